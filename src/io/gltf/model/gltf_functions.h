/* gltf_functions.h - the functions of glTF in mesh_format's table, which gltf_format.c fills, in the order of
   folders: gltf_faces.c, gltf_select.c, gltf_instancing.c, gltf_places.c, gltf_carriers.c, gltf_skin.c,
   gltf_faults.c, gltf_results.c and gltf_splats.c of model; gltf_rig_follow.c of edit; gltf_save.c,
   gltf_container.c and gltf_resources.c of write; gltf_open.c, gltf_as_morph.c, gltf_compare.c,
   gltf_describe.c, gltf_extract.c, gltf_names.c, gltf_materials.c, gltf_skeleton.c and gltf_anchors.c. */
#ifndef FFD_IO_GLTF_MODEL_GLTF_FUNCTIONS_H
#define FFD_IO_GLTF_MODEL_GLTF_FUNCTIONS_H

#include "mesh/linked_files.h"
#include "mesh/morphs.h"
#include "mesh/places.h"
#include "mesh/rig.h"
#include "mesh/selector.h"
#include "mesh/splats.h"

mesh_faces_function ffd_gltf_faces;
mesh_visit_triangles_function ffd_gltf_visit_triangles;
mesh_corner_normals_function ffd_gltf_corner_normals;
mesh_mark_used_function ffd_gltf_mark_used;
mesh_mixed_faces_function ffd_gltf_mixed_faces;

/* Names the node, or the mesh if the node has no name. */
mesh_name_owner_function ffd_gltf_name_part;
mesh_list_things_function ffd_gltf_list_parts;
mesh_select_function ffd_gltf_select;
mesh_mark_function ffd_gltf_mark;

mesh_check_reach_function ffd_gltf_check_reach;

/* Lists joints, cameras, lights, animated pivots, physics shapes, and sockets (empty nodes without children).
   After ffd_gltf_select only those of selected nodes, of the empty nodes below them, and of their skins. all:
   also nodes that place a mesh or have an extension, and groups whose world scale is uneven, since they would
   shear their descendants if only these turned; nodes that are not selected are listed as staying. */
mesh_list_places_function ffd_gltf_list_places;
/* Counts skins of the scene. */
mesh_count_skins_function ffd_gltf_count_skins;
/* Returns the name of a node, or "node N" if it has none. */
mesh_place_name_function ffd_gltf_place_name;
mesh_place_pieces_function ffd_gltf_place_pieces;
mesh_find_turned_function ffd_gltf_find_turned;

mesh_read_transforms_function ffd_gltf_read_transforms;

/* Warns of values that glTF does not allow but that viewers can do without: levels of detail, visibility,
   cameras, lights and physics shapes of nodes; targets of animations; the texture coordinates of textures.
   One line, and --strict refuses them. Errors: FFD_E_INVALID (strict), FFD_E_MEMORY. */
ffd_status ffd_gltf_warn_of_faults(const mesh_document *document, const mesh_log *log, ffd_error *error);

mesh_begin_results_function ffd_gltf_begin_results;
mesh_write_function ffd_gltf_write;
mesh_write_offsets_function ffd_gltf_write_offsets;

mesh_read_splats_function ffd_gltf_read_splats;
mesh_write_splats_function ffd_gltf_write_splats;

mesh_follow_function ffd_gltf_follow;

/* Saves a document with its results in place of the deformed attributes. */
mesh_save_function ffd_gltf_save_results;
/* Counts the files of the buffers. */
mesh_count_sidecars_function ffd_gltf_count_sidecars;
mesh_list_files_function ffd_gltf_list_images;
mesh_list_files_function ffd_gltf_list_linked;
mesh_find_named_function ffd_gltf_find_named;

mesh_open_function ffd_gltf_open;
mesh_close_function ffd_gltf_close;
mesh_list_files_function ffd_gltf_list_files;

/* Makes results offsets of a further morph target of this name. */
mesh_keep_base_function ffd_gltf_keep_base;
mesh_keep_clips_function ffd_gltf_keep_clips;
mesh_list_targets_function ffd_gltf_list_targets;
mesh_read_target_function ffd_gltf_read_target;
/* Adds the morph targets after ffd_gltf_keep_base, else works like ffd_gltf_save_results. */
mesh_save_function ffd_gltf_save;

mesh_compare_function ffd_gltf_compare;
mesh_describe_function ffd_gltf_describe;
mesh_describe_function ffd_gltf_list_names;
mesh_model_function ffd_gltf_extract;
/* A value that glTF does not allow counts as absent. */
mesh_list_materials_function ffd_gltf_list_materials;
mesh_read_skeleton_function ffd_gltf_read_skeleton;
mesh_read_anchors_function ffd_gltf_read_anchors;

#endif
