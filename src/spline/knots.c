#include "spline/knots.h"
#include "base/arithmetic.h"
#include "base/lower_bound.h"
#include "base/memory/memory.h"
#include "base/text/number.h"
#include "base/text/words.h"
#include "spline/bezier.h"
#include <limits.h>
#include <math.h>
#include <string.h>

/* What the checks need. `given` are the caller's knots or breakpoints, not the extended vector. */
typedef struct knot_list {
    const double *given;
    size_t count;
    int degree;
    bool closed;
    char direction;
    ffd_error *error;
} knot_list;

static const char *word_of(const knot_list *list)
{
    return list->closed ? "breakpoint" : "knot";
}

const char *ffd_degree_hint(double degree)
{
    if (degree == 0)
        return ": degree 1 between two layers that move alike does the same";
    return degree > MAX_DEGREE ? ": as many control points of a lower degree each move a smaller part" : "";
}

static ffd_status check_shape(int degree, size_t points, char direction, ffd_error *error)
{
    if (degree < 1 || degree > MAX_DEGREE)
        return ffd_fail(error, FFD_E_INVALID, "direction %c: degree %d is not between 1 and %d%s", direction,
                        degree, MAX_DEGREE, ffd_degree_hint(degree));
    if (points < (size_t)degree + 1)
        return ffd_fail(error, FFD_E_INVALID,
                        "direction %c: %zu control points, but degree %d needs at least %d", direction,
                        points, degree, degree + 1);
    /* Indices of spans are int, and a closed vector has points + 2 degree + 1 knots. */
    if (points > (size_t)INT_MAX - 2 * MAX_ORDER)
        return ffd_fail(error, FFD_E_LIMIT, "direction %c: %zu control points are too many", direction,
                        points);
    return FFD_OK;
}

static ffd_status check_count(const knot_list *list, size_t points)
{
    const size_t needed = list->closed ? points + 1 : points + (size_t)list->degree + 1;
    if (list->count == needed)
        return FFD_OK;
    if (list->closed)
        return ffd_fail(list->error, FFD_E_INVALID,
                        "direction %c: %zu %s, but %zu control points need %zu in one period",
                        list->direction, list->count, ffd_plural(list->count, "breakpoint", "breakpoints"),
                        points, needed);
    return ffd_fail(list->error, FFD_E_INVALID,
                    "direction %c: %zu %s, but %zu control points of degree %d need %zu", list->direction,
                    list->count, ffd_plural(list->count, "knot", "knots"), points, list->degree, needed);
}

static ffd_status check_order(const knot_list *list)
{
    const double *const t = list->given;
    for (size_t i = 0; i < list->count; i++) {
        if (!isfinite(t[i]))
            return ffd_fail(list->error, FFD_E_INVALID, "direction %c: %s %zu is %s, not a finite number",
                            list->direction, word_of(list), i, ffd_number_text(t[i]).text);
        if (i > 0 && t[i] < t[i - 1])
            return ffd_fail(list->error, FFD_E_INVALID, "direction %c: %s %zu is %s, less than %s %zu, %s",
                            list->direction, word_of(list), i, ffd_number_text(t[i]).text, word_of(list),
                            i - 1, ffd_number_text(t[i - 1]).text);
    }
    return FFD_OK;
}

static ffd_status check_domain(const knot_list *list)
{
    const size_t first = list->closed ? 0 : (size_t)list->degree;
    const size_t last = list->count - 1 - first;
    if (list->given[first] < list->given[last])
        return FFD_OK;
    return ffd_fail(list->error, FFD_E_INVALID,
                    "direction %c: the domain is empty, %s %zu and %s %zu are both %s", list->direction,
                    word_of(list), first, word_of(list), last, ffd_number_text(list->given[first]).text);
}

/* Returns the index after the last entry that equals entry first. */
static size_t run_end(const knot_list *list, size_t first)
{
    size_t end = first + 1;
    while (end < list->count && !(list->given[end] > list->given[first]))
        end++;
    return end;
}

/* Both ends of a period are the same point of the curve, so their multiplicities add up, less the breakpoint
   that they share. */
static ffd_status check_seam(const knot_list *list, size_t at_start, size_t at_end)
{
    const size_t multiplicity = at_start + at_end - 1;
    if (multiplicity <= (size_t)list->degree)
        return FFD_OK;
    return ffd_fail(
        list->error, FFD_E_INVALID,
        "direction %c: the breakpoints at the seam, %s and %s, meet there %zu times, but degree %d "
        "allows %d",
        list->direction, ffd_number_text(list->given[0]).text,
        ffd_number_text(list->given[list->count - 1]).text, multiplicity, list->degree, list->degree);
}

