/* morphs.h - the morph targets of a mesh: deforming those that it has, and storing a deformation as a
   further one. */
#ifndef FFD_MESH_MORPHS_H
#define FFD_MESH_MORPHS_H

#include "mesh/mesh.h"

typedef struct morph_clip morph_clip; /* morph/morph_clip.h */

/* Read and write the offsets of a morph target for one of its streams: 3 numbers for each vertex, also
   for tangents. As the reader and the writer of positions. */
typedef void mesh_read_offsets_function(const mesh_document *document, size_t part, size_t shape,
                                        mesh_stream stream, size_t first, size_t count, double *xyz);
typedef void mesh_write_offsets_function(mesh_document *document, size_t part, size_t shape,
                                         mesh_stream stream, size_t first, size_t count, const double *xyz,
                                         const uint8_t *changed);
/* Keeps the base shape: results become the offsets of a further morph target of this name. To be called
   before begin_results; and again for each further target, when the results of the one before are
   complete. */
typedef ffd_status mesh_keep_base_function(mesh_document *document, const char *name, ffd_error *error);
/* Adds animations of morph target weights, to be saved. They belong to the caller, and refer to new
   targets or to those of the file. To be called before keep_base. names: those of all new targets.
   Errors: FFD_E_ARGUMENT (a clip refers to an unknown target). */
typedef ffd_status mesh_keep_clips_function(mesh_document *document, const morph_clip *clips, size_t count,
                                            const char *const *names, size_t name_count, ffd_error *error);

struct mesh_morph_calls {
    mesh_read_offsets_function *read_offsets;
    mesh_write_offsets_function *write_offsets;
    mesh_keep_base_function *keep_base;
    mesh_keep_clips_function *keep_clips;
};

#endif
