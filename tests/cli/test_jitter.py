#!/usr/bin/env python3
"""The move jitter: seeded noise, beside SplitMix64 in whole numbers of Python. authoring/jitter-all.json holds right answers."""

import json
import re

from author import offsets_of, reference_cases
from harness import CUBE, INVALID, case, check, equal, lattice, main, near

MASK = (1 << 64) - 1
GAMMA = 0x9E3779B97F4A7C15


def mix(z):
    z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9 & MASK
    z = (z ^ z >> 27) * 0x94D049BB133111EB & MASK
    return z ^ z >> 31


def noise(seed, point, axis):
    z = mix(mix(seed + GAMMA & MASK) + (3 * point + axis + 1) * GAMMA & MASK)
    return (z >> 11) * 2.0 ** -52 - 1


def moved(run, moves, *options, **members):
    """The offsets of a lattice of 4^3 points with these moves."""
    run.write("l.json", lattice(moves=moves, **members))
    run.ffd("lattice", "set", "l.json", "--strength", "1", "-o", "o.json", "--force", *options)
    return offsets_of(json.loads(run.text("o.json")))


@case
def the_reference_case(run):
    for name, of in reference_cases("jitter"):
        run.write("l.json", of["lattice"])
        run.ffd("lattice", "set", "l.json", "--strength", "1", "-o", "o.json")
        equal(offsets_of(json.loads(run.text("o.json"))), of["expect"]["offsets"], name)


@case
def the_bits_of_each_point(run):
    sigma = [0.5, 0, 0.3]
    for seed in (0, 1, 2**53 - 1):
        equal(moved(run, [{"jitter": {"sigma": sigma, "seed": seed}}]),
              [[s * noise(seed, i, a) for a, s in enumerate(sigma)] for i in range(64)], seed)
    equal(moved(run, [{"jitter": {"sigma": 0.25, "seed": 3}}]), [[0.25 * noise(3, i, a) for a in range(3)] for i in range(64)])
    # Added to what the moves before do; a part of the points; a weight.
    found = moved(run, [{"by": [1, 0, 0]}, {"at": [1, "all", "all"], "weight": 0.5, "jitter": {"sigma": 1, "seed": 9}}])
    for i, offset in enumerate(found):
        near(offset, [(a == 0) + (0.5 * noise(9, i, a) if i % 4 == 1 else 0) for a in range(3)], 1e-15)
    # Fractions of the sides, which are 4 long.
    near(moved(run, [{"jitter": {"sigma": 0.25, "seed": 3}}], units="box"), [[noise(3, i, a) for a in range(3)] for i in range(64)], 1e-15)


@case
def a_table_of_seeds_makes_variants(run):
    run.write("a.obj", CUBE)
    run.write("l.json", lattice(moves=[{"jitter": {"sigma": {"$": "SIGMA"}, "seed": {"$": "SEED"}}}]))
    run.write("t.csv", "out,SEED,SIGMA\n" + "".join(f"o{i}.obj,{i // 2},0.1\n" for i in range(6)))
    run.ffd("batch", "--csv", "t.csv", "--in", "a.obj", "-l", "l.json", lines=1, err=lambda lines: True)
    files = [run.read(f"o{i}.obj") for i in range(6)]
    check(files[0] == files[1] and files[2] == files[3] and len(set(files)) == 3, "one file for each seed")


@case
def derivatives_by_sigma(run):
    run.write("a.obj", CUBE)
    run.write("l.json", lattice(moves=[{"jitter": {"sigma": {"$": "S"}, "seed": {"$": "N"}}}]))
    run.ffd("jacobian", "a.obj", "-l", "l.json", "--set", "S=[0.1, 0.2, 0.3]", "--set", "N=4", "--wrt", "parameters", "--check", "-o", "j.npy",
            code=INVALID, lines=1, err=re.compile('there is no derivative by "N": here it is the seed of a jitter'))
    run.write("l.json", lattice(moves=[{"weight": 0.7, "jitter": {"sigma": {"$": "S"}, "seed": 4}}], units="box"))
    run.ffd("jacobian", "a.obj", "-l", "l.json", "--set", "S=[0.1, 0.2, 0.3]", "--wrt", "parameters", "--check", "-o", "j.npy", data=True)


@case
def what_cannot_be_is_refused(run):
    run.write("a.obj", CUBE)
    for move, what in (({"sigma": 1}, '"seed" is missing'), ({"seed": 1}, '"sigma" is missing'), ({"sigma": -1, "seed": 1}, "sigma -1 is less than 0"),
                       ({"sigma": 1, "seed": 0.5}, "seed 0.5 is not a whole number"), ({"sigma": 1, "seed": -1}, "seed -1 is not"),
                       ({"sigma": 1, "seed": 2**53}, "seed 9007199254740992 is not"), (0.5, 'write {"jitter": {"sigma": 0.5, "seed": 1}}'),
                       ({"sigma": 1, "seed": 1, "about": [0, 0, 0]}, 'unknown key "about"')):
        run.write("l.json", lattice(moves=[{"jitter": move}]))
        run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", code=INVALID, lines=1, err=re.compile(re.escape(what)))
    run.write("l.json", lattice(moves=[{"mirror": "x", "jitter": {"sigma": 1, "seed": 1}}]))
    run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", code=INVALID, lines=1, err=re.compile("noise has no mirror image: .*--symmetrize"))


main()
