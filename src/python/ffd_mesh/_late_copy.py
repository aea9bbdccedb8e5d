"""Copies of lattices with other control points or weights, made when they are first used."""

from __future__ import annotations

import ctypes
from typing import Any, NamedTuple, Sequence, cast

import numpy as np

from . import _arrays as arrays
from ._library import Owned, call, lib

_SAFE = 1e100  # control points and offsets up to this size cannot be refused


class Edit(NamedTuple):
    """What is set in a copy. function: of the library; numbers: a copy of the caller's, (nu, nv, nw, ..)."""

    function: Any
    numbers: np.ndarray


class LateCopy:
    """A lattice of the library, as `Owned` is, that is made when its address is first asked for. Threads may share it."""

    _pending: tuple[Any, int, Sequence[Edit]] | None
    _made: Owned

    def __init__(self, of: Any, count: int, edits: Sequence[Edit]) -> None:
        """of: an Owned or a LateCopy, with so many control points. What the library may refuse is set now, and raises what it
        does."""
        self._pending = of, count, edits
        if not all(_cannot_be_refused(edit) for edit in edits):
            self.pointer

    @property
    def pointer(self) -> ctypes.c_void_p:
        """The address of the lattice."""
        pending = self._pending  # before _made, which is there when this is gone
        made: Owned | None = self.__dict__.get("_made")
        if made is None:
            # Of several threads the first one's copy stays: setdefault is atomic.
            made = self.__dict__.setdefault("_made", _copied(*cast(Any, pending)))
            self._pending = None
        return cast(Owned, made).pointer


def _cannot_be_refused(edit: Edit) -> bool:
    numbers = edit.numbers
    return edit.function is not lib.ffd_lattice_set_weights and bool(-_SAFE < numbers.min() and numbers.max() < _SAFE)  # not of a NaN


def _copied(of: Any, count: int, edits: Sequence[Edit]) -> Owned:
    made = Owned(lib.ffd_lattice_destroy)
    call(lib.ffd_lattice_copy, of.pointer, ctypes.byref(made.pointer))
    for function, numbers in edits:
        values = arrays.to_library(numbers)
        call(function, made.pointer, None, count, arrays.address(values))
    return made
