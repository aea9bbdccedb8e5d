"""Run in Blender 4.2 or later: installs the extension, and checks its operators.

    check_extension.py -- ZIP SCRIPTS SEED      SCRIPTS: the folder of ffd_export.py
"""

import importlib.util
import json
import os
import random
import runpy
import sys

import bpy
from mathutils import Euler, Matrix, Vector

PACKAGE, SCRIPTS, SEED = sys.argv[sys.argv.index("--") + 1:]
RANDOM = random.Random(int(SEED))
TYPES = ["KEY_LINEAR", "KEY_CARDINAL", "KEY_CATMULL_ROM", "KEY_BSPLINE"]
OPS = bpy.ops.ffd_lattice
NEAR = 1e-5


def check(condition, *shown):
    if not condition:
        raise AssertionError(" ".join(map(str, shown)))


def vectors(count, most):
    return [Vector(RANDOM.uniform(-most, most) for _ in range(3)) for _ in range(count)]


def link(name, data):
    thing = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(thing)
    return thing


def matrix(negative=False):
    scale = [RANDOM.uniform(0.5, 2) for _ in range(3)]
    if negative:
        scale[1] *= -1
    return Matrix.Translation(vectors(1, 1)[0]) @ Euler(vectors(1, 3)[0]).to_matrix().to_4x4() @ Matrix.Diagonal(scale + [1])


def add_cage(size=None, types=None, name="cage"):
    data = bpy.data.lattices.new(name)
    data.interpolation_type_u, data.interpolation_type_v, data.interpolation_type_w = types or [RANDOM.choice(TYPES) for _ in range(3)]
    data.points_u, data.points_v, data.points_w = size or [RANDOM.randint(1, 5) for _ in range(3)]
    for point, by in zip(data.points, vectors(len(data.points), 0.3)):
        point.co_deform = point.co + by
    cage = link(name, data)
    cage.matrix_world = matrix(RANDOM.random() < 0.3)
    return cage


def add_mesh(cage, keys=3, count=200, name="body"):
    data = bpy.data.meshes.new(name)
    data.from_pydata(vectors(count, 2), [], [])
    body = link(name, data)
    body.matrix_world = matrix()
    modifier = body.modifiers.new("Lattice", "LATTICE")
    modifier.object, modifier.strength = cage, RANDOM.uniform(0.3, 1.5)
    group = body.vertex_groups.new(name="half")
    for index in range(count):
        if RANDOM.random() < 0.7:
            group.add([index], RANDOM.random(), "REPLACE")
    if keys:
        body.shape_key_add(name="Basis")
    for k in range(keys):
        key = body.shape_key_add(name=f"key {k}")
        for point, by in zip(key.data, vectors(count, 0.3)):
            point.co = point.co + by
        key.value = RANDOM.random()
    if keys > 1:
        blocks = data.shape_keys.key_blocks
        blocks[2].relative_key = blocks[1]
        blocks[2].vertex_group = "half"
        blocks[1].slider_min, blocks[1].slider_max = -2, 3
        blocks[3].mute = True
        driver = blocks[1].driver_add("value").driver
        driver.expression = "0.25 + frame * 0"
    bpy.context.view_layer.objects.active = body
    for thing in bpy.context.scene.objects:
        thing.select_set(thing == body)
    bpy.context.view_layer.update()
    return body


def shown(body):
    """What Blender shows: each key alone, its vertex group set aside; without keys the mesh. A mix of two shapes, also one by a group's
    weights, is another shape behind a lattice than before it."""
    found = []
    blocks = body.data.shape_keys.key_blocks if body.data.shape_keys else []
    for index in range(len(blocks)) if blocks else [None]:
        body.show_only_shape_key = index is not None
        body.active_shape_key_index = index or 0
        group = blocks[index].vertex_group if blocks else ""
        if group:
            blocks[index].vertex_group = ""
        bpy.context.view_layer.update()
        graph = bpy.context.evaluated_depsgraph_get()
        found.append([v.co.copy() for v in body.evaluated_get(graph).data.vertices])
        if group:
            blocks[index].vertex_group = group
    body.show_only_shape_key = False
    return found


