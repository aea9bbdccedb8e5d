/* animation_plan.c - chooses the morph targets of a path, and their weights: shapes of the path itself,
   picked by Gram-Schmidt with pivots (Golub and Van Loan, Matrix Computations, 4th ed., 5.2 and 5.4), or
   those at its keys. All sums are made in one order, so that the same path always has the same animation. */
#include "base/arithmetic.h"
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include "base/vector/vec.h"
#include "job/animate/animation.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

void ffd_animation_free(animation_plan *plan)
{
    ffd_free(plan->targets);
    ffd_free(plan->keys);
    ffd_free(plan->weights);
    *plan = (animation_plan){0};
}

static const double *sample_at(const path_samples *samples, size_t sample)
{
    return samples->offsets + sample * samples->width;
}

/* The largest displacement of a control point. */
static double largest_of(const double *offsets, size_t width)
{
    double most = 0;
    for (size_t c = 0; c < width; c += 3)
        most = larger_of(most, vec_dot(offsets + c, offsets + c));
    return sqrt(most);
}

double ffd_animation_miss(const path_samples *samples, const animation_plan *plan, size_t sample,
                          const double *weights)
{
    const double *const path = sample_at(samples, sample);
    double most = 0;
    for (size_t c = 0; c < samples->width; c += 3) {
        double away[3] = {path[c], path[c + 1], path[c + 2]};
        for (size_t t = 0; t < plan->target_count; t++) {
            const double *const target = sample_at(samples, plan->targets[t]) + c;
            for (size_t d = 0; d < 3; d++)
                away[d] -= weights[t] * target[d];
        }
        most = larger_of(most, vec_dot(away, away));
    }
    return sqrt(most);
}

static ffd_status allocate(const path_samples *samples, size_t targets, memory_budget *budget,
                           animation_plan *plan, ffd_error *error)
{
    plan->target_count = targets;
    TRY(ffd_budget_take(budget, samples->count, targets * sizeof *plan->weights, error));
    plan->targets = ffd_alloc(targets, sizeof *plan->targets);
    plan->weights = ffd_alloc_zero(samples->count, targets * sizeof *plan->weights);
    return plan->targets && plan->weights ? FFD_OK : ffd_fail_memory(error);
}

/* Makes the shapes of some samples targets, whose weights are 1 there and 0 elsewhere. keeps: of each sample;
   those at rest need no target. */
static ffd_status take_keys(const path_samples *samples, const bool *keeps, memory_budget *budget,
                            animation_plan *plan, ffd_error *error)
{
    size_t targets = 0;
    for (size_t k = 0; k < samples->count; k++)
        targets += keeps[k] && !samples->is_still[k];
    TRY(allocate(samples, targets, budget, plan, error));
    for (size_t k = 0, t = 0; k < samples->count; k++)
        if (keeps[k] && !samples->is_still[k]) {
            plan->weights[k * targets + t] = 1;
            plan->targets[t++] = k;
        }
    return FFD_OK;
}

/* How far a control point of a sample is from the line between two others. */
static double miss_between(const path_samples *samples, size_t sample, size_t before, size_t after)
{
    const double *const path = sample_at(samples, sample), *const a = sample_at(samples, before),
                        *const b = sample_at(samples, after);
    const double from = samples->times[before],
                 part = (samples->times[sample] - from) / (samples->times[after] - from);
    double most = 0;
    for (size_t c = 0; c < samples->width; c += 3) {
        double away[3];
        for (size_t d = 0; d < 3; d++)
            away[d] = path[c + d] - ((1 - part) * a[c + d] + part * b[c + d]);
        most = larger_of(most, vec_dot(away, away));
    }
    return sqrt(most);
}

/* Measures the samples between two that are kept. */
static ffd_status measure_between(const path_samples *samples, size_t before, size_t after, double *misses,
                                  ffd_error *error)
{
    for (size_t k = before + 1; k < after; k++) {
        TRY(ffd_deadline_check(error));
        misses[k] = miss_between(samples, k, before, after);
    }
    return FFD_OK;
}

