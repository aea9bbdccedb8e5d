/* gltf_rig_edit.h - the JSON of nodes, skins and animations that follow the deformation. */
#ifndef FFD_IO_GLTF_RIG_GLTF_RIG_EDIT_H
#define FFD_IO_GLTF_RIG_GLTF_RIG_EDIT_H

#include "io/gltf/rig/gltf_rig.h"
#include "json/json_edit.h"

/* Writes the transforms of the nodes that are written otherwise: only the numbers that change. */
void ffd_gltf_edit_nodes(const gltf_document *document, json_edits *edits);

/* Names the accessors that hold the skins' inverse bind matrices. outputs: of the rig's contents. */
void ffd_gltf_edit_skins(const gltf_document *document, const size_t *outputs, json_edits *edits);

/* Gives animations the samplers that they need beside their own, and names the accessors of all outputs. */
void ffd_gltf_edit_animations(const gltf_document *document, const size_t *outputs, json_edits *edits);

#endif
