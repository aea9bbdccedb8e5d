/* rig.h - the animation of a mesh: nodes, the animations that drive them, and the nodes that each vertex
   follows. A format makes the skeleton of an open document; the anchors are the mesh in that skeleton, at
   rest or deformed.

   The position of a vertex is the sum of weight * world(node) * bind * anchor over the bones that it follows;
   world(node) is the matrix of a bone's node at some time. Matrices have 12 numbers: linear (row-major) and
   offset. */
#ifndef FFD_MESH_RIG_H
#define FFD_MESH_RIG_H

#include "mesh/mesh.h"

#define RIG_NONE SIZE_MAX

typedef enum rig_path { RIG_TRANSLATION, RIG_ROTATION, RIG_SCALE, RIG_WEIGHTS } rig_path;
typedef enum rig_interpolation { RIG_STEP, RIG_LINEAR, RIG_CUBICSPLINE } rig_interpolation;

typedef struct rig_node {
    size_t parent; /* index of the parent, which comes before it in the list; RIG_NONE: none */
    bool is_joint; /* of a skin */
    bool has_matrix;
    double matrix[12];
    double translation[3], rotation[4], scale[3]; /* rotation: a quaternion x,y,z,w */
} rig_node;

typedef struct rig_bone {
    size_t node;
    double bind[12];
} rig_bone;

/* The weight by which a vertex follows a bone. */
typedef struct rig_influence {
    uint32_t bone;
    float weight; /* the weights of a vertex sum to 1 */
} rig_influence;

/* The keys that drive a property of a node; times and values as in gltf_animation.h. */
typedef struct rig_channel {
    size_t node;         /* RIG_NONE for RIG_WEIGHTS */
    size_t first_weight; /* for RIG_WEIGHTS: index in the weights of the skeleton */
    rig_path path;
    rig_interpolation interpolation;
    size_t key_count, width;
    const double *times, *values; /* belong to the skeleton */
    size_t input;                 /* channels with the same input have the same times */
} rig_channel;

typedef struct rig_animation {
    const char *name; /* as in the file; NULL: none */
    double begin, end;
    rig_channel *channels; /* channels of visible things; NULL until loaded */
    size_t channel_count;
    size_t left; /* number of channels that drive something else, or nothing, and are left out */
} rig_animation;

typedef struct mesh_skeleton mesh_skeleton;
struct mesh_skeleton {
    rig_node *nodes; /* nodes that visible things follow, and their parents */
    size_t node_count;
    double *weights; /* default weights of morph targets */
    size_t weight_count;
    rig_bone *bones;
    size_t bone_count;
    rig_animation *animations;
    size_t animation_count;
    /* Vertex v of the document has the influences starts[v] .. starts[v+1]-1. Both are NULL if there are no
       animations. */
    size_t *starts;
    rig_influence *influences;
    size_t vertex_count;

    /* Loads the keys of an animation. Errors: FFD_E_INVALID, FFD_E_UNSUPPORTED, FFD_E_LIMIT, FFD_E_MEMORY. */
    ffd_status (*load)(mesh_skeleton *skeleton, size_t animation, ffd_error *error);
    /* Computes the matrices of all nodes and the weights at a time of a loaded animation; RIG_NONE: the
       default pose of the file. One thread at a time. */
    void (*pose)(mesh_skeleton *skeleton, size_t animation, double time, double *worlds, double *weights);
    void (*free)(mesh_skeleton *skeleton);
};

/* The effect of a morph target on anchors: adds (weight - default weight) * offset. */
typedef struct rig_target {
    size_t first, count; /* range of vertices of the document */
    size_t weight;       /* index in the weights of the skeleton */
    double *offsets;     /* 3 each */
} rig_target;

/* The anchors of a mesh in a skeleton. */
typedef struct mesh_anchors {
    double *points; /* 3 for each vertex of the document */
    rig_target *targets;
    size_t target_count;
    bool keeps_offsets; /* the offsets of targets could not be deformed, and are those at rest */
} mesh_anchors;

/* Makes the skeleton of a document with animations or skins, without loading keys. It must be destroyed
   before the document is closed. after: the skeleton of the deformed mesh, as follow (places.h) has moved
   it. *skeleton is NULL if there is none. Errors: FFD_E_LIMIT, FFD_E_MEMORY. */
typedef ffd_status mesh_read_skeleton_function(mesh_document *document, bool after, mesh_skeleton **skeleton,
                                               ffd_error *error);
/* Fills anchors, which the caller frees in every case, with the vertices of the file, or with the results
   of a deformation. The targets are those that loaded animations drive. Errors: FFD_E_LIMIT, FFD_E_MEMORY. */
typedef ffd_status mesh_read_anchors_function(const mesh_skeleton *skeleton, mesh_state state, bool after,
                                              mesh_anchors *anchors, ffd_error *error);

struct mesh_rig_calls {
    mesh_read_skeleton_function *read_skeleton;
    mesh_read_anchors_function *read_anchors;
};

#endif
