"""VTK, NumPy, SciPy and meshio read the lattices that `ffd lattice convert` writes, and it reads what they write: every file of theirs
is made by them. Run by test_others.py, with the program in FFD."""

import itertools
import json
import os
import re
import subprocess
import sys
import tempfile
import unittest

import meshio
import numpy as np
from scipy.interpolate import BSpline, NdBSpline
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkBitArray, vtkIdTypeArray, vtkPoints, vtkStringArray, vtkUnsignedCharArray
from vtkmodules.vtkCommonDataModel import vtkPolyData, vtkStructuredGrid
from vtkmodules.vtkIOGeometry import vtkOBJReader, vtkOBJWriter
from vtkmodules.vtkIOLegacy import vtkStructuredGridReader, vtkStructuredGridWriter
from vtkmodules.vtkIOParallel import vtkMultiBlockPLOT3DReader
from vtkmodules.vtkIOXML import vtkXMLStructuredGridReader, vtkXMLStructuredGridWriter

SEED = int(os.environ.get("FFD_SEED") or np.random.SeedSequence().entropy % 2**31)
RANDOM = np.random.default_rng(SEED)
print(f"seed {SEED} (FFD_SEED)", file=sys.stderr)
FFD = os.environ["FFD"]
ARRAYS = ("offset", "weight", "weight_deformed")
ADVICE = r"Blender's lattices act beyond their box"
ROUNDED = r"VTK writes text with 11 digits"


def random_grid(size, noise=0.2):
    """Control points near the integers, (n_u, n_v, n_w, 3)."""
    return np.stack(np.meshgrid(*map(np.arange, size), indexing="ij"), axis=-1) + RANDOM.uniform(-noise, noise, (*size, 3))


def fortran(array):
    """The rows of a file, u fastest."""
    return array.transpose(2, 1, 0, *range(3, array.ndim)).reshape(-1, *array.shape[3:])


def lattice(size, degree, knots, points, **members):
    return {"format": "ffd-lattice", "version": 1, "size": list(size), "degree": list(degree), "knots": knots, "rest": {"points": fortran(points).tolist()},
            "moves": [], **members}


def dimensions(grid):
    found = [0, 0, 0]
    grid.GetDimensions(found)
    return found


def full_knots(found, direction, degree, count):
    """All knots of a direction, of a closed one unrolled by its degree at both ends."""
    values, closed = found["knots"][direction], found["closed"][direction]
    if not closed:
        return values
    period = values[-1] - values[0]
    return np.concatenate([values[count - degree:count] - period, values, values[1:degree + 1] + period])


