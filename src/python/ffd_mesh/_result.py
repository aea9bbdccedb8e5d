"""Results of jobs, and their failures."""

from __future__ import annotations

import ctypes
import math
import os
from types import SimpleNamespace
from typing import Any

from . import _declarations as declared
from . import _library as library
from ._errors import Error, GateError, failure
from ._library import lib
from ._values import FACES, Folds, folds_of


class Group(SimpleNamespace):
    """A group of figures: the members of its struct (ffd/result.h) as attributes."""


# Members of ffd_job_result that are not figures of the job.
_NO_FIGURES = {"struct_size", "status", "error", "picture", "page", "own_frame", "morphs", "outputs"}


class Result:
    """The result of a job: the members of ffd_job_result (ffd/result.h) as attributes, and

    warnings: the warnings that the program would print, one string each (also logged as "ffd_mesh")
    outputs: names of the files that the job has written or, with dry_run, would write; also those that were up to date
    counts: number of vertices by status: "inside", "outside", "multiple", "singular", "invalid"
    folds: a `Folds`
    tear, det, edges, displacement, ..: groups of figures, as result.tear.largest; tear.cause is a word: "stays", "blocks", ..;
      seam has continuity, "C1", and faces, a list for each lattice, as [["u+"]]
    rigid: a list of groups, one for each part of rigid= and uniform=: part, pieces, rotation, scale, distance
    cells: of volume meshes: count, inverted, by_deformation, unknown, scaled_jacobian, worst, as in a report
    flipped_faces: how many of the visible faces end with their back side out, as far as it was counted
    What is not known is None: a group that the job did not look for (folds, tear, det, edges) or that has nothing (rig, seam, cells), and a
    number such as the volume of a mesh that is not closed. No number is infinite or NaN.
    """

    warnings: list[str]
    outputs: list[str]
    counts: dict[str, int]
    folds: Folds | None
    vertices: int
    moved: int
    has_flipped: bool
    faces: int | None
    flipped_faces: int | None
    unused: int
    hidden: int
    indices_left: int
    bytes_left: int
    bounds_left: int
    flaw_count: int
    own_box: bool
    normals_collapsed: int
    normals_carried: int
    transforms_singular: int
    tear: Any
    displacement: Any
    morph_targets: Any
    shared_faces: Any
    residual: Any
    iterations: Any
    volume: Any
    area: Any
    det: Any
    edges: Any
    skin_weights: Any
    precision: Any
    splats: Any
    bounds: Any
    rig: Any
    seam: Any
    weight: Any
    rigid: Any
    cells: Any
    behind: Any
    flaws: Any
    seconds: Any
    # Of a job of a batch:
    error: Error | None
    input: str | None
    output: str | None
    skipped: bool
    line: int
    row: int
    own_frame: str | None

    def __init__(self, found: Any, warnings: list[str], outputs: list[str] | None = None) -> None:
        for name, _ in found._fields_:
            if name not in _NO_FIGURES and not name.endswith("_room"):
                self.__dict__[name] = figures(getattr(found, name))
        words = [word.removeprefix("point_") for word in library.WORDS["ffd_vertex_status"]]
        self.counts = dict(zip(words, found.counts))
        self.behind = dict(zip(library.WORDS["ffd_behind_kind"], self.behind))
        self.flaws = self.flaws[:found.flaw_count]
        self.folds = folds_of(found.folds) if found.folds.is_known else None
        if not self.has_flipped:
            self.faces = self.flipped_faces = None
        self.warnings = warnings
        self.outputs = outputs or []

    def __repr__(self) -> str:
        counts = ", ".join(f"{count} {word}" for word, count in self.counts.items() if count)
        return f"<Result: {self.vertices} vertices ({counts or 'none'}), {self.moved} moved, {len(self.warnings)} warnings>"


_UNKNOWN = 2**64 - 1


