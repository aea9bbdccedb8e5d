#include "embed/cells/collapse.h"
#include "base/memory/memory.h"
#include "embed/cells/cells.h"
#include "lattice/border.h"
#include "spline/basis.h"
#include "spline/bezier.h"
#include "spline/knots.h"
#include <math.h>
#include <string.h>

enum { N = BEZIER_COMPONENTS };

/* The limits of halving a curve: how often, and the number of parts in total. */
#define CURVE_HALVINGS 52
#define CURVE_BUDGET 4096

/* Finding */

/* Computes a control point of a face in the search's units. */
static void face_point(const ffd_locator *locator, const border_face *face, const size_t index[3],
                       double point[N])
{
    ffd_border_point(face, index, locator->origin, point);
    for (int a = 0; a < 3; a++)
        point[a] *= locator->cells->scale;
}

static bool is_one_point(const double a[N], const double b[N], const double tolerance[3])
{
    for (int c = 0; c < 3; c++)
        if (!(fabs(a[c] / a[3] - b[c] / b[3]) <= tolerance[c]))
            return false;
    return true;
}

/* Sets half the tolerance of a point of the set; the other half is for the search. */
static void set_tolerance(const cell_search *cells, double tolerance[3])
{
    for (int a = 0; a < 3; a++)
        tolerance[a] = 8 * DBL_EPSILON * cells->extent[a];
}

/* Returns whether the row of control points of a face through index in a direction is a single point. */
static bool line_collapses(const ffd_locator *locator, const border_face *face, int along, size_t index[3])
{
    double first[N], point[N], tolerance[3];
    set_tolerance(locator->cells, tolerance);
    index[along] = 0;
    face_point(locator, face, index, first);
    for (index[along] = 1; index[along] < locator->lattice->size[along]; index[along]++) {
        face_point(locator, face, index, point);
        if (!is_one_point(first, point, tolerance))
            return false;
    }
    return true;
}

/* Returns whether every row of a face in a direction is a single point. */
static bool face_collapses(const ffd_locator *locator, const border_face *face, int along)
{
    const int other = 3 - face->direction - along;
    size_t index[3] = {0, 0, 0};
    for (size_t i = 0; i < locator->lattice->size[other]; i++) {
        index[other] = i;
        if (!line_collapses(locator, face, along, index))
            return false;
    }
    return true;
}

static void note_point(collapse *set, const double point[N], size_t index)
{
    const double position[3] = {point[0] / point[3], point[1] / point[3], point[2] / point[3]};
    memcpy(set->points + N * index, point, N * sizeof *point);
    if (index == 0)
        for (int a = 0; a < 3; a++)
            set->box.lo[a] = set->box.hi[a] = position[a];
    bounds_add(&set->box, position);
}

static double end_of(const ffd_locator *locator, int direction, int end)
{
    return end ? ffd_knots_last(&locator->knots[direction]) : 0;
}

/* Adds a set: the points of the face along a direction (-1: its single point), with the other indices from
   index. */
static ffd_status add_set(const ffd_locator *locator, const border_face *face, int along, size_t index[3],
                          const double uvw[3], collapse_list *list, ffd_error *error)
{
    collapse *set = &list->sets[list->count];
    const size_t count = along < 0 ? 1 : locator->knots[along].functions;
    set->points = ffd_alloc(count, N * sizeof *set->points);
    if (!set->points)
        return ffd_fail_memory(error);
    list->count++;
    set->along = along;
    memcpy(set->uvw, uvw, sizeof set->uvw);
    for (size_t i = 0; i < count; i++) {
        double point[N];
        if (along >= 0)
            index[along] = ffd_knots_point(&locator->knots[along], i);
        face_point(locator, face, index, point);
        note_point(set, point, i);
    }
    return FFD_OK;
}

/* Adds an edge of the face at an end of `side`, if the face collapses the row along the third direction
   there. */
static ffd_status add_edge(const ffd_locator *locator, const border_face *face, const double face_uvw[3],
                           int side, collapse_list *list, ffd_error *error)
{
    const int along = 3 - face->direction - side;
    for (int end = 0; end < 2; end++) {
        /* Only with clamped knots the control points of the edge are those of the last row of the face.
           Otherwise the face has no control points on its edge, and edges are not collapsed in practice. */
        const knot_vector *knots = &locator->knots[side];
        size_t index[3] = {0, 0, 0};
        index[side] = end ? locator->lattice->size[side] - 1 : 0;
        const double u = end_of(locator, side, end);
        double value[MAX_ORDER], uvw[3] = {face_uvw[0], face_uvw[1], face_uvw[2]};
        ffd_basis_values(knots, ffd_knots_span(knots, u), u, value);
        if (value[end ? knots->degree : 0] != 1 || !line_collapses(locator, face, along, index))
            continue;
        index[along] = 0;
        uvw[side] = u;
        TRY(add_set(locator, face, -1, index, uvw, list, error));
    }
    return FFD_OK;
}

