/* cells.c - a cell of the rest lattice: its control points, its Bezier form, C and its derivatives. */
#include "embed/cells/cells.h"
#include "spline/basis.h"
#include <string.h>

enum { N = BEZIER_COMPONENTS };

const span_scheme *ffd_cells_scheme(const ffd_locator *locator, int a, int span, span_scheme *own)
{
    if (locator->cells->schemes[a])
        return &locator->cells->schemes[a][span];
    ffd_basis_scheme(&locator->knots[a], span, own);
    return own;
}

const double *ffd_cells_point(const ffd_locator *locator, const size_t function[3])
{
    const ffd_lattice *lattice = locator->lattice;
    const size_t i = ffd_knots_point(&lattice->knots[0], function[0]);
    const size_t j = ffd_knots_point(&lattice->knots[1], function[1]);
    const size_t k = ffd_knots_point(&lattice->knots[2], function[2]);
    return locator->cells->points + N * (i + lattice->size[0] * (j + lattice->size[1] * k));
}

void ffd_cell_spans(const ffd_lattice *lattice, const size_t cell[3], int span[3])
{
    for (int a = 0; a < 3; a++)
        span[a] = lattice->knots[a].spans[cell[a]];
}

void ffd_cell_bezier(const ffd_locator *locator, const size_t cell[3], bezier_box *box)
{
    const cell_search *cells = locator->cells;
    int span[3];
    ffd_cell_spans(locator->lattice, cell, span);
    double *to = box->coefficients;
    size_t function[3];
    for (int k = 0; k < cells->order[2]; k++)
        for (int j = 0; j < cells->order[1]; j++)
            for (int i = 0; i < cells->order[0]; i++, to += N) {
                function[0] = (size_t)(span[0] - cells->order[0] + 1 + i);
                function[1] = (size_t)(span[1] - cells->order[1] + 1 + j);
                function[2] = (size_t)(span[2] - cells->order[2] + 1 + k);
                memcpy(to, ffd_cells_point(locator, function), N * sizeof(double));
            }
    const double *matrix[3];
    for (int a = 0; a < 3; a++) {
        box->order[a] = cells->order[a];
        matrix[a] = cells->extraction[a] + cell[a] * (size_t)cells->order[a] * (size_t)cells->order[a];
    }
    box->rational = cells->rational;
    ffd_bezier_extract(box, matrix);
}

void ffd_cell_region(const ffd_locator *locator, const int span[3], const bezier_box *box,
                     const contraction_bound *contraction, cell_region *result)
{
    double least;
    result->grain = 0;
    for (int a = 0; a < 3; a++) {
        const double *t = locator->knots[a].t;
        const double side = t[span[a] + 1] - t[span[a]];
        result->span[a] = span[a];
        result->lo[a] = box->lo[a] * side;
        result->width[a] = (box->hi[a] - box->lo[a]) * side;
        result->grain = maximum_number(result->grain, DBL_EPSILON * (box->hi[a] / (box->hi[a] - box->lo[a])));
    }
    memcpy(result->inverse, contraction->inverse, sizeof result->inverse);
    result->bound = contraction->bound;
    ffd_bezier_weights(box, &least, &result->greatest_weight);
}

void ffd_cells_rows(const ffd_locator *locator, const int span[3], cell_rows rows, double own[CELL_NUMBERS])
{
    const int *const order = locator->cells->order;
    size_t first[3], function[3];
    for (int a = 0; a < 3; a++)
        first[a] = (size_t)(span[a] - order[a] + 1);
    const bool turns = first[0] + (size_t)order[0] > locator->lattice->size[0];
    for (int k = 0; k < order[2]; k++)
        for (int j = 0; j < order[1]; j++) {
            function[0] = first[0];
            function[1] = first[1] + (size_t)j;
            function[2] = first[2] + (size_t)k;
            rows[k][j] = turns ? own : ffd_cells_point(locator, function);
            for (int i = 0; i < order[0] && turns; i++, own += N) {
                function[0] = first[0] + (size_t)i;
                memcpy(own, ffd_cells_point(locator, function), N * sizeof *own);
            }
        }
}

void ffd_cells_evaluate(const ffd_locator *locator, const int span[3], const double offset[3],
                        homogeneous *result)
{
    const cell_search *cells = locator->cells;
    cell_basis basis;
    cell_rows rows;
    double own[CELL_NUMBERS];
    for (int a = 0; a < 3; a++) {
        span_scheme made;
        const span_scheme *const scheme = ffd_cells_scheme(locator, a, span[a], &made);
        ffd_basis_derivatives_by(scheme, offset[a], basis.value[a], basis.slope[a]);
    }
    ffd_cells_rows(locator, span, rows, own);
    cells->kernel(&basis, cells->order, (const cell_rows *)&rows, result);
    if (!cells->rational) {
        result->value[3] = 1;
        for (int a = 0; a < 3; a++)
            result->derivative[a][3] = 0;
    }
}

void ffd_cells_centre(const ffd_locator *locator, cell_region *region)
{
    homogeneous at;
    double offset[3];
    for (int a = 0; a < 3; a++)
        offset[a] = region->lo[a] + 0.5 * region->width[a];
    ffd_cells_evaluate(locator, region->span, offset, &at);
    memcpy(region->centre, at.value, sizeof region->centre);
}
