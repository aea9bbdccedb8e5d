/* oracle.c - the slow volume: formulas of Piegl & Tiller, The NURBS Book, 2nd ed., 2.2 and 4.2, taken
 * literally. */
#include "oracle.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

long double oracle_first(const oracle_axis *axis)
{
    return axis->closed ? axis->t[0] : axis->t[axis->degree];
}

long double oracle_last(const oracle_axis *axis)
{
    return axis->t[axis->n];
}

long double oracle_knot(const oracle_axis *axis, int i)
{
    if (!axis->closed)
        return axis->t[i];
    long double shift = 0;
    const long double period = axis->t[axis->n] - axis->t[0];
    for (i -= axis->degree; i < 0; i += axis->n)
        shift -= period;
    for (; i >= axis->n; i -= axis->n)
        shift += period;
    return axis->t[i] + shift;
}

long double oracle_greville(const oracle_axis *axis, int i)
{
    long double sum = 0;
    for (int k = 1; k <= axis->degree; k++)
        sum += oracle_knot(axis, i + k);
    return sum / axis->degree;
}

static bool in_span(const oracle_axis *axis, int i, long double u)
{
    const long double left = oracle_knot(axis, i), right = oracle_knot(axis, i + 1);
    const long double end = oracle_last(axis);
    if (u == end)
        return left < right && right == end;
    return left <= u && u < right;
}

long double oracle_basis(const oracle_axis *axis, int i, int d, long double u)
{
    if (d == 0)
        return in_span(axis, i, u) ? 1 : 0;
    const long double a = oracle_knot(axis, i), b = oracle_knot(axis, i + d);
    const long double c = oracle_knot(axis, i + 1), e = oracle_knot(axis, i + d + 1);
    if (u < a || u > e)
        return 0;
    long double sum = 0;
    if (b > a)
        sum += (u - a) / (b - a) * oracle_basis(axis, i, d - 1, u);
    if (e > c)
        sum += (e - u) / (e - c) * oracle_basis(axis, i + 1, d - 1, u);
    return sum;
}

long double oracle_basis_derivative(const oracle_axis *axis, int i, long double u)
{
    const int d = axis->degree;
    const long double left = oracle_knot(axis, i + d) - oracle_knot(axis, i);
    const long double right = oracle_knot(axis, i + d + 1) - oracle_knot(axis, i + 1);
    long double sum = 0;
    if (left > 0)
        sum += d / left * oracle_basis(axis, i, d - 1, u);
    if (right > 0)
        sum -= d / right * oracle_basis(axis, i + 1, d - 1, u);
    return sum;
}

void oracle_factors(const oracle_axis *axis, long double u, long double value[ORACLE_MAX_POINTS],
                    long double derivative[ORACLE_MAX_POINTS])
{
    for (int i = 0; i < axis->n; i++) {
        value[i] = 0;
        if (derivative)
            derivative[i] = 0;
        /* Images beyond the first meet the period only with functions n .. n + degree - 1. */
        for (int image = i; image < (axis->closed ? axis->n + axis->degree : axis->n); image += axis->n) {
            value[i] += oracle_basis(axis, image, axis->degree, u);
            if (derivative)
                derivative[i] += oracle_basis_derivative(axis, image, u);
        }
    }
}

size_t oracle_count(const oracle_volume *volume)
{
    return (size_t)volume->axis[0].n * (size_t)volume->axis[1].n * (size_t)volume->axis[2].n;
}

static long double *allocate(size_t count)
{
    long double *memory = calloc(count, sizeof *memory);
    if (!memory)
        abort();
    return memory;
}

oracle_volume oracle_make(const oracle_axis axis[3], bool rational)
{
    oracle_volume volume = {{axis[0], axis[1], axis[2]}, NULL, NULL};
    const size_t count = oracle_count(&volume);
    volume.points = allocate(3 * count);
    if (rational) {
        volume.weights = allocate(count);
        for (size_t i = 0; i < count; i++)
            volume.weights[i] = 1;
    }
    return volume;
}

