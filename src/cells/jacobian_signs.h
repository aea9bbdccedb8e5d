/* jacobian_signs.h - the signs of a cell's Jacobian at the places that are looked at. */
#ifndef FFD_CELLS_JACOBIAN_SIGNS_H
#define FFD_CELLS_JACOBIAN_SIGNS_H

#include "base/arithmetic.h"
#include <stdbool.h>

/* What is known of a cell's Jacobian, everywhere in it. */
typedef enum jacobian_state {
    JACOBIAN_UNKNOWN, /* not decided */
    JACOBIAN_POSITIVE,
    JACOBIAN_NEGATIVE,
    JACOBIAN_MIXED /* it is 0 somewhere, or has both signs */
} jacobian_state;

typedef struct jacobian_signs {
    unsigned positive, negative, zero;
    unsigned undecided; /* closer to 0 than rounding */
    double least;       /* of all values; infinite: there is none */
} jacobian_signs;

static inline jacobian_signs no_signs(void)
{
    return (jacobian_signs){.least = HUGE_VAL};
}

/* Adds a value whose error is at most this large. Without an error its sign is exact. */
static inline void add_sign(jacobian_signs *signs, double value, double error)
{
    const bool positive = value > error, negative = value < -error, zero = value == 0 && error == 0;
    signs->positive += positive;
    signs->negative += negative;
    signs->zero += zero;
    signs->undecided += !positive && !negative && !zero; /* NaN, too */
    signs->least = value < signs->least ? value : signs->least;
}

/* What signs at some places say of all of them, if others are not looked at. */
static inline jacobian_state state_of(const jacobian_signs *signs)
{
    if (signs->zero || (signs->positive && signs->negative))
        return JACOBIAN_MIXED;
    if (signs->undecided || (!signs->positive && !signs->negative))
        return JACOBIAN_UNKNOWN;
    return signs->positive ? JACOBIAN_POSITIVE : JACOBIAN_NEGATIVE;
}

/* The same of a quadratic cell, whose signs say nothing where they differ: it bulges, and may be mended by
   its middles. */
static inline jacobian_state quadratic_state_of(const jacobian_signs *signs)
{
    return signs->positive && (signs->negative || signs->zero) ? JACOBIAN_UNKNOWN : state_of(signs);
}

#endif
