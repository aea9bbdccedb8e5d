/* tile.h - a tile of a pass: the vertices that a thread processes at a time. Internal to job/pass. */
#ifndef FFD_JOB_PASS_TILE_H
#define FFD_JOB_PASS_TILE_H

#include "job/figures/pass_totals.h"
#include "job/pass/mesh_pass.h"
#include "job/pass/vertex_transform.h"
#include <stdatomic.h>

#define PASS_TILE VERTEX_TRANSFORMS /* the most vertices of a tile */

/* Scratch memory for a morph target. `moved` lists the vertices that the target moves; position, moved_delta
   and outcomes hold their values contiguously. */
typedef struct shape_scratch {
    double offsets[3 * PASS_TILE]; /* from the file, then replaced by the results */
    double position[3 * PASS_TILE];
    size_t moved[PASS_TILE];
    size_t moved_count;
    double moved_delta[3 * PASS_TILE], moved_gradient[9 * PASS_TILE];
    point_outcome moved_outcomes[PASS_TILE];
    const double *gradients[PASS_TILE]; /* of every vertex: the base's where the target does not move it */
    double base[3 * PASS_TILE];         /* positions or directions without the target */
    double normals[3 * PASS_TILE];      /* deformed, with the target */
    double tangents[4 * PASS_TILE];
    uint8_t changed[PASS_TILE];
} shape_scratch;

/* Scratch memory for Gaussian splats. */
typedef struct splat_scratch {
    splat_ellipsoid splats[PASS_TILE];
    splat_turn turns[PASS_TILE];
    uint8_t outcomes[PASS_TILE], changed[PASS_TILE];
} splat_scratch;

/* Scratch memory of one worker. */
typedef struct tile_scratch {
    double raw[3 * PASS_TILE]; /* positions in the file's space */
    bool all_chosen;           /* all vertices of the tile are selected; else chosen lists those that are */
    uint32_t chosen[PASS_TILE];
    size_t chosen_count;
    chain_scratch chain; /* its locations: of the chosen vertices, then of those that a morph target moves */
    /* Values of the chosen vertices, contiguous until spread moves them to their slots in the tile. */
    double position[3 * PASS_TILE]; /* in the lattice's space, at rest, then deformed */
    double delta[3 * PASS_TILE], gradient[9 * PASS_TILE];
    point_outcome point_outcomes[PASS_TILE];
    turn_list turns; /* the chosen vertices at which det F may be 0 or less, if only these are wanted */
    uint8_t changed[PASS_TILE];
    vertex_transforms transforms;
    double normals[3 * PASS_TILE], tangents[4 * PASS_TILE];
    uint8_t normals_changed[PASS_TILE], tangents_changed[PASS_TILE];
    uint32_t of_points[PASS_TILE]; /* points that normals belong to, if not one a vertex */
    uint8_t outcomes[PASS_TILE];   /* ATTRIBUTE_.. of each normal or tangent */
    uint8_t *kept;                 /* marks of the chain, bits 0 between tiles; NULL if not wanted */
    shape_scratch *shape;          /* NULL if the document has no morph targets */
    splat_scratch *splat;          /* NULL if no splats follow */
    ffd_status status;             /* of the first tile of this worker that failed, with its message */
    ffd_error error;
} tile_scratch;

typedef struct part_work {
    const mesh_pass *pass;
    const mesh_part *part;
    size_t part_number;
    uint64_t first_vertex; /* number of the part's first vertex in the document */
    int workers;
    tile_scratch *scratch; /* one for each worker */
    pass_totals *tiles;    /* figures of each tile */
    atomic_bool stopped;   /* a tile has failed: skip the others */
} part_work;

/* Whether the pass processes the morph targets of a part. */
static inline bool ffd_pass_takes_shapes(const mesh_pass *pass, const mesh_part *part)
{
    const bool deforms = (pass->write || pass->counts_shapes) && !pass->document->keeps_base;
    return part->shape_count > 0 && !pass->document->shown && (deforms || pass->bounds_shapes);
}

/* Whether the pass deforms rotations and sizes of a part's splats. */
static inline bool ffd_pass_takes_splats(const mesh_pass *pass, const mesh_part *part)
{
    return pass->write && part->has_ellipsoids && !part->singular && !part->repeats_positions &&
           !pass->document->keeps_base && !pass->document->converted;
}

/* Whether the results go to the document. */
static inline bool ffd_pass_stores(const mesh_pass *pass)
{
    return pass->write && !pass->discards;
}

/* Returns the index in the tile of chosen vertex i. */
static inline size_t ffd_tile_chosen(const tile_scratch *scratch, size_t i)
{
    return scratch->all_chosen ? i : scratch->chosen[i];
}

/* The largest coordinate that the file's number type can hold. */
static inline double ffd_largest_coordinate(const mesh_document *document)
{
    const double own = document->largest_coordinate;
    return own > 0 ? own : document->format->largest_coordinate;
}

#endif
