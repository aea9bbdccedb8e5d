/* volume.c - the signed volume of the rest lattice. */
#include "base/arithmetic.h"
#include "base/memory/memory.h"
#include "embed/frame/face_net.h"
#include "embed/frame/rational_volume.h"
#include "fold/bernstein.h"
#include "fold/determinant.h"

/* Without weights. By Gauss's theorem the integral of det [C_u C_v C_w] over the domain equals that of det
   [C, C_b, C_c] / 3 over its border, (a,b,c) cyclic, last face minus first face; closed directions have no
   faces. The integrand is a polynomial, whose integral over a cell is the mean of its Bernstein coefficients.
 */

enum { N = BEZIER_COMPONENTS };

#define UNIT (0.5 * DBL_EPSILON)

/* A face of the domain, and memory for a single cell of it. */
typedef struct volume_face {
    const fold_plan *plan;
    face_net net;
    double *coefficients, *rows, *scratch, *product;
} volume_face;

typedef struct volume_sum {
    double volume, size, error; /* the sum, the sum of magnitudes, and the sum of rounding bounds */
} volume_sum;

/* Makes the rows A_b, A_c, A of a cell of the face. */
static void make_form(const volume_face *face, size_t cell_b, size_t cell_c, bezier_box *box, cell_form *form)
{
    const face_net *net = &face->net;
    box->coefficients = face->coefficients;
    ffd_face_net_cell(net, face->plan->extraction, cell_b, cell_c, box);

    const size_t count = ffd_bernstein_count(box->order);
    const double steps = 6 * (box->order[0] + box->order[1]) + 2 * face->plan->order[net->a] + 8;
    form->rows = 3;
    for (int row = 0; row < 3; row++) {
        const size_t next = row == 0 ? N : N * (size_t)box->order[0];
        const double degree = row < 2 ? box->order[row] - 1 : 1;
        int *order = form->order[row];
        for (int a = 0; a < 3; a++)
            order[a] = box->order[a] - (a == row && row < 2);
        for (int r = 0; r < 3; r++) {
            double *value = form->row[row][r] = face->rows + (size_t)(3 * row + r) * count;
            double greatest = 0;
            for (int j = 0; j < order[1]; j++)
                for (int i = 0; i < order[0]; i++, value++) {
                    const double *c = box->coefficients + N * (size_t)(i + box->order[0] * j) + r;
                    *value = row == 2 ? *c : degree * (c[next] - *c);
                    greatest = maximum_number(greatest, fabs(*value));
                }
            form->greatest.at[row][r] = greatest;
            form->rounding.at[row][r] = form->coarse.at[row][r] =
                (2 * degree * steps + 2) * UNIT * net->extent[r];
        }
    }
}

static void add_cell(const volume_face *face, size_t cell_b, size_t cell_c, volume_sum *sum)
{
    bezier_box box;
    cell_form form;
    determinant_bounds limits;
    int order[3];
    make_form(face, cell_b, cell_c, &box, &form);
    ffd_determinant_bounds(&form, &limits);
    ffd_determinant_coefficients(&form, 1, face->scratch, face->product);
    for (int a = 0; a < 3; a++)
        order[a] = form.order[0][a] + form.order[1][a] + form.order[2][a] - 2;
    const size_t count = ffd_bernstein_count(order);
    double integral = 0;
    for (size_t i = 0; i < count; i++)
        integral += face->product[i];
    integral /= (double)count;
    sum->volume += integral;
    sum->size += fabs(integral);
    sum->error += limits.rounding + (double)count * UNIT * limits.greatest;
}

/* Summed row by row, so that rounding errors do not accumulate over all cells. */
static void add_face(volume_face *face, const face_scale *scale, int end, volume_sum *total)
{
    const size_t *cells = face->plan->cells;
    const face_net *net = &face->net;
    const double sign = end ? 1 : -1;
    ffd_face_net_fill(&face->net, scale, end);
    for (size_t k = 0; k < cells[net->c]; k++) {
        volume_sum row = {0, 0, 0};
        for (size_t j = 0; j < cells[net->b]; j++)
            add_cell(face, j, k, &row);
        total->volume += sign * row.volume;
        total->size += row.size;
        total->error += row.error + (double)cells[net->b] * UNIT * row.size;
    }
}

static ffd_status add_direction(const fold_plan *plan, int a, const face_scale *scale, volume_sum *total,
                                ffd_error *error)
{
    volume_face face = {.plan = plan};
    TRY(ffd_face_net_create(plan->lattice, a, &face.net, error));
    const int order[3] = {plan->order[face.net.b], plan->order[face.net.c], 1};
    const size_t count = ffd_bernstein_count(order), scratch = ffd_determinant_scratch(order, false);
    face.coefficients = ffd_alloc(N * count + 9 * count + scratch + 9 * count, sizeof(double));
    ffd_status status;
    TRY_END(face.coefficients ? FFD_OK : ffd_fail_memory(error));
    face.rows = face.coefficients + N * count;
    face.scratch = face.rows + 9 * count;
    face.product = face.scratch + scratch;
    for (int end = 0; end < 2; end++)
        add_face(&face, scale, end, total);
end:
    ffd_face_net_free(&face.net);
    ffd_free(face.coefficients);
    return status;
}

static ffd_status find_polynomial_volume(const fold_plan *plan, rational_volume *volume, ffd_error *error)
{
    face_scale scale;
    volume_sum total = {0, 0, 0};
    size_t rows = 0;
    ffd_face_scale_find(plan->lattice, &scale);
    for (int a = 0; a < 3; a++) {
        rows += 2 * plan->cells[a];
        if (ffd_knots_closed(&plan->lattice->knots[a]))
            continue;
        TRY(add_direction(plan, a, &scale, &total, error));
    }
    volume->triple = total.volume;
    volume->doubt = total.error + (double)rows * UNIT * total.size;
    volume->exponent = scale.exponent[0] + scale.exponent[1] + scale.exponent[2];
    return FFD_OK;
}

/* The volume of the bounds of the control points. A side of 0 counts as the longest one. */
static scaled bounds_volume(const ffd_lattice *lattice)
{
    double side[3], longest = 0;
    scaled volume = scaled_make(1, 0);
    for (int r = 0; r < 3; r++) {
        double lo = lattice->rest[r], hi = lo;
        for (size_t i = 0; i < lattice->count; i++) {
            lo = minimum_number(lo, lattice->rest[3 * i + (size_t)r]);
            hi = maximum_number(hi, lattice->rest[3 * i + (size_t)r]);
        }
        side[r] = hi - lo;
        longest = maximum_number(longest, side[r]);
    }
    for (int r = 0; r < 3 && longest > 0; r++)
        volume = scaled_multiply(volume, scaled_make(side[r] > 0 ? side[r] : longest, 0));
    return volume;
}

ffd_status ffd_fold_volume(const fold_plan *plan, signed_volume *volume, ffd_error *error)
{
    rational_volume found;
    TRY(plan->rational ? ffd_rational_volume(plan->lattice, &found, error)
                       : find_polynomial_volume(plan, &found, error));
    const double size = fabs(found.triple);
    volume->sign = found.triple < 0 ? -1 : 1;
    volume->is_mean = size > 2 * found.doubt && size <= DBL_MAX;
    volume->reference =
        volume->is_mean ? scaled_make(size / 3, found.exponent) : bounds_volume(plan->lattice);
    volume->doubt = volume->is_mean ? found.doubt / size + 4 * UNIT : 4 * UNIT;
    return FFD_OK;
}
