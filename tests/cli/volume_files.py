"""Files of volume meshes in every encoding, written and read by other code than the program's."""

import base64
import math
import re
import struct
import zlib

# The corners of a hexahedron, one point above it, and one that no cell has.
POINTS = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 1.0],
          [1.0, 1.0, 1.0], [0.0, 1.0, 1.0], [0.5, 0.25, 1.75], [-1.5, 0.5, 0.1]]
HEXAHEDRON, PYRAMID, QUAD = 12, 14, 9
# The quad is a side of the hexahedron.
CELLS = [(HEXAHEDRON, [0, 1, 2, 3, 4, 5, 6, 7]), (PYRAMID, [4, 5, 6, 7, 8]), (QUAD, [0, 1, 2, 3])]
OUTER = [[0, 3, 2, 1], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7], [4, 5, 8], [5, 6, 8], [6, 7, 8], [7, 4, 8]]
NORMALS = [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.6, 0.8], [0.0, -1.0, 0.0]] * 2
WEIGHTS = [1.0, 0.0, 0.5, 1.0, 0.25, 0.0, 1.0, 1.0, 0.0, 1.0]
CODES = {"float": "f", "double": "d"}


def rows(values):
    return "".join(" ".join(repr(x) for x in row) + "\n" for row in values)


def flat(values):
    return [x for row in values for x in row]


# VTK, legacy

class Vtk:
    """Builds a file of the legacy format, in text or in binary."""

    def __init__(self, is_binary, dataset, version="3.0", title="made by a test"):
        self.is_binary = is_binary
        self.data = (f"# vtk DataFile Version {version}\n{title}\n{'BINARY' if is_binary else 'ASCII'}\n"
                     f"DATASET {dataset}\n").encode()

    def line(self, text):
        self.data += text.encode() + b"\n"
        return self

    def numbers(self, code, values):
        if self.is_binary:
            self.data += struct.pack(f">{len(values)}{code}", *values) + b"\n"
        else:
            texts = [repr(x) for x in values]
            self.data += "".join(" ".join(texts[i:i + 6]) + " \n" for i in range(0, len(texts), 6)).encode()
        return self


