#!/usr/bin/env python3
"""Files that end early, are no files, are far from anything expected, or name files elsewhere: an exit code of the
table and one line, in time, in little memory, without a look outside of the model's folder."""

import json
import os
import shutil
import struct
import subprocess
import sys

import foam_files as foam
import volume_files as volume
from broken_gltf_cases import TRIANGLES, USHORT, Model
from harness import (CUBE, FFD, INVALID, IO, LIMIT, OK, SANITIZED, UNSUPPORTED, case, check, equal, glb, gltf_json, lattice, main)
from messages import anything

MEASURE_PEAK = None if SANITIZED else os.path.abspath(sys.argv.pop(1))  # the program of that name
REFUSALS = (IO, INVALID, UNSUPPORTED, LIMIT)
MEGABYTE = 2**20

PLY = ("ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n"
       "element face 2\nproperty list uchar int vertex_indices\nend_header\n"
       + "".join("%d %d %d\n" % (x, y, z) for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)) + "4 0 1 3 2\n3 4 5 6\n")
PLY_BYTES = (b"ply\nformat binary_little_endian 1.0\nelement vertex 2\nproperty double x\nproperty float y\n"
             b"property float z\nelement face 1\nproperty list uchar uint vertex_indices\nend_header\n"
             + struct.pack("<dffdff", 0, 1, 0, 1, 0, 1) + struct.pack("<B3I", 3, 0, 1, 1))
OFF = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"
STL = ("solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
       "endsolid x\n")
STL_BYTES = bytes(80) + struct.pack("<I12fH", 1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0)


def start(run):
    run.write("l.json", lattice(moves=[{"at": [1, "all", "all"], "by": [0.25, 0.5, 0]}]))


def small_files():
    yield "m.obj", CUBE.encode() + b"vn 0 0 1\nf 1//1 2//1 3//1\n"
    yield "m.glb", Model().morph().glb()
    yield "m.gltf", Model().skin().gltf()
    yield "m.ply", PLY.encode()
    yield "b.ply", PLY_BYTES
    yield "m.off", OFF.encode()
    yield "m.stl", STL.encode()
    yield "b.stl", STL_BYTES
    yield "m.vtk", volume.vtk()
    yield "b.vtk", volume.vtk(is_binary=True, offsets=True)
    yield "m.su2", volume.su2(boxes=1)
    yield "m.vtu", volume.vtu()
    yield "b.vtu", volume.vtu(encoding="raw zlib")
    yield "m.vtp", volume.vtp(encoding="base64")
    yield "m.vts", volume.vts(encoding="appended base64")
    yield "m.msh", volume.msh2()
    yield "b.msh", volume.msh4(is_binary=True)
    yield "points", foam.Foam().points()
    yield "b/points", foam.Foam(True).points()


def output_of(run, name):
    """The name of an output: one of its ending; that of OpenFOAM in a folder."""
    if not name.endswith("points"):
        return "out" + os.path.splitext(name)[1]
    os.makedirs(run.path("out"), exist_ok=True)
    return "out/points"


def deform(run, name, code, *words, **options):
    """Either the output is there, or the program said why in one line that names a file."""
    output = output_of(run, name)
    run.remove(output)
    done = run.ffd("deform", name, output, "-l", "l.json", "-q", *words, code=code, **options)
    check(run.exists(output) == (done.code == OK), f"{name}: exit {done.code}, but {run.names()}")
    return done


