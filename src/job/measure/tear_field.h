/* tear_field.h - the displacement at places of an edge, by the lattices that move its ends: where places are
   looked up, the lattices one after the other (tear_field.c) or side by side (tear_blocks.c), and the foot of
   a place, the point of a volume whose displacement it gets (tear_feet.c). */
#ifndef FFD_JOB_MEASURE_TEAR_FIELD_H
#define FFD_JOB_MEASURE_TEAR_FIELD_H

#include "job/chain/marks.h"
#include "mesh/mesh.h"
#include <stdatomic.h>

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
    const double *along;          /* from end to end; NULL: exits are not asked for */
    double delta[3], gradient[9]; /* filled: the displacement, and its derivative by x */
    /* Filled, of links one after the other: how many times `along` is the way back, and the way on, to where
       the place leaves a link that does not move both ends, as the derivatives have it; infinite: none
       holds it. holder: the last such link, + 1; 0: there is none. */
    double exits[2];
    size_t holder;
} field_place;

/* The most places at once, and the most pairs. */
#define FIELD_RUN ((size_t)1024)
#define FIELD_PAIRS ((size_t)256)

/* Where places are looked up; shared by threads. */
typedef struct tear_field {
    const lattice_chain *chain;
    const mesh_faces *faces;
    mark_planes marks;
    lattice_chain plain; /* of blocks: the chain without an extension and a snap */
    bool parts;          /* jumps are also looked for in volumes that move both ends: they may open, or meet
                            themselves, or the edge may lead through what is outside */
    bool continues;      /* the first end of an edge stays; what moves the second goes on to it */
    /* The evaluations that are left to all threads; NULL: there is no limit. Whether they suffice does not
       depend on the order in which threads take them. */
    atomic_llong *left;
} tear_field;

typedef struct field_foot {
    bool found;  /* false: none acts; the other members are not set */
    bool inside; /* the volume holds the place; else the foot is the nearest point of the border */
    size_t link;
    bool on_seam;         /* it was moved there, and the displacement does not follow the place */
    boundary_point point; /* inside: only its u,v,w are set */
} field_foot;

/* Scratch memory of a thread. */
typedef struct field_scratch {
    chain_scratch chain;
    double x[3 * FIELD_RUN], delta[3 * FIELD_RUN], gradient[9 * FIELD_RUN];
    point_outcome outcomes[FIELD_RUN];
    /* One after the other: */
    double link_x[3 * FIELD_RUN];
    uint8_t actions[FIELD_RUN];
    uint32_t asked[FIELD_RUN]; /* the places that a link may act on */
    uint8_t held[FIELD_RUN];   /* a link that moves one end, or none, holds the place */
    uint32_t gaps[FIELD_RUN];  /* the places in a gap */
    field_place in_gaps[FIELD_RUN];
    field_foot feet[2 * FIELD_PAIRS];
} field_scratch;

/* Takes what a search cost from the evaluations that are left. Errors: FFD_E_LIMIT. */
static inline ffd_status ffd_field_take(const tear_field *field, long long evaluations, ffd_error *error)
{
    return !field->left || atomic_fetch_sub(field->left, evaluations) >= evaluations
               ? FFD_OK
               : ffd_fail(error, FFD_E_LIMIT, "they take long in this lattice (see {quality})");
}

/* Finds the border point of a link that is nearest to x, within the link's falloff. Errors: FFD_E_MEMORY. */
ffd_status ffd_foot_on_border(const tear_field *field, size_t link, const double x[3], field_foot *foot,
                              ffd_error *error);
/* Computes the displacement at a foot, and its derivative by the place. */
void ffd_foot_displacement(const tear_field *field, const field_foot *foot, double delta[3],
                           double gradient[9]);
/* Sets exits (field_place) where they are nearer than those that are set, by a foot inside a link that has
   not been applied yet. */
void ffd_foot_exits(const tear_field *field, const field_foot *foot, field_place *place);
/* Adjusts the feet of two neighbouring places in one link. Beside a seam both are moved onto it, each on its
   own face. Where points outside stay, and a place is outside, one foot serves for both unless a seam is
   between. */
void ffd_feet_join(const tear_field *field, field_foot *first, field_foot *second);
/* Returns why the displacements at two neighbouring feet of a link may differ. */
ffd_tear_cause ffd_feet_cause(const tear_field *field, const field_foot *first, const field_foot *second);

/* As ffd_tear_field_find, without a visitor. */
ffd_status ffd_tear_blocks_find(const tear_field *field, field_place *places, size_t count,
                                field_scratch *scratch, ffd_error *error);
/* As ffd_tear_field_compare, of one pair. */
ffd_status ffd_tear_blocks_compare(const tear_field *field, field_place pair[2], ffd_tear_cause *cause,
                                   ffd_error *error);

/* Makes a field that borrows all arguments. marks: of the vertices of faces. parts: as of tear_field. */
tear_field ffd_tear_field_make(const lattice_chain *chain, const mesh_faces *faces, const mark_planes *marks,
                               bool parts);
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

/* The same for count pairs, at most FIELD_PAIRS, of neighbouring places of an edge, and why their
   displacements may differ. Where points
   outside stay, and a place is outside of a volume that moves both ends, the displacement of one place stands
   for both, unless a seam is between: an edge that cuts a corner of a volume is not torn. */
ffd_status ffd_tear_field_compare(const tear_field *field, field_place *pairs, size_t count,
                                  field_scratch *scratch, ffd_tear_cause *causes, ffd_error *error);

#endif
