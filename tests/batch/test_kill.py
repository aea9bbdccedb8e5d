#!/usr/bin/env python3
"""1,000 jobs, 20 of them bad in all ways, killed at 20 random moments and resumed: every good output is that of a
single clean run, nothing else lies in the folders, and the report names each bad job and why.

    test_kill.py FFD OPEN-TRAP [SEED]

OPEN-TRAP is the library that makes ffd crash, hang or run out of memory on files of certain names."""

import itertools
import json
import os
import random
import re
import signal
import subprocess
import sys
import tempfile
import time

FFD, TRAP = map(os.path.abspath, sys.argv[1:3])
os.environ["FFD"] = FFD
sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "cli"))
from harness import CUBE, check, equal, glb, gltf_json, lattice  # noqa: E402

JOBS, KILLS, MESHES, LATTICES = 1000, 20, 80, 12
SECONDS = 600
# Each run to its end waits for it, as long as it takes the two jobs that hang; all others take milliseconds.
TIMEOUT = "2"


def write(folder, name, content):
    path = os.path.join(folder, name)
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "wb") as file:
        file.write(content if isinstance(content, bytes) else
                   (content if isinstance(content, str) else json.dumps(content)).encode())


def snapshot(folder):
    """Every file below the folder with its content."""
    found = {}
    for where, _, names in os.walk(folder):
        for name in names:
            with open(os.path.join(where, name), "rb") as file:
                found[os.path.relpath(os.path.join(where, name), folder)] = file.read()
    return found


def write_inputs(folder):
    meshes = []
    for i in range(MESHES):
        points = [[random.uniform(-1, 1) for _ in range(3)] for _ in range(random.choice((3, 30, 300, 3000)))]
        name = f"in/{i}" + (".obj", ".gltf", ".glb", ".obj")[i % 4]
        if name.endswith(".obj"):
            write(folder, name, "".join("v %.9g %.9g %.9g\n" % tuple(p) for p in points) + "f 1 2 3\n")
        elif name.endswith(".gltf"):
            asset, data = gltf_json(points, uri=f"{i}.bin")
            write(folder, name, asset)
            write(folder, f"in/{i}.bin", data)
        else:
            write(folder, name, glb(*gltf_json(points)))
        meshes.append(name)
    for i in range(LATTICES):
        write(folder, f"in/l{i}.json", lattice(size=(4, 4, 4 + i % 3), moves=[
            {"at": [[1, 2], "all", 1], "by": [random.uniform(-0.2, 0.2) for _ in range(3)]},
            {"twist": {"axis": "z", "degrees": random.uniform(-40, 40)}}]))
    for name in ("abort.obj", "segv.obj", "kill.obj", "sleep.obj", "nomemory.obj", "folded.obj"):
        write(folder, "in/" + name, CUBE)
    for name in ("abort.json", "sleep.json"):
        write(folder, "in/" + name, lattice())
    asset, data = gltf_json([[0, 0, 0]])
    asset["accessors"][0].update(count=200000000)
    del asset["accessors"][0]["bufferView"]  # zeros, and as many as one likes
    write(folder, "in/large.glb", glb(asset, data))
    write(folder, "in/broken.obj", "v 1 2 3\nf 1 2 3\n")
    write(folder, "in/broken.json", '{"format": "ffd-lattice", "version": 1}')
    return meshes


