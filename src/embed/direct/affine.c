/* affine.c - lattices with an affine rest map: u,v,w by a 3 x 3 matrix. */
#include "embed/direct/affine.h"
#include "base/vector/vec.h"
#include "embed/frame/face.h"
#include "embed/frame/slabs.h"
#include <float.h>
#include <math.h>
#include <string.h>

#define REFINEMENTS 8

static double domain_side(const ffd_lattice *lattice, int a)
{
    return ffd_knots_last(&lattice->knots[a]) - ffd_knots_first(&lattice->knots[a]);
}

/* Returns the Greville abscissa of point i as a fraction of the domain. */
static double greville_fraction(const ffd_lattice *lattice, int a, size_t i)
{
    const knot_vector *knots = &lattice->knots[a];
    return (ffd_knots_greville(knots, i) - ffd_knots_first(knots)) / domain_side(lattice, a);
}

static bool weights_are_equal(const ffd_lattice *lattice)
{
    for (size_t i = 1; lattice->rest_weights && i < lattice->count; i++)
        if (lattice->rest_weights[i] != lattice->rest_weights[0])
            return false;
    return true;
}

/* Computes the affine map that the first corner and the last points in each direction define; column a is the
   derivative by t_a. */
static void map_of_corners(const ffd_locator *locator, double frame[9], double start[3])
{
    const ffd_lattice *lattice = locator->lattice;
    const size_t step[3] = {1, lattice->size[0], lattice->size[0] * lattice->size[1]};
    double base[3], first[3];
    for (int r = 0; r < 3; r++)
        base[r] = start[r] = lattice->rest[r] - locator->origin[r];
    for (int a = 0; a < 3; a++) {
        const size_t last = lattice->size[a] - 1;
        const double *far = lattice->rest + 3 * last * step[a];
        first[a] = greville_fraction(lattice, a, 0);
        const double length = greville_fraction(lattice, a, last) - first[a];
        for (int r = 0; r < 3; r++)
            frame[3 * r + a] = (far[r] - locator->origin[r] - base[r]) / length;
    }
    for (int a = 0; a < 3; a++)
        for (int r = 0; r < 3; r++)
            start[r] -= frame[3 * r + a] * first[a];
}

/* Returns whether the map takes the Greville abscissae of every control point to its position, within 4 eps
   of the size relative to the origin. */
static bool map_fits(const ffd_locator *locator, const double frame[9], const double start[3])
{
    const ffd_lattice *lattice = locator->lattice;
    const double *point = lattice->rest;
    for (size_t k = 0; k < lattice->size[2]; k++)
        for (size_t j = 0; j < lattice->size[1]; j++)
            for (size_t i = 0; i < lattice->size[0]; i++, point += 3) {
                const double t[3] = {greville_fraction(lattice, 0, i), greville_fraction(lattice, 1, j),
                                     greville_fraction(lattice, 2, k)};
                double expected[3];
                mat_apply(frame, t, expected);
                for (int r = 0; r < 3; r++) {
                    const double off = point[r] - locator->origin[r] - (start[r] + expected[r]);
                    if (!(fabs(off) <= 4 * DBL_EPSILON * locator->extent[r]))
                        return false;
                }
            }
    return true;
}

/* Returns whether the determinant, with normalised columns, exceeds the rounding error of its terms. */
static bool has_volume(const double frame[9])
{
    double unit[9];
    for (int a = 0; a < 3; a++) {
        const double column[3] = {frame[a], frame[3 + a], frame[6 + a]}, length = vec_length(column);
        for (int r = 0; r < 3; r++)
            unit[3 * r + a] = column[r] / length;
    }
    return fabs(mat_determinant(unit)) > 16 * DBL_EPSILON;
}

/* Returns whether the determinant exceeds the effect of rounding the control points: each end of a column may
   be off by half an ulp in the file, and by as much again after the origin is subtracted. */
static bool exceeds_rounding(const ffd_locator *locator, const double frame[9])
{
    double column[3][3], off[3], across[3], sum = 0;
    for (int r = 0; r < 3; r++) {
        const double size = larger_of(fabs(locator->hull.lo[r]), fabs(locator->hull.hi[r]));
        off[r] = 2 * DBL_EPSILON * size / locator->extent[r];
        for (int a = 0; a < 3; a++)
            column[a][r] = frame[3 * r + a] / locator->extent[r];
    }
    const double reach = vec_length(off);
    for (int a = 0; a < 3; a++) {
        vec_cross(column[(a + 1) % 3], column[(a + 2) % 3], across);
        sum += reach * (vec_length(across) + reach * (vec_length(column[a]) + reach));
    }
    return fabs(vec_dot(column[2], across)) > sum;
}

bool ffd_affine_detect(ffd_locator *locator)
{
    const ffd_lattice *lattice = locator->lattice;
    affine_map *map = &locator->affine;
    double start[3] = {0, 0, 0};
    for (int a = 0; a < 3; a++)
        if (ffd_knots_closed(&lattice->knots[a]))
            return false;
    if (!weights_are_equal(lattice))
        return false;
    if (lattice->form == REST_BOX_AFFINE) {
        /* The box in the file is exact, but the rounding errors of control points are relative to their
           distance from the origin. */
        for (int r = 0; r < 3; r++)
            locator->origin[r] = lattice->origin[r];
        for (int i = 0; i < 9; i++)
            map->frame[i] = lattice->frame[i];
        for (int r = 0; r < 3; r++)
            locator->extent[r] =
                fabs(map->frame[3 * r]) + fabs(map->frame[3 * r + 1]) + fabs(map->frame[3 * r + 2]);
    } else {
        map_of_corners(locator, map->frame, start);
        if (!map_fits(locator, map->frame, start) || !exceeds_rounding(locator, map->frame))
            return false;
        for (int r = 0; r < 3; r++)
            locator->origin[r] += start[r];
    }
    return has_volume(map->frame) && mat_invert(map->frame, map->inverse);
}

