/* polyhedron.h - the Jacobian of cells that are given by their faces. */
#ifndef FFD_CELLS_POLYHEDRON_H
#define FFD_CELLS_POLYHEDRON_H

#include "cells/jacobian_signs.h"
#include <stddef.h>
#include <stdint.h>

/* The words of a prism, at most: 8 faces with 36 corners. */
#define PRISM_WORDS 45

/* Whether the faces of a polyhedron all look outwards, or all inwards: each edge is in two faces that go
   along it in the two directions. words: the number of faces; for each the number of its vertices, and these.
   The counts must be right. */
bool ffd_polyhedron_is_oriented(const uint32_t *words);

/* Adds the signs of the tetrahedra of a polyhedron: each edge of a face, the face's centre and the cell's
   centre, which are means of vertices, make one; a triangle and the cell's centre another. They are positive
   where faces look outwards: their vertices go round counterclockwise, seen from outside, as in VTK and in a
   face of OpenFOAM's in its owner.
   - scale: of the points, a power of two.
   - rest: other positions of the points, where each face looks outwards, whatever its vertices say; NULL:
   they tell. */
void ffd_polyhedron_signs(const uint32_t *words, const double *points, double scale, const double *rest,
                          jacobian_signs *signs);

/* Makes the faces of a prism with n sides, at most 6, from its 2 n points, which are numbered as those of a
   hexahedron are. */
void ffd_prism_words(const uint32_t *points, size_t n, uint32_t words[PRISM_WORDS]);

#endif
