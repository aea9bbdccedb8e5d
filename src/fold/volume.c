/* volume.c - the signed volume of the rest lattice. */
#include "base/memory/memory.h"
#include "embed/frame/bezier_box.h"
#include "fold/bernstein.h"
#include "fold/determinant.h"
#include "lattice/border.h"

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

/* A face of the domain. */
typedef struct face_net {
    const fold_plan *plan;
    int a, b, c;
    size_t count_b, count_c; /* numbers of basis functions */
    double *points;          /* control points of the face, scaled: N numbers each, b fastest */
    double extent[N];        /* max |component| */
    /* For a single cell. */
    double *coefficients, *rows, *scratch, *product;
} face_net;

typedef struct volume_scale {
    double origin[3];
    int exponent[N];
} volume_scale;

typedef struct volume_sum {
    double volume, size, error; /* the sum, the sum of magnitudes, and the sum of rounding bounds */
} volume_sum;

static int exponent_of(double size)
{
    int exponent = 0;
    if (size > 0)
        frexp(size, &exponent);
    return exponent;
}

static void find_scale(const ffd_lattice *lattice, volume_scale *scale)
{
    double greatest = 0;
    for (int r = 0; r < 3; r++) {
        double lo = lattice->rest[r], hi = lo;
        for (size_t i = 0; i < lattice->count; i++) {
            lo = fmin(lo, lattice->rest[3 * i + (size_t)r]);
            hi = fmax(hi, lattice->rest[3 * i + (size_t)r]);
        }
        scale->origin[r] = 0.5 * lo + 0.5 * hi;
        scale->exponent[r] = exponent_of(fmax(hi - scale->origin[r], scale->origin[r] - lo));
    }
    for (size_t i = 0; lattice->rest_weights && i < lattice->count; i++)
        greatest = fmax(greatest, lattice->rest_weights[i]);
    scale->exponent[3] = exponent_of(greatest);
}

static void fill_net(face_net *net, const volume_scale *scale, int end)
{
    const ffd_lattice *lattice = net->plan->lattice;
    border_face face;
    double *point = net->points;
    size_t index[3] = {0, 0, 0};
    ffd_border_face(lattice, FFD_VOLUME_REST, net->a, end, &face);
    for (int r = 0; r < N; r++)
        net->extent[r] = 0;
    for (size_t k = 0; k < net->count_c; k++)
        for (size_t j = 0; j < net->count_b; j++, point += N) {
            index[net->b] = ffd_knots_point(&lattice->knots[net->b], j);
            index[net->c] = ffd_knots_point(&lattice->knots[net->c], k);
            ffd_border_point(&face, index, scale->origin, point);
            for (int r = 0; r < N; r++) {
                /* In two steps, because the power of two may be out of range. */
                point[r] = ldexp(point[r], -scale->exponent[r]);
                if (r < 3)
                    point[r] = ldexp(point[r], net->plan->rational ? -scale->exponent[3] : 0);
                net->extent[r] = fmax(net->extent[r], fabs(point[r]));
            }
        }
}

