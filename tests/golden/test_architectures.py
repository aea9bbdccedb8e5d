#!/usr/bin/env python3
"""Debian 12's compilers for other processors build the program without a warning, and it gives the bytes of this one.

    test_architectures.py BUILD-FOLDER FFD

Every source of the build folder is compiled for armhf, whose addresses have 32 bits and whose doubles lie at multiples of 8.
Of other libraries only headers are needed, those of this machine: the program is linked with the one module that needs no
more, tinygltf. It does the runs of golden.json, and converts, under qemu. (arm64 is built whole: tests/run.sh.) What is read
only (-fsyntax-only), where its compiler is installed: the other architectures of Debian.
"""

import concurrent.futures
import filecmp
import json
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile

import golden

SKIPPED = 77
ROOT = os.path.dirname(os.path.dirname(golden.HERE))
MODELS = os.path.join(golden.DATA, "models")

# Compilers for a machine, what runs its programs, and options as in meson.build.
RUN = {"arm-linux-gnueabihf": ("qemu-arm", ["-O2"])}
# Those of Debian 12's cross compilers (.ci/setup, soak), and the options of meson.build where it adds some. m68k, whose registers
# hold more than a double, is refused (base/vector/vec.h).
READ = {machine if "-linux-" in machine else machine + "-linux-gnu": []
        for machine in ("alpha", "arc", "arm-linux-gnueabi", "hppa", "mips", "mips64-linux-gnuabi64", "mips64el-linux-gnuabi64",
                        "mipsel", "powerpc", "powerpc64", "powerpc64le", "riscv64", "s390x", "sh4", "sparc64", "x86_64-linux-gnux32")}
READ["i686-linux-gnu"] = ["-msse2", "-mfpmath=sse"]
READ["powerpc-linux-gnu"] = ["-Wno-psabi"]

# What is for this machine's processor, or says how this folder is compiled.
DROPPED = re.compile(r"-m|-fcf-protection$|-fstack-protector|-DFFD_X86$|-O|-g|-D_FORTIFY_SOURCE|-fdiagnostics-color|-MD$|-c$|-W(no-)?error$")
WITH_VALUE = {"-o", "-MQ", "-MF"}

CONVERSIONS = [("knight.glb", "ply"), ("knight.glb", "obj"), ("character.glb", "ply"), ("keg_decorated.obj", "glb"),
               ("spot.obj", "stl")]


class Unit:
    """A source of a target: the library's core, a module, the program."""

    def __init__(self, entry):
        words = shlex.split(entry["command"])
        compiler = next(word for word in words if not word.endswith("ccache"))
        self.is_cpp = compiler.endswith("++")
        self.target = os.path.basename(os.path.dirname(entry["output"]))
        self.object = os.path.basename(entry["output"])
        self.source = entry["file"]
        self.arguments = []
        words = iter(words[words.index(compiler) + 1:])
        for word in words:
            if word in WITH_VALUE:
                next(words)
            elif not DROPPED.match(word):
                self.arguments.append(word)

    def compile(self, machine, options, build, folder):
        """What the compiler says, if it fails."""
        command = [machine + ("-g++" if self.is_cpp else "-gcc"), *self.arguments, "-Werror", "-idirafter", "/usr/include",
                   "-idirafter", f"/usr/include/{os.uname().machine}-linux-gnu", *options]
        if folder:
            made = os.path.join(folder, self.target, self.object)
            os.makedirs(os.path.dirname(made), exist_ok=True)
            command += ["-c", "-o", made, "-MD", "-MF", made + ".d"]
            command[:0] = ["ccache"] if shutil.which("ccache") else []
        else:
            command.append("-fsyntax-only")
        done = subprocess.run(command, cwd=build, capture_output=True, text=True, check=False)
        if done.returncode == 0:
            return None
        lines = [line for line in done.stderr.splitlines() if "error:" in line] or done.stderr.splitlines()
        return f"{machine}: {lines[0] if lines else self.source}"


