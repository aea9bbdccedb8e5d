"""The program `ffd` that the package ffd_mesh brings. This does not import the package: numpy takes longer to load than the
program takes for most meshes."""

import os
import sys


def main() -> None:
    """Becomes the program, with the arguments of this process."""
    program = os.path.join(os.path.dirname(os.path.abspath(__file__)), "ffd_mesh", "ffd")
    os.execv(program, ["ffd", *sys.argv[1:]])
