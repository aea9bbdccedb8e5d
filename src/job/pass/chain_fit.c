#include "job/pass/chain_fit.h"
#include "job/chain/chain_boxes.h"
#include "job/chain/chain_load.h"
#include "job/chain/seams.h"
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

/* The box of the selected visible vertices as the first `links` links leave them; if no selected vertex is
   visible, of all selected ones. */
static ffd_status find_box(const lattice_chain *chain, size_t links, mesh_document *document, int threads,
                           ffd_bounds *box, ffd_error *error)
{
    mesh_pass pass = {.document = document,
                      .chain = chain,
                      .links = links,
                      .threads = threads,
                      .bounds_shapes = true,
                      .bounds_of = PASS_BOUNDS_SHOWN};
    pass_totals totals;
    TRY(ffd_mesh_mark_used(document, error));
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

static ffd_status fit_link(lattice_chain *chain, size_t l, const ffd_bounds *box, ffd_error *error)
{
    ffd_lattice *const lattice = chain->links[l].lattice;
    ffd_status status;
    TRY_END(ffd_lattice_fit(lattice, box->min, box->max, error));
    TRY_END(ffd_chain_prepare(chain, l, error));
end:
    if (status)
        ffd_fail_name_file(error, lattice->spec->name);
    return status;
}

ffd_status ffd_chain_fit(lattice_chain *chain, mesh_document *document, int threads, ffd_error *error)
{
    const int usable = ffd_pass_threads(&document->budget, 0, threads);
    for (size_t l = 0; l < chain->count; l++) {
        if (chain->links[l].locator)
            continue;
        ffd_bounds box;
        TRY(check_reach(NULL, l, document, error));
        TRY(find_box(chain, chain->blocks ? 0 : l, document, usable, &box, error));
        TRY(fit_link(chain, l, &box, error));
    }
    TRY(ffd_chain_boxes(chain, error));
    TRY(ffd_seams_find(chain, error));
    for (size_t l = 0; l < chain->count; l++)
        TRY(check_reach(chain, l, document, error));
    return FFD_OK;
}
