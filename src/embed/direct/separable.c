/* separable.c - lattices with P_ijk = (x_i, y_j, z_k), each sequence strictly monotone: three equations in
   one unknown, each with one root or none. */
#include "embed/direct/separable.h"
#include "base/lower_bound.h"
#include "base/memory/memory.h"
#include "base/vector/vec.h"
#include "spline/basis.h"
#include <math.h>

static size_t stride_of(const ffd_lattice *lattice, int a)
{
    return a == 0 ? 1 : a == 1 ? lattice->size[0] : lattice->size[0] * lattice->size[1];
}

/* Returns whether coordinate a of every control point depends only on its index in direction a. */
static bool depends_on_own_index(const ffd_lattice *lattice, int a)
{
    const size_t stride = stride_of(lattice, a);
    for (size_t n = 0; n < lattice->count; n++) {
        const size_t index = n / stride % lattice->size[a];
        if (lattice->rest[3 * n + (size_t)a] != lattice->rest[3 * index * stride + (size_t)a])
            return false;
    }
    return true;
}

static bool is_strictly_monotone(const ffd_lattice *lattice, int a)
{
    const size_t stride = stride_of(lattice, a);
    const double *x = lattice->rest + a;
    const bool falling = x[3 * stride] < x[0];
    for (size_t i = 1; i < lattice->size[a]; i++) {
        const double before = x[3 * (i - 1) * stride], here = x[3 * i * stride];
        if (falling ? !(here < before) : !(here > before))
            return false;
    }
    return true;
}

/* Evaluates the curve at u = t_span + offset. */
static double value_at(const knot_vector *knots, const monotone_curve *curve, int span, double offset,
                       double *slope)
{
    double value[MAX_ORDER], derivative[MAX_ORDER], x = 0, dx = 0;
    ffd_basis_derivatives_in(knots, span, offset, value, derivative);
    const double *points = curve->points + (span - knots->degree);
    for (int i = 0; i <= knots->degree; i++) {
        x += points[i] * value[i];
        dx += points[i] * derivative[i];
    }
    *slope = dx;
    return x;
}

static ffd_status make_curve(ffd_locator *locator, int a, ffd_error *error)
{
    const ffd_lattice *lattice = locator->lattice;
    const knot_vector *knots = &locator->knots[a];
    monotone_curve *curve = &locator->curves[a];
    const size_t stride = stride_of(lattice, a);
    curve->points = ffd_alloc(lattice->size[a], sizeof(double));
    curve->breakpoints = ffd_alloc(knots->span_count + 1, sizeof(double));
    if (!curve->points || !curve->breakpoints)
        return ffd_fail_memory(error);
    for (size_t i = 0; i < lattice->size[a]; i++)
        curve->points[i] = lattice->rest[3 * i * stride + (size_t)a] - locator->origin[a];
    curve->falling = curve->points[1] < curve->points[0];
    double slope;
    for (size_t s = 0; s < knots->span_count; s++)
        curve->breakpoints[s] = value_at(knots, curve, knots->spans[s], 0, &slope);
    const int last = knots->spans[knots->span_count - 1];
    curve->breakpoints[knots->span_count] =
        value_at(knots, curve, last, knots->t[last + 1] - knots->t[last], &slope);
    return FFD_OK;
}

ffd_status ffd_separable_detect(ffd_locator *locator, bool *found, ffd_error *error)
{
    const ffd_lattice *lattice = locator->lattice;
    *found = false;
    if (lattice->rest_weights)
        return FFD_OK;
    for (int a = 0; a < 3; a++)
        if (ffd_knots_closed(&lattice->knots[a]) || !depends_on_own_index(lattice, a) ||
            !is_strictly_monotone(lattice, a))
            return FFD_OK;
    *found = true;
    for (int a = 0; a < 3; a++)
        TRY(make_curve(locator, a, error));
    return FFD_OK;
}