def vtk(points=None, is_binary=False, kind="float", normals=None, offsets=False):
    """A grid with normals, a vector that stays, and weights."""
    points = POINTS if points is None else points
    count = len(points)
    made = Vtk(is_binary, "UNSTRUCTURED_GRID", "5.1" if offsets else "3.0")
    made.line("FIELD FieldData 1").line("TIME 1 1 double").numbers("d", [0.5])
    made.line(f"POINTS {count} {kind}").numbers(CODES[kind], flat(points))
    words = [len(c) for _, c in CELLS]
    if offsets:
        made.line(f"CELLS {len(CELLS) + 1} {sum(words)}")
        made.line("OFFSETS vtktypeint64").numbers("q", [sum(words[:i]) for i in range(len(words) + 1)])
        made.line("CONNECTIVITY vtktypeint64").numbers("q", flat(c for _, c in CELLS))
    else:
        made.line(f"CELLS {len(CELLS)} {sum(words) + len(words)}").numbers("i", flat([len(c), *c] for _, c in CELLS))
    made.line(f"CELL_TYPES {len(CELLS)}").numbers("i", [k for k, _ in CELLS])
    made.line(f"CELL_DATA {len(CELLS)}").line("SCALARS region int 1").line("LOOKUP_TABLE default").numbers("i", [1, 2, 3])
    made.line(f"POINT_DATA {count}").line(f"NORMALS n {kind}").numbers(CODES[kind], flat(normals or NORMALS))
    made.line("METADATA").line("INFORMATION 0").line("")
    made.line("VECTORS velocity double").numbers("d", flat(NORMALS))
    made.line("FIELD FieldData 2").line(f"w 1 {count} double").numbers("d", WEIGHTS)
    made.line(f"tags 1 {count} unsigned_char").numbers("B", [255, 0] * (count // 2))
    return made.data


def vtk_polygons(points=None, is_binary=False, kind="float", offsets=False):
    points = POINTS if points is None else points
    made = Vtk(is_binary, "POLYDATA", "5.1" if offsets else "4.2")
    made.line(f"POINTS {len(points)} {kind}").numbers(CODES[kind], flat(points))
    for keyword, cells in (("VERTICES", [[0], [1, 2]]), ("LINES", [[0, 1], [1, 2, 3]]), ("POLYGONS", OUTER),
                           ("TRIANGLE_STRIPS", [[0, 1, 9, 2]])):
        words = [len(c) for c in cells]
        if offsets:
            made.line(f"{keyword} {len(cells) + 1} {sum(words)}")
            made.line("OFFSETS vtktypeint64").numbers("q", [sum(words[:i]) for i in range(len(words) + 1)])
            made.line("CONNECTIVITY vtktypeint64").numbers("q", flat(cells))
        else:
            made.line(f"{keyword} {len(cells)} {sum(words) + len(words)}").numbers("i", flat([len(c), *c] for c in cells))
    return made.data


def grid_points(size):
    return [[0.25 * x, 0.3 * y, 0.2 * z] for z in range(size[2]) for y in range(size[1]) for x in range(size[0])]


def vtk_grid(points=None, is_binary=False, kind="float", size=(4, 3, 3)):
    points = grid_points(size) if points is None else points
    made = Vtk(is_binary, "STRUCTURED_GRID")
    made.line("DIMENSIONS %d %d %d" % size).line(f"POINTS {len(points)} {kind}").numbers(CODES[kind], flat(points))
    return made.data


# Two polyhedra, with one side in common.
POLYHEDRA = [[[0, 2, 1], [0, 1, 4], [1, 2, 4], [2, 0, 4]], [[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]]]
CORNERS_OF_POLYHEDRA = [0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, -1, 0, 0, 1]


def stream_of(faces):
    """How many faces; of each how many points, and these."""
    return [len(faces), *flat([len(face), *face] for face in faces)]


def vtk_polyhedra():
    made = Vtk(False, "UNSTRUCTURED_GRID").line("POINTS 5 double")
    made.numbers("d", CORNERS_OF_POLYHEDRA).line("CELLS 2 36")
    return made.numbers("i", flat([17, *stream_of(faces)] for faces in POLYHEDRA)).line("CELL_TYPES 2").numbers("i", [42, 42]).data


def vtu_polyhedra(is_listed):
    """is_listed: the faces are in a list, in which the common side stands once, as VTK writes them since 9.4."""
    listed = POLYHEDRA[0] + POLYHEDRA[1][1:]
    faces = ([("face_connectivity", flat(listed)), ("face_offsets", range(3, 3 * len(listed) + 1, 3)),
              ("polyhedron_to_faces", [0, 1, 2, 3, 0, 4, 5, 6]), ("polyhedron_offsets", [4, 8])]
             if is_listed else [("faces", flat(map(stream_of, POLYHEDRA))), ("faceoffsets", [17, 34])])
    arrays = "".join(f'<DataArray type="Int64" Name="{name}" format="ascii">{" ".join(map(str, values))}</DataArray>\n'
                     for name, values in [("connectivity", [0, 1, 2, 4, 0, 1, 2, 3]), ("offsets", [4, 8]), ("types", [42, 42]), *faces])
    points = " ".join(map(str, CORNERS_OF_POLYHEDRA))
    return ('<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian">\n<UnstructuredGrid><Piece NumberOfPoints="5" NumberOfCells="2">'
            f'<Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">{points}</DataArray></Points>\n<Cells>\n{arrays}</Cells>'
            "</Piece></UnstructuredGrid></VTKFile>\n").encode()


def middles(corners, *groups):
    """Corners, and the means of groups of them."""
    return corners + [[sum(corners[i][a] for i in group) / len(group) for a in range(3)] for group in groups]


def vtk_kinds():
    """A cell of each kind, with its points where VTK has them; a prism of five and one of six sides."""
    cube = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [1.0, 1.0, 1.0], [0.0, 1.0, 1.0]]
    tetra, wedge, pyramid = ([cube[i] for i in (0, 1, 3, 4)], [cube[i] for i in (0, 1, 3, 4, 5, 7)], cube[:4] + [[0.5, 0.5, 1.0]])
    around, up = [(0, 1), (1, 2), (2, 3), (3, 0)], [(0, 4), (1, 5), (2, 6), (3, 7)]
    edges = around + [(4, 5), (5, 6), (6, 7), (7, 4)] + up
    sides = [(0, 4, 7, 3), (1, 2, 6, 5), (0, 1, 5, 4), (3, 7, 6, 2)]
    triangles = [(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3)]
    quads = [(0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)]
    towers = [[math.cos(2 * math.pi * i / n), math.sin(2 * math.pi * i / n), z] for n in (5, 6) for z in (0.0, 1.0) for i in range(n)]
    kinds = [(10, tetra), (11, [cube[i] for i in (0, 1, 3, 2, 4, 5, 7, 6)]), (12, cube), (13, wedge), (14, pyramid), (15, towers[:10]), (16, towers[10:]),
             (24, middles(tetra, (0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))), (25, middles(cube, *edges)),
             (26, middles(wedge, *triangles, (0, 3), (1, 4), (2, 5))), (27, middles(pyramid, *around, (0, 4), (1, 4), (2, 4), (3, 4))),
             (29, middles(cube, *edges, *sides, (0, 1, 2, 3), (4, 5, 6, 7), range(8))), (31, middles(wedge, *triangles)),
             (32, middles(wedge, *triangles, (0, 3), (1, 4), (2, 5), *quads)), (33, middles(cube, *edges, *sides))]
    points, cells = [], []
    for number, (kind, own) in enumerate(kinds):
        cells.append([len(own), *range(len(points), len(points) + len(own))])
        points += [[x + 3.0 * number, y, z] for x, y, z in own]
    made = Vtk(False, "UNSTRUCTURED_GRID").line(f"POINTS {len(points)} double").numbers("d", flat(points))
    made.line(f"CELLS {len(cells)} {sum(map(len, cells))}").numbers("i", flat(cells))
    return made.line(f"CELL_TYPES {len(cells)}").numbers("i", [kind for kind, _ in kinds]).data


def vtk_vectors(data, keyword, code, count):
    """The numbers behind a line that begins with a keyword."""
    at = data.index(keyword)
    at = data.index(b"\n", at) + 1
    if b"\nBINARY\n" in data[:200]:
        size = struct.calcsize(code)
        values = list(struct.unpack_from(f">{3 * count}{code}", data, at))
        return [values[i:i + 3] for i in range(0, 3 * count, 3)], at, at + 3 * count * size
    words = data[at:].split()[:3 * count]
    values = [float(x) for x in words]
    return [values[i:i + 3] for i in range(0, 3 * count, 3)], at, None


# SU2

SU2_FLAT = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.5, 1.5]]


