"""Runs the program like a user, and makes the checks that apply to every run.

A test file registers functions with @case; each gets a Run with its own temporary folder. The environment variable
FFD is the path of the program. Every run must end in time, print only lines "ffd: ..." on stderr (a single one if it
fails), and leave no temporary file.

Most runs are forked from a process that has loaded the program (driver.py, FFD_DRIVER). A new process is started for
the first run of each command with each exit code in a test file, for ffd batch (its workers are processes of the
program), and for a run with options such as an environment, a limit or descriptors."""

import glob
import itertools
import json
import math
import os
import pty
import random
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import time
import traceback

from driver import Driver

FFD = os.path.abspath(os.environ["FFD"])
# The folder of the modules beside an installed program.
MODULE_FOLDER = "ffd-" + ".".join(subprocess.run([FFD, "--version"], capture_output=True, text=True,
                                                 check=True).stdout.split()[1].split(".")[:2])
MODELS = os.environ.get("FFD_MODELS")
SECONDS = 120
# Lines about glTF data that the output stores differently from the input. They are not counted in checks of stderr.
ANNOUNCED = re.compile("deformed differently under other nodes$|(is|are) stored as floats|(is|are) written uncompressed")
NOBODY = 65534
LEFTOVER = re.compile(r"\.ffd-(tmp|old|set)$")


def announce(pattern):
    """Excludes further lines of stderr from checks, by a pattern: another test file covers them."""
    global ANNOUNCED
    ANNOUNCED = re.compile(f"{ANNOUNCED.pattern}|{pattern}")


OK, NO, USAGE, IO, INVALID, EMBEDDING, UNSUPPORTED, LIMIT = range(8)

# Fills new memory with a random byte in the program. Meson sets MALLOC_PERTURB_ for all processes of a test, but in this
# one it would take more time than everything else.
os.environ["MALLOC_PERTURB_"] = os.environ.get("FFD_PERTURB") or str(random.randrange(1, 256))

# A bar is for a terminal that can show one: what the machine's own terminal can do must decide nothing.
os.environ["TERM"] = "xterm"
os.environ.pop("NO_COLOR", None)

with open(FFD, "rb") as _program:
    _sanitizer = re.search(b"__[at]san_init", _program.read())
    SANITIZED, _sees_races = _sanitizer is not None, _sanitizer is not None and _sanitizer[0] == b"__tsan_init"

# Notes and journals of the program go to a folder of the test, not to the user's.
_cache = tempfile.TemporaryDirectory(prefix="ffd-cache-")
os.environ["XDG_CACHE_HOME"] = _cache.name

_cases = []
_threaded = []
_driver = Driver(os.environ["FFD_DRIVER"]) if os.environ.get("FFD_DRIVER") else None
_seen = set()  # (command, .., exit code) of the runs so far


def case(function):
    _cases.append(function)
    return function


def threaded_case(function):
    """One whose meshes are large enough for several threads. The thread sanitizer finds nothing in the others, and runs these only
    (where a file has any)."""
    _threaded.append(function)
    return case(function)


def repetitions(count):
    """How many of `count` repetitions to make. Sanitizers are up to twenty times as slow, and find no further errors in the
    same code with other numbers."""
    return (count + 9) // 10 if SANITIZED else count


def check(condition, *shown):
    if not condition:
        raise AssertionError(" ".join(repr(x) if not isinstance(x, str) else x for x in shown))


def equal(found, expected, what=""):
    if not found == expected:  # format the message only on failure: values may have megabytes
        check(False, f"{what}: found {found!r}, expected {expected!r}")


def near(found, expected, tolerance, what=""):
    check(len(found) == len(expected), f"{what}: {len(found)} instead of {len(expected)} values")
    for i, (a, b) in enumerate(zip(found, expected)):
        if isinstance(a, (list, tuple)):
            near(a, b, tolerance, f"{what}[{i}]")
        elif not abs(a - b) <= tolerance:
            check(False, f"{what}[{i}]: {a!r} and {b!r} differ by more than {tolerance}")


def wait_until(condition, what):
    limit = time.monotonic() + SECONDS
    while not condition():
        check(time.monotonic() < limit, what)
        time.sleep(0.001)


class Done:
    """The result of a run: exit code, stdout (bytes), stderr (lines; those that match ANNOUNCED separately)."""

    def __init__(self, code, out, err, announced):
        self.code, self.out, self.err, self.announced = code, out, err, announced

    @property
    def text(self):
        return self.out.decode("utf-8")

    @property
    def json(self):
        return json.loads(self.out)


