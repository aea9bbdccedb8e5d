/* search_many.c - searches several points of a general lattice at a time. A point is queued until there are
   others of its cell; their iterations then run together, each in its own leaf. A point with several leaves
   is queued in each, and gets its verdict when all of them are finished. Points that are not decided this way
   are searched alone (search.c), and the others get the same bits as there. */
#include "base/memory/memory.h"
#include "embed/cells/packet.h"
#include "embed/cells/region_kernel.h"
#include "embed/cells/region_root.h"
#include <math.h>
#include <string.h>

/* The result of the iteration in a leaf. */
typedef struct leaf_result {
    const cell_leaf *leaf;
    region_outcome outcome;
    uint32_t evaluations;
    double t[3];
    sample at;
} leaf_result;

typedef struct waiting_point {
    const cell_leaf *leaf;
    uint32_t index;
    leaf_result *result; /* for a point with several leaves; NULL: this is its only leaf */
} waiting_point;

/* A point with several leaves. */
typedef struct shared_point {
    uint32_t index, count;
    leaf_result *results; /* in the order of its leaves */
} shared_point;

/* A point in the search's units with its tolerance, computed once. */
typedef struct placed_point {
    double x[3], tolerance[3], aim[3];
} placed_point;

/* The queued points in leaves of one cell. */
typedef struct cell_group {
    const int *span;
    size_t first, count; /* range in `grouped` */
} cell_group;

#define MOST_WAITING (2 * CELLS_AT_ONCE)
#define BUCKETS (2 * MOST_WAITING)
#define NO_GROUP UINT16_MAX

struct many_scratch {
    waiting_point waiting[MOST_WAITING], grouped[MOST_WAITING];
    uint16_t group_of[MOST_WAITING]; /* group of each queued point */
    cell_group groups[MOST_WAITING];
    uint16_t buckets[BUCKETS]; /* hash table of groups by cell */
    shared_point shared[CELLS_AT_ONCE / 2];
    leaf_result results[CELLS_AT_ONCE];
    placed_point placed[CELLS_AT_ONCE]; /* indexed by the number of the point; set for queued points */
    region_kernel_cell cell;
    double own[CELL_NUMBERS];
    region_lanes lanes;
};

