#!/usr/bin/env python3
"""A .gltf and its buffers are replaced together: whatever call fails and whenever the program is killed, the old files or
the new ones are whole, and the next run that writes them brings them back.

Each call that changes the folder is made to fail, and to be the program's last one, by strace. FFD_LARGE=1 tries more
reasons, also on a file system without renameat2's flags."""

import copy
import json
import os
import re
import shutil
import subprocess
import time

from harness import CUBE, CUBE_CORNERS, FFD, IO, OK, SANITIZED, SECONDS, case, check, equal, gltf_json, lattice, main

CHANGING = ("openat", "rename", "renameat2", "link", "unlink", "mkdir", "rmdir")
LINE = re.compile(r"(?:\d+ +)?(\w+)\((.*)")
HIDDEN = re.compile(r"\.(.*)\.ffd-(tmp|old|set)$")
LARGE = int(os.environ.get("FFD_LARGE", "0"))


def model(uris):
    """A .gltf of a cube in each buffer, and the buffers' bytes by their names."""
    asset, data = gltf_json(CUBE_CORNERS, uri=uris[0])
    for i, uri in enumerate(uris[1:], 1):
        asset["buffers"].append({**asset["buffers"][0], "uri": uri})
        asset["bufferViews"].append({**asset["bufferViews"][0], "buffer": i})
        asset["accessors"].append({**asset["accessors"][0], "bufferView": i})
        asset["meshes"].append(copy.deepcopy(asset["meshes"][0]))
        asset["meshes"][i]["primitives"][0]["attributes"]["POSITION"] = i
        asset["nodes"].append({"mesh": i})
    asset["scenes"][0]["nodes"] = list(range(len(uris)))
    return json.dumps(asset).encode(), {uri: data for uri in uris}


def files_of(path, uris, folder=""):
    text, buffers = model(uris)
    return {folder + path: text, **{folder + name: data for name, data in buffers.items()}}


def old_output(*names):
    return {name: b"old " + name.encode() for name in names}


DEFORM = ("--threads", "1", "-q", "-l", "l.json")
# name: (files, links, the command). What is written stands in o/.
SCENES = {
    "in place": (files_of("a.gltf", ["a.bin", "a-1.bin"], "o/"), {}, ("deform", "o/a.gltf", "--in-place", *DEFORM)),
    "in place, other names of buffers": (files_of("a.gltf", ["x.bin", "y.bin"], "o/"), {},
                                         ("deform", "o/a.gltf", "--in-place", *DEFORM)),
    "force": ({**files_of("i.gltf", ["i.bin", "j.bin"]), **old_output("o/a.gltf", "o/a.bin", "o/a-1.bin")}, {},
              ("deform", "i.gltf", "o/a.gltf", "--force", *DEFORM)),
    "force, one buffer more": ({**files_of("i.gltf", ["i.bin", "j.bin"]), **old_output("o/a.gltf", "o/a.bin")}, {},
                               ("deform", "i.gltf", "o/a.gltf", "--force", *DEFORM)),
    "new": (files_of("i.gltf", ["i.bin", "j.bin"]), {}, ("deform", "i.gltf", "o/a.gltf", *DEFORM)),
    "conversion": ({"i.obj": CUBE.encode(), **old_output("o/a.gltf", "o/a.bin")}, {},
                   ("deform", "i.obj", "o/a.gltf", "--force", *DEFORM)),
    "through links": ({**files_of("i.gltf", ["i.bin"]), **old_output("o/far.gltf", "far/far.bin")},
                      {"o/a.gltf": "far.gltf", "o/a.bin": "../far/far.bin"},
                      ("deform", "i.gltf", "o/a.gltf", "--force", *DEFORM)),
    "embedding": ({"i.obj": CUBE.encode(), **old_output("o/u.npy", "o/s.npy")}, {},
                  ("embed", "i.obj", "-l", "l.json", "-o", "o/u.npy", "--status", "o/s.npy", "--force", "-q")),
}
WRITTEN = ("o", "far")


