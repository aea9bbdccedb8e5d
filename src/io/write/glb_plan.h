/* glb_plan.h - a model in the form of glTF: a mesh per object and group, in it a primitive per material and
   set of attributes, and vertices with one normal and one texture coordinate each. */
#ifndef FFD_IO_WRITE_GLB_PLAN_H
#define FFD_IO_WRITE_GLB_PLAN_H

#include "mesh/model.h"

typedef struct glb_primitive {
    uint32_t mesh, material; /* material: MODEL_NONE for none */
    model_kind kind;
    bool normals, texcoords;
    size_t first_vertex, vertex_count; /* a range of plan->vertices */
    size_t first_index, index_count;   /* a range of plan->indices; empty for points */
    size_t elements;                   /* number of the model's elements in it */
} glb_primitive;

typedef struct glb_plan {
    const mesh_model *model;
    intern_table meshes;    /* keys: object and group, uint32_t each */
    intern_table materials; /* keys: the number of a name */
    glb_primitive *primitives;
    size_t primitive_count;
    uint32_t *by_mesh; /* primitives sorted by mesh */
    model_corner *vertices;
    size_t vertex_count;
    uint32_t *indices; /* relative to the first vertex of their primitive */
    size_t index_count;
    uint64_t hurried_polygons; /* as in polygon_cutter */
    bool *morphed; /* per mesh and morph target of the model: whether all primitives of the mesh have it */
} glb_plan;

/* Whether a primitive has a morph target of the model. */
static inline bool glb_has_morph(const glb_plan *plan, const glb_primitive *primitive, size_t morph)
{
    return plan->morphed[primitive->mesh * plan->model->morph_count + morph];
}

/* Makes the plan. Free it with ffd_glb_free_plan, after an error too. Errors: FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_glb_make_plan(const mesh_model *model, glb_plan *plan, ffd_error *error);
/* Frees the arrays of a plan. */
void ffd_glb_free_plan(glb_plan *plan);

#endif
