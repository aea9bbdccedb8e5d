/* attribute.h - many normals and tangents at once, and tangents for normals that come from elsewhere
   (public: ffd/deform.h). */
#ifndef FFD_DEFORM_ATTRIBUTE_H
#define FFD_DEFORM_ATTRIBUTE_H

#include "base/vector/isa.h"
#include "deform/attribute_kernel.h"
#include <ffd/deform.h>

/* ffd_deform_normal, or ffd_deform_tangent, for every direction of the batch, with the same bits whatever the
   instruction set. No outcome is left open. */
void ffd_deform_normals(ffd_isa isa, const attribute_batch *batch);
/* The same for tangents. */
void ffd_deform_tangents(ffd_isa isa, const attribute_batch *batch);

/* ffd_deform_tangent for a normal that changed, perhaps though the gradient is 0. Returns 1 and writes
   result; 0 and copies t where nothing is left of it. */
int ffd_tangent_of_normal(const double gradient[9], const double tangent[3], const double normal[3],
                          double result[3]);

#endif
