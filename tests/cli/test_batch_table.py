#!/usr/bin/env python3
"""Placeholders in the moves of a lattice: ffd deform --set, "set" in the lines of a manifest, ffd batch --csv; and what a
dry run sees of them."""

import json
import re

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
def a_table_without_rows(run):
    """It is said; so is why its rows are not seen."""
    begin(run)
    words = ("--in", "a.obj", "-l", "p.json", "--out-dir", "o", "--dry-run")
    run.write("t.csv", "H\n\n \n")
    said = []
    run.ffd("batch", "--csv", "t.csv", *words, err=said.extend)
    equal(said[:-1], ["t.csv: has no jobs"])
    for table, line, reason in (("H\r1\r2\r", 1, "the lines end with CR alone: a table needs LF or CR LF"),
                                ("out,H\rx.obj,1\r", 1, "the lines end with CR alone: a table needs LF or CR LF"),
                                ("H\n\0\0\n", 2, "NUL bytes, and no job before them")):
        run.write("t.csv", table)
        run.ffd("batch", "--csv", "t.csv", *words, code=INVALID, err=f"t.csv:{line}: {reason}")
    run.write("t.csv", "\0" * 100)
    run.ffd("batch", "--csv", "t.csv", *words, code=INVALID)


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
    jobs = [job(i, lattice="p.json", set={"H": (i + 1) / 16}) for i in range(12)]
    jobs += [job(12, lattice=["p.json", "k.json"], set={"H": 0.25, "K": 0.5}), job(13, lattice=["l.json", "p.json"], set={"H": -0.5})]
    run.write("m.jsonl", lines_of(jobs))
    batch(run, "m.jsonl", "-j", "2", done=14)
    for i in range(12):
        raised(run, f"o{i}.obj", (i + 1) / 16)
    raised(run, "o12.obj", 1)
    raised(run, "o13.obj", -0.5)
    for i in (3, 7):
        run.ffd("deform", "a.obj", "s.obj", "-l", "p.json", "--set", f"H={(i + 1) / 16}", "--force")
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
def a_set_that_does_not_fit_fails_its_job(run):
    begin(run)
    bad = [([], '"set"'), (3, '"set"'), ("H=1", '"set"'), ({}, '"H"'), ({"H": "1"}, r"p\.json:1: /moves/0/by/1"), ({"H": [1]}, r"p\.json:1: /moves/0/by/1"),
           ({"H": None}, r"p\.json:1: /moves/0/by/1"), ({"H": True}, r"p\.json:1: /moves/0/by/1"), ({"H": 1, "K": 2}, '"K"'), ({"h": 1}, '"H"')]
    run.write("m.jsonl", lines_of([job(i, lattice="p.json", set=value) for i, (value, _) in enumerate(bad)] + [job(99, lattice="p.json", set={"H": 1})]))
    batch(run, "m.jsonl", "--report", "r.json", failed=[told for _, told in bad], done=1)
    equal([e["exit"] for e in report(run)], [INVALID] * len(bad) + [OK])
    equal([n for n in run.names() if n.startswith("o")], ["o99.obj"])


@case
def a_row_of_a_table_is_a_job(run):
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
    run.write("t.csv", "H,out,dx,in,lattice\n0.5,d.obj,0,a.obj,two.json\n-0.25x,e.obj,0.0,a.obj,two.json\n")
    batch(run, "--csv", "t.csv", done=1, failed=['"-0.25x"'])
    raised(run, "d.obj", 0.5)


