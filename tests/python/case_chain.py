"""Several lattices on arrays: one after the other, and side by side; the bits are those of the program."""

import os
import pickle
import tempfile
import threading
import unittest

import ffd_mesh as ffd
import numpy as np
import support

RANDOM = support.rng("chain")


def moved(lattice, by=0.06):
    return lattice.moved(support.pushed(RANDOM, lattice, by))


FIRST = moved(support.curved(RANDOM))
SECOND = moved(ffd.Lattice.box((-0.1, 0.1, -0.2), (0.8, 1.2, 1.1), size=(4, 5, 4)))
WEIGHTED = moved(support.curved(RANDOM, (3, 4, 3), weights=True))
POINTS = RANDOM.uniform(-0.2, 1.2, (5000, 3))
POINTS[7, 1] = np.nan
# Three boxes that share faces, with points on these.
SIDES = [moved(ffd.Lattice.box((x, 0, 0), (x + 0.5, 1, 1), size=3)) for x in (0.0, 0.5, 1.0)]
ON_FACES = RANDOM.uniform(-0.1, 1.7, (4000, 3)) * (1, 0.7, 0.7)
ON_FACES[::5, 0] = RANDOM.choice([0.0, 0.5, 1.0, 1.5], 800)


def by_program(points, lattices, *options, normals=None, others=()):
    """What the program makes of the points, and normals, with all lattices. others: further clouds of the same command."""
    with tempfile.TemporaryDirectory() as folder:
        names = [os.path.join(folder, name) for name in ("in.ply", "out.ply")]
        with open(names[0], "wb") as file:
            file.write(support.ply(points, normals))
        words = []
        for number, lattice in enumerate(lattices):
            words += ["-l", os.path.join(folder, f"{number}.json")]
            lattice.save(words[-1])
        for number, other in enumerate(others):
            with open(os.path.join(folder, f"more{number}.ply"), "wb") as file:
                file.write(support.ply(other))
        if others:
            os.mkdir(os.path.join(folder, "out"))
            more = [os.path.join(folder, f"more{number}.ply") for number in range(len(others))]
            support.program("deform", names[0], *more, "--out-dir", os.path.join(folder, "out"), *words, *options)
            names[1] = os.path.join(folder, "out", "in.ply")
        else:
            support.program("deform", *names, *words, *options)
        with open(names[1], "rb") as file:
            data = file.read().split(b"end_header\n", 1)[1]
    return np.frombuffer(data, points.dtype).reshape(len(points), -1)


SETTINGS = (("keep", 0.0, 0.0), ("extend", 0.0, 0.0), ("extend", 0.3, 0.0), ("keep", 0.0, 0.02))


def words(outside, falloff, snap):
    return ["--outside", outside] + (["--falloff", str(falloff)] if falloff else []) + (["--snap", str(snap)] if snap else [])


