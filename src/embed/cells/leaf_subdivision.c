/* leaf_subdivision.c - hard leaves, without a contraction bound, near folds and collapses: subdivided for a
   single point (src/maths.md 6.5). */
#include "embed/cells/leaf_subdivision.h"
#include "base/memory/memory.h"
#include "base/vector/vec.h"
#include "embed/cells/leaf.h"
#include "embed/cells/region_root.h"
#include "embed/cells/tolerance_image.h"
#include "embed/frame/face.h"
#include <string.h>

/* The most halvings of a box in each direction, unless the tolerance makes its parts indistinguishable
   before: next to a collapsed face one direction must be divided as finely as doubles allow. */
#define HARD_HALVINGS 48
#define HARD_LEVELS (3 * HARD_HALVINGS + 2)
/* Only boxes of at most this side can be blurred: Y of a larger box can be large by chance, if its centre is
   on a fold. */
#define BLURRED_SIDE 0x1p-22
#define HARD_BUDGET 4096 /* boxes in a leaf */
#define HARD_BOUND 0.75
/* If the tolerance is as large as half of a box, halving it gives no information. */
#define MOST_BLUR 64
/* The same in a search for a root of a point that otherwise stays outside: smaller boxes show no more. */
#define STRICT_BLUR 1
/* PART_LEVELS: halvings of a region in which the iteration stalled. */
#define PART_LEVELS 16
#define POLISH_ROUNDS 12
/* A u,v,w with a greater residual, in the search's units, is not accepted; the lattice has a size of about 1
   there. */
#define LARGEST_MISS 1e-6
/* The most singular boxes that are polished in a hard leaf before the rest of it is dropped. */
#define HARD_SINGULAR 8
/* The most boxes that are polished in a hard leaf after its budget is used up. */
#define MOST_LEFT 16

static bool make_memory(point_search *search)
{
    const int *order = search->locator->cells->order;
    search_scratch *scratch = search->scratch;
    if (!scratch->slots)
        scratch->slots = ffd_alloc(HARD_LEVELS + 1, ffd_bezier_size(order) * sizeof(double));
    if (!scratch->columns)
        scratch->columns = ffd_alloc(3 * ffd_bezier_size(order), sizeof(double));
    if (scratch->slots && scratch->columns)
        return true;
    search->status = ffd_fail_memory(search->error);
    return false;
}

/* Makes a damped step (Levenberg): no movement in the null direction of J, a Newton step in the others. */
static bool damped_step(const double jacobian[9], const double equation[3], double step[3])
{
    double normal[9], gradient[3], inverse[9], trace = 0;
    const double *j = jacobian;
    for (int r = 0; r < 3; r++) {
        gradient[r] = -(j[r] * equation[0] + j[3 + r] * equation[1] + j[6 + r] * equation[2]);
        for (int c = 0; c < 3; c++)
            normal[3 * r + c] = j[r] * j[c] + j[3 + r] * j[3 + c] + j[6 + r] * j[6 + c];
        trace += normal[4 * r];
    }
    for (int r = 0; r < 3; r++)
        normal[4 * r] += 1e-9 * trace;
    if (!mat_invert(normal, inverse))
        return false;
    mat_apply(inverse, gradient, step);
    return true;
}

/* Makes a step, damped if necessary. Returns false if there is none. */
static bool polishing_step(const point_search *search, const sample *at, bool full, double t[3])
{
    double jacobian[9], equation[3], step[3];
    if (!ffd_weigh_rows(at->jacobian, at->equation, search->tolerance, jacobian, equation))
        return false;
    if (!(full && newton_step(jacobian, equation, step)) && !damped_step(jacobian, equation, step))
        return false;
    for (int a = 0; a < 3; a++)
        t[a] = clip_to_unit(t[a] + step[a]);
    return true;
}

static void note_stall(point_search *search, const cell_region *region, const double t[3], const sample *at)
{
    root stall;
    ffd_search_stall(search, region, t, at, &stall);
    ffd_search_note_stall(search, &stall);
}

/* Handles a box that is not halved further, where J is singular or nearly so: Newton steps as long as
   possible, then damped ones. Returns whether there is a root; otherwise records the best point. */
