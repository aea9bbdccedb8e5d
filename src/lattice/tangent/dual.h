/* dual.h - dual numbers: a value with its derivative by one parameter, for forward differentiation (Griewank
   & Walther, Evaluating Derivatives, 2nd ed., 3.1). */
#ifndef FFD_LATTICE_TANGENT_DUAL_H
#define FFD_LATTICE_TANGENT_DUAL_H

#include <math.h>

typedef struct dual {
    double v, d; /* value and derivative */
} dual;

typedef struct dual3 {
    dual c[3];
} dual3;

static inline dual dual_of(double v)
{
    return (dual){v, 0};
}

static inline dual dual_add(dual a, dual b)
{
    return (dual){a.v + b.v, a.d + b.d};
}

static inline dual dual_sub(dual a, dual b)
{
    return (dual){a.v - b.v, a.d - b.d};
}

static inline dual dual_mul(dual a, dual b)
{
    return (dual){a.v * b.v, a.d * b.v + a.v * b.d};
}

static inline dual dual_div(dual a, dual b)
{
    const double q = a.v / b.v;
    return (dual){q, (a.d - q * b.d) / b.v};
}

static inline dual dual_scale(dual a, double k)
{
    return (dual){k * a.v, k * a.d};
}

/* At 0 the square root has no derivative; the result has derivative 0. */
static inline dual dual_sqrt(dual a)
{
    const double root = sqrt(a.v);
    return (dual){root, root > 0 ? 0.5 * a.d / root : 0};
}

static inline dual3 dual3_add(dual3 a, dual3 b)
{
    return (dual3){{dual_add(a.c[0], b.c[0]), dual_add(a.c[1], b.c[1]), dual_add(a.c[2], b.c[2])}};
}

static inline dual3 dual3_sub(dual3 a, dual3 b)
{
    return (dual3){{dual_sub(a.c[0], b.c[0]), dual_sub(a.c[1], b.c[1]), dual_sub(a.c[2], b.c[2])}};
}

static inline dual3 dual3_scale(dual3 a, dual k)
{
    return (dual3){{dual_mul(a.c[0], k), dual_mul(a.c[1], k), dual_mul(a.c[2], k)}};
}

static inline dual dual3_dot(dual3 a, dual3 b)
{
    return dual_add(dual_add(dual_mul(a.c[0], b.c[0]), dual_mul(a.c[1], b.c[1])), dual_mul(a.c[2], b.c[2]));
}

static inline dual3 dual3_cross(dual3 a, dual3 b)
{
    dual3 out;
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        out.c[i] = dual_sub(dual_mul(a.c[j], b.c[k]), dual_mul(a.c[k], b.c[j]));
    }
    return out;
}

/* Normalises a vector that is not 0. */
static inline dual3 dual3_unit(dual3 a)
{
    return dual3_scale(a, dual_div(dual_of(1), dual_sqrt(dual3_dot(a, a))));
}

#endif
