#!/usr/bin/env python3
"""How glTF stores what is deformed: sparse accessors, accessors without bytes, integers of every type, in every
container. What integers must become is taken from a twin of the file that has floats instead."""
import base64
import copy
import itertools
import json
import os
import struct

from gltf_reader import (DEFORMED, FLOAT, SCALES, TYPES, Gltf, attribute_sets, check_bounds, check_rest,
                         deformed_accessors)
from harness import LIMIT, MODELS, OK, UNSUPPORTED, announce, case, check, equal, glb, lattice, main, near, pad, threaded_case
from messages import anything

announce("(camera|light)s? stays? where|off the deformed mesh")
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


def deform(run, source, content=ALL, normals="keep", options=(), lines=0):
    """Deforms a file; both as Gltf. Whatever is changed, what must stay does."""
    run.write("l.json", content)
    target = "out" + source[source.rindex("."):]
    done = run.ffd("deform", source, target, "-l", "l.json", "--force", "--normals", normals, *options, err=anything)
    said = [line for line in done.err if "no vertex moves" not in line and "rounded to the steps" not in line]
    equal(len(said), lines, f"lines of {done.err}")
    before, after = Gltf(run.path(source)), Gltf(run.path(target))
    check_rest(before, after)
    for index in range(len(after.asset["accessors"])):
        check_bounds(after, index)
    return before, after, said


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
def zeros_without_bytes_get_a_buffer(run):
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
    # Into the other container, to standard output, and beside a BIN chunk that no buffer names.
    run.write("l.json", ALL)
    maker = Maker()
    maker.mesh({"POSITION": maker.accessor(2, **bounds([(0, 0, 0)]))})
    for source, target in (("glb", "gltf"), ("data", "glb")):
        run.ffd("deform", maker.write(run, "in", source), "turned." + target, "-l", "l.json")
        after = Gltf(run.path("turned." + target))
        near(after.decoded(after.primitives()[0]["attributes"]["POSITION"]), [SHIFT, SHIFT], 1e-6)
        equal((len(after.buffers), after.bin is not None), (1, target == "glb"), "the new buffer")
    run.write("unused.glb", glb(maker.asset, b"nobody's"))
    _, after, _ = deform(run, "unused.glb")
    equal((after.bin, after.asset["buffers"][0]["uri"][:5]), (b"nobody's", "data:"), "the chunk")
    near(after.decoded(after.primitives()[0]["attributes"]["POSITION"]), [SHIFT, SHIFT], 1e-6)
    run.write("out.gltf", run.ffd("deform", "in.gltf", "-", "--output-format", "gltf", "-l", "l.json").out)
    after = Gltf(run.path("out.gltf"))
    near(after.decoded(after.primitives()[0]["attributes"]["POSITION"]), [SHIFT, SHIFT], 1e-6)


@threaded_case
def too_many_zeros_are_refused(run):
    run.write("l.json", ALL)
    for count, code in ((1 << 20, OK), (1 << 23, LIMIT), (1 << 31, LIMIT), (1 << 52, LIMIT)):
        maker = Maker()
        maker.mesh({"POSITION": maker.accessor(count)})
        source = maker.write(run, "in", "data")
        run.ffd("deform", source, "out.gltf", "-l", "l.json", "--force", code=code, err=anything)


QUANTIZED = {"extensionsUsed": ["KHR_mesh_quantization"], "extensionsRequired": ["KHR_mesh_quantization"]}
INTEGERS = tuple(itertools.product((5120, 5121, 5122, 5123), (False, True)))
SINGLE = 2.0 ** -24


def limits(component):
    bits = 8 * TYPES[component][1]
    return (0, 2 ** bits - 1) if component in (5121, 5123) else (-2 ** (bits - 1), 2 ** (bits - 1) - 1)


def integers(component, reach):
    """Points of a type; reach: how much of its range they use."""
    low, high = limits(component)
    middle, half = (low + high) / 2, (high - low) / 2 * reach
    return [tuple(round(middle + half * x) for x in p) for p in POINTS]


def in_scene(component, normalized):
    """The node that brings the type's range to the box [-1, 1]."""
    low, high = limits(component)
    unit = SCALES[component] if normalized else 1
    scale = 2 * unit / (high - low)
    return {"mesh": 0, "scale": [scale] * 3, "translation": [-(low + high) / 2 * scale / unit] * 3}


