/* run_rows.h - the array that a run's jobs write their positions to (--positions), and the report beside it
   that says what is in each row. */
#ifndef FFD_BATCH_RUN_ROWS_H
#define FFD_BATCH_RUN_ROWS_H

#include "batch/batch.h"
#include "batch/row_array.h"

/* All zeros: none is wanted. */
typedef struct run_rows {
    row_array array;
    bool is_there;      /* or will be: the meshes' vertices are known */
    char *list;         /* the path of the report beside it */
    ffd_report *report; /* NULL: of a dry run, or one that was interrupted before its first job */
    hash128 file;       /* the array's identity */
    file_output *made;  /* the array, which has no name yet; NULL: it is there, or none is to be written */
    bool replaces;      /* an array that is there */
    bool goes_on;       /* with one that is there */
} run_rows;

/* Counts jobs and vertices, and makes the array, unless nothing is to be written. One that is there is gone
   on with where the run resumes, or is a shard; else it stays until ffd_run_rows_place. Errors: those of the
   jobs and the workers; FFD_E_EXISTS, FFD_E_LIMIT, FFD_E_IO. */
ffd_status ffd_run_rows_open(run_rows *rows, const batch_desc *desc, ffd_error *error);
/* Starts the report and gives the array its name: when all else that the run could be refused for has been
   seen. Errors: FFD_E_EXISTS, FFD_E_IO, FFD_E_MEMORY. */
ffd_status ffd_run_rows_place(run_rows *rows, const batch_desc *desc, ffd_error *error);
/* By what the journal knows the results of a job: its output (NULL: it has none) and its row. */
hash128 ffd_run_rows_target(const run_rows *rows, uint64_t row, const hash128 *output);
/* Frees; a report that was not finished keeps what is there. */
void ffd_run_rows_close(run_rows *rows);

#endif
