/* measure.h - what has to be known of the jobs' meshes before the first job: the box round all of them, which
   they share (`--shared-box`), and how many vertices they have (`--positions`). */
#ifndef FFD_BATCH_MEASURE_H
#define FFD_BATCH_MEASURE_H

#include "base/file/path_list.h"
#include "batch/manifest/job_source.h"
#include "batch/pool.h"

/* Reads the mesh of every job, of all shards, in the workers. A job that is not valid, or whose mesh cannot
   be read, is left out: it fails by itself later. The files of the meshes come into files, where they are
   wanted. Ends early where the program is asked to end. Errors: those of the manifest and the workers;
   FFD_E_ARGUMENT for a manifest that cannot be read twice. */
ffd_status ffd_batch_measure(const job_source_desc *jobs, const pool_desc *pool, bool wants_files,
                             shown_box *box, path_list *files, ffd_error *error);

/* Counts the vertices of the first mesh that can be read, in a worker. Returns 0 in *vertices and false in
 *found where there is none. Errors: those of the manifest and the workers. */
ffd_status ffd_batch_count_vertices(const job_source_desc *jobs, const pool_desc *pool, uint64_t *vertices,
                                    bool *found, ffd_error *error);

#endif
