#!/usr/bin/env python3
"""Help, version, and everything that is a mistake on the command line (exit 2, one line, before any work)."""
import os
import re
import subprocess

from harness import CUBE, LIMIT, SECONDS, USAGE, case, check, equal, lattice, main

COMMANDS = ["deform", "check", "embed", "animate", "fit", "compare", "info", "view", "edit", "lattice new", "lattice refine", "lattice set", "lattice convert", "report merge",
            "report junit"]
OPTIONS = {
    "deform": {"--lattice", "--set", "--shared-box", "--out-dir", "--outside", "--falloff", "--seam", "--snap", "--blocks", "--normals", "--rig", "--only", "--rigid", "--uniform", "--space", "--embedding", "--weight", "--as-morph", "--fail-on",
               "--resources", "--report", "--report-stable", "--threads", "--isa", "--in-place", "--force", "--if-changed", "--depfile", "--input-format", "--memory", "--strict", "--allow-extension",
               "--output-format", "--morph", "--clip", "--timeout", "--time"},
    "check": {"--picture", "--camera", "--up", "--no-cage", "--lattice", "--set", "--shared-box", "--outside", "--falloff", "--seam", "--snap", "--blocks", "--normals", "--rig", "--only", "--rigid", "--uniform", "--space", "--embedding", "--weight", "--as-morph", "--fail-on", "--resources",
              "--report", "--report-stable", "--threads", "--isa", "--in-place", "--force", "--if-changed", "--depfile", "--input-format", "--memory", "--strict", "--allow-extension", "--timeout", "--time"},
    "embed": {"--lattice", "--set", "--output", "--status", "--space", "--snap", "--threads", "--force", "--input-format", "--memory", "--strict", "--allow-extension"},
    "jacobian": {"--lattice", "--output", "--wrt", "--components", "--of", "--times", "--transposed", "--check", "--set", "--outside", "--falloff", "--seam", "--snap", "--space",
                 "--only", "--weight", "--threads", "--isa", "--memory", "--allow-extension", "--strict", "--input-format", "--force", "--time"},
    "animate": {"--lattice", "--name", "--tolerance", "--targets", "--fps", "--set", "--outside", "--falloff", "--seam", "--snap", "--normals", "--space", "--only", "--weight", "--report",
                "--report-stable", "--resources", "--depfile", "--force", "--if-changed", "--threads", "--isa", "--memory", "--timeout", "--allow-extension", "--strict"},
    "fit": {"--output", "--pairs", "--handles", "--lattice", "--size", "--degree", "--knots", "--margin", "--axes", "--cover", "--smooth", "--within", "--weights", "--symmetric",
            "--robust", "--fail-on", "--only", "--space", "--snap", "--set", "--time", "--report", "--report-stable", "--force", "--threads", "--isa", "--memory", "--timeout",
            "--allow-extension", "--strict", "--input-format"},
    "compare": {"--recursive", "--tolerance", "--normal-tolerance", "--json", "--input-format", "--memory", "--strict"},
    "info": {"--json", "--parts", "--set", "--input-format", "--memory", "--strict"},
    "view": {"--output", "--morph", "--size", "--camera", "--up", "--no-cage", "--color", "--frames", "--animation", "--full", "--lattice", "--set", "--shared-box", "--outside", "--falloff", "--seam", "--snap", "--blocks", "--normals", "--rig", "--only", "--rigid", "--uniform", "--space", "--embedding", "--weight",
             "--as-morph", "--fail-on", "--resources", "--report", "--report-stable", "--threads", "--isa", "--in-place", "--force", "--if-changed", "--depfile", "--input-format", "--memory", "--strict",
             "--allow-extension", "--timeout", "--time"},
    "edit": {"--lattice", "--size", "--degree", "--knots", "--margin", "--output", "--only", "--outside", "--falloff", "--snap", "--space", "--set", "--time", "--up", "--full", "--force",
             "--threads", "--memory", "--allow-extension", "--strict", "--input-format"},
    "lattice new": {"--output", "--size", "--degree", "--knots", "--margin", "--spacing", "--shape", "--axis", "--axes", "--only",
                    "--force", "--input-format", "--memory", "--strict", "--allow-extension"},
    "lattice refine": {"--output", "--size", "--insert", "--degree", "--set", "--mesh", "--only", "--space", "--threads", "--force", "--memory",
                       "--strict", "--report", "--report-stable", "--time"},
    "lattice set": {"--output", "--block", "--deformed", "--deformed-offsets", "--strength", "--blend", "--add", "--mirror", "--symmetrize", "--transform", "--move", "--rotate", "--scale",
                    "--invert", "--seam", "--set", "--mesh", "--only", "--space", "--threads", "--force", "--memory", "--strict", "--time"},
    "lattice convert": {"--output", "--block", "--part", "--size", "--degree", "--order", "--set", "--mesh", "--only", "--space", "--threads", "--force", "--memory", "--strict", "--time"},
    "report merge": {"--output", "--interleave", "--force"},
    "report junit": {"--output", "--force"},
}
COMMON = {"--quiet", "--verbose", "--help"}


