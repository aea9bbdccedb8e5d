#include "base/memory.h"
#include "io/obj/obj_document.h"
#include <string.h>

static void copy_vector(double *to, const double *from)
{
    memcpy(to, from, 3 * sizeof *to);
}

void ffd_obj_read_positions(const mesh_document *document, size_t part, size_t first, size_t count,
                            double *xyz)
{
    const obj_document *d = ffd_obj_of(document);
    (void)part; /* there is one */
    for (size_t i = 0; i < count; i++)
        copy_vector(xyz + 3 * i, d->positions + 3 * (first + i));
}

void ffd_obj_read_normals(const mesh_document *document, size_t part, size_t first, size_t count, double *xyz)
{
    const obj_document *d = ffd_obj_of(document);
    (void)part;
    for (size_t i = 0; i < count; i++)
        copy_vector(xyz + 3 * i, d->directions + 3 * (size_t)d->pair_normal[first + i]);
}

ffd_status ffd_obj_begin_results(mesh_document *document, bool normals, bool tangents, ffd_error *error)
{
    obj_document *d = (obj_document *)document;
    (void)tangents; /* there are none */
    if (!d->new_positions) {
        d->new_positions = ffd_alloc(d->vertices, 3 * sizeof *d->new_positions);
        if (!d->new_positions)
            return ffd_fail_memory(error);
        ffd_obj_read_positions(document, 0, 0, d->vertices, d->new_positions);
    }
    if (normals && d->pair_normal && !d->new_directions) {
        d->new_directions = ffd_alloc(d->part.normal_count, 3 * sizeof *d->new_directions);
        if (!d->new_directions)
            return ffd_fail_memory(error);
        ffd_obj_read_normals(document, 0, 0, d->part.normal_count, d->new_directions);
    }
    return FFD_OK;
}

static void write_vectors(double *results, size_t first, size_t count, const double *xyz,
                          const uint8_t *changed)
{
    for (size_t i = 0; results && i < count; i++)
        if (changed[i])
            copy_vector(results + 3 * (first + i), xyz + 3 * i);
}

void ffd_obj_write_positions(mesh_document *document, size_t part, size_t first, size_t count,
                             const double *xyz, const uint8_t *changed)
{
    (void)part;
    write_vectors(((obj_document *)document)->new_positions, first, count, xyz, changed);
}

void ffd_obj_write_normals(mesh_document *document, size_t part, size_t first, size_t count,
                           const double *xyz, const uint8_t *changed)
{
    (void)part;
    write_vectors(((obj_document *)document)->new_directions, first, count, xyz, changed);
}
