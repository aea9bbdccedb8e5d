/* view_pose.h - positions of a scene's vertices at a time of an animation. */
#ifndef FFD_VIEW_VIEW_POSE_H
#define FFD_VIEW_VIEW_POSE_H

#include "view/view_scene.h"

/* Computes the positions of the vertices before (side 0) or after (side 1) the deformation, 3 numbers each,
   at a time in seconds. animation: index in scene->animations. If the side has no skeleton or not this
   animation, these are the positions at rest. *positions is the caller's, freed with ffd_free. Errors:
   FFD_E_MEMORY. */
ffd_status ffd_view_pose(const view_scene *scene, int side, size_t animation, double time, double **positions,
                         ffd_error *error);

/* Returns the linear parts of the matrices that each vertex of a skeleton's document follows at rest, 9
   numbers each, row by row; the caller frees them. NULL: memory ran out, and error says so. */
double *ffd_view_rest_matrices(mesh_skeleton *skeleton, ffd_error *error);

#endif
