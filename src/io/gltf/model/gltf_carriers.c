/* gltf_carriers.c - the nodes that carry vertices: which of them move with a piece, and which ones animations
   turn. */
#include "base/memory/memory.h"
#include "io/gltf/model/gltf_animation.h"
#include "io/gltf/model/gltf_functions.h"
#include "io/gltf/model/gltf_joints.h"
#include <string.h>

/* Fills the node that carries each vertex of a part, or MESH_NONE. In mesh space that is the first node with
   the mesh. */
static ffd_status list_carriers(const gltf_document *d, size_t p, uint32_t *carriers, bool *blends,
                                ffd_error *error)
{
    const gltf_part *const part = &d->parts[p];
    const gltf_mesh_uses *const uses = &d->mesh_uses[part->primitive->mesh];
    const size_t node = part->node != GLTF_NONE ? part->node : uses->nodes ? uses->nodes[0] : GLTF_NONE;
    if (part->skin)
        return ffd_gltf_leading_joints(d, p, carriers, blends, error);
    for (size_t v = 0; v < d->mesh_parts[p].vertex_count; v++)
        carriers[v] = node == GLTF_NONE ? MESH_NONE : (uint32_t)node;
    return FFD_OK;
}

/* The same for all vertices of the document. *carriers is freed by the caller. blends: as in
   ffd_gltf_leading_joints. */
static ffd_status list_all(const gltf_document *d, uint32_t **carriers, bool *blends, ffd_error *error)
{
    size_t first = 0;
    *carriers = ffd_alloc((size_t)ffd_mesh_vertex_count(&d->base), sizeof **carriers);
    if (!*carriers)
        return ffd_fail_memory(error);
    for (size_t p = 0; p < d->base.part_count; p++) {
        if (d->mesh_parts[p].repeats_positions)
            continue;
        TRY(list_carriers(d, p, *carriers + first, blends, error));
        first += d->mesh_parts[p].vertex_count;
    }
    return FFD_OK;
}

/* What the vertices of a node are of: a piece, or one of these. */
#define OF_NONE MESH_NONE          /* there are no vertices */
#define OF_SEVERAL (MESH_NONE - 1) /* of several pieces, or some of none */

/* Adds what vertices are of. Returns whether that changes something. */
static bool add_piece(uint32_t piece, uint32_t *of)
{
    const uint32_t before = *of;
    *of = before == OF_NONE || before == piece ? piece : OF_SEVERAL;
    return *of != before;
}

/* Adds the pieces of vertices to the nodes that carry them. */
static void add_own(const gltf_document *d, const uint32_t *pieces, const uint32_t *carriers, uint32_t *own)
{
    size_t vertex = 0;
    for (size_t p = 0; p < d->base.part_count; p++) {
        const mesh_part *const part = &d->mesh_parts[p];
        for (size_t v = 0; v < part->vertex_count && !part->repeats_positions; v++, vertex++)
            if (carriers[vertex] != MESH_NONE && ffd_part_selects(part, v))
                add_piece(pieces[vertex] == MESH_NONE ? OF_SEVERAL : pieces[vertex], &own[carriers[vertex]]);
    }
}

/* Adds what nodes carry to all nodes above them: each changes twice at most. */
static void add_below(const gltf_document *d, const uint32_t *own, uint32_t *below)
{
    for (size_t n = 0; n < d->model.node_count; n++) {
        size_t at = own[n] == OF_NONE ? GLTF_NONE : n;
        while (at != GLTF_NONE && add_piece(own[n], &below[at]))
            at = d->parents[at];
    }
}

/* Stands for a node that has no value, and none above it. */
#define OF_NOBODY (MESH_NONE - 2)

/* Fills for each node the value of the nearest node, itself or above it, that has one. Parents may form a
   circle (MSFT_lod). */
static void inherit(const gltf_document *d, uint32_t *values)
{
    for (size_t n = 0; n < d->model.node_count; n++) {
        size_t steps = 0, at = n;
        while (at != GLTF_NONE && values[at] == MESH_NONE && steps++ < d->model.node_count)
            at = d->parents[at];
        const bool is_found = at != GLTF_NONE && values[at] != MESH_NONE;
        const uint32_t found = is_found ? values[at] : OF_NOBODY;
        for (at = n; at != GLTF_NONE && values[at] == MESH_NONE; at = d->parents[at])
            values[at] = found;
    }
    for (size_t n = 0; n < d->model.node_count; n++)
        values[n] = values[n] == OF_NOBODY ? MESH_NONE : values[n];
}

