#include "embed/cells/leaf_exit.h"
#include "base/vector/vec.h"
#include "embed/cells/region_root.h"
#include "embed/cells/tolerance_image.h"
#include "embed/frame/face.h"
#include <float.h>
#include <string.h>

/* The most damped steps. */
#define CALM_STEPS 32

/* The search for a root on a face: a root may be outside the box by a rounding error. */
typedef struct face_search {
    point_search *search;
    const cell_region *region;
    bool admits; /* accept what ffd_search_admits accepts */
    sample at;
} face_search;

static bool evaluate_on_face(void *context, const double t[3], double jacobian[9], double equation[3])
{
    face_search *face = context;
    ffd_search_evaluate_in(face->search, face->region, t, &face->at);
    memcpy(jacobian, face->at.jacobian, sizeof face->at.jacobian);
    memcpy(equation, face->at.equation, sizeof face->at.equation);
    return face->admits ? ffd_search_admits(face->search, face->region, t, &face->at)
                        : ffd_search_accepts(face->search, face->region, t, &face->at);
}

/* Returns whether a face of the region is on the border of the domain. */
static bool is_domain_face(const ffd_locator *locator, const cell_region *region, int a, int end)
{
    const knot_vector *knots = &locator->knots[a];
    const int span = region->span[a];
    if (ffd_knots_closed(knots))
        return false;
    return end ? span == knots->spans[knots->span_count - 1] &&
                     region->lo[a] + region->width[a] >= knots->t[span + 1] - knots->t[span]
               : span == knots->spans[0] && region->lo[a] == 0;
}

/* Returns whether the contraction proves that the box has no root: G(t) = t - Y F is within L e plus the
   tolerance of a root in each direction, but all such roots would be outside. Sets e, a bound of the distance
   of t from a root. */
static bool leaves_by_contraction(const point_search *search, const cell_region *region, const double t[3],
                                  const sample *at, double *e)
{
    double image[3], noise[3], most = 0;
    mat_apply(region->inverse, at->equation, image);
    for (int a = 0; a < 3; a++) {
        const double *row = region->inverse + 3 * a;
        noise[a] = region->greatest_weight *
                       (fabs(row[0]) * search->tolerance[0] + fabs(row[1]) * search->tolerance[1] +
                        fabs(row[2]) * search->tolerance[2]) +
                   region->grain;
        most = noise[a] > most ? noise[a] : most;
    }
    *e = lesser_of(1, (vec_greatest(image) + most) / (1 - region->bound));
    for (int a = 0; a < 3; a++) {
        const double to = t[a] - image[a], out = to < 0 ? -to : to - 1;
        if (out > region->bound * *e + noise[a])
            return true;
    }
    return false;
}

/* Subtracts from v its components along orthonormal vectors. */
static void take_away(const double unit[3][3], int count, double v[3])
{
    for (int round = 0; round < 2; round++) /* the second time removes what rounding left */
        for (int i = 0; i < count; i++) {
            const double along = vec_dot(unit[i], v);
            for (int r = 0; r < 3; r++)
                v[r] -= along * unit[i][r];
        }
}

/* Projects the residual, and the columns of the fixed coordinates, onto the orthogonal complement of the
   columns of the free coordinates. Returns false if the latter are not linearly independent. */
static bool project_residual(const double jacobian[9], const double residual[3], const double t[3],
                             double across[3][3], double left[3])
{
    double unit[3][3];
    int count = 0;
    for (int a = 0; a < 3; a++)
        for (int r = 0; r < 3; r++)
            across[a][r] = jacobian[3 * r + a];
    for (int a = 0; a < 3; a++) {
        if (t[a] == 0 || t[a] == 1)
            continue;
        const double length = vec_length(across[a]);
        take_away((const double(*)[3])unit, count, across[a]);
        const double rest = vec_length(across[a]);
        if (!(rest > 1e-10 * length))
            return false;
        for (int r = 0; r < 3; r++)
            unit[count][r] = across[a][r] / rest;
        count++;
    }
    memcpy(left, residual, 3 * sizeof *left);
    take_away((const double(*)[3])unit, count, left);
    for (int a = 0; a < 3; a++)
        if (t[a] == 0 || t[a] == 1)
            take_away((const double(*)[3])unit, count, across[a]);
    return true;
}

/* Returns whether t, on faces of the region, is next to the point of the region closest to x, in units of the
   allowance, and that point misses x: most of the residual is orthogonal to the free coordinates and exceeds
   the allowance, and the fixed coordinates could improve it only outwards. */
