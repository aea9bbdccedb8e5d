/* gltf_skeleton.h - the animations of a glTF file in the format-independent form of mesh/rig.h.
   gltf_anchors.c has ffd_gltf_read_anchors, and gltf_followed.c ffd_gltf_follow_transforms,
   ffd_gltf_follow_keys and ffd_gltf_skeleton_binds. */
#ifndef FFD_IO_GLTF_GLTF_SKELETON_H
#define FFD_IO_GLTF_GLTF_SKELETON_H

#include "io/gltf/model/gltf_pose.h"
#include "mesh/rig.h"

typedef struct gltf_skeleton {
    mesh_skeleton base;
    gltf_document *document;
    gltf_animations animations;
    gltf_pose pose;
    bool follows;      /* whether it is that of the deformed mesh, whose nodes have moved (io/gltf/edit) */
    gltf_node *nodes;  /* per node, if it follows: its default transform; NULL: the file's */
    size_t *places;    /* per node of the file: its index in base.nodes; GLTF_NONE: not there */
    size_t *order;     /* per element of base.nodes: the node of the file */
    size_t *node_bone; /* per node of the file: the bone of its own vertices; GLTF_NONE: none */
    size_t *skin_bone; /* per skin: the bone of its first joint; GLTF_NONE: the skin is not used */
    /* Per skin: the matrix that takes its vertices to their places at rest, or near them. */
    double *skin_rest;
    uint64_t taken; /* bytes of the document's memory budget */
} gltf_skeleton;

/* Takes memory from the document's budget until the skeleton is freed. Errors: FFD_E_LIMIT. */
static inline ffd_status ffd_gltf_skeleton_take(gltf_skeleton *skeleton, uint64_t count, uint64_t size,
                                                ffd_error *error)
{
    memory_budget *const budget = &skeleton->document->base.budget;
    const uint64_t before = budget->taken;
    const ffd_status status = ffd_budget_take(budget, count, size, error);
    skeleton->taken += budget->taken - before;
    return status;
}

/* Returns the world matrix of a node in the default pose, 12 numbers. */
const double *ffd_gltf_skeleton_world(const gltf_skeleton *skeleton, size_t node);

/* Makes skeleton->nodes, if the skeleton follows. Errors: FFD_E_MEMORY. */
ffd_status ffd_gltf_follow_transforms(gltf_skeleton *skeleton, ffd_error *error);
/* Replaces the loaded keys of an animation by those of the rig that follows. Errors: FFD_E_LIMIT,
   FFD_E_MEMORY. */
ffd_status ffd_gltf_follow_keys(gltf_skeleton *skeleton, size_t animation, ffd_error *error);
/* Reads the inverse bind matrices of a skin, 12 numbers each; the changed ones, if the skeleton follows.
   unmoved: the identity for each node. Errors: FFD_E_INVALID. */
ffd_status ffd_gltf_skeleton_binds(const gltf_skeleton *skeleton, size_t skin, const double *unmoved,
                                   double *binds, ffd_error *error);

#endif
