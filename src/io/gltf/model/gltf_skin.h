/* gltf_skin.h - skins in their default pose (glTF 2.0, 3.7.3), and which primitives they move. */
#ifndef FFD_IO_GLTF_MODEL_GLTF_SKIN_H
#define FFD_IO_GLTF_MODEL_GLTF_SKIN_H

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

/* Reads document->skins, without their matrices. Errors: FFD_E_INVALID, FFD_E_MEMORY. */
ffd_status ffd_gltf_list_skins(gltf_document *document, ffd_error *error);

/* Computes the joint matrices of the skins that nodes of the scene use, and checks the joints and weights of
   their meshes. Errors: FFD_E_INVALID, FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_gltf_prepare_skins(gltf_document *document, ffd_error *error);

/* Computes the joint matrices of a prepared skin, 12 numbers per joint. worlds: the nodes' world matrices,
   laid out as document->world. Errors: FFD_E_INVALID. */
ffd_status ffd_gltf_joint_matrices(const gltf_document *document, const gltf_skin *skin, const double *worlds,
                                   double *matrices, ffd_error *error);

/* Whether the joint matrices of a skin that was not prepared, since the scene does not show it, are valid. */
bool ffd_gltf_has_joint_matrices(const gltf_document *document, const gltf_skin *skin);

/* Frees document->skins. */
void ffd_gltf_free_skins(gltf_document *document);

#endif
