#include "spline/refine.h"
#include "base/arithmetic.h"
#include "base/memory/memory.h"
#include "base/text/number.h"
#include "spline/halving.h"
#include "spline/knots.h"
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static size_t knot_count(const knot_row *row)
{
    return row->closed ? row->points + 1 : row->points + (size_t)row->degree + 1;
}

static ffd_status make_row(int degree, size_t points, bool closed, knot_row *row, ffd_error *error)
{
    *row = (knot_row){.degree = degree, .points = points, .closed = closed};
    row->t = ffd_alloc(knot_count(row), sizeof *row->t);
    return row->t ? FFD_OK : ffd_fail_memory(error);
}

static double domain_first(const knot_row *row)
{
    return row->t[row->closed ? 0 : row->degree];
}

static double domain_last(const knot_row *row)
{
    return row->t[row->points];
}

/* Returns breakpoint k of a closed row, k any integer, by distances to the ends of the period as
 * ffd_knots_make. */
static double breakpoint(const knot_row *row, ptrdiff_t k)
{
    const ptrdiff_t n = (ptrdiff_t)row->points;
    const double *const b = row->t;
    if (k < 0)
        return b[0] - (b[n] - breakpoint(row, k + n));
    return k > n ? b[n] + (breakpoint(row, k - n) - b[0]) : b[k];
}

/* Returns knot i; a closed row goes on beyond its ends. */
static double knot_at(const knot_row *row, ptrdiff_t i)
{
    return row->closed ? breakpoint(row, i - row->degree) : row->t[i];
}

/* Returns the number of entries from `first` on that equal it, of `count` in all. */
static size_t run_of(const double *t, size_t first, size_t count)
{
    size_t end = first + 1;
    while (end < count && !(t[end] > t[first]))
        end++;
    return end - first;
}

