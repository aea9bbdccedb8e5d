/* gltf_join_uses.h - nodes whose results differ by their rounding only keep one mesh. */
#ifndef FFD_IO_GLTF_SAVE_GLTF_JOIN_USES_H
#define FFD_IO_GLTF_SAVE_GLTF_JOIN_USES_H

#include "io/gltf/save/gltf_plan.h"

/* Uses of a mesh that all see the same bits, with what is needed while they are joined. */
typedef struct gltf_use_group {
    size_t use, rank; /* the use that comes first in the scene; SIZE_MAX: there is none */
    size_t leader;    /* the group whose bits it gets */
    size_t
        target; /* of a leader: the copy that gets them, from the first one on; GLTF_NONE: the mesh itself */
    size_t number; /* of a group that is a target: its copy's new number in the plan */
} gltf_use_group;

/* Joins the copies of a mesh, which are the plan's from first_copy on, and the mesh itself, where their
   results agree: each coordinate to 1 ulp of its own in the file's type (of a direction, to 1 ulp of its
   length) and the rounding of the doubles that it was computed with. A mirrored half need not come out to the
   same bits as its original. A vector that one use leaves as it is agrees with what moves by that rounding
   at most: it keeps its bits. The use that comes first in the scene gives the bits. groups and order: memory
   for one more than there are copies. */
void ffd_gltf_join_uses(const gltf_document *document, size_t mesh, size_t first_copy, size_t first_change,
                        gltf_plan *plan, gltf_use_group *groups, size_t *order);

#endif
