#!/usr/bin/env python3
"""Time and memory of `ffd deform` on a mesh of a million vertices with normals, beside a plain copy of the file.

    bench.py --ffd PATH [--runs 5] [--side 1000] [--threads N] [--folder DIR] [--only glb|obj] [--csv FILE]

The meshes are made first (at the default size a GLB of 48 MB and an OBJ of v, vt, vn and quads of about 160 MB).
Before that: what it takes to start. Each run of the program is followed by one of `dd bs=64M` on the same file, so that both meet the same machine;
read and written data stay in the page cache. Time is wall-clock, memory the largest resident set of the process.
Then what the lattice's size and normals with tangents cost, what a second thread brings to four million vertices, how
many small meshes a second a batch does, and what others take that are installed (assimp; SciPy and VTK, if the Python
that runs this has them).
"""

import argparse
import array
import json
import math
import os
import platform
import shutil
import statistics
import struct
import subprocess
import sys
import tempfile
import time


STARTS = 31
JOBS, ALONE = 1000, 100
SIZES = (4, 8, 16, 32, 64)


def surface(side):
    """A wavy square of side x side vertices: positions and unit normals, as flat lists of floats."""
    step = 10.0 / (side - 1)
    sine = [math.sin(2.1 * i * step) for i in range(side)]
    cosine = [math.cos(2.1 * i * step) for i in range(side)]
    positions, normals = array.array("f"), array.array("f")
    for j in range(side):
        y = j * step
        for i in range(side):
            positions.extend((i * step, y, sine[i] * cosine[j]))
            dx, dy = 2.1 * cosine[i] * cosine[j], -2.1 * sine[i] * sine[j]
            size = math.sqrt(dx * dx + dy * dy + 1)
            normals.extend((-dx / size, -dy / size, 1 / size))
    return positions, normals


def quads(side):
    for j in range(side - 1):
        for i in range(side - 1):
            a = j * side + i
            yield a, a + 1, a + side + 1, a + side


def tangents_of(normals):
    """Along x, with a handedness of 1."""
    tangents = array.array("f")
    for k in range(0, len(normals), 3):
        x, z = normals[k + 2], -normals[k]
        size = math.hypot(x, z)
        tangents.extend((x / size, 0, z / size, 1))
    return tangents


def write_glb(path, side, positions, normals, tangents=None):
    indices = array.array("I")
    for a, b, c, d in quads(side):
        indices.extend((a, b, c, a, c, d))
    count = side * side
    streams = [("POSITION", "VEC3", positions), ("NORMAL", "VEC3", normals)]
    if tangents:
        streams.append(("TANGENT", "VEC4", tangents))
    parts = [values.tobytes() for _, _, values in streams] + [indices.tobytes()]
    bounds = {"min": [min(positions[a::3]) for a in range(3)], "max": [max(positions[a::3]) for a in range(3)]}
    document = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {name: i for i, (name, _, _) in enumerate(streams)},
                                    "indices": len(streams)}]}],
        "accessors": [
            {"bufferView": i, "componentType": 5126, "count": count, "type": kind, **(bounds if i == 0 else {})}
            for i, (_, kind, _) in enumerate(streams)
        ] + [{"bufferView": len(streams), "componentType": 5125, "count": len(indices), "type": "SCALAR"}],
        "bufferViews": [
            {"buffer": 0, "byteOffset": sum(map(len, parts[:i])), "byteLength": len(part),
             "target": 34962 if i < len(streams) else 34963}
            for i, part in enumerate(parts)
        ],
        "buffers": [{"byteLength": sum(map(len, parts))}],
    }
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    size = 12 + 8 + len(text) + 8 + sum(map(len, parts))
    with open(path, "wb") as file:
        file.write(struct.pack("<4sII", b"glTF", 2, size))
        file.write(struct.pack("<I4s", len(text), b"JSON") + text)
        file.write(struct.pack("<I4s", sum(map(len, parts)), b"BIN\0"))
        for part in parts:
            file.write(part)


def write_glb_with_tangents(path, side, positions, normals):
    write_glb(path, side, positions, normals, tangents_of(normals))


