"""The class of PyGeM against results of PyGeM itself, and against de Casteljau's algorithm on the sums that define its map."""

import configparser
import contextlib
import copy
import glob
import io
import json
import os
import pickle
import sys
import tempfile
import types
import unittest

import ffd_mesh as ffd
import numpy as np
import support
from ffd_mesh import pygem
from ffd_mesh.pygem import FFD

CASES = os.path.join(support.SOURCE, "tests", "cli", "authoring")
RANDOM = support.rng("pygem")
CORNERS = np.array(list(np.ndindex(2, 2, 2)), float)
ATTRIBUTES = ("n_control_points", "box_length", "box_origin", "rot_angle", "array_mu_x", "array_mu_y", "array_mu_z")


def cases(kind):
    found = []
    for path in sorted(glob.glob(os.path.join(CASES, f"{kind}-*.json"))):
        with open(path, encoding="utf-8") as file:
            found.append(json.load(file))
    assert found, kind
    return found


def turns(angles):
    """The product of three turns, each by its definition."""
    product = np.eye(3)
    for axis, angle in enumerate(np.radians(angles)):
        turn, (b, c) = np.eye(3), ((axis + 1) % 3, (axis + 2) % 3)
        turn[b, b] = turn[c, c] = np.cos(angle)
        turn[b, c], turn[c, b] = -np.sin(angle), np.sin(angle)
        product = product @ turn
    return product


def casteljau(mu, t):
    """The Bernstein sums of mu (nx, ny, nz, 3) at t (N, 3), by repeated averages."""
    values = np.broadcast_to(mu, (len(t), *mu.shape))
    for axis in range(3):
        while values.shape[1] > 1:
            s = t[:, axis].reshape(-1, *[1] * (values.ndim - 1))
            values = (1 - s) * values[:, :-1] + s * values[:, 1:]
        values = values[:, 0]
    return values


def weights(box):
    return np.stack([box.array_mu_x, box.array_mu_y, box.array_mu_z], axis=-1)


def shift(box, t):
    """What the places t of the unit cube are moved by."""
    return (casteljau(weights(box), t) * box.box_length) @ turns(box.rot_angle).T


def place(box, t):
    return (t * box.box_length) @ turns(box.rot_angle).T + box.box_origin


def random_box(counts=None, kind=FFD, far=3.0):
    """Any number of control points, lengths of both signs, and angles that may be quarters."""
    box = kind(RANDOM.integers(1, 16, 3) if counts is None else counts)
    box.box_length = RANDOM.uniform(0.3, 3, 3) * RANDOM.choice([-1, 1], 3)
    box.box_origin = RANDOM.uniform(-far, far, 3)
    box.rot_angle = np.where(RANDOM.random(3) < 0.3, RANDOM.choice([-180, -90, 0, 90, 270]), RANDOM.uniform(-400, 400, 3))
    for name in ATTRIBUTES[4:]:
        setattr(box, name, RANDOM.uniform(-0.3, 0.3, box.n_control_points))
    return box


def state(box):
    return [np.array(getattr(box, name)).tolist() for name in ATTRIBUTES]


def shown(box):
    return state(box)[:4]


