/* gltf_pose.h - the nodes of a file at a time of an animation: their transforms, the matrices in the scene
   and the weights of morph targets. */
#ifndef FFD_IO_GLTF_ANIMATION_GLTF_POSE_H
#define FFD_IO_GLTF_ANIMATION_GLTF_POSE_H

#include "io/gltf/animation/gltf_animation.h"

typedef struct gltf_pose {
    const gltf_node *rest; /* per node: its transform by default, lent; NULL: the file's */
    gltf_node *nodes;      /* per node: its own transform; children are lent by the model */
    double *world;         /* per node, as gltf_document's */
    double *weights;       /* of all nodes */
    size_t *first_weight; /* per node, and the end: its weights are from here on, one for each morph target */
    size_t *order;        /* nodes, parents first */
    size_t order_count;   /* below the number of nodes where the file's nodes form no forest */
} gltf_pose;

/* Makes the default pose of a document that is open in scene space; to be freed in any case. Errors:
   FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_gltf_make_pose(const gltf_document *document, gltf_pose *pose, ffd_error *error);
/* Frees it; nothing is left. */
void ffd_gltf_free_pose(gltf_pose *pose);

/* Sets it to an animation (loaded; NULL: the default pose) at a time. Of two channels that drive the same,
   the last one counts. A node with a matrix that is animated is taken apart into translation, rotation and
   scale first, as viewers do. */
void ffd_gltf_set_pose(const gltf_document *document, const gltf_animation *animation, double time,
                       gltf_pose *pose);

/* Takes the matrix of a node apart into translation, rotation and scale, as viewers do; it has none then. */
void ffd_gltf_take_apart(gltf_node *node);

#endif
