"""Puts glTF files together for the tests, and lattices that are easily calculated."""

import struct

from gltf_asset import CODES, SIZES, GltfAsset
from harness import float32, glb, gltf_vectors, glb_split, lattice

# Everything within 10 of the origin by 1 along x; the volume is an affine map.
SHIFT = lattice(low=(-10, -10, -10), high=(10, 10, 10), moves=[{"by": [1, 0, 0]}])
# x' = x + 0.05 x y: what a point gets depends on where it is.
SHEAR = lattice(size=(2, 2, 2), low=(-10, -10, -10), high=(10, 10, 10),
                moves=[{"at": [i, j, "all"], "by": [0.05 * x * y, 0, 0]}
                       for i, x in enumerate((-10, 10)) for j, y in enumerate((-10, 10))])


class Scene(GltfAsset):
    """Puts a GLB together."""

    def add(self, rows, component=5126, shape="VEC3", bounds=False, **members):
        """A new accessor; its number."""
        if bounds:
            rows = [[float32(x) for x in row] for row in rows]
        data = b"".join(struct.pack(f"<{SIZES[shape]}{CODES[component]}", *row) for row in rows)
        return self.view_accessor(self.view(data), rows, shape, component, bounds, **members)

    def glb(self):
        self.asset["buffers"] = [{"byteLength": len(self.data)}]
        return glb(self.asset, self.data)


def vectors(file, accessor):
    return gltf_vectors(*glb_split(file), accessor)
