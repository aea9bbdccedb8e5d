/* claims.h - claims the files that the jobs of a run write: no two jobs may write the same file, nor one that
   another job reads. */
#ifndef FFD_BATCH_FILES_CLAIMS_H
#define FFD_BATCH_FILES_CLAIMS_H

#include "batch/files/job_files.h"
#include "batch/files/run_files.h"

/* Notes the output of a job before any job begins. Errors: FFD_E_MEMORY. */
ffd_status ffd_claims_expect(run_files *files, batch_job *job, ffd_error *error);
/* Claims the output of a job; *target: its place as the journal has it. If an earlier job or the run itself
   writes that file, or (where the outputs of later jobs are not known) an earlier job reads it, stores an
   error in the job. Errors: FFD_E_MEMORY. */
ffd_status ffd_claims_output(run_files *files, batch_job *job, hash128 *target, ffd_error *error);
/* Likewise claims the picture of a job, whose place is `file`. */
ffd_status ffd_claims_picture(run_files *files, batch_job *job, const hash128 *file, const char *path,
                              ffd_error *error);
/* What must be known before the other files of a job are claimed. The first process opens no mesh: one that
   crashes or hangs must cost its own jobs only. */
typedef struct claim_needs {
    bool mesh, lattices; /* a worker must scan these */
    bool others;         /* there may be such files */
} claim_needs;
/* Returns that. */
claim_needs ffd_claims_need(run_files *files, const batch_job *job, const job_kind *kind);
/* Whether all of it is known: from the formats, or from the last scans. */
bool ffd_claims_are_ready(const run_files *files, const batch_job *job, const job_kind *kind,
                          const claim_needs *needs);
/* Whether a worker must first scan the models of the folder of the output, which could name the files
   beside it. */
bool ffd_claims_need_survey(run_files *files, const batch_job *job, const job_kind *kind);
/* Whether that has failed: the job scans them by itself. */
bool ffd_claims_lack_survey(run_files *files, const batch_job *job, const job_kind *kind);
/* Likewise claims the other files of a job. Two jobs may copy equal bytes to one place. A file that another
   model names is passed over (mesh/resource/sidecar.h): passed gets its path and those models' names, each
   terminated by 0; and the path of a file of its own behind these, with that of the output. Errors:
   FFD_E_MEMORY. */
ffd_status ffd_claims_others(run_files *files, batch_job *job, const job_kind *kind, byte_buffer *passed,
                             ffd_error *error);

#endif
