#include "embed/cells.h"
#include "base/memory.h"
#include "base/vec.h"
#include "spline/basis.h"
#include <string.h>

enum { N = BEZIER_COMPONENTS };

/* Cells whose volume is looked at before any search; of larger lattices every n-th. */
#define SAMPLED_CELLS 32768

static ffd_status make_points(ffd_locator *locator, cell_search *cells, ffd_error *error)
{
    const ffd_lattice *lattice = locator->lattice;
    cells->points = ffd_alloc(lattice->count, N * sizeof(double));
    if (!cells->points)
        return ffd_fail_memory(error);
    for (size_t i = 0; i < lattice->count; i++) {
        const double h = cells->rational ? lattice->rest_weights[i] : 1;
        for (int a = 0; a < 3; a++)
            cells->points[N * i + (size_t)a] = h * (lattice->rest[3 * i + (size_t)a] - locator->origin[a]);
        cells->points[N * i + 3] = h;
    }
    return FFD_OK;
}

static ffd_status make_extractions(const ffd_locator *locator, cell_search *cells, ffd_error *error)
{
    for (int a = 0; a < 3; a++) {
        const knot_vector *knots = &locator->knots[a];
        const size_t size = (size_t)cells->order[a] * (size_t)cells->order[a];
        cells->extraction[a] = ffd_alloc(knots->span_count, size * sizeof(double));
        if (!cells->extraction[a])
            return ffd_fail_memory(error);
        for (size_t s = 0; s < knots->span_count; s++) {
            double matrix[MAX_ORDER * MAX_ORDER];
            ffd_bezier_extraction(knots, knots->spans[s], matrix);
            memcpy(cells->extraction[a] + s * size, matrix, size * sizeof(double));
        }
    }
    return FFD_OK;
}

static const double *control_point(const ffd_locator *locator, const size_t function[3])
{
    const ffd_lattice *lattice = locator->lattice;
    const size_t i = ffd_knots_point(&lattice->knots[0], function[0]);
    const size_t j = ffd_knots_point(&lattice->knots[1], function[1]);
    const size_t k = ffd_knots_point(&lattice->knots[2], function[2]);
    return locator->cells->points + N * (i + lattice->size[0] * (j + lattice->size[1] * k));
}

static void cell_spans(const ffd_lattice *lattice, const size_t cell[3], int span[3])
{
    for (int a = 0; a < 3; a++)
        span[a] = lattice->knots[a].spans[cell[a]];
}

void ffd_cell_bezier(const ffd_locator *locator, const size_t cell[3], bezier_box *box)
{
    const cell_search *cells = locator->cells;
    int span[3];
    cell_spans(locator->lattice, cell, span);
    double *to = box->coefficients;
    size_t function[3];
    for (int k = 0; k < cells->order[2]; k++)
        for (int j = 0; j < cells->order[1]; j++)
            for (int i = 0; i < cells->order[0]; i++, to += N) {
                function[0] = (size_t)(span[0] - cells->order[0] + 1 + i);
                function[1] = (size_t)(span[1] - cells->order[1] + 1 + j);
                function[2] = (size_t)(span[2] - cells->order[2] + 1 + k);
                memcpy(to, control_point(locator, function), N * sizeof(double));
            }
    const double *matrix[3];
    for (int a = 0; a < 3; a++) {
        box->order[a] = cells->order[a];
        matrix[a] = cells->extraction[a] + cell[a] * (size_t)cells->order[a] * (size_t)cells->order[a];
    }
    box->rational = cells->rational;
    ffd_bezier_extract(box, matrix);
}

void ffd_cell_region(const ffd_locator *locator, const int span[3], const bezier_box *box,
                     const contraction_bound *contraction, cell_region *result)
{
    double least;
    for (int a = 0; a < 3; a++) {
        const double *t = locator->knots[a].t;
        const double start = t[span[a]], side = t[span[a] + 1] - start;
        result->span[a] = span[a];
        result->lo[a] = start + box->lo[a] * side;
        result->width[a] = (box->hi[a] - box->lo[a]) * side;
    }
    memcpy(result->inverse, contraction->inverse, sizeof result->inverse);
    result->bound = contraction->bound;
    ffd_bezier_weights(box, &least, &result->greatest_weight);
    result->weight_ratio = result->greatest_weight / least;
}

