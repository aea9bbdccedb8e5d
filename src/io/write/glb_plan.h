/* glb_plan.h - a model as glTF has it: a mesh for each object and group, in it a primitive for each material
   and each set of attributes, and vertices that have one normal and one texture coordinate each. */
#ifndef FFD_IO_WRITE_GLB_PLAN_H
#define FFD_IO_WRITE_GLB_PLAN_H

#include "mesh/model.h"

typedef struct glb_primitive {
    uint32_t mesh, material; /* material: MODEL_NONE: none */
    model_kind kind;
    bool normals, texcoords;
    size_t first_vertex, vertex_count; /* in plan->vertices */
    size_t first_index, index_count;   /* in plan->indices; points have none */
    size_t elements;                   /* of the model */
} glb_primitive;

typedef struct glb_plan {
    const mesh_model *model;
    intern_table meshes;    /* keys: object and group, uint32_t each */
    intern_table materials; /* keys: a name's number */
    glb_primitive *primitives;
    size_t primitive_count;
    uint32_t *by_mesh; /* the primitives in the order of their meshes */
    model_corner *vertices;
    size_t vertex_count;
    uint32_t *indices; /* each counts from its primitive's first vertex */
    size_t index_count;
    uint64_t hurried_polygons; /* as polygon_cutter has them */
    bool *morphed; /* of each mesh and morph target of the model: all primitives of the mesh have it */
} glb_plan;

/* Whether a primitive has a morph target of the model. */
static inline bool glb_has_morph(const glb_plan *plan, const glb_primitive *primitive, size_t morph)
{
    return plan->morphed[primitive->mesh * plan->model->morph_count + morph];
}

/* Errors: FFD_E_LIMIT, FFD_E_MEMORY. Must be freed in every case. */
ffd_status ffd_glb_make_plan(const mesh_model *model, glb_plan *plan, ffd_error *error);
/* Frees the arrays of a plan. */
void ffd_glb_free_plan(glb_plan *plan);

#endif
