#include "lattice/ring.h"
#include "base/vector/trig.h"
#include "base/vector/vec.h"
#include "lattice/shapes.h"
#include "spline/basis.h"
#include "spline/bezier.h"
#include "spline/knots.h"
#include <math.h>

static bool is_rational(const knot_vector *knots, const ring_point *points)
{
    for (size_t j = 1; j < knots->points; j++)
        if (points[j].weight != points[0].weight)
            return true;
    return false;
}

/* Returns whether angles and knots have equal steps: each span of the curve is then the one before,
   rotated. */
static bool is_regular(const knot_vector *knots)
{
    return knots->kind == KNOTS_OPEN || knots->kind == KNOTS_UNIFORM || knots->kind == KNOTS_CLOSED;
}

/* Returns the position of control point j between the start (0) and the end (1) of the turn: its Greville
   abscissa. For preset knots it is a single division, so that 90 degrees stay exact. */
static double fraction_of(const knot_vector *knots, size_t j)
{
    if (!is_regular(knots))
        return ffd_shape_fraction(knots, j, FFD_SPACING_GREVILLE);
    const double steps =
        knots->kind == KNOTS_CLOSED ? (double)knots->points : (double)knots->points - knots->degree;
    return (2 * (double)j - (knots->degree - 1)) / (2 * steps);
}

static void set_angles(const knot_vector *knots, double first, double last, ring_point *points)
{
    for (size_t j = 0; j < knots->points; j++)
        ffd_sincos_degrees(ffd_shape_between(first, last, fraction_of(knots, j)), &points[j].y, &points[j].x);
}

/* Computes the direction of C at a parameter; dividing by the weight would not change it. Returns false if C
   is 0. */
static bool direction_at(const knot_vector *knots, const ring_point *points, double v, double direction[2])
{
    double value[MAX_ORDER], sum[2] = {0, 0};
    const int span = ffd_knots_span(knots, v);
    ffd_basis_values(knots, span, v, value);
    for (int r = 0; r <= knots->degree; r++) {
        const ring_point *const p = &points[ffd_knots_point(knots, (size_t)(span - knots->degree + r))];
        sum[0] += value[r] * p->weight * p->x;
        sum[1] += value[r] * p->weight * p->y;
    }
    const double length = sqrt(sum[0] * sum[0] + sum[1] * sum[1]);
    direction[0] = sum[0] / length;
    direction[1] = sum[1] / length;
    return length > 0;
}

/* Rotates all control points so that the curve starts at the angle `first`. */
static bool turn_start_to(const knot_vector *knots, double first, ring_point *points)
{
    double is[2], sine, cosine;
    if (!direction_at(knots, points, ffd_knots_first(knots), is))
        return false;
    ffd_sincos_degrees(first, &sine, &cosine);
    const double c = cosine * is[0] + sine * is[1], s = sine * is[0] - cosine * is[1];
    for (size_t j = 0; j < knots->points; j++) {
        const double x = points[j].x, y = points[j].y;
        points[j].x = c * x - s * y;
        points[j].y = s * x + c * y;
    }
    return true;
}

/* Returns the sine of the angle by which the end of the curve is beyond `turn` degrees from its start, if the
   angles of the control points are stretched by a factor. */
static double end_error(const knot_vector *knots, double turn, double stretch, ring_point *points)
{
    double start[2] = {1, 0}, end[2] = {1, 0}, sine, cosine;
    set_angles(knots, 0, turn * stretch, points);
    direction_at(knots, points, ffd_knots_first(knots), start);
    direction_at(knots, points, ffd_knots_last(knots), end);
    ffd_sincos_degrees(turn, &sine, &cosine);
    const double x = cosine * start[0] - sine * start[1], y = sine * start[0] + cosine * start[1];
    return x * end[1] - y * end[0];
}

/* Repeated end knots or symmetry usually put the ends of the curve at the right angles. Otherwise (lists of
   knots, weights on unclamped knots) the angles of the control points are multiplied by a factor, found by
   bisection. Within the bracket the error of the end stays below half a turn, so its sine has the same
   sign. */
