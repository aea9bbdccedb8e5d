# SPDX-License-Identifier: MIT
"""Writes a lattice file of ffd for each Lattice modifier of a scene of Blender.

    blender -b scene.blend --python-exit-code 1 -P ffd_export.py -- --out DIR --up y

The deformation is Blender's with `ffd deform IN OUT -l FILE --outside extend`. data/blender/README.md says what is exact.
"""

import argparse
import os
import shlex
import sys
import tempfile

import bpy

try:
    import numpy as np
except ImportError:
    sys.exit("ffd_export: NumPy is missing, which Blender has of its own; Debian's Blender takes that of the package python3-numpy")
if __package__:
    from . import ffd_lattice_math as maths
else:
    sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
    import ffd_lattice_math as maths

ATTRIBUTE = "_ffd"
SURFACES = {"MESH", "CURVE", "SURFACE", "FONT", "META"}  # what becomes a mesh of a glTF
BEFORE_NAMES = (3, 5)  # Blender's exporter of glTF puts an underscore of its own before all names of attributes
MOVED = 1e-6  # of a matrix: its floats' rounding


class Source:
    """A Lattice modifier that can be exported, and what names it in messages."""

    def __init__(self, owner, modifier):
        self.owner, self.modifier, self.lattice = owner, modifier, modifier.object
        self.label = f"{owner.name}, {modifier.name}"
        self.weight = None  # the attribute that holds its vertex group


def reason_to_skip(owner, modifier):
    if modifier.object is None or modifier.object.type != "LATTICE":
        return "has no lattice"
    if modifier.object.data.is_editmode:  # Blender tells wrong points then
        return "its lattice is in edit mode"
    if not modifier.show_viewport:
        return "is off"
    if not owner.visible_get():
        return f'"{owner.name}" is hidden'
    return None


def find_sources(objects, say):
    """The modifiers of these objects, in the order of names and stacks. What is left out is told."""
    sources = []
    for owner in sorted(objects, key=lambda thing: thing.name_full):
        for place, modifier in enumerate(owner.modifiers):
            if modifier.type != "LATTICE":
                continue
            why = reason_to_skip(owner, modifier)
            if why:
                say(f"{owner.name}, {modifier.name}: skipped: {why}")
                continue
            source = Source(owner, modifier)
            sources.append(source)
            if any(before.type != "LATTICE" and before.show_viewport for before in list(owner.modifiers)[:place]):
                say(f"{source.label}: stands behind other modifiers, and acts on what they make")
            if modifier.object.data.vertex_group:
                say(f'{source.label}: the vertex group "{modifier.object.data.vertex_group}" of the lattice is not carried')
    return sources


# Weights


def has_weights(owner, name):
    """Whether Blender heeds the vertex group: a mesh none of whose vertices is in any group moves as a whole."""
    return bool(name) and owner.type == "MESH" and name in owner.vertex_groups and any(len(v.groups) for v in owner.data.vertices)


def group_weights(owner, modifier):
    """How far each vertex of a mesh moves; None: all as far as the lattice says."""
    if not has_weights(owner, modifier.vertex_group):
        return None
    group = owner.vertex_groups[modifier.vertex_group].index
    weights = np.zeros(len(owner.data.vertices), np.float32)
    for vertex in owner.data.vertices:
        for membership in vertex.groups:
            if membership.group == group:
                weights[vertex.index] = membership.weight
    return 1 - weights if modifier.invert_vertex_group else weights


def is_ours(attribute):
    return attribute.data_type == "FLOAT" and attribute.domain == "POINT"


def give_attributes(sources, say):
    """Copies the vertex groups of modifiers to attributes of the meshes: _ffd, of a second one _ffd_2. Blender's exporter of glTF
    carries attributes whose names begin with an underscore, when it is asked to."""
    given = {}  # of a mesh: its attributes by group
    for source in sources:
        modifier, mesh = source.modifier, source.owner.data
        weights = group_weights(source.owner, modifier)
        if weights is None:
            if modifier.vertex_group:
                say(f'{source.label}: there are no weights of a vertex group "{modifier.vertex_group}": as in Blender, all vertices move')
            continue
        names = given.setdefault(mesh, {})
        group = modifier.vertex_group, modifier.invert_vertex_group
        if group not in names:
            names[group] = ATTRIBUTE if not names else f"{ATTRIBUTE}_{len(names) + 1}"
            if not write_attribute(mesh, names[group], weights):
                say(f'{source.label}: the mesh "{mesh.name}" takes no attribute {names[group]}: its vertex group is not carried')
                continue
        source.weight = names[group]


