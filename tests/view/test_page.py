#!/usr/bin/env python3
"""Pages of ffd view in Chromium, opened as files: the slider, colours, parts, marks, names, sizes of windows, and that
nothing is asked of a network.

    test_page.py MAKE_PAGE MODEL.obj

FFD_NODE names the folder whose node_modules holds playwright-core. FFD_SCREENSHOTS names a folder for pictures to be
looked at.
"""

import os
import shutil
import subprocess
import sys
import tempfile

SKIPPED = 77
HERE = os.path.dirname(os.path.abspath(__file__))
KINDS = ("torn", "fold", "hostile", "large", "empty")


def skip(reason):
    print(f"SKIP: {reason}")
    sys.exit(SKIPPED)


def main():
    make_page, model = sys.argv[1:]
    node_folder = os.environ.get("FFD_NODE", "")
    browser = shutil.which("chromium") or shutil.which("chromium-browser")
    if not shutil.which("node") or not browser:
        skip("node or chromium is not there")
    if not os.path.isdir(os.path.join(node_folder, "node_modules", "playwright-core")):
        skip("playwright-core is not installed (tests/run.sh installs it)")
    with tempfile.TemporaryDirectory() as folder:
        for kind in KINDS:
            words = [make_page, kind, os.path.join(folder, kind + ".html")]
            subprocess.run(words + ([model] if kind in ("torn", "fold") else []), check=True, stdout=subprocess.DEVNULL)
        # The browser wants a home of its own.
        done = subprocess.run(["node", os.path.join(HERE, "page.mjs"), node_folder, browser, folder], check=False,
                              env={**os.environ, "HOME": folder}, timeout=100)
    sys.exit(done.returncode)


main()
