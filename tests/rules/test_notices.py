#!/usr/bin/env python3
"""What packages say of the code of others in them follows the table of data/packaging/THIRD-PARTY.md: each library has its text, the
licence of the wheels and of the package for npm names all that is in them, and each Debian package brings the texts. No page of a
package has a link that leads out of it."""

import re

import tree

PACKAGING = "data/packaging/"
ROW = re.compile(r"^\| [^|]+ \| [^|]+ \| ([^|]+) \| `([\w-]+\.txt)` \| ([^|]+) \|$", re.M)


def licence(rows, *artefacts):
    """Of what these artefacts contain, and of ffd itself, as a set."""
    names = {"MIT"}
    for text, _, places in rows:
        if places == "all" or set(artefacts) & set(places.split(", ")):
            names |= set(text.split(" AND "))
    return names


def differences(path, pattern, right):
    said = set(re.search(pattern, tree.read(path), re.M)[1].split(" AND "))
    return [f"{path}: the licence lacks {name}" for name in sorted(right - said)] + \
           [f"{path}: nothing in it has the licence {name}" for name in sorted(said - right)]


def main():
    files = tree.files()
    rows = ROW.findall(tree.read(PACKAGING + "THIRD-PARTY.md"))
    listed = {f"{PACKAGING}licenses/{name}" for _, name, _ in rows}
    there = {path for path in files if path.startswith(PACKAGING + "licenses/")}
    findings = [f"{path}: not in THIRD-PARTY.md, or not there" for path in sorted(listed ^ there)]
    findings += differences("pyproject.toml", r'^license = "(.*)"$', licence(rows, "wheel", "wheel-musl"))
    findings += differences("src/wasm/js/package.json", r'^  "license": "(.*)",$', licence(rows, "npm"))
    for package in re.findall(r"^Package: (.*)$", tree.read(PACKAGING + "debian/control"), re.M):
        docs = f"{PACKAGING}debian/{package}.docs"
        # Meson installs them to the folder of the package ffd.
        wanted = {PACKAGING + "THIRD-PARTY.md", PACKAGING + "licenses"} if package != "ffd" else set()
        findings += [f"{docs}: lacks {path}" for path in sorted(wanted - set(tree.read(docs).split() if docs in files else []))]
    for page in ("data/python.md", "data/npm.md"):
        findings += [f"{page}: {link} leads nowhere in a package" for link in re.findall(r"\]\(([^)]+)\)", tree.read(page))
                     if not re.match(r"#|https?://", link)]
    tree.finish(len(rows), "libraries", findings)


main()
