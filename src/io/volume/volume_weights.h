/* volume_weights.h - which arrays of a volume mesh can be weights. */
#ifndef FFD_IO_VOLUME_VOLUME_WEIGHTS_H
#define FFD_IO_VOLUME_VOLUME_WEIGHTS_H

#include "io/volume/volume_document.h"

/* Fails with FFD_E_INVALID: the points have no array of the name. */
ffd_status ffd_volume_no_weights(const volume_document *document, const weight_source *source,
                                 ffd_error *error);
/* Checks that an array can be weights. Errors: FFD_E_INVALID. */
ffd_status ffd_volume_check_weights(const volume_document *document, const weight_source *source,
                                    number_type type, size_t width, size_t line, ffd_error *error);
/* Divides count numbers by the one of their type that stands for 1. */
void ffd_volume_scale_weights(number_type type, double *weights, size_t count);

#endif
