"""Jobs on mesh files, as the program `ffd` does them."""

from __future__ import annotations

import contextlib
import ctypes
import json
import logging
import os
from typing import Any, Callable, Iterator, Mapping, NamedTuple, Sequence, Union

from . import _declarations as declared
from . import _library as library
from ._errors import Error, GateError, failure
from ._lattice import Lattice
from ._library import lib
from ._values import Folds, folds_of, settings

_LEVELS = {0: logging.WARNING, 1: logging.INFO, 2: logging.DEBUG}

Path = Union[str, "os.PathLike[str]"]
AnyLattice = Union[Lattice, Path, bytes]
Files = Union[Mapping[str, Any], Callable[[str], Any]]


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
                self.__dict__[name] = _plain(getattr(found, name))
        words = [word.removeprefix("point_") for word in library.WORDS["ffd_vertex_status"]]
        self.counts = dict(zip(words, found.counts))
        self.behind = dict(zip(library.WORDS["ffd_behind_kind"], self.behind))
        self.flaws = self.flaws[:found.flaw_count]
        self.folds = folds_of(found.folds) if found.has_folds else None
        self.warnings = warnings

    def __repr__(self) -> str:
        counts = ", ".join(f"{count} {word}" for word, count in self.counts.items() if count)
        return f"<Result: {self.vertices} vertices ({counts or 'none'}), {self.moved} moved, {len(self.warnings)} warnings>"


def _plain(value: Any) -> Any:
    """Values of ctypes as those of Python."""
    if isinstance(value, bytes):
        return library.text(value)
    if isinstance(value, ctypes.Array):
        return [_plain(entry) for entry in value]
    if isinstance(value, ctypes.Structure):
        return {name: _plain(getattr(value, name)) for name, *_ in value._fields_}
    return value


@contextlib.contextmanager
def _described(source: Any, lattices: Any, options: dict[str, Any]) -> Iterator[tuple[Any, list[str]]]:
    """The description of a job, and the list of its warnings, which is filled at the end. source: a path or a `_Memory`."""
    desc = library.filled("ffd_deform_desc")
    lines: list[Any] = []
    warnings: list[str] = []
    library.log_into(desc, lines)
    kept = [source, _set_lattices(desc, lattices)]
    if isinstance(source, _Memory):
        source.give(desc.input)
    else:
        desc.input.path = library.path(source)
    kept += _set_options(desc, options)
    try:
        yield desc, warnings
    finally:
        for level, line in lines:
            library.LOG.log(_LEVELS.get(level, logging.DEBUG), "%s", line)
            if level == 0:
                warnings.append(line)
    del kept


class _Memory:
    """A mesh in memory, and what it names."""

    def __init__(self, data: Any, name: str, files: Files | None) -> None:
        self.name, self.resolver = library.path(name), None
        self.address, self.size, self.kept = library.lend_bytes(data, "data")
        if files is not None and not callable(files) and not isinstance(files, Mapping):
            raise TypeError(f"files must be a dict or a function, not {type(files).__name__}")
        self.find = files.get if isinstance(files, Mapping) else files

    def give(self, source: Any) -> None:
        """Puts what it has into an ffd_source."""
        source.path = self.name
        source.bytes.data, source.bytes.size = self.address, self.size
        if self.find is not None:
            self.resolver = library.Resolver(source, self.find)

    def reraise(self) -> None:
        """Raises what the function of the files has raised."""
        if self.resolver is not None:
            self.resolver.reraise()


