"""An aerofoil that comes as near as it can to another one, with its area kept: 8 parameters, SLSQP, exact derivatives.

Needs ffd_mesh and scipy. Prints evaluations, the mean square distance before and after, and how far the area is off."""

import ffd_mesh as ffd
import numpy as np
from scipy.optimize import minimize


def naca(camber, thickness, count=200):
    """A closed section of the NACA four-digit series, as points in the plane z = 0, from the trailing edge round the nose."""
    x = 0.5 * (1 + np.cos(np.linspace(0, np.pi, count)))
    half = 5 * thickness * (0.2969 * np.sqrt(x) - 0.1260 * x - 0.3516 * x**2 + 0.2843 * x**3 - 0.1036 * x**4)
    line = np.where(x < 0.4, camber / 0.16 * (0.8 * x - x**2), camber / 0.36 * (0.2 + 0.8 * x - x**2))
    upper, lower = np.column_stack([x, line + half]), np.column_stack([x, line - half])
    section = np.concatenate([upper, lower[-2:0:-1]])
    return np.column_stack([section, np.zeros(len(section))])


def area(points):
    """The area of the section, and its derivative by the points."""
    after, before = np.roll(points, -1, axis=0), np.roll(points, 1, axis=0)
    slope = np.zeros_like(points)
    slope[:, 0], slope[:, 1] = 0.5 * (after[:, 1] - before[:, 1]), 0.5 * (before[:, 0] - after[:, 0])
    return 0.5 * np.sum(points[:, 0] * after[:, 1] - points[:, 1] * after[:, 0]), slope


start, target = naca(0.0, 0.12), naca(0.04, 0.12)
lattice = ffd.Lattice.box((-0.05, -0.1, -0.1), (1.05, 0.1, 0.1), size=(6, 2, 2), degree=(3, 1, 1))
embedding = lattice.embed(start)
B = lattice.basis(embedding)  # points x control points

# Parameter p[a, b]: how far the control points of column a of the four inner ones, row b (lower, upper), move along y.
S = np.zeros(lattice.size + (8,))
for p, (a, b) in enumerate(np.ndindex(4, 2)):
    S[1 + a, b, :, p] = 1.0
dydp = B @ S.reshape(-1, 8)  # dy/dp, exact, once for all
wanted_area = area(start)[0]


def shape(p):
    offsets = np.zeros(lattice.rest.shape)
    offsets[..., 1] = S @ p
    return lattice.deform(embedding, offsets=offsets)


def distance(p):
    difference = shape(p) - target
    return np.mean(np.sum(difference**2, axis=1)), 2 / len(start) * (difference[:, 1] @ dydp)


def area_is_kept(p):
    return area(shape(p))[0] - wanted_area


found = minimize(lambda p: tuple(1e4 * part for part in distance(p)), np.zeros(8), jac=True, method="SLSQP",
                 constraints={"type": "eq", "fun": area_is_kept, "jac": lambda p: area(shape(p))[1][:, 1] @ dydp},
                 options={"ftol": 1e-9})
assert found.success, found.message
print(f"evaluations {found.nfev}, distance {distance(np.zeros(8))[0]:.3e} to {distance(found.x)[0]:.3e}, area off {area_is_kept(found.x):.1e}")