static bool stretch_to(const knot_vector *knots, double first, double last, ring_point *points)
{
    double low = 0.75, high = 4.0 / 3;
    const double turn = last - first;
    if (!(end_error(knots, turn, low, points) <= 0) || !(end_error(knots, turn, high, points) >= 0))
        return false;
    for (;;) {
        const double middle = 0.5 * (low + high);
        if (!(low < middle && middle < high))
            break;
        if (end_error(knots, turn, middle, points) <= 0)
            low = middle;
        else
            high = middle;
    }
    set_angles(knots, 0, turn * low, points);
    return turn_start_to(knots, first, points);
}

/* Current bounds of the squared distance: the values attained at some point, and the proven bounds. */
typedef struct radius_bounds {
    double least_met, greatest_met, least, greatest;
} radius_bounds;

/* A Bezier arc in homogeneous coordinates (w x, w y, w). */
typedef struct bezier_arc {
    int degree;
    double point[MAX_ORDER][3];
} bezier_arc;

#define MAX_SQUARE_ORDER (2 * MAX_DEGREE + 1)
#define RADIUS_TOLERANCE 1e-10
#define RADIUS_DEPTH 24 /* each level divides the gap by 4; the tolerance needs about 17 */

/* Computes the Bernstein coefficients of x^2 + y^2 divided by those of w^2. In a product of Bernstein forms
   coefficient k is sum_{i+j=k} C(d,i) C(d,j) / C(2d,k) b_i b_j (Farouki & Rajan 1988). Because the
   coefficients of w^2 are positive, |C|^2 lies between the least and the greatest quotient; the first and the
   last quotient are attained at the ends of the arc. */
static void square_quotients(const bezier_arc *arc, double quotient[MAX_SQUARE_ORDER])
{
    double binomial[MAX_ORDER] = {1};
    const int d = arc->degree;
    for (int i = 1; i <= d; i++)
        binomial[i] = binomial[i - 1] * (d - i + 1) / i;
    for (int k = 0; k <= 2 * d; k++) {
        double square = 0, weight = 0;
        for (int i = k > d ? k - d : 0; i <= d && i <= k; i++) {
            const double *const a = arc->point[i], *const b = arc->point[k - i];
            const double factor = binomial[i] * binomial[k - i];
            square += factor * (a[0] * b[0] + a[1] * b[1]);
            weight += factor * (a[2] * b[2]);
        }
        quotient[k] = square / weight;
    }
}

/* Splits an arc in the middle with de Casteljau's algorithm. */
static void halve(const bezier_arc *arc, bezier_arc *left, bezier_arc *right)
{
    *right = *arc;
    left->degree = arc->degree;
    for (int i = 0; i <= arc->degree; i++) {
        for (int c = 0; c < 3; c++)
            left->point[i][c] = right->point[0][c];
        for (int r = 0; r < arc->degree - i; r++)
            for (int c = 0; c < 3; c++)
                right->point[r][c] = 0.5 * right->point[r][c] + 0.5 * right->point[r + 1][c];
    }
}

static void bound_arc(const bezier_arc *arc, int depth, radius_bounds *bounds)
{
    double quotient[MAX_SQUARE_ORDER] = {0};
    const int last = 2 * arc->degree;
    square_quotients(arc, quotient);
    double least = quotient[0], greatest = quotient[0];
    for (int k = 1; k <= last; k++) {
        least = minimum_number(least, quotient[k]);
        greatest = maximum_number(greatest, quotient[k]);
    }
    bounds->least_met = minimum_number(bounds->least_met, minimum_number(quotient[0], quotient[last]));
    bounds->greatest_met = maximum_number(bounds->greatest_met, maximum_number(quotient[0], quotient[last]));
    if (depth < RADIUS_DEPTH && (least < bounds->least_met * (1 - RADIUS_TOLERANCE) ||
                                 greatest > bounds->greatest_met * (1 + RADIUS_TOLERANCE))) {
        bezier_arc left, right;
        halve(arc, &left, &right);
        bound_arc(&left, depth + 1, bounds);
        bound_arc(&right, depth + 1, bounds);
        return;
    }
    bounds->least = minimum_number(bounds->least, least);
    bounds->greatest = maximum_number(bounds->greatest, greatest);
}

static void arc_of_span(const knot_vector *knots, const ring_point *points, int span, bezier_arc *arc)
{
    double matrix[MAX_ORDER * MAX_ORDER];
    const int order = knots->degree + 1;
    ffd_bezier_extraction(knots, span, matrix);
    arc->degree = knots->degree;
    for (int r = 0; r < order; r++) {
        double *const b = arc->point[r];
        b[0] = b[1] = b[2] = 0;
        for (int j = 0; j < order; j++) {
            const ring_point *const p = &points[ffd_knots_point(knots, (size_t)(span - knots->degree + j))];
            const double factor = matrix[r * order + j] * p->weight;
            b[0] += factor * p->x;
            b[1] += factor * p->y;
            b[2] += factor;
        }
    }
}

