#include "io/gltf/read/gltf_drawing.h"
#include "base/little_endian.h"
#include "base/memory/memory.h"
#include "base/system/thread.h"
#include "io/gltf/read/gltf_elements.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

ffd_status ffd_gltf_drop_drawing(gltf_document *d, gltf_primitive *primitive, uint32_t value,
                                 ffd_error *error, const char *format, ...)
{
    char message[sizeof error->message];
    va_list arguments;
    va_start(arguments, format);
    ffd_status status = FFD_OK;
    if (ffd_gltf_has_extension(d, primitive->value, "KHR_draco_mesh_compression")) {
        vsnprintf(message, sizeof message, format, arguments);
        status = ffd_json_tree_fail(&d->tree, value, d->name, FFD_E_INVALID, error, "%s", message);
    } else {
        status = ffd_gltf_note_flaw(d, value, error, format, arguments);
    }
    va_end(arguments);
    d->base.unknown_drawings++;
    primitive->mode = MODE_UNKNOWN;
    primitive->indices = -1;
    return status;
}

static ffd_status read_drawing(gltf_document *d, gltf_primitive *primitive, ffd_error *error)
{
    const uint32_t value = primitive->value;
    const uint32_t mode = ffd_json_tree_member(&d->tree, value, "mode");
    double number;
    if (ffd_json_tree_number(&d->tree, ffd_json_tree_member(&d->tree, value, "indices"), &number))
        primitive->indices = (int)number;
    primitive->mode = MODE_TRIANGLES;
    if (!ffd_json_tree_number(&d->tree, mode, &number))
        return FFD_OK;
    if (number >= MODE_POINTS && number <= MODE_FAN && floor_of(number) == number) {
        primitive->mode = (int)number;
        return FFD_OK;
    }
    return ffd_gltf_drop_drawing(d, primitive, mode, error,
                                 "a mode is from 0 to 6, not %g: what the primitive draws is not known",
                                 number);
}

ffd_status ffd_gltf_read_drawings(gltf_document *d, ffd_error *error)
{
    for (size_t i = 0; i < d->model.primitive_count; i++)
        TRY(read_drawing(d, &d->model.primitives[i], error));
    return FFD_OK;
}

