"""Makes PNG files of 8 bits, red, green, blue, and alpha where pixels have four numbers: textures."""

import struct
import zlib

SIGNATURE = b"\x89PNG\r\n\x1a\n"


def make_png(rows, level=-1):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    lines = b"".join(b"\0" + bytes(x for pixel in row for x in pixel) for row in rows)
    return (SIGNATURE + chunk(b"IHDR", struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 6 if len(rows[0][0]) == 4 else 2, 0, 0, 0))
            + chunk(b"IDAT", zlib.compress(lines, level)) + chunk(b"IEND", b""))