def write_attribute(mesh, name, weights):
    attribute = mesh.attributes.get(name)
    if mesh.library or mesh.override_library or mesh.is_editmode or (attribute and not is_ours(attribute)):
        return False
    attribute = attribute or mesh.attributes.new(name, "FLOAT", "POINT")
    attribute.data.foreach_set("value", weights)
    return True


# Lattices


class Moment:
    """A lattice as Blender evaluates it, with the modifier's strength."""

    def __init__(self, source, graph):
        cage = source.lattice.evaluated_get(graph)
        data = cage.data
        self.size = [data.points_u, data.points_v, data.points_w]
        self.types = [data.interpolation_type_u, data.interpolation_type_v, data.interpolation_type_w]
        self.matrix = np.array(cage.matrix_world, float)
        self.owner_matrix = np.array(source.owner.evaluated_get(graph).matrix_world, float)
        rest, deformed = (self._points(data, name) for name in ("co", "co_deform"))
        self.first = [rest.flat[d] for d in range(3)]
        self.step = [(rest[-1, -1, -1, d] - rest[0, 0, 0, d]) / (n - 1) if n > 1 else 0.0 for d, n in enumerate(self.size)]
        strength = source.owner.evaluated_get(graph).modifiers[source.modifier.name].strength
        self.offsets = strength * (deformed - rest)

    def _points(self, data, name):
        flat = np.empty(3 * len(data.points), np.float32)
        data.points.foreach_get(name, flat)
        return flat.astype(float).reshape(self.size[::-1] + [3])


def follow(sources, context, frames):
    """The moments of all sources: one, or one for each frame, after which the scene is at the frame where it was."""
    if frames is None:
        graph = context.evaluated_depsgraph_get()
        return [[Moment(source, graph)] for source in sources]
    scene = context.scene
    before = scene.frame_current, scene.frame_subframe
    moments = [[] for _ in sources]
    try:
        for frame in range(frames[0], frames[1] + 1):
            scene.frame_set(frame)
            graph = context.evaluated_depsgraph_get()
            for list_of, source in zip(moments, sources):
                list_of.append(Moment(source, graph))
    finally:
        scene.frame_set(before[0], subframe=before[1])
    return moments


def has_moved(moments, what):
    first = getattr(moments[0], what)
    return any(np.abs(getattr(moment, what) - first).max() > MOVED * np.abs(first).max() for moment in moments)


def warn_of_motion(source, moments, say):
    for what, thing in (("matrix", source.lattice), ("owner_matrix", source.owner)):
        if has_moved(moments, what):
            say(f'{source.label}: the object "{thing.name}" itself moves: the lattice stands as at the first frame')


def document_of(moments, frames, scene, up):
    """The content of a lattice file. Raises maths.Refused."""
    first = moments[0]
    if any(moment.size != first.size or moment.types != first.types for moment in moments):
        raise maths.Refused("has other points or interpolations at other frames")
    rate = scene.render.fps / scene.render.fps_base
    times = None if frames is None else [frame / rate for frame in range(frames[0], frames[1] + 1)]
    offsets = first.offsets if frames is None else [moment.offsets for moment in moments]
    return maths.lattice_document(first.types, first.size, first.first, first.step, first.matrix, offsets, up, times)


def make_texts(sources, context, frames, up, say):
    """The texts of lattice files, beside their sources. What cannot be written is told and left out."""
    made = []
    for source, moments in zip(sources, follow(sources, context, frames)):
        try:
            text = maths.text_of(document_of(moments, frames, context.scene, up)) + "\n"
        except maths.Refused as error:
            say(f'{source.label}: skipped: the lattice "{source.lattice.name}" {error}')
            continue
        warn_of_motion(source, moments, say)
        made.append((source, text))
    return made


# Files


def write_file(path, text, replaces):
    """Writes a file that is complete or absent. Raises maths.Refused, OSError."""
    folder = os.path.dirname(os.path.abspath(path))
    handle, draft = tempfile.mkstemp(prefix=".ffd_export-", dir=folder)
    try:
        with os.fdopen(handle, "w", encoding="utf-8", newline="\n") as file:
            file.write(text)
        mask = os.umask(0)
        os.umask(mask)
        os.chmod(draft, 0o666 & ~mask)
        if replaces:
            os.replace(draft, path)
        else:
            place_new(draft, path)
    except BaseException:
        if os.path.exists(draft):
            os.unlink(draft)
        raise


