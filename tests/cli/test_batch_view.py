#!/usr/bin/env python3
"""ffd batch --view: a picture a job, named after its output, and a page that lists all jobs with their figures."""

import html.parser
import json
import os
import re
import shutil
import signal
import struct
import subprocess

from batches import batch, case, check, equal, job, lattice, lines_of, main, names, report, start
from harness import CUBE, FFD, IO, NO, SANITIZED, SECONDS, USAGE, wait_until
from messages import anything
from png import chunks
from urllib.parse import unquote

# A picture takes a moment: so many that a signal comes before the last.
JOBS = 12 if SANITIZED else 24
FOLD = [{"at": [1, 1, 1], "by": [30, 30, 30]}]
COLUMNS = ["Line", "Output", "Parameters", "Largest displacement", "Torn edges", "Folds", "Flipped faces", "State"]


class Index(html.parser.HTMLParser):
    """The rows of a page: of each cell its text and its key, and the address of the picture."""
    VOID = {"meta", "img"}

    def __init__(self, text):
        super().__init__()
        self.rows, self.cell, self.policy, self.addresses, self.open, self.counts = [], None, None, [], [], ""
        self.feed(text)
        self.close()
        equal(self.open, [], "elements that are not closed")

    def handle_starttag(self, tag, attrs):
        attrs = dict(attrs)
        equal(len([a for a in attrs if a.startswith("on") or a == "style"]), 0, "attributes that run or style")
        if tag not in self.VOID:
            self.open.append((tag, attrs.get("id")))
        if attrs.get("http-equiv") == "Content-Security-Policy":
            self.policy = attrs["content"]
        self.addresses += [attrs[a] for a in ("src", "href") if a in attrs]
        if tag == "tr" and ("tbody", None) in self.open:
            self.rows.append({"picture": None})
        if tag in ("td", "th") and "data-label" in attrs:
            self.cell = attrs["data-label"]
            self.rows[-1][self.cell] = ["", attrs.get("data-key")]
        if tag == "img":
            self.rows[-1].update(picture=unquote(attrs["src"]), alt=attrs["alt"], loading=attrs["loading"])

    def handle_endtag(self, tag):
        equal(self.open.pop()[0], tag, "the element that ends")
        if tag in ("td", "th"):
            self.cell = None

    def handle_data(self, data):
        if self.cell:
            self.rows[-1][self.cell][0] += data
        if self.open and self.open[-1] == ("p", "counts"):
            self.counts += data


def index(run, name="v/index.html"):
    found = Index(run.text(name))
    check(re.fullmatch(r"default-src 'none'; img-src 'self'; script-src 'sha256-[\w+/=]+'; style-src 'sha256-[\w+/=]+'; "
                       r"base-uri 'none'; form-action 'none'", found.policy), found.policy)
    for row in found.rows:
        equal(sorted(set(COLUMNS) - set(row)), [], "columns that are missing")
        if row["picture"]:
            check(run.exists(os.path.join(os.path.dirname(name), row["picture"])), row["picture"], "is not there")
            equal(row["loading"], "lazy")
    for address in found.addresses:
        check(not re.match(r"/|\w+:|.*\.\.", address), address, "leads out")
    return found


def column(found, label, part=0):
    return [row[label][part] for row in found.rows]


def pictures(run, folder="v"):
    return sorted(os.path.relpath(os.path.join(where, name), run.path(folder)) for where, _, files in os.walk(run.path(folder))
                  for name in files if name.endswith(".png"))


def is_picture(run, name):
    found = list(chunks(run.read(name)))
    equal((found[0][0], found[-1][0], struct.unpack(">II", found[0][1][:8])), (b"IHDR", b"IEND", (1600, 900)), name)