def _set_lattices(desc: Any, lattices: Any) -> list[Any]:
    """Names the lattices, or gives them as objects or texts; returns what must stay alive."""
    named = isinstance(lattices, Mapping)
    several = list(lattices.values()) if named else list(lattices) if isinstance(lattices, (list, tuple)) else [lattices]
    if not several:
        raise ValueError("no lattice is given")
    if named:
        desc.morphs = (ctypes.c_char_p * len(several))(*(library.encoded(str(name), "a name") for name in lattices))
    paths, texts = (ctypes.c_char_p * len(several))(), (declared.ffd_bytes * len(several))()
    objects = (ctypes.c_void_p * len(several))()
    kept = [several, objects]
    for i, lattice in enumerate(several):
        if isinstance(lattice, Lattice):
            objects[i] = lattice._owned.pointer.value
        elif isinstance(lattice, bytes):
            texts[i].data, texts[i].size, text = library.lend_bytes(lattice, "a lattice")
            kept.append(text)
        else:
            paths[i] = library.path(lattice)
    desc.lattices, desc.lattice_count = paths, len(several)
    desc.lattice_objects, desc.lattice_texts = ctypes.addressof(objects), texts
    return kept


def _texts(value: Any, what: str) -> Any:
    """A list of texts for the library; one text is a list of one."""
    texts = [value] if isinstance(value, str) else list(value)
    return (ctypes.c_char_p * len(texts))(*(library.encoded(text, what) for text in texts)), len(texts)


def _set_snap(desc: Any, value: Any) -> None:
    """A length, or a text "0.001r": a part of the rest lattice's diagonal."""
    relative = isinstance(value, str) and value.endswith("r")
    desc.snap = library.real(value[:-1] if relative else value, "snap")
    desc.snap_relative = relative


def _set_gates(desc: Any, value: Any) -> None:
    """["folds", "tear=0.1", ..]: the words of --fail-on."""
    for gate in [value] if isinstance(value, str) else value:
        word, equals, most = str(gate).partition("=")
        desc.fail_on |= library.number_of("ffd_gate", word, "fail_on")
        if equals and word not in ("tear", "flipped", "edges") or word == "edges" and not equals:
            raise ValueError(f"fail_on has {gate!r}: tear=LENGTH, flipped=N and edges=LENGTH have a value, others none")
        if word == "tear":
            desc.tear_most = float(most) if equals else -1
        elif word == "flipped" and equals:
            desc.flipped_most = library.integer(int(most), "flipped", most=2**63)
        elif word == "edges":
            desc.edges_most = float(most)


# Option -> enumeration, and whether it is the input's.
_ENUMERATIONS = {"outside": "ffd_outside", "normals": "ffd_normals", "resources": "ffd_resources", "rig": "ffd_rig", "isa": "ffd_isa",
                 "output_format": "ffd_format"}
_INPUT_ENUMERATIONS = {"input_format": ("format", "ffd_format"), "space": ("space", "ffd_space")}
_SWITCHES = ("blocks", "quality", "force", "if_changed", "dry_run")
_OPTIONS = {*_ENUMERATIONS, *_INPUT_ENUMERATIONS, *_SWITCHES, "set", "falloff", "snap", "embedding", "fail_on", "as_morph", "only", "clips",
            "threads", "memory", "strict", "allow_extensions"}


def _set_options(desc: Any, options: dict[str, Any]) -> list[Any]:
    """Sets what is not None; returns what must stay alive."""
    unknown = sorted(set(options) - _OPTIONS)
    if unknown:
        raise TypeError(f"unknown option {unknown[0]!r} (known: {', '.join(sorted(_OPTIONS))})")
    options = {name: value for name, value in options.items() if value is not None}
    kept = []
    for name, value in options.items():
        if name in _ENUMERATIONS:
            setattr(desc, name, library.number_of(_ENUMERATIONS[name], value, name))
        elif name in _INPUT_ENUMERATIONS:
            member, enumeration = _INPUT_ENUMERATIONS[name]
            setattr(desc.input, member, library.number_of(enumeration, value, name))
        elif name in _SWITCHES:
            setattr(desc, name, bool(value))
        elif name == "set":
            desc.set, desc.set_count = settings(value)
        elif name == "falloff":
            desc.falloff = library.real(value, "falloff")
        elif name == "snap":
            _set_snap(desc, value)
        elif name == "fail_on":
            _set_gates(desc, value)
        elif name == "embedding" and isinstance(value, bytes):
            desc.embedding_bytes.data, desc.embedding_bytes.size, embedding = library.lend_bytes(value, name)
            kept.append(embedding)
        elif name == "embedding":
            desc.embedding = library.path(value)
        elif name == "as_morph":
            desc.as_morph = library.encoded(str(value), "as_morph")
        elif name == "only":
            desc.only, desc.only_count = _texts(value, name)
        elif name == "clips":
            desc.clips, desc.clip_count = _texts(value, name)
        elif name == "threads":
            desc.threads = library.integer(value, name)
        elif name == "memory":
            desc.input.memory = library.integer(value, name, most=2**63)
        elif name == "strict":
            desc.input.strict = bool(value)
        elif name == "allow_extensions":
            texts, count = _texts(value, name)
            kept.append(texts)
            desc.input.allow_extensions, desc.input.allow_extension_count = texts, count
    return kept


