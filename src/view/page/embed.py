#!/usr/bin/env python3
"""Makes C arrays of a page's sources.

    embed.py OUT NAME PROGRAM SOURCES HEAD PAGE STYLE... SCRIPT...

The arrays are called ffd_NAME_start and so on. The page is cut where {{title}} and {{data}} stand. Its {{head}} is
replaced by the file that all pages share, {{style}} and {{script}} by the files that end in .css and .js, {{program}} by
PROGRAM. Its Content-Security-Policy begins with {{sources}}, SOURCES; {{style-hash}} and {{script-hash}} are what it
allows beside them: these very bytes and nothing else.
"""

import base64
import hashlib
import os
import sys

WIDTH = 24  # bytes a line


def read(path):
    with open(path, encoding="utf-8", newline="") as file:
        text = file.read().replace("\r\n", "\n")
    if not text.isascii():
        sys.exit(f"{path}: holds other characters than ASCII")
    return text


def hash_of(text):
    return "sha256-" + base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()


def join_scripts(paths):
    """One script of all, in a scope of its own."""
    parts = ["(function () {\n'use strict';\n"] + [read(path) for path in paths] + ["})();\n"]
    text = "".join(parts)
    for word in ("</script", "<!--"):
        if word in text.lower():
            sys.exit(f"a script holds {word}, where a browser would end it")
    return text


def c_array(name, text):
    data = text.encode()
    lines = [",".join(map(str, data[at:at + WIDTH])) for at in range(0, len(data), WIDTH)]
    return (f"const unsigned char {name}[] = {{\n" + ",\n".join(lines) + "};\n" +
            f"const size_t {name}_size = sizeof {name};\n")


def main():
    out, name, program, sources, head, page, *files = sys.argv[1:]
    style_text = "".join(read(path) for path in files if path.endswith(".css"))
    script_text = join_scripts([path for path in files if path.endswith(".js")])
    text = read(page)
    for key, value in (("head", read(head)), ("program", program), ("sources", sources),
                       ("style-hash", hash_of(style_text)), ("script-hash", hash_of(script_text)),
                       ("style", style_text), ("script", script_text)):
        if text.count("{{" + key + "}}") != 1:
            sys.exit(f"{page}: does not hold {{{{{key}}}}} once")
        text = text.replace("{{" + key + "}}", value)
    start, rest = text.split("{{title}}")
    middle, end = rest.split("{{data}}")
    with open(out, "w", encoding="ascii") as file:
        file.write(f"/* Made by {os.path.basename(__file__)} of the files in src/view/page. */\n")
        file.write('#include "view/page_assets.h"\n')
        for place, part in (("start", start), ("middle", middle), ("end", end)):
            file.write(c_array(f"ffd_{name}_{place}", part))


main()
