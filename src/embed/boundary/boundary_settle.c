/* boundary_settle.c - the last step of a search: makes the distance stationary to rounding, also across the
   edges between patches, and computes the derivative of the point by x. */
#include "base/vector/vec.h"
#include "embed/boundary/boundary_faces.h"
#include <float.h>
#include <math.h>
#include <string.h>

/* The most edges between patches that a point crosses: it moves only by rounding errors. */
#define CROSSINGS 6
/* Coordinates of u,v,w whose difference is at most this, relative to the domain, are equal. */
#define EQUAL_UVW 1e-9
/* A derivative of the distance counts as 0 up to this many eps of |S_f| |x - S|. */
#define SLOPE_ROUNDINGS 64
/* A matrix of second derivatives is singular if its determinant is at most this (relative). */
#define LEAST_DETERMINANT 1e-12

typedef struct settling {
    const boundary *border;
    const double *x;
    boundary_location location;
    face_patch *patch; /* of the cell that contains the point */
    patch_sample sample;
} settling;

void ffd_boundary_uvw(const boundary *border, const boundary_location *location, double uvw[3])
{
    const boundary_face *face = &border->faces[location->face];
    const knot_vector *across = &border->lattice->knots[face->direction];
    uvw[face->direction] = face->end ? ffd_knots_last(across) : ffd_knots_first(across);
    for (int f = 0; f < 2; f++) {
        const knot_vector *knots = boundary_knots(border, location->face, f);
        const double *knot = knots->t + knots->spans[location->cell[f]], t = location->t[f];
        const double u = t == 0 ? knot[0] : t == 1 ? knot[1] : knot[0] + t * (knot[1] - knot[0]);
        uvw[face->along[f]] = ffd_knots_wrap(knots, u > knot[1] ? knot[1] : u);
    }
}

bool ffd_boundary_before(const boundary *border, const double a[3], const double b[3])
{
    for (int d = 0; d < 3; d++) {
        const knot_vector *knots = &border->lattice->knots[d];
        const double side = ffd_knots_last(knots) - ffd_knots_first(knots);
        if (fabs(a[d] - b[d]) > EQUAL_UVW * side)
            return a[d] < b[d];
    }
    return false;
}

static void project(settling *at)
{
    ffd_boundary_patch(at->border, at->location.face, at->location.cell, at->patch);
    ffd_patch_project(at->patch, at->x, at->location.t, &at->sample);
}

/* Returns whether coordinate f is at an end of the patch beyond which the distance decreases. */
static bool leads_out(const settling *at, int f)
{
    double gradient[2], hessian[3];
    const double t = at->location.t[f];
    if (t != 0 && t != 1)
        return false;
    ffd_patch_gradient(&at->sample, gradient, hessian);
    const double noise = SLOPE_ROUNDINGS * DBL_EPSILON * vec_length(at->sample.first[f]) *
                         (vec_length(at->sample.residual) + 1);
    return t == 0 ? gradient[f] > noise : gradient[f] < -noise;
}

/* Returns whether the end of the patch at which coordinate f is, is an edge of the face. */
static bool is_edge(const boundary *border, const boundary_location *location, int f)
{
    const size_t cells = border->faces[location->face].cells[f];
    return !ffd_knots_closed(boundary_knots(border, location->face, f)) &&
           location->cell[f] == (location->t[f] == 0 ? 0 : cells - 1);
}

/* Expresses the point in the next patch beyond coordinate f: a patch of the same face or, at an edge, of the
   adjacent face. *moving is the coordinate that may then change. */
