/* view_pose.h - a scene's vertices at a time of an animation. */
#ifndef FFD_VIEW_VIEW_POSE_H
#define FFD_VIEW_VIEW_POSE_H

#include "view/view_scene.h"

/* Computes where the vertices before (side 0) or after (1) are, 3 numbers each; where the side has no
   skeleton or not this animation (of scene->animations), where they are at rest. Errors: FFD_E_MEMORY. */
ffd_status ffd_view_pose(const view_scene *scene, int side, size_t animation, double time, double **positions,
                         ffd_error *error);

#endif
