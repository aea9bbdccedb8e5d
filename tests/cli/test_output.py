#!/usr/bin/env python3
"""Outputs are complete or absent: nothing half written, nothing left behind, nothing overwritten unasked."""
import json
import os
import re
import resource
import signal
import socket
import stat
import subprocess
import time

from harness import (CUBE, CUBE_CORNERS, FFD, INVALID, IO, SECONDS, USAGE, case, check, equal, glb, gltf_json, gltf_vectors,
                     lattice, main, wait_until)


def start(run):
    run.write("a.obj", CUBE)
    run.write("l.json", lattice(moves=[{"by": [1, 0, 0]}]))
    run.ffd("deform", "a.obj", "expected.obj", "-l", "l.json")
    return run.read("expected.obj")


def deform(run, out, *arguments, **options):
    return run.ffd("deform", "a.obj", out, "-l", "l.json", *arguments, **options)


@case
def existing_files_need_force(run):
    expected = start(run)
    run.write("b.obj", "old")
    deform(run, "b.obj", code=IO, err="b.obj: exists already (--force overwrites it)")
    equal(run.read("b.obj"), b"old")
    deform(run, "b.obj", "--force")
    equal(run.read("b.obj"), expected)


@case
def the_input_is_overwritten_in_place_only(run):
    start(run)
    os.symlink("a.obj", run.path("s.obj"))
    os.link(run.path("a.obj"), run.path("h.obj"))
    for name in ("a.obj", "./a.obj", "s.obj", "h.obj", os.path.join(run.folder, "a.obj")):
        for more in ([], ["--force"]):
            done = deform(run, name, *more, code=IO)
            check("--in-place" in done.err[0], done.err[0])
    run.ffd("deform", "a.obj", "--out-dir", ".", "--force", "-l", "l.json", code=IO)
    equal(run.text("a.obj"), CUBE)


@case
def a_lattice_is_not_overwritten(run):
    start(run)
    text = run.read("l.json")
    os.symlink("l.json", run.path("l.obj"))
    deform(run, "l.obj", code=IO)
    equal(run.read("l.json"), text)


@case
def failures_leave_the_old_file(run):
    start(run)
    run.write("bad.obj", CUBE + "v 1 x 2\n")
    run.write("bad.json", "{")
    run.write("b.obj", "old")
    run.ffd("deform", "bad.obj", "b.obj", "-l", "l.json", "--force", code=INVALID)
    run.ffd("deform", "a.obj", "b.obj", "-l", "bad.json", "--force", code=INVALID)
    run.ffd("deform", "none.obj", "b.obj", "-l", "l.json", "--force", code=IO)
    run.ffd("deform", "bad.obj", "--in-place", "-l", "l.json", code=INVALID)
    equal(run.read("b.obj"), b"old")
    equal(run.names(), ["a.obj", "b.obj", "bad.json", "bad.obj", "expected.obj", "l.json"])


@case
def folders_and_missing_folders(run):
    start(run)
    run.folder_of("d.obj")
    deform(run, "d.obj", code=IO, err="d.obj: is a folder")
    deform(run, "d.obj", "--force", code=IO, err="d.obj: is a folder")
    deform(run, "none/b.obj", code=IO)
    deform(run, "a.obj/b.obj", code=IO)
    deform(run, "b.obj/", code=USAGE)
    equal(run.names("d.obj"), [])


@case
def read_only_folder(run):
    start(run)
    user = run.unprivileged()
    check(user, "there is no unprivileged user to run as")
    run.folder_of("locked")
    run.write("locked/old.obj", "old")
    os.chmod(run.path("locked"), 0o555)
    deform(run, "locked/b.obj", code=IO, **user)
    deform(run, "locked/old.obj", "--force", code=IO, **user)
    run.ffd("deform", "a.obj", "--out-dir", "locked", "-l", "l.json", code=IO, **user)
    run.ffd("embed", "a.obj", "-l", "l.json", "-o", "locked/e.npy", code=IO, **user)
    run.ffd("lattice", "new", "a.obj", "-o", "locked/n.json", code=IO, **user)
    for ending in ("ply", "off", "stl", "glb", "gltf"):
        run.ffd("deform", "a.obj", f"a.{ending}", "-l", "l.json", "-q")
        for mesh in ("a.obj", f"a.{ending}"):
            done = run.ffd("deform", mesh, f"locked/b.{ending}", "-l", "l.json", "-q", code=IO, **user)
            check("Permission denied" in done.err[0], done.err)
    os.chmod(run.folder, 0o777)
    for n, option in enumerate(("--report", "--depfile")):
        deform(run, f"b{n}.obj", option, "locked/x", code=IO, err="locked/x: cannot be written: Permission denied", **user)
        check(not run.exists(f"b{n}.obj"), "work was done although it was known to fail")
    deform(run, "locked/old.obj", "--if-changed", code=IO, **user)
    os.chmod(run.path("locked"), 0o755)
    equal(run.names("locked"), ["old.obj"])
    equal(run.read("locked/old.obj"), b"old")


