"""mypy finds wrong words, arrays and options in scripts for the package, and nothing in right ones; its lists are those of the library."""

import importlib.util
import os
import re
import subprocess
import sys
import tempfile
import typing
import unittest

import ffd_mesh as ffd
from ffd_mesh import _description, _library, _types

BEGIN = """import numpy as np
import ffd_mesh as ffd
lat = ffd.Lattice.around(np.zeros((10, 3)), size=(6, 6, 6), degree=3)
emb = lat.embed(np.zeros((10, 3), np.float32), outside="extend", falloff=0.5)
"""
# Each line is wrong by itself; what mypy says of it.
WRONG = [
    ('lat.embed(np.zeros((10, 3)), outside="clamp")', "clamp"),
    ('lat.deform(emb, "nonsense")', "str"),
    ("lat.embed(np.zeros((10, 3), np.complex128))", "complex"),
    ('lat.moved(np.array(["a", "b"], np.str_))', "str_"),
    ('ffd.deform_file("a.obj", "b.obj", lat, normls="recompute")', "normls"),
    ('ffd.check_file("a.obj", lat, rig="stay")', "stay"),
    ('ffd.jacobian_file("a.obj", "J.npz", lat, wrt="pts")', "pts"),
    ('ffd.Lattice.box((0, 0, 0), (1, 1, 1), spacing="even")', "even"),
    ('ffd.deform_mesh(None, lat, with_result=True).points', "points"),
    ('ffd.view_file("a.obj", "a.png", camera="below")', "below"),
    ('ffd.batch("jobs.jsonl", normals="flip")', "flip"),
    ('lat.seal("C1", ["u"])', "u-"),
    ("emb.points.nonsense", "nonsense"),
    ('lat.deform(emb, gradients=True).shape', "shape"),
    ('lat.mirrored("u")', "u"),
    ('ffd.Lattice.plane((0, 0), (1, 1)).mirror("w")', "w"),
    ('ffd.Lattice.plane((0, 0), (1, 1)).deform(emb)', "Embedding"),
    ('ffd.Lattice.plane((0, 0), (1, 1)).nonsense', "nonsense"),
    ('ffd.Chain(["a.json"])', "str"),
    ('ffd.Blocks([lat]).deform(emb)', "Embedding"),
    ('ffd.Chain([lat]).embed(np.zeros((10, 3)), outside="clamp")', "clamp"),
    ('ffd.Chain([lat]).deform(ffd.Chain([lat]).embed(np.zeros((10, 3))), gradients=True).shape', "shape"),
    ("lat.parameters_jacobian(emb, 3)", "int"),
    ('lat.weights_times(emb, "x")', "str"),
]
RIGHT = """Q = lat.rest.copy()
Q[5, 2, 2] += (0, 0, 0.3)
moved = lat.deform(emb, Q, threads=2) + 1
both = lat.deform(emb, offsets=Q - lat.rest, normals=np.zeros((10, 3), np.float32), weight=[1.0] * 10, triangles=[[0, 1, 2]])
assert both.normals is not None and both.normals.shape == moved.shape
points, jacobians = lat.evaluate([[0.5, 0.5, 0.5]], jacobians=True)
more = ffd.Lattice.from_points(2 * lat.rest, knots=["clamped", "open", np.linspace(0, 1, 10)], weights=np.ones((6, 6, 6)))
box = ffd.Lattice.box(np.zeros(3), (1, 1, 1), np.array([4, 5, 6]), (2, 3, None), spacing="uniform", axes=np.eye(3))
box.refine(8, insert={"u": [0.25]}).seal("C1", ["u-", "w+"]).mirror("u").save("b.json", part="both")
B = lat.basis(emb)
displacements = B @ (Q - lat.rest).reshape(-1, 3)
derivatives = lat.parameters_jacobian(emb, {"A": 3}, threads=1) @ [1.0, 2.0] + lat.parameters_times(emb, [1, 2])
back = lat.parameters_transposed(emb, derivatives, {"A": [1, 2]}).sum() + lat.weights_transposed(emb, lat.weights_times(emb, lat.rest[..., 0]))
columns = lat.mirrored("x", at=0.5).parameter_columns[0] + "A"
plane = ffd.Lattice.plane((0, 0), [1, 2], size=(4, 5), knots=("open", [0, 0, 0, 0, 0.5, 1, 1, 1, 1])).refine(8, insert={"u": [0.2]})
flat = plane.embed([[0.5, 0.5]], outside="extend")
flat_results = plane.deform(flat, np.zeros((3, 4, 5, 2))) + 1, plane.deform(flat, normals=[[0, 1]]).normals, plane.basis(flat) @ plane.rest.reshape(-1, 2)
flat_lattices = plane.moved(plane.rest, weights=np.ones((4, 5))).seal("C1", ["u-"]).solid.rest, plane.fold_barrier(plane.rest).gradient, plane.size[1] + 1
ffd.deform_file("a.obj", "b.obj", plane)
chain = ffd.Chain([lat, box]).fit(np.zeros((10, 3)), shared_box=True).moved([Q, None])
several = chain.embed(np.zeros((10, 3), np.float32), snap=0.1)
ahead = chain.deform(several, [None, box.rest]) + chain.basis_times(several, [Q, None], threads=1)
back = chain.basis_transposed(several, ahead)[0][..., 0].sum() + chain.deform(several, normals=ahead).points.sum()
blocks = ffd.Blocks((lat, box)).embed([[0, 0, 0.5]]).blocks
mesh, result = ffd.deform_mesh(object(), lat, Q, outside="extend", with_result=True)
turned = mesh.points, result.moved + 1, result.tear.edges
result = ffd.deform_file("a.obj", "b.obj", {"a": lat, "b": "c.json"}, set={"A": 3}, only="node:a", fail_on=["folds", "tear=0.1"], snap="1e-3r")
ffd.fit(np.zeros((4, 3)), [[0, 0, 1]] * 4, exact=[0], smooth=0.5, symmetric="u")
ffd.view_file("a.obj", "a.png", lat, camera=(1, 0, 0), up="z", size=(10, 20), fail_on="folds,tear")
ffd.batch([{"in": "a.obj"}], view="shots", camera="front", in_place=True, weight="joint:Head")
"""


