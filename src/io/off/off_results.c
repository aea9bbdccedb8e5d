#include "base/memory.h"
#include "io/off/off_document.h"
#include <string.h>

void ffd_off_read_positions(const mesh_document *document, size_t part, size_t first, size_t count,
                            double *xyz)
{
    (void)part; /* there is one */
    memcpy(xyz, ffd_off_of(document)->positions + 3 * first, 3 * count * sizeof *xyz);
}

void ffd_off_read_normals(const mesh_document *document, size_t part, size_t first, size_t count, double *xyz)
{
    (void)part;
    memcpy(xyz, ffd_off_of(document)->directions + 3 * first, 3 * count * sizeof *xyz);
}

/* A copy of the vectors for the results, unless there is one. */
static ffd_status make_room(const double *vectors, size_t count, double **results, ffd_error *error)
{
    if (*results)
        return FFD_OK;
    *results = ffd_alloc(count, 3 * sizeof **results);
    if (!*results)
        return ffd_fail_memory(error);
    memcpy(*results, vectors, 3 * count * sizeof **results);
    return FFD_OK;
}

ffd_status ffd_off_begin_results(mesh_document *document, bool normals, bool tangents, ffd_error *error)
{
    off_document *d = (off_document *)document;
    (void)tangents; /* there are none */
    const ffd_status status = make_room(d->positions, d->header.vertices, &d->new_positions, error);
    if (status || !normals || !d->directions)
        return status;
    return make_room(d->directions, d->header.vertices, &d->new_directions, error);
}

static void write_vectors(double *results, size_t first, size_t count, const double *xyz,
                          const uint8_t *changed)
{
    for (size_t i = 0; results && i < count; i++)
        if (changed[i])
            memcpy(results + 3 * (first + i), xyz + 3 * i, 3 * sizeof *xyz);
}

void ffd_off_write_positions(mesh_document *document, size_t part, size_t first, size_t count,
                             const double *xyz, const uint8_t *changed)
{
    (void)part;
    write_vectors(ffd_off_of(document)->new_positions, first, count, xyz, changed);
}

void ffd_off_write_normals(mesh_document *document, size_t part, size_t first, size_t count,
                           const double *xyz, const uint8_t *changed)
{
    (void)part;
    write_vectors(ffd_off_of(document)->new_directions, first, count, xyz, changed);
}
