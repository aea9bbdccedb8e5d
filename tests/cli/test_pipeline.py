#!/usr/bin/env python3
"""A step of a build: depfiles as real make and ninja read them, and outputs that stay where nothing changed."""
import json
import os
import shlex
import subprocess

from harness import (CUBE, CUBE_CORNERS, FFD, IO, NO, PNG, SECONDS, USAGE, case, check, equal, glb, gltf_json, lattice, main)

UP = lattice(moves=[{"by": [0, 0, 0.5]}])
# What both tools can read: blanks, what either gives a meaning, backslashes.
AWKWARD = "a b#c$d\\e (1),[2] @x~ \\ é:f"


def tool(run, *command):
    done = subprocess.run(command, cwd=run.folder, capture_output=True, text=True, timeout=SECONDS, check=False)
    equal(done.returncode, 0, f"{command}: {done.stdout}{done.stderr}")
    return done.stdout


def touch(run, name):
    """Gives a file the time of now, by the clock that stamps files: time.time() may be some milliseconds ahead, and
    ninja 1.12 compares with the start of its step."""
    os.utime(run.path(name))


def age(run):
    """Makes all files older than what comes next, in their order."""
    for folder, _, names in os.walk(run.folder):
        for name in names:
            path = os.path.join(folder, name)
            info = os.stat(path)
            os.utime(path, ns=(info.st_atime_ns - 10 ** 10, info.st_mtime_ns - 10 ** 10))


def gltf(run, name, buffers=2, image=None):
    """A model of several buffers, each beside it."""
    asset, data = gltf_json(CUBE_CORNERS)
    folder = os.path.dirname(name)
    asset["buffers"] = []
    for b in range(buffers):
        asset["buffers"].append({"byteLength": len(data), "uri": f"part%20{b}.bin"})
        run.write(os.path.join(folder, f"part {b}.bin"), data)
        if b:
            asset["bufferViews"].append({"buffer": b, "byteOffset": 0, "byteLength": len(data)})
            asset["accessors"].append({**asset["accessors"][0], "bufferView": b})
            asset["meshes"].append({"primitives": [{"attributes": {"POSITION": b}, "mode": 0}]})
            asset["nodes"].append({"mesh": b})
            asset["scenes"][0]["nodes"].append(b)
    if image:
        asset["images"] = [{"uri": image}, {"uri": "missing.png"}]
        run.write(os.path.join(folder, image), PNG + b"a picture")
    run.write(name, asset)


def rules(text):
    """The rules of a depfile without anything to be escaped."""
    lines = text.split("\n")
    equal(lines[-1], "")
    return {line.split(": ")[0]: line.split(": ")[1].split(" ") for line in lines[:-1]}


@case
def what_a_depfile_lists(run):
    run.write("a.obj", CUBE)
    run.write("l.json", UP)
    run.write("k.json", UP)
    run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "-l", "k.json", "--depfile", "b.d")
    equal(run.text("b.d"), "b.obj: a.obj l.json k.json\n")
    run.ffd("embed", "a.obj", "-l", "l.json", "-o", "e.npy")
    run.ffd("deform", "./a.obj", "c.stl", "-l", "l.json", "--embedding", "e.npy", "--depfile=c.d", lines=1)
    equal(run.text("c.d"), "c.stl: ./a.obj l.json e.npy\n")
    run.write("a.glb", glb(*gltf_json(CUBE_CORNERS)))
    run.ffd("deform", "a.glb", "b.glb", "-l", "l.json", "--depfile", "-", out="b.glb: a.glb l.json\n")


@case
def buffers_and_images(run):
    run.write("l.json", UP)
    run.folder_of("out")
    gltf(run, "m/a.gltf", image="p.png")
    missing = 'm/a.gltf: the image "missing.png" is missing and was not copied'
    buffers = ["m/part\\ 0.bin", "m/part\\ 1.bin"]
    run.ffd("deform", "m/a.gltf", "out/a.gltf", "-l", "l.json", "--depfile", "d", err=missing)
    outputs = "out/a.gltf out/a.bin out/a-1.bin out/p.png"
    equal(run.text("d"), " ".join([outputs + ": m/a.gltf", *buffers, "m/p.png", "l.json\n"]))
    # Also where the copy is there already.
    run.ffd("deform", "m/a.gltf", "out/a.gltf", "-l", "l.json", "--depfile", "d", "--force", err=missing)
    equal(run.text("d"), " ".join([outputs + ": m/a.gltf", *buffers, "m/p.png", "l.json\n"]))
    # The image's bytes are in no file that is written.
    for out, more in (("out/b.gltf", ["--resources", "reference"]), ("m/b.gltf", []), ("out/b.obj", [])):
        run.ffd("deform", "m/a.gltf", out, "-l", "l.json", "--depfile", "d", "-q", *more)
        beside = [out.replace(".gltf", end) for end in (".bin", "-1.bin") if out.endswith(".gltf")]
        equal(run.text("d"), " ".join([*[out, *beside][:-1], [out, *beside][-1] + ": m/a.gltf", *buffers, "l.json\n"]))


