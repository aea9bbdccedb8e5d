"""Many jobs in several processes of the program."""

import filecmp
import json
import os
import sys
import tempfile
import unittest
from unittest import mock

import ffd_mesh as ffd
import numpy as np
import support

SPOT = os.path.join(support.DATA, "models", "spot.obj")
TWIST = os.path.join(support.DATA, "lattices", "twist.json")


def jobs_of(*names, **more):
    return [{"in": SPOT, "lattice": TWIST, "out": name, **more} for name in names]


class Batches(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(folder.name)
        path = os.path.dirname(support.FFD) + os.pathsep + os.environ["PATH"]
        patch = mock.patch.dict(os.environ, PATH=path, XDG_CACHE_HOME=os.path.join(folder.name, "cache"))
        patch.start()
        self.addCleanup(patch.stop)

    def test_results_come_in_the_order_of_the_jobs_and_are_those_of_deform_file(self):
        options = {"normals": "keep"}
        listed = [*jobs_of("a.obj", "b.obj"), {"in": "none.obj", "lattice": TWIST, "out": "x.obj"}, *jobs_of("c.obj", options=options),
                  *jobs_of("d.obj", options={"normal": "keep"})]
        results = ffd.batch(listed, workers=2, quality=True)
        self.assertEqual([(result.row, result.output) for result in results], list(enumerate(["a.obj", "b.obj", "x.obj", "c.obj", "d.obj"])))
        self.assertEqual([type(result.error) for result in results],
                         [type(None), type(None), ffd.FileError, type(None), ffd.InvalidError])
        self.assertEqual(str(results[2].error), "none.obj: cannot be opened: No such file or directory")
        self.assertIn("(nearest: normals)", str(results[4].error))
        for name, number, own in (("one.obj", 0, {}), ("three.obj", 3, options)):
            expected = ffd.deform_file(SPOT, name, TWIST, quality=True, **own)
            self.assertTrue(filecmp.cmp(name, results[number].output, shallow=False))
            differing = [key for key, value in expected.__dict__.items()
                         if key not in ("seconds", "outputs") and repr(value) != repr(results[number].__dict__[key])]
            self.assertEqual(differing, [])
            self.assertEqual((expected.outputs, results[number].outputs), ([name], [results[number].output]))
        self.assertEqual(results[0].folds.verdict, "none")

    def test_an_iterator_is_asked_for_what_can_begin_and_resume_leaves_what_is_done(self):
        ended, taken = [], []

        def jobs():
            for i in range(12):
                taken.append(len([name for name in os.listdir() if name.startswith("i")]))
                yield from jobs_of(f"i{i}.obj")
        first = ffd.batch(jobs(), workers=2, resume=True)
        self.assertGreater(taken[-1], 5, "all jobs were taken before any had ended")
        again = ffd.batch(jobs_of(*(f"i{i}.obj" for i in range(13))), resume=True, workers=2,
                          progress=lambda done: ended.append(done))
        self.assertEqual([result.skipped for result in first], [False] * 12)
        self.assertEqual([result.skipped for result in again], [True] * 12 + [False])
        self.assertEqual((again[0].error, again[12].moved, ended[-1]), (None, 11533, 1.0))

    def test_pictures_have_the_options_of_view_one_frame_and_pages(self):
        small = {"camera": "front", "up": "z", "size": (160, 90), "color": "det", "no_cage": True}
        listed = jobs_of("a.obj", "b.obj")
        listed[1]["options"] = {"view": {"camera": [0, 0, 1], "no-cage": True}}
        results = ffd.batch(listed, view="v", pages=True, **small)
        self.assertEqual([result.outputs for result in results], [[name, f"v/{name}.png", f"v/{name}.html"] for name in ("a.obj", "b.obj")])
        self.assertEqual([result.own_frame for result in results], [None, "options"])
        self.assertIn("1 of 2 pictures is not in the common frame", "".join(self.log(lambda: ffd.batch(listed, view="w", force=True, **small))))
        ffd.view_file(SPOT, "p.png", TWIST, **{**small, "camera": (0, 0, 1)})
        self.assertTrue(filecmp.cmp("p.png", "v/b.obj.png", shallow=False))
        ffd.view_file(SPOT, "a.png", TWIST, **small)
        self.assertTrue(filecmp.cmp("a.png", "v/a.obj.png", shallow=False))
        with self.assertRaisesRegex(ffd.ArgumentError, "pages=True needs view="):
            ffd.batch(listed, pages=True)
        with self.assertRaisesRegex(ffd.ArgumentError, "how pictures are drawn needs view="):
            ffd.batch(listed, camera="front")
        with self.assertRaisesRegex(ValueError, "camera must be one of"):
            ffd.batch(listed, view="v", camera="frnt")

    def log(self, call):
        """What is logged during a call."""
        with self.assertLogs("ffd_mesh") as logged:
            call()
        return logged.output

    def test_manifests_tables_and_patterns(self):
        with open("m.jsonl", "w", encoding="utf-8") as file:
            file.writelines(json.dumps(job) + "\n" for job in jobs_of("a.obj", "b.obj", "c.obj"))
        self.assertEqual([result.line for result in ffd.batch("m.jsonl", shard=(1, 2))], [2])
        os.mkdir("out")
        with open("t.csv", "w", encoding="utf-8") as file:
            file.write(f"in,out\n{SPOT},t1.obj\n{SPOT},t2.obj\n")
        results = ffd.batch("t.csv", lattice=TWIST, out_dir="out", normals="keep", set=None)
        self.assertEqual([result.output for result in results], ["out/t1.obj", "out/t2.obj"])
        ffd.deform_file(SPOT, "one.obj", TWIST, normals="keep")
        self.assertTrue(filecmp.cmp("one.obj", "out/t2.obj", shallow=False))
        ffd.batch(None, in_=SPOT, lattice=[TWIST, TWIST], positions="all.npy", dtype="f8")
        points = np.load("all.npy")
        self.assertEqual((points.shape, points.dtype), ((1, 11533, 3), np.float64))
        np.testing.assert_array_equal(points[0], ffd.positions_file(SPOT, [TWIST, TWIST]).points)

    def test_what_the_caller_raises_ends_the_batch(self):
        def broken():
            yield from jobs_of("a.obj")
            raise KeyError("mine")
        with self.assertRaisesRegex(KeyError, "mine"):
            ffd.batch(broken())
        with self.assertRaises(ZeroDivisionError):
            ffd.batch(jobs_of("b.obj"), progress=lambda done: 1 / 0)
        with self.assertRaises(ffd.Cancelled):
            ffd.batch(jobs_of("c.obj", "d.obj"), progress=lambda done: False)
        with self.assertRaisesRegex(TypeError, "a job must be a dict, not int"):
            ffd.batch([1])

    def test_arguments_that_do_not_fit(self):
        lattice = ffd.Lattice.load(TWIST)
        for says, jobs, arguments in (("shard= is not one of", jobs_of("a.obj"), {"shard": (2, 2)}),
                                      ("a list of jobs cannot be used with", jobs_of("a.obj"), {"lattice": TWIST}),
                                      ("of a batch are files", None, {"in_": SPOT, "lattice": lattice, "out_dir": "."}),
                                      ("shared_box=True reads the jobs twice, but its caller gives them only once", iter(jobs_of("a.obj")),
                                       {"shared_box": True}),
                                      ("a manifest, or in_=, or a table", None, {})):
            with self.assertRaisesRegex(ffd.ArgumentError, says):
                ffd.batch(jobs, **arguments)
        with self.assertRaisesRegex(TypeError, "unknown option 'normal'"):
            ffd.batch(jobs_of("a.obj"), normal="keep")
        self.assertEqual(os.listdir(), [])

    def test_without_the_program_the_message_names_it(self):
        """The package brings the program; it may have lost it."""
        program = os.path.join(os.path.dirname(ffd.__file__), "ffd")
        os.rename(program, program + ".away")
        self.addCleanup(os.rename, program + ".away", program)
        with mock.patch.dict(os.environ, PATH="/nowhere"), self.assertRaisesRegex(ffd.UnsupportedError, '"ffd"'):
            ffd.batch(jobs_of("a.obj"))
        with open("ffd", "w", encoding="utf-8") as file:
            file.write("#!/bin/sh\nexit 2\n")
        os.chmod("ffd", 0o755)
        with mock.patch.dict(os.environ, PATH=os.getcwd()), self.assertRaisesRegex(ffd.UnsupportedError, "is of another build"):
            ffd.batch(jobs_of("a.obj"))


if __name__ == "__main__":
    sys.exit(unittest.main())
