"""Descriptions of jobs: a mesh in a file or in memory, lattices, options."""

from __future__ import annotations

import contextlib
import ctypes
import io
import os
from typing import Any, Callable, Collection, Iterator, Mapping, Union

import numpy as np

from . import _arrays as arrays
from . import _declarations as declared
from . import _library as library
from ._errors import Error
from ._lattice import Lattice
from ._plane import PlaneLattice
from ._types import Path, ReadOptions, names
from ._values import faces_of, settings
from ._wording import worded

AnyLattice = Union[Lattice, PlaneLattice, Path, bytes]
Files = Union[Mapping[str, Any], Callable[[str], Any]]

# The settings that have arguments of their own, or none.
_ARGUMENTS = {"output", "lattices", "morphs", "in_place", "depfile", "positions", "output_list", "progress", "cancel"}
# Option -> the library's entry for it: called as the member is, without "input.".
_MEMBERS = {"input_format" if member.name == "input.format" else member.name.removeprefix("input."): member
            for member in library.members() if member.name not in _ARGUMENTS}
OPTIONS = set(_MEMBERS)
# Options for reading a mesh.
INPUT_OPTIONS = names(ReadOptions)


@contextlib.contextmanager
def described(source: Any, lattices: Any, options: Mapping[str, Any], known: Collection[str] = OPTIONS,
              reword: Callable[[str], str] = worded, own: Collection[str] = ()) -> Iterator[tuple[Any, list[str]]]:
    """Yields the description of a job, and a list that gets its warnings at the end.

    source: a path or a `Memory`; lattices: None if the job needs none; known: the options that the job accepts, besides the arguments own, which a
      refusal names too; reword: of lines of the log
    """
    refuse_unknown(options, known, own)
    desc = library.filled("ffd_deform_desc")
    kept = [None if lattices is None else _set_lattices(desc, lattices)]
    with _logged(desc, source, options, kept, reword) as warnings:
        yield desc, warnings


@contextlib.contextmanager
def defaults_described(lattices: Any, options: Mapping[str, Any]) -> Iterator[Any]:
    """Yields the description that the jobs of a batch have in common. Its lattices are files, which other processes read."""
    desc = library.filled("ffd_deform_desc")
    kept = [None if lattices is None else _set_lattices(desc, lattices), _set_options(desc, options)]
    yield desc
    del kept


@contextlib.contextmanager
def embedding_described(source: Any, lattice: AnyLattice, options: Mapping[str, Any],
                        known: Collection[str], own: Collection[str]) -> Iterator[tuple[Any, list[str]]]:
    """The same of a job that embeds, in one lattice."""
    refuse_unknown(options, known, own)
    desc = library.filled("ffd_embed_desc")
    kept = [lattice, set_lattice(desc.lattice, lattice)]
    with _logged(desc, source, options, kept) as warnings:
        yield desc, warnings


@contextlib.contextmanager
def _logged(desc: Any, source: Any, options: Mapping[str, Any], kept: list[Any],
            reword: Callable[[str], str] = worded) -> Iterator[list[str]]:
    """Gives a job its mesh and its options, and keeps alive what it has been given."""
    place(source, desc.input)
    kept += [source, *_set_options(desc, options)]
    with library.logged(desc, reword) as warnings:
        yield warnings
    del kept


def place(source: Any, structure: Any) -> None:
    """Sets an ffd_source to a path or a `Memory`; the latter must outlive it."""
    if isinstance(source, Memory):
        source.give(structure)
    else:
        structure.path = library.path(source)


@contextlib.contextmanager
def resolved(*sources: Any) -> Iterator[None]:
    """Around a call: if it fails because the function for a `Memory`'s files has raised an exception, raises that one instead."""
    try:
        yield
    except Error:
        for source in sources:
            if isinstance(source, Memory):
                source.reraise()
        raise


def _content(data: Any) -> Any:
    """Returns an object with a buffer as it is (also an mmap at any position), and the rest of an open file as bytes."""
    try:
        memoryview(data).release()
    except TypeError:
        return data.read() if hasattr(data, "read") else data
    return data