class Run:
    def __init__(self, folder):
        self.folder = folder

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, content):
        os.makedirs(os.path.dirname(self.path(name)), exist_ok=True)
        if isinstance(content, (dict, list)):
            content = json.dumps(content)
        with open(self.path(name), "wb") as file:
            file.write(content.encode("utf-8") if isinstance(content, str) else content)
        return name

    def read(self, name):
        with open(self.path(name), "rb") as file:
            return file.read()

    def text(self, name):
        return self.read(name).decode("utf-8")

    def exists(self, name):
        return os.path.lexists(self.path(name))

    def names(self, folder=""):
        return sorted(os.listdir(self.path(folder)))

    def remove(self, name):
        """Removes a file if it exists."""
        if self.exists(name):
            os.unlink(self.path(name))

    def folder_of(self, name):
        os.makedirs(self.path(name))
        return name

    def ffd(self, *arguments, code=OK, err=None, out=None, data=False, stdin=b"", lines=None, **options):
        """Runs ffd in the folder, and returns a Done.

        code: the expected exit code, or a tuple of allowed ones
        err: the expected lines of stderr without "ffd: ": a list; a string or compiled pattern for a single line; or a
          function that checks the list
        lines: the expected number of lines, if err is None; default: one for a failure, else none
        out: the expected text of stdout; data: a failure may print to stdout
        options: passed to subprocess.run
        Lines that match ANNOUNCED are not counted.
        """
        reports = self.reports(arguments)
        done = self.done(arguments, code, stdin, options)
        shown = "ffd " + " ".join(arguments)
        told = (done.stderr or b"").decode("utf-8", "backslashreplace")
        allowed = code if isinstance(code, tuple) else (code,)
        check(done.returncode in allowed, f"{shown}: exit {done.returncode}, expected {code}; {told}")
        code = done.returncode
        check(told == "" or told.endswith("\n"), f"{shown}: the last line of stderr has no end: {told!r}")
        said = told.split("\n")[:-1]
        for line in said:
            check(line.startswith("ffd: ") and line.isprintable(), f"{shown}: not a message: {line!r}")
        said = [line[len("ffd: "):] for line in said]
        announced = [line for line in said if ANNOUNCED.search(line)]
        said = [line for line in said if line not in announced]
        if isinstance(err, str):
            equal(said, [err], shown)
        elif isinstance(err, list):
            equal(said, err, shown)
        elif callable(err):
            err(said)
        elif err is not None:
            check(len(said) == 1 and err.search(said[0]), f"{shown}: said {said}, expected {err.pattern}")
        elif options.get("stderr", subprocess.PIPE) == subprocess.PIPE:
            expected = lines if lines is not None else 0 if code in (OK, NO) else 1
            check(len(said) == expected, f"{shown}: said {said}, expected {expected} lines")
        if out is not None:
            equal((done.stdout or b"").decode("utf-8"), out, shown)
        elif code > NO and not data and done.stdout is not None:
            equal(done.stdout, b"", f"{shown}: stdout of a failure")
        self.check_no_leftovers()
        self.check_reports(arguments, reports, done.stdout)
        return Done(done.returncode, done.stdout or b"", said, announced)

    def done(self, arguments, code, stdin, options):
        """Runs ffd to its end, in a new process or in a forked one."""
        head = arguments[:2 if arguments[:1] in (("lattice",), ("report",)) else 1]
        # Batches are not forked. Each set of options counts as another command.
        modes = sorted({a for a in arguments if a.startswith("--")}) if head == ("batch",) else []
        kind = (*head, *modes, code)
        is_first = kind not in _seen
        forked = _driver and not options and not is_first and arguments[:1] != ("batch",)
        _seen.add(kind)
        done = _driver.run([FFD, *arguments], self.folder, stdin, SECONDS) if forked else None
        if done:
            return done
        options = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, **options}
        program = options.pop("program", FFD)
        if not is_first:  # these checks take most of the time, so make them once for each kind
            options.setdefault("env", {**os.environ, "MALLOC_PERTURB_": "0",
                                       "ASAN_OPTIONS": os.environ.get("ASAN_OPTIONS", "") + ":detect_leaks=0"})
        return subprocess.run([program, *arguments], cwd=self.folder, input=stdin, timeout=SECONDS, check=False, **options)

    def check_no_leftovers(self):
        for folder, _, names in os.walk(self.folder):
            for name in names:
                check(not LEFTOVER.search(name), f"{os.path.join(folder, name)} was left")

    def reports(self, arguments):
        """The names of reports in the arguments (also "-"), each with the inode of an existing file or None."""
        names = [b if a == "--report" else a.partition("=")[2] for a, b in zip(arguments, (*arguments[1:], ""))
                 if a.partition("=")[0] == "--report"]
        return {name: os.stat(self.path(name)).st_ino if os.path.isfile(self.path(name)) else None for name in names}

    def check_reports(self, arguments, before, out):
        """Checks every report that the run has written against the published schema. Not with a sanitizer: the report is the
        same as in other builds, and checking takes longer than the run."""
        if SANITIZED:
            return
        for name, file in self.reports(arguments).items():
            content = out if name == "-" else self.read(name) if file != before[name] else None
            if content and content.lstrip().startswith(b"{"):
                from report_schema import faults  # imported late: many tests write no report
                if name.endswith(".jsonl"):  # wrapped as a report: the entries are the same
                    content = b'{"format": "ffd-report", "version": 1, "jobs": [' + content.strip().replace(b"\n", b",") + b"]}"
                equal(faults(content), [], f"ffd {' '.join(arguments)}: its report against the schema")

    def unprivileged(self):
        """Options for running ffd as another user than root; None if that is not possible. Makes the folder accessible to
        all users."""
        program = self.path("ffd-for-all/ffd")
        if not os.path.exists(program):
            copy_program(self.path("ffd-for-all"))
            os.chmod(self.folder, 0o755)
        if os.geteuid() != 0:
            return {"program": program}
        options = {"program": program, "user": NOBODY, "group": NOBODY, "extra_groups": []}
        try:
            subprocess.run([program, "--version"], user=NOBODY, group=NOBODY, extra_groups=[], check=True,
                           capture_output=True, timeout=SECONDS)
        except (OSError, subprocess.SubprocessError):
            return None
        return options


