/* gltf_unpack.h - compressed data that the output holds decompressed, because some of it changed. */
#ifndef FFD_IO_GLTF_WRITE_GLTF_UNPACK_H
#define FFD_IO_GLTF_WRITE_GLTF_UNPACK_H

#include "io/gltf/write/gltf_saver.h"

/* Lists saver->unpackings from the plan. Errors: FFD_E_MEMORY. */
ffd_status ffd_gltf_list_unpackings(gltf_saver *saver, ffd_error *error);

/* Frees saver's lists of unpackings. */
void ffd_gltf_free_unpackings(gltf_saver *saver);

/* Whether primitive p is written decompressed for a use of its mesh. */
bool ffd_gltf_is_unpacked(const gltf_saver *saver, size_t mesh, size_t p, size_t use);

/* Removes, and logs, the compression of the primitives that are written decompressed for a use of their
   mesh. */
void ffd_gltf_edit_compression(const gltf_saver *saver, size_t mesh, size_t use, json_edits *edits);

/* Edits views and accessors to name the decompressed data. */
void ffd_gltf_edit_unpackings(gltf_saver *saver);

/* Appends the bufferViews of decompressed accessors to the text of a list. */
void ffd_gltf_write_unpacked_views(const gltf_saver *saver, byte_buffer *text);

/* Whether primitives were decompressed and no primitive of the output is compressed by Draco. */
bool ffd_gltf_lost_draco(gltf_saver *saver);

/* Whether views were decompressed and nothing in the output uses EXT_meshopt_compression. */
bool ffd_gltf_lost_ext_meshopt(gltf_saver *saver);

/* Whether views were decompressed and nothing in the output uses KHR_meshopt_compression. */
bool ffd_gltf_lost_khr_meshopt(gltf_saver *saver);

#endif
