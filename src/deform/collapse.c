#include "deform/collapse.h"
#include "base/vector/vec.h"
#include <float.h>

/* How many roundings of the greatest coordinate a derivative's steps may be off: each is the difference of
   two displacements, which are differences of coordinates that some moves have changed one after the other;
   the sum over the control points adds a few. */
#define ROUNDINGS 64

double ffd_slope_rounding(const ffd_lattice *lattice, int coordinate, double scale)
{
    return ROUNDINGS * DBL_EPSILON * lattice->greatest[coordinate] * scale;
}

/* Returns the sum of the sizes of the products of a determinant. */
static double permanent(const double m[9])
{
    return fabs(m[0]) * (fabs(m[4] * m[8]) + fabs(m[5] * m[7])) +
           fabs(m[1]) * (fabs(m[3] * m[8]) + fabs(m[5] * m[6])) +
           fabs(m[2]) * (fabs(m[3] * m[7]) + fabs(m[4] * m[6]));
}

/* Returns sum_ij |m_ij| times the permanent of r without row i and column j. */
static double permanent_with(const double m[9], const double r[9])
{
    double sum = 0;
    for (int i = 0; i < 3; i++) {
        const double *const next = r + 3 * ((i + 1) % 3), *const last = r + 3 * ((i + 2) % 3);
        sum += fabs(m[3 * i]) * (next[1] * last[2] + next[2] * last[1]) +
               fabs(m[3 * i + 1]) * (next[0] * last[2] + next[2] * last[0]) +
               fabs(m[3 * i + 2]) * (next[0] * last[1] + next[1] * last[0]);
    }
    return sum;
}

/* det (M + E) = det M + sum cof(M)_ij E_ij + sum M_ij cof(E)_ij + det E (src/maths.md 7.5). */
double ffd_determinant_change(const double m[9], const double radius[9])
{
    double cofactor[9], change = permanent(radius) + permanent_with(m, radius);
    mat_cofactor(m, cofactor);
    for (int i = 0; i < 9; i++)
        change += fabs(cofactor[i]) * radius[i];
    return change;
}

/* Returns degree / width of the cell at u in a direction. */
static double slope_scale(const knot_vector *knots, double u)
{
    const double *const span = knots->t + knots->spans[ffd_knots_span_index(knots, ffd_knots_wrap(knots, u))];
    return knots->degree / (span[1] - span[0]);
}

/* Finds d uvw / d p. Returns false if J has no inverse. */
static bool find_inverse(const ffd_lattice *lattice, const double uvw[3], double uvw_by_p[9])
{
    double point[3], jacobian[9];
    if (lattice->has_uvw_by_p) {
        for (int i = 0; i < 9; i++)
            uvw_by_p[i] = lattice->uvw_by_p[i];
        return true;
    }
    ffd_lattice_evaluate(lattice, FFD_VOLUME_REST, uvw, point, jacobian);
    return mat_invert(jacobian, uvw_by_p);
}

/* Fills bounds of the rounding errors of F: F - I is the sum over u,v,w of the displacement's derivatives,
   times the rows of d uvw / d p. */
static void find_rounding(const ffd_lattice *lattice, const double uvw[3], const double uvw_by_p[9],
                          double falloff, double rounding[9])
{
    double by_p[3] = {0}; /* of a displacement of 1 */
    for (int a = 0; a < 3; a++)
        for (int c = 0; c < 3; c++)
            by_p[c] += slope_scale(&lattice->knots[a], uvw[a]) * fabs(uvw_by_p[3 * a + c]);
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++)
            rounding[3 * r + c] = ffd_slope_rounding(lattice, r, by_p[c] + (falloff > 0 ? 1 / falloff : 0));
}

/* A determinant that is larger than this, relative to rows that are longer by 1, is not due to rounding.
   Nearly all are, and the rounding need not be known. */
#define COARSE 1e-6

bool ffd_collapses(const ffd_lattice *lattice, const double uvw[3], const double *uvw_by_p, double falloff,
                   const double gradient[9])
{
    double f[9], own[9], rounding[9];
    mat_add_identity(gradient, f);
    const double det = fabs(mat_determinant(f));
    if (det > COARSE * (1 + vec_length(f)) * (1 + vec_length(f + 3)) * (1 + vec_length(f + 6)))
        return false;
    if (!uvw_by_p && !find_inverse(lattice, uvw, own))
        return false;
    find_rounding(lattice, uvw, uvw_by_p ? uvw_by_p : own, falloff, rounding);
    /* The second term is what the determinant itself is rounded by. */
    return det <= ffd_determinant_change(f, rounding) + 8 * DBL_EPSILON * permanent(f);
}
