#!/usr/bin/env python3
"""Random lattices out through every format of `ffd lattice convert` and back: all that the format holds is there, to the bit where it
holds doubles, and a warning names all that it does not hold.

    test_formats.py    the program in FFD; the seed is printed; FFD_SEED repeats a run; FFD_SECONDS makes a longer one"""

import json
import os
import random
import re
import struct
import sys
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "cli"))
from author import deformed_points, offsets_of, rest_points  # noqa: E402
from harness import SANITIZED, UNSUPPORTED, USAGE, case, check, equal, main, near  # noqa: E402

SEED = int(os.environ.get("FFD_SEED") or random.randrange(1 << 30))
RANDOM = random.Random(SEED)
print(f"seed {SEED} (FFD_SEED)")
LATTICES = 4 if SANITIZED else 25
KINDS = {"npy": "an array", "xyz": "Plot3D", "fmt": "Plot3D", "obj": "a cage"}


def random_knots(count, degree):
    """A keyword, or a list that no keyword means."""
    kind = RANDOM.choice(["clamped", "clamped", "open", "uniform", "list", "graded", "repeated", "closed", "closed list"])
    if kind == "list":
        return sorted(RANDOM.uniform(-1, 1) for _ in range(count + degree + 1))
    if kind == "graded":
        ratio, knots = RANDOM.choice([0.02, 0.3, 2, 40]), [RANDOM.uniform(-1, 1)]
        for k in range(count + degree):
            knots.append(knots[-1] + ratio ** min(k, 4))
        return knots
    if kind == "repeated":  # clamped at the ends, of any multiplicity within
        within = sorted(RANDOM.choice([0.1, 0.24, 0.6, 0.7]) for _ in range(count - degree - 1))
        if within and all(within.count(t) <= degree for t in within):
            return [0.0] * (degree + 1) + within + [1.0] * (degree + 1)
        return "clamped"
    if kind.startswith("closed"):
        if count < degree + 2:
            return "open"
        return "closed" if kind == "closed" else {"closed": sorted(RANDOM.uniform(0, 10) for _ in range(count + 1))}
    return kind


def random_rest(size, plain):
    """Control points anywhere, a box that may be turned, or its image in the mirror."""
    if RANDOM.random() < 0.5 or not plain:
        return {"points": [[RANDOM.uniform(-1, 1) * 10 ** RANDOM.randint(-3, 5) for _ in range(3)] for _ in range(size[0] * size[1] * size[2])]}
    low = [RANDOM.uniform(-3, 3) for _ in range(3)]
    return {"box": {"min": low, "max": [x + RANDOM.uniform(0.1, 4) for x in low], **({"spacing": "uniform"} if RANDOM.random() < 0.2 else {})}}


def random_lattice(is_bernstein):
    """is_bernstein: a box that .prm holds."""
    degree = [RANDOM.choice([1, 2, 3, 3, RANDOM.randint(4, 14)]) for _ in range(3)]
    size = [p + 1 if is_bernstein else RANDOM.choice([p + 1, p + 1 + RANDOM.randint(0, 3)]) for p in degree]
    knots = [random_knots(*pair) if RANDOM.random() < 0.7 and not is_bernstein else "clamped" for pair in zip(size, degree)]
    count = size[0] * size[1] * size[2]
    content = {"format": "ffd-lattice", "version": 1, "size": size, "degree": degree, "knots": knots, "moves": [],
               "rest": random_rest(size, all(k == "clamped" for k in knots))}
    if is_bernstein:
        content["rest"] = {"box": {"min": [-1, 0, 2], "max": [1, 3, 2.5]}}
    elif RANDOM.random() < 0.4:
        content["weights"] = [RANDOM.uniform(0.1, 3) for _ in range(count)]
    if RANDOM.random() < 0.8:
        content["deformed"] = {"offsets": [[RANDOM.choice([0.0, RANDOM.uniform(-1, 1), RANDOM.uniform(-1e-9, 1e-9)]) for _ in range(3)] for _ in range(count)]}
        if "weights" in content and RANDOM.random() < 0.5:
            content["deformed"]["weights"] = [RANDOM.uniform(0.1, 3) for _ in range(count)]
    return content


def losses(content):
    """What a format of positions alone does not hold, as the warning names it."""
    lost = [f"{'closed ' if 'closed' in str(knots)[:12] else ''}knots of {letter}" for letter, knots, p, n in
            zip("uvw", content["knots"], content["degree"], content["size"]) if knots != "clamped" or p != min(3, n - 1)]
    return ", ".join(lost + (["weights"] if "weights" in content else []))


def convert(run, source, target, *more, **options):
    run.ffd("lattice", "convert", source, "-o", target, "--force", *more, **options)
    return run.read(target)


