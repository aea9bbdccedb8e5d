"""Lattices of a plane: points (N, 2) and control points (n, m, 2), through a 3-D lattice of two layers that move alike."""

from __future__ import annotations

import dataclasses
import math
from typing import TYPE_CHECKING, Any, Literal, Mapping, Sequence, overload

import numpy as np
from numpy.typing import NDArray

from . import _arrays as arrays
from . import _library as library
from ._embedding import Embedding, Status
from ._lattice import Lattice
from ._library import Progress
from ._types import (ControlPoints, Counts, Degrees, Doubles, Floats, Grid, Indices, Isa, Knots, Numbers, Outside, Part, Path, Row, Rows, Sparse,
                     Triangles, Volume)
from ._values import Deformed, FoldBarrier, Folds, has_breakpoints, pair, sparse

PlaneDirection = Literal["u", "v"]
PlaneHalf = Literal["u-", "u+", "v-", "v+"]
# Along w, where a fold barrier counts each coefficient of the determinant so often: 3 times the degree.
_COUNTED = 3


def raised(points: np.ndarray) -> np.ndarray:
    """Vectors (..., 2) as (..., 3) in the plane z = 0."""
    found = np.zeros(points.shape[:-1] + (3,), points.dtype)
    found[..., :2] = points
    return found


class PlaneEmbedding:
    """u, v and statuses of N points of a plane, made by `PlaneLattice.embed`. It has a copy of the points. Immutable, so threads may
    share it. Can be pickled."""

    lattice: PlaneLattice
    _solid: Embedding

    def __init__(self) -> None:
        raise TypeError("use PlaneLattice.embed")

    @classmethod
    def _of(cls, lattice: PlaneLattice, solid: Embedding) -> PlaneEmbedding:
        self = cls.__new__(cls)
        self.lattice, self._solid = lattice, solid
        return self

    def __len__(self) -> int:
        return len(self._solid)

    @property
    def points(self) -> Floats:
        """The points, (N, 2)."""
        return self._solid.points[:, :2]

    @property
    def uvw(self) -> Doubles:
        """u, v: (N, 2) float64, in the range of the knots; NaN for points without. A read-only view."""
        return self._solid.uvw[:, :2]

    @property
    def status(self) -> NDArray[np.uint8]:
        """(N,) uint8, values of `Status`. A read-only view."""
        return self._solid.status

    @property
    def counts(self) -> dict[Status, int]:
        """The number of points of each status."""
        return self._solid.counts

    def affected(self, control_points: Indices | Triangles | NDArray[np.bool_]) -> NDArray[np.uint32]:
        """The indices of the points that these control points act on: uint32, ascending. No other point depends on them.

        control_points: (M, 2) integers i, j, or a bool mask (n, m)
        """
        chosen = np.asarray(control_points)
        size = self.lattice.size
        if chosen.dtype == bool and chosen.shape == size:
            chosen = np.argwhere(chosen)
        if chosen.ndim != 2 or chosen.shape[1] != 2 or chosen.dtype.kind not in "iu":
            raise ValueError(f"control_points must be integers (M, 2) or a mask {size}")
        return self._solid.affected(np.column_stack([chosen, np.zeros(len(chosen), chosen.dtype)]))

    def __repr__(self) -> str:
        return repr(self._solid).replace("<Embedding", "<PlaneEmbedding")

    def __copy__(self) -> PlaneEmbedding:
        return self

    def __deepcopy__(self, memo: Any) -> PlaneEmbedding:
        return self

    def __reduce__(self) -> Any:
        return PlaneEmbedding._of, (self.lattice, self._solid)