#define TURN_DEPTH 60

/* Computes the angle in degrees by which an arc turns round the origin. If its control points are on one side
   of a line through the origin, so is the arc, and its ends give the angle; otherwise it is halved. Returns
   false if the arc comes too near to the origin. */
static bool turn_of_arc(const bezier_arc *arc, int depth, double *turn)
{
    const double *const first = arc->point[0], *const last = arc->point[arc->degree];
    const double length[2] = {vec_length((const double[3]){first[0], first[1], 0}),
                              vec_length((const double[3]){last[0], last[1], 0})};
    const double middle[2] = {first[0] / length[0] + last[0] / length[1],
                              first[1] / length[0] + last[1] / length[1]};
    bool one_side = true;
    for (int i = 0; i <= arc->degree; i++)
        one_side = one_side && arc->point[i][0] * middle[0] + arc->point[i][1] * middle[1] > 0;
    if (one_side) {
        const double sine = first[0] * last[1] - first[1] * last[0],
                     cosine = first[0] * last[0] + first[1] * last[1];
        *turn += ffd_angle_degrees(sine, cosine);
        return true;
    }
    bezier_arc left, right;
    if (depth == TURN_DEPTH)
        return false;
    halve(arc, &left, &right);
    return turn_of_arc(&left, depth + 1, turn) && turn_of_arc(&right, depth + 1, turn);
}

/* Returns whether the curve turns by the requested angle, and not by another one with the same end, such as
   the shorter way round; then it passes every angle between. A wrong angle differs by whole turns, so the
   rounding of the angles does not matter. */
static bool turns_by(const knot_vector *knots, const ring_point *points, double degrees)
{
    double turn = 0;
    for (size_t i = 0; i < knots->span_count; i++) {
        bezier_arc arc;
        arc_of_span(knots, points, knots->spans[i], &arc);
        if (!turn_of_arc(&arc, 0, &turn))
            return false;
    }
    return fabs(turn - degrees) < 1;
}

ffd_status ffd_ring_rotate(const knot_vector *knots, double first, double last, bool full_turn,
                           ring_point *points, ffd_error *error)
{
    const bool closed = ffd_knots_closed(knots), clamped = ffd_shape_is_clamped(knots);
    bool placed = true;
    set_angles(knots, first, closed ? first + 360 : last, points);
    if (clamped && full_turn)
        points[knots->points - 1] = (ring_point){points[0].x, points[0].y, points[knots->points - 1].weight};
    if (!clamped && (!is_regular(knots) || is_rational(knots, points)))
        placed = closed ? turn_start_to(knots, first, points) : stretch_to(knots, first, last, points);
    if (placed && turns_by(knots, points, closed || full_turn ? 360 : last - first))
        return FFD_OK;
    return ffd_fail(error, FFD_E_INVALID,
                    "%zu control points of degree %d along v are too few for this angle of the cylinder",
                    knots->points, knots->degree);
}

/* Returns whether span i is a rotated copy of another span that is examined: all but the first one of a
   regular curve, and those of a long clamped curve that end knots do not affect. Rational curves have no
   copies. */
static bool is_copy(const knot_vector *knots, size_t i)
{
    const size_t reach = 2 * (size_t)knots->degree;
    if (is_regular(knots))
        return i > 0;
    return knots->kind == KNOTS_CLAMPED && i > reach && i + reach < knots->span_count;
}

void ffd_ring_radius(const knot_vector *knots, const ring_point *points, double *least, double *greatest)
{
    const bool rational = is_rational(knots, points);
    radius_bounds bounds = {INFINITY, 0, INFINITY, 0};
    for (size_t i = 0; i < knots->span_count; i++) {
        if (!rational && is_copy(knots, i))
            continue;
        bezier_arc arc;
        arc_of_span(knots, points, knots->spans[i], &arc);
        bound_arc(&arc, 0, &bounds);
    }
    *least = bounds.least > 0 ? sqrt(bounds.least) : 0;
    *greatest = sqrt(bounds.greatest);
}
