/* job_words.h - a job as the words of `ffd deform` that do it. */
#ifndef FFD_BATCH_MANIFEST_JOB_WORDS_H
#define FFD_BATCH_MANIFEST_JOB_WORDS_H

#include "base/fail.h"
#include "base/text/buffer.h"
#include "batch/manifest/job_description.h"
#include <stdbool.h>
#include <stdint.h>

/* An option that holds for all jobs that do not have it themselves. */
typedef struct batch_default {
    const char *name;  /* "normals" */
    const char *value; /* NULL: it takes none */
} batch_default;

/* What all jobs of a batch have in common. */
typedef struct batch_frame {
    const char *name;   /* of the manifest, in messages; not owned, as all here */
    const char *folder; /* that relative paths start from; "" for the current one */
    const batch_default *defaults;
    size_t default_count;
    bool resume;    /* jobs that cannot be resumed are refused */
    bool pictures;  /* likewise those that have no OUT to name a picture after */
    bool positions; /* jobs need no OUT: each has a row of positions; those without one are refused */
} batch_frame;

typedef struct batch_job {
    uint64_t line;     /* in the manifest, from 1 */
    uint64_t row;      /* its number among the jobs of all shards, from 0 */
    char *input;       /* as the manifest names it; NULL where it does not */
    char *output;      /* likewise; NULL too where the input is overwritten, or no mesh is written */
    char *target;      /* where the output goes; NULL likewise, but where the input is overwritten */
    byte_buffer words; /* arguments of `ffd deform`, each ended by 0 */
    size_t word_count;
    byte_buffer content; /* what the job says, but for where files are: each word ended by 0 */
    ffd_error error;     /* what is wrong with the line; FFD_OK: nothing */
} batch_job;

/* Makes an empty job, whose line is set, do what a description says. What is wrong with that comes into the
   job's error; returns FFD_OK or FFD_E_MEMORY. */
ffd_status ffd_job_make(const batch_frame *frame, const job_description *description, batch_job *job);
/* Returns the name of its output; NULL if it has none. */
const char *ffd_job_output_name(const batch_job *job);
/* Returns the value of an option among its words; NULL: it has none. */
const char *ffd_job_option(const batch_job *job, const char *name);
/* Leaves an empty job. */
void ffd_job_free(batch_job *job);

#endif