def write_obj(path, side, positions, normals):
    with open(path, "w", encoding="ascii", buffering=1 << 22) as file:
        for k in range(0, 3 * side * side, 3):
            file.write("v %.6f %.6f %.6f\n" % (positions[k], positions[k + 1], positions[k + 2]))
        for j in range(side):
            for i in range(side):
                file.write("vt %.5f %.5f\n" % (i / (side - 1), j / (side - 1)))
        for k in range(0, 3 * side * side, 3):
            file.write("vn %.5f %.5f %.5f\n" % (normals[k], normals[k + 1], normals[k + 2]))
        for quad in quads(side):
            file.write("f %d/%d/%d %d/%d/%d %d/%d/%d %d/%d/%d\n" % tuple(k + 1 for k in quad for _ in range(3)))


def make(write, path, side):
    """In a process of its own: what this one has held would count in the peak of the programs that it starts."""
    child = os.fork()
    if child == 0:
        code = 1
        try:
            write(path, side, *surface(side))
            code = 0
        finally:
            os._exit(code)
    if os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) != 0:
        sys.exit(f"could not make {path}")


TWIST = [{"twist": {"axis": "z", "degrees": 20}}, {"at": [[2, 5], [2, 5], [4, 7]], "by": [0.3, 0.2, 0.5]}]


def write_lattices(folder):
    """8 x 8 x 8 cubic: a box (the rest map is affine) and a box with bent control points (inverted cell by cell)."""
    box = {"min": [-0.1, -0.1, -1.2], "max": [10.1, 10.1, 1.2]}
    common = {"format": "ffd-lattice", "version": 1, "size": [8, 8, 8], "moves": TWIST}
    points = []
    for k in range(8):
        for j in range(8):
            for i in range(8):
                x, y, z = (-0.6 + 11.2 * i / 7, -0.6 + 11.2 * j / 7, -1.5 + 3.0 * k / 7)
                points.append([x + 0.15 * math.sin(0.9 * y), y + 0.15 * math.sin(1.1 * x), z + 0.1 * math.sin(x + y)])
    lattices = {"box": dict(common, rest={"box": box}), "warped": dict(common, rest={"points": points})}
    paths = {}
    for name, lattice in lattices.items():
        paths[name] = os.path.join(folder, name + ".json")
        with open(paths[name], "w", encoding="ascii") as file:
            json.dump(lattice, file)
    return paths


def measure(command, output=None):
    """Seconds and peak bytes of one run. The output is removed before: to replace a file costs time of its own,
    which depends on the file system."""
    if output and os.path.exists(output):
        os.remove(output)
    start = time.perf_counter()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    with process.stderr:
        errors = process.stderr.read()
    _, status, usage = os.wait4(process.pid, 0)
    seconds = time.perf_counter() - start
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        sys.exit(f"exit {process.returncode}: {' '.join(command)}\n{errors.decode(errors='replace')}")
    return seconds, usage.ru_maxrss * 1024


def spread(values):
    return f"{statistics.median(values):7.3f}  ({min(values):.3f} to {max(values):.3f})"


def write_small(path):
    with open(path, "w", encoding="ascii") as file:
        file.writelines(f"v {i % 10} {i // 10} 0.5\n" for i in range(100))


def print_starts(ffd, folder, lattices):
    """What a process costs that has next to nothing to do."""
    source, target = os.path.join(folder, "small.obj"), os.path.join(folder, "small-out.obj")
    write_small(source)
    jobs = {"ffd --version": [ffd, "--version"],
            "100 vertices, box": [ffd, "deform", source, target, "-l", lattices["box"], "--quiet"],
            "100 vertices, warped": [ffd, "deform", source, target, "-l", lattices["warped"], "--quiet"]}
    for name, command in jobs.items():
        times = [1000 * measure(command, target)[0] for _ in range(STARTS)]
        print(f"{name:22} {spread(times)} ms")


def processor():
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as file:
            return next(line.split(":", 1)[1].strip() for line in file if line.startswith("model name"))
    except (OSError, StopIteration):
        return platform.processor() or "unknown processor"


def build_flags(ffd):
    """How the build folder round the program was configured, where there is one."""
    folder = os.path.dirname(os.path.abspath(ffd))
    while folder != os.path.dirname(folder):
        path = os.path.join(folder, "meson-info", "intro-buildoptions.json")
        if os.path.isfile(path):
            with open(path, encoding="utf-8") as file:
                options = {option["name"]: option["value"] for option in json.load(file)}
            with open(os.path.join(folder, "compile_commands.json"), encoding="utf-8") as file:
                words = next(entry["command"].split() for entry in json.load(file) if entry["file"].endswith(".c"))
            compiler = words[os.path.basename(words[0]) == "ccache"]
            said = subprocess.run([compiler, "--version"], capture_output=True, text=True, check=False).stdout
            compiler = said.splitlines()[0] if said else compiler
            return f"{compiler}; buildtype {options['buildtype']}, b_sanitize {options['b_sanitize']}"
        folder = os.path.dirname(folder)
    return "unknown build"


