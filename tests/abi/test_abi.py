#!/usr/bin/env python3
"""Programs that were built with the headers of this ABI run with the library of today (data/promises.md).

    test_abi.py ABI LIBRARY       compares include/ffd with what was kept, and what was kept with the library's symbols
    test_abi.py --keep ABI        keeps include/ffd as it is now: for a new ABI, or one that was not released yet

What is kept is ffd-ABI.h, all public headers in one, without comments and macros. Both sides become libraries whose functions do
nothing, built by one compiler, and abidiff compares these: so nothing depends on what compilers say of the real one.
"""

import os
import re
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.append(os.path.join(os.path.dirname(HERE), "rules"))
from tree import ROOT, finish, skip

COMPILER = os.environ.get("CC", "cc").split()
SYSTEM = ("stdbool.h", "stddef.h", "stdint.h")


def run(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def public_headers():
    """All public headers in one text: what is left after the preprocessor, and the system's headers by name."""
    with tempfile.TemporaryDirectory() as folder:
        for name in SYSTEM:
            open(os.path.join(folder, name), "w", encoding="ascii").close()
        text = run(*COMPILER, "-E", "-P", "-nostdinc", "-U__GNUC__", "-x", "c", "-I", folder, "-I", os.path.join(ROOT, "include"),
                   os.path.join(ROOT, "include", "ffd", "ffd.h"))
    return "".join(f"#include <{name}>\n" for name in SYSTEM) + text


def statements(text):
    """Declarations, each without its semicolon."""
    text, depth, begin = re.sub(r"^#.*$|/\*.*?\*/", "", text, flags=re.M), 0, 0
    for match in re.finditer(r"[{};]", text):
        depth += {"{": 1, "}": -1, ";": 0}[match[0]]
        if match[0] == ";" and not depth:
            yield " ".join(text[begin:match.start()].split())
            begin = match.end()


def structs(text):
    """Name -> declarations of its members."""
    found = (re.fullmatch(r"typedef struct \w+ \{(.*)\} (\w+)", statement) for statement in statements(text))
    return {match[2]: [member.strip() for member in match[1].split(";")[:-1]] for match in found if match}


def names(member):
    """Those that one declaration declares."""
    function = re.search(r"\(\*(\w+)\)", member)
    return [function[1]] if function else re.findall(r"(\w+)(?:\[[^,]*)?(?=,|$)", re.sub(r"\[[^]]*\]", "", member))


def is_sized(members):
    return members[0] == "size_t struct_size"


def as_kept(text, kept):
    """Headers of today without what a struct that knows its size has at its end, and with the room that was kept."""
    before, made = structs(kept), []
    for statement in statements(text):
        match = re.fullmatch(r"(typedef struct \w+ \{)(.*)\} (\w+)", statement)
        if match and match[3] in before:
            old, members = before[match[3]], [member.strip() for member in match[2].split(";")[:-1]]
            if is_sized(old):
                members = members[:len(old)]
            elif old[-1].startswith("uint64_t room[") and members[-1].startswith("uint64_t room["):
                members = members[:len(old) - 1] + old[-1:]
            members = [was if "_room[" in was and names(is_now) == names(was) else is_now
                       for was, is_now in zip(old, members)] + members[len(old):]
            statement = match[1] + "".join(f"{member}; " for member in members) + "} " + match[3]
        made.append(statement)
    return "".join(f"#include <{name}>\n" for name in SYSTEM) + ";\n".join(made) + ";\n"


def functions(text):
    return {re.search(r"(\w+)\(", statement)[1]: statement for statement in statements(text)
            if not statement.startswith("typedef") and "(" in statement}


def stub(text, folder, name):
    """A library of functions that do nothing."""
    source, library = os.path.join(folder, f"{name}.c"), os.path.join(folder, f"{name}.so")
    declared = functions(text).values()
    with open(source, "w", encoding="ascii") as file:
        file.write("".join(f"#include <{header}>\n" for header in SYSTEM))
        file.writelines(f"{statement};\n" if statement not in declared else f"{statement} {{ __builtin_trap(); }}\n"
                        for statement in statements(text))
    run(*COMPILER, "-w", "-g", "-shared", "-fPIC", "-nostdlib", source, "-o", library)
    return library


def layout(text, of, folder, name):
    """Lines of where the members of the structs of `of` lie in those of text, and of the sizes that callers rely on."""
    source, program = os.path.join(folder, f"{name}-layout.c"), os.path.join(folder, f"{name}-layout")
    lines = []
    for struct, members in structs(of).items():
        lines += [f'printf("{struct}.{member} %zu\\n", offsetof({struct}, {member}));' for part in members for member in names(part)
                  if not member.endswith("room")]
        lines += [] if is_sized(members) else [f'printf("sizeof {struct} %zu\\n", sizeof({struct}));']
    with open(source, "w", encoding="ascii") as file:
        file.write(f"#include <stdio.h>\n{text}\nint main(void)\n{{\n" + "\n".join(lines) + "\n}\n")
    built = subprocess.run([*COMPILER, "-w", source, "-o", program], capture_output=True, text=True, check=False)
    return run(program).splitlines() if built.returncode == 0 else [f"a member is gone: {built.stderr[:500]}"]


class Kept:
    """The kept headers, compiled once."""

    def __init__(self, text, folder):
        self.text, self.folder = text, folder
        self.library, self.layout = stub(text, folder, "kept"), layout(text, text, folder, "kept")

    def changes(self, text, name="now"):
        """What a program built with them cannot take of the headers `text`: lines; none where all that is new is an addition."""
        try:
            library = stub(as_kept(text, self.text), self.folder, name)
        except subprocess.CalledProcessError as failed:
            return [f"the headers do not compile: {failed.stderr[:500]}"]
        done = subprocess.run(["abidiff", "--no-added-syms", "--no-corpus-path", self.library, library],
                              capture_output=True, text=True, check=False)
        found = [] if done.returncode == 0 else [line for line in done.stdout.splitlines() if line.strip()]
        if found:
            return found
        now = layout(text, self.text, self.folder, name)
        return [f"{b}, was {a}" for a, b in zip(self.layout, now) if a != b] if len(now) == len(self.layout) else now


def symbols(kept, library, abi):
    """What the library does not have of what was kept."""
    shown = dict(line.split()[-1].split("@@") for line in run("nm", "-D", "--defined-only", library).splitlines() if "@@" in line)
    soname = re.search(r"SONAME.*\[(.*)\]", run("readelf", "-d", library))[1]
    return [f"{name} is not there with the version FFD_{abi}" for name in functions(kept) if shown.get(name) != f"FFD_{abi}"] + \
        ([] if soname == f"libffd.so.{abi}" else [f"the soname is {soname}"])


# What is changed in the headers, as an expression and what takes its place -> whether that is an addition.
CASES = {
    "a function": (r"(const char \*ffd_version\(void\);)", r"\1 int ffd_more(int x);", True),
    "a member at the end of a struct with its size": (r"(\} ffd_run_options;)", r"double later; \1", True),
    "a number of an enumeration": (r"FFD_ISA_NEON\b", "FFD_ISA_NEON, FFD_ISA_LATER", True),
    "a figure of folds, in their room": (r"(\} ffd_folds;)((?:.|\n)*folds_room)\[8\]", r"uint64_t later; \1\2[7]", True),
    "a figure of a group, in its room": (r"uint64_t room\[2\];(\s+\} ffd_splat_figures;)", r"uint64_t later; uint64_t room[1];\1", True),
    "a figure of a group, beside its room": (r"uint64_t room\[2\];(\s+\} ffd_splat_figures;)", r"uint64_t later; uint64_t room[2];\1", False),
    "a figure of folds without room": (r"(\} ffd_folds;)", r"uint64_t later; \1", False),
    "a member within": (r"(ffd_isa isa;\s+bool \(\*progress)", r"double later; \1", False),
    "a type of the same size": (r"ptrdiff_t stride;", "size_t stride;", False),
    "a type in a struct with its size": (r"double snap;(\s+\} ffd_embedding_desc;)", r"uint64_t snap;\1", False),
    "a longer struct of which there are arrays": (r"(\} ffd_setting;)", r"int later; \1", False),
    "another number": (r"FFD_ISA_SSE2,", "FFD_ISA_SSE2 = 7,", False),
    "a function that is gone": (r"const char \*ffd_version\(void\);", "", False),
    "another argument": (r"ffd_free\(void \*block\)", "ffd_free(void *block, size_t size)", False),
}


def judged(kept, case):
    """What is wrong with the verdict on one change."""
    pattern, by, is_addition = CASES[case]
    text, count = re.subn(pattern, by, kept.text)
    if count != 1:
        return [f"{case}: changed in {count} places"]
    found = kept.changes(text, re.sub(r"\W", "-", case))
    return [] if bool(found) != is_addition else [f"{case}: taken for {'a change: ' + found[0] if found else 'an addition'}"]


def main():
    if sys.argv[1] == "--keep":
        path = os.path.join(HERE, f"ffd-{sys.argv[2]}.h")
        with open(path, "w", encoding="ascii") as file:
            file.write(f"/* {os.path.basename(path)} - the public headers that programs of this ABI were built with (test_abi.py --keep). */\n")
            file.write(public_headers())
        run("clang-format", "-i", path)
        return
    abi, library = sys.argv[1:]
    try:
        run("abidiff", "--version")
    except FileNotFoundError:
        skip("abidiff is not there")
    with open(os.path.join(HERE, f"ffd-{abi}.h"), encoding="ascii") as file:
        text = file.read()
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(2) as pool:
        kept = Kept(text, folder)
        findings = symbols(text, library, abi) + kept.changes(public_headers())
        if findings:
            findings.append(f"programs of ABI {abi} would break: it needs another number (data/promises.md), or, if it was not "
                            "released yet, test_abi.py --keep")
        for found in pool.map(lambda case: judged(kept, case), CASES):
            findings += found
    finish(len(functions(text)) + len(CASES), "functions and changes", findings)


main()
