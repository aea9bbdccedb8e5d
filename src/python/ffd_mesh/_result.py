"""What a job did, or why it failed."""

from __future__ import annotations

import ctypes
import os
from typing import Any

from . import _declarations as declared
from . import _library as library
from ._errors import Error, GateError, failure
from ._values import Folds, folds_of


class Result:
    """What a job did: the members of ffd_job_result (ffd/job.h) as attributes, and

    warnings: what a user of the program would be told, a line each (also by logging, as "ffd_mesh")
    counts: vertices by status: "inside", "outside", "multiple", "singular", "invalid"
    folds: a `Folds`, or None where the proof was not asked for
    """

    warnings: list[str]
    counts: dict[str, int]
    folds: Folds | None
    vertices: int
    moved: int
    behind: Any
    flaws: Any

    def __init__(self, found: Any, warnings: list[str]) -> None:
        for name, kind in found._fields_:
            if name not in ("struct_size", "status", "error", "picture") and not name.startswith("morph") \
                    and not name.endswith("_room"):
                self.__dict__[name] = plain(getattr(found, name))
        words = [word.removeprefix("point_") for word in library.WORDS["ffd_vertex_status"]]
        self.counts = dict(zip(words, found.counts))
        self.behind = dict(zip(library.WORDS["ffd_behind_kind"], self.behind))
        self.flaws = self.flaws[:found.flaw_count]
        self.folds = folds_of(found.folds) if found.has_folds else None
        self.warnings = warnings

    def __repr__(self) -> str:
        counts = ", ".join(f"{count} {word}" for word, count in self.counts.items() if count)
        return f"<Result: {self.vertices} vertices ({counts or 'none'}), {self.moved} moved, {len(self.warnings)} warnings>"


def plain(value: Any) -> Any:
    """Values of ctypes as those of Python."""
    if isinstance(value, bytes):
        return library.text(value)
    if isinstance(value, ctypes.Array):
        return [plain(entry) for entry in value]
    if isinstance(value, ctypes.Structure):
        return {name: plain(getattr(value, name)) for name, *_ in value._fields_}
    return value


def beside(taken: list[Any], output: str) -> dict[str, bytes]:
    """What a sink has taken before the output, which comes last, by names relative to it."""
    folder = os.path.dirname(output)
    return {os.path.relpath(path, folder) if folder else path: content for path, content in taken[:-1]}


def run(function: Any, desc: Any) -> tuple[Any, Error | None]:
    """Runs a job: what it did (ffd_job_result), and what it failed of."""
    result, error = library.empty("ffd_job_result"), declared.ffd_error()
    status = function(ctypes.byref(desc), ctypes.byref(result), ctypes.byref(error))
    return result, (failure(status, error) if status else None)


def finish(found: Any, raised: Error | None, warnings: list[str]) -> Result:
    """What a job did; raises what it failed of, which has it too where a gate refuses."""
    result = Result(found, warnings)
    if raised is None:
        return result
    if isinstance(raised, GateError):
        raised.result = result
    raised.warnings = warnings
    raise raised
