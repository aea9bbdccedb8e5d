/* ply_describe.c - what `ffd info` reports of a PLY file. */
#include "base/memory/memory.h"
#include "io/ply/ply_document.h"
#include "mesh/face_sizes.h"

static face_sizes survey_faces(const ply_document *d)
{
    face_sizes sizes = {0};
    ply_walk walk;
    if (d->face)
        ffd_ply_document_walk(d, d->face, &walk);
    for (uint64_t row = 0; d->face && row < d->face->count; row++) {
        ffd_ply_walk_row(&walk);
        for (size_t i = 0; i < d->face->property_count; i++) {
            const ply_property *property = &d->face->properties[i];
            ply_walk list = walk;
            text_word word;
            size_t count;
            if (property == d->face_corners && ffd_ply_walk_list(&list, property, &word, &count))
                face_sizes_count(&sizes, count);
            ffd_ply_walk_skip(&walk, property);
        }
    }
    return sizes;
}

static bool has_colours(const ply_document *d)
{
    return ffd_ply_find_property(d->vertex, "red") && ffd_ply_find_property(d->vertex, "green") &&
           ffd_ply_find_property(d->vertex, "blue");
}

static uint64_t row_count(const ply_element *element)
{
    return element ? element->count : 0;
}

static void append_word(byte_buffer *text, text_word word)
{
    ffd_buffer_append(text, word.first, (size_t)(word.last - word.first));
}

/* Writes the collected text. Returns false if memory ran out. */
static bool write_text(json_text *json, const char *key, byte_buffer *text)
{
    char *string = ffd_buffer_finish(text);
    if (string)
        ffd_json_string(json, key, string);
    ffd_free(string);
    return string;
}

/* Writes "float x" or "list uchar int vertex_indices". */
static bool write_property(json_text *json, const ply_property *property)
{
    byte_buffer text = {0};
    if (property->is_list)
        ffd_buffer_format(&text, "list %s ", ffd_ply_type_name(property->count_type));
    ffd_buffer_format(&text, "%s ", ffd_ply_type_name(property->type));
    append_word(&text, property->name);
    return write_text(json, NULL, &text);
}

static bool write_element(json_text *json, const ply_element *element)
{
    byte_buffer name = {0};
    append_word(&name, element->name);
    ffd_json_object(json, NULL, false);
    bool done = write_text(json, "name", &name);
    ffd_json_count(json, "count", element->count);
    ffd_json_array(json, "properties", true);
    for (size_t i = 0; done && i < element->property_count; i++)
        done = write_property(json, &element->properties[i]);
    ffd_json_end(json, ']');
    ffd_json_end(json, '}');
    return done;
}

ffd_status ffd_ply_describe(const mesh_document *document, json_text *json, ffd_error *error)
{
    static const char *const encodings[] = {[PLY_ASCII] = "ascii",
                                            [PLY_LITTLE_ENDIAN] = "binary little endian",
                                            [PLY_BIG_ENDIAN] = "binary big endian"};
    const ply_document *d = ffd_ply_of(document);
    const face_sizes sizes = survey_faces(d);
    const json_count members[] = {
        {"vertices", d->vertex->count},
        {"vertices_with_color", has_colours(d) ? d->vertex->count : 0},
        {"normals", d->file.part.normal_count},
        {"faces", row_count(d->face)},
        {"triangles", sizes.triangles},
        {"quads", sizes.quads},
        {"ngons", sizes.ngons},
        {"lines", row_count(ffd_ply_find_edges(d))},
        {"triangle_strips", row_count(ffd_ply_find_element(&d->header, "tristrips"))},
        {"bytes_behind", d->file.input.size - d->behind},
    };
    bool done = true;
    ffd_json_string(json, "encoding", encodings[d->header.encoding]);
    ffd_json_string(json, "line_endings", d->header.line_end);
    ffd_json_counts(json, members, sizeof members / sizeof *members);
    ffd_mesh_describe_splats(document, json);
    ffd_json_array(json, "elements", false);
    for (size_t i = 0; done && i < d->header.element_count; i++)
        done = write_element(json, &d->header.elements[i]);
    ffd_json_end(json, ']');
    return done ? FFD_OK : ffd_fail_memory(error);
}
