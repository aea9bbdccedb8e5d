/* Two PLY files are the same mesh when their elements, properties and types are, in their order, and their
   values as numbers (1.0 and 1, NaN and NaN). x y z of the vertices may differ by the tolerance; other
   numbers, normals too, may not. How the numbers are written (ascii, either binary order), comments, blanks
   and line ends are no part of the mesh; obj_info and the names of texture files are. */
#include "io/difference.h"
#include "io/ply/ply_document.h"
#include <inttypes.h>
#include <stdio.h>

typedef struct comparer {
    const ply_document *a, *b;
    ply_walk in_a, in_b;
    const ply_element *element; /* of a */
    uint64_t row;
    double tolerance;
    ffd_comparison *result;
    bool same_rows; /* so far: the walks go on together */
} comparer;

/* Headers */

static void differ_in_words(comparer *c, const char *what, text_word a, text_word b)
{
    ffd_difference_say(c->result, "%s: \"%.*s\" and \"%.*s\"", what, ffd_text_shown(a), a.first,
                       ffd_text_shown(b), b.first);
}

static bool same_properties(comparer *c, const ply_element *a, const ply_element *b)
{
    for (size_t i = 0; i < a->property_count && i < b->property_count; i++) {
        const ply_property *p = &a->properties[i], *q = &b->properties[i];
        const int shown = ffd_text_shown(p->name);
        if (!ffd_text_same(p->name, q->name))
            differ_in_words(c, "properties", p->name, q->name);
        else if (p->is_list != q->is_list)
            ffd_difference_say(c->result, "property %.*s is a list only in the %s", shown, p->name.first,
                               p->is_list ? "first" : "second");
        else if (p->type != q->type || p->count_type != q->count_type)
            ffd_difference_say(c->result, "property %.*s: types %s and %s", shown, p->name.first,
                               ffd_ply_type_name(p->type != q->type ? p->type : p->count_type),
                               ffd_ply_type_name(p->type != q->type ? q->type : q->count_type));
    }
    if (a->property_count != b->property_count)
        ffd_difference_say(c->result, "element %.*s has %zu and %zu properties", ffd_text_shown(a->name),
                           a->name.first, a->property_count, b->property_count);
    return !c->result->difference[0];
}

static bool same_elements(comparer *c)
{
    const ply_header *a = &c->a->header, *b = &c->b->header;
    for (size_t i = 0; i < a->element_count && i < b->element_count; i++) {
        const ply_element *x = &a->elements[i], *y = &b->elements[i];
        if (!ffd_text_same(x->name, y->name))
            differ_in_words(c, "elements", x->name, y->name);
        else if (x->count != y->count)
            ffd_difference_say(c->result, "element %.*s has %" PRIu64 " and %" PRIu64 " rows",
                               ffd_text_shown(x->name), x->name.first, x->count, y->count);
        else
            same_properties(c, x, y);
    }
    if (a->element_count != b->element_count)
        ffd_difference_say(c->result, "%zu and %zu elements", a->element_count, b->element_count);
    return !c->result->difference[0];
}

static void compare_notes(comparer *c)
{
    const ply_header *a = &c->a->header, *b = &c->b->header;
    for (size_t i = 0; i < a->note_count && i < b->note_count; i++)
        if (!ffd_text_same(a->notes[i], b->notes[i]))
            differ_in_words(c, "lines of the header", a->notes[i], b->notes[i]);
    if (a->note_count != b->note_count)
        ffd_difference_say(c->result, "%zu and %zu lines of obj_info and texture files", a->note_count,
                           b->note_count);
}

/* Rows */

/* "face 3 (lines 20 and 21)"; lines where both files have them. */
static void format_place(const comparer *c, char *text, size_t capacity)
{
    const text_word name = c->element->name;
    const size_t a = c->in_a.line, b = c->in_b.line;
    char lines[64] = "";
    if (c->a->header.encoding == PLY_ASCII && c->b->header.encoding == PLY_ASCII) {
        if (a == b)
            snprintf(lines, sizeof lines, " (line %zu)", a);
        else
            snprintf(lines, sizeof lines, " (lines %zu and %zu)", a, b);
    }
    snprintf(text, capacity, "%.*s %" PRIu64 " counted from 0%s", ffd_text_shown(name), name.first, c->row,
             lines);
}

