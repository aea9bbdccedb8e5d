#include "embed/cells/brick.h"
#include "base/memory/memory.h"
#include "embed/cells/cell_locator.h"
#include <string.h>

static void brick_cells(const cell_search *cells, uint32_t index, size_t first[3], size_t last[3])
{
    const size_t at[3] = {index % cells->bricks[0], index / cells->bricks[0] % cells->bricks[1],
                          index / cells->bricks[0] / cells->bricks[1]};
    for (int a = 0; a < 3; a++) {
        first[a] = at[a] * BRICK_SIDE;
        last[a] = first[a] + BRICK_SIDE - 1;
        if (last[a] >= cells->cells[a])
            last[a] = cells->cells[a] - 1;
    }
}

/* Returns the bounds of all control points that act in a brick. */
static bounds brick_hull(const ffd_locator *locator, uint32_t index)
{
    const cell_search *cells = locator->cells;
    size_t first[3], last[3], from[3], to[3], function[3];
    brick_cells(cells, index, first, last);
    for (int a = 0; a < 3; a++) {
        const knot_vector *knots = &locator->knots[a];
        from[a] = (size_t)(knots->spans[first[a]] - knots->degree);
        to[a] = (size_t)knots->spans[last[a]];
    }
    bounds hull = {{DBL_MAX, DBL_MAX, DBL_MAX}, {-DBL_MAX, -DBL_MAX, -DBL_MAX}};
    for (function[2] = from[2]; function[2] <= to[2]; function[2]++)
        for (function[1] = from[1]; function[1] <= to[1]; function[1]++)
            for (function[0] = from[0]; function[0] <= to[0]; function[0]++) {
                const double *c = ffd_cells_point(locator, function);
                const double point[3] = {c[0] / c[3], c[1] / c[3], c[2] / c[3]};
                bounds_add(&hull, point);
            }
    return hull;
}

ffd_status ffd_bricks_create(const ffd_locator *locator, ffd_error *error)
{
    cell_search *cells = locator->cells;
    size_t count = 1;
    for (int a = 0; a < 3; a++) {
        cells->bricks[a] = (cells->cells[a] + BRICK_SIDE - 1) / BRICK_SIDE;
        count *= cells->bricks[a]; /* at most the number of control points, which is below 2^31 */
    }
    cells->made = ffd_alloc(count, sizeof *cells->made);
    if (!cells->made)
        return ffd_fail_memory(error);
    for (size_t i = 0; i < count; i++)
        atomic_init(&cells->made[i], NULL);
    cells->brick_hulls = ffd_alloc(count, sizeof *cells->brick_hulls);
    if (!cells->brick_hulls)
        return ffd_fail_memory(error);
    for (size_t i = 0; i < count; i++)
        cells->brick_hulls[i] = brick_hull(locator, (uint32_t)i);
    return ffd_box_tree_build(cells->brick_hulls, count, &cells->brick_tree) ? FFD_OK
                                                                             : ffd_fail_memory(error);
}

static void brick_free(cell_brick *brick)
{
    if (!brick)
        return;
    ffd_box_tree_free(&brick->tree);
    ffd_free(brick->leaves);
    ffd_free(brick);
}

/* State while a cell is divided into leaves. */
typedef struct cell_cutter {
    const ffd_locator *locator;
    cell_brick *brick;
    size_t capacity;
    int span[3];
    int budget;
    double *slots;   /* coefficients of each depth */
    double *columns; /* scratch memory of the contraction bound */
} cell_cutter;

static bool add_leaf(cell_cutter *cutter, const bezier_box *box, const bounds *hull,
                     const contraction_bound *found, bool hard)
{
    cell_brick *brick = cutter->brick;
    if (!ffd_grow((void **)&brick->leaves, &cutter->capacity, brick->leaf_count + 1, sizeof *brick->leaves))
        return false;
    cell_leaf *leaf = &brick->leaves[brick->leaf_count++];
    memset(leaf, 0, sizeof *leaf);
    leaf->hull = *hull;
    leaf->hard = hard;
    for (int a = 0; a < 3; a++) {
        leaf->region.span[a] = cutter->span[a];
        leaf->part.lo[a] = box->lo[a];
        leaf->part.hi[a] = box->hi[a];
    }
    if (!hard) {
        static const double zero[3] = {0, 0, 0};
        ffd_cell_region(cutter->locator, cutter->span, box, found, &leaf->region);
        ffd_cells_centre(cutter->locator, &leaf->region);
        leaf->image = ffd_bezier_image(box, found->inverse, zero);
    }
    return true;
}

static bool cut(cell_cutter *cutter, bezier_box *box, int depth)
{
    const contraction_kernel *const kernel = cutter->locator->cells->contraction;
    const bounds hull = ffd_bezier_hull(box);
    double middle[3], reach[3];
    for (int a = 0; a < 3; a++) {
        middle[a] = 0.5 * hull.lo[a] + 0.5 * hull.hi[a];
        reach[a] = hull.hi[a] - middle[a];
    }
    contraction_bound found;
    cutter->budget--;
    kernel->find_bound(box, middle, reach, cutter->columns, &found);
    if (found.regular && found.bound <= LEAF_BOUND)
        return add_leaf(cutter, box, &hull, &found, false);
    if (depth == LEAF_DEPTH || cutter->budget <= 0)
        return add_leaf(cutter, box, &hull, &found, true);
    bezier_box lower = {.coefficients = cutter->slots + (size_t)(depth + 1) * ffd_bezier_size(box->order)};
    bezier_box upper = {.coefficients = box->coefficients};
    ffd_bezier_halve(box, kernel->find_halving(box, &found, cutter->columns), &lower, &upper);
    return cut(cutter, &lower, depth + 1) && cut(cutter, &upper, depth + 1);
}

