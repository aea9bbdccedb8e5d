"""Descriptions of mesh and lattice files, and comparisons of meshes."""

from __future__ import annotations

import contextlib
import ctypes
import json
from typing import Any, Iterator, Mapping

from . import _library as library
from ._description import Files, Memory, Path, place, resolved
from ._library import lib
from ._types import Format
from ._values import settings


@contextlib.contextmanager
def _text() -> Iterator[Any]:
    """Holds a text that the library allocates, and frees it."""
    text = ctypes.c_void_p()
    try:
        yield text
    finally:
        lib.ffd_free(text)


def _place(source: Any, structure: Any, input_format: str | None, memory: int | None, strict: bool) -> None:
    place(source, structure)
    structure.strict = bool(strict)
    if input_format is not None:
        structure.format = library.value_of("ffd_format", input_format, "input_format")
    if memory is not None:
        structure.memory = library.integer(memory, "memory", most=2**63)


def _info(source: Any, parts: bool, values: Mapping[str, Any] | None, **options: Any) -> dict[str, Any]:
    desc = library.filled("ffd_info_desc")
    _place(source, desc.file, **options)
    desc.json, desc.parts = True, bool(parts)
    desc.set, desc.set_count = settings(values)
    with _text() as text:
        with library.logged(desc), resolved(source):
            library.call(lib.ffd_info_run, ctypes.byref(desc), ctypes.byref(text))
        return json.loads(ctypes.string_at(text))


def info(path: Path, *, parts: bool = False, set: Mapping[str, Any] | None = None, input_format: Format | None = None,
         memory: int | None = None, strict: bool = False) -> dict[str, Any]:
    """Describes a mesh or lattice file in a dict, as `ffd info --json` does. A lattice file's name ends in .json.

    parts: also list the names that only= accepts
    set: values for the placeholders of a lattice
    input_format="ply", memory=BYTES, strict=True: as in `deform_file`
    Raises `Error` if the file is missing or not valid. Threads may call it at the same time.
    """
    return _info(path, parts, set, input_format=input_format, memory=memory, strict=strict)


def info_bytes(data: Any, *, name: str, files: Files | None = None, parts: bool = False, set: Mapping[str, Any] | None = None,
               input_format: Format | None = None, memory: int | None = None, strict: bool = False) -> dict[str, Any]:
    """Like `info`, for a mesh or lattice in memory. data, name, files: as in `deform_bytes`."""
    source = Memory(data, name, files)
    return _info(source, parts, set, input_format=input_format, memory=memory, strict=strict)


def _set_tolerances(desc: Any, tolerance: Any, normal_tolerance: Any) -> None:
    """Sets both tolerances like the program: a text "1e-6r" is relative to the diagonal, and is also the default for normals."""
    desc.relative = isinstance(tolerance, str) and tolerance.endswith("r")
    desc.tolerance = library.real(tolerance[:-1] if desc.relative else tolerance, "tolerance")
    if normal_tolerance is not None:
        desc.direction_tolerance = library.real(normal_tolerance, "normal_tolerance")
    elif desc.relative:
        desc.direction_tolerance = desc.tolerance


def _compare(a: Any, b: Any, names: tuple[bytes, bytes], tolerance: Any, normal_tolerance: Any, **options: Any) -> dict[str, Any]:
    desc, comparison = library.filled("ffd_compare_desc"), library.empty("ffd_comparison")
    _place(a, desc.a, **options)
    _place(b, desc.b, **options)
    _set_tolerances(desc, tolerance, normal_tolerance)
    with library.logged(desc), resolved(a, b):
        library.call(lib.ffd_compare_run, ctypes.byref(desc), ctypes.byref(comparison))
    with _text() as text:
        library.call(lib.ffd_comparison_json, ctypes.byref(comparison), *names, ctypes.byref(text))
        return json.loads(ctypes.string_at(text))


def compare_files(a: Path, b: Path, *, tolerance: float | str = 0.0, normal_tolerance: float | None = None,
                  input_format: Format | None = None, memory: int | None = None, strict: bool = False) -> dict[str, Any]:
    """Compares two mesh files, as `ffd compare --json` does. Returns a dict with "equal", "differences", "first", "worst", ..

    tolerance: largest difference of a coordinate of positions; a text such as "1e-6r" is relative to the diagonal of a
    normal_tolerance: largest difference of a component of normals and tangents. None: 0, or the number of a relative tolerance
    input_format="ply", memory=BYTES, strict=True: as in `deform_file`, for both files
    Different meshes are not an error. Raises `Error` if a file is missing or not valid. Threads may call it at the same time.
    """
    return _compare(a, b, (library.path(a), library.path(b)), tolerance, normal_tolerance, input_format=input_format,
                    memory=memory, strict=strict)


def compare_folders(a: Path, b: Path, *, tolerance: float | str = 0.0, normal_tolerance: float | None = None,
                    memory: int | None = None, strict: bool = False) -> dict[str, Any]:
    """Compares the meshes of two folders, paired by their relative names, as `ffd compare --recursive --json` does.

    Returns a dict with "equal", "files" (each with "name", "equal", "error" and the members of `compare_files`), "only_a", "only_b".
    A mesh that cannot be read differs. tolerance, ..: as in `compare_files`. Raises `Error` if a folder cannot be read.
    """
    desc, result = library.filled("ffd_compare_desc"), library.empty("ffd_folder_comparison")
    for path, structure in ((a, desc.a), (b, desc.b)):
        _place(path, structure, None, memory, strict)
    _set_tolerances(desc, tolerance, normal_tolerance)
    with _text() as text:
        with library.logged(desc):
            library.call(lib.ffd_compare_folders_json, ctypes.byref(desc), ctypes.byref(result), ctypes.byref(text))
        return json.loads(ctypes.string_at(text))


def compare_bytes(a: Any, b: Any, *, name: str, other_name: str | None = None, files: Files | None = None,
                  other_files: Files | None = None, tolerance: float | str = 0.0, normal_tolerance: float | None = None,
                  input_format: Format | None = None, memory: int | None = None, strict: bool = False) -> dict[str, Any]:
    """Like `compare_files`, for two meshes in memory.

    a, b, name, files: as in `deform_bytes`
    other_name, other_files: of b; None: the same as for a
    """
    first = Memory(a, name, files)
    second = Memory(b, name if other_name is None else other_name, files if other_files is None else other_files)
    return _compare(first, second, (first.name, second.name), tolerance, normal_tolerance, input_format=input_format,
                    memory=memory, strict=strict)
