/* job_source.h - enumerates the jobs of a batch: lines of a manifest, rows of a table, or files that match a
   pattern. */
#ifndef FFD_BATCH_MANIFEST_JOB_SOURCE_H
#define FFD_BATCH_MANIFEST_JOB_SOURCE_H

#include "batch/manifest/batch_job.h"
#include "batch/manifest/lines.h"
#include "mesh/flaws.h"
#include <ffd/batch.h>

typedef struct job_source_desc {
    const char *manifest;         /* JSON Lines; "-": standard input; or NULL */
    const char *table;            /* CSV, whose first row names the columns; or NULL */
    ffd_batch_next_function next; /* lines of a manifest; or NULL */
    void *next_user;
    bool repeats;        /* next can be asked again from the first line on */
    const char *pattern; /* with a table: the mesh of rows without "in"; else a pattern for meshes */
    const char *ignored; /* columns of the table to ignore, "a,b"; or NULL */
    const char *out_dir; /* pattern: folder of outputs, which keep their names; table: folder of "out" */
    const ffd_deform_desc *defaults;  /* for jobs that do not say otherwise: lattices where the jobs come from
                                         no manifest, and all other settings; or NULL */
    const ffd_view_desc *look;        /* of pictures; NULL: the default one */
    const char *ending;               /* of outputs, by the default output_format; or NULL */
    bool resume, pictures, positions; /* as in batch_frame */
    bool strict;                      /* refuse a table with flaws whose meaning is clear */
    uint64_t shard, shards;           /* take the jobs shard, shard + shards, .. of all, counted from 0 */
} job_source_desc;

typedef struct job_source job_source;

/* Opens the source. The texts of desc must outlive it. Errors: FFD_E_IO, FFD_E_INVALID, FFD_E_ARGUMENT,
   FFD_E_MEMORY. */
ffd_status ffd_jobs_open(const job_source_desc *desc, job_source **source, ffd_error *error);
/* Fills an empty job with the next one and sets *state to LINE_READ; or to LINE_LATER if a manifest that is
   still being written has no complete line, without waiting. ffd_job_free must be called in every case. An
   error in the job itself is stored in it, and is not a failure. Errors: FFD_E_IO, FFD_E_MEMORY. */
ffd_status ffd_jobs_next(job_source *source, batch_job *job, line_state *state, ffd_error *error);
/* Whether the jobs come from standard input or a pipe, and cannot be read twice. */
bool ffd_jobs_come_once(const job_source_desc *desc);
/* Counts the jobs of all shards. The source must be readable twice. Errors: those of ffd_jobs_open and
   ffd_jobs_next. */
ffd_status ffd_jobs_total(const job_source_desc *desc, uint64_t *total, ffd_error *error);
/* Returns the number of jobs so far, of all shards. */
uint64_t ffd_jobs_count(const job_source *source);
/* Returns the fraction of the source consumed, by bytes or files, 0 to 1; negative: unknown. */
double ffd_jobs_fraction(const job_source *source);
/* Returns the descriptor of the manifest or table, to wait for its next line; negative: there is none. */
int ffd_jobs_descriptor(const job_source *source);
/* Returns the flaws of the table found so far. */
const mesh_flaws *ffd_jobs_flaws(const job_source *source);
/* Returns the name of the manifest, table or pattern for messages. */
const char *ffd_jobs_name(const job_source *source);
/* Closes a source and sets *source to NULL, which it may be already. */
void ffd_jobs_close(job_source **source);

#endif
