"""Each mesh, deformed by its lattice, is what its golden file holds."""
import json
import pathlib
import subprocess

import pytest

DATA = pathlib.Path(__file__).resolve().parents[2]
SHAPES = [("models/banner_red.glb", "lattices/twist.json", "guard/banner.golden.glb")]


@pytest.mark.parametrize("mesh, lattice, golden", SHAPES)
def test_shape(mesh, lattice, golden, tmp_path):
    deformed = tmp_path / pathlib.Path(golden).name
    subprocess.run(["ffd", "deform", DATA / mesh, deformed, "-l", DATA / lattice], check=True)
    done = subprocess.run(["ffd", "compare", DATA / golden, deformed, "--tolerance", "1e-6r", "--json"],
                          stdout=subprocess.PIPE, check=False)
    assert done.returncode in (0, 1)  # others: a file cannot be read, or is not valid
    found = json.loads(done.stdout)
    assert found["equal"], f"{found['differences']}, first: {found['first']}, worst: {found['worst']}"
