"""Lattices in the formats of other programs, as tables and arrays."""

from __future__ import annotations

import ctypes
from typing import Any, Mapping

from . import _library as library
from ._library import call, lib
from ._types import Counts, Degrees, Order, Part, Path
from ._values import settings, three


def is_other(path: Any) -> bool:
    """Whether a file holds a lattice in another format than JSON, by its ending."""
    return bool(lib.ffd_lattice_converts(library.path(path)))


def convert(source: Any, output: Any, *, pointer: Any = None, values: Mapping[str, Any] | None = None, size: Any = None,
            degree: Any = None, part: str | None = None, order: str | None = None, block: str | int | None = None,
            time: float | None = None, force: bool = False, taken: list[Any] | None = None) -> list[str]:
    """Runs the job of `ffd lattice convert`. pointer: of a lattice, in place of the file `source`. taken: receives the output.
    Returns the warnings, which are logged too."""
    job, desc = library.filled("ffd_author_desc"), library.filled("ffd_convert_desc")
    made, count = settings(values)
    if pointer is None:
        job.lattice.path = library.path(source)
    else:
        job.lattice.object = pointer
    job.output, job.force, job.set, job.set_count = library.path(output), bool(force), made, count
    desc.size[:] = [0 if value is None else library.integer(value, "size", 2, 2**62) for value in three(size, "size")]
    desc.degree[:] = [0 if value is None else library.integer(value, "degree", 1, 14) for value in three(degree, "degree")]
    if time is not None:
        job.time, job.has_time = library.real(time, "time"), True
    if part is not None:
        desc.part = library.value_of("ffd_lattice_part", part, "part")
    if order is not None:
        desc.order = library.value_of("ffd_point_order", order, "order")
    desc.block = None if block is None else library.path(str(block))
    if taken is not None:
        library.sink_into(job, taken)
    with library.logged(job) as warnings:
        call(lib.ffd_lattice_convert_run, ctypes.byref(job), ctypes.byref(desc))
    return warnings


def convert_lattice(source: Path, output: Path, *, values: Mapping[str, Any] | None = None, size: Counts | None = None,
                    degree: Degrees = None, part: Part | None = None, order: Order | None = None,
                    block: str | int | None = None, time: float | None = None, force: bool = False) -> list[str]:
    """Writes a lattice file in another format, as `ffd lattice convert` does, by the endings (data/schema/lattice.md 12).

    values: for the placeholders of a JSON file, by name
    size: of points in a row (.npy, .obj): control points along u, v, w; one for all, or three
    degree: of a file that tells none; None: min(3, n - 1)
    part: "rest", "deformed" or "both"; None: both, where the format holds both
    order: of points (.npy, .obj, .xyz, .fmt), "uvw": as they stand, or "auto": u, v, w are found by them; None: "uvw", but of a
        .obj that does not tell its size "auto"
    block: of a file of several lattices, its number from 0 (.xyz, .fmt) or its name (.su2)
    time: of a lattice with keys, which is written as it is at this time; required for one
    force: replace an existing file
    Returns the warnings: what the format cannot hold, and the size that was found. They are also logged, as "ffd_mesh".
    """
    return convert(source, output, values=values, size=size, degree=degree, part=part, order=order, block=block, time=time, force=force)
