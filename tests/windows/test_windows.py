#!/usr/bin/env python3
"""The program for Windows under wine: what it does by other calls than on Linux, and the jobs of the list.

    test_windows.py FFD names|outputs|batch|faults|jobs

FFD is the program of this system, whose files are compared. FFD_WINDOWS names the build folder of the other one; without it, and
without wine, these tests are skipped. wine is not Windows: it keeps Linux's permissions, and lets mapped files be replaced.
"""

import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
SECONDS = 120
SKIPPED = 77
SPOT = os.path.join(ROOT, "data/models/spot.obj")
LATTICE = os.path.join(ROOT, "data/lattices/twist.json")
NATIVE = os.path.abspath(sys.argv[1])
BUILD = os.environ.get("FFD_WINDOWS", "")
WINE = shutil.which("wine64") or shutil.which("wine64", path="/usr/lib/wine")


def skip(reason):
    print(f"SKIP: {reason}")
    sys.exit(SKIPPED)


def program(name):
    return os.path.join(BUILD, name)


FFD = program("src/cli/ffd.exe")
FAULT = program("tests/windows/ffd_fault.exe")
HOLD = program("tests/windows/hold.exe")


def start(*arguments, exe=FFD, folder=".", **more):
    return subprocess.Popen([WINE, exe, *arguments], cwd=folder, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                            env={**os.environ, **more}, encoding="utf-8", errors="replace")


def run(*arguments, code=0, said=None, exe=FFD, folder=".", **more):
    """Its exit code and standard output. code: the exit code, None for any; said: what is on standard error."""
    process = start(*arguments, exe=exe, folder=folder, **more)
    output, errors = process.communicate(timeout=SECONDS)
    command = f"ffd {' '.join(arguments)}"
    assert code is None or process.returncode == code, f"{command}: exit {process.returncode}, not {code}: {errors}"
    assert said is None or re.search(said, errors), f"{command}: {errors!r} lacks {said!r}"
    if code:
        lines = errors.splitlines()
        assert lines and all(re.match(r"ffd: ", line) for line in lines), f"{command}: {errors!r}"
    return process.returncode, output


def native(*arguments, folder="."):
    subprocess.run([NATIVE, *arguments], cwd=folder, check=True, stdin=subprocess.DEVNULL, timeout=SECONDS)


def content(*path):
    with open(os.path.join(*path), "rb") as file:
        return file.read()


def write(path, text):
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)


def copy_of_spot(folder, name="spot.obj"):
    shutil.copyfile(SPOT, os.path.join(folder, name))
    shutil.copyfile(LATTICE, os.path.join(folder, "twist.json"))
    return name


def test_names(folder):
    """Names in three scripts, long ones, patterns, and names that are none of a file."""
    copy_of_spot(folder)
    native("deform", "spot.obj", "wanted.obj", "-l", "twist.json", folder=folder)
    wanted = content(folder, "wanted.obj")
    for name in ("кот.obj", "龍.obj", "\U0001f431 x.obj", "straße é.obj"):
        os.rename(os.path.join(folder, "spot.obj"), os.path.join(folder, name))
        run("deform", name, "out-" + name, "-l", "twist.json", folder=folder)
        assert content(folder, "out-" + name) == wanted, name
        os.rename(os.path.join(folder, name), os.path.join(folder, "spot.obj"))
    deep = os.path.join(folder, *(["d" * 100] * 4))
    os.makedirs(deep)
    copy_of_spot(deep)
    long = "\\".join(["d" * 100] * 4)
    run("deform", long + "\\spot.obj", long + "\\out.obj", "-l", "twist.json", folder=folder)
    assert content(deep, "out.obj") == wanted
    # A pattern is what the program expands; without a match it is a name.
    os.mkdir(os.path.join(folder, "in"))
    for name in ("а1.obj", "б1.OBJ", "c2.obj"):
        copy_of_spot(os.path.join(folder, "in"), name)
    run("deform", "in\\?1.obj", "--out-dir", "out", "-l", "twist.json", folder=folder)
    assert sorted(os.listdir(os.path.join(folder, "out"))) == ["а1.obj", "б1.OBJ"]
    run("info", "none*.obj", folder=folder, code=3, said=r"none\*\.obj")
    for name, why in (("NUL.obj", "device"), ("con.obj", "device"), ("aux .obj", "device"), ("com1.obj", "device"), ("a.obj.", "dot"),
                      ("a.obj ", "blank"), ("a.obj:b.obj", "stream")):
        before = sorted(os.listdir(folder))
        run("deform", "spot.obj", name, "-l", "twist.json", "--force", "--output-format", "obj", folder=folder, code=3, said=why)
        assert sorted(os.listdir(folder)) == before, f"{name}: {os.listdir(folder)}"
    native("deform", "spot.obj", "model.gltf", "-l", "twist.json", folder=folder)
    path = os.path.join(folder, "model.gltf")
    with open(path, encoding="utf-8") as file:
        text = file.read()
    uri = re.search(r'"uri": ?"([^"]+\.bin)"', text)[1]
    for other, why in (("aux.bin", "device"), (uri + ":x", "outside"), (uri + ".", "dot")):
        write(path, text.replace(uri, other))
        run("info", "model.gltf", folder=folder, code=3, said=why)


