#include "job/judge/tear_walk.h"
#include "base/memory/memory.h"
#include "base/vector/vec.h"
#include "deform/extension.h"
#include "embed/frame/frame.h"
#include "embed/locator.h"
#include "embed/locator_border.h"
#include "job/chain/point_outcome.h"
#include "job/judge/tears.h"
#include <math.h>
#include <string.h>

/* The two sides of a border: within the link's volume, and beyond it. */
enum { WITHIN, BEYOND, WAYS };

/* A place at a link's border, followed through the chain on both sides of the border. */
typedef struct tear_walk {
    uint32_t inner, outer; /* the edge's end that link `start` moves, and the other end */
    size_t start;          /* the link whose border is examined; the outer end is followed up to it */
    bool over;             /* no border is left to examine */
    bool apart;            /* past the border; before, both sides coincide at BEYOND */
    bool by_ends;          /* no border is examined: each side follows its own end */
    double x[WAYS][3], delta[WAYS][3];
    double across[3]; /* vector from the border to a place just beyond it */
} tear_walk;

/* A side to be displaced by the current link. Before the sides part, BEYOND stands for both. */
typedef struct walk_stop {
    uint32_t walk;
    uint8_t way;
} walk_stop;

/* Places just beside a border are this part of the lattice's diagonal away from it, */
#define BESIDE 1e-6
/* plus this part of its coordinates, which exceeds the evaluation error of points on a face. */
#define BESIDE_COORDINATES 1e-12
/* A place that misses the lattice by at most this part of that distance is in it: the edge runs along a
   face. */
#define ALONG 1e-3

/* Borders of an edge that are examined one by one; the others are handled together, as the time is the
   product of their number and that of the links. */
#define ROUNDS 16

struct tear_walks {
    const lattice_chain *chain;
    const mesh_faces *faces;
    const uint8_t *marks;
    uint8_t *settled; /* marks of examined links, in planes of TEAR_RUN bytes (chain.h) */
    tear_walk walks[TEAR_RUN];
    walk_stop stops[WAYS * TEAR_RUN];
    double stop_x[WAYS * 3 * TEAR_RUN];
    ffd_location locations[WAYS * TEAR_RUN];
};

static const double *position_of(const tear_walks *walks, uint32_t vertex)
{
    return walks->faces->positions + 3 * (size_t)vertex;
}

static bool takes(const tear_walks *walks, uint32_t vertex, size_t link)
{
    return ffd_tear_takes(walks->marks, walks->faces->vertex_count, vertex, link);
}

ffd_status ffd_tear_border_point(const chain_link *link, const double x[3], double reach,
                                 boundary_point *nearest, ffd_error *error)
{
    const boundary *border;
    const ffd_status status = ffd_locator_border(link->locator, &border, error);
    return status ? status : ffd_boundary_find(border, x, reach, nearest, error);
}

static bool is_settled(const tear_walks *walks, size_t edge, size_t link)
{
    return walks->settled[ffd_kept_plane(link) * TEAR_RUN + edge] & ffd_kept_bit(link);
}

static void settle(tear_walks *walks, size_t edge, size_t link)
{
    walks->settled[ffd_kept_plane(link) * TEAR_RUN + edge] |= ffd_kept_bit(link);
}

static void move_on(tear_walk *walk, int way, const double delta[3])
{
    for (int a = 0; a < 3; a++) {
        walk->x[way][a] += delta[a];
        walk->delta[way][a] += delta[a];
    }
}

/* Finds the vector across the border: towards the outer end or, if that is too close, along the edge. */
static void find_across(const tear_walks *walks, const chain_link *link, const double end[3], tear_walk *walk)
{
    const double *const from = position_of(walks, walk->inner), *const to = position_of(walks, walk->outer);
    const bounds *const hull = &link->locator->hull;
    const double *const x = walk->x[BEYOND];
    double size = 0;
    for (int a = 0; a < 3; a++) {
        size = larger_of(size, larger_of(fabs(hull->lo[a]), fabs(hull->hi[a])));
        walk->across[a] = end[a] - x[a];
    }
    const double beside = BESIDE * link->lattice->diagonal + BESIDE_COORDINATES * size;
    const bool is_clear = vec_length(walk->across) > beside;
    for (int a = 0; a < 3 && !is_clear; a++)
        walk->across[a] = to[a] - from[a];
    const double length = vec_length(walk->across);
    for (int a = 0; a < 3 && length > 0; a++)
        walk->across[a] *= beside / length;
}

