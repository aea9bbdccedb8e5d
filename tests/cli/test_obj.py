#!/usr/bin/env python3
"""OBJ files line by line, with a reader of their own here: in every dialect only the numbers of `v` and `vn` change
that move, and the indices that an added `vn` asks for."""
import re

from harness import INVALID, MODELS, SANITIZED, carried, case, check, equal, lattice, main, models, threaded_case

NAMES = ("g", "o", "usemtl", "mtllib")
BUMP = [{"at": [[1, 2], [1, 2], [1, 2]], "by": [0.5, 0.25, -0.125]}]
REFUSED = {"obj/ufbx/synthetic_partial_attrib_0_obj.obj": "23: vertex index 0 is out of range: indices start at 1"}


LINE = re.compile(r"[^\r\n\\#]*(\r\n|\r|\n)")
WORD = re.compile(r"[^ \t\v\f\r\n]+")
EXPONENT = re.compile(r"([+-]?[\d.]+)[+-][eE]\d*")


def line_end(text, at):
    return 2 if text[at:at + 2] == "\r\n" else 1 if text[at:at + 1] in ("\r", "\n") else 0


def logical_lines(text):
    """Lines with what continues them: (text, its words)."""
    at, found = 0, []
    while at < len(text):
        plain = LINE.match(text, at)
        if plain:
            found.append((plain[0], WORD.findall(plain[0])))
            at = plain.end()
            continue
        start, words, word, comment = at, [], None, False
        while at < len(text):
            c = text[at]
            if c == "\\" and not comment and (at + 1 == len(text) or line_end(text, at + 1)):
                word = None
                at += 1 + line_end(text, at + 1)
                continue
            if line_end(text, at):
                at += line_end(text, at)
                break
            comment = comment or c == "#" and not (words and text[slice(*words[0])] in NAMES)
            if comment or c in " \t\v\f":
                word = None
            elif word:
                word[1] = at + 1
            else:
                word = [at, at + 1]
                words.append(word)
            at += 1
        found.append((text[start:at], [text[slice(*w)] for w in words]))
    return found


def decoded(data):
    text = data.decode("latin-1")
    return text[3:] if text.startswith("\xef\xbb\xbf") else text


def number(word):
    """Some exporters write 3.1+e2 and mean nothing by it."""
    try:
        return float(word)
    except ValueError:
        plain = EXPONENT.fullmatch(word)
        return float(plain[1] if plain else word)


def vectors(lines, keyword):
    return [[number(w) for w in words[1:4]] for _, words in lines if words[:1] == [keyword]]


def count(lines, keyword):
    return sum(words[:1] == [keyword] for _, words in lines)


def corners(lines):
    """(vertex, normal or None) of each corner of each face, from 0."""
    seen = {"v": 0, "vn": 0}
    total = count(lines, "vn")
    found = []
    for _, words in lines:
        if words[:1] == ["f"]:
            for word in words[1:]:
                parts = word.split("/")
                vertex, normal = int(parts[0]), int(parts[2]) if total and len(parts) > 2 and parts[2] else None
                found.append((vertex - 1 if vertex > 0 else seen["v"] + vertex,
                              normal if normal is None else normal - 1 if normal > 0 else seen["vn"] + normal))
        elif words and words[0] in seen:
            seen[words[0]] += 1
    return found


def blanked(line, words, keyword):
    """A line's text without the numbers that may change."""
    if keyword in ("v", "vn"):
        for word in words[1:4]:
            line = line.replace(word, "\0", 1)
    elif keyword == "f":
        line = re.sub(r"(\d/\d*/)[+-]?\d+", r"\1" + "\0", line)
    return line


def drop_added(name, before, after):
    """The lines of `after` without the `vn` that were added, which are the last ones."""
    added = count(after, "vn") - count(before, "vn")
    check(added >= 0, name, "lost normals")
    kept, joined = [], False
    for text, words in reversed(after):
        if added and words[:1] == ["vn"]:
            check(re.fullmatch(r"vn( -?[\d.]+(e[+-]\d+)?){3}(\r\n|\r|\n)", text), f"{name}: added {text!r}")
            added -= 1
            joined = not added
            continue
        # What a backslash at the end of a comment joins, for readers that continue those too.
        if not (joined and text.strip() == ""):
            kept.append((text, words))
        joined = False
    return kept[::-1]


def compare_lines(name, before, after):
    """Fails unless the files differ only as they may. Returns how many lines do."""
    kept = drop_added(name, before, after)
    equal(len(kept), len(before), f"{name}: lines")
    changed = 0
    for i, ((old, old_words), (new, new_words)) in enumerate(zip(before, kept)):
        if i == len(before) - 1 and len(after) > len(before) and re.search(r"([^\r\n]|\\(\r\n|\r|\n))\Z", old):
            new = re.sub(r"(\r\n|\r|\n)\Z", "", new)
        if old == new:
            continue
        changed += 1
        keyword = old_words[0] if old_words else ""
        if keyword not in ("v", "vn", "f") or len(old_words) != len(new_words):
            check(False, f"{name}: {old!r} became {new!r}")
        equal(blanked(new, new_words, keyword), blanked(old, old_words, keyword), name)
        if keyword != "f":
            for a, b in zip(old_words, new_words):
                if not (a == b or number(a) != number(b) or number(a) == 0):
                    check(False, f"{name}: {a} became {b}")
    return changed


