#include "fold/cell.h"
#include "base/memory.h"
#include "fold/bernstein.h"
#include "fold/determinant.h"
#include "fold/regular.h"
#include <string.h>

#define UNIT (0.5 * DBL_EPSILON)
#define CELL_DEPTH 12      /* halvings of a cell before a box is left open */
#define CELL_BOXES 2048    /* boxes looked at in one cell, if cubic */
#define LEAST_BOXES 64     /* however large the boxes are */
#define DETERMINANT_COST 8 /* that of a cell's coefficients, in boxes */

/* A part of the cell. Slots belong to the depth of the search. */
typedef struct box {
    double lo[3], hi[3];
    double *coefficients; /* of sign det J, with weights of sign W^4 det J */
    double *weights;      /* of W; NULL without weights */
    double rounding;      /* of each coefficient */
} box;

struct fold_scratch {
    double *block;
    double *working;                /* for forms, determinants and restrictions, one after the other */
    double *rows, *rest_rows;       /* of the forms */
    double *rest_whole, *rest_part; /* coefficients of the rest volume, of the cell and of one box */
    double *coefficients[CELL_DEPTH + 1], *weights[CELL_DEPTH + 1];
};

typedef struct cell_search {
    const fold_plan *plan;
    fold_scratch *scratch;
    size_t index[3];
    bool rational;
    int order[3], weight_order[3];
    scaled unit; /* of the deformed cell's determinant, relative to the mean of the rest volume's */
    cell_form form;
    determinant_bounds bounds;
    double greatest;      /* coefficient of the whole cell, in size */
    bool on_border[3][2]; /* the cell touches this end of the domain */
    bool has_rest;        /* the three below are made when a box needs them */
    determinant_bounds rest_bounds;
    double rest_greatest;
    bool refining;
    long boxes;         /* that may still be looked at */
    double whole_lower; /* the bound that the whole cell's coefficients give */
    cell_verdict result;
} cell_search;

static size_t larger(size_t a, size_t b)
{
    return a > b ? a : b;
}

fold_scratch *ffd_fold_scratch_create(const fold_plan *plan)
{
    const bool rational = plan->rational;
    int order[3];
    ffd_determinant_order(plan->order, rational, order);
    const size_t large = ffd_bernstein_count(order), rows = ffd_cell_form_size(plan->order, rational),
                 weights = rational ? ffd_bernstein_count(plan->order) : 0;
    const size_t working = larger(
        large, larger(ffd_cell_form_scratch(plan->order), ffd_determinant_scratch(plan->order, rational)));
    const size_t total = working + 2 * rows + (CELL_DEPTH + 3) * large + (CELL_DEPTH + 1) * weights;
    fold_scratch *scratch = ffd_alloc_zero(1, sizeof *scratch);
    if (!scratch)
        return NULL;
    double *next = scratch->block = ffd_alloc(total, sizeof(double));
    if (!next) {
        ffd_free(scratch);
        return NULL;
    }
    scratch->working = next;
    scratch->rows = next += working;
    scratch->rest_rows = next += rows;
    scratch->rest_whole = next += rows;
    scratch->rest_part = next += large;
    for (int depth = 0; depth <= CELL_DEPTH; depth++)
        scratch->coefficients[depth] = next += large;
    next += large;
    for (int depth = 0; depth <= CELL_DEPTH && rational; depth++, next += weights)
        scratch->weights[depth] = next;
    return scratch;
}

void ffd_fold_scratch_destroy(fold_scratch *scratch)
{
    if (!scratch)
        return;
    ffd_free(scratch->block);
    ffd_free(scratch);
}

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

double ffd_fold_target(double least_seen)
{
    return least_seen - 0.01 * fabs(least_seen);
}

/* Relative figures */

/* A value of the scaled cell; of W^4 det J with this W. */
static double relative_value(const cell_search *search, double value, double weight)
{
    return scaled_apply(value / (weight * weight * weight * weight), search->unit);
}

/* A lower bound stays one: the mean is known to a doubt only. */
static double relative_lower(const cell_search *search, double value, double least_weight,
                             double greatest_weight)
{
    const double doubt = search->plan->volume.doubt + 64 * UNIT;
    const double result = relative_value(search, value, value > 0 ? greatest_weight : least_weight);
    return result > 0 ? result * (1 - doubt) : result * (1 + 2 * doubt);
}

static void see(cell_search *search, double relative)
{
    if (relative < search->result.least_seen)
        search->result.least_seen = relative;
}

static void lower_to(cell_search *search, double relative)
{
    if (!(relative >= search->result.lower))
        search->result.lower = relative;
}

