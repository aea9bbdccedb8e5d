#include "io/difference.h"
#include "base/number.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>

void ffd_difference_say(ffd_comparison *comparison, const char *format, ...)
{
    char *text = comparison->difference;
    va_list arguments;
    if (text[0])
        return;
    va_start(arguments, format);
    vsnprintf(text, sizeof comparison->difference, format, arguments);
    va_end(arguments);
    for (; *text; text++)
        if ((unsigned char)*text < 0x20 || *text == 0x7f)
            *text = '?';
}

double ffd_difference_of(double a, double b)
{
    if (isnan(a) || isnan(b))
        return isnan(a) && isnan(b) ? 0 : INFINITY;
    return a < b || a > b ? fabs(a - b) : 0;
}

bool ffd_difference_coordinate(ffd_comparison *comparison, const char *place, int axis, double a, double b,
                               double tolerance)
{
    const double difference = ffd_difference_of(a, b);
    if (difference > comparison->position_difference_max)
        comparison->position_difference_max = difference;
    if (difference <= tolerance)
        return true;
    if (isfinite(difference))
        ffd_difference_say(comparison, "%s: %c differs by %s", place, "xyz"[axis],
                           ffd_number_text(difference).text);
    else
        ffd_difference_say(comparison, "%s: %c: %s and %s", place, "xyz"[axis], ffd_number_text(a).text,
                           ffd_number_text(b).text);
    return false;
}