@case
def quoted_cells_hold_commas_quotes_and_line_ends(run):
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
def bad_rows_fail_alone(run):
    begin(run)
    rows = [(b"a.obj,p.json,x1.obj", r"^t\.csv:2: .*3.*4"), (b"a.obj,p.json,x2.obj,1,2", r"^t\.csv:3: .*5.*4"), (b"a.obj,p.json,good1.obj,1", None),
            (b'a.obj,p.json,"x3.obj"x,1', r"^t\.csv:5: "), (b'a.obj,p.json,x".obj,1', r"^t\.csv:6: "), (b",p.json,x4.obj,1", r'^t\.csv:7: .*"in"'),
            (b"a.obj,,x5.obj,1", r'^t\.csv:8: .*"lattice"'), (b"a.obj,p.json,,1", r'^t\.csv:9: .*"out"'), (b"a.obj,p.json,x6.obj,abc", "abc"),
            (b"a.obj,p.json,x7.obj,", r"p\.json:1: /moves/0/by/1"), (b"a.obj,p.json,x8.obj,nan", "nan"), (b"none.obj,p.json,x9.obj,1", r"^none\.obj: "),
            (b"a.obj,p.json,good2.obj,0.5", None), (b"a.obj,p.json,x12.obj,1\x002", r"^t\.csv:15: .*UTF-8"), (b"a\xff.obj,p.json,x10.obj,1", r"UTF-8|a.*\.obj: "), (b'a.obj,p.json,"x11.obj,1', r"^t\.csv:17: ")]
    run.write("t.csv", b"in,lattice,out,H\n" + b"\n".join(row for row, _ in rows) + b"\n")
    batch(run, "--csv", "t.csv", "--report", "r.json", done=2, failed=[told for _, told in rows if told])
    equal([(e["line"], e["status"]) for e in report(run)], [(i, "failed" if told else "ok") for i, (_, told) in enumerate(rows, 2)])
    raised(run, "good1.obj", 1)
    raised(run, "good2.obj", 0.5)
    check(not any(name.startswith("x") for name in run.names()), "a bad row wrote")


@case
def bad_tables_are_refused(run):
    begin(run)
    for header in ("", "\n", "in,lattice,out,H,H\na.obj,p.json,x.obj,1,2\n", "in,in,lattice,out,H\na.obj,a.obj,p.json,x.obj,1\n",
                   "in,lattice,out,H\0\na.obj,p.json,x.obj,1\n", '"in,lattice,out,H\n'):
        run.write("t.csv", header)
        said = run.ffd("batch", "--csv", "t.csv", code=INVALID).err[0]
        check(said.startswith("t.csv:1: "), repr(header), "said", said)
    run.ffd("batch", "--csv", "none.csv", code=IO)
    check(not run.exists("x.obj"), "a bad table wrote")
    # A column that no lattice has a placeholder for.
    run.write("t.csv", "in,lattice,out,H,K\na.obj,p.json,x.obj,1,2\n")
    batch(run, "--csv", "t.csv", failed=['"K"'])


def sets_of(run, table, *arguments, name="t.csv", code=OK):
    """What the rows of a table set, and what is said of the table."""
    run.write(name, table)
    done = run.ffd("batch", "--csv", name, "--in", "a.obj", "-l", "p.json", "--dry-run", "--report", "r.json", *arguments, code=code,
                   err=lambda said: None)
    return [(e["output"], e["set"]) for e in report(run)], [line for line in done.err if line.startswith(name)]