def files(run):
    run.write("a.obj", CUBE)
    run.write("l.json", lattice(moves=[{"by": [1, 0, 0]}]))
    return ["deform", "a.obj", "b.obj", "-l", "l.json"]


def refused(run, *arguments, says=None):
    """A usage error that names what is wrong and changes nothing."""
    before = run.names()
    done = run.ffd(*arguments, code=USAGE)
    if says:
        check(says in done.err[0], f"{arguments}: {done.err[0]!r} does not say {says!r}")
    equal(run.names(), before, f"{arguments}: the folder")


@case
def the_version_is_three_numbers(run):
    check(re.fullmatch(r"ffd \d+\.\d+\.\d+( \([0-9a-f]{12}\+?\))?\n", run.ffd("--version").text), "the version")
    refused(run, "--version", "x")


@case
def help_is_data(run):
    overview = run.ffd("help").text
    for command in COMMANDS:
        check(f"ffd {command}" in overview, f"help does not list {command}")
    for arguments in (["--help"], ["-h"], ["help", "help"], ["help", "--help"]):
        equal(run.ffd(*arguments).text, overview, str(arguments))


@case
def help_of_each_command(run):
    for command in COMMANDS:
        words = command.split()
        text = run.ffd("help", *words).text
        for arguments in ([*words, "--help"], [*words, "-h"], [*words, "a", "-h", "--bogus"]):
            equal(run.ffd(*arguments).text, text, str(arguments))
        equal(set(re.findall(r"^ +(?:-\w, )?(--[\w-]+)", text, re.M)), OPTIONS[command] | COMMON, command)
        check(f"usage: ffd {command} " in text, f"{command}: no usage line")
    for command in [*COMMANDS, "batch", "jacobian"]:
        lines = run.ffd("help", *command.split()).text.splitlines()
        check(all(len(line) < 130 for line in lines), f"{command}: a line too long")
    for group, commands in (("lattice", ["new", "refine", "set", "convert"]), ("report", ["merge", "junit"])):
        equal(run.ffd("help", group).text, "".join(run.ffd("help", group, command).text for command in commands))
        equal(run.ffd(group, "--help").text, run.ffd("help", group).text)


@case
def without_a_command_usage_is_told(run):
    refused(run)


@case
def an_unknown_command_gets_the_nearest_one_proposed(run):
    for word, nearest in (("defrom", "deform"), ("emebd", "embed"), ("comp", "compare"), ("inf", "info"), ("hlep", "help")):
        refused(run, word, says=nearest)
        refused(run, "help", word, says=nearest)
    refused(run, "lattice", says="lattice new")
    refused(run, "lattice", "nwe", "a.obj", says="lattice new")
    refused(run, "report", says="report merge")
    refused(run, "report", "junt", "a.json", says="report junit")
    refused(run, "report", "mrge", "a.json", says="report merge")
    refused(run, "help", "deform", "x", says="x")
    refused(run, "DEFORM", says="DEFORM")
    for word in ("", "mesh"):
        refused(run, word, says=f'unknown command "{word}" (ffd help lists the known ones)')
    for word in ("weave", ""):
        refused(run, "lattice", word, says=f'unknown command "lattice {word}" (ffd help lists the known ones)')
    refused(run, "--xyz", says="unknown option --xyz (options follow a command)")
    for typed, nearest in (("repot", "report merge"), ("latice", "lattice new"), ("bach", "batch")):
        refused(run, typed, says=f"nearest: {nearest}")


