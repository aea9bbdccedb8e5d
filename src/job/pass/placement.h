/* placement.h - the lattices that take their box from the mesh, and the one summary line about the vertices.
 */
#ifndef FFD_JOB_PASS_PLACEMENT_H
#define FFD_JOB_PASS_PLACEMENT_H

#include "job/pass/pass.h"

/* Gives each lattice whose box is "mesh" its place: round the mesh as it arrives at that lattice, after those
   before it. Makes the locators that were still missing. */
ffd_status ffd_chain_place(lattice_chain *chain, mesh_document *document, int threads, ffd_error *error);

/* The figures of a pass as a job's result; seconds are the time of the wall, shared out by the threads' own.
 */
void ffd_result_fill(ffd_job_result *result, const pass_totals *totals, double seconds);

/* "3 of 100 vertices are not inside: 2 outside (left where they are), 1 multiple", and what else is worth a
   warning. deformed: whether the vertices outside were kept or moved; else their u,v,w was asked for. */
void ffd_result_warn(const pass_totals *totals, const lattice_chain *chain, bool deformed,
                     const mesh_log *log);

#endif
