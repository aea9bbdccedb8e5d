/* off_results.c - takes the results of an OFF file. */
#include "base/memory/memory.h"
#include "io/off/off_document.h"
#include "io/text/vectors.h"

void ffd_off_read_positions(const mesh_document *document, size_t part, size_t first, size_t count,
                            double *xyz)
{
    (void)part; /* there is one */
    ffd_vectors_read(ffd_off_of(document)->positions, first, count, xyz);
}

void ffd_off_read_normals(const mesh_document *document, size_t part, size_t first, size_t count, double *xyz)
{
    (void)part;
    ffd_vectors_read(ffd_off_of(document)->directions, first, count, xyz);
}

ffd_status ffd_off_begin_results(mesh_document *document, bool normals, bool tangents, ffd_error *error)
{
    off_document *d = (off_document *)document;
    (void)tangents; /* there are none */
    const ffd_status status = ffd_vectors_copy(d->positions, d->header.vertices, &d->new_positions, error);
    if (status || !normals || !d->directions) {
        ffd_free(d->new_directions);
        d->new_directions = NULL;
        return status;
    }
    return ffd_vectors_copy(d->directions, d->header.vertices, &d->new_directions, error);
}

void ffd_off_write_positions(mesh_document *document, size_t part, size_t first, size_t count,
                             const double *xyz, const uint8_t *changed)
{
    (void)part;
    ffd_vectors_write(ffd_off_of(document)->new_positions, first, count, xyz, changed);
}

void ffd_off_write_normals(mesh_document *document, size_t part, size_t first, size_t count,
                           const double *xyz, const uint8_t *changed)
{
    (void)part;
    ffd_vectors_write(ffd_off_of(document)->new_directions, first, count, xyz, changed);
}
