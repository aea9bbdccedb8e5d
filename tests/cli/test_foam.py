#!/usr/bin/env python3
"""Meshes of OpenFOAM, in ascii and in binary, with a reader of their own here: what deform changes in the points, what the files beside
them tell, and what is said where one of them is missing or broken."""
import json
import os
import re

import foam_files as foam
import volume_files as volume
from harness import (INVALID, IO, NO, UNSUPPORTED, USAGE, carried, case, check, equal, float32, lattice, main, near)

BUMP = [{"at": [[1, 2], [1, 2], [1, 2]], "by": [0.5, 0.25, -0.125]}]
CORPUS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "fuzz", "corpus", "foam")
ALONE = "the file faces is not beside it: the mesh is taken as its points alone, without faces and cells"


def write(run, folder, files, *names):
    """Writes the files of a mesh, or those with these names, to a folder."""
    for name in names or files:
        run.write(f"{folder}/{name}", files[name])
    return f"{folder}/points"


def lattices(run):
    run.write("l.json", lattice(moves=BUMP))
    run.write("still.json", lattice())


def prepare_outputs(run):
    for folder in ("o", "still"):
        run.folder_of(folder)


@case
def points_get_the_bits_of_an_obj(run):
    """In each encoding; every byte before and behind the points stays."""
    lattices(run)
    prepare_outputs(run)
    for name, made in foam.ENCODINGS.items():
        is_float = made.scalar == "f"
        rounded = [[float32(x) if is_float else x for x in p] for p in volume.POINTS]
        expected = [[float32(x) if is_float else x for x in p] for p in carried(run, rounded, "l.json")]
        before = made.files(rounded)
        mesh = write(run, "m", before)
        run.ffd("deform", mesh, "still/points", "-l", "still.json", "--force")
        equal(run.read("still/points"), before["points"], f"{name}: nothing moves")
        run.ffd("deform", mesh, "o/points", "-l", "l.json", "--force")
        equal(os.listdir(run.path("o")), ["points"], "no other file is written")
        found, first, last = foam.read_points(run.read("o/points"))
        equal(found, expected, name)
        equal((first, last), foam.read_points(before["points"])[1:], f"{name}: the rest")
        if made.is_binary:
            equal(len(run.read("o/points")), len(before["points"]))
        else:
            marks = re.compile(rb"[^()/*\n]+")
            equal(marks.sub(b"", run.read("o/points")), marks.sub(b"", before["points"]), f"{name}: brackets, comments, lines")


@case
def one_place_for_all_points(run):
    lattices(run)
    prepare_outputs(run)
    head = foam.Foam().header("vectorField", "points")
    mesh = write(run, "m", {"points": head + b"4 { (0.5 0.25 1) }\n"})
    run.ffd("deform", mesh, "o/points", "-l", "l.json", err=f"{mesh}: {ALONE}")
    point, = carried(run, [[0.5, 0.25, 1.0]], "l.json")
    equal(run.read("o/points"), head + ("4 { (" + " ".join(map(repr, point)) + ") }\n").encode())
    write(run, "m", {"pointZones": foam.Foam().zones("point", "one", [2])})
    run.ffd("deform", mesh, "still/points", "-l", "l.json", "--only", "group:one", "-q", code=UNSUPPORTED,
            err=f"{mesh}: has one place for all points, and only some of them move: this is not supported")


