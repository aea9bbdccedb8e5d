"""The names of this package's functions in messages of the library, which name commands of the program."""

from __future__ import annotations

import re

_FUNCTIONS = {"lattice convert": "convert_lattice", "lattice set": "Lattice.transform", "embed": "embed_file"}
_COMMAND = re.compile(r"`?\bffd (" + "|".join(_FUNCTIONS) + r")\b`?(?! worker)")


def worded(message: str) -> str:
    """A message with functions in place of commands: "convert_lattice" for "ffd lattice convert"."""
    return _COMMAND.sub(lambda found: _FUNCTIONS[found.group(1)], message)
