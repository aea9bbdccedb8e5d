/* gltf_skin.h - skins in their default pose (glTF 2.0, 3.7.3). */
#ifndef FFD_IO_GLTF_MODEL_GLTF_SKIN_H
#define FFD_IO_GLTF_MODEL_GLTF_SKIN_H

#include "io/gltf/read/gltf_document.h"

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

/* mesh_format's read_transforms. */
mesh_read_transforms_function ffd_gltf_read_transforms;

#endif
