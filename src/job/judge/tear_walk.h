/* tear_walk.h - measures how far the displacement jumps at borders of lattices that act one after the
   other. */
#ifndef FFD_JOB_JUDGE_TEAR_WALK_H
#define FFD_JOB_JUDGE_TEAR_WALK_H

#include "job/chain/chain.h"
#include "mesh/mesh.h"

typedef struct tear_walks tear_walks;

/* Returns NULL if memory runs out. The walks borrow all arguments. marks: as in tear_question. */
tear_walks *ffd_tear_walks_make(const lattice_chain *chain, const mesh_faces *faces, const uint8_t *marks);
/* Accepts NULL. */
void ffd_tear_walks_free(tear_walks *walks);

/* Measures the steps of at most TEAR_RUN edges (tear_step_function) of the modes TEAR_UNMOVABLE and
   TEAR_BORDER. If the staying end does not move at all: its displacement by the links of its neighbour,
   extended where it is outside. Else: the largest jump at the border of a link that moves only one end.
   Errors: FFD_E_MEMORY, FFD_E_LIMIT. */
ffd_status ffd_tear_walks_measure(tear_walks *walks, const uint64_t *edges, size_t count, double *lengths,
                                  ffd_error *error);

/* Finds the point of a link's border nearest to x, within reach (ffd_boundary_find). Errors: FFD_E_MEMORY. */
ffd_status ffd_tear_border_point(const chain_link *link, const double x[3], double reach,
                                 boundary_point *nearest, ffd_error *error);

#endif
