#include "embed/frame/rational_volume.h"
#include "base/memory/memory.h"
#include "base/vector/trig.h"
#include "base/vector/vec.h"
#include "embed/frame/face_net.h"
#include "spline/bezier.h"
#include <float.h>
#include <string.h>

/* By Gauss' theorem the integral of det [C_u C_v C_w] over the domain equals that of det [C, C_b, C_c] / 3
   over its border, (a,b,c) cyclic, last face minus first face; closed directions have no faces. With C = A/W
   the integrand is N / W^3, N = det [A, A_b, A_c] a polynomial. It is integrated by Gauss-Legendre rules on
   parts of the faces in which W varies so little that the error of the rule is bounded (find_nodes). */

enum { N = BEZIER_COMPONENTS, RULES = 6, MOST_NODES = 32 };

#define UNIT (0.5 * DBL_EPSILON)
/* How many parts the faces are cut into, at most: in all, and more for each cell. */
#define MOST_PARTS 16384
#define CELL_PARTS 256
#define MOST_HALVINGS 160
/* The greatest weight has size 1. Smaller ones than LEAST_WEIGHT lose digits by underflow; in a part that has
   only ones smaller than SMALL_WEIGHT products would. */
#define LEAST_WEIGHT 0x1p-960
#define SMALL_WEIGHT 0x1p-200
/* The error of a rule, relative to the greatest that N / W^3 could be. */
#define RULE_ERROR 0x1p-38

static const int rule_nodes[RULES] = {4, 8, 12, 16, 24, 32};

/* A Gauss-Legendre rule on [0,1], and the Bernstein polynomials of one degree at its nodes. */
typedef struct rule {
    int nodes;
    double weight[MOST_NODES];
    double value[MOST_NODES][MAX_ORDER], slope[MOST_NODES][MAX_ORDER];
} rule;

/* The sum over parts, and a bound of its error. */
typedef struct integral {
    double value, error;
} integral;

typedef struct integration {
    face_net net;
    double *extraction[3]; /* of all spans of each direction */
    rule (*rules)[RULES];  /* of each direction, made when they are needed */
    double *slots;         /* the Bezier forms of a part and of those that wait, one for each halving */
    long parts;            /* left of the budget */
} integration;

/* A part of a cell of a face: its Bezier form, order[0] fastest. Derivatives are by its own parameters, so
   that its size is part of N. */
typedef struct part {
    int order[2];
    double *coefficients;
    double steps; /* its coefficients are known to this many UNIT of the weights beside them */
} part;

/* Rules */

/* Computes P_n(x), and its derivative. */
static double legendre(int n, double x, double *derivative)
{
    double before = 1, value = x;
    for (int k = 2; k <= n; k++) {
        const double next = ((2 * k - 1) * x * value - (k - 1) * before) / k;
        before = value;
        value = next;
    }
    *derivative = n * (before - x * value) / (1 - x * x);
    return value;
}

/* Computes the Bernstein polynomials of a degree at t, and their derivatives. */
static void bernstein(int degree, double t, double *value, double *slope)
{
    value[0] = 1;
    for (int n = 1; n <= degree; n++) {
        if (n == degree)
            for (int i = 0; i <= n; i++)
                slope[i] = n * ((i > 0 ? value[i - 1] : 0) - (i < n ? value[i] : 0));
        value[n] = t * value[n - 1];
        for (int i = n - 1; i > 0; i--)
            value[i] = (1 - t) * value[i] + t * value[i - 1];
        value[0] *= 1 - t;
    }
}

/* Returns a rule for a degree. The nodes are zeros of P_n, by Newton's method from the usual approximation.
 */
static const rule *make_rule(int nodes, int degree, rule *result)
{
    if (result->nodes == nodes)
        return result;
    result->nodes = nodes;
    for (int i = 0; i < nodes; i++) {
        double x, sine, derivative;
        ffd_sincos_degrees(180 * (i + 0.75) / (nodes + 0.5), &sine, &x);
        for (int step = 0; step < 6; step++) {
            const double value = legendre(nodes, x, &derivative);
            x -= value / derivative;
        }
        legendre(nodes, x, &derivative);
        result->weight[i] = 1 / ((1 - x * x) * derivative * derivative);
        bernstein(degree, 0.5 - 0.5 * x, result->value[i], result->slope[i]);
    }
    return result;
}

