#!/usr/bin/env python3
"""A program that loads libffd may export functions under the names of meshoptimizer, OpenMesh, libpng, libjpeg, zlib or Draco, of
other versions than ours, and have allocators of its own: the modules call their own libraries, and the program's allocators.

    test_host.py CC PROGRAM HOST PACKED-GLB LIBRARY MODULE...

Here *every* name that these libraries export stands for a function that ends the process: one preloaded library has them all.
HOST (host.cpp) ends itself where memory of one allocator reaches another. What comes out is what comes out without them.
"""

import os
import re
import shutil
import subprocess
import sys
import tempfile

import stage

# The runtime libraries of C and C++, which a module shares with its process.
SHARED = re.compile(r"lib(c|m|dl|pthread|stdc\+\+|c\+\+|c\+\+abi|gcc_s|unwind)\.so|ld-|linux-vdso")
# Instances of the C++ library's templates: those of all libraries are alike.
STANDARD = re.compile(r"_Z(T[VISCT]|GV)?N?K?S[tabdiops]")
MODELS = os.path.join(stage.ROOT, "data", "models")
IMAGES = os.path.join(stage.ROOT, "tests", "fuzz", "corpus", "jpeg")
LATTICE = ('{"format": "ffd-lattice", "version": 1, "size": [4, 4, 4], "rest": {"box": "mesh", "margin": 0.05},\n'
           ' "moves": [{"twist": {"axis": "y", "degrees": 30}}]}\n')
BOX = """v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
v 0 0 1
v 1 0 1
vn 0 0 1
f 1//1 2//1 3//1 4//1
f 1//1 5//1 6//1 2//1
"""
PICTURES = """mtllib m.mtl
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
v 2 0 0
v 2 1 0
vt 0 0
vt 1 0
vt 1 1
vt 0 1
usemtl png
f 1/1 2/2 3/3 4/4
usemtl jpeg
f 2/1 5/2 6/3 3/4
"""
COMMANDS = {"deform": ["deform"], "recompute": ["deform", "--normals", "recompute"],
            "view": ["view", "--size", "64x32", "--color", "plain", "-o"], "page": ["view", "--color", "plain", "-o"]}
JOBS = [("deform", "meshopt.glb", "glb"), ("deform", "draco.glb", "glb"), ("recompute", "box.obj", "obj"),
        ("view", "pictures.obj", "png"), ("page", "meshopt.glb", "html")]


def foreign_libraries(modules):
    """Those that the modules are linked with."""
    paths = set()
    for module in modules:
        paths |= set(re.findall(r"=> (/\S+)", stage.run(["ldd", module])))
    return sorted(path for path in paths if not SHARED.match(os.path.basename(path)))


def exported(library):
    lines = (line.split() for line in stage.run(["nm", "-D", "--defined-only", library]).splitlines())
    return {words[-1].split("@")[0] for words in lines if words[-2] != "A"}


def make_traps(folder, names, compiler):
    """A library with a function of each name."""
    source, library = os.path.join(folder, "traps.c"), os.path.join(folder, "traps.so")
    with open(source, "w", encoding="ascii") as file:
        file.write('#include <unistd.h>\n#define NAME(s) "called: " s "\\n"\n'
                   "#define TRAP(n, s) void n(void) __asm__(s); void n(void) { _exit(write(1, NAME(s), sizeof NAME(s) - 1) < 0 ? 8 : 9); }\n")
        file.writelines(f'TRAP(trap_{i}, "{name}")\n' for i, name in enumerate(names))
    stage.run([*compiler, "-O0", "-shared", "-fPIC", source, "-o", library])
    return library


def write_inputs(folder, packed_glb):
    for name, content in (("l.json", LATTICE), ("box.obj", BOX), ("pictures.obj", PICTURES),
                          ("m.mtl", "newmtl png\nmap_Kd colormap.png\nnewmtl jpeg\nmap_Kd rgb420.jpg\n")):
        with open(os.path.join(folder, name), "w", encoding="ascii") as file:
            file.write(content)
    shutil.copy(os.path.join(MODELS, "Textures", "colormap.png"), folder)
    shutil.copy(os.path.join(IMAGES, "rgb420.jpg"), folder)
    # More vertices than a page shows, so that they are reduced.
    stage.run([packed_glb, "meshopt", "450", os.path.join(folder, "meshopt.glb")])
    stage.run([packed_glb, "edgebreaker", "8", os.path.join(folder, "draco.glb")])


def finding(what, command, output, expected, environment, folder):
    path = os.path.join(folder, output)
    done = subprocess.run([*command, output], cwd=folder, env=environment, stdin=subprocess.DEVNULL, capture_output=True, text=True,
                          check=False)
    if done.returncode != 0:
        return f"{what}: exit {done.returncode}: {done.stdout}{done.stderr}"
    with open(path, "rb") as file:
        found = file.read()
    os.remove(path)
    return None if found == expected else f"{what}: another output"


def main():
    program, host, packed_glb, library, *modules = map(os.path.abspath, sys.argv[2:])
    stage.need("ldd", "nm")
    libraries = foreign_libraries(modules)
    names = sorted(name for path in libraries for name in exported(path) if not STANDARD.match(name))
    if not names:
        stage.skip("the modules are linked with no other libraries")
    print(f"{len(names)} functions of {', '.join(map(os.path.basename, libraries))}")
    findings = []
    with tempfile.TemporaryDirectory() as folder:
        write_inputs(folder, packed_glb)
        traps = make_traps(folder, names, sys.argv[1].split())
        usual = dict(os.environ, LD_LIBRARY_PATH=os.path.dirname(library))
        trapped = dict(usual, LD_PRELOAD=traps)
        for what, mesh, ending in JOBS:
            output = f"out.{ending}"
            verb, *options = COMMANDS[what]
            command = [program, verb, mesh, "-l", "l.json", "-q", *options]
            stage.run([*command, output], cwd=folder, env=usual)
            with open(os.path.join(folder, output), "rb") as file:
                expected = file.read()
            os.remove(os.path.join(folder, output))
            for which, words, environment in (("ffd", command, trapped), ("host", [host, what, mesh, "l.json"], usual),
                                              ("host", [host, what, mesh, "l.json"], trapped)):
                said = f"{which}{'' if environment is usual else ' with traps'}, {what} {mesh}"
                findings += filter(None, [finding(said, words, output, expected, environment, folder)])
    stage.finish(3 * len(JOBS), "runs", findings)


main()
