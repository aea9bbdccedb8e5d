#!/usr/bin/env python3
"""Texture coordinates of glTF in other formats: of the set that the base colour's texture takes, transformed as the
material says (KHR_texture_transform), of any type; what stays behind is told."""
import math

from gltf_build import Scene
from harness import INVALID, case, check, equal, lattice, main, near
from messages import anything

STILL = lattice(low=(-9, -9, -9), high=(9, 9, 9), moves=[])
CORNERS = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]  # v goes down
OTHERS = [(0.5, 0.25), (0.75, 0.25), (0.75, 0.5), (0.5, 0.5)]
MORE = "further texture coordinates"


def texture(set_=None, transform=None):
    info = {"index": 0}
    if set_ is not None:
        info["texCoord"] = set_
    if transform is not None:
        info["extensions"] = {"KHR_texture_transform": transform}
    return info


def base(info):
    return {"pbrMetallicRoughness": {"baseColorTexture": info}}


def write(run, materials, sets=(CORNERS,), component=5126, drawn=None, **members):
    """A quad for each number in `drawn` of a material (None: none), all of the same accessors."""
    run.write("still.json", STILL)
    scene = Scene()
    attributes = {"POSITION": scene.add([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], bounds=True)}
    for i, rows in enumerate(sets):
        if rows:
            attributes[f"TEXCOORD_{i}"] = scene.add(rows, component, "VEC2", **members)
    indices = scene.add([[i] for i in (0, 1, 2, 0, 2, 3)], 5121, "SCALAR")
    primitives = [{"attributes": attributes, "indices": indices, **({} if m is None else {"material": m})}
                  for m in (range(len(materials)) if drawn is None else drawn)]
    scene.asset.update(extensionsUsed=["KHR_texture_transform"], images=[{"uri": "x.png"}], textures=[{"source": 0}],
                       materials=materials, scene=0, scenes=[{"nodes": [0]}], nodes=[{"mesh": 0}], meshes=[{"primitives": primitives}])
    run.write("a.glb", scene.glb())


def converted(run, materials, *arguments, more=False, **options):
    """The texture coordinates of the corners 0, 1, 2, 3 of each quad, v upwards, in the file's OBJ; whether
    coordinates stay behind is as said."""
    write(run, materials, *arguments, **options)
    told = []
    run.ffd("deform", "a.glb", "a.obj", "-l", "still.json", "--force", err=lambda lines: told.extend(lines) or True)
    equal(any(MORE in line for line in told), more, told)
    values, faces = [], []
    for line in run.text("a.obj").splitlines():
        key, *words = line.split()
        if key == "vt":
            values.append([float(x) for x in words])
        elif key == "f":
            faces.append([values[int(word.split("/")[1]) - 1] if "/" in word else None for word in words])
    return [[*first, second[2]] for first, second in zip(faces[::2], faces[1::2])]


def up(points):
    return [[u, 1 - v] for u, v in points]


def transformed(points, offset=(0, 0), rotation=0.0, scale=(1, 1)):
    """Translation times rotation times scale; counter-clockwise as seen, where v goes down."""
    c, s = math.cos(rotation), math.sin(rotation)
    return [(c * scale[0] * u + s * scale[1] * v + offset[0], -s * scale[0] * u + c * scale[1] * v + offset[1])
            for u, v in points]


