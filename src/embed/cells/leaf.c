/* leaf.c - the one root of a region, by its contraction (src/maths.md 6.4). */
#include "embed/cells/leaf.h"
#include "base/vector/vec.h"
#include "embed/frame/face.h"
#include <string.h>

/* Newton steps in one leaf: the certified radius at least halves with each, and 2^-64 is below any rounding.
 */
#define LEAF_STEPS 64

static double greatest(const double v[3])
{
    const double x = fabs(v[0]), y = fabs(v[1]), z = fabs(v[2]);
    return x > y ? (x > z ? x : z) : (y > z ? y : z);
}

static void offset_of(const cell_region *region, const double t[3], double offset[3])
{
    for (int a = 0; a < 3; a++)
        offset[a] = region->lo[a] + t[a] * region->width[a];
}

void ffd_search_evaluate_in(point_search *search, const cell_region *region, const double t[3], sample *at)
{
    double offset[3];
    offset_of(region, t, offset);
    ffd_search_evaluate(search, region->span, offset, at);
    for (int i = 0; i < 9; i++)
        at->jacobian[i] *= region->width[i % 3];
}

/* t + step, clipped to the box. */
static void step_from(const double t[3], const double step[3], double to[3])
{
    for (int a = 0; a < 3; a++)
        to[a] = clip_to_unit(t[a] + step[a]);
}

/* The full Newton step -J^{-1} F by Cramer's rule; false where J is singular. */
static bool newton_step(const sample *at, double step[3])
{
    double inverse[9];
    if (!mat_invert(at->jacobian, inverse))
        return false;
    mat_apply(inverse, at->equation, step);
    for (int a = 0; a < 3; a++)
        step[a] = -step[a];
    return true;
}

/* A root may lie a rounding outside the box. */
typedef struct face_search {
    point_search *search;
    const cell_region *region;
    sample at;
} face_search;

static bool evaluate_on_face(void *context, const double t[3], double jacobian[9], double equation[3])
{
    face_search *face = context;
    ffd_search_evaluate_in(face->search, face->region, t, &face->at);
    memcpy(jacobian, face->at.jacobian, sizeof face->at.jacobian);
    memcpy(equation, face->at.equation, sizeof face->at.equation);
    return ffd_search_accepts(face->search, &face->at, face->region->weight_ratio);
}

/* Whether the determinant is no more than the rounding of its own terms. */
static bool is_singular(const double jacobian[9], double *determinant)
{
    double column[3][3], cross[3];
    for (int a = 0; a < 3; a++)
        for (int r = 0; r < 3; r++)
            column[a][r] = jacobian[3 * r + a];
    vec_cross(column[1], column[2], cross);
    *determinant = vec_dot(column[0], cross);
    return !(fabs(*determinant) >
             16 * DBL_EPSILON * vec_length(column[0]) * vec_length(column[1]) * vec_length(column[2]));
}

void ffd_search_record(point_search *search, const cell_region *region, const double t[3], const sample *at,
                       bool singular)
{
    root found = {.residual = vec_length(at->residual)};
    double inverse[9], offset[3];
    found.singular = is_singular(at->jacobian, &found.determinant) || singular;
    offset_of(region, t, offset);
    for (int a = 0; a < 3; a++) {
        const knot_vector *knots = &search->locator->knots[a];
        found.uvw[a] = ffd_knots_wrap(knots, knots->t[region->span[a]] + offset[a]);
    }
    if (mat_invert(at->jacobian, inverse))
        for (int a = 0; a < 3; a++) {
            const double *row = inverse + 3 * a;
            found.spread[a] = 4 * region->width[a] * at->weight * region->weight_ratio *
                              (fabs(row[0]) * search->tolerance[0] + fabs(row[1]) * search->tolerance[1] +
                               fabs(row[2]) * search->tolerance[2]);
        }
    ffd_roots_add(search->locator, &search->roots, &found);
}

/* The first step, -Y F from the centre, whose value is known: false where the region has no root. */
static bool leave_centre(const point_search *search, const cell_region *region, double noise, double t[3],
                         double *e)
{
    static const double middle[3] = {0.5, 0.5, 0.5};
    double equation[3], step[3];
    for (int r = 0; r < 3; r++)
        equation[r] = search->x[r] * region->centre[3] - region->centre[r];
    mat_apply(region->inverse, equation, step);
    if (!(greatest(step) <= (1 + region->bound) * *e + noise))
        return false;
    step_from(middle, step, t);
    *e = region->bound * *e + noise;
    return true;
}

/* What a step led to. */
typedef struct stride {
    double t[3], radius; /* the new point, and a bound of its distance from the root */
    sample at;
} stride;

/* Newton's step, where it brings the certified radius below that of the contraction. */
static bool newton_stride(point_search *search, const cell_region *region, const double t[3],
                          const sample *at, double noise, double shorter, stride *ahead)
{
    double step[3], image[3];
    if (!newton_step(at, step))
        return false;
    step_from(t, step, ahead->t);
    ffd_search_evaluate_in(search, region, ahead->t, &ahead->at);
    mat_apply(region->inverse, ahead->at.equation, image);
    ahead->radius = (greatest(image) + noise) / (1 - region->bound);
    return ahead->radius <= shorter || ffd_search_accepts(search, &ahead->at, region->weight_ratio);
}

/* e bounds |t - root| throughout, if there is a root: Y F contracts distances from it by L, clipping does not
   lengthen them, and any t has |Y F(t)| between (1-L) and (1+L) times its distance. */
void ffd_search_region(point_search *search, const cell_region *region)
{
    const double noise = ffd_image_of_tolerance(region->inverse, search->tolerance, region->greatest_weight);
    const double bound = region->bound, least = fmax(1e-12, 4 * noise);
    double t[3], e = 0.5, image[3];
    sample at;
    if (!leave_centre(search, region, noise, t, &e))
        return;
    ffd_search_evaluate_in(search, region, t, &at);
    for (int i = 0; i < LEAF_STEPS; i++) {
        stride ahead;
        e = e > least ? e : least;
        if (ffd_search_accepts(search, &at, region->weight_ratio)) {
            ffd_search_record(search, region, t, &at, false);
            return;
        }
        mat_apply(region->inverse, at.equation, image);
        if (!(greatest(image) <= (1 + bound) * e + noise))
            return; /* also where a value is not finite */
        const double shorter = bound * e + noise;
        if (!newton_stride(search, region, t, &at, noise, shorter, &ahead)) {
            for (int a = 0; a < 3; a++)
                image[a] = -image[a];
            step_from(t, image, ahead.t);
            ffd_search_evaluate_in(search, region, ahead.t, &ahead.at);
            ahead.radius = shorter;
        }
        const bool unmoved = memcmp(t, ahead.t, sizeof t) == 0;
        memcpy(t, ahead.t, sizeof t);
        at = ahead.at;
        e = ahead.radius;
        if (unmoved)
            break;
    }
    face_search face = {.search = search, .region = region, .at = at};
    if (ffd_search_accepts(search, &at, region->weight_ratio) ||
        ffd_face_settle(search->tolerance, evaluate_on_face, &face, t))
        ffd_search_record(search, region, t, &face.at, false);
}
