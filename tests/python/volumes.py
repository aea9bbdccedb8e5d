"""VTK and meshio read the volume meshes that `ffd deform` writes, which are files of theirs: the points have the bits of the same points
in an OBJ, and all else is as it was. Run by test_others.py, with the program in FFD."""

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
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkIdList, vtkPoints, vtkStringArray
from vtkmodules.vtkCommonDataModel import vtkPolyData, vtkStructuredGrid, vtkUnstructuredGrid
from vtkmodules.vtkIOLegacy import vtkPolyDataReader, vtkPolyDataWriter, vtkStructuredGridReader, vtkStructuredGridWriter, vtkUnstructuredGridReader, vtkUnstructuredGridWriter
from vtkmodules.vtkIOXML import (vtkXMLPolyDataReader, vtkXMLPolyDataWriter, vtkXMLStructuredGridReader, vtkXMLStructuredGridWriter,
                                 vtkXMLUnstructuredGridReader, vtkXMLUnstructuredGridWriter)

SEED = int(os.environ.get("FFD_SEED") or np.random.SeedSequence().entropy % 2**31)
RANDOM = np.random.default_rng(SEED)
print(f"seed {SEED} (FFD_SEED)", file=sys.stderr)
FFD = os.environ["FFD"]
STAYS = "arrays? of three components"
SIZE = (4, 3, 5)
# VTK's numbers of linear and quadratic cells, and their points.
KINDS = ((10, 4), (14, 5), (13, 6), (12, 8), (11, 8), (24, 10), (25, 20), (26, 15), (27, 13), (29, 27), (5, 3), (9, 4), (3, 2), (1, 1))
LEGACY = {"vtu": (vtkUnstructuredGridReader, vtkUnstructuredGridWriter), "vtp": (vtkPolyDataReader, vtkPolyDataWriter),
          "vts": (vtkStructuredGridReader, vtkStructuredGridWriter)}
XML = {"vtu": (vtkXMLUnstructuredGridReader, vtkXMLUnstructuredGridWriter), "vtp": (vtkXMLPolyDataReader, vtkXMLPolyDataWriter),
       "vts": (vtkXMLStructuredGridReader, vtkXMLStructuredGridWriter)}


def grid_points(kind):
    """Points near the integers, the first number fastest."""
    regular = np.stack(np.meshgrid(*map(np.arange, SIZE), indexing="ij"), axis=-1).transpose(2, 1, 0, 3).reshape(-1, 3)
    return (regular + RANDOM.uniform(-0.3, 0.3, regular.shape)).astype(kind)


def add_data(grid, points):
    """Data of all sorts: numbers, vectors, normals, cells' numbers, words of the whole file."""
    normals = RANDOM.normal(size=points.shape)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    for where, name, values in ((grid.GetPointData(), "heat", RANDOM.random(len(points))),
                                (grid.GetPointData(), "flow", RANDOM.random(points.shape).astype(np.float32)),
                                (grid.GetPointData(), "turned", normals.astype(np.float32)),
                                (grid.GetCellData(), "zone", RANDOM.integers(0, 9, grid.GetNumberOfCells()).astype(np.int32))):
        array = numpy_to_vtk(np.ascontiguousarray(values), deep=True)
        array.SetName(name)
        where.AddArray(array)
    grid.GetPointData().SetActiveNormals("turned")
    words = vtkStringArray()
    words.SetName("words")
    words.InsertNextValue("a word")
    grid.GetFieldData().AddArray(words)


def made(ending, kind):
    """A mesh of VTK whose points have numbers of this kind."""
    points = grid_points(kind)
    grid = {"vtu": vtkUnstructuredGrid, "vtp": vtkPolyData, "vts": vtkStructuredGrid}[ending]()
    stored = vtkPoints()
    stored.SetData(numpy_to_vtk(points, deep=True))
    grid.SetPoints(stored)
    if ending == "vts":
        grid.SetDimensions(SIZE)
    elif ending == "vtp":
        grid.Allocate(8)
        for count, corners in ((3, 5), (4, 9), (5, 7)):
            grid.InsertNextCell({3: 5, 4: 9}.get(count, 7), count, RANDOM.permutation(len(points))[:count].tolist())
    else:
        for number, count in KINDS:
            grid.InsertNextCell(number, count, RANDOM.permutation(len(points))[:count].tolist())
        faces = vtkIdList()  # a tetrahedron as a polyhedron
        for number in (4, 3, 0, 1, 2, 3, 0, 3, 1, 3, 1, 3, 2, 3, 2, 3, 0):
            faces.InsertNextId(number)
        grid.InsertNextCell(42, faces)
    add_data(grid, points)
    return grid, points


