"""OBJ, PLY, OFF and STL as pieces of the file: which of them are coordinates and normals, and everything else.

read(path) gives a Shape: positions and corners for the judge, and pieces for the comparison."""

import array
import functools
import itertools
import math
import os
import re
import struct
import sys

TESTS = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.append(os.path.join(TESTS, "cli"))
from vectors import cross, dot, minus  # noqa: E402 (a neighbour of this folder)

DOUBLE, FLOAT = "double", "float"


class Shape:
    """positions: [x,y,z]; corners: [vertex, normal] for every place where a normal is used; facets: (normal,
    three positions) of an STL; rest: the file with every changeable piece taken out; numbers: the texts of the
    changeable numbers, in order, where the file is text."""

    def __init__(self, precision):
        self.precision = precision
        self.positions, self.corners, self.facets = [], [], []
        self.rest, self.numbers = [], []

    def points(self):
        """For the judge: the positions, then each corner as the vertex and the normal."""
        numbers = array.array("d", itertools.chain.from_iterable(self.positions))
        for vertex, normal in self.corners:
            numbers.append(vertex)
            numbers.extend(normal)
        return numbers


def shortest(text, number):
    """Whether a number's text has no digit more than reading it back needs."""
    if repr(number) == text:
        return True
    digits = lambda t: re.sub(r"[^0-9]", "", re.split("[eE]", t)[0]).strip("0")
    return len(digits(text)) <= len(digits(repr(number)))


# ---- OBJ --------------------------------------------------------------------------------------------------------

LINE_END = re.compile(r"\r\n|\n|\r")
NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?")
PIECE = re.compile(r"(?:\\(?:\r\n|\n|\r)|[ \t\f\v])+|(?:(?!\\(?:\r\n|\n|\r))[^\s])+")


def logical_lines(text):
    """Lines with their ends; one that is continued by a backslash goes on."""
    at = 0
    while at < len(text):
        search = at
        while True:
            end = LINE_END.search(text, search)
            stop = end.end() if end else len(text)
            if not end or text[end.start() - 1:end.start()] != "\\" or end.start() == at:
                break
            search = stop
        yield text[at:stop]
        at = stop


def number_of(text):
    """As C reads it: what follows the number, as in 3.1+e2, is left."""
    return float(NUMBER.match(text).group())


def is_blank(piece):
    return piece[0] in " \t\f\v" or piece[:2] in ("\\\r", "\\\n")


class ObjLine:
    """One logical line: pieces, and which of them are words (comments are none)."""

    def __init__(self, line):
        end = re.search(r"(\r\n|\n|\r)?\Z", line)
        self.end = end.group()
        self.pieces = PIECE.findall(line[:end.start()])
        self.words = []
        for i, piece in enumerate(self.pieces):
            if piece.startswith("#"):
                break
            if not is_blank(piece):
                self.words.append(i)
        self.kind = self.pieces[self.words[0]] if self.words else ""

    def word(self, n):
        return self.pieces[self.words[n]]

    def vector(self):
        return [number_of(self.word(n)) for n in (1, 2, 3)]

    def without(self, words):
        return "".join("<>" if i in words else piece for i, piece in enumerate(self.pieces)) + self.end


# Where a line v or vn is as plain as most are, its numbers, and what stands before each; what follows them is left.
PLAIN = re.compile(r"^(vn?)([ \t]+)(#)([ \t]+)(#)([ \t]+)(#)(?=[ \t\r\n]|\Z)".replace(
    "#", NUMBER.pattern.replace("(", "(?:")), re.M)
# Lines of normals and of faces; a word of a face that names a normal, as what stands before it and the normal.
NORMAL_LINE = re.compile(r"^vn[ \t].*(?:\n|\Z)", re.M)
FACE_LINE = re.compile(r"^f[ \t].*", re.M)
FACE_WORD = re.compile(r"(?<=[ \t])(\d+/\d*)/(\d+)(?=[ \t\r\n]|\Z)")


