"""The class `FFD` of PyGeM, for scripts that were written for it: its box, its weights and its files, deformed by this library.

    from ffd_mesh.pygem import FFD

in place of `from pygem import FFD`. data/python.md says what differs. `FFD.lattice` leads to the rest of ffd_mesh.
"""

from __future__ import annotations

import configparser
import contextlib
import copy
import math
import os
import secrets
from typing import Any, Callable, NamedTuple

import numpy as np

from . import __version__
from . import _arrays as arrays
from . import _library as library
from ._errors import InvalidError, UnsupportedError
from ._lattice import Lattice
from ._values import three

__all__ = ["FFD", "__version__"]

_AT_ONCE = 1 << 16  # points, whose places in the lattice are held: fresh memory for those of all costs more than to find them
_MOST = 15  # control points along a direction, whose degree is one less
_BOX, _WEIGHTS = "Box info", "Parameters weights"
_AXES = "xyz"
_MAPS = ("psi", "inverse_psi", "T", "position_vertices", "reference_frame")  # what a subclass may replace
# What PyGeM has beside FFD.
_ABSENT = {
    "BFFD", "CADDeformation", "CFFD", "CustomDeformation", "Deformation", "ElmerHandler", "FileHandler", "IDW", "IgesHandler",
    "KHandler", "MdpaHandler", "NurbsHandler", "OpenFoamHandler", "RBF", "RBFFactory", "StepHandler", "StlHandler", "UnvHandler",
    "VFFD", "VtkHandler", "cad",
}


def __getattr__(name: str) -> Any:
    if name in _ABSENT:
        raise ImportError(f"ffd_mesh.pygem offers FFD, not {name}: ffd_mesh.fit finds the lattice that carries points where they are "
                          "wanted, ffd_mesh.deform_file deforms meshes in files")
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


class _Box(NamedTuple):
    """What an FFD holds, checked. mu: (nx, ny, nz, 3)."""

    counts: tuple[int, int, int]
    lengths: np.ndarray
    origin: np.ndarray
    angles: np.ndarray
    mu: np.ndarray