class Memory:
    """A mesh in memory, and the files that it refers to."""

    def __init__(self, data: Any, name: str, files: Files | None) -> None:
        self.name = library.path(name)
        self.resolver: library.Resolver | None = None
        self.address, self.size, self.kept = library.lend_bytes(_content(data), "data")
        if files is not None and not callable(files) and not isinstance(files, Mapping):
            raise TypeError(f"files must be a dict or a function, not {type(files).__name__}")
        self.find = files.get if isinstance(files, Mapping) else files

    def give(self, source: Any) -> None:
        """Sets an ffd_source to this mesh."""
        source.path = self.name
        source.bytes.data, source.bytes.size = self.address, self.size
        if self.find is not None:
            self.resolver = library.Resolver(source, self.find)

    def reraise(self) -> None:
        """Raises the exception of the function for files, if there is one."""
        if self.resolver is not None:
            self.resolver.reraise()


def set_lattice(source: Any, lattice: AnyLattice) -> Any:
    """Sets an ffd_lattice_source by path, as an object or as a text. Returns what must stay alive beside the lattice."""
    text = None
    if isinstance(lattice, PlaneLattice):
        lattice = lattice.solid
    if isinstance(lattice, Lattice):
        source.object = lattice._owned.pointer.value
    elif isinstance(lattice, bytes):
        source.text.data, source.text.size, text = library.lend_bytes(lattice, "a lattice")
    else:
        source.path = library.path(lattice)
    return text


def _set_lattices(desc: Any, lattices: Any) -> list[Any]:
    """Sets the lattices. Returns the objects that must stay alive."""
    named = isinstance(lattices, Mapping)
    several = list(lattices.values()) if named else list(lattices) if isinstance(lattices, (list, tuple)) else [lattices]
    if not several:
        raise ValueError("no lattice is given")
    if named:
        desc.morphs = (ctypes.c_char_p * len(several))(*(library.encoded(str(name), "a name") for name in lattices))
    sources = (declared.ffd_lattice_source * len(several))()
    kept = [several, *(set_lattice(source, lattice) for source, lattice in zip(sources, several))]
    desc.lattices, desc.lattice_count = sources, len(several)
    return kept


def _listed(value: Any, what: str) -> list[Any]:
    """A list, or a single text as one; of a mapping only the keys would be taken."""
    if isinstance(value, Mapping):
        raise TypeError(f"{what} is a list of texts, not a mapping")
    return [value] if isinstance(value, str) else list(value)


def _texts(value: Any, what: str) -> Any:
    """Converts a list of texts, or a single one, to an array of the library and its length."""
    texts = _listed(value, what)
    return (ctypes.c_char_p * len(texts))(*(library.encoded(text, what) for text in texts)), len(texts)


def _set_snap(desc: Any, value: Any) -> None:
    """Sets snap: a length, or a text such as "0.001r", relative to the rest lattice's diagonal."""
    relative = isinstance(value, str) and value.endswith("r")
    desc.snap = library.real(value[:-1] if relative else value, "snap")
    desc.snap_relative = relative


def _set_seam(desc: Any, value: Any) -> None:
    """Sets the seam from a text of --seam, such as "C1" or "C2:u-,v+"."""
    word, colon, faces = str(value).partition(":")
    desc.seam = library.one_of(_MEMBERS["seam"].words, word, "seam")
    desc.seam_faces = faces_of(faces) if colon and faces != "cut" else 0  # FFD_FACES_CUT


