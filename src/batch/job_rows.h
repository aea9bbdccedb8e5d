/* job_rows.h - what a row of a table, or a file that a pattern names, says as a job. */
#ifndef FFD_BATCH_JOB_ROWS_H
#define FFD_BATCH_JOB_ROWS_H

#include "batch/csv.h"
#include "batch/job_description.h"

/* What the command line says for all jobs. */
typedef struct job_commons {
    const char *folder;          /* of the table; "" for the current one */
    const char *out_dir;         /* of outputs; or NULL */
    const char *input;           /* of rows that have none; or NULL */
    const char *const *lattices; /* of jobs that have none */
    size_t lattice_count;
} job_commons;

/* Describes a row, whose cells are UTF-8 and as many as the columns. */
void ffd_describe_row(const job_commons *commons, const csv_row *columns, const csv_row *row,
                      job_description *job);
/* Describes a job for a file. */
void ffd_describe_file(const job_commons *commons, const char *path, job_description *job);

#endif