class FFD:
    """A box of control points whose displacements deform the points inside, by Bernstein polynomials: PyGeM's class.

    n_control_points: along the three sides, each 1 to 15; None: [2, 2, 2]
    A point x = R diag(box_length) t + box_origin with t in [0, 1]^3 goes to x + R diag(box_length) sum mu_ijk b_i(t_x) b_j(t_y)
    b_k(t_z), where R is `rotation_matrix` and b the Bernstein polynomials of degree n - 1. Other points stay, to the bit.

    box_length, box_origin, rot_angle: three numbers each; a length may be negative; angles in degrees
    array_mu_x, array_mu_y, array_mu_z: displacements of the control points along the sides, in box lengths; of the shape
      n_control_points. With one control point along a side, displacements do not depend on the place along it
    conversion_unit: 1, unused
    Values are checked where they are used: a length of 0, numbers that are not finite and another shape raise ValueError, more
    than 15 control points along a side `UnsupportedError`. Can be copied and pickled.
    Sederberg and Parry, Free-form deformation of solid geometric models, 1986.
    """

    reference_frame: np.ndarray = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])

    array_mu_x: np.ndarray
    array_mu_y: np.ndarray
    array_mu_z: np.ndarray

    def __init__(self, n_control_points: Any = None) -> None:
        self.conversion_unit = 1.0
        self.box_length: Any = np.ones(3)
        self.box_origin: Any = np.zeros(3)
        self.rot_angle: Any = np.zeros(3)
        self.n_control_points = [2, 2, 2] if n_control_points is None else n_control_points

    # -- the box

    @property
    def n_control_points(self) -> np.ndarray:
        """The numbers of control points along the three sides. Setting them makes all weights 0."""
        return self._n_control_points

    @n_control_points.setter
    def n_control_points(self, value: Any) -> None:
        """Sets the numbers, and arrays of zeros of that shape."""
        counts = _counts(value)
        self._n_control_points = np.array(counts)
        self.array_mu_x, self.array_mu_y, self.array_mu_z = (np.zeros(counts) for _ in _AXES)

    @property
    def rotation_matrix(self) -> np.ndarray:
        """R = Rx Ry Rz of `rot_angle`, right-handed: its columns are the directions of the sides."""
        (sx, cx), (sy, cy), (sz, cz) = map(_sine_and_cosine, _finite(self.rot_angle, "rot_angle", (3,)).tolist())
        return np.array([[cy * cz, -cy * sz, sy],
                         [cx * sz + sx * sy * cz, cx * cz - sx * sy * sz, -sx * cy],
                         [sx * sz - cx * sy * cz, sx * cz + cx * sy * sz, cx * cy]]) + 0.0  # no -0

    @property
    def position_vertices(self) -> np.ndarray:
        """The origin of the box and the ends of the three sides that begin there, (4, 3)."""
        sides = (self.rotation_matrix * _finite(self.box_length, "box_length", (3,))).T
        return _finite(self.box_origin, "box_origin", (3,)) + np.vstack([np.zeros(3), sides])

    @property
    def psi(self) -> Callable[[np.ndarray], np.ndarray]:
        """The function that maps places relative to `box_origin`, (N, 3), to the unit cube."""
        self._checked()
        return _affine(self.position_vertices - self.box_origin, self.reference_frame)

    @property
    def inverse_psi(self) -> Callable[[np.ndarray], np.ndarray]:
        """The function that maps the unit cube, (N, 3), to places relative to `box_origin`."""
        self._checked()
        return _affine(self.reference_frame, self.position_vertices - self.box_origin)

    @property
    def T(self) -> Callable[[np.ndarray], np.ndarray]:
        """The function that deforms points of the unit cube, (N, 3). Outside of it the polynomials go on."""
        box = self._checked()

        def deformed(points: np.ndarray) -> np.ndarray:
            """The points, moved by the weights."""
            t = np.asarray(points, np.float64)
            x, y, z = (_bernstein(t[:, a], n) for a, n in enumerate(box.counts))
            shift = np.zeros(t.shape)
            for i, j in np.ndindex(box.counts[:2]):
                shift += (x[:, i] * y[:, j])[:, None] * np.einsum("nk,kc->nc", z, box.mu[i, j])
            return t + shift
        return deformed

    @property
    def lattice(self) -> Lattice:
        """The same map as an `ffd_mesh.Lattice`, for `folds()`, `save(path)`, `deform_mesh` and the like. Not in PyGeM.

        A direction of one control point has two layers there, which move alike.
        """
        box = self._checked()
        directions = self.rotation_matrix.T
        axes = np.where(box.lengths < 0, -1.0, 1.0)[:, None] * directions
        low = (axes * box.origin).sum(axis=1)
        offsets = sum(box.mu[..., a, None] * box.lengths[a] * directions[a] for a in range(3))
        for a, count in enumerate(box.counts):
            offsets = np.repeat(offsets, 2, axis=a) if count == 1 else offsets
        size = [max(count, 2) for count in box.counts]
        rest = Lattice.box(low, low + abs(box.lengths), size, [n - 1 for n in size], knots="clamped", axes=axes)
        return rest.moved(offsets=offsets)

    def control_points(self, deformed: bool = True) -> np.ndarray:
        """The control points, (n, 3), the last index fastest. deformed: False: at rest."""
        box = self._checked()
        grids = np.meshgrid(*map(np.linspace, np.zeros(3), box.lengths, box.counts), indexing="ij")
        along = (np.stack(grids, axis=-1) + (box.mu * box.lengths if deformed else 0)).reshape(-1, 3)
        return np.einsum("nc,rc->nr", along, self.rotation_matrix) + box.origin

    def fit_to_points(self, points: Any, margin: Any = 0) -> None:
        """Lays the box round points (N, 3), along the directions of `rot_angle`: sets `box_origin` and `box_length`, which become
        positive; weights stay. Points that are not finite are ignored. Not in PyGeM.

        margin: fraction of the extent that is added on both sides: one value, or three
        """
        found = _floats(points)
        found = found[np.isfinite(found).all(axis=1)].astype(np.float64)
        if not len(found):
            raise ValueError("points has no finite point")
        margins = np.array([library.real(value, "margin") for value in three(margin, "margin")])
        if not (np.isfinite(margins) & (margins >= 0)).all():
            raise ValueError(f"margin must be at least 0, not {margin}")
        turned = np.einsum("nr,rc->nc", found, self.rotation_matrix)
        low, high = turned.min(axis=0), turned.max(axis=0)
        low, high = low - margins * (high - low), high + margins * (high - low)
        for a, letter in enumerate(_AXES):
            if not low[a] < high[a]:
                raise ValueError(f"the box would have no length along {letter}: all points are at {low[a]:g} there")
        self.box_origin, self.box_length = np.einsum("rc,c->r", self.rotation_matrix, low), high - low

    # -- the weights

    def reset_weights(self) -> None:
        """Sets all weights to 0."""
        for letter in _AXES:
            getattr(self, f"array_mu_{letter}").fill(0)

    def reflect(self, axis: int = 0, in_place: bool = True) -> FFD | None:
        """Appends the mirror image along axis (0, 1 or 2), across the side of the box that is opposite to the origin: the box is
        twice as long and has 2 n - 1 control points there. Weights keep their values, which along axis are then in lengths twice
        as great; those of the image have the other sign along axis.

        in_place: False: change nothing, and return a new object
        Raises RuntimeError where a control point of that side is displaced along axis.
        """
        if axis not in (0, 1, 2):
            raise ValueError(f"axis must be 0, 1 or 2, not {axis}")
        box = self._checked()
        side = tuple(slice(-1, None) if a == axis else slice(None) for a in range(3))
        if box.mu[side][..., axis].any():
            raise RuntimeError(f"control points of the mirror plane are displaced along axis {axis}")
        doubled = [2 * n - 1 if a == axis else n for a, n in enumerate(box.counts)]
        image = np.flip(box.mu, axis)[tuple(slice(1, None) if a == axis else slice(None) for a in range(3))]
        image = image * np.where(np.arange(3) == axis, -1.0, 1.0)
        found = self if in_place else copy.deepcopy(self)
        found.n_control_points = doubled
        found.box_length = box.lengths * np.where(np.arange(3) == axis, 2.0, 1.0)
        found._set_mu(np.concatenate([box.mu, image], axis=axis))
        return None if in_place else found

    # -- files

    def read_parameters(self, filename: str | os.PathLike[str] = "parameters.prm") -> None:
        """Reads a parameter file of PyGeM (data/schema/lattice.md 12), its numbers to the bit. Weights that are not there are 0.

        Raises FileNotFoundError where there is none, and `InvalidError`; nothing is changed then.
        """
        parser = configparser.RawConfigParser()
        with open(os.fspath(filename), encoding="utf-8-sig", errors="replace") as file:
            try:
                parser.read_file(file)
                box = _box_of(parser)
            except (configparser.Error, ValueError) as error:
                raise InvalidError(" ".join(str(error).split()), file=os.fsdecode(filename)) from error
            except UnsupportedError as error:
                raise UnsupportedError(error.message, file=os.fsdecode(filename)) from None
        self.n_control_points = box.counts
        self.box_length, self.box_origin, self.rot_angle = box.lengths, box.origin, box.angles
        self._set_mu(box.mu)

    def write_parameters(self, filename: str | os.PathLike[str] = "parameters.prm") -> None:
        """Writes a parameter file, completely or not at all, which PyGeM and `Lattice.load` read too. Numbers have the digits that
        read back to the same bits. An existing file is replaced."""
        box = self._checked()
        lines = [f"[{_BOX}]"]
        for name, values in (("n control points", box.counts), ("box length", box.lengths.tolist()),
                             ("box origin", box.origin.tolist()), ("rotation angle", box.angles.tolist())):
            lines += [f"{name} {letter}: {value!r}" for letter, value in zip(_AXES, values)] + [""]
        lines.append(f"[{_WEIGHTS}]")
        for a, letter in enumerate(_AXES):
            before = f"parameter {letter}: "
            for i, j, k in np.ndindex(box.counts):
                lines.append(f"{before}{i} {j} {k} {box.mu[i, j, k, a].item()!r}")
                before = " " * len(before)
            lines.append("")
        _write_whole(os.fspath(filename), "\n".join(lines))

    # -- deformation

    def __call__(self, points: Any) -> np.ndarray:
        """Returns the points (N, 3) deformed, as a new array: float32 for float32, float64 for float64 and for whole numbers.

        What misses the box by no more than the rounding of its coordinates is inside, at the border.
        """
        array = _floats(points)
        if any(getattr(type(self), name) is not getattr(FFD, name) for name in _MAPS):
            return self._by_its_maps(array)
        lattice, box = self.lattice, self._checked()
        # A few roundings of the largest coordinates there are in the box, or would be if it was turned.
        snap = 8 * np.finfo(float).eps * float(np.linalg.norm(box.origin) + np.linalg.norm(box.lengths))
        out = np.empty(array.shape, array.dtype)
        for first in range(0, len(array), _AT_ONCE):
            some = slice(first, first + _AT_ONCE)
            lattice.deform(lattice.embed(array[some], snap=snap), out=out[some])
        return out

    def __str__(self) -> str:
        names = ("conversion_unit", "n_control_points", "box_length", "box_origin", "rot_angle", "array_mu_x", "array_mu_y",
                 "array_mu_z", "rotation_matrix", "position_vertices")
        lines = []
        for name in names:
            text = str(getattr(self, name))
            lines.append(name + (" =\n" if "\n" in text else " = ") + text)
        return "\n".join(lines)

    # -- internal

    def _checked(self) -> _Box:
        counts = _counts(self.n_control_points)
        lengths = _finite(self.box_length, "box_length", (3,))
        if not lengths.all():
            raise ValueError(f"box_length must not have a 0: {lengths.tolist()}")
        mu = [_finite(getattr(self, f"array_mu_{letter}"), f"array_mu_{letter}", counts) for letter in _AXES]
        return _Box(counts, lengths, _finite(self.box_origin, "box_origin", (3,)), _finite(self.rot_angle, "rot_angle", (3,)),
                    np.stack(mu, axis=-1))

    def _set_mu(self, mu: np.ndarray) -> None:
        self.array_mu_x, self.array_mu_y, self.array_mu_z = (np.ascontiguousarray(mu[..., a]) for a in range(3))

    def _by_its_maps(self, points: np.ndarray) -> np.ndarray:
        """Of a subclass that replaces one of the maps."""
        t = self.psi(points - self.box_origin)
        inside = ((t >= 0) & (t <= 1)).all(axis=1)
        out = points.copy()
        out[inside] = self.inverse_psi(self.T(t[inside])) + self.box_origin
        return out