static void set_folded(cell_search *search, const double place[3], double relative)
{
    search->result.verdict = FFD_FOLDS_SOME;
    for (int a = 0; a < 3; a++)
        search->result.place[a] = place[a];
    search->result.value = relative < 0 ? relative : 0;
    see(search, search->result.value);
}

static scaled unit_of(const fold_plan *plan, const size_t index[3], int exponent)
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
    search->unit = unit_of(plan, search->index, search->form.exponent);
    search->result.least_seen = DBL_MAX;
    search->result.lower = DBL_MAX;
}

/* Coefficients */

static double greatest_size(const double *values, size_t count)
{
    double greatest = 0;
    for (size_t i = 0; i < count; i++)
        greatest = fabs(values[i]) > greatest ? fabs(values[i]) : greatest;
    return greatest;
}

static void make_box(cell_search *search, box *whole)
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
    search->greatest = greatest_size(whole->coefficients, ffd_bernstein_count(search->order));
    if (search->rational) {
        whole->weights = scratch->weights[0];
        memcpy(whole->weights, search->form.row[3][3],
               ffd_bernstein_count(search->weight_order) * sizeof(double));
    }
    search->boxes -= DETERMINANT_COST;
}

/* The lower half of `whole` into the next depth's slot; whole becomes the upper half. */
static void halve(const cell_search *search, box *whole, int a, int depth, box *lower)
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

/* Zeros that the rest volume has on the border */

/* The rest volume's coefficients over the box, and the roundings of halving to it. */
static double make_rest(cell_search *search, const box *part)
{
    fold_scratch *scratch = search->scratch;
    const size_t count = ffd_bernstein_count(search->order);
    if (!search->has_rest) {
        cell_form form;
        ffd_cell_form_make(search->plan, FFD_VOLUME_REST, search->index, search->rational, scratch->rest_rows,
                           scratch->working, &form);
        ffd_determinant_bounds(&form, &search->rest_bounds);
        ffd_determinant_coefficients(&form, search->plan->volume.sign, scratch->working, scratch->rest_whole);
        search->rest_greatest = greatest_size(scratch->rest_whole, count);
        search->has_rest = true;
        search->boxes -= DETERMINANT_COST;
    }
    memcpy(scratch->rest_part, scratch->rest_whole, count * sizeof(double));
    ffd_bernstein_restrict(scratch->rest_part, search->order, part->lo, part->hi, scratch->working);
    search->boxes--;
    return CELL_DEPTH * BERNSTEIN_MAX_ORDER * UNIT * search->rest_greatest;
}

/* Whether a coefficient's index is one of the first two from an end of the domain. */
static bool is_at_border(const bool touches[3][2], const int order[3], const int at[3])
{
    for (int a = 0; a < 3; a++)
        if ((touches[a][0] && at[a] <= 1) || (touches[a][1] && at[a] >= order[a] - 2))
            return true;
    return false;
}

/* What the coefficients of a box say. */
typedef struct box_view {
    double least, greatest; /* coefficient that is no zero of the rest volume's */
    int at[3];              /* of least */
    bool has_zeros;         /* some are zeros that the rest volume has too */
    bool corner_is_zero[8]; /* among them these */
    double least_weight, greatest_weight;
} box_view;

static int corner_of(const int order[3], const int at[3])
{
    int corner = 0;
    for (int a = 0; a < 3; a++) {
        if (at[a] == order[a] - 1)
            corner |= 1 << a;
        else if (at[a] != 0)
            return -1;
    }
    return corner;
}

/* rest: the rest volume's coefficients, or NULL where no zeros are looked for. */
static void scan(const cell_search *search, const box *part, const bool touches[3][2], const double *rest,
                 double rest_rounding, box_view *view)
{
    const int *order = search->order;
    const double coarse = search->bounds.coarse + (part->rounding - search->bounds.rounding);
    const double rest_coarse = search->rest_bounds.coarse + rest_rounding;
    const double *c = part->coefficients;
    int at[3];
    view->least = DBL_MAX;
    view->greatest = -DBL_MAX;
    view->at[0] = view->at[1] = view->at[2] = 0;
    view->has_zeros = false;
    memset(view->corner_is_zero, 0, sizeof view->corner_is_zero);
    for (at[2] = 0; at[2] < order[2]; at[2]++)
        for (at[1] = 0; at[1] < order[1]; at[1]++)
            for (at[0] = 0; at[0] < order[0]; at[0]++, c++) {
                if (rest && fabs(*c) <= coarse && is_at_border(touches, order, at) &&
                    fabs(rest[c - part->coefficients]) <= rest_coarse) {
                    const int corner = corner_of(order, at);
                    view->has_zeros = true;
                    if (corner >= 0)
                        view->corner_is_zero[corner] = true;
                    continue;
                }
                view->greatest = *c > view->greatest ? *c : view->greatest;
                if (*c < view->least) {
                    view->least = *c;
                    memcpy(view->at, at, sizeof at);
                }
            }
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
    /* All positive: the relative rounding of what led to them is far less. */
    view->least_weight = least * (1 - 1e-12);
    view->greatest_weight = greatest * (1 + 1e-12);
}

