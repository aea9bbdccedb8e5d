"""Rigs and deformations with a known outcome, for the tests through the program and for those in a viewer."""

import math

from bspline import BoxVolume
from harness import lattice
from made import JOINTS, SHORT, TIMES, Arm, cubic, posed, turns
from matrices import about, apply, of_numbers, of_parts, of_quaternion, placed, to_numbers
from rule import Deformation

LOW, HIGH = (-9.1, -9.2, -9.3), (12.2, 9.9, 10.1)  # holds all of every rig here


def volume(move, low=LOW, high=HIGH, size=(5, 4, 4), degree=(3, 3, 3)):
    return BoxVolume(low, high, move, size, degree)


def affine(m, **box):
    """The volume that carries its box by an affine map."""
    return volume(lambda p: [a - b for a, b in zip(apply(m, p), p)], **box)


def text(one):
    """The lattice file of a volume."""
    size = [len(t) - d - 1 for t, d in zip(one.knots, one.degree)]
    points = [[x + d for x, d in zip(p, offset)] for p, offset in zip(one.points, one.offsets)]
    return lattice(size, one.low, one.high, degree=list(one.degree), deformed={"points": points}, moves=[])


def text_at_rest(one):
    """The same lattice, of which nothing is moved."""
    return {key: value for key, value in text(one).items() if key != "deformed"}


def bend(degrees):
    """Lays the x axis on an arc towards y (interface of the move `bend`), applied to control points."""
    def move(p):
        a = math.radians(degrees)
        r, s, t = (HIGH[0] - LOW[0]) / a, p[0] - LOW[0], p[1]
        return [LOW[0] + (r - t) * math.sin(s / r) - p[0], r - (r - t) * math.cos(s / r) - p[1], 0.1 * p[2]]
    return move


def ripple(p):
    return [1.2 * math.sin(0.5 * p[1]), math.sin(0.6 * p[2] + 0.4 * p[0]), 1.1 * math.cos(0.5 * p[0])]


def scale(s):
    return of_parts((0, 0, 0), (0, 0, 0, 1), (s, s, s))


DOUBLE = scale(2.0)
QUARTER = placed(of_quaternion(about((0, 0, 1), 90)), (0.5, -1.0, 2.0))
RIGID = placed(of_quaternion(about((1, -2, 0.5), 70)), (3.0, 1.0, -2.0))
LARGER = placed([1.4 * x for x in of_quaternion(about((0.3, 1, 0.5), 40))], (0.2, 0.1, -0.7))  # a similarity
BENT = Deformation(volume(bend(200), size=(9, 4, 4)))
WAVED = Deformation(volume(ripple, size=(8, 7, 7)))


# Rigs: what a rig may consist of, each with something the others have not.

def plain():
    return Arm()


def posed_with_morphs():
    arm = posed(Arm(morphs=True))
    arm.channel("skin", "weights", [[0.0], [0.0], [1.0], [0.2], [0.3], [0.9], [0.0], [0.5]])
    return arm


def turned_root():
    """All of it stands turned and twice as large in the scene, and a group in between is turned too."""
    arm = posed(Arm(rotation=about((1, 1, 0), 33), scale=[1.3, 1.3, 1.3]))
    arm["car"]["rotation"] = about((0, 1, 0), 20)
    return arm


def without_binds():
    arm = posed(Arm())
    del arm.asset["skins"][0]["inverseBindMatrices"]
    return arm


def uneven():
    """Scales that differ by direction: of the skin's root, which is turned, and of a joint."""
    arm = posed(Arm(scale=[1.0, 1.3, 0.8], rotation=about((0, 0, 1), 30)))
    arm["elbow"]["scale"] = [1.2, 0.9, 1.0]
    return arm


def quantized():
    arm = posed(Arm(animated=False))
    arm.channel("shoulder", "rotation", turns((0, 0, 1), [0, 40, 95, -20]), component=SHORT)
    arm.channel("elbow", "rotation", [v for q in turns((0, 1, 0), [0, 30, 60, 10]) for v in ([0.0, 0.1, 0, 0], q, [0.1, 0, 0, 0])],
                "CUBICSPLINE", component=SHORT)
    arm.channel("axle", "rotation", turns((1, 0, 0), [0, 90, 180, 270]), component=SHORT)
    return arm


