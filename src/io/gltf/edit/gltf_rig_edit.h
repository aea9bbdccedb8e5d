/* gltf_rig_edit.h - edits the JSON of nodes, skins and animations that follow the deformation. */
#ifndef FFD_IO_GLTF_EDIT_GLTF_RIG_EDIT_H
#define FFD_IO_GLTF_EDIT_GLTF_RIG_EDIT_H

#include "io/gltf/edit/gltf_rig.h"
#include "json/json_edit.h"

/* Edits the transforms of nodes: only numbers that differ are replaced. */
void ffd_gltf_edit_nodes(const gltf_document *document, json_edits *edits);

/* Edits the skins to name the accessors of their new inverse bind matrices. outputs: the accessor of each of
   the rig's contents. */
void ffd_gltf_edit_skins(const gltf_document *document, const size_t *outputs, json_edits *edits);

/* Adds the further samplers of animations, and edits samplers to name the accessors of their new outputs.
   outputs: as above. */
void ffd_gltf_edit_animations(const gltf_document *document, const size_t *outputs, json_edits *edits);

#endif
