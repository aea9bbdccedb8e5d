/* behind.h - says what stays behind when the mesh moves. */
#ifndef FFD_JOB_JUDGE_BEHIND_H
#define FFD_JOB_JUDGE_BEHIND_H

#include "mesh/mesh_log.h"
#include <ffd/job.h>

/* Logs one line for each kind of thing left behind; with FFD_RIG_KEEP none for joints, pivots and sockets
   (ffd_rig_warn). */
void ffd_behind_warn(const ffd_job_result *result, ffd_rig rig, const mesh_log *log);

#endif
