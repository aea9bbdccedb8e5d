#!/usr/bin/env python3
"""What data/packaging/release.sh has made is what its page says: names, sums, SBOMs, sizes, what it needs of a system and shows to it;
and does the jobs of the list.

    test_artefacts.py OUT [NAME|sums|sbom]...     NAME: of an artefact; default: all that OUT holds

The tools are those of `sh .ci/setup release`; numpy comes from the wheels of the suite python.
"""

import glob
import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile
import zipfile

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
TOOLS = os.path.join(ROOT, ".build-release/venv/bin")
with open(os.path.join(ROOT, "include/ffd/version.h"), encoding="utf-8") as header:
    VERSION = re.search(r'#define FFD_VERSION "(.*)"', header.read())[1]
ABI = ".".join(VERSION.split(".")[:2])
NAMES = {
    "wheel": f"ffd_mesh-{VERSION}-cp311-abi3-manylinux_2_28_x86_64.whl",
    "wheel-musl": f"ffd_mesh-{VERSION}-cp311-abi3-musllinux_1_2_x86_64.whl",
    "wheel-arm64": f"ffd_mesh-{VERSION}-cp311-abi3-manylinux_2_28_aarch64.whl",
    "wheel-windows": f"ffd_mesh-{VERSION}-cp311-abi3-win_amd64.whl",
    "static": f"ffd-{VERSION}-linux-x86_64.tar.xz",
    "static-arm64": f"ffd-{VERSION}-linux-arm64.tar.xz",
    "windows": f"ffd-{VERSION}-windows-x86_64.zip",
    "macos": f"ffd-{VERSION}-macos-arm64.tar.xz",
    "source": f"ffd-{VERSION}.tar.xz",
    "npm": f"ffd-mesh-{VERSION}.tgz",
    "blender": f"ffd_lattice-{VERSION}.zip",
    "deb": f"ffd_{VERSION}-1_amd64.deb",
}
MEGABYTE = 1_000_000
# What every Windows has.
WINDOWS = {"ADVAPI32.dll", "KERNEL32.dll", "msvcrt.dll"}
# What every macOS has.
MACOS = {"/usr/lib/libSystem.B.dylib"}
# Debian's cross compiler brings this system of arm64.
SYSTEM = "/usr/aarch64-linux-gnu"
findings = []


def check(right, text):
    if not right:
        findings.append(text)


def run(*command, **more):
    """Its standard output. A failure ends the test, with what was said."""
    done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, encoding="utf-8", errors="replace", check=False, **more)
    if done.returncode:
        sys.exit(f"{' '.join(command)}: exit {done.returncode}\n{done.stdout[-4000:]}{done.stderr[-4000:]}")
    return done.stdout


def do_jobs(what, *program, options=()):
    done = subprocess.run([sys.executable, os.path.join(HERE, "run_jobs.py"), *options, *program], capture_output=True, text=True,
                          check=False)
    print(f"{what}: {done.stdout.splitlines()[-1] if done.stdout else done.stderr[-500:]}")
    check(done.returncode == 0, f"{what}: the job list: {done.stdout[-2000:]}{done.stderr[-500:]}")


def needed(path):
    return set(re.findall(r"\(NEEDED\).*\[(.*)\]", run("readelf", "-d", path)))


def shown(path):
    """The names that a shared object defines for others."""
    lines = run("nm", "-D", "--defined-only", path).splitlines()
    return {line.split()[-1].split("@")[0] for line in lines}


def unpack(out, file, folder):
    with tarfile.open(os.path.join(out, file)) as archive:
        archive.extractall(folder, filter="data")
    return os.path.join(folder, f"ffd-{VERSION}")


def test_sums(out):
    with open(os.path.join(out, "SHA256SUMS"), encoding="utf-8") as file:
        listed = dict(reversed(line.rstrip("\n").split("  ", 1)) for line in file)
    artefacts = {name for name in os.listdir(out) if name != "SHA256SUMS" and not name.endswith(".spdx.json")}
    check(set(listed) == artefacts, f"SHA256SUMS lists {sorted(listed)}, and {sorted(artefacts)} are there")
    for name, digest in listed.items():
        with open(os.path.join(out, name), "rb") as file:
            check(hashlib.sha256(file.read()).hexdigest() == digest, f"{name}: not the sum of SHA256SUMS")


