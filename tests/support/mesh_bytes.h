/* mesh_bytes.h - opens meshes of any format except glTF from bytes that are mutated at random, changes and
   saves them, also with failing memory. */
#ifndef FFD_TESTS_MESH_BYTES_H
#define FFD_TESTS_MESH_BYTES_H

#include "base/memory/memory.h"
#include "draw.h"
#include "mesh_file.h"
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static inline double as_held(const mesh_document *document, double value)
{
    return document->largest_coordinate == (double)FLT_MAX ? (double)(float)value : value;
}

static inline bool same_number(double a, double b)
{
    return a == b || (isnan(a) && isnan(b));
}

/* Checks that the saved file contains the written positions. */
static inline void assert_holds(const mesh_document *before, const file_input *saved, const double *positions)
{
    mesh_document *document = opened_bytes(before->format, saved->data, saved->size);
    assert_int_equal(document->parts->vertex_count, before->parts->vertex_count);
    for (size_t i = 0; i < document->parts->vertex_count; i++) {
        double p[3];
        document->format->read(document, 0, MESH_POSITIONS, MESH_STORED, i, 1, p);
        for (size_t a = 0; a < 3; a++)
            assert_true(same_number(p[a], as_held(before, positions[3 * i + a])));
    }
    document->format->close(document);
}

/* Moves about half of the vertices a little, and saves. */
static inline void change_and_save(mesh_document *document, draw *d)
{
    const mesh_format *format = document->format;
    const mesh_part *part = document->parts;
    double *positions = malloc((part->vertex_count + 1) * 3 * sizeof *positions);
    file_input saved;
    ffd_error error = {0};
    assert_non_null(positions);
    for (size_t i = 0; i < part->vertex_count; i++) {
        const uint8_t changed = draw_int(d, 0, 1) == 1;
        format->read(document, 0, MESH_POSITIONS, MESH_STORED, i, 1, positions + 3 * i);
        for (size_t a = 0; a < 3 && changed; a++)
            positions[3 * i + a] += draw_int(d, 0, 2) / 3.0;
        format->write(document, 0, MESH_POSITIONS, i, 1, positions + 3 * i, &changed);
    }
    for (size_t n = 0; n < part->normal_count; n++) {
        const double value[3] = {draw_int(d, 0, 1), draw_int(d, 0, 1), 0.5};
        const uint8_t changed = draw_int(d, 0, 1) == 1;
        format->write(document, 0, MESH_NORMALS, n, 1, value, &changed);
    }
    if (save_bytes(document, &saved, &error))
        fail_msg("%s", error.message);
    assert_holds(document, &saved, positions);
    ffd_file_unload(&saved);
    free(positions);
}

/* Calls the other functions of the format's table. Only PLY may report, after opening, that faces cannot be
   read or results cannot be written. Returns whether they can be written. */
static inline bool use_document(mesh_document *document)
{
    const mesh_format *format = document->format;
    const bool may_refuse = format->format == FFD_FORMAT_PLY;
    mesh_faces faces;
    ffd_comparison comparison = {.struct_size = sizeof comparison};
    byte_buffer buffer = {0};
    json_text json;
    ffd_json_begin(&json, &buffer);
    ffd_json_object(&json, NULL, true);
    assert_int_equal(format->describe(document, &json, NULL), FFD_OK);
    ffd_buffer_free(&buffer);
    const ffd_status shown = format->faces(document, MESH_STORED, &faces, NULL);
    if (shown == FFD_OK) {
        for (size_t i = 0; i < faces.start[faces.face_count]; i++)
            assert_true(faces.corners[i] < faces.vertex_count);
        ffd_mesh_faces_free(&faces);
    } else
        assert_true(may_refuse && (shown == FFD_E_INVALID || shown == FFD_E_UNSUPPORTED));
    ffd_difference_begin(&comparison, 0, 0);
    assert_int_equal(format->compare(document, document, &comparison, NULL), FFD_OK);
    assert_true(comparison.equal);
    const ffd_status begun = format->begin_results(document, &(mesh_results){.directions = true}, NULL);
    assert_true(begun == FFD_OK || (may_refuse && begun == FFD_E_UNSUPPORTED));
    return begun == FFD_OK;
}

/* Checks that a refusal has a message. Errors in an OBJ, which is a pure text format, must name a line. */
static inline void assert_refusal(const mesh_format *format, ffd_status status, const ffd_error *error)
{
    if (format->format == FFD_FORMAT_OBJ)
        assert_true(status == FFD_E_INVALID && error->line > 0);
    assert_true(status == FFD_E_INVALID || status == FFD_E_UNSUPPORTED || status == FFD_E_LIMIT);
    assert_int_equal(error->status, status);
    assert_true(error->message[0]);
}