/* Returns the least rule whose error is below RULE_ERROR times the greatest that |N| / W^3 could be, or -1.

   On the ellipse with the foci 0 and 1 and the sum of half-axes rho/2 a point z has |z| + |1 - z| = k = (rho
   + 1/rho) / 2, so that a polynomial of degree m is at most k^m times its greatest coefficient. N has the
   degree 3d - 1; W differs from the middle of its coefficients by at most q k^d times that, so that 1/W^3 is
   at most (1 - q k^d)^-3 times that of the least coefficient. A rule with n nodes for a function of size M on
   the ellipse has an error of at most 32/15 M rho^-2n / (1 - rho^-2) (Trefethen, Approximation Theory and
   Approximation Practice, theorem 19.3). ratio: of weights along the direction. */
static int find_nodes(int degree, double ratio)
{
    static const double size[] = {1.25, 1.5, 1.75, 2, 2.5, 3, 4, 6, 8, 16, 64, 256, 1024};
    const double q = (ratio - 1) / (ratio + 1);
    int best = RULES;
    for (size_t s = 0; s < sizeof size / sizeof *size; s++) {
        const double rho = size[s], k = 0.5 * (rho + 1 / rho);
        double weight = 1, numerator = 1;
        for (int i = 0; i < degree; i++)
            weight *= k;
        for (int i = 0; i < 3 * degree - 1; i++)
            numerator *= k;
        const double room = 1 - q * weight;
        if (!(room > 0))
            break;
        double error = 32.0 / 15 * numerator / (room * room * room) / (1 - 1 / (rho * rho));
        for (int r = 0, n = 0; r < best; r++) {
            for (; n < rule_nodes[r]; n++)
                error /= rho * rho;
            if (error <= RULE_ERROR)
                best = r;
        }
    }
    return best < RULES ? best : -1;
}

/* Parts */

/* What is known of a part from its coefficients. */
typedef struct part_view {
    double ratio[2];        /* the greatest ratio of weights in a row of direction b, c */
    double least, greatest; /* weight */
    double row[3][3];       /* max |A|, |A_b|, |A_c| of each coordinate */
} part_view;

static double *point_of(const part *p, int i, int k)
{
    return p->coefficients + N * (i + p->order[0] * k);
}

static void view_weights(const part *p, part_view *view)
{
    view->least = DBL_MAX;
    view->greatest = 0;
    for (int a = 0; a < 2; a++) {
        view->ratio[a] = 1;
        for (int k = 0; k < p->order[1 - a]; k++) {
            double least = DBL_MAX, greatest = 0;
            for (int i = 0; i < p->order[a]; i++) {
                const double h = point_of(p, a ? k : i, a ? i : k)[3];
                least = lesser_of(least, h);
                greatest = larger_of(greatest, h);
            }
            view->ratio[a] = larger_of(view->ratio[a], greatest / least);
            view->least = lesser_of(view->least, least);
            view->greatest = larger_of(view->greatest, greatest);
        }
    }
}

static void view_rows(const part *p, part_view *view)
{
    memset(view->row, 0, sizeof view->row);
    for (int k = 0; k < p->order[1]; k++)
        for (int i = 0; i < p->order[0]; i++) {
            const double *c = point_of(p, i, k);
            for (int r = 0; r < 3; r++) {
                view->row[0][r] = larger_of(view->row[0][r], fabs(c[r]));
                if (i + 1 < p->order[0])
                    view->row[1][r] = larger_of(view->row[1][r], (p->order[0] - 1) * fabs(c[N + r] - c[r]));
                if (k + 1 < p->order[1])
                    view->row[2][r] =
                        larger_of(view->row[2][r], (p->order[1] - 1) * fabs(point_of(p, i, k + 1)[r] - c[r]));
            }
        }
}

/* Returns the permanent: the most that the determinant of rows of these sizes can be. */
static double permanent(const double a[3], const double b[3], const double c[3])
{
    double sum = 0;
    for (int r = 0; r < 3; r++) {
        const int s = (r + 1) % 3, t = (r + 2) % 3;
        sum += a[r] * (b[s] * c[t] + b[t] * c[s]);
    }
    return sum;
}

