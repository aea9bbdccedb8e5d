#!/usr/bin/env python3
"""The limits that data/promises.md and data/reference.md state are those that the source defines."""

import re

import tree

LIMITS, REFERENCE = "data/promises.md", "data/reference.md"
# What a page says, where N is the value that a macro of the source has, written as a power of two, with a sum of one,
# or with commas.
STATED = (
    (LIMITS, "| control points of a lattice | N |", "src/lattice/lattice.h", "FFD_MAX_CONTROL_POINTS"),
    (LIMITS, "| lattices of a job | N |", "include/ffd/result.h", "FFD_LATTICES_MOST"),
    (LIMITS, "OBJ (and normals), OFF, glTF (of its scene), VTK, SU2, Gmsh, OpenFOAM, conversions: N;", "src/io/obj/obj_document.h", "OBJ_ELEMENTS_MAX"),
    (LIMITS, "OBJ (and normals), OFF, glTF (of its scene), VTK, SU2, Gmsh, OpenFOAM, conversions: N;", "src/io/off/off_header.h", "OFF_VERTICES_MAX"),
    (LIMITS, "OBJ (and normals), OFF, glTF (of its scene), VTK, SU2, Gmsh, OpenFOAM, conversions: N;", "src/io/gltf/model/gltf_parts.c", "MOST_VERTICES"),
    (LIMITS, "OBJ (and normals), OFF, glTF (of its scene), VTK, SU2, Gmsh, OpenFOAM, conversions: N;", "src/mesh/model.h", "MODEL_VALUES_MAX"),
    (LIMITS, "STL: N facets", "src/io/stl/stl_document.h", "STL_FACETS_MAX"),
    (LIMITS, "glTF: N triangles of its scene", "src/io/gltf/model/gltf_faces.c", "MOST_TRIANGLES"),
    (LIMITS, "N sets of joints", "src/io/gltf/model/gltf_skin.c", "MOST_SETS"),
    (LIMITS, "N names, 1 MiB", "src/io/obj/resource/obj_paths.h", "OBJ_RESOURCES_MAX"),
    (LIMITS, "N elements and properties", "src/io/ply/ply_header.h", "PLY_DECLARATIONS_MAX"),
    (LIMITS, "N pixels a side", "src/picture/image/image.h", "IMAGE_MOST_SIDE"),
    (LIMITS, "N in all; then grey", "src/picture/image/image.h", "IMAGE_MOST_PIXELS"),
    (LIMITS, "where N parts of its cells", "src/embed/cells/cells.h", "MOST_HEAVY_LEAVES"),
    (REFERENCE, "a mesh of more than N vertices is simplified", "src/view/page_options.h", "VIEW_PAGE_VERTICES"),
    (REFERENCE, "Lattices are left out of it above N control points", "src/view/page_options.h", "VIEW_PAGE_CONTROLS"),
    (REFERENCE, "(of a picture above N)", "src/view/view_cages.h", "VIEW_PICTURE_CONTROLS"),
)
LARGEST = {"UINT16_MAX": 2**16 - 1, "INT32_MAX": 2**31 - 1, "UINT32_MAX": 2**32 - 1}


def value(path, macro):
    """The whole number that #define gives a macro, without casts."""
    text = re.search(rf"^#define {macro}\s+(.*?)(?:/\*.*)?$", tree.read(path), re.M)[1]
    text = re.sub(r"\((?:size_t|u?int\d+_t)\)", "", text).replace("/", "//")
    return eval(text, {"__builtins__": {}}, LARGEST)  # pylint: disable=eval-used


def spellings(number):
    yield f"{number:,}"
    for more, end in ((0, ""), (1, " - 1"), (2, " - 2")):
        power = number + more
        if power & (power - 1) == 0:
            yield f"2^{power.bit_length() - 1}{end}"


def main():
    findings = []
    for page, sentence, path, macro in STATED:
        number = value(path, macro)
        if not any(sentence.replace("N", spelled, 1) in tree.read(page) for spelled in spellings(number)):
            findings.append(f"{page} does not say '{sentence}' with the {number} of {macro}")
    tree.finish(len(STATED), "limits", findings)


main()
