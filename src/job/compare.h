/* compare.h - what a comparison of two meshes writes, for that of two folders. */
#ifndef FFD_JOB_COMPARE_H
#define FFD_JOB_COMPARE_H

#include "json/json_text.h"
#include <ffd/job.h>

/* Writes the members of a comparison, without the names of the files. */
void ffd_comparison_write(json_text *json, const ffd_comparison *comparison);

#endif
