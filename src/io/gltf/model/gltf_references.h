/* gltf_references.h - references of nodes to other elements of the file that the model does not hold; nodes
   that stand for a node without being shown beside it: coarser levels of detail, which replace it at a
   distance (MSFT_lod), and the shapes of its collider and trigger (KHR_physics_rigid_bodies). */
#ifndef FFD_IO_GLTF_MODEL_GLTF_REFERENCES_H
#define FFD_IO_GLTF_MODEL_GLTF_REFERENCES_H

#include "io/gltf/read/gltf_document.h"

/* The kinds of elements that a node can refer to. */
typedef enum gltf_reference {
    GLTF_CAMERA,
    GLTF_LIGHT,
    GLTF_LIGHT_PROFILE,
    GLTF_COLLIDER,
    GLTF_TRIGGER,
    GLTF_OMI_COLLIDER,
    GLTF_OMI_TRIGGER,
    GLTF_OLD_OMI_COLLIDER,
    GLTF_COLLIDER_NODE,
    GLTF_TRIGGER_NODE,
    GLTF_REFERENCE_COUNT
} gltf_reference;

/* Returns the JSON value by which a node refers to such an element; JSON_NONE if it does not. */
uint32_t ffd_gltf_reference(const gltf_document *document, size_t node, gltf_reference reference);

/* Returns the JSON of the element that the value refers to; JSON_NONE if there is none. */
uint32_t ffd_gltf_referred(const gltf_document *document, uint32_t value, gltf_reference reference);

/* Whether the value refers to an element that exists. */
bool ffd_gltf_refers(const gltf_document *document, uint32_t value, gltf_reference reference);

/* Finds the node whose translation, rotation or scale an animation channel's target drives; GLTF_NONE: it
   drives something else. *fault is a value that should define the target but is not valid; JSON_NONE: none.
   Errors: FFD_E_MEMORY. */
ffd_status ffd_gltf_animated_node(const gltf_document *document, uint32_t target, size_t *node,
                                  uint32_t *fault, ffd_error *error);

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
