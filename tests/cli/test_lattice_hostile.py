#!/usr/bin/env python3
"""ffd lattice convert of files that were made to do harm: each ends with exit 4, 6 or 7 and one line, within 300 MB and 2 seconds of
a processor, and nothing is written. Argument: the program measure_peak."""

import os
import random
import re
import resource
import struct
import subprocess
import sys
import zlib

from author import array
from harness import FFD, INVALID, LIMIT, SANITIZED, UNSUPPORTED, USAGE, case, check, lattice, main, repetitions
from lattice_files import SU2, Vts, grid, npy, plot3d, refitter, su2_box, zipped

MEASURE_PEAK = os.path.abspath(sys.argv.pop(1))
SEED = int(os.environ.get("FFD_SEED") or random.randrange(1 << 30))
RANDOM = random.Random(SEED)
print(f"seed {SEED} (FFD_SEED)")
REFUSALS = (INVALID, UNSUPPORTED, LIMIT)
MOST, SECONDS = 300e6, 2
# Of each file; FFD_LARGE: at every place.
CUTS = 1 << 30 if os.environ.get("FFD_LARGE") else 150
CONTROLS = re.compile("[\0-\x1f\x7f-\x9f]")
IDENTITY = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
HUGE = [1 << 31, (1 << 31) - 1, 1 << 32, (1 << 32) + 1, 1 << 40, 1 << 63, (1 << 64) - 1, 1 << 64, 10 ** 30]


def limit():
    """A sanitizer takes more time, and has its own memory."""
    if not SANITIZED:
        resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS))


def refuse(run, name, content, what="", codes=None, change=""):
    """Measures a run that must refuse the file."""
    # Points in a row are refused where the command does not tell how many stand along u, v and w.
    codes = codes or (REFUSALS + (USAGE,) if name.endswith((".obj", ".npy")) else REFUSALS)
    run.write(name, content)
    environment = {key: value for key, value in os.environ.items() if key != "MALLOC_PERTURB_"}
    done = subprocess.run([MEASURE_PEAK, run.path("peak"), FFD, "lattice", "convert", name, "-o", "n.json"], cwd=run.folder,
                          env=environment, stdin=subprocess.DEVNULL, capture_output=True, check=True, preexec_fn=limit, timeout=120)
    code, peak = map(int, run.text("peak").split())
    said = done.stderr.decode("utf-8", "backslashreplace")
    shown = f"{name} {change}: exit {code}, {peak / 1e6:.0f} MB: {said}"
    check(code in codes and (code != USAGE or "(--size)" in said), shown)
    check(said.startswith("ffd: ") and said.count("\n") == 1 and not CONTROLS.search(said[:-1]) and re.search(what, said), f"{what}: {shown}")
    check(SANITIZED or peak <= MOST, shown)
    check(not run.exists("n.json") and not done.stdout, shown)
    run.check_no_leftovers()
    run.remove(name)


def refit(**more):
    """A small lattice of Blender; more: members in place of its own."""
    rest = [[x, y, 0.0] for y in (-0.5, 0.0, 0.5) for x in (-0.5, 0.5)]
    parts = dict(size=(2, 3, 1), types=["KEY_LINEAR"] * 3, rotation=IDENTITY, location=[1, 2, 3], scale=[2, 1, 4], rest=rest,
                 deformed=[[x + 0.25, y, z] for x, y, z in rest])
    return refitter(**{**parts, **more})


