"""What a run says and reports, where only the figures and names are promised and not the words around them."""

import json
import re

from harness import check, equal


def anything(_lines):
    """Whatever is said on stderr."""


def lines_with(done, *patterns):
    """The lines of stderr that have all of these, in any case of letters."""
    return [line for line in done.err + done.announced if all(re.search(p, line, re.I) for p in patterns)]


def one_line(done, *patterns):
    """One line has all of these, and no second one."""
    found = lines_with(done, *patterns)
    check(len(found) == 1, f"expected one line with all of {patterns}, said {done.err + done.announced}")
    return found[0]


def no_line(done, *patterns):
    found = lines_with(done, *patterns)
    check(not found, f"expected no line with all of {patterns}, said {found}")


def entry(run, *arguments, **options):
    """The run's only job in its report."""
    options.setdefault("err", anything)
    force = [] if arguments[0] == "check" else ["--force"]
    run.ffd(*arguments, *force, "--report", "r.json", **options)
    return json.loads(run.read("r.json"))["jobs"][0]


def counts(job, **expected):
    equal({name: job.get(name) for name in expected}, expected, "the report")
