#!/usr/bin/env python3
"""Standard input and output: data in and out, closed streams, full devices, broken pipes."""
import base64
import json
import os
import re
import signal
import subprocess

from harness import (CUBE, CUBE_CORNERS, FFD, INVALID, IO, SECONDS, UNSUPPORTED, USAGE, case, check, equal, glb, gltf_json,
                     lattice, main)


def start(run):
    run.write("a.obj", CUBE)
    run.write("l.json", lattice(moves=[{"by": [1, 0, 0]}]))
    run.ffd("deform", "a.obj", "expected.obj", "-l", "l.json")
    return run.text("expected.obj")


@case
def obj_files_go_through_streams(run):
    expected = start(run)
    run.ffd("deform", "-", "-", "--input-format", "obj", "--output-format", "obj", "-l", "l.json", stdin=CUBE.encode(),
            out=expected)
    run.ffd("deform", "a.obj", "-", "--output-format=obj", "-l", "l.json", out=expected)
    run.ffd("deform", "-", "b.obj", "--input-format=obj", "-l", "l.json", stdin=CUBE.encode())
    equal(run.text("b.obj"), expected)
    run.ffd("deform", "/dev/stdin", "c.obj", "--input-format=obj", "-l", "l.json", stdin=CUBE.encode())
    equal(run.text("c.obj"), expected)


@case
def glb_files_go_through_streams(run):
    start(run)
    file = glb(*gltf_json(CUBE_CORNERS))
    run.write("a.glb", file)
    run.ffd("deform", "a.glb", "b.glb", "-l", "l.json")
    done = run.ffd("deform", "-", "-", "--input-format", "glb", "--output-format", "glb", "-l", "l.json", stdin=file)
    equal(done.out, run.read("b.glb"))


