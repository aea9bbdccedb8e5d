#include "job/pass/chain_fit.h"
#include "job/chain/chain_boxes.h"
#include "job/chain/chain_load.h"
#include "job/chain/seams.h"
#include "job/input/shown_box.h"
#include "job/pass/pass.h"
#include "lattice/lattice.h"
#include "lattice/spec.h"
#include "mesh/bounds.h"
#include <math.h>
#include <string.h>

/* Refuses a lattice that reaches parts which cannot be deformed. chain NULL: a lattice round the mesh, which
   reaches all parts. */
static ffd_status check_reach(const lattice_chain *chain, size_t link, const mesh_document *document,
                              ffd_error *error)
{
    ffd_bounds box = {{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}, {HUGE_VAL, HUGE_VAL, HUGE_VAL}};
    if (!document->format->check_reach)
        return FFD_OK;
    if (chain) {
        const bounds reach = ffd_chain_reach(chain, link);
        memcpy(box.min, reach.lo, sizeof box.min);
        memcpy(box.max, reach.hi, sizeof box.max);
    }
    return document->format->check_reach(document, &box, error);
}

static bool is_empty(const ffd_bounds *box)
{
    for (int a = 0; a < 3; a++)
        if (!(box->min[a] <= box->max[a]))
            return true;
    return false;
}

/* The bounds of the selected visible vertices as the first `links` links leave them; if no selected vertex is
   visible, of all selected ones. */
static ffd_status find_bounds(const lattice_chain *chain, size_t links, mesh_document *document,
                              mesh_state state, int threads, ffd_bounds *box, ffd_error *error)
{
    mesh_pass pass = {.document = document,
                      .state = state,
                      .chain = chain,
                      .links = links,
                      .threads = threads,
                      .bounds_shapes = state == MESH_STORED,
                      .bounds_of = PASS_BOUNDS_SHOWN};
    pass_totals totals;
    TRY(ffd_pass_over_mesh(&pass, &totals, error));
    pass.bounds_of = PASS_BOUNDS_ALL;
    if (is_empty(&totals.after) && is_empty(&totals.shapes))
        TRY(ffd_pass_over_mesh(&pass, &totals, error));
    *box = totals.after;
    ffd_bounds_join(box, &totals.shapes);
    /* Without vertices any box will do. */
    for (int a = 0; a < 3 && is_empty(box); a++) {
        box->min[a] = 0;
        box->max[a] = 1;
    }
    return FFD_OK;
}

static bool has_shapes(const mesh_document *document)
{
    for (size_t i = 0; i < document->part_count; i++)
        if (document->parts[i].shape_count > 0)
            return true;
    return false;
}

static ffd_status find_extent(const lattice_chain *chain, size_t link, mesh_document *document, int threads,
                              fit_extent *extent, ffd_error *error)
{
    const size_t links = chain->blocks ? 0 : link;
    ffd_bounds all, shown;
    TRY(ffd_mesh_mark_used(document, error));
    TRY(find_bounds(chain, links, document, MESH_STORED, threads, &all, error));
    shown = all;
    if (has_shapes(document) && chain->links[link].lattice->spec->units == UNITS_MESH)
        TRY(find_bounds(chain, links, document, MESH_SHOWN, threads, &shown, error));
    *extent = ffd_fit_extent(&all, &shown);
    return FFD_OK;
}

static ffd_status fit_link(lattice_chain *chain, size_t l, const fit_extent *extent, ffd_error *error)
{
    ffd_lattice *const lattice = chain->links[l].lattice;
    ffd_status status;
    TRY_END(ffd_lattice_fit_extent(lattice, extent, error));
    TRY_END(ffd_chain_prepare(chain, l, error));
end:
    if (status)
        ffd_fail_name_file(error, lattice->spec->name);
    return status;
}

static ffd_status fit_to_mesh(lattice_chain *chain, size_t l, mesh_document *document, int threads,
                              ffd_error *error)
{
    fit_extent extent;
    TRY(check_reach(NULL, l, document, error));
    TRY(find_extent(chain, l, document, threads, &extent, error));
    return fit_link(chain, l, &extent, error);
}

ffd_status ffd_chain_fit(lattice_chain *chain, mesh_document *document, int threads, const fit_seals *seals,
                         ffd_error *error)
{
    const int usable = ffd_pass_threads(&document->budget, 0, threads);
    for (size_t l = 0; l < chain->count; l++) {
        if (!chain->links[l].locator)
            TRY(fit_to_mesh(chain, l, document, usable, error));
        if (seals && !chain->blocks)
            TRY(seals->seal(seals->context, l, error));
    }
    TRY(ffd_chain_boxes(chain, error));
    if (seals && chain->blocks)
        TRY(seals->seal(seals->context, 0, error));
    TRY(ffd_seams_find(chain, error));
    for (size_t l = 0; l < chain->count; l++)
        TRY(check_reach(chain, l, document, error));
    return FFD_OK;
}
