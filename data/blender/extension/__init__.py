# SPDX-License-Identifier: GPL-3.0-or-later
"""Lattices of ffd in Blender: export, import, and applying one to a mesh with shape keys."""

import os

import bpy
from bpy_extras.io_utils import ExportHelper, ImportHelper

from . import apply_lattice, ffd_export, ffd_import
from . import ffd_lattice_math as maths

UP = bpy.props.EnumProperty(name="Up", items=(("Z", "Z", "As in Blender"), ("Y", "Y", "As in glTF: (x, y, z) is (x, z, -y)")), default="Z")
FILTER = bpy.props.StringProperty(default="*.json", options={"HIDDEN"})


class Operator:
    """What the operators share: a refusal is an error in the status line."""

    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context):
        try:
            self.run(context)
        except maths.Refused as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}

    def warn(self, text):
        self.report({"WARNING"}, text)


class FFD_LATTICE_OT_export(Operator, bpy.types.Operator, ExportHelper):
    """Write a lattice file of ffd for each Lattice modifier of the selected objects"""

    bl_idname = "ffd_lattice.export"
    bl_label = "Export FFD Lattices"
    filename_ext = ".json"
    filter_glob: FILTER
    check_existing: bpy.props.BoolProperty(default=False, options={"HIDDEN"})
    up: UP
    use_frames: bpy.props.BoolProperty(name="Frames", description="A key for each frame of the range")
    frame_start: bpy.props.IntProperty(name="First", default=1, min=0)
    frame_end: bpy.props.IntProperty(name="Last", default=250, min=1)
    replace: bpy.props.BoolProperty(name="Replace Files", description="Replace files that exist")

    def run(self, context):
        if self.use_frames and self.frame_end <= self.frame_start:
            raise maths.Refused("the last frame is not behind the first")
        frames = (self.frame_start, self.frame_end) if self.use_frames else None
        sources = ffd_export.find_sources(context.selected_objects, self.warn)
        texts = ffd_export.make_texts(sources, context, frames, self.up.lower(), self.warn)
        if not texts:
            raise maths.Refused("nothing was written: the selection has no Lattice modifier to export")
        ffd_export.write_all(self.files(texts), self.replace, '"Replace Files" replaces it')
        ffd_export.give_attributes([source for source, _ in texts], self.warn)
        for source, _ in texts:
            self.report({"INFO"}, f"{source.label}: {ffd_export.advice_for(source, context.view_layer.objects)}")

    def files(self, texts):
        """One is called as chosen, several are beside that name."""
        path = bpy.path.ensure_ext(bpy.path.abspath(self.filepath), self.filename_ext)
        if len(texts) == 1:
            return [(path, texts[0][1])]
        taken = set()
        return [(f"{os.path.splitext(path)[0]}-{maths.file_name(source.owner.name, source.modifier.name, taken)}", text) for source, text in texts]


class FFD_LATTICE_OT_import_file(Operator, bpy.types.Operator, ImportHelper):
    """Make a lattice of a lattice file of ffd, and a Lattice modifier on the selected meshes"""

    bl_idname = "ffd_lattice.import_file"
    bl_label = "Import FFD Lattice"
    filter_glob: FILTER
    up: UP
    size: bpy.props.IntVectorProperty(name="Size", description="Points of a lattice that is fitted; 0: as many as it needs", default=(0, 0, 0), min=0,
                                      max=maths.MOST_POINTS)

    def run(self, context):
        path = bpy.path.abspath(self.filepath)
        size = maths.checked_size(",".join(map(str, self.size))) if any(self.size) else None
        wanted = ffd_import.convert(ffd_import.read_text(path), path, size, self.up.lower())
        meshes = [thing for thing in context.selected_objects if thing.type == "MESH"]
        ffd_import.check_meshes(meshes)
        cage = ffd_import.add_lattice(wanted, os.path.splitext(os.path.basename(path))[0], context.collection)
        ffd_import.use_lattice(cage, meshes)
        ffd_import.tell(wanted, path, size, lambda text: self.report({"INFO"}, text))


class FFD_LATTICE_OT_apply(Operator, bpy.types.Operator):
    """Apply the first Lattice modifier of the active mesh to its vertices and to each of its shape keys"""

    bl_idname = "ffd_lattice.apply"
    bl_label = "Apply FFD Lattice, Keep Shape Keys"

    @staticmethod
    def run(context):
        apply_lattice.apply_first(context)


CLASSES = (FFD_LATTICE_OT_export, FFD_LATTICE_OT_import_file, FFD_LATTICE_OT_apply)


def draw_export(menu, _context):
    menu.layout.operator(FFD_LATTICE_OT_export.bl_idname, text="FFD Lattices (.json)")


def draw_import(menu, _context):
    menu.layout.operator(FFD_LATTICE_OT_import_file.bl_idname, text="FFD Lattice (.json)")


def draw_apply(menu, _context):
    menu.layout.operator(FFD_LATTICE_OT_apply.bl_idname)


MENUS = (("TOPBAR_MT_file_export", draw_export), ("TOPBAR_MT_file_import", draw_import), ("VIEW3D_MT_object", draw_apply))


def register():
    for one in CLASSES:
        bpy.utils.register_class(one)
    for name, draw in MENUS:
        getattr(bpy.types, name).append(draw)


def unregister():
    for name, draw in MENUS:
        getattr(bpy.types, name).remove(draw)
    for one in reversed(CLASSES):
        bpy.utils.unregister_class(one)
