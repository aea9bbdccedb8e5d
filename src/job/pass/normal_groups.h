/* normal_groups.h - groups normals that must stay equal, and computes them from the deformed faces. */
#ifndef FFD_JOB_PASS_NORMAL_GROUPS_H
#define FFD_JOB_PASS_NORMAL_GROUPS_H

#include "mesh/mesh.h"

#define NORMAL_NO_GROUP UINT32_MAX

/* Upper bound of the temporary memory for each normal and its corner, in bytes. */
#define NORMAL_BYTES 76

typedef enum normal_outcome {
    NORMAL_KEPT, /* no vertex of its faces moved */
    NORMAL_NEW,
    NORMAL_LOST /* its faces have no area, or their normals cancel out */
} normal_outcome;

/* Normals are numbered through all parts of a document, in order. */
typedef struct normal_groups {
    uint32_t *
        group; /* of each normal; NORMAL_NO_GROUP: no corner uses it, or its vertex's transform is singular */
    size_t normal_count, group_count;
    double
        *directions; /* 3 a group: the unit normal where the outcome is NORMAL_NEW, in the lattice's space */
    uint8_t *outcomes; /* normal_outcome of each group */
} normal_groups;

/* Groups corners whose vertices have equal positions at rest (0 and -0 are equal), equal deformed positions
   and equal normals, bit for bit, in the lattice's space. The new normal of a group is the direction of the
   sum over its corners of (area of the face) (angle) (unit normal of the face), all of the deformed faces. If
   the faces have the same unit normal, it is exactly that one. faces      of the whole document, at rest
     deformed   3 doubles a vertex: deformed positions in the lattice's space
   Call ffd_normal_groups_free also after a failure. Errors: FFD_E_MEMORY, FFD_E_LIMIT. */
ffd_status ffd_normal_groups_make(const mesh_document *document, mesh_state state, const mesh_faces *faces,
                                  const double *deformed, normal_groups *groups, ffd_error *error);
/* Frees the arrays. */
void ffd_normal_groups_free(normal_groups *groups);

#endif
