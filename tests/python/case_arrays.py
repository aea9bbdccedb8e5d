"""Arrays of any shape, stride and type are taken as they are, or refused with a clear exception."""

import contextlib
import gc
import threading
import unittest
import unittest.mock

import ffd_mesh as ffd
import numpy as np
import support
from ffd_mesh import _library
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

RANDOM = support.rng("arrays")
LATTICE = support.curved(RANDOM)
Q = support.pushed(RANDOM, LATTICE)

coordinates = st.one_of(st.floats(-0.5, 1.5, width=32), st.sampled_from([np.nan, np.inf, -0.0, 1e30]))
clouds = st.sampled_from([np.float32, np.float64]).flatmap(
    lambda kind: st.integers(0, 12).flatmap(lambda n: arrays(kind, (n, 3), elements=coordinates)))
layouts = st.sampled_from(["C", "Fortran", "interleaved", "reversed", "backwards", "every second", "unaligned"])


def laid_out(points, layout):
    """The same numbers with other strides."""
    n = len(points)
    if layout == "Fortran":
        return np.asfortranarray(points)
    if layout == "interleaved":
        wide = np.full((n, 8), 7, points.dtype)
        wide[:, 2:5] = points
        return wide[:, 2:5]
    if layout == "reversed":
        return np.ascontiguousarray(points[::-1])[::-1]
    if layout == "backwards":
        return np.ascontiguousarray(points[:, ::-1])[:, ::-1]
    if layout == "every second":
        return np.repeat(points, 2, axis=0)[::2]
    if layout == "unaligned":
        raw = np.frombuffer(bytearray(1 + points.nbytes), np.uint8)[1:]
        view = raw.view(points.dtype).reshape(points.shape) if n else points
        view[...] = points
        return view
    return points


class Layouts(unittest.TestCase):
    @settings(max_examples=150, deadline=None, derandomize=True, database=None)
    @given(clouds, layouts, layouts)
    def test_strides_change_no_bit(self, points, there, back):
        plain = LATTICE.embed(points)
        wanted = LATTICE.deform(plain, Q)
        self.assertEqual(wanted.dtype, points.dtype)
        view = laid_out(points, there)
        embedding = LATTICE.embed(view)
        self.assertEqual(embedding.points.__array_interface__["data"][0], view.__array_interface__["data"][0])
        self.assertEqual(embedding.uvw.tobytes(), plain.uvw.tobytes())
        out = laid_out(np.zeros_like(points), back)
        self.assertIs(LATTICE.deform(embedding, Q, out=out), out)
        self.assertEqual(np.ascontiguousarray(out).tobytes(), wanted.tobytes())
        finite = np.isfinite(points).all(axis=1)
        self.assertTrue(np.array_equal(embedding.status == ffd.Status.INVALID, ~finite))
        self.assertEqual(wanted[~finite].tobytes(), points[~finite].tobytes())
        self.assertTrue(np.isfinite(wanted[finite]).all())

    @settings(max_examples=60, deadline=None, derandomize=True, database=None)
    @given(st.tuples(*[st.integers(2, 5)] * 3), st.integers(0, 2**32 - 1))
    def test_control_points_come_and_go_in_pythons_order(self, size, seed):
        random = np.random.default_rng(seed)
        grid = np.stack(np.meshgrid(*(np.linspace(0, 1, n) for n in size), indexing="ij"), axis=-1)
        weights = random.uniform(0.5, 2, size)
        lattice = ffd.Lattice.from_points(grid, weights=weights)
        self.assertEqual(lattice.size, size)
        self.assertTrue(np.array_equal(lattice.rest, grid) and np.array_equal(lattice.rest_weights, weights))
        wanted = random.standard_normal(grid.shape)
        for given_as in (wanted, np.asfortranarray(wanted), wanted[::-1][::-1]):
            self.assertTrue(np.array_equal(lattice.moved(offsets=given_as).offsets, wanted))
        lattice = ffd.Lattice.parse(lattice.moved(offsets=wanted).text)
        self.assertTrue(np.array_equal(lattice.offsets, wanted))

    def test_a_type_may_differ_from_that_of_the_result(self):
        points = RANDOM.uniform(0, 1, (20, 3)).astype(np.float32)
        embedding = LATTICE.embed(points)
        wide = LATTICE.deform(embedding, Q, out=np.empty((20, 3)))
        self.assertTrue(np.array_equal(wide.astype(np.float32), LATTICE.deform(embedding, Q)))

    def test_other_types_and_byte_orders_are_copied(self):
        points = RANDOM.integers(0, 4, (20, 3)) / 4
        wanted = LATTICE.deform(LATTICE.embed(points), Q)
        for kind, found_as in ((">f8", "f8"), (">f4", "f4"), ("f2", "f4"), (">f2", "f4"), ("g", "f8")):
            found = LATTICE.deform(LATTICE.embed(points.astype(kind)), Q)
            self.assertEqual(found.dtype, np.dtype(found_as))
            self.assertEqual(found.tobytes(), wanted.astype(found_as).tobytes(), kind)
            self.assertTrue(np.array_equal(LATTICE.evaluate(points.astype(kind)), LATTICE.evaluate(points)))
            self.assertTrue(np.array_equal(ffd.Lattice.around(points.astype(kind)).rest, ffd.Lattice.around(points).rest))
        for kind in ("i1", "u2", ">i4", "i8"):
            whole = np.arange(12).reshape(4, 3).astype(kind)
            lattice = ffd.Lattice.around(whole, 3)
            moved = lattice.deform(lattice.embed(whole), 2 * lattice.rest)
            self.assertTrue(np.array_equal(moved, lattice.deform(lattice.embed(whole.astype(float)), 2 * lattice.rest)))
            twice = np.round(10 * Q).astype(kind)
            self.assertTrue(np.array_equal(LATTICE.moved(twice).deformed, twice))
        for kind in (">f8", ">f4", "f2", "g"):
            self.assertTrue(np.array_equal(LATTICE.moved(Q.astype(kind)).deformed, Q.astype(kind).astype(float)))

    def test_views_live_as_long_as_they_are_used(self):
        uvw = LATTICE.embed(RANDOM.uniform(0, 1, (1000, 3))).uvw
        rest = support.curved(support.rng("views")).rest
        other = [LATTICE.embed(RANDOM.uniform(0, 1, (1000, 3))) for _ in range(20)]
        self.assertTrue(((uvw >= 0) & (uvw <= 1))[np.isfinite(uvw)].all() and len(other) == 20)
        self.assertTrue(np.array_equal(rest, support.curved(support.rng("views")).rest))
        for view in (uvw, rest, other[0].status):
            self.assertFalse(view.flags.writeable)

    def test_repeated_rows_are_taken(self):
        points = np.broadcast_to(np.float32(0.5), (4, 3))
        out = LATTICE.deform(LATTICE.embed(points), Q)
        self.assertTrue((out == out[0]).all())


