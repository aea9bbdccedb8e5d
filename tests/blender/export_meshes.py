"""Run in Blender behind ffd_export.py: exports the scene, without modifiers and with attributes."""

import os
import sys

import bpy

folder = sys.argv[sys.argv.index("--out") + 1]
bpy.ops.export_scene.gltf(filepath=os.path.join(folder, "scene.glb"), export_attributes=True)
