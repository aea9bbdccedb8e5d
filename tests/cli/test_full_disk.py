#!/usr/bin/env python3
"""Disks that are full, and such that may only be read: exit 3, the old file stays, nothing is left behind.

The file systems are real ones, of a megabyte: tmpfs and, where the rights suffice, ext4 in a loop device. They are mounted in a
mount namespace of this test's own, as root or in a user namespace. What cannot be mounted is skipped; /dev/full is there always."""
import contextlib
import json
import os
import subprocess
import sys

import foam_files as foam
import volume_files as volume
from harness import CUBE, IO, PNG, SECONDS, case, check, equal, lattice, main

NAMESPACES = (["unshare", "-m"], ["unshare", "-rm"])
SPACE = "No space left on device"
NO_WRITING = "Read-only file system"
SKIPPED = 77
FORMATS = ("obj", "ply", "off", "stl", "glb", "gltf")
VOLUMES = ("vtk", "su2", "vtu", "vts", "msh")

not_mounted = set()


def enter_namespace():
    """Starts this test again in a mount namespace, if there can be one."""
    for namespace in NAMESPACES:
        probe = [*namespace, "sh", "-c", "mount -t tmpfs -o size=1m none /mnt"]
        if subprocess.run(probe, capture_output=True, check=False, timeout=SECONDS).returncode == 0:
            os.environ["FFD_TEST_NAMESPACE"] = "1"
            os.execvp(namespace[0], [*namespace, sys.executable, *sys.argv])
    not_mounted.add("no file system can be mounted")
    sys.argv[1:] = [a_full_device_is_exit_3.__name__]


def command(*words):
    done = subprocess.run(words, capture_output=True, text=True, timeout=SECONDS, check=False)
    equal(done.returncode, 0, f"{words}: {done.stderr}")


@contextlib.contextmanager
def disk(run, kind):
    """A folder "disk" with a file system of its own. Yields nothing where this kind cannot be mounted."""
    place, image = run.folder_of("disk"), run.path("image")
    if kind == "tmpfs":
        words = ["mount", "-t", "tmpfs", "-o", "size=1m,nr_inodes=64", "none", run.path(place)]
    else:
        with open(image, "wb") as file:
            file.truncate(1 << 20)
        command("mkfs.ext4", "-q", "-O", "^has_journal", "-N", "64", image)
        words = ["mount", "-o", "loop", image, run.path(place)]
    mounted = subprocess.run(words, capture_output=True, text=True, timeout=SECONDS, check=False)
    try:
        if mounted.returncode == 0:
            yield run.path(place)
        else:
            check(kind != "tmpfs", mounted.stderr)
            not_mounted.add(f"{kind} cannot be mounted: {mounted.stderr.strip()}")
            yield None
    finally:
        if mounted.returncode == 0:
            command("umount", run.path(place))
        os.rmdir(run.path(place))
        run.remove("image")


def disks(run):
    for kind in ("tmpfs", "ext4"):
        with disk(run, kind) as folder:
            if folder:
                yield folder


def fill(folder, room=0):
    """Fills a file system except for this many bytes, as far as its blocks allow. Returns the file that does it."""
    filler = os.path.join(folder, "filler")
    with open(filler, "wb", buffering=0) as file:
        with contextlib.suppress(OSError):
            while True:
                file.write(b"x" * 4096)
        with contextlib.suppress(OSError):
            while True:
                file.write(b"x")
        if room:
            file.truncate(file.tell() - room)
    return filler


def start(run):
    """A mesh whose output takes several blocks in every format."""
    count = 3000
    points = "".join(f"v {n % 97 / 97} {n % 89 / 89} {n % 83 / 83}\n" for n in range(count))
    faces = "".join(f"f {n} {n + 1} {n + 2}\n" for n in range(1, count - 1))
    run.write("a.obj", points + faces)
    run.write("cube.obj", CUBE)
    run.write("l.json", lattice(moves=[{"by": [0.1, 0.2, 0.3]}]))
    run.ffd("lattice", "refine", "l.json", "-o", "fine.json", "--size", "12")
    run.write("k.json", lattice(keys=[{"time": n, "moves": [{"by": [0.1 * n, 0.2, 0.3]}]} for n in range(2)]))
    for ending in FORMATS[1:]:
        run.ffd("deform", "a.obj", f"a.{ending}", "-l", "l.json", "-q")
    places = [[n % 97 / 97, n % 89 / 89, n % 83 / 83] for n in range(count)]
    run.write("a.vtk", volume.vtk_polygons(places, is_binary=True))
    run.write("a.su2", volume.su2(places))
    run.write("a.vtu", volume.vtu(volume.POINTS * 300, "base64", pieces=300))
    run.write("a.vts", volume.vts(places, "raw zlib", size=(30, 10, 10)))
    run.write("a.msh", volume.msh4(places))
    run.write("a/points", foam.Foam(True).points(places))
    run.write("a/faces", foam.Foam(True).faces())


