/* flat.c - with weights: cells whose determinant is 0 within rounding everywhere. */
#include "fold/bernstein.h"
#include "fold/place.h"
#include "fold/search.h"

/* Returns whether the control points alone make the determinant 0 within rounding. With weights that are very
   different it may be so small that it is lost in the rounding of its terms, in a cell that is not flat.
   The slots of deeper boxes are free, and larger than what is needed. */
static bool is_flat_without_weights(const cell_search *search)
{
    fold_scratch *scratch = search->scratch;
    double *const rows = scratch->coefficients[1], *const coefficients = scratch->coefficients[3];
    cell_form form;
    determinant_bounds bounds;
    int order[3];
    ffd_cell_form_make(search->plan, FFD_VOLUME_DEFORMED, search->index, false, rows, scratch->working,
                       &form);
    ffd_determinant_bounds(&form, &bounds);
    ffd_determinant_order(search->plan->order, false, order);
    ffd_determinant_coefficients(&form, 1, scratch->working, coefficients);
    return ffd_bernstein_greatest_size(coefficients, ffd_bernstein_count(order)) <= bounds.rounding;
}

void ffd_search_flat(cell_search *search)
{
    static const double centre[3] = {0.5, 0.5, 0.5};
    if (!is_flat_without_weights(search))
        return;
    /* The centre, and one place in each octant. */
    for (int place = 0; place < 9 && search->boxes > 0; place++) {
        double t[3], uvw[3];
        for (int a = 0; a < 3; a++)
            t[a] = place == 0 ? centre[a] : (place - 1) >> a & 1 ? 0.75 : 0.25;
        ffd_place_parameters(search->plan, search->index, t, uvw);
        search->boxes -= PLACE_COST;
        const place_determinant det =
            ffd_place_determinant(search->plan, search->index, uvw, search->scratch->working);
        if (det.sign <= 0) {
            ffd_search_set_folded(search, t, -det.size);
            return;
        }
    }
    ffd_search_set_folded(search, centre, 0);
    search->result.is_positive = true;
}
