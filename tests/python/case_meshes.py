"""Meshes of trimesh, meshio and pyvista: what they store turns with them or is named, and the result says what happened."""

import itertools
import unittest

import ffd_mesh as ffd
import meshio
import numpy as np
import support
import trimesh

try:
    import pyvista
except ImportError:
    pyvista = None

LATTICE = ffd.Lattice.box((-1, -1, -1), (1, 1, 1))
Q = LATTICE.rest.copy()
Q[..., 1] += 0.8 * Q[..., 0] + 0.2 * Q[..., 2] ** 2


def angles(a, b):
    """The largest angle between two arrays of unit vectors, in degrees."""
    across, along = np.linalg.norm(np.cross(a, b), axis=1), np.sum(np.asarray(a, float) * b, axis=1)
    return float(np.degrees(np.arctan2(across, along)).max())


def face_normals(points, faces):
    """Unit normals of triangles."""
    found = np.cross(points[faces[:, 1]] - points[faces[:, 0]], points[faces[:, 2]] - points[faces[:, 0]])
    return found / np.linalg.norm(found, axis=1, keepdims=True)


def ball(**more):
    """A meshio mesh, its triangles and the normals of its points."""
    mesh = trimesh.creation.icosphere(subdivisions=2, radius=0.5)
    faces, points = np.array(mesh.faces), np.array(mesh.vertices)
    return meshio.Mesh(points, [("triangle", faces[:100]), ("triangle", faces[100:])], **more), faces, points / 0.5


