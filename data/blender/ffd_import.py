# SPDX-License-Identifier: MIT
"""Makes a lattice of Blender of a lattice file of ffd, and modifiers that use it.

    blender scene.blend -P ffd_import.py -- LATTICE.json --on OBJECT

data/blender/README.md says which lattices are exact, and what becomes of others.
"""

import argparse
import os
import sys

import bpy
from mathutils import Matrix

try:
    import numpy as np
except ImportError:
    sys.exit("ffd_import: NumPy is missing, which Blender has of its own; Debian's Blender takes that of the package python3-numpy")
if __package__:
    from . import ffd_lattice_math as maths
else:
    sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
    import ffd_lattice_math as maths


def read_text(path):
    """Raises maths.Refused."""
    try:
        with open(path, encoding="utf-8-sig") as file:
            return file.read()
    except OSError as error:
        raise maths.Refused(f"{path}: {error.strerror}") from None
    except UnicodeDecodeError:
        raise maths.Refused(f"{path}: is not UTF-8") from None


def convert(text, path, size, up):
    """What the lattice object is to have. Raises maths.Refused."""
    try:
        return maths.BlenderLattice(maths.BoxLattice(text), size, up)
    except maths.Refused as error:
        raise maths.Refused(f"{path}: {error}") from None


def tell(wanted, path, size, say):
    """What a user must know of the result."""
    if wanted.is_exact:
        grid = " x ".join(map(str, wanted.size))
        say(f"{path}: {grid} points, exact to single precision within its box{', so that the size is not used' if size else ''}")
    else:
        say(f"{path}: fitted by {' x '.join(map(str, wanted.size))} points, off by {wanted.error:.3g} at most where it was looked at within its box "
            "(README.md tells which lattices are exact)")
    say(f"{path}: Blender's lattice goes on beyond the box, where ffd's ends")


def add_lattice(wanted, name, collection):
    """Makes the object."""
    data = bpy.data.lattices.new(name)
    data.interpolation_type_u, data.interpolation_type_v, data.interpolation_type_w = wanted.types
    data.points_u, data.points_v, data.points_w = wanted.size
    flat = np.empty(3 * len(data.points), np.float32)
    data.points.foreach_get("co", flat)
    rest = flat.astype(float).reshape(wanted.size[::-1] + [3])
    matrix, offsets = wanted.placed(rest[0, 0, 0], rest[-1, -1, -1])
    data.points.foreach_set("co_deform", (rest + offsets).astype(np.float32).ravel())
    thing = bpy.data.objects.new(name, data)
    collection.objects.link(thing)
    thing.matrix_world = Matrix(matrix.tolist())
    return thing


def use_lattice(cage, objects):
    for thing in objects:
        thing.modifiers.new(cage.name, "LATTICE").object = cage


# The command line


def say(text):
    print(f"ffd_import: {text}", file=sys.stderr, flush=True)


class Parser(argparse.ArgumentParser):
    def error(self, message):
        say(f"{message} (--help)")
        sys.exit(2)


def read_size(text):
    try:
        return maths.checked_size(text)
    except maths.Refused as error:
        raise argparse.ArgumentTypeError(error) from None


def make_parser():
    parser = Parser(prog="blender scene.blend -P ffd_import.py --", description="Makes a lattice object of a lattice file of ffd, and a Lattice modifier "
                    "on each OBJECT.", epilog="The exit code is 1 when nothing was made, 2 for a wrong command line. With -b, "
                    "--python-expr \"import bpy; bpy.ops.wm.save_mainfile()\" behind -P saves the scene.")
    parser.add_argument("lattice", metavar="LATTICE.json", help="a lattice file whose rest is a box")
    parser.add_argument("--size", metavar="n,m,o", type=read_size, help="points of a lattice that is fitted (4 to 64, at most 32,000 in all); default: as many as it needs")
    parser.add_argument("--on", metavar="OBJECT", action="append", default=[], help="a mesh that gets the modifier (repeatable)")
    parser.add_argument("--up", choices=("y", "z"), default="z", help="y: the file has y up, as for glTF; default: z, as in Blender")
    return parser


def meshes_of(names, view_layer):
    """Raises maths.Refused."""
    found = []
    for name in names:
        thing = next((thing for thing in view_layer.objects if thing.name == name), None)
        if thing is None:
            raise maths.Refused(f'the scene has no object "{name}"')
        if thing.type != "MESH":
            raise maths.Refused(f'the object "{name}" is not a mesh')
        if thing not in found:
            found.append(thing)
    check_meshes(found)
    return found


def check_meshes(meshes):
    """Raises maths.Refused for one that takes no modifier."""
    for thing in meshes:
        if thing.library:
            raise maths.Refused(f'the object "{thing.name}" is linked from a library')


def run(options):
    """Raises maths.Refused."""
    context = bpy.context
    meshes = meshes_of(options.on, context.view_layer)
    wanted = convert(read_text(options.lattice), options.lattice, options.size, options.up)
    cage = add_lattice(wanted, os.path.splitext(os.path.basename(options.lattice))[0], context.scene.collection)
    use_lattice(cage, meshes)
    tell(wanted, options.lattice, options.size, say)


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
