#!/usr/bin/env python3
"""glTF files that are not valid, but have a plain meaning, are deformed as viewers show them, and what is not moved keeps its
bytes; required extensions; .vrm. What is said, reported and refused with --strict: test_broken_gltf.py."""

import base64
import json
import struct

from broken_gltf_cases import CORNERS, Model, spread
from gltf_build import SHIFT
from gltf_reader import Gltf
from harness import CUBE, INVALID, IO, UNSUPPORTED, USAGE, case, check, equal, glb_split, lattice, main
from messages import anything, entry, one_line

SHIFTED = [(x + 1, y, z) for x, y, z in CORNERS]


def start(run):
    run.write("l.json", SHIFT)


def deform(run, name="m.glb", output="o.glb", *words, **options):
    options.setdefault("err", anything)
    return run.ffd("deform", name, output, "-l", "l.json", "--force", *words, **options)


def positions(run, name, primitive=0):
    gltf = Gltf(run.path(name))
    return [tuple(p) for p in gltf.decoded(gltf.asset["meshes"][0]["primitives"][primitive]["attributes"]["POSITION"])]


@case
def positions_at_any_byte(run):
    """Views with strides of all sizes, and beginnings at all bytes."""
    start(run)
    for stride in (*range(12, 24), 251):
        for first in (0, 1, 2, 3):
            run.write("m.glb", spread(stride, first)())
            deform(run)
            equal(positions(run, "o.glb"), SHIFTED, f"stride {stride}, first byte {first}")
            before, after = (len(glb_split(run.read(name))[1]) for name in ("m.glb", "o.glb"))
            equal(after, before, "all in place")
    run.write("m.glb", Model().set("bufferViews/0/byteStride", 0).glb())
    deform(run)
    equal(list(struct.iter_unpack("<3f", glb_split(run.read("o.glb"))[1][:96])), SHIFTED, "stride 0")


def first_of(asset, key):
    return asset if key == "" else asset[key] if key == "asset" else asset[key][0]


@case
def numbers_beyond_double_where_nothing_reads_them(run):
    start(run)
    for key in ("", "asset", "scenes", "nodes", "meshes", "accessors", "bufferViews", "buffers"):
        for member in ("extras", "extensions", "OTHER_member"):
            model = Model()
            first_of(model.asset, key)[member] = {"OTHER_range": [1e99, {"x": 1e99}]}
            run.write("m.glb", model.glb().replace(b"1e+99", b"1e999"))
            deform(run, err=[])
            equal(positions(run, "o.glb"), SHIFTED, f"{key} {member}")
            equal(run.read("o.glb").count(b"1e999"), 2, f"{key} {member}: the text stays")
    for key, value in (("meshes/0/weights", [1e99]), ("nodes/0/weights", [1e99]),
                       ("meshes/0/primitives/0/mode", 1e99)):
        model = Model().morph().set(key, value)
        uri = "data:application/octet-stream;base64," + base64.b64encode(model.data).decode()
        run.write("m.gltf", model.text(uri).replace(b"1e+99", b"1e999"))
        pointer, expected = (key, "a mode from 0 to 6") if key.endswith("mode") else (key + "/0", "a finite number")
        run.ffd("deform", "m.gltf", "o.gltf", "-l", "l.json", code=INVALID,
                err=f"m.gltf:1: /{pointer}: {expected} is expected, not 1e999")


@case
def sparse_values_at_any_byte(run):
    start(run)
    model = Model().sparse()
    values = model.asset["accessors"][0]["sparse"]["values"]
    view = model.view(b"\0" * 3 + struct.pack("<6f", 1, 2, 3, 4, 5, 6))
    values |= {"bufferView": view, "byteOffset": 3}
    run.write("m.glb", model.glb())
    deform(run)
    expected = [(2, 2, 3) if i == 1 else (5, 5, 6) if i == 6 else p for i, p in enumerate(SHIFTED)]
    equal(positions(run, "o.glb"), expected)