static bool polish(point_search *search, const cell_region *region)
{
    double t[3] = {0.5, 0.5, 0.5}, best_t[3], least = HUGE_VAL;
    sample at, best = {.weight = 1};
    for (int round = 0; round <= POLISH_ROUNDS; round++) {
        ffd_search_evaluate_in(search, region, t, &at);
        if (ffd_search_accepts(search, region, t, &at)) {
            ffd_search_record(search, region, t, &at, true);
            return true;
        }
        if (round == 0 || vec_length(at.residual) < least) {
            least = vec_length(at.residual);
            best = at;
            memcpy(best_t, t, sizeof t);
        }
        if (round < POLISH_ROUNDS && !polishing_step(search, &at, round < POLISH_ROUNDS / 2, t))
            break;
    }
    const bool admitted = ffd_search_admits(search, region, best_t, &best);
    if (admitted)
        ffd_search_record(search, region, best_t, &best, true);
    else if (least <= LARGEST_MISS)
        note_stall(search, region, best_t, &best);
    else
        search->unresolved = true;
    return admitted;
}

typedef struct hard_search {
    point_search *search;
    int span[3];
    int budget, singular;
    int left; /* boxes that were dropped without being examined, of which a few are polished */
    int most_levels;
} hard_search;

static const contraction_kernel *kernel_of(const hard_search *hard)
{
    return hard->search->locator->cells->contraction;
}

static bool holds_zero(const bounds *box, const double slack[3])
{
    static const double zero[3] = {0, 0, 0};
    return bounds_hold(box, zero, slack);
}

/* Returns the direction to halve: the one that the contraction bound suggests or, if that is short enough
   already, the longest; -1 if all are short enough. */
static int direction_to_halve(const bezier_box *box, int wanted)
{
    const double end = ldexp(1, -HARD_HALVINGS);
    int across = wanted;
    if (box->hi[across] - box->lo[across] <= end)
        for (int a = 0; a < 3; a++)
            if (box->hi[a] - box->lo[a] > box->hi[across] - box->lo[across])
                across = a;
    return box->hi[across] - box->lo[across] <= end ? -1 : across;
}

static double shortest_side(const bezier_box *box)
{
    double shortest = 1;
    for (int a = 0; a < 3; a++)
        shortest = minimum_number(shortest, box->hi[a] - box->lo[a]);
    return shortest;
}

/* Searches a region with a contraction bound. Returns false if it must be halved. */
static bool settle_region(hard_search *hard, const cell_region *region, double noise, int level)
{
    point_search *const search = hard->search;
    root stall;
    if (ffd_search_region(search, region, &stall))
        return true;
    if (noise < MOST_BLUR && level < hard->most_levels)
        return false;
    search->blurred = true;
    ffd_search_note_stall(search, &stall);
    return true;
}

/* The same in a further search, which looks at the shape of the tolerance's image and not at its size. */
static bool settle_by_shape(hard_search *hard, const cell_region *region, const tolerance_view *view,
                            int level)
{
    point_search *const search = hard->search;
    double t[3] = {0.5, 0.5, 0.5};
    sample at;
    root stall;
    if (ffd_search_region(search, region, &stall))
        return true;
    if (ffd_tolerance_find(search, region, t, &at)) {
        ffd_search_record(search, region, t, &at, false);
        return true;
    }
    if (view->blur < (search->strict ? STRICT_BLUR : MOST_BLUR) && level < hard->most_levels)
        return false;
    ffd_search_note_stall(search, &stall);
    return true;
}

/* Settles a box with a regular J at the centre. noise: the size of the image of the tolerance. Results as for
   settle_box. */
static bool settle_regular(hard_search *hard, const bezier_box *box, cell_region *region, double noise,
                           int level, bool *blurred)
{
    point_search *const search = hard->search;
    tolerance_view view = {.blur = noise};
    if (search->again) {
        ffd_cells_centre(search->locator, region);
        view = ffd_tolerance_view(search, region, box);
        if (view.misses)
            return true;
    }
    if (region->bound > HARD_BOUND) {
        *blurred = view.blur >= 0.5 && shortest_side(box) <= BLURRED_SIDE;
        search->blurred = search->blurred || *blurred;
        return false;
    }
    if (!search->again)
        ffd_cells_centre(search->locator, region);
    search->evaluations++;
    return search->again ? settle_by_shape(hard, region, &view, level)
                         : settle_region(hard, region, noise, level);
}

/* Returns whether the box is finished: it has no root, or its only root was searched. Otherwise *blurred says
   whether its halves could not be distinguished, because the tolerance is as large as half of the box. */
static bool settle_box(hard_search *hard, const bezier_box *box, int level, contraction_bound *found,
                       cell_region *region, bool *blurred)
{
    static const double no_reach[3] = {0, 0, 0};
    point_search *search = hard->search;
    double least, most, slack[3];
    ffd_bezier_weights(box, &least, &most);
    for (int a = 0; a < 3; a++)
        slack[a] = search->slack[a] * most;
    *blurred = false;
    bounds hull = ffd_bezier_equation_hull(box, search->x);
    if (!holds_zero(&hull, slack))
        return true;
    kernel_of(hard)->find_bound(box, search->x, no_reach, search->scratch->columns, found);
    ffd_cell_region(search->locator, hard->span, box, found, region);
    if (!found->regular)
        return false;
    const double noise = ffd_image_of_tolerance(found->inverse, slack, 1);
    const double image_slack[3] = {noise, noise, noise};
    hull = ffd_bezier_image(box, found->inverse, search->x);
    if (!holds_zero(&hull, image_slack))
        return true;
    return settle_regular(hard, box, region, noise, level, blurred);
}

