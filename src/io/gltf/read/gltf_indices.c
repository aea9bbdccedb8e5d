#include "io/gltf/read/gltf_indices.h"
#include "base/little_endian.h"
#include "base/memory/memory.h"
#include "base/system/thread.h"
#include "io/gltf/read/gltf_drawing.h"
#include "io/gltf/read/gltf_read.h"
#include "io/gltf/read/gltf_restart.h"

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

static ffd_status check_primitive(gltf_document *d, size_t m, size_t p, uint64_t *largest, ffd_error *error)
{
    gltf_primitive *const primitive = &d->model.meshes[m].primitives[p];
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
    if (ffd_gltf_restarts(d, primitive)) {
        uint32_t index;
        const ffd_status status = ffd_gltf_unroll(d, primitive, &index, error);
        if (status || index < vertices)
            return status;
        found = index;
    }
    return ffd_gltf_drop_drawing(
        d, m, p, ffd_gltf_primitive_value(d, m, p), error,
        "there is an index %llu, but the count of vertices is %llu: what the primitive "
        "draws is not known",
        (unsigned long long)found, (unsigned long long)vertices);
}

ffd_status ffd_gltf_check_indices(gltf_document *d, ffd_error *error)
{
    ffd_status status = FFD_OK;
    uint64_t *largest = ffd_alloc(d->model.accessor_count, sizeof *largest);
    if (!largest)
        return ffd_fail_memory(error);
    for (size_t a = 0; a < d->model.accessor_count; a++)
        largest[a] = UINT64_MAX;
    for (size_t m = 0; m < d->model.mesh_count; m++)
        for (size_t p = 0; p < d->model.meshes[m].primitive_count && status == FFD_OK; p++)
            status = check_primitive(d, m, p, largest, error);
    ffd_free(largest);
    return status;
}
