/* path_samples.c - samples the path of control points, close enough that chords between them are short. */
#include "base/arithmetic.h"
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include "base/vector/vec.h"
#include "job/animate/animation.h"
#include "lattice/file/lattice_time.h"
#include "lattice/spec.h"
#include <math.h>
#include <string.h>

/* Of the diagonal: what moves leave where they move nothing. */
#define STILL 1e-12
/* How often a part is halved. */
#define MOST_HALVINGS 8

typedef struct sampler {
    ffd_lattice *lattice;
    const sampling *by;
    memory_budget *budget;
    path_samples *samples;
    ffd_error *error;
} sampler;

void ffd_path_free(path_samples *samples)
{
    ffd_free(samples->times);
    ffd_free(samples->offsets);
    ffd_free(samples->is_key);
    ffd_free(samples->is_still);
    *samples = (path_samples){0};
}

/* Fills offsets with those at a time. */
static ffd_status evaluate(const sampler *s, double time, double *offsets)
{
    const ffd_lattice *const lattice = s->lattice;
    TRY(ffd_deadline_check(s->error));
    TRY(ffd_lattice_set_time(s->lattice, time, s->error));
    if (lattice->weights_moved)
        return ffd_fail(s->error, FFD_E_UNSUPPORTED,
                        "the weights of control points move: morph targets cannot play that");
    memcpy(offsets, lattice->difference, s->samples->width * sizeof *offsets);
    for (size_t i = 0; i < lattice->count; i++)
        if (!(vec_length(offsets + 3 * i) <= STILL * lattice->diagonal))
            return FFD_OK;
    memset(offsets, 0, s->samples->width * sizeof *offsets);
    return FFD_OK;
}

static bool is_still(const path_samples *samples, const double *offsets)
{
    for (size_t c = 0; c < samples->width; c++)
        if (offsets[c] != 0)
            return false;
    return true;
}

/* Makes room for as many samples again. */
static ffd_status grow(const sampler *s)
{
    path_samples *const to = s->samples;
    const size_t more = to->capacity ? to->capacity : 64, capacity = to->capacity + more;
    const size_t each = to->width * sizeof *to->offsets;
    TRY(ffd_budget_take(s->budget, more, each + sizeof *to->times + 2 * sizeof(bool), s->error));
    double *const times = ffd_realloc(to->times, capacity, sizeof *times);
    to->times = times ? times : to->times;
    double *const offsets = ffd_realloc(to->offsets, capacity, each);
    to->offsets = offsets ? offsets : to->offsets;
    bool *const keys = ffd_realloc(to->is_key, capacity, sizeof *keys);
    to->is_key = keys ? keys : to->is_key;
    bool *const stills = ffd_realloc(to->is_still, capacity, sizeof *stills);
    to->is_still = stills ? stills : to->is_still;
    if (!times || !offsets || !keys || !stills)
        return ffd_fail_memory(s->error);
    to->capacity = capacity;
    return FFD_OK;
}

static ffd_status add_sample(const sampler *s, double time, bool is_key, const double *offsets)
{
    path_samples *const to = s->samples;
    if (to->count == to->capacity)
        TRY(grow(s));
    to->times[to->count] = (double)(float)time;
    to->is_key[to->count] = is_key;
    to->is_still[to->count] = is_still(to, offsets);
    memcpy(to->offsets + to->count * to->width, offsets, to->width * sizeof *offsets);
    to->count++;
    return FFD_OK;
}

static double *new_offsets(const sampler *s)
{
    return ffd_alloc(s->samples->width, sizeof(double));
}

/* Returns the largest distance of a control point from the mean of two others. */
static double distance_from_mean(const path_samples *samples, const double *middle, const double *a,
                                 const double *b)
{
    double most = 0;
    for (size_t c = 0; c < samples->width; c += 3) {
        double away[3];
        for (size_t d = 0; d < 3; d++)
            away[d] = middle[c + d] - (a[c + d] + b[c + d]) / 2;
        most = larger_of(most, vec_length(away));
    }
    return most;
}

/* Adds what is needed between the last sample and an end, which is not added. */
static ffd_status sample_part(const sampler *s, double end, const double *at_end, int halvings)
{
    path_samples *const samples = s->samples;
    const double begin = samples->times[samples->count - 1];
    const double middle = (double)(float)((begin + end) / 2);
    const bool is_between = middle > begin && middle < (double)(float)end;
    double *const at_middle = new_offsets(s);
    ffd_status status;
    TRY_END(at_middle ? FFD_OK : ffd_fail_memory(s->error));
    TRY_END(evaluate(s, is_between ? middle : (begin + end) / 2, at_middle));
    const double away = distance_from_mean(samples, at_middle,
                                           samples->offsets + (samples->count - 1) * samples->width, at_end);
    if (!(away > s->by->nearness) || halvings == MOST_HALVINGS || !is_between) {
        samples->chord = larger_of(samples->chord, away);
    } else {
        TRY_END(sample_part(s, middle, at_middle, halvings + 1));
        TRY_END(add_sample(s, middle, false, at_middle));
        TRY_END(sample_part(s, end, at_end, halvings + 1));
    }
end:
    ffd_free(at_middle);
    return status;
}

/* Adds the samples behind a key up to the next one, which is added too. */
static ffd_status sample_interval(const sampler *s, double from, double to)
{
    /* Times in decimals: 0.1 seconds may be a little more. */
    const double wanted = ceil_of(s->by->frames * (to - from) * (1 - STILL));
    const double parts = wanted >= 1 ? wanted : 1;
    double *const offsets = new_offsets(s);
    double last = (double)(float)from;
    ffd_status status;
    TRY_END(offsets ? FFD_OK : ffd_fail_memory(s->error));
    for (double i = 1; i <= parts; i++) {
        const bool is_key = i == parts;
        const double time = is_key ? to : (double)(float)(from + (to - from) * (i / parts));
        if (!is_key && !(time > last && time < (double)(float)to))
            continue; /* the file cannot tell these times apart */
        TRY_END(evaluate(s, time, offsets));
        TRY_END(sample_part(s, time, offsets, 0));
        TRY_END(add_sample(s, time, is_key, offsets));
        last = (double)(float)time;
    }
end:
    ffd_free(offsets);
    return status;
}

static ffd_status sample_keys(const sampler *s, const double *times, size_t count, bool between)
{
    double *const offsets = new_offsets(s);
    ffd_status status;
    TRY_END(offsets ? FFD_OK : ffd_fail_memory(s->error));
    for (size_t k = 0; k < count; k++) {
        if (k > 0 && between) {
            TRY_END(sample_interval(s, times[k - 1], times[k]));
            continue;
        }
        TRY_END(evaluate(s, times[k], offsets));
        TRY_END(add_sample(s, times[k], true, offsets));
    }
end:
    ffd_free(offsets);
    return status;
}

ffd_status ffd_path_sample(ffd_lattice *lattice, const sampling *by, memory_budget *budget,
                           path_samples *samples, ffd_error *error)
{
    const sampler s = {lattice, by, budget, samples, error};
    const size_t count = ffd_lattice_get_keys(lattice, NULL);
    double *const times = ffd_alloc(count, sizeof *times);
    *samples = (path_samples){.places = lattice->count, .width = 3 * lattice->count};
    ffd_status status;
    TRY_END(times ? FFD_OK : ffd_fail_memory(error));
    ffd_lattice_get_keys(lattice, times);
    /* Points go straight between keys; values take them along curves. */
    TRY_END(sample_keys(&s, times, count, lattice->spec->keys.kind == KEYS_VALUES));
end:
    ffd_free(times);
    return status;
}
