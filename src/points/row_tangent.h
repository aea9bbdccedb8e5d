/* row_tangent.h - how a point follows when control points and weights of the deformed volume change. */
#ifndef FFD_POINTS_ROW_TANGENT_H
#define FFD_POINTS_ROW_TANGENT_H

#include "lattice/tangent/tangents.h"
#include "points/basis_row.h"

/* A change of the deformed control points and of their weights, u fastest. */
typedef struct control_change {
    const double *points;  /* 3 for each control point; NULL: they stay */
    const double *weights; /* one for each; NULL: they stay */
} control_change;

/* Returns the change by one column of tangents. count: of control points. */
static inline control_change ffd_tangents_column(const lattice_tangents *tangents, size_t count,
                                                 size_t column)
{
    return (control_change){tangents->points + column * 3 * count,
                            tangents->weights ? tangents->weights + column * count : NULL};
}

/* Evaluates the deformed volume at the point of a row, which has the deformed weights. */
void ffd_row_place(const ffd_lattice *lattice, const basis_row *row, double x[3]);
/* Computes the derivative of the point of a row along a change: sum R_j dQ_j, plus, if weights change,
   sum R_j (Q_j - X) dh_j / h_j (the quotient rule). x: the place of the row. */
void ffd_row_tangent(const ffd_lattice *lattice, const control_change *change, const basis_row *row,
                     const double x[3], double tangent[3]);

#endif