class Scripts(unittest.TestCase):
    @unittest.skipIf(importlib.util.find_spec("mypy") is None, "mypy is not installed")
    def test_mypy_finds_what_is_wrong(self):
        with tempfile.TemporaryDirectory() as folder:
            scripts = {f"wrong{number}.py": BEGIN + line + "\n" for number, (line, _) in enumerate(WRONG)} | {"right.py": BEGIN + RIGHT}
            for name, text in scripts.items():
                with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
                    file.write(text)
            done = subprocess.run([sys.executable, "-m", "mypy", "--strict", "--no-incremental", "--no-error-summary", *scripts], cwd=folder,
                                  capture_output=True, text=True, check=False)
        errors = [line for line in done.stdout.splitlines() if ": error: " in line]
        self.assertEqual(([line for line in errors if line.startswith("right")], done.stderr), ([], ""))
        for number, (line, words) in enumerate(WRONG):
            found = [error for error in errors if error.startswith(f"wrong{number}.py:5: ")]
            self.assertTrue(found and words in found[0], f"{line}: {found}")
        self.assertEqual(len({error.partition(":")[0] for error in errors}), len(WRONG))

    @unittest.skipIf(importlib.util.find_spec("mypy") is None, "mypy is not installed")
    def test_mypy_finds_nothing_in_the_package(self):
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run([sys.executable, "-m", "mypy", "--no-incremental", "--no-error-summary", "-p", "ffd_mesh"], cwd=folder,
                                  capture_output=True, text=True, check=False)
        self.assertEqual([line for line in done.stdout.splitlines() if ": error: " in line and "[import-untyped]" not in line], [])


