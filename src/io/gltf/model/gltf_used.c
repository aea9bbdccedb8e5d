#include "io/gltf/model/gltf_used.h"
#include "base/system/thread.h"
#include "io/gltf/model/gltf_refuse.h"
#include "io/gltf/read/gltf_restart.h"
#include <stdatomic.h>
#include <string.h>

/* Indices read at a time, and indices in a thread's tile, whose mmap pages are then released. */
#define RUN ((size_t)4096)
#define TILE (16 * RUN)

/* A primitive, and the parts of the nodes that show it. */
typedef struct drawn_primitive {
    gltf_document *document;
    const gltf_instance *instances;
    size_t nodes;
    const gltf_primitive *primitive;
    atomic_bool failed; /* set if an index is out of range */
} drawn_primitive;

/* Returns the part to mark for a node; NULL: no part, or all its vertices are marked. */
static gltf_part *part_of(const drawn_primitive *primitive, size_t node)
{
    const size_t part = primitive->instances[node].part[GLTF_POSITION];
    gltf_part *const found = part == GLTF_NONE ? NULL : &primitive->document->parts[part];
    return found && !found->is_all_used ? found : NULL;
}

static size_t vertices_of(const drawn_primitive *primitive, size_t node)
{
    return primitive->document->mesh_parts[primitive->instances[node].part[GLTF_POSITION]].vertex_count;
}

/* Marks all vertices, for a primitive without indices or with indices that cannot be read. */
static void mark_all(const drawn_primitive *primitive)
{
    for (size_t n = 0; n < primitive->nodes; n++) {
        gltf_part *const part = part_of(primitive, n);
        if (!part)
            continue;
        part->is_all_used = true;
        if (part->used)
            memset(part->used, 1, vertices_of(primitive, n));
    }
}

/* Sets the bytes of vertices. Other threads may set the same bytes at the same time. */
static void mark(uint8_t *used, const uint32_t *vertices, size_t count)
{
    for (size_t i = 0; i < count; i++)
        atomic_store_explicit((_Atomic uint8_t *)&used[vertices[i]], 1, memory_order_relaxed);
}

static void mark_run(drawn_primitive *primitive, size_t first, size_t count)
{
    uint32_t indices[RUN];
    const uint32_t largest =
        ffd_gltf_read_drawn(primitive->document, primitive->primitive, first, count, indices);
    for (size_t n = 0; n < primitive->nodes; n++) {
        const gltf_part *const part = part_of(primitive, n);
        if (part && largest >= vertices_of(primitive, n))
            atomic_store(&primitive->failed, true);
        else if (part && part->used)
            mark(part->used, indices, count);
    }
}

static void mark_tile(void *context, size_t tile, size_t first, size_t last, int worker)
{
    drawn_primitive *const primitive = context;
    (void)tile;
    (void)worker;
    for (size_t run = first; run < last && !atomic_load(&primitive->failed); run += RUN)
        mark_run(primitive, run, last - run < RUN ? last - run : RUN);
    if (!primitive->primitive->drawn)
        ffd_gltf_forget_elements(primitive->document, (size_t)primitive->primitive->indices, first,
                                 last - first);
}

static ffd_status mark_indices(drawn_primitive *primitive, ffd_error *error)
{
    gltf_document *const d = primitive->document;
    const size_t count = ffd_gltf_drawn_count(d, primitive->primitive);
    for (size_t n = 0; n < primitive->nodes; n++) {
        gltf_part *const part = part_of(primitive, n);
        const ffd_status status = part && !part->used
                                      ? ffd_used_make(&d->base, vertices_of(primitive, n), &part->used, error)
                                      : FFD_OK;
        if (status)
            return status;
    }
    ffd_parallel_tiles(count, TILE, d->threads, mark_tile, primitive);
    return FFD_OK;
}

/* Marks the vertices that a primitive draws, in the part of each node that shows it. */
static ffd_status mark_primitive(gltf_document *d, size_t m, size_t p, ffd_error *error)
{
    const gltf_primitive *const primitive = &d->model.meshes[m].primitives[p];
    drawn_primitive drawn = {.document = d,
                             .primitive = primitive,
                             .instances = ffd_gltf_instances(d, m, p),
                             .nodes = d->mesh_uses[m].node_count};
    if (drawn.nodes == 0 || primitive->accessor[GLTF_POSITION] < 0)
        return FFD_OK;
    const bool failed =
        primitive->indices < 0 || ffd_gltf_refuse_unreadable(d, m, p, primitive->indices, NULL);
    atomic_init(&drawn.failed, failed);
    if (!failed) {
        const ffd_status status = mark_indices(&drawn, error);
        if (status)
            return status;
    }
    if (atomic_load(&drawn.failed))
        mark_all(&drawn);
    return FFD_OK;
}

ffd_status ffd_gltf_mark_used(mesh_document *document, ffd_error *error)
{
    gltf_document *const d = (gltf_document *)document;
    ffd_status status = FFD_OK;
    for (size_t m = 0; m < d->model.mesh_count && !status; m++)
        for (size_t p = 0; p < d->model.meshes[m].primitive_count && !status; p++)
            status = mark_primitive(d, m, p, error);
    for (size_t i = 0; i < d->base.part_count && !status; i++)
        if (d->parts[i].used && ffd_used_keep(document, d->mesh_parts[i].vertex_count, &d->parts[i].used))
            d->mesh_parts[i].used = d->parts[i].used;
    return status;
}
