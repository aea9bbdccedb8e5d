/* fit_csv.h - the table of pairs of `ffd fit --pairs`. */
#ifndef FFD_JOB_AUTHOR_FIT_CSV_H
#define FFD_JOB_AUTHOR_FIT_CSV_H

#include "base/file/input.h"

/* The pairs of a table, in the order of its rows. All zeros: there are none. */
typedef struct fit_table {
    size_t count;
    double *sources; /* 3 each; NULL: they are vertices */
    size_t *vertices;
    size_t *lines;   /* of the file, from 1 */
    double *targets; /* 3 each */
    double *weights;
    size_t *exact; /* indices of rows */
    size_t exact_count;
} fit_table;

/* Reads comma-separated values (RFC 4180) with a header: x, y, z are the targets, px, py, pz or vertex the
   sources, weight a positive number or "exact". name: for messages. To be freed in every case. Errors:
   FFD_E_INVALID with the line, FFD_E_MEMORY. */
ffd_status ffd_fit_table_read(const file_input *file, const char *name, fit_table *table, ffd_error *error);
/* Frees the arrays and empties it. */
void ffd_fit_table_free(fit_table *table);

#endif