@case
def commands_see_the_outer_faces(run):
    """What an OBJ of the outer faces has: topology, u,v,w, figures of check."""
    lattices(run)
    run.write("m.obj", "".join("v %r %r %r\n" % tuple(p) for p in volume.POINTS)
              + "".join("f " + " ".join(str(i + 1) for i in face) + "\n" for face in volume.OUTER))
    expected = run.ffd("info", "m.obj", "--json").json
    run.ffd("embed", "m.obj", "-l", "l.json", "-o", "m.npy")
    report = {}
    for name, made in foam.ENCODINGS.items():
        files = made.files()
        if made.is_binary:
            files["faces"] = made.faces(is_compact=name == "binary")
        else:
            files["faces"] = made.faces(is_compact=name == "ascii without arch")
        mesh = write(run, "m", files)
        found = run.ffd("info", mesh, "--json").json
        equal(found["topology"], expected["topology"], name)
        equal(found["bounds"], expected["bounds"])
        equal([found["contents"][key] for key in ("cells", "volumes", "faces", "groups")], [2, 2, 10, 6], name)
        equal(found["contents"]["encoding"], "binary" if made.is_binary else "ascii")
        run.ffd("embed", mesh, "-l", "l.json", "-o", "f.npy", "--force")
        rows = 9 if made.scalar == "f" else 10  # the last one has no floats
        equal(run.read("f.npy")[:128 + 24 * rows], run.read("m.npy")[:128 + 24 * rows], "u,v,w")
        for path in (mesh, "m.obj"):
            run.ffd("check", path, "-l", "l.json", "--report", "r.json", "--force", data=True)
            report[path] = json.loads(run.read("r.json"))["jobs"][0]
        for member in ("vertices", "flipped_faces"):
            equal(report[mesh][member], report["m.obj"][member], name)
        for member in ("area", "volume"):
            near(list(report[mesh][member].values()), list(report["m.obj"][member].values()), 1e-12, name)
    run.ffd("lattice", "new", mesh, "-o", "n.json")
    run.ffd("jacobian", mesh, "-l", "l.json", "-o", "j.npz")
    run.ffd("fit", mesh, mesh, "-o", "f.json", lines=1)
    for page in ("v.png", "v.html"):
        run.ffd("view", mesh, "-l", "l.json", "-o", page, data=True)
    run.ffd("edit", mesh, "-o", "e.html", data=True)


@case
def patches_and_zones_are_groups(run):
    lattices(run)
    prepare_outputs(run)
    whole = carried(run, volume.POINTS, "l.json")
    for name in ("ascii", "binary"):
        mesh = write(run, "m", foam.ENCODINGS[name].files())
        for group, members in foam.MEMBERS.items():
            run.ffd("deform", mesh, "o/points", "-l", "l.json", "--force", "-q", "--only", "group:" + group)
            found = foam.read_points(run.read("o/points"))[0]
            equal(found, [(whole if i in members else volume.POINTS)[i] for i in range(10)], f"{name}: {group}")
    named = {name["selector"]: name["vertices"] for name in run.ffd("info", mesh, "--json", "--parts").json["named_parts"]}
    equal(named, {"group:" + group: len(members) for group, members in foam.MEMBERS.items()})
    run.ffd("deform", mesh, "still/points", "-l", "l.json", "--only", "group:wals", code=USAGE,
            err=f'{mesh}: --only: no group is called "wals" (nearest: "walls")')
    run.remove("m/boundary")
    run.ffd("deform", mesh, "still/points", "-l", "l.json", "--only", "group:floor", code=USAGE,
            err=re.compile(r'no group is called "floor" .*\(the file boundary, which names patches, is not beside it\)$'))