@case
def dialects_of_tables(run):
    """Tabs, bars, a line "sep=;", blanks beside separators, columns without a name: each means what it does in a table with commas."""
    begin(run)
    plain = [("b.obj", {"H": 0.5}), ("c.obj", {"H": 0.25})]
    for table in ("out,H\nb.obj,0.5\nc.obj,0.25\n", "out\tH\nb.obj\t0,5\nc.obj\t.25\n", "out;H\nb.obj;0,5\nc.obj;0.25\n",
                  "out , H\n b.obj ,\t0.5\nc.obj, 0.25 \n", '"out", "H"\n"b.obj" , "0.5"\n"c.obj", 0.25\n',
                  ",out,H\n0,b.obj,0.5\n1,c.obj,0.25\n", "out,H,\nb.obj,0.5,\nc.obj,0.25,\n", ",,out,H\n0,1,b.obj,0.5\n1,1,c.obj,0.25\n",
                  "\tout\tH\n0\tb.obj\t0.5\n1\tc.obj\t0.25\n", "out\tH\n\"b.obj\"\t\"0.5\"\nc.obj\t0.25\n",
                  "out|H\nb.obj|0,5\nc.obj|0.25\n", "sep=;\r\nout;H\r\nb.obj;0,5\r\nc.obj;0.25\r\n", '"sep=,"\nout,H\nb.obj,0.5\nc.obj,0.25\n',
                  "\ufeffsep=\t\nout\tH\nb.obj\t0.5\nc.obj\t0.25\n", "sep=|\nout|H\nb.obj|0.5\nc.obj|0.25\n", "sep=;\nout;H\nb.obj;0.5\nc.obj;0,25\n"):
        equal(sets_of(run, table)[0], plain, repr(table))
    equal(sets_of(run, 'out,H\n" b.obj",0.5\n')[0], [(" b.obj", {"H": 0.5})], "blanks in quotes belong to the name")
    for table, told in (("OUT,H\nb.obj,1\n", 'line 1: the column "OUT" sets a placeholder: files are in columns "in", "out" and '
                                             '"lattice", in small letters'),
                        ("# out,H\nb.obj,1\n", 'line 1: the first row names the columns, although it begins with "# out"'),
                        ("out,H\n b.obj,1\n c.obj,2\n", 'line 2: blanks beside "b.obj" are left out (the first of 2 such)'),
                        ("sep=;\nout;H\nb.obj;1\n", 'line 1: the line names the separator: the columns are named in the next one'),
                        ("out|H\nb.obj|1\n", 'line 1: the columns are separated by bars: numbers may have a decimal comma'),
                        ("out,H\nb.obj,1\n,\n , \n", 'line 3: all cells of the row are empty: its job has the values of --set and the '
                                                        'defaults (the first of 2 such)'),
                        ("out H\nb.obj 1\n", 'line 1: the table has one column, "out H": commas, semicolons, tabs and bars separate columns, '
                                               'blanks and colons do not'),
                        ("# H : out\n1 : b.obj\n", 'line 1: the table has one column, "# H : out": commas, semicolons, tabs and bars '
                                                   'separate columns, blanks and colons do not'),
                        ("out , H\nb.obj, 1\n", 'line 1: blanks beside "out" are left out (the first of 2 such)')):
        check("t.csv: " + told in sets_of(run, table, "--out-dir", ".", code=(OK, NO))[1], table)
    # What only looks like it.
    for table in ("out H,out\n1,b.obj\n", "out\nb.obj\n", " out \nb.obj\n", "outer H\n1\n", "no H\n1\n"):
        check(not [line for line in sets_of(run, table, "--out-dir", ".", code=(OK, NO))[1] if "has one column" in line], table)
    for table in ("sep=\nb.obj\n", "sep=:\nb.obj\n", "sep=;;\nb.obj;1;2\n"):
        check(not [line for line in sets_of(run, table, "--out-dir", ".", code=(OK, NO))[1] if "names the separator" in line], table)
    run.write("t.csv", "sep=;\n")
    run.ffd("batch", "--csv", "t.csv", code=INVALID, err="t.csv:1: the first row of the table must name its columns")
    for table, told in (('out,H\nb.obj,1\n"c.obj,2\nd.obj,3\n', "t.csv:3: not a valid CSV row: the quote that was opened in line 3 is not closed"),
                        ('out,H,N\nb.obj,1,"a\nb"\nc.obj,"1",\n"c.obj",2,"d\n', "t.csv:5: not a valid CSV row: the quote that was opened in line 5 is not closed"),
                        ('out,H,N\nb.obj,1,"a\nb","c\nd.obj,3\n', "t.csv:2: not a valid CSV row: the quote that was opened in line 3 is not closed"),
                        ('out,H\nb.obj,1\nc"d.obj,2\n', "t.csv:3: not a valid CSV row: a quote stands beside other characters of its cell")):
        run.write("t.csv", table)
        ignored = ["--csv-ignore", "N"] if "N" in table[:8] else []
        done = run.ffd("batch", "--csv", "t.csv", "--in", "a.obj", "-l", "p.json", *ignored, "--dry-run", code=NO, err=lambda said: None)
        check(told in done.err, done.err)
    run.write("t.csv", 'out,"H\nb.obj,1\n')
    run.ffd("batch", "--csv", "t.csv", "--in", "a.obj", code=INVALID,
            err="t.csv:1: not a valid CSV row: the quote that was opened in line 1 is not closed")
    run.ffd("batch", "--csv", "a.obj", "--in", "a.obj", code=INVALID, err="a.obj: has the ending of a mesh, not of a table")
    for codec in ("utf-16-le", "utf-16-be"):
        run.write("t.csv", ("\ufeffout,H\nb.obj,1\n").encode(codec))
        for arguments in (["--csv", "t.csv", "--in", "a.obj", "-l", "p.json"], ["t.csv"]):
            run.ffd("batch", *arguments, code=INVALID, err="t.csv:1: is text in UTF-16: it must be UTF-8")


