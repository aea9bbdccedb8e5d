/* gltf_vrm.h - finds the nodes that top-level VRM extensions and node constraints refer to. */
#ifndef FFD_IO_GLTF_MODEL_GLTF_VRM_H
#define FFD_IO_GLTF_MODEL_GLTF_VRM_H

#include "io/gltf/read/gltf_document.h"

/* The role of a node in VRM. */
typedef enum gltf_vrm_role {
    VRM_COLLIDER,
    VRM_SPRING,      /* a joint of a spring (VRMC_springBone) */
    VRM_SPRING_ROOT, /* it and all its descendants are spring joints (VRM 0.x) */
    VRM_BONE,        /* a bone of the humanoid; what poses it is not in the file */
    VRM_EYES,        /* the offset of the eyes in the file is relative to this bone */
    VRM_DRIVEN,      /* a constraint turns it */
    VRM_AIM,         /* a constraint turns it to aim at another node */
    VRM_NAMED        /* the center of springs, the source of a constraint, a node hidden in first person */
} gltf_vrm_role;

typedef void gltf_vrm_visitor(void *context, size_t node, gltf_vrm_role role);

/* Calls visit for every node and role that the file names; a pair may be visited more than once. */
void ffd_gltf_visit_vrm(const gltf_document *document, gltf_vrm_visitor *visit, void *context);

/* Notes a flaw for each value that names no node but should. Errors: those of a flaw. */
ffd_status ffd_gltf_check_vrm(gltf_document *document, ffd_error *error);

#endif
