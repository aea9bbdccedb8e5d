/* recompute.h - `--normals recompute`: normals and tangents from the deformed faces. */
#ifndef FFD_JOB_PASS_RECOMPUTE_H
#define FFD_JOB_PASS_RECOMPUTE_H

#include "mesh/mesh.h"

typedef struct recompute_counts {
    uint64_t normals;   /* in all parts of the document */
    uint64_t carried;   /* normals without usable faces, which follow the deformation */
    uint64_t collapsed; /* those of them that the deformation collapses; they are kept */
} recompute_counts;

/* Replaces the normals of a document, whose results have begun, by those of its deformed faces
   (normal_groups.h), and makes tangents perpendicular to them. A normal keeps its bits, and so does its
   tangent, if no vertex of its faces moved. A normal without faces, or whose faces have no area or cancel
   out, follows the deformation instead. Only selected vertices change. Offsets of morph targets are not
   touched: a pass deforms them (mesh_pass.only_offsets). faces      of the whole document, at rest deformed
   3 doubles a vertex, and gradients  9 doubles a vertex: both from a pass over the whole chain (mesh_pass)
   Errors: FFD_E_MEMORY, FFD_E_LIMIT. */
ffd_status ffd_recompute_normals(mesh_document *document, mesh_state state, const mesh_faces *faces,
                                 const double *deformed, const double *gradients, recompute_counts *counts,
                                 ffd_error *error);

#endif
