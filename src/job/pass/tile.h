/* tile.h - a tile of a pass: the vertices that a thread processes at a time. Internal to job/pass. */
#ifndef FFD_JOB_PASS_TILE_H
#define FFD_JOB_PASS_TILE_H

#include "job/figures/pass_totals.h"
#include "job/pass/mesh_pass.h"
#include "job/pass/vertex_transform.h"

#define PASS_TILE VERTEX_TRANSFORMS /* the most vertices of a tile */

struct pass_tile;

/* Points of a tile that go through the chain together: the selected vertices, or those that a morph target
   moves. */
typedef struct tile_points {
    const struct pass_tile *tile;
    const double *offsets; /* 3 a vertex of the tile: of the morph target; NULL: of the base */
    size_t shape;          /* the target's number, or SHAPE_SHOWN */
    chain_rounding cells;  /* the rounding cells of the points */
    bool are_all;          /* all vertices of the tile, in their order; else which lists them */
    uint32_t which[PASS_TILE];
    size_t count;
    double stored[3 * PASS_TILE]; /* 3 a vertex of the tile: its position in the file, without the offset */
    /* One entry a point: */
    double position[3 * PASS_TILE]; /* in the lattice's space, at rest, then deformed */
    double delta[3 * PASS_TILE], gradient[9 * PASS_TILE];
    point_outcome outcomes[PASS_TILE];
} tile_points;

/* In place of a target's number: the shape with the default weights of all targets. */
#define SHAPE_SHOWN SIZE_MAX

/* Scratch memory for a morph target. */
typedef struct shape_scratch {
    double offsets[3 * PASS_TILE]; /* from the file, then replaced by the results */
    tile_points moved;             /* the vertices that the target moves */
    double before[3 * PASS_TILE];  /* directions without the target, from the file */
    double normals[3 * PASS_TILE]; /* with the target; deformed */
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
    tile_points base; /* the selected vertices, until spread makes them all vertices of the tile */
    chain_scratch
        chain;       /* its locations: of the selected vertices, then of those that a morph target moves */
    turn_list turns; /* the points at which det F may be 0 or less, if only these are wanted */
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

/* A tile that a thread works on. */
typedef struct pass_tile {
    const mesh_pass *pass;
    const mesh_part *part;
    size_t part_number;
    size_t first, count;   /* its vertices in the part */
    uint64_t first_number; /* the number of the first one in the document */
    tile_scratch *scratch;
    pass_totals *totals;     /* of this tile */
    struct chain_pace *pace; /* pass->pace in the calling thread, else NULL */
} pass_tile;

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

/* Returns the index in the tile of the vertex that point i is. */
static inline size_t ffd_tile_vertex(const tile_points *points, size_t i)
{
    return points->are_all ? i : points->which[i];
}

/* The largest coordinate that the file's number type can hold. */
static inline double ffd_largest_coordinate(const mesh_document *document)
{
    const double own = document->largest_coordinate;
    return own > 0 ? own : document->format->largest_coordinate;
}

#endif