@case
def transforms_are_applied(run):
    """The example of the extension's text: the lower left quadrant of the image, turned clockwise by 90 degrees."""
    found, = converted(run, [base(texture(transform={"offset": [0, 1], "rotation": 1.57079632679, "scale": [0.5, 0.5]}))])
    near(found, [[0, 0], [0, 0.5], [0.5, 0.5], [0.5, 0]], 1e-11)
    exact, = converted(run, [base(texture(transform={"offset": [0, 1], "rotation": math.pi / 2, "scale": [0.5, 0.5]}))])
    equal(exact, [[0, 0], [0, 0.5], [0.5, 0.5], [0.5, 0]], "a quarter of a turn")
    inverted, = converted(run, [base(texture(transform={"offset": [0, 1], "scale": [1, -1]}))])
    equal(inverted, [list(p) for p in CORNERS], "v is turned over twice")
    for transform in ({"offset": [0.25, -3]}, {"scale": [2, 0.125]}, {"rotation": 0.3}, {"rotation": -200.0},
                      {"offset": [1e-3, 7], "rotation": 2.5, "scale": [3, -0.25]}, {}):
        found, = converted(run, [base(texture(transform=transform))], (OTHERS,))
        near(found, up(transformed(OTHERS, **transform)), 1e-12, transform)
    for transform in ({"offset": [None, 1]}, {"scale": "2", "rotation": []}, {"rotation": 1e301, "texCoord": "0"}):
        found, = converted(run, [base(texture(transform=transform))], (OTHERS,))
        equal(found, up(transformed(OTHERS, transform.get("offset") and (0, 1) or (0, 0))), f"{transform}: numbers that are there")
    # Every target gets them.
    write(run, [base(texture(transform={"scale": [0.5, 0.25]}))])
    for target in ("ply", "off"):
        run.ffd("deform", "a.glb", f"a.{target}", "-l", "still.json", "-q")
        run.ffd("deform", f"a.{target}", "b.obj", "-l", "still.json", "-q", "--force")
        equal([line for line in run.text("b.obj").splitlines() if line.startswith("vt")],
              ["vt 0 1", "vt 0.5 1", "vt 0.5 0.75", "vt 0 0.75"], target)


@case
def values_that_gltf_does_not_allow_are_named(run):
    """The warning names them, whatever is written; --strict refuses the first one. So is a set that is not there."""
    place = "/materials/0/pbrMetallicRoughness/baseColorTexture"
    inside = place + "/extensions/KHR_texture_transform"
    for info, wheres in ((texture(transform={"scale": "x"}), [inside + "/scale"]),
                         (texture(transform={"scale": [1]}), [inside + "/scale"]),
                         (texture(transform={"offset": [None, 0]}), [inside + "/offset/0"]),
                         (texture(transform={"rotation": "90", "texCoord": "1"}), [inside + "/texCoord", inside + "/rotation"]),
                         (texture(transform=[2, 2]), [inside]), (texture("1"), [place + "/texCoord"]),
                         (texture(1.5), [place + "/texCoord"])):
        found, = converted(run, [base(info)], (CORNERS, OTHERS), more=True)
        equal(found, up(CORNERS), info)
        many = len(wheres) > 1
        line = (f"a.glb: {len(wheres)} {'values are' if many else 'value is'} not what glTF allows there, "
                f"and {'are' if many else 'is'} ignored: " + ", ".join(wheres))
        for target in ("a.obj", "b.glb"):
            told = run.ffd("deform", "a.glb", target, "-l", "still.json", "--force", err=anything).err
            check(line in told, told, line)
        run.ffd("deform", "a.glb", "a.obj", "-l", "still.json", "--force", "--strict", code=INVALID,
                err=f"a.glb:{wheres[0]}: is not what glTF allows there")
    line = "a.glb: 1 primitive lacks the set of texture coordinates that its texture uses: TEXCOORD_0 takes its place"
    for info, sets, there in ((texture(1), (CORNERS,), True), (texture(0), (CORNERS,), False), (texture(1), (CORNERS, OTHERS), False),
                              (texture(1), (None,), False)):
        write(run, [base(info)], sets)
        told = run.ffd("deform", "a.glb", "a.obj", "-l", "still.json", "--force", err=anything).err
        equal(line in told, there, info)


