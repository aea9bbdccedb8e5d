/* search.c - finds every u,v,w with C(u,v,w) = p: bricks, leaves, verdict (src/maths.md 6.4 to 6.7). */
#include "base/vector/vec.h"
#include "embed/cells/cell_locator.h"
#include "embed/cells/collapse.h"
#include "embed/cells/leaf.h"
#include "embed/cells/leaf_subdivision.h"
#include "embed/frame/face.h"
#include "embed/frame/slabs.h"
#include <float.h>

#define CURVE_STEPS 2
/* The parts of the way between two roots at whose ends the residual is looked at. */
#define BLUR_STEPS 8
/* The budget of a point, so that no lattice makes the search endless: visited bricks (SEARCH_BRICKS), and
   boxes of hard leaves. For degrees above 3 there are fewer boxes, in proportion to their size. */
#define MOST_HARD_BOXES 16384
#define LEAST_HARD_BOXES 1024
/* A further search has the budget divided by this: for an undecided point, and for one probably outside. */
#define AGAIN_PART 2
#define STRICT_PART 16

typedef struct brick_visit {
    point_search *search;
    const cell_brick *brick;
} brick_visit;

static bool visit_leaf(void *context, uint32_t index)
{
    const brick_visit *visit = context;
    point_search *search = visit->search;
    const cell_leaf *leaf = &visit->brick->leaves[index];
    if (!bounds_hold(&leaf->hull, search->x, search->slack))
        return true;
    if (leaf->hard) {
        search->leaves++;
        ffd_search_hard_leaf(search, leaf);
    } else if (ffd_search_image_holds(search, leaf)) {
        search->leaves++;
        root stall;
        if (!ffd_search_region(search, &leaf->region, &stall))
            ffd_search_part(search, &leaf->region);
    }
    return search->status == FFD_OK;
}

static bool visit_brick(void *context, uint32_t index)
{
    point_search *search = context;
    const cell_search *cells = search->locator->cells;
    if (!bounds_hold(&cells->brick_hulls[index], search->x, search->slack))
        return true;
    if (search->bricks++ >= SEARCH_BRICKS) {
        search->unresolved = true;
        return false;
    }
    brick_visit visit = {.search = search};
    search->status =
        ffd_cells_brick(search->locator, index, &search->scratch->own, &visit.brick, search->error);
    if (search->status)
        return false;
    return ffd_box_tree_visit(&visit.brick->tree, search->x, search->slack, visit_leaf, &visit);
}

/* The curve of a collapse passes the point within the tolerance: finds the nearest point of the curve with
   Gauss-Newton steps. */
static void settle_on_curve(point_search *search, int along, const int span[3], double offset[3], sample *at)
{
    const double *knot = search->locator->knots[along].t + span[along];
    for (int step = 0; step < CURVE_STEPS; step++) {
        double jacobian[9], equation[3], slope = 0, square = 0;
        if (!ffd_weigh_rows(at->jacobian, at->equation, search->tolerance, jacobian, equation))
            return;
        for (int r = 0; r < 3; r++) {
            slope += jacobian[3 * r + along] * equation[r];
            square += jacobian[3 * r + along] * jacobian[3 * r + along];
        }
        const double next = offset[along] - slope / square;
        if (!isfinite(next))
            return;
        offset[along] = minimum_number(maximum_number(next, 0), knot[1] - knot[0]);
        ffd_search_evaluate(search, span, offset, at);
    }
}

/* A point of a collapsed face or edge has whole lines of u,v,w. Sets the least of them, without a search. */
static bool is_on_collapse(point_search *search, ffd_location *location)
{
    const ffd_locator *locator = search->locator;
    const collapse_list *list = &locator->cells->collapses;
    for (int i = 0; i < list->count; i++) {
        double uvw[3], offset[3];
        int span[3];
        sample at;
        if (!ffd_collapse_holds(locator, &list->sets[i], search->x, search->tolerance, uvw))
            continue;
        for (int a = 0; a < 3; a++)
            span[a] = ffd_knots_span(&locator->knots[a], uvw[a]);
        for (int a = 0; a < 3; a++)
            offset[a] = uvw[a] - locator->knots[a].t[span[a]];
        ffd_search_evaluate(search, span, offset, &at);
        if (list->sets[i].along >= 0)
            settle_on_curve(search, list->sets[i].along, span, offset, &at);
        if (!ffd_within_tolerance(at.residual, search->tolerance))
            continue;
        for (int a = 0; a < 3; a++)
            uvw[a] = locator->knots[a].t[span[a]] + offset[a];
        location->status = FFD_VERTEX_SINGULAR;
        location->residual = vec_length(at.residual) / locator->cells->scale;
        ffd_locator_report(locator, uvw, location->uvw);
        return true;
    }
    return false;
}

