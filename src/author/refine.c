/* refine.c - ffd_lattice_refine: the same map with more control points or of higher degree. */
#include "author/refine.h"
#include "author/made.h"
#include "base/memory/memory.h"
#include "base/struct_size.h"
#include "lattice/lattice.h"
#include "lattice/spec.h"
#include "spline/refine.h"
#include <ffd/author.h>
#include <stdint.h>
#include <string.h>

void ffd_refine_desc_init(ffd_refine_desc *desc, size_t size)
{
    const ffd_refine_desc defaults = {.struct_size = sizeof defaults};
    ffd_struct_give(&defaults, sizeof defaults, desc, size);
}

typedef struct refinement {
    const ffd_lattice *lattice;
    refine_plan plans[3];
    size_t *copied[3]; /* for each control point of a direction the old one that it is, or REFINE_NEW */
    made_lattice *to;
} refinement;

static const knot_row *last_row(const refine_plan *plan)
{
    return &plan->rows[plan->count - 1];
}

static ffd_status refuse_count(ffd_error *error)
{
    return ffd_fail(error, FFD_E_LIMIT, "the lattice would have more than %zu control points",
                    FFD_MAX_CONTROL_POINTS);
}

/* Refuses sizes that are too large together before any memory is taken for one of them. */
static ffd_status check_sizes(const ffd_lattice *lattice, const size_t size[3], ffd_error *error)
{
    size_t count = 1;
    for (int a = 0; a < 3; a++) {
        const size_t least = size[a] > lattice->size[a] ? size[a] : lattice->size[a];
        TRY(ffd_refine_check_count(least, "uvw"[a], FFD_MAX_CONTROL_POINTS, error));
        if (least > FFD_MAX_CONTROL_POINTS / count)
            return refuse_count(error);
        count *= least;
    }
    return FFD_OK;
}

static ffd_status make_plans(refinement *of, const ffd_refine_desc *desc, ffd_error *error)
{
    bool changes = false;
    size_t count = 1;
    TRY(check_sizes(of->lattice, desc->size, error));
    for (int a = 0; a < 3; a++) {
        const refine_wish wish = {.degree = desc->degree[a],
                                  .points = desc->size[a],
                                  .insert = desc->insert[a],
                                  .insert_count = desc->insert_count[a]};
        TRY(ffd_refine_plan(&of->lattice->knots[a], &wish, "uvw"[a], FFD_MAX_CONTROL_POINTS, &of -> plans[a],
                            error));
        changes = changes || of->plans[a].count > 1;
        if (last_row(&of->plans[a])->points > FFD_MAX_CONTROL_POINTS / count)
            return refuse_count(error);
        count *= last_row(&of->plans[a])->points;
    }
    return changes ? FFD_OK
                   : ffd_fail(error, FFD_E_ARGUMENT,
                              "nothing would change: {size}, {insert} and {degree} are as they are");
}

/* The copies of a direction after all rows of its plan. */
static ffd_status find_copies(refinement *of, int a, ffd_error *error)
{
    const refine_plan *const plan = &of->plans[a];
    const size_t most = last_row(plan)->points;
    size_t *const known = ffd_alloc(most, sizeof *known), *const next = ffd_alloc(most, sizeof *next);
    double *const out = ffd_alloc_zero(most, sizeof *out);
    ffd_status status = FFD_OK;
    of->copied[a] = known;
    if (!known || !next || !out)
        TRY_END(ffd_fail_memory(error));
    for (size_t i = 0; i < most; i++)
        known[i] = i;
    for (size_t row = 1; row < plan->count; row++) {
        TRY_END(ffd_refine_points(&plan->rows[row - 1], &plan->rows[row], out, 1, 0, out, next, error));
        for (size_t i = plan->rows[row].points; i-- > 0;)
            next[i] = next[i] == REFINE_NEW ? REFINE_NEW : known[next[i]];
        memcpy(known, next, plan->rows[row].points * sizeof *known);
    }
end:
    ffd_free(next);
    ffd_free(out);
    return status;
}

/* Replaces *numbers, `width` a control point, by those of the refined lattice. */
static ffd_status refine_numbers(const refinement *of, size_t width, double **numbers, ffd_error *error)
{
    size_t size[3] = {of->lattice->size[0], of->lattice->size[1], of->lattice->size[2]};
    size_t before = width;
    for (int a = 0; a < 3; a++) {
        size_t *const copied = ffd_alloc(last_row(&of->plans[a])->points, sizeof *copied);
        ffd_status status = copied ? FFD_OK : ffd_fail_memory(error);
        for (size_t row = 1; row < of->plans[a].count && !status; row++) {
            const knot_row *const to = &of->plans[a].rows[row];
            const size_t lines = a == 0 ? size[1] * size[2] : a == 1 ? size[2] : 1;
            double *const out = ffd_alloc_whole(before * to->points, lines * sizeof *out);
            status = out ? ffd_refine_points(to - 1, to, *numbers, before, lines, out, copied, error)
                         : ffd_fail_memory(error);
            ffd_free(*numbers);
            *numbers = out;
            size[a] = to->points;
        }
        ffd_free(copied);
        TRY(status);
        before *= size[a];
    }
    return FFD_OK;
}