/* Drops a box. The first few dropped boxes are polished, so that the point gets at least a u,v,w. */
static void leave_box(hard_search *hard, const bezier_box *box)
{
    static const contraction_bound unknown = {.bound = HUGE_VAL};
    cell_region region;
    hard->search->unresolved = true;
    if (hard->singular >= HARD_SINGULAR || hard->left++ >= MOST_LEFT)
        return;
    ffd_cell_region(hard->search->locator, hard->span, box, &unknown, &region);
    if (polish(hard->search, &region))
        hard->left = MOST_LEFT;
}

static void halve_for_point(hard_search *hard, bezier_box *box, int level)
{
    point_search *search = hard->search;
    contraction_bound found;
    cell_region region;
    bool blurred;
    if (hard->singular >= HARD_SINGULAR || hard->budget-- <= 0 || search->hard_boxes-- <= 0) {
        leave_box(hard, box);
        return;
    }
    if (settle_box(hard, box, level, &found, &region, &blurred))
        return;
    const int across =
        blurred
            ? -1
            : direction_to_halve(box, kernel_of(hard)->find_halving(box, &found, search->scratch->columns));
    if (across < 0) {
        if (polish(search, &region))
            hard->singular++;
        return;
    }
    bezier_box lower = {.coefficients =
                            search->scratch->slots + (size_t)(level + 1) * ffd_bezier_size(box->order)};
    bezier_box upper = {.coefficients = box->coefficients};
    ffd_bezier_halve(box, across, &lower, &upper);
    halve_for_point(hard, &lower, level + 1);
    halve_for_point(hard, &upper, level + 1);
}

/* Restricts a box to the part [lo, hi] of its cell, both multiples of powers of 1/2. */
static void restrict_to_part(bezier_box *box, const double lo[3], const double hi[3], double *spare)
{
    for (int a = 0; a < 3; a++)
        while (box->lo[a] < lo[a] || box->hi[a] > hi[a]) {
            bezier_box lower = {.coefficients = spare}, upper = {.coefficients = box->coefficients};
            ffd_bezier_halve(box, a, &lower, &upper);
            if (lo[a] < lower.hi[a]) {
                memcpy(upper.coefficients, lower.coefficients, ffd_bezier_size(box->order) * sizeof(double));
                lower.coefficients = upper.coefficients;
                *box = lower;
            } else {
                *box = upper;
            }
        }
}

static void search_part(point_search *search, const int span[3], const double lo[3], const double hi[3],
                        int most_levels)
{
    const ffd_lattice *lattice = search->locator->lattice;
    if (!make_memory(search))
        return;
    hard_search hard = {.search = search, .budget = HARD_BUDGET, .most_levels = most_levels};
    bezier_box box = {.coefficients = search->scratch->slots};
    size_t cell[3];
    for (int a = 0; a < 3; a++) {
        hard.span[a] = span[a];
        cell[a] = 0;
        while (lattice->knots[a].spans[cell[a]] != span[a])
            cell[a]++;
    }
    ffd_cell_bezier(search->locator, cell, &box);
    restrict_to_part(&box, lo, hi, search->scratch->slots + ffd_bezier_size(box.order));
    halve_for_point(&hard, &box, 0);
}

void ffd_search_hard_leaf(point_search *search, const cell_leaf *leaf)
{
    search_part(search, leaf->region.span, leaf->part.lo, leaf->part.hi, HARD_LEVELS);
}

void ffd_search_part(point_search *search, const cell_region *region)
{
    double lo[3], hi[3];
    for (int a = 0; a < 3; a++) {
        /* Number of halvings of the cell, which the rounding of lo and width does not affect. */
        const double *knot = search->locator->knots[a].t + region->span[a], side = knot[1] - knot[0];
        lo[a] = ldexp(nearest_integer(ldexp(region->lo[a] / side, LEAF_DEPTH)), -LEAF_DEPTH);
        hi[a] = lo[a] + ldexp(nearest_integer(ldexp(region->width[a] / side, LEAF_DEPTH)), -LEAF_DEPTH);
    }
    search_part(search, region->span, lo, hi, search->again ? HARD_LEVELS : PART_LEVELS);
}