@case
def missing_files_are_said(run):
    """The points move all the same; what is missing has a warning of every command, and is refused with --strict."""
    lattices(run)
    prepare_outputs(run)
    made = foam.Foam()
    files = made.files()
    files["noted"] = made.labels("owner", foam.OWNER, '    note        "nPoints:10  nCells:2  nFaces:10  nInternalFaces:1";\n')
    outer = "the mesh is taken as its points and outer faces, without cells"
    for names, said, faces in ((["points"], ALONE, 0), (["points", "owner", "neighbour", "boundary"], ALONE, 0),
                               (["points", "faces", "owner"], ALONE.replace("faces", "neighbour", 1), 0),
                               (["points", "faces", "noted"], f"the file neighbour is not beside it: {outer}", 9),
                               (["points", "faces", "neighbour"], f"the file owner is not beside it: {outer}", 9)):
        mesh = write(run, "m", files, *names)
        if "noted" in names:
            os.rename(run.path("m/noted"), run.path("m/owner"))
        run.ffd("deform", mesh, "o/points", "-l", "l.json", "--force", err=f"{mesh}: {said}")
        run.ffd("embed", mesh, "-l", "l.json", "-o", "u.npy", "--force", err=f"{mesh}: {said}")
        run.ffd("check", mesh, "-l", "l.json", data=True, err=f"{mesh}: {said}")
        run.ffd("view", mesh, "-o", "v.png", "--force", err=f"{mesh}: {said}")
        run.ffd("edit", mesh, "-o", "e.html", "--force", err=f"{mesh}: {said}")
        run.ffd("deform", mesh, "o/points", "-l", "l.json", "--force", "--strict", code=INVALID, err=f"{mesh}: {said}")
        topology = run.ffd("info", mesh, "--json", err=f"{mesh}: {said}").json.get("topology") or {"faces": 0}
        equal(topology["faces"], faces, names)
        for name in os.listdir(run.path("m")):
            run.remove(f"m/{name}")
    mesh = write(run, "m", {"points": files["points"], "faces.gz": b"\x1f\x8b\x08"})
    run.ffd("deform", mesh, "o/points", "-l", "l.json", "--force", err=f"{mesh}: " + ALONE.replace(
        " beside it", " beside it (only compressed, which is not read: unpack it with gunzip)"))
    done = run.ffd("deform", "-", "-", "-l", "l.json", "--input-format", "foam", "--output-format", "foam", stdin=files["points"],
                   err=f"standard input: {ALONE}")
    equal(done.out, run.read("o/points"), "a stream has no folder")


@case
def points_are_compared_without_their_cells(run):
    """The output has no faces beside it: its points are compared, and not the cells. Where both have them, these are."""
    lattices(run)
    prepare_outputs(run)
    files = foam.Foam().files()
    mesh = write(run, "m", files)
    run.ffd("deform", mesh, "still/points", "-l", "still.json")
    run.ffd("compare", mesh, "still/points", err=f"still/points: {ALONE}")
    run.ffd("deform", mesh, "o/points", "-l", "l.json")
    check("differs by" in run.ffd("compare", mesh, "o/points", code=NO, lines=1).text, "points")
    write(run, "still", files, "faces", "owner", "neighbour")
    run.ffd("compare", mesh, "still/points")
    write(run, "still", {"neighbour": foam.Foam().labels("neighbour", [2])})
    check("2 and 3 cells" in run.ffd("compare", mesh, "still/points", code=NO).text, "cells")
    write(run, "still", {**files, "points": files["points"].replace(b"points;", b"dots;")})
    check("other bytes differ" in run.ffd("compare", mesh, "still/points", code=NO).text, "bytes")
    write(run, "right/a", files)
    write(run, "left/a", files)
    run.ffd("compare", "--recursive", "left", "right")
    write(run, "right/a", {"points": run.read("o/points")})
    run.ffd("compare", "--recursive", "left", "right", code=NO)


