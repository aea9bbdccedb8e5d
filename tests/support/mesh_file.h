/* mesh_file.h - opens, describes, compares and saves meshes in memory, of any format except glTF. Their
   documents have a single part. */
#ifndef FFD_TESTS_MESH_FILE_H
#define FFD_TESTS_MESH_FILE_H

#include "base/file/input.h"
#include "base/file/output.h"
#include "base/memory/memory.h"
#include "io/formats.h"
#include "mesh/difference.h"
#include "mesh/mesh.h"
#include <stdio.h>
#include <string.h>
#include <unistd.h>

/* Opens bytes, which must outlive the document, as if they were the file "a.mesh". */
static inline ffd_status open_bytes(const mesh_format *format, const void *bytes, size_t size,
                                    mesh_document **document, ffd_error *error)
{
    file_input input = {.data = bytes, .size = size};
    const ffd_source source = {.path = "a.mesh", .format = format->format};
    *error = (ffd_error){0};
    *document = NULL;
    return ffd_format_open(format, &input, &source, document, error);
}

static inline mesh_document *opened_bytes(const mesh_format *format, const void *bytes, size_t size)
{
    mesh_document *document;
    ffd_error error;
    if (open_bytes(format, bytes, size, &document, &error))
        fail_msg("line %zu: %s, in:\n%.*s", error.line, error.message, (int)size, (const char *)bytes);
    assert_int_equal(document->part_count, 1);
    assert_true(document->parts->identity);
    assert_false(document->parts->has_tangents);
    return document;
}

/* Returns a path for saved files, unique to this process. remove_saved removes the file. */
static inline const char *saved_path(void)
{
    static char path[64];
    snprintf(path, sizeof path, "/tmp/ffd-test-mesh-%ld", (long)getpid());
    return path;
}

static inline int remove_saved(void **state)
{
    (void)state;
    remove(saved_path());
    return 0;
}

/* Saves to a file and reads it back. */
static inline ffd_status save_bytes(mesh_document *document, file_input *saved, ffd_error *error)
{
    const mesh_format *format = document->format;
    const mesh_save_options options = {.path = saved_path(), .format = format->format, .force = true};
    const mesh_log log = {0};
    file_output *output;
    ffd_status status = ffd_output_create(&output, error);
    if (status)
        return status;
    status = format->save(document, &options, output, &log, error);
    if (status == FFD_OK)
        status = ffd_output_commit(output, error);
    ffd_output_destroy(&output);
    return status == FFD_OK ? ffd_file_load(saved_path(), saved, error) : status;
}

static inline bool same_bytes(const file_input *file, const void *bytes, size_t size)
{
    return file->size == size && memcmp(file->data, bytes, size) == 0;
}

static inline void assert_saved(mesh_document *document, const void *bytes, size_t size)
{
    file_input saved;
    ffd_error error = {0};
    if (save_bytes(document, &saved, &error))
        fail_msg("%s", error.message);
    if (!same_bytes(&saved, bytes, size))
        fail_msg("saved:\n%.*s\nexpected:\n%.*s", (int)saved.size, (const char *)saved.data, (int)size,
                 (const char *)bytes);
    ffd_file_unload(&saved);
}

/* Appends all positions, as "1,2,3 4,5,6", with a bar after each `row` of them. */
static inline void append_positions(const mesh_document *document, size_t row, byte_buffer *text)
{
    for (size_t i = 0; i < document->parts->vertex_count; i++) {
        double p[3];
        document->format->read(document, 0, MESH_POSITIONS, MESH_STORED, i, 1, p);
        ffd_buffer_format(text, "%s%g,%g,%g", i == 0 ? "" : i % row == 0 ? " | " : " ", p[0], p[1], p[2]);
    }
}

typedef struct read_text {
    const char *text, *contents;
} read_text;

/* Checks texts that open, and are saved unchanged. append_contents: describes a document's content. */
static inline void assert_read(const mesh_format *format, const read_text *cases, size_t count,
                               void (*append_contents)(const mesh_document *document, byte_buffer *text))
{
    for (size_t i = 0; i < count; i++) {
        mesh_document *document = opened_bytes(format, cases[i].text, strlen(cases[i].text));
        byte_buffer buffer = {0};
        append_contents(document, &buffer);
        char *contents = ffd_buffer_finish(&buffer);
        assert_non_null(contents);
        if (strcmp(contents, cases[i].contents) != 0)
            fail_msg("case %zu: %s", i, contents);
        ffd_free(contents);
        assert_int_equal(ffd_mesh_check(document, NULL), FFD_OK);
        assert_int_equal(format->begin_results(document, &(mesh_results){.directions = true}, NULL), FFD_OK);
        assert_saved(document, cases[i].text, strlen(cases[i].text));
        format->close(document);
    }
}

typedef struct refused_text {
    const char *text;
    ffd_status status;
    size_t line;
    const char *says; /* the message, or part of it */
} refused_text;

static inline bool has_words(const char *message, const char *words)
{
    return strstr(message, words) != NULL;
}

static inline bool is_words(const char *message, const char *words)
{
    return strcmp(message, words) == 0;
}

/* Checks texts that do not open. agrees: compares the message with the expected one. */
static inline void assert_refused(const mesh_format *format, const refused_text *cases, size_t count,
                                  bool (*agrees)(const char *message, const char *says))
{
    for (size_t i = 0; i < count; i++) {
        mesh_document *document;
        ffd_error error;
        const ffd_status status = open_bytes(format, cases[i].text, strlen(cases[i].text), &document, &error);
        if (status != cases[i].status || error.line != cases[i].line || !agrees(error.message, cases[i].says))
            fail_msg("case %zu: status %d, line %zu: %s", i, status, error.line, error.message);
        assert_int_equal(error.status, status);
        assert_string_equal(error.file, "a.mesh");
        assert_null(document);
    }
}

static inline void assert_described(mesh_document *document, const char *expected)
{
    byte_buffer buffer = {0};
    json_text json;
    ffd_json_begin(&json, &buffer);
    ffd_json_object(&json, NULL, true);
    assert_int_equal(document->format->describe(document, &json, NULL), FFD_OK);
    ffd_json_end(&json, '}');
    char *text = ffd_buffer_finish(&buffer);
    assert_non_null(text);
    assert_string_equal(text, expected);
    ffd_free(text);
}

/* Compares a with b, and checks that b with a gives the same. */
static inline ffd_comparison compared(mesh_document *a, mesh_document *b, double tolerance,
                                      double direction_tolerance)
{
    ffd_comparison result, turned;
    ffd_difference_begin(&result, tolerance, direction_tolerance);
    ffd_difference_begin(&turned, tolerance, direction_tolerance);
    assert_int_equal(a->format->compare(a, b, &result, NULL), FFD_OK);
    assert_int_equal(a->format->compare(b, a, &turned, NULL), FFD_OK);
    assert_int_equal(result.equal, turned.equal);
    assert_int_equal(result.equal, result.first.text[0] == 0);
    assert_int_equal(result.equal, result.differences == 0);
    assert_int_equal(result.complete, turned.complete);
    assert_int_equal(result.differences, turned.differences);
    uint64_t sum = 0;
    for (int kind = 0; kind < FFD_DIFFERENCE_KIND_COUNT; kind++)
        sum += result.counts[kind];
    assert_int_equal(sum, result.differences);
    assert_int_equal(result.positions_compared, turned.positions_compared);
    return result;
}

#endif
