/* search.c - every u,v,w with C(u,v,w) = p, by the leaves' contraction (maths.md 6.4 to 6.7). Nothing is
   carried from one point to the next but scratch memory. */
#include "base/memory.h"
#include "base/vec.h"
#include "embed/cells.h"
#include "embed/face.h"
#include <math.h>
#include <string.h>

enum { N = BEZIER_COMPONENTS };

/* Bernstein hulls and images carry a few roundings more than a value does: tests against them are this much
   wider than the tolerance. */
#define HULL_SLACK 4
/* Newton steps in one leaf: the certified radius at least halves with each, and 2^-64 is below any rounding.
 */
#define LEAF_STEPS 64
/* Roots of one point that are kept apart; of more, the least by the tie rule are kept. */
#define MOST_ROOTS 16
/* A hard leaf is halved for one point: this often in a row, and so many boxes in all. */
#define HARD_HALVINGS 24
#define HARD_LEVELS (3 * HARD_HALVINGS + 2)
#define HARD_BUDGET 4096
#define HARD_BOUND 0.75
/* Singular boxes that are polished in one hard leaf before the rest of it is left. */
#define HARD_SINGULAR 8

struct search_scratch {
    double *slots;   /* coefficients of a hard leaf's halvings */
    double *numbers; /* of the contraction bound */
};

typedef struct root {
    double uvw[3];
    double residual;
    double determinant;
    double spread[3]; /* how far roots that are one may lie apart, by direction */
    bool singular;
} root;

typedef struct point_search {
    const ffd_locator *locator;
    double p[3], tolerance[3], slack[3];
    search_scratch **scratch;
    root roots[MOST_ROOTS];
    int root_count;
    bool unresolved; /* a box is left in which nothing could be shown */
    uint32_t evaluations, leaves;
    ffd_status status;
    ffd_error *error;
} point_search;

/* C - p and F's derivatives at one u,v,w. */
typedef struct sample {
    double equation[3]; /* F = A - p W */
    double residual[3]; /* C - p = F / W */
    double jacobian[9]; /* of F by u,v,w, row by row */
    double weight;
} sample;

static void evaluate(point_search *search, const int span[3], const double uvw[3], sample *at)
{
    homogeneous value;
    ffd_cells_evaluate(search->locator, span, uvw, &value);
    search->evaluations++;
    at->weight = value.value[3];
    for (int r = 0; r < 3; r++) {
        at->equation[r] = value.value[r] - search->p[r] * value.value[3];
        at->residual[r] = at->equation[r] / value.value[3];
        for (int a = 0; a < 3; a++)
            at->jacobian[3 * r + a] = value.derivative[a][r] - search->p[r] * value.derivative[a][3];
    }
}

static double greatest(const double v[3])
{
    const double x = fabs(v[0]), y = fabs(v[1]), z = fabs(v[2]);
    return x > y ? (x > z ? x : z) : (y > z ? y : z);
}

/* The greatest row of |Y| tolerance: what a rounding of C can do to t. */
static double image_of_tolerance(const double inverse[9], const double tolerance[3], double weight)
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

/* u = lo + t width, never past the region's end. */
static void place(const cell_region *region, const double t[3], double uvw[3])
{
    for (int a = 0; a < 3; a++)
        uvw[a] = region->lo[a] + t[a] * region->width[a];
}

static void evaluate_in(point_search *search, const cell_region *region, const double t[3], sample *at)
{
    double uvw[3];
    place(region, t, uvw);
    evaluate(search, region->span, uvw, at);
    for (int i = 0; i < 9; i++)
        at->jacobian[i] *= region->width[i % 3];
}

/* t + step, clipped to the box. */
static void step_from(const double t[3], const double step[3], double to[3])
{
    for (int a = 0; a < 3; a++)
        to[a] = clip_to_unit(t[a] + step[a]);
}

/* The full Newton step -J^{-1} F by Cramer's rule; false where J is singular. */
static bool newton_step(const sample *at, double step[3])
{
    double inverse[9];
    if (!mat_invert(at->jacobian, inverse))
        return false;
    mat_apply(inverse, at->equation, step);
    for (int a = 0; a < 3; a++)
        step[a] = -step[a];
    return true;
}

