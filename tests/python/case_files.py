"""Files, and what results of jobs on them say."""

import filecmp
import json
import os
import tempfile
import unittest

import ffd_mesh as ffd
import numpy as np
import support

SPOT = os.path.join(support.DATA, "models", "spot.obj")
TWIST = os.path.join(support.DATA, "lattices", "twist.json")


def part_of_spot():
    """A lattice that holds a part of the cow, and a push of it."""
    lattice = ffd.Lattice.box((-0.6, 0.0, -0.8), (0.6, 1.2, 1.2), size=5)
    Q = lattice.rest.copy()
    Q[2, 3, 2] += (0.1, 0.2, 0.0)
    return lattice.moved(Q)


class Files(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(folder.name)

    def test_a_file_becomes_what_the_program_makes_of_it(self):
        lattice = part_of_spot()
        lattice.save("part.json", force=True)
        support.program("deform", SPOT, "theirs.obj", "-l", "part.json", "-l", TWIST, "--normals", "recompute", "--force")
        result = ffd.deform_file(SPOT, "ours.obj", [lattice, TWIST], normals="recompute", force=True)
        self.assertTrue(filecmp.cmp("ours.obj", "theirs.obj", shallow=False))
        self.assertEqual((result.vertices, result.moved, sum(result.counts.values())), (11533, 11533, 11533))
        self.assertIsNone(result.folds)
        self.assertEqual(ffd.deform_file(SPOT, "ours.obj", TWIST, force=True, quality=True).folds.verdict, "none")

    def test_faces_that_are_turned_over_are_told(self):
        """Of a tetrahedron whose tip slides through its base: det F > 0 at its corners."""
        points = ((0, 0, -1), (1, 0, -1), (0, 1, -1), (0, 0, 1))
        faces = ((1, 3, 2), (1, 2, 4), (2, 3, 4), (3, 1, 4))
        with open("tip.obj", "w", encoding="ascii") as file:
            file.write("".join("v %d %d %d\n" % p for p in points) + "".join("f %d %d %d\n" % f for f in faces))
        lattice = ffd.Lattice.box((-4, -4, -4), (4, 4, 4), size=(2, 2, 33))
        offsets = lattice.offsets.copy()
        offsets[:, :, 17:] = (0, 0, -6)
        lattice = lattice.moved(offsets=offsets)
        turned = ffd.deform_file("tip.obj", "turned.obj", lattice)
        self.assertEqual(ffd.check_file("tip.obj", lattice).flipped_faces, 3)
        self.assertEqual(turned.flipped_faces, 3)
        self.assertEqual([line for line in turned.warnings if "3 of 4 faces are turned over" in line], turned.warnings[-1:])

    def test_options_are_those_of_the_program(self):
        lattice = part_of_spot()
        lattice.save("part.json", force=True)
        model = os.path.join(support.DATA, "models", "character.glb")
        for words, options in ((["--outside", "extend", "--falloff", "0.5"], {"outside": "extend", "falloff": 0.5}),
                               (["--snap", "0.01r"], {"snap": "0.01r"}),
                               (["--seam", "C1"], {"seam": "C1"}), (["--seam", "C0:u-,w+"], {"seam": "C0:u-,w+"}),
                               (["--seam", "C1:all"], {"seam": "C1:all"}), (["--seam", "C1:cut"], {"seam": "C1:cut"}),
                               (["--as-morph", "wide", "--space", "mesh"], {"as_morph": "wide", "space": "mesh"}),
                               (["--rig", "follow"], {"rig": "follow"}),
                               (["--only", "node:arm-left", "--resources", "reference"],
                                {"only": "node:arm-left", "resources": "reference"})):
            support.program("deform", model, "theirs.glb", "-l", "part.json", "--force", *words)
            ffd.deform_file(model, "ours.glb", lattice, force=True, **options)
            self.assertTrue(filecmp.cmp("ours.glb", "theirs.glb", shallow=False), options)

    def test_held_faces(self):
        """Which are held is told as the report has it; the text of the option is checked here."""
        lattice = part_of_spot()
        lattice.save("part.json", force=True)
        support.program("deform", SPOT, "theirs.obj", "-l", "part.json", "--seam", "C1", "--force", "--report", "r.json")
        with open("r.json", encoding="utf-8") as file:
            theirs = json.load(file)["jobs"][0]["seam"]
        result = ffd.deform_file(SPOT, "ours.obj", lattice, seam="C1", force=True)
        self.assertTrue(filecmp.cmp("ours.obj", "theirs.obj", shallow=False))
        self.assertEqual({"continuity": result.seam.continuity, "faces": result.seam.faces}, theirs)
        self.assertTrue(theirs["faces"][0])
        self.assertTrue(any("the mesh cuts" in line for line in result.warnings))
        self.assertEqual(ffd.check_file(SPOT, [lattice, TWIST], seam="C0:u+").seam.faces, [["u+"], ["u+"]])
        self.assertIsNone(ffd.check_file(SPOT, lattice, seam="none").seam)
        for wrong in ("C3", "c1", "C1:", "C1:x+", "C1:u+,", 1):
            with self.assertRaises(ValueError):
                ffd.check_file(SPOT, lattice, seam=wrong)
        with self.assertRaisesRegex(ffd.ArgumentError, "C2 needs degree 3 along u"):
            ffd.check_file(SPOT, ffd.Lattice.box((-1, -1, -1), (1, 1, 1), degree=2, size=4), seam="C2:u-")

    def test_several_morph_targets(self):
        lattice, clip = part_of_spot(), "bow: 0, 0.5 part=1, 1"
        lattice.save("part.json")
        model = os.path.join(support.DATA, "models", "character.glb")
        support.program("deform", model, "theirs.glb", "--morph", "part=part.json", "--morph", f"turn={TWIST}", "--clip", clip)
        ffd.deform_file(model, "ours.glb", {"part": lattice, "turn": TWIST}, clips=[clip])
        self.assertTrue(filecmp.cmp("ours.glb", "theirs.glb", shallow=False))

    def test_checks_and_gates(self):
        result = ffd.check_file(SPOT, TWIST)
        self.assertEqual(result.folds.verdict, "none")
        report = "report.json"
        support.program("check", SPOT, "-l", TWIST, "--report", report)
        with open(report, encoding="utf-8") as file:
            theirs = json.load(file)["jobs"][0]
        for group in ("displacement", "iterations", "det", "area"):
            self.assertEqual({name: getattr(getattr(result, group), name) for name in theirs[group] if name != "outside"},
                             {name: value for name, value in theirs[group].items() if name != "outside"})
        self.assertEqual(result.edges.deviation.max, theirs["edges"]["deviation"]["max"])
        self.assertEqual((result.tear.edges, result.tear.cause, result.rig), (0, "none", None))
        self.assertIsNone(ffd.deform_file(SPOT, "ours.obj", TWIST, force=True).edges)
        with self.assertRaisesRegex(ffd.GateError, "outside") as caught:
            ffd.check_file(SPOT, part_of_spot(), fail_on=["outside", "folds", "tear=0.5"])
        self.assertGreater(caught.exception.result.counts["outside"], 0)
        self.assertEqual(caught.exception.status, -1)
        self.assertTrue(ffd.check_file(SPOT, part_of_spot()).warnings)

    def test_derivatives_of_files_are_those_of_arrays(self):
        from scipy import sparse
        lattice, points = part_of_spot(), support.rng("jacobian").uniform(-0.5, 0.5, (60, 3))
        with open("cloud.ply", "wb") as file:
            file.write(support.ply(points))
        self.assertLess(ffd.jacobian_file("cloud.ply", "held.npz", lattice, check=True, seam="C1:u-,w+")["worst"], 1e-6)
        found = ffd.jacobian_file("cloud.ply", "j.npz", lattice, check=True)
        embedding = lattice.embed(points)
        B = lattice.basis(embedding)
        self.assertEqual((found["vertices"], found["rows"], found["columns"], found["entries"]), (60, *B.shape, B.nnz))
        self.assertLess(found["worst"], 1e-6)
        columns = np.arange(125).reshape(5, 5, 5).transpose(2, 1, 0).ravel()  # u fastest in files
        theirs = sparse.load_npz("j.npz").toarray()
        self.assertEqual(theirs.tobytes(), B.toarray()[:, columns].tobytes())
        with self.assertRaises(ffd.ExistsError):
            ffd.jacobian_file("cloud.ply", "j.npz", lattice)
        with self.assertRaisesRegex(ValueError, "'points', 'parameters'"):
            ffd.jacobian_file("cloud.ply", "k.npz", lattice, by="weights")

    def test_failures_of_files(self):
        lattice = part_of_spot()
        with open("there.obj", "w", encoding="ascii") as file:
            file.write("mine\n")
        with self.assertRaises(ffd.ExistsError):
            ffd.deform_file(SPOT, "there.obj", lattice)
        with open("there.obj", encoding="ascii") as file:
            self.assertEqual(file.read(), "mine\n")
        with open("bad.obj", "w", encoding="ascii") as file:
            file.write("v 0 0 0\nv 1 x 0\n")
        with self.assertRaises(ffd.InvalidError) as caught:
            ffd.deform_file("bad.obj", "out.obj", lattice)
        self.assertEqual((caught.exception.file, caught.exception.line), ("bad.obj", 2))
        self.assertFalse(os.path.exists("out.obj"))
        with self.assertRaisesRegex(TypeError, "unknown option 'outsid'"):
            ffd.deform_file(SPOT, "out.obj", lattice, outsid="keep")
        with self.assertRaisesRegex(ValueError, "fail_on"):
            ffd.deform_file(SPOT, "out.obj", lattice, fail_on=["edges"])
        for mapping in ({"fail_on": {"tear": 0.1}}, {"only": {"group": "a"}}):
            with self.assertRaisesRegex(TypeError, "is a list of texts, not a mapping"):
                ffd.deform_file(SPOT, "out.obj", lattice, **mapping)

    def test_a_refusal_names_keywords_of_python(self):
        lattice = part_of_spot()
        for options, message in (
                ({"falloff": 1}, "falloff= needs outside='extend'"),
                ({"rig": "follow", "as_morph": "a"}, "rig='follow' moves the shape itself, which as_morph= leaves"),
                ({"rig": "follow", "space": "mesh"}, "rig='follow' moves nodes, which have no place with space='mesh'"),
                ({"embedding": b"u", "blocks": True}, "embedding= works with one lattice, and not with blocks=True"),
                ({"clips": "a: 0"}, "clips= needs named lattices"),
                ({"falloff": -1}, "the falloff -1 is not a length"),
                ({"only": "node"}, "only=: \"node\" is not KIND:NAME (node, mesh, material, group or object)"),
                ({"only": "node:a"}, "only='node': a file of format OBJ has only material, group and object")):
            with self.assertRaises(ffd.ArgumentError) as refused:
                ffd.check_file(SPOT, lattice, **options)
            self.assertEqual(refused.exception.message, message)
        for lattices, options, message in (
                ({"a": lattice}, {"as_morph": "b"}, "as_morph= cannot be used with named lattices"),
                ({"a": lattice}, {"blocks": True}, "blocks=True cannot be used with named lattices"),
                (lattice, {"output_format": "ply"}, "output=None keeps the format: output_format= cannot be used with it")):
            with self.assertRaises(ffd.ArgumentError) as refused:
                ffd.deform_file(SPOT, None, lattices, **options)
            self.assertEqual(refused.exception.message, message)

    def test_the_caller_watches_and_ends_a_job(self):
        seen = []
        result = ffd.deform_file(SPOT, "new/a.gltf", TWIST, make_folders=True, progress=seen.append)
        self.assertEqual((seen[-1], seen), (1, sorted(seen)))
        self.assertEqual(result.outputs, ["new/a.gltf", "new/a.bin"])
        self.assertEqual(sorted(os.listdir("new")), ["a.bin", "a.gltf"])
        with self.assertRaises(ffd.Cancelled):
            ffd.deform_file(SPOT, "b.obj", TWIST, progress=lambda done: False)
        with self.assertRaisesRegex(KeyError, "of the caller"):
            ffd.deform_file(SPOT, "b.obj", TWIST, progress=lambda done: {}["of the caller"])
        with self.assertRaisesRegex(TypeError, "progress must be a function"):
            ffd.deform_file(SPOT, "b.obj", TWIST, progress=3)
        self.assertFalse(os.path.exists("b.obj"))

    def test_outputs_are_named(self):
        self.assertEqual(ffd.check_file(SPOT, TWIST).outputs, [])
        self.assertEqual(ffd.deform_file(SPOT, "c.obj", TWIST, dry_run=True).outputs, ["c.obj"])
        with self.assertRaises(ffd.Error):
            ffd.deform_file(SPOT, "none/c.obj", TWIST)
        jobs = [{"in": SPOT, "lattice": TWIST, "out": f"o/{name}"} for name in ("a.gltf", "b.obj")] + [{"in": "none.obj", "lattice": TWIST, "out": "c.obj"}]
        self.assertEqual([job.outputs for job in ffd.batch(jobs)], [["o/a.gltf", "o/a.bin"], ["o/b.obj"], []])

    def test_folders_are_compared(self):
        for folder in "ab":
            ffd.deform_file(SPOT, f"{folder}/x.obj", TWIST, make_folders=True)
        self.assertEqual(ffd.compare_folders("a", "b")["equal"], True)
        ffd.deform_file(SPOT, "b/y.obj", TWIST)
        found = ffd.compare_folders("a", "b", tolerance="1e-6r")
        self.assertEqual((found["equal"], [file["name"] for file in found["files"]], found["only_a"], found["only_b"]),
                         (False, ["x.obj"], [], ["y.obj"]))
        with self.assertRaises(ffd.FileError):
            ffd.compare_folders("a", "none")

    def test_placeholders(self):
        text = json.loads(part_of_spot().text)
        del text["deformed"]
        text["parameters"] = {"lift": {"default": 0.1, "min": 0, "max": 1, "unit": "m", "comment": "how far"}}
        text["moves"] = [{"at": [2, 3, 2], "by": [0, {"$": "lift"}, 0]}]
        with open("lift.json", "w", encoding="utf-8") as file:
            json.dump(text, file)
        self.assertEqual(ffd.parameters("lift.json")["lift"], ("lift", 0.1, "m", "how far", 0, 1))
        self.assertEqual(ffd.Lattice.load("lift.json").offsets[2, 3, 2].tolist(), [0, 0.1, 0])
        lattice = ffd.Lattice.load("lift.json", {"lift": 0.25})
        self.assertEqual((lattice.offsets[2, 3, 2, 1], list(lattice.parameters)), (0.25, ["lift"]))
        with self.assertRaisesRegex(ValueError, "'lifted'"):
            ffd.Lattice.load("lift.json", {"lifted": 1})
        os.mkfifo("lift.pipe")
        with self.assertRaisesRegex(ValueError, "read twice"):
            ffd.Lattice.load("lift.pipe")
        self.assertEqual(ffd.info("lift.json", set={"lift": 0.25})["kind"], "lattice")
        self.assertEqual(ffd.info(SPOT)["vertices"], 11533)
        ffd.deform_file(SPOT, "lifted.obj", "lift.json", set={"lift": 0.25}, force=True)

    def test_bytes_become_what_files_become(self):
        lattice, models = part_of_spot(), os.path.join(support.DATA, "models")
        for name in ("spot.obj", "character.glb"):
            with open(os.path.join(models, name), "rb") as file:
                data = file.read()
            ffd.deform_file(os.path.join(models, name), name, [lattice, TWIST], force=True)
            for lent in (data, bytearray(data), memoryview(b" " + data)[1:], np.frombuffer(data, np.uint8)):
                made = ffd.deform_bytes(lent, [lattice, TWIST], name=name)
                with open(name, "rb") as file:
                    self.assertEqual(made.data, file.read())
                self.assertFalse(made.files)
            self.assertEqual(ffd.check_bytes(data, TWIST, name=name).displacement.max,
                             ffd.check_file(os.path.join(models, name), TWIST).displacement.max)

    def test_volume_meshes_in_bytes(self):
        corpus, lattice = os.path.join(support.SOURCE, "tests", "fuzz", "corpus"), ffd.Lattice.box((-2, -2, -2), (3, 3, 3))
        lattice = lattice.moved(lattice.rest + [0.5, 0, 0])
        for path in ("su2/plain", "vtk/text", "vtk/bytes", "vtu/ascii", "vtu/raw-zlib", "vtp/base64", "vts/raw", "msh/old-bytes", "msh/new-text"):
            name = "a." + path.split("/")[0]
            with open(os.path.join(corpus, path), "rb") as file:
                data = file.read()
            with open(name, "wb") as file:
                file.write(data)
            made = ffd.deform_bytes(data, lattice, name=name)
            self.assertGreater(made.result.moved, 0, path)
            self.assertNotEqual(made.data, data, path)
            ffd.deform_file(name, "b" + name, lattice)
            with open("b" + name, "rb") as file:
                self.assertEqual(made.data, file.read(), path)
            os.remove(name)
            os.remove("b" + name)
            still, _ = ffd.positions_bytes(data, ffd.Lattice.box((9, 9, 9), (10, 10, 10)), name="a", input_format=path.split("/")[0])
            moved, _ = ffd.positions_bytes(data, lattice, name=name)
            self.assertTrue(np.allclose(moved - still, [0.5, 0, 0], atol=1e-7), path)
        with self.assertRaisesRegex(ffd.UnsupportedError, "meshio"):
            ffd.deform_bytes(data, lattice, name="a.msh", output="a.obj")

    def test_bytes_name_other_bytes(self):
        obj = b"mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
        given, asked = {"a.mtl": bytearray(b"newmtl a\n")}, []
        made = ffd.deform_bytes(obj, TWIST, name="in/a.obj", output="out/b.obj", files=given)
        self.assertEqual(made.files, {"a.mtl": b"newmtl a\n"})
        self.assertTrue(made.data.startswith(b"mtllib a.mtl"))
        self.assertEqual(made.result.moved, made.result.vertices)
        self.assertEqual(os.listdir(), [])
        made = ffd.deform_bytes(obj, TWIST, name="a.obj", output="a.gltf", files=lambda name: asked.append(name))
        self.assertEqual(list(made.files), ["a.bin"])
        made = ffd.deform_bytes(obj, TWIST, name="a.obj", files=lambda name: asked.append(name))
        self.assertEqual((asked[-1], made.files), ("a.mtl", {}))
        self.assertIn("is missing", made.result.warnings[0])
        text = b'{"format": "ffd-lattice", "version": 1, "size": [2, 2, 2], "rest": {"box": "mesh"}, ' \
               b'"moves": [{"by": [0, 0, {"$": "lift"}]}]}'
        self.assertIn(b"v 1 0 0.5\n", ffd.deform_bytes(obj, text, name="a.obj", set={"lift": 0.5}).data)
        with self.assertRaises(ffd.InvalidError):
            ffd.deform_bytes(obj, TWIST, name="a.obj", embedding=b"no array")

    def test_failures_of_bytes(self):
        obj, lattice = b"mtllib a.mtl\nv 0 0 0\nv 1 x 0\n", part_of_spot()
        with self.assertRaises(ffd.InvalidError) as caught:
            ffd.deform_bytes(obj, lattice, name="in/a.obj")
        self.assertEqual((caught.exception.file, caught.exception.line), ("in/a.obj", 3))
        good = obj.replace(b"x", b"0")
        for wrong, expected in ((lambda name: 1 / 0, ZeroDivisionError), (lambda name: name, TypeError),
                                (lambda: None, TypeError)):
            with self.assertRaises(expected):
                ffd.deform_bytes(good, lattice, name="a.obj", files=wrong)
        for data, files, expected in ((None, None, TypeError), ("text", None, TypeError), (good, [1], TypeError),
                                      (np.zeros((4, 4), np.uint8)[:, ::2], None, ValueError)):
            with self.assertRaises(expected):
                ffd.deform_bytes(data, lattice, name="a.obj", files=files)
        for data, name, options in ((good, "a", {}), (b"", "a.glb", {}), (good, "a.obj", {"resources": "reference"})):
            with self.assertRaises(ffd.Error):
                ffd.deform_bytes(data, lattice, name=name, **options)
        with self.assertRaises(ffd.GateError) as refused:
            ffd.check_bytes(good, ffd.Lattice.box((4, 4, 4), (5, 5, 5)), name="a.obj", fail_on="outside")
        self.assertEqual(refused.exception.result.counts["outside"], 2)
        self.assertEqual(os.listdir(), [])


class Figures(unittest.TestCase):
    def test_what_is_not_known_is_none(self):
        lattice, points = ffd.Lattice.box((0, 0, 0), (1, 1, 1)), support.rng("figures").uniform(0.1, 0.9, (30, 3))
        result = ffd.positions_bytes(support.ply(points), lattice, name="a.ply").result
        self.assertEqual((result.volume.before, result.faces, result.flipped_faces, result.tear.vertex), (None,) * 4)
        self.assertEqual(result.behind["camera"].names, [])
        self.assertEqual([name for name in vars(result) if name not in ffd.Result.__annotations__], [])
        checked = ffd.check_bytes(support.ply(points), lattice, name="a.ply")
        self.assertEqual((checked.det.outside, checked.det.outside_vertex), (None, None))
        nothing = ffd.check_bytes(support.ply(np.full((1, 3), np.nan)), lattice, name="a.ply")
        self.assertEqual((nothing.bounds.before, nothing.bounds.after), (None, None))

        def numbers(value):
            members = value.values() if isinstance(value, dict) else value if isinstance(value, (list, tuple)) else vars(value).values() if hasattr(value, "__dict__") else ()
            return [value] if isinstance(value, (int, float)) else [number for member in members for number in numbers(member)]
        for one in (result, checked, nothing):
            for number in numbers(one):
                self.assertTrue(np.isfinite(number) and number != 2**64 - 1)
