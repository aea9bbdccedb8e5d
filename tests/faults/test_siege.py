#!/usr/bin/env python3
"""Races and hostile surroundings that once cost users their files (siege-*): what stands under a name when a run ends is
whole, and what is not the run's own is as it was. The inputs are made here. Others are in tests/cli: siege-02, a run that is
killed at any call, and siege3-07, file systems without locks, in test_file_sets.py; siege3-06, textures beyond the memory, in
test_memory.py; siege3-09, jobs that read what others write, and siege3-05 in a batch in test_batch_reads.py.

    FFD=... PYTHONPATH=tests/cli python3 tests/faults/test_siege.py siege_05_a_file_that_appears_under_the_name_of_the_output_stays
"""

import json
import math
import os
import socket
import subprocess
import time

from harness import CUBE, CUBE_CORNERS, FFD, INVALID, IO, NO, NOBODY, PNG, SECONDS, USAGE, case, check, equal, gltf_json, lattice, main

TWIST = lattice(low=(-1, -1, -1), high=(2, 2, 2), moves=[{"twist": {"axis": "z", "degrees": 40}}])


def grid(n):
    """A wavy sheet of n x n vertices."""
    points = "".join(f"v {i / n:.6g} {j / n:.6g} {math.sin(i * j % 7) / 70:.6g}\n" for j in range(n) for i in range(n))
    return points + "".join(f"f {k + 1} {k + 2} {k + n + 2} {k + n + 1}\n" for k in range(n * n - n) if k % n < n - 1)


def start(run, *arguments, **options):
    return subprocess.Popen([FFD, *arguments], cwd=run.folder, stderr=subprocess.PIPE, **options)


def ended(child):
    told = child.communicate(timeout=SECONDS)[1].decode()
    return child.returncode, told


@case
def siege_01_a_buffer_that_cannot_be_renamed_leaves_all_as_it_was(run):
    """A buffer that this user must not rename, in a folder with the sticky bit: nothing is replaced."""
    user = run.unprivileged()
    if os.geteuid() != 0 or not user:
        return  # only root can lay out files of three users
    asset, data = gltf_json(CUBE_CORNERS, uri="a.bin")
    asset["buffers"].append({**asset["buffers"][0], "uri": "a-1.bin"})
    asset["bufferViews"].append({**asset["bufferViews"][0], "buffer": 1})
    asset["accessors"].append({**asset["accessors"][0], "bufferView": 1})
    asset["meshes"][0]["primitives"].append({"attributes": {"POSITION": 1}, "mode": 0})
    run.folder_of("st")
    os.chmod(run.path("st"), 0o1777)
    for name, content, owner in (("a.gltf", asset, NOBODY), ("a.bin", data, NOBODY), ("a-1.bin", data, 1002)):
        run.write("st/" + name, content)
        os.chown(run.path("st/" + name), owner, owner)
    run.write("l.json", TWIST)
    before = {name: run.read("st/" + name) for name in run.names("st")}
    run.ffd("deform", "st/a.gltf", "--in-place", "-l", "l.json", code=IO,
            err="st/a-1.bin: cannot be replaced: it belongs to another user, in a folder with the sticky bit", **user)
    run.write("st/r.json", '{"format": "ffd-report"}')
    os.chown(run.path("st/r.json"), 1002, 1002)
    os.chmod(run.path("st/r.json"), 0o666)
    run.write("a.obj", CUBE)
    run.ffd("deform", "a.obj", "st/b.obj", "-l", "l.json", "--report", "st/r.json", code=IO,
            err="st/r.json: cannot be replaced: it belongs to another user, in a folder with the sticky bit", **user)
    run.remove("st/r.json")
    equal({name: run.read("st/" + name) for name in run.names("st")}, before)


@case
def siege_03_an_input_cut_at_any_moment_leaves_nothing(run):
    """The input becomes shorter at any moment: one line, exit 3, and nothing is left; or it was read before that."""
    run.write("l.json", TWIST)
    run.write("big.obj", grid(150))
    begun = time.monotonic()
    run.ffd("deform", "big.obj", "expected.obj", "-l", "l.json", "--normals", "keep")
    whole = time.monotonic() - begun
    cut = 0
    for n in range(10):
        run.write("x.obj", run.read("big.obj"))
        child = start(run, "deform", "x.obj", "y.obj", "-l", "l.json", "--normals", "keep")
        time.sleep(whole * n / 8)
        os.truncate(run.path("x.obj"), 1000)
        code, told = ended(child)
        if code == 0:  # it was read whole, or when it was cut already
            check(run.exists("y.obj"), told)
            run.remove("y.obj")
            continue
        # It may have had 1,000 bytes from the start: the last line is cut, or faces are missing.
        check(code in (IO, INVALID) and told.count("\n") == 1, code, told)
        cut += told == "ffd: x.obj: became shorter while it was read\n"
        equal(run.names(), ["big.obj", "expected.obj", "l.json", "x.obj"])
    check(cut > 0, "no run was under way when its input became shorter")


