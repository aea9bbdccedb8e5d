/* gltf_morph_reuse.h - decides which accessors of a replaced morph target can hold the new offsets, so that
   replacing a target again and again does not enlarge the file. */
#ifndef FFD_IO_GLTF_EDIT_GLTF_MORPH_REUSE_H
#define FFD_IO_GLTF_EDIT_GLTF_MORPH_REUSE_H

#include "io/gltf/read/gltf_document.h"

/* An attribute of a morph target of a primitive. */
typedef struct morph_place {
    size_t mesh, primitive, target;
    gltf_semantic semantic;
} morph_place;

/* Counts the users of each accessor; 2 means two or more. `but`: animations that do not count, or NULL. The
   caller frees the array. NULL: memory ran out. */
unsigned char *ffd_gltf_count_users(const gltf_document *document, const gltf_values *but);

/* Whether any node that shows the primitive is not selected: it keeps the old offsets. */
bool ffd_gltf_is_partly_selected(const gltf_document *document, size_t mesh, size_t primitive);

/* Whether the new offsets of an attribute can be stored in the old accessor. It must hold floats, only these
   offsets, in bytes of its own, and every selected use must have results in a target of source, whose
   instances are the document's. If some uses are not selected, they keep the old offsets, and the accessor
   may be shared: saving then gives the selected uses a new one. users: from ffd_gltf_count_users. */
bool ffd_gltf_can_reuse(const gltf_document *document, const unsigned char *users, const morph_place *place,
                        const gltf_document *source, const gltf_morph *morph);

#endif
