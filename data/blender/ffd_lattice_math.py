# SPDX-License-Identifier: MIT
"""Lattices of Blender and of ffd: the arithmetic of ffd_export.py, ffd_import.py and the extension.

It does not import bpy, so that it is tested without Blender. Arrays of control points have the shape (o, m, n, 3), u fastest, as
both programs keep the points; d is 0, 1, 2 for the directions u, v, w.
"""

import itertools
import json
import math
import sys

import numpy as np

LINEAR, BSPLINE = "KEY_LINEAR", "KEY_BSPLINE"
TENSIONS = {"KEY_CATMULL_ROM": 0.5, "KEY_CARDINAL": 0.71}
TYPES = (LINEAR, "KEY_CARDINAL", "KEY_CATMULL_ROM", BSPLINE)
MOST_POINTS = 64  # of a lattice of Blender, in a direction
MOST_IN_ALL = 32000  # of one: of more it takes fewer, without a word
SIZES_OF_FIT = (4, 8, 16, 32, 64)  # points of Blender's B-splines along a direction that are tried
MAX_DEGREE = 14
TO_Y_UP = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])  # x, y, z to x, z, -y
SKEW = 1e-6  # between the axes of a box, as in a lattice file
EVEN = 1e-12  # of a span: inner knots so near to even ones are even
CLOSE_ENOUGH = 1e-3  # of the box's diagonal: the error of a fit
CHECKS = 3  # places in each span, beside its ends, where the error of a fit is looked for,
LEAST_CHECKS = 24  # and so many parts along each direction at least


class Refused(Exception):
    """What cannot be done, in one line."""


# Blender's lattice to ffd's


def ffd_size(kind, n):
    """The number of control points that a direction of n of Blender's becomes."""
    return 2 if n == 1 else n if kind == LINEAR else n + 4 if kind == BSPLINE else 2 * n + 4


def blends(kind, n):
    """The control points of a direction as sums: of each the indices and the weights of three of Blender's.

    Blender holds indices within 0 to n - 1. Its splines are constant from one cell beyond its points on: its B-splines have knots at
    every point and as far out, its cardinal ones are cubics in each cell, with the Bezier points q_i + m_i / 3 and q_(i+1) - m_(i+1) / 3
    of m_i = tension (q_(i+1) - q_(i-1)).
    """
    count = ffd_size(kind, n)
    indices, weights = np.zeros((count, 3), int), np.zeros((count, 3))
    weights[:, 0] = 1
    if n == 1:
        return indices, weights
    if kind not in TENSIONS:
        indices[:, 0] = np.arange(count) - (0 if kind == LINEAR else 2)
    else:
        indices[0, 0], indices[-1, 0] = -1, n
        third = TENSIONS[kind] / 3
        for c in range(1, count - 1):
            of = (c - 1) // 2 - 1 if c % 2 else c // 2 - 1
            indices[c] = of, of + 1, of - 1
            weights[c, 1:] = (third, -third) if c % 2 else (-third, third)
    return np.clip(indices, 0, n - 1), weights


def blended(offsets, types):
    """The offsets of all control points from Blender's, summed in the order of `ffd lattice convert`, so that bits are equal."""
    for d, kind in enumerate(types):
        axis = 2 - d
        indices, weights = blends(kind, offsets.shape[axis])
        shape = [-1 if a == axis else 1 for a in range(4)]
        terms = [weights[:, t].reshape(shape) * np.take(offsets, indices[:, t], axis) for t in range(3)]
        offsets = terms[0] + terms[1] + terms[2]
    return offsets


def ffd_knots(kind, n):
    """The knots of a direction, as a lattice file has them."""
    if n == 1 or kind == LINEAR:
        return "clamped"
    return "open" if kind == BSPLINE else [-1] * 4 + [i for i in range(n) for _ in range(2)] + [n] * 4


def ffd_degree(kind, n):
    return 1 if n == 1 or kind == LINEAR else 3


def ends(kind, n, first, step):
    """Where a direction begins and ends, in the lattice's own space."""
    beyond = 0.5 if n == 1 else 0.0 if kind == LINEAR else step
    return first - beyond, first + (n - 1) * step + beyond


