/* refine.h - the clamped form of a lattice, and the memory that a refinement takes (public: ffd/author.h). */
#ifndef FFD_AUTHOR_REFINE_H
#define FFD_AUTHOR_REFINE_H

#include "author/made.h"
#include <ffd/author.h>

/* Describes the lattice that ffd_lattice_refine would make as far as its memory depends on it
   (ffd_spec_point_bytes, ffd_spec_knot_bytes): sizes, degrees, and the arrays that it has, in whose place
   those of `lattice` stand. Not to be freed. Errors: FFD_E_ARGUMENT, FFD_E_LIMIT and FFD_E_MEMORY, as
   there. */
ffd_status ffd_lattice_refined_spec(const ffd_lattice *lattice, const ffd_refine_desc *desc,
                                    lattice_spec *spec, ffd_error *error);

/* Begins with the same map (ffd_lattice_refine) whose knots are clamped at both ends along the directions
   given, those that are closed excepted; where all are already, its rest stays as it is. Moves become
   offsets. Errors: those of ffd_made_begin, FFD_E_MEMORY. */
ffd_status ffd_made_begin_clamped(const ffd_lattice *lattice, const bool directions[3], made_lattice *made,
                                  ffd_error *error);

#endif
