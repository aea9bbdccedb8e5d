#include "job/chain/overlaps.h"
#include "base/memory/memory.h"
#include "base/vector/vec.h"
#include "embed/frame/box_tree.h"
#include "embed/locator.h"
#include "job/chain/point_outcome.h"
#include "lattice/lattice.h"
#include "lattice/spec.h"
#include <ffd/deform.h>
#include <math.h>
#include <stdio.h>

/* Sample places of each block that are looked up in other blocks: along each direction the middle, and this
   part of the domain from either end. */
#define PLACES 27
#define INSET 1e-3
/* A place is in the overlap of two blocks if it is deeper than this part of the domain in both. */
#define DEEP 1e-6

typedef struct overlap_search {
    const lattice_chain *chain;
    double *places; /* PLACES a block; the first is NaN until they are computed */
    uint32_t block; /* the current block, which is compared with later ones */
    overlap_pairs found;
    ffd_status status;
    ffd_error *error;
} overlap_search;

static void find_places(const ffd_lattice *lattice, double *places)
{
    static const double at[3] = {INSET, 0.5, 1 - INSET};
    for (int n = 0; n < PLACES; n++) {
        const int index[3] = {n % 3, n / 3 % 3, n / 9};
        double uvw[3];
        for (int a = 0; a < 3; a++) {
            const double first = ffd_knots_first(&lattice->knots[a]),
                         last = ffd_knots_last(&lattice->knots[a]);
            uvw[a] = first + at[index[a]] * (last - first);
        }
        ffd_lattice_evaluate(lattice, FFD_VOLUME_REST, uvw, places + 3 * n, NULL);
    }
}

/* Whether a point is deep inside a block. */
static bool holds_one(overlap_search *search, uint32_t block, const double *points, size_t count)
{
    const chain_link *const link = &search->chain->links[block];
    const face_ends ends = ffd_face_ends(link->lattice, DEEP);
    ffd_location locations[PLACES];
    search->status = ffd_locator_find(link->locator, points, count, locations, search->error);
    for (size_t i = 0; i < count && !search->status; i++)
        if (ffd_location_is_placed(&locations[i]) && !ffd_faces_at(&ends, locations[i].uvw))
            return true;
    return false;
}

/* Whether a sample place of one block is deep inside another block. */
static bool reaches_into(overlap_search *search, uint32_t from, uint32_t block)
{
    static const double none[3] = {0, 0, 0};
    double *const places = search->places + (size_t)3 * PLACES * from;
    double points[3 * PLACES];
    size_t count = 0;
    if (isnan(*places))
        find_places(search->chain->links[from].lattice, places);
    for (size_t n = 0; n < PLACES; n++) {
        const double *const p = places + 3 * n;
        if (!bounds_hold(&search->chain->boxes[block], p, none))
            continue;
        for (int a = 0; a < 3; a++)
            points[3 * count + (size_t)a] = p[a];
        count++;
    }
    return count > 0 && holds_one(search, block, points, count);
}

/* Returns the centre of the intersection of two bounding boxes; false if they only touch. */
static bool find_middle(const overlap_search *search, uint32_t a, uint32_t b, double middle[3])
{
    const bounds *const of_a = &search->chain->boxes[a], *const of_b = &search->chain->boxes[b];
    for (int c = 0; c < 3; c++) {
        const double low = larger_of(of_a->lo[c], of_b->lo[c]);
        const double high = of_a->hi[c] < of_b->hi[c] ? of_a->hi[c] : of_b->hi[c];
        if (!(high > low))
            return false;
        middle[c] = low + (high - low) / 2;
    }
    return true;
}

/* Tests the centre first: if two boxes with the same axes overlap, it is in both. */
static bool overlap(overlap_search *search, uint32_t a, uint32_t b)
{
    double middle[3];
    if (!find_middle(search, a, b, middle))
        return false;
    bool found = holds_one(search, a, middle, 1) && !search->status && holds_one(search, b, middle, 1);
    for (int turn = 0; turn < 2 && !found && !search->status; turn++)
        found = reaches_into(search, turn ? b : a, turn ? a : b);
    return found && !search->status;
}

static bool visit_pair(void *context, uint32_t other)
{
    overlap_search *const search = context;
    const uint32_t block = search->block;
    if (other <= block)
        return true;
    /* The tree visits in any order; report the pair with the lowest numbers. */
    if (overlap(search, block, other)) {
        if (search->found.pairs == 0 || (search->found.first == block && other < search->found.other)) {
            search->found.first = block;
            search->found.other = other;
        }
        search->found.pairs++;
    }
    return !search->status;
}

ffd_status ffd_overlaps_find(const lattice_chain *chain, overlap_pairs *found, ffd_error *error)
{
    static const double none[3] = {0, 0, 0};
    overlap_search search = {.chain = chain, .error = error};
    *found = (overlap_pairs){0};
    if (!chain->blocks)
        return FFD_OK;
    search.places = ffd_alloc(chain->count, 3 * PLACES * sizeof *search.places);
    if (!search.places)
        return ffd_fail_memory(error);
    for (size_t l = 0; l < chain->count; l++)
        search.places[3 * PLACES * l] = NAN;
    for (size_t l = 0; l < chain->count && !search.status; l++) {
        search.block = (uint32_t)l;
        ffd_box_tree_visit_box(&chain->tree, &chain->boxes[l], none, visit_pair, &search);
    }
    ffd_free(search.places);
    *found = search.found;
    return search.status;
}

ffd_status ffd_overlaps_warn(const lattice_chain *chain, const mesh_log *log, ffd_error *error)
{
    overlap_pairs found;
    char more[60] = "";
    TRY(ffd_overlaps_find(chain, &found, error));
    if (found.pairs == 0)
        return FFD_OK;
    if (found.pairs > 1)
        snprintf(more, sizeof more, ", and %zu more pairs do", found.pairs - 1);
    ffd_log_line(log, FFD_LOG_WARNING,
                 "the volumes of %s and %s overlap%s: what is in both goes with the first {lattice} alone",
                 chain->links[found.first].lattice->spec->name, chain->links[found.other].lattice->spec->name,
                 more);
    return FFD_OK;
}
