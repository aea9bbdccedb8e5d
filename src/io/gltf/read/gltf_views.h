/* gltf_views.h - bufferViews, and decoding those of EXT_meshopt_compression and KHR_meshopt_compression. */
#ifndef FFD_IO_GLTF_READ_GLTF_VIEWS_H
#define FFD_IO_GLTF_READ_GLTF_VIEWS_H

#include "io/gltf/read/gltf_document.h"

/* Decodes the compressed bufferViews into document->decoded_views; ffd_gltf_check calls it. A view whose
   compression is not supported is left undecoded. Errors: FFD_E_INVALID, FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_gltf_decode_views(gltf_document *document, ffd_error *error);

/* Returns the JSON value of a view's meshopt extension; JSON_NONE if the view is not compressed. */
uint32_t ffd_gltf_meshopt_value(const gltf_document *document, size_t view);

/* Returns the decoded bytes of a view, owned by the document; NULL if the view was not decoded. */
const unsigned char *ffd_gltf_view_bytes(const gltf_document *document, size_t view);

/* Returns the compressed bytes of a view and sets *size; NULL if the view is not compressed or its
   bytes are missing. */
const unsigned char *ffd_gltf_compressed_bytes(const gltf_document *document, size_t view, size_t *size);

/* Fails with the reason why ffd_gltf_decode_views left a view undecoded; returns FFD_OK if it did not. */
ffd_status ffd_gltf_refuse_view(const gltf_document *document, size_t view, ffd_error *error);

#endif
