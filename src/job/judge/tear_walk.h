/* tear_walk.h - how far the displacement by lattices that act one after the other jumps at their borders. */
#ifndef FFD_JOB_JUDGE_TEAR_WALK_H
#define FFD_JOB_JUDGE_TEAR_WALK_H

#include "job/chain/chain.h"
#include "mesh/mesh.h"

typedef struct tear_walks tear_walks;

/* All of these must outlive it; the marks are those of the question. NULL where memory runs out. */
tear_walks *ffd_tear_walks_make(const lattice_chain *chain, const mesh_faces *faces, const uint8_t *marks);
/* Frees it; NULL is allowed. */
void ffd_tear_walks_free(tear_walks *walks);

/* The steps of TEAR_RUN edges at most (tear_step_function), of the modes TEAR_UNMOVABLE and TEAR_BORDER: of
   an end that nothing moves what the links of its neighbour would do to it, outside included; of one that
   other links move the largest jump at the border of a link that treats the two ends differently. Errors:
   FFD_E_MEMORY, FFD_E_LIMIT. */
ffd_status ffd_tear_walks_measure(tear_walks *walks, const uint64_t *edges, size_t count, double *lengths,
                                  ffd_error *error);

/* The point of a link's border nearest to x, if one is within reach (ffd_boundary_find). Errors:
   FFD_E_MEMORY. */
ffd_status ffd_tear_border_point(const chain_link *link, const double x[3], double reach,
                                 boundary_point *nearest, ffd_error *error);

#endif
