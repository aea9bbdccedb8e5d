/* volume.c - the signed volume of the rest lattice. */
#include "base/memory/memory.h"
#include "embed/frame/face_net.h"
#include "fold/bernstein.h"
#include "fold/determinant.h"

/* By Gauss's theorem the integral of det [C_u C_v C_w] over the domain equals that of det [C, C_b, C_c] / 3
   over its border, (a,b,c) cyclic, last face minus first face; closed directions have no faces. With C = A/W
   the integrand is det [A, A_b, A_c] / W^3; without weights it is a polynomial, whose integral over a cell is
   the mean of its Bernstein coefficients. */

enum { N = BEZIER_COMPONENTS };

#define UNIT (0.5 * DBL_EPSILON)

/* Nodes and weights of Gauss-Legendre rules on [0,1]: the first half; the other half is symmetric. */
static const double rule_8[4][2] = {{0.019855071751231884, 0.05061426814518813},
                                    {0.10166676129318664, 0.11119051722668724},
                                    {0.2372337950418355, 0.15685332293894363},
                                    {0.4082826787521751, 0.181341891689181}};
static const double rule_12[6][2] = {
    {0.009219682876640375, 0.023587668193255914}, {0.04794137181476257, 0.05346966299765921},
    {0.11504866290284765, 0.08003916427167311},   {0.2063410228566913, 0.10158371336153296},
    {0.3160842505009099, 0.1167462682691774},     {0.43738329574426554, 0.12457352290670139}};

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
                    greatest = fmax(greatest, fabs(*value));
                }
            form->greatest.at[row][r] = greatest;
            form->rounding.at[row][r] = form->coarse.at[row][r] =
                (2 * degree * steps + 2) * UNIT * net->extent[r];
        }
    }
}

/* Integrates numerator / W^3 with a rule of 2 * half nodes in each direction. */
static double integrate(const double *numerator, const int order[3], const double *weights,
                        const int weight_order[3], const double rule[][2], int half)
{
    double sum = 0;
    for (int j = 0; j < 2 * half; j++) {
        double row = 0;
        for (int i = 0; i < 2 * half; i++) {
            const double *u = rule[i < half ? i : 2 * half - 1 - i];
            const double *v = rule[j < half ? j : 2 * half - 1 - j];
            const double t[3] = {i < half ? u[0] : 1 - u[0], j < half ? v[0] : 1 - v[0], 0};
            const double w = ffd_bernstein_value(weights, weight_order, t);
            row += u[1] * v[1] * (ffd_bernstein_value(numerator, order, t) / (w * w * w));
        }
        sum += row;
    }
    return sum;
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
    const size_t count = ffd_bernstein_count(order), weight_count = ffd_bernstein_count(box.order);
    double integral = 0, error = limits.rounding;
    if (face->plan->rational) {
        double *weights = face->rows; /* the rows are not needed any more */
        double least = DBL_MAX;
        for (size_t i = 0; i < weight_count; i++) {
            weights[i] = box.coefficients[N * i + 3];
            least = fmin(least, weights[i]);
        }
        const double rough = integrate(face->product, order, weights, box.order, rule_8, 4);
        integral = integrate(face->product, order, weights, box.order, rule_12, 6);
        error = error / (least * least * least) + fabs(integral - rough);
    } else {
        for (size_t i = 0; i < count; i++)
            integral += face->product[i];
        integral /= (double)count;
        error += (double)count * UNIT * limits.greatest;
    }
    sum->volume += integral;
    sum->size += fabs(integral);
    sum->error += error;
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
    ffd_status status = ffd_face_net_create(plan->lattice, a, &face.net, error);
    const int order[3] = {plan->order[face.net.b], plan->order[face.net.c], 1};
    const size_t count = ffd_bernstein_count(order), scratch = ffd_determinant_scratch(order, false);
    if (status)
        return status;
    face.coefficients = ffd_alloc(N * count + 9 * count + scratch + 9 * count, sizeof(double));
    if (!face.coefficients) {
        status = ffd_fail_memory(error);
        goto out;
    }
    face.rows = face.coefficients + N * count;
    face.scratch = face.rows + 9 * count;
    face.product = face.scratch + scratch;
    for (int end = 0; end < 2; end++)
        add_face(&face, scale, end, total);
out:
    ffd_face_net_free(&face.net);
    ffd_free(face.coefficients);
    return status;
}

ffd_status ffd_fold_volume(const fold_plan *plan, signed_volume *volume, ffd_error *error)
{
    face_scale scale;
    volume_sum total = {0, 0, 0};
    size_t rows = 0;
    ffd_face_scale_find(plan->lattice, &scale);
    for (int a = 0; a < 3; a++) {
        rows += 2 * plan->cells[a];
        if (ffd_knots_closed(&plan->lattice->knots[a]))
            continue;
        const ffd_status status = add_direction(plan, a, &scale, &total, error);
        if (status)
            return status;
    }
    const int exponent = scale.exponent[0] + scale.exponent[1] + scale.exponent[2];
    const double size = fabs(total.volume), doubt = total.error + (double)rows * UNIT * total.size;
    volume->sign = total.volume < 0 ? -1 : 1;
    if (size > 2 * doubt && size <= DBL_MAX) {
        volume->reference = scaled_make(size / 3, exponent);
        volume->doubt = doubt / size + 4 * UNIT;
    } else {
        volume->reference = scaled_make(1, exponent);
        volume->doubt = 0;
    }
    return FFD_OK;
}
