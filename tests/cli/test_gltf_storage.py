#!/usr/bin/env python3
"""How glTF stores what is deformed: sparse accessors, accessors without bytes, in every container."""
import base64
import itertools
import json
import struct

from gltf_reader import FLOAT, TYPES, Gltf, check_bounds, check_rest
from harness import LIMIT, case, check, equal, glb, lattice, main, near, pad

POINTS = [(-1.0, -1.0, -0.5), (1.0, -1.0, 0.25), (-1.0, 1.0, 0.5), (1.0, 1.0, 0.0), (0.0, 0.5, 1.0), (0.0, 0.0, 0.0)]
SHIFT = (0.25, -0.5, 0.125)
ALL = lattice(moves=[{"by": list(SHIFT)}])
NONE = lattice(moves=[{"by": [0, 0, 0]}])
# A corner of the lattice: what is far from it stays.
CORNER = lattice(size=(8, 8, 8), low=(-1.5,) * 3, high=(1.5,) * 3,
                 moves=[{"at": [[5, 7], [5, 7], [3, 7]], "by": [0.5, 0.25, -0.5]}])
CONTAINERS = ("glb", "bin", "data")


class Maker:
    """A glTF asset in one buffer, piece by piece."""

    def __init__(self, **top):
        self.data = b""
        self.asset = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
                      "meshes": [], **top, "accessors": []}

    def view(self, data, **members):
        self.data = pad(self.data, b"\xee")
        views = self.asset.setdefault("bufferViews", [])
        views.append({"buffer": 0, "byteOffset": len(self.data), "byteLength": len(data), **members})
        self.data += data
        return len(views) - 1

    def accessor(self, count, component=FLOAT, kind="VEC3", **members):
        self.asset["accessors"].append({"componentType": component, "count": count, "type": kind, **members})
        return len(self.asset["accessors"]) - 1

    def dense(self, elements, component=FLOAT, kind="VEC3", **members):
        data = packed(elements, component)
        return self.accessor(len(elements), component, kind, bufferView=self.view(data), **members)

    def sparse(self, values, indices=5123, component=FLOAT):
        """The "sparse" of an accessor; values: of the elements that it names."""
        where = self.view(packed([(i,) for i in values], indices))
        return {"count": len(values), "indices": {"bufferView": where, "componentType": indices},
                "values": {"bufferView": self.view(packed(values.values(), component))}}

    def mesh(self, *primitives):
        self.asset["meshes"].append({"primitives": [{"attributes": p, "mode": 0} for p in primitives]})

    def write(self, run, name, container):
        """Returns the file's name."""
        if not self.data:
            equal("bufferViews" in self.asset, False, "views without bytes")
            if container == "glb":
                text = pad(json.dumps(self.asset).encode(), b" ")
                file = struct.pack("<III", 0x46546C67, 2, 20 + len(text)) + struct.pack("<II", len(text), 0x4E4F534A)
                return run.write(name + ".glb", file + text)
            return run.write(name + ".gltf", self.asset)
        buffer = {"byteLength": len(self.data)}
        asset = {**self.asset, "buffers": [buffer]}
        if container == "glb":
            return run.write(name + ".glb", glb(asset, self.data))
        if container == "bin":
            buffer["uri"] = run.write(name + "-data.bin", self.data)
        else:
            buffer["uri"] = "data:application/gltf-buffer;base64," + base64.b64encode(self.data).decode()
        return run.write(name + ".gltf", asset)


def packed(elements, component):
    code = TYPES[component][0]
    return b"".join(struct.pack(f"<{len(element)}{code}", *element) for element in elements)


def bounds(elements):
    return {"min": [min(column) for column in zip(*elements)], "max": [max(column) for column in zip(*elements)]}


def deform(run, source, content=ALL, options=(), lines=0):
    """Deforms a file; both as Gltf. Whatever is changed, what must stay does."""
    run.write("l.json", content)
    target = "out" + source[source.rindex("."):]
    done = run.ffd("deform", source, target, "-l", "l.json", "--force", "--normals", "keep", *options, lines=lines)
    before, after = Gltf(run.path(source)), Gltf(run.path(target))
    check_rest(before, after)
    for index in range(len(after.asset["accessors"])):
        check_bounds(after, index)
    return before, after, done.err


def check_unmoved(run, source):
    before, after, _ = deform(run, source, NONE)
    if source.endswith(".glb") or before.asset == after.asset:
        equal(after.bytes, before.bytes, "nothing moved")
    equal(after.buffers, before.buffers, "nothing moved: buffers")


def shifted(points):
    return [tuple(x + d for x, d in zip(p, SHIFT)) for p in points]


