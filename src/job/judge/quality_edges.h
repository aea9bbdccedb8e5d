/* quality_edges.h - how far the edges of a deformed mesh lie from the true deformed surface. */
#ifndef FFD_JOB_JUDGE_QUALITY_EDGES_H
#define FFD_JOB_JUDGE_QUALITY_EDGES_H

#include "job/chain/chain.h"
#include "mesh/mesh.h"
#include <stdint.h>

typedef struct edge_quality {
    uint64_t edges;                       /* that were measured */
    double deviation_max, deviation_mean; /* of the edges' largest deviations, world units; 0 without edges */
    uint32_t worst[2]; /* the vertices of the edge with deviation_max, the lesser first; of several such edges
                          the first by these numbers */
} edge_quality;

/* How far the straight edges of the deformed mesh lie from the true deformed surface: for each edge (once,
   however many faces share it) the largest distance from a deformed point of the rest edge to the straight
   edge between its deformed ends. Edges with an end or a sample that is not finite, or of a length whose
   square is not, are left out.

   Which points of an edge are looked at depends on this edge only. They are at multiples of 1/64 of it:
   - 1/4, 1/2, 3/4 always; and all of 1/8 .. 7/8 where the edge is long: longer than 1/16 of a lattice's
     diagonal, or one of its two middle quarters passes more than 1/16 of a span cell in some direction of a
     lattice's u,v,w, or crosses a lattice's border.
     Blocks have a border wherever another block begins.
   - Of a long edge every piece between neighbours is halved that passes more than 1/2 of a span cell, is
     longer than 1/8 of a lattice's diagonal, or crosses a lattice's border, so that no cell that the
     edge crosses from side to side is passed over.
   - A piece is halved where it may hold a deviation more than 1/64 above the largest one seen on the edge.
     The estimate takes the piece for a parabola between its ends: its sagitta is a quarter of that of the
     piece it is half of, as for a smooth curve, plus the amount by which the two halvings before missed this
     rule (large at kinks and where waves are not resolved yet).
   Of an edge that reaches beyond all lattices (with --outside extend: beyond the falloff) the part that
   passes them is taken for the edge in all this; beyond it nothing moves. An edge that crosses more than
   about 30 cells is sampled at most at 63 inner points and may deviate more between them.

     document  whose vertices they are: points of an edge stand for what its ends stand for; NULL: for
   themselves deformed  3 doubles a vertex, the chain's own results in double: their rounding counts as
   deviation threads   0 for all; never changes the result The chain's locators must be there. Errors:
   FFD_E_MEMORY. */
ffd_status ffd_quality_edges(const mesh_document *document, const mesh_faces *faces, const double *deformed,
                             const lattice_chain *chain, int threads, edge_quality *result, ffd_error *error);

#endif