class MovedLattices(unittest.TestCase):
    """A lattice that `moved` returns is copied when it is first used."""

    def test_a_copy_is_made_once_and_late(self):
        with unittest.mock.patch.object(_library.lib, "ffd_lattice_copy", wraps=_library.lib.ffd_lattice_copy) as copy:
            moved = LATTICE.moved(Q)
            self.assertEqual((moved.size, moved.degree, copy.call_count), (LATTICE.size, LATTICE.degree, 0))
            self.assertTrue(np.array_equal(moved.deformed, Q) and np.array_equal(moved.deformed, Q))
            self.assertEqual(copy.call_count, 1)
            twice = moved.moved(offsets=LATTICE.rest)
            self.assertEqual(copy.call_count, 1)
            self.assertTrue(np.array_equal(twice.offsets, LATTICE.rest))
            self.assertEqual(copy.call_count, 2)

    def test_what_is_given_may_change_at_once(self):
        for given in (Q.copy(), LATTICE.rest + 0.25, np.asfortranarray(Q), Q[::-1]):
            kept = np.array(given)
            moved = LATTICE.moved(given)
            given[...] = 7
            self.assertTrue(np.array_equal(moved.deformed, kept))

    def test_the_lattice_it_came_from_may_go_first(self):
        lattice = support.curved(support.rng("gone"))
        moved = lattice.moved(offsets=lattice.rest).moved(weights=np.full(lattice.size, 2.0))
        rest = np.array(lattice.rest)
        del lattice
        gc.collect()
        self.assertTrue(np.array_equal(moved.rest, rest) and np.array_equal(moved.offsets, rest) and (moved.weights == 2).all())

    def test_refusals_do_not_wait(self):
        wide = ffd.Lattice.box((0, 0, 0), (1e308, 1, 1), size=2)
        for lattice, given in ((LATTICE, {"Q": np.where(Q == Q[1, 2, 0, 1], np.nan, Q)}), (LATTICE, {"offsets": np.where(Q == Q[1, 2, 0, 1], -np.inf, Q)}),
                               (wide, {"offsets": wide.rest}), (LATTICE, {"weights": np.zeros(LATTICE.size)})):
            self.assertRaises(ffd.InvalidError, lattice.moved, **given)

    def test_threads_share_one_copy(self):
        for number in range(20):
            moved, found, start = LATTICE.moved(Q + number), [], threading.Barrier(8)

            def use(moved=moved, found=found, start=start):
                start.wait()
                found.append(moved.deformed)
            threads = [threading.Thread(target=use) for _ in range(8)]
            for thread in threads:
                thread.start()
            for thread in threads:
                thread.join()
            self.assertEqual(len({one.__array_interface__["data"] for one in found}), 1)
            self.assertTrue(np.array_equal(found[0], Q + number))