def bad_jobs():
    """Manifest lines, with the exit code and what the reason must say."""
    numbers = itertools.count()

    def bad(mesh="in/1.gltf", grid="in/l0.json", **members):
        ending = ".obj" if mesh.endswith(".obj") else ".glb"
        return {"in": mesh, "lattice": grid, "out": f"out/bad{next(numbers)}{ending}", **members}

    return [
        (bad("in/missing.obj"), 3, r"in/missing\.obj: .*No such file"),
        (bad("in/missing.glb"), 3, r"in/missing\.glb: .*No such file"),
        (bad(grid="in/missing.json"), 3, r"in/missing\.json: .*No such file"),
        (bad(out="in/0.obj/bad.glb"), 3, r"in/0\.obj/bad\.glb: .*Not a directory"),
        ('{"in": "in/0.obj",', 4, r"m\.jsonl:\d+: not valid JSON"),
        (bad(option={}), 4, r"m\.jsonl:\d+: unknown key \"option\""),
        (bad(options={"normal": "keep"}), 4, r"m\.jsonl:\d+: .*normal.*nearest"),
        (bad("in/broken.obj"), 4, r"in/broken\.obj:2: "),
        (bad(grid="in/broken.json"), 4, r"in/broken\.json:"),
        (bad("in/abort.obj"), 7, r"in/abort\.obj: .*Abort"), (bad("in/abort.obj", "in/l1.json"), 7, r"in/abort\.obj: .*Abort"),
        (bad(grid="in/abort.json"), 7, r"in/1\.gltf: .*Abort"), (bad("in/segv.obj"), 7, r"in/segv\.obj: .*Segmentation"),
        (bad("in/kill.obj"), 7, r"in/kill\.obj: .*Killed"),
        (bad("in/sleep.obj"), 7, r"in/sleep\.obj: .*--timeout"), (bad(grid="in/sleep.json"), 7, r"in/1\.gltf: .*--timeout"),
        (bad("in/nomemory.obj"), 7, r"in/nomemory\.obj: .*memory"), (bad("in/nomemory.obj", "in/l2.json"), 7, r"in/nomemory\.obj: .*memory"),
        (bad("in/large.glb"), 7, r"in/large\.glb:.*--memory"),
        (bad("in/folded.obj", "in/folded.json", options={"fail-on": "folds"}), 1, r"in/folded\.obj: .*fold"),
    ]


