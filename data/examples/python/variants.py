"""500 variants of a mesh into one array (500, N, 3), by a Latin hypercube of three parameters, as a training set wants them.

Needs ffd_mesh and scipy. Prints how many there are, and how many fold."""

import ffd_mesh as ffd
import numpy as np
from scipy.stats import qmc

points = np.random.default_rng(1).uniform(-1, 1, (1800, 3)).astype(np.float32)  # in place of a mesh's vertices
lattice = ffd.Lattice.around(points, size=(5, 5, 5))
embedding = lattice.embed(points)

parameters = qmc.scale(qmc.LatinHypercube(3, seed=1).random(500), [-0.3, -0.3, 0.6], [0.3, 2.5, 1.4])  # lift, pull, width
Qs = np.empty((500, *lattice.rest.shape))
for Q, (lift, pull, width) in zip(Qs, parameters):
    Q[:] = lattice.rest * (width, 1, 1)
    Q[2, 2, 4, 2] += lift
    Q[1, :, :, 0] += pull
variants = lattice.deform(embedding, Qs)
folds = np.array([lattice.folds(Q).verdict != "none" for Q in Qs])

np.savez("variants.npz", positions=variants[~folds], parameters=parameters[~folds])
print(f"{len(variants)} variants of {len(points)} points, {folds.sum()} that fold and are left out")