static bool accepted(const point_search *search, const sample *at, double weight_ratio)
{
    double tolerance[3];
    for (int a = 0; a < 3; a++)
        tolerance[a] = search->tolerance[a] * weight_ratio;
    return ffd_within_tolerance(at->residual, tolerance);
}

/* A root may lie a rounding outside the box: the clipped coordinates stay on their face, the others are
   solved for again by least squares (the closest point of the face). Two steps suffice from a rounding away.
 */
static void settle_on_face(point_search *search, const cell_region *region, double t[3], sample *at)
{
    for (int round = 0; round < 2; round++) {
        if (!ffd_face_step(at->jacobian, at->equation, search->tolerance, t))
            return;
        evaluate_in(search, region, t, at);
    }
}

/* Roots */

/* -1, 0, 1 as a comes before, with or after b by (u,v,w). */
static int compare_places(const double a[3], const double b[3])
{
    for (int i = 0; i < 3; i++)
        if (a[i] != b[i])
            return a[i] < b[i] ? -1 : 1;
    return 0;
}

/* The tie rule: the sign of the lattice's volume first, then the least (u,v,w). */
static bool is_preferred(const point_search *search, const root *a, const root *b)
{
    const double sign = search->locator->cells->volume_sign;
    const bool a_agrees = a->determinant * sign > 0, b_agrees = b->determinant * sign > 0;
    if (a_agrees != b_agrees)
        return a_agrees;
    return compare_places(a->uvw, b->uvw) < 0;
}

static bool are_one(const point_search *search, const root *a, const root *b)
{
    for (int d = 0; d < 3; d++) {
        const knot_vector *knots = &search->locator->knots[d];
        const double side = ffd_knots_last(knots) - ffd_knots_first(knots);
        double apart = fabs(a->uvw[d] - b->uvw[d]);
        if (ffd_knots_closed(knots) && apart > 0.5 * side)
            apart = side - apart;
        if (apart > fmax(1e-9 * side, fmax(a->spread[d], b->spread[d])))
            return false;
    }
    return true;
}

static void add_root(point_search *search, const root *found)
{
    root *roots = search->roots;
    for (int i = 0; i < search->root_count; i++)
        if (are_one(search, &roots[i], found)) {
            /* A face shared by leaves: keep the better of the two; what is singular stays so. */
            const bool singular = roots[i].singular || found->singular;
            if (found->residual < roots[i].residual ||
                (found->residual == roots[i].residual && compare_places(found->uvw, roots[i].uvw) < 0))
                roots[i] = *found;
            roots[i].singular = singular;
            return;
        }
    if (search->root_count < MOST_ROOTS) {
        roots[search->root_count++] = *found;
        return;
    }
    int last = 0;
    for (int i = 1; i < MOST_ROOTS; i++)
        if (is_preferred(search, &roots[last], &roots[i]))
            last = i;
    if (is_preferred(search, found, &roots[last]))
        roots[last] = *found;
}

/* Records the root at t, whose sample is `at`. */
static void record(point_search *search, const cell_region *region, const double t[3], const sample *at,
                   bool singular)
{
    root found = {.singular = singular};
    double inverse[9], column[3][3], cross[3];
    place(region, t, found.uvw);
    for (int a = 0; a < 3; a++) {
        const knot_vector *knots = &search->locator->knots[a];
        found.uvw[a] = ffd_knots_wrap(knots, found.uvw[a]);
    }
    found.residual = vec_length(at->residual);
    for (int a = 0; a < 3; a++)
        for (int r = 0; r < 3; r++)
            column[a][r] = at->jacobian[3 * r + a];
    vec_cross(column[1], column[2], cross);
    found.determinant = vec_dot(column[0], cross);
    if (!(fabs(found.determinant) >
          16 * DBL_EPSILON * vec_length(column[0]) * vec_length(column[1]) * vec_length(column[2])))
        found.singular = true;
    if (mat_invert(at->jacobian, inverse))
        for (int a = 0; a < 3; a++) {
            const double *row = inverse + 3 * a;
            found.spread[a] = 4 * region->width[a] * at->weight *
                              (fabs(row[0]) * search->tolerance[0] + fabs(row[1]) * search->tolerance[1] +
                               fabs(row[2]) * search->tolerance[2]);
        }
    add_root(search, &found);
}

