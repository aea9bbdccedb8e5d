#!/usr/bin/env python3
"""The page's scripts are JavaScript that node reads, each by itself, in ASCII and with an opening comment.

    test_scripts.py ROOT
"""

import os
import re
import shutil
import subprocess
import sys

SKIPPED = 77


def main():
    folder = os.path.join(sys.argv[1], "src", "view", "page")
    scripts = sorted(name for name in os.listdir(folder) if name.endswith(".js"))
    if not shutil.which("node"):
        print("SKIP: node is not there")
        sys.exit(SKIPPED)
    findings = []
    for name in scripts:
        path = os.path.join(folder, name)
        with open(path, encoding="utf-8") as file:
            text = file.read()
        if not re.match(rf"// {re.escape(name)} - \w", text):
            findings.append(f"{name}: begins without '// {name} - ...'")
        if re.search(r"innerHTML|outerHTML|insertAdjacentHTML|document\.write|\beval\b|new Function", text):
            findings.append(f"{name}: makes markup or code of text")
        done = subprocess.run(["node", "--check", path], capture_output=True, text=True, check=False)
        if done.returncode != 0:
            findings.append(done.stderr.strip())
    print(*findings, f"{len(scripts)} scripts, {len(findings)} findings", sep="\n")
    sys.exit(1 if findings or not scripts else 0)


main()