class Bits(unittest.TestCase):
    def test_a_chain_is_several_lattices_of_the_program(self):
        for kind in (np.float32, np.float64):
            points = POINTS.astype(kind)
            for lattices in ([FIRST, SECOND], [SECOND, FIRST, WEIGHTED], [WEIGHTED]):
                chain = ffd.Chain(lattices)
                for outside, falloff, snap in SETTINGS:
                    embedding = chain.embed(points, outside=outside, falloff=falloff, snap=snap)
                    found = chain.deform(embedding)
                    wanted = by_program(points, lattices, *words(outside, falloff, snap))
                    self.assertEqual((found.dtype, found.tobytes()), (kind, wanted.tobytes()), (kind, lattices, outside, falloff, snap))
                    self.assertTrue((found != points).any(axis=1).sum() > 1000)

    def test_blocks_are_those_of_the_program(self):
        for kind in (np.float32, np.float64):
            points = ON_FACES.astype(kind)
            for lattices in (SIDES, SIDES[::-1], [WEIGHTED, SECOND]):
                blocks = ffd.Blocks(lattices)
                for outside, falloff, snap in SETTINGS:
                    embedding = blocks.embed(points, outside=outside, falloff=falloff, snap=snap)
                    wanted = by_program(points, lattices, "--blocks", *words(outside, falloff, snap))
                    self.assertEqual(blocks.deform(embedding).tobytes(), wanted.tobytes(), (kind, lattices, outside, falloff, snap))

    def test_other_control_points_are_those_of_other_lattices(self):
        for kind, lattices, points in ((ffd.Chain, [FIRST, SECOND, WEIGHTED], POINTS), (ffd.Blocks, SIDES, ON_FACES)):
            several = kind(lattices)
            embedding = several.embed(points, outside="extend", falloff=0.2)
            for chosen in ((0, 1, 2), (1,), (2,), (0, 2), ()):
                Q = [support.pushed(RANDOM, lattice, 0.04) if number in chosen else None for number, lattice in enumerate(lattices)]
                others = several.moved(Q)
                wanted = by_program(points, others.lattices, *(["--blocks"] if kind is ffd.Blocks else []), "--outside", "extend", "--falloff", "0.2")
                self.assertEqual(several.deform(embedding, Q).tobytes(), wanted.tobytes(), (kind, chosen))
                offsets = [None if q is None else q - lattice.rest for q, lattice in zip(Q, lattices)]
                self.assertEqual(several.deform(embedding, offsets=offsets).tobytes(),
                                 several.moved(offsets=offsets).deform(embedding).tobytes())
            weights = [None, RANDOM.uniform(0.5, 2, lattices[1].size), None]
            wanted = by_program(points, several.moved(weights=weights).lattices, *(["--blocks"] if kind is ffd.Blocks else []), "--outside", "extend", "--falloff", "0.2")
            self.assertEqual(several.deform(embedding, weights=weights).tobytes(), wanted.tobytes())

    def test_normals_and_weights(self):
        points = np.nan_to_num(POINTS, nan=0.5)
        normals = RANDOM.standard_normal(points.shape)
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        for several, more in ((ffd.Chain([FIRST, SECOND]), []), (ffd.Blocks(SIDES), ["--blocks"])):
            found = several.deform(several.embed(points), normals=normals)
            wanted = by_program(points, several.lattices, *more, normals=normals)
            self.assertEqual(found.points.tobytes(), np.ascontiguousarray(wanted[:, :3]).tobytes())
            self.assertEqual(found.normals.tobytes(), np.ascontiguousarray(wanted[:, 3:]).tobytes())
            weight = RANDOM.random(len(points))
            with tempfile.TemporaryDirectory() as folder:
                np.save(os.path.join(folder, "w.npy"), weight)
                wanted = by_program(points, several.lattices, *more, "--weight", os.path.join(folder, "w.npy"))
            self.assertEqual(several.deform(several.embed(points), weight=weight).tobytes(), wanted.tobytes())

    def test_threads_and_instruction_sets_change_nothing(self):
        for several, points in ((ffd.Chain([FIRST, SECOND, WEIGHTED]), np.tile(POINTS, (3, 1))), (ffd.Blocks(SIDES), np.tile(ON_FACES, (3, 1)))):
            g = RANDOM.standard_normal(points.shape)
            D = [RANDOM.standard_normal(lattice.rest.shape) for lattice in several.lattices]

            def all_of(**more):
                embedding = several.embed(points, outside="extend", **more)
                made = several.deform(embedding, gradients=True, **more)
                back = several.basis_transposed(embedding, g, **more)
                return [made.points, made.gradients, several.basis_times(embedding, D, **more), *back, embedding.status, embedding.uvw]

            wanted = [array.tobytes() for array in all_of(threads=1, isa="scalar")]
            for more in ({"threads": 5}, {"threads": 2, "isa": "sse2"}):
                self.assertEqual([array.tobytes() for array in all_of(**more)], wanted)


class Boxes(unittest.TestCase):
    def lattices(self):
        return [ffd.Lattice.parse({"format": "ffd-lattice", "version": 1, "size": [4, 4, 4], "rest": {"box": "mesh", "margin": margin}, "moves": [move]})
                for margin, move in ((0.05, {"twist": {"axis": "y", "degrees": 60}}), (0.0, {"bend": {"axis": "z", "toward": "x", "degrees": 40}}),
                                     (0.1, {"at": ["all", "all", -1], "by": [0.1, 0.2, 0.3]}))]

    def test_boxes_go_round_the_points_as_they_come(self):
        for kind in (np.float32, np.float64):
            points = POINTS.astype(kind)[8:]
            for several, more in ((ffd.Chain(self.lattices()), []), (ffd.Blocks(self.lattices()), ["--blocks"])):
                self.assertTrue(several.needs_points)
                for outside in ("keep", "extend"):
                    fitted = several.fit(points, outside=outside)
                    self.assertFalse(fitted.needs_points)
                    found = fitted.deform(fitted.embed(points, outside=outside))
                    wanted = by_program(points, several.lattices, *more, "--outside", outside)
                    self.assertEqual(found.tobytes(), wanted.tobytes(), (kind, more, outside))

    def test_a_shared_box_goes_round_all(self):
        points, other = POINTS[8:1000], 2 * POINTS[1000:2000] + (0, 0, 3)
        for several, more in ((ffd.Chain(self.lattices()), []), (ffd.Blocks(self.lattices()), ["--blocks"])):
            fitted = several.fit(points, other, shared_box=True)
            wanted = by_program(points, several.lattices, "--shared-box", *more, others=[other])
            self.assertEqual(fitted.deform(fitted.embed(points)).tobytes(), wanted.tobytes())
            with self.assertRaisesRegex(ValueError, "shared_box=True"):
                several.fit(points, other)
            with self.assertRaisesRegex(ValueError, "one array"):
                several.fit()
            with self.assertRaisesRegex(ValueError, "use the lattice that fit"):
                several.embed(points)
            with self.assertRaisesRegex(ValueError, "no finite point"):
                several.fit(points[:3] * np.nan)


