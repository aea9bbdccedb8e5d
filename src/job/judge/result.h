/* result.h - turns the figures of a pass into a job's result and warnings. */
#ifndef FFD_JOB_JUDGE_RESULT_H
#define FFD_JOB_JUDGE_RESULT_H

#include "job/chain/chain.h"
#include "job/figures/figure_values.h"
#include "mesh/mesh.h"

/* Copies the flaws of the input: violations of its format's specification. */
void ffd_result_note_flaws(ffd_job_result *result, const mesh_flaws *flaws);

/* Logs "3 of 100 vertices are not inside: 2 outside (left where they are), 1 multiple" and other warnings of
   the pass. deformed: say whether vertices outside were kept or moved; else the job asked for u,v,w only. */
void ffd_result_warn(const pass_totals *totals, const lattice_chain *chain, bool deformed,
                     const mesh_log *log);

#endif