def float_twin(run, source, name):
    """The same scene with floats for every deformed accessor."""
    file = Gltf(source)
    asset = copy.deepcopy(file.asset)
    for buffer, data in zip(asset.get("buffers", []), file.buffers):
        if data is not None:
            buffer["uri"] = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
    data, twins = b"", {}
    views = asset.setdefault("bufferViews", [])
    buffers = asset.setdefault("buffers", [])
    for index in sorted(deformed_accessors(file.asset)):
        elements = packed(file.decoded(index), FLOAT)
        views.append({"buffer": len(buffers), "byteOffset": len(data), "byteLength": len(elements)})
        data += elements
        twins[index] = len(asset["accessors"])
        asset["accessors"].append({"bufferView": len(views) - 1, "componentType": FLOAT,
                                   "count": file.accessor(index)["count"], "type": file.accessor(index)["type"]})
    for attributes in attribute_sets(asset):
        for semantic in DEFORMED:
            if semantic in attributes:
                attributes[semantic] = twins[attributes[semantic]]
    buffers.append({"byteLength": len(data),
                    "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode()})
    return run.write(name, asset)


def check_like_twin(file, twin, old):
    """Every deformed attribute is that of the twin, to half a step of the type that it had."""
    for a, b, was in zip(*(attribute_sets(f.asset) for f in (file, twin, old))):
        for name in DEFORMED:
            if name not in was:
                continue
            half = old.step(was[name]) / 2
            found, wanted = file.decoded(a[name]), twin.decoded(b[name])
            equal([len(found), {*map(len, found)}], [len(wanted), {*map(len, wanted)}], f"{name}: elements")
            for x, y in zip(itertools.chain.from_iterable(found), itertools.chain.from_iterable(wanted)):
                if x != y:
                    check(abs(x - y) <= half * 1.001 + 4 * SINGLE * max(abs(x), abs(y), 1),
                          f"{name}: {x!r} instead of {y!r}, half a step is {half!r}")


def deform_with_twin(run, source, content, normals="keep", **others):
    before, after, said = deform(run, source, content, normals, **others)
    twin = float_twin(run, run.path(source), "twin.gltf")
    run.ffd("deform", twin, "twin-out.gltf", "-l", "l.json", "--force", "--normals", normals, err=anything)
    check_like_twin(after, Gltf(run.path("twin-out.gltf")), before)
    return before, after, said


def on_grid(file, index, step):
    for element in file.decoded(index):
        for x in element:
            check(abs(x / step - round(x / step)) <= abs(x / step) * 2 * SINGLE, f"{x!r} is on no step of {step!r}")


@case
def integers_stay_integers(run):
    """What fits is written in place, whatever the type and the container; what does not move keeps its bits."""
    for (component, normalized), container in itertools.product(INTEGERS, CONTAINERS):
        points = integers(component, 0.5)
        maker = Maker(**QUANTIZED, nodes=[in_scene(component, normalized)])
        flags = {"normalized": True} if normalized else {}
        maker.mesh({"POSITION": maker.dense(points, component, **bounds(points), **flags)})
        source = maker.write(run, "in", container)
        before, after, _ = deform_with_twin(run, source, lattice(low=(-1,) * 3, high=(1,) * 3, moves=[{"by": [0.1, -0.2, 0.15]}]))
        equal(after.asset["meshes"], before.asset["meshes"], "the accessor")
        equal(after.asset["extensionsUsed"], QUANTIZED["extensionsUsed"], "extensions")
        check(after.stored(0) != points, "nothing moved")
        before, after, _ = deform_with_twin(run, source, lattice(size=(8, 8, 8), low=(-1,) * 3, high=(1,) * 3,
                                                                 moves=[{"at": [[5, 7], [3, 7], [3, 7]], "by": [0.2, 0.2, 0]}]))
        equal(after.stored(0)[0], points[0], "the vertex in the far corner")
        check(after.stored(0)[3] != points[3], "the vertex in the near corner")
        check_unmoved(run, source)


@case
def integers_become_floats(run):
    """One vertex that leaves the range makes the accessor one of floats, on the same steps."""
    for component, normalized in INTEGERS:
        points = integers(component, 1)
        maker = Maker(**QUANTIZED, nodes=[in_scene(component, normalized)])
        flags = {"normalized": True} if normalized else {"normalized": False}
        maker.mesh({"POSITION": maker.dense(points, component, **bounds(points), **flags)})
        source = maker.write(run, "in", "glb")
        before, after, said = deform_with_twin(run, source, ALL, options=("-v",), lines=2)
        equal(said[0], f"{source}: accessor 0: its component type {component} cannot hold the results, which "
              "accessor 1 holds as floats", "what is said")
        copied = after.accessor(1)
        equal((copied["componentType"], "normalized" in copied), (FLOAT, False), "the type")
        on_grid(after, 1, before.step(0))
        check("extensionsUsed" not in after.asset and "extensionsRequired" not in after.asset, "extensions")


@case
def the_extension_goes_when_nothing_needs_it(run):
    texcoords = [(i, i) for i in range(len(POINTS))]
    uses = {
        "another name": ({}, ["EXT_a", "KHR_mesh_quantization", "EXT_b"], ["EXT_a", "EXT_b"]),
        "alone": ({}, ["KHR_mesh_quantization"], None),
        "texture coordinates that glTF itself knows": ({"TEXCOORD_0": (5123, True)}, ["KHR_mesh_quantization"], None),
        "other texture coordinates": ({"TEXCOORD_0": (5123, False)}, ["KHR_mesh_quantization"], ["KHR_mesh_quantization"]),
        "more of them": ({"TEXCOORD_1": (5122, True)}, ["KHR_mesh_quantization"], ["KHR_mesh_quantization"]),
        "its own attribute": ({"_BYTES": (5120, False)}, ["KHR_mesh_quantization"], None),
    }
    for what, (more, used, left) in uses.items():
        points = integers(5122, 1)
        maker = Maker(extensionsUsed=used, nodes=[in_scene(5122, True)])
        attributes = {"POSITION": maker.dense(points, 5122, normalized=True, **bounds(points))}
        for name, (component, normalized) in more.items():
            data = b"".join(pad(packed([t], component), b"\0") for t in texcoords)
            view = maker.view(data, byteStride=4)
            attributes[name] = maker.accessor(len(POINTS), component, "VEC2", bufferView=view, normalized=normalized)
        maker.mesh(attributes)
        _, after, _ = deform(run, maker.write(run, "in", "data"))
        equal(after.asset.get("extensionsUsed"), left, what)
    # The offsets of a morph target may stay where the base does not.
    for reach, left in ((0.01, ["KHR_mesh_quantization"]), (1, None)):
        points, offsets = integers(5122, 1), integers(5122, reach)
        maker = Maker(extensionsUsed=["KHR_mesh_quantization"], nodes=[in_scene(5122, True)])
        maker.mesh({"POSITION": maker.dense(points, 5122, normalized=True, **bounds(points))})
        maker.asset["meshes"][0]["primitives"][0]["targets"] = [
            {"POSITION": maker.dense(offsets, 5122, normalized=True, **bounds(offsets))}]
        grow = lattice(low=(-2.5,) * 3, high=(2.5,) * 3, moves=[{"scale": {"factor": 1.5}}])
        _, after, _ = deform_with_twin(run, maker.write(run, "in", "data"), grow)
        equal(after.asset.get("extensionsUsed"), left, f"offsets of {reach}")
    # A second mesh that stays in its range keeps it; so does one that no node shows.
    for shown in (True, False):
        points, small = integers(5122, 1), integers(5122, 0.25)
        node = in_scene(5122, True)
        maker = Maker(extensionsUsed=["KHR_mesh_quantization"], nodes=[node, {**node, "mesh": 1}],
                      scenes=[{"nodes": [0, 1] if shown else [0]}])
        for p in (points, small):
            maker.mesh({"POSITION": maker.dense(p, 5122, normalized=True, **bounds(p))})
        _, after, _ = deform(run, maker.write(run, "in", "data"), lines=0 if shown else 1)
        equal(after.asset.get("extensionsUsed"), ["KHR_mesh_quantization"], "a second mesh")


@case
def neighbours_stay_neighbours(run):
    """Equal positions in an accessor that becomes floats and in one that stays: equal results."""
    for component, normalized in INTEGERS:
        inner, outer = integers(component, 0.4), integers(component, 1)
        flags = {"normalized": True} if normalized else {}
        maker = Maker(**QUANTIZED, nodes=[in_scene(component, normalized)])
        maker.mesh({"POSITION": maker.dense(inner, component, **bounds(inner), **flags)},
                   {"POSITION": maker.dense(inner + outer, component, **bounds(inner + outer), **flags)})
        _, after, _ = deform(run, maker.write(run, "in", "glb"), ALL)
        a, b = (after.primitives()[i]["attributes"]["POSITION"] for i in range(2))
        equal((after.accessor(a)["componentType"], after.accessor(b)["componentType"]), (component, FLOAT), "types")
        equal([struct.pack("<3f", *p) for p in after.decoded(a)],
              [struct.pack("<3f", *p) for p in after.decoded(b)[:len(inner)]], "the common vertices")


@case
def copies_of_integers_are_aligned(run):
    """Where a copy is needed, its elements start at multiples of 4 bytes, even if the old ones did not."""
    for (component, normalized), aligned in itertools.product(INTEGERS, (False, True)):
        points = integers(component, 0.5)
        flags = {"normalized": True} if normalized else {}
        size = 3 * TYPES[component][1]
        stride = (size + 3) // 4 * 4 if aligned else size
        data = b"".join(packed([p], component) + b"\xcc" * (stride - size) for p in points)
        node = in_scene(component, normalized)
        maker = Maker(**QUANTIZED, nodes=[node, {"mesh": 0, "translation": [9, 0, 0]}], scenes=[{"nodes": [0, 1]}])
        view = maker.view(data, **({"byteStride": stride} if aligned else {}), target=34962)
        maker.mesh({"POSITION": maker.accessor(len(points), component, bufferView=view, **bounds(points), **flags)})
        moves = lattice(low=(-1,) * 3, high=(1,) * 3, moves=[{"by": [0.1, -0.2, 0.15]}])
        before, after, _ = deform(run, maker.write(run, "in", "glb"), moves, lines=1)
        made = after.asset["bufferViews"][1]
        equal([p["attributes"] for p in after.primitives()], [{"POSITION": 1}, {"POSITION": 0}], "accessors")
        equal([node["mesh"] for node in after.asset["nodes"]], [0, 1], "meshes")
        equal(after.accessor(1)["componentType"], component, "the type")
        equal((made["byteOffset"] % 4, made.get("byteStride", 4), made["target"]), (0, (size + 3) // 4 * 4, 34962),
              "the new view")
        equal(after.stored(0), points, "the original")
        check(after.stored(1) != points, "the copy")
        # In place its stride stays.
        maker.asset["nodes"], maker.asset["scenes"] = [node], [{"nodes": [0]}]
        before, after, _ = deform_with_twin(run, maker.write(run, "in", "glb"), moves)
        equal(after.asset["bufferViews"], before.asset["bufferViews"], "views")


@case
def interleaved_integers_keep_what_is_between_them(run):
    """Position, normal and tangent of different types in one view; the rest between them stays."""
    points = integers(5122, 0.5)
    rows = [struct.pack("<3hxx4h3bx2HBBBB", *p, 0, 32767, 0, (-1) ** i * 32767, 0, 0, 127, 7 * i, 9 * i, 1, 2, 3, i)
            for i, p in enumerate(points)]
    count, stride = len(rows), len(rows[0])
    maker = Maker(**QUANTIZED, nodes=[in_scene(5122, True)])
    view = maker.view(b"".join(rows), byteStride=stride)
    part = {"bufferView": view, "normalized": True}
    maker.mesh({"POSITION": maker.accessor(count, 5122, **part, **bounds(points)),
                "TANGENT": maker.accessor(count, 5122, "VEC4", **part, byteOffset=8),
                "NORMAL": maker.accessor(count, 5120, **part, byteOffset=16),
                "TEXCOORD_0": maker.accessor(count, 5123, "VEC2", **part, byteOffset=20)})
    twisted = lattice(low=(-1,) * 3, high=(1,) * 3, moves=[{"rotate": {"axis": [1, 2, 3], "degrees": 20}},
                                                           {"twist": {"axis": "y", "degrees": 30}}])
    for container in CONTAINERS:
        source = maker.write(run, "in", container)
        before, after, _ = deform_with_twin(run, source, twisted, "transform")
        equal(after.asset["accessors"][1:], before.asset["accessors"][1:], "all in place")
        equal([t[3] for t in after.stored(1)], [t[3] for t in before.stored(1)], "handedness")
        check(after.stored(1) != before.stored(1) and after.stored(2) != before.stored(2), "directions do not change")
        check_unmoved(run, source)


@case
def directions_in_other_integers(run):
    """glTF does not allow normals in integers without sign or scale: they become floats, of unit length."""
    points = [tuple(float(x) for x in p) for p in POINTS]
    twisted = lattice(moves=[{"rotate": {"axis": [1, 2, 3], "degrees": 20}}])
    for component, normalized in ((5120, False), (5121, False), (5121, True), (5123, True), (5122, False)):
        one = SCALES[component] if normalized else 1
        maker = Maker()
        flags = {"normalized": True} if normalized else {}
        normals = maker.dense([(0, 0, one)] * len(points), component, **flags)
        maker.mesh({"POSITION": maker.dense(points, **bounds(points)), "NORMAL": normals})
        run.write("l.json", twisted)
        source = maker.write(run, "in", "glb")
        run.ffd("deform", source, "out.glb", "-l", "l.json", "--force")
        after = Gltf(run.path("out.glb"))
        normal = after.primitives()[0]["attributes"]["NORMAL"]
        equal(after.accessor(normal)["componentType"], FLOAT, "the type")
        for n in after.decoded(normal):
            check(abs(sum(x * x for x in n) - 1) < 1e-6, f"{n} has no unit length")


def other_users():
    """name -> a maker of a file whose POSITION 0 shares bytes, and what it is expected to stay in: in place or not."""
    points = integers(5122, 0.5)
    node = in_scene(5122, False)
    size = 6

    def maker(nodes=1):
        made = Maker(**QUANTIZED, nodes=[{**node, "mesh": i} for i in range(nodes)], scenes=[{"nodes": list(range(nodes))}])
        made.data = b""
        view = made.view(packed(points, 5122) + b"\0" * 8)
        made.accessor(len(points), 5122, bufferView=view, **bounds(points))
        return made

    made = maker()
    made.accessor(2 * len(points), 5123, "SCALAR", bufferView=0, byteOffset=2)
    made.mesh({"POSITION": 0})
    yield "an accessor that nothing uses", made, False
    made = maker()
    made.accessor(4, 5123, "SCALAR", bufferView=0, byteOffset=size * len(points))
    made.mesh({"POSITION": 0})
    made.asset["meshes"][0]["primitives"][0]["indices"] = 1
    yield "indices behind the positions", made, True
    made = maker()
    made.accessor(4, 5123, "SCALAR", bufferView=0, byteOffset=size * len(points) - 2)
    made.mesh({"POSITION": 0}, {"POSITION": made.dense([(0, 0, 0)] * 65536, 5122, **bounds([(0, 0, 0)]))})
    made.asset["meshes"][0]["primitives"][1]["indices"] = 1
    yield "indices that begin in the last number", made, False
    made = maker(2)
    made.accessor(len(points) - 1, 5122, bufferView=0, byteOffset=size, **bounds(points[1:]))
    made.mesh({"POSITION": 0})
    made.mesh({"POSITION": 1})
    yield "positions that begin one vertex later", made, False
    made = maker(2)
    made.accessor(len(points), 5122, bufferView=0, **bounds(points))
    made.mesh({"POSITION": 0})
    made.mesh({"POSITION": 1})
    yield "the same positions under another number", made, True
    made = maker(2)
    made.accessor(len(points), 5122, bufferView=0, normalized=True, **bounds(points))
    made.mesh({"POSITION": 0})
    made.mesh({"POSITION": 1})
    made.asset["nodes"][1] = {**in_scene(5122, True), "mesh": 1}
    yield "the same bytes as normalized numbers", made, False
    made = maker()
    made.mesh({"POSITION": 0}, {"POSITION": made.dense(points, 5122, **bounds(points)), "_OLD": 0})
    yield "an attribute of another name", made, False
    made = maker()
    made.mesh({"POSITION": 0}, {"POSITION": made.dense(points, 5122, **bounds(points)), "NORMAL": 0})
    yield "normals", made, False
    made = maker()
    made.mesh({"POSITION": 0}, {"POSITION": made.dense(points, 5122, **bounds(points))})
    made.asset["meshes"][0]["primitives"][0]["targets"] = [{"POSITION": 0}]
    made.asset["meshes"][0]["primitives"][1]["targets"] = [{}]
    yield "offsets of a morph target", made, False
    made = maker()
    made.asset["extensions"] = {"EXT_structural_metadata": {"propertyTables": [{"count": 1, "properties": {"a": {"values": 0}}}]}}
    made.mesh({"POSITION": 0})
    yield "a property table", made, False
    made = maker()
    made.asset["accessors"].append({"componentType": 5122, "count": 9, "type": "VEC3", "sparse": {
        "count": 1, "indices": {"bufferView": made.view(b"\0\0"), "componentType": 5121},
        "values": {"bufferView": 0}}})
    made.mesh({"POSITION": 0})
    yield "values of a sparse accessor", made, False
    rows = [struct.pack("<3h3h", *p, *(x // 2 for x in p)) for p in points]
    made = maker(2)
    view = made.view(b"".join(rows), byteStride=12)
    for i in range(2):
        half = [tuple(x // (i + 1) for x in p) for p in points]
        made.mesh({"POSITION": made.accessor(len(points), 5122, bufferView=view, byteOffset=6 * i, **bounds(half))})
    yield "positions between positions", made, True


@threaded_case
def bytes_that_others_use(run):
    """Integers are written in place only where nothing else reads these bytes, or all want the same."""
    moves = lattice(low=(-1,) * 3, high=(1,) * 3, moves=[{"by": [0.1, -0.2, 0.15]}])
    for what, maker, in_place in other_users():
        for container in CONTAINERS:
            before, after, _ = deform_with_twin(run, maker.write(run, "in", container), moves)
            added = len(after.asset["accessors"]) - len(before.asset["accessors"])
            if in_place:
                equal(added, 0, f"{what}: new accessors")
                continue
            check(added > 0, f"{what}: no new accessor")
            stayed = {0}.union(*(a.values() for a in attribute_sets(after.asset)), [
                p["indices"] for p in after.primitives() if "indices" in p])
            for index in (i for i in stayed if i < len(before.asset["accessors"])):
                if index == 0 or index not in deformed_accessors(before.asset):
                    equal(after.stored(index), before.stored(index), f"{what}: accessor {index}")
        check_unmoved(run, "in.gltf")


@case
def positions_that_an_animation_reads(run):
    """The output of a sampler and the times of one keep their numbers."""
    for key, kind in (("output", "VEC3"), ("input", "VEC3")):
        points = [tuple(float(x) for x in p) for p in POINTS]
        maker = Maker()
        maker.mesh({"POSITION": maker.dense(points, FLOAT, kind, **bounds(points))})
        times = maker.dense([(float(i),) for i in range(len(points))], FLOAT, "SCALAR", min=[0], max=[5])
        maker.asset["animations"] = [{"channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}],
                                      "samplers": [{"input": times, "output": times, key: 0}]}]
        before, after, _ = deform_with_twin(run, maker.write(run, "in", "glb"), ALL)
        equal(after.stored(0), before.stored(0), key)


@threaded_case
def models_like_their_float_twins(run):
    """Every sample model with integers, sparse data or none at all; compressed ones are left out."""
    if not MODELS:
        return
    done = 0
    for folder, _, names in sorted(os.walk(MODELS)):
        for name in sorted(names):
            if not name.endswith((".gltf", ".glb")):
                continue
            path = os.path.join(folder, name)
            before = Gltf(path)
            if any("compression" in extension for extension in before.asset.get("extensionsUsed", [])):
                continue
            accessors = [before.accessor(i) for i in deformed_accessors(before.asset)]
            if not any(a["componentType"] != FLOAT or "sparse" in a or "bufferView" not in a for a in accessors):
                continue
            target = "out" + os.path.splitext(name)[1]
            run.write("l.json", lattice(size=(4, 6, 4), rest={"box": "mesh", "margin": 0.05},
                                        moves=[{"twist": {"axis": "y", "degrees": 60}}]))
            options = ("-l", "l.json", "--force", "-q", "--resources", "reference")
            if run.ffd("deform", path, target, *options, code=(OK, UNSUPPORTED)).code != OK:
                continue
            after = Gltf(run.path(target))
            run.ffd("deform", float_twin(run, path, "twin.gltf"), "twin-out.gltf", *options)
            check_like_twin(after, Gltf(run.path("twin-out.gltf")), before)
            for index in range(len(after.asset["accessors"])):
                check_bounds(after, index)
            if not any(node.get("skin") is not None for node in before.asset["nodes"]):
                check_rest(before, after)
            done += 1
    print(f"{done} models")
    check(done > 0, "no model was deformed")


@threaded_case
def buffers_of_many_pieces(run):
    """An interleaved buffer of any length is put together in pieces, by any number of threads."""
    run.write("l.json", lattice(low=(0, 0, 0), high=(9, 9, 9), moves=[{"by": list(SHIFT)}]))
    piece = 3 << 16
    for count, tail in ((piece // 24, 0), (piece // 24, 1), (piece // 24 - 1, 23), (2 * piece // 24, 2), (20001, 7)):
        points = [(i % 64 / 8 + 1, i // 64 % 64 / 8 + 1, i % 5 / 4 + 1) for i in range(count)]
        colors = [(i % 3 / 2, i % 7 / 8, i % 11 / 16) for i in range(count)]
        end = bytes(i % 251 for i in range(tail))
        moved = [tuple(p + s for p, s in zip(point, SHIFT)) for point in points]
        data, expected = (b"".join(struct.pack("<6f", *p, *c) for p, c in zip(shape, colors)) + end
                          for shape in (points, moved))
        for container in CONTAINERS:
            maker = Maker()
            maker.data = data
            maker.asset["bufferViews"] = [{"buffer": 0, "byteOffset": 0, "byteLength": 24 * count, "byteStride": 24}]
            low, high = ([f(p[a] for p in points) for a in range(3)] for f in (min, max))
            maker.accessor(count, bufferView=0, min=low, max=high)
            maker.accessor(count, bufferView=0, byteOffset=12)
            maker.mesh({"POSITION": 0, "COLOR_0": 1})
            name = maker.write(run, "large", container)
            for threads in ("1", "4"):
                run.ffd("deform", name, "out-" + name, "-l", "l.json", "--force", "--threads", threads)
                found = Gltf(run.path("out-" + name)).buffers[0]
                equal(bytes(found[:len(expected)]) == expected, True, f"{count} {tail} {container} {threads}")


@threaded_case
def streams_of_many_pieces(run):
    """A buffer of streams one behind the other is written from where they are, whatever pieces they end in."""
    run.write("l.json", lattice(low=(0, 0, 0), high=(9, 9, 9), moves=[{"by": list(SHIFT)}]))
    for count in (40000, 1 << 16, 70001):
        points = [(i % 64 / 8 + 1, i // 64 % 64 / 8 + 1, i % 5 / 4 + 1) for i in range(count)]
        before, after = (b"".join(struct.pack("<3f", *point) for point in shape)
                         for shape in (points, [tuple(p + s for p, s in zip(point, SHIFT)) for point in points]))
        rest = bytes(i * i % 251 for i in range(12 * count))
        for container in CONTAINERS:
            maker = Maker()
            streams = [maker.view(data) for data in (before, rest, before, rest)]
            low, high = ([f(p[a] for p in points) for a in range(3)] for f in (min, max))
            for first in (0, 2):
                maker.mesh({"POSITION": maker.accessor(count, bufferView=streams[first], min=low, max=high)})
            maker.asset["nodes"], maker.asset["scenes"] = [{"mesh": 0}, {"mesh": 1}], [{"nodes": [0, 1]}]
            name = maker.write(run, "streams", container)
            for threads in ("1", "3"):
                run.ffd("deform", name, "out-" + name, "-l", "l.json", "--force", "--threads", threads)
                found = Gltf(run.path("out-" + name)).buffers[0]
                equal(bytes(found[:48 * count]) == after + rest + after + rest, True, f"{count} {container} {threads}")


main()
