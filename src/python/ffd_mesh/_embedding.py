"""Embeddings: the parameters u, v, w of points in a lattice at rest."""

from __future__ import annotations

import ctypes
import enum
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from . import _arrays as arrays
from . import _library as library
from ._library import Owned, call, lib
from ._types import Doubles, Floats, Outside, Rows, Triangles

if TYPE_CHECKING:
    from ._lattice import Lattice


class Status(enum.IntEnum):
    """The status of an embedded point: the values in `Embedding.status`."""

    INSIDE = 0
    OUTSIDE = 1
    MULTIPLE = 2
    SINGULAR = 3
    INVALID = 4


class EmbeddingOptions(NamedTuple):
    """The options of `Lattice.embed` that its result depends on, as they were given."""

    outside: Outside
    falloff: float
    snap: float


class Embedding:
    """u, v, w and statuses of N points, made by `Lattice.embed`. Immutable, so threads may share it. Can be pickled."""

    _lattice: Lattice
    _points: Floats
    _owned: Owned
    _options: EmbeddingOptions | None  # None: not known

    def __init__(self) -> None:
        raise TypeError("use Lattice.embed")

    @classmethod
    def _of(cls, owned: Owned, lattice: Lattice, points: np.ndarray, options: EmbeddingOptions | None = None) -> Embedding:
        self = cls.__new__(cls)
        self._owned, self._lattice, self._points, self._options = owned, lattice, arrays.kept(points), options
        return self

    def __len__(self) -> int:
        return len(self._points)

    @property
    def lattice(self) -> Lattice:
        """The lattice in which the points are."""
        return self._lattice

    @property
    def points(self) -> Floats:
        """The points, (N, 3): a read-only view of the array that was embedded, or of its copy where one was made."""
        return self._points

    @property
    def uvw(self) -> Doubles:
        """u, v, w: (N, 3) float64, in the range of the knots; NaN for points without. A read-only view."""
        return arrays.lent(self._owned, lib.ffd_embedding_get_uvw(self._pointer), (len(self), 3), np.float64)

    @property
    def status(self) -> NDArray[np.uint8]:
        """(N,) uint8, values of `Status`. A read-only view."""
        return arrays.lent(self._owned, lib.ffd_embedding_get_status(self._pointer), (len(self),), np.uint8)

    @property
    def counts(self) -> dict[Status, int]:
        """The number of points of each status."""
        counts = np.bincount(self.status, minlength=len(Status))
        return {status: int(counts[status]) for status in Status}

    def affected(self, control_points: Triangles | NDArray[np.bool_]) -> NDArray[np.uint32]:
        """The indices of the points that these control points act on: uint32, ascending. No other point depends on them.

        control_points: (M, 3) integers i, j, k, or a bool mask (nu, nv, nw)
        """
        size = self.lattice.size
        chosen = np.asarray(control_points)
        if chosen.dtype == bool and chosen.shape == size:
            chosen = np.argwhere(chosen)
        if chosen.ndim != 2 or chosen.shape[1] != 3 or chosen.dtype.kind not in "iu":
            raise ValueError(f"control_points must be integers (M, 3) or a mask {size}")
        if chosen.size and ((chosen < 0) | (chosen >= size)).any():
            raise ValueError(f"control_points must be below {size}")
        numbers = (chosen @ [1, size[0], size[0] * size[1]]).astype(np.uintp)
        found, count = ctypes.c_void_p(), ctypes.c_size_t()
        call(lib.ffd_embedding_affected, self._pointer, arrays.address(numbers), len(numbers), ctypes.byref(found),
             ctypes.byref(count))
        return np.frombuffer(library.take_bytes(found, 4 * count.value), np.uint32).copy()

    def to_bytes(self) -> bytes:
        """Serializes u, v, w and statuses for `from_bytes`, of the same version of the library on the same kind of machine."""
        data, size = ctypes.c_void_p(), ctypes.c_size_t()
        call(lib.ffd_embedding_save, self._pointer, ctypes.byref(data), ctypes.byref(size))
        return library.take_bytes(data, size.value)

    @classmethod
    def from_bytes(cls, data: bytes, lattice: Lattice, points: Rows) -> Embedding:
        """Restores an embedding from `to_bytes`. points: the embedded points (N, 3). lattice: must have the same rest volume."""
        owned = Owned(lib.ffd_embedding_destroy)
        data = bytes(data)
        call(lib.ffd_embedding_load, data, len(data), lattice._fitted, ctypes.byref(owned.pointer))
        count = lib.ffd_embedding_get_count(owned.pointer)
        return cls._of(owned, lattice, arrays.readable(arrays.vectors(points, "points", count)))

    def __repr__(self) -> str:
        counted = ", ".join(f"{count} {status.name.lower()}" for status, count in self.counts.items() if count)
        return f"<Embedding of {len(self)} points: {counted or 'none'}>"

    def __copy__(self) -> Embedding:
        return self

    def __deepcopy__(self, memo: Any) -> Embedding:
        return self

    def __reduce__(self) -> Any:
        return _again, (self.to_bytes(), self.lattice, self.points, self._options)

    @property
    def _pointer(self) -> ctypes.c_void_p:
        return self._owned.pointer


def _again(data: bytes, lattice: Lattice, points: np.ndarray, options: EmbeddingOptions | None) -> Embedding:
    """Restores a pickled embedding."""
    embedding = Embedding.from_bytes(data, lattice, points)
    embedding._options = options
    return embedding