static bool cut_brick(const ffd_locator *locator, uint32_t index, cell_brick *brick)
{
    const cell_search *cells = locator->cells;
    cell_cutter cutter = {.locator = locator, .brick = brick};
    size_t first[3], last[3], cell[3];
    bool done = false;
    cutter.slots = ffd_alloc(LEAF_DEPTH + 2, ffd_bezier_size(cells->order) * sizeof(double));
    cutter.columns = ffd_alloc(3 * ffd_bezier_size(cells->order), sizeof(double));
    if (!cutter.slots || !cutter.columns)
        goto end;
    brick_cells(cells, index, first, last);
    for (cell[2] = first[2]; cell[2] <= last[2]; cell[2]++)
        for (cell[1] = first[1]; cell[1] <= last[1]; cell[1]++)
            for (cell[0] = first[0]; cell[0] <= last[0]; cell[0]++) {
                bezier_box box = {.coefficients = cutter.slots};
                ffd_cell_bezier(locator, cell, &box);
                ffd_cell_spans(locator->lattice, cell, cutter.span);
                cutter.budget = LEAF_BUDGET;
                if (!cut(&cutter, &box, 0))
                    goto end;
            }
    done = true;
end:
    ffd_free(cutter.slots);
    ffd_free(cutter.columns);
    return done;
}

static bool index_leaves(cell_brick *brick)
{
    bounds *hulls = ffd_alloc(brick->leaf_count, sizeof *hulls);
    if (!hulls)
        return false;
    for (size_t i = 0; i < brick->leaf_count; i++)
        hulls[i] = brick->leaves[i].hull;
    const bool done = ffd_box_tree_build(hulls, brick->leaf_count, &brick->tree);
    ffd_free(hulls);
    return done;
}

/* Limits */

/* Scales a limit for leaves of cubic lattices to these degrees: the time for a leaf is in proportion to its
   control points. */
static size_t limit_of(const cell_search *cells, size_t cubic)
{
    const size_t points = ffd_bezier_count(cells->order);
    return points <= 64 ? cubic : cubic * 64 / points;
}

/* Publishes a brick, unless another thread has published the same brick first. Returns whether this one was
   published. */
static bool keep(cell_search *cells, uint32_t index, cell_brick *mine, const cell_brick **kept)
{
    cell_brick *there = NULL;
    if (atomic_compare_exchange_strong(&cells->made[index], &there, mine)) {
        *kept = mine;
        return true;
    }
    brick_free(mine);
    *kept = there;
    return false;
}

/* The bricks that a mesh needs do not depend on the order of its vertices, so neither does this check. */
static ffd_status check_heavy(cell_search *cells, ffd_error *error)
{
    const size_t most = limit_of(cells, MOST_HEAVY_LEAVES);
    if (atomic_load(&cells->heavy_leaves) > most)
        return ffd_fail(
            error, FFD_E_LIMIT,
            "the rest lattice folds in too many of its cells: finding u,v,w takes more than %zu parts "
            "of cells",
            most);
    return FFD_OK;
}

bool ffd_cells_are_strained(const struct cell_search *cells)
{
    return atomic_load(&cells->heavy_leaves) > 0;
}

static void keep_light(cell_search *cells, uint32_t index, cell_brick *mine, own_bricks *own,
                       const cell_brick **kept)
{
    const size_t leaves = mine->leaf_count;
    const bool fits = atomic_fetch_add(&cells->light_leaves, leaves) + leaves <= MOST_LIGHT_LEAVES;
    if (!fits || !keep(cells, index, mine, kept))
        atomic_fetch_sub(&cells->light_leaves, leaves);
    if (fits)
        return;
    const size_t slot = index % OWN_BRICKS;
    brick_free(own->brick[slot]);
    own->brick[slot] = mine;
    own->index[slot] = index;
    *kept = mine;
}

ffd_status ffd_cells_brick(const ffd_locator *locator, uint32_t index, own_bricks *own,
                           const cell_brick **brick, ffd_error *error)
{
    cell_search *cells = locator->cells;
    const size_t slot = index % OWN_BRICKS;
    *brick = atomic_load_explicit(&cells->made[index], memory_order_acquire);
    if (!*brick && own->brick[slot] && own->index[slot] == index)
        *brick = own->brick[slot];
    if (*brick)
        return FFD_OK;
    TRY(check_heavy(cells, error)); /* once the limit is exceeded, no more are made */
    cell_brick *mine = ffd_alloc_zero(1, sizeof *mine);
    if (!mine || !cut_brick(locator, index, mine) || !index_leaves(mine)) {
        brick_free(mine);
        return ffd_fail_memory(error);
    }
    const size_t leaves = mine->leaf_count;
    if (leaves <= LIGHT_LEAVES) {
        keep_light(cells, index, mine, own, brick);
        return FFD_OK;
    }
    if (keep(cells, index, mine, brick))
        atomic_fetch_add(&cells->heavy_leaves, leaves);
    return check_heavy(cells, error);
}

void ffd_own_bricks_free(own_bricks *own)
{
    for (int i = 0; i < OWN_BRICKS; i++)
        brick_free(own->brick[i]);
}

void ffd_bricks_free(cell_search *cells)
{
    const size_t count = cells->bricks[0] * cells->bricks[1] * cells->bricks[2];
    for (size_t i = 0; cells->made && i < count; i++)
        brick_free(atomic_load(&cells->made[i]));
    ffd_free(cells->made);
    ffd_free(cells->brick_hulls);
    ffd_box_tree_free(&cells->brick_tree);
}