class Map(unittest.TestCase):
    def near(self, found, right, tolerance, what=None):
        self.assertEqual(np.shape(found), np.shape(right), what)
        self.assertLessEqual(np.abs(np.subtract(found, right)).max(initial=0), tolerance, what)

    def test_what_pygem_makes(self):
        for case in cases("pygem"):
            box, expect = FFD(case["n_control_points"]), case["expect"]
            for name in ATTRIBUTES[1:]:
                setattr(box, name, np.array(case[name]))
            tolerance = expect.get("tolerance", 1e-12)
            self.near(box(np.array(case["before"])), expect["after"], tolerance, case["name"])
            self.near(box.control_points(False), expect["control_points"], tolerance)
            self.near(box.control_points(), expect["deformed_control_points"], tolerance)
            self.near(box.rotation_matrix, expect["rotation_matrix"], tolerance)
            self.near(box.position_vertices, expect["position_vertices"], tolerance)
        for case in cases("interop-prm"):
            with tempfile.TemporaryDirectory() as folder:
                path = os.path.join(folder, "X.prm")
                with open(path, "w", encoding="utf-8") as file:
                    file.write(case["prm"])
                box = FFD()
                box.read_parameters(path)
            self.near(box(np.array(case["before"])), case["expect"]["after"], case["expect"].get("tolerance", 1e-12), case["name"])

    def test_random_boxes(self):
        for _ in range(60):
            box = random_box()
            t = RANDOM.uniform(-0.3, 1.3, (200, 3))
            t[:100] = RANDOM.uniform(0.001, 0.999, (100, 3))
            points = place(box, t)
            inside = ((t >= 0) & (t <= 1)).all(axis=1)
            before = points.copy()
            after = box(points)
            self.assertEqual(points.tobytes(), before.tobytes())
            self.near(after[inside], points[inside] + shift(box, t[inside]), 1e-12, shown(box))
            self.assertEqual(after[~inside].tobytes(), points[~inside].tobytes())
            self.assertTrue(inside[:100].all() and not inside.all())
            single = points[:100].astype(np.float32)
            found = box(single)
            self.assertEqual(found.dtype, np.float32)
            exact = (single.astype(np.float64) - box.box_origin) @ turns(box.rot_angle) / box.box_length
            right = single + shift(box, exact)
            self.assertLessEqual((np.abs(found - right) - np.spacing(np.abs(right).astype(np.float32)) / 2).max(), 1e-12, shown(box))

    def test_the_border_is_inside(self):
        for kind, far in ((np.float64, 3.0), (np.float64, 1e5), (np.float32, 3.0), (np.float32, 300.0)):
            for _ in range(25):
                box = random_box(RANDOM.integers(2, 7, 3), far=far)
                t = RANDOM.random((90, 3))
                for face in range(6):
                    t[face * 10:face * 10 + 10, face // 2] = face % 2
                    t[60 + face * 5:65 + face * 5, [face % 3, (face + 1) % 3]] = RANDOM.integers(0, 2, (5, 2))
                t = np.vstack([t, CORNERS])
                points = place(box, t).astype(kind)
                step = np.spacing(np.abs(points).max())
                self.near(box(points), points.astype(np.float64) + shift(box, t), max(1e-12, 64 * step), (kind, shown(box)))
                moved = np.abs(shift(box, t)).max(axis=1) > max(1e-12, 64 * step)
                self.assertTrue((box(points) != points).any(axis=1)[moved].all())
                self.assertGreater(moved.sum(), 90)

    def test_corners_of_far_boxes_move(self):
        for _ in range(400):
            box = random_box((2, 2, 2), far=1e5)
            points = place(box, CORNERS)
            off = np.abs(box(points) - points - shift(box, CORNERS)).max()
            self.assertLess(off, 64 * np.spacing(np.abs(points).max()), shown(box))

    def test_what_is_beside_the_border_stays(self):
        for _ in range(20):
            box = random_box(RANDOM.integers(2, 7, 3))
            t = RANDOM.uniform(0, 1, (60, 3))
            for face in range(6):
                t[face * 10:face * 10 + 10, face // 2] = (-1e-10, 1 + 1e-10)[face % 2]
            points = place(box, t)
            self.assertEqual(box(points).tobytes(), points.tobytes(), shown(box))

    def test_one_control_point_along_a_side(self):
        for counts in ((1, 3, 4), (4, 1, 1), (1, 1, 1)):
            box = random_box(counts)
            double = FFD(np.maximum(counts, 2))
            double.box_length, double.box_origin, double.rot_angle = box.box_length, box.box_origin, box.rot_angle
            for name in ATTRIBUTES[4:]:
                setattr(double, name, getattr(box, name) + np.zeros(double.n_control_points))
            points = place(box, RANDOM.random((50, 3)))
            self.near(box(points), double(points), 0)
            self.near(box(points), points + shift(box, (points - box.box_origin) @ turns(box.rot_angle) / box.box_length), 1e-12)
            self.assertEqual(box.lattice.size, tuple(double.n_control_points))

    def test_maps_of_the_cube(self):
        for _ in range(10):
            box = random_box(RANDOM.integers(1, 7, 3))
            self.near(box.psi(box.position_vertices - box.box_origin), FFD.reference_frame, 1e-12)
            t = RANDOM.uniform(-0.5, 1.5, (40, 3))
            self.near(box.inverse_psi(t) + box.box_origin, place(box, t), 1e-12)
            self.near(box.psi(place(box, t) - box.box_origin), t, 1e-12)
            self.near(box.T(t), t + casteljau(weights(box), t), 1e-12 * 2.0 ** 12)
            t = RANDOM.random((40, 3))
            self.near(box.inverse_psi(box.T(t)) + box.box_origin, box(place(box, t)), 1e-12)

    def test_the_lattice_is_the_same_map(self):
        box = random_box((4, 3, 5))
        points = place(box, RANDOM.random((50, 3)))
        lattice = box.lattice
        self.assertEqual((lattice.size, lattice.degree), ((4, 3, 5), (3, 2, 4)))
        self.assertEqual(lattice.deform(lattice.embed(points)).tobytes(), box(points).tobytes())
        for made, right in ((lattice.rest, box.control_points(False)), (lattice.deformed, box.control_points())):
            self.near(made.reshape(-1, 3), right, 1e-14)
        quiet = FFD()
        self.assertEqual(quiet.lattice.folds().verdict, "none")
        quiet.array_mu_x[:] = [[[2.0]], [[-2.0]]]
        self.assertEqual(quiet.lattice.folds().verdict, "some")

    def test_kinds_of_points(self):
        box = random_box((3, 3, 3))
        box.box_length, box.box_origin, box.rot_angle = [10, 10, 10], [-5, -5, -5], [0, 0, 0]
        whole = RANDOM.integers(-7, 8, (30, 3))
        right = box(whole.astype(np.float64))
        for points in (whole, whole.tolist(), whole.astype(np.int8), whole.astype(np.float64).tolist(), whole.astype(">f8"),
                       np.asfortranarray(whole.astype(np.float64)), np.repeat(whole, 2, axis=0).astype(np.float64)[::2]):
            found = box(points)
            self.assertEqual((found.dtype, found.tobytes()), (np.float64, right.tobytes()))
        self.assertEqual(box(whole.astype(">f4")).tobytes(), box(whole.astype(np.float32)).tobytes())
        self.assertEqual(box(np.empty((0, 3))).shape, (0, 3))
        broken = np.array([[np.nan, 0, 0], [np.inf, 0, 0]])
        np.testing.assert_array_equal(box(broken), broken)
        still = FFD()
        points = RANDOM.random((5, 3))
        self.assertEqual(still(points).tobytes(), points.tobytes())
        self.assertFalse(np.shares_memory(still(points), points))
        for points, kind in (([0, 0, 0], ValueError), (np.zeros((3, 2)), ValueError), (np.ma.zeros((2, 3)), TypeError),
                             (np.zeros((2, 3), bool), TypeError)):
            self.assertRaises(kind, box, points)

    def test_a_box_round_points(self):
        for _ in range(20):
            box = random_box(RANDOM.integers(2, 5, 3))
            kept = [getattr(box, name).tolist() for name in ("rot_angle", *ATTRIBUTES[4:])]
            points = RANDOM.normal(size=(300, 3)) * (3, 0.5, 1) + RANDOM.uniform(-50, 50, 3)
            points[0] = np.nan
            for margin in (0, 0.1, (0.2, 0, 0.3)):
                box.fit_to_points(points, margin)
                t = (points[1:] - box.box_origin) @ turns(box.rot_angle) / box.box_length
                room = np.broadcast_to(margin, 3) / (1 + 2 * np.broadcast_to(margin, 3))
                self.near(t.min(axis=0), room, 1e-12)
                self.near(t.max(axis=0), 1 - room, 1e-12)
                self.assertEqual(box.lattice.embed(points).counts[ffd.Status.INSIDE], 299)
            self.assertEqual([getattr(box, name).tolist() for name in ("rot_angle", *ATTRIBUTES[4:])], kept)
        for points, margin in ((np.zeros((3, 3)), 0), (np.full((2, 3), np.nan), 0), (np.eye(3), -0.1), (np.eye(3), np.nan), (np.eye(3), (1, 2))):
            before = state(box)
            self.assertRaises(ValueError, box.fit_to_points, points, margin)
            self.assertEqual(state(box), before)


class Values(unittest.TestCase):
    def test_defaults(self):
        box = FFD()
        self.assertEqual(state(box), [[2, 2, 2], [1, 1, 1], [0, 0, 0], [0, 0, 0], *[np.zeros((2, 2, 2)).tolist()] * 3])
        self.assertEqual(box.conversion_unit, 1)
        self.assertEqual(box.rotation_matrix.tolist(), np.eye(3).tolist())
        np.testing.assert_array_equal(box.position_vertices, box.reference_frame)
        self.assertEqual(FFD(n_control_points=(2, 3, 5)).array_mu_z.shape, (2, 3, 5))
        text = str(random_box((2, 1, 3)))
        for name in (*ATTRIBUTES, "conversion_unit", "rotation_matrix", "position_vertices"):
            self.assertIn(f"{name} =", text)

    def test_weights_begin_at_zero(self):
        box = random_box((2, 3, 2))
        box.reset_weights()
        self.assertFalse(weights(box).any())
        box.array_mu_x[1, 2, 1] = 1
        box.n_control_points = [4, 2, 3]
        self.assertEqual(weights(box).tolist(), np.zeros((4, 2, 3, 3)).tolist())

    def test_quarters_are_exact(self):
        box = FFD()
        box.rot_angle = [90, 180, -270]
        self.assertEqual(set(np.abs(box.rotation_matrix).ravel()), {0, 1})
        self.near_turns(box)
        for _ in range(50):
            box.rot_angle = RANDOM.uniform(-1000, 1000, 3)
            self.near_turns(box)

    def near_turns(self, box):
        self.assertLess(np.abs(box.rotation_matrix - turns(box.rot_angle)).max(), 1e-14, box.rot_angle)

    def test_what_cannot_be(self):
        for name, value in (("box_length", [1, 0, 1]), ("box_length", [1, np.inf, 1]), ("box_length", [1, 1]), ("box_origin", [0, np.nan, 0]),
                            ("rot_angle", [0, 0, np.inf]), ("array_mu_x", np.zeros((2, 2, 3))), ("array_mu_y", np.full((2, 2, 2), np.nan)),
                            ("array_mu_z", [0.0])):
            box = FFD()
            setattr(box, name, value)
            for use in (lambda: box(np.zeros((1, 3))), lambda: box.lattice, box.control_points, lambda: box.psi, lambda: box.T,
                        lambda: box.write_parameters("no/where.prm"), box.reflect):
                self.assertRaisesRegex(ValueError, name, use)
        for counts, kind, said in (([16, 2, 2], ffd.UnsupportedError, "15 control points"), ([2, 0, 2], ValueError, "at least 1"), ([2, -1, 2], ValueError, "at least 1"),
                                   ([2, 2], ValueError, "three numbers"), ([2, 2.5, 2], TypeError, "integer")):
            self.assertRaisesRegex(kind, said, FFD, counts)
            box = FFD([3, 3, 3])
            with self.assertRaisesRegex(kind, said):
                box.n_control_points = counts
            self.assertEqual(box.array_mu_x.shape, (3, 3, 3))
        box.n_control_points[0] = 16
        self.assertRaisesRegex(ffd.UnsupportedError, "15 control points", box, np.zeros((1, 3)))

    def test_mirror_images(self):
        for axis in range(3):
            box = random_box(RANDOM.integers(1, 9, 3))
            end = [slice(None)] * 3
            end[axis] = -1
            mu = getattr(box, ATTRIBUTES[4 + axis])
            mu[tuple(end)] = 0
            before = state(box)
            image = box.reflect(axis, in_place=False)
            self.assertEqual(state(box), before)
            self.assertIsNone(box.reflect(axis=axis))
            self.assertEqual(state(box), state(image))
            self.assertEqual(np.array(box.array_mu_x)[tuple(slice(n) for n in before[0])].tolist(), before[4])
            self.assertEqual(box.box_length[axis], 2 * before[1][axis])
            t = RANDOM.random((40, 3))
            other = t.copy()
            other[:, axis] = 1 - t[:, axis]
            left, right = box.psi(box(place(box, t)) - box.box_origin), box.psi(box(place(box, other)) - box.box_origin)
            right[:, axis] = 1 - right[:, axis]
            self.assertLess(np.abs(left - right).max(), 1e-12)
        box = FFD([2, 2, 9])
        box.array_mu_y[0, 1, 0] = box.array_mu_x[0, 1, 1] = 1e-300
        before = state(box)
        for axis, kind in ((3, ValueError), (-1, ValueError), (1, RuntimeError), (2, ffd.UnsupportedError)):
            self.assertRaises(kind, box.reflect, axis)
            self.assertEqual(state(box), before)

    def test_copies(self):
        class Mine(FFD):
            """Of a script."""

            def __init__(self, note, *more):
                super().__init__(*more)
                self.note = note

            def __call__(self, points):
                return super().__call__(points) + 1
        globals()["Mine"] = Mine
        Mine.__qualname__ = "Mine"
        box, points = random_box((3, 2, 4), lambda counts: Mine("a note", counts)), RANDOM.random((20, 3))
        for twin in (copy.deepcopy(box), copy.copy(box), pickle.loads(pickle.dumps(box))):
            self.assertEqual((type(twin), twin.note, state(twin)), (Mine, "a note", state(box)))
            self.assertEqual(twin(points).tobytes(), box(points).tobytes())
        twin = copy.deepcopy(box)
        twin.array_mu_x += 1
        self.assertFalse((twin.array_mu_x == box.array_mu_x).any())
        plain = FFD([3, 2, 4])
        for name in ATTRIBUTES[1:]:
            setattr(plain, name, getattr(box, name))
        self.assertEqual((plain(points) + 1).tobytes(), box(points).tobytes())
        self.assertIsInstance(FFD.reflect(Mine(""), 0, False), Mine)

    def test_maps_that_a_subclass_replaces(self):
        skew = np.array([[1, 0.5, 0], [0, 1, 0.25], [0, 0, 1]])

        class Skewed(FFD):
            """Its sides are at no right angles."""

            @property
            def position_vertices(self):
                return self.box_origin + np.vstack([np.zeros(3), skew])

        class Twice(FFD):
            """What it does in the cube is twice as much."""

            @property
            def T(self):
                once = super().T
                return lambda t: 2 * once(t) - t

        class Turned(FFD):
            """It has directions of its own."""

            @property
            def rotation_matrix(self):
                return np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])
        t = RANDOM.uniform(0.01, 0.99, (30, 3))
        for kind, sides, factor in ((Skewed, skew, 1), (Twice, np.eye(3), 2), (Turned, np.array([[0, 1, 0], [-1, 0, 0], [0, 0, 1]]), 1)):
            box = random_box((3, 2, 4), kind)
            box.box_length, box.rot_angle = [1, 1, 1], [0, 0, 0]
            points = np.vstack([t @ sides, [[3, 3, 3], [-2, 0.5, 0.5]]]) + box.box_origin
            found = box(points)
            self.assertLess(np.abs(found[:30] - points[:30] - factor * casteljau(weights(box), t) @ sides).max(), 1e-12, kind)
            self.assertEqual(found[30:].tobytes(), points[30:].tobytes())

    def test_a_frame_that_a_subclass_replaces(self):
        class Half(FFD):
            """Its sides end at 2: the weights act in an eighth of the box."""
            reference_frame = 2 * FFD.reference_frame
        box, t = random_box((3, 2, 4), Half), RANDOM.uniform(0.01, 0.49, (30, 3))
        points = np.vstack([place(box, t), place(box, t + 0.5)])
        found = box(points)
        self.assertLess(np.abs(found[:30] - points[:30] - shift(box, 2 * t) / 2).max(), 1e-12)
        self.assertEqual(found[30:].tobytes(), points[30:].tobytes())

    def test_what_is_not_offered(self):
        for name in ("CFFD", "BFFD", "VFFD", "RBF", "IDW", "StlHandler", "IgesHandler", "cad"):
            with self.assertRaisesRegex(ImportError, rf"{name}.*ffd_mesh\.fit .*deform_file"):
                exec(f"from ffd_mesh.pygem import {name}")
        with self.assertRaisesRegex(ImportError, "cannot import name 'FFDs'"):
            exec("from ffd_mesh.pygem import FFDs")
        self.assertFalse(hasattr(pygem, "FFDs"))
        self.assertEqual(pygem.__version__, ffd.__version__)


