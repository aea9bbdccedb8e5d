#include "job/judge/tear_steps.h"
#include "base/memory/memory.h"
#include "base/vector/vec.h"
#include "deform/extension.h"
#include "embed/locator.h"
#include "embed/locator_border.h"
#include "job/chain/chain_apply.h"
#include "job/chain/point_outcome.h"
#include "job/chain/seams.h"
#include "job/judge/tear_walk.h"
#include "job/pass/vertex_rounding.h"
#include <ffd/deform.h>
#include <math.h>
#include <string.h>

/* Bisections of an edge across a seam. */
#define HALVINGS 20
/* After this many bisections, an edge whose u,v,w do not jump is recognized by its shrinking gap. */
#define SURE_HALVINGS 4

/* A point of an edge in the lattice of a seam, or the nearest border point if it is outside. */
typedef struct seam_side {
    double uvw[3], at; /* at: 0 .. 1 from the edge's marked end, which is at the last face */
    double distance;   /* from the border; 0 if inside */
} seam_side;

/* An edge that may cross a seam. */
typedef struct seam_edge {
    const chain_seam *seam; /* NULL: no seam */
    seam_side low, high;    /* nearer to the first face; nearer to the last face */
    bool settled;
} seam_edge;

struct tear_steps {
    const lattice_chain *chain;
    const mesh_faces *faces;
    const uint8_t *marks;
    tear_walks *walks; /* of lattices one after the other */
    vertex_owners owners;
    lattice_chain extended; /* the chain with blocks set to extend to points outside */
    chain_scratch *scratch;
    double x[3 * TEAR_RUN], delta[3 * TEAR_RUN];
    point_outcome outcomes[TEAR_RUN];
    ffd_location locations[TEAR_RUN];
    seam_edge edges[TEAR_RUN];
};

static const double *position_of(const tear_steps *steps, uint32_t vertex)
{
    return steps->faces->positions + 3 * (size_t)vertex;
}

/* Prepares a run of the points in steps->x, which it changes. */
static chain_run start_run(tear_steps *steps, size_t count)
{
    return (chain_run){.x = steps->x,
                       .count = count,
                       .scratch = steps->scratch,
                       .delta = steps->delta,
                       .outcomes = steps->outcomes};
}

/* Context of find_rounding: edges whose staying ends are sent. */
typedef struct sent_edges {
    const tear_steps *steps;
    const uint64_t *edges;
} sent_edges;

static void find_rounding(const void *context, size_t point, bool is_first, const double x[3], double half[3])
{
    const sent_edges *const sent = context;
    (void)is_first; /* in blocks every point is at its position in the file */
    (void)x;
    const uint32_t stays = ffd_faces_number(sent->steps->faces, ffd_tear_end_stays(sent->edges[point]));
    ffd_vertex_rounding(&sent->steps->owners, stays, NULL, half);
}

/* Blocks: the step is either the displacement by the nearest border of all blocks, or the disagreement of two
   blocks. */
static ffd_status find_block_steps(tear_steps *steps, size_t mode, const uint64_t *edges, size_t count,
                                   double *lengths, ffd_error *error)
{
    const lattice_chain *const chain = steps->chain;
    const bool disagrees = mode == TEAR_DISAGREES;
    const sent_edges sent = {steps, edges};
    const chain_rounding rounding = {find_rounding, &sent};
    chain_run run = start_run(steps, count);
    ffd_status status = FFD_OK;
    for (size_t l = 0; l < chain->count && !disagrees && !status; l++)
        status = ffd_locator_border(chain->links[l].locator, &steps->extended.links[l].border, error);
    for (size_t i = 0; i < count; i++)
        memcpy(steps->x + 3 * i, position_of(steps, ffd_tear_end_stays(edges[i])), 3 * sizeof *steps->x);
    if (disagrees) {
        run.rounding = &rounding;
        run.differences = lengths;
    }
    if (!status)
        status = ffd_chain_apply(disagrees ? chain : &steps->extended, chain->count, &run, error);
    for (size_t i = 0; i < count && !disagrees && !status; i++)
        lengths[i] = vec_length(steps->delta + 3 * i);
    return status;
}

/* Finds the locations of the points in steps->x in one link or, with blocks, in their own blocks. Changes
   steps->x. */
