/* tile.h - a tile of a pass: the vertices that one thread processes at a time. Used within pass only. */
#ifndef FFD_JOB_PASS_TILE_H
#define FFD_JOB_PASS_TILE_H

#include "job/pass/mesh_pass.h"
#include "job/pass/pass_totals.h"
#include "job/pass/vertex_transform.h"
#include <stdatomic.h>

#define PASS_TILE VERTEX_TRANSFORMS /* at most */

/* What a morph target of a tile needs. Of the vertices that it moves, the ones listed in `moved`, position
   and outcome are stored one after the other. */
typedef struct shape_scratch {
    double offsets[3 * PASS_TILE]; /* as the file has them, then what becomes of them */
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

/* What the Gaussian splats of a tile need. */
typedef struct splat_scratch {
    splat_ellipsoid splats[PASS_TILE];
    splat_turn turns[PASS_TILE];
    uint8_t outcomes[PASS_TILE], changed[PASS_TILE];
} splat_scratch;

/* What one worker needs for a tile. */
typedef struct tile_scratch {
    double raw[3 * PASS_TILE]; /* positions as the file has them */
    bool all_chosen;           /* all vertices of the tile are selected; else those are that are listed */
    uint32_t chosen[PASS_TILE];
    size_t chosen_count;
    chain_scratch chain; /* its locations: of the chosen ones, then of those that a morph target moves */
    /* Values of the chosen vertices, one after the other, until they are spread to
       their slots in the tile. */
    double position[3 * PASS_TILE]; /* in the lattice's space, from rest to deformed */
    double delta[3 * PASS_TILE], gradient[9 * PASS_TILE];
    point_outcome point_outcomes[PASS_TILE];
    uint8_t changed[PASS_TILE];
    vertex_transforms transforms;
    double normals[3 * PASS_TILE], tangents[4 * PASS_TILE];
    uint8_t normals_changed[PASS_TILE], tangents_changed[PASS_TILE];
    uint32_t of_points[PASS_TILE]; /* the points that normals belong to, where they are not one a vertex */
    uint8_t outcomes[PASS_TILE];   /* what became of these */
    uint8_t *kept;                 /* marks of the chain, all 0 between tiles; NULL where none are wanted */
    shape_scratch *shape;          /* NULL where the document has no morph targets */
    splat_scratch *splat;          /* NULL where no splats follow */
    ffd_status status;             /* of the first tile of this worker that failed, and what it said */
    ffd_error error;
} tile_scratch;

typedef struct part_work {
    const mesh_pass *pass;
    const mesh_part *part;
    size_t part_number;
    uint64_t first_vertex; /* the part's first vertex in the document */
    tile_scratch *scratch; /* one a worker */
    pass_totals *tiles;    /* what each tile adds */
    atomic_bool stopped;   /* a tile failed: the others need not be looked at */
} part_work;

/* Whether the pass looks at the morph targets of a part. */
static inline bool ffd_pass_takes_shapes(const mesh_pass *pass, const mesh_part *part)
{
    const bool deforms = (pass->write || pass->counts_shapes) && !pass->document->keeps_base;
    return part->shape_count > 0 && !pass->document->shown && (deforms || pass->bounds_shapes);
}

/* Whether rotations and sizes of a part's splats follow the pass. */
static inline bool ffd_pass_takes_splats(const mesh_pass *pass, const mesh_part *part)
{
    return pass->write && part->has_ellipsoids && !part->singular && !part->repeats_positions &&
           !pass->document->keeps_base && !pass->document->converted;
}

/* Whether the totals' bounds are of another shape of the part than its own vertices. */
static inline bool ffd_pass_bounds_shown(const mesh_pass *pass, const mesh_part *part)
{
    return pass->bounds_shown && part->shows_shapes && ffd_pass_takes_shapes(pass, part);
}

/* The vertex of the tile that the chosen one with this number is. */
static inline size_t ffd_tile_chosen(const tile_scratch *scratch, size_t i)
{
    return scratch->all_chosen ? i : scratch->chosen[i];
}

/* The largest coordinate that the numbers of the document's file can hold. */
static inline double ffd_largest_coordinate(const mesh_document *document)
{
    const double own = document->largest_coordinate;
    return own > 0 ? own : document->format->largest_coordinate;
}

#endif
