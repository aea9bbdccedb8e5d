"""What the cases of the Python package share: meshes as files, the program, a random lattice."""

import os
import subprocess
import tempfile

import ffd_mesh as ffd
import numpy as np

FFD = os.path.abspath(os.environ["FFD"])
SOURCE = os.environ["FFD_SOURCE"]
DATA = os.path.join(SOURCE, "data")
SEED = int(os.environ.get("FFD_SEED", "1"))


def rng(what):
    """Random numbers, the same for each name and FFD_SEED."""
    return np.random.default_rng([SEED, *what.encode()])


def program(*arguments):
    """Runs ffd; returns its stdout."""
    # It has no use for what an interpreter was made to load (test_sanitized.py).
    environment = {name: value for name, value in os.environ.items() if name != "LD_PRELOAD"}
    done = subprocess.run([FFD, *arguments], capture_output=True, text=True, check=False, env=environment)
    assert done.returncode == 0, done.stderr
    return done.stdout


def ply(points, normals=None):
    """A binary PLY of these numbers, without faces."""
    columns = points if normals is None else np.hstack([points, normals]).astype(points.dtype)
    names = ["x", "y", "z"] + (["nx", "ny", "nz"] if normals is not None else [])
    kind = {"float32": "float", "float64": "double"}[str(points.dtype)]
    head = "".join(f"property {kind} {name}\n" for name in names)
    return (f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\n{head}end_header\n").encode() + columns.tobytes()


def deformed_by_program(points, lattice, *options, normals=None):
    """What the program makes of the points (and normals), in a folder of its own."""
    with tempfile.TemporaryDirectory() as folder:
        names = [os.path.join(folder, name) for name in ("in.ply", "out.ply", "lattice.json")]
        with open(names[0], "wb") as file:
            file.write(ply(points, normals))
        lattice.save(names[2])
        program("deform", names[0], names[1], "-l", names[2], *options)
        with open(names[1], "rb") as file:
            data = file.read().split(b"end_header\n", 1)[1]
    return np.frombuffer(data, points.dtype).reshape(len(points), -1)


def curved(random, size=(4, 5, 3), degree=2, weights=False):
    """A lattice of arrays whose volume at rest is not affine."""
    grid = np.stack(np.meshgrid(*(np.linspace(0, 1, n) for n in size), indexing="ij"), axis=-1)
    grid += 0.04 * random.standard_normal(grid.shape)
    return ffd.Lattice.from_points(grid, degree, weights=random.uniform(0.5, 2, size) if weights else None)


def pushed(random, lattice, by=0.1):
    """Deformed control points."""
    return lattice.rest + by * random.standard_normal(lattice.rest.shape)
