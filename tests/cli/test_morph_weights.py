#!/usr/bin/env python3
"""Default morph weights, of meshes and nodes: what a viewer shows is what boxes go round, what conversions write and
what gates judge. And --as-morph with a name that is there."""
import json

from gltf_build import SHIFT, Scene
from gltf_reader import Gltf
from harness import NO, case, check, equal, float32, glb_split, gltf_vectors, lattice, main, near, npy, obj_vertices
from messages import anything, entry, lines_with

TRIANGLE = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]]


def scene(offsets, weights=None, node_weights=None, nodes=None, names=None):
    """A triangle with a morph target for each offset, which moves all of it."""
    made = Scene(nodes=nodes or [{"mesh": 0, **({"weights": node_weights} if node_weights else {})}], scene=0)
    made.asset["scenes"] = [{"nodes": list(range(len(made.asset["nodes"])))}]
    primitive = {"attributes": {"POSITION": made.add(TRIANGLE, bounds=True)},
                 "targets": [{"POSITION": made.add([offset] * 3, bounds=True)} for offset in offsets]}
    made.asset["meshes"] = [{"primitives": [primitive], **({"weights": weights} if weights else {}),
                             **({"extras": {"targetNames": names}} if names else {})}]
    return made


def box_round(run, made):
    run.write("a.glb", made.glb())
    run.ffd("lattice", "new", "a.glb", "-o", "n.json", "--margin", "0", "--force", err=anything)
    box = json.loads(run.read("n.json"))["rest"]["box"]
    return [box["min"], box["max"]]


def bounds(run, made):
    run.write("a.glb", made.glb())
    box = run.ffd("info", "a.glb", "--json", err=anything).json["bounds"]
    return [box["min"], box["max"]]


def shown(run, made, **options):
    """The vertices of the OBJ that a shift by 1 along x gives."""
    run.write("a.glb", made.glb())
    run.write("l.json", SHIFT)
    run.ffd("deform", "a.glb", "a.obj", "-l", "l.json", "--force", err=anything, **options)
    return obj_vertices(run.text("a.obj"))


def moved(by):
    return [[p[a] + by[a] + (a == 0) for a in range(3)] for p in TRIANGLE]


TWO = [[2.0, 0.0, 1.0], [0.0, 4.0, 2.0]]


@case
def a_box_goes_round_base_targets_and_what_is_shown(run):
    for weights, low, high in ((None, [0, 0, 0], [3, 5, 2]), ([1, 1], [0, 0, 0], [3, 5, 3]), ([-1, 0], [-2, 0, -1], [3, 5, 2]),
                               ([0.5, 0.25], [0, 0, 0], [3, 5, 2])):
        near(box_round(run, scene(TWO, weights)), [low, high], 1e-6, str(weights))


@case
def the_weights_of_a_node_hold_before_those_of_its_mesh(run):
    near(bounds(run, scene(TWO, [1, 1], [0, 0.5])), [[0, 2, 1], [1, 3, 1]], 1e-6)
    near(shown(run, scene(TWO, [1, 1], [0, 0.5])), moved([0, 2, 1]), 1e-6)


@case
def weights_that_are_not_one_number_for_each_target(run):
    """What is missing or is not a finite number counts as 0; what is too many is left."""
    for weights, shift in (("x", [0, 0, 0]), (7, [0, 0, 0]), ({"a": 1}, [0, 0, 0]), ([1], [2, 0, 1]), ([1, 1, 1], [2, 4, 3]),
                           (["x", 1], [0, 4, 2]), ([None, 1], [0, 4, 2]), ([1e39, 1], [0, 4, 2]), ([[1], True], [0, 0, 0])):
        for holder in ("mesh", "node"):
            made = scene(TWO, nodes=[{"mesh": 0}])
            made.asset["meshes" if holder == "mesh" else "nodes"][0]["weights"] = weights
            near(shown(run, made), moved(shift), 1e-6, f"{holder} {weights}")
            place = "/meshes/0/weights" if holder == "mesh" else "/nodes/0/weights"
            equal(lines_with(run.ffd("check", "a.glb", "-l", "l.json", err=anything), "default weights"),
                  [f"a.glb: {place}: the default weights are not one finite number for each morph target: a missing or other one "
                   "counts as 0"], str(weights))
    # Of a node that has no list of them, those of its mesh hold; an empty list is one.
    near(shown(run, scene(TWO, [1, 1], nodes=[{"mesh": 0, "weights": "x"}])), moved([2, 4, 3]), 1e-6)
    near(shown(run, scene(TWO, [1, 1], nodes=[{"mesh": 0, "weights": []}])), moved([0, 0, 0]), 1e-6)
    equal(lines_with(run.ffd("check", "a.glb", "-l", "l.json", err=anything), "/nodes/0/weights: the default weights"),
          lines_with(run.ffd("check", "a.glb", "-l", "l.json", err=anything), "default weights"))


