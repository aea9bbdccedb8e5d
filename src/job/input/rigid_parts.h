/* rigid_parts.h - the parts of a mesh that move as one piece: `--rigid` and `--uniform` (src/maths.md 9.8).
 */
#ifndef FFD_JOB_INPUT_RIGID_PARTS_H
#define FFD_JOB_INPUT_RIGID_PARTS_H

#include "base/vector/motion.h"
#include "mesh/mesh.h"
#include "mesh/places.h"
#include <ffd/job.h>

/* Vertices that move together. */
typedef struct rigid_piece {
    size_t part; /* what names it: of the selectors of `--rigid`, then of those of `--uniform` */
    rigid_motion motion;
} rigid_piece;

/* Vertices at one position that move apart, since they are of different pieces. */
typedef struct rigid_splits {
    uint64_t count;
    double largest;
    size_t vertex; /* of the largest step */
} rigid_splits;

typedef struct rigid_parts {
    size_t part_count, rigid_count; /* selectors, and those of them that keep their size: the first ones */
    size_t *first;                  /* of each part of the document, its first vertex */
    uint32_t *pieces;               /* of each vertex: its piece, or MESH_NONE. NULL: there are no parts */
    rigid_piece *list;              /* count, which has room for capacity */
    size_t count, capacity;
    rigid_splits splits;
    memory_budget *budget; /* of the document, from which the arrays of so many vertices are taken */
    size_t vertices;
} rigid_parts;

/* What a job says of its parts. */
typedef struct rigid_request {
    const char *const *rigid, *const *uniform;
    size_t rigid_count, uniform_count;
    bool leaves; /* not all of the mesh is selected */
} rigid_request;

/* Checks the syntax of a selector of a setting, "rigid" or "uniform". Errors: FFD_E_ARGUMENT. */
ffd_status ffd_rigid_check(const char *option, const char *text, ffd_error *error);

/* Returns the text of a selector, by the number of its part. */
const char *ffd_rigid_part_text(const rigid_request *request, size_t part);

/* Finds the pieces in an open mesh, in the state that is judged; their motions are not known yet. The log is
   warned of parts without vertices. name: of the mesh, for messages. Errors: FFD_E_ARGUMENT (an unknown name;
   a vertex of two parts; too many parts), FFD_E_LIMIT, FFD_E_MEMORY, and those of reading faces. */
ffd_status ffd_rigid_parts_load(const rigid_request *request, mesh_document *document, mesh_state state,
                                const char *name, int threads, const mesh_log *log, rigid_parts *parts,
                                ffd_error *error);
/* Frees the arrays, and gives back what they took of the budget of the document, which must be open. */
void ffd_rigid_parts_free(rigid_parts *parts);

/* Returns the motion of a vertex of the document; NULL: it is of no piece. parts may be NULL. */
static inline const rigid_motion *ffd_rigid_motion_of(const rigid_parts *parts, size_t vertex)
{
    return parts && parts->pieces[vertex] != MESH_NONE ? &parts->list[parts->pieces[vertex]].motion : NULL;
}

#endif
