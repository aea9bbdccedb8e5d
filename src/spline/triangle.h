/* triangle.h - one step of the triangular scheme for basis functions and blossoms. */
#ifndef FFD_SPLINE_TRIANGLE_H
#define FFD_SPLINE_TRIANGLE_H

/* Replaces the `degree` non-zero basis functions of degree - 1 on a span by the degree + 1 functions of this
   degree, in place (Piegl & Tiller A2.2), for t_span <= u <= t_{span+1}. It multiplies by quotients (u -
   t_i)/(t_j - t_i) instead of by reciprocals of the differences: at a knot they are exactly 0 or 1, so a
   clamped curve meets its end points to the bit. With a different u in each step the result is the
   coefficients of the blossom at these u (Ramshaw). */
static inline void triangle_raise(const double *t, int span, int degree, double u, double *value)
{
    const double *const left = t + span + 1 - degree, *const right = t + span + 1;
    double from_left = 0;
    for (int r = 0; r < degree; r++) {
        const double width = right[r] - left[r];
        const double lower = value[r];
        value[r] = from_left + lower * ((right[r] - u) / width);
        from_left = lower * ((u - left[r]) / width);
    }
    value[degree] = from_left;
}

#endif
