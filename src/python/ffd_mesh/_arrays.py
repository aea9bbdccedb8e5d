"""Arrays between numpy and the library."""

from __future__ import annotations

from typing import Any

import numpy as np

from ._declarations import ENUMERATIONS, ffd_span

_NUMBERS = {np.dtype(np.float64): ENUMERATIONS["ffd_number"]["FFD_FLOAT64"],
            np.dtype(np.float32): ENUMERATIONS["ffd_number"]["FFD_FLOAT32"]}


def numbers(value: Any, what: str) -> np.ndarray:
    """Checks that value holds real numbers of any type and byte order. Returns an array, uncopied if it is one."""
    array = value if isinstance(value, np.ndarray) else np.asarray(value)
    if isinstance(array, np.ma.MaskedArray):
        raise TypeError(f"{what} must not be a masked array: its mask would be ignored")
    if array.dtype.kind not in "fiu":
        raise TypeError(f"{what} must hold real numbers, not {array.dtype}")
    return array


def vectors(value: Any, what: str, count: int | None = None, width: int = 3) -> np.ndarray:
    """Checks that value is an array (N, 3), or of another width, of real numbers, with any strides. Returns float32 and float64 in the machine's byte order
    uncopied. Floats of at most 32 bits become float32, all other numbers float64."""
    array = numbers(value, what)
    if array.dtype not in _NUMBERS:
        narrow = array.dtype.kind == "f" and array.dtype.itemsize <= 4
        array = array.astype(np.float32 if narrow else np.float64)
    if array.ndim != 2 or array.shape[1] != width:
        raise ValueError(f"{what} must have the shape (N, {width}), not {array.shape}")
    if count is not None and len(array) != count:
        raise ValueError(f"{what} must have {count} rows, not {len(array)}")
    return array


def output(value: Any, what: str, count: int, width: int = 3) -> np.ndarray:
    """Checks that value is an array (count, 3), or of another width, that results can be written to."""
    if not isinstance(value, np.ndarray):
        raise TypeError(f"{what} must be an array of numpy, not {type(value).__name__}")
    if value.dtype not in _NUMBERS:
        raise TypeError(f"{what} must be float32 or float64 in the machine's byte order, not {value.dtype}")
    array = vectors(value, what, count, width)
    if not array.flags.writeable:
        raise ValueError(f"{what} is read-only")
    if _repeats(array):
        raise ValueError(f"{what} has rows or columns that share their memory")
    return array


def outputs(value: Any, what: str, shape: tuple[int, int, int]) -> np.ndarray:
    """Checks that value is an array of this shape, (K, N, 3) or (K, N, 2), that results can be written to."""
    if not isinstance(value, np.ndarray):
        raise TypeError(f"{what} must be an array of numpy, not {type(value).__name__}")
    if isinstance(value, np.ma.MaskedArray):
        raise TypeError(f"{what} must not be a masked array: its mask would be ignored")
    if value.dtype not in _NUMBERS:
        raise TypeError(f"{what} must be float32 or float64 in the machine's byte order, not {value.dtype}")
    if value.shape != shape:
        raise ValueError(f"{what} must have the shape {shape}, not {value.shape}")
    if not value.flags.writeable:
        raise ValueError(f"{what} is read-only")
    if _repeats(value):
        raise ValueError(f"{what} has elements that share their memory")
    return value


def rows_span(array: np.ndarray) -> ffd_span | None:
    """An ffd_span of all rows of a (K, N, 3) array, which must outlive it; None: they are not evenly spaced."""
    variants, count, _ = array.shape
    if array.size == 0:
        return ffd_span(None, variants * count, _NUMBERS[array.dtype], 0, 0)
    if count > 1 and variants > 1 and array.strides[0] != count * array.strides[1]:
        return None
    stride = array.strides[1] if count > 1 else array.strides[0]
    return ffd_span(address(array), variants * count, _NUMBERS[array.dtype], stride, array.strides[2])


def _repeats(array: np.ndarray) -> bool:
    """Whether elements of an array share memory because of its strides, so that they must not be written in parallel.
    Strides that merely interleave elements count too; slices do not have such strides."""
    reach = array.itemsize
    for stride, count in sorted((abs(stride), count) for stride, count in zip(array.strides, array.shape) if count > 1):
        if array.size and stride < reach:
            return True
        reach += stride * (count - 1)
    return False