class Others(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def ffd(self, *words, code=0, says=None):
        done = subprocess.run([FFD, *words], cwd=self.folder.name, capture_output=True, text=True, stdin=subprocess.DEVNULL, check=False)
        self.assertEqual(done.returncode, code, (words, done.stderr))
        self.assertEqual(done.stderr.count("\n"), 1 if says else 0, (words, done.stderr))
        if says:
            self.assertRegex(done.stderr, says)

    def convert(self, source, target, *more, **options):
        self.ffd("lattice", "convert", source, "-o", target, "--force", *more, **options)

    def write(self, name, content):
        with open(self.path(name), "w", encoding="utf-8") as file:
            json.dump(content, file)

    def table(self, source, *more, **options):
        """What the program reads: degree, knots, closed, and columns, by its table, whose numbers are exact."""
        self.convert(source, "table.csv", *more, **options)
        with open(self.path("table.csv"), encoding="utf-8") as file:
            lines = file.read().splitlines()
        told = [line[2:].split() for line in lines if line.startswith("#")]
        head = next(i for i, line in enumerate(lines) if line.startswith("i,"))
        columns = np.array([[float(x) for x in line.split(",")] for line in lines[head + 1:]])
        found = {"knots": [np.array(words[2:], float) for words in told if words[0] == "knots"], "degree": [], "closed": [0, 0, 0]}
        found |= {words[0]: [int(x) for x in words[1:]] for words in told if words[0] in ("degree", "closed")}
        return found | {"size": columns[:, :3].max(axis=0).astype(int) + 1, "points": columns[:, 3:6], "offset": columns[:, 6:9],
                        "weight": columns[:, 9:10], "weight_deformed": columns[:, 10:11]}

    def random_lattice(self, name="a.json"):
        """With all that a lattice can have: weights that move, and knots of all kinds."""
        size = RANDOM.integers(3, 7, 3)
        degree = [int(RANDOM.integers(1, n)) for n in size]
        count = int(size.prod())
        knots = [("clamped", "open", np.sort(RANDOM.uniform(0, 3, n + p + 1)).tolist())[RANDOM.integers(3)] for n, p in zip(size, degree)]
        members = {"weights": RANDOM.uniform(0.5, 2, count).tolist(), "deformed": {"offsets": RANDOM.uniform(-1, 1, (count, 3)).tolist()}} if RANDOM.random() < 0.7 else \
            {"deformed": {"offsets": RANDOM.uniform(-1, 1, (count, 3)).tolist()}}
        if "weights" in members and RANDOM.random() < 0.7:
            members["deformed"]["weights"] = RANDOM.uniform(0.5, 2, count).tolist()
        self.write(name, lattice(map(int, size), degree, knots, random_grid(size), **members))
        return self.table(name)

    def same(self, found, right, what=None):
        for name in ("points", *ARRAYS):
            self.assertEqual(found[name].tobytes(), right[name].tobytes(), (what, name))
        self.assertEqual([k.tolist() for k in found["knots"]], [k.tolist() for k in right["knots"]], what)
        self.assertEqual([found["degree"], found["closed"], found["size"].tolist()], [right["degree"], right["closed"], right["size"].tolist()], what)

    # VTK

    def read_by_vtk(self, name):
        reader = vtkXMLStructuredGridReader() if name.endswith(".vts") else vtkStructuredGridReader()
        if not name.endswith(".vts"):
            reader.ReadAllVectorsOn()
            reader.ReadAllScalarsOn()
        reader.SetFileName(self.path(name))
        reader.Update()
        return reader.GetOutput()

    def test_vtk_reads_all_of_a_lattice(self):
        for _ in range(6):
            right = self.random_lattice()
            for name in ("a.vtk", "a.vts"):
                self.convert("a.json", name)
                read = self.read_by_vtk(name)
                self.assertEqual(dimensions(read), right["size"].tolist())
                self.assertEqual(vtk_to_numpy(read.GetPoints().GetData()).astype(float).tobytes(), right["points"].tobytes())
                for array in ARRAYS:
                    found = read.GetPointData().GetArray(array)
                    self.assertEqual(vtk_to_numpy(found).tobytes() if found else b"", right[array].tobytes(), (name, array))
                field = read.GetFieldData()
                self.assertEqual(vtk_to_numpy(field.GetArray("ffd_degree")).ravel().tolist(), right["degree"])
                self.assertEqual(vtk_to_numpy(field.GetArray("ffd_closed")).ravel().tolist(), right["closed"])
                for letter, knots in zip("uvw", right["knots"]):
                    self.assertEqual(vtk_to_numpy(field.GetArray(f"ffd_knots_{letter}")).tobytes(), knots.tobytes())

    def grid_of_vtk(self, right, kind=np.float64, extent=None):
        """All of a lattice, with what VTK's users have beside it."""
        made, kept = vtkStructuredGrid(), []

        def array(values, name=None):
            numbers = np.ascontiguousarray(values)
            kept.append(numbers)
            found = numpy_to_vtk(numbers, deep=True)
            if name:
                found.SetName(name)
            return found
        size = [int(n) for n in right["size"]]
        made.SetExtent(*(extent or [x for n in size for x in (0, n - 1)]))
        points = vtkPoints()
        points.SetDataType(11 if kind == np.float64 else 10)
        points.SetData(array(right["points"].astype(kind)))
        made.SetPoints(points)
        count, data = len(right["points"]), made.GetPointData()
        ids, names, bits, colours = vtkIdTypeArray(), vtkStringArray(), vtkBitArray(), vtkUnsignedCharArray()
        for extra, name in ((ids, "ids of points"), (bits, "bits"), (colours, "colours")):
            extra.SetName(name)
            extra.SetNumberOfTuples(count)
            extra.Fill(1)
            data.AddArray(extra)
        names.SetName("names")
        names.InsertNextValue("one, two")
        names.InsertNextValue("\u00e4" * 200)
        for name in ARRAYS:
            if right[name].size:
                data.AddArray(array(right[name].astype(kind), name))
        data.AddArray(array(np.arange(2 * count).reshape(-1, 2).astype(np.int16), "pairs"))
        data.GetArray("offset").GetRange(-1)  # VTK then writes what it has found beside the numbers
        made.GetCellData().AddArray(array(np.ones(made.GetNumberOfCells()), "offset"))
        field = made.GetFieldData()
        field.AddArray(names)
        field.AddArray(array(np.array(right["degree"], np.int32), "ffd_degree"))
        field.AddArray(array(np.array(right["closed"], np.int64), "ffd_closed"))
        for letter, knots in zip("uvw", right["knots"]):
            field.AddArray(array(knots, f"ffd_knots_{letter}"))
        field.AddArray(array(np.array([2.5]), "TimeValue"))
        return made

    def in_kind(self, right, kind):
        return {**right, **{name: right[name].astype(kind).astype(np.float64) for name in ("points", *ARRAYS)}}

    def test_ffd_reads_the_legacy_files_of_vtk(self):
        for binary, version, kind in itertools.product((False, True), (42, 51), (np.float32, np.float64)):
            right = self.random_lattice()
            writer = vtkStructuredGridWriter()
            writer.SetFileName(self.path("v.vtk"))
            writer.SetFileVersion(version)
            (writer.SetFileTypeToBinary if binary else writer.SetFileTypeToASCII)()
            writer.SetInputData(self.grid_of_vtk(right, kind))
            self.assertTrue(writer.Write())
            found = self.table("v.vtk", says=None if binary else ROUNDED)
            if binary:
                self.same(found, self.in_kind(right, kind), (version, kind))
                continue
            self.assertEqual(found["degree"], right["degree"])
            for name in ("points", *ARRAYS):  # 11 digits, and 6 of float32
                np.testing.assert_allclose(found[name], right[name], rtol=1e-5 if kind == np.float32 else 1e-10, atol=1e-12)

    def test_ffd_reads_the_xml_files_of_vtk(self):
        for mode, packed, header, big, block, kind in itertools.product(("Ascii", "Binary", "Appended", "Raw"), (False, True), ("32", "64"), (False, True), (0, 1000),
                                                                       (np.float32, np.float64)):
            if mode == "Ascii" and (packed or big or block or header == "32"):
                continue
            if block and not packed:
                continue
            right = self.random_lattice()
            writer = vtkXMLStructuredGridWriter()
            writer.SetFileName(self.path("v.vts"))
            getattr(writer, f"SetDataModeTo{'Appended' if mode == 'Raw' else mode}")()
            writer.SetEncodeAppendedData(mode == "Appended")
            (writer.SetCompressorTypeToZLib if packed else writer.SetCompressorTypeToNone)()
            getattr(writer, f"SetHeaderTypeToUInt{header}")()
            (writer.SetByteOrderToBigEndian if big else writer.SetByteOrderToLittleEndian)()
            if block:
                writer.SetBlockSize(block)
            writer.SetInputData(self.grid_of_vtk(right, kind))
            self.assertTrue(writer.Write())
            found = self.table("v.vts")
            if mode == "Ascii":  # the numbers of the text, which are float32 to nine digits
                found = self.in_kind(found, kind)
            self.same(found, self.in_kind(right, kind), (mode, packed, header, big, block, kind))

    def test_parts_of_a_larger_grid_and_other_compressors(self):
        right = self.random_lattice()
        writer = vtkXMLStructuredGridWriter()
        writer.SetFileName(self.path("v.vts"))
        shift = [x for n, s in zip(right["size"], (5, -3, 0)) for x in (s, s + int(n) - 1)]
        writer.SetInputData(self.grid_of_vtk(right, extent=shift))
        self.assertTrue(writer.Write())
        self.same(self.table("v.vts"), right)
        for name in ("LZ4", "LZMA"):
            getattr(writer, f"SetCompressorTypeTo{name}")()
            self.assertTrue(writer.Write())
            self.convert("v.vts", "no.json", code=6, says=f"vtk{name}DataCompressor")
            self.assertFalse(os.path.exists(self.path("no.json")))

    def test_plain_grids_of_vtk(self):
        """Points alone are clamped and uniform."""
        size = (4, 5, 3)
        points = fortran(random_grid(size))
        made, places = vtkStructuredGrid(), vtkPoints()
        places.SetData(numpy_to_vtk(points, deep=True))
        made.SetDimensions(*size)
        made.SetPoints(places)
        writer = vtkStructuredGridWriter()
        writer.SetFileTypeToBinary()
        xml = vtkXMLStructuredGridWriter()
        for one, name in ((writer, "v.vtk"), (xml, "v.vts")):
            one.SetFileName(self.path(name))
            one.SetInputData(made)
            self.assertTrue(one.Write())
            found = self.table(name)
            self.assertEqual([found["degree"], found["points"].tobytes(), found["offset"].any()], [[3, 3, 2], points.tobytes(), False])
            self.assertEqual(self.table(name, "--degree", "2")["degree"], [2, 2, 2])

    def test_vtk_reads_grids_of_plot3d_and_cages(self):
        right = self.random_lattice()
        for part, points in (("rest", right["points"]), ("deformed", right["points"] + right["offset"])):
            self.ffd("lattice", "convert", "a.json", "-o", "a.xyz", "--force", "--part", part, "-q")
            reader = vtkMultiBlockPLOT3DReader()
            reader.SetFileName(self.path("a.xyz"))
            reader.BinaryFileOff()
            reader.MultiGridOn()
            reader.HasByteCountOff()
            reader.DoublePrecisionOn()
            reader.Update()
            block = reader.GetOutput().GetBlock(0)
            self.assertEqual(dimensions(block), right["size"].tolist())
            self.assertEqual(vtk_to_numpy(block.GetPoints().GetData()).astype(float).tobytes(), points.tobytes())
        self.ffd("lattice", "convert", "a.json", "-o", "a.obj", "--force", "-q")
        reader = vtkOBJReader()
        reader.SetFileName(self.path("a.obj"))
        reader.Update()
        read = vtk_to_numpy(reader.GetOutput().GetPoints().GetData())
        np.testing.assert_allclose(read, np.vstack([right["points"], right["points"] + right["offset"]]), rtol=2e-7, atol=1e-7)
        n = right["size"]
        self.assertEqual(reader.GetOutput().GetNumberOfLines(), 2 * int(n[1] * n[2] + n[0] * n[2] + n[0] * n[1]))

    def test_ffd_reads_the_points_that_vtk_writes_as_obj(self):
        points = fortran(random_grid((3, 4, 5)))
        made, places = vtkPolyData(), vtkPoints()
        places.SetData(numpy_to_vtk(points.astype(np.float32), deep=True))
        made.SetPoints(places)
        writer = vtkOBJWriter()
        writer.SetFileName(self.path("v.obj"))
        writer.SetInputData(made)
        self.assertTrue(writer.Write())
        found = self.table("v.obj", "--size", "3,4,5", "--order", "uvw")
        np.testing.assert_allclose(found["points"], points, rtol=2e-6, atol=2e-6)
        found = self.table("v.obj", "--size", "5,3,4", says="v.obj: 3 x 4 x 5 control points")
        np.testing.assert_allclose(found["points"], points, rtol=2e-6, atol=2e-6)

    # NumPy

    def test_numpy_reads_arrays_and_tables(self):
        for _ in range(5):
            right = self.random_lattice()
            for part, points in (("rest", right["points"]), ("deformed", right["points"] + right["offset"])):
                self.ffd("lattice", "convert", "a.json", "-o", "a.npy", "--force", "--part", part, "-q")
                found = np.load(self.path("a.npy"))
                self.assertEqual([found.dtype, found.shape], [np.float64, (*right["size"], 3)])
                self.assertEqual(fortran(found).tobytes(), points.tobytes())
            self.convert("a.json", "a.csv")
            with open(self.path("a.csv"), encoding="utf-8") as file:
                comments = sum(line.startswith("#") for line in file)
            rows = np.genfromtxt(self.path("a.csv"), delimiter=",", names=True, skip_header=comments)
            self.assertEqual(np.stack([rows[c] for c in ("x", "y", "z")], axis=-1).tobytes(), right["points"].tobytes())
            self.assertEqual(np.stack([rows[c] for c in ("dx", "dy", "dz")], axis=-1).tobytes(), right["offset"].tobytes())
            self.ffd("lattice", "convert", "a.json", "-o", "a.xyz", "--force", "--part", "rest", "-q")
            self.assertEqual(np.loadtxt(self.path("a.xyz"), skiprows=2).reshape(3, -1).T.tobytes(), right["points"].tobytes())

    def test_ffd_reads_the_arrays_of_numpy(self):
        points = random_grid((3, 4, 5))
        for kind, order in itertools.product(("<f4", "<f8", ">f4", ">f8"), "CF"):
            array = np.asarray(points, kind, order)
            np.save(self.path("n.npy"), array)
            self.assertEqual(self.table("n.npy")["points"].tobytes(), fortran(array).astype(float).tobytes(), (kind, order))
            rows = np.asarray(fortran(points), kind, order)
            np.save(self.path("n.npy"), rows)
            self.assertEqual(self.table("n.npy", "--size", "3,4,5")["points"].tobytes(), rows.astype(float).tobytes())
        np.save(self.path("n.npy"), points[::-1, ::-1])  # turned round in two directions
        self.assertEqual(self.table("n.npy", "--order", "auto", says="3 x 4 x 5")["points"].tobytes(), fortran(points).tobytes())
        for version in ((1, 0), (2, 0), (3, 0)):
            with open(self.path("n.npy"), "wb") as file:
                np.lib.format.write_array(file, points, version)
            self.assertEqual(self.table("n.npy")["points"].tobytes(), fortran(points).tobytes())
        for array in (points.astype(int), points.astype(complex), points[..., 0], points.astype(np.float16), np.array([{}])):
            np.save(self.path("n.npy"), array, allow_pickle=True)
            self.convert("n.npy", "no.json", code=4, says="n.npy: ")

    def test_ffd_reads_the_tables_of_numpy(self):
        points = fortran(random_grid((3, 4, 5)))
        index = fortran(np.stack(np.indices((3, 4, 5)), axis=-1))
        rows = np.hstack([index, points, RANDOM.uniform(-1, 1, points.shape), RANDOM.uniform(0.5, 2, (60, 1))])[RANDOM.permutation(60)]
        np.savetxt(self.path("n.csv"), rows, fmt=["%d"] * 3 + ["%.17g"] * 7, delimiter=",", header="i,j,k,x,y,z,dx,dy,dz,weight", comments="")
        found, order = self.table("n.csv"), np.lexsort(rows[:, :3].T)
        self.assertEqual([found[n].tolist() for n in ("points", "offset", "weight")], [rows[order, a:b].tolist() for a, b in ((3, 6), (6, 9), (9, 10))])

    def test_ffd_reads_the_archives_of_numpy(self):
        """A lattice of Blender as body refitters keep it."""
        size = (3, 2, 4)
        rest = fortran(np.stack(np.meshgrid(*(np.linspace(-0.5, 0.5, n) for n in size), indexing="ij"), axis=-1))
        for kind, save in itertools.product((np.float32, np.float64), (np.savez, np.savez_compressed)):
            moved = (rest + RANDOM.uniform(-0.1, 0.1, rest.shape)).astype(kind)
            save(self.path("n.npz"), magic=np.array([b"LATZ"]), version=np.array([3], np.uint16), name=np.array([b"x"], "S64"), interp=np.array([b"KEY_LINEAR"] * 3, "S16"),
                 location=np.array([1, 2, 3], kind), rotation_quat=np.array([1, 0, 0, 0], kind), scale=np.array([2, 2, 2], kind), use_outside=np.array([1], np.uint8),
                 points_rest=rest.astype(kind), points_deform=moved, **{name: np.array([n], np.uint16) for name, n in zip("UVW", size)})
            found = self.table("n.npz", says=ADVICE)
            self.assertEqual(found["offset"].tobytes(), (2 * (moved.astype(float) - rest.astype(kind).astype(float))).tobytes())
            np.testing.assert_allclose(found["points"], 2 * rest + [1, 2, 3], atol=1e-14)

    # SciPy

    def test_scipy_evaluates_the_same_map(self):
        for _ in range(12):
            size = [int(RANDOM.integers(4, 8)) for _ in range(3)]
            degree = [int(RANDOM.integers(1, min(n, 5))) for n in size]
            knots = [RANDOM.choice(["clamped", "open", "uniform"]) if RANDOM.random() < 0.7 else
                     np.sort(RANDOM.uniform(0, 1, n + p + 1)).tolist() for n, p in zip(size, degree)]
            self.write("b.json", {"format": "ffd-lattice", "version": 1, "size": size, "degree": degree, "knots": [k if isinstance(k, list) else str(k) for k in knots],
                                  "rest": {"box": {"min": [-1, 0, 2], "max": [1, 3, 4]}}, "moves": []})
            box, count = self.table("b.json"), int(np.prod(size))
            members = {"weights": RANDOM.uniform(0.9, 1.1, count).tolist()} if RANDOM.random() < 0.5 else {}
            # Not so far that the volume folds at rest, which has no u, v, w of its own then.
            gaps = [np.diff(np.unique(axis)).min() for axis in box["points"].T]
            warped = box["points"] + min(0.02, 0.1 * min(gaps)) * RANDOM.uniform(-1, 1, (count, 3))
            self.write("a.json", {"format": "ffd-lattice", "version": 1, "size": size, "degree": degree, "knots": [k.tolist() for k in box["knots"]],
                                  "rest": {"points": warped.tolist()}, "moves": [], "deformed": {"offsets": RANDOM.uniform(-0.05, 0.05, (count, 3)).tolist()}, **members})
            self.evaluates(RANDOM.choice(["a.csv", "a.vtk", "a.vts"]), "a.json")

    def test_scipy_evaluates_closed_lattices(self):
        size, degree = (3, 7, 3), (2, 3, 1)
        offsets = RANDOM.uniform(-0.1, 0.1, (63, 3)).tolist()
        self.write("a.json", {"format": "ffd-lattice", "version": 1, "size": size, "degree": degree, "knots": ["clamped", "closed", "clamped"], "moves": [],
                              "rest": {"cylinder": {"center": [0, 0, 0], "axis": [0, 0, 1], "radius": [0.5, 1], "height": 2}}, "deformed": {"offsets": offsets}})
        self.evaluates("a.vts", "a.json")

    def evaluates(self, name, source):
        """The program's map is that of the knots and control points that it writes."""
        self.convert(source, name)
        found = self.table(name)
        size, degree = found["size"], found["degree"]
        knots = [full_knots(found, d, degree[d], size[d]) for d in range(3)]
        weight = found["weight"] if found["weight"].size else np.ones((len(found["points"]), 1))
        moved = found["weight_deformed"] if found["weight_deformed"].size else weight
        indices = np.ix_(*(np.arange(n + (p if c else 0)) % n for n, p, c in zip(size, degree, found["closed"])))

        def volume(points, weights):
            coefficients = np.hstack([points * weights, weights]).reshape(*size[::-1], 4).transpose(2, 1, 0, 3)[indices]
            spline = NdBSpline(tuple(knots), np.ascontiguousarray(coefficients), tuple(degree))

            def at(uvw):
                values = spline(uvw)
                return values[:, :3] / values[:, 3:]
            return at
        ends = np.array([[t[p], t[-p - 1]] for t, p in zip(knots, degree)])
        uvw = ends[:, 0] + (ends[:, 1] - ends[:, 0]) * RANDOM.uniform(0.02, 0.98, (300, 3))
        before = volume(found["points"], weight)(uvw)
        after = volume(found["points"] + found["offset"], moved)(uvw)
        # One direction by itself, by the other class.
        line = BSpline(knots[0], np.eye(len(knots[0]) - degree[0] - 1), degree[0])(uvw[:5, 0])
        np.testing.assert_allclose(line.sum(axis=1), 1, atol=1e-13)
        with open(self.path("in.obj"), "w", encoding="ascii") as file:
            file.writelines("v {!r} {!r} {!r}\n".format(*map(float, p)) for p in before)
        self.convert(name, "again.json")
        self.ffd("deform", "in.obj", "out.obj", "-l", "again.json", "--force", "--outside", "error", "-q")
        with open(self.path("out.obj"), encoding="ascii") as file:
            made = np.array([[float(x) for x in line.split()[1:4]] for line in file if line.startswith("v ")])
        self.assertLess(np.abs(made - after).max(), 1e-11, (name, size, degree, found["closed"]))
        self.assertGreater(np.abs(made - before).max(), 1e-3)

    # meshio

    def test_meshio_reads_grids_and_cages(self):
        for _ in range(4):
            right = self.random_lattice()
            self.convert("a.json", "a.vtk")
            mesh = meshio.read(self.path("a.vtk"))
            self.assertEqual(mesh.points.tobytes(), right["points"].tobytes())
            self.assertEqual(mesh.point_data["offset"].tobytes(), right["offset"].tobytes())
            for name in ARRAYS[1:]:
                self.assertEqual(mesh.point_data[name].tobytes() if name in mesh.point_data else b"", right[name].tobytes())
            (cells,) = mesh.cells
            self.assertEqual([cells.type, len(cells.data)], ["hexahedron", int((right["size"] - 1).prod())])

    def test_ffd_and_the_files_of_meshio(self):
        points = fortran(random_grid((3, 4, 5)))
        mesh = meshio.Mesh(points, [("triangle", np.array([[0, 1, 2], [3, 4, 5]]))])
        mesh.write(self.path("m.obj"))
        found = self.table("m.obj", "--size", "3,4,5", says="3 x 4 x 5 control points")
        np.testing.assert_allclose(found["points"], points, rtol=1e-15, atol=1e-15)
        for binary in (False, True):
            meshio.vtk.write(self.path("m.vtk"), mesh, binary=binary)
            self.convert("m.vtk", "no.json", code=6, says="UNSTRUCTURED_GRID, not a STRUCTURED_GRID")


if __name__ == "__main__":
    unittest.main()