@case
def bounds_of_info_are_those_of_what_is_shown(run):
    near(bounds(run, scene(TWO)), [[0, 0, 0], [1, 1, 0]], 1e-6)
    near(bounds(run, scene(TWO, [1, 0.5])), [[2, 2, 2], [3, 3, 2]], 1e-6)
    placed = [{"mesh": 0, "scale": [2, 2, 2]}, {"mesh": 0, "weights": [0, 1]}]
    near(bounds(run, scene(TWO, [1, 0], nodes=placed)), [[0, 0, 2], [6, 5, 2]], 1e-6)


@case
def parts_of_info_have_the_bounds_of_what_is_shown(run):
    run.write("a.glb", scene(TWO, nodes=[{"mesh": 0, "name": "n", "weights": [1, 0.5]}]).glb())
    part = run.ffd("info", "a.glb", "--parts", "--json").json["named_parts"][0]
    near([part["bounds"]["min"], part["bounds"]["max"]], [[2, 2, 2], [3, 3, 2]], 1e-6)


@case
def a_conversion_writes_what_is_shown(run):
    near(shown(run, scene(TWO)), moved([0, 0, 0]), 1e-6)
    near(shown(run, scene(TWO, [0.5, -1])), moved([1, -4, -1.5]), 1e-6)


def two_primitives(targets, weights, directions=None, meshes=1):
    """Primitives of the same triangle, in one mesh or in two, each with morph targets of its own; directions: the normals that
    the targets add to that of both."""
    made = scene([], nodes=[{"mesh": m} for m in range(meshes)])
    attributes = made.asset["meshes"][0]["primitives"][0]["attributes"]
    if directions:
        attributes["NORMAL"] = made.add([[0.0, 0.0, 1.0]] * 3)
    primitives = [{"attributes": attributes, "targets": [
        {"POSITION": made.add([offset] * 3, bounds=True), **({"NORMAL": made.add([directions[p]] * 3)} if directions else {})}
        for offset in offsets]} for p, offsets in enumerate(targets)]
    made.asset["meshes"] = [{"primitives": part, "weights": weights} for part in
                            ([primitives] if meshes == 1 else [[primitive] for primitive in primitives])]
    return made


@case
def primitives_that_share_positions_are_shown_by_their_own_targets(run):
    """Each is where its own targets show it, and counts as vertices of its own; with weights of 0 they are one."""
    for weights, first, second in (([1, 0], [2, 0, 1], [0, 4, 2]), ([0.5, 1], [1, 0, 0.5], [0, 2, 1])):
        made = two_primitives([TWO[:1] + [[0, 0, 0]], TWO[1:] + [[0, 0, 0]]], weights)
        near(shown(run, made), moved(first) + moved(second), 1e-6, str(weights))
        places = [[x - (a == 0) for a, x in enumerate(p)] for p in moved(first) + moved(second)]
        near(bounds(run, made), [list(map(edge, *places)) for edge in (min, max)], 1e-6, f"bounds, {weights}")
        equal(entry(run, "check", "a.glb", "-l", "l.json")["vertices"], 6)
    made = two_primitives([TWO[:1], TWO[1:]], [0])
    equal(len(shown(run, made)), 3)
    high = lattice(low=(-10, -10, 1.5), high=(10, 10, 10), moves=[{"by": [1, 0, 0]}])
    run.write("a.glb", two_primitives([TWO[:1], TWO[1:]], [1]).glb())
    run.write("h.json", high)
    equal(entry(run, "check", "a.glb", "-l", "h.json")["morph_targets"],
          {"outside": 3, "shown_outside": 3, "base_outside": 6, "invalid": 0})


@case
def primitives_that_share_positions_in_other_meshes_and_their_normals(run):
    made = two_primitives([TWO[:1], TWO[1:]], [1], meshes=2)
    near(shown(run, made), moved(TWO[0]) + moved(TWO[1]), 1e-6)
    run.ffd("deform", "a.glb", "b.obj", "-l", "l.json", "--space", "mesh", err=anything)
    near(obj_vertices(run.text("b.obj")), moved(TWO[0]) + moved(TWO[1]), 1e-6)
    shown(run, two_primitives([TWO[:1], TWO[:1]], [1], directions=[[1.0, 0.0, -1.0], [0.0, 1.0, -1.0]]))
    normals = [[float(x) for x in line.split()[1:]] for line in run.text("a.obj").splitlines() if line.startswith("vn ")]
    near(sorted(map(list, {tuple(n) for n in normals})), [[0, 1, 0], [1, 0, 0]], 1e-6)


