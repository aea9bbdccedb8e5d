/* gltf_joints.h - which joints the vertices of a skin follow. */
#ifndef FFD_IO_GLTF_MODEL_GLTF_JOINTS_H
#define FFD_IO_GLTF_MODEL_GLTF_JOINTS_H

#include "io/gltf/read/gltf_document.h"

/* Fills the share of the marked nodes in each vertex of a part with a skin: their weights, divided by the sum
   of all. A vertex whose weights sum to 0 follows its first joint (gltf_skin.c). Errors: those of the
   deadline. */
ffd_status ffd_gltf_joint_shares(const gltf_document *document, size_t part, const bool *is_marked,
                                 double *shares, ffd_error *error);

/* Fills the node of the joint that each vertex of such a part follows with more than half of its weight, or
   UINT32_MAX. blends: set for nodes that such a vertex does not follow alone; or NULL. Errors: those of the
   deadline. */
ffd_status ffd_gltf_leading_joints(const gltf_document *document, size_t part, uint32_t *nodes, bool *blends,
                                   ffd_error *error);

#endif
