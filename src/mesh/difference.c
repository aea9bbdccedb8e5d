#include "mesh/difference.h"
#include "base/text/number.h"
#include <ffd/program.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

const char *ffd_difference_kind_name(ffd_difference_kind kind)
{
    static const char *const names[FFD_DIFFERENCE_KIND_COUNT] = {"position", "normal",   "tangent",
                                                                 "texcoord", "topology", "other"};
    return (unsigned)kind < FFD_DIFFERENCE_KIND_COUNT ? names[kind] : NULL;
}

void ffd_difference_begin(ffd_comparison *comparison, double tolerance, double direction_tolerance)
{
    *comparison = (ffd_comparison){
        .equal = true, .complete = true, .tolerance = tolerance, .direction_tolerance = direction_tolerance};
}

/* Counts a difference. Returns whether it is the first one, whose text is needed. */
static bool count(ffd_comparison *comparison, ffd_difference_kind kind)
{
    comparison->equal = false;
    comparison->counts[kind]++;
    return comparison->differences++ == 0;
}

void ffd_difference_add_text(ffd_comparison *comparison, ffd_difference_kind kind, const char *format, ...)
{
    ffd_difference *first = &comparison->first;
    va_list arguments;
    if (!count(comparison, kind))
        return;
    first->kind = kind;
    va_start(arguments, format);
    vsnprintf(first->text, sizeof first->text, format, arguments);
    va_end(arguments);
    ffd_make_one_line(first->text, strlen(first->text));
}

double ffd_difference_of(double a, double b)
{
    if (isnan(a) || isnan(b))
        return isnan(a) && isnan(b) ? 0 : INFINITY;
    return a < b || a > b ? fabs(a - b) : 0;
}

static void describe(ffd_difference *difference, int axis, difference_label *label, const void *context)
{
    static const char *const subjects[] = {"", " of the normal", " of the tangent"};
    const char *subject = subjects[difference->kind];
    char where[320];
    label(context, where, sizeof where);
    if (isfinite(difference->amount))
        snprintf(difference->text, sizeof difference->text, "%s: %c%s differs by %s", where, "xyzw"[axis],
                 subject, ffd_number_text(difference->amount).text);
    else
        snprintf(difference->text, sizeof difference->text, "%s: %c%s: %s and %s", where, "xyzw"[axis],
                 subject, ffd_number_text(difference->a).text, ffd_number_text(difference->b).text);
    ffd_make_one_line(difference->text, strlen(difference->text));
}

static bool is_worse(const ffd_difference *worst, ffd_difference_kind kind, double amount)
{
    return !worst->measured || kind < worst->kind || (kind == worst->kind && amount > worst->amount);
}

void ffd_difference_vector(ffd_comparison *comparison, ffd_difference_kind kind, int components,
                           const double *a, const double *b, difference_label *label, const void *context)
{
    const bool is_position = kind == FFD_DIFFERENCE_POSITION;
    double *largest =
        is_position ? &comparison->position_difference_max : &comparison->direction_difference_max;
    ffd_difference found = {.kind = kind, .measured = true};
    int axis = 0;
    for (int i = 0; i < components; i++) {
        const double amount = ffd_difference_of(a[i], b[i]);
        if (amount > found.amount) {
            found.amount = amount;
            axis = i;
        }
    }
    if (found.amount > *largest)
        *largest = found.amount;
    if (found.amount <= (is_position ? comparison->tolerance : comparison->direction_tolerance))
        return;
    const bool is_first = count(comparison, kind);
    if (!is_first && !is_worse(&comparison->worst, kind, found.amount))
        return;
    found.a = a[axis];
    found.b = b[axis];
    describe(&found, axis, label, context);
    if (is_first)
        comparison->first = found;
    if (is_worse(&comparison->worst, kind, found.amount))
        comparison->worst = found;
}
