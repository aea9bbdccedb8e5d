"""The meshes that are deformed: wavy squares of side x side vertices with normals, as GLB, OBJ or PLY; without, as OFF."""

import array
import json
import math
import os
import random
import struct
import sys
import zlib


def surface(side):
    """Positions and unit normals, as flat lists of floats."""
    step = 10.0 / (side - 1)
    sine = [math.sin(2.1 * i * step) for i in range(side)]
    cosine = [math.cos(2.1 * i * step) for i in range(side)]
    positions, normals = array.array("f"), array.array("f")
    for j in range(side):
        y = j * step
        for i in range(side):
            positions.extend((i * step, y, sine[i] * cosine[j]))
            dx, dy = 2.1 * cosine[i] * cosine[j], -2.1 * sine[i] * sine[j]
            size = math.sqrt(dx * dx + dy * dy + 1)
            normals.extend((-dx / size, -dy / size, 1 / size))
    return positions, normals


def quads(side):
    for j in range(side - 1):
        for i in range(side - 1):
            a = j * side + i
            yield a, a + 1, a + side + 1, a + side


def triangles(side):
    indices = array.array("I")
    for a, b, c, d in quads(side):
        indices.extend((a, b, c, a, c, d))
    return indices


def tangents_of(normals):
    """Along x, with a handedness of 1."""
    tangents = array.array("f")
    for k in range(0, len(normals), 3):
        x, z = normals[k + 2], -normals[k]
        size = math.hypot(x, z)
        tangents.extend((x / size, 0, z / size, 1))
    return tangents


def gltf_of(streams, indices):
    """The JSON of a scene with one mesh; streams: name, type and values of each attribute, positions first."""
    names, kinds, values = zip(*streams)
    positions = values[0]
    bounds = {"min": [min(positions[a::3]) for a in range(3)], "max": [max(positions[a::3]) for a in range(3)]}
    sizes = [len(part) * part.itemsize for part in (*values, indices)]
    last = len(streams)
    return {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {name: i for i, name in enumerate(names)}, "indices": last}]}],
        "accessors": [
            {"bufferView": i, "componentType": 5126, "count": len(positions) // 3, "type": kind,
             **(bounds if i == 0 else {})}
            for i, kind in enumerate(kinds)
        ] + [{"bufferView": last, "componentType": 5125, "count": len(indices), "type": "SCALAR"}],
        "bufferViews": [
            {"buffer": 0, "byteOffset": sum(sizes[:i]), "byteLength": size, "target": 34962 if i < last else 34963}
            for i, size in enumerate(sizes)
        ],
        "buffers": [{"byteLength": sum(sizes)}],
    }


def write_streams(path, side, streams):
    indices = triangles(side)
    document = gltf_of(streams, indices)
    bytes_in_all = document["buffers"][0]["byteLength"]
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    with open(path, "wb") as file:
        file.write(struct.pack("<4sII", b"glTF", 2, 12 + 8 + len(text) + 8 + bytes_in_all))
        file.write(struct.pack("<I4s", len(text), b"JSON") + text)
        file.write(struct.pack("<I4s", bytes_in_all, b"BIN\0"))
        for part in [values for _, _, values in streams] + [indices]:
            part.tofile(file)


def write_glb(path, side):
    positions, normals = surface(side)
    write_streams(path, side, [("POSITION", "VEC3", positions), ("NORMAL", "VEC3", normals)])


def write_glb_with_tangents(path, side):
    positions, normals = surface(side)
    write_streams(path, side, [("POSITION", "VEC3", positions), ("NORMAL", "VEC3", normals),
                               ("TANGENT", "VEC4", tangents_of(normals))])


def write_weighted_glb(path, side, has_normals):
    """The surface with a weight for each vertex, _FFD."""
    positions, normals = surface(side)
    weights = array.array("f", (0.5 + 0.5 * math.sin(0.01 * i + 0.02 * j) for j in range(side) for i in range(side)))
    write_streams(path, side, [("POSITION", "VEC3", positions), *([("NORMAL", "VEC3", normals)] if has_normals else []),
                               ("_FFD", "SCALAR", weights)])


