/* Two OFF files are the same mesh when their vertices have the same attributes, and vertices and faces are
   the same one by one. x y z may differ by the tolerance; other numbers, normals too, may not. Colours are
   equal where they are the same numbers and written in the same of the two ways, whole (0 to 255) or not (0
   to 1). Comments, blanks, the number of edges, where lines end, and what stands behind the last face are no
   part of the mesh. */
#include "io/difference.h"
#include "io/off/off_document.h"
#include <stdio.h>
#include <string.h>

typedef struct comparer {
    const off_document *a, *b;
    off_walk in_a, in_b;
    double tolerance;
    ffd_comparison *result;
    const char *what; /* "vertex", "face" */
    size_t number, lines[2];
} comparer;

/* "vertex 3 counted from 0 (lines 5 and 6)" */
static void format_place(const comparer *c, char *text, size_t capacity)
{
    const size_t a = c->lines[0], b = c->lines[1];
    if (a == b)
        snprintf(text, capacity, "%s %zu counted from 0 (line %zu)", c->what, c->number, a);
    else
        snprintf(text, capacity, "%s %zu counted from 0 (lines %zu and %zu)", c->what, c->number, a, b);
}

/* All of the following return whether the files can be the same so far. */

static bool differ(comparer *c, const char *what, text_word a, text_word b)
{
    char place[160];
    format_place(c, place, sizeof place);
    ffd_difference_say(c->result, "%s: %s \"%.*s\" and \"%.*s\"", place, what, ffd_text_shown(a), a.first,
                       ffd_text_shown(b), b.first);
    return false;
}

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
            ffd_difference_say(c->result, "%s of vertices are only in the %s", attributes[i].name,
                               attributes[i].a ? "first" : "second");
    if (a->vertices != b->vertices)
        ffd_difference_say(c->result, "%zu and %zu vertices", a->vertices, b->vertices);
    if (a->faces != b->faces)
        ffd_difference_say(c->result, "%zu and %zu faces", a->faces, b->faces);
    return !c->result->difference[0];
}

static bool same_position(comparer *c)
{
    const double *a = c->a->positions + 3 * c->number, *b = c->b->positions + 3 * c->number;
    char place[160];
    for (int axis = 0; axis < 3; axis++)
        if (ffd_difference_of(a[axis], b[axis]) > 0) {
            format_place(c, place, sizeof place);
            ffd_difference_coordinate(c->result, place, axis, a[axis], b[axis], c->tolerance);
        }
    return true;
}

static bool same_normal(comparer *c, const off_vertex *a, const off_vertex *b)
{
    for (size_t i = 0; c->a->directions && i < 3; i++) {
        const size_t place = 3 * c->number + i;
        if (ffd_difference_of(c->a->directions[place], c->b->directions[place]) > 0)
            return differ(c, "normal", a->numbers[3 + i], b->numbers[3 + i]);
    }
    return true;
}

/* Whether a number would be read as one of 0 to 255. */
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

/* What follows: colours, u v. */
static bool same_rest(comparer *c)
{
    for (;;) {
        text_word a, b;
        const bool in_a = ffd_off_walk_rest(&c->in_a, &a), in_b = ffd_off_walk_rest(&c->in_b, &b);
        if (!in_a && !in_b)
            return true;
        if (in_a != in_b || !same_number(a, b))
            return differ(c, "followed by", a, b);
    }
}

static bool same_vertex(comparer *c)
{
    off_vertex a, b;
    ffd_off_walk_vertex(&c->in_a, &a);
    ffd_off_walk_vertex(&c->in_b, &b);
    c->lines[0] = a.line;
    c->lines[1] = b.line;
    return same_position(c) && same_normal(c, &a, &b) && same_rest(c);
}

static bool same_face(comparer *c)
{
    text_word a, b;
    uint64_t corners, x, y;
    ffd_off_walk_face(&c->in_a, &a);
    ffd_off_walk_face(&c->in_b, &b);
    c->lines[0] = c->in_a.scan.line;
    c->lines[1] = c->in_b.scan.line;
    if (!ffd_text_whole(a, &corners) || !ffd_text_whole(b, &y) || corners != y)
        return differ(c, "corners", a, b);
    for (uint64_t i = 0; i < corners; i++) {
        ffd_off_walk_corner(&c->in_a, &a);
        ffd_off_walk_corner(&c->in_b, &b);
        if (!ffd_text_whole(a, &x) || !ffd_text_whole(b, &y) || x != y)
            return differ(c, "vertices", a, b);
    }
    return same_rest(c);
}

static void compare_all(comparer *c)
{
    bool same = true;
    ffd_off_walk_begin(&c->a->header, &c->in_a);
    ffd_off_walk_begin(&c->b->header, &c->in_b);
    c->what = "vertex";
    for (c->number = 0; same && c->number < c->a->header.vertices; c->number++) {
        same = same_vertex(c);
        c->result->positions_compared += same;
    }
    c->what = "face";
    for (c->number = 0; same && c->number < c->a->header.faces; c->number++)
        same = same_face(c);
}

ffd_status ffd_off_compare(const mesh_document *a, const mesh_document *b, double tolerance,
                           ffd_comparison *comparison, ffd_error *error)
{
    comparer c = {.a = ffd_off_of(a), .b = ffd_off_of(b), .tolerance = tolerance, .result = comparison};
    (void)error;
    *comparison = (ffd_comparison){0};
    if (same_header(&c))
        compare_all(&c);
    comparison->equal = !comparison->difference[0];
    return FFD_OK;
}
