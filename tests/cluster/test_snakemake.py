#!/usr/bin/env python3
"""The Snakefile of data/: every mesh of a folder is deformed, and again those that have changed, no others."""
import base64
import functools
import json
import os
import shutil
import subprocess

from harness import CUBE, case, check, equal, gltf_json, lattice, main
from many import SOURCE, contents, environment, page_commands, page_folder, shell

ARGUMENTS = ["--snakefile", "../Snakefile", "--cores", "2", "--nocolor", "--config", "meshes=in", "lattice=l.json", "out=out"]
# Python needs a second to read Snakemake: it is read once, and each run of it is a copy of that process. Answers each
# line (folder, environment, arguments) with a line (status, what was said).
SERVER = """
import json, os, sys, tempfile
from snakemake import main
for line in sys.stdin:
    folder, environment, arguments = json.loads(line)
    with tempfile.TemporaryFile() as said:
        pid = os.fork()
        if pid == 0:
            os.chdir(folder)
            os.environ.clear()
            os.environ.update(environment)
            for number in (1, 2):
                os.dup2(said.fileno(), number)
            main(arguments)  # which exits
        status = os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1])
        said.seek(0)
        print(json.dumps([status, said.read().decode("utf-8", "replace")]), flush=True)
"""


def only_behind(said):
    """What is said of the data's meshes: that pivots of animations, joints and sockets are off the deformed mesh, and what turns wobbles."""
    check(all("off the deformed mesh" in line and line.endswith(": see --rig") or "will wobble" in line and line.endswith(": see --rigid")
              for line in said), said)


@case
def the_tutorial_s_commands(run):
    page_folder(run, "data")
    shell(run, "data", page_commands("snakemake"), environment(run))
    meshes = [name for name in run.names("data/models") if name.endswith((".obj", ".glb"))]
    equal([name for name in run.names("data/deformed") if name in meshes], meshes)
    check(len(meshes) > 4, "few meshes")
    for name in meshes:
        run.ffd("deform", f"data/models/{name}", name, "-l", "data/lattices/twist.json", err=only_behind)
        equal(run.read(f"data/deformed/{name}"), run.read(name), name)


def work(run):
    shutil.copy(os.path.join(SOURCE, "data/snakemake/Snakefile"), run.path("Snakefile"))
    asset, data = gltf_json([[0, 0, 0], [1, 0, 0], [0, 1, 0]], uri="a%20b.bin")
    for name, content in (("a.obj", CUBE), ("b c.obj", CUBE + "# spaces\n"), ("d.gltf", asset), ("a b.bin", data), ("note.txt", "")):
        run.write(f"w/in/{name}", content)
    run.write("w/l.json", lattice(moves=[{"by": [1, 0, 0]}]))


@functools.cache
def server():
    with open(shutil.which("snakemake"), encoding="utf-8") as file:
        interpreter = file.readline().removeprefix("#!").split()
    return subprocess.Popen([*interpreter, "-c", SERVER], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)


def snakemake(run, *more, code=0):
    """Runs Snakemake in the folder w."""
    request = [run.path("w"), environment(run), [*ARGUMENTS, *more]]
    server().stdin.write(json.dumps(request) + "\n")
    server().stdin.flush()
    found, said = json.loads(server().stdout.readline())
    check(found == code, f"snakemake ended with {found}: {said}")


def build(run):
    """Runs Snakemake; returns which outputs are new since the last time."""
    def stamps():
        return {name: os.stat(run.path(f"w/out/{name}")).st_mtime_ns for name in run.names("w/out")} if run.exists("w/out") else {}

    before = stamps()
    snakemake(run)
    return sorted(name for name, stamp in stamps().items() if before.get(name) != stamp)


# One pixel.
PICTURE = "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg=="
ALL = ["a.obj", "b c.obj", "d.bin", "d.gltf"]


@case
def only_what_has_changed_is_deformed_again(run):
    work(run)
    equal(build(run), ALL)
    whole = contents(run, "w/out")
    equal(build(run), [], "nothing has changed")
    run.write("w/in/b c.obj", CUBE + "v 0.5 0.5 0.5\n")
    equal(build(run), ["b c.obj"])
    _, data = gltf_json([[0, 0, 0.5], [1, 0, 0], [0, 1, 0]])
    run.write("w/in/a b.bin", data)
    equal(build(run), ["d.bin", "d.gltf"], "a buffer has changed")
    run.remove("w/out/a.obj")
    equal(build(run), ["a.obj"], "an output is missing")
    equal(run.read("w/out/a.obj"), whole["a.obj"])
    run.write("w/l.json", lattice(moves=[{"by": [0, 0, 0.5]}]))
    equal(build(run), ALL, "the lattice has changed")
    run.write("w/in/e.obj", CUBE)
    equal(build(run), ["e.obj"], "a new mesh")


@case
def what_a_mesh_brings_along_is_seen(run):
    """Two meshes have one texture, and one of them a material library: inputs, and outputs that others can ask for."""
    work(run)
    asset, data = gltf_json([[0, 0, 0], [1, 0, 0], [0, 1, 0]], uri="a%20b.bin")
    asset["images"] = [{"uri": "wood.png"}]
    run.write("w/in/d.gltf", asset)
    run.write("w/in/m.obj", "mtllib m.mtl\n" + CUBE)
    run.write("w/in/m.mtl", "newmtl a\nmap_Kd wood.png\n")
    picture = base64.b64decode(PICTURE)
    run.write("w/in/wood.png", picture)
    everything = sorted([*ALL, "m.mtl", "m.obj", "wood.png"])
    equal(build(run), everything)
    equal(build(run), [], "nothing has changed")
    run.write("w/in/wood.png", picture + b"x")
    equal(build(run), ["d.bin", "d.gltf", "m.obj", "wood.png"], "the texture has changed")
    equal(build(run), [], "nothing has changed again")
    equal(run.read("w/out/wood.png"), picture + b"x")
    run.remove("w/out/m.mtl")
    equal(build(run), ["m.mtl", "m.obj"], "a copy is missing")
    run.write("w/in/m.mtl", "newmtl a\nmap_Kd wood.png\nmap_Ks other.png\n")
    run.write("w/in/other.png", picture)
    equal(build(run), ["m.mtl", "m.obj", "other.png"], "a new texture")


@case
def a_failing_mesh_leaves_no_output(run):
    work(run)
    run.write("w/in/b c.obj", "v 1 2\n")
    snakemake(run, "--keep-going", code=1)
    equal(run.names("w/out"), [name for name in ALL if name != "b c.obj"])


main()
