"""Run in Blender: makes a scene of tori with Lattice modifiers, saves it, and exports it as it looks.

    make_pair.py -- FOLDER
"""

import os
import sys

import bpy

folder = sys.argv[sys.argv.index("--") + 1]
bpy.ops.wm.read_factory_settings(use_empty=True)
data = bpy.data.lattices.new("cage")
data.points_u, data.points_v, data.points_w = 3, 4, 2
data.interpolation_type_v = "KEY_LINEAR"
cage = bpy.data.objects.new("cage", data)
cage.scale, cage.rotation_euler = (3, 2, 2), (0.2, 0.3, 0.4)
bpy.context.scene.collection.objects.link(cage)
for number, point in enumerate(data.points):
    point.co_deform.x += 0.1 * (number % 5 - 2)
    point.co_deform.z += 0.07 * (number % 3 - 1)
for name in ("plain", "masked"):
    bpy.ops.mesh.primitive_torus_add(major_segments=24, minor_segments=12, location=(0.1, 0.2, 0.3), rotation=(0.3, 0, 0))
    torus = bpy.context.object
    torus.name = torus.data.name = name
    bpy.ops.object.shade_smooth()
    modifier = torus.modifiers.new("Lattice", "LATTICE")
    modifier.object = cage
    if name == "masked":
        group = torus.vertex_groups.new(name="mask")
        for vertex in torus.data.vertices:
            group.add([vertex.index], min(1, max(0, 0.5 + vertex.co.x / 2)), "REPLACE")
        modifier.vertex_group, modifier.invert_vertex_group = "mask", True
# A third one, with the mesh of the first, is not deformed, and hangs below the second.
still = bpy.data.objects.new("it's still", bpy.data.objects["plain"].data)
bpy.context.scene.collection.objects.link(still)
still.parent = bpy.data.objects["masked"]
bpy.ops.wm.save_as_mainfile(filepath=os.path.join(folder, "scene.blend"))
bpy.ops.export_scene.gltf(filepath=os.path.join(folder, "blender.glb"), export_apply=True)
