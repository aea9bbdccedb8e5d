/* gltf_plan.h - where the results go: in the bytes of their accessors where all that uses these bytes wants
   the same, else into accessors (and meshes that use them) appended at the end. */
#ifndef FFD_IO_GLTF_SAVE_GLTF_PLAN_H
#define FFD_IO_GLTF_SAVE_GLTF_PLAN_H

#include "io/gltf/document/gltf_document.h"

/* A new content of an accessor. GLTF_NONE in place of its number: the original content. */
typedef struct gltf_version {
    size_t accessor;
    const float *values; /* 3 * count, lent by a part */
    size_t order;        /* of the first part and attribute that has it */
    bool needed;
    int component; /* of its numbers: the accessor's, or GLTF_FLOAT where that does not hold them */
    size_t output; /* the accessor that holds it in the output; GLTF_NONE: none yet */
    bool rebinds;  /* its accessor, one of our own without bytes, gets a bufferView itself */
} gltf_version;

/* A mesh as nodes want it that cannot use the original. */
typedef struct gltf_mesh_copy {
    size_t mesh, use; /* use: the first of those that want it, in the mesh's uses */
} gltf_mesh_copy;

typedef struct gltf_node_change {
    size_t node, copy; /* copy: in plan->copies */
} gltf_node_change;

typedef struct gltf_plan {
    gltf_version *versions;
    size_t version_count;
    size_t *part_versions; /* GLTF_DEFORMED a part, shapes too */
    size_t *base_uses;     /* of a mesh: the node (in its uses) after which the original mesh goes;
                                GLTF_NONE: it   keeps its accessors' content */
    gltf_mesh_copy *copies;
    size_t copy_count;
    gltf_node_change *changes;
    size_t change_count;
    size_t *in_place; /* of an accessor: the version that overwrites it, or GLTF_NONE */
    size_t *appended; /* versions with new bufferViews, in the order of these and of the new accessors */
    size_t appended_count;
} gltf_plan;

/* Returns the version that primitive p of a mesh shows at a place of its uses; GLTF_NONE: the original. */
size_t ffd_gltf_version_at(const gltf_document *document, const gltf_plan *plan, size_t mesh, size_t p,
                           size_t slot, size_t use);

/* Frees the plan's arrays. */
void ffd_gltf_free_plan(gltf_plan *plan);

#endif
