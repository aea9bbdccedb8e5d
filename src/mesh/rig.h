/* rig.h - what moves a mesh over time: nodes, the animations that drive them, and which of them each vertex
   follows. A format makes a skeleton of a document that is open; what the mesh is in it, at rest or deformed,
   are its anchors.

   A vertex is at the sum of weight * world(node) * bind * anchor over the bones that it follows, where
   world(node) is the matrix of a bone's node at some time. Matrices have 12 numbers: linear row by row, and
   offset. */
#ifndef FFD_MESH_RIG_H
#define FFD_MESH_RIG_H

#include "base/fail.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define RIG_NONE SIZE_MAX

typedef enum rig_path { RIG_TRANSLATION, RIG_ROTATION, RIG_SCALE, RIG_WEIGHTS } rig_path;
typedef enum rig_interpolation { RIG_STEP, RIG_LINEAR, RIG_CUBICSPLINE } rig_interpolation;

typedef struct rig_node {
    size_t parent; /* before it in the list; RIG_NONE: none */
    bool is_joint; /* of a skin */
    bool has_matrix;
    double matrix[12];
    double translation[3], rotation[4], scale[3]; /* rotation: a quaternion x,y,z,w */
} rig_node;

typedef struct rig_bone {
    size_t node;
    double bind[12];
} rig_bone;

/* A vertex follows a bone by this share. */
typedef struct rig_influence {
    uint32_t bone;
    float weight; /* those of a vertex sum to 1 */
} rig_influence;

/* Keys that drive a node; times and values as gltf_animation.h has them. */
typedef struct rig_channel {
    size_t node;         /* with RIG_WEIGHTS: RIG_NONE */
    size_t first_weight; /* of the skeleton's weights, with RIG_WEIGHTS */
    rig_path path;
    rig_interpolation interpolation;
    size_t key_count, width;
    const double *times, *values; /* lent by the skeleton */
    size_t input;                 /* channels with the same number have the same times */
} rig_channel;

typedef struct rig_animation {
    const char *name; /* as the file has it; NULL: none */
    double begin, end;
    rig_channel *channels; /* of what is seen; NULL until it is loaded */
    size_t channel_count;
    size_t left; /* channels that drive something else, or nothing, and are left out */
} rig_animation;

typedef struct mesh_skeleton mesh_skeleton;
struct mesh_skeleton {
    rig_node *nodes; /* those that something seen follows, and their parents */
    size_t node_count;
    double *weights; /* of morph targets, by default */
    size_t weight_count;
    rig_bone *bones;
    size_t bone_count;
    rig_animation *animations;
    size_t animation_count;
    /* Vertex v of the document follows influences starts[v] up to starts[v + 1]. Both NULL where there are no
       animations. */
    size_t *starts;
    rig_influence *influences;
    size_t vertex_count;

    /* Loads the keys of an animation. Errors: FFD_E_INVALID, FFD_E_UNSUPPORTED, FFD_E_LIMIT, FFD_E_MEMORY. */
    ffd_status (*load)(mesh_skeleton *skeleton, size_t animation, ffd_error *error);
    /* Computes the matrices of all nodes and the weights at a time of an animation that is loaded; RIG_NONE:
       as the file shows them by default. One thread at a time. */
    void (*pose)(mesh_skeleton *skeleton, size_t animation, double time, double *worlds, double *weights);
    void (*free)(mesh_skeleton *skeleton);
};

/* Where a morph target brings anchors: weight - its default times the offset is added. */
typedef struct rig_target {
    size_t first, count; /* vertices of the document */
    size_t weight;       /* of the skeleton's weights */
    double *offsets;     /* 3 each */
} rig_target;

/* The mesh in a skeleton. */
typedef struct mesh_anchors {
    double *points; /* 3 a vertex of the document */
    rig_target *targets;
    size_t target_count;
    bool keeps_offsets; /* the targets' offsets could not be deformed, and are those at rest */
} mesh_anchors;

#endif
