/* gltf_pose.h - the nodes of a file at a time of an animation: their transforms, world matrices and morph
   target weights; the values of an animation's samplers (glTF 2.0, appendix C). */
#ifndef FFD_IO_GLTF_MODEL_GLTF_POSE_H
#define FFD_IO_GLTF_MODEL_GLTF_POSE_H

#include "io/gltf/model/gltf_animation.h"

/* Evaluates a sampler whose keys are loaded, and writes sampler->width numbers. Before the first key and
   after the last one the value is that key's; at a key it has the bits of the key's value. is_rotation:
   LINEAR turns along the shorter arc, and the result of CUBICSPLINE is normalized. The bits are the same on
   every processor. */
void ffd_gltf_sample(const gltf_animation_sampler *sampler, bool is_rotation, double time, double *value);

/* Interpolates between the rotations a and b along the shorter arc, by the fraction t; quaternions
   x,y,z,w. */
void ffd_gltf_slerp(const double a[4], const double b[4], double t, double turned[4]);

typedef struct gltf_pose {
    const gltf_node *rest; /* per node: its default transform, lent; NULL: the file's */
    gltf_node *nodes;      /* per node: its local transform; the lists of children are the model's */
    double *world;         /* per node, as in gltf_document */
    double *weights;       /* of all nodes, see first_weight */
    /* node_count + 1: node n's weights are from first_weight[n] to before first_weight[n + 1]. */
    size_t *first_weight;
    size_t *order;      /* nodes, parents before children */
    size_t order_count; /* less than the number of nodes where the file's nodes do not form a forest */
} gltf_pose;

/* Makes the default pose of a document that is open in scene space. Free it with ffd_gltf_free_pose, after an
   error too. Errors: FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_gltf_make_pose(const gltf_document *document, gltf_pose *pose, ffd_error *error);
/* Frees a pose and empties it. */
void ffd_gltf_free_pose(gltf_pose *pose);

/* Sets a pose to an animation (loaded; NULL: the default pose) at a time in seconds. If two channels drive
   the same property, the last one counts. The matrix of an animated node is decomposed into translation,
   rotation and scale first, as in viewers. */
void ffd_gltf_set_pose(const gltf_document *document, const gltf_animation *animation, double time,
                       gltf_pose *pose);

/* Decomposes the matrix of a node into translation, rotation and scale, as viewers do; the node then has no
   matrix. */
void ffd_gltf_take_apart(gltf_node *node);

#endif
