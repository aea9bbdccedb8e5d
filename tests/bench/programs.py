"""Runs programs: their time by the clock on the wall and on processors, and the largest resident set of the process."""

import os
import subprocess
import sys
import time
import typing


class Command(typing.NamedTuple):
    words: list
    output: str = None
    at_once: int = 1  # so many processes, side by side


class Samples(typing.NamedTuple):
    seconds: list
    processor: list  # seconds too, of all threads: what else runs on the machine counts less
    megabytes: list


def remove(path):
    if path and os.path.exists(path):
        os.remove(path)


def measure(command):
    """Seconds, those of processors, and peak megabytes of one run. The output is removed before: to replace a file costs
    time of its own, which depends on the file system."""
    remove(command.output)
    start = time.perf_counter()
    processes = [subprocess.Popen(command.words, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
                 for _ in range(command.at_once)]
    ended = [end(process) for process in processes]
    seconds = time.perf_counter() - start
    return seconds, sum(used.ru_utime + used.ru_stime for used in ended), max(used.ru_maxrss for used in ended) * 1024 / 1e6


def end(process):
    """Waits for the process; what it used."""
    with process.stderr:
        errors = process.stderr.read()
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        sys.exit(f"exit {process.returncode}: {' '.join(process.args)}\n{errors.decode(errors='replace')}")
    return usage


def in_turns(commands, runs):
    """What each command takes. They are run in turns, so that all meet the same machine; what they read and write stays
    in the page cache."""
    samples = [Samples([], [], []) for _ in commands]
    for _ in range(runs):
        for command, sample in zip(commands, samples):
            for values, value in zip(sample, measure(command)):
                values.append(value)
    for command in commands:
        remove(command.output)
    return samples
