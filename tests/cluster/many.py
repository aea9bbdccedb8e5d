"""A manifest of many jobs, what they give in one run, and the commands of data/tutorial.md's section on many machines."""
import functools
import json
import os
import re
import shutil
import subprocess
import sys

from harness import FFD, check, equal, lattice
from report_schema import faults

SOURCE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
sys.path.append(os.path.join(SOURCE, "tests", "readme"))
from test_readme import blocks, pages

SECONDS = 300


def tools(run):
    """A folder with the program, for the path."""
    if not run.exists("bin"):
        os.makedirs(run.path("bin"))
        os.symlink(FFD, run.path("bin/ffd"))
    return run.path("bin")


def environment(run):
    """That of a user with the program in the path, and a home in the folder."""
    return dict(os.environ, PATH=tools(run) + os.pathsep + os.environ["PATH"], HOME=run.path("home"), XDG_CACHE_HOME=run.path("cache"))


def page_commands(kind):
    """The commands of the blocks ```sh KIND."""
    found = [content for language, name, content in blocks(pages(SOURCE)) if (language, name) == ("sh", kind)]
    check(found, f"the pages have no commands for {kind}")
    return "".join(found)


def page_folder(run, name):
    """A copy of data/ with the files that the pages show."""
    shutil.copytree(os.path.join(SOURCE, "data"), run.path(name))
    for language, file, content in blocks(pages(SOURCE)):
        if language == "json":
            run.write(f"{name}/{file}", content)
    return name


def shell(run, folder, script, environment, code=0):
    done = subprocess.run(["sh", "-eu", "-c", script], cwd=run.path(folder), env=environment, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=SECONDS, check=False)
    logs = "".join(run.text(f"{folder}/{name}") for name in run.names(folder) if re.fullmatch(r"slurm-.*\.out", name))
    check(done.returncode == code, f"{script}\nended with {done.returncode}: {done.stdout}{logs}")


@functools.cache
def sheet_at(count):
    """A square of count x count vertices at the height HEIGHT."""
    rows = [f"v {2 * x / count - 1:.6f} {2 * y / count - 1:.6f} HEIGHT" for y in range(count) for x in range(count)]
    faces = [f"f {i} {i + 1} {i + count + 1} {i + count}"
             for y in range(count - 1) for i in range(y * count + 1, y * count + count)]
    return "\n".join(rows + faces) + "\n"


def sheet(count, height):
    return sheet_at(count).replace("HEIGHT", f"{height:.6f}")


def manifest(run, folder, jobs, size):
    """jobs jobs, each with a mesh of its own."""
    for i in range(3):
        run.write(f"{folder}/l{i}.json", lattice(size=(6, 6, 6), knots=["uniform", "open", "clamped"], moves=[
            {"twist": {"axis": "z", "degrees": 40}}, {"at": [i, 2, 3], "by": [0.1, 0.2, 0.3]}]))
    for i in range(jobs):
        run.write(f"{folder}/m{i}.obj", sheet(size, i / jobs))
    run.write(f"{folder}/jobs.jsonl", "".join(
        json.dumps({"in": f"m{i}.obj", "lattice": f"l{i % 3}.json", "out": f"out/{i:03}.obj"}) + "\n" for i in range(jobs)))
    run.folder_of(f"{folder}/out")


def contents(run, folder):
    """The files of a folder and those below it, by their names in it."""
    return {os.path.relpath(os.path.join(place, name), run.path(folder)): run.read(os.path.join(place, name))
            for place, _, names in os.walk(run.path(folder)) for name in names}


def one_run(run, folder, name="jobs.jsonl"):
    """The entries of the report of a single run over the manifest."""
    shell(run, folder, f"ffd batch {name} --report whole.json", environment(run))
    return json.loads(run.read(f"{folder}/whole.json"))["jobs"]


def check_report(run, name, entries, statuses=("ok",)):
    """The report names the same jobs as entries, in their order, each ended in one of the statuses."""
    equal(faults(run.read(name)), [], name)
    found = json.loads(run.read(name))["jobs"]
    equal([(e["input"], e["output"]) for e in found], [(e["input"], e["output"]) for e in entries], name)
    check({e["status"] for e in found} <= set(statuses), f"{name}: {[e['status'] for e in found]}")
    return found
