"""Run in Blender: makes a scene of random lattices that act on clouds of points, saves it, and writes what Blender makes of them.

    make_scene.py -- FOLDER SEED

FOLDER gets scene.blend and blender.json: of each object the points in the world before and after, at each frame where there are several.
"""

import json
import os
import random
import sys

import bpy
from mathutils import Euler, Matrix, Vector

TYPES = ["KEY_LINEAR", "KEY_CARDINAL", "KEY_CATMULL_ROM", "KEY_BSPLINE"]
FRAMES = range(3, 9)


def add(name, data):
    thing = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(thing)
    return thing


def add_cage(random_, name, size, types, moved=0.2):
    data = bpy.data.lattices.new(name)
    data.interpolation_type_u, data.interpolation_type_v, data.interpolation_type_w = types
    data.points_u, data.points_v, data.points_w = size
    for point in data.points:
        point.co_deform = point.co + Vector(random_.uniform(-moved, moved) for _ in range(3))
    return add(name, data)


def turn(random_):
    return Euler([random_.uniform(-3, 3) for _ in range(3)]).to_matrix().to_4x4()


def place(random_, cage, negative=False):
    scale = [random_.uniform(0.5, 2) for _ in range(3)]
    if negative:
        scale[random_.randrange(3)] *= -1
    cage.matrix_world = Matrix.Translation([random_.uniform(-2, 2) for _ in range(3)]) @ turn(random_) @ Matrix.Diagonal(scale + [1])


def bounds(data):
    points = [point.co for point in data.points]
    return [[bound(p[d] for p in points) for d in range(3)] for bound in (min, max)]


def add_cloud(random_, name, cage, count=400, reach=1.0):
    """Points round a lattice, whose object has a matrix of its own. reach: in sides of the lattice, beyond it."""
    bpy.context.view_layer.update()
    low, high = bounds(cage.data)
    sides = [max(h - l, 1) for l, h in zip(low, high)]
    own = Matrix.Translation([random_.uniform(-1, 1) for _ in range(3)]) @ turn(random_) @ Matrix.Diagonal([random_.uniform(0.5, 2) for _ in range(3)] + [1])
    to_own = own.inverted() @ cage.matrix_world
    points = [to_own @ Vector(random_.uniform(l - reach * s, h + reach * s) for l, h, s in zip(low, high, sides)) for _ in range(count)]
    data = bpy.data.meshes.new(name)
    data.from_pydata(points, [], [])
    cloud = add(name, data)
    cloud.matrix_world = own
    return cloud


def use(cloud, cage, strength=1.0, name="Lattice"):
    modifier = cloud.modifiers.new(name, "LATTICE")
    modifier.object, modifier.strength = cage, strength
    return modifier


def weigh(random_, cloud, modifier, name="mask"):
    """Weights of a group, in which not every vertex is."""
    group = cloud.vertex_groups.new(name=name)
    for index in range(len(cloud.data.vertices)):
        if random_.random() < 0.8:
            group.add([index], random_.random(), "REPLACE")
    modifier.vertex_group = name


def add_keys(random_, cage, count=2):
    cage.shape_key_add(name="Basis")
    for k in range(count):
        key = cage.shape_key_add(name=f"key {k}")
        for point in key.data:
            point.co = point.co + Vector(random_.uniform(-0.3, 0.3) for _ in range(3))
        key.value = random_.random()


def animate(owner, path, values):
    for frame, value in zip(FRAMES, values):
        setattr(owner, path, value)
        owner.keyframe_insert(path, frame=frame)


def plain_scenes(random_):
    """A lattice of each kind."""
    for kind in TYPES:
        cage = add_cage(random_, f"{kind} cage", [random_.randint(2, 5) for _ in range(3)], [kind] * 3)
        place(random_, cage)
        use(add_cloud(random_, kind, cage), cage)
    for n in range(4):
        cage = add_cage(random_, f"mixed {n} cage", [random_.randint(1, 5) for _ in range(3)], [random_.choice(TYPES) for _ in range(3)])
        place(random_, cage, negative=n % 2)
        use(add_cloud(random_, f"mixed {n}", cage), cage, random_.uniform(-0.5, 1.5))
    for name, size in (("flat", [4, 1, 3]), ("row", [1, 5, 1]), ("point", [1, 1, 1]), ("fine", [64, 2, 2])):
        cage = add_cage(random_, f"{name} cage", size, [random_.choice(TYPES) for _ in range(3)], 0.2)
        place(random_, cage)
        use(add_cloud(random_, name, cage), cage)
    cage = add_cage(random_, "far cage", [4, 3, 4], ["KEY_BSPLINE", "KEY_CARDINAL", "KEY_CATMULL_ROM"])
    place(random_, cage)
    use(add_cloud(random_, "far", cage, reach=9), cage)


