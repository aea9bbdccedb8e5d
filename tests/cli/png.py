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


def unfilter(kind, line, above):
    """The bytes of a row of filtered ones; before both rows are three zeros. Pictures have a million bytes: a loop a kind."""
    check(kind < 5, "a filter of PNG")
    n = len(line)
    if kind == 1:
        for i in range(3, n):
            line[i] = (line[i] + line[i - 3]) & 255
    elif kind == 2:
        line[:] = bytes((x + up) & 255 for x, up in zip(line, above))
    elif kind == 3:
        for i in range(3, n):
            line[i] = (line[i] + (line[i - 3] + above[i]) // 2) & 255
    elif kind == 4:  # Paeth: what is nearest to left + up - corner
        for i in range(3, n):
            left, up, corner = line[i - 3], above[i], above[i - 3]
            by_left, by_up, by_corner = abs(up - corner), abs(left - corner), abs(left + up - 2 * corner)
            if by_left <= by_up and by_left <= by_corner:
                line[i] = (line[i] + left) & 255
            else:
                line[i] = (line[i] + (up if by_up <= by_corner else corner)) & 255
    return line


def read_png(content):
    """Rows of (red, green, blue)."""
    found = list(chunks(content))
    equal([found[0][0], found[-1][0]], [b"IHDR", b"IEND"], "the ends of a PNG")
    width, height, depth, color, *rest = struct.unpack(">IIBBBBB", found[0][1])
    equal([depth, color, rest], [8, 2, [0, 0, 0]], "kind of PNG")
    data = zlib.decompress(b"".join(data for kind, data in found if kind == b"IDAT"))
    check(len(data) == height * (1 + 3 * width), "the size of the pixels")
    rows, above, size = [], bytes(3 + 3 * width), 1 + 3 * width
    for y in range(height):
        above = unfilter(data[y * size], bytearray(3) + data[y * size + 1:(y + 1) * size], above)
        rows.append(list(zip(above[3::3], above[4::3], above[5::3])))
    return rows


def make_png(rows):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    lines = b"".join(b"\0" + bytes(x for pixel in row for x in pixel) for row in rows)
    return (SIGNATURE + chunk(b"IHDR", struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 2, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(lines)) + chunk(b"IEND", b""))