class Cut:
    """A text cut by PLAIN: the numbers, and all the rest."""

    def __init__(self, text):
        pieces = PLAIN.split(text)
        self.kinds = pieces[1::8]
        self.between, self.blanks = pieces[0::8], [pieces[at::8] for at in (2, 4, 6)]
        self.vectors = list(zip(*(pieces[at::8] for at in (3, 5, 7))))

    def same_but_numbers(self, other):
        return self.kinds == other.kinds and self.between == other.between and self.blanks == other.blanks

    def same_but_normals(self, other):
        """Whether all is the same but numbers and the normals that faces name."""
        if self.kinds != other.kinds or self.blanks != other.blanks:
            return False
        mine, others = (FACE_WORD.split("\0".join(cut.between)) for cut in (self, other))
        return mine[::3] == others[::3] and mine[1::3] == others[1::3]

    def words(self, kind):
        return [word for found, vector in zip(self.kinds, self.vectors) if found == kind for word in vector]


class ObjText:
    """An OBJ as text, to tell by few operations on all of it that another is the same but for numbers."""

    def __init__(self, text):
        self.text = text
        # One line after the other, each as it is: nothing that is continued, ends of one kind.
        self.simple = "\\" not in text and text.count("\r") == text.count("\r\n")

    @functools.cached_property
    def cut(self):
        return Cut(self.text)

    @functools.cached_property
    def without_normals(self):
        return Cut(NORMAL_LINE.sub("", self.text))

    @functools.cached_property
    def gaps(self):
        """How many lines vn there are between other lines."""
        return [len(run) for run in "".join(
            "n" if line.startswith(("vn ", "vn\t")) else "|" for line in self.text.split("\n")).split("|")]

    @functools.cached_property
    def face_words(self):
        return FACE_WORD.findall("\n".join(FACE_LINE.findall(self.text)))

    def same_but_numbers(self, other):
        return self.simple and other.simple and self.cut.same_but_numbers(other.cut)

    def has_more_normals(self, other):
        """Whether it is the other but for numbers, more lines vn, and the normals that faces name."""
        return self.simple and other.simple and self.without_normals.same_but_normals(other.without_normals) and \
            self.cut.kinds.count("vn") == sum(self.gaps) > sum(other.gaps) and \
            all(a >= b for a, b in zip(self.gaps, other.gaps)) and \
            len(self.face_words) == len(FACE_WORD.findall(self.text))


class Obj(Shape):
    """like: another, which is not read again line by line where all that this one has otherwise is numbers, or normals
    that were added; then as_before."""

    def __init__(self, data, like=None):
        super().__init__(DOUBLE)
        self.whole = ObjText(data.decode("latin-1"))
        # All coordinates must be in plain lines.
        plain = like is not None and self.whole.cut.kinds.count("v") == len(like.positions)
        numbers = plain and self.whole.same_but_numbers(like.whole) and \
            self.whole.cut.kinds.count("vn") == len(like.normals)
        self.as_before = numbers or (plain and self.whole.has_more_normals(like.whole) and
                                     len(self.whole.face_words) == len(like.named))
        if self.as_before:
            self.read_numbers()
            self.corners = self.same_corners(like) if numbers else self.named_corners(like)
        else:
            self.read_lines()

    def read_numbers(self):
        self.numbers, self.normal_numbers = (self.whole.cut.words(kind) for kind in ("v", "vn"))
        self.positions, self.normals = (vectors(words) for words in (self.numbers, self.normal_numbers))

    def same_corners(self, like):
        return [[v, self.normals[n]] for v, n in like.named if n < len(self.normals)]

    def named_corners(self, like):
        return [[v, self.normals[int(n) - 1]] for (v, _), (_, n) in zip(like.named, self.whole.face_words)
                if int(n) <= len(self.normals)]

    def read_lines(self):
        text = self.whole.text
        self.lines = [ObjLine(line) for line in logical_lines(text.removeprefix("\xef\xbb\xbf"))]
        self.bom = text.startswith("\xef\xbb\xbf")
        self.normals = []
        self.faces = []
        for line in self.lines:
            if line.kind == "v":
                self.positions.append(line.vector())
                self.numbers += [line.word(n) for n in (1, 2, 3)]
            elif line.kind == "vn":
                self.normals.append(line.vector())
            elif line.kind == "f":
                self.face(line)
        self.normal_numbers = [line.word(n) for line in self.lines if line.kind == "vn" for n in (1, 2, 3)]
        # What names a normal. Some files name normals that they have not.
        self.named = [(v, n) for face in self.faces for v, n in face if n is not None]
        self.corners = self.same_corners(self)

    def face(self, line):
        face = []
        for n in range(1, len(line.words)):
            parts = line.word(n).split("/")
            vertex = self.number(parts[0], self.positions)
            face.append((vertex, self.number(parts[2], self.normals) if len(parts) > 2 and parts[2] else None))
        self.faces.append(face)

    @staticmethod
    def number(text, counted):
        return int(text) - 1 if int(text) > 0 else len(counted) + int(text)


