#include "fold/affine/rest_box.h"
#include "base/vector/vec.h"

/* What the rounding of control points may be at most, in units of the distance between layers. */
#define MOST_ROUNDING 0x1p-10

/* Returns whether the points of an edge, along direction a from the first point, lie on a line and follow
   each other. inverse: of the box's sides. */
static bool is_edge(const scaled_points *points, size_t step, int a, const double inverse[9])
{
    const ffd_lattice *lattice = points->lattice;
    const double least = ffd_scaled_rounding(inverse, points->rounding) / MOST_ROUNDING;
    double before = 0;
    for (size_t i = 1; i < lattice->size[a]; i++) {
        double p[3], t[3];
        ffd_scaled_point(points, i * step, p);
        mat_apply(inverse, p, t);
        if (!(t[a] - before > least) ||
            !(fabs(t[(a + 1) % 3]) + fabs(t[(a + 2) % 3]) <= least * MOST_ROUNDING))
            return false;
        before = t[a];
    }
    return true;
}

/* Returns whether every control point is the sum of its places along the three edges. */
static bool is_grid(const scaled_points *points, const size_t step[3])
{
    const size_t *size = points->lattice->size;
    double u[3], v[3], w[3], p[3], off[3];
    for (size_t k = 0; k < size[2]; k++)
        for (size_t j = 0; j < size[1]; j++)
            for (size_t i = 0; i < size[0]; i++) {
                ffd_scaled_point(points, i * step[0], u);
                ffd_scaled_point(points, j * step[1], v);
                ffd_scaled_point(points, k * step[2], w);
                ffd_scaled_point(points, i * step[0] + j * step[1] + k * step[2], p);
                for (int r = 0; r < 3; r++)
                    off[r] = p[r] - (u[r] + v[r] + w[r]);
                if (!ffd_scaled_within(off, points->rounding))
                    return false;
            }
    return true;
}

bool ffd_rest_is_box(const scaled_points *points)
{
    const ffd_lattice *lattice = points->lattice;
    const size_t step[3] = {1, lattice->size[0], lattice->size[0] * lattice->size[1]};
    double sides[9], inverse[9], side[3];
    for (int a = 0; a < 3; a++) {
        if (ffd_knots_closed(&lattice->knots[a]))
            return false;
        ffd_scaled_point(points, (lattice->size[a] - 1) * step[a], side);
        for (int r = 0; r < 3; r++)
            sides[3 * r + a] = side[r];
    }
    if (!mat_invert(sides, inverse))
        return false;
    for (int a = 0; a < 3; a++)
        if (!is_edge(points, step[a], a, inverse))
            return false;
    return is_grid(points, step);
}