def box_of(matrix):
    """The axes (rows), scales and the origin's coordinates along them, of the matrix of an object; None for axes that are not
    perpendicular. The rounding of Blender's floats is taken out of the axes: perpendicular ones are so to the last bits."""
    linear = matrix[:3, :3]
    scales = np.sqrt((linear * linear).sum(axis=0))
    for d in range(3):
        if not np.isfinite(scales[d]) or not scales[d] > 0:
            raise Refused(f"has the scale {scales[d]:g} along {'xyz'[d]}")
    axes = (linear / scales).T
    if np.abs(axes @ axes.T - np.eye(3)).max() > SKEW:
        return None
    for _ in range(2):
        axes = (3 * axes - axes @ axes.T @ axes) / 2  # to the nearest perpendicular ones
    return axes, scales, axes @ matrix[:3, 3]


def rest_points(types, size, first, step, matrix):
    """The control points at rest where they are no box: at the Greville abscissae, taken to the world."""
    along = []
    for d, (kind, n) in enumerate(zip(types, size)):
        low, high = ends(kind, n, first[d], step[d])
        abscissae = greville(knot_vector(ffd_knots(kind, n), ffd_size(kind, n), ffd_degree(kind, n)), ffd_degree(kind, n))
        along.append(low + (high - low) * abscissae)
    w, v, u = np.meshgrid(along[2], along[1], along[0], indexing="ij")
    return np.stack([u, v, w], axis=-1) @ matrix[:3, :3].T + matrix[:3, 3]


def lattice_document(types, size, first, step, matrix, offsets, up="z", times=None):
    """A lattice file of a lattice of Blender.

    types, size, first, step: of its directions; its points at rest are first + i step, in its own space
    matrix: (4, 4) to the world
    offsets: of its points from rest, (o, m, n, 3) in its own space, strength included; with times one array for each of them
    up: "z", as in Blender, or "y", as in glTF
    """
    matrix = np.asarray(matrix, float)
    moments = [np.asarray(o, float) for o in (offsets if times is not None else [offsets])]
    if not np.isfinite(matrix).all() or not all(np.isfinite(moment).all() for moment in moments):
        raise Refused("has a number that is not finite")
    turn = TO_Y_UP if up == "y" else np.eye(3)
    placed = box_of(matrix)
    if placed is None:
        points = rest_points(types, size, first, step, matrix) @ turn.T
        rest = {"points": points.reshape(-1, 3).tolist()}
    else:
        axes, scales, origin = placed
        both = [ends(kind, n, first[d], step[d]) for d, (kind, n) in enumerate(zip(types, size))]
        rest = {"box": {"min": [origin[d] + scales[d] * both[d][0] for d in range(3)],
                        "max": [origin[d] + scales[d] * both[d][1] for d in range(3)],
                        "spacing": "greville", "axes": (axes @ turn.T).tolist()}}
    linear = turn @ matrix[:3, :3]
    world = [(blended(moment, types) @ linear.T).reshape(-1, 3).tolist() for moment in moments]
    document = {"format": "ffd-lattice", "version": 1, "size": [ffd_size(kind, n) for kind, n in zip(types, size)],
                "degree": [ffd_degree(kind, n) for kind, n in zip(types, size)],
                "knots": [ffd_knots(kind, n) for kind, n in zip(types, size)], "rest": rest}
    if times is not None:
        document["keys"] = [{"time": float(time), "offsets": moment} for time, moment in zip(times, world)]
    else:
        document.update(deformed={"offsets": world[0]}, moves=[])
    return document


def text_of(value, indent=""):
    """JSON whose numbers read back as the same doubles: a line for each member of an object and for each control point."""
    inner = indent + "  "
    if isinstance(value, dict):
        lines = [f"{inner}{json.dumps(name)}: {text_of(member, inner)}" for name, member in value.items()]
        return "{\n" + ",\n".join(lines) + "\n" + indent + "}"
    if isinstance(value, list) and value and isinstance(value[0], (list, dict)):
        return "[\n" + ",\n".join(inner + text_of(member, inner) for member in value) + "\n" + indent + "]"
    if isinstance(value, list):
        return "[" + ", ".join(text_of(member) for member in value) + "]"
    if isinstance(value, float):
        whole = int(value) if abs(value) < 1e15 and value == int(value) else value
        return repr(whole)
    return json.dumps(value)


# Splines