@case
def truncated_at_every_byte(run):
    """What is left of a small file is refused or, where it is one, a smaller file."""
    start(run)
    for name, content in small_files():
        # All of the beginning and the end; every few bytes of what is alike.
        step, edge = max(1, len(content) // (40 if SANITIZED else 200)), 12 if SANITIZED else 40
        for size in [n for n in range(len(content)) if n < edge or n > len(content) - edge or n % step == 0]:
            run.write(name, content[:size])
            done = deform(run, name, (OK, *REFUSALS))
            if name.endswith((".glb", ".gltf", "b.stl")):
                check(done.code in (INVALID, UNSUPPORTED), f"{name}, {size} bytes of {len(content)}: exit {done.code}")
        run.write(name, content)
        deform(run, name, OK)


@case
def buffers_truncated_at_every_byte(run):
    start(run)
    model = Model()
    run.write("m.gltf", model.text("m.bin"))
    for size in range(0, len(model.data), 7):
        run.write("m.bin", bytes(model.data[:size]))
        done = deform(run, "m.gltf", INVALID)
        check("byteLength" in done.err[0], done.err[0])


@case
def files_beside_the_points_truncated_at_every_byte(run):
    start(run)
    for made in (foam.Foam(), foam.Foam(True)):
        for name, content in made.files().items():
            run.write(name, content)
        for name, content in made.files().items():
            end = content.index(b"object")
            step = max(1, (len(content) - end) // (20 if SANITIZED else 60))
            for size in [0, 1, 200, *range(end, len(content), step)] if name != "points" else []:
                run.write(name, content[:size])
                done = deform(run, "points", (OK, *REFUSALS))
                check(done.code == OK or done.err[0].startswith(name), f"{name}, {size} bytes: {done.err}")
            run.write(name, content)


@case
def what_is_no_file(run):
    """Folders, pipes that nobody writes to, devices, sockets: exit 3 at once, wherever a file is named."""
    start(run)
    run.write("a.obj", CUBE)
    os.mkfifo(run.path("pipe"))
    run.folder_of("folder")
    for what in ("folder", "pipe", "/dev/zero", "/dev/full"):
        for ending in (".obj", ".glb", ".gltf", ".ply", ".off", ".stl", ".vtk", ".su2", ".vtu", ".msh", "/points", ".json"):
            name = "x" + ending
            os.makedirs(run.path(os.path.dirname(name)), exist_ok=True)
            os.symlink(what if what.startswith("/") else run.path(what), run.path(name))
            if ending == ".json":
                run.ffd("deform", "a.obj", "out.obj", "-l", name, code=IO)
                run.ffd("embed", "a.obj", "-l", name, "-o", "out.npy", code=IO)
            else:
                deform(run, name, IO)
                run.ffd("compare", "a.obj", name, code=IO)
                run.ffd("lattice", "new", name, "-o", "n.json", code=IO)
            run.ffd("info", name, code=IO)
            run.remove(name)
    os.mkfifo(run.path("m.bin"))
    run.write("m.gltf", Model().text("m.bin"))
    deform(run, "m.gltf", IO)


@case
def streams_that_are_given_are_read(run):
    """A pipe by the name of a descriptor is what shells pass for <(...)."""
    start(run)
    reading, writing = os.pipe()
    os.write(writing, CUBE.encode())
    os.close(writing)
    run.ffd("deform", f"/dev/fd/{reading}", "out.obj", "--input-format", "obj", "-l", "l.json", "-q",
            pass_fds=(reading,))
    os.close(reading)
    check(run.text("out.obj").startswith("# a cube\n"), "the pipe was not read")


@case
def links_and_uris_that_lead_out(run):
    """A pipe lies where each of them leads: who opens it, waits for ever."""
    start(run)
    run.folder_of("m/in")
    os.mkfifo(run.path("outside.bin"))
    os.symlink("..", run.path("m/up"))
    os.symlink("../outside.bin", run.path("m/link.bin"))
    os.symlink(run.folder, run.path("m/in/far"))
    os.symlink("link.bin", run.path("m/twice.bin"))
    os.symlink("loop.bin", run.path("m/loop.bin"))
    absolute = run.path("outside.bin")
    for uri in ("up/outside.bin", "link.bin", "twice.bin", "loop.bin", "in/far/outside.bin", "../outside.bin",
                "%2e%2e/outside.bin", "%2E%2E%2Foutside.bin", ".%2e/outside.bin", "in/../../outside.bin", absolute,
                "file://" + absolute, "file:outside.bin", "FILE:" + absolute, "%2F" + absolute[1:], "//" + absolute,
                "..\\outside.bin", "\\outside.bin", "C:\\outside.bin", "x:outside.bin", "./../outside.bin",
                "in//..//..//outside.bin", "up%2Foutside.bin", "\u002e\u002e/outside.bin", "../m/../outside.bin"):
        for ending, content in ((".gltf", Model().text(uri)), (".glb", glb(json.loads(Model().text(uri)), b""))):
            name = "m/m" + ending
            run.write(name, content)
            done = deform(run, name, IO)
            check(done.err[0].startswith(name + ":"), done.err[0])
            run.ffd("info", name, code=IO)
    run.write("m/m.gltf", Model().text("m%00.bin"))
    deform(run, "m/m.gltf", INVALID)


@case
def only_the_folder_is_looked_into(run):
    """What the system is asked to open: the files that are named, and nothing of the folders beside them."""
    if SANITIZED or not shutil.which("strace"):
        return
    start(run)
    run.folder_of("m")
    run.write("other/m.mtl", "newmtl a\n")
    run.write("m/m.obj", "mtllib ../other/m.mtl\nusemtl a\n" + CUBE)
    model = Model()
    model.asset["images"] = [{"uri": "../other/m.mtl"}]
    run.write("m/m.gltf", model.gltf())
    for name in ("m/m.obj", "m/m.gltf"):
        log = run.path("strace.log")
        done = subprocess.run(["strace", "-f", "-o", log, "-e", "trace=open,openat,openat2", FFD, "info", name],
                              cwd=run.folder, capture_output=True, check=False, timeout=60)
        with open(log, encoding="utf-8", errors="replace") as file:
            opened = [line for line in file if "ENOENT" not in line]
        if done.returncode != OK and not any(name in line for line in opened):
            return  # strace itself is not allowed to run
        equal(done.returncode, OK, name)
        check(any(f'"{name}"' in line for line in opened), f"{name} is not among {opened}")
        check(not any("other" in line for line in opened), f"{name}: {opened}")


def images_outside(run, uri):
    model = Model()
    model.asset["images"] = [{"uri": uri}]
    run.write("m/m.gltf", model.gltf())


@case
def images_that_lead_out_are_not_copied(run):
    start(run)
    run.folder_of("m")
    run.folder_of("o")
    os.mkfifo(run.path("outside.png"))
    os.symlink("../outside.png", run.path("m/link.png"))
    for uri in ("../outside.png", "link.png", "%2e%2e/outside.png"):
        images_outside(run, uri)
        run.ffd("deform", "m/m.gltf", "o/m.gltf", "-l", "l.json", "-q", code=IO)
        equal(run.names("o"), [], uri)


def peak(run, *words, code):
    """Peak memory of a run, in bytes. Without MALLOC_PERTURB_, which makes memory of what never would be any."""
    environment = {name: value for name, value in os.environ.items() if name != "MALLOC_PERTURB_"}
    subprocess.run([MEASURE_PEAK, run.path("peak"), FFD, *words], cwd=run.folder, env=environment, capture_output=True, check=True,
                   timeout=300)
    ended, used = run.text("peak").split()
    run.remove("peak")
    check(int(ended) in code, f"{words}: exit {int(ended)}, expected {code}")
    return int(used)


def zeros(count, nodes=1, primitives=1):
    """Much from little: accessors without bytes, meshes shown many times."""
    asset = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(nodes))}],
             "nodes": [{"mesh": 0, "translation": [n / 16, 0, 0]} for n in range(nodes)],
             "meshes": [{"primitives": [{"attributes": {"POSITION": 0}} for _ in range(primitives)]}],
             "accessors": [{"componentType": 5126, "count": count, "type": "VEC3", "min": [0, 0, 0], "max": [0, 0, 0]}]}
    return json.dumps(asset)


