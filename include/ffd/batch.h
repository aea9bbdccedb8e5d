/* batch.h - many jobs in several processes, as `ffd batch` does them: a job that crashes, hangs or takes too
   much memory harms no other. data/reference.md describes a batch, data/schema/formats.md 3 and 4 its
   manifests and tables.

   The processes are those of the program `ffd` of the same build as this library. It is looked for near the
   library, as its modules are, and then in the folders of PATH. Several batches may run in several threads at
   once if they write different files. Strings, arrays and objects that a description points to belong to the
   caller and are used during the call only. */
#ifndef FFD_BATCH_H
#define FFD_BATCH_H

#include <ffd/error.h>
#include <ffd/export.h>
#include <ffd/job.h>
#include <ffd/result.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Gives a job as a line of a manifest (JSON, UTF-8, terminated by 0), with paths relative to the current
   folder. index: of the job, counted from 0, each one more than the last. *line: NULL, as it is before the
   call, if there are no more jobs; it must stay valid until the next call. Called in the thread that runs the
   batch, for as many jobs ahead as there are workers; with repeats for all of them before the first one
   begins, and for some again. A result other than FFD_OK ends the batch with this
   status, after the jobs that have begun (FFD_E_IO if it is not an ffd_status). */
typedef ffd_status (*ffd_batch_next_function)(void *user, uint64_t index, const char **line);

/* A job that has ended. All of it is valid during the call only. */
typedef struct ffd_batch_job {
    uint64_t line;      /* of the manifest or table, from 1; of others the ordinal of the job, from 1 */
    uint64_t row;       /* index among the jobs of all shards, from 0 */
    const char *input;  /* as the job names it; NULL: it names none */
    const char *output; /* likewise; of a job in place its input; NULL: it writes no mesh */
    bool skipped;       /* resume has found its output up to date */
    const char *log;    /* lines of warnings and errors, each ended by a line break */
    /* With its status and error. Of a skipped job the figures are those of the run that made its output, as
       far as the journal has them; of a job that no worker has begun all are 0. */
    const ffd_job_result *result;
} ffd_batch_job;

/* Called for each job as it ends, with its picture, in the thread that runs the batch; not in the order of
   the jobs. */
typedef void (*ffd_batch_ended_function)(void *user, const ffd_batch_job *job);

/* A batch. Fill with ffd_batch_desc_init, then say where the jobs come from: a manifest, a callback, a
   pattern, or a table, alone or with a pattern that names the mesh of rows without one. */
