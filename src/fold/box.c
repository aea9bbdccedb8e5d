/* box.c - the boxes into which a cell is subdivided, and bounds from their coefficients. */
#include "fold/bernstein.h"
#include "fold/search.h"
#include <string.h>

#define UNIT (0.5 * DBL_EPSILON)

/* With weights the error is at most that of the products in the box; without, all parts of a cell have
   products of much the same size. */
static void bound_rounding(const cell_search *search, box *part)
{
    size_bounds bounds;
    part->rounding = part->cell_rounding;
    part->is_even = true;
    if (!search->rational)
        return;
    ffd_sizes_bound(&search->form, &part->sizes, &bounds);
    part->is_even = bounds.is_even;
    const double own =
        (search->relative + 1.01 * UNIT * part->halvings) * ffd_sizes_products(&bounds, false) +
        LEAST_ROUNDING;
    part->rounding = own < part->cell_rounding ? own : part->cell_rounding;
}

void ffd_box_make(cell_search *search, box *whole)
{
    fold_scratch *scratch = search->scratch;
    for (int a = 0; a < 3; a++) {
        whole->lo[a] = 0;
        whole->hi[a] = 1;
    }
    whole->coefficients = scratch->coefficients[0];
    whole->cell_rounding = search->bounds.rounding;
    whole->halvings = 0;
    ffd_determinant_coefficients(&search->form, search->plan->volume.sign, scratch->working,
                                 whole->coefficients);
    search->greatest = ffd_bernstein_greatest_size(whole->coefficients, ffd_bernstein_count(search->order));
    if (search->rational)
        ffd_sizes_make(&search->form, scratch->sizes[0], &whole->sizes);
    bound_rounding(search, whole);
    search->boxes -= DETERMINANT_COST;
}

void ffd_box_halve(const cell_search *search, box *whole, int a, int depth, box *lower)
{
    fold_scratch *scratch = search->scratch;
    whole->cell_rounding += (search->order[a] - 1) * UNIT * search->greatest;
    whole->halvings += search->order[a] - 1;
    *lower = *whole;
    lower->hi[a] = whole->lo[a] = 0.5 * (whole->lo[a] + whole->hi[a]);
    lower->coefficients = scratch->coefficients[depth + 1];
    ffd_bernstein_halve(whole->coefficients, search->order, a, lower->coefficients);
    if (search->rational)
        ffd_sizes_halve(&search->form, a, scratch->sizes[depth + 1], &whole->sizes, &lower->sizes);
    bound_rounding(search, lower);
    bound_rounding(search, whole);
}

static void scan(const cell_search *search, const box *part, box_view *view)
{
    const int *order = search->order;
    const double *c = part->coefficients;
    int at[3];
    memset(view, 0, sizeof *view);
    view->least = DBL_MAX;
    for (at[2] = 0; at[2] < order[2]; at[2]++)
        for (at[1] = 0; at[1] < order[1]; at[1]++)
            for (at[0] = 0; at[0] < order[0]; at[0]++, c++) {
                if (*c < view->least) {
                    view->least = *c;
                    memcpy(view->at, at, sizeof at);
                }
            }
    view->is_positive = view->least > part->rounding;
}

static void view_weights(const cell_search *search, const box *part, box_view *view)
{
    const double *weights = part->sizes.row[3][1];
    view->least_weight = view->greatest_weight = 1;
    if (!search->rational)
        return;
    double least = DBL_MAX, greatest = 0;
    for (size_t i = 0; i < ffd_bernstein_count(search->weight_order); i++) {
        least = weights[i] < least ? weights[i] : least;
        greatest = weights[i] > greatest ? weights[i] : greatest;
    }
    /* Valid because all terms are positive: their relative rounding error is far below 1e-12. */
    view->least_weight = least * (1 - 1e-12);
    view->greatest_weight = greatest * (1 + 1e-12);
}

void ffd_box_view(cell_search *search, const box *part, box_view *view)
{
    bool touches[3][2], any = false;
    for (int a = 0; a < 3; a++) {
        touches[a][0] = search->on_border[a][0] && part->lo[a] == 0;
        touches[a][1] = search->on_border[a][1] && part->hi[a] == 1;
        any |= touches[a][0] | touches[a][1];
    }
    scan(search, part, view);
    if (any && !view->is_positive)
        ffd_border_view(search, part, (const bool(*)[2])touches, view);
    view_weights(search, part, view);
}

double ffd_box_lower(const cell_search *search, const box *part, const box_view *view)
{
    const double lower =
        ffd_search_lower(search, view->least - part->rounding, view->least_weight, view->greatest_weight);
    return view->has_zeros && lower > 0 ? 0 : lower;
}

double ffd_box_weight(const cell_search *search, const box *part, const double t[3])
{
    return search->rational ? ffd_bernstein_value(part->sizes.row[3][1], search->weight_order, t) : 1;
}

double ffd_box_least(const cell_search *search, const box *part)
{
    const size_t count = ffd_bernstein_count(search->order);
    double least = DBL_MAX;
    for (size_t i = 0; i < count; i++)
        least = part->coefficients[i] < least ? part->coefficients[i] : least;
    return least;
}