@case
def a_primitive_whose_faces_are_not_known(run):
    """Positions and normals are deformed; what it would draw stays as it was, to the byte."""
    start(run)
    for change in (lambda m: m.set("meshes/0/primitives/0/mode", 7), lambda m: m.put(2, 4, "<H", 65535),
                   lambda m: m.set("meshes/0/primitives/0/indices", 9), lambda m: m.set("meshes/0/primitives/0/indices", 0)):
        model = Model()
        change(model)
        run.write("m.glb", model.glb())
        job = entry(run, "deform", "m.glb", "o.glb", "-l", "l.json")
        equal((job["vertices"], job["moved"], job["flipped_faces"], len(job["flaws"])), (8, 8, 0, 1))
        equal(positions(run, "o.glb"), SHIFTED)
        before, after = (glb_split(run.read(name)) for name in ("m.glb", "o.glb"))
        equal(after[0]["meshes"], before[0]["meshes"])
        equal(after[1][96:], before[1][96:], "normals and indices")
        for words in (("--normals", "recompute"), ("--as-morph", "a"), ("--outside", "extend")):
            deform(run, "m.glb", "p.glb", *words)
        run.ffd("check", "m.glb", "-l", "l.json", err=anything)
        run.ffd("lattice", "new", "m.glb", "-o", "n.json", "--force", err=anything)
        # A conversion would lose the faces.
        one_line(deform(run, "m.glb", "o.obj", code=INVALID), "m.glb:/meshes/0/primitives/0", "cannot be converted")


@case
def a_root_that_is_a_child_stands_where_its_parent_places_it(run):
    start(run)
    for roots in ([0, 1], [1, 0], [1], [1, 1, 0]):
        model = Model().set("nodes", [{"translation": [2, 0, 0], "children": [1]}, {"mesh": 0, "translation": [0, 3, 0]}])
        run.write("m.glb", model.set("scenes/0/nodes", roots).glb())
        info = run.ffd("info", "m.glb", "--json", err=anything).json
        equal(info["bounds"], {"min": [1, 2, -1], "max": [3, 4, 1]}, roots)
        job = entry(run, "deform", "m.glb", "o.glb", "-l", "l.json")
        equal((job["vertices"], job["moved"]), (8, 8))
        equal(positions(run, "o.glb"), SHIFTED)


@case
def base64_as_browsers_read_it(run):
    """The head keeps its text where the data changes; it is never taken for data that is not in base64."""
    start(run)
    model = Model()
    text = base64.b64encode(model.data).decode()
    broken = "\n".join(text[i:i + 76] for i in range(0, len(text), 76))
    for head, data in ((";BASE64,", text), (";Base64,", text), ("; base64,", text), (";base64 ,", text), (";base64,", broken),
                       (";base64,", " " + text + "\r\n\t"), (";base64;,", text), (";base64;charset=utf-8,", text), (" base64,", text),
                       (";base64%20,", text)):
        run.write("m.gltf", model.text("data:application/octet-stream" + head + data))
        done = deform(run, "m.gltf", "o.gltf")
        equal(len(done.err), 1, done.err)
        equal(positions(run, "o.gltf"), SHIFTED, head)
        uri = Gltf(run.path("o.gltf")).asset["buffers"][0]["uri"]
        check(uri.startswith("data:application/octet-stream" + head), uri[:60])
        deform(run, "m.gltf", "n.gltf", "--strict", code=INVALID)
    run.write("m.gltf", model.text("data:application/octet-stream;base64\n," + text))
    equal(len(deform(run, "m.gltf", "o.gltf").err), 1)
    equal(positions(run, "o.gltf"), SHIFTED, "a line break before the comma")
    # Other words are no marker, and a buffer's data is nothing else than base64.
    for head in ("text/plain;xbase64,", "text/plain;base64x,", "text/plainbase64,", ";base65,", ";base-64,", "base64,", ",",
                 "application/octet-stream;charset=utf-8,"):
        run.write("m.gltf", model.text("data:" + head + text))
        one_line(deform(run, "m.gltf", "n.gltf", code=INVALID), 'm.gltf:1: /buffers/0/uri: ', 'must say ";base64"')
        check(not run.exists("n.gltf"), head)


