/* triangle.h - one step of the triangular scheme that basis functions and blossoms share. */
#ifndef FFD_SPLINE_TRIANGLE_H
#define FFD_SPLINE_TRIANGLE_H

/* Computes, from the `degree` functions of degree - 1 that are not 0 on span, the degree + 1 ones of this
   degree, in place (Piegl & Tiller A2.2). The quotients, not the reciprocals of the differences, are
   multiplied in: at a knot they are exactly 0 and 1, so that a clamped curve meets its end points to the
   bit. With another u in each step the result is the blossom's coefficients at these u instead (Ramshaw).
   t_span <= u <= t_{span+1}. */
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
