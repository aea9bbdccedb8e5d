#include "job/chain/block_nets.h"
#include "base/memory/memory.h"
#include "base/vector/vec.h"
#include "embed/frame/frame.h"
#include "lattice/border.h"
#include "lattice/lattice.h"
#include <float.h>
#include <math.h>
#include <string.h>

/* Two faces are moved alike if their control points' displacements differ by at most this part of the
   diagonal. */
#define AGREEMENT 1e-9
/* Positions agree within so many eps of the coordinates, and boxes touch. */
#define ROUNDING 64
/* Knots agree, relative to the domain. */
#define KNOTS 1e-12

enum { FACES = 6, CORNERS = 4 };

/* A face of a block: bit 0 of its number is the end, the others are the direction. */
typedef struct net_face {
    border_face rest, moves; /* the control points at rest, and their displacements */
    double corners[CORNERS][3];
    size_t size[2]; /* of the net, along `along` */
    int along[2];
} net_face;

/* How indices of one face lead to those of another. */
typedef struct net_turn {
    bool swaps;      /* the first direction of one is the second of the other */
    bool reverse[2]; /* by direction of the first face */
} net_turn;

typedef struct net_work {
    const lattice_chain *chain;
    net_face *faces;  /* FACES for each block */
    uint32_t *groups; /* of blocks that are connected: the number of one of them */
    uint32_t block;   /* the one at hand */
    bool agree;
} net_work;

/* The control point i, j of a face, or its displacement. */
static void find_point(const net_face *face, const border_face *of, size_t i, size_t j, double point[4])
{
    static const double origin[3] = {0, 0, 0};
    size_t index[3] = {0, 0, 0};
    index[face->along[0]] = i;
    index[face->along[1]] = j;
    ffd_border_point(of, index, origin, point);
    for (int c = 0; c < 3; c++)
        point[c] /= point[3];
}

/* Returns false if the block is closed in the direction, so that it has no face there. */
static bool make_face(const ffd_lattice *lattice, int index, net_face *face)
{
    const int direction = index / 2;
    if (ffd_knots_closed(&lattice->knots[direction]))
        return false;
    face->along[0] = direction == 0 ? 1 : 0;
    face->along[1] = direction == 2 ? 1 : 2;
    ffd_border_face(lattice, FFD_VOLUME_REST, direction, index % 2, &face->rest);
    face->moves = face->rest;
    face->moves.points = lattice->difference;
    for (int a = 0; a < 2; a++)
        face->size[a] = lattice->size[face->along[a]];
    for (size_t c = 0; c < CORNERS; c++) {
        double point[4];
        find_point(face, &face->rest, c % 2 ? face->size[0] - 1 : 0, c / 2 ? face->size[1] - 1 : 0, point);
        memcpy(face->corners[c], point, sizeof face->corners[c]);
    }
    return true;
}

static bool are_within(const double a[3], const double b[3], double tolerance)
{
    for (int c = 0; c < 3; c++)
        if (!(fabs(a[c] - b[c]) <= tolerance))
            return false;
    return true;
}

/* Finds how the corners of one face lie on those of another. */
static bool find_turn(const net_face *a, const net_face *b, double tolerance, net_turn *turn)
{
    for (unsigned n = 0; n < 8; n++) {
        bool fits = true;
        *turn = (net_turn){n & 1, {n >> 1 & 1, n >> 2 & 1}};
        for (unsigned c = 0; c < CORNERS && fits; c++) {
            const unsigned i = (c & 1) ^ turn->reverse[0], j = (c >> 1) ^ turn->reverse[1];
            fits = are_within(a->corners[c], b->corners[turn->swaps ? j + 2 * i : i + 2 * j], tolerance);
        }
        if (fits)
            return true;
    }
    return false;
}

/* Whether two directions have the same knots, or the mirrored ones. */
static bool are_equal_knots(const knot_vector *a, const knot_vector *b, bool reverse)
{
    const double first_a = ffd_knots_first(a), length_a = ffd_knots_last(a) - first_a;
    const double first_b = ffd_knots_first(b), length_b = ffd_knots_last(b) - first_b;
    const size_t count = a->functions + (size_t)a->degree + 1;
    if (a->degree != b->degree || a->functions != b->functions || ffd_knots_closed(a) || ffd_knots_closed(b))
        return false;
    for (size_t i = 0; i < count; i++) {
        const double t = (a->t[i] - first_a) / length_a;
        const double s = (b->t[reverse ? count - 1 - i : i] - first_b) / length_b;
        if (!(fabs(t - (reverse ? 1 - s : s)) <= KNOTS))
            return false;
    }
    return true;
}

