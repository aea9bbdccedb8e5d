"""The rule of --rig follow, written apart from the program and slowly: what a rig becomes under a deformation.

A deformation is a list of volumes (bspline.BoxVolume), one after the other; a point that none holds stays. The answer
is a Rig of the same kind as it was read from a file (pose.py), so that both can be shown at any time."""

import copy
import math

from matrices import (UNIT, apply, determinant, inverse, linear, norm, of_columns, origin, placed, product, quaternion,
                      quaternions_product, sum_of, transposed, turn)
from pose import blend

SHEAR = 1e-6


class Deformation:
    """What --outside, --falloff and --blocks make of volumes. Where the whole is more than their product, its gradient is
    taken from differences."""

    def __init__(self, *volumes, extend=False, falloff=None, blocks=False):
        self.volumes, self.extend, self.falloff, self.blocks = volumes, extend, falloff, blocks

    def weight(self, volume, p):
        """How much of the displacement of the border's nearest point is left."""
        if not self.extend:
            return float(volume.holds(p))
        far = math.sqrt(sum(max(a - x, x - b, 0) ** 2 for x, a, b in zip(p, volume.low, volume.high)))
        if self.falloff is None:
            return 1.0
        s = min(far / self.falloff, 1.0)
        return 1 - s ** 3 * (10 - 15 * s + 6 * s * s)

    def __call__(self, p):
        for volume in self.volumes:
            if self.blocks and not volume.holds(p):
                continue
            weight = self.weight(volume, p)
            if weight:
                p = [x + weight * d for x, d in zip(p, volume.displacement(p))]
            if self.blocks:
                break
        return tuple(p)

    def at(self, p):
        """D(p) and F(p)."""
        if self.extend:
            return self(p), self.by_differences(p)
        gradient, q = UNIT, p
        for volume in self.volumes:
            if volume.holds(q):
                gradient, q = product(volume.gradient(q), gradient), volume.deform(q)
                if self.blocks:
                    break
        return tuple(q), gradient

    def by_differences(self, p, h=1e-5):
        columns = []
        for a in range(3):
            high, low = (self([x + s * h * (b == a) for b, x in enumerate(p)]) for s in (1, -1))
            columns.append([(x - y) / (2 * h) for x, y in zip(high, low)])
        return of_columns(*columns)


def polar(f):
    """The rotation of the polar decomposition by Higham's iteration; the identity where there is none."""
    if determinant(f) <= 0:
        return UNIT
    found = linear(f)
    for _ in range(100):
        following = sum_of(found, transposed(inverse(found)), 0.5, 0.5)
        change = norm(sum_of(following, found, 1, -1))
        found = following
        if change < 1e-14:
            break
    return found


def is_singular(world):
    return abs(determinant(world)) <= 1e-12 * norm(linear(world)) ** 3


def is_uneven(world):
    m = product(transposed(world), linear(world))
    return norm(sum_of(m, UNIT, 1, -m[0])) > 1e-6 * abs(m[0])