static bool same_cell(const int a[3], const int b[3])
{
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

/* Returns the group of a cell, and adds it if it is new. */
static cell_group *take_group(struct many_scratch *many, const int span[3], size_t *group_count)
{
    /* Primes, so that neighbouring cells are in different buckets. */
    size_t bucket = ((size_t)span[0] + 61 * (size_t)span[1] + 3727 * (size_t)span[2]) % BUCKETS;
    for (; many->buckets[bucket] != NO_GROUP; bucket = (bucket + 1) % BUCKETS)
        if (same_cell(many->groups[many->buckets[bucket]].span, span))
            return &many->groups[many->buckets[bucket]];
    many->buckets[bucket] = (uint16_t)*group_count;
    cell_group *const made = &many->groups[(*group_count)++];
    *made = (cell_group){.span = span};
    return made;
}

/* Groups the queued points by cell, stably, in many->grouped. Returns the number of cells. */
static size_t group_waiting(struct many_scratch *many, size_t count)
{
    size_t group_count = 0, first = 0;
    memset(many->buckets, 0xff, sizeof many->buckets);
    for (size_t i = 0; i < count; i++) {
        const int *const span = many->waiting[i].leaf->region.span;
        const bool same = i > 0 && same_cell(span, many->waiting[i - 1].leaf->region.span);
        cell_group *const group =
            same ? &many->groups[many->group_of[i - 1]] : take_group(many, span, &group_count);
        many->group_of[i] = (uint16_t)(group - many->groups);
        group->count++;
    }
    for (size_t g = 0; g < group_count; g++) {
        many->groups[g].first = first;
        first += many->groups[g].count;
        many->groups[g].count = 0;
    }
    for (size_t i = 0; i < count; i++) {
        cell_group *const group = &many->groups[many->group_of[i]];
        many->grouped[group->first + group->count++] = many->waiting[i];
    }
    return group_count;
}

static void load_cell(const ffd_locator *locator, const int span[3], double *own, region_kernel_cell *cell)
{
    for (int a = 0; a < 3; a++) {
        cell->order[a] = locator->cells->order[a];
        cell->schemes[a] = ffd_cells_scheme(locator, a, span[a], &cell->own_schemes[a]);
    }
    ffd_cells_rows(locator, span, cell->rows, own);
}

static void load_point(const placed_point *point, const cell_leaf *leaf, int lane, region_lanes *lanes)
{
    lanes->region[lane] = &leaf->region;
    for (int a = 0; a < 3; a++) {
        lanes->x[a][lane] = point->x[a];
        lanes->tolerance[a][lane] = point->tolerance[a];
        lanes->aim[a][lane] = point->aim[a];
    }
}

/* Written in place: a wide copy of values that were just stored one by one would stall (no store
   forwarding). */
static void take_result(const cell_leaf *leaf, const region_lanes *lanes, int lane, leaf_result *result)
{
    result->leaf = leaf;
    result->outcome = lanes->outcome[lane];
    result->evaluations = lanes->evaluations[lane];
    result->at.weight = 1;
    for (int a = 0; a < 3; a++) {
        result->t[a] = lanes->t[a][lane];
        result->at.equation[a] = result->at.residual[a] = lanes->equation[a][lane];
    }
    for (int i = 0; i < 9; i++)
        result->at.jacobian[i] = lanes->jacobian[i][lane];
}

/* Determines the verdict from the results of all leaves of a point. */
static void judge(const ffd_locator *locator, const placed_point *point, const leaf_result *results,
                  uint32_t count, ffd_location *location)
{
    point_search search;
    ffd_search_begin(&search, locator);
    memcpy(search.tolerance, point->tolerance, sizeof search.tolerance);
    search.leaves = count;
    for (uint32_t i = 0; i < count; i++) {
        search.evaluations += results[i].evaluations;
        if (results[i].outcome == REGION_FOUND)
            ffd_search_record(&search, &results[i].leaf->region, results[i].t, &results[i].at, false);
    }
    ffd_search_judge(&search, location);
}

static ffd_status find_alone(const ffd_locator *locator, const double *p, uint32_t index,
                             search_scratch **scratch, ffd_location *locations, ffd_error *error)
{
    return ffd_cells_find(locator, p + 3 * (size_t)index, scratch, &locations[index], error);
}

/* Processes the points of a cell. */
static ffd_status find_in_cell(const ffd_locator *locator, const double *p, const waiting_point *waiting,
                               size_t count, search_scratch **scratch, ffd_location *locations,
                               ffd_error *error)
{
    const size_t width = (size_t)locator->cells->lanes;
    region_lanes *const lanes = &(*scratch)->many->lanes;
    const placed_point *const placed = (*scratch)->many->placed;
    load_cell(locator, waiting->leaf->region.span, (*scratch)->many->own, &(*scratch)->many->cell);
    for (size_t first = 0; first < count; first += width) {
        const size_t filled = count - first < width ? count - first : width;
        for (size_t l = 0; l < width; l++) {
            const waiting_point *const point = &waiting[first + (l < filled ? l : filled - 1)];
            load_point(&placed[point->index], point->leaf, (int)l, lanes);
        }
        locator->cells->region_kernel(&(*scratch)->many->cell, lanes);
        for (size_t l = 0; l < filled; l++) {
            const waiting_point *const point = &waiting[first + l];
            leaf_result own, *const result = point->result ? point->result : &own;
            take_result(point->leaf, lanes, (int)l, result);
            if (point->result)
                continue;
            if (result->outcome == REGION_UNCERTAIN)
                TRY(find_alone(locator, p, point->index, scratch, locations, error));
            else
                judge(locator, &placed[point->index], result, 1, &locations[point->index]);
        }
    }
    return FFD_OK;
}

static ffd_status find_waiting(const ffd_locator *locator, const double *p, size_t count,
                               search_scratch **scratch, ffd_location *locations, ffd_error *error)
{
    struct many_scratch *const many = (*scratch)->many;
    const size_t groups = group_waiting(many, count);
    for (size_t g = 0; g < groups; g++)
        TRY(find_in_cell(locator, p, many->grouped + many->groups[g].first, many->groups[g].count, scratch,
                         locations, error));
    return FFD_OK;
}

/* The kernel needs a lattice without weights, and without collapses, which are examined first for each
   point. */
static bool has_lanes(const cell_search *cells)
{
    return cells->region_kernel && !cells->rational && cells->collapses.count == 0;
}

/* The state of a call. */
typedef struct many_search {
    const ffd_locator *locator;
    const double *p;
    search_scratch **scratch;
    ffd_location *locations;
    ffd_error *error;
    point_packet packet;
    size_t waiting, shared, results; /* numbers of entries in the scratch memory */
} many_search;

/* Queues a point in its leaves. Returns false if there are too many. */
static bool wait_in_leaves(many_search *many, const packet_point *point)
{
    struct many_scratch *const scratch = (*many->scratch)->many;
    leaf_result *results = NULL;
    if (point->count > 1) {
        if (CELLS_AT_ONCE - many->results < point->count)
            return false;
        results = scratch->results + many->results;
        many->results += point->count;
        scratch->shared[many->shared++] = (shared_point){point->index, point->count, results};
    }
    placed_point *const placed = &scratch->placed[point->index];
    memcpy(placed->x, point->search.x, sizeof placed->x);
    memcpy(placed->tolerance, point->search.tolerance, sizeof placed->tolerance);
    memcpy(placed->aim, point->search.aim, sizeof placed->aim);
    for (uint32_t i = 0; i < point->count; i++)
        scratch->waiting[many->waiting++] =
            (waiting_point){point->leaves[i], point->index, results ? results + i : NULL};
    return true;
}

/* Determines the verdicts of points with several leaves, all of which are finished. */
static ffd_status judge_shared(const many_search *many)
{
    const struct many_scratch *const scratch = (*many->scratch)->many;
    for (size_t i = 0; i < many->shared; i++) {
        const shared_point *const point = &scratch->shared[i];
        bool certain = true;
        for (uint32_t l = 0; l < point->count; l++)
            certain = certain && point->results[l].outcome != REGION_UNCERTAIN;
        if (certain)
            judge(many->locator, &scratch->placed[point->index], point->results, point->count,
                  &many->locations[point->index]);
        else
            TRY(find_alone(many->locator, many->p, point->index, many->scratch, many->locations,
                           many->error));
    }
    return FFD_OK;
}

/* Finds the leaves of the points of the packet, queues the points, and empties the packet. */
static ffd_status settle_packet(many_search *many)
{
    point_packet *const p = &many->packet;
    ffd_packet_find_leaves(p);
    for (int i = 0; i < p->count; i++) {
        packet_point *const point = &p->points[i];
        if (point->alone || !wait_in_leaves(many, point))
            TRY(find_alone(many->locator, many->p, point->index, many->scratch, many->locations,
                           many->error));
        else if (point->count == 0)
            ffd_search_judge(&point->search, &many->locations[point->index]);
    }
    p->count = 0;
    return FFD_OK;
}

static ffd_status find_leaves(many_search *many, size_t count)
{
    ffd_packet_begin(&many->packet, many->locator);
    for (uint32_t i = 0; i < count; i++) {
        const double *const p = many->p + 3 * (size_t)i;
        if (isnan(p[0]) || ffd_packet_add(&many->packet, p, i))
            continue;
        TRY(settle_packet(many));
        ffd_packet_add(&many->packet, p, i);
    }
    return settle_packet(many);
}

static ffd_status find_each(const ffd_locator *locator, const double *p, size_t count,
                            search_scratch **scratch, ffd_location *locations, ffd_error *error)
{
    for (uint32_t i = 0; i < count; i++)
        if (!isnan(p[3 * (size_t)i]))
            TRY(find_alone(locator, p, i, scratch, locations, error));
    return FFD_OK;
}

ffd_status ffd_cells_find_many(const ffd_locator *locator, const double *p, size_t count,
                               search_scratch **scratch, ffd_location *locations, ffd_error *error)
{
    many_search many = {
        .locator = locator, .p = p, .scratch = scratch, .locations = locations, .error = error};
    if (!ffd_search_scratch_make(scratch))
        return ffd_fail_memory(error);
    if (!has_lanes(locator->cells))
        return find_each(locator, p, count, scratch, locations, error);
    if (!(*scratch)->many)
        (*scratch)->many = ffd_alloc(1, sizeof *(*scratch)->many);
    if (!(*scratch)->many)
        return ffd_fail_memory(error);
    TRY(find_leaves(&many, count));
    TRY(find_waiting(locator, p, many.waiting, scratch, locations, error));
    return judge_shared(&many);
}