def vectors(words):
    numbers = iter(map(float, words))
    return [list(vector) for vector in zip(numbers, numbers, numbers)]


def obj_changes(before, after):
    """Lines other than v and vn are as they were, but for the normals of faces where normals were added."""
    if after.as_before:
        return []
    found = [] if before.bom == after.bom else ["the byte order mark changed"]
    more = len(after.normals) - len(before.normals)
    if more < 0:
        found.append(f"{-more} normals are gone")
    old = [line for line in before.lines if line.kind != "vn"]
    new = [line for line in after.lines if line.kind != "vn"]
    if len(old) != len(new):
        return found + [f"{len(old)} lines without normals became {len(new)}"]
    for a, b in zip(old, new):
        if a.pieces == b.pieces and a.end == b.end:
            continue
        if not (same_vertex_line(a, b) or (more and same_face_line(a, b))):
            found.append(f"line {''.join(a.pieces)[:60]!r} became {''.join(b.pieces)[:60]!r}")
    found += normal_lines(before, after)
    # A face names what it named.
    if [[v for v, _ in face] for face in before.faces] != [[v for v, _ in face] for face in after.faces]:
        found.append("faces have other vertices")
    return found


def same_vertex_line(a, b):
    return a.kind == b.kind == "v" and a.without(a.words[1:4]) == b.without(b.words[1:4])


def same_face_line(a, b):
    if a.kind != "f" or b.kind != "f" or len(a.pieces) != len(b.pieces):
        return False
    cut = lambda word: word.rsplit("/", 1)[0] if word.count("/") == 2 else word
    return all(x == y or (i in a.words and cut(x) == cut(y)) for i, (x, y) in enumerate(zip(a.pieces, b.pieces))) \
        and a.end == b.end


def normal_lines(before, after):
    """The vn lines that were there are still there, in their places, but for three numbers; and normals that no
    face uses, or whose value is the same, keep their text."""
    old = [line for line in before.lines if line.kind == "vn"]
    if len(after.normals) == len(before.normals):
        new = [line for line in after.lines if line.kind == "vn"]
        wrong = [i for i, (a, b) in enumerate(zip(old, new)) if a.without(a.words[1:4]) != b.without(b.words[1:4])]
        places = [i for i, line in enumerate(before.lines) if line.kind == "vn"]
        moved = places != [i for i, line in enumerate(after.lines) if line.kind == "vn"]
        return ([f"vn {wrong[0]} changed in more than its numbers"] if wrong else []) + \
            (["vn lines moved"] if moved else [])
    # Between the other lines there are no fewer than there were.
    gaps = lambda lines: [len(run) for run in "".join("n" if line.kind == "vn" else "|" for line in lines).split("|")]
    fewer = [i for i, (a, b) in enumerate(zip(gaps(before.lines), gaps(after.lines))) if b < a]
    return [f"a vn line before line {fewer[0]} is gone"] if fewer else []


# ---- PLY --------------------------------------------------------------------------------------------------------

PLY_TYPES = {"char": "b", "uchar": "B", "short": "h", "ushort": "H", "int": "i", "uint": "I", "float": "f",
             "double": "d", "int8": "b", "uint8": "B", "int16": "h", "uint16": "H", "int32": "i", "uint32": "I",
             "float32": "f", "float64": "d"}
