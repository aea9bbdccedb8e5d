/* figures.c - relative values of the determinant, and the intermediate result of a search. */
#include "base/arithmetic.h"
#include "fold/search.h"

#define UNIT (0.5 * DBL_EPSILON)

double ffd_search_relative(const cell_search *search, double value, double weight)
{
    /* Divided one by one, because the fourth power of a small weight could underflow to 0. */
    const double result = scaled_apply(value / weight / weight / weight / weight, search->unit);
    return isnan(result) ? -DBL_MAX : result; /* a weight underflowed to 0 */
}

double ffd_search_lower(const cell_search *search, double value, double least_weight, double greatest_weight)
{
    const double doubt = search->plan->volume.doubt + 64 * UNIT;
    const double result = ffd_search_relative(search, value, value > 0 ? greatest_weight : least_weight);
    return result > 0 ? result * (1 - doubt) : maximum_number(result * (1 + 2 * doubt), -DBL_MAX);
}

void ffd_search_see(cell_search *search, double relative)
{
    if (relative < search->result.least_seen)
        search->result.least_seen = relative;
}

void ffd_search_lower_to(cell_search *search, double relative)
{
    if (relative < search->result.lower)
        search->result.lower = relative;
}

void ffd_search_set_folded(cell_search *search, const double local[3], double relative)
{
    search->result.verdict = FFD_FOLDS_SOME;
    for (int a = 0; a < 3; a++)
        search->result.local[a] = local[a];
    search->result.value = relative < 0 ? relative : 0;
    ffd_search_see(search, search->result.value);
}

scaled ffd_search_unit(const fold_plan *plan, const size_t index[3], int exponent)
{
    scaled unit = scaled_divide(scaled_make(1, exponent), plan->volume.reference);
    for (int a = 0; a < 3; a++) {
        const knot_vector *knots = &plan->lattice->knots[a];
        const double *knot = knots->t + knots->spans[index[a]];
        unit = scaled_multiply(unit, scaled_make(ffd_knots_last(knots) - ffd_knots_first(knots), 0));
        unit = scaled_divide(unit, scaled_make(knot[1] - knot[0], 0));
    }
    return unit;
}