def commands():
    """What ffd writes: (names of the files, arguments)."""
    for ending in FORMATS:
        files = [f"disk/b.{ending}"] + (["disk/b.bin"] if ending == "gltf" else [])
        yield files, ["deform", f"a.{ending}", f"disk/b.{ending}", "-l", "l.json"]
        if ending not in ("obj", "gltf"): # a conversion
            yield files, ["deform", "a.obj", f"disk/b.{ending}", "-l", "l.json", "-q"]
    for ending in VOLUMES:
        yield [f"disk/b.{ending}"], ["deform", f"a.{ending}", f"disk/b.{ending}", "-l", "l.json", "-q"]
    yield ["disk/points"], ["deform", "a/points", "disk/points", "-l", "l.json", "-q"]
    yield ["disk/b.obj", "disk/b.d"], ["deform", "a.obj", "disk/b.obj", "-l", "l.json", "--depfile", "disk/b.d"]
    yield ["disk/a.glb"], ["animate", "a.obj", "disk/a.glb", "-l", "k.json", "-q"]
    yield ["disk/a.gltf", "disk/a.bin"], ["animate", "a.gltf", "disk/a.gltf", "-l", "k.json", "-q"]
    yield ["disk/e.npy", "disk/s.npy"], ["embed", "a.obj", "-l", "l.json", "-o", "disk/e.npy", "--status", "disk/s.npy"]
    yield ["disk/n.json"], ["lattice", "new", "a.obj", "-o", "disk/n.json", "--size", "9,9,9"]
    yield ["disk/f.json"], ["lattice", "refine", "l.json", "-o", "disk/f.json", "--size", "12"]
    yield ["disk/h.json"], ["lattice", "set", "fine.json", "-o", "disk/h.json", "--strength", "0.5"]
    yield ["disk/f.csv"], ["lattice", "convert", "fine.json", "-o", "disk/f.csv"]
    yield ["disk/f.npy"], ["lattice", "convert", "fine.json", "-o", "disk/f.npy", "--part", "rest", "-q"]


def with_force(arguments):
    return [*arguments, "--force"]


def check_refused(run, arguments, why):
    """The run fails by the reason `why`, and the disk holds what it held before."""
    names = run.names("disk")
    before = {name: run.read(f"disk/{name}") for name in names if os.path.isfile(run.path(f"disk/{name}"))}
    done = run.ffd(*arguments, code=IO)
    check(why in done.err[0], arguments, done.err)
    equal(run.names("disk"), names, str(arguments))
    equal({name: run.read(f"disk/{name}") for name in before}, before, str(arguments))


@case
def a_full_device_is_exit_3(run):
    start(run)
    for ending in FORMATS[:-1]:
        run.ffd("deform", f"a.{ending}", "/dev/full", "--output-format", ending, "-l", "l.json", code=IO,
                err=f"/dev/full: cannot be written: {SPACE}")
        with open("/dev/full", "wb") as stdout:
            run.ffd("deform", f"a.{ending}", "-", "--output-format", ending, "-l", "l.json", code=IO, stdout=stdout,
                    err=f"standard output: cannot be written: {SPACE}")
    os.symlink("/dev/full", run.path("full.npy"))
    run.ffd("embed", "a.obj", "-l", "l.json", "-o", "full.npy", "--status", "s.npy", code=IO, err=f"full.npy: cannot be written: {SPACE}")
    os.remove(run.path("full.npy"))
    run.ffd("lattice", "new", "a.obj", "-o", "/dev/full", code=IO)
    run.ffd("lattice", "set", "l.json", "--strength", "2", "-o", "/dev/full", "--force", code=IO)
    for n, option in enumerate(("--report", "--depfile")):
        run.ffd("deform", "a.obj", f"b{n}.obj", "-l", "l.json", option, "/dev/full", code=IO, err=f"/dev/full: cannot be written: {SPACE}")
        check(not run.exists(f"b{n}.obj"), option)
        run.write("old.obj", "old")
        run.ffd("deform", "a.obj", "old.obj", "-l", "l.json", "--force", option, "/dev/full", code=IO, err=f"/dev/full: cannot be written: {SPACE}")
        equal(run.text("old.obj"), "old")
    check(not run.exists("s.npy"), "one of two arrays")


