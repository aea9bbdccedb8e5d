/* obj_check.h - sets normals of an OBJ document, saves it, and checks the file with an independent reader:
   each corner has its normal, everything else is unchanged, and no more `vn` than necessary were added. */
#ifndef FFD_TESTS_OBJ_CHECK_H
#define FFD_TESTS_OBJ_CHECK_H

#include "base/memory/memory.h"
#include "draw.h"
#include "io/obj/obj_document.h"
#include "io/obj/obj_format.h"
#include "mesh_file.h"
#include "obj_reader.h"

static const mesh_format *const obj = &ffd_obj_format;

/* Draws new values for the document's pairs, 3 a pair: unchanged, one of a few shared values, or a unique
   one. */
static inline double *draw_normals(mesh_document *document, draw *d)
{
    const size_t count = document->parts->normal_count;
    double *values = malloc((count + 1) * 3 * sizeof *values);
    assert_non_null(values);
    obj->read(document, 0, MESH_NORMALS, MESH_STORED, 0, count, values);
    const int kinds = draw_int(d, 0, 3);
    for (size_t i = 0; i < count; i++) {
        const int kind = draw_int(d, 0, kinds);
        if (kind == 0)
            continue;
        values[3 * i] = kind == 3 ? draw_unit(d) : 0.25 * draw_int(d, 0, 2);
        values[3 * i + 1] = draw_int(d, 0, 1);
    }
    return values;
}

/* Returns the value that a corner must have after the change. A normal of -1 (no pair) does not occur
   here. */
static inline const double *wanted_normal(const obj_document *document, const double *values,
                                          plain_corner corner)
{
    for (size_t p = document->pair_start[corner.vertex]; p < document->pair_start[corner.vertex + 1]; p++)
        if (document->pair_normal[p] == (uint32_t)corner.normal)
            return values + 3 * p;
    fail_msg("vertex %zu has no normal %ld", corner.vertex, corner.normal);
    return NULL;
}

static inline bool same_bits(const double *a, const double *b)
{
    return memcmp(a, b, 3 * sizeof *a) == 0;
}

/* Returns how many `vn` must be added: for each `vn` its distinct values minus one. */
static inline size_t needed_additions(const obj_document *document, const double *values)
{
    const size_t pairs = document->file.part.normal_count;
    size_t needed = 0;
    unsigned char *used = calloc(document->normals + 1, 1);
    assert_non_null(used);
    for (size_t p = 0; p < pairs; p++) {
        bool is_new = true;
        for (size_t q = 0; q < p && is_new && used[document->pair_normal[p]]; q++)
            is_new = document->pair_normal[q] != document->pair_normal[p] ||
                     !same_bits(values + 3 * q, values + 3 * p);
        needed += is_new && used[document->pair_normal[p]];
        used[document->pair_normal[p]] = 1;
    }
    free(used);
    return needed;
}

/* Equal texts, except for an empty line that may have been added to end a continuation. */
static inline void check_text(char *a, char *b)
{
    for (size_t size = strlen(a); size && a[size - 1] == '\n'; size--)
        a[size - 1] = 0;
    for (size_t size = strlen(b); size && b[size - 1] == '\n'; size--)
        b[size - 1] = 0;
    assert_string_equal(a, b);
}

/* The text of a face is unchanged unless one of its corners has a different normal now. */
static inline void check_face(const plain_obj *a, const plain_statement *x, const plain_obj *b,
                              const plain_statement *y, const obj_document *document, const double *values)
{
    bool renumbered = false;
    assert_int_equal(x->corners, y->corners);
    for (size_t i = 0; i < x->corners; i++) {
        const plain_corner old = a->corners[x->first_corner + i], new = b->corners[y->first_corner + i];
        assert_int_equal(old.vertex, new.vertex);
        if (old.normal < 0 || a->normal_count == 0) { /* indices without any vn: unchanged */
            assert_int_equal(old.normal, new.normal);
            continue;
        }
        assert_true((size_t) new.normal < b->normal_count);
        assert_true(same_bits(b->normals[new.normal], wanted_normal(document, values, old)));
        renumbered = renumbered || old.normal != new.normal;
    }
    if (!renumbered)
        check_text(x->text, y->text);
}

/* Compares the statements of both files. Statements that only the second one has must be `vn`, or an empty
   line that ends a continuation before them. Returns the number of such `vn`. */
static inline size_t check_statements(const plain_obj *a, const plain_obj *b, const obj_document *document,
                                      const double *values)
{
    size_t i = 0, additions = 0, normals = 0;
    for (size_t j = 0; j < b->statement_count; j++) {
        const plain_statement *y = &b->statements[j], *x = i < a->statement_count ? &a->statements[i] : NULL;
        const bool is_normal = strcmp(y->keyword, "vn") == 0;
        const bool extra = b->normal_count > a->normal_count && normals >= a->normal_count &&
                           additions < b->normal_count - a->normal_count;
        normals += is_normal;
        if (extra && is_normal) {
            additions++;
            continue;
        }
        if (!x || strcmp(x->keyword, y->keyword) != 0) {
            assert_string_equal(y->text, "");
            continue;
        }
        if (strcmp(y->keyword, "f") == 0)
            check_face(a, x, b, y, document, values);
        else if (!is_normal)
            check_text(x->text, y->text);
        i++;
    }
    assert_int_equal(i, a->statement_count);
    return additions;
}

static inline void check_new_normals(mesh_document *document, draw *d, bool count_additions)
{
    const obj_document *o = ffd_obj_of(document);
    double *values = draw_normals(document, d);
    unsigned char *changed = malloc(document->parts->normal_count + 1);
    file_input saved;
    ffd_error error = {0};
    assert_non_null(changed);
    memset(changed, 1, document->parts->normal_count + 1);
    const mesh_results results = {.directions = true, .replace = draw_int(d, 0, 1) == 1};
    assert_int_equal(obj->begin_results(document, &results, NULL), FFD_OK);
    obj->write(document, 0, MESH_NORMALS, 0, document->parts->normal_count, values, changed);
    if (save_bytes(document, &saved, &error) != FFD_OK)
        fail_msg("%s", error.message);
    plain_obj a = plain_read(o->file.input.data, o->file.input.size), b = plain_read(saved.data, saved.size);
    assert_int_equal(a.vertex_count, b.vertex_count);
    assert_int_equal(a.corner_count, b.corner_count);
    assert_true(b.normal_count >= a.normal_count);
    const size_t additions = check_statements(&a, &b, o, values);
    assert_int_equal(additions, b.normal_count - a.normal_count);
    if (count_additions)
        assert_int_equal(additions, needed_additions(o, values));
    plain_free(&a);
    plain_free(&b);
    ffd_file_unload(&saved);
    free(changed);
    free(values);
}

#endif
