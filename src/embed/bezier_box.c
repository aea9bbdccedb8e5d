#include "embed/bezier_box.h"
#include "base/vec.h"
#include <float.h>
#include <string.h>

enum { N = BEZIER_COMPONENTS };

size_t ffd_bezier_count(const int order[3])
{
    return (size_t)order[0] * (size_t)order[1] * (size_t)order[2];
}

size_t ffd_bezier_size(const int order[3])
{
    return N * ffd_bezier_count(order);
}

static size_t stride_of(const int order[3], int a)
{
    return a == 0 ? 1 : a == 1 ? (size_t)order[0] : (size_t)order[0] * (size_t)order[1];
}

/* Every line of control points along a: the first point's number from a running number of lines. */
static size_t line_start(const int order[3], int a, size_t line)
{
    if (a == 0)
        return line * (size_t)order[0];
    if (a == 2)
        return line;
    const size_t u = line % (size_t)order[0], w = line / (size_t)order[0];
    return u + w * (size_t)order[0] * (size_t)order[1];
}

/* Multiplies every line of points along a by the span's extraction matrix. */
static void extract_direction(bezier_box *box, const double *matrix, int a)
{
    const size_t stride = N * stride_of(box->order, a),
                 lines = ffd_bezier_count(box->order) / (size_t)box->order[a];
    const int order = box->order[a];
    for (size_t number = 0; number < lines; number++) {
        double line[MAX_ORDER][N];
        double *first = box->coefficients + N * line_start(box->order, a, number);
        for (int i = 0; i < order; i++)
            memcpy(line[i], first + stride * (size_t)i, sizeof line[i]);
        for (int r = 0; r < order; r++)
            for (int c = 0; c < N; c++) {
                double sum = 0;
                for (int i = 0; i < order; i++)
                    sum += matrix[r * order + i] * line[i][c];
                first[stride * (size_t)r + (size_t)c] = sum;
            }
    }
}

void ffd_bezier_extract(bezier_box *box, const double *const matrix[3])
{
    for (int a = 0; a < 3; a++) {
        box->lo[a] = 0;
        box->hi[a] = 1;
        extract_direction(box, matrix[a], a);
    }
    if (!box->rational) /* the matrices' rows sum to 1 but for rounding */
        for (size_t i = 0; i < ffd_bezier_count(box->order); i++)
            box->coefficients[N * i + 3] = 1;
}

/* De Casteljau's scheme at 1/2. The upper half arises in place: after step k, points k.. hold the level-k
   values of the line, and point k+.. of the lower half is the first of them. */
void ffd_bezier_halve(const bezier_box *box, int a, bezier_box *lower, bezier_box *upper)
{
    const size_t stride = N * stride_of(box->order, a),
                 lines = ffd_bezier_count(box->order) / (size_t)box->order[a];
    const int order = box->order[a];
    if (upper->coefficients != box->coefficients)
        memcpy(upper->coefficients, box->coefficients, ffd_bezier_size(box->order) * sizeof(double));
    for (size_t line = 0; line < lines; line++) {
        const size_t start = N * line_start(box->order, a, line);
        for (int c = 0; c < N; c++) {
            double *high = upper->coefficients + start + c, *low = lower->coefficients + start + c;
            for (int k = 0; k < order; k++) {
                low[(size_t)k * stride] = high[0];
                for (int i = 0; i + 1 < order - k; i++)
                    high[(size_t)i * stride] =
                        0.5 * high[(size_t)i * stride] + 0.5 * high[(size_t)(i + 1) * stride];
            }
        }
    }
    const double middle = 0.5 * (box->lo[a] + box->hi[a]), end = box->hi[a];
    for (int b = 0; b < 3; b++) {
        lower->order[b] = upper->order[b] = box->order[b];
        const double lo = box->lo[b], hi = box->hi[b];
        lower->lo[b] = upper->lo[b] = lo;
        lower->hi[b] = upper->hi[b] = hi;
    }
    lower->rational = upper->rational = box->rational;
    lower->hi[a] = middle;
    upper->lo[a] = middle;
    upper->hi[a] = end;
}

static const bounds empty_bounds = {{DBL_MAX, DBL_MAX, DBL_MAX}, {-DBL_MAX, -DBL_MAX, -DBL_MAX}};

bounds ffd_bezier_hull(const bezier_box *box)
{
    bounds hull = empty_bounds;
    const size_t size = ffd_bezier_size(box->order);
    for (size_t i = 0; i < size; i += N) {
        const double *c = box->coefficients + i;
        const double point[3] = {c[0] / c[3], c[1] / c[3], c[2] / c[3]};
        bounds_add(&hull, point);
    }
    return hull;
}

void ffd_bezier_weights(const bezier_box *box, double *least, double *greatest)
{
    *least = DBL_MAX;
    *greatest = 0;
    const size_t size = ffd_bezier_size(box->order);
    for (size_t i = 3; i < size; i += N) {
        const double h = box->coefficients[i];
        *least = h < *least ? h : *least;
        *greatest = h > *greatest ? h : *greatest;
    }
}

