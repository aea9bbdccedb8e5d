#include "cells/hexahedron.h"
#include "base/vector/vec.h"
#include "cells/corners.h"

/* The error of a coefficient relative to the product of the largest components of the edges along each axis:
   it is a mean of up to 8 determinants, each a sum of 6 products. */
#define RELATIVE_ERROR 1e-13
/* Products that underflow. */
#define ABSOLUTE_ERROR 1e-290

/* The four edges along each axis, by the bits of their places along the next two axes. */
typedef struct hexahedron_edges {
    double of[3][4][3];
    double largest[3]; /* component of each axis */
} hexahedron_edges;

/* The point at a corner, by the bits of its coordinates. */
static const uint8_t corner_at[8] = {0, 1, 3, 2, 4, 5, 7, 6};

static void find_edges(const double (*p)[3], hexahedron_edges *edges)
{
    for (int d = 0; d < 3; d++) {
        edges->largest[d] = 0;
        for (int e = 0; e < 4; e++) {
            const int from = (e & 1) << (d + 1) % 3 | (e >> 1) << (d + 2) % 3, to = from | 1 << d;
            double *const edge = edges->of[d][e];
            for (int a = 0; a < 3; a++)
                edge[a] = p[corner_at[to]][a] - p[corner_at[from]][a];
            edges->largest[d] = larger_of(edges->largest[d], vec_greatest(edge));
        }
    }
}

/* The coefficients of degree 2 in each direction, the first fastest: those of a product of linear functions
   are means of products of theirs. */
static void find_coefficients(const hexahedron_edges *edges, double coefficients[27])
{
    for (int i = 0; i < 27; i++)
        coefficients[i] = 0;
    for (int y = 0; y < 4; y++)
        for (int z = 0; z < 4; z++) {
            double normal[3];
            vec_cross(edges->of[1][y], edges->of[2][z], normal);
            for (int x = 0; x < 4; x++) {
                /* Edges along x have bits of y and z, those along y of z and x, those along z of x and y. */
                const int i = (y >> 1) + (z & 1), j = (x & 1) + (z >> 1), k = (x >> 1) + (y & 1);
                const double weight = (i == 1 ? 0.5 : 1) * (j == 1 ? 0.5 : 1) * (k == 1 ? 0.5 : 1);
                coefficients[i + 3 * j + 9 * k] += weight * vec_dot(edges->of[0][x], normal);
            }
        }
}

/* The value at Gauss points in one direction, in place of three coefficients. */
static void reduce(const double *coefficients, size_t count, double *values)
{
    static const double roots[] = {0.21132486540518711775, 0.78867513459481288225};
    for (size_t i = 0; i < count; i++)
        for (size_t g = 0; g < 2; g++) {
            const double u = roots[g], v = 1 - u, *const c = coefficients + 3 * i;
            values[g * count + i] = v * v * c[0] + 2 * u * v * c[1] + u * u * c[2];
        }
}

/* The values at the 8 Gauss points, in any order. */
static void evaluate(const double coefficients[27], double values[8])
{
    double once[18], twice[12];
    reduce(coefficients, 9, once);
    reduce(once, 6, twice);
    reduce(twice, 4, values);
}

jacobian_state ffd_hexahedron_state(const double (*points)[3], double *least)
{
    hexahedron_edges edges;
    double coefficients[27], values[8];
    jacobian_signs corners = no_signs(), gauss = no_signs(), all = no_signs();
    find_edges(points, &edges);
    find_coefficients(&edges, coefficients);
    evaluate(coefficients, values);
    const double error =
        RELATIVE_ERROR * edges.largest[0] * edges.largest[1] * edges.largest[2] + ABSOLUTE_ERROR;
    ffd_corner_signs(FAMILY_HEXAHEDRON, points, &corners);
    for (int i = 0; i < 8; i++)
        add_sign(&gauss, values[i], error);
    for (int i = 0; i < 27; i++)
        if (i % 3 == 1 || i / 3 % 3 == 1 || i / 9 == 1) /* the others are the corners */
            add_sign(&all, coefficients[i], error);
    *least = lesser_of(corners.least, gauss.least);
    const jacobian_state at_corners = state_of(&corners);
    if (at_corners == JACOBIAN_MIXED)
        return JACOBIAN_MIXED;
    if (at_corners == JACOBIAN_POSITIVE ? gauss.negative : gauss.positive)
        return JACOBIAN_MIXED;
    return state_of(&all) == at_corners ? at_corners : JACOBIAN_UNKNOWN;
}
