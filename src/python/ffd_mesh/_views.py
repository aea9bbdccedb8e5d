"""Pages and pictures of meshes before and after, as `ffd view` makes them."""

from __future__ import annotations

import ctypes
import os
from typing import Any, Mapping, NamedTuple, Sequence

from . import _declarations as declared
from . import _library as library
from ._description import OPTIONS, AnyLattice, Files, Memory, Path, described, place
from ._errors import Error, GateError
from ._library import lib
from ._result import Result, finish, run

# What is said of outputs of other jobs.
_OPTIONS = OPTIONS - {"output_format", "resources", "force", "if_changed", "dry_run", "as_morph", "clips"}
# As the program has them; "iso" is what a page opens with.
_CAMERAS = {"front": (0, 0, 1), "back": (0, 0, -1), "left": (-1, 0, 0), "right": (1, 0, 0), "top": (0, 1, 0), "iso": (0, 0, 0)}


def _set_camera(desc: Any, value: Any) -> None:
    if isinstance(value, str) and value not in _CAMERAS:
        raise ValueError(f"camera must be one of {', '.join(map(repr, _CAMERAS))}, or three numbers, not {value!r}")
    direction = _CAMERAS[value] if isinstance(value, str) else tuple(value)
    if len(direction) != 3:
        raise ValueError(f"camera must be three numbers, not {len(direction)}")
    desc.camera[:] = [library.real(number, "camera") for number in direction]


def _set_look(desc: Any, output: Any, color: str, camera: Any, size: tuple[int, int] | None, frames: int | None, full: bool,
              animation: str | None) -> None:
    """Refuses what would do nothing, as the program does."""
    is_picture = os.fsdecode(output).lower().endswith(".png")
    if full and is_picture:
        raise ValueError("full is of a page, and the output is a picture")
    if not is_picture and (size is not None or frames is not None):
        raise ValueError("size and frames are of a picture, and the output is a page")
    desc.color, desc.full = library.number_of("ffd_view_color", color, "color"), bool(full)
    _set_camera(desc, camera)
    if size is not None:
        desc.width, desc.height = (library.integer(side, "size", 1, 2**32 - 1) for side in size)
    if frames is not None:
        desc.frames = library.integer(frames, "frames", 1, 2**32 - 1)
    if animation is not None:
        desc.animation = library.encoded(animation, "animation")


def _view(desc: Any, source: Any, output: Any, lattices: Any, deformed: Any, look: Mapping[str, Any],
          options: dict[str, Any]) -> tuple[Any, Error | None, list[str]]:
    desc.output = library.path(output)
    _set_look(desc, output, **look)
    with described(source, lattices, options, _OPTIONS) as (job, warnings):
        desc.job = ctypes.pointer(job)
        if deformed is not None:
            other = declared.ffd_source.from_buffer_copy(job.input)  # read as the first one
            place(deformed, other)
            desc.deformed = ctypes.pointer(other)
        found, raised = run(lib.ffd_view_run, desc)
    return found, raised, warnings


def view_file(source: Path, output: Path, lattices: AnyLattice | Sequence[AnyLattice] | None = None, *,
              deformed: Path | None = None, color: str = "displacement", camera: str | Sequence[float] = "iso",
              size: tuple[int, int] | None = None, frames: int | None = None, full: bool = False, animation: str | None = None,
              force: bool = False, **options: Any) -> Result:
    """Draws a mesh before and after, as `ffd view` does: a page (.html), which a browser opens without a network, or a
    picture (.png). The output is complete or absent.

    lattices: what deforms it, as `deform_file` takes it; None: it is shown as it is. deformed: the deformed mesh as a file, of
      as many vertices: lattices are drawn then, and deform nothing
    color="displacement" | "status" | "det" | "plain"; camera="front" | "back" | "left" | "right" | "top" | "iso" | (x, y, z):
      where one looks from, y upwards; animation="NAME": its poses, or what a page opens with
    size=(width, height), frames=N: of a picture, in pixels (None: 1600 x 900), and how many in a row; full=True: a page shows all
      vertices; force=True: replace the output
    options: those of `check_file`
    Returns what `check_file` finds, of the shapes that are shown. Raises `Error`; `GateError` where fail_on refuses what is drawn
    all the same. Any number of threads may call it.
    """
    desc = library.filled("ffd_view_desc")
    desc.force = bool(force)
    look = {"color": color, "camera": camera, "size": size, "frames": frames, "full": full, "animation": animation}
    return finish(*_view(desc, source, output, lattices, deformed, look, options))


class ViewBytes(NamedTuple):
    """What `view_bytes` returns."""

    data: bytes  # the page or the picture
    result: Result  # what `view_file` returns


def view_bytes(data: Any, lattices: AnyLattice | Sequence[AnyLattice] | None = None, *, name: str, output: str = "view.html",
               files: Files | None = None, deformed: Any = None, deformed_name: str | None = None,
               deformed_files: Files | None = None, color: str = "displacement", camera: str | Sequence[float] = "iso",
               size: tuple[int, int] | None = None, frames: int | None = None, full: bool = False, animation: str | None = None,
               **options: Any) -> ViewBytes:
    """`view_file` of a mesh in memory: data, name and files as `deform_bytes` takes them; reads and writes no file.

    output: its ending says whether it is a page or a picture. deformed: the deformed mesh, as data; deformed_name,
      deformed_files: None: as those of data. All else as `view_file`, but for force. A `GateError` has the output as its data.
    """
    desc, taken = library.filled("ffd_view_desc"), []
    library.sink_into(desc, taken)
    memory = Memory(data, name, files)
    other = None if deformed is None else Memory(deformed, name if deformed_name is None else deformed_name,
                                                 files if deformed_files is None else deformed_files)
    look = {"color": color, "camera": camera, "size": size, "frames": frames, "full": full, "animation": animation}
    found, raised, warnings = _view(desc, memory, output, lattices, other, look, options)
    memory.reraise()
    if other is not None:
        other.reraise()
    if isinstance(raised, GateError):
        raised.data = taken[-1][1]
    return ViewBytes(taken[-1][1] if taken else b"", finish(found, raised, warnings))
