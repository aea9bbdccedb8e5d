/* Two OBJ files are the same mesh when their statements are, one by one: the keyword, and each argument as
   text, as a number (1.0 and 1, NaN and NaN) or, in f, l and p, as the element it names (-1 and 8). The
   coordinates of `v` may differ by the tolerance; other numbers, normals too, may not. Comments, empty lines,
   blanks, continuations and line ends are no part of the mesh; names and mtllib are. */
#include "base/number.h"
#include "io/obj/obj_document.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

typedef struct comparer {
    obj_walk a, b;
    double tolerance;
    ffd_comparison *result;
    bool same_statements; /* so far: the walks go on together */
} comparer;

/* The place in both files: "line 4" or "lines 4 and 5". */
static void format_lines(const comparer *c, char *text, size_t capacity)
{
    const size_t a = c->a.scan.line, b = c->b.scan.line;
    if (a == b)
        snprintf(text, capacity, "line %zu", a);
    else
        snprintf(text, capacity, "lines %zu and %zu", a, b);
}

/* What is compared: "vertex 17", "normal 3", or the keyword. */
static void format_subject(const comparer *c, char *text, size_t capacity)
{
    const text_word name = c->a.scan.name;
    if (c->a.scan.keyword == OBJ_VERTEX)
        snprintf(text, capacity, "vertex %zu", c->a.vertices.seen);
    else if (c->a.scan.keyword == OBJ_NORMAL)
        snprintf(text, capacity, "normal %zu", c->a.normals.seen);
    else if (c->a.scan.keyword == OBJ_TEXCOORD)
        snprintf(text, capacity, "texcoord %zu", c->a.texcoords.seen);
    else
        snprintf(text, capacity, "%.*s", ffd_text_shown(name), name.first);
}

static void without_control_characters(char *text)
{
    for (; *text; text++)
        if ((unsigned char)*text < 0x20 || *text == 0x7f)
            *text = '?';
}

/* Keeps the first difference: "SUBJECT (LINES): what". */
static void differ(comparer *c, const char *format, ...) FFD_PRINTF(2, 3);
static void differ(comparer *c, const char *format, ...)
{
    char subject[64], lines[64], what[256];
    va_list arguments;
    if (c->result->difference[0])
        return;
    format_subject(c, subject, sizeof subject);
    format_lines(c, lines, sizeof lines);
    va_start(arguments, format);
    vsnprintf(what, sizeof what, format, arguments);
    va_end(arguments);
    snprintf(c->result->difference, sizeof c->result->difference, "%s (%s): %s", subject, lines, what);
    without_control_characters(c->result->difference);
}

static void differ_in_words(comparer *c, text_word a, text_word b)
{
    differ(c, "\"%.*s\" and \"%.*s\"", ffd_text_shown(a), a.first, ffd_text_shown(b), b.first);
    c->same_statements = false;
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

/* |a - b|; 0 also for equal infinities and two NaN, infinity for a NaN and a number. */
static double distance(double a, double b)
{
    if (isnan(a) || isnan(b))
        return isnan(a) && isnan(b) ? 0 : INFINITY;
    return a < b || a > b ? fabs(a - b) : 0;
}

static void compare_coordinate(comparer *c, int axis, text_word a, text_word b)
{
    double x, y;
    if (!ffd_obj_number(a, &x) || !ffd_obj_number(b, &y)) {
        differ_in_words(c, a, b);
        return;
    }
    const double difference = distance(x, y);
    if (difference > c->result->position_difference_max)
        c->result->position_difference_max = difference;
    if (difference <= c->tolerance)
        return;
    char text[FFD_NUMBER_CAPACITY];
    if (isfinite(difference))
        differ(c, "%c differs by %.*s", "xyz"[axis], (int)ffd_number_format(difference, text), text);
    else
        differ(c, "%c: \"%.*s\" and \"%.*s\"", "xyz"[axis], ffd_text_shown(a), a.first, ffd_text_shown(b),
               b.first);
}

static void compare_word(comparer *c, int place, text_word a, text_word b)
{
    const obj_keyword keyword = c->a.scan.keyword;
    if (same_text(a, b))
        return;
    if (keyword == OBJ_VERTEX && place < 3) {
        compare_coordinate(c, place, a, b);
        return;
    }
    const bool corners = keyword == OBJ_FACE || keyword == OBJ_LINE || keyword == OBJ_POINT;
    const bool names = keyword >= OBJ_GROUP;
    if (names || !(corners ? same_corner(c, a, b) : same_number(a, b)))
        differ_in_words(c, a, b);
}

static void compare_words(comparer *c)
{
    for (int place = 0; c->same_statements; place += place < 3) {
        text_word a, b;
        const bool in_a = ffd_obj_scan_word(&c->a.scan, &a), in_b = ffd_obj_scan_word(&c->b.scan, &b);
        if (!in_a && !in_b)
            break;
        if (in_a && in_b)
            compare_word(c, place, a, b);
        else {
            differ(c, "\"%.*s\" is only in the %s", ffd_text_shown(in_a ? a : b), in_a ? a.first : b.first,
                   in_a ? "first" : "second");
            c->same_statements = false;
        }
    }
}

/* One of the files ends: the other has statements left. */
static void differ_in_length(comparer *c, bool in_a)
{
    const obj_scan *longer = in_a ? &c->a.scan : &c->b.scan;
    if (!c->result->difference[0])
        snprintf(c->result->difference, sizeof c->result->difference, "%.*s (line %zu) is only in the %s",
                 ffd_text_shown(longer->name), longer->name.first, longer->keyword_line,
                 in_a ? "first" : "second");
    without_control_characters(c->result->difference);
    c->same_statements = false;
}

static void compare_statements(comparer *c)
{
    while (c->same_statements) {
        const bool in_a = ffd_obj_walk_next(&c->a), in_b = ffd_obj_walk_next(&c->b);
        if (!in_a && !in_b)
            break;
        if (in_a != in_b) {
            differ_in_length(c, in_a);
            break;
        }
        if (!same_text(c->a.scan.name, c->b.scan.name)) {
            differ_in_words(c, c->a.scan.name, c->b.scan.name);
            break;
        }
        compare_words(c);
        c->result->positions_compared += c->a.scan.keyword == OBJ_VERTEX && c->same_statements;
    }
}

ffd_status ffd_obj_compare(const mesh_document *a, const mesh_document *b, double tolerance,
                           ffd_comparison *comparison, ffd_error *error)
{
    comparer c = {.tolerance = tolerance, .result = comparison, .same_statements = true};
    (void)error;
    *comparison = (ffd_comparison){0};
    ffd_obj_document_walk(ffd_obj_of(a), &c.a);
    ffd_obj_document_walk(ffd_obj_of(b), &c.b);
    compare_statements(&c);
    comparison->equal = !comparison->difference[0];
    return FFD_OK;
}
