"""Stands for Blender's program where there is only its module bpy: opens a scene, if one is named, and runs scripts one after the other.

    python wheel.py [SCENE.blend] SCRIPT... [-- ARGUMENTS]
"""

import runpy
import sys

import bpy

end = sys.argv.index("--") if "--" in sys.argv else len(sys.argv)
words = sys.argv[1:end]
bpy.ops.wm.read_factory_settings()
if words[0].endswith(".blend"):
    bpy.ops.wm.open_mainfile(filepath=words.pop(0))
given = sys.argv[end:]
for script in words:
    sys.argv = [script] + given
    runpy.run_path(script, run_name="__main__")
