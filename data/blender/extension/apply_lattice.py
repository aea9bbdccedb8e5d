# SPDX-License-Identifier: GPL-3.0-or-later
"""Applies a Lattice modifier to a mesh with shape keys: the mesh and each key by itself. Blender refuses this."""

import numpy as np

from . import ffd_export
from . import ffd_lattice_math as maths


def import_ffd():
    """The package that the extension brings. Raises maths.Refused."""
    try:
        import ffd_mesh  # pylint: disable=import-outside-toplevel
    except Exception as error:  # whatever keeps a library from being loaded
        raise maths.Refused(f"ffd_mesh cannot be imported: {error}") from None
    return ffd_mesh


def find_modifier(owner):
    """The modifier that can be applied. Raises maths.Refused."""
    if owner is None or owner.type != "MESH":
        raise maths.Refused("the active object is not a mesh")
    if owner.mode != "OBJECT":
        raise maths.Refused(f'"{owner.name}" is not in object mode')
    if not any(modifier.type == "LATTICE" for modifier in owner.modifiers):
        raise maths.Refused(f'"{owner.name}" has no Lattice modifier')
    modifier, mesh = owner.modifiers[0], owner.data
    if modifier.type != "LATTICE":
        raise maths.Refused(f'the Lattice modifier of "{owner.name}" is not the first one')
    if modifier.object is None or modifier.object.type != "LATTICE":
        raise maths.Refused(f'the modifier "{modifier.name}" has no lattice')
    if modifier.object.data.is_editmode:  # Blender tells wrong points then
        raise maths.Refused(f'the lattice of "{modifier.name}" is in edit mode')
    if not modifier.show_viewport:
        raise maths.Refused(f'the modifier "{modifier.name}" is off')
    if mesh.users - mesh.use_fake_user > 1:
        raise maths.Refused(f'the mesh "{mesh.name}" has several users')
    if any(data.library or data.override_library for data in (owner, mesh)):
        raise maths.Refused(f'"{owner.name}" is linked from a library')
    return modifier


def shapes_of(mesh):
    """What holds coordinates: the vertices, and the points of each key."""
    keys = mesh.shape_keys.key_blocks if mesh.shape_keys else []
    return [mesh.vertices, *(key.data for key in keys)]


def read(points):
    flat = np.empty(3 * len(points), np.float32)
    points.foreach_get("co", flat)
    return flat.astype(float).reshape(-1, 3)


def deformed(ffd, moment, shapes, weights):
    """The shapes, deformed in the lattice's own space: the box stays a box there, whatever the parents of the objects."""
    maths.box_of(moment.matrix)
    try:
        to_cage = np.linalg.inv(moment.matrix) @ moment.owner_matrix
        back = np.linalg.inv(to_cage[:3, :3])
    except np.linalg.LinAlgError:
        raise maths.Refused("the object has the scale 0") from None
    lattice = ffd.Lattice.parse(maths.lattice_document(moment.types, moment.size, moment.first, moment.step, np.eye(4), moment.offsets))
    points = np.concatenate(shapes) @ to_cage[:3, :3].T + to_cage[:3, 3]
    if not np.isfinite(points).all():
        raise maths.Refused("the mesh has a coordinate that is not finite")
    moved = lattice.deform(lattice.embed(points, outside="extend"), weight=None if weights is None else np.tile(weights.astype(float), len(shapes)))
    found = np.concatenate(shapes) + (moved - points) @ back.T
    return np.split(found, len(shapes))


def apply_first(context):
    """Applies the first modifier of the active object. Raises maths.Refused, and has changed nothing then."""
    owner = context.object
    modifier = find_modifier(owner)
    ffd = import_ffd()
    mesh = owner.data
    moment = ffd_export.Moment(ffd_export.Source(owner, modifier), context.evaluated_depsgraph_get())
    shapes = shapes_of(mesh)
    if len(mesh.vertices):
        try:
            results = deformed(ffd, moment, [read(points) for points in shapes], ffd_export.group_weights(owner, modifier))
        except ffd.Error as error:
            raise maths.Refused(str(error)) from None
        for points, result in zip(shapes, results):
            points.foreach_set("co", result.astype(np.float32).ravel())
    owner.modifiers.remove(modifier)
    mesh.update()
