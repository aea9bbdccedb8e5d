/* view_mesh.h - the geometry of what is shown, out of a model and the places its vertices go to. */
#ifndef FFD_JOB_VIEW_VIEW_MESH_H
#define FFD_JOB_VIEW_VIEW_MESH_H

#include "mesh/mesh_log.h"
#include "mesh/model.h"
#include "view/view_scene.h"

/* Fills the scene's vertices, triangles, lines, points and parts; what the scene keeps is taken out of the
   model. faces: filled with the number of the polygon that each triangle was cut from,
   scene->triangle_count of them; the caller's to free. log: gets a warning of polygons whose triangles may
   overlap. Errors: FFD_E_LIMIT (more triangles than 32 bits can number the corners of, or the model's memory
   budget), FFD_E_MEMORY. */
ffd_status ffd_view_take_mesh(mesh_model *model, view_scene *scene, uint32_t **faces, const mesh_log *log,
                              ffd_error *error);

/* Fills where the vertices go. deformed: 3 numbers a vertex of the document, in the order of `ffd embed`. A
   vertex without a place there (NaN: its transform has no inverse) stays. NULL: all stay. Errors:
   FFD_E_LIMIT (the model's memory budget), FFD_E_MEMORY. */
ffd_status ffd_view_place_after(const mesh_model *model, const double *deformed, view_scene *scene,
                                ffd_error *error);

#endif
