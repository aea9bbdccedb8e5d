#!/usr/bin/env python3
"""Files that are not what a run takes them for, and what they need beside them (wild3-*, artist-*, siege3-*). Each case
runs the program on the files of its folder, or on files that it makes, and says what is right.

    FFD=... PYTHONPATH=tests/cli python3 tests/faults/test_files.py wild3_01_a_pointer_is_no_buffer
"""

import base64
import json
import os
import re
import shutil
import struct
import zlib

from harness import (INVALID, IO, LIMIT, NO, PNG, UNSUPPORTED, USAGE, case, check, equal, glb, glb_split, gltf_json, gltf_vectors, lattice,
                     main, near, obj_vertices)
from messages import anything, counts, entry, no_line, one_line

HERE = os.path.dirname(os.path.abspath(__file__))
LIFT = lattice(moves=[{"by": [0, 0, 1]}])
TRIANGLE = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]


def use(run, name):
    shutil.copytree(os.path.join(HERE, name), run.folder, dirs_exist_ok=True)


# Buffers

POINTER = b"version https://git-lfs.github.com/spec/v1\noid sha256:" + b"0" * 64 + b"\nsize 52233\n"


@case
def wild3_01_a_pointer_is_no_buffer(run):
    """A Git LFS pointer where the buffer should be: refused by every command, whatever its length."""
    use(run, "wild3-01-lfs-pointer-as-buffer")
    why = re.compile(r'^model\.gltf:\d+: /buffers/0/uri: the buffer "model\.bin" seems to be a Git LFS pointer: the file itself is not there$')
    for words in (["deform", "model.gltf", "out.gltf", "-l"], ["check", "model.gltf", "-l"], ["embed", "model.gltf", "-o", "e.npy", "-l"],
                  ["view", "model.gltf", "-o", "v.html", "-l"], ["deform", "model.gltf", "out.obj", "-l"]):
        run.ffd(*words, "twist.json", code=INVALID, err=why)
    run.ffd("info", "model.gltf", code=INVALID, err=why)
    run.ffd("compare", "model.gltf", "model.gltf", code=INVALID, err=anything)
    check(not run.exists("out.gltf") and not run.exists("out.bin"), "nothing is written")
    asset = json.loads(run.text("model.gltf"))
    asset["buffers"][0]["byteLength"] = 5000
    run.write("model.gltf", asset)
    run.ffd("info", "model.gltf", code=INVALID, err=why)


@case
def text_is_no_floats(run):
    """Numbers as text, or a message, in place of the positions: of any kind, and within min and max."""
    use(run, "wild3-01-lfs-pointer-as-buffer")
    size = json.loads(run.text("model.gltf"))["buffers"][0]["byteLength"]
    for text in (b"0.25 1.5 -0.75\n", b"Not found; ask the administrator of this server.\r\n"):
        run.write("model.bin", (text * size)[:size])
        run.ffd("info", "model.gltf", code=INVALID, err=re.compile("text is where the floats of positions should be"))
        run.ffd("deform", "model.gltf", "out.glb", "-l", "twist.json", code=INVALID, err=anything)


@case
def other_files_are_no_buffers(run):
    """Pages, archives, images and JSON in place of a buffer, beside the model, in a GLB and in its second buffer; as editors and
    shells save them, with a byte order mark or in UTF-16."""
    wrong = {"an HTML page": b"\n<!DOCTYPE html><html><body>404: not found, the page is gone</body></html>",
             "JSON text": b'{"message": "Not Found", "documentation_url": "https://docs.example.org"}',
             "a gzip file": zlib.compress(bytes(range(200)), wbits=31), "a ZIP archive": b"PK\3\4\x14\0\0\0\x08\0" + bytes(60),
             "a PNG image": PNG, "a JPEG image": b"\xff\xd8\xff\xe0\0\x10JFIF" + bytes(60), "an XML file": b'<?xml version="1.0"?><Error>' + b" " * 60,
             "a Git LFS pointer": POINTER, "a GLB file": glb(*gltf_json(TRIANGLE)), "a bzip2 file": b"BZh91AY&SY" + bytes(60)}
    run.write("l.json", LIFT)
    asset, data = gltf_json(TRIANGLE, uri="m.bin")
    run.write("m.gltf", asset)
    more = [("a Git LFS pointer", b"\xef\xbb\xbf" + POINTER), ("UTF-16 text", POINTER.decode().encode("utf-16")),
            ("UTF-16 text", b"\xfe\xff" + POINTER.decode().encode("utf-16-be")), ("an HTML page", b"<!-- cache -->\n<HTML>" + b" " * 60),
            ("JSON text", b'[\n  {"message": "Not Found", "status": 404}\n]'), ("an SVG image", b"<svg xmlns='http://www.w3.org/2000/svg'/>"),
            ("a git-annex pointer", b"/annex/objects/SHA256E-s52233--" + b"0" * 64 + b".bin\n")]
    for kind, content in [*wrong.items(), *more]:
        run.write("m.bin", content)
        run.ffd("deform", "m.gltf", "o.gltf", "-l", "l.json", code=INVALID, err=re.compile(f'/buffers/0/uri: the buffer "m.bin" seems to be {kind}'))
        short = {**asset, "buffers": [{"byteLength": len(content)}]}
        run.write("b.glb", glb(short, content))
        run.ffd("info", "b.glb", code=INVALID, err=re.compile(f"/buffers/0: the buffer seems to be {kind}"))
        second = {**asset, "buffers": [{"byteLength": len(data)}, asset["buffers"][0]], "bufferViews": [{**asset["bufferViews"][0], "buffer": 1}]}
        run.write("s.glb", glb(second, data))
        run.ffd("info", "s.glb", code=INVALID, err=re.compile(f'/buffers/1/uri: the buffer "m.bin" seems to be {kind}'))
    run.write("l.json", b"\xef\xbb\xbf" + POINTER)
    run.ffd("info", "l.json", code=INVALID, err=re.compile("it seems to be a Git LFS pointer"))


