#!/usr/bin/env python3
"""The scripts for Blender (data/blender) in Blender itself: in Debian's, and in the module bpy. What `ffd deform` makes with the lattices
that they write is what Blender shows, to single precision, inside and beyond the lattices.

    FFD=... PYTHONPATH=tests/cli python3 tests/blender/test_scripts.py lattices_of_all_kinds
"""

import json
import math
import os
import random
import re
import shlex
import shutil
import struct
import tempfile

import programs
from harness import case, check, equal, glb_split, gltf_vectors, lattice, main, near

SEED = int(os.environ.get("FFD_SEED") or random.randrange(1 << 30))
RANDOM = random.Random(SEED)
print(f"seed {SEED} (FFD_SEED)")
FLOAT32 = 1e-6  # of the largest coordinate: some ten roundings
EXPORT, IMPORT = (os.path.join(programs.SCRIPTS, name) for name in ("ffd_export.py", "ffd_import.py"))
KEPT = tempfile.TemporaryDirectory()
BLENDERS = [blender for blender in (programs.debian(), programs.wheel(os.path.join(KEPT.name, "venv"))) if blender]
if not BLENDERS:
    programs.skip("blender", "neither Debian's Blender nor the wheels of tests/blender are here (.ci/setup stages)")
print("in", " and ".join(blender.name for blender in BLENDERS))


def script(name):
    return os.path.join(programs.HERE, name)


def in_blender(run, blender, *scripts, code=0, say=None, **options):
    """stdout's lines that are of the scripts, and stderr's."""
    done = blender.run(run.folder, *scripts, **options)
    told = [line for line in done.stderr.splitlines() if line.startswith("ffd_")]
    check(done.returncode == code, f"{blender.name}, {options}: exit {done.returncode}, not {code}:\n{done.stdout[-3000:]}\n{done.stderr[-3000:]}")
    if code:
        check(len(told) == 1 and "Traceback" not in done.stderr + done.stdout, f"{blender.name}, {options}: {done.stdout[-500:]}{done.stderr[-3000:]}")
    if say is not None:
        check(re.search(say, "\n".join(told)), f"{blender.name}, {options}: {told}, not {say}")
    return [line for line in done.stdout.splitlines() if "--outside" in line], told


def make(run, blender, kind):
    in_blender(run, blender, script("make_scene.py"), arguments=[run.folder, kind, str(SEED)])
    return json.loads(run.text("blender.json"))


def cloud(points, weights=None):
    lines = ["ply", "format binary_little_endian 1.0", f"element vertex {len(points)}", *(f"property double {c}" for c in "xyz"),
             *(["property float ffd"] if weights else []), "end_header\n"]
    numbers = b"".join(struct.pack("<3d", *p) + (struct.pack("<f", weights[i]) if weights else b"") for i, p in enumerate(points))
    return "\n".join(lines).encode() + numbers


def cloud_points(data, weights=None):
    start, stride = data.index(b"end_header\n") + 11, 28 if weights else 24
    return [list(struct.unpack_from("<3d", data, i)) for i in range(start, len(data), stride)]


def size_of(points):
    return max(abs(c) for p in points for c in p)


def compare(run, blender, name, of, file, frame, *more):
    weights = of.get("weights")
    run.write("cloud.ply", cloud(of["before"], weights))
    run.ffd("deform", "cloud.ply", "out.ply", "-l", file, "--outside", "extend", "--force", *more, *(["--weight", "property:ffd"] if weights else []),
            err=lambda lines: None, lines=None)
    wanted = of["after"][frame]
    near(cloud_points(run.read("out.ply"), weights), wanted, FLOAT32 * max(1, size_of(wanted)), f"{blender.name}: {name}")


def each(run, kind, *arguments):
    for blender in BLENDERS:
        found = make(run, blender, kind)
        run.folder_of(blender.name)
        printed, told = in_blender(run, blender, EXPORT, scene="scene.blend", arguments=["--out", blender.name, *arguments])
        equal(len(printed), len(found["objects"]), blender.name)
        yield blender, found, dict(zip(sorted(found["objects"]), printed)), told


@case
def lattices_of_all_kinds(run):
    for blender, found, _, told in each(run, "plain"):
        equal(told, [], blender.name)
        for name, of in found["objects"].items():
            compare(run, blender, name, of, f"{blender.name}/{name}-Lattice.json", 0)