def lay_out(run, files, links):
    for folder in WRITTEN:
        shutil.rmtree(run.path(folder), ignore_errors=True)
        run.folder_of(folder)
    run.write("l.json", lattice(moves=[{"at": [3, "all", "all"], "by": [0.5, 0, 0]}]))
    for name, content in files.items():
        run.write(name, content)
    for name, to in links.items():
        os.symlink(to, run.path(name))


def state(run):
    """The files of the folders that are written to. A link is where it leads."""
    found = {}
    for folder in WRITTEN:
        for name in run.names(folder):
            path = f"{folder}/{name}"
            found[path] = os.readlink(run.path(path)) if os.path.islink(run.path(path)) else run.read(path)
    return found


def strace(run, arguments, *options):
    """Runs ffd under strace. None where it may not trace."""
    log = run.path("strace.log")
    run.remove("strace.log")
    done = subprocess.run(["strace", "-f", "-o", log, *options, FFD, *arguments], cwd=run.folder, capture_output=True,
                          check=False, timeout=SECONDS)
    allowed = os.path.exists(log) and os.path.getsize(log) > 0 and b"PTRACE" not in done.stderr
    return done if allowed else None


def points(run, arguments, options):
    """(call, how manyth of its name) of each call that changes a folder, in their order."""
    if not strace(run, arguments, "-e", "trace=" + ",".join(CHANGING), *options):
        return None
    counts, found = {}, []
    for line in run.text("strace.log").splitlines():
        match = LINE.match(line)
        if not match or match[1] not in CHANGING:
            continue
        counts[match[1]] = counts.get(match[1], 0) + 1
        if (match[1] != "openat" or "O_CREAT" in line) and "INJECTED" not in line:
            found.append((match[1], counts[match[1]]))
    return found


def is_whole(now, wanted):
    """Whether all of these files are there, under their names or, each, set aside."""
    def stands(path, content):
        folder, name = os.path.split(path)
        return content in (now.get(path), now.get(f"{folder}/.{name}.ffd-old"))
    return all(stands(path, content) for path, content in wanted.items())


def hidden(now):
    return [path for path in now if HIDDEN.match(os.path.basename(path))]


def run_to_the_end(run, arguments):
    run.ffd(*arguments, code=(OK, IO), err=lambda said: None)


def try_point(run, scene, wanted, options, inject, lasting):
    """One run with a fault, and one without. wanted: the states (before, after, after twice)."""
    files, links, arguments = SCENES[scene]
    before, after, twice = wanted
    lay_out(run, files, links)
    done = strace(run, arguments, *options, *inject)
    now = state(run)
    where = f"{scene}, {inject}: exit {done.returncode}, {done.stderr.decode()!r}, {sorted(now)}"
    check(is_whole(now, before) or is_whole(now, after), "neither the old nor the new files are whole:", where)
    if not lasting:
        # Where what was replaced cannot be removed, it stays beside the new files.
        check(now == before if done.returncode == IO and not is_whole(now, after) else is_whole(now, after), "not as it was:", where)
        check(hidden(now) == [] or b"cannot be removed" in done.stderr, where)
        check(done.returncode in (OK, IO) and done.stderr.count(b"\n") == (done.returncode != 0), where)
    run_to_the_end(run, arguments)
    then = state(run)
    equal(hidden(then), [], f"left after {where}")
    check(then in (after, twice), "the next run does not mend it:", where)


def try_scene(run, scene, faults, options=()):
    """Tries each fault at each point. Returns how many times; None where strace may not be used."""
    files, links, arguments = SCENES[scene]
    lay_out(run, files, links)
    before = state(run)
    found = points(run, arguments, list(options))
    if found is None:
        return None
    after = state(run)
    run_to_the_end(run, arguments)
    wanted = before, after, state(run)
    check(hidden(after) == [] and before != after, scene, sorted(after))
    for fault, lasting in faults:
        for call, number in found:
            try_point(run, scene, wanted, options, ("-e", f"inject={call}:{fault.format(number)}"), lasting)
    return len(faults) * len(found)