def write_manifest(folder, meshes):
    """Returns the lines with the bad ones' exit codes and reasons, None for good ones."""
    jobs = []
    for i in range(JOBS - len(bad_jobs())):
        mesh = meshes[i * MESHES // JOBS]
        job = {"in": mesh, "lattice": f"in/l{i % LATTICES}.json", "out": f"out/{i % 7}/{i}" + os.path.splitext(mesh)[1]}
        if i % 10 == 0:
            job["lattice"] = [f"in/l{i % LATTICES}.json", "in/l1.json"]
        if i % 15 == 0:
            job["options"] = {"normals": "recompute"}
        jobs.append((job, None))
    for job, code, reason in bad_jobs():
        jobs.insert(random.randrange(len(jobs) + 1), (job, (code, reason)))
    write(folder, "m.jsonl", "".join((j if isinstance(j, str) else json.dumps(j)) + "\n" for j, _ in jobs))
    for i in range(7):
        os.makedirs(os.path.join(folder, f"out/{i}"))
    return jobs


def start(folder, cache, *options):
    """A batch in a session of its own, which says what it has to say to the file "said" of the cache."""
    environment = {**os.environ, "LD_PRELOAD": TRAP, "XDG_CACHE_HOME": cache}
    with open(os.path.join(cache, "said"), "wb") as said:
        return subprocess.Popen([FFD, "batch", "m.jsonl", "-j", "2", "--timeout", TIMEOUT, "-q", *options], cwd=folder,
                                env=environment, start_new_session=True, stdin=subprocess.DEVNULL, stdout=said, stderr=said)


def said_by(cache):
    """What a run has said, which is but why bad jobs failed."""
    with open(os.path.join(cache, "said"), encoding="utf-8") as file:
        said = file.read()
    for line in said.splitlines():
        place = re.match(r"ffd: m\.jsonl:\d+: ", line)
        check(place and any(re.match("ffd: " + reason, line) or re.match(reason, line[place.end():]) for _, _, reason in bad_jobs()),
              "no reason of a bad job:", line)
    check(said.count("\n") <= len(bad_jobs()), "more reasons than bad jobs")
    return said


def alive(session):
    """The processes of a session that run still."""
    found = []
    for name in os.listdir("/proc"):
        try:
            with open(f"/proc/{name}/stat", encoding="latin-1") as file:
                state, _, _, its = file.read().rpartition(")")[2].split()[:4]
        except (OSError, ValueError):
            continue
        if int(its) == session and state not in "ZX":
            found.append(int(name))
    return found


def end_workers(session):
    """Workers of a killed batch must end by themselves, though not in the same moment."""
    limit = time.monotonic() + 10
    while alive(session) and time.monotonic() < limit:
        time.sleep(0.01)
    left = alive(session)
    if left:
        os.killpg(session, signal.SIGKILL)
    check(not left, f"{len(left)} processes outlived a killed batch by 10 s")


def finish(folder, cache, *options):
    """A run to its end, with its report's jobs."""
    process = start(folder, cache, *options, "--report", os.path.join(cache, "r.json"))
    code = process.wait(timeout=SECONDS)
    equal(code, 1, said_by(cache))
    equal(alive(process.pid), [], "processes after the end")
    with open(os.path.join(cache, "r.json"), encoding="utf-8") as file:
        return json.load(file)["jobs"]


def judge(jobs, entries, statuses):
    equal(len(entries), len(jobs), "jobs of the report")
    for (job, bad), (number, entry) in zip(jobs, enumerate(entries, 1)):
        equal(entry["line"], number)
        if bad:
            code, reason = bad
            equal((entry["status"], entry["exit"]), ("failed", code), f"line {number}, {job}, {entry['error']}")
            check(re.search(reason, entry["error"]), f"line {number}: {entry['error']!r} does not match {reason!r}")
        else:
            check(entry["status"] in statuses and entry["exit"] == 0 and entry["error"] is None, f"line {number}", job, entry)


def main():
    seed = int(sys.argv[3]) if len(sys.argv) > 3 else random.SystemRandom().randrange(10 ** 9)
    print(f"seed {seed}", flush=True)
    random.seed(seed)
    with tempfile.TemporaryDirectory(prefix="ffd-test-") as work:
        clean, killed, caches = (os.path.join(work, name) for name in ("clean", "killed", "caches"))
        for name in ("clean", "killed"):
            os.makedirs(os.path.join(caches, name))
        meshes = write_inputs(clean)
        write(clean, "in/folded.json", lattice(moves=[{"at": ["all", "all", 0], "by": [0, 0, 9]}]))
        jobs = write_manifest(clean, meshes)
        subprocess.run(["cp", "-r", clean, killed], check=True)

        begun = time.monotonic()
        judge(jobs, finish(clean, os.path.join(caches, "clean")), ("ok",))
        seconds = time.monotonic() - begun
        expected = snapshot(clean)
        good = {job["out"] for job, bad in jobs if not bad}
        outputs = {name for name in expected if name.startswith("out")}
        equal({name for name in outputs if not name.endswith(".bin")}, good, "outputs of the clean run")

        cache = os.path.join(caches, "killed")
        killed_running = 0
        for i in range(KILLS):
            process = start(killed, cache, "--resume")
            time.sleep(random.uniform(0, 2 * seconds / KILLS))
            if process.poll() is None:
                killed_running += 1
                if i % 2:
                    process.kill()  # its workers are left alone
                else:
                    os.killpg(process.pid, signal.SIGKILL)
            check(process.wait() in (1, -signal.SIGKILL), f"exit {process.returncode}:", said_by(cache))
            said_by(cache)
            # The next run may begin while a worker of this one is at its last job.
            if i % 4 == 3:
                end_workers(process.pid)
        sessions_end = time.monotonic()
        made = sum(len(files) for _, _, files in os.walk(os.path.join(killed, "out")))
        print(f"clean run {seconds:.1f} s; {killed_running} of {KILLS} killed while they ran; then {made} of {len(outputs)} files were there")
        check(killed_running >= KILLS // 2, "most runs had ended before they were killed")
        judge(jobs, finish(killed, cache, "--resume"), ("ok", "skipped"))
        print(f"last run {time.monotonic() - sessions_end:.1f} s")
        found = snapshot(killed)
        equal(sorted(found), sorted(expected), "files")
        different = [name for name in expected if found[name] != expected[name]]
        equal(different, [], "files that differ from those of the clean run")

        entries = finish(killed, cache, "--resume")
        judge(jobs, entries, ("skipped",))
        equal(snapshot(killed), found, "after one more run")
    print("1 cases, 0 failed")


main()
