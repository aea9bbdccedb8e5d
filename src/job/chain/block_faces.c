#include "job/chain/block_faces.h"
#include "base/vector/vec.h"
#include "embed/frame/frame.h"
#include "embed/locator.h"
#include "embed/locator_border.h"
#include "job/chain/common_faces.h"
#include "job/chain/point_outcome.h"
#include "lattice/lattice.h"
#include <ffd/deform.h>
#include <math.h>
#include <string.h>

/* Two blocks move a place alike if their displacements differ by at most this part of the diagonal. */
#define AGREEMENT 1e-9
/* A direction leads out of a face if its cosine with the outward normal exceeds this. */
#define OUTWARD 0.01

/* Direction n of 27 (-1, 0 or 1 along each parameter), as a sum of unit vectors along the columns of the
   Jacobian. Returns false if it does not lead into the block from a place on these faces, or is zero. */
static bool direction_into(unsigned faces, const double jacobian[9], unsigned n, double direction[3])
{
    memset(direction, 0, 3 * sizeof *direction);
    for (int a = 0; a < 3; a++, n /= 3) {
        const int way = (int)(n % 3) - 1;
        const double column[3] = {jacobian[a], jacobian[3 + a], jacobian[6 + a]};
        const double length = vec_length(column);
        if ((faces >> 2 * a & 1 && way != 1) || (faces >> (2 * a + 1) & 1 && way != -1))
            return false;
        for (int c = 0; c < 3 && length > 0; c++)
            direction[c] += way * column[c] / length;
    }
    return vec_length(direction) > 0;
}

/* Whether the next block contains points beyond the own block's faces at this place: then the displacement
   may jump there. Otherwise both lie on the same side, and the own block, the earlier one, owns their
   overlap. */
static bool goes_on(const block_place *own, const block_place *next, const double half[3], double snap)
{
    double of_own[9], of_next[9], normals[6][3], direction[3];
    const unsigned faces = ffd_faces_reached(own->link, own->uvw, half, snap, of_own);
    const unsigned others = ffd_faces_reached(next->link, next->uvw, half, snap, of_next);
    if (mat_determinant(of_own) == 0 || mat_determinant(of_next) == 0)
        return true; /* the normals are undefined, so the displacements must be compared */
    ffd_faces_normals(faces, of_own, normals);
    for (unsigned n = 0; n < 27; n++) {
        if (!direction_into(others, of_next, n, direction))
            continue;
        for (int f = 0; f < 6; f++)
            if (vec_dot(direction, normals[f]) > OUTWARD * vec_length(direction))
                return true;
    }
    return false;
}

/* Returns an upper bound of the change of a displacement over a short distance. */
static double change_of(const double gradient[9], double way)
{
    double square = 0;
    for (int i = 0; i < 9; i++)
        square += gradient[i] * gradient[i];
    return isfinite(square) ? way * sqrt(square) : 0;
}

static double distance(const double a[3], const double b[3])
{
    const double way[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    return vec_length(way);
}

/* Looks up a place of one block in another block. If that one does not hold it, uvw is left as it is. */
static ffd_status find_there(const chain_link *link, const double place[3], double off, double uvw[3],
                             bool *found, ffd_error *error)
{
    ffd_location location;
    boundary_point nearest;
    const boundary *border;
    *found = false;
    TRY(ffd_locator_find(link->locator, place, 1, &location, error));
    *found = ffd_location_is_placed(&location);
    if (*found) {
        memcpy(uvw, location.uvw, sizeof location.uvw);
        return FFD_OK;
    }
    TRY(ffd_locator_border(link->locator, &border, error));
    TRY(ffd_boundary_find(border, place, off, &nearest, error));
    *found = nearest.found;
    if (*found)
        memcpy(uvw, nearest.uvw, sizeof nearest.uvw);
    return FFD_OK;
}

ffd_status ffd_blocks_part(const block_place *own, const block_place *next, const double half[3], double snap,
                           double *parting, ffd_error *error)
{
    const block_place *const both[2] = {own, next};
    const double off = ffd_link_rounding(own->link) + ffd_link_rounding(next->link);
    double uvw[2][3], at[2][3], delta[2][3], gradient[9];
    double limit = AGREEMENT * larger_of(own->link->lattice->diagonal, next->link->lattice->diagonal);
    *parting = 0;
    if (!goes_on(own, next, half, snap))
        return FFD_OK;
    for (int b = 0; b < 2; b++) {
        memcpy(uvw[b], both[b]->uvw, sizeof uvw[b]);
        ffd_lattice_evaluate(both[b]->link->lattice, FFD_VOLUME_REST, uvw[b], at[b], NULL);
    }
    /* A point's rounding cell may touch both blocks at slightly different places. Evaluate both displacements
       at one place if a block holds the other's place; across a gap, each at its own. */
    bool found = distance(at[0], at[1]) <= off;
    for (int b = 0; b < 2 && !found; b++)
        TRY(find_there(both[1 - b]->link, at[b], off, uvw[1 - b], &found, error));
    for (int b = 0; b < 2; b++) {
        ffd_displacement(ffd_link_mover(both[b]->link), uvw[b], delta[b], gradient);
        limit += change_of(gradient, off);
    }
    const double length = distance(delta[0], delta[1]);
    *parting = length > limit ? length : 0;
    return FFD_OK;
}