static ffd_status locate(tear_steps *steps, size_t link, size_t count, ffd_error *error)
{
    const lattice_chain *const chain = steps->chain;
    chain_run run = start_run(steps, count);
    const ffd_status status = ffd_chain_apply(chain, chain->blocks ? chain->count : link, &run, error);
    if (status || !chain->blocks)
        return status
                   ? status
                   : ffd_locator_find(chain->links[link].locator, steps->x, count, steps->locations, error);
    memcpy(steps->locations, steps->scratch->locations, count * sizeof *steps->locations);
    return FFD_OK;
}

/* Finds the side of the seam that point i (located by locate) is on. If it is outside, takes the nearest
   border point. */
static ffd_status find_side(tear_steps *steps, size_t i, double at, seam_side *side, ffd_error *error)
{
    const lattice_chain *const chain = steps->chain;
    const size_t link = steps->edges[i].seam->link;
    const ffd_location *const location = &steps->locations[i];
    boundary_point nearest;
    side->at = at;
    if (ffd_location_is_placed(location) && (!chain->blocks || steps->scratch->owners[i] == link)) {
        memcpy(side->uvw, location->uvw, sizeof side->uvw);
        side->distance = 0;
        return FFD_OK;
    }
    const ffd_status status =
        ffd_tear_border_point(&chain->links[link], steps->x + 3 * i, HUGE_VAL, &nearest, error);
    if (status)
        return status;
    memcpy(side->uvw, nearest.uvw, sizeof side->uvw);
    side->distance = nearest.distance;
    return FFD_OK;
}

/* Returns the distance of two sides along the seam's direction, relative to the domain. */
static double gap_between(const lattice_chain *chain, const chain_seam *seam, const seam_side *low,
                          const seam_side *high)
{
    const knot_vector *const knots = &chain->links[seam->link].lattice->knots[seam->direction];
    return fabs(high->uvw[seam->direction] - low->uvw[seam->direction]) /
           (ffd_knots_last(knots) - ffd_knots_first(knots));
}

static void place_at(tear_steps *steps, uint64_t edge, double at, size_t i)
{
    const double *const from = position_of(steps, ffd_tear_end_stays(edge));
    const double *const to = position_of(steps, ffd_tear_end_moves(edge));
    for (int a = 0; a < 3; a++)
        steps->x[3 * i + (size_t)a] = at == 1 ? to[a] : from[a] + at * (to[a] - from[a]);
}

/* Returns the seam that an edge of this mode may cross, or NULL. */
static const chain_seam *seam_of(const tear_steps *steps, size_t mode, uint64_t edge, size_t i)
{
    const lattice_chain *const chain = steps->chain;
    const size_t number = mode - ffd_tear_seams(chain);
    if (chain->blocks) /* modes are numbered by direction */
        return steps->scratch->owners[i] == BLOCK_NONE
                   ? NULL
                   : ffd_chain_seam(chain, steps->scratch->owners[i], (int)number);
    const chain_seam *const seam = &chain->seams[number];
    const size_t vertices = steps->faces->vertex_count;
    return ffd_tear_takes(steps->marks, vertices, ffd_tear_end_stays(edge), seam->link) &&
                   ffd_tear_takes(steps->marks, vertices, ffd_tear_end_moves(edge), seam->link)
               ? seam
               : NULL;
}

/* Locates both ends of the edges. The marked end, where `at` is 0, is nearer to the last face. */
static ffd_status begin_seam_edges(tear_steps *steps, size_t mode, const uint64_t *edges, size_t count,
                                   ffd_error *error)
{
    const size_t link =
        steps->chain->blocks ? 0 : steps->chain->seams[mode - ffd_tear_seams(steps->chain)].link;
    ffd_status status = FFD_OK;
    for (int end = 0; end < 2 && !status; end++) {
        for (size_t i = 0; i < count; i++)
            place_at(steps, edges[i], end, i);
        status = locate(steps, link, count, error);
        for (size_t i = 0; i < count && !status; i++) {
            seam_edge *const edge = &steps->edges[i];
            if (end == 0)
                edge->seam = seam_of(steps, mode, edges[i], i);
            else if (steps->chain->blocks && edge->seam && steps->scratch->owners[i] != edge->seam->link)
                edge->seam = NULL;
            edge->settled = !edge->seam;
            if (edge->seam)
                status = find_side(steps, i, end, end ? &edge->low : &edge->high, error);
        }
    }
    return status;
}

