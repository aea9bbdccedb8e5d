"""Arguments and results of lattices, apart from arrays of points."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from . import _arrays as arrays
from . import _declarations as declared
from . import _library as library
from ._library import Owned, lib
from ._types import Doubles, Floats, Path, Verdict


class Parameter(NamedTuple):
    """A placeholder, as a lattice file declares it. default, min, max: None if it has none."""

    name: str
    default: Any
    unit: str | None
    comment: str | None
    min: float | None
    max: float | None


class Deformed(NamedTuple):
    """What `Lattice.deform` returns if it is asked for more than points. Members not asked for are None.

    points: (N, 3); normals, tangents: (N, 3); gradients: (N, 3, 3) float64, [n, r, c] = d displacement_r / d p_c
    collapsed: the number of normals and tangents that the deformation collapses; they keep their direction
    """

    points: Floats
    normals: Floats | None = None
    tangents: Floats | None = None
    gradients: Doubles | None = None
    collapsed: int = 0


class Csr(NamedTuple):
    """A sparse matrix in CSR format, if scipy is not installed. The entries of row i are indptr[i] to indptr[i+1]-1."""

    data: Doubles
    indices: NDArray[np.integer[Any]]
    indptr: NDArray[np.integer[Any]]
    shape: tuple[int, int]


@dataclass(frozen=True)
class Folds:
    """The fold proof of a deformed volume (ffd/fold.h). verdict: "none", "some", or "unknown".

    cells, folded_cells, unknown_cells: numbers of span cells
    min_det: a lower bound of the Jacobian determinant, relative to what `relative_to` says: "mean", the mean of the determinant
      at rest; "bounds", the volume of the bounds of the control points at rest, where that mean is 0 to rounding; "place", the
      determinant at rest at the same place, where one affine map moves the whole lattice. None: no bound is known
    witness_uvw, witness_xyz, witness_rest: (3,) parameters, deformed and rest position of a point that folds; witness_det: the
      determinant there, relative as min_det is. None without such a point
    """

    verdict: Verdict
    cells: int
    folded_cells: int
    unknown_cells: int
    min_det: float | None
    witness_uvw: Doubles | None
    witness_xyz: Doubles | None
    witness_rest: Doubles | None
    witness_det: float | None
    relative_to: Literal["mean", "bounds", "place"]


class FoldBarrier(NamedTuple):
    """What `Lattice.fold_barrier` returns."""

    least: float | None  # the least Bernstein coefficient of det J, relative to the mean of det J at rest; None where no cell counts
    value: float  # the sum of max(0, floor - c)^2 over the coefficients c
    gradient: np.ndarray  # (nu, nv, nw, 3) float64: of the value by the deformed control points


def finite(value: float) -> float | None:
    """A number, or None for one that is not finite: there is none."""
    return value if math.isfinite(value) else None


def folds_of(found: Any) -> Folds:
    """Folds of the library's ffd_folds."""
    witness, has = found.witness, found.witness.is_there
    uvw, xyz, rest = (np.array(v) if has else None for v in (witness.uvw, witness.xyz, witness.rest))
    verdict: Any = library.NAMES["ffd_fold_verdict"][found.verdict]
    relative_to: Any = library.NAMES["ffd_fold_reference"][found.relative_to]
    return Folds(verdict, found.cells, found.folded_cells, found.unknown_cells,
                 finite(found.min_det), uvw, xyz, rest, witness.det if has else None, relative_to)


def settings(values: Mapping[str, Any] | None) -> tuple[Any, int]:
    """Values of placeholders as ffd_setting; texts as they are, all else as JSON."""
    if values is not None and not isinstance(values, Mapping):
        raise TypeError(f"values of placeholders must be a dict, not {type(values).__name__}")
    items = list((values or {}).items())
    made = (declared.ffd_setting * len(items))()
    for setting, (name, value) in zip(made, items):
        value = value.tolist() if isinstance(value, (np.ndarray, np.generic)) else value
        setting.name = library.encoded(name, "the name of a placeholder")
        setting.value = library.encoded(value if isinstance(value, str) else json.dumps(value), f"the value of {name}")
    return made, len(items)


def three(value: Any, what: str) -> tuple[Any, Any, Any]:
    """Returns three values, for u, v, w. value: one for all, or three."""
    if isinstance(value, (list, tuple, np.ndarray)):
        if len(value) != 3:
            raise ValueError(f"{what} must be one value, or three, not {len(value)}")
        return tuple(value)  # type: ignore[return-value]
    return value, value, value


