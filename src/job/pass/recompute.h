/* recompute.h - `--normals recompute`: normals and tangents of the deformed faces. */
#ifndef FFD_JOB_PASS_RECOMPUTE_H
#define FFD_JOB_PASS_RECOMPUTE_H

#include "mesh/mesh.h"

/* What was found. */
typedef struct recompute_counts {
    uint64_t normals;   /* of the document's parts */
    uint64_t carried;   /* that have no face to be computed from: they follow the deformation */
    uint64_t collapsed; /* of these, kept: the deformation leaves nothing of them */
} recompute_counts;

/* Hands the document, whose results have begun, the normals of its deformed faces (normal_groups.h) and
   tangents perpendicular to them. Where no face around a normal has a vertex that moved, it keeps its bits,
   as its tangent does. A normal without faces, or whose faces have no area or cancel out, is carried by the
   deformation. Only what is selected changes. Morph targets are not looked at: what they add to a normal is
   carried by the deformation (mesh_pass: only_offsets).
     faces      of the whole document, at rest
     deformed   3 doubles a vertex, and
     gradients  9 doubles a vertex: as a pass over all of the chain has left them (mesh_pass)
   Errors: FFD_E_MEMORY, FFD_E_LIMIT. */
ffd_status ffd_recompute_normals(mesh_document *document, const mesh_faces *faces, const double *deformed,
                                 const double *gradients, recompute_counts *counts, ffd_error *error);

#endif
