"""What a viewer shows against what the slow evaluator finds."""

import math

from pose import size_of


def poses_of(rig, most=4, times=5):
    """The default pose, and some times of the first animations."""
    return [(None, 0.0)] + [(a, t) for a in range(min(len(rig.animations), most)) for t in rig.times(a, times)]


def difference(rig, poses, step, answer):
    """The largest between the answer of viewer.shown() and the evaluator, by the size."""
    worst = 0.0
    chosen = {key: range(0, len(shape.positions), step) for key, shape in rig.shapes.items()}
    for pose, there in zip(poses, answer, strict=True):
        mine = rig.vertices(*pose, chosen)
        pairs = [(p, q) for key, points in zip(sorted(mine), there, strict=True) for p, q in zip(mine[key], points, strict=True)]
        worst = max(worst, max(math.dist(p, q) for p, q in pairs) / size_of(mine))
    return worst
