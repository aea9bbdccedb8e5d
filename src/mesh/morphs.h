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

/* A morph target of what a node shows, as readers list it. */
typedef struct mesh_target {
    char *name;          /* as in the file; NULL: none. The list's to free */
    size_t mesh, number; /* the mesh that has it, and its number there, from 0 */
    size_t part;         /* whose vertices it moves */
    double weight;       /* without animation */
    size_t rig_weight;   /* index in the weights of a skeleton (rig.h); RIG_NONE: there are none */
    size_t source;       /* the format's own, for read_target */
} mesh_target;

typedef struct mesh_targets {
    mesh_target *list;
    size_t count;
} mesh_targets;

/* Lists the targets that move positions, each under every node that shows it; parts that are shown several
   times count once. Fill an empty list, which the caller frees in every case (ffd_mesh_targets_free). Errors:
   FFD_E_LIMIT, FFD_E_MEMORY. */
typedef ffd_status mesh_list_targets_function(const mesh_document *document, mesh_targets *targets,
                                              ffd_error *error);
/* Reads by how much a target moves all vertices of its part in the space of the lattice, 3 numbers each.
   after: the results, which are those of stored shapes. */
typedef void mesh_read_target_function(const mesh_document *document, const mesh_target *target, bool after,
                                       double *offsets);
/* Frees a list; leaves an empty one. */
void ffd_mesh_targets_free(mesh_targets *targets);

struct mesh_morph_calls {
    mesh_read_offsets_function *read_offsets;
    mesh_write_offsets_function *write_offsets;
    mesh_keep_base_function *keep_base;
    mesh_keep_clips_function *keep_clips;
    mesh_list_targets_function *list_targets;
    mesh_read_target_function *read_target;
};

#endif