def instances(vertices, nodes):
    """A small buffer that many nodes show: vertices * nodes points."""
    points = [[(n * 7 % 16) / 8 - 1, (n * 5 % 16) / 8 - 1, (n * 3 % 16) / 8 - 1] for n in range(vertices)]
    asset, data = gltf_json(points, nodes=[{"mesh": 0, "translation": [n / 4096, 0, 0]} for n in range(nodes)])
    return glb(asset, data)


def drawn(primitives):
    """Indices that many primitives share: 12000 triangles each."""
    model = Model()
    model.primitive["indices"] = model.add(TRIANGLES * 2000, "SCALAR", USHORT, target=34963)
    model.asset["meshes"][0]["primitives"] = [model.primitive] * primitives
    return model.glb()


def crowd(primitives, nodes):
    """Primitives * nodes that are shown."""
    model = Model()
    model.asset["meshes"][0]["primitives"] = [model.primitive] * primitives
    model.asset["nodes"] = [{"mesh": 0}] * nodes
    model.asset["scenes"][0]["nodes"] = list(range(nodes))
    return model.glb()


# Vertices, and nodes that show them: each time counts as a vertex of the file. With a sanitizer, which leaves no memory
# to be measured, fewer are the same; so are all things of which a file has many.
SHOWN = 400, 100 if SANITIZED else 4000
ZEROS = 2**16 if SANITIZED else 2**22
MANY = 10**4 if SANITIZED else 10**6

