#!/usr/bin/env python3
"""Names that lead to the same file: nothing is deformed twice, and no output replaces an input or another output."""
import json
import os
import resource
import stat

from harness import CUBE, CUBE_CORNERS, INVALID, IO, NO, USAGE, case, check, equal, gltf_json, lattice, main

UP = lattice(moves=[{"by": [0, 0, 1]}])


def start(run):
    run.write("a.obj", CUBE)
    run.write("l.json", UP)
    run.ffd("deform", "a.obj", "once.obj", "-l", "l.json")
    return run.read("once.obj")


@case
def one_file_under_two_names_is_refused_before_any_work(run):
    start(run)
    run.ffd("deform", "a.obj", "./a.obj", "--in-place", "-l", "l.json", code=INVALID,
            err="./a.obj: and a.obj would both write one file")
    run.write("b.obj", CUBE)
    os.symlink("b.obj", run.path("c.obj"))
    run.ffd("deform", "a.obj", "b.obj", "c.obj", "--in-place", "-l", "l.json", code=INVALID,
            err="c.obj: and b.obj would both write one file")
    equal((run.text("a.obj"), run.text("b.obj")), (CUBE, CUBE))


@case
def one_file_is_deformed_once_in_place(run):
    """Two hard links are two files once one of them was replaced."""
    once = start(run)
    run.write("b.obj", CUBE)
    os.link(run.path("b.obj"), run.path("c.obj"))
    run.ffd("deform", "b.obj", "c.obj", "--in-place", "-l", "l.json")
    equal((run.read("b.obj"), run.read("c.obj")), (once, once))


@case
def what_stays_as_it_is_was_written_too(run):
    once = start(run)
    os.link(run.path("once.obj"), run.path("link.obj"))
    run.write("still.json", lattice(moves=[]))
    run.ffd("deform", "once.obj", "link.obj", "--in-place", "--if-changed", "-l", "still.json", code=NO,
            err="link.obj: was written by this run already, under this name or another")
    equal(run.read("link.obj"), once)


@case
def no_two_outputs_share_a_buffer(run):
    """m.gltf has two buffers, so its second is m-1.bin, which m-1.gltf wants for its first: it gets another."""
    run.write("l.json", UP)
    run.folder_of("k")
    for name, buffers in (("m", 2), ("m-1", 1)):
        asset, data = gltf_json(CUBE_CORNERS, uri=f"{name}-data0.bin")
        run.write(f"k/{name}-data0.bin", data)
        if buffers == 2: # a second mesh, with the same layout in a buffer of its own
            run.write(f"k/{name}-data1.bin", data)
            asset["buffers"].append({"byteLength": len(data), "uri": f"{name}-data1.bin"})
            asset["bufferViews"].append({"buffer": 1, "byteOffset": 0, "byteLength": len(data)})
            asset["accessors"].append({**asset["accessors"][0], "bufferView": 1})
            asset["meshes"].append({"primitives": [{"attributes": {"POSITION": 1}, "mode": 0}]})
            asset["nodes"].append({"mesh": 1})
            asset["scenes"][0]["nodes"].append(1)
        run.write(f"k/{name}.gltf", asset)
    run.folder_of("o")
    run.folder_of("single")
    run.ffd("deform", "k/m.gltf", "single/m.gltf", "-l", "l.json")
    for _ in "ab":
        run.ffd("deform", "k/m.gltf", "k/m-1.gltf", "--out-dir", "o", "--force", "-l", "l.json", err=lambda said: None)
        for name in ("m.gltf", "m.bin", "m-1.bin"):
            equal(run.read("o/" + name), run.read("single/" + name), name)
        equal((json.loads(run.text("o/m-1.gltf"))["buffers"][0]["uri"], run.names("o")),
              ("m-1-1.bin", ["m-1-1.bin", "m-1.bin", "m-1.gltf", "m.bin", "m.gltf"]))


