"""What files hold."""

from __future__ import annotations

import ctypes
import json
from typing import Any, Mapping

from . import _library as library
from ._description import Path
from ._library import lib
from ._values import settings


def info(path: Path, *, parts: bool = False, set: Mapping[str, Any] | None = None) -> dict[str, Any]:
    """Describes a mesh or lattice file, as `ffd info --json` does. parts: the names that only= can have; set: values for the
    placeholders of a lattice."""
    desc = library.filled("ffd_info_desc")
    desc.file.path, desc.json, desc.parts = library.path(path), True, bool(parts)
    desc.set, desc.set_count = settings(set)
    text = ctypes.c_void_p()
    with library.logged(desc):
        library.call(lib.ffd_info_run, ctypes.byref(desc), ctypes.byref(text))
    try:
        return json.loads(ctypes.string_at(text))
    finally:
        lib.ffd_text_free(text)