class Products(unittest.TestCase):
    def several(self):
        return ((ffd.Chain([FIRST, SECOND, WEIGHTED]), POINTS[8:208]), (ffd.Blocks(SIDES), ON_FACES[:200]))

    def test_differences(self):
        for several, points in self.several():
            for outside in ("keep", "extend"):
                embedding = several.embed(points, outside=outside, falloff=0.7 if outside == "extend" else 0)
                for number, lattice in enumerate(several.lattices):
                    D = [None] * len(several)
                    D[number] = RANDOM.standard_normal(lattice.rest.shape)
                    step = 1e-6
                    sides = []
                    for way in (step, -step):
                        offsets = [None] * len(several)
                        offsets[number] = lattice.offsets + way * D[number]
                        sides.append(several.deform(embedding, offsets=offsets))
                    slope = (sides[0] - sides[1]) / (2 * step)
                    found = several.basis_times(embedding, D)
                    # A step may take a point over the border of a later lattice.
                    near = np.abs(slope - found).max(axis=1) < 1e-6
                    self.assertGreater(near.sum(), 195 if outside == "keep" else 190, (several, outside, number))
                    self.assertGreater(np.abs(found).max(), 0.1)

    def test_transposed_is_the_adjoint(self):
        for several, points in self.several():
            embedding = several.embed(np.tile(points, (50, 1)), outside="extend")
            D = [RANDOM.standard_normal(lattice.rest.shape) for lattice in several.lattices]
            g = RANDOM.standard_normal((len(embedding), 3))
            ahead, back = several.basis_times(embedding, D), several.basis_transposed(embedding, g)
            self.assertEqual([array.shape for array in back], [lattice.rest.shape for lattice in several.lattices])
            forward = np.sum(ahead * g)
            self.assertLess(abs(forward - sum(np.sum(d * b) for d, b in zip(D, back))), 1e-9 * max(1, abs(forward)))
            parts = sum(several.basis_times(embedding, [d if k == n else None for k, d in enumerate(D)]) for n in range(len(several)))
            self.assertLess(np.abs(parts - ahead).max(), 1e-11)

    def test_an_embedding_goes_along_with_the_control_points(self):
        for several, points in ((ffd.Chain([FIRST, SECOND, WEIGHTED]), POINTS), (ffd.Blocks(SIDES), ON_FACES)):
            for kind, options in ((np.float64, {"outside": "extend", "falloff": 0.3}), (np.float32, {"snap": 0.01})):
                embedding = several.embed(points.astype(kind), **options)
                Q = [support.pushed(RANDOM, lattice, 0.04) for lattice in several.lattices]
                made, wanted = embedding.moved(Q), several.moved(Q).embed(points.astype(kind), **options)
                self.assertEqual((made.uvw.tobytes(), made.status.tobytes()), (wanted.uvw.tobytes(), wanted.status.tobytes()))
                self.assertTrue(np.array_equal(made.blocks, wanted.blocks))
                self.assertEqual(made.chain.deform(made).tobytes(), several.deform(embedding, Q).tobytes())
                g = RANDOM.standard_normal(points.shape)
                for a, b in zip(made.chain.basis_transposed(made, g), wanted.chain.basis_transposed(wanted, g)):
                    self.assertEqual(a.tobytes(), b.tobytes())

    def test_a_chain_agrees_with_the_program(self):
        """By the control points of each lattice, through those behind it."""
        points, lattices = POINTS[8:308], [FIRST, SECOND, WEIGHTED]
        chain = ffd.Chain(lattices)
        embedding = chain.embed(points, outside="extend")
        with tempfile.TemporaryDirectory() as folder:
            names = [os.path.join(folder, name) for name in ("in.ply", "D.npy", "out.npy")]
            with open(names[0], "wb") as file:
                file.write(support.ply(points))
            for number, lattice in enumerate(lattices):
                D = [None, None, None]
                D[number] = RANDOM.standard_normal(lattice.rest.shape)
                np.save(names[1], D[number].transpose(2, 1, 0, 3).reshape(-1, 3))
                ffd.jacobian_file(names[0], names[2], lattices, of=number, times=names[1], outside="extend", force=True)
                self.assertLess(np.abs(chain.basis_times(embedding, D) - np.load(names[2])).max(), 1e-12)

    def test_one_lattice_is_a_lattice(self):
        for kind in (ffd.Chain, ffd.Blocks):
            one = kind([WEIGHTED])
            embedding, alone = one.embed(POINTS, outside="extend", falloff=0.1), WEIGHTED.embed(POINTS, outside="extend", falloff=0.1)
            self.assertEqual(one.deform(embedding).tobytes(), WEIGHTED.deform(alone).tobytes())
            self.assertEqual((embedding.uvw.tobytes(), embedding.status.tobytes()), (alone.uvw.tobytes(), alone.status.tobytes()))
            D, g = RANDOM.standard_normal(WEIGHTED.rest.shape), RANDOM.standard_normal(POINTS.shape)
            self.assertLess(np.abs(one.basis_times(embedding, [D]) - WEIGHTED.basis_times(alone, D)).max(), 1e-14)
            self.assertEqual(one.basis_transposed(embedding, g)[0].tobytes(), WEIGHTED.basis_transposed(alone, g).tobytes())
            more = {"normals": g, "tangents": g[:, ::-1], "gradients": True, "weight": RANDOM.random(5000), "triangles": RANDOM.integers(8, 5000, (900, 3))}
            found, wanted = one.deform(embedding, **more), WEIGHTED.deform(alone, **more)
            for name in ("points", "normals", "tangents", "gradients"):
                self.assertEqual(getattr(found, name).tobytes(), getattr(wanted, name).tobytes(), name)
            self.assertEqual(found.collapsed, wanted.collapsed)