MAY_CHANGE = ("x", "y", "z", "nx", "ny", "nz")


class Ply(Shape):
    def __init__(self, data):
        end = re.search(rb"end_header[ \t]*(\r\n|\n|\r)", data)
        self.rest = [data[:end.end()]]
        self.elements = []
        for words in (line.split() for line in re.split(r"\r\n|\n|\r", data[:end.start()].decode("latin-1"))):
            if words[:1] == ["format"]:
                self.format = words[1]
            elif words[:1] == ["element"]:
                self.elements.append((words[1], int(words[2]), []))
            elif words[:1] == ["property"]:
                self.elements[-1][2].append((words[-1], words[1:-1]))
        properties = {name: kind for element, _, fields in self.elements if element == "vertex"
                      for name, kind in fields}
        super().__init__(FLOAT if PLY_TYPES[properties["x"][0]] == "f" else DOUBLE)
        self.rest = [data[:end.end()]]
        (self.ascii if self.format == "ascii" else self.binary)(data[end.end():])

    def vertex(self, row):
        self.positions.append([row[name] for name in ("x", "y", "z")])
        if "nx" in row:
            self.corners.append([len(self.positions) - 1, [row[name] for name in ("nx", "ny", "nz")]])

    def ascii(self, body):
        pieces = re.findall(r"\s+|\S+", body.decode("latin-1"))
        words = iter([i for i, piece in enumerate(pieces) if not piece.isspace()])
        for element, count, fields in self.elements:
            for _ in range(count):
                row = {}
                for name, kind in fields:
                    at = next(words)
                    if kind[0] == "list":
                        for _ in range(int(pieces[at])):
                            next(words)
                    elif element == "vertex" and name in MAY_CHANGE:
                        self.numbers.append(pieces[at])
                        row[name] = float_of(pieces[at], PLY_TYPES[kind[0]])
                        pieces[at] = "<>"
                if element == "vertex":
                    self.vertex(row)
        self.rest += pieces

    def binary(self, body):
        order = "<" if "little" in self.format else ">"
        at = 0

        def take(kind):
            nonlocal at
            code = order + PLY_TYPES[kind]
            value = struct.unpack_from(code, body, at)[0]
            at += struct.calcsize(code)
            return value, body[at - struct.calcsize(code):at]
        for element, count, fields in self.elements:
            for _ in range(count):
                row = {}
                for name, kind in fields:
                    if kind[0] == "list":
                        length, text = take(kind[1])
                        self.rest += [text] + [take(kind[2])[1] for _ in range(length)]
                        continue
                    value, text = take(kind[0])
                    if element == "vertex" and name in MAY_CHANGE:
                        row[name] = value
                    else:
                        self.rest.append(text)
                if element == "vertex":
                    self.vertex(row)
        self.rest.append(body[at:])


def float_of(text, code):
    return struct.unpack("f", struct.pack("f", float(text)))[0] if code == "f" else float(text)


# ---- OFF --------------------------------------------------------------------------------------------------------

class Off(Shape):
    def __init__(self, data):
        super().__init__(DOUBLE)
        self.width, self.wanted = 0, None
        for line in re.findall(r"[^\r\n]*(?:\r\n|\n|\r|\Z)", data.decode("latin-1")):
            text, mark, comment = line.partition("#")
            pieces = re.findall(r"\s+|\S+", text)
            self.line(pieces, [i for i, piece in enumerate(pieces) if not piece.isspace()])
            self.rest.append("".join(pieces) + mark + comment)

    def line(self, pieces, words):
        """The keyword, the counts, then a line a vertex."""
        if not self.width and words and pieces[words[0]].endswith("OFF"):
            self.width = 6 if "N" in pieces[words[0]] else 3
            words = words[1:]
        if not words:
            return
        if self.wanted is None:
            self.wanted = int(pieces[words[0]])
        elif len(self.positions) < self.wanted:
            texts = [pieces[i] for i in words[:self.width]]
            self.numbers += texts
            self.positions.append([float(text) for text in texts[:3]])
            if self.width == 6:
                self.corners.append([len(self.positions) - 1, [float(text) for text in texts[3:]]])
            for i in words[:self.width]:
                pieces[i] = "<>"


