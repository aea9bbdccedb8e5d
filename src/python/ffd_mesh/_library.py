"""The library's functions through ctypes, which releases the GIL during a call."""

from __future__ import annotations

import contextlib
import ctypes
import itertools
import logging
import operator
import os
import sys
from typing import Any, Callable, Iterator, NamedTuple

import numpy as np

from . import _declarations as declared
from . import _native  # type: ignore[attr-defined]
from ._errors import Cancelled, failure
from ._wording import worded

Progress = Callable[[float], "bool | None"]

LOG = logging.getLogger("ffd_mesh")
LOG.addHandler(logging.NullHandler())

_ENDING = {"win32": "dll", "darwin": "dylib"}.get(sys.platform, "so")
_LIBRARY = ctypes.CDLL(os.path.join(os.path.dirname(os.path.abspath(__file__)), f"libffd.{_ENDING}"))
for _name, (_result, _arguments) in declared.FUNCTIONS.items():
    _function = getattr(_LIBRARY, _name)
    _function.restype, _function.argtypes = _result, _arguments
lib = _LIBRARY
lib.ffd_spell_members(_native.spell)
_native.connect(*(ctypes.cast(function, ctypes.c_void_p).value
                  for function in (lib.ffd_output_list_count, lib.ffd_output_list_name)))


def _words(names: dict[str, int]) -> dict[str, int]:
    """FFD_NORMALS_KEEP, ... -> keep, ...: drops the prefix that all names share."""
    split = [name.split("_") for name in names]
    common = 0
    while all(len(words) > common + 1 and words[common] == split[0][common] for words in split):
        common += 1
    return {"_".join(words[common:]).lower(): number for words, number in zip(split, names.values())}


# Enumeration -> word -> number; enumeration -> number -> word.
WORDS = {name: _words(names) for name, names in declared.ENUMERATIONS.items()}
NAMES = {name: {number: word for word, number in words.items()} for name, words in WORDS.items()}


def one_of(words: dict[str, int], word: Any, what: str) -> int:
    """The number of a word such as "extend". A ValueError lists the words that are possible."""
    if not isinstance(word, str) or word not in words:
        raise ValueError(f"{what} must be one of {', '.join(map(repr, words))}, not {word!r}")
    return words[word]


def value_of(enumeration: str, word: Any, what: str) -> int:
    return one_of(WORDS[enumeration], word, what)


class Member(NamedTuple):
    """A setting of a job (ffd/settings.h). words: of a choice, with their numbers."""

    name: str
    kind: str
    words: dict[str, int]


def members() -> list[Member]:
    found: list[Member] = []
    while entry := lib.ffd_deform_member(len(found)):
        member = entry.contents
        words = itertools.takewhile(bool, member.words) if member.words else ()
        found.append(Member(member.name.decode(), NAMES["ffd_member_kind"][member.kind],
                            {word.decode(): number for number, word in enumerate(words)}))
    return found


def integer(value: Any, what: str, least: int = 0, most: int = 2**31 - 1) -> int:
    """Converts an object with __index__ to an int within bounds: ctypes would truncate it silently."""
    try:
        number = operator.index(value)
    except TypeError:
        raise TypeError(f"{what} must be an integer, not {type(value).__name__}") from None
    if not least <= number <= most:
        raise ValueError(f"{what} must be {least} to {most}, not {number}")
    return number


def real(value: Any, what: str) -> float:
    """Converts to float. An int that is too large raises ValueError, like other bad values."""
    try:
        return float(value)
    except OverflowError:
        raise ValueError(f"{what} is too large for a float") from None


def encoded(value: Any, what: str) -> bytes:
    """Encodes a text. Refuses null characters, where the library would see its end."""
    if not isinstance(value, str):
        raise TypeError(f"{what} must be a text, not {type(value).__name__}")
    if "\0" in value:
        raise ValueError(f"{what} must not have a null character")
    return value.encode()


def path(value: Any) -> bytes:
    """Encodes a path. Refuses null characters, where the library would see its end."""
    data = os.fsencode(value)
    if b"\0" in data:
        raise ValueError(f"a path must not have a null character: {value!r}")
    return data


def text(data: bytes | None) -> str | None:
    return None if data is None else data.decode("utf-8", "backslashreplace")


def empty(name: str) -> Any:
    """A zeroed structure for results, with struct_size set if it has one."""
    structure = getattr(declared, name)()
    if hasattr(structure, "struct_size"):
        structure.struct_size = ctypes.sizeof(structure)
    return structure


def filled(name: str) -> Any:
    """A structure with the library's defaults."""
    structure = getattr(declared, name)()
    init = getattr(lib, name + "_init")
    if len(init.argtypes) == 2:
        init(ctypes.byref(structure), ctypes.sizeof(structure))
    else:
        init(ctypes.byref(structure))
    return structure


@contextlib.contextmanager
def output_list() -> Iterator[Any]:
    """Yields a list for the names of a job's outputs."""
    outputs = ctypes.c_void_p()
    call(lib.ffd_output_list_create, ctypes.byref(outputs))
    try:
        yield outputs
    finally:
        lib.ffd_output_list_destroy(ctypes.byref(outputs))