@case
def an_unknown_option_gets_the_nearest_one_proposed(run):
    work = files(run)
    for option, nearest in (("--latice", "--lattice"), ("--thread", "--threads"), ("--outdir", "--out-dir"),
                            ("--forse", "--force"), ("--report_stable", "--report-stable")):
        refused(run, *work, option, says=f"nearest: {nearest}")
        refused(run, *work, f"{option}=1", says=f"nearest: {nearest}")
    refused(run, *work, "-x", says="-x")
    refused(run, *work, "-o", "x", says="unknown option -o: OUT is the second argument")
    refused(run, "batch", "m.jsonl", "-o", "x", says="unknown option -o: outputs are named in the manifest")
    refused(run, "info", "a.obj", "-m", says="unknown option -m (nearest: --memory)")
    refused(run, "info", "a.obj", "-s", says="unknown option -s (--help lists the known ones)")
    refused(run, *work, "-qx", says="-x")
    refused(run, "--bogus", says="--bogus")
    refused(run, "--verson", says="--version")
    refused(run, "-l", "l.json", says="-l")


@case
def options_of_later_versions_are_absent(run):
    work = files(run)
    for option in ("--refine=0.1",):
        refused(run, *work, option, says="unknown option")


@case
def values_that_an_option_does_not_take_are_refused(run):
    work = files(run)
    for option, value in (("--outside", "kep"), ("--outside", "KEEP"), ("--normals", ""), ("--space", "world"),
                          ("--resources", "move"), ("--memory", ""), ("--memory", "0"), ("--memory", "M"),
                          ("--memory", "4T"), ("--memory", "-1G"), ("--memory", "1e30"), ("--memory", "4 G"), ("--memory", "nan"),
                          ("--memory", "1" * 5000), ("--input-format", "fbx"), ("--output-format", ""),
                          ("--threads", "0"), ("--threads", "-1"), ("--threads", "two"), ("--threads", "2x"),
                          ("--falloff", "0"), ("--falloff", "-1"), ("--falloff", "inf"), ("--falloff", "nan"),
                          ("--falloff", "1m"), ("--falloff", ""), ("--snap", "-1"), ("--snap", "r"), ("--snap", "1" * 5000 + "x"), ("--embedding", ""), ("--seam", ""), ("--seam", "C3"), ("--seam", "C1:"), ("--seam", "C1:x+"), ("--rigid", ""), ("--rigid", "component:x"), ("--uniform", "wheel"), ("--uniform", "node:"), ("--weight", ""), ("--weight", "1-"), ("--weight", "mask"), ("--weight", "color:x"), ("--fail-on", ""),
                          ("--fail-on", "fold"), ("--fail-on", "folds,"), ("--fail-on", "folds,,outside"),
                          ("--fail-on", "folds outside"), ("--fail-on", "OUTSIDE"), ("--fail-on", "x" * 5000),
                          ("--threads", "1.5"), ("--threads", " 2"), ("--threads", "+2"), ("--threads", ""),
                          ("--only", ""), ("--only", "node"), ("--only", "node:"), ("--only", "nodes:x"), ("--only", ":"),
                          ("--only", "x" * 5000), ("--threads", "99999999999999999999"), ("--lattice", ""), ("--report", ""), ("--out-dir", ""), ("--depfile", "")):
        refused(run, *work, option, value, says=option)
        refused(run, *work, f"{option}={value}", says=option)
    refused(run, *work, "-j", "x", says='"x"')
    refused(run, *work, "-j", "1025", says='"1025"')
    run.ffd(*work, "-j", "1024", "--force")
    refused(run, *work, "-jx", says='"x"')
    for option in ("--force", "--in-place", "--report-stable", "--quiet", "--verbose", "--help"):
        refused(run, *work, f"{option}=yes", says=option)
    for option in ("--lattice", "-l", "--threads", "-j", "--outside", "--report", "--out-dir", "--falloff", "--seam", "--snap", "--embedding",
                   "--weight", "--fail-on"):
        refused(run, *work, option, says=option)


@case
def the_help_has_the_words_of_each_setting(run):
    """They stand in the table of settings, and in the options of each command that has them."""
    work, found = files(run), 0
    for command in ("deform", "batch", "check", "view", "jacobian", "embed"):
        for option, words in re.findall(r"^ +(?:-\w, )?(--[a-z-]+) ((?:[a-z0-9]+\|)+[a-z0-9]+)", run.ffd("help", command).text, re.M):
            refusal = run.ffd(*work, option, "none of them", code=USAGE).err[0]
            if " is not one of " in refusal:
                equal(sorted(words.split("|")), sorted(refusal.split(" is not one of ")[1].split(", ")), f"{command} {option}")
                found += 1
    equal(found, 6 + 6 + 6 + 6 + 3 + 1)


