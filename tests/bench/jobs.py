"""Single jobs, whole processes: time and memory of `ffd deform` beside `dd` on the same file, and what they hang on."""

import math
import os
import shutil
import statistics

import lattices
import meshes
import programs
from table import Row

SIZES = (4, 8, 16, 32, 64)
BLOCKS = (2, 5, 10)  # along each side


def vertices(side):
    return f"{side * side:,} vertices"


def start(bench):
    """What a process costs that has next to nothing to do, beside a program that does nothing, started the same way. A
    GLB loads a module and the C++ runtime."""
    source = bench.mesh("small.obj", meshes.write_points, 100)
    small_glb = bench.mesh("small.glb", meshes.write_glb, 10)
    nothing = bench.built("nothing")
    jobs = {"a C program that does nothing": (nothing and programs.Command([nothing]), ""),
            "ffd --version": (programs.Command([bench.ffd, "--version"]), "<= 1.6" if nothing else ""),
            "100 vertices, box": (bench.deform(source, bench.lattices["box"]), "<= 2.5" if nothing else ""),
            "100 vertices, warped": (bench.deform(source, bench.lattices["warped"]), "< 8 ms"),
            "100 vertices, box, GLB": (bench.deform(small_glb, bench.lattices["box"]), "< 8 ms")}
    jobs = {name: (command, bar) for name, (command, bar) in jobs.items() if command}
    bench.table.title("Start")
    samples = programs.in_turns([command for command, _ in jobs.values()], 6 * bench.runs + 1)
    least = None
    for (name, (_, bar)), sample in zip(jobs.items(), samples):
        row = bench.table.add(name, [1000 * seconds for seconds in sample.seconds], "ms", least, bar)
        least = least or (row if nothing else None)


def static(bench):
    """The static program beside the dynamic one: on large meshes, and on a small one, where its start counts."""
    bench.table.title(f"Static program, one thread ({vertices(bench.side)}, and 100)")
    if not bench.static:
        bench.table.say("  on request, --static PATH")
        return
    small = bench.mesh("small.obj", meshes.write_points, 100)
    for source, runs in ((bench.glb(), bench.runs), (bench.obj(), bench.runs), (small, 6 * bench.runs + 1)):
        for kind, lattice in bench.lattices.items():
            dynamic = bench.deform(source, lattice, threads=1)
            one, other = programs.in_turns([dynamic, dynamic._replace(words=[bench.static, *dynamic.words[1:]])], runs)
            name = f"{os.path.basename(source)}, {kind}"
            for clock, unit in (("seconds", "ms"), ("processor", "ms cpu")):
                row = bench.table.add(f"{name}: dynamic", [1000 * seconds for seconds in getattr(one, clock)], unit)
                bench.table.add(f"{name}: static", [1000 * seconds for seconds in getattr(other, clock)], unit, row, "<= 1.03")


def beside_copy(bench, source, bars):
    """Time and memory with each kind of lattice beside a plain copy."""
    size = Row("the file", [os.path.getsize(source) / 1e6], "MB")
    bench.table.title(f"{os.path.splitext(source)[1]}, {vertices(bench.side)} with normals, {size.median:.1f} MB")
    copy = bench.copy(source)
    programs.measure(copy)  # the file is in the page cache from here on
    for name, lattice in bench.lattices.items():
        deformed, copied = programs.in_turns([bench.deform(source, lattice), copy], bench.runs)
        plain = bench.table.add(f"{name}: dd bs=64M", copied.seconds, "s")
        bench.table.add(f"{name}: ffd deform", deformed.seconds, "s", plain, bars.get(name, ""))
        bench.table.add(f"{name}: peak memory", deformed.megabytes, "MB", size, "<= 1.5")


def glb(bench):
    beside_copy(bench, bench.glb(), {"box": "<= 2 (1.5)", "warped": "<= 10"})


def obj(bench):
    beside_copy(bench, bench.obj(), {"box": "<= 3 (2)"})


def sizes(bench):
    """What the number of control points costs, box lattices of 4^3 to 64^3: the whole process, and a vertex, which is
    what it takes longer than with 100 vertices."""
    small = bench.mesh("small.obj", meshes.write_points, 100)
    paths = [lattices.write_box(bench.path(f"box{size}.json"), size) for size in SIZES]
    whole, starts = (programs.in_turns([bench.deform(source, path) for path in paths], bench.runs)
                     for source in (bench.glb(), small))
    bench.table.title("Lattice size (GLB, box)")
    process = vertex = None
    for size, sample, begun in zip(SIZES, whole, starts):
        beginning = statistics.median(begun.seconds)
        costs = [1e9 * (seconds - beginning) / bench.side ** 2 for seconds in sample.seconds]
        row = bench.table.add(f"{size}^3: whole process", sample.seconds, "s", process)
        cost = bench.table.add(f"{size}^3: a vertex", costs, "ns", vertex, "<= 1.5" if vertex else "")
        process, vertex = process or row, vertex or cost


