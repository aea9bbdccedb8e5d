#!/usr/bin/env python3
"""What test_corpus.py does not see it does not prove: outputs of the program are damaged, each in one way that one
of the checks is there for, and that check has to say so.

    test_blind.py FFD"""

import dataclasses
import os
import re
import shutil
import struct
import sys
import tempfile

from test_corpus import Corpus, Row, requirements

# Positions, texture coordinates, normals, indices at 0, 288, 480, 768 of the .bin.
CUBES = "gltf/draco/two_objects_inverse_materials.gltf"
SPHERE = "gltf/draco/sphere_lights.gltf"  # tangents at 8064
BEVEL = "obj/ufbx/max7_cube_normals.obj"
SPLIT = "obj/ufbx/blender_279_default.obj"  # normals shared by corners: some are added
PLY = "other/draco/cube_att.ply"
OFF = "other/assimp/OFF/Cube.off"
STL = "other/pmp/stl/icosahedron_binary.stl"


def edit(path, change):
    with open(path, "rb") as file:
        data = file.read()
    with open(path, "wb") as file:
        file.write(change(data))


def buffer_of(path):
    return os.path.splitext(path)[0] + ".bin"


def add_ulps(at, count):
    """The float at this place of the .bin, by some steps."""
    def change(data):
        bits = struct.unpack_from("<I", data, at)[0]
        return data[:at] + struct.pack("<I", bits + count) + data[at + 4:]
    return lambda path: edit(buffer_of(path), change)


def flip(at):
    return lambda path: edit(buffer_of(path), lambda data: data[:at] + bytes([data[at] ^ 1]) + data[at + 1:])


def text(pattern, replacement):
    """The first match in the file."""
    def change(data):
        changed = re.sub(pattern, replacement, data, count=1)
        if changed == data:
            raise AssertionError(f"{pattern} is not there")
        return changed
    return lambda path: edit(path, change)


def byte(at):
    return lambda path: edit(path, lambda data: data[:at] + bytes([data[at] ^ 0x40]) + data[at + 1:])


