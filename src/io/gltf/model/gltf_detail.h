/* gltf_detail.h - nodes that stand for a node without being shown beside it: coarser levels of detail, which
   replace it at a distance (MSFT_lod), and the shapes of its collider and trigger (KHR_physics_rigid_bodies).
 */
#ifndef FFD_IO_GLTF_MODEL_GLTF_DETAIL_H
#define FFD_IO_GLTF_MODEL_GLTF_DETAIL_H

#include "io/gltf/read/gltf_document.h"

/* A walk through the nodes that stand for a node. */
typedef struct gltf_stand_ins {
    const gltf_document *document;
    size_t node;
    uint32_t detail; /* the next element of the list of levels; JSON_NONE: none */
    int shapes;      /* number of shapes that were looked at */
    bool collides;   /* whether the node that was returned last is a shape */
} gltf_stand_ins;

/* Begins such a walk. */
gltf_stand_ins ffd_gltf_stand_ins(const gltf_document *document, size_t node);

/* Returns the next node; GLTF_NONE: there is none. */
size_t ffd_gltf_next_stand_in(gltf_stand_ins *walk);

/* Returns the number of nodes with a mesh that only replace others at a distance, or, if collide, that are
   only shapes of colliders and triggers. */
size_t ffd_gltf_count_stand_ins(const gltf_document *document, bool collide);

#endif