class PlaneLattice:
    """A control lattice of a plane: n x m control points (n, m, 2) that deform points (N, 2). Made by `Lattice.plane`.

    It does what a `Lattice` does, with two coordinates in place of three. Inside it is a lattice with two layers along w, at the same
    distance from the plane z = 0, which move alike: `solid`. Its text and its files are those of this lattice, so that `ffd deform`
    takes them for meshes at z = 0; `PlaneLattice.of` makes a plane of such a lattice. Immutable, so threads may share it. Can be pickled,
    and stays a plane then.
    """

    solid: Lattice

    def __init__(self) -> None:
        raise TypeError("use Lattice.plane or PlaneLattice.of")

    @classmethod
    def _of(cls, solid: Lattice) -> PlaneLattice:
        self = cls.__new__(cls)
        self.solid = solid
        return self

    @classmethod
    def of(cls, solid: Lattice) -> PlaneLattice:
        """Makes a plane of a lattice with two layers along w that differ in z alone, at rest and deformed."""
        if not isinstance(solid, Lattice):
            raise TypeError(f"a plane is made of a Lattice, not of {type(solid).__name__}")
        alike = solid.size[2] == 2 and solid.degree[2] == 1
        for points in (solid.rest, solid.deformed, solid.offsets):
            alike = alike and np.array_equal(points[:, :, 0, :2], points[:, :, 1, :2])
        if not alike or (solid.offsets[..., 2] != 0).any() or not (solid.rest[:, :, :, 2] == solid.rest[0, 0, :, 2]).all() \
                or any(not np.array_equal(w[:, :, 0], w[:, :, 1]) for w in (solid.rest_weights, solid.weights) if w is not None) \
                or solid.rest[0, 0, 0, 2] != -solid.rest[0, 0, 1, 2]:
            raise ValueError("a plane needs two layers along w, at the same distance from z = 0, that are alike in x and y and do not move along z")
        return cls._of(solid)

    @classmethod
    def _box(cls, low: Row, high: Row, size: Counts, degree: Degrees, knots: Knots) -> PlaneLattice:
        """What `Lattice.plane` returns."""
        lowest, highest = arrays.doubles(low, "low", (2,)), arrays.doubles(high, "high", (2,))
        side = float((highest - lowest).max())
        # A power of two, so that w is 1/2 in the plane, to the bit.
        half = math.ldexp(1.0, max(-500, min(math.frexp(side)[1], 500)) - 2) if 0 < side < math.inf else 1.0
        sizes, degrees = [library.integer(value, "size", 2, 2**62) for value in pair(size, "size")], pair(degree, "degree")
        kinds: Any = (knots, knots) if isinstance(knots, str) or has_breakpoints(knots) else pair(knots, "knots")
        return cls._of(Lattice.box([*lowest, -half], [*highest, half], [*sizes, 2], [*degrees, 1], knots=[*kinds, "clamped"]))

    # -- properties

    @property
    def size(self) -> tuple[int, int]:
        """The number of control points along u and v: (n, m)."""
        return self.solid.size[:2]

    @property
    def degree(self) -> tuple[int, int]:
        """The degrees along u and v."""
        return self.solid.degree[:2]

    @property
    def knots(self) -> tuple[Doubles, Doubles]:
        """The knot vectors of u and v: read-only views, float64."""
        return self.solid.knots[:2]

    @property
    def domain(self) -> Doubles:
        """The domain: (2, 2), the least and the greatest u, v."""
        return self.solid.domain[:, :2]

    @property
    def rest(self) -> Doubles:
        """The control points at rest, (n, m, 2) float64: a read-only view."""
        return self.solid.rest[:, :, 0, :2]

    @property
    def deformed(self) -> Doubles:
        """The deformed control points: a view like `rest`."""
        return self.solid.deformed[:, :, 0, :2]

    @property
    def offsets(self) -> Doubles:
        """The displacements of the control points from rest: a view like `rest`."""
        return self.solid.offsets[:, :, 0, :2]

    @property
    def rest_weights(self) -> Doubles | None:
        """The weights at rest, (n, m) float64: a read-only view; None: all are 1."""
        weights = self.solid.rest_weights
        return None if weights is None else weights[:, :, 0]

    @property
    def weights(self) -> Doubles | None:
        """The deformed weights: a view like `rest_weights`."""
        weights = self.solid.weights
        return None if weights is None else weights[:, :, 0]

    @property
    def text(self) -> str:
        """The text of the lattice file of `solid`."""
        return self.solid.text

    def save(self, path: Path, *, force: bool = False, part: Part | None = None) -> None:
        """Writes the lattice file of `solid`, as `Lattice.save`: `Lattice.load` reads it as a `Lattice`, of which `PlaneLattice.of` makes
        a plane."""
        self.solid.save(path, force=force, part=part)

    # -- modified copies

    def refine(self, size: Counts | None = None, degree: Degrees = None, *, insert: Mapping[PlaneDirection, Row] | None = None) -> PlaneLattice:
        """`Lattice.refine`, with one value or two."""
        _directions(insert or {}, "insert")
        sizes = None if size is None else [*pair(size, "size"), None]
        degrees = None if degree is None else [*pair(degree, "degree"), None]
        return self._of(self.solid.refine(sizes, degrees, insert=insert))  # type: ignore[arg-type]

    def strength(self, strength: float) -> PlaneLattice:
        """`Lattice.strength`."""
        return self._of(self.solid.strength(strength))

    def blend(self, other: PlaneLattice, t: float) -> PlaneLattice:
        """`Lattice.blend`."""
        return self._of(self.solid.blend(_plane(other).solid, t))

    def add(self, other: PlaneLattice) -> PlaneLattice:
        """`Lattice.add`."""
        return self._of(self.solid.add(_plane(other).solid))

    def mirror(self, direction: PlaneDirection) -> PlaneLattice:
        """`Lattice.mirror` across the middle of u or v."""
        _directions([direction], "a direction of a plane")
        return self._of(self.solid.mirror(direction))

    def mirrored(self, axis: Literal["x", "y"], at: float = 0.0) -> PlaneLattice:
        """`Lattice.mirrored`: reflected in the line where x or y is `at`."""
        if axis not in ("x", "y"):
            raise ValueError(f"axis must be 'x' or 'y' in a plane, not {axis!r}")
        return self._of(self.solid.mirrored(axis, at))

    def symmetrize(self, half: PlaneHalf) -> PlaneLattice:
        """`Lattice.symmetrize`, with "u+", "u-", "v+" or "v-"."""
        if half not in ("u-", "u+", "v-", "v+"):
            raise ValueError(f"the half that stays is u+, u-, v+ or v- in a plane, not {half!r}")
        return self._of(self.solid.symmetrize(half))

    def transform(self, matrix: Rows) -> PlaneLattice:
        """`Lattice.transform` by an affine map of the plane, (3, 3) with a last row 0 0 1."""
        given = arrays.doubles(matrix, "matrix", (3, 3))
        if (given[2] != (0, 0, 1)).any():
            raise ValueError(f"the last row of the matrix is {given[2].tolist()}, not 0 0 1")
        whole = np.eye(4)
        whole[:2, :2], whole[:2, 3] = given[:2, :2], given[:2, 2]
        return self._of(self.solid.transform(whole))

    def jitter(self, sigma: Numbers, seed: int) -> PlaneLattice:
        """`Lattice.jitter`: noise along x and y, that of the lower layer of `solid`. sigma: one, or two."""
        noisy = self.solid.jitter([*pair(sigma, "sigma"), 0.0], seed)
        return self.moved(offsets=noisy.offsets[:, :, 0, :2])

    def seal(self, continuity: str, faces: str | Sequence[PlaneHalf] = "all") -> PlaneLattice:
        """`Lattice.seal` of the sides "u-", "u+", "v-", "v+"; "all": of those of both directions that are not closed."""
        wished: Any = faces.split(",") if isinstance(faces, str) and faces != "all" else faces
        if isinstance(wished, str):
            closed = [len(knots) != count + degree + 1 for knots, count, degree in zip(self.knots, self.size, self.degree)]
            wished = [side for side in ("u-", "u+", "v-", "v+") if not closed["uv".index(side[0])]]
        for side in wished:
            if side not in ("u-", "u+", "v-", "v+"):
                raise ValueError(f"a side of a plane is u-, u+, v-, v+, not {side!r}")
        return self._of(self.solid.seal(continuity, wished))

    def invert(self, *, threads: int = 0) -> PlaneLattice:
        """`Lattice.invert`."""
        return self._of(self.solid.invert(threads=threads))

    def moved(self, Q: Grid | None = None, *, offsets: Grid | None = None, weights: Rows | None = None) -> PlaneLattice:
        """`Lattice.moved`, with Q or offsets (n, m, 2) and weights (n, m)."""
        if Q is None and offsets is None and weights is None:
            return self
        return self._of(self.solid.moved(self._points(Q), offsets=self._offsets(offsets), weights=self._weights(weights)))

    # -- deformation

    def embed(self, points: Rows, *, outside: Outside = "keep", falloff: float = 0.0, snap: float = 0.0, threads: int = 0,
              isa: Isa = "auto", progress: Progress | None = None) -> PlaneEmbedding:
        """Finds u, v and the status of points (N, 2), as `Lattice.embed`. The points are copied."""
        solid = self.solid.embed(raised(arrays.vectors(points, "points", width=2)), outside=outside, falloff=falloff, snap=snap,
                                 threads=threads, isa=isa, progress=progress)
        return PlaneEmbedding._of(self, solid)

    @overload
    def deform(self, embedding: PlaneEmbedding, Q: Grid | ControlPoints | None = None, *, offsets: Grid | ControlPoints | None = None,
               weights: Rows | None = None, points: Rows | None = None, out: Floats | None = None, vertices: Indices | None = None, normals: None = None,
               tangents: None = None, gradients: Literal[False] = False, weight: Row | None = None, triangles: Triangles | None = None,
               threads: int = 0, isa: Isa = "auto", progress: Progress | None = None) -> Floats: ...

    @overload
    def deform(self, embedding: PlaneEmbedding, Q: Grid | ControlPoints | None = None, *, offsets: Grid | ControlPoints | None = None,
               weights: Rows | None = None, points: Rows | None = None, out: Floats | None = None, vertices: Indices | None = None, normals: Rows,
               tangents: Rows | None = None, gradients: bool = False, weight: Row | None = None, triangles: Triangles | None = None,
               threads: int = 0, isa: Isa = "auto", progress: Progress | None = None) -> Deformed: ...

    @overload
    def deform(self, embedding: PlaneEmbedding, Q: Grid | ControlPoints | None = None, *, offsets: Grid | ControlPoints | None = None,
               weights: Rows | None = None, points: Rows | None = None, out: Floats | None = None, vertices: Indices | None = None, normals: Rows | None = None,
               tangents: Rows, gradients: bool = False, weight: Row | None = None, triangles: Triangles | None = None,
               threads: int = 0, isa: Isa = "auto", progress: Progress | None = None) -> Deformed: ...

    @overload
    def deform(self, embedding: PlaneEmbedding, Q: Grid | ControlPoints | None = None, *, offsets: Grid | ControlPoints | None = None,
               weights: Rows | None = None, points: Rows | None = None, out: Floats | None = None, vertices: Indices | None = None, normals: Rows | None = None,
               tangents: Rows | None = None, gradients: Literal[True], weight: Row | None = None, triangles: Triangles | None = None,
               threads: int = 0, isa: Isa = "auto", progress: Progress | None = None) -> Deformed: ...

    def deform(self, embedding: PlaneEmbedding, Q: Grid | ControlPoints | None = None, *, offsets: Grid | ControlPoints | None = None,
               weights: Rows | None = None, points: Rows | None = None, out: Floats | None = None, vertices: Indices | None = None, normals: Rows | None = None,
               tangents: Rows | None = None, gradients: bool = False, weight: Row | None = None, triangles: Triangles | None = None,
               threads: int = 0, isa: Isa = "auto", progress: Progress | None = None) -> Floats | Deformed:
        """Deforms the embedded points, as `Lattice.deform`: (N, 2), or (K, N, 2) of K variants of Q or offsets, (K, n, m, 2); a `Deformed`
        with normals and tangents (N, 2) of curves in the plane, and gradients (N, 2, 2).

        triangles: (M, 3) indices of points: the part of the plane on which weight= changes
        """
        solid = self._solid_of(embedding)
        source = None if points is None else raised(arrays.vectors(points, "points", len(embedding), width=2))
        count = len(embedding)
        many = _variants(Q, offsets)
        if out is not None:
            out = arrays.outputs(out, "out", (many, count, 2)) if many is not None else arrays.output(out, "out", count, width=2)
        lifted: list[Any] = [None if value is None else raised(arrays.vectors(value, what, count, width=2))
                             for value, what in ((normals, "normals"), (tangents, "tangents"))]
        deform: Any = self.solid.deform
        made = deform(solid, self._points(Q), offsets=self._offsets(offsets), weights=self._weights(weights), points=source,
                      out=None if out is None else np.empty(out.shape[:-1] + (3,), out.dtype), vertices=vertices, normals=lifted[0],
                      tangents=lifted[1], gradients=gradients, weight=weight, triangles=triangles, threads=threads, isa=isa, progress=progress)
        found = np.asarray(made.points if isinstance(made, Deformed) else made)[..., :2]
        if out is None:
            result = np.ascontiguousarray(found)
        else:
            result = out
            chosen: Any = ... if vertices is None else np.asarray(vertices, np.intp)
            result[chosen] = found[chosen]
        if not isinstance(made, Deformed):
            return result
        flat = [None if value is None else np.ascontiguousarray(value[:, :2]) for value in (made.normals, made.tangents)]
        slopes = None if made.gradients is None else np.ascontiguousarray(made.gradients[:, :2, :2])
        return Deformed(result, flat[0], flat[1], slopes, made.collapsed)

    def basis(self, embedding: PlaneEmbedding, *, weights: Rows | None = None, threads: int = 0, isa: Isa = "auto",
              progress: Progress | None = None) -> Sparse:
        """The derivative dX/dQ, (N, n*m), as `Lattice.basis`: columns are in Python's order, v fastest."""
        both = self.solid.basis(self._solid_of(embedding), weights=self._weights(weights), threads=threads, isa=isa, progress=progress)
        # The columns of the two layers follow each other.
        rows = np.repeat(np.arange(len(embedding)), np.diff(both.indptr))
        columns = both.indices // 2
        begins = np.flatnonzero(np.append(True, (columns[1:] != columns[:-1]) | (rows[1:] != rows[:-1]))) if len(columns) else np.arange(0)
        data = np.add.reduceat(both.data, begins) if len(begins) else np.empty(0)
        starts = np.searchsorted(begins, both.indptr).astype(both.indptr.dtype)
        found: Sparse = sparse((data, columns[begins], starts), (len(embedding), self.size[0] * self.size[1]))
        return found

    def basis_times(self, embedding: PlaneEmbedding, D: Grid, *, weights: Rows | None = None, threads: int = 0, isa: Isa = "auto",
                    progress: Progress | None = None) -> Doubles:
        """Computes `basis` @ D.reshape(-1, 2) for offsets D (n, m, 2) without storing the matrix: (N, 2) float64."""
        made = self.solid.basis_times(self._solid_of(embedding), self._offsets(D, "D"), weights=self._weights(weights), threads=threads, isa=isa,
                                      progress=progress)
        return np.ascontiguousarray(made[:, :2])

    def basis_transposed(self, embedding: PlaneEmbedding, dfdx: Rows, *, weights: Rows | None = None, threads: int = 0, isa: Isa = "auto",
                         progress: Progress | None = None) -> Doubles:
        """The derivative of a scalar f by the control points, (n, m, 2) float64. dfdx: its derivative by the points, (N, 2)."""
        solid = self._solid_of(embedding)
        numbers = raised(arrays.doubles(dfdx, "dfdx", (len(embedding), 2)))
        made = self.solid.basis_transposed(solid, numbers, weights=self._weights(weights), threads=threads, isa=isa, progress=progress)
        return np.ascontiguousarray((made[:, :, 0] + made[:, :, 1])[..., :2])

    def weights_jacobian(self, embedding: PlaneEmbedding, *, threads: int = 0, isa: Isa = "auto", progress: Progress | None = None) -> Doubles:
        """The derivative of the deformed points by the weights of the deformed plane, (N, 2, n*m), as `Lattice.weights_jacobian`."""
        made = self.solid.weights_jacobian(self._solid_of(embedding), threads=threads, isa=isa, progress=progress)[:, :2]
        return np.ascontiguousarray(made[..., 0::2] + made[..., 1::2])

    def weights_times(self, embedding: PlaneEmbedding, dw: Rows | Row, *, threads: int = 0, isa: Isa = "auto",
                      progress: Progress | None = None) -> Doubles:
        """Computes `weights_jacobian` @ dw for changes dw of the weights, (n, m) or (n*m,): (N, 2) float64."""
        solid = self._solid_of(embedding)
        given = arrays.numbers(dw, "dw")
        shape = (self.size[0] * self.size[1],) if given.ndim == 1 else self.size
        numbers = np.repeat(arrays.doubles(given, "dw", shape).reshape(self.size)[:, :, None], 2, axis=2)
        return np.ascontiguousarray(self.solid.weights_times(solid, numbers, threads=threads, isa=isa, progress=progress)[:, :2])

    def weights_transposed(self, embedding: PlaneEmbedding, g: Rows, *, threads: int = 0, isa: Isa = "auto",
                           progress: Progress | None = None) -> Doubles:
        """The derivative of a scalar f by the weights of the deformed plane, (n, m) float64. g: its derivative by the points, (N, 2)."""
        solid = self._solid_of(embedding)
        numbers = raised(arrays.doubles(g, "g", (len(embedding), 2)))
        made = self.solid.weights_transposed(solid, numbers, threads=threads, isa=isa, progress=progress)
        return np.ascontiguousarray(made[:, :, 0] + made[:, :, 1])

    @overload
    def evaluate(self, uvw: Rows, *, volume: Volume = "deformed", jacobians: Literal[False] = False, threads: int = 0, isa: Isa = "auto",
                 progress: Progress | None = None) -> Doubles: ...

    @overload
    def evaluate(self, uvw: Rows, *, volume: Volume = "deformed", jacobians: Literal[True], threads: int = 0, isa: Isa = "auto",
                 progress: Progress | None = None) -> tuple[Doubles, Doubles]: ...

    def evaluate(self, uvw: Rows, *, volume: Volume = "deformed", jacobians: bool = False, threads: int = 0, isa: Isa = "auto",
                 progress: Progress | None = None) -> Doubles | tuple[Doubles, Doubles]:
        """`Lattice.evaluate` at u, v (N, 2): points (N, 2), with jacobians=True also (N, 2, 2), whose columns are C_u and C_v."""
        places = raised(arrays.vectors(uvw, "uvw", width=2).astype(np.float64))
        places[:, 2] = self.solid.domain[:, 2].mean()
        made, found = self.solid.evaluate(places, volume=volume, jacobians=True, threads=threads, isa=isa, progress=progress)
        flat = np.ascontiguousarray(made[:, :2])
        return (flat, np.ascontiguousarray(found[:, :2, :2])) if jacobians else flat

    def folds(self, Q: Grid | None = None, *, offsets: Grid | None = None, weights: Rows | None = None, threads: int = 0) -> Folds:
        """Proves whether the deformed plane folds anywhere, as `Lattice.folds`; witnesses have two numbers."""
        found = self.solid.folds(self._points(Q), offsets=self._offsets(offsets), weights=self._weights(weights), threads=threads)
        uvw, xyz, rest = (None if place is None else place[:2] for place in (found.witness_uvw, found.witness_xyz, found.witness_rest))
        return dataclasses.replace(found, witness_uvw=uvw, witness_xyz=xyz, witness_rest=rest)

    def fold_barrier(self, Q: Grid | None = None, *, floor: float = 0.1, embedding: PlaneEmbedding | None = None, threads: int = 0) -> FoldBarrier:
        """`Lattice.fold_barrier`, with a gradient (n, m, 2): 3 degree coefficients along u and v in each span cell count once."""
        made = self.solid.fold_barrier(self._points(Q), floor=floor, embedding=None if embedding is None else self._solid_of(embedding),
                                       threads=threads)
        gradient = (made.gradient[:, :, 0] + made.gradient[:, :, 1])[..., :2] / _COUNTED
        return FoldBarrier(made.least, made.value / _COUNTED, np.ascontiguousarray(gradient))

    def __repr__(self) -> str:
        return f"<PlaneLattice {'x'.join(map(str, self.size))}, degree {', '.join(map(str, self.degree))}>"

    def __copy__(self) -> PlaneLattice:
        return self

    def __deepcopy__(self, memo: Any) -> PlaneLattice:
        return self

    def __reduce__(self) -> Any:
        return PlaneLattice._of, (self.solid,)

    if not TYPE_CHECKING:
        def __getattr__(self, name: str) -> Any:
            if name.startswith("_") or not hasattr(Lattice, name):
                raise AttributeError(f"'PlaneLattice' object has no attribute {name!r}")
            raise AttributeError(f"a lattice of a plane has no {name}: its 3-D lattice, `solid`, has")

    # -- internal

    def _solid_of(self, embedding: PlaneEmbedding) -> Embedding:
        """The embedding in `solid`."""
        if not isinstance(embedding, PlaneEmbedding):
            raise TypeError(f"embedding must be what PlaneLattice.embed returns, not {type(embedding).__name__}")
        return embedding._solid

    def _doubled(self, value: Any, what: str) -> Any:
        """Control points (n, m, 2), or (K, n, m, 2), in both layers, with z = 0; None: None."""
        if value is None:
            return None
        shape = self.size + (2,)
        numbers = arrays.numbers(value, what)
        if numbers.ndim == 4 and what in ("Q", "offsets"):
            shape = (len(numbers),) + shape  # type: ignore[assignment]
        return np.repeat(raised(arrays.doubles(numbers, what, shape))[..., None, :], 2, axis=-2)

    def _points(self, Q: Any) -> Any:
        doubled = self._doubled(Q, "Q")
        if doubled is not None:
            doubled[..., 2] = self.solid.rest[..., 2]
        return doubled

    def _offsets(self, offsets: Any, what: str = "offsets") -> Any:
        return self._doubled(offsets, what)

    def _weights(self, weights: Any) -> Any:
        return None if weights is None else np.repeat(arrays.doubles(weights, "weights", self.size)[:, :, None], 2, axis=2)


def _variants(*controls: Any) -> int | None:
    """How many variants these control points or offsets are, (K, n, m, 2); None: they are none."""
    return next((len(value) for value in controls if value is not None and np.ndim(value) == 4), None)


def _plane(other: Any) -> PlaneLattice:
    if not isinstance(other, PlaneLattice):
        raise TypeError(f"other must be a PlaneLattice, not {type(other).__name__}")
    return other


def _directions(letters: Any, what: str) -> None:
    """Refuses what is no direction of a plane."""
    for letter in letters:
        if letter not in ("u", "v"):
            raise ValueError(f"{what} is u or v, not {letter!r}")
