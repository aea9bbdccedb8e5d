"""The JSON Schemas that come with the package."""

from __future__ import annotations

import json
import os
from typing import Any, Literal

_NAMES = ("lattice", "report")


def schema(name: Literal["lattice", "report"]) -> dict[str, Any]:
    """Returns a JSON Schema as a dict. name: "lattice" (lattice files) or "report" (files of the program's --report).

    The file in the package is schema/ffd-NAME.schema.json.
    """
    if name not in _NAMES:
        raise ValueError(f"schema must be one of {', '.join(map(repr, _NAMES))}, not {name!r}")
    with open(os.path.join(os.path.dirname(__file__), "schema", f"ffd-{name}.schema.json"), encoding="utf-8") as file:
        return json.load(file)