@case
def a_conversion_of_a_bent_shape(run):
    """The target is shown in full: base and target of the glTF that comes out, added."""
    run.write("a.glb", scene([[0.0, 0.0, 1.0]], [1]).glb())
    run.write("l.json", lattice(low=(-3, -3, -3), high=(3, 3, 3), moves=[{"twist": {"axis": "z", "degrees": 60}}]))
    run.ffd("deform", "a.glb", "b.glb", "-l", "l.json", err=anything)
    run.ffd("deform", "a.glb", "b.obj", "-l", "l.json", err=anything)
    asset, data = glb_split(run.read("b.glb"))
    primitive = asset["meshes"][0]["primitives"][0]
    base, target = (gltf_vectors(asset, data, n["POSITION"]) for n in (primitive["attributes"], primitive["targets"][0]))
    near(obj_vertices(run.text("b.obj")), [[a + b for a, b in zip(p, m)] for p, m in zip(base, target)], 1e-6)


@case
def gates_judge_base_target_and_what_is_shown(run):
    """The lattice holds z from -1 to 1."""
    run.write("l.json", lattice(low=(-9, -9, -1), high=(9, 9, 1), moves=[{"by": [1, 0, 0]}]))
    for offsets, weights, outside in (([[0.0, 0.0, 0.5]], None, False), ([[0.0, 0.0, 0.5]], [1], False),
                                      ([[0.0, 0.0, 0.5]], [3], True),  # what is shown alone
                                      ([[0.0, 0.0, 2.0]], None, True), ([[0.0, 0.0, 2.0]], [0.25], True)):
        run.write("a.glb", scene(offsets, weights).glb())
        for command in (["check", "a.glb"], ["deform", "a.glb", "b.glb", "--force"]):
            done = run.ffd(*command, "-l", "l.json", "--fail-on", "outside", code=NO if outside else 0, err=anything)
            if outside:
                equal("default weights" in done.err[0], weights == [3], done.err[0])


@case
def the_report_has_what_the_gates_count(run):
    """The lattice holds z from -1 to 1, base at 0; what gates count beside the vertices as shown is in a member of its own."""
    run.write("l.json", lattice(low=(-9, -9, -1), high=(9, 9, 1), moves=[{"by": [1, 0, 0]}]))
    for offsets, weights, targets, shown in (([0.5], None, 0, 0), ([0.5], [1], 0, 0), ([0.5], [3], 0, 3), ([2.0], None, 3, 0),
                                             ([2.0], [1], 3, 3), ([2.0, 0.5], [0.25, 1], 3, 0), ([2.0, 3.0], [1, -1], 6, 0),
                                             ([2.0, 3.0], [0, 1], 6, 3)):
        run.write("a.glb", scene([[0.0, 0.0, z] for z in offsets], weights).glb())
        for command in (["check", "a.glb"], ["deform", "a.glb", "b.glb"], ["deform", "a.glb", "b.obj"]):
            job = entry(run, *command, "-l", "l.json")
            equal([job["outside"], job["morph_targets"]], [shown, {"outside": targets, "shown_outside": shown, "invalid": 0}],
                  f"{offsets} {weights} {command}")
    made = scene([])
    made.asset["meshes"][0]["primitives"][0]["targets"] = [{"POSITION": made.add([[0, float("inf"), 0]] * 3)}]
    run.write("a.glb", made.glb())
    equal(entry(run, "check", "a.glb", "-l", "l.json")["morph_targets"], {"outside": 0, "shown_outside": 0, "invalid": 3})


@case
def bounds_of_a_report_are_those_of_info(run):
    """Also of targets that move one vertex only, of several nodes, and of a mesh without weights beside one with them."""
    run.write("l.json", lattice(low=(-9, -9, -9), high=(9, 9, 9), moves=[{"by": [1, 0, 0]}]))
    made = scene(TWO, [0.5, -1], nodes=[{"mesh": 0, "scale": [2, 1, 1]}, {"mesh": 0, "weights": [1, 0]}, {"mesh": 0, "weights": [0, 0]}])
    one = scene([[0.0, 0.0, 1.0]], [1])
    one.asset["meshes"][0]["primitives"][0]["targets"] = [{"POSITION": one.add([[0, 0, 0], [0, 0, 3], [0, 0, 0]], bounds=True)}]
    for file in (scene(TWO), scene(TWO, [1, 0]), scene(TWO, [0.5, 0.25]), made, one):
        shape = bounds(run, file)
        shifted = [[p[0] + 1, *p[1:]] for p in shape]
        for command in (["check", "a.glb"], ["deform", "a.glb", "b.glb"], ["deform", "a.glb", "b.obj"]):
            found = entry(run, *command, "-l", "l.json")["bounds"]
            near([[box["min"], box["max"]] for box in (found["before"], found["after"])], [shape, shifted], 1e-6, str(command))