def box_lattice(size):
    box = {"min": [-0.1, -0.1, -1.2], "max": [10.1, 10.1, 1.2]}
    last = size - 1
    moves = [TWIST[0], {"at": [[1, last], [1, last], [last // 2, last]], "by": [0.3, 0.2, 0.5]}]
    return {"format": "ffd-lattice", "version": 1, "size": [size] * 3, "moves": moves, "rest": {"box": box}}


def medians(commands, runs, output):
    """The median seconds of each command, run in turn."""
    times = [[] for _ in commands]
    for _ in range(runs):
        for k, command in enumerate(commands):
            times[k].append(measure(command, output)[0])
    return [statistics.median(values) for values in times]


def print_sizes(bench, source, folder):
    """What the number of control points costs, box lattices of 4^3 to 64^3: the whole process, and a vertex, which is
    what it takes longer than with 100 vertices."""
    target, commands, starts = os.path.join(folder, "sized.glb"), [], []
    small, small_target = os.path.join(folder, "small.obj"), os.path.join(folder, "small-out.obj")
    write_small(small)
    for size in SIZES:
        path = os.path.join(folder, f"box{size}.json")
        with open(path, "w", encoding="ascii") as file:
            json.dump(box_lattice(size), file)
        commands.append(bench.command(source, target, path))
        starts.append(bench.command(small, small_target, path))
    whole, making = medians(commands, bench.runs, target), medians(starts, bench.runs, small_target)
    costs = [seconds - start for seconds, start in zip(whole, making)]
    shown = ", ".join(f"{size}^3 {seconds:.3f} s ({seconds / whole[0]:.2f}; a vertex {cost / costs[0]:.2f})"
                      for size, seconds, cost in zip(SIZES, whole, costs))
    print(f"GLB, box lattice by its size (ratio to {SIZES[0]}^3): {shown}", flush=True)
    for path in (target, small, small_target):
        os.remove(path)


def print_attributes(bench, folder, lattices):
    """What normals and tangents cost beside positions, whole process, one thread."""
    source, target = os.path.join(folder, "tangents.glb"), os.path.join(folder, "tangents-out.glb")
    make(write_glb_with_tangents, source, bench.side)
    for name, lattice in lattices.items():
        command = bench.command(source, target, lattice, 1)
        positions, all_three = medians([command + ["--normals", normals] for normals in ("keep", "transform")],
                                       bench.runs, target)
        print(f"GLB, {name}: positions {positions:.3f} s, with normals and tangents {all_three:.3f} s "
              f"({all_three / positions:.2f})", flush=True)
    os.remove(source)
    os.remove(target)


def print_threads(bench, folder, lattices):
    """What a second thread brings to four times as many vertices."""
    side = 2 * bench.side
    source, target = os.path.join(folder, "four.glb"), os.path.join(folder, "four-out.glb")
    make(write_glb, source, side)
    for name, lattice in lattices.items():
        one, two = medians([bench.command(source, target, lattice, threads) for threads in (1, 2)], bench.runs, target)
        print(f"GLB, {side * side / 1e6:.1f} M vertices, {name}: 1 thread {one:.3f} s, 2 threads {two:.3f} s, "
              f"{one / two:.2f} times as fast", flush=True)
    os.remove(source)
    os.remove(target)


def write_manifest(path, jobs):
    with open(path, "w", encoding="ascii") as file:
        for source, lattice, target in jobs:
            file.write(json.dumps({"in": source, "lattice": lattice, "out": target}) + "\n")


def print_batch(bench, folder, lattices):
    """Meshes of about 1,000 vertices a second: different ones; one, with a thousand outputs, which is read and embedded
    once; and by a command each."""
    meshes, out = os.path.join(folder, "meshes"), os.path.join(folder, "outputs")
    os.mkdir(meshes)
    for ending, write in (("obj", write_obj), ("glb", write_glb)):
        sources = [os.path.join(meshes, f"{k}.{ending}") for k in range(JOBS)]
        make(write, sources[0], 32)
        for source in sources[1:]:
            shutil.copyfile(sources[0], source)
        for name, lattice in lattices.items():
            rates = {}
            for kind, shared in (("meshes", False), ("outputs of one mesh", True)):
                manifest = os.path.join(folder, "jobs.jsonl")
                write_manifest(manifest, [(sources[0 if shared else k], lattice, os.path.join(out, f"{k}.{ending}"))
                                          for k in range(JOBS)])
                times = []
                for _ in range(bench.runs):
                    os.mkdir(out)
                    command = [bench.ffd, "batch", manifest, "--quiet", "--journal", os.path.join(folder, "journal")]
                    times.append(measure(command)[0])
                    shutil.rmtree(out)
                rates[kind] = JOBS / statistics.median(times)
            os.mkdir(out)
            start = time.perf_counter()
            for k in range(ALONE):
                subprocess.run(bench.command(sources[k], os.path.join(out, f"{k}.{ending}"), lattice), check=True)
            rates["commands"] = ALONE / (time.perf_counter() - start)
            shutil.rmtree(out)
            print(f"batch {ending} {name}: " + ", ".join(f"{rate:.0f} {kind}/s" for kind, rate in rates.items()),
                  flush=True)
    shutil.rmtree(meshes)
    print_sweep(bench, folder, lattices)


def print_sweep(bench, folder, lattices):
    """A mesh of 102,400 vertices with a hundred lattices of one rest volume: what sharing mesh and u,v,w brings."""
    source, out = os.path.join(folder, "sweep.glb"), os.path.join(folder, "outputs")
    make(write_glb, source, 320)
    for name, path in lattices.items():
        with open(path, encoding="utf-8") as file:
            lattice = json.load(file)
        swept, targets = [], []
        for k in range(ALONE):
            lattice["moves"] = lattice["moves"][:len(TWIST)] + [{"at": [1, 1, 1], "by": [0.001 * k, 0, 0]}]
            swept.append(os.path.join(folder, f"sweep-{k}.json"))
            targets.append(os.path.join(out, f"{k}.glb"))
            with open(swept[-1], "w", encoding="ascii") as file:
                json.dump(lattice, file)
        manifest = os.path.join(folder, "jobs.jsonl")
        write_manifest(manifest, [(source, swept[k], targets[k]) for k in range(ALONE)])
        os.mkdir(out)
        batch = measure([bench.ffd, "batch", manifest, "--quiet", "--journal", os.path.join(folder, "journal")])[0]
        shutil.rmtree(out)
        os.mkdir(out)
        alone = sum(measure(bench.command(source, targets[k], swept[k]))[0] for k in range(ALONE))
        shutil.rmtree(out)
        print(f"sweep {name}: {ALONE / batch:.0f} jobs/s that share mesh and u,v,w, {ALONE / alone:.0f} by a command each",
              flush=True)


def print_peers(bench, folder, lattice):
    """Others that are installed, with the same OBJ: reading and writing it without any deformation."""
    source, target = os.path.join(folder, "in.obj"), os.path.join(folder, "peer.obj")
    own, = medians([bench.command(source, target, lattice)], bench.runs, target)
    peers = {"assimp": ["assimp", "export", source, target]}
    for name, command in peers.items():
        if not shutil.which(command[0]):
            print(f"{name} is not installed")
            continue
        seconds, = medians([command], 1, target)
        print(f"OBJ, {name} reads and writes it: {seconds:.2f} s, ffd deforms it: {own:.2f} s ({seconds / own:.1f})")
    if os.path.exists(target):
        os.remove(target)


def print_scipy(bench):
    """SciPy's tensor B-spline on as many points as a lattice of 8^3 has to displace, one coordinate after another."""
    try:
        import numpy
        from scipy import ndimage
    except ImportError:
        print("SciPy is not installed")
        return
    draw = numpy.random.default_rng(7)
    points = 1000 * bench.side
    coefficients, places = draw.random((3, 8, 8, 8)), 7 * draw.random((3, points))
    times = []
    for _ in range(bench.runs):
        start = time.perf_counter()
        for axis in coefficients:
            ndimage.map_coordinates(axis, places, order=3, prefilter=False, mode="nearest")
        times.append(time.perf_counter() - start)
    print(f"SciPy (map_coordinates, cubic, 8^3): {points / statistics.median(times) / 1e6:.2f} M points/s")


def print_vtk(bench):
    """VTK's B-spline transform on as many points."""
    try:
        from vtkmodules.util.numpy_support import numpy_to_vtk
        from vtkmodules.vtkCommonCore import vtkPoints
        from vtkmodules.vtkCommonDataModel import vtkImageData
        from vtkmodules.vtkFiltersHybrid import vtkBSplineTransform
        import numpy
    except ImportError:
        print("VTK is not installed")
        return
    draw = numpy.random.default_rng(7)
    count = 1000 * bench.side
    image, source, target, transform = vtkImageData(), vtkPoints(), vtkPoints(), vtkBSplineTransform()
    image.SetDimensions(8, 8, 8)
    image.GetPointData().SetScalars(numpy_to_vtk(draw.random((512, 3)), deep=True))
    source.SetData(numpy_to_vtk(7 * draw.random((count, 3)), deep=True))
    transform.SetCoefficientData(image)
    times = []
    for _ in range(bench.runs):
        target.Reset()
        start = time.perf_counter()
        transform.TransformPoints(source, target)
        times.append(time.perf_counter() - start)
    print(f"VTK (vtkBSplineTransform, 8^3): {count / statistics.median(times) / 1e6:.2f} M points/s")


class Bench:
    def __init__(self, arguments):
        self.ffd, self.runs, self.side, self.threads = (arguments.ffd, arguments.runs, arguments.side,
                                                        arguments.threads)

    def command(self, source, target, lattice, threads=0):
        command = [self.ffd, "deform", source, target, "-l", lattice, "--quiet"]
        threads = threads or self.threads
        return command + (["--threads", str(threads)] if threads else [])


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--ffd", required=True)
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--side", type=int, default=1000, help="the mesh has side x side vertices")
    parser.add_argument("--threads", type=int, default=0, help="0: all cores")
    parser.add_argument("--folder", help="where the files are made (default: a temporary folder)")
    parser.add_argument("--only", choices=("glb", "obj"))
    parser.add_argument("--csv", metavar="FILE", help="one line for each run")
    arguments = parser.parse_args()

    print(f"{processor()}, {os.cpu_count()} cores, {platform.system()} {platform.release()}")
    print(f"{build_flags(arguments.ffd)}; threads: {arguments.threads or 'all'}; runs: {arguments.runs}", flush=True)

    bench = Bench(arguments)
    csv = ["file,lattice,run,ffd_seconds,copy_seconds,ffd_peak_bytes,file_bytes"]
    with tempfile.TemporaryDirectory(dir=arguments.folder) as folder:
        lattices = write_lattices(folder)
        print_starts(arguments.ffd, folder, lattices)
        print(f"{'file':5} {'MB':>6} {'lattice':8} {'ffd s: median (spread)':>28} {'copy s: median (spread)':>28}"
              f" {'ratio':>6} {'peak MB':>8} {'x file':>6}")
        for ending, write in (("glb", write_glb), ("obj", write_obj)):
            if arguments.only not in (None, ending):
                continue
            source = os.path.join(folder, "in." + ending)
            make(write, source, arguments.side)
            size = os.path.getsize(source)
            target = os.path.join(folder, "out." + ending)
            copy = os.path.join(folder, "copy." + ending)
            for name, lattice in lattices.items():
                command = bench.command(source, target, lattice)
                dd = ["dd", "if=" + source, "of=" + copy, "bs=64M"]
                measure(dd, copy)  # the file is in the page cache from here on
                times, copies, peaks = [], [], []
                for run in range(arguments.runs):
                    seconds, peak = measure(command, target)
                    times.append(seconds)
                    peaks.append(peak)
                    copies.append(measure(dd, copy)[0])
                    csv.append(f"{ending},{name},{run},{seconds:.6f},{copies[-1]:.6f},{peak},{size}")
                ratio = statistics.median(times) / statistics.median(copies)
                print(f"{ending:5} {size / 1e6:6.1f} {name:8} {spread(times):>28} {spread(copies):>28} {ratio:6.1f}"
                      f" {max(peaks) / 1e6:8.1f} {max(peaks) / size:6.2f}", flush=True)
            if ending == "glb":
                print_sizes(bench, source, folder)
            else:
                print_peers(bench, folder, lattices["box"])
            for path in (source, target, copy):
                os.remove(path)
        print_attributes(bench, folder, lattices)
        print_threads(bench, folder, lattices)
        print_batch(bench, folder, lattices)
        print_scipy(bench)
        print_vtk(bench)
    if arguments.csv:
        with open(arguments.csv, "w", encoding="ascii") as file:
            file.write("\n".join(csv) + "\n")


main()
