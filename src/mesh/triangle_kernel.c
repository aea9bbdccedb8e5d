/* triangle_kernel.c - compiled once for each instruction set; FFD_TRIANGLE_KERNEL is the name of its table.
 */
#include "mesh/triangle_kernel.h"
#include "base/vector/vec.h"
#include <string.h>

/* The square of the sine of the angle at corner 0 of triangles that are too thin: rounding has lost their
   plane. */
#define THIN 1e-24

/* Triangles: number by number what is computed, and as sums are what is added to these. */
typedef struct triangle_block {
    double from[3][TRIANGLE_RUN], to[3][TRIANGLE_RUN]; /* two edges from corner 0 */
    double first[TRIANGLE_RUN], second[TRIANGLE_RUN];  /* the differences of the weights along these */
    double parts[TRIANGLE_RUN][SLOPE_STRIDE];          /* of sums: slope times area, and area, both doubled */
} triangle_block;

static void take_edges(const triangle_run *run, triangle_block *block)
{
    const uint32_t *corner = run->corners;
    const double *const positions = run->positions, *const w = run->weights;
    const size_t count = run->count, base = run->base;
    for (size_t n = 0; n < count; n++, corner += 3) {
        const double *const from = positions + 3 * (corner[0] - base);
        const double *const to = positions + 3 * (corner[1] - base);
        const double *const last = positions + 3 * (corner[2] - base);
        for (int k = 0; k < 3; k++) {
            block->from[k][n] = to[k] - from[k];
            block->to[k][n] = last[k] - from[k];
        }
        block->first[n] = w[corner[1]] - w[corner[0]];
        block->second[n] = w[corner[2]] - w[corner[0]];
    }
}

/* A loop without branches, which compilers make of as many triangles at once as a register has doubles. */
static void find_slopes(triangle_block *block, double scale)
{
    for (size_t n = 0; n < TRIANGLE_RUN; n++) {
        const double first = block->first[n], second = block->second[n];
        double e[3], f[3], normal[3], along[3], slope[3];
        for (int k = 0; k < 3; k++) {
            e[k] = block->from[k][n] * scale;
            f[k] = block->to[k][n] * scale;
            along[k] = first * f[k] - second * e[k];
        }
        vec_cross(e, f, normal);
        vec_cross(along, normal, slope);
        const double square = vec_dot(normal, normal), least = THIN * vec_dot(e, e) * vec_dot(f, f);
        const double area = sqrt(square), share = 1 / area, change = first + second;
        const bool counts = (square > least) & (change == change);
        for (int k = 0; k < 3; k++)
            block->parts[n][k] = counts ? slope[k] * share : 0;
        block->parts[n][3] = counts ? area : 0;
    }
}

/* All are loaded before any is stored: then compilers add them at once. */
static inline void add_part(const double part[SLOPE_STRIDE], double sum[SLOPE_STRIDE])
{
    double added[SLOPE_STRIDE];
    for (int k = 0; k < SLOPE_STRIDE; k++)
        added[k] = sum[k] + part[k];
    memcpy(sum, added, sizeof added);
}

static void add_to_sums(const triangle_run *run, const triangle_block *block)
{
    const uint32_t *owner = run->owners, first = run->first, share = run->share;
    double *const sums = run->sums;
    const size_t count = run->count;
    for (size_t n = 0; n < count; n++, owner += 3) {
        const double *const part = block->parts[n];
        for (int c = 0; c < 3; c++) {
            const uint32_t at = owner[c] - first; /* wraps round before the first */
            double *const sum = sums + SLOPE_STRIDE * (size_t)at;
            if (at < share)
                add_part(part, sum);
        }
    }
}

void FFD_TRIANGLE_KERNEL(const triangle_run *run)
{
    triangle_block block;
    take_edges(run, &block);
    for (size_t n = run->count; n < TRIANGLE_RUN; n++) /* no areas */
        for (int k = 0; k < 3; k++)
            block.from[k][n] = block.to[k][n] = block.first[n] = block.second[n] = 0;
    find_slopes(&block, run->scale);
    add_to_sums(run, &block);
}
