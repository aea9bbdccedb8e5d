/* gltf_references.h - references between elements of the file that the model does not hold. */
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

#endif