@case
def every_format_through(run):
    """In and out by pipes and by redirected files, under the names - and /dev/..., gives what files give."""
    start(run)
    run.write("a.glb", glb(*gltf_json(CUBE_CORNERS)))
    for ending in ("ply", "off", "stl"):
        run.ffd("deform", "a.obj", f"a.{ending}", "-l", "l.json", "-q")
    run.ffd("deform", "a.glb", "embedded.gltf", "-l", "l.json")
    asset = json.loads(run.read("embedded.gltf"))
    asset["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64.b64encode(run.read("embedded.bin")).decode()
    run.write("a.gltf", asset)
    for ending in ("obj", "glb", "gltf", "ply", "off", "stl"):
        name, formats = f"a.{ending}", ["--input-format", ending, "--output-format", ending, "-l", "l.json", "-q"]
        run.ffd("deform", name, f"expected.{ending}", "-l", "l.json", "-q", "--force")
        expected = run.read(f"expected.{ending}")
        check(expected != run.read(name), f"{name}: nothing has moved")
        for source, target in (("-", "-"), ("/dev/stdin", "/dev/stdout"), ("/dev/fd/0", "/proc/self/fd/1")):
            equal(run.ffd("deform", source, target, *formats, stdin=run.read(name)).out, expected, f"{ending} {source}")
            with open(run.path(name), "rb") as given, open(run.path("out"), "wb") as taken:
                taken.write(b"before ")
                taken.flush()
                subprocess.run([FFD, "deform", source, target, *formats], cwd=run.folder, stdin=given, stdout=taken, check=True,
                               timeout=SECONDS)
            equal(run.read("out"), b"before " + expected, f"{ending} {target}, a file")
    equal([name for name in run.names() if name.startswith(".")], [])


@case
def one_open_file_for_several_runs(run):
    """A file that is standard input counts as a whole, small or large, wherever it has been read to."""
    start(run)
    large = "# " + 300000 * "x" + "\n"
    for name, text in (("a.obj", CUBE), ("large.obj", CUBE + large)):
        run.write(name, text)
        with open(run.path(name), "rb") as given:
            given.read(10)
            for _ in range(2):
                done = subprocess.run([FFD, "compare", name, "-", "--input-format", "obj"], cwd=run.folder, stdin=given,
                                      timeout=SECONDS, check=False)
                equal(done.returncode, 0, name)


@case
def other_outputs_go_behind_what_a_stream_holds(run):
    """Reports, lattices and arrays to a stream that was led into a file go behind what is there, as text would."""
    start(run)
    for arguments in (["lattice", "new", "a.obj", "-o"], ["embed", "a.obj", "-l", "l.json", "-o"],
                      ["deform", "a.obj", "b.obj", "-l", "l.json", "--force", "--report-stable", "--report"],
                      ["deform", "a.obj", "b.obj", "-l", "l.json", "--force", "--depfile"]):
        expected = run.ffd(*arguments, "-").out
        check(len(expected) > 10, arguments[0])
        for name in ("-", "/dev/stdout", "/dev/fd/1"):
            with open(run.path("out"), "wb") as taken:
                taken.write(b"before ")
                taken.flush()
                run.ffd(*arguments, name, stdout=taken)
            equal(run.read("out"), b"before " + expected, name)
    run.ffd("deform", "a.obj", "/dev/fd/77", "--output-format", "obj", "-l", "l.json", code=IO,
            err="/dev/fd/77: cannot be written: Bad file descriptor")
    with open(run.path("third"), "wb") as third:
        run.ffd("deform", "a.obj", f"/dev/fd/{third.fileno()}", "--output-format", "obj", "-l", "l.json", pass_fds=[third.fileno()])
    equal(run.text("third"), run.text("expected.obj"))
    run.ffd("deform", "a.obj", "/dev/stdout", "-l", "l.json", code=USAGE,
            err="standard output needs --output-format obj, gltf, glb, vrm, ply, off, stl, vtk, su2, vtu, vtp, vts, msh or foam")
    run.ffd("deform", "a.obj", "-", "--output-format", "obj", "-l", "l.json", "--report", "/dev/stdout", code=USAGE)
    run.ffd("deform", "/dev/stdin", "b.obj", "--input-format", "obj", "-l", "-", code=USAGE)


@case
def a_pipe_of_two_runs(run):
    expected = start(run)
    run.write("back.json", lattice(low=(-9, -9, -9), high=(9, 9, 9), moves=[{"by": [-1, 0, 0]}]))
    formats = ["--input-format", "obj", "--output-format", "obj"]
    first = subprocess.Popen([FFD, "deform", "-", "-", *formats, "-l", "l.json"], cwd=run.folder, stdin=subprocess.PIPE,
                             stdout=subprocess.PIPE)
    second = subprocess.Popen([FFD, "deform", "-", "-", *formats, "-l", "back.json"], cwd=run.folder, stdin=first.stdout,
                              stdout=subprocess.PIPE)
    first.stdout.close()
    first.stdin.write(CUBE.encode())
    first.stdin.close()
    out = second.communicate(timeout=SECONDS)[0]
    equal([first.wait(timeout=SECONDS), second.returncode], [0, 0])
    check(expected != CUBE and out.decode() == CUBE, out)


@case
def formats_are_needed(run):
    start(run)
    run.ffd("deform", "-", "b.obj", "-l", "l.json", stdin=CUBE.encode(), code=USAGE,
            err="standard input needs --input-format obj, gltf, glb, vrm, ply, off, stl, vtk, su2, vtu, vtp, vts, msh or foam")
    run.ffd("deform", "a.obj", "-", "-l", "l.json", code=USAGE, err="standard output needs --output-format obj, gltf, glb, vrm, ply, off, stl, vtk, su2, vtu, vtp, vts, msh or foam")
    run.ffd("embed", "-", "-l", "l.json", "-o", "e.npy", stdin=CUBE.encode(), code=USAGE,
            err="standard input needs --input-format obj, gltf, glb, vrm, ply, off, stl, vtk, su2, vtu, vtp, vts, msh or foam")


@case
def formats_overrule_endings(run):
    expected = start(run)
    run.write("mesh.data", CUBE)
    run.ffd("deform", "mesh.data", "out.data", "--input-format", "obj", "--output-format", "obj", "-l", "l.json")
    equal(run.text("out.data"), expected)
    run.write("wrong.glb", CUBE)
    run.ffd("deform", "wrong.glb", "b.obj", "-l", "l.json", "--input-format", "OBJ")
    equal(run.text("b.obj"), expected)
    run.ffd("deform", "wrong.glb", "c.glb", "-l", "l.json", code=INVALID)


@case
def standard_input_is_read_once(run):
    start(run)
    formats = ["--input-format", "obj"]
    text = CUBE.encode()
    run.ffd("deform", "-", "b.obj", *formats, "-l", "-", stdin=text, code=USAGE)
    run.ffd("deform", "a.obj", "b.obj", "-l", "-", "-l", "-", stdin=text, code=USAGE)
    run.ffd("deform", "-", "--out-dir", ".", *formats, "-l", "l.json", stdin=text, code=USAGE)
    run.ffd("deform", "-", "--in-place", *formats, "-l", "l.json", stdin=text, code=USAGE)
    run.ffd("embed", "-", *formats, "-l", "-", "-o", "e.npy", stdin=text, code=USAGE)


@case
def the_lattice_from_standard_input(run):
    expected = start(run)
    run.ffd("deform", "a.obj", "b.obj", "-l", "-", stdin=run.read("l.json"))
    equal(run.text("b.obj"), expected)
    run.ffd("deform", "a.obj", "c.obj", "-l", "-", stdin=b"{", code=INVALID)


@case
def empty_and_broken_input(run):
    start(run)
    both = ["--output-format", "glb", "--input-format", "glb", "-l", "l.json"]
    done = run.ffd("deform", "-", "-", *both, code=INVALID)
    check(done.err[0].startswith("standard input: "), done.err[0])
    run.ffd("deform", "-", "-", *both, stdin=glb(*gltf_json(CUBE_CORNERS))[:-4], code=INVALID)
    done = run.ffd("deform", "-", "-", "--input-format", "obj", "--output-format", "obj", "-l", "l.json", stdin=b"\nv 1\n",
                   code=INVALID)
    check(done.err[0].startswith("standard input:2: "), done.err[0])


@case
def messages_name_standard_input(run):
    start(run)
    run.ffd("deform", "-", "b.obj", "--input-format", "obj", "-l", "l.json", stdin=b"v 9 9 9\n",
            err="standard input: 1 of 1 vertex is not inside: 1 outside (left where it is); the lattice lies from "
                "-2 -2 -2 to 2 2 2, the mesh from 9 9 9 to 9 9 9")
    run.ffd("deform", "-", "c.obj", "--input-format", "obj", "-l", "l.json", "-v", stdin=CUBE.encode(),
            err="standard input: 8 of 8 vertices moved, by 1 at most")


@case
def a_gltf_to_standard_output(run):
    """One stream holds no second file: data URIs go through, buffers of their own do not."""
    start(run)
    asset, data = gltf_json(CUBE_CORNERS, uri="a.bin")
    run.write("a.gltf", asset)
    run.write("a.bin", data)
    for name in ("-", "/dev/stdout"):
        run.ffd("deform", "a.gltf", name, "--output-format", "gltf", "-l", "l.json", code=(USAGE, IO, UNSUPPORTED))
    for name in ("-", "/dev/stdin"):
        run.ffd("deform", name, "b.gltf", "--input-format", "gltf", "-l", "l.json", stdin=run.read("a.gltf"), code=IO,
                err=re.compile("standard input has no folder"))
    equal(run.names(), ["a.bin", "a.gltf", "a.obj", "expected.obj", "l.json"])


@case
def a_full_standard_output_is_exit_3(run):
    start(run)
    for arguments in (["deform", "a.obj", "-", "--output-format", "obj", "-l", "l.json"],
                      ["info", "a.obj"], ["info", "a.obj", "--json"], ["embed", "a.obj", "-l", "l.json", "-o", "-"], ["lattice", "new", "a.obj", "-o", "-"], ["help"],
                      ["--version"], ["help", "deform"]):
        with open("/dev/full", "wb") as full:
            run.ffd(*arguments, stdout=full, code=IO, err="standard output: cannot be written: No space left on device")
    with open("/dev/full", "wb") as full:
        run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "--report", "-", stdout=full, code=IO)
        run.ffd("deform", "a.obj", "c.obj", "-l", "l.json", stdout=full)


