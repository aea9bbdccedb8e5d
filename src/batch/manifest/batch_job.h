/* batch_job.h - turns a job's description into what the library runs. */
#ifndef FFD_BATCH_MANIFEST_BATCH_JOB_H
#define FFD_BATCH_MANIFEST_BATCH_JOB_H

#include "base/fail.h"
#include "base/file/path_list.h"
#include "base/memory/hash.h"
#include "batch/manifest/job_description.h"
#include <ffd/job.h>
#include <stdbool.h>
#include <stdint.h>

/* What all jobs of a batch share. Nothing is owned. */
typedef struct batch_frame {
    const char *name;                /* of the manifest, for messages */
    const char *folder;              /* base of relative paths; "": the current one */
    const ffd_deform_desc *defaults; /* for jobs that do not say otherwise, without their lattices; or NULL */
    const char *ending;              /* of outputs, by the default output_format; NULL: none */
    const ffd_view_desc *look; /* of pictures of jobs that do not say otherwise; NULL: the default one */
    bool resume;               /* refuse jobs that cannot be resumed */
    bool pictures;             /* refuse jobs without OUT, after which pictures are named */
    bool positions; /* jobs need no OUT, as each has a row of positions; refuse jobs without positions */
} batch_frame;

/* The place of an output, and as seen from the folder of the jobs' file (base/file/place.h). */
typedef struct output_place {
    bool is_known;
    hash128 place, seen;
} output_place;

typedef struct batch_job {
    uint64_t line;        /* of the manifest, from 1 */
    uint64_t row;         /* number among the jobs of all shards, from 0 */
    char *input;          /* as in the manifest; NULL: missing */
    char *output;         /* as in the manifest; NULL: in place, or no mesh is written */
    const char *target;   /* path of the output, also in place; NULL: no mesh is written */
    ffd_deform_desc desc; /* without what workers add: objects, log, share of the processors */
    ffd_view_desc look;   /* of its picture (manifest/job_look.h) */
    output_place place;   /* of target, once it was asked for */
    hash128 content;      /* of what determines the output, without the bytes of files */
    ffd_error error;      /* what is wrong with the line; FFD_OK: nothing */
    byte_buffer texts;    /* of desc and look, */
    path_list paths;      /* and its paths */
} batch_job;

/* Fills an empty job, whose line is set, from a description, whose texts it takes over. Errors in the
   description are stored in job->error. Returns FFD_OK or FFD_E_MEMORY. */
ffd_status ffd_job_make(const batch_frame *frame, job_description *description, batch_job *job);
/* Returns the output's name for messages; NULL: none. */
const char *ffd_job_output_name(const batch_job *job);
/* Returns the ending that an output format gives to names, or NULL. */
const char *ffd_format_ending(ffd_format format);
/* Returns the memory budget of a job in bytes (mesh/memory_budget.h), by its own and the sizes of its files.
   Buffers that a .gltf names are not counted, because only a worker reads it. draws: the job makes a picture
   too. */
uint64_t ffd_job_memory(const batch_job *job, bool draws);
/* Frees the texts; leaves an empty job. */
void ffd_job_free(batch_job *job);

#endif
