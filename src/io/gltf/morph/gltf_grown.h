/* gltf_grown.h - a file that gets further accessors: its JSON with the edits, and its bytes with new ones at
   their end, in memory. */
#ifndef FFD_IO_GLTF_MORPH_GLTF_GROWN_H
#define FFD_IO_GLTF_MORPH_GLTF_GROWN_H

#include "io/gltf/save/gltf_saver.h"

/* What is added to the file. */
typedef struct morph_data {
    byte_buffer accessors; /* texts of new accessors, with commas */
    size_t accessor_count; /* of them */
    byte_buffer bytes;     /* of one new bufferView, for new animation data */
} morph_data;

/* saver: one that only edits the JSON. */
typedef struct gltf_grown {
    gltf_saver saver;
    morph_data data;
} gltf_grown;

/* Makes the file, after all other edits. *made is the caller's. Errors: FFD_E_MEMORY, FFD_E_LIMIT. */
ffd_status ffd_gltf_grown_write(gltf_grown *grown, file_input *made, ffd_error *error);
/* Frees what was edited and added. */
void ffd_gltf_grown_free(gltf_grown *grown);

#endif
