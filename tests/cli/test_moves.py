#!/usr/bin/env python3
"""Moves through the program: every action with weight, falloff and mirror against another evaluation of
data/schema/lattice.md 8, by the formulas as they stand there; exact bends on their circles."""
import json
import math
import random

from harness import INVALID, case, check, equal, lattice, main, near, obj_of, obj_vertices
from messages import anything
from vectors import cross, dot, minus, unit


def plus(a, b, factor=1.0):
    return [x + factor * y for x, y in zip(a, b)]


def named(axis):
    return [float(c == axis) for c in "xyz"] if isinstance(axis, str) else unit([float(x) for x in axis])


# The actions, each a function of the points before it. All parameters are those of the file.


def turned(p, axis, degrees, about):
    a, v = math.radians(degrees), minus(p, about)
    c, s, k = math.cos(a), math.sin(a), dot(axis, v)
    w = cross(axis, v)
    return [about[i] + c * v[i] + s * w[i] + (1 - c) * k * axis[i] for i in range(3)]


def action_of(move, points, rest, chosen):
    """The function (point, its place at rest) -> point of a move's action."""
    kind, = set(move) & {"by", "to", "scale", "rotate", "matrix", "twist", "taper", "bend", "pull"}
    value = move[kind]
    if kind == "by":
        return lambda p, r: plus(p, value)
    if kind == "to":
        return lambda p, r: value
    if kind == "matrix":
        return lambda p, r: [dot(value[4 * i:4 * i + 3], p) + value[4 * i + 3] for i in range(3)]
    if kind == "pull":
        def pulled(p, r):
            x = min(math.dist(r, value["point"]) / value["radius"], 1.0)
            return plus(p, value["by"], (1 - x * x) ** 2)
        return pulled
    about = value.get("about") or [math.fsum(points[i][c] for i in chosen) / len(chosen) for c in range(3)]
    if kind == "scale":
        factor = value["factor"] if isinstance(value["factor"], list) else [value["factor"]] * 3
        return lambda p, r: [b + f * (x - b) for x, b, f in zip(p, about, factor)]
    axis = named(value["axis"])
    if kind == "rotate":
        return lambda p, r: turned(p, axis, value["degrees"], about)
    along = [dot(axis, minus(points[i], about)) for i in chosen]
    low, length = min(along), max(along) - min(along)
    if kind == "twist":
        return lambda p, r: turned(p, axis, value["degrees"] * (dot(axis, minus(p, about)) - low) / length, about)
    if kind == "taper":
        def tapered(p, r):
            s = dot(axis, minus(p, about))
            factor = 1 + (value["factor"] - 1) * (s - low) / length
            foot = plus(about, axis, s)
            return plus(foot, minus(p, foot), factor)
        return tapered
    toward = named(value["toward"])
    toward = unit(plus(toward, axis, -dot(axis, toward)))
    radius = length / math.radians(value["degrees"])

    def bent(p, r):
        s, t = dot(axis, minus(p, about)), dot(toward, minus(p, about))
        new_s = low + (radius - t) * math.sin((s - low) / radius)
        new_t = radius - (radius - t) * math.cos((s - low) / radius)
        return plus(plus(p, axis, new_s - s), toward, new_t - t)
    return bent


def left_of(falloff, r):
    """What the falloff leaves at a place at rest."""
    if not falloff:
        return 1.0
    if "radius" in falloff:
        x = math.dist(r, falloff["center"]) / falloff["radius"]
    else:
        x = (dot(named(falloff["axis"]), r) - falloff["from"]) / (falloff["to"] - falloff["from"])
    x = min(max(x, 0.0), 1.0)
    return 1 - (3 * x ** 2 - 2 * x ** 3)


