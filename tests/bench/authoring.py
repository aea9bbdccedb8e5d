"""What it takes to make a lattice file of another one."""

import array
import json
import os
import random
import struct
import subprocess
import sys
import zlib

import lattices
import programs
from programs import Command


def write_lattice(path, size):
    """A box whose control points have all moved."""
    draw = random.Random(size)
    with open(path, "w", encoding="utf-8") as file:
        json.dump({"format": "ffd-lattice", "version": 1, "size": [size] * 3, "rest": {"box": {"min": [-1] * 3, "max": [1] * 3}},
                   "deformed": {"offsets": [[draw.uniform(-1e-3, 1e-3) for _ in range(3)] for _ in range(size**3)]}}, file)


def authoring(bench):
    """refine and set beside convert, which reads and writes the same numbers."""
    size = max(6, 128 * bench.side // 1000)
    bench.table.title(f"Lattices of {size}^3 control points")
    source = bench.mesh("large.json", write_lattice, size)
    output = bench.path("made.json")
    commands = [Command([bench.ffd, "lattice", *words, source, *more, "-o", output], output)
                for words, more in ((["convert"], []), (["refine"], ["--insert", "u:0.41"]), (["set"], ["--strength", "0.5"]))]
    converted, refined, changed = programs.in_turns(commands, bench.runs)
    for what, unit, bar in (("seconds", "s", "<= 1.5"), ("megabytes", "MB", "<= 1.5")):
        of = "" if what == "seconds" else ", peak memory"
        row = bench.table.add("convert" + of, getattr(converted, what), unit)
        bench.table.add("refine, a knot inserted" + of, getattr(refined, what), unit, row, bar)
        bench.table.add("set, half the edit" + of, getattr(changed, what), unit, row, bar)


BLOCK = 32768  # VTK's size of a compressed block


def numbers_of(source):
    """Those of the points, and of the offsets."""
    with open(source, encoding="utf-8") as file:
        content = json.load(file)
    return [[x for p in rows for x in p] for rows in (content["rest"]["points"], content["deformed"]["offsets"])]


def write_vtk(path, size, source):
    """Binary, as VTK writes it."""
    swapped = [array.array("d", values) for values in numbers_of(source)]
    if sys.byteorder == "little":
        for values in swapped:
            values.byteswap()
    with open(path, "wb") as file:
        file.write(f"# vtk DataFile Version 4.2\nvtk output\nBINARY\nDATASET STRUCTURED_GRID\nDIMENSIONS {size} {size} {size}\nPOINTS {size**3} double\n".encode())
        file.write(swapped[0].tobytes() + f"\nPOINT_DATA {size**3}\nVECTORS offset double\n".encode() + swapped[1].tobytes() + b"\n")


def packed(values):
    """An array in blocks of zlib, with their sizes in front."""
    data = array.array("d", values).tobytes()
    blocks = [zlib.compress(data[at:at + BLOCK]) for at in range(0, len(data), BLOCK)]
    return struct.pack(f"={3 + len(blocks)}Q", len(blocks), BLOCK, len(data) % BLOCK, *map(len, blocks)) + b"".join(blocks)


def write_vts(path, size, source):
    """Appended raw and compressed by zlib, as ParaView writes it."""
    points, offsets = map(packed, numbers_of(source))
    extent, tag = " ".join([f"0 {size - 1}"] * 3), '<DataArray type="Float64" Name="{}" NumberOfComponents="3" format="appended" offset="{}"/>'
    order = "LittleEndian" if sys.byteorder == "little" else "BigEndian"
    with open(path, "wb") as file:
        file.write(f'<VTKFile type="StructuredGrid" version="1.0" byte_order="{order}" header_type="UInt64" compressor="vtkZLibDataCompressor"><StructuredGrid WholeExtent="{extent}">'
                   f'<Piece Extent="{extent}"><PointData>{tag.format("offset", len(points))}</PointData><Points>{tag.format("Points", 0)}</Points></Piece></StructuredGrid>'
                   '<AppendedData encoding="raw">_'.encode() + points + offsets + b"</AppendedData></VTKFile>")


def formats(bench):
    """convert to and from other formats beside JSON to JSON of the same numbers."""
    size = max(6, 128 * bench.side // 1000)
    bench.table.title(f"Formats of lattices of {size}^3 control points")
    source, points = bench.mesh("large.json", write_lattice, size), bench.path("points.json")
    table = bench.path("table.csv")
    for read, *written in ([source, table], [table, points], [table, bench.path("rest.npy"), "--part", "rest"]):
        subprocess.run([bench.ffd, "lattice", "convert", read, "-o", *written, "--quiet"], check=True)
    bench.mesh("grid.vtk", write_vtk, size, points)
    bench.mesh("grid.vts", write_vts, size, points)
    runs = [("JSON to JSON", "points.json", "made.json", ""), ("JSON to .csv", "points.json", "made.csv", "<= 1"), ("JSON to .npy", "points.json", "made.npy", "<= 1"),
            (".csv to JSON", "table.csv", "made.json", "<= 1"), (".npy to JSON", "rest.npy", "made.json", "<= 1"), (".vtk, binary, to JSON", "grid.vtk", "made.json", "<= 1"),
            (".vts, zlib, to JSON", "grid.vts", "made.json", "<= 2")]
    words = [[bench.ffd, "lattice", "convert", bench.path(read), "-o", bench.path(written), *(["--part", "rest"] if written.endswith(".npy") else [])]
             for _, read, written, _ in runs]
    samples = programs.in_turns([Command(line, line[5]) for line in words], bench.runs)
    first = None
    for (what, _, _, bar), sample in zip(runs, samples):
        row = bench.table.add(what, sample.seconds, "s", first, bar)
        first = first or row
    # The text of JSON is made in memory: .vts is written as it is made.
    for name, each in (("table.csv", 6), ("rest.npy", 3), ("grid.vtk", 6), ("grid.vts", 6)):
        output, source = bench.path("made.vts"), bench.path(name)
        sample, = programs.in_turns([Command([bench.ffd, "lattice", "convert", source, "-o", output], output)], bench.runs)
        row = bench.table.add(f"{name}: the numbers", [each * 8 * size**3 / 1e6], "MB")
        beyond = [megabytes - os.path.getsize(source) / 1e6 for megabytes in sample.megabytes]
        bench.table.add(f"{name} to .vts: memory beyond the file", beyond, "MB", row, "<= 4")
    for name in ("table.csv", "points.json", "rest.npy", "grid.vtk", "grid.vts"):
        os.remove(bench.path(name))


KEYS = [{"time": 0, "set": {"A": 0}}, {"time": 2, "set": {"A": 180}}]  # 121 samples


def write_path(path, size, degrees=None):
    """A twist, over time or of so many degrees."""
    twist = {"twist": {"axis": "z", "degrees": {"$": "A"} if degrees is None else degrees}}
    with open(path, "w", encoding="utf-8") as file:
        json.dump({"format": "ffd-lattice", "version": 1, "size": [size] * 3, "rest": {"box": lattices.BOX}, "moves": [twist],
                   **({"keys": KEYS} if degrees is None else {})}, file)


def targets_of(words):
    """How many morph targets the animation has."""
    report = json.loads(subprocess.run([*words, "--report", "-"], check=True, capture_output=True, text=True).stdout)
    return report["jobs"][0]["animation"]["targets"]


def animation(bench):
    """animate beside deform --morph, which writes as many targets of the same mesh."""
    size = 16 if bench.side >= 100 else 6
    source, output, path = bench.glb(), bench.path("animated.glb"), bench.path("path.json")
    bench.table.title(f"An animation by {size}^3 control points ({bench.side * bench.side:,} vertices)")
    write_path(path, size)
    animate = [bench.ffd, "animate", source, output, "-l", path, "--force"]
    count = targets_of(animate)
    morphs = [bench.ffd, "deform", source, output, "--force"]
    for target in range(count):
        still = bench.path(f"still-{target}.json")
        write_path(still, size, 180 * (target + 1) / count)
        morphs += ["--morph", f"turn-{target}={still}"]
    pair = programs.in_turns([Command(words, output) for words in (morphs, animate)], bench.runs)
    for what, unit in (("seconds", "s"), ("megabytes", "MB")):
        of = "" if what == "seconds" else ", peak memory"
        row = bench.table.add(f"deform --morph, {count} targets{of}", getattr(pair[0], what), unit)
        bench.table.add(f"animate, 121 samples{of}", getattr(pair[1], what), unit, row, "<= 1.5")