/* F's value at a control point: A - p W. */
static void equation(const double *c, const double p[3], double f[3])
{
    for (int a = 0; a < 3; a++)
        f[a] = c[a] - p[a] * c[3];
}

bounds ffd_bezier_equation_hull(const bezier_box *box, const double p[3])
{
    bounds hull = empty_bounds;
    const size_t size = ffd_bezier_size(box->order);
    for (size_t i = 0; i < size; i += N) {
        double f[3];
        equation(box->coefficients + i, p, f);
        bounds_add(&hull, f);
    }
    return hull;
}

bounds ffd_bezier_image(const bezier_box *box, const double inverse[9], const double p[3])
{
    bounds hull = empty_bounds;
    const size_t size = ffd_bezier_size(box->order);
    for (size_t i = 0; i < size; i += N) {
        double f[3];
        equation(box->coefficients + i, p, f);
        mat_apply(inverse, f, f);
        bounds_add(&hull, f);
    }
    return hull;
}

/* Bernstein polynomials of the degree at 1/2: binomial(d, i) / 2^d, exact. */
static void bernstein_at_half(int degree, double value[MAX_ORDER])
{
    double binomial = 1;
    for (int i = 0; i <= degree; i++) {
        value[i] = ldexp(binomial, -degree);
        binomial = binomial * (degree - i) / (i + 1);
    }
}

/* J_F at the centre, row by row. */
static void centre_jacobian(const bezier_box *box, const double p[3], double jacobian[9])
{
    double value[3][MAX_ORDER], slope[3][MAX_ORDER];
    for (int a = 0; a < 3; a++) {
        const int degree = box->order[a] - 1;
        double lower[MAX_ORDER] = {0};
        bernstein_at_half(degree, value[a]);
        bernstein_at_half(degree - 1, lower);
        for (int i = 0; i <= degree; i++)
            slope[a][i] = degree * ((i > 0 ? lower[i - 1] : 0) - (i < degree ? lower[i] : 0));
    }
    for (int i = 0; i < 9; i++)
        jacobian[i] = 0;
    const double *c = box->coefficients;
    for (int k = 0; k < box->order[2]; k++)
        for (int j = 0; j < box->order[1]; j++)
            for (int i = 0; i < box->order[0]; i++, c += N) {
                double f[3];
                equation(c, p, f);
                const double du = slope[0][i] * value[1][j] * value[2][k];
                const double dv = value[0][i] * slope[1][j] * value[2][k];
                const double dw = value[0][i] * value[1][j] * slope[2][k];
                for (int r = 0; r < 3; r++) {
                    jacobian[3 * r] += f[r] * du;
                    jacobian[3 * r + 1] += f[r] * dv;
                    jacobian[3 * r + 2] += f[r] * dw;
                }
            }
}

/* Where column b of Y J_F stands: 3 coefficients for each control point that has a next one along b. */
static double *column_of(const bezier_box *box, int b, double *columns)
{
    return columns + (size_t)b * 3 * ffd_bezier_count(box->order);
}

static void column_coefficients(const bezier_box *box, int b, const double middle[3], const double inverse[9],
                                double *column)
{
    const size_t next = N * stride_of(box->order, b);
    const double degree = box->order[b] - 1;
    const int last[3] = {box->order[0] - (b == 0), box->order[1] - (b == 1), box->order[2] - (b == 2)};
    for (int k = 0; k < last[2]; k++)
        for (int j = 0; j < last[1]; j++)
            for (int i = 0; i < last[0]; i++) {
                const size_t point = (size_t)((k * box->order[1] + j) * box->order[0] + i);
                const double *c = box->coefficients + N * point, *d = c + next;
                const double difference[N] = {degree * (d[0] - c[0]), degree * (d[1] - c[1]),
                                              degree * (d[2] - c[2]), degree * (d[3] - c[3])};
                double f[3];
                equation(difference, middle, f);
                mat_apply(inverse, f, column + 3 * point);
            }
}

/* The greatest |delta_rb - coefficient| of each row of the column, with the reach of p added. */
static void column_distance(const bezier_box *box, int b, const double reach[3], const double inverse[9],
                            const double *column, double distance[3])
{
    const size_t next = N * stride_of(box->order, b);
    const double degree = box->order[b] - 1;
    const int last[3] = {box->order[0] - (b == 0), box->order[1] - (b == 1), box->order[2] - (b == 2)};
    double away[3];
    for (int r = 0; r < 3; r++) {
        const double *row = inverse + 3 * r;
        away[r] = fabs(row[0]) * reach[0] + fabs(row[1]) * reach[1] + fabs(row[2]) * reach[2];
        distance[r] = 0;
    }
    for (int k = 0; k < last[2]; k++)
        for (int j = 0; j < last[1]; j++)
            for (int i = 0; i < last[0]; i++) {
                const size_t point = (size_t)((k * box->order[1] + j) * box->order[0] + i);
                const double *c = box->coefficients + N * point + 3;
                const double weight = fabs(degree * (c[next] - c[0]));
                for (int r = 0; r < 3; r++) {
                    const double off =
                        fabs((r == b ? 1.0 : 0.0) - column[3 * point + (size_t)r]) + away[r] * weight;
                    if (!(off <= distance[r])) /* a NaN must not pass as a small bound */
                        distance[r] = off;
                }
            }
}

