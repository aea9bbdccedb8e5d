/* batch_run.h - a batch on its way: the jobs that are known, and what follows from them. batch_run.c runs it
   (batch.h), batch_ends.c has the functions below. */
#ifndef FFD_BATCH_BATCH_RUN_H
#define FFD_BATCH_BATCH_RUN_H

#include "base/file/path.h"
#include "batch/batch.h"
#include "batch/journal.h"
#include "batch/mesh_states.h"
#include "batch/outputs.h"
#include "batch/progress.h"
#include "batch/run_rows.h"
#include "batch/run_view.h"
#include "job/report/depfile.h"

/* The most jobs that are known at a time. Where something is told in their order, those that end before an
   earlier one wait here for their turn. */
#define BATCH_WINDOW ((size_t)1024)

typedef struct batch_run {
    const batch_desc *desc;
    job_source *source;
    worker_pool *pool;
    job_journal *journal; /* NULL: there is none */
    ffd_report *report;   /* likewise */
    ffd_depfile *depfile; /* likewise */
    run_view *view;       /* likewise */
    run_rows rows;        /* likewise */
    shown_box box;        /* of all meshes, where they share one */
    path_list box_files;  /* that it was taken from, where there is a depfile */
    path_list outputs;    /* that depend on these */
    run_outputs written;  /* by the jobs so far */
    mesh_states meshes;   /* that they have read */
    uint64_t jobs;        /* so far */
    batch_progress progress;
    batch_counts counts;
    pool_task *tasks[BATCH_WINDOW]; /* in their order; count of them */
    size_t count, waiting;          /* those that have not begun */
    bool ended;                     /* the source has no more jobs */
    bool starved;                   /* the next one has not come yet */
    bool ending;                    /* no more jobs are begun */
    bool dropped;                   /* some were not begun */
} batch_run;

/* The name of what the jobs are lines of; NULL: they have none. */
const char *ffd_run_manifest(const batch_run *run);
/* Prints a failure that is of no job. */
void ffd_run_say_error(batch_run *run, const ffd_error *error);
/* Does what follows at once from the ends of jobs. A job that is not valid ends when those before it have: it
   could be the one to stop at. Once no more are begun it is not begun either. Errors: FFD_E_MEMORY, FFD_E_IO.
 */
ffd_status ffd_run_note_ends(batch_run *run, ffd_error *error);
/* Takes ended jobs out of the window; where they are told in their order, up to the first one that has not
   ended. Counts those that wait. Errors: the same. */
ffd_status ffd_run_take_ended(batch_run *run, ffd_error *error);

#endif
