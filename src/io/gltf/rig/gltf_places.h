/* gltf_places.h - what a file places in the scene beside its vertices, and what of these is more than a
   position. */
#ifndef FFD_IO_GLTF_RIG_GLTF_PLACES_H
#define FFD_IO_GLTF_RIG_GLTF_PLACES_H

#include "io/gltf/document/gltf_document.h"

/* mesh_format's list_places: joints, cameras, lights, animated pivots, physics shapes, and sockets: empty
   nodes without children. After ffd_gltf_select only those of the nodes that it selects, of the empty nodes
   below, and of their skins. All: also nodes that place a mesh or have an extension, and groups whose scale
   in the scene is uneven, which would shear what is below them if that turned and they did not; and, to stay,
   what is not selected. */
mesh_list_places_function ffd_gltf_list_places;

/* mesh_format's count_skins: of the skins of the scene. */
mesh_count_skins_function ffd_gltf_count_skins;

/* mesh_format's place_name: the name of a node, "node N" where it has none. */
mesh_place_name_function ffd_gltf_place_name;

#endif