@case
def outputs_have_the_name_points(run):
    lattices(run)
    mesh = write(run, "m", foam.Foam(True).files())
    run.ffd("deform", mesh, "--out-dir", "o", "-l", "l.json")
    expected = run.read("o/points")
    run.ffd("deform", mesh, "--out-dir", "p", "-l", "l.json", "--output-format", "foam")
    equal(run.read("p/points"), expected)
    equal(run.ffd("deform", mesh, "-", "-l", "l.json", "--output-format", "foam").out, expected)
    run.write("jobs.jsonl", '{"in": "m/points", "lattice": "l.json", "out": "b/points"}\n')
    run.ffd("batch", "jobs.jsonl", "-q")
    equal(run.read("b/points"), expected, "in a batch")
    write(run, "i", foam.Foam(True).files())
    run.ffd("deform", "i/points", "--in-place", "-l", "l.json", "--threads", "3")
    equal(run.read("i/points"), expected, "in place")
    equal(run.read("i/faces"), run.read("m/faces"))
    refused = (("n", USAGE, "is not that of a mesh format (obj, gltf, glb, vrm, ply, off, stl, vtk, su2, vtu, vtp, vts, msh or foam, "
                            "whose file is called points)"),
               ("points.gz", UNSUPPORTED, "points.gz: compressed files of OpenFOAM are not written: the output is called points"),
               ("n.obj", UNSUPPORTED, "OpenFOAM cannot become OBJ: meshes of volumes keep their format (meshio converts them)"),
               ("n.vtu", UNSUPPORTED, "OpenFOAM cannot become VTU"))
    for name, code, said in refused:
        run.ffd("deform", mesh, name, "-l", "l.json", code=code, err=re.compile(re.escape(said)))
    run.ffd("deform", mesh, "n", "-l", "l.json", "--output-format", "foam", code=USAGE,
            err="n: the output of a mesh of OpenFOAM is called points, too")
    run.write("jobs.jsonl", '{"in": "m/points", "lattice": "l.json", "out": "n", "options": {"output-format": "foam"}}\n')
    run.ffd("batch", "jobs.jsonl", "-q", code=NO, err=re.compile("n: the output of a mesh of OpenFOAM is called points, too"))
    run.write("m.obj", "v 0 0 0\n")
    run.ffd("deform", "m.obj", "points", "-l", "l.json", code=UNSUPPORTED, err=re.compile("OBJ cannot become OpenFOAM"))
    run.write("k.json", lattice(keys=[{"time": 0, "moves": []}, {"time": 1, "moves": BUMP}]))
    run.ffd("animate", mesh, "n.glb", "-l", "k.json", code=USAGE,
            err=f"{mesh}: a mesh of volumes keeps its format, which has no animations")


@case
def rows_of_a_table_have_folders(run):
    """A number cannot be in the name: the folder has it."""
    run.write("l.json", lattice(moves=[{"by": [{"$": "d"}, 0, 0]}]))
    write(run, "m", foam.Foam().files())
    run.write("t.csv", "d\n0.25\n0.5\n")
    run.ffd("batch", "--csv", "t.csv", "--in", "m/points", "--lattice", "l.json", "--out-dir", "o", "-q")
    for row, offset in ((1, 0.25), (2, 0.5)):
        found = foam.read_points(run.read(f"o/points-{row}/points"))[0]
        equal(found, [[x + offset, y, z] for x, y, z in volume.POINTS], "a row")


@case
def a_batch_goes_on_where_it_stopped(run):
    """A job is done as long as the files that it read are the same, those beside the points too, and its output is."""
    lattices(run)
    files = foam.Foam().files()
    write(run, "m", files)
    write(run, "o", files, "faces")
    run.write("jobs.jsonl", '{"in": "m/points", "lattice": "l.json", "out": "o/points", "options": {"only": "group:walls"}}\n')

    def skipped():
        run.ffd("batch", "jobs.jsonl", "-q", "--resume", "--force", "--report", "r.json")
        return json.loads(run.read("r.json"))["jobs"][0]["status"] == "skipped"

    equal([skipped(), skipped()], [False, True])
    write(run, "o", files, "owner")  # is no output
    equal(skipped(), True)
    write(run, "m", {"boundary": files["boundary"].replace(b"walls", b"roofs").replace(b" roof\n", b" walls\n")})
    equal([skipped(), skipped()], [False, True])
    moved = [a != b for a, b in zip(foam.read_points(run.read("o/points"))[0], volume.POINTS, strict=True)]
    equal({i for i, has_moved in enumerate(moved) if has_moved}, foam.MEMBERS["roof"])


