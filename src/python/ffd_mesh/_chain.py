"""Several lattices for arrays of points: one after the other, or side by side."""

from __future__ import annotations

import ctypes
from typing import Any, Literal, Sequence, TypeVar, overload

import numpy as np
from numpy.typing import NDArray

from . import _arrays as arrays
from . import _library as library
from ._directions import turned
from ._embedding import Status
from ._errors import InvalidError
from ._lattice import DEFORMED, REST, Lattice
from ._library import Owned, Progress, Run, lib
from ._types import ControlPoints, Doubles, Floats, Grid, Indices, Isa, Outside, Row, Rows, Triangles
from ._values import Deformed, vertices_of
from ._weights import weighted

_Self = TypeVar("_Self", bound="_Several")
Several = Sequence["ControlPoints | None"]  # an entry for each lattice; None: its own


class ChainEmbedding:
    """N points in several lattices, made by `Chain.embed` and `Blocks.embed`. Immutable, so threads may share it.

    u, v, w in the first lattice of a chain, and in blocks, hold for any deformed control points. Those in the later lattices of a
    chain depend on the ones before: the embedding has them for the lattices' own control points, and `deform` finds them anew for
    others. Can be pickled: the points are then embedded again, which gives the same bits.
    """

    _chain: Chain | Blocks
    _points: Floats
    _options: dict[str, Any]
    _owned: Owned

    def __init__(self) -> None:
        raise TypeError("use Chain.embed or Blocks.embed")

    @classmethod
    def _of(cls, owned: Owned, chain: Any, points: np.ndarray, options: dict[str, Any]) -> ChainEmbedding:
        self = cls.__new__(cls)
        self._owned, self._chain, self._points, self._options = owned, chain, arrays.kept(points), options
        return self

    def __len__(self) -> int:
        return len(self._points)

    @property
    def chain(self) -> Chain | Blocks:
        """The lattices in which the points are."""
        return self._chain

    @property
    def points(self) -> Floats:
        """The points, (N, 3): a read-only view of the array that was embedded, or of its copy where one was made."""
        return self._points

    @property
    def uvw(self) -> Doubles:
        """u, v, w in the first lattice, or of blocks in that which holds the point: (N, 3) float64, in the range of its knots; NaN for
        points without. A read-only view."""
        return arrays.lent(self._owned, lib.ffd_chain_embedding_get_uvw(self._pointer), (len(self), 3), np.float64)

    @property
    def status(self) -> NDArray[np.uint8]:
        """(N,) uint8, values of `Status`, at the lattices' own control points: OUTSIDE only where a point is outside of all lattices,
        else the greatest status of all; of blocks that in its own. A read-only view."""
        return arrays.lent(self._owned, lib.ffd_chain_embedding_get_status(self._pointer), (len(self),), np.uint8)

    @property
    def blocks(self) -> NDArray[np.int64] | None:
        """Of blocks the number of the lattice that moves each point, from 0, (N,) int64: which holds it or, with outside="extend",
        whose border is nearest; -1: none. None for a chain."""
        if not isinstance(self.chain, Blocks):
            return None
        where = lib.ffd_chain_embedding_get_blocks(self._pointer)
        found = arrays.lent(self._owned, where, (len(self),), np.uint32)
        return np.where(found == 2**32 - 1, -1, found.astype(np.int64))

    @property
    def counts(self) -> dict[Status, int]:
        """The number of points of each status."""
        counts = np.bincount(self.status, minlength=len(Status))
        return {status: int(counts[status]) for status in Status}

    def moved(self, Q: Several | None = None, *, offsets: Several | None = None, weights: Sequence[Grid | None] | None = None, threads: int = 0,
              isa: Isa = "auto", progress: Progress | None = None) -> ChainEmbedding:
        """Returns the embedding of the same points in `chain.moved(Q, ..)`, at whose control points products are: u, v, w in the first
        lattice, and in blocks, are not searched again."""
        return self.chain.moved(Q, offsets=offsets, weights=weights)._embed(self.points, self._options, Run(threads, isa, progress), self)

    def __repr__(self) -> str:
        counted = ", ".join(f"{count} {status.name.lower()}" for status, count in self.counts.items() if count)
        return f"<ChainEmbedding of {len(self)} points in {len(self.chain.lattices)} lattices: {counted or 'none'}>"

    def __copy__(self) -> ChainEmbedding:
        return self

    def __deepcopy__(self, memo: Any) -> ChainEmbedding:
        return self

    def __reduce__(self) -> Any:
        return _embedded, (self.chain, self.points, self._options)

    @property
    def _pointer(self) -> ctypes.c_void_p:
        return self._owned.pointer


