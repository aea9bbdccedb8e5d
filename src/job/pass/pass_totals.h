/* pass_totals.h - the figures of a pass, which are joined tile by tile. */
#ifndef FFD_JOB_PASS_PASS_TOTALS_H
#define FFD_JOB_PASS_PASS_TOTALS_H

#include <ffd/embedding.h>
#include <ffd/job.h>

typedef struct pass_totals {
    uint64_t vertices, counts[FFD_VERTEX_STATUS_COUNT], moved;
    uint64_t located; /* vertices with a u,v,w in some link: those that the residuals are of */
    double residual_square_max, residual_square_sum; /* relative to the lattice's diagonal */
    uint64_t evaluations;
    uint32_t evaluations_max;
    double displacement_square_max, displacement_square_sum;
    ffd_bounds before, after;                              /* in the lattice's space */
    uint64_t outside_any;                                  /* vertices outside of at least one lattice */
    uint64_t multiple_any;                                 /* likewise */
    uint64_t unresolved;                                   /* whose search ended at its limits */
    uint64_t first_outside, first_invalid, first_overflow; /* vertex numbers; UINT64_MAX: none */
    uint64_t shapes_outside; /* vertices that a morph target moves to a position outside of a lattice */
    uint64_t first_shape_outside, first_shape_invalid; /* of morph targets; UINT64_MAX: none */
    uint64_t extended; /* of those with status outside: displaced as the border is */
    uint64_t normals_collapsed, transforms_singular;
    uint64_t normals_carried; /* not by a pass: see ffd_job_result */
    double det_min, det_max;  /* of F, where it is asked for, a link acts and none is singular; else min > max
                               */
    double embed_seconds, deform_seconds; /* summed over threads */
} pass_totals;

/* No figures yet. */
void ffd_totals_clear(pass_totals *totals);

/* Adds those of a tile, which comes after the ones that are there. */
void ffd_totals_join(const pass_totals *tile, pass_totals *all);

#endif