def test_outputs(folder):
    """Complete or absent: beside other programs that have the target open, or are writing it; in place; read-only."""
    copy_of_spot(folder)
    native("deform", "spot.obj", "wanted.obj", "-l", "twist.json", folder=folder)
    wanted = content(folder, "wanted.obj")
    target = os.path.join(folder, "out.obj")
    write(target, "old")
    # The same file by another name is the same file.
    os.link(os.path.join(folder, "spot.obj"), os.path.join(folder, "twin.obj"))
    run("deform", "spot.obj", ".\\SPOT.obj", "-l", "twist.json", folder=folder, code=3)
    run("deform", "spot.obj", "out.obj", "-l", "twist.json", folder=folder, code=3, said="exists already")
    holder = start("open", "out.obj", exe=HOLD, folder=folder)
    assert holder.stdout.readline().strip() == "ready"
    run("deform", "spot.obj", "out.obj", "-l", "twist.json", "--force", folder=folder, code=3, said="another program has it open")
    holder.communicate()
    assert content(target) == b"old"
    hidden = os.path.join(folder, ".out.obj.ffd-tmp")
    holder = start("lock", ".out.obj.ffd-tmp", exe=HOLD, folder=folder)
    assert holder.stdout.readline().strip() == "ready"
    run("deform", "spot.obj", "out.obj", "-l", "twist.json", "--force", folder=folder, code=3, said="being written by another run")
    assert content(target) == b"old" and os.path.exists(hidden)
    holder.communicate()
    run("deform", "spot.obj", "out.obj", "-l", "twist.json", "--force", folder=folder)  # it takes the leftover away
    assert content(target) == wanted and not os.path.exists(hidden)
    # The input, which is mapped, is what is replaced.
    copy_of_spot(folder, "place.obj")
    run("deform", "place.obj", "--in-place", "-l", "twist.json", folder=folder)
    assert content(folder, "place.obj") == wanted
    assert not [name for name in os.listdir(folder) if name.startswith(".")], os.listdir(folder)
    check_read_only(folder)
    with open(os.path.join(folder, "spot.obj"), "rb") as file:
        done = subprocess.run([WINE, FFD, "deform", "-", "-", "--input-format", "obj", "--output-format", "obj", "-l", "twist.json"], cwd=folder, stdin=file,
                              capture_output=True, check=False)
    assert done.stdout == wanted, f"standard streams: exit {done.returncode}: {done.stderr!r}, {len(done.stdout)} bytes"


def check_read_only(folder):
    """A folder that nobody may write to; root may, under wine."""
    if os.geteuid() == 0:
        return
    closed = os.path.join(folder, "closed")
    os.mkdir(closed)
    os.chmod(closed, 0o555)
    run("deform", "spot.obj", "closed\\out.obj", "-l", "twist.json", folder=folder, code=3, said="Permission denied")
    assert os.listdir(closed) == []
    os.chmod(closed, 0o755)


def test_batch(folder):
    """Workers: many jobs, one that is killed, a time limit; the same files as ever."""
    copy_of_spot(folder)
    names = [f"out{i}.{'obj' if i % 2 else 'ply'}" for i in range(24)]
    write(os.path.join(folder, "jobs.jsonl"), "".join(json.dumps({"in": "spot.obj", "lattice": "twist.json", "out": name}) + "\n"
                                                      for name in names))
    native("batch", "jobs.jsonl", "-j", "2", "-q", folder=folder)
    wanted = {name: content(folder, name) for name in names}
    for name in names:
        os.remove(os.path.join(folder, name))
    run("batch", "jobs.jsonl", "-j", "3", "-q", "--report", "report.json", "--journal", "j", folder=folder)
    assert {name: content(folder, name) for name in names} == wanted
    run("batch", "jobs.jsonl", "-j", "3", "--resume", "--journal", "j", folder=folder, said="24 up to date|24 skipped|24 of 24")
    # The patterns of a batch are the program's own.
    os.mkdir(os.path.join(folder, "in 1"))  # wine puts names with blanks into quotes
    for name in ("a.obj", "б.OBJ", "c.ply"):
        copy_of_spot(os.path.join(folder, "in 1"), name)
    run("batch", "--in", "in 1\\*.obj", "--out-dir", "made", "-l", "twist.json", "-q", folder=folder)
    assert sorted(os.listdir(os.path.join(folder, "made"))) == ["a.obj", "б.OBJ"]
    # A job that takes too long is ended, and leaves nothing.
    with open(os.path.join(folder, "large.obj"), "w", encoding="utf-8") as file:
        file.writelines(f"v {i % 997 * 0.001} {i % 991 * 0.001} {i % 983 * 0.001}\n" for i in range(400000))
    write(os.path.join(folder, "slow.jsonl"), "".join(json.dumps({"in": "large.obj", "lattice": "twist.json", "out": f"slow{i}.obj"}) + "\n"
                                                      for i in range(3)))
    run("batch", "slow.jsonl", "-j", "1", "--timeout", "0.05", "-q", folder=folder, code=None, said="took longer")
    assert not [name for name in os.listdir(folder) if name.startswith((".slow", "slow")) and name != "slow.jsonl"], os.listdir(folder)
    check_killed_worker(folder)


