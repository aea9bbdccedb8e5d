/* stl_describe.c - what `ffd info` reports of an STL file. */
#include "base/memory/memory.h"
#include "io/stl/stl_document.h"

/* Writes a text of the file, with '?' for zero bytes. Returns false if memory ran out. */
static bool write_text(json_text *json, const char *key, text_word text)
{
    byte_buffer buffer = {0};
    for (const char *at = text.first; at < text.last; at++)
        ffd_buffer_append(&buffer, *at ? at : "?", 1);
    char *string = ffd_buffer_finish(&buffer);
    if (string)
        ffd_json_string(json, key, string);
    ffd_free(string);
    return string;
}

/* Returns the header without the blanks and zeros that pad it. */
static text_word header_text(const stl_document *d)
{
    const char *first = (const char *)d->file.input.data, *last = first + STL_HEADER;
    while (last > first && (last[-1] == 0 || last[-1] == ' '))
        last--;
    return (text_word){first, last};
}

static size_t count_degenerate(const stl_document *d)
{
    size_t count = 0;
    for (size_t i = 0; i < d->facets; i++) {
        double corners[9], normal[3];
        ffd_stl_read_corners(d, 3 * i, 3, corners);
        count += !ffd_stl_normal(corners, normal);
    }
    return count;
}

static bool describe_binary(const stl_document *d, json_text *json)
{
    const bool done = write_text(json, "header", header_text(d));
    size_t attributes = 0;
    for (size_t i = 0; i < d->facets; i++) {
        const unsigned char *facet = ffd_stl_facet(d, i);
        attributes += facet[STL_ATTRIBUTE] != 0 || facet[STL_ATTRIBUTE + 1] != 0;
    }
    ffd_json_count(json, "facets_with_attribute", attributes);
    ffd_json_count(json, "bytes_behind", d->file.input.size - STL_START - STL_FACET * d->facets);
    return done;
}

/* The maximum number of names shown: a file may have a solid every few bytes. */
#define NAMES_MAX 16

static bool describe_text(const stl_document *d, json_text *json)
{
    stl_text text;
    stl_facet facet;
    stl_event event;
    bool done = true;
    ffd_stl_text_begin(&text, d->file.input.data, d->file.input.size, NULL);
    ffd_json_array(json, "names", true);
    do {
        ffd_stl_text_step(&text, d->file.name, &facet, &event, NULL);
        if (event == STL_AT_SOLID && text.solids <= NAMES_MAX)
            done = write_text(json, NULL, text.name);
    } while (event != STL_AT_END && done);
    ffd_json_end(json, ']');
    ffd_json_count(json, "solids", text.solids);
    ffd_json_string(json, "line_endings", ffd_text_line_ends(d->file.input.data, d->file.input.size));
    return done;
}

ffd_status ffd_stl_describe(const mesh_document *document, json_text *json, ffd_error *error)
{
    const stl_document *d = ffd_stl_of(document);
    ffd_json_string(json, "encoding", d->binary ? "binary" : "ascii");
    ffd_json_count(json, "facets", d->facets);
    ffd_json_count(json, "degenerate_facets", count_degenerate(d));
    const bool done = d->binary ? describe_binary(d, json) : describe_text(d, json);
    return done ? FFD_OK : ffd_fail_memory(error);
}