@case
def an_empty_cell_leaves_the_value_to_set_or_to_the_default(run):
    begin(run, parameters={"H": {"default": 3}})
    table = 'out,H\nb.obj,\nc.obj, \nd.obj,1\n'
    equal(sets_of(run, table)[0], [("b.obj", {}), ("c.obj", {}), ("d.obj", {"H": 1})])
    equal(sets_of(run, table, "--set", "H=2")[0], [("b.obj", {"H": 2}), ("c.obj", {"H": 2}), ("d.obj", {"H": 1})])
    batch(run, "--csv", "t.csv", "--in", "a.obj", "-l", "p.json", done=3)
    raised(run, "b.obj", 3)
    equal(sets_of(run, 'out,H\nb.obj,""\n', code=NO)[0], [("b.obj", {"H": ""})], "in quotes it is an empty text")


@case
def long_tables_and_lines_take_linear_time(run):
    """Each of these took minutes: 80,000 columns, left out or not; as many values in a line of a manifest; 30,000 clips."""
    begin(run)
    count = 80000
    names = ",".join(f"c{i}" for i in range(count))
    run.write("t.csv", names + "\n" + ",".join("1" * count) + "\n")
    said = []
    run.folder_of("o")
    for ignored in ([], ["--csv-ignore", ",".join(f"c{i}" for i in range(1, 16000))]):
        run.ffd("batch", "--csv", "t.csv", "--in", "a.obj", "-l", "p.json", "--out-dir", "o", *ignored, code=NO, err=said.extend)
    run.write("m.jsonl", json.dumps({**job(0, lattice="p.json"), "set": {f"c{i}": 1 for i in range(count)}}))
    run.ffd("batch", "m.jsonl", code=NO, err=said.extend)
    equal(sum('has no value' in line for line in said), 3, said)
    clips = [f"c{i}: 0 a=1" for i in range(30000)]
    run.write("m.jsonl", json.dumps({"in": "a.obj", "morph": {"a": "p.json"}, "clip": [*clips, clips[0]], "out": "o.glb", "set": {"H": 1}}))
    run.ffd("batch", "m.jsonl", code=NO, err=said.extend)
    check(any('--clip: two clips are called "c0"' in line for line in said), said[-2:])
    run.write("m.jsonl", json.dumps({"in": "a.obj", "morph": {f"a{i}": "p.json" for i in range(30000)}, "out": "o.glb"}))
    run.ffd("batch", "m.jsonl", code=NO, err=said.extend)
    check(any("a job has at most 1024 lattices, not 30000" in line for line in said), said[-2:])


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
    # A mesh that serves several rows, under whatever names, is written with their numbers.
    run.write("t.csv", "in,H\nx.obj,0.5\n\ny.obj,0.25\n./x.obj,0.125\n")
    batch(run, "--csv", "t.csv", "-l", "p.json", "--out-dir", "out2", "--report", "r.json", done=3)
    equal(run.names("out2"), ["x-1.obj", "x-3.obj", "y.obj"])
    for name, height in (("x-1", 0.5), ("x-3", 0.125), ("y", 0.25)):
        raised(run, f"out2/{name}.obj", height)
    equal([(e["line"], e["set"]) for e in report(run)], [(2, {"H": 0.5}), (4, {"H": 0.25}), (5, {"H": 0.125})])


