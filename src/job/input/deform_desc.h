/* deform_desc.h - takes the description of a job from its caller (public: ffd/job.h). */
#ifndef FFD_JOB_INPUT_DEFORM_DESC_H
#define FFD_JOB_INPUT_DEFORM_DESC_H

#include <ffd/job.h>

/* Fills own with what the caller's header has, and defaults. Errors: those of ffd_struct_take. */
ffd_status ffd_deform_desc_take(const ffd_deform_desc *callers, ffd_deform_desc *own, ffd_error *error);

#endif
