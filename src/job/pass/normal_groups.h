/* normal_groups.h - which normals belong together, and what they become on the deformed faces. */
#ifndef FFD_JOB_PASS_NORMAL_GROUPS_H
#define FFD_JOB_PASS_NORMAL_GROUPS_H

#include "mesh/mesh.h"

#define NORMAL_NO_GROUP UINT32_MAX

/* Bytes of memory that a normal takes at the most while its group is found, with its corner. */
#define NORMAL_BYTES 76

typedef enum normal_outcome {
    NORMAL_KEPT, /* no face around it has a vertex that moved */
    NORMAL_NEW,
    NORMAL_LOST /* the faces around it have no area, or their normals cancel out */
} normal_outcome;

/* Normals are numbered through the parts of a document, in their order. */
typedef struct normal_groups {
    uint32_t *
        group; /* of each normal; NORMAL_NO_GROUP: no corner has it, or its vertex has no inverse transform */
    size_t normal_count, group_count;
    double *directions; /* 3 a group: unit normals of new ones, in the lattice's space */
    uint8_t *outcomes;  /* of each group, normal_outcome */
} normal_groups;

/* Corners belong together whose vertices are at one position (0 and -0 are equal), are moved to one position
   and have one normal, all three equal in bits, in the lattice's space. Their new normal is the direction of
   the sum over them of (area of the face) (angle) (unit normal of the face), of the deformed faces; of faces
   with one unit normal it is that one to the bit.
     faces      of the whole document, at rest
     deformed   3 doubles a vertex: where the vertices are now, in the lattice's space
   Freed by ffd_normal_groups_free, also after a failure. Errors: FFD_E_MEMORY, FFD_E_LIMIT. */
ffd_status ffd_normal_groups_make(const mesh_document *document, const mesh_faces *faces,
                                  const double *deformed, normal_groups *groups, ffd_error *error);
/* Frees the arrays of groups. */
void ffd_normal_groups_free(normal_groups *groups);

#endif