@case
def a_row_does_not_lead_out_of_the_folder_of_outputs(run):
    """By an absolute path or "..", whatever the rest of it is. Without --out-dir, and in a manifest, any path will do."""
    begin(run)
    run.folder_of("out")
    out = ["../c.obj", run.path("abs.obj"), run.path("out/in.obj"), "d/../../c.obj", "..", "d//./../../c.obj"]
    for options in ([], ["--dry-run"], ["--resume"], ["--shard", "0/1"], ["--output-format", "off"]):
        run.write("t.csv", "out,H\n" + "".join(f"{name},0.5\n" for name in out))
        batch(run, "--csv", "t.csv", "--in", "a.obj", "-l", "p.json", "--out-dir", "out", "--report", "r.json", *options,
              failed=[rf'^t\.csv:{line}: "out" leads out of --out-dir: "{re.escape(name)}"$' for line, name in enumerate(out, 2)])
        equal([(e["line"], e["exit"]) for e in report(run)], [(line, INVALID) for line in range(2, 2 + len(out))])
        equal(run.names("out"), [])
        check(not run.exists("c.obj") and not run.exists("abs.obj"), run.names())
    run.write("t.csv", "out,H\n..c.obj,0.5\nd/..e/f..obj,0.25\nd/../g.obj,0.125\n./h.obj,0.75\n")
    batch(run, "--csv", "t.csv", "--in", "a.obj", "-l", "p.json", "--out-dir", "out", done=4)
    for name, height in (("..c.obj", 0.5), ("d/..e/f..obj", 0.25), ("g.obj", 0.125), ("h.obj", 0.75)):
        raised(run, "out/" + name, height)
    run.folder_of("sub")
    run.write("sub/t.csv", f"out,H\n../c.obj,0.5\n{run.path('abs.obj')},0.25\n")
    batch(run, "--csv", "sub/t.csv", "--in", "a.obj", "-l", "p.json", done=2)
    raised(run, "c.obj", 0.5)
    raised(run, "abs.obj", 0.25)


@case
def tables_and_the_options_of_batches(run):
    begin(run)
    run.write("t.csv", "in,lattice,out,H\n" + "".join(f"a.obj,p.json,o{i}.obj,{(i + 1) / 16}\n" for i in range(20)))
    batch(run, "--csv", "t.csv", "--dry-run", done=20, out="".join(f"to do: a.obj -> o{i}.obj\n" for i in range(20)))
    for shard in range(3):
        batch(run, "--csv", "t.csv", "--shard", f"{shard}/3", done=len(range(shard, 20, 3)))
    for i in range(20):
        raised(run, f"o{i}.obj", (i + 1) / 16)
    batch(run, "--csv", "t.csv", "--resume", "--normals", "keep", "-j", "3", done=20)
    run.write("t.csv", run.text("t.csv").replace("o7.obj,0.5", "o7.obj,0.75"))
    batch(run, "--csv", "t.csv", "--resume", "--normals", "keep", done=1, kept=19)
    raised(run, "o7.obj", 0.75)


ODD_NUMBERS = {".5": 0.5, "+.5": 0.5, "-.25": -0.25, "5.": 5, "+2": 2, "05": 5, "-00.5e+1": -5, " +1 ": 1, "+1e-1": 0.1}
NO_NUMBERS = (".", "+", "-", "+-1", "1e", "1e+", "0x1", "1,5", "1 5", "++1", ".e1", "+1e400", "+inf", "--5")


@case
def numbers_as_people_write_them(run):
    begin(run)
    cells = [*ODD_NUMBERS, *NO_NUMBERS]
    run.write("t.csv", "in,lattice,out,H\n" + "".join(f'a.obj,p.json,o{i}.obj,"{cell}"\n' for i, cell in enumerate(cells)))
    odd, bad = len(ODD_NUMBERS), len(NO_NUMBERS)
    flaw = f't.csv: line 2: ".5" is no number in JSON, and is read as 0.5 (the first of {odd} such)'

    def judge(said):
        check(said[-2] == flaw, "not said:", flaw, "but", said)
        equal(len(said), bad + 2, said)
        check(all("must be a number" in line or "is not in the range" in line for line in said[:bad]), said)

    run.ffd("batch", "--csv", "t.csv", "--report", "r.json", code=NO, err=judge)
    for i, value in enumerate(ODD_NUMBERS.values()):
        raised(run, f"o{i}.obj", value)
    equal([e["set"] for e in report(run)], [{"H": value} for value in ODD_NUMBERS.values()] + [{"H": cell} for cell in NO_NUMBERS])
    # What --strict refuses is just that.
    run.write("t.csv", "in,lattice,out,H\na.obj,p.json,x.obj,.5\na.obj,p.json,y.obj,0.5\n")
    batch(run, "--csv", "t.csv", "--strict", done=1, failed=[r'^t\.csv:2: ".5" is no number in JSON'])
    run.ffd("batch", "--csv", "t.csv", "-q", "--force", err=[])


