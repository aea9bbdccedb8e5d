/* search_many.c - points of a general lattice, several at a time. A point that has one leaf only, as nearly
   all have, waits until others of its leaf are there; Newton's steps are then theirs together. Whatever is
   not settled so is searched for alone (search.c), and what is settled has the bits that it would get there.
 */
#include "base/memory.h"
#include "base/vec.h"
#include "embed/region_kernel.h"
#include "embed/search.h"
#include "spline/basis.h"
#include <stdlib.h>
#include <string.h>

typedef struct waiting_point {
    const cell_leaf *leaf;
    uint32_t number;
} waiting_point;

struct many_scratch {
    waiting_point waiting[CELLS_AT_ONCE];
    region_kernel_cell cell;
    double own[CELL_NUMBERS];
    region_lanes lanes;
};

/* The leaves of a point, as long as there is one at most. */
typedef struct leaf_search {
    point_search *search;
    uint32_t bricks; /* looked into */
    const cell_brick *brick;
    const cell_leaf *leaf;
} leaf_search;

/* False: the point needs a search of its own. */
static bool note_leaf(void *context, uint32_t number)
{
    leaf_search *found = context;
    const cell_leaf *leaf = &found->brick->leaves[number];
    if (!bounds_hold(&leaf->hull, found->search->x, found->search->slack) ||
        (!leaf->hard && !ffd_search_image_holds(found->search, leaf)))
        return true;
    if (leaf->hard || found->leaf)
        return false;
    found->leaf = leaf;
    return true;
}

static bool note_brick(void *context, uint32_t number)
{
    leaf_search *found = context;
    const cell_search *cells = found->search->locator->cells;
    if (!bounds_hold(&cells->brick_hulls[number], found->search->x, found->search->slack))
        return true;
    if (found->bricks++ >= SEARCH_BRICKS)
        return false;
    /* A brick that is not kept, or not made yet, may not outlast this point. */
    found->brick = atomic_load_explicit(&cells->made[number], memory_order_acquire);
    return found->brick &&
           ffd_box_tree_visit(&found->brick->tree, found->search->x, found->search->slack, note_leaf, found);
}

static int compare_waiting(const void *a, const void *b)
{
    const waiting_point *x = a, *y = b;
    if (x->leaf != y->leaf)
        return (uintptr_t)x->leaf < (uintptr_t)y->leaf ? -1 : 1;
    return (x->number > y->number) - (x->number < y->number);
}

/* Points come leaf by leaf most often: what is in order already is not sorted. */
static void sort_waiting(waiting_point *waiting, size_t count)
{
    for (size_t i = 1; i < count; i++)
        if (compare_waiting(&waiting[i - 1], &waiting[i]) > 0) {
            qsort(waiting, count, sizeof *waiting, compare_waiting);
            return;
        }
}

static void load_cell(const ffd_locator *locator, const cell_region *region, double *own,
                      region_kernel_cell *cell)
{
    cell->region = region;
    for (int a = 0; a < 3; a++) {
        cell->order[a] = locator->cells->order[a];
        cell->schemes[a] = ffd_cells_scheme(locator, a, region->span[a], &cell->own_schemes[a]);
    }
    ffd_cells_rows(locator, region->span, cell->rows, own);
}

static void load_point(const point_search *search, int lane, region_lanes *lanes)
{
    for (int a = 0; a < 3; a++) {
        lanes->x[a][lane] = search->x[a];
        lanes->tolerance[a][lane] = search->tolerance[a];
    }
}

static void take_result(const ffd_locator *locator, const cell_region *region, const double p[3],
                        const region_lanes *lanes, int lane, ffd_location *location)
{
    point_search search = {.locator = locator, .evaluations = lanes->evaluations[lane], .leaves = 1};
    ffd_search_place(&search, p);
    if (lanes->outcome[lane] == REGION_FOUND) {
        double t[3];
        sample at = {.weight = 1};
        for (int a = 0; a < 3; a++) {
            t[a] = lanes->t[a][lane];
            at.equation[a] = at.residual[a] = lanes->equation[a][lane];
        }
        for (int i = 0; i < 9; i++)
            at.jacobian[i] = lanes->jacobian[i][lane];
        ffd_search_record(&search, region, t, &at, false);
    }
    ffd_search_judge(&search, location);
}