def facts(body):
    """What is to stay of the keys."""
    keys = body.data.shape_keys
    if not keys:
        return []
    drivers = [(curve.data_path, curve.driver.expression) for curve in keys.animation_data.drivers] if keys.animation_data else []
    return [[key.name, key.value, key.slider_min, key.slider_max, key.mute, key.vertex_group, key.relative_key.name] for key in keys.key_blocks] + drivers


def everything(body):
    """All that a refusal must leave as it was."""
    return (facts(body), [v.co[:] for v in body.data.vertices], [[p.co[:] for p in key.data] for key in (body.data.shape_keys.key_blocks if body.data.shape_keys else [])],
            [(m.name, m.type) for m in body.modifiers], [a.name for a in body.data.attributes])


def fresh():
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    for lists in (bpy.data.meshes, bpy.data.lattices):
        for one in list(lists):
            lists.remove(one)


def refused(operator, what, **properties):
    try:
        done = operator(**properties)
    except RuntimeError as error:
        check(what in str(error) and str(error).startswith("Error: ") and "Traceback" not in str(error), error)
        return
    check(False, f"{what}: not refused, {done}")


def applied_lattices_look_as_before():
    for number in range(16):
        fresh()
        cage = add_cage([1, 1, 1] if number == 0 else None, ["KEY_BSPLINE"] * 3 if number == 1 else None)
        body = add_mesh(cage, keys=0 if number == 2 else 3)
        modifier = body.modifiers[0]
        if number % 3 == 1:
            modifier.vertex_group, modifier.invert_vertex_group = "half", number % 2 == 0
        if number == 4:
            body.data.shape_keys.use_relative = False
            body.data.shape_keys.eval_time = 5
        if number == 5:  # a parent that shears
            mother = link("mother", None)
            mother.scale, mother.rotation_euler = (1, 2, 0.7), (0.3, 0.4, 0.5)
            cage.parent = mother
        if number == 6:
            body.modifiers.new("Subdivision", "SUBSURF").show_viewport = False
        bpy.context.view_layer.update()
        before, kept, names = shown(body), facts(body), [m.name for m in body.modifiers][1:]
        check(OPS.apply() == {"FINISHED"}, number)
        after = shown(body)
        check([m.name for m in body.modifiers] == names, number)
        check(facts(body) == kept, number, kept, facts(body))
        for index, (p, q) in enumerate(zip(before, after)):
            worst = max((a - b).length for a, b in zip(p, q))
            check(worst <= NEAR * max(1, max(a.length for a in p)), f"{number}: shape {index} of {len(before)} is off by {worst}")
        check(len(before) == len(after) == (1 if number == 2 else 4), number)


def an_empty_mesh_loses_its_modifier():
    fresh()
    body = add_mesh(add_cage(), keys=0, count=0)
    check(OPS.apply() == {"FINISHED"} and not body.modifiers, "an empty mesh")


def undone_in_one_step():
    fresh()
    add_mesh(add_cage())
    bpy.ops.ed.undo_push(message="before")
    before = everything(bpy.data.objects["body"])
    check(OPS.apply() == {"FINISHED"} and everything(bpy.data.objects["body"]) != before, "applied")
    bpy.ops.ed.undo_push(message="after")  # as the window's loop does behind an operator with UNDO
    bpy.ops.ed.undo()
    check(everything(bpy.data.objects["body"]) == before, "undone")
    for name in ("export", "import_file", "apply"):
        check({"REGISTER", "UNDO"} <= getattr(bpy.types, f"FFD_LATTICE_OT_{name}").bl_options, name)


