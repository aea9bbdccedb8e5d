/* cell_kernel.c - compiled once for each instruction set; FFD_CELL_KERNEL is the name of the function. */
#include "embed/cells/cell_kernel.h"
#include "base/vector/quad.h"

enum { N = BEZIER_COMPONENTS };

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
                const quad point = quad_load((*rows)[k][j] + N * i);
                quad_add(&line, basis->value[0][i], &point);
                quad_add(&line_u, basis->slope[0][i], &point);
            }
            quad_add(&plane, basis->value[1][j], &line);
            quad_add(&plane_u, basis->value[1][j], &line_u);
            quad_add(&plane_v, basis->slope[1][j], &line);
        }
        quad_add(&sum, basis->value[2][k], &plane);
        quad_add(&by_u, basis->value[2][k], &plane_u);
        quad_add(&by_v, basis->value[2][k], &plane_v);
        quad_add(&by_w, basis->slope[2][k], &plane);
    }
    quad_store(&sum, result->value);
    quad_store(&by_u, result->derivative[0]);
    quad_store(&by_v, result->derivative[1]);
    quad_store(&by_w, result->derivative[2]);
}

void FFD_CELL_KERNEL(const cell_basis *basis, const int order[3], const cell_rows *rows, homogeneous *result)
{
    static const int cubic[3] = {4, 4, 4};
    /* Constant orders let the compiler unroll the loops. */
    if (order[0] == 4 && order[1] == 4 && order[2] == 4)
        sum_cell(basis, cubic, rows, result);
    else
        sum_cell(basis, order, rows, result);
}
