/* gltf_plan.h - where the results go: into the bytes of their accessors if all users of these bytes
   want the same content, else into new accessors (and copies of meshes that use them) at the end. */
#ifndef FFD_IO_GLTF_SAVE_GLTF_PLAN_H
#define FFD_IO_GLTF_SAVE_GLTF_PLAN_H

#include "io/gltf/document/gltf_document.h"

/* A new content of an accessor. The number GLTF_NONE means the original content. */
typedef struct gltf_version {
    size_t accessor; /* GLTF_NONE: a new one, of MAT4 */
    /* components * count, owned by a part: the first numbers of each element. Of a rig's content: `width`
       numbers an element, all of them, of `count` elements; they are written as floats. */
    const float *values;
    size_t width, count; /* width is 0 otherwise */
    size_t components;
    size_t order; /* of the first part and attribute that has it */
    bool needed;
    int component; /* of its numbers: the accessor's, or GLTF_FLOAT if that cannot represent them */
    size_t output; /* the accessor that holds it in the output; GLTF_NONE: none yet */
    bool rebinds;  /* its accessor, one that we added without bytes, gets a bufferView itself */
} gltf_version;

/* A copy of a mesh for nodes that cannot use the original. */
typedef struct gltf_mesh_copy {
    size_t mesh, use; /* use: the first of those that need the copy */
} gltf_mesh_copy;

typedef struct gltf_node_change {
    size_t node, copy; /* copy: in plan->copies */
} gltf_node_change;

typedef struct gltf_plan {
    gltf_version *versions;
    size_t version_count;
    size_t *part_versions; /* GLTF_DEFORMED per part, shapes too */
    size_t
        *base_uses; /* per mesh: the use whose content the original mesh gets; GLTF_NONE: its old content */
    gltf_mesh_copy *copies;
    size_t copy_count;
    gltf_node_change *changes;
    size_t change_count;
    size_t *rig_versions; /* per content of the document's rig; NULL: it has none */
    size_t *in_place;     /* per accessor: the version that overwrites it, or GLTF_NONE */
    size_t *appended;     /* versions with new bufferViews, in their order */
    size_t appended_count;
} gltf_plan;

/* Returns how many elements a version has. */
static inline size_t ffd_gltf_version_count(const gltf_document *document, const gltf_version *version)
{
    return version->width ? version->count : (size_t)document->model.accessors[version->accessor].count;
}

/* Returns how many numbers an element of it has. */
static inline size_t ffd_gltf_version_numbers(const gltf_document *document, const gltf_version *version)
{
    return version->width ? version->width : (size_t)document->model.accessors[version->accessor].rows;
}

/* Writes element i of a version as its output has it: GLTF_LARGEST_ELEMENT bytes at most. */
void ffd_gltf_version_encode(const gltf_document *document, const gltf_version *version, size_t i,
                             unsigned char *element);

/* Returns the version of a slot of primitive p for a use of its mesh; GLTF_NONE: the original content. */
size_t ffd_gltf_version_at(const gltf_document *document, const gltf_plan *plan, size_t mesh, size_t p,
                           size_t slot, size_t use);

/* Frees the plan's arrays. */
void ffd_gltf_free_plan(gltf_plan *plan);

#endif