@case
def integers_of_every_type(run):
    """Normalized ones are fractions; others are numbers that the transform brings to size (KHR_mesh_quantization)."""
    for component, largest, least in ((5120, 127, -127), (5121, 255, 0), (5122, 32767, -32767), (5123, 65535, 0)):
        rows = [(0, 0), (largest, 0), (largest, largest // 3), (least, largest // 3)]
        fractions = [(u / largest, v / largest) for u, v in rows]
        options = {"component": component, "sets": (rows,)}
        found, = converted(run, [base(texture())], normalized=True, **options)
        near(found, up(fractions), 1e-15, f"{component} normalized")
        found, = converted(run, [base(texture(transform={"scale": [1 / largest, 1 / largest]}))], **options)
        near(found, up(fractions), 1e-15, component)
        found, = converted(run, [base(texture())], **options)
        equal(found, up(rows), f"{component}: nothing says how large they are")


@case
def the_set_of_the_base_colour(run):
    """The one that KHR_texture_transform names overrides the texture's own."""
    sets = (CORNERS, OTHERS)
    for info, expected in ((texture(), CORNERS), (texture(0), CORNERS), (texture(1), OTHERS),
                           (texture(0, {"texCoord": 1}), OTHERS), (texture(1, {"texCoord": 0}), CORNERS),
                           (texture(1, {"scale": [2, 2]}), transformed(OTHERS, scale=(2, 2))),
                           (texture(2), CORNERS), (texture(1e300), CORNERS), (texture(-1), CORNERS)):  # not there
        found, = converted(run, [base(info)], sets, more=True)
        equal(found, up(expected), info)
    # Without a base colour: the colour of the older material, else the first texture; without any: the first set.
    diffuse = {"KHR_materials_pbrSpecularGlossiness": {"diffuseTexture": texture(1)}}
    for material, expected in (({"emissiveTexture": texture(0), "extensions": diffuse}, OTHERS),
                               ({"normalTexture": texture(1)}, OTHERS),
                               ({"extras": {"oddTexture": texture(1)}}, CORNERS), ({}, CORNERS)):
        found, = converted(run, [material], sets, more=True)
        equal(found, up(expected), material)
    found, = converted(run, [base(texture(1))], sets, drawn=[None], more=True)
    equal(found, up(CORNERS), "no material")
    found, = converted(run, [base(texture(1))], (None, OTHERS))
    equal(found, up(OTHERS), "the only set is not the first")


@case
def materials_share_an_accessor(run):
    """Each quad has the coordinates of its own material's transform."""
    halves = [base(texture(transform={"scale": [0.5, 1]})), base(texture(transform={"scale": [0.5, 1], "offset": [0.5, 0]}))]
    found = converted(run, halves, drawn=[0, 1, None, 0])
    low, high = up(transformed(CORNERS, scale=(0.5, 1))), up(transformed(CORNERS, (0.5, 0), scale=(0.5, 1)))
    equal(found, [low, high, up(CORNERS), low])
    equal(run.text("a.obj").count("vt "), 12, "equal ones are there once")


@case
def what_other_textures_take_is_told(run):
    """What only they take stays behind; coordinates that all share do not."""
    half = {"scale": [0.5, 0.5]}
    for material, sets, more in (
            ({**base(texture(0, half)), "normalTexture": texture(0, half)}, (CORNERS,), False),
            ({**base(texture(0, half)), "normalTexture": texture(0)}, (CORNERS,), True),
            ({**base(texture(0)), "occlusionTexture": texture(0, {"rotation": 0.5})}, (CORNERS,), True),
            ({**base(texture(0)), "occlusionTexture": texture(1)}, (CORNERS, OTHERS), True),
            ({**base(texture(0)), "occlusionTexture": texture(1)}, (CORNERS,), False),  # which is not there
            ({**base(texture(0)), "extensions": {"KHR_materials_clearcoat": {"clearcoatTexture": texture(0, half)}}},
             (CORNERS,), True),
            ({**base(texture(0)), "extras": {"oddTexture": texture(0, half)}}, (CORNERS,), False)):
        converted(run, [material], sets, more=more)
    # A target without any says it once.
    write(run, [base(texture(1))], (CORNERS, OTHERS))
    done = run.ffd("deform", "a.glb", "a.stl", "-l", "still.json", lines=1)
    check("texture coordinates" in done.err[0] and MORE not in done.err[0], done.err)


main()
