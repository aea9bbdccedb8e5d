#!/usr/bin/env python3
"""Makes models/knight.glb from KayKit's Knight.glb: without what the figure holds, and with one animation of 76.

    python3 make_knight.py Knight.glb [OUT]         default: models/knight.glb beside this script

What stays keeps its bytes: vertices, skin, texture. The original is in KayKit-Game-Assets/
KayKit-Character-Pack-Adventures-1.0, commit 672074b73b, Characters/gltf (Kay Lousberg, CC0-1.0).
"""

import json
import os
import struct
import sys

LEFT_OUT = {"1H_Sword", "1H_Sword_Offhand", "2H_Sword", "Badge_Shield", "Rectangle_Shield", "Round_Shield", "Spike_Shield"}
ANIMATION = "Idle"


def read(path):
    with open(path, "rb") as file:
        data = file.read()
    length = struct.unpack("<I", data[12:16])[0]
    return json.loads(data[20:20 + length]), data[28 + length:]


def renumber(numbers):
    """The old numbers in use, in their order, and the new number of each."""
    used = sorted(set(numbers))
    return used, {old: new for new, old in enumerate(used)}


def accessors_of(document):
    """(object, key) of every place that names an accessor."""
    for mesh in document["meshes"]:
        for primitive in mesh["primitives"]:
            yield primitive, "indices"
            yield from ((primitive["attributes"], name) for name in primitive["attributes"])
    for skin in document["skins"]:
        yield skin, "inverseBindMatrices"
    for animation in document["animations"]:
        for sampler in animation["samplers"]:
            yield sampler, "input"
            yield sampler, "output"


def drop_nodes(document):
    nodes = document["nodes"]
    used, new = renumber(i for i, node in enumerate(nodes) if node["name"] not in LEFT_OUT)
    document["nodes"] = [nodes[i] for i in used]
    for node in document["nodes"]:
        children = [new[i] for i in node.pop("children", ()) if i in new]
        if children:
            node["children"] = children
    document["scenes"][0]["nodes"] = [new[i] for i in document["scenes"][0]["nodes"]]
    document["skins"][0]["joints"] = [new[i] for i in document["skins"][0]["joints"]]
    document["animations"] = [one for one in document["animations"] if one["name"] == ANIMATION]
    for animation in document["animations"]:
        for channel in animation["channels"]:
            channel["target"]["node"] = new[channel["target"]["node"]]


def drop_meshes(document):
    showing = [node for node in document["nodes"] if "mesh" in node]
    used, new = renumber(node["mesh"] for node in showing)
    document["meshes"] = [document["meshes"][i] for i in used]
    for node in showing:
        node["mesh"] = new[node["mesh"]]


def drop_data(document, data):
    places = list(accessors_of(document))
    used, new = renumber(place[key] for place, key in places)
    for place, key in places:
        place[key] = new[place[key]]
    document["accessors"] = [document["accessors"][i] for i in used]
    holders = document["accessors"] + document["images"]
    used, new = renumber(holder["bufferView"] for holder in holders)
    kept = bytearray()
    views = []
    for view in (document["bufferViews"][i] for i in used):
        start = view.get("byteOffset", 0)
        views.append(dict(view, byteOffset=len(kept)))
        kept += data[start:start + view["byteLength"]]
        kept += bytes(-len(kept) % 4)
    for holder in holders:
        holder["bufferView"] = new[holder["bufferView"]]
    document["bufferViews"] = views
    document["buffers"] = [{"byteLength": len(kept)}]
    return bytes(kept)


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    default = os.path.join(os.path.dirname(os.path.abspath(__file__)), "models", "knight.glb")
    document, data = read(sys.argv[1])
    drop_nodes(document)
    drop_meshes(document)
    data = drop_data(document, data)
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    with open(sys.argv[2] if len(sys.argv) == 3 else default, "wb") as file:
        file.write(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(data)))
        file.write(struct.pack("<I4s", len(text), b"JSON") + text)
        file.write(struct.pack("<I4s", len(data), b"BIN\0") + data)


if __name__ == "__main__":
    main()
