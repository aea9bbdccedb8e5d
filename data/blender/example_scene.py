# SPDX-License-Identifier: MIT
"""Makes a scene to try the scripts on: the vase of models/, with a Lattice modifier that bends its neck.

    blender -b --factory-startup -P blender/example_scene.py -- vase.blend
"""

import os
import sys

import bpy

HERE = os.path.dirname(os.path.abspath(__file__))
target = os.path.abspath(sys.argv[sys.argv.index("--") + 1])
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.wm.obj_import(filepath=os.path.join(HERE, "..", "models", "vase.obj"))
vase = bpy.context.selected_objects[0]
vase.name = "vase"
data = bpy.data.lattices.new("cage")
data.points_u, data.points_v, data.points_w = 2, 2, 5
data.interpolation_type_u = data.interpolation_type_v = "KEY_LINEAR"
cage = bpy.data.objects.new("cage", data)
bpy.context.collection.objects.link(cage)
bpy.context.view_layer.update()
corners = [vase.matrix_world @ type(vase.location)(corner) for corner in vase.bound_box]
low, high = ([bound(corner[d] for corner in corners) for d in range(3)] for bound in (min, max))
cage.location = [(a + b) / 2 for a, b in zip(low, high)]
# The points of a lattice of n are 1 apart.
cage.scale = [1.1 * (b - a) / (n - 1) for a, b, n in zip(low, high, (2, 2, 5))]
for number, point in enumerate(data.points):
    layer = number // 4
    point.co_deform.x += (0, 0, 0.05, 0.35, 0.3)[layer]
    point.co_deform.y *= (1, 1.1, 1, 0.8, 1.3)[layer]
vase.modifiers.new("Lattice", "LATTICE").object = cage
bpy.ops.wm.save_as_mainfile(filepath=target)