def closed(*descriptors):
    def close():
        for descriptor in descriptors:
            os.close(descriptor)
    return close


@case
def nothing_lands_in_a_file_with_the_number_of_a_closed_stream(run):
    """No message and no data may land in a file that happened to get the number of a closed stream."""
    expected = start(run)
    run.write("l.json", lattice(moves=[{"by": [1, 0, 0]}]))
    run.write("out.obj", CUBE + "v 9 9 9\n")
    run.ffd("info", "a.obj", stdout=None, preexec_fn=closed(1), code=IO)
    run.ffd("deform", "a.obj", "-", "--output-format", "obj", "-l", "l.json", stdout=None, preexec_fn=closed(1), code=IO)
    for n, which in enumerate(((0,), (1,), (2,), (1, 2), (0, 1, 2))):
        options = {"stdin": None} if 0 in which else {}
        process = subprocess.run([FFD, "deform", "out.obj", f"{n}.obj", "-l", "l.json", "-v"], cwd=run.folder, timeout=SECONDS,
                                 check=False, preexec_fn=closed(*which), stderr=subprocess.PIPE, **options)
        equal(process.returncode, 0, str(which))
        equal(run.text(f"{n}.obj"), expected + "v 9 9 9\n", str(which))


@case
def closed_standard_input(run):
    start(run)
    process = subprocess.run([FFD, "deform", "-", "b.obj", "--input-format", "glb", "--output-format", "glb", "-l", "l.json"],
                             cwd=run.folder, timeout=SECONDS, check=False, preexec_fn=closed(0), stderr=subprocess.PIPE)
    check(process.returncode in (IO, INVALID) and process.stderr.count(b"\n") == 1, process)
    check(not run.exists("b.obj"), "an output")