def pair(value: Any, what: str) -> tuple[Any, Any]:
    """Returns two values, for u, v. value: one for both, or two."""
    if isinstance(value, (list, tuple, np.ndarray)):
        if len(value) != 2:
            raise ValueError(f"{what} must be one value, or two, not {len(value)}")
        return tuple(value)  # type: ignore[return-value]
    return value, value


def box_desc(size: Any = 4, degree: Any = None, knots: Any = "default", margin: Any = 0.05) -> Any:
    """The description of a new lattice: of each one value, or three for u, v, w."""
    desc = library.filled("ffd_lattice_desc")
    desc.size[:], desc.degree[:] = shape_of(size, degree)
    desc.knots[:] = [library.value_of("ffd_knots", word, "knots") for word in three(knots, "knots")]
    desc.margin[:] = [library.real(value, "margin") for value in three(margin, "margin")]
    return desc


def box_content(low: Any, high: Any, size: Any, degree: Any, knots: Any, axes: Any, spacing: str) -> dict[str, Any]:
    """The content of a lattice file with a box from low to high, of the arguments of `Lattice.box`."""
    sizes, degrees = shape_of(size, degree)
    box = {"min": arrays.doubles(low, "low", (3,)).tolist(), "max": arrays.doubles(high, "high", (3,)).tolist(), "spacing": spacing}
    if axes is not None:
        box["axes"] = arrays.doubles(axes, "axes", (3, 3)).tolist()
    kinds = (knots,) * 3 if isinstance(knots, str) else three(knots, "knots")
    for kind in kinds:
        if isinstance(kind, str) and kind not in ("default", "clamped") or has_breakpoints(kind):
            raise ValueError(f"spacing='{spacing}' needs clamped knots, not {kind!r}")
    made = ["clamped" if isinstance(kind, str) else arrays.doubles(kind, "knots", np.shape(kind)).tolist() for kind in kinds]
    return {"format": "ffd-lattice", "version": 1, "size": sizes, "knots": made, "rest": {"box": box},
            "degree": [known or min(3, count - 1) for known, count in zip(degrees, sizes)]}


def shape_of(size: Any, degree: Any) -> tuple[list[int], list[int]]:
    """Converts sizes and degrees for the library, which takes 0 for a degree that is not given."""
    sizes = [library.integer(value, "size", 1, 2**62) for value in three(size, "size")]
    if 1 in sizes:
        raise ValueError(f"size 1 along {'uvw'[sizes.index(1)]} is less than 2: Lattice.plane makes a lattice of a plane")
    return sizes, degrees_of(degree)


def degrees_of(degree: Any) -> list[int]:
    """Converts degrees for the library, which takes 0 for one that is not given, and knows the greatest one."""
    degrees = [0 if value is None else library.integer(value, "degree") for value in three(degree, "degree")]
    if any(found == 0 and value is not None for found, value in zip(degrees, three(degree, "degree"))):
        raise ValueError("degree must be at least 1, not 0: degree 1 between two layers that move alike does the same")
    return degrees


def direction_of(letter: Any) -> int:
    """The number of a direction."""
    if letter not in ("u", "v", "w"):
        raise ValueError(f"a direction is u, v or w, not {letter!r}")
    return "uvw".index(letter)


FACES = ("u-", "u+", "v-", "v+", "w-", "w+")


def faces_of(faces: Any) -> int:
    """The bits of faces of a volume."""
    if isinstance(faces, str):
        if faces == "all":
            return 1 << len(FACES)
        faces = faces.split(",")
    bits = 0
    for face in faces:
        if face not in FACES:
            raise ValueError(f"a face is {', '.join(FACES)}, not {face!r}")
        bits |= 1 << FACES.index(face)
    if not bits:
        raise ValueError("there is no face to hold")
    return bits


def wishes_of(size: Any, degree: Any, insert: Any) -> tuple[Any, list[np.ndarray]]:
    """Makes an ffd_refine_desc. Returns it with the arrays that must stay alive."""
    desc, kept = library.filled("ffd_refine_desc"), []
    desc.size[:] = [0 if value is None else library.integer(value, "size", 1, 2**62) for value in three(size, "size")]
    desc.degree[:] = degrees_of(degree)
    for direction, knots in (insert or {}).items():
        if direction not in ("u", "v", "w"):
            raise ValueError(f"insert has the directions u, v and w, not {direction!r}")
        kept.append(arrays.doubles(knots, "insert", (np.size(knots),)))
        desc.insert["uvw".index(direction)] = arrays.address(kept[-1])
        desc.insert_count["uvw".index(direction)] = len(kept[-1])
    return desc, kept


