/* job_rows.h - what a row of a table, or a file that a pattern names, says as a job. */
#ifndef FFD_BATCH_MANIFEST_JOB_ROWS_H
#define FFD_BATCH_MANIFEST_JOB_ROWS_H

#include "batch/manifest/csv.h"
#include "batch/manifest/job_description.h"
#include <stdint.h>

/* What the command line says for all jobs. */
typedef struct job_commons {
    const char *folder;          /* of the table; "" for the current one */
    const char *out_dir;         /* of outputs; or NULL */
    const char *input;           /* of rows that have none; or NULL */
    const char *const *lattices; /* of jobs that have none */
    size_t lattice_count;
    const char *const *morphs; /* lattice_count names of the morph targets that they make; or NULL */
    const char *ignored;       /* columns "a,b" that are left out; or NULL */
    bool decimal_comma;        /* numbers may have one */
} job_commons;

/* A number in a row that JSON writes otherwise. All zeros: there is none. */
typedef struct csv_flaw {
    char cell[48], number[64]; /* the first one, as it is and as it is read */
} csv_flaw;

/* Whether a column is left out. */
bool ffd_column_is_ignored(const char *ignored, const char *column);
/* Describes a row, whose cells are UTF-8 and as many as the columns. number: of the row, for the name of an
   output that has none (0: the input's name does). */
void ffd_describe_row(const job_commons *commons, const csv_row *columns, const csv_row *row, uint64_t number,
                      job_description *job, csv_flaw *flaw);
/* Describes a job for a file. */
void ffd_describe_file(const job_commons *commons, const char *path, job_description *job);

#endif
