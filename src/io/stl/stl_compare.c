/* stl_compare.c - compares two STL files.

   Two STL files are the same mesh if their facets are equal one by one. Corners and normals may differ by
   their tolerances. The two bytes after each facet of a binary file must be equal (in a text they count as
   0). If both files are text, the solids and their names must be equal; if both are binary, the headers. The
   writing of numbers, line breaks, blanks, and anything after the last facet of a binary file are not
   compared. */
#include "io/stl/stl_document.h"
#include "mesh/difference.h"
#include <stdio.h>
#include <string.h>

/* One of the two files, and the current facet. */
typedef struct stl_side {
    const stl_document *document;
    stl_text text; /* of a text file */
    size_t line;   /* of a text file: the line of the facet */
    double normal[3], corners[9];
    unsigned attribute;
} stl_side;

typedef struct comparer {
    stl_side a, b;
    size_t facet;
    int corner; /* of the facet; -1: the facet itself */
    ffd_comparison *result;
} comparer;

static void begin_side(stl_side *side, const stl_document *document)
{
    *side = (stl_side){.document = document};
    ffd_stl_text_begin(&side->text, document->file.input.data, document->file.input.size, NULL);
}

static void next_text_facet(stl_side *side)
{
    stl_facet facet;
    bool found;
    ffd_stl_text_next(&side->text, side->document->file.name, &facet, &found, NULL);
    for (size_t i = 0; found && i < 3; i++)
        ffd_stl_text_normal(facet.normal[i], &side->normal[i]);
    side->line = found ? facet.line : side->text.scan.line;
}

static void next_facet(stl_side *side, size_t index)
{
    ffd_stl_read_corners(side->document, 3 * index, 3, side->corners);
    if (!side->document->binary) {
        next_text_facet(side);
        return;
    }
    const unsigned char *bytes = ffd_stl_facet(side->document, index);
    ffd_stl_load(bytes, side->normal);
    side->attribute = bytes[STL_ATTRIBUTE] | (unsigned)bytes[STL_ATTRIBUTE + 1] << 8;
}

static bool both_text(const comparer *c)
{
    return !c->a.document->binary && !c->b.document->binary;
}

/* Writes "facet 3 counted from 0 (lines 20 and 21), corner 1", with lines if both files have lines. A
   difference_label. */
static void format_place(const void *context, char *text, size_t capacity)
{
    const comparer *c = context;
    char lines[TEXT_LINES_CAPACITY] = "", corner[32] = "";
    if (both_text(c))
        ffd_text_lines(c->a.line, c->b.line, lines);
    if (c->corner >= 0)
        snprintf(corner, sizeof corner, ", corner %d", c->corner);
    snprintf(text, capacity, "facet %zu counted from 0%s%s", c->facet, lines, corner);
}

static void differ_in_solids(comparer *c, stl_event in_a, stl_event in_b)
{
    const bool first = in_a > in_b; /* whether the first file has more here: a facet, or at least a solid */
    const size_t solid = (first ? c->a : c->b).text.solids - 1;
    ffd_difference_stop(c->result, FFD_DIFFERENCE_OTHER, "solid %zu counted from 0 %s the %s", solid,
                        (first ? in_a : in_b) == STL_AT_FACET ? "has more facets in" : "is only in",
                        first ? "first" : "second");
}

/* Compares the solids of two text files: the number of facets and the name of each. Facets are matched
   regardless of solids. */
static void compare_solids(comparer *c)
{
    const stl_text *a = &c->a.text, *b = &c->b.text;
    stl_event in_a = STL_AT_SOLID, in_b = STL_AT_SOLID;
    stl_facet facet;
    while (in_a == in_b && in_a != STL_AT_END) {
        ffd_stl_text_step(&c->a.text, c->a.document->file.name, &facet, &in_a, NULL);
        ffd_stl_text_step(&c->b.text, c->b.document->file.name, &facet, &in_b, NULL);
        if (in_a != in_b)
            differ_in_solids(c, in_a, in_b);
        else if (in_a == STL_AT_SOLID && !ffd_text_same(a->name, b->name))
            ffd_difference_add_text(c->result, FFD_DIFFERENCE_OTHER,
                                    "solid %zu counted from 0 is named \"%.*s\" and \"%.*s\"", a->solids - 1,
                                    ffd_text_display_size(a->name), a->name.first,
                                    ffd_text_display_size(b->name), b->name.first);
    }
}

static void compare_attribute(comparer *c)
{
    char place[128];
    if (c->a.attribute == c->b.attribute)
        return;
    format_place(c, place, sizeof place);
    ffd_difference_add_text(c->result, FFD_DIFFERENCE_OTHER, "%s: attribute %u and %u", place, c->a.attribute,
                            c->b.attribute);
}

static void compare_facet(comparer *c)
{
    for (c->corner = 0; c->corner < 3; c->corner++)
        ffd_difference_vector(c->result, FFD_DIFFERENCE_POSITION, 3, c->a.corners + 3 * c->corner,
                              c->b.corners + 3 * c->corner, format_place, c);
    c->corner = -1;
    ffd_difference_vector(c->result, FFD_DIFFERENCE_NORMAL, 3, c->a.normal, c->b.normal, format_place, c);
    compare_attribute(c);
    c->result->positions_compared += 3;
}

/* Compares everything before the facets. Returns false if the facets cannot be matched. */
static bool same_frame(comparer *c)
{
    const stl_document *a = c->a.document, *b = c->b.document;
    if (a->facets != b->facets)
        ffd_difference_stop(c->result, FFD_DIFFERENCE_TOPOLOGY, "%zu and %zu facets", a->facets, b->facets);
    else if (both_text(c))
        compare_solids(c);
    else if (a->binary && b->binary && memcmp(a->file.input.data, b->file.input.data, STL_HEADER) != 0)
        ffd_difference_add_text(c->result, FFD_DIFFERENCE_OTHER, "the headers of %d bytes are not the same",
                                STL_HEADER);
    return a->facets == b->facets;
}

static void compare_facets(comparer *c)
{
    const size_t facets = c->a.document->facets;
    begin_side(&c->a, c->a.document);
    begin_side(&c->b, c->b.document);
    for (c->facet = 0; c->facet < facets; c->facet++) {
        next_facet(&c->a, c->facet);
        next_facet(&c->b, c->facet);
        compare_facet(c);
    }
}

ffd_status ffd_stl_compare(const mesh_document *a, const mesh_document *b, ffd_comparison *comparison,
                           ffd_error *error)
{
    comparer c = {.result = comparison};
    (void)error;
    begin_side(&c.a, ffd_stl_of(a));
    begin_side(&c.b, ffd_stl_of(b));
    if (same_frame(&c))
        compare_facets(&c);
    return FFD_OK;
}
