#include "fit/pairs.h"
#include "author/mirror_layers.h"
#include "base/arithmetic.h"
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include "base/vector/vec.h"
#include "points/span.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* What is known of all pairs of the caller. */
typedef struct given_pairs {
    const ffd_fit_desc *desc;
    ffd_span source, target;
    size_t own_count, count; /* of the caller; with mirror images */
    double *ends;            /* with them: all sources, then all targets */
    bool *exact;
    ffd_embedding *embedding;
    double *moved; /* where the base takes the sources */
} given_pairs;

static ffd_status check(given_pairs *given, ffd_error *error)
{
    const ffd_fit_desc *const desc = given->desc;
    given->source = desc->source;
    given->target = desc->target;
    given->own_count = given->count = desc->source.count;
    if (given->count != desc->target.count)
        return ffd_fail(error, FFD_E_INVALID, "there are %zu sources, but %zu targets", given->count,
                        desc->target.count);
    if (given->count == 0)
        return ffd_fail(error, FFD_E_INVALID, "there are no pairs");
    TRY(ffd_span_check(&given->source, given->count, "the array of sources", error));
    TRY(ffd_span_check(&given->target, given->count, "the array of targets", error));
    for (size_t i = 0; i < given->count; i++) {
        double ends[6];
        ffd_span_read(&given->source, i, 1, ends);
        ffd_span_read(&given->target, i, 1, ends + 3);
        if (!vec_is_finite(ends) || !vec_is_finite(ends + 3))
            return ffd_fail(error, FFD_E_INVALID, "pair %zu has a coordinate that is not finite",
                            i + desc->numbered_from);
        if (desc->weights && !(desc->weights[i] >= 0 && isfinite(desc->weights[i])))
            return ffd_fail(error, FFD_E_INVALID,
                            "the weight of pair %zu is %g, but weights are finite and at least 0",
                            i + desc->numbered_from, desc->weights[i]);
    }
    return FFD_OK;
}

/* Adds the mirror images of all pairs behind them. */
static ffd_status add_images(given_pairs *given, ffd_error *error)
{
    const size_t own = given->own_count;
    layer_reflection by;
    if (given->desc->symmetric == 0)
        return FFD_OK;
    TRY(ffd_layer_reflection_make(given->desc->base, given->desc->symmetric - 1, &by, error));
    given->ends = ffd_alloc(own, 4 * 3 * sizeof *given->ends);
    if (!given->ends)
        return ffd_fail_memory(error);
    double *const ends[] = {given->ends, given->ends + 6 * own};
    ffd_span_read(&given->source, 0, own, ends[0]);
    ffd_span_read(&given->target, 0, own, ends[1]);
    for (size_t e = 0; e < 2; e++)
        for (size_t i = 0; i < own; i++)
            ffd_reflect_place(&by, ends[e] + 3 * i, ends[e] + 3 * (own + i));
    given->count = 2 * own;
    given->source = (ffd_span){.data = ends[0], .count = given->count};
    given->target = (ffd_span){.data = ends[1], .count = given->count};
    TRY(ffd_span_check(&given->source, given->count, "the array of sources", error));
    return ffd_span_check(&given->target, given->count, "the array of targets", error);
}

static ffd_status mark_exact(given_pairs *given, ffd_error *error)
{
    given->exact = ffd_alloc_zero(given->count, sizeof *given->exact);
    if (!given->exact)
        return ffd_fail_memory(error);
    for (size_t e = 0; e < given->desc->exact_count; e++) {
        if (given->desc->exact[e] >= given->own_count)
            return ffd_fail(error, FFD_E_ARGUMENT, "there is no pair %zu that could be exact",
                            given->desc->exact[e]);
        given->exact[given->desc->exact[e]] = true;
    }
    for (size_t i = given->own_count; i < given->count; i++)
        given->exact[i] = given->exact[i - given->own_count];
    return FFD_OK;
}

static ffd_status embed(given_pairs *given, const ffd_run_options *options, ffd_error *error)
{
    ffd_embedding_desc desc;
    ffd_embedding_desc_init(&desc, sizeof desc);
    desc.lattice = given->desc->base;
    desc.points = given->source;
    desc.snap = given->desc->snap;
    TRY(ffd_embedding_create(&desc, options, &given->embedding, error));
    given->moved = ffd_alloc(given->count, 3 * sizeof *given->moved);
    if (!given->moved)
        return ffd_fail_memory(error);
    const ffd_span moved = {.data = given->moved, .count = given->count};
    return ffd_embedding_deform(given->embedding, desc.lattice, given->source, moved, NULL, options, error);
}

