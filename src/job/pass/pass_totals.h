/* pass_totals.h - the figures of a pass, which are joined tile by tile. */
#ifndef FFD_JOB_PASS_PASS_TOTALS_H
#define FFD_JOB_PASS_PASS_TOTALS_H

#include "mesh/mesh.h"
#include <ffd/embedding.h>
#include <ffd/job.h>

typedef struct pass_totals {
    uint64_t vertices, counts[FFD_VERTEX_STATUS_COUNT], moved;
    uint64_t located; /* vertices with a u,v,w in some link: those that the residuals are of */
    double residual_square_max, residual_square_sum; /* relative to the lattice's diagonal */
    uint64_t evaluations;
    uint32_t evaluations_max;
    double displacement_square_max, displacement_square_sum;
    ffd_bounds before, after; /* in the lattice's space */
    ffd_bounds shapes;    /* likewise, where morph targets and what is shown of them bring vertices, deformed;
                             only    of a pass that is to find it */
    uint64_t outside_all; /* vertices outside of every lattice */
    uint64_t multiple_any; /* with several u,v,w in at least one */
    uint64_t moved_twice;  /* on a face that two lattices share, and moved by both, one after the other */
    uint64_t disagreeing;  /* of blocks: on a face that another block moves otherwise */
    double disagreement;   /* their largest difference */
    uint64_t unresolved;   /* whose search ended at its limits */
    uint64_t degenerate;   /* the singular ones among the others: J has no inverse there */
    uint64_t first_outside, first_invalid, first_overflow; /* vertex numbers; UINT64_MAX: none */
    uint64_t first_missed;        /* vertex that the u,v,w of an embedding miss; UINT64_MAX: none */
    double missed_by;             /* its distance, world units */
    uint64_t shapes_outside;      /* vertices that a morph target moves to a position outside of a lattice */
    uint64_t shown_outside;       /* likewise what the weights of all targets show */
    uint64_t first_shape_outside; /* UINT64_MAX: none */
    uint64_t shapes_invalid;      /* finite vertices that a morph target moves to a position that is not */
    uint64_t extended;            /* of those with status outside: displaced as the border is, */
    uint64_t extended_moved;      /* and where that moves */
    uint64_t kept;                /* vertices that were marked as staying, where marks are wanted */
    uint64_t normals_collapsed, transforms_singular;
    skin_weights weights;
    uint64_t normals_carried;             /* not by a pass: see ffd_job_result */
    uint64_t splats_carried;              /* whose rotations or sizes follow, */
    uint64_t splats_flattened;            /* of these: that lose a size, */
    uint64_t splats_broken;               /* and those that move without, since they are no numbers */
    uint64_t splats_moved;                /* vertices of parts of splats that do not follow */
    size_t splat_parts[FFD_BEHIND_NAMES]; /* the first parts of these */
    int splat_part_count;
    double det_outside;         /* the least det F of vertices that are extended, as det_min; else infinite */
    uint64_t first_det_outside; /* the first such vertex */
    double det_min, det_max; /* of F, where it is asked for, a link acts and none is singular; else min > max
                              */
    /* Vertices that are not simply inside and not shown, which the counts above leave out: in no face, line
       or point, or of hidden nodes. */
    uint64_t unused, hidden;
    uint64_t unshown_outside, first_unshown_outside; /* of them: outside of a lattice; UINT64_MAX: none */
    uint8_t *others; /* of a tile until it is joined: what is known of each chosen vertex that is not simply
                        inside (0: it is); NULL: all are */
    double embed_seconds, deform_seconds; /* summed over threads */
} pass_totals;

/* No figures yet. */
void ffd_totals_clear(pass_totals *totals);

/* Notes that so many vertices of a part of splats have moved. Parts come in their order. */
void ffd_totals_note_splats(pass_totals *totals, size_t part, uint64_t moved);

/* Adds those of a tile, which comes after the ones that are there. */
void ffd_totals_join(const pass_totals *tile, pass_totals *all);

#endif