typedef struct ffd_batch_desc {
    size_t struct_size;           /* sizeof(ffd_batch_desc) in the caller's header */
    const char *manifest;         /* path of JSON Lines; "-": standard input; or NULL */
    const char *csv;              /* path of a table; or NULL */
    const char *in;               /* pattern of mesh files; or NULL */
    ffd_batch_next_function next; /* or NULL */
    void *next_user;
    bool repeats; /* next may be asked for all jobs again, from index 0 on: needed for shared_box and
                     positions, and jobs that write what others read are known before the first one begins */
    const char *csv_ignore; /* columns of the table to ignore, "a,b"; or NULL */
    const char *out_dir;    /* folder of outputs of a pattern or a table; or NULL */
    /* The settings of jobs that do not say otherwise; or NULL. Lattices and morphs are for jobs of patterns
       and tables that name no lattice. Of its members that have no option (ffd_member) only quality counts.
     */
    const ffd_deform_desc *defaults;
    /* Ending that outputs get instead of that of another mesh format; NULL: that of defaults->output_format.
     */
    const char *output_ending;
    int workers;            /* processes; 0: one for each processor, as far as memory allows */
    double timeout;         /* limit of a job in seconds; 0: none */
    uint64_t shard, shards; /* only the jobs shard, shard + shards, .. counted from 0; shards 0: all */
    bool resume;            /* keep outputs that are up to date by content, replace others */
    const char *journal;    /* where resume records what outputs were made from; NULL: in the user's cache */
    const char *positions;  /* path (.npy) of the array of all deformed positions; or NULL */
    bool positions_double;  /* its numbers are float64, else float32 */
    /* Folder for pictures of the jobs, and the index that compares them; or NULL. Pictures of the jobs on one
       mesh have one frame and one scale of colours, except with `in` alone: they are drawn when the last job
       has ended, and only then are jobs told of (ended, report). A mesh that is deformed to farther than 10
       diagonals of the mesh at rest from it has a frame of its own, and so has a job whose options of view
       differ from those of most jobs on its mesh (ffd_job_result.own_frame). */
    const char *view;
    const char *report;             /* path; "-": standard output; or NULL */
    bool report_stable;             /* without times */
    const char *depfile;            /* path of the rules of all outputs; or NULL */
    bool shared_box;                /* the box "mesh" of a lattice goes round all meshes, not round each */
    bool dry_run;                   /* write nothing */
    bool stop;                      /* begin no more jobs after one has failed */
    ffd_batch_ended_function ended; /* or NULL */
    void *ended_user;
    /* Called in the thread that runs the batch, several times a second while jobs run, with the fraction of
       all jobs that has begun; where pictures wait for the last job, that is the first half, and the fraction
       of pictures the second; negative: unknown. If it returns false, the running jobs are stopped and the
       batch fails with FFD_E_CANCELLED; outputs that are complete stay. NULL: no callback. */
    bool (*progress)(void *user, double done);
    void *progress_user;
    ffd_log_function
        log; /* receives warnings and errors of the batch and of its jobs, as they come; may be NULL */
    void *log_user;
    bool quiet;   /* no warnings */
    bool verbose; /* details too */
    /* For the program `ffd`, instead of log and progress: messages and progress go to standard error, the
       plan of a dry run to standard output, signals that ask to end the process end the batch, and the
       processes are its own. */
    bool is_program;
    /* When *cancel is not 0 the batch ends as by progress. Another thread or the handler of a signal may set
       it, by an atomic store; NULL: nobody does. */
    const int *cancel;
    /* How pictures are drawn: camera, up, color, width, height, frames, animation and no_cage; its other
       members do not count. A job may say otherwise ("view" among its options). Only with view; NULL: as by
       default. */
    const ffd_view_desc *look;
    /* Beside the picture of each job, DIR/OUT.png, a page, DIR/OUT.html, to which the index leads. Needs
       view. */
    bool pages;
} ffd_batch_desc;

/* Sets desc to defaults: all members 0, NULL or false. size: sizeof(ffd_batch_desc) in the caller's header.
 */
FFD_API void ffd_batch_desc_init(ffd_batch_desc *desc, size_t size);

/* Checks that the members fit each other, without a look at any file. ffd_batch_run begins with it.
   Thread-safe. Errors: FFD_E_ARGUMENT. */
FFD_API ffd_status ffd_batch_desc_check(const ffd_batch_desc *desc, ffd_error *error);

/* How many jobs have ended, and how. */
typedef struct ffd_batch_result {
    size_t struct_size;             /* sizeof(ffd_batch_result) in the caller's header, set before the call */
    uint64_t done, skipped, failed; /* skipped: their outputs were up to date */
    bool is_complete;               /* all jobs have ended; else some were not begun */
} ffd_batch_result;

/* Runs a batch. A job that fails is counted, and is not an error of the batch. result is filled in every
   case. Errors: FFD_E_UNSUPPORTED (there is no program `ffd`, or one of another build), FFD_E_CANCELLED, and
   those of the manifest, the report, the journal and the workers; jobs that have ended stay done. */
FFD_API ffd_status ffd_batch_run(const ffd_batch_desc *desc, ffd_batch_result *result, ffd_error *error);

#ifdef __cplusplus
}
#endif

#endif