/* How much a row of a column varies along a line of coefficients. */
static double line_spread(const double *first, size_t stride, int length)
{
    double least = *first, greatest = *first;
    for (int i = 1; i < length; i++) {
        const double value = first[(size_t)i * stride];
        least = value < least ? value : least;
        greatest = value > greatest ? value : greatest;
    }
    return greatest - least;
}

/* spread[r][a]: how much row r of the column varies along a, over all lines of coefficients. */
static void column_spread(const bezier_box *box, int b, const double *column, double spread[3][3])
{
    for (int a = 0; a < 3; a++) {
        const int across[2] = {(a + 1) % 3, (a + 2) % 3};
        size_t stride[2], count[2];
        for (int i = 0; i < 2; i++) {
            stride[i] = 3 * stride_of(box->order, across[i]);
            count[i] = (size_t)box->order[across[i]] - (across[i] == b); /* the last layer along b has none */
        }
        for (int r = 0; r < 3; r++)
            spread[r][a] = 0;
        for (size_t m = 0; m < count[1]; m++)
            for (size_t n = 0; n < count[0]; n++)
                for (size_t r = 0; r < 3; r++) {
                    const double *first = column + m * stride[1] + n * stride[0] + r;
                    const double found =
                        line_spread(first, 3 * stride_of(box->order, a), box->order[a] - (a == b));
                    spread[r][a] = found > spread[r][a] ? found : spread[r][a];
                }
    }
}

/* The greatest row sum of spreads once the box is halved along c (-1: as it is). Halving halves every spread
   along c and all of column c (its derivative is by a shorter side), and doubles row c (its coordinate is
   stretched). */
static double predicted_sum(double spread[3][3][3], int c)
{
    double greatest = 0;
    for (int r = 0; r < 3; r++) {
        double sum = 0;
        for (int b = 0; b < 3; b++)
            for (int a = 0; a < 3; a++)
                sum += spread[b][r][a] * (a == c ? 0.5 : 1) * (b == c ? 0.5 : 1) * (r == c ? 2 : 1);
        greatest = sum > greatest ? sum : greatest;
    }
    return greatest;
}

/* Where no halving alone wins anything, the longest side is taken: all three together always do. */
static int best_halving(const bezier_box *box, double spread[3][3][3])
{
    int best = 0, longest = 0;
    double least = DBL_MAX;
    for (int c = 0; c < 3; c++) {
        const double predicted = predicted_sum(spread, c);
        if (predicted < least) {
            least = predicted;
            best = c;
        }
        if (box->hi[c] - box->lo[c] > box->hi[longest] - box->lo[longest])
            longest = c;
    }
    return least < (1 - 1.0 / 64) * predicted_sum(spread, -1) ? best : longest;
}

/* The direction in which the box is widest in space. */
static int widest(const bezier_box *box)
{
    int best = 0;
    double longest = -1;
    for (int a = 0; a < 3; a++) {
        const size_t stride = N * stride_of(box->order, a);
        const size_t lines = ffd_bezier_count(box->order) / (size_t)box->order[a];
        for (size_t line = 0; line < lines; line++) {
            const double *first = box->coefficients + N * line_start(box->order, a, line);
            double length = 0;
            for (int i = 0; i + 1 < box->order[a]; i++) {
                const double *c = first + (size_t)i * stride, *d = c + stride;
                const double step[3] = {d[0] / d[3] - c[0] / c[3], d[1] / d[3] - c[1] / c[3],
                                        d[2] / d[3] - c[2] / c[3]};
                length += vec_length(step);
            }
            if (length > longest) {
                longest = length;
                best = a;
            }
        }
    }
    return best;
}

void ffd_bezier_contraction(const bezier_box *box, const double middle[3], const double reach[3],
                            double *columns, contraction_bound *result)
{
    double jacobian[9], sum[3] = {0, 0, 0};
    centre_jacobian(box, middle, jacobian);
    result->regular = mat_invert(jacobian, result->inverse);
    if (!result->regular)
        return;
    for (int b = 0; b < 3; b++) {
        double distance[3], *const column = column_of(box, b, columns);
        column_coefficients(box, b, middle, result->inverse, column);
        column_distance(box, b, reach, result->inverse, column, distance);
        for (int r = 0; r < 3; r++)
            sum[r] += distance[r];
    }
    result->bound = sum[0];
    for (int r = 1; r < 3; r++)
        if (!(sum[r] <= result->bound))
            result->bound = sum[r];
}

int ffd_bezier_halving(const bezier_box *box, const contraction_bound *found, double *columns)
{
    double spread[3][3][3];
    if (!found->regular)
        return widest(box);
    for (int b = 0; b < 3; b++)
        column_spread(box, b, column_of(box, b, columns), spread[b]);
    return best_halving(box, spread);
}
