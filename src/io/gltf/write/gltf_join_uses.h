/* gltf_join_uses.h - lets nodes share a mesh if their results differ only by rounding. */
#ifndef FFD_IO_GLTF_WRITE_GLTF_JOIN_USES_H
#define FFD_IO_GLTF_WRITE_GLTF_JOIN_USES_H

#include "io/gltf/write/gltf_plan.h"

/* Uses of a mesh that see the same bits. */
typedef struct gltf_use_group {
    size_t use, rank; /* the first use in the scene and its rank; SIZE_MAX: no use */
    size_t leader;    /* the group whose bits it gets */
    /* If it is a leader: the copy, counted from first_copy, that gets its bits; GLTF_NONE: the mesh
       itself. */
    size_t target;
    size_t number; /* if it is a target: the new number of its copy in the plan */
} gltf_use_group;

/* Joins the mesh and its copies (plan->copies from first_copy on) where their results agree: each coordinate
   within 1 ulp in the file's type (for a direction, 1 ulp of its length) plus the rounding of the double
   computation. A mirrored half, for example, need not have the same bits as its original. A vector that stays
   in one use agrees only with vectors that move by no more than the rounding in double, so that it keeps its
   bits. The bits are those of the use that comes first in the scene. groups and order: room for one more than
   the number of copies. */
void ffd_gltf_join_uses(const gltf_document *document, size_t mesh, size_t first_copy, size_t first_change,
                        gltf_plan *plan, gltf_use_group *groups, size_t *order);

#endif
