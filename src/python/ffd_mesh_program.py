"""The program `ffd` that the package ffd_mesh brings. This does not import the package: numpy takes longer to load than the
program takes for most meshes."""

import os
import sys


def last_words(line: str, count: int) -> str:
    """The last words of a command line of Windows, as they were typed: the program expands patterns outside of quotes, which
    sys.argv does not show. Words are told apart by the rules of CommandLineToArgvW."""
    starts, quoted, in_word, slashes = [], False, False, 0
    for place, character in enumerate(line):
        if character in " \t" and not quoted:
            in_word = False
        elif not in_word:
            in_word = True
            starts.append(place)
        if character == '"' and slashes % 2 == 0:
            quoted = not quoted  # of two marks inside of quotes, which are one, the second begins quotes again
        slashes = slashes + 1 if character == "\\" else 0
    return line[starts[-count]:] if count else ""


def run_on_windows(program: str) -> None:
    """Runs the program and ends with its exit code: there os.execv would end this process while the program goes on."""
    import ctypes
    import signal
    import subprocess

    line = ctypes.windll.kernel32.GetCommandLineW  # type: ignore[attr-defined]
    line.restype = ctypes.c_wchar_p
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the program gets Ctrl-C too, and removes what it has begun
    sys.exit(subprocess.call(f'"{program}" {last_words(line(), len(sys.argv) - 1)}'))


def main() -> None:
    """Becomes the program, with the arguments of this process."""
    program = os.path.join(os.path.dirname(os.path.abspath(__file__)), "ffd_mesh", "ffd")
    if os.name == "nt":
        run_on_windows(program + ".exe")
    os.execv(program, ["ffd", *sys.argv[1:]])
