/* tear_place.h - places of edges, and where they are looked up. */
#ifndef FFD_JOB_MEASURE_TEAR_PLACE_H
#define FFD_JOB_MEASURE_TEAR_PLACE_H

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
    bool continues;      /* the first end of an edge stays; what moves the second goes on to it */
    /* The evaluations that are left to all threads; NULL: there is no limit. Whether they suffice does not
       depend on the order in which threads take them. */
    atomic_llong *left;
} tear_field;

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
} field_scratch;

/* Takes what a search cost from the evaluations that are left. Errors: FFD_E_LIMIT. */
static inline ffd_status ffd_field_take(const tear_field *field, long long evaluations, ffd_error *error)
{
    return !field->left || atomic_fetch_sub(field->left, evaluations) >= evaluations
               ? FFD_OK
               : ffd_fail(error, FFD_E_LIMIT, "they take long in this lattice (see {quality})");
}

#endif