def blocks(bench):
    """What the number of blocks costs (--blocks), 8 to 1,000 of 4^3 control points side by side, one thread: a vertex,
    as above. The bar is how the logarithm grows."""
    small = bench.mesh("small.obj", meshes.write_points, 100)
    paths = [lattices.write_blocks(bench.path(f"block{side}"), side) for side in BLOCKS]
    whole, starts = (programs.in_turns([bench.deform(source, first, "--blocks", *(word for path in more for word in ("-l", path)),
                                                     threads=1) for first, *more in paths], bench.runs)
                     for source in (bench.glb(), small))
    bench.table.title("Blocks (GLB, boxes, one thread)")
    least = None
    for side, sample, begun in zip(BLOCKS, whole, starts):
        bench.table.add(f"{side ** 3} blocks: 100 vertices", begun.seconds, "s")
        beginning = statistics.median(begun.seconds)
        costs = [1e9 * (seconds - beginning) / bench.side ** 2 for seconds in sample.seconds]
        bar = f"<= {math.log(side) / math.log(BLOCKS[0]):.1f}" if least else ""
        row = bench.table.add(f"{side ** 3} blocks: a vertex", costs, "ns", least, bar)
        least = least or row


def attributes(bench):
    """What normals and tangents cost beside positions, whole process, one thread."""
    source = bench.mesh("tangents.glb", meshes.write_glb_with_tangents, bench.side)
    bench.table.title("Normals and tangents (GLB, one thread, whole process)")
    for name, lattice in bench.lattices.items():
        kept, carried = programs.in_turns([bench.deform(source, lattice, "--normals", normals, threads=1)
                                           for normals in ("keep", "transform")], bench.runs)
        positions = bench.table.add(f"{name}: positions", kept.seconds, "s")
        bench.table.add(f"{name}: with normals and tangents", carried.seconds, "s", positions, "<= 2.5")


def weights(bench):
    """What a weight for each vertex costs, without normals and with: there it needs the faces."""
    bench.table.title(f"Weights (GLB, {vertices(bench.side)})")
    for what, has_normals, bar in (("positions", False, "<= 1.3"), ("normals too", True, "<= 1.6")):
        source = bench.mesh(f"weighted-{int(has_normals)}.glb", meshes.write_weighted_glb, bench.side, has_normals)
        plain, weighted = programs.in_turns([bench.deform(source, bench.lattices["box"], *options)
                                             for options in ((), ("--weight", "attribute:_FFD"))], 2 * bench.runs + 1)
        row = bench.table.add(f"{what}: plain", plain.seconds, "s")
        bench.table.add(f"{what}: weighted", weighted.seconds, "s", row, bar)


def threads(bench):
    """What a second thread brings to four times as many vertices, and how fast a plain copy is; and without a file to
    write, which has one writer at a time, beside what the machine has for two processes that share nothing."""
    side = 2 * bench.side
    source = bench.mesh("four.glb", meshes.write_glb, side)
    bench.table.title(f"Threads (GLB, {vertices(side)})")

    def measure(*commands):
        return [[command.at_once * side * side / 1e6 / seconds for seconds in sample.seconds]
                for command, sample in zip(commands, programs.in_turns(commands, bench.runs))]

    def add(name, one, two):
        row = bench.table.add(f"{name}: 1 thread", one, "M/s")
        bench.table.add(f"{name}: 2 threads", two, "M/s", row, ">= 1.8")
        return row

    for name, lattice in bench.lattices.items():
        one, two, copied = measure(*(bench.deform(source, lattice, threads=count) for count in (1, 2)),
                                   bench.copy(source))
        bench.table.add(f"{name}: dd bs=64M", copied, "M/s")
        add(name, one, two)
    for name, lattice in bench.lattices.items():
        single, double = (bench.deform(source, lattice, "--output-format", "glb", target="-", threads=count)
                          for count in (1, 2))
        one, two, apart = measure(single, double, single._replace(at_once=2))
        row = add(f"{name}, to /dev/null", one, two)
        bench.table.add(f"{name}, to /dev/null: 2 processes at once", apart, "M/s", row)


