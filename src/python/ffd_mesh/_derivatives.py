"""Derivatives of embedded points by the placeholders of a lattice file, and by the weights of the deformed volume."""

from __future__ import annotations

import copy
import ctypes
from typing import TYPE_CHECKING, Any, Mapping, NamedTuple

import numpy as np

from . import _arrays as arrays
from . import _library as library
from ._errors import InvalidError
from ._library import Owned, Run, call, lib
from ._values import settings

if TYPE_CHECKING:
    from ._embedding import Embedding
    from ._lattice import Lattice


class Source(NamedTuple):
    """The text of a lattice file with placeholders, its name, and the values that they were given."""

    data: bytes
    name: str
    values: dict[str, Any]


def source_of(data: bytes, name: str, values: Mapping[str, Any] | None = None) -> Source | None:
    """What derivatives by placeholders need; None: the text has none."""
    return Source(data, name, copy.deepcopy(dict(values or {}))) if b'"$"' in data or b"\\u0024" in data else None


class _Variables(NamedTuple):
    """The lattice with what derivatives by its placeholders need. owned: it, as the library has it; None: there are none."""

    owned: Owned | None
    names: tuple[str, ...]


def _name(lattice: Owned, column: int) -> str:
    found = ctypes.c_void_p()
    call(lib.ffd_lattice_get_column, lattice.pointer, column, ctypes.byref(found))
    try:
        return ctypes.string_at(found.value or 0).decode()
    finally:
        lib.ffd_free(found)


def _variables(lattice: Lattice, values: Mapping[str, Any] | None) -> _Variables:
    """Reads the lattice's text again, with values in place of those that it was loaded with."""
    source = lattice._source
    if source is not None and lattice._is_edited:
        raise InvalidError("control points or weights of the lattice were set: they do not follow its placeholders")
    settings(values)  # refuses what is no dict
    given = dict(values or {})
    if source is None:
        if given:
            raise ValueError(f"the lattice has no placeholder {', '.join(map(repr, given))}")
        return _Variables(None, ())
    made, count = settings(source.values | given)
    used, owned = (ctypes.c_bool * count)(), Owned(lib.ffd_lattice_destroy)
    call(lib.ffd_lattice_parse_set, source.data, len(source.data), library.encoded(source.name, "name"), made, count, used,
         ctypes.byref(owned.pointer))
    unused = [name for name, is_used in zip(source.values | given, used) if not is_used]
    if unused:
        raise ValueError(f"the lattice has no placeholder {', '.join(map(repr, unused))}")
    if lattice._bounds is not None:
        call(lib.ffd_lattice_fit, owned.pointer, arrays.address(lattice._bounds[0]), arrays.address(lattice._bounds[1]))
    if lattice._time is not None:
        call(lib.ffd_lattice_set_time, owned.pointer, ctypes.c_double(lattice._time))
    return _Variables(owned, tuple(_name(owned, column) for column in range(lib.ffd_lattice_get_column_count(owned.pointer))))


def columns(lattice: Lattice) -> tuple[str, ...]:
    """The names of the columns of `Lattice.parameters_jacobian`."""
    return _variables(lattice, None).names


def parameters_jacobian(lattice: Lattice, run: Run, embedding: Embedding, values: Mapping[str, Any] | None) -> np.ndarray:
    """`Lattice.parameters_jacobian`."""
    lattice._check_same(embedding)
    variables = _variables(lattice, values)
    out = np.empty((len(embedding), 3, len(variables.names)))
    if variables.owned is not None:
        run(lib.ffd_embedding_parameters, embedding._pointer, variables.owned.pointer, arrays.address(out))
    return out


def parameters_times(lattice: Lattice, run: Run, embedding: Embedding, dp: Any, values: Mapping[str, Any] | None) -> np.ndarray:
    """`Lattice.parameters_times`."""
    lattice._check_same(embedding)
    variables = _variables(lattice, values)
    numbers = arrays.doubles(dp, "dp", (len(variables.names),))
    out = np.zeros((len(embedding), 3))
    if variables.owned is not None:
        run(lib.ffd_embedding_parameters_times, embedding._pointer, variables.owned.pointer, arrays.address(numbers),
            arrays.address(out))
    return out


def parameters_transposed(lattice: Lattice, run: Run, embedding: Embedding, g: Any,
                          values: Mapping[str, Any] | None) -> np.ndarray:
    """`Lattice.parameters_transposed`."""
    lattice._check_same(embedding)
    numbers = arrays.doubles(g, "g", (len(embedding), 3))
    variables = _variables(lattice, values)
    out = np.zeros(len(variables.names))
    if variables.owned is not None:
        run(lib.ffd_embedding_parameters_transposed, embedding._pointer, variables.owned.pointer, arrays.address(numbers),
            arrays.address(out))
    return out


def weights_jacobian(lattice: Lattice, run: Run, embedding: Embedding) -> np.ndarray:
    """`Lattice.weights_jacobian`."""
    lattice._check_same(embedding)
    out = np.empty((len(embedding), 3, lattice._count))
    run(lib.ffd_embedding_weights, embedding._pointer, lattice._fitted, True, arrays.address(out))
    return out


def weights_times(lattice: Lattice, run: Run, embedding: Embedding, dw: Any) -> np.ndarray:
    """`Lattice.weights_times`."""
    lattice._check_same(embedding)
    one_axis = np.ndim(dw) == 1
    numbers = arrays.doubles(dw, "dw", (lattice._count,) if one_axis else lattice.size).reshape(lattice.size)
    numbers = arrays.to_library(numbers)
    out = np.empty((len(embedding), 3))
    run(lib.ffd_embedding_weights_times, embedding._pointer, lattice._fitted, arrays.address(numbers), arrays.address(out))
    return out


def weights_transposed(lattice: Lattice, run: Run, embedding: Embedding, g: Any) -> np.ndarray:
    """`Lattice.weights_transposed`."""
    lattice._check_same(embedding)
    numbers = arrays.doubles(g, "g", (len(embedding), 3))
    out = np.empty(lattice.size[::-1])
    run(lib.ffd_embedding_weights_transposed, embedding._pointer, lattice._fitted, arrays.address(numbers), arrays.address(out))
    return np.ascontiguousarray(out.transpose(2, 1, 0))
