#include "fit/affine.h"
#include "base/vector/vec.h"
#include <math.h>
#include <string.h>

/* A singular value below this part of the largest one is 0. */
#define LEAST_SINGULAR 1e-10
/* Two columns are orthogonal if the cosine between them is below this. */
#define ORTHOGONAL 1e-16
#define MOST_SWEEPS 60

/* A row of the system: a place and its offset, from their means, times the root of the weight. */
#define ROW 6

/* The length of (a, b), without an overflow of the squares. */
static double length_of(double a, double b)
{
    const double most = larger_of(fabs(a), fabs(b)), least = lesser_of(fabs(a), fabs(b));
    return most > 0 ? most * sqrt(1 + least / most * (least / most)) : 0;
}

/* Rotates a row into the triangle of three rows, so that it keeps the triangle's form. */
static void absorb(double triangle[3][ROW], double row[ROW])
{
    for (int k = 0; k < 3; k++) {
        const double length = length_of(triangle[k][k], row[k]);
        const double cosine = length > 0 ? triangle[k][k] / length : 1;
        const double sine = length > 0 ? row[k] / length : 0;
        for (int c = k; c < ROW; c++) {
            const double upper = triangle[k][c];
            triangle[k][c] = cosine * upper + sine * row[c];
            row[c] = cosine * row[c] - sine * upper;
        }
    }
}

/* Rotates two columns of m, and of v, until those of m are orthogonal. Returns whether they were not. */
static bool rotate_columns(double m[9], double v[9], int p, int q)
{
    double pp = 0, qq = 0, pq = 0;
    for (int r = 0; r < 3; r++) {
        pp += m[3 * r + p] * m[3 * r + p];
        qq += m[3 * r + q] * m[3 * r + q];
        pq += m[3 * r + p] * m[3 * r + q];
    }
    if (!(fabs(pq) > ORTHOGONAL * sqrt(pp) * sqrt(qq)))
        return false;
    const double zeta = (qq - pp) / (2 * pq);
    const double tangent = copysign(1, zeta) / (fabs(zeta) + sqrt(1 + zeta * zeta));
    const double cosine = 1 / sqrt(1 + tangent * tangent), sine = cosine * tangent;
    for (int r = 0; r < 3; r++)
        for (int which = 0; which < 2; which++) {
            double *const a = &(which ? v : m)[3 * r + p], *const b = &(which ? v : m)[3 * r + q];
            const double old = *a;
            *a = cosine * old - sine * *b;
            *b = sine * old + cosine * *b;
        }
    return true;
}

/* m = U S V^T by rotations of columns (one-sided Jacobi): m becomes U S. */
static void decompose(double m[9], double v[9])
{
    bool turns = true;
    memset(v, 0, 9 * sizeof *v);
    v[0] = v[4] = v[8] = 1;
    for (int sweep = 0; sweep < MOST_SWEEPS && turns; sweep++) {
        turns = false;
        for (int p = 0; p < 2; p++)
            for (int q = p + 1; q < 3; q++)
                turns = rotate_columns(m, v, p, q) || turns;
    }
}

static double column_length(const double m[9], int c)
{
    return length_of(length_of(m[c], m[3 + c]), m[6 + c]);
}

/* Adds what a singular direction of the places has: matrix += (right / length) v^T for the column of V. */
static void add_direction(const double m[9], const double v[9], int c, const double triangle[3][ROW],
                          double matrix[9])
{
    const double length = column_length(m, c);
    for (int o = 0; o < 3; o++) {
        double along = 0;
        for (int r = 0; r < 3; r++)
            along += m[3 * r + c] / length * triangle[r][3 + o];
        for (int a = 0; a < 3; a++)
            matrix[3 * o + a] += along / length * v[3 * a + c];
    }
}

/* Solves by the triangle, and lists the directions that it does not tell. */
static void solve(const double triangle[3][ROW], fit_affine *affine)
{
    double m[9], v[9], largest = 0;
    for (int r = 0; r < 3; r++)
        memcpy(m + 3 * r, triangle[r], 3 * sizeof *m);
    decompose(m, v);
    for (int c = 0; c < 3; c++)
        largest = larger_of(largest, column_length(m, c));
    for (int c = 0; c < 3; c++) {
        if (largest > 0 && column_length(m, c) >= LEAST_SINGULAR * largest) {
            add_direction(m, v, c, triangle, affine->matrix);
            continue;
        }
        for (int a = 0; a < 3; a++)
            affine->unknown[affine->unknown_count][a] = v[3 * a + c];
        affine->unknown_count++;
    }
}

void ffd_affine_nearest(const double *places, const double *offsets, const double *weights, size_t count,
                        fit_affine *affine)
{
    double triangle[3][ROW] = {{0}}, mean[3] = {0, 0, 0}, turned[3], sum = 0;
    *affine = (fit_affine){.unknown_count = 0};
    for (size_t i = 0; i < count; i++) {
        sum += weights[i];
        for (size_t c = 0; c < 3; c++) {
            affine->middle[c] += weights[i] / sum * (places[3 * i + c] - affine->middle[c]);
            mean[c] += weights[i] / sum * (offsets[3 * i + c] - mean[c]);
        }
    }
    for (size_t i = 0; i < count; i++) {
        double row[ROW];
        for (size_t c = 0; c < 3; c++) {
            row[c] = sqrt(weights[i]) * (places[3 * i + c] - affine->middle[c]);
            row[3 + c] = sqrt(weights[i]) * (offsets[3 * i + c] - mean[c]);
        }
        absorb(triangle, row);
    }
    solve((const double(*)[ROW])triangle, affine);
    mat_apply(affine->matrix, affine->middle, turned);
    for (int c = 0; c < 3; c++)
        affine->constant[c] = mean[c] - turned[c];
}

void ffd_affine_nearest_offset(const fit_affine *affine, const double place[3], double offset[3])
{
    mat_apply(affine->matrix, place, offset);
    for (int c = 0; c < 3; c++)
        offset[c] += affine->constant[c];
}