@case
def semicolons_and_decimal_commas_are_understood(run):
    begin(run)
    said = "t.csv: line 1: the columns are separated by semicolons: numbers may have a decimal comma"
    values = {"0,5": 0.5, "-1,25": -1.25, ",5": 0.5, "+2": 2, "3": 3, "0.75": 0.75, '"1,5"': 1.5, "1,5e1": 15}
    run.write("t.csv", b"\xef\xbb\xbf" + ("out;H\r\n" + "".join(f'"o{i}.obj";{cell}\r\n' for i, cell in enumerate(values))).encode())
    arguments = ["--csv", "t.csv", "--in", "a.obj", "-l", "p.json"]
    done = run.ffd("batch", *arguments, err=lambda lines: equal(len(lines), 3, lines))
    equal(done.err[:2], [said, 't.csv: line 5: "+2" is no number in JSON, and is read as 2'])
    for i, value in enumerate(values.values()):
        raised(run, f"o{i}.obj", value)
    run.ffd("batch", *arguments, "--strict", code=INVALID, err=said.replace(" line 1:", "1:"))
    # With commas a semicolon is nothing but that, and so is one within quotes.
    run.write("t.csv", 'out,H\n"o;1.obj",0.5\n"o,1;2.obj","0.25"\n')
    batch(run, *arguments, done=2)
    raised(run, "o;1.obj", 0.5)
    raised(run, "o,1;2.obj", 0.25)
    run.write("t.csv", 'out,"H;x"\no9.obj,0.5\n')
    batch(run, *arguments, failed=[r'^t\.csv:2: H;x=0\.5: p\.json'])
    # A vector within a cell keeps its commas.
    run.write("v.json", lattice(moves=[{"by": {"$": "V"}}]))
    run.write("t.csv", "out;V\nv.obj;[0, 0.5, 0]\n")
    run.ffd("batch", "--csv", "t.csv", "--in", "a.obj", "-l", "v.json", err=lambda lines: equal(lines[0], said))
    raised(run, "v.obj", 0.5)


@case
def dots_before_three_digits_beside_decimal_commas(run):
    """They may stand for thousands: a warning, whichever comes first. Each column by itself."""
    begin(run)
    arguments = ["--csv", "t.csv", "--in", "a.obj", "-l", "p.json", "--force"]

    def mixed(line, cell):
        return f't.csv:{line}: column "H" has decimal commas, and dots before three digits, which are read as decimal points too: "{cell}"'

    for cells, said in ((["0,5", "1.500"], mixed(3, "1.500")), (["1.500", "0,5"], mixed(3, "0,5")), (["0,5", "1.5"], None),
                        (["0,5", "1.5000"], None), (["1.500", "2.250"], None), (["0,5", "2,500"], None)):
        run.write("t.csv", "out;H\n" + "".join(f"o{i}.obj;{cell}\n" for i, cell in enumerate(cells)))
        done = run.ffd("batch", *arguments, err=lambda lines: True)
        equal([line for line in done.err if "dots" in line], [said.replace("t.csv:3:", "t.csv: line 3:")] if said else [], str(cells))
        for i, cell in enumerate(cells):
            raised(run, f"o{i}.obj", float(cell.replace(",", ".")))
    # With commas between the cells a dot is the decimal point.
    run.write("t.csv", "out,H\no0.obj,1.500\no1.obj,0.5\n")
    batch(run, *arguments, done=2)


