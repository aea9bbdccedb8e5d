#!/usr/bin/env python3
"""What is built with optimization has what keeps a mistake from being used against the user (meson.build): each is read
from the program, the shared library and the modules.

    test_hardening.py LANDING FILE...

LANDING: the instructions, separated by commas, of which a function must begin with one; "-": the compiler knows none.
"""

import re
import shutil
import subprocess
import sys

import tree

# Parts of a function that a compiler made of it, which nothing but that function calls.
PARTS = re.compile(r"\.(part|cold|constprop|isra|lto_priv)\b")


def said(*command):
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout


def first_instructions(file):
    """Function of ours -> its first instruction."""
    listing = said("objdump", "--disassemble", "--no-show-raw-insn", file)
    return {name: word for name, word in re.findall(r"^[0-9a-f]+ <(ffd_\w[\w.]*)>:\n\s*[0-9a-f]+:\s+(\w+)", listing, re.M)
            if not PARTS.search(name)}


def check(file, landing):
    header, segments, dynamic = (said("readelf", "-W", option, file) for option in ("-h", "-l", "-d"))
    symbols = set(re.findall(r"(\w+)(?:@\S+)?$", said("nm", "-D", "--undefined-only", file), re.M))
    if not re.search(r"Type:\s+DYN", header):
        yield "is not position independent"
    if not file.endswith(".so") and ".so." not in file and not re.search(r"FLAGS_1.*\bPIE\b", dynamic):
        yield "is no position independent program"
    if "GNU_RELRO" not in segments or not re.search(r"\(FLAGS_1\).*\bNOW\b|\(BIND_NOW\)", dynamic):
        yield "can have its table of addresses written to: no full RELRO"
    if not re.search(r"GNU_STACK.*\bRW\b\s", segments):
        yield "has a stack that can be run"
    if "__stack_chk_fail" not in symbols:
        yield "does not guard its stack"
    if not any(re.fullmatch(r"__\w+_chk", name) for name in symbols):
        yield "does not check calls that write to memory: no _FORTIFY_SOURCE"
    if landing != "-":
        firsts = first_instructions(file)
        if not firsts:
            yield "shows no function of ours"
        for name, word in sorted(firsts.items()):
            if word not in landing.split(","):
                yield f"{name} begins with {word}, not with {landing}"


def main():
    landing, *files = sys.argv[1:]
    for tool in ("readelf", "nm", "objdump"):
        if not shutil.which(tool):
            tree.skip(f"{tool} is not there")
    tree.finish(len(files), "files", [f"{file}: {what}" for file in files for what in check(file, landing)])


main()
