"""Lattices with keys: stills of Lattice.at give the bytes of --time, the right answers of reference cases, pickles."""

import copy
import json
import os
import pickle
import tempfile
import unittest

import ffd_mesh as ffd
import numpy as np
import support

RANDOM = support.rng("keys")
CASES = os.path.join(support.SOURCE, "tests", "cli", "authoring")
TURN = {"format": "ffd-lattice", "version": 1, "size": [4, 5, 4], "rest": {"box": {"min": [-1, -1, -1], "max": [1, 1, 1]}},
        "parameters": {"B": {"default": 1.25}}, "moves": [{"twist": {"axis": "y", "degrees": {"$": "A"}}}, {"scale": {"factor": {"$": "B"}}}],
        "keys": [{"time": 0.5, "set": {"A": 0}}, {"time": 2, "set": {"A": 120}}, {"time": 3, "set": {"A": -30}}]}


def at(content, **changes):
    """The same content as a still, with these values."""
    made = {**content, "parameters": {name: {"default": value} for name, value in changes.items()}}
    del made["keys"]
    return ffd.Lattice.parse(made)


class Keys(unittest.TestCase):
    def test_reference_cases(self):
        for name in ("time-set-twist.json", "animate-keys-1.json"):
            with open(os.path.join(CASES, name), encoding="utf-8") as file:
                of = json.load(file)
            lattice = ffd.Lattice.parse(of["lattice"])
            self.assertEqual(lattice.keys, tuple(key["time"] for key in of["lattice"]["keys"]))
            points = np.array(of["before"])
            embedding = lattice.embed(points)
            for frame in of["expect"]["frames"]:
                found = lattice.at(frame["time"]).deform(embedding)
                self.assertLessEqual(abs(found - frame["points"]).max(), of["expect"]["tolerance"], (name, frame["time"]))

    def test_the_bytes_of_the_program(self):
        lattice = ffd.Lattice.parse(TURN)
        points = RANDOM.uniform(-1, 1, (20, 3)).astype(np.float32)
        with tempfile.TemporaryDirectory() as folder:
            path, mesh, out, own, table = (os.path.join(folder, name) for name in ("k.json", "m.ply", "o.ply", "p.ply", "k.csv"))
            lattice.save(path)
            with open(mesh, "wb") as file:
                file.write(support.ply(points))
            for time in (0, 0.5, 1.1, 2.9, 9):
                support.program("deform", mesh, out, "-l", path, "--time", repr(time), "--force")
                for given in (path, lattice, lattice.at(time)):
                    options = {} if given is not path and not given.keys else {"time": time}
                    ffd.deform_file(mesh, own, given, force=True, **options)
                    with open(out, "rb") as programs, open(own, "rb") as ours:
                        self.assertEqual(programs.read(), ours.read(), time)
                support.program("lattice", "convert", path, "-o", table, "--time", repr(time), "--force")
                with open(table, "rb") as programs:
                    text = programs.read()
                for write in (lambda: ffd.convert_lattice(path, table, time=time, force=True), lambda: lattice.at(time).save(table, force=True)):
                    write()
                    with open(table, "rb") as ours:
                        self.assertEqual(text, ours.read())
            ffd.deform_file(mesh, own, lattice, force=True)  # the first key
            ffd.deform_file(mesh, out, at(TURN, A=0, B=1.25), force=True)
            with open(out, "rb") as first, open(own, "rb") as ours:
                self.assertEqual(first.read(), ours.read())
            for call in (lambda: ffd.deform_file(mesh, own, lattice.at(1), time=float("nan"), force=True),
                         lambda: ffd.deform_file(mesh, own, at(TURN, A=1, B=1), time=1.0, force=True),
                         lambda: ffd.convert_lattice(path, table, force=True), lambda: lattice.save(table, force=True),
                         lambda: ffd.Lattice.load(path, {"A": 3})):
                with self.assertRaises(ffd.ArgumentError):
                    call()

    def test_stills(self):
        lattice = ffd.Lattice.parse(TURN)
        self.assertEqual(lattice.keys, (0.5, 2.0, 3.0))
        for time, angle in ((0, 0), (1.25, 60), (2, 120), (2.5, 45), (7, -30)):
            still = lattice.at(time)
            self.assertEqual((still.keys, still.text.count('"keys"')), ((), 0))
            self.assertTrue((still.offsets == at(TURN, A=angle, B=1.25).offsets).all())
            for again in (pickle.loads(pickle.dumps(still)), copy.deepcopy(still), ffd.Lattice.parse(still.text)):
                self.assertTrue((again.offsets == still.offsets).all())
            with self.assertRaises(ValueError):
                still.at(1)
        for again in (pickle.loads(pickle.dumps(lattice)), ffd.Lattice.parse(lattice.text)):
            self.assertEqual(again.keys, lattice.keys)
            self.assertTrue((again.at(1.1).offsets == lattice.at(1.1).offsets).all())
        self.assertEqual(lattice.moved(offsets=lattice.offsets).keys, ())
        self.assertTrue((lattice.at(1).strength(0.5).offsets == 0.5 * lattice.at(1).offsets).all())
        with self.assertRaises(ffd.ArgumentError):
            lattice.at(float("inf"))
        with self.assertRaises(ValueError):
            at(TURN, A=1, B=1).at(0)

    def test_animations_are_those_of_the_program(self):
        with open(os.path.join(CASES, "animate-keys-1.json"), encoding="utf-8") as file:
            of = json.load(file)
        points = np.array(of["before"], np.float32)
        with tempfile.TemporaryDirectory() as folder:
            mesh, k, out, own, report = (os.path.join(folder, name) for name in ("m.ply", "k.json", "o.glb", "p.glb", "r.json"))
            with open(mesh, "wb") as file:
                file.write(support.ply(points))
            with open(k, "w", encoding="utf-8") as file:
                json.dump(of["lattice"], file)
            w = os.path.join(folder, "w.npy")
            np.save(w, np.linspace(0, 1, len(points)))
            for words, options in (([], {}), (["--targets", "keys"], {"targets": "keys"}), (["--targets", "2", "--name", "wave"], {"targets": 2, "name": "wave"}),
                                   (["--tolerance", "0.01", "--fps", "24", "--normals", "keep"], {"tolerance": 0.01, "fps": 24, "normals": "keep"}),
                                   (["--tolerance", "1e-2r", "--outside", "extend"], {"tolerance": "1e-2r", "outside": "extend"}),
                                   (["--weight", w], {"weight": w})):
                support.program("animate", mesh, out, "-l", k, "--force", "--report", report, "--report-stable", *words)
                with open(out, "rb") as file:
                    bytes_of_program = file.read()
                with open(report, encoding="utf-8") as file:
                    told = json.load(file)["jobs"][0]
                made = ffd.animate_file(mesh, own, k, force=True, **options)
                with open(own, "rb") as file:
                    self.assertEqual(file.read(), bytes_of_program, words)
                self.assertEqual({name: getattr(made, name) for name in told["animation"]}, told["animation"])
                self.assertEqual(made.counts, {name: told[name] for name in made.counts})
                lent = {"animation": options.get("name", "k"), **{name: value for name, value in options.items() if name != "name"}}
                for lattice in (ffd.Lattice.load(k), k):
                    found = ffd.animate_bytes(support.ply(points), lattice, name="m.ply", output="o.glb", **lent)
                    self.assertEqual((found.data, found.files), (bytes_of_program, {}))
            self.assertEqual(ffd.animate_file(mesh, own, k, force=True, targets="keys").targets, of["expect"]["targets"])
            for call, error in ((lambda: ffd.animate_file(mesh, own, k), ffd.ExistsError), (lambda: ffd.animate_file(mesh, own, k, fail_on="folds"), TypeError),
                                (lambda: ffd.animate_file(mesh, own, k, targets="some"), (TypeError, ValueError)),
                                (lambda: ffd.animate_file(mesh, own, k, tolerance=0, force=True), ffd.ArgumentError),
                                (lambda: ffd.animate_file(mesh, own, k, fps=0.5, force=True), ffd.ArgumentError),
                                (lambda: ffd.animate_file(mesh, own, k, normals="recompute", force=True), ffd.ArgumentError),
                                (lambda: ffd.animate_file(mesh, "o.ply", k), ffd.ArgumentError),
                                (lambda: ffd.animate_file(mesh, own, ffd.Lattice.box((0, 0, 0), (1, 1, 1)), force=True), ffd.InvalidError),
                                (lambda: ffd.animate_file(mesh, own, k, force=True, progress=lambda done: False), ffd.Cancelled)):
                with self.assertRaises(error):
                    call()

    def test_a_box_round_points(self):
        content = {**TURN, "rest": {"box": "mesh"}, "units": "box"}
        points = RANDOM.uniform(-1, 1, (50, 3))
        lattice = ffd.Lattice.parse(content)
        first, second = lattice.fit(points).at(1.1), lattice.at(1.1).fit(points)
        self.assertTrue((first.offsets == second.offsets).all() and abs(first.offsets).max() > 0.1)
        for again in (pickle.loads(pickle.dumps(first)), pickle.loads(pickle.dumps(lattice)).fit(points).at(1.1),
                      pickle.loads(pickle.dumps(lattice.fit(points))).at(1.1), pickle.loads(pickle.dumps(lattice.at(1.1))).fit(points)):
            self.assertTrue((again.offsets == first.offsets).all())


if __name__ == "__main__":
    unittest.main()