def on_terminal(run, *arguments, environment=None):
    """What ffd writes to a terminal."""
    process, terminal = pty.fork()
    if process == 0:
        os.chdir(run.folder)
        os.execve(FFD, [FFD, *arguments], {**os.environ, **(environment or {})})
    shown = b""
    try:
        while block := os.read(terminal, 65536):
            shown += block
    except OSError:
        pass  # the terminal's end
    equal(os.waitstatus_to_exitcode(os.waitpid(process, 0)[1]), OK, shown.decode())
    os.close(terminal)
    return shown.decode()


def modules():
    """The modules that the program loads on demand, in the build folder."""
    return sorted(glob.glob(os.path.join(os.path.dirname(os.path.dirname(FFD)), "ffd-*.so")))


def copy_program(folder):
    """Copies the program to a new folder, and its modules as they are installed beside a library. Returns the program's path."""
    os.makedirs(os.path.join(folder, MODULE_FOLDER))
    for path in [FFD, *modules()]:
        target = os.path.join(folder, "" if path == FFD else MODULE_FOLDER, os.path.basename(path))
        shutil.copy(path, target)
        os.chmod(target, 0o755)
    return os.path.join(folder, "ffd")


def float32(x):
    """The number of single precision that is nearest to x."""
    return struct.unpack("<f", struct.pack("<f", x))[0]


def lattice(size=(4, 4, 4), low=(-2, -2, -2), high=(2, 2, 2), moves=(), **members):
    content = {"format": "ffd-lattice", "version": 1, "size": list(size),
               "rest": {"box": {"min": list(low), "max": list(high)}}, "moves": list(moves)}
    content.update(members)
    return content


CUBE_CORNERS = [[float(x), float(y), float(z)] for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)]
CUBE_FACES = [[1, 3, 4, 2], [5, 6, 8, 7], [1, 2, 6, 5], [3, 7, 8, 4], [1, 5, 7, 3], [2, 4, 8, 6]]
CUBE = ("# a cube\n" + "".join("v %g %g %g\n" % tuple(p) for p in CUBE_CORNERS)
        + "".join("f %d %d %d %d\n" % tuple(f) for f in CUBE_FACES))


def obj_vertices(text):
    return [[float(x) for x in line.split()[1:4]] for line in text.splitlines() if line.startswith("v ")]


def obj_of(points):
    """An OBJ file of vertices alone, in double precision."""
    return "".join("v %r %r %r\n" % tuple(p) for p in points)


def carried(run, points, lattice_name, **options):
    """The points deformed by a lattice file, in double precision (through an OBJ file)."""
    run.write("carried-in.obj", obj_of(points))
    run.ffd("deform", "carried-in.obj", "carried-out.obj", "-l", lattice_name, "--force", **options)
    return obj_vertices(run.text("carried-out.obj"))


def models(ending):
    """The sample models whose names have this ending: (name, path, bytes)."""
    found = []
    for folder, _, names in sorted(os.walk(MODELS or "")):
        for name in sorted(names):
            if name.endswith(ending):
                path = os.path.join(folder, name)
                with open(path, "rb") as file:
                    found.append((os.path.relpath(path, MODELS), path, file.read()))
    return found