@case
def a_buffer_named_with_backslashes(run):
    start(run)
    model = Model()
    run.write("sub/deep/m.bin", bytes(model.data))
    run.write("../outside.bin", bytes(model.data))
    for uri in ("sub\\deep\\m.bin", "sub/deep\\m.bin", "sub%5Cdeep%5cm.bin", ".\\sub\\deep\\m.bin"):
        run.write("m.gltf", model.text(uri))
        one_line(deform(run, "m.gltf", "o.gltf"), "backslash", "sub/deep/m.bin")
        equal(positions(run, "o.gltf"), SHIFTED, uri)
        deform(run, "m.gltf", "n.gltf", "--strict", code=INVALID)
    # A file of that very name is the one that is meant.
    other = bytearray(model.data)
    struct.pack_into("<3f", other, 0, 1, 1, 1)
    run.write("sub\\deep\\m.bin", bytes(other))
    run.write("m.gltf", model.text("sub\\deep\\m.bin"))
    equal(deform(run, "m.gltf", "o.gltf").err, [])
    equal(positions(run, "o.gltf")[0], (2, 1, 1))
    # Nothing outside of the folder is read.
    for uri in ("..\\outside.bin", "sub\\..\\..\\outside.bin", "\\outside.bin", "%5Coutside.bin", "%5C..%5Coutside.bin", "c:\\m.bin"):
        run.write("m.gltf", model.text(uri))
        deform(run, "m.gltf", "n.gltf", code=IO)


@case
def an_image_named_with_backslashes_is_copied(run):
    start(run)
    model = Model()
    model.asset["images"] = [{"uri": "tex\\a.png"}]
    run.write("tex/a.png", b"\x89PNG\r\n\x1a\n" + b"\0" * 20)
    run.write("m.gltf", model.gltf())
    run.folder_of("out")
    equal(deform(run, "m.gltf", "out/m.gltf").err, [])
    equal(run.read("out/tex/a.png"), run.read("tex/a.png"))


@case
def a_buffer_with_less_than_its_byte_length(run):
    """What no view needs may be missing."""
    start(run)
    model = Model().set("buffers/0/byteLength", 5000)
    run.write("m.glb", model.glb())
    one_line(deform(run), "/buffers/0", "less than its byteLength 5000")
    # The reader of the tests wants as many bytes as are stated.
    equal(glb_split(run.read("o.glb"))[1][:12], struct.pack("<3f", *SHIFTED[0]))
    run.write("m.gltf", model.set("buffers/0/byteLength", len(model.data) + 1).text("m.bin"))
    run.write("m.bin", bytes(model.data)[:90])
    deform(run, "m.gltf", "n.gltf", code=INVALID, err="m.gltf:1: /buffers/0: the buffer has 90 bytes, less than its byteLength 229")


@case
def many_kinds_of_flaws(run):
    """Each kind is said once, with the number of such; what does not fit shares the last place."""
    start(run)
    model = Model()
    model.asset["nodes"] = [{"children": [1, 1]}, {"mesh": 0}, {"matrix": [float(i % 5 == 0) for i in range(15)] + [1.000001]}]
    model.set("scenes/0/nodes", [0, 0, 1]).set("bufferViews/1/byteStride", 0)
    primitive = model.primitive
    model.asset["meshes"][0]["primitives"] = [
        primitive, *({**primitive, "mode": mode} for mode in (7, 8, 9)), {**primitive, "indices": 99}, {**primitive, "indices": 0}]
    position = model.asset["accessors"][0]
    model.view(b"\0" * 98)
    model.asset["accessors"].append({**position, "bufferView": len(model.asset["bufferViews"]) - 1, "byteOffset": 2})
    job = entry(run, "deform", run.write("m.glb", model.glb()), "o.glb", "-l", "l.json")
    flaws = job["flaws"]
    equal(len(flaws), 8, flaws)
    modes = [flaw for flaw in flaws if "a mode is" in flaw["message"]]
    equal([(flaw["count"], flaw["pointer"]) for flaw in modes], [(3, "/meshes/0/primitives/1/mode")])
    check(flaws[-1]["message"].startswith("there is more of other kinds: ") and flaws[-1]["count"] > 1, flaws[-1])
    one_line(deform(run), "a mode is", r"\(the first of 3 such\)")


REQUIRES = '/extensionsRequired/0: the required extension "{}" {} (--allow-extension {} deforms {})'