class Arrays(unittest.TestCase):
    def setUp(self):
        random = support.rng("meshes")
        self.lattice = support.curved(random)
        self.Q = support.pushed(random, self.lattice)
        self.points = random.uniform(0.1, 0.9, (30, 3))
        self.normals = random.standard_normal((30, 3))
        self.normals /= np.linalg.norm(self.normals, axis=1, keepdims=True)
        self.faces = np.arange(30).reshape(10, 3)
        self.wanted = self.lattice.deform(self.lattice.embed(self.points), self.Q, normals=self.normals)

    def test_trimesh(self):
        mesh = trimesh.Trimesh(self.points, self.faces, vertex_normals=self.normals, process=False)
        found = ffd.deform_mesh(mesh, self.lattice, self.Q)
        self.assertIsInstance(found, trimesh.Trimesh)
        self.assertTrue(np.array_equal(found.vertices, self.wanted.points) and np.array_equal(found.faces, self.faces))
        self.assertLess(np.abs(found.vertex_normals - self.wanted.normals).max(), 1e-15)
        self.assertTrue(np.array_equal(mesh.vertices, self.points))
        cloud = ffd.deform_mesh(trimesh.PointCloud(self.points), self.lattice, self.Q)
        self.assertTrue(np.array_equal(cloud.vertices, self.wanted.points))
        with self.assertRaisesRegex(TypeError, "Scene"):
            ffd.deform_mesh(trimesh.Scene(mesh), self.lattice, self.Q)

    def test_a_plane_deforms_meshes_at_z_0(self):
        plane = ffd.Lattice.plane((0, 0), (1, 1), size=4)
        Q = plane.rest + 0.1 * plane.rest[..., ::-1]
        flat = self.points * (1, 1, 0)
        found = ffd.deform_mesh(trimesh.Trimesh(flat, self.faces, process=False), plane, Q)
        self.assertTrue(np.array_equal(found.vertices[:, :2], plane.deform(plane.embed(flat[:, :2]), Q)) and not found.vertices[:, 2].any())
        with self.assertRaisesRegex(TypeError, "lattice must be a Lattice, not Chain"):
            ffd.deform_mesh(found, ffd.Chain([self.lattice]))

    def test_what_trimesh_holds(self):
        mesh = trimesh.creation.icosphere(radius=0.5)
        mesh.face_attributes["Normals"], mesh.vertex_attributes["normals"] = np.array(mesh.face_normals), np.array(mesh.vertex_normals)
        mesh.metadata["normals"] = np.zeros(3)
        found, result = ffd.deform_mesh(mesh, LATTICE, Q, with_result=True)
        self.assertLess(angles(found.face_attributes["Normals"], found.face_normals), 1e-5)
        self.assertLess(angles(found.face_normals, face_normals(found.vertices, found.faces)), 1e-5)
        self.assertLess(angles(found.vertex_attributes["normals"], found.vertex_normals), 1e-5)
        self.assertEqual((result.warnings, "normals" in found.metadata), (["removed, because they cannot turn: 'normals' of the mesh"], False))
        anew, result = ffd.deform_mesh(trimesh.Trimesh(self.points, self.faces, vertex_normals=self.normals, process=False), self.lattice,
                                       self.Q, normals=False, with_result=True)
        self.assertLess(angles(anew.vertex_normals, np.repeat(anew.face_normals, 3, axis=0)), 1e-5)
        self.assertFalse([line for line in result.warnings if "normals" in line])

    def test_meshio(self):
        mesh = meshio.Mesh(self.points, [("triangle", self.faces)], point_data={"Normals": self.normals, "heat": self.points[:, 0]})
        found = ffd.deform_mesh(mesh, self.lattice, self.Q)
        self.assertTrue(np.array_equal(found.points, self.wanted.points) and np.array_equal(mesh.points, self.points))
        self.assertTrue(np.array_equal(found.point_data["Normals"], self.wanted.normals))
        self.assertTrue(np.array_equal(found.point_data["heat"], self.points[:, 0]))
        for flat in (meshio.Mesh(self.points[:, :2], []), meshio.Mesh(self.points[:, :2], [("triangle", self.faces)])):
            with self.assertRaisesRegex(ValueError, r"\(30, 2\).*column of zeros"):
                ffd.deform_mesh(flat, self.lattice)

    def test_every_normal_turns(self):
        mesh, faces, normals = ball()
        mesh.point_data = {name: normals for name in ("Normals", "NORMALS", "Normals_", "vertexNormals", "second normals")}
        mesh.point_data |= dict(zip(("nx", "ny", "nz"), normals.T.astype(np.float32)))
        of_faces = face_normals(mesh.points, faces)
        mesh.cell_data = {"Normals": [of_faces[:100], of_faces[100:]], "inward_normal": [-of_faces[:100], -of_faces[100:]]}
        found, result = ffd.deform_mesh(mesh, LATTICE, Q, with_result=True)
        wanted = LATTICE.deform(LATTICE.embed(mesh.points), Q, normals=normals)
        for name in ("Normals", "NORMALS", "Normals_", "vertexNormals", "second normals"):
            self.assertTrue(np.array_equal(found.point_data[name], wanted.normals), name)
        apart = np.stack([found.point_data[name] for name in ("nx", "ny", "nz")], axis=1)
        self.assertEqual(apart.dtype, np.float32)
        self.assertLess(np.abs(apart - wanted.normals).max(), 1e-6)
        true = face_normals(found.points, faces)
        self.assertLess(angles(np.concatenate(found.cell_data["Normals"]), true), 1e-5)
        self.assertLess(angles(np.concatenate(found.cell_data["inward_normal"]), -true), 1e-5)
        self.assertEqual(result.warnings, [])
        self.assertTrue(np.array_equal(mesh.cell_data["Normals"][0], of_faces[:100]))

    def test_normals_of_cells_turn_as_an_affine_map_says(self):
        random, A = support.rng("affine"), np.array([[1, 0.4, 0], [0, 0.8, 0.3], [0.1, 0, 1.3]])
        points, cells = random.uniform(-0.5, 0.5, (12, 3)), [("tetra", np.arange(12).reshape(3, 4)), ("triangle", np.arange(12).reshape(4, 3))]
        normals = random.standard_normal((7, 3))
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        mesh = meshio.Mesh(points, cells, cell_data={"normals": [normals[:3], normals[3:]]})
        found = np.concatenate(ffd.deform_mesh(mesh, LATTICE, LATTICE.rest @ A.T).cell_data["normals"])
        wanted = normals @ np.linalg.inv(A)
        self.assertLess(np.abs(found - wanted / np.linalg.norm(wanted, axis=1, keepdims=True)).max(), 1e-12)
        mirrored = np.concatenate(ffd.deform_mesh(mesh, LATTICE, LATTICE.rest * (1, 1, -1)).cell_data["normals"])
        self.assertLess(np.abs(mirrored + normals * (1, 1, -1)).max(), 1e-12)

    def test_what_cannot_turn_goes_and_what_stays_is_named(self):
        mesh, faces, normals = ball()
        mesh.point_data = {"normals": faces[:162], "long_normals": 2 * normals, "vertex_normals": normals[:, :2], "tangents": np.zeros((162, 4)), "speed": normals,
                           "heat": normals[:, 0], "color": normals,
                           "normal_stress": normals[:, 0]}
        mesh.cell_data = {"CellNormals": [faces[:100], faces[100:]], "Area": [np.ones(100), np.ones(220)]}
        mesh.field_data = {"Normals": normals}
        with self.assertLogs("ffd_mesh", "WARNING") as logged:
            found, result = ffd.deform_mesh(mesh, LATTICE, Q, with_result=True)
        self.assertEqual(sorted(found.point_data), ["color", "heat", "long_normals", "normal_stress", "speed", "tangents"])
        wanted = LATTICE.deform(LATTICE.embed(mesh.points), Q, normals=normals).normals
        self.assertLess(np.abs(found.point_data["long_normals"] - 2 * wanted).max(), 1e-12)
        self.assertEqual((sorted(found.cell_data), found.field_data), (["Area"], {}))
        self.assertEqual(result.warnings, [
            "turned, though they are no unit vectors, with their lengths: 'long_normals' of the points",
            "removed, because they cannot turn: 'CellNormals' of the cells, 'Normals' of the mesh, 'normals' of the points, 'vertex_normals' of the points",
            "kept as they were, though the mesh has moved: 'Area' of the cells, 'normal_stress' of the points, 'speed' of the points, "
            "'tangents' of the points"])
        self.assertEqual([record.getMessage() for record in logged.records], result.warnings)
        mesh, _, normals = ball()
        mesh.point_data["Normals"] = normals
        kept, result = ffd.deform_mesh(mesh, LATTICE, Q, normals=False, with_result=True)
        self.assertTrue(np.array_equal(kept.point_data["Normals"], normals))
        self.assertEqual(result.warnings, ["kept as they were, though the mesh has moved: 'Normals' of the points"])

    def test_what_does_not_move_keeps_every_bit(self):
        mesh, faces, normals = ball()
        of_faces = face_normals(mesh.points, faces).astype(np.float32)
        mesh.point_data, mesh.cell_data = {"Normals": normals, "speed": normals}, {"Normals": [of_faces[:100], of_faces[100:]]}
        for lattice, words in ((LATTICE, "no point moves: no control point of the lattice does"),
                               (ffd.Lattice.box((3, 3, 3), (4, 4, 4)).moved(offsets=np.ones((4, 4, 4, 3))), "no point moves")):
            found, result = ffd.deform_mesh(mesh, lattice, with_result=True)
            self.assertEqual((result.moved, result.warnings[-1]), (0, words))
            self.assertEqual(found.points.tobytes(), mesh.points.tobytes())
            self.assertEqual(found.point_data["Normals"].tobytes(), normals.tobytes())
            self.assertEqual(np.concatenate(found.cell_data["Normals"]).tobytes(), of_faces.tobytes())
        half = ffd.Lattice.box((0, -1, -1), (1, 1, 1), 5, 1)
        found = ffd.deform_mesh(mesh, half, half.rest * (1, 1, 1.5))
        still = (mesh.points[faces][..., 0] < 0).all(axis=1)
        self.assertEqual(np.concatenate(found.cell_data["Normals"])[still].tobytes(), of_faces[still].tobytes())
        self.assertLess(angles(np.concatenate(found.cell_data["Normals"]), face_normals(found.points, faces)), 1e-3)


