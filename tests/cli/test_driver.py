#!/usr/bin/env python3
"""What the driver answers is what the program does: command lines of every command and exit code, both ways. But for
ffd batch, which the driver is not asked for: its workers are the program itself, by its file."""
import os
import signal
import subprocess

from driver import Driver
from harness import CUBE, CUBE_CORNERS, FFD, SECONDS, case, check, equal, glb, gltf_json, lattice, main, threaded_case

MESH = CUBE + "v 9 9 9\np 9\n"
# Command lines and their exit codes. Each runs in a folder of its own.
LINES = [
    (["--version"], 0), (["help"], 0), (["deform", "--help"], 0), ([], 2), (["deforn"], 2), (["--versio"], 2),
    (["deform", "a.obj", "b.obj", "-l", "l.json"], 0),
    (["deform", "a.obj", "b.obj", "-l", "l.json", "-v", "-j", "3", "--report", "-", "--report-stable"], 0),
    (["deform", "a.glb", "b.glb", "-l", "l.json"], 0), (["deform", "a.glb", "b.ply", "-l", "l.json"], 0),
    (["deform", "a.obj", "b.off", "-l", "l.json", "--report", "r.json", "--report-stable"], 0),
    (["deform", "a.obj", "b.obj", "-l", "l.json", "--fail-on", "outside"], 1),
    (["deform", "a.obj", "none.obj", "--out-dir", ".", "-l", "l.json"], 1), (["deform", "a.obj", "b.obj"], 2),
    (["deform", "none.obj", "b.obj", "-l", "l.json"], 3), (["deform", "a.obj", "broken.obj", "-l", "l.json"], 3),
    (["deform", "broken.obj", "b.obj", "-l", "l.json"], 4), (["deform", "a.obj", "b.obj", "-l", "l.json", "--outside", "error"], 5),
    (["deform", "needs.gltf", "b.gltf", "-l", "l.json"], 6), (["deform", "zeros.gltf", "b.gltf", "-l", "l.json"], 7),
    (["deform", "-", "-", "--input-format", "obj", "--output-format", "obj", "-l", "l.json"], 0),
    (["check", "a.obj", "-l", "l.json"], 0), (["check", "a.obj", "-l", "l.json", "--report", "r.json", "--report-stable"], 0),
    (["check", "a.obj"], 2), (["check", "none.obj", "-l", "l.json"], 3), (["check", "broken.obj", "-l", "l.json"], 4),
    (["check", "a.obj", "-l", "l.json", "--outside", "error"], 5), (["check", "needs.gltf", "-l", "l.json"], 6),
    (["check", "zeros.gltf", "-l", "l.json"], 7), (["check", "a.obj", "-l", "l.json", "--fail-on", "outside"], 1),
    (["embed", "a.obj", "-l", "l.json", "-o", "e.npy", "--status", "s.npy"], 0), (["embed", "a.obj", "-l", "l.json", "-o", "-"], 0),
    (["embed", "a.obj", "-o", "e.npy"], 2), (["embed", "a.obj", "-l", "none.json", "-o", "e.npy"], 3),
    (["embed", "a.obj", "-l", "broken.obj", "-o", "e.npy"], 4), (["embed", "zeros.gltf", "-l", "l.json", "-o", "e.npy"], 7),
    (["compare", "a.obj", "a.obj"], 0), (["compare", "a.obj", "a.glb", "--json"], 1), (["compare", "a.obj"], 2),
    (["compare", "a.obj", "none.obj"], 3), (["compare", "a.obj", "broken.obj"], 4),
    (["info", "a.obj"], 0), (["info", "l.json", "--json"], 0), (["info", "-", "--input-format", "obj"], 0), (["info"], 2),
    (["info", "none.obj"], 3), (["info", "broken.obj"], 4), (["info", "zeros.gltf"], 7),
    (["lattice", "new", "a.obj", "-o", "n.json"], 0), (["lattice", "new", "a.obj", "-o", "-"], 0), (["lattice", "new"], 2),
    (["lattice", "new", "none.obj", "-o", "n.json"], 3), (["lattice", "new", "broken.obj", "-o", "n.json"], 4),
    (["lattice", "new", "a.obj", "-o", "n.json", "--size", "1000000,1000000,1000000"], 7),
    (["report", "merge", "given.json", "given.json", "-o", "m.json"], 0), (["report", "merge", "given.json", "-o", "-"], 0),
    (["report", "merge"], 2), (["report", "merge", "none.json", "-o", "m.json"], 3), (["report", "merge", "a.obj", "-o", "m.json"], 4),
]
GIVEN = {"format": "ffd-report", "version": 1, "jobs": []}


