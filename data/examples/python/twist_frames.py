"""Frames of an animation: points are twisted more and more about the y axis.

    python3 twist_frames.py POINTS DEGREES FRAMES

POINTS is text, x y z a line (numpy.savetxt writes it so). Frame n goes to frame-n.txt in the same form; the last one is twisted by
DEGREES. The points are embedded once, and every frame costs an evaluation of the volume only. ctypes calls the library."""

import array
import ctypes
import json
import sys
from ctypes import byref, c_double, c_int, c_size_t, c_ssize_t, c_void_p

LIBRARY = ctypes.CDLL("libffd.so.0.3")


class Span(ctypes.Structure):
    """ffd_span of ffd/points.h"""
    _fields_ = [("data", c_void_p), ("count", c_size_t), ("type", c_int), ("stride", c_ssize_t), ("step", c_ssize_t)]


class Description(ctypes.Structure):
    """ffd_embedding_desc of ffd/points.h"""
    _fields_ = [("struct_size", c_size_t), ("lattice", c_void_p), ("points", Span), ("outside", c_int), ("falloff", c_double),
                ("snap", c_double)]


def call(name, *arguments):
    """Calls a function that takes an ffd_error last, for which 4096 bytes are enough."""
    error, line = ctypes.create_string_buffer(4096), ctypes.create_string_buffer(2048)
    if getattr(LIBRARY, name)(*arguments, error):
        LIBRARY.ffd_error_format(error, line, c_size_t(len(line)))
        sys.exit(f"twist_frames: {line.value.decode()}")


def twist(xyz, degrees):
    """A lattice round the points whose layers along y turn, the last one by so many degrees."""
    box = {"min": [min(xyz[a::3]) for a in range(3)], "max": [max(xyz[a::3]) for a in range(3)]}
    text = json.dumps({"format": "ffd-lattice", "version": 1, "size": [4, 6, 4], "rest": {"box": box},
                       "moves": [{"twist": {"axis": "y", "degrees": degrees}}]}).encode()
    lattice = c_void_p()
    call("ffd_lattice_parse", text, c_size_t(len(text)), b"twist", byref(lattice))
    return lattice


if len(sys.argv) != 4:
    sys.exit(__doc__)
xyz, degrees, frames = array.array("d", map(float, open(sys.argv[1]).read().split())), float(sys.argv[2]), int(sys.argv[3])
moved, desc, embedding = array.array("d", xyz), Description(), c_void_p()
rest, result = (Span(data=numbers.buffer_info()[0], count=len(numbers) // 3) for numbers in (xyz, moved))
LIBRARY.ffd_embedding_desc_init(byref(desc), c_size_t(ctypes.sizeof(desc)))
desc.lattice, desc.points = twist(xyz, 0), rest
call("ffd_embedding_create", byref(desc), None, byref(embedding))
for frame in range(1, frames + 1):
    lattice = twist(xyz, degrees * frame / frames)
    call("ffd_embedding_deform", embedding, lattice, rest, result, None, None)
    LIBRARY.ffd_lattice_destroy(byref(lattice))
    with open(f"frame-{frame}.txt", "w", encoding="ascii") as file:
        file.writelines("{!r} {!r} {!r}\n".format(*moved[i:i + 3]) for i in range(0, len(moved), 3))
