/* chain.h - the lattices of a job, one after the other or side by side, and a run of points that they
   move. */
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

/* The most lattices, one after the other, of which marks tell parts of the volume (mark_layout). */
#define MOST_PARTED 16

/* Which points count as outside of a lattice, and how they move. */
typedef struct chain_outside {
    bool extend;    /* move like the nearest border point; else stay */
    double falloff; /* distance over which the extended displacement fades to 0, world units; 0: no fading */
    double snap;    /* points that miss the volume by at most this are inside: in world units, or */
    bool snap_is_relative; /* relative to the diagonal of the rest lattice */
} chain_outside;

/* The parts into which marks divide a direction of a link (marks.h). */
typedef struct link_parts {
    double first, scale; /* the start of the domain, and how many parts a unit has */
    int count;
} link_parts;

/* Faces of all lattices that are held still (`--seam`). */
typedef struct chain_seal {
    int layers;     /* the continuity plus 1; 0: none are held */
    unsigned faces; /* as of ffd_lattice_seal; FFD_FACES_CUT: those that the mesh cuts */
    bool closes;    /* the chain has one link, whose volume all edges of the mesh leave by held faces */
} chain_seal;

typedef struct chain_link {
    ffd_lattice *lattice; /* as given: vertices have its u,v,w */
    ffd_lattice *sealed;  /* the same at rest, with held faces, which moves points in its place; NULL: none */
    unsigned held;        /* these faces: bit 2 a + side, as of ffd_lattice_seal */
    const ffd_lattice *moved; /* the same at rest, lent: it moves points in place of both; NULL: none */
    ffd_locator *locator;     /* NULL until the lattice is fitted to the mesh */
    bool lattice_is_lent, locator_is_lent; /* owned by the chain's share */
    const char *path; /* of the lattice file, the caller's; NULL if values are set in it */
    file_stamp stamp; /* of the file at path, taken before it was read */
    hash128 rest; /* hash of the rest volume and its search method; set with the locator, if the chain has a
                     share */
    const boundary *border; /* the locator's; NULL if points outside stay */
    double falloff;         /* as in chain_outside */
    double snap;            /* in world units; set with the locator */
    path_list box_files;    /* files of the meshes that the lattice file names for its box */
    bool has_folds;         /* folds are known: */
    ffd_folds folds;        /* of the lattice, which was already fitted; never of `sealed` */
    /* Set by ffd_seams_find: */
    bool is_convex;  /* the rest volume is a box: its displacement is continuous, also as it is extended */
    bool opens_axis; /* ffd_lattice_opens_axis */
    bool is_still;   /* no control point is moved */
    link_parts parts[3];
    size_t parts_plane; /* the first of their three planes of marks; 0: none */
} chain_link;

/* A direction of a link in which the first and the last rest face coincide, and the moves separate them. */
typedef struct chain_seam {
    size_t link;
    int direction;
} chain_seam;

/* Where the marks of a point are among planes of one byte a point. Written by marks.h. */
typedef struct mark_layout {
    size_t kept;   /* planes 0 .. kept - 1: bits, see KEPT_ALWAYS */
    size_t owners; /* the first of the two planes of owners, which blocks have; 0: none */
    size_t parts;  /* the first plane of parts, three for each of parted_count links; with blocks, for all */
    size_t parted_count;
    uint16_t parted[MOST_PARTED]; /* these links, ascending */
    size_t planes;                /* of all marks */
} mark_layout;

typedef struct lattice_chain {
    chain_link *links;
    size_t count;
    bool blocks; /* side by side, each on the points at rest; else one after the other */
    bounds *
        boxes; /* of each link, a box that holds its volume; NULL for a single link or until all are fitted */
    box_tree tree; /* over the boxes; blocks only */
    double
        slack[3]; /* tolerance of lookups in the tree, to which 16 eps of the point's coordinates are added */
    chain_seam *seams; /* seam_count, ascending by link; filled once all links are fitted */
    size_t seam_count;
    mark_layout marks;    /* of the points of a pass (marks.h) */
    memory_budget memory; /* charged with the lattices */
    chain_outside outside;
    chain_seal seal;
    ffd_isa isa;          /* of the kernels; does not change results */
    ffd_job_cache *cache; /* cache shared with the jobs before and after, or NULL */
} lattice_chain;

/* Returns the lattice whose control points move what is in the link. */
static inline const ffd_lattice *ffd_link_mover(const chain_link *link)
{
    return link->moved ? link->moved : link->sealed ? link->sealed : link->lattice;
}

/* The number of u,v,w that a point may have in this chain: one in each link, or one in all blocks. */
static inline size_t ffd_chain_layers(const lattice_chain *chain)
{
    return chain->blocks ? 1 : chain->count;
}

