/* job_source.h - the jobs of a batch, one after the other: lines of a manifest, rows of a table, or the files
   that a pattern names. */
#ifndef FFD_BATCH_MANIFEST_JOB_SOURCE_H
#define FFD_BATCH_MANIFEST_JOB_SOURCE_H

#include "batch/manifest/job_words.h"
#include "batch/manifest/lines.h"
#include "mesh/flaws.h"

typedef struct job_source_desc {
    const char *manifest; /* JSON Lines, "-": standard input; or NULL */
    const char *table;    /* CSV: a row a job, its first row names the columns; or NULL */
    const char *pattern;  /* of a table's rows that have no "in": the mesh; else a pattern for meshes */
    const char *const *lattices; /* with table and pattern: of all jobs that name none */
    size_t lattice_count;
    const char *const *morphs; /* lattice_count names of the morph targets that they make; or NULL */
    const char *ignored;       /* columns "a,b" of the table that are left out; or NULL */
    const char *out_dir; /* with pattern: where files keep their names; with table: the folder of "out" */
    const batch_default *defaults;
    size_t default_count;
    bool resume, pictures, positions; /* as in batch_frame */
    bool strict;                      /* a table that is odd but plain is refused */
    uint64_t shard, shards;           /* jobs shard, shard + shards, ... of all, counted from 0 */
} job_source_desc;

typedef struct job_source job_source;

/* desc's texts must outlive the source. Errors: FFD_E_IO, FFD_E_INVALID, FFD_E_ARGUMENT, FFD_E_MEMORY. */
ffd_status ffd_jobs_open(const job_source_desc *desc, job_source **source, ffd_error *error);
/* Fills an empty job, to be freed by the caller in every case, with the next one, if *state becomes
   LINE_READ: it does not wait for a manifest that is still being written. An error in the job itself is not a
   failure. Errors: FFD_E_IO, FFD_E_MEMORY. */
ffd_status ffd_jobs_next(job_source *source, batch_job *job, line_state *state, ffd_error *error);
/* Counts the jobs of all shards. desc is that of a text that can be read twice. Errors: those of
   ffd_jobs_open and ffd_jobs_next. */
ffd_status ffd_jobs_total(const job_source_desc *desc, uint64_t *total, ffd_error *error);
/* How many jobs there were so far, in all shards. */
uint64_t ffd_jobs_count(const job_source *source);
/* The part of the jobs that was handed out, by bytes or files: 0 to 1; negative where it is not known. */
double ffd_jobs_fraction(const job_source *source);
/* What is odd, but plain, about the table so far. */
const mesh_flaws *ffd_jobs_flaws(const job_source *source);
/* The name of the manifest, table or pattern, for messages. */
const char *ffd_jobs_name(const job_source *source);
/* Sets *source to NULL; it may be NULL before. */
void ffd_jobs_close(job_source **source);

#endif
