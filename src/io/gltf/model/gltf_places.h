/* gltf_places.h - lists what a file places in the scene besides its vertices, and what else than a position
   such a place has. */
#ifndef FFD_IO_GLTF_MODEL_GLTF_PLACES_H
#define FFD_IO_GLTF_MODEL_GLTF_PLACES_H

#include "io/gltf/read/gltf_document.h"

/* mesh_format's list_places: joints, cameras, lights, animated pivots, physics shapes, and sockets (empty
   nodes without children). After ffd_gltf_select only those of selected nodes, of the empty nodes below them,
   and of their skins. all: also nodes that place a mesh or have an extension, and groups whose world scale is
   uneven, since they would shear their descendants if only these turned; nodes that are not selected are
   listed as staying. */
mesh_list_places_function ffd_gltf_list_places;

/* mesh_format's count_skins: counts skins of the scene. */
mesh_count_skins_function ffd_gltf_count_skins;

/* mesh_format's place_name: the name of a node, or "node N" if it has none. */
mesh_place_name_function ffd_gltf_place_name;

#endif