def samples(run):
    """A file of each format and of each encoding, by its name."""
    files = {}
    run.write("l.json", lattice(size=(2, 3, 2), degree=(1, 2, 1), weights=[1.0] * 11 + [2.0], deformed={"offsets": [[0.125, 0, -0.5]] * 12}))
    run.write("b.json", lattice(size=(2, 3, 2), degree=(1, 2, 1), deformed={"offsets": [[0.125, 0, -0.5]] * 12}))
    for source, name in (("l", "a.csv"), ("l", "a.vtk"), ("l", "a.vts"), ("b", "a.prm"), ("b", "a.obj"), ("b", "a.xyz"), ("b", "a.npy")):
        part = ["--part", "rest"] if name in ("a.xyz", "a.npy") else []
        run.ffd("lattice", "convert", f"{source}.json", "-o", name, *part)
        files[name] = run.read(name)
    files["a.fmt"] = plot3d([((2, 2, 3), grid(2, 2, 3))], "").encode()
    files["a.su2"] = (SU2 + su2_box("W", (2, 2, 2), points=[[i, j, k, i, j, k] for i in range(2) for j in range(2) for k in range(2)])).encode()
    points, offsets = grid(2, 3, 2), [[0.5, 0.0, 0.25]] * 12
    for name, place, packed, more in (("b", "binary", False, {}), ("c", "binary", True, {}), ("d", "appended", False, {}), ("e", "appended", True, {}),
                                      ("f", "appended", True, {"encoding": "base64", "order": "BigEndian", "header": "UInt32"})):
        files[name + ".vts"] = Vts(place, packed, **more).file(points, offsets, extent="0 1 0 2 0 1")
    data = [x for p in points for x in p]
    files["b.vtk"] = b"# vtk DataFile Version 5.1\nx\nBINARY\nDATASET STRUCTURED_GRID\nDIMENSIONS 2 3 2\nPOINTS 12 double\n" + struct.pack(">36d", *data) + b"\n"
    files["a.npz"], files["b.npz"] = refit(packed=False), refit(packed=True)
    files["a.json"] = run_json()
    return files


def run_json(**more):
    rest = [[-0.5 + i, -0.5 + j / 2, 0.0] for j in range(3) for i in range(2)]
    content = {"lattice_points": [2, 3, 1], "lattice_object_location": [0, 0, 0], "lattice_object_rotation": [0, 0, 0], "lattice_object_scale": [1, 1, 1],
               "deformed_control_points": rest, **more}
    return ("{" + ", ".join(f'"{name}": {value}' for name, value in content.items()) + "}").encode()


