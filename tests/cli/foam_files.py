"""Meshes of OpenFOAM in every encoding, written and read by other code than the program's."""

import re
import struct

from volume_files import OUTER, POINTS, flat

# The hexahedron and the pyramid of volume_files: the face between them, then the outer ones.
FACES = [[4, 5, 6, 7], *OUTER]
OWNER, NEIGHBOUR = [0] * 6 + [1] * 4, [1]
PATCHES = (("floor", 1, 1), ("walls", 2, 4), ("roof", 6, 4))
MEMBERS = {"floor": {0, 1, 2, 3}, "walls": set(range(8)), "roof": {4, 5, 6, 7, 8},
           "loose": {9}, "layers": set(range(8)), "tip": {4, 5, 6, 7, 8}}
BANNER = ("/*--------------------------------*- C++ -*----------------------------------*\\\n"
          "  =========                 | by a test: FoamFile { format ascii; }\n"
          "\\*---------------------------------------------------------------------------*/\n")


class Foam:
    """How files are written: as text, or with numbers of these sizes. is_short: lists in one line."""

    def __init__(self, is_binary=False, label="i", scalar="d", is_short=False, has_arch=True):
        self.is_binary, self.label, self.scalar, self.is_short = is_binary, label, scalar, is_short
        self.has_arch = has_arch

    def header(self, kind, name, note=""):
        bits = {"i": 32, "q": 64, "f": 32, "d": 64}
        arch = f'    arch        "LSB;label={bits[self.label]};scalar={bits[self.scalar]}";\n' if self.has_arch else ""
        form = "binary" if self.is_binary else "ascii"
        return (BANNER + "FoamFile\n{\n    version     2.0;\n" + f"    format      {form}; // as it is\n"
                f"    class       {kind};\n{arch}{note}    location    \"constant/polyMesh\";\n    object      {name};\n"
                "}\n// * * * * * * * //\n\n\n").encode()

    def numbers(self, code, values, width=1):
        """A list of numbers, or of tuples of them."""
        count = len(values) // width
        if self.is_binary:
            return f"{count}\n(".encode() + struct.pack(f"<{len(values)}{code}", *values) + b")"
        texts = [repr(x) for x in values]
        if width > 1:
            texts = ["(" + " ".join(texts[i:i + width]) + ")" for i in range(0, len(texts), width)]
        if self.is_short:
            return (f"{count}(" + " ".join(texts) + ")").encode()
        return (f"{count}\n(\n" + "".join(t + (" /* here */\n" if i % 3 == 1 else "\n") for i, t in enumerate(texts)) + ")").encode()

    def points(self, points=None):
        points = POINTS if points is None else points
        return self.header("vectorField", "points") + self.numbers(self.scalar, flat(points), 3) + b"\n\n// ***** //\n"

    def faces(self, faces=None, is_compact=None):
        faces = FACES if faces is None else faces
        if self.is_binary if is_compact is None else is_compact:
            starts = [sum(map(len, faces[:i])) for i in range(len(faces) + 1)]
            return (self.header("faceCompactList", "faces") + self.numbers(self.label, starts) + b"\n"
                    + self.numbers(self.label, flat(faces)) + b"\n")
        rows = b"\n".join(self.numbers(self.label, face) for face in faces)
        return self.header("faceList", "faces") + f"{len(faces)}\n(\n".encode() + rows + b"\n)\n"

    def labels(self, name, values, note=""):
        return self.header("labelList", name, note) + self.numbers(self.label, values) + b"\n"

    def boundary(self):
        entries = "".join(f"    {name}\n    {{\n        type            wall;\n        inGroups        1(wall);\n"
                          f"        nFaces          {count};\n        startFace       {first};\n    }}\n" for name, first, count in PATCHES)
        return self.header("polyBoundaryMesh", "boundary") + f"{len(PATCHES)}\n(\n{entries})\n".encode()

    def zones(self, what, name, values):
        """One zone of "point", "face" or "cell"."""
        flips = b"    flipMap         List<bool>\n" + self.flips(len(values)) + b";\n" if what == "face" else b""
        zone = f"1\n(\n{name}\n{{\n    type {what}Zone;\n{what}Labels List<label> "
        return self.header("regIOobject", what + "Zones") + zone.encode() + self.numbers(self.label, values) + b";\n" + flips + b"}\n)\n"

    def flips(self, count):
        """Bytes that look like brackets and quotes."""
        return f"{count}\n(".encode() + (b')";(' * count)[:count] + b")" if self.is_binary else f"{count}{{0}}".encode()

    def files(self, points=None):
        """All files of the mesh."""
        return {"points": self.points(points), "faces": self.faces(), "owner": self.labels("owner", OWNER),
                "neighbour": self.labels("neighbour", NEIGHBOUR), "boundary": self.boundary(),
                "pointZones": self.zones("point", "loose", [9]), "faceZones": self.zones("face", "layers", [0, 1]),
                "cellZones": self.zones("cell", "tip", [1])}


ENCODINGS = {
    "ascii": Foam(), "ascii in lines": Foam(is_short=True), "ascii without arch": Foam(has_arch=False),
    "binary": Foam(True), "binary of 64 and 32 bits": Foam(True, "q", "f"), "binary without arch": Foam(True, has_arch=False),
}


def read_points(data):
    """The points of a file, and the bytes before and behind them."""
    head = re.search(rb"\nFoamFile\n\{(.*?)\n\}", data, re.S)
    entries = dict(re.findall(rb"\n\s*(\w+)\s+(\"[^\"]*\"|[^;]*?);", head.group(1)))
    count = re.compile(rb"(\d+)\s*\(").search(data, head.end())
    number, at = int(count.group(1)), count.end()
    if entries[b"format"] == b"binary":
        code = "f" if b"scalar=32" in entries.get(b"arch", b"") else "d"
        end = at + struct.calcsize(f"<{3 * number}{code}")
        values = list(struct.unpack(f"<{3 * number}{code}", data[at:end]))
    else:
        end = data.index(b")\n\n// *", at) if b")\n\n// *" in data[at:] else data.rindex(b")")
        values = [float(x) for x in re.sub(rb"/\*.*?\*/|[()]", b" ", data[at:end]).split()]
    return [values[i:i + 3] for i in range(0, len(values), 3)], data[:at], data[end:]


def joined(files):
    """One file for the fuzzer: the points, and then each of the others behind its name."""
    return files["points"] + b"".join(b"\n@" + name.encode() + b"\n" + data for name, data in files.items() if name != "points")


def parted(data):
    """The files that joined() has made one of."""
    parts = re.split(rb"\n@(\w+)\n", data)
    return {"points": parts[0], **{name.decode(): text for name, text in zip(parts[1::2], parts[2::2], strict=True)}}
