#!/usr/bin/env python3
"""The program for Windows under wine: what it does by other calls than on Linux, and the jobs of the list.

    test_windows.py FFD LIBRARY names|outputs|batch|faults|jobs|package|console|pages

FFD is the program of this system, and LIBRARY is library.c for it, whose files are compared. FFD_WINDOWS names the build folder of the other one; without it, and
without wine, these tests are skipped. wine is not Windows: it keeps Linux's permissions, and lets mapped files be replaced.
"""

import fcntl
import json
import os
import pty
import re
import select
import shlex
import shutil
import struct
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
NATIVE_LIBRARY = os.path.abspath(sys.argv[2])
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
    # Names that differ in capitals are one file, also in folders that are not there yet.
    write(os.path.join(folder, "twice.jsonl"), "".join(json.dumps({"in": "spot.obj", "lattice": "twist.json", "out": name}) + "\n"
                                                       for name in ("Новая/a.obj", "новая/A.obj")))
    run("batch", "twice.jsonl", folder=folder, code=1, said="twice.jsonl:2: .*is written by the job of line 1 too")
    # A file in the place of a folder is refused once.
    shutil.copyfile(SPOT, os.path.join(folder, "龍.obj"))
    for name in ("龍.obj", "龍.obj\\below"):
        process = start("deform", "spot.obj", "in\\c2.obj", "--out-dir", name, "-l", "twist.json", folder=folder)
        errors = process.communicate(timeout=SECONDS)[1]
        assert process.returncode == 3 and errors.splitlines() == [f"ffd: {name}: is not a folder"], errors
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
    names = [f"kept{i}.obj" for i in range(12)]
    write(os.path.join(folder, "kept.jsonl"), "".join(json.dumps({"in": "large.obj", "lattice": "twist.json", "out": name}) + "\n"
                                                      for name in names))
    killer = start("kill", "ffd.exe", exe=HOLD)
    assert killer.stdout.readline().strip() == "ready"
    process = start("batch", "kept.jsonl", "-j", "1", "-q", folder=folder)
    end = time.monotonic() + SECONDS
    while not os.path.exists(os.path.join(folder, ".kept0.obj.ffd-tmp")):
        assert time.monotonic() < end and process.poll() is None, process.communicate()
        time.sleep(0.001)
    assert killer.communicate(timeout=SECONDS)[0].strip() == "1"
    errors = process.communicate(timeout=SECONDS)[1]
    failed = re.findall(r"kept\.jsonl:(\d+): large\.obj: was ended by the system", errors)
    assert process.returncode and len(failed) == 1, f"exit {process.returncode}: {errors}"
    # The worker may have been killed when it had written all of it, and not yet said so.
    made = {name for name in os.listdir(folder) if "kept" in name} - {names[int(failed[0]) - 1]}
    assert made == {"kept.jsonl", *names} - {names[int(failed[0]) - 1]}, f"{made}: {errors}"


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


# What every Windows has.
SYSTEM = {"ADVAPI32.dll", "KERNEL32.dll", "msvcrt.dll"}


def test_package(folder):
    """The Python package without Python: what its files need and show; its library from a program in C, and with its workers."""
    package = os.path.join(folder, "ffd_mesh")
    os.mkdir(package)
    for name in ("src/python/libffd.dll", "src/python/_native.pyd", "src/python/ffd.exe", "tests/windows/library.exe"):
        shutil.copy(program(name), package)
    check_linking(package)
    library = os.path.join(package, "library.exe")
    check_points(folder, library)
    copy_of_spot(folder)
    for model in ("spot.obj", "knight.glb", "banner_red.glb"):
        path = os.path.join(ROOT, "data/models", model)
        native("deform", path, "wanted-" + model, "-l", "twist.json", folder=folder)
        run("file", path, "made-" + model, "twist.json", exe=library, folder=folder)
        assert content(folder, "made-" + model) == content(folder, "wanted-" + model), model
    names = [f"job{i}.obj" for i in range(6)]
    write(os.path.join(folder, "jobs.jsonl"), "".join(json.dumps({"in": "spot.obj", "lattice": "twist.json", "out": name}) + "\n" for name in names))
    assert run("batch", "jobs.jsonl", exe=library, folder=folder)[1].strip() == "6"
    assert all(content(folder, name) == content(folder, "wanted-spot.obj") for name in names)
    os.remove(os.path.join(package, "ffd.exe"))
    process = start("batch", "jobs.jsonl", exe=library, folder=folder)
    errors = process.communicate(timeout=SECONDS)[1]
    assert process.returncode == 6 and '"ffd.exe"' in errors, f"exit {process.returncode}: {errors}"
    check_last_words()


def check_linking(package):
    for name, others, shows in (("libffd.dll", set(), "ffd_"), ("_native.pyd", {"python3.dll"}, "PyInit__native"), ("ffd.exe", {"libffd.dll"}, None)):
        text = subprocess.run(["x86_64-w64-mingw32-objdump", "-p", os.path.join(package, name)], check=True, capture_output=True, text=True).stdout
        needed = set(re.findall(r"DLL Name: (\S+)", text))
        assert needed <= SYSTEM | others and others <= needed, f"{name} needs {sorted(needed)}"
        table = re.search(r"\[Ordinal/Name Pointer\] Table\n(.*?)\n\n", text, re.S)
        shown = re.findall(r"\] (\S+)", table[1]) if table else []
        assert bool(shown) == bool(shows) and all(other.startswith(shows) for other in shown), f"{name} shows {shown}"