def warned(ending, content):
    lost = losses(content)
    if not lost:
        return {"lines": 0}
    return {"err": re.compile(rf"\.{ending}: {KINDS[ending]} holds positions alone, not the {lost}: it is read as clamped uniform, without weights, of degree min\(3, n - 1\)$")}


def bits(points):
    return struct.pack(f"<{3 * len(points)}d", *(x for p in points for x in p))


def rows_of(table):
    """The columns of a table behind its indices, a row each."""
    lines = table.decode().splitlines()
    head = next(i for i, line in enumerate(lines) if line.startswith("i,"))
    return [[float(x) for x in line.split(",")[3:]] for line in lines[head + 1:]]


def check_all(run, table):
    """Through the formats that hold all of a lattice, in a row."""
    order = RANDOM.sample(["csv", "vtk", "vts", "json"], 4)
    source = "a.json"
    for ending in order:
        convert(run, source, f"chain.{ending}")
        source = f"chain.{ending}"
        equal(convert(run, source, "back.csv"), table, order)


def check_parts(run, content, table):
    """One of the states as rest, with its weights."""
    rows = rows_of(table)
    for ending in ("csv", "vtk", "vts", "json"):
        for part, shift in (("rest", 0), ("deformed", 1)):
            convert(run, "a.json", f"part.{ending}", "--part", part)
            made = rows_of(convert(run, f"part.{ending}", "part-back.csv"))
            equal([r[:6] for r in made], [[x + shift * d for x, d in zip(r[:3], r[3:6])] + [0.0] * 3 for r in rows], (ending, part))
            weights = [[r[-1 if shift else 6]] for r in rows] if "weights" in content else [[]] * len(rows)
            equal([r[6:] for r in made], weights, (ending, part))


def check_positions(run, content, table):
    """Through the formats that hold positions of one state, and cages."""
    rows = rows_of(table)
    still = not any(any(r[3:6]) for r in rows) and all(r[6:7] == r[7:8] or len(r) < 8 for r in rows)
    for ending in ("npy", "xyz", "fmt"):
        run.remove(f"p.{ending}")
        if not still:
            run.ffd("lattice", "convert", "a.json", "-o", f"p.{ending}", code=USAGE, err=re.compile("holds one state of a lattice, and this one is deformed: choose"))
            check(not run.exists(f"p.{ending}"))
        for part, shift in (("rest", 0), ("deformed", 1)):
            convert(run, RANDOM.choice(["a.json", "a.csv"]), f"p.{ending}", "--part", part, **warned(ending, content))
            made = json.loads(convert(run, f"p.{ending}", "p.json"))
            equal(bits(rest_points(made)), bits([[x + shift * d for x, d in zip(r[:3], r[3:6])] for r in rows]), (ending, part))
            equal([made["size"], made["degree"], made["knots"], made.get("deformed")], [content["size"], [min(3, n - 1) for n in content["size"]], ["clamped"] * 3, None])
    convert(run, "a.json", "p.obj", **warned("obj", content))
    made = json.loads(convert(run, "p.obj", "p.json"))
    equal(bits(rest_points(made)), bits([r[:3] for r in rows]))
    size = max(1.0, max(abs(x) for r in rows for x in r[:3]))
    near(deformed_points(made), [[x + d for x, d in zip(r[:3], r[3:6])] for r in rows], 2.0**-51 * size)
    check(convert(run, "a.json", "p.glb")[:4] == b"glTF")


def check_prm(run, content):
    """A box of Bernstein polynomials, and nothing else."""
    box, size = content["rest"].get("box"), content["size"]
    holds = box and "spacing" not in box and "weights" not in content and all(k == "clamped" and p == n - 1 for k, p, n in zip(content["knots"], content["degree"], size))
    run.remove("p.prm")
    if not holds:
        run.ffd("lattice", "convert", "a.json", "-o", "p.prm", code=UNSUPPORTED, err=re.compile("a box of Bernstein polynomials alone"))
        check(not run.exists("p.prm"))
        return 0
    convert(run, "a.json", "p.prm")
    made = json.loads(convert(run, "p.prm", "p.json"))
    equal([made["size"], made["degree"], made["knots"]], [size, content["degree"], ["clamped"] * 3])
    near(rest_points(made), rest_points(content), 1e-14)
    near(offsets_of(made), offsets_of(content), 1e-15)
    return 1


@case
def out_and_back(run):
    ends, boxes, made = time.monotonic() + float(os.environ.get("FFD_SECONDS") or 0), 0, 0
    while made < LATTICES or time.monotonic() < ends:
        content = random_lattice(made % 5 == 0)
        run.write("a.json", content)
        table = convert(run, "a.json", "a.csv")
        check_all(run, table)
        check_parts(run, content, table)
        check_positions(run, content, table)
        boxes += check_prm(run, content)
        made += 1
    check(boxes and made, boxes)


main()
