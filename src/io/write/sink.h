/* sink.h - the output of a writer: text, numbers and bytes, to the file begun last. The first failure is kept
   and nothing is written after it. */
#ifndef FFD_IO_WRITE_SINK_H
#define FFD_IO_WRITE_SINK_H

#include "base/file/output.h"
#include <stdint.h>

typedef struct model_sink {
    file_output *output;
    ffd_error *error;
    ffd_status status;
} model_sink;

/* Each appends to the output. After a failure, which sink holds, they do nothing. */

/* Appends size bytes. */
void ffd_sink_bytes(model_sink *sink, const void *bytes, size_t size);
/* Appends a string. */
void ffd_sink_text(model_sink *sink, const char *text);
/* Appends a whole number in decimal digits. */
void ffd_sink_count(model_sink *sink, uint64_t count);
/* The shortest text of each number, with a blank before it. */
void ffd_sink_numbers(model_sink *sink, const double *numbers, size_t count);
/* A whole number of 32 bits, little endian. */
void ffd_sink_u32(model_sink *sink, uint32_t value);
/* The nearest float, little endian. */
void ffd_sink_float(model_sink *sink, double value);
/* A double, little endian. */
void ffd_sink_double(model_sink *sink, double value);

#endif