class Results(unittest.TestCase):
    def test_the_result_is_that_of_the_program(self):
        mesh = trimesh.creation.icosphere(subdivisions=3, radius=1.3)
        found, result = ffd.deform_mesh(mesh, LATTICE, Q, with_result=True)
        data = mesh.export(file_type="off", digits=17).encode()
        wanted = ffd.positions_bytes(data, LATTICE.moved(Q), name="a.off", quality=True).result
        self.assertGreater(min(wanted.tear.edges, wanted.flipped_faces, wanted.counts["outside"]), 0)
        for one in ("moved", "counts", "flipped_faces", "faces", "warnings", "vertices"):
            self.assertEqual(getattr(result, one), getattr(wanted, one), one)
        self.assertEqual((result.tear.edges, result.tear.vertex), (wanted.tear.edges, wanted.tear.vertex))
        self.assertEqual(np.array(found.vertices).tobytes(), LATTICE.deform(LATTICE.embed(np.array(mesh.vertices)), Q).tobytes())
        with self.assertLogs("ffd_mesh", "WARNING") as logged:
            self.assertIsInstance(ffd.deform_mesh(mesh, LATTICE, Q), trimesh.Trimesh)
        self.assertIn("left where they are", logged.output[0])

    def test_edges_of_lines_and_of_the_inside_are_torn_and_no_faces(self):
        half = ffd.Lattice.box((-1, -1, -1), (0.1, 1, 1))
        grid = np.array(list(itertools.product((0, 0.5), repeat=3)))
        corners = np.array([0, 4, 6, 2, 1, 5, 7, 3])
        several = np.concatenate([grid - (0.5, 0, 0), grid])
        line, one = meshio.Mesh(grid, [("line", [[0, 4], [4, 5]])]), meshio.Mesh(grid, [("hexahedron", corners[None])])
        two = meshio.Mesh(np.unique(several, axis=0), [("hexahedron", np.searchsorted(np.unique(several @ [9, 3, 1]), [c @ [9, 3, 1] for c in (several[corners], several[8 + corners])]))])
        for mesh, edges, faces in ((line, 1, 0), (one, 4, 6), (two, 4, 10)):
            _, result = ffd.deform_mesh(mesh, half, half.rest + 0.3, with_result=True)
            self.assertEqual((result.tear.edges, result.faces), (edges, faces))

    def test_every_number_type_and_empty_meshes(self):
        mesh, faces, normals = ball()
        wanted = ffd.deform_mesh(mesh, LATTICE, Q).points
        for kind in (">f8", "f4", ">f4"):
            found = ffd.deform_mesh(meshio.Mesh(mesh.points.astype(kind), mesh.cells, point_data={"normals": normals.astype(kind)}), LATTICE, Q)
            self.assertLess(np.abs(found.points - wanted).max(), 1e-6)
            self.assertTrue(found.point_data["normals"].dtype == np.dtype(kind) and found.points.dtype == np.dtype(kind).newbyteorder("="))
        for kind in ("u8", "i4", "u1", ">i8"):
            several = meshio.Mesh(mesh.points, [("triangle", faces.astype(kind)), ("line", np.array([[0, 161]], "i8"))])
            self.assertEqual(ffd.deform_mesh(several, LATTICE, Q, with_result=True)[1].faces, 320)
        whole = ffd.deform_mesh(meshio.Mesh(np.array([[0, 0, 0], [1, 0, 1]]), [("line", [[0, 1]])]), LATTICE, Q)
        self.assertTrue(np.array_equal(whole.points, LATTICE.deform(LATTICE.embed(np.array([[0., 0, 0], [1, 0, 1]])), Q)))
        none, result = ffd.deform_mesh(meshio.Mesh(np.empty((0, 3)), []), LATTICE, Q, with_result=True)
        self.assertEqual((none.points.shape, result.moved, len(result.warnings)), ((0, 3), 0, 1))

    def test_options_and_refusals(self):
        mesh, _, _ = ball()
        far = meshio.Mesh(4 * mesh.points, mesh.cells)
        for options in ({"outside": "extend"}, {"outside": "extend", "falloff": 0.7}, {"snap": 0.2}, {"threads": 1, "isa": "scalar"}):
            for kind in ("f4", "f8"):
                points = far.points.astype(kind)
                found = ffd.deform_mesh(meshio.Mesh(points, far.cells), LATTICE, Q, **options).points
                self.assertEqual(found.tobytes(), LATTICE.deform(LATTICE.embed(points, **options), Q).tobytes(), options)
        for options, kind, words in (({"outside": "error"}, ffd.EmbeddingError, "outside"), ({"falloff": 1}, ffd.ArgumentError, "outside='extend'"),
                                     ({"only": "x"}, TypeError, "unknown option 'only'"), ({"outside": "stay"}, ValueError, "'keep'")):
            with self.assertRaisesRegex(kind, words):
                ffd.deform_mesh(far, LATTICE, Q, **options)
        with self.assertRaises(ffd.Cancelled):
            ffd.deform_mesh(mesh, LATTICE, Q, progress=lambda done: False)
        fitted = ffd.Lattice.parse({"format": "ffd-lattice", "version": 1, "size": [3, 3, 3], "rest": {"box": "mesh"},
                                    "moves": [{"twist": {"axis": "z", "degrees": 30}}]})
        self.assertGreater(ffd.deform_mesh(mesh, fitted, with_result=True)[1].moved, 100)
        for other in (mesh.points, None, "a.obj", object()):
            with self.assertRaisesRegex(TypeError, "no mesh"):
                ffd.deform_mesh(other, LATTICE)