class Statuses(unittest.TestCase):
    def test_outside_is_outside_of_all(self):
        chain = ffd.Chain([FIRST, SECOND])
        embedding = chain.embed(POINTS)
        first = FIRST.embed(POINTS)
        second = SECOND.embed(np.where(np.isfinite(POINTS), FIRST.deform(first), POINTS))
        outside = (first.status == ffd.Status.OUTSIDE) & (second.status == ffd.Status.OUTSIDE)
        self.assertTrue(np.array_equal(embedding.status == ffd.Status.OUTSIDE, outside) and 0 < outside.sum() < 4000)
        self.assertEqual(embedding.status[7], ffd.Status.INVALID)
        self.assertEqual(embedding.uvw.tobytes(), first.uvw.tobytes())
        self.assertIsNone(embedding.blocks)
        self.assertEqual(embedding.counts[ffd.Status.OUTSIDE], outside.sum())
        with self.assertRaisesRegex(ffd.EmbeddingError, f"point {np.flatnonzero(outside)[0]} at .* is outside of all lattices"):
            chain.embed(POINTS[np.isfinite(POINTS).all(axis=1) | outside], outside="error", threads=1)
        inside = POINTS[~outside & np.isfinite(POINTS).all(axis=1)]
        self.assertEqual(chain.deform(chain.embed(inside, outside="error")).tobytes(), chain.deform(chain.embed(inside)).tobytes())

    def test_blocks_say_which_lattice_moves_a_point(self):
        blocks = ffd.Blocks(SIDES)
        embedding = blocks.embed(ON_FACES)
        x = ON_FACES[:, 0]
        inside = ((ON_FACES >= 0) & (ON_FACES <= (1.5, 1, 1))).all(axis=1)
        # A point on a common face is in the first of both.
        wanted = np.where(inside, np.clip(np.ceil(x / 0.5) - 1, 0, 2), -1).astype(int)
        self.assertTrue(np.array_equal(embedding.blocks, wanted))
        self.assertTrue(np.array_equal(embedding.status == ffd.Status.OUTSIDE, ~inside))
        nearest = blocks.embed(ON_FACES, outside="extend").blocks
        self.assertTrue(np.array_equal(nearest[inside], wanted[inside]) and (nearest >= 0).all())
        self.assertTrue(np.array_equal(nearest[~inside], np.clip(np.ceil(x[~inside] / 0.5) - 1, 0, 2)))
        self.assertTrue(np.array_equal(ffd.Blocks(SIDES[:1]).embed(ON_FACES).blocks, np.where(inside & (x <= 0.5), 0, -1)))


    def test_volumes_that_overlap_have_a_warning(self):
        with self.assertNoLogs("ffd_mesh"):
            ffd.Blocks(SIDES).embed(POINTS)
            ffd.Chain([SECOND, SECOND]).embed(POINTS)
        with self.assertLogs("ffd_mesh", "WARNING") as found:
            ffd.Blocks([SIDES[0], SIDES[2], SECOND]).embed(POINTS)
        self.assertEqual(found.output, ["WARNING:ffd_mesh:the volumes of lattices 0 and 2 overlap: what is in both goes with the first lattice alone"])
        with self.assertLogs("ffd_mesh", "WARNING") as found:
            ffd.Blocks([SECOND, *SIDES]).embed(POINTS)
        self.assertIn("lattices 0 and 1 overlap, and 1 more pairs do", found.output[0])


