/* box.c - the boxes into which a cell is subdivided, and bounds from their coefficients. */
#include "fold/bernstein.h"
#include "fold/search.h"
#include <string.h>

#define UNIT (0.5 * DBL_EPSILON)

void ffd_box_make(cell_search *search, box *whole)
{
    fold_scratch *scratch = search->scratch;
    for (int a = 0; a < 3; a++) {
        whole->lo[a] = 0;
        whole->hi[a] = 1;
    }
    whole->coefficients = scratch->coefficients[0];
    whole->weights = NULL;
    whole->rounding = search->bounds.rounding;
    ffd_determinant_coefficients(&search->form, search->plan->volume.sign, scratch->working,
                                 whole->coefficients);
    search->greatest = ffd_bernstein_greatest_size(whole->coefficients, ffd_bernstein_count(search->order));
    if (search->rational) {
        whole->weights = scratch->weights[0];
        memcpy(whole->weights, search->form.row[3][3],
               ffd_bernstein_count(search->weight_order) * sizeof(double));
    }
    search->boxes -= DETERMINANT_COST;
}

void ffd_box_halve(const cell_search *search, box *whole, int a, int depth, box *lower)
{
    fold_scratch *scratch = search->scratch;
    whole->rounding += (search->order[a] - 1) * UNIT * search->greatest;
    *lower = *whole;
    lower->hi[a] = whole->lo[a] = 0.5 * (whole->lo[a] + whole->hi[a]);
    lower->coefficients = scratch->coefficients[depth + 1];
    ffd_bernstein_halve(whole->coefficients, search->order, a, lower->coefficients);
    if (search->rational) {
        lower->weights = scratch->weights[depth + 1];
        ffd_bernstein_halve(whole->weights, search->weight_order, a, lower->weights);
    }
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
    view->least_weight = view->greatest_weight = 1;
    if (!search->rational)
        return;
    double least = DBL_MAX, greatest = 0;
    for (size_t i = 0; i < ffd_bernstein_count(search->weight_order); i++) {
        least = part->weights[i] < least ? part->weights[i] : least;
        greatest = part->weights[i] > greatest ? part->weights[i] : greatest;
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
    return search->rational ? ffd_bernstein_value(part->weights, search->weight_order, t) : 1;
}

double ffd_box_least(const cell_search *search, const box *part)
{
    const size_t count = ffd_bernstein_count(search->order);
    double least = DBL_MAX;
    for (size_t i = 0; i < count; i++)
        least = part->coefficients[i] < least ? part->coefficients[i] : least;
    return least;
}
