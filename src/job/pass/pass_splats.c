#include "job/pass/pass_splats.h"

void ffd_tile_splat_turns(tile_scratch *scratch, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const vertex_transform transform = ffd_vertex_transform_of(&scratch->transforms, i);
        splat_turn *const turn = &scratch->splat->turns[i];
        ffd_splat_find_turn(scratch->gradient + 9 * i, turn);
        if (!transform.identity && !transform.singular)
            ffd_splat_turn_to_file(transform.linear, turn);
    }
}

void ffd_tile_splats(const part_work *work, tile_scratch *scratch, size_t first, size_t count,
                     pass_totals *totals)
{
    mesh_document *const document = work->pass->document;
    splat_scratch *const tile = scratch->splat;
    document->format->read_splats(document, work->part_number, first, count, tile->splats);
    for (size_t i = 0; i < count; i++) {
        const splat_outcome outcome =
            ffd_splat_deform(scratch->gradient + 9 * i, &tile->turns[i], &work->part->form, &tile->splats[i]);
        tile->changed[i] = outcome == SPLAT_CARRIED || outcome == SPLAT_FLATTENED;
        totals->splats_carried += tile->changed[i];
        totals->splats_flattened += outcome == SPLAT_FLATTENED;
        totals->splats_broken += outcome == SPLAT_BROKEN && scratch->changed[i];
    }
    document->format->write_splats(document, work->part_number, first, count, tile->splats, tile->turns,
                                   tile->changed);
}