static ffd_status find_alone(const ffd_locator *locator, const double *p, uint32_t number,
                             search_scratch **scratch, ffd_location *locations, ffd_error *error)
{
    return ffd_cells_find(locator, p + 3 * (size_t)number, scratch, &locations[number], error);
}

/* The points of one leaf. */
static ffd_status find_in_leaf(const ffd_locator *locator, const double *p, const waiting_point *waiting,
                               size_t count, search_scratch **scratch, ffd_location *locations,
                               ffd_error *error)
{
    const cell_region *const region = &waiting->leaf->region;
    const size_t width = (size_t)locator->cells->lanes;
    region_lanes *const lanes = &(*scratch)->many->lanes;
    ffd_status status = FFD_OK;
    load_cell(locator, region, (*scratch)->many->own, &(*scratch)->many->cell);
    for (size_t first = 0; first < count && !status; first += width) {
        const size_t filled = count - first < width ? count - first : width;
        for (size_t l = 0; l < width; l++) {
            point_search search = {.locator = locator};
            ffd_search_place(&search, p + 3 * (size_t)waiting[first + (l < filled ? l : filled - 1)].number);
            load_point(&search, (int)l, lanes);
        }
        locator->cells->region_kernel(&(*scratch)->many->cell, lanes);
        for (size_t l = 0; l < filled && !status; l++) {
            const uint32_t number = waiting[first + l].number;
            if (lanes->outcome[l] == REGION_UNCERTAIN)
                status = find_alone(locator, p, number, scratch, locations, error);
            else
                take_result(locator, region, p + 3 * (size_t)number, lanes, (int)l, &locations[number]);
        }
    }
    return status;
}

static ffd_status find_waiting(const ffd_locator *locator, const double *p, size_t count,
                               search_scratch **scratch, ffd_location *locations, ffd_error *error)
{
    ffd_status status = FFD_OK;
    if (count == 0)
        return FFD_OK;
    waiting_point *const waiting = (*scratch)->many->waiting;
    sort_waiting(waiting, count);
    for (size_t first = 0, last; first < count && !status; first = last) {
        for (last = first + 1; last < count && waiting[last].leaf == waiting[first].leaf;)
            last++;
        status = find_in_leaf(locator, p, waiting + first, last - first, scratch, locations, error);
    }
    return status;
}

/* Lanes need control points without weights; a collapse is looked at first, point by point. */
static bool has_lanes(const cell_search *cells)
{
    return cells->region_kernel && !cells->rational && cells->collapses.count == 0;
}

ffd_status ffd_cells_find_many(const ffd_locator *locator, const double *p, size_t count,
                               search_scratch **scratch, ffd_location *locations, ffd_error *error)
{
    const cell_search *const cells = locator->cells;
    ffd_status status = FFD_OK;
    size_t waiting = 0;
    if (!ffd_search_scratch_make(scratch))
        return ffd_fail_memory(error);
    if (has_lanes(cells) && !(*scratch)->many) {
        (*scratch)->many = ffd_alloc(1, sizeof *(*scratch)->many);
        if (!(*scratch)->many)
            return ffd_fail_memory(error);
    }
    for (uint32_t i = 0; i < count && !status; i++) {
        point_search search = {.locator = locator};
        leaf_search found = {.search = &search};
        if (isnan(p[3 * (size_t)i]) || !ffd_search_place(&search, p + 3 * (size_t)i))
            continue;
        if (!has_lanes(cells) ||
            !ffd_box_tree_visit(&cells->brick_tree, search.x, search.slack, note_brick, &found))
            status = find_alone(locator, p, i, scratch, locations, error);
        else if (found.leaf)
            (*scratch)->many->waiting[waiting++] = (waiting_point){found.leaf, i};
        else
            ffd_search_judge(&search, &locations[i]);
    }
    return status ? status : find_waiting(locator, p, waiting, scratch, locations, error);
}
