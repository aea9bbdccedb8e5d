#!/usr/bin/env python3
"""The examples of every command's help are right: at least two, one line each, run one after the other in a folder
with the files that they speak of. FFD_DATA names data/."""

import json
import os
import shutil
import struct
import subprocess

from author import array
from harness import FFD, SECONDS, case, check, main

DATA = os.environ["FFD_DATA"]
FILES = {"cow.obj": "models/spot.obj", "robot.glb": "models/character.glb", "vase.obj": "models/vase.obj",
         "old.obj": "models/vase.obj", "new.obj": "models/vase.obj", "column.obj": "models/column.obj",
         "knight.glb": "models/knight.glb", "tall.json": "lattices/taller.json", "bend.json": "lattices/bend.json", "twist.json": "lattices/twist.json"}


def commands(run):
    lines = [line for line in run.ffd("help").text.splitlines() if line.startswith("  ffd ")]
    names = [line[len("  ffd "):].split("  ")[0] for line in lines]
    return [name for name in names if name not in ("help", "--version")]


def examples(run, command):
    """(what it does, line) of each."""
    text = run.ffd("help", *command.split()).text.split("\nExamples:\n")[1]
    lines = text.splitlines()
    check(len(lines) % 2 == 0, f"{command}: an example without its line")
    for what, line in zip(lines[::2], lines[1::2]):
        check(what.startswith("  ") and what.endswith(":") and line.startswith("      "), f"{command}: {what!r}, {line!r}")
        yield what.strip(), line.strip()


def write_batch(work):
    """A manifest, and a folder of meshes."""
    with open(os.path.join(work, "jobs.jsonl"), "w", encoding="ascii") as file:
        for name in ("cow.obj", "vase.obj"):
            file.write(json.dumps({"in": name, "lattice": "bend.json", "out": "bent-" + name}) + "\n")
    with open(os.path.join(work, "swept.json"), "w", encoding="ascii") as file:
        json.dump({"format": "ffd-lattice", "version": 1, "size": [4, 4, 6], "rest": {"box": "mesh"},
                   "moves": [{"twist": {"axis": "y", "degrees": {"$": "SWEEP"}}}]}, file)
    with open(os.path.join(work, "turning.json"), "w", encoding="ascii") as file:
        json.dump({"format": "ffd-lattice", "version": 1, "size": [4, 4, 6], "rest": {"box": "mesh"},
                   "moves": [{"twist": {"axis": "y", "degrees": {"$": "TURN"}}}],
                   "keys": [{"time": 0, "set": {"TURN": 0}}, {"time": 1, "set": {"TURN": 40}}]}, file)
    with open(os.path.join(work, "upper.json"), "w", encoding="ascii") as file:
        json.dump({"format": "ffd-lattice", "version": 1, "size": [4, 9, 4], "rest": {"box": {"min": [-1.2, 3, -1.2], "max": [1.2, 8.2, 1.2]}},
                   "moves": [{"by": [1, 0, 0.5]}]}, file)
    with open(os.path.join(work, "table.csv"), "w", encoding="ascii") as file:
        file.write("SWEEP\n10\n20\n")
    with open(os.path.join(work, "vase.obj"), encoding="ascii") as file:
        numbers = 3 * sum(line.startswith("v ") for line in file)
    head = f"{{'descr': '<f8', 'fortran_order': False, 'shape': ({numbers},), }}\n".encode()
    with open(os.path.join(work, "dFdX.npy"), "wb") as file:
        file.write(b"\x93NUMPY\x01\x00" + struct.pack("<H", len(head)) + head + bytes(8 * numbers))
    write_moved(work)
    write_posed(work)
    os.mkdir(os.path.join(work, "out"))
    os.mkdir(os.path.join(work, "meshes"))
    for name in ("cow.obj", "column.obj"):
        shutil.copy(os.path.join(work, name), os.path.join(work, "meshes", name))


def write_moved(work):
    """A lattice at rest, and control points that a script has moved."""
    with open(os.path.join(work, "rest.json"), "w", encoding="ascii") as file:
        json.dump({"format": "ffd-lattice", "version": 1, "size": [2, 3, 2], "rest": {"box": {"min": [0, 0, 0], "max": [1, 2, 1]}}}, file)
    with open(os.path.join(work, "moved.npy"), "wb") as file:
        file.write(array([x + 0.125 * y for z in (0, 1) for y in (0, 1, 2) for u in (0, 1) for x in (u, y, z)], "(12, 3)"))


def write_posed(work):
    """The cow as another program has posed it, and a table of vertices to drag."""
    with open(os.path.join(work, "cow.obj"), encoding="ascii") as file:
        lines = file.read().splitlines()
    with open(os.path.join(work, "posed.obj"), "w", encoding="ascii") as file:
        for line in lines:
            word, *numbers = line.split() or [""]
            if word == "v":
                x, y, z = map(float, numbers[:3])
                line = f"v {x + 0.25 * y * y!r} {y!r} {z + 0.125 * x * y!r}"
            file.write(line + "\n")
    with open(os.path.join(work, "pairs.csv"), "w", encoding="ascii") as file:
        file.write("vertex,x,y,z,weight\n12,0.5,0.5,0.25,exact\n900,0,0.25,-0.5,\n")


@case
def the_examples_do_what_they_say(run):
    tools = run.folder_of("tools")
    os.symlink(FFD, run.path(os.path.join(tools, "ffd")))
    environment = dict(os.environ, PATH=run.path(tools) + os.pathsep + os.environ["PATH"])
    for command in commands(run):
        work = run.path(run.folder_of(f"work {command}"))
        for name, source in FILES.items():
            shutil.copy(os.path.join(DATA, source), os.path.join(work, name))
        shutil.copytree(os.path.join(DATA, "models/Textures"), os.path.join(work, "Textures"))
        write_batch(work)
        count = 0
        for what, line in examples(run, command):
            check(f"ffd {command} " in line, f"{command}: not an example of it: {line}")
            done = subprocess.run(["sh", "-eu", "-c", line], cwd=work, env=environment, stdin=subprocess.DEVNULL,
                                  capture_output=True, timeout=SECONDS, check=False)
            check(done.returncode == 0, f"{command}: {what} {line}: exit {done.returncode}, {done.stderr.decode()}")
            count += 1
        check(count >= 2, f"{command}: {count} examples")


main()