@case
def siege_04_a_journal_touches_nothing_beside_it(run):
    """A journal grows without touching what stands beside it."""
    run.write("a.obj", CUBE)
    run.write("l.json", TWIST)
    run.folder_of("o")
    run.write("jobs.jsonl", "".join(json.dumps({"in": "a.obj", "lattice": "l.json", "out": f"o/{i}.obj"}) + "\n" for i in range(520)))
    run.write("J.new", "precious")
    run.write("victim", "precious")
    os.symlink("victim", run.path("K.new"))
    for name in "JK":
        run.ffd("batch", "jobs.jsonl", "--journal", name, "-q", "--force", err=lambda said: None)
        check(os.stat(run.path(name)).st_size > 1024 * 64, "the journal did not grow")
    equal([run.text("J.new"), run.text("victim"), os.readlink(run.path("K.new"))], ["precious", "precious", "victim"])


@case
def siege_05_a_file_that_appears_under_the_name_of_the_output_stays(run):
    """A file that appears under the output's name while the run goes on stays."""
    run.write("l.json", TWIST)
    run.write("big.obj", grid(100))
    for _ in range(50):
        run.remove("race.obj")
        child = start(run, "deform", "big.obj", "race.obj", "-l", "l.json")
        while not run.exists(".race.obj.ffd-tmp") and child.poll() is None:
            time.sleep(0.0005)
        try:
            with open(run.path("race.obj"), "x", encoding="utf-8") as file:
                file.write("precious")
        except FileExistsError:
            equal(ended(child), (0, ""))
            continue
        equal(ended(child), (IO, "ffd: race.obj: exists already (--force overwrites it)\n"))
        equal(run.text("race.obj"), "precious")
        return run.check_no_leftovers()
    check(False, "the file never appeared in time")


def what_is_read(run):
    """A glTF with a buffer and an image, one whose buffer has the name of an array, an OBJ with a material library and a map, a lattice round both; a PLY with a texture."""
    asset, data = gltf_json(CUBE_CORNERS, uri="m.bin")
    asset["images"] = [{"uri": "m.png"}]
    asset["extensions"] = {"EXT_structural_metadata": {"schemaUri": "m.schema"}, "KHR_audio_emitter": {"audio": [{"uri": "m.mp3"}]}}
    run.write("m.schema", "{}")
    run.write("m.mp3", "ID3")
    run.write("m.gltf", asset)
    run.write("m.bin", data)
    run.write("n.gltf", gltf_json(CUBE_CORNERS, uri="n.npy")[0])
    run.write("n.npy", data)
    run.write("m.png", PNG)
    run.write("k.obj", "mtllib k.mtl\n" + CUBE)
    run.write("k.mtl", "newmtl a\nmap_Kd k.png\n")
    run.write("k.png", PNG)
    run.write("p.ply", "ply\nformat ascii 1.0\ncomment TextureFile p.png\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
              "end_header\n0 0 0\n")
    run.write("p.png", PNG)
    run.write("l.json", TWIST)
    run.write("box.json", {**TWIST, "rest": {"box": {"meshes": ["m.gltf", "k.obj", "n.gltf"]}, "margin": 0.1}})
    run.write("other.obj", CUBE)
    return {name: run.read(name) for name in run.names()}


@case
def siege3_04_no_output_replaces_what_is_read(run):
    """In whatever format and by whatever option an output is written: what the input is made of stays, with --force too."""
    kept = what_is_read(run)
    buffer, resource = "is a buffer of the input m.gltf", "is an image or a material library of the input "
    box = "is a file of the meshes that the box of box.json goes round"
    named = "is a file that is named by the input m.gltf"
    outputs = [("m.bin", "m.gltf", buffer), ("m.schema", "m.gltf", named), ("m.mp3", "m.gltf", named), ("m.png", "m.gltf", resource + "m.gltf"), ("k.mtl", "k.obj", resource + "k.obj"),
               ("k.png", "k.obj", resource + "k.obj"), ("p.png", "p.ply", resource + "p.ply"), ("n.npy", "n.gltf", "is a buffer of the input n.gltf")]
    for output, mesh, told in outputs:
        told = f"{output}: {told} and is not overwritten"
        for to in ("obj", "ply", "off", "stl", "glb", "gltf"):
            run.ffd("deform", mesh, output, "-l", "l.json", "--output-format", to, "--force", code=IO, err=told)
        for arrays in (["-o", output], ["-o", "e.npy", "--status", output]):
            run.ffd("embed", mesh, "-l", "l.json", *arrays, "--force",
                    **({"code": IO, "err": told} if output == "n.npy" else {"code": USAGE, "err": f"{output}: must end in .npy: it is an array"}))
        run.ffd("lattice", "new", "other.obj", mesh, "-o", output, "--force", code=IO, err=told)
        run.write("m.jsonl", json.dumps({"in": mesh, "lattice": "l.json", "out": output, "options": {"output-format": "obj", "force": True}}))
        run.ffd("batch", "m.jsonl", "-q", code=NO, err=lambda said, told=told: check(told in said[0], said))
        run.remove("m.jsonl")
    for output in ("m.bin", "m.gltf", "k.obj", "n.npy"):
        run.ffd("deform", "other.obj", output, "--output-format", "obj", "-l", "box.json", "--force", code=IO, err=f"{output}: {box} and is not overwritten")
    run.ffd("embed", "other.obj", "-o", "n.npy", "-l", "box.json", "--force", code=IO, err=f"n.npy: {box} and is not overwritten")
    equal({name: run.read(name) for name in run.names() if name != "cache"}, kept)
    # What is read is not replaced where a link leads to it either; a mesh in place may stand in the box.
    os.symlink("m.bin", run.path("link"))
    run.ffd("deform", "m.gltf", "link", "-l", "l.json", "--output-format", "obj", "--force", code=IO,
            err="link: is a buffer of the input m.gltf and is not overwritten")
    run.ffd("deform", "k.obj", "--in-place", "-l", "box.json")


