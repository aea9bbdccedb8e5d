/* gltf_results.h - the results of a deformation until they are saved. */
#ifndef FFD_IO_GLTF_MODEL_GLTF_RESULTS_H
#define FFD_IO_GLTF_MODEL_GLTF_RESULTS_H

#include "io/gltf/read/gltf_document.h"

/* Copies the original vectors to every tile of the results that was not written. */
void ffd_gltf_complete_results(gltf_document *document);

/* Overwrites count vectors of a stream by its results where they differ; stored integers may be more precise
   than floats. */
void ffd_gltf_put_results(const gltf_stream *stream, size_t count, double *values);

/* Returns the bounds of count vectors; NaN is ignored. */
gltf_tile_bounds ffd_gltf_find_bounds(const float *xyz, size_t count);

/* Makes the results of a part that has none because it is not selected; call it after ffd_gltf_begin_results.
   Errors: FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_gltf_add_results(gltf_document *document, size_t part, ffd_error *error);

#endif
