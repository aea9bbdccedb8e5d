/* boundary_box.c - the nearest border point of a box with an affine map: clamps the coordinates. */
#include "base/vector/vec.h"
#include "embed/boundary/boundary_faces.h"
#include "embed/frame/face.h"
#include <float.h>
#include <string.h>

/* Faces count as equally near to a point inside if their distances differ by at most this. */
#define EQUAL (16 * DBL_EPSILON)

static double coordinate(const boundary *border, int a, double t)
{
    const knot_vector *knots = &border->lattice->knots[a];
    const double first = ffd_knots_first(knots), last = ffd_knots_last(knots);
    return t == 0 ? first : t == 1 ? last : ffd_knots_wrap(knots, first + t * (last - first));
}

/* Moves a point inside to the nearest face. Of equally near faces it chooses the one with the least u,v,w:
   upper faces come last, and those of later directions before those of earlier ones. */
static void go_to_face(const double t[3], const double side[3], double to[3])
{
    double least = HUGE_VAL;
    for (int a = 0; a < 3; a++)
        least = minimum_number(least, minimum_number(t[a], 1 - t[a]) * side[a]);
    for (int a = 0; a < 3; a++)
        if (t[a] * side[a] <= least + EQUAL * side[a]) {
            to[a] = 0;
            return;
        }
    for (int a = 2; a >= 0; a--)
        if ((1 - t[a]) * side[a] <= least + EQUAL * side[a]) {
            to[a] = 1;
            return;
        }
}

void ffd_boundary_box_find(const boundary *border, const boundary_query *query, boundary_foot *foot)
{
    double column[3][3], t[3], to[3], side[3];
    bool inside = true;
    for (int a = 0; a < 3; a++) {
        for (int r = 0; r < 3; r++)
            column[a][r] = border->frame[3 * r + a];
        const double square = vec_dot(column[a], column[a]);
        side[a] = sqrt(square);
        t[a] = square > 0 ? vec_dot(query->x, column[a]) / square : 0;
        to[a] = clip_to_unit(t[a]);
        inside = inside && to[a] > 0 && to[a] < 1;
    }
    if (inside)
        go_to_face(t, side, to);
    memset(foot, 0, sizeof *foot);
    for (int a = 0; a < 3; a++) {
        foot->uvw[a] = coordinate(border, a, to[a]);
        for (int r = 0; r < 3; r++)
            foot->residual[r] += (t[a] - to[a]) * column[a][r];
        if (to[a] == 0 || to[a] == 1)
            continue;
        /* At least one coordinate is fixed on a face, so at most two are free. */
        const knot_vector *knots = &border->lattice->knots[a];
        const double width = ffd_knots_last(knots) - ffd_knots_first(knots);
        for (int r = 0; r < 3; r++)
            foot->by_x[foot->free_count][r] = column[a][r] / side[a] / side[a] * width;
        foot->free[foot->free_count++] = a;
    }
}
