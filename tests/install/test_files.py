#!/usr/bin/env python3
"""`meson install` puts down these files and no others, readable for all, and only programs and shared libraries to be run. A JSON
Schema (data/*.schema.json) is installed with them.

    test_files.py BUILD-FOLDER
"""

import glob
import os
import sys
import tempfile

import stage


def expected(installed):
    """Where from the prefix -> the mode."""
    options = installed.options
    library = options["libdir"]
    paths = [f"{library}/pkgconfig/ffd.pc", f"{options['mandir']}/man1/ffd.1",
             f"{options['datadir']}/bash-completion/completions/ffd", f"{options['datadir']}/zsh/site-functions/_ffd"]
    for header in glob.glob(os.path.join(stage.ROOT, "include/ffd/*.h")):
        paths.append(f"{options['includedir']}/ffd/{os.path.basename(header)}")
    for schema in glob.glob(os.path.join(stage.ROOT, "data/**/*.schema.json"), recursive=True):
        paths.append(f"{options['datadir']}/ffd/{os.path.basename(schema)}")
    paths += [f"{options['datadir']}/ffd/blender/{name}.py" for name in ("ffd_export", "ffd_import", "ffd_lattice_math")]
    notices = glob.glob(os.path.join(stage.ROOT, "data/packaging/licenses/*.txt"))
    paths += [f"{options['datadir']}/doc/ffd/{name}" for name in
              ("LICENSE", "THIRD-PARTY.md", *(f"licenses/{os.path.basename(notice)}" for notice in notices))]
    paths.append(f"{options['bindir']}/ffd")
    if options["default_library"] != "shared":
        paths.append(f"{library}/libffd.a")
    if options["default_library"] != "static":
        paths += [f"{library}/{name}" for name in ("libffd.so", f"libffd.so.{stage.ABI}", f"libffd.so.{stage.ABI}.0", *stage.MODULES)]
        paths += [f"{library}/cmake/ffd/{name}.cmake" for name in ("ffdConfig", "ffdConfigVersion")]
    return {path: 0o755 if path.endswith("bin/ffd") or ".so" in path else 0o644 for path in paths}


def main():
    findings = []
    with tempfile.TemporaryDirectory() as root:
        installed = stage.Stage(sys.argv[1], root)
        wanted = expected(installed)
        found = {}
        for folder, _, names in os.walk(root):
            for name in names:
                path = os.path.join(folder, name)
                found[os.path.relpath(path, root + installed.options["prefix"])] = os.stat(path).st_mode & 0o777
        findings += [f"not installed: {path}" for path in sorted(wanted.keys() - found.keys())]
        findings += [f"installed, and not expected: {path}" for path in sorted(found.keys() - wanted.keys())]
        findings += [f"{path}: mode {found[path]:o} instead of {wanted[path]:o}"
                     for path in sorted(wanted.keys() & found.keys()) if found[path] != wanted[path]]
    stage.finish(len(wanted), "installed files", findings)


main()