@case
def counts_and_messages_are_of_what_is_shown(run):
    """The lattice holds z from 4 to 6: the base lies below it, and what is shown in it. The base comes beside that."""
    run.write("l.json", lattice(low=(-9, -9, 4), high=(9, 9, 6), moves=[{"by": [1, 0, 0]}]))
    without = "without the default weights of morph targets 3 vertices are outside the lattice (left where they are)"
    for offset, weight, inside in ((5.0, 1, True), (10.0, 0.5, True), (2.0, 1, False)):
        run.write("a.glb", scene([[0.0, 0.0, offset]], [weight]).glb())
        for command in (["check", "a.glb"], ["deform", "a.glb", "b.glb"], ["deform", "a.glb", "b.obj"], ["view", "a.glb", "-o", "v.html"]):
            done = run.ffd(*command, "-l", "l.json", *([] if command[0] == "check" else ["--force"]), err=anything)
            equal(lines_with(done, "without the default"), [f"a.glb: {without}"] if inside else [], str(command))
            equal(len(lines_with(done, "3 of 3 vertices are not inside: 3 outside")), 0 if inside else 1, str(command))
            if command[0] == "view":
                continue
            job = entry(run, *command, "-l", "l.json")
            equal([job["inside"], job["outside"], job["moved"], job["displacement"]["max"], job["morph_targets"]["base_outside"]],
                  [3, 0, 3, 1, 3] if inside else [0, 3, 0, 0, 3], str(command))
        done = run.ffd("check", "a.glb", "-l", "l.json", "--fail-on", "outside", code=NO, err=anything)
        equal("3 of 3 vertices are outside" in done.err[0], not inside, done.err[0])
        run.ffd("check", "a.glb", "-l", "l.json", "--outside", "error", code=5, err=anything)


@case
def the_base_of_other_meshes_is_not_counted_beside_what_is_shown(run):
    """A mesh without weights beside one with them, both at z = 0, outside."""
    run.write("l.json", lattice(low=(-9, -9, 4), high=(9, 9, 6), moves=[{"by": [1, 0, 0]}]))
    made = scene([[0.0, 0.0, 5.0]], [1], nodes=[{"mesh": 0}, {"mesh": 1}])
    made.asset["meshes"].append({"primitives": [{"attributes": {"POSITION": made.add(TRIANGLE, bounds=True)}}]})
    run.write("a.glb", made.glb())
    job = entry(run, "check", "a.glb", "-l", "l.json")
    equal([job["inside"], job["outside"], job["morph_targets"]["base_outside"]], [3, 3, 3])


@case
def a_vertex_shown_has_the_rounding_of_base_and_offsets(run):
    """1 - 0.9 as float32 is 2.4e-8 above the lattice's end at 0.1: less than these numbers are rounded by, and more than 0.1 is."""
    run.write("l.json", lattice(low=(-9, -9, -9), high=(9, 9, 0.1), moves=[{"by": [1, 0, 0]}]))
    run.write("a.glb", scene([[0.0, 0.0, 1.0], [0.0, 0.0, -float32(0.9)]], [1, 1]).glb())
    for command in (["check", "a.glb"], ["deform", "a.glb", "b.glb"], ["deform", "a.glb", "b.obj"]):
        job = entry(run, *command, "-l", "l.json")
        equal([job["inside"], job["moved"]], [3, 3], str(command))


GRID = [[x / 4, y / 4, 0.0] for y in range(7) for x in range(7)]
QUADS = [[7 * y + x, 7 * y + x + 1, 7 * y + x + 8, 7 * y + x, 7 * y + x + 8, 7 * y + x + 7] for y in range(6) for x in range(6)]