@case
def names_that_are_none(run):
    """Folders, compressed files, ParaView's mark of a case, and files that only have the name."""
    lattices(run)
    files = foam.Foam().files()
    write(run, "case/constant/polyMesh", files)
    run.ffd("info", "case", code=USAGE, err="case: is a folder: name its file case/constant/polyMesh/points")
    run.ffd("info", "case/constant/polyMesh/", code=USAGE,
            err="case/constant/polyMesh/: is a folder: name its file case/constant/polyMesh/points")
    run.write("case/case.foam", b"")
    run.ffd("info", "case/case.foam", code=USAGE,
            err="case/case.foam: is no mesh: that of its case is the file constant/polyMesh/points beside it")
    run.write("points.gz", b"\x1f\x8b\x08\0")
    run.folder_of("o")
    packed = "is compressed, which is not supported: unpack it with gunzip"
    run.ffd("deform", "points.gz", "o/points", "-l", "l.json", code=UNSUPPORTED, err=f"points.gz: {packed}")
    run.write("points", b"\x1f\x8b\x08\0")
    run.ffd("info", "points", code=UNSUPPORTED, err=f"points: {packed}")
    run.write("points", "1 2 3\n4 5 6\n")
    run.ffd("info", "points", code=INVALID, err="points: does not begin with FoamFile")
    write(run, ".", {"points": files["points"], "owner": b"FoamFile", "faces": files["faces"]})
    run.ffd("info", "points", code=INVALID, err=re.compile(r"^owner:1: the end of the file is in the place of the"))
    run.remove("owner")
    os.mkdir(run.path("owner"))
    run.ffd("info", "points", code=IO, err=re.compile("owner: .*"))


@case
def files_beside_it_belong_to_the_job(run):
    """They are in depfiles, no output replaces them, and links to them are followed."""
    lattices(run)
    prepare_outputs(run)
    mesh = write(run, "m", foam.Foam().files())
    run.ffd("deform", mesh, "o/points", "-l", "l.json", "--depfile", "d")
    names = set(run.text("d").replace("\\\n", " ").split(":", 1)[1].split())
    equal(names, {"l.json", *(f"m/{name}" for name in foam.Foam().files())})
    for command in (["lattice", "new", mesh], ["fit", mesh, mesh]):
        run.ffd(*command, "-o", "m/owner", "--force", code=IO,
                err="m/owner: is a file of the input m/points and is not overwritten")
    before = run.ffd("info", mesh, "--json").json
    run.folder_of("base")
    for name in ("faces", "owner", "neighbour", "boundary"):
        os.rename(run.path(f"m/{name}"), run.path(f"base/{name}"))
        os.symlink(f"../base/{name}", run.path(f"m/{name}"))
    equal(run.ffd("info", mesh, "--json").json, before, "links")


@case
def meshes_of_openfoam_itself(run):
    """Made by its blockMesh: four cells between three patches, in both formats."""
    lattices(run)
    read = {}
    for name in ("blockMesh", "blockMesh-binary"):
        with open(os.path.join(CORPUS, name), "rb") as file:
            files = foam.parted(file.read())
        mesh = write(run, name, files)
        contents = run.ffd("info", mesh, "--json", "--parts").json
        equal([contents["contents"][key] for key in ("cells", "faces", "groups")], [4, 20, 4], name)
        equal([contents["topology"][key] for key in ("faces", "boundary_edges", "euler")], [16, 0, 2], name)
        equal({part["selector"]: part["vertices"] for part in contents["named_parts"]},
              {"group:movingWall": 6, "group:fixedWalls": 14, "group:frontAndBack": 18, "group:half": 12})
        run.ffd("deform", mesh, f"{name}-o/points", "-l", "l.json", code=IO)
        run.folder_of(f"{name}-o")
        run.ffd("deform", mesh, f"{name}-o/points", "-l", "l.json")
        read[name] = foam.read_points(run.read(f"{name}-o/points"))[0]
        equal(read[name], carried(run, foam.read_points(files["points"])[0], "l.json"))
    near(sum(read["blockMesh"], []), sum(read["blockMesh-binary"], []), 1e-6)


main()
