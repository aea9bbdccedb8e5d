"""The deformation of embedded points by control points that are given with the call: one set, or K variants."""

from __future__ import annotations

import ctypes
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _arrays as arrays
from . import _library as library
from ._library import Run, lib

if TYPE_CHECKING:
    from ._embedding import Embedding
    from ._lattice import Lattice


def are_many(lattice: Lattice, Q: Any, offsets: Any) -> bool:
    """Whether Q or offsets are variants, (K, nu, nv, nw, 3)."""
    return any(value is not None and np.ndim(value) == 5 for value in (Q, offsets))


def _described(lattice: Lattice, Q: Any, offsets: Any, count: int | None) -> tuple[Any, Any]:
    """The ffd_variants of Q or offsets, and what must stay alive. count: their number; None: one, without an axis for it."""
    if Q is not None and offsets is not None:
        raise ValueError("give Q or offsets, not both")
    lattice._fitted
    value, what = (Q, "Q") if Q is not None else (offsets, "offsets")
    shape = lattice.size + (3,)
    numbers = arrays.doubles(value, what, shape if count is None else (count,) + shape)
    made = library.filled("ffd_variants")
    made.count = 1 if count is None else count
    made.values, made.are_points, made.w_fastest = arrays.address(numbers), Q is not None, True
    return made, numbers


def _weigh(lattice: Lattice, made: Any, weights: Any, weight: Any, count: int) -> Any:
    """Sets the weights of control points and of points. Returns what must stay alive."""
    weights = lattice.weights if weights is None else weights
    kept = []
    if weights is not None:
        try:
            kept.append(arrays.doubles(weights, "weights", lattice.size))
        except ValueError as error:
            raise ValueError(f"{error} (of control points; weight= is of points)") from None
        made.control_weights = arrays.address(kept[-1])
    if weight is not None:
        try:
            kept.append(arrays.doubles(weight, "weight", (count,)))
        except ValueError as error:
            raise ValueError(f"{error} (of points; weights= is of control points)") from None
        made.weights = arrays.address(kept[-1]) if count else None
    return kept


def deform_one(lattice: Lattice, run: Run, embedding: Embedding, Q: Any, offsets: Any, weights: Any, points: Any, out: Any,
               weight: Any) -> np.ndarray:
    """`Lattice.deform` of points alone by one Q or offsets: no lattice is copied."""
    made, numbers = _described(lattice, Q, offsets, None)
    source, out = lattice._source_and_out(embedding, points, out, None)
    lattice._check_same(embedding)
    kept = _weigh(lattice, made, arrays.apart(weights, out), arrays.apart(weight, out), len(source))
    if arrays.overlap(out, numbers):
        numbers = numbers.copy()
        made.values = arrays.address(numbers)
    run(lib.ffd_embedding_deform_variants, embedding._pointer, ctypes.byref(made), arrays.span(source), arrays.span(out))
    del numbers, kept
    return out


def deform(lattice: Lattice, run: Run, embedding: Embedding, Q: Any, offsets: Any, weights: Any, points: Any, out: Any,
           weight: Any, triangles: Any) -> np.ndarray:
    """`Lattice.deform` by K variants: (K, N, 3)."""
    if triangles is not None:
        raise ValueError("triangles= is for normals and gradients, which variants have not")
    if Q is not None and offsets is not None:
        raise ValueError("give Q or offsets, not both")
    made, numbers = _described(lattice, Q, offsets, len(Q if Q is not None else offsets))
    source, _ = lattice._source_and_out(embedding, points, None, None)
    lattice._check_same(embedding)
    kept = _weigh(lattice, made, arrays.apart(weights, out), arrays.apart(weight, out), len(source))
    shape = (made.count, len(source), 3)
    given = np.empty(shape, source.dtype) if out is None else arrays.outputs(out, "out", shape)
    if out is not None and (arrays.overlap(given, source) or arrays.overlap(given, embedding.points)):
        raise ValueError("out is memory of the points, from which all variants start")
    if out is not None and arrays.overlap(given, numbers):
        raise ValueError(f"out is memory of {'Q' if Q is not None else 'offsets'}")
    rows = arrays.rows_span(given)
    result = given if rows is not None else np.empty(shape, given.dtype)
    run(lib.ffd_embedding_deform_variants, embedding._pointer, ctypes.byref(made), arrays.span(source),
        arrays.rows_span(result))
    if result is not given:
        given[...] = result
    del kept
    return given
