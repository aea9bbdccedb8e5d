"""The table that the benchmark prints: a line for each thing measured, with the bar that it is to reach."""

import csv
import statistics
import typing


class Row(typing.NamedTuple):
    what: str
    values: list
    unit: str

    @property
    def median(self):
        return statistics.median(self.values)


def digits(value):
    """Behind the point, that are worth showing."""
    return 3 if abs(value) < 10 else 1 if abs(value) < 1000 else 0


def line(what, median, least, greatest, unit, ratio, bar, to):
    return f"{what:46} {median:>9} {least:>9} {greatest:>9} {unit:8} {ratio:>7}  {bar:14} {to}".rstrip()


HEAD = ("what", "median", "least", "greatest", "unit", "ratio", "bar", "ratio to")


class Table:
    """Prints each row when it is measured, and keeps all of them."""

    def __init__(self):
        self.subject = ""
        self.rows = []

    def say(self, text=""):
        print(text, flush=True)

    def head(self):
        self.say("A bar is for the ratio, or with a unit for the median; in brackets the one that is hoped for.\n")
        self.say(line(*HEAD))

    def title(self, subject):
        self.subject = subject
        self.say(f"\n{subject}")

    def add(self, what, values, unit, to=None, bar=""):
        """A row; to is another one that its median is divided by."""
        row = Row(what, values, unit)
        figures = row.median, min(values), max(values)
        ratio, divisor = (row.median / to.median, to.what) if to else ("", "")
        shown = [f"{figure:.{digits(row.median)}f}" for figure in figures]
        self.say(line("  " + what, *shown, unit, ratio and f"{ratio:.{2 if ratio >= 0.1 else 4}f}", bar, divisor))
        self.rows.append((self.subject, what, *figures, unit, ratio, bar, divisor,
                          " ".join(f"{value:.6g}" for value in values)))
        return row

    def save(self, path):
        with open(path, "w", encoding="utf-8", newline="") as file:
            writer = csv.writer(file)
            writer.writerow(("subject", *HEAD, "values"))
            writer.writerows(self.rows)