@case
def counts_that_no_file_has(run):
    files = samples(run)
    texts = {name: data.decode() for name, data in files.items() if name in ("a.csv", "a.vtk", "a.vts", "a.prm", "a.obj", "a.xyz", "a.fmt", "a.su2", "a.json")}
    places = (("a.csv", "\n1,2,1,", "\n@,2,1,"), ("a.csv", "# degree 1 2 1", "# degree @ 2 1"), ("a.vtk", "DIMENSIONS 2 3 2", "DIMENSIONS @ 3 2"),
              ("a.vtk", "DIMENSIONS 2 3 2", "DIMENSIONS @ @ @"), ("a.vtk", "POINTS 12", "POINTS @"), ("a.vtk", "ffd_knots_u 4 1", "ffd_knots_u @ 1"),
              ("a.vtk", "ffd_knots_u 4 1", "ffd_knots_u 1 @"), ("a.vtk", "FieldData 5", "FieldData @"), ("a.vtk", "POINT_DATA 12", "POINT_DATA @"),
              ("a.vtk", "SCALARS weight double 1", "SCALARS weight double @"), ("a.vts", 'Piece Extent="0 1 0 2 0 1"', 'Piece Extent="0 @ 0 2 0 1"'),
              ("a.vts", 'Piece Extent="0 1 0 2 0 1"', 'Piece Extent="-@ @ -@ @ -@ @"'), ("a.vts", 'NumberOfTuples="4"', 'NumberOfTuples="@"'),
              ("a.vts", 'Name="weight" NumberOfComponents="1"', 'Name="weight" NumberOfComponents="@"'), ("a.prm", "n control points x: 2", "n control points x: @"),
              ("a.prm", " 0 0 0 ", " @ 0 0 "), ("a.xyz", "1\n2 3 2\n", "@\n2 3 2\n"), ("a.xyz", "2 3 2\n", "@ 3 2\n"), ("a.xyz", "2 3 2\n", "@ @ @\n"), ("a.fmt", "2 2 3\n", "2 @ 3\n"),
              ("a.obj", "size 2 3 2", "size @ 3 2"), ("a.obj", "size 2 3 2", "size @ @ @"), ("a.su2", "FFD_DEGREE_I= 1", "FFD_DEGREE_I= @"), ("a.su2", "FFD_CONTROL_POINTS= 8", "FFD_CONTROL_POINTS= @"),
              ("a.su2", "FFD_CORNER_POINTS= 8", "FFD_CORNER_POINTS= @"), ("a.su2", "\n0\t0\t0\t0", "\n@\t0\t0\t0"), ("a.json", "[2, 3, 1]", "[@, 3, 1]"), ("a.json", "[2, 3, 1]", "[@, @, @]"))
    for name, old, new in places:
        for number in HUGE if SANITIZED or RANDOM.random() < 0.3 else HUGE[:1] + RANDOM.sample(HUGE, 2):
            check(old in texts[name], (name, old))
            refuse(run, "h" + name[1:], texts[name].replace(old, new.replace("@", str(number)), 1), change=new.replace("@", str(number)))
    for shape in ("(2147483648, 2147483648, 2147483648, 3)", "(67108864, 1, 1, 3)", "(4294967296, 4294967296, 1, 3)", "(512, 512, 256, 3)", "(2, 2, 2, 3, 2147483648)"):
        refuse(run, "h.npy", array([0.0] * 24, shape))
    for count in (65535, 4000000000, 1 << 40):
        huge = npy("<u8", "(1,)", struct.pack("<Q", count))
        refuse(run, "h.npz", refit(U=huge))
        refuse(run, "h.npz", refit(U=huge, V=huge, W=huge))
    # Corners alone: a few lines ask for all control points.
    for degrees in ((2, 8000, 2000), (1 << 31, 1, 1), (14, 14, 300000)):
        refuse(run, "h.su2", su2_box("W", (3, 3, 3)).replace("FFD_DEGREE_I= 2", f"FFD_DEGREE_I= {degrees[0]}").replace("FFD_DEGREE_J= 2", f"FFD_DEGREE_J= {degrees[1]}")
               .replace("FFD_DEGREE_K= 2", f"FFD_DEGREE_K= {degrees[2]}").replace("BEZIER", "BSPLINE_UNIFORM\nBSPLINE_ORDER_I= 3\nBSPLINE_ORDER_J= 3\nBSPLINE_ORDER_K= 3"))


def zeros(count):
    """A deflate stream of zeros."""
    packer = zlib.compressobj(9, zlib.DEFLATED, -15)
    piece = b"\0" * (1 << 20)
    return b"".join(packer.compress(piece[:min(len(piece), count - at)]) for at in range(0, count, len(piece))) + packer.flush()


def vts_of(array_tag, extent, appended):
    return (b'<VTKFile type="StructuredGrid" byte_order="LittleEndian" header_type="UInt64" compressor="vtkZLibDataCompressor"><StructuredGrid>'
            + array_tag.encode() + f'<Piece Extent="{extent}"><Points><DataArray type="Float64" Name="Points" NumberOfComponents="3" format="appended" offset="0"/>'.encode()
            + b'</Points></Piece></StructuredGrid><AppendedData encoding="raw">_' + appended + b"</AppendedData></VTKFile>")


