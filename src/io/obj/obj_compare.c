/* obj_compare.c - compares two OBJ files. Two OBJ files are the same mesh when their statements are,
   one by one: the keyword, and each argument as text, as a number (1.0 and 1, NaN and NaN) or, in f, l
   and p, as the element it names (-1 and 8). The coordinates of `v` and `vn` may differ by their
   tolerances; other numbers may not. Names and mtllib are compared; comments, empty lines, blanks,
   continuations and line ends are not. */
#include "io/obj/obj_document.h"
#include "io/obj/obj_number.h"
#include "mesh/difference.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

typedef struct comparer {
    obj_walk a, b;
    ffd_comparison *result;
} comparer;

/* What is compared: "vertex 17 (line 4)", "normal 3 (line 4)", or the keyword. A difference_label. */
static void format_place(const void *context, char *text, size_t capacity)
{
    const comparer *c = context;
    const text_word name = c->a.scan.name;
    char lines[TEXT_LINES_CAPACITY];
    ffd_text_lines(c->a.scan.line, c->b.scan.line, lines);
    if (c->a.scan.keyword == OBJ_VERTEX)
        snprintf(text, capacity, "vertex %zu%s", c->a.vertices.seen, lines);
    else if (c->a.scan.keyword == OBJ_NORMAL)
        snprintf(text, capacity, "normal %zu%s", c->a.normals.seen, lines);
    else if (c->a.scan.keyword == OBJ_TEXCOORD)
        snprintf(text, capacity, "texcoord %zu%s", c->a.texcoords.seen, lines);
    else
        snprintf(text, capacity, "%.*s%s", ffd_text_display_size(name), name.first, lines);
}

/* The kind of a difference in what a statement has besides coordinates, such as the weight
   or colour of a vertex. */
static ffd_difference_kind kind_of(obj_keyword keyword)
{
    switch (keyword) {
    case OBJ_NORMAL:
        return FFD_DIFFERENCE_NORMAL;
    case OBJ_TEXCOORD:
        return FFD_DIFFERENCE_TEXCOORD;
    case OBJ_FACE:
    case OBJ_LINE:
    case OBJ_POINT:
        return FFD_DIFFERENCE_TOPOLOGY;
    default:
        return FFD_DIFFERENCE_OTHER;
    }
}

/* "PLACE: what" */
static void differ(comparer *c, ffd_difference_kind kind, const char *format, ...) FFD_PRINTF(3, 4);
static void differ(comparer *c, ffd_difference_kind kind, const char *format, ...)
{
    char place[192], what[256];
    va_list arguments;
    format_place(c, place, sizeof place);
    va_start(arguments, format);
    vsnprintf(what, sizeof what, format, arguments);
    va_end(arguments);
    ffd_difference_add_text(c->result, kind, "%s: %s", place, what);
}

static void differ_in_words(comparer *c, ffd_difference_kind kind, text_word a, text_word b)
{
    differ(c, kind, "\"%.*s\" and \"%.*s\"", ffd_text_display_size(a), a.first, ffd_text_display_size(b),
           b.first);
}

static bool same_text(text_word a, text_word b)
{
    const size_t size = (size_t)(a.last - a.first);
    return size == (size_t)(b.last - b.first) && (size == 0 || memcmp(a.first, b.first, size) == 0);
}

static bool same_number(text_word a, text_word b)
{
    double x, y;
    if (!ffd_obj_number(a, &x) || !ffd_obj_number(b, &y))
        return false;
    return !(x < y || x > y) && isnan(x) == isnan(y);
}

static bool same_index(obj_index a, obj_count a_count, obj_index b, obj_count b_count)
{
    size_t x, y;
    const bool a_there = ffd_obj_find(a.value, a_count, &x), b_there = ffd_obj_find(b.value, b_count, &y);
    return a_there && b_there ? x == y : same_text(a.text, b.text);
}

static bool same_corner(const comparer *c, text_word a, text_word b)
{
    obj_corner x, y;
    return ffd_obj_corner(a, &x) && ffd_obj_corner(b, &y) &&
           same_index(x.vertex, c->a.vertices, y.vertex, c->b.vertices) &&
           same_index(x.texcoord, c->a.texcoords, y.texcoord, c->b.texcoords) &&
           same_index(x.normal, c->a.normals, y.normal, c->b.normals);
}