def knot_vector(knots, n, degree):
    """The knots of a direction of n control points. Raises Refused."""
    if knots in ("clamped",):
        inner = [(i - degree) / (n - degree) for i in range(degree + 1, n)]
        return np.array([0.0] * (degree + 1) + inner + [1.0] * (degree + 1))
    if knots in ("open", "unclamped"):
        return np.array([(i - degree) / (n - degree) for i in range(n + degree + 1)])
    if knots == "uniform":
        return np.array([i / (n + degree) for i in range(n + degree + 1)])
    if knots in ("closed", "periodic") or isinstance(knots, dict):
        raise Refused("has a closed direction, which Blender's lattices have not")
    if not isinstance(knots, list) or len(knots) != n + degree + 1 or not all(is_number(t) for t in knots):
        raise Refused(f"has knots that are not {n + degree + 1} numbers")
    found = np.array(knots, float)
    if (np.diff(found) < 0).any() or not found[n] > found[degree]:
        raise Refused("has knots that fall, or an empty domain")
    inside = found[(found > found[degree]) & (found < found[n])]
    if len(inside) and np.unique(inside, return_counts=True)[1].max() > degree:
        raise Refused(f"has a knot inside its domain that occurs more than {degree} times")
    return found


def greville(knots, degree):
    """The Greville abscissae as fractions of the domain."""
    n = len(knots) - degree - 1
    means = np.array([knots[i + 1:i + degree + 1].sum() / degree for i in range(n)])
    return (means - knots[degree]) / (knots[n] - knots[degree])


def basis(knots, degree, places, slope=False):
    """The basis functions at places within the domain, a row for each; slope: their derivatives too. Cox-de Boor; at the domain's end
    the last span is closed. Knots beyond the domain may be anywhere."""
    n = len(knots) - degree - 1
    spans = np.clip(np.searchsorted(knots, places, side="right") - 1, degree, n - 1)
    while (knots[spans + 1] <= knots[spans]).any():
        spans = np.where(knots[spans + 1] <= knots[spans], spans - 1, spans)
    local, lower = np.ones((len(places), 1)), None
    for p in range(1, degree + 1):
        lower = local
        local = np.zeros((len(places), p + 1))
        for r in range(p):
            left, right = knots[spans + r + 1 - p], knots[spans + r + 1]
            share = lower[:, r] / (right - left)
            local[:, r] += (right - places) * share
            local[:, r + 1] += (places - left) * share
    rows = np.zeros((len(places), n))
    at = spans[:, None] + np.arange(-degree, 1)
    np.put_along_axis(rows, at, local, axis=1)
    if not slope:
        return rows
    steep = np.zeros_like(local)
    for r in range(degree):
        share = degree * lower[:, r] / (knots[spans + r + 1] - knots[spans + r + 1 - degree])
        steep[:, r] -= share
        steep[:, r + 1] += share
    slopes = np.zeros_like(rows)
    np.put_along_axis(slopes, at, steep, axis=1)
    return rows, slopes


def blossom(knots, degree, span, arguments):
    """The blossom of the polynomial in a span, as the weights of all control points: de Boor's triangle with an argument a level
    (Ramshaw 1987)."""
    n = len(knots) - degree - 1
    rows = np.eye(n)[span - degree:span + 1]
    for level, x in enumerate(arguments, 1):
        for k in range(degree, level - 1, -1):
            left, right = knots[span - degree + k], knots[span + 1 + k - level]
            a = (x - left) / (right - left)
            rows[k] = (1 - a) * rows[k - 1] + a * rows[k]
    return rows[degree]


def along(matrix, values, d):
    """Applies a matrix to the control points of direction d."""
    return np.moveaxis(np.tensordot(matrix, values, axes=(1, 2 - d)), 0, 2 - d)


# ffd's lattice to Blender's


def is_number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool) and abs(value) <= sys.float_info.max


def numbers(value, shape, what):
    """An array of a lattice file. Raises Refused."""
    try:
        found = np.array(value)
    except (TypeError, ValueError):  # rows of unequal lengths
        found = np.array("")
    if found.dtype.kind not in "iuf" or found.shape != shape or not np.isfinite(found).all():
        raise Refused(f"has {what} that are not {' x '.join(map(str, shape))} finite numbers")
    return found.astype(float)