def arrays_of(grid):
    """All that a mesh of VTK holds beside points and normals: bytes by name."""
    found = {}
    for where, data in (("point", grid.GetPointData()), ("cell", grid.GetCellData())):
        found |= {(where, data.GetArrayName(i)): vtk_to_numpy(data.GetArray(i)).tobytes() for i in range(data.GetNumberOfArrays())}
    found.pop(("point", "turned"), None)
    words = grid.GetFieldData().GetAbstractArray("words")
    found["words"] = [words.GetValue(i) for i in range(words.GetNumberOfValues())]
    cells = []
    for i in range(grid.GetNumberOfCells()):
        cell = grid.GetCell(i)
        sides = [[cell.GetFace(k).GetPointId(j) for j in range(cell.GetFace(k).GetNumberOfPoints())] for k in range(cell.GetNumberOfFaces())] \
            if grid.GetCellType(i) == 42 else None
        cells.append((grid.GetCellType(i), [cell.GetPointId(j) for j in range(cell.GetNumberOfPoints())], sides))
    return found | {"cells": cells}


def read(reader, path):
    reader = reader()
    if hasattr(reader, "ReadAllVectorsOn"):
        for what in ("Vectors", "Scalars", "Normals", "Fields"):
            getattr(reader, f"ReadAll{what}On")()
    reader.SetFileName(path)
    reader.Update()
    return reader.GetOutput()


