/* pass_splats.c - Gaussian splats in a tile of a pass (src/maths.md 9.6). */
#include "job/pass/tile.h"
#include "mesh/splats.h"

void ffd_tile_splat_turns(const pass_tile *tile)
{
    splat_turn *const turns = tile->scratch->splat->turns;
    ffd_splats_find_turns(tile->pass->chain->isa, tile->scratch->base.gradient, tile->count, turns);
    for (size_t i = 0; i < tile->count && !tile->part->identity; i++) {
        const vertex_transform transform = ffd_vertex_transform_of(&tile->scratch->transforms, i);
        if (!transform.identity && !transform.singular)
            ffd_splat_turn_to_file(transform.linear, &turns[i]);
    }
}

void ffd_tile_splats(const pass_tile *tile)
{
    mesh_document *const document = tile->pass->document;
    splat_scratch *const s = tile->scratch->splat;
    document->format->splats->read(document, tile->part_index, tile->first, tile->count, s->splats);
    ffd_splats_deform(tile->pass->chain->isa, tile->scratch->base.gradient, s->turns, &tile->part->form,
                      tile->count, s->splats, s->outcomes);
    for (size_t i = 0; i < tile->count; i++) {
        const uint8_t outcome = s->outcomes[i];
        s->changed[i] = outcome == SPLAT_CARRIED || outcome == SPLAT_FLATTENED;
        if (!ffd_part_selects(tile->part, tile->first + i))
            continue; /* not selected: it only makes up for the turn of its node */
        tile->totals->splats_carried += s->changed[i];
        tile->totals->splats_flattened += outcome == SPLAT_FLATTENED;
        tile->totals->splats_broken += outcome == SPLAT_BROKEN && tile->scratch->changed[i];
    }
    if (ffd_pass_stores(tile->pass))
        document->format->splats->write(document, tile->part_index, tile->first, tile->count, s->splats,
                                        s->turns, s->changed);
}