def check_killed_worker(folder):
    """Its job fails, what it had begun is removed, and another worker does the rest."""
    process = start("batch", "slow.jsonl", "-j", "1", "-q", folder=folder)
    end = time.monotonic() + SECONDS
    while not os.path.exists(os.path.join(folder, ".slow0.obj.ffd-tmp")):
        assert time.monotonic() < end and process.poll() is None, process.communicate()
        time.sleep(0.001)
    assert run("kill", "ffd.exe", exe=HOLD)[1].strip() == "1"
    errors = process.communicate(timeout=SECONDS)[1]
    made = sorted(name for name in os.listdir(folder) if "slow" in name)
    assert process.returncode and errors.count("large.obj: was ended by the system") == 1, f"exit {process.returncode}: {errors}"
    assert len(made) == 3 and not [name for name in made if name.startswith(".")], f"{made}: {errors}"


def test_faults(folder):
    """At every call that changes the folder an error, or the end of the program: the old files or the new ones, never neither."""
    for kind in ("error", "kill"):
        for what in ("file", "set"):
            check_faults(os.path.join(folder, f"{kind}-{what}"), kind, what)


def check_faults(folder, kind, what):
    os.mkdir(folder)
    shutil.copyfile(LATTICE, os.path.join(folder, "twist.json"))
    target = "out.obj" if what == "file" else "out.gltf"
    for state, height in (("old", 1), ("new", 2)):
        write(os.path.join(folder, state + ".obj"), f"v 0 0 0\nv 1 0 0\nv 0 {height} 0\nf 1 2 3\n")
        os.mkdir(os.path.join(folder, state))
        native("deform", state + ".obj", f"{state}/{target}", "-l", "twist.json", folder=folder)
    files = sorted(os.listdir(os.path.join(folder, "new")))
    states = {state: {name: content(folder, state, name) for name in files} for state in ("old", "new")}
    for number in range(1, 60):
        work, marked = os.path.join(folder, str(number)), os.path.join(folder, f"fault{number}")
        shutil.copytree(os.path.join(folder, "old"), work)
        code, _ = run("deform", "new.obj", f"{number}/{target}", "-l", "twist.json", "--force", exe=FAULT, folder=folder, code=None,
                      FFD_FAULT_AT=str(number), FFD_FAULT_KIND=kind, FFD_FAULT_MARK=f"fault{number}")
        fired = os.path.exists(marked)
        found = {name: content(work, name) if os.path.exists(os.path.join(work, name)) else None for name in files}
        where = f"{kind} at call {number} of a {what}"
        if kind == "error" or not fired:
            assert found == states["new"] or (fired and code == 3 and found == states["old"]), f"{where}: exit {code}, mixed, or missing: {[name for name in files if found[name] is None]}"
        else:
            assert code == 99
            heads = [name for name in (target, f".{target}.ffd-old") if os.path.exists(os.path.join(work, name))]
            assert heads, f"{where}: neither"
        if kind == "error" and set(os.listdir(work)) == set(files) and fired:
            continue
        # The next run makes it whole, whatever there was.
        run("deform", "new.obj", f"{number}/{target}", "-l", "twist.json", "--force", folder=folder)
        assert {name: content(work, name) for name in files} == states["new"], f"{where}: the next run"
        left = sorted(set(os.listdir(work)) - set(files))
        assert not left, f"{where}: {left} is left"
        if not fired:
            assert number > 3
            return
    raise AssertionError("more calls than expected")


def test_jobs(_):
    done = subprocess.run([sys.executable, os.path.join(ROOT, "tests/release/run_jobs.py"), "--every", "6", WINE, FFD], check=False)
    assert done.returncode == 0


def main():
    if not BUILD:
        skip("FFD_WINDOWS is not set (tests/run.sh --suite windows sets it)")
    if not WINE:
        skip("wine: wine64 is not installed")
    os.environ.setdefault("WINEPREFIX", os.path.join(BUILD, "wine"))
    os.environ["WINEDEBUG"] = "-all"
    os.environ.pop("DISPLAY", None)
    run("--version")
    with tempfile.TemporaryDirectory() as folder:
        globals()["test_" + sys.argv[2]](folder)


main()