KILL = ("signal=KILL:when={}", True)
FAIL = ("error=EIO:when={}", False)
FAIL_ON = ("error=EIO:when={}+", True)  # from here on: what was begun cannot be undone either


@case
def whatever_fails_and_whenever_it_is_killed(run):
    if SANITIZED:
        return  # leaks cannot be looked for under strace
    faults = [KILL, FAIL, FAIL_ON]
    if LARGE:
        faults += [(f"error={reason}:when={{}}", False) for reason in ("EACCES", "ENOSPC", "EPERM", "EROFS")]
    counts = [try_scene(run, scene, faults) for scene in SCENES]
    if None in counts:
        print("strace is not allowed to run")
        return
    print(f"{sum(counts)} points")
    check(sum(counts) >= 200, "too few")


@case
def without_a_rename_that_replaces_nothing(run):
    """File systems that know no such rename have links."""
    if SANITIZED:
        return
    options = ("-e", "inject=renameat2:error=EINVAL")
    for scene in SCENES if LARGE else ("in place", "new"):
        if try_scene(run, scene, [KILL, FAIL, FAIL_ON] if LARGE else [KILL], options) is None:
            return


NO_LOCKS = ("-e", "inject=flock:error=ENOLCK")


@case
def without_locks(run):
    """Lustre and NFS may have none: outputs are written all the same, and a run mends what a killed one left."""
    if SANITIZED:
        return
    for scene in SCENES if LARGE else ("in place", "new"):
        if try_scene(run, scene, [KILL, FAIL] if LARGE else [KILL], NO_LOCKS) is None:
            return


@case
def all_kinds_of_outputs_are_written_without_locks(run):
    if SANITIZED:
        return
    run.write("i.obj", CUBE)
    run.write("l.json", lattice(moves=[{"at": [3, "all", "all"], "by": [0.5, 0, 0]}]))
    run.write("jobs.jsonl", '{"in": "i.obj", "lattice": "l.json", "out": "o/i.obj"}')
    run.folder_of("o")
    for reason in ("ENOLCK", "ENOSYS", "EOPNOTSUPP"):
        for _ in "ab":
            done = strace(run, ["batch", "jobs.jsonl", "--report", "r.json", "--depfile", "d", "--journal", "j", "--force", "-q"],
                          "-e", f"inject=flock:error={reason}")
            if not done:
                print("strace is not allowed to run")
                return
            equal((done.returncode, done.stderr), (OK, b""), reason)
            equal(run.names("o"), ["i.obj"])
            equal(hidden(run.names()), [])


@case
def without_locks_an_output_that_another_run_has_begun_anew_is_not_placed(run):
    """Two runs write one output: the first finds that its temporary file is that of the second by now."""
    if SANITIZED:
        return
    run.write("i.obj", CUBE)
    run.write("l.json", lattice(moves=[{"at": [3, "all", "all"], "by": [0.5, 0, 0]}]))
    first = subprocess.Popen(["strace", "-f", "-o", run.path("strace.log"), *NO_LOCKS, "-e", "inject=dup:delay_enter=400000",
                              FFD, "deform", "i.obj", "o.obj", "-l", "l.json"], cwd=run.folder, stderr=subprocess.PIPE)
    while not (run.exists(".o.obj.ffd-tmp") and run.read(".o.obj.ffd-tmp")) and first.poll() is None:
        time.sleep(0.001)
    if first.poll() is not None:
        print("strace is not allowed to run")
        return
    run.remove(".o.obj.ffd-tmp")
    run.write(".o.obj.ffd-tmp", "half")
    equal((first.communicate(timeout=SECONDS)[1], first.returncode), (b"ffd: o.obj: is being written by another run\n", IO))
    equal((run.text(".o.obj.ffd-tmp"), run.exists("o.obj")), ("half", False))


