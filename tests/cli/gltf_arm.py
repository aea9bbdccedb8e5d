"""A glTF file of an arm with two joints and two animations, whose poses are plain to work out."""

import base64
import struct

from gltf_asset import UBYTE, GltfAsset

TURN = [(0, 0, 0, 1), (0, 0, 0.7071067811865476, 0.7071067811865476)]
LIFT = [(0, 0, 0), (0, 0, 3)]


def accessor(asset, rows, kind, component=5126, **members):
    code = {5126: "f", 5121: "B"}[component]
    view = asset.view(b"".join(struct.pack(f"<{len(row)}{code}", *row) for row in rows))
    return asset.view_accessor(view, rows, kind, component, kind == "VEC3", **members)


def arm(names=("turn", "lift"), times=(0, 2), interpolation="LINEAR"):
    """A flat arm from (0, 0) to (2, 0), a fifth wide, whose lower half turns about (1, 0) by 90 degrees; a second animation
    lifts it all by 3 to z."""
    asset = GltfAsset(scene=0, scenes=[{"nodes": [0, 1]}], nodes=[
        {"mesh": 0, "skin": 0}, {"children": [2]}, {"translation": [1, 0, 0]}])
    places = [(x, y, 0) for x in (0, 1, 1.01, 2) for y in (-0.1, 0.1)]
    bones = [(0, 0, 0, 0)] * 4 + [(1, 0, 0, 0)] * 4
    binds = [(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1), (1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1)]
    corners = [c for x in range(0, 6, 2) for c in (x, x + 2, x + 3, x, x + 3, x + 1)]
    attributes = {"POSITION": accessor(asset, places, "VEC3"), "JOINTS_0": accessor(asset, bones, "VEC4", UBYTE),
                  "WEIGHTS_0": accessor(asset, [(1, 0, 0, 0)] * 8, "VEC4")}
    indices = accessor(asset, [(c,) for c in corners], "SCALAR", UBYTE)
    asset.asset["meshes"] = [{"primitives": [{"attributes": attributes, "indices": indices}]}]
    asset.asset["skins"] = [{"joints": [1, 2], "inverseBindMatrices": accessor(asset, binds, "MAT4")}]
    inputs = accessor(asset, [(t,) for t in times], "SCALAR")
    turns, lifts = TURN, LIFT
    if interpolation == "CUBICSPLINE":
        # Tangents before and behind each key: those beyond the ends are not looked at.
        turns = [q for key in TURN for q in ((0, 0, 0, 0), key, (0, 0, 0, 0))]
        lifts = [(0, 0, 99), LIFT[0], (0, 0, 1), (0, 0, -2), LIFT[1], (0, 0, 99)]
    outputs = accessor(asset, turns, "VEC4"), accessor(asset, lifts, "VEC3")
    asset.asset["animations"] = [
        {**({"name": name} if name else {}), "samplers": [{"input": inputs, "output": output, "interpolation": interpolation}],
         "channels": [{"sampler": 0, "target": {"node": node, "path": path}}]}
        for name, output, node, path in zip(names, outputs, (2, 1), ("rotation", "translation"))]
    asset.asset["buffers"] = [{"byteLength": len(asset.data), "uri": "data:application/octet-stream;base64,"
                               + base64.b64encode(asset.data).decode()}]
    return asset.asset


def face(names, weights=None):
    """The arm, whose skin has two targets of these names: one that lifts, one that widens it; beside a mesh under a turned
    node that has a target of the first name. weights: the default ones, of each mesh."""
    asset = GltfAsset()
    asset.asset = arm()
    asset.data = base64.b64decode(asset.asset["buffers"][0]["uri"].split(",")[1])
    up = [(0, 0, 0.25 * (v % 3)) for v in range(8)]
    wide = [(0, 0.5 if v % 2 else -0.5, 0) for v in range(8)]
    mesh = asset.asset["meshes"][0]
    mesh["primitives"][0]["targets"] = [{"POSITION": accessor(asset, rows, "VEC3")} for rows in (up, wide)]
    mesh["extras"] = {"targetNames": list(names)}
    places = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
    lifted = accessor(asset, [(0, 0, 0), (0, 0, 0), (0, 1, 0.5), (0, 0, 0)], "VEC3")
    asset.asset["meshes"].append({"primitives": [{"attributes": {"POSITION": accessor(asset, places, "VEC3")}, "targets": [{"POSITION": lifted}],
                                                  "indices": accessor(asset, [(c,) for c in (0, 1, 2, 0, 3, 1)], "SCALAR", UBYTE)}],
                                  "extras": {"targetNames": list(names[:1])}})
    asset.asset["nodes"].append({"mesh": 1, "translation": [1, 1, 0], "rotation": [0, 0, 0.6, 0.8], "scale": [1, 2, 1]})
    asset.asset["scenes"][0]["nodes"].append(len(asset.asset["nodes"]) - 1)
    for number, one in enumerate(asset.asset["meshes"]):
        if weights:
            one["weights"] = weights[number]
    asset.asset["buffers"] = [{"byteLength": len(asset.data), "uri": "data:application/octet-stream;base64,"
                               + base64.b64encode(asset.data).decode()}]
    return asset.asset
