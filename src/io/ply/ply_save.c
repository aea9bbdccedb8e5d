/* ply_save.c - writes a PLY file with its results. */
#include "io/ply/ply_save.h"
#include "base/memory/memory.h"
#include "io/ply/ply_textures.h"
#include <stdio.h>

/* Sets that a line names at most. */
#define MOST_NAMED ((size_t)8)

/* Names that programs give to normals and tangents beside nx ny nz of vertices and faces: three numbers, or a
   list. */
static const char *const triples[][3] = {{"nx", "ny", "nz"},
                                         {"normal_x", "normal_y", "normal_z"},
                                         {"tx", "ty", "tz"},
                                         {"tangent_x", "tangent_y", "tangent_z"}};
static const char *const lists[] = {"normal", "normals", "tangent", "tangents"};

static bool has_triple(const ply_element *element, const char *const names[3])
{
    bool all = true;
    for (int a = 0; a < 3; a++) {
        const ply_property *const found = ffd_ply_find_property(element, names[a]);
        all = all && found && !found->is_list;
    }
    return all;
}

/* Whether nx ny nz of an element turn, are refused, or have a line of their own. */
static bool is_known(const ply_document *d, const ply_element *element)
{
    return element == d->vertex || element == d->face;
}

static void add(byte_buffer *text, size_t *count, const ply_element *element, const char *what)
{
    if ((*count)++ < MOST_NAMED)
        ffd_buffer_format(text, "%s%s of %.*s", *count > 1 ? ", " : "", what,
                          ffd_text_display_size(element->name), element->name.first);
}

static void add_element(const ply_document *d, const ply_element *element, byte_buffer *text, size_t *count)
{
    char name[64];
    for (size_t i = 0; i < sizeof triples / sizeof *triples; i++) {
        const char *const *const names = triples[i];
        snprintf(name, sizeof name, "%s %s %s", names[0], names[1], names[2]);
        if (has_triple(element, names) && (i > 0 || !is_known(d, element)))
            add(text, count, element, name);
    }
    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++) {
        const ply_property *const found = ffd_ply_find_property(element, lists[i]);
        if (found && found->is_list)
            add(text, count, element, lists[i]);
    }
}

/* Warns of normals and tangents that stay as they are, although the shape has changed. */
static void warn_stale(const ply_document *d, const mesh_log *log)
{
    byte_buffer text = {0};
    size_t count = 0;
    for (size_t i = 0; i < d->header.element_count; i++)
        if (d->header.elements[i].count > 0)
            add_element(d, &d->header.elements[i], &text, &count);
    if (count > MOST_NAMED)
        ffd_buffer_format(&text, " and %zu more", count - MOST_NAMED);
    char *const named = count ? ffd_buffer_finish(&text) : NULL;
    if (named)
        ffd_log_line(log, FFD_LOG_WARNING, "these normals and tangents stay as they are: %s", named);
    ffd_free(named);
    if (d->has_whole_face_normals)
        ffd_log_line(log, FFD_LOG_WARNING, "nx ny nz of the faces are not all float or double: they stay");
}

/* Writes everything that changes, in the order of the file. Returns the number of splats whose harmonics stay
   because their types cannot hold the results. */
static size_t write_elements(const ply_document *d, file_splice *splice)
{
    size_t unturned = 0;
    for (size_t i = 0; i < d->header.element_count && splice->status == FFD_OK; i++) {
        const ply_element *const element = &d->header.elements[i];
        if (element == d->vertex)
            unturned = d->has_fixed_rows ? ffd_ply_write_fixed(d, splice) : ffd_ply_write_walked(d, splice);
        else if (element == d->face && d->face_normals[0] && d->renew_normals)
            ffd_ply_write_face_normals(d, splice);
    }
    return unturned;
}

ffd_status ffd_ply_save(mesh_document *document, const mesh_save_options *options, file_output *output,
                        const mesh_log *log, ffd_error *error)
{
    const ply_document *d = ffd_ply_of(document);
    file_splice splice;
    TRY(ffd_ply_bring_textures(&d->header, &document->folder, options, output, log, error));
    if (!output)
        return FFD_OK;
    ffd_splice_begin(&splice, &d->file, options, output, error);
    const size_t unturned = d->file.new_positions ? write_elements(d, &splice) : 0;
    if (unturned > 0)
        ffd_log_line(log, FFD_LOG_WARNING,
                     "%zu Gaussian splat%s spherical harmonics that are not numbers, or too large: they are "
                     "not turned",
                     unturned, unturned == 1 ? " has" : "s have");
    if (d->file.new_positions && d->renew_normals)
        warn_stale(d, log);
    return ffd_splice_end(&splice);
}
