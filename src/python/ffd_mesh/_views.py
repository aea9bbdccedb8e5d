"""Pages and pictures of meshes before and after, as `ffd view` makes them; pages with tools, as `ffd edit` makes them."""

from __future__ import annotations

import ctypes
import os
from typing import Any, Mapping, NamedTuple, Sequence, Unpack

from . import _declarations as declared
from . import _library as library
from ._description import AnyLattice, Files, Memory, Path, described, place
from ._errors import Error, GateError
from ._library import lib
from ._result import Result, finish, run
from ._types import Axis, Color, Counts, Degrees, EditOptions, KnotWords, Side, ViewOptions, names
from ._values import box_desc

_OPTIONS = names(ViewOptions)
_SIDES = ("front", "back", "left", "right", "top", "bottom", "iso")


def _set_camera(desc: Any, value: Any) -> None:
    """Of a desc whose `up` is set, by which a named side is turned."""
    if isinstance(value, str):
        if value not in _SIDES:
            raise ValueError(f"camera must be one of {', '.join(map(repr, _SIDES))}, or three numbers, not {value!r}")
        lib.ffd_view_camera(value.encode(), desc.up, desc.camera)
        return
    direction = tuple(value)
    if len(direction) != 3:
        raise ValueError(f"camera must be three numbers, not {len(direction)}")
    desc.camera[:] = [library.real(number, "camera") for number in direction]


# What `batch` takes of the options of a view.
LOOK = ("color", "camera", "size", "frames", "animation", "up", "no_cage")


def set_look(desc: Any, color: str = "auto", camera: Any = "iso", size: tuple[int, int] | None = None, frames: int | None = None,
             animation: str | None = None, up: Axis = "y", no_cage: bool = False) -> None:
    """Sets how a mesh is drawn."""
    desc.color = library.value_of("ffd_view_color", color, "color")
    desc.up, desc.no_cage = library.value_of("ffd_up", up, "up"), bool(no_cage)
    _set_camera(desc, camera)
    if size is not None:
        desc.width, desc.height = (library.integer(side, "size", 1, 2**32 - 1) for side in size)
    if frames is not None:
        desc.frames = library.integer(frames, "frames", 1, 2**32 - 1)
    if animation is not None:
        desc.animation = library.encoded(animation, "animation")


def _set_output(desc: Any, output: Any, full: bool, **look: Any) -> None:
    """Sets the options of the page or picture. Like the program, refuses options without effect."""
    is_picture = os.fsdecode(output).lower().endswith(".png")
    if full and is_picture:
        raise ValueError("full is for pages, but the output is a picture")
    if not is_picture and (look["size"] is not None or look["frames"] is not None):
        raise ValueError("size and frames are for pictures, but the output is a page")
    desc.full = bool(full)
    set_look(desc, **look)


def _view(desc: Any, source: Any, output: Any, lattices: Any, deformed: Any, look: Mapping[str, Any],
          options: Mapping[str, Any], own: tuple[str, ...]) -> tuple[Any, Error | None, list[str]]:
    desc.output = library.path(output)
    _set_output(desc, output, **look)
    with described(source, lattices, options, _OPTIONS, own=own) as (job, warnings):
        desc.job = ctypes.pointer(job)
        if deformed is not None:
            other = declared.ffd_source.from_buffer_copy(job.input)  # same options for reading
            place(deformed, other)
            desc.deformed = ctypes.pointer(other)
        found, raised = run(lib.ffd_view_run, desc)
    return found, raised, warnings


def view_file(source: Path, output: Path, lattices: AnyLattice | Sequence[AnyLattice] | Mapping[str, AnyLattice] | None = None, *,
              deformed: Path | None = None, color: Color = "auto", camera: Side | Sequence[float] = "iso",
              size: tuple[int, int] | None = None, frames: int | None = None, full: bool = False, animation: str | None = None,
              up: Axis = "y", no_cage: bool = False, force: bool = False,
              **options: Unpack[ViewOptions]) -> Result:
    """Draws a mesh before and after its deformation, as `ffd view` does. The output is complete or absent.

    output: path of a page (.html, needs no network) or a picture (.png)
    lattices: as in `deform_file`; None: show the mesh as it is. A dict {name: lattice} shows the morph targets that these make,
      in full; in a page each has a slider, as have those of the file
    deformed: path of the deformed mesh, with as many vertices; lattices are then drawn, but deform nothing
    color: "auto" | "displacement" | "status" | "det" | "plain"
    camera: "front" | "back" | "left" | "right" | "top" | "bottom" | "iso", or (x, y, z), the direction from the mesh to the camera
    up: "y" | "z" | "x", the axis that points upwards in the view; the mesh stays as it is
    no_cage=True: draw no control points
    animation: name of the animation that a picture shows in poses, or that a page shows first
    size=(width, height): of a frame of a picture, in pixels; None: 1600 x 900
    frames: number of frames of a picture, in one row
    full=True: a page shows all vertices
    force=True: replace the output
    options: those of `check_file`
    Returns the result of `check_file` for the shapes shown. Raises `Error`; `GateError` if fail_on refuses the shape, which is
    drawn all the same. Threads may call it at the same time.
    """
    desc = library.filled("ffd_view_desc")
    desc.force = bool(force)
    look = {"color": color, "camera": camera, "size": size, "frames": frames, "full": full, "animation": animation,
            "up": up, "no_cage": no_cage}
    return finish(*_view(desc, source, output, lattices, deformed, look, options, (*look, "deformed", "force")))