@case
def bytes_that_look_like_other_files_are_read(run):
    """An image at the start of a buffer, and numbers that begin as an archive, an image or text would."""
    run.write("l.json", LIFT)
    asset, data = gltf_json(TRIANGLE)
    packed = {**asset, "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": len(PNG)},
                                       {"buffer": 0, "byteOffset": 200, "byteLength": len(data)}],
              "images": [{"bufferView": 0, "mimeType": "image/png"}], "buffers": [{"byteLength": 200 + len(data)}]}
    packed["accessors"][0]["bufferView"] = 1
    check(len(PNG) <= 200)
    run.write("p.glb", glb(packed, PNG.ljust(200, b"\0") + data))
    run.ffd("deform", "p.glb", "o.glb", "-l", "l.json")
    # Colours and indices at the start.
    for first in (b"\x1f\x8b\xff\xff", b"\xff\xd8\xff\xff", b"\xff\xfe\0\0", b"\xff\xfev\0v\0", b"{{{\xff", b"{{{{", b"[{[{", b"v v ", b"solid", b"off\n"):
        asset, data = gltf_json(TRIANGLE)
        asset["bufferViews"] += [{"buffer": 0, "byteOffset": len(data), "byteLength": 12}]
        asset["accessors"] += [{"bufferView": 1, "componentType": 5121, "normalized": True, "count": 3, "type": "VEC4"}]
        asset["bufferViews"][0]["byteOffset"], asset["bufferViews"][1]["byteOffset"] = 12, 0
        asset["buffers"][0]["byteLength"] = 12 + len(data)
        asset["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = 1
        run.write("c.glb", glb(asset, (first * 12)[:12] + data))
        run.ffd("deform", "c.glb", "o.glb", "-l", "l.json", "--force")


def three(low, high, data, **members):
    """A model beside its buffer, whose accessor states these bounds."""
    asset, _ = gltf_json(TRIANGLE, uri="m.bin")
    asset["accessors"][0].update(min=low, max=high)
    asset["buffers"][0].update(members)
    return asset, data


@case
def positions_are_where_the_accessor_says(run):
    """More than 1e15 times beyond min and max: refused; outside: a flaw, which --strict refuses."""
    run.write("l.json", LIFT)
    big = struct.pack("<9f", 0, 0, 0, 1, -2e15, 0, 0, 1, 0)
    for name, asset in (("m", three([0, 0, 0], [1, 1, 0], big)[0]), ("z", three([0, 0, 0], [0, 0, 0], big)[0]),
                        ("t", three([0, -2e15, 0], [1, 1, 0], big)[0])):
        run.write("m.bin", big)
        run.write(name + ".gltf", asset)
        code = INVALID if name == "m" else 0
        done = run.ffd("deform", name + ".gltf", "o.gltf", "-l", "l.json", "--force", "--report", "r.json", code=code, err=anything)
        if name == "m":
            one_line(done, r"^m\.gltf:1: /accessors/0: a coordinate of -2e\+15 is more than 1e15 times the largest number of min and max, 1: ")
        elif name == "t":
            no_line(done, "min|max")
    run.write("m.bin", struct.pack("<9f", 0, 0, 0, 3.5, 0, 0, 0, 1, 0))
    done = run.ffd("deform", "m.gltf", "o.gltf", "-l", "l.json", "--force", "--report", "r.json", err=anything)
    one_line(done, r"^m\.gltf: /accessors/0/max: a position has x = 3\.5, more than the max 1$")
    equal([(flaw["pointer"], flaw["count"]) for flaw in json.loads(run.text("r.json"))["jobs"][0]["flaws"]], [("/accessors/0/max", 1)])
    run.ffd("check", "m.gltf", "-l", "l.json", "--strict", code=INVALID, err=re.compile("more than the max 1$"))
    # Numbers that are not finite are counted elsewhere; those that min and max round to are equal.
    run.write("m.bin", struct.pack("<9f", 0, 0, 0, 1, float("inf"), 0, 0, float("nan"), 0))
    no_line(run.ffd("info", "m.gltf", err=anything), "a position has|1e15")
    run.write("m.bin", struct.pack("<9f", 0, 0, 0, 0.1, 0.7, 0, 0, 0, 0))
    run.write("m.gltf", three([0, 0, 0], [0.1, 0.7, 0], b"")[0])
    run.ffd("info", "m.gltf")


@case
def offsets_are_where_the_accessor_says(run):
    """The same for the offsets of morph targets."""
    asset, data = gltf_json(TRIANGLE)
    far = struct.pack("<9f", 0, 0, 0, 0, 0, 5e20, 0, 0, 0)
    asset["bufferViews"].append({"buffer": 0, "byteOffset": len(data), "byteLength": 36})
    asset["accessors"].append({**asset["accessors"][0], "bufferView": 1})
    asset["buffers"][0]["byteLength"] += 36
    asset["meshes"][0]["primitives"][0]["targets"] = [{"POSITION": 1}]
    run.write("m.glb", glb(asset, data + far))
    run.ffd("info", "m.glb", code=INVALID, err=re.compile(r"^m\.glb:/accessors/1: a coordinate of 5e\+20 "))


@case
def a_buffer_of_another_length_is_a_flaw(run):
    """Longer or shorter than byteLength, though it holds its bufferViews; a GLB is padded."""
    run.write("l.json", LIFT)
    _, data = gltf_json(TRIANGLE)
    for more, what in ((4, "40 bytes, more than its byteLength 36"), (1, "37 bytes, more than its byteLength 36")):
        run.write("m.gltf", three([0, 0, 0], [1, 1, 0], b"")[0])
        run.write("m.bin", data + bytes(more))
        done = run.ffd("deform", "m.gltf", "o.gltf", "-l", "l.json", "--force", err=anything)
        one_line(done, rf"^m\.gltf: /buffers/0: the buffer has {what}$")
        run.ffd("info", "m.gltf", "--strict", code=INVALID, err=re.compile(what))
    run.write("m.gltf", three([0, 0, 0], [1, 1, 0], b"", byteLength=40)[0])
    run.write("m.bin", data)
    one_line(run.ffd("info", "m.gltf", err=anything), "36 bytes, less than its byteLength 40")
    asset, data = gltf_json(TRIANGLE)
    asset["buffers"][0]["byteLength"] = 35
    run.write("m.gltf", three([0, 0, 0], [1, 1, 0], b"", byteLength=35)[0])
    run.ffd("info", "m.gltf", code=INVALID, err=re.compile("are outside buffer 0 of 35 bytes"))
    asset["buffers"][0]["byteLength"] = 36
    for more, flaws in ((0, False), (4, True)):
        run.write("p.glb", glb(asset, data + bytes(more)))
        done = run.ffd("info", "p.glb", err=anything)
        (one_line if flaws else no_line)(done, "the buffer has 40 bytes, more than its byteLength 36")


# Names and numbers of a glTF

def skinned(second, **members):
    """A mesh of points under a skin, whose second primitive has these attributes: accessors 1 joints, 2 weights."""
    asset, data = gltf_json(TRIANGLE, nodes=[{"mesh": 0, "skin": 0}, {"name": "J"}])
    for component, kind, element in ((5121, "VEC4", b"\0" * 4), (5126, "VEC4", struct.pack("<4f", 1, 0, 0, 0)), (5126, "VEC3", bytes(12))):
        asset["bufferViews"].append({"buffer": 0, "byteOffset": len(data), "byteLength": 3 * len(element)})
        asset["accessors"].append({"bufferView": len(asset["bufferViews"]) - 1, "componentType": component, "count": 3, "type": kind})
        data += 3 * element
    asset["buffers"][0]["byteLength"] = len(data)
    asset["skins"] = [{"joints": [1]}]
    first = asset["meshes"][0]["primitives"][0]
    first["attributes"] |= {"JOINTS_0": 1, "WEIGHTS_0": 2}
    asset["meshes"][0]["primitives"] = [first, {"attributes": second, "mode": 0, **members}]
    return glb(asset, data)


COMMANDS = (["deform", "m.glb", "o.glb", "--force", "-l", "l.json"], ["deform", "m.glb", "o.obj", "--force", "-l", "l.json"],
            ["deform", "m.glb", "o.glb", "--force", "-l", "l.json", "--as-morph", "a"],
            ["deform", "m.glb", "o.glb", "--force", "-l", "l.json", "--rig", "follow"], ["check", "m.glb", "-l", "l.json"],
            ["embed", "m.glb", "-l", "l.json", "-o", "e.npy", "--force"], ["view", "m.glb", "-o", "v.html", "--force"], ["info", "m.glb"])


@case
def siege3_01_primitives_without_positions_are_passed_over(run):
    """Joints, weights, morph targets and splats of a primitive without POSITION: it has no vertices, and nobody reads them."""
    run.write("l.json", LIFT)
    without = [{"WEIGHTS_0": 2}, {"JOINTS_0": 1}, {"WEIGHTS_0": 2, "JOINTS_1": 1}, {"JOINTS_1": 1}, {"NORMAL": 3}, {}]
    primitives = [(attributes, {}) for attributes in without]
    primitives += [({"WEIGHTS_0": 2}, {"targets": [{"POSITION": 3, "NORMAL": 3}]}),
                   ({"KHR_gaussian_splatting:ROTATION": 2, "KHR_gaussian_splatting:SCALE": 3},
                    {"extensions": {"KHR_gaussian_splatting": {"kernel": "ellipse"}}})]
    for attributes, members in primitives:
        run.write("m.glb", skinned(attributes, **members))
        for words in COMMANDS:
            done = run.ffd(*words, code=(0, INVALID), err=anything, data=True)
            check(done.code == 0 or len(done.err) == 1, attributes, words, done.err)
    # With positions what is missing is named.
    for attributes, missing in (({"WEIGHTS_0": 2}, "JOINTS_0"), ({"JOINTS_0": 1}, "WEIGHTS_0"), ({"WEIGHTS_0": 2, "JOINTS_1": 1}, "JOINTS_0")):
        run.write("m.glb", skinned({"POSITION": 0, **attributes}))
        for words in COMMANDS:
            done = run.ffd(*words, code=(0, INVALID), err=anything, data=True)
            check(any(missing in line for line in done.err), words, done.err)


def named(*names, targets=()):
    """Points, and attributes of these names with other positions."""
    asset, data = gltf_json(TRIANGLE, nodes=[{"mesh": 0, "name": "N\0"}, {"mesh": 0, "translation": [3, 0, 0]}])
    far = [[9, 9, 9]] * 3
    asset["bufferViews"].append({"buffer": 0, "byteOffset": len(data), "byteLength": 36})
    asset["accessors"].append({**asset["accessors"][0], "bufferView": 1, "min": far[0], "max": far[0]})
    asset["buffers"][0]["byteLength"] += 36
    primitive = asset["meshes"][0]["primitives"][0]
    primitive["attributes"] |= {name: 1 for name in names}
    if targets:
        primitive["targets"] = [{name: 1 for name in targets}]
    return glb(asset, data + struct.pack("<9f", *[x for p in far for x in p]))


@case
def siege3_02_a_name_with_nul_is_another_name(run):
    """Attributes whose names begin with that of a known one and go on with U+0000: neither that attribute nor a crash."""
    run.write("l.json", LIFT)
    names = ["POSITION", "NORMAL", "TANGENT", "JOINTS_0", "WEIGHTS_0", "COLOR_0", "TEXCOORD_0", "KHR_gaussian_splatting:SCALE"]
    for name in names:
        for spelled in (name + "\0", name + "\0x", "\0" + name):
            for targets in ((), (spelled,)):
                run.write("m.glb", named(spelled, targets=targets))
                facts = run.ffd("info", "m.glb", "--json", err=anything).json
                equal([facts["vertices"], facts["normals"]], [6, 0])
                for words in COMMANDS:
                    run.ffd(*words, code=(0, INVALID), err=anything, data=True)
                run.ffd(*COMMANDS[0], err=anything)
                asset, data = glb_split(run.read("o.glb"))
                primitive = asset["meshes"][0]["primitives"][0]
                equal(gltf_vectors(asset, data, primitive["attributes"]["POSITION"]), [[x, y, z + 1.0] for x, y, z in TRIANGLE])
                equal(gltf_vectors(asset, data, primitive["attributes"][spelled]), [[9, 9, 9]] * 3)


@case
def names_of_parts_with_nul_are_shown_whole(run):
    """A hint does not propose the very name that is not there."""
    run.write("l.json", LIFT)
    run.write("m.glb", named())
    run.write("m.obj", "g a\0b\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    for name, kind, word, nearest in (("m.glb", "node", "N", "N\u2400"), ("m.obj", "group", "a", "a\u2400b")):
        run.ffd("check", name, "-l", "l.json", "--only", f"{kind}:{word}", code=USAGE,
                err=f'{name}: --only: no {kind} is called "{word}" (nearest: "{nearest}")')


@case
def names_of_extensions_with_nul_are_not_known(run):
    """A required extension whose name has a U+0000 is not the one that its beginning names."""
    run.write("l.json", LIFT)
    asset, data = gltf_json(TRIANGLE)
    for name in ("KHR_mesh_quantization\0", "KHR_draco_mesh_compression\0x", "KHR_node_visibility\0"):
        asset["extensionsRequired"] = asset["extensionsUsed"] = [name]
        run.write("m.glb", glb(asset, data))
        run.ffd("deform", "m.glb", "o.glb", "-l", "l.json", code=UNSUPPORTED,
                err=re.compile('the required extension "' + name.replace("\0", "\u2400") + '" is not known'))


# Geometry that an extension holds

SPZ = "KHR_gaussian_splatting_compression_spz_2"


@case
def artist_05_geometry_of_an_extension_is_not_deformed(run):
    """Splats in a compressed stream: no command takes zeros for their positions, and no option claims to deform them."""
    use(run, "artist-05-spz-splats")
    facts = run.ffd("info", "spz.glb", "--json").json
    equal([facts["vertices"], facts["bounds"]], [0, None])
    equal(facts["positions_unknown"], f'the extension "{SPZ}" holds the geometry in a form that is not supported')
    why = re.compile(rf'^spz\.glb:/meshes/0/primitives/0/extensions/KHR_gaussian_splatting/extensions/{SPZ}: the extension "{SPZ}" holds the '
                     "geometry in a form that is not supported$")
    for words in (["deform", "spz.glb", "o.glb"], ["check", "spz.glb"], ["embed", "spz.glb", "-o", "e.npy"], ["view", "spz.glb", "-o", "v.png"],
                  ["deform", "spz.glb", "o.ply"]):
        run.ffd(*words, "-l", "move.json", code=UNSUPPORTED, err=why)
        if words[0] != "view":
            run.ffd(*words, "-l", "move.json", "--allow-extension", SPZ, code=UNSUPPORTED, err=why)
    run.ffd("view", "spz.glb", "-o", "v.png", code=UNSUPPORTED, err=why)


def empty(low, high, **extensions):
    asset, data = gltf_json(TRIANGLE)
    asset["accessors"].append({"componentType": 5126, "count": 3, "type": "VEC3", "min": low, "max": high})
    asset["meshes"][0]["primitives"].append({"attributes": {"POSITION": 1}, "mode": 0, "extensions": extensions})
    return asset, data


@case
def accessors_without_bytes_hold_zeros_or_nothing(run):
    """Without a bufferView positions are zeros; not where min and max say otherwise, or an extension holds them."""
    run.write("l.json", LIFT)
    deform = ["deform", "m.glb", "o.glb", "-l", "l.json", "--force"]
    run.write("m.glb", glb(*empty([0] * 3, [0] * 3)))
    run.ffd(*deform)
    elsewhere = re.compile("^m.glb:/accessors/1: the accessor has no bytes, but its min and max are not 0: the positions are in a form that is not "
                           "supported$")
    for extensions in ({}, {"ACME_mesh_compression": {"bufferView": 0}}):
        asset, data = empty([0] * 3, [1] * 3, **extensions)
        asset["extensionsUsed"] = asset["extensionsRequired"] = list(extensions)
        run.write("m.glb", glb(asset, data))
        run.ffd(*deform, code=UNSUPPORTED, err=elsewhere)
        run.ffd(*deform, "--allow-extension", "ACME_mesh_compression", code=UNSUPPORTED, err=elsewhere)
        facts = run.ffd("info", "m.glb", "--json").json
        equal([facts["vertices"], facts["bounds"]["max"]], [3, [1, 1, 0]])
        check("min and max are not 0" in facts["positions_unknown"])
    run.write("m.glb", glb(*empty([0] * 3, [0] * 3, EXT_implicit_geometry={})))
    run.ffd(*deform, code=UNSUPPORTED, err=re.compile('the extension "EXT_implicit_geometry" holds the geometry'))


@case
def offsets_and_indices_without_bytes_are_not_zeros_either(run):
    """Of a morph target and of normals: refused. Of indices: the file is deformed, what it draws is not known."""
    run.write("l.json", LIFT)
    deform = ["deform", "m.glb", "o.glb", "-l", "l.json", "--force"]

    def shown(kind, component, *, low, high, **members):
        asset, data = gltf_json(TRIANGLE)
        asset["accessors"].append({"componentType": component, "count": 3, "type": kind, "min": low, "max": high})
        asset["meshes"][0]["primitives"][0] |= members
        run.write("m.glb", glb(asset, data))
    positions = {"POSITION": 0}
    for members, what in (({"targets": [{"POSITION": 1}]}, "offsets"), ({"attributes": {**positions, "NORMAL": 1}}, "normals")):
        shown("VEC3", 5126, low=[0, 0, 0], high=[0, 5, 0], mode=0, **members)
        for words in (deform, [*deform, "--as-morph", "a"], ["check", "m.glb", "-l", "l.json"], ["view", "m.glb", "-o", "v.png"]):
            run.ffd(*words, code=UNSUPPORTED, err=re.compile(f"^m.glb:/accessors/1: the accessor has no bytes, but its min and max are not 0: the {what} "
                                                             "are in a form that is not supported$"))
        facts = run.ffd("info", "m.glb", "--json").json
        check(f"the {what} are in a form" in facts["positions_unknown"])
        shown("VEC3", 5126, low=[0, 0, 0], high=[0, 0, 0], mode=0, **members)
        run.ffd(*deform)
    for words in (["info", "m.glb"], deform, ["check", "m.glb", "-l", "l.json"]):
        shown("SCALAR", 5123, low=[0], high=[2], mode=4, indices=1)
        one_line(run.ffd(*words, err=anything), "accessor 1 has no bytes, but its max is 2: what the primitive draws is not known")
        shown("SCALAR", 5123, low=[0], high=[0], mode=4, indices=1)
        no_line(run.ffd(*words, err=anything), "has no bytes")


@case
def an_extension_beside_positions_keeps_the_old_geometry(run):
    """What a file holds twice, or beside its vertices, is deformed once: a line says which extension keeps the old one."""
    run.write("l.json", LIFT)
    for name, required in ((SPZ, False), (SPZ, True), ("EXT_primitive_voxels", True), ("ASOBO_asset_optimized", False)):
        asset, data = gltf_json(TRIANGLE)
        asset["extensionsUsed"] = [name]
        if required:
            asset["extensionsRequired"] = [name]
        asset["meshes"][0]["primitives"][0]["extensions"] = {name: {"bufferView": 0}}
        run.write("m.glb", glb(asset, data))
        allow = ["--allow-extension", name] if required else []
        if required:
            run.ffd("deform", "m.glb", "o.glb", "-l", "l.json", "--force", code=UNSUPPORTED,
                    err=re.compile(rf"\(--allow-extension {name} deforms what else the file holds\)$"))
        for words in (["deform", "m.glb", "o.glb", "--force"], ["check", "m.glb"]):
            one_line(run.ffd(*words, "-l", "l.json", *allow, err=anything),
                 f'the extension "{name}" holds geometry in a form of its own, which is not deformed')


# Strips that restart

def unrolled(mode, indices, restart):
    """The mode without restarts, and its indices."""
    runs = [[]]
    for index in indices:
        if index == restart:
            runs.append([])
        else:
            runs[-1].append(index)
    found = []
    for run in runs:
        if mode in (2, 3):
            if len(run) > 1:
                found += [i for pair in zip(run, run[1:] + (run[:1] if mode == 2 else [])) for i in pair]
        else:
            for t in range(len(run) - 2):
                found += [run[0], run[t + 1], run[t + 2]] if mode == 6 else [run[t], run[t + 1 + t % 2], run[t + 2 - t % 2]]
    return 1 if mode in (2, 3) else 4, found


def drawn(mode, indices, component, **members):
    """A wavy grid of 4 x 3 vertices, which this draws."""
    points = [[x, y, x * y % 3 / 4] for y in range(3) for x in range(4)]
    asset, data = gltf_json(points)
    code = {5121: "B", 5123: "H", 5125: "I"}[component]
    packed = struct.pack(f"<{len(indices)}{code}", *indices)
    asset["bufferViews"].append({"buffer": 0, "byteOffset": len(data), "byteLength": len(packed)})
    asset["accessors"].append({"bufferView": 1, "componentType": component, "count": len(indices), "type": "SCALAR"})
    asset["buffers"][0]["byteLength"] += len(packed)
    asset["meshes"][0]["primitives"][0] |= {"mode": mode, "indices": 1}
    return glb({**asset, **members}, data + packed)


RESTART = {"extensionsUsed": ["KHR_mesh_primitive_restart"], "extensionsRequired": ["KHR_mesh_primitive_restart"]}


@case
def wild3_08_strips_restart(run):
    """Strips, fans, lines and loops that restart are what the same triangles and lines are, in every command."""
    run.write("l.json", lattice(low=(-1, -1, -1), high=(4, 3, 2), moves=[{"at": [[2, 3], "all", "all"], "by": [0.5, 0.25, 1]}]))
    for component, r in ((5121, 255), (5123, 65535), (5125, 2 ** 32 - 1)):
        for mode in (2, 3, 5, 6):
            for indices in ([0, 4, 1, 5, 2, 6, 3, 7, r, 4, 8, 5, 9, 6, 10, 7, 11], [r, r, 0, 1, 4, r, 5, 4, 1, 2, 6, r, r, 3, r, 8, 9, r],
                            [r, r], [0, 1, 4, r]):
                run.write("a.glb", drawn(mode, indices, component, **RESTART))
                run.write("b.glb", drawn(*unrolled(mode, indices, r), component))
                a, b = (run.ffd("info", name, "--json", "--strict").json for name in ("a.glb", "b.glb"))
                equal(a["topology"], b["topology"], (mode, indices))
                for key in ("triangles", "lines", "points"):
                    equal(a["contents"]["stored"][key], b["contents"]["stored"][key], (mode, indices, key))
                for name in "ab":
                    run.ffd("deform", name + ".glb", name + ".obj", "-l", "l.json", "--force", "--strict", err=anything)
                    run.ffd("check", name + ".glb", "-l", "l.json", "--report", name + ".json", err=anything)
                equal(run.text("a.obj").replace("a.glb", "b.glb"), run.text("b.obj"), (mode, indices))
                a, b = (json.loads(run.text(name + ".json"))["jobs"][0] for name in "ab")
                for key in ("unused", "flipped_faces", "tear", "area", "volume", "edges", "bounds"):
                    equal(a[key], b[key], (mode, indices, key))
    run.ffd("deform", "a.glb", "o.glb", "-l", "l.json")
    asset, data = glb_split(run.read("o.glb"))
    before, old = glb_split(run.read("a.glb"))
    equal([asset["meshes"], data[144:]], [before["meshes"], old[144:]], "what is drawn stays as it is")


@case
def an_index_that_is_none_stays_a_flaw(run):
    """Without the extension, in triangles, and where another index is too large."""
    strip = [0, 4, 1, 255, 4, 8, 5]
    for name, content in (("no.glb", drawn(5, strip, 5121)), ("triangles.glb", drawn(4, [0, 4, 1, 255, 8, 5], 5121, **RESTART)),
                          ("large.glb", drawn(5, [0, 4, 1, 255, 4, 12, 5], 5121, **RESTART))):
        run.write(name, content)
        one_line(run.ffd("info", name, err=anything), "what the primitive draws is not known", "index 12" if name == "large.glb" else "index 255")
        run.ffd("info", name, "--strict", code=INVALID, err=anything)


# Words

@case
def artist_10_hints_name_what_is_meant(run):
    """An axis in capitals, with a sign, a word for an index: the hint is what the user meant, or all that there is."""
    run.write("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\n")
    sign = 'the axis "{}" has a sign; write [{}] for that direction'
    index = 'is the text "{}", not an index (0, "first" or "bottom": the first layer; -1, "last" or "top": the last), a range [lo, hi] or "all"'
    axes = 'unknown word "{}"; known ones are "x", "y", "z"'
    nearest = 'unknown word "{}"; the nearest known one is "{}"'
    for word, why in (("Y", nearest.format("Y", "y")), ("Z", nearest.format("Z", "z")), ("-y", sign.format("-y", "0, -1, 0")),
                      ("-Z", sign.format("-Z", "0, 0, -1")), ("x-", sign.format("x-", "-1, 0, 0")), ("Y-", sign.format("Y-", "0, -1, 0")), ("+x", nearest.format("+x", "x")), ("up", axes.format("up")), ("w", axes.format("w")),
                      ("XY", axes.format("XY"))):
        for move, at in (({"twist": {"axis": word, "degrees": 90}}, "twist/axis"),
                         ({"bend": {"axis": "x" if "y" in word.lower() else "y", "toward": word, "degrees": 9}}, "bend/toward")):
            run.write("l.json", lattice(moves=[move]))
            run.ffd("check", "m.obj", "-l", "l.json", code=INVALID, err=f"l.json:1: /moves/0/{at}: {why}")
    for word in ("Top", "al", "ALL", "lst", "-1"):
        run.write("l.json", lattice(moves=[{"at": ["all", word, "all"], "by": [0, 1, 0]}]))
        run.ffd("check", "m.obj", "-l", "l.json", code=INVALID, err="l.json:1: /moves/0/at/1: " + index.format(word))
    for word, layer in (("top", -1), ("last", -1), ("bottom", 0), ("first", 0)):
        for at in (word, [word, word]):
            for name, chosen in (("w.obj", at), ("i.obj", layer)):
                run.write("l.json", lattice(moves=[{"at": ["all", chosen, "all"], "by": [0, 1, 0]}]))
                run.ffd("deform", "m.obj", name, "-l", "l.json", "--force", err=anything)
            check(run.read("w.obj") == run.read("i.obj") != run.read("m.obj"), word)
    for members, at, why in (({"rest": {"box": "Mesh"}}, "rest/box", nearest.format("Mesh", "mesh")), ({"units": "BOX"}, "units", nearest.format("BOX", "box")),
                             ({"knots": ["Clamped"] * 3}, "knots/0", nearest.format("Clamped", "clamped")),
                             ({"moves": [{"By": [1, 0, 0]}]}, "moves/0/By", 'unknown key "By"; the nearest known one is "by"'),
                             ({"moves": [{"by": [1, 0, 0], "mirror": "X"}]}, "moves/0/mirror", nearest.format("X", "x"))):
        run.write("l.json", lattice(**members))
        run.ffd("check", "m.obj", "-l", "l.json", code=INVALID, err=f"l.json:1: /{at}: {why}")
    run.write("l.json", LIFT)
    for words, why in ((["--outside", "Keep"], '--outside: "Keep" is not one of keep, extend, error (nearest: keep)'),
                       (["--normals", "none"], '--normals: "none" is not one of transform, keep, recompute'),
                       (["--fail-on", "FOLDS"], '--fail-on: unknown gate "FOLDS" (nearest: folds)'),
                       (["--fail-on", "quick"], '--fail-on: unknown gate "quick" (known: folds, outside, multiple, singular, invalid, tear, flipped, edges, inverted, quality)'),
                       (["--only", "part:a"], '--only: unknown kind "part", not node, mesh, material, group or object'),
                       (["--widgets"], "unknown option --widgets (--help lists the known ones)")):
        run.ffd("check", "m.obj", "-l", "l.json", *words, code=USAGE, err=why)
    run.ffd("view", "m.obj", "-o", "v.png", "--camera", "Front", code=USAGE,
            err='--camera: "Front" is not front, back, left, right, top, bottom, iso or a direction like 1,0.5,2 (nearest: front)')
    for side in ("-front", "top-"):
        run.ffd("view", "m.obj", "-o", "v.png", "--camera", side, code=USAGE,
                err=f'--camera: "{side}" is not front, back, left, right, top, bottom, iso or a direction like 1,0.5,2')
    for up, why in (("-y", ""), ("Z-", ""), ("Z", " (nearest: z)"), ("+x", " (nearest: x)")):
        run.ffd("view", "m.obj", "-o", "v.png", "--up", up, code=USAGE, err=f'--up: "{up}" is not one of y, z, x{why}')
    for words, why in ((["--axis", "Y"], "x, y, z or a direction like 0,1,1 (nearest: y)"), (["--axis", "up"], "x, y, z or a direction like 0,1,1"),
                       (["--axis", "-Y"], "x, y, z or a direction like 0,1,1 (that direction is 0,-1,0)"),
                       (["--axis", "x-"], "x, y, z or a direction like 0,1,1 (that direction is -1,0,0)"),
                       (["--knots", "open,Closed,open"], "one or three of clamped, open, uniform, closed (nearest: closed)")):
        run.ffd("lattice", "new", "m.obj", "-o", "n.json", *words, code=USAGE, err=f'{words[0]}: "{words[1]}" is not {why}')


# Colours of faces

def ply_faces(data):
    """The property lines of the faces, and the bytes behind the corners of each triangle."""
    header, _, body = data.partition(b"end_header\n")
    lines = header.decode().split("\n")
    vertices, faces = (int(next(line for line in lines if line.startswith("element " + name)).split()[2]) for name in ("vertex", "face"))
    properties = lines[lines.index(f"element face {faces}") + 2:]
    size = (len(body) - 24 * vertices) // faces
    return properties[:-1], [body[24 * vertices + i * size + 13:24 * vertices + (i + 1) * size] for i in range(faces)]


OFF = "OFF\n4 3 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n"


@case
def wild3_19_colours_of_faces_are_kept(run):
    """OFF to PLY and back, bytes and fractions, with alpha, with a face that has no colour; STL to both; the line elsewhere."""
    run.write("l.json", lattice(low=(-1, -1, -1), high=(2, 2, 2), moves=[{"by": [0, 0, 1]}]))
    byte = [f"property uchar {name}" for name in ("red", "green", "blue", "alpha")]
    grey = bytes([170, 170, 170])
    for faces, properties, colours, back in (
            ("3 0 1 2 230 20 20\n3 0 2 3 0 0 1\n3 1 2 3\n", byte[:3], [bytes([230, 20, 20]), bytes([0, 0, 1]), grey],
             ["3 0 1 2 230 20 20", "3 0 2 3 0 0 1", "3 1 2 3 170 170 170"]),
            ("3 0 1 2 1.0 0 0\n3 0 2 3 0 0 1.0 0.2\n3 1 2 3 0 0 0.0\n", byte, [bytes([255, 0, 0, 255]), bytes([0, 0, 255, 51]), bytes([0, 0, 0, 255])],
             ["3 0 1 2 255 0 0 255", "3 0 2 3 0 0 255 51", "3 1 2 3 0 0 0 255"]),
            ("3 0 1 2 0.25 0.5 0.1\n3 0 2 3\n3 1 2 3\n", [p.replace("uchar", "float") for p in byte[:3]], None, None)):
        run.write("m.off", OFF + faces)
        run.ffd("deform", "m.off", "m.ply", "-l", "l.json", "--force")
        found = ply_faces(run.read("m.ply"))
        equal(found[0], properties)
        if colours:
            equal(found[1], colours)
            run.ffd("deform", "m.ply", "n.off", "-l", "l.json", "--force")
            equal(run.text("n.off").splitlines()[6:], back)
        for name in ("m.off", "m.ply"):
            for out in ("m.obj", "m.glb", "m.stl"):
                one_line(run.ffd("deform", name, out, "-l", "l.json", "--force", err=anything), "cannot hold", "face colours")
            one_line(run.ffd("view", name, "-o", "v.png", "--force", err=anything), "the colours of faces are not shown")
    # A 1 that a program has written without its point is white, before and after the fractions; among bytes it is not.
    for faces, back in (("3 0 1 2 1 1 1\n3 0 2 3 0.5 0.25 1\n3 1 2 3 0 1 0\n", ["1.0 1.0 1.0", "0.5 0.25 1.0", "0.0 1.0 0.0"]),
                        ("3 0 1 2 1 0 0 1\n2 0 1 1 1 1\n3 0 2 3 0.5 0 0 0.5\n", ["1.0 0.0 0.0 1.0", "0.5 0.0 0.0 0.5"]),
                        ("3 0 1 2 1 1 1\n3 0 2 3\n3 1 2 3 1e-1 0 0\n", ["1.0 1.0 1.0", "0.6666666865348816 0.6666666865348816 0.6666666865348816",
                                                                    "0.10000000149011612 0.0 0.0"]),
                        ("3 0 1 2 51 51 51\n3 0 2 3 1 0 0\n3 1 2 3 0.5 0 0\n", ["0.20000000298023224 0.20000000298023224 0.20000000298023224",
                                                                             "0.003921568859368563 0.0 0.0", "0.5 0.0 0.0"])):
        run.write("m.off", OFF + faces)
        run.ffd("deform", "m.off", "m.ply", "-l", "l.json", "--force", err=anything)
        run.ffd("deform", "m.ply", "n.off", "-l", "l.json", "--force", err=anything)
        equal([line.split(" ", 4)[4] for line in run.text("n.off").splitlines()[6:] if line.startswith("3")], back)
    # Other spellings, and what is no colour.
    run.write("a.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
                       "property uchar diffuse_blue\nproperty list uchar int vertex_indices\nproperty uchar diffuse_red\n"
                       "property uchar diffuse_green\nproperty int id\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 3 0 1 2 1 2 7\n")
    one_line(run.ffd("deform", "a.ply", "a.off", "-l", "l.json", err=anything), "further data of vertices and faces")
    equal(run.text("a.off").splitlines()[-1], "3 0 1 2 1 2 3")
    # Numbers of other ranges mean what they mean for vertices.
    for kind, colours, back, line in (("int", ["255 0 0", "0 0 200"], ["255 0 0", "0 0 200"], None),
                                      ("float", ["255 0 0", "0 0 200"], ["255 0 0", "0 0 200"], None),
                                      ("float", ["1.5 0 0", "0 0 1"], ["255 0 0", "0 0 255"], "above 1, and 1 in OFF: 1 colour$"),
                                      ("float", ["nan 0 0", "0 0 1"], ["0 0 0 0", "0 0 255 255"], "not finite as numbers of OFF, and zero: .* 1 colour$")):
        header = "".join(f"property {kind} {name}\n" for name in ("red", "green", "blue"))
        run.write("a.ply", "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 2\n"
                           f"property list uchar int vertex_indices\n{header}end_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
                           f"3 0 1 2 {colours[0]}\n3 0 2 3 {colours[1]}\n")
        done = run.ffd("deform", "a.ply", "a.off", "-l", "l.json", "--force", err=anything)
        equal(run.text("a.off").splitlines()[-2:], [f"3 0 1 2 {back[0]}", f"3 0 2 3 {back[1]}"])
        one_line(done, line) if line else equal(done.err, [])
        no_line(run.ffd("deform", "a.ply", "a.glb", "-l", "l.json", "--force", err=anything), "above 1|not finite")
    run.write("m.off", OFF + "3 0 1 2 300 0 0\n3 0 2 3 0 0 1\n3 1 2 3 0 0 1\n")
    one_line(run.ffd("deform", "m.off", "m.ply", "-l", "l.json", "--force", err=anything), "above 1, and 1 in PLY: 1 colour")
    run.write("m.off", OFF + "3 0 1 2 7\n3 0 2 3\n3 1 2 3\n")
    one_line(run.ffd("deform", "m.off", "m.ply", "-l", "l.json", "--force", err=anything), "further data of vertices and faces")


@case
def colours_of_stl_facets_are_kept(run):
    """Five bits each, red first or last, as the header says; without a valid colour a facet is grey."""
    run.write("l.json", lattice(low=(-1, -1, -1), high=(2, 2, 2), moves=[{"by": [0, 0, 1]}]))
    for header, attributes, colours in ((b"x", (0x8000 | 31 << 10 | 5, 0x8000 | 31 << 5, 0), [(255, 0, 41), (0, 255, 0), (170, 170, 170)]),
                                        (b"a COLOR=\xff\xff\xff\xff", (31 | 5 << 10, 31 << 5, 0x8000), [(255, 0, 41), (0, 255, 0), (170, 170, 170)])):
        facets = b"".join(struct.pack("<12fH", 0, 0, 1, 0, 0, i, 1, 0, i, 0, 1, i, attribute) for i, attribute in enumerate(attributes))
        run.write("m.stl", header.ljust(80, b"\0") + struct.pack("<I", len(attributes)) + facets)
        done = run.ffd("deform", "m.stl", "m.ply", "-l", "l.json", "--force", err=anything)
        no_line(done, "face colours")
        near = [[round(255 * x) for x in struct.unpack("<3f", colour)] for colour in ply_faces(run.read("m.ply"))[1]]
        equal(near, [list(c) for c in colours])
        one_line(run.ffd("deform", "m.stl", "m.obj", "-l", "l.json", "--force", err=anything), "face colours")


# What a file needs beside it

def textured_ply(*names):
    return ("ply\nformat ascii 1.0\n" + "".join(f"comment TextureFile {name}\n" for name in names) + "element vertex 3\nproperty float x\n"
            "property float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\n"
            "property int texnumber\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 6 0 0 1 0 0 1 0\n")


def files_in(run, folder):
    return sorted(os.path.relpath(os.path.join(where, name), run.path(folder)) for where, _, names in os.walk(run.path(folder)) for name in names)


@case
def wild3_12_textures_of_a_ply_go_along(run):
    """The images of "comment TextureFile" are copied with an output in another folder, as those of other formats; or a line says what is left."""
    run.write("l.json", LIFT)
    run.write("in/m.ply", textured_ply("a.png", "sub/two words.png", "gone.png", "/tmp/x.png", "sub\\b.png"))
    for name in ("a.png", "sub/two words.png", "sub/b.png"):
        run.write("in/" + name, PNG + name.encode())
    run.folder_of("out")
    done = run.ffd("deform", "in/m.ply", "out/m.ply", "-l", "l.json", err=anything)
    equal(done.err, ['in/m.ply: the image "gone.png" is missing and was not copied'])
    equal(files_in(run, "out"), ["a.png", "m.ply", "sub/b.png", "sub/two words.png"])
    equal(run.read("out/sub/b.png"), PNG + b"sub/b.png")
    run.folder_of("ref")
    done = run.ffd("deform", "in/m.ply", "ref/m.ply", "-l", "l.json", "--resources", "reference", err=anything)
    one_line(done, r'the output does not reach the image "a\.png" \(--resources copy copies it\)')
    equal(files_in(run, "ref"), ["m.ply"])
    run.ffd("deform", "in/m.ply", "in/n.ply", "-l", "l.json")
    run.write("up/in/m.ply", textured_ply("../out.png"))
    run.write("up/out.png", PNG)
    run.folder_of("up/to/x")
    one_line(run.ffd("deform", "up/in/m.ply", "up/to/x/m.ply", "-l", "l.json", err=anything), "cannot be copied")
    one_line(run.ffd("deform", "in/m.ply", "out/m.obj", "-l", "l.json", err=anything), "cannot hold", "textures")
    one_line(run.ffd("view", "in/m.ply", "-o", "v.png", err=anything), "the textures that the file names are not shown")
    # Two jobs of a batch that would copy different images to one place.
    run.write("b/m.ply", textured_ply("a.png"))
    run.write("b/a.png", PNG + b"other")
    run.write("m.jsonl", "".join(json.dumps({"in": f"{name}/m.ply", "lattice": "l.json", "out": f"all/{name}.ply"}) + "\n" for name in ("in", "b")))
    run.folder_of("all")
    run.ffd("batch", "m.jsonl", "-q", code=1, err=re.compile("a\\.png"))


def image_of(gltf, number=0):
    head, _, data = json.loads(gltf)["images"][number]["uri"].partition(",")
    return head, base64.b64decode(data)


@case
def artist_14_a_glb_of_a_gltf_holds_its_images(run):
    """In another folder and in its own, on stdout, as .vrm, in a batch where two images have one name: the GLB needs no file."""
    run.write("l.json", LIFT)
    asset, data = gltf_json(TRIANGLE, uri="m.bin")
    jpeg = b"\xff\xd8\xff\xe0\0\x10JFIF" + bytes(50)
    asset["images"] = [{"uri": "tex/a.png", "name": "a"}, {"uri": "b%20c.jpg"}, {"uri": "gone.png"}, {"uri": "data:image/png;base64,iVBORw0KGgo="}]
    for folder, more in (("in", b"1"), ("b", b"2")):
        run.write(folder + "/m.gltf", asset)
        run.write(folder + "/m.bin", data)
        run.write(folder + "/tex/a.png", PNG + more)
        run.write(folder + "/b c.jpg", jpeg)
    run.folder_of("out")
    for out in ("out/m.glb", "in/m.glb", "out/m.vrm"):
        done = run.ffd("deform", "in/m.gltf", out, "-l", "l.json", err=anything)
        equal(done.err, ['in/m.gltf: the image "gone.png" is missing and is not in the output'])
        text = json.dumps(glb_split(run.read(out))[0])
        equal([image_of(text), image_of(text, 1)], [("data:image/png;base64", PNG + b"1"), ("data:image/jpeg;base64", jpeg)])
        equal(json.loads(text)["images"][2:], asset["images"][2:])
    equal(files_in(run, "out"), ["m.glb", "m.vrm"])
    done = run.ffd("deform", "in/m.gltf", "-", "--output-format", "glb", "-l", "l.json", err=anything)
    equal(done.out, run.read("out/m.glb"))
    # By reference it names them where they are, and a .gltf of the GLB keeps them.
    run.ffd("deform", "in/m.gltf", "out/r.glb", "-l", "l.json", "--resources", "reference")
    equal(glb_split(run.read("out/r.glb"))[0]["images"][0]["uri"], "../in/tex/a.png")
    run.ffd("deform", "out/m.glb", "out/n.gltf", "-l", "l.json", err=anything)
    equal(image_of(run.text("out/n.gltf")), ("data:image/png;base64", PNG + b"1"))
    # Two models whose images have one name.
    run.folder_of("all")
    run.write("m.jsonl", "".join(json.dumps({"in": f"{name}/m.gltf", "lattice": "l.json", "out": f"all/{name}.glb"}) + "\n" for name in ("in", "b")))
    run.ffd("batch", "m.jsonl", "-q", err=anything)
    equal([image_of(json.dumps(glb_split(run.read(f"all/{name}.glb"))[0]))[1] for name in ("in", "b")], [PNG + b"1", PNG + b"2"])
    equal(files_in(run, "all"), ["b.glb", "in.glb"])
    # What is no image is not taken in.
    run.write("in/tex/a.png", "echo")
    one_line(run.ffd("deform", "in/m.gltf", "out/t.glb", "-l", "l.json", err=anything), '"tex/a.png" does not have the content of an image and is not in the output')
    run.write("in/m.gltf", {**asset, "images": [{"uri": "tex/a.png"}] * 40})
    run.write("in/tex/a.png", PNG + bytes(2 << 20))
    run.ffd("deform", "in/m.gltf", "out/l.glb", "-l", "l.json", code=LIMIT, err=re.compile("memory"))
    check(not run.exists("out/l.glb"), "nothing is written")
    # Images of their own are files of the job: they need no --memory, however large they are.
    run.write("in/m.gltf", {**asset, "images": [{"uri": f"tex/{i}.png"} for i in range(12)]})
    for i in range(12):
        run.write(f"in/tex/{i}.png", PNG + bytes([i]) * (3 << 20))
    run.ffd("deform", "in/m.gltf", "out/l.glb", "-l", "l.json")
    text = json.dumps(glb_split(run.read("out/l.glb"))[0])
    equal([image_of(text, i)[1] for i in (0, 11)], [PNG + bytes([i]) * (3 << 20) for i in (0, 11)])


@case
def images_that_a_glb_cannot_hold_stay_uris(run):
    """Outside of the model's folder, by name or by a link, or at an absolute address: a line names each. A .gltf says less."""
    run.write("l.json", LIFT)
    asset, data = gltf_json(TRIANGLE, uri="m.bin")
    run.write("in/m.bin", data)
    run.write("out.png", PNG + b"secret")
    os.symlink("../out.png", run.path("in/link.png"))
    run.folder_of("out")
    outside, address, no_name = "is outside the model's folder and is not in the output", "is not a file beside the model and is not in the output", \
        "is not the name of a file"
    for uri, shown, why, as_gltf in (("../out.png", "../out.png", outside, IO), ("link.png", "link.png", outside, IO),
                                     ("%2e%2e/out.png", "../out.png", outside, IO), ("https://x.org/a.png", "https://x.org/a.png", address, 0),
                                     ("/a.png", "/a.png", address, 0), ("C:/a.png", "C:/a.png", address, 0), ("", "", no_name, 0),
                                     ("a.png\0.png", r"a.png\u0000.png", no_name, 0)):
        run.write("in/m.gltf", {**asset, "images": [{"uri": uri}]})
        one_line(run.ffd("deform", "in/m.gltf", "out/m.glb", "-l", "l.json", "--force", err=anything), re.escape(f'm.gltf: the image "{shown}" {why}') + "$")
        written = run.read("out/m.glb")
        equal(glb_split(written)[0]["images"], [{"uri": uri}])
        check(b"secret" not in written)
        done = run.ffd("deform", "in/m.gltf", "out/m.gltf", "-l", "l.json", "--force", code=as_gltf, err=anything)
        equal(len(done.err), 1 if as_gltf or why == no_name else 0, done.err)
        done = run.ffd("deform", "in/m.gltf", "out/r.glb", "-l", "l.json", "--force", "--resources", "reference", err=anything)
        equal(len(done.err), 1 if why == no_name else 0, done.err)


@case
def wild3_13_files_of_extensions_are_named(run):
    """What extensions name by uri stays, and a line says so where the output does not reach it."""
    run.write("l.json", LIFT)
    asset, data = gltf_json(TRIANGLE, uri="m.bin")
    asset["extensions"] = {"EXT_structural_metadata": {"schemaUri": "schema.json"},
                           "KHR_audio_emitter": {"audio": [{"uri": "a%20b.mp3"}, {"uri": "data:audio/mpeg;base64,AAAA"}, {"uri": "https://x.org/a.mp3"}]},
                           "MPEG_media": {"media": [{"alternatives": [{"uri": "v.mp4"}, {"uri": "../v.mp4"}, {"uri": "./v.mp4"}]}]}}
    asset["extensions"]["MSFT_audio_emitter"] = {"clips": [{"uri": "a%20b.mp3"}]}  # named before, and counted once
    asset["nodes"][0]["extensions"] = {"EXT_x": {"extras": {"uri": "no.txt"}, "name": "uri"}}
    asset["extras"] = {"extensions": {"X": {"uri": "no.txt"}}}
    run.write("in/m.gltf", asset)
    run.write("in/m.bin", data)
    run.write("in/schema.json", "{}")
    run.folder_of("out")
    line = (r'4 files that extensions name are not copied: "schema\.json" of EXT_structural_metadata, "a b\.mp3" of KHR_audio_emitter, '
            r'"v\.mp4" of MPEG_media and 1 more$')
    for words in (["out/m.gltf"], ["out/m.glb"], ["out/n.gltf", "--resources", "reference"]):
        one_line(run.ffd("deform", "in/m.gltf", *words, "-l", "l.json", err=anything), line)
    run.ffd("deform", "in/m.gltf", "in/n.gltf", "-l", "l.json")
    run.write("out/schema.json", "{}")
    one_line(run.ffd("deform", "in/m.gltf", "out/m.gltf", "-l", "l.json", "--force", err=anything), "3 files that extensions name are not copied")


@case
def files_of_obj_statements_are_named(run):
    """call, maplib, shadow_obj and trace_obj name files: they stay, a line says so, and they are not replaced by OUT."""
    run.write("l.json", LIFT)
    mesh = "mtllib m.mtl\nshadow_obj my shadow.obj\ntrace_obj t.obj\nmaplib a.map b.map\ncall c.obj 1 2\ncall c.obj 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
    run.write("in/m.obj", mesh)
    run.write("in/m.mtl", "newmtl a\n")
    run.write("in/c.obj", "precious")
    run.folder_of("out")
    line = (r'm\.obj: 5 files that statements name are not copied: "c\.obj" of call, "a\.map" of maplib, "b\.map" of maplib and 2 more$')
    for words in ([], ["--resources", "reference", "--force"]):
        one_line(run.ffd("deform", "in/m.obj", "out/m.obj", *words, "-l", "l.json", err=anything), line)
    equal(files_in(run, "out"), ["m.mtl", "m.obj"])
    for name in ("t.obj", "b.map", "my shadow.obj", "a.map"):
        run.write("out/" + name, "there")
    one_line(run.ffd("deform", "in/m.obj", "out/m.obj", "--force", "-l", "l.json", err=anything),
         r'm\.obj: 1 file that a statement names is not copied: "c\.obj" of call$')
    run.ffd("deform", "in/m.obj", "in/n.obj", "-l", "l.json")
    run.ffd("deform", "in/m.obj", "in/c.obj", "-l", "l.json", "--force", code=IO,
            err="in/c.obj: is a file that is named by the input in/m.obj and is not overwritten")
    equal(run.text("in/c.obj"), "precious")
    # Other files take no notice of such words.
    run.write("in/n.obj", "g call x.obj\n# call y.obj\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    run.ffd("deform", "in/n.obj", "out/n.obj", "-l", "l.json")


@case
def what_standard_input_names_is_told(run):
    """It has no folder, so that nothing goes along: one line names the files that the output does not reach."""
    run.write("l.json", LIFT)
    for name in ("m.mtl", "n.mtl", "a.png"):
        run.write(name, "beside where the program runs, which counts for nothing")
    run.folder_of("out")
    asset, data = gltf_json(TRIANGLE)
    asset["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
    asset["images"] = [{"uri": "a%20b.png"}, {"uri": "a%20b.png"}, {"uri": "data:image/png;base64,AAAA"}, {"uri": "c.jpg"}]
    asset["extensions"] = {"EXT_structural_metadata": {"schemaUri": "s.json"}}
    corners = "0 0 0\n1 0 0\n0 1 0\n"
    cases = (("obj", "mtllib m.mtl\nmtllib n.mtl m.mtl\ncall x/c.obj\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
              '3 files that the mesh names are not copied, as standard input has no folder: "m.mtl" of mtllib, "n.mtl" of mtllib, "x/c.obj" of call'),
             ("ply", "ply\nformat ascii 1.0\ncomment TextureFile a.png\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nend_header\n" + corners,
              '1 file that the mesh names is not copied, as standard input has no folder: "a.png" of TextureFile'),
             ("gltf", json.dumps(asset), '3 files that the mesh names are not copied, as standard input has no folder: "a b.png" of images, '
              '"c.jpg" of images, "s.json" of EXT_structural_metadata'))
    for ending, text, said in cases:
        words = ["deform", "-", f"out/m.{ending}", "--input-format", ending, "-l", "l.json"]
        one_line(run.ffd(*words, stdin=text.encode(), err=anything), re.escape(said) + "$")
        # To standard output nothing can go along; and what is beside the output already needs no word.
        run.ffd("deform", "-", "-", "--input-format", ending, "--output-format", ending, "-l", "l.json", stdin=text.encode())
    for name in ("m.mtl", "n.mtl", "x/c.obj", "a.png", "a b.png", "c.jpg", "s.json"):
        run.write("out/" + name, "there")
    for ending, text, _ in cases:
        run.ffd("deform", "-", f"out/m.{ending}", "--input-format", ending, "-l", "l.json", "--force", stdin=text.encode())


@case
def of_what_there_is_none_is_said_so(run):
    """A number of a thing of which the file has none: "only 0" is no answer."""
    head = "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
    asset = {"asset": {"version": "2.0"}, "nodes": [{"mesh": 0}]}
    mesh = {"meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}]}
    for name, content, told_ in (
            ("m.off", "OFF\n0 1 0\n3 0 1 2\n", "m.off:3: there is no vertex 0: the file has none"),
            ("m.ply", head + "property list uchar int vertex_indices\nend_header\n3 0 1 2\n", "m.ply:10: face 0: there is no vertex 0: the file has none"),
            ("m.gltf", asset, "m.gltf:1: /nodes/0/mesh: there is no mesh 0: the file has none"),
            ("m.gltf", {**asset, "meshes": [], "nodes": [{"skin": 0}]}, "m.gltf:1: /nodes/0/skin: there is no skin 0: the file has none"),
            ("m.gltf", {**asset, **mesh, "accessors": []}, "m.gltf:1: /meshes/0/primitives/0/attributes/POSITION: there is no accessor 0: the file has none"),
            ("m.gltf", {"asset": {"version": "2.0"}, "scene": 2}, "m.gltf:1: /scene: there is no scene 2: the file has none")):
        run.write(name, content)
        run.ffd("info", name, code=INVALID, err=told_)


@case
def wild3_14_tiles_go_along(run):
    """A map whose name stands for tiles: those that exist are copied; a picture says why it is grey."""
    run.write("l.json", LIFT)
    run.write("in/m.obj", "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1.5 0\nusemtl a\nf 1/1 2/2 3/1\n")
    run.write("in/m.mtl", "newmtl a\nmap_Kd tex/s.<UDIM>.png\nbump n_<UVTILE>.png\nmap_Ks none.<UDIM>.png\n")
    tiles = ["tex/s.1001.png", "tex/s.1010.png", "tex/s.1101.png", "n_u1_v1.png", "n_u10_v2.png"]
    for name in [*tiles, "tex/s.1000.png", "tex/s.png", "tex/s.3001.png", "n_u0_v1.png"]:
        run.write("in/" + name, PNG + name.encode())
    run.folder_of("out")
    done = run.ffd("deform", "in/m.obj", "out/m.obj", "-l", "l.json", err=anything)
    equal(done.err, ['in/m.obj: the image "none.<UDIM>.png" is missing and was not copied'])
    equal(files_in(run, "out"), sorted([*tiles, "m.mtl", "m.obj"]))
    one_line(run.ffd("view", "in/m.obj", "-o", "v.png", err=anything), r'cannot be shown: "tex/s\.<UDIM>\.png" has tiles$')
    # Other spellings, and a name that no file has.
    for name, found in (("tex/s.<udim>.png", tiles[:3]), ("tex/s.%(UDIM)d.png", tiles[:3]), ("n_u<U>_v<V>.png", tiles[3:]), ("n_u<U>_v1.png", tiles[3:4]),
                        ("n_u<u>_v<v>.png", ["n_u0_v1.png", "n_u1_v1.png"]), ("<UDIM>/<UDIM>.png", ["1002/1002.png"])):
        run.write("in/m.mtl", f"newmtl a\nmap_Kd {name}\n")
        run.write("in/1002/1002.png", PNG)
        run.folder_of("to/x")
        run.ffd("deform", "in/m.obj", "to/x/m.obj", "-l", "l.json", err=[])
        equal(files_in(run, "to/x"), sorted([*found, "m.mtl", "m.obj"]), name)
        shutil.rmtree(run.path("to"))
    run.write("in/m.mtl", "newmtl a\nmap_Kd <UDIM>" + "<" * 100000 + ".png\n")
    run.folder_of("to/x")
    one_line(run.ffd("deform", "in/m.obj", "to/x/m.obj", "-l", "l.json", err=anything), "the image \"<UDIM><<<<", "missing and was not copied$")
    run.write("in/m.mtl", "newmtl a\n" + "".join(f"map_Kd {i}.<UDIM>.png\n" for i in range(300)))
    run.ffd("deform", "in/m.obj", "out/n.obj", "-l", "l.json", code=LIMIT, err=re.compile("m.mtl: names more than 256 maps with tiles"))


# Compressed geometry

KHR_MESHOPT = "wild3-10-meshopt-version-1"


def linear(srgb):
    return srgb / 12.92 if srgb <= 0.04045 else ((srgb + 0.055) / 1.055) ** 2.4


def columns(text, key):
    return [[float(x) for x in line.split()[1:]] for line in text.splitlines() if line.startswith(key + " ")]


@case
def wild3_10_meshopt_version_1(run):
    """What a packer of 2025 wrote: positions and normals in version 1 of the codec, and triangles."""
    use(run, KHR_MESHOPT)
    facts = run.ffd("info", "packed.glb", "--json").json
    equal([facts["contents"]["stored"]["triangles"], facts.get("flaws", [])], [242, []])
    done = run.ffd("deform", "packed.glb", "out.glb", "-l", "twist.json", "--report", "r.json", err=anything)
    one_line(done, "1 bufferView is written uncompressed")
    counts(json.loads(run.text("r.json"))["jobs"][0], vertices=144, inside=144, moved=144)
    asset, _ = glb_split(run.read("out.glb"))
    check("KHR_meshopt_compression" in asset["extensionsRequired"], "what is not moved stays compressed")


@case
def every_mode_and_filter_of_meshopt(run):
    """A sheet of 25 vertices at (x, y, xy), with the normals, colours and texture coordinates that belong there, an offset of x^2/8
    as its morph target, and its border as a loop."""
    use(run, KHR_MESHOPT)
    run.write("l.json", lattice(low=(-1, -1, -1), high=(2, 2, 2), moves=[{"by": [0, 0, 1]}]))
    run.ffd("deform", "every.glb", "o.obj", "-l", "l.json", err=anything)
    text, grid = run.text("o.obj"), [(i % 5 / 4, i // 5 / 4) for i in range(25)]
    vertices = columns(text, "v")
    near([v[:3] for v in vertices], [[x, y, x * y + 1] for x, y in grid], 1e-9, "positions")
    near([[linear(c) for c in v[3:]] for v in vertices], [[x, y, 1 - x] for x, y in grid], 0.02, "colours")
    near(columns(text, "vt"), [[x, 1 - y] for x, y in grid], 1e-4, "texture coordinates")
    near(columns(text, "vn"), [[c / (1 + x * x + y * y) ** 0.5 for c in (-y, -x, 1)] for x, y in grid], 0.015, "normals")
    faces = [{int(corner.split("/")[0]) - 1 for corner in line.split()[1:]} for line in text.splitlines() if line.startswith("f ")]
    expected = [{a, a + 1, a + 5} for a in range(24) if a % 5 < 4 and a < 20] + [{a + 1, a + 5, a + 6} for a in range(24) if a % 5 < 4 and a < 20]
    equal(sorted(map(sorted, faces)), sorted(map(sorted, expected)))
    ring = [0, 1, 2, 3, 4, 9, 14, 19, 24, 23, 22, 21, 20, 15, 10, 5]
    found = [[int(c.split("/")[0]) - 1 for c in line.split()[1:]] for line in text.splitlines() if line.startswith("l ")]
    equal(found, [list(pair) for pair in zip(ring, ring[1:] + ring[:1])])
    asset, data = glb_split(run.read("every.glb"))
    asset["meshes"][0]["weights"] = [1]
    run.write("bent.glb", glb(asset, data))
    run.ffd("deform", "bent.glb", "b.obj", "-l", "l.json", err=anything)
    near([v[2] for v in columns(run.text("b.obj"), "v")], [x * y + 1 + x * x / 8 for x, y in grid], 1e-4, "the morph target")
    one_line(run.ffd("deform", "every.glb", "o.glb", "-l", "l.json", err=anything), "bufferView.* written uncompressed")
    run.ffd("deform", "every.glb", "m.glb", "--morph", "up=l.json", err=anything)


@case
def broken_streams_of_meshopt(run):
    """Version 2 is refused as unsupported; what version 1 cannot hold as invalid, with what it is."""
    use(run, KHR_MESHOPT)
    asset, data = glb_split(run.read("every.glb"))
    packed = [view["extensions"]["KHR_meshopt_compression"] for view in asset["bufferViews"]]

    def refused(view, place, value, code, why):
        at = packed[view].get("byteOffset", 0) + place % packed[view]["byteLength"]
        changed = bytearray(data)
        changed[at] = value
        run.write("m.glb", glb(asset, bytes(changed)))
        run.ffd("check", "m.glb", "-l", "twist.json", code=code, err=re.compile("^m.glb:/bufferViews/%d/extensions/KHR_meshopt_compression: %s$" % (view, why)))

    refused(0, 0, 0xa2, UNSUPPORTED, "version 2 of the meshopt codec for ATTRIBUTES is not known, only up to 1")
    refused(0, -1, 0x03, INVALID, "channel 2 of the compressed data has the unknown mode 0x03")
    refused(0, -2, 0x41, INVALID, "channel 1 of the compressed data has the unknown mode 0x41")
    refused(0, 1, 0xff, INVALID, "the compressed data of mode ATTRIBUTES (ends too early|has \\d+ bytes? too many)")
    refused(5, 1, 0x10, INVALID, "triangle 0 of the compressed data is broken")
    refused(5, -1, 0x01, INVALID, "the table of the compressed data of mode TRIANGLES is broken")
    refused(6, -5, 0x80, INVALID, "index 15 of the compressed data is broken")


@case
def a_small_file_of_many_zeros(run):
    """Version 1 holds a thousand bytes in one: what does not fit into the memory is refused before it is made."""
    count = 6000000
    data = b"\xa1" + -(-count // 256) * b"\xaa\xaa\xaa" + bytes(24)
    packed = {"buffer": 0, "byteLength": len(data), "byteStride": 12, "mode": "ATTRIBUTES", "count": count}
    asset = {"asset": {"version": "2.0"}, "extensionsUsed": ["KHR_meshopt_compression"], "extensionsRequired": ["KHR_meshopt_compression"],
             "buffers": [{"byteLength": len(data)}, {"byteLength": 12 * count}], "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
             "bufferViews": [{"buffer": 1, "byteLength": 12 * count, "byteStride": 12, "extensions": {"KHR_meshopt_compression": packed}}],
             "accessors": [{"bufferView": 0, "componentType": 5126, "count": count, "type": "VEC3", "min": [0, 0, 0], "max": [0, 0, 0]}],
             "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "mode": 0}]}]}
    run.write("m.glb", glb(asset, data))
    run.write("l.json", lattice(low=(-1, -1, -1), high=(1, 1, 1), moves=[{"by": [0, 0, 1]}]))
    run.ffd("check", "m.glb", "-l", "l.json", "--memory", "50M", code=LIMIT, err=re.compile("memory"))
    counts(entry(run, "check", "m.glb", "-l", "l.json", "--memory", "1G"), vertices=count, inside=count)


# Forms of files

@case
def wild3_15_compressed_splats_are_not_supported(run):
    """Compressed splats are valid, and not read: exit 6, and what to do."""
    run.write("l.json", LIFT)
    chunk = "".join(f"property float {edge}_{axis}\n" for edge in ("min", "max") for axis in "xyz")
    packed = "".join(f"property uint packed_{name}\n" for name in ("position", "rotation", "scale", "color"))
    header = f"ply\nformat binary_little_endian 1.0\nelement chunk 1\n{chunk}element vertex 4\n{packed}end_header\n"
    run.write("c.compressed.ply", header.encode() + bytes(24 + 64))
    why = "c.compressed.ply:10: compressed Gaussian splats (packed_position): save them uncompressed"
    for words in (["deform", "c.compressed.ply", "o.ply", "-l", "l.json"], ["check", "c.compressed.ply", "-l", "l.json"], ["info", "c.compressed.ply"]):
        run.ffd(*words, code=UNSUPPORTED, err=why)


@case
def other_forms_of_splats_are_named(run):
    """The endings that programs for splats use: as an input of every command and of a batch, and as an output."""
    run.write("l.json", LIFT)
    run.write("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    for folder in ("in", "out"):
        run.folder_of(folder)
    run.write("in/m.obj", run.text("m.obj"))
    for ending in (".splat", ".ksplat", ".spz", ".SOG"):
        said = f'"{ending}" is a form of Gaussian splats that is not supported: they are read and written as uncompressed ply'
        run.write("c" + ending, bytes(64))
        for words in (["deform", "c" + ending, "o.ply", "-l", "l.json"], ["check", "c" + ending, "-l", "l.json"], ["info", "c" + ending],
                      ["compare", "m.obj", "c" + ending], ["embed", "c" + ending, "-l", "l.json", "-o", "e.npy"], ["view", "c" + ending, "-l", "l.json", "-o", "v.html"]):
            run.ffd(*words, code=USAGE, err=f"c{ending}: {said}")
        run.ffd("deform", "m.obj", "o" + ending, "-l", "l.json", code=USAGE, err=f"o{ending}: {said}")
        run.write("in/c" + ending, bytes(64))
        done = run.ffd("batch", "--in", "in/*", "-l", "l.json", "--out-dir", "out", "--force", code=NO, err=anything)
        one_line(done, re.escape(said))
        check(run.exists("out/m.obj"), "the others are done")
        run.remove("in/c" + ending)
    run.ffd("info", "m.fbx", code=USAGE, err='m.fbx: the ending ".fbx" is not that of a mesh format (obj, gltf, glb, vrm, ply, off, stl, vtk, su2, vtu, vtp, vts, msh or foam, whose file is called points)')


@case
def ends_of_stl_in_two_words(run):
    """"end loop" and "end facet" are read, with a warning, as "end solid" is."""
    run.write("l.json", LIFT)
    text = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nend loop\nEND FACET\nend solid a\n"
    run.write("m.stl", text)
    done = run.ffd("deform", "m.stl", "o.stl", "-l", "l.json", err=anything)
    one_line(done, '"endloop" or "endfacet" is written as two words')
    equal(run.text("o.stl"), text.replace(" 0\nvertex", " 1\nvertex").replace("0 1 0\nend", "0 1 1\nend"))
    run.ffd("info", "m.stl", "--strict", code=INVALID, err=re.compile("two words"))
    run.write("m.stl", text.replace("end loop", "end"))
    run.ffd("info", "m.stl", code=INVALID, err=re.compile("endloop"))


@case
def a_name_that_ends_in_a_backslash(run):
    """The next line belongs to it, as the format has it: a warning leads to the line, of whatever keyword, and strict refuses it."""
    run.write("l.json", LIFT)
    said = "the backslash at the end of the line joins the next one to it, which seems to be a statement of its own"
    corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n"
    for statement in ("usemtl wood\\", "g a\\", "o C:\\", "mtllib C:\\a\\", "usemap a\\", "usemtl wood \\"):
        for below in ("f 1 2 3", "  f 1 2 3", "l 1 2", "usemtl b", "vt 0 0"):
            run.write("m.obj", f"{corners}{statement}\n{below}\nf 2 4 3\n")
            run.ffd("info", "m.obj", err=[f"m.obj: line 5: {said}"])
            run.ffd("check", "m.obj", "-l", "l.json", "--strict", code=INVALID, err=f"m.obj:5: {said}")
    one_line(run.ffd("deform", "m.obj", "o.obj", "-l", "l.json", err=anything), "line 5: " + said)
    run.write("m.obj", f"{corners}usemtl wood\\\nv 2 2 0\nf 1 2 5\n")
    run.ffd("info", "m.obj", code=INVALID, err="m.obj:7: vertex index 5 is out of range: the file has 4 (the backslash at the end of "
                                               "line 5 joins the next one to it)")
    for text in ("g a \\\nb c\nf 1 2 3\n", "f 1 2 \\\n3\n", "g a \\\nfelt f\nf 1 2 3\n", "# C:\\\nf 1 2 3\n", "usemtl a\\ \nf 1 2 3\n"):
        run.write("m.obj", corners + text)
        equal(run.ffd("info", "m.obj", "--json").json["contents"]["faces"], 1)
    lines = "".join("g a\\\nf 1 2 3\nf 2 4 3\n" for _ in range(40000))
    run.write("m.obj", corners + lines)
    run.ffd("info", "m.obj", err=[f"m.obj: line 5: {said} (the first of 40000 such)"])


@case
def an_stl_whose_count_was_not_filled_in(run):
    """A binary STL of 0 facets with facets behind is refused; one that is empty is not. A count that is too small is a warning."""
    facet = struct.pack("<12fH", 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0)
    run.write("m.stl", b"x".ljust(80) + struct.pack("<I", 0) + 3 * facet)
    run.ffd("info", "m.stl", code=INVALID, err="m.stl: 0 facets are stated, but 150 bytes follow, which hold 3: the count was not filled in")
    for count, more in ((1, "1 facet is stated, but 100 bytes follow, as many as 2 more take"),
                        (2, "2 facets are stated, but 50 bytes follow, as many as 1 more takes")):
        run.write("m.stl", b"x".ljust(80) + struct.pack("<I", count) + 3 * facet)
        run.ffd("info", "m.stl", err=f"m.stl: {more}: they stay as they are")
        run.ffd("info", "m.stl", "--strict", code=INVALID, err=f"m.stl: {more}: they stay as they are")
    run.write("m.stl", b"x".ljust(80) + struct.pack("<I", 3) + 3 * facet + b"by a writer")
    run.ffd("info", "m.stl")
    run.write("e.stl", b"x".ljust(80) + struct.pack("<I", 0))
    equal(run.ffd("info", "e.stl", "--json").json["vertices"], 0)


@case
def artist_24_a_lattice_of_blender_deforms_as_there(run):
    """Its control points alone make another shape; converted it is Blender's, by what the pages say. With all types of Blender, and
    through its scripts: tests/blender."""
    use(run, "artist-24-lattice-of-blender")
    of = json.loads(run.text("blender.json"))
    low, high = of["rest"][0], of["rest"][-1]
    middle, sides = [(a + b) / 2 for a, b in zip(low, high)], [b - a for a, b in zip(low, high)]
    own = [[(x - m) / s for x, m, s in zip(p, middle, sides)] for p in of["deformed"]]
    run.write("cage.json", {"lattice_points": of["size"], "lattice_object_location": middle, "lattice_object_rotation": [0, 0, 0], "lattice_object_scale": sides,
                            "deformed_control_points": own})
    run.write("plain.json", {"format": "ffd-lattice", "version": 1, "size": of["size"], "rest": {"points": of["rest"]}, "deformed": {"points": of["deformed"]}})
    run.write("monkey.obj", "".join("v {!r} {!r} {!r}\n".format(*p) for p in of["before"]) + "p 1\n")
    run.ffd("lattice", "convert", "cage.json", "-o", "L.json", lines=1, err=re.compile("--outside extend"))
    found = {}
    for name, more in (("L", ["--outside", "extend"]), ("plain", ["--snap", "1e-6"])):
        run.ffd("deform", "monkey.obj", f"{name}.obj", "-l", f"{name}.json", *more, err=anything)
        found[name] = max(abs(a - b) for p, q in zip(obj_vertices(run.text(f"{name}.obj")), of["after"]) for a, b in zip(p, q))
    check(found["L"] <= 1e-6, found)
    check(found["plain"] > 0.02, "its control points alone are no fault any more: compare something else", found)


main()
