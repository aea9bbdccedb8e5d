#!/usr/bin/env python3
"""The sample meshes that are our own are what data/make_models.py makes, byte for byte."""

import filecmp
import os
import subprocess
import sys
import tempfile

DATA = os.path.join(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))), "data")


def main():
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([sys.executable, os.path.join(DATA, "make_models.py"), folder], check=True)
        made = sorted(os.listdir(folder))
        same, other, missing = filecmp.cmpfiles(folder, os.path.join(DATA, "models"), made, shallow=False)
    for name in other + missing:
        print(f"data/models/{name} is not what make_models.py makes")
    print(f"{len(same)} of {len(made)} files are the same")
    sys.exit(0 if made and same == made else 1)


main()
