#include "mesh/listing.h"
#include "base/memory/memory.h"
#include "mesh/bounds.h"
#include <string.h>

static void read_positions(const mesh_document *document, mesh_listing *listing)
{
    for (size_t i = 0; i < document->part_count; i++) {
        const size_t count = document->parts[i].vertex_count;
        double *const xyz = listing->xyz + 3 * listing->first[i];
        if (document->parts[i].repeats_positions)
            continue;
        document->format->read(document, i, MESH_POSITIONS, MESH_SHOWN, 0, count, xyz);
        ffd_part_transform(document, i, 0, count, xyz);
    }
}

ffd_status ffd_listing_begin(const mesh_document *document, mesh_listing *listing, ffd_error *error)
{
    memory_budget budget = document->budget;
    const uint64_t count = ffd_mesh_vertex_count(document);
    *listing = (mesh_listing){0};
    TRY(ffd_budget_take(&budget, count, 3 * sizeof *listing->xyz + sizeof *listing->seen, error));
    TRY(ffd_first_vertices(document, &listing->first, error));
    listing->xyz = ffd_alloc((size_t)count, 3 * sizeof *listing->xyz);
    listing->seen = ffd_alloc_zero((size_t)count, sizeof *listing->seen);
    if (!listing->xyz || !listing->seen)
        return ffd_fail_memory(error);
    read_positions(document, listing);
    return FFD_OK;
}

void ffd_listing_free(mesh_listing *listing)
{
    for (size_t i = 0; i < listing->count; i++)
        ffd_free(listing->things[i].name);
    ffd_free(listing->things);
    ffd_free(listing->xyz);
    ffd_free(listing->first);
    ffd_free(listing->seen);
    *listing = (mesh_listing){0};
}

ffd_status ffd_listing_add(mesh_listing *listing, selector_kind kind, const char *name, size_t size,
                           size_t index, ffd_error *error)
{
    char *const copy = size > 0 ? ffd_alloc(size + 1, 1) : NULL;
    if ((size > 0 && !copy) || !ffd_grow((void **)&listing->things, &listing->capacity, listing->count + 1,
                                         sizeof *listing->things)) {
        ffd_free(copy);
        return ffd_fail_memory(error);
    }
    if (copy) {
        memcpy(copy, name, size);
        copy[size] = 0;
    }
    listing->things[listing->count++] =
        (mesh_thing){.kind = kind, .name = copy, .index = index, .bounds = ffd_bounds_empty()};
    return FFD_OK;
}

void ffd_listing_draw(mesh_listing *listing, size_t part, const uint32_t *vertices, size_t count)
{
    mesh_thing *const thing = &listing->things[listing->count - 1];
    const uint32_t stamp = (uint32_t)listing->count;
    for (size_t i = 0; i < count; i++) {
        const size_t v = listing->first[part] + vertices[i];
        const double *const xyz = listing->xyz + 3 * v;
        if (listing->seen[v] == stamp)
            continue;
        listing->seen[v] = stamp;
        thing->vertices++;
        if (vec_is_finite(xyz))
            ffd_bounds_widen(&thing->bounds, xyz);
    }
}

void ffd_listing_draw_faces(mesh_listing *listing, size_t count)
{
    listing->things[listing->count - 1].faces += count;
}
