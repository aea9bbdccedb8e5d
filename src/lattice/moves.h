/* moves.h - applies the moves of a lattice file to its control points. */
#ifndef FFD_LATTICE_MOVES_H
#define FFD_LATTICE_MOVES_H

#include "lattice/drag.h"
#include "lattice/mirror.h"
#include "lattice/move_action.h"
#include "lattice/shapes.h"
#include "lattice/spec.h"

/* One move, or its mirror image, before it is applied. The mirror image of a drag is in the same step: plane
   is its plane then. */
typedef struct move_step {
    const lattice_move *move;      /* as in the file */
    size_t index;                  /* of the move */
    const ready_move *ready;       /* in world units */
    const mirror_plane *plane;     /* NULL: not a mirror image */
    const unsigned char *selected; /* one byte for each control point */
    ffd_lattice *lattice;          /* in its state before the move */
    const rest_region *region;
    const double *inverse; /* inverse of the region's frame; NULL: world units */
    drag_solver *drag;     /* of a drag, with the mirrored places after those of the move; else NULL */
} move_step;

/* A callback for each step. */
typedef struct move_observer {
    ffd_status (*see)(void *context, const move_step *step, ffd_error *error);
    void *context;
} move_observer;

/* Fills targets (3 numbers for each place of a drag) with `by` of its places, in world units, and the mirror
   images of these. from: the places, or derivatives of them, of which `by` is taken. */
void ffd_drag_targets(const move_step *step, const spec_drag *from, double *targets);

/* Applies the moves of the spec to lattice->deformed and lattice->difference. region: for fractions of it.
   observer: called before each step; may be NULL. Errors: FFD_E_INVALID at the move, FFD_E_MEMORY, and those
   of the observer. */
ffd_status ffd_moves_apply(const lattice_spec *spec, const rest_region *region, ffd_lattice *lattice,
                           const move_observer *observer, ffd_error *error);

#endif