void ffd_separable_free(ffd_locator *locator)
{
    for (int a = 0; a < 3; a++) {
        ffd_free(locator->curves[a].points);
        ffd_free(locator->curves[a].breakpoints);
    }
}

typedef struct curve_value {
    double x;
    bool falling;
} curve_value;

static bool is_value_up_to(const void *breakpoint, const void *value)
{
    const curve_value *const v = value;
    const double here = *(const double *)breakpoint;
    return v->falling ? v->x <= here : v->x >= here;
}

/* Returns the index of the span whose range of values contains x; the first or last one for x beyond the
   ends. */
static size_t span_holding(const knot_vector *knots, const monotone_curve *curve, double x)
{
    const curve_value value = {x, curve->falling};
    return last_up_to(&value, curve->breakpoints, knots->span_count, sizeof *curve->breakpoints,
                      is_value_up_to);
}

/* Solves x(u) = x in a span, in offsets from its start: Newton steps, and bisection if a step leaves the
   bracket or reduces it by less than half. Stops when the bracket is two adjacent doubles, or x(u) = x. For x
   beyond the ends, returns the nearest end. Sets *residual to x(u) - x, and *grain to the change of x(u) by
   rounding u. */
static double solve(const knot_vector *knots, const monotone_curve *curve, double x, double *residual,
                    double *grain)
{
    const size_t index = span_holding(knots, curve, x);
    const int span = knots->spans[index];
    double low = 0, high = knots->t[span + 1] - knots->t[span], u = 0.5 * high;
    double best = u, best_residual = HUGE_VAL, slope;
    const double sign = curve->falling ? -1 : 1;
    const double ends[2] = {low, high};
    for (int e = 0; e < 2; e++) {
        const double off = value_at(knots, curve, span, ends[e], &slope) - x;
        if (fabs(off) < fabs(best_residual)) {
            best = ends[e];
            best_residual = off;
        }
    }
    /* Twice the bits of a double: bisection alone would have ended by then. */
    for (int step = 0; step < 128 && best_residual != 0; step++) {
        const double off = value_at(knots, curve, span, u, &slope) - x;
        if (fabs(off) < fabs(best_residual)) {
            best = u;
            best_residual = off;
        }
        if (sign * off > 0)
            high = u;
        else
            low = u;
        double next = u - off / slope;
        if (!(next > low && next < high))
            next = 0.5 * low + 0.5 * high;
        if (next == u || !(next > low && next < high))
            break;
        u = next;
    }
    *residual = best_residual;
    value_at(knots, curve, span, best, &slope);
    *grain = fabs(slope) * DBL_EPSILON * best;
    return knots->t[span] + best;
}

void ffd_separable_find(const ffd_locator *locator, const double p[3], ffd_location *location)
{
    double residual[3], tolerance[3], uvw[3], grain[3];
    ffd_locator_tolerance(locator, p, tolerance);
    for (int a = 0; a < 3; a++) {
        /* Early exit for points far outside. */
        const monotone_curve *curve = &locator->curves[a];
        const double first = curve->breakpoints[0], last = curve->breakpoints[locator->knots[a].span_count];
        if (p[a] < minimum_number(first, last) - tolerance[a] ||
            p[a] > maximum_number(first, last) + tolerance[a])
            return;
    }
    for (int a = 0; a < 3; a++)
        uvw[a] = solve(&locator->knots[a], &locator->curves[a], p[a], &residual[a], &grain[a]);
    for (int a = 0; a < 3; a++)
        tolerance[a] += grain[a];
    /* Whether the point is outside was tested first. */
    const bool found = ffd_within_tolerance(residual, tolerance);
    location->status = found ? FFD_VERTEX_INSIDE : FFD_VERTEX_SINGULAR;
    location->unresolved = !found;
    location->residual = vec_length(residual);
    ffd_locator_report(locator, uvw, location->uvw);
}
