#include "base/memory.h"
#include "base/thread.h"
#include "io/obj/obj_document.h"
#include "io/vectors.h"
#include <string.h>

/* Vectors that a thread copies at a time. */
#define TILE ((size_t)1 << 14)

void ffd_obj_forget_vectors(const obj_document *d, size_t first, size_t count)
{
    ffd_spill_forget(&d->position_store, first * OBJ_VECTOR, count * OBJ_VECTOR);
    ffd_spill_forget(&d->result_store, first * OBJ_VECTOR, count * OBJ_VECTOR);
}

void ffd_obj_read_positions(const mesh_document *document, size_t part, size_t first, size_t count,
                            double *xyz)
{
    const obj_document *d = ffd_obj_of(document);
    (void)part; /* there is one */
    ffd_vectors_read(d->positions, first, count, xyz);
    ffd_obj_forget_vectors(d, first, count);
}

void ffd_obj_read_normals(const mesh_document *document, size_t part, size_t first, size_t count, double *xyz)
{
    const obj_document *d = ffd_obj_of(document);
    (void)part;
    for (size_t i = 0; i < count; i++)
        memcpy(xyz + 3 * i, d->directions + 3 * (size_t)d->pair_normal[first + i], 3 * sizeof *xyz);
}

static void copy_tile(void *context, size_t tile, size_t first, size_t last, int worker)
{
    const obj_document *d = context;
    (void)tile;
    (void)worker;
    ffd_vectors_read(d->positions, first, last - first, d->new_positions + 3 * first);
    ffd_obj_forget_vectors(d, first, last - first);
}

static void copy_normals(void *context, size_t tile, size_t first, size_t last, int worker)
{
    const obj_document *d = context;
    (void)tile;
    (void)worker;
    ffd_obj_read_normals(&d->base, 0, first, last - first, d->new_directions + 3 * first);
}

ffd_status ffd_obj_begin_results(mesh_document *document, bool normals, bool tangents, ffd_error *error)
{
    obj_document *d = (obj_document *)document;
    (void)tangents; /* there are none */
    if (!ffd_spill_grow(&d->result_store, d->vertices * OBJ_VECTOR))
        return ffd_fail_memory(error);
    d->new_positions = d->result_store.data;
    ffd_parallel_tiles(d->vertices, TILE, d->threads, copy_tile, d);
    if (!normals || !d->pair_normal) {
        ffd_free(d->new_directions);
        d->new_directions = NULL;
        return FFD_OK;
    }
    if (!d->new_directions)
        d->new_directions = ffd_alloc(d->part.normal_count, 3 * sizeof *d->new_directions);
    if (!d->new_directions)
        return ffd_fail_memory(error);
    ffd_expect_all(d->new_directions, d->part.normal_count, 3 * sizeof *d->new_directions);
    ffd_parallel_tiles(d->part.normal_count, TILE, d->threads, copy_normals, d);
    return FFD_OK;
}

void ffd_obj_write_positions(mesh_document *document, size_t part, size_t first, size_t count,
                             const double *xyz, const uint8_t *changed)
{
    const obj_document *d = ffd_obj_of(document);
    (void)part;
    ffd_vectors_write(d->new_positions, first, count, xyz, changed);
    ffd_obj_forget_vectors(d, first, count);
}

void ffd_obj_write_normals(mesh_document *document, size_t part, size_t first, size_t count,
                           const double *xyz, const uint8_t *changed)
{
    (void)part;
    ffd_vectors_write(ffd_obj_of(document)->new_directions, first, count, xyz, changed);
}