def test_sbom(out):
    for path in sorted(glob.glob(os.path.join(out, "*.spdx.json"))):
        done = subprocess.run([os.path.join(TOOLS, "pyspdxtools"), "-i", path], capture_output=True, text=True, check=False)
        check(done.returncode == 0, f"{path}: {done.stdout}{done.stderr}")
        with open(path, encoding="utf-8") as file:
            own = json.load(file)["packages"][0]
        with open(path.removesuffix(".spdx.json"), "rb") as file:
            check(hashlib.sha256(file.read()).hexdigest() == own["checksums"][0]["checksumValue"], f"{path}: the sum of another file")


def check_static(out, name, emulator, *options):
    """emulator: what runs it, or none."""
    with tempfile.TemporaryDirectory() as folder:
        tree = unpack(out, NAMES[name], folder)
        for page in ("share/man/man1/ffd.1", "share/bash-completion/completions/ffd", "share/zsh/site-functions/_ffd",
                     "share/doc/ffd/LICENSE", "share/doc/ffd/THIRD-PARTY.md", "share/doc/ffd/licenses/glibc.txt", "share/ffd/blender/ffd_export.py"):
            check(os.path.isfile(os.path.join(tree, page)), f"{name}: lacks {page}")
        program = os.path.join(tree, "bin/ffd")
        check(not needed(program) and "INTERP" not in run("readelf", "-lW", program), f"{name}: needs a loader or a library")
        in_empty_root(program, emulator, folder)
        do_jobs(name, *emulator, program, options=options)


def test_static(out):
    check_static(out, "static", [])


def test_static_arm64(out):
    check_static(out, "static-arm64", ["qemu-aarch64-static"], "--without", "batch")


def test_windows(out):
    path = os.path.join(out, NAMES["windows"])
    check(os.path.getsize(path) <= 8 * MEGABYTE, f"windows: {os.path.getsize(path)} bytes")
    with tempfile.TemporaryDirectory() as folder:
        with zipfile.ZipFile(path) as archive:
            archive.extractall(folder)
        tree = os.path.join(folder, f"ffd-{VERSION}")
        check(sorted(os.listdir(tree)) == ["LICENSE", "THIRD-PARTY.md", "ffd.exe", "licenses"], f"windows: holds {os.listdir(tree)}")
        program = os.path.join(tree, "ffd.exe")
        check(os.path.getsize(program) <= 8 * MEGABYTE, f"windows: ffd.exe has {os.path.getsize(program)} bytes")
        check(imported(program) <= WINDOWS, f"windows: needs {sorted(imported(program))}")
        do_jobs_in_wine("windows", program, folder)


def imported(path):
    return set(re.findall(r"DLL Name: (\S+)", run("x86_64-w64-mingw32-objdump", "-p", path)))


def do_jobs_in_wine(what, program, folder, options=()):
    os.environ |= {"WINEPREFIX": os.path.join(folder, "wine"), "WINEDEBUG": "-all"}
    wine = shutil.which("wine64") or "/usr/lib/wine/wine64"
    # While one program runs, wine need not begin anew for each: this one waits for its input, which ends with the block.
    with subprocess.Popen([wine, "cmd"], stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL):
        do_jobs(what, wine, program, options=options)


def test_wheel_windows(out):
    """Without Python: its files, what they need, and the program."""
    path = os.path.join(out, NAMES["wheel-windows"])
    check(os.path.getsize(path) <= 4 * MEGABYTE, f"wheel-windows: {os.path.getsize(path)} bytes")
    with tempfile.TemporaryDirectory() as folder:
        with zipfile.ZipFile(path) as archive:
            archive.extractall(folder)
            names = archive.namelist()
            (tag,) = [name for name in names if name.endswith(".dist-info/WHEEL")]
            check(b"Tag: cp311-abi3-win_amd64\n" in archive.read(tag) + b"\n", "wheel-windows: another tag")
        for name, others in (("libffd.dll", set()), ("_native.pyd", {"python3.dll"}), ("ffd.exe", {"libffd.dll"})):
            needs = imported(os.path.join(folder, "ffd_mesh", name))
            check(others <= needs <= WINDOWS | others, f"wheel-windows: {name} needs {sorted(needs)}")
        do_jobs_in_wine("wheel-windows", os.path.join(folder, "ffd_mesh/ffd.exe"), folder, ["--every", "10"])
    check_notices(names, "wheel-windows", ("gcc", "mingw"))


