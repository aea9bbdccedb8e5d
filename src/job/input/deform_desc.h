/* deform_desc.h - copies a job's description from the caller's struct (public: ffd/job.h),
   checks that the arrays of a description are complete, and tells what it wants. */
#ifndef FFD_JOB_INPUT_DEFORM_DESC_H
#define FFD_JOB_INPUT_DEFORM_DESC_H

#include <ffd/job.h>

/* Fills own with the members that the caller's struct has, and defaults for the others. Errors: those of
   ffd_struct_take. */
ffd_status ffd_deform_desc_take(const ffd_deform_desc *callers, ffd_deform_desc *own, ffd_error *error);

/* Whether a deformation writes a mesh; else only its positions are wanted. */
bool ffd_deform_desc_writes(const ffd_deform_desc *desc);

/* Whether the array has so many texts, none of them NULL. */
bool ffd_desc_has_texts(const char *const *texts, size_t count);
/* The same of values of placeholders. */
bool ffd_desc_has_settings(const ffd_setting *set, size_t count);

#endif
