#include "base/memory.h"
#include "io/obj/obj_document.h"
#include "io/vectors.h"
#include <string.h>

void ffd_obj_read_positions(const mesh_document *document, size_t part, size_t first, size_t count,
                            double *xyz)
{
    (void)part; /* there is one */
    ffd_vectors_read(ffd_obj_of(document)->positions, first, count, xyz);
}

void ffd_obj_read_normals(const mesh_document *document, size_t part, size_t first, size_t count, double *xyz)
{
    const obj_document *d = ffd_obj_of(document);
    (void)part;
    for (size_t i = 0; i < count; i++)
        memcpy(xyz + 3 * i, d->directions + 3 * (size_t)d->pair_normal[first + i], 3 * sizeof *xyz);
}

ffd_status ffd_obj_begin_results(mesh_document *document, bool normals, bool tangents, ffd_error *error)
{
    obj_document *d = (obj_document *)document;
    (void)tangents; /* there are none */
    const ffd_status status = ffd_vectors_copy(d->positions, d->vertices, &d->new_positions, error);
    if (status)
        return status;
    if (normals && d->pair_normal && !d->new_directions) {
        d->new_directions = ffd_alloc(d->part.normal_count, 3 * sizeof *d->new_directions);
        if (!d->new_directions)
            return ffd_fail_memory(error);
        ffd_obj_read_normals(document, 0, 0, d->part.normal_count, d->new_directions);
    }
    return FFD_OK;
}

void ffd_obj_write_positions(mesh_document *document, size_t part, size_t first, size_t count,
                             const double *xyz, const uint8_t *changed)
{
    (void)part;
    ffd_vectors_write(ffd_obj_of(document)->new_positions, first, count, xyz, changed);
}

void ffd_obj_write_normals(mesh_document *document, size_t part, size_t first, size_t count,
                           const double *xyz, const uint8_t *changed)
{
    (void)part;
    ffd_vectors_write(ffd_obj_of(document)->new_directions, first, count, xyz, changed);
}
