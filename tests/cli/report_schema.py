"""The published schema of reports. Without its validator the import fails, and with it the test."""
import json
import os
import sys

try:
    import jsonschema
except ImportError:  # a python3 of one's own does not see what Debian has installed
    sys.path.append("/usr/lib/python3/dist-packages")
    import jsonschema

SCHEMA = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "data", "schema", "ffd-report.schema.json")

with open(SCHEMA, encoding="utf-8") as _file:
    _schema = json.load(_file)
jsonschema.Draft202012Validator.check_schema(_schema)
_validator = jsonschema.Draft202012Validator(_schema)


def _refuse_constant(word):
    raise ValueError(f"{word} is not JSON")


def faults(text):
    """What is wrong with the text of a report: one line for each fault."""
    try:
        report = json.loads(text, parse_constant=_refuse_constant)
    except ValueError as error:
        return [f"not JSON: {error}"]
    return [f"/{'/'.join(map(str, e.absolute_path))}: {e.message[:200]}" for e in _validator.iter_errors(report)]