def test_macos(out):
    """Nothing runs them here: for which system and processor they are, what they need and show, and that this is said."""
    shows = {"libffd.dylib": declared(), "_native.abi3.so": {"PyInit__native"}}
    for processor in ("arm64", "x86_64"):
        with tempfile.TemporaryDirectory() as folder:
            tree = unpack(out, f"ffd-{VERSION}-macos-{processor}.tar.xz", folder)
            check(sorted(os.listdir(tree)) == ["LICENSE", "NOT-RUN", "THIRD-PARTY.md", "bin", "licenses"], f"macos: holds {os.listdir(tree)}")
            check_macos(os.path.join(tree, "bin/ffd"), processor)
        wheel = f"ffd_mesh-{VERSION}-cp311-abi3-macosx_11_0_{processor}.whl"
        with tempfile.TemporaryDirectory() as folder:
            with zipfile.ZipFile(os.path.join(out, wheel)) as archive:
                archive.extractall(folder)
                names = archive.namelist()
                (tag,) = [name for name in names if name.endswith(".dist-info/WHEEL")]
                check(f"Tag: cp311-abi3-macosx_11_0_{processor}\n".encode() in archive.read(tag) + b"\n", f"{wheel}: another tag")
            package = os.path.join(folder, "ffd_mesh")
            check(os.path.isfile(os.path.join(package, "NOT-RUN")), f"{wheel}: does not say that it was not run")
            check_notices(names, wheel, ("llvm", "zig"))
            modules = glob.glob(os.path.join(package, f"ffd-{ABI}/*.so"))
            check(len(modules) == 6, f"{wheel}: {len(modules)} modules")
            for library, wanted in shows.items():
                path = os.path.join(package, library)
                check_macos(path, processor)
                found = shown_by_macos(path)
                check(found == wanted, f"{wheel}: {library} shows others: {sorted(found ^ wanted)[:5]}")
            for path in modules:
                check_macos(path, processor)
                # Operators of C++ stand in for those of the system in the whole process, if a program has others.
                others = {name for name in shown_by_macos(path) if not re.match(r"ffd_|_Z(n[wa]|d[la])", name)}
                check(not others, f"{wheel}: {path} shows {sorted(others)[:5]}")
            asked = set(re.findall(r"^PYTHON .*?\b(_?Py\w+)\)?[(;]", read("src/python/stable_abi.h"), re.M))
            needs = {name for name in shown_by_macos(os.path.join(package, "_native.abi3.so"), "--undefined-only") if "Py" in name}
            check(needs and needs <= asked, f"{wheel}: needs of Python {sorted(needs - asked)}")
            program = os.path.join(package, "ffd")
            check_macos(program, processor, {"@rpath/libffd.dylib"})
            check("path @loader_path " in headers_of(program), f"{wheel}: the program does not look beside itself")


def headers_of(path):
    return run("llvm-objdump", "--macho", "--private-headers", path)


def shown_by_macos(path, which="--defined-only"):
    return {line.split()[-1].removeprefix("_") for line in run("llvm-nm", "--extern-only", which, path).splitlines()}


def check_macos(path, processor, others=frozenset()):
    headers, name = headers_of(path), f"macos {processor}: {os.path.basename(path)}"
    check(re.search(rf"MH_MAGIC_64 +{processor} ", headers, re.I), f"{name}: is for another processor")
    check(re.search(r"^ *minos 11\.0$", headers, re.M), f"{name}: is for another version of the system")
    check(processor != "arm64" or "LC_CODE_SIGNATURE" in headers, f"{name}: has no signature, without which the system starts nothing")
    needs = set(re.findall(r"cmd LC_LOAD_DYLIB\n.*\n +name (\S+)", headers))
    check(MACOS <= needs == MACOS | others, f"{name}: needs {sorted(needs)}")


def read(path):
    with open(os.path.join(ROOT, path), encoding="utf-8") as file:
        return file.read()


def declared():
    """The functions of the public headers."""
    names = set()
    for path in glob.glob("include/ffd/*.h", root_dir=ROOT):
        if not path.endswith("export.h"):
            names |= set(re.findall(r"\bFFD_API\b[^;(]*?\b(\w+)\s*\(", re.sub(r"/\*.*?\*/", "", read(path), flags=re.S)))
    return names


