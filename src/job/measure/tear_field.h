/* tear_field.h - the displacement at places of an edge, by the lattices that move its ends. */
#ifndef FFD_JOB_MEASURE_TEAR_FIELD_H
#define FFD_JOB_MEASURE_TEAR_FIELD_H

#include "job/measure/tear_place.h"

/* Makes a field that borrows all arguments. marks: of the vertices of faces. */
tear_field ffd_tear_field_make(const lattice_chain *chain, const mesh_faces *faces, const mark_planes *marks);
/* The same for edges of which the first end stays: what moves the second one goes on to it, as it is
   extended. room: for the chain. */
tear_field ffd_tear_field_continue(const tear_field *field, lattice_chain *room);
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
   outside stay, and a place is outside of a volume that moves both ends, the displacement of one place stands
   for both, unless a seam is between: an edge that cuts a corner of a volume is not torn. */
ffd_status ffd_tear_field_compare(const tear_field *field, field_place pair[2], field_scratch *scratch,
                                  ffd_tear_cause *cause, ffd_error *error);

#endif