def su2(points=None, end="\n", boxes=0):
    """In three dimensions, with a comment here and there."""
    points = POINTS if points is None else points
    lines = ["% a mesh", "NDIME= 3", f"NELEM= {len(CELLS) - 1}% cells"]
    lines += [" ".join(map(str, [kind, *cell, i])) for i, (kind, cell) in enumerate(CELLS[:2])]
    lines += [f"NPOIN = {len(points)} {len(points)}", "% the points"]
    lines += ["\t" + " ".join(repr(x) for x in p) + (f"  {i}" if i % 2 == 0 else "% here") for i, p in enumerate(points)]
    lines += ["NMARK= 2", "MARKER_TAG= wall", "MARKER_ELEMS= 1", "9 0 1 2 3", "MARKER_TAG= far", "MARKER_ELEMS= 2", "5 4 5 8",
              "5 5 6 8"]
    lines += [f"FFD_NBOX= {boxes}", "FFD_TAG= box", "FFD_CORNER_POINTS= 8", *["0 0 0"] * 8] if boxes else []
    return end.join(lines + [""]).encode()


def su2_flat(points=None):
    points = SU2_FLAT if points is None else points
    return ("NDIME= 2\nNELEM= 2\n9 0 1 2 3\n5 3 2 4\n" + f"NPOIN= {len(points)}\n"
            + "".join("%r %r %d\n" % (x, y, i) for i, (x, y) in enumerate(points))
            + "NMARK= 1\nMARKER_TAG= low\nMARKER_ELEMS= 1\n3 0 1\n").encode()