static bool is_closest(const double t[3], const sample *at, const double allowance[3])
{
    double jacobian[9], equation[3], across[3][3], left[3];
    bool outward = false;
    if (!ffd_weigh_rows(at->jacobian, at->equation, allowance, jacobian, equation) ||
        !project_residual(jacobian, equation, t, across, left) ||
        !(vec_length(left) > 0.5 * vec_length(equation)) ||
        !(vec_greatest(left) >
          at->weight * minimum_number(allowance[0], minimum_number(allowance[1], allowance[2]))))
        return false;
    for (int a = 0; a < 3; a++) {
        if (t[a] != 0 && t[a] != 1)
            continue;
        const double slope = (t[a] == 0 ? 1 : -1) * vec_dot(across[a], left);
        const double size = vec_length(across[a]) * vec_length(left);
        if (slope < -0.01 * size)
            return false;
        outward = outward || slope > 0.1 * size;
    }
    return outward;
}

/* J counts as constant near t if its relative change is at most this. */
#define MOST_CHANGE 0.25

/* Returns an upper bound of the change of I - Y J, which L bounds over the region, within e of a point:
   Markov's inequality for polynomials of the lattice's degrees. *usual: an estimate that holds except for
   polynomials constructed against it. */
static double change_of_jacobian(const point_search *search, const cell_region *region, double e,
                                 double *usual)
{
    double slope = 0;
    for (int a = 0; a < 3; a++) {
        const int degree = search->locator->cells->order[a] - 1;
        slope += 2.0 * degree * degree;
    }
    *usual = 8 * region->bound * e;
    return slope * region->bound * e;
}

/* The image of the tolerance is a sliver if it is at least this many times as long as it is wide. */
#define SLIVER 1024

/* Returns whether the image of the allowance is a sliver. The columns of the inverse times the allowance are
   its edges. */
static bool is_sliver(const double inverse[9], const double allowance[3])
{
    double least = HUGE_VAL, most = 0;
    for (int r = 0; r < 3; r++) {
        const double edge[3] = {inverse[r], inverse[3 + r], inverse[6 + r]};
        const double length = vec_length(edge) * allowance[r];
        least = lesser_of(least, length);
        most = larger_of(most, length);
    }
    return most > SLIVER * least;
}

/* Returns whether Newton's step, which ends within e of any root, leads out of the region by more than the
   curvature and the tolerance explain: then there is no root. If not surely, an estimate of the curvature is
   enough at the border of the domain, without the tolerance: what is within it there was looked for. Across a
   sliver that is doubtful: t may stop so far from an edge or a corner of the domain that the points there
   were never examined. */
static bool leads_out_by_step(point_search *search, const cell_region *region, const double t[3],
                              const sample *at, double e, bool surely)
{
    double allowance[3], inverse[9], step[3], reach[3], usual, most = 0;
    const double change = change_of_jacobian(search, region, e, &usual);
    const double bent = surely ? change : usual;
    if (usual > MOST_CHANGE || !(bent < MOST_CHANGE) || !mat_invert(at->jacobian, inverse))
        return false;
    ffd_search_allowance(search, region, t, at, allowance);
    mat_apply(inverse, at->equation, step);
    for (int a = 0; a < 3; a++) {
        const double *row = inverse + 3 * a;
        reach[a] = at->weight *
                   (fabs(row[0]) * allowance[0] + fabs(row[1]) * allowance[1] + fabs(row[2]) * allowance[2]);
        most = larger_of(most, fabs(step[a]) + reach[a]);
    }
    const double bend = bent * most / (1 - bent);
    for (int a = 0; a < 3; a++) {
        const double to = t[a] - step[a], out = to < 0 ? -to : to - 1;
        const bool is_far = out > bend + reach[a];
        if (surely ? !is_far : !(out > bend) || !is_domain_face(search->locator, region, a, to > 0))
            continue;
        if (!is_far && is_sliver(inverse, allowance))
            search->doubtful = true;
        return true;
    }
    return false;
}

/* Returns whether it is proven that the region has no root. Sets e, a bound of the distance of t from a
   root. */
static bool is_empty(point_search *search, const cell_region *region, const double t[3], const sample *at,
                     double *e)
{
    return leaves_by_contraction(search, region, t, at, e) ||
           leads_out_by_step(search, region, t, at, *e, true);
}

/* Returns whether estimates say so: of Newton's step, or because t, on a face, is the closest point of the
   region, and misses. */
static bool seems_empty(point_search *search, const cell_region *region, const double t[3], const sample *at,
                        double e)
{
    double allowance[3];
    if (search->strict)
        return false;
    ffd_search_allowance(search, region, t, at, allowance);
    return leads_out_by_step(search, region, t, at, e, false) ||
           (8 * region->bound * e <= MOST_CHANGE && is_closest(t, at, allowance));
}