@case
def weights_parents_and_shape_keys(run):
    """And a lattice that several objects share, hooks, groups that are empty or not there, names of all kinds."""
    for blender, found, printed, told in each(run, "special"):
        equal([line for line in told if "as in Blender, all vertices move" not in line], [], blender.name)
        equal(len(told), 4, blender.name)
        for name, of in found["objects"].items():
            compare(run, blender, name, of, f"{blender.name}/{name.replace('/', '_')}-Lattice.json", 0)
            check(("--weight" in printed[name]) == ("weights" in of), printed[name])
        check("points" in json.loads(run.text(f"{blender.name}/sheared-Lattice.json"))["rest"], "sheared")


@case
def moving_strengths_and_shape_keys(run):
    for blender, found, _, told in each(run, "moving", "--frames", "3:8"):
        check(len(told) == 1 and "moved cage" in told[0] and "itself moves" in told[0], told)
        for name, of in found["objects"].items():
            file = f"{blender.name}/{name}-Lattice.json"
            keys = json.loads(run.text(file))["keys"]
            near([key["time"] for key in keys], [frame / found["rate"] for frame in found["frames"]], 1e-12)
            if name == "moved":
                continue
            for number, key in enumerate(keys):
                compare(run, blender, name, of, file, number, "--time", repr(key["time"]))


def shapes_of(run, name):
    """The positions of each node's mesh."""
    asset, data = glb_split(run.read(name))
    return {node["name"]: gltf_vectors(asset, data, asset["meshes"][node["mesh"]]["primitives"][0]["attributes"]["POSITION"]) for node in asset["nodes"] if "mesh" in node}


@case
def a_glb_without_modifiers_becomes_that_with_them(run):
    """The way of a user: lattices and a GLB from one run of Blender, deformed by the options that the script prints, of each mesh its own."""
    for blender in BLENDERS:
        in_blender(run, blender, script("make_pair.py"), arguments=[run.folder])
        run.folder_of(blender.name)
        printed, _ = in_blender(run, blender, EXPORT, script("export_meshes.py"), scene="scene.blend", arguments=["--out", blender.name, "--up", "y"])
        before = shapes_of(run, f"{blender.name}/scene.glb")
        run.write("out.glb", run.read(f"{blender.name}/scene.glb"))
        for line in printed:
            file, options = re.fullmatch(r"(.*) \((.*)\)", line).groups()
            run.ffd("deform", "out.glb", "--in-place", "-l", file, *shlex.split(options), err=lambda lines: None, lines=None)
        found, wanted = shapes_of(run, "out.glb"), shapes_of(run, "blender.glb")
        equal(sorted(found), ["it's still", "masked", "plain"])
        for name in ("masked", "plain"):
            near(found[name], wanted[name], 2e-6, f"{blender.name}: {name}")
            check(max(abs(a - b) for p, q in zip(before[name], wanted[name]) for a, b in zip(p, q)) > 0.1, "nothing has moved")
        equal(found["it's still"], before["it's still"], blender.name)


@case
def lattices_of_ffd_in_blender(run):
    """Exact ones to single precision within the box, others within the error that is printed; the scene has a cage and modifiers."""
    knots = [["clamped", "open", "uniform"], ["clamped"] * 3, ["open", "clamped", [0, 0, 0, 0, 0.3, 1, 1, 1, 1]]]
    shapes = [((4, 5, 6), (3, 3, 3)), ((2, 4, 3), (1, 3, 1)), ((4, 4, 5), (3, 3, 3))]
    for blender in BLENDERS:
        for up in "zy":
            for number, (k, (size, degree)) in enumerate(zip(knots, shapes)):
                offsets = [[RANDOM.uniform(-0.2, 0.2) for _ in range(3)] for _ in range(math.prod(size))]
                a = RANDOM.uniform(0, 6)
                axes = [[math.cos(a), math.sin(a), 0], [math.sin(a), -math.cos(a), 0], [0, 0, 1]]
                run.write("L.json", lattice(size=size, degree=degree, knots=k, rest={"box": {"min": [-1, -2, 0], "max": [1, 0, 3], "axes": axes}}, deformed={"offsets": offsets}))
                within = [(RANDOM.uniform(-1, 1), RANDOM.uniform(-2, 0), RANDOM.uniform(0, 3)) for _ in range(300)]
                points = [[sum(c * axis[x] for c, axis in zip(p, axes)) for x in range(3)] for p in within]
                own = [[x, -z, y] for x, y, z in points] if up == "y" else points
                run.write("cloud.ply", cloud(points))
                run.write("points.json", {name: own for name in ("one", "two/2", "three")})
                run.ffd("deform", "cloud.ply", "out.ply", "-l", "L.json", "--force")
                in_blender(run, blender, script("make_clouds.py"))
                _, told = in_blender(run, blender, IMPORT, script("look.py"), scene="clouds.blend", arguments=["L.json", "--on", "one", "--on", "two/2", "--up", up])
                found = json.loads(run.text("look.json"))
                equal([found["L"]["type"], found["one"]["modifiers"], found["two/2"]["modifiers"], found["three"]["modifiers"]], ["LATTICE", [["LATTICE", "L"]], [["LATTICE", "L"]], []])
                after = [[x, z, -y] for x, y, z in found["one"]["after"]] if up == "y" else found["one"]["after"]
                equal(len(told), 2, told)
                check(told[1] == "ffd_import: L.json: Blender's lattice goes on beyond the box, where ffd's ends", told)
                error = 0
                if number == 2:
                    error = float(re.search(r"fitted by \d+ x \d+ x \d+ points, off by ([\d.e-]+) at most", told[0])[1])
                    check(0 < error < 0.1, told)
                else:
                    check("exact to single precision within its box" in told[0], told)
                near(after, cloud_points(run.read("out.ply")), 4e-6 + 1.5 * error, f"{blender.name}: {k}")
                equal(found["two/2"]["after"], found["one"]["after"])