static void view_box(cell_search *search, const box *part, box_view *view)
{
    bool touches[3][2], any = false;
    for (int a = 0; a < 3; a++) {
        touches[a][0] = search->on_border[a][0] && part->lo[a] == 0;
        touches[a][1] = search->on_border[a][1] && part->hi[a] == 1;
        any |= touches[a][0] | touches[a][1];
    }
    scan(search, part, (const bool(*)[2])touches, NULL, 0, view);
    if (any && view->least <= part->rounding) {
        const double rounding = make_rest(search, part);
        scan(search, part, (const bool(*)[2])touches, search->scratch->rest_part, rounding, view);
    }
    view_weights(search, part, view);
}

/* Places */

static double weight_at(const cell_search *search, const box *part, const double t[3])
{
    return search->rational ? ffd_bernstein_value(part->weights, search->weight_order, t) : 1;
}

static void place_in(const box *part, const double t[3], double place[3])
{
    for (int a = 0; a < 3; a++)
        place[a] = part->lo[a] + t[a] * (part->hi[a] - part->lo[a]);
}

/* Looks at the corners, whose coefficients are values. Returns whether one of them is so near to zero that
   its sign is not known; search->result says whether one is negative. */
static bool look_at_corners(cell_search *search, const box *part, const box_view *view)
{
    const int *order = search->order;
    bool doubtful = false;
    for (int corner = 0; corner < 8; corner++) {
        double t[3], place[3];
        size_t at = 0, stride = 1;
        for (int a = 0; a < 3; a++) {
            t[a] = corner >> a & 1;
            at += stride * (corner >> a & 1 ? (size_t)order[a] - 1 : 0);
            stride *= (size_t)order[a];
        }
        const double value = view->corner_is_zero[corner] ? 0 : part->coefficients[at];
        const double relative = relative_value(search, value, weight_at(search, part, t));
        see(search, relative);
        if (view->corner_is_zero[corner])
            continue;
        doubtful |= fabs(value) <= part->rounding;
        if (value < -part->rounding && search->result.verdict != FFD_FOLDS_SOME) {
            place_in(part, t, place);
            set_folded(search, place, relative);
        }
    }
    return doubtful;
}

/* Looks where the least coefficient has its greatest influence. */
static void look_at_least(cell_search *search, const box *part, const box_view *view)
{
    double t[3], place[3];
    int orders = 0;
    for (int a = 0; a < 3; a++) {
        t[a] = (double)view->at[a] / (search->order[a] - 1);
        orders += search->order[a];
    }
    const double value = ffd_bernstein_value(part->coefficients, search->order, t);
    const double relative = relative_value(search, value, weight_at(search, part, t));
    see(search, relative);
    if (value < -part->rounding - 8 * orders * UNIT * search->greatest &&
        search->result.verdict != FFD_FOLDS_SOME) {
        place_in(part, t, place);
        set_folded(search, place, relative);
    }
}

/* Whether the box has collapsed: all coefficients are zero to rounding, and those of the rest volume not. */
static bool has_collapsed(cell_search *search, const box *part, const box_view *view)
{
    const size_t count = ffd_bernstein_count(search->order);
    if (view->greatest > part->rounding || view->least < -part->rounding ||
        greatest_size(part->coefficients, count) > part->rounding)
        return false;
    const double rounding = make_rest(search, part);
    return greatest_size(search->scratch->rest_part, count) > search->rest_bounds.coarse + rounding;
}

/* The verdict: whether nothing remains to be done for the box. */
static bool is_decided(cell_search *search, const box *part, const box_view *view)
{
    static const double centre[3] = {0.5, 0.5, 0.5};
    if (view->least > part->rounding && view->greatest > part->rounding)
        return true;
    if (has_collapsed(search, part, view)) {
        double place[3];
        place_in(part, centre, place);
        set_folded(search, place, 0);
        return true;
    }
    const bool doubtful = look_at_corners(search, part, view);
    if (search->result.verdict == FFD_FOLDS_SOME)
        return true;
    if (doubtful && view->least >= -part->rounding) {
        /* No smaller box can show more: the corner stays what it is, and nothing is surely negative. */
        search->result.verdict = FFD_FOLDS_UNKNOWN;
        return true;
    }
    look_at_least(search, part, view);
    return search->result.verdict == FFD_FOLDS_SOME;
}

