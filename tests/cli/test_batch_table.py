#!/usr/bin/env python3
"""Placeholders in the moves of a lattice: ffd deform --set, "set" in the lines of a manifest, ffd batch --csv."""

import json

from batches import batch, case, check, equal, job, lattice, lines_of, main, report, start
from harness import CUBE, CUBE_CORNERS, INVALID, IO, NO, OK, USAGE, near, obj_vertices

HEIGHT = [{"by": [0, {"$": "H"}, 0]}]
PLACES = [{"at": [{"$": "I"}, "all", [0, {"$": "J"}]], "by": {"$": "STEP"}, "weight": {"$": "W"}},
          {"twist": {"axis": {"$": "AXIS"}, "degrees": {"$": "A"}, "about": [0, {"$": "H"}, 0]}}]


def begin(run, moves=None, **members):
    start(run)
    run.write("p.json", lattice(moves=moves or HEIGHT, **members))


def raised(run, name, height):
    near(obj_vertices(run.text(name)), [[p[0], p[1] + height, p[2]] for p in CUBE_CORNERS], 1e-14, name)


def filled(value, values):
    """What a lattice is without placeholders."""
    if isinstance(value, dict):
        return values[value["$"]] if "$" in value else {k: filled(v, values) for k, v in value.items()}
    return [filled(v, values) for v in value] if isinstance(value, list) else value


@case
def set_on_the_command_line(run):
    begin(run)
    for value in ("0.5", "-1", "1e-1", "0", "3"):
        run.ffd("deform", "a.obj", "b.obj", "-l", "p.json", "--set", "H=" + value, "--force", err=lambda said: None)
        raised(run, "b.obj", float(value))
    for arguments, code, told in ((["--set", "H"], USAGE, "NAME=VALUE"), (["--set", "=1"], USAGE, "NAME=VALUE"),
                                  (["--set", "H=1", "--set", "H=2"], USAGE, '"H"'), (["--set", "H=x"], INVALID, '"x"'),
                                  (["--set", "H="], INVALID, "/moves/0/by/1"), (["--set", "H=nan"], INVALID, "nan"),
                                  (["--set", "H=[1, 2]"], INVALID, "number"), (["--set", "H=1e400"], INVALID, "1e400"),
                                  ([], INVALID, '"H"'), (["--set", "h=1"], INVALID, '"H"'),
                                  (["--set", "H=1", "--set", "K=1"], INVALID, '"K"')):
        said = run.ffd("deform", "a.obj", "b.obj", "-l", "p.json", "--force", *arguments, code=code).err[0]
        check(told in said, arguments, "said", said)
    run.ffd("check", "a.obj", "-l", "p.json", "--set", "H=0.5")


@case
def every_place_of_a_move(run):
    values = {"I": [1, 2], "J": -1, "STEP": [0.25, -0.5, 0.125], "W": 0.75, "AXIS": "y", "A": 35.5, "H": 0.3}
    begin(run, PLACES)
    run.write("filled.json", lattice(moves=filled(PLACES, values)))
    run.ffd("deform", "a.obj", "expected.obj", "-l", "filled.json")
    run.ffd("deform", "a.obj", "b.obj", "-l", "p.json", *[x for name, value in values.items() for x in (
        "--set", f"{name}={value if isinstance(value, str) else json.dumps(value)}")])
    equal(run.read("b.obj"), run.read("expected.obj"), "--set")
    run.write("m.jsonl", lines_of([job(0, lattice="p.json", set=values)]))
    batch(run, "m.jsonl", done=1)
    equal(run.read("o0.obj"), run.read("expected.obj"), '"set"')
    cells = ['"%s"' % (value if isinstance(value, str) else json.dumps(value)) for value in values.values()]
    run.write("t.csv", "in,lattice,out," + ",".join(values) + "\na.obj,p.json,c.obj," + ",".join(cells) + "\n")
    batch(run, "--csv", "t.csv", done=1)
    equal(run.read("c.obj"), run.read("expected.obj"), "--csv")


@case
def placeholders_stand_in_moves_only(run):
    begin(run)
    run.write("bad.json", {**lattice(), "size": [{"$": "N"}, 4, 4]})
    run.ffd("deform", "a.obj", "b.obj", "-l", "bad.json", "--set", "N=4", code=INVALID)
    for wrong in ({"$": "H", "more": 1}, {"$": 3}, {"$": ""}):
        run.write("bad.json", lattice(moves=[{"by": [0, wrong, 0]}]))
        run.ffd("deform", "a.obj", "b.obj", "-l", "bad.json", "--set", "H=4", code=INVALID)


