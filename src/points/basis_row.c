#include "points/basis_row.h"
#include "base/text/number.h"
#include "deform/extension.h"
#include "spline/knots.h"
#include <math.h>

ffd_status ffd_basis_weights(const ffd_embedding *embedding, const double **weights, ffd_error *error)
{
    for (size_t i = 0; *weights && i < embedding->rest->count; i++)
        if (!((*weights)[i] > 0 && isfinite((*weights)[i])))
            return ffd_fail(error, FFD_E_INVALID,
                            "the weight %s of control point %zu is not positive and finite",
                            ffd_number_text((*weights)[i]).text, i);
    *weights = *weights ? *weights : embedding->rest->rest_weights;
    return FFD_OK;
}

/* The control points of a direction whose basis functions are not 0 at u, with these functions. */
typedef struct factor {
    size_t count, index[MAX_ORDER];
    double value[MAX_ORDER];
} factor;

/* Sorts by control point, because the indices wrap round in a closed direction. */
static void make_factor(const knot_vector *knots, int span, const double value[MAX_ORDER], factor *made)
{
    const size_t order = (size_t)knots->degree + 1, first = (size_t)span - (size_t)knots->degree;
    size_t wrapped = 0; /* number of functions before the seam */
    while (wrapped < order && ffd_knots_point(knots, first + wrapped) >= ffd_knots_point(knots, first))
        wrapped++;
    made->count = order;
    for (size_t i = 0; i < order; i++) {
        const size_t from = (i + wrapped) % order;
        made->index[i] = ffd_knots_point(knots, first + from);
        made->value[i] = value[from];
    }
}

/* Fills the row at u,v,w of a lattice, times the scale: R_j = h_j N N N / sum h N N N (NURBS Book 4.2). */
static void fill_row(const ffd_lattice *lattice, const double *weights, const double uvw[3], double scale,
                     basis_row *row)
{
    lattice_basis basis;
    factor of[3];
    double sum = 0;
    double inside[3];
    row->count = 0;
    for (int a = 0; a < 3; a++)
        inside[a] = ffd_knots_wrap(&lattice->knots[a], uvw[a]);
    ffd_lattice_basis(lattice, inside, &basis);
    for (int a = 0; a < 3; a++)
        make_factor(&lattice->knots[a], basis.span[a], basis.value[a], &of[a]);
    for (size_t k = 0; k < of[2].count; k++)
        for (size_t j = 0; j < of[1].count; j++)
            for (size_t i = 0; i < of[0].count; i++) {
                const size_t column =
                    of[0].index[i] + lattice->size[0] * (of[1].index[j] + lattice->size[1] * of[2].index[k]);
                const double value =
                    of[2].value[k] * of[1].value[j] * of[0].value[i] * (weights ? weights[column] : 1);
                sum += value;
                if (value == 0)
                    continue;
                row->columns[row->count] = (uint32_t)column;
                row->values[row->count++] = value;
            }
    for (size_t i = 0; i < row->count; i++)
        row->values[i] = weights ? scale * (row->values[i] / sum) : scale * row->values[i];
}

void ffd_basis_row(const ffd_embedding *embedding, const double *weights, size_t point, size_t *next,
                   basis_row *row)
{
    row->count = 0;
    if (ffd_embedding_has(embedding, point)) {
        fill_row(embedding->rest, weights, embedding->uvw + 3 * point, 1, row);
        return;
    }
    while (*next < embedding->extended_count && embedding->extended[*next].point < point)
        ++*next;
    if (*next == embedding->extended_count || embedding->extended[*next].point != point)
        return;
    const boundary_point *const nearest = &embedding->extended[*next].nearest;
    const double fade = ffd_extension_fade(nearest->distance, embedding->falloff, NULL);
    if (fade > 0)
        fill_row(embedding->rest, weights, nearest->uvw, fade, row);
}
