/* gltf_faults.h - values of members that a viewer can do without, but that are not what glTF has there. */
#ifndef FFD_IO_GLTF_SCENE_GLTF_FAULTS_H
#define FFD_IO_GLTF_SCENE_GLTF_FAULTS_H

#include "io/gltf/document/gltf_document.h"

/* Says which there are: default weights of morph targets; levels of detail, visibility, cameras, lights and
   physics shapes of nodes; targets of animations. A line each for the weights and the others. Errors:
   FFD_E_MEMORY. */
ffd_status ffd_gltf_warn_of_faults(const mesh_document *document, const mesh_log *log, ffd_error *error);

#endif