@case
def out_of_blender_and_back(run):
    """What Blender's B-splines are written as comes back as the same splines, with more points."""
    for blender in BLENDERS:
        found = make(run, blender, "plain")
        run.folder_of(blender.name)
        in_blender(run, blender, EXPORT, scene="scene.blend", arguments=["--out", blender.name, "--object", "KEY_BSPLINE", "--object", "KEY_LINEAR", "--force"])
        equal(sorted(run.names(blender.name)), ["KEY_BSPLINE-Lattice.json", "KEY_LINEAR-Lattice.json"])
        for name in ("KEY_BSPLINE", "KEY_LINEAR"):
            of = found["objects"][name]
            content = json.loads(run.text(f"{blender.name}/{name}-Lattice.json"))
            run.write("points.json", {"one": of["before"]})
            run.write("L.json", content)
            in_blender(run, blender, script("make_clouds.py"))
            _, told = in_blender(run, blender, IMPORT, script("look.py"), scene="clouds.blend", arguments=["L.json", "--on", "one"])
            check("exact" in told[0], told)
            after = json.loads(run.text("look.json"))["one"]["after"]
            near(after, of["after"][0], 8 * FLOAT32 * size_of(of["after"][0]), name)  # also beyond the box: both go on alike


@case
def commands_of_the_tutorial(run):
    """Those of Debian's Blender, in a copy of data/; the lattice is that beside the pages."""
    blender = next((blender for blender in BLENDERS if blender.command[0] == programs.PROGRAM), None)
    if not blender:
        return
    data = os.path.join(programs.ROOT, "data")
    shutil.copytree(data, run.path("data"))
    with open(os.path.join(data, "tutorial.md"), encoding="utf-8") as file:
        page = file.read()
    recipe = page[page.index("## From Blender, and back"):].split("\n## ")[0]
    commands = re.findall("^    (blender .*)$", recipe, re.M)
    equal(len(commands), 3)
    run.ffd("lattice", "convert", "data/lattices/bulge.json", "-o", "data/bulge-box.json", "--mesh", "data/models/vase.obj")
    for command in commands:
        words = shlex.split(command)[1:]
        done = blender.given(run.path("data"), *([] if "-b" in words else ["-b"]), *words)
        check(done.returncode == 0 and "Traceback" not in done.stdout + done.stderr, command, done.stdout, done.stderr)
    check("5 x 7 x 5 points, exact to single precision" in done.stderr, done.stderr)
    kept, made = (json.loads(run.text(f"data/{name}")) for name in ("blender/vase-Lattice.json", "vase-Lattice.json"))
    for of in (kept, made):
        of["rest"] = [*of["rest"]["box"]["min"], *of["rest"]["box"]["max"], *sum(of["rest"]["box"]["axes"], [])]
    near([made["rest"], *made["deformed"]["offsets"]], [kept["rest"], *kept["deformed"]["offsets"]], 1e-6, "vase-Lattice.json")
    equal([made[name] for name in ("size", "degree", "knots")], [kept[name] for name in ("size", "degree", "knots")])
    run.ffd("deform", "data/vase.glb", "a.glb", "-l", "data/vase-Lattice.json", "--outside", "extend", err=lambda lines: None, lines=None)
    check(run.exists("a.glb"), "the GLB")


