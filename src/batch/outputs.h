/* outputs.h - records the files that the jobs of a run write: no two jobs may write the same file. */
#ifndef FFD_BATCH_OUTPUTS_H
#define FFD_BATCH_OUTPUTS_H

#include "base/memory/file_table.h"
#include "base/file/input.h"
#include "base/file/path_list.h"
#include "batch/manifest/job_words.h"
#include <ffd/job.h>

/* An image or material library that is copied with an output. */
typedef struct copied_file {
    char *source;
    uint64_t line; /* of the first job that copies it */
} copied_file;

/* All zeros: none. */
typedef struct run_outputs {
    file_table lines;    /* line of the job that writes each file; 0: the run itself */
    file_table copies;   /* index in `copied` of each target of a copy */
    copied_file *copied; /* copied_count entries */
    size_t copied_count, copied_capacity;
    /* The mesh that a worker looked at last (NULL: none), the number of files written beside its output, and
       the files that may be copied. */
    char *input;
    ffd_format from, to;
    file_stamp stamp;
    size_t beside;
    path_list resources;
} run_outputs;

/* How the files beside a job's output, and copied with it, become known. The first process opens no mesh: one
   that crashes or hangs must cost its own jobs only. */
typedef enum output_others {
    OTHERS_NONE,
    OTHERS_KNOWN,  /* from the formats */
    OTHERS_BY_MESH /* only by opening the mesh, in a worker */
} output_others;
/* Returns how the other files of a job become known. */
output_others ffd_outputs_others(const batch_job *job);
/* Whether the job's mesh is the one looked at last, and has not changed. */
bool ffd_outputs_know_mesh(const run_outputs *outputs, const batch_job *job);
/* Stores what a worker found: the number of files beside the output, and paths that may be copied, each
   terminated by 0. Errors: FFD_E_MEMORY. */
ffd_status ffd_outputs_learn(run_outputs *outputs, const batch_job *job, size_t beside,
                             const byte_buffer *resources, ffd_error *error);
/* Claims the output of a job; *target: its identity. If an earlier job or the run itself writes that file,
   stores an error in the job, with its line of the manifest (NULL: there is none). Errors: FFD_E_MEMORY. */
ffd_status ffd_outputs_claim(run_outputs *outputs, const char *manifest, batch_job *job, hash128 *target,
                             ffd_error *error);
/* Likewise claims the other files of a job, as the last look at its mesh has found them. Two jobs may copy
   equal bytes to one place. */
ffd_status ffd_outputs_claim_others(run_outputs *outputs, const char *manifest, batch_job *job,
                                    ffd_error *error);
/* Likewise claims the picture of a job, whose identity is `file`. */
ffd_status ffd_outputs_claim_picture(run_outputs *outputs, const char *manifest, batch_job *job,
                                     const hash128 *file, const char *path, ffd_error *error);
/* Stores an error in a job whose embedding is a file of the run, or one that this job or an earlier one
   writes. */
void ffd_outputs_check_embedding(const run_outputs *outputs, const char *manifest, batch_job *job);
/* Reserves a file of the run itself. Errors: FFD_E_MEMORY. */
ffd_status ffd_outputs_reserve(run_outputs *outputs, const char *path, ffd_error *error);
/* Frees the tables; leaves all zeros. */
void ffd_outputs_free(run_outputs *outputs);

#endif
