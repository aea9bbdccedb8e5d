"""Run in Blender behind ffd_import.py: writes what its modifiers make of the scene, and what objects there are."""

import json
import sys

import bpy

graph = bpy.context.evaluated_depsgraph_get()
found = {}
for thing in bpy.context.scene.objects:
    made = {"type": thing.type, "modifiers": [[m.type, m.object and m.object.name] for m in thing.modifiers]}
    if thing.type == "MESH":
        matrix = thing.matrix_world
        made["after"] = [list(matrix @ v.co) for v in thing.evaluated_get(graph).data.vertices]
    found[thing.name] = made
with open("look.json", "w", encoding="utf-8") as file:
    json.dump(found, file)