/* Leaves */

/* Finds the region's root or shows that it has none. e bounds |t - root| throughout, if there is a root: Y F
   contracts distances from it by L, clipping does not lengthen them, and any t has |Y F(t)| between (1-L) and
   (1+L) times its distance (maths.md 6.4). */
static void search_region(point_search *search, const cell_region *region)
{
    const double noise = image_of_tolerance(region->inverse, search->tolerance, region->greatest_weight);
    const double bound = region->bound, least = fmax(1e-12, 4 * noise);
    double t[3] = {0.5, 0.5, 0.5}, e = 0.5, image[3], step[3], next[3];
    sample at, ahead;
    evaluate_in(search, region, t, &at);
    for (int i = 0; i < LEAF_STEPS; i++) {
        if (accepted(search, &at, region->weight_ratio)) {
            record(search, region, t, &at, false);
            return;
        }
        mat_apply(region->inverse, at.equation, image);
        if (!(greatest(image) <= (1 + bound) * e + noise))
            return; /* also where a value is not finite */
        const double shorter = bound * e + noise;
        double radius = shorter;
        bool kept = false;
        if (newton_step(&at, step)) {
            double ahead_image[3];
            step_from(t, step, next);
            evaluate_in(search, region, next, &ahead);
            mat_apply(region->inverse, ahead.equation, ahead_image);
            radius = (greatest(ahead_image) + noise) / (1 - bound);
            kept = radius <= shorter || accepted(search, &ahead, region->weight_ratio);
        }
        if (!kept) {
            for (int a = 0; a < 3; a++)
                step[a] = -image[a];
            step_from(t, step, next);
            evaluate_in(search, region, next, &ahead);
            radius = shorter;
        }
        const bool stands = compare_places(t, next) == 0;
        memcpy(t, next, sizeof t);
        at = ahead;
        e = radius > least ? radius : least;
        if (stands)
            break;
    }
    settle_on_face(search, region, t, &at);
    if (accepted(search, &at, region->weight_ratio))
        record(search, region, t, &at, false);
}

/* Hard leaves: halved for this point alone. */

static bool make_scratch(point_search *search)
{
    if (*search->scratch)
        return true;
    const int *order = search->locator->cells->order;
    search_scratch *made = ffd_alloc_zero(1, sizeof *made);
    if (made) {
        made->slots = ffd_alloc(HARD_LEVELS + 1, ffd_bezier_size(order) * sizeof(double));
        made->numbers = ffd_alloc(3 * ffd_bezier_count(order), sizeof(double));
    }
    if (made && made->slots && made->numbers) {
        *search->scratch = made;
        return true;
    }
    ffd_search_scratch_free(made);
    search->status = ffd_fail_memory(search->error);
    return false;
}

void ffd_search_scratch_free(search_scratch *scratch)
{
    if (!scratch)
        return;
    ffd_free(scratch->slots);
    ffd_free(scratch->numbers);
    ffd_free(scratch);
}

/* A box too small to halve further, where J is singular or nearly so. Levenberg's damping lets the direction
   that J cannot see rest and takes the others to the solution. */