/* Makes the rows A_b, A_c, A of a cell of the face. */
static void make_form(const face_net *net, size_t cell_b, size_t cell_c, bezier_box *box, cell_form *form)
{
    static const double one = 1;
    const fold_plan *plan = net->plan;
    const knot_vector *knots = plan->lattice->knots;
    const int order_b = plan->order[net->b], order_c = plan->order[net->c];
    const size_t first_b = (size_t)(knots[net->b].spans[cell_b] - order_b + 1);
    const size_t first_c = (size_t)(knots[net->c].spans[cell_c] - order_c + 1);
    /* The directions u, v of the box are b, c. */
    const double *matrix[3] = {plan->extraction[net->b] + cell_b * (size_t)order_b * (size_t)order_b,
                               plan->extraction[net->c] + cell_c * (size_t)order_c * (size_t)order_c, &one};
    double *to = box->coefficients = net->coefficients;
    box->rational = plan->rational;
    box->order[0] = order_b;
    box->order[1] = order_c;
    box->order[2] = 1;
    for (int k = 0; k < order_c; k++)
        for (int j = 0; j < order_b; j++, to += N)
            for (int r = 0; r < N; r++)
                to[r] =
                    net->points[N * (first_b + (size_t)j + net->count_b * (first_c + (size_t)k)) + (size_t)r];
    ffd_bezier_extract(box, matrix);

    const size_t count = ffd_bernstein_count(box->order);
    const double steps = 6 * (order_b + order_c) + 2 * plan->order[net->a] + 8;
    form->rows = 3;
    for (int row = 0; row < 3; row++) {
        const size_t next = row == 0 ? N : N * (size_t)order_b;
        const double degree = row < 2 ? box->order[row] - 1 : 1;
        int *order = form->order[row];
        for (int a = 0; a < 3; a++)
            order[a] = box->order[a] - (a == row && row < 2);
        for (int r = 0; r < 3; r++) {
            double *value = form->row[row][r] = net->rows + (size_t)(3 * row + r) * count;
            double greatest = 0;
            for (int j = 0; j < order[1]; j++)
                for (int i = 0; i < order[0]; i++, value++) {
                    const double *c = box->coefficients + N * (size_t)(i + order_b * j) + r;
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

static void add_cell(const face_net *net, size_t cell_b, size_t cell_c, volume_sum *sum)
{
    bezier_box box;
    cell_form form;
    determinant_bounds limits;
    int order[3];
    make_form(net, cell_b, cell_c, &box, &form);
    ffd_determinant_bounds(&form, &limits);
    ffd_determinant_coefficients(&form, 1, net->scratch, net->product);
    for (int a = 0; a < 3; a++)
        order[a] = form.order[0][a] + form.order[1][a] + form.order[2][a] - 2;
    const size_t count = ffd_bernstein_count(order), weight_count = ffd_bernstein_count(box.order);
    double integral = 0, error = limits.rounding;
    if (net->plan->rational) {
        double *weights = net->rows; /* the rows are not needed any more */
        double least = DBL_MAX;
        for (size_t i = 0; i < weight_count; i++) {
            weights[i] = box.coefficients[N * i + 3];
            least = fmin(least, weights[i]);
        }
        const double rough = integrate(net->product, order, weights, box.order, rule_8, 4);
        integral = integrate(net->product, order, weights, box.order, rule_12, 6);
        error = error / (least * least * least) + fabs(integral - rough);
    } else {
        for (size_t i = 0; i < count; i++)
            integral += net->product[i];
        integral /= (double)count;
        error += (double)count * UNIT * limits.greatest;
    }
    sum->volume += integral;
    sum->size += fabs(integral);
    sum->error += error;
}

/* Summed row by row, so that rounding errors do not accumulate over all cells. */
static void add_face(face_net *net, const volume_scale *scale, int end, volume_sum *total)
{
    const size_t *cells = net->plan->cells;
    const double sign = end ? 1 : -1;
    fill_net(net, scale, end);
    for (size_t k = 0; k < cells[net->c]; k++) {
        volume_sum row = {0, 0, 0};
        for (size_t j = 0; j < cells[net->b]; j++)
            add_cell(net, j, k, &row);
        total->volume += sign * row.volume;
        total->size += row.size;
        total->error += row.error + (double)cells[net->b] * UNIT * row.size;
    }
}

static ffd_status add_direction(const fold_plan *plan, int a, const volume_scale *scale, volume_sum *total,
                                ffd_error *error)
{
    face_net net = {.plan = plan, .a = a, .b = (a + 1) % 3, .c = (a + 2) % 3};
    ffd_status status = FFD_OK;
    net.count_b = plan->lattice->knots[net.b].functions;
    net.count_c = plan->lattice->knots[net.c].functions;
    /* The number of functions in two directions is at most (points + degree) each. */
    const int order[3] = {plan->order[net.b], plan->order[net.c], 1};
    const size_t count = ffd_bernstein_count(order), scratch = ffd_determinant_scratch(order, false);
    net.points = ffd_alloc(net.count_b * net.count_c, N * sizeof(double));
    net.coefficients = ffd_alloc(N * count + 9 * count + scratch + 9 * count, sizeof(double));
    if (!net.points || !net.coefficients) {
        status = ffd_fail_memory(error);
        goto out;
    }
    net.rows = net.coefficients + N * count;
    net.scratch = net.rows + 9 * count;
    net.product = net.scratch + scratch;
    for (int end = 0; end < 2; end++)
        add_face(&net, scale, end, total);
out:
    ffd_free(net.points);
    ffd_free(net.coefficients);
    return status;
}

ffd_status ffd_fold_volume(const fold_plan *plan, signed_volume *volume, ffd_error *error)
{
    volume_scale scale;
    volume_sum total = {0, 0, 0};
    size_t rows = 0;
    find_scale(plan->lattice, &scale);
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