# The name, and what makes the file.
HUNGRY = [
    *((f"{count}/points", lambda count=count: foam.Foam().header("vectorField", "points") + b"%d{(0 0 0)}" % count)
      for count in (520000, 4000000000)),
    ("zeros.gltf", lambda: zeros(ZEROS)),
    ("more-zeros.gltf", lambda: zeros(2**62)),
    ("zeros-shown.gltf", lambda: zeros(MANY, nodes=500)),
    ("zeros-drawn.gltf", lambda: zeros(3 * ZEROS // 4, primitives=500)),
    ("drawn.glb", lambda: drawn(3000)),
    ("crowd.glb", lambda: crowd(3000, 20000)),
    ("shown.glb", lambda: instances(*SHOWN)),
    ("nested.gltf", lambda: '{"asset":{"version":"2.0"},"extras":' + "[" * MANY),
    ("members.gltf", lambda: '{"asset":{"version":"2.0"},"extras":[' + "0," * MANY + "0]}"),
    *((key + ".gltf", lambda key=key, each=each: json.dumps({"asset": {"version": "2.0"}, key: [each] * (3 * MANY // 10)}))
      for key, each in (("nodes", {}), ("scenes", {}), ("meshes", {"primitives": []}), ("materials", {}), ("images", {}),
                        ("skins", {"joints": [0]}), ("buffers", {"byteLength": 0}), ("animations", {}))),
    ("line.obj", lambda: "v " + "1" * (10 * MANY) + " 0 0\n"),
    ("face.obj", lambda: CUBE + "f" + " 1" * MANY + "\n"),
    ("continued.obj", lambda: "v 0 0 0\nf 1 \\\n" + "1 \\\n" * MANY),
    ("groups.obj", lambda: CUBE + "g a b\nusemtl c\n" * (MANY // 10)),
    ("count.ply", lambda: PLY.replace("vertex 8", "vertex 4611686018427387904")),
    ("count-31.ply", lambda: PLY.replace("vertex 8", "vertex 2147483648")),
    ("count-face.ply", lambda: PLY.replace("face 2", "face 4294967296")),
    ("nothing-each.ply", lambda: PLY.replace("element face 2", "element nothing 9223372036854775807\nelement face 2")),
    ("list.ply", lambda: PLY_BYTES.replace(b"uchar uint", b"uint  uint") + b"\xff" * 64),
    ("count.off", lambda: OFF.replace("3 1 0", "2147483648 1 0")),
    ("count-62.off", lambda: OFF.replace("3 1 0", "3 4611686018427387904 0")),
    ("corners.off", lambda: OFF.replace("3 0 1 2", "2147483647 0 1 2")),
    ("count.stl", lambda: STL_BYTES[:80] + b"\xff\xff\xff\xff" + STL_BYTES[84:]),
    ("facets.stl", lambda: "solid\n" + "facet normal 0 0 1\n" * (MANY // 10)),
]


@case
def memory_stays_near_the_size_of_the_file(run):
    """At most 20 times the file and 100 MB, whatever the file states."""
    start(run)
    wrong = []
    for name, make in HUNGRY:
        run.write(name, make())
        size = os.path.getsize(run.path(name))
        if name == "shown.glb":
            size += 12 * SHOWN[0] * SHOWN[1]
        output = output_of(run, name)
        for words in (("deform", name, output, "-l", "l.json", "-q", "--force"), ("info", name),
                      ("check", name, "-l", "l.json", "-q")):
            if SANITIZED:  # its memory cannot be told from the program's
                run.ffd(*words, code=(OK, *REFUSALS), err=None if words[0] != "info" else anything)
                continue
            used = peak(run, *words, code=(OK, *REFUSALS))
            if used > 20 * size + 100 * MEGABYTE:
                wrong.append(f"{words[0]} {name}: {used // MEGABYTE} MB for {size} bytes")
        run.remove(name)
    check(not wrong, "\n".join(wrong))


@case
def numbers_at_the_ends_of_their_range(run):
    """Offsets and lengths that wrap where they are added in 64 bits, and counts that do where they are
    multiplied."""
    start(run)
    for path in ("accessors/0/count", "accessors/0/byteOffset", "bufferViews/0/byteOffset", "bufferViews/0/byteLength",
                 "bufferViews/0/byteStride", "buffers/0/byteLength", "nodes/0/mesh", "meshes/0/primitives/0/indices",
                 "accessors/2/count", "accessors/2/byteOffset"):
        for value in (2**31 - 1, 2**31, 2**32 - 1, 2**32, 2**53 - 1, 2**62, 2**63 - 1, 2**63, 2**64 - 1, 2**64, 1e300,
                      -1, -2**63):
            run.write("m.glb", Model().set(path, value).glb())
            done = deform(run, "m.glb", INVALID, "--strict")
            check(done.err[0].startswith("m.glb:/"), done.err[0])
            run.ffd("info", "m.glb", "--strict", code=INVALID)
            # What the faces are, and the end of the buffer, need not be known.
            liberal = path in ("buffers/0/byteLength", "meshes/0/primitives/0/indices")
            deform(run, "m.glb", (OK, INVALID) if liberal else INVALID)


@case
def marks_zeros_and_empty_files(run):
    start(run)
    for name, content in small_files():
        run.write(name, b"")
        deform(run, name, (OK, INVALID))
        run.write(name, b"\0" * 100)
        deform(run, name, (OK, INVALID))
        run.write(name, b"\xef\xbb\xbf" + content)
        # A mark is let pass before JSON and OBJ.
        deform(run, name, OK if name in ("m.gltf", "m.obj") else (OK, INVALID))
        if not name.startswith("b.") and not name.endswith(".glb"):
            middle = len(content) // 2
            run.write(name, content[:middle] + b"\0" + content[middle:])
            deform(run, name, (OK, INVALID))


@case
def a_locale_with_a_decimal_comma(run):
    """The names of locales that machines may have; what is not there is the same as C."""
    start(run)
    for name, content in small_files():
        run.write(name, content)
        deform(run, name, OK)
        expected = run.read(output_of(run, name))
        for locale in ("de_DE.UTF-8", "de_DE", "fr_FR.utf8"):
            deform(run, name, OK, env={**os.environ, "LC_ALL": locale})
            equal(run.read(output_of(run, name)), expected, f"{name} under {locale}")


main()
