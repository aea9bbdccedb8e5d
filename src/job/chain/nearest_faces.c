#include "job/chain/nearest_faces.h"
#include "embed/locator.h"
#include "embed/locator_border.h"
#include "job/chain/blocks.h"
#include "job/chain/common_faces.h"
#include "job/chain/point_outcome.h"

/* Faces that meet are told apart this far from where they meet, as a part of the domain; and so far inside a
   face it is seen whether another block is behind it. */
#define ASIDE 1e-6
#define INSET 1e-3
/* A vertex is beyond a face if its direction from the nearest point has this part outwards. */
#define OUTWARDS 1e-5
/* Borders of blocks are equally near if they differ by this part of the distance. */
#define EQUAL_DISTANCE 1e-9

/* Returns uvw at another place: all coordinates that are on faces, but that of direction a, are moved away
   from them by a part of the domain. */
static void move_aside(const ffd_lattice *lattice, unsigned faces, int a, double part, const double uvw[3],
                       double to[3])
{
    for (int d = 0; d < 3; d++) {
        const knot_vector *const knots = &lattice->knots[d];
        const double by = part * (ffd_knots_last(knots) - ffd_knots_first(knots));
        to[d] = uvw[d];
        if (d != a && faces >> (2 * d) & 3)
            to[d] += faces >> (2 * d) & 1 ? by : -by;
    }
}

/* Of faces that meet at the nearest point, those that the vertex is beyond: one in the plane of a face is
   not. Where a face has no normal, as an axis has none, nothing is beyond it. */
static unsigned faces_beyond(const chain_link *link, unsigned faces, const boundary_point *nearest)
{
    unsigned beyond = 0;
    for (int f = 0; f < 6; f++) {
        double uvw[3], point[3], jacobian[9], normals[6][3];
        if (!(faces >> f & 1))
            continue;
        move_aside(link->lattice, faces, f / 2, ASIDE, nearest->uvw, uvw);
        ffd_lattice_evaluate(link->lattice, FFD_VOLUME_REST, uvw, point, jacobian);
        ffd_faces_normals(1U << f, jacobian, normals);
        if (vec_dot(normals[f], nearest->direction) > OUTWARDS)
            beyond |= 1U << f;
    }
    return beyond ? beyond : faces;
}

/* Faces that lie on each other at rest, as those of a full turn, are not on the surface of the volume. */
static unsigned without_seams(const chain_link *link, unsigned faces)
{
    unsigned left = faces;
    for (int a = 0; a < 3; a++)
        if (ffd_locator_has_seam(link->locator, a))
            left &= ~(3U << (2 * a));
    return left ? left : faces;
}

static bool is_one(unsigned faces)
{
    return (faces & (faces - 1)) == 0;
}

static unsigned faces_at(const chain_link *link, const boundary_point *nearest)
{
    const face_ends ends = ffd_face_ends(link->lattice, ON_FACE);
    const unsigned faces = without_seams(link, ffd_faces_at(&ends, nearest->uvw));
    return is_one(faces) ? faces : faces_beyond(link, faces, nearest);
}

/* Whether another block holds a place. */
static ffd_status is_held(const lattice_chain *chain, size_t block, const double place[3], bool *held,
                          ffd_error *error)
{
    *held = false;
    for (size_t l = 0; l < chain->count && !*held; l++) {
        ffd_location location;
        if (l == block || !bounds_hold(&chain->boxes[l], place, chain->slack))
            continue;
        TRY(ffd_locator_find(chain->links[l].locator, place, 1, &location, error));
        *held = ffd_location_is_placed(&location);
    }
    return FFD_OK;
}

/* Takes away the faces of a block behind which there is another one: at the nearest point such a face meets
   one that is free. */
static ffd_status drop_shared(const lattice_chain *chain, size_t block, const double uvw[3], unsigned *faces,
                              ffd_error *error)
{
    const ffd_lattice *const lattice = chain->links[block].lattice;
    const face_ends ends = ffd_face_ends(lattice, ON_FACE);
    const unsigned all = ffd_faces_at(&ends, uvw);
    for (int f = 0; f < 6; f++) {
        double aside[3], place[3];
        bool held;
        if (!(*faces >> f & 1) || is_one(all))
            continue;
        move_aside(lattice, all, f / 2, INSET, uvw, aside);
        ffd_lattice_evaluate(lattice, FFD_VOLUME_REST, aside, place, NULL);
        TRY(is_held(chain, block, place, &held, error));
        if (held)
            *faces &= ~(1U << f);
    }
    return FFD_OK;
}

/* A point, and what visits the faces that are nearest to it. */
typedef struct face_search {
    const lattice_chain *chain;
    const double *p;
    double reach;
    nearest_face_visitor *visit;
    void *context;
    ffd_status status;
    ffd_error *error;
} face_search;

static ffd_status visit_link(const face_search *search, size_t link)
{
    const chain_link *const of = &search->chain->links[link];
    const boundary *border;
    boundary_point nearest;
    TRY(ffd_locator_border(of->locator, &border, search->error));
    TRY(ffd_boundary_find(border, search->p, search->reach, &nearest, search->error));
    if (!nearest.found)
        return FFD_OK;
    unsigned faces = faces_at(of, &nearest);
    if (search->chain->blocks)
        TRY(drop_shared(search->chain, link, nearest.uvw, &faces, search->error));
    if (faces)
        search->visit(search->context, link, faces);
    return FFD_OK;
}

static bool visit_block(void *context, uint32_t block)
{
    face_search *const search = context;
    search->status = visit_link(search, block);
    return !search->status;
}

ffd_status ffd_nearest_faces(const lattice_chain *chain, size_t link, const double p[3],
                             nearest_face_visitor *visit, void *context, ffd_error *error)
{
    face_search search = {
        .chain = chain, .p = p, .reach = HUGE_VAL, .visit = visit, .context = context, .error = error};
    boundary_point nearest;
    uint32_t block;
    if (!chain->blocks)
        return visit_link(&search, link);
    TRY(ffd_blocks_nearest(chain, p, HUGE_VAL, &nearest, &block, error));
    if (!nearest.found)
        return FFD_OK;
    search.reach = nearest.distance * (1 + EQUAL_DISTANCE);
    ffd_box_tree_visit_near(&chain->tree, p, &search.reach, visit_block, &search);
    return search.status;
}
