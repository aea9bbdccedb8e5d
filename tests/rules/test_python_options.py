#!/usr/bin/env python3
"""What a job can be told, the Python package offers: each member of the descriptions of jobs is in the table of settings, which
the package reads, or named in src/python/ffd_mesh, or below with the reason that it is not."""

import re

import tree

# Of runs of several jobs, and what the program decides by itself.
NOT_OFFERED = {"struct_size", "output_set", "cache", "shared_box", "depfile", "morph_results", "only_positions", "as_stored"}
# Structure -> the header, and the files that name its members.
COMMON = ("description", "library")
STRUCTURES = {
    "ffd_deform_desc": ("job", "jobs"), "ffd_source": ("job", "jobs"), "ffd_view_desc": ("job", "views"), "ffd_edit_desc": ("job", "views"),
    "ffd_compare_desc": ("job", "facts"), "ffd_info_desc": ("job", "facts"), "ffd_jacobian_desc": ("jacobian", "jacobian"),
    "ffd_animate_desc": ("animate", "animate"),
}


def members(name, text):
    """The members of a structure, without comments."""
    body = re.search(r"typedef struct " + name + r" \{(.*?)\n\} " + name + ";", text, re.S).group(1)
    return re.findall(r"(\w+)(?:\[[^\]]*\])?\s*[;,]", body)


def settings():
    """The members in the table of settings, and those with the numbers of lists."""
    rows = re.findall(r'\{"([\w.]+)",\s+(?:"[\w-]+"|NULL),\s+FFD_MEMBER_\w+,\s+AT\([\w.]+\),\s+(?:AT\(([\w.]+)\)|0)', tree.read("src/job/input/settings.c"))
    return {name.rpartition(".")[2] for row in rows for name in row if name}


def main():
    checked, findings, table = 0, [], settings()
    for structure, (header, source) in STRUCTURES.items():
        text = re.sub(r"/\*.*?\*/", "", tree.read(f"include/ffd/{header}.h"), flags=re.S)
        package = "".join(tree.read(f"src/python/ffd_mesh/_{name}.py") for name in (*COMMON, source))
        offered = set(re.findall(r"\w+", package)) | NOT_OFFERED | table
        names = [name for name in members(structure, text) if not name.endswith("_room")]
        findings += [f"{structure}.{name}: not offered by src/python/ffd_mesh" for name in names if name not in offered]
        checked += len(names)
    tree.finish(checked, "members", findings)


main()
