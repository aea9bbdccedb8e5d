/* run_reads.h - what the jobs of a run read must not be written by another one, whichever comes first. */
#ifndef FFD_BATCH_FILES_RUN_READS_H
#define FFD_BATCH_FILES_RUN_READS_H

#include "batch/files/job_files.h"
#include "batch/files/run_files.h"

/* Stores an error in a job whose mesh, lattice or embedding another job or the run writes; else notes that it
   reads these. Errors: FFD_E_MEMORY. */
ffd_status ffd_reads_check(run_files *files, batch_job *job, ffd_error *error);
/* Stores an error in a job whose mesh, lattice or embedding the run itself writes. */
void ffd_reads_check_own(run_files *files, batch_job *job);
/* Whether workers have scanned all lattices of a job. */
bool ffd_reads_know_lattices(const run_files *files, const batch_job *job);
/* The same as ffd_reads_check for the meshes that the boxes of these lattices go round. */
void ffd_reads_check_boxes(const run_files *files, batch_job *job);
/* Whether the job's mesh is the one scanned last, and has not changed. */
bool ffd_reads_know_mesh(const run_files *files, const job_kind *kind);
/* Whether the files that a job's mesh names must be known. */
bool ffd_reads_need_named(run_files *files, const job_kind *kind);
/* Stores an error in a job whose mesh, which was scanned last, names a file that another job writes. */
void ffd_reads_check_named(const run_files *files, batch_job *job);
/* Stores what a worker has found for a job (scan.h). of_mesh: it has scanned the mesh; sidecars: the
   number of files beside the output. Errors: FFD_E_MEMORY. */
ffd_status ffd_reads_learn(run_files *files, const batch_job *job, const job_kind *kind, bool of_mesh,
                           size_t sidecars, const byte_buffer *found, ffd_error *error);
/* Stores that a worker has found nothing: the mesh names no files, its output has none beside it, and no
   lattice has a box round meshes. Errors: FFD_E_MEMORY. */
ffd_status ffd_reads_learn_nothing(run_files *files, const batch_job *job, bool of_mesh, ffd_error *error);

#endif
