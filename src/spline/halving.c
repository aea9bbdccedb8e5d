#include "spline/halving.h"
#include "base/memory/memory.h"
#include <stdlib.h>

/* Spans that differ by rounding count as equally long. */
#define ALIKE (1 - 1e-9)

typedef struct span_piece {
    double begin, end;
} span_piece;

/* The first `heaped` pieces are a heap with the longest one at its top, the others were taken from it. */
typedef struct halving {
    span_piece *pieces;
    size_t count, heaped;
} halving;

static double length_of(const span_piece *piece)
{
    return piece->end - piece->begin;
}

static int compare_begins(const void *a, const void *b)
{
    const span_piece *const x = a, *const y = b;
    return (x->begin > y->begin) - (x->begin < y->begin);
}

static void swap(span_piece *a, span_piece *b)
{
    const span_piece piece = *a;
    *a = *b;
    *b = piece;
}

/* Puts the piece behind the heap into it. */
static void put(halving *h)
{
    span_piece *const p = h->pieces;
    for (size_t i = h->heaped++; i > 0 && length_of(&p[i]) > length_of(&p[(i - 1) / 2]); i = (i - 1) / 2)
        swap(&p[i], &p[(i - 1) / 2]);
}

/* Takes the longest piece, which then stands behind the heap. */
static void take(halving *h)
{
    span_piece *const p = h->pieces;
    const size_t last = --h->heaped;
    swap(&p[0], &p[last]);
    for (size_t i = 0, longest;; i = longest) {
        longest = i;
        for (size_t child = 2 * i + 1; child <= 2 * i + 2 && child < last; child++)
            longest = length_of(&p[child]) > length_of(&p[longest]) ? child : longest;
        if (longest == i)
            return;
        swap(&p[i], &p[longest]);
    }
}

/* Halves the longest pieces, `most` at most. Returns false if one has no middle. */
static bool halve_longest(halving *h, size_t most, double *middles, size_t *found)
{
    const double least = ALIKE * length_of(&h->pieces[0]);
    const size_t all = h->count;
    while (h->heaped > 0 && length_of(&h->pieces[0]) >= least)
        take(h);
    qsort(h->pieces + h->heaped, all - h->heaped, sizeof *h->pieces, compare_begins);
    for (size_t i = h->heaped; i < all && *found < most; i++) {
        span_piece *const piece = &h->pieces[i];
        const double middle = 0.5 * piece->begin + 0.5 * piece->end;
        if (!(piece->begin < middle && middle < piece->end))
            return false;
        middles[(*found)++] = middle;
        h->pieces[h->count++] = (span_piece){middle, piece->end};
        piece->end = middle;
    }
    while (h->heaped < h->count)
        put(h);
    return true;
}

ffd_status ffd_halve_spans(const double *t, size_t first, size_t last, size_t count, double *middles,
                           size_t *found, ffd_error *error)
{
    halving h = {.pieces = ffd_alloc(last - first + count, sizeof *h.pieces)};
    *found = 0;
    if (!h.pieces)
        return ffd_fail_memory(error);
    for (size_t i = first; i < last; i++)
        if (t[i] < t[i + 1]) {
            h.pieces[h.count++] = (span_piece){t[i], t[i + 1]};
            put(&h);
        }
    bool goes_on = true;
    while (goes_on && *found < count)
        goes_on = halve_longest(&h, count, middles, found);
    ffd_free(h.pieces);
    return FFD_OK;
}
