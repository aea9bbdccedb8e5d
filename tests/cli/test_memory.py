#!/usr/bin/env python3
"""No file takes more memory than 20 times its size and 100 MB, whatever it shows; what needs more is refused
(exit 7), and --memory allows it; however many threads there are. Peaks are measured from outside; arguments: the
programs packed_glb and measure_peak."""

import json
import os
import resource
import struct
import subprocess
import sys
import zlib

from harness import FFD, LIMIT, OK, case, check, equal, main

PACKED_GLB, MEASURE_PEAK = os.path.abspath(sys.argv.pop(1)), os.path.abspath(sys.argv.pop(1))
MOST, MOST_PER_BYTE = 100e6, 20
MOST_OF_VIEWS = 420e6  # 400 MB are published; what is taken is estimated, to a twentieth
# What is allowed beside 20 times the file where nothing is shown several times: less than the published 100 MB, so
# that files of a third of the size leave no memory for a copy that is not needed. What info says of edges may take
# all that is published, and a GLB is put together in tables, as a page is.
MOST_OF_TEXT = {"info": MOST, "glb": 70e6, "view": 70e6, "picture": MOST}
MOST_OF_OTHERS = 50e6
LATTICE = {"format": "ffd-lattice", "version": 1, "size": [4, 4, 4], "units": "box",
           "rest": {"box": "mesh", "margin": 0.1}, "moves": [{"twist": {"axis": [0, 0, 1], "degrees": 40}}]}
# Filling what is allocated, as meson asks for, makes memory of what never would be any.
ENVIRONMENT = {name: value for name, value in os.environ.items() if name != "MALLOC_PERTURB_"}


def measure(run, arguments):
    """Exit code, peak of memory in bytes, and the last line of stderr."""
    with open(run.path("err"), "wb+") as err, open(run.path("out"), "wb") as out:
        subprocess.run([MEASURE_PEAK, run.path("peak"), FFD, *arguments],
                       cwd=run.folder, env=ENVIRONMENT, stdout=out, stderr=err, check=True)
        err.seek(0)
        lines = err.read().decode().splitlines()
    code, peak = run.text("peak").split()
    return int(code), int(peak), lines[-1] if lines else ""


COMMANDS = {
    "deform": ["deform", "IN", "out.ENDING", "-l", "l.json", "--force"],
    "report": ["deform", "IN", "out.ENDING", "-l", "l.json", "--force", "--report", "r.json"],
    "recompute": ["deform", "IN", "out.ENDING", "-l", "l.json", "--force", "--normals", "recompute"],
    "morph": ["deform", "IN", "out.glb", "-l", "l.json", "--force", "--as-morph", "x"],
    "morphs": ["deform", "IN", "out.glb", "--force", "--morph", "x=l.json", "--morph", "y=l.json", "--clip", "c: 0, 1 x=1"],
    "check": ["check", "IN", "-l", "l.json"],
    "embed": ["embed", "IN", "-l", "l.json", "-o", "e.npy", "--force"],
    "info": ["info", "IN", "--json"],
    "obj": ["deform", "IN", "o.obj", "-l", "l.json", "--force"],
    "glb": ["deform", "IN", "o.glb", "-l", "l.json", "--force"],
    "ply": ["deform", "IN", "o.ply", "-l", "l.json", "--force"],
    "stl": ["deform", "IN", "o.stl", "-l", "l.json", "--force"],
    "view": ["view", "IN", "-l", "l.json", "-o", "p.html", "--force"],
    "picture": ["view", "IN", "-l", "l.json", "-o", "p.png", "--force"],
}


def run_bounded(run, name, command, arguments, most):
    """Runs a command whose peak must stay within most bytes; returns its exit code."""
    code, peak, line = measure(run, arguments)
    if os.environ.get("FFD_PEAKS"):
        print(f"{name:16s} {command:10s} exit {code} {peak / 1e6:7.1f} of {most / 1e6:7.1f} MB {line[:100]}")
    check(code in (OK, LIMIT), name, command, code, line)
    check(code == OK or "(--memory raises this)" in line, name, command, line)
    check(peak <= most, f"{name} {command}: {peak / 1e6:.1f} MB of {most / 1e6:.1f}")
    return code