/* Bounds the error of a part's integral by rounding: of its coefficients, and of the rule's sums. size: the
   greatest that the integral could be. */
static double rounding_of(const part *p, const part_view *view, double size)
{
    const double off = p->steps * UNIT * view->greatest, weight = view->least;
    const double a[3] = {off, off, off};
    double moved = permanent(a, view->row[1], view->row[2]);
    moved += 2 * (p->order[0] - 1) * permanent(view->row[0], a, view->row[2]);
    moved += 2 * (p->order[1] - 1) * permanent(view->row[0], view->row[1], a);
    return (24 * (p->order[0] + p->order[1]) + 64) * UNIT * size + 3 * off / weight * size +
           moved / weight / weight / weight;
}

static double integrate(const part *p, const rule *b, const rule *c)
{
    double sum = 0, line[MAX_ORDER][2][N];
    for (int k = 0; k < c->nodes; k++) {
        double row = 0;
        for (int i = 0; i < p->order[0]; i++) {
            memset(line[i], 0, sizeof line[i]);
            for (int j = 0; j < p->order[1]; j++)
                for (int r = 0; r < N; r++) {
                    line[i][0][r] += c->value[k][j] * point_of(p, i, j)[r];
                    line[i][1][r] += c->slope[k][j] * point_of(p, i, j)[r];
                }
        }
        for (int j = 0; j < b->nodes; j++) {
            double a[N] = {0}, by_b[3] = {0}, by_c[3] = {0}, across[3];
            for (int i = 0; i < p->order[0]; i++) {
                for (int r = 0; r < N; r++)
                    a[r] += b->value[j][i] * line[i][0][r];
                for (int r = 0; r < 3; r++) {
                    by_b[r] += b->slope[j][i] * line[i][0][r];
                    by_c[r] += b->value[j][i] * line[i][1][r];
                }
            }
            vec_cross(by_b, by_c, across);
            row += b->weight[j] * (vec_dot(a, across) / a[3] / a[3] / a[3]);
        }
        sum += c->weight[k] * row;
    }
    return sum;
}

/* Splits a part: `high` becomes the upper half, `low` the lower one, in the next slot. */
static void halve(part *high, int a, part *low)
{
    const size_t order = (size_t)high->order[a], inner = a ? N * (size_t)high->order[0] : N,
                 size = N * (size_t)(high->order[0] * high->order[1]);
    high->steps += high->order[a];
    *low = *high;
    low->coefficients = high->coefficients + size;
    for (size_t slab = 0; slab < size; slab += order * inner)
        ffd_bezier_halve_lines(order, inner, low->coefficients + slab, high->coefficients + slab);
}

/* Integrates a part of which a rule is exact enough for each direction, or that must not be halved. */
static void add_part(const integration *all, const part *p, const part_view *view, const int index[2],
                     integral *sum)
{
    const bool exact = index[0] >= 0 && index[1] >= 0;
    const int direction[2] = {all->net.b, all->net.c};
    const rule *rules[2];
    for (int a = 0; a < 2; a++) {
        const int r = exact ? index[a] : 1;
        rules[a] = make_rule(rule_nodes[r], p->order[a] - 1, &all->rules[direction[a]][r]);
    }
    const double most = permanent(view->row[0], view->row[1], view->row[2]);
    const double size = most / view->least / view->least / view->least;
    sum->value += integrate(p, rules[0], rules[1]);
    sum->error += exact ? 2 * RULE_ERROR * size + rounding_of(p, view, size) : 2 * size;
    sum->error += UNIT * fabs(sum->value);
}

/* Brings the coefficients of a part with small weights to size 1. */
static void scale_up(const part *p, double greatest)
{
    int exponent;
    frexp(greatest, &exponent);
    for (int i = 0; i < N * p->order[0] * p->order[1]; i++)
        p->coefficients[i] = ldexp(p->coefficients[i], -exponent);
}

/* Integrates a cell of a face: halves it, and its parts, along the direction in which the weights vary most,
   until a rule is exact enough. What waits is in the slots, the last one first. */