@case
def unreadable_files_are_exit_3(run):
    start(run)
    user = run.unprivileged()
    check(user, "there is no unprivileged user to run as")
    os.chmod(run.path("a.obj"), 0)
    deform(run, "-", "--output-format", "obj", code=IO, err="a.obj: cannot be opened: Permission denied", **user)
    os.chmod(run.path("a.obj"), 0o644)
    os.chmod(run.path("l.json"), 0)
    deform(run, "-", "--output-format", "obj", code=IO, err="l.json: cannot be opened: Permission denied", **user)


def mode_under(run, mask, name):
    """The bits of a file that is written under a umask."""
    old = os.umask(mask)
    try:
        deform(run, name)
    finally:
        os.umask(old)
    return stat.S_IMODE(os.stat(run.path(name)).st_mode)


@case
def permissions_of_a_replaced_file_stay(run):
    expected = start(run)
    for mode in (0o600, 0o644, 0o755, 0o640):
        run.write("b.obj", "old")
        os.chmod(run.path("b.obj"), mode)
        deform(run, "b.obj", "--force")
        equal(stat.S_IMODE(os.stat(run.path("b.obj")).st_mode), mode, "the bits of the target")
        equal(run.read("b.obj"), expected)
    equal(mode_under(run, 0o027, "new.obj"), 0o640, "a new file follows the umask")
    # What a killed run left had the bits of another file.
    run.write(".fresh.obj.ffd-tmp", "left")
    os.chmod(run.path(".fresh.obj.ffd-tmp"), 0o400)
    equal(mode_under(run, 0o022, "fresh.obj"), 0o644, "a new file over one that was left")
    os.chmod(run.path("a.obj"), 0o604)
    run.ffd("deform", "a.obj", "--in-place", "-l", "l.json")
    equal(stat.S_IMODE(os.stat(run.path("a.obj")).st_mode), 0o604, "in place")


@case
def permissions_of_every_file(run):
    """Of each format, of a .gltf's buffer, and of what is written beside a mesh."""
    start(run)
    jobs = [([f"b.{ending}"] + (["b.bin"] if ending == "gltf" else []), ["deform", "a.obj", f"b.{ending}", "-l", "l.json", "-q"])
            for ending in ("ply", "off", "stl", "glb", "gltf")]
    jobs += [(["e.npy", "s.npy"], ["embed", "a.obj", "-l", "l.json", "-o", "e.npy", "--status", "s.npy"]),
             (["n.json"], ["lattice", "new", "a.obj", "-o", "n.json"]),
             (["c.obj", "r.json", "d"], ["deform", "a.obj", "c.obj", "-l", "l.json", "--report", "r.json", "--depfile", "d"])]
    for files, arguments in jobs:
        run.ffd(*arguments)
        for mode in (0o600, 0o640, 0o666):
            for name in files:
                os.chmod(run.path(name), mode)
            inodes = [os.stat(run.path(name)).st_ino for name in files]
            run.ffd(*arguments, "--force")
            equal([stat.S_IMODE(os.stat(run.path(name)).st_mode) for name in files], [mode] * len(files), str(files))
            check(all(a != os.stat(run.path(name)).st_ino for a, name in zip(inodes, files)), f"{files}: not written anew")


@case
def a_link_stays_and_its_target_is_written(run):
    expected = start(run)
    run.folder_of("far")
    run.write("far/target.obj", "old")
    os.symlink("far/target.obj", run.path("link.obj"))
    deform(run, "link.obj", code=IO)
    deform(run, "link.obj", "--force")
    check(os.path.islink(run.path("link.obj")), "the link was replaced")
    equal(run.read("far/target.obj"), expected)
    equal(run.names("far"), ["target.obj"])
    # In place through a link: its target changes.
    run.write("far/mesh.obj", CUBE)
    os.symlink("far/mesh.obj", run.path("mesh.obj"))
    run.ffd("deform", "mesh.obj", "--in-place", "-l", "l.json")
    check(os.path.islink(run.path("mesh.obj")), "the link was replaced")
    equal(run.read("far/mesh.obj"), expected)


