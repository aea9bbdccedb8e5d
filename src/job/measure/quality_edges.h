/* quality_edges.h - the distance of a deformed mesh's edges from the true deformed surface. */
#ifndef FFD_JOB_MEASURE_QUALITY_EDGES_H
#define FFD_JOB_MEASURE_QUALITY_EDGES_H

#include "job/chain/chain.h"
#include "job/input/rigid_parts.h"
#include "job/input/weights.h"
#include "mesh/mesh.h"
#include <stdint.h>

typedef struct edge_quality {
    uint64_t edges; /* measured edges */
    double deviation_max,
        deviation_mean; /* over the largest deviation of each edge, world units; 0 without edges */
    uint32_t worst[2];  /* vertices of the edge with deviation_max, the smaller index first; of several edges
                           the first in this order */
} edge_quality;

/* Measures the deviation of the deformed mesh's straight edges from the true deformed surface: for each edge
   (once, however many faces share it) the largest distance of a deformed point of the rest edge from the
   straight edge between its deformed ends. Excludes edges with an end, a sample or a squared length that is
   not finite.

   The choice of samples depends on the edge alone. They are at multiples of 1/64 of the edge:
   - 1/4, 1/2, 3/4 always, and all of 1/8 .. 7/8 if the edge is long. It is long if it exceeds 1/16 of a
     lattice's diagonal, or if one of its two middle quarters spans more than 1/16 of a span cell in some
     direction of a lattice's u,v,w, or crosses a lattice's border.
     With blocks there is a border wherever another block begins.
   - On a long edge, a piece between neighbouring samples is halved if it spans more than 1/2 of a span cell,
     exceeds 1/8 of a lattice's diagonal, or crosses a lattice's border. So no cell that the edge crosses from
     side to side is missed.
   - A piece is halved if its deviation may exceed the largest one found on the edge by more than 1/64.
     The estimate is a parabola between the piece's ends: its sagitta is a quarter of its parent's, as for a
     smooth curve, plus the error of this rule in the two halvings before (large at kinks and at waves that
     are not resolved yet).
   If an edge extends beyond all lattices (with --outside extend: beyond the falloff), all this applies to the
   part within their reach; the rest does not move. An edge has at most 63 inner samples, so one that crosses
   more than about 30 cells may deviate more between them.

     document  of the vertices, for their rounding cells; NULL: coordinates are exact
     deformed  3 doubles a vertex: the chain's own results in double, as rounding would count as deviation
     weights   of the vertices, linear along an edge; NULL: all are 1
     rigid     pieces, whose edges are not measured: the surface between them is straight; NULL: none
     threads   0 for all; never changes the result
   The chain's locators must exist. Errors: FFD_E_MEMORY. */
ffd_status ffd_quality_edges(const mesh_document *document, mesh_state state, const mesh_faces *faces,
                             const double *deformed, const lattice_chain *chain,
                             const vertex_weights *weights, const rigid_parts *rigid, int threads,
                             edge_quality *result, ffd_error *error);

#endif