def grid(run, plain, offsets, weights):
    """A grid in two primitives, with normals and tangents. plain: its base is the shape that the weights show of the other."""
    made = Scene(nodes=[{"mesh": 0, "name": "Sheet"}], scene=0, scenes=[{"nodes": [0]}])
    moves = [[[k * (i % 5) / 64 * c for c in offset] for i in range(len(GRID))] for k, offset in enumerate(offsets, 1)]
    shown = [[x + sum(w * m[i][a] for w, m in zip(weights, moves)) for a, x in enumerate(p)] for i, p in enumerate(GRID)]
    attributes = {"POSITION": made.add(shown if plain else GRID, bounds=True), "NORMAL": made.add([[0.0, 0.0, 1.0]] * len(GRID)),
                  "TANGENT": made.add([[1.0, 0.0, 0.0, 1.0]] * len(GRID), shape="VEC4")}
    halves = [[[i] for quad in part for i in quad] for part in (QUADS[:18], QUADS[18:])]
    primitives = [{"attributes": attributes, "indices": made.add(half, 5123, "SCALAR")} for half in halves]
    if not plain:
        targets = [{"POSITION": made.add(m, bounds=True)} for m in moves]
        primitives = [{**primitive, "targets": targets} for primitive in primitives]
    made.asset["meshes"] = [{"primitives": primitives, **({} if plain else {"weights": weights})}]
    run.write("plain.glb" if plain else "a.glb", made.glb())


def figures(job, *left_out):
    """What a report says of the deformation."""
    names = ("line", "input", "output", "outputs", "seconds", "picture", "row", "positions", "set", *left_out)
    return {name: value for name, value in job.items() if name not in names}


FOLD = [{"at": [1, [1, 2], [1, 2]], "by": [3, 0.5, 0.25]}, {"twist": {"axis": "z", "degrees": 30}}]
TARGETS = ([0.0, 1.0, 8.0], [-2.0, 0.0, 4.0])


@case
def every_figure_is_that_of_the_shape_shown(run):
    """Whole reports: of a check, of conversions, of a glTF, of a picture and of a batch, and of a glTF whose base is that shape."""
    run.write("l.json", lattice(low=(-0.25, -0.25, -0.5), high=(1, 2, 0.5), moves=FOLD))
    wanted = ("--fail-on", "edges=1e9,flipped=99")
    for weights, options in (([0.5, 1], ()), ([1, 0], ("--outside", "extend", "--falloff", "0.3")), ([0.5, -1], ("--normals", "recompute")),
                             ([1, 0.25], ("--only", "node:Sheet", "--snap", "0.1", "--normals", "keep"))):
        grid(run, False, TARGETS, weights)
        grid(run, True, TARGETS, weights)
        checked = figures(entry(run, "check", "a.glb", "-l", "l.json", *options))
        plain = figures(entry(run, "check", "plain.glb", "-l", "l.json", *options), "morph_targets")
        edges = plain.pop("edges")
        equal({name: checked[name] for name in plain}, plain, f"{weights} {options}: the shape alone")
        # Where an edge leaves the lattice depends on the rounding of its ends, which is that of base and offsets together.
        near([checked["edges"]["deviation"][name] for name in ("max", "mean")], [edges["deviation"][name] for name in ("max", "mean")],
             1e-7, f"{weights} {options}: edges")
        check(all(checked[name] for name in ("outside", "moved", "flipped_faces")) and checked["folds"]["folded_cells"]
              and (checked["tear"]["edges"] > 0) == ("extend" not in options), "too little happens", checked)
        for out in ("b.obj", "b.ply", "b.off", "b.stl", "b.glb"):
            found = entry(run, "deform", "a.glb", out, "-l", "l.json", *options, *wanted)
            equal(figures(found), checked, f"{weights} {options} {out}")
        equal(figures(entry(run, "check", "a.glb", "-l", "l.json", *options, "--picture", "p.html", "--force")), checked, "a picture")
        run.write("m.jsonl", "".join(json.dumps({"in": "a.glb", "lattice": "l.json", "out": name}) + "\n" for name in ("1.ply", "2.glb", "3.obj")))
        run.ffd("batch", "m.jsonl", *options, *wanted, "--report", "r.json", "--force", err=anything)
        for job in json.loads(run.read("r.json"))["jobs"]:
            equal(figures(job), checked, f"a batch: {job['output']}")


@case
def gates_are_those_of_the_shape_shown_whatever_is_written(run):
    """Each of these is violated as shown, and by neither base nor targets."""
    high = {"low": (-9, -9, 4), "high": (9, 9, 6)}
    for name, made, offset in (("flipped", lattice(size=(2, 2, 2), **high, moves=[{"at": [1, "all", "all"], "by": [-40, 0, 0]}]), [0.0, 0.0, 5.0]),
                               ("tear", lattice(low=(0.6, -9, 4), high=(9, 9, 6), moves=[{"by": [0, 0, 1]}]), [0.25, 0.0, 5.0]),
                               ("edges=0.01", lattice(**high, moves=[{"twist": {"axis": "x", "degrees": 3000}}]), [0.0, 0.0, 5.0])):
        run.write("l.json", made)
        run.write("a.glb", scene([offset], [1]).glb())
        for command in (["check", "a.glb"], ["deform", "a.glb", "b.obj"], ["deform", "a.glb", "b.glb"], ["deform", "a.glb", "b.stl"]):
            done = run.ffd(*command, "-l", "l.json", "--fail-on", name, code=NO, err=anything)
            equal(len(lines_with(done, f"--fail-on {name.partition('=')[0]}")), 1, f"{command} {name} {done.err}")


