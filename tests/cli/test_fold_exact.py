#!/usr/bin/env python3
"""Verdicts, witnesses and min_det of volumes with steep weights, beside determinants without rounding.
FFD_SEED=N takes other lattices, FFD_CASES=N so many."""
import math
import os
import random

from exact_determinant import ExactVolume, greville, preset
from harness import NO, case, check, equal, main, repetitions
from messages import anything

CASES = int(os.environ.get("FFD_CASES") or repetitions(30))
SEED = int(os.environ.get("FFD_SEED") or (random.randrange(10 ** 6) if os.environ.get("FFD_CASES") else 7))
MOST_STEEP = 8  # weights to 10^8
SAMPLES = 40
MESH = "v 0.4 0.4 0.4\nv 0.6 0.4 0.5\nv 0.4 0.6 0.6\nf 1 2 3\n"


def knots(numbers, n, degree):
    """Clamped ones, so that a box is the whole volume, whatever the weights."""
    if numbers.random() < 0.6:
        return "clamped"
    start, side = numbers.choice((0.0, 1e3, -5.0)), numbers.choice((1, 1e-2, 100))
    inner = sorted(start + side * numbers.random() ** numbers.choice((1, 3)) for _ in range(n - degree + 1))
    return [inner[0]] * degree + inner + [inner[-1]] * degree


def steep_weights(numbers, size):
    """A heavy or a light point, a few, a layer, every other one, products, or any."""
    ratio = 10 ** numbers.uniform(0.3, MOST_STEEP) ** numbers.choice((1, 1, -1))
    index = [(i, j, k) for k in range(size[2]) for j in range(size[1]) for i in range(size[0])]
    kind = numbers.randrange(6)
    if kind == 0:
        heavy = set(numbers.sample(index, min(len(index), numbers.choice((1, 1, 2, 4)))))
        return [ratio if at in heavy else 1.0 for at in index]
    if kind == 1:
        a = numbers.randrange(3)
        layer = numbers.randrange(size[a])
        return [ratio if at[a] == layer else 1.0 for at in index]
    if kind == 2:
        return [ratio if sum(at) % 2 else 1.0 for at in index]
    if kind == 3:
        factors = [[ratio ** (numbers.random() / 3) for _ in range(n)] for n in size]
        return [math.prod(f[i] for f, i in zip(factors, at)) for at in index]
    return [ratio ** numbers.random() for _ in index]


class Box:
    """A lattice of a unit box with weights, and its control points."""

    def __init__(self, numbers):
        most = 9 if numbers.random() < 0.05 else 3
        self.degree = [numbers.randint(1, most if most == 3 or a == 0 else 2) for a in range(3)]
        self.size = [d + 1 + numbers.choice((0, 0, 1, 2)) for d in self.degree]
        self.kinds = [knots(numbers, n, d) for n, d in zip(self.size, self.degree)]
        self.knots = [preset(kind, n, d) for kind, n, d in zip(self.kinds, self.size, self.degree)]
        places = [greville(t, n, d) for t, n, d in zip(self.knots, self.size, self.degree)]
        self.points = [[x, y, z] for z in places[2] for y in places[1] for x in places[0]]
        self.weights = steep_weights(numbers, self.size)

    def file(self, **more):
        return {"format": "ffd-lattice", "version": 1, "size": self.size, "degree": self.degree, "knots": self.kinds,
                "rest": {"box": {"min": [0, 0, 0], "max": [1, 1, 1]}}, "weights": self.weights, **more}

    def mean(self):
        """The volume is 1, whatever the weights."""
        return 1 / math.prod(t[n] - t[d] for t, n, d in zip(self.knots, self.size, self.degree))


def shaken(numbers, box):
    strength = numbers.choice((1e-6, 0.05, 0.2, 0.5, 1.5))
    return [[x + numbers.uniform(-1, 1) * strength / n for x, n in zip(p, box.size)] for p in box.points]


def bent(numbers, box):
    angle, inner = numbers.uniform(0.5, 4), numbers.choice((0.3, 0.3, -0.8))
    return [[(1 + inner * y) * math.sin(angle * x), (1 + inner * y) * math.cos(angle * x), z] for x, y, z in box.points]


