#include "cells/polyhedron.h"
#include "base/vector/vec.h"

/* The error of a determinant relative to the product of the largest components of its edges, whose ends are
   means of points: those have errors relative to the points' distances, as the edges are taken from one
   vertex. */
#define RELATIVE_ERROR 1e-13
/* Products that underflow. */
#define ABSOLUTE_ERROR 1e-290

/* A polyhedron, seen from its first vertex. */
typedef struct polyhedron {
    const double *points, *origin;
    double scale;
    double center[3];
    double largest; /* component of an edge from the first vertex */
    jacobian_signs *signs;
} polyhedron;

static void place(const polyhedron *cell, uint32_t point, double out[3])
{
    for (int a = 0; a < 3; a++)
        out[a] = (cell->points[3 * (size_t)point + a] - cell->origin[a]) * cell->scale;
}

/* The mean of vertices. */
static void find_mean(const polyhedron *cell, const uint32_t *face, uint32_t count, double mean[3])
{
    double p[3];
    for (int a = 0; a < 3; a++)
        mean[a] = 0;
    for (uint32_t i = 0; i < count; i++) {
        place(cell, face[i], p);
        for (int a = 0; a < 3; a++)
            mean[a] += p[a] / count;
    }
}

/* The mean of the corners of all faces, so that a vertex counts as often as it has faces. */
static void find_center(polyhedron *cell, const uint32_t *words)
{
    const uint32_t *at = words + 1;
    double total = 0, sum[3] = {0}, p[3];
    cell->largest = 0;
    for (uint32_t f = 0; f < words[0]; f++, at += 1 + (size_t)*at)
        for (uint32_t i = 0; i < *at; i++) {
            place(cell, at[1 + i], p);
            for (int a = 0; a < 3; a++)
                sum[a] += p[a];
            cell->largest = larger_of(cell->largest, vec_greatest(p));
            total++;
        }
    for (int a = 0; a < 3; a++)
        cell->center[a] = sum[a] / total;
}

/* Adds a tetrahedron of a triangle, which looks outwards, and the centre. */
static void add_tetra(const polyhedron *cell, const double a[3], const double b[3], const double c[3])
{
    double edges[3][3], normal[3];
    for (int i = 0; i < 3; i++) {
        edges[0][i] = a[i] - cell->center[i];
        edges[1][i] = b[i] - cell->center[i];
        edges[2][i] = c[i] - cell->center[i];
    }
    vec_cross(edges[1], edges[2], normal);
    const double size = cell->largest, value = vec_dot(edges[0], normal);
    const double error = size > 0 ? RELATIVE_ERROR * size * size * size + ABSOLUTE_ERROR : 0;
    add_sign(cell->signs, value, error);
}

static void add_face(const polyhedron *cell, const uint32_t *face, uint32_t count)
{
    double mean[3], a[3], b[3], c[3];
    if (count == 3) {
        place(cell, face[0], a);
        place(cell, face[1], b);
        place(cell, face[2], c);
        add_tetra(cell, a, b, c);
        return;
    }
    find_mean(cell, face, count, mean);
    for (uint32_t i = 0; i < count; i++) {
        place(cell, face[i], a);
        place(cell, face[i + 1 < count ? i + 1 : 0], b);
        add_tetra(cell, mean, a, b);
    }
}

void ffd_polyhedron_signs(const uint32_t *words, const double *points, double scale, jacobian_signs *signs)
{
    const uint32_t *at = words + 1;
    uint32_t face = 0;
    while (face < words[0] && *at == 0) { /* faces without vertices */
        at++;
        face++;
    }
    if (face == words[0])
        return;
    polyhedron cell = {
        .points = points, .origin = points + 3 * (size_t)at[1], .scale = scale, .signs = signs};
    find_center(&cell, words);
    for (; face < words[0]; face++, at += 1 + (size_t)*at)
        if (*at > 0)
            add_face(&cell, at + 1, *at);
}

static uint32_t *put_face(uint32_t *words, const uint32_t *points, size_t count)
{
    *words++ = (uint32_t)count;
    for (size_t i = 0; i < count; i++)
        *words++ = points[i];
    return words;
}

void ffd_prism_words(const uint32_t *points, size_t n, uint32_t words[PRISM_WORDS])
{
    uint32_t base[6], *at = words;
    *at++ = (uint32_t)n + 2;
    for (size_t i = 0; i < n; i++)
        base[i] = points[(n - i) % n];
    at = put_face(at, base, n);
    at = put_face(at, points + n, n);
    for (size_t i = 0; i < n; i++) {
        const size_t next = (i + 1) % n;
        const uint32_t side[4] = {points[i], points[next], points[n + next], points[n + i]};
        at = put_face(at, side, 4);
    }
}