@case
def normals_recomputed_beside_figures_of_the_shape_shown(run):
    """The base's normals come from the base's faces, though the figures are of other ones."""
    run.write("l.json", lattice(low=(-9, -9, -9), high=(9, 9, 9), moves=[{"rotate": {"axis": "x", "degrees": 90, "about": [0, 0, 0]}}]))
    grid(run, False, ([0.0, 0.0, 8.0],), [1])
    run.ffd("deform", "a.glb", "b.glb", "-l", "l.json", "--normals", "recompute", "--report", "r.json", err=anything)
    asset, data = glb_split(run.read("b.glb"))
    near(gltf_vectors(asset, data, asset["meshes"][0]["primitives"][0]["attributes"]["NORMAL"]), [[0, -1, 0]] * len(GRID), 1e-6)


@case
def arrays_of_embed_are_those_of_the_base(run):
    run.write("a.glb", scene([[0.0, 0.0, 1.0]], [1]).glb())
    run.write("l.json", lattice())
    run.ffd("embed", "a.glb", "-l", "l.json", "-o", "e.npy", "--status", "s.npy", err=anything)
    near(npy(run.read("e.npy"))[2], [[(x + 2) / 4 for x in p] for p in TRIANGLE], 1e-15)
    equal(npy(run.read("s.npy"))[2], [0, 0, 0])


MADE_ROUND = lattice(moves=[{"twist": {"axis": "z", "degrees": 40}}], rest={"box": "mesh", "margin": 0.05})


@case
def the_box_is_the_same_whatever_is_written(run):
    """What the glTF shows afterwards is what the OBJ has; so too where the targets stay as they are."""
    run.write("a.glb", scene(TWO, [0, 1]).glb())
    run.write("l.json", MADE_ROUND)
    run.ffd("deform", "a.glb", "b.glb", "-l", "l.json", err=anything)
    run.ffd("deform", "a.glb", "b.obj", "-l", "l.json", err=anything)
    run.ffd("deform", "a.glb", "m.glb", "-l", "l.json", "--as-morph", "new", err=anything)
    base, target, added = primitives(run, "b.glb", 0), targets(run, "b.glb")[1], targets(run, "m.glb")
    near(obj_vertices(run.text("b.obj")), total(base, target), 1e-6)
    near(total(primitives(run, "a.glb", 0), added[2]), base, 1e-6)
    near(added[:2], targets(run, "a.glb"), 0)


@case
def a_lattice_round_a_mesh_holds_base_targets_and_what_is_shown(run):
    """Nothing is outside of it, and it is no larger: the corner of the box is at the end of the volume."""
    for weights, low, high in ((None, [0, 0, 0], [3, 5, 2]), ([1, 1], [0, 0, 0], [3, 5, 3]), ([-1, 0], [-2, 0, -1], [3, 5, 2])):
        run.write("a.glb", scene(TWO, weights).glb())
        run.write("l.json", lattice(rest={"box": "mesh", "margin": 0}, moves=[{"by": [1, 0, 0]}]))
        run.ffd("check", "a.glb", "-l", "l.json", "--fail-on", "outside")
        run.ffd("embed", "a.glb", "-l", "l.json", "-o", "e.npy", "--force")
        near(npy(run.read("e.npy"))[2], [[(x - a) / (b - a) for x, a, b in zip(p, low, high)] for p in TRIANGLE], 1e-9)
    # One target, and weights that show more than it, or the other side.
    for weight, low, high in ((2, [0, 0, 0], [5, 1, 2]), (-1, [-2, 0, -1], [3, 1, 1])):
        near(box_round(run, scene(TWO[:1], [weight])), [low, high], 1e-6, str(weight))


def primitives(run, name, mesh):
    asset, data = glb_split(run.read(name))
    return gltf_vectors(asset, data, asset["meshes"][mesh]["primitives"][0]["attributes"]["POSITION"])