void ffd_cells_evaluate(const ffd_locator *locator, const int span[3], const double uvw[3],
                        homogeneous *result)
{
    const cell_search *cells = locator->cells;
    double value[3][MAX_ORDER], slope[3][MAX_ORDER];
    for (int a = 0; a < 3; a++)
        ffd_basis_derivatives(&locator->knots[a], span[a], uvw[a], value[a], slope[a]);
    memset(result, 0, sizeof *result);
    size_t function[3];
    for (int k = 0; k < cells->order[2]; k++) {
        double plane[N] = {0}, plane_u[N] = {0}, plane_v[N] = {0};
        function[2] = (size_t)(span[2] - cells->order[2] + 1 + k);
        for (int j = 0; j < cells->order[1]; j++) {
            double line[N] = {0}, line_u[N] = {0};
            function[1] = (size_t)(span[1] - cells->order[1] + 1 + j);
            for (int i = 0; i < cells->order[0]; i++) {
                function[0] = (size_t)(span[0] - cells->order[0] + 1 + i);
                const double *point = control_point(locator, function);
                for (int c = 0; c < N; c++) {
                    line[c] += value[0][i] * point[c];
                    line_u[c] += slope[0][i] * point[c];
                }
            }
            for (int c = 0; c < N; c++) {
                plane[c] += value[1][j] * line[c];
                plane_u[c] += value[1][j] * line_u[c];
                plane_v[c] += slope[1][j] * line[c];
            }
        }
        for (int c = 0; c < N; c++) {
            result->value[c] += value[2][k] * plane[c];
            result->derivative[0][c] += value[2][k] * plane_u[c];
            result->derivative[1][c] += value[2][k] * plane_v[c];
            result->derivative[2][c] += slope[2][k] * plane[c];
        }
    }
    if (!cells->rational) {
        result->value[3] = 1;
        for (int a = 0; a < 3; a++)
            result->derivative[a][3] = 0;
    }
}

/* Bricks */

static void brick_cells(const cell_search *cells, uint32_t number, size_t first[3], size_t last[3])
{
    const size_t at[3] = {number % cells->bricks[0], number / cells->bricks[0] % cells->bricks[1],
                          number / cells->bricks[0] / cells->bricks[1]};
    for (int a = 0; a < 3; a++) {
        first[a] = at[a] * BRICK_SIDE;
        last[a] = first[a] + BRICK_SIDE - 1;
        if (last[a] >= cells->cells[a])
            last[a] = cells->cells[a] - 1;
    }
}

/* Bounds of all control points that act in the brick. */
static bounds brick_hull(const ffd_locator *locator, uint32_t number)
{
    const cell_search *cells = locator->cells;
    size_t first[3], last[3], from[3], to[3], function[3];
    brick_cells(cells, number, first, last);
    for (int a = 0; a < 3; a++) {
        const knot_vector *knots = &locator->knots[a];
        from[a] = (size_t)(knots->spans[first[a]] - knots->degree);
        to[a] = (size_t)knots->spans[last[a]];
    }
    bounds hull = {{DBL_MAX, DBL_MAX, DBL_MAX}, {-DBL_MAX, -DBL_MAX, -DBL_MAX}};
    for (function[2] = from[2]; function[2] <= to[2]; function[2]++)
        for (function[1] = from[1]; function[1] <= to[1]; function[1]++)
            for (function[0] = from[0]; function[0] <= to[0]; function[0]++) {
                const double *c = control_point(locator, function);
                const double point[3] = {c[0] / c[3], c[1] / c[3], c[2] / c[3]};
                bounds_add(&hull, point);
            }
    return hull;
}