@case
def a_link_to_nothing(run):
    """As output, report and depfile: it is refused before any work, and nothing appears at its end."""
    start(run)
    for name in ("link.obj", "link.json"):
        os.symlink("nowhere", run.path(name))
    before = run.names()
    told = "link.obj: is a link that leads to no file"
    for more in ([], ["--force"]):
        deform(run, "link.obj", *more, code=IO, err=told)
        deform(run, "b.obj", "--report", "link.obj", *more, code=IO, err=told)
        deform(run, "b.obj", "--depfile", "link.obj", *more, code=IO, err=told)
    run.ffd("embed", "a.obj", "-l", "l.json", "-o", "link.obj", code=IO, err=told)
    run.ffd("lattice", "new", "a.obj", "-o", "link.json", code=IO, err="link.json: is a link that leads to no file")
    equal(run.names(), before)


@case
def hard_links_keep_the_old_content(run):
    start(run)
    run.write("b.obj", "old")
    os.link(run.path("b.obj"), run.path("other.obj"))
    deform(run, "b.obj", "--force")
    equal(run.read("other.obj"), b"old")


@case
def devices_are_written_and_not_replaced(run):
    expected = start(run)
    deform(run, "/dev/null", "--output-format", "obj")
    check(stat.S_ISCHR(os.stat("/dev/null").st_mode), "/dev/null was replaced")
    deform(run, "/dev/full", "--output-format", "obj", code=IO,
           err="/dev/full: cannot be written: No space left on device")
    equal(deform(run, "/dev/stdout", "--output-format", "obj").out, expected)


@case
def a_write_that_fails_in_the_middle_leaves_the_old_file(run):
    """A limit on the size of files imitates a full disk: the write fails in the middle."""
    run.write("big.obj", CUBE + "v 0.123456789 0 0\n" * 20000)
    run.write("l.json", lattice(moves=[{"by": [1e-7, 0, 0]}]))
    run.write("b.obj", "old")

    def limit():
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (65536, 65536))

    run.ffd("deform", "big.obj", "b.obj", "-l", "l.json", "--force", preexec_fn=limit, code=IO)
    run.ffd("deform", "big.obj", "c.obj", "-l", "l.json", preexec_fn=limit, code=IO)
    run.ffd("embed", "big.obj", "-l", "l.json", "-o", "e.npy", "--status", "s.npy", preexec_fn=limit, code=IO)
    equal(run.read("b.obj"), b"old")
    equal(run.names(), ["b.obj", "big.obj", "l.json"])


def write_what_takes_a_while(run):
    """Writes a.obj and l.json. Returns the seconds of the deformation that gives expected.obj."""
    run.write("a.obj", "".join(f"v {n % 97 / 97} {n % 89 / 89} {n % 83 / 83}\n" for n in range(60000)))
    run.write("l.json", lattice(moves=[{"by": [0.1, 0.2, 0.3]}]))
    begun = time.monotonic()
    deform(run, "expected.obj")
    return time.monotonic() - begun


@case
def killed_runs_leave_no_half_file(run):
    """Whenever a run is killed the target is the old file or the new one, and the next run cleans up after it."""
    whole = write_what_takes_a_while(run)
    killed = 0
    for n in range(12):
        run.write("b.obj", "old")
        child = subprocess.Popen([FFD, "deform", "a.obj", "b.obj", "-l", "l.json", "--force"], cwd=run.folder)
        time.sleep(whole * n / 10)
        child.kill()
        killed += child.wait(timeout=SECONDS) < 0
        check(run.read("b.obj") in (b"old", run.read("expected.obj")), "half a file")
        check(set(run.names()) <= {"a.obj", "b.obj", "l.json", "expected.obj", ".b.obj.ffd-tmp"}, run.names())
    check(killed > 0, "no run was killed before its end")
    run.write(".b.obj.ffd-tmp", "left by a run that was killed, and longer than what comes next" * 100000)
    deform(run, "b.obj", "--force")
    equal(run.read("b.obj"), run.read("expected.obj"))
    equal(run.names(), ["a.obj", "b.obj", "expected.obj", "l.json"])