def sparse_kinds(maker, indices):
    """name -> accessor, all of them of POINTS."""
    half = {i: POINTS[i] for i in (1, 3, 4)}
    base = [(9.0, 9.0, 9.0) if i in half else p for i, p in enumerate(POINTS)]
    most = {i: p for i, p in enumerate(POINTS) if p != (0.0, 0.0, 0.0)}
    extent = bounds(POINTS)
    yield maker.dense(base, sparse=maker.sparse(half, indices), **extent)
    yield maker.accessor(len(POINTS), sparse=maker.sparse(most, indices), **extent)
    # The same with its members in another order.
    maker.asset["accessors"].append({"sparse": maker.sparse(most, indices), "type": "VEC3", "count": len(POINTS),
                                     **extent, "componentType": FLOAT, "name": "last", "extras": {"sparse": 1}})
    yield len(maker.asset["accessors"]) - 1


@case
def sparse_positions_become_dense(run):
    for container, indices in itertools.product(CONTAINERS, (5121, 5123, 5125)):
        maker = Maker()
        accessors = list(sparse_kinds(maker, indices))
        maker.mesh(*({"POSITION": a} for a in accessors))
        source = maker.write(run, "in", container)
        before, after, _ = deform(run, source)
        for old, primitive in zip(accessors, after.primitives(), strict=True):
            new = primitive["attributes"]["POSITION"]
            near(before.decoded(old), POINTS, 0, "the crafted points")
            near(after.decoded(new), shifted(POINTS), 1e-6, "positions")
            copy = after.accessor(new)
            check("sparse" not in copy and "bufferView" in copy, "the copy is not dense")
            equal(copy.get("extras"), before.accessor(old).get("extras"), "extras")
            equal(after.asset["bufferViews"][copy["bufferView"]].get("target"),
                  None if "bufferView" in before.accessor(old) else 34962, "target")
        # A vertex that does not move keeps its bits in the copy too.
        before, after, _ = deform(run, source, CORNER)
        for old, primitive in zip(accessors, after.primitives(), strict=True):
            a, b = before.stored(old), after.stored(primitive["attributes"]["POSITION"])
            equal(a[0], b[0], "the vertex in the far corner")
            check(a[3] != b[3], "the vertex in the near corner does not move")
        check_unmoved(run, source)


@case
def zeros_without_bytes(run):
    """An accessor without bufferView and sparse is all zeros; its results need a buffer, perhaps the first."""
    zeros = [(0.0, 0.0, 0.0)] * 3
    for container, alone in itertools.product(CONTAINERS, (True, False)):
        maker = Maker()
        empty = maker.accessor(3, name="nothing", **bounds(zeros))
        primitives = [{"POSITION": empty}]
        if not alone:
            primitives.append({"POSITION": maker.dense(POINTS, **bounds(POINTS))})
        maker.mesh(*primitives)
        source = maker.write(run, "in", container)
        before, after, _ = deform(run, source)
        new = after.primitives()[0]["attributes"]["POSITION"]
        near(after.decoded(new), shifted(zeros), 1e-6, "positions")
        equal(len(after.asset["buffers"]), 1, "buffers")
        if alone:
            equal(len(before.buffers), 0, "buffers before")
            equal(after.bin is not None, container == "glb", "a BIN chunk")
            uri = after.asset["buffers"][0].get("uri", "")
            equal(uri[:5], "" if container == "glb" else "data:", "the new buffer")
        check_unmoved(run, source)


@case
def a_new_buffer_beside_others(run):
    """Where no buffer has bytes of its own, one is added: as BIN only where it comes first."""
    unused = {"byteLength": 16, "name": "no bytes here"}
    for asset, is_bin in (({}, True), ({"buffers": []}, True), ({"buffers": [unused]}, False)):
        maker = Maker(**asset)
        maker.mesh({"POSITION": maker.accessor(2, **bounds([(0, 0, 0)]))})
        for container in ("glb", "data"):
            source = maker.write(run, "in", container)
            _, after, _ = deform(run, source)
            number = len(asset.get("buffers", []))
            equal(len(after.asset["buffers"]), number + 1, "buffers")
            equal("uri" in after.asset["buffers"][number], not (is_bin and container == "glb"), "a URI")
            near(after.decoded(after.primitives()[0]["attributes"]["POSITION"]), [SHIFT, SHIFT], 1e-6)
    # To standard output too.
    run.write("l.json", ALL)
    done = run.ffd("deform", "in.gltf", "-", "--output-format", "gltf", "-l", "l.json")
    run.write("out.gltf", done.out)
    after = Gltf(run.path("out.gltf"))
    near(after.decoded(after.primitives()[0]["attributes"]["POSITION"]), [SHIFT, SHIFT], 1e-6)


@case
def too_many_zeros(run):
    run.write("l.json", ALL)
    for count in (1 << 24, 1 << 31, 1 << 52):
        maker = Maker()
        maker.mesh({"POSITION": maker.accessor(count)})
        source = maker.write(run, "in", "data")
        run.ffd("deform", source, "out.gltf", "-l", "l.json", code=LIMIT)


main()
