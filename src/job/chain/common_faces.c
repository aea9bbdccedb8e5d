#include "job/chain/common_faces.h"
#include "base/vector/vec.h"
#include "embed/frame/frame.h"
#include "embed/locator.h"
#include "job/chain/point_outcome.h"
#include "job/chain/point_rounding.h"
#include <float.h>
#include <math.h>
#include <string.h>

/* At a common face the outward normals of two lattices are opposite: their cosine is at most this. (Two boxes
   round the same mesh have equal normals there.) */
#define OPPOSITE (-0.99)

/* Points within this many of the largest rounding cells of a face are examined. Cells are measured relative
   to the diagonal, distances relative to the domain, so no point is missed unless the lattice is thinner than
   1 / NEAR_CELLS of its diagonal. */
#define NEAR_CELLS 1e4

/* Error bound of a place evaluated in a lattice, relative to the size of the coordinates. */
#define ROUNDING (4 * DBL_EPSILON)

/* A point counts as moved if its displacement exceeds this part of the diagonal: rounding may be left at a
   border to which the lattice fades. */
#define MOVED 1e-9

double ffd_link_rounding(const chain_link *link)
{
    const bounds *const hull = &link->locator->hull;
    double size = 0;
    for (int a = 0; a < 3; a++)
        size = larger_of(size, larger_of(fabs(hull->lo[a]), fabs(hull->hi[a])));
    return ROUNDING * size;
}

unsigned ffd_faces_reached(const chain_link *link, const double uvw[3], const double half[3], double snap,
                           double jacobian[9])
{
    double point[3], by_p[9];
    const ffd_lattice *const lattice = link->lattice;
    face_ends ends = ffd_face_ends(lattice, ON_FACE);
    ffd_lattice_evaluate(lattice, FFD_VOLUME_REST, uvw, point, jacobian);
    if (mat_invert(jacobian, by_p))
        for (int a = 0; a < 3; a++) {
            const double *const row = by_p + 3 * a;
            double reach = (snap + ffd_link_rounding(link)) * vec_length(row);
            for (int c = 0; c < 3; c++)
                reach += half[c] * fabs(row[c]);
            ends.low[a] += reach;
            ends.high[a] -= reach;
        }
    return ffd_faces_at(&ends, uvw);
}

void ffd_faces_normals(unsigned faces, const double jacobian[9], double normals[6][3])
{
    double columns[3][3];
    const double sign = mat_determinant(jacobian) < 0 ? -1 : 1;
    for (int a = 0; a < 3; a++)
        for (int c = 0; c < 3; c++)
            columns[a][c] = jacobian[3 * c + a];
    memset(normals, 0, 6 * sizeof *normals);
    for (int f = 0; f < 6; f++) {
        double across[3];
        vec_cross(columns[(f / 2 + 1) % 3], columns[(f / 2 + 2) % 3], across);
        const double length = vec_length(across);
        for (int c = 0; c < 3 && faces >> f & 1 && length > 0; c++)
            normals[f][c] = (f % 2 ? sign : -sign) * across[c] / length;
    }
}

/* Whether a place is also on a face of the link `to`, where its parameters are uvw. */
static bool share_face(const chain_link *links, const face_place *place, const chain_link *to,
                       const double uvw[3])
{
    double jacobian[9], of_place[6][3], of_other[6][3];
    const chain_link *const of = &links[place->link];
    ffd_faces_normals(ffd_faces_reached(of, place->uvw, place->half, of->snap, jacobian), jacobian, of_place);
    ffd_faces_normals(ffd_faces_reached(to, uvw, place->half, to->snap, jacobian), jacobian, of_other);
    for (int i = 0; i < 6; i++)
        for (int k = 0; k < 6; k++)
            if (vec_dot(of_place[i], of_other[k]) <= OPPOSITE)
                return true;
    return false;
}

void ffd_common_begin(chain_run *run)
{
    chain_scratch *const scratch = run->scratch;
    memset(scratch->on_face, 0, sizeof scratch->on_face);
    scratch->place_count = 0;
    scratch->cell = 0;
    for (size_t i = 0; i < run->count && run->rounding; i++) {
        double half[3];
        if (!vec_is_finite(run->x + 3 * i))
            continue;
        ffd_rounding_find(run->rounding, i, true, run->x + 3 * i, half);
        scratch->cell = larger_of(scratch->cell, vec_length(half));
    }
}

