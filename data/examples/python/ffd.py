"""What twist_frames.py needs of the library, through ctypes: a lattice, u,v,w of points, displacements.

The functions and structures are those of include/ffd; what is not here is added in the same way."""

import ctypes
import json
from ctypes import POINTER, Structure, byref, c_bool, c_char, c_char_p, c_double, c_int, c_size_t, c_uint8, c_uint32, c_void_p


class ErrorRecord(Structure):
    """ffd_error of ffd/error.h"""
    _fields_ = [("status", c_int), ("file", c_char * 1024), ("line", c_size_t), ("pointer", c_char * 256),
                ("message", c_char * 512)]


class Location(Structure):
    """ffd_location of ffd/embedding.h"""
    _fields_ = [("uvw", c_double * 3), ("residual", c_double), ("status", c_uint8), ("unresolved", c_bool),
                ("evaluations", c_uint32), ("leaves", c_uint32)]


library = ctypes.CDLL("libffd.so.0.2")


def _declare(name, *arguments, result=c_int):
    function = getattr(library, name)
    function.argtypes, function.restype = arguments, result
    return function


_format = _declare("ffd_error_format", POINTER(ErrorRecord), c_char_p, c_size_t, result=c_size_t)
_parse = _declare("ffd_lattice_parse", c_char_p, c_size_t, c_char_p, POINTER(c_void_p), POINTER(ErrorRecord))
_lattice_destroy = _declare("ffd_lattice_destroy", POINTER(c_void_p), result=None)
_locator_create = _declare("ffd_locator_create", c_void_p, POINTER(c_void_p), POINTER(ErrorRecord))
_locator_locate = _declare("ffd_locator_locate", c_void_p, POINTER(c_double), c_size_t, c_void_p, POINTER(Location),
                           c_size_t, POINTER(ErrorRecord))
_locator_destroy = _declare("ffd_locator_destroy", POINTER(c_void_p), result=None)
_displacement = _declare("ffd_displacement", c_void_p, POINTER(c_double), POINTER(c_double), POINTER(c_double))


class Error(Exception):
    """What the library says of a failure."""


def _call(function, *arguments):
    """Calls a function that takes an ffd_error last."""
    error = ErrorRecord()
    if function(*arguments, byref(error)):
        line = ctypes.create_string_buffer(2048)
        _format(byref(error), line, len(line))
        raise Error(line.value.decode())


class Lattice:
    """A lattice from a dict of the form that lattice files have."""

    def __init__(self, content):
        self.handle = c_void_p()
        text = json.dumps(content).encode()
        _call(_parse, text, len(text), b"lattice", byref(self.handle))

    def __del__(self):
        _lattice_destroy(byref(self.handle))

    def locate(self, points):
        """u,v,w of points by the lattice at rest: an array of Location, for displace of this lattice and of any
        other with the same rest."""
        coordinates = (c_double * (3 * len(points)))(*(x for point in points for x in point))
        locations = (Location * len(points))()
        locator = c_void_p()
        _call(_locator_create, self.handle, byref(locator))
        try:
            _call(_locator_locate, locator, coordinates, len(points), None, locations, ctypes.sizeof(Location))
        finally:
            _locator_destroy(byref(locator))
        return locations

    def displace(self, points, locations):
        """The points where the moved control points carry them."""
        delta = (c_double * 3)()
        moved = []
        for point, location in zip(points, locations):
            # Outside u,v,w are not numbers, and the point stays.
            if location.uvw[0] == location.uvw[0] and _displacement(self.handle, location.uvw, delta, None):
                point = [x + d for x, d in zip(point, delta)]
            moved.append(point)
        return moved
