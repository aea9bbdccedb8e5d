/* gltf_unpack.h - compressed data that the output holds decoded, because something in it changed. */
#ifndef FFD_IO_GLTF_SAVE_GLTF_UNPACK_H
#define FFD_IO_GLTF_SAVE_GLTF_UNPACK_H

#include "io/gltf/save/gltf_saver.h"

/* Lists saver->unpackings from the plan. Errors: FFD_E_MEMORY. */
ffd_status ffd_gltf_list_unpackings(gltf_saver *saver, ffd_error *error);

/* Frees the lists of unpackings. */
void ffd_gltf_free_unpackings(gltf_saver *saver);

/* Whether primitive p is written uncompressed for a use of its mesh. */
bool ffd_gltf_is_unpacked(const gltf_saver *saver, size_t mesh, size_t p, size_t use);

/* Removes the compression of the primitives that are written uncompressed for a use of their mesh, and
   logs it. */
void ffd_gltf_edit_compression(const gltf_saver *saver, size_t mesh, size_t use, json_edits *edits);

/* Edits the views and accessors so that they name the decoded data. */
void ffd_gltf_edit_unpackings(gltf_saver *saver);

/* Appends the bufferViews of unpacked accessors to a list's text. */
void ffd_gltf_write_unpacked_views(const gltf_saver *saver, byte_buffer *text);

/* Whether primitives were unpacked and none in the output has Draco compression any more. */
bool ffd_gltf_lost_draco(gltf_saver *saver);

/* Whether views were unpacked and nothing in the output has EXT_meshopt_compression any more. */
bool ffd_gltf_lost_ext_meshopt(gltf_saver *saver);

/* Whether views were unpacked and nothing in the output has KHR_meshopt_compression any more. */
bool ffd_gltf_lost_khr_meshopt(gltf_saver *saver);

#endif