def read_as_pygem(path):
    """A parameter file by the calls that PyGeM makes: each line of a value has four words."""
    parser = configparser.RawConfigParser()
    assert parser.read(path)
    found = [[parser.getint("Box info", f"n control points {axis}") for axis in "xyz"]]
    for name in ("box length", "box origin", "rotation angle"):
        found.append([parser.getfloat("Box info", f"{name} {axis}") for axis in "xyz"])
    for axis in "xyz":
        mu = np.zeros(found[0])
        for line in parser.get("Parameters weights", f"parameter {axis}").split("\n"):
            words = line.split()
            mu[tuple(map(int, words[:3]))] = float(words[3])
        found.append(mu.tolist())
    return found


TEXT = """[Box info]
N CONTROL POINTS x = 3
n control points y: 1
n control points z=2
; a comment
box length x: -2
box length y: 1
box length z: 4
box origin x: 1
box origin y: 2
box origin z: 3
rotation angle x: 0
rotation angle y: 0
rotation angle z: 30

[Parameters weights]
parameter x: 1 0 1 9

   # within
   1 0 1 0.25
parameter y: 2 0 0 0.5
parameter z: 0 0 0 -1
"""
BAD = [("[Box info]", "[Box]", None), ("box origin y: 2\n", "", None), ("origin x: 1", "origin x: one", None), ("y: 1\nn", "y: 0\nn", None),
       ("POINTS x = 3", "POINTS x = 2.5", None), ("POINTS x = 3", "POINTS x = 1e400", None), ("length y: 1", "length y: 0", None),
       ("length y: 1", "length y: inf", None), ("1 0 1 9", "1 1 1 9", "1 is not an index below 1"), ("1 0 1 9", "-1 0 1 9", None),
       ("1 0 1 9", "1 0 1", "is not three indices and a finite number"), ("1 0 1 9", "1 0 1 9 9", None), ("1 0 1 9", "1 0 x 9", None),
       ("1 0 1 9", "1 0 1 nan", "is not three indices and a finite number"), ("box length x: -2", "box length x: -2\nBOX LENGTH X: 2", None)]


