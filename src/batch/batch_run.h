/* batch_run.h - the state of a running batch. batch_run.c runs it (batch.h), batch_ends.c has the functions
   below. */
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

/* The most jobs in memory. If results are output in order, jobs that end early wait here for earlier ones. */
#define BATCH_WINDOW ((size_t)1024)

typedef struct batch_run {
    const batch_desc *desc;
    job_source *source;
    worker_pool *pool;
    job_journal *journal; /* NULL: none */
    ffd_report *report;   /* NULL: none */
    ffd_depfile *depfile; /* NULL: none */
    run_view *view;       /* NULL: none */
    run_rows rows;        /* zeros: none */
    shown_box box;        /* the shared box of all meshes */
    path_list box_files;  /* its files, for the depfile */
    path_list outputs;    /* outputs that depend on box_files */
    run_outputs written;  /* files claimed so far */
    mesh_states meshes;   /* states of the meshes read so far */
    uint64_t jobs;        /* number of jobs read so far */
    batch_progress progress;
    batch_counts counts;
    pool_task *tasks[BATCH_WINDOW]; /* count tasks in the order of the jobs */
    size_t count, waiting;          /* waiting: those that have not begun */
    bool ended;                     /* the source has no more jobs */
    bool starved;                   /* the next job is not complete yet */
    bool ending;                    /* no more jobs are begun */
    bool dropped;                   /* some jobs were not begun */
    bool said_shortage;             /* that jobs wait for memory */
} batch_run;

/* Returns the file whose lines the jobs are, for messages; NULL: none. */
const char *ffd_run_manifest(const batch_run *run);
/* Prints an error that belongs to no job. */
void ffd_run_say_error(batch_run *run, const ffd_error *error);
/* Handles the ends of jobs that need not wait for earlier jobs. An invalid job "ends" when all earlier ones
   have, because an earlier failure may stop the run; it is dropped if no more jobs are begun. Errors:
   FFD_E_MEMORY, FFD_E_IO. */
ffd_status ffd_run_note_ends(batch_run *run, ffd_error *error);
/* Removes ended jobs from the window; if results are output in order, only up to the first job that has not
   ended. Counts waiting jobs. Errors: as of ffd_run_note_ends. */
ffd_status ffd_run_take_ended(batch_run *run, ffd_error *error);

#endif