class Use(unittest.TestCase):
    def test_outputs_and_parts(self):
        chain = ffd.Chain([FIRST, SECOND])
        points = POINTS.copy()
        embedding = chain.embed(points)
        self.assertTrue(np.shares_memory(embedding.points, points) and not embedding.points.flags.writeable)
        wanted = chain.deform(embedding)
        wide = np.full((5000, 5), 7.0)
        self.assertEqual(np.ascontiguousarray(chain.deform(embedding, out=wide[:, 1:4])).tobytes(), wanted.tobytes())
        some = np.array([0, 3, 900, 4999])
        out = chain.deform(embedding, vertices=some)
        self.assertTrue(np.array_equal(out[some], wanted[some]))
        rest = np.setdiff1d(np.arange(5000), some)
        self.assertEqual(out[rest].tobytes(), points[rest].tobytes())
        self.assertEqual(chain.deform(embedding, vertices=[]).tobytes(), points.tobytes())
        changed = points.copy()
        points[:] = 0
        self.assertEqual(chain.deform(embedding, points=changed, out=changed).tobytes(), wanted.tobytes())
        narrow = chain.embed(POINTS.astype(np.float32))
        self.assertEqual(chain.deform(narrow, out=np.empty((5000, 3))).astype(np.float32).tobytes(), chain.deform(narrow).tobytes())
        empty = chain.embed(np.empty((0, 3)))
        self.assertEqual((len(empty), chain.deform(empty).shape, chain.basis_times(empty, [None, None]).shape), (0, (0, 3), (0, 3)))
        self.assertEqual([array.any() for array in chain.basis_transposed(empty, np.empty((0, 3)))], [False, False])

    def test_pickles_keep_every_bit(self):
        for several, points in ((ffd.Chain([FIRST, SECOND]), POINTS.astype(np.float32)), (ffd.Blocks(SIDES), ON_FACES)):
            embedding = several.embed(points, outside="extend", falloff=0.3, snap=0.01)
            again = pickle.loads(pickle.dumps(embedding))
            self.assertEqual((again.uvw.tobytes(), again.status.tobytes()), (embedding.uvw.tobytes(), embedding.status.tobytes()))
            self.assertEqual(again.chain.deform(again).tobytes(), several.deform(embedding).tobytes())
            other = pickle.loads(pickle.dumps(several))
            g = RANDOM.standard_normal(points.shape)
            for a, b in zip(other.basis_transposed(embedding, g), several.basis_transposed(again, g)):
                self.assertEqual(a.tobytes(), b.tobytes())

    def test_threads_share_an_embedding(self):
        chain = ffd.Chain([FIRST, SECOND])
        embedding, found = chain.embed(POINTS), {}
        Q = [[support.pushed(RANDOM, FIRST), None] for _ in range(4)]

        def work(number):
            found[number] = [chain.deform(embedding, Q[number], threads=2).tobytes() for _ in range(3)]

        threads = [threading.Thread(target=work, args=(number,)) for number in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for number in range(4):
            self.assertEqual(found[number], [chain.deform(embedding, Q[number]).tobytes()] * 3)

    def test_progress_and_cancelling(self):
        for several in (ffd.Chain([FIRST, SECOND]), ffd.Blocks(SIDES)):
            embedding = several.embed(POINTS)
            D = [None] * len(several)
            for call in (lambda **more: several.embed(POINTS, **more), lambda **more: several.deform(embedding, **more),
                         lambda **more: several.basis_times(embedding, D, **more), lambda **more: several.basis_transposed(embedding, POINTS, **more)):
                seen = []
                call(progress=seen.append)
                self.assertTrue(seen and seen[-1] <= 1)
                with self.assertRaises(ffd.Cancelled):
                    call(progress=lambda done: False)

    def refused(self, kind, words, function, *arguments, **more):
        with self.assertRaisesRegex(kind, words):
            function(*arguments, **more)

    def test_refusals(self):
        chain, blocks = ffd.Chain([FIRST, SECOND]), ffd.Blocks(SIDES)
        points = np.nan_to_num(POINTS)
        embedding, Q = chain.embed(points), [FIRST.rest, SECOND.rest]
        self.refused(ValueError, "Chain needs at least one lattice", ffd.Chain, [])
        self.refused(TypeError, "Blocks takes lattices, not str", ffd.Blocks, ["a.json"])
        self.refused(TypeError, "use Chain.embed or Blocks.embed", ffd.ChainEmbedding)
        self.refused(ValueError, r"points must have the shape \(N, 3\)", chain.embed, points[:, :2])
        self.refused(ffd.ArgumentError, 'falloff 1 needs outside "extend"', chain.embed, points, falloff=1)
        self.refused(ffd.ArgumentError, "snap -1", chain.embed, points, snap=-1)
        for bad, kind, words in ((FIRST.rest, TypeError, "Q must be a list with an entry for each lattice"), ([None], ValueError, "Q must have 2 entries"),
                                 ([FIRST.rest, FIRST.rest], ValueError, r"Q\[1\] must have the shape \(4, 5, 4, 3\)"),
                                 ([FIRST.rest[None], None], ValueError, r"Q\[0\] must have the shape"), ([FIRST.rest * np.nan, None], ffd.InvalidError, "finite")):
            self.refused(kind, words, chain.deform, embedding, bad)
        self.refused(ValueError, "lattice 0: give Q or offsets, not both", chain.deform, embedding, Q, offsets=Q)
        self.refused(ffd.InvalidError, "weight", chain.deform, embedding, weights=[-np.ones(FIRST.size), None])
        self.refused(ValueError, "triangles= is for weight=", chain.deform, embedding, triangles=[[0, 1, 2]])
        self.refused(ValueError, "need triangles=", chain.deform, embedding, normals=points, weight=np.ones(5000))
        self.refused(ffd.InvalidError, "weight", chain.deform, embedding, weight=np.full(5000, 2.0))
        self.refused(ValueError, "need all vertices", chain.deform, embedding, vertices=[1], gradients=True)
        self.refused(ValueError, "out is memory", chain.deform, embedding, out=points)
        self.refused(ValueError, "vertices", chain.deform, embedding, vertices=[5000])
        self.refused(ffd.ArgumentError, "ascending", chain.deform, embedding, vertices=[2, 1])
        self.refused(TypeError, "what Chain.embed returns, not Embedding", chain.deform, FIRST.embed(points))
        self.refused(TypeError, "what embed returns, not ChainEmbedding", FIRST.deform, embedding)
        for function in (blocks.deform, ffd.Chain([FIRST]).deform):
            self.refused(ffd.InvalidError, "other lattices", function, embedding)
        self.refused(ffd.InvalidError, "lattice 0: the embedding is of another lattice", ffd.Chain([SECOND, FIRST]).deform, embedding)
        self.refused(ValueError, "D must have 2 entries", chain.basis_times, embedding, [None])
        self.refused(ValueError, r"D\[0\] must have the shape", chain.basis_times, embedding, [SECOND.rest, None])
        self.refused(ValueError, "dfdx must have the shape", chain.basis_transposed, embedding, points[1:])
        other = chain.moved(Q)
        self.refused(ffd.InvalidError, "lattice 0 is not that of the embedding", other.basis_transposed, embedding, points)
        self.assertEqual(other.deform(embedding).tobytes(), points.tobytes())
        self.refused(ffd.InvalidError, "too large for float32", ffd.Chain([FIRST.moved(FIRST.rest + 1e39), SECOND]).deform,
                     chain.embed(points.astype(np.float32)))


if __name__ == "__main__":
    unittest.main()
