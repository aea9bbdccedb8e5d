/* chain.h - the lattices of a job, in their order or side by side, and a run of points on its way through
 * them.
 */
#ifndef FFD_JOB_CHAIN_CHAIN_H
#define FFD_JOB_CHAIN_CHAIN_H

#include "base/fail.h"
#include "base/file/input.h"
#include "base/file/path_list.h"
#include "base/memory/hash.h"
#include "deform/displacement.h"
#include "embed/boundary/boundary.h"
#include "embed/frame/box_tree.h"
#include "mesh/memory_budget.h"
#include <ffd/embedding.h>
#include <ffd/fold.h>
#include <ffd/job.h>
#include <ffd/lattice.h>
#include <stdbool.h>
#include <stdint.h>

/* What is done with points outside a lattice, and which these are. */
typedef struct chain_outside {
    bool extend;           /* they get the displacement of the nearest point of the border; else they stay */
    double falloff;        /* which fades to nothing over this distance, world units; 0: it does not */
    double snap;           /* points that miss the volume by no more than this are inside: world units or, */
    bool snap_is_relative; /* parts of the rest lattice's diagonal */
} chain_outside;

typedef struct chain_link {
    ffd_lattice *lattice;
    ffd_locator *locator;                  /* NULL until the lattice is fitted to the mesh */
    bool lattice_is_lent, locator_is_lent; /* by the chain's share */
    const char *path;                      /* the caller's: of a file in which no values are set; or NULL */
    file_stamp stamp;                      /* its, from before it was read */
    hash128 rest; /* of the rest volume and how it is searched, once there is a locator; only in a chain with
                     a share */
    const boundary *border; /* the locator's; NULL where points outside stay */
    double falloff;         /* chain_outside's */
    double snap;            /* its, in world units, once there is a locator */
    path_list box_files;    /* of the meshes that the lattice file names for its box */
    bool has_folds;         /* they were looked for: */
    ffd_folds folds;        /* of the lattice, which was fitted then */
} chain_link;

/* A direction of a link whose two rest faces are one, and which the moves take apart. */
typedef struct chain_seam {
    size_t link;
    int direction;
} chain_seam;

typedef struct lattice_chain {
    chain_link *links;
    size_t count;
    bool blocks;       /* side by side, on the points at rest; else one after the other */
    bounds *boxes;     /* of several links: what holds each one's volume, once all are fitted; else NULL */
    box_tree tree;     /* over the boxes of blocks, */
    double slack[3];   /* which may be missed by this and 16 eps of the point's own coordinates */
    chain_seam *seams; /* seam_count, by link; once all are fitted */
    size_t seam_count;
    memory_budget memory; /* of the lattices, which have taken theirs of it */
    chain_outside outside;
    ffd_isa isa;      /* of the kernels; changes no bit */
    ffd_share *share; /* with jobs before and after, or NULL */
} lattice_chain;

/* How many u,v,w a point may have on its way: one in each link, or one in all blocks. */
static inline size_t ffd_chain_layers(const lattice_chain *chain)
{
    return chain->blocks ? 1 : chain->count;
}

/* What the links know of one point: of blocks the one that has it. */
typedef struct point_outcome {
    double residual_square; /* relative to the link's diagonal, the greatest of the links' */
    uint32_t evaluations;
    uint8_t status; /* ffd_vertex_status: outside where no link has more to say, else the highest other one */
    bool moved;     /* some link's control points act on it: its displacement is more than zeros */
    bool located;   /* has u,v,w in some link */
    bool outside;   /* of all links */
    bool multiple;  /* in some link */
    bool unresolved; /* the search for some link ended at its limits */
    bool disagrees;  /* of blocks: it is on a face, and another block moves it otherwise */
    bool extended;   /* displaced by a link that it is outside of: a point of its border was
                        found within the falloff */
} point_outcome;

