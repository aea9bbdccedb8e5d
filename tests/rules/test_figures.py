#!/usr/bin/env python3
"""Each figure of a job stands in the table of src/job/figures/figures.c, in ffd_job_result, in the schema of reports and in the page
that describes them; pages and options use its names."""

import json
import re

import tree

TABLE, SCHEMA, PAGE = "src/job/figures/figures.c", "data/schema/ffd-report.schema.json", "data/schema/formats.md"
HEADERS = ("include/ffd/fold.h", "include/ffd/result.h", "src/job/figures/pass_totals.h", "src/mesh/mesh.h")
STATUSES = ("inside", "outside", "multiple", "singular", "invalid")

# Members of the result that are no figures, or belong to one with another name.
NO_FIGURES = {"struct_size", "status", "error", "picture", "page", "own_frame", "outputs", "flaw_count", "folds.struct_size", "morphs.count", "morphs.names",
              "morphs.lattices", "morphs.results", "rigid.count", "rigid.parts"}
# Members of pass_totals that are not joined tile by tile, and not copied to the result.
OF_PASS = {"of_shown", "rounding.error", "rounding.float_error", "rounding.before", "splats_moved", "splat_parts", "splat_part_count", "others"}
# Members of an entry that say which job it is, and what became of it.
OF_ENTRY = {"line", "set", "input", "output", "outputs", "positions", "row", "picture", "page", "own_frame", "status", "exit", "error"}


class Row:
    def __init__(self, kind, name, rest):
        self.kind, self.name, self.key = kind, name, name.split(".")[-1]
        self.is_absent, self.is_null = "ABSENT_UNLESS" in rest, "NULL_UNLESS" in rest
        self.is_of_job, self.is_time = "OF_JOB" in rest, ".is_time" in rest
        self.members = []


def table():
    """The figures of the report as a tree, all names in the result, and the members that say whether others are there."""
    text = tree.read(TABLE)
    text = text[text.index("ffd_figures[] = {"):text.index("Of a pass only")]
    top, groups, names = [], [], set()
    for kind, name, morphs, rest in re.findall(r'\{(?:(FIGURE|HELD_BACK|GROUP)\(([\w.]+)\)|\.name = "(\w+)")(.*?)\},\n|\bEND,', text, re.S):
        if not (name or morphs):
            groups.pop()
            continue
        row = Row(kind or "FIGURE", name or morphs, rest)
        names |= {row.name} | set(re.findall(r"(?:NULL|ABSENT)_UNLESS\w*\(([\w.]+)", rest))
        if kind != "HELD_BACK":
            (groups[-1].members if groups else top).append(row)
        if kind == "GROUP":
            groups.append(row)
    return top, names


def structs():
    """Struct -> (type, name) of its members, of the headers."""
    text = re.sub(r"/\*.*?\*/", "", "".join(tree.read(path) for path in HEADERS), flags=re.S)
    found = {}
    for name, body in re.findall(r"typedef struct \w+ \{([^{}]*)\} (\w+);", text, re.S):
        name, body = body, name
        members = (re.fullmatch(r"\s*((?:const |struct )*\w+)\s+(.*)", part, re.S) for part in body.split(";") if part.strip())
        found[name] = [(member[1], each.strip(" *")) for member in members for each in member[2].replace("const *", "").split(",")]
    return found


def in_result(known, struct="ffd_job_result", path=""):
    """Paths of all members, but for those that are reserved."""
    for kind, name in known[struct]:
        plain = re.sub(r"\[.*", "", name)
        if plain.endswith("room"):
            continue
        if kind in known and plain == name and kind != "ffd_bounds":
            yield from in_result(known, kind, f"{path}{plain}.")
        else:
            yield path + plain


def keys(rows):
    return [key for row in rows for key in (STATUSES if row.name == "counts" else (row.key,))]


def followed(schema, node):
    """A node, or what it refers to."""
    while "$ref" in node:
        found = schema
        for step in node["$ref"].removeprefix("#/").split("/"):
            found = found[step]
        node = found
    return node


def inner(schema, node):
    """The same, without null beside it."""
    node = followed(schema, node)
    kinds = [kind for kind in node.get("oneOf", ()) if kind != {"type": "null"}]
    return inner(schema, kinds[0]) if len(kinds) == 1 else node


def takes_null(schema, node):
    node = followed(schema, node)
    return {"type": "null"} in node.get("oneOf", ()) or "null" in node.get("type", ())