@case
def values_of_other_commands(run):
    files(run)
    for value in ("-1", "nan", "inf", "x", "", "1e999", "0x1", " 1", "1 ", "1,5", "-0.001", "1e"):
        refused(run, "compare", "a.obj", "a.obj", "--tolerance", value, says="--tolerance")
        refused(run, "compare", "a.obj", "a.obj", "--tolerance", value + "r", says="--tolerance")
        refused(run, "compare", "a.obj", "a.obj", "--normal-tolerance", value, says="--normal-tolerance")
        refused(run, "lattice", "new", "a.obj", "-o", "n.json", "--margin", value, says="--margin")
    for value in ("r", "1rr", "1 r", "1R", "1%", "1" * 600 + "r"):
        refused(run, "compare", "a.obj", "a.obj", "--tolerance", value, says="--tolerance")
    for option, bad in (("--size", ["4,4", "4,4,4,4", "4,4,x", "1,4,4", "0,4,4", "-4,4,4", "4;4;4", "", "4,,4", "4,4,4,",
                                    "4.0,4,4", "4, 4,4"]),
                        ("--degree", ["3,3", "0,3,3", "10,3,3", "x", ""]),
                        ("--knots", ["clamped,open", "closed,open,round", "", "clamped clamped clamped"]),
                        ("--spacing", ["even", ""]), ("--shape", ["sphere", ""]), ("--axes", ["main", ""]),
                        ("--axis", ["w", "0,0,0", "1,2", "1,2,3,4", "x,y,z", "nan,0,1", ""])):
        for value in bad:
            refused(run, "lattice", "new", "a.obj", "-o", "n.json", "--shape", "cylinder", option, value, says=option)


@case
def values_that_do_not_fit_each_other_are_named_by_their_options(run):
    files(run)
    for options, message in (
            (["--shape", "cylinder", "--size", "2,2,2"],
             "--size: 2 control points of degree 1 along v are too few for this angle of the cylinder"),
            (["--degree", "4"], "--degree 4 along u needs --size 5 or more there, not 4"),
            (["--size", "4,3,4", "--degree", "3"], "--degree 3 along v needs --size 4 or more there, not 3"),
            (["--knots", "clamped,closed,open"], "--knots closed: direction v of a box cannot be closed"),
            (["--shape", "cylinder", "--knots", "clamped,open,closed"], "--knots closed: direction w of a cylinder cannot be closed"),
            (["--spacing", "uniform", "--knots", "clamped,open,clamped"],
             "--spacing uniform needs --knots clamped, which direction v does not have"),
            (["--shape", "cylinder", "--spacing", "uniform"], "--spacing uniform is for boxes, not for cylinders")):
        refused(run, "lattice", "new", "a.obj", "-o", "n.json", *options, says=message)
    run.ffd("lattice", "new", "a.obj", "-o", "n.json", "--size", "1000000", code=LIMIT, err=re.compile("^--size: a lattice of 1000000 by "))
    refused(run, "jacobian", "a.obj", "-l", "l.json", "-o", "j.npz", "--of", "1", says="--of: there is no lattice 1: the job has 1,")
    other = "neon" if os.uname().machine in ("x86_64", "i686") else "avx2"
    refused(run, "check", "a.obj", "-l", "l.json", "--isa", other, says=f"--isa: this build or this processor does not support the "
            f"instruction set {other}")


@case
def words_of_deform(run):
    work = files(run)
    refused(run, "deform", says="lattice")
    refused(run, "deform", "a.obj", "b.obj", says="lattice")
    refused(run, "deform", "-l", "l.json", says="IN")
    refused(run, "deform", "a.obj", "-l", "l.json", says="OUT")
    refused(run, *work, "c.obj", says="--out-dir")
    refused(run, "deform", "--out-dir", ".", "-l", "l.json", says="IN")
    refused(run, "deform", "--in-place", "-l", "l.json", says="IN")
    refused(run, "deform", "a.obj", "--in-place", "--out-dir", ".", "-l", "l.json", says="--in-place")
    refused(run, "deform", "a.obj", "--in-place", "--output-format", "obj", "-l", "l.json", says="--output-format")
    refused(run, *work, "--report-stable", says="--report")
    refused(run, *work, "--", "-l", "l.json", says="--out-dir")


