#!/usr/bin/env python3
"""Lays out the package for npm: the modules that Meson has built, and the JavaScript of src/wasm/js.

    pack.py ROOT BUILD VERSION FOLDER
"""

import base64
import gzip
import os
import re
import shutil
import sys

# Of the package's own modules: where they go.
DIST = ("error.mjs", "load.mjs", "run.mjs", "fit.mjs", "lattice.mjs", "jobs.mjs", "ffd-mesh.mjs", "ffd-mesh.d.ts", "files.mjs",
        "gltf-transform.mjs", "gltf-transform.d.ts")
# Those of the classic script, each behind what it uses.
CLASSIC = ("error.mjs", "run.mjs", "fit.mjs", "lattice.mjs", "jobs.mjs", "ffd-mesh.mjs")
MODULES = {"core": "createCore", "program": "createProgram"}

# In place of load.mjs.
LOAD = """
async function loadFile(name) {
  const packed = Uint8Array.from(atob(FILES[name]), (letter) => letter.charCodeAt(0));
  return new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream('gzip'))).arrayBuffer();
}
async function readUrl(url) {
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${url}: ${response.status} ${response.statusText}`);
  return response.arrayBuffer();
}
"""


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def write(path, text):
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w", encoding="utf-8", newline="\n") as file:
        file.write(text)


def plain(text):
    """A module's text without its imports and the word export."""
    text = re.sub(r"^import [^;]*;\n", "", text, flags=re.MULTILINE)
    text = re.sub(r"^export \{[^}]*\};\n", "", text, flags=re.MULTILINE)
    return re.sub(r"^export ", "", text, flags=re.MULTILINE)


def packed(path):
    """A file as text."""
    with open(path, "rb") as file:
        return base64.b64encode(gzip.compress(file.read(), 9, mtime=0)).decode()


def make_classic(own, built, version):
    files = ",\n".join(f'"{name}.wasm": "{packed(os.path.join(built, name + ".wasm"))}"' for name in MODULES)
    glue = "".join(read(os.path.join(built, name + ".js")) for name in MODULES)
    text = "".join(plain(read(os.path.join(own, name))) for name in CLASSIC)
    return (f"/* ffd-mesh {version}, MIT; notices of all that is in it: THIRD-PARTY.md of the package */\n"
            f"globalThis.ffdMesh = (() => {{\n'use strict';\nconst FILES = {{\n{files}\n}};\n{glue}\n{LOAD}{text}"
            "return {init, FfdError};\n})();\n")


def main():
    root, build, version, folder = sys.argv[1:5]
    own, built, dist = os.path.join(root, "src", "wasm", "js"), os.path.join(build, "src", "wasm"), os.path.join(folder, "dist")
    packaging = os.path.join(root, "data", "packaging")
    for name in DIST:
        write(os.path.join(dist, name), read(os.path.join(own, name)))
    for name, function in MODULES.items():
        write(os.path.join(dist, name + ".mjs"), read(os.path.join(built, name + ".js")) + f"\nexport default {function};\n")
        shutil.copyfile(os.path.join(built, name + ".wasm"), os.path.join(dist, name + ".wasm"))
    write(os.path.join(dist, "ffd-mesh.js"), make_classic(own, built, version))
    write(os.path.join(folder, "bin", "ffd-mesh.mjs"), read(os.path.join(own, "command.mjs")))
    write(os.path.join(folder, "package.json"), read(os.path.join(own, "package.json")).replace("@VERSION@", version))
    write(os.path.join(folder, "examples", "index.html"), read(os.path.join(packaging, "npm", "index.html")))
    write(os.path.join(folder, "README.md"), read(os.path.join(root, "data", "npm.md")))
    write(os.path.join(folder, "LICENSE"), read(os.path.join(root, "LICENSE")))
    notices = read(os.path.join(packaging, "THIRD-PARTY.md"))
    write(os.path.join(folder, "THIRD-PARTY.md"), notices)
    for name, places in re.findall(r"\| `([\w-]+\.txt)` \| ([^|]+) \|$", notices, flags=re.MULTILINE):
        if places == "all" or "npm" in places.split(", "):
            write(os.path.join(folder, "licenses", name), read(os.path.join(packaging, "licenses", name)))


main()
