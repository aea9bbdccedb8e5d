#include "job/arrays/chain_embedding.h"
#include "base/memory/memory.h"
#include "base/struct_size.h"
#include "base/text/number.h"
#include "embed/locator.h"
#include "embed/locator_border.h"
#include "job/chain/chain_boxes.h"
#include "job/chain/point_outcome.h"
#include "lattice/rest_hash.h"
#include "points/span.h"
#include <ffd/result.h>
#include <math.h>
#include <string.h>

void ffd_chain_desc_init(ffd_chain_desc *desc, size_t size)
{
    const ffd_chain_desc defaults = {.struct_size = sizeof defaults};
    ffd_struct_give(&defaults, sizeof defaults, desc, size);
}

/* Checks an embedding whose u,v,w are taken over. */
static ffd_status check_start(const ffd_chain_desc *desc, ffd_error *error)
{
    const lattice_chain *const chain = &desc->start->chain;
    const chain_outside *const outside = &chain->outside;
    bool same = desc->start->count == desc->points.count && chain->count == desc->count &&
                (desc->start->owners != NULL) == desc->blocks &&
                desc->start->is_float == (desc->points.type == FFD_FLOAT32) &&
                outside->extend == (desc->outside == FFD_OUTSIDE_EXTEND) &&
                outside->falloff == desc->falloff && outside->snap == desc->snap;
    for (size_t l = 0; same && l < desc->count; l++)
        same = ffd_rest_equal(desc->lattices[l], chain->links[l].lattice);
    return same ? FFD_OK
                : ffd_fail(error, FFD_E_INVALID,
                           "the embedding to start from is of other points, settings or lattices");
}

static ffd_status check(ffd_chain_desc *desc, ffd_error *error)
{
    if (!desc->lattices || desc->count == 0)
        return ffd_fail(error, FFD_E_ARGUMENT, "no lattice is given");
    if (desc->count > FFD_LATTICES_MOST)
        return ffd_fail(error, FFD_E_LIMIT, "there are at most %d lattices, not %zu", FFD_LATTICES_MOST,
                        desc->count);
    for (size_t l = 0; l < desc->count; l++) {
        ffd_embedding_desc one;
        ffd_embedding_desc_init(&one, sizeof one);
        one.lattice = desc->lattices[l];
        one.points = desc->points;
        one.outside = desc->outside;
        one.falloff = desc->falloff;
        one.snap = desc->snap;
        TRY(ffd_embedding_desc_check(&one, error));
        desc->points = l + 1 == desc->count ? one.points : desc->points;
    }
    return desc->start ? check_start(desc, error) : FFD_OK;
}

static ffd_status make_link(const ffd_chain_desc *desc, const ffd_lattice *lattice, ffd_isa isa,
                            chain_link *link, ffd_error *error)
{
    TRY(ffd_lattice_copy(lattice, &link->lattice, error));
    TRY(ffd_locator_create_for(link->lattice, isa, &link->locator, error));
    link->snap = desc->snap;
    if (desc->outside != FFD_OUTSIDE_EXTEND)
        return FFD_OK;
    link->falloff = desc->falloff;
    return ffd_locator_border(link->locator, &link->border, error);
}

static ffd_status make_chain(const ffd_chain_desc *desc, ffd_isa isa, lattice_chain *chain, ffd_error *error)
{
    *chain = (lattice_chain){.isa = isa,
                             .blocks = desc->blocks && desc->count > 1,
                             .outside = {.extend = desc->outside == FFD_OUTSIDE_EXTEND,
                                         .falloff = desc->falloff,
                                         .snap = desc->snap}};
    chain->links = ffd_alloc_zero(desc->count, sizeof *chain->links);
    if (!chain->links)
        return ffd_fail_memory(error);
    chain->count = desc->count;
    for (size_t l = 0; l < desc->count; l++)
        TRY(make_link(desc, desc->lattices[l], isa, &chain->links[l], error));
    return chain->blocks ? ffd_chain_boxes(chain, error) : FFD_OK;
}

/* Allocates the arrays of all points. */
static ffd_status make_arrays(bool has_owners, ffd_chain_embedding *embedding, ffd_error *error)
{
    const size_t count = embedding->count;
    bool whole = true;
    embedding->layers = ffd_chain_layers(&embedding->chain);
    embedding->places = ffd_alloc_zero(embedding->chain.count, sizeof *embedding->places);
    embedding->status = ffd_alloc(count, sizeof *embedding->status);
    embedding->owners = has_owners ? ffd_alloc(count, sizeof *embedding->owners) : NULL;
    if (!embedding->places || !embedding->status || (has_owners && !embedding->owners))
        return ffd_fail_memory(error);
    for (size_t layer = 0; layer < embedding->layers; layer++) {
        ffd_embedding *const places = &embedding->places[layer];
        places->uvw = ffd_alloc_whole(count, 3 * sizeof *places->uvw);
        places->status = ffd_alloc(count, sizeof *places->status);
        whole = whole && places->uvw && places->status;
    }
    for (size_t l = 0; l < embedding->chain.count; l++) {
        embedding->places[l].rest = embedding->chain.links[l].lattice;
        embedding->places[l].count = count;
        embedding->places[l].falloff = embedding->chain.outside.falloff;
    }
    return whole ? FFD_OK : ffd_fail_memory(error);
}

