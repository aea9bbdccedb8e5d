"""The published schema of reports."""
from schema import Schema

_schema = Schema("ffd-report.schema.json")


def faults(text):
    """What is wrong with the text of a report: one line for each fault."""
    return _schema.faults(text.encode("utf-8") if isinstance(text, str) else text)
