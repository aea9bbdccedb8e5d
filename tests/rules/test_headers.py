#!/usr/bin/env python3
"""Every public header compiles alone, as C11 and as C++17, without a warning, with each compiler there is."""

import os
import shutil
import subprocess
import tempfile

import tree

LANGUAGES = [("c", "c11", ("gcc", "clang")), ("c++", "c++17", ("g++", "clang++"))]
WARNINGS = ["-Wall", "-Wextra", "-Wpedantic", "-Wshadow", "-Wundef", "-Werror"]


def main():
    headers = [path for path in tree.files() if path.startswith("include/ffd/") and path.endswith(".h")]
    findings = []
    checked = 0
    with tempfile.TemporaryDirectory() as folder:
        for language, standard, compilers in LANGUAGES:
            for compiler in filter(shutil.which, compilers):
                for header in headers:
                    # Included twice: the guard has to hold.
                    source = os.path.join(folder, "alone.c")
                    with open(source, "w", encoding="ascii") as file:
                        line = f"#include <{header[len('include/'):]}>\n"
                        file.write(line + line + "extern int ffd_not_empty;\n")
                    command = [compiler, f"-std={standard}", *WARNINGS, "-I", os.path.join(tree.ROOT, "include"),
                               "-x", language, "-fsyntax-only", source]
                    run = subprocess.run(command, capture_output=True, text=True, check=False)
                    checked += 1
                    if run.returncode != 0:
                        findings.append(f"{header} alone with {compiler} -std={standard}:\n{run.stderr}")
    tree.finish(checked, "header compilations", findings)


main()