@case
def what_is_refused(run):
    """One line, exit 1 or 2, and nothing is written."""
    for blender in BLENDERS:
        make(run, blender, "plain")
        names = set(run.names())
        exporting = dict(scene="scene.blend")
        for arguments, code, what in (
                ([], 2, "ffd_export: the following arguments are required: --out"), (["--out", "nowhere"], 1, "nowhere: is not a folder"), (["--out", ".", "--object", "nobody"], 1, 'no object "nobody"'),
                (["--out", ".", "--frames", "5:5"], 2, "5:5"), (["--out", ".", "--frames", "-1:5"], 2, "frames"), (["--out", ".", "--frames", "x"], 2, '"x" is not a:b'), (["--out", ".", "--up", "x"], 2, "up"),
                (["--out", ".", "--name", "KEY_LINEAR cage"], 1, "nothing was written"), (["--out", ".", "more"], 2, "more")):
            in_blender(run, blender, EXPORT, code=code, say=what, arguments=arguments, **exporting)
            equal(set(run.names()), names, str(arguments))
        run.write("KEY_LINEAR-Lattice.json", "precious")
        in_blender(run, blender, EXPORT, code=1, say=r"KEY_LINEAR-Lattice.json: exists already \(--force replaces it\)", arguments=["--out", "."], **exporting)
        equal(run.text("KEY_LINEAR-Lattice.json"), "precious")
        equal(set(run.names()), names | {"KEY_LINEAR-Lattice.json"})
        in_blender(run, blender, EXPORT, arguments=["--out", ".", "--object", "KEY_LINEAR", "--force"], **exporting)
        check("ffd-lattice" in run.text("KEY_LINEAR-Lattice.json"), "--force")
        in_blender(run, blender, EXPORT, code=1, say="nothing was written", arguments=["--out", "."])
        run.write("L.json", lattice())
        run.write("mesh.json", lattice(rest={"box": "mesh"}))
        run.write("bad.json", b"\xff")
        for arguments, code, what in (
                ([], 2, "required: LATTICE.json"), (["no.json"], 1, "no.json: No such file"), (["L.json", "--on", "nobody"], 1, 'no object "nobody"'), (["L.json", "--on", "KEY_LINEAR cage"], 1, "is not a mesh"),
                (["L.json", "--size", "3"], 2, "from 4 to 64"), (["mesh.json"], 1, "mesh.json: has a box round a mesh"), (["bad.json"], 1, "bad.json: is not UTF-8"), (["."], 1, "Is a directory")):
            in_blender(run, blender, IMPORT, code=code, say=what, arguments=arguments, **exporting)
        for which, pages in ((EXPORT, ("--frames", "--object", "--force", "--python-exit-code 1")), (IMPORT, ("--size", "--on", "--up"))):
            done = blender.run(run.folder, which, arguments=["--help"])
            check(done.returncode == 0 and all(page in done.stdout for page in pages), done.stdout)


@case
def what_is_skipped(run):
    """Each with a line: modifiers that are off or have no lattice, hidden objects, lattices without a size; the others are written."""
    for blender in BLENDERS:
        in_blender(run, blender, script("make_odd.py"), arguments=[run.folder])
        run.folder_of(blender.name)
        printed, told = in_blender(run, blender, EXPORT, scene="odd.blend", arguments=["--out", blender.name])
        for name, what in (("off", "is off"), ("without", "has no lattice"), ("hidden", 'skipped: "hidden" is hidden'), ("flat", "has the scale 0 along z"), ("edited", "its lattice is in edit mode")):
            equal([line for line in told if line.startswith(f"ffd_export: {name}, Lattice: skipped: ") and what in line][1:], [], name)
            check(any(line.startswith(f"ffd_export: {name}, Lattice: skipped: ") and what in line for line in told), name, str(told))
        check(any(line.startswith("ffd_export: behind, Lattice: stands behind other modifiers") for line in told), told)
        check(any('grouped, Lattice: the vertex group "g" of the lattice is not carried' in line for line in told), told)
        check(any('linked, Lattice: the mesh "linked" takes no attribute _ffd' in line for line in told), told)
        equal(len(told), 8, told)
        equal(sorted(run.names(blender.name)), sorted(f"{name}.json" for name in
              ("_dot-Lattice", "a_b-Lattice", "a_b-Lattice-2", "behind-Lattice", "empty-Lattice", "grouped-Lattice", "linked-Lattice", "several-Lattice", "several-Lattice.001", "several-_x_")))
        equal(len(printed), 10)
        check("--weight attribute:" in [line for line in printed if "several-Lattice.json" in line][0], printed)
        check(re.search(r"attribute:_+ffd_2\)", [line for line in printed if "several-Lattice.001.json" in line][0]), printed)
        # Another scene is chosen by Blender's own option.
        if blender.command[0] == programs.PROGRAM:
            done = blender.run(run.folder, EXPORT, scene="odd.blend", arguments=["--out", blender.name, "--object", "elsewhere"])
            check(done.returncode == 1 and 'the scene has no object "elsewhere"' in done.stderr, done.stderr)


main()
