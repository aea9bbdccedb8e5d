"""Others that read, or read and write, the same OBJ, beside `ffd deform`."""

import os
import shutil
import subprocess
import typing

import programs

BLENDER_SCRIPT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "blender_lattice.py")


class Peer(typing.NamedTuple):
    name: str
    words: list = None
    missing: str = ""


def libraries(bench, source, target):
    """Those of read_obj.cpp."""
    program = bench.built("read_obj")
    if not program:
        return [Peer("tinyobjloader, OpenMesh", missing=f"not built beside {bench.ffd}")]
    there = subprocess.run([program], stdout=subprocess.PIPE, text=True, check=True).stdout.split()
    return [Peer("tinyobjloader: read", [program, "tinyobjloader", source]) if "tinyobjloader" in there else
            Peer("tinyobjloader", missing="not built in"),
            Peer("OpenMesh: read", [program, "OpenMesh", source]),
            Peer("OpenMesh: read, write", [program, "OpenMesh", source, target])]


def assimp(source, target):
    if not shutil.which("assimp"):
        return Peer("assimp", missing="not installed")
    return Peer("assimp: read, write", ["assimp", "export", source, target])


def blender(program, source, target):
    if not program:
        return Peer("Blender", missing="on request, --blender PATH")
    return Peer("Blender: read, lattice modifier, write",
                [program, "--background", "--factory-startup", "--python-exit-code", "1",
                 "--python", BLENDER_SCRIPT, "--", source, target])


def peers(bench):
    source, target = bench.obj(), bench.path("peer.obj")
    found = [*libraries(bench, source, target), assimp(source, target), blender(bench.blender, source, target)]
    there = [peer for peer in found if peer.words]
    bench.table.title("Others on the same OBJ")
    own, *others = programs.in_turns([bench.deform(source, bench.lattices["box"]),
                                      *(programs.Command(peer.words, target) for peer in there)], bench.runs)
    row = bench.table.add("ffd deform, box", own.seconds, "s")
    for peer, sample in zip(there, others):
        bench.table.add(peer.name, sample.seconds, "s", row)
    for peer in found:
        if peer.missing:
            bench.table.say(f"  {peer.name}: {peer.missing}")