@case
def a_picture_a_job_and_an_index(run):
    start(run, [job(0), job(1, lattice="fold.json"), {**job(), "out": "deep/o0.obj"}, job(3, **{"in": "gone.obj"})])
    run.write("fold.json", lattice(moves=FOLD))
    run.folder_of("deep")
    said = []
    run.ffd("batch", "m.jsonl", "--view", "new/v", "--report", "r.json", code=NO, err=said.extend, out="")
    equal(sorted(bool(re.search("gone.obj|the deformed volume folds|4 jobs in", line)) for line in said), [True] * 3, said)
    equal(pictures(run, "new/v"), ["deep/o0.obj.png", "o0.obj.png", "o1.obj.png"])
    equal([e.get("picture") for e in report(run)],
          ["new/v/o0.obj.png", "new/v/o1.obj.png", "new/v/deep/o0.obj.png", None])
    is_picture(run, "new/v/o0.obj.png")
    # The same one as that of a check.
    run.ffd("check", "a.obj", "-l", "fold.json", "--picture", "p.png")
    equal(run.read("new/v/o1.obj.png") == run.read("p.png"), True, "the picture of a check")
    found = index(run, "new/v/index.html")
    equal([row["picture"] for row in found.rows], ["o0.obj.png", "o1.obj.png", "deep/o0.obj.png", None])
    equal(column(found, "Line"), ["1", "2", "3", "4"])
    equal(column(found, "Output"), [f"{out} from {mesh}.obj" for out, mesh in
                                    (("o0.obj", "a"), ("o1.obj", "a"), ("deep/o0.obj", "a"), ("o3.obj", "gone"))])
    entries = report(run)
    equal([float(key) for key in column(found, "Largest displacement", 1)[:3]], [e["displacement"]["max"] for e in entries[:3]])
    check(re.match(r"\d+ cells?, det J to -", found.rows[1]["Folds"][0]), found.rows[1])
    folds = entries[1]["folds"]
    equal([[float(x) for x in key.split()] for key in column(found, "Folds", 1)[:2]],
          [[1, 0, -entries[0]["folds"]["min_det"]], [3, folds["folded_cells"], -folds["min_det"]]])
    equal(column(found, "Flipped faces")[:2], [str(e["flipped_faces"]) for e in entries[:2]])
    equal(column(found, "Torn edges")[:3], ["none"] * 3)
    equal([row["Folds"] for row in found.rows][3], ["not known", ""])
    equal(column(found, "State")[:3], ["done"] * 3)
    check(re.match("failed: gone.obj: ", found.rows[3]["State"][0]), found.rows[3])
    equal(found.counts, "4 jobs: 3 done, 0 up to date, 1 failed")


@case
def pictures_take_the_options_of_view(run):
    start(run, [job(0), job(1)])
    look = ["--camera", "bottom", "--up", "z", "--no-cage", "--color", "det", "--size", "200x100", "--frames", "3"]
    run.ffd("batch", "m.jsonl", "--view", "v", *look, err=lambda said: None)
    run.ffd("view", "a.obj", "-l", "l.json", "-o", "p.png", *look)
    check(run.read("v/o0.obj.png") == run.read("p.png") == run.read("v/o1.obj.png"), "the picture of view")
    for option in (["--camera", "front"], ["--up", "y"], ["--no-cage"], ["--color", "plain"], ["--size", "20x20"], ["--frames", "2"],
                   ["--animation", "x"]):
        run.ffd("batch", "m.jsonl", *option, code=USAGE, err=re.compile(f"{option[0]} needs --view"))
    run.ffd("batch", "m.jsonl", "--view", "w", "--up", "w", code=USAGE, err=re.compile("--up"))


@case
def torn_edges_have_their_column(run):
    """The box ends between the cube's sides and holds its edges there at full strength."""
    start(run, [job(0)])
    run.write("l.json", lattice(low=(-1, -1, -1), high=(0.5, 2, 2), moves=[{"by": [0, 0, 0.25]}]))
    run.ffd("batch", "m.jsonl", "--view", "v", "--report", "r.json", err=lambda said: None)
    tear = report(run)[0]["tear"]
    check(tear["edges"] > 0, tear)
    text, key = index(run).rows[0]["Torn edges"]
    equal(text, f"{tear['edges']}, step to {tear['largest']:g}")
    equal([float(x) for x in key.split()], [tear["edges"], tear["largest"]])