/* A multiplicity above d tears the volume at an inner knot; above d + 1 at an end it leaves a control point
   without effect. */
static ffd_status check_run(const knot_list *list, size_t first, size_t end)
{
    const double *const t = list->given;
    const size_t degree = (size_t)list->degree;
    const double value = t[first];
    const bool inside = list->closed || (t[degree] < value && value < t[list->count - 1 - degree]);
    const size_t allowed = inside ? degree : degree + 1;
    if (end - first <= allowed)
        return FFD_OK;
    return ffd_fail(list->error, FFD_E_INVALID,
                    "direction %c: %ss %zu to %zu are all %s, %zu times, but degree %d allows %zu %s",
                    list->direction, word_of(list), first, end - 1, ffd_number_text(value).text, end - first,
                    list->degree, allowed, inside ? "inside the domain" : "at an end of the domain");
}

static ffd_status check_multiplicity(const knot_list *list)
{
    const size_t start_run = run_end(list, 0);
    for (size_t first = 0, end; first < list->count; first = end) {
        end = run_end(list, first);
        const bool at_seam = list->closed && (first == 0 || end == list->count);
        TRY(at_seam ? FFD_OK : check_run(list, first, end));
        if (list->closed && end == list->count)
            return check_seam(list, start_run, end - first);
    }
    return FFD_OK;
}

static ffd_status check_list(const knot_list *list, size_t points)
{
    TRY(check_count(list, points));
    TRY(check_order(list));
    TRY(check_domain(list));
    return check_multiplicity(list);
}

/* Refuses knots for which d times the range, or d divided by the width of a span, overflows. */
static ffd_status check_widths(const knot_vector *knots, char direction, ffd_error *error)
{
    const double *const t = knots->t;
    const int d = knots->degree;
    const size_t last = knots->functions + (size_t)d;
    const bool closed = ffd_knots_closed(knots);
    const char *const word = closed ? "breakpoints" : "knots";
    if (!isfinite(d * (t[last] - t[0])))
        return ffd_fail(error, FFD_E_INVALID,
                        "direction %c: the %s reach from %s to %s, too far to compute with", direction, word,
                        ffd_number_text(t[closed ? d : 0]).text,
                        ffd_number_text(t[closed ? knots->functions : last]).text);
    for (size_t i = 0; i < knots->span_count; i++) {
        const int span = knots->spans[i], index = closed ? span - d : span;
        if (!isfinite(d / (t[span + 1] - t[span])))
            return ffd_fail(error, FFD_E_INVALID, "direction %c: %s %d and %d, %s and %s, are too close",
                            direction, word, index, index + 1, ffd_number_text(t[span]).text,
                            ffd_number_text(t[span + 1]).text);
    }
    return FFD_OK;
}

/* Every preset knot is a single division of two exact numbers. So 0 and 1 are exact, equal fractions have
   equal bits, and the ends of the domain are knots exactly. */
static void fill_preset(const knot_vector *knots)
{
    const int d = knots->degree, n = (int)knots->points;
    double *const t = knots->t;
    for (int i = 0; i <= n + d; i++) {
        if (knots->kind == KNOTS_UNIFORM)
            t[i] = (double)i / (n + d);
        else if (knots->kind == KNOTS_OPEN || (d < i && i < n))
            t[i] = (double)(i - d) / (n - d);
        else
            t[i] = i <= d ? 0 : 1;
    }
}

/* t_{i+n} = t_i + T, computed with distances to the ends of the period: so rounding cannot make the knots
   decrease, and repeated breakpoints at one end are repeated at the other. */
static void extend_period(const knot_vector *knots)
{
    const size_t d = (size_t)knots->degree, n = knots->points;
    double *const b = knots->t + d;
    for (size_t m = 1; m <= d; m++) {
        knots->t[d - m] = b[0] - (b[n] - b[n - m]);
        b[n + m] = b[n] + (b[m] - b[0]);
    }
}

static void fill_knots(const knot_vector *knots, const double *list)
{
    double *const breakpoints = knots->t + knots->degree;
    switch (knots->kind) {
    case KNOTS_CLAMPED:
    case KNOTS_OPEN:
    case KNOTS_UNIFORM:
        fill_preset(knots);
        break;
    case KNOTS_LIST:
        memcpy(knots->t, list, (knots->points + (size_t)knots->degree + 1) * sizeof *list);
        break;
    case KNOTS_CLOSED:
        for (size_t i = 0; i <= knots->points; i++)
            breakpoints[i] = (double)i / (double)knots->points;
        extend_period(knots);
        break;
    case KNOTS_CLOSED_LIST:
        memcpy(breakpoints, list, (knots->points + 1) * sizeof *list);
        extend_period(knots);
        break;
    }
}

