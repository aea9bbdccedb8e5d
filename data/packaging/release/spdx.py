#!/usr/bin/env python3
"""Prints the SBOM of an artefact: SPDX 2.3, JSON. What is in it stands in the table of THIRD-PARTY.md; the versions are those of
the wraps.

    spdx.py ROOT NAME FILE COMMIT
    spdx.py ROOT NAME                 prints the licence of the artefact, as one expression
"""

import datetime
import glob
import hashlib
import json
import os
import re
import sys

ROW = re.compile(r"^\| (?P<name>[^|]+) \| (?P<use>[^|]+) \| (?P<license>[^|]+) \| `(?P<text>[\w-]+)\.txt` \| (?P<places>[^|]+) \|$", re.M)


def read(*path):
    with open(os.path.join(*path), encoding="utf-8") as file:
        return file.read()


def libraries(root, artefact):
    """(name, license, stem of its text) of each library that the artefact contains"""
    artefact = "wheel" if artefact == "blender" else artefact
    for row in ROW.finditer(read(root, "data/packaging/THIRD-PARTY.md")):
        if row["places"] == "all" or artefact.removesuffix("-arm64") in row["places"].split(", "):
            yield row["name"], row["license"], row["text"]


def origins(root):
    """Stem of the wrap -> (version, where it comes from)"""
    found = {}
    for path in glob.glob(os.path.join(root, "subprojects/*.wrap")):
        values = dict(re.findall(r"^(\w+) = (.*)$", read(path), re.M))
        found[os.path.basename(path).removesuffix(".wrap")] = (
            values["directory"].rsplit("-", 1)[1], f"git+{values['url']}@{values['revision']}")
    return found


def identifier(name):
    return "SPDXRef-" + re.sub(r"[^A-Za-z0-9.]+", "-", name)


def package(name, version, license_, origin):
    described = {"SPDXID": identifier(name), "name": name, "downloadLocation": origin or "NOASSERTION", "filesAnalyzed": False,
                 "licenseConcluded": license_, "licenseDeclared": license_, "copyrightText": "NOASSERTION"}
    return described | ({"versionInfo": version} if version else {})


def own_licences(artefact):
    """The extension for Blender has code under Blender's licence beside the package."""
    return {"GPL-3.0-or-later", "MIT"} if artefact == "blender" else {"MIT"}


def licence(root, artefact):
    """Of ffd and of what the artefact contains."""
    return " AND ".join(sorted(own_licences(artefact).union(*(names.split(" AND ") for _, names, _ in libraries(root, artefact)))))


def main():
    root, artefact = sys.argv[1:3]
    if len(sys.argv) == 3:
        print(licence(root, artefact))
        return
    path, commit = sys.argv[3:]
    with open(path, "rb") as file:
        digest = hashlib.sha256(file.read()).hexdigest()
    version = re.search(r'^#define FFD_VERSION "(.*)"$', read(root, "include/ffd/version.h"), re.M)[1]
    name = os.path.basename(path)
    own = package("ffd", version, " AND ".join(sorted(own_licences(artefact))), None)
    own |= {"packageFileName": name, "checksums": [{"algorithm": "SHA256", "checksumValue": digest}],
            "sourceInfo": f"commit {commit}", "primaryPackagePurpose": "SOURCE" if artefact == "source" else "APPLICATION"}
    where = origins(root)
    inside = [package(library, *((where[text][0], license_, where[text][1]) if text in where else (None, license_, None)))
              for library, license_, text in libraries(root, artefact)]
    date = datetime.datetime.fromtimestamp(int(os.environ["SOURCE_DATE_EPOCH"]), datetime.timezone.utc)
    relations = [{"spdxElementId": "SPDXRef-DOCUMENT", "relationshipType": "DESCRIBES", "relatedSpdxElement": own["SPDXID"]}]
    relations += [{"spdxElementId": own["SPDXID"], "relationshipType": "CONTAINS", "relatedSpdxElement": other["SPDXID"]}
                  for other in inside]
    json.dump({
        "spdxVersion": "SPDX-2.3",
        "dataLicense": "CC0-1.0",
        "SPDXID": "SPDXRef-DOCUMENT",
        "name": name,
        "documentNamespace": f"https://ffd.example/spdx/{name}-{digest}",
        "creationInfo": {"created": date.strftime("%Y-%m-%dT%H:%M:%SZ"), "creators": ["Organization: The ffd authors", "Tool: spdx.py"]},
        "packages": [own, *inside],
        "relationships": relations,
    }, sys.stdout, indent=2)
    print()


main()
