#!/usr/bin/env python3
"""Sums up a `meson test` run from its testlog.json: prints what failed, with its output, and the counts.

    summary.py TESTLOG.json [--may-skip]       last line: PASSED FAILED SKIPPED

A test that was skipped although nothing is missing (no --may-skip) has failed. So has a run without tests.
"""

import json
import sys

LINES = 40


def tail(text):
    lines = text.rstrip().splitlines()
    if len(lines) > LINES:
        lines = [f"... ({len(lines) - LINES} lines more in the log)"] + lines[-LINES:]
    return "".join(f"    {line}\n" for line in lines)


def main():
    may_skip = "--may-skip" in sys.argv[2:]
    counts = {"passed": 0, "failed": 0, "skipped": 0}
    try:
        with open(sys.argv[1], encoding="utf-8", errors="replace") as file:
            tests = [json.loads(line) for line in file if line.strip()]
    except OSError:
        tests = []
    for test in tests:
        result = test["result"]
        if result in ("OK", "EXPECTEDFAIL"):
            counts["passed"] += 1
        elif result == "SKIP" and may_skip:
            counts["skipped"] += 1
            reasons = [line for line in test.get("stdout", "").splitlines() if line.startswith("SKIP")]
            print(f"  skipped: {test['name']}: {' '.join(reasons)}")
        else:
            counts["failed"] += 1
            why = "skipped though nothing is missing" if result == "SKIP" else result.lower()
            print(f"  FAILED: {test['name']} ({why}, exit {test.get('returncode')}, {test['duration']:.1f} s)")
            print(tail(test.get("stdout", "")) + tail(test.get("stderr", "")), end="")
    if not tests:
        counts["failed"] = 1
        print("  FAILED: no test ran")
    print(*counts.values())


main()