/* What is known of one point after all links; with blocks, in its own block. */
typedef struct point_outcome {
    double residual_square; /* largest of all links, relative to the link's diagonal */
    uint32_t evaluations;
    uint8_t
        status;    /* ffd_vertex_status: the largest one other than outside; outside if no link has another */
    bool moved;    /* a moved control point acts on it in some link */
    bool located;  /* has u,v,w in some link */
    bool outside;  /* outside of all links */
    bool multiple; /* has several u,v,w in some link */
    bool unresolved; /* the search in some link ended at its limits */
    bool disagrees;  /* blocks: it is on a face where another block moves it differently */
    bool extended;   /* displaced by a link that it is outside of: a border point was within the falloff */
    bool collapsed;  /* some link collapses space there: det F is 0 within rounding. Known where the run has
                        turns, and where gradients are wanted of a point that is extended */
} point_outcome;

/* Rounding cells of the points of a run (mesh/rounding.h). */
typedef struct chain_rounding {
    /* Fills half with half the extents of a point's rounding cell along each axis of the lattice's space.
       is_first: the point is at its position in the file; else at x, where earlier links have moved it. */
    void (*find)(const void *context, size_t point, bool is_first, const double x[3], double half[3]);
    const void *context;
} chain_rounding;

/* The most points in a run. */
#define CHAIN_RUN DISPLACEMENT_BATCH

/* The owner of a point that is in no block. */
#define BLOCK_NONE UINT32_MAX

/* The border point that an extended point follows, and with blocks the block that it is of. */
typedef struct border_place {
    boundary_point nearest;
    uint32_t block;
} border_place;

/* Scratch memory for blocks, beside that of single links. */
typedef struct block_scratch {
    double x[3 * CHAIN_RUN];       /* the points that are looked up in one block, contiguous */
    ffd_location found[CHAIN_RUN]; /* and their locations in it */
    uint32_t asked[CHAIN_RUN];     /* block to look up next, by point */
    uint32_t pending[CHAIN_RUN], sorted[CHAIN_RUN], again[CHAIN_RUN]; /* point indices */
    size_t pending_count;
} block_scratch;

/* A point on a face of a link, as it was before the link moved it. */
typedef struct face_place {
    double x[3], uvw[3];
    double half[3]; /* half the extents of its rounding cell */
    size_t link;
    uint32_t point;
    bool is_counted;
} face_place;

/* Scratch memory of one thread. Before the first run, call ffd_displacement_scratch_clear on displacement, or
   zero all of it. */
typedef struct chain_scratch {
    ffd_location locations[CHAIN_RUN]; /* in the last link; with blocks, in the point's own block */
    double delta[3 * CHAIN_RUN], gradient[9 * CHAIN_RUN];
    turn_list turns;              /* of a link among several */
    uint8_t is_turned[CHAIN_RUN]; /* an odd number of links have turned the point inside out */
    uint32_t inside[CHAIN_RUN];   /* indices of the points that have u,v,w */
    uint8_t moves[CHAIN_RUN];
    uint32_t owners[CHAIN_RUN]; /* blocks: the point's own block, or BLOCK_NONE */
    block_scratch blocks;
    face_place places[CHAIN_RUN]; /* of several links one after the other */
    size_t place_count;
    uint8_t on_face[CHAIN_RUN]; /* whether places has the point */
    double cell;                /* several links: half the diagonal of the largest rounding cell in the run */
    displacement_scratch displacement;
} chain_scratch;

struct chain_pace;

/* A run of points that is sent through the chain. */
typedef struct chain_run {
    double *x;                      /* 3 a point: replaced by the new positions */
    size_t count;                   /* at most CHAIN_RUN */
    bool located;                   /* scratch->locations already holds those of the first link; with
                                       blocks, scratch->owners the blocks too */
    border_place *borders;          /* NULL, or an entry for each point: of those that the first link, or
                                       blocks, extend to; filled, or known if the run is located */
    bool first_only;                /* blocks: do not look up a point on a face in other blocks too */
    const chain_rounding *rounding; /* NULL: coordinates are exact */
    chain_scratch *scratch;
    struct chain_pace *pace; /* pace.h; or NULL */
    /* Filled, one entry a point: */
    double *delta;    /* 3: displacement by all links, world units; zeros where nothing acts */
    double *gradient; /* 9: F - I of the whole deformation; or NULL */
    turn_list *turns; /* NULL, or with gradient: the points are added where det F may be 0 or less; of several
                         links, one after the other, those where it is less, or 0 */
    bool only_turns;  /* not filled: gradients are wanted only there. Several links do not fill them then */
    point_outcome *outcomes;
    uint8_t *kept; /* chain->marks.planes planes of CHAIN_RUN bytes, or NULL: bits of points that links leave
                      are added, other marks are set */
    bool keeps;    /* some bits were added */
    double embed_seconds, deform_seconds; /* elapsed times are added */
    /* Added: the number of points on a common face of two links, one after the other, that both move. */
    size_t moved_twice;
    /* Blocks: the number of points on a face that another block moves differently, and the largest
       difference. */
    size_t disagreeing;
    double disagreement;
} chain_run;

#endif
