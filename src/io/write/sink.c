#include "io/write/sink.h"
#include "base/little_endian.h"
#include "base/text/number.h"
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

void ffd_sink_bytes(model_sink *sink, const void *bytes, size_t size)
{
    if (sink->status == FFD_OK)
        sink->status = ffd_output_write(sink->output, bytes, size, sink->error);
}

void ffd_sink_text(model_sink *sink, const char *text)
{
    ffd_sink_bytes(sink, text, strlen(text));
}

void ffd_sink_count(model_sink *sink, uint64_t count)
{
    char text[24];
    const int size = snprintf(text, sizeof text, "%" PRIu64, count);
    ffd_sink_bytes(sink, text, (size_t)size);
}

void ffd_sink_numbers(model_sink *sink, const double *numbers, size_t count)
{
    char text[1 + FFD_NUMBER_CAPACITY] = " ";
    for (size_t i = 0; i < count; i++)
        ffd_sink_bytes(sink, text, 1 + ffd_number_format(numbers[i], text + 1));
}

void ffd_sink_u32(model_sink *sink, uint32_t value)
{
    unsigned char bytes[4];
    store_u32(bytes, value);
    ffd_sink_bytes(sink, bytes, sizeof bytes);
}

void ffd_sink_float(model_sink *sink, double value)
{
    unsigned char bytes[4];
    store_float(bytes, (float)value);
    ffd_sink_bytes(sink, bytes, sizeof bytes);
}

void ffd_sink_double(model_sink *sink, double value)
{
    unsigned char bytes[8];
    store_double(bytes, value);
    ffd_sink_bytes(sink, bytes, sizeof bytes);
}