static double weight_of(const given_pairs *given, size_t i)
{
    const double *const weights = given->desc->weights;
    return given->exact[i] || !weights ? 1 : weights[i % given->own_count];
}

/* Counts a pair, unless it is an image, and tells whether it is used. */
static ffd_status count_pair(const given_pairs *given, size_t i, ffd_fit_result *result, bool *is_used,
                             ffd_error *error)
{
    const uint8_t status = ffd_embedding_get_status(given->embedding)[i];
    const bool weighs = weight_of(given, i) > 0, counts = weighs && i < given->own_count;
    *is_used = status == FFD_VERTEX_INSIDE && weighs;
    result->exact += counts && given->exact[i];
    result->outside += counts && status == FFD_VERTEX_OUTSIDE;
    result->multiple += counts && status == FFD_VERTEX_MULTIPLE;
    result->singular += counts && status == FFD_VERTEX_SINGULAR;
    return given->exact[i] && !*is_used
               ? ffd_fail(error, FFD_E_EMBEDDING, "the exact pair %zu is not inside the lattice: %s",
                          i % given->own_count + given->desc->numbered_from,
                          ffd_vertex_status_name((ffd_vertex_status)status))
               : FFD_OK;
}

static void add_pair(const given_pairs *given, size_t i, fit_pairs *pairs)
{
    const size_t n = pairs->count++;
    pairs->numbers[n] = i % given->own_count;
    ffd_span_read(&given->source, i, 1, pairs->x + 3 * n);
    ffd_span_read(&given->target, i, 1, pairs->y + 3 * n);
    for (size_t c = 0; c < 3; c++)
        pairs->y[3 * n + c] -= given->moved[3 * i + c];
    memcpy(pairs->uvw + 3 * n, ffd_embedding_get_uvw(given->embedding) + 3 * i, 3 * sizeof *pairs->uvw);
    pairs->exact[n] = given->exact[i];
    pairs->given[n] = pairs->weights[n] = weight_of(given, i);
}

static ffd_status allocate(size_t count, fit_pairs *pairs, ffd_error *error)
{
    *pairs = (fit_pairs){.numbers = ffd_alloc(count, sizeof *pairs->numbers),
                         .x = ffd_alloc(count, 3 * sizeof *pairs->x),
                         .y = ffd_alloc(count, 3 * sizeof *pairs->y),
                         .uvw = ffd_alloc(count, 3 * sizeof *pairs->uvw),
                         .given = ffd_alloc(count, sizeof *pairs->given),
                         .weights = ffd_alloc(count, sizeof *pairs->weights),
                         .exact = ffd_alloc(count, sizeof *pairs->exact)};
    return pairs->numbers && pairs->x && pairs->y && pairs->uvw && pairs->given && pairs->weights &&
                   pairs->exact
               ? FFD_OK
               : ffd_fail_memory(error);
}

/* Divides all weights, of exact pairs too, by a power of four, so that the largest is near 1: only their
   ratios count, and their sums are numbers. Their roots keep their digits. */
static void scale_weights(fit_pairs *pairs)
{
    double largest = 0;
    int power;
    for (size_t i = 0; i < pairs->count; i++)
        largest = larger_of(largest, pairs->given[i]);
    (void)frexp(largest, &power);
    for (size_t i = 0; i < pairs->count; i++)
        pairs->given[i] = pairs->weights[i] = ldexp(pairs->given[i], power % 2 - power);
}

ffd_status ffd_pairs_make(const ffd_fit_desc *desc, const ffd_run_options *options, fit_pairs *pairs,
                          ffd_fit_result *result, ffd_error *error)
{
    given_pairs given = {.desc = desc};
    ffd_status status;
    *pairs = (fit_pairs){.count = 0};
    TRY_END(check(&given, error));
    TRY_END(add_images(&given, error));
    TRY_END(mark_exact(&given, error));
    TRY_END(embed(&given, options, error));
    TRY_END(allocate(given.count, pairs, error));
    for (size_t i = 0; i < given.count; i++) {
        bool is_used;
        TRY_END(count_pair(&given, i, result, &is_used, error));
        if (is_used)
            add_pair(&given, i, pairs);
        if (i < given.own_count)
            pairs->own_count = pairs->count;
    }
    result->pairs = given.own_count;
    result->used = pairs->own_count;
    scale_weights(pairs);
    if (pairs->own_count == 0)
        status = ffd_fail(error, FFD_E_EMBEDDING, "none of %zu pairs is inside the lattice", given.own_count);
end:
    ffd_free(given.ends);
    ffd_embedding_destroy(&given.embedding);
    ffd_free(given.exact);
    ffd_free(given.moved);
    return status;
}