static long hard_boxes_of(const cell_search *cells)
{
    const size_t points = ffd_bezier_count(cells->order);
    const long boxes = (long)(MOST_HARD_BOXES * 64 / points);
    return points <= 64 ? MOST_HARD_BOXES : boxes < LEAST_HARD_BOXES ? LEAST_HARD_BOXES : boxes;
}

/* Returns whether there is a root within `reach` of u,v,w, with F linear. */
static bool is_near_root(point_search *search, const double uvw[3], const double reach[3])
{
    double offset[3], allowed[3];
    int span[3];
    sample at;
    for (int a = 0; a < 3; a++) {
        span[a] = ffd_knots_span(&search->locator->knots[a], uvw[a]);
        offset[a] = uvw[a] - search->locator->knots[a].t[span[a]];
    }
    ffd_search_evaluate(search, span, offset, &at);
    for (int a = 0; a < 3; a++)
        allowed[a] = at.weight * search->tolerance[a];
    return ffd_residual_is_explained(at.equation, at.jacobian, allowed, reach);
}

/* Returns whether there are roots all along the way between two roots, by samples: then the tolerance blurs
   one root. They may be beside the way, by less than a step of it and than the spreads. */
static bool are_joined_by_roots(point_search *search, const root *from, const root *to)
{
    for (int step = 1; step < BLUR_STEPS; step++) {
        const double share = (double)step / BLUR_STEPS;
        double uvw[3], reach[3];
        for (int a = 0; a < 3; a++) {
            uvw[a] = (1 - share) * from->uvw[a] + share * to->uvw[a];
            reach[a] = DBL_EPSILON * uvw[a] + lesser_of(fabs(to->uvw[a] - from->uvw[a]) / BLUR_STEPS,
                                                        larger_of(from->spread[a], to->spread[a]));
        }
        if (!is_near_root(search, uvw, reach))
            return false;
    }
    return true;
}

/* Weights make J change within what the tolerance covers of a thin lattice, so that roots in two leaves may
   be farther apart than their spreads and still be one. */
static void unite_blurred(point_search *search)
{
    root_list *const list = &search->roots;
    for (int i = 0; i < list->count; i++)
        for (int j = list->count - 1; j > i; j--)
            if (are_joined_by_roots(search, &list->roots[i], &list->roots[j]))
                ffd_roots_unite(search->locator, list, i, j);
}

static void search_bricks(point_search *search, ffd_location *location)
{
    ffd_box_tree_visit(&search->locator->cells->brick_tree, search->x, search->slack, visit_brick, search);
    if (search->status)
        return;
    if (search->locator->cells->rational)
        unite_blurred(search);
    ffd_search_judge(search, location);
}

/* Searches again, more thoroughly. The result stays if this leaves the point undecided, unless it was outside
   and there is a root. */
static void search_by_shape(point_search *search, long part, ffd_location *location)
{
    ffd_location second = {.uvw = {NAN, NAN, NAN}};
    search->again = true;
    search->unresolved = search->doubtful = false;
    search->hard_boxes = hard_boxes_of(search->locator->cells) / part;
    search->bricks = 0;
    search->stall_count = search->roots.count = 0;
    search_bricks(search, &second);
    if (!search->status && (!second.unresolved || (search->strict && search->roots.count > 0)))
        *location = second;
}

/* Searches again if stalled iterations leave the point undecided, or if only a doubtful estimate calls it
   outside. Nothing else that the first search decides depends on this. */
static void search_again(point_search *search, ffd_location *location)
{
    if (!search->status && location->status == FFD_VERTEX_SINGULAR && location->unresolved && search->blurred)
        search_by_shape(search, AGAIN_PART, location);
    search->strict = search->doubtful && location->status == FFD_VERTEX_OUTSIDE;
    if (!search->status && search->strict)
        search_by_shape(search, STRICT_PART, location);
}

ffd_status ffd_cells_find(const ffd_locator *locator, const double p[3], search_scratch **scratch,
                          ffd_location *location, ffd_error *error)
{
    const cell_search *cells = locator->cells;
    if (!ffd_search_scratch_make(scratch))
        return ffd_fail_memory(error);
    point_search search = {
        .locator = locator, .scratch = *scratch, .hard_boxes = hard_boxes_of(cells), .error = error};
    if (!ffd_search_set_point(&search, p))
        return FFD_OK;
    if (!is_on_collapse(&search, location)) {
        search_bricks(&search, location);
        search_again(&search, location);
    }
    location->evaluations = search.evaluations;
    location->leaves = search.leaves;
    return search.status;
}
