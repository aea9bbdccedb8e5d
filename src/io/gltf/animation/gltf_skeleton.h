/* gltf_skeleton.h - a file's animations as any format has them (mesh/rig.h). gltf_anchors.c has
   ffd_gltf_read_anchors, gltf_influences.c ffd_gltf_make_influences. */
#ifndef FFD_IO_GLTF_ANIMATION_GLTF_SKELETON_H
#define FFD_IO_GLTF_ANIMATION_GLTF_SKELETON_H

#include "io/gltf/animation/gltf_pose.h"
#include "mesh/rig.h"

typedef struct gltf_skeleton {
    mesh_skeleton base;
    gltf_document *document;
    gltf_animations animations;
    gltf_pose pose;
    size_t *places;    /* of each node of the file in base.nodes; GLTF_NONE: it is not there */
    size_t *order;     /* of each of base.nodes: the node of the file */
    size_t *node_bone; /* of each node of the file: the bone of its own vertices; GLTF_NONE: none */
    size_t *skin_bone; /* of each skin: the bone of its first joint; GLTF_NONE: it is not used */
    double *skin_rest; /* of each skin: what takes its vertices to where they are at rest, or near there */
    uint64_t taken;    /* of the document's budget */
} gltf_skeleton;

/* mesh_format's read_skeleton and read_anchors. */
mesh_read_skeleton_function ffd_gltf_read_skeleton;
mesh_read_anchors_function ffd_gltf_read_anchors;

/* Takes memory from the document's budget until the rig is freed. Errors: FFD_E_LIMIT. */
ffd_status ffd_gltf_skeleton_take(gltf_skeleton *rig, uint64_t count, uint64_t size, ffd_error *error);

/* Fills the skeleton's influences. Errors: FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_gltf_make_influences(gltf_skeleton *rig, ffd_error *error);

#endif
