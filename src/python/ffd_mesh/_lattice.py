"""Control lattices, and the deformation of embedded points."""

from __future__ import annotations

import ctypes
import json
import os
import re
from typing import TYPE_CHECKING, Any, Literal, Mapping, Sequence, overload

import numpy as np

from . import _arrays as arrays
from . import _declarations as declared
from . import _derivatives as derivatives
from . import _library as library
from . import _variants as variants
from ._convert import convert, is_other
from ._directions import turned
from ._embedding import Embedding, EmbeddingOptions
from ._errors import InvalidError
from ._late_copy import Edit, LateCopy
from ._library import Owned, Progress, Run, call, lib
from ._types import (Axis, ControlPoints, Counts, Degrees, Direction, Doubles, Floats, Grid, Half, Indices, Isa, KnotWords, Knots, Numbers, Order, Outside,
                     Part, Path, Row, Rows, Shape, Spacing, Sparse, Triangles, Volume)
from ._values import (Deformed, FoldBarrier, Folds, Parameter, box_content, box_desc, csr, described, direction_of, faces_of, finite, folds_of, parameters, parameters_of, settings, three, vertices_of,
                      wishes_of)
from ._weights import weighted

if TYPE_CHECKING:
    from ._plane import PlaneLattice

REST, DEFORMED = declared.ENUMERATIONS["ffd_volume"].values()


