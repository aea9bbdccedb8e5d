/* attribute.h - transforms many normals and tangents at once, and tangents for given deformed normals (public
   functions: ffd/deform.h). */
#ifndef FFD_DEFORM_ATTRIBUTE_H
#define FFD_DEFORM_ATTRIBUTE_H

#include "base/vector/isa.h"
#include "deform/attribute_kernel.h"
#include <ffd/deform.h>

/* Applies ffd_deform_normal to every direction of the batch, with the same bits for all instruction sets. No
   outcome is DIRECTION_OPEN afterwards. */
void ffd_deform_normals(ffd_isa isa, const attribute_batch *batch);
/* The same for tangents, as ffd_deform_tangent. */
void ffd_deform_tangents(ffd_isa isa, const attribute_batch *batch);

/* As ffd_deform_tangent, for a normal that changed although the gradient may be 0. */
ffd_direction_outcome ffd_tangent_of_normal(const double gradient[9], const double tangent[3],
                                            const double normal[3], double result[3]);

#endif
