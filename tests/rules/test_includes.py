#!/usr/bin/env python3
"""An #include goes to the same folder, to a lower layer, or to the public headers; other libraries and the
system's interfaces are reached from the folders that are there for them only."""

import os
import re

import tree

# Folder under src/ -> the folders under src/ that its files may include from.
LAYERS = {
    "base/macos": set(),
    "base/windows": set(),
    "base": {"base/macos", "base/windows"},
    "base/memory": {"base"},
    "base/file": {"base", "base/memory", "base/system", "base/text", "base/windows"},
    "base/vector": {"base"},
    "base/text": {"base", "base/memory", "base/vector"},
    "base/system": {"base", "base/memory", "base/text", "base/windows"},
    "io/npy": {"base", "base/file", "base/memory"},
    "io/csv": {"base/text", "json"},
    "json": {"base", "base/memory", "base/text"},
    "splat": {"base", "base/vector"},
    "cells": {"base", "base/memory", "base/vector"},
    "mesh": {"base", "base/file", "base/memory", "base/system", "base/text", "base/vector", "cells", "json", "splat"},
    "mesh/morph": {"base", "base/memory", "base/text", "json"},
    "mesh/meshopt": {"base", "base/system", "base/text"},
    "mesh/resource": {"base", "base/file", "base/memory", "base/system", "base/text", "mesh"},
    "picture/image": {"base", "base/memory", "base/system", "mesh"},
    "picture": {
        "base", "base/memory", "base/system", "base/vector", "mesh", "picture/image",
    },
    "io/gltf/file": {"base", "base/file", "base/memory", "base/text", "json"},
    "io/gltf/read": {
        "base", "base/file", "base/memory", "base/system", "base/text", "base/vector", "io/gltf/file",
        "json", "mesh", "mesh/meshopt",
    },
    "io/gltf/model": {
        "base", "base/memory", "base/system", "base/text", "base/vector", "io/gltf/read", "mesh", "splat",
    },
    "io/gltf/edit": {
        "base", "base/memory", "base/text", "base/vector", "io/gltf/model", "io/gltf/read", "json", "mesh", "mesh/morph",
    },
    "io/gltf/write": {
        "base", "base/file", "base/memory", "base/system", "base/text", "io/gltf/edit", "io/gltf/file",
        "io/gltf/model", "io/gltf/read", "json", "mesh/resource",
    },
    "io/gltf": {
        "base", "base/file", "base/memory", "base/system", "base/text", "base/vector", "io/gltf/edit", "io/gltf/file",
        "io/gltf/model", "io/gltf/read", "io/gltf/write", "json", "mesh", "mesh/resource", "splat",
    },
    "io/deflate": {"base", "base/system"},
    "io/openmesh": {"base/memory", "base/system", "base/vector", "mesh"},
    "io/text": {"base/file", "base/memory", "base/text", "mesh"},
    "io/obj/resource": {"base", "base/file", "base/memory", "base/text", "io/text", "mesh", "mesh/resource"},
    "io/obj": {
        "base", "base/file", "base/memory", "base/system", "base/text", "io/obj/resource", "io/text", "mesh",
    },
    "io/off": {"base/file", "base/memory", "base/system", "base/text", "io/text", "mesh"},
    "io/ply": {
        "base", "base/file", "base/memory", "base/system", "base/text", "base/vector", "io/text", "mesh",
        "mesh/resource", "splat",
    },
    "io/volume": {"base", "base/memory", "base/system", "base/text", "base/vector", "io/text", "mesh"},
    "io/vtk": {"base/memory", "base/system", "io/volume", "mesh"},
    "io/vtkxml": {"base/memory", "base/system", "base/text", "io/deflate", "io/volume", "mesh"},
    "io/foam": {"base", "base/file", "base/memory", "base/system", "base/text", "io/volume", "mesh"},
    "io/msh": {"base/memory", "base/system", "io/volume", "mesh"},
    "io/su2": {"base", "base/memory", "base/system", "base/text", "io/volume", "mesh"},
    "io/stl": {"base", "base/memory", "base/system", "base/text", "base/vector", "io/text", "mesh"},
    "io": {
        "base", "base/file", "base/memory", "base/text", "io/foam", "io/gltf", "io/msh", "io/obj", "io/off", "io/ply", "io/stl", "io/su2", "io/vtk",
        "io/vtkxml",        "mesh",
    },
    "io/write": {
        "base", "base/file", "base/memory", "base/system", "base/text", "base/vector", "io/gltf/file", "io/stl", "json",
        "mesh", "mesh/morph", "mesh/resource",
    },
    "view": {
        "base", "base/file", "base/memory", "base/system", "base/text", "base/vector", "json", "mesh", "mesh/meshopt",
        "picture", "picture/image",
    },
    "job/report": {"base", "base/file", "base/memory", "base/text", "job/figures", "json"},
    "spline": {"base", "base/memory", "base/text"},
    "lattice": {"base", "base/file", "base/memory", "base/text", "base/vector", "spline"},
    "author": {"base", "base/file", "base/memory", "base/system", "base/vector", "lattice", "spline"},
    "lattice/file": {"base", "base/file", "base/memory", "base/text", "base/vector", "json", "lattice", "lattice/formats"},
    "lattice/formats": {"base", "base/file", "base/memory", "base/text", "base/vector", "io/deflate", "io/npy", "json", "lattice"},
    "lattice/tangent": {"base/memory", "base/text", "base/vector", "lattice"},
    "embed/frame": {"base", "base/memory", "base/vector", "lattice", "spline"},
    "embed/boundary": {"base", "base/memory", "base/vector", "embed/frame", "lattice", "spline"},
    "deform": {"base", "base/vector", "embed/boundary", "lattice"},
    "embed/cells": {"base/memory", "base/vector", "embed/frame", "lattice", "spline"},
    "embed/direct": {"base", "base/memory", "base/vector", "embed/frame", "spline"},
    "embed": {"base", "base/memory", "base/vector", "embed/boundary", "embed/cells", "embed/direct", "embed/frame"},
    "fit": {"author", "base", "base/memory", "base/system", "base/vector", "lattice", "points", "spline"},
    "fold/affine": {"base/vector", "lattice"},
    "fold": {"base", "base/memory", "base/system", "base/vector", "embed/frame", "fold/affine", "lattice", "spline"},
    "points": {
        "base", "base/memory", "base/system", "base/text", "base/vector", "cells", "deform", "embed", "embed/boundary", "lattice",
        "lattice/tangent", "mesh", "spline",
    },
    "job/input": {
        "base", "base/file", "base/memory", "base/system", "base/text", "base/vector", "io", "io/npy", "lattice",
        "mesh",
    },
    "job/chain": {
        "author", "base", "base/file", "base/memory", "base/system", "base/text", "base/vector", "deform", "embed", "embed/boundary",
        "embed/frame", "job/input", "lattice", "lattice/file", "mesh",
    },
    "job/figures": {"base/text", "mesh"},
    "job/pass": {
        "base", "base/memory", "base/system", "base/vector", "deform", "io/openmesh", "job/chain", "job/figures", "job/input",
        "lattice", "mesh",
    },
    "job/judge": {"base", "base/memory", "base/text", "job/chain", "job/figures", "lattice"},
    "job/measure": {
        "base", "base/memory", "base/system", "base/text", "base/vector", "cells", "deform", "embed", "embed/frame", "io/openmesh",
        "job/chain", "job/figures", "job/input", "job/pass", "lattice", "mesh",
    },
    "job/animate": {
        "base", "base/file", "base/memory", "base/system", "base/text", "base/vector", "job", "job/chain", "job/input", "json", "lattice",
        "lattice/file", "mesh", "mesh/morph",
    },
    "job/arrays": {
        "base", "base/memory", "base/text", "base/vector", "deform", "embed", "job/chain", "lattice", "mesh", "points",
    },
    "job/jacobian": {
        "base", "base/file", "base/memory", "base/system", "base/text", "base/vector", "deform", "embed/boundary", "io/npy",
        "job", "job/chain", "job/input", "job/judge", "job/pass", "lattice/tangent", "points",
    },
    "job/view": {
        "base", "base/file", "base/memory", "base/system", "base/text", "base/vector", "deform", "embed", "job",
        "job/chain", "job/figures", "job/input", "job/measure", "job/pass", "job/report", "json", "lattice", "lattice/file", "mesh", "view",
    },
    "job/author": {
        "author", "base", "base/file", "base/memory", "base/system", "base/text", "base/vector", "io/csv", "io/npy", "job", "job/chain", "job/input", "job/pass",
        "job/report", "lattice", "lattice/file", "lattice/formats", "mesh",
    },
    "batch/manifest": {
        "base", "base/file", "base/memory", "base/system", "base/text", "io", "io/csv", "job/input", "json", "mesh",
    },
    "batch/files": {"base/file", "base/memory", "base/text", "batch/manifest", "io"},
    "batch": {
        "base", "base/file", "base/memory", "base/system", "base/text", "batch/files", "batch/manifest", "io", "io/npy", "job", "job/chain", "job/figures", "job/input",
        "job/report", "job/view", "json", "lattice/file", "mesh/resource", "view",
    },
    # A client of the library as others are: what it lacks is made public, or belongs further down.
    "cli": set(),
    "cli/pages": {"cli"},
    "python": set(),
    "wasm": {"base"},
    "job": {
        "base", "base/file", "base/memory", "base/system", "base/text", "base/vector", "io", "io/npy",
        "io/openmesh", "io/write", "job/chain", "job/figures", "job/input", "job/judge", "job/measure", "job/pass", "job/report", "json",
        "lattice", "lattice/file", "mesh", "mesh/morph", "mesh/resource",
    },
}