oracle_volume oracle_with_points(const oracle_axis axis[3], const double *points, const double *weights)
{
    oracle_volume volume = oracle_make(axis, weights != NULL);
    const size_t count = oracle_count(&volume);
    for (size_t i = 0; i < 3 * count; i++)
        volume.points[i] = points[i];
    for (size_t i = 0; weights && i < count; i++)
        volume.weights[i] = weights[i];
    return volume;
}

void oracle_free(oracle_volume *volume)
{
    free(volume->points);
    free(volume->weights);
    volume->points = volume->weights = NULL;
}

long double oracle_wrap(const oracle_axis *axis, long double u)
{
    const long double first = oracle_first(axis), last = oracle_last(axis);
    if (axis->closed) {
        u -= floorl((u - first) / (last - first)) * (last - first);
        return u >= last || u < first ? first : u;
    }
    return fminl(fmaxl(u, first), last);
}

/* The factors of all control points in three directions. Those outside of first[a] .. last[a] are 0: a sum
   need not visit their control points. */
typedef struct factors {
    long double value[3][ORACLE_MAX_POINTS], derivative[3][ORACLE_MAX_POINTS];
    int first[3], last[3];
} factors;

static void make_factors(const oracle_volume *volume, const long double uvw[3], factors *f)
{
    for (int a = 0; a < 3; a++) {
        const int n = volume->axis[a].n;
        oracle_factors(&volume->axis[a], uvw[a], f->value[a], f->derivative[a]);
        f->first[a] = 0;
        f->last[a] = n - 1;
        while (f->first[a] < n - 1 && f->value[a][f->first[a]] == 0 && f->derivative[a][f->first[a]] == 0)
            f->first[a]++;
        while (f->last[a] > 0 && f->value[a][f->last[a]] == 0 && f->derivative[a][f->last[a]] == 0)
            f->last[a]--;
    }
}

/* Steps i to the next control point that counts. False after the last. */
static bool next_point(const factors *f, int i[3])
{
    for (int a = 0; a < 3; a++) {
        if (++i[a] <= f->last[a])
            return true;
        i[a] = f->first[a];
    }
    return false;
}

static size_t index_of(const oracle_volume *volume, const int i[3])
{
    return (size_t)i[0] +
           (size_t)volume->axis[0].n * ((size_t)i[1] + (size_t)volume->axis[1].n * (size_t)i[2]);
}

/* gradient[0]: N N N; gradient[1+a]: its derivative in direction a. */
static void product(const factors *f, const int i[3], long double gradient[4])
{
    const long double *const n[3] = {f->value[0], f->value[1], f->value[2]};
    gradient[0] = n[0][i[0]] * n[1][i[1]] * n[2][i[2]];
    gradient[1] = f->derivative[0][i[0]] * n[1][i[1]] * n[2][i[2]];
    gradient[2] = n[0][i[0]] * f->derivative[1][i[1]] * n[2][i[2]];
    gradient[3] = n[0][i[0]] * n[1][i[1]] * f->derivative[2][i[2]];
}

static void point_at(const oracle_volume *volume, const factors *f, long double point[3], long double *total)
{
    long double weight_sum = 0, sum[3] = {0, 0, 0};
    int i[3] = {f->first[0], f->first[1], f->first[2]};
    do {
        const size_t at = index_of(volume, i);
        long double n = f->value[0][i[0]] * f->value[1][i[1]] * f->value[2][i[2]];
        if (volume->weights)
            n *= volume->weights[at];
        weight_sum += n;
        for (int a = 0; a < 3; a++)
            sum[a] += n * volume->points[3 * at + (size_t)a];
    } while (next_point(f, i));
    for (int a = 0; a < 3; a++)
        point[a] = sum[a] / weight_sum;
    *total = weight_sum;
}

void oracle_evaluate(const oracle_volume *volume, const long double uvw[3], long double point[3],
                     long double jacobian[9])
{
    factors f;
    long double total;
    make_factors(volume, uvw, &f);
    point_at(volume, &f, point, &total);
    if (!jacobian)
        return;
    /* C_u = sum h N_u (P - C) / W, which is the quotient rule with C moved to the origin. */
    for (int e = 0; e < 9; e++)
        jacobian[e] = 0;
    int i[3] = {f.first[0], f.first[1], f.first[2]};
    do {
        const size_t at = index_of(volume, i);
        long double g[4];
        product(&f, i, g);
        const long double h = volume->weights ? volume->weights[at] : 1;
        for (int r = 0; r < 3; r++)
            for (int c = 0; c < 3; c++)
                jacobian[3 * r + c] += h * g[1 + c] * (volume->points[3 * at + (size_t)r] - point[r]) / total;
    } while (next_point(&f, i));
}

