"""Runs --rig follow on a rig and holds what comes out against what is known, at many times."""

import math

from cases import text
from harness import check, equal, float32
from matrices import apply
from pose import Rig, largest_difference, size_of
from messages import anything, entry

TIMES = 20
CLOSE = 2e-6  # of the size: keys, positions and inverse binds are single precision


def options_of(deformation):
    found = ["--blocks"] if deformation.blocks else []
    if deformation.extend:
        found += ["--outside", "extend"]
    return found + (["--falloff", repr(deformation.falloff)] if deformation.falloff else [])


def deformed(run, arm, deformation, *options, rig="follow", out="b.glb", **more):
    """Before and after, and the report's job. arm: what builds a GLB."""
    run.write("a.glb", arm.glb())
    chosen = []
    for number, volume in enumerate(deformation.volumes):
        chosen += ["-l", run.write(f"l{number}.json", text(volume))]
    chosen += ["--rig", rig] if rig else []
    job = entry(run, "deform", "a.glb", out, *chosen, *options_of(deformation), *options, **{"err": anything, **more})
    return Rig(run.path("a.glb")), Rig(run.path(out)), job


def poses(rig, count=TIMES):
    return [(None, 0.0)] + [(a, t) for a in range(len(rig.animations)) for t in rig.times(a, count)]


def carried(map_, positions):
    return {key: [map_(p) for p in points] for key, points in positions.items()}


def moves_as_one(before, after, map_, close=CLOSE, name="a rig"):
    """Every vertex at all times stands where an affine map takes it."""
    size = size_of(carried(map_, before.vertices()))
    for pose in poses(before):
        wanted = carried(map_, before.vertices(*pose))
        off = largest_difference(wanted, after.vertices(*pose)) / size
        check(off <= close, f"{name} at {pose}: a vertex is off by {off:.3g} of the size")


def moves_as(expected, after, close=CLOSE, name="a rig", count=TIMES):
    """Every vertex, and every node, stands at all times where another rig has it."""
    size = size_of(expected.vertices())
    for pose in poses(expected, count):
        off = largest_difference(expected.vertices(*pose), after.vertices(*pose)) / size
        check(off <= close, f"{name} at {pose}: a vertex is off by {off:.3g} of the size")
        for node, a, b in zip(expected.nodes, expected.worlds(*pose), after.worlds(*pose)):
            far = max(abs(x - y) for x, y in zip(a, b)) / size
            check(far <= close, f"{name} at {pose}: node {node.name} is off by {far:.3g} of the size")


def has_turned(before, after, map_):
    """Cameras, lights and sockets stand where an orthogonal map takes them, and are turned by it."""
    for pose in poses(before):
        for node, a, b in zip(before.nodes, before.worlds(*pose), after.worlds(*pose)):
            if not node.children and node.skin is None:
                wanted = [apply(map_, p) for p in ((a[3], a[7], a[11]), (a[0] + a[3], a[4] + a[7], a[8] + a[11]))]
                found = [(b[3], b[7], b[11]), (b[0] + b[3], b[4] + b[7], b[8] + b[11])]
                check(max(map(math.dist, wanted, found)) <= 1e-5, f"at {pose} {node.name}")


PARTS = ("translation", "rotation", "scale", "matrix")


def is_kept(before, after):
    """What follow has no business with is as it was: names, hierarchy, scales, keys, interpolation."""
    old, new = before.asset, after.asset
    for a, b in zip(old["nodes"], new["nodes"], strict=True):
        equal({k: v for k, v in b.items() if k not in (*PARTS, "mesh")}, {k: v for k, v in a.items() if k not in (*PARTS, "mesh")})
        equal(b.get("scale"), a.get("scale"), f"scale of {a.get('name')}")
        equal("matrix" in b, "matrix" in a, f"{a.get('name')} keeps its kind")
        check(all(-1 <= x <= 1 for x in b.get("rotation", [])), f"rotation of {a.get('name')} within [-1, 1]")
    equal([s["joints"] for s in new.get("skins", [])], [s["joints"] for s in old.get("skins", [])], "joints")
    for a, b in zip(old.get("animations", []), new.get("animations", []), strict=True):
        equal([c["target"] for c in b["channels"]], [c["target"] for c in a["channels"]], "targets of channels")
        for c, d in zip(a["channels"], b["channels"]):
            s, t = a["samplers"][c["sampler"]], b["samplers"][d["sampler"]]
            equal([t["input"], t.get("interpolation")], [s["input"], s.get("interpolation")], "a sampler")
            equal(new["accessors"][t["output"]]["count"], old["accessors"][s["output"]]["count"], "keys")
    bounds_are_right(after)


def bounds_are_right(rig):
    for number, accessor in enumerate(rig.asset.get("accessors", [])):
        if "min" in accessor and accessor["componentType"] == 5126 and accessor["type"] != "MAT4":
            columns = list(zip(*rig.file.stored(number)))
            for key, edge in (("min", min), ("max", max)):
                equal([edge(c) for c in columns], [float32(x) for x in accessor[key]], f"{key} of accessor {number}")