def against_schema(schema, node, rows, path, others=()):
    """What an object of the schema has that the figures have not, and the other way round."""
    properties, required = node["properties"], set(node.get("required", ()))
    expected = set(keys(rows)) | set(others)
    for key in sorted(set(properties) ^ expected):
        yield f"{SCHEMA}: {path}{key} is {'not in' if key in properties else 'only in'} {TABLE}"
    needed = set(keys(row for row in rows if not row.is_absent and not row.is_time))
    for key in sorted((required - set(others)) ^ needed):
        yield f"{SCHEMA}: {path}{key} is {'required' if key in required else 'not required'}, unlike in {TABLE}"
    for row in rows:
        if row.key in properties and row.is_null and not takes_null(schema, properties[row.key]):
            yield f"{SCHEMA}: {path}{row.key} may not be null, unlike in {TABLE}"
        if path and not row.is_null and row.key in properties and takes_null(schema, properties[row.key]) and \
                inner(schema, properties[row.key]).get("type") == "integer":
            yield f"{SCHEMA}: {path}{row.key} may be null, unlike in {TABLE}"
        if row.kind == "GROUP" and row.key in properties:
            yield from against_schema(schema, inner(schema, properties[row.key]), row.members, f"{path}{row.key}.")


def against_page(rows):
    """Each figure has a row in the page's table of members. The members of a group are named there, or below the table where the group
    is."""
    section = re.search(r"^## 2\. .*?(?=^## 3\. )", tree.read(PAGE), re.S | re.M)[0]
    first, *parts = section.split("\n### ")
    described = {}
    for cell, text in re.findall(r"^\| (`[^|]*) \| (.*) \|$", first, re.M):
        for name in re.findall(r"`([\w.]+)`", cell):
            described[name] = set(re.findall(r"`([\w.]+)`", text))
    for part in parts:
        words = set(re.findall(r"`([\w.]+)`", part))
        for name in {word.split(".")[0] for word in words} & set(described):
            described[name] |= {step for word in words for step in word.split(".")}
    for key in sorted(set(keys(rows)) - set(described)):
        yield f"{PAGE}: {key} has no row"
    for name in sorted(described):
        if name.split(".")[0] not in set(keys(rows)) | OF_ENTRY:
            yield f"{PAGE}: {name} is not in {TABLE}"

    def members(row, name):
        for member in row.members:
            path = f"{name}.{member.key}"
            if path not in described and member.key not in described.get(name, ()):
                yield f"{PAGE}: {path} is not described in the row of {name}, nor below"
            yield from members(member, path) if path in described else ()

    for row in rows:
        yield from members(row, row.key)


def against_pages(rows):
    """What the pages read of a report, and lists of names that are written in another language."""
    panel, known = tree.read("src/view/page/panel.js"), {key: [] for key in keys(rows)}
    known |= {row.key: [member.key for member in row.members] for row in rows}
    for name, member in re.findall(r"\bjob\.([a-z_]+)(?:\.([a-z_]+))?", panel):
        if name not in known or member and known[name] and member not in known[name]:
            yield f"src/view/page/panel.js: job.{name}{'.' + member if member else ''} is not in {TABLE}"
    listed = re.search(r"STATUS_NAMES = \[(.*)\]", tree.read("src/view/page/decode.js"))[1]
    if tuple(re.findall(r"'(\w+)'", listed)) != names_of("ffd_vertex_status"):
        yield "src/view/page/decode.js: STATUS_NAMES are not those of src/base/names.c"
    listed = re.search(r"color_names\[\] = \{(.*), NULL\}", tree.read("src/cli/look.c"))[1]
    # No --color at all is the last one.
    if (*re.findall(r'"(\w+)"', listed), "auto") != names_of("ffd_view_color"):
        yield "src/cli/look.c: color_names are not those of src/base/names.c"


def names_of(enumeration):
    body = re.search(rf"\*{enumeration}_name\(.*?\n\}}", tree.read("src/base/names.c"), re.S)[0]
    return tuple(re.findall(r'"(\w+)"', body))


def main():
    top, names = table()
    findings = []
    members = set(in_result(structs()))
    for name in sorted(members - names - NO_FIGURES):
        findings.append(f"include/ffd: ffd_job_result.{name} has no row in {TABLE}")
    joined = re.findall(r"FROM\(([\w.]+)", tree.read(TABLE))
    for name in sorted({name for name in joined if joined.count(name) > 1}):
        findings.append(f"{TABLE}: {name} of a pass is in two rows: it is joined twice")
    for name in sorted(set(in_result(structs(), "pass_totals")) - set(joined) - OF_PASS):
        findings.append(f"src/job/figures/pass_totals.h: {name} has no row in {TABLE}: it is neither cleared nor joined")
    schema = json.loads(tree.read(SCHEMA))
    job, morph = schema["$defs"]["job"], schema["$defs"]["morph"]
    findings += against_schema(schema, job, top, "", OF_ENTRY)
    findings += against_schema(schema, morph, [row for row in top if not row.is_of_job], "morphs.", {"name", "lattice"})
    findings += against_page(top)
    findings += against_pages(top)
    if names_of("ffd_vertex_status") != STATUSES:
        findings.append("src/base/names.c: other statuses than here")
    tree.finish(len(names), "figures", findings)


main()
