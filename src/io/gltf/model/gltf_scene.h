/* gltf_scene.h - finds the nodes in the displayed scene, those that KHR_node_visibility hides, and their
   world matrices. */
#ifndef FFD_IO_GLTF_MODEL_GLTF_SCENE_H
#define FFD_IO_GLTF_MODEL_GLTF_SCENE_H

#include "io/gltf/read/gltf_document.h"

/* Fills document->world, in_scene, scene_ranks, parents, stands_in, collides and mesh_uses. Errors:
   FFD_E_INVALID (a cycle, a root that is a child, a matrix that is not finite), FFD_E_MEMORY. */
ffd_status ffd_gltf_make_scene(gltf_document *document, ffd_error *error);

/* Returns the use of a mesh by a node; uses->node_count if the scene does not show it there. */
size_t ffd_gltf_find_use(const gltf_mesh_uses *uses, size_t node);

/* Reads a node's local matrix: the linear part row by row, and the offset. */
void ffd_gltf_local_matrix(const gltf_node *node, double linear[9], double offset[3]);

/* joined = parent * (linear, offset); parent and joined have 12 numbers: the linear part row by row, then the
   offset. */
void ffd_gltf_join_matrix(const double parent[12], const double linear[9], const double offset[3],
                          double joined[12]);

#endif
