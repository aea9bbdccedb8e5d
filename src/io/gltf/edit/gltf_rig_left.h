/* gltf_rig_left.h - skinned meshes that stay as they are, although joints of theirs have moved. */
#ifndef FFD_IO_GLTF_EDIT_GLTF_RIG_LEFT_H
#define FFD_IO_GLTF_EDIT_GLTF_RIG_LEFT_H

#include "io/gltf/edit/gltf_rig.h"

/* Finds the largest distance by which a joint has moved that has a weight in a vertex of a part; 0 if the
   part is selected, has no skin, or no such joint has moved. Call it after ffd_gltf_follow_skins. Errors:
   FFD_E_MEMORY. */
ffd_status ffd_gltf_left_by_joints(const gltf_document *document, const gltf_rig *rig, size_t part,
                                   double *distance, ffd_error *error);

#endif