static bool is_declared(const gltf_document *d)
{
    const uint32_t used = ffd_json_tree_member(&d->tree, 0, "extensionsUsed");
    for (uint32_t v = ffd_json_tree_first(&d->tree, used); v != JSON_NONE;
         v = ffd_json_tree_after(&d->tree, v))
        if (ffd_json_tree_string_is(&d->tree, v, "KHR_mesh_primitive_restart"))
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

/* Whether the largest number that the type of a primitive's indices can hold begins a new strip, fan, line or
   loop. */
static bool restarts(const gltf_document *d, const gltf_primitive *primitive)
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

/* Lists what such a primitive draws, triangle by triangle or line by line, in primitive->drawn, and changes
   its mode to that. Returns the largest of the other indices in *largest. Errors: FFD_E_LIMIT,
   FFD_E_MEMORY. */
static ffd_status unroll_drawing(gltf_document *d, gltf_primitive *primitive, uint32_t *largest,
                                 ffd_error *error)
{
    const size_t count = (size_t)d->model.accessors[primitive->indices].count;
    const uint32_t restart = restart_of(d, primitive);
    *largest = 0;
    TRY(ffd_budget_check(&d->base.budget, count, sizeof(uint32_t), error));
    uint32_t *const indices = ffd_alloc(count, sizeof *indices);
    if (!indices)
        return ffd_fail_memory(error);
    ffd_gltf_read_indices(d, (size_t)primitive->indices, 0, count, indices);
    for (size_t i = 0; i < count; i++)
        *largest = indices[i] != restart && indices[i] > *largest ? indices[i] : *largest;
    const size_t corners = unroll(primitive->mode, restart, indices, count, NULL);
    ffd_status status;
    TRY_END(ffd_budget_take(&d->base.budget, corners, sizeof *primitive->drawn, error));
    primitive->drawn = ffd_alloc(corners, sizeof *primitive->drawn);
    TRY_END(primitive->drawn ? FFD_OK : ffd_fail_memory(error));
    primitive->drawn_count = unroll(primitive->mode, restart, indices, count, primitive->drawn);
    primitive->mode = primitive->mode < MODE_TRIANGLES ? MODE_LINES : MODE_TRIANGLES;
end:
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

/* Elements read at a time. */
#define BLOCK ((size_t)256)

/* The maximum number of tiles that threads share, and the minimum size of a tile in elements. */
#define TILES 64
#define SMALLEST_TILE ((size_t)1 << 16)

/* Finds the largest of contiguous indices, in loops that the compiler can vectorize. */
static uint32_t largest_packed(const unsigned char *at, size_t count, int component)
{
    uint32_t largest = 0;
    switch (component) {
    case GLTF_U8:
        for (size_t i = 0; i < count; i++)
            largest = at[i] > largest ? at[i] : largest;
        break;
    case GLTF_U16:
        for (size_t i = 0; i < count; i++) {
            const uint32_t index = at[2 * i] | (uint32_t)at[2 * i + 1] << 8;
            largest = index > largest ? index : largest;
        }
        break;
    default:
        for (size_t i = 0; i < count; i++) {
            const uint32_t index = load_u32(at + 4 * i);
            largest = index > largest ? index : largest;
        }
    }
    return largest;
}

/* A search for the largest index of an accessor, tile by tile. */
typedef struct index_search {
    const gltf_document *document;
    size_t accessor;
    bool is_packed;
    uint32_t largest[TILES]; /* per tile */
} index_search;

static uint32_t largest_read(const gltf_document *d, size_t a, size_t begin, size_t end)
{
    double values[BLOCK];
    uint32_t largest = 0;
    for (size_t first = begin; first < end; first += BLOCK) {
        const size_t size = end - first < BLOCK ? end - first : BLOCK;
        ffd_gltf_read(d, a, first, size, 1, values);
        for (size_t i = 0; i < size; i++)
            if (values[i] > largest)
                largest = (uint32_t)values[i];
    }
    return largest;
}

static void search_tile(void *context, size_t tile, size_t first, size_t last, int worker)
{
    index_search *search = context;
    const gltf_document *d = search->document;
    const gltf_layout *layout = &d->layouts[search->accessor];
    (void)worker;
    search->largest[tile] = search->is_packed
                                ? largest_packed(layout->data + first * layout->stride, last - first,
                                                 d->model.accessors[search->accessor].component)
                                : largest_read(d, search->accessor, first, last);
}

static uint32_t largest_of(const gltf_document *d, size_t a)
{
    const gltf_accessor *accessor = &d->model.accessors[a];
    const gltf_layout *layout = &d->layouts[a];
    const bool is_index =
        accessor->component == GLTF_U8 || accessor->component == GLTF_U16 || accessor->component == GLTF_U32;
    const size_t count = (size_t)accessor->count, share = count / TILES + 1;
    index_search search = {.document = d,
                           .accessor = a,
                           .is_packed = is_index && layout->data && !accessor->sparse.present &&
                                        !accessor->normalized &&
                                        layout->stride == ffd_gltf_component_size(accessor->component)};
    uint32_t largest = 0;
    ffd_parallel_tiles(count, share > SMALLEST_TILE ? share : SMALLEST_TILE, d->threads, search_tile,
                       &search);
    for (size_t t = 0; t < TILES; t++)
        largest = search.largest[t] > largest ? search.largest[t] : largest;
    return largest;
}

static ffd_status check_indices(gltf_document *d, gltf_primitive *primitive, uint64_t *largest,
                                ffd_error *error)
{
    const int position = primitive->accessor[GLTF_POSITION], indices = primitive->indices;
    if (position < 0 || indices < 0 || !d->layouts[indices].readable)
        return FFD_OK;
    /* Each accessor is searched once: many primitives can share the indices. */
    if (largest[indices] == UINT64_MAX)
        largest[indices] = largest_of(d, (size_t)indices);
    const uint64_t vertices = d->model.accessors[position].count;
    if (largest[indices] < vertices)
        return FFD_OK;
    uint64_t found = largest[indices];
    if (restarts(d, primitive)) {
        uint32_t index;
        TRY(unroll_drawing(d, primitive, &index, error));
        if (index < vertices)
            return FFD_OK;
        found = index;
    }
    return ffd_gltf_drop_drawing(
        d, primitive, primitive->value, error,
        "there is an index %llu, but the count of vertices is %llu: what the primitive "
        "draws is not known",
        (unsigned long long)found, (unsigned long long)vertices);
}

ffd_status ffd_gltf_check_indices(gltf_document *d, ffd_error *error)
{
    uint64_t *largest = ffd_alloc(d->model.accessor_count, sizeof *largest);
    if (!largest)
        return ffd_fail_memory(error);
    for (size_t a = 0; a < d->model.accessor_count; a++)
        largest[a] = UINT64_MAX;
    ffd_status status = FFD_OK;
    for (size_t i = 0; i < d->model.primitive_count; i++)
        TRY_END(check_indices(d, &d->model.primitives[i], largest, error));
end:
    ffd_free(largest);
    return status;
}
