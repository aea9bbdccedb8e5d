/* moves_sample.h - random moves (data/schema/lattice.md 8), written as JSON and carried out in long double
 * with libm. */
#ifndef FFD_TESTS_MOVES_SAMPLE_H
#define FFD_TESTS_MOVES_SAMPLE_H

#include "sample.h"

/* The control points while moves are applied, and the largest coordinate that came up on the way. */
typedef struct moved_points {
    const sample *s;
    const double *rest;
    long double *points;
    bool *selected;
    size_t count, selected_count;
    long double size;
} moved_points;

/* Starts from deformed (3 * count doubles). */
moved_points moved_start(const sample *s, const double *rest, const double *deformed);
void moved_free(moved_points *m);

/* Appends one random move to s->moves and applies it. */
void moved_random(moved_points *m, sample *s, draw *random);

#endif