class Following:
    """The rule, carried out. rig: as it becomes; moved, sheared: node numbers; lag: node -> |D(x) - x|."""

    def __init__(self, before, deformation, chosen=lambda node: True):
        self.before, self.deformation = before, deformation
        self.rig = copy.copy(before)
        self.rig.nodes = [copy.copy(node) for node in before.nodes]
        self.old = before.worlds()
        self.new = [None] * len(before.nodes)
        self.frames = {}  # node -> (D(x), F, R as asked for)
        self.turns = {}  # node -> g
        self.sheared, self.lag = [], {}
        self.places = self.places_of_rig(chosen)
        for number in before.order:
            self.move(number)
        self.moved = [n for n, (a, b) in enumerate(zip(before.nodes, self.rig.nodes))
                      if (a.parts, a.matrix) != (b.parts, b.matrix)]
        self.rig.skins = copy.copy(before.skins)
        self.similar = [self.follow_skin(i) for i in range(len(before.skins))]
        self.rig.shapes = {key: self.follow_shape(key) for key in before.shapes}
        self.rig.animations = [[self.follow_channel(channel) for channel in animation] for animation in before.animations]

    def places_of_rig(self, chosen):
        """The nodes of rule 7, and groups of uneven world scale."""
        rig = self.before
        joints = {joint for skin in rig.skins for joint in skin.joints}
        animated = {channel.node for animation in rig.animations for channel in animation if channel.path != "weights"}
        found = set()
        for node in rig.nodes:
            has_skin = node.mesh is not None and node.skin is not None  # nobody sees where such a node stands
            is_place = (node.number in joints or node.number in animated or (node.mesh is not None and not has_skin)
                        or "camera" in node.members or node.members.get("extensions")
                        or not (node.children or has_skin) or (node.children and is_uneven(self.old[node.number])))
            if is_place and chosen(node) and (node.number in rig.shown or node.number in joints):
                found.add(node.number)
        return found

    def move(self, number):
        node = self.rig.nodes[number]
        parent_old = self.old[node.parent] if node.parent is not None else UNIT
        parent_new = self.new[node.parent] if node.parent is not None else UNIT
        world = self.old[number]
        still = number not in self.places or is_singular(world) or is_singular(parent_old)
        if not still:
            place, gradient = self.deformation.at(origin(world))
            wanted = polar(gradient)
            self.frames[number] = place, gradient
            self.lag[number] = math.dist(place, origin(world))
            back = inverse(parent_new)
            g = product(linear(back), wanted, linear(parent_old))
            if norm(sum_of(product(transposed(g), g), UNIT, 1, -1)) > SHEAR:
                self.sheared.append(number)
                g = UNIT
            self.turns[number] = g
            at = apply(back, place)
            if node.matrix:
                node.matrix = placed(product(g, linear(node.matrix)), at)
            else:
                node.parts = {"translation": at, "scale": node.parts["scale"],
                              "rotation": quaternions_product(quaternion(g), node.parts["rotation"])}
        self.new[number] = product(parent_new, node.local())

    def follow_skin(self, index):
        """The similarity of a skin; its inverse binds are replaced."""
        skin = self.before.skins[index]
        if self.new[skin.joints[0]] is None:
            return None
        x = origin(self.old[skin.joints[0]])
        place, gradient = self.deformation.at(x) if skin.joints[0] in self.places else (x, UNIT)
        size = determinant(gradient)
        similar = [(size ** (1 / 3) if size > 0 else 1.0) * v for v in polar(gradient)]
        similar = placed(similar, [a - b for a, b in zip(place, turn(similar, x))])
        binds = [product(inverse(self.new[j]), similar, self.old[j], bind) if not is_singular(self.old[j]) else bind
                 for j, bind in zip(skin.joints, skin.inverse_binds)]
        self.rig.skins[index] = type(skin)(skin.joints, binds)
        return similar

    def follow_shape(self, key):
        shape, node = self.before.shapes[key], self.before.nodes[key[0]]
        found = copy.copy(shape)
        if shape.influences is None:
            def there(_):
                return self.old[key[0]]

            def back(_):
                return inverse(self.new[key[0]])
        else:
            joints = self.before.joints(node.skin, self.old)

            def there(i):
                return blend(joints, shape.influences[i])

            def back(i):
                return product(inverse(there(i)), inverse(self.similar[node.skin]))

        def carry(i, p):
            if is_singular(there(i)):
                return p
            return apply(back(i), self.deformation(apply(there(i), p)))

        found.positions = [carry(i, p) for i, p in enumerate(shape.positions)]
        found.targets = [target and [tuple(a - b for a, b in zip(carry(i, tuple(map(sum, zip(p, d)))), q))
                                     for i, (p, d, q) in enumerate(zip(shape.positions, target, found.positions))]
                         for target in shape.targets]
        return found

    def follow_channel(self, channel):
        found = copy.copy(channel)
        if channel.node not in self.turns or channel.path not in ("translation", "rotation"):
            return found
        step = 3 if channel.interpolation == "CUBICSPLINE" else 1
        if channel.path == "rotation":
            g = quaternion(self.turns[channel.node])
            found.values = [quaternions_product(g, v) for v in channel.values]
            return found
        rest = self.before.nodes[channel.node].parts["translation"]
        parent = self.before.nodes[channel.node].parent
        old, new = (UNIT, UNIT) if parent is None else (self.old[parent], self.new[parent])
        carry = product(linear(inverse(new)), self.frames[channel.node][1], linear(old))
        begin = self.rig.nodes[channel.node].parts["translation"]
        found.values = [tuple(b + d for b, d in zip(begin, turn(carry, [a - b for a, b in zip(v, rest)])))
                        if i % step == step // 2 else turn(carry, v) for i, v in enumerate(channel.values)]
        return found