def carried_normals(run, points, pairs, normals, lattice_name):
    """What becomes of each pair of a vertex and a normal, from a PLY that has a vertex for each."""
    pairs = sorted(pairs)
    rows = "".join(" ".join(map(repr, points[v] + normals[n])) + "\n" for v, n in pairs)
    run.write("n.ply", f"ply\nformat ascii 1.0\nelement vertex {len(pairs)}\n"
              + "".join(f"property double {p}\n" for p in ("x", "y", "z", "nx", "ny", "nz")) + "end_header\n" + rows)
    run.ffd("deform", "n.ply", "m.ply", "-l", lattice_name, "--force", "-q")
    moved = run.text("m.ply").split("end_header\n")[1].splitlines()
    return {pair: [float(x) for x in row.split()[3:6]] for pair, row in zip(pairs, moved)}


def around(points):
    """A lattice that holds all points well inside, which moves all of them."""
    low, high = ([edge(p[a] for p in points) for a in range(3)] if points else [0.0] * 3 for edge in (min, max))
    size = max(b - a for a, b in zip(low, high)) or 1.0
    return lattice(low=[a - size / 8 for a in low], high=[b + size / 8 for b in high],
                   moves=[{**move, "by": [size * x for x in move["by"]]} for move in BUMP])


def deforms(run, name, path, before):
    """Deforms a file and compares all of it with what must come out. Returns how many lines changed."""
    old = logical_lines(decoded(before))
    points, normals = vectors(old, "v"), vectors(old, "vn")
    run.write("still.json", lattice())
    run.ffd("deform", path, "q.obj", "-l", "still.json", "--force", "-q")
    equal(run.read("q.obj"), before, f"{name}: without a move")
    run.write("moved.json", around(points))
    run.ffd("deform", path, "q.obj", "-l", "moved.json", "--force", "-q")
    after = run.read("q.obj")
    new = logical_lines(decoded(after))
    equal(after[:3] == b"\xef\xbb\xbf", before[:3] == b"\xef\xbb\xbf", f"{name}: byte order mark")
    equal(vectors(new, "v"), carried(run, points, "moved.json"), name)
    changed = compare_lines(name, old, new)
    was, now = corners(old), corners(new)
    equal([v for v, _ in now], [v for v, _ in was], f"{name}: corners")
    pairs = {pair for pair in was if pair[1] is not None}
    expected = carried_normals(run, points, pairs, normals, "moved.json") if pairs else {}
    found = vectors(new, "vn")
    for (v, n), (_, m) in set(zip(was, now)):
        equal(m is None, n is None, name)
        if n is not None:
            equal(found[m], expected[v, n], f"{name}: normal {n} of vertex {v}")
    return changed


DIALECT = """# every kind of line \\
f 1//1 2//1 3//2
mtllib ../no such.mtl
v 0.1 0.2 0.3
v\t1.0000001  -2e-1 +3.25E+00 \t
v .5 5. 0.30000000000000004 # a comment, not continued \\
v 1 1 1 0.5
v 0.25 0.125 1 255 128 0
v 0.25 0.125 0.75 1 1 0.5 0.25
v 123456.7 1234567890.1234567 -1e-7
vn 0 0 1
vn 0.6 0 0.8
vt 0.5 0.5
o a name # with a hash
g one two \\
 three
usemtl m\\n
s off
f 1/1/1 2/1/1 3//1 4//1 5//1
f -1//-1 \\
 -2//-1 \\
  -3//-2# at once
v -1 -1 -1
vn 1 0 0
f -1//-1 -2//-1 -3//-3
l 1 2 -1
p 3
cstype rat bezier
deg 2 2
surf 0 1 0 1 1 2 3 4 5 6 7 8 1//1
parm u 0 1
end
vp 0.5 0.5
f 1 2 3

unknown 1 2 3 \\
"""


@case
def line_ends_and_marks_stay_as_they_are(run):
    """The same file with each line end, with and without byte order mark and end of its last line."""
    for end in ("\n", "\r\n", "\r"):
        for mark in (b"", b"\xef\xbb\xbf"):
            for last in ("", end, "v 7 8 9", "# \\"):
                text = mark + (DIALECT.replace("\n", end) + last).encode()
                run.write("d.obj", text)
                changed = deforms(run, f"{end!r} {last!r}", "d.obj", text)
                check(changed >= 8 + 3 + 3, f"{changed} lines changed")


@case
def dialect_is_read_as_meant(run):
    """What the reader of this test makes of the dialect, in numbers."""
    run.write("d.obj", DIALECT)
    found = run.ffd("info", "d.obj", "--json", err="d.obj: line 36: \"unknown\" is no statement of OBJ: it is left as it is").json
    equal([found[key] for key in ("vertices", "normals")], [8, len({c for c in corners(logical_lines(DIALECT)) if c[1] is not None})])
    equal(len(vectors(logical_lines(DIALECT), "v")), 8)
    equal([found["contents"][key] for key in ("faces", "lines", "points")], [5, 1, 1])
    equal(vectors(logical_lines(DIALECT), "v")[6], [123456.7, 1234567890.1234567, -1e-7])


@threaded_case
def sample_models_are_copied_and_deformed(run):
    found = models(".obj")
    changed = 0
    # Under a sanitizer some of them: test_obj_models.c reads others.
    for name, path, before in found[::3 if SANITIZED else 1]:
        if name in REFUSED:
            run.ffd("deform", path, "r.obj", "-l", run.write("l.json", lattice()), code=INVALID,
                    err=f"{path}:{REFUSED[name]}")
            continue
        changed += deforms(run, name, path, before)
    check(not MODELS or len(found) > 100 and changed > (1000 if SANITIZED else 10000), f"{len(found)} models, {changed} lines")


main()
