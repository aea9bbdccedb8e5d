"""Meshes in memory: facts, comparisons, views and derivatives are those of files."""

import filecmp
import io
import json
import mmap
import os
import shutil
import tempfile
import unittest

import ffd_mesh as ffd
import numpy as np
import support

TRIANGLE = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
LIFT = b'{"format": "ffd-lattice", "version": 1, "size": [2, 2, 2], "rest": {"box": "mesh"}, ' \
       b'"moves": [{"by": [0, 0, {"$": "lift"}]}]}'


def read(path):
    with open(path, "rb") as file:
        return file.read()


def fails(name):
    """A function of files that raises."""
    raise LookupError(name)


class Folder(unittest.TestCase):
    """Runs in a folder of its own, which has a mesh, a mesh of two files, and a lattice."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(folder.name)
        for name in ("models/spot.obj", "models/character.glb", "lattices/twist.json"):
            shutil.copy(os.path.join(support.DATA, name), ".")
        made = ffd.deform_bytes(TRIANGLE, LIFT, name="t.obj", output="t.gltf", set={"lift": 0})
        self.files = {"t.gltf": made.data, **made.files}
        self.names = sorted(os.listdir())

    def write_gltf(self):
        """Puts the mesh of two files into the folder."""
        for name, content in self.files.items():
            with open(name, "wb") as file:
                file.write(content)


def foam(kind, text):
    """A file of OpenFOAM."""
    return f"FoamFile {{ format ascii; class {kind}; }}\n{text}\n".encode()


class OpenFoam(Folder):
    """Points with the files beside them: a tetrahedron."""

    POINTS = foam("vectorField", "4((0 0 0) (1 0 0) (0 1 0) (0 0 1))")
    BESIDE = {"faces": foam("faceList", "4(3(0 2 1) 3(0 1 3) 3(1 2 3) 3(2 0 3))"), "owner": foam("labelList", "4{0}"),
              "neighbour": foam("labelList", "0()"),
              "boundary": foam("polyBoundaryMesh", "1(top { nFaces 1; startFace 2; })")}

    def test_files_beside_the_points_are_asked_for(self):
        moved = foam("vectorField", "4((0 0 0.5) (1 0 0.5) (0 1 0.5) (0 0 1.5))")
        made = ffd.deform_bytes(self.POINTS, LIFT, name="points", files=self.BESIDE, set={"lift": 0.5})
        self.assertEqual((made.data, made.files, made.result.warnings), (moved, {}, []))
        asked = []
        ffd.check_bytes(self.POINTS, LIFT, name="points", files=asked.append, set={"lift": 0.5})
        self.assertIn("faces", asked)
        facts = ffd.info_bytes(self.POINTS, name="points", files=self.BESIDE, parts=True)
        self.assertEqual((facts["contents"]["cells"], facts["topology"]["faces"]), (1, 4))
        self.assertEqual([part["selector"] for part in facts["named_parts"]], ["group:top"])
        only = ffd.deform_bytes(self.POINTS, LIFT, name="points", files=self.BESIDE.get, set={"lift": 0.5}, only="group:top")
        self.assertEqual(only.data, moved.replace(b"(0 0 0.5)", b"(0 0 0)"))
        self.assertTrue(ffd.compare_bytes(made.data, moved, name="points", other_name="points")["equal"])

    def test_without_them_there_are_points_alone(self):
        alone = ffd.deform_bytes(self.POINTS, LIFT, name="mesh", output="mesh", input_format="foam", output_format="foam", set={"lift": 0.5})
        self.assertEqual(alone.result.moved, 4)
        self.assertIn("the file faces is not beside it", alone.result.warnings[0])
        with self.assertRaisesRegex(LookupError, "faces"):
            ffd.deform_bytes(self.POINTS, LIFT, name="points", files=fails, set={"lift": 0.5})

    def test_files_in_a_folder_give_the_same(self):
        os.makedirs("polyMesh")
        for name, content in {"points": self.POINTS, **self.BESIDE}.items():
            with open(os.path.join("polyMesh", name), "wb") as file:
                file.write(content)
        with open("lift.json", "wb") as file:
            file.write(LIFT)
        os.makedirs("out")
        result = ffd.deform_file("polyMesh/points", "out/points", "lift.json", set={"lift": 0.5})
        self.assertEqual((result.moved, os.listdir("out")), (4, ["points"]))
        self.assertEqual(read("out/points"), ffd.deform_bytes(self.POINTS, LIFT, name="points", files=self.BESIDE, set={"lift": 0.5}).data)


class Facts(Folder):
    def test_facts_of_bytes_are_those_of_files(self):
        spot, streams = read("spot.obj"), [open("spot.obj", "rb"), io.BytesIO(read("spot.obj"))]
        for stream in streams:
            self.addCleanup(stream.close)
        for data in (spot, memoryview(spot), *streams):
            self.assertEqual(ffd.info_bytes(data, name="spot.obj"), ffd.info("spot.obj"))
        with open("spot.obj", "rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as mapped:
            for _ in range(2):  # its place is not moved
                self.assertEqual(ffd.info_bytes(mapped, name="spot.obj"), ffd.info("spot.obj"))
        self.assertEqual(ffd.info("spot.obj"), json.loads(support.program("info", "spot.obj", "--json")))
        self.assertEqual(ffd.info_bytes(spot, name="spot", input_format="obj", parts=True)["vertices"], 11533)
        found = ffd.info_bytes(LIFT, name="lift.json", set={"lift": 2})
        self.assertEqual((found["kind"], found["size"]), ("lattice", [2, 2, 2]))
        found = ffd.info_bytes(self.files["t.gltf"], name="t.gltf", files=self.files)
        self.write_gltf()
        self.assertEqual(found, ffd.info("t.gltf"))

    def test_strict_facts_and_comparisons(self):
        gltf = json.loads(self.files["t.gltf"])
        gltf["scenes"][0]["nodes"] *= 2
        twice, given = json.dumps(gltf).encode(), {"name": "t.gltf", "files": self.files}
        with self.assertLogs("ffd_mesh", "WARNING"):
            self.assertEqual(ffd.info_bytes(twice, **given)["vertices"], 3)
        for run in (lambda: ffd.info_bytes(twice, strict=True, **given),
                    lambda: ffd.compare_bytes(self.files["t.gltf"], twice, strict=True, **given)):
            with self.assertRaises(ffd.InvalidError):
                run()

    def test_positions_are_what_a_deformation_writes(self):
        spot, twist = read("spot.obj"), "twist.json"
        points, result = ffd.positions_file("spot.obj", twist)
        made = ffd.deform_bytes(spot, twist, name="spot.obj")
        written = [[float(x) for x in line.split()[1:4]] for line in made.data.decode().splitlines() if line.startswith("v ")]
        self.assertEqual((points.dtype, points.shape), (np.float64, (result.vertices, 3)))
        self.assertTrue(np.array_equal(points, written))
        points[0] = 0  # the caller's own
        again = ffd.positions_bytes(spot, twist, name="spot.obj", threads=1)
        self.assertTrue(np.array_equal(again.points, written))
        self.assertEqual(again.result.moved, result.moved)
        gltf = ffd.positions_bytes(self.files["t.gltf"], LIFT, name="t.gltf", files=self.files, set={"lift": 2})
        self.assertEqual(gltf.points.tolist(), [[0, 0, 2], [1, 0, 2], [0, 1, 2]])
        with self.assertRaises(ffd.GateError) as failed:
            ffd.positions_file("spot.obj", b'{"format": "ffd-lattice", "version": 1, "size": [2, 2, 2], "rest": {"box": {"min": [0, 0, 0], '
                               b'"max": [1, 1, 1]}}}', fail_on="outside")
        self.assertGreater(failed.exception.result.counts["outside"], 0)
        with self.assertRaises(ffd.ArgumentError):
            ffd.positions_bytes(spot, twist, name="spot.obj", as_morph="M")
        self.assertEqual(sorted(os.listdir()), self.names)

    def test_what_cannot_be_described(self):
        with self.assertRaises(ffd.FileError):
            ffd.info_bytes(self.files["t.gltf"], name="t.gltf")
        with self.assertRaisesRegex(LookupError, "t.bin"):
            ffd.info_bytes(self.files["t.gltf"], name="t.gltf", files=fails)
        with self.assertRaises(ffd.InvalidError) as caught:
            ffd.info_bytes(b"v 0 0\n", name="in/a.obj")
        self.assertEqual((caught.exception.file, caught.exception.line), ("in/a.obj", 1))
        with self.assertRaisesRegex(ValueError, "memory"):
            ffd.info_bytes(TRIANGLE, name="a.obj", memory=-1)
        with self.assertRaises(TypeError):
            ffd.info_bytes(io.StringIO("v 0 0 0\n"), name="a.obj")


class Embeddings(Folder):
    def test_embeddings_are_those_of_the_program(self):
        lattice = ffd.Lattice.box((-0.6, 0.0, -0.8), (0.6, 1.2, 1.2), size=5)
        lattice.save("part.json")
        support.program("embed", "spot.obj", "-l", "part.json", "-o", "theirs.npy", "--status", "theirs-status.npy", "--snap", "0.01r")
        result = ffd.embed_file("spot.obj", "ours.npy", lattice, status_output="ours-status.npy", snap="0.01r")
        self.assertEqual(read("ours.npy"), read("theirs.npy"))
        self.assertEqual(read("ours-status.npy"), read("theirs-status.npy"))
        uvw, status = np.load("ours.npy"), np.load("ours-status.npy")
        self.assertEqual((uvw.shape, status.shape), ((result.vertices, 3), (result.vertices,)))
        self.assertEqual(result.counts["inside"], (status == ffd.Status.INSIDE).sum())
        self.assertEqual(result.counts["outside"], (status == ffd.Status.OUTSIDE).sum())
        self.assertTrue(0 < result.counts["outside"] and any("not inside" in line for line in result.warnings))
        for given in (lattice, "part.json", read("part.json")):
            made = ffd.embed_bytes(read("spot.obj"), given, name="spot.obj", snap="0.01r", threads=1)
            self.assertEqual(made.data, read("theirs.npy"))
            self.assertEqual((made.uvw.tobytes(), made.status.tobytes()), (uvw.tobytes(), status.tobytes()))
            self.assertEqual(made.result.counts, result.counts)
        # Jobs take both, and nothing else in their place.
        moved, spot = lattice.moved(lattice.rest + 0.25), read("spot.obj")
        searched = ffd.deform_bytes(spot, moved, name="spot.obj", snap="0.01r").data
        for embedding in ("ours.npy", made.data):
            self.assertEqual(ffd.deform_bytes(spot, moved, name="spot.obj", snap="0.01r", embedding=embedding).data, searched)
        with self.assertRaises(ffd.InvalidError):
            ffd.deform_bytes(spot, moved, name="spot.obj", embedding=made.data)

    def test_embeddings_of_meshes_of_several_files(self):
        made = ffd.embed_bytes(self.files["t.gltf"], LIFT, name="t.gltf", files=self.files, space="mesh")  # "lift" has no value
        self.assertEqual((made.uvw.shape, made.status.tolist()), ((3, 3), [0, 0, 0]))
        self.assertEqual(made.uvw[:, 0].tolist(), [0, 1, 0])
        self.assertEqual(sorted(os.listdir()), self.names)

    def test_what_cannot_be_embedded(self):
        ffd.embed_file("spot.obj", "e.npy", "twist.json")
        with self.assertRaises(ffd.ExistsError):
            ffd.embed_file("spot.obj", "e.npy", "twist.json")
        ffd.embed_file("spot.obj", "e.npy", "twist.json", force=True)
        with self.assertRaises(ffd.ExistsError):
            ffd.embed_file("spot.obj", "spot.obj", "twist.json", force=True)
        with self.assertRaises(ffd.ArgumentError):
            ffd.embed_file("spot.obj", "f.npy", "twist.json", status_output="./f.npy")
        for run in (lambda: ffd.embed_file("spot.obj", "f.npy", "twist.json", outside="extend"),
                    lambda: ffd.embed_bytes(TRIANGLE, "twist.json", name="a.obj", force=True)):
            with self.assertRaisesRegex(TypeError, "unknown option"):
                run()
        with self.assertRaisesRegex(LookupError, "t.bin"):
            ffd.embed_bytes(self.files["t.gltf"], "twist.json", name="t.gltf", files=fails)
        self.assertEqual(sorted(os.listdir()), sorted([*self.names, "e.npy"]))


class Comparisons(Folder):
    def test_comparisons_say_what_the_program_says(self):
        theirs = json.loads(support.program("compare", "spot.obj", "spot.obj", "--json"))
        self.assertEqual(ffd.compare_files("spot.obj", "spot.obj"), theirs)
        spot = read("spot.obj")
        self.assertEqual(ffd.compare_bytes(spot, io.BytesIO(spot), name="spot.obj"), theirs)
        self.assertIs(theirs["equal"], True)

    def test_tolerances(self):
        moved = TRIANGLE.replace(b"v 1 0 0", b"v 1 0.25 0")
        found = ffd.compare_bytes(TRIANGLE, moved, name="a.obj", other_name="b.obj")
        self.assertEqual((found["equal"], found["a"], found["b"], found["differences"]["total"]), (False, "a.obj", "b.obj", 1))
        self.assertEqual((found["first"]["kind"], found["first"]["difference"]), ("position", 0.25))
        for tolerance, equal in ((0.25, True), (0.2, False), ("0.18r", True), ("0.17r", False), ("0.25", True)):  # of sqrt 2
            self.assertEqual(ffd.compare_bytes(TRIANGLE, moved, name="a.obj", tolerance=tolerance)["equal"], equal, tolerance)
        normals = [b"vn 0 0 1\nvn 0 %g 1\n" % y + TRIANGLE.replace(b"1 2 3", b"1//1 2//2 3//1") for y in (0, 0.01)]
        for options, equal in (({}, False), ({"normal_tolerance": 0.01}, True), ({"tolerance": "0.01r"}, True),
                               ({"tolerance": "0.01r", "normal_tolerance": 0}, False), ({"tolerance": 0.01}, False)):
            self.assertEqual(ffd.compare_bytes(*normals, name="a.obj", **options)["equal"], equal, options)

    def test_meshes_of_several_files(self):
        other = {"t.bin": bytes(len(self.files["t.bin"]))}
        gltf = self.files["t.gltf"]
        self.assertTrue(ffd.compare_bytes(gltf, gltf, name="t.gltf", files=self.files)["equal"])
        self.assertFalse(ffd.compare_bytes(gltf, gltf, name="t.gltf", files=self.files, other_files=other)["equal"])
        for files in ({"files": fails}, {"files": self.files, "other_files": fails}):
            with self.assertRaisesRegex(LookupError, "t.bin"):
                ffd.compare_bytes(gltf, gltf, name="t.gltf", **files)
        with self.assertRaises(ffd.ArgumentError):
            ffd.compare_bytes(TRIANGLE, TRIANGLE, name="a.obj", tolerance=-1)
        with self.assertRaises(ffd.FileError):
            ffd.compare_files("spot.obj", "none.obj")


class Views(Folder):
    def test_views_are_those_of_the_program(self):
        spot = read("spot.obj")
        for output, words, options in (("v.html", ["--color", "status"], {"color": "status"}),
                                       ("v.png", ["--size", "200x100", "--frames", "2", "--camera", "left"],
                                        {"size": (200, 100), "frames": 2, "camera": "left"}),
                                       ("v.png", ["--size", "99x80", "--camera", "1,0.5,2", "--normals", "keep"],
                                        {"size": (99, 80), "camera": np.array([1, 0.5, 2]), "normals": "keep"})):
            support.program("view", "spot.obj", "-l", "twist.json", "-o", output, "--force", *words)
            made = ffd.view_bytes(spot, "twist.json", name="spot.obj", output=output, **options)
            self.assertEqual(made.data, read(output))
            result = ffd.view_file("spot.obj", "ours-" + output, "twist.json", force=True, **options)
            self.assertTrue(filecmp.cmp(output, "ours-" + output, shallow=False))
            self.assertEqual((result.vertices, made.result.moved), (11533, 11533))
        self.assertNotEqual(sorted(os.listdir()), self.names)
        with self.assertRaises(ffd.ExistsError):
            ffd.view_file("spot.obj", "v.png")

    def test_pages_of_tools_are_those_of_the_program(self):
        for lattices, words, options in ((None, ["--size", "3,4,5", "--margin", "0.1"], {"size": (3, 4, 5), "margin": 0.1}), (None, [], {}),
                                         ("twist.json", ["--outside", "extend", "--up", "z"], {"outside": "extend", "up": "z"})):
            support.program("edit", "spot.obj", *(["-l", lattices] if lattices else []), "-o", "e.html", "--force", *words)
            made = ffd.edit_bytes(read("spot.obj"), lattices, name="spot.obj", **options)
            self.assertEqual(made.data, read("e.html"))
            result = ffd.edit_file("spot.obj", "ours.html", lattices, force=True, **options)
            self.assertTrue(filecmp.cmp("e.html", "ours.html", shallow=False))
            self.assertEqual((result.vertices, made.result.vertices), (11533, 11533))
        with self.assertRaises(ffd.ExistsError):
            ffd.edit_file("spot.obj", "ours.html")
        with self.assertRaises(ValueError):
            ffd.edit_file("spot.obj", "ours.html", "twist.json", size=4)
        with self.assertRaises(TypeError):
            ffd.edit_file("spot.obj", "ours.html", normals="keep")

    def test_morph_targets_are_those_of_the_program(self):
        for output, words in (("v.html", []), ("v.png", ["--size", "200x100"])):
            support.program("view", "spot.obj", "--morph", "turn=twist.json", "--morph", "more=twist.json", "-o", output, "--force", *words)
            lattices = {"turn": "twist.json", "more": "twist.json"}
            size = {"size": (200, 100)} if words else {}
            self.assertEqual(ffd.view_bytes(read("spot.obj"), lattices, name="spot.obj", output=output, **size).data, read(output))
            ffd.view_file("spot.obj", "ours-" + output, lattices, force=True, **size)
            self.assertTrue(filecmp.cmp(output, "ours-" + output, shallow=False))

    def test_cameras_are_those_of_the_program(self):
        for camera in ("front", "back", "left", "right", "top", "iso"):
            support.program("view", "spot.obj", "-o", "v.png", "--size", "64x64", "--camera", camera, "--force")
            self.assertEqual(ffd.view_bytes(read("spot.obj"), name="spot.obj", output="v.png", size=(64, 64), camera=camera).data,
                             read("v.png"), camera)

    def test_a_mesh_beside_its_deformed_one(self):
        gltf, self_of = self.files["t.gltf"], {"name": "t.gltf", "files": self.files}
        self.write_gltf()
        lifted = ffd.deform_bytes(gltf, LIFT, output="u.gltf", set={"lift": 1}, **self_of)
        for name, content in (("u.gltf", lifted.data), *lifted.files.items()):
            with open(name, "wb") as file:
                file.write(content)
        ffd.view_file("t.gltf", "v.html", deformed="u.gltf")
        support.program("view", "t.gltf", "u.gltf", "-o", "w.html")
        other = {"deformed": lifted.data, "deformed_name": "u.gltf"}
        self.assertEqual(read("v.html"), read("w.html"))
        self.assertEqual(ffd.view_bytes(gltf, **other, deformed_files=lifted.files, **self_of).data, read("v.html"))
        with self.assertRaisesRegex(LookupError, "u.bin"):
            ffd.view_bytes(gltf, **other, deformed_files=fails, **self_of)
        with self.assertRaisesRegex(LookupError, "t.bin"):
            ffd.view_bytes(gltf, name="t.gltf", files=fails)
        with self.assertRaises(ffd.InvalidError):
            ffd.view_bytes(TRIANGLE, name="a.obj", deformed=TRIANGLE + b"v 1 1 1\n")

    def test_what_a_gate_refuses_is_drawn(self):
        far = ffd.Lattice.box((4, 4, 4), (5, 5, 5))
        with self.assertRaises(ffd.GateError) as caught:
            ffd.view_bytes(TRIANGLE, far, name="a.obj", fail_on="outside")
        self.assertEqual(caught.exception.result.counts["outside"], 3)
        self.assertIn(b"<html", caught.exception.data)
        self.assertEqual(sorted(os.listdir()), self.names)

    def test_what_cannot_be_drawn(self):
        for output, options, expected in (("v.html", {"size": (9, 9)}, "picture"), ("v.html", {"frames": 3}, "picture"),
                                          ("v.png", {"full": True}, "page"), ("v.png", {"camera": "below"}, "'front'"),
                                          ("v.png", {"camera": (1, 2)}, "three"), ("v.png", {"color": "red"}, "'det'")):
            with self.assertRaisesRegex(ValueError, expected):
                ffd.view_bytes(TRIANGLE, name="a.obj", output=output, **options)
        for options in ({"force": True}, {"output_format": "glb"}, {"size_": 1}):
            with self.assertRaisesRegex(TypeError, "unknown option"):
                ffd.view_bytes(TRIANGLE, name="a.obj", **options)
        for output, options in (("v.txt", {}), ("v.png", {"frames": 65}), ("v.png", {"camera": (0, 0, float("inf"))})):
            with self.assertRaises(ffd.ArgumentError):
                ffd.view_bytes(TRIANGLE, name="a.obj", output=output, **options)


class Derivatives(Folder):
    def test_derivatives_of_bytes_are_those_of_files(self):
        spot = read("spot.obj")
        for output in ("j.npz", "j.mtx"):
            found = ffd.jacobian_file("spot.obj", output, "twist.json")
            made = ffd.jacobian_bytes(spot, "twist.json", name="spot.obj", output=output)
            self.assertEqual((made.data, made.result, made.files), (read(output), found, {}))
        with open("lift.json", "wb") as file:
            file.write(LIFT)
        ffd.jacobian_file("spot.obj", "p.npy", "lift.json", by="parameters", set={"lift": 0.5}, force=True)
        made = ffd.jacobian_bytes(spot, LIFT, name="spot.obj", output="p.npy", by="parameters", set={"lift": 0.5})
        self.assertEqual((made.data, made.files), (read("p.npy"), {"p.columns.txt": read("p.columns.txt")}))

    def test_products_with_arrays_and_bytes(self):
        from scipy import sparse
        box, points = ffd.Lattice.box((0, 0, 0), (1, 1, 1), size=3), support.rng("product").uniform(0.1, 0.9, (20, 3))
        cloud = {"name": "c.ply", "data": support.ply(points)}
        B = sparse.load_npz(io.BytesIO(ffd.jacobian_bytes(lattices=box, **cloud).data))
        for name, matrix, factor in (("times", B, support.rng("q").random((27, 3))), ("transposed", B.T, points)):
            stream = io.BytesIO()
            np.save(stream, factor)
            np.save("v.npy", factor)
            products = [ffd.jacobian_bytes(lattices=box, output="p.npy", **cloud, **{name: value}).data
                        for value in (factor, stream.getvalue(), "v.npy", factor.tolist())]
            self.assertEqual(products, products[:1] * 4)
            self.assertLess(np.abs(np.load(io.BytesIO(products[0])) - matrix @ factor).max(), 1e-14)
        with self.assertRaises(ffd.InvalidError) as caught:
            ffd.jacobian_bytes(lattices=box, output="p.npy", **cloud, times=np.zeros((26, 3)))
        self.assertEqual(caught.exception.file, "times")
        with self.assertRaises(ffd.ArgumentError):
            ffd.jacobian_bytes(lattices=box, output="p.npy", **cloud, times=points, transposed=points)

    def test_a_check_that_fails_has_figures(self):
        # So far from the origin differences of positions are mostly rounding.
        far = 1e9 + support.rng("far").random((5, 3))
        box = ffd.Lattice.box((1e9,) * 3, (1e9 + 1,) * 3, size=2)
        with open("far.ply", "wb") as file:
            file.write(support.ply(far))
        for run in (lambda: ffd.jacobian_file("far.ply", "j.npz", box, check=True),
                    lambda: ffd.jacobian_bytes(support.ply(far), box, name="far.ply", check=True)):
            with self.assertRaises(ffd.GateError) as caught:
                run()
            self.assertEqual((caught.exception.result["rows"], caught.exception.result["columns"]), (5, 8))
            self.assertGreater(caught.exception.result["worst"], 1e-6)
            self.assertEqual(caught.exception.warnings, [])
        self.assertEqual(sorted(os.listdir()), sorted([*self.names, "far.ply"]))

    def test_what_has_no_derivative(self):
        with self.assertRaisesRegex(LookupError, "t.bin"):
            ffd.jacobian_bytes(self.files["t.gltf"], "twist.json", name="t.gltf", files=fails)
        for run in (lambda: ffd.jacobian_bytes(TRIANGLE, "twist.json", name="a.obj", force=True),
                    lambda: ffd.jacobian_file("spot.obj", "j.npz", "twist.json", fail_on="folds")):
            with self.assertRaisesRegex(TypeError, "unknown option"):
                run()
        with self.assertRaises(ffd.ArgumentError):
            ffd.jacobian_bytes(TRIANGLE, "twist.json", name="a.obj", output="j.txt")
        self.assertEqual(sorted(os.listdir()), self.names)