@case
def interrupted_runs_leave_nothing(run):
    """A run that a signal ends at any moment leaves the old file or the new one, and no temporary one; its parent sees the signal."""
    whole = write_what_takes_a_while(run)
    ends = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
    interrupted = 0
    for n in range(30):
        run.write("b.obj", "old")
        child = subprocess.Popen([FFD, "deform", "a.obj", "b.obj", "-l", "l.json", "--force", "--report", "r.json"],
                                 cwd=run.folder, stderr=subprocess.PIPE)
        time.sleep(whole * n / 25)
        child.send_signal(ends[n % 3])
        equal(child.communicate(timeout=SECONDS)[1], b"")
        check(child.returncode in (0, -ends[n % 3]), child.returncode)
        interrupted += child.returncode < 0
        check(run.read("b.obj") in (b"old", run.read("expected.obj")), "half a file")
        check(set(run.names()) <= {"a.obj", "b.obj", "l.json", "expected.obj", "r.json"}, run.names())
        if run.exists("r.json"):
            json.loads(run.read("r.json"))
    check(interrupted > 5, f"{interrupted} runs were interrupted before their end")


@case
def ignored_signals_stay_ignored(run):
    """As under nohup: the hangup does not end the run, nor leave anything behind."""
    expected = start(run)
    child = subprocess.Popen([FFD, "deform", "-", "b.obj", "--input-format", "obj", "-l", "l.json", "--report", "r.json"], cwd=run.folder,
                             stdin=subprocess.PIPE, preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN))
    wait_until(lambda: run.exists("r.json"), "the report is not begun")
    child.send_signal(signal.SIGHUP)
    child.communicate(run.read("a.obj"), timeout=SECONDS)
    equal(child.returncode, 0)
    equal(run.read("b.obj"), expected)
    run.check_no_leftovers()


@case
def pipes_and_sockets_as_files(run):
    expected = start(run)
    os.mkfifo(run.path("in.obj"))
    writer = subprocess.Popen(["sh", "-c", "cat a.obj > in.obj"], cwd=run.folder)
    # A pipe among files may never give anything; one that this process was given does.
    run.ffd("deform", "in.obj", "b.obj", "-l", "l.json", code=IO)
    writer.kill()
    writer.wait(timeout=SECONDS)
    run.ffd("deform", "/dev/stdin", "b.obj", "-l", "l.json", "--input-format", "obj", stdin=run.read("a.obj"))
    equal(run.read("b.obj"), expected)
    if len(run.path("s.obj")) < 100:
        with socket.socket(socket.AF_UNIX) as server:
            server.bind(run.path("s.obj"))
            run.ffd("deform", "s.obj", "c.obj", "-l", "l.json", code=IO)
            deform(run, "s.obj", "--force", code=IO)


@case
def two_runs_at_once(run):
    """The same target from several runs at the same time: one of the results, complete; nothing left."""
    expected = start(run)
    children = [subprocess.Popen([FFD, "deform", "a.obj", "b.obj", "-l", "l.json", "--force"], cwd=run.folder,
                                 stderr=subprocess.PIPE) for _ in range(12)]
    for child in children:
        told = child.communicate(timeout=SECONDS)[1]
        check(child.returncode in (0, IO), told)
    equal(run.read("b.obj"), expected)
    run.check_no_leftovers()


@case
def gltf_is_complete_or_absent(run):
    start(run)
    asset, data = gltf_json(CUBE_CORNERS, uri="a.bin")
    run.write("m/a.gltf", asset)
    run.write("m/a.bin", data)
    run.folder_of("out")
    run.write("out/b.bin", "somebody's")
    run.ffd("deform", "m/a.gltf", "out/b.gltf", "-l", "l.json", code=IO, err="out/b.bin: exists already (--force overwrites it)")
    equal(run.names("out"), ["b.bin"])
    equal(run.read("out/b.bin"), b"somebody's")
    run.ffd("deform", "m/a.gltf", "out/b.gltf", "-l", "l.json", "--force")
    after = json.loads(run.read("out/b.gltf"))
    equal(gltf_vectors(after, run.read("out/b.bin"), 0)[0], [0, -1, -1])
    # A target in the input's folder never takes the input's buffer, whatever its name.
    run.ffd("deform", "m/a.gltf", "m/c.gltf", "-l", "l.json")
    equal(run.read("m/a.bin"), data)
    asset["buffers"][0]["uri"] = "d.bin"
    run.write("m/x.gltf", asset)
    run.write("m/d.bin", data)
    run.ffd("deform", "m/x.gltf", "m/d.gltf", "-l", "l.json",
            err="m/x.gltf: m/d.bin is a file of m/x.gltf too, and stays: m/d-1.bin is written in place of it")
    run.ffd("deform", "m/x.gltf", "m/d.gltf", "-l", "l.json", "--force")
    equal(run.read("m/d.bin"), data, "the input's buffer")
    equal(json.loads(run.read("m/d.gltf"))["buffers"][0]["uri"], "d-1.bin")


