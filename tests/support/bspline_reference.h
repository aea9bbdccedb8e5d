/* bspline_reference.h - reference basis functions: the plain Cox-de Boor recursion in long double, over all
   functions. Slow, and shares no code with the triangular scheme that it checks. */
#ifndef FFD_TESTS_BSPLINE_REFERENCE_H
#define FFD_TESTS_BSPLINE_REFERENCE_H

#include <stddef.h>

/* Returns the span where N_{i,0} is 1: the last non-empty span of the domain that begins at or before u. */
static inline size_t reference_span(const double *t, size_t functions, int degree, double u)
{
    size_t span = (size_t)degree;
    while (!(t[span] < t[span + 1]))
        span++;
    for (size_t s = span; s < functions; s++)
        if (t[s] < t[s + 1] && t[s] <= u)
            span = s;
    return span;
}

static inline long double reference_quotient(long double numerator, long double denominator)
{
    return denominator > 0 ? numerator / denominator : 0;
}

static inline long double reference_value(const double *t, size_t span, size_t i, int degree, double u)
{
    if (degree == 0)
        return i == span ? 1 : 0;
    const size_t d = (size_t)degree;
    if (i > span || i + d < span)
        return 0;
    const long double x = u;
    return reference_quotient(x - t[i], (long double)t[i + d] - t[i]) *
               reference_value(t, span, i, degree - 1, u) +
           reference_quotient(t[i + d + 1] - x, (long double)t[i + d + 1] - t[i + 1]) *
               reference_value(t, span, i + 1, degree - 1, u);
}

/* The two terms of N'_{i,d}. The derivative is rising - falling. */
static inline void reference_slopes(const double *t, size_t span, size_t i, int degree, double u,
                                    long double *rising, long double *falling)
{
    const size_t d = (size_t)degree;
    *rising =
        reference_quotient(degree, (long double)t[i + d] - t[i]) * reference_value(t, span, i, degree - 1, u);
    *falling = reference_quotient(degree, (long double)t[i + d + 1] - t[i + 1]) *
               reference_value(t, span, i + 1, degree - 1, u);
}

#endif