def write_png(side):
    """Waves of colours with grain: what a painted texture compresses to, about 2.5 bytes a pixel."""
    grain = random.Random(1)
    wave = [int(100 + 80 * math.sin(0.05 * i)) for i in range(side)]
    rows = (b"\0" + bytes(c for i in range(side) for c in (wave[i] + grain.getrandbits(4), wave[j] + grain.getrandbits(4), wave[(i + j) % side]))
            for j in range(side))
    chunks = ((b"IHDR", struct.pack(">IIBBBBB", side, side, 8, 2, 0, 0, 0)), (b"IDAT", zlib.compress(b"".join(rows), 6)), (b"IEND", b""))
    return b"\x89PNG\r\n\x1a\n" + b"".join(struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
                                          for kind, data in chunks)


def write_textured(path, side, images, pixels):
    """The surface with so many images of pixels x pixels, beside path as image-0.png ..: a material each, of a run of its rows.
    images 0: no material, and no coordinates."""
    positions, normals = surface(side)
    texcoords = array.array("f", (x for j in range(side) for i in range(side) for x in (i / (side - 1), j / (side - 1))))
    indices = triangles(side)
    streams = [("POSITION", "VEC3", positions), ("NORMAL", "VEC3", normals)] + ([("TEXCOORD_0", "VEC2", texcoords)] if images else [])
    document = gltf_of(streams, indices)
    data = b"".join(part.tobytes() for _, _, part in streams) + indices.tobytes()
    document["buffers"] = [{"byteLength": len(data), "uri": os.path.basename(path) + ".bin"}]
    with open(path + ".bin", "wb") as file:
        file.write(data)
    if images:
        add_materials(document, path, images, pixels)
    with open(path, "w", encoding="ascii") as file:
        json.dump(document, file)


