/* gates.h - reasons for a job to fail: policies, and the quality gates of --fail-on. */
#ifndef FFD_JOB_JUDGE_GATES_H
#define FFD_JOB_JUDGE_GATES_H

#include "job/chain/chain.h"
#include "job/figures/pass_totals.h"

/* Applies the policy for vertices outside, and refuses an embedding that misses vertices. name: of the mesh.
   Errors: FFD_E_INVALID, FFD_E_EMBEDDING. */
ffd_status ffd_policies_judge(const ffd_deform_desc *desc, const char *name, const lattice_chain *chain,
                              const pass_totals *totals, ffd_error *error);

/* Fails with one message that lists all violated gates, in the order of ffd_gate. result must have the folds
   if their gate is set. Errors: FFD_E_GATE. */
ffd_status ffd_gates_judge(const ffd_deform_desc *desc, const char *name, const pass_totals *totals,
                           const ffd_job_result *result, ffd_error *error);

#endif
