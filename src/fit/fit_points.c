/* fit_points.c - ffd_fit_points: from pairs of places to a lattice. */
#include "author/made.h"
#include "base/memory/memory.h"
#include "base/struct_size.h"
#include "base/system/deadline.h"
#include "base/system/thread.h"
#include "base/vector/vec.h"
#include "fit/affine.h"
#include "fit/choose.h"
#include "fit/exact.h"
#include "fit/pairs.h"
#include <ffd/author.h>
#include <ffd/fit.h>
#include <math.h>
#include <string.h>

/* The most bytes of a band matrix. */
#define MOST_BYTES ((uint64_t)1 << 31)
/* Diagonals whose squares, and the products of some, are numbers. */
#define SMALLEST 1e-60
#define LARGEST 1e60
#define TOO_LARGE "the coordinates are too large to be fitted"
/* What the affine map leaves is nothing below this part of the diagonal. */
#define NOTHING 1e-12
/* The greatest S to which folds raise it. */
#define MOST_SMOOTH 100
/* FFD_FIT_WITHIN: S is 10^(k/2) for k from the first down to the last. */
#define FIRST_POWER 4
#define LAST_POWER (-16)
/* Rounds of weighing again, and the share of the median beyond which pairs count less (Holland & Welsch). */
#define ROUNDS 8
#define TUNING 1.345
#define MEDIAN 1.4826

void ffd_fit_desc_init(ffd_fit_desc *desc, size_t size)
{
    const ffd_fit_desc defaults = {.struct_size = sizeof defaults};
    ffd_struct_give(&defaults, sizeof defaults, desc, size);
}

const char *ffd_fit_choice_name(ffd_fit_choice choice)
{
    static const char *const names[] = {"gcv", "default", "within", "given", "folds"};
    return (size_t)choice < sizeof names / sizeof *names ? names[choice] : NULL;
}

typedef struct fit_work {
    const ffd_fit_desc *desc;
    const ffd_lattice *base;
    fit_pairs pairs;
    fit_affine affine;
    fit_unknowns unknowns;
    fit_bending bending;
    double lengths[3];
    double diagonal; /* of the base at rest */
    fit_places soft, exact;
    double *wanted; /* 3 of each pair: what the affine map leaves */
    fit_steps steps;
    fit_system system;
    fit_solution solution;
    ffd_lattice *made;
    ffd_fit_result result;
} fit_work;

/* Finds the affine map, and what it leaves. */
static void take_affine(fit_work *work)
{
    const fit_pairs *const pairs = &work->pairs;
    work->affine = (fit_affine){.unknown_count = 0};
    if (!work->desc->handles)
        ffd_affine_nearest(pairs->x, pairs->y, pairs->weights, pairs->count, &work->affine);
    for (size_t i = 0; i < pairs->count; i++) {
        double offset[3];
        ffd_affine_nearest_offset(&work->affine, pairs->x + 3 * i, offset);
        for (size_t c = 0; c < 3; c++)
            work->wanted[3 * i + c] = pairs->y[3 * i + c] - offset[c];
    }
}

/* Makes the places of the soft pairs, or of the exact ones. numbers: room for 7 of each pair. */
static ffd_status make_places_in(const fit_work *work, bool exact, double *numbers, size_t *index,
                                 fit_places *places, ffd_error *error)
{
    const fit_pairs *const pairs = &work->pairs;
    double *const uvw = numbers, *const wanted = numbers + 3 * pairs->count,
                  *const weights = numbers + 6 * pairs->count;
    size_t n = 0;
    for (size_t i = 0; i < pairs->count; i++) {
        if (pairs->exact[i] != exact)
            continue;
        memcpy(uvw + 3 * n, pairs->uvw + 3 * i, 3 * sizeof *uvw);
        memcpy(wanted + 3 * n, work->wanted + 3 * i, 3 * sizeof *wanted);
        weights[n] = pairs->weights[i];
        index[n++] = pairs->numbers[i] + work->desc->numbered_from;
    }
    return ffd_fit_places_make(&work->unknowns, n, uvw, wanted, weights, index, places, error);
}

static ffd_status make_places(const fit_work *work, bool exact, fit_places *places, ffd_error *error)
{
    double *const numbers = ffd_alloc(work->pairs.count, 7 * sizeof *numbers);
    size_t *const index = ffd_alloc(work->pairs.count, sizeof *index);
    const ffd_status status = numbers && index ? make_places_in(work, exact, numbers, index, places, error)
                                               : ffd_fail_memory(error);
    ffd_free(numbers);
    ffd_free(index);
    return status;
}