@case
def no_mesh_is_placed_whose_depfile_has_no_space(run):
    """On a disk of its own that is full: the old mesh stays, or there is none, and the old depfile. With space both are written."""
    start(run)
    for folder in disks(run):
        words = ["deform", "a.obj", "b.obj", "-l", "l.json", "--depfile", "disk/b.d", "--force"]
        for old in (False, True):
            if old:
                run.write("b.obj", "old")
                run.write("disk/b.d", "old:\n")
            filler = fill(folder)
            check_refused(run, words, SPACE)
            check(run.text("b.obj") == "old" if old else not run.exists("b.obj"), run.names())
            os.unlink(filler)
        run.ffd(*words)
        equal(run.text("disk/b.d"), "b.obj: a.obj l.json\n")
        run.remove("b.obj")
        run.remove("disk/b.d")


@case
def a_full_disk_leaves_nothing_behind(run):
    """Not a byte is left; then space for a part of the output; then enough."""
    start(run)
    for folder in disks(run):
        for files, arguments in commands():
            for old in (False, True):
                if old:
                    for name in files:
                        run.write(name, "" if name.endswith(".d") else "old")
                for room in (0,) if "new" in arguments else (0, 20000):
                    filler = fill(folder, room)
                    check_refused(run, with_force(arguments) if old else arguments, SPACE)
                    os.unlink(filler)
            run.ffd(*with_force(arguments))
            for name in files:
                check(len(run.read(name)) > 20 and run.read(name) != b"old", name)
                run.remove(name)