class Refusals(unittest.TestCase):
    def refused(self, kind, words, function, *arguments, **more):
        with self.assertRaisesRegex(kind, words):
            function(*arguments, **more)

    def test_points(self):
        good = RANDOM.uniform(0, 1, (5, 3))
        for bad in (good[:, :2], good.ravel(), good[None], good[:, :0], np.float64(3), []):
            self.refused(ValueError, r"points must have the shape \(N, 3\)", LATTICE.embed, bad)
        for bad in (good.astype(bool), good.astype(complex), good.astype(object), good.astype("M8[s]"), "xyz", None):
            self.refused(TypeError, "points must hold real numbers", LATTICE.embed, bad)
        self.refused(TypeError, "mask", LATTICE.embed, np.ma.masked_array(good))

    def test_an_embedding_keeps_its_points(self):
        """Whatever is done to the array that was embedded, or tried with the embedding's own."""
        points = RANDOM.uniform(0, 1, (40, 3))
        for lattice in (LATTICE, ffd.Chain([LATTICE])):
            embedding = lattice.embed(points)
            points.shape = (-1,)
            self.assertEqual((len(embedding), embedding.points.shape, len(embedding.status)), (40, (40, 3), 40))
            points.shape = (40, 3)
            with self.assertRaises(AttributeError):
                embedding.points = points[:1]
            self.assertFalse(embedding.points.flags.writeable)
        plane = ffd.Lattice.plane((0, 0), (1, 1))
        flat = plane.embed(points[:, :2])
        self.refused(ValueError, "read-only", plane.deform, flat, plane.rest, out=flat.points)

    def test_results_over_what_they_are_made_of(self):
        points, moved = RANDOM.uniform(0, 1, (40, 3)), LATTICE.moved(Q)
        for lattice, given in ((moved, {}), (LATTICE, {"Q": Q}), (LATTICE, {"Q": Q[None]}), (ffd.Chain([moved]), {})):
            embedding = lattice.embed(points)
            buffer = np.zeros(120)
            weight, out = buffer[:40], buffer.reshape(40, 3)
            weight[:] = 0.5
            right = lattice.deform(embedding, weight=weight.copy(), **given)
            out = out if right.ndim == 2 else out[None]
            self.assertTrue(np.array_equal(lattice.deform(embedding, weight=weight, out=out, **given), right))
        normals = RANDOM.normal(size=(40, 3))
        embedding = LATTICE.embed(points)
        right = LATTICE.deform(embedding, Q, normals=normals.copy())
        self.assertTrue(np.array_equal(LATTICE.deform(embedding, Q, normals=normals, out=normals).normals, right.normals))

    def test_a_barrier_is_of_its_own_embedding(self):
        points = RANDOM.uniform(0, 1, (40, 3))
        foreign = ffd.Lattice.box((-1, -1, -1), (2, 2, 2), size=5).embed(points)
        self.refused(ffd.InvalidError, "another lattice", LATTICE.fold_barrier, Q, embedding=foreign)
        self.refused(TypeError, "what embed returns", LATTICE.fold_barrier, Q, embedding="x")
        plane = ffd.Lattice.plane((0, 0), (1, 1), size=5)
        other = ffd.Lattice.plane((-1, -1), (1, 1), size=5).embed(points[:, :2])
        self.refused(ffd.InvalidError, "another lattice", plane.fold_barrier, embedding=other)

    def test_out(self):
        embedding = LATTICE.embed(RANDOM.uniform(0, 1, (5, 3)))
        frozen = np.empty((5, 3))
        frozen.flags.writeable = False
        for bad in (np.empty((4, 3)), np.empty((5, 4)), np.empty(15), frozen, np.lib.stride_tricks.as_strided(np.empty(3), (5, 3), (0, 8)),
                    embedding.points, embedding.points[::-1]):
            self.refused(ValueError, "out", LATTICE.deform, embedding, Q, out=bad)
        for bad in ([[0.0] * 3] * 5, np.empty((5, 3), np.float16), np.empty((5, 3), int)):
            self.refused(TypeError, "out", LATTICE.deform, embedding, Q, out=bad)
        both = np.array(np.hstack([embedding.points, embedding.points]))
        self.assertTrue(np.array_equal(LATTICE.deform(embedding, Q, points=both[:, :3], out=both[:, 3:]), LATTICE.deform(embedding, Q)))
        self.assertTrue(np.array_equal(LATTICE.deform(embedding, Q, points=both[:, :3], out=both[:, :3]), LATTICE.deform(embedding, Q)))
        self.refused(ValueError, "overlap", LATTICE.deform, embedding, Q, points=both[:, :3], out=both[:, 1:4])

    def test_control_points(self):
        embedding = LATTICE.embed(RANDOM.uniform(0, 1, (5, 3)))
        for bad in (Q[:-1], Q.reshape(-1, 3), Q[..., :2]):
            self.refused(ValueError, "Q must have the shape", LATTICE.deform, embedding, bad)
        self.refused(TypeError, "Q must hold real numbers", LATTICE.deform, embedding, Q.astype(complex))
        self.refused(TypeError, "Q must not be a masked array", LATTICE.deform, embedding, np.ma.masked_less(Q, 0.5))
        self.refused(ffd.InvalidError, "finite", LATTICE.deform, embedding, Q * np.nan)
        self.refused(ValueError, "not both", LATTICE.deform, embedding, Q, offsets=Q)
        self.refused(ValueError, "weights must have the shape", LATTICE.deform, embedding, weights=np.ones(3))
        self.refused(ffd.InvalidError, "weight", LATTICE.deform, embedding, weights=-np.ones(LATTICE.size))
        self.refused(ValueError, "another lattice", support.curved(RANDOM).basis, embedding)
        self.refused(ffd.InvalidError, "", support.curved(RANDOM).deform, embedding)
        for other in (ffd.Lattice.from_points(LATTICE.rest, LATTICE.degree, knots="open"), ffd.Lattice.from_points(LATTICE.rest, 1),
                      ffd.Lattice.from_points(LATTICE.rest, LATTICE.degree, weights=1 + Q[..., 0] ** 2)):
            for function in (other.basis, other.deform):
                self.refused(ffd.InvalidError, "another lattice", function, embedding)
        self.assertEqual(LATTICE.moved(Q, weights=np.ones(LATTICE.size)).basis(embedding).shape, (5, Q[..., 0].size))
        self.refused(ValueError, "control_points", embedding.affected, [[9, 0, 0]])
        for bad in (0 * Q[..., 0], -Q[..., 0], Q[..., 0] * np.nan):
            self.refused(ffd.InvalidError, "weight", LATTICE.basis, embedding, weights=bad)
            self.refused(ffd.InvalidError, "weight", LATTICE.basis_times, embedding, Q, weights=bad)
            self.refused(ffd.InvalidError, "weight", LATTICE.basis_transposed, embedding, embedding.points, weights=bad)
        self.refused(ValueError, "vertices", LATTICE.deform, embedding, Q, vertices=[-1])
        self.refused(ffd.ArgumentError, "", LATTICE.deform, embedding, Q, vertices=[2, 1])

    def test_knots(self):
        for bad in (((), (), ()), ("closed",), [[]] * 3, ("open", "open", ("closed", [0, 1]))):
            with self.assertRaises((ValueError, TypeError)):
                ffd.Lattice.from_points(LATTICE.rest, knots=bad)

    def test_options(self):
        points = RANDOM.uniform(0, 1, (5, 3))
        self.refused(ValueError, "'keep', 'extend', 'error'", LATTICE.embed, points, outside="kept")
        self.refused(ValueError, "threads", LATTICE.embed, points, threads=2**40)
        self.refused(TypeError, "threads", LATTICE.embed, points, threads=1.5)
        self.refused(TypeError, "progress", LATTICE.embed, points, progress=3)
        self.refused(ffd.ArgumentError, "falloff", LATTICE.embed, points, outside="extend", falloff=-1)
        for outside in ("keep", "error"):
            self.refused(ffd.ArgumentError, 'falloff 0.5 needs outside "extend"', LATTICE.embed, points, outside=outside, falloff=0.5)
        self.refused(ffd.ArgumentError, 'needs outside "extend"', LATTICE.embed, points, falloff=0.5)
        self.refused(ValueError, "size", ffd.Lattice.around, points, size=(3, -1, 3))
        self.refused(ValueError, "three", ffd.Lattice.around, points, size=(3, 3))
        self.refused(ffd.InvalidError, "", ffd.Lattice.around, points * np.nan)

    def test_rows_that_share_memory_are_no_output(self):
        embedding = LATTICE.embed(RANDOM.uniform(0, 1, (5, 3)))
        for strides in ((8, 8), (16, 8), (0, 8), (8, 0), (12, 8)):
            out = np.lib.stride_tricks.as_strided(np.zeros(50), (5, 3), strides)
            self.refused(ValueError, "share their memory", LATTICE.deform, embedding, Q, out=out)

    def test_texts_and_paths_are_whole(self):
        self.refused(TypeError, "name must be a text, not NoneType", ffd.Lattice.parse, LATTICE.text, None)
        for bad in (5, 2**63, None, [1], range(3)):
            self.refused(TypeError, "text must be a text, bytes or a dict", ffd.Lattice.parse, bad)
        for bad in (1.5, [1], "x", {1}):
            self.refused(TypeError, "values of placeholders must be a dict", ffd.Lattice.load, "absent.json", bad)
        self.refused(ValueError, "null character", LATTICE.save, "a\0b.json")
        self.refused(ValueError, "null character", ffd.Lattice.load, "a\0b.json")
        self.refused(ValueError, "null character", ffd.Lattice.load, "absent.json", {"a\0b": 1})
        self.refused(ValueError, "null character", ffd.check_file, "a\0b.obj", LATTICE)
        self.refused(ValueError, "falloff is too large", LATTICE.embed, RANDOM.uniform(0, 1, (5, 3)), falloff=10**400)

    def test_strange_values_end_in_clear_exceptions(self):
        class Unreadable:
            def __array__(self, *_, **__):
                raise ValueError("not today")
        embedding = LATTICE.embed(RANDOM.uniform(0, 1, (5, 3)))
        strange = (None, True, -1, 3.7, np.nan, 10**400, 2**63, "", "x", "\0", "\ud800", b"\xff", [], [[1, 2, 3], [4, 5]], {}, {"a": 1},
                   object(), Unreadable(), np.array(3.0), np.zeros((3, 0)), np.zeros((2, 3), ">f8"), np.zeros((2, 3), "M8[s]"),
                   np.zeros((2, 3), "S3"), np.zeros(2, [("x", "f8", 3)]), np.full((5, 3), 1e308), np.zeros((3, 4, 4, 3)), type, 1j, ...)
        deform = {name: (lambda name: lambda value: LATTICE.deform(embedding, **{name: value}))(name)
                  for name in ("Q", "out", "offsets", "weights", "normals", "tangents", "points", "vertices", "threads", "isa", "progress")}
        calls = deform | {"embed": LATTICE.embed, "deform": LATTICE.deform, "basis": LATTICE.basis, "folds": LATTICE.folds,
                          "evaluate": LATTICE.evaluate, "affected": embedding.affected, "around": ffd.Lattice.around,
                          "from_points": ffd.Lattice.from_points, "parse": ffd.Lattice.parse,
                          "size": lambda value: ffd.Lattice.box((0, 0, 0), (1, 1, 1), size=value),
                          "knots": lambda value: ffd.Lattice.box((0, 0, 0), (1, 1, 1), knots=value),
                          "mesh": lambda value: ffd.deform_mesh(value, LATTICE)}
        for name, call in calls.items():
            for value in strange:
                with self.subTest(call=name, value=value), contextlib.suppress(ValueError, TypeError, ffd.Error):
                    call(value)

    def test_errors_say_where(self):
        with self.assertRaises(ffd.InvalidError) as caught:
            ffd.Lattice.parse('{"format": "ffd-lattice",\n "version": 1,\n oops}', "my.json")
        self.assertEqual((caught.exception.file, caught.exception.line, caught.exception.status), ("my.json", 3, -30))
        with self.assertRaises(ffd.InvalidError) as caught:
            ffd.Lattice.parse(ffd.Lattice.box((0, 0, 0), (1, 1, 1)).text.replace('"degree"', '"degrees"'))
        self.assertTrue(caught.exception.pointer)
        with self.assertRaises(ffd.FileError) as caught:
            ffd.Lattice.load("absent.json")
        self.assertEqual(caught.exception.file, "absent.json")
        self.assertIsInstance(caught.exception, OSError)