@case
def columns_are_left_out(run):
    begin(run)
    run.write("t.csv", "in,note,H,out,who\na.obj,first,0.5,b.obj,me\na.obj,second,0.25,c.obj,you\n")
    table = ["--csv", "t.csv", "-l", "p.json"]
    told = r'^p\.json: no lattice has the placeholders \{"\$": "note"\}, \{"\$": "who"\} \(--set\); --csv-ignore leaves columns of a table out$'
    batch(run, *table, failed=[told] * 2)
    batch(run, *table, "--dry-run", failed=[told] * 2, out="")
    batch(run, *table, "--csv-ignore", "note", failed=[r'placeholder \{"\$": "who"\}'] * 2)
    batch(run, *table, "--csv-ignore", "who,note", "--report", "r.json", done=2)
    raised(run, "b.obj", 0.5)
    equal([e["set"] for e in report(run)], [{"H": 0.5}, {"H": 0.25}])
    for names in ("nobody", "note,nobody", "not", "note,who,h"):
        run.ffd("batch", *table, "--csv-ignore", names, code=INVALID,
                err=f't.csv:1: the table has no column "{names.split(",")[-1]}" (--csv-ignore)')
    run.write("m.jsonl", lines_of([job(0)]))
    run.ffd("batch", "m.jsonl", "--csv-ignore", "note", code=USAGE)
    # The columns of files too.
    run.folder_of("out")
    run.write("b2.obj", CUBE)
    batch(run, *table, "--csv-ignore", "note,who,out,in", "--in", "b2.obj", "--out-dir", "out", done=2)
    equal(run.names("out"), ["b2-1.obj", "b2-2.obj"])


@case
def outputs_without_a_column(run):
    begin(run)
    run.folder_of("out")
    one = ["--csv", "t.csv", "--in", "a.obj", "-l", "p.json", "--out-dir", "out"]

    def made(*arguments, **options):
        batch(run, *one, "--force", *arguments, **options)
        names = run.names("out")
        for name in names:
            run.remove("out/" + name)
        return names

    run.write("t.csv", "H\n0.5\n")
    equal(made(done=1), ["a.obj"])
    run.write("t.csv", "H\n0.5\n\n0.25\n" + "0.125\n" * 9)
    equal(made(done=11), sorted(f"a-{i}.obj" for i in range(1, 12)))
    # Each shard gives the names of the whole, and a malformed row has its number too.
    equal(made("--shard", "1/4", done=3), ["a-10.obj", "a-2.obj", "a-6.obj"])
    run.write("t.csv", 'H\n0.5\n"0.25"x\n0.125\n')
    equal(made(failed=["not a valid CSV row"], done=2), ["a-1.obj", "a-3.obj"])
    # With a column an empty cell is the input's name, which serves once.
    run.write("t.csv", "out,H\n,0.5\nb.obj,0.25\n,0.125\n")
    equal(made(done=2, failed=[r'^t\.csv:4: "out/a\.obj" is written by the job of line 2 too$']), ["a.obj", "b.obj"])
    # Other meshes of one name are not one mesh.
    run.write("other/a.obj", CUBE)
    run.write("t.csv", "in,H\na.obj,0.5\nother/a.obj,0.25\n")
    equal(made(done=1, failed=[r'^t\.csv:3: "out/a\.obj" is written by the job of line 2 too$']), ["a.obj"])
    # Standard input cannot be looked through beforehand.
    batch(run, "--csv", "-", *one[2:], done=1, stdin=b"H\n0.5\n")
    equal(run.names("out"), ["a-1.obj"])
    run.write("x.y.obj", CUBE)
    run.write("t.csv", "in,H\nx.y.obj,0.5\nx.y.obj,1\n")
    equal(made(done=2), ["a-1.obj", "x.y-1.obj", "x.y-2.obj"])


@case
def all_missing_values_at_once(run):
    begin(run, [{"by": [{"$": "A"}, {"$": "B"}, {"$": "A"}]}, {"by": [{"$": "C"}, 0, 0]}])
    run.write("k.json", lattice(moves=[{"by": [{"$": "D"}, {"$": "B"}, 0]}]))
    deform = ["deform", "a.obj", "x.obj", "-l", "p.json"]
    run.ffd(*deform, code=INVALID, err='p.json:1: /moves/0/by/0: the placeholders "A", "B", "C" have no values (--set NAME=VALUE for each)')
    run.ffd(*deform, "--set", "A=1", code=INVALID, err='p.json:1: /moves/0/by/1: the placeholders "B", "C" have no values (--set NAME=VALUE for each)')
    run.ffd(*deform, "--set", "A=1", "--set", "B=1", code=INVALID, err='p.json:1: /moves/1/by/0: the placeholder "C" has no value (--set C=VALUE)')
    # Of all lattices, whichever lacks one first.
    told = 'p.json:1: /moves/0/by/0: the placeholders "A", "B", "C", "D" have no values (--set NAME=VALUE for each)'
    run.ffd(*deform, "-l", "k.json", code=INVALID, err=told)
    run.ffd(*deform, "-l", "k.json", "--set", "A=1", "--set", "B=1", "--set", "C=1", code=INVALID,
            err='k.json:1: /moves/0/by/0: the placeholder "D" has no value (--set D=VALUE)')
    run.ffd("check", "a.obj", "-l", "p.json", "-l", "k.json", code=INVALID, err=told)
    # What a lattice has against it else is told as before.
    run.write("k.json", "{")
    run.ffd(*deform, "-l", "k.json", code=INVALID, err='p.json:1: /moves/0/by/0: the placeholders "A", "B", "C" have no values (--set NAME=VALUE for each)')
    run.ffd(*deform[:3], "-l", "k.json", "-l", "p.json", code=INVALID, err=lambda said: check(said[0].startswith("k.json:1: "), said))
    many = [{"by": [{"$": f"N{i:06}"}, 0, 0]} for i in range(2000)]
    run.write("p.json", lattice(moves=many))
    said = run.ffd(*deform, code=INVALID).err[0]
    check('"N000000", ' in said and " and 19" in said and " more have no values" in said and len(said) < 600, said)