@case
def what_exists_needs_force(run):
    start(run, [job(0), job(1)])
    run.folder_of("v")
    run.write("v/o1.obj.png", "mine")
    batch(run, "m.jsonl", "--view", "v", done=1, failed=["^v/o1.obj.png: exists already.*--force"])
    check(not run.exists("o1.obj"), "a job whose picture is refused writes its output")
    equal(run.text("v/o1.obj.png"), "mine")
    before = run.read("v/index.html")
    run.ffd("batch", "m.jsonl", "--view", "v", "--report", "r.json", code=IO, err=re.compile("^v/index.html: exists already.*--force"))
    check(not run.exists("r.json"), "a report of a run that does not begin")
    run.ffd("batch", "m.jsonl", "--view", "v", "--dry-run", code=IO, err=re.compile("^v/index.html: exists already"))
    equal(run.read("v/index.html"), before)
    batch(run, "m.jsonl", "--view", "v", "--force", done=2)
    is_picture(run, "v/o1.obj.png")
    batch(run, "m.jsonl", "--view", "v", "--if-changed", done=2)
    # A folder's name that is a file's.
    run.ffd("batch", "m.jsonl", "--view", "a.obj", "--force", code=IO, err=re.compile("^a.obj"))
    # A job's own option is of its picture too.
    run.remove("v/index.html")
    run.write("m.jsonl", lines_of([job(0, options={"force": True}), job(1)]))
    batch(run, "m.jsonl", "--view", "v", done=1, failed=["^v/o1.obj.png: exists already"])


@case
def resume_draws_what_is_missing(run):
    start(run, [job(i) for i in range(3)])
    batch(run, "m.jsonl", "--resume", done=3)
    before = {i: os.stat(run.path(f"o{i}.obj")).st_mtime_ns for i in range(3)}
    # Pictures of what was made without them.
    batch(run, "m.jsonl", "--view", "v", "--resume", "--report", "r.json", done=3)
    equal([e["folds"]["verdict"] for e in report(run)], ["none"] * 3)
    check(all(e["vertices"] == 8 and e["displacement"]["max"] > 0 for e in report(run)), "figures")
    run.remove("v/o0.obj.png")
    os.utime(run.path("v/o1.obj.png"), (1, 1))
    last = run.read("v/o2.obj.png"), os.stat(run.path("v/o2.obj.png")).st_ino
    batch(run, "m.jsonl", "--view", "v", "--resume", "--dry-run", done=2, kept=1,
          out="to do: a.obj -> o0.obj\nto do: a.obj -> o1.obj\nup to date: a.obj -> o2.obj\n")
    check(not run.exists("v/o0.obj.png"), "a dry run draws")
    batch(run, "m.jsonl", "--view", "v", "--resume", "--report", "r.json", done=2, kept=1)
    for i in range(3):
        is_picture(run, f"v/o{i}.obj.png")
        equal(os.stat(run.path(f"o{i}.obj")).st_mtime_ns, before[i], f"o{i}.obj is left alone")
    equal((run.read("v/o2.obj.png"), os.stat(run.path("v/o2.obj.png")).st_ino), last, "the picture that was there")
    equal([e["picture"] for e in report(run)], [f"v/o{i}.obj.png" for i in range(3)])
    found = index(run)
    equal(column(found, "State"), ["done", "done", "up to date"])
    equal(column(found, "Largest displacement", 1), [column(found, "Largest displacement", 1)[0]] * 3)
    equal(found.counts, "3 jobs: 2 done, 1 up to date, 0 failed")
    # Another lattice: outputs and pictures are made again.
    old = run.read("v/o2.obj.png")
    run.write("l.json", lattice(moves=[{"by": [0, 0, 1.5]}]))
    batch(run, "m.jsonl", "--view", "v", "--resume", done=3)
    check(run.read("v/o2.obj.png") != old, "an old picture stayed")
    batch(run, "m.jsonl", "--view", "v", "--resume", kept=3)
    equal(column(index(run), "Largest displacement", 1), ["1.5"] * 3, "figures of skipped jobs")


