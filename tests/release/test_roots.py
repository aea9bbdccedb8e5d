#!/usr/bin/env python3
"""The lines of the README's table, each in a bare root of Debian (tests/install/bare_root.sh) that has what the line itself needs and
nothing else; then what the page says next.

    test_roots.py OUT [wheel|static|deb|npm|old]...      default: all that OUT holds; needs root

old: the shared libraries of the wheel on Debian 11 (glibc 2.31), loaded by ctypes, deform a mesh; skipped where it cannot be had.
"""

import os
import re
import shutil
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
BARE = os.path.join(ROOT, "tests/install/bare_root.sh")
# Name -> (what its line holds, packages, how the program is called then). Python's packages come with an environment.
KINDS = {
    "wheel": ("manylinux", ["python3-venv"], "/env/bin/ffd"),
    "static": ("linux-x86_64.tar.xz", ["xz-utils"], "/dist/ffd-*/bin/ffd"),
    "deb": (".deb", [], "ffd"),
    "npm": (".tgz", ["nodejs", "npm"], "npx --prefix /dist ffd-mesh"),
}
NEXT = """{ffd} deform models/knight.glb /tmp/knight.glb -l lattices/twist.json
{ffd} info /tmp/knight.glb
{ffd} view models/spot.obj -l lattices/fatter.json -o /tmp/fatter.html
{ffd} deform models/spot.obj /tmp/fatter.obj -l lattices/fatter.json
{ffd} compare models/spot.obj /tmp/fatter.obj --tolerance 10
"""
# The library and its declarations, without the package, which needs a newer Python.
OLD = r"""
import ctypes, importlib.util
spec = importlib.util.spec_from_file_location("declared", "/wheel/ffd_mesh/_declarations.py")
declared = importlib.util.module_from_spec(spec)
spec.loader.exec_module(declared)
lib = ctypes.CDLL("/wheel/ffd_mesh/libffd.so")
desc, result, error = declared.ffd_deform_desc(), declared.ffd_job_result(), declared.ffd_error()
lib.ffd_deform_desc_init(ctypes.byref(desc), ctypes.sizeof(desc))
result.struct_size = ctypes.sizeof(result)
desc.input.path, desc.output = b"models/knight.glb", b"/tmp/by_ctypes.glb"
lattices = (declared.ffd_lattice_source * 1)()
lattices[0].path = b"lattices/twist.json"
desc.lattices, desc.lattice_count = lattices, 1
status = lib.ffd_deform_run(ctypes.byref(desc), ctypes.byref(result), ctypes.byref(error))
assert status == 0 and result.moved == result.vertices > 0, error.message
"""


def enter(folder, command):
    done = subprocess.run(["sh", BARE, "run", folder, command], stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False)
    return done.returncode, done.stdout + done.stderr


def make(folder, release, packages, out):
    subprocess.run(["sh", BARE, "make", folder, "--release", release, "--", *packages], check=True, stdin=subprocess.DEVNULL)
    os.mkdir(os.path.join(folder, "dist"))
    for name in os.listdir(out):
        shutil.copy(os.path.join(out, name), os.path.join(folder, "dist"))


def line_of(kind):
    """The command of the README's table."""
    with open(os.path.join(ROOT, "README.md"), encoding="utf-8") as file:
        (command,) = re.findall(rf"^\| [^|]+ \| `([^`]*{re.escape(KINDS[kind][0])}[^`]*)` \|$", file.read(), re.M)
    return command


def install(kind, folder, out):
    _, packages, program = KINDS[kind]
    results = []
    for release in ("bookworm", "trixie") if kind == "wheel" else ("bookworm",):
        make(os.path.join(folder, release), release, packages, out)
        before = "python3 -m venv /env; PATH=/env/bin:$PATH; " if kind == "wheel" else "apt-get -qq update; " if kind == "deb" else ""
        steps = NEXT.format(ffd=program).replace("\n", "; ").replace("compare models/spot.obj /tmp/fatter.obj --tolerance 10; ",
                                                                     "compare models/spot.obj /tmp/fatter.obj --tolerance 10 || test $? -eq 1; ")
        code, text = enter(os.path.join(folder, release), f"set -e; {before}cd /dist; {line_of(kind)}; cd /src/ffd/data; {steps}")
        results.append(code == 0)
        print(f"{kind} on {release}: exit {code}" + ("" if code == 0 else f"\n{text[-3000:]}"))
    return all(results)


def old(folder, out):
    """None where the machine's sources of packages have no Debian 11 any more."""
    try:
        make(folder, "bullseye", ["python3", "unzip"], out)
    except subprocess.CalledProcessError:
        print("old: skipped: no root of Debian 11 can be made from this machine's sources of packages")
        return None
    with open(os.path.join(folder, "old.py"), "w", encoding="utf-8") as file:
        file.write(OLD)
    code, text = enter(folder, "mkdir /wheel; cd /wheel; unzip -q /dist/*manylinux*x86_64.whl; cd /src/ffd/data && python3 /old.py && "
                               "/wheel/ffd_mesh/ffd deform models/knight.glb /tmp/k.glb -l lattices/twist.json && cmp /tmp/k.glb /tmp/by_ctypes.glb")
    print(f"old: exit {code}, {text.strip()[-2000:]}")
    return code == 0


def main():
    out, *chosen = sys.argv[1:]
    if os.geteuid() != 0:
        sys.exit("root is needed to make the roots")
    found = [kind for kind, (part, _, _) in KINDS.items() if any(part in name and not name.endswith(".json") for name in os.listdir(out))]
    results = []
    for kind in chosen or [*found, "old"]:
        folder = tempfile.mkdtemp(prefix="ffd-root.")
        try:
            results.append(old(folder, out) if kind == "old" else install(kind, folder, out))
        finally:
            subprocess.run(["rm", "-rf", "--one-file-system", folder], check=False)
    ran = [right for right in results if right is not None]
    print(f"{sum(ran)} kinds right of {len(ran)}, {len(results) - len(ran)} skipped")
    sys.exit(not all(ran))


main()
