/* gltf_grown.h - a file with further accessors, made in memory: the edited JSON, and the old bytes followed
   by new ones. */
#ifndef FFD_IO_GLTF_MORPH_GLTF_GROWN_H
#define FFD_IO_GLTF_MORPH_GLTF_GROWN_H

#include "io/gltf/save/gltf_saver.h"

/* The additions to the file. */
typedef struct morph_data {
    byte_buffer accessors; /* the JSON of new accessors, with commas */
    size_t accessor_count; /* in accessors */
    byte_buffer bytes;     /* new animation data, in one new bufferView */
} morph_data;

/* saver: only its edits of the JSON are used. */
typedef struct gltf_grown {
    gltf_saver saver;
    morph_data data;
} gltf_grown;

/* Makes the file; call it after all edits. The caller owns *made. Errors: FFD_E_MEMORY, FFD_E_LIMIT. */
ffd_status ffd_gltf_grown_write(gltf_grown *grown, file_input *made, ffd_error *error);
/* Frees the edits and additions. */
void ffd_gltf_grown_free(gltf_grown *grown);

#endif
