"""Plays the morph target animations of a GLB whose nodes have no transforms: places of vertices at a time."""

import struct

from harness import check, equal, float32, glb_split, gltf_vectors


def vectors(asset, data, number):
    """The vectors of an accessor of floats, which may be sparse or have no bytes at all."""
    accessor = asset["accessors"][number]
    rows = gltf_vectors(asset, data, number) if "bufferView" in accessor else [[0.0] * 3] * accessor["count"]
    sparse = accessor.get("sparse")
    if sparse:
        indices, values = ({**part, "count": sparse["count"]} for part in (sparse["indices"], sparse["values"]))
        code = {5121: "B", 5123: "H", 5125: "I"}[indices["componentType"]]
        at = [asset["bufferViews"][part["bufferView"]].get("byteOffset", 0) + part.get("byteOffset", 0) for part in (indices, values)]
        places = struct.unpack_from(f"<{sparse['count']}{code}", data, at[0])
        floats = struct.unpack_from(f"<{3 * sparse['count']}f", data, at[1])
        rows = list(rows)
        for k, place in enumerate(places):
            rows[place] = list(floats[3 * k:3 * k + 3])
    return rows


def scalars(asset, data, number):
    accessor = asset["accessors"][number]
    begin = asset["bufferViews"][accessor["bufferView"]].get("byteOffset", 0) + accessor.get("byteOffset", 0)
    return list(struct.unpack_from(f"<{accessor['count']}f", data, begin))


class Played:
    """The animation of a name, of the mesh of a node."""

    def __init__(self, file, name, node=0):
        self.asset, self.data = glb_split(file)
        self.mesh = self.asset["meshes"][self.asset["nodes"][node]["mesh"]]
        self.names = self.mesh.get("extras", {}).get("targetNames", [])
        found, = [animation for animation in self.asset["animations"] if animation["name"] == name]
        channel, = [channel for channel in found["channels"] if channel["target"] == {"node": node, "path": "weights"}]
        sampler = found["samplers"][channel["sampler"]]
        equal(sampler["interpolation"], "LINEAR")
        self.times = scalars(self.asset, self.data, sampler["input"])
        accessor = self.asset["accessors"][sampler["input"]]
        equal([[float32(accessor[end][0]) for end in ("min", "max")], accessor["type"]], [[self.times[0], self.times[-1]], "SCALAR"])
        check(all(a < b for a, b in zip(self.times, self.times[1:])), "times rise")
        count = len(self.mesh["primitives"][0]["targets"])
        values = scalars(self.asset, self.data, sampler["output"])
        equal(len(values), count * len(self.times), "keys x targets")
        self.rows = [values[i:i + count] for i in range(0, len(values), count)]

    def target(self, number, attribute="POSITION", primitive=0):
        return vectors(self.asset, self.data, self.mesh["primitives"][primitive]["targets"][number][attribute])

    def weights(self, time):
        if time <= self.times[0] or len(self.times) == 1:
            return self.rows[0]
        if time >= self.times[-1]:
            return self.rows[-1]
        k = max(i for i, t in enumerate(self.times) if t <= time)
        s = (time - self.times[k]) / (self.times[k + 1] - self.times[k])
        return [(1 - s) * a + s * b for a, b in zip(self.rows[k], self.rows[k + 1])]

    def places(self, time, primitive=0):
        part = self.mesh["primitives"][primitive]
        places = [list(p) for p in vectors(self.asset, self.data, part["attributes"]["POSITION"])]
        for number, weight in enumerate(self.weights(time)):
            if weight:
                for place, offset in zip(places, self.target(number, primitive=primitive)):
                    for a in range(3):
                        place[a] += weight * offset[a]
        return places