void oracle_magnitude(const oracle_volume *volume, const long double uvw[3], long double point[3],
                      long double jacobian[9])
{
    factors f;
    long double total, centre[3];
    make_factors(volume, uvw, &f);
    point_at(volume, &f, centre, &total);
    for (int a = 0; a < 3; a++)
        point[a] = 0;
    for (int e = 0; e < 9; e++)
        jacobian[e] = 0;
    int i[3] = {f.first[0], f.first[1], f.first[2]};
    do {
        const size_t at = index_of(volume, i);
        long double g[4];
        product(&f, i, g);
        const long double h = volume->weights ? volume->weights[at] : 1;
        for (int r = 0; r < 3; r++) {
            const long double size = fabsl(volume->points[3 * at + (size_t)r]);
            point[r] += h * g[0] * size / total;
            for (int c = 0; c < 3; c++)
                jacobian[3 * r + c] += h * fabsl(g[1 + c]) * (size + fabsl(centre[r])) / total;
        }
    } while (next_point(&f, i));
}

long double oracle_determinant(const long double m[9])
{
    return m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) +
           m[2] * (m[3] * m[7] - m[4] * m[6]);
}

/* Solves m x = b for the k unknowns by elimination with full pivoting. m is k x k in rows of 3. */
static bool eliminate(int k, long double m[3][3], long double b[3], long double x[3])
{
    int order[3] = {0, 1, 2};
    for (int s = 0; s < k; s++) {
        int row = s, column = s;
        for (int r = s; r < k; r++)
            for (int c = s; c < k; c++)
                if (fabsl(m[r][c]) > fabsl(m[row][column])) {
                    row = r;
                    column = c;
                }
        if (m[row][column] == 0 || !isfinite(m[row][column]))
            return false;
        for (int c = 0; c < k; c++) {
            const long double swap = m[s][c];
            m[s][c] = m[row][c];
            m[row][c] = swap;
        }
        const long double swap = b[s];
        b[s] = b[row];
        b[row] = swap;
        for (int r = 0; r < k; r++) {
            const long double entry = m[r][s];
            m[r][s] = m[r][column];
            m[r][column] = entry;
        }
        const int name = order[s];
        order[s] = order[column];
        order[column] = name;
        for (int r = s + 1; r < k; r++) {
            const long double q = m[r][s] / m[s][s];
            for (int c = s; c < k; c++)
                m[r][c] -= q * m[s][c];
            b[r] -= q * b[s];
        }
    }
    long double y[3];
    for (int r = k - 1; r >= 0; r--) {
        y[r] = b[r];
        for (int c = r + 1; c < k; c++)
            y[r] -= m[r][c] * y[c];
        y[r] /= m[r][r];
        x[order[r]] = y[r];
    }
    return true;
}

bool oracle_invert(const long double m[9], long double inverse[9])
{
    for (int c = 0; c < 3; c++) {
        long double a[3][3], b[3] = {c == 0, c == 1, c == 2}, x[3];
        memcpy(a, m, sizeof a);
        if (!eliminate(3, a, b, x))
            return false;
        for (int r = 0; r < 3; r++)
            inverse[3 * r + c] = x[r];
    }
    return true;
}

void oracle_bounds(const oracle_volume *volume, long double lo[3], long double hi[3])
{
    for (int a = 0; a < 3; a++)
        lo[a] = hi[a] = volume->points[a];
    for (size_t i = 0; i < oracle_count(volume); i++)
        for (size_t a = 0; a < 3; a++) {
            lo[a] = fminl(lo[a], volume->points[3 * i + a]);
            hi[a] = fmaxl(hi[a], volume->points[3 * i + a]);
        }
}