/* The extended points of a tile in a layer, until the lists are joined. */
typedef struct extended_list {
    extended_point *points;
    size_t count, capacity;
} extended_list;

/* The state of a call of ffd_chain_embedding_create. */
typedef struct embed_work {
    const ffd_chain_desc *desc;
    ffd_chain_embedding *embedding;
    chain_room *rooms;      /* one for each thread */
    extended_list *outside; /* of tile t in a layer: at t layers + layer */
    size_t tiles;
} embed_work;

/* Returns the block that moves point i of a tile: that holds it, or whose border it follows. */
static uint32_t owner_of(const ffd_chain_embedding *embedding, const chain_room *room, size_t i, bool placed,
                         bool extended)
{
    if (!placed && !extended)
        return BLOCK_NONE;
    return !ffd_has_owners(embedding) ? 0 : placed ? room->chain.owners[i] : room->borders[i].block;
}

/* Keeps where a layer has the points of a tile. */
static ffd_status keep_layer(const embed_work *work, size_t layer, const chain_points *points,
                             const chain_room *room, ffd_error *error)
{
    ffd_chain_embedding *const embedding = work->embedding;
    const ffd_embedding *const places = &embedding->places[layer];
    extended_list *const list = &work->outside[points->first / POINT_TILE * embedding->layers + layer];
    for (size_t i = 0; i < points->count; i++) {
        const size_t point = points->first + i;
        const ffd_location *const location = &room->chain.locations[i];
        const border_place *const border = &room->borders[i];
        const bool placed = ffd_location_is_placed(location), extended = !placed && border->nearest.found;
        places->status[point] = location->status;
        for (size_t c = 0; c < 3; c++)
            places->uvw[3 * point + c] = placed ? location->uvw[c] : (double)NAN;
        if (embedding->owners)
            embedding->owners[point] = owner_of(embedding, room, i, placed, extended);
        if (!extended)
            continue;
        if (!ffd_grow((void **)&list->points, &list->capacity, list->count + 1, sizeof *list->points))
            return ffd_fail_memory(error);
        list->points[list->count++] = (extended_point){point, border->nearest};
    }
    return FFD_OK;
}

/* Keeps what is known of the points of a tile after all layers. */
static ffd_status keep_statuses(const embed_work *work, const chain_points *points,
                                const point_outcome *outcomes, ffd_error *error)
{
    for (size_t i = 0; i < points->count; i++) {
        const size_t point = points->first + i;
        double x[3];
        work->embedding->status[point] = outcomes[i].status;
        if (work->desc->outside != FFD_OUTSIDE_ERROR || !outcomes[i].outside)
            continue;
        ffd_span_read(&work->desc->points, point, 1, x);
        return ffd_fail(error, FFD_E_EMBEDDING, "point %zu at %s %s %s is outside of %s", point,
                        ffd_number_text(x[0]).text, ffd_number_text(x[1]).text, ffd_number_text(x[2]).text,
                        work->desc->count == 1 ? "the lattice" : "all lattices");
    }
    return FFD_OK;
}

static ffd_status embed_tile(void *context, size_t first, size_t count, int worker, ffd_error *error)
{
    const embed_work *const work = context;
    ffd_chain_embedding *const embedding = work->embedding;
    chain_room *const room = &work->rooms[worker];
    const chain_points points = {first, count, NULL};
    const ffd_chain_embedding *const start = work->desc->start;
    ffd_span_read(&work->desc->points, first, count, room->x);
    for (size_t layer = 0; layer < embedding->layers; layer++) {
        const bool known = start && layer == 0;
        TRY(ffd_chain_send(known ? start : embedding, embedding->chain.links, layer, known, &points, room,
                           room->delta, NULL, error));
        TRY(keep_layer(work, layer, &points, room, error));
        for (size_t i = 0; i < count && layer > 0; i++)
            ffd_outcome_join(&room->outcomes[i], &room->joined[i]);
        if (layer == 0)
            memcpy(room->joined, room->outcomes, count * sizeof *room->joined);
        for (size_t i = 0; i < count && known && embedding->owners; i++)
            room->joined[i].status = start->status[first + i];
    }
    return keep_statuses(work, &points, room->joined, error);
}

