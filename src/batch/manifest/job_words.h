/* job_words.h - turns a job's description into the words of an `ffd deform` command. */
#ifndef FFD_BATCH_MANIFEST_JOB_WORDS_H
#define FFD_BATCH_MANIFEST_JOB_WORDS_H

#include "base/fail.h"
#include "base/text/buffer.h"
#include "batch/manifest/job_description.h"
#include <stdbool.h>
#include <stdint.h>

/* An option of the batch, for jobs that do not override it. */
typedef struct batch_default {
    const char *name;  /* without dashes: "normals" */
    const char *value; /* NULL: it takes none */
} batch_default;

/* What all jobs of a batch share. Nothing is owned. */
typedef struct batch_frame {
    const char *name;   /* of the manifest, for messages */
    const char *folder; /* base of relative paths; "": the current one */
    const batch_default *defaults;
    size_t default_count;
    bool resume;    /* refuse jobs that cannot be resumed */
    bool pictures;  /* refuse jobs without OUT, after which pictures are named */
    bool positions; /* jobs need no OUT, as each has a row of positions; refuse jobs without positions */
} batch_frame;

typedef struct batch_job {
    uint64_t line;     /* of the manifest, from 1 */
    uint64_t row;      /* number among the jobs of all shards, from 0 */
    char *input;       /* as in the manifest; NULL: missing */
    char *output;      /* as in the manifest; NULL: in place, or no mesh is written */
    char *target;      /* path of the output, also in place; NULL: no mesh is written */
    byte_buffer words; /* arguments of `ffd deform`, each terminated by 0 */
    size_t word_count;
    byte_buffer content; /* words that determine the output, without paths; each terminated by 0 */
    ffd_error error;     /* what is wrong with the line; FFD_OK: nothing */
} batch_job;

/* Fills an empty job, whose line is set, from a description. Errors in the description are stored in
   job->error. Returns FFD_OK or FFD_E_MEMORY. */
ffd_status ffd_job_make(const batch_frame *frame, const job_description *description, batch_job *job);
/* Returns the output's name for messages; NULL: none. */
const char *ffd_job_output_name(const batch_job *job);
/* Returns the value of an option of the job; NULL: not set. */
const char *ffd_job_option(const batch_job *job, const char *name);
/* Returns the path of the lattice that a word of a job names; NULL: it names none. */
const char *ffd_word_lattice(const char *word);
/* Frees the texts; leaves an empty job. */
void ffd_job_free(batch_job *job);

#endif