@case
def streams_are_no_files(run):
    run.write("a.obj", CUBE)
    run.write("l.json", UP)
    run.ffd("deform", "-", "b.obj", "--input-format", "obj", "-l", "l.json", "--depfile", "d", stdin=CUBE.encode())
    equal(run.text("d"), "b.obj: l.json\n")
    run.ffd("deform", "/dev/stdin", "c.obj", "--input-format", "obj", "-l", "l.json", "--depfile", "d", stdin=CUBE.encode())
    equal(run.text("d"), "c.obj: l.json\n")
    run.ffd("deform", "a.obj", "e.obj", "-l", "-", "--depfile", "d", stdin=json.dumps(UP).encode())
    equal(run.text("d"), "e.obj: a.obj\n")


@case
def several_meshes_have_a_rule_each(run):
    run.write("a.obj", CUBE)
    run.write("b.obj", CUBE)
    run.write("bad.obj", "v 1 x\n")
    run.write("l.json", UP)
    run.folder_of("out")
    run.ffd("deform", "a.obj", "b.obj", "--out-dir", "out", "-l", "l.json", "--depfile", "d")
    equal(rules(run.text("d")), {"out/a.obj": ["a.obj", "l.json"], "out/b.obj": ["b.obj", "l.json"]})
    # Where a mesh fails an old depfile stays.
    run.ffd("deform", "a.obj", "bad.obj", "--out-dir", "out", "-l", "l.json", "--force", "--depfile", "d", code=NO, lines=1)
    equal(rules(run.text("d")), {"out/a.obj": ["a.obj", "l.json"], "out/b.obj": ["b.obj", "l.json"]})


@case
def a_failure_leaves_the_old_depfile(run):
    run.write("a.obj", CUBE)
    run.write("far.obj", CUBE + "v 9 9 9\np 9\n")
    run.write("l.json", UP)
    run.write("bad.json", "{")
    run.write("d", "b.obj: old.obj\n")
    run.ffd("deform", "a.obj", "b.obj", "-l", "bad.json", "--depfile", "d", code=4)
    run.ffd("deform", "far.obj", "b.obj", "-l", "l.json", "--fail-on", "outside", "--depfile", "d", code=NO, lines=1)
    run.ffd("deform", "a.obj", "none/b.obj", "-l", "l.json", "--depfile", "d", code=IO)
    run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "--depfile", "none/d", code=IO)
    run.ffd("deform", "a.obj", "c.obj", "-l", "l.json", "--depfile", "/dev/full", code=IO)
    equal(run.text("d"), "b.obj: old.obj\n")
    check(not run.exists("b.obj"), "an output without its depfile")


@case
def a_depfile_replaces_depfiles_only(run):
    run.write("a.obj", CUBE)
    run.write("l.json", json.dumps(UP, separators=(",", ": ")))
    others = {"other.obj": "#made: by hand\n", "other.ply": "ply\n", "other.json": '{"format": 1}', "pretty.json": '{\n  "a": 1}',
              "other.txt": "a b: c\nd e\n", "other.glb": b"glTF\2\0\0\0"}
    for name, content in others.items():
        run.write(name, content)
        run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "--force", "--depfile", name, code=IO,
                err=f"{name}: exists and is not a depfile: it is not replaced")
        equal(run.read(name), content if isinstance(content, bytes) else content.encode())
    for name in ("a.obj", "b.obj"):
        run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "--depfile", name, code=USAGE)
    run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "--depfile", "l.json", code=IO)
    run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "--depfile", "d", "--report", "d", code=USAGE)
    run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "--depfile", "-", "--report", "-", code=USAGE)
    run.ffd("deform", "a.obj", "--in-place", "-l", "l.json", "--depfile", "d", code=USAGE)
    run.ffd("deform", "a.obj", "-", "--output-format", "obj", "-l", "l.json", "--depfile", "d", code=USAGE)
    run.folder_of("out")
    run.ffd("deform", "a.obj", "--out-dir", "out", "-l", "l.json", "--depfile", "out/a.obj", code=IO)
    equal(run.names("out"), [])
    check(not run.exists("b.obj") and not run.exists("d"), "something was written")
    for old in ("", "x: y\n", "a\\ b: c \\\n d\n", "x:\n"):
        run.write("d", old)
        run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "--force", "--depfile", "d")
        equal(run.text("d"), "b.obj: a.obj l.json\n")


