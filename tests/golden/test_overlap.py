#!/usr/bin/env python3
"""data/overlap.svg is what the program makes today, and the volume in it is proven not to fold.

    test_overlap.py FFD SOURCE"""

import json
import os
import subprocess
import sys
import tempfile


def main():
    ffd, data = sys.argv[1], os.path.join(sys.argv[2], "data")
    with tempfile.TemporaryDirectory() as folder:
        picture = os.path.join(folder, "overlap.svg")
        subprocess.run([sys.executable, os.path.join(data, "make_overlap.py"), ffd, picture], check=True)
        with open(picture, "rb") as made, open(os.path.join(data, "overlap.svg"), "rb") as kept:
            if made.read() != kept.read():
                sys.exit("data/overlap.svg is not what make_overlap.py draws")
    report = subprocess.run(
        [ffd, "check", os.path.join(data, "models", "plank.obj"), "-l", os.path.join(data, "lattices", "overlap.json"),
         "--report", "-"], check=True, stdout=subprocess.PIPE).stdout
    folds = json.loads(report)["jobs"][0]["folds"]
    if folds["verdict"] != "none" or not folds["min_det"] > 0:
        sys.exit(f"the volume of overlap.json: {folds}")


main()