def flat(numbers, box):
    a, b = numbers.uniform(-1, 1), numbers.uniform(-1, 1)
    return [[x + a * y, y - b * x, 0.37 * x] for x, y, z in box.points]


def folds_of(run, lattice, *options, **more):
    run.write("m.obj", MESH)
    run.write("l.json", lattice)
    return run.ffd("check", "m.obj", "-l", "l.json", "--report", "-", *options, err=anything, **more).json["jobs"][0]["folds"]


def judge(volume, mean, folds, numbers):
    """What is wrong with a verdict, in exact arithmetic."""
    places = [volume.place(numbers) for _ in range(SAMPLES)]
    least = min(volume.determinant(*place) for place in places)
    check(folds["verdict"] != "none" or least > 0, f"no folds, but det J is {float(least)}")
    check(folds["min_det"] * mean <= least + abs(least) * 1e-12, f"min_det {folds['min_det']}, but {float(least) / mean}")
    equal([folds["relative_to"], folds["verdict"] == "some"], ["mean", folds["witness"] is not None])
    if folds["witness"]:
        det = volume.determinant(folds["witness"]["uvw"])
        check(det <= 0, f"det J is {float(det)} at the witness {folds['witness']}")
        check(abs(folds["witness"]["det"] - float(det) / mean) <= 1e-9 * abs(float(det) / mean), folds["witness"], float(det) / mean)


def judged(run, seed, i):
    """The verdict on a lattice, which is judged. A quarter has other weights deformed."""
    numbers = random.Random(1000003 * seed + i)
    box = Box(numbers)
    points = numbers.choice((shaken, shaken, shaken, bent, flat))(numbers, box) if i % 4 else box.points
    weights = box.weights if i % 4 else steep_weights(numbers, box.size)
    folds = folds_of(run, box.file(deformed={"points": points, "weights": weights}))
    try:
        judge(ExactVolume(box.size, box.degree, box.knots, points, weights), box.mean(), folds, numbers)
    except AssertionError as error:
        raise AssertionError(f"FFD_SEED={seed}, lattice {i}: {error}; {run.text('l.json')[:300]}") from None
    return folds["verdict"]


@case
def verdicts_on_steep_weights_are_those_of_exact_arithmetic(run):
    counts = {"none": 0, "some": 0, "unknown": 0}
    for i in range(CASES):
        counts[judged(run, SEED, i)] += 1
    check(5 * counts["unknown"] <= CASES and (CASES < 30 or 4 * min(counts["none"], counts["some"]) >= CASES), counts)


@case
def a_place_at_which_the_determinant_is_positive_is_no_witness(run):
    """A volume that is flat to rounding."""
    judged(run, 1, 91)


# One affine map

MOVES = (
    ([], 1),
    ([{"by": [0.1, 1e6, -1e-9]}], 1),
    ([{"rotate": {"axis": [1, 2, 3], "degrees": 33}}, {"by": [0.3, 0, 0]}, {"rotate": {"axis": "x", "degrees": -100}}], 1),
    ([{"scale": {"factor": [2, 0.5, 0.3], "about": [9, -3, 4]}}], 0.3),
    ([{"matrix": [1, 0.5, 0, 3, -0.25, 1, 0.2, 0, 0.1, 0, 0.5, -7, 0, 0, 0, 1]}], 0.5725),
)
SHAPES = (
    {"box": {"min": [-1, 0, 2], "max": [1, 1, 4]}},
    {"box": {"min": [0, 0, 0], "max": [1e-3, 5, 100], "axes": [[0.6, 0.8, 0], [-0.8, 0.6, 0], [0, 0, 1]]}},
    {"box": {"min": [0, 0, 0], "max": [1, 1, 1], "spacing": "uniform"}},
    {"cylinder": {"center": [1, 2, 3], "axis": [1, 0, 2], "radius": [0.5, 2], "height": 3, "angle": [0, 360]}},
    {"cylinder": {"center": [0, 0, 0], "axis": [0, 0, 1], "radius": [0, 1], "height": 1, "angle": [0, 200]}},
)


