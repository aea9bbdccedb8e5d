"""Run in Blender: makes a scene of what the export skips, warns about or has to name, and saves odd.blend.

    make_odd.py -- FOLDER
"""

import os
import sys

import bpy

folder = sys.argv[sys.argv.index("--") + 1]


def add(name, cage, modifier="Lattice", group=None):
    data = bpy.data.meshes.new(name)
    data.from_pydata([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], [], [])
    thing = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(thing)
    if group:
        thing.vertex_groups.new(name=group).add([0, 1, 2], 0.5, "REPLACE")
    made = thing.modifiers.new(modifier, "LATTICE")
    made.object = cage
    made.vertex_group = group or ""
    return thing


def add_cage(name):
    cage = bpy.data.objects.new(name, bpy.data.lattices.new(name))
    bpy.context.scene.collection.objects.link(cage)
    return cage


# A library with a mesh that is linked.
bpy.ops.wm.read_factory_settings(use_empty=True)
add("linked", None, group="mask")
bpy.data.objects["linked"].modifiers.clear()
bpy.ops.wm.save_as_mainfile(filepath=os.path.join(folder, "library.blend"))

bpy.ops.wm.read_factory_settings(use_empty=True)
cage = add_cage("cage")
add("off", cage).modifiers[0].show_viewport = False
add("without", None)
add("hidden", cage).hide_viewport = True
flat = add_cage("flat cage")
flat.scale.z = 0
add("flat", flat)
add("a/b", cage)
add("a:b", cage)
add(".dot", cage)
with_group = add_cage("grouped cage")
with_group.data.vertex_group = with_group.vertex_groups.new(name="g").name
add("grouped", with_group)
behind = add("behind", cage)
behind.modifiers.new("Subdivision", "SUBSURF")
with bpy.context.temp_override(object=behind):
    bpy.ops.object.modifier_move_up(modifier="Subdivision")
empty = add("empty", cage)
empty.data.clear_geometry()
several = add("several", cage, group="one")
several.vertex_groups.new(name="two").add([3, 4], 0.25, "REPLACE")
second = several.modifiers.new("Lattice", "LATTICE")
second.object, second.vertex_group = cage, "two"
third = several.modifiers.new('"x"', "LATTICE")
third.object, third.vertex_group = cage, "one"
with bpy.data.libraries.load(os.path.join(folder, "library.blend"), link=True) as (source, target):
    target.meshes = ["linked"]
linked = bpy.data.objects.new("linked", target.meshes[0])
bpy.context.scene.collection.objects.link(linked)
modifier = linked.modifiers.new("Lattice", "LATTICE")
modifier.object, modifier.vertex_group = cage, "mask"
scene = bpy.data.scenes.new("other")
elsewhere = add("elsewhere", cage)
bpy.context.scene.collection.objects.unlink(elsewhere)
scene.collection.objects.link(elsewhere)
edited = add_cage("edited cage")
add("edited", edited)
bpy.context.view_layer.objects.active = edited
bpy.ops.object.mode_set(mode="EDIT")
bpy.ops.wm.save_as_mainfile(filepath=os.path.join(folder, "odd.blend"))
