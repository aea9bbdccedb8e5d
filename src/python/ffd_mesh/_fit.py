"""The lattice that carries points where they are wanted, as `ffd fit` finds it."""

from __future__ import annotations

import ctypes
import math
from typing import Any, Literal, Mapping, NamedTuple, Sequence

import numpy as np

from . import _arrays as arrays
from . import _declarations as declared
from . import _library as library
from ._description import AnyLattice, Path, set_lattice
from ._errors import Error, GateError
from ._lattice import Lattice
from ._library import Progress, Run, lib
from ._types import Counts, Degrees, Direction, Doubles, Indices, Isa, KnotWords, Numbers, Row, Rows, Space, Texts, Triangles
from ._values import direction_of, finite, settings, shape_of, three, triangles_of


class Fit(NamedTuple):
    """What `fit` has found."""

    lattice: Lattice
    report: dict[str, Any]  # the member `fit` of the report (data/schema/formats.md): pairs, used, residual, smooth, folds, ..
    residuals: Doubles  # (N,) how far each source ends from its target; NaN: it is not used


class FittedFile(NamedTuple):
    """What `fit_file` has done."""

    report: dict[str, Any]  # as of `Fit`
    seconds: dict[str, float]
    warnings: list[str]


def _folds(found: Any) -> dict[str, Any]:
    """An ffd_folds as the report has it."""
    at = found.witness
    witness = {"lattice": at.lattice, "uvw": list(at.uvw), "xyz": list(at.xyz), "rest": list(at.rest), "det": at.det} if at.is_there else None
    return {"verdict": library.NAMES["ffd_fold_verdict"][found.verdict], "cells": found.cells, "min_det": finite(found.min_det),
            "relative_to": library.NAMES["ffd_fold_reference"][found.relative_to], "folded_cells": found.folded_cells,
            "unknown_cells": found.unknown_cells, "witness": witness}


def _report(found: Any, robust: bool) -> dict[str, Any]:
    """An ffd_fit_result as the report has it."""
    counts = ("pairs", "used", "outside", "multiple", "singular", "exact", "dependent")
    affine = list(found.affine)
    return {
        **{name: getattr(found, name) for name in counts},
        "smooth": found.smooth, "smooth_chosen_by": lib.ffd_fit_choice_name(found.smooth_chosen_by).decode(), "gcv": finite(found.gcv),
        "affine": [affine[3 * row:3 * row + 3] for row in range(4)],
        "residual": {"max": found.residual_max, "rms": found.residual_rms, "p95": found.residual_p95, "worst": found.worst},
        "residual_exact": finite(found.residual_exact), "largest_offset": found.largest_offset,
        "points_without_data": found.points_without_data, "folds": _folds(found.folds),
        "downweighted": found.downweighted if robust else None,
        "spread": {"positions": found.spread_positions, "largest": found.spread_largest}, "flops": found.flops}


def _length(value: Any, what: str) -> tuple[float, bool]:
    """A length, or of a text such as "1e-3r" the part of a diagonal."""
    relative = isinstance(value, str) and value.endswith("r")
    return library.real(value[:-1] if relative else value, what), relative


def _set_smoothing(desc: Any, smooth: Any, within: Any) -> bool:
    """Sets how the smoothing is found. Returns whether `within` is relative."""
    automatic = isinstance(smooth, str) and smooth == "auto"
    if within is not None and not automatic:
        raise ValueError("smooth= and within= cannot be used together")
    relative = False
    if within is not None:
        desc.within, relative = _length(within, "within")
    elif not automatic:
        desc.smooth = library.real(smooth, "smooth")
    desc.smoothing = library.value_of("ffd_fit_smoothing", "within" if within is not None else "auto" if automatic else "given", "smooth")
    return relative


def _areas(points: np.ndarray, triangles: Any) -> np.ndarray | None:
    """A third of the areas of the triangles at each point; None: they have none."""
    corners = triangles_of(triangles, len(points))
    at = points.astype(np.float64)[corners]
    a, b = at[:, 1] - at[:, 0], at[:, 2] - at[:, 0]
    cross = np.stack([a[:, (c + 1) % 3] * b[:, (c + 2) % 3] - a[:, (c + 2) % 3] * b[:, (c + 1) % 3] for c in range(3)], axis=1)
    areas = np.sqrt(cross[:, 0] * cross[:, 0] + cross[:, 1] * cross[:, 1] + cross[:, 2] * cross[:, 2]) / 2
    weights = np.zeros(len(points))
    np.add.at(weights, corners.ravel(), np.repeat(areas / 3, 3))
    return weights if weights.any() else None