@unittest.skipIf(pyvista is None, "pyvista is not installed")
class Pyvista(unittest.TestCase):
    def sphere(self, **more):
        return pyvista.Sphere(radius=0.5).compute_normals(**more)

    def test_normals_of_points_and_cells(self):
        mesh = self.sphere(cell_normals=True, point_normals=True)
        mesh.point_data["other"] = np.array(mesh.point_data["Normals"])
        mesh.point_data.active_normals_name = "other"
        found, result = ffd.deform_mesh(mesh, LATTICE, Q, with_result=True)
        again = pyvista.PolyData(np.array(found.points), found.faces)
        fresh = again.compute_normals(cell_normals=True, point_normals=False, auto_orient_normals=False, consistent_normals=False)
        self.assertLess(angles(found.cell_data["Normals"], fresh.cell_data["Normals"]), 1e-2)
        wanted = LATTICE.deform(LATTICE.embed(np.array(mesh.points)), Q, normals=np.array(mesh.point_data["Normals"]))
        for name in ("Normals", "other"):
            self.assertTrue(np.array_equal(found.point_data[name], wanted.normals))
        self.assertEqual((found.point_data.active_normals_name, found.points.dtype, result.warnings), ("other", np.float32, []))
        self.assertTrue(np.array_equal(found.points, wanted.points))
        mesh.field_data["Normals"] = np.ones((2, 3))
        found, result = ffd.deform_mesh(mesh, LATTICE, Q, with_result=True)
        self.assertEqual((list(found.field_data), len(result.warnings), list(mesh.field_data)), ([], 1, ["Normals"]))

    def test_cells_of_every_kind(self):
        random = support.rng("kinds")
        for name, faces in (("Tetrahedron", 4), ("Voxel", 6), ("Wedge", 5), ("Pyramid", 5), ("Hexahedron", 6), ("QuadraticHexahedron", 6),
                            ("QuadraticTetrahedron", 4), ("QuadraticWedge", 5), ("QuadraticPyramid", 5), ("TriQuadraticHexahedron", 6), ("Pixel", 1),
                            ("Quadrilateral", 1), ("Polygon", 1), ("TriangleStrip", None), ("PolyLine", 0), ("Vertex", 0)):
            mesh = getattr(pyvista.examples.cells, name)().scale(0.2)
            normals = random.standard_normal((mesh.n_cells, 3))
            mesh.cell_data["Normals"] = normals / np.linalg.norm(normals, axis=1, keepdims=True)
            found, result = ffd.deform_mesh(mesh, LATTICE, LATTICE.rest @ np.array([[1, 0.4, 0], [0, 0.8, 0.3], [0.1, 0, 1.3]]), with_result=True)
            wanted = mesh.cell_data["Normals"] @ np.linalg.inv(np.array([[1, 0.4, 0], [0, 0.8, 0.3], [0.1, 0, 1.3]])).T
            self.assertLess(angles(found.cell_data["Normals"], wanted / np.linalg.norm(wanted, axis=1, keepdims=True)), 1e-4, name)
            self.assertEqual((result.faces if faces is not None else None, result.counts["inside"], result.warnings), (faces, mesh.n_points, []), name)
        _, result = ffd.deform_mesh(pyvista.examples.cells.Polyhedron().scale(0.2), LATTICE, Q, with_result=True)
        self.assertEqual(result.warnings, ["edges and faces of cells of the kinds 42 of VTK are not looked at"])

    def test_grids_without_points_come_back_with_points(self):
        image = pyvista.ImageData(dimensions=(4, 3, 2), spacing=(0.2, 0.2, 0.3))
        image.cell_data["heat"] = np.arange(image.n_cells)
        for mesh in (image, pyvista.RectilinearGrid([0, 0.2, 0.4, 0.6], [0, 0.2, 0.4], [0, 0.3])):
            found = ffd.deform_mesh(mesh, LATTICE, Q)
            points = np.array(mesh.points)
            self.assertIsInstance(found, pyvista.StructuredGrid)
            self.assertEqual(found.dimensions, (4, 3, 2))
            self.assertTrue(np.array_equal(found.points, LATTICE.deform(LATTICE.embed(points), Q)))
        self.assertTrue(np.array_equal(ffd.deform_mesh(image, LATTICE, Q).cell_data["heat"], image.cell_data["heat"]))

    def test_blocks(self):
        sphere = self.sphere(cell_normals=True)
        blocks = pyvista.MultiBlock({"a": sphere, "b": None, "c": pyvista.MultiBlock([pyvista.ImageData(dimensions=(2, 2, 2)), self.sphere()])})
        found, result = ffd.deform_mesh(blocks, LATTICE, Q, with_result=True)
        self.assertEqual(found.keys(), ["a", "b", "c"])
        self.assertTrue(found["b"] is None and isinstance(found["c"][0], pyvista.StructuredGrid))
        alone = ffd.deform_mesh(sphere, LATTICE, Q)
        for one in (found["a"], found["c"][1]):
            self.assertTrue(np.array_equal(one.points, alone.points) and np.array_equal(one.point_data["Normals"], alone.point_data["Normals"]))
        self.assertTrue(np.array_equal(found["a"].cell_data["Normals"], alone.cell_data["Normals"]))
        self.assertEqual(result.vertices, 2 * sphere.n_points + 8)
        self.assertTrue(np.array_equal(sphere.points, blocks["a"].points) and isinstance(blocks["c"][0], pyvista.ImageData))
        empty, result = ffd.deform_mesh(pyvista.MultiBlock(), LATTICE, Q, with_result=True)
        self.assertEqual((len(empty), result.vertices), (0, 0))
        with self.assertRaisesRegex(TypeError, "no mesh"):
            ffd.deform_mesh(pyvista.Table({"a": np.arange(3)}), LATTICE)


if __name__ == "__main__":
    unittest.main()
