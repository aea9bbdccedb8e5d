/* cell_measure.h - judges a cell of a volume mesh: whether its Jacobian has one sign everywhere, and how well
   shaped it is. */
#ifndef FFD_CELLS_CELL_MEASURE_H
#define FFD_CELLS_CELL_MEASURE_H

#include "cells/cell_view.h"
#include "cells/reference.h"

typedef struct cell_measure {
    jacobian_state state; /* UNKNOWN also of kinds that are not known, and where a coordinate is not finite */
    double jacobian;      /* the least determinant that was looked at; NaN: none, or not finite */
    double scaled; /* the scaled Jacobian of the corners; NaN of polyhedra, and where it is not known */
} cell_measure;

/* Measures a cell. points: three numbers each, of all that the cell names. rest: the points at rest, or NULL:
   by them the faces of a polyhedron look outwards where they contradict each other; without them it is
   unknown then. rules: hold that of its kind. The Jacobian is the determinant of the map from the reference
   cell, whose edges have the length 1: of a tetrahedron six times its volume, of a box its volume. Tetrahedra
   and all corners of linear cells have exact signs; hexahedra are decided by Bezier coefficients
   (hexahedron.h), wedges and pyramids by corners and Gauss points, quadratic cells by these and their middles
   where the signs agree, polyhedra by tetrahedra round their centre (polyhedron.h). */
cell_measure ffd_cell_measure(const cell_rules *rules, const cell_view *cell, const double *points,
                              const double *rest);

#endif
