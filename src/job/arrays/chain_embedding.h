/* chain_embedding.h - the struct behind ffd_chain_embedding (public functions: ffd/chain.h), and what its
   parts share. Declares chain_send.c. */
#ifndef FFD_JOB_ARRAYS_CHAIN_EMBEDDING_H
#define FFD_JOB_ARRAYS_CHAIN_EMBEDDING_H

#include "job/chain/chain.h"
#include "job/chain/overlaps.h"
#include "points/embedding.h"
#include "points/point_run.h"
#include <ffd/chain.h>

struct ffd_chain_embedding {
    lattice_chain chain; /* owns its lattices and locators */
    size_t count;        /* of points */
    bool is_float;       /* they stand for their rounding cells */
    size_t layers;       /* u,v,w of a point: one in each lattice, or one in all blocks */
    /* Of each lattice: the points as its own control points and those of the lattices before bring them to
       it; rest is lent by the chain. Blocks share the arrays of the first. */
    ffd_embedding *places;
    uint32_t *owners; /* the block that moves each point; BLOCK_NONE: none. NULL: of a chain */
    uint8_t *status;  /* in all lattices together */
    overlap_pairs overlaps;
};

/* Scratch memory of a thread for a tile. All zeros before the first use. */
typedef struct chain_room {
    chain_scratch chain;
    double x[3 * CHAIN_RUN], delta[3 * CHAIN_RUN], gradient[9 * CHAIN_RUN];
    point_outcome outcomes[CHAIN_RUN]; /* in the last layer */
    point_outcome joined[CHAIN_RUN];   /* in all layers; of who embeds */
    border_place borders[CHAIN_RUN];
} chain_room;

_Static_assert(POINT_TILE <= CHAIN_RUN, "a tile is one run");

/* Points of an embedding: from `first` on, or those that are listed from there on. */
typedef struct chain_points {
    size_t first, count;
    const uint32_t *vertices; /* NULL: all */
} chain_points;

/* Returns the index of point i among all. */
static inline size_t ffd_chain_point(const chain_points *points, size_t i)
{
    return points->vertices ? points->vertices[points->first + i] : points->first + i;
}

/* Whether there are several blocks: the owner of each point then says which lattice it is in. */
static inline bool ffd_has_owners(const ffd_chain_embedding *embedding)
{
    return embedding->chain.blocks;
}

/* Sends the points at room->x through a layer; they are then where it takes them. Their locations, border
   places and outcomes stay in room.
   - links: those of the embedding, or a copy with moved lattices.
   - known: take the locations of the embedding; else search.
   - delta, gradient: filled; gradient may be NULL.
   Errors: FFD_E_MEMORY, FFD_E_LIMIT. */
ffd_status ffd_chain_send(const ffd_chain_embedding *embedding, chain_link *links, size_t layer, bool known,
                          const chain_points *points, chain_room *room, double *delta, double *gradient,
                          ffd_error *error);
/* Sends the points at room->x through all layers. links as above; known: so many layers are known. delta and
   gradient are those of all together. Errors: FFD_E_MEMORY, FFD_E_LIMIT. */
ffd_status ffd_chain_send_all(const ffd_chain_embedding *embedding, chain_link *links, size_t known,
                              const chain_points *points, chain_room *room, double *delta, double *gradient,
                              ffd_error *error);

/* Allocates the scratch memory of the threads of a run. Returns NULL if memory runs out. */
chain_room *ffd_chain_rooms(const point_run *run);

#endif
