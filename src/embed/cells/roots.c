#include "embed/cells/roots.h"

/* Coordinates that differ by at most this, relative to the domain, are equal (src/maths.md 6.7). */
#define SAME 1e-9

void ffd_root_find_spread(root *of)
{
    double inverse[9];
    if (of->has_spread)
        return;
    of->has_spread = true;
    if (mat_invert(of->jacobian, inverse))
        for (int a = 0; a < 3; a++) {
            const double *row = inverse + 3 * a;
            of->spread[a] =
                of->width[a] * (fabs(row[0]) * of->tolerance[0] + fabs(row[1]) * of->tolerance[1] +
                                fabs(row[2]) * of->tolerance[2]);
        }
}

static void find_spreads(root_list *list)
{
    for (int i = 0; i < list->count; i++)
        ffd_root_find_spread(&list->roots[i]);
}

static double side_of(const ffd_locator *locator, int direction)
{
    const knot_vector *knots = &locator->knots[direction];
    return ffd_knots_last(knots) - ffd_knots_first(knots);
}

static double tolerance_of(const ffd_locator *locator, const root *a, const root *b, int direction)
{
    return maximum_number(SAME * side_of(locator, direction),
                          maximum_number(a->spread[direction], b->spread[direction]));
}

/* Returns whether the shorter way from a to b in this direction crosses the ends of the domain, which
   coincide. */
static bool is_across_seam(const ffd_locator *locator, const root *a, const root *b, int direction)
{
    return (ffd_knots_closed(&locator->knots[direction]) || locator->cells->is_seam[direction]) &&
           fabs(a->uvw[direction] - b->uvw[direction]) > 0.5 * side_of(locator, direction);
}

/* Returns the distance of two roots in a direction, the shorter way round if its ends coincide. */
static double distance_along(const ffd_locator *locator, const root *a, const root *b, int direction)
{
    const double apart = fabs(a->uvw[direction] - b->uvw[direction]);
    return is_across_seam(locator, a, b, direction) ? side_of(locator, direction) - apart : apart;
}

/* Two coinciding faces with different weights have the same point at different parameters, so the parameters
   along the faces need not agree. */
static bool are_one_on_seam(const ffd_locator *locator, const root *a, const root *b)
{
    for (int d = 0; d < 3; d++)
        if (locator->cells->is_seam[d] && is_across_seam(locator, a, b, d) &&
            distance_along(locator, a, b, d) <= tolerance_of(locator, a, b, d))
            return true;
    return false;
}

static bool are_one(const ffd_locator *locator, const root *a, const root *b)
{
    for (int d = 0; d < 3; d++)
        if (!(distance_along(locator, a, b, d) <= tolerance_of(locator, a, b, d)))
            return are_one_on_seam(locator, a, b);
    return true;
}

/* Compares two roots by (u,v,w), with coordinates equal within the tolerance. Returns -1, 0 or 1. */
static int compare_within_tolerance(const ffd_locator *locator, const root *a, const root *b)
{
    for (int d = 0; d < 3; d++)
        if (fabs(a->uvw[d] - b->uvw[d]) > tolerance_of(locator, a, b, d))
            return a->uvw[d] < b->uvw[d] ? -1 : 1;
    return 0;
}

static int compare_exactly(const root *a, const root *b)
{
    for (int d = 0; d < 3; d++)
        if (a->uvw[d] != b->uvw[d])
            return a->uvw[d] < b->uvw[d] ? -1 : 1;
    return 0;
}

static bool is_preferred(const ffd_locator *locator, const root *a, const root *b)
{
    const double sign = locator->cells->volume_sign;
    const bool a_agrees = a->determinant * sign > 0, b_agrees = b->determinant * sign > 0;
    if (a_agrees != b_agrees)
        return a_agrees;
    return compare_within_tolerance(locator, a, b) < 0;
}

/* Selects between two results for the same root: across a seam the least u,v,w, otherwise the smaller
   residual. */
static bool is_better_find(const ffd_locator *locator, const root *a, const root *b)
{
    for (int d = 0; d < 3; d++)
        if (is_across_seam(locator, a, b, d))
            return compare_within_tolerance(locator, a, b) < 0;
    if (a->residual != b->residual)
        return a->residual < b->residual;
    return compare_exactly(a, b) < 0;
}

static void join(const ffd_locator *locator, root *kept, const root *found)
{
    const bool singular = kept->singular || found->singular; /* a singular root stays singular */
    if (is_better_find(locator, found, kept))
        *kept = *found;
    kept->singular = singular;
}

/* Adds a root to a list that has some. */
static void add_to_others(const ffd_locator *locator, root_list *list, const root *found)
{
    for (int i = 0; i < list->count; i++)
        if (are_one(locator, &list->roots[i], found)) {
            join(locator, &list->roots[i], found);
            return;
        }
    if (list->count < MOST_ROOTS) {
        list->roots[list->count++] = *found;
        return;
    }
    int last = 0;
    for (int i = 1; i < MOST_ROOTS; i++)
        if (is_preferred(locator, &list->roots[last], &list->roots[i]))
            last = i;
    if (is_preferred(locator, found, &list->roots[last]))
        list->roots[last] = *found;
}

void ffd_roots_add(const ffd_locator *locator, root_list *list, const root *found)
{
    root own = *found;
    if (list->count == 0) {
        list->roots[list->count++] = own;
        return;
    }
    find_spreads(list);
    ffd_root_find_spread(&own);
    add_to_others(locator, list, &own);
}

void ffd_roots_unite(const ffd_locator *locator, root_list *list, int kept, int other)
{
    join(locator, &list->roots[kept], &list->roots[other]);
    list->count--;
    for (int i = other; i < list->count; i++)
        list->roots[i] = list->roots[i + 1];
}

bool ffd_roots_hold(const ffd_locator *locator, root_list *list, const root *found)
{
    find_spreads(list);
    for (int i = 0; i < list->count; i++)
        if (are_one(locator, &list->roots[i], found))
            return true;
    return false;
}

const root *ffd_roots_best(const ffd_locator *locator, const root_list *list)
{
    const root *best = &list->roots[0];
    for (int i = 1; i < list->count; i++)
        if (is_preferred(locator, &list->roots[i], best))
            best = &list->roots[i];
    return best;
}