def reflected(move, axis, middle, about):
    """The move whose parameters are reflected: polar vectors turn round along the axis, axial ones across it."""
    c = "xyz".index(axis)

    def place(p):
        return [2 * middle - x if i == c else x for i, x in enumerate(p)]

    def polar(v):
        return [-x if i == c else x for i, x in enumerate(v)]

    def axial(v):
        return [x if i == c else -x for i, x in enumerate(v)]
    new = dict(move)
    for kind in ("by", "to"):
        if kind in move:
            new[kind] = (polar if kind == "by" else place)(move[kind])
    if "matrix" in move:
        rows = [move["matrix"][4 * i:4 * i + 4] for i in range(4)]
        shift = place([0.0, 0.0, 0.0])
        linear = [[rows[i][j] * (-1 if (i == c) != (j == c) else 1) for j in range(3)] for i in range(3)]
        # M A M: p -> place(L place(p) + t)
        moved = [dot(rows[i][:3], shift) + rows[i][3] for i in range(3)]
        offset = place(moved)
        new["matrix"] = [x for i in range(3) for x in (*linear[i], offset[i])] + [0.0, 0.0, 0.0, 1.0]
    if "pull" in move:
        new["pull"] = {**move["pull"], "point": place(move["pull"]["point"]), "by": polar(move["pull"]["by"])}
    for kind in ("scale", "rotate", "twist", "taper", "bend"):
        if kind in move:
            value = {**move[kind], "about": place(about)}
            if "axis" in value:
                value["axis"] = (axial if kind == "rotate" else polar)(named(value["axis"]))
            if "toward" in value:
                value["toward"] = polar(named(value["toward"]))
            if kind == "twist":
                value["degrees"] = -value["degrees"]
            new[kind] = value
    if "falloff" in move:
        falloff = dict(move["falloff"])
        if "center" in falloff:
            falloff["center"] = place(falloff["center"])
        else:
            k = named(falloff["axis"])
            falloff["axis"] = polar(k)
            # k.(2m e - place) = k.p: the coordinate along the reflected axis is counted from the image of the origin.
            away = 2 * middle * polar(k)[c]
            falloff["from"] += away
            falloff["to"] += away
        new["falloff"] = falloff
    return new