static bool polish(point_search *search, const cell_region *region)
{
    double t[3] = {0.5, 0.5, 0.5};
    sample at;
    evaluate_in(search, region, t, &at);
    for (int round = 0; round < 12; round++) {
        if (accepted(search, &at, region->weight_ratio)) {
            record(search, region, t, &at, true);
            return true;
        }
        double normal[9], gradient[3], inverse[9], step[3], trace = 0;
        const double *j = at.jacobian;
        for (int r = 0; r < 3; r++) {
            gradient[r] = -(j[r] * at.equation[0] + j[3 + r] * at.equation[1] + j[6 + r] * at.equation[2]);
            for (int c = 0; c < 3; c++)
                normal[3 * r + c] = j[r] * j[c] + j[3 + r] * j[3 + c] + j[6 + r] * j[6 + c];
            trace += normal[4 * r];
        }
        for (int r = 0; r < 3; r++)
            normal[4 * r] += 1e-9 * trace;
        if (!mat_invert(normal, inverse))
            return false;
        mat_apply(inverse, gradient, step);
        step_from(t, step, t);
        evaluate_in(search, region, t, &at);
    }
    return false;
}

typedef struct hard_search {
    point_search *search;
    int span[3];
    int budget, singular;
} hard_search;

static bool holds_zero(const bounds *box, const double slack[3])
{
    static const double zero[3] = {0, 0, 0};
    return bounds_hold(box, zero, slack);
}

static void halve_for_point(hard_search *hard, bezier_box *box, int level)
{
    point_search *search = hard->search;
    const ffd_locator *locator = search->locator;
    static const double no_reach[3] = {0, 0, 0};
    double least, most, slack[3];
    if (hard->budget-- <= 0) {
        search->unresolved = true;
        return;
    }
    if (hard->singular >= HARD_SINGULAR)
        return;
    ffd_bezier_weights(box, &least, &most);
    for (int a = 0; a < 3; a++)
        slack[a] = search->slack[a] * most;
    bounds hull = ffd_bezier_equation_hull(box, search->p);
    if (!holds_zero(&hull, slack))
        return;

    contraction_bound found;
    cell_region region;
    ffd_bezier_contraction(box, search->p, no_reach, (*search->scratch)->numbers, &found);
    ffd_cell_region(locator, hard->span, box, &found, &region);
    if (found.regular) {
        const double noise = image_of_tolerance(found.inverse, slack, 1);
        const double image_slack[3] = {noise, noise, noise};
        hull = ffd_bezier_image(box, found.inverse, search->p);
        if (!holds_zero(&hull, image_slack))
            return;
        if (found.bound <= HARD_BOUND) {
            search_region(search, &region);
            return;
        }
    }
    const double end = ldexp(1, -HARD_HALVINGS);
    int across = found.halve;
    if (box->hi[across] - box->lo[across] <= end)
        for (int a = 0; a < 3; a++)
            if (box->hi[a] - box->lo[a] > box->hi[across] - box->lo[across])
                across = a;
    if (box->hi[across] - box->lo[across] <= end) {
        if (polish(search, &region))
            hard->singular++;
        else
            search->unresolved = true;
        return;
    }
    bezier_box lower = {.coefficients =
                            (*search->scratch)->slots + (size_t)(level + 1) * ffd_bezier_size(box->order)};
    bezier_box upper = {.coefficients = box->coefficients};
    ffd_bezier_halve(box, across, &lower, &upper);
    halve_for_point(hard, &lower, level + 1);
    halve_for_point(hard, &upper, level + 1);
}

/* Cuts box down to the part [lo, hi] of its cell, both reached by halving. */
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

static void search_hard_leaf(point_search *search, const cell_leaf *leaf)
{
    const ffd_lattice *lattice = search->locator->lattice;
    if (!make_scratch(search))
        return;
    hard_search hard = {.search = search, .budget = HARD_BUDGET};
    bezier_box box = {.coefficients = (*search->scratch)->slots};
    size_t cell[3];
    for (int a = 0; a < 3; a++) {
        hard.span[a] = leaf->region.span[a];
        cell[a] = 0;
        while (lattice->knots[a].spans[cell[a]] != hard.span[a])
            cell[a]++;
    }
    ffd_cell_bezier(search->locator, cell, &box);
    restrict_to_part(&box, leaf->part_lo, leaf->part_hi,
                     (*search->scratch)->slots + ffd_bezier_size(box.order));
    halve_for_point(&hard, &box, 0);
}

