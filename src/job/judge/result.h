/* result.h - says what the figures of a pass mean. */
#ifndef FFD_JOB_JUDGE_RESULT_H
#define FFD_JOB_JUDGE_RESULT_H

#include "job/chain/chain.h"
#include "job/figures/pass_totals.h"
#include "mesh/mesh.h"

/* Logs "3 of 100 vertices are not inside: 2 outside (left where they are), 1 multiple" and other warnings of
   the pass. deformed: say whether vertices outside were kept or moved; else the job asked for u,v,w only. */
void ffd_result_warn(const pass_totals *totals, const lattice_chain *chain, bool deformed,
                     const mesh_log *log);

#endif