def targets(run, name):
    asset, data = glb_split(run.read(name))
    return [gltf_vectors(asset, data, target["POSITION"]) for target in asset["meshes"][0]["primitives"][0]["targets"]]


def total(points, offsets):
    return [[a + b for a, b in zip(p, m)] for p, m in zip(points, offsets)]


BOUNDS = ((-3, -3, -3), (4, 4, 4))


def turned(p):
    """What a rotation of the whole lattice by 90 degrees about z through the origin does."""
    return [-p[1], p[0], p[2]]


@case
def a_conversion_deforms_the_shape_that_is_shown(run):
    """Half of a target through a lattice that is not affine: not half of what the target gets."""
    moves = [{"twist": {"axis": "z", "degrees": 60, "about": [0, 0, 0]}}]
    low, high = BOUNDS
    run.write("l.json", lattice(low=low, high=high, moves=moves))
    run.write("a.glb", scene([[0.0, 2.0, 2.0]], [0.5]).glb())
    run.ffd("deform", "a.glb", "a.obj", "-l", "l.json", err=anything)
    run.write("s.obj", "".join("v %r %r %r\n" % (p[0], p[1] + 1, p[2] + 1) for p in TRIANGLE))
    run.ffd("deform", "s.obj", "t.obj", "-l", "l.json", err=anything)
    near(obj_vertices(run.text("a.obj")), obj_vertices(run.text("t.obj")), 1e-6)


@case
def colours_and_texture_coordinates_of_a_conversion_are_those_shown(run):
    """Under each node by its own weights, before KHR_texture_transform; a weight of 0 leaves the base's values."""
    def floats(text, key, first, count):
        return [[float(x) for x in line.split()[first:first + count]] for line in text.splitlines() if line.split()[0] == key]

    def srgb(linear):
        return 12.92 * linear if linear <= 0.0031308 else 1.055 * linear ** (1 / 2.4) - 0.055

    made = scene([[0.0, 0.0, 0.0]], [0.5], nodes=[{"mesh": 0}, {"mesh": 0, "weights": [1]}, {"mesh": 0, "weights": [0]}])
    made.asset["materials"] = [{"pbrMetallicRoughness": {"baseColorTexture": {
        "index": 0, "extensions": {"KHR_texture_transform": {"scale": [2, 2], "offset": [0.25, 0]}}}}}]
    made.asset.update(textures=[{"source": 0}], images=[{"uri": "data:,"}], extensionsUsed=["KHR_texture_transform"])
    primitive = made.asset["meshes"][0]["primitives"][0]
    primitive["material"] = 0
    primitive["attributes"].update(COLOR_0=made.add([[0.25, 0.0, 1.0, 1.0]] * 3, shape="VEC4"),
                                   TEXCOORD_0=made.add([[0.0, 0.0], [0.5, 0.0], [0.5, 0.5]], shape="VEC2"))
    primitive["targets"][0].update(COLOR_0=made.add([[0.5, 1.0, 1.0, 0.0]] * 3, shape="VEC4"),
                                   TEXCOORD_0=made.add([[0.125, 0.25]] * 3, shape="VEC2"))
    shown(run, made)
    text = run.text("a.obj")
    equal(len(floats(text, "v", 4, 3)), 9)
    near(floats(text, "v", 4, 3), [[srgb(min(x + w * d, 1)) for x, d in zip((0.25, 0, 1), (0.5, 1, 1))] for w in (0.5, 1, 0) for _ in range(3)],
         1e-6)
    near(floats(text, "vt", 1, 2), [[2 * (u + 0.125 * w) + 0.25, 1 - 2 * (v + 0.25 * w)] for w in (0.5, 1, 0) for u, v in ((0, 0), (0.5, 0), (0.5, 0.5))],
         1e-6)


@case
def normals_of_a_conversion_are_those_of_the_shape_shown(run):
    low, high = BOUNDS
    run.write("l.json", lattice(low=low, high=high, moves=[{"rotate": {"axis": "z", "degrees": 90, "about": [0, 0, 0]}}]))
    made = scene([[0.0, 0.0, 1.0]], [0.5])
    primitive = made.asset["meshes"][0]["primitives"][0]
    primitive["attributes"]["NORMAL"] = made.add([[0.0, 0.0, 1.0]] * 3)
    primitive["targets"][0]["NORMAL"] = made.add([[1.5, 0.0, 0.0]] * 3)
    run.write("a.glb", made.glb())
    for normals in ("transform", "keep"):
        run.ffd("deform", "a.glb", "a.obj", "-l", "l.json", "--normals", normals, "--force", err=anything)
        lines = [line.split() for line in run.text("a.obj").splitlines()]
        found = [[float(x) for x in line[1:]] for line in lines if line[0] == "vn"]
        near(found, [turned([0.6, 0, 0.8]) if normals == "transform" else [0.6, 0, 0.8]] * len(found), 1e-6, normals)
        near(obj_vertices(run.text("a.obj")), [turned([p[0], p[1], p[2] + 0.5]) for p in TRIANGLE], 1e-6, normals)
    run.ffd("deform", "a.glb", "a.obj", "-l", "l.json", "--normals", "recompute", "--force", err=anything)
    check("vn 0 0 1" in run.text("a.obj").splitlines(), run.text("a.obj"))