static int compare_numbers(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Clamps both ends of a row that is not closed: the domain's ends degree + 1 times, the knots beyond them are
 * left out. */
static ffd_status clamp_row(const knot_row *from, knot_row *to, ffd_error *error)
{
    const double first = domain_first(from), last = domain_last(from);
    const size_t d = (size_t)from->degree, count = knot_count(from);
    size_t inner = 0, k = 0;
    for (size_t i = 0; i < count; i++)
        inner += first < from->t[i] && from->t[i] < last;
    TRY(make_row(from->degree, inner + d + 1, false, to, error));
    while (k <= d)
        to->t[k++] = first;
    for (size_t i = 0; i < count; i++)
        if (first < from->t[i] && from->t[i] < last)
            to->t[k++] = from->t[i];
    while (k < knot_count(to))
        to->t[k++] = last;
    return FFD_OK;
}

/* Returns the number of spans that are not empty. */
static size_t count_spans(const knot_row *row)
{
    const size_t count = knot_count(row);
    size_t distinct = 0;
    for (size_t i = 0; i < count; i += run_of(row->t, i, count))
        distinct++;
    return distinct - 1;
}

/* Returns how often the last knot stands at the end. */
static size_t run_at_end(const knot_row *row)
{
    const size_t last = knot_count(row) - 1;
    size_t run = 1;
    while (run <= last && !(row->t[last - run] < row->t[last]))
        run++;
    return run;
}

/* Repeats every distinct knot once more. Of a closed row those of the seam stand at the start, and its end
 * once. */
static ffd_status elevate_row(const knot_row *from, knot_row *to, ffd_error *error)
{
    const size_t count = knot_count(from);
    const size_t seam = from->closed ? run_at_end(from) - 1 : 0; /* copies at the end that go to the start */
    size_t k = 0;
    TRY(make_row(from->degree + 1, from->points + count_spans(from), from->closed, to, error));
    for (size_t i = 0, run; i < count; i += run) {
        run = run_of(from->t, i, count);
        size_t copies = run + 1;
        if (from->closed)
            copies = i == 0 ? run + 1 + seam : i + run == count ? 1 : run + 1;
        while (copies-- > 0)
            to->t[k++] = from->t[i];
    }
    return FFD_OK;
}

/* Brings a knot into the domain of a closed row, [first, last). */
static double wrap(const knot_row *row, double value)
{
    const double first = domain_first(row), period = domain_last(row) - first;
    if (value >= first && value < domain_last(row))
        return value;
    const double wrapped = value - period * floor_of((value - first) / period);
    return wrapped >= first && wrapped < domain_last(row) ? wrapped : first;
}

/* Checks how often each knot of the row stands in it. Those at the end of a period are those at its start. */
static ffd_status check_runs(const knot_row *row, char direction, ffd_error *error)
{
    const double first = domain_first(row), last = domain_last(row);
    const size_t count = knot_count(row);
    for (size_t i = 0, run; i < count; i += run) {
        run = run_of(row->t, i, count);
        const double value = row->t[i];
        const bool is_end = !row->closed && (value <= first || value >= last);
        const size_t allowed = (size_t)row->degree + is_end;
        const size_t times = row->closed && i == 0 ? run + run_at_end(row) - 1 : run;
        if (times > allowed)
            return ffd_fail(error, FFD_E_ARGUMENT,
                            "{insert} %c: the knot %s would be there %zu times; degree %d allows %zu %s",
                            direction, ffd_number_text(value).text, times, row->degree, allowed,
                            is_end ? "at an end of the domain" : "inside it");
    }
    return FFD_OK;
}

static ffd_status insert_knots(const knot_row *from, const refine_wish *wish, char direction, knot_row *to,
                               ffd_error *error)
{
    const size_t count = knot_count(from);
    const double first = domain_first(from), last = domain_last(from);
    TRY(make_row(from->degree, from->points + wish->insert_count, from->closed, to, error));
    memcpy(to->t, from->t, count * sizeof *to->t);
    for (size_t i = 0; i < wish->insert_count; i++) {
        const double value =
            from->closed && isfinite(wish->insert[i]) ? wrap(from, wish->insert[i]) : wish->insert[i];
        if (!(value >= first && value <= last))
            return ffd_fail(error, FFD_E_ARGUMENT,
                            "{insert} %c: the knot %s is outside of the domain, %s to %s", direction,
                            ffd_number_text(value).text, ffd_number_text(first).text,
                            ffd_number_text(last).text);
        to->t[count + i] = value + 0.0; /* 0 has one sign: which of two came first would depend on qsort */
    }
    qsort(to->t, count + wish->insert_count, sizeof *to->t, compare_numbers);
    return check_runs(to, direction, error);
}

/* Halves the longest spans until there are as many control points. */
static ffd_status halve_spans(const knot_row *from, size_t points, char direction, knot_row *to,
                              ffd_error *error)
{
    const size_t first = from->closed ? 0 : (size_t)from->degree, count = knot_count(from);
    const size_t missing = points - from->points;
    size_t found;
    TRY(make_row(from->degree, points, from->closed, to, error));
    memcpy(to->t, from->t, count * sizeof *to->t);
    TRY(ffd_halve_spans(from->t, first, from->points, missing, to->t + count, &found, error));
    if (found < missing)
        return ffd_fail(error, FFD_E_ARGUMENT, "{size}: the spans along %c cannot be halved so often",
                        direction);
    qsort(to->t, count + missing, sizeof *to->t, compare_numbers);
    return FFD_OK;
}

static ffd_status first_row(const knot_vector *knots, knot_row *row, ffd_error *error)
{
    const bool closed = ffd_knots_closed(knots);
    TRY(make_row(knots->degree, knots->points, closed, row, error));
    for (size_t i = 0; i < knot_count(row); i++)
        row->t[i] = knots->t[i + (closed ? (size_t)knots->degree : 0)] + 0.0;
    return FFD_OK;
}

static bool is_clamped(const knot_row *row)
{
    const size_t d = (size_t)row->degree, n = row->points;
    return row->closed || (row->t[0] >= row->t[d] && row->t[n + d] <= row->t[n]);
}

ffd_status ffd_refine_check_count(size_t points, char direction, size_t most, ffd_error *error)
{
    return points <= most
               ? FFD_OK
               : ffd_fail(error, FFD_E_LIMIT, "{size}: %zu control points along %c are more than %zu", points,
                          direction, most);
}

static ffd_status clamp(refine_plan *plan, ffd_error *error)
{
    if (is_clamped(&plan->rows[plan->count - 1]))
        return FFD_OK;
    plan->count++;
    return clamp_row(&plan->rows[plan->count - 2], &plan->rows[plan->count - 1], error);
}

static ffd_status elevate(const refine_wish *wish, char direction, size_t most, refine_plan *plan,
                          ffd_error *error)
{
    const knot_row *const row = &plan->rows[plan->count - 1];
    TRY(ffd_refine_check_count(row->points + count_spans(row) * (size_t)(wish->degree - row->degree),
                               direction, most, error));
    while (plan->rows[plan->count - 1].degree < wish->degree) {
        plan->count++;
        TRY(elevate_row(&plan->rows[plan->count - 2], &plan->rows[plan->count - 1], error));
    }
    return FFD_OK;
}

static ffd_status check_wish(const knot_row *last, const refine_wish *wish, char direction, size_t most,
                             ffd_error *error)
{
    const size_t points =
        wish->insert_count > SIZE_MAX - last->points ? SIZE_MAX : last->points + wish->insert_count;
    TRY(ffd_refine_check_count(points > wish->points ? points : wish->points, direction, most, error));
    if (wish->points > 0 && wish->points < points)
        return ffd_fail(
            error, FFD_E_ARGUMENT, "{size} %zu along %c is less than the %zu control points that are there%s",
            wish->points, direction, points, points > last->points || wish->degree ? " by then" : "");
    return FFD_OK;
}

ffd_status ffd_refine_plan(const knot_vector *knots, const refine_wish *wish, char direction, size_t most,
                           refine_plan *plan, ffd_error *error)
{
    *plan = (refine_plan){.count = 1};
    ffd_status status;
    if (wish->degree && (wish->degree < knots->degree || wish->degree > MAX_DEGREE))
        TRY_END(ffd_fail(error, FFD_E_ARGUMENT,
                         "{degree} %d along %c is not between the %d that it is and %d%s", wish->degree,
                         direction, knots->degree, MAX_DEGREE, ffd_degree_hint(wish->degree)));
    TRY_END(first_row(knots, &plan->rows[0], error));
    if (wish->clamped || wish->degree > knots->degree)
        TRY_END(clamp(plan, error));
    if (wish->degree > knots->degree)
        TRY_END(elevate(wish, direction, most, plan, error));
    TRY_END(check_wish(&plan->rows[plan->count - 1], wish, direction, most, error));
    if (wish->insert_count > 0) {
        plan->count++;
        TRY_END(
            insert_knots(&plan->rows[plan->count - 2], wish, direction, &plan->rows[plan->count - 1], error));
    }
    if (wish->points > plan->rows[plan->count - 1].points) {
        plan->count++;
        TRY_END(halve_spans(&plan->rows[plan->count - 2], wish->points, direction,
                            &plan->rows[plan->count - 1], error));
    }
end:
    if (status)
        ffd_refine_plan_free(plan);
    return status;
}

void ffd_refine_plan_free(refine_plan *plan)
{
    for (size_t i = 0; i < plan->count; i++)
        ffd_free(plan->rows[i].t);
    *plan = (refine_plan){0};
}

/* The blossom of one piece of a spline: the triangle of de Boor with another argument at each level. */
typedef struct blossom {
    const knot_row *row;
    ptrdiff_t span;                       /* the piece is that of this non-empty span */
    double factor[MAX_DEGREE][MAX_ORDER]; /* of level r and the point of index span - degree + k */
    bool known[MAX_DEGREE][MAX_ORDER];    /* else only points that are not there: the sum is 0 */
} blossom;

/* Whether a function is one of the row's. Those beyond its ends count as 0, exactly: so do their factors. */
static bool has_point(const knot_row *row, ptrdiff_t j)
{
    return row->closed || (j >= 0 && j < (ptrdiff_t)row->points);
}

/* Sets the arguments, in ascending order. The levels take them from the last to the first: other orders,
   though the same in exact arithmetic, lose all digits on graded knots. */
static void set_arguments(blossom *b, const double *arguments)
{
    const int p = b->row->degree;
    for (int r = 1; r <= p; r++)
        for (int k = r; k <= p; k++) {
            const ptrdiff_t j = b->span - p + k;
            bool known = false;
            for (ptrdiff_t from = j - r; from <= j; from++)
                known = known || has_point(b->row, from);
            b->known[r - 1][k] = known;
            if (!known)
                continue;
            const double low = knot_at(b->row, j), high = knot_at(b->row, j + p - r + 1);
            b->factor[r - 1][k] = (arguments[p - r] - low) / (high - low);
        }
}

/* Computes the value for one line of `before` numbers a point. work: degree + 1 times as many. */
static const double *value_of(const blossom *b, const double *line, size_t before, double *work)
{
    const int p = b->row->degree;
    const ptrdiff_t n = (ptrdiff_t)b->row->points;
    for (int k = 0; k <= p; k++) {
        const ptrdiff_t j = b->span - p + k;
        double *const row = work + (size_t)k * before;
        if (has_point(b->row, j))
            memcpy(row, line + (size_t)((j % n + n) % n) * before, before * sizeof *row);
        else
            memset(row, 0, before * sizeof *row);
    }
    for (int r = 1; r <= p; r++)
        for (int k = p; k >= r; k--) {
            const double a = b->factor[r - 1][k];
            double *const row = work + (size_t)k * before;
            const double *const lower = row - before;
            if (b->known[r - 1][k])
                for (size_t c = 0; c < before; c++)
                    row[c] = (1 - a) * lower[c] + a * row[c];
            else
                memset(row, 0, before * sizeof *row);
        }
    return work + (size_t)p * before;
}

/* Returns the span of the whole row, not of its domain alone, that is not empty and has x; *span is that of
   an x that is not larger. */
static void advance_span(const knot_row *row, double x, ptrdiff_t *span)
{
    const ptrdiff_t last = (ptrdiff_t)knot_count(row) - 2;
    while ((row->closed || *span < last) && knot_at(row, *span + 1) <= x)
        ++*span;
    while (!row->closed && *span > 0 && knot_at(row, *span) >= knot_at(row, *span + 1))
        --*span;
}

/* Returns the control point whose arguments are these, in a row; REFINE_NEW if there is none. A knot that
   stands degree + 1 times at an end of the domain gives two points the same arguments: the one that counts
   acts on the piece of `span`. *from: where the search begins, and began for smaller ones. */
static size_t find_copy(const knot_row *row, const double *arguments, ptrdiff_t span, ptrdiff_t *from)
{
    const ptrdiff_t n = (ptrdiff_t)row->points, first = span - row->degree;
    while ((row->closed || *from < n) && knot_at(row, *from + 1) < arguments[0])
        ++*from;
    for (ptrdiff_t j = *from; (row->closed || j < n) && knot_at(row, j + 1) <= arguments[0]; j++) {
        bool equal = has_point(row, j) && j >= first;
        for (int k = 0; k < row->degree && equal; k++)
            equal = !(knot_at(row, j + 1 + k) < arguments[k]) && !(knot_at(row, j + 1 + k) > arguments[k]);
        if (equal)
            return (size_t)((j % n + n) % n);
    }
    return REFINE_NEW;
}

/* The rows of numbers that a point is computed from and into. */
typedef struct refine_lines {
    const double *in;
    double *out, *work;
    size_t before, lines, in_points, out_points;
} refine_lines;

static void copy_point(const refine_lines *of, size_t from, size_t to)
{
    for (size_t l = 0; l < of->lines; l++)
        memcpy(of->out + of->before * (to + of->out_points * l),
               of->in + of->before * (from + of->in_points * l), of->before * sizeof *of->out);
}

/* Adds the blossom's values to the numbers of a point, or sets them. */
static void put_values(const refine_lines *of, const blossom *b, size_t to, bool adds)
{
    for (size_t l = 0; l < of->lines; l++) {
        const double *const value =
            value_of(b, of->in + of->before * of->in_points * l, of->before, of->work);
        double *const out = of->out + of->before * (to + of->out_points * l);
        for (size_t c = 0; c < of->before; c++)
            out[c] = adds ? out[c] + value[c] : value[c];
    }
}

/* f(a_1 .. a_(p+1)) of degree p + 1 is the mean of f of degree p without each of its arguments (Cohen, Lyche
   and Schumaker, 1985). */
static void put_mean(const refine_lines *of, blossom *b, const double *arguments, size_t to)
{
    const int p = b->row->degree;
    for (int left_out = 0; left_out <= p; left_out++) {
        double others[MAX_ORDER];
        for (int k = 0, count = 0; k <= p; k++)
            if (k != left_out)
                others[count++] = arguments[k];
        set_arguments(b, others);
        put_values(of, b, to, left_out > 0);
    }
    for (size_t l = 0; l < of->lines; l++)
        for (size_t c = 0; c < of->before; c++)
            of->out[of->before * (to + of->out_points * l) + c] /= p + 1;
}

ffd_status ffd_refine_points(const knot_row *from, const knot_row *to, const double *in, size_t before,
                             size_t lines, double *out, size_t *copied, ffd_error *error)
{
    refine_lines of = {.in = in,
                       .out = out,
                       .before = before,
                       .lines = lines,
                       .in_points = from->points,
                       .out_points = to->points};
    blossom b = {.row = from, .span = from->closed ? -2 * (ptrdiff_t)from->points : 0};
    ptrdiff_t seen = from->closed ? b.span : 0;
    of.work = ffd_alloc(before, (size_t)(from->degree + 1) * sizeof *of.work);
    if (!of.work)
        return ffd_fail_memory(error);
    for (size_t i = 0; i < to->points; i++) {
        double arguments[MAX_ORDER];
        for (int k = 0; k < to->degree; k++)
            arguments[k] = knot_at(to, (ptrdiff_t)i + 1 + k);
        advance_span(from, knot_at(to, (ptrdiff_t)i), &b.span);
        copied[i] = to->degree == from->degree ? find_copy(from, arguments, b.span, &seen) : REFINE_NEW;
        if (copied[i] != REFINE_NEW) {
            copy_point(&of, copied[i], i);
        } else if (to->degree > from->degree) {
            put_mean(&of, &b, arguments, i);
        } else {
            set_arguments(&b, arguments);
            put_values(&of, &b, i, false);
        }
    }
    ffd_free(of.work);
    return FFD_OK;
}