@case
def what_needs_what(run):
    work = files(run)
    run.write("b.glb", b"")
    for command in (work, ["check", "a.obj", "-l", "l.json"]):
        refused(run, *command, "--falloff", "1", says="--outside extend")
        refused(run, *command, "--falloff", "1", "--outside", "error", says="--outside extend")
        refused(run, *command, "-l", "l.json", "--embedding", "e.npy", says="-l")
        refused(run, *command, "--embedding", "e.npy", "--report", "e.npy", says="embedding")
        refused(run, *command, "--fail-on", "outsied", says="nearest: outside")
        refused(run, *command, "--fail-on", "folds,mutliple", says="nearest: multiple")
        refused(run, *command, "--fail-on", "folds,edges", says="the gate edges needs a length: edges=LENGTH")
        refused(run, *command, "--fail-on", "folds=3", says='the gate folds takes no value: "folds=3"')
    for rest in (["--in-place"], ["--out-dir", "."]):
        refused(run, "deform", "a.obj", "b.glb", *rest, "-l", "l.json", "--embedding", "e.npy", says="IN")
    refused(run, "check", "a.obj", "b.glb", "-l", "l.json", "--embedding", "e.npy", says="IN")


@case
def words_of_check(run):
    files(run)
    refused(run, "check", says="IN")
    refused(run, "check", "a.obj", says="lattice")
    refused(run, "check", "-l", "l.json", says="IN")
    refused(run, "check", "a.txt", "-l", "l.json", says="a.txt")
    refused(run, "check", "a.obj", "a.txt", "-l", "l.json", says="a.txt")
    refused(run, "check", "-", "-l", "l.json", says="--input-format")
    refused(run, "check", "-", "-", "-l", "l.json", says="once")
    refused(run, "check", "-", "-l", "-", "--input-format", "obj", says="once")
    refused(run, "check", "a.obj", "-l", "l.json", "-l", "-", "--embedding", "-", says="-l")
    refused(run, "check", "a.obj", "-l", "-", "--embedding", "-", says="once")
    refused(run, "check", "a.obj", "-l", "l.json", "--out-dir", ".", says="unknown option")
    refused(run, "check", "a.obj", "-l", "l.json", "--report-stable", says="--report")
    refused(run, "check", "a.obj", "-l", "l.json", "--report", "a.obj", says="mesh")
    refused(run, "check", "a.obj", "-l", "l.json", "--report", "l.json", says="lattice")


@case
def words_of_the_others(run):
    files(run)
    refused(run, "embed", "-l", "l.json", "-o", "e.npy", says="IN")
    refused(run, "embed", "a.obj", "a.obj", "-l", "l.json", "-o", "e.npy", says="IN")
    refused(run, "embed", "a.obj", "-o", "e.npy", says="lattice")
    refused(run, "embed", "a.obj", "-l", "l.json", says="-o")
    refused(run, "embed", "a.obj", "-l", "l.json", "-l", "l.json", "-o", "e.npy", says="--lattice")
    refused(run, "embed", "a.obj", "-l", "l.json", "-o", "e.npy", "--status", "e.npy", says="--status")
    refused(run, "compare", says="A and B")
    refused(run, "compare", "a.obj", says="A and B")
    refused(run, "compare", "a.obj", "a.obj", "a.obj", says="A and B")
    refused(run, "info", says="FILE")
    refused(run, "info", "a.obj", "a.obj", says="FILE")
    refused(run, "lattice", "new", "-o", "n.json", says="MESH")
    refused(run, "lattice", "new", "a.obj", says="-o")
    refused(run, "lattice", "new", "-", "-", "-o", "n.json", says="standard input")
    refused(run, "report", "merge", says="REPORT")
    refused(run, "report", "merge", "-o", "r.json", says="REPORT")
    refused(run, "report", "merge", "-", "a.json", "-", says="once")
    refused(run, "report", "merge", "a.json", "-o", "", says="--output")


@case
def unknown_endings_are_refused(run):
    work = files(run)
    refused(run, "deform", "a.obj", "b.xyz", "-l", "l.json", says="b.xyz")
    refused(run, "deform", "a.obj", "b", "-l", "l.json", says="b: ")
    refused(run, "deform", "a.txt", "b.obj", "-l", "l.json", says="a.txt")
    refused(run, "deform", "a.obj", "c.txt", "--out-dir", ".", "-l", "l.json", says="c.txt")
    refused(run, "embed", "a.txt", "-l", "l.json", "-o", "e.npy", says="a.txt")
    refused(run, "compare", "a.obj", "a.txt", says="a.txt")
    refused(run, "compare", "a", "a.obj", says="a: ")
    refused(run, "info", "a.txt", says="a.txt")
    run.folder_of("meshes/a.obj")
    for name in ("meshes", "meshes/"):
        refused(run, "info", name, says=f"{name}: is a folder: name its meshes, such as meshes/*.obj")
    refused(run, "lattice", "new", "a.txt", "-o", "n.json", says="a.txt")
    refused(run, "lattice", "new", "a.obj", "-o", "n.obj", says="JSON")
    check(run.ffd(*work), "the right words")


