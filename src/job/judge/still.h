/* still.h - says why moves move nothing. */
#ifndef FFD_JOB_JUDGE_STILL_H
#define FFD_JOB_JUDGE_STILL_H

#include "job/judge/job_state.h"

/* Warns of lattices whose moves move no control point; and if no vertex moves, though lattices hold vertices
   and move control points, that none of these acts on a vertex, or that the floats of the output are too
   coarse for it. box: the bounds of the mesh at rest. */
void ffd_still_warn(const deform_job *job, const ffd_bounds *box);

#endif
