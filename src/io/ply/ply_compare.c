/* ply_compare.c - compares two PLY files.

   Two PLY files are the same mesh if their elements, properties and types are equal, in the same order, and
   their values are equal as numbers (1.0 and 1, NaN and NaN). x y z and nx ny nz of the vertices may differ
   by their tolerances, other numbers may not. The encoding (ascii, either byte order), comments, blanks and
   line ends are not compared; obj_info and the names of texture files are. */
#include "io/ply/ply_document.h"
#include "mesh/difference.h"
#include <inttypes.h>
#include <stdio.h>

typedef struct comparer {
    const ply_document *a, *b;
    ply_walk in_a, in_b;
    const ply_element *element; /* one of a */
    uint64_t row;
    ffd_comparison *result;
} comparer;

/* The headers */

static void differ_in_words(comparer *c, const char *what, text_word a, text_word b)
{
    ffd_difference_add_text(c->result, FFD_DIFFERENCE_OTHER, "%s: \"%.*s\" and \"%.*s\"", what,
                            ffd_text_display_size(a), a.first, ffd_text_display_size(b), b.first);
}

static void compare_properties(comparer *c, const ply_element *a, const ply_element *b)
{
    for (size_t i = 0; i < a->property_count && i < b->property_count; i++) {
        const ply_property *p = &a->properties[i], *q = &b->properties[i];
        const int shown = ffd_text_display_size(p->name);
        if (!ffd_text_same(p->name, q->name))
            differ_in_words(c, "properties", p->name, q->name);
        else if (p->is_list != q->is_list)
            ffd_difference_add_text(c->result, FFD_DIFFERENCE_OTHER, "property %.*s is a list only in the %s",
                                    shown, p->name.first, p->is_list ? "first" : "second");
        else if (p->type != q->type || p->count_type != q->count_type)
            ffd_difference_add_text(c->result, FFD_DIFFERENCE_OTHER, "property %.*s: types %s and %s", shown,
                                    p->name.first,
                                    ffd_ply_type_name(p->type != q->type ? p->type : p->count_type),
                                    ffd_ply_type_name(p->type != q->type ? q->type : q->count_type));
    }
    if (a->property_count != b->property_count)
        ffd_difference_add_text(c->result, FFD_DIFFERENCE_OTHER, "element %.*s has %zu and %zu properties",
                                ffd_text_display_size(a->name), a->name.first, a->property_count,
                                b->property_count);
}

/* Whether the rows of both files have the same form. */
static bool same_elements(comparer *c)
{
    const ply_header *a = &c->a->header, *b = &c->b->header;
    for (size_t i = 0; i < a->element_count && i < b->element_count; i++) {
        const ply_element *x = &a->elements[i], *y = &b->elements[i];
        if (!ffd_text_same(x->name, y->name))
            differ_in_words(c, "elements", x->name, y->name);
        else if (x->count != y->count)
            ffd_difference_add_text(c->result, FFD_DIFFERENCE_TOPOLOGY,
                                    "element %.*s has %" PRIu64 " and %" PRIu64 " rows",
                                    ffd_text_display_size(x->name), x->name.first, x->count, y->count);
        else
            compare_properties(c, x, y);
    }
    if (a->element_count != b->element_count)
        ffd_difference_add_text(c->result, FFD_DIFFERENCE_OTHER, "%zu and %zu elements", a->element_count,
                                b->element_count);
    return c->result->equal;
}

static void compare_notes(comparer *c)
{
    const ply_header *a = &c->a->header, *b = &c->b->header;
    for (size_t i = 0; i < a->note_count && i < b->note_count; i++)
        if (!ffd_text_same(a->notes[i], b->notes[i]))
            differ_in_words(c, "lines of the header", a->notes[i], b->notes[i]);
    if (a->note_count != b->note_count)
        ffd_difference_add_text(c->result, FFD_DIFFERENCE_OTHER,
                                "%zu and %zu lines of obj_info and texture files", a->note_count,
                                b->note_count);
}

/* The rows */

/* Writes "face 3 (lines 20 and 21)", with lines if both files have lines. A difference_label. */
static void format_place(const void *context, char *text, size_t capacity)
{
    const comparer *c = context;
    const text_word name = c->element->name;
    char lines[TEXT_LINES_CAPACITY] = "";
    if (c->a->header.encoding == PLY_ASCII && c->b->header.encoding == PLY_ASCII)
        ffd_text_lines(c->in_a.line, c->in_b.line, lines);
    snprintf(text, capacity, "%.*s %" PRIu64 " counted from 0%s", ffd_text_display_size(name), name.first,
             c->row, lines);
}

/* Writes a number for a message: its text, or the shortest text of a binary number. */
static void format_value(const ply_document *d, number_type type, text_word word, char *text, size_t capacity)
{
    double value = 0;
    if (d->header.encoding == PLY_ASCII)
        snprintf(text, capacity, "%.*s", ffd_text_display_size(word), word.first);
    else if (ffd_ply_load(d->header.encoding, type, word, &value)) {
        char shortest[FFD_NUMBER_CAPACITY];
        const size_t length = ffd_ply_store(PLY_ASCII, type, value, shortest);
        snprintf(text, capacity, "%.*s", (int)length, shortest);
    }
}

