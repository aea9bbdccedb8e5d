/* job_rows.h - describes the job of a table row, or of a file that matches a pattern. */
#ifndef FFD_BATCH_MANIFEST_JOB_ROWS_H
#define FFD_BATCH_MANIFEST_JOB_ROWS_H

#include "batch/manifest/job_description.h"
#include "io/csv/csv.h"
#include <ffd/job.h>
#include <stdint.h>

/* Values from the command line, for all jobs. */
typedef struct job_commons {
    const char *folder;              /* of the table; "": the current one */
    const char *out_dir;             /* folder of outputs; or NULL */
    const char *ending;              /* of outputs that the inputs name; NULL: that of the input */
    const char *input;               /* for rows without one; or NULL */
    const ffd_deform_desc *defaults; /* lattices and morph targets for jobs without any; or NULL */
    const uint8_t *skipped;          /* of a table's columns: whether they are left out */
    bool decimal_comma;              /* numbers may have a decimal comma */
    uint8_t *points;                 /* of a table's columns: csv_point of their numbers so far */
} job_commons;

/* Numbers that may be read otherwise than they were meant. All zeros: none. */
typedef struct csv_flaw {
    char cell[48],
        number[64]; /* the first one that is not written as in JSON: the original, and the number read */
    /* The first one by which its column has decimal commas and dots before three digits. */
    char column[48], mixed[48];
} csv_flaw;

/* Returns the name of the output of an input, which names none. ordinal: appended if the input has several
   outputs (STEM-ROW.EXT); 0: not appended. Free it with ffd_free; NULL: memory ran out. */
char *ffd_output_name(const job_commons *commons, const char *input, uint64_t ordinal);
/* Describes a row. Its cells must be UTF-8, as many as the columns. ordinal: of the row, for the name of an
   output without one (0: use the input's name). */
void ffd_describe_row(const job_commons *commons, const csv_row *columns, const csv_row *row,
                      uint64_t ordinal, job_description *job, csv_flaw *flaw);
/* Describes a job for a single file. */
void ffd_describe_file(const job_commons *commons, const char *path, job_description *job);

#endif
