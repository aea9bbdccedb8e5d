/* coverage.h - explains why vertices among a lattice's control points may be outside of its volume. */
#ifndef FFD_JOB_CHAIN_COVERAGE_H
#define FFD_JOB_CHAIN_COVERAGE_H

#include "job/chain/chain.h"
#include "mesh/mesh_log.h"
#include <ffd/job.h>

/* If the end knots of a lattice are not repeated d+1 times, the volume covers only the domain [t_d, t_n],
   which is smaller than the hull of the control points (src/maths.md 4.4). Writes the covered range and the
   remedy for the first lattice of this kind whose control points come from the file; else "". Lattices made
   from a box or a cylinder cover it, whatever the knots, unless weights differ. */
void ffd_chain_coverage(const lattice_chain *chain, char *text, size_t capacity);

/* Warns of each lattice with weights whose volume is not the whole box or cylinder that it was made for. */
void ffd_coverage_warn(const lattice_chain *chain, const mesh_log *log);

/* Writes where the volumes and the mesh lie (in the lattice's space), for a mesh that is outside; "" if the
   mesh has no finite vertex. */
void ffd_chain_places(const lattice_chain *chain, const ffd_bounds *mesh, char *text, size_t capacity);

#endif