def call(function: Any, *arguments: Any) -> None:
    """Calls a function whose last argument is an ffd_error; raises an exception if it fails."""
    error = declared.ffd_error()
    status = function(*arguments, ctypes.byref(error))
    if status != 0:
        raise failure(status, error)


def native(name: str) -> int:
    """The address of a callback of the extension."""
    return getattr(_native, name)


def lent(progress: Progress | None) -> list[Any]:
    """What the extension's callback gets: the caller's progress function, and then the exception that it may raise."""
    if progress is not None and not callable(progress):
        raise TypeError(f"progress must be a function, not {type(progress).__name__}")
    return [progress]


class Run:
    """An ffd_run_options, with the caller's progress function and the exception that it may raise."""

    def __init__(self, threads: int, isa: str, progress: Progress | None) -> None:
        self._lent = lent(progress)
        self.options = filled("ffd_run_options")
        self.options.threads = integer(threads, "threads")
        self.options.isa = value_of("ffd_isa", isa, "isa")
        self.options.progress = _native.progress
        self.options.user = id(self._lent)

    def __call__(self, function: Any, *arguments: Any, last: tuple[Any, ...] = ()) -> None:
        """Calls a function with arguments, an ffd_run_options, the arguments in last, and an ffd_error."""
        try:
            call(function, *arguments, ctypes.byref(self.options), *last)
        except Cancelled:
            if len(self._lent) > 1:
                raise self._lent[1] from None
            raise
        if len(self._lent) > 1:
            raise self._lent[1]


@contextlib.contextmanager
def progress_into(desc: Any, progress: Progress | None) -> Iterator[None]:
    """Gives a job the caller's progress function; the exception that it raises is passed on."""
    kept = lent(progress)
    if progress is not None:
        desc.progress, desc.progress_user = _native.progress, id(kept)
    yield
    if len(kept) > 1:
        raise kept[1] from None


_LEVELS = {0: logging.WARNING, 1: logging.INFO, 2: logging.DEBUG}


@contextlib.contextmanager
def logged(structure: Any, reword: Callable[[str], str] = worded) -> Iterator[list[str]]:
    """Passes the log of a job's structure to logging, as "ffd_mesh". Yields a list that gets the warnings at the end.

    reword: of each line what is logged
    """
    lines: list[Any] = []
    warnings: list[str] = []
    structure.log = _native.log
    structure.log_user = id(lines)
    try:
        yield warnings
    finally:
        for level, line in ((level, reword(line)) for level, line in lines):
            LOG.log(_LEVELS.get(level, logging.DEBUG), "%s", line)
            if level == 0:
                warnings.append(line)


def lend_bytes(data: Any, what: str) -> tuple[Any, int, Any]:
    """Returns the address and size of a contiguous buffer, and an object that keeps it alive."""
    try:
        view = memoryview(data)
    except TypeError:
        raise TypeError(f"{what} must be bytes, not {type(data).__name__}") from None
    if not view.c_contiguous:
        raise ValueError(f"{what} must be contiguous")
    kept = np.frombuffer(view, np.uint8) if view.nbytes else np.zeros(1, np.uint8)
    return kept.ctypes.data, view.nbytes, kept


class Resolver:
    """Sets a source's resolve callback to a Python function of a file's name, and keeps the exception that it may raise."""

    def __init__(self, source: Any, function: Callable[[str], Any]) -> None:
        self._lent: list[Any] = [function, []]
        source.resolve, source.resolve_user = _native.resolve, id(self._lent)

    def reraise(self) -> None:
        if len(self._lent) > 2:
            raise self._lent[2] from None


def sink_into(structure: Any, files: list[Any]) -> None:
    """Makes a job append (name, bytes) of each output to a list, which must outlive the call, instead of writing files."""
    structure.sink = _native.sink
    structure.sink_user = id(files)


def positions_into(structure: Any, arrays: list[Any]) -> None:
    """Makes a job append the bytes of its deformed positions to a list, which must outlive the call."""
    structure.positions = _native.positions
    structure.positions_user = id(arrays)


def list_parameters(data: bytes, name: str) -> list[Any]:
    found: list[Any] = []
    call(lib.ffd_lattice_list_parameters, data, len(data), encoded(name, "name"), _native.parameter, id(found))
    return found


class Owned:
    """Owns an object of the library, and destroys it. structure: one whose content is to be freed, in place of a pointer."""

    def __init__(self, destroy: Any, structure: Any = None) -> None:
        self.pointer = ctypes.c_void_p() if structure is None else structure
        self._destroy = destroy

    # ctypes is bound as a default: when the interpreter exits, the module may be gone before its last object.
    def __del__(self, byref: Any = ctypes.byref) -> None:
        if self.pointer:  # a structure is always true
            self._destroy(byref(self.pointer))


def take_bytes(pointer: ctypes.c_void_p, size: int) -> bytes:
    """Copies memory that the library has allocated for the caller, and frees it."""
    try:
        return ctypes.string_at(pointer, size)
    finally:
        lib.ffd_free(pointer)
