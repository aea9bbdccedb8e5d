/* gltf_vrm.h - the nodes that extensions of VRM name at the top of a file, and node constraints. */
#ifndef FFD_IO_GLTF_RIG_GLTF_VRM_H
#define FFD_IO_GLTF_RIG_GLTF_VRM_H

#include "io/gltf/document/gltf_document.h"

/* What a node is for VRM. */
typedef enum gltf_vrm_role {
    VRM_COLLIDER,
    VRM_SPRING,      /* a joint of a spring (VRMC_springBone) */
    VRM_SPRING_ROOT, /* it and all below it are such (VRM 0.x) */
    VRM_BONE,        /* of the humanoid: what poses it is not in the file */
    VRM_EYES,        /* the offset of the eyes, which the file has, is from this bone */
    VRM_DRIVEN,      /* a constraint turns it; */
    VRM_AIM,         /* towards another node */
    VRM_NAMED        /* what springs are seen from, a constraint looks at, the first person does not show */
} gltf_vrm_role;

typedef void gltf_vrm_visitor(void *context, size_t node, gltf_vrm_role role);

/* Calls visit for every node and role that the file names, perhaps more than once. */
void ffd_gltf_visit_vrm(const gltf_document *document, gltf_vrm_visitor *visit, void *context);

/* Notes the values that should name a node and do not. Errors: those of a flaw. */
ffd_status ffd_gltf_check_vrm(gltf_document *document, ffd_error *error);

#endif