@case
def a_dry_run_sees_what_would_be_refused(run):
    """Of every job its lattices with their values; of the first all but the writing."""
    begin(run)
    rows = ["a.obj,p.json,x1.obj,0.5", "a.obj,p.json,x2.obj,", "a.obj,p.json,x3.obj,abc", "none.obj,p.json,x4.obj,1", "a.obj,none.json,x5.obj,1",
            "a.obj,p.json,p.json/x6.obj,1"]
    run.write("t.csv", "in,lattice,out,H\n" + "\n".join(rows) + "\n")
    failed = [rf"^t\.csv:{i}: " for i in range(3, 8)]
    batch(run, "--csv", "t.csv", "--dry-run", done=1, failed=failed, out="to do: a.obj -> x1.obj\n")
    batch(run, "--csv", "t.csv", done=1, failed=failed)
    run.write("half.json", lattice(high=(2, 2, 0), moves=HEIGHT))
    run.write("m.obj", CUBE)
    for options, told in (({"outside": "error"}, "outside"), ({"fail-on": "outside"}, "outside"), ({"only": "group:none"}, "none"),
                          ({"as-morph": "m"}, "morph")):
        run.write("m.jsonl", lines_of([job(7, lattice="half.json", set={"H": 1}, options=options)]))
        batch(run, "m.jsonl", "--dry-run", failed=[told], out="")
        batch(run, "m.jsonl", failed=[told])
        check(not run.exists("o7.obj"), options)
    # The first that is not up to date.
    run.write("m.jsonl", lines_of([job(0), job(1, lattice="half.json", set={"H": 1}, options={"outside": "error"})]))
    batch(run, "m.jsonl", "--resume", done=1, failed=["outside"])
    batch(run, "m.jsonl", "--resume", "--dry-run", kept=1, failed=["outside"], out="up to date: a.obj -> o0.obj\n")
    before = run.names()
    run.write("m.jsonl", lines_of([job(2), {"in": "m.obj", "lattice": "l.json", "options": {"in-place": True}}]))
    batch(run, "m.jsonl", "--dry-run", done=2, out="to do: a.obj -> o2.obj\nto do: m.obj -> m.obj\n")
    equal((run.names(), run.text("m.obj")), (before, CUBE))


@case
def the_format_of_all_inputs(run):
    begin(run)
    run.write("a.mesh", CUBE)
    run.write("m.jsonl", lines_of([job(0, **{"in": "a.mesh"}), job(1, **{"in": "a.mesh"}, options={"input-format": "ply"})]))
    batch(run, "m.jsonl", failed=[r"^a\.mesh: ", r"^a\.mesh"])
    batch(run, "m.jsonl", "--input-format", "obj", done=1, failed=[r"^a\.mesh"])
    run.ffd("deform", "a.obj", "s.obj", "-l", "l.json")
    equal(run.read("o0.obj"), run.read("s.obj"))
    batch(run, "m.jsonl", "--input-format", "obj", "--resume", kept=1, failed=[r"^a\.mesh"])
    run.ffd("batch", "m.jsonl", "--input-format", "nonsense", code=USAGE)


main()
