#!/usr/bin/env python3
"""The figures of data/tutorial.md and data/README.md are what the program computes, and so is what they say of the sample lattices.

    test_figures.py FFD SOURCE
"""
import ast
import json
import math
import os
import re
import struct
import subprocess
import sys
import tempfile

from test_readme import pages

TWIST = {"twist": {"axis": "y", "degrees": 90}}
SAMPLES = 1001
STEPS = ("0.001", "0.000001")


class Place:
    """A folder with the program."""

    def __init__(self, ffd, source, folder):
        self.ffd, self.source, self.folder = os.path.abspath(ffd), os.path.abspath(source), folder
        self.pages = pages(source)

    def path(self, name):
        return os.path.join(self.folder, name)

    def model(self, name):
        return os.path.join(self.source, "data/models", name)

    def write(self, name, text):
        with open(self.path(name), "w", encoding="utf-8") as file:
            file.write(text)

    def lattice(self, name, **members):
        self.write(name, json.dumps({"format": "ffd-lattice", "version": 1, **members}))

    def run(self, *words):
        done = subprocess.run([self.ffd, *words], cwd=self.folder, text=True, check=False,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        if done.returncode != 0:
            sys.exit(f"{words} ended with {done.returncode}:\n{done.stdout}")

    def points(self, name):
        with open(self.path(name), encoding="utf-8") as file:
            return [tuple(map(float, line.split()[1:4])) for line in file if line.startswith("v ")]

    def stated(self, pattern):
        """The numbers that the pages have where the pattern is."""
        match = re.search(pattern, self.pages)
        if not match:
            sys.exit(f"the pages have no {pattern}")
        return match.groups()


def near(found, stated, what):
    """Whether a figure is the stated one, to the digits that are stated."""
    mantissa, _, exponent = stated.partition("e")
    digits = len(mantissa.partition(".")[2]) - int(exponent or 0)
    if not abs(found - float(stated)) <= 0.51 * 10.0 ** -digits:
        sys.exit(f"{what}: the page says {stated}, found is {found!r}")


def turn_of_the_column(place):
    rest = place.points(place.model("column.obj"))
    low, high = min(p[1] for p in rest), max(p[1] for p in rest)
    turns = []
    for margin in (0.05, 0):
        place.lattice("twist.json", size=[4, 6, 4], rest={"box": "mesh", "margin": margin}, moves=[TWIST])
        place.run("deform", place.model("column.obj"), "turned.obj", "-l", "twist.json", "--force")
        ends = []
        for end in (low, high):
            angles = [math.atan2(p[0], p[2]) - math.atan2(q[0], q[2])
                      for q, p in zip(rest, place.points("turned.obj")) if q[1] == end and math.hypot(q[0], q[2]) > 0.1]
            ends.append(math.degrees(math.atan2(sum(map(math.sin, angles)), sum(map(math.cos, angles)))))
        turns.append((ends[1] - ends[0]) % 360)
    stated = place.stated(r"turns by ([\d.]+) degrees between its foot and its top\. With `\"margin\": 0` it turns by ([\d.]+)")
    for found, number in zip(turns, stated):
        near(found, number, "the turn of the column")


def exact_corners(place):
    length = 2.0
    place.write("line.obj", "".join(f"v 0 {length * i / (SAMPLES - 1)!r} 0\n" for i in range(SAMPLES)))
    radius = length / (math.pi / 2)
    rows = re.findall(r"^\| (\d), degree (\d)(, exact)? \| ([\de.-]+) \|$", place.pages, re.M)
    if len(rows) != 3:
        sys.exit(f"the pages have {len(rows)} rows of exact corners")
    for row in rows:
        layers, degree, exact, stated = int(row[0]), int(row[1]), bool(row[2]), row[3]
        knots = [0, 0, 0, 1, 1, 2, 2, 2] if exact else "clamped"
        place.lattice("bend.json", size=[4, layers, 4], degree=[3, degree, 3], knots=["clamped", knots, "clamped"],
                      rest={"box": {"min": [-0.5, 0, -0.5], "max": [0.5, length, 0.5]}},
                      moves=[{"bend": {"axis": "y", "toward": "x", "degrees": 90, **({"exact": True} if exact else {})}}])
        place.run("deform", "line.obj", "bent.obj", "-l", "bend.json", "--force")
        found = max(abs(math.hypot(x - radius, y) - radius) for x, y, _ in place.points("bent.obj")) / radius
        if exact and found > 1e-15:
            sys.exit(f"an exact corner: {found}")
        if not exact:
            near(found, stated, f"{layers} layers of degree {degree}")


def outer_layers(place):
    """With k layers at rest the displacement begins as the k-th power of the distance from the border."""
    steps = [2.0 ** -12, 2.0 ** -11]
    place.write("row.obj", "".join(f"v {x!r} 0.5 0.5\n" for x in (0.0, *steps)))
    for layers in range(4):
        place.lattice("layers.json", size=[12, 4, 4], rest={"box": {"min": [0, 0, 0], "max": [1, 1, 1]}},
                      moves=[{"at": [[layers, 11], "all", "all"], "by": [0, 0, 1]}])
        place.run("deform", "row.obj", "moved.obj", "-l", "layers.json", "--force")
        border, first, second = (p[2] - 0.5 for p in place.points("moved.obj"))
        if (border != 0) != (layers == 0) or abs(second / first / 2 ** layers - 1) > 0.02:
            sys.exit(f"{layers} layers at rest: displacements {border}, {first}, {second}")


def falloff_that_folds(place):
    """det F of a vertex in the middle of the falloff, where the border moves outward."""
    top, bottom = map(float, place.stated(r"outward by more than half of R \((\d+)/(\d+)\)"))
    place.write("beyond.obj", "v 1.5 0.5 0.5\nv 0.5 0.5 0.5\n")
    for factor, folds in ((0.99, False), (1.01, True)):
        place.lattice("out.json", size=[4, 4, 4], rest={"box": {"min": [0, 0, 0], "max": [1, 1, 1]}},
                      moves=[{"by": [factor * top / bottom, 0, 0]}])
        place.run("check", "beyond.obj", "-l", "out.json", "--outside", "extend", "--falloff", "1", "--report", "r.json")
        with open(place.path("r.json"), encoding="utf-8") as file:
            least = json.load(file)["jobs"][0]["det"]["outside"]
        if (least <= 0) != folds:
            sys.exit(f"det F outside is {least} where the border moves by {factor} of {top}/{bottom} of R")


def corners_of_stl(path):
    with open(path, "rb") as file:
        data = file.read()
    (count,) = struct.unpack_from("<I", data, 80)
    for facet in range(count):
        numbers = struct.unpack_from("<12f", data, 84 + 50 * facet)
        yield from (numbers[3:6], numbers[6:9], numbers[9:12])


def dense(path):
    """The shape and the numbers of an array of doubles."""
    with open(path, "rb") as file:
        data = file.read()
    (size,) = struct.unpack_from("<H", data, 8)
    shape = ast.literal_eval(data[10:10 + size].decode("latin-1"))["shape"]
    return shape, struct.unpack_from(f"<{math.prod(shape)}d", data, 10 + size)


def float32(point):
    return struct.unpack("<3f", struct.pack("<3f", *point))


def errors_of_differences(place):
    """The table of derivatives: doubles of an OBJ, and floats of an STL."""
    sweep = re.search(r"```json sweep\.json\n(.*?)```", place.pages, re.S)[1]
    place.write("sweep.json", sweep)
    column = place.model("column.obj")

    def words(degrees):
        return ["-l", "sweep.json", "--set", "HEIGHT=1", "--set", "GIRTH=1", "--set", f"DEGREES={degrees}", "--force"]

    place.run("jacobian", column, *words("30"), "--wrt", "parameters", "-o", "J.npy")
    with open(place.path("J.columns.txt"), encoding="utf-8") as file:
        column_number = [line.strip() for line in file].index("DEGREES")
    (vertices, _, names), numbers = dense(place.path("J.npy"))
    exact = [numbers[names * row + column_number] for row in range(3 * vertices)]
    largest = max(map(abs, exact))

    def results(degrees, name):
        for ending in ("obj", "stl"):
            place.run("deform", column, f"{name}.{ending}", *words(degrees))
        return place.points(f"{name}.obj"), list(corners_of_stl(place.path(f"{name}.stl")))

    points, corners = results("30", "a")
    numbers_of = {float32(point): number for number, point in enumerate(points)}
    for step in STEPS:
        moved, moved_corners = results(repr(30 + float(step)), "b")
        taken = (30 + float(step)) - 30
        of_obj = max(abs((q - p) / taken - exact[3 * v + a]) for v in range(vertices)
                     for a, (p, q) in enumerate(zip(points[v], moved[v]))) / largest
        of_stl = max(abs((q - p) / taken - exact[3 * numbers_of[corner] + a]) for corner, other in zip(corners, moved_corners)
                     for a, (p, q) in enumerate(zip(corner, other))) / largest
        stated = place.stated(rf"\| {re.escape(step)} \| ([\d.e-]+) \| ([\d.]+)")
        near(of_obj, stated[0], f"the derivative of an OBJ by a step of {step}")
        near(of_stl, stated[1], f"the derivative of an STL by a step of {step}")


def sample_lattice(place, name):
    with open(os.path.join(place.source, "data/lattices", name), encoding="utf-8") as file:
        return json.load(file)


def moved_vase(place, lattice):
    """The vase at rest and deformed, its lowest and its highest vertices at rest."""
    place.write("of-vase.json", json.dumps(lattice))
    place.run("deform", place.model("vase.obj"), "moved-vase.obj", "-l", "of-vase.json", "--force")
    rest = place.points(place.model("vase.obj"))
    heights = [p[1] for p in rest]
    ends = [[i for i, height in enumerate(heights) if height == end] for end in (min(heights), max(heights))]
    return rest, place.points("moved-vase.obj"), ends


def sample_lattices_on_a_vase(place):
    """What data/README.md says of the foot and of the top."""
    with open(os.path.join(place.source, "data/README.md"), encoding="utf-8") as file:
        place.pages = file.read()
    rest, moved, (foot, _) = moved_vase(place, sample_lattice(place, "taller.json"))
    if any(rest[i] != moved[i] for i in foot):
        sys.exit("taller.json moves the foot")
    height = [max(p[1] for p in points) - min(p[1] for p in points) for points in (rest, moved)]
    near(height[1] / height[0], place.stated(r"makes it ([\d.]+) times as tall; the foot stays")[0], "the height of taller.json")
    for tall in (0.8, 1.3):
        sweep = re.search(r"```json sweep\.json\n(.*?)```", pages(place.source), re.S)[1]
        for name, value in (("GIRTH", 1), ("HEIGHT", tall), ("DEGREES", 0)):
            sweep = sweep.replace('{"$": "%s"}' % name, str(value))
        rest, moved, (foot, _) = moved_vase(place, json.loads(sweep))
        if any(rest[i] != moved[i] for i in foot):
            sys.exit(f"sweep.json moves the foot of a variant of height {tall}")

    rest, moved, ends = moved_vase(place, sample_lattice(place, "wind.json"))
    foot, top = (max(math.dist(rest[i], moved[i]) for i in end) for end in ends)
    near(foot / top, place.stated(r"the top moves by a (\d+)th of what the foot does")[0], "the top of wind.json")

    rest, moved, ends = moved_vase(place, sample_lattice(place, "twist.json"))
    turns = [math.degrees(math.atan2(moved[end[0]][0], moved[end[0]][2]) - math.atan2(rest[end[0]][0], rest[end[0]][2]))
             for end in ends]
    near((turns[1] - turns[0]) % 360, place.stated(r"top against its foot by (\d+) of the 120 degrees")[0], "the turn of twist.json")

    rest, moved, ends = moved_vase(place, sample_lattice(place, "taper.json"))
    foot, top = (100 * math.hypot(moved[i][0], moved[i][2]) / math.hypot(rest[i][0], rest[i][2]) for i in (end[0] for end in ends))
    stated = place.stated(r"narrows its top to (\d+) percent and its foot to (\d+)")
    near(top, stated[0], "the top of taper.json")
    near(foot, stated[1], "the foot of taper.json")


def turned(value, key=None, fractions=False):
    """A lattice for y up as data/README.md says to turn it: z is up, and -y the front."""
    if isinstance(value, dict):
        fractions = fractions or value.get("units") == "box"
        result = {key: turned(member, key, fractions) for key, member in value.items()}
        if "min" in result:
            result["min"][1], result["max"][1] = result["max"][1], result["min"][1]
        return result
    if key == "moves":
        return [turned(move, None, fractions) for move in value]
    if key in ("axis", "toward") and isinstance(value, str):
        return {"x": "x", "y": "z", "z": [0, -1, 0]}[value]
    if key == "mirror":
        return {"x": "x", "y": "z", "z": "y"}[value]
    if not isinstance(value, list):
        return value
    if key == "at":
        def other_end(layers):
            return layers if layers == "all" else [-1 - layers[1], -1 - layers[0]] if isinstance(layers, list) else -1 - layers
        return [value[0], other_end(value[2]), value[1]]
    if key in ("size", "degree", "knots", "margin", "factor"):
        return [value[0], value[2], value[1]]
    if key in ("about", "point", "center", "min", "max", "to") and fractions:
        return [value[0], 1 - value[2], value[1]]
    if key in ("by", "to", "toward", "point", "center", "about", "axis", "min", "max"):
        return [value[0], -value[2], value[1]]
    sys.exit(f"no rule for {key}")


# Each kind of member that the rule names; the sample lattices have no layers along z.
ALL_MEMBERS = {"format": "ffd-lattice", "version": 1, "size": [4, 6, 5], "degree": [3, 2, 3], "knots": ["clamped", "open", "clamped"],
               "rest": {"box": "mesh", "margin": [0.05, 0.1, 0.2]},
               "moves": [{"at": [[1, 2], [0, 3], [0, 1]], "by": [0.01, 0.02, 0.05]},
                         {"at": ["all", "all", 4], "scale": {"factor": [1.1, 1.2, 1.3], "about": [0.1, 0.2, 0.3]}},
                         {"mirror": "z", "pull": {"point": [0.1, 0.2, 0.4], "by": [0.02, 0.1, 0.1], "radius": 0.8}},
                         {"falloff": {"center": [0, 0.3, 0.5], "radius": 1.0}, "rotate": {"axis": "z", "degrees": 20}},
                         {"falloff": {"axis": "y", "from": 1, "to": -0.5}, "twist": {"axis": [0.1, 1, 0.3], "degrees": 30}},
                         {"bend": {"axis": "x", "toward": "z", "degrees": 25}}]}


def lattices_turned_for_z_up(place):
    """A turned lattice does to the turned mesh what the lattice does to the mesh."""
    def turn(points):
        return [(x, -z, y) for x, y, z in points]

    def write(name, points):
        place.write(name, "".join("v %r %r %r\n" % point for point in points))

    names = [name for name in sorted(os.listdir(os.path.join(place.source, "data/lattices"))) if name.endswith(".json")]
    # A cylinder, a matrix and offsets are turned by hand.
    lattices = {name: sample_lattice(place, name) for name in names if name not in ("bend-cylinder.json", "overlap.json", "snout.json", "wing.json", "wing-folds.json")}
    lattices["all-members.json"] = ALL_MEMBERS
    lattices["box.json"] = {**ALL_MEMBERS, "units": "box"}
    rest = place.points(place.model("spot.obj"))
    tall = [(x, 2 + y, z) for x, y, z in rest]
    for name, lattice in lattices.items():
        # A cow that stands in the box of a knight's head too.
        points = tall if name == "big-head.json" else rest
        write("up-y.obj", points)
        write("up-z.obj", turn(points))
        place.write("up-y.json", json.dumps(lattice))
        place.write("up-z.json", json.dumps(turned(lattice)))
        for up in ("y", "z"):
            place.run("deform", f"up-{up}.obj", f"out-{up}.obj", "-l", f"up-{up}.json", "--force")
        expected, found = turn(place.points("out-y.obj")), place.points("out-z.obj")
        worst = max(math.dist(p, q) for p, q in zip(expected, found))
        if place.points("out-y.obj") == points or worst > 1e-12:
            sys.exit(f"{name}: turned for z up it moves a vertex {worst} away from where it belongs")


def residual(place, *words):
    """The largest of a fit."""
    place.run("fit", *words, "-o", "found.json", "--report", "fit.json", "--force")
    with open(place.path("fit.json"), encoding="utf-8") as file:
        return json.load(file)["jobs"][0]["fit"]["residual"]["max"]


def residuals_of_fits(place):
    """Those that the recipes of fits have besides the lines that the program prints."""
    data = os.path.join(place.source, "data")
    subprocess.run([sys.executable, os.path.join(data, "make_refitter.py")], cwd=place.folder, check=True)
    lattice, spot = {name: os.path.join(data, "lattices", f"{name}.json") for name in ("lean", "bulge")}, place.model("spot.obj")
    place.run("lattice", "set", lattice["lean"], "-o", "stoop.json", "--mesh", "refit/body.glb", "--strength", "0.35")
    place.run("deform", "refit/body.glb", "other.glb", "-l", "stoop.json", "-l", lattice["bulge"])
    covers = ("--cover", "refit/clothes/tunic.glb", "--cover", "refit/clothes/hat.glb")
    least, cloth, large = place.stated(r"comes within ([\d.]+) mm of the other one, and the tunic is made (\d+) mm off it\. "
                                       r"With 6,6,6 control points the largest residual is ([\d.]+) mm")
    for size, stated in (("12,12,12", least), ("6,6,6", large)):
        near(1000 * residual(place, "refit/body.glb", "other.glb", *covers, "--size", size), stated, f"a body by {size}")
    with open(os.path.join(data, "make_refitter.py"), encoding="utf-8") as file:
        near(1000 * float(re.search(r'"tunic", .*?\(0\.62, 1\.43, 36, ([\d.]+)', file.read())[1]), cloth, "the tunic")
    place.write("ears.json", re.search(r"```json ears\.json\n(.*?)```", place.pages, re.S)[1])
    place.run("deform", spot, "posed.obj", "-l", "ears.json", "-l", lattice["lean"])
    stated = place.stated(r"With the default size, 6,6,6, the largest residual is ([\d.]+), with 16,16,16 ([\d.]*\d)")
    for size, number in zip(("6,6,6", "16,16,16"), stated):
        near(residual(place, spot, "posed.obj", "--size", size), number, f"a cow by {size}")


def aligned_scan(place):
    """How far the whole scan is from the model, whose vertices it has."""
    for language, name in (("json", "scan.json"), ("csv", "landmarks.csv")):
        place.write(name, re.search(rf"```{language} {re.escape(name)}\n(.*?)```", place.pages, re.S)[1])
    spot = place.model("spot.obj")
    place.run("deform", spot, "scan.obj", "-l", "scan.json")
    landmarks = ("--pairs", "landmarks.csv", "--cover", "scan.obj", "--size")

    def off(size):
        largest = residual(place, *landmarks, size)
        place.run("deform", "scan.obj", "aligned.obj", "-l", "found.json", "--force")
        distances = [math.dist(p, q) for p, q in zip(place.points(spot), place.points("aligned.obj"))]
        return largest, math.sqrt(sum(x * x for x in distances) / len(distances)), max(distances)

    mean, most = place.stated(r"which are known here, are ([\d.]+) off \(rms\) and ([\d.]+) at most")
    coarse, fine = off("4,4,4"), off("8,8,8")
    near(coarse[1], mean, "the scan, rms")
    near(coarse[2], most, "the scan, at most")
    near(fine[0], place.stated(r"8,8,8, bring the landmarks to ([\d.]+), and the scan no nearer")[0], "the landmarks")
    if fine[1] < 0.9 * coarse[1] or fine[2] < coarse[2]:
        sys.exit(f"more control points bring the scan nearer: {coarse}, {fine}")


def main():
    checks = (turn_of_the_column, exact_corners, outer_layers, falloff_that_folds, errors_of_differences, sample_lattices_on_a_vase,
              lattices_turned_for_z_up, residuals_of_fits, aligned_scan)
    for check in checks:
        with tempfile.TemporaryDirectory(prefix="ffd-test-") as folder:
            check(Place(*sys.argv[1:], folder))
    print(f"{len(checks)} groups of figures are what is computed")


if __name__ == "__main__":
    main()
