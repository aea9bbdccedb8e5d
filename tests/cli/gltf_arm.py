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