def _run(function: Any, desc: Any) -> tuple[Any, Error | None]:
    result, error = library.empty("ffd_job_result"), declared.ffd_error()
    status = function(ctypes.byref(desc), ctypes.byref(result), ctypes.byref(error))
    return result, (failure(status, error) if status else None)


def _finish(found: Any, raised: Error | None, warnings: list[str]) -> Result:
    result = Result(found, warnings)
    if raised is None:
        return result
    if isinstance(raised, GateError):
        raised.result = result  # type: ignore[attr-defined]
    raised.warnings = warnings  # type: ignore[attr-defined]
    raise raised


def deform_file(source: Path, output: Path | None, lattices: AnyLattice | Sequence[AnyLattice] | Mapping[str, AnyLattice],
                **options: Any) -> Result:
    """Deforms a mesh file as `ffd deform` does; the output is complete or absent.

    source, output: paths; output None: in place. lattices: a `Lattice`, a path, or the text of a file as bytes; or several, in
      their order; of a glTF also a dict of names: each makes the morph target of its name, and
      clips=["NAME: TIME TARGET=WEIGHT, .."] animate these
    options, as those of the program (data/reference.md):
      set={"NAME": value}, outside="keep" | "extend" | "error", falloff=, snap=LENGTH or "0.001r", blocks=True,
      normals="transform" | "keep" | "recompute", as_morph="NAME", only=["node:NAME"], embedding="uvw.npy" or its bytes,
      fail_on=["folds", "tear=0.1"], quality=True (fills the figures of `check_file`), space="scene" | "mesh",
      resources="copy" | "reference", rig="keep" | "follow", force=True (replace the output), if_changed=True, dry_run=True, threads=,
      memory=BYTES, strict=True, allow_extensions=["NAME"], input_format="ply", output_format="glb", isa="auto"
    """
    with _described(source, lattices, options) as (desc, warnings):
        if output is None:
            desc.in_place = True
        else:
            desc.output = library.path(output)
        found, raised = _run(lib.ffd_deform_run, desc)
    return _finish(found, raised, warnings)


class DeformedBytes(NamedTuple):
    """What `deform_bytes` returns."""

    data: bytes  # the mesh
    files: dict[str, bytes]  # those beside it, by their names: buffers, copies of images and material libraries
    result: Result