def in_empty_root(program, emulator, folder):
    """No /proc, no /dev, no home folder, no environment; with workers, which an emulator cannot begin."""
    root = os.path.join(folder, "root")
    os.makedirs(os.path.join(root, "w"))
    for file in [program, *map(shutil.which, emulator)]:
        shutil.copy(file, root)
    for path in ("data/models/spot.obj", "data/lattices/twist.json"):
        shutil.copy(os.path.join(ROOT, path), os.path.join(root, "w"))
    enter = [shutil.which("chroot", path="/usr/sbin:/usr/bin"), root, *("/" + name for name in emulator), "/ffd"]
    if os.geteuid() != 0:
        enter = ["unshare", "--map-root-user", *enter]
    run(*enter, "deform", "/w/spot.obj", "/w/one.obj", "-l", "/w/twist.json", env={})
    if emulator:
        return
    with open(os.path.join(root, "w/jobs.jsonl"), "w", encoding="utf-8") as file:
        file.write('{"in": "spot.obj", "lattice": "twist.json", "out": "two.obj"}\n'
                   '{"in": "spot.obj", "lattice": "twist.json", "out": "three.glb"}\n')
    run(*enter, "batch", "/w/jobs.jsonl", "-j", "2", env={})
    with open(os.path.join(root, "w/one.obj"), "rb") as one, open(os.path.join(root, "w/two.obj"), "rb") as two:
        check(one.read() == two.read(), "static: a worker gives other bytes")
    check(sorted(os.listdir(root)) == ["ffd", "w"], f"static: makes {os.listdir(root)} in an empty root")


def check_wheel(path, name):
    """What is in it needs the C library and itself alone, and shows its own names alone."""
    check(os.path.getsize(path) <= 4 * MEGABYTE, f"{name}: {os.path.getsize(path)} bytes")
    system = {"libc.so.6", "libm.so.6", "libdl.so.2", "libpthread.so.0", "librt.so.1", "ld-linux-x86-64.so.2", "ld-linux-aarch64.so.1",
              "libc.so"}
    with tempfile.TemporaryDirectory() as folder:
        with zipfile.ZipFile(path) as archive:
            archive.extractall(folder)
            names = archive.namelist()
        for library in glob.glob(os.path.join(folder, "**/*.so"), recursive=True):
            check(needed(library) <= system, f"{name}: {os.path.basename(library)} needs {sorted(needed(library) - system)}")
            others = {symbol for symbol in shown(library) if not re.match(r"PyInit_|ffd_", symbol)}
            check(not others, f"{name}: {os.path.basename(library)} shows {sorted(others)[:5]}")
        # The library beside it, which it looks for nowhere else.
        program = os.path.join(folder, "ffd_mesh/ffd")
        check(needed(program) <= system | {"libffd.so"}, f"{name}: the program needs {sorted(needed(program) - system)}")
        check("[$ORIGIN]" in run("readelf", "-d", program), f"{name}: the program does not look beside itself")
    check_notices(names, name, ("llvm",))


def check_notices(names, artefact, libraries):
    for notice in ("LICENSE", "THIRD-PARTY.md", "licenses/draco.txt", *(f"licenses/{library}.txt" for library in libraries)):
        check(any("licenses/" in entry and entry.endswith(notice) for entry in names), f"{artefact}: lacks {notice}")


def test_wheel(out):
    path = os.path.join(out, NAMES["wheel"])
    check_wheel(path, "wheel")
    check("manylinux_2_28_x86_64" in run(os.path.join(TOOLS, "auditwheel"), "show", path).replace("\n", " "), "wheel: auditwheel gives another tag")
    done = subprocess.run([os.path.join(TOOLS, "abi3audit"), "--strict", path], capture_output=True, text=True, check=False)
    check(done.returncode == 0, f"wheel: abi3audit: {done.stdout}{done.stderr}")
    with tempfile.TemporaryDirectory() as folder:
        run("/usr/bin/python3", "-m", "venv", os.path.join(folder, "venv"))
        python = os.path.join(folder, "venv/bin/python3")
        run(python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-index", "--find-links",
            os.path.join(ROOT, ".build-test/wheels"), path)
        check(run(os.path.join(folder, "venv/bin/ffd"), "--version").startswith(f"ffd {VERSION}"), "wheel: ffd --version")
        with_batch = ("import ffd_mesh, sys\n"
                      "r = ffd_mesh.batch([{'in': sys.argv[1], 'lattice': sys.argv[2], 'out': sys.argv[3]}])\n"
                      "assert r[0].error is None, r[0].error")
        environment = {"PATH": "/nowhere", "HOME": folder}
        run(python, "-c", with_batch, os.path.join(ROOT, "data/models/spot.obj"), os.path.join(ROOT, "data/lattices/twist.json"),
            os.path.join(folder, "out.obj"), env=environment)
        do_jobs("wheel, ffd", os.path.join(folder, "venv/bin/ffd"))
        do_jobs("wheel, -m", python, "-m", "ffd_mesh", options=["--every", "10"])