def su2_zones():
    zone = su2_flat().decode()
    return ("NZONE= 2\nIZONE= 1\n" + zone + "IZONE= 2\n" + zone).encode()


def su2_points(data, dimensions):
    lines = [line.split("%")[0].split() for line in data.decode().replace("\r\n", "\n").split("\n")]
    lines = [words for words in lines if words]
    first = next(i for i, words in enumerate(lines) if words[0].startswith("NPOIN"))
    count = int(" ".join(lines[first]).split("=")[1].split()[0])
    return [[float(x) for x in words[:dimensions]] for words in lines[first + 1:first + 1 + count]]


# VTK in XML

XML_TYPES = {"f": "Float32", "d": "Float64", "i": "Int32", "q": "Int64", "B": "UInt8"}
ENCODINGS = ("ascii", "base64", "raw", "appended base64", "base64 zlib", "raw zlib", "appended base64 zlib")


class Xml:
    """Builds a file in one of the encodings."""

    def __init__(self, grid, encoding="ascii", order="<", word="I", block=64):
        self.encoding, self.order, self.word, self.block = encoding, order, word, block
        self.is_packed = encoding.endswith("zlib")
        self.is_appended = encoding.startswith(("raw", "appended"))
        self.grid, self.body, self.appended = grid, [], b""

    def encoded(self, data):
        """Data with their header."""
        text = (lambda b: b) if self.encoding.startswith("raw") else base64.b64encode
        word = self.order + "%d" + self.word
        if not self.is_packed:
            return text(struct.pack(word % 1, len(data)) + data)
        blocks = [data[i:i + self.block] for i in range(0, len(data), self.block)]
        packed = [zlib.compress(b, 1) for b in blocks]
        rest = len(blocks[-1]) if blocks and len(blocks[-1]) < self.block else 0
        head = [len(blocks), self.block, rest, *map(len, packed)]
        return text(struct.pack(word % len(head), *head)) + text(b"".join(packed))

    def array(self, name, code, values, width=1, extra=""):
        tag = f'<DataArray type="{XML_TYPES[code]}" Name="{name}" NumberOfComponents="{width}"{extra}'
        if self.encoding == "ascii":
            self.body.append(tag + ' format="ascii">\n' + " ".join(repr(x) for x in values) + "\n</DataArray>\n")
            return self
        data = self.encoded(struct.pack(f"{self.order}{len(values)}{code}", *values))
        if self.is_appended:
            self.body.append(tag + f' format="appended" offset="{len(self.appended)}"/>\n')
            self.appended += data
        else:
            self.body.append(tag + ' format="binary">\n  ' + data.decode() + "\n</DataArray>\n")
        return self

    def text(self, text):
        self.body.append(text + "\n")
        return self

    def finished(self):
        packed = ' compressor="vtkZLibDataCompressor"' if self.is_packed else ""
        head = (f'<?xml version="1.0"?>\n<VTKFile type="{self.grid}" version="1.0" byte_order='
                f'"{"LittleEndian" if self.order == "<" else "BigEndian"}" header_type='
                f'"{"UInt32" if self.word == "I" else "UInt64"}"{packed}>\n<{self.grid}>\n')
        data = head.encode() + "".join(self.body).encode() + f"</{self.grid}>\n".encode()
        if self.is_appended:
            kind = "raw" if self.encoding.startswith("raw") else "base64"
            data += f'<AppendedData encoding="{kind}">\n _'.encode() + self.appended + b"\n</AppendedData>\n"
        return data + b"</VTKFile>\n"