def add_materials(document, path, images, pixels):
    """A primitive and a material for each run of triangles."""
    (mesh,) = document["meshes"]
    whole, count = mesh["primitives"][0], document["accessors"][-1]["count"] // 3
    mesh["primitives"] = []
    for i in range(images):
        first, end = 3 * (count * i // images), 3 * (count * (i + 1) // images)
        document["accessors"].append({**document["accessors"][whole["indices"]], "byteOffset": 4 * first, "count": end - first})
        mesh["primitives"].append({**whole, "indices": len(document["accessors"]) - 1, "material": i})
        with open(os.path.join(os.path.dirname(path), f"image-{i}.png"), "wb") as file:
            file.write(write_png(pixels))
    document["materials"] = [{"pbrMetallicRoughness": {"baseColorTexture": {"index": i}}} for i in range(images)]
    document["textures"] = [{"source": i} for i in range(images)]
    document["images"] = [{"uri": f"image-{i}.png"} for i in range(images)]


def obj_lines(side, corner):
    """Lines of v, vt, vn and quads; corner gives the number that a face has for a vertex."""
    positions, normals = surface(side)
    for k in range(0, 3 * side * side, 3):
        yield "v %.6f %.6f %.6f\n" % (positions[k], positions[k + 1], positions[k + 2])
    for j in range(side):
        for i in range(side):
            yield "vt %.5f %.5f\n" % (i / (side - 1), j / (side - 1))
    for k in range(0, 3 * side * side, 3):
        yield "vn %.5f %.5f %.5f\n" % (normals[k], normals[k + 1], normals[k + 2])
    for quad in quads(side):
        yield "f %d/%d/%d %d/%d/%d %d/%d/%d %d/%d/%d\n" % tuple(corner(k) for k in quad for _ in range(3))


def write_obj(path, side):
    with open(path, "w", encoding="ascii", buffering=1 << 22) as file:
        file.writelines(obj_lines(side, lambda k: k + 1))


def write_large_obj(path, side, size):
    """As many squares one after another as make size bytes. Their faces count backwards, so that all are the same text,
    which is made once."""
    text = "".join(obj_lines(side, lambda k: k - side * side)).encode("ascii")
    with open(path, "wb") as file:
        for _ in range(math.ceil(size / len(text))):
            file.write(text)


PLY_HEAD = """ply
format {} 1.0
element vertex {}
property float x
property float y
property float z
property float nx
property float ny
property float nz
element face {}
property list uchar int vertex_indices
end_header
"""


def write_ply(path, side):
    positions, normals = surface(side)
    indices = triangles(side)
    with open(path, "w", encoding="ascii", buffering=1 << 22) as file:
        file.write(PLY_HEAD.format("ascii", side * side, len(indices) // 3))
        for k in range(0, len(positions), 3):
            file.write("%.6f %.6f %.6f %.5f %.5f %.5f\n" % (*positions[k:k + 3], *normals[k:k + 3]))
        file.writelines("3 %d %d %d\n" % tuple(indices[k:k + 3]) for k in range(0, len(indices), 3))


def write_binary_ply(path, side):
    positions, normals = surface(side)
    indices = triangles(side)
    with open(path, "wb", buffering=1 << 22) as file:
        file.write(PLY_HEAD.format("binary_little_endian", side * side, len(indices) // 3).encode("ascii"))
        for k in range(0, len(positions), 3):
            file.write(struct.pack("<6f", *positions[k:k + 3], *normals[k:k + 3]))
        for k in range(0, len(indices), 3):
            file.write(struct.pack("<B3i", 3, *indices[k:k + 3]))


# What 3D Gaussian splatting writes, with harmonics up to degree 3.
SPLAT_NAMES = (["f_dc_0", "f_dc_1", "f_dc_2"] + [f"f_rest_{i}" for i in range(45)] + ["opacity", "scale_0", "scale_1", "scale_2"]
               + [f"rot_{i}" for i in range(4)])


def write_splats(path, side, are_splats):
    """Vertices of 62 floats: Gaussian splats, or with other names for all but the positions and normals."""
    positions, normals = surface(side)
    names = SPLAT_NAMES if are_splats else [f"value_{i}" for i in range(len(SPLAT_NAMES))]
    tails = [struct.pack("<56f", *(math.sin(7 * i + k) - (4 if 49 <= k < 52 else 0) for k in range(56))) for i in range(97)]
    with open(path, "wb", buffering=1 << 22) as file:
        file.write(("ply\nformat binary_little_endian 1.0\nelement vertex %d\n" % (side * side)
                    + "".join(f"property float {name}\n" for name in ["x", "y", "z", "nx", "ny", "nz", *names])
                    + "end_header\n").encode("ascii"))
        for k in range(0, len(positions), 3):
            normal = (0, 0, 0) if are_splats else normals[k:k + 3]
            file.write(struct.pack("<6f", *positions[k:k + 3], *normal) + tails[k // 3 % len(tails)])


def write_off(path, side):
    positions, _ = surface(side)
    indices = triangles(side)
    with open(path, "w", encoding="ascii", buffering=1 << 22) as file:
        file.write(f"OFF\n{side * side} {len(indices) // 3} 0\n")
        file.writelines("%.6f %.6f %.6f\n" % tuple(positions[k:k + 3]) for k in range(0, len(positions), 3))
        file.writelines("3 %d %d %d\n" % tuple(indices[k:k + 3]) for k in range(0, len(indices), 3))


def write_points(path, count):
    with open(path, "w", encoding="ascii") as file:
        file.writelines(f"v {i % 10} {i // 10} 0.5\n" for i in range(count))


def make(path, write, *arguments):
    """In a process of its own: what this one has held would count in the peak of the programs that it starts."""
    child = os.fork()
    if child == 0:
        code = 1
        try:
            write(path, *arguments)
            code = 0
        finally:
            os._exit(code)
    if os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) != 0:
        sys.exit(f"could not make {path}")
