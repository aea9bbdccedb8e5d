/* result.h - the figures of a pass as a job's result, and what its user is warned of. */
#ifndef FFD_JOB_JUDGE_RESULT_H
#define FFD_JOB_JUDGE_RESULT_H

#include "job/chain/chain.h"
#include "job/pass/pass_totals.h"
#include "mesh/mesh.h"

/* No figures yet. */
void ffd_result_clear(ffd_job_result *result);

/* The figures of a pass as a job's result; seconds are wall time, divided in proportion to
   the threads' own times. */
void ffd_result_fill(ffd_job_result *result, const pass_totals *totals, double seconds);

/* Takes what the input has against its format's specification. */
void ffd_result_note_flaws(ffd_job_result *result, const mesh_flaws *flaws);

/* "3 of 100 vertices are not inside: 2 outside (left where they are), 1 multiple", and what else is worth a
   warning. deformed: whether the vertices outside were kept or moved; else their u,v,w was asked for. */
void ffd_result_warn(const pass_totals *totals, const lattice_chain *chain, bool deformed,
                     const mesh_log *log);

#endif