@case
def a_dry_run_makes_nothing(run):
    start(run, [job(0), job(1)])
    batch(run, "m.jsonl", "--view", "v/w", "--dry-run", done=2, out="to do: a.obj -> o0.obj\nto do: a.obj -> o1.obj\n")
    equal(names(run), ["a.obj", "l.json", "m.jsonl"])
    run.folder_of("v")
    run.write("v/o1.obj.png", "mine")
    batch(run, "m.jsonl", "--view", "v", "--dry-run", done=1, failed=["^v/o1.obj.png: exists already"], out="to do: a.obj -> o0.obj\n")


@case
def shards_have_indexes_of_their_own(run):
    start(run, [job(i) for i in range(3)])
    for shard in range(2):
        batch(run, "m.jsonl", "--view", "v", "--shard", f"{shard}/2", done=2 - shard)
    equal(sorted(os.listdir(run.path("v"))), ["index-0-of-2.html", "index-1-of-2.html", *(f"o{i}.obj.png" for i in range(3))])
    equal([column(index(run, f"v/index-{i}-of-2.html"), "Line") for i in range(2)], [["1", "3"], ["2"]])


@case
def a_violated_gate_has_its_picture(run):
    start(run, [job(0, lattice="fold.json", options={"fail-on": "folds"}), job(1)])
    run.write("fold.json", lattice(moves=FOLD))
    batch(run, "m.jsonl", "--view", "v", "--report", "r.json", done=1, failed=["fold"])
    check(not run.exists("o0.obj"), "the output")
    is_picture(run, "v/o0.obj.png")
    equal([(e["exit"], e["picture"]) for e in report(run)], [(NO, "v/o0.obj.png"), (0, "v/o1.obj.png")])
    row = index(run).rows[0]
    equal(row["picture"], "o0.obj.png")
    check(row["State"][0].startswith("failed: ") and "det J to" in row["Folds"][0], row)


@case
def a_sweep_shows_its_parameters(run):
    start(run)
    run.write("l.json", lattice(moves=[{"by": [0, 0, {"$": "LIFT"}]}]))
    run.folder_of("out")
    run.write("t.csv", "LIFT,NOTE\n0.5,<b>&\n1.5,2\n")
    batch(run, "--csv", "t.csv", "--csv-ignore", "NOTE", "--in", "a.obj", "-l", "l.json", "--out-dir", "out", "--view", "v", done=2)
    equal(pictures(run), ["a-1.obj.png", "a-2.obj.png"])
    found = index(run)
    equal(column(found, "Parameters"), ["LIFT=0.5", "LIFT=1.5"])
    equal([float(x) for x in column(found, "Largest displacement", 1)], [0.5, 1.5])
    batch(run, "--in", run.path("a.obj"), "-l", "l.json", "--set", "LIFT=1", "--out-dir", "out", "--view", "w", done=1)
    equal(pictures(run, "w"), ["a.obj.png"])


@case
def names_are_text_and_stay_below(run):
    hostile = "<img src=x onerror=alert(1)>\"'&#?%41 \u202e.obj"
    run.folder_of("sub/out")
    start(run)
    outs = [hostile, "../up.obj", run.path("abs.obj"), "out/./x/../b.obj", "c:d.obj"]
    run.write("sub/m.jsonl", lines_of([{"in": "../a.obj", "lattice": "../l.json", "out": out} for out in outs]))
    run.folder_of("sub/out/x")
    batch(run, "sub/m.jsonl", "--view", "v", done=5)
    whole = run.path("abs.obj").lstrip("/")
    equal(pictures(run), sorted([hostile + ".png", "up.obj.png", whole + ".png", "out/b.obj.png", "c:d.obj.png"]))
    found = index(run)
    equal([row["picture"] for row in found.rows], [hostile + ".png", "up.obj.png", whole + ".png", "out/b.obj.png", "c:d.obj.png"])
    shown = hostile.replace("\u202e", "\\u{202e}")
    equal((found.rows[0]["Output"][0], found.rows[0]["alt"]), (shown + " from ../a.obj", "before and after: " + shown))