/* Whether two faces have the same net, moved alike. */
static bool are_one(const net_face *a, const net_face *b, const net_turn *turn, double tolerance)
{
    const ffd_lattice *const of_a = a->rest.lattice, *const of_b = b->rest.lattice;
    const double alike = AGREEMENT * larger_of(of_a->diagonal, of_b->diagonal);
    double ratio = 0;
    for (int d = 0; d < 2; d++)
        if (!are_equal_knots(&of_a->knots[a->along[d]], &of_b->knots[b->along[turn->swaps ? 1 - d : d]],
                             turn->reverse[d]))
            return false;
    for (size_t j = 0; j < a->size[1]; j++)
        for (size_t i = 0; i < a->size[0]; i++) {
            const size_t s = turn->reverse[0] ? a->size[0] - 1 - i : i;
            const size_t t = turn->reverse[1] ? a->size[1] - 1 - j : j;
            double p[4], q[4], d[4], e[4];
            find_point(a, &a->rest, i, j, p);
            find_point(b, &b->rest, turn->swaps ? t : s, turn->swaps ? s : t, q);
            find_point(a, &a->moves, i, j, d);
            find_point(b, &b->moves, turn->swaps ? t : s, turn->swaps ? s : t, e);
            ratio = ratio == 0 ? p[3] / q[3] : ratio;
            if (!are_within(p, q, tolerance) || !are_within(d, e, alike) ||
                !(fabs(p[3] - ratio * q[3]) <= KNOTS * p[3]))
                return false;
        }
    return true;
}

/* How far two boxes overlap along each axis, less than 0 by rounding only counts as 0. Returns the number of
   axes along which they overlap, or -1 if they do not touch. */
static int count_overlaps(const bounds *a, const bounds *b, double tolerance)
{
    int overlaps = 0;
    for (int c = 0; c < 3; c++) {
        const double overlap = lesser_of(a->hi[c], b->hi[c]) - larger_of(a->lo[c], b->lo[c]);
        if (overlap < -tolerance)
            return -1;
        overlaps += overlap > tolerance;
    }
    return overlaps;
}

static uint32_t group_of(const net_work *work, uint32_t block)
{
    while (work->groups[block] != block)
        block = work->groups[block];
    return block;
}

/* Compares the block at hand with an earlier one whose box it meets. */
static bool compare(void *context, uint32_t other)
{
    net_work *const work = context;
    const bounds *const a = &work->chain->boxes[work->block], *const b = &work->chain->boxes[other];
    double size = 0;
    if (other >= work->block)
        return true;
    for (int c = 0; c < 3; c++)
        size = larger_of(size, larger_of(larger_of(fabs(a->lo[c]), fabs(a->hi[c])),
                                         larger_of(fabs(b->lo[c]), fabs(b->hi[c]))));
    const double tolerance = ROUNDING * DBL_EPSILON * size;
    const int overlaps = count_overlaps(a, b, tolerance);
    if (overlaps < 2)
        return true; /* they have an edge or a corner in common, or nothing */
    for (unsigned n = 0; n < FACES * FACES && overlaps == 2; n++) {
        net_turn turn;
        const net_face *const of_a = &work->faces[FACES * work->block + n / FACES];
        const net_face *const of_b = &work->faces[FACES * (size_t)other + n % FACES];
        if (!find_turn(of_a, of_b, tolerance, &turn))
            continue;
        work->agree = are_one(of_a, of_b, &turn, tolerance);
        work->groups[group_of(work, work->block)] = group_of(work, other);
        return work->agree;
    }
    work->agree = false;
    return false;
}

ffd_status ffd_blocks_join(const lattice_chain *chain, bool *join, ffd_error *error)
{
    net_work work = {.chain = chain, .agree = true};
    *join = false;
    for (size_t l = 0; l < chain->count; l++)
        if (!chain->links[l].is_convex || ffd_link_mover(&chain->links[l])->weights_moved)
            return FFD_OK;
    work.faces = ffd_alloc_zero(chain->count, FACES * sizeof *work.faces);
    work.groups = ffd_alloc(chain->count, sizeof *work.groups);
    ffd_status status;
    TRY_END(work.faces && work.groups ? FFD_OK : ffd_fail_memory(error));
    for (size_t l = 0; l < chain->count; l++) {
        work.groups[l] = (uint32_t)l;
        for (int n = 0; n < FACES && work.agree; n++)
            work.agree = make_face(ffd_link_mover(&chain->links[l]), n, &work.faces[FACES * l + (size_t)n]);
    }
    for (size_t l = 1; l < chain->count && work.agree; l++) {
        work.block = (uint32_t)l;
        ffd_box_tree_visit_box(&chain->tree, &chain->boxes[l], chain->slack, compare, &work);
    }
    for (size_t l = 1; l < chain->count && work.agree; l++)
        work.agree = group_of(&work, (uint32_t)l) == group_of(&work, 0);
    *join = work.agree;
end:
    ffd_free(work.faces);
    ffd_free(work.groups);
    return status;
}