def test_wheel_musl(out):
    """Its libraries can be loaded while a program runs: musl refuses those whose variables of threads have the static model."""
    path = os.path.join(out, NAMES["wheel-musl"])
    check_wheel(path, "wheel-musl")
    with tempfile.TemporaryDirectory() as folder:
        with zipfile.ZipFile(path) as archive:
            archive.extractall(folder)
        for library in glob.glob(os.path.join(folder, "**/*.so"), recursive=True):
            check("STATIC_TLS" not in run("readelf", "-d", library), f"wheel-musl: {os.path.basename(library)} has the static model")
        program = os.path.join(folder, "ffd_mesh/ffd")
        os.chmod(program, 0o755)
        do_jobs("wheel-musl", program)


def test_wheel_arm64(out):
    path = os.path.join(out, NAMES["wheel-arm64"])
    check_wheel(path, "wheel-arm64")
    done = subprocess.run([os.path.join(TOOLS, "abi3audit"), "--strict", path], capture_output=True, text=True, check=False)
    check(done.returncode == 0, f"wheel-arm64: abi3audit: {done.stdout}{done.stderr}")
    with tempfile.TemporaryDirectory() as folder:
        with zipfile.ZipFile(path) as archive:
            archive.extractall(folder)
        program = os.path.join(folder, "ffd_mesh/ffd")
        os.chmod(program, 0o755)  # zipfile forgets
        do_jobs("wheel-arm64, ffd", "qemu-aarch64", "-L", SYSTEM, "-E", f"LD_LIBRARY_PATH={SYSTEM}/lib", program,
                options=["--without", "batch"])


def test_source(out):
    """It builds without a network, and without the system's libraries."""
    with tempfile.TemporaryDirectory() as folder:
        tree = unpack(out, NAMES["source"], folder)
        build = os.path.join(folder, "build")
        environment = dict(os.environ)
        if shutil.which("ccache"):
            environment |= {"CC": "ccache gcc", "CXX": "ccache g++", "CCACHE_BASEDIR": folder, "CCACHE_NOHASHDIR": "1"}
        offline = ["unshare", "--net", "--map-root-user"]
        run(*offline, "meson", "setup", build, tree, "--wrap-mode=forcefallback", "-Dtests=disabled", "--buildtype=release", env=environment)
        run(*offline, "ninja", "-C", build, env=environment)
        check(run(os.path.join(build, "src/cli/ffd"), "--version").startswith(f"ffd {VERSION}"), "source: ffd --version")
        do_jobs("source", os.path.join(build, "src/cli/ffd"), options=["--every", "10"])


def test_deb(out):
    with tempfile.TemporaryDirectory() as folder:
        for package in ("ffd", f"libffd{ABI}", "libffd-dev"):
            run("dpkg-deb", "--extract", os.path.join(out, f"{package}_{VERSION}-1_amd64.deb"), folder)
        do_jobs("deb", os.path.join(folder, "usr/bin/ffd"))


def test_npm(out):
    with tempfile.TemporaryDirectory() as folder:
        with tarfile.open(os.path.join(out, NAMES["npm"])) as archive:
            archive.extractall(folder)
        do_jobs("npm", "node", os.path.join(folder, "package/bin/ffd-mesh.mjs"), options=("--without", "batch"))


def test_blender(out):
    """It holds the wheel of the same release. tests/blender installs and runs such a file."""
    with zipfile.ZipFile(os.path.join(out, NAMES["blender"])) as archive:
        check(f'version = "{VERSION}"' in archive.read("blender_manifest.toml").decode(), "blender: another version")
        packed = archive.read(f"wheels/{NAMES['wheel']}")
        check({entry.date_time for entry in archive.infolist()} == {(1980, 1, 1, 0, 0, 0)}, "blender: times")
    if os.path.exists(os.path.join(out, NAMES["wheel"])):
        with open(os.path.join(out, NAMES["wheel"]), "rb") as file:
            check(file.read() == packed, "blender: another wheel")


def main():
    out, *chosen = sys.argv[1:]
    chosen = chosen or [name for name, file in NAMES.items() if os.path.exists(os.path.join(out, file))] + ["sums", "sbom"]
    for name in chosen:
        globals()["test_" + name.replace("-", "_")](out)
    for finding in findings:
        print(finding)
    print(f"{', '.join(chosen)}: {len(findings)} findings")
    sys.exit(bool(findings))


main()
