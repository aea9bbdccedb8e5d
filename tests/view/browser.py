"""Chromium, and Firefox, for the tests of pages: runs a script of this folder, or skips the test where something is missing."""

import os
import shutil
import subprocess
import sys

SKIPPED = 77
HERE = os.path.dirname(os.path.abspath(__file__))


def skip(reason):
    print(f"SKIP: {reason}")
    sys.exit(SKIPPED)


def find_browser(*names):
    """What the script is called with before its folder: FFD_NODE and the browser, Chromium unless others are named."""
    names = names or ("chromium", "chromium-browser")
    node_folder = os.environ.get("FFD_NODE", "")
    browser = next(filter(None, map(shutil.which, names)), None)
    if not shutil.which("node") or not browser:
        skip(f"node or {names[0]} is not there")
    if not os.path.isdir(os.path.join(node_folder, "node_modules", "playwright-core")):
        skip("playwright-core is not installed (tests/run.sh installs it)")
    return [node_folder, browser]


def run_script(name, found, pages, home, timeout, *words):
    """Returns the exit code. The browser wants a home of its own."""
    done = subprocess.run(["node", os.path.join(HERE, name), *found, pages, *words], check=False, env={**os.environ, "HOME": home},
                          timeout=timeout)
    return done.returncode


class Screen:
    """A screen that nobody sees, for what a browser draws only on one: DISPLAY names it. Skips the test without Xvfb."""

    def __enter__(self):
        if not shutil.which("Xvfb"):
            skip("Xvfb is not there (Debian's package xvfb)")
        reader, writer = os.pipe()
        self.server = subprocess.Popen(["Xvfb", "-displayfd", str(writer), "-screen", "0", "1600x1200x24", "-nolisten", "tcp"],
                                       pass_fds=[writer], stderr=subprocess.DEVNULL)
        os.close(writer)
        with os.fdopen(reader, encoding="ascii") as numbers:
            os.environ["DISPLAY"] = ":" + numbers.readline().strip()
        return self

    def __exit__(self, *_):
        self.server.terminate()
        self.server.wait()
