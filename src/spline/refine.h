/* refine.h - the same spline with more knots, or of a higher degree: its knots, and its control points by
   blossoms (Piegl & Tiller 5.2 and 5.5; Ramshaw, Blossoming, 1987). */
#ifndef FFD_SPLINE_REFINE_H
#define FFD_SPLINE_REFINE_H

#include "base/fail.h"
#include "spline/knot_vector.h"
#include <stdint.h>

/* The knots of a direction on the way to finer ones. */
typedef struct knot_row {
    int degree;
    size_t points;
    bool closed;
    double *t; /* points + degree + 1 knots; closed: the points + 1 breakpoints of one period */
} knot_row;

/* What is wanted of a direction. */
typedef struct refine_wish {
    bool clamped;         /* both ends, unless the direction is closed */
    int degree;           /* 0: as it is */
    size_t points;        /* at least so many, by halving the longest spans; 0: as they are */
    const double *insert; /* insert_count knots, in any order, closed: modulo the period */
    size_t insert_count;
} refine_wish;

/* Clamped once, one row a degree, knots inserted. */
#define REFINE_ROWS (3 + MAX_DEGREE)

/* The rows from that of a knot vector to the one that is wanted. Each follows from the one before by inserted
   knots, or, where the degrees differ, by an elevation of one degree. */
typedef struct refine_plan {
    knot_row rows[REFINE_ROWS];
    size_t count;
} refine_plan;

/* Refuses more than `most` control points of a direction: 'u', 'v' or 'w', for the message. Errors:
   FFD_E_LIMIT. */
ffd_status ffd_refine_check_count(size_t points, char direction, size_t most, ffd_error *error);

/* Makes the plan. direction: 'u', 'v' or 'w', for messages. *plan is empty after a failure. Errors:
   FFD_E_ARGUMENT for a knot outside of the domain, too many equal ones, a degree or a number of control
   points that is less than now, or a degree above MAX_DEGREE; FFD_E_LIMIT for more than `most` control
   points; FFD_E_MEMORY. */
ffd_status ffd_refine_plan(const knot_vector *knots, const refine_wish *wish, char direction, size_t most,
                           refine_plan *plan, ffd_error *error);
/* Frees the plan and empties it; it can be freed again. */
void ffd_refine_plan_free(refine_plan *plan);

/* What stands for a control point that is a copy of none. */
#define REFINE_NEW SIZE_MAX

/* Computes the control points of `to` from those of `from`, the row before it. Point i of line l begins at
   in[before * (i + points * l)] and has `before` numbers; there are `lines`. copied: for each control point
   of `to` the one of `from` that it has to the bit, or REFINE_NEW. Errors: FFD_E_MEMORY. */
ffd_status ffd_refine_points(const knot_row *from, const knot_row *to, const double *in, size_t before,
                             size_t lines, double *out, size_t *copied, ffd_error *error);

#endif
