/* compare.h - what comparing two folders shares with comparing two meshes. */
#ifndef FFD_JOB_COMPARE_H
#define FFD_JOB_COMPARE_H

#include "json/json_text.h"
#include <ffd/job.h>

/* Errors: FFD_E_ARGUMENT. */
ffd_status ffd_compare_check(const ffd_compare_desc *desc, ffd_error *error);
/* Begins the text, an object, with its kind and the names of the meshes or folders. */
void ffd_comparison_begin(json_text *json, const char *a, const char *b);
/* Writes the members of a comparison of two meshes, without their names. */
void ffd_comparison_write(json_text *json, const ffd_comparison *comparison);

#endif