static ffd_status make_bricks(ffd_locator *locator, cell_search *cells, ffd_error *error)
{
    size_t count = 1;
    for (int a = 0; a < 3; a++) {
        cells->bricks[a] = (cells->cells[a] + BRICK_SIDE - 1) / BRICK_SIDE;
        count *= cells->bricks[a]; /* no more than the control points, of which there are fewer than 2^31 */
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

/* The cutting of one cell. */
typedef struct cell_cutter {
    const ffd_locator *locator;
    cell_brick *brick;
    size_t capacity;
    int span[3];
    int budget;
    double *slots;   /* coefficients for each depth */
    double *scratch; /* of the contraction_bound */
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
        leaf->part_lo[a] = box->lo[a];
        leaf->part_hi[a] = box->hi[a];
    }
    if (!hard) {
        static const double zero[3] = {0, 0, 0};
        ffd_cell_region(cutter->locator, cutter->span, box, found, &leaf->region);
        leaf->image = ffd_bezier_image(box, found->inverse, zero);
    }
    return true;
}

static bool cut(cell_cutter *cutter, bezier_box *box, int depth)
{
    const bounds hull = ffd_bezier_hull(box);
    double middle[3], reach[3];
    for (int a = 0; a < 3; a++) {
        middle[a] = 0.5 * hull.lo[a] + 0.5 * hull.hi[a];
        reach[a] = hull.hi[a] - middle[a];
    }
    contraction_bound found;
    cutter->budget--;
    ffd_bezier_contraction(box, middle, reach, cutter->scratch, &found);
    if (found.regular && found.bound <= LEAF_BOUND)
        return add_leaf(cutter, box, &hull, &found, false);
    if (depth == LEAF_DEPTH || cutter->budget <= 0)
        return add_leaf(cutter, box, &hull, &found, true);
    bezier_box lower = {.coefficients = cutter->slots + (size_t)(depth + 1) * ffd_bezier_size(box->order)};
    bezier_box upper = {.coefficients = box->coefficients};
    ffd_bezier_halve(box, found.halve, &lower, &upper);
    return cut(cutter, &lower, depth + 1) && cut(cutter, &upper, depth + 1);
}

static bool cut_brick(const ffd_locator *locator, uint32_t number, cell_brick *brick)
{
    const cell_search *cells = locator->cells;
    cell_cutter cutter = {.locator = locator, .brick = brick};
    size_t first[3], last[3], cell[3];
    bool done = false;
    cutter.slots = ffd_alloc(LEAF_DEPTH + 2, ffd_bezier_size(cells->order) * sizeof(double));
    cutter.scratch = ffd_alloc(3 * ffd_bezier_count(cells->order), sizeof(double));
    if (!cutter.slots || !cutter.scratch)
        goto out;
    brick_cells(cells, number, first, last);
    for (cell[2] = first[2]; cell[2] <= last[2]; cell[2]++)
        for (cell[1] = first[1]; cell[1] <= last[1]; cell[1]++)
            for (cell[0] = first[0]; cell[0] <= last[0]; cell[0]++) {
                bezier_box box = {.coefficients = cutter.slots};
                ffd_cell_bezier(locator, cell, &box);
                cell_spans(locator->lattice, cell, cutter.span);
                cutter.budget = LEAF_BUDGET;
                if (!cut(&cutter, &box, 0))
                    goto out;
            }
    done = true;
out:
    ffd_free(cutter.slots);
    ffd_free(cutter.scratch);
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

ffd_status ffd_cells_brick(const ffd_locator *locator, uint32_t number, const cell_brick **result,
                           ffd_error *error)
{
    cell_search *cells = locator->cells;
    cell_brick *there = atomic_load_explicit(&cells->made[number], memory_order_acquire);
    if (!there) {
        cell_brick *mine = ffd_alloc_zero(1, sizeof *mine);
        if (!mine || !cut_brick(locator, number, mine) || !index_leaves(mine)) {
            brick_free(mine);
            return ffd_fail_memory(error);
        }
        /* Another thread may have been faster: its brick is the same. */
        if (atomic_compare_exchange_strong(&cells->made[number], &there, mine))
            there = mine;
        else
            brick_free(mine);
    }
    *result = there;
    return FFD_OK;
}

/* Signed volume */

/* det [C_u C_v C_w] at t of a cell's [0,1]^3; *flat: it is no more than the rounding of its columns can make,
   which are sums of control points times slopes of about degree / side. */
static double determinant_in(const ffd_locator *locator, const int span[3], const double t[3], bool *flat)
{
    homogeneous at;
    double uvw[3], column[3][3], cross[3], length[3], noise[3];
    for (int a = 0; a < 3; a++) {
        const double *knot = locator->knots[a].t + span[a];
        uvw[a] = knot[0] + t[a] * (knot[1] - knot[0]);
        noise[a] =
            16 * DBL_EPSILON * vec_length(locator->extent) * locator->knots[a].degree / (knot[1] - knot[0]);
    }
    ffd_cells_evaluate(locator, span, uvw, &at);
    for (int a = 0; a < 3; a++) {
        for (int r = 0; r < 3; r++)
            column[a][r] =
                (at.derivative[a][r] - at.value[r] / at.value[3] * at.derivative[a][3]) / at.value[3];
        length[a] = vec_length(column[a]);
    }
    vec_cross(column[1], column[2], cross);
    const double det = vec_dot(column[0], cross);
    *flat = !(fabs(det) > noise[0] * length[1] * length[2] + noise[1] * length[0] * length[2] +
                              noise[2] * length[0] * length[1]);
    return det;
}

/* The part of the signed volume that a cell has, by one-point quadrature; *flat: it has none at any of 9
 * places. */
static double cell_volume(const ffd_locator *locator, const size_t cell[3], bool *flat)
{
    static const double places[9][3] = {{0.5, 0.5, 0.5},    {0.25, 0.25, 0.25}, {0.75, 0.25, 0.25},
                                        {0.25, 0.75, 0.25}, {0.75, 0.75, 0.25}, {0.25, 0.25, 0.75},
                                        {0.75, 0.25, 0.75}, {0.25, 0.75, 0.75}, {0.75, 0.75, 0.75}};
    int span[3];
    double side = 1;
    cell_spans(locator->lattice, cell, span);
    for (int a = 0; a < 3; a++) {
        const double *knot = locator->knots[a].t + span[a];
        side *= knot[1] - knot[0];
    }
    const double volume = determinant_in(locator, span, places[0], flat) * side;
    for (int i = 1; i < 9 && *flat; i++)
        determinant_in(locator, span, places[i], flat);
    return volume;
}

static ffd_status look_at_volume(ffd_locator *locator, cell_search *cells, ffd_error *error)
{
    const size_t count = cells->cells[0] * cells->cells[1] * cells->cells[2];
    const size_t step = count / SAMPLED_CELLS + 1;
    double volume = 0;
    for (size_t n = 0; n < count; n += step) {
        const size_t cell[3] = {n % cells->cells[0], n / cells->cells[0] % cells->cells[1],
                                n / cells->cells[0] / cells->cells[1]};
        bool flat;
        volume += cell_volume(locator, cell, &flat);
        if (flat)
            return ffd_fail(
                error, FFD_E_INVALID,
                "the rest lattice has no volume in cell (%zu, %zu, %zu): its control points lie in a plane "
                "or on a line",
                cell[0], cell[1], cell[2]);
    }
    cells->volume_sign = volume < 0 ? -1 : 1;
    return FFD_OK;
}

ffd_status ffd_cells_create(ffd_locator *locator, ffd_error *error)
{
    const ffd_lattice *lattice = locator->lattice;
    cell_search *cells = ffd_alloc_zero(1, sizeof *cells);
    if (!cells)
        return ffd_fail_memory(error);
    locator->cells = cells;
    cells->rational = lattice->rest_weights != NULL;
    for (int a = 0; a < 3; a++) {
        cells->order[a] = lattice->knots[a].degree + 1;
        cells->cells[a] = lattice->knots[a].span_count;
    }
    ffd_status status = make_points(locator, cells, error);
    if (!status)
        status = make_extractions(locator, cells, error);
    if (!status)
        status = look_at_volume(locator, cells, error);
    if (!status)
        status = make_bricks(locator, cells, error);
    return status; /* the locator's destroy frees what there is */
}

void ffd_cells_destroy(cell_search **cells_pointer)
{
    cell_search *cells = *cells_pointer;
    if (!cells)
        return;
    const size_t count = cells->bricks[0] * cells->bricks[1] * cells->bricks[2];
    for (size_t i = 0; cells->made && i < count; i++)
        brick_free(atomic_load(&cells->made[i]));
    ffd_free(cells->made);
    ffd_free(cells->brick_hulls);
    ffd_box_tree_free(&cells->brick_tree);
    for (int a = 0; a < 3; a++)
        ffd_free(cells->extraction[a]);
    ffd_free(cells->points);
    ffd_free(cells);
    *cells_pointer = NULL;
}