class BoxLattice:
    """A lattice file whose rest is a box, and that needs nothing else to be read.

    size, degree, knots; low, high: the box along axes (rows); offsets (o, m, n, 3); at_rest, moved: weights, or None where both are 1
    """

    MEMBERS = {"format", "version", "size", "degree", "knots", "rest", "weights", "deformed", "units", "moves", "parameters", "keys",
               "comment", "name"}

    def __init__(self, text):
        """Reads the text of a lattice file. Raises Refused."""
        of = self._parse(text)
        self._check(of)
        self.size = self._whole(of.get("size"), "size", 2, 2**26)
        if np.prod([float(n) for n in self.size]) > 2**26:
            raise Refused("has more than 67108864 control points")
        self.degree = self._whole(of.get("degree", [min(3, n - 1) for n in self.size]), "degree", 1, MAX_DEGREE)
        for d in range(3):
            if self.degree[d] >= self.size[d]:
                raise Refused(f"has degree {self.degree[d]} and {self.size[d]} control points along {'uvw'[d]}")
        named = of.get("knots", ["clamped"] * 3)
        if not isinstance(named, list) or len(named) != 3:
            raise Refused("has knots that are not three")
        self.knots = [knot_vector(named[d], self.size[d], self.degree[d]) for d in range(3)]
        self._read_box(of["rest"]["box"])
        self._read_points(of)

    @staticmethod
    def _parse(text):
        def refuse(name):
            raise Refused(f"has the number {name}, which is not JSON")
        try:
            of = json.loads(text, parse_constant=refuse)
        except (ValueError, RecursionError) as error:
            raise Refused(f"is not JSON: {error}") from None
        if not isinstance(of, dict) or of.get("format") != "ffd-lattice":
            raise Refused("is not a lattice file of ffd (`ffd lattice convert` makes one of other formats)")
        if of.get("version") != 1:
            raise Refused(f"is of version {of.get('version')}, not 1")
        return of

    @classmethod
    def _check(cls, of):
        """Refuses what changes the lattice and is not read here."""
        unknown = sorted(set(of) - cls.MEMBERS)
        if unknown:
            raise Refused(f'has the unknown member "{unknown[0]}"')
        if of.get("keys"):
            raise Refused("has keys: `ffd lattice convert --time T` writes one moment")
        if of.get("moves"):
            raise Refused("has moves: `ffd lattice convert` writes their result")
        rest = of.get("rest")
        if not isinstance(rest, dict) or "box" not in rest:
            raise Refused("is not a box at rest, as Blender's lattices are")
        if not isinstance(rest["box"], dict) or "meshes" in rest["box"]:
            raise Refused("has a box round a mesh: `ffd lattice convert --mesh MESH` lays it")

    @staticmethod
    def _whole(value, what, least, most):
        if not isinstance(value, list) or len(value) != 3 or not all(is_number(n) and n == int(n) and least <= n <= most for n in value):
            raise Refused(f"has a {what} that is not three whole numbers from {least} to {most}")
        return [int(n) for n in value]

    def _read_box(self, box):
        self.low, self.high = (numbers(box.get(name), (3,), f'"{name}" of the box') for name in ("min", "max"))
        if not (self.high > self.low).all():
            raise Refused('has a box whose "max" is not above "min"')
        self.axes = numbers(box.get("axes", np.eye(3)), (3, 3), "axes of the box")
        if np.abs(self.axes @ self.axes.T - np.eye(3)).max() > SKEW:
            raise Refused("has axes of the box that are not perpendicular unit vectors")
        spacing = box.get("spacing", "greville")
        if spacing not in ("greville", "uniform"):
            raise Refused(f'has the spacing "{spacing}"')
        self.is_even = spacing == "uniform"
        for d in range(3):
            t, p = self.knots[d], self.degree[d]
            if self.is_even and (t[0] < t[p] or t[-1] > t[-1 - p]):
                raise Refused("has evenly spaced control points and knots that are not clamped")
        # Where the control points rest, as fractions of the box.
        self.places = [np.linspace(0, 1, n) if self.is_even else greville(t, p) for n, t, p in zip(self.size, self.knots, self.degree)]

    def _read_points(self, of):
        shape = tuple(self.size[::-1]) + (3,)
        count = int(np.prod(self.size))
        deformed = of.get("deformed", {})
        if not isinstance(deformed, dict):
            raise Refused('has a "deformed" that is no object')
        if "offsets" in deformed:
            self.offsets = numbers(deformed["offsets"], (count, 3), "offsets").reshape(shape)
        elif "points" in deformed:
            self.offsets = numbers(deformed["points"], (count, 3), "deformed points").reshape(shape) - self.rest()
        else:
            self.offsets = np.zeros(shape)
        at_rest = numbers(of.get("weights", np.ones(count)), (count,), "weights").reshape(shape[:3])
        moved = numbers(deformed["weights"], (count,), "deformed weights").reshape(shape[:3]) if "weights" in deformed else at_rest
        if not (at_rest > 0).all() or not (moved > 0).all():
            raise Refused("has a weight that is not above 0")
        is_plain = (at_rest == at_rest.flat[0]).all() and (moved == moved.flat[0]).all()
        self.at_rest, self.moved = (None, None) if is_plain else (at_rest, moved)
        for d in range(3):
            t, p = self.knots[d], self.degree[d]
            if not (at_rest == at_rest.flat[0]).all() and (t[0] < t[p] or t[-1] > t[-1 - p]):
                raise Refused("has weights and knots that are not clamped: its volume is not the box")

    def rest(self):
        """The control points at rest, in the world."""
        sides = [self.low[d] + self.places[d] * (self.high[d] - self.low[d]) for d in range(3)]
        w, v, u = np.meshgrid(sides[2], sides[1], sides[0], indexing="ij")
        return np.stack([u, v, w], axis=-1) @ self.axes

    def parameters(self, d, fractions):
        """u, v or w at fractions of the box's side, of a lattice without weights. With evenly spaced control points it is found by
        bisection: the side grows with the parameter."""
        t, p, n = self.knots[d], self.degree[d], self.size[d]
        if not self.is_even:
            return t[p] + (t[n] - t[p]) * fractions
        low, high = np.full(len(fractions), t[p]), np.full(len(fractions), t[n])
        for _ in range(60):
            middle = (low + high) / 2
            is_below = basis(t, p, middle) @ self.places[d] < fractions
            low, high = np.where(is_below, middle, low), np.where(is_below, high, middle)
        return (low + high) / 2

    def displacements(self, fractions):
        """The displacements at all places of a grid: three arrays of fractions of the box's sides."""
        if self.at_rest is not None:
            return self._rational(fractions)
        values = self.offsets
        for d in range(3):
            values = along(basis(self.knots[d], self.degree[d], self.parameters(d, fractions[d])), values, d)
        return values

    def _rational(self, fractions):
        """The same with weights: the volume at rest is inverted by Newton's method, layer by layer of w."""
        w, v, u = np.meshgrid(*fractions[::-1], indexing="ij")
        places = np.stack([u, v, w], axis=-1).reshape(-1, 3)
        rest = np.stack(np.meshgrid(*self.places[::-1], indexing="ij")[::-1], axis=-1)
        deformed = self.rest() + self.offsets
        values = np.concatenate([self.at_rest[..., None] * rest, self.at_rest[..., None], self.at_rest[..., None] * self.rest(),
                                 self.moved[..., None] * deformed, self.moved[..., None]], axis=-1)
        tile = max(1, 2**22 // (8 * self.size[0] * self.size[1]))
        found = [self._moved(values, places[i:i + tile]) for i in range(0, len(places), tile)]
        return np.concatenate(found).reshape(w.shape + (3,))

    def _moved(self, values, places):
        begin = np.array([t[p] for t, p in zip(self.knots, self.degree)])
        end = np.array([t[n] for t, n in zip(self.knots, self.size)])
        at = begin + (end - begin) * places
        for _ in range(60):
            f, slopes = self._evaluate(values[..., :4], at, True)
            x = f[:, :3] / f[:, 3:]
            missing = places - x
            if np.abs(missing).max() < 1e-13:
                break
            jacobian = (slopes[..., :3] - x[:, None] * slopes[..., 3:]) / f[:, None, 3:]
            step = np.linalg.solve(jacobian.transpose(0, 2, 1), missing[..., None])[..., 0]
            # Steps are held to a quarter of the domain.
            size = (np.abs(step) / (end - begin)).max(axis=1, keepdims=True)
            at = np.clip(at + step * np.minimum(1, 0.25 / np.maximum(size, 1e-300)), begin, end)
        else:
            if np.abs(missing).max() > 1e-9:
                raise Refused("has weights at which no u, v, w was found for a place of its box")
        both = self._evaluate(values[..., 3:], at, False)
        return both[:, 4:7] / both[:, 7:8] - both[:, 1:4] / both[:, 0:1]

    def _evaluate(self, values, at, slopes):
        """Sums of control points over the basis functions, and their derivatives by u, v, w."""
        rows = [basis(self.knots[d], self.degree[d], at[:, d], True) for d in range(3)]
        def sums(u, v, w):
            total = np.zeros((len(at), values.shape[-1]))
            for k in range(self.size[2]):
                if not w[:, k].any():
                    continue
                layer = np.einsum("pj,jic,pi->pc", v, values[k], u, optimize=True)
                total += w[:, k, None] * layer
            return total
        plain = sums(*(row[0] for row in rows))
        if not slopes:
            return plain
        return plain, np.stack([sums(*(row[e == d] for e, row in enumerate(rows))) for d in range(3)], axis=1)


def is_uniform(knots, degree):
    """Whether the knots within the domain are simple and even."""
    inner = knots[degree:len(knots) - degree]
    steps = np.diff(inner)
    return bool((np.abs(steps - steps.mean()) <= EVEN * steps.mean() * len(steps)).all())


def exact_direction(knots, degree):
    """A direction of Blender that has the same splines: (type, points, matrix to Blender's points), or None."""
    n = len(knots) - degree - 1
    spans = n - degree
    is_clamped = knots[0] == knots[degree] and knots[-1] == knots[n]
    if degree == 1 and is_clamped and is_uniform(knots, degree) and n <= MOST_POINTS:
        return LINEAR, n, np.eye(n)
    if degree != 3 or not is_uniform(knots, degree) or spans + 3 > MOST_POINTS:
        return None
    step = (knots[n] - knots[degree]) / spans
    rows = []
    for i in range(spans + 3):
        span = min(max(i - 1, 0), spans - 1) + degree
        rows.append(blossom(knots, degree, span, [knots[degree] + (i - 2 + r) * step for r in range(3)]))
    return BSPLINE, spans + 3, np.array(rows)


def even_knots(n):
    """The knots of n points of Blender's B-splines, with 0 to 1 between the second and the last but one."""
    return (np.arange(n + 4) - 3) / (n - 3)


def fit_sites(n):
    """Places that determine n points of Blender's B-splines: the Greville abscissae of clamped knots, all within the box."""
    return greville(knot_vector("clamped", n, 3), 3)


def fitted(lattice, size):
    """The points of a grid of Blender's B-splines that has the lattice's displacements at as many places."""
    sites = [fit_sites(n) for n in size]
    values = lattice.displacements(sites)
    for d in range(3):
        values = along(np.linalg.inv(basis(even_knots(size[d]), 3, sites[d])), values, d)
    return values


def check_sites(lattice, d, n):
    """Places along a direction where the error of a fit by n points is looked for: in each span of either, and at its ends."""
    t, p = lattice.knots[d], lattice.degree[d]
    breaks = basis(t, p, np.unique(t[p:lattice.size[d] + 1])) @ lattice.places[d]
    breaks = np.unique(np.clip(np.concatenate([breaks, np.linspace(0, 1, n - 2)]), 0, 1))
    parts = max(CHECKS + 1, math.ceil(LEAST_CHECKS / (len(breaks) - 1)))
    inner = np.arange(parts) / parts
    return np.append((breaks[:-1, None] + np.diff(breaks)[:, None] * inner).ravel(), 1.0)


def largest_error(lattice, size, values):
    """The largest difference of a fit from the lattice, layer by layer of w."""
    sites = [check_sites(lattice, d, size[d]) for d in range(3)]
    rows = [basis(even_knots(size[d]), 3, sites[d]) for d in range(3)]
    across = along(rows[1], along(rows[0], values, 0), 1)
    worst = 0.0
    for i in range(0, len(sites[2]), 8):
        found = along(rows[2][i:i + 8], across, 2)
        wanted = lattice.displacements([sites[0], sites[1], sites[2][i:i + 8]])
        worst = max(worst, float(np.sqrt(((found - wanted) ** 2).sum(axis=-1)).max()))
    return worst


def error_along(lattice, d, n):
    """The error of a fit by n points along one direction alone, at the places of the lattice's points along the others."""
    places = [np.clip(lattice.places[a], 0, 1) for a in range(3)]
    checked = [check_sites(lattice, d, n) if a == d else places[a] for a in range(3)]
    fit = [fit_sites(n) if a == d else places[a] for a in range(3)]
    points = np.linalg.inv(basis(even_knots(n), 3, fit[d]))
    found = along(basis(even_knots(n), 3, checked[d]) @ points, lattice.displacements(fit), d)
    return float(np.sqrt(((found - lattice.displacements(checked)) ** 2).sum(axis=-1)).max())


def size_of_fit(lattice, tolerance):
    """As many points along each direction as a third of the tolerance needs there, 4 doubled again and again; at most as many in all
    as Blender takes."""
    size = []
    for d in range(3):
        errors = {}
        for n in SIZES_OF_FIT:
            errors[n] = error_along(lattice, d, n)
            if errors[n] <= tolerance / 3:
                break
        size.append(n if errors[n] <= tolerance / 3 else min(errors, key=errors.get))
    while math.prod(size) > MOST_IN_ALL:
        size[size.index(max(size))] //= 2
    return size


class BlenderLattice:
    """What a lattice object of Blender is to have.

    types, size: of its directions; offsets: (o, m, n, 3) of its points, in the world
    low, high: its first and last points along axes (rows)
    is_exact: whether it is the lattice's own splines; else error is the largest difference from it within the box
    """

    def __init__(self, lattice, size=None, up="z"):
        """Of a BoxLattice. size: of the points of a fit; None: as many as it needs. up: of the lattice file. Raises Refused."""
        exact = [exact_direction(t, p) for t, p in zip(lattice.knots, lattice.degree)]
        self.is_exact = lattice.at_rest is None and not lattice.is_even and all(exact) and math.prod(e[1] for e in exact) <= MOST_IN_ALL
        self.error = 0.0
        if self.is_exact:
            self.types, self.size = [e[0] for e in exact], [e[1] for e in exact]
            self.offsets = lattice.offsets
            for d in range(3):
                self.offsets = along(exact[d][2], self.offsets, d)
        else:
            self.types = [BSPLINE] * 3
            self._fit(lattice, size)
        sides = lattice.high - lattice.low
        beyond = [0.0 if kind == LINEAR else sides[d] / (self.size[d] - 3) for d, kind in enumerate(self.types)]
        self.low, self.high = lattice.low - beyond, lattice.high + beyond
        turn = TO_Y_UP.T if up == "y" else np.eye(3)
        self.axes = lattice.axes @ turn.T
        self.offsets = self.offsets @ turn.T

    def _fit(self, lattice, size):
        diagonal = float(np.sqrt(((lattice.high - lattice.low) ** 2).sum()))
        self.size = list(size or size_of_fit(lattice, CLOSE_ENOUGH * diagonal))
        self.offsets = fitted(lattice, self.size)
        self.error = largest_error(lattice, self.size, self.offsets)

    def placed(self, first, last):
        """The matrix of the object whose points at rest go from first to last, and the offsets in its own space."""
        first, last = np.asarray(first, float), np.asarray(last, float)
        scales = (self.high - self.low) / (last - first)
        matrix = np.eye(4)
        matrix[:3, :3] = self.axes.T * scales
        matrix[:3, 3] = self.axes.T @ (self.low - scales * first)
        return matrix, (self.offsets @ self.axes.T) / scales


def checked_size(text):
    """The --size of a fit, "8,8,8" or one number for all. Raises Refused."""
    words = text.split(",")
    if len(words) not in (1, 3) or not all(word.strip().isdigit() and SIZES_OF_FIT[0] <= int(word) <= MOST_POINTS for word in words):
        raise Refused(f'size "{text}" is not n,m,o with whole numbers from 4 to {MOST_POINTS}')
    size = [int(word) for word in words] * (3 if len(words) == 1 else 1)
    if math.prod(size) > MOST_IN_ALL:
        raise Refused(f'size "{text}" has {math.prod(size)} points, and a lattice of Blender at most {MOST_IN_ALL}')
    return size


def file_name(object_name, modifier_name, taken):
    """A name for the lattice file of a modifier that is not in taken (of names in small letters), to which it is added."""
    stem = "".join("_" if c in '/\\:*?"<>|' or ord(c) < 32 or ord(c) == 127 else c for c in f"{object_name}-{modifier_name}")
    stem = "_" + stem[1:] if stem.startswith(".") else stem
    for number in itertools.count(1):
        name = f"{stem}.json" if number == 1 else f"{stem}-{number}.json"
        if name.casefold() not in taken:
            taken.add(name.casefold())
            return name
