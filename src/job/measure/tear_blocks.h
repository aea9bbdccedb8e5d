/* tear_blocks.h - tear_field.h for blocks (lattices side by side). */
#ifndef FFD_JOB_MEASURE_TEAR_BLOCKS_H
#define FFD_JOB_MEASURE_TEAR_BLOCKS_H

#include "job/measure/tear_place.h"

/* As ffd_tear_field_find, without a visitor. */
ffd_status ffd_tear_blocks_find(const tear_field *field, field_place *places, size_t count,
                                field_scratch *scratch, ffd_error *error);
/* As ffd_tear_field_compare. */
ffd_status ffd_tear_blocks_compare(const tear_field *field, field_place pair[2], ffd_tear_cause *cause,
                                   ffd_error *error);

#endif