class Lattice:
    """A control lattice: a B-spline volume with nu x nv x nw control points, each with a rest and a deformed position.

    Immutable, so threads may share it. Can be pickled. Arrays of control points have the shape (nu, nv, nw, 3), in Python's
    order: P[i, j, k], w fastest. (Lattice files and the C library have u fastest.) Lengths are in the units of the points. Arrays are taken
    with any real number type and byte order; they are copied as float64, except points (see `embed`).
    """

    _owned: Owned | LateCopy
    _parameters: tuple[Parameter, ...]
    _bounds: np.ndarray | None  # it was fitted to
    _is_still: bool  # at a time of its keys
    _time: float | None  # this time
    _source: derivatives.Source | None  # of its placeholders
    _is_edited: bool  # control points or weights were set
    _size: tuple[int, int, int]
    _degree: tuple[int, int, int]

    def __init__(self) -> None:
        raise TypeError("use Lattice.around, .load, .parse, .box or .from_points")

    # -- constructors

    @classmethod
    def _new(cls, make: Any, *arguments: Any, parameters: tuple[Parameter, ...] = ()) -> Lattice:
        """Wraps the lattice that a function makes whose last arguments are an ffd_lattice ** and an ffd_error."""
        owned = Owned(lib.ffd_lattice_destroy)
        call(make, *arguments, ctypes.byref(owned.pointer))
        self = cls.__new__(cls)
        self._owned, self._parameters, self._bounds, self._is_still = owned, parameters, None, False
        self._time, self._source, self._is_edited = None, None, False
        size, degree = (ctypes.c_size_t * 3)(), (ctypes.c_int * 3)()
        lib.ffd_lattice_get_size(owned.pointer, size)
        lib.ffd_lattice_get_degree(owned.pointer, degree)
        self._size, self._degree = (size[0], size[1], size[2]), (degree[0], degree[1], degree[2])
        return self

    @classmethod
    def around(cls, points: Rows, size: Counts = 4, degree: Degrees = None, *, knots: KnotWords = "default", margin: Numbers = 0.05,
               shape: Shape = "box", spacing: Spacing = "greville", axis: Row = (0, 0, 1), principal: bool = False) -> Lattice:
        """Makes an undeformed lattice round points (N, 3), like `ffd lattice new`. Points that are not finite are ignored.

        size, degree, knots and margin: one value, or three for u, v, w
        size: number of control points
        degree: 1 to 14; None: 3, or size-1 if that is less
        knots: "clamped", "open", "uniform" or "closed"
        margin: fraction of the extent that is added on both sides
        shape: "box" (principal=True: along the principal axes of the points), or "cylinder" round axis
        """
        desc = box_desc(size, degree, knots, margin)
        desc.shape = library.value_of("ffd_lattice_shape", shape, "shape")
        desc.spacing = library.value_of("ffd_spacing", spacing, "spacing")
        desc.axis[:] = [library.real(value, "axis") for value in three(axis, "axis")]
        desc.principal = bool(principal)
        xyz = np.ascontiguousarray(arrays.vectors(points, "points"), dtype=np.float64)
        return cls._new(lib.ffd_lattice_create, ctypes.byref(desc), arrays.address(xyz), len(xyz))

    @classmethod
    def load(cls, path: Path, values: Mapping[str, Any] | None = None, *, size: Counts | None = None,
             degree: Degrees = None, order: Order | None = None, block: str | int | None = None) -> Lattice:
        """Loads a lattice file (data/schema/lattice.md), which is read twice: not a pipe; or one of another format, by its ending.

        values: for the placeholders of its moves, by name
        size, degree, order, block: of another format, as `convert_lattice` takes them
        """
        if is_other(path):
            taken: list[Any] = []
            convert(path, "lattice.json", values=values, size=size, degree=degree, order=order, block=block, taken=taken)
            return cls.parse(taken[-1][1], os.fspath(path))
        if any(wish is not None for wish in (size, degree, order, block)):
            raise ValueError("size, degree, order and block are for other formats than JSON")
        if os.path.exists(path) and not os.path.isfile(path) and not os.path.isdir(path):
            raise ValueError(f"{os.fspath(path)} is not a file that can be read twice; Lattice.parse takes what was read")
        made, count = settings(values)
        used = (ctypes.c_bool * count)()
        self = cls._new(lib.ffd_lattice_load_set, library.path(path), made, count, used)
        unused = [name for name, is_used in zip(values or {}, used) if not is_used]
        if unused:
            raise ValueError(f"{os.fspath(path)} has no placeholder {', '.join(map(repr, unused))}")
        with open(path, "rb") as file:
            data = file.read()
        self._parameters = tuple(parameters_of(data, os.fspath(path)).values())
        self._source = derivatives.source_of(data, os.fspath(path), values)
        return self

    @classmethod
    def parse(cls, text: str | bytes | dict[str, Any], name: str = "lattice") -> Lattice:
        """Makes a lattice from the text of a lattice file, or its content as a dict. name: the file's name in errors."""
        if not isinstance(text, (str, dict, bytes, bytearray, memoryview)):
            raise TypeError(f"text must be a text, bytes or a dict, not {type(text).__name__}")
        text = json.dumps(text) if isinstance(text, dict) else text
        data = text.encode() if isinstance(text, str) else bytes(text)
        found = parameters_of(data, name)
        self = cls._new(lib.ffd_lattice_parse, data, len(data), library.encoded(name, "name"), parameters=tuple(found.values()))
        self._source = derivatives.source_of(data, name)
        return self

    @classmethod
    def box(cls, low: Row, high: Row, size: Counts = 4, degree: Degrees = None, *, knots: Knots = "default", axes: Rows | None = None,
            spacing: Spacing = "greville") -> Lattice:
        """Makes a lattice whose rest volume is the box from low (3,) to high (3,).

        size, degree: as in `around`; knots: as in `from_points`
        axes: (3, 3), rows are orthogonal unit vectors along which low and high are measured; None: x, y, z
        spacing: of the control points: "greville", so that u, v, w are affine in x, y, z, or "uniform", evenly
        """
        if library.value_of("ffd_spacing", spacing, "spacing"):
            return cls.parse(box_content(low, high, size, degree, knots, axes, spacing), "a box")
        made, kept = described(size, degree, knots)
        made.box_min[:], made.box_max[:] = arrays.doubles(low, "low", (3,)), arrays.doubles(high, "high", (3,))
        if axes is not None:
            made.axes[:] = arrays.doubles(axes, "axes", (3, 3)).ravel()
        return cls._new(lib.ffd_lattice_from_arrays, ctypes.byref(made))

    @classmethod
    def plane(cls, low: Row, high: Row, size: Counts = 4, degree: Degrees = None, *, knots: Knots = "default") -> PlaneLattice:
        """Makes a lattice for points of a plane (N, 2), whose volume at rest is the rectangle from low (2,) to high (2,): its control
        points are (n, m, 2). Files of it have a doubled layer: see `PlaneLattice`.

        size, degree, knots: as in `box`, one value, or two for u, v
        """
        from ._plane import PlaneLattice
        return PlaneLattice._box(low, high, size, degree, knots)

    @classmethod
    def from_points(cls, points: ControlPoints, degree: Degrees = None, *, knots: Knots = "default", weights: Grid | None = None) -> Lattice:
        """Makes a lattice with these control points at rest, (nu, nv, nw, 3), and positive weights (nu, nv, nw); None: all 1.

        degree: as in `around`
        knots: one value, or three for u, v, w: "clamped", "open", "uniform", "closed", a knot vector of size+degree+1 numbers,
               or ("closed", breakpoints) with the size+1 breakpoints of one period
        """
        shape: tuple[int, ...] = np.asarray(points).shape
        if len(shape) != 4 or shape[3] != 3:
            raise ValueError(f"points must have the shape (nu, nv, nw, 3), not {shape}")
        made, kept = described(shape[:3], degree, knots)
        rest = arrays.to_library(arrays.doubles(points, "points", shape))
        made.rest = arrays.address(rest)
        if weights is not None:
            kept.append(arrays.to_library(arrays.doubles(weights, "weights", shape[:3])))
            made.rest_weights = arrays.address(kept[-1])
        return cls._new(lib.ffd_lattice_from_arrays, ctypes.byref(made))

    # -- properties

    @property
    def size(self) -> tuple[int, int, int]:
        """The number of control points along u, v, w: (nu, nv, nw)."""
        return self._size

    @property
    def degree(self) -> tuple[int, int, int]:
        """The degrees along u, v, w."""
        return self._degree  # type: ignore[return-value]

    @property
    def knots(self) -> tuple[Doubles, Doubles, Doubles]:
        """The knot vectors of u, v, w: read-only views, float64."""
        found = []
        for direction in range(3):
            knots = ctypes.c_void_p()
            count = lib.ffd_lattice_get_knots(self._pointer, direction, ctypes.byref(knots))
            found.append(arrays.lent(self._owned, knots.value, (count,), np.float64))
        return tuple(found)  # type: ignore[return-value]

    @property
    def domain(self) -> Doubles:
        """The domain: (2, 3), the least and the greatest u, v, w."""
        low, high = (ctypes.c_double * 3)(), (ctypes.c_double * 3)()
        lib.ffd_lattice_get_domain(self._pointer, low, high)
        return np.array([low[:], high[:]])

    @property
    def rest(self) -> Doubles:
        """The control points at rest, (nu, nv, nw, 3) float64: a read-only view of the library's memory, which has u fastest."""
        return self._controls(lib.ffd_lattice_get_points(self._fitted, REST), 3)

    @property
    def deformed(self) -> Doubles:
        """The deformed control points: a view like `rest`."""
        return self._controls(lib.ffd_lattice_get_points(self._fitted, DEFORMED), 3)

    @property
    def offsets(self) -> Doubles:
        """The displacements of the control points from rest: a view like `rest`."""
        return self._controls(lib.ffd_lattice_get_offsets(self._fitted), 3)

    @property
    def rest_weights(self) -> Doubles | None:
        """The weights at rest, (nu, nv, nw) float64: a read-only view; None: all are 1."""
        return self._weights(REST)

    @property
    def weights(self) -> Doubles | None:
        """The deformed weights: a view like `rest_weights`."""
        return self._weights(DEFORMED)

    @property
    def needs_points(self) -> bool:
        """Whether the box goes round a mesh that is not known yet: see `fit`."""
        return not lib.ffd_lattice_get_points(self._pointer, REST)

    @property
    def parameters(self) -> dict[str, Parameter]:
        """The placeholders that the lattice file declares, by name."""
        return {parameter.name: parameter for parameter in self._parameters}

    @property
    def keys(self) -> tuple[float, ...]:
        """The times of the keys in seconds, ascending; without keys (). The lattice is as it is at the first one: see `at`."""
        count = 0 if self._is_still else lib.ffd_lattice_get_keys(self._pointer, None)
        times = np.empty(count)
        if count:
            lib.ffd_lattice_get_keys(self._pointer, arrays.address(times))
        return tuple(times.tolist())

    @property
    def text(self) -> str:
        """The text of a lattice file for this lattice. Control points set by `moved` are stored as offsets."""
        data, size = ctypes.c_void_p(), ctypes.c_size_t()
        call(lib.ffd_lattice_text, self._pointer, ctypes.byref(data), ctypes.byref(size))
        return library.take_bytes(data, size.value).decode()

    def save(self, path: Path, *, force: bool = False, part: Part | None = None) -> None:
        """Writes a lattice file, or one of another format, by its ending, completely or not at all.

        force: replace an existing file
        part: "rest", "deformed" or "both", as of `convert_lattice`; with it moves become offsets. What the format cannot hold
              is logged, as "ffd_mesh"
        """
        if is_other(path) or part is not None:
            convert(None, path, pointer=self._pointer, part=part, force=force)
            return
        call(lib.ffd_lattice_save, self._pointer, library.path(path), bool(force))

    # -- modified copies

    def fit(self, points: Rows) -> Lattice:
        """If the lattice file's box is "mesh", returns a lattice whose box goes round the finite points of (N, 3); else self.

        Its text and file still have the box "mesh": `deform_file` fits it to the mesh of the job.
        """
        points = arrays.vectors(points, "points")
        if not lib.ffd_lattice_needs_bounds(self._pointer):
            return self
        known = points[np.isfinite(points).all(axis=1)]
        if not len(known):
            raise ValueError("points has no finite point")
        return self._fit(np.array([known.min(axis=0), known.max(axis=0)], np.float64))

    def _fit(self, bounds: np.ndarray) -> Lattice:
        copy = self._copy()
        call(lib.ffd_lattice_fit, copy._pointer, arrays.address(bounds[0]), arrays.address(bounds[1]))
        copy._bounds = bounds
        return copy

    def at(self, time: float) -> Lattice:
        """Returns a lattice with keys as it is at this time, in seconds: between two keys between them, before the first and
        after the last like these. The result has no keys; its text is that of a still."""
        if not self.keys:
            raise ValueError("the lattice has no keys")
        copy, copy_time = self._copy(), library.real(time, "time")
        call(lib.ffd_lattice_set_time, copy._pointer, ctypes.c_double(copy_time))
        copy._is_still, copy._time = True, copy_time
        return copy

    def refine(self, size: Counts | None = None, degree: Degrees = None, *, insert: Mapping[Direction, Row] | None = None) -> Lattice:
        """Returns a lattice with more control points, or of higher degree, that is the same map, at rest and deformed.

        degree: not less than now, at most 14; one for all directions, or three for u, v, w; None: as it is
        insert: knots to insert, as {"u": [0.25, 0.5]}; one that is there already becomes a knot of so many more
        size: control points, by halving the longest spans, the first ones first; one for all directions, or three for u, v, w;
              None: as it is
        This is the order of the steps. A direction that is neither clamped nor closed is clamped where its degree rises.
        Each coordinate of the map differs by at most 4 eps (du + dv + dw) times the largest one of a control point (times the
        ratio of the weights). Control points that did not move, nor their neighbours, do not move, to the bit; those
        among whose knots none is inserted keep their bits. A box stays one, unless there are weights.
        Blossoms: Piegl and Tiller, The NURBS Book, 2nd ed., 5.2 and 5.5.
        """
        desc, _kept = wishes_of(size, degree, insert)
        return self._new(lib.ffd_lattice_refine, self._pointer, ctypes.byref(desc))

    def strength(self, strength: float) -> Lattice:
        """Returns a lattice with strength times all displacements: 0.5 is half the edit, 1 the same to the bit, -1 the opposite.
        A weight that moved from h to q becomes (1 - strength) h + strength q."""
        return self._new(lib.ffd_lattice_strength, self._pointer, library.real(strength, "strength"))

    def blend(self, other: Lattice, t: float) -> Lattice:
        """Returns a lattice with 1 - t of what this one does, and t of what other does, to the bit where t is 0 or 1; t may be
        beyond these. Raises `InvalidError` if they differ in size, degree, knots, rest or weights at rest."""
        return self._new(lib.ffd_lattice_blend, self._pointer, other._pointer, library.real(t, "t"))

    def add(self, other: Lattice) -> Lattice:
        """Returns a lattice that does what both do. Raises `InvalidError` as `blend`."""
        return self._new(lib.ffd_lattice_add, self._pointer, other._pointer)

    def mirror(self, direction: Direction) -> Lattice:
        """Returns the mirror image across the middle of a direction, "u", "v" or "w": each control point does, reflected, what
        the one opposite did. Twice is the same, to the bit across a coordinate axis. Raises `InvalidError` if the lattice at
        rest is not symmetric, or the direction is closed."""
        return self._new(lib.ffd_lattice_mirror, self._pointer, direction_of(direction))

    def symmetrize(self, half: Half) -> Lattice:
        """Returns a lattice of which one half stays, "u+", "u-", "v+" .. "w-", and the other is its mirror image; in a layer
        between them nothing moves off the plane. Raises `InvalidError` as `mirror`."""
        if not isinstance(half, str) or half[1:] not in ("+", "-"):
            raise ValueError(f"the half that stays is u+, u-, v+, v-, w+ or w-, not {half!r}")
        return self._new(lib.ffd_lattice_symmetrize, self._pointer, direction_of(half[:1]), half[1] == "+")

    def transform(self, matrix: Rows) -> Lattice:
        """Returns the lattice placed elsewhere by an affine map M, (4, 4) with a last row 0 0 0 1: what was f is M f M^-1. A box
        stays one if its sides stay at right angles (to 1e-15), other shapes become control points. Raises `InvalidError` if
        its determinant is 0."""
        numbers = np.ascontiguousarray(arrays.doubles(matrix, "matrix", (4, 4)))
        return self._new(lib.ffd_lattice_transform, self._pointer, arrays.address(numbers))

    def mirrored(self, axis: Axis, at: float = 0.0) -> Lattice:
        """Returns the lattice reflected in the plane where the coordinate of axis, "x", "y" or "z", is `at`: points reflected
        there go to the reflected places. (`mirror` turns the layers of a lattice round.) A box stays one, other shapes become
        control points, as of `transform`."""
        if axis not in ("x", "y", "z"):
            raise ValueError(f"axis must be 'x', 'y' or 'z', not {axis!r}")
        matrix, row = np.eye(4), "xyz".index(axis)
        matrix[row, row], matrix[row, 3] = -1, 2 * library.real(at, "at")
        return self.transform(matrix)

    def jitter(self, sigma: Numbers, seed: int) -> Lattice:
        """Returns a lattice with noise added to its displacements: sigma x, with x in [-1, 1) for each axis of each control
        point, the same bits on every machine, as of the move "jitter".

        sigma: one for all axes, or three, world units, from 0 on; seed: 0 to 2**53 - 1
        """
        numbers = np.array([library.real(value, "sigma") for value in three(sigma, "sigma")], np.float64)
        return self._new(lib.ffd_lattice_jitter, self._pointer, arrays.address(numbers), library.integer(seed, "seed", most=2**53))

    def seal(self, continuity: str, faces: str | Sequence[Half] = "all") -> Lattice:
        """Returns a lattice with faces held still, so that what is deformed joins what is not with that continuity.

        continuity: "C0", "C1", "C2" ..: the displacement and so many of its derivatives are 0 on the faces; less than the degree
        faces: of "u-", "u+", "v-" .. "w+", a list or one text with commas; "all": those of all directions that are not closed
        The directions of the faces are clamped (`refine`), and the displacements of the outermost layers become 0. For Bezier
        volumes: Sederberg and Parry, Free-form deformation of solid geometric models, 1986. Raises `ValueError` for
        another word, `ArgumentError` for a face of a closed direction, and a degree that is too low.
        """
        if not isinstance(continuity, str) or not re.fullmatch("C[0-9]{1,2}", continuity):
            raise ValueError(f"the continuity is C0, C1, C2 .., not {continuity!r}")
        return self._new(lib.ffd_lattice_seal, self._pointer, int(continuity[1:]), faces_of(faces))

    def invert(self, *, threads: int = 0) -> Lattice:
        """Returns the exact inverse: rest and deformed volume change places. It covers the image of the volume. Raises
        `InvalidError` where the lattice is not proven to have no folds."""
        return self._new(lib.ffd_lattice_invert, self._pointer, library.integer(threads, "threads"))

    def moved(self, Q: ControlPoints | None = None, *, offsets: ControlPoints | None = None, weights: Grid | None = None) -> Lattice:
        """Returns this lattice with other deformed control points Q or offsets from rest, (nu, nv, nw, 3), and deformed weights
        (nu, nv, nw). None: unchanged. Offsets are used without rounding: a control point with offset 0 moves nothing, exactly.
        The lattice itself is copied when the result is first used."""
        if Q is not None and offsets is not None:
            raise ValueError("give Q or offsets, not both")
        self._fitted
        if Q is None and offsets is None and weights is None:
            return self
        edits = [Edit(function, arrays.copied(value, what, self.size + more))
                 for function, value, what, more in ((lib.ffd_lattice_set_points, Q, "Q", (3,)), (lib.ffd_lattice_set_offsets, offsets, "offsets", (3,)),
                                                     (lib.ffd_lattice_set_weights, weights, "weights", ())) if value is not None]
        copy = self._copy(edits)
        copy._is_edited = True
        return copy

    # -- deformation

    def embed(self, points: Rows, *, outside: Outside = "keep", falloff: float = 0.0, snap: float = 0.0, threads: int = 0,
              isa: Isa = "auto", progress: Progress | None = None) -> Embedding:
        """Finds u, v, w and the status of points (N, 3) in the rest volume, with certified results. One that is not finite gets the
        status INVALID.

        The embedding refers to float32 and float64 points without a copy: do not change them while it is in use, or pass points= to
        `deform`. Points of other number types and byte orders are copied, as float32 (floats of at most 32 bits) or float64.

        outside: points without u, v, w: "keep" (stay), "extend" (follow the nearest point of the border), or "error"
        falloff: with "extend": distance, in units of the points, over which the displacement fades to 0; 0: no fading.
            Without "extend" it is refused
        snap: a point that misses the volume by at most this distance is inside, at the border
        threads: 0: all cores
        progress: called from time to time with the fraction done, 0 to 1; returning False cancels
        Raises `EmbeddingError` for outside="error", and other kinds of `Error`.
        """
        points = arrays.readable(arrays.vectors(points, "points"))
        self._fitted
        desc = library.filled("ffd_embedding_desc")
        desc.lattice, desc.points = self._pointer, arrays.span(points)
        desc.outside = library.value_of("ffd_outside", outside, "outside")
        desc.falloff, desc.snap = library.real(falloff, "falloff"), library.real(snap, "snap")
        owned = Owned(lib.ffd_embedding_destroy)
        Run(threads, isa, progress)(lib.ffd_embedding_create, ctypes.byref(desc), last=(ctypes.byref(owned.pointer),))
        return Embedding._of(owned, self, points, EmbeddingOptions(outside, desc.falloff, desc.snap))

    @overload
    def deform(self, embedding: Embedding, Q: ControlPoints | None = None, *, offsets: ControlPoints | None = None, weights: Grid | None = None,
               points: Rows | None = None, out: Floats | None = None, vertices: Indices | None = None, normals: None = None, tangents: None = None,
               gradients: Literal[False] = False, weight: Row | None = None, triangles: Triangles | None = None, threads: int = 0,
               isa: Isa = "auto", progress: Progress | None = None) -> Floats: ...

    @overload
    def deform(self, embedding: Embedding, Q: ControlPoints | None = None, *, offsets: ControlPoints | None = None, weights: Grid | None = None,
               points: Rows | None = None, out: Floats | None = None, vertices: Indices | None = None, normals: Rows, tangents: Rows | None = None,
               gradients: bool = False, weight: Row | None = None, triangles: Triangles | None = None, threads: int = 0,
               isa: Isa = "auto", progress: Progress | None = None) -> Deformed: ...

    @overload
    def deform(self, embedding: Embedding, Q: ControlPoints | None = None, *, offsets: ControlPoints | None = None, weights: Grid | None = None,
               points: Rows | None = None, out: Floats | None = None, vertices: Indices | None = None, normals: Rows | None = None, tangents: Rows,
               gradients: bool = False, weight: Row | None = None, triangles: Triangles | None = None, threads: int = 0,
               isa: Isa = "auto", progress: Progress | None = None) -> Deformed: ...

    @overload
    def deform(self, embedding: Embedding, Q: ControlPoints | None = None, *, offsets: ControlPoints | None = None, weights: Grid | None = None,
               points: Rows | None = None, out: Floats | None = None, vertices: Indices | None = None, normals: Rows | None = None, tangents: Rows | None = None,
               gradients: Literal[True], weight: Row | None = None, triangles: Triangles | None = None, threads: int = 0,
               isa: Isa = "auto", progress: Progress | None = None) -> Deformed: ...

    def deform(self, embedding: Embedding, Q: ControlPoints | None = None, *, offsets: ControlPoints | None = None, weights: Grid | None = None,
               points: Rows | None = None, out: Floats | None = None, vertices: Indices | None = None, normals: Rows | None = None, tangents: Rows | None = None,
               gradients: bool = False, weight: Row | None = None, triangles: Triangles | None = None, threads: int = 0,
               isa: Isa = "auto", progress: Progress | None = None) -> Floats | Deformed:
        """Deforms the embedded points. Returns an array (N, 3) of the points' type, computed in double and rounded once; or a
        `Deformed`, if normals, tangents or gradients are given.

        Q, offsets, weights: as in `moved`; without them this lattice's own deformed control points are used. K variants of Q or
                             of offsets, (K, nu, nv, nw, 3), give (K, N, 3), each with the bits of a call of its own; weights= and
                             weight= are one set for all. With variants there are no normals, tangents, gradients and vertices
        points: the points at rest, if the array given to `embed` has changed since
        out: (N, 3), or (K, N, 3), float32 or float64 with any strides, for the result; may be the array points= of one variant
        vertices: indices, ascending: deform only these. Other rows of out are unchanged or, without out, at rest
        normals, tangents: (N, 3), transformed to the deformed surface; the results are unit vectors of the same type
        gradients: True: also return the gradients of the displacement
        weight: (N,), from 0 to 1: each point moves by its weight times the displacement (weights= are of control points)
        triangles: (M, 3) indices of points: the surface on which the weight changes. Normals and tangents need it with weight=;
                   gradients have the slope of the weight with it only

        Points that do not move keep their bits. After an exception the content of out is undefined.
        """
        wanted = gradients or normals is not None or tangents is not None
        run = Run(threads, isa, progress)
        if variants.are_many(self, Q, offsets):
            if wanted or vertices is not None:
                raise ValueError("normals, tangents, gradients and vertices are for one Q, not for (K, nu, nv, nw, 3)")
            return variants.deform(self, run, embedding, Q, offsets, weights, points, out, weight, triangles)
        if (Q is not None or offsets is not None) and not wanted and vertices is None and triangles is None:
            return variants.deform_one(self, run, embedding, Q, offsets, weights, points, out, weight)
        lattice = self.moved(Q, offsets=offsets, weights=weights)
        source, out = self._source_and_out(embedding, points, out, vertices)
        if vertices is not None and wanted:
            raise ValueError("normals, tangents and gradients need all vertices")
        count = len(source)
        found = np.empty((count, 3, 3)) if wanted else None
        where = arrays.address(found) if found is not None and count else None
        arguments: tuple[Any, ...] = (arrays.span(source), arrays.span(out), where)
        kept = weighted(run, source, arrays.apart(weight, out), triangles, wanted, normals is not None or tangents is not None)
        normals, tangents = arrays.apart(normals, out), arrays.apart(tangents, out)
        weights_of_points = () if kept.weights is None else kept.addresses
        listed = None if vertices is None else vertices_of(vertices, count)
        if listed is None:
            function = lib.ffd_embedding_deform_weighted if weights_of_points else lib.ffd_embedding_deform
            run(function, embedding._pointer, lattice._pointer, *weights_of_points, *arguments)
        else:
            function = lib.ffd_embedding_deform_some_weighted if weights_of_points else lib.ffd_embedding_deform_some
            run(function, embedding._pointer, lattice._pointer, arrays.address(listed), len(listed), *weights_of_points, *arguments)
        del kept
        if found is None:
            return out
        return turned(run, out, found, normals, tangents, gradients)

    def basis(self, embedding: Embedding, *, weights: Grid | None = None, threads: int = 0, isa: Isa = "auto",
              progress: Progress | None = None) -> Sparse:
        """The derivative B = dX/dQ, (N, nu*nv*nw): a scipy.sparse.csr_array, or a `Csr` without scipy.

        Row i has, for each control point, the derivative of a coordinate of point i by the same coordinate of the control
        point. So B @ D.reshape(-1, 3) are the displacements for offsets D (nu, nv, nw, 3). Columns are in Python's order, like
        reshape, w fastest. (The C library and files have u fastest.) Rows of points that cannot move are empty.

        weights: deformed weights (nu, nv, nw); None: this lattice's
        """
        self._check_same(embedding)
        matrix = library.empty("ffd_csr")
        kept = self._weights_for_library(weights)
        Run(threads, isa, progress)(lib.ffd_embedding_basis_ordered, embedding._pointer,
                                    None if kept is None else arrays.address(kept), True, ctypes.byref(matrix))
        return csr(matrix)

    def basis_times(self, embedding: Embedding, D: ControlPoints, *, weights: Grid | None = None, threads: int = 0,
                    isa: Isa = "auto", progress: Progress | None = None) -> Doubles:
        """Computes `basis` @ D.reshape(-1, 3) for offsets D (nu, nv, nw, 3) without storing the matrix: (N, 3) float64."""
        self._check_same(embedding)
        numbers = arrays.to_library(arrays.doubles(D, "D", self.size + (3,)))
        kept = self._weights_for_library(weights)
        out = np.empty((len(embedding), 3))
        Run(threads, isa, progress)(lib.ffd_embedding_basis_times, embedding._pointer,
                                    None if kept is None else arrays.address(kept), arrays.address(numbers), arrays.address(out))
        return out

    def basis_transposed(self, embedding: Embedding, dfdx: Rows, *, weights: Grid | None = None, threads: int = 0,
                         isa: Isa = "auto", progress: Progress | None = None) -> Doubles:
        """Computes `basis`.T @ dfdx without storing the matrix. dfdx: derivative of a scalar f by the points, (N, 3). Returns
        the derivative of f by the control points, (nu, nv, nw, 3) float64."""
        self._check_same(embedding)
        numbers = arrays.doubles(dfdx, "dfdx", (len(embedding), 3))
        kept = self._weights_for_library(weights)
        out = np.empty(self.size[::-1] + (3,))
        Run(threads, isa, progress)(lib.ffd_embedding_basis_transposed, embedding._pointer,
                                    None if kept is None else arrays.address(kept), arrays.address(numbers), arrays.address(out))
        return np.ascontiguousarray(out.transpose(2, 1, 0, 3))

    @property
    def parameter_columns(self) -> tuple[str, ...]:
        """The names of the columns of `parameters_jacobian`, in their order: "A" of a number, "S[0]", "S[1]" .. of an array."""
        return derivatives.columns(self)

    def parameters_jacobian(self, embedding: Embedding, values: Mapping[str, Any] | None = None, *, threads: int = 0,
                            isa: Isa = "auto", progress: Progress | None = None) -> Doubles:
        """The derivative of the deformed points by the numbers of the placeholders in the moves of the lattice's file, (N, 3, m)
        float64, with the bits of `ffd jacobian --wrt parameters`. Without placeholders m is 0.

        values: of placeholders, by name, at which the lattice is taken; for others those that it was loaded with, else
                their defaults
        Columns are in the order in which the file first uses the placeholders: see `parameter_columns`. Raises `InvalidError` if
        control points were set since (`moved`), or where a placeholder is no number that moves points (a text, an index, a seed).
        Lattices made of this one (`strength`, `refine` ..) have no placeholders.
        """
        return derivatives.parameters_jacobian(self, Run(threads, isa, progress), embedding, values)

    def parameters_times(self, embedding: Embedding, dp: Row, values: Mapping[str, Any] | None = None, *, threads: int = 0,
                         isa: Isa = "auto", progress: Progress | None = None) -> Doubles:
        """Computes `parameters_jacobian` @ dp for changes dp (m,) of the numbers, without storing it: (N, 3) float64."""
        return derivatives.parameters_times(self, Run(threads, isa, progress), embedding, dp, values)

    def parameters_transposed(self, embedding: Embedding, g: Rows, values: Mapping[str, Any] | None = None, *, threads: int = 0,
                              isa: Isa = "auto", progress: Progress | None = None) -> Doubles:
        """The derivative of a scalar f by the numbers of the placeholders, (m,) float64. g: its derivative by the deformed points,
        (N, 3)."""
        return derivatives.parameters_transposed(self, Run(threads, isa, progress), embedding, g, values)

    def weights_jacobian(self, embedding: Embedding, *, threads: int = 0, isa: Isa = "auto",
                         progress: Progress | None = None) -> Doubles:
        """The derivative of the deformed points by the weights of the deformed volume, (N, 3, nu*nv*nw) float64, at this
        lattice's own deformed control points and weights (those that it does not have are 1): R_j (Q_j - X) / h_j. Columns are
        in Python's order, w fastest. The NURBS Book, 4.4."""
        return derivatives.weights_jacobian(self, Run(threads, isa, progress), embedding)

    def weights_times(self, embedding: Embedding, dw: Grid | Row, *, threads: int = 0, isa: Isa = "auto",
                      progress: Progress | None = None) -> Doubles:
        """Computes `weights_jacobian` @ dw for changes dw of the weights, (nu, nv, nw) or (nu*nv*nw,), without storing it: (N, 3)."""
        return derivatives.weights_times(self, Run(threads, isa, progress), embedding, dw)

    def weights_transposed(self, embedding: Embedding, g: Rows, *, threads: int = 0, isa: Isa = "auto",
                           progress: Progress | None = None) -> Doubles:
        """The derivative of a scalar f by the weights of the deformed volume, (nu, nv, nw) float64. g: its derivative by the deformed
        points, (N, 3)."""
        return derivatives.weights_transposed(self, Run(threads, isa, progress), embedding, g)

    @overload
    def evaluate(self, uvw: Rows, *, volume: Volume = "deformed", jacobians: Literal[False] = False, threads: int = 0, isa: Isa = "auto",
                 progress: Progress | None = None) -> Doubles: ...

    @overload
    def evaluate(self, uvw: Rows, *, volume: Volume = "deformed", jacobians: Literal[True], threads: int = 0, isa: Isa = "auto",
                 progress: Progress | None = None) -> tuple[Doubles, Doubles]: ...

    def evaluate(self, uvw: Rows, *, volume: Volume = "deformed", jacobians: bool = False, threads: int = 0, isa: Isa = "auto",
                 progress: Progress | None = None) -> Doubles | tuple[Doubles, Doubles]:
        """Evaluates the volume ("rest" or "deformed") at uvw (N, 3). Returns points (N, 3) float64; with jacobians=True also
        (N, 3, 3), whose columns are C_u, C_v, C_w. uvw beyond the domain count as on its border; NaN gives NaN.

        To move the same points again and again, `deform` of an embedding is several times faster. Threads may call it at the same
        time. Raises ValueError for another shape or word, and `Error`.
        """
        self._fitted
        uvw = np.ascontiguousarray(arrays.vectors(uvw, "uvw"), dtype=np.float64)
        out = np.empty_like(uvw)
        found = np.empty((len(uvw), 3, 3)) if jacobians else None
        number = library.value_of("ffd_volume", volume, "volume")
        Run(threads, isa, progress)(lib.ffd_lattice_evaluate_many, self._pointer, number, arrays.address(uvw), len(uvw),
                                    arrays.address(out), None if found is None else arrays.address(found))
        return out if found is None else (out, found)

    def folds(self, Q: ControlPoints | None = None, *, offsets: ControlPoints | None = None, weights: Grid | None = None, threads: int = 0) -> Folds:
        """Proves whether the deformed volume folds anywhere. Q, offsets, weights: as in `moved`. threads: 0: all cores."""
        lattice = self.moved(Q, offsets=offsets, weights=weights)
        found = library.empty("ffd_folds")
        call(lib.ffd_folds_find, lattice._pointer, library.integer(threads, "threads"), ctypes.byref(found))
        return folds_of(found)

    def fold_barrier(self, Q: ControlPoints | None = None, *, floor: float = 0.1, embedding: Embedding | None = None, threads: int = 0) -> FoldBarrier:
        """A smooth measure of folding with its gradient, for optimizers: sum max(0, floor - c)^2 over the Bernstein coefficients c of det J of
        the deformed volume, 3 degree a direction in each span cell, relative to the mean of det J at rest (src/maths.md 10.7). Where
        the value is 0 and floor is well above rounding (1e-9 or more) the volume does not fold in these cells; it may be above 0 where
        nothing folds.

        Q: the deformed control points (nu, nv, nw, 3); None: those of the lattice
        embedding: only the cells that hold its points count. threads: 0: all cores; never changes a bit
        Raises `UnsupportedError` for a lattice with weights.
        """
        self._fitted
        points = None if Q is None else arrays.to_library(arrays.doubles(Q, "Q", self.size + (3,)))
        if embedding is not None:
            self._check_same(embedding)
        uvw = None if embedding is None else np.ascontiguousarray(embedding.uvw, dtype=np.float64)
        found, gradient = library.empty("ffd_barrier"), np.empty((self.size[2], self.size[1], self.size[0], 3))
        call(lib.ffd_folds_barrier, self._pointer, None if points is None else arrays.address(points), library.real(floor, "floor"),
             None if uvw is None else arrays.address(uvw), 0 if uvw is None else len(uvw), library.integer(threads, "threads"),
             ctypes.byref(found), arrays.address(gradient))
        return FoldBarrier(finite(found.least), found.value, np.ascontiguousarray(gradient.transpose(2, 1, 0, 3)))

    def __repr__(self) -> str:
        return f"<Lattice {'x'.join(map(str, self.size))}, degree {', '.join(map(str, self.degree))}>"

    def __copy__(self) -> Lattice:
        return self

    def __deepcopy__(self, memo: Any) -> Lattice:
        return self

    def __reduce__(self) -> Any:
        return _again, (self.text, self._bounds, None if self.needs_points or self.keys else self.offsets, self._parameters,
                        (self._time, self._source, self._is_edited))

    # -- internal

    @property
    def _pointer(self) -> ctypes.c_void_p:
        return self._owned.pointer

    @property
    def _fitted(self) -> ctypes.c_void_p:
        if self.needs_points:
            raise ValueError("the lattice's box goes round a mesh that is not known: use the lattice that fit(points) returns")
        return self._pointer

    @property
    def _count(self) -> int:
        return self.size[0] * self.size[1] * self.size[2]

    def _controls(self, where: int | None, *more: int) -> np.ndarray:
        return arrays.lent_controls(self._owned, where, self.size, *more)

    def _weights(self, volume: int) -> np.ndarray | None:
        where = lib.ffd_lattice_get_weights(self._fitted, volume)
        return self._controls(where) if where else None

    def _weights_or_ones(self, volume: int) -> np.ndarray:
        weights = self._weights(volume)
        return np.ones(self.size) if weights is None else weights

    def _copy(self, edits: Sequence[Edit] = ()) -> Lattice:
        copy = Lattice.__new__(Lattice)
        copy.__dict__.update(self.__dict__, _owned=LateCopy(self._owned, self._count, edits))
        return copy

    def _weights_for_library(self, weights: Any) -> np.ndarray | None:
        weights = self.weights if weights is None else weights
        return None if weights is None else arrays.to_library(arrays.doubles(weights, "weights", self.size))

    def _check_same(self, embedding: Embedding) -> None:
        if not isinstance(embedding, Embedding):
            raise TypeError(f"embedding must be what embed returns, not {type(embedding).__name__}")
        other = embedding.lattice
        if other is self:
            return
        if other.size != self.size or other.degree != self.degree \
                or not all(map(np.array_equal, (*other.knots, other.rest, other._weights_or_ones(REST)),
                               (*self.knots, self.rest, self._weights_or_ones(REST)))):
            raise InvalidError("the embedding was made with another lattice")

    def _source_and_out(self, embedding: Embedding, points: Any, out: Any, vertices: Any) -> tuple[np.ndarray, np.ndarray]:
        """Returns the points at rest, and the array for the results, after checks."""
        if not isinstance(embedding, Embedding):
            raise TypeError(f"embedding must be what embed returns, not {type(embedding).__name__}")
        return arrays.source_and_out(embedding.points, points, out, vertices)


def _again(text: str, bounds: np.ndarray | None, offsets: np.ndarray | None, parameters: tuple[Parameter, ...] = (),
           origin: tuple[float | None, derivatives.Source | None, bool] = (None, None, False)) -> Lattice:
    """Restores a pickled lattice. parameters, origin: what its text lacks."""
    lattice = Lattice.parse(text)
    lattice = lattice if bounds is None else lattice._fit(bounds).moved(offsets=offsets)  # None: as the text says
    lattice._parameters = parameters or lattice._parameters
    lattice._time, lattice._source, lattice._is_edited = origin
    return lattice
