/* glb_origin.h - chooses the translation of a new glTF file's nodes, so that floats keep a shape far from the
   origin. */
#ifndef FFD_IO_WRITE_GLB_ORIGIN_H
#define FFD_IO_WRITE_GLB_ORIGIN_H

#include "io/write/glb_plan.h"

/* Finds the translation of the nodes, relative to which positions are then stored. It is zero if the step of
   floats at the largest coordinate is at most 1e-6 of the diagonal. Otherwise its coordinates are multiples
   of a unit, the next power of two above the diagonal: on each axis the multiple nearest to the middle. So
   parts of the same size that lie side by side mostly have the same translation. Returns whether it is not
   zero. */
bool ffd_glb_origin(const glb_plan *plan, double origin[3]);

#endif
