"""Meshes of all formats, lattices and options, for tests of what jobs of one run have in common."""

import struct

from harness import CUBE, CUBE_FACES, glb, gltf_json, lattice

NORMALS = [[0.0, 0.0, 1.0]] * 6
POINTS = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0.5], [0, 0, 1], [-1, 0.25, 1]]


def write_meshes(run):
    """A mesh in every format. Returns their names."""
    run.write("m.obj", CUBE + "vn 0 0 1\nvn 1 0 0\nf 1//1 2//2 3//1\n")
    asset, data = gltf_json(POINTS, normals=NORMALS)
    run.write("m.glb", glb(asset, data))
    asset, data = gltf_json(POINTS, normals=NORMALS, uri="m.bin")
    run.write("m.gltf", asset)
    run.write("m.bin", data)
    run.write("m.off", "OFF\n8 6 0\n" + "".join(line[2:] + "\n" for line in CUBE.splitlines() if line.startswith("v "))
              + "".join("4 " + " ".join(str(i - 1) for i in face) + "\n" for face in CUBE_FACES))
    header = "ply\nformat %s 1.0\nelement vertex 6\n" + "".join(f"property {{0}} {c}\n" for c in "xyz") + "end_header\n"
    run.write("m.ply", (header % "ascii").format("double") + "".join("%r %r %r\n" % tuple(p) for p in POINTS))
    run.write("b.ply", (header % "binary_little_endian").format("float").encode() + b"".join(struct.pack("<3f", *p) for p in POINTS))
    run.write("m.stl", b" " * 80 + struct.pack("<I", 2) + b"".join(
        struct.pack("<12fH", 0, 0, 1, *POINTS[i], *POINTS[i + 1], *POINTS[i + 2], 0) for i in range(2)))
    return ["m.obj", "m.glb", "m.gltf", "m.off", "m.ply", "b.ply", "m.stl"]


LATTICES = {
    "twist.json": lattice(moves=[{"twist": {"axis": "z", "degrees": 70}}]),
    "bend.json": lattice(moves=[{"bend": {"axis": "z", "toward": [1, 0, 0], "degrees": 50}}]),
    "round.json": lattice(rest={"box": "mesh", "margin": 0.1}, units="box", moves=[{"by": [0, 0.25, 0]}]),
    "half.json": lattice(high=(2, 2, 0.25), moves=[{"by": [0.1, 0, 0]}]),
    "curved.json": lattice(moves=[{"at": [3, 3, 3], "by": [1, 1, 1]}], rest={"points": [
        [-2 + 4 * i / 3 + 0.1 * ((i + j * k) % 2), -2 + 4 * j / 3, -2 + 4 * k / 3 + 0.05 * (i % 2)]
        for k in range(4) for j in range(4) for i in range(4)]}),
}
COMBINATIONS = [(["twist.json"], {}), (["bend.json"], {}), (["twist.json", "bend.json"], {}), (["round.json"], {}),
                (["half.json"], {"outside": "extend"}), (["half.json"], {"outside": "extend", "falloff": 0.5}),
                (["curved.json"], {}), (["curved.json"], {"normals": "recompute"}), (["curved.json", "twist.json"], {"normals": "keep"}),
                (["twist.json"], {"threads": 1, "isa": "scalar"}), (["half.json"], {"fail-on": "outside"}), (["twist.json"], {"space": "mesh"})]


def words(options):
    return [str(x) for name, value in options.items() for x in ("--" + name, value)]