@case
def set_in_a_manifest(run):
    begin(run)
    run.write("k.json", lattice(low=(-9, -9, -9), high=(9, 9, 9), moves=[{"by": [0, {"$": "K"}, 0]}, {"by": [0, {"$": "H"}, 0]}]))
    run.write("l.json", lattice())
    jobs = [job(i, lattice="p.json", set={"H": i / 16}) for i in range(12)]
    jobs += [job(12, lattice=["p.json", "k.json"], set={"H": 0.25, "K": 0.5}), job(13, lattice=["l.json", "p.json"], set={"H": -0.5})]
    run.write("m.jsonl", lines_of(jobs))
    batch(run, "m.jsonl", "-j", "2", done=14)
    for i in range(12):
        raised(run, f"o{i}.obj", i / 16)
    raised(run, "o12.obj", 1)
    raised(run, "o13.obj", -0.5)
    for i in (3, 7):
        run.ffd("deform", "a.obj", "s.obj", "-l", "p.json", "--set", f"H={i / 16}", "--force")
        equal(run.read(f"o{i}.obj"), run.read("s.obj"), f"o{i}.obj and a single run's")
    # A changed value is a changed job.
    jobs[4]["set"]["H"] = 0.875
    run.write("m.jsonl", lines_of(jobs))
    batch(run, "m.jsonl", "--resume", done=1, kept=13)
    raised(run, "o4.obj", 0.875)
    # --set is the default of jobs that do not set it themselves.
    run.write("m.jsonl", lines_of([job(0, lattice="p.json", set={"H": 0.5}), job(1, lattice="p.json")]))
    batch(run, "m.jsonl", "--force", "--set", "H=0.125", done=2)
    raised(run, "o0.obj", 0.5)
    raised(run, "o1.obj", 0.125)


@case
def bad_sets(run):
    begin(run)
    bad = [([], '"set"'), (3, '"set"'), ("H=1", '"set"'), ({}, '"H"'), ({"H": "1"}, r"p\.json:/moves/0/by/1"), ({"H": [1]}, r"p\.json:/moves/0/by/1"),
           ({"H": None}, r"p\.json:/moves/0/by/1"), ({"H": True}, r"p\.json:/moves/0/by/1"), ({"H": 1, "K": 2}, '"K"'), ({"h": 1}, '"H"')]
    run.write("m.jsonl", lines_of([job(i, lattice="p.json", set=value) for i, (value, _) in enumerate(bad)] + [job(99, lattice="p.json", set={"H": 1})]))
    batch(run, "m.jsonl", "--report", "r.json", failed=[told for _, told in bad], done=1)
    equal([e["exit"] for e in report(run)], [INVALID] * len(bad) + [OK])
    equal([n for n in run.names() if n.startswith("o")], ["o99.obj"])


@case
def a_table(run):
    begin(run)
    run.write("two.json", lattice(moves=[{"by": [{"$": "dx"}, {"$": "H"}, 0]}]))
    run.write("sweep/a.obj", CUBE)
    run.write("sweep/p.json", lattice(moves=HEIGHT))
    # Rows are relative to the table.
    run.write("sweep/t.csv", "in,lattice,out,H\na.obj,p.json,b.obj,0.5\n../a.obj,../p.json,c.obj,-0.25\n")
    batch(run, "--csv", "sweep/t.csv", "--report", "r.json", done=2)
    raised(run, "sweep/b.obj", 0.5)
    raised(run, "sweep/c.obj", -0.25)
    equal([e["line"] for e in report(run)], [2, 3])
    # Any order of columns, names of columns with case and signs.
    run.write("t.csv", "H,out,dx,in,lattice\n0.5,d.obj,0,a.obj,two.json\n-.25,e.obj,0.0,a.obj,two.json\n")
    batch(run, "--csv", "t.csv", done=1, failed=['"-.25"'])
    raised(run, "d.obj", 0.5)


@case
def quoted_cells(run):
    begin(run)
    run.write('with "quotes", comma.obj', CUBE)
    run.write("line\nbreak.obj", CUBE)
    run.write("t.csv", b'\xef\xbb\xbf"in",lattice,"out",H\r\n"with ""quotes"", comma.obj",p.json,b.obj,"0.5"\r\n\r\n'
              b'"line\nbreak.obj",p.json,"out\nput.obj",1\r\na.obj,"p.json",c.obj,"0.25"')
    batch(run, "--csv", "t.csv", "--report", "r.json", done=3)
    raised(run, "b.obj", 0.5)
    raised(run, "out\nput.obj", 1)
    raised(run, "c.obj", 0.25)
    # Rows are counted by the lines of the file that they begin on.
    equal([e["line"] for e in report(run)], [2, 4, 7])
    equal([e["input"] for e in report(run)], ['with "quotes", comma.obj', "line\nbreak.obj", "a.obj"])