@case
def a_buffer_that_others_share_is_left_to_them_in_place(run):
    """Also one without the output's stem: a line names who has it still. A buffer of one's own is left without a word."""
    asset, data = gltf_json([[0, 0, 0], [1, 0, 0], [0, 1, 0]])
    asset["buffers"] = [{"byteLength": len(data), "uri": "s.bin"}]
    run.write("l.json", lattice(low=(-9, -9, -9), high=(9, 9, 9), moves=[{"by": [1, 0, 0]}]))
    run.write("s.bin", data)
    for name in ("a.gltf", "b.gltf"):
        run.write(name, json.dumps(asset))
    said = "a.gltf: s.bin was a file of b.gltf too, and stays: a.bin is written in place of it"
    run.ffd("deform", "a.gltf", "--in-place", "-l", "l.json", err=said)
    check(run.read("s.bin") == data and run.read("a.bin") != data, "s.bin stays")
    run.ffd("deform", "a.gltf", "--in-place", "-l", "l.json", err=[])
    run.ffd("deform", "b.gltf", "--in-place", "-l", "l.json", err=[])


@case
def gltf_in_place_keeps_a_valid_file(run):
    start(run)
    asset, data = gltf_json(CUBE_CORNERS, uri="a.bin")
    run.write("m/a.gltf", asset)
    run.write("m/a.bin", data)
    run.ffd("deform", "m/a.gltf", "--in-place", "-l", "l.json")
    after = json.loads(run.read("m/a.gltf"))
    equal(gltf_vectors(after, run.read("m/" + after["buffers"][0]["uri"]), 0)[0], [0, -1, -1])
    run.ffd("deform", "m/a.gltf", "--in-place", "-l", "l.json")
    run.ffd("info", "m/a.gltf")


@case
def input_and_output_may_be_in_other_folders(run):
    expected = start(run)
    run.folder_of("work/deep")
    run.ffd("deform", os.path.join(run.folder, "a.obj"), "work/deep/../b.obj", "-l", "./l.json")
    equal(run.read("work/b.obj"), expected)


@case
def a_report_or_depfile_under_another_spelling_of_out(run):
    """The report took the place of OUT, which was then said to exist: exit 3."""
    start(run)
    run.folder_of("in/x")
    os.symlink("in", os.path.join(run.folder, "link"))
    for option in ("--report", "--depfile"):
        for out, other in (("b.obj", "./b.obj"), ("in/b.obj", "link/b.obj"), ("./in/../b.obj", "b.obj")):
            run.ffd("deform", "a.obj", out, "-l", "l.json", option, other, code=USAGE, err=re.compile("would replace a mesh"))
    run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "--report", "./a.obj", "--depfile", "c.d", code=USAGE,
            err=re.compile("would replace a mesh"))
    run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "--report", "./l.json", code=USAGE, err=re.compile("would replace a lattice"))
    equal(run.names(), ["a.obj", "expected.obj", "in", "l.json", "link"], "the folder")
    run.ffd("deform", "a.obj", "in/b.obj", "-l", "l.json", "--report", "b.obj")


@case
def long_names_leave_room_for_a_temporary_one(run):
    expected = start(run)
    name = "n" * 240 + ".obj"  # with the temporary name's letters still a name
    deform(run, name)
    equal(run.read(name), expected)
    deform(run, "n" * 300 + ".obj", code=IO)


@case
def glb_to_the_same_name_with_force(run):
    start(run)
    run.write("a.glb", glb(*gltf_json(CUBE_CORNERS)))
    run.write("b.glb", b"old")
    run.ffd("deform", "a.glb", "b.glb", "-l", "l.json", code=IO)
    run.ffd("deform", "a.glb", "b.glb", "-l", "l.json", "--force")
    run.ffd("compare", "a.glb", "b.glb", "--tolerance", "1")


main()
