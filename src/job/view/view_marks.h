/* view_marks.h - marks of a deformation in a scene: statuses, det F, flipped faces, torn edges, the witness
   of a fold; and the control lattices. */
#ifndef FFD_JOB_VIEW_VIEW_MARKS_H
#define FFD_JOB_VIEW_VIEW_MARKS_H

#include "job/measure/job_state.h"
#include "view/view_scene.h"

/* Fills the marks of a scene that has its mesh. faces: of each triangle the polygon in the model that the
   scene was made from. Errors: FFD_E_MEMORY. */
ffd_status ffd_view_add_marks(const deform_job *job, const ffd_job_result *result, const mesh_model *model,
                              const uint32_t *faces, view_scene *scene, ffd_error *error);
/* Fills the cages. The lattices must be fitted. sources: of the lattices, for their names. Errors:
 * FFD_E_MEMORY. */
ffd_status ffd_view_add_cages(const lattice_chain *chain, const ffd_lattice_source *sources,
                              view_scene *scene, ffd_error *error);
/* Finds the largest displacement of a vertex. */
void ffd_view_measure(view_scene *scene);

#endif
