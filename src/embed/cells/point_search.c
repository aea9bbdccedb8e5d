/* point_search.c - the search for one point: evaluation relative to the point, its tolerance, and the verdict
   on the roots found (src/maths.md 6.6, 6.7). */
#include "embed/cells/point_search.h"
#include "base/memory/memory.h"
#include "base/vector/vec.h"

/* Bernstein hulls and images have a few more rounding errors than a value, so tests against them use this
   multiple of the tolerance. */
#define HULL_SLACK 4

void ffd_search_evaluate(point_search *search, const int span[3], const double offset[3], sample *at)
{
    homogeneous value;
    ffd_cells_evaluate(search->locator, span, offset, &value);
    search->evaluations++;
    at->weight = value.value[3];
    for (int r = 0; r < 3; r++) {
        at->equation[r] = value.value[r] - search->x[r] * value.value[3];
        at->residual[r] = at->equation[r] / value.value[3];
        for (int a = 0; a < 3; a++)
            at->jacobian[3 * r + a] = value.derivative[a][r] - search->x[r] * value.derivative[a][3];
    }
}

double ffd_image_of_tolerance(const double inverse[9], const double tolerance[3], double weight)
{
    double most = 0;
    for (int r = 0; r < 3; r++) {
        const double *row = inverse + 3 * r;
        const double sum =
            (fabs(row[0]) * tolerance[0] + fabs(row[1]) * tolerance[1] + fabs(row[2]) * tolerance[2]) *
            weight;
        most = sum > most ? sum : most;
    }
    return most;
}

/* Returns whether Y (C - x) can be 0 in the leaf: compares Y x with the bounds of Y C. */
bool ffd_search_image_holds(const point_search *search, const cell_leaf *leaf)
{
    if (search->locator->cells->rational)
        return true;
    double image[3];
    mat_apply(leaf->region.inverse, search->x, image);
    const double noise = ffd_image_of_tolerance(leaf->region.inverse, search->slack, 1);
    const double slack[3] = {noise, noise, noise};
    return bounds_hold(&leaf->image, image, slack);
}

void ffd_search_note_stall(point_search *search, const root *stall)
{
    root *const first = &search->stalls[0];
    if (!vec_is_finite(stall->uvw) || !isfinite(stall->residual)) {
        search->unresolved = true;
        return;
    }
    if (ffd_roots_hold(search->locator, &search->roots, stall))
        return;
    if (search->stall_count > 0 && stall->residual < first->residual) {
        const root before = *first;
        *first = *stall;
        ffd_search_note_stall(search, &before);
        return;
    }
    /* If the list is full, more stalls are not recorded. */
    if (search->stall_count < MOST_STALLS)
        search->stalls[search->stall_count++] = *stall;
    else
        search->unresolved = true;
}

/* Returns whether the search stalled anywhere except at a root that it has found. */
static bool has_stalled(point_search *search)
{
    for (int i = 0; i < search->stall_count; i++)
        if (!ffd_roots_hold(search->locator, &search->roots, &search->stalls[i]))
            return true;
    return false;
}

void ffd_search_judge(point_search *search, ffd_location *location)
{
    const root_list *list = &search->roots;
    const bool unresolved = search->unresolved || has_stalled(search);
    location->evaluations = search->evaluations;
    location->leaves = search->leaves;
    location->unresolved = unresolved;
    if (list->count == 0 && search->stall_count == 0) {
        location->status = unresolved ? FFD_VERTEX_SINGULAR : FFD_VERTEX_OUTSIDE;
        return;
    }
    const root *best = list->count > 0 ? ffd_roots_best(search->locator, list) : &search->stalls[0];
    bool regular = false;
    for (int i = 0; i < list->count; i++)
        regular = regular || !list->roots[i].singular;
    /* Several singular roots are one set of roots that the subdivision found more than once. */
    if (list->count > 1 && regular)
        location->status = FFD_VERTEX_MULTIPLE;
    else
        location->status = best->singular || unresolved ? FFD_VERTEX_SINGULAR : FFD_VERTEX_INSIDE;
    location->residual = best->residual / search->locator->cells->scale;
    ffd_locator_report(search->locator, best->uvw, location->uvw);
}

bool ffd_search_scratch_make(search_scratch **scratch)
{
    if (!*scratch)
        *scratch = ffd_alloc_zero(1, sizeof **scratch);
    return *scratch;
}

bool ffd_search_set_point(point_search *search, const double p[3])
{
    const cell_search *cells = search->locator->cells;
    for (int a = 0; a < 3; a++)
        search->x[a] = p[a] * cells->scale;
    if (!vec_is_finite(search->x))
        return false;
    ffd_cells_tolerance(search->locator, cells, search->x, search->tolerance, search->aim);
    for (int a = 0; a < 3; a++)
        search->slack[a] = HULL_SLACK * search->tolerance[a];
    return true;
}

void ffd_search_scratch_free(search_scratch *scratch)
{
    if (!scratch)
        return;
    ffd_own_bricks_free(&scratch->own);
    ffd_free(scratch->many);
    ffd_free(scratch->slots);
    ffd_free(scratch->columns);
    ffd_free(scratch);
}