static void neighbour(const boundary *border, const boundary_location *from, int f, boundary_location *to,
                      int *moving)
{
    const boundary_face *face = &border->faces[from->face];
    const bool low = from->t[f] == 0;
    *to = *from;
    *moving = f;
    if (!is_edge(border, from, f)) {
        const size_t cells = face->cells[f];
        to->cell[f] = low ? (from->cell[f] + cells - 1) % cells : (from->cell[f] + 1) % cells;
        to->t[f] = low ? 1 : 0;
        return;
    }
    for (int i = 0; i < border->face_count; i++)
        if (border->faces[i].direction == face->along[f] && border->faces[i].end == !low)
            to->face = i;
    const boundary_face *other = &border->faces[to->face];
    for (int g = 0; g < 2; g++)
        if (other->along[g] == face->direction) {
            to->cell[g] = face->end ? other->cells[g] - 1 : 0;
            to->t[g] = face->end;
            *moving = g;
        } else {
            to->cell[g] = from->cell[1 - f];
            to->t[g] = from->t[1 - f];
        }
}

/* Moves to a neighbouring patch in which the distance decreases. Returns false if there is none. */
static bool cross(settling *at)
{
    for (int f = 0; f < 2; f++) {
        if (!leads_out(at, f))
            continue;
        settling next = *at;
        int moving;
        neighbour(at->border, &at->location, f, &next.location, &moving);
        const double start = next.location.t[moving];
        project(&next);
        if (next.location.t[moving] != start) {
            *at = next;
            return true;
        }
    }
    return false;
}

/* Lists the free coordinates of the point: those that are not fixed on an edge of the face or on a ridge of
   the surface, and not collapsed by the face. Returns their number. */
static int free_coordinates(const settling *at, int free[2])
{
    int count = 0;
    for (int f = 0; f < 2; f++) {
        const double t = at->location.t[f];
        const bool at_end = t == 0 || t == 1;
        if (at_end && (is_edge(at->border, &at->location, f) || leads_out(at, f)))
            continue;
        if (vec_length(at->sample.first[f]) > SLOPE_ROUNDINGS * DBL_EPSILON)
            free[count++] = f;
    }
    return count;
}

/* Computes the derivative by x: H dt = S_f . dx with H_fg = S_f . S_g + (S - x) . S_fg keeps the gradient
   0. */
static void follow(const settling *at, boundary_foot *foot)
{
    double gradient[2], h[3], rows[2][3];
    int free[2];
    const patch_sample *sample = &at->sample;
    const int count = free_coordinates(at, free);
    ffd_patch_gradient(sample, gradient, h);
    for (int i = 0; i < count; i++) {
        const double *slope = sample->first[free[i]];
        if (!(h[2 * free[i]] > LEAST_DETERMINANT * vec_dot(slope, slope)))
            return;
    }
    if (count == 2) {
        const double det = h[0] * h[2] - h[1] * h[1];
        if (!(det > LEAST_DETERMINANT * (h[0] * h[2])))
            return;
        for (int c = 0; c < 3; c++) {
            const double s = sample->first[0][c], t = sample->first[1][c];
            rows[0][c] = (h[2] * s - h[1] * t) / det;
            rows[1][c] = (h[0] * t - h[1] * s) / det;
        }
    } else if (count == 1) {
        for (int c = 0; c < 3; c++)
            rows[0][c] = sample->first[free[0]][c] / h[2 * free[0]];
    }
    for (int i = 0; i < count; i++) {
        const knot_vector *knots = boundary_knots(at->border, at->location.face, free[i]);
        const double *knot = knots->t + knots->spans[at->location.cell[free[i]]];
        foot->free[i] = at->border->faces[at->location.face].along[free[i]];
        for (int c = 0; c < 3; c++)
            foot->by_x[i][c] = rows[i][c] * (knot[1] - knot[0]);
    }
    foot->free_count = count;
}

void ffd_boundary_settle(const boundary *border, const double x[3], const boundary_location *location,
                         face_patch *scratch, boundary_foot *foot)
{
    settling at = {.border = border, .x = x, .location = *location, .patch = scratch};
    project(&at);
    for (int i = 0; i < CROSSINGS && cross(&at); i++)
        continue;
    memset(foot, 0, sizeof *foot);
    ffd_boundary_uvw(border, &at.location, foot->uvw);
    for (int c = 0; c < 3; c++)
        foot->residual[c] = -at.sample.residual[c];
    follow(&at, foot);
}