/* Joins the lists of the tiles. Blocks share all arrays. */
static ffd_status join_lists(const embed_work *work, ffd_error *error)
{
    ffd_chain_embedding *const embedding = work->embedding;
    for (size_t layer = 0; layer < embedding->layers; layer++) {
        ffd_embedding *const places = &embedding->places[layer];
        size_t count = 0;
        for (size_t t = 0; t < work->tiles; t++)
            count += work->outside[t * embedding->layers + layer].count;
        places->extended = ffd_alloc(count, sizeof *places->extended);
        if (!places->extended)
            return ffd_fail_memory(error);
        for (size_t t = 0; t < work->tiles; t++) {
            const extended_list *const list = &work->outside[t * embedding->layers + layer];
            if (list->count > 0)
                memcpy(places->extended + places->extended_count, list->points,
                       list->count * sizeof *list->points);
            places->extended_count += list->count;
        }
    }
    for (size_t l = embedding->layers; l < embedding->chain.count; l++) {
        ffd_embedding *const places = &embedding->places[l];
        places->uvw = embedding->places[0].uvw;
        places->status = embedding->places[0].status;
        places->extended = embedding->places[0].extended;
        places->extended_count = embedding->places[0].extended_count;
    }
    return FFD_OK;
}

static ffd_status embed_all(const ffd_chain_desc *desc, point_run *run, ffd_chain_embedding *embedding,
                            ffd_error *error)
{
    embed_work work = {.desc = desc, .embedding = embedding, .tiles = desc->points.count / POINT_TILE + 1};
    ffd_status status;
    TRY_END(make_arrays(desc->blocks, embedding, error));
    work.rooms = ffd_chain_rooms(run);
    work.outside = ffd_alloc_zero(work.tiles, embedding->layers * sizeof *work.outside);
    TRY_END(work.rooms && work.outside ? FFD_OK : ffd_fail_memory(error));
    TRY_END(ffd_point_run_tiles(run, embed_tile, &work, error));
    TRY_END(join_lists(&work, error));
end:
    for (size_t i = 0; work.outside && i < work.tiles * embedding->layers; i++)
        ffd_free(work.outside[i].points);
    ffd_free(work.outside);
    ffd_free(work.rooms);
    return status;
}

ffd_status ffd_chain_embedding_create(const ffd_chain_desc *callers, const ffd_run_options *options,
                                      ffd_chain_embedding **embedding, ffd_error *error)
{
    ffd_chain_desc desc;
    point_run run = {.total = 0};
    *embedding = NULL;
    ffd_chain_desc_init(&desc, sizeof desc);
    ffd_status status;
    TRY_END(ffd_struct_take(&desc, sizeof desc, callers, "ffd_chain_desc", error));
    TRY_END(check(&desc, error));
    TRY_END(ffd_point_run_begin(options, desc.points.count, &run, error));
    *embedding = ffd_alloc_zero(1, sizeof **embedding);
    TRY_END(*embedding ? FFD_OK : ffd_fail_memory(error));
    (*embedding)->count = desc.points.count;
    (*embedding)->is_float = desc.points.type == FFD_FLOAT32;
    TRY_END(make_chain(&desc, run.options.isa, &(*embedding)->chain, error));
    TRY_END(ffd_overlaps_find(&(*embedding)->chain, &(*embedding)->overlaps, error));
    TRY_END(embed_all(&desc, &run, *embedding, error));
end:
    ffd_point_run_end(&run);
    if (status)
        ffd_chain_embedding_destroy(embedding);
    return status;
}

void ffd_chain_embedding_destroy(ffd_chain_embedding **embedding)
{
    if (!embedding || !*embedding)
        return;
    ffd_chain_embedding *const gone = *embedding;
    for (size_t layer = 0; gone->places && layer < gone->layers; layer++) {
        ffd_free(gone->places[layer].uvw);
        ffd_free(gone->places[layer].status);
        ffd_free(gone->places[layer].extended);
    }
    for (size_t l = 0; l < gone->chain.count; l++) {
        ffd_locator_destroy(&gone->chain.links[l].locator);
        ffd_lattice_destroy(&gone->chain.links[l].lattice);
    }
    ffd_free(gone->chain.links);
    ffd_free(gone->chain.boxes);
    ffd_box_tree_free(&gone->chain.tree);
    ffd_free(gone->places);
    ffd_free(gone->owners);
    ffd_free(gone->status);
    ffd_free(gone);
    *embedding = NULL;
}

size_t ffd_chain_embedding_get_count(const ffd_chain_embedding *embedding)
{
    return embedding->count;
}

const double *ffd_chain_embedding_get_uvw(const ffd_chain_embedding *embedding)
{
    return embedding->places[0].uvw;
}

const uint8_t *ffd_chain_embedding_get_status(const ffd_chain_embedding *embedding)
{
    return embedding->status;
}

const uint32_t *ffd_chain_embedding_get_blocks(const ffd_chain_embedding *embedding)
{
    return embedding->owners;
}

size_t ffd_chain_embedding_get_overlaps(const ffd_chain_embedding *embedding, size_t pair[2])
{
    pair[0] = embedding->overlaps.first;
    pair[1] = embedding->overlaps.other;
    return embedding->overlaps.pairs;
}