static void add_cell(integration *all, part whole, integral *sum)
{
    part waiting[MOST_HALVINGS + 1];
    int count = 1;
    part_view view;
    waiting[0] = whole;
    all->parts += CELL_PARTS;
    view_weights(&whole, &view);
    if (view.least < LEAST_WEIGHT)
        sum->error = INFINITY;
    while (count > 0) {
        part *const p = &waiting[count - 1];
        int index[2];
        view_weights(p, &view);
        for (int a = 0; a < 2; a++)
            index[a] = find_nodes(p->order[a] - 1, view.ratio[a]);
        const bool exact = index[0] >= 0 && index[1] >= 0;
        if (!exact && all->parts > 1 && count <= MOST_HALVINGS) {
            halve(p, view.ratio[0] < view.ratio[1], p + 1);
            all->parts--;
            count++;
            continue;
        }
        if (view.greatest < SMALL_WEIGHT) {
            scale_up(p, view.greatest);
            view_weights(p, &view);
        }
        view_rows(p, &view);
        add_part(all, p, &view, index, sum);
        count--;
    }
    all->parts--;
}

/* Adds row by row, so that rounding errors do not accumulate over all cells. */
static void add_face(integration *all, int end, integral *total)
{
    const face_net *net = &all->net;
    const knot_vector *knots = net->lattice->knots;
    const double sign = end ? 1 : -1;
    for (size_t k = 0; k < knots[net->c].span_count; k++) {
        integral row = {0, 0};
        for (size_t j = 0; j < knots[net->b].span_count; j++) {
            bezier_box box = {.coefficients = all->slots};
            ffd_face_net_cell(net, all->extraction, j, k, &box);
            const double steps = 6 * (box.order[0] + box.order[1]) + 2 * knots[net->a].degree + 16;
            add_cell(all, (part){{box.order[0], box.order[1]}, box.coefficients, steps}, &row);
        }
        total->value += sign * row.value;
        total->error += row.error + UNIT * fabs(total->value);
    }
}

static ffd_status add_direction(integration *all, const ffd_lattice *lattice, int a, const face_scale *scale,
                                integral *total, ffd_error *error)
{
    TRY(ffd_face_net_create(lattice, a, &all->net, error));
    const size_t order_b = (size_t)lattice->knots[all->net.b].degree + 1,
                 order_c = (size_t)lattice->knots[all->net.c].degree + 1;
    all->slots = ffd_alloc(MOST_HALVINGS + 1, N * order_b * order_c * sizeof(double));
    ffd_status status = FFD_OK;
    if (!all->slots)
        TRY_END(ffd_fail_memory(error));
    for (int end = 0; end < 2; end++) {
        ffd_face_net_fill(&all->net, scale, end);
        add_face(all, end, total);
    }
end:
    ffd_face_net_free(&all->net);
    ffd_free(all->slots);
    return status;
}

static ffd_status prepare(integration *all, const ffd_lattice *lattice, ffd_error *error)
{
    all->rules = ffd_alloc_zero(3, sizeof *all->rules);
    if (!all->rules)
        return ffd_fail_memory(error);
    for (int a = 0; a < 3; a++) {
        all->extraction[a] = ffd_bezier_extractions(&lattice->knots[a]);
        if (!all->extraction[a])
            return ffd_fail_memory(error);
    }
    return FFD_OK;
}

ffd_status ffd_rational_volume(const ffd_lattice *lattice, rational_volume *volume, ffd_error *error)
{
    integration all = {.parts = MOST_PARTS};
    integral total = {0, 0};
    face_scale scale;
    ffd_status status;
    ffd_face_scale_find(lattice, &scale);
    TRY_END(prepare(&all, lattice, error));
    for (int a = 0; a < 3; a++)
        if (!ffd_knots_closed(&lattice->knots[a]))
            TRY_END(add_direction(&all, lattice, a, &scale, &total, error));
end:
    for (int a = 0; a < 3; a++)
        ffd_free(all.extraction[a]);
    ffd_free(all.rules);
    volume->triple = total.value;
    volume->doubt = total.error >= 0 && isfinite(total.value) ? total.error : INFINITY;
    volume->exponent = scale.exponent[0] + scale.exponent[1] + scale.exponent[2];
    return status;
}