@case
def no_two_jobs_have_one_picture(run):
    run.folder_of("sub/up")
    start(run)
    run.write("sub/m.jsonl", lines_of([{"in": "../a.obj", "lattice": "../l.json", "out": out} for out in ("../up.obj", "up.obj", "up/x.obj")]))
    batch(run, "sub/m.jsonl", "--view", "v", done=2, failed=[r'"v/up.obj.png" is written by the job of line 1 too$'])
    check(not run.exists("sub/up.obj"), "the later job works")
    # An output that would be the index.
    start(run, [{**job(), "out": "v/index.html", "options": {"output-format": "obj"}}, job(1)])
    batch(run, "m.jsonl", "--view", "v", "--force", done=1, failed=["is the manifest, the table, the report, the depfile, the journal, the index or the array of this run"])
    equal(len(index(run).rows), 2)


@case
def a_picture_that_fails_fails_its_job(run):
    start(run, [job(0), job(1)])
    run.folder_of("v/o0.obj.png")
    batch(run, "m.jsonl", "--view", "v", "--force", "--report", "r.json", done=1, failed=["^v/o0.obj.png"])
    check(not run.exists("o0.obj"), "what can be seen before is refused before")
    entry = report(run)[0]
    equal(("picture" in entry, entry["exit"]), (False, IO))
    equal(index(run).rows[0]["picture"], None)
    # So is a folder that cannot be made.
    run.write("m.jsonl", lines_of([{**job(), "out": "d/o2.obj"}]))
    run.folder_of("d")
    run.write("v/d", "a file")
    batch(run, "m.jsonl", "--view", "v", "--resume", "--report", "r.json", failed=["v/d"])
    check(not run.exists("d/o2.obj"), "what can be seen before is refused before")
    os.remove(run.path("v/d"))
    batch(run, "m.jsonl", "--view", "v", "--resume", done=1)
    is_picture(run, "v/d/o2.obj.png")


@case
def a_large_mesh_makes_room_for_its_picture(run):
    """A small one stays for the next job."""
    start(run, [job(0), job(1)])
    for padding, reads in ((0, "1 time"), (1 << 22, "2 times")):
        run.write("a.obj", CUBE + "#" * padding + "\n")
        said = []
        run.ffd("batch", "m.jsonl", "--view", "v", "--force", "-j1", "-v", err=said.extend)
        check(any(f"meshes read {reads}," in line for line in said), reads, said)


@case
def warnings_are_said_once(run):
    start(run, [job(0, lattice="fold.json")])
    run.write("fold.json", lattice(low=(-1, -1, -1), high=(0.5, 2, 2), moves=[{"by": [0, 0, 0.25]}]))
    said = []
    run.ffd("batch", "m.jsonl", "--force", err=said.extend)
    both = []
    run.ffd("batch", "m.jsonl", "--force", "--view", "v", err=both.extend)
    check(len(said) > 1, said)
    equal(both[:-1], said[:-1])


@case
def what_cannot_be_asked_for(run):
    start(run, [job(0), {"in": "a.obj", "lattice": "l.json", "options": {"in-place": True}}])
    batch(run, "m.jsonl", "--view", "v", done=1, failed=["cannot be used with --view"])
    run.write("m.jsonl", lines_of([job(2, options={"view": "x"})]))
    batch(run, "m.jsonl", "--view", "w", failed=['option "view" is not an object'])
    run.ffd("batch", "--in", "a.obj", "-l", "l.json", "--in-place", "--view", "x", code=USAGE,
            err=re.compile("--in-place cannot be used with --view"))
    check(not run.exists("x"), "a folder")


@case
def a_run_that_fails_leaves_no_folder(run):
    start(run)
    run.write("zeros.jsonl", b"\0" * 100)
    run.ffd("batch", "gone.jsonl", "--view", "v/w", code=IO, lines=1)
    run.ffd("batch", "m.jsonl", "--view", "v/w", "--report", "no/r.json", code=IO, lines=1)
    check(not run.exists("v"), "a folder")
    # No jobs: an index that says so.
    run.ffd("batch", "m.jsonl", "--view", "v", err=lambda said: None)
    equal((index(run).rows, index(run).counts), ([], "0 jobs: 0 done, 0 up to date, 0 failed"))