/* Makes the rows of the system anew: by what the affine map leaves. */
static ffd_status make_rows(fit_work *work, ffd_error *error)
{
    ffd_fit_places_free(&work->soft);
    ffd_fit_places_free(&work->exact);
    take_affine(work);
    TRY(make_places(work, false, &work->soft, error));
    return make_places(work, true, &work->exact, error);
}

/* The largest equal size whose band fits. */
static size_t fitting_size(const ffd_lattice *lattice)
{
    const size_t degrees[3] = {(size_t)lattice->knots[0].degree, (size_t)lattice->knots[1].degree,
                               (size_t)lattice->knots[2].degree};
    size_t side = 2;
    for (size_t next = 3, reach; true; side = next++) {
        reach = degrees[2] * next * next + degrees[1] * next + degrees[0];
        if (ffd_band_bytes(next * next * next, reach) > MOST_BYTES)
            return side;
    }
}

/* With mirror images. */
static size_t pair_count(const fit_work *work)
{
    return work->desc->source.count * (work->desc->symmetric ? 2 : 1);
}

static double solution_work(const fit_work *work)
{
    return ffd_normal_work(&work->unknowns, pair_count(work)) + ffd_factor_work(&work->unknowns);
}

/* How many solutions there are at most, but for those that folds ask for. */
static int most_solutions(const ffd_fit_desc *desc)
{
    return (desc->robust ? ROUNDS : 0) +
           (desc->smoothing == FFD_FIT_WITHIN ? FIRST_POWER - LAST_POWER + 1 : 1);
}

static ffd_status begin(fit_work *work, const ffd_run_options *options, ffd_error *error)
{
    if (ffd_band_bytes(work->unknowns.count, work->unknowns.reach) > MOST_BYTES) {
        const size_t side = fitting_size(work->base);
        return ffd_fail(error, FFD_E_LIMIT,
                        "a lattice of %zu control points takes more than 2^31 bytes to solve: at most {size} "
                        "%zu,%zu,%zu of equal sides fits",
                        work->unknowns.count, side, side, side);
    }
    ffd_bending_lengths(work->base, work->lengths);
    TRY(ffd_bending_make(&work->unknowns, work->lengths, &work->bending, error));
    work->wanted = ffd_alloc(work->pairs.count, 3 * sizeof *work->wanted);
    if (!work->wanted)
        return ffd_fail_memory(error);
    work->system = (fit_system){.unknowns = &work->unknowns,
                                .bending = &work->bending,
                                .soft = &work->soft,
                                .exact = &work->exact,
                                .minimal = work->desc->handles,
                                .diagonal = work->diagonal,
                                .run = {.isa = options->isa,
                                        .threads = ffd_threads_for(options->threads, UINT64_MAX),
                                        .steps = &work->steps}};
    return make_rows(work, error);
}

/* The value at a control point of the affine function along a direction that the pairs do not tell. */
static double unknown_at_point(const fit_work *work, int u, size_t point)
{
    double value = 0;
    for (size_t c = 0; c < 3; c++)
        value += work->affine.unknown[u][c] * (work->base->rest[3 * point + c] - work->affine.middle[c]);
    return value;
}

/* Takes what is affine along such directions out of the offsets: neither the pairs nor the energy see it. */
static void remove_unknown(const fit_work *work, double *offsets)
{
    for (int u = 0; u < work->affine.unknown_count; u++) {
        double squares = 0, products[3] = {0, 0, 0};
        for (size_t i = 0; i < work->base->count; i++) {
            const double g = unknown_at_point(work, u, i);
            squares += g * g;
            for (size_t c = 0; c < 3; c++)
                products[c] += g * offsets[3 * ffd_unknown_of(&work->unknowns, i) + c];
        }
        for (size_t i = 0; i < work->base->count && squares > 0; i++)
            for (size_t c = 0; c < 3; c++)
                offsets[3 * ffd_unknown_of(&work->unknowns, i) + c] -=
                    products[c] / squares * unknown_at_point(work, u, i);
    }
}

static ffd_status solve(fit_work *work, double smooth, ffd_error *error)
{
    ffd_solution_free(&work->solution);
    TRY(ffd_system_solve(&work->system, smooth, false, &work->solution, error));
    remove_unknown(work, work->solution.offsets);
    work->result.smooth = smooth;
    return FFD_OK;
}

