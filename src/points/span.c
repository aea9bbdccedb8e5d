#include "points/span.h"
#include <stdint.h>
#include <string.h>

static size_t size_of(ffd_number type)
{
    return type == FFD_FLOAT32 ? sizeof(float) : sizeof(double);
}

ffd_status ffd_span_check(ffd_span *span, size_t count, const char *what, ffd_error *error)
{
    if (span->type != FFD_FLOAT32 && span->type != FFD_FLOAT64)
        return ffd_fail(error, FFD_E_ARGUMENT, "%s: %d is not a type of numbers", what, (int)span->type);
    if (span->count != count)
        return ffd_fail(error, FFD_E_ARGUMENT, "%s has %zu points, not %zu", what, span->count, count);
    if (!span->data && count > 0)
        return ffd_fail(error, FFD_E_ARGUMENT, "%s has no data", what);
    if (span->step == 0)
        span->step = (ptrdiff_t)size_of(span->type);
    if (span->stride == 0)
        span->stride = 3 * (ptrdiff_t)size_of(span->type);
    return FFD_OK;
}

static char *address(const ffd_span *span, size_t point)
{
    return (char *)span->data + (ptrdiff_t)point * span->stride;
}

static bool is_packed(const ffd_span *span)
{
    const ptrdiff_t size = (ptrdiff_t)size_of(span->type);
    return span->step == size && span->stride == 3 * size;
}

/* Numbers may be unaligned. */
static double read_number(const char *from, ffd_number type)
{
    double wide;
    float narrow;
    if (type == FFD_FLOAT64) {
        memcpy(&wide, from, sizeof wide);
        return wide;
    }
    memcpy(&narrow, from, sizeof narrow);
    return narrow;
}

static void write_number(char *to, ffd_number type, double number)
{
    const float narrow = (float)number;
    if (type == FFD_FLOAT64)
        memcpy(to, &number, sizeof number);
    else
        memcpy(to, &narrow, sizeof narrow);
}

static void read_floats(const char *from, size_t count, double *to)
{
    for (size_t i = 0; i < count; i++)
        to[i] = read_number(from + i * sizeof(float), FFD_FLOAT32);
}

static void write_floats(const double *from, size_t count, char *to)
{
    for (size_t i = 0; i < count; i++)
        write_number(to + i * sizeof(float), FFD_FLOAT32, from[i]);
}

void ffd_span_read(const ffd_span *span, size_t first, size_t count, double *xyz)
{
    const char *from = address(span, first);
    if (is_packed(span) && span->type == FFD_FLOAT64)
        memcpy(xyz, from, 3 * count * sizeof *xyz);
    else if (is_packed(span))
        read_floats(from, 3 * count, xyz);
    else
        for (size_t i = 0; i < count; i++, from += span->stride)
            for (int c = 0; c < 3; c++)
                xyz[3 * i + (size_t)c] = read_number(from + c * span->step, span->type);
}

void ffd_span_write(const ffd_span *span, size_t first, size_t count, const double *xyz)
{
    char *to = address(span, first);
    if (is_packed(span) && span->type == FFD_FLOAT64)
        memcpy(to, xyz, 3 * count * sizeof *xyz);
    else if (is_packed(span))
        write_floats(xyz, 3 * count, to);
    else
        for (size_t i = 0; i < count; i++, to += span->stride)
            for (int c = 0; c < 3; c++)
                write_number(to + c * span->step, span->type, xyz[3 * i + (size_t)c]);
}

double *ffd_span_doubles(const ffd_span *span, size_t first)
{
    void *const from = address(span, first);
    const bool are_doubles = is_packed(span) && span->type == FFD_FLOAT64;
    return are_doubles && (uintptr_t)from % _Alignof(double) == 0 ? from : NULL;
}

float *ffd_span_floats(const ffd_span *span, size_t first)
{
    void *const from = address(span, first);
    const bool are_floats = is_packed(span) && span->type == FFD_FLOAT32;
    return are_floats && (uintptr_t)from % _Alignof(float) == 0 ? from : NULL;
}

void ffd_span_copy(const ffd_span *from, const ffd_span *to, size_t point)
{
    const char *const source = address(from, point);
    char *const target = address(to, point);
    for (int c = 0; c < 3; c++)
        memmove(target + c * to->step, source + c * from->step, size_of(from->type));
}
