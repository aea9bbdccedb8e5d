"""Puts glTF files together for the tests, and lattices that are easily calculated."""

import struct

from harness import glb, gltf_vectors, glb_split, lattice

CODES = {5120: "b", 5121: "B", 5123: "H", 5126: "f"}
WIDTHS = {"SCALAR": 1, "VEC3": 3, "VEC4": 4, "MAT4": 16}
# Everything within 10 of the origin by 1 along x; the volume is an affine map.
SHIFT = lattice(low=(-10, -10, -10), high=(10, 10, 10), moves=[{"by": [1, 0, 0]}])
# x' = x + 0.05 x y: what a point gets depends on where it is.
SHEAR = lattice(size=(2, 2, 2), low=(-10, -10, -10), high=(10, 10, 10),
                moves=[{"at": [i, j, "all"], "by": [0.05 * x * y, 0, 0]}
                       for i, x in enumerate((-10, 10)) for j, y in enumerate((-10, 10))])


class Scene:
    """Puts a GLB together."""

    def __init__(self, **members):
        self.data = b""
        self.asset = {"asset": {"version": "2.0"}, "bufferViews": [], "accessors": [], **members}

    def add(self, rows, component=5126, shape="VEC3", bounds=False, **members):
        """A new accessor; its number."""
        accessor = {"componentType": component, "type": shape, "count": len(rows), **members}
        if bounds:
            rows = [[struct.unpack("<f", struct.pack("<f", x))[0] for x in row] for row in rows]
            accessor.update({name: [edge(row[a] for row in rows) for a in range(3)]
                             for name, edge in (("min", min), ("max", max))})
        data = b"".join(struct.pack(f"<{WIDTHS[shape]}{CODES[component]}", *row) for row in rows)
        self.data += b"\0" * (-len(self.data) % 4)
        self.asset["bufferViews"].append({"buffer": 0, "byteOffset": len(self.data), "byteLength": len(data)})
        self.data += data
        self.asset["accessors"].append({"bufferView": len(self.asset["bufferViews"]) - 1, **accessor})
        return len(self.asset["accessors"]) - 1

    def glb(self):
        self.asset["buffers"] = [{"byteLength": len(self.data)}]
        return glb(self.asset, self.data)


def vectors(file, accessor):
    return gltf_vectors(*glb_split(file), accessor)
