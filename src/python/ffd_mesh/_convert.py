"""Lattices as tables (.csv) and arrays (.npy)."""

from __future__ import annotations

import ctypes
import os
from typing import Any, Mapping

from . import _library as library
from ._library import call, lib
from ._values import settings, three

TABLES = (".csv", ".npy")


def is_table(path: Any) -> bool:
    """Whether a file holds a lattice in another format than JSON, by its ending."""
    return str(os.fspath(path)).lower().endswith(TABLES)


def convert(source: Any, output: Any, *, pointer: Any = None, values: Mapping[str, Any] | None = None, size: Any = None,
            degree: Any = None, part: str | None = None, force: bool = False, taken: list[Any] | None = None) -> list[str]:
    """Runs the job of `ffd lattice convert`. pointer: of a lattice, in place of the file `source`. taken: receives the output.
    Returns the warnings, which are logged too."""
    desc = library.filled("ffd_lattice_convert_desc")
    made, count = settings(values)
    if pointer is None:
        desc.lattice.path = library.path(source)
    else:
        desc.lattice.object = pointer
    desc.output, desc.force, desc.set, desc.set_count = library.path(output), bool(force), made, count
    desc.size[:] = [0 if value is None else library.integer(value, "size", 2, 2**62) for value in three(size, "size")]
    desc.degree[:] = [0 if value is None else library.integer(value, "degree", 1, 14) for value in three(degree, "degree")]
    if part is not None:
        desc.part = library.value_of("ffd_lattice_part", part, "part")
    if taken is not None:
        library.sink_into(desc, taken)
    with library.logged(desc) as warnings:
        call(lib.ffd_lattice_convert_run, ctypes.byref(desc))
    return warnings


def convert_lattice(source: str | os.PathLike[str], output: str | os.PathLike[str], *, values: Mapping[str, Any] | None = None,
                    size: Any = None, degree: Any = None, part: str | None = None, force: bool = False) -> list[str]:
    """Writes a lattice file in another format, as `ffd lattice convert` does: .json, .csv and .npy, by the endings.

    values: for the placeholders of a JSON file, by name
    size: of an array (n, 3): control points along u, v, w; one for all, or three
    degree: of a file that tells none; None: min(3, n - 1)
    part: "rest", "deformed" or "both"; None: both, where the format holds both
    force: replace an existing file
    Returns the warnings: what the format cannot hold. They are also logged, as "ffd_mesh".
    """
    return convert(source, output, values=values, size=size, degree=degree, part=part, force=force)