# <header> pattern -> folders that may include it.
OUTSIDE = [
    (r"OpenMesh/", {"io/openmesh"}),
    (r"tiny_gltf\.h|nlohmann/", {"io/gltf/read"}),
    (r"draco/", {"io/gltf/read"}),
    (r"meshoptimizer\.h", {"mesh/meshopt"}),
    (r"png\.h|jpeglib\.h|jerror\.h|webp/", {"picture/image"}),
    (r"Python\.h", {"python"}),
    (r"xxhash\.h|xxh3\.h", {"base/memory"}),
    (r"sys/platform/", {"base/vector"}),
    (r"unistd\.h|fcntl\.h|pthread\.h|sys/(?!platform/)|dirent\.h|dlfcn\.h|sched\.h|spawn\.h|glob\.h|poll\.h|windows\.h",
     {"base", "base/file", "base/macos", "base/memory", "base/system", "base/windows"}),
]

INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*(?:"([^"]+)"|<([^>]+)>)', re.M)


def main():
    findings = []
    checked = 0
    used = set()
    for path in tree.files():
        if not path.endswith((".c", ".h", ".cpp")) or not path.startswith(("src/", "include/")):
            continue
        checked += 1
        folder = os.path.dirname(path).split("/", 1)[1]
        for match in INCLUDE.finditer(tree.read(path)):
            quoted, angled = match.groups()
            if path.startswith("include/"):
                if quoted or not (angled.startswith("ffd/") or re.fullmatch(r"std\w+\.h", angled)):
                    findings.append(f"{path}: a public header includes {quoted or angled}")
                continue
            if folder not in LAYERS:
                findings.append(f"{path}: folder src/{folder} has no place in the table of {__file__}")
                break
            if quoted:
                target = os.path.dirname(quoted) or folder
                used.add((folder, target))
                if target != folder and target not in LAYERS[folder]:
                    findings.append(f'{path}: src/{folder} must not include "{quoted}"')
                continue
            for pattern, allowed in OUTSIDE:
                if re.match(pattern, angled) and folder not in allowed:
                    findings.append(f"{path}: <{angled}> belongs in {', '.join(sorted(allowed))} only")
    findings += [f"the table of {__file__} has src/{target} below src/{folder}, but nothing of it is included there"
                 for folder, targets in LAYERS.items() for target in sorted(targets) if (folder, target) not in used]
    tree.finish(checked, "files", findings)


main()