/* What the points of a run stand for. */
typedef struct chain_rounding {
    /* Finds how far the cell of a point reaches along each axis (mesh/rounding.h), in the lattice's space.
       is_first: the point is where the file has it; else it is at x, where links before have brought it. */
    void (*find)(const void *context, size_t point, bool is_first, const double x[3], double half[3]);
    const void *context;
} chain_rounding;

/* Most points of a run. */
#define CHAIN_RUN DISPLACEMENT_BATCH

/* Marks of what does not move with the others: bit 0 of a point that no link may move, bit l + 1 of one that
   link l leaves where it is because it is outside of it; further ones as ffd_chain_marked says. 8 bits a
   byte, in planes of a byte for each point. */
#define KEPT_ALWAYS 1u

/* How many planes the marks of so many links need. */
static inline size_t ffd_kept_planes(size_t links)
{
    return links / 8 + 1;
}

static inline size_t ffd_kept_plane(size_t link)
{
    return (link + 1) / 8;
}

static inline uint8_t ffd_kept_bit(size_t link)
{
    return (uint8_t)(1u << (link + 1) % 8);
}

/* What is not in a block. */
#define BLOCK_NONE UINT32_MAX

/* What blocks need beside the links' own scratch. */
typedef struct block_scratch {
    double x[3 * CHAIN_RUN];       /* points of one block, one after the other, */
    ffd_location found[CHAIN_RUN]; /* and where they are in it */
    uint32_t asked[CHAIN_RUN];     /* the block that a point is looked for in */
    uint32_t pending[CHAIN_RUN], sorted[CHAIN_RUN], again[CHAIN_RUN]; /* points */
    size_t pending_count;
} block_scratch;

/* A point that was found on a face of a link: as it arrived there. */
typedef struct face_place {
    double x[3], uvw[3];
    double half[3]; /* of the cell that it stands for */
    size_t link;
    uint32_t point;
    bool is_counted;
} face_place;

/* What one thread needs to send runs through the chain; before the first run its displacement must be cleared
   (ffd_displacement_scratch_clear), or all of it zeroed. */
typedef struct chain_scratch {
    ffd_location locations[CHAIN_RUN]; /* in the link that was last; of blocks in the point's own one */
    double delta[3 * CHAIN_RUN], gradient[9 * CHAIN_RUN];
    uint32_t inside[CHAIN_RUN]; /* points that have u,v,w */
    uint8_t moves[CHAIN_RUN];
    uint32_t owners[CHAIN_RUN]; /* of blocks: the one that has the point, or BLOCK_NONE */
    block_scratch blocks;
    face_place places[CHAIN_RUN]; /* of several links one after the other */
    size_t place_count;
    uint8_t on_face[CHAIN_RUN]; /* the point has a place */
    double cell;                /* of several links: half the largest that a point of the run stands for */
    displacement_scratch displacement;
} chain_scratch;

/* A run of points on its way through the chain. */
typedef struct chain_run {
    double *x;                      /* 3 a point, changed to their new positions */
    size_t count;                   /* CHAIN_RUN at most */
    bool located;                   /* the first link's locations are there already */
    const chain_rounding *rounding; /* NULL: the points stand for themselves */
    chain_scratch *scratch;
    /* Filled: one a point. */
    double *delta;    /* 3: the displacement by all links, world units; zeros where nothing acts */
    double *gradient; /* 9: of the composed deformation, F - I; or NULL */
    point_outcome *outcomes;
    /* ffd_kept_planes of CHAIN_RUN marks, or NULL: the marks of points that a link leaves are added. */
    uint8_t *kept;
    bool keeps;                           /* some were */
    double embed_seconds, deform_seconds; /* the time taken is added */
    /* Added: the points on a face that two links share, which both move, one after the other. */
    size_t moved_twice;
    /* Of blocks: points on a face that another block moves otherwise, and the largest difference. */
    size_t disagreeing;
    double disagreement;
    double *differences; /* filled: one a point, 0 where none moves it otherwise; or NULL */
} chain_run;

#endif