def special_scenes(random_):
    cage = add_cage(random_, "shared/cage", [3, 4, 3], TYPES[1:])
    place(random_, cage)
    for name in ("shared/1", "shared.2", "Größe 形"):
        use(add_cloud(random_, name, cage), cage)
    mother = add("mother", None)
    mother.rotation_euler, mother.scale = (0.3, 0.4, 0.5), (1, 2, 0.7)
    sheared = add_cage(random_, "sheared cage", [3, 3, 4], TYPES[:3])
    sheared.parent, sheared.rotation_euler = mother, (0.7, -0.4, 0.2)
    use(add_cloud(random_, "sheared", sheared, reach=0), sheared)
    outside = add_cage(random_, "outside cage", [5, 5, 5], ["KEY_BSPLINE"] * 3)
    outside.data.use_outside = True
    use(add_cloud(random_, "outside", outside), outside, 0.6)
    hooked = add_cage(random_, "hooked cage", [3, 3, 3], ["KEY_BSPLINE"] * 3)
    hook = hooked.modifiers.new("Hook", "HOOK")
    hook.object, hook.strength = mother, 0.5
    hook.vertex_indices_set(range(9, 27))
    hook.matrix_inverse = Matrix.Translation((0.1, 0.2, -0.3))
    use(add_cloud(random_, "hooked", hooked), hooked)
    for name, invert in (("weighted", False), ("inverted", True)):
        cloud = add_cloud(random_, name, cage)
        modifier = use(cloud, cage)
        weigh(random_, cloud, modifier)
        modifier.invert_vertex_group = invert
    for name, invert in (("empty group", False), ("empty group inverted", True)):
        cloud = add_cloud(random_, name, cage)
        cloud.vertex_groups.new(name="empty")
        modifier = use(cloud, cage)
        modifier.vertex_group, modifier.invert_vertex_group = "empty", invert
    for name, groups in (("no group", False), ("no such group", True)):
        cloud = add_cloud(random_, name, cage)
        modifier = use(cloud, cage)
        if groups:
            weigh(random_, cloud, modifier, "other")
        group = cloud.vertex_groups.new(name="missing")
        modifier.vertex_group = "missing"
        cloud.vertex_groups.remove(group)
    keyed = add_cage(random_, "keyed cage", [3, 3, 3], ["KEY_BSPLINE", "KEY_LINEAR", "KEY_CARDINAL"])
    add_keys(random_, keyed)
    place(random_, keyed)
    use(add_cloud(random_, "keyed", keyed), keyed, 0.7)


def moving_scenes(random_):
    moved = add_cage(random_, "moved cage", [2, 2, 2], ["KEY_LINEAR"] * 3)
    use(add_cloud(random_, "moved", moved), moved)
    animate(moved, "location", [(frame, 0, 0) for frame in FRAMES])
    cage = add_cage(random_, "cage", [3, 3, 3], ["KEY_BSPLINE", "KEY_LINEAR", "KEY_CATMULL_ROM"])
    add_keys(random_, cage)
    place(random_, cage)
    cloud = add_cloud(random_, "moving", cage)
    animate(use(cloud, cage), "strength", [random_.uniform(-0.5, 1) for _ in FRAMES])
    for key in cage.data.shape_keys.key_blocks[1:]:
        animate(key, "value", [random_.random() for _ in FRAMES])
    driven = add_cage(random_, "driven cage", [2, 3, 2], ["KEY_BSPLINE"] * 3)
    cloud = add_cloud(random_, "driven", driven)
    use(cloud, driven).driver_add("strength").driver.expression = "frame / 10"
    bpy.context.scene.render.fps, bpy.context.scene.render.fps_base = 30, 1.001


def weights(cloud):
    """As the modifier heeds them; None: all vertices move."""
    modifier, mesh = cloud.modifiers[0], cloud.data
    group = cloud.vertex_groups.get(modifier.vertex_group)
    if not group or not any(len(v.groups) for v in mesh.vertices):
        return None
    found = [sum(g.weight for g in v.groups if g.group == group.index) for v in mesh.vertices]
    return [1 - w for w in found] if modifier.invert_vertex_group else found


def positions(cloud, graph=None):
    mesh = cloud.evaluated_get(graph).data if graph else cloud.data
    matrix = [list(row) for row in cloud.matrix_world]
    # In double: the world's matrix is what ffd is given.
    return [[sum(matrix[r][c] * x for c, x in enumerate(v.co)) + matrix[r][3] for r in range(3)] for v in mesh.vertices]


def main(folder, kind, seed):
    random_ = random.Random(int(seed))
    bpy.ops.wm.read_factory_settings(use_empty=True)
    {"plain": plain_scenes, "special": special_scenes, "moving": moving_scenes}[kind](random_)
    bpy.context.view_layer.update()
    clouds = [thing for thing in bpy.context.scene.objects if thing.type == "MESH"]
    frames = FRAMES if kind == "moving" else [bpy.context.scene.frame_current]
    found = {cloud.name: {"before": positions(cloud), "after": []} for cloud in clouds}
    for cloud in clouds:
        if weights(cloud):
            found[cloud.name]["weights"] = weights(cloud)
    for frame in frames:
        if kind == "moving":
            bpy.context.scene.frame_set(frame)
        graph = bpy.context.evaluated_depsgraph_get()
        for cloud in clouds:
            found[cloud.name]["after"].append(positions(cloud, graph))
    rate = bpy.context.scene.render.fps / bpy.context.scene.render.fps_base
    with open(os.path.join(folder, "blender.json"), "w", encoding="utf-8") as file:
        json.dump({"frames": list(frames), "rate": rate, "objects": found}, file)
    bpy.ops.wm.save_as_mainfile(filepath=os.path.join(folder, "scene.blend"))


main(*sys.argv[sys.argv.index("--") + 1:])
