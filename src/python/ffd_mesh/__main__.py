"""`python -m ffd_mesh` is the program `ffd`."""

from ffd_mesh_program import main

main()