def check_points(folder, library):
    """The vertices of the OBJ jobs of the list, as arrays: embedded, deformed, with gradients, normals and derivatives."""
    pairs, embedded = {}, set()
    with open(os.path.join(ROOT, "tests/release/jobs.txt"), encoding="utf-8") as file:
        for line in file:
            words = shlex.split(line)[1:]
            found = re.match(r"(embed|deform) (models/\S+\.obj) .*?-l ((?:lattices|inputs)/\S+\.json)$",
                             " ".join(words[:words.index("-l") + 2] if "-l" in words else []))
            if found and not {"--set", "--only", "--space"} & set(words):
                pairs[found[2], found[3]] = True
                embedded |= {(found[2], found[3])} if found[1] == "embed" else set()
    folders = {"models": "data/models", "lattices": "data/lattices", "inputs": "tests/release/inputs"}
    done = 0
    for model, lattice in pairs:
        model_path, lattice_path = (os.path.join(ROOT, folders[path.split("/")[0]], path.split("/", 1)[1]) for path in (model, lattice))
        if not os.path.exists(model_path):
            continue
        with open(model_path, encoding="utf-8") as file:
            numbers = [float(word) for line in file if line.startswith("v ") for word in line.split()[1:4]]
        with open(os.path.join(folder, "points"), "wb") as file:
            file.write(struct.pack(f"<{len(numbers)}d", *numbers))
        wanted = subprocess.run([NATIVE_LIBRARY, "points", lattice_path, "points", "wanted"], cwd=folder, capture_output=True, check=False)
        if wanted.returncode:  # a lattice with placeholders
            assert (model, lattice) not in embedded, wanted.stderr
            continue
        run("points", lattice_path, "points", "made", exe=library, folder=folder)
        assert content(folder, "made") == content(folder, "wanted"), f"{model} in {lattice}"
        if (model, lattice) in embedded:
            native("embed", model_path, "-l", lattice_path, "-o", "uvw.npy", "--force", folder=folder)
            size, stored = 8 * len(numbers), content(folder, "uvw.npy")
            stored = stored[10 + int.from_bytes(stored[8:10], "little"):]  # behind the header
            assert content(folder, "made")[:size] == stored[:size], f"u,v,w of {model} in {lattice}"
        done += 1
    print(f"arrays of {done} jobs")
    assert done >= 15 and len(embedded) >= 5, f"{done} jobs, {len(embedded)} of them embed"


def in_console(*arguments, exe=FFD, folder=".", until=None):
    """Exit code and output, in a console of wine, in which Ctrl-C is pressed when until() is true."""
    process, terminal = pty.fork()
    if process == 0:
        os.chdir(folder)
        os.execve(WINE, [WINE, exe, *arguments], {**os.environ, "TERM": "xterm"})
    output, status, end = b"", 0, time.monotonic() + SECONDS
    is_over = False
    while time.monotonic() < end:
        is_read = select.select([terminal], [], [], 0.001)[0]
        try:
            output += os.read(terminal, 65536) if is_read else b""
        except OSError:
            is_read = []
        if until and until():
            os.write(terminal, b"\x03")
            until = None
        if is_over and not is_read:
            break
        if not is_over:
            ended, status = os.waitpid(process, os.WNOHANG)
            is_over = ended != 0
    if not is_over:
        os.kill(process, 9)
        os.waitpid(process, 0)
    os.close(terminal)
    spaced = re.sub(r"\x1b\[(\d+)C", lambda match: " " * int(match[1]), output.decode("utf-8", "replace"))
    output = re.sub(r"\x1b\[[?0-9]*[A-Za-z]", "", spaced)
    assert is_over and until is None, f"{arguments}: over: {is_over}, no Ctrl-C yet: {until is not None}: {output!r}"
    return os.waitstatus_to_exitcode(status), output


