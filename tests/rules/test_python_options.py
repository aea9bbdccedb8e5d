#!/usr/bin/env python3
"""What a job on a file can be told, the Python package offers: each member of ffd_deform_desc and ffd_source is named in
src/python/ffd_mesh, or below with the reason that it is not."""

import re

import tree

# Of runs of several jobs, and what the program decides by itself.
NOT_OFFERED = {"struct_size", "written", "share", "shared_box", "depfile", "morph_results", "only_positions"}


def members(name, text):
    """The members of a structure, without comments."""
    body = re.search(r"typedef struct " + name + r" \{(.*?)\n\} " + name + ";", text, re.S).group(1)
    return re.findall(r"(\w+)(?:\[[^\]]*\])?\s*[;,]", body)


def main():
    header = re.sub(r"/\*.*?\*/", "", tree.read("include/ffd/job.h"), flags=re.S)
    package = "".join(tree.read(f"src/python/ffd_mesh/_{name}.py") for name in ("description", "jobs", "library"))
    offered = set(re.findall(r"\w+", package))
    names = [name for name in members("ffd_deform_desc", header) + members("ffd_source", header) if not name.endswith("_room")]
    tree.finish(len(names), "members", [f"{name}: not offered by src/python/ffd_mesh" for name in names
                                        if name not in offered | NOT_OFFERED])


main()