@case
def siege3_05_a_box_of_meshes_in_place_is_refused(run):
    """The first mesh in place would change the box of the second: neither is moved. --shared-box goes round both as they were."""
    kit = {**TWIST, "rest": {"box": {"meshes": ["a.obj", "b.obj"]}, "margin": 0.1}}
    run.write("kit.json", kit)
    run.write("round.json", {**TWIST, "rest": {"box": "mesh", "margin": 0.1}})
    for name, shift in (("a.obj", 0), ("b.obj", 1.5)):
        run.write(name, "".join(f"v {x + shift} {y} {z}\n" for x, y, z in CUBE_CORNERS))
    kept = run.read("a.obj"), run.read("b.obj")
    for names in (["a.obj", "b.obj"], ["b.obj", "a.obj"]):
        run.ffd("deform", *names, "--in-place", "-l", "kit.json", code=INVALID,
                err=lambda said: check("(for the box of kit.json)" in said[0], said))
        equal((run.read("a.obj"), run.read("b.obj")), kept)
    run.folder_of("apart")
    run.ffd("deform", "a.obj", "b.obj", "--out-dir", "apart", "-l", "kit.json")
    run.ffd("deform", "b.obj", "a.obj", "--in-place", "-l", "round.json", "--shared-box")
    equal((run.read("a.obj"), run.read("b.obj")), (run.read("apart/a.obj"), run.read("apart/b.obj")))


@case
def siege_07_pipes_sockets_and_disks_are_refused_at_once(run):
    """Pipes, sockets and disks as outputs of any kind: one line at once, and no work is done."""
    run.write("a.obj", CUBE)
    run.write("l.json", TWIST)
    run.ffd("deform", "a.obj", "old.obj", "-l", "l.json", "--report", "old.json")
    for name in ("f.obj", "f.json"):
        os.mkfifo(run.path(name))
    run.ffd("lattice", "new", "a.obj", "-o", "f.json", "--force", code=IO,
            err="f.json: is a pipe, not a file (- writes to standard output)")
    specials = {"f.obj": "pipe"}
    listener = socket.socket(socket.AF_UNIX)
    if len(run.path("s.obj")) < 100:
        listener.bind(run.path("s.obj"))
        specials["s.obj"] = "socket"
    before = run.names()
    reader = os.open(run.path("f.obj"), os.O_RDONLY | os.O_NONBLOCK)
    for held in (True, False):  # somebody reads from the pipe, who may stop to
        for name, kind in specials.items():
            told = f"{name}: is a {kind}, not a file (- writes to standard output)"
            for arguments in (["deform", "a.obj", name, "-l", "l.json", "--force"],
                              ["deform", "a.obj", "b.obj", "-l", "l.json", "--report", name, "--force"],
                              ["deform", "a.obj", "b.obj", "-l", "l.json", "--depfile", name],
                              ["check", "a.obj", "-l", "l.json", "--report", name],
                              ["embed", "a.obj", "-l", "l.json", "-o", name, "--force"],
                              ["embed", "a.obj", "-l", "l.json", "-o", "u.npy", "--status", name],
                              ["report", "merge", "old.json", "-o", name, "--force"]):
                run.ffd(*arguments, code=IO, err=told)
        if held:
            os.close(reader)
    run.write("jobs.jsonl", json.dumps({"in": "a.obj", "lattice": "l.json", "out": "f.obj", "options": {"force": True}}) + "\n")
    code, said = ended(start(run, "batch", "jobs.jsonl", "--journal", "J"))
    check(code == 1 and "f.obj: is a pipe, not a file" in said, code, said)
    for option in ("--report", "--depfile", "--journal"):
        code, said = ended(start(run, "batch", "jobs.jsonl", option, "f.obj"))
        check(code == IO and said.startswith("ffd: f.obj: is ") and said.count("\n") == 1, option, code, said)
    listener.close()
    equal(sorted(set(run.names()) - {"J", "jobs.jsonl"}), before)


main()