def shape_of(numbers, rest, moves):
    size = [numbers.randint(3, 5), numbers.randint(7, 9) if "cylinder" in rest else numbers.randint(3, 5), 3]
    lattice = {"format": "ffd-lattice", "version": 1, "size": size, "rest": rest, "weights": steep_weights(numbers, size),
               "degree": [numbers.randint(1, min(3, n - 1)) for n in size], "moves": moves}
    if "spacing" not in rest.get("box", {}) and "box" in rest:
        lattice["knots"] = [numbers.choice(("clamped", "open", "uniform")) for _ in size]
    return lattice


@case
def one_affine_map_of_a_box_or_a_cylinder_needs_no_proof(run):
    numbers = random.Random(SEED)
    for i, rest in enumerate(SHAPES):
        for moves, det in (MOVES if i == 0 else MOVES[i % 2::2]):
            folds = folds_of(run, shape_of(numbers, rest, moves), "--fail-on", "folds")
            equal([folds["verdict"], folds["relative_to"], folds["unknown_cells"]], ["none", "place", 0], (rest, moves))
            near = 1 - folds["min_det"] / det
            check(near == 0 if det == 1 and len(moves) < 2 else -1e-15 <= near < 1e-6, folds, rest, moves)


@case
def given_points_with_weights_are_a_box_where_they_form_one(run):
    numbers = random.Random(SEED)
    for turned in (False, True):
        box = Box(numbers)
        points = [[x + 0.3 * y, y - 0.2 * z, z + 0.1 * x + 7] for x, y, z in box.points] if turned else box.points
        equal(folds_of(run, {**box.file(), "rest": {"points": points}})["relative_to"], "place")
        folded = [[3 * x - 2 * a for a, x in zip(*points[:2])], *points[1:]]  # a corner beyond the next point
        folds = folds_of(run, {**box.file(), "rest": {"points": folded}, "weights": [1.0 + i % 2 for i in range(len(points))]})
        equal([folds["verdict"], folds["relative_to"]], ["some", "mean"])


@case
def what_is_not_one_affine_map_is_proven(run):
    """A mirror folds; a point that leaves the map, and deformed weights, are proven."""
    numbers = random.Random(SEED)
    lattice = shape_of(numbers, SHAPES[0], [{"scale": {"factor": [-1, 1, 1]}}])
    equal(folds_of(run, lattice, "--fail-on", "folds", code=NO)["verdict"], "some")
    lattice.update(moves=[{"rotate": {"axis": "z", "degrees": 20}}, {"at": [1, 1, 1], "by": [1e-6, 0, 0]}])
    equal(folds_of(run, lattice)["relative_to"], "mean")
    for factor in (2, 3, 0.1):  # weights count by their ratios
        lattice.update(moves=[], deformed={"weights": [factor * h for h in lattice["weights"]]})
        equal(folds_of(run, lattice)["relative_to"], "place")
    lattice["deformed"]["weights"][1] *= 1.5
    equal(folds_of(run, lattice)["relative_to"], "mean")


@case
def a_volume_at_rest_that_is_0_is_told(run):
    """The second half of the volume takes back the first: min_det is relative to the bounds of the control points."""
    points = [[x, y, z] for z in (0.0, 2.0) for y in (0.0, 1.0) for x in (0.0, 1.0, 0.0)]
    lattice = {"format": "ffd-lattice", "version": 1, "size": [3, 2, 2], "degree": [1, 1, 1], "rest": {"points": points},
               "deformed": {"points": [[2 * i, y, z] for (_, y, z), i in zip(points, [0, 1, 2] * 4)]}}
    for weights in ({}, {"weights": [1.0, 2.0] * 6}):
        folds = folds_of(run, {**lattice, **weights})
        equal(folds["relative_to"], "bounds", weights)
        if not weights:  # det J is 4 * 2 in the whole domain of size 1; the bounds have a volume of 2
            check(abs(abs(folds["min_det"]) - 4) < 0.05, folds)
    said = run.ffd("check", "m.obj", "-l", "l.json", err=anything).text
    check(" of the bounds of the control points at rest" in said, said)


print(f"FFD_SEED={SEED}", flush=True)
main()
