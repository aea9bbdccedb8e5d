/* animation_times.c - drops the times of an animation that the weights at others reproduce. */
#include "base/arithmetic.h"
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include "job/animate/animation.h"
#include <math.h>

typedef struct time_choice {
    const path_samples *samples;
    animation_plan *plan;
    bool *keeps;    /* of each sample */
    double *misses; /* by how far its shape is missed */
    double *row;    /* weights */
    ffd_error *error;
} time_choice;

static const double *weights_of(const time_choice *c, size_t sample)
{
    return c->plan->weights + sample * c->plan->target_count;
}

/* Measures what weights that go linearly between two samples make of those between. */
static ffd_status measure(const time_choice *c, size_t before, size_t after)
{
    const double *const times = c->samples->times, *const a = weights_of(c, before),
                        *const b = weights_of(c, after);
    for (size_t k = before + 1; k < after; k++) {
        const double part = (times[k] - times[before]) / (times[after] - times[before]);
        TRY(ffd_deadline_check(c->error));
        for (size_t t = 0; t < c->plan->target_count; t++)
            c->row[t] = (1 - part) * a[t] + part * b[t];
        c->misses[k] = ffd_animation_miss(c->samples, c->plan, k, c->row);
    }
    return FFD_OK;
}

/* The worst of all samples, and the worst of those that are not kept; 0: all are kept. */
static double find_worst(const time_choice *c, size_t *worst)
{
    double most = 0, dropped = -1;
    *worst = 0;
    for (size_t k = 0; k < c->samples->count; k++) {
        most = larger_of(most, c->misses[k]);
        if (!c->keeps[k] && c->misses[k] > dropped) {
            dropped = c->misses[k];
            *worst = k;
        }
    }
    return most;
}

/* Begins with the first and the last time, and keeps the worst one until none is missed by more than most. */
static ffd_status keep_times(const time_choice *c, double most)
{
    const size_t last = c->samples->count - 1;
    c->keeps[0] = c->keeps[last] = true;
    TRY(measure(c, 0, last));
    for (;;) {
        size_t worst;
        if (find_worst(c, &worst) + c->samples->chord <= most || worst == 0)
            return FFD_OK;
        size_t before = worst, after = worst;
        while (!c->keeps[before])
            before--;
        while (!c->keeps[after])
            after++;
        c->keeps[worst] = true;
        c->misses[worst] = ffd_animation_miss(c->samples, c->plan, worst, weights_of(c, worst));
        TRY(measure(c, before, worst));
        TRY(measure(c, worst, after));
    }
}

static void list_keys(const time_choice *c)
{
    animation_plan *const plan = c->plan;
    size_t worst;
    plan->bound = find_worst(c, &worst) + c->samples->chord;
    for (size_t k = 0; k < c->samples->count; k++) {
        if (!c->keeps[k])
            continue;
        plan->keys[plan->key_count++] = k;
        for (size_t t = 0; t < plan->target_count; t++)
            plan->largest_weight = larger_of(plan->largest_weight, fabs(weights_of(c, k)[t]));
    }
}

ffd_status ffd_animation_drop_times(const path_samples *samples, double most, animation_plan *plan,
                                    ffd_error *error)
{
    const size_t count = samples->count;
    time_choice c = {.samples = samples, .plan = plan, .error = error};
    c.keeps = ffd_alloc_zero(count, sizeof *c.keeps);
    c.misses = ffd_alloc_zero(count, sizeof *c.misses);
    c.row = ffd_alloc(plan->target_count, sizeof *c.row);
    plan->keys = ffd_alloc(count, sizeof *plan->keys);
    ffd_status status;
    TRY_END(c.keeps && c.misses && c.row && plan->keys ? FFD_OK : ffd_fail_memory(error));
    c.misses[0] = ffd_animation_miss(samples, plan, 0, weights_of(&c, 0));
    c.misses[count - 1] = ffd_animation_miss(samples, plan, count - 1, weights_of(&c, count - 1));
    TRY_END(keep_times(&c, most));
    list_keys(&c);
end:
    ffd_free(c.keeps);
    ffd_free(c.misses);
    ffd_free(c.row);
    return status;
}