void ffd_pairs_free(fit_pairs *pairs)
{
    ffd_free(pairs->numbers);
    ffd_free(pairs->x);
    ffd_free(pairs->y);
    ffd_free(pairs->uvw);
    ffd_free(pairs->given);
    ffd_free(pairs->weights);
    ffd_free(pairs->exact);
    *pairs = (fit_pairs){.count = 0};
}

/* A pair by its source. */
typedef struct source_entry {
    double x[3];
    size_t pair;
} source_entry;

static int compare_sources(const void *a, const void *b)
{
    const source_entry *const one = a, *const other = b;
    for (int c = 0; c < 3; c++)
        if (one->x[c] != other->x[c])
            return one->x[c] < other->x[c] ? -1 : 1;
    return (one->pair > other->pair) - (one->pair < other->pair);
}

/* Returns how far a target is from the weighted mean of those of entries at one position. */
static double spread_of(const fit_pairs *pairs, const source_entry *entries, size_t count)
{
    double mean[3] = {0, 0, 0}, sum = 0, largest = 0;
    for (size_t i = 0; i < count; i++) {
        const size_t pair = entries[i].pair;
        sum += pairs->weights[pair];
        for (size_t c = 0; c < 3 && sum > 0; c++)
            mean[c] += pairs->weights[pair] / sum * (pairs->y[3 * pair + c] - mean[c]);
    }
    for (size_t i = 0; i < count; i++) {
        double off[3];
        for (size_t c = 0; c < 3; c++)
            off[c] = pairs->y[3 * entries[i].pair + c] - mean[c];
        largest = larger_of(largest, vec_length(off));
    }
    return largest;
}

static bool targets_differ(const fit_pairs *pairs, const source_entry *entries, size_t count)
{
    for (size_t i = 1; i < count; i++)
        if (memcmp(pairs->y + 3 * entries[i].pair, pairs->y + 3 * entries[0].pair, 3 * sizeof *pairs->y) != 0)
            return true;
    return false;
}

ffd_status ffd_pairs_find_spread(const fit_pairs *pairs, uint64_t *positions, double *largest,
                                 ffd_error *error)
{
    source_entry *const entries = ffd_alloc(pairs->own_count, sizeof *entries);
    if (!entries)
        return ffd_fail_memory(error);
    for (size_t i = 0; i < pairs->own_count; i++) {
        for (size_t c = 0; c < 3; c++)
            entries[i].x[c] = pairs->x[3 * i + c] + 0.0;
        entries[i].pair = i;
    }
    qsort(entries, pairs->own_count, sizeof *entries, compare_sources);
    *positions = 0;
    *largest = 0;
    for (size_t first = 0, last; first < pairs->own_count; first = last) {
        for (last = first + 1; last < pairs->own_count; last++)
            if (memcmp(entries[last].x, entries[first].x, sizeof entries->x) != 0)
                break;
        if (!targets_differ(pairs, entries + first, last - first))
            continue;
        ++*positions;
        *largest = larger_of(*largest, spread_of(pairs, entries + first, last - first));
    }
    ffd_free(entries);
    return FFD_OK;
}

ffd_status ffd_pairs_count_unseen(const fit_pairs *pairs, const fit_unknowns *unknowns, uint64_t *count,
                                  ffd_error *error)
{
    bool *const seen = ffd_alloc_zero(unknowns->count, sizeof *seen);
    double row[LONGEST_ROW];
    uint32_t at[LONGEST_ROW];
    if (!seen)
        return ffd_fail_memory(error);
    for (size_t i = 0; i < pairs->count && !ffd_deadline_passed_at(i); i++) {
        ffd_unknowns_row(unknowns, pairs->uvw + 3 * i, row);
        ffd_unknowns_seen(unknowns, pairs->uvw + 3 * i, at);
        for (size_t n = 0; n < unknowns->row; n++)
            seen[at[n]] = seen[at[n]] || row[n] != 0;
    }
    *count = unknowns->count;
    for (size_t i = 0; i < unknowns->count; i++)
        *count -= seen[i];
    ffd_free(seen);
    return ffd_deadline_check(error);
}

static int compare_numbers(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

double ffd_quantile(double *numbers, size_t count, double share)
{
    const double exact = share * (double)count;
    const size_t below = (size_t)exact, rank = (double)below < exact ? below + 1 : below;
    qsort(numbers, count, sizeof *numbers, compare_numbers);
    return numbers[rank > 0 ? rank - 1 : 0];
}

double ffd_median(double *numbers, size_t count)
{
    qsort(numbers, count, sizeof *numbers, compare_numbers);
    return count == 0 ? 0 : (numbers[(count - 1) / 2] + numbers[count / 2]) / 2;
}