# (model, lattice whose output is damaged, what is done to it, the check that has to see it)
CASES = {
    "a byte of a copy": (CUBES, "still", flip(700), "same"),
    "a space in the copy's JSON": (CUBES, "still", text(rb'"asset"', b'"asset" '), "same"),
    "a position by two floats": (CUBES, "twist", add_ulps(0, 2), "values"),
    "one of two equal positions": (CUBES, "twist", add_ulps(0, 2), "equal"),
    "a normal by two floats": (CUBES, "twist", add_ulps(480 + 8, 2), "values"),
    "a tangent": (SPHERE, "twist", add_ulps(8064, 2), "values"),
    "a tangent's handedness": (SPHERE, "twist", flip(8064 + 15), "values"),
    "a position that had to stay": (CUBES, "part", add_ulps(0, 1), "values"),
    "a byte of a texture coordinate": (CUBES, "twist", flip(290), "only"),
    "a byte of the indices": (CUBES, "twist", flip(768), "only"),
    "the layout of the JSON": (CUBES, "twist", text(rb'"asset" :', b'"asset":'), "only"),
    "the text of a number": (CUBES, "twist", text(rb"-2\.8181216716766357", b"-2.81812167167663570"), "only"),
    "a name": (CUBES, "twist", text(rb"Icosphere", b"Icosfere"), "only"),
    "a new key": (CUBES, "twist", text(rb'"asset" :', b'"extras" : 1, "asset" :'), "only"),
    "a maximum": (CUBES, "twist", text(rb'"max" : \[', b'"max" : [ 7,'), "only"),
    "a minimum's value": (CUBES, "twist", text(rb'"min"\s*:\s*\[\s*-', b'"min" : [ -1'), "valid"),
    "a coordinate of an OBJ": (BEVEL, "twist", text(rb"\nv +(-?)\d", rb"\nv \g<1>9"), "values"),
    "a normal of an OBJ": (BEVEL, "twist", text(rb"\nvn +(-?)\d", rb"\nvn \g<1>9"), "values"),
    "a comment of an OBJ": (BEVEL, "twist", text(rb"#", b"##"), "only"),
    "a face of an OBJ": (BEVEL, "twist", text(rb"\nf +(\d+)", rb"\nf \g<1>0"), "only"),
    "a group of an OBJ": (BEVEL, "twist", text(rb"\ng ", b"\ng x"), "only"),
    "a longer number": (BEVEL, "twist", text(rb"(\nv +\S+\.\d+)", rb"\g<1>00000000000000001"), "only"),
    "a normal of a face that was split": (SPLIT, "twist", text(rb"//\d\d", b"//1"), "values"),
    "a vertex of a face that was split": (SPLIT, "twist", text(rb"\nf 5//", b"\nf 1//"), "only"),
    "a lost normal": (SPLIT, "twist", text(rb"\nvn [^\n]*\nvn", b"\nvn"), "values"),
    "a coordinate of an OBJ with more normals": (SPLIT, "twist", text(rb"\nv +(-?)\d", rb"\nv \g<1>9"), "values"),
    "a longer number beside more normals": (SPLIT, "twist", text(rb"(\nv +\S+\.\d+)", rb"\g<1>00000000000000001"), "only"),
    "a group of an OBJ with more normals": (SPLIT, "twist", text(rb"\ng ", b"\ng x"), "only"),
    "a line end": (BEVEL, "still", text(rb"\r?\n", b"\r"), "same"),
    "a texture coordinate of a PLY": (PLY, "twist", text(rb"\n3 0", b"\n3 1"), "only"),
    "a number of a PLY": (PLY, "twist", text(rb"(end_header\r?\n\S+ +-?0\.)\d", rb"\g<1>9"), "values"),
    "a face of an OFF": (OFF, "twist", text(rb"\n4 +0", b"\n4  1"), "only"),
    "the header of an STL": (STL, "twist", byte(3), "only"),
    "the normal of an STL": (STL, "twist", byte(84 + 2), "only"),
    "a corner of an STL": (STL, "twist", byte(84 + 12 + 2), "values"),
}


class Outputs:
    """What the program makes of a model in scene space, by the lattices of the cases, and what the checks find in it."""

    def __init__(self, corpus, model):
        self.corpus, self.model = corpus, model
        self.jobs = {job.lattice: job for job in corpus.jobs(Row(model), "scene")}
        for job in self.jobs.values():
            corpus.run(job)
            shutil.copytree(os.path.dirname(job.target), self.sound(job))

    @staticmethod
    def sound(job):
        return os.path.dirname(job.target) + ".sound"

    def findings(self, lattice, damage):
        """The row of the model where this has been done to one output of the program."""
        job = dataclasses.replace(self.jobs[lattice], row=Row(self.model))
        folder = os.path.dirname(job.target)
        shutil.rmtree(folder)
        shutil.copytree(self.sound(job), folder)
        damage(job.target)
        self.corpus.look(job)
        self.corpus.settle()
        return job.row


def main():
    root, node_folder = requirements()
    blind = []
    with tempfile.TemporaryDirectory() as folder:
        corpus = Corpus(sys.argv[1], root, folder, {"scene": ("twist", "part")}, node_folder)
        outputs = {model: Outputs(corpus, model) for model in {case[0] for case in CASES.values()}}
        for model, lattice in sorted({case[:2] for case in CASES.values()}):
            sound = outputs[model].findings(lattice, lambda path: None)
            blind += [f"{model}, undamaged: {line}" for line in sound.failures()]
        for name, (model, lattice, damage, check) in CASES.items():
            row = outputs[model].findings(lattice, damage)
            if not row.wrong[check]:
                blind.append(f"{name}: '{check}' does not see it; others: {row.failures()}")
        corpus.close()
    for line in blind:
        print(line)
    print(f"{len(CASES)} damages, {len(blind)} findings")
    sys.exit(1 if blind else 0)


if __name__ == "__main__":
    main()