static ffd_status visit_face(const ffd_locator *locator, int direction, int end, collapse_list *list,
                             ffd_error *error)
{
    const int a = direction == 0 ? 1 : 0, b = direction == 2 ? 1 : 2;
    size_t index[3] = {0, 0, 0};
    double uvw[3] = {0, 0, 0};
    border_face face;
    ffd_border_face(locator->lattice, FFD_VOLUME_REST, direction, end, &face);
    uvw[direction] = end_of(locator, direction, end);
    const bool by_a = face_collapses(locator, &face, a), by_b = face_collapses(locator, &face, b);
    if (by_a || by_b)
        return add_set(locator, &face, by_a && by_b ? -1 : by_a ? b : a, index, uvw, list, error);
    /* An edge belongs to two faces; it is handled with the face of the lower direction. */
    for (int side = direction + 1; side < 3; side++)
        if (!ffd_knots_closed(&locator->knots[side]))
            TRY(add_edge(locator, &face, uvw, side, list, error));
    return FFD_OK;
}

ffd_status ffd_collapses_find(const ffd_locator *locator, collapse_list *list, ffd_error *error)
{
    for (int direction = 0; direction < 3; direction++)
        for (int end = 0; end < 2 && !ffd_knots_closed(&locator->knots[direction]); end++)
            TRY(visit_face(locator, direction, end, list, error));
    return FFD_OK;
}

void ffd_collapses_free(collapse_list *list)
{
    for (int i = 0; i < list->count; i++)
        ffd_free(list->sets[i].points);
    list->count = 0;
}

/* Answering */

typedef struct curve_search {
    const double *x, *tolerance;
    int order, budget;
    double at; /* the result: a fraction of the span */
} curve_search;

/* Returns whether the part [lo, lo + width] of the span passes x within the tolerance, and stores the least
   such u. */
static bool search_curve(curve_search *search, double curve[MAX_ORDER][N], double lo, double width, int level)
{
    bounds box = {{HUGE_VAL, HUGE_VAL, HUGE_VAL}, {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}};
    bool short_enough = true;
    for (int i = 0; i < search->order; i++) {
        const double *c = curve[i], point[3] = {c[0] / c[3], c[1] / c[3], c[2] / c[3]};
        bounds_add(&box, point);
    }
    if (search->budget-- <= 0 || !bounds_hold(&box, search->x, search->tolerance))
        return false;
    for (int a = 0; a < 3; a++)
        short_enough = short_enough && box.lo[a] >= search->x[a] - search->tolerance[a] &&
                       box.hi[a] <= search->x[a] + search->tolerance[a];
    if (short_enough || level == CURVE_HALVINGS) {
        search->at = lo;
        return short_enough;
    }
    double lower[MAX_ORDER][N];
    ffd_bezier_halve_lines((size_t)search->order, N, (double *)lower, (double *)curve);
    return search_curve(search, lower, lo, 0.5 * width, level + 1) ||
           search_curve(search, curve, lo + 0.5 * width, 0.5 * width, level + 1);
}

static bool span_holds(const ffd_locator *locator, const collapse *set, int span, const double x[3],
                       const double tolerance[3], double *u)
{
    const knot_vector *knots = &locator->knots[set->along];
    const int order = knots->degree + 1;
    const double *points = set->points + N * (span - knots->degree);
    double matrix[MAX_ORDER * MAX_ORDER], curve[MAX_ORDER][N];
    ffd_bezier_extraction(knots, span, matrix);
    for (int r = 0; r < order; r++)
        for (int c = 0; c < N; c++) {
            curve[r][c] = 0;
            for (int i = 0; i < order; i++)
                curve[r][c] += matrix[r * order + i] * points[N * i + c];
        }
    curve_search search = {.x = x, .tolerance = tolerance, .order = order, .budget = CURVE_BUDGET};
    if (!search_curve(&search, curve, 0, 1, 0))
        return false;
    *u = knots->t[span] + search.at * (knots->t[span + 1] - knots->t[span]);
    return true;
}

bool ffd_collapse_holds(const ffd_locator *locator, const collapse *set, const double x[3],
                        const double tolerance[3], double uvw[3])
{
    if (!bounds_hold(&set->box, x, tolerance))
        return false;
    memcpy(uvw, set->uvw, sizeof set->uvw);
    if (set->along < 0)
        return true;
    const knot_vector *knots = &locator->knots[set->along];
    for (size_t s = 0; s < knots->span_count; s++)
        if (span_holds(locator, set, knots->spans[s], x, tolerance, &uvw[set->along]))
            return true;
    return false;
}
