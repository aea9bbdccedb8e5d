/* move_tangent.h - the derivatives of the points that a move moves, by one parameter. */
#ifndef FFD_LATTICE_TANGENT_MOVE_TANGENT_H
#define FFD_LATTICE_TANGENT_MOVE_TANGENT_H

#include "lattice/moves.h"
#include "lattice/tangent/dual.h"

/* A move in world units, with derivatives of its numbers. */
typedef struct dual_move {
    const move_step *step;
    dual3 about, vector, axis, toward;
    dual amount, weight, matrix[16];
    dual3 point, center; /* of a pull and of a falloff, in the units of the file */
    dual radius, from, to, ball;
    dual3 falloff_axis;
    dual first, length; /* s0 and s1 - s0 */
} dual_move;

/* Makes the move of a step. derivatives: those of the numbers of step->move, in the same struct; points: the
   derivatives of the control points before the step, 3 numbers each. */
void ffd_dual_move_make(const move_step *step, const lattice_move *derivatives, const double *points,
                        dual_move *made);

/* Replaces the derivative of a selected control point by its derivative after the move. For an exact bend,
   part is the position of the point as a fraction of the whole angle and, for a point between joints, half is
   half the fraction of its arc; otherwise they are NULL. */
void ffd_dual_move_point(const dual_move *move, size_t point, const dual *part, const dual *half,
                         double derivative[3]);

/* Returns s, the coordinate of a control point along the axis of the move, reflected in the plane of the
   step. */
dual ffd_dual_move_along(const dual_move *move, size_t point, const double derivative[3]);

#endif
