/* off_compare.c - compares two OFF files.

   Two OFF files are the same mesh if their vertices have the same attributes, and vertices and faces are
   equal one by one. Positions and normals may differ by their tolerances, other numbers may not. Colours are
   equal if they are the same numbers in the same form: whole numbers (0 to 255) or decimals (0 to 1).
   Comments, blanks, the number of edges, line breaks, and anything after the last face are not compared. */
#include "io/off/off_document.h"
#include "mesh/difference.h"
#include <stdio.h>
#include <string.h>

typedef struct comparer {
    const off_document *a, *b;
    off_walk in_a, in_b;
    ffd_comparison *result;
    const char *what; /* "vertex", "face" */
    size_t index, lines[2];
} comparer;

/* Writes "vertex 3 counted from 0 (lines 5 and 6)". A difference_label. */
static void format_place(const void *context, char *text, size_t capacity)
{
    const comparer *c = context;
    char lines[TEXT_LINES_CAPACITY];
    ffd_text_lines(c->lines[0], c->lines[1], lines);
    snprintf(text, capacity, "%s %zu counted from 0%s", c->what, c->index, lines);
}

static void differ(comparer *c, ffd_difference_kind kind, const char *what, text_word a, text_word b)
{
    char place[160];
    format_place(c, place, sizeof place);
    ffd_difference_add_text(c->result, kind, "%s: %s \"%.*s\" and \"%.*s\"", place, what,
                            ffd_text_display_size(a), a.first, ffd_text_display_size(b), b.first);
}

/* Whether the vertices and faces of both files can be matched one by one. */
static bool same_header(comparer *c)
{
    const off_header *a = &c->a->header, *b = &c->b->header;
    const struct {
        const char *name;
        bool a, b;
    } attributes[] = {{"normals", a->has_normals, b->has_normals},
                      {"colors", a->has_colours, b->has_colours},
                      {"texcoords", a->has_texcoords, b->has_texcoords}};
    for (size_t i = 0; i < sizeof attributes / sizeof *attributes; i++)
        if (attributes[i].a != attributes[i].b)
            ffd_difference_stop(c->result, FFD_DIFFERENCE_OTHER, "%s of vertices are only in the %s",
                                attributes[i].name, attributes[i].a ? "first" : "second");
    if (a->vertices != b->vertices)
        ffd_difference_stop(c->result, FFD_DIFFERENCE_TOPOLOGY, "%zu and %zu vertices", a->vertices,
                            b->vertices);
    if (a->faces != b->faces)
        ffd_difference_stop(c->result, FFD_DIFFERENCE_TOPOLOGY, "%zu and %zu faces", a->faces, b->faces);
    return c->result->complete;
}

static void compare_vectors(comparer *c)
{
    const off_document *a = c->a, *b = c->b;
    const size_t at = 3 * c->index;
    ffd_difference_vector(c->result, FFD_DIFFERENCE_POSITION, 3, a->file.positions + at,
                          b->file.positions + at, format_place, c);
    if (a->file.directions)
        ffd_difference_vector(c->result, FFD_DIFFERENCE_NORMAL, 3, a->file.directions + at,
                              b->file.directions + at, format_place, c);
    c->result->positions_compared++;
}

/* Whether readers take a number as one of 0 to 255. */
static bool is_whole(text_word word)
{
    uint64_t value;
    return ffd_text_whole(word, &value);
}

static bool same_number(text_word a, text_word b)
{
    double x, y;
    return ffd_text_same(a, b) || (is_whole(a) == is_whole(b) && ffd_text_number(a, &x) &&
                                   ffd_text_number(b, &y) && !(ffd_difference_of(x, y) > 0));
}

/* Compares the remaining words of a vertex or face: colours, u v. Adds one difference at most. */
static void compare_rest(comparer *c, ffd_difference_kind kind)
{
    for (;;) {
        text_word a, b;
        const bool in_a = ffd_off_walk_rest(&c->in_a, &a), in_b = ffd_off_walk_rest(&c->in_b, &b);
        if (!in_a && !in_b)
            return;
        if (in_a != in_b || !same_number(a, b)) {
            differ(c, kind, "followed by", a, b);
            return;
        }
    }
}

static void compare_vertex(comparer *c)
{
    const off_header *header = &c->a->header;
    off_vertex a, b;
    ffd_off_walk_vertex(&c->in_a, &a);
    ffd_off_walk_vertex(&c->in_b, &b);
    c->lines[0] = a.line;
    c->lines[1] = b.line;
    compare_vectors(c);
    compare_rest(c, header->has_texcoords && !header->has_colours ? FFD_DIFFERENCE_TEXCOORD
                                                                  : FFD_DIFFERENCE_OTHER);
}

/* Reads and compares the corners of a face in both files. Adds one difference at most. */
static void compare_corners(comparer *c, uint64_t count_a, uint64_t count_b)
{
    bool same = count_a == count_b;
    for (uint64_t i = 0; i < count_a || i < count_b; i++) {
        text_word a = {0}, b = {0};
        uint64_t x = 0, y = 0;
        const bool in_a = i < count_a && ffd_off_walk_whole(&c->in_a, &a, &x);
        const bool in_b = i < count_b && ffd_off_walk_whole(&c->in_b, &b, &y);
        if (!in_a && !in_b)
            return; /* another program has changed the files since they were read */
        if (same && (!in_a || !in_b || x != y)) {
            differ(c, FFD_DIFFERENCE_TOPOLOGY, "vertices", a, b);
            same = false;
        }
    }
}

static void compare_face(comparer *c)
{
    text_word a, b;
    uint64_t x = 0, y = 0;
    ffd_off_walk_face(&c->in_a);
    ffd_off_walk_face(&c->in_b);
    c->lines[0] = c->in_a.scan.line;
    c->lines[1] = c->in_b.scan.line;
    ffd_off_walk_whole(&c->in_a, &a, &x);
    ffd_off_walk_whole(&c->in_b, &b, &y);
    if (x != y)
        differ(c, FFD_DIFFERENCE_TOPOLOGY, "corners", a, b);
    compare_corners(c, x, y);
    compare_rest(c, FFD_DIFFERENCE_OTHER);
}

static void compare_all(comparer *c)
{
    ffd_off_walk_begin(&c->a->header, &c->in_a);
    ffd_off_walk_begin(&c->b->header, &c->in_b);
    c->what = "vertex";
    for (c->index = 0; c->index < c->a->header.vertices; c->index++)
        compare_vertex(c);
    c->what = "face";
    for (c->index = 0; c->index < c->a->header.faces; c->index++)
        compare_face(c);
}

ffd_status ffd_off_compare(const mesh_document *a, const mesh_document *b, ffd_comparison *comparison,
                           ffd_error *error)
{
    comparer c = {.a = ffd_off_of(a), .b = ffd_off_of(b), .result = comparison};
    (void)error;
    if (same_header(&c))
        compare_all(&c);
    return FFD_OK;
}