static bool is_texcoord(const comparer *c, const ply_property *property)
{
    if (c->element == c->a->face)
        return ffd_text_is(property->name, "texcoord");
    for (size_t i = 0; c->element == c->a->vertex && i < PLY_TEXCOORD_NAMES; i++)
        if (ffd_text_is(property->name, ffd_ply_texcoord_names[i][0]) ||
            ffd_text_is(property->name, ffd_ply_texcoord_names[i][1]))
            return true;
    return false;
}

static ffd_difference_kind kind_of(const comparer *c, const ply_property *property)
{
    const bool joins_vertices = property == c->a->face_corners || ffd_text_is(c->element->name, "edge") ||
                                ffd_text_is(c->element->name, "tristrips");
    if (is_texcoord(c, property))
        return FFD_DIFFERENCE_TEXCOORD;
    return joins_vertices ? FFD_DIFFERENCE_TOPOLOGY : FFD_DIFFERENCE_OTHER;
}

static void differ_in_values(comparer *c, const ply_property *property, number_type type, text_word a,
                             text_word b)
{
    char place[160], first[48] = "", second[48] = "";
    format_place(c, place, sizeof place);
    format_value(c->a, type, a, first, sizeof first);
    format_value(c->b, type, b, second, sizeof second);
    ffd_difference_add_text(c->result, kind_of(c, property), "%s: %.*s: %s and %s", place,
                            ffd_text_display_size(property->name), property->name.first, first, second);
}

static bool same_value(const comparer *c, number_type type, text_word a, text_word b)
{
    const ply_encoding in_a = c->a->header.encoding, in_b = c->b->header.encoding;
    double x, y;
    if (in_a == in_b && ffd_text_same(a, b))
        return true;
    return ffd_ply_load(in_a, type, a, &x) && ffd_ply_load(in_b, type, b, &y) &&
           !(ffd_difference_of(x, y) > 0);
}

/* Compares a list and moves past it in both files. Adds one difference at most. */
static void compare_list(comparer *c, const ply_property *property)
{
    text_word a, b;
    size_t count_a, count_b;
    ffd_ply_walk_list(&c->in_a, property, &a, &count_a);
    ffd_ply_walk_list(&c->in_b, property, &b, &count_b);
    bool same = count_a == count_b;
    if (!same)
        differ_in_values(c, property, property->count_type, a, b);
    for (size_t i = 0; i < count_a || i < count_b; i++) {
        const bool in_a = i < count_a && ffd_ply_walk_value(&c->in_a, property->type, &a);
        const bool in_b = i < count_b && ffd_ply_walk_value(&c->in_b, property->type, &b);
        if (!same || !in_a || !in_b || same_value(c, property->type, a, b))
            continue;
        differ_in_values(c, property, property->type, a, b);
        same = false;
    }
}

static void compare_scalar(comparer *c, const ply_property *property)
{
    text_word a, b;
    ffd_ply_walk_value(&c->in_a, property->type, &a);
    ffd_ply_walk_value(&c->in_b, property->type, &b);
    if (property->slot >= PLY_ROTATION_SLOT && !same_value(c, property->type, a, b))
        differ_in_values(c, property, property->type, a, b);
}

static void compare_vectors(comparer *c)
{
    const size_t at = 3 * (size_t)c->row;
    ffd_difference_vector(c->result, FFD_DIFFERENCE_POSITION, 3, c->a->file.positions + at,
                          c->b->file.positions + at, format_place, c);
    if (c->a->file.directions)
        ffd_difference_vector(c->result, FFD_DIFFERENCE_NORMAL, 3, c->a->file.directions + at,
                              c->b->file.directions + at, format_place, c);
    c->result->positions_compared++;
}

static void compare_row(comparer *c)
{
    ffd_ply_walk_row(&c->in_a);
    ffd_ply_walk_row(&c->in_b);
    for (size_t i = 0; i < c->element->property_count; i++) {
        const ply_property *property = &c->element->properties[i];
        if (property->is_list)
            compare_list(c, property);
        else
            compare_scalar(c, property);
    }
    if (c->element == c->a->vertex)
        compare_vectors(c);
}

static void compare_rows(comparer *c)
{
    for (size_t i = 0; i < c->a->header.element_count; i++) {
        c->element = &c->a->header.elements[i];
        if (c->element->property_count == 0)
            continue;
        ffd_ply_document_walk(c->a, c->element, &c->in_a);
        ffd_ply_document_walk(c->b, &c->b->header.elements[i], &c->in_b);
        for (c->row = 0; c->row < c->element->count; c->row++)
            compare_row(c);
    }
}

ffd_status ffd_ply_compare(const mesh_document *a, const mesh_document *b, ffd_comparison *comparison,
                           ffd_error *error)
{
    comparer c = {.a = ffd_ply_of(a), .b = ffd_ply_of(b), .result = comparison};
    (void)error;
    if (same_elements(&c)) {
        compare_notes(&c);
        compare_rows(&c);
    } else {
        comparison->complete = false;
    }
    return FFD_OK;
}