/* How far a pair is from its target. */
static double residual_of(const fit_work *work, size_t pair)
{
    double value[3];
    ffd_place_value(&work->unknowns, work->pairs.uvw + 3 * pair, work->solution.offsets, value);
    for (size_t c = 0; c < 3; c++)
        value[c] -= work->wanted[3 * pair + c];
    return vec_length(value);
}

static double largest_residual(const fit_work *work)
{
    double largest = 0;
    for (size_t i = 0; i < work->pairs.count && !ffd_deadline_passed_at(i); i++)
        largest = larger_of(largest, residual_of(work, i));
    return largest;
}

/* Finds the largest S with which all pairs are near enough. */
static ffd_status solve_within(fit_work *work, ffd_error *error)
{
    double best = HUGE_VAL, best_smooth = 0;
    for (int power = FIRST_POWER; power >= LAST_POWER; power--) {
        ffd_error unmet;
        const ffd_status status = solve(work, ffd_half_power(power), &unmet);
        if (status == FFD_E_UNMET && (power > LAST_POWER || best < HUGE_VAL))
            continue; /* exact rows need more freedom than there is */
        TRY(ffd_fail_as(status, &unmet, error));
        const double largest = largest_residual(work);
        TRY(ffd_deadline_check(error));
        if (largest <= work->desc->within)
            return FFD_OK;
        if (largest < best) {
            best = largest;
            best_smooth = work->result.smooth;
        }
    }
    return ffd_fail(error, FFD_E_UNMET,
                    "no smoothing brings all pairs within %.6g: the best is %.6g, with %g",
                    work->desc->within, best, best_smooth);
}

static bool is_all_affine(const fit_work *work)
{
    for (size_t i = 0; i < work->pairs.count; i++)
        if (vec_length(work->wanted + 3 * i) > NOTHING * work->diagonal)
            return false;
    return true;
}

/* Chooses S, and solves with it. */
static ffd_status solve_chosen(fit_work *work, ffd_error *error)
{
    double smooth = work->desc->smooth;
    work->result.gcv = (double)NAN;
    switch (work->desc->smoothing) {
    case FFD_FIT_GIVEN:
        work->result.smooth_chosen_by = FFD_FIT_BY_CALLER;
        return solve(work, smooth, error);
    case FFD_FIT_WITHIN:
        work->result.smooth_chosen_by = FFD_FIT_BY_WITHIN;
        return solve_within(work, error);
    case FFD_FIT_AUTO:
        break;
    }
    smooth = work->desc->handles ? 0 : FIT_DEFAULT_SMOOTH;
    if (!work->desc->handles && !is_all_affine(work))
        TRY(ffd_smooth_choose(&work->system, work->lengths, &smooth, &work->result.gcv, error));
    work->result.smooth_chosen_by = isnan(work->result.gcv) ? FFD_FIT_BY_DEFAULT : FFD_FIT_BY_GCV;
    return solve(work, smooth, error);
}

/* Removes what rounding made of a symmetric solution. */
static ffd_status make_symmetric(fit_work *work, ffd_error *error)
{
    ffd_lattice *symmetric;
    if (work->desc->symmetric == 0)
        return FFD_OK;
    TRY(ffd_lattice_symmetrize(work->made, work->desc->symmetric - 1, true, &symmetric, error));
    ffd_lattice_destroy(&work->made);
    work->made = symmetric;
    return FFD_OK;
}

static void find_largest_offset(fit_work *work)
{
    const double *const offsets = ffd_lattice_get_offsets(work->made);
    work->result.largest_offset = 0;
    for (size_t i = 0; i < work->base->count; i++)
        work->result.largest_offset = larger_of(work->result.largest_offset, vec_length(offsets + 3 * i));
}

/* Makes the lattice: the base with its own offsets, the affine map's and the solution's. */
static ffd_status make_lattice(fit_work *work, ffd_error *error)
{
    const ffd_lattice *const base = work->base;
    made_lattice made = {0};
    ffd_status status;
    ffd_lattice_destroy(&work->made);
    TRY_END(ffd_made_begin_same(base, &made, error));
    for (size_t i = 0; i < base->count; i++) {
        const size_t at = ffd_unknown_of(&work->unknowns, i);
        double *const own = made.offsets + 3 * i, offset[3];
        ffd_affine_nearest_offset(&work->affine, base->rest + 3 * i, offset);
        for (size_t c = 0; c < 3; c++)
            own[c] += offset[c] + work->solution.offsets[3 * at + c];
    }
    TRY_END(ffd_made_finish(&made, &work->made, error));
    TRY_END(make_symmetric(work, error));
    find_largest_offset(work);
end:
    ffd_made_free(&made);
    return status;
}

