"""How positions of meshes follow control points or placeholders, as `ffd jacobian` tells it."""

from __future__ import annotations

import ctypes
import io
import os
from typing import Any, Mapping, NamedTuple, Sequence

import numpy as np

from . import _library as library
from ._description import INPUT_OPTIONS, AnyLattice, Files, Memory, Path, described, resolved
from ._errors import Error, GateError
from ._library import lib
from ._result import beside, plain

_OPTIONS = {*INPUT_OPTIONS, "set", "outside", "falloff", "snap", "only", "threads", "isa"}


def _set_factor(desc: Any, name: str, lent: Any, value: Any) -> Any:
    """An .npy as a path, or as bytes or an array in memory; returns what must stay alive."""
    if value is None:
        return None
    if isinstance(value, (str, os.PathLike)):
        setattr(desc, name, library.path(value))
        return None
    if not isinstance(value, (bytes, bytearray, memoryview)):
        stream = io.BytesIO()
        np.save(stream, np.ascontiguousarray(value, dtype=np.float64), allow_pickle=False)
        value = stream.getvalue()
    lent.data, lent.size, kept = library.lend_bytes(value, name)
    return kept


def _figures(result: Any, check: bool) -> dict[str, Any]:
    return {name: value for name, value in plain(result).items() if name != "struct_size" and (check or name != "worst")}


def _jacobian(source: Any, output: Any, lattices: Any, taken: list[Any] | None, by: str, components: bool, of: int | None,
              times: Any, transposed: Any, check: bool, options: Mapping[str, Any]) -> dict[str, Any]:
    desc, result = library.filled("ffd_jacobian_desc"), library.empty("ffd_jacobian_result")
    desc.output, desc.by = library.path(output), library.number_of("ffd_jacobian_by", by, "by")
    desc.components, desc.check = bool(components), bool(check)
    if of is not None:
        desc.of = library.integer(of, "of")
    kept = [_set_factor(desc, "times", desc.times_bytes, times),
            _set_factor(desc, "transposed", desc.transposed_bytes, transposed)]

    warnings: list[str] = []
    try:
        with described(source, lattices, dict(options), _OPTIONS | ({"force"} if taken is None else set())) as (job, warnings), \
                resolved(source):
            if taken is not None:
                library.sink_into(job, taken)
            desc.job = ctypes.pointer(job)
            library.call(lib.ffd_jacobian_run, ctypes.byref(desc), ctypes.byref(result))
    except Error as refused:
        refused.warnings = warnings
        if isinstance(refused, GateError):
            refused.result = _figures(result, check)
        raise
    del kept
    return _figures(result, check)


def jacobian_file(source: Path, output: Path, lattices: AnyLattice | Sequence[AnyLattice], *, by: str = "points",
                  components: bool = False, of: int | None = None, times: Any = None, transposed: Any = None,
                  check: bool = False, **options: Any) -> dict[str, Any]:
    """Writes the derivative of a file's positions, as `ffd jacobian` does: by control points, u fastest, or by="parameters", the
    placeholders of their moves. Returns rows, columns, entries, vertices, moving, and with check worst.

    output: .npz (scipy.sparse.load_npz), .mtx or .npy. of: the lattice of several, from 0; None: the last
    times, transposed: multiplied instead, output an .npy: a path, or the bytes of an .npy, or an array: (n, 3) or (m,) numbers,
      of transposed (N, 3), for N vertices and n control points or m numbers of placeholders
    check: compares with central differences; above 1e-6 a `GateError`, whose result is what is returned else, and no output
    options: those of `deform_file` that positions depend on (set, outside, falloff, snap, only, space, ..), threads, isa, force
    Raises `Error`. Any number of threads may call it.
    """
    return _jacobian(source, output, lattices, None, by, components, of, times, transposed, check, options)


class JacobianBytes(NamedTuple):
    """What `jacobian_bytes` returns."""

    data: bytes  # the matrix, or the product: of io.BytesIO(data) scipy.sparse.load_npz or numpy.load reads it
    files: dict[str, bytes]  # those beside it, by their names: "jacobian.columns.txt"
    result: dict[str, Any]  # what `jacobian_file` returns


def jacobian_bytes(data: Any, lattices: AnyLattice | Sequence[AnyLattice], *, name: str, output: str = "jacobian.npz",
                   files: Files | None = None, by: str = "points", components: bool = False, of: int | None = None,
                   times: Any = None, transposed: Any = None, check: bool = False, **options: Any) -> JacobianBytes:
    """`jacobian_file` of a mesh in memory: data, name and files as `deform_bytes` takes them; reads and writes no file.

    output: the name of the result, whose ending says the format. All else as `jacobian_file`, but for force.
    """
    taken: list[Any] = []
    result = _jacobian(Memory(data, name, files), output, lattices, taken, by, components, of, times, transposed, check, options)
    return JacobianBytes(taken[-1][1], beside(taken, output), result)
