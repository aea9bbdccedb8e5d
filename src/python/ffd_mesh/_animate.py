"""Lattices with keys as animations of morph targets, as `ffd animate` makes them."""

from __future__ import annotations

import ctypes
from typing import Any, Literal, Mapping, NamedTuple, Unpack

from . import _library as library
from ._description import AnyLattice, Files, Memory, Path, described, resolved
from ._errors import Error
from ._library import Progress, call, lib
from ._result import beside, plain
from ._types import AnimateFileOptions, AnimateOptions, names

_OWN = ("name", "tolerance", "targets", "fps")


class Animation(NamedTuple):
    """What `animate_file` and `animate_bytes` have made. Lengths are in world units."""

    name: str
    targets: int  # new morph targets of a mesh, at most; 0: nothing moves
    keys: int  # times of the animation
    samples: int  # of the path, from which these were chosen
    tolerance: float
    bound: float  # no vertex is farther from its place, but for the rounding to float32
    largest_weight: float
    bytes: int  # by which the files grew
    counts: dict[str, int]  # vertices, and those of each status
    seconds: dict[str, float]
    warnings: list[str]


class AnimatedBytes(NamedTuple):
    """What `animate_bytes` returns."""

    data: bytes  # the mesh
    files: dict[str, bytes]  # further files by name, as of `deform_bytes`
    animation: Animation


def _set_tolerance(desc: Any, value: Any) -> None:
    relative = isinstance(value, str) and value.endswith("r")
    desc.tolerance, desc.relative = library.real(value[:-1] if relative else value, "tolerance"), relative


def _set_targets(desc: Any, value: Any) -> None:
    if value in ("auto", "keys"):
        desc.targets = library.value_of("ffd_animate_targets", value, "targets")
    else:
        desc.targets, desc.count = library.value_of("ffd_animate_targets", "count", "targets"), library.integer(value, "targets", 1)


def _figures(result: Any, warnings: list[str]) -> Animation:
    told: dict[str, Any] = plain(result)
    counts = {name: told[name] for name in ("vertices", "inside", "outside", "multiple", "singular", "invalid")}
    figures = {name: told[name] for name in Animation._fields[:8]}
    return Animation(**figures, counts=counts, seconds=told["seconds"], warnings=warnings)


def _animate(source: Any, output: Any, lattice: AnyLattice, taken: list[Any] | None, name: str | None, tolerance: Any, targets: Any,
             fps: float, progress: Progress | None, options: Mapping[str, Any], known: frozenset[str], own: tuple[str, ...]) -> Animation:
    desc, result = library.filled("ffd_animate_desc"), library.empty("ffd_animate_result")
    if name is not None:
        desc.name = library.encoded(name, "name")
    _set_tolerance(desc, tolerance)
    _set_targets(desc, targets)
    desc.frames_per_second = library.real(fps, "fps")
    warnings: list[str] = []
    try:
        with described(source, lattice, options, known, own=own) as (job, warnings), resolved(source), \
                library.progress_into(job, progress):
            job.output = library.path(output)
            if taken is not None:
                library.sink_into(job, taken)
            desc.job = ctypes.pointer(job)
            call(lib.ffd_animate_run, ctypes.byref(desc), ctypes.byref(result))
    except Error as refused:
        refused.warnings = warnings
        raise
    return _figures(result, warnings)


def animate_file(source: Path, output: Path, lattice: AnyLattice, *, name: str | None = None, tolerance: float | str = "0.001r",
                 targets: Literal["auto", "keys"] | int = "auto", fps: float = 60, progress: Progress | None = None,
                 **options: Unpack[AnimateFileOptions]) -> Animation:
    """Plays a lattice with keys as an animation of morph targets, as `ffd animate` does. The output is complete or absent.

    output: a .glb, .gltf or .vrm
    lattice: a `Lattice`, a path, or the text of a lattice file as bytes
    name: of the animation, whose targets are called NAME-1, ..; None: that of the lattice's file
    tolerance: how far a vertex may be from its place: a length, or a text such as "0.001r", relative to the diagonal of the lattice
    targets: "auto" (as few as the tolerance allows), "keys" (one for each key), or their number
    fps: how many samples a second at least, where keys set values: 1 to 1000
    progress: as of `deform_file`
    options: set=, outside=, falloff=, seam=, snap=, only=, weight=, normals="transform" | "keep", space=, resources=, force=,
      if_changed=, dry_run=, make_folders=, threads=, isa=, memory=, timeout=, strict=, allow_extensions=, as of `deform_file`
    Raises `Error`. Threads may call it at the same time.
    """
    return _animate(source, output, lattice, None, name, tolerance, targets, fps, progress, options,
                    names(AnimateFileOptions), (*_OWN, "progress"))


def animate_bytes(data: Any, lattice: AnyLattice, *, name: str, output: str, files: Files | None = None, animation: str | None = None,
                  tolerance: float | str = "0.001r", targets: Literal["auto", "keys"] | int = "auto", fps: float = 60,
                  **options: Unpack[AnimateOptions]) -> AnimatedBytes:
    """Like `animate_file`, for a mesh in memory, with the same bytes as result; reads and writes no files.

    data, name, files: the mesh, its name and the files that it refers to, as of `deform_bytes`
    output: name of the result, which ends in .glb, .gltf or .vrm
    animation: its name
    options: those of `animate_file`, except force, if_changed, make_folders and resources
    """
    taken: list[Any] = []
    made = _animate(Memory(data, name, files), output, lattice, taken, animation, tolerance, targets, fps, None, options,
                    names(AnimateOptions), (*_OWN, "output", "files", "animation"))
    return AnimatedBytes(taken[-1][1] if taken else b"", beside(taken, output), made)
