"""Many jobs in several processes, like `ffd batch`."""

from __future__ import annotations

import ctypes
import json
import os
from typing import Any, Callable, Iterable, Literal, Mapping, Sequence, Union, Unpack

from . import _declarations as declared
from . import _library as library
from ._description import OPTIONS, Path, defaults_described, refuse_unknown
from ._errors import Error, failure
from ._library import lib
from ._result import Result
from ._types import BatchOptions
from ._views import LOOK, set_look
from ._wording import worded

Jobs = Union[Path, Iterable[Mapping[str, Any]], None]
# Options that a batch has arguments for.
_OPTIONS = OPTIONS - {"dry_run", "timeout"}
_FLAGS = ("in_place", "shared_box", "csv_ignore")
_ARGUMENTS = ("in_", "lattice", "out_dir", "workers", "shard", "resume", "journal", "positions", "dtype", "view", "pages", "timeout", "dry_run",
              "stop", "report", "progress")
_TABLES = (".csv", ".tsv")


def batch(jobs: Jobs, *, in_: Path | None = None,
          lattice: Path | Sequence[Path] | Mapping[str, Path] | None = None, out_dir: Path | None = None, workers: int = 0,
          shard: tuple[int, int] | None = None, resume: bool = False, journal: Path | None = None,
          positions: Path | None = None, dtype: Literal["f4", "f8"] = "f4", view: Path | None = None, pages: bool = False,
          timeout: float | None = None, dry_run: bool = False, stop: bool = False, report: Path | None = None,
          progress: Callable[[float], Any] | None = None, **options: Unpack[BatchOptions]) -> list[Result]:
    """Runs many jobs in several processes, as `ffd batch` does. A job that crashes, hangs or fails harms no other.

    jobs: the path of a manifest, or of a table (.csv, .tsv); a list of dicts, each as a line of a manifest: {"in": "a.glb",
      "lattice": "bend.json", "out": "b.glb", "options": {"normals": "keep"}, "set": {"ANGLE": 30}}; an iterator of such dicts, from
      which no more are taken than processes can begin; or None: in_ names the meshes
    in_: a pattern of mesh files, "meshes/*.obj"; with a table the mesh of rows without one
    lattice: of patterns and tables: a path, a list of paths, or a dict {name: path} of morph targets
    out_dir: the folder of the outputs of patterns and tables
    workers: the number of processes; 0: one for each processor, as far as memory allows
    shard: (i, n): only every n-th job, beginning with job i, from 0
    resume, journal: leave outputs that are up to date by content; journal records what they were made from
    positions, dtype: the path of an array .npy of all deformed positions; "f4" or "f8"
    view: a folder for pictures of the jobs and an index that compares them. Jobs on one mesh have one frame and one scale of
      colours; their pictures are drawn when the last job has ended, and progress, warnings and results come with them
    pages=True: beside each picture a page, to which the index leads
    timeout: the longest time of a job in seconds
    dry_run, stop: write nothing; begin no more jobs after one has failed
    report: the path of a report
    progress: called from time to time with the fraction of jobs that has begun, negative if it is unknown; returning False
      ends the batch, which raises `Cancelled`
    options: those of `deform_file`, for all jobs that do not say otherwise; in_place=, shared_box=, csv_ignore="COLUMN,.."; and
      with view those of `view_file` for pictures: color=, camera=, up=, size=, frames=, animation=, no_cage=. A job may have its
      own: {"options": {"view": {"camera": "front"}}}

    Returns a `Result` for each job that has ended, in the order of the jobs, with these attributes besides:
      error: an `Error`, or None; no job raises it
      input, output: as the job names them; skipped: the output was up to date; line, row: its place among the jobs
      own_frame: None, or why its picture has another frame than those of the other jobs on its mesh: "far" (the deformed mesh
        lies farther than 10 diagonals of the mesh from it) or "options"
    Raises `UnsupportedError` where there is no program `ffd`: it is looked for near the package, and then by PATH; and `Error`
    for what fails all jobs. Threads may call it at the same time.
    """
    desc = library.filled("ffd_batch_desc")
    source = _Source(desc, jobs)
    given: dict[str, Any] = dict(options)
    own = {name: given.pop(name) for name in _FLAGS if name in given}
    look = {name: given.pop(name) for name in LOOK if name in given}
    refuse_unknown(given, _OPTIONS, (*_FLAGS, *LOOK, *_ARGUMENTS))
    texts = {"in": in_, "out_dir": out_dir, "journal": journal, "positions": positions, "view": view, "report": report}
    for name, value in texts.items():
        setattr(desc, name, None if value is None else library.path(value))
    desc.workers = library.integer(workers, "workers", most=1024)
    if shard is not None:
        desc.shard, desc.shards = (library.integer(number, "shard") for number in shard)
        if not desc.shards:
            raise ValueError(f"shard must be (i, n) with i from 0 to n-1, not {shard!r}")
    desc.timeout = 0 if timeout is None else library.real(timeout, "timeout")
    desc.positions_double = library.one_of({"f4": 0, "f8": 1}, dtype, "dtype")
    if look:
        drawn = library.filled("ffd_view_desc")
        set_look(drawn, **look)
        desc.look = ctypes.pointer(drawn)
    desc.pages = bool(pages)
    desc.resume, desc.dry_run, desc.stop, desc.shared_box = resume, dry_run, stop, own.get("shared_box", False)
    if own.get("csv_ignore") is not None:
        desc.csv_ignore = library.encoded(own["csv_ignore"], "csv_ignore")
    asked = library.lent(progress)
    ended: list[Any] = []
    desc.progress, desc.progress_user = library.native("progress"), id(asked)
    desc.ended, desc.ended_user = library.native("job_ended"), id(ended)
    with defaults_described(lattice, given) as defaults, library.logged(desc):
        defaults.in_place = bool(own.get("in_place", False))
        desc.defaults = ctypes.pointer(defaults)
        result, error = library.empty("ffd_batch_result"), declared.ffd_error()
        status = lib.ffd_batch_run(ctypes.byref(desc), ctypes.byref(result), ctypes.byref(error))
    for exceptions in (source.kept[2:], asked[1:]):
        if exceptions:
            raise exceptions[0] from None
    if status:
        raise failure(status, error)
    return [_result(*job) for job in sorted(ended, key=lambda job: job[0])]