def has_breakpoints(knots: Any) -> bool:
    """Whether these are ("closed", breakpoints)."""
    return isinstance(knots, tuple) and len(knots) == 2 and isinstance(knots[0], str) and knots[0] == "closed"


def described(size: Any, degree: Any, knots: Any) -> tuple[Any, list[np.ndarray]]:
    """Makes an ffd_lattice_arrays. Returns it with the arrays that must stay alive."""
    made, kept = library.filled("ffd_lattice_arrays"), []
    made.size[:], made.degree[:] = shape_of(size, degree)
    one = isinstance(knots, str) or has_breakpoints(knots)
    for direction, knot in enumerate((knots,) * 3 if one else three(knots, "knots")):
        word, values = (knot, None) if isinstance(knot, str) else knot if has_breakpoints(knot) else ("default", knot)
        made.knots[direction] = library.value_of("ffd_knots", word, "knots")
        if values is not None:
            kept.append(arrays.doubles(values, "knots", (len(values),)))
            made.knot_values[direction] = arrays.address(kept[-1])
            made.knot_count[direction] = len(kept[-1])
    return made, kept


def vertices_of(value: Any, count: int) -> np.ndarray:
    """Converts indices of points, 0 to count-1, to contiguous uint32."""
    array = np.asarray(value)
    if array.ndim != 1 or array.dtype.kind not in "iu" and array.size:
        raise TypeError("vertices must be a list of integers")
    if array.size and (array.min() < 0 or array.max() >= count):
        raise ValueError(f"vertices must be 0 to {count - 1}")
    return np.ascontiguousarray(array, dtype=np.uint32)


def triangles_of(value: Any, count: int) -> np.ndarray:
    """Converts triangles (M, 3) of indices of points, 0 to count-1, to contiguous uint32."""
    array = np.asarray(value)
    if array.dtype.kind not in "iu" and array.size:
        raise TypeError("triangles must hold integers")
    if array.ndim != 2 or array.shape[1] != 3:
        raise ValueError(f"triangles must have the shape (M, 3), not {array.shape}")
    if array.size and (array.min() < 0 or array.max() >= count):
        raise ValueError(f"triangles must hold 0 to {count - 1}")
    return np.ascontiguousarray(array, dtype=np.uint32)


def csr(matrix: Any) -> Any:
    """Makes a scipy csr_array, or a `Csr`, of an ffd_csr, whose memory it takes over."""
    owned = Owned(lib.ffd_csr_free, matrix)
    rows, columns = matrix.rows, matrix.columns
    starts = arrays.lent(owned, matrix.starts, (rows + 1,), np.uintp)
    count = int(starts[-1]) if len(starts) else 0
    kind: type[np.signedinteger[Any]] = np.int32 if max(count, rows, columns) < 2**31 else np.int64
    indices = arrays.lent(owned, matrix.indices, (count,), np.int32, writable=True)  # below 2**26, so the sign is never set
    parts = (arrays.lent(owned, matrix.values, (count,), np.float64, writable=True), indices.astype(kind, copy=False),
             starts.astype(kind))
    return sparse(parts, (rows, columns))


def sparse(parts: tuple[np.ndarray, np.ndarray, np.ndarray], shape: tuple[int, int]) -> Any:
    """Makes a scipy csr_array, or a `Csr`, of values, columns and starts."""
    try:
        from scipy.sparse import csr_array  # type: ignore[import-untyped]
    except ImportError:
        return Csr(*parts, shape)
    return csr_array(parts, shape=shape)


def parameters_of(data: bytes, name: str) -> dict[str, Parameter]:
    """The placeholders that the text of a lattice file declares, by name. name: of the file, for messages."""
    return {name: Parameter(name, None if default is None else json.loads(default), unit, comment, finite(least), finite(most))
            for name, default, unit, comment, least, most in library.list_parameters(data, name)}


def parameters(path: Path) -> dict[str, Parameter]:
    """The placeholders that a lattice file declares, by name. They need no values for this."""
    with open(path, "rb") as file:
        return parameters_of(file.read(), os.fspath(path))
