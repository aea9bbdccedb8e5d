/* stl_save.c - writes an STL file with its results. */
#include "base/vector/vec.h"
#include "io/stl/stl_document.h"
#include "io/text/splice.h"
#include "io/text/vectors.h"
#include <math.h>
#include <string.h>

typedef struct stl_saver {
    const stl_document *document;
    file_splice splice;
} stl_saver;

static void corners_before(const stl_document *d, size_t facet, double corners[9])
{
    ffd_stl_read_corners(d, 3 * facet, 3, corners);
}

/* Computes the unit normal of a moved facet from its corners as written. It points to the side of the old
   normal, even if the order of the corners says otherwise. Returns false if the old normal stays: the corners
   have no normal, or the old one is zero, by which many programs mean the normal of the corners. */
static bool renew_normal(const stl_document *d, const double before[9], const double after[9],
                         const double old[3], double normal[3])
{
    double rest[3];
    if (!d->renew_normals || (old[0] == 0 && old[1] == 0 && old[2] == 0) || !ffd_stl_normal(after, normal))
        return false;
    if (ffd_stl_normal(before, rest) && vec_dot(rest, old) < 0)
        for (int a = 0; a < 3; a++)
            normal[a] = 0 - normal[a]; /* 0 stays 0 */
    return true;
}

static void write_text_facet(stl_saver *s, const stl_facet *facet, const double *before, const double *after)
{
    double old[3] = {NAN, NAN, NAN}, normal[3];
    for (int a = 0; a < 3; a++)
        (void)ffd_stl_text_normal(facet->normal[a], &old[a]);
    if (renew_normal(s->document, before, after, old, normal))
        ffd_splice_numbers(&s->splice, facet->normal, normal, ffd_vectors_changes(old, normal, 3), 3, NULL);
    ffd_splice_numbers(&s->splice, facet->corners, after, ffd_vectors_changes(before, after, 9), 9, NULL);
}

static void write_binary_facet(stl_saver *s, size_t facet, const double *before, const double *after)
{
    const char *first = (const char *)ffd_stl_facet(s->document, facet);
    unsigned char bytes[STL_ATTRIBUTE];
    double old[3], normal[3];
    memcpy(bytes, first, sizeof bytes);
    ffd_stl_load(bytes, old);
    if (renew_normal(s->document, before, after, old, normal))
        ffd_stl_store(bytes, normal, 3);
    for (size_t i = 0; i < 9; i++)
        if (memcmp(before + i, after + i, sizeof *after) != 0)
            ffd_stl_store(bytes + STL_NORMAL + 4 * i, after + i, 1);
    ffd_splice_replace(&s->splice, (text_word){first, first + sizeof bytes}, bytes, sizeof bytes);
}

static void write_facets(stl_saver *s)
{
    const stl_document *d = s->document;
    stl_text text;
    stl_facet facet;
    bool found;
    ffd_stl_text_begin(&text, d->file.input.data, d->file.input.size, NULL);
    for (size_t i = 0; s->splice.status == FFD_OK && i < d->facets; i++) {
        const double *after = d->file.new_positions + 9 * i;
        double before[9];
        corners_before(d, i, before);
        const bool moved = memcmp(before, after, sizeof before) != 0;
        if (!d->binary && (ffd_stl_text_next(&text, d->file.name, &facet, &found, NULL) || !found)) {
            s->splice.status = ffd_file_document_changed(&d->file, s->splice.error);
            return;
        }
        if (moved && d->binary)
            write_binary_facet(s, i, before, after);
        else if (moved)
            write_text_facet(s, &facet, before, after);
    }
}

ffd_status ffd_stl_save(mesh_document *document, const mesh_save_options *options, file_output *output,
                        const mesh_log *log, ffd_error *error)
{
    stl_saver s = {.document = ffd_stl_of(document)};
    (void)log;
    if (!output)
        return FFD_OK;
    ffd_splice_begin(&s.splice, &s.document->file, options, output, error);
    if (s.document->file.new_positions)
        write_facets(&s);
    return ffd_splice_end(&s.splice);
}