def inversion(bench):
    """Certified inversions a second and thread: by what a warped lattice takes longer than a box, all else being equal.
    Its search structure counts; normals are kept, for those too would cost more in the warped one."""
    side = 2 * bench.side
    source = bench.mesh("four.glb", meshes.write_glb, side)
    bench.table.title(f"Inversion (GLB, {vertices(side)}, one thread, --normals keep)")
    box, warped = programs.in_turns([bench.deform(source, lattice, "--normals", "keep", threads=1)
                                     for lattice in bench.lattices.values()], bench.runs)
    bench.table.add("box", box.seconds, "s")
    bench.table.add("warped", warped.seconds, "s")
    longer = [slow - fast for slow, fast in zip(warped.seconds, box.seconds)]
    bench.table.add("certified vertices", [side * side / 1e6 / seconds if seconds > 0 else math.inf
                                           for seconds in longer], "M/s", bar=">= 1 M/s (2)")


def tears(bench):
    """What it costs to count torn edges: a lattice that leaves a twentieth of the vertices outside, beside one that holds
    all."""
    bench.table.title(f"Torn edges ({vertices(bench.side)})")
    cut = lattices.write_cut(bench.path("cut.json"))
    for kind, source in ((".glb", bench.glb()), (".obj", bench.obj()),
                         (".ply, ascii", bench.mesh("ascii.ply", meshes.write_ply, bench.side)),
                         (".ply, binary", bench.mesh("binary.ply", meshes.write_binary_ply, bench.side)),
                         (".off", bench.mesh("in.off", meshes.write_off, bench.side))):
        whole, partly = programs.in_turns([bench.deform(source, bench.lattices["box"]), bench.deform(source, cut)], bench.runs)
        row = bench.table.add(f"{kind}: all inside", whole.seconds, "s")
        bench.table.add(f"{kind}: 5 % outside", partly.seconds, "s", row, "<= 1.3")
        row = bench.table.add(f"{kind}: all inside, peak memory", whole.megabytes, "MB")
        bench.table.add(f"{kind}: 5 % outside, peak memory", partly.megabytes, "MB", row, "<= 1.1")


def seams(bench):
    """What it costs to find the faces that the mesh cuts, and to hold them: of lattices that leave a twentieth of the vertices
    outside, and of one that holds all, beside the same without --seam."""
    bench.table.title(f"Smooth joins, --seam C1 ({vertices(bench.side)})")
    cut, warped = lattices.write_cut(bench.path("cut.json")), lattices.write_warped_cut(bench.path("warped-cut.json"))
    for kind, source in ((".glb", bench.glb()), (".obj", bench.obj()),
                         (".ply, binary", bench.mesh("binary.ply", meshes.write_binary_ply, bench.side))):
        for name, lattice in (("5 % outside", cut), ("all inside", bench.lattices["box"]), ("warped, some outside", warped)):
            plain, held = programs.in_turns([bench.deform(source, lattice), bench.deform(source, lattice, "--seam", "C1")], bench.runs)
            row = bench.table.add(f"{kind}, {name}", plain.seconds, "s")
            bench.table.add(f"{kind}, {name}: --seam", held.seconds, "s", row, "<= 1.1")


def splats(bench):
    """Gaussian splats beside vertices with normals of as many bytes."""
    bench.table.title(f"Gaussian splats (binary PLY, 248 bytes a vertex, {vertices(bench.side)})")
    sources = [bench.mesh(name, meshes.write_splats, bench.side, are_splats)
               for name, are_splats in (("values.ply", False), ("splats.ply", True))]
    for name, lattice in bench.lattices.items():
        plain, turned = programs.in_turns([bench.deform(source, lattice) for source in sources], bench.runs)
        row = bench.table.add(f"{name}: vertices with normals", plain.seconds, "s")
        bench.table.add(f"{name}: Gaussian splats", turned.seconds, "s", row, "<= 2")
        row = bench.table.add(f"{name}: vertices with normals, peak memory", plain.megabytes, "MB")
        bench.table.add(f"{name}: Gaussian splats, peak memory", turned.megabytes, "MB", row)


def large(bench):
    """Time and memory of a file of many gigabytes, once."""
    bench.table.title(f"Large OBJ, {bench.large:g} GB, --normals keep")
    # The file, its result, and positions that are put aside (data/promises.md, Limits).
    needed, free = 2.5 * bench.large, shutil.disk_usage(bench.folder).free / 1e9
    if free < needed:
        bench.table.say(f"  too little disk space in {bench.folder}: {free:.1f} GB of {needed:.1f} GB (see --folder)")
        return
    source = bench.mesh("large.obj", meshes.write_large_obj, bench.side, bench.large * 1e9)
    sample, = programs.in_turns([bench.deform(source, bench.lattices["box"], "--normals", "keep")], 1)
    size = Row("the file", [os.path.getsize(source) / 1e6], "MB")
    bench.table.add("box: ffd deform", sample.seconds, "s")
    bench.table.add("box: peak memory (bar: for 10 GB)", sample.megabytes, "MB", size, "< 1000 MB")
    os.remove(source)