class Files(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.path = os.path.join(self.folder.name, "a.prm")

    def write(self, text):
        with open(self.path, "w", encoding="utf-8") as file:
            file.write(text)

    def test_numbers_to_the_bit(self):
        for _ in range(20):
            box, again = random_box(RANDOM.integers(1, 6, 3)), FFD()
            box.array_mu_x[0, 0, 0], box.array_mu_y[0, 0, 0], box.box_origin[0] = 5e-324, -1.7e308, -0.0
            box.write_parameters(self.path)
            again.read_parameters(self.path)
            self.assertEqual(repr(state(again)), repr(state(box)))
            self.assertEqual(repr(read_as_pygem(self.path)), repr(state(box)))
            self.assertEqual(os.listdir(self.folder.name), ["a.prm"])
        for case in cases("pygem"):
            self.write(case["prm"])
            box = FFD()
            box.read_parameters(filename=self.path)
            self.assertEqual(state(box), [case[name] for name in ATTRIBUTES])
            box.write_parameters(filename=self.path)
            self.assertEqual(read_as_pygem(self.path), [case[name] for name in ATTRIBUTES])

    def test_files_of_lattices(self):
        for _ in range(20):
            box, again = random_box(RANDOM.integers(1, 6, 3)), FFD()
            box.write_parameters(self.path)
            lattice = ffd.Lattice.load(self.path)
            np.testing.assert_allclose(lattice.rest, box.lattice.rest, rtol=0, atol=1e-14)
            np.testing.assert_allclose(lattice.offsets, box.lattice.offsets, rtol=0, atol=1e-14)
            box.lattice.save(self.path, force=True)
            again.read_parameters(self.path)
            points = place(box, RANDOM.uniform(-0.2, 1.2, (50, 3)))
            np.testing.assert_allclose(again(points), box(points), rtol=0, atol=1e-12)
        self.write(TEXT)
        box.read_parameters(self.path)
        self.assertEqual(state(box)[:4], [[3, 1, 2], [-2, 1, 4], [1, 2, 3], [0, 0, 30]])
        self.assertEqual([np.argwhere(mu).tolist() for mu in np.moveaxis(weights(box), -1, 0)], [[[1, 0, 1]], [[2, 0, 0]], [[0, 0, 0]]])
        self.assertEqual(weights(box).sum(axis=(0, 1, 2)).tolist(), [0.25, 0.5, -1])
        np.testing.assert_allclose(ffd.Lattice.load(self.path).offsets, box.lattice.offsets, rtol=0, atol=1e-15)

    def test_what_is_refused_by_both(self):
        box = random_box((2, 3, 2))
        before = state(box)
        for old, new, said in BAD:
            self.write(TEXT.replace(old, new))
            self.assertNotEqual(TEXT.replace(old, new), TEXT)
            self.assertRaises(ffd.Error, ffd.Lattice.load, self.path)
            with self.assertRaisesRegex(ffd.InvalidError, said or "") as caught:
                box.read_parameters(self.path)
            self.assertIsInstance(caught.exception, ValueError)
            self.assertEqual((caught.exception.file, "\n" in str(caught.exception), state(box)), (self.path, False, before))
        self.write(TEXT.replace("POINTS x = 3", "POINTS x = 16"))
        for read in (ffd.Lattice.load, box.read_parameters):
            self.assertRaisesRegex(ffd.UnsupportedError, r"a\.prm.*16 control points.*15", read, self.path)
        self.assertEqual(state(box), before)

    def test_names(self):
        box = random_box((2, 2, 2))
        self.assertRaises(FileNotFoundError, box.read_parameters, self.path)
        self.assertFalse(os.path.exists(self.path))
        self.assertRaises(FileNotFoundError, box.write_parameters, os.path.join(self.folder.name, "no", "a.prm"))
        for call in (box.read_parameters, box.write_parameters):
            self.assertRaises(TypeError, call, 3)
            self.assertRaises(IsADirectoryError, call, self.folder.name)
        here = os.getcwd()
        os.chdir(self.folder.name)
        try:
            box.write_parameters()
            again = FFD()
            again.read_parameters()
            os.symlink("parameters.prm", "link.prm")
            box.box_origin = [7, 8, 9]
            box.write_parameters("link.prm")
            self.assertTrue(os.path.islink("link.prm"))
            again.read_parameters("parameters.prm")
        finally:
            os.chdir(here)
        self.assertEqual(state(again), state(box))
        self.assertEqual(sorted(os.listdir(self.folder.name)), ["link.prm", "parameters.prm"])
        before = state(again)
        box.array_mu_x = np.full((2, 2, 2), np.nan)
        self.assertRaises(ValueError, box.write_parameters, os.path.join(self.folder.name, "parameters.prm"))
        again.read_parameters(os.path.join(self.folder.name, "parameters.prm"))
        self.assertEqual(state(again), before)
        box.reset_weights()
        box.write_parameters(os.devnull)


# The calls of PyGeM's first tutorial: points of a sphere, a box of 2 x 2 x 2, one control point moved, kept in a file.
SCRIPT = """
import numpy as np
from pygem import FFD

turn, height = np.pi * (1 + 5 ** 0.5) * (np.arange(2000) + 0.5), 1 - (np.arange(2000) + 0.5) / 1000
mesh = np.stack([np.cos(turn) * np.sqrt(1 - height ** 2), np.sin(turn) * np.sqrt(1 - height ** 2), height], axis=1)
ffd = FFD([2, 2, 2])
print(ffd)
first = ffd.array_mu_x[1, 1, 1], ffd.array_mu_z[1, 1, 1]
ffd.array_mu_x[1, 1, 1] = 2
ffd.array_mu_z[1, 1, 1] = 0.8
new_mesh = ffd(mesh)
cage = ffd.control_points()
ffd.write_parameters("parameters.prm")
ffd.reset_weights()
still = ffd(mesh)
ffd = FFD()
ffd.read_parameters("parameters.prm")
kept = ffd.array_mu_x
ffd.array_mu_y[:, 1, 1] = 0.3
again = ffd(mesh)
"""


class Formula:
    """What the script needs of PyGeM, of a unit box."""

    def __init__(self, counts=(2, 2, 2)):
        self.array_mu_x, self.array_mu_y, self.array_mu_z = (np.zeros(counts) for _ in range(3))

    def __call__(self, points):
        inside = ((points >= 0) & (points <= 1)).all(axis=1)
        return points + inside[:, None] * casteljau(weights(self), points)

    def reset_weights(self):
        self.__init__(self.array_mu_x.shape)

    def write_parameters(self, path):
        numbers = {"n control points": self.array_mu_x.shape, "box length": (1.0,) * 3, "box origin": (0.0,) * 3, "rotation angle": (0.0,) * 3}
        parser = configparser.RawConfigParser()
        parser["Box info"] = {f"{name} {axis}": str(value) for name, values in numbers.items() for axis, value in zip("xyz", values)}
        parser["Parameters weights"] = {f"parameter {axis}": "\n".join(f"{i} {j} {k} {mu[i, j, k]!s}" for i, j, k in np.ndindex(mu.shape))
                                        for axis, mu in zip("xyz", np.moveaxis(weights(self), -1, 0))}
        with open(path, "w", encoding="utf-8") as file:
            parser.write(file)

    def read_parameters(self, path):
        self.array_mu_x, self.array_mu_y, self.array_mu_z = map(np.array, read_as_pygem(path)[4:])

    def control_points(self):
        grid = np.meshgrid(*(np.linspace(0, 1, n) for n in self.array_mu_x.shape), indexing="ij")
        return (np.stack(grid, axis=-1) + weights(self)).reshape(-1, 3)


class Script(unittest.TestCase):
    def run_script(self, text):
        """Its names and what it prints, in a folder of its own."""
        names, here, printed = {}, os.getcwd(), io.StringIO()
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)
            try:
                with contextlib.redirect_stdout(printed):
                    exec(text, names)
            finally:
                os.chdir(here)
        return names, printed.getvalue()

    def test_its_import_alone_changes(self):
        sys.modules["pygem"] = types.ModuleType("pygem")
        sys.modules["pygem"].FFD = Formula
        try:
            right, _ = self.run_script(SCRIPT)
        finally:
            del sys.modules["pygem"]
        found, printed = self.run_script(SCRIPT.replace("from pygem import FFD", "from ffd_mesh.pygem import FFD"))
        self.assertIs(type(found["new_mesh"]), np.ndarray)
        self.assertEqual((found["new_mesh"].shape, found["first"]), ((2000, 3), (0, 0)))
        self.assertIn("array_mu_x", printed)
        self.assertEqual((found["new_mesh"] != found["mesh"]).any(axis=1).sum(), (right["new_mesh"] != right["mesh"]).any(axis=1).sum())
        self.assertGreater((found["new_mesh"] != found["mesh"]).sum(), 300)
        np.testing.assert_array_equal(found["still"], found["mesh"])
        self.assertEqual(found["kept"].tolist(), right["kept"].tolist())
        for name in ("new_mesh", "cage", "again"):
            self.assertLess(np.abs(found[name] - right[name]).max(), 1e-12)
