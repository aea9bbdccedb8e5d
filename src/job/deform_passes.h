/* deform_passes.h - the passes of a job over its mesh. Default weights of morph targets may show another
   shape than the base. The figures are then those of the shape shown, and base and targets get a pass of
   their own. */
#ifndef FFD_JOB_DEFORM_PASSES_H
#define FFD_JOB_DEFORM_PASSES_H

#include "job/measure/figures.h"
#include "job/measure/job_state.h"
#include "job/pass/mesh_pass.h"

/* Lets a pass over stored vertices use their locations in the only link, if an earlier job or pass has found
   them, or fill them for a later one. for_later: keep them in any case where a second search is slow. */
void ffd_pass_take_locations(deform_job *job, bool for_later, mesh_pass *pass);
/* Notes that the pass has filled them. */
void ffd_pass_keep_locations(deform_job *job, const mesh_pass *pass);

/* Sends the mesh through the chain: fills the results, job->totals, job->positions and the arrays, and
   recomputes normals. figures: of the shape that is judged. stored: of the base, if normals are recomputed
   and the results are of another shape than the figures; else empty. Errors: those of ffd_pass_over_mesh and
   ffd_recompute_normals. */
ffd_status ffd_deform_passes(deform_job *job, const figure_arrays *figures, const figure_arrays *stored,
                             ffd_error *error);

#endif