def units(build):
    """Those of src; of the kernels the scalar ones."""
    with open(os.path.join(build, "compile_commands.json"), encoding="utf-8") as file:
        entries = json.load(file)
    return [Unit(entry) for entry in entries if entry["output"].startswith("src/")
            and not re.search(r"-DFFD_LANES=[^1]|ffd-pages", entry["command"])]


def link(machine, folder):
    """Links the program and its module; returns the program."""
    def objects(*targets):
        return [os.path.join(folder, target + ".p", name) for target in targets
                for name in sorted(os.listdir(os.path.join(folder, target + ".p"))) if name.endswith(".o")]

    core = objects("libffd_core.a", "libffd_small.a", "libffd_unversioned.a", "libffd_kernels_scalar.a")
    program, archive = os.path.join(folder, "ffd"), os.path.join(folder, "core.a")
    libraries = ["-lm", "-lpthread", "-ldl"]
    subprocess.run([machine + "-gcc", "-o", program, *core, *objects("libffd_loading.a", "libffd_cli.a", "ffd"),
                    *libraries], check=True)
    subprocess.run([machine + "-ar", "rcs", archive, *core], check=True)
    subprocess.run([machine + "-g++", "-shared", "-o", os.path.join(folder, "ffd-tinygltf.so"),
                    *objects("ffd-tinygltf.so", "libffd_tinygltf.a"), archive, *libraries], check=True)
    return program


def convert(ffd, folder, name, ending):
    """A conversion of a deformed model."""
    made = os.path.join(folder, f"{name}.{ending}")
    done = subprocess.run([ffd, "deform", os.path.join(MODELS, name), made, "-l", os.path.join(golden.DATA, "lattices", "twist.json")],
                          capture_output=True, text=True, check=False)
    return made, f"exit {done.returncode}: {done.stderr}"


def compare(machine, program, own, folder, pool):
    """Findings of the runs of a machine's program."""
    wrapper = os.path.join(folder, "run")
    with open(wrapper, "w", encoding="utf-8") as file:
        file.write(f'#!/bin/sh\nexec {RUN[machine][0]} -L /usr/{machine} "{program}" "$@"\n')
    os.chmod(wrapper, 0o755)
    here, there = os.path.join(folder, "here"), os.path.join(folder, "there")
    os.mkdir(here)
    os.mkdir(there)
    with open(golden.MEMORY, encoding="ascii") as file:
        memory = json.load(file)
    cases = list(golden.cases())
    results = pool.map(lambda case: golden.run(wrapper, there, *case), cases)
    for (mesh, lattices, options), result in zip(cases, results):
        name = " ".join([mesh, *lattices, *options])
        yield from (f"{machine}: {line}" for line in golden.differences(name, memory.get(name), result))
    pairs = pool.map(lambda pair: (convert(own, here, *pair), convert(wrapper, there, *pair)), CONVERSIONS)
    for (expected, said), (found, told) in pairs:
        if said != told:
            yield f"{machine}: {os.path.basename(expected)}: {told!r} instead of {said!r}"
        elif not filecmp.cmp(expected, found, shallow=False):
            yield f"{machine}: {os.path.basename(expected)} has other bytes than on this machine"


def main():
    build, own = sys.argv[1:]
    missing = [tool for machine, (emulator, _) in RUN.items() for tool in (machine + "-g++", emulator) if not shutil.which(tool)]
    if missing:
        print(f"SKIP: no {', '.join(missing)} (.ci/setup stages)")
        sys.exit(SKIPPED)
    found, findings = units(build), []
    with tempfile.TemporaryDirectory() as top, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for machine in [*RUN, *(name for name in READ if shutil.which(name + "-g++"))]:
            folder = os.path.join(top, machine) if machine in RUN else None
            options = RUN[machine][1] + ["-DNDEBUG"] if folder else READ[machine]
            said = [line for line in pool.map(lambda unit: unit.compile(machine, options, build, folder), found) if line]
            findings += said
            if folder and not said:
                findings += compare(machine, link(machine, folder), own, folder, pool)
            print(f"{machine}: {len(found)} sources", flush=True)
    for line in findings:
        print(line)
    print(f"{len(findings)} findings")
    sys.exit(1 if findings or not found else 0)


if __name__ == "__main__":
    main()