def deform_bytes(data: Any, lattices: AnyLattice | Sequence[AnyLattice] | Mapping[str, AnyLattice], *, name: str,
                 output: str | None = None, files: Files | None = None, **options: Any) -> DeformedBytes:
    """Deforms a mesh in memory as `deform_file` does a file, to the same bytes; reads and writes no file.

    data: bytes, or what has them (bytearray, memoryview, an array); name: that of the mesh, whose ending says the format
    output: the name of the result, None: the same; another ending converts it
    files: what the mesh names (.bin, images, .mtl): a dict of names, relative to the mesh, or a function of a name that returns
      bytes, or None for a file that is not there; what it raises is raised
    options: those of `deform_file` but for in place, force and resources
    """
    memory, taken = _Memory(data, name, files), []
    with _described(memory, lattices, options) as (desc, warnings):
        desc.output = library.path(name if output is None else output)
        library.sink_into(desc, taken)
        found, raised = _run(lib.ffd_deform_run, desc)
    memory.reraise()
    result = _finish(found, raised, warnings)
    folder = os.path.dirname(name if output is None else output)
    beside = {os.path.relpath(path, folder) if folder else path: content for path, content in taken[:-1]}
    return DeformedBytes(taken[-1][1] if taken else b"", beside, result)


def check_bytes(data: Any, lattices: AnyLattice | Sequence[AnyLattice], *, name: str, files: Files | None = None,
                **options: Any) -> Result:
    """`check_file` of a mesh in memory, as `deform_bytes` takes it."""
    memory = _Memory(data, name, files)
    with _described(memory, lattices, options) as (desc, warnings):
        found, raised = _run(lib.ffd_check_run, desc)
    memory.reraise()
    return _finish(found, raised, warnings)


def check_file(source: Path, lattices: AnyLattice | Sequence[AnyLattice], **options: Any) -> Result:
    """Everything that `deform_file` does but the writing, with all figures: folds, flipped faces, torn edges, .. Options as
    there; fail_on raises `GateError`, which has the result."""
    with _described(source, lattices, options) as (desc, warnings):
        found, raised = _run(lib.ffd_check_run, desc)
    return _finish(found, raised, warnings)


def jacobian_file(source: Path, output: Path, lattices: AnyLattice | Sequence[AnyLattice], *, by: str = "points",
                  components: bool = False, of: int | None = None, times: Path | None = None, transposed: Path | None = None,
                  check: bool = False, **options: Any) -> dict[str, Any]:
    """Writes the derivative of a file's positions, as `ffd jacobian` does: by control points, u fastest, or by="parameters", the
    placeholders of their moves. Returns rows, columns, entries, vertices, moving, and with check worst.

    output: .npz (scipy.sparse.load_npz), .mtx or .npy. times, transposed: an .npy that is multiplied instead, output an .npy
    of: the lattice of several, from 0; None: the last. options: those of `deform_file` that positions depend on, and force
    """
    desc, result = library.filled("ffd_jacobian_desc"), library.empty("ffd_jacobian_result")
    desc.output, desc.by = library.path(output), library.number_of("ffd_jacobian_by", by, "by")
    desc.components, desc.check = bool(components), bool(check)
    if of is not None:
        desc.of = library.integer(of, "of")
    desc.times, desc.transposed = (None if path is None else library.path(path) for path in (times, transposed))
    with _described(source, lattices, options) as (job, _):
        desc.job = ctypes.pointer(job)
        library.call(lib.ffd_jacobian_run, ctypes.byref(desc), ctypes.byref(result))
    found = _plain(result)
    del found["struct_size"]
    return found if check else {name: value for name, value in found.items() if name != "worst"}


def info(path: Path, *, parts: bool = False, set: Mapping[str, Any] | None = None) -> dict[str, Any]:
    """Describes a mesh or lattice file, as `ffd info --json` does. parts: the names that only= can have; set: values for the
    placeholders of a lattice."""
    desc = library.filled("ffd_info_desc")
    desc.file.path, desc.json, desc.parts = library.path(path), True, bool(parts)
    desc.set, desc.set_count = settings(set)
    lines: list[Any] = []
    library.log_into(desc, lines)
    text = ctypes.c_void_p()
    try:
        library.call(lib.ffd_info_run, ctypes.byref(desc), ctypes.byref(text))
        found = json.loads(ctypes.string_at(text))
    finally:
        lib.ffd_text_free(text)
        for level, line in lines:
            library.LOG.log(_LEVELS.get(level, logging.DEBUG), "%s", line)
    return found