def refusals_change_nothing():
    def first_is_another(body):
        body.modifiers.new("Subdivision", "SUBSURF")
        bpy.ops.object.modifier_move_up(modifier="Subdivision")

    def without_lattice(body):
        body.modifiers[0].object = None

    def several_users(body):
        link("other", body.data)

    def no_modifier(body):
        body.modifiers.clear()

    def is_off(body):
        body.modifiers[0].show_viewport = False

    def flat_cage(body):
        body.modifiers[0].object.scale.z = 0

    def flat_body(body):
        body.scale.z = 0

    def not_finite(body):
        body.data.vertices[3].co.x = float("nan")

    def not_importable(_body):
        sys.modules["ffd_mesh"] = None  # Python's word for a module that cannot be imported

    for spoil, what in ((first_is_another, "is not the first one"), (without_lattice, "has no lattice"), (several_users, "has several users"), (no_modifier, "has no Lattice modifier"),
                        (is_off, "is off"), (flat_cage, "the scale 0 along z"), (flat_body, "the scale 0"), (not_finite, "not finite"), (not_importable, "ffd_mesh cannot be imported")):
        fresh()
        body = add_mesh(add_cage())
        spoil(body)
        bpy.context.view_layer.update()
        before = repr(everything(body))
        kept = sys.modules.get("ffd_mesh")
        refused(OPS.apply, what)
        if kept is None:
            sys.modules.pop("ffd_mesh", None)
        check(repr(everything(body)) == before, what)
    fresh()
    cage = add_cage()
    body = add_mesh(cage)
    body.select_set(False)
    bpy.context.view_layer.objects.active = cage
    bpy.ops.object.mode_set(mode="EDIT")
    with bpy.context.temp_override(object=body, active_object=body):
        refused(OPS.apply, "is in edit mode")
    bpy.ops.object.mode_set(mode="OBJECT")
    bpy.context.view_layer.objects.active = body
    bpy.ops.object.mode_set(mode="EDIT")
    refused(OPS.apply, "is not in object mode")
    bpy.ops.object.mode_set(mode="OBJECT")
    body.data.use_fake_user = True
    check(OPS.apply() == {"FINISHED"}, "a fake user is no user")
    bpy.context.view_layer.objects.active = add_cage()
    refused(OPS.apply, "the active object is not a mesh")
    bpy.context.view_layer.objects.active = None
    refused(OPS.apply, "the active object is not a mesh")


def by_script(name, *arguments):
    kept, sys.argv = sys.argv, [name, "--", *arguments]
    try:
        runpy.run_path(os.path.join(SCRIPTS, name), run_name="__main__")
    finally:
        sys.argv = kept


def bytes_of(path):
    with open(path, "rb") as file:
        return file.read()


def exports_are_the_scripts():
    fresh()
    cage = add_cage([3, 4, 2])
    body = add_mesh(cage)
    body.modifiers[0].vertex_group = "half"
    for frame, strength in ((1, 0.2), (4, 0.9)):
        body.modifiers[0].strength = strength
        body.modifiers[0].keyframe_insert("strength", frame=frame)
    os.makedirs("script", exist_ok=True)
    for number, (options, properties) in enumerate((([], {}), (["--up", "y"], {"up": "Y"}), (["--frames", "1:4"], {"use_frames": True, "frame_start": 1, "frame_end": 4}))):
        by_script("ffd_export.py", "--out", "script", "--force", *options)
        check(OPS.export(filepath=os.path.abspath(f"one-{number}"), **properties) == {"FINISHED"}, options)
        check(bytes_of(f"one-{number}.json") == bytes_of("script/body-Lattice.json"), options)
    check("_ffd" in body.data.attributes, "the attribute")
    check(len(json.loads(bytes_of("one-2.json"))["keys"]) == 4, "keys")
    refused(OPS.export, "exists already", filepath=os.path.abspath("one-0.json"))
    check(OPS.export(filepath=os.path.abspath("one-0.json"), replace=True) == {"FINISHED"}, "replace")
    body.modifiers.new("a/b", "LATTICE").object = cage
    other = link("other", body.data.copy())
    other.modifiers.new("Lattice", "LATTICE").object = cage
    other.select_set(True)
    bpy.context.view_layer.update()
    by_script("ffd_export.py", "--out", "script", "--force")
    check(OPS.export(filepath=os.path.abspath("all.json")) == {"FINISHED"}, "several")
    made = sorted(name for name in os.listdir() if name.startswith("all"))
    check(made == ["all-body-Lattice.json", "all-body-a_b.json", "all-other-Lattice.json"], made)
    for name in made:
        check(bytes_of(name) == bytes_of("script/" + name[4:]), name)
    body.select_set(False)
    other.select_set(False)
    refused(OPS.export, "the selection has no Lattice modifier", filepath=os.path.abspath("none.json"))
    refused(OPS.export, "is not behind the first", filepath=os.path.abspath("none.json"), use_frames=True, frame_start=5, frame_end=5)
    check(not os.path.exists("none.json"), "nothing is written")