/* A lower bound of the determinant in the box. */
static double box_lower(const cell_search *search, const box *part, const box_view *view)
{
    const double lower =
        relative_lower(search, view->least - part->rounding, view->least_weight, view->greatest_weight);
    return view->has_zeros && lower > 0 ? 0 : lower;
}

/* The closer look: whether the box's bound is good enough. */
static bool is_near(cell_search *search, const box *part, const box_view *view)
{
    look_at_corners(search, part, view);
    const double rounding = relative_value(search, 4 * part->rounding, view->least_weight);
    const double lower = box_lower(search, part, view), seen = search->result.least_seen;
    if (lower >= ffd_fold_target(seen) || lower >= seen - rounding)
        return true;
    look_at_least(search, part, view);
    return lower >= ffd_fold_target(search->result.least_seen);
}

static bool must_stop(const cell_search *search)
{
    return !search->refining && search->result.verdict == FFD_FOLDS_SOME;
}

static double least_of(const cell_search *search, const box *part)
{
    const size_t count = ffd_bernstein_count(search->order);
    double least = DBL_MAX;
    for (size_t i = 0; i < count; i++)
        least = part->coefficients[i] < least ? part->coefficients[i] : least;
    return least;
}

static void search_box(cell_search *search, box *part, int depth)
{
    box_view view;
    search->boxes--;
    view_box(search, part, &view);
    if (depth == 0)
        search->whole_lower = box_lower(search, part, &view);
    const bool done = search->refining ? is_near(search, part, &view) : is_decided(search, part, &view);
    if (done || depth == CELL_DEPTH || search->boxes <= 0) {
        if (!done && !search->refining)
            search->result.verdict = FFD_FOLDS_UNKNOWN;
        lower_to(search, box_lower(search, part, &view));
        return;
    }
    box lower;
    halve(search, part, ffd_bernstein_direction(part->coefficients, search->order), depth, &lower);
    /* The half with the least coefficient first: it may settle the matter. The other one keeps its slot: what
       follows is written to deeper ones. */
    const bool lower_first = least_of(search, &lower) <= least_of(search, part);
    search_box(search, lower_first ? &lower : part, depth + 1);
    if (!must_stop(search))
        search_box(search, lower_first ? part : &lower, depth + 1);
}

/* Values at the corners of the whole cell, before there are coefficients. A value that is negative even if
   control points are known roughly only is no zero of the rest volume's. */
static void look_at_cell_corners(cell_search *search)
{
    for (int corner = 0; corner < 8; corner++) {
        double t[3], weight = 1;
        for (int a = 0; a < 3; a++)
            t[a] = corner >> a & 1;
        if (search->rational)
            weight = ffd_bernstein_value(search->form.row[3][3], search->weight_order, t);
        const double value = search->plan->volume.sign * ffd_determinant_corner(&search->form, corner);
        const double relative = relative_value(search, value, weight);
        if (value >= -search->bounds.coarse)
            see(search, relative);
        else if (search->result.verdict != FFD_FOLDS_SOME)
            set_folded(search, t, relative);
    }
}

/* No determinant is less, whatever the signs of its products. */
static double crude_lower(const cell_search *search)
{
    const double weight = search->form.least_weight * (1 - 1e-12);
    return relative_lower(search, -search->bounds.greatest, weight, weight);
}

static bool decide_quickly(cell_search *search)
{
    static const double centre[3] = {0.5, 0.5, 0.5};
    regularity quick;
    ffd_cell_regularity(&search->form, &quick);
    look_at_cell_corners(search);
    if (quick.proven && quick.negative == (search->plan->volume.sign < 0)) {
        search->result.lower = relative_lower(search, quick.least, 1, 1);
        return true;
    }
    if (quick.proven && search->result.verdict != FFD_FOLDS_SOME)
        set_folded(search, centre, relative_value(search, -quick.least, 1));
    if (search->result.verdict == FFD_FOLDS_SOME)
        search->result.lower = crude_lower(search);
    return search->result.verdict == FFD_FOLDS_SOME;
}

void ffd_cell_decide(const fold_plan *plan, size_t cell, fold_scratch *scratch, cell_verdict *verdict)
{
    cell_search search;
    begin(plan, cell, scratch, &search);
    search.result.verdict = FFD_FOLDS_NONE;
    if (!decide_quickly(&search)) {
        box whole;
        search.boxes = ffd_cell_boxes(plan, CELL_BOXES);
        make_box(&search, &whole);
        search_box(&search, &whole, 0);
        if (search.result.verdict == FFD_FOLDS_SOME) /* not all of it has been looked at */
            lower_to(&search, search.whole_lower);
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
    make_box(&search, &whole);
    search_box(&search, &whole, 0);
    *boxes = search.boxes;
    *least_seen = search.result.least_seen;
    return search.result.lower;
}