@case
def bad_rows(run):
    begin(run)
    rows = [(b"a.obj,p.json,x.obj", r"^t\.csv:2: .*3.*4"), (b"a.obj,p.json,x.obj,1,2", r"^t\.csv:3: .*5.*4"), (b"a.obj,p.json,good1.obj,1", None),
            (b'a.obj,p.json,"x.obj"x,1', r"^t\.csv:5: "), (b'a.obj,p.json,x".obj,1', r"^t\.csv:6: "), (b",p.json,x.obj,1", r'^t\.csv:7: .*"in"'),
            (b"a.obj,,x.obj,1", r'^t\.csv:8: .*"lattice"'), (b"a.obj,p.json,,1", r'^t\.csv:9: .*"out"'), (b"a.obj,p.json,x.obj,abc", "abc"),
            (b"a.obj,p.json,x.obj,", r"p\.json:/moves/0/by/1"), (b"a.obj,p.json,x.obj,nan", "nan"), (b"none.obj,p.json,x.obj,1", r"^none\.obj: "),
            (b"a.obj,p.json,good2.obj,0.5", None), (b"a\xff.obj,p.json,x.obj,1", r"UTF-8|a.*\.obj: "), (b'a.obj,p.json,"x.obj,1', r"^t\.csv:16: ")]
    run.write("t.csv", b"in,lattice,out,H\n" + b"\n".join(row for row, _ in rows) + b"\n")
    batch(run, "--csv", "t.csv", "--report", "r.json", done=2, failed=[told for _, told in rows if told])
    equal([(e["line"], e["status"]) for e in report(run)], [(i, "failed" if told else "ok") for i, (_, told) in enumerate(rows, 2)])
    raised(run, "good1.obj", 1)
    raised(run, "good2.obj", 0.5)
    check(not run.exists("x.obj"), "a bad row wrote")


@case
def bad_tables(run):
    begin(run)
    for header in ("", "\n", "in,lattice,out,H,H\na.obj,p.json,x.obj,1,2\n", "in,in,lattice,out,H\na.obj,a.obj,p.json,x.obj,1\n",
                   "in,lattice,out,H,\na.obj,p.json,x.obj,1,2\n", '"in,lattice,out,H\n'):
        run.write("t.csv", header)
        said = run.ffd("batch", "--csv", "t.csv", code=INVALID).err[0]
        check(said.startswith("t.csv:1: "), repr(header), "said", said)
    run.ffd("batch", "--csv", "none.csv", code=IO)
    run.write("t.csv", "in,lattice,out,H\n")
    batch(run, "--csv", "t.csv")
    check(not run.exists("x.obj"), "a bad table wrote")
    # A column that no lattice has a placeholder for.
    run.write("t.csv", "in,lattice,out,H,K\na.obj,p.json,x.obj,1,2\n")
    batch(run, "--csv", "t.csv", failed=['"K"'])


@case
def options_stand_in_for_columns(run):
    begin(run)
    run.write("t.csv", "out,H\nb.obj,0.5\nc.obj,0.25\n")
    batch(run, "--csv", "t.csv", "--in", "a.obj", "-l", "p.json", done=2)
    raised(run, "b.obj", 0.5)
    raised(run, "c.obj", 0.25)
    for name in ("x.obj", "y.obj"):
        run.write(name, CUBE)
    for folder in ("out", "out2"):
        run.folder_of(folder)
    run.write("t.csv", "in,H\nx.obj,0.5\ny.obj,0.125\n")
    batch(run, "--csv", "t.csv", "-l", "p.json", "--out-dir", "out", done=2)
    raised(run, "out/x.obj", 0.5)
    raised(run, "out/y.obj", 0.125)
    run.write("t.csv", "in,H\nx.obj,0.5\nx.obj,0.125\n")
    run.ffd("batch", "--csv", "t.csv", "-l", "p.json", "--out-dir", "out2", code=(NO, USAGE), err=lambda said: None)
    if run.exists("out2/x.obj"):
        raised(run, "out2/x.obj", 0.5)  # the second one must not have replaced it


@case
def tables_and_the_options_of_batches(run):
    begin(run)
    run.write("t.csv", "in,lattice,out,H\n" + "".join(f"a.obj,p.json,o{i}.obj,{i / 16}\n" for i in range(20)))
    batch(run, "--csv", "t.csv", "--dry-run", done=20, out="".join(f"to do: a.obj -> o{i}.obj\n" for i in range(20)))
    for shard in range(3):
        batch(run, "--csv", "t.csv", "--shard", f"{shard}/3", done=len(range(shard, 20, 3)))
    for i in range(20):
        raised(run, f"o{i}.obj", i / 16)
    batch(run, "--csv", "t.csv", "--resume", "--normals", "keep", "-j", "3", done=20)
    run.write("t.csv", run.text("t.csv").replace("o7.obj,0.4375", "o7.obj,0.75"))
    batch(run, "--csv", "t.csv", "--resume", "--normals", "keep", done=1, kept=19)
    raised(run, "o7.obj", 0.75)


main()
