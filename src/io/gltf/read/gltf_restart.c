#include "io/gltf/read/gltf_restart.h"
#include "base/memory/memory.h"
#include "io/gltf/read/gltf_read.h"
#include <string.h>

static bool is_declared(const gltf_document *d)
{
    const uint32_t used = ffd_json_span_member(&d->tree, 0, "extensionsUsed");
    for (uint32_t v = ffd_json_span_first(&d->tree, used); v != JSON_NONE;
         v = ffd_json_span_after(&d->tree, v))
        if (ffd_json_span_string_is(&d->tree, v, "KHR_mesh_primitive_restart"))
            return true;
    return false;
}

static uint32_t restart_of(const gltf_document *d, const gltf_primitive *primitive)
{
    switch (d->model.accessors[primitive->indices].component) {
    case GLTF_U8:
        return UINT8_MAX;
    case GLTF_U16:
        return UINT16_MAX;
    default:
        return UINT32_MAX;
    }
}

bool ffd_gltf_restarts(const gltf_document *d, const gltf_primitive *primitive)
{
    return primitive->indices >= 0 && primitive->mode != MODE_POINTS && primitive->mode != MODE_LINES &&
           primitive->mode != MODE_TRIANGLES && primitive->mode != MODE_UNKNOWN && is_declared(d);
}

/* Writes the lines of a strip or loop. Returns their corners; to NULL: only counts them. */
static size_t unroll_lines(int mode, const uint32_t *run, size_t count, uint32_t *to)
{
    const size_t lines = count < 2 ? 0 : mode == MODE_LINE_LOOP ? count : count - 1;
    for (size_t i = 0; i < lines && to; i++) {
        to[2 * i] = run[i];
        to[2 * i + 1] = run[i + 1 < count ? i + 1 : 0];
    }
    return 2 * lines;
}

/* The same for the triangles of a strip or fan. */
static size_t unroll_triangles(int mode, const uint32_t *run, size_t count, uint32_t *to)
{
    const size_t triangles = count < 3 ? 0 : count - 2;
    for (size_t t = 0; t < triangles && to; t++)
        gltf_triangle(mode, t, run, to + 3 * t);
    return 3 * triangles;
}

/* Unrolls all runs between restarts. Returns the number of corners; to NULL: only counts them. */
static size_t unroll(int mode, uint32_t restart, const uint32_t *indices, size_t count, uint32_t *to)
{
    size_t corners = 0;
    for (size_t begin = 0, end; begin < count; begin = end + 1) {
        for (end = begin; end < count && indices[end] != restart;)
            end++;
        uint32_t *const at = to ? to + corners : NULL;
        corners += mode == MODE_LINE_LOOP || mode == MODE_LINE_STRIP
                       ? unroll_lines(mode, indices + begin, end - begin, at)
                       : unroll_triangles(mode, indices + begin, end - begin, at);
    }
    return corners;
}

ffd_status ffd_gltf_unroll(gltf_document *d, gltf_primitive *primitive, uint32_t *largest, ffd_error *error)
{
    const size_t count = (size_t)d->model.accessors[primitive->indices].count;
    const uint32_t restart = restart_of(d, primitive);
    ffd_status status = ffd_budget_check(&d->base.budget, count, sizeof(uint32_t), error);
    uint32_t *const indices = status ? NULL : ffd_alloc(count, sizeof *indices);
    *largest = 0;
    if (status || !indices)
        return status ? status : ffd_fail_memory(error);
    ffd_gltf_read_indices(d, (size_t)primitive->indices, 0, count, indices);
    for (size_t i = 0; i < count; i++)
        *largest = indices[i] != restart && indices[i] > *largest ? indices[i] : *largest;
    const size_t corners = unroll(primitive->mode, restart, indices, count, NULL);
    status = ffd_budget_take(&d->base.budget, corners, sizeof *primitive->drawn, error);
    if (!status) {
        primitive->drawn = ffd_alloc(corners, sizeof *primitive->drawn);
        status = primitive->drawn ? FFD_OK : ffd_fail_memory(error);
    }
    if (!status) {
        primitive->drawn_count = unroll(primitive->mode, restart, indices, count, primitive->drawn);
        primitive->mode = primitive->mode < MODE_TRIANGLES ? MODE_LINES : MODE_TRIANGLES;
    }
    ffd_free(indices);
    return status;
}

size_t ffd_gltf_drawn_count(const gltf_document *d, const gltf_primitive *primitive)
{
    return primitive->drawn ? primitive->drawn_count : (size_t)d->model.accessors[primitive->indices].count;
}

uint32_t ffd_gltf_read_drawn(const gltf_document *d, const gltf_primitive *primitive, size_t first,
                             size_t count, uint32_t *vertices)
{
    uint32_t largest = 0;
    if (!primitive->drawn)
        return ffd_gltf_read_indices(d, (size_t)primitive->indices, first, count, vertices);
    for (size_t i = 0; i < count; i++) {
        vertices[i] = primitive->drawn[first + i];
        largest = vertices[i] > largest ? vertices[i] : largest;
    }
    return largest;
}