static ffd_status find_folds(fit_work *work, ffd_error *error)
{
    work->result.folds = (ffd_folds){.struct_size = sizeof work->result.folds};
    TRY(make_lattice(work, error));
    return ffd_folds_find(work->made, work->system.run.threads, &work->result.folds, error);
}

static ffd_status solve_again(fit_work *work, double smooth, ffd_error *error)
{
    work->steps.expected += solution_work(work);
    TRY(solve(work, smooth, error));
    return find_folds(work, error);
}

/* Raises an S that was chosen by itself, until the lattice does not fold. */
static ffd_status avoid_folds(fit_work *work, ffd_error *error)
{
    TRY(find_folds(work, error));
    while (work->desc->smoothing == FFD_FIT_AUTO && !work->desc->handles &&
           work->result.folds.verdict != FFD_FOLDS_NONE && work->result.smooth < MOST_SMOOTH) {
        const double before = work->result.smooth;
        work->steps.expected += solution_work(work);
        ffd_error unmet;
        const ffd_status status = solve(work, lesser_of(before * sqrt(10), MOST_SMOOTH), &unmet);
        if (status == FFD_E_UNMET) /* exact rows need more freedom: it folds */
            return solve_again(work, before, error);
        TRY(ffd_fail_as(status, &unmet, error));
        work->result.smooth_chosen_by = FFD_FIT_BY_FOLDS;
        TRY(find_folds(work, error));
    }
    return FFD_OK;
}

/* Weighs the pairs by how far they are off, again and again. */
static ffd_status weigh_again(fit_work *work, ffd_error *error)
{
    fit_pairs *const pairs = &work->pairs;
    const double smooth = work->desc->smoothing == FFD_FIT_GIVEN ? work->desc->smooth : FIT_DEFAULT_SMOOTH;
    double *const residuals = ffd_alloc(pairs->count, sizeof *residuals);
    ffd_status status = residuals ? FFD_OK : ffd_fail_memory(error);
    for (int round = 0; round < ROUNDS && !status; round++) {
        size_t soft = 0;
        TRY_END(solve(work, smooth, error));
        for (size_t i = 0; i < pairs->count && !ffd_deadline_passed_at(i); i++)
            if (!pairs->exact[i])
                residuals[soft++] = residual_of(work, i);
        TRY_END(ffd_deadline_check(error));
        const double scale = MEDIAN * ffd_median(residuals, soft);
        if (!(scale > NOTHING * work->diagonal))
            break;
        for (size_t i = 0; i < pairs->count && !ffd_deadline_passed_at(i); i++)
            if (!pairs->exact[i])
                pairs->weights[i] = pairs->given[i] * lesser_of(1, TUNING * scale / residual_of(work, i));
        TRY_END(make_rows(work, error));
    }
end:
    ffd_free(residuals);
    return status;
}

static ffd_status run(fit_work *work, const ffd_run_options *options, ffd_error *error)
{
    TRY(begin(work, options, error));
    if (work->desc->robust && work->soft.count == 0)
        return ffd_fail(error, FFD_E_ARGUMENT, "{robust} needs pairs that are not exact");
    if (work->desc->robust)
        TRY(weigh_again(work, error));
    TRY(solve_chosen(work, error));
    return avoid_folds(work, error);
}

static void tell_affine(const fit_affine *affine, double numbers[12])
{
    memcpy(numbers, affine->constant, sizeof affine->constant);
    for (size_t r = 0; r < 3; r++)
        for (size_t c = 0; c < 3; c++)
            numbers[3 + 3 * r + c] = affine->matrix[3 * c + r];
}

/* Fills the figures of the residuals. residuals: the caller's, of all pairs; or NULL. */
static ffd_status tell_residuals(fit_work *work, double *residuals, ffd_error *error)
{
    const fit_pairs *const pairs = &work->pairs;
    ffd_fit_result *const result = &work->result;
    const size_t count = pairs->own_count;
    double *const own = ffd_alloc(count, sizeof *own), squares = 0;
    if (!own)
        return ffd_fail_memory(error);
    for (size_t i = 0; residuals && i < result->pairs; i++)
        residuals[i] = (double)NAN;
    result->residual_max = -1;
    result->residual_exact = (double)NAN;
    for (size_t i = 0; i < count && !ffd_deadline_passed_at(i); i++) {
        own[i] = residual_of(work, i);
        squares += own[i] * own[i];
        if (own[i] > result->residual_max) {
            result->residual_max = own[i];
            result->worst = pairs->numbers[i];
        }
        if (pairs->exact[i] && !(own[i] <= result->residual_exact))
            result->residual_exact = own[i];
        if (residuals)
            residuals[pairs->numbers[i]] = own[i];
        result->downweighted += !pairs->exact[i] && pairs->weights[i] < pairs->given[i] / 2;
    }
    result->residual_rms = sqrt(squares / (double)count);
    result->residual_p95 = ffd_quantile(own, count, 0.95);
    ffd_free(own);
    return ffd_deadline_check(error);
}

