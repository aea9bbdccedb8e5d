"""Run in Blender: makes a mesh of each list of points in points.json, and saves clouds.blend."""

import json
import os

import bpy

bpy.ops.wm.read_factory_settings(use_empty=True)
with open("points.json", encoding="utf-8") as file:
    lists = json.load(file)
for name, points in lists.items():
    data = bpy.data.meshes.new(name)
    data.from_pydata(points, [], [])
    bpy.context.scene.collection.objects.link(bpy.data.objects.new(name, data))
bpy.ops.wm.save_as_mainfile(filepath=os.path.abspath("clouds.blend"))
