"""Reads the published JSON Schemas and judges texts by them. Without the validator the import fails, and with it the
test."""
import json
import os
import sys

try:
    import jsonschema
except ImportError:  # a python3 of one's own does not see what Debian has installed
    sys.path.append("/usr/lib/python3/dist-packages")
    import jsonschema

FOLDER = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "data", "schema")


def _refuse_constant(word):
    raise ValueError(f"{word} is not JSON")


def read(name):
    """A published schema as Python objects."""
    with open(os.path.join(FOLDER, name), encoding="utf-8") as file:
        return json.load(file)


class Schema:
    def __init__(self, name):
        content = read(name)
        jsonschema.Draft202012Validator.check_schema(content)
        self.validator = jsonschema.Draft202012Validator(content)

    def faults(self, content):
        """What is wrong with the bytes of a file, which may begin with a byte order mark, or with what they hold: one line
        for each fault."""
        if isinstance(content, bytes):
            try:
                content = json.loads(content.decode("utf-8-sig"), parse_constant=_refuse_constant)
            except (ValueError, RecursionError) as error:
                return [f"not JSON: {error}"]
        return [f"/{'/'.join(map(str, e.absolute_path))}: {e.message[:200]}" for e in self.validator.iter_errors(content)]
