/* outputs.h - the files that the jobs of a run write: no two may write one file. */
#ifndef FFD_BATCH_OUTPUTS_H
#define FFD_BATCH_OUTPUTS_H

#include "base/file/input.h"
#include "base/file/path_list.h"
#include "batch/manifest/file_table.h"
#include "batch/manifest/job_words.h"
#include <ffd/job.h>

/* An image or material library that goes with an output into another folder. */
typedef struct copied_file {
    char *source;
    uint64_t line; /* of the first job that copies it */
} copied_file;

/* All zeros: none. */
typedef struct run_outputs {
    file_table lines;    /* of the job that writes each file; 0: the run itself does */
    file_table copies;   /* number in `copied` of each file that is a copy */
    copied_file *copied; /* copied_count */
    size_t copied_count, copied_capacity;
    /* The mesh that a worker looked at last (NULL: none), how many files are written beside its output, and
       what may be copied. */
    char *input;
    ffd_format from, to;
    file_stamp stamp;
    size_t beside;
    path_list resources;
} run_outputs;

/* The files that a job writes beside its output, or copies with it. The first process reads no mesh: one that
   ends the program, or never ends, must cost its own jobs only. */
typedef enum output_others {
    OTHERS_NONE,
    OTHERS_KNOWN,  /* by the formats */
    OTHERS_BY_MESH /* only a look at the mesh shows them */
} output_others;
/* What is known of the others before anything is read. */
output_others ffd_outputs_others(const batch_job *job);
/* Whether the mesh is the one of the last look, as it was then. */
bool ffd_outputs_know_mesh(const run_outputs *outputs, const batch_job *job);
/* Takes note of what a worker saw: how many files are written beside the output, and the paths that may be
   copied, each ended by 0. Errors: FFD_E_MEMORY. */
ffd_status ffd_outputs_learn(run_outputs *outputs, const batch_job *job, size_t beside,
                             const byte_buffer *resources, ffd_error *error);
/* Notes the output of a job, which becomes *target. If a job before writes that file, or the run itself, this
   becomes the job's error, at its line in the manifest (NULL: there is none). Errors: FFD_E_MEMORY. */
ffd_status ffd_outputs_claim(run_outputs *outputs, const char *manifest, batch_job *job, hash128 *target,
                             ffd_error *error);
/* The same of the others, as the last look at its mesh has shown them; two jobs may copy the same bytes to
   one place. */
ffd_status ffd_outputs_claim_others(run_outputs *outputs, const char *manifest, batch_job *job,
                                    ffd_error *error);
/* Notes the picture of a job, whose identity is `file`, likewise. */
ffd_status ffd_outputs_claim_picture(run_outputs *outputs, const char *manifest, batch_job *job,
                                     const hash128 *file, const char *path, ffd_error *error);
/* Notes a file of the run itself. Errors: FFD_E_MEMORY. */
ffd_status ffd_outputs_reserve(run_outputs *outputs, const char *path, ffd_error *error);
/* Leaves none. */
void ffd_outputs_free(run_outputs *outputs);

#endif
