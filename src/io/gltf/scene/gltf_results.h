/* gltf_results.h - the results of a deformation, until they are saved. */
#ifndef FFD_IO_GLTF_SCENE_GLTF_RESULTS_H
#define FFD_IO_GLTF_SCENE_GLTF_RESULTS_H

#include "io/gltf/document/gltf_document.h"

/* mesh_format's begin_results and write functions. */
mesh_begin_results_function ffd_gltf_begin_results;
mesh_write_function ffd_gltf_write_positions;
mesh_write_function ffd_gltf_write_normals;
mesh_write_function ffd_gltf_write_tangents;
mesh_write_offsets_function ffd_gltf_write_offsets;

/* Copies the original vectors to every tile of the results that nothing was written to. */
void ffd_gltf_complete_results(gltf_document *document);

/* Frees a stream's result and what belongs to it. */
void ffd_gltf_free_result(gltf_stream *stream);

/* Returns the bounds of count vectors; NaNs are ignored. */
gltf_tile_bounds ffd_gltf_find_bounds(const float *xyz, size_t count);

/* Makes the results of a part that has none as it is not selected. After ffd_gltf_begin_results. Errors:
   FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_gltf_add_results(gltf_document *document, size_t part, ffd_error *error);

#endif
