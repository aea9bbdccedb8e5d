#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Builds the extension for Blender: ffd_lattice-VERSION.zip, the same bytes of the same inputs.

    python3 data/blender/build_extension.py --wheel FILE.whl --out DIR [--force]

FILE.whl: ffd_mesh of this version for CPython 3.11 and later on x86-64
"""

import argparse
import io
import os
import re
import sys
import tempfile
import zipfile

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
OWN = ("LICENSE", "__init__.py", "apply_lattice.py")  # in extension/
SHARED = ("ffd_lattice_math.py", "ffd_export.py", "ffd_import.py")
WHEEL = re.compile(r"ffd_mesh-([^-]+)-cp311-abi3-manylinux\w*_x86_64\.whl")
WHEN = (1980, 1, 1, 0, 0, 0)


def fail(text, code=1):
    print(f"build_extension: {text}", file=sys.stderr)
    sys.exit(code)


class Parser(argparse.ArgumentParser):
    def error(self, message):
        fail(f"{message} (--help)", 2)


def read(*path):
    with open(os.path.join(*path), "rb") as file:
        return file.read()


def version():
    """That of meson.build, which takes it from there too."""
    found = re.search(rb'^#define FFD_VERSION "(.*)"$', read(ROOT, "include", "ffd", "version.h"), re.M)
    return found[1].decode()


def check_wheel(path, wanted):
    """The name of the wheel."""
    name = os.path.basename(path)
    found = WHEEL.fullmatch(name)
    if not found:
        fail(f"{name}: is not a wheel ffd_mesh-VERSION-cp311-abi3-manylinux.._x86_64.whl")
    if found[1] != wanted:
        fail(f"{name}: is of version {found[1]}, not {wanted}")
    if not zipfile.is_zipfile(path):
        fail(f"{name}: is not a wheel" if os.path.exists(path) else f"{path}: cannot be read")
    return name


def pack(members):
    """A ZIP that depends on nothing but its content: nothing is deflated, since zlib's versions differ, and the wheel is already."""
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_STORED) as archive:
        for name in sorted(members):
            info = zipfile.ZipInfo(name, WHEN)
            info.create_system, info.external_attr = 3, 0o100644 << 16
            archive.writestr(info, members[name])
    return packed.getvalue()


def write(path, data):
    handle, draft = tempfile.mkstemp(prefix=".ffd_lattice-", dir=os.path.dirname(path))
    with os.fdopen(handle, "wb") as file:
        file.write(data)
    mask = os.umask(0)
    os.umask(mask)
    os.chmod(draft, 0o666 & ~mask)
    os.replace(draft, path)


def main():
    parser = Parser(description="Builds the extension for Blender, ffd_lattice-VERSION.zip.")
    parser.add_argument("--wheel", metavar="FILE.whl", required=True, help="ffd_mesh for CPython 3.11 and later on x86-64")
    parser.add_argument("--out", metavar="DIR", required=True, help="the folder of the ZIP, which exists")
    parser.add_argument("--force", action="store_true", help="replace a file that exists")
    options = parser.parse_args()
    number = version()
    wheel = check_wheel(options.wheel, number)
    path = os.path.join(options.out, f"ffd_lattice-{number}.zip")
    if not os.path.isdir(options.out):
        fail(f"{options.out}: is not a folder")
    if os.path.lexists(path) and not options.force:
        fail(f"{path}: exists already (--force replaces it)")
    manifest = read(HERE, "extension", "blender_manifest.toml").replace(b"@VERSION@", number.encode()).replace(b"@WHEEL@", wheel.encode())
    members = {"blender_manifest.toml": manifest, "LICENSE-MIT": read(ROOT, "LICENSE"), f"wheels/{wheel}": read(options.wheel)}
    members.update((name, read(HERE, "extension", name)) for name in OWN)
    members.update((name, read(HERE, name)) for name in SHARED)
    write(path, pack(members))
    print(path)


main()