@case
def units_of_sizes(run):
    files(run)
    run.write("large.gltf", {
        "asset": {"version": "2.0"}, "nodes": [{"mesh": 0}],
        "accessors": [{"componentType": 5126, "count": 10 ** 9, "type": "VEC3", "min": [0, 0, 0], "max": [0, 0, 0]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}]})
    for size, megabytes in (("300M", 300), ("300000K", 300), ("0.3G", 300), ("300000000", 300), ("1.5G", 1500)):
        run.ffd("deform", "large.gltf", "o.gltf", "-l", "l.json", "--memory", size, code=LIMIT,
                err=re.compile(f" the {megabytes} MB of memory allowed"))


@case
def forms_of_options(run):
    files(run)
    expected = None
    for n, arguments in enumerate((["-l", "l.json"], ["-ll.json"], ["--lattice", "l.json"], ["--lattice=l.json"],
                                   ["-ql", "l.json"], ["-qll.json"], ["-qj2", "-l", "l.json"], ["-j", "2", "-ll.json"],
                                   ["--threads=2", "-ll.json"])):
        run.ffd("deform", *arguments, "a.obj", f"{n}.obj")
        expected = expected or run.read(f"{n}.obj")
        equal(run.read(f"{n}.obj"), expected, str(arguments))
    run.ffd("deform", "a.obj", "-l", "l.json", "between.obj")
    equal(run.read("between.obj"), expected)
    run.write("-v", CUBE)
    run.ffd("deform", "-l", "l.json", "--input-format", "obj", "--", "-v", "-q.obj")
    equal(run.read("-q.obj"), expected)


@case
def names_that_are_unusual(run):
    files(run)
    for name in ("with space.obj", "ä.obj", "a\nb.obj", "%s%n.obj", "UPPER.OBJ", ".obj.obj", "\u0085\u009b1m\u2028\u202e.obj", "a" * 250 + ".obj"):
        run.write(name, CUBE)
        run.ffd("deform", name, "out" + name[:200] + ".obj", "-l", "l.json")
        run.ffd("deform", "missing" + name[-200:], "x.obj", "-l", "l.json", code=3)


@case
def color_is_never_printed(run):
    files(run)
    for environment in ({}, {"NO_COLOR": "1"}):
        done = run.ffd("deform", code=USAGE, env=environment)
        check("\x1b" not in done.err[0], "an escape sequence")


@case
def the_commit_of_a_build(run):
    """Of a clone, with + where it is changed; of an archive what its file says; of another repository around it nothing."""
    script = os.path.join(os.environ["FFD_DATA"], "../src/base/commit.sh")

    def commit(folder):
        return subprocess.run(["sh", script, run.path(folder)], env={**os.environ, "commit": "of others"}, capture_output=True, text=True,
                              check=True, timeout=SECONDS).stdout

    def git(*words):
        subprocess.run(["git", "-C", run.path("clone"), "-c", "user.name=a", "-c", "user.email=a@b", *words], check=True, capture_output=True, timeout=SECONDS)

    run.write("clone/a.c", "1")
    git("init", "-q")
    equal(commit("clone"), "", "before the first commit")
    git("add", "a.c")
    git("commit", "-qm", "a")
    head = run.text("clone/.git/refs/heads/" + os.listdir(run.path("clone/.git/refs/heads"))[0])[:12]
    equal(commit("clone"), f"\\040({head})\n")
    run.write("clone/new.c", "")
    equal(commit("clone"), f"\\040({head})\n", "a file that is not of it")
    run.write("clone/a.c", "2")
    equal(commit("clone"), f"\\040({head}+)\n")
    run.write("clone/sub/b.c", "")
    equal((commit("clone/sub"), commit("none")), ("", ""))
    run.write("clone/sub/COMMIT", "0123456789ab\n")
    equal(commit("clone/sub"), "\\040(0123456789ab)\n")


main()