_OTHER = ("deformed", "deformed_name", "deformed_files")


class ViewBytes(NamedTuple):
    """What `view_bytes` returns."""

    data: bytes  # the page or picture
    result: Result  # as `view_file` returns it


def view_bytes(data: Any, lattices: AnyLattice | Sequence[AnyLattice] | Mapping[str, AnyLattice] | None = None, *,
               name: str, output: str = "view.html", files: Files | None = None, deformed: Any = None,
               deformed_name: str | None = None, deformed_files: Files | None = None, color: Color = "auto", camera: Side | Sequence[float] = "iso",
               size: tuple[int, int] | None = None, frames: int | None = None, full: bool = False, animation: str | None = None,
               up: Axis = "y", no_cage: bool = False, **options: Unpack[ViewOptions]) -> ViewBytes:
    """Like `view_file`, for a mesh in memory; reads and writes no files.

    data, name, files: as in `deform_bytes`
    output: its ending decides between page and picture
    deformed, deformed_name, deformed_files: the deformed mesh, likewise; name and files None: the same as for data
    All other arguments are those of `view_file`, except force. A `GateError` has the output in its member data.
    """
    desc = library.filled("ffd_view_desc")
    taken: list[Any] = []
    library.sink_into(desc, taken)
    memory = Memory(data, name, files)
    other = None if deformed is None else Memory(deformed, name if deformed_name is None else deformed_name,
                                                 files if deformed_files is None else deformed_files)
    look = {"color": color, "camera": camera, "size": size, "frames": frames, "full": full, "animation": animation,
            "up": up, "no_cage": no_cage}
    found, raised, warnings = _view(desc, memory, output, lattices, other, look, options, (*look, "name", "output", "files", *_OTHER))
    memory.reraise()
    if other is not None:
        other.reraise()
    if isinstance(raised, GateError):
        raised.data = taken[-1][1]
    return ViewBytes(taken[-1][1] if taken else b"", finish(found, raised, warnings))


def _edit(desc: Any, source: Any, output: Any, lattices: Any, full: bool, up: str, new: Mapping[str, Any],
          options: Mapping[str, Any], own: tuple[str, ...]) -> tuple[Any, Error | None, list[str]]:
    given = {name: value for name, value in new.items() if value is not None}
    if lattices is not None and given:
        raise ValueError(f"{', '.join(given)}: of a new lattice, not with lattices")
    box = box_desc(**given)
    desc.output, desc.full, desc.up = library.path(output), bool(full), library.value_of("ffd_up", up, "up")
    if lattices is None:
        desc.lattice = ctypes.pointer(box)
    with described(source, lattices, options, names(EditOptions), own=(*new, "full", "up", *own)) as (job, warnings):
        desc.job = ctypes.pointer(job)
        found, raised = run(lib.ffd_edit_run, desc)
    return found, raised, warnings


def edit_file(source: Path, output: Path, lattices: AnyLattice | Sequence[AnyLattice] | None = None, *,
              size: Counts | None = None, degree: Degrees = None, knots: KnotWords | None = None,
              margin: Sequence[float] | float | None = None, full: bool = False, up: Axis = "y", force: bool = False,
              **options: Unpack[EditOptions]) -> Result:
    """Makes a page in which a lattice is shaped by hand, as `ffd edit` does. The output is complete or absent.

    output: path of the page (.html), which a browser opens without a network; its Save writes a lattice file
    lattices: as in `deform_file`; of several the last is edited. None: a new box round the mesh, by size (4, 4, 4), degree, knots and
      margin, as in `Lattice.around`
    full=True: the page shows all vertices; else a mesh of more than 200,000 is simplified
    up: "y" | "z" | "x", the axis that points upwards on the page; the mesh stays as it is
    force=True: replace the output
    options: only, outside, falloff, snap, space, set, time, threads, memory, timeout, .. of `deform_file`
    Returns a result with the numbers of vertices inside and outside of the lattice. Raises `Error`. Threads may call it at the same time.
    """
    desc = library.filled("ffd_edit_desc")
    desc.force = bool(force)
    new = {"size": size, "degree": degree, "knots": knots, "margin": margin}
    return finish(*_edit(desc, source, output, lattices, full, up, new, options, ("force",)))


def edit_bytes(data: Any, lattices: AnyLattice | Sequence[AnyLattice] | None = None, *, name: str, output: str = "edit.html",
               files: Files | None = None, size: Counts | None = None, degree: Degrees = None,
               knots: KnotWords | None = None, margin: Sequence[float] | float | None = None, full: bool = False, up: Axis = "y",
               **options: Unpack[EditOptions]) -> ViewBytes:
    """Like `edit_file`, for a mesh in memory; reads and writes no files.

    data, name, files: as in `deform_bytes`
    output: name of the page
    All other arguments are those of `edit_file`, except force.
    """
    desc = library.filled("ffd_edit_desc")
    taken: list[Any] = []
    library.sink_into(desc, taken)
    memory = Memory(data, name, files)
    new = {"size": size, "degree": degree, "knots": knots, "margin": margin}
    found, raised, warnings = _edit(desc, memory, output, lattices, full, up, new, options, ("name", "output", "files"))
    memory.reraise()
    return ViewBytes(taken[-1][1] if taken else b"", finish(found, raised, warnings))
