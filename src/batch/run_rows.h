/* run_rows.h - the array for the positions of a run's jobs (--positions), and the report beside it that
   describes the rows. */
#ifndef FFD_BATCH_RUN_ROWS_H
#define FFD_BATCH_RUN_ROWS_H

#include "batch/batch_desc.h"
#include "batch/row_array.h"

/* All zeros: not wanted. */
typedef struct run_rows {
    row_array array;
    bool is_there;       /* exists, or will: the number of vertices is known */
    char *list;          /* path of the report beside it */
    ffd_report *report;  /* NULL: a dry run, or interrupted before the first job */
    hash128 file;        /* identity of the array */
    file_output *folder; /* the folders that were made for the files, which go again if they stay empty */
    file_output *made;   /* the array under its temporary name; NULL: it exists, or none is to be written */
    bool replaces;       /* an existing array is replaced */
    bool goes_on;        /* an existing array is continued */
} run_rows;

/* Returns the path of the report beside the array: "ALL.json" for "ALL.npy". Shards write at the same time,
   so each has its own. Free with ffd_free; NULL: out of memory. */
char *ffd_run_rows_list(const batch_desc *desc);
/* Counts jobs and vertices and, unless it is a dry run, makes the array. Continues an existing one if the run
   resumes or is a shard; else that one stays until ffd_run_rows_place. Errors: those of the jobs and the
   workers; FFD_E_EXISTS, FFD_E_LIMIT, FFD_E_IO. */
ffd_status ffd_run_rows_open(run_rows *rows, const batch_desc *desc, ffd_error *error);
/* Starts the report and moves the array to its name. Call it after all other checks of the run. Errors:
   FFD_E_EXISTS, FFD_E_IO, FFD_E_MEMORY. */
ffd_status ffd_run_rows_place(run_rows *rows, const batch_desc *desc, ffd_error *error);
/* Returns the journal's key of a job: by its output (NULL: none) and its row. */
hash128 ffd_run_rows_target(const run_rows *rows, uint64_t row, const hash128 *output);
/* Frees the memory. An unfinished report keeps its entries. */
void ffd_run_rows_close(run_rows *rows);

#endif