/* Finds a root next to t: the closest point of the border, in least squares, may miss in one coordinate where
   another point is within the tolerance in all three. */
static bool find_sidecar(point_search *search, const cell_region *region, const double t[3])
{
    double neighbour[3] = {t[0], t[1], t[2]};
    sample at;
    if (!ffd_tolerance_find(search, region, neighbour, &at))
        return false;
    ffd_search_record(search, region, neighbour, &at, false);
    return true;
}

static bool is_within_box(const double t[3])
{
    return t[0] > 0 && t[0] < 1 && t[1] > 0 && t[1] < 1 && t[2] > 0 && t[2] < 1;
}

/* Returns whether t is a root, or the closest point of a face next to it is one; t is moved there. */
static bool settle(face_search *face, double t[3])
{
    const sample at = face->at;
    if (ffd_search_accepts(face->search, face->region, t, &at) ||
        ffd_face_settle(face->search->aim, false, evaluate_on_face, face, t))
        return true;
    const bool admitted = ffd_search_admits(face->search, face->region, t, &at);
    face->admits = true;
    if (admitted && is_within_box(t)) {
        face->at = at;
        return true;
    }
    if (ffd_face_settle(face->search->tolerance, true, evaluate_on_face, face, t))
        return true;
    face->at = at;
    return admitted;
}

/* Returns |F| in units of the allowance of each row. */
static double miss_of(const sample *at, const double allowance[3])
{
    double weighed[3];
    for (int r = 0; r < 3; r++)
        weighed[r] = at->residual[r] / allowance[r];
    return vec_length(weighed);
}

/* Makes a damped least-squares step (Levenberg), clamped to the box. Returns false if there is none. */
static bool damped_step(const sample *at, const double allowance[3], double damping, const double t[3],
                        double to[3])
{
    double jacobian[9], equation[3], normal[9], gradient[3], inverse[9], step[3], trace = 0;
    if (!ffd_weigh_rows(at->jacobian, at->equation, allowance, jacobian, equation))
        return false;
    for (int a = 0; a < 3; a++) {
        double slope = 0;
        for (int r = 0; r < 3; r++)
            slope += jacobian[3 * r + a] * equation[r];
        const bool rests = (t[a] == 0 && slope > 0) || (t[a] == 1 && slope < 0);
        for (int r = 0; r < 3 && rests; r++)
            jacobian[3 * r + a] = 0;
        gradient[a] = rests ? 0 : -slope;
    }
    for (int b = 0; b < 3; b++)
        for (int a = 0; a < 3; a++)
            normal[3 * b + a] = jacobian[b] * jacobian[a] + jacobian[3 + b] * jacobian[3 + a] +
                                jacobian[6 + b] * jacobian[6 + a];
    trace = normal[0] + normal[4] + normal[8];
    for (int a = 0; a < 3; a++)
        normal[4 * a] += damping * trace;
    if (!mat_invert(normal, inverse))
        return false;
    mat_apply(inverse, gradient, step);
    step_from(t, step, to);
    return true;
}

/* Where J is nearly singular, Newton steps are mostly rounding in the null direction, and curvature makes
   each step miss again. Damped steps avoid that direction as long as possible. Returns whether t is a root
   afterwards. */
static bool damp_step(point_search *search, const cell_region *region, double t[3], sample *at)
{
    double damping = 1e-6;
    for (int step = 0; step < CALM_STEPS; step++) {
        double allowance[3], to[3];
        sample ahead;
        ffd_search_allowance(search, region, t, at, allowance);
        if (ffd_search_admits(search, region, t, at))
            return true;
        if (!damped_step(at, allowance, damping, t, to) || memcmp(t, to, sizeof to) == 0)
            return false;
        ffd_search_evaluate_in(search, region, to, &ahead);
        const bool falls = miss_of(&ahead, allowance) < miss_of(at, allowance);
        damping *= falls ? 0.1 : 10;
        if (!falls)
            continue;
        memcpy(t, to, sizeof to);
        *at = ahead;
    }
    return ffd_search_admits(search, region, t, at);
}

bool ffd_search_end(point_search *search, const cell_region *region, double t[3], sample *at, root *stall)
{
    face_search face = {.search = search, .region = region, .at = *at};
    double e;
    if (settle(&face, t))
        ffd_search_record(search, region, t, &face.at, false);
    else if (damp_step(search, region, t, at))
        ffd_search_record(search, region, t, at, false);
    else if (!is_empty(search, region, t, at, &e) && !find_sidecar(search, region, t) &&
             !seems_empty(search, region, t, at, e)) {
        ffd_search_stall(search, region, t, at, stall);
        return false;
    }
    return true;
}