def npy(data):
    """Parses a .npy file, version 1.0, C order. Returns (dtype text, shape, list of rows or of values)."""
    equal(data[:8], b"\x93NUMPY\x01\x00", "the magic and version of the .npy")
    length = struct.unpack_from("<H", data, 8)[0]
    equal((10 + length) % 64, 0, "the alignment of the .npy header")
    header = data[10:10 + length].decode("latin-1")
    check(header.endswith("\n"), "the .npy header has no end")
    match = re.fullmatch(r"\{'descr': '([<>|][fu]\d)', 'fortran_order': False, 'shape': \(([\d, ]*)\), \} *\n",
                         header)
    check(match, "the .npy header is", header)
    descr, shape = match.group(1), tuple(int(n) for n in match.group(2).replace(" ", "").split(",") if n)
    code, size = {"<f8": ("<d", 8), "<f4": ("<f", 4), "|u1": ("<B", 1)}[descr]
    count = math.prod(shape)
    check(len(data) >= 10 + length + size * count, "the .npy is too short")
    values = [x[0] for x in struct.iter_unpack(code, data[10 + length:10 + length + size * count])]
    if len(shape) == 2:
        values = [values[i:i + shape[1]] for i in range(0, count, shape[1])]
    return descr, shape, values


# The signature of an image: files without one are not copied.
PNG = b"\x89PNG\r\n\x1a\n"


def pad(data, filler):
    return data + filler * (-len(data) % 4)


def gltf_json(positions, nodes=None, uri=None, normals=None):
    """Makes a glTF asset of points, or of triangles if normals are given. Returns it with the bytes of its single buffer."""
    data, views, accessors = b"", [], []
    for stream in [positions] + ([normals] if normals else []):
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": 12 * len(stream)})
        floats = struct.pack(f"<{3 * len(stream)}f", *itertools.chain.from_iterable(stream))
        accessor = {"bufferView": len(views) - 1, "componentType": 5126, "count": len(stream), "type": "VEC3"}
        if not data:
            accessor["min"], accessor["max"] = ([edge(axis) for axis in zip(*struct.iter_unpack("<3f", floats))]
                                                for edge in (min, max))
        data += floats
        accessors.append(accessor)
    attributes = {"POSITION": 0, **({"NORMAL": 1} if normals else {})}
    buffer = {"byteLength": len(data), **({"uri": uri} if uri else {})}
    asset = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(len(nodes or [0])))}],
             "nodes": nodes or [{"mesh": 0}],
             "meshes": [{"primitives": [{"attributes": attributes, "mode": 4 if normals else 0}]}],
             "buffers": [buffer], "bufferViews": views, "accessors": accessors}
    return asset, data


def glb(asset, data):
    text = pad(json.dumps(asset).encode("utf-8"), b" ")
    data = pad(data, b"\0")
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(data), 0x004E4942) + data
    return struct.pack("<III", 0x46546C67, 2, 12 + len(chunks)) + chunks


def glb_split(file):
    """Returns the asset and the binary chunk of a GLB."""
    magic, version, length = struct.unpack_from("<III", file)
    equal((magic, version, length), (0x46546C67, 2, len(file)), "the GLB's header")
    size, kind = struct.unpack_from("<II", file, 12)
    equal(kind, 0x4E4F534A, "the first chunk's kind")
    return json.loads(file[20:20 + size]), file[28 + size:]


def gltf_vectors(asset, data, index):
    """Returns the VEC3 elements of a float accessor in the single buffer."""
    accessor = asset["accessors"][index]
    view = asset["bufferViews"][accessor["bufferView"]]
    start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
    stride = view.get("byteStride", 12)
    if stride == 12:
        return [list(v) for v in struct.iter_unpack("<3f", data[start:start + 12 * accessor["count"]])]
    return [list(struct.unpack_from("<3f", data, start + stride * i)) for i in range(accessor["count"])]


def glb_positions(file):
    asset, data = glb_split(file)
    return [gltf_vectors(asset, data, primitive["attributes"]["POSITION"])
            for mesh in asset["meshes"] for primitive in mesh["primitives"]]


def main():
    failed = 0
    only = sys.argv[1:]
    cases = _threaded if _sees_races and _threaded else _cases
    chosen = [function for function in cases if not only or function.__name__ in only]
    for function in chosen:
        with tempfile.TemporaryDirectory(prefix="ffd-test-") as folder:
            try:
                function(Run(os.path.realpath(folder)))
            except Exception:  # one failing case must not hide the others
                failed += 1
                print(f"FAILED: {function.__name__}: {(function.__doc__ or '').strip()}")
                traceback.print_exc(limit=-2, file=sys.stdout)
    if _driver and _driver.close() != 0:
        failed += 1
        print("FAILED: the driver")
    print(f"{len(chosen)} cases, {failed} failed (FFD_PERTURB={os.environ['MALLOC_PERTURB_']})")
    sys.exit(1 if failed or not chosen else 0)
