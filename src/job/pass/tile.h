/* tile.h - a tile of a pass: the vertices that a thread processes at a time, and what is done with them, each
   in a source of its own: the way of its points through the chain (tile_points.c), their weights
   (tile_weights.c), parts that move as one piece (tile_rigid.c), morph targets (pass_shapes.c), splats
   (pass_splats.c), rounding (tile_rounding.c), points that miss the volume by a rounding (tile_misses.c),
   counting (tile_totals.c). Internal to job/pass. */
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
    turn_list turns; /* the points at which det F may be 0 or less */
    uint8_t changed[PASS_TILE];
    double rest[3 * PASS_TILE]; /* with weights or pieces: the points before the chain */
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
    size_t part_index;
    size_t first, count;  /* its vertices in the part */
    uint64_t first_index; /* of the first one in the document */
    tile_scratch *scratch;
    pass_totals *totals;     /* of this tile */
    struct chain_pace *pace; /* pass->pace in the calling thread, else NULL */
} pass_tile;

/* Whether the pass processes the morph targets of a part. */
static inline bool ffd_pass_takes_shapes(const mesh_pass *pass, const mesh_part *part)
{
    const bool deforms = (pass->write || pass->counts_shapes) && !pass->only_base;
    return part->shape_count > 0 && pass->state == MESH_STORED && (deforms || pass->bounds_shapes);
}

/* Whether the pass deforms rotations and sizes of a part's splats. */
static inline bool ffd_pass_takes_splats(const mesh_pass *pass, const mesh_part *part)
{
    return pass->write && part->has_ellipsoids && !part->singular && !part->repeats_positions &&
           !pass->only_base && !pass->is_converted;
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

/* Prepares for the points of a tile. offsets: of all its vertices in a morph target (shape), or NULL. */
void ffd_tile_points_begin(const pass_tile *tile, const double *offsets, size_t shape, tile_points *points);

/* Puts point i, which is vertex v of the tile, to where it is at rest. */
void ffd_tile_place(tile_points *points, size_t i, size_t v);

/* The same, and lets it stay there. */
void ffd_tile_hold(tile_points *points, size_t i, size_t v);

/* Returns a run of the points through the chain. gradients: whether they are wanted. */
chain_run ffd_tile_run(tile_points *points, bool gradients);

/* Sends the points of a run through the chain, where each moves by its weight times the displacement, or with
   its piece. Errors: those of ffd_chain_apply. */
ffd_status ffd_tile_send(tile_points *points, chain_run *run, ffd_error *error);

/* Gives points of pieces the displacements and gradients of these. rest: the points before the chain. */
void ffd_tile_move_pieces(tile_points *points, const chain_run *run, const double *rest);
/* Whether a point is of a piece whose motion the part's node makes too: the point then stays. */
bool ffd_tile_is_at_rest(const tile_points *points, size_t i);
/* Notes how the gradients of all vertices stretch those that animations turn (after the selected vertices are
 * spread). */
void ffd_tile_note_stretches(const pass_tile *tile);

/* Adds the times of a run to the totals. */
void ffd_tile_add_times(const pass_tile *tile, const chain_run *run);

/* If the part's node or skin moves too (the rig follows), adjusts the displacements so that vertices end up
   where the deformation puts them in the scene. Vertices that are not finite stay. */
void ffd_tile_carry(tile_points *points, bool gradients);

/* Transforms the displacements to the file's space: p' = p + linear^{-1} delta. */
void ffd_tile_bring_back(tile_points *points);
/* Transforms the gradients to the file's space. */
void ffd_tile_bring_gradients_back(tile_points *points);

/* Widens the box by the points that count for bounds. Returns whether all points are finite. */
bool ffd_tile_widen(const tile_points *points, ffd_bounds *box);

/* Deforms the morph targets of a tile. Call it last: scratch holds the base's displacements and gradients in
   the file's space, and its deformed normals and tangents. Errors: those of ffd_chain_apply. */
ffd_status ffd_tile_shapes(const pass_tile *tile, ffd_error *error);

/* Finds how directions turn at the tile's vertices, in the file's space. Their gradients must still be in the
   lattice's space. */
void ffd_tile_splat_turns(const pass_tile *tile);

/* Deforms the splats of the tile and writes them. Their gradients must be in the file's space. */
void ffd_tile_splats(const pass_tile *tile);

/* Finds those of the visible vertices outside of the only lattice that miss it by next to nothing, if they
   are left where they are. Call it before the selected vertices are spread over the tile. Errors:
   FFD_E_MEMORY. */
ffd_status ffd_tile_find_misses(const pass_tile *tile, ffd_error *error);

/* Returns the rounding error of a part's results above which its shape changes, relative to its largest
   side. */
double ffd_part_tolerance(const mesh_document *document, const mesh_rounding *rounding);

/* Notes how fine the floats of a tile's positions are before it is displaced. */
void ffd_tile_rounding_at_rest(const pass_tile *tile);

/* Whether floats hold a displacement of the tile: the position of a vertex changes in the output. True too
   where the results are not rounded here. Call it before the vertices are displaced in the file's space. */
bool ffd_tile_shows(const pass_tile *tile);

/* Notes the rounding errors of the results, if they may exceed the tolerance. */
void ffd_tile_rounding_of_results(const pass_tile *tile);

/* Counts a tile's selected vertices at rest. Call it after their positions are read. */
void ffd_totals_count_rest(const pass_tile *tile);
/* Counts them after the chain has moved them, and stores the flags for ffd_totals_count_others. Errors:
   FFD_E_MEMORY. */
ffd_status ffd_totals_count_deformed(const pass_tile *tile, ffd_error *error);
/* Counts the vertices of a tile that are not simply inside. Call it after ffd_mesh_mark_used. */
void ffd_totals_count_others(const pass_tile *tile);

#endif
