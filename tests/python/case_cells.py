"""Cells of volume meshes: counts and scaled Jacobians beside vtkMeshQuality, numbers by hand, kinds of meshio, what is refused."""

import importlib.util
import os
import tempfile
import unittest

import ffd_mesh as ffd
import meshio
import numpy as np
import support

RANDOM = support.rng("cells")
HAS_VTK = importlib.util.find_spec("vtkmodules") is not None
CUBE = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1.]])
# meshio's name -> VTK's number, a cell.
CELLS = {
    "tetra": (10, CUBE[[0, 1, 3, 4]]), "hexahedron": (12, CUBE), "wedge": (13, CUBE[[0, 1, 3, 4, 5, 7]]),
    "pyramid": (14, np.concatenate([CUBE[:4], [[0.5, 0.5, 0.7]]]))}


def quality(points, cells, kind):
    """The scaled Jacobians that VTK finds."""
    from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkUnstructuredGrid
    from vtkmodules.vtkFiltersVerdict import vtkMeshQuality
    grid, places, list_of, judge = vtkUnstructuredGrid(), vtkPoints(), vtkCellArray(), vtkMeshQuality()
    places.SetData(numpy_to_vtk(np.ascontiguousarray(points, np.float64), deep=True))
    grid.SetPoints(places)
    list_of.SetData(cells.shape[1], numpy_to_vtkIdTypeArray(np.ascontiguousarray(cells, np.int64).ravel(), deep=True))
    grid.SetCells(kind, list_of)
    judge.SetInputData(grid)
    for family in ("Tet", "Hex", "Wedge", "Pyramid"):
        getattr(judge, f"Set{family}QualityMeasureToScaledJacobian")()
    judge.Update()
    return vtk_to_numpy(judge.GetOutput().GetCellData().GetArray("Quality")).copy()


def grid(n):
    """Points of a grid on [0, 1]^3, and six tetrahedra in each of its boxes."""
    z, y, x = (axis.ravel() for axis in np.meshgrid(*[np.arange(n + 1)] * 3, indexing="ij"))
    at = np.flatnonzero((x < n) & (y < n) & (z < n))
    corner = [at + i + (n + 1) * (j + (n + 1) * k) for k in (0, 1) for j in (0, 1) for i in (0, 1)]
    cells = [np.stack([corner[0], corner[a], corner[b], corner[7]], axis=1) for a, b in ((1, 3), (3, 2), (2, 6), (6, 4), (4, 5), (5, 1))]
    return np.stack([x, y, z], axis=1) / n, np.concatenate(cells)


