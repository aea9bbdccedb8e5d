/* measure.h - measures the jobs' meshes before the first job: their common box (`--shared-box`), and their
   number of vertices (`--positions`). */
#ifndef FFD_BATCH_MEASURE_H
#define FFD_BATCH_MEASURE_H

#include "base/file/path_list.h"
#include "batch/manifest/job_source.h"
#include "batch/pool.h"

/* Measures the meshes of all jobs, of all shards, in workers. Skips an invalid job or an unreadable mesh,
   which fails by itself later. wants_files: add the files of the meshes to `files`. Ends early if the program
   is interrupted. Errors: those of the manifest and the workers; FFD_E_ARGUMENT for a manifest that cannot be
   read twice. */
ffd_status ffd_batch_measure(const job_source_desc *jobs, const pool_desc *pool, bool wants_files,
                             shown_box *box, path_list *files, ffd_error *error);

/* Counts the vertices of the first readable mesh, in a worker. *found: false (and *vertices 0) if there is
   none. Errors: those of the manifest and the workers. */
ffd_status ffd_batch_count_vertices(const job_source_desc *jobs, const pool_desc *pool, uint64_t *vertices,
                                    bool *found, ffd_error *error);

#endif