def imports_are_the_scripts():
    fresh()
    body, other = add_mesh(add_cage(), name="one"), add_mesh(add_cage(), name="two")
    body.select_set(True)
    size = [5, 4, 6]
    content = {"format": "ffd-lattice", "version": 1, "size": size, "degree": [4, 3, 3], "rest": {"box": {"min": [0, 0, 0], "max": [1, 2, 3]}},
               "deformed": {"offsets": [list(v) for v in vectors(120, 0.2)]}}
    with open("L.json", "w", encoding="utf-8") as file:
        json.dump(content, file)
    for options, properties in (([], {}), (["--up", "y", "--size", "6"], {"up": "Y", "size": (6, 6, 6)})):
        by_script("ffd_import.py", "L.json", *options)
        check(OPS.import_file(filepath=os.path.abspath("L.json"), **properties) == {"FINISHED"}, options)
        one, two = (bpy.data.objects[name] for name in ("L", "L.001"))
        check(one.matrix_world == two.matrix_world and [p.co_deform[:] for p in one.data.points] == [p.co_deform[:] for p in two.data.points], options)
        for thing in (body, other):
            check(thing.modifiers[-1].object == two, options)
        for thing in (one, two):
            bpy.data.objects.remove(thing)
    counts = len(bpy.data.objects), len(bpy.data.lattices)
    for change, what in (({"moves": [{"by": [0, 0, 1]}]}, "has moves"), ({"rest": {"box": "mesh"}}, "round a mesh"), ({"size": 4}, "has a size")):
        with open("bad.json", "w", encoding="utf-8") as file:
            json.dump({**content, **change}, file)
        refused(OPS.import_file, what, filepath=os.path.abspath("bad.json"))
    refused(OPS.import_file, "No such file", filepath=os.path.abspath("no.json"))
    refused(OPS.import_file, "from 4 to 64", filepath=os.path.abspath("L.json"), size=(3, 4, 4))
    check((len(bpy.data.objects), len(bpy.data.lattices)) == counts, "nothing is made")


def in_menus():
    """How many of Blender's menus have entries of the extension."""
    return sum(any("ffd_lattice" in draw.__module__ for draw in getattr(bpy.types, name)._dyn_ui_initialize())
               for name in ("TOPBAR_MT_file_export", "TOPBAR_MT_file_import", "VIEW3D_MT_object"))


def it_is_removed_again():
    check(in_menus() == 3, "the menus")
    bpy.ops.extensions.package_uninstall(repo_index=1, pkg_id="ffd_lattice")
    check(not hasattr(bpy.types, "FFD_LATTICE_OT_apply"), "unregistered")
    check(in_menus() == 0, "the menus are as before")


def main():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    check(importlib.util.find_spec("ffd_mesh") is None, "ffd_mesh comes with the extension only")
    bpy.ops.extensions.package_install_files(filepath=PACKAGE, repo="user_default", enable_on_install=True)
    check(importlib.util.find_spec("ffd_mesh") is not None, "the wheel is installed")
    failed = 0
    cases = (applied_lattices_look_as_before, an_empty_mesh_loses_its_modifier, undone_in_one_step, refusals_change_nothing, exports_are_the_scripts,
             imports_are_the_scripts, it_is_removed_again)
    for one in cases:
        try:
            one()
        except Exception as error:  # one failing case must not hide the others
            failed += 1
            line = error.__traceback__
            while line.tb_next:
                line = line.tb_next
            print(f"FAILED: {one.__name__}: {type(error).__name__}: {error} ({line.tb_frame.f_code.co_name}, line {line.tb_lineno})")
    print(f"{len(cases)} cases, {failed} failed")
    sys.exit(1 if failed else 0)


main()