double ffd_faces_near(const chain_link *link, double snap, const chain_run *run)
{
    const double cell = run->scratch->cell + ffd_link_rounding(link);
    const double near = NEAR_CELLS * cell / link->lattice->diagonal;
    return snap > 0 || near > 1 ? 1 : larger_of(near, ON_FACE);
}

void ffd_common_note(const lattice_chain *chain, size_t link, const chain_run *run)
{
    chain_scratch *const scratch = run->scratch;
    const chain_link *const of = &chain->links[link];
    const face_ends ends = ffd_face_ends(of->lattice, ffd_faces_near(of, of->snap, run));
    for (size_t i = 0; i < run->count; i++) {
        const double *const uvw = scratch->locations[i].uvw, *const x = run->x + 3 * i;
        double half[3], jacobian[9];
        if (!ffd_faces_at(&ends, uvw) || scratch->on_face[i] || !vec_is_finite(uvw))
            continue;
        ffd_rounding_find(run->rounding, i, link == 0, x, half);
        if (!ffd_faces_reached(of, uvw, half, of->snap, jacobian))
            continue;
        face_place *const place = &scratch->places[scratch->place_count++];
        *place = (face_place){.point = (uint32_t)i, .link = link};
        memcpy(place->x, x, sizeof place->x);
        memcpy(place->uvw, uvw, sizeof place->uvw);
        memcpy(place->half, half, sizeof place->half);
        scratch->on_face[i] = 1;
    }
}

/* Whether a link's displacement moves a point at all. */
static bool is_moved(const chain_link *link, const double *deltas, size_t point)
{
    return vec_length(deltas + 3 * point) > MOVED * link->lattice->diagonal;
}

static void drop_unmoved(const chain_link *of, size_t link, const double *deltas, chain_scratch *scratch)
{
    size_t kept = 0;
    for (size_t k = 0; k < scratch->place_count; k++) {
        const face_place *const place = &scratch->places[k];
        if (place->link == link && !is_moved(of, deltas, place->point))
            scratch->on_face[place->point] = 0;
        else
            scratch->places[kept++] = *place;
    }
    scratch->place_count = kept;
}

/* Places per call of the locator. */
#define PLACES 64

/* Counts those of the numbered places that are on a common face with a link, and marks them as counted. */
static ffd_status count_places(const lattice_chain *chain, size_t link, const size_t *indices, size_t count,
                               chain_run *run, ffd_error *error)
{
    const chain_link *const to = &chain->links[link];
    double x[3 * PLACES] = {0};
    ffd_location at[PLACES];
    for (size_t k = 0; k < count; k++)
        memcpy(x + 3 * k, run->scratch->places[indices[k]].x, 3 * sizeof *x);
    TRY(ffd_locator_find(to->locator, x, count, at, error));
    for (size_t k = 0; k < count; k++) {
        face_place *const place = &run->scratch->places[indices[k]];
        if (at[k].status == FFD_VERTEX_OUTSIDE)
            TRY(ffd_retry_near_border(to, to->snap, place->link == 0, run, place->point, place->x, &at[k],
                                      error));
        if (!vec_is_finite(at[k].uvw) || !share_face(chain->links, place, to, at[k].uvw))
            continue;
        place->is_counted = true;
        run->moved_twice++;
    }
    return FFD_OK;
}

ffd_status ffd_common_count(const lattice_chain *chain, size_t link, const double *deltas, chain_run *run,
                            ffd_error *error)
{
    chain_scratch *const scratch = run->scratch;
    const chain_link *const of = &chain->links[link];
    const double near = ON_FACE * of->lattice->diagonal + of->snap;
    size_t indices[PLACES], count = 0;
    drop_unmoved(of, link, deltas, scratch);
    for (size_t k = 0; k < scratch->place_count; k++) {
        const face_place *const place = &scratch->places[k];
        const double slack[3] = {near + 2 * place->half[0], near + 2 * place->half[1],
                                 near + 2 * place->half[2]};
        if (place->link < link && !place->is_counted && is_moved(of, deltas, place->point) &&
            bounds_hold(&chain->boxes[link], place->x, slack))
            indices[count++] = k;
        if (count == PLACES) {
            TRY(count_places(chain, link, indices, count, run, error));
            count = 0;
        }
    }
    return count ? count_places(chain, link, indices, count, run, error) : FFD_OK;
}