def _embedded(chain: Chain | Blocks, points: Floats, options: dict[str, Any]) -> ChainEmbedding:
    """Restores a pickled embedding."""
    return chain.embed(points, **options)


class _Several:
    """What `Chain` and `Blocks` have in common."""

    lattices: tuple[Lattice, ...]
    _side_by_side: bool

    def __init__(self, lattices: Sequence[Lattice]) -> None:
        self.lattices = tuple(lattices)
        for lattice in self.lattices:
            if not isinstance(lattice, Lattice):
                raise TypeError(f"{type(self).__name__} takes lattices, not {type(lattice).__name__}")
        if not self.lattices:
            raise ValueError(f"{type(self).__name__} needs at least one lattice")

    def __len__(self) -> int:
        return len(self.lattices)

    @property
    def needs_points(self) -> bool:
        """Whether the box of some lattice goes round a mesh that is not known yet: see `fit`."""
        return any(lattice.needs_points for lattice in self.lattices)

    def fit(self: _Self, *points: Rows, shared_box: bool = False, outside: Outside = "keep", falloff: float = 0.0,
            snap: float = 0.0) -> _Self:
        """Returns these lattices with each box "mesh" laid round points (N, 3), as `Lattice.fit`: in a chain round the points as
        the lattices before it leave them, in blocks round the points at rest.

        points: one array; with shared_box several
        shared_box: all these boxes go round all the points at rest, of all arrays, as with `--shared-box`: then meshes that
                    belong together are deformed alike
        outside, falloff, snap: how the lattices before move points, as in `embed`
        """
        if shared_box or self._side_by_side:
            if len(points) != 1 and not shared_box or not points:
                raise ValueError("fit takes one array of points; shared_box=True takes several")
            known = [found[np.isfinite(found).all(axis=1)] for found in (arrays.vectors(array, "points") for array in points)]
            every = np.concatenate([found.astype(np.float64) for found in known])
            return self._with([lattice.fit(every) for lattice in self.lattices])
        if len(points) != 1:
            raise ValueError("fit takes one array of points; shared_box=True takes several")
        found: list[Lattice] = []
        for lattice in self.lattices:
            if found and lib.ffd_lattice_needs_bounds(lattice._pointer):
                before = Chain(found).embed(points[0], outside=outside, falloff=falloff, snap=snap)
                low, high = (ctypes.c_double * 3)(), (ctypes.c_double * 3)()
                Run(0, "auto", None)(lib.ffd_chain_embedding_bounds, before._pointer, arrays.span(before.points), low, high)
                lattice = lattice.fit(np.array([low[:], high[:]]))
            found.append(lattice.fit(points[0]) if not found else lattice)
        return self._with(found)

    def moved(self: _Self, Q: Several | None = None, *, offsets: Several | None = None,
              weights: Sequence[Grid | None] | None = None) -> _Self:
        """Returns these lattices with other deformed control points Q, or offsets from rest, and deformed weights: lists with an entry
        for each lattice, as `Lattice.moved` takes them; None: unchanged."""
        return self._with(self._moved(Q, offsets, weights))

    def embed(self, points: Rows, *, outside: Outside = "keep", falloff: float = 0.0, snap: float = 0.0, threads: int = 0,
              isa: Isa = "auto", progress: Progress | None = None) -> ChainEmbedding:
        """Finds u, v, w and the status of points (N, 3), in the later lattices of a chain where those before take them.

        Arguments, and what is kept of the points, as in `Lattice.embed`; outside="error" refuses a point that is outside of all lattices.
        """
        options = {"outside": outside, "falloff": library.real(falloff, "falloff"), "snap": library.real(snap, "snap")}
        return self._embed(arrays.readable(arrays.vectors(points, "points")), options, Run(threads, isa, progress))

    @overload
    def deform(self, embedding: ChainEmbedding, Q: Several | None = None, *, offsets: Several | None = None,
               weights: Sequence[Grid | None] | None = None, points: Rows | None = None, out: Floats | None = None, vertices: Indices | None = None,
               normals: None = None, tangents: None = None, gradients: Literal[False] = False, weight: Row | None = None,
               triangles: Triangles | None = None, threads: int = 0, isa: Isa = "auto", progress: Progress | None = None) -> Floats: ...

    @overload
    def deform(self, embedding: ChainEmbedding, Q: Several | None = None, *, offsets: Several | None = None,
               weights: Sequence[Grid | None] | None = None, points: Rows | None = None, out: Floats | None = None, vertices: Indices | None = None,
               normals: Rows, tangents: Rows | None = None, gradients: bool = False, weight: Row | None = None,
               triangles: Triangles | None = None, threads: int = 0, isa: Isa = "auto", progress: Progress | None = None) -> Deformed: ...

    @overload
    def deform(self, embedding: ChainEmbedding, Q: Several | None = None, *, offsets: Several | None = None,
               weights: Sequence[Grid | None] | None = None, points: Rows | None = None, out: Floats | None = None, vertices: Indices | None = None,
               normals: Rows | None = None, tangents: Rows, gradients: bool = False, weight: Row | None = None,
               triangles: Triangles | None = None, threads: int = 0, isa: Isa = "auto", progress: Progress | None = None) -> Deformed: ...

    @overload
    def deform(self, embedding: ChainEmbedding, Q: Several | None = None, *, offsets: Several | None = None,
               weights: Sequence[Grid | None] | None = None, points: Rows | None = None, out: Floats | None = None, vertices: Indices | None = None,
               normals: Rows | None = None, tangents: Rows | None = None, gradients: Literal[True], weight: Row | None = None,
               triangles: Triangles | None = None, threads: int = 0, isa: Isa = "auto", progress: Progress | None = None) -> Deformed: ...

    def deform(self, embedding: ChainEmbedding, Q: Several | None = None, *, offsets: Several | None = None,
               weights: Sequence[Grid | None] | None = None, points: Rows | None = None, out: Floats | None = None, vertices: Indices | None = None,
               normals: Rows | None = None, tangents: Rows | None = None, gradients: bool = False, weight: Row | None = None,
               triangles: Triangles | None = None, threads: int = 0, isa: Isa = "auto", progress: Progress | None = None) -> Floats | Deformed:
        """Deforms the embedded points by all lattices, with the bits of `ffd deform` with several -l. Returns (N, 3) of the points' type,
        computed in double and rounded once; or a `Deformed`, if normals, tangents or gradients are given.

        Q, offsets, weights: lists with an entry for each lattice, as in `moved`; None, also for one of them: its own. In a chain
                             points are looked up anew behind the first lattice with other control points
        All other arguments are those of `Lattice.deform`; gradients are of all lattices together.
        """
        wanted = gradients or normals is not None or tangents is not None
        run = Run(threads, isa, progress)
        self._check_same(embedding)
        moved = self._moved(Q, offsets, weights)
        source, out = arrays.source_and_out(embedding.points, points, out, vertices)
        if vertices is not None and wanted:
            raise ValueError("normals, tangents and gradients need all vertices")
        count = len(source)
        found = np.empty((count, 3, 3)) if wanted else None
        kept = weighted(run, source, arrays.apart(weight, out), triangles, wanted, normals is not None or tangents is not None)
        normals, tangents = arrays.apart(normals, out), arrays.apart(tangents, out)
        listed = None if vertices is None else vertices_of(vertices, count)
        pointers = (ctypes.c_void_p * len(moved))(*(None if lattice is known else lattice._pointer.value
                                                    for lattice, known in zip(moved, embedding.chain.lattices)))
        desc = library.filled("ffd_chain_deform_desc")
        setattr(desc, "in", arrays.span(source))
        desc.moved, desc.out = ctypes.addressof(pointers), arrays.span(out)
        desc.weights, desc.slopes = kept.addresses
        desc.gradients = None if found is None or not count else arrays.address(found)
        if listed is not None:
            empty = np.zeros(1, np.uint32)
            desc.vertices, desc.vertex_count = arrays.address(listed if len(listed) else empty), len(listed)
        run(lib.ffd_chain_embedding_deform, embedding._pointer, ctypes.byref(desc))
        del pointers, kept
        return out if found is None else turned(run, out, found, normals, tangents, gradients)

    def basis_times(self, embedding: ChainEmbedding, D: Several, *, threads: int = 0, isa: Isa = "auto",
                    progress: Progress | None = None) -> Doubles:
        """The derivative of the deformed points along changes D of the deformed control points, a list with (nu, nv, nw, 3) for each
        lattice (None: its own stay), at the lattices' own control points: (N, 3) float64. In a chain what a lattice does goes
        through the gradients of those behind it."""
        self._check_own(embedding)
        entries = self._entries(D, "D")
        numbers = [None if entry is None else arrays.to_library(arrays.doubles(entry, f"D[{number}]", lattice.size + (3,)))
                   for number, (entry, lattice) in enumerate(zip(entries, self.lattices))]
        pointers = (ctypes.c_void_p * len(numbers))(*(None if array is None else arrays.address(array) for array in numbers))
        out = np.empty((len(embedding), 3))
        Run(threads, isa, progress)(lib.ffd_chain_embedding_basis_times, embedding._pointer, pointers, arrays.address(out))
        return out

    def basis_transposed(self, embedding: ChainEmbedding, dfdx: Rows, *, threads: int = 0, isa: Isa = "auto",
                         progress: Progress | None = None) -> list[Doubles]:
        """The derivative of a scalar f by the deformed control points of each lattice, (nu, nv, nw, 3) float64, at the lattices' own
        control points. dfdx: its derivative by the deformed points, (N, 3)."""
        self._check_own(embedding)
        numbers = arrays.doubles(dfdx, "dfdx", (len(embedding), 3))
        found = [np.empty(lattice.size[::-1] + (3,)) for lattice in self.lattices]
        pointers = (ctypes.c_void_p * len(found))(*(arrays.address(array) for array in found))
        Run(threads, isa, progress)(lib.ffd_chain_embedding_basis_transposed, embedding._pointer, arrays.address(numbers), pointers)
        return [np.ascontiguousarray(array.transpose(2, 1, 0, 3)) for array in found]

    def __repr__(self) -> str:
        return f"<{type(self).__name__} of {', '.join('x'.join(map(str, lattice.size)) for lattice in self.lattices)}>"

    def __copy__(self: _Self) -> _Self:
        return self

    def __deepcopy__(self: _Self, memo: Any) -> _Self:
        return self

    def __reduce__(self) -> Any:
        return type(self), (list(self.lattices),)

    # -- internal

    def _embed(self, points: np.ndarray, options: dict[str, Any], run: Run, start: ChainEmbedding | None = None) -> ChainEmbedding:
        """Embeds points. start: of the same points, with the same options, in the same lattices at rest."""
        pointers = (ctypes.c_void_p * len(self.lattices))(*(lattice._fitted.value for lattice in self.lattices))
        desc = library.filled("ffd_chain_desc")
        desc.lattices, desc.count, desc.blocks = ctypes.addressof(pointers), len(self.lattices), self._side_by_side
        desc.points = arrays.span(points)
        desc.outside = library.value_of("ffd_outside", options["outside"], "outside")
        desc.falloff, desc.snap = options["falloff"], options["snap"]
        desc.start = None if start is None else start._pointer.value
        owned = Owned(lib.ffd_chain_embedding_destroy)
        run(lib.ffd_chain_embedding_create, ctypes.byref(desc), last=(ctypes.byref(owned.pointer),))
        pair = (ctypes.c_size_t * 2)()
        pairs = lib.ffd_chain_embedding_get_overlaps(owned.pointer, pair) if start is None else 0
        if pairs:
            library.LOG.warning("the volumes of lattices %d and %d overlap%s: what is in both goes with the first lattice alone", *pair,
                                f", and {pairs - 1} more pairs do" if pairs > 1 else "")
        return ChainEmbedding._of(owned, self, points, options)

    def _with(self: _Self, lattices: Sequence[Lattice]) -> _Self:
        return type(self)(lattices)

    def _entries(self, values: Any, what: str) -> Sequence[Any]:
        """A list with an entry for each lattice. values: it, or None."""
        if values is None:
            return [None] * len(self.lattices)
        if not isinstance(values, (list, tuple)):
            raise TypeError(f"{what} must be a list with an entry for each lattice, not {type(values).__name__}")
        if len(values) != len(self.lattices):
            raise ValueError(f"{what} must have {len(self.lattices)} entries, one for each lattice, not {len(values)}")
        return values

    def _moved(self, Q: Any, offsets: Any, weights: Any) -> list[Lattice]:
        found = []
        for number, (lattice, *entries) in enumerate(zip(self.lattices, self._entries(Q, "Q"), self._entries(offsets, "offsets"),
                                                         self._entries(weights, "weights"))):
            q, d, w = entries
            if q is not None and d is not None:
                raise ValueError(f"lattice {number}: give Q or offsets, not both")
            shape = lattice.size + (3,)
            found.append(lattice.moved(None if q is None else arrays.doubles(q, f"Q[{number}]", shape),
                                       offsets=None if d is None else arrays.doubles(d, f"offsets[{number}]", shape),
                                       weights=None if w is None else arrays.doubles(w, f"weights[{number}]", lattice.size)))
        return found

    def _check_same(self, embedding: ChainEmbedding) -> None:
        """Refuses an embedding in other lattices."""
        if not isinstance(embedding, ChainEmbedding):
            raise TypeError(f"embedding must be what {type(self).__name__}.embed returns, not {type(embedding).__name__}")
        if type(embedding.chain) is not type(self) or len(embedding.chain) != len(self):
            raise InvalidError("the embedding was made with other lattices")

    def _check_own(self, embedding: ChainEmbedding) -> None:
        """The same, also of one with other deformed control points."""
        self._check_same(embedding)
        for number, (lattice, other) in enumerate(zip(self.lattices, embedding.chain.lattices)):
            if lattice is not other and not _alike(lattice, other):
                raise InvalidError(f"lattice {number} is not that of the embedding: products are at the control points with which "
                                   "the points were embedded")


