/* chain.h - the lattices of a job in their order, and what they do to a run of points. */
#ifndef FFD_JOB_CHAIN_CHAIN_H
#define FFD_JOB_CHAIN_CHAIN_H

#include "base/fail.h"
#include "base/file/input.h"
#include "base/memory/hash.h"
#include "deform/displacement.h"
#include "embed/boundary/boundary.h"
#include "embed/frame/box_tree.h"
#include <ffd/embedding.h>
#include <ffd/fold.h>
#include <ffd/job.h>
#include <ffd/lattice.h>
#include <stdbool.h>
#include <stdint.h>

/* What becomes of points outside a lattice. */
typedef struct chain_outside {
    bool extend;    /* they get the displacement of the nearest point of the border; else they stay */
    double falloff; /* which fades to nothing over this distance, world units; 0: it does not */
} chain_outside;

typedef struct chain_link {
    ffd_lattice *lattice;
    ffd_locator *locator;                                  /* NULL until the lattice is fitted to the mesh */
    bool lattice_is_lent, locator_is_lent, border_is_lent; /* by the chain's share */
    const char *path; /* the caller's: of a file in which no values are set; or NULL */
    file_stamp stamp; /* its, from before it was read */
    hash128 rest; /* of the rest volume and how it is searched, once there is a locator; only in a chain with
                     a share */
    boundary *border; /* likewise; NULL too where points outside stay */
    double falloff;   /* chain_outside's */
    bool has_folds;   /* they were looked for: */
    ffd_folds folds;  /* of the lattice, which was fitted then */
} chain_link;

typedef struct lattice_chain {
    chain_link *links;
    size_t count;
    chain_outside outside;
    ffd_isa isa;      /* of the kernels; changes no bit */
    ffd_share *share; /* with jobs before and after, or NULL */
} lattice_chain;

/* Frees what the chain owns: what is lent stays. Leaves an empty chain. */
void ffd_chain_free(lattice_chain *chain);

/* Beyond it a link, whose lattice is fitted, moves nothing: the bounds of the control points hold the
   volume, and what is extended goes on from there. */
bounds ffd_chain_reach(const lattice_chain *chain, size_t link);

/* What the links know of one point. */
typedef struct point_outcome {
    double residual_square; /* relative to the link's diagonal, the greatest of the links' */
    uint32_t evaluations;
    uint8_t status;  /* ffd_vertex_status, the highest of the links' */
    bool moved;      /* some link's control points act on it: its displacement is more than zeros */
    bool located;    /* has u,v,w in some link */
    bool outside;    /* of some link */
    bool multiple;   /* in some link */
    bool unresolved; /* the search for some link ended at its limits */
    bool extended;   /* by a link that it is outside of: its border was there, and within the falloff */
} point_outcome;

/* Most points of a run. */
#define CHAIN_RUN DISPLACEMENT_BATCH

/* What one thread needs to send runs through the chain; before the first its displacement is to be cleared
   (ffd_displacement_scratch_clear), or all of it zeroed. */
typedef struct chain_scratch {
    ffd_location locations[CHAIN_RUN]; /* in the link that was last */
    double delta[3 * CHAIN_RUN], gradient[9 * CHAIN_RUN];
    uint32_t inside[CHAIN_RUN]; /* points that have u,v,w */
    uint8_t moves[CHAIN_RUN];
    displacement_scratch displacement;
} chain_scratch;

/* A run of points on its way through the chain. */
typedef struct chain_run {
    double *x;    /* 3 a point, changed to their new positions */
    size_t count; /* CHAIN_RUN at most */
    bool located; /* the first link's locations are there already */
    chain_scratch *scratch;
    /* Filled: one a point. */
    double *delta;    /* 3: the displacement by all links, world units; zeros where nothing acts */
    double *gradient; /* 9: of the composed deformation, F - I; or NULL */
    point_outcome *notes;
    double embed_seconds, deform_seconds; /* the time taken is added */
} chain_run;

/* Sends the points through links [0, links). */
ffd_status ffd_chain_apply(const lattice_chain *chain, size_t links, chain_run *run, ffd_error *error);

#endif