def fill(run, folder):
    zeros = {"asset": {"version": "2.0"}, "accessors": [{"componentType": 5126, "count": 2**30, "type": "VEC3"}],
             "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}]}
    needs = {"asset": {"version": "2.0"}, "extensionsRequired": ["EXT_unknown"], "extensionsUsed": ["EXT_unknown"]}
    for name, content in (("a.obj", MESH), ("broken.obj", "v 1\n"), ("a.glb", glb(*gltf_json(CUBE_CORNERS))), ("zeros.gltf", zeros),
                          ("needs.gltf", needs), ("l.json", lattice(moves=[{"by": [1, 0, 0]}])), ("given.json", GIVEN)):
        run.write(f"{folder}/{name}", content)
    return run.path(folder)


def outcome(done, folder):
    files = {}
    for name in os.listdir(folder):
        with open(os.path.join(folder, name), "rb") as file:
            files[name] = os.stat(file.fileno()).st_mode, file.read()
    return done.returncode, done.stdout, done.stderr, files


@case
def every_command_and_exit_code(run):
    driver = Driver(os.environ["FFD_DRIVER"])
    reached = set()
    for i, (words, code) in enumerate(LINES):
        stdin = MESH.encode() if "-" in words[1:3] else b""
        folder = fill(run, f"program{i}")
        process = subprocess.run([FFD, *words], cwd=folder, input=stdin, capture_output=True, timeout=SECONDS, check=False)
        started = outcome(process, folder)
        folder = fill(run, f"driver{i}")
        forked = outcome(driver.run([FFD, *words], folder, stdin, SECONDS), folder)
        for what, a, b in zip(("exit code", "stdout", "stderr", "files"), started, forked):
            equal(b, a, f"{words}: {what}")
        equal(started[0], code, f"{words}: {started[2].decode()}")
        reached.add(code)
    equal(reached, set(range(8)), "exit codes")
    equal(driver.close(), 0, "the driver's own")


@threaded_case
def the_environment_the_umask_and_large_streams_go_along(run):
    """And a run leaves nothing to the next one."""
    driver = Driver(os.environ["FFD_DRIVER"])
    fill(run, "one")
    large = ("# " + 500000 * "x" + "\n" + MESH).encode()
    before = os.umask(0o077)
    try:
        for target in ("b.obj", "c.obj"):
            done = driver.run([FFD, "deform", "-", "-", "--input-format", "obj", "--output-format", "obj", "-l", "l.json", "-q",
                               "--report", target + ".json"], run.path("one"), large, SECONDS)
            equal(done.returncode, 0, done.stderr.decode())
            check(done.stdout.startswith(large[:500000]) and done.stdout != large, "a large stream")
            equal(os.stat(run.path(f"one/{target}.json")).st_mode & 0o777, 0o600, "the umask")
            os.umask(0o077)
    finally:
        os.umask(before)
    equal(driver.close(), 0)


@case
def an_end_by_a_signal(run):
    driver = Driver(os.environ["FFD_DRIVER"])
    run.write("a.obj", CUBE)
    reading, writing = os.pipe()
    os.close(reading)
    driver.start([FFD, "info", "a.obj"], run.folder, [driver.nothing, writing, 2])
    equal(driver.ended(), -signal.SIGPIPE)
    os.close(writing)
    equal(driver.run([FFD, "--version"], run.folder, b"", SECONDS).returncode, 0, "a run after it")
    equal(driver.close(), 0)


@case
def a_run_that_does_not_end(run):
    """Is given up after its time, and ended with the driver."""
    driver = Driver(os.environ["FFD_DRIVER"])
    run.write("a.obj", "".join(f"v {i % 97} {i % 89} {i % 83}\n" for i in range(500000)))
    try:
        driver.run([FFD, "info", "a.obj"], run.folder, b"", 0.001)
    except subprocess.TimeoutExpired:
        equal(driver.process.returncode, -signal.SIGKILL, "the driver")
        return
    raise AssertionError("no run takes so long")


main()
