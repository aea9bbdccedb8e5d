#!/usr/bin/env python3
"""Runs others.py, on lattices in the formats of VTK, NumPy, SciPy and meshio, and volumes.py, on volume meshes of VTK and meshio, in a
fresh environment.

    test_others.py SOURCE [CASE...]       CASE: as unittest names it, "others.Others.test_plain_grids_of_vtk"; the program in FFD

All that it installs are the wheels of requirements.txt and of others.txt, which .ci/setup has fetched to .build-test/wheels and
.build-test/others (FFD_WHEELS, FFD_OTHERS name other folders): no index is asked. Without them, or with another Python than they
are for, it is skipped.
"""

import os
import sys
import tempfile

from test_package import HERE, fetched, make_environment, run_cases


def main():
    source, *chosen = sys.argv[1:]
    lists = {"requirements.txt": fetched(source, "FFD_WHEELS", "wheels"), "others.txt": fetched(source, "FFD_OTHERS", "others")}
    with tempfile.TemporaryDirectory() as folder:
        python, _ = make_environment(os.path.join(folder, "venv"), lists)
        environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
        environment |= {"PYTHONDONTWRITEBYTECODE": "1", "PYTHONPATH": HERE, "TMPDIR": folder}
        code = run_cases(python, chosen or ["others", "volumes"], folder, environment)
    sys.exit(1 if code else 0)


if __name__ == "__main__":
    main()
