#include "fold/cell.h"
#include "fold/bernstein.h"
#include "fold/regular.h"
#include "fold/search.h"
#include <string.h>

#define LEAST_BOXES 256 /* for boxes of any size */

long ffd_cell_boxes(const fold_plan *plan, long boxes)
{
    static const int cubic[3] = {9, 9, 9};
    int order[3];
    ffd_determinant_order(plan->order, plan->rational, order);
    const size_t count = ffd_bernstein_count(order), usual = ffd_bernstein_count(cubic);
    if (count <= usual)
        return boxes;
    const long fewer = (long)((double)boxes * (double)usual / (double)count);
    return fewer > LEAST_BOXES ? fewer : LEAST_BOXES;
}

static void begin(const fold_plan *plan, size_t cell, fold_scratch *scratch, cell_search *search)
{
    int span[3];
    memset(search, 0, sizeof *search);
    search->plan = plan;
    search->scratch = scratch;
    ffd_fold_cell_at(plan, cell, search->index, span);
    search->rational = ffd_cell_is_rational(plan, span, scratch->working);
    ffd_determinant_order(plan->order, search->rational, search->order);
    for (int a = 0; a < 3; a++) {
        const bool closed = ffd_knots_closed(&plan->lattice->knots[a]);
        search->on_border[a][0] = !closed && search->index[a] == 0;
        search->on_border[a][1] = !closed && search->index[a] + 1 == plan->cells[a];
        search->weight_order[a] = plan->order[a];
    }
    ffd_cell_form_make(plan, FFD_VOLUME_DEFORMED, search->index, search->rational, scratch->rows,
                       scratch->working, &search->form);
    ffd_determinant_bounds(&search->form, &search->bounds);
    if (search->rational)
        search->relative = 1.01 * (4 * search->form.roundings * 0.5 * DBL_EPSILON + search->bounds.relative);
    search->unit = ffd_search_unit(plan, search->index, search->form.exponent);
    search->result.least_seen = DBL_MAX;
    search->result.lower = DBL_MAX;
}

/* Tests the values at the corners of the cell, before coefficients are computed. A value that is negative
   even if control points are known only roughly is not an excused zero. */
static void test_cell_corners(cell_search *search)
{
    for (int corner = 0; corner < 8; corner++) {
        double t[3], weight = 1;
        for (int a = 0; a < 3; a++)
            t[a] = corner >> a & 1;
        if (search->rational)
            weight = ffd_bernstein_value(search->form.row[3][3], search->weight_order, t);
        const double value = search->plan->volume.sign * ffd_determinant_corner(&search->form, corner);
        const double relative = ffd_search_relative(search, value, weight);
        if (value >= -search->bounds.coarse)
            ffd_search_see(search, relative);
        else if (search->result.verdict != FFD_FOLDS_SOME)
            ffd_search_set_folded(search, t, relative);
    }
}

/* Returns a lower bound that holds for any signs of the products of the determinant. */
static double crude_lower(const cell_search *search)
{
    const double weight = search->form.least_weight * (1 - 1e-12);
    return ffd_search_lower(search, -search->bounds.greatest, weight, weight);
}

static bool decide_quickly(cell_search *search)
{
    static const double centre[3] = {0.5, 0.5, 0.5};
    regularity quick;
    ffd_cell_regularity(&search->form, &quick);
    test_cell_corners(search);
    if (quick.proven && quick.negative == (search->plan->volume.sign < 0)) {
        search->result.lower = ffd_search_lower(search, quick.least, 1, 1);
        return true;
    }
    if (quick.proven && search->result.verdict != FFD_FOLDS_SOME)
        ffd_search_set_folded(search, centre, ffd_search_relative(search, -quick.least, 1));
    if (search->result.verdict == FFD_FOLDS_SOME)
        search->result.lower = crude_lower(search);
    return search->result.verdict == FFD_FOLDS_SOME;
}

void ffd_cell_decide(const fold_plan *plan, size_t cell, long boxes, fold_scratch *scratch,
                     cell_verdict *verdict)
{
    cell_search search;
    begin(plan, cell, scratch, &search);
    search.result.verdict = FFD_FOLDS_NONE;
    if (!decide_quickly(&search)) {
        box whole;
        search.boxes = boxes;
        ffd_box_make(&search, &whole);
        ffd_search_box(&search, &whole, 0);
        if (search.result.verdict == FFD_FOLDS_SOME) /* the cell was not examined completely */
            ffd_search_lower_to(&search, search.whole_lower);
    }
    *verdict = search.result;
}

double ffd_cell_refine(const fold_plan *plan, size_t cell, fold_scratch *scratch, double *least_seen,
                       long *boxes)
{
    cell_search search;
    box whole;
    begin(plan, cell, scratch, &search);
    search.refining = true;
    search.boxes = *boxes;
    search.result.least_seen = *least_seen;
    ffd_box_make(&search, &whole);
    ffd_search_box(&search, &whole, 0);
    *boxes = search.boxes;
    *least_seen = search.result.least_seen;
    return search.result.lower;
}
