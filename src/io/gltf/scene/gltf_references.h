/* gltf_references.h - members beyond the model by which an element of the file names another, if it does. */
#ifndef FFD_IO_GLTF_SCENE_GLTF_REFERENCES_H
#define FFD_IO_GLTF_SCENE_GLTF_REFERENCES_H

#include "io/gltf/document/gltf_document.h"

/* What a node can name: elements of lists of the file. */
typedef enum gltf_reference {
    GLTF_CAMERA,
    GLTF_LIGHT,
    GLTF_LIGHT_PROFILE,
    GLTF_COLLIDER,
    GLTF_TRIGGER,
    GLTF_OMI_COLLIDER,
    GLTF_OMI_TRIGGER,
    GLTF_REFERENCE_COUNT
} gltf_reference;

/* Returns the value by which a node names one; JSON_NONE if it does not. */
uint32_t ffd_gltf_reference(const gltf_document *document, size_t node, gltf_reference reference);

/* Whether such a value names an element that is there. */
bool ffd_gltf_refers(const gltf_document *document, uint32_t value, gltf_reference reference);

/* Looks up the node whose translation, rotation or scale the target of an animation's channel is; GLTF_NONE:
   it is of something else. *fault is the value that should say so and does not; JSON_NONE: none. Errors:
   FFD_E_MEMORY. */
ffd_status ffd_gltf_animated_node(const gltf_document *document, uint32_t target, size_t *node,
                                  uint32_t *fault, ffd_error *error);

#endif