/* The outer end has reached link `start`, which leaves it. Splits the walk at the nearest border point. */
static ffd_status part_at_border(tear_walks *walks, size_t edge, ffd_error *error)
{
    tear_walk *const walk = &walks->walks[edge];
    const chain_link *const link = &walks->chain->links[walk->start];
    boundary_point nearest;
    double delta[3], end[3];
    memcpy(end, walk->x[BEYOND], sizeof end);
    const ffd_status status = ffd_tear_border_point(link, end, HUGE_VAL, &nearest, error);
    walk->apart = true;
    memset(walk->delta, 0, sizeof walk->delta);
    settle(walks, edge, walk->start);
    if (status || !nearest.found)
        return status;
    for (int way = 0; way < WAYS; way++)
        ffd_lattice_evaluate(link->lattice, FFD_VOLUME_REST, nearest.uvw, walk->x[way], NULL);
    find_across(walks, link, end, walk);
    ffd_displacement(link->lattice, nearest.uvw, delta, NULL);
    move_on(walk, WITHIN, delta);
    return FFD_OK;
}

/* Whether a link holds the place just beside the border, on one side. */
static ffd_status find_beside(const chain_link *link, const tear_walk *walk, int way, bool *holds,
                              ffd_error *error)
{
    const double sign = way == WITHIN ? -1 : 1;
    double p[3];
    ffd_location location;
    boundary_point nearest;
    for (int a = 0; a < 3; a++)
        p[a] = walk->x[BEYOND][a] + sign * walk->across[a];
    ffd_status status = ffd_locator_find(link->locator, p, 1, &location, error);
    *holds = !status && ffd_location_is_placed(&location);
    if (status || *holds)
        return status;
    status = ffd_tear_border_point(link, p, ALONG * vec_length(walk->across), &nearest, error);
    *holds = !status && nearest.found;
    return status;
}

/* Decides which sides move with a link that moves one end and not the other. If its border is here too, each
   side moves if the link holds it. If the link holds both or neither side, its border is elsewhere and is
   examined in its own round. If it holds neither but moves the outer end, the edge leads through a gap into
   another lattice, and the sides move like their ends. */
static ffd_status choose_sides(tear_walks *walks, size_t edge, size_t link, bool takes_way[WAYS],
                               ffd_error *error)
{
    const tear_walk *const walk = &walks->walks[edge];
    const bool inner = takes_way[WITHIN], outer = takes_way[BEYOND];
    bool holds[WAYS] = {false, false};
    ffd_status status = FFD_OK;
    for (int way = 0; way < WAYS && !status; way++)
        status = find_beside(&walks->chain->links[link], walk, way, &holds[way], error);
    if (!outer || holds[WITHIN] || holds[BEYOND])
        memcpy(takes_way, holds, sizeof holds);
    if (takes_way[WITHIN] == inner && takes_way[BEYOND] == outer)
        settle(walks, edge, link);
    return status;
}

/* Lists the sides of an edge that a link moves. */
static ffd_status list_stops(tear_walks *walks, size_t link, size_t edge, size_t *stop_count,
                             ffd_error *error)
{
    tear_walk *const walk = &walks->walks[edge];
    bool takes_way[WAYS] = {
        [WITHIN] = takes(walks, walk->inner, link), [BEYOND] = takes(walks, walk->outer, link)};
    ffd_status status = FFD_OK;
    if (!walk->apart && link == walk->start)
        return part_at_border(walks, edge, error);
    if (!walk->apart)
        takes_way[WITHIN] = false;
    else if (takes_way[WITHIN] != takes_way[BEYOND] && !walk->by_ends)
        status = choose_sides(walks, edge, link, takes_way, error);
    for (uint8_t way = 0; way < WAYS && !status; way++) {
        if (!takes_way[way])
            continue;
        memcpy(walks->stop_x + 3 * *stop_count, walk->x[way], sizeof walk->x[way]);
        walks->stops[(*stop_count)++] = (walk_stop){(uint32_t)edge, way};
    }
    return status;
}

/* Displaces a side by a link: by its location, or else from the nearest border point. */
static ffd_status displace(const chain_link *link, const double x[3], const ffd_location *location, int way,
                           tear_walk *walk, ffd_error *error)
{
    const bool turns = way == BEYOND && walk->apart;
    double delta[3] = {0, 0, 0}, gradient[9] = {0}, turned[3];
    boundary_point nearest;
    if (ffd_location_is_placed(location)) {
        ffd_displacement(link->lattice, location->uvw, delta, turns ? gradient : NULL);
    } else {
        const ffd_status status = ffd_tear_border_point(link, x, HUGE_VAL, &nearest, error);
        if (status)
            return status;
        if (nearest.found)
            ffd_extension_displacement(link->lattice, &nearest, link->falloff, delta,
                                       turns ? gradient : NULL);
    }
    move_on(walk, way, delta);
    mat_apply(gradient, walk->across, turned);
    for (int a = 0; a < 3; a++)
        walk->across[a] += turned[a];
    return FFD_OK;
}

