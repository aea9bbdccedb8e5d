/* view_marks.h - where a deformation went well or wrong: statuses, det F, flipped faces, torn edges, the
   fold's witness; and the lattices themselves. */
#ifndef FFD_JOB_VIEW_VIEW_MARKS_H
#define FFD_JOB_VIEW_VIEW_MARKS_H

#include "job/judge/job_state.h"
#include "view/view_scene.h"

/* Fills the marks of the scene, whose mesh is there, from what a job has found. faces: the polygon of each
   triangle, of the model that the scene was made of. Errors: FFD_E_MEMORY. */
ffd_status ffd_view_add_marks(const deform_job *job, const ffd_job_result *result, const mesh_model *model,
                              const uint32_t *faces, view_scene *scene, ffd_error *error);
/* Fills the cages, of lattices that are fitted. Errors: FFD_E_MEMORY. */
ffd_status ffd_view_add_cages(const lattice_chain *chain, const char *const *names, view_scene *scene,
                              ffd_error *error);
/* Finds the largest displacement of a vertex. */
void ffd_view_measure(view_scene *scene);

#endif
