"""Reads the PNG files of ffd view: 8 bits, red, green, blue."""

import itertools
import struct
import zlib

from harness import check, equal
from png_make import SIGNATURE


def chunks(content):
    equal(content[:8], SIGNATURE, "the signature of a PNG")
    at = 8
    while at < len(content):
        size, kind = struct.unpack_from(">I4s", content, at)
        data = content[at + 8:at + 8 + size]
        equal(struct.unpack_from(">I", content, at + 8 + size)[0], zlib.crc32(kind + data), "the checksum of a chunk")
        yield kind, data
        at += 12 + size


def paeth(line, above):
    """A channel of a row: what is nearest to left + up - corner was taken away."""
    left = corner = 0
    for x, up in zip(line, above):
        if left == corner:
            nearest = up
        elif up == corner:
            nearest = left
        else:
            by_left, by_up, by_corner = abs(up - corner), abs(left - corner), abs(left + up - 2 * corner)
            nearest = left if by_left <= by_up and by_left <= by_corner else up if by_up <= by_corner else corner
        left = (x + nearest) & 255
        corner = up
        yield left


def average(line, above):
    left = 0
    for x, up in zip(line, above):
        left = (x + (left + up) // 2) & 255
        yield left


def unfilter(kind, line, above):
    """The bytes of a row of filtered ones. Pictures have a million bytes: what is quick for most of them."""
    check(kind < 5, "a filter of PNG")
    if kind in (2, 4) and line.count(0) == len(line):  # like the row above
        return above
    if kind == 2:
        return bytes((x + up) & 255 for x, up in zip(line, above))
    if kind == 0:
        return line
    found = bytearray(len(line))
    for channel in range(3):
        own, up = line[channel::3], above[channel::3]
        found[channel::3] = bytes(x & 255 for x in itertools.accumulate(own)) if kind == 1 else \
            bytes(average(own, up) if kind == 3 else paeth(own, up))
    return bytes(found)


def read_png(content):
    """Rows of (red, green, blue)."""
    found = list(chunks(content))
    equal([found[0][0], found[-1][0]], [b"IHDR", b"IEND"], "the ends of a PNG")
    width, height, depth, color, *rest = struct.unpack(">IIBBBBB", found[0][1])
    equal([depth, color, rest], [8, 2, [0, 0, 0]], "kind of PNG")
    data = zlib.decompress(b"".join(data for kind, data in found if kind == b"IDAT"))
    check(len(data) == height * (1 + 3 * width), "the size of the pixels")
    rows, above, size = [], bytes(3 * width), 1 + 3 * width
    for y in range(height):
        above = unfilter(data[y * size], data[y * size + 1:(y + 1) * size], above)
        rows.append(list(zip(above[::3], above[1::3], above[2::3])))
    return rows