def _known(value: Any) -> Any:
    """A number or text as it is; None for a number that says that there is none."""
    missing = not math.isfinite(value) if isinstance(value, float) else value == _UNKNOWN
    return None if missing else value


def _texts(value: Any) -> list[str | None]:
    """An array of texts, without the empty ones at its end."""
    return [library.text(entry.value) for entry in value if entry.value]


def figures(value: Any) -> Any:
    """Converts ctypes values to Python values, recursively. Structures become groups; what is not known is None."""
    if isinstance(value, ctypes.Array):
        if isinstance(value[0], ctypes.Array) and value[0]._type_ is ctypes.c_char:
            return _texts(value)
        return [figures(entry) for entry in value]
    if isinstance(value, declared.ffd_bounds):
        return Group(min=list(value.min), max=list(value.max)) if value.min[0] <= value.max[0] else None
    if not isinstance(value, ctypes.Structure):
        return plain(value)
    if isinstance(value, declared.ffd_rigid_figures):
        return [figures(part) for part in value.parts[:value.count]]
    known = getattr(value, "is_known", getattr(value, "is_there", True))
    names = (name for name, *_ in value._fields_ if name not in ("room", "is_known", "is_there"))
    group = Group(**{name: figures(getattr(value, name)) for name in names}) if known else None
    if isinstance(value, declared.ffd_tear_figures) and group:
        group.vertex = group.vertex if group.edges else None
        group.cause = library.NAMES["ffd_tear_cause"][value.cause]
    if isinstance(value, declared.ffd_seam_figures) and group:
        group.faces = [[face for bit, face in enumerate(FACES) if faces >> bit & 1] for faces in group.faces[:group.count]]
        group.continuity = f"C{value.continuity - 1}"
        del group.count
    if isinstance(value, declared.ffd_cell_figures) and group:
        group.worst = group.worst if group.has_worst else None
        del group.has_worst
    return group


def plain(value: Any) -> Any:
    """Converts ctypes values to Python values, recursively. Structures become dicts; what is not known is None."""
    if isinstance(value, bytes):
        return library.text(value)
    if isinstance(value, ctypes.Array):
        return [plain(entry) for entry in value]
    if isinstance(value, ctypes.Structure):
        return {name: plain(getattr(value, name)) for name, *_ in value._fields_}
    return _known(value)


def beside(taken: list[Any], output: str) -> dict[str, bytes]:
    """The files that a sink received before the output (the last entry), by path relative to the output."""
    folder = os.path.dirname(output)
    return {os.path.relpath(path, folder) if folder else path: content for path, content in taken[:-1]}


def run(function: Any, desc: Any) -> tuple[Any, Error | None]:
    """Runs a job. Returns its ffd_job_result, which gets the names of the outputs, and the exception if it failed.

    Ctrl-C ends it, also where the caller has no progress function.
    """
    result, error = library.empty("ffd_job_result"), declared.ffd_error()
    job = desc.job.contents if hasattr(desc, "job") else desc
    asked = library.lent(None)
    if hasattr(job, "progress") and not job.progress_user:
        job.progress, job.progress_user = library.native("progress"), id(asked)
    with library.output_list() as outputs:
        if hasattr(job, "output_list"):
            job.output_list = outputs
        status = function(ctypes.byref(desc), ctypes.byref(result), ctypes.byref(error))
        count = lib.ffd_output_list_count(outputs)
        if len(asked) > 1:
            raise asked[1]
        result.output_names = [os.fsdecode(lib.ffd_output_list_name(outputs, i)) for i in range(count)]
    return result, (failure(status, error) if status else None)


def finish(found: Any, raised: Error | None, warnings: list[str]) -> Result:
    """Returns the result of a job, or raises its exception. A `GateError` gets the result."""
    result = Result(found, warnings, found.output_names)
    if raised is None:
        return result
    if isinstance(raised, GateError):
        raised.result = result
    raised.warnings = warnings
    raise raised