/* A number as it may be shown: its text, or the shortest one for what its bytes stand for. */
static void format_value(const ply_document *d, ply_type type, text_word word, char *text, size_t capacity)
{
    double value = 0;
    if (d->header.encoding == PLY_ASCII)
        snprintf(text, capacity, "%.*s", ffd_text_shown(word), word.first);
    else if (ffd_ply_load(d->header.encoding, type, word, &value)) {
        char shortest[FFD_NUMBER_CAPACITY];
        const size_t length = ffd_ply_store(PLY_ASCII, type, value, shortest);
        snprintf(text, capacity, "%.*s", (int)length, shortest);
    }
}

static void differ_in_values(comparer *c, const ply_property *property, ply_type type, text_word a,
                             text_word b)
{
    char place[160], first[48] = "", second[48] = "";
    format_place(c, place, sizeof place);
    format_value(c->a, type, a, first, sizeof first);
    format_value(c->b, type, b, second, sizeof second);
    ffd_difference_say(c->result, "%s: %.*s: %s and %s", place, ffd_text_shown(property->name),
                       property->name.first, first, second);
}

static void compare_values(comparer *c, const ply_property *property, ply_type type, text_word a, text_word b)
{
    const ply_encoding in_a = c->a->header.encoding, in_b = c->b->header.encoding;
    char place[160] = "";
    double x, y;
    if (in_a == in_b && ffd_text_same(a, b))
        return;
    const bool numbers = ffd_ply_load(in_a, type, a, &x) && ffd_ply_load(in_b, type, b, &y);
    if (numbers && property->slot < PLY_NORMAL_SLOT) {
        if (ffd_difference_of(x, y) > c->tolerance)
            format_place(c, place, sizeof place);
        ffd_difference_coordinate(c->result, place, property->slot, x, y, c->tolerance);
    } else if (!numbers || ffd_difference_of(x, y) > 0) {
        differ_in_values(c, property, type, a, b);
        c->same_rows = false;
    }
}

static void compare_list(comparer *c, const ply_property *property)
{
    text_word a, b;
    size_t count_a = 0, count_b = 0;
    ffd_ply_walk_value(&c->in_a, property->count_type, &a);
    ffd_ply_walk_value(&c->in_b, property->count_type, &b);
    ffd_ply_load_count(c->a->header.encoding, property->count_type, a, &count_a);
    ffd_ply_load_count(c->b->header.encoding, property->count_type, b, &count_b);
    if (count_a != count_b) {
        differ_in_values(c, property, property->count_type, a, b);
        c->same_rows = false;
    }
    for (size_t i = 0; c->same_rows && i < count_a; i++) {
        ffd_ply_walk_value(&c->in_a, property->type, &a);
        ffd_ply_walk_value(&c->in_b, property->type, &b);
        compare_values(c, property, property->type, a, b);
    }
}

static void compare_row(comparer *c)
{
    text_word a, b;
    ffd_ply_walk_row(&c->in_a);
    ffd_ply_walk_row(&c->in_b);
    for (size_t i = 0; c->same_rows && i < c->element->property_count; i++) {
        const ply_property *property = &c->element->properties[i];
        if (property->is_list) {
            compare_list(c, property);
            continue;
        }
        ffd_ply_walk_value(&c->in_a, property->type, &a);
        ffd_ply_walk_value(&c->in_b, property->type, &b);
        compare_values(c, property, property->type, a, b);
    }
    c->result->positions_compared += c->element == c->a->vertex && c->same_rows;
}

static void compare_rows(comparer *c)
{
    ffd_ply_walk_begin(&c->a->header, &c->a->input, &c->in_a);
    ffd_ply_walk_begin(&c->b->header, &c->b->input, &c->in_b);
    for (size_t i = 0; i < c->a->header.element_count; i++) {
        c->element = &c->a->header.elements[i];
        if (c->element->property_count == 0)
            continue;
        for (c->row = 0; c->same_rows && c->row < c->element->count; c->row++)
            compare_row(c);
    }
}

ffd_status ffd_ply_compare(const mesh_document *a, const mesh_document *b, double tolerance,
                           ffd_comparison *comparison, ffd_error *error)
{
    comparer c = {.a = ffd_ply_of(a),
                  .b = ffd_ply_of(b),
                  .tolerance = tolerance,
                  .result = comparison,
                  .same_rows = true};
    (void)error;
    *comparison = (ffd_comparison){0};
    if (same_elements(&c)) {
        compare_notes(&c);
        compare_rows(&c);
    }
    comparison->equal = !comparison->difference[0];
    return FFD_OK;
}