/* Returns the old control point that a new one is, in all three directions, or REFINE_NEW. */
static size_t copy_of(const refinement *of, size_t i, size_t j, size_t k)
{
    const size_t *const size = of->lattice->size;
    const size_t u = of->copied[0][i], v = of->copied[1][j], w = of->copied[2][k];
    return u == REFINE_NEW || v == REFINE_NEW || w == REFINE_NEW ? REFINE_NEW
                                                                 : u + size[0] * (v + size[1] * w);
}

static bool any_but_zero(const double *numbers, size_t count)
{
    for (size_t i = 0; numbers && i < count; i++)
        if (numbers[i] != 0)
            return true;
    return false;
}

/* Without weights the control points and their offsets are refined each by themselves: zeros stay zeros. */
static ffd_status refine_plain(refinement *of, const double *offsets, ffd_error *error)
{
    const size_t numbers = 3 * of->lattice->count;
    if (any_but_zero(offsets, numbers)) {
        TRY(ffd_made_copy(offsets, numbers, &of->to->offsets, error));
        TRY(refine_numbers(of, 3, &of->to->offsets, error));
    }
    if (ffd_made_is_box(of->to))
        return FFD_OK;
    TRY(ffd_made_copy(of->lattice->rest, numbers, &of->to->points, error));
    return refine_numbers(of, 3, &of->to->points, error);
}

/* Homogeneous numbers of a control point with weights: h P, h D, h, and where weights are moved to g, g Q, g,
   and whether it moves. P and Q count from the mean of P, so that a lattice far from the origin loses no
   digits. */
enum { HP = 0, HD = 3, H = 6, FEW = 7, GQ = 7, G = 10, MOVES = 11, ALL = 12 };

typedef struct weighted_points {
    double origin[3];
    size_t width; /* FEW or ALL */
    double *numbers;
} weighted_points;

static ffd_status gather_weighted(const ffd_lattice *from, weighted_points *points, ffd_error *error)
{
    const size_t width = points->width;
    for (int c = 0; c < 3; c++) {
        for (size_t i = 0; i < from->count; i++)
            points->origin[c] += from->rest[3 * i + (size_t)c] / (double)from->count;
    }
    points->numbers = ffd_alloc_whole(from->count, width * sizeof *points->numbers);
    if (!points->numbers)
        return ffd_fail_memory(error);
    for (size_t i = 0; i < from->count; i++) {
        double *const n = points->numbers + width * i;
        const double h = from->rest_weights[i], g = from->deformed_weights[i];
        bool moves = g != h;
        n[H] = h;
        for (int c = 0; c < 3; c++) {
            const double p = from->rest[3 * i + (size_t)c] - points->origin[c],
                         d = from->difference[3 * i + (size_t)c];
            n[HP + c] = h * p;
            n[HD + c] = h * d;
            moves = moves || d != 0;
            if (width == ALL)
                n[GQ + c] = g * (p + d);
        }
        if (width == ALL) {
            n[G] = g;
            n[MOVES] = moves;
        }
    }
    return FFD_OK;
}

static void put_weighted(const double *n, const weighted_points *points, size_t i, made_lattice *to)
{
    const bool moves_weights = points->width == ALL;
    to->weights[i] = n[H];
    if (moves_weights)
        to->moved_weights[i] = n[MOVES] > 0 ? n[G] : n[H];
    for (int c = 0; c < 3; c++) {
        const double p = n[HP + c] / n[H];
        to->points[3 * i + (size_t)c] = points->origin[c] + p;
        to->offsets[3 * i + (size_t)c] = !moves_weights ? n[HD + c] / n[H]
                                         : n[MOVES] > 0 ? n[GQ + c] / n[G] - p
                                                        : 0;
    }
}

static void put_copy(const ffd_lattice *from, size_t old, size_t i, made_lattice *to)
{
    to->weights[i] = from->rest_weights[old];
    if (to->moved_weights)
        to->moved_weights[i] = from->deformed_weights[old];
    memcpy(to->points + 3 * i, from->rest + 3 * old, 3 * sizeof *to->points);
    memcpy(to->offsets + 3 * i, from->difference + 3 * old, 3 * sizeof *to->offsets);
}