@case
def whatever_call_on_a_file_fails_no_temporary_file_stays(run):
    if SANITIZED:
        return
    calls = ("flock", "fstat", "newfstatat", "fchmod", "write", "dup", "close")
    run.write("i.obj", CUBE)
    run.write("l.json", lattice(moves=[{"at": [3, "all", "all"], "by": [0.5, 0, 0]}]))
    arguments = ["deform", "i.obj", "o.obj", "-l", "l.json", "--report", "r.json", "--threads", "1"]
    if not strace(run, arguments, "-e", "trace=all"):
        print("strace is not allowed to run")
        return
    lines = run.text("strace.log").splitlines()
    begun = next(i for i, line in enumerate(lines) if ".r.json.ffd-tmp" in line and "O_CREAT" in line)
    tried = 0
    for call in calls:
        marked = [i >= begun for i, line in enumerate(lines) if re.match(rf"(\d+ +)?{call}\(", line)]
        for number in (n for n, is_late in enumerate(marked, 1) if is_late):
            for name in ("o.obj", "r.json"):
                run.remove(name)
            done = strace(run, arguments, "-e", f"inject={call}:error=EIO:when={number}")
            equal(hidden(run.names()), [], f"{call} {number}: exit {done.returncode}, {done.stderr}")
            tried += 1
    check(tried >= 12, tried, "calls failed")


@case
def what_stands_in_the_place_of_a_temporary_file_is_named(run):
    run.write("i.obj", CUBE)
    run.write("l.json", lattice(moves=[{"at": [3, "all", "all"], "by": [0.5, 0, 0]}]))
    for kind, make, unmake in (("link", lambda p: os.symlink("nowhere", p), os.unlink), ("folder", os.mkdir, os.rmdir),
                               ("pipe", os.mkfifo, os.unlink)):
        for name, arguments in (("o.obj", ("deform", "i.obj", "o.obj", "-l", "l.json")), ("o.npy", ("embed", "i.obj", "-l", "l.json", "-o", "o.npy"))):
            path = run.path(f".{name}.ffd-tmp")
            make(path)
            equal(plain(run, *arguments),
                  (IO, f"ffd: {name}: cannot be written: a {kind} named .{name}.ffd-tmp stands where it is written first: remove that\n"))
            unmake(path)


@case
def no_look_at_a_file_decides_what_was_placed(run):
    """All stats fail after the last rename, as they may where somebody moves the file away: the new files stay."""
    if SANITIZED:
        return
    for scene in ("in place", "new"):
        files, links, arguments = SCENES[scene]
        lay_out(run, files, links)
        if not strace(run, arguments, "-e", "trace=newfstatat,renameat2"):
            print("strace is not allowed to run")
            return
        calls = [line for line in run.text("strace.log").splitlines() if "newfstatat(" in line or "renameat2(" in line]
        after = state(run)
        placed = max(i for i, line in enumerate(calls) if "renameat2(" in line and 'a.gltf"' in line)
        stats = sum("newfstatat(" in line for line in calls[:placed])
        check(stats > 0, "no stat", calls)
        for reason in ("EIO", "ENOENT"):
            lay_out(run, files, links)
            done = strace(run, arguments, "-e", f"inject=newfstatat:error={reason}:when={stats + 1}+")
            equal((done.returncode, state(run)), (OK, after), f"{scene}, {reason}")


def plain(run, *arguments):
    """Runs ffd where files of a killed run lie about: exit code, stderr."""
    done = subprocess.run([FFD, *arguments], cwd=run.folder, capture_output=True, check=False, timeout=SECONDS)
    return done.returncode, done.stderr.decode()


def kill_at(run, scene, call, number):
    files, links, arguments = SCENES[scene]
    lay_out(run, files, links)
    return strace(run, arguments, "-e", f"inject={call}:signal=KILL:when={number}")


