/* off_describe.c - what `ffd info` reports of an OFF file. */
#include "io/off/off_document.h"
#include "mesh/face_sizes.h"
#include <stdio.h>

typedef struct off_facts {
    size_t coloured, coloured_faces; /* numbers of vertices and of faces with colours */
    face_sizes sizes;
} off_facts;

static size_t count_rest(off_walk *walk)
{
    text_word word;
    size_t count = 0;
    while (ffd_off_walk_rest(walk, &word))
        count++;
    return count;
}

static off_facts survey(const off_document *d)
{
    const size_t texcoord = d->header.has_texcoords ? 2 : 0;
    off_facts facts = {0};
    off_walk walk;
    off_vertex vertex;
    ffd_off_walk_begin(&d->header, &walk);
    for (size_t i = 0; i < d->header.vertices; i++) {
        ffd_off_walk_vertex(&walk, &vertex);
        facts.coloured += count_rest(&walk) > texcoord;
    }
    for (size_t i = 0; i < d->header.faces; i++) {
        const size_t corners = ffd_off_walk_face_size(&walk);
        face_sizes_count(&facts.sizes, corners);
        for (size_t c = 0; c < corners && ffd_off_walk_corner_index(&walk) != UINT32_MAX;)
            c++;
        facts.coloured_faces += count_rest(&walk) > 0;
    }
    return facts;
}

ffd_status ffd_off_describe(const mesh_document *document, json_text *json, ffd_error *error)
{
    const off_document *d = ffd_off_of(document);
    const text_word keyword = d->header.keyword;
    const off_facts facts = survey(d);
    const json_count members[] = {
        {"vertices", d->header.vertices},
        {"vertices_with_color", facts.coloured},
        {"normals", d->file.part.normal_count},
        {"texcoords", d->header.has_texcoords ? d->header.vertices : 0},
        {"faces", d->header.faces - d->lines - d->points},
        {"faces_with_color", facts.coloured_faces},
        {"triangles", facts.sizes.triangles},
        {"quads", facts.sizes.quads},
        {"ngons", facts.sizes.ngons},
        {"lines", d->lines},
        {"points", d->points},
        {"bytes_behind", (size_t)((const char *)d->file.input.data + d->file.input.size - d->behind)},
    };
    char text[16];
    (void)error;
    snprintf(text, sizeof text, "%.*s", (int)(keyword.last - keyword.first), keyword.first);
    ffd_json_string(json, "keyword", keyword.first < keyword.last ? text : NULL);
    ffd_json_counts(json, members, sizeof members / sizeof *members);
    ffd_json_string(json, "line_endings", ffd_text_line_ends(d->file.input.data, d->file.input.size));
    return FFD_OK;
}
