#!/usr/bin/env python3
"""Writes the PNG files that fuzzing starts from, one for each kind of pixels. test_picture_image.c knows what they show.

    python3 tests/fuzz/make_images.py FOLDER
"""

import os
import struct
import sys
import zlib

WIDTH, HEIGHT = 11, 9
# Where the pixels of each pass of an interlaced image begin, and how far they are apart (PNG, 8.2).
PASSES = [(0, 0, 8, 8), (4, 0, 8, 8), (0, 4, 4, 8), (2, 0, 4, 4), (0, 2, 2, 4), (1, 0, 2, 2), (0, 1, 1, 2)]


def color(x, y):
    return (23 * x, 28 * y, 255 - 12 * x - 14 * y, 255 - 7 * (x + y))


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def png(header, *chunks, size=(WIDTH, HEIGHT)):
    return b"".join((b"\x89PNG\r\n\x1a\n", chunk(b"IHDR", struct.pack(">II", *size) + bytes(header)), *chunks,
                     chunk(b"IEND", b"")))


def rows(pixel, interlaced=False):
    """Filter 0 before each row; filters 1 and 2 where rows are whole bytes are left to the mutations."""
    data = b""
    for x0, y0, dx, dy in PASSES if interlaced else [(0, 0, 1, 1)]:
        for y in range(y0, HEIGHT, dy):
            line = b"".join(pixel(x, y) for x in range(x0, WIDTH, dx))
            data += b"\0" + line if line else b""
    return chunk(b"IDAT", zlib.compress(data))


def bits(x, y):
    return (x + y) % 2


def bit_rows():
    data = b""
    for y in range(HEIGHT):
        number = int("".join(str(bits(x, y)) for x in range(WIDTH)).ljust(16, "0"), 2)
        data += b"\0" + number.to_bytes(2, "big")
    return chunk(b"IDAT", zlib.compress(data))


def files():
    yield "rgb8", png((8, 2, 0, 0, 0), rows(lambda x, y: bytes(color(x, y)[:3])))
    yield "rgba8", png((8, 6, 0, 0, 0), rows(lambda x, y: bytes(color(x, y))))
    yield "interlaced", png((8, 6, 0, 0, 1), rows(lambda x, y: bytes(color(x, y)), True))
    yield "rgb16", png((16, 2, 0, 0, 0), rows(lambda x, y: b"".join(bytes((c, c)) for c in color(x, y)[:3])))
    yield "gray8", png((8, 0, 0, 0, 0), rows(lambda x, y: bytes(color(x, y)[:1])))
    yield "gray-alpha", png((8, 4, 0, 0, 0), rows(lambda x, y: bytes((color(x, y)[0], color(x, y)[3]))))
    yield "gray1", png((1, 0, 0, 0, 0), bit_rows())
    yield "palette", png((1, 3, 0, 0, 0), chunk(b"PLTE", bytes((10, 20, 30, 200, 210, 220))), chunk(b"tRNS", b"\x40"),
                         bit_rows())
    text = chunk(b"zTXt", b"Comment\0\0" + zlib.compress(b"a" * 1000)) + chunk(b"gAMA", struct.pack(">I", 100000))
    yield "chunks", png((8, 2, 0, 0, 0), text, rows(lambda x, y: bytes(color(x, y)[:3])), chunk(b"tEXt", b"a\0b"))
    yield "large", png((8, 6, 0, 0, 0), rows(lambda x, y: bytes(color(x, y))), size=(32767, 32767))


def main():
    for name, data in files():
        with open(os.path.join(sys.argv[1], name + ".png"), "wb") as file:
            file.write(data)


main()