static bool same_word(const comparer *c, text_word a, text_word b)
{
    const obj_keyword keyword = c->a.scan.keyword;
    const bool corners = keyword == OBJ_FACE || keyword == OBJ_LINE || keyword == OBJ_POINT;
    const bool names = keyword >= OBJ_GROUP;
    return same_text(a, b) || (!names && (corners ? same_corner(c, a, b) : same_number(a, b)));
}

/* The words that are left: one difference at most. */
static void compare_words(comparer *c)
{
    const ffd_difference_kind kind = kind_of(c->a.scan.keyword);
    for (;;) {
        text_word a, b;
        const bool in_a = ffd_obj_scan_word(&c->a.scan, &a), in_b = ffd_obj_scan_word(&c->b.scan, &b);
        if (!in_a && !in_b)
            return;
        if (in_a != in_b)
            differ(c, kind, "\"%.*s\" is only in the %s", ffd_text_display_size(in_a ? a : b),
                   in_a ? a.first : b.first, in_a ? "first" : "second");
        else if (!same_word(c, a, b))
            differ_in_words(c, kind, a, b);
        else
            continue;
        return;
    }
}

/* The coordinates of a `v` or `vn`, then what follows. */
static void compare_vector(comparer *c, ffd_difference_kind kind)
{
    double x[3] = {0}, y[3] = {0};
    for (int i = 0; i < 3; i++) {
        text_word a, b;
        const bool in_a = ffd_obj_scan_word(&c->a.scan, &a), in_b = ffd_obj_scan_word(&c->b.scan, &b);
        if (in_a == in_b && same_text(a, b))
            continue;
        if (!ffd_obj_number(a, &x[i]) || !ffd_obj_number(b, &y[i])) {
            differ_in_words(c, kind_of(c->a.scan.keyword), a, b);
            return;
        }
    }
    ffd_difference_vector(c->result, kind, 3, x, y, format_place, c);
    compare_words(c);
}

static void compare_arguments(comparer *c)
{
    if (c->a.scan.keyword == OBJ_VERTEX)
        compare_vector(c, FFD_DIFFERENCE_POSITION);
    else if (c->a.scan.keyword == OBJ_NORMAL)
        compare_vector(c, FFD_DIFFERENCE_NORMAL);
    else
        compare_words(c);
}

/* The statements that only one of the files has, after the end of the other. */
static void differ_in_length(comparer *c, bool in_a)
{
    obj_walk *longer = in_a ? &c->a : &c->b;
    do {
        const obj_scan *scan = &longer->scan;
        const ffd_difference_kind kind =
            scan->keyword == OBJ_VERTEX ? FFD_DIFFERENCE_TOPOLOGY : kind_of(scan->keyword);
        ffd_difference_add_text(c->result, kind, "%.*s (line %zu) is only in the %s",
                                ffd_text_display_size(scan->name), scan->name.first, scan->keyword_line,
                                in_a ? "first" : "second");
    } while (ffd_obj_walk_next(longer));
}

static void compare_statements(comparer *c)
{
    for (;;) {
        const bool in_a = ffd_obj_walk_next(&c->a), in_b = ffd_obj_walk_next(&c->b);
        if (in_a != in_b)
            differ_in_length(c, in_a);
        if (!in_a || !in_b)
            return;
        if (!same_text(c->a.scan.name, c->b.scan.name)) {
            const bool is_vertex = c->a.scan.keyword == OBJ_VERTEX || c->b.scan.keyword == OBJ_VERTEX;
            c->result->complete = false;
            differ_in_words(c, is_vertex ? FFD_DIFFERENCE_TOPOLOGY : FFD_DIFFERENCE_OTHER, c->a.scan.name,
                            c->b.scan.name);
            return;
        }
        compare_arguments(c);
        c->result->positions_compared += c->a.scan.keyword == OBJ_VERTEX;
    }
}

ffd_status ffd_obj_compare(const mesh_document *a, const mesh_document *b, ffd_comparison *comparison,
                           ffd_error *error)
{
    comparer c = {.result = comparison};
    (void)error;
    ffd_obj_document_walk(ffd_obj_of(a), &c.a);
    ffd_obj_document_walk(ffd_obj_of(b), &c.b);
    compare_statements(&c);
    return FFD_OK;
}