/* Returns the exact pair, other than this one, whose source is the nearest to its source. */
static size_t nearest_exact(const fit_work *work, size_t pair)
{
    const fit_pairs *const pairs = &work->pairs;
    double least = HUGE_VAL;
    size_t nearest = pair;
    for (size_t i = 0; i < pairs->own_count; i++) {
        double off[3];
        for (size_t c = 0; c < 3; c++)
            off[c] = pairs->x[3 * i + c] - pairs->x[3 * pair + c];
        if (i == pair || !pairs->exact[i] || !(vec_length(off) < least))
            continue;
        least = vec_length(off);
        nearest = i;
    }
    return nearest;
}

/* Sources that are nearly at one place, and have other targets, are told apart by a slope that is then taken
   for one that the pairs do not tell. */
static ffd_status check_exact(const fit_work *work, ffd_error *error)
{
    const fit_pairs *const pairs = &work->pairs;
    for (size_t i = 0; i < pairs->own_count; i++) {
        const double by = pairs->exact[i] ? residual_of(work, i) : 0;
        if (!(by > EXACT_HOLDS * work->diagonal))
            continue;
        const size_t from = work->desc->numbered_from, other = nearest_exact(work, i);
        if (other == i && work->desc->symmetric == 0)
            return ffd_fail(
                error, FFD_E_UNMET,
                "the exact row %zu misses its target by %.6g: the others hardly tell of the direction in "
                "which it is off them",
                pairs->numbers[i] + from, by);
        return ffd_exact_fail(pairs->numbers[i] + from, pairs->numbers[other] + from, by, error);
    }
    return FFD_OK;
}

static ffd_status tell(fit_work *work, double *residuals, ffd_error *error)
{
    ffd_fit_result *const result = &work->result;
    tell_affine(&work->affine, result->affine);
    result->dependent = work->solution.dependent;
    result->flops = work->solution.flops;
    TRY(ffd_pairs_find_spread(&work->pairs, &result->spread_positions, &result->spread_largest, error));
    TRY(ffd_pairs_count_unseen(&work->pairs, &work->unknowns, &result->points_without_data, error));
    TRY(tell_residuals(work, residuals, error));
    TRY(work->affine.unknown_count > 0 ? check_exact(work, error) : FFD_OK);
    return isfinite(result->residual_rms) && isfinite(result->spread_largest)
               ? FFD_OK
               : ffd_fail(error, FFD_E_INVALID, TOO_LARGE);
}

static ffd_status check(const ffd_fit_desc *desc, ffd_error *error)
{
    if (!desc->base || !desc->base->rest)
        return ffd_fail(error, FFD_E_ARGUMENT, "the base has no control points yet");
    if (desc->base->weights_moved)
        return ffd_fail(error, FFD_E_UNSUPPORTED,
                        "the weights of the lattice's control points move: a fit finds offsets");
    if (!(desc->base->diagonal <= LARGEST))
        return ffd_fail(error, FFD_E_INVALID, TOO_LARGE);
    if (desc->base->diagonal < SMALLEST)
        return ffd_fail(error, FFD_E_INVALID, "the coordinates are too small to be fitted");
    if (desc->smoothing == FFD_FIT_GIVEN && !(desc->smooth >= 0 && isfinite(desc->smooth)))
        return ffd_fail(error, FFD_E_ARGUMENT, "{smooth} must be at least 0, not %g", desc->smooth);
    if (desc->smoothing == FFD_FIT_WITHIN && !(desc->within >= 0))
        return ffd_fail(error, FFD_E_ARGUMENT, "{within} must be at least 0, not %g", desc->within);
    if (desc->symmetric < 0 || desc->symmetric > 3)
        return ffd_fail(error, FFD_E_ARGUMENT, "{symmetric} must be 0 to 3, not %d", desc->symmetric);
    const size_t most = desc->symmetric ? MOST_EXACT / 2 : MOST_EXACT; /* their images are exact too */
    if (desc->exact_count > most)
        return ffd_fail(error, FFD_E_LIMIT, "%zu exact pairs are more than %zu: give others a large weight",
                        desc->exact_count, most);
    return desc->robust && desc->handles
               ? ffd_fail(error, FFD_E_ARGUMENT, "{robust} does not go with {handles}")
               : FFD_OK;
}

