/* moves.h - moves of control points. */
#ifndef FFD_LATTICE_MOVES_H
#define FFD_LATTICE_MOVES_H

#include "lattice/mirror.h"
#include "lattice/move_action.h"
#include "lattice/shapes.h"
#include "lattice/spec.h"

/* One move, or its mirror image, before it is applied. */
typedef struct move_step {
    const lattice_move *move;      /* as the file has it */
    size_t number;                 /* of the move */
    const ready_move *ready;       /* in world units */
    const mirror_plane *plane;     /* NULL: not the image */
    const unsigned char *selected; /* a byte a control point */
    ffd_lattice *lattice;          /* as it is before the move */
    const rest_region *region;
    const double *inverse; /* of the region's frame; NULL: units are those of the world */
} move_step;

/* Sees each step. */
typedef struct move_observer {
    ffd_status (*see)(void *context, const move_step *step, ffd_error *error);
    void *context;
} move_observer;

/* Applies the spec's moves to lattice->deformed and its difference; units of the box are those of region.
   observer: NULL, or what sees them. Errors: FFD_E_INVALID at the move, and those of the observer. */
ffd_status ffd_moves_apply(const lattice_spec *spec, const rest_region *region, ffd_lattice *lattice,
                           const move_observer *observer, ffd_error *error);

#endif
