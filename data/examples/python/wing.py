"""A wing whose volume lies as far forward as it can, with the volume kept: 60 control points, SLSQP, exact derivatives.

    wing.py wing.obj            (data/make_wing.py makes it)

The first optimum turns the rear inside out: a negative volume pays there. With the fold barrier the second one does not.
Needs ffd_mesh and scipy. Writes wing-folds.json and wing.json; prints a line for each."""

import sys

import ffd_mesh as ffd
import numpy as np
from scipy.optimize import minimize

with open(sys.argv[1], encoding="ascii") as file:
    lines = [line.split() for line in file]
points = np.array([line[1:] for line in lines if line[0] == "v"], float)
triangles = np.array([line[1:] for line in lines if line[0] == "f"], int) - 1

lattice = ffd.Lattice.around(points, size=(6, 2, 5), degree=(3, 1, 2))
embedding = lattice.embed(points)
thickness = np.ptp(points[:, 1])

# The volume and its moment along x are the integrals of y and of x y over the shadow of the surface on y = 0. Points move along y
# alone, so the shadow stays, and both are linear in y.
a, b, c = (points[triangles[:, corner]] for corner in range(3))
shadow, x = np.cross(b - a, c - a)[:, 1] / 2, points[triangles][..., 0]
volume_by_y, moment_by_y = np.zeros(len(points)), np.zeros(len(points))
np.add.at(volume_by_y, triangles, shadow[:, None] / 3)
np.add.at(moment_by_y, triangles, shadow[:, None] / 12 * (x.sum(axis=1, keepdims=True) + x))
volume = volume_by_y @ points[:, 1]


def by_p(by_y):
    """The derivative by p, how far each control point moves along y, in thicknesses of the wing."""
    return thickness * lattice.basis_transposed(embedding, by_y[:, None] * (0, 1, 0))[..., 1].ravel()


def moved(p):
    return lattice.rest + thickness * p.reshape(*lattice.size, 1) * (0, 1, 0)


def centre(p, price):
    """The centre of the volume along x, with a price on large moves and one on folding, and the derivative."""
    barrier = lattice.fold_barrier(moved(p), floor=0.1)
    return (moment_by_y @ lattice.deform(embedding, moved(p))[:, 1] / volume + 0.01 * p @ p + price * barrier.value,
            by_p(moment_by_y / volume) + 0.02 * p + price * thickness * barrier.gradient[..., 1].ravel())


start, gain = np.zeros(60), by_p(volume_by_y) / volume
for name, price in (("wing-folds", 0), ("wing", 1)):
    found = minimize(centre, start, price, jac=True, method="SLSQP", options={"ftol": 1e-9, "maxiter": 200},
                     constraints={"type": "eq", "fun": lambda p: gain @ p, "jac": lambda p: gain})
    best, forward = lattice.moved(moved(found.x)), centre(start, 0)[0] - centre(found.x, 0)[0] + 0.01 * found.x @ found.x
    assert found.success, found.message
    best.save(f"{name}.json", force=True)
    print(f"{name}.json: {forward:.3f} forward after {found.nfev} evaluations, volume off {abs(gain @ found.x):.0e}, "
          f"folds: {best.folds().verdict}, least det {best.folds().min_det:.2f}")