def _weights(points: np.ndarray, weights: Any, triangles: Any) -> np.ndarray | None:
    if weights is not None:
        if triangles is not None:
            raise ValueError("triangles= is in place of weights=")
        return arrays.doubles(weights, "weights", (len(points),))
    return None if triangles is None else _areas(points, triangles)


def fit(source: Rows, target: Rows, base: Lattice | None = None, *, size: Counts = 6, degree: Degrees = 3, knots: KnotWords = "open",
        margin: Numbers = 0.05, weights: Row | None = None, exact: Indices | None = None, handles: bool = False,
        smooth: float | Literal["auto"] = "auto", within: float | str | None = None, symmetric: Direction | None = None, robust: bool = False,
        triangles: Triangles | None = None, snap: float = 0.0, progress: Progress | None = None, threads: int = 0, isa: Isa = "auto") -> Fit:
    """Finds the lattice that carries points where they are wanted, as `ffd fit` does: `fit(a, b).lattice.deform(...)`.

    source, target: arrays (N, 3)
    base: where to start: what it does stays, and the rest is fitted; None: a box round the sources, by size, degree, knots and margin
      as of `Lattice.around`
    weights: (N,) numbers from 0 on; 0: not used; None: all 1, or with triangles a third of the areas of those at a point
    triangles: (M, 3) indices of sources: their surface
    exact: indices of pairs that hold exactly
    handles: True: drag the pairs, and change the rest as little as possible
    smooth: "auto", or a number from 0 on without a unit
    within: the smoothest lattice with all pairs so near: a length, or a text as "1e-3r", relative to the diagonal of the sources
    symmetric: "u", "v" or "w": pairs count mirrored too, and the result is symmetric to the bit
    robust: True: pairs that are far off count less
    snap: a source that misses the lattice by at most this distance is inside
    progress: called ten times a second with the fraction that is done; returning False cancels
    Raises `Error`: `UnmetError` where exact pairs contradict each other or nothing meets within=.
    """
    sources = arrays.readable(arrays.vectors(source, "source"))
    targets = arrays.readable(arrays.vectors(target, "target", len(sources)))
    if base is None:
        base = Lattice.around(sources, size, degree, knots=knots, margin=margin)
    elif not isinstance(base, Lattice):
        raise TypeError(f"base must be a Lattice, not {type(base).__name__}")
    weighing, residuals = _weights(sources, weights, triangles), np.empty(len(sources))
    indices = np.zeros(0, np.uintp) if exact is None else np.ascontiguousarray([library.integer(i, "exact", 0, 2**62) for i in exact], np.uintp)
    desc, result = library.filled("ffd_fit_desc"), library.empty("ffd_fit_result")
    desc.base, desc.source, desc.target = base._pointer, arrays.span(sources), arrays.span(targets)
    desc.weights = None if weighing is None else arrays.address(weighing)
    desc.exact, desc.exact_count = arrays.address(indices) if len(indices) else None, len(indices)
    desc.handles, desc.robust, desc.snap = bool(handles), bool(robust), library.real(snap, "snap")
    desc.symmetric = 0 if symmetric is None else direction_of(symmetric) + 1
    if _set_smoothing(desc, smooth, within) and len(sources):
        desc.within *= math.sqrt(sum(float(side) * float(side) for side in sources.max(axis=0).astype(float) - sources.min(axis=0).astype(float)))
    run = Run(threads, isa, progress)

    def make(pointer: Any, _: Any) -> int:
        """The library's call as `Lattice` expects it."""
        run(lib.ffd_fit_points, ctypes.byref(desc), last=(pointer, arrays.address(residuals), ctypes.byref(result)))
        return 0

    return Fit(Lattice._new(make), _report(result, bool(robust)), residuals)


def _box(size: Any, degree: Any, knots: Any, margin: Any, principal: bool) -> Any:
    """An ffd_lattice_desc of what is given; None: nothing is."""
    if size is None and degree is None and knots is None and margin is None and not principal:
        return None
    box = library.filled("ffd_lattice_desc")
    box.size[:], box.degree[:] = shape_of(6 if size is None else size, degree)
    box.knots[:] = [library.value_of("ffd_knots", word, "knots") for word in three("open" if knots is None else knots, "knots")]
    if margin is not None:
        box.margin[:] = [library.real(value, "margin") for value in three(margin, "margin")]
    box.principal = bool(principal)
    return box


def _texts(value: str | Sequence[str] | None, what: str) -> tuple[Any, int]:
    several = [] if value is None else [value] if isinstance(value, str) else list(value)
    return (ctypes.c_char_p * len(several))(*(library.encoded(text, what) for text in several)), len(several)


