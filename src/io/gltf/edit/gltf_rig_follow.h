/* gltf_rig_follow.h - makes the nodes, skins and animations of a file follow the deformation. */
#ifndef FFD_IO_GLTF_EDIT_GLTF_RIG_FOLLOW_H
#define FFD_IO_GLTF_EDIT_GLTF_RIG_FOLLOW_H

#include "io/gltf/edit/gltf_rig.h"

/* mesh_format's follow. */
mesh_follow_function ffd_gltf_follow;

#endif