@case
def an_embedding_of_the_base_serves_a_conversion(run):
    run.write("a.glb", scene(TWO, [1, 0]).glb())
    run.write("l.json", SHIFT)
    run.ffd("embed", "a.glb", "-l", "l.json", "-o", "e.npy", err=anything)
    run.ffd("deform", "a.glb", "a.obj", "-l", "l.json", "--embedding", "e.npy", err=anything)
    near(obj_vertices(run.text("a.obj")), moved(TWO[0]), 1e-6)


@case
def a_mesh_that_jobs_share_is_shown_to_conversions_only(run):
    run.write("a.glb", scene(TWO, [1, 0]).glb())
    run.write("l.json", SHIFT)
    outputs = ["1.glb", "2.obj", "3.glb", "4.ply", "5.obj", "6.glb"]
    run.write("m.jsonl", "".join(json.dumps({"in": "a.glb", "lattice": "l.json", "out": name}) + "\n" for name in outputs))
    run.ffd("batch", "m.jsonl", "-j", "1", err=anything)
    equal([run.read(name) for name in ("3.glb", "6.glb")], [run.read("1.glb")] * 2)
    equal(run.read("5.obj"), run.read("2.obj"))
    near(primitives(run, "1.glb", 0), moved([0, 0, 0]), 1e-6)
    near(obj_vertices(run.text("2.obj")), moved(TWO[0]), 1e-6)


@case
def counts_are_of_the_base_and_targets_in_a_conversion_too(run):
    """The target that is not shown leaves the box: the gate says so whatever is written."""
    run.write("l.json", lattice(low=(-9, -9, -1), high=(9, 9, 1), moves=[{"by": [1, 0, 0]}]))
    run.write("a.glb", scene([[0.0, 0.0, 2.0], [0.0, 0.0, 0.5]], [0, 1]).glb())
    run.ffd("deform", "a.glb", "b.obj", "-l", "l.json", "--fail-on", "outside", code=NO, err=anything)
    run.ffd("deform", "a.glb", "b.obj", "-l", "l.json", err=anything)
    near(obj_vertices(run.text("b.obj")), moved([0, 0, 0.5]), 1e-6)


def as_morph(run, made, name, moves):
    run.write("a.glb", made.glb())
    run.write("l.json", lattice(low=(-10, -10, -10), high=(10, 10, 10), moves=moves))
    run.ffd("deform", "a.glb", "b.glb", "-l", "l.json", "--as-morph", name, "--force", err=anything)
    gltf = Gltf(run.path("b.glb"))  # reads accessors of zeros, which need no bytes
    mesh = gltf.asset["meshes"][0]
    return mesh, [[list(m) for m in gltf.decoded(target["POSITION"])] for target in mesh["primitives"][0]["targets"]]


@case
def as_morph_replaces_a_target_of_that_name(run):
    mesh, targets = as_morph(run, scene(TWO, [0.5, 0], names=["smile", "frown"]), "smile", [{"by": [0, 0, 3]}])
    equal([mesh["extras"]["targetNames"], mesh["weights"]], [["smile", "frown"], [0.5, 0]])
    near(targets, [[[0, 0, 3]] * 3, [TWO[1]] * 3], 1e-6)
    mesh, targets = as_morph(run, scene(TWO, [0.5, 0], names=["smile", "frown"]), "frown", [{"by": [0, 0, 3]}])
    near(targets, [[TWO[0]] * 3, [[0, 0, 3]] * 3], 1e-6)


@case
def a_zero_shape_gets_its_target(run):
    mesh, targets = as_morph(run, scene(TWO[:1], names=["smile"]), "rest", [])
    equal(mesh["extras"]["targetNames"], ["smile", "rest"])
    near(targets[1], [[0, 0, 0]] * 3, 0)
    mesh, targets = as_morph(run, scene(TWO[:1], names=["smile"]), "smile", [])
    equal(mesh["extras"]["targetNames"], ["smile"])
    near(targets, [[[0, 0, 0]] * 3], 0)


main()
