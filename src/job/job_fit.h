/* job_fit.h - the lattices of a job where its mesh has them: fitted to it, and with the faces that are held.
 */
#ifndef FFD_JOB_JOB_FIT_H
#define FFD_JOB_JOB_FIT_H

#include "job/measure/job_state.h"

/* Fits the chain to the mesh, holds the faces that the description asks for, says which ones the mesh cuts,
   and opens the embedding if the job has one. Errors: those of ffd_chain_fit, ffd_cut_faces_find,
   ffd_lattice_seal and ffd_embedding_reuse. */
ffd_status ffd_job_fit(deform_job *job, ffd_error *error);
/* Notes in the result of the job which faces are held. */
void ffd_job_note_seam(const deform_job *job, ffd_job_result *result);

#endif