def test_console(folder):
    """In a console: letters of several bytes, page and mode as they were, and Ctrl-C, which leaves no unfinished output."""
    copy_of_spot(folder)
    code, output = in_console("info", "нет 龍.obj", folder=folder)
    assert code == 3 and "ffd: нет 龍.obj: cannot be opened: No such file" in output, f"exit {code}: {output!r}"
    code, output = in_console("console", f"{FFD} batch none.jsonl", exe=HOLD, folder=folder)
    assert "exit 3, page 437, old mode" in output, f"exit {code}: {output!r}"
    with open(os.path.join(folder, "large.obj"), "w", encoding="utf-8") as file:
        file.writelines(f"v {i % 997 * 0.001} {i % 991 * 0.001} {i % 983 * 0.001}\n" for i in range(1000000))
    before = sorted(os.listdir(folder))
    in_console("deform", "large.obj", "out.obj", "-l", "twist.json", folder=folder,
               until=lambda: os.path.exists(os.path.join(folder, ".out.obj.ffd-tmp")))
    assert sorted(os.listdir(folder)) == before, os.listdir(folder)
    names = ["first.obj", "second.obj", "third.obj"]
    write(os.path.join(folder, "jobs.jsonl"), "".join(json.dumps({"in": "large.obj", "lattice": "twist.json", "out": name}) + "\n" for name in names))
    code, output = in_console("batch", "jobs.jsonl", "-j", "1", folder=folder,
                              until=lambda: os.path.exists(os.path.join(folder, ".second.obj.ffd-tmp")))
    left = sorted(set(os.listdir(folder)) - set(before))
    # The job that runs is done to its end, as elsewhere.
    assert left == ["first.obj", "jobs.jsonl", "second.obj"], f"{left}: exit {code}: {output!r}"
    assert "interrupted" in output, f"exit {code}: {output!r}"


def test_pages(folder):
    """The commands of data/windows.md, in wine's cmd; those of PowerShell as it takes them apart."""
    data, tools = os.path.join(folder, "data"), os.path.join(os.environ["WINEPREFIX"], "drive_c/Tools/ffd-0.3.0")
    shutil.copytree(os.path.join(ROOT, "data"), data)
    os.makedirs(tools, exist_ok=True)
    shutil.copy(FFD, tools)
    with open(os.path.join(ROOT, "data/windows.md"), encoding="utf-8") as file:
        blocks = re.findall(r"^```(\S+)\n(.*?)^```$", file.read(), re.M | re.S)
    assert [language for language, _ in blocks].count("bat") >= 5 and {language for language, _ in blocks} == {"bat", "powershell"}
    path = next(line for line in blocks[0][1].splitlines() if line.startswith("set "))
    for language, block in blocks:
        if language == "powershell":
            run_as_powershell(block, data)
            continue
        # A command that fails ends the block; cmd by itself goes on.
        lines = [part for line in block.splitlines() for part in (line, "if errorlevel 1 exit 1")[:1 if line.endswith("^") else 2]]
        with open(os.path.join(data, "block.cmd"), "w", encoding="utf-8", newline="") as file:
            file.write("\r\n".join(["@echo off", path, *lines, "exit 0", ""]))
        process = subprocess.run([WINE, "cmd", "/c", "block.cmd"], cwd=data, stdin=subprocess.DEVNULL, capture_output=True, check=False,
                                 timeout=SECONDS)
        assert process.returncode == 0, f"{block}exit {process.returncode}: {process.stdout.decode()}{process.stderr.decode()}"
    made = ["fatter.html", "fatter.obj", "my cow.obj", "my cows/spot.obj", "bent/one.obj", "bent/two.obj", "twisted/one.obj", "twisted/two.obj",
            "my lean cow.obj", "cage.json"]
    assert all(os.path.exists(os.path.join(data, name)) for name in made), [name for name in made if not os.path.exists(os.path.join(data, name))]


def run_as_powershell(block, folder):
    """Words in quotes lose these; outside of quotes nothing may stand that PowerShell takes for its own."""
    for line in block.splitlines():
        if re.fullmatch(r'\$env:Path \+= ";C:\\Tools\\[^"$`;]+"', line):
            continue
        words = re.findall(r"""(?:"[^"$`]*"|'[^']*'|[^\s"'`$@;,{}()|<>&])+""", line)
        assert words[0] == "ffd" and " ".join(words) == line, f"PowerShell does not read as words: {line}"
        run(*(re.sub(r"""["']""", "", word) for word in words[1:]), folder=folder)


def check_last_words():
    """What starts the program from Python hands on its words as they were typed."""
    sys.path.insert(0, os.path.join(ROOT, "src/python"))
    import ffd_mesh_program  # pylint: disable=import-outside-toplevel
    typed = ["deform", r"in\*.obj", '"*.obj"', r'"a b\\"', r'\"', '"in ""x"" y"', 'a" "b', r"c\\", "''"]
    for count in range(len(typed) + 1):
        line = r'"C:\Program Files\python.exe"  -m ffd_mesh  ' + "  ".join(typed) + " "
        rest = ffd_mesh_program.last_words(line, count)
        assert rest.split() == " ".join(typed[len(typed) - count:]).split(), f"{count}: {rest!r}"


def main():
    if not BUILD:
        skip("FFD_WINDOWS is not set (tests/run.sh --suite windows sets it)")
    if not WINE:
        skip("wine: wine64 is not installed")
    os.environ.setdefault("WINEPREFIX", os.path.join(BUILD, "wine"))
    os.environ["WINEDEBUG"] = "-all"
    os.environ.pop("DISPLAY", None)
    # The first one makes wine's folder, of which another that starts meanwhile finds half.
    with open(os.path.join(BUILD, "wine.lock"), "w", encoding="ascii") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        run("--version")
    # While one program runs, wine need not begin anew for each.
    with tempfile.TemporaryDirectory() as folder, start("open", os.path.join(BUILD, "wine", "kept"), exe=HOLD):
        globals()["test_" + sys.argv[3]](folder)


main()