static ffd_status walk_link(tear_walks *walks, size_t link, size_t count, ffd_error *error)
{
    const chain_link *const of = &walks->chain->links[link];
    size_t stop_count = 0;
    ffd_status status = FFD_OK;
    for (size_t i = 0; i < count && !status; i++)
        if (!walks->walks[i].over)
            status = list_stops(walks, link, i, &stop_count, error);
    if (!status)
        status = ffd_locator_find(of->locator, walks->stop_x, stop_count, walks->locations, error);
    for (size_t s = 0; s < stop_count && !status; s++)
        status = displace(of, walks->stop_x + 3 * s, &walks->locations[s], walks->stops[s].way,
                          &walks->walks[walks->stops[s].walk], error);
    return status;
}

/* Whether the staying end of an edge does not move at all: it may not move, or is outside of all links. */
static bool stays_behind(const tear_walks *walks, uint64_t edge)
{
    return !ffd_tear_takes_part(walks->marks, walks->faces->vertex_count, ffd_tear_end_stays(edge),
                                walks->chain->count);
}

/* Starts a round at the first unexamined link that moves only one end. If the staying end does not move at
   all, there is a single round, in which it follows its neighbour. */
static void begin_walk(tear_walks *walks, size_t i, int round, uint64_t edge)
{
    const uint32_t stays = ffd_tear_end_stays(edge), moves = ffd_tear_end_moves(edge);
    const size_t links = walks->chain->count;
    const bool behind = stays_behind(walks, edge);
    tear_walk *const walk = &walks->walks[i];
    size_t l = 0;
    while (l < links && !behind &&
           (takes(walks, stays, l) == takes(walks, moves, l) || is_settled(walks, i, l)))
        l++;
    const bool back = l < links && takes(walks, stays, l);
    *walk = (tear_walk){.inner = back ? stays : moves,
                        .outer = back ? moves : stays,
                        .start = l,
                        .over = l == links || round > (behind ? 0 : ROUNDS),
                        .apart = behind,
                        .by_ends = behind || round == ROUNDS};
    for (int way = 0; way < WAYS; way++)
        memcpy(walk->x[way], position_of(walks, walk->outer), sizeof walk->x[way]);
}

/* Updates the largest steps. Returns whether borders are left to examine. */
static bool end_round(const tear_walks *walks, size_t count, double *lengths)
{
    bool more = false;
    for (size_t i = 0; i < count; i++) {
        const tear_walk *const walk = &walks->walks[i];
        double difference[3];
        if (walk->over)
            continue;
        for (int a = 0; a < 3; a++)
            difference[a] = walk->delta[WITHIN][a] - walk->delta[BEYOND][a];
        lengths[i] = larger_of(lengths[i], vec_length(difference));
        more |= !walk->by_ends;
    }
    return more;
}

ffd_status ffd_tear_walks_measure(tear_walks *walks, const uint64_t *edges, size_t count, double *lengths,
                                  ffd_error *error)
{
    ffd_status status = FFD_OK;
    bool more = count > 0;
    memset(lengths, 0, count * sizeof *lengths);
    memset(walks->settled, 0, ffd_kept_planes(walks->chain->count) * TEAR_RUN);
    for (int round = 0; more && !status; round++) {
        for (size_t i = 0; i < count; i++)
            begin_walk(walks, i, round, edges[i]);
        for (size_t l = 0; l < walks->chain->count && !status; l++)
            status = walk_link(walks, l, count, error);
        more = end_round(walks, count, lengths);
    }
    return status;
}

tear_walks *ffd_tear_walks_make(const lattice_chain *chain, const mesh_faces *faces, const uint8_t *marks)
{
    tear_walks *const walks = ffd_alloc_zero(1, sizeof *walks);
    uint8_t *const settled = ffd_alloc(ffd_kept_planes(chain->count), TEAR_RUN);
    if (!walks || !settled) {
        ffd_free(walks);
        ffd_free(settled);
        return NULL;
    }
    walks->settled = settled;
    walks->chain = chain;
    walks->faces = faces;
    walks->marks = marks;
    return walks;
}

void ffd_tear_walks_free(tear_walks *walks)
{
    if (!walks)
        return;
    ffd_free(walks->settled);
    ffd_free(walks);
}