def begun(run, *arguments):
    process = subprocess.Popen([FFD, "batch", "m.jsonl", "-j", "2", "--view", "v", *arguments], cwd=run.folder, stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE, start_new_session=True)
    wait_until(lambda: (run.exists("v") and len(pictures(run)) > 2) or process.poll() is not None, "pictures do not come")
    check(process.poll() is None, "it ended before the signal came")
    return process


@case
def signals_leave_whole_pictures_and_an_index(run):
    for number in (signal.SIGTERM, signal.SIGKILL) if SANITIZED else (signal.SIGINT, signal.SIGTERM, signal.SIGKILL):
        start(run, [job(i) for i in range(JOBS)])
        process = begun(run)
        if number == signal.SIGKILL:
            os.killpg(process.pid, number)
        else:
            process.send_signal(number)
        process.communicate(timeout=SECONDS)
        left = pictures(run)
        for name in left:
            if not name.endswith(".ffd-tmp"):
                is_picture(run, "v/" + name)
        check(2 < len(left) < JOBS, len(left))
        if number == signal.SIGKILL:
            check(not run.exists("v/index.html"), "half an index")
        else:
            run.check_no_leftovers()
            found = index(run)
            equal(sorted(row["picture"] for row in found.rows if row["picture"]), left)
        run.ffd("batch", "m.jsonl", "--view", "v", "--resume", err=lambda said: None)
        found = index(run)
        equal(sorted(row["picture"] for row in found.rows), sorted(f"o{i}.obj.png" for i in range(JOBS)))
        equal(pictures(run), sorted(row["picture"] for row in found.rows))
        shutil.rmtree(run.path("v"))
        shutil.rmtree(run.path("cache"))
        for i in range(JOBS):
            run.remove(f"o{i}.obj")


@case
def the_index_keeps_folders_to_itself(run):
    """Of absolute paths the names alone: in the title, of what is read and written, and in the messages of what failed."""
    start(run)
    os.mkdir(run.path("secret client"))
    place = run.path("secret client")
    for name in ("a.obj", "l.json"):
        shutil.copy(run.path(name), os.path.join(place, name))
    jobs = [{"in": f"{place}/{mesh}", "out": f"{place}/{n}.obj", "lattice": f"{place}/{lattice_file}"}
            for n, (mesh, lattice_file) in enumerate((("a.obj", "l.json"), ("none.obj", "l.json"), ("a.obj", "none.json")))]
    run.write("secret client/m.jsonl", "".join(json.dumps(one) + "\n" for one in jobs))
    run.ffd("batch", f"{place}/m.jsonl", "--view", "pics", code=NO, err=anything)
    text = re.sub(r'(src|href)="[^"]*"', "", run.text("pics/index.html"))
    check("secret" not in text and "client" not in text, [line for line in text.splitlines() if "secret" in line or "client" in line])
    check("<title>m.jsonl" in text and "none.obj: cannot be opened" in text and "none.json: cannot be opened" in text, text[-2000:])


@case
def the_index_says_where_in_a_file_a_job_has_failed(run):
    """A JSON pointer begins as a path does, but is no secret; in a manifest and where a pattern names the meshes."""
    start(run)
    run.write("bad.json", lattice(moves=[{"at": [0, 0, 9], "by": [1, 0, 0]}]))
    run.write("m.jsonl", lines_of([job(0, lattice=run.path("bad.json"))]))
    for jobs in (["m.jsonl"], ["--in", "a.obj", "-l", run.path("bad.json"), "--out-dir", "out"]):
        run.ffd("batch", *jobs, "--view", "pics", "--force", code=NO, err=anything)
        error = re.search('class="error">([^<]*)', run.text("pics/index.html"))[1]
        check(re.fullmatch(r"bad\.json:\d+: /moves/0/at/2: index 9 .*", error), error)


main()
