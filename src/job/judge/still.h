/* still.h - says why moves move nothing. */
#ifndef FFD_JOB_JUDGE_STILL_H
#define FFD_JOB_JUDGE_STILL_H

#include "job/chain/chain.h"
#include "job/figures/pass_totals.h"

/* Warns of lattices whose moves move no control point; and if no vertex moves, though lattices hold vertices
   and move control points, that none of these acts on a vertex, or that the floats of the output are too
   coarse for it. box: the bounds of the mesh at rest; is_target: it becomes a
   morph target; is_written: an output is. */
void ffd_still_warn(const pass_totals *totals, const lattice_chain *chain, const ffd_bounds *box,
                    bool is_target, bool is_written, const mesh_log *log);

#endif