/* Bisects each unsettled edge, and keeps the half with the larger change of the parameter. */
static ffd_status halve_seam_edges(tear_steps *steps, int turn, const uint64_t *edges, size_t count,
                                   ffd_error *error)
{
    const lattice_chain *const chain = steps->chain;
    const chain_seam *seam = NULL;
    for (size_t i = 0; i < count; i++) {
        const seam_edge *const edge = &steps->edges[i];
        place_at(steps, edges[i], edge->settled ? 0 : (edge->low.at + edge->high.at) / 2, i);
        seam = edge->settled ? seam : edge->seam;
    }
    ffd_status status = seam ? locate(steps, seam->link, count, error) : FFD_OK;
    for (size_t i = 0; i < count && !status; i++) {
        seam_edge *const edge = &steps->edges[i];
        seam_side middle;
        if (edge->settled)
            continue;
        status = find_side(steps, i, (edge->low.at + edge->high.at) / 2, &middle, error);
        if (gap_between(chain, edge->seam, &edge->low, &middle) >
            gap_between(chain, edge->seam, &middle, &edge->high))
            edge->high = middle;
        else
            edge->low = middle;
        edge->settled =
            turn > SURE_HALVINGS && gap_between(chain, edge->seam, &edge->low, &edge->high) < 0.25;
    }
    return status;
}

/* The step of an edge across a seam is the distance between the displaced faces where the edge crosses. */
static ffd_status find_seam_steps(tear_steps *steps, size_t mode, const uint64_t *edges, size_t count,
                                  double *lengths, ffd_error *error)
{
    const lattice_chain *const chain = steps->chain;
    ffd_status status = begin_seam_edges(steps, mode, edges, count, error);
    for (int turn = 1; turn <= HALVINGS && !status; turn++)
        status = halve_seam_edges(steps, turn, edges, count, error);
    for (size_t i = 0; i < count && !status; i++) {
        const seam_edge *const edge = &steps->edges[i];
        lengths[i] = 0;
        if (!edge->seam || gap_between(chain, edge->seam, &edge->low, &edge->high) < 0.5)
            continue;
        lengths[i] = ffd_seam_parting(chain, edge->seam, edge->low.uvw, edge->high.uvw) *
                     ffd_extension_fade(edge->low.distance, chain->links[edge->seam->link].falloff, NULL);
    }
    return status;
}

ffd_status ffd_tear_steps_find(void *context, size_t mode, const uint64_t *edges, size_t count,
                               double *lengths, ffd_error *error)
{
    tear_steps *const steps = context;
    if (mode >= ffd_tear_seams(steps->chain))
        return find_seam_steps(steps, mode, edges, count, lengths, error);
    return steps->chain->blocks ? find_block_steps(steps, mode, edges, count, lengths, error)
                                : ffd_tear_walks_measure(steps->walks, edges, count, lengths, error);
}

void ffd_tear_steps_free(tear_steps *steps)
{
    if (!steps)
        return;
    ffd_tear_walks_free(steps->walks);
    ffd_vertex_owners_free(&steps->owners);
    ffd_free(steps->extended.links);
    ffd_free(steps->scratch);
    ffd_free(steps);
}

tear_steps *ffd_tear_steps_make(const lattice_chain *chain, const mesh_document *document,
                                const mesh_faces *faces, const uint8_t *marks)
{
    tear_steps *const steps = ffd_alloc_zero(1, sizeof *steps);
    if (!steps)
        return NULL;
    steps->chain = chain;
    steps->faces = faces;
    steps->marks = marks;
    steps->extended = *chain;
    steps->extended.links = ffd_alloc(chain->count, sizeof *chain->links);
    steps->scratch = ffd_alloc_zero(1, sizeof *steps->scratch);
    steps->walks = ffd_tear_walks_make(chain, faces, marks);
    if (!steps->extended.links || !steps->scratch || !steps->walks ||
        ffd_vertex_owners_list(document, &steps->owners, NULL)) {
        ffd_free(steps->extended.links);
        steps->extended.links = NULL;
        ffd_tear_steps_free(steps);
        return NULL;
    }
    memcpy(steps->extended.links, chain->links, chain->count * sizeof *chain->links);
    if (chain->blocks)
        steps->extended.outside = (chain_outside){.extend = true};
    return steps;
}