/* Opens bytes and uses the document. One in `one_in` documents is also saved, unchanged and changed. */
static inline ffd_status use_bytes(const mesh_format *format, const void *bytes, size_t size, int one_in,
                                   draw *d)
{
    char *copy =
        malloc(size ? size : 1); /* of the exact size, so that a sanitizer detects reading past its end */
    mesh_document *document;
    ffd_error error;
    assert_non_null(copy);
    memcpy(copy, bytes, size);
    const ffd_status status = open_bytes(format, copy, size, &document, &error);
    if (status == FFD_OK) {
        if (use_document(document) && draw_int(d, 1, one_in) == 1) {
            assert_saved(document, copy, size);
            change_and_save(document, d);
        }
        format->close(document);
    } else {
        assert_refusal(format, status, &error);
        assert_null(document);
    }
    free(copy);
    return status;
}

static inline size_t mutate_bytes(draw *d, char *bytes, size_t size, size_t capacity, const char *likely)
{
    for (int count = draw_int(d, 1, 4); count > 0; count--) {
        const size_t at = size ? (size_t)draw_int(d, 0, (int)size - 1) : 0;
        const char byte =
            draw_int(d, 0, 3) ? likely[draw_int(d, 0, (int)strlen(likely) - 1)] : (char)draw_int(d, 0, 255);
        const int kind = draw_int(d, 0, 3);
        if (kind == 0 && size < capacity) {
            memmove(bytes + at + 1, bytes + at, size - at);
            bytes[at] = byte;
            size++;
        } else if (kind == 1 && size) {
            memmove(bytes + at, bytes + at + 1, size - at - 1);
            size--;
        } else if (kind == 2 && size)
            size = draw_int(d, 0, 3) ? size : at;
        else if (size)
            bytes[at] = byte;
    }
    return size;
}

typedef struct byte_seed {
    const char *bytes;
    size_t size;
} byte_seed;

#define BYTE_SEED(text)                                                                                      \
    {                                                                                                        \
        text, sizeof(text) - 1                                                                               \
    }

/* Uses valid files with random changes. likely: bytes that are meaningful in the format. */
static inline void use_mutations(const mesh_format *format, const byte_seed *seeds, size_t count, int rounds,
                                 const char *likely)
{
    draw d = {draw_seed()};
    int valid = 0, refused = 0;
    char scratch[1024];
    for (int round = 0; round < rounds; round++) {
        const byte_seed *seed = &seeds[(size_t)round % count];
        assert_true(seed->size < sizeof scratch);
        memcpy(scratch, seed->bytes, seed->size);
        const size_t size = mutate_bytes(&d, scratch, seed->size, sizeof scratch, likely);
        const bool opens = use_bytes(format, scratch, size, 10, &d) == FFD_OK;
        valid += opens;
        refused += !opens;
    }
    assert_true(valid > rounds / 12 && refused > rounds / 12);
}

static inline void use_truncations(const mesh_format *format, const byte_seed *seeds, size_t count)
{
    draw d = {draw_seed()};
    for (size_t i = 0; i < count; i++)
        for (size_t size = 0; size < seeds[i].size; size++)
            use_bytes(format, seeds[i].bytes, size, 1, &d);
}

/* Opens, describes, reads faces, and saves, unchanged and changed. */
static inline ffd_status use_all(const mesh_format *format, const byte_seed *seed)
{
    static const double moved[3] = {7, 8, 9}, turned[2][3] = {{1, 2, 3}, {4, 5, 6}};
    static const uint8_t changed = 1;
    mesh_document *document;
    mesh_faces faces = {0};
    file_input saved;
    byte_buffer buffer = {0};
    json_text json;
    ffd_error error;
    ffd_status status = open_bytes(format, seed->bytes, seed->size, &document, &error);
    if (status)
        return status;
    ffd_json_begin(&json, &buffer);
    ffd_json_object(&json, NULL, true);
    status = format->begin_results(document, &(mesh_results){.directions = true}, &error);
    if (status == FFD_OK) {
        format->write(document, 0, MESH_POSITIONS, 0, 1, moved, &changed);
        for (size_t n = 0; n < 2 && n < document->parts->normal_count; n++)
            format->write(document, 0, MESH_NORMALS, n, 1, turned[n], &changed);
        status = format->faces(document, MESH_STORED, &faces, &error);
    }
    if (status == FFD_OK)
        status = format->describe(document, &json, &error);
    if (status == FFD_OK)
        status = save_bytes(document, &saved, &error);
    if (status == FFD_OK)
        ffd_file_unload(&saved);
    ffd_buffer_free(&buffer);
    ffd_mesh_faces_free(&faces);
    format->close(document);
    return status;
}

/* Repeats this, with each allocation failing in turn. */
static inline void use_with_failing_memory(const mesh_format *format, const byte_seed *seed)
{
    long successes = 0;
    ffd_status status = FFD_E_MEMORY;
    for (; status == FFD_E_MEMORY && successes < 1000; successes++) {
        ffd_alloc_fail_after(successes);
        status = use_all(format, seed);
        ffd_alloc_fail_after(-1);
    }
    assert_int_equal(status, FFD_OK);
    assert_true(successes > 10);
}

#endif
