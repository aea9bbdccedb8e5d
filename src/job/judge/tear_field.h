/* tear_field.h - the displacement at places of an edge, by the lattices that move its ends. */
#ifndef FFD_JOB_JUDGE_TEAR_FIELD_H
#define FFD_JOB_JUDGE_TEAR_FIELD_H

#include "job/chain/marks.h"
#include "mesh/mesh.h"

/* Which lattices act at a place. */
typedef enum field_by {
    FIELD_FIRST,  /* those that move the first end, also where they do not hold the place */
    FIELD_SECOND, /* likewise of the second end */
    /* Those that hold the place, and those that move both ends. In a gap, where none of those that move one
       end only holds it, those of the end whose lattices are nearer. Blocks: the first that holds the place;
       if none does, the one that moves both ends, else the nearest. */
    FIELD_BETWEEN
} field_by;

typedef struct field_place {
    uint32_t ends[2]; /* of the edge; vertices of faces */
    field_by by;
    double x[3]; /* at rest. Blocks: an end that its block holds by the vertex's rounding or by the snap is
                    moved to the border */
    double delta[3], gradient[9]; /* filled: the displacement, and its derivative by x */
} field_place;

/* The most places at once. */
#define FIELD_RUN ((size_t)1024)

/* Where places are looked up; shared by threads. */
typedef struct tear_field {
    const lattice_chain *chain;
    const mesh_faces *faces;
    mark_planes marks;
    lattice_chain plain; /* of blocks: the chain without an extension and a snap */
} tear_field;

typedef struct field_scratch field_scratch; /* of a thread */

/* Makes a field that borrows all arguments. marks: of the vertices of faces. */
tear_field ffd_tear_field_make(const lattice_chain *chain, const mesh_faces *faces, const mark_planes *marks);
/* Returns NULL if memory runs out. */
field_scratch *ffd_tear_field_scratch(void);

/* A callback before a link, of several one after the other: x: where the links before it have moved the
   places, 3 a place. */
typedef struct field_visitor {
    void (*visit)(void *context, size_t link, const double *x);
    void *context;
} field_visitor;

/* Finds the displacements of at most FIELD_RUN places. visitor may be NULL. Errors: FFD_E_MEMORY,
   FFD_E_LIMIT. */
ffd_status ffd_tear_field_find(const tear_field *field, field_place *places, size_t count,
                               const field_visitor *visitor, field_scratch *scratch, ffd_error *error);

/* The same for two neighbouring places of an edge, and why their displacements may differ. Where points
   outside stay, and both places are outside of a volume that moves both ends, the border point nearest to
   the first place stands for both, unless a seam is between: an edge that cuts a corner of a volume is not
   torn. */
ffd_status ffd_tear_field_compare(const tear_field *field, field_place pair[2], field_scratch *scratch,
                                  ffd_tear_cause *cause, ffd_error *error);

#endif
