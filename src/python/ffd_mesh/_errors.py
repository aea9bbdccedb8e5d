"""Exceptions for failures of the library."""

from __future__ import annotations

from typing import Any, Sequence

from ._declarations import ENUMERATIONS
from ._wording import worded

_STATUS: dict[str, int] = ENUMERATIONS["ffd_status"]


class Error(Exception):
    """A failure of the library.

    status: the library's error code (ffd/error.h), a negative number
    message: what is wrong, with the value
    file, line, pointer: the place in a file: its name, line from 1, JSON pointer; each may be None
    warnings: of a job: the warnings that the program would have printed, one string each
    """

    status: int = -10
    warnings: Sequence[str] = ()

    def __init__(self, message: str, *, status: int | None = None, file: str | None = None, line: int | None = None,
                 pointer: str | None = None) -> None:
        # As ffd_error_format.
        place = "" if not file else f"{file}:{line}: " if line else f"{file}:{pointer}: " if pointer else f"{file}: "
        if file and line and pointer:
            place += f"{pointer}: "
        super().__init__(place + message)
        self.status = type(self).status if status is None else status
        self.message, self.file, self.line, self.pointer = message, file, line, pointer

    def __reduce__(self) -> Any:
        return _again, (type(self), self.message, self.status, self.file, self.line, self.pointer, self.__dict__)


def _again(kind: type[Error], message: str, status: int, file: str | None, line: int | None, pointer: str | None,
           members: dict[str, Any]) -> Error:
    error = kind(message, status=status, file=file, line=line, pointer=pointer)
    error.__dict__.update(members)
    return error


class GateError(Error):
    """A quality gate is violated.

    result: the figures of the job: a `Result`; from `jacobian_file` and `jacobian_bytes` the dict that they return
    data: from `view_bytes` the page or picture, which is made all the same; else None
    """

    result: Any = None
    data: bytes | None = None


class UnmetError(Error):
    """What is asked for cannot be met: exact pairs contradict each other, or no smoothing brings all pairs near enough."""


class ArgumentError(Error, ValueError):
    """An argument is not valid."""


class FileError(Error, OSError):
    """A file cannot be read or written."""


class ExistsError(FileError):
    """The output exists, and force was not given."""


class InvalidError(Error, ValueError):
    """A mesh, a lattice or a result is not valid."""


class EmbeddingError(Error):
    """A point is outside, with outside="error"."""


class UnsupportedError(Error):
    """The input is valid, but needs something that this build lacks."""


class OutOfMemoryError(Error, MemoryError):
    """Memory ran out."""


class LimitError(Error):
    """A documented limit is exceeded."""


class Cancelled(Error):
    """The progress function returned False."""


_KINDS: dict[int, type[Error]] = {}
for _name, _kind in {
    "GATE": GateError, "UNMET": UnmetError, "ARGUMENT": ArgumentError, "IO": FileError, "EXISTS": ExistsError, "INVALID": InvalidError,
    "EMBEDDING": EmbeddingError, "UNSUPPORTED": UnsupportedError, "MEMORY": OutOfMemoryError, "LIMIT": LimitError,
    "CANCELLED": Cancelled,
}.items():
    _kind.status = _STATUS["FFD_E_" + _name]
    _KINDS[_kind.status] = _kind


def failure(status: int, error: Any) -> Error:
    """Makes the exception for a status and an ffd_error."""
    def text(data: bytes) -> str:
        """Decodes a text of ffd_error."""
        return data.decode("utf-8", "backslashreplace")
    return _KINDS.get(status, Error)(worded(text(error.message)), status=status, file=text(error.file) or None,
                                     line=error.line or None, pointer=text(error.pointer) or None)