def _counts(value: Any) -> tuple[int, int, int]:
    """Three numbers of control points."""
    if len(value) != 3:
        raise ValueError(f"n_control_points must be three numbers, not {len(value)}")
    counts = tuple(library.integer(count, "n_control_points", -2**63, 2**63) for count in value)
    if min(counts) < 1:
        raise ValueError(f"n_control_points must be at least 1, not {min(counts)}")
    if max(counts) > _MOST:
        raise UnsupportedError(f"{max(counts)} control points are Bernstein polynomials of degree {max(counts) - 1}; "
                               f"degrees to {_MOST - 1} ({_MOST} control points) are supported")
    return counts  # type: ignore[return-value]


def _finite(value: Any, what: str, shape: tuple[int, ...]) -> np.ndarray:
    array = arrays.doubles(value, what, shape)
    if not np.isfinite(array).all():
        raise ValueError(f"{what} must have finite numbers")
    return array


def _floats(points: Any) -> np.ndarray:
    """Points as float32 or float64 of this machine; whole numbers become float64."""
    array = points if isinstance(points, np.ndarray) else np.asarray(points)
    if array.dtype.kind in "iu":
        array = array.astype(np.float64)
    elif array.dtype.kind == "f" and not array.dtype.isnative:
        array = array.astype(array.dtype.newbyteorder("="))
    return arrays.vectors(array, "points")


