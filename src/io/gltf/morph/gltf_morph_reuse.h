/* gltf_morph_reuse.h - which accessors of a morph target that is replaced can hold the new offsets, so that a
   file whose target is replaced again and again does not grow. */
#ifndef FFD_IO_GLTF_MORPH_GLTF_MORPH_REUSE_H
#define FFD_IO_GLTF_MORPH_GLTF_MORPH_REUSE_H

#include "io/gltf/document/gltf_document.h"

/* An attribute of a morph target of a primitive. */
typedef struct morph_place {
    size_t mesh, primitive, target;
    gltf_semantic semantic;
} morph_place;

/* Counts the users of each accessor, where 2 stands for more too, for the caller to free; `but`: an animation
   that is left out of account, or JSON_NONE. NULL: no memory. */
unsigned char *ffd_gltf_count_users(const gltf_document *document, uint32_t but);

/* Whether some node that shows a primitive is not selected: it keeps the old offsets. */
bool ffd_gltf_is_partly_selected(const gltf_document *document, size_t mesh, size_t primitive);

/* Whether an attribute's accessor has nothing but its offsets, as floats in bytes of its own, and all
   selected ones get results, those of a target of source, whose instances are the document's; what is not
   selected keeps the old ones then. For this others are used too, of floats: what is selected gets one of its
   own when it is saved. users: of ffd_gltf_count_users. */
bool ffd_gltf_can_reuse(const gltf_document *document, const unsigned char *users, const morph_place *place,
                        const gltf_document *source, const gltf_morph *morph);

#endif