/* Keeps the samples of keys, and those farthest from the lines between samples that are kept, until all are
   near enough. */
static ffd_status bisect(const path_samples *samples, double tolerance, bool *keeps, double *misses,
                         ffd_error *error)
{
    size_t last = 0;
    for (size_t k = 0; k < samples->count; k++) {
        keeps[k] = samples->is_key[k];
        misses[k] = 0;
        if (keeps[k] && k > 0)
            TRY(measure_between(samples, last, k, misses, error));
        last = keeps[k] ? k : last;
    }
    for (;;) {
        size_t worst = 0;
        for (size_t k = 1; k < samples->count; k++)
            worst = misses[k] > misses[worst] ? k : worst;
        if (keeps[worst] || misses[worst] + samples->chord <= tolerance)
            return FFD_OK;
        size_t before = worst, after = worst;
        while (!keeps[before])
            before--;
        while (!keeps[after])
            after++;
        keeps[worst] = true;
        misses[worst] = 0;
        TRY(measure_between(samples, before, worst, misses, error));
        TRY(measure_between(samples, worst, after, misses, error));
    }
}

static ffd_status choose_keys(const path_samples *samples, bool of_points, double tolerance,
                              memory_budget *budget, animation_plan *plan, ffd_error *error)
{
    bool *const keeps = ffd_alloc(samples->count, sizeof *keeps);
    double *const misses = ffd_alloc(samples->count, sizeof *misses);
    ffd_status status;
    TRY_END(keeps && misses ? FFD_OK : ffd_fail_memory(error));
    for (size_t k = 0; k < samples->count; k++)
        keeps[k] = true;
    if (!of_points)
        TRY_END(bisect(samples, tolerance, keeps, misses, error));
    TRY_END(take_keys(samples, keeps, budget, plan, error));
    plan->keys = ffd_alloc(samples->count, sizeof *plan->keys);
    TRY_END(plan->keys ? FFD_OK : ffd_fail_memory(error));
    for (size_t k = 0; k < samples->count; k++) {
        if (keeps[k])
            plan->keys[plan->key_count++] = k;
        plan->bound = larger_of(plan->bound, of_points ? 0 : misses[k]);
    }
    plan->bound += samples->chord;
    plan->largest_weight = plan->target_count > 0 ? 1 : 0;
end:
    ffd_free(keeps);
    ffd_free(misses);
    return status;
}

/* Gram-Schmidt: what is left of each sample, and its shares of the directions of the picks so far. */
typedef struct picking {
    const path_samples *samples;
    double *left;   /* count x width */
    double *shares; /* count x most */
    size_t *picks;
    size_t count, most;
} picking;

/* Returns the sample of which most is left, the first of equals; *most: how much of its worst control point.
 */
static size_t find_worst(const picking *p, double *most)
{
    size_t worst = 0;
    *most = -1;
    for (size_t k = 0; k < p->samples->count; k++) {
        const double left = largest_of(p->left + k * p->samples->width, p->samples->width);
        worst = left > *most ? k : worst;
        *most = larger_of(*most, left);
    }
    return worst;
}

static double dot(const double *a, const double *b, size_t width)
{
    double sum = 0;
    for (size_t c = 0; c < width; c++)
        sum += a[c] * b[c];
    return sum;
}

/* Takes the direction of a sample out of all. */
static ffd_status project(picking *p, size_t pick, double *direction, ffd_error *error)
{
    const size_t width = p->samples->width;
    const double *const left = p->left + pick * width;
    const double length = sqrt(dot(left, left, width));
    for (size_t c = 0; c < width; c++)
        direction[c] = left[c] / length;
    for (size_t k = 0; k < p->samples->count; k++) {
        TRY(ffd_deadline_check(error));
        double *const row = p->left + k * width;
        const double share = dot(row, direction, width);
        for (size_t c = 0; c < width; c++)
            row[c] -= share * direction[c];
        p->shares[k * p->most + p->count] = share;
    }
    memset(p->left + pick * width, 0, width * sizeof *p->left);
    p->picks[p->count++] = pick;
    return FFD_OK;
}