class _Source:
    """Says where the jobs come from. kept: the function for jobs, its last line, and the exception that it may raise."""

    def __init__(self, desc: Any, jobs: Jobs) -> None:
        self.kept: list[Any] = [None, None]
        if isinstance(jobs, (str, os.PathLike)):
            member = "csv" if os.fspath(jobs).lower().endswith(_TABLES) else "manifest"
            setattr(desc, member, library.path(jobs))
        elif jobs is not None:
            desc.repeats = isinstance(jobs, Sequence)
            self.kept[0] = _listed(jobs) if isinstance(jobs, Sequence) else _iterated(iter(jobs))
            desc.next, desc.next_user = library.native("next_job"), id(self.kept)


def _line(job: Any) -> bytes:
    if not isinstance(job, Mapping):
        raise TypeError(f"a job must be a dict, not {type(job).__name__}")
    return json.dumps(dict(job), default=_plain).encode()


def _plain(value: Any) -> Any:
    """What JSON does not know: paths, and the numbers and arrays of NumPy."""
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if hasattr(value, "tolist"):
        return value.tolist()
    raise TypeError(f"a job must not have a {type(value).__name__}")


def _listed(jobs: Sequence[Any]) -> Callable[[int], bytes | None]:
    return lambda index: _line(jobs[index]) if index < len(jobs) else None


def _iterated(jobs: Any) -> Callable[[int], bytes | None]:
    def following(index: int) -> bytes | None:
        """The line of the next job; None: there are no more."""
        for job in jobs:
            return _line(job)
        return None
    return following


def _result(row: int, line: int, source: str | None, output: str | None, skipped: int, log: str, outputs: list[str],
            own_frame: str | None, data: bytes) -> Result:
    found = declared.ffd_job_result.from_buffer_copy(data)
    error: Error | None = failure(found.status, found.error) if found.status else None
    lines = worded(log).splitlines()
    result = Result(found, lines[:-1] if error else lines, outputs)
    result.error, result.input, result.output = error, source, output
    result.skipped, result.line, result.row, result.own_frame = bool(skipped), line, row, own_frame
    if error:
        error.warnings = result.warnings
    return result
