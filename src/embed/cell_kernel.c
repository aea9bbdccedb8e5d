/* cell_kernel.c - compiled once for each instruction set: FFD_CELL_KERNEL is the function's name, FFD_LANES
   the number of doubles that a register holds. */
#include "embed/cell_kernel.h"
#include <string.h>

enum { N = BEZIER_COMPONENTS, WIDTH = FFD_LANES < N ? FFD_LANES : N, PARTS = N / WIDTH };

#if FFD_LANES == 1
typedef double lanes;
#else
typedef double lanes __attribute__((vector_size(8 * (FFD_LANES < 4 ? FFD_LANES : 4))));
#endif

/* The components of a point. */
typedef struct quad {
    lanes part[PARTS];
} quad;

static inline quad take(const double *components)
{
    quad taken;
    memcpy(&taken, components, sizeof taken);
    return taken;
}

/* *sum += factor * term */
static inline void add(quad *sum, double factor, const quad *term)
{
    for (int p = 0; p < PARTS; p++)
        sum->part[p] += factor * term->part[p];
}

static inline void sum_cell(const cell_basis *basis, const int order[3], const cell_rows *rows,
                            homogeneous *result)
{
    const quad zero = {0};
    quad sum = zero, by_u = zero, by_v = zero, by_w = zero;
    for (int k = 0; k < order[2]; k++) {
        quad plane = zero, plane_u = zero, plane_v = zero;
        for (int j = 0; j < order[1]; j++) {
            quad line = zero, line_u = zero;
            for (int i = 0; i < order[0]; i++) {
                const quad point = take((*rows)[k][j] + N * i);
                add(&line, basis->value[0][i], &point);
                add(&line_u, basis->slope[0][i], &point);
            }
            add(&plane, basis->value[1][j], &line);
            add(&plane_u, basis->value[1][j], &line_u);
            add(&plane_v, basis->slope[1][j], &line);
        }
        add(&sum, basis->value[2][k], &plane);
        add(&by_u, basis->value[2][k], &plane_u);
        add(&by_v, basis->value[2][k], &plane_v);
        add(&by_w, basis->slope[2][k], &plane);
    }
    memcpy(result->value, &sum, sizeof sum);
    memcpy(result->derivative[0], &by_u, sizeof by_u);
    memcpy(result->derivative[1], &by_v, sizeof by_v);
    memcpy(result->derivative[2], &by_w, sizeof by_w);
}

void FFD_CELL_KERNEL(const cell_basis *basis, const int order[3], const cell_rows *rows, homogeneous *result)
{
    static const int cubic[3] = {4, 4, 4};
    /* What the compiler knows it unrolls. */
    if (order[0] == 4 && order[1] == 4 && order[2] == 4)
        sum_cell(basis, cubic, rows, result);
    else
        sum_cell(basis, order, rows, result);
}
