/* batch_run.h - the state of a running batch. batch_run.c runs it (batch_desc.h); batch_ends.c, job_ended.c,
   run_claims.c, run_drawing.c and run_early.c have the functions below. */
#ifndef FFD_BATCH_BATCH_RUN_H
#define FFD_BATCH_BATCH_RUN_H

#include "base/file/path.h"
#include "base/memory/file_table.h"
#include "base/memory/intern.h"
#include "batch/batch_desc.h"
#include "batch/files/claims.h"
#include "batch/journal.h"
#include "batch/progress.h"
#include "batch/run_frames.h"
#include "batch/run_rows.h"
#include "batch/run_view.h"
#include "job/report/depfile.h"

/* The most jobs in memory. If results are output in order, jobs that end early wait here for earlier ones. */
#define BATCH_WINDOW ((size_t)1024)

/* The jobs of a run, if they are few: they are read before the first one begins. */
typedef struct early_jobs {
    batch_job *list;
    size_t count, capacity, next; /* next: of those that are still to be taken */
    bool are_all;
} early_jobs;

typedef struct batch_run {
    const batch_desc *desc;
    job_source *source;
    worker_pool *pool;
    job_journal *journal; /* NULL: none */
    char *journal_path;   /* NULL: none */
    char *base;           /* folder that the names in the journal are relative to, without links */
    ffd_report *report;   /* NULL: none */
    ffd_depfile *depfile; /* NULL: none */
    run_view *view;       /* NULL: none */
    run_frames frames;    /* of the pictures */
    run_rows rows;        /* zeros: none */
    shown_box box;        /* the shared box of all meshes */
    path_list box_files;  /* its files, for the depfile */
    path_list outputs;    /* outputs that depend on box_files */
    run_files files;      /* what the jobs read and write */
    early_jobs early;
    file_table meshes;  /* for each mesh read so far: its first state, and whether a warning was given */
    intern_table boxed; /* names (as hashes) of the meshes round each of which a lattice's box was laid */
    uint64_t jobs;      /* number of jobs read so far */
    batch_progress progress;
    ffd_batch_result counts, made;  /* made: with the jobs that wait for their pictures */
    pool_task *tasks[BATCH_WINDOW]; /* count tasks in the order of the jobs */
    size_t count, waiting;          /* waiting: those that have not begun */
    bool ended;                     /* the source has no more jobs */
    bool starved;                   /* the next job is not complete yet */
    bool ending;                    /* no more jobs are begun */
    bool dropped;                   /* some jobs were not begun */
    bool cancelled;                 /* the caller wants the batch to end */
    bool logged_shortage;           /* that jobs wait for memory */
} batch_run;

/* Returns the file whose lines the jobs are, for messages; NULL: none. */
const char *ffd_run_manifest(const batch_run *run);
/* Prints an error that belongs to no job. */
void ffd_run_log_error(batch_run *run, const ffd_error *error);
/* Fails a job whose error is stored in it. */
void ffd_run_fail_task(pool_task *task);
/* Notes the outputs of all jobs before any of them begins, if the jobs can be read twice. checks: refuse a
   job that reads a file which the run itself replaces. Errors: those of reading the jobs, too. */
ffd_status ffd_run_expect(batch_run *run, bool checks, ffd_error *error);
/* Reads the next job as ffd_jobs_next does, or takes one that was read before. */
ffd_status ffd_run_next_job(batch_run *run, batch_job *job, line_state *state, ffd_error *error);
/* Returns the fraction of the jobs read, as ffd_jobs_fraction does. */
double ffd_run_fraction(const batch_run *run);
/* Frees the jobs that were read before and not taken. */
void ffd_run_drop_early(batch_run *run);
/* Claims the files of jobs as far as they are known, and makes these ready to run. Errors: FFD_E_MEMORY. */
ffd_status ffd_run_claim_tasks(batch_run *run, ffd_error *error);
/* Takes what the end of a task, or of a scan that found nothing, says of its files. Errors: FFD_E_MEMORY. */
ffd_status ffd_run_learn(batch_run *run, pool_task *task, ffd_error *error);
/* Handles the ends of jobs that need not wait for earlier jobs. An invalid job "ends" when all earlier ones
   have, because an earlier failure may stop the run; it is dropped if no more jobs are begun. Errors:
   FFD_E_MEMORY, FFD_E_IO. */
ffd_status ffd_run_note_ends(batch_run *run, ffd_error *error);
/* Finds what the journal has of the picture of a job, which has a record. */
void ffd_run_find_drawn(batch_run *run, pool_task *task);
/* Records the picture of a job that has ended, if there is a journal. */
void ffd_run_put_drawn(const batch_run *run, const pool_task *task);
/* Reads jobs that wait for their pictures; run->ended: there are no more. Errors: FFD_E_IO, FFD_E_MEMORY. */
ffd_status ffd_run_take_waiting(batch_run *run, ffd_error *error);
/* Fills a result with what the worker has answered. morphs: results of morph targets, freed by the caller. */
void ffd_run_take_result(const pool_task *task, ffd_job_result *result, ffd_job_result **morphs);
/* Adds texts that are each terminated by 0 to a list. Errors: FFD_E_MEMORY. */
ffd_status ffd_run_list_texts(const byte_buffer *texts, path_list *list, ffd_error *error);
/* Lists the outputs of a job that has ended, with its picture and page. Errors: FFD_E_MEMORY. */
ffd_status ffd_run_list_outputs(const batch_run *run, const pool_task *task, path_list *list,
                                ffd_error *error);
/* Names the picture and the page of a job in its result, if they are there. */
void ffd_run_name_picture(const pool_task *task, ffd_job_result *result);
/* Tells the caller that a job has ended. log: its messages. */
void ffd_run_call_ended(const batch_run *run, const pool_task *task, const char *log);
/* Removes ended jobs from the window; if results are output in order, only up to the first job that has not
   ended. Counts waiting jobs. Errors: as of ffd_run_note_ends. */
ffd_status ffd_run_take_ended(batch_run *run, ffd_error *error);

#endif