class Words(unittest.TestCase):
    def test_messages_name_functions_and_keywords(self):
        with tempfile.TemporaryDirectory() as folder:
            mesh, lattice = os.path.join(folder, "a.obj"), ffd.Lattice.box((-1, -1, -1), (2, 2, 2))
            with open(mesh, "w", encoding="ascii") as file:
                file.write("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
            self.assertEqual(ffd.jacobian_file(mesh, mesh + ".npz", lattice, wrt="points")["rows"], 3)
            for run, words in ((lambda: ffd.deform_file(mesh, mesh, lattice), "output=None"),
                               (lambda: ffd.deform_file(mesh, mesh + ".obj", lattice, falloff=1), "falloff= needs outside='extend'"),
                               (lambda: ffd.deform_file(mesh, mesh + ".obj", lattice, embedding=b"x" * 200), "embed_file"),
                               (lambda: ffd.jacobian_file(mesh, mesh + ".npz", lattice), "force=True overwrites it"),
                               (lambda: ffd.jacobian_file(mesh, mesh + ".npy", lattice, wrt="points", by="points"), "give one"),
                               (lambda: ffd.jacobian_file(mesh, mesh + ".npy", lattice, wrt="pts"), "wrt must be one of 'points', 'parameters'"),
                               (lambda: ffd.deform_file(mesh, mesh + ".obj", lattice, fail_on="folds,holes"), "fail_on must be one of"),
                               (lambda: ffd.deform_file(mesh, mesh + ".obj", mesh), "convert_lattice")):
                with self.assertRaisesRegex((ffd.Error, ValueError), words) as caught:
                    run()
                self.assertIsNone(re.search(r"--|\bffd [a-z]", str(caught.exception)))
            for gates in ("folds,tear", "folds,tear=0.1,flipped=3", ["folds"]):
                self.assertEqual(ffd.check_file(mesh, lattice, fail_on=gates).moved, 0)


class Lists(unittest.TestCase):
    def test_words_are_those_of_the_library(self):
        for words, enumeration in ((_types.Isa, "ffd_isa"), (_types.KnotWord, "ffd_knots"), (_types.Spacing, "ffd_spacing"), (_types.Shape, "ffd_lattice_shape"),
                                   (_types.Volume, "ffd_volume"), (_types.Wrt, "ffd_jacobian_by"), (_types.Color, "ffd_view_color"), (_types.Axis, "ffd_up"),
                                   (_types.Format, "ffd_format"), (_types.Verdict, "ffd_fold_verdict"), (_types.Outside, "ffd_outside")):
            self.assertEqual(set(typing.get_args(words)), set(_library.WORDS[enumeration]), enumeration)
        for words, enumeration in ((_types.Part, "ffd_lattice_part"), (_types.Order, "ffd_point_order")):
            self.assertEqual({*typing.get_args(words), "default"}, set(_library.WORDS[enumeration]), enumeration)

    def test_options_are_those_of_the_library(self):
        self.assertEqual(_types.names(_types.JobOptions), _description.OPTIONS)
        more = {"in_place", "shared_box", "csv_ignore", "color", "camera", "size", "frames", "animation", "up", "no_cage"}
        self.assertEqual(_types.names(_types.BatchOptions), _description.OPTIONS - {"timeout", "dry_run"} | more)
        settings = {member.name.rpartition(".")[2]: member for member in _library.members()} | {"input_format": _library.members()[0]}
        for options in (_types.JobOptions, _types.BatchOptions, _types.AnimateFileOptions, _types.EditOptions):
            for name, kind in typing.get_type_hints(options).items():
                if typing.get_origin(kind) is typing.Literal and name in settings and options is not _types.AnimateFileOptions:
                    self.assertEqual(set(typing.get_args(kind)), set(settings[name].words), name)

    def test_a_refusal_names_every_keyword(self):
        points = ffd.Lattice.box((0, 0, 0), (1, 1, 1))
        for call, own in ((lambda: ffd.jacobian_file("a.obj", "J.npz", points, wrong=1), ("wrt", "of", "times", "check", "force")),
                          (lambda: ffd.deform_file("a.obj", "b.obj", points, wrong=1), ("progress", "normals")),
                          (lambda: ffd.batch([], wrong=1), ("workers", "camera", "normals", "csv_ignore")),
                          (lambda: ffd.view_bytes(b"", points, name="a.obj", wrong=1), ("camera", "deformed_files", "outside")),
                          (lambda: ffd.edit_file("a.obj", "a.html", wrong=1), ("size", "margin", "time")),
                          (lambda: ffd.animate_file("a.obj", "a.glb", points, wrong=1), ("fps", "targets", "force")),
                          (lambda: ffd.embed_file("a.obj", "a.npy", points, wrong=1), ("status_output", "snap"))):
            with self.assertRaisesRegex(TypeError, "unknown option 'wrong' .known: ") as caught:
                call()
            self.assertLess(set(own), set(re.findall(r"\w+", str(caught.exception).partition("known: ")[2])))


if __name__ == "__main__":
    unittest.main()