/* The scaled problem of oracle_descend: residuals over the extents, parameters over the domain's length. */
typedef struct descent {
    const oracle_volume *volume;
    const long double *p;
    long double extent[3], length[3];
} descent;

static long double norm(const long double v[3])
{
    return sqrtl(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

static long double scaled_residual(const descent *d, const long double uvw[3], long double residual[3],
                                   long double jacobian[9])
{
    long double point[3];
    oracle_evaluate(d->volume, uvw, point, jacobian);
    for (int r = 0; r < 3; r++) {
        residual[r] = (d->p[r] - point[r]) / d->extent[r];
        for (int c = 0; jacobian && c < 3; c++)
            jacobian[3 * r + c] *= d->length[c] / d->extent[r];
    }
    return norm(residual);
}

/* The Gauss-Newton step in the coordinates that are free: those at a bound which the slope presses against it
   are held. 3 free ones: the linear system itself; fewer: its normal equations. */
static bool step_within(const descent *d, const long double uvw[3], const long double residual[3],
                        const long double jacobian[9], long double step[3])
{
    int free_axis[3], k = 0;
    for (int c = 0; c < 3; c++) {
        const oracle_axis *axis = &d->volume->axis[c];
        long double slope = 0;
        for (int r = 0; r < 3; r++)
            slope += jacobian[3 * r + c] * residual[r];
        const bool held = !axis->closed && ((uvw[c] <= oracle_first(axis) && slope <= 0) ||
                                            (uvw[c] >= oracle_last(axis) && slope >= 0));
        step[c] = 0;
        if (!held)
            free_axis[k++] = c;
    }
    long double m[3][3], b[3], x[3];
    for (int i = 0; i < k; i++) {
        b[i] = k == 3 ? residual[i] : 0;
        for (int r = 0; k < 3 && r < 3; r++)
            b[i] += jacobian[3 * r + free_axis[i]] * residual[r];
        for (int j = 0; j < k; j++) {
            m[i][j] = k == 3 ? jacobian[3 * i + j] : 0;
            for (int r = 0; k < 3 && r < 3; r++)
                m[i][j] += jacobian[3 * r + free_axis[i]] * jacobian[3 * r + free_axis[j]];
        }
    }
    if (k == 0 || !eliminate(k, m, b, x))
        return false;
    for (int i = 0; i < k; i++)
        step[free_axis[i]] = x[i];
    return true;
}

/* Halves the step until the residual falls; takes the gradient's direction where Gauss-Newton has none. */
static bool improve(const descent *d, long double uvw[3], long double *size, const long double residual[3],
                    const long double jacobian[9])
{
    for (int method = 0; method < 2; method++) {
        long double step[3];
        if (method == 0 && !step_within(d, uvw, residual, jacobian, step))
            continue;
        for (int c = 0; method == 1 && c < 3; c++) {
            step[c] = 0;
            for (int r = 0; r < 3; r++)
                step[c] += jacobian[3 * r + c] * residual[r];
        }
        long double factor = 1;
        for (int c = 0; c < 3; c++)
            if (fabsl(step[c]) * factor > 0.5L)
                factor = 0.5L / fabsl(step[c]);
        for (int k = 0; k < 24; k++, factor /= 2) {
            long double trial[3], rest[3];
            for (int c = 0; c < 3; c++)
                trial[c] = oracle_wrap(&d->volume->axis[c], uvw[c] + factor * step[c] * d->length[c]);
            const long double next = scaled_residual(d, trial, rest, NULL);
            if (next < *size) {
                memcpy(uvw, trial, sizeof trial);
                *size = next;
                return true;
            }
        }
    }
    return false;
}

long double oracle_descend(const oracle_volume *volume, const long double p[3], long double uvw[3])
{
    descent d = {.volume = volume, .p = p};
    long double lo[3], hi[3], residual[3], jacobian[9];
    oracle_bounds(volume, lo, hi);
    for (int a = 0; a < 3; a++) {
        d.extent[a] = hi[a] - lo[a];
        d.length[a] = oracle_last(&volume->axis[a]) - oracle_first(&volume->axis[a]);
        uvw[a] = oracle_wrap(&volume->axis[a], uvw[a]);
    }
    for (int k = 0; k < 60; k++) {
        long double size = scaled_residual(&d, uvw, residual, jacobian);
        const long double before = size;
        if (size == 0 || !improve(&d, uvw, &size, residual, jacobian))
            break;
        if (size > before / 2 && size < 1e-17L)
            break;
    }
    scaled_residual(&d, uvw, residual, NULL);
    return fmaxl(fabsl(residual[0]), fmaxl(fabsl(residual[1]), fabsl(residual[2])));
}

/* The search for all roots. */
typedef struct search {
    const oracle_volume *volume;
    const long double *p;
    oracle_volume shifted; /* its zeros are the roots, and it is no rational one */
    long double extent[3], accept;
    long double (*roots)[3];
    int count;
} search;

long double oracle_distance(const oracle_axis *axis, long double a, long double b)
{
    const long double difference = fabsl(a - b);
    if (!axis->closed)
        return difference;
    const long double period = oracle_last(axis) - oracle_first(axis);
    return fminl(difference, fabsl(period - difference));
}

static void keep_root(search *s, const long double uvw[3])
{
    for (int i = 0; i < s->count; i++) {
        bool same = true;
        for (int a = 0; a < 3; a++) {
            const oracle_axis *axis = &s->volume->axis[a];
            const long double length = oracle_last(axis) - oracle_first(axis);
            same = same && oracle_distance(axis, s->roots[i][a], uvw[a]) <= 1e-7L * length;
        }
        if (same)
            return;
    }
    if (s->count < ORACLE_MAX_ROOTS)
        memcpy(s->roots[s->count++], uvw, 3 * sizeof uvw[0]);
}

static int point_index(const oracle_axis *axis, int function)
{
    return axis->closed ? function % axis->n : function;
}

/* bound[3*r+c] >= |dF_r/du_c| over the cell of these spans: the derivative's own control points (P&T 3.3). */
static void derivative_bounds(const oracle_volume *f, const int span[3], long double bound[9])
{
    for (int c = 0; c < 3; c++) {
        const oracle_axis *axis = &f->axis[c];
        int step[3] = {0, 0, 0}, i[3];
        step[c] = 1;
        for (int r = 0; r < 3; r++)
            bound[3 * r + c] = 0;
        for (i[2] = span[2]; i[2] <= span[2] + f->axis[2].degree - step[2]; i[2]++)
            for (i[1] = span[1]; i[1] <= span[1] + f->axis[1].degree - step[1]; i[1]++)
                for (i[0] = span[0]; i[0] <= span[0] + f->axis[0].degree - step[0]; i[0]++) {
                    size_t at[2];
                    for (int side = 0; side < 2; side++) {
                        const size_t x = (size_t)point_index(&f->axis[0], i[0] + side * step[0]);
                        const size_t y = (size_t)point_index(&f->axis[1], i[1] + side * step[1]);
                        const size_t z = (size_t)point_index(&f->axis[2], i[2] + side * step[2]);
                        at[side] = x + (size_t)f->axis[0].n * (y + (size_t)f->axis[1].n * z);
                    }
                    const long double gap =
                        oracle_knot(axis, i[c] + axis->degree + 1) - oracle_knot(axis, i[c] + 1);
                    for (size_t r = 0; r < 3; r++) {
                        const long double slope =
                            axis->degree * fabsl(f->points[3 * at[1] + r] - f->points[3 * at[0] + r]) / gap;
                        bound[3 * r + (size_t)c] = fmaxl(bound[3 * r + (size_t)c], slope);
                    }
                }
    }
}

/* lo, hi: the box. Excludes it when F cannot reach 0 from its value at the centre, halves it, or starts a
 * descent. */
static void search_box(search *s, const long double bound[9], const long double lo[3],
                       const long double hi[3], int depth)
{
    long double centre[3], value[3], reach[3] = {0, 0, 0};
    for (int a = 0; a < 3; a++)
        centre[a] = (lo[a] + hi[a]) / 2;
    oracle_evaluate(&s->shifted, centre, value, NULL);
    for (int r = 0; r < 3; r++) {
        for (int c = 0; c < 3; c++)
            reach[r] += bound[3 * r + c] * (hi[c] - lo[c]) / 2;
        if (fabsl(value[r]) > reach[r] * (1 + 1e-9L) + 1e-9L * s->extent[r])
            return;
    }
    if (depth == 0) {
        if (oracle_descend(s->volume, s->p, centre) <= s->accept)
            keep_root(s, centre);
        return;
    }
    /* The direction that reaches farthest, measured against the extents. */
    int widest = 0;
    long double most = -1;
    for (int c = 0; c < 3; c++) {
        long double far = 0;
        for (int r = 0; r < 3; r++)
            far += bound[3 * r + c] * (hi[c] - lo[c]) / s->extent[r];
        if (far > most) {
            most = far;
            widest = c;
        }
    }
    for (int half = 0; half < 2; half++) {
        long double a[3], b[3];
        memcpy(a, lo, sizeof a);
        memcpy(b, hi, sizeof b);
        (half ? a : b)[widest] = centre[widest];
        search_box(s, bound, a, b, depth - 1);
    }
}

static void search_cells(search *s)
{
    const oracle_axis *axis = s->volume->axis;
    int i[3];
    /* The span whose first function is i runs from t_{i+degree} to t_{i+degree+1}. */
    for (i[2] = 0; i[2] < axis[2].n - (axis[2].closed ? 0 : axis[2].degree); i[2]++)
        for (i[1] = 0; i[1] < axis[1].n - (axis[1].closed ? 0 : axis[1].degree); i[1]++)
            for (i[0] = 0; i[0] < axis[0].n - (axis[0].closed ? 0 : axis[0].degree); i[0]++) {
                long double lo[3], hi[3], bound[9];
                bool empty = false;
                for (int a = 0; a < 3; a++) {
                    lo[a] = oracle_knot(&axis[a], i[a] + axis[a].degree);
                    hi[a] = oracle_knot(&axis[a], i[a] + axis[a].degree + 1);
                    empty = empty || !(lo[a] < hi[a]);
                }
                if (empty)
                    continue;
                derivative_bounds(&s->shifted, i, bound);
                search_box(s, bound, lo, hi, 10);
            }
}

static int compare_roots(const void *a, const void *b)
{
    const long double *x = a, *y = b;
    for (int i = 0; i < 3; i++)
        if (x[i] != y[i])
            return x[i] < y[i] ? -1 : 1;
    return 0;
}

/* Coefficients h (P - p), seen in the frame of the derivative at the middle of the domain: so that boxes of
   thin and oblique lattices are excluded as soon as those of others. */
static oracle_volume shifted_volume(const oracle_volume *volume, const long double p[3])
{
    oracle_volume shifted = oracle_make(volume->axis, false);
    long double middle[3], point[3], jacobian[9], frame[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    for (int a = 0; a < 3; a++)
        middle[a] = (oracle_first(&volume->axis[a]) + oracle_last(&volume->axis[a])) / 2;
    oracle_evaluate(volume, middle, point, jacobian);
    if (!oracle_invert(jacobian, frame))
        memcpy(frame, (long double[9]){1, 0, 0, 0, 1, 0, 0, 0, 1}, sizeof frame);
    for (size_t i = 0; i < oracle_count(volume); i++)
        for (size_t a = 0; a < 3; a++)
            for (size_t b = 0; b < 3; b++)
                shifted.points[3 * i + a] += frame[3 * a + b] * (volume->weights ? volume->weights[i] : 1) *
                                             (volume->points[3 * i + b] - p[b]);
    return shifted;
}

int oracle_find_all(const oracle_volume *volume, const long double p[3], long double accept,
                    long double roots[ORACLE_MAX_ROOTS][3])
{
    search s = {.volume = volume, .p = p, .accept = accept, .roots = roots};
    long double lo[3], hi[3];
    s.shifted = shifted_volume(volume, p);
    oracle_bounds(&s.shifted, lo, hi);
    for (int a = 0; a < 3; a++)
        s.extent[a] = hi[a] - lo[a];
    search_cells(&s);
    qsort(roots, (size_t)s.count, sizeof roots[0], compare_roots);
    oracle_free(&s.shifted);
    return s.count;
}
