"""Derivatives of a mesh's positions by control points or placeholders, as `ffd jacobian` computes them."""

from __future__ import annotations

import ctypes
import io
import os
from typing import Any, Mapping, NamedTuple, Sequence, Union, Unpack

import numpy as np

from . import _library as library
from ._description import AnyLattice, Files, Memory, Path, described, resolved
from ._errors import Error, GateError
from ._library import lib
from ._result import beside, plain
from ._types import JacobianFileOptions, JacobianOptions, Row, Rows, Wrt, names

_OWN = ("wrt", "by", "components", "of", "times", "transposed", "check")
Factor = Union[Path, bytes, Row, Rows]


def _set_factor(desc: Any, name: str, lent: Any, value: Any) -> Any:
    """Sets a factor of a product: the path or bytes of an .npy, or an array. Returns the object that must stay alive."""
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


def _columns(wrt: str | None, by: str | None) -> int:
    """What the columns are of."""
    if wrt is not None and by is not None:
        raise ValueError("wrt= and by= are the same: give one of them")
    word, what = (wrt, "wrt") if by is None else (by, "by")
    return library.value_of("ffd_jacobian_by", "points" if word is None else word, what)


def _jacobian(source: Any, output: Any, lattices: Any, taken: list[Any] | None, wrt: str | None, by: str | None, components: bool, of: int | None,
              times: Any, transposed: Any, check: bool, options: Mapping[str, Any]) -> dict[str, Any]:
    known = names(JacobianFileOptions if taken is None else JacobianOptions)
    own = _OWN if taken is None else (*_OWN, "name", "output", "files")
    desc, result = library.filled("ffd_jacobian_desc"), library.empty("ffd_jacobian_result")
    desc.output, desc.by = library.path(output), _columns(wrt, by)
    desc.components, desc.check = bool(components), bool(check)
    if of is not None:
        desc.of = library.integer(of, "of")
    kept = [_set_factor(desc, "times", desc.times_bytes, times),
            _set_factor(desc, "transposed", desc.transposed_bytes, transposed)]

    warnings: list[str] = []
    try:
        with described(source, lattices, options, known, own=own) as (job, warnings), \
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


def jacobian_file(source: Path, output: Path, lattices: AnyLattice | Sequence[AnyLattice], *, wrt: Wrt | None = None,
                  by: Wrt | None = None, components: bool = False, of: int | None = None, times: Factor | None = None,
                  transposed: Factor | None = None, check: bool = False, **options: Unpack[JacobianFileOptions]) -> dict[str, Any]:
    """Writes the derivative of the deformed positions of a mesh file, as `ffd jacobian` does.

    Returns a dict with rows, columns, entries, vertices, moving and, with check, worst.

    wrt: "points" (the default): by the control points, u fastest; "parameters": by the numbers of the placeholders in moves
    by: the same as wrt
    output: path of an .npz (scipy.sparse.load_npz), .mtx or .npy file
    components: True: three rows for each vertex, also by points
    of: with several lattices, the number of the one whose control points count, from 0; None: the last
    times, transposed: write the product of the matrix, or of its transpose, with these numbers to output, an .npy. A path, the
      bytes of an .npy, or an array. For N vertices, n control points and m numbers of placeholders: times is (n, 3) or (m,),
      transposed is (N, 3)
    check: compare with central differences. An error above 1e-6 raises `GateError`, whose result is the dict; there is no output
    options: those of `deform_file` that positions depend on (set, outside, falloff, seam, snap, only, space, ..), threads, isa, force
    Raises `Error`. Threads may call it at the same time.
    """
    return _jacobian(source, output, lattices, None, wrt, by, components, of, times, transposed, check, options)


class JacobianBytes(NamedTuple):
    """What `jacobian_bytes` returns."""

    data: bytes  # the matrix or product: pass io.BytesIO(data) to scipy.sparse.load_npz or numpy.load
    files: dict[str, bytes]  # further files by name, such as "jacobian.columns.txt"
    result: dict[str, Any]  # as `jacobian_file` returns it


def jacobian_bytes(data: Any, lattices: AnyLattice | Sequence[AnyLattice], *, name: str, output: str = "jacobian.npz",
                   files: Files | None = None, wrt: Wrt | None = None, by: Wrt | None = None, components: bool = False,
                   of: int | None = None, times: Factor | None = None, transposed: Factor | None = None, check: bool = False,
                   **options: Unpack[JacobianOptions]) -> JacobianBytes:
    """Like `jacobian_file`, for a mesh in memory; reads and writes no files.

    data, name, files: as in `deform_bytes`
    output: name of the result; its ending determines the format
    All other arguments are those of `jacobian_file`, except force.
    """
    taken: list[Any] = []
    result = _jacobian(Memory(data, name, files), output, lattices, taken, wrt, by, components, of, times, transposed, check, options)
    return JacobianBytes(taken[-1][1], beside(taken, output), result)