def cubic_only():
    arm = posed(Arm(animated=False))
    for name in ("shoulder", "elbow", "hand", "axle"):
        arm.channel(name, "rotation", cubic(turns((0.2, 1, 0.5), [0, 70, -30, 20])), "CUBICSPLINE")
        arm.channel(name, "translation", cubic([[0.1, 0, 0.2], [1, 0.5, 0], [0.5, 0.2, 0.4], [0.3, 0, 0]]), "CUBICSPLINE")
        arm.channel(name, "scale", cubic([[1, 1, 1], [1.1, 1.1, 1.1], [1, 1, 1], [0.8, 0.8, 0.8]]), "CUBICSPLINE", animation=1)
    return arm


def shared_samplers():
    """One sampler of several nodes, in two animations one output, and the keys that are the times of another."""
    arm = posed(Arm(animated=False))
    times = arm.times()
    output = arm.channel("shoulder", "rotation", turns((0, 0.4, 1), [0, 40, 95, -20]), times=times)
    for name in ("elbow", "hand", "axle"):
        arm.target(name, "rotation", 0)
    moves = arm.channel("shoulder", "translation", [[0.1, 0, 0], [0.2, 0.1, 0], [0, 0.2, 0.3], [0.1, 0, 0]], times=times)
    arm.target("axle", "translation", 1)
    arm.asset["animations"].append({"channels": [], "samplers": [
        {"input": times, "output": output, "interpolation": "STEP"}, {"input": times, "output": moves}]})
    arm.target("elbow", "rotation", 0, animation=1)
    arm.target("hand", "translation", 1, animation=1)
    return arm


def two_skins(shared_binds):
    """Two meshes on the same joints, named in another order, with one accessor of inverse binds or with two."""
    arm = posed(Arm())
    primitive = dict(arm.asset["meshes"][0]["primitives"][0])
    arm.asset["meshes"].append({"primitives": [primitive]})
    joints = [arm.names[name] for name in JOINTS]
    accessor = arm.asset["skins"][0]["inverseBindMatrices"]
    order = [1, 0, 2]
    arm.asset["skins"].append({"joints": [joints[i] for i in order], "inverseBindMatrices":
                               accessor if shared_binds else arm.matrices([arm.binds[i] for i in order])})
    arm.node("second", "root", mesh=2, skin=1)
    return arm


def matrices():
    """Nodes with `matrix`: above the rig, a joint, and one with a mesh."""
    arm = Arm(animated=False)
    for name in ("root", "elbow", "wheel"):
        node = arm[name]
        m = of_parts(node.pop("translation"), about((1, 0.5, 0), 25), node.pop("scale", [1.1, 1.1, 1.1]))
        node["matrix"] = to_numbers(m)
        assert of_numbers(node["matrix"]) == m
    arm.channel("shoulder", "rotation", turns((0, 0, 1), [0, 40, 95, -20]))
    arm.channel("axle", "rotation", turns((0, 1, 0), [0, 90, 180, 270]))
    return arm


def pointers():
    """Channels of KHR_animation_pointer: of nodes."""
    arm = posed(Arm(animated=False))
    arm.channel("shoulder", "rotation", turns((0, 0, 1), [0, 40, 95, -20]), pointer=True)
    arm.channel("elbow", "translation", cubic([[2, 0, 0], [2.2, 0.1, 0], [1.8, 0.2, 0.3], [2, 0, 0]]), "CUBICSPLINE", pointer=True)
    arm.channel("hand", "rotation", turns((0, 1, 0), [0, 50, 10, 0]))
    arm.channel("axle", "scale", [[1, 1, 1], [1.1, 1.1, 1.1], [0.9, 0.9, 0.9], [1, 1, 1]], pointer=True)
    return arm


def constant():
    """Channels that hold the rest, of which nothing may be added: a walk that stands still."""
    arm = Arm(animated=False)
    arm["axle"]["translation"] = [0.5, 0.125, -0.25]  # as float32 too
    for name in ("elbow", "axle"):
        arm.channel(name, "translation", [arm[name]["translation"]] * len(TIMES))
    return arm


ARMS = {"plain": plain, "posed, with morphs": posed_with_morphs, "turned root": turned_root, "without binds": without_binds,
        "quantized": quantized, "cubic": cubic_only, "shared samplers": shared_samplers,
        "shared binds": lambda: two_skins(True), "two skins": lambda: two_skins(False), "matrices": matrices,
        "pointers": pointers, "constant": constant, "uneven": uneven}
EVEN = [name for name in ARMS if name != "uneven"]