# ---- STL --------------------------------------------------------------------------------------------------------

class Stl(Shape):
    def __init__(self, data):
        count = struct.unpack_from("<I", data, 80)[0] if len(data) >= 84 else 0
        if len(data) == 84 + 50 * count:
            super().__init__(FLOAT)
            self.binary(data, count)
        else:
            super().__init__(DOUBLE)
            self.ascii(data.decode("latin-1"))

    def facet(self, values):
        self.facets.append((values[:3], [values[3:6], values[6:9], values[9:12]]))
        self.positions += [values[3:6], values[6:9], values[9:12]]

    def binary(self, data, count):
        self.rest.append(data[:84])
        for i in range(count):
            at = 84 + 50 * i
            self.facet(list(struct.unpack_from("<12f", data, at)))
            self.rest.append(data[at + 48:at + 50])

    def ascii(self, text):
        pieces = re.findall(r"\s+|\S+", text)
        values, expected = [], 0
        for i, piece in enumerate(pieces):
            if expected and not piece.isspace():
                values.append(float(piece))
                self.numbers.append(piece)
                pieces[i] = "<>"
                expected -= 1
            elif piece.lower() in ("normal", "vertex"):
                expected = 3
            if len(values) == 12:
                self.facet(values)
                values = []
        self.rest = pieces


def facet_changes(before, after):
    """Facet normals are those of the corners as written; a facet that did not move keeps its own."""
    tolerance = 1.2e-7 if after.precision == FLOAT else 1e-15
    for i, ((old, was), (new, corners)) in enumerate(zip(before.facets, after.facets)):
        if was == corners:
            if old != new:
                yield f"facet {i} did not move, and its normal {old} became {new}"
            continue
        sides = [minus(corners[1], corners[0]), minus(corners[2], corners[0])]
        normal = cross(*sides)
        length = math.hypot(*normal)
        if not any(old) or length == 0:
            continue
        # Some files have normals that look against the corners' winding: they stay on their side.
        side = -1 if dot(old, cross(minus(was[1], was[0]), minus(was[2], was[0]))) < 0 else 1
        # A sliver's normal is uncertain by the rounding of the products that make it.
        slack = tolerance + 4e-16 * math.hypot(*sides[0]) * math.hypot(*sides[1]) / length
        if any(abs(side * x / length - y) > slack for x, y in zip(normal, new)):
            yield f"facet {i}: normal {new}, its corners say {[side * x / length for x in normal]}"


# ---- all --------------------------------------------------------------------------------------------------------

READERS = {".obj": Obj, ".ply": Ply, ".off": Off, ".stl": Stl}


def read(path, before=None):
    """before: what the file was made from."""
    with open(path, "rb") as file:
        data = file.read()
    reader = READERS[path[path.rindex("."):].lower()]
    return reader(data, before) if reader is Obj else reader(data)


def same_bits(a, b):
    return a == b and math.copysign(1, a) == math.copysign(1, b)


def normal_numbers(before, after):
    """Pairs of the texts of normals' numbers, where none were added."""
    if not isinstance(before, Obj) or len(before.normals) != len(after.normals):
        return []
    return zip(before.normal_numbers, after.normal_numbers)


def changes(before, after):
    """What is different between two shapes and may not be: a list of lines."""
    if isinstance(before, Obj):
        found = obj_changes(before, after)
    else:
        found = [] if before.rest == after.rest else ["something other than coordinates and normals changed"]
    found += list(facet_changes(before, after))
    number = number_of if before.precision == DOUBLE else lambda text: float_of(text, "f")
    for old, new in [*zip(before.numbers, after.numbers), *normal_numbers(before, after)]:
        if old == new:
            continue
        now = number(new)
        if same_bits(number(old), now):
            found.append(f"the number {old} is the same and became {new}")
        elif before.precision == DOUBLE and not shortest(new, now):
            found.append(f"the number {new} is longer than it needs to be")
    return found