def run_without_reader(run, arguments, ignored):
    """Exit code and stderr of a run whose reader has gone away before it begins: a short output fits into a pipe, and
    a run on a busy machine may end before its reader has had the time to go."""
    def prepare():
        signal.signal(signal.SIGPIPE, signal.SIG_IGN if ignored else signal.SIG_DFL)
    reader, writer = os.pipe()
    os.close(reader)
    done = subprocess.run([FFD, *arguments], cwd=run.folder, stdout=writer, stderr=subprocess.PIPE, check=False,
                          preexec_fn=prepare, restore_signals=False, timeout=SECONDS)
    os.close(writer)
    return done.returncode, done.stderr.decode()


@case
def a_reader_that_goes_away_ends_the_program_quietly(run):
    """A reader that goes away: a quiet end by the signal, or exit 3 with a message where it is ignored. Nothing is left."""
    run.write("a.obj", CUBE + "v 0.123 0.456 0.789\n" * 20000)
    run.write("l.json", lattice(moves=[{"by": [1e-3, 0, 0]}]))
    for ending in ("glb", "gltf", "ply", "off", "stl"):
        run.ffd("deform", "a.obj", f"a.{ending}", "-l", "l.json", "-q")
    jobs = [["deform", f"a.{ending}", out, "--output-format", ending, "-l", "l.json", "-q", "--report", f"{ending}.json"]
            for ending in ("obj", "glb", "ply", "off", "stl") for out in ("-", "/dev/stdout")]
    for arguments in (*jobs, ["embed", "a.obj", "-l", "l.json", "-o", "-"], ["info", "a.obj"], ["lattice", "new", "a.obj", "-o", "-"]):
        equal(run_without_reader(run, arguments, False), (-signal.SIGPIPE, ""), arguments)
        for name in run.names():
            if name.endswith("json") and name != "l.json":
                equal(json.loads(run.read(name))["jobs"], [], f"{name} of a run that was ended")
                run.remove(name)
        equal(run_without_reader(run, arguments, True), (IO, "ffd: standard output: cannot be written: Broken pipe\n"), arguments)
        run.check_no_leftovers()
        for name in run.names():
            if name.endswith(".json") and name != "l.json":
                run.remove(name)


@case
def input_in_small_pieces_is_read_to_its_end(run):
    """Input that arrives in small pieces is read to its end."""
    expected = start(run)
    child = subprocess.Popen([FFD, "deform", "-", "-", "--input-format", "obj", "--output-format", "obj", "-l", "l.json"],
                             cwd=run.folder, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
    for n in range(0, len(CUBE), 40):
        child.stdin.write(CUBE[n:n + 40].encode())
        child.stdin.flush()
    out = child.communicate(timeout=SECONDS)[0]
    equal(out.decode(), expected)


main()