def overlap(a: np.ndarray, b: np.ndarray) -> bool:
    """Whether two arrays share memory; True also if that would take too long to find out."""
    if not np.may_share_memory(a, b):
        return False
    try:
        return np.shares_memory(a, b, max_work=100_000)  # type: ignore[arg-type]
    except np.exceptions.TooHardError:
        return True


def same_place(a: np.ndarray, b: np.ndarray) -> bool:
    """Whether two arrays of equal shape are the same memory with the same layout."""
    return (a.dtype == b.dtype and a.strides == b.strides
            and a.__array_interface__["data"][0] == b.__array_interface__["data"][0])


def readable(array: np.ndarray) -> np.ndarray:
    """Returns the array, or a copy if its elements share memory (numpy.broadcast_to)."""
    return array.copy() if _repeats(array) else array


def kept(array: np.ndarray) -> np.ndarray:
    """A read-only view of an array, whose shape stays though that of the array is changed in place."""
    view = array.view()
    view.flags.writeable = False
    return view


def apart(value: Any, out: np.ndarray | None) -> Any:
    """Returns value, or a copy if out, which is written first, shares its memory."""
    return value.copy() if out is not None and isinstance(value, np.ndarray) and overlap(value, out) else value


def source_and_out(embedded: np.ndarray, points: Any, out: Any, vertices: Any) -> tuple[np.ndarray, np.ndarray]:
    """Returns the points at rest, and the array for the results, after checks. embedded: the points of the embedding."""
    count = len(embedded)
    source = embedded if points is None else readable(vectors(points, "points", count))
    if out is None:
        return source, np.empty((count, 3), source.dtype) if vertices is None else np.array(source)
    out = output(out, "out", count)
    if overlap(out, embedded):
        raise ValueError("out is memory of the points that were embedded, which a later call starts from: embed a copy")
    if points is not None and not same_place(source, out) and overlap(source, out):
        raise ValueError("out and points overlap and are not the same array")
    return source, out


def span(array: np.ndarray) -> ffd_span:
    """An ffd_span of an (N, 3) array, which must outlive it."""
    if array.size == 0:
        return ffd_span(None, 0, _NUMBERS[array.dtype], 0, 0)
    return ffd_span(address(array), len(array), _NUMBERS[array.dtype], array.strides[0], array.strides[1])


def address(array: np.ndarray) -> int:
    return array.__array_interface__["data"][0]


def doubles(value: Any, what: str, shape: tuple[int, ...]) -> np.ndarray:
    """Returns value as contiguous float64 of this shape, in C order; copied only if necessary."""
    array = numbers(value, what)
    if array.shape != shape:
        raise ValueError(f"{what} must have the shape {shape}, not {array.shape}")
    return np.ascontiguousarray(array, dtype=np.float64)


def copied(value: Any, what: str, shape: tuple[int, ...]) -> np.ndarray:
    """Returns a copy of value as float64 of this shape, laid out as value is."""
    array = numbers(value, what)
    if array.shape != shape:
        raise ValueError(f"{what} must have the shape {shape}, not {array.shape}")
    return np.array(array, dtype=np.float64, order="K")


def to_library(array: np.ndarray) -> np.ndarray:
    """Copies (nu, nv, nw, ...) from Python's order, w fastest, to that of the library and of files, u fastest."""
    return np.ascontiguousarray(array.transpose(2, 1, 0, *range(3, array.ndim)))


class _Lent:
    """Memory of a library object. An array made from this keeps the owner alive."""

    def __init__(self, owner: Any, where: int, shape: tuple[int, ...], kind: str, writable: bool) -> None:
        self._owner = owner
        self.__array_interface__ = {"data": (where, not writable), "shape": shape, "typestr": kind, "version": 3}


def lent(owner: Any, where: int | None, shape: tuple[int, ...], dtype: Any, writable: bool = False) -> np.ndarray:
    """An array, read-only unless it is to be writable, of memory that owner keeps alive. where: its address; None: an empty array."""
    if not where or 0 in shape:
        return np.empty(shape, dtype)
    return np.asarray(_Lent(owner, where, shape, np.dtype(dtype).str, writable))


def lent_controls(owner: Any, where: int | None, size: tuple[int, int, int], *more: int) -> np.ndarray:
    """A view (nu, nv, nw, ...) of control point data of the library, which has u fastest."""
    array = lent(owner, where, size[::-1] + more, np.float64)
    return array.transpose(2, 1, 0, *range(3, array.ndim))