def _alike(a: Lattice, b: Lattice) -> bool:
    """Whether two lattices are the same map, to the bit: one may have been pickled."""
    weights = [(lattice._weights_or_ones(REST), lattice._weights_or_ones(DEFORMED)) for lattice in (a, b)]
    return a.size == b.size and a.degree == b.degree and all(map(np.array_equal, (*a.knots, a.rest, a.offsets, a.deformed, *weights[0]),
                                                                 (*b.knots, b.rest, b.offsets, b.deformed, *weights[1])))


class Chain(_Several):
    """Lattices that act one after the other, as several -l of `ffd deform`: what one has moved is embedded in the next. (A point on a
    common face of two is moved by both: volumes that lie side by side are `Blocks`.)

        chain = ffd_mesh.Chain([bend, twist])
        embedding = chain.embed(points)
        moved = chain.deform(embedding, [Q, None])

    Immutable, so threads may share it. Can be pickled. lattices: the `Lattice` objects, in their order
    """

    _side_by_side = False


class Blocks(_Several):
    """Lattices side by side, as with `--blocks` of `ffd deform`: all act on the points at rest, each point in the first lattice that
    holds it. Their volumes may share faces; a point on a common face is in the first of both. `embed` warns of volumes that overlap in the
    log "ffd_mesh".

    Immutable, so threads may share it. Can be pickled. lattices: the `Lattice` objects, in their order
    """

    _side_by_side = True