ffd_status ffd_gltf_place_pieces(const mesh_document *document, const mesh_places *places,
                                 const uint32_t *pieces, uint32_t *of_places, ffd_error *error)
{
    const gltf_document *const d = ffd_gltf_of(document);
    const size_t count = d->model.node_count;
    uint32_t *const own = ffd_alloc(count, sizeof *own), *const below = ffd_alloc(count, sizeof *below);
    uint32_t *carriers = NULL;
    ffd_status status;
    TRY_END(own && below ? FFD_OK : ffd_fail_memory(error));
    TRY_END(list_all(d, &carriers, NULL, error));
    for (size_t n = 0; n < count; n++)
        own[n] = below[n] = OF_NONE;
    add_own(d, pieces, carriers, own);
    add_below(d, own, below);
    for (size_t n = 0; n < count; n++)
        own[n] = own[n] == OF_NONE ? below[n] : own[n];
    inherit(d, own);
    for (size_t i = 0; i < places->count; i++) {
        const uint32_t piece = own[places->list[i].index];
        of_places[i] = piece == OF_SEVERAL ? MESH_NONE : piece;
    }
end:
    ffd_free(own);
    ffd_free(below);
    ffd_free(carriers);
    return status;
}

/* Whether the keys of a sampler are not all alike. */
static bool changes(const gltf_animation_sampler *sampler)
{
    const bool is_cubic = sampler->interpolation == GLTF_CUBICSPLINE;
    const size_t step = sampler->width * (is_cubic ? 3 : 1), value = is_cubic ? sampler->width : 0;
    for (size_t k = 1; k < sampler->key_count; k++)
        if (memcmp(sampler->values + step * k + value, sampler->values + value,
                   sampler->width * sizeof *sampler->values) != 0)
            return true;
    return false;
}

/* Marks the nodes that an animation turns with their own numbers. Returns whether there are any. */
static bool mark_turned(gltf_document *d, gltf_animation *animation, uint32_t *turned)
{
    bool any = false, drives = false;
    for (size_t c = 0; c < animation->channel_count; c++)
        drives = drives || animation->channels[c].path == GLTF_ROTATION;
    if (!drives || ffd_gltf_load_animation(d, animation, NULL))
        return false;
    for (size_t c = 0; c < animation->channel_count; c++) {
        const gltf_channel *const channel = &animation->channels[c];
        if (channel->path != GLTF_ROTATION || channel->sampler == GLTF_NONE ||
            !changes(&animation->samplers[channel->sampler]))
            continue;
        turned[channel->node] = (uint32_t)channel->node;
        any = true;
    }
    ffd_gltf_unload_animation(d, animation);
    return any;
}

ffd_status ffd_gltf_find_turned(mesh_document *document, uint32_t **nodes, ffd_error *error)
{
    gltf_document *const d = (gltf_document *)document;
    gltf_animations animations = {0};
    uint32_t *const turned = ffd_alloc(d->model.node_count, sizeof *turned);
    bool *const blends = ffd_alloc_zero(d->model.node_count, sizeof *blends);
    bool any = false;
    ffd_status status = FFD_OK;
    *nodes = NULL;
    TRY_END(turned && blends ? FFD_OK : ffd_fail_memory(error));
    for (size_t n = 0; n < d->model.node_count; n++)
        turned[n] = MESH_NONE;
    TRY_END(ffd_gltf_list_animations(d, &animations, error));
    for (size_t a = 0; a < animations.count; a++)
        any = mark_turned(d, &animations.list[a], turned) || any;
    if (!any)
        goto end;
    inherit(d, turned);
    TRY_END(list_all(d, nodes, blends, error));
    const size_t count = (size_t)ffd_mesh_vertex_count(document);
    for (size_t v = 0; v < count; v++) {
        const uint32_t carrier = (*nodes)[v];
        (*nodes)[v] = carrier == MESH_NONE || blends[carrier] ? MESH_NONE : turned[carrier];
    }
end:
    ffd_gltf_free_animations(d, &animations);
    ffd_free(turned);
    ffd_free(blends);
    return status;
}