@case
def an_output_replaces_no_lattice(run):
    start(run)
    run.write("l.obj", UP)
    kept = run.read("l.obj")
    os.symlink("l.obj", run.path("s.obj"))
    for lattice_name, output in (("l.obj", "l.obj"), ("s.obj", "l.obj"), ("l.obj", "s.obj")):
        run.ffd("deform", "a.obj", output, "-l", lattice_name, "--force", code=IO,
                err=f"{output}: is a lattice of this command")
    equal(run.read("l.obj"), kept)


@case
def a_report_replaces_reports_only(run):
    start(run)
    run.write("notes.txt", "mine")
    run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "--report", "notes.txt", code=IO,
            err="notes.txt: exists and is not a report: it is not replaced")
    equal(run.read("notes.txt"), b"mine")
    check(not run.exists("b.obj"), "the job ran")
    for _ in range(2):
        run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "--report", "r.json", "--force")
    run.ffd("deform", "a.obj", "c.obj", "-l", "l.json", "--report", "c.obj", code=USAGE)


@case
def a_report_that_cannot_be_written_is_told_first(run):
    start(run)
    run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "--report", "none/r.json", code=IO)
    check(not run.exists("b.obj"), "the job ran")


@case
def embed_does_not_replace_its_inputs(run):
    start(run)
    os.symlink("l.json", run.path("link.npy"))
    for options in (["-o", "./a.obj"], ["-o", "u.npy", "--status", "./a.obj"], ["-o", "link.npy"]):
        run.ffd("embed", "a.obj", "-l", "l.json", *options, "--force", code=(USAGE, IO))
    equal(run.text("a.obj"), CUBE)
    check(not run.exists("u.npy"), "half of the outputs was written")
    run.write("u.npy", "")
    os.link(run.path("u.npy"), run.path("s.npy"))
    run.ffd("embed", "a.obj", "-l", "l.json", "-o", "u.npy", "--status", "s.npy", "--force", code=USAGE)


@case
def a_size_limit_is_a_failure_like_others(run):
    start(run)
    run.write("big.obj", "".join(f"v {i} {i} {i}\n" for i in range(100000)))

    def limit():
        resource.setrlimit(resource.RLIMIT_FSIZE, (100000, 100000))

    run.ffd("deform", "big.obj", "o.obj", "-l", "l.json", "-q", preexec_fn=limit, code=IO)
    check(not run.exists("o.obj"), "half a file was left")


@case
def a_pipe_at_the_temporary_name_is_refused(run):
    start(run)
    os.mkfifo(run.path(".o.obj.ffd-tmp"))
    arguments = ["deform", "a.obj", "o.obj", "-l", "l.json"]
    check_leftovers, run.check_no_leftovers = run.check_no_leftovers, lambda: None
    run.ffd(*arguments, code=IO)
    os.unlink(run.path(".o.obj.ffd-tmp"))
    run.check_no_leftovers = check_leftovers
    run.ffd(*arguments)


@case
def the_longest_names_can_be_written(run):
    once = start(run)
    for name in ("x" * 251 + ".obj", "y" * 242 + ".obj", "\u00e4" * 125 + ".obj"):
        run.ffd("deform", "a.obj", name, "-l", "l.json")
        equal(run.read(name), once)
        run.ffd("deform", "a.obj", name, "-l", "l.json", "--force")


@case
def an_answer_that_nobody_sees_is_a_failure(run):
    start(run)
    with open("/dev/full", "wb") as full:
        run.ffd("compare", "a.obj", "once.obj", stdout=full, code=IO)


@case
def the_owner_stays(run):
    if os.geteuid() != 0:
        return
    start(run)
    os.chown(run.path("a.obj"), 65534, 65534)
    run.ffd("deform", "a.obj", "--in-place", "-l", "l.json")
    info = os.stat(run.path("a.obj"))
    equal((info.st_uid, info.st_gid, stat.S_ISREG(info.st_mode)), (65534, 65534, True))


if __name__ == "__main__":
    main()