class Cells(unittest.TestCase):
    def test_numbers_by_hand(self):
        corners = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (0, 0, -1)]
        found = ffd.cells(corners, [(0, 1, 2, 3), (0, 1, 2, 4)], "tetra")
        self.assertEqual((found.inverted.tolist(), found.unknown.tolist(), found.jacobian.tolist()), ([False, True], [False, False], [1, -1]))
        np.testing.assert_allclose(found.scaled_jacobian, [0.5 ** 0.5, -(0.5 ** 0.5)], rtol=1e-15)
        self.assertEqual((found.inverted.dtype, found.unknown.dtype, found.jacobian.dtype), (bool, bool, np.float64))
        self.assertEqual(ffd.cells(2 * CUBE, [range(8)], "hexahedron").jacobian.tolist(), [8])
        self.assertEqual(ffd.cells(CUBE, [[0, 1, 3, 2, 4, 5, 7, 6]], "voxel").jacobian.tolist(), [1])

    def test_polyhedra_are_lists_of_faces(self):
        faces = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]]
        for kind in ("polyhedron", "polyhedron8"):
            found = ffd.cells(CUBE, [faces, [face[::-1] for face in faces]], kind)
            self.assertEqual((found.inverted.tolist(), found.unknown.tolist()), ([False, True], [False, False]))
            self.assertTrue(np.isnan(found.scaled_jacobian).all())

    def test_kinds_of_meshio_up_to_the_second_order_are_known(self):
        linear = {"tetra": 4, "pyramid": 5, "wedge": 6, "hexahedron": 8}
        kinds = linear | {f"{name}{count}": count for name, counts in (("tetra", [10]), ("pyramid", [13, 14]), ("wedge", [12, 15, 18]), ("hexahedron", [20, 24, 27]))
                          for count in counts}
        for name, size in kinds.items():
            self.assertEqual(meshio._mesh.num_nodes_per_cell.get(name, size), size)
            self.assertEqual(ffd.cells(np.zeros((size, 3)), [range(size)], name).inverted.tolist(), [True])
            with self.assertRaisesRegex(ValueError, f"shape .C, {size}."):
                ffd.cells(np.zeros((size, 3)), [range(size - 1)], name)
        of_third_order = [name for name, dimension in meshio._mesh.topological_dimension.items()
                          if dimension == 3 and name not in kinds and not name.startswith(("VTK", "penta", "hexa_", "poly"))]
        self.assertIn("tetra20", of_third_order)
        for name in of_third_order:
            with self.assertRaisesRegex(ValueError, "not a kind of volume cells that is known"):
                ffd.cells(np.zeros((4, 3)), [range(4)], name)

    def test_quadratic_cells_are_unknown_where_signs_differ(self):
        corners = CUBE[[0, 1, 3, 4]]
        middles = [(corners[i] + corners[k]) / 2 for i, k in ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))]
        points = np.concatenate([corners, middles])
        self.assertEqual(ffd.cells(points, [range(10)], "tetra10")[:3], ([False], [False], [1]))
        points[4, 0] = 0.9
        found = ffd.cells(points, [range(10)], "tetra10")
        self.assertEqual((found.inverted.tolist(), found.unknown.tolist()), ([False], [True]))
        self.assertLess(found.jacobian[0], 0)
        self.assertTrue(ffd.cells(points * (1, 1, -1), [range(10)], "tetra10").unknown[0])
        points[4, 0] = 0.5
        self.assertEqual(ffd.cells(points * (1, 1, -1), [range(10)], "tetra10")[:2], ([True], [False]))

    @unittest.skipUnless(HAS_VTK, "VTK is not installed")
    def test_scaled_jacobians_are_those_of_vtk(self):
        for name, (kind, cell) in CELLS.items():
            points = cell + RANDOM.normal(size=(2000, *cell.shape)) * RANDOM.choice([0, 0.1, 0.3, 0.8], (2000, 1, 1))
            points = (points * RANDOM.uniform(0.1, 10, (2000, 1, 1))).reshape(-1, 3)
            cells = np.arange(len(points)).reshape(2000, -1)
            found, expected = ffd.cells(points, cells, name, threads=2), quality(points, cells, kind)
            np.testing.assert_allclose(found.scaled_jacobian, expected, rtol=0, atol=2e-15)
            # VTK also looks at the axes of a hexahedron.
            self.assertTrue((found.inverted | found.unknown)[expected <= 0].all(), name)
            if name in ("tetra", "pyramid"):
                self.assertEqual(found.inverted.tolist(), (expected <= 0).tolist())

    @unittest.skipUnless(HAS_VTK, "VTK is not installed")
    def test_a_layer_of_96000_tetrahedra_is_counted_as_vtk_counts_it(self):
        points, cells = grid(25)
        points, cells = np.concatenate([points, points[:, ] + (2, 0, 0)]), np.concatenate([cells, cells[:2250] + len(points)])
        lattice = ffd.Lattice.box((0, 0, 0), (1, 1, 1), size=(2, 2, 6), degree=(1, 1, 2))
        Q = lattice.rest.copy()
        Q[:, :, 2, 2] += 0.8
        with tempfile.TemporaryDirectory() as folder:
            mesh, out = os.path.join(folder, "a.vtk"), os.path.join(folder, "b.vtk")
            with open(mesh, "w", encoding="ascii") as file:
                file.write(f"# vtk DataFile Version 3.0\n\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS {len(points)} double\n")
                file.write("".join("%r %r %r\n" % tuple(p) for p in points.tolist()) + f"CELLS {len(cells)} {5 * len(cells)}\n")
                file.write("".join("4 %d %d %d %d\n" % tuple(c) for c in cells.tolist()) + f"CELL_TYPES {len(cells)}\n" + "10\n" * len(cells))
            result = ffd.deform_file(mesh, out, lattice.moved(Q))
            moved = meshio.read(out).points
        before, after = quality(points, cells, 10), quality(moved, cells, 10)
        self.assertEqual(len(cells), 96000)
        self.assertGreater(int((after <= 0).sum()), 10000)
        self.assertEqual((result.cells.count, result.cells.inverted.before, result.cells.inverted.after, result.cells.by_deformation, result.cells.unknown),
                         (96000, int((before <= 0).sum()), int((after <= 0).sum()), int((after <= 0).sum()), 0))
        np.testing.assert_allclose([result.cells.scaled_jacobian.before, result.cells.scaled_jacobian.after, after[result.cells.worst]],
                                   [before.min(), after.min(), after.min()], rtol=0, atol=2e-15)
        self.assertIn("cells are inverted by the deformation", " ".join(result.warnings))

    def test_arrays_of_any_layout(self):
        points, cells = grid(6)
        points = points + RANDOM.normal(size=points.shape) * 0.08
        narrow = points.astype(np.float32)
        one = ffd.cells(narrow.astype(np.float64), cells, "tetra", threads=1)
        strided = np.zeros((len(points), 9), np.float32)[:, ::4]
        strided[:] = narrow
        for other in (ffd.cells(narrow, cells.astype(np.uint8 if len(points) < 256 else np.int32), "tetra", threads=3),
                      ffd.cells(strided, np.asfortranarray(cells), "tetra"), ffd.cells(narrow[::-1], len(points) - 1 - cells, "tetra")):
            for name in one._fields:
                self.assertEqual(getattr(one, name).tobytes(), getattr(other, name).tobytes(), name)
        self.assertTrue(0 < one.inverted.sum() < len(cells))
        for empty in ([], np.empty((0, 4), int)):
            self.assertEqual(len(ffd.cells(points, empty, "tetra").inverted), 0)

    def test_what_is_refused(self):
        for cells, kind, kind_of_error, words in (
                ([[0, 1, 2, 8]], "tetra", ValueError, "the point 8, but there are 8"), ([[0, 1, 2, -1]], "tetra", ValueError, "the point -1"),
                ([[0, 1, 2]], "tetra", ValueError, r"\(C, 4\), not \(1, 3\)"), ([[0, 1, 2, 3.0]], "tetra", TypeError, "integers"),
                ([[0, 1, 2]], "triangle", ValueError, "not a kind of volume cells"), ([[0, 1, 2, 3]], "Tetra", ValueError, "not a kind of volume cells"),
                ([[[0, 1, 9]]], "polyhedron", ValueError, "the point 9"), (7, "polyhedron", TypeError, "iterable"), ([[0, 1, 2, 3]], 4, TypeError, "kind")):
            with self.assertRaisesRegex(kind_of_error, words):
                ffd.cells(CUBE, cells, kind)
        with self.assertRaises(ffd.Cancelled):
            ffd.cells(CUBE, [range(8)], "hexahedron", progress=lambda done: False)

    def test_gates_and_results_of_jobs(self):
        lattice = ffd.Lattice.box((0, 0, 0), (1, 1, 1), size=(2, 2, 2))
        text = "\n".join(["# vtk DataFile Version 3.0", "", "ASCII", "DATASET UNSTRUCTURED_GRID", "POINTS 4 double", "0 0 0 0.5 0 0 0 0.5 0 0 0 0.5",
                          "CELLS 1 5", "4 0 1 2 3", "CELL_TYPES 1", "10", ""]).encode()
        mirrored = lattice.moved(lattice.rest * (1, 1, -1))
        self.assertEqual(ffd.check_bytes(text, lattice, name="a.vtk", fail_on="inverted,quality=0.5").cells.worst, 0)
        for gates in ("inverted", ["inverted=0"], "quality=0"):
            with self.assertRaises(ffd.GateError) as caught:
                ffd.check_bytes(text, mirrored, name="a.vtk", fail_on=gates)
            self.assertEqual(caught.exception.result.cells.by_deformation, 1)
        self.assertEqual(ffd.check_bytes(text, mirrored, name="a.vtk", fail_on="inverted=1,quality=-1").cells.inverted.after, 1)
        obj = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
        self.assertIsNone(ffd.check_bytes(obj, lattice, name="a.obj").cells)
        with self.assertRaisesRegex(ffd.ArgumentError, "no volume cells"):
            ffd.check_bytes(obj, lattice, name="a.obj", fail_on="inverted")
        with self.assertRaisesRegex(ValueError, "quality=MIN"):
            ffd.check_bytes(obj, lattice, name="a.obj", fail_on="quality")


if __name__ == "__main__":
    unittest.main()
