/* point_outcome.h - the outcome of a point in one lattice, and its combination over several. */
#ifndef FFD_JOB_CHAIN_POINT_OUTCOME_H
#define FFD_JOB_CHAIN_POINT_OUTCOME_H

#include "base/vector/vec.h"
#include "deform/collapse.h"
#include "deform/displacement.h"
#include "embed/locator.h"
#include "job/chain/chain.h"
#include "lattice/lattice.h"
#include <math.h>

/* Fills the outcome of a point in one lattice from its location. */
static inline void ffd_outcome_make(const ffd_lattice *lattice, const ffd_location *location,
                                    point_outcome *outcome)
{
    /* Assigned member by member: copying a whole record from the stack would stall on store forwarding. */
    const bool invalid = location->status == FFD_VERTEX_INVALID;
    const bool placed = ffd_location_is_placed(location);
    const double relative = location->residual / lattice->diagonal;
    outcome->residual_square = relative * relative;
    outcome->evaluations = location->evaluations;
    outcome->status = location->status;
    outcome->moved = false;
    outcome->located = placed;
    outcome->outside = !placed && !invalid;
    outcome->multiple = location->status == FFD_VERTEX_MULTIPLE;
    outcome->unresolved = location->unresolved;
    outcome->disagrees = false;
    outcome->extended = false;
    outcome->collapsed = false;
}

/* Being outside of one lattice does not matter if another one has the point. */
static inline uint8_t ffd_status_joined(uint8_t a, uint8_t b)
{
    if (a == FFD_VERTEX_OUTSIDE || b == FFD_VERTEX_OUTSIDE)
        return a == FFD_VERTEX_OUTSIDE ? b : a;
    return a > b ? a : b;
}

/* Combines the outcome in a further lattice (now) into outcome. */
static inline void ffd_outcome_join(const point_outcome *now, point_outcome *outcome)
{
    outcome->residual_square = larger_of(outcome->residual_square, now->residual_square);
    outcome->evaluations += now->evaluations;
    outcome->status = ffd_status_joined(outcome->status, now->status);
    outcome->located |= now->located;
    outcome->outside &= now->outside;
    outcome->multiple |= now->multiple;
    outcome->unresolved |= now->unresolved;
}

/* Notes at which points a lattice collapses space, among those where it may turn it inside out: those of
   batch->turns from `first` on. */
static inline void ffd_outcomes_note_collapse(const ffd_lattice *lattice, const displacement_batch *batch,
                                              size_t first, point_outcome *outcomes)
{
    for (size_t k = first; k < batch->turns->count; k++) {
        const size_t i = batch->turns->points[k];
        if (ffd_collapses(lattice, ffd_batch_uvw(batch, i), NULL, 0, batch->gradient + 9 * i))
            outcomes[i].collapsed = true;
    }
}

/* The same for a point outside that is extended. */
static inline void ffd_outcome_note_extension(const ffd_lattice *lattice, const boundary_point *nearest,
                                              double falloff, const double gradient[9],
                                              point_outcome *outcome)
{
    if (ffd_collapses(lattice, nearest->uvw, nearest->uvw_by_p, falloff, gradient))
        outcome->collapsed = true;
}

/* The parameters beyond which a point is on or near a face of the domain. A closed direction has no faces. */
typedef struct face_ends {
    double low[3], high[3];
} face_ends;

#define ON_FACE 1e-9

/* near: distance relative to the domain; ON_FACE for points exactly on a face. */
static inline face_ends ffd_face_ends(const ffd_lattice *lattice, double near)
{
    face_ends ends;
    for (int a = 0; a < 3; a++) {
        const knot_vector *const knots = &lattice->knots[a];
        const double first = ffd_knots_first(knots), last = ffd_knots_last(knots);
        const double distance = near * (last - first);
        ends.low[a] = ffd_knots_closed(knots) ? -HUGE_VAL : first + distance;
        ends.high[a] = ffd_knots_closed(knots) ? HUGE_VAL : last - distance;
    }
    return ends;
}

/* Returns the faces that uvw is on: bit 2a for the start of the domain in direction a, bit 2a + 1 for its
   end. */
static inline unsigned ffd_faces_at(const face_ends *ends, const double uvw[3])
{
    unsigned faces = 0;
    for (int a = 0; a < 3; a++)
        faces |= (unsigned)(uvw[a] <= ends->low[a]) << 2 * a | (unsigned)(uvw[a] >= ends->high[a])
                                                                   << (2 * a + 1);
    return faces;
}

#endif