@case
def names_that_no_depfile_can_hold(run):
    run.write("l.json", UP)
    run.write("a\nb.obj", CUBE)
    run.ffd("deform", "a\nb.obj", "b.obj", "-l", "l.json", "--depfile", "d", code=IO,
            err="a?b.obj: cannot be written in a depfile: its name has a line break")
    check(not run.exists("b.obj") and not run.exists("d"), "something was written")
    for name in ("it's.obj", "a=b.obj", "a\\#b.obj", "a\\:b.obj", "50%.obj", "a|b.obj"):
        run.write(name, CUBE)
        run.ffd("deform", name, "b.obj", "-l", "l.json", "--depfile", "d", "--force",
                err=f'{name}: the depfile names "{name}": make or ninja cannot read such a name')
    equal(run.text("d"), "b.obj: a|b.obj l.json\n")


@case
def check_takes_the_options(run):
    run.write("a.obj", CUBE)
    run.write("l.json", UP)
    run.ffd("check", "a.obj", "-l", "l.json", "--depfile", "d", "--if-changed", "-q")
    equal(run.names(), ["a.obj", "l.json"])


def prepare_step(run):
    """A step with awkward names: a model, its buffers, an image, two lattices, an embedding."""
    names = {"in": f"in {AWKWARD}", "out": f"out {AWKWARD}"}
    gltf(run, f"{names['in']}/m.gltf", image="p.png")
    run.folder_of(names["out"])
    run.write(f"{AWKWARD}.json", UP)
    mesh, out, lattice_name = f"{names['in']}/m.gltf", f"{names['out']}/m.gltf", f"{AWKWARD}.json"
    run.ffd("embed", mesh, "-l", lattice_name, "-o", "e.npy")
    inputs = [mesh, *(f"{names['in']}/{name}" for name in ("part 0.bin", "part 1.bin", "p.png")), lattice_name, "e.npy"]
    command = shlex.join([FFD, "deform", mesh, out, "-l", lattice_name, "--embedding", "e.npy", "--depfile", "step.d",
                          "--force", "-q"])
    return inputs, out, command


def check_rebuilds(run, inputs, build):
    """build() runs the tool and tells whether the step was run."""
    check(build(), "nothing was built at first")
    check(not build(), "nothing was touched, and something was built")
    for name in inputs:
        age(run)
        touch(run, name)
        check(build(), f"{name} was touched, and nothing was built")
        check(not build(), f"again, after {name} was touched")
    age(run)
    run.write("unrelated", "")
    check(not build(), "something unrelated was touched")


@case
def ninja_rebuilds_what_has_changed(run):
    """With deps: without it ninja refuses targets that it does not know."""
    inputs, out, command = prepare_step(run)

    def quoted(text):
        return text.replace("$", "$$").replace(" ", "$ ").replace(":", "$:")

    run.write("build.ninja", f"rule step\n  command = {command.replace('$', '$$')}\n  depfile = step.d\n  deps = gcc\n"
                             f"build {quoted(out)}: step\n")

    def build():
        return "no work to do" not in tool(run, "ninja")

    check_rebuilds(run, inputs, build)


@case
def make_rebuilds_what_has_changed(run):
    inputs, out, command = prepare_step(run)
    quoted = out.replace("\\ ", "\\\\ ").replace("$", "$$").replace(" ", "\\ ").replace("#", "\\#").replace(":", "\\:")
    run.write("Makefile", f"{quoted}:\n\t{command.replace('$', '$$')}\n-include step.d\n")

    def build():
        return FFD in tool(run, "make")

    check_rebuilds(run, inputs, build)


def times(run, *names):
    return [os.stat(run.path(name)).st_mtime_ns for name in names]


@case
def equal_outputs_stay(run):
    run.write("a.obj", CUBE)
    run.write("l.json", UP)
    for out in ("b.obj", "b.ply", "b.off", "b.stl", "b.glb", "b.gltf"):
        names = [out, "b.bin"] if out == "b.gltf" else [out]
        run.ffd("deform", "a.obj", out, "-l", "l.json", "--if-changed", "-q")
        age(run)
        before = times(run, *names)
        run.ffd("deform", "a.obj", out, "-l", "l.json", "--if-changed", "-q")
        equal(times(run, *names), before, out)
        run.ffd("deform", "a.obj", out, "-l", "l.json", code=IO)
        run.ffd("deform", "a.obj", out, "-l", "l.json", "--force", "-q")
        check(times(run, *names) != before, f"{out}: --force left it")
    text = run.read("b.obj")
    for changed in (text + b"\n", text[:-1], b"", text[:-2] + b"9\n"):
        run.write("b.obj", changed)
        run.ffd("deform", "a.obj", "b.obj", "-l", "l.json", "--if-changed")
        equal(run.read("b.obj"), text)
    run.check_no_leftovers()