@case
def a_reader_is_told_of_a_killed_run(run):
    """The .gltf is away, and not lost."""
    if SANITIZED or not kill_at(run, "in place", "renameat2", 3):
        return
    check(not run.exists("o/a.gltf"), run.names("o"))
    equal(plain(run, "info", "o/a.gltf"),
          (IO, "ffd: o/a.gltf: cannot be opened: No such file or directory (a run that replaces it is at work, or was killed: "
               "the next one that writes it brings it back)\n"))
    equal(len(hidden(state(run))), 6, "a reader changes nothing")
    run.ffd("batch", run.write("jobs.jsonl", json.dumps({"in": "o/a.gltf", "lattice": "l.json", "options": {"in-place": True}})),
            "--report", "r.json", err=lambda said: None)
    equal(json.loads(run.read("r.json"))["jobs"][0]["vertices"], 16)
    equal(run.names("o"), ["a-1.bin", "a.bin", "a.gltf"])


@case
def what_others_put_there_meanwhile_is_not_touched(run):
    if SANITIZED or not kill_at(run, "in place", "renameat2", 4):
        return
    left = state(run)
    run.write("o/a.gltf", "somebody's")
    equal(plain(run, "deform", "o/a.gltf", "--in-place", "-l", "l.json"),
          (IO, "ffd: o/a.gltf: stands where .a.gltf.ffd-old, set aside by a run that was killed, is to come back to: remove "
               "one of them\n"))
    equal(state(run), {**left, "o/a.gltf": b"somebody's"})
    run.remove("o/a.gltf")
    run.ffd("deform", "o/a.gltf", "--in-place", "-l", "l.json", "-q")
    equal(run.names("o"), ["a-1.bin", "a.bin", "a.gltf"])


@case
def a_record_that_was_planted_is_not_followed(run):
    """It could name any file: one of another user, of many names, or that others may write."""
    lay_out(run, *SCENES["in place"][:2])
    run.write("victim", "precious")
    info = os.stat(run.path("victim"))
    planted = (b"ffd-set 1\n\0" + b"new %d %d %d %s\0" % (info.st_size, info.st_mtime_ns // 10**9, info.st_mtime_ns % 10**9,
                                                       os.fsencode(run.path("victim")))
               + b"old 1 1 1 a.gltf\0end\n\0")

    def plant(mode=0o600, owner=None):
        run.remove("o/.a.gltf.ffd-set")
        run.write("o/.a.gltf.ffd-set", planted)
        os.chmod(run.path("o/.a.gltf.ffd-set"), mode)
        if owner is not None:
            os.chown(run.path("o/.a.gltf.ffd-set"), owner, owner)

    def tried():
        code, told = plain(run, "deform", "o/a.gltf", "--in-place", "-l", "l.json")
        check(code == IO and told.startswith("ffd: o/.a.gltf.ffd-set: ") and told.count("\n") == 1, code, told)
        equal(run.read("victim"), b"precious")

    plant(mode=0o666)
    tried()
    if os.geteuid() == 0:
        plant(owner=65534)
        tried()
    plant()
    os.link(run.path("o/.a.gltf.ffd-set"), run.path("other name"))
    tried()
    run.remove("o/.a.gltf.ffd-set")
    os.symlink("../other name", run.path("o/.a.gltf.ffd-set"))
    tried()
    run.remove("o/.a.gltf.ffd-set")
    os.mkfifo(run.path("o/.a.gltf.ffd-set"))
    tried()


@case
def a_set_that_is_being_written_is_waited_for(run):
    """Two runs on one model at once: each ends well, or says that the other is at work."""
    lay_out(run, *SCENES["in place"][:2])
    children = [subprocess.Popen([FFD, "deform", "o/a.gltf", "--in-place", "-l", "l.json", "-q"], cwd=run.folder,
                                 stderr=subprocess.PIPE) for _ in range(8)]
    for child in children:
        told = child.communicate(timeout=SECONDS)[1]
        check(child.returncode in (0, IO), child.returncode, told)
    equal(run.names("o"), ["a-1.bin", "a.bin", "a.gltf"])
    run.ffd("info", "o/a.gltf")


main()
