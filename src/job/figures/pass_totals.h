/* pass_totals.h - the figures of a pass, accumulated tile by tile; figure_values.c clears and joins them. */
#ifndef FFD_JOB_FIGURES_PASS_TOTALS_H
#define FFD_JOB_FIGURES_PASS_TOTALS_H

#include "mesh/mesh.h"
#include <ffd/embedding.h>
#include <ffd/job.h>

/* What rounding to floats or doubles does to a part, in the file's space. */
typedef struct part_rounding {
    ffd_bounds box;     /* of the results */
    double error;       /* the largest one of a result; 0 if all are within the tolerance; */
    double float_error; /* that of floats, which quantized positions beyond their range become too */
    double before;      /* the largest half step of a coordinate at rest */
} part_rounding;

/* The part whose shape rounding changes most. */
typedef struct rounding_loss {
    double error, side; /* the largest error, and the part's largest side; zeros: none */
    bool of_doubles, of_steps;
} rounding_loss;

/* Vertices that are left outside although they miss the lattice by next to nothing. */
typedef struct near_misses {
    uint64_t count;
    uint64_t examined; /* of the vertices outside */
    double largest;    /* miss, world units */
    bool is_least;     /* there may be more: not all were examined */
} near_misses;

typedef struct pass_totals {
    bool is_visible; /* a displacement is large enough for the floats of the output */
    uint64_t vertices, counts[FFD_VERTEX_STATUS_COUNT], moved;
    uint64_t located; /* vertices with u,v,w in some link; residuals are over these */
    double residual_square_max, residual_square_sum; /* relative to the lattice's diagonal */
    uint64_t evaluations;
    uint64_t evaluations_max;
    double displacement_square_max, displacement_square_sum;
    ffd_bounds before, after; /* in the lattice's space */
    ffd_bounds shapes; /* likewise, of the deformed morph targets and the shape with default weights; only if
                          the pass asks for it */
    uint64_t outside_all; /* vertices outside of every lattice */
    near_misses misses;
    uint64_t multiple_any; /* vertices with several u,v,w in some lattice */
    uint64_t moved_twice;  /* vertices on a common face of two consecutive lattices that both move them */
    uint64_t disagreeing;  /* blocks: vertices on a face that another block moves differently */
    double disagreement;   /* the largest such difference */
    uint64_t unresolved;   /* vertices whose search ended at its limits */
    uint64_t degenerate;   /* the other singular vertices: J has no inverse there */
    uint64_t first_outside, first_invalid, first_overflow; /* indices of vertices; UINT64_MAX: none */
    uint64_t first_missed;        /* vertex for which an embedding's u,v,w are wrong; UINT64_MAX: none */
    double missed_by;             /* distance from the vertex to the point at u,v,w, world units */
    uint64_t shapes_outside;      /* vertices that a morph target moves to a position outside of a lattice */
    uint64_t first_shape_outside; /* index of a vertex; UINT64_MAX: none */
    /* Those of outside_all in parts whose default weights show another shape than the base. */
    uint64_t weighted_outside, first_weighted_outside;
    /* The same of the base, if the other figures are of the shape shown (ffd_totals_add_stored). */
    uint64_t base_outside, first_base_outside;
    bool of_shown;           /* they are */
    uint64_t shapes_invalid; /* finite vertices that a morph target moves to a position that is not finite */
    uint64_t extended;       /* vertices of status outside that are displaced like the border, */
    uint64_t extended_moved; /* and those of them that this moves */
    uint64_t kept;           /* vertices marked as staying; only if marks are wanted */
    uint64_t normals_collapsed, transforms_singular;
    part_rounding rounding; /* of a tile */
    rounding_loss lost;     /* of all parts */
    skin_weights weights;
    uint64_t normals_carried;  /* filled by recompute, not by a pass: see ffd_job_result */
    uint64_t splats_carried;   /* splats whose rotations or sizes follow, */
    uint64_t splats_flattened; /* those of them that lose a dimension, */
    uint64_t splats_broken;    /* and those that only move, as their rotation or size is not finite */
    uint64_t splats_moved;     /* vertices of parts of splats that move without rotations and sizes */
    size_t splat_parts[FFD_BEHIND_NAMES]; /* the first such parts */
    int splat_part_count;
    double det_outside;         /* the smallest det F of extended vertices, like det_min; else infinite */
    uint64_t first_det_outside; /* the first such vertex */
    /* Vertices in a lattice with det F < 0, beyond rounding, the first of them, and their least det F;
     * likewise. */
    uint64_t inverted, first_inverted;
    double det_inverted;
    uint64_t collapsed, first_collapsed; /* vertices in a lattice with det F = 0 within rounding; likewise */
    double det_min, det_max; /* range of det F over non-singular vertices that a link moves, if wanted; empty:
                                min > max */
    /* Vertices that are not simply inside and not visible (used by no face, line or point, or of hidden
       nodes). The counts above omit them. */
    uint64_t unused, hidden;
    uint64_t unshown_outside, first_unshown_outside; /* those outside of a lattice; first: UINT64_MAX: none */
    uint8_t *others; /* temporary, per tile: flags of each chosen vertex that is not simply inside (0: it is);
                        NULL: all are inside */
    double embed_seconds, deform_seconds; /* summed over threads */
} pass_totals;

/* Resets all figures. */
void ffd_totals_clear(pass_totals *totals);

/* Records the number of moved vertices in a part whose splats do not follow. Call it in the order of
   parts. */
void ffd_totals_note_splats(pass_totals *totals, size_t part, uint64_t moved);

/* Adds what concerns the stored shapes, base and morph targets, to the figures of the shape that default
   weights show. written: the results of the stored ones go to the file. */
void ffd_totals_add_stored(const pass_totals *stored, bool written, pass_totals *shown);

/* Judges the rounding of all tiles of a part. tolerance: of ffd_part_tolerance. kind: how it is stored. */
void ffd_totals_judge_rounding(const pass_totals *tiles, size_t count, double tolerance, rounding_kind kind,
                               pass_totals *all);

/* Adds the figures of a tile. Tiles must be added in order. */
void ffd_totals_join(const pass_totals *tile, pass_totals *all);

/* Lowers the index of the first vertex of a kind. */
static inline void ffd_note_first(uint64_t *first, uint64_t index)
{
    *first = index < *first ? index : *first;
}

#endif
