"""PNG files of 8 bits, red, green, blue: reading those of ffd view, and making textures."""

import struct
import zlib

from harness import check, equal

SIGNATURE = b"\x89PNG\r\n\x1a\n"


def chunks(content):
    equal(content[:8], SIGNATURE, "the signature of a PNG")
    at = 8
    while at < len(content):
        size, kind = struct.unpack_from(">I4s", content, at)
        data = content[at + 8:at + 8 + size]
        equal(struct.unpack_from(">I", content, at + 8 + size)[0], zlib.crc32(kind + data), "the checksum of a chunk")
        yield kind, data
        at += 12 + size


def predict(kind, left, above, corner):
    if kind == 4:  # Paeth
        guess = left + above - corner
        return min((abs(guess - x), order, x) for order, x in enumerate((left, above, corner)))[2]
    return (0, left, above, (left + above) // 2)[kind]


def read_png(content):
    """Rows of (red, green, blue)."""
    found = list(chunks(content))
    equal([found[0][0], found[-1][0]], [b"IHDR", b"IEND"], "the ends of a PNG")
    width, height, depth, color, *rest = struct.unpack(">IIBBBBB", found[0][1])
    equal([depth, color, rest], [8, 2, [0, 0, 0]], "kind of PNG")
    data = zlib.decompress(b"".join(data for kind, data in found if kind == b"IDAT"))
    check(len(data) == height * (1 + 3 * width), "the size of the pixels")
    rows, above = [], bytes(3 * width)
    for y in range(height):
        line = bytearray(data[y * (1 + 3 * width):(y + 1) * (1 + 3 * width)])
        kind = line.pop(0)
        if kind:
            for i in range(3 * width):
                left, corner = (line[i - 3], above[i - 3]) if i > 2 else (0, 0)
                line[i] = (line[i] + predict(kind, left, above[i], corner)) & 255
        above = line
        rows.append([tuple(line[i:i + 3]) for i in range(0, 3 * width, 3)])
    return rows


def make_png(rows):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    lines = b"".join(b"\0" + bytes(x for pixel in row for x in pixel) for row in rows)
    return (SIGNATURE + chunk(b"IHDR", struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 2, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(lines)) + chunk(b"IEND", b""))