def place_new(draft, path):
    """Gives the draft its name, unless that is taken, also by a file that has just appeared. Some file systems have no links."""
    try:
        os.link(draft, path)
    except FileExistsError:
        raise maths.Refused(f"{path}: exists already") from None
    except OSError:
        if os.path.lexists(path):
            raise maths.Refused(f"{path}: exists already") from None
        os.rename(draft, path)
        return
    os.unlink(draft)


def write_all(files, replaces, advice):
    """Writes (path, text); nothing where one of them exists already. Raises maths.Refused."""
    for path, _ in files:
        if os.path.isdir(path):
            raise maths.Refused(f"{path}: is a folder")
        if os.path.lexists(path) and not replaces:
            raise maths.Refused(f"{path}: exists already ({advice})")
    for path, text in files:
        try:
            write_file(path, text, replaces)
        except OSError as error:
            raise maths.Refused(f"{path}: {error.strerror}") from None


# The command line


def say(text):
    print(f"ffd_export: {text}", file=sys.stderr, flush=True)


class Parser(argparse.ArgumentParser):
    def error(self, message):
        say(f"{message} (--help)")
        sys.exit(2)


def read_frames(text):
    words = text.split(":")
    if len(words) != 2 or not all(word.isdigit() for word in words) or int(words[0]) >= int(words[1]):
        raise argparse.ArgumentTypeError(f'"{text}" is not a:b with whole numbers from 0 on, the second greater')
    return int(words[0]), int(words[1])


def make_parser():
    parser = Parser(prog="blender -b scene.blend --python-exit-code 1 -P ffd_export.py --", description="Writes a lattice file of ffd for each "
                    "Lattice modifier of the scene: DIR/OBJECT-MODIFIER.json. Strength and the mix of shape keys are in it; a vertex group becomes the "
                    "attribute _ffd of the mesh.", epilog="The exit code is 1 when nothing was written, 2 for a wrong command line. "
                    "--python-exit-code 1 makes it 1 also for an error of Blender itself.")
    parser.add_argument("--out", metavar="DIR", required=True, help="the folder of the lattice files, which exists")
    parser.add_argument("--object", "--name", metavar="NAME", action="append", dest="names", help="only this object's modifiers (repeatable)")
    parser.add_argument("--frames", metavar="a:b", type=read_frames, help="a key for each of these frames, at the time frame / fps")
    parser.add_argument("--up", choices=("y", "z"), default="z", help="y: turned for glTF, (x, y, z) to (x, z, -y); default: z, as in Blender")
    parser.add_argument("--force", action="store_true", help="replace files that exist")
    return parser


def named_objects(names, view_layer):
    """Objects by their names; without names all of the scene. Raises maths.Refused."""
    found = [thing for thing in view_layer.objects if not names or thing.name in names]
    for name in names or []:
        if not any(thing.name == name for thing in found):
            raise maths.Refused(f'the scene has no object "{name}"')
    return found


def run(options):
    """Raises maths.Refused."""
    if not os.path.isdir(options.out):
        raise maths.Refused(f"{options.out}: is not a folder")
    context = bpy.context
    sources = find_sources(named_objects(options.names, context.view_layer), say)
    texts = make_texts(sources, context, options.frames, options.up, say)
    if not texts:
        raise maths.Refused(f'nothing was written: the scene "{context.scene.name}" has no Lattice modifier to export')
    taken = set()
    files = [(os.path.join(options.out, maths.file_name(source.owner.name, source.modifier.name, taken)), text) for source, text in texts]
    write_all(files, options.force, "--force replaces it")
    give_attributes([source for source, _ in texts], say)
    for (path, _), (source, _) in zip(files, texts):
        print(f"{path} ({advice_for(source, context.view_layer.objects)})", flush=True)


def advice_for(source, objects):
    """The options of ffd with which the lattice acts as in Blender on a glTF of these objects: on its own one alone."""
    owner = source.owner
    words = "--outside extend"
    if any(thing.type in SURFACES and thing != owner for thing in objects):
        # A node is taken with all that is below it, a mesh with all objects that have it.
        is_single = owner.type == "MESH" and owner.data.users - owner.data.use_fake_user == 1
        words += " --only " + shlex.quote(f"mesh:{owner.data.name}" if is_single else f"node:{owner.name}")
    if source.weight:
        words += f" --weight attribute:{'_' if bpy.app.version < BEFORE_NAMES else ''}{source.weight}"
    return words


def main(words):
    options = make_parser().parse_args(words)
    try:
        run(options)
    except maths.Refused as error:
        say(error)
        if bpy.app.background:  # a window stays open
            sys.exit(1)


if __name__ == "__main__":
    main(sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else [])