def ranges(points):
    lengths = [math.sqrt(sum(x * x for x in p)) for p in points]
    return f' RangeMin="{min(lengths)!r}" RangeMax="{max(lengths)!r}"'


def data_of_points(made, code, normals):
    made.text('<PointData Scalars="w" Normals="n &amp; n">').array("w", "d", WEIGHTS)
    made.array("n &amp; n", code, flat(normals or NORMALS), 3).array("velocity", "d", flat(NORMALS), 3)
    return made.array("tags", "B", [255, 0] * (len(WEIGHTS) // 2)).text("</PointData>")


def vtu(points=None, encoding="ascii", code="f", normals=None, pieces=1, **options):
    """The mesh of vtk(), once for each piece; its range and a comment too."""
    points = POINTS if points is None else points
    made = Xml("UnstructuredGrid", encoding, **options).text("<!-- by a test > -->")
    for piece in range(pieces):
        part = points[piece * len(points) // pieces:(piece + 1) * len(points) // pieces]
        made.text(f'<Piece NumberOfPoints="{len(part)}" NumberOfCells="{len(CELLS)}">')
        data_of_points(made, code, normals)
        made.text("<CellData>").array("region", "i", [1, 2, 3]).text("</CellData>")
        made.text("<Points>").array("Points", code, flat(part), 3, ranges(part)).text("</Points><Cells>")
        made.array("connectivity", "q", flat(c for _, c in CELLS))
        made.array("offsets", "i", [sum(len(c) for _, c in CELLS[:i + 1]) for i in range(len(CELLS))])
        made.array("types", "B", [k for k, _ in CELLS]).text("</Cells></Piece>")
    return made.finished()


def vtp(points=None, encoding="ascii", code="f", normals=None, **options):
    points = POINTS if points is None else points
    lists = (("Verts", [[0], [1, 2]]), ("Lines", [[0, 1], [1, 2, 3]]), ("Strips", [[0, 1, 9, 2]]), ("Polys", OUTER))
    made = Xml("PolyData", encoding, **options)
    made.text(f'<Piece NumberOfPoints="{len(points)}" '
              + " ".join(f'NumberOf{name}="{len(cells)}"' for name, cells in lists) + ">")
    data_of_points(made, code, normals).text("<Points>").array("Points", code, flat(points), 3, ranges(points)).text("</Points>")
    for name, cells in lists:
        made.text(f"<{name}>").array("connectivity", "i", flat(cells))
        made.array("offsets", "i", [sum(map(len, cells[:i + 1])) for i in range(len(cells))]).text(f"</{name}>")
    return made.text("</Piece>").finished()


def vts(points=None, encoding="ascii", code="f", size=(4, 3, 3), **options):
    points = grid_points(size) if points is None else points
    extent = " ".join(f"0 {n - 1}" for n in size)
    made = Xml("StructuredGrid", encoding, **options).text(f'<Piece Extent="{extent}"><Points>')
    return made.array("Points", code, flat(points), 3, ranges(points)).text("</Points></Piece>").finished()


def unpacked(data, at, order, word, is_raw, is_packed):
    """The bytes of an array at a place of the file, and where what stands for them ends."""
    size = struct.calcsize(word)

    def take(at, count):
        if is_raw:
            return data[at:at + count], at + count
        length = (count + 2) // 3 * 4
        return base64.b64decode(data[at:at + length])[:count], at + length

    if not is_packed:
        head, _ = take(at, size)
        count = struct.unpack(order + word, head)[0]
        both, end = take(at, size + count)
        return both[size:], end
    head, _ = take(at, 3 * size)
    blocks = struct.unpack(order + "3" + word, head)[0]
    head, at = take(at, (3 + blocks) * size)
    sizes = struct.unpack(f"{order}{blocks}{word}", head[3 * size:])
    packed, end = take(at, sum(sizes))
    return b"".join(zlib.decompress(packed[sum(sizes[:i]):sum(sizes[:i + 1])]) for i in range(blocks)), end


def xml_arrays(data):
    """All arrays by their names, of each piece: lists of numbers; and the attributes of their tags."""
    head = data.split(b">", 2)[1].decode() if data.startswith(b"<?xml") else ""
    order = "<" if "LittleEndian" in head else ">"
    word = "Q" if "UInt64" in head else "I"
    is_packed = "vtkZLib" in head
    mark = re.search(rb'<AppendedData encoding="(\w+)">\s*_', data)
    found = {}
    for tag in re.finditer(rb"<DataArray ([^>]*?)/?>", data[:mark.start() if mark else len(data)]):
        attributes = dict(re.findall(r'(\w+)="([^"]*)"', tag.group(1).decode()))
        code = next(c for c, name in XML_TYPES.items() if name == attributes["type"])
        if attributes["format"] == "ascii":
            values = [float(x) for x in data[tag.end():data.index(b"<", tag.end())].split()]
        else:
            at = mark.end() + int(attributes["offset"]) if attributes["format"] == "appended" else tag.end() + 3
            is_raw = attributes["format"] == "appended" and mark.group(1) == b"raw"
            packed, _ = unpacked(data, at, order, word, is_raw, is_packed)
            values = list(struct.unpack(f"{order}{len(packed) // struct.calcsize(code)}{code}", packed))
        found.setdefault(attributes["Name"], []).append((values, attributes))
    return found


def xml_points(data, name="Points"):
    values = [x for part, _ in xml_arrays(data)[name] for x in part]
    return [values[i:i + 3] for i in range(0, len(values), 3)]


# Gmsh

GMSH = {HEXAHEDRON: 5, PYRAMID: 7, QUAD: 3}
NAMES = '$PhysicalNames\n2\n2 7 "the wall"\n3 1 "inside"\n$EndPhysicalNames\n'
# The physical groups of CELLS.
PHYSICAL = [1, 0, 7]


class Msh:
    """Builds a file of one of the versions, in text or in binary."""

    def __init__(self, version, is_binary, order="<", word="Q"):
        self.is_binary, self.order, self.word = is_binary, order, word
        size = struct.calcsize(word)
        self.data = f"$MeshFormat\n{version} {int(is_binary)} {size}\n".encode()
        if is_binary:
            self.data += struct.pack(order + "i", 1) + b"\n"
        self.data += b"$EndMeshFormat\n"

    def text(self, text):
        self.data += text.encode()
        return self

    def put(self, codes, *values):
        """i: int, n: number of things or tag, d: coordinate."""
        if self.is_binary:
            self.data += struct.pack(self.order + codes.replace("n", self.word), *values)
        else:
            self.data += (" ".join(repr(x) for x in values) + "\n").encode()
        return self


DIMENSIONS = [0, 1, 1, 2, 2, 2, 3, 3, 1, 0]  # of the entities that parametric nodes are on


def msh2(points=None, is_binary=False, order="<", tags=None, parameters=False):
    points = POINTS if points is None else points
    tags = tags or [3 * i + 2 for i in range(len(points))]
    section = "ParametricNodes" if parameters else "Nodes"
    made = Msh("2.2", is_binary, order).text(NAMES + f"${section}\n{len(points)}\n")
    for tag, point, dimension in zip(tags, points, DIMENSIONS):
        extra = [0.25] * (dimension % 3)
        made.put(*(("i3d2i" + "d" * len(extra), tag, *point, dimension, 7, *extra) if parameters else ("i3d", tag, *point)))
    made.text(("\n" if is_binary else "") + f"$End{section}\n$Elements\n{len(CELLS)}\n")
    for i, (kind, cell) in enumerate(CELLS):
        nodes = [tags[p] for p in cell]
        if is_binary:
            made.put(f"3i{3 + len(nodes)}i", GMSH[kind], 1, 2, i + 1, PHYSICAL[i], 1, *nodes)
        else:
            made.put("", i + 1, GMSH[kind], 2, PHYSICAL[i], 1, *nodes)
    return made.text(("\n" if is_binary else "") + "$EndElements\n$NodeData\n1\n\"t\"\n0\n0\n$EndNodeData\n").data


def msh4(points=None, is_binary=False, order="<", word="Q", parameters=False):
    """The first four nodes are on a surface, the others in a volume."""
    points = POINTS if points is None else points
    count = len(points)
    made = Msh("4.1", is_binary, order, word).text(NAMES + "$Entities\n")
    made.put("4n", 1, 0, 1, 2).put("i3dn", 5, 0.0, 0.0, 0.0, 0)
    made.put("i6dnini", 2, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 1, 7, 1, -5)
    made.put("i6dnini", 1, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1, 1, 1, 2).put("i6dnn", 2, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 0, 0)
    made.text(("\n" if is_binary else "") + "$EndEntities\n$Nodes\n").put("4n", 2, count, 1, count)
    for dimension, first, last in ((2, 0, 4), (3, 4, count)):
        made.put("3in", dimension, dimension - 1, int(parameters and dimension == 2), last - first)
        for i in range(first, last):
            made.put("n", i + 1)
        for i in range(first, last):
            extra = [0.25, 0.75] if parameters and dimension == 2 else []
            made.put(f"{3 + len(extra)}d", *points[i], *extra)
    made.text(("\n" if is_binary else "") + "$EndNodes\n$Elements\n").put("4n", 3, 3, 1, 3)
    for i, (kind, cell) in enumerate(CELLS):
        made.put("3in", 2 if kind == QUAD else 3, {QUAD: 2, HEXAHEDRON: 1, PYRAMID: 2}[kind], GMSH[kind], 1)
        made.put(f"{1 + len(cell)}n", i + 1, *[p + 1 for p in cell])
    return made.text(("\n" if is_binary else "") + "$EndElements\n").data


def msh_points(data, order="<", word="Q"):
    """Coordinates, and the bytes of the file without them."""
    version, is_binary = data.split(b"\n")[1].split()[:2]
    at = data.index(b"$Nodes\n") + 7
    points, rest = [], []
    if is_binary == b"0":
        lines = data[at:data.index(b"$EndNodes")].decode().split("\n")
        if version == b"2.2":
            return [[float(x) for x in line.split()[1:4]] for line in lines[1:-1]], None
        lines = lines[1:]
        while len(lines) > 1:
            count = int(lines[0].split()[3])
            points += [[float(x) for x in line.split()[:3]] for line in lines[1 + count:1 + 2 * count]]
            lines = lines[1 + 2 * count:]
        return points, None
    start = 0

    def take(count):
        nonlocal at, start
        rest.append(data[start:at])
        points.append(list(struct.unpack_from(order + "3d", data, at)))
        at = start = at + 24
        at += 8 * (count - 3)

    if version == b"2.2":
        end = data.index(b"\n", at)
        count, at = int(data[at:end]), end + 1
        for _ in range(count):
            at += 4
            take(3)
    else:
        size = struct.calcsize(order + word)
        blocks, at = struct.unpack_from(order + word, data, at)[0], at + 4 * size
        for _ in range(blocks):
            dimension, _, has_parameters = struct.unpack_from(order + "3i", data, at)
            count = struct.unpack_from(order + word, data, at + 12)[0]
            at += 12 + size + count * size
            for _ in range(count):
                take(3 + has_parameters * dimension)
    return points, b"".join(rest) + data[start:]
