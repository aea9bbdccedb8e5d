/* chain.h - the lattices of a job in their order, and what they do to a run of points. */
#ifndef FFD_JOB_CHAIN_H
#define FFD_JOB_CHAIN_H

#include "base/fail.h"
#include <ffd/embedding.h>
#include <ffd/lattice.h>
#include <stdbool.h>
#include <stdint.h>

typedef struct chain_link {
    ffd_lattice *lattice;
    ffd_locator *locator; /* NULL until the lattice has its place */
} chain_link;

typedef struct lattice_chain {
    chain_link *links;
    size_t count;
} lattice_chain;

ffd_status ffd_chain_load(const char *const *paths, size_t count, lattice_chain *chain, ffd_error *error);
void ffd_chain_free(lattice_chain *chain);

/* What the links have done to one point. */
typedef struct chain_point {
    double delta[3];        /* the displacement so far, world units */
    double gradient[9];     /* of the composed deformation, F - I */
    double residual_square; /* relative to the link's diagonal, the greatest of the links' */
    double uvw[3];          /* of the last link */
    uint32_t evaluations;
    uint8_t status; /* ffd_vertex_status, the highest of the links' */
    bool outside;   /* of some link */
} chain_point;

/* Sends count points x (3 doubles each, changed to their new places) through links [0, links) and fills
   points (count). locations (count) is scratch; the time taken is added to *embed_seconds and
   *deform_seconds. */
ffd_status ffd_chain_apply(const lattice_chain *chain, size_t links, double *x, size_t count, bool gradients,
                           ffd_location *locations, chain_point *points, double *embed_seconds,
                           double *deform_seconds, ffd_error *error);

#endif
