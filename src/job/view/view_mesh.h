/* view_mesh.h - makes a scene's geometry from a model and its deformed positions. */
#ifndef FFD_JOB_VIEW_VIEW_MESH_H
#define FFD_JOB_VIEW_VIEW_MESH_H

#include "mesh/mesh_log.h"
#include "mesh/model.h"
#include "view/view_scene.h"

/* Fills the scene's vertices, triangles, segments, points and parts. Arrays that the scene keeps are moved
   out of the model. faces: filled with the polygon of each triangle, scene->triangle_count numbers; freed by
   the caller. log: gets a warning of polygons whose triangles may overlap. Errors: FFD_E_LIMIT (more triangle
   corners than 32 bits can number, or the model's memory budget), FFD_E_MEMORY. */
ffd_status ffd_view_take_mesh(mesh_model *model, view_scene *scene, uint32_t **faces, const mesh_log *log,
                              ffd_error *error);

/* Fills the positions after. deformed: 3 numbers for each vertex of the document after, in the order of `ffd
   embed`; NULL: no vertex moves. A vertex whose entry is NaN (its transform has no inverse) stays. Errors:
   FFD_E_LIMIT (the model's memory budget), FFD_E_MEMORY. */
ffd_status ffd_view_place_after(const mesh_model *model, const double *deformed, view_scene *scene,
                                ffd_error *error);

#endif
