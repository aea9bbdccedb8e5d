/* move_tangent.h - how the points that a move puts follow one parameter. */
#ifndef FFD_LATTICE_TANGENT_MOVE_TANGENT_H
#define FFD_LATTICE_TANGENT_MOVE_TANGENT_H

#include "lattice/moves.h"
#include "lattice/tangent/dual.h"

/* A move in world units, with the derivatives of its numbers. */
typedef struct dual_move {
    const move_step *step;
    dual3 about, vector, axis, toward;
    dual amount, weight, matrix[16];
    dual3 point, center; /* of a pull and of a falloff, in the file's units */
    dual radius, from, to, ball;
    dual3 falloff_axis;
    dual first, length; /* s0 and s1 - s0 */
} dual_move;

/* Makes the move of a step. derivatives: of the numbers of step->move, which has the same layout; points: the
   derivatives of the control points before it, 3 each. */
void ffd_dual_move_make(const move_step *step, const lattice_move *derivatives, const double *points,
                        dual_move *made);

/* Replaces the derivative of a selected control point by that of where the move puts it. part: of an exact
   bend, which part of the whole angle the point is at; half: of a point between joints, half the part of its
   arc; else NULL. */
void ffd_dual_move_point(const dual_move *move, size_t point, const dual *part, const dual *half,
                         double derivative[3]);

/* s of a control point on the move's axis, as the step's plane shows it. */
dual ffd_dual_move_along(const dual_move *move, size_t point, const double derivative[3]);

#endif