/* equation = frame t - p */
static void affine_equation(const affine_map *map, const double p[3], const double t[3], double equation[3])
{
    mat_apply(map->frame, t, equation);
    for (int r = 0; r < 3; r++)
        equation[r] -= p[r];
}

/* The inverse of a strongly sheared frame loses digits; iterative refinement recovers them. */
static void refine(const affine_map *map, const double p[3], const double tolerance[3], double t[3])
{
    for (int step = 0; step < REFINEMENTS; step++) {
        double equation[3], correction[3];
        affine_equation(map, p, t, equation);
        if (ffd_within_tolerance(equation, tolerance))
            return;
        mat_apply(map->inverse, equation, correction);
        for (int a = 0; a < 3; a++)
            t[a] -= correction[a];
    }
}

typedef struct affine_point {
    const affine_map *map;
    const double *p, *tolerance;
    double share; /* of the tolerance */
    bool grains;  /* allow also the change of C by rounding t */
} affine_point;

static bool evaluate_on_face(void *context, const double t[3], double jacobian[9], double equation[3])
{
    const affine_point *point = context;
    double allowance[3];
    memcpy(jacobian, point->map->frame, sizeof point->map->frame);
    affine_equation(point->map, point->p, t, equation);
    for (int r = 0; r < 3; r++) {
        double jump = 0;
        for (int a = 0; a < 3; a++)
            jump += fabs(point->map->frame[3 * r + a]) * DBL_EPSILON * fabs(t[a]);
        allowance[r] = point->share * (point->tolerance[r] + (point->grains ? jump : 0));
    }
    return ffd_within_tolerance(equation, allowance);
}

/* Clamps t to the domain. Returns false if it is farther outside than the tolerance and the residual
   allow. */
static bool clip(const affine_map *map, const double p[3], const double tolerance[3], double t[3],
                 bool *clipped)
{
    double residual[3];
    affine_equation(map, p, t, residual);
    for (int a = 0; a < 3; a++) {
        const double inner = clip_to_unit(t[a]), *row = map->inverse + 3 * a;
        double reach = 0; /* including rounding */
        for (int r = 0; r < 3; r++)
            reach += fabs(row[r]) * larger_of(tolerance[r], fabs(residual[r]));
        if (fabs(t[a] - inner) > 4 * reach)
            return false;
        *clipped = *clipped || inner != t[a];
        t[a] = inner;
    }
    return true;
}

/* Moves t to a point of the domain that meets the tolerance, if there is one: the closest point, in least
   squares, may miss in one coordinate where another one is within the tolerance in all three. */
static bool find_within(affine_point *point, double t[3])
{
    const step_box box = steps_in_unit_box(t);
    double equation[3], jacobian[9], step[3], to[3];
    affine_equation(point->map, point->p, t, equation);
    if (!ffd_slabs_find(&box, equation, point->map->frame, point->tolerance, step))
        return false;
    step_from(t, step, to);
    point->share = BORDER_SHARE;
    if (!evaluate_on_face(point, to, jacobian, equation))
        return false;
    memcpy(t, to, sizeof to);
    return true;
}

/* Returns whether t is a root, or the closest point of a face is one, or another point of the domain; t is
   moved there. */
static bool settle(affine_point *point, bool clipped, const double aim[3], const double tolerance[3],
                   double t[3])
{
    double jacobian[9], residual[3];
    *point = (affine_point){point->map, point->p, aim, 1, false};
    if (evaluate_on_face(point, t, jacobian, residual) ||
        (clipped && ffd_face_settle(aim, false, evaluate_on_face, point, t)))
        return true;
    *point = (affine_point){point->map, point->p, tolerance, TOLERANCE_SHARE, true};
    return (clipped && ffd_face_settle(tolerance, true, evaluate_on_face, point, t)) ||
           evaluate_on_face(point, t, jacobian, residual) || find_within(point, t);
}

void ffd_affine_find(const ffd_locator *locator, const double p[3], ffd_location *location)
{
    const affine_map *map = &locator->affine;
    double t[3], residual[3], aim[3], tolerance[3];
    bool clipped = false;
    affine_point point = {.map = map, .p = p};
    ffd_locator_aim(locator, p, aim);
    ffd_locator_tolerance(locator, p, tolerance);
    mat_apply(map->inverse, p, t);
    refine(map, p, aim, t);
    if (!clip(map, p, tolerance, t, &clipped))
        return;
    /* The origin is a corner of the domain, so the aim may exceed the tolerance. */
    for (int r = 0; r < 3 && clipped; r++)
        aim[r] = lesser_of(aim[r], TOLERANCE_SHARE * tolerance[r]);
    const bool found = settle(&point, clipped, aim, tolerance, t);
    if (!found && clipped)
        return; /* outside: all of the domain misses */
    affine_equation(map, p, t, residual);
    location->status = found ? FFD_VERTEX_INSIDE : FFD_VERTEX_SINGULAR;
    location->unresolved = !found;
    location->residual = vec_length(residual);
    for (int a = 0; a < 3; a++) {
        const knot_vector *knots = &locator->lattice->knots[a];
        const double lo = ffd_knots_first(knots), hi = ffd_knots_last(knots), u = lo + t[a] * (hi - lo);
        location->uvw[a] = u > hi ? hi : u;
    }
}