@case
def bombs(run):
    """Compressed data that would be gigabytes: refused by what the counts take, before they are unpacked."""
    block = 1 << 20
    piece = zlib.compress(b"\0" * block, 9)
    blocks = 700 if not SANITIZED else 70
    packed = struct.pack(f"<{3 + blocks}Q", blocks, block, 0, *[len(piece)] * blocks) + piece * blocks
    refuse(run, "b.vts", vts_of("", "0 399 0 399 0 199", packed), "MB of memory")
    refuse(run, "b.vts", vts_of("", "0 1 0 1 0 1", packed), "more than 192 bytes|MB")
    field = '<FieldData><DataArray type="Float64" Name="ffd_knots_u" NumberOfTuples="{}" format="appended" offset="0"/></FieldData>'
    refuse(run, "b.vts", vts_of(field.format(blocks * block // 8), "0 1 0 1 0 1", packed), "MB of memory|not of|more than")
    for head in ((1 << 24, 1, 0), ((1 << 64) - 1, 1, 0), (1 << 20, 1 << 63, 1 << 63), (3, (1 << 64) - 64, 1)):
        refuse(run, "b.vts", vts_of("", "0 1 0 1 0 1", struct.pack("<3Q", *head) + b"\0" * 4000), "ends within|more than|broken|blocks")
    count = 400 * 400 * 200 if not SANITIZED else 40 * 400 * 200
    sizes = [npy("<u2", "(1,)", struct.pack("<H", n)) for n in (400, 400, count // 160000)]
    head = npy("<f4", f"({count}, 3)", b"")
    packer = zlib.compressobj(9, zlib.DEFLATED, -15)
    first = packer.compress(head) + packer.flush(zlib.Z_FULL_FLUSH)
    rest = (first + zeros(12 * count), len(head) + 12 * count)
    refuse(run, "b.npz", refit(U=sizes[0], V=sizes[1], W=sizes[2], points_rest=rest, points_deform=rest), "MB of memory")
    # Sizes that the directory tells and the stream does not have, and the other way round.
    for told in (len(head) + 12 * count, 200, 0, (1 << 32) - 2):
        refuse(run, "b.npz", refit(points_rest=(rest[0], told)), "points|longer|shorter|bytes|NumPy|check sum|hold")
    refuse(run, "b.npz", refit(name=(zeros(1 << 26), 1 << 26), magic=(zeros(1 << 26), 1 << 26)), "bytes; at most")


@case
def documents_of_xml(run):
    whole = samples(run)["a.vts"].decode()
    body = whole[whole.index("<VTKFile"):]
    laughs = "<!DOCTYPE l [<!ENTITY l0 'lol'>" + "".join(f"<!ENTITY l{i} '{f'&l{i - 1};' * 10}'>" for i in range(1, 10)) + "]>\n"
    for front in (laughs, "<!DOCTYPE VTKFile SYSTEM 'file:///etc/passwd'>\n", "<!DOCTYPE VTKFile [<!ENTITY x SYSTEM 'file:///etc/passwd'>]>\n", "<!ENTITY x 'y'>\n",
                  "<!DOCTYPE VTKFile PUBLIC '-//x' 'x.dtd'>", "<?xml version='1.0'?>\n<!-- a --> <!DOCTYPE x>\n"):
        refuse(run, "d.vts", front + body, "document type", (INVALID,))
    points = re.search(r'Name="points"[^>]*>\n', body)
    for change, what in (((points[0], points[0] + "&l9;"), "is not a finite number"), ((points[0], points[0] + "&#48;"), "is not a finite number"), ((points[0], points[0] + "<![CDATA[0 0 0]]>"), "document type, or CDATA|ends"),
                         (('Name="offset"', 'Name="&#111;ffset"'), "entities"), (('Piece Extent="0', 'Piece Extent="&x;0'), "entities"), (("</Points>", "<!-- "), "does not end"),
                         (("<Points>", "<?x "), "does not end|twice|no points"), (("<Points>", '<Points a="'), "does not end")):
        check(change[0] in body, change[0])
        refuse(run, "d.vts", body.replace(*change, 1), what, (INVALID,))
    for content in ("<" * 3000000, "<a>" * 1000000, "<a" + " b='c'" * 500000 + ">", "<VTKFile type='StructuredGrid'>" + "<Piece>" * 400000, "<!--" * 700000, "<a '" * 700000,
                    "<VTKFile type='StructuredGrid'>" + "<DataArray" * 300000, body.replace("<Points>", "<a>" * 500000 + "<b>"), "&" * 1000000, "", " ", "\0" * 100000,
                    body.replace("</PointData>", '<DataArray Name="offset" type="Float64" NumberOfComponents="3">' * 2)):
        refuse(run, "d.vts", content)


@case
def nesting_and_length(run):
    files = samples(run)
    for deep in ("[" * 2000000, "{\"a\":" * 300000, "[" * 500000 + "]" * 500000):
        refuse(run, "h.json", b'{"deformed_control_points": ' + deep.encode())
        refuse(run, "h.json", run_json(deformed_control_points=deep))
    for name, data in (("h.csv", b"i,j,k,x,y,z,dx,dy,dz\n" + b"0," * 3000000), ("h.csv", b"# knots u " + b"0 " * 3000000 + b"\n"), ("h.csv", b"#" * 5000000), ("h.csv", b"," * 5000000),
                       ("h.xyz", b"1" * 5000000), ("h.xyz", b"1\n2 2 2\n" + b"1e" * 2000000), ("h.xyz", b"1000000 " + b"1 1 1 " * 900000), ("h.xyz", b"0." + b"0" * 4000000 + b"1"),
                       ("h.prm", b"[" * 4000000), ("h.prm", b"[Box info]\n" + b"n control points x: 2\n" * 100000), ("h.prm", files["a.prm"] + b"parameter x: 0 0 0 " + b"9" * 3000000 + b" x"),
                       ("h.su2", b"FFD_TAG= A\n" * 400000), ("h.su2", b"FFD_TAG= " + b"W" * 4000000), ("h.su2", b"=" * 4000000), ("h.su2", b"FFD_TAG= A\nFFD_CORNER_POINTS= 8\n" * 1000),
                       ("h.obj", b"v " * 2000000), ("h.obj", b"v 0 0 " + b"1" * 4000000 + b"e\n"), ("h.obj", b"# ffd-lattice size 2 2 2" + b" 0" * 2000000), ("h.vtk", b"# vtk DataFile Version " + b"3" * 4000000),
                       ("h.vtk", b"# vtk DataFile Version 3.0\nx\nASCII\nDATASET STRUCTURED_GRID\n" + b"METADATA\n" * 400000), ("h.vtk", b"# vtk DataFile Version 3.0\nx\nASCII\nDATASET STRUCTURED_GRID\n" + b"FIELD F 1\n" * 400000),
                       ("h.npy", b"\x93NUMPY\1\0\xff\xff" + b"(" * 65535), ("h.npy", b"\x93NUMPY\2\0\xff\xff\xff\xff" + b"(" * 65535), ("h.npz", b"PK\5\6" * 20000), ("h.npz", b"PK\1\2" * 20000)):
        refuse(run, name, data)


@case
def zeros_and_rubbish(run):
    files = samples(run)
    for name, data in files.items():
        for content in (b"", b"\0", b"\0" * 4096, b"\n" * 4096, b"\xff" * 4096, bytes(RANDOM.randrange(256) for _ in range(4096)), b"\0" + data, b"\xef\xbb\xbf\0" + data):
            if not name.endswith((".npz", ".su2")) or not content.endswith(data):  # a ZIP file, and a mesh, may begin with anything
                refuse(run, "z" + name[1:], content)
    # A zero among text is no white space.
    for name in ("a.csv", "a.vtk", "a.vts", "a.prm", "a.obj", "a.su2", "a.xyz"):
        read = files[name].partition({"a.su2": b"FFD_SURFACE", "a.obj": b"\nl "}.get(name, b"\0"))[0]
        at = max(i for i, byte in enumerate(read) if chr(byte).isdigit())
        refuse(run, "z" + name[1:], files[name][:at] + b"\0" + files[name][at + 1:])
        refuse(run, "z" + name[1:], files[name][:at] + b"\0" + files[name][at:])


@case
def archives(run):
    good = refit()
    members = {"U": npy("<u2", "(1,)", struct.pack("<H", 2))}
    extra = npy("<u2", "(1,)", struct.pack("<H", 3))
    for data, what in (
            (zipped(good, encrypted="scale"), "encrypted member"), (zipped(good, method=("scale", 12)), "of the compression 12"), (zipped(good, method=("scale", 99)), "of the compression 99"),
            (zipped(good, packed=("scale", 0xffffffff)), "4 GB or more"), (zipped(good, size=("scale", 0xffffffff)), "4 GB or more"), (zipped(good, header=("scale", 0xffffffff)), "4 GB or more"),
            (zipped(good, double="U", with_data=extra), "twice"), (zipped(good, double="x"), "twice"), (zipped(good, crc=("points_rest", 1)), "check sum"), (zipped(good, header=("U", 5)), "no header"),
            (zipped(good, header=("U", 0xfffffff0)), "no header"), (zipped(good, packed=("points_rest", 0xfffffff0)), "ends early"), (zipped(good, packed=("points_rest", 3)), "early|two sizes|shorter|broken"),
            (zipped(good, size=("points_rest", 100)), "two sizes|longer|NumPy|early|array"), (zipped(good, size=("points_rest", 0xfffffff0)), "at most|two sizes"), (zipped(good, count=65535), "65535 members"),
            (zipped(good, count=12), "directory is broken|no array|twice"), (zipped(good, count=0), "no array"), (zipped(good, start=0xffffffff), "directory is broken"), (zipped(good, start=3), "directory is broken"),
            (good + b"\0" * 70000, "no end record"), (refit(points_rest=npy("<f4", "(6, 3)", b"\0" * 60)), "array"), (refit(points_rest=npy("<f4", "(6, 3)", b"\0" * 90)), "array"),
            (refit(points_deform=npy("<f4", "(3, 6)", b"\0" * 71)), "array"), (refit(rotation_quat=npy("<f4", "(2,)", b"\0" * 8)), "of 2 elements, not of 4"), (refit(magic=npy("|O", "(1,)", b"\x80\x04N.")), ""),
            (refit(U=b"\x80\x04]q\x00."), "NumPy"), (refit(points_rest=npy("<f2", "(6, 3)", b"\0" * 36)), "type"), (refit(points_rest=npy("<c16", "(6, 3)", b"\0" * 288)), "type"),
            (refit(scale=[float("nan"), 1, 1]), "not finite"), (refit(**{f"a{n}" * 100: members["U"] for n in range(60)}), "members; at most 64")):
        refuse(run, "a.npz", data, what)
    # What may be: written to a pipe, behind other bytes, with a comment.
    for data in (zipped(good, descriptors=True), b"#!/bin/sh\n" + zipped(good, shift=10), good[:-2] + b"\4\0note"):
        run.write("a.npz", data)
        run.ffd("lattice", "convert", "a.npz", "-o", "o.json", "--force", lines=1, err=re.compile("Blender's lattices act"))


def judge(run, name, content):
    """A lattice, or a refusal: never another exit."""
    run.write("b" + name[1:], content)
    run.remove("n.json")
    told = (USAGE,) if name.endswith((".obj", ".npy")) else ()

    def check_lines(lines):
        check(len(lines) <= 1, lines)
    done = run.ffd("lattice", "convert", "b" + name[1:], "-o", "n.json", code=(0, *REFUSALS, *told), err=check_lines)
    check(done.code != USAGE or "(--size)" in done.err[0], done.err)
    check(run.exists("n.json") == (done.code == 0), name, done.code)
    return done.code


# What may be missing begins so.
OPTIONAL = {"a.obj": b"\nl 1 2", "a.vtk": b"POINT_DATA", "a.prm": b"[Parameters", "a.su2": b"FFD_SURFACE"}


@case
def cut_anywhere(run):
    for name, data in samples(run).items():
        step = max(1, len(data) // repetitions(CUTS))
        places = range(RANDOM.randrange(step), len(data), step)
        codes = [judge(run, name, data[:at]) for at in places]
        # A text has no end mark: what is missing may be what need not be there, or digits of its last number.
        needed = data.index(OPTIONAL[name]) - 8 if name in OPTIONAL else len(data) - 20
        early = [code for at, code in zip(places, codes) if at < needed]
        check(early and all(early), name, [at for at, code in zip(places, codes) if code == 0][:5])


@case
def flipped_bits(run):
    for name, data in samples(run).items():
        refused = 0
        for _ in range(repetitions(60)):
            changed = bytearray(data)
            for _ in range(RANDOM.choice([1, 1, 2, 8])):
                changed[RANDOM.randrange(len(changed))] ^= 1 << RANDOM.randrange(8)
            refused += judge(run, name, bytes(changed)) != 0
        check(refused or SANITIZED, name)


main()
