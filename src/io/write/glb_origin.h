/* glb_origin.h - where the nodes of a new glTF file stand, so that floats keep a shape far from the origin.
 */
#ifndef FFD_IO_WRITE_GLB_ORIGIN_H
#define FFD_IO_WRITE_GLB_ORIGIN_H

#include "io/write/glb_plan.h"

/* Finds the translation of the nodes, from which positions are then measured. Zeros, where the step of floats
   at the largest coordinate is at most 1e-6 of the diagonal. Else multiples of a unit, the power of two next
   above the diagonal: the one nearest to the middle of each axis. So parts of one size that lie side by side
   mostly have one translation. Returns whether there is one. */
bool ffd_glb_origin(const glb_plan *plan, double origin[3]);

#endif
