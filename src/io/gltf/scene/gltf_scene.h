/* gltf_scene.h - which nodes are in the displayed scene, and their matrices. */
#ifndef FFD_IO_GLTF_SCENE_GLTF_SCENE_H
#define FFD_IO_GLTF_SCENE_GLTF_SCENE_H

#include "io/gltf/document/gltf_document.h"

/* Fills document->world, in_scene, scene_ranks, parents, stands_in and mesh_uses. Errors: FFD_E_INVALID (a
   cycle, a root that is a child, a matrix that is not finite), FFD_E_MEMORY. */
ffd_status ffd_gltf_make_scene(gltf_document *document, ffd_error *error);

/* The use of a mesh by a node; uses->node_count where the scene does not show it. */
size_t ffd_gltf_find_use(const gltf_mesh_uses *uses, size_t node);

/* Reads the node's own matrix: linear row by row, and offset. */
void ffd_gltf_local_matrix(const gltf_node *node, double linear[9], double offset[3]);

/* joined = parent * (linear, offset); parent and joined have 12 numbers each, linear
   row by row and offset. */
void ffd_gltf_join_matrix(const double parent[12], const double linear[9], const double offset[3],
                          double joined[12]);

#endif