def _set_gates(desc: Any, value: Any) -> None:
    """Sets the gates from words of --fail-on: ["folds", "tear=0.1"], or one text with commas."""
    for gate in value.split(",") if isinstance(value, str) else _listed(value, "fail_on"):
        word, equals, most = str(gate).partition("=")
        desc.fail_on |= library.value_of("ffd_gate", word, "fail_on")
        if equals and word not in ("tear", "flipped", "edges", "inverted", "quality") or word in ("edges", "quality") and not equals:
            raise ValueError(f"fail_on has {gate!r}: tear=LENGTH, flipped=N, edges=LENGTH, inverted=N and quality=MIN have a value, "
                             "others none")
        if word == "tear":
            desc.tear_most = float(most) if equals else -1
        elif word == "flipped" and equals:
            desc.flipped_most = library.integer(int(most), "flipped", most=2**63)
        elif word == "edges":
            desc.edges_most = float(most)
        elif word == "inverted" and equals:
            desc.inverted_most = library.integer(int(most), "inverted", most=2**63)
        elif word == "quality":
            desc.quality_least = float(most)


def _set_embedding(desc: Any, value: Any) -> Any:
    """Sets the embedding: a path, or the bytes of the file, which are returned to be kept alive."""
    if not isinstance(value, bytes):
        desc.embedding.path = library.path(value)
        return None
    lent = desc.embedding.bytes
    lent.data, lent.size, kept = library.lend_bytes(value, "embedding")
    return kept


def _set_time(desc: Any, value: Any) -> None:
    desc.time, desc.has_time = library.real(value, "time"), True


def _set_weight(desc: Any, value: Any) -> Any:
    """Sets the source of the weights: a text or path as of --weight, the bytes of an .npy, or an array. Returns what must stay
    alive."""
    if isinstance(value, (str, os.PathLike)):
        desc.weight.source = library.path(value)
        return None
    if not isinstance(value, (bytes, bytearray, memoryview)):
        stream = io.BytesIO()
        np.save(stream, arrays.doubles(value, "weight", np.shape(value)), allow_pickle=False)
        value = stream.getvalue()
    lent = desc.weight.bytes
    lent.data, lent.size, kept = library.lend_bytes(value, "weight")
    return kept


def _set_values(desc: Any, value: Any) -> None:
    desc.set, desc.set_count = settings(value)


# Options whose members take more than their value.
_OWN: dict[str, Callable[[Any, Any], Any]] = {
    "set": _set_values, "snap": _set_snap, "seam": _set_seam, "fail_on": _set_gates, "embedding": _set_embedding, "time": _set_time, "weight": _set_weight}


def _seconds(value: Any, what: str) -> float:
    seconds = library.real(value, what)
    if not seconds > 0:
        raise ValueError(f"{what} is {value!r}: it must be more than 0 seconds")
    return seconds


# Kind of a member -> function of an option's value and its name.
_CONVERT: dict[str, Callable[[Any, str], Any]] = {
    "flag": lambda value, what: bool(value), "count": library.integer, "length": library.real, "time": _seconds,
    "bytes": lambda value, what: library.integer(value, what, most=2**63),
    "text": lambda value, what: library.encoded(str(value), what)}


def _set_member(desc: Any, option: str, value: Any) -> Any:
    """Sets the member of an option. Returns an object that must stay alive."""
    member = _MEMBERS[option]
    structure, name = (desc.input if member.name.startswith("input.") else desc), member.name.removeprefix("input.")
    if member.kind in ("texts", "selectors", "clips"):
        texts, count = _texts(value, option)
        setattr(structure, name, texts)
        setattr(structure, name.removesuffix("s") + "_count", count)
        return texts
    setattr(structure, name, library.one_of(member.words, value, option) if member.words else _CONVERT[member.kind](value, option))
    return None


def refuse_unknown(options: Mapping[str, Any], known: Collection[str], own: Collection[str] = ()) -> None:
    """Raises TypeError for an option that is not known. own: other keywords that the caller's function has."""
    unknown = sorted(set(options) - set(known))
    if unknown:
        raise TypeError(f"unknown option {unknown[0]!r} (known: {', '.join(sorted({*known, *own}))})")


def _set_options(desc: Any, options: Mapping[str, Any]) -> list[Any]:
    """Sets the options that are not None. Returns the objects that must stay alive."""
    return [_OWN[name](desc, value) if name in _OWN else _set_member(desc, name, value)
            for name, value in options.items() if value is not None]
