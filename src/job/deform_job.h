/* deform_job.h - the steps that `ffd deform` and `ffd check` share: everything except writing;
   and what a job would write (deform.c). */
#ifndef FFD_JOB_DEFORM_JOB_H
#define FFD_JOB_DEFORM_JOB_H

#include "job/job_call.h"
#include "job/measure/job_state.h"

/* Clears result, checks the options that do not concern the output, and takes desc. Errors, stored in result:
   FFD_E_ARGUMENT, FFD_E_EXISTS. */
ffd_status ffd_deform_job_begin(deform_job *job, const ffd_deform_desc *desc, bool check,
                                ffd_job_result *result);

/* Refuses several morph targets, for jobs of one deformation. Errors: FFD_E_ARGUMENT. */
ffd_status ffd_deform_job_refuse_morphs(const ffd_deform_desc *desc, ffd_error *error);

/* What a job needs beside positions and displacements: the normals of the mesh; the derivatives of the
   control points by placeholders. */
enum { JOB_NEEDS_NORMALS = 1, JOB_NEEDS_DERIVATIVES = 2 };

/* Loads the job's lattices into its chain; they are fitted later. needs: a set of JOB_NEEDS. cache may be
   NULL. Errors: those of ffd_chain_load. */
ffd_status ffd_deform_job_load_chain(deform_job *job, unsigned needs, const chain_outside *outside,
                                     ffd_job_cache *cache, ffd_error *error);

/* Opens the lattices and the mesh. needs: a set of JOB_NEEDS. */
ffd_status ffd_deform_job_open(deform_job *job, unsigned needs, ffd_job_result *result, ffd_error *error);

/* Loads the weights of the vertices, if any are given, unless they are loaded. The mesh must be one that can
   be deformed (ffd_mesh_check). Errors: those of ffd_vertex_weights_load. */
ffd_status ffd_deform_job_load_weights(deform_job *job, ffd_error *error);

/* Deforms the vertices, fills result with the figures and judges them. The document can be saved
   afterwards. */
ffd_status ffd_deform_job_run(deform_job *job, ffd_job_result *result, ffd_error *error);

/* Frees the job's memory, stores the outcome in result and in *error (may be NULL), and returns it. */
ffd_status ffd_deform_job_end(deform_job *job, ffd_status status, ffd_job_result *result, ffd_error *error);

/* Runs a call of `ffd deform` that has begun; its failure is in call->result. animation: NULL: none
   (deform.c). */
ffd_status ffd_deform_call(job_call *call, job_animation *animation);

/* Fills desc->output_list with the names of the files that a job writes, without doing it; the mesh is opened
   through desc->cache (deform.c). Errors: those of opening the mesh and the lattices, and of the checks of
   outputs. */
ffd_status ffd_deform_list_outputs(const ffd_deform_desc *desc, ffd_error *error);

#endif