static void find_spans(knot_vector *knots)
{
    knots->span_count = 0;
    for (size_t s = (size_t)knots->degree; s < knots->functions; s++)
        if (knots->t[s] < knots->t[s + 1])
            knots->spans[knots->span_count++] = (int)s;
}

ffd_status ffd_knots_make(knot_kind kind, int degree, size_t points, const double *list, size_t list_count,
                          char direction, knot_vector *knots, ffd_error *error)
{
    *knots = (knot_vector){.kind = kind, .degree = degree, .points = points};
    ffd_status status;
    TRY_END(check_shape(degree, points, direction, error));
    const bool closed = ffd_knots_closed(knots);
    if (kind == KNOTS_LIST || kind == KNOTS_CLOSED_LIST) {
        const knot_list given = {list, list_count, degree, closed, direction, error};
        TRY_END(check_list(&given, points));
    }
    knots->functions = closed ? points + (size_t)degree : points;
    knots->t = ffd_alloc(knots->functions + (size_t)degree + 1, sizeof *knots->t);
    knots->spans = ffd_alloc(knots->functions - (size_t)degree, sizeof *knots->spans);
    if (!knots->t || !knots->spans)
        TRY_END(ffd_fail_memory(error));
    fill_knots(knots, list);
    find_spans(knots);
    TRY_END(check_widths(knots, direction, error));
    knots->extractions = ffd_bezier_extractions(knots);
    if (!knots->extractions)
        TRY_END(ffd_fail_memory(error));
    ffd_bezier_weigh(knots, knots->extractions);
end:
    if (status)
        ffd_knots_free(knots);
    return status;
}

void ffd_knots_free(knot_vector *knots)
{
    ffd_free(knots->t);
    ffd_free(knots->spans);
    ffd_free(knots->extractions);
    *knots = (knot_vector){0};
}

double ffd_knots_first(const knot_vector *knots)
{
    return knots->t[knots->degree];
}

double ffd_knots_last(const knot_vector *knots)
{
    return knots->t[knots->functions];
}

static double wrap_period(double u, double first, double last)
{
    const double period = last - first;
    double offset = remainder_of(u - first, period); /* exact, with the sign of u - first */
    if (offset < 0)
        offset += period;
    const double wrapped = first + offset;
    return wrapped >= last ? first : wrapped;
}

double ffd_knots_wrap_outside(const knot_vector *knots, double u)
{
    const double first = ffd_knots_first(knots), last = ffd_knots_last(knots);
    if (ffd_knots_closed(knots))
        return wrap_period(u, first, last);
    if (u < first)
        return first;
    return u > last ? last : u;
}

static double span_first(const knot_vector *knots, size_t span)
{
    return knots->t[knots->spans[span]];
}

typedef struct knot_place {
    const double *t;
    double u;
} knot_place;

static bool begins_up_to(const void *span, const void *place)
{
    const knot_place *const p = place;
    return p->u >= p->t[*(const int *)span];
}

size_t ffd_knots_span_index(const knot_vector *knots, double u)
{
    const size_t count = knots->span_count;
    const knot_place place = {knots->t, u};
    /* First guess, as if all spans had the same length; most do. */
    const double first = span_first(knots, 0), last = ffd_knots_last(knots);
    const double guess = (u - first) / (last - first) * (double)count;
    if (guess >= 0 && guess < (double)count) {
        const size_t span = (size_t)guess;
        if (u >= span_first(knots, span) && (span + 1 == count || u < span_first(knots, span + 1)))
            return span;
    }
    return last_up_to(&place, knots->spans, count, sizeof *knots->spans, begins_up_to);
}

int ffd_knots_span(const knot_vector *knots, double u)
{
    return knots->spans[ffd_knots_span_index(knots, u)];
}

double ffd_knots_greville(const knot_vector *knots, size_t function)
{
    /* Computed relative to the first knot, so that equal knots give exactly that knot. */
    const double *const t = knots->t + function + 1;
    double sum = 0;
    for (int j = 1; j < knots->degree; j++)
        sum += t[j] - t[0];
    return t[0] + sum / knots->degree;
}