# Those of the registry in July 2026, archived ones too, but for AGI_articulations, MPEG_accessor_timed and
# MPEG_buffer_circular, which say where vertices are.
REGISTRY = """
ADOBE_materials_clearcoat_specular ADOBE_materials_clearcoat_tint ADOBE_materials_thin_transparency AGI_stk_metadata
CESIUM_primitive_outline EXT_lights_ies EXT_lights_image_based EXT_mesh_gpu_instancing EXT_mesh_manifold
EXT_mesh_primitive_edge_visibility EXT_mesh_primitive_restart EXT_meshopt_compression EXT_texture_astc
EXT_texture_webp FB_geometry_metadata GODOT_single_root GRIFFEL_bim_data KHR_animation_pointer
KHR_draco_mesh_compression KHR_gaussian_splatting KHR_interactivity KHR_lights_punctual KHR_materials_anisotropy
KHR_materials_clearcoat KHR_materials_diffuse_transmission KHR_materials_dispersion KHR_materials_emissive_strength
KHR_materials_ior KHR_materials_iridescence KHR_materials_pbrSpecularGlossiness KHR_materials_sheen
KHR_materials_specular KHR_materials_transmission KHR_materials_unlit KHR_materials_variants KHR_materials_volume
KHR_mesh_quantization KHR_meshopt_compression KHR_node_hoverability KHR_node_selectability KHR_node_visibility
KHR_techniques_webgl KHR_texture_basisu KHR_texture_transform KHR_xmp KHR_xmp_json_ld MPEG_animation_timing
MPEG_audio_spatial MPEG_media MPEG_mesh_linking MPEG_scene_dynamic MPEG_texture_video MPEG_viewport_recommended
MSFT_lod MSFT_packing_normalRoughnessMetallic MSFT_packing_occlusionRoughnessMetallic MSFT_texture_dds
NV_materials_mdl
""".split()


def requiring(*names):
    return Model().set("extensionsUsed", list(names)).set("extensionsRequired", list(names)).glb()


@case
def a_required_extension_that_touches_no_vertices_is_let_pass(run):
    """What does not touch vertices is let pass, and everything else is the user's to decide."""
    start(run)
    for name in ("KHR_node_visibility", "KHR_materials_unlit", "KHR_texture_basisu", "KHR_xmp_json_ld", "KHR_interactivity",
                 "KHR_lights_punctual", "KHR_node_selectability", "KHR_techniques_webgl", "EXT_texture_webp", "EXT_mesh_manifold",
                 "EXT_textureInfo_constant_lod", "MSFT_packing_occlusionRoughnessMetallic", "MSFT_texture_dds", "AGI_stk_metadata",
                 "ADOBE_materials_thin_transparency", "CESIUM_primitive_outline", "FB_geometry_metadata", "GODOT_single_root",
                 "GRIFFEL_bim_data", "MAXAR_mesh_variants", "MPEG_media", "NV_materials_mdl", "NGA_gpm_local", "VRMC_vrm",
                 "BENTLEY_materials_line_style"):
        run.write("m.glb", requiring(name))
        deform(run, err=[])
        deform(run, "m.glb", "o.glb", "--strict", err=[])
    run.write("m.glb", requiring(*REGISTRY))
    deform(run, err=[])
    for name, why in (("ACME_x", "is not known"), ("AGI_articulations", "places vertices in a way that is not supported"),
                      ("MPEG_accessor_timed", "holds geometry in a form that is not supported"), ("KHR_materials", "is not known"), ("khr_materials_unlit", "is not known"),
                      ("CESIUM_RTC", "places vertices in a way that is not supported"),
                      ("MPEG_buffer_circular", "holds geometry in a form that is not supported"),
                      ("KHR_gaussian_splatting_compression_spz_2", "holds geometry in a form that is not supported")):
        run.write("m.glb", requiring(name))
        held = "holds geometry" in why
        told = "m.glb:" + REQUIRES.format(name, why, name, "what else the file holds" if held else "the file all the same")
        for words in (("deform", "m.glb", "n.glb", "-l", "l.json"), ("check", "m.glb", "-l", "l.json"),
                      ("embed", "m.glb", "-l", "l.json", "-o", "n.npy"), ("lattice", "new", "m.glb", "-o", "n.json")):
            run.ffd(*words, code=UNSUPPORTED, err=told)
        run.ffd("info", "m.glb")
        allowed = f'm.glb: the extension "{name}" holds geometry in a form of its own, which is not deformed: viewers that read it show the old one'
        deform(run, "m.glb", "o.glb", "--allow-extension", name, err=[allowed] if held else [])
        equal(positions(run, "o.glb"), SHIFTED)
        run.ffd("check", "m.glb", "-l", "l.json", "--allow-extension", name, err=anything)
        run.ffd("embed", "m.glb", "-l", "l.json", "-o", "e.npy", "--force", "--allow-extension", name, err=anything)
        run.ffd("lattice", "new", "m.glb", "-o", "e.json", "--force", "--allow-extension", name, err=anything)
    run.write("m.glb", requiring("ACME_x", "ACME_y"))
    deform(run, "m.glb", "n.glb", "--allow-extension", "ACME_x", code=UNSUPPORTED)
    deform(run, "m.glb", "o.glb", "--allow-extension", "ACME_x", "--allow-extension", "ACME_y", err=[])
    deform(run, "m.glb", "n.glb", "--allow-extension", "", code=USAGE)


