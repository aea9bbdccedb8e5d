#include "fold/affine/affine.h"
#include "base/vector/vec.h"
#include "fold/affine/rest_box.h"
#include "lattice/spec.h"
#include <float.h>

/* How much less than that of the map det F can be, in units of degree^3 and the rounding (src/maths.md
   10.1). */
#define LOSS 108

static void set_column(double m[9], int a, const double column[3])
{
    for (int r = 0; r < 3; r++)
        m[3 * r + a] = column[r];
}

/* Finds the control point that spans the most with those before: the longest edge from the first point, then
   the greatest area, then the greatest volume. */
static void span_most(const scaled_points *points, int edges, double edge[3][3], size_t at[3])
{
    double greatest = -1;
    for (size_t i = 0; i < points->lattice->count; i++) {
        double p[3], across[3];
        ffd_scaled_point(points, i, p);
        if (edges > 0)
            vec_cross(edge[0], edges > 1 ? edge[1] : p, across);
        const double spanned = edges == 0   ? vec_dot(p, p)
                               : edges == 1 ? vec_dot(across, across)
                                            : fabs(vec_dot(across, p));
        if (spanned > greatest) {
            greatest = spanned;
            at[edges] = i;
        }
    }
    ffd_scaled_point(points, at[edges], edge[edges]);
}

/* The affine map by which four control points move, a tetrahedron with three edges from the first point. */
typedef struct affine_move {
    double edges[9], changes[9];    /* at rest, and what they change by; in columns */
    double by_rest[9], by_moved[9]; /* the inverses of the edges at rest, and moved */
    double gradient[9];             /* of the displacement */
    bool is_translation;
} affine_move;

static bool find_move(const scaled_points *points, affine_move *move)
{
    double edge[3][3], change[3], moved[9];
    size_t at[3];
    move->is_translation = true;
    for (int a = 0; a < 3; a++) {
        span_most(points, a, edge, at);
        ffd_scaled_change(points, at[a], change);
        set_column(move->edges, a, edge[a]);
        set_column(move->changes, a, change);
        move->is_translation = move->is_translation && change[0] == 0 && change[1] == 0 && change[2] == 0;
    }
    for (int i = 0; i < 9; i++)
        moved[i] = move->edges[i] + move->changes[i];
    if (!mat_invert(move->edges, move->by_rest) || !mat_invert(moved, move->by_moved))
        return false;
    mat_multiply(move->changes, move->by_rest, move->gradient);
    return true;
}

/* How far control points are from the map at most, in units of the tetrahedron's moved edges: as computed,
   and with the rounding of that. */
typedef struct map_error {
    double found, most;
} map_error;

/* sizes[r] += sum of |m_rc v_c| */
static void add_sizes(const double m[9], const double v[3], double sizes[3])
{
    for (int r = 0; r < 3; r++)
        sizes[r] += fabs(m[3 * r] * v[0]) + fabs(m[3 * r + 1] * v[1]) + fabs(m[3 * r + 2] * v[2]);
}

/* Computes how far a control point is from the map, and a bound of the rounding of that. Its coordinates t
   along the edges are refined once: those of a thin lattice lose digits that the map needs. */
static void find_off(const scaled_points *points, const affine_move *move, size_t i, double off[3],
                     double rounding[3])
{
    double p[3], t[3], image[3], more[3], inner[3];
    ffd_scaled_point(points, i, p);
    ffd_scaled_change(points, i, off);
    mat_apply(move->by_rest, p, t);
    mat_apply(move->edges, t, image);
    for (int r = 0; r < 3; r++) {
        rounding[r] = fabs(off[r]);
        inner[r] = fabs(p[r]);
        image[r] = p[r] - image[r];
    }
    mat_apply(move->by_rest, image, more);
    for (int a = 0; a < 3; a++)
        t[a] += more[a];
    mat_apply(move->changes, t, image);
    for (int r = 0; r < 3; r++)
        off[r] -= image[r];
    add_sizes(move->edges, t, inner);
    add_sizes(move->changes, t, rounding);
    add_sizes(move->gradient, inner, rounding);
    for (int r = 0; r < 3; r++)
        rounding[r] *= 4 * DBL_EPSILON;
}

/* Returns whether all control points move by the map, to rounding. */
static bool fits(const scaled_points *points, const affine_move *move, map_error *error)
{
    *error = (map_error){0, 0};
    for (size_t i = 0; i < points->lattice->count; i++) {
        double off[3], rounding[3];
        find_off(points, move, i, off, rounding);
        if (!ffd_scaled_within(off, points->rounding))
            return false;
        for (int a = 0; a < 3; a++) {
            const double found = fabs(vec_dot(move->by_moved + 3 * a, off));
            error->found = larger_of(error->found, found);
            error->most = larger_of(error->most, found + ffd_scaled_rounding(move->by_moved, rounding));
        }
    }
    return true;
}

/* Returns the sum of the sizes of a determinant's products. */
static double permanent(const double m[9])
{
    double sum = 0;
    for (int a = 0; a < 3; a++) {
        const int b = (a + 1) % 3, c = (a + 2) % 3;
        sum += fabs(m[a]) * (fabs(m[3 + b] * m[6 + c]) + fabs(m[3 + c] * m[6 + b]));
    }
    return sum;
}

static bool is_affine_move(const scaled_points *points, double *determinant)
{
    double matrix[9], degree = 0;
    affine_move move;
    map_error error;
    if (!find_move(points, &move) || !fits(points, &move, &error))
        return false;
    if (move.is_translation && error.found == 0)
        return true;
    for (int i = 0; i < 9; i++)
        matrix[i] = move.gradient[i] + (i % 4 == 0);
    for (int a = 0; a < 3; a++)
        degree = larger_of(degree, points->lattice->knots[a].degree);
    const double loss = LOSS * degree * degree * degree * error.most;
    *determinant = mat_determinant(matrix) * (1 - loss) - 16 * DBL_EPSILON * permanent(matrix);
    return loss <= 0.5 && *determinant > 0;
}

static bool is_still(const ffd_lattice *lattice)
{
    for (size_t c = 0; c < 3 * lattice->count; c++)
        if (lattice->difference[c] != 0)
            return false;
    return true;
}

bool ffd_fold_is_affine(const ffd_lattice *lattice, double *determinant)
{
    const bool is_shape = lattice->spec && lattice->spec->rest != SPEC_POINTS;
    scaled_points points;
    *determinant = 1;
    if (!(is_shape || lattice->rest_weights) || lattice->weights_moved)
        return false;
    ffd_scaled_points_make(lattice, &points);
    return (is_still(lattice) || is_affine_move(&points, determinant)) &&
           (is_shape || ffd_rest_is_box(&points));
}