/* Multiplications and additions of embedding a pair, roughly. */
#define EMBEDDING_WORK 4000

/* The callback of the embedding. user: the fit_steps. */
static bool look(void *user, double done)
{
    ffd_fit_step_done(user, done);
    return !ffd_deadline_passed();
}

static ffd_status make_pairs(fit_work *work, const ffd_run_options *options, ffd_error *error)
{
    const ffd_run_options how = {.struct_size = sizeof how,
                                 .threads = options->threads,
                                 .isa = options->isa,
                                 .progress = look,
                                 .user = &work->steps};
    const size_t count = pair_count(work);
    const double cost = EMBEDDING_WORK * (double)count;
    const bool chooses = work->desc->smoothing == FFD_FIT_AUTO && !work->desc->handles;
    work->steps.expected =
        cost + most_solutions(work->desc) * solution_work(work) +
        (chooses ? ffd_smooth_choose_work(&work->unknowns, count, work->desc->exact_count > 0) : 0);
    ffd_fit_step_begin(&work->steps, cost);
    const ffd_status status = ffd_pairs_make(work->desc, &how, &work->pairs, &work->result, error);
    TRY(status == FFD_E_CANCELLED ? ffd_deadline_check(error) : status);
    for (size_t i = 0; i < 3 * work->pairs.count; i++)
        if (!(fabs(work->pairs.x[i]) <= LARGEST && fabs(work->pairs.y[i]) <= LARGEST))
            return ffd_fail(error, FFD_E_INVALID, TOO_LARGE);
    return FFD_OK;
}

/* All from the pairs to the lattice and the figures, while the caller watches. */
static ffd_status fit(fit_work *work, const ffd_run_options *options, double *residuals, ffd_error *error)
{
    work_watch watch = {.progress = options->progress, .user = options->user};
    deadline limit;
    ffd_status status;
    const deadline *const before = ffd_deadline_begin(&limit, 0, &watch);
    TRY_END(make_pairs(work, options, error));
    TRY_END(run(work, options, error));
    TRY_END(tell(work, residuals, error));
end:
    ffd_deadline_end(before);
    if (!status && watch.progress && !watch.progress(watch.user, 1))
        status = ffd_fail(error, FFD_E_CANCELLED, "the caller has ended the job");
    return status;
}

ffd_status ffd_fit_points(const ffd_fit_desc *desc, const ffd_run_options *options, ffd_lattice **lattice,
                          double *residuals, ffd_fit_result *result, ffd_error *error)
{
    ffd_fit_desc own;
    ffd_run_options how;
    fit_work work = {.desc = &own};
    ffd_lattice *symmetric = NULL;
    ffd_status status;
    *lattice = NULL;
    ffd_fit_desc_init(&own, sizeof own);
    ffd_run_options_init(&how, sizeof how);
    TRY(ffd_struct_take(&own, sizeof own, desc, "ffd_fit_desc", error));
    TRY(options ? ffd_struct_take(&how, sizeof how, options, "ffd_run_options", error) : FFD_OK);
    TRY(result ? ffd_struct_check(sizeof *result, result, "ffd_fit_result", error) : FFD_OK);
    TRY(check(&own, error));
    if (own.symmetric)
        TRY(ffd_lattice_symmetrize(own.base, own.symmetric - 1, true, &symmetric, error));
    work.base = own.base = symmetric ? symmetric : own.base;
    work.diagonal = work.base->diagonal;
    work.unknowns = ffd_unknowns_make(work.base);
    TRY_END(fit(&work, &how, residuals, error));
    if (result)
        ffd_struct_give(&work.result, sizeof work.result, result, result->struct_size);
    *lattice = work.made;
    work.made = NULL;
end:
    ffd_lattice_destroy(&work.made);
    ffd_lattice_destroy(&symmetric);
    ffd_solution_free(&work.solution);
    ffd_fit_places_free(&work.soft);
    ffd_fit_places_free(&work.exact);
    ffd_bending_free(&work.bending);
    ffd_pairs_free(&work.pairs);
    ffd_free(work.wanted);
    return status;
}
