/* tears.h - says what torn edges a deformation makes. */
#ifndef FFD_JOB_JUDGE_TEARS_H
#define FFD_JOB_JUDGE_TEARS_H

#include "mesh/mesh_log.h"
#include <ffd/result.h>

/* Describes torn edges, as in "36 vertices of Knight_Sword stay; the largest step to a neighbour is 0.47".
   Requires torn edges. */
void ffd_tears_describe(const ffd_job_result *result, char *text, size_t capacity);
/* Warns of torn edges, and suggests a remedy. selects: only parts of the mesh are deformed. */
void ffd_tears_warn(const ffd_job_result *result, bool selects, const mesh_log *log);

#endif
