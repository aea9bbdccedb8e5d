/* gltf_plan.h - where the results go: into the bytes of their accessors if all users of these bytes need the
   same content, else into new accessors at the end (and copies of the meshes that use them). Declares
   gltf_plan.c, gltf_make_plan.c and its steps, gltf_join_uses.c and gltf_overlap.c. */
#ifndef FFD_IO_GLTF_WRITE_GLTF_PLAN_H
#define FFD_IO_GLTF_WRITE_GLTF_PLAN_H

#include "io/gltf/read/gltf_document.h"

/* A new content of an accessor. As the index of a version, GLTF_NONE means the original content. */
typedef struct gltf_version {
    size_t accessor; /* GLTF_NONE: a new accessor of MAT4 */
    /* Owned by a part: components * count floats, the first components of each element. Owned by the edit:
       count elements of width numbers, all numbers of each element, stored as floats. */
    const float *values;
    size_t width, count; /* width is 0 if a part owns the values */
    size_t components;
    size_t order; /* index of the first part and attribute with this content */
    bool needed;
    int component; /* the component type: the accessor's, or GLTF_FLOAT if that cannot represent the values */
    size_t output; /* its accessor in the output; GLTF_NONE: none yet */
    bool rebinds;  /* its accessor is one that saving adds: it gets the bufferView of these bytes */
} gltf_version;

/* A copy of a mesh, for nodes that cannot use the original. */
typedef struct gltf_mesh_copy {
    size_t mesh, use; /* use: the first use that needs the copy */
} gltf_mesh_copy;

typedef struct gltf_node_change {
    size_t node, copy; /* copy: index in plan->copies */
} gltf_node_change;

typedef struct gltf_plan {
    gltf_version *versions;
    size_t version_count;
    /* GLTF_DEFORMED per part, also for shapes and splats; GLTF_NONE: original content. */
    size_t *part_versions;
    /* Per mesh: the use whose content the original mesh gets; GLTF_NONE: its old content. */
    size_t *base_uses;
    gltf_mesh_copy *copies;
    size_t copy_count;
    gltf_node_change *changes;
    size_t change_count;
    size_t *content_versions; /* per content of the document's edit */
    size_t *in_place;         /* per accessor: the version that overwrites it, or GLTF_NONE */
    size_t *appended;         /* versions with new bufferViews, in order */
    size_t appended_count;
} gltf_plan;

/* Returns the number of elements of a version. */
static inline size_t ffd_gltf_version_count(const gltf_document *document, const gltf_version *version)
{
    return version->width ? version->count : (size_t)document->model.accessors[version->accessor].count;
}

/* Returns the number of components of its elements. */
static inline size_t ffd_gltf_version_width(const gltf_document *document, const gltf_version *version)
{
    return version->width ? version->width : (size_t)document->model.accessors[version->accessor].rows;
}

/* Writes element i of a version as in the output: at most GLTF_LARGEST_ELEMENT bytes. */
void ffd_gltf_version_encode(const gltf_document *document, const gltf_version *version, size_t i,
                             unsigned char *element);

/* Returns the version of a slot of primitive p for a use of its mesh; GLTF_NONE: the original content. */
size_t ffd_gltf_version_at(const gltf_document *document, const gltf_plan *plan,
                           const gltf_primitive *primitive, size_t slot, size_t use);

/* Frees the plan's arrays. */
void ffd_gltf_free_plan(gltf_plan *plan);

/* Makes the plan. plan->version_count is 0 if no value changed. Errors: FFD_E_MEMORY. */
ffd_status ffd_gltf_make_plan(const gltf_document *document, gltf_plan *plan, ffd_error *error);

/* Uses of a mesh that see the same bits. */
typedef struct gltf_use_group {
    size_t use, rank; /* the first use in the scene and its rank; SIZE_MAX: no use */
    size_t leader;    /* the group whose bits it gets */
    /* If it is a leader: the copy, counted from first_copy, that gets its bits; GLTF_NONE: the mesh
       itself. */
    size_t target;
    size_t copy; /* if it is a target: the new index of its copy in the plan */
} gltf_use_group;

/* Joins the mesh and its copies (plan->copies from first_copy on) where their results agree: each coordinate
   within 1 ulp in the file's type (for a direction, 1 ulp of its length) plus the rounding of the double
   computation. A mirrored half, for example, need not have the same bits as its original. A vector that stays
   in one use agrees only with vectors that move by no more than the rounding in double, so that it keeps its
   bits. The bits are those of the use that comes first in the scene. groups and order: room for one more than
   the number of copies. */
void ffd_gltf_join_uses(const gltf_document *document, size_t mesh, size_t first_copy, size_t first_change,
                        gltf_plan *plan, gltf_use_group *groups, size_t *order);

/* Withdraws the in-place versions that would change bytes which another user needs unchanged. Errors:
   FFD_E_MEMORY. */
ffd_status ffd_gltf_resolve_overlaps(const gltf_document *document, gltf_plan *plan, ffd_error *error);

#endif