@case
def a_model_and_its_buffers_stay_together(run):
    run.write("l.json", UP)
    run.folder_of("out")
    gltf(run, "m/a.gltf", image="p.png")
    files = ["out/a.gltf", "out/a.bin", "out/a-1.bin"]

    def deform():
        run.ffd("deform", "m/a.gltf", "out/a.gltf", "-l", "l.json", "--if-changed", lines=1)

    deform()
    first = [run.read(name) for name in files]
    age(run)
    before = times(run, *files, "out/p.png")
    deform()
    equal(times(run, *files, "out/p.png"), before)
    for name in files:
        whole = run.read(name)
        run.write(name, whole[:-1] + bytes([whole[-1] ^ 1]))
        age(run)
        before = times(run, *files)
        deform()
        equal([run.read(name) for name in files], first)
        check(all(a != b for a, b in zip(times(run, *files), before)), f"{name} was changed, and a file stayed")
    run.remove("out/a.bin")
    deform()
    equal([run.read(name) for name in files], first)


@case
def what_stays_stays_as_it_is(run):
    """Links, permission bits, a folder that nobody may write, in place, many at once, standard output."""
    run.write("a.obj", CUBE)
    run.write("l.json", UP)
    run.write("same.json", lattice())
    run.ffd("deform", "a.obj", "b.obj", "-l", "l.json")
    os.link(run.path("b.obj"), run.path("hard.obj"))
    os.symlink("b.obj", run.path("soft.obj"))
    os.chmod(run.path("b.obj"), 0o440)
    age(run)
    before = os.stat(run.path("b.obj"))
    for out in ("b.obj", "hard.obj", "soft.obj"):
        run.ffd("deform", "a.obj", out, "-l", "l.json", "--if-changed")
    after = os.stat(run.path("b.obj"))
    equal((after.st_ino, after.st_mode, after.st_mtime_ns, after.st_nlink),
          (before.st_ino, before.st_mode, before.st_mtime_ns, before.st_nlink))
    inputs = times(run, "a.obj")
    run.ffd("deform", "a.obj", "--in-place", "-l", "same.json", "--if-changed")
    equal(times(run, "a.obj"), inputs, "in place")
    run.folder_of("out")
    run.ffd("deform", "a.obj", "--out-dir", "out", "-l", "l.json", "--if-changed")
    age(run)
    before = times(run, "out/a.obj")
    run.ffd("deform", "a.obj", "b.obj", "--out-dir", "out", "-l", "l.json", "--if-changed")
    equal(times(run, "out/a.obj"), before)
    equal(run.ffd("deform", "a.obj", "-", "--output-format", "obj", "-l", "l.json", "--if-changed").out, run.read("b.obj"))
    # A run that fails changes nothing either.
    run.write("far.obj", CUBE + "v 9 9 9\np 9\n")
    before = times(run, "b.obj")
    run.ffd("deform", "far.obj", "b.obj", "-l", "l.json", "--if-changed", "--outside", "error", code=5)
    equal(times(run, "b.obj"), before)
    run.ffd("deform", "a.obj", "a.obj", "-l", "l.json", "--if-changed", code=IO)


@case
def ninja_stops_where_nothing_changed(run):
    """With restat the steps that come after are not run for an output that stayed."""
    run.write("a.obj", CUBE)
    run.write("l.json", UP)
    run.write("build.ninja", f"rule step\n  command = {shlex.quote(FFD)} deform a.obj $out -l l.json --if-changed --depfile $out.d -q\n"
                             "  depfile = $out.d\n  restat = 1\nrule next\n  command = cat $in >> $out\n"
                             "build b.obj: step\nbuild c: next b.obj\n")
    tool(run, "ninja")
    equal(run.read("c"), run.read("b.obj"))
    for text in (CUBE, CUBE + "# and a comment\n"):
        age(run)
        run.write("a.obj", text)
        check("no work to do" not in tool(run, "ninja"), "the step was not run")
        check("no work to do" in tool(run, "ninja"), "the step was run again")
        equal(run.text("c").count("# a cube"), 1 + (text != CUBE), "runs of the next step")


main()
