/* obj_results.c - what a deformation changes in an OBJ file. */
#include "base/memory/memory.h"
#include "base/system/thread.h"
#include "io/obj/obj_document.h"
#include "io/text/vectors.h"
#include <string.h>

/* Vectors that a thread copies at a time. */
#define TILE ((size_t)1 << 14)

void ffd_obj_forget_vectors(const obj_document *d, size_t first, size_t count)
{
    ffd_spill_release_pages(&d->position_store, first * OBJ_VECTOR, count * OBJ_VECTOR);
    ffd_spill_release_pages(&d->result_store, first * OBJ_VECTOR, count * OBJ_VECTOR);
}

static void read_normals(const obj_document *d, size_t first, size_t count, double *xyz)
{
    for (size_t i = 0; i < count; i++)
        memcpy(xyz + 3 * i, d->file.directions + 3 * (size_t)d->pair_normal[first + i], 3 * sizeof *xyz);
}

void ffd_obj_read(const mesh_document *document, size_t part, mesh_stream stream, mesh_state state,
                  size_t first, size_t count, double *xyz)
{
    const obj_document *d = ffd_obj_of(document);
    (void)part; /* there is one */
    (void)state;
    if (stream != MESH_POSITIONS) {
        read_normals(d, first, count, xyz);
        return;
    }
    ffd_vectors_read(d->file.positions, first, count, xyz);
    ffd_obj_forget_vectors(d, first, count);
}

static void copy_tile(void *context, size_t tile, size_t first, size_t last, int worker)
{
    const obj_document *d = context;
    (void)tile;
    (void)worker;
    ffd_vectors_read(d->file.positions, first, last - first, d->file.new_positions + 3 * first);
    ffd_obj_forget_vectors(d, first, last - first);
}

static void copy_normals(void *context, size_t tile, size_t first, size_t last, int worker)
{
    const obj_document *d = context;
    (void)tile;
    (void)worker;
    read_normals(d, first, last - first, d->file.new_directions + 3 * first);
}

/* Nothing has changed so far. */
static bool clear_changes(uint8_t **changes, size_t count)
{
    if (*changes)
        memset(*changes, 0, count);
    else
        *changes = ffd_alloc_zero(count, sizeof **changes);
    return *changes;
}

static ffd_status begin_positions(obj_document *d, bool replace, ffd_error *error)
{
    if (!clear_changes(&d->position_changes, d->vertices))
        return ffd_fail_memory(error);
    if (replace) {
        d->file.new_positions = d->position_store.data;
        return FFD_OK;
    }
    if (!ffd_spill_grow(&d->result_store, d->vertices * OBJ_VECTOR))
        return ffd_fail_memory(error);
    d->file.new_positions = d->result_store.data;
    ffd_parallel_tiles(d->vertices, TILE, d->threads, copy_tile, d);
    return FFD_OK;
}

/* Whether each pair is the `vn` of the same number, so that its result can replace what was read. (Where only
   some faces are selected the others keep what was read: has_both, obj_model.c.) */
static bool results_fit(const obj_document *d)
{
    bool fit = !d->selected_faces;
    for (uint32_t i = 0; i < d->file.part.normal_count && fit; i++)
        fit = d->pair_normal[i] == i;
    return fit;
}

static ffd_status begin_normals(obj_document *d, bool replace, ffd_error *error)
{
    const size_t count = d->file.part.normal_count;
    if (!clear_changes(&d->direction_changes, count))
        return ffd_fail_memory(error);
    if (replace && results_fit(d)) {
        d->file.new_directions = d->direction_store.data;
        return FFD_OK;
    }
    if (!d->file.new_directions)
        d->file.new_directions = ffd_alloc_whole(count, 3 * sizeof *d->file.new_directions);
    if (!d->file.new_directions)
        return ffd_fail_memory(error);
    ffd_parallel_tiles(count, TILE, d->threads, copy_normals, d);
    return FFD_OK;
}

void ffd_obj_free_normals(obj_document *d)
{
    if (d->file.new_directions != d->file.directions)
        ffd_free(d->file.new_directions);
    d->file.new_directions = NULL;
}

ffd_status ffd_obj_begin_results(mesh_document *document, const mesh_results *results, ffd_error *error)
{
    obj_document *d = (obj_document *)document;
    ffd_status status;
    TRY_END(begin_positions(d, results->replace, error));
    if (results->directions && d->pair_normal)
        return begin_normals(d, results->replace, error);
end:
    ffd_obj_free_normals(d);
    return status;
}

/* Copies the vectors that are marked as changed to the results, and notes which of
   their coordinates changed. */
static void write_vectors(double *results, uint8_t *changes, size_t first, size_t count, const double *xyz,
                          const uint8_t *changed)
{
    for (size_t i = 0; i < count; i++)
        if (changed[i]) {
            double *const result = results + 3 * (first + i);
            changes[first + i] = (uint8_t)ffd_vectors_changes(result, xyz + 3 * i, 3);
            memcpy(result, xyz + 3 * i, 3 * sizeof *xyz);
        }
}

void ffd_obj_write(mesh_document *document, size_t part, mesh_stream stream, size_t first, size_t count,
                   const double *xyz, const uint8_t *changed)
{
    const obj_document *d = ffd_obj_of(document);
    (void)part;
    if (stream == MESH_POSITIONS) {
        write_vectors(d->file.new_positions, d->position_changes, first, count, xyz, changed);
        ffd_obj_forget_vectors(d, first, count);
    } else if (d->file.new_directions) { /* else normals are kept */
        write_vectors(d->file.new_directions, d->direction_changes, first, count, xyz, changed);
    }
}