/* Whether Y (C - p) can be 0 in the leaf: p's image against that of the leaf's control points. */
static bool image_holds(const point_search *search, const cell_leaf *leaf)
{
    if (search->locator->cells->rational)
        return true;
    double image[3];
    mat_apply(leaf->region.inverse, search->p, image);
    const double noise = image_of_tolerance(leaf->region.inverse, search->slack, 1);
    const double slack[3] = {noise, noise, noise};
    return bounds_hold(&leaf->image, image, slack);
}

typedef struct brick_visit {
    point_search *search;
    const cell_brick *brick;
} brick_visit;

static bool visit_leaf(void *context, uint32_t number)
{
    const brick_visit *visit = context;
    point_search *search = visit->search;
    const cell_leaf *leaf = &visit->brick->leaves[number];
    if (!bounds_hold(&leaf->hull, search->p, search->slack))
        return true;
    if (leaf->hard) {
        search->leaves++;
        search_hard_leaf(search, leaf);
    } else if (image_holds(search, leaf)) {
        search->leaves++;
        search_region(search, &leaf->region);
    }
    return search->status == FFD_OK;
}

static bool visit_brick(void *context, uint32_t number)
{
    point_search *search = context;
    const cell_search *cells = search->locator->cells;
    if (!bounds_hold(&cells->brick_hulls[number], search->p, search->slack))
        return true;
    brick_visit visit = {.search = search};
    search->status = ffd_cells_brick(search->locator, number, &visit.brick, search->error);
    if (search->status)
        return false;
    return ffd_box_tree_visit(&visit.brick->tree, search->p, search->slack, visit_leaf, &visit);
}

/* Where the lattice collapses (a cylinder's axis), one point has whole lines of u,v,w. Of a singular root
   each coordinate in turn goes to the domain's start if that is a root too: the least (u,v,w) of such a line.
 */
static void take_least_of_set(point_search *search, root *found)
{
    const knot_vector *knots = search->locator->knots;
    for (int a = 0; a < 3; a++) {
        double uvw[3];
        int span[3];
        sample at;
        memcpy(uvw, found->uvw, sizeof uvw);
        uvw[a] = ffd_knots_first(&knots[a]);
        for (int b = 0; b < 3; b++)
            span[b] = ffd_knots_span(&knots[b], uvw[b]);
        evaluate(search, span, uvw, &at);
        if (accepted(search, &at, 1)) {
            found->uvw[a] = uvw[a];
            found->residual = vec_length(at.residual);
        }
    }
}

static void judge(point_search *search, ffd_location *location)
{
    for (int i = 0; i < search->root_count; i++)
        if (search->roots[i].singular)
            take_least_of_set(search, &search->roots[i]);
    location->evaluations = search->evaluations;
    location->leaves = search->leaves;
    if (search->root_count == 0) {
        location->status = search->unresolved ? FFD_SINGULAR : FFD_OUTSIDE;
        return;
    }
    const root *best = &search->roots[0];
    bool regular = !best->singular;
    for (int i = 1; i < search->root_count; i++) {
        regular = regular || !search->roots[i].singular;
        if (is_preferred(search, &search->roots[i], best))
            best = &search->roots[i];
    }
    /* Several singular roots are a root set that the halving met more than once. */
    if (search->root_count > 1 && regular)
        location->status = FFD_MULTIPLE;
    else
        location->status = best->singular || search->unresolved ? FFD_SINGULAR : FFD_INSIDE;
    location->residual = best->residual;
    ffd_locator_report(search->locator, best->uvw, location->uvw);
}

ffd_status ffd_cells_find(const ffd_locator *locator, const double p[3], search_scratch **scratch,
                          ffd_location *location, ffd_error *error)
{
    point_search search = {.locator = locator, .scratch = scratch, .error = error};
    memcpy(search.p, p, sizeof search.p);
    ffd_locator_tolerance(locator, p, search.tolerance);
    for (int a = 0; a < 3; a++)
        search.slack[a] = HULL_SLACK * search.tolerance[a];
    ffd_box_tree_visit(&locator->cells->brick_tree, p, search.slack, visit_brick, &search);
    if (!search.status)
        judge(&search, location);
    return search.status;
}