def _sine_and_cosine(degrees: float) -> tuple[float, float]:
    """Exact for multiples of 90 degrees."""
    rest = math.remainder(degrees, 90.0)
    quarter = round(math.remainder(degrees - rest, 360.0) / 90.0) % 4
    sine, cosine = math.sin(math.radians(rest)), math.cos(math.radians(rest))
    return ((sine, cosine), (cosine, -sine), (-sine, -cosine), (-cosine, sine))[quarter]


def _affine(start: np.ndarray, end: np.ndarray) -> Callable[[np.ndarray], np.ndarray]:
    """The affine map of four points, (4, 3), to four others."""
    matrix = np.linalg.solve(start[1:] - start[0], end[1:] - end[0])

    def mapped(points: np.ndarray) -> np.ndarray:
        """Their images."""
        return np.einsum("...r,rc->...c", points - start[0], matrix) + end[0]
    return mapped


def _bernstein(t: np.ndarray, count: int) -> np.ndarray:
    """The Bernstein polynomials of degree count - 1 at t (N,), (N, count)."""
    return np.stack([math.comb(count - 1, i) * t ** i * (1 - t) ** (count - 1 - i) for i in range(count)], axis=1)


def _box_of(parser: configparser.RawConfigParser) -> _Box:
    """What a parameter file says, checked."""
    def three_of(name: str) -> list[float]:
        """The numbers of a key, for x, y and z."""
        return [parser.getfloat(_BOX, f"{name} {letter}") for letter in _AXES]
    counts = three_of("n control points")
    if not all(count.is_integer() for count in counts):
        raise ValueError(f"{counts} are not numbers of control points")
    found = FFD([int(count) for count in counts])
    found.box_length, found.box_origin, found.rot_angle = map(three_of, ("box length", "box origin", "rotation angle"))
    for letter in _AXES:
        for line in parser.get(_WEIGHTS, f"parameter {letter}", fallback="").splitlines():
            if words := line.split():
                index, weight = _weight_of(words, found.n_control_points.tolist(), letter)
                getattr(found, f"array_mu_{letter}")[index] = weight
    return found._checked()


def _weight_of(words: list[str], counts: list[int], letter: str) -> tuple[tuple[int, ...], float]:
    """The indices and the number in a line of weights."""
    try:
        index, weight = tuple(map(int, words[:3])), float(words[3])
    except (ValueError, IndexError):
        index, weight = (), math.nan
    if len(words) != 4 or not math.isfinite(weight):
        raise ValueError(f"parameter {letter}: {' '.join(words)!r} is not three indices and a finite number")
    for i, count in zip(index, counts):
        if not 0 <= i < count:
            raise ValueError(f"parameter {letter}: {i} is not an index below {count}")
    return index, weight


def _write_whole(path: str | bytes, text: str) -> None:
    """Writes a file beside the path, and then gives it that name. What is not a file, such as a device, is written to."""
    if os.path.exists(path) and not os.path.isfile(path):
        with open(path, "w", encoding="ascii", newline="\n") as file:
            file.write(text)
        return
    path = os.path.realpath(os.fsdecode(path))
    part = f"{path}.{secrets.token_hex(6)}"
    try:
        with open(part, "x", encoding="ascii", newline="\n") as file:
            file.write(text)
        os.replace(part, path)
    except BaseException:
        with contextlib.suppress(OSError):
            os.unlink(part)
        raise