def _reading(space: str, memory: int, strict: bool, allow_extensions: Sequence[str]) -> Any:
    """An ffd_source with what all meshes are read by."""
    reading = declared.ffd_source()
    reading.space, reading.strict = library.value_of("ffd_space", space, "space"), bool(strict)
    reading.memory = library.integer(memory, "memory", 0, 2**63)
    reading.allow_extensions, reading.allow_extension_count = _texts(list(allow_extensions), "allow_extensions")
    return reading


def _set_meshes(job: Any, reading: Any, before: Path | None, after: Path | None, cover: Sequence[Path]) -> None:
    """Sets the meshes that are read."""
    paths = [before, after, *cover]
    sources = (declared.ffd_source * len(paths))(*([reading] * len(paths)))
    for source, path in zip(sources, paths):
        source.path = None if path is None else library.path(path)
    if before is not None:
        job.before = ctypes.pointer(sources[0])
    if after is not None:
        job.after = ctypes.pointer(sources[1])
    if cover:
        job.cover, job.cover_count = ctypes.pointer(sources[2]), len(cover)


def _run(job: Any, author: Any, progress: Progress | None, robust: bool) -> FittedFile:
    result = library.empty("ffd_fit_job_result")
    warnings: list[str] = []
    try:
        with library.logged(author) as warnings, library.progress_into(job, progress):
            library.call(lib.ffd_fit_run, ctypes.byref(job), ctypes.byref(result))
    except Error as refused:
        refused.warnings = warnings
        if isinstance(refused, GateError):
            refused.result = _report(result.fit, robust)
        raise
    seconds = {name: getattr(result.seconds, name) for name in ("read", "fit", "write")}
    return FittedFile(_report(result.fit, robust), seconds, warnings)


def fit_file(before: Path | None, after: Path | None, output: Path, *, pairs: Path | None = None, handles: bool = False,
             base: AnyLattice | None = None, values: Mapping[str, Any] | None = None, time: float | None = None, size: Counts | None = None,
             degree: Degrees = None, knots: KnotWords | None = None, margin: Numbers | None = None, principal: bool = False, cover: Sequence[Path] = (),
             smooth: float | Literal["auto"] = "auto", within: float | str | None = None,
             weights: Path | None = None, symmetric: Direction | None = None,
             robust: bool = False, fail_on: Literal["folds"] | None = None, only: Texts | None = None, space: Space = "scene",
             snap: float | str = 0.0, threads: int = 0, isa: Isa = "auto", memory: int = 0, timeout: float | None = None,
             strict: bool = False, allow_extensions: Sequence[str] = (), force: bool = False, progress: Progress | None = None) -> FittedFile:
    """Writes the lattice that carries one mesh file onto another, or pairs of a table, as `ffd fit` does, with its options.

    before, after: meshes of the same vertices, or .npy (N, 3); None beside pairs
    pairs: a .csv of x, y, z, of px, py, pz or vertex, and weight
    base: a `Lattice`, a path, or the text of a lattice file as bytes, with values for its placeholders and the time of its keys
    weights: "area" (the default), "uniform", or an .npy
    fail_on: "folds"
    The output is complete or absent. Raises `Error`; a `GateError` has the report as its result.
    """
    author, job = library.filled("ffd_author_desc"), library.filled("ffd_fit_job")
    author.reading = _reading(space, memory, strict, allow_extensions)
    kept = None if base is None else set_lattice(author.lattice, base)
    author.set, author.set_count = settings(values)
    if time is not None:
        author.time, author.has_time = library.real(time, "time"), True
    author.only, author.only_count = _texts(only, "only")
    author.threads, author.output, author.force = library.integer(threads, "threads"), library.path(output), bool(force)
    job.job = ctypes.pointer(author)
    _set_meshes(job, author.reading, before, after, cover)
    box = _box(size, degree, knots, margin, principal)
    if box is not None:
        job.lattice = ctypes.pointer(box)
    job.pairs = None if pairs is None else library.path(pairs)
    job.weights = None if weights is None else library.path(weights)
    job.handles, job.robust = bool(handles), bool(robust)
    job.symmetric = 0 if symmetric is None else direction_of(symmetric) + 1
    job.within_relative = _set_smoothing(job, smooth, within)
    job.snap, job.snap_relative = _length(snap, "snap")
    job.fail_on = 0 if fail_on is None else library.value_of("ffd_gate", fail_on, "fail_on")
    job.isa = library.value_of("ffd_isa", isa, "isa")
    job.timeout = 0.0 if timeout is None else library.real(timeout, "timeout")
    done = _run(job, author, progress, bool(robust))
    del kept
    return done
