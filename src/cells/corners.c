#include "cells/corners.h"
#include "base/vector/vec.h"
#include "cells/exact_volume.h"

#define ROOT_2 1.41421356237309504880

/* The corners: each with the ends of its three edges, which are right-handed in a cell that is numbered as
   VTK and meshio number it. Of pyramids they are tetrahedra of three corners of the base and the apex. */
static const uint8_t tetra[][4] = {{0, 1, 2, 3}};
static const uint8_t pyramid[][4] = {{3, 0, 1, 4}, {0, 1, 2, 4}, {1, 2, 3, 4}, {2, 3, 0, 4}};
static const uint8_t wedge[][4] = {{0, 1, 2, 3}, {1, 2, 0, 4}, {2, 0, 1, 5},
                                   {3, 0, 5, 4}, {4, 1, 3, 5}, {5, 2, 4, 3}};
static const uint8_t hexahedron[][4] = {{0, 1, 3, 4}, {1, 2, 0, 5}, {2, 3, 1, 6}, {3, 0, 2, 7},
                                        {4, 7, 5, 0}, {5, 4, 6, 1}, {6, 5, 7, 2}, {7, 6, 4, 3}};

static const struct {
    const uint8_t (*corners)[4];
    size_t count;
    double factor; /* the inverse of what the ideal cell has otherwise */
} families[] = {
    [FAMILY_TETRA] = {tetra, 1, 1},
    [FAMILY_PYRAMID] = {pyramid, 4, ROOT_2},
    [FAMILY_WEDGE] = {wedge, 6, 1.15470053837925152902},
    [FAMILY_HEXAHEDRON] = {hexahedron, 8, 1},
};

void ffd_corner_signs(cell_family family, const double (*p)[3], jacobian_signs *signs)
{
    for (size_t c = 0; c < families[family].count; c++) {
        const uint8_t *const corner = families[family].corners[c];
        add_sign(signs, ffd_exact_volume(p[corner[0]], p[corner[1]], p[corner[2]], p[corner[3]]), 0);
    }
}

static void edge(const double from[3], const double to[3], double out[3])
{
    for (int a = 0; a < 3; a++)
        out[a] = to[a] - from[a];
}

/* The determinant of unit vectors, c . (a x b); 0 if a vector is 0. */
static double unit_determinant(const double a[3], const double b[3], const double c[3])
{
    double normal[3];
    const double squares = vec_dot(a, a) * vec_dot(b, b) * vec_dot(c, c);
    vec_cross(a, b, normal);
    return squares > 0 ? vec_dot(c, normal) / sqrt(squares) : 0;
}

/* sqrt(2) times the determinant of the edges at a corner, relative to the largest product of the lengths of
   the edges at any of the four. */
static double tetra_determinant(const double (*p)[3], const uint8_t corner[4])
{
    static const uint8_t ends[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
    static const uint8_t at[4][3] = {{0, 2, 3}, {0, 1, 4}, {1, 2, 5}, {3, 4, 5}};
    double edges[6][3], squares[6], normal[3], product = 0;
    for (int e = 0; e < 6; e++) {
        edge(p[corner[ends[e][0]]], p[corner[ends[e][1]]], edges[e]);
        squares[e] = vec_dot(edges[e], edges[e]);
    }
    for (int c = 0; c < 4; c++)
        product = larger_of(product, squares[at[c][0]] * squares[at[c][1]] * squares[at[c][2]]);
    vec_cross(edges[2], edges[0], normal);
    const double exact = ffd_exact_volume(p[corner[0]], p[corner[1]], p[corner[2]], p[corner[3]]);
    const double rounded = vec_dot(edges[3], normal);
    const double volume = rounded * exact > 0 ? rounded : exact; /* of the exact sign */
    product = larger_of(sqrt(product), fabs(volume));
    return product > 0 ? ROOT_2 * volume / product : 0;
}

/* The determinant of the axes of a hexahedron: the sums of the edges along each. */
static double axes_scaled(const double (*p)[3])
{
    static const uint8_t along[3][4][2] = {
        {{0, 1}, {3, 2}, {4, 5}, {7, 6}}, {{0, 3}, {1, 2}, {4, 7}, {5, 6}}, {{0, 4}, {1, 5}, {2, 6}, {3, 7}}};
    double axes[3][3] = {{0}};
    for (int d = 0; d < 3; d++)
        for (int e = 0; e < 4; e++)
            for (int a = 0; a < 3; a++)
                axes[d][a] += p[along[d][e][1]][a] - p[along[d][e][0]][a];
    return unit_determinant(axes[1], axes[2], axes[0]);
}

double ffd_corners_scaled(cell_family family, const double (*p)[3])
{
    const bool of_tetras = family == FAMILY_TETRA || family == FAMILY_PYRAMID;
    double least = family == FAMILY_HEXAHEDRON ? axes_scaled(p) : HUGE_VAL;
    for (size_t c = 0; c < families[family].count; c++) {
        const uint8_t *const corner = families[family].corners[c];
        double e[3][3], own;
        for (int i = 0; i < 3; i++)
            edge(p[corner[0]], p[corner[i + 1]], e[i]);
        own = of_tetras                     ? tetra_determinant(p, corner)
              : family == FAMILY_HEXAHEDRON ? unit_determinant(e[1], e[2], e[0])
                                            : unit_determinant(e[0], e[1], e[2]);
        least = lesser_of(least, own);
    }
    least *= families[family].factor;
    if (family != FAMILY_PYRAMID)
        return least;
    /* A pyramid that is higher than the ideal one would have more than 1, and an inverted one less than 0. */
    return least > 1 ? 2 - least : larger_of(least, 0);
}
