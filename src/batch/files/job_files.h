/* job_files.h - which kinds of files a job reads and writes beside those that it names, by its description
 * alone.
 */
#ifndef FFD_BATCH_FILES_JOB_FILES_H
#define FFD_BATCH_FILES_JOB_FILES_H

#include "batch/manifest/batch_job.h"
#include "io/formats.h"

typedef struct job_kind {
    const char *input;                  /* path of the mesh */
    ffd_format from, to;                /* to: FFD_FORMAT_AUTO without an output */
    const mesh_format *source, *format; /* of these; NULL: unknown */
    bool is_kept;                       /* they are the same */
    bool has_sidecars;                  /* the output may have files beside it */
    bool is_scanned;                    /* a worker has scanned this mesh last (run_files.h) */
} job_kind;

/* Returns the kind of a valid job; is_scanned: false. */
job_kind ffd_job_kind(const batch_job *job);
/* Whether files may be copied with the output. */
bool ffd_job_has_copies(const batch_job *job, const job_kind *kind);
/* Returns the number of files beside an output whose format is not that of the mesh. */
size_t ffd_job_count_sidecars(const job_kind *kind);

#endif