def select(move, rest, size):
    if "within" in move:
        low, high = move["within"]["min"], move["within"]["max"]
        return [i for i, p in enumerate(rest) if all(a <= x <= b for a, x, b in zip(low, p, high))]
    ranges = []
    for at, n in zip(move.get("at", ["all"] * 3), size):
        first, last = (0, n - 1) if at == "all" else at if isinstance(at, list) else (at, at)
        ranges.append((first % n, last % n))
    return [i for i in range(len(rest)) if all(a <= x <= b for (a, b), x in zip(
        ranges, (i % size[0], i // size[0] % size[1], i // size[0] // size[1])))]


def apply(moves, rest, size):
    points = [list(p) for p in rest]

    def act(move, chosen, action):
        for i in chosen:
            w = move.get("weight", 1.0) * left_of(move.get("falloff"), rest[i])
            points[i] = plus(points[i], minus(action(points[i], rest[i]), points[i]), w)
    for move in moves:
        chosen = select(move, rest, size)
        before = [list(p) for p in points]
        act(move, chosen, action_of(move, before, rest, chosen))
        if "mirror" not in move:
            continue
        c = "xyz".index(move["mirror"])
        middle = (min(p[c] for p in rest) + max(p[c] for p in rest)) / 2
        by_place = "pull" in move or "falloff" in move
        images = chosen if by_place else [i for i, p in enumerate(rest) if any(
            math.dist([2 * middle - x if a == c else x for a, x in enumerate(p)], rest[j]) < 1e-9 for j in chosen)]
        centroid = [math.fsum(before[i][a] for i in chosen) / len(chosen) for a in range(3)]
        value = next((move[k] for k in ("scale", "rotate", "twist", "taper", "bend") if k in move), {})
        image = reflected(move, move["mirror"], middle, value.get("about") or centroid)
        # The extent is that of the points that the move selects, as they were: their images'.
        mirrored = [[2 * middle - x if a == c else x for a, x in enumerate(p)] for p in before]
        act(image, images, action_of(image, mirrored, rest, chosen))
    return points


SIZE, LOW, HIGH = (4, 3, 5), [-1.0, -2.0, 0.5], [3.0, 2.0, 2.5]


def grid(size=SIZE, low=tuple(LOW), high=tuple(HIGH)):
    steps = [[a + (b - a) * i / (n - 1) for i in range(n)] for a, b, n in zip(low, high, size)]
    return [[x, y, z] for z in steps[2] for y in steps[1] for x in steps[0]]


def draw_move(draw):
    def vector():
        return [draw.uniform(-1, 1) for _ in range(3)]

    def axis():
        return draw.choice(["x", "y", "z", vector()])

    def about():
        return {"about": plus(vector(), [1, 0, 1.5])} if draw.random() < 0.5 else {}
    kind = draw.choice(["by", "to", "scale", "rotate", "matrix", "twist", "taper", "bend", "pull", "pull"])
    toward = vector()
    move = {"by": lambda: vector(), "to": lambda: vector(),
            "scale": lambda: {"factor": draw.choice([0.5, vector()]), **about()},
            "rotate": lambda: {"axis": axis(), "degrees": draw.uniform(-200, 200), **about()},
            "matrix": lambda: [draw.uniform(-1, 1) for _ in range(12)] + [0, 0, 0, 1],
            "twist": lambda: {"axis": axis(), "degrees": draw.uniform(-200, 200), **about()},
            "taper": lambda: {"axis": axis(), "factor": draw.uniform(-0.5, 2), **about()},
            "bend": lambda: {"axis": draw.choice(["x", [1, 0.2, 0]]), "toward": [toward[0], 1, toward[2]],
                             "degrees": draw.choice([-1, 1]) * draw.uniform(5, 200), **about()},
            "pull": lambda: {"point": plus(vector(), [1, 0, 1.5]), "by": vector(), "radius": draw.uniform(0.5, 4)}}
    move = {kind: move[kind]()}
    if draw.random() < 0.4:
        move["weight"] = draw.random()
    if draw.random() < 0.5:
        start = draw.uniform(-2, 2)
        move["falloff"] = draw.choice([{"axis": axis(), "from": start, "to": start + draw.choice([-1, 1]) * draw.uniform(0.5, 4)},
                                       {"center": plus(vector(), [1, 0, 1.5]), "radius": draw.uniform(0.5, 5)}])
    if draw.random() < 0.6:
        move["mirror"] = draw.choice("xyz")
    which = draw.random()
    if which < 0.3:
        move["at"] = [[-3, -1], "all", [1, -1]]
    elif which < 0.5:
        move["at"] = ["all", [-2, 2], [0, 2]]
    elif which < 0.7:
        move["within"] = {"min": [-1.1, -0.1, 0], "max": [2, 2.1, 3]}
    return move


@case
def moves_are_those_of_another_evaluation(run):
    """Of degree 1 a vertex on a control point goes where that goes."""
    rest = grid()
    run.write("a.obj", obj_of(rest))
    draw = random.Random(11)
    for n in range(60):
        moves = [draw_move(draw) for _ in range(draw.choice([1, 1, 2, 3]))]
        run.write("l.json", lattice(size=SIZE, low=LOW, high=HIGH, degree=[1, 1, 1], moves=moves))
        run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "--force", "--outside", "error", err=anything)
        expected = apply(moves, rest, SIZE)
        size = max(abs(x) for p in expected for x in p)
        for i, (found, right) in enumerate(zip(obj_vertices(run.text("b.obj")), expected)):
            near(found, right, 3e-13 * max(size, 10), f"{n}: vertex {i} by {moves}")


@case
def an_exact_bend_is_on_its_circles(run):
    """Any place of the volume, at whatever angle, lies at the distance |R - t| from the middle of the arc."""
    draw = random.Random(5)
    points = [[draw.uniform(-1, 1), draw.uniform(-1, 1), draw.uniform(0, 4)] for _ in range(2000)]
    # The borders of the arcs, of which the formulas are exact.
    ends = [[x, y, z] for x in (-1.0, 0.25, 1.0) for y in (-1.0, 0.5) for z in (0.0, 1.0, 2.0, 4.0)]
    run.write("a.obj", "".join("v %r %r %r\n" % tuple(p) for p in points + ends))
    for degrees, toward in ((180, "x"), (-90, "x"), (300, "y"), (10, "y"), (-0.5, "x")):
        for about in ([0, 0, 0], [0.3, -0.2, 7]):
            bend = {"axis": "z", "toward": toward, "degrees": degrees, "about": about, "exact": True}
            run.write("l.json", lattice(size=(3, 4, 7), low=[-1, -1, 0], high=[1, 1, 4], degree=[2, 3, 2],
                                        knots=["clamped", "open", [0, 0, 0, 1, 1, 2, 2, 4, 4, 4]], moves=[{"bend": bend}]))
            run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "--force", "--outside", "error", err=anything)
            found = obj_vertices(run.text("b.obj"))
            radius, t = 4 / math.radians(degrees), "xyz".index(toward)
            for p, q in zip(points + ends, found):
                away = math.hypot(q[t] - about[t] - radius, q[2])
                near([away / abs(radius)], [abs(1 - (p[t] - about[t]) / radius)], 1e-14, f"{bend}: {p} at {q}")
                near([q[1 - t]], [p[1 - t]], 1e-15, "the third coordinate")
            for p, q in zip(ends, found[len(points):]):
                angle, r = p[2] / radius, radius - (p[t] - about[t])
                near([q[t] - about[t], q[2]], [radius - r * math.cos(angle), r * math.sin(angle)], 1e-14 * abs(radius) + 1e-14,
                     f"{bend}: the joint {p}")


@case
def an_exact_bend_keeps_an_embedding_of_the_rest(run):
    """Its weights are of the deformed volume alone: u,v,w of the same lattice without moves serve it."""
    run.write("a.obj", "v 0.5 0.5 1\nv -0.5 0.25 3\n")
    shape = {"size": (2, 2, 5), "low": [-1, -1, 0], "high": [1, 1, 4], "degree": [1, 1, 2], "knots": ["clamped", "clamped", [0, 0, 0, 1, 1, 2, 2, 2]]}
    bend = {"axis": "z", "toward": "x", "degrees": {"$": "D"}, "exact": {"$": "E"}}
    run.write("l.json", lattice(moves=[{"bend": bend}], **shape))
    run.ffd("embed", "a.obj", "-l", "l.json", "-o", "e.npy")
    run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "--set", "D=90", "--set", "E=true", "--embedding", "e.npy")
    run.ffd("deform", "a.obj", "c.obj", "-l", "l.json", "--set", "D=90", "--set", "E=true")
    equal(run.text("b.obj"), run.text("c.obj"))
    told = run.ffd("info", "l.json", "--json", "--set", "D=90", "--set", "E=true", data=True).json
    equal((told["weights_moved"], told["rational"], told["moved"]), (True, True, 16), "info")
    told = run.ffd("info", "l.json", "--json", "--set", "D=0", "--set", "E=true", data=True).json
    equal((told["weights_moved"], told["rational"], told["moved"]), (False, False, 0), "info of 0 degrees")


@case
def placeholders_stand_for_any_of_their_values(run):
    run.write("a.obj", "v 0.5 0.5 1\nv -1.5 0.25 0.75\n")
    moves = [{"falloff": {"axis": "x", "from": -2, "to": 2}, "mirror": "y", "pull": {"point": [1, 0, 0], "by": [0, 0.5, 1], "radius": 3}},
             {"falloff": {"center": [0, 0, 0], "radius": 3}, "by": [0, 0, 1]}]
    run.write("l.json", lattice(moves=moves))
    run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", err=anything)
    open_moves = [{"falloff": {"axis": {"$": "K"}, "from": {"$": "F"}, "to": {"$": "T"}}, "mirror": {"$": "M"},
                   "pull": {"point": [{"$": "P"}, 0, 0], "by": {"$": "B"}, "radius": {"$": "R"}}}, {"falloff": {"$": "W"}, "by": [0, 0, 1]}]
    run.write("l.json", lattice(moves=open_moves))
    values = ("K=x", "F=-2", "T=2", "M=y", "P=1", "B=[0, 0.5, 1]", "R=3", 'W={"center": [0, 0, 0], "radius": 3}')
    run.ffd("deform", "a.obj", "c.obj", "-l", "l.json", *(x for value in values for x in ("--set", value)), err=anything)
    equal(run.text("b.obj"), run.text("c.obj"))
    run.ffd("deform", "a.obj", "d.obj", "-l", "l.json", code=INVALID, err=anything)
    bad = [x for value in values for x in ("--set", value.replace("R=3", "R=0"))]
    done = run.ffd("deform", "a.obj", "d.obj", "-l", "l.json", *bad, code=INVALID, err=anything)
    check("radius 0 is not more than 0" in done.err[0], done.err)


@case
def the_lines_of_many_moves_take_linear_time(run):
    """Each was counted from the beginning of the file, which took minutes; the last place that is wrong has its own."""
    count = 60000
    note = {"by": [0, 0, 0], "comment": "x" * 60}
    drag = {"drag": [{"by": [0, 0, 0], "point": [0, 0, 0]} for _ in range(900)]}
    places = json.dumps(drag).replace("}, {", "},\n{").replace("[0, 0, 0]}]", "[5, 0, 0]}]")
    moves = ",\n".join([json.dumps(note)] * count + [places])
    text = json.dumps(lattice(moves=[])).replace('"moves": []', '"moves": [\n' + moves + "]")
    run.write("l.json", text)
    run.write("a.obj", "v 0 0 0\n")
    line = text.count("\n", 0, text.rindex("[5, 0, 0]")) + 1
    equal(line, count + 901 + text.count("\n", 0, text.index("moves")))
    run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", code=INVALID,
            err=f"l.json:{line}: /moves/{count}/drag/899/point: the place 5 0 0 is not inside the volume at rest, but outside")


@case
def what_a_weight_of_nothing_reaches_keeps_its_bits(run):
    """Beyond a pull's radius and a falloff's end nothing changes, nor where mirrored points lie on no image."""
    points = [[-1.9, 0.1, 0.3], [1.7, -0.3, 0.1]]
    text = obj_of(points)
    run.write("a.obj", text)
    for move in ({"pull": {"point": [-2, 0, 0], "by": [0, 0, 1], "radius": 1.5}},
                 {"falloff": {"axis": "x", "from": -2, "to": -1}, "rotate": {"axis": "y", "degrees": 33}},
                 {"falloff": {"center": [-2, 0, 0], "radius": 1.5}, "taper": {"axis": "z", "factor": 0.1}}):
        run.write("l.json", lattice(size=(9, 4, 4), degree=[1, 1, 1], moves=[move]))
        run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "--force", err=anything)
        found = run.text("b.obj").splitlines()
        check(found[1] == text.splitlines()[1] and found[0] != text.splitlines()[0], f"{move}: {found}")


main()
