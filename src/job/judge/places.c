/* places.c - says where moves take a place of the model less far than they say. */
#include "base/memory/memory.h"
#include "base/text/words.h"
#include "job/chain/lattice_memory.h"
#include "job/judge/warnings.h"
#include "lattice/lattice.h"
#include "lattice/place_moves.h"
#include "lattice/spec.h"
#include <stdio.h>

static bool names_places(const lattice_spec *spec)
{
    for (size_t i = 0; i < spec->move_count; i++)
        if (spec->moves[i].action == MOVE_PULL || spec->moves[i].falloff.kind == FALLOFF_BALL)
            return true;
    return false;
}

/* Warns of the move that falls short most. Returns how many do. */
static size_t warn_of_short(const chain_link *link, const place_move *found, size_t count,
                            const mesh_log *log)
{
    const place_move *worst = NULL;
    size_t all = 0;
    char name[100], more[40] = "";
    for (size_t i = 0; i < count; i++) {
        if (!(found[i].moved < 0.5 * found[i].asked))
            continue;
        all++;
        if (!worst || found[i].moved * worst->asked < worst->moved * found[i].asked)
            worst = &found[i];
    }
    if (all == 0)
        return 0;
    if (all > 1)
        snprintf(more, sizeof more, " (%zu more %s)", all - 1,
                 ffd_plural(all - 1, "move falls short", "moves fall short"));
    ffd_name_shown(link->lattice->spec->name, name, sizeof name);
    ffd_log_line(log, FFD_LOG_WARNING,
                 "%s: /moves/%zu: asked %.3g, the mesh moves %.3g: the layers are %.3g apart%s", name,
                 worst->move, worst->asked, worst->moved, worst->apart, more);
    return all;
}

static ffd_status find_short(const lattice_chain *chain, const chain_link *link, const mesh_log *log,
                             bool *falls_short, ffd_error *error)
{
    const lattice_spec *const spec = link->lattice->spec;
    memory_budget budget = chain->memory;
    size_t count;
    /* A lattice that fills the memory allowed is not built a second time for a warning. */
    if (ffd_lattice_memory_take(&budget, spec, 0, NULL))
        return FFD_OK;
    place_move *const found = ffd_alloc(spec->move_count, sizeof *found);
    ffd_status status;
    TRY_END(found ? FFD_OK : ffd_fail_memory(error));
    TRY_END(ffd_lattice_place_moves(link->lattice, link->locator, found, &count, error));
    if (warn_of_short(link, found, count, log) > 0)
        *falls_short = true;
end:
    ffd_free(found);
    return status;
}

static void warn_of_missed(const ffd_lattice *lattice, const mesh_log *log)
{
    const drag_miss *const missed = &lattice->missed;
    char name[100];
    if (!(missed->miss > 0))
        return;
    ffd_name_shown(lattice->spec->name, name, sizeof name);
    ffd_log_line(log, FFD_LOG_WARNING,
                 "%s: %s: the control points cannot take all places as far as the drag asks: the largest "
                 "miss is %.3g of %.3g, at %g %g %g",
                 name, missed->pointer, missed->miss, missed->asked, missed->place[0], missed->place[1],
                 missed->place[2]);
}

ffd_status ffd_places_warn(const lattice_chain *chain, const mesh_log *log, bool *falls_short,
                           ffd_error *error)
{
    *falls_short = false;
    for (size_t l = 0; l < chain->count; l++) {
        const chain_link *const link = &chain->links[l];
        if (!link->lattice->spec || link->lattice->edited)
            continue;
        warn_of_missed(link->lattice, log);
        if (link->locator && names_places(link->lattice->spec))
            TRY(find_short(chain, link, log, falls_short, error));
    }
    return FFD_OK;
}
