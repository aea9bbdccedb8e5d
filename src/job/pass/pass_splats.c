#include "job/pass/pass_splats.h"

void ffd_tile_splat_turns(const part_work *work, tile_scratch *scratch, size_t count)
{
    splat_turn *const turns = scratch->splat->turns;
    ffd_splats_find_turns(work->pass->chain->isa, scratch->gradient, count, turns);
    for (size_t i = 0; i < count && !work->part->identity; i++) {
        const vertex_transform transform = ffd_vertex_transform_of(&scratch->transforms, i);
        if (!transform.identity && !transform.singular)
            ffd_splat_turn_to_file(transform.linear, &turns[i]);
    }
}

void ffd_tile_splats(const part_work *work, tile_scratch *scratch, size_t first, size_t count,
                     pass_totals *totals)
{
    mesh_document *const document = work->pass->document;
    splat_scratch *const tile = scratch->splat;
    document->format->read_splats(document, work->part_number, first, count, tile->splats);
    ffd_splats_deform(work->pass->chain->isa, scratch->gradient, tile->turns, &work->part->form, count,
                      tile->splats, tile->outcomes);
    for (size_t i = 0; i < count; i++) {
        const uint8_t outcome = tile->outcomes[i];
        tile->changed[i] = outcome == SPLAT_CARRIED || outcome == SPLAT_FLATTENED;
        if (!ffd_part_selects(work->part, first + i))
            continue; /* not selected: it only makes up for the turn of its node */
        totals->splats_carried += tile->changed[i];
        totals->splats_flattened += outcome == SPLAT_FLATTENED;
        totals->splats_broken += outcome == SPLAT_BROKEN && scratch->changed[i];
    }
    if (ffd_pass_stores(work->pass))
        document->format->write_splats(document, work->part_number, first, count, tile->splats, tile->turns,
                                       tile->changed);
}