def run_all(run, name, commands, is_text=False):
    """Runs the commands; returns the exit code of each."""
    ending = name.rsplit(".", 1)[1]
    size = os.path.getsize(run.path(name))
    run.write("l.json", json.dumps(LATTICE))
    codes = {}
    for command in commands:
        arguments = [name if a == "IN" else a.replace("ENDING", ending) for a in COMMANDS[command]]
        most = (MOST_OF_TEXT.get(command, MOST_OF_OTHERS) if is_text else MOST) + MOST_PER_BYTE * size
        is_view = command in ("view", "picture")
        # The scratch memory of threads that run at the same time is part of what a view may take, some 0.7 MB for each. With few
        # threads a text leaves no memory for a copy that is not needed; one text is drawn with many, too.
        many, few = {64: max(most, MOST_OF_VIEWS) if is_view else most}, {8: most}
        bounds = (few if name != "faces.obj" else {**few, **many}) if is_text and is_view else many
        for threads, bound in bounds.items():
            codes[command] = run_bounded(run, name, command, arguments + ([] if command == "info" else ["--threads", str(threads)]),
                                         bound)
    return codes


def glb(content, data=b""):
    text = json.dumps({"asset": {"version": "2.0"}, **content}, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    data += b"\0" * (-len(data) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text
    if data:
        chunks += struct.pack("<II", len(data), 0x4E4942) + data
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def scene(nodes):
    return {"nodes": nodes, "scenes": [{"nodes": list(range(len(nodes)))}], "scene": 0}


def quantized(count, accessors, primitives, nodes=1):
    """count vectors of bytes, seen through accessors, which primitives name."""
    data = bytes((i * i >> 3) % 251 for i in range(4096)) * (4 * count // 4096 + 1)
    return glb({"extensionsUsed": ["KHR_mesh_quantization"], "extensionsRequired": ["KHR_mesh_quantization"],
                "buffers": [{"byteLength": 4 * count}],
                "bufferViews": [{"buffer": 0, "byteLength": 4 * count, "byteStride": 4}],
                "accessors": [{"bufferView": 0, "componentType": 5120, "count": count, "min": [-128] * 3,
                               "max": [127] * 3, **accessor} for accessor in accessors],
                "meshes": [{"primitives": [{"mode": 0, **primitive} for primitive in primitives]}],
                **scene([{"mesh": 0, "translation": [i, 0, 0]} for i in range(nodes)])}, data[:4 * count])


POSITION = {"type": "VEC3"}
DIRECTIONS = [POSITION, {"type": "VEC3", "normalized": True}, {"type": "VEC4", "normalized": True}]
ALL = ["deform", "report", "recompute", "morph", "check", "embed", "info", "obj", "glb", "ply", "stl", "view", "picture"]
OF_GLTF = [command for command in ALL if command != "glb"]
# Vertices in pieces, twice, with the faces, with u,v,w, described, and in another format. The other commands take what one of
# these takes.
EACH_WAY = ["deform", "morph", "check", "embed", "info", "obj", "view", "picture"]


def of_text(ending, commands=ALL):
    return [command for command in commands if command not in ("morph", ending)]


@case
def compressed_by_draco(run):
    for kind, side, refused in (("edgebreaker", 500, False), ("edgebreaker", 1100, True), ("sequential", 400, False)):
        subprocess.run([PACKED_GLB, kind, str(side), run.path("a.glb")], check=True)
        codes = run_all(run, "a.glb", OF_GLTF if refused else EACH_WAY if kind == "edgebreaker" else ["deform", "morphs", "info", "obj"])
        equal(codes["deform"], LIMIT if refused else OK, f"{kind} {side}")
        if refused:
            code, peak, line = measure(run, ["deform", "a.glb", "b.glb", "-l", "l.json", "--memory", "1G"])
            equal(code, OK, line)
            check(peak > MOST + MOST_PER_BYTE * os.path.getsize(run.path("a.glb")), "the limit was not needed", peak)


@case
def compressed_by_meshopt(run):
    """What the larger file is refused for, the smaller one has memory for."""
    for side, refused, commands in ((600, False, ["check", "obj"]), (1200, True, OF_GLTF)):
        subprocess.run([PACKED_GLB, "meshopt", str(side), run.path("a.glb")], check=True)
        codes = run_all(run, "a.glb", [*commands, "view"] if "view" not in commands else commands)
        equal(codes.get("deform", OK), OK, side)
        equal([codes["check"], codes["obj"]], [LIMIT if refused else OK] * 2, side)


@case
def recomputing_many_quantized_normals_passes_the_limit(run):
    """What the larger file is refused for, the smaller one has memory for."""
    run.write("small.glb", quantized(200000, DIRECTIONS, [{"attributes": {"POSITION": 0, "NORMAL": 1, "TANGENT": 2}}]))
    run.write("large.glb", quantized(2000000, DIRECTIONS, [{"attributes": {"POSITION": 0, "NORMAL": 1, "TANGENT": 2}}]))
    both = ["recompute", "check"]
    equal(run_all(run, "small.glb", both), dict.fromkeys(both, OK))
    codes = run_all(run, "large.glb", [*both, "deform", "morph", "morphs", "embed", "info", "obj", "stl"])
    equal(codes, {**dict.fromkeys(codes, OK), **dict.fromkeys(both, LIMIT)})


@case
def the_same_bytes_shown_again(run):
    def shown(count, accessors, nodes, **more):
        primitives = [{"attributes": {"POSITION": i}, **more} for i in range(accessors)]
        return quantized(count, [POSITION] * accessors, primitives, nodes)

    near, beyond = {"deform": OK, "obj": LIMIT}, {"deform": LIMIT, "check": LIMIT, "info": LIMIT}
    others = [command for command in OF_GLTF if command not in EACH_WAY]  # each once, and one again
    for content, expected in ((shown(25000, 100, 1), near), (shown(25000, 400, 1), beyond),
                              (shown(10000, 1, 600), near), (shown(10000, 1, 1600), beyond),
                              (shown(1000000, 1, 11), near), (shown(1000000, 1, 300), beyond),
                              (shown(4, 250, 250), {"deform": OK}), (shown(4, 600, 600), beyond),
                              (shown(4, 100, 6, targets=[{"POSITION": i} for i in range(100)]), {"deform": OK}),
                              (shown(4, 300, 30, targets=[{"POSITION": 0}] * 300), beyond)):
        run.write("a.glb", content)
        commands = EACH_WAY
        if expected is beyond:
            commands, others = [*EACH_WAY, others[0]], [*others[1:], others[0]]
        codes = run_all(run, "a.glb", commands)
        equal({command: codes[command] for command in expected}, expected)


@case
def a_short_file_of_many_instances_is_drawn(run):
    """A million triangles by 40 nodes need no --memory to be looked at, though check asks for it; what takes more is refused."""
    side = 112
    corners = struct.pack(f"<{6 * side * side}I", *(k for i in range(side) for j in range(side)
                                                   for k in (i * (side + 1) + j, i * (side + 1) + j + 1, (i + 1) * (side + 1) + j,
                                                             (i + 1) * (side + 1) + j, i * (side + 1) + j + 1, (i + 1) * (side + 1) + j + 1)))
    points = struct.pack(f"<{3 * (side + 1) ** 2}f", *(x for i in range(side + 1) for j in range(side + 1) for x in (i / side, j / side, 0)))

    def content(nodes):
        return glb({"buffers": [{"byteLength": len(corners) + len(points)}],
                    "bufferViews": [{"buffer": 0, "byteLength": len(corners)},
                                    {"buffer": 0, "byteOffset": len(corners), "byteLength": len(points)}],
                    "accessors": [{"bufferView": 0, "componentType": 5125, "count": 6 * side * side, "type": "SCALAR"},
                                  {"bufferView": 1, "componentType": 5126, "count": (side + 1) ** 2, "type": "VEC3",
                                   "min": [0, 0, 0], "max": [1, 1, 0]}],
                    "meshes": [{"primitives": [{"indices": 0, "attributes": {"POSITION": 1}}]}],
                    **scene([{"mesh": 0, "translation": [i % 7, i // 7, 0]} for i in range(nodes)])}, corners + points)

    run.write("a.glb", content(40))
    equal(run_all(run, "a.glb", ["check", "view", "picture"]), {"check": LIMIT, "view": OK, "picture": OK})
    run.write("a.glb", content(400))
    equal(run_all(run, "a.glb", ["view", "picture"]), {"view": LIMIT, "picture": LIMIT})


@case
def one_file_for_many_buffers(run):
    """A file counts once; and so does what is decoded out of data URIs."""
    run.write("b.bin", bytes(1000000))
    content = {"asset": {"version": "2.0"}, "buffers": [{"byteLength": 1, "uri": f"{'./' * (i % 5)}b.bin"} for i in range(500)],
               "accessors": [{"componentType": 5126, "count": 20000, "type": "VEC3", "min": [0] * 3, "max": [0] * 3}],
               "meshes": [{"primitives": [{"mode": 0, "attributes": {"POSITION": 0}}]}],
               **scene([{"mesh": 0, "translation": [i, 0, 0]} for i in range(800)])}
    run.write("a.gltf", json.dumps(content, separators=(",", ":")))
    run.write("l.json", json.dumps(LATTICE))
    code, _, line = measure(run, COMMANDS["deform"][:1] + ["a.gltf", "c.gltf", "-l", "l.json"])
    equal(code, LIMIT, line)
    del content["nodes"][400:]
    content["scenes"][0]["nodes"] = list(range(400))
    run.write("a.gltf", json.dumps(content, separators=(",", ":")))
    code, _, line = measure(run, COMMANDS["deform"][:1] + ["a.gltf", "c.gltf", "-l", "l.json"])
    equal(code, OK, line)


@case
def many_buffers_name_one_small_file(run):
    """Such a file is mapped, though others of its size are read, for each buffer has its bytes."""
    size, count = 250000, 1000
    run.write("b.bin", bytes(size))
    content = {"asset": {"version": "2.0"}, "buffers": [{"byteLength": 1, "uri": "b.bin"}] * count}
    run.write("a.gltf", json.dumps(content, separators=(",", ":")))
    code, peak, line = measure(run, ["info", "a.gltf"])
    equal(code, OK, line)
    check(peak < size * count / 2, f"{peak / 1e6:.1f} MB")


@case
def corners_of_one_primitive(run):
    """Faces are made beside a copy of a primitive's corners."""
    content = {"accessors": [{"componentType": 5126, "count": 3, "type": "VEC3", "min": [0] * 3, "max": [0] * 3},
                             {"componentType": 5125, "count": 12000000, "type": "SCALAR"}],
               "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}], **scene([{"mesh": 0}])}
    run.write("a.glb", glb(content))
    run_all(run, "a.glb", ["info", "check", "obj"])


@case
def many_joints_stay_within_the_limit(run):
    run.write("a.gltf", json.dumps({
        "asset": {"version": "2.0"}, "skins": [{"joints": [*range(2000)]}] * 100,
        "accessors": [{"componentType": 5126, "count": 4, "type": "VEC3", "min": [0] * 3, "max": [0] * 3},
                      {"componentType": 5121, "count": 4, "type": "VEC4"},
                      {"componentType": 5126, "count": 4, "type": "VEC4"}],
        "meshes": [{"primitives": [{"mode": 0, "attributes": {"POSITION": 0, "JOINTS_0": 1, "WEIGHTS_0": 2}}]}],
        **scene([{"mesh": 0, "skin": i % 100} for i in range(2000)])}, separators=(",", ":")))
    run_all(run, "a.gltf", ["deform", "check", "info", "obj"])


@case
def long_json_stays_within_the_limit(run):
    head = b'{"asset":{"version":"2.0"},'
    run.write("nodes.gltf", head + b'"nodes":[' + b"{}," * 79999 + b"{}]}")
    run.write("accessors.gltf", head + b'"accessors":[' + b'{"componentType":5121,"count":1,"type":"SCALAR"},' * 79999
              + b'{"componentType":5121,"count":1,"type":"SCALAR"}]}')
    run.write("numbers.gltf", head + b'"extras":[' + b"0," * 2000000 + b"0]}")
    run.write("arrays.gltf", head + b'"extras":[' + b"[]," * 1500000 + b"0]}")
    run.write("objects.gltf", head + b'"extras":[' + b'{"":0},' * 700000 + b"0]}")
    run.write("roots.gltf", head + b'"nodes":[{}],"scenes":[{"nodes":[' + b"0," * 1000000 + b"0]}]}")
    for name in ("nodes.gltf", "accessors.gltf", "numbers.gltf", "arrays.gltf", "objects.gltf"):
        run_all(run, name, ["deform", "info"])
    code, peak, line = measure(run, ["info", "roots.gltf"])
    check(code == 0 and peak <= MOST + MOST_PER_BYTE * os.path.getsize(run.path("roots.gltf")), code, peak, line)


TRIANGLE = b"v 0 0 1\nv 0 1 0\nv 1 0 0\n"


@case
def short_lines_of_obj(run):
    run.write("vertices.obj", b"v 0 0 1\nv 0 1 0\nv 1 0 0\n" * 80000 + b"f 1 2 3\n")
    run.write("faces.obj", TRIANGLE + b"f 1 2 3\n" * 200000)
    run.write("polygon.obj", TRIANGLE + b"f" + b" 1 2 3" * 300000 + b"\n")
    run.write("groups.obj", TRIANGLE + b"".join(b"g %x\nf 1 2 3\n" % i for i in range(100000)))
    run.write("normals.obj", TRIANGLE + b"vn 0 0 1\n" + b"f 1//1 2//1 3//1\n" * 130000)
    # Cutting a polygon takes its time, so that few commands meet this one, and these not the other.
    run.write("cut.obj", TRIANGLE + b"f" + b" 1 2 3" * 20000 + b"\n")
    for name, commands in (("vertices.obj", ALL), ("faces.obj", [*EACH_WAY, "recompute", "glb", "stl"]),
                           ("groups.obj", ["deform", "report", "info", "glb"]),
                           ("normals.obj", ["deform", "recompute", "check", "info", "glb", "view"])):
        equal(run_all(run, name, of_text("obj", commands), is_text=True)["deform"], OK, name)
    equal(run_all(run, "polygon.obj", ["deform", "recompute", "check", "embed", "info", "glb"])["deform"], OK)
    equal(run_all(run, "cut.obj", ["stl", "view", "picture"], is_text=True), {"stl": OK, "view": OK, "picture": OK})


@case
def more_vertices_than_memory(run):
    """The positions of a large OBJ do not stay in memory."""
    block = b"".join(b"v %d %d %d\n" % (i % 10, i // 10 % 10, i // 100) for i in range(1000))
    with open(run.path("a.obj"), "wb") as file:
        for _ in range(12000):
            file.write(block)
        file.write(b"f 1 2 3\n")
    run.write("l.json", json.dumps(LATTICE))
    for normals in ("keep", "transform"):
        code, peak, line = measure(run, [*COMMANDS["deform"][:1], "a.obj", "b.obj", "-l", "l.json", "--force", "--normals", normals,
                                        "--threads", "4"])
        equal(code, OK, line)
        check(peak < 260e6, f"{peak / 1e6:.0f} MB, where positions have {12000000 * 24 / 1e6:.0f}")


@case
def more_faces_than_memory(run):
    """Nor does the text of its faces, whether they are read with the vectors or after them."""
    run.write("l.json", json.dumps(LATTICE))
    for face, normals in (("f 1//1 2//1 3//1", "keep"), ("f 1//1 2//1 3//1", "transform"), ("f -3//-1 -2//-1 -1//-1", "transform")):
        with open(run.path("a.obj"), "wb") as file:
            file.write(TRIANGLE + b"vn 0 0 1\n")
            for _ in range(12):
                file.write((face + "\nl 1 2\nf 3 2 1\n").encode() * 400000)
            size = file.tell()
        code, peak, line = measure(run, [*COMMANDS["deform"][:1], "a.obj", "b.obj", "-l", "l.json", "--force", "--normals", normals,
                                        "--threads", "4"])
        equal(code, OK, line)
        check(peak < 100e6 < 0.7 * size, f"{peak / 1e6:.0f} MB of {size / 1e6:.0f}: {face}, {normals}")


@case
def normals_of_zeros(run):
    """Those of Gaussian splats are, and nothing is held of them: neither what they are nor what becomes of them."""
    head = (f"ply\nformat binary_little_endian 1.0\nelement vertex {500 * 1000}\n"
            + "".join(f"property float {name}\n" for name in ("x", "y", "z", "nx", "ny", "nz")) + "end_header\n").encode()
    run.write("l.json", json.dumps(LATTICE))
    peaks = []
    for normal in ((0, 0, 1), (0, 0, 0)):
        run.write("a.ply", head + 500 * b"".join(struct.pack("<6f", i % 10, i // 10 % 10, i // 100, *normal) for i in range(1000)))
        code, peak, line = measure(run, ["deform", "a.ply", "b.ply", "-l", "l.json", "--force", "--threads", "2"])
        equal(code, OK, line)
        peaks.append(peak)
    check(peaks[0] - peaks[1] > 0.8 * 500 * 1000 * 2 * 24, peaks)


@case
def short_lines_of_others(run):
    head = b"ply\nformat binary_little_endian 1.0\nelement vertex 3\n" \
           b"property float x\nproperty float y\nproperty float z\n" \
           b"element face 500000\nproperty list uchar uchar vertex_indices\nend_header\n"
    run.write("faces.ply", head + struct.pack("<9f", 0, 0, 1, 0, 1, 0, 1, 0, 0) + b"\3\0\1\2" * 500000)
    run.write("vertices.ply", head.replace(b"binary_little_endian", b"ascii").replace(b"vertex 3", b"vertex 300000")
              .replace(b"face 500000", b"face 0") + b"0 0 1\n" * 150000 + b"1 1 0\n" * 150000)
    run.write("vertices.off", b"OFF\n300000 0 0\n" + b"0 0 1\n" * 150000 + b"1 1 0\n" * 150000)
    run.write("faces.off", b"OFF\n3 200000 0\n0 0 1\n0 1 0\n1 0 0\n" + b"3 0 1 2\n" * 200000)
    run.write("facets.stl", bytes(80) + struct.pack("<I", 30000) + b"".join(
        struct.pack("<12fH", 0, 0, 1, i, 0, 1, i, 1, 0, i + 0.5, 0, i % 7, 0) for i in range(30000)))
    for name, commands in (("faces.ply", ALL), ("vertices.ply", EACH_WAY), ("vertices.off", EACH_WAY),
                           ("faces.off", EACH_WAY), ("facets.stl", [*EACH_WAY, "recompute", "glb"])):
        equal(run_all(run, name, of_text(name[-3:], commands), is_text=True)["deform"], OK, name)


def png_of_zeros(side):
    """A picture of one bit a pixel."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">2I5B", side, side, 1, 0, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(bytes((side + 7) // 8 + 1) * side)) + chunk(b"IEND", b""))


@case
def textures_are_taken_from_one_budget(run):
    """Five of 161 MB, each of which fits, in a file of some kilobytes: two fit together, beside what drawing takes."""
    image = png_of_zeros(5500)
    corners = struct.pack("<15f", 0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1)
    data = corners + image
    run.write("t.glb", glb({
        "buffers": [{"byteLength": len(data)}],
        "bufferViews": [{"buffer": 0, "byteLength": 60, "byteStride": 20}]
        + [{"buffer": 0, "byteOffset": 60, "byteLength": len(image)} for _ in range(5)],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]},
                      {"bufferView": 0, "byteOffset": 12, "componentType": 5126, "count": 3, "type": "VEC2"}],
        "images": [{"bufferView": i + 1, "mimeType": "image/png"} for i in range(5)],
        "textures": [{"source": i} for i in range(5)],
        "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": i}}} for i in range(5)],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "material": i} for i in range(5)]}],
        **scene([{"mesh": 0}])}, data))
    run.write("l.json", json.dumps(LATTICE))
    run.write("jobs.jsonl", json.dumps({"in": "t.glb", "lattice": "l.json", "out": "o.glb"}))
    grey = "grey in the picture: 3 images, as image 2: needs more than the 400 MB of memory allowed (--memory raises this)"
    code, peak, line = measure(run, ["view", "t.glb", "-o", "p.png", "--size", "64x48"])
    equal((code, line), (OK, "ffd: t.glb: " + grey))
    check(peak <= MOST_OF_VIEWS, f"{peak / 1e6:.1f} MB")
    # What --memory says holds for pictures too, down to what any mesh of that size may take.
    for size, grey_ones, most in (("1M", 5, 110e6), ("250M", 4, 262e6)):
        code, peak, line = measure(run, ["view", "t.glb", "-o", "p.png", "--size", "64x48", "--force", "--memory", size])
        check(code == OK and f"grey in the picture: {grey_ones} images" in line and peak <= most, size, code, line, f"{peak / 1e6:.1f} MB")
    code, peak, line = measure(run, ["batch", "jobs.jsonl", "--view", "v", "-j", "1"])
    check(code == OK and ": 1 done" in line, line)
    check(peak <= MOST_OF_VIEWS, f"{peak / 1e6:.1f} MB")


@case
def a_report_that_is_merged_need_not_fit_into_memory(run):
    """It is mapped (mmap), and the system can evict its pages: the address space is limited to little more."""
    count = 60000
    entry = json.dumps({"input": "x" * 1400, "output": None, "status": "ok", "exit": 0, "error": None})
    run.write("big.json", '{"format": "ffd-report", "version": 1, "jobs": [' + ",".join([entry] * count) + "]}")
    room = os.path.getsize(run.path("big.json")) + (64 << 20)
    check(room > 140 << 20, "the report is not large")
    run.ffd("report", "merge", "big.json", "-o", "all.json", env=ENVIRONMENT,
            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (room, room)))
    with open(run.path("all.json"), encoding="utf-8") as file:
        equal(sum(line.startswith('    {"input"') for line in file), count)


main()
