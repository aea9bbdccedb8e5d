/* gltf_model.h - what the program uses of a glTF file, in plain C. gltf_tinygltf.cpp or tinygltf_load.c fills
   it. Indices are -1 if absent. */
#ifndef FFD_IO_GLTF_READ_GLTF_MODEL_H
#define FFD_IO_GLTF_READ_GLTF_MODEL_H

#include "base/fail.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef enum gltf_component {
    GLTF_I8 = 5120,
    GLTF_U8 = 5121,
    GLTF_I16 = 5122,
    GLTF_U16 = 5123,
    GLTF_U32 = 5125,
    GLTF_FLOAT = 5126
} gltf_component;

/* The attributes that a deformation changes. All other attributes are GLTF_OTHER; once found, those of splats
   that can be changed are GLTF_SPLAT. */
typedef enum gltf_semantic { GLTF_POSITION, GLTF_NORMAL, GLTF_TANGENT, GLTF_OTHER, GLTF_SPLAT } gltf_semantic;
#define GLTF_DEFORMED 3 /* the number of vector attributes */

/* The largest size that a file may state: exact in a double, and not more than this machine can address. */
#define GLTF_LARGEST_SIZE ((size_t)(SIZE_MAX < UINT64_C(1) << 53 ? SIZE_MAX : UINT64_C(1) << 53))

/* What a primitive draws. MODE_UNKNOWN: its mode or its indices are not valid; it then has no indices. */
enum {
    MODE_POINTS,
    MODE_LINES,
    MODE_LINE_LOOP,
    MODE_LINE_STRIP,
    MODE_TRIANGLES,
    MODE_STRIP,
    MODE_FAN,
    MODE_UNKNOWN
};

typedef struct gltf_view {
    int buffer;
    uint64_t offset, length;
    uint64_t stride; /* 0: not stated */
} gltf_view;

typedef struct gltf_sparse {
    bool present;
    uint64_t count;
    int indices_view, values_view;
    uint64_t indices_offset, values_offset;
    int indices_type;
} gltf_sparse;

typedef struct gltf_accessor {
    int view;
    uint64_t offset, count;
    int component;     /* gltf_component */
    int columns, rows; /* VEC3: 1 column, 3 rows; MAT4: 4 columns, 4 rows */
    bool normalized;
    gltf_sparse sparse;
} gltf_accessor;

typedef struct gltf_attribute {
    gltf_semantic semantic;
    int accessor;
} gltf_attribute;

/* The accessors of JOINTS_n and WEIGHTS_n for one n; -1 if only the other exists. */
typedef struct gltf_influence {
    int joints, weights;
} gltf_influence;

typedef struct gltf_primitive {
    size_t mesh, index;          /* it is primitive `index` of its mesh */
    uint32_t value;              /* its JSON object. Set after parsing */
    int accessor[GLTF_DEFORMED]; /* of POSITION, NORMAL, TANGENT */
    gltf_attribute *attributes;  /* all attributes */
    size_t attribute_count;
    gltf_attribute *targets; /* the attributes of all morph targets */
    size_t target_attribute_count, target_count;
    int *target_accessors; /* GLTF_DEFORMED per target */
    /* Attributes of Gaussian splats, GLTF_DEFORMED per group, -1 where a group has fewer. Set after parsing,
       for splats that can be changed. */
    int *splat_accessors;
    size_t splat_groups;
    gltf_influence *influences; /* for n = 0, 1, .. as long as either exists */
    size_t influence_count;
    int indices, mode;
    /* The vertices that it draws in this mode, where the file's indices restart; NULL: the file's. Set after
       parsing. */
    uint32_t *drawn;
    size_t drawn_count;
} gltf_primitive;

/* Finds the vertices of triangle t among a primitive's corners. Every second triangle of a strip is reversed
   (glTF 2.0, 3.7.2.1). */
static inline void gltf_triangle(int mode, size_t t, const uint32_t *corners, uint32_t triangle[3])
{
    const size_t first = mode == MODE_TRIANGLES ? 3 * t : mode == MODE_FAN ? 0 : t;
    const size_t second = mode == MODE_TRIANGLES ? first + 1 : mode == MODE_FAN ? t + 1 : t + 1 + t % 2;
    const size_t third = mode == MODE_TRIANGLES ? first + 2 : mode == MODE_FAN ? t + 2 : t + 2 - t % 2;
    triangle[0] = corners[first];
    triangle[1] = corners[second];
    triangle[2] = corners[third];
}

/* Slots number the deformed attributes of a primitive: slot s is its own attribute of semantic s, slot
   GLTF_DEFORMED * (t + 1) + s that of its morph target t. The slots of splats follow. */
static inline size_t gltf_vector_slots(const gltf_primitive *primitive)
{
    return GLTF_DEFORMED * (1 + primitive->target_count);
}

static inline size_t gltf_slot_count(const gltf_primitive *primitive)
{
    return gltf_vector_slots(primitive) + GLTF_DEFORMED * primitive->splat_groups;
}

static inline int gltf_slot_accessor(const gltf_primitive *primitive, size_t slot)
{
    if (slot >= gltf_vector_slots(primitive))
        return primitive->splat_accessors[slot - gltf_vector_slots(primitive)];
    return slot < GLTF_DEFORMED ? primitive->accessor[slot]
                                : primitive->target_accessors[slot - GLTF_DEFORMED];
}

typedef struct gltf_mesh {
    gltf_primitive *primitives; /* among those of the model */
    size_t primitive_count;
} gltf_mesh;

typedef struct gltf_node {
    int mesh, skin;
    int *children;
    size_t child_count;
    bool has_matrix;
    double matrix[16]; /* column by column, as in the file */
    double translation[3], rotation[4], scale[3];
} gltf_node;

typedef struct gltf_scene {
    int *nodes;
    size_t node_count;
} gltf_scene;

typedef struct gltf_model {
    gltf_view *views;
    size_t view_count;
    gltf_accessor *accessors;
    size_t accessor_count;
    gltf_mesh *meshes;
    size_t mesh_count;
    gltf_primitive *primitives; /* of all meshes, in order */
    size_t primitive_count;
    gltf_node *nodes;
    size_t node_count;
    gltf_scene *scenes;
    size_t scene_count;
    int scene; /* the default scene */
} gltf_model;

#ifdef __cplusplus
extern "C" {
#endif

/* Parses JSON text (with stubs for buffers, without images) with tinygltf, which opens no file. Throws no
   exception. After a failure the model is empty. Errors: FFD_E_INVALID with tinygltf's message,
   FFD_E_UNSUPPORTED (no library), FFD_E_MEMORY. */
ffd_status ffd_gltf_parse_model(const char *text, size_t size, const char *name, gltf_model *model,
                                ffd_error *error);

/* Frees the model's arrays and empties it. */
void ffd_gltf_free_model(gltf_model *model);

#ifdef __cplusplus
}
#endif

#endif
