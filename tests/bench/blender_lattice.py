"""Run by Blender: reads an OBJ, deforms it by a lattice modifier with 8 x 8 x 8 points, and writes it.

    blender --background --python blender_lattice.py -- IN.obj OUT.obj
"""

import math
import sys

import bpy
from mathutils import Matrix, Vector


def add_lattice(meshes):
    """One round all meshes, twisted by 20 degrees."""
    corners = [mesh.matrix_world @ Vector(corner) for mesh in meshes for corner in mesh.bound_box]
    low, high = ([bound(corner[a] for corner in corners) for a in range(3)] for bound in (min, max))
    lattice = bpy.data.lattices.new("lattice")
    lattice.points_u = lattice.points_v = lattice.points_w = 8
    lattice.interpolation_type_u = lattice.interpolation_type_v = lattice.interpolation_type_w = "KEY_BSPLINE"
    cage = bpy.data.objects.new("lattice", lattice)
    cage.location = [(a + b) / 2 for a, b in zip(low, high)]
    cage.scale = [1.02 * (b - a) for a, b in zip(low, high)]
    bpy.context.collection.objects.link(cage)
    for point in lattice.points:
        point.co_deform = Matrix.Rotation(math.radians(20) * point.co[2], 3, "Z") @ point.co
    return cage


def main():
    source, target = sys.argv[sys.argv.index("--") + 1:]
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.wm.obj_import(filepath=source)
    bpy.context.view_layer.update()
    meshes = [thing for thing in bpy.context.scene.objects if thing.type == "MESH"]
    cage = add_lattice(meshes)
    for mesh in meshes:
        mesh.modifiers.new("lattice", "LATTICE").object = cage
    bpy.ops.wm.obj_export(filepath=target)


main()