@case
def full_for_the_second_file(run):
    """What is complete by itself goes too where the set is not: a .gltf and its buffer, statuses and u,v,w."""
    start(run)
    for folder in disks(run):
        for files, arguments in (x for x in commands() if len(x[0]) == 2 and "--depfile" not in x[1]):
            run.ffd(*arguments)
            first, block = max(os.stat(run.path(name)).st_size for name in files), os.statvfs(folder).f_frsize
            for name in files:
                run.remove(name)
            filler = fill(folder, (first + block - 1) // block * block)
            check_refused(run, arguments, SPACE)
            os.unlink(filler)
            run.ffd(*arguments)
            for name in files:
                run.remove(name)


@case
def full_for_what_comes_after_the_mesh(run):
    """Report and depfile on a full disk, the mesh elsewhere: the old ones stay."""
    start(run)
    for folder in disks(run):
        run.write("disk/r.json", '{"format": "ffd-report"}')
        run.write("disk/d", "b.obj: a.obj\n")
        filler = fill(folder)
        for n, (option, name) in enumerate((("--report", "r.json"), ("--report", "new.json"), ("--depfile", "d"), ("--depfile", "new"))):
            check_refused(run, ["deform", "cube.obj", f"b{n}.obj", "-l", "l.json", "--force", option, f"disk/{name}"], SPACE)
        # Without space for the report nothing is begun. If there is some, but not for the mesh, the report says so.
        run.ffd("deform", "a.obj", "disk/b.obj", "-l", "l.json", "--report", "disk/r.json", code=IO)
        os.unlink(filler)
        filler = fill(folder, 20000)
        run.ffd("deform", "a.obj", "disk/b.obj", "-l", "l.json", "--report", "disk/r.json", code=IO)
        equal(sorted(run.names("disk")), sorted(["filler", "r.json", "d"] + [n for n in run.names("disk") if n == "lost+found"]))
        check(SPACE in json.loads(run.read("disk/r.json"))["jobs"][0]["error"], run.read("disk/r.json"))
        os.unlink(filler)


@case
def no_file_takes_the_place_of_a_mount(run):
    """No file takes the place of a mount: OUT, report and depfile are refused before any work."""
    start(run)
    for name, content in (("b.obj", "old"), ("r.json", '{"format": "ffd-report"}'), ("d", "b.obj: a.obj\n")):
        run.write(name, content)
        command("mount", "--bind", run.path(name), run.path(name))
    try:
        before = run.names()
        for arguments, name in ((["b.obj", "--force"], "b.obj"), (["c.obj", "--report", "r.json"], "r.json"),
                                (["c.obj", "--depfile", "d"], "d")):
            run.ffd("deform", "cube.obj", *arguments, "-l", "l.json", code=IO,
                    err=f"{name}: cannot be replaced: it is mounted here, or immutable")
        equal(run.names(), before)
        equal(run.text("b.obj"), "old")
    finally:
        for name in ("b.obj", "r.json", "d"):
            command("umount", run.path(name))


@case
def full_for_the_rest_of_a_report(run):
    """What does not fit whole is not there: the report is whole JSON of the jobs before."""
    start(run)
    run.write("m.jsonl", "".join(f'{{"in": "cube.obj", "lattice": "l.json", "out": "o{i}.obj"}}\n' for i in range(60)))
    for folder in disks(run):
        for name in ("r.json", "r.jsonl"):
            filler = fill(folder, 20000)
            done = run.ffd("batch", "m.jsonl", "--force", "-j", "2", "--journal", "j", "--report", f"disk/{name}", code=IO)
            check(SPACE in done.err[0], done.err)
            text = run.text(f"disk/{name}")
            jobs = json.loads(text)["jobs"] if name == "r.json" else [json.loads(line) for line in text.splitlines()]
            check(0 < len(jobs) < 60 and all(job["status"] == "ok" for job in jobs), name, len(jobs))
            os.unlink(filler)
            run.remove(f"disk/{name}")
        run.remove("j")


@case
def full_for_an_image(run):
    start(run)
    asset = json.loads(run.read("a.gltf"))
    asset["images"] = [{"uri": "pictures/p.png"}]
    run.write("m/a.gltf", asset)
    run.write("m/" + asset["buffers"][0]["uri"], run.read(asset["buffers"][0]["uri"]))
    run.write("m/pictures/p.png", PNG + b"p" * 49992)
    for folder in disks(run):
        filler = fill(folder, 20000)
        check_refused(run, ["deform", "m/a.gltf", "disk/b.gltf", "-l", "l.json"], SPACE)
        os.unlink(filler)
        run.ffd("deform", "m/a.gltf", "disk/b.gltf", "-l", "l.json")
        equal(len(run.read("disk/pictures/p.png")), 50000)


@case
def no_room_for_a_name(run):
    """Every inode is taken: the temporary file cannot even be made."""
    start(run)
    for folder in disks(run):
        run.write("disk/b.obj", "old")
        count = 0
        with contextlib.suppress(OSError):
            while True:
                run.write(f"disk/{count}", "")
                count += 1
        check(5 < count < 70, count)
        for out in ("b.obj", "c.obj"):
            check_refused(run, ["deform", "cube.obj", f"disk/{out}", "-l", "l.json", "--force"], SPACE)


@case
def equal_outputs_on_a_full_disk(run):
    """To compare, the output is written first: if there is no space for it the old one stays too."""
    start(run)
    for folder in disks(run):
        run.ffd("deform", "a.obj", "disk/b.obj", "-l", "l.json")
        filler = fill(folder)
        check_refused(run, ["deform", "a.obj", "disk/b.obj", "-l", "l.json", "--if-changed"], SPACE)
        os.unlink(filler)
        run.ffd("deform", "a.obj", "disk/b.obj", "-l", "l.json", "--if-changed")


@case
def a_disk_for_reading_only_is_exit_3(run):
    start(run)
    for folder in disks(run):
        for files, arguments in commands():
            for name in files:
                run.write(name, "" if name.endswith(".d") else "old")
        os.makedirs(os.path.join(folder, "new"))
        command("mount", "-o", "remount,bind,ro", folder)
        for _, arguments in commands():
            check_refused(run, with_force(arguments), NO_WRITING)
            check_refused(run, [word.replace("disk/", "disk/new/" if word == "disk/points" else "disk/new-") for word in arguments],
                          NO_WRITING)
        check_refused(run, ["deform", "cube.obj", "--out-dir", "disk", "-l", "l.json"], NO_WRITING)


if "FFD_TEST_NAMESPACE" not in os.environ:
    enter_namespace()
try:
    main()
except SystemExit as end:
    if end.code or not not_mounted:
        raise
    print("SKIP: mounts:", "; ".join(sorted(not_mounted)))
    sys.exit(SKIPPED)