/* Solves for the weights of the picks, in their order, that come nearest to a sample. */
static void solve(const picking *p, size_t sample, double *weights)
{
    const double *const shares = p->shares + sample * p->most;
    for (size_t r = p->count; r-- > 0;) {
        double sum = shares[r];
        for (size_t s = r + 1; s < p->count; s++)
            sum -= weights[s] * p->shares[p->picks[s] * p->most + r];
        weights[r] = sum / p->shares[p->picks[r] * p->most + r];
    }
    for (size_t r = 0; r < p->count; r++)
        if (p->picks[r] == sample)
            for (size_t s = 0; s < p->count; s++)
                weights[s] = s == r;
}

static int compare_samples(const void *a, const void *b)
{
    const size_t x = *(const size_t *)a, y = *(const size_t *)b;
    return (x > y) - (x < y);
}

/* Makes the picks targets, in the order of their times, and finds the weights of all samples. */
static ffd_status take_picks(const picking *p, memory_budget *budget, animation_plan *plan, ffd_error *error)
{
    const size_t count = p->count;
    double *const weights = ffd_alloc(count, sizeof *weights);
    ffd_status status;
    TRY_END(weights ? allocate(p->samples, count, budget, plan, error) : ffd_fail_memory(error));
    memcpy(plan->targets, p->picks, count * sizeof *plan->targets);
    qsort(plan->targets, count, sizeof *plan->targets, compare_samples);
    for (size_t k = 0; k < p->samples->count; k++) {
        solve(p, k, weights);
        for (size_t r = 0; r < count && !p->samples->is_still[k]; r++) {
            size_t t = 0;
            while (plan->targets[t] != p->picks[r])
                t++;
            plan->weights[k * count + t] = (double)(float)weights[r];
        }
    }
end:
    ffd_free(weights);
    return status;
}

static ffd_status pick(picking *p, const plan_wish *wish, memory_budget *budget, ffd_error *error)
{
    const path_samples *const samples = p->samples;
    const size_t width = samples->width, most = samples->count < width ? samples->count : width;
    const bool counts = wish->kind == FFD_TARGETS_COUNT;
    double *direction = NULL;
    ffd_status status;
    p->most = counts && wish->count < most ? wish->count : most;
    TRY_END(ffd_budget_take(budget, samples->count, width * sizeof *p->left, error));
    TRY_END(ffd_budget_take(budget, samples->count, p->most * sizeof *p->shares, error));
    p->left = ffd_alloc_whole(samples->count, width * sizeof *p->left);
    p->shares = ffd_alloc_zero(samples->count, p->most * sizeof *p->shares);
    p->picks = ffd_alloc(p->most, sizeof *p->picks);
    direction = ffd_alloc(width, sizeof *direction);
    TRY_END(p->left && p->shares && p->picks && direction ? FFD_OK : ffd_fail_memory(error));
    memcpy(p->left, samples->offsets, samples->count * width * sizeof *p->left);
    while (p->count < p->most) {
        double left;
        const size_t worst = find_worst(p, &left);
        if (left <= (counts ? wish->still : wish->tolerance / 2))
            break;
        TRY_END(project(p, worst, direction, error));
    }
end:
    ffd_free(direction);
    return status;
}

ffd_status ffd_animation_choose(const path_samples *samples, bool of_points, const plan_wish *wish,
                                memory_budget *budget, animation_plan *plan, ffd_error *error)
{
    picking p = {.samples = samples};
    *plan = (animation_plan){0};
    if (wish->kind == FFD_TARGETS_KEYS)
        return choose_keys(samples, of_points, wish->tolerance, budget, plan, error);
    ffd_status status;
    TRY_END(pick(&p, wish, budget, error));
    TRY_END(take_picks(&p, budget, plan, error));
end:
    ffd_free(p.left);
    ffd_free(p.shares);
    ffd_free(p.picks);
    return status;
}