@case
def rules_are_those_of_each_job(run):
    """Jobs of a batch that share a mesh, and the box of a lattice, each refuse what they are to refuse."""
    start(run)
    run.write("x.glb", requiring("ACME_x"))
    run.write("twice.glb", Model().set("scenes/0/nodes", [0, 0]).glb())
    run.write("box.json", lattice(rest={"box": {"meshes": ["twice.glb"]}, "margin": 0.1}, moves=[{"by": [1, 0, 0]}]))
    run.write("a.glb", Model().glb())
    jobs = [("x.glb", "l.json", {"allow-extension": "ACME_x"}, True),
            ("x.glb", "l.json", {"allow-extension": "ACME_y"}, False),
            ("x.glb", "l.json", {"allow-extension": ["ACME_y", "ACME_x"]}, True), ("x.glb", "l.json", {}, False), ("twice.glb", "l.json", {}, True),
            ("twice.glb", "l.json", {"strict": True}, False), ("twice.glb", "l.json", {}, True),
            ("a.glb", "box.json", {}, True), ("a.glb", "box.json", {"strict": True}, False), ("a.glb", "box.json", {}, True)]
    run.write("m.jsonl", "".join(json.dumps({"in": mesh, "lattice": path, "out": f"o{i}.glb", "options": options}) + "\n"
                                 for i, (mesh, path, options, _) in enumerate(jobs)))
    run.ffd("batch", "m.jsonl", "-j", "1", "--report", "r.json", code=1, err=anything)
    found = json.loads(run.text("r.json"))["jobs"]
    equal([job["status"] == "ok" for job in found], [done for *_, done in jobs])
    equal([len(job.get("flaws", [])) for job in found], [0, 0, 0, 0, 1, 0, 1, 0, 0, 0])
    run.ffd("batch", "--in", "x.glb", "-l", "l.json", "--out-dir", run.folder_of("out"), "--allow-extension", "ACME_x", err=anything)


@case
def a_vrm_is_a_glb(run):
    """Read, written, overwritten, converted, described, in batches, and by standard streams."""
    start(run)
    model = Model().set("extensionsUsed", ["VRMC_vrm"]).set("extensions", {"VRMC_vrm": {"specVersion": "1.0"}}).glb()
    run.write("a.vrm", model)
    run.write("a.glb", model)
    deform(run, "a.glb", "b.glb", err=[])
    deform(run, "a.vrm", "b.vrm", err=[])
    equal(run.read("b.vrm"), run.read("b.glb"))
    deform(run, "a.vrm", "c.glb", err=[])
    equal(run.read("c.glb"), run.read("b.glb"))
    run.ffd("compare", "b.vrm", "b.glb", out="")
    equal(run.ffd("info", "a.vrm", "--json").json["contents"]["container"], "glb")
    run.ffd("lattice", "new", "a.vrm", "-o", "n.json")
    run.ffd("lattice", "new", "a.vrm", "-o", "n.vrm", code=USAGE)
    run.ffd("embed", "a.vrm", "-l", "l.json", "-o", "e.npy")
    run.ffd("batch", "--in", "a.vrm", "-l", "l.json", "--out-dir", run.folder_of("out"), err=anything)
    equal(run.read("out/a.vrm"), run.read("b.glb"))
    equal(run.ffd("deform", "-", "-", "-l", "l.json", "--input-format", "vrm", "--output-format", "vrm", stdin=model, data=True).out,
          run.read("b.glb"))
    run.write("cube.obj", CUBE)
    deform(run, "cube.obj", "cube.vrm")
    deform(run, "cube.obj", "cube.glb")
    equal(run.read("cube.vrm"), run.read("cube.glb"))
    run.ffd("deform", "a.vrm", "--in-place", "-l", "l.json")
    equal(run.read("a.vrm"), run.read("b.glb"))
    run.write("text.vrm", Model().gltf())
    deform(run, "text.vrm", "n.vrm", code=INVALID)


main()