class Volumes(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        offsets = RANDOM.uniform(-0.4, 0.4, (4 * 4 * 4, 3)).tolist()
        with open(self.path("l.json"), "w", encoding="utf-8") as file:
            json.dump({"format": "ffd-lattice", "version": 1, "size": [4, 4, 4], "rest": {"box": {"min": [-1, -1, -1], "max": [5, 5, 5]}},
                       "deformed": {"offsets": offsets}}, file)

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def deform(self, source, target, says=None):
        done = subprocess.run([FFD, "deform", source, target, "-l", "l.json", "--force"], cwd=self.folder.name, capture_output=True, text=True,
                              stdin=subprocess.DEVNULL, check=False)
        self.assertEqual(done.returncode, 0, (source, done.stderr))
        # The cells join random points, so that any number of them, and of their faces, may turn over.
        said = [line for line in done.stderr.splitlines() if not re.search(r"faces are turned over$|\(see --fail-on inverted\)$", line)]
        self.assertEqual(len(said), 1 if says else 0, (source, done.stderr))
        self.assertRegex("".join(said), says or "^$")

    def moved(self, points):
        """Where an OBJ of the same points has them after."""
        with open(self.path("same.obj"), "w", encoding="ascii") as file:
            file.writelines("v %r %r %r\n" % tuple(map(float, point)) for point in points)
        self.deform("same.obj", "same-moved.obj")
        with open(self.path("same-moved.obj"), encoding="ascii") as file:
            return np.array([[float(x) for x in line.split()[1:4]] for line in file])

    def check(self, reader, name, points, what):
        """Deforms the file, and compares what VTK reads before and after."""
        before = read(reader, self.path(name))
        stored = vtk_to_numpy(before.GetPoints().GetData())
        self.deform(name, "after-" + name, says=STAYS)
        after = read(reader, self.path("after-" + name))
        found = vtk_to_numpy(after.GetPoints().GetData())
        self.assertEqual((found.dtype, found.shape), (points.dtype, points.shape), what)
        self.assertEqual(found.tobytes(), self.moved(stored).astype(points.dtype).tobytes(), what)
        self.assertEqual(arrays_of(after), arrays_of(before), what)
        turned, normals = (vtk_to_numpy(grid.GetPointData().GetNormals()) for grid in (after, before))
        self.assertLess(np.abs(np.linalg.norm(turned, axis=1) - 1).max(), 1e-6, what)
        self.assertGreater(np.abs(turned - normals).max(), 1e-3, what)

    def test_xml_of_vtk(self):
        for ending, (reader, writer) in XML.items():
            for kind, mode, packed, wide, coded in itertools.product((np.float32, np.float64), ("Ascii", "Binary", "Appended"), (0, 1), (0, 1), (0, 1)):
                if mode != "Appended" and coded or mode == "Ascii" and (packed or wide):
                    continue
                grid, points = made(ending, kind)
                file = writer()
                getattr(file, f"SetDataModeTo{mode}")()
                file.SetCompressorTypeToZLib() if packed else file.SetCompressorTypeToNone()
                file.SetHeaderTypeToUInt64() if wide else file.SetHeaderTypeToUInt32()
                file.SetEncodeAppendedData(bool(coded))
                file.SetBlockSize(256)
                file.SetFileName(self.path("a." + ending))
                file.SetInputData(grid)
                self.assertTrue(file.Write())
                self.check(reader, "a." + ending, points, (ending, kind, mode, packed, wide, coded))

    def test_legacy_files_of_vtk(self):
        for ending, (reader, writer) in LEGACY.items():
            for kind, binary, version in itertools.product((np.float32, np.float64), (0, 1), (42, 51)):
                grid, points = made(ending, kind)
                file = writer()
                file.SetFileType(2 if binary else 1)
                file.SetFileVersion(version)
                file.SetFileName(self.path("a.vtk"))
                file.SetInputData(grid)
                self.assertTrue(file.Write())
                self.check(reader, "a.vtk", points, (ending, kind, binary, version))

    def test_other_compressors_of_vtk_are_refused(self):
        for name in ("LZ4", "LZMA"):
            file = vtkXMLUnstructuredGridWriter()
            getattr(file, f"SetCompressorTypeTo{name}")()
            file.SetFileName(self.path("a.vtu"))
            file.SetInputData(made("vtu", np.float32)[0])
            self.assertTrue(file.Write())
            done = subprocess.run([FFD, "deform", "a.vtu", "b.vtu", "-l", "l.json"], cwd=self.folder.name, capture_output=True, text=True, check=False)
            self.assertEqual((done.returncode, done.stderr.count("\n")), (6, 1), done.stderr)
            self.assertIn(name, done.stderr)
            self.assertFalse(os.path.exists(self.path("b.vtu")))

    def test_files_of_meshio(self):
        points = grid_points(np.float64)
        cells = [("tetra", RANDOM.integers(0, len(points), (7, 4))), ("hexahedron", RANDOM.integers(0, len(points), (3, 8))),
                 ("wedge", RANDOM.integers(0, len(points), (2, 6))), ("pyramid", RANDOM.integers(0, len(points), (2, 5))), ("triangle", RANDOM.integers(0, len(points), (4, 3)))]
        quadratic = [("tetra10", RANDOM.integers(0, len(points), (3, 10))), ("hexahedron20", RANDOM.integers(0, len(points), (3, 20)))]
        heat = RANDOM.random(len(points))

        def write(name, kinds, **options):
            if name == "a.su2":  # meshio cannot write it: in the layout of SU2's own writer
                numbers = {"tetra": 10, "hexahedron": 12, "wedge": 13, "pyramid": 14}
                rows = [(numbers[kind], *row) for kind, block in kinds for row in block.tolist()]
                with open(self.path(name), "w", encoding="ascii") as file:
                    file.write(f"NDIME= 3\nNELEM= {len(rows)}\n" + "".join("\t".join(map(str, (*row, i))) + "\n" for i, row in enumerate(rows)))
                    file.write(f"NPOIN= {len(points)}\n" + "".join(f"{x:.15e}\t{y:.15e}\t{z:.15e}\t{i}\n" for i, (x, y, z) in enumerate(points.tolist())))
                    file.write("NMARK= 1\nMARKER_TAG= wall\nMARKER_ELEMS= 1\n5\t0\t1\t2\n")
                return
            # With NumPy 2 meshio does not read its own data of nodes in text of Gmsh.
            has_data = ".msh" not in name or options["binary"]
            meshio.Mesh(points, kinds, {"heat": heat} if has_data else {}).write(self.path(name), **options)

        for name, kinds, options in (("a.vtk", cells + quadratic, {"binary": False}), ("a.vtk", cells + quadratic, {"binary": True}),
                                     ("a.vtk", cells, {"file_format": "vtk42", "binary": True}), ("a.vtu", cells + quadratic, {"binary": False}),
                                     ("a.vtu", cells + quadratic, {"binary": True}), ("a.vtu", cells, {"binary": True, "compression": None}),
                                     ("a.msh", cells + quadratic, {"file_format": "gmsh22", "binary": False}), ("a.msh", cells + quadratic, {"file_format": "gmsh22", "binary": True}),
                                     ("a.msh", cells[:1], {"file_format": "gmsh", "binary": False}), ("a.msh", quadratic[:1], {"file_format": "gmsh", "binary": True}),
                                     ("a.su2", cells[:4], {})):
            what = (name, options)
            write(name, kinds, **options)
            self.deform(name, "after-" + name)
            before, after = meshio.read(self.path(name)), meshio.read(self.path("after-" + name))
            self.assertTrue(np.array_equal(after.points, self.moved(before.points)), what)
            self.assertEqual([(block.type, block.data.tolist()) for block in after.cells], [(block.type, block.data.tolist()) for block in before.cells], what)
            self.assertEqual({key: value.tobytes() for key, value in after.point_data.items()}, {key: value.tobytes() for key, value in before.point_data.items()}, what)


if __name__ == "__main__":
    unittest.main()