static ffd_status refine_weighted(refinement *of, ffd_error *error)
{
    const ffd_lattice *const from = of->lattice;
    made_lattice *const to = of->to;
    const bool moves_weights =
        memcmp(from->rest_weights, from->deformed_weights, from->count * sizeof *from->rest_weights) != 0;
    weighted_points points = {.width = moves_weights ? ALL : FEW};
    ffd_status status;
    for (int a = 0; a < 3; a++)
        TRY_END(find_copies(of, a, error));
    TRY_END(gather_weighted(from, &points, error));
    TRY_END(refine_numbers(of, points.width, &points.numbers, error));
    TRY_END(ffd_made_allocate(to, moves_weights, error));
    for (size_t k = 0, i = 0; k < to->size[2]; k++)
        for (size_t j = 0; j < to->size[1]; j++)
            for (size_t l = 0; l < to->size[0]; l++, i++) {
                const size_t old = copy_of(of, l, j, k);
                if (old == REFINE_NEW)
                    put_weighted(points.numbers + points.width * i, &points, i, to);
                else
                    put_copy(from, old, i, to);
            }
end:
    ffd_free(points.numbers);
    return status;
}

static ffd_status refine(refinement *of, ffd_error *error)
{
    const ffd_lattice *const from = of->lattice;
    for (int a = 0; a < 3; a++) {
        const knot_row *const row = last_row(&of->plans[a]);
        TRY(ffd_made_set_knots(of->to, a, row->degree, row->points, row->closed, row->t, error));
    }
    if (from->rest_weights)
        return refine_weighted(of, error);
    return refine_plain(of, from->rest ? from->difference : from->spec->deformed_offsets, error);
}

static void free_refinement(refinement *of)
{
    for (int a = 0; a < 3; a++) {
        ffd_refine_plan_free(&of->plans[a]);
        ffd_free(of->copied[a]);
    }
}

/* Points and offsets count where they may be written. */
static lattice_spec arrays_of(const ffd_lattice *lattice)
{
    const made_lattice made = {.from = lattice};
    return (lattice_spec){.count = 1,
                          .points = ffd_made_is_box(&made) ? NULL : lattice->rest,
                          .weights = lattice->rest_weights,
                          .deformed_weights = lattice->deformed_weights,
                          .deformed_offsets =
                              lattice->rest ? lattice->difference : lattice->spec->deformed_offsets};
}

ffd_status ffd_lattice_refined_spec(const ffd_lattice *lattice, const ffd_refine_desc *desc,
                                    lattice_spec *spec, ffd_error *error)
{
    ffd_refine_desc own;
    refinement of = {.lattice = lattice};
    ffd_refine_desc_init(&own, sizeof own);
    TRY(ffd_struct_take(&own, sizeof own, desc, "ffd_refine_desc", error));
    const ffd_status status = make_plans(&of, &own, error);
    *spec = arrays_of(lattice);
    for (int a = 0; a < 3 && !status; a++) {
        const knot_row *const row = last_row(&of.plans[a]);
        spec->size[a] = row->points;
        spec->degree[a] = row->degree;
        spec->list_count[a] = row->points + (size_t)row->degree + 1;
        spec->count *= row->points;
    }
    free_refinement(&of);
    return status;
}

ffd_status ffd_made_begin_clamped(const ffd_lattice *lattice, const bool directions[3], made_lattice *made,
                                  ffd_error *error)
{
    refinement of = {.lattice = lattice, .to = made};
    bool changes = false;
    ffd_status status;
    TRY_END(ffd_made_begin(lattice, made, error));
    for (int a = 0; a < 3; a++) {
        const refine_wish wish = {.clamped = directions[a]};
        TRY_END(ffd_refine_plan(&lattice->knots[a], &wish, "uvw"[a], FFD_MAX_CONTROL_POINTS, &of.plans[a],
                                error));
        changes = changes || of.plans[a].count > 1;
    }
    TRY_END(changes ? refine(&of, error) : ffd_made_begin_same(lattice, made, error));
end:
    free_refinement(&of);
    return status;
}

ffd_status ffd_lattice_refine(const ffd_lattice *lattice, const ffd_refine_desc *desc, ffd_lattice **refined,
                              ffd_error *error)
{
    ffd_refine_desc own;
    made_lattice made;
    refinement of = {.lattice = lattice, .to = &made};
    ffd_status status;
    *refined = NULL;
    ffd_refine_desc_init(&own, sizeof own);
    TRY(ffd_struct_take(&own, sizeof own, desc, "ffd_refine_desc", error));
    TRY(ffd_made_begin(lattice, &made, error));
    TRY_END(make_plans(&of, &own, error));
    TRY_END(refine(&of, error));
    TRY_END(ffd_made_finish(&made, refined, error));
end:
    free_refinement(&of);
    ffd_made_free(&made);
    return status;
}
