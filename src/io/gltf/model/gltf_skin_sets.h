/* gltf_skin_sets.h - which primitives a skin moves. */
#ifndef FFD_IO_GLTF_MODEL_GLTF_SKIN_SETS_H
#define FFD_IO_GLTF_MODEL_GLTF_SKIN_SETS_H

#include "io/gltf/read/gltf_document.h"

/* Notes what is wrong, but plain, in the sets of joints and weights of primitives that the scene shows with a
   skin, and takes it out of the model: a last set with only one of the two, which viewers ignore; the skin of
   a node none of whose primitives has a set, which its own transform places then. Call it after
   ffd_gltf_make_scene and before ffd_gltf_make_parts. Errors: FFD_E_INVALID (strict). */
ffd_status ffd_gltf_settle_skins(gltf_document *document, ffd_error *error);

/* Whether a skin moves a primitive of a node that has the skin. */
static inline bool ffd_gltf_is_skinned(const gltf_primitive *primitive)
{
    return primitive->influence_count > 0;
}

/* Whether the transform of a node places a primitive of its mesh, because it has no skin or the primitive has
   no set. */
bool ffd_gltf_places_mesh(const gltf_document *document, size_t node);

#endif
