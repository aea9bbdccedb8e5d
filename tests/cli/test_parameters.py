#!/usr/bin/env python3
"""Parameters of a lattice file: defaults, bounds, factors of placeholders; and deformed control points as offsets."""
import json

from harness import CUBE, INVALID, case, check, equal, lattice, main, near

WIDE = lattice(size=(2, 2, 2), degree=[1, 1, 1], rest={"box": {"min": [0, 0, 0], "max": [1, 1, 1]}})
POINT = "v 1 1 1\n"


def moved_point(run, content, *options):
    """Where the corner 1 1 1 goes."""
    run.write("p.obj", POINT)
    run.write("l.json", content)
    done = run.ffd("deform", "p.obj", "-", "--output-format", "obj", "-l", "l.json", *options)
    return [float(word) for word in done.text.split()[1:4]]


def with_moves(parameters, *moves):
    return {**WIDE, "parameters": parameters, "moves": list(moves)}


@case
def defaults_stand_where_nothing_is_set(run):
    content = with_moves({"A": {"default": 0.5}, "V": {"default": [0, 2, 0]}}, {"by": [{"$": "A"}, 0, 0]}, {"by": {"$": "V"}})
    equal(moved_point(run, content), [1.5, 3, 1], "by default")
    equal(moved_point(run, content, "--set", "A=1"), [2, 3, 1], "A set")
    equal(moved_point(run, content, "--set", "V=[0, 0, 4]", "--set", "A=0"), [1, 1, 5], "both set")


@case
def a_minus_and_a_factor_multiply(run):
    content = with_moves({}, {"by": [{"$": "-A"}, {"$": "A", "times": 3}, {"$": "-A", "times": -0.25, "comment": "up"}]})
    equal(moved_point(run, content, "--set", "A=0.5"), [0.5, 2.5, 1.125], "a number")
    content = with_moves({}, {"by": {"$": "V", "times": 2}}, {"by": {"$": "-V"}})
    equal(moved_point(run, content, "--set", "V=[1, 2, 3]"), [2, 3, 4], "a vector")


@case
def only_numbers_multiply(run):
    for value in ('"x"', "x", '[1, "x", 0]', "true", "1e308"):
        run.write("l.json", with_moves({}, {"by": {"$": "V", "times": 10}}))
        run.write("p.obj", POINT)
        done = run.ffd("check", "p.obj", "-l", "l.json", "--set", f"V={value}", code=INVALID)
        check("/moves/0/by" in done.err[0] and '"V"' in done.err[0] and "multiplied" in done.err[0], done.err)


@case
def values_outside_the_bounds_are_refused(run):
    run.write("p.obj", POINT)
    run.write("l.json", with_moves({"A": {"default": 0, "min": -1, "max": 45, "unit": "degrees"}},
                                   {"twist": {"axis": "z", "degrees": {"$": "A"}}}))
    for value in ("-1", "45"):
        run.ffd("check", "p.obj", "-l", "l.json", "--set", f"A={value}")
    for value, word in (("-1.5", "min"), ("46", "max")):
        done = run.ffd("check", "p.obj", "-l", "l.json", "--set", f"A={value}", code=INVALID)
        check(value in done.err[0] and word in done.err[0] and "degrees" in done.err[0], done.err)


@case
def a_batch_names_the_job_of_such_a_value(run):
    run.write("p.obj", POINT)
    run.write("l.json", with_moves({"A": {"default": 0, "max": 45}}, {"twist": {"axis": "z", "degrees": {"$": "A"}}}))
    jobs = [{"in": "p.obj", "lattice": "l.json", "out": f"o{number}.obj", "set": {"A": value}} for number, value in enumerate((30, 50))]
    run.write("jobs.jsonl", "".join(json.dumps(job) + "\n" for job in jobs))
    done = run.ffd("batch", "jobs.jsonl", code=1, lines=2)
    check(any("jobs.jsonl:2" in line and "50" in line and "45" in line for line in done.err), done.err)
    check(run.exists("o0.obj") and not run.exists("o1.obj"), "outputs")


@case
def info_lists_them(run):
    parameters = {"A": {"default": 30, "min": -90, "max": 90, "unit": "degrees", "comment": "of the twist"}, "B \"q\"": {}}
    run.write("l.json", with_moves(parameters, {"twist": {"axis": "z", "degrees": {"$": "A"}}}, {"weight": {"$": "C"}, "by": [0, 0, 0]}))
    told = run.ffd("info", "--json", "l.json").json
    equal(told["parameters"], parameters, "parameters")
    equal(told["open_placeholders"], ["C"], "open ones")
    text = run.ffd("info", "l.json").text
    check("degrees" in text and "of the twist" in text, text)


@case
def offsets_are_used_as_they_are(run):
    """Far from the origin a rest point plus its offset has lost most digits of the offset."""
    far = 1e6
    rest = {"box": {"min": [far + 0.1, 0.1, 0.1], "max": [far + 1.1, 1.1, 1.1]}}
    offsets = [[0, 0, 0] if i % 2 == 0 else [1e-9, 0.1, 0] for i in range(8)]
    run.write("l.json", {**WIDE, "rest": rest, "deformed": {"offsets": offsets}})
    run.write("p.obj", "".join(f"v {far + 0.1} {y} {z}\n" for y in (0.1, 0.3, 1.1) for z in (0.1, 0.7)) + f"v {far + 1.1} 0.1 0.1\n")
    out = run.ffd("deform", "p.obj", "-", "--output-format", "obj", "-l", "l.json").text.splitlines()
    equal(out[:6], run.text("p.obj").splitlines()[:6], "what stands on points of offset 0")
    told = run.ffd("info", "--json", "l.json").json
    equal(told["moved"], 4, "moved")
    near([told["largest_move"]], [0.1], 1e-15, "the largest move")


@case
def offsets_go_with_a_box_round_the_mesh_and_with_moves(run):
    run.write("a.obj", CUBE)
    offsets = [[0.5, 0, 0] for _ in range(8)]
    base = {**WIDE, "rest": {"box": "mesh", "margin": 0.1}}
    run.write("o.json", {**base, "deformed": {"offsets": offsets}, "moves": [{"by": [0.5, 0.25, 0]}]})
    run.write("m.json", {**base, "moves": [{"by": [0.5, 0, 0]}, {"by": [0.5, 0.25, 0]}]})
    run.ffd("deform", "a.obj", "o.obj", "-l", "o.json")
    run.ffd("deform", "a.obj", "m.obj", "-l", "m.json")
    equal(run.read("o.obj"), run.read("m.obj"), "offsets beside moves")


@case
def points_and_offsets_together_are_refused(run):
    run.write("p.obj", POINT)
    run.write("l.json", {**WIDE, "deformed": {"points": [[0, 0, 0]] * 8, "offsets": [[0, 0, 0]] * 8}})
    done = run.ffd("check", "p.obj", "-l", "l.json", code=INVALID)
    check("/deformed" in done.err[0] and "points" in done.err[0] and "offsets" in done.err[0], done.err)


if __name__ == "__main__":
    main()
