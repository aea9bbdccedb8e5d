/* sink.h - the output of a writer: appends text, numbers and bytes to the file begun last. The first failure
   is kept, and nothing is written after it. */
#ifndef FFD_IO_WRITE_SINK_H
#define FFD_IO_WRITE_SINK_H

#include "base/file/output.h"
#include <stdint.h>

typedef struct model_sink {
    file_output *output;
    ffd_error *error;
    ffd_status status;
} model_sink;

/* These append to the output. After a failure, which is in sink, they do nothing. */

/* Appends size bytes. */
void ffd_sink_bytes(model_sink *sink, const void *bytes, size_t size);
/* Appends a string. */
void ffd_sink_text(model_sink *sink, const char *text);
/* Appends a whole number in decimal digits. */
void ffd_sink_count(model_sink *sink, uint64_t count);
/* Appends the shortest text of each number, preceded by a blank. */
void ffd_sink_numbers(model_sink *sink, const double *numbers, size_t count);
/* Appends a 32-bit integer, little-endian. */
void ffd_sink_u32(model_sink *sink, uint32_t value);
/* Appends the nearest float, little-endian. */
void ffd_sink_float(model_sink *sink, double value);
/* Appends a double, little-endian. */
void ffd_sink_double(model_sink *sink, double value);

#endif
