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
} polyhedron;

/* The finalizer of splitmix64 (Steele, Lea, Flood, Fast Splittable Pseudorandom Number Generators, 2014). */
static uint64_t mix(uint64_t bits)
{
    bits = (bits ^ bits >> 30) * UINT64_C(0xbf58476d1ce4e5b9);
    bits = (bits ^ bits >> 27) * UINT64_C(0x94d049bb133111eb);
    return bits ^ bits >> 31;
}

/* A number for an edge, and the opposite one for the other direction. */
static uint64_t number_of(uint32_t from, uint32_t to)
{
    return from < to ? mix((uint64_t)from << 32 | to) : -mix((uint64_t)to << 32 | from);
}

bool ffd_polyhedron_is_oriented(const uint32_t *words)
{
    const uint32_t *at = words + 1;
    uint64_t sum = 0;
    for (uint32_t f = 0; f < words[0]; f++, at += 1 + (size_t)*at)
        for (uint32_t i = 0; i < *at; i++)
            sum += number_of(at[1 + i], at[1 + (i + 1 < *at ? i + 1 : 0)]);
    return sum == 0;
}

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

/* Returns the determinant of a tetrahedron of a triangle, which looks outwards, and the centre. */
static double tetra_of(const polyhedron *cell, const double a[3], const double b[3], const double c[3])
{
    double edges[3][3], normal[3];
    for (int i = 0; i < 3; i++) {
        edges[0][i] = a[i] - cell->center[i];
        edges[1][i] = b[i] - cell->center[i];
        edges[2][i] = c[i] - cell->center[i];
    }
    vec_cross(edges[1], edges[2], normal);
    return vec_dot(edges[0], normal);
}

/* What the determinants of a face's tetrahedra are for. */
typedef struct face_use {
    double sum;
    jacobian_signs *signs; /* or NULL */
    double factor, error;
} face_use;

static void take(face_use *use, double value)
{
    use->sum += value;
    if (use->signs)
        add_sign(use->signs, use->factor * value, use->error);
}

static void visit_face(const polyhedron *cell, const uint32_t *face, uint32_t count, face_use *use)
{
    double mean[3], a[3], b[3], c[3];
    if (count == 3) {
        place(cell, face[0], a);
        place(cell, face[1], b);
        place(cell, face[2], c);
        take(use, tetra_of(cell, a, b, c));
        return;
    }
    find_mean(cell, face, count, mean);
    for (uint32_t i = 0; i < count; i++) {
        place(cell, face[i], a);
        place(cell, face[i + 1 < count ? i + 1 : 0], b);
        take(use, tetra_of(cell, mean, a, b));
    }
}

static polyhedron make(const uint32_t *words, uint32_t origin, const double *points, double scale)
{
    polyhedron cell = {.points = points, .origin = points + 3 * (size_t)origin, .scale = scale};
    find_center(&cell, words);
    return cell;
}

void ffd_polyhedron_signs(const uint32_t *words, const double *points, double scale, const double *rest,
                          jacobian_signs *signs)
{
    const uint32_t *at = words + 1;
    uint32_t face = 0;
    while (face < words[0] && *at == 0) { /* faces without vertices */
        at++;
        face++;
    }
    if (face == words[0])
        return;
    const polyhedron cell = make(words, at[1], points, scale);
    const polyhedron before = rest ? make(words, at[1], rest, scale) : cell;
    const double size = cell.largest;
    const double error = size > 0 ? RELATIVE_ERROR * size * size * size + ABSOLUTE_ERROR : 0;
    for (; face < words[0]; face++, at += 1 + (size_t)*at) {
        face_use outwards = {.signs = NULL}, use = {.signs = signs, .factor = 1, .error = error};
        if (rest)
            visit_face(&before, at + 1, *at, &outwards);
        use.factor = outwards.sum < 0 ? -1 : 1;
        visit_face(&cell, at + 1, *at, &use);
    }
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
