#include "points/variant_block.h"
#include "base/memory/memory.h"
#include "deform/common_shift.h"
#include "points/span.h"
#include <math.h>
#include <stdint.h>
#include <string.h>

/* With at most this many points of a cell, a lane for each would leave most of a register empty. */
#define FEW_IN_CELL 2

/* Returns the number of control points of a cell. */
static size_t cell_size(const ffd_lattice *lattice)
{
    size_t size = 1;
    for (int a = 0; a < 3; a++)
        size *= (size_t)lattice->knots[a].degree + 1;
    return size;
}

double ffd_block_scratch_size(const block_work *work)
{
    return 3.0 * (double)work->variants->rest->count * (double)work->kernel->lanes * sizeof(double);
}

bool ffd_block_scratch_make(const block_work *work, bool lanes, block_scratch *scratch)
{
    const size_t width = lanes ? work->kernel->lanes : 1, cell = 3 * cell_size(work->variants->rest);
    const size_t field = lanes ? 3 * work->variants->rest->count * width : 0,
                 planes = lanes ? cell * width : 0;
    const size_t points = VARIANT_POINTS;
    const size_t numbers = field + 2 * planes + 3 * points * width + 4 * points + 2 * (cell + 1);
    *scratch = (block_scratch){.planes = {.column = SIZE_MAX}};
    double *next = ffd_alloc(numbers * sizeof(double) + points * (sizeof(uint32_t) + 1), 1);
    scratch->room = next;
    if (!next)
        return false;
    scratch->field = next;
    scratch->planes.vectors = scratch->field + field;
    scratch->planes.bezier = scratch->planes.vectors + planes;
    scratch->vectors = scratch->planes.bezier + planes;
    scratch->x = scratch->vectors + 3 * points * width;
    scratch->weight = scratch->x + 3 * points;
    scratch->numbers = scratch->weight + points;
    scratch->bezier = scratch->numbers + cell + 1;
    scratch->order = (uint32_t *)(void *)(scratch->bezier + cell + 1);
    scratch->changed = (uint8_t *)(scratch->order + points);
    for (size_t i = 0; i < points; i++)
        scratch->order[i] = (uint32_t)i;
    return true;
}

void ffd_block_scratch_free(block_scratch *scratch)
{
    ffd_free(scratch->room);
}

bool ffd_block_take(const block_work *work, const block_part *part, block_scratch *scratch)
{
    const variant_set *const all = work->variants;
    const double *from[16];
    if (scratch->packed == part->variant + 1)
        return scratch->fits;
    scratch->packed = part->variant + 1;
    scratch->planes.column = SIZE_MAX;
    if (all->is_large)
        scratch->fits = false;
    else if (part->is_single)
        scratch->fits =
            work->kernel->fits(ffd_variant_values(all, part->variant), 3 * all->rest->count, VARIANT_MOST);
    else {
        for (size_t l = 0; l < work->kernel->lanes; l++) /* lanes to spare have the first variant */
            from[l] = ffd_variant_values(all, part->variant + (l < part->count ? l : 0));
        scratch->fits =
            work->kernel->pack(from, work->origin, 3 * all->rest->count, VARIANT_MOST, scratch->field);
    }
    return scratch->fits;
}

/* Some of the points of a cell. */
typedef struct cell_points {
    const point_cell *cell;
    int span[3];
    size_t first, count; /* among the sorted points */
} cell_points;

/* Writes a point of a variant. */
static inline void write_point(const block_work *work, size_t variant, size_t point, const double x[3])
{
    const size_t at = work->in.count * variant + point;
    if (work->out_doubles)
        memcpy(work->out_doubles + 3 * at, x, 3 * sizeof *x);
    else if (work->out_floats)
        for (size_t c = 0; c < 3; c++)
            work->out_floats[3 * at + c] = (float)x[c];
    else
        ffd_span_write(&work->out, at, 1, x);
}

/* Reads the points, and their weights. */
static void read_points(const block_work *work, const cell_points *points, block_scratch *s)
{
    const uint32_t *const which = work->cells->which + points->first;
    const double *const weights = work->variants->of.weights;
    for (size_t i = 0; i < points->count; i++)
        if (work->in_doubles)
            memcpy(s->x + 3 * i, work->in_doubles + 3 * (size_t)which[i], 3 * sizeof *s->x);
        else
            ffd_span_read(&work->in, which[i], 1, s->x + 3 * i);
    for (size_t i = 0; i < points->count && weights; i++)
        s->weight[i] = weights[which[i]];
}

static shift_points shift_of(const block_work *work, const cell_points *points, double *delta, size_t step)
{
    return (shift_points){.lattice = work->variants->rest,
                          .span = {points->span[0], points->span[1], points->span[2]},
                          .uvw = work->cells->uvw + 3 * points->first,
                          .count = points->count,
                          .has_knots = points->cell->has_knots,
                          .delta = delta,
                          .step = step};
}

/* -- a block of variants */

static variant_cell begin_cell(const block_work *work, const point_cell *cell, const int span[3],
                               const block_scratch *s)
{
    const ffd_lattice *const rest = work->variants->rest;
    variant_cell made = {.field = s->field,
                         .column = cell->index[0] * rest->knots[1].span_count + cell->index[1],
                         .first_plane = (size_t)(span[2] - rest->knots[2].degree)};
    for (int a = 0; a < 3; a++) {
        const knot_vector *const knots = &rest->knots[a];
        const size_t order = (size_t)knots->degree + 1;
        made.degree[a] = knots->degree;
        made.extraction[a] = knots->extractions + cell->index[a] * order * order;
        made.first[a] = knots->t[span[a]];
        made.width[a] = knots->t[span[a] + 1] - knots->t[span[a]];
        made.at[a] = work->variants->at[a] + cell->index[a] * order;
    }
    return made;
}

/* Whether the control points of a cell may have one displacement in a lane. */
static bool may_shift(const block_work *work, const variant_cell *cell, size_t lane)
{
    const size_t lanes = work->kernel->lanes, first = cell->at[0][0] + cell->at[1][0] + cell->at[2][0];
    const size_t next = first - cell->at[0][0] + cell->at[0][1];
    const double *const a = cell->field + lanes * first + lane, *const b = cell->field + lanes * next + lane;
    return a[0] == b[0] && a[lanes] == b[lanes] && a[2 * lanes] == b[2 * lanes];
}

/* Shifts the points in the lanes in which they may have a common displacement. */
static void shift_lanes(const block_work *work, const variant_cell *cell, const cell_points *points,
                        const block_part *part, block_scratch *s)
{
    for (size_t l = 0; l < part->count; l++) {
        if (!points->cell->has_knots && !may_shift(work, cell, l))
            continue;
        const shift_points shifts = shift_of(work, points, s->vectors + l, work->kernel->lanes);
        ffd_variant_cell(work->variants, part->variant + l, points->cell->index, s->numbers);
        ffd_shift_points(&shifts, s->numbers);
    }
}

/* Writes the moved points of all lanes. */
static void write_lanes(const block_work *work, const cell_points *points, const block_part *part,
                        const block_scratch *s)
{
    const size_t lanes = work->kernel->lanes;
    const uint32_t *const which = work->cells->which + points->first;
    for (size_t i = 0; i < points->count; i++)
        for (size_t l = 0; l < part->count; l++) {
            const double *const v = s->vectors + 3 * lanes * i + l;
            const double x[3] = {v[0], v[lanes], v[2 * lanes]};
            write_point(work, part->variant + l, which[i], x);
        }
}

static bool deform_lanes(const block_work *work, const variant_cell *cell, const cell_points *points,
                         const block_part *part, block_scratch *s)
{
    const double *const fade = work->cells->fade;
    const variant_moves moves = {.x = s->x,
                                 .fade = fade ? fade + points->first : NULL,
                                 .weight = work->variants->of.weights ? s->weight : NULL,
                                 .count = points->count,
                                 .largest = work->largest,
                                 .vectors = s->vectors};
    const double *const uvw = work->cells->uvw + 3 * points->first;
    if (points->cell->count == 1)
        work->kernel->displace_one(cell, &s->planes, uvw, s->vectors);
    else
        work->kernel->displace(cell, s->planes.bezier, uvw, points->count, s->vectors);
    shift_lanes(work, cell, points, part, s);
    read_points(work, points, s);
    if (!work->kernel->move(&moves))
        return false;
    write_lanes(work, points, part, s);
    return true;
}

/* -- a single variant */

/* Whether two neighbours in a cell may have the same displacement. */
static bool may_share(const variant_source *source)
{
    const size_t place = source->at[0][0] + source->at[1][0] + source->at[2][0];
    const size_t next = place - source->at[0][0] + source->at[0][1];
    const double *const a = source->values + place, *const b = source->values + next;
    if (!source->rest)
        return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
    const size_t origin = source->rest_at[0][0] + source->rest_at[1][0] + source->rest_at[2][0];
    const double *const p = source->rest + origin, *const q =
                                                       p - source->rest_at[0][0] + source->rest_at[0][1];
    return a[0] - p[0] == b[0] - q[0] && a[1] - p[1] == b[1] - q[1] && a[2] - p[2] == b[2] - q[2];
}

/* Finds the Bezier points of a cell. Returns whether its points may have a common displacement, which the
   control points in s->numbers then tell. */
static bool extract_single(const block_work *work, const point_cell *of, size_t variant, block_scratch *s,
                           kernel_cell *cell)
{
    const ffd_lattice *const rest = work->variants->rest;
    variant_source source;
    const bool is_cubic = ffd_variant_source(work->variants, variant, of->index, &source);
    const bool may_shift = !is_cubic || of->has_knots || may_share(&source);
    if (may_shift)
        ffd_variant_cell(work->variants, variant, of->index, s->numbers);
    if (is_cubic)
        work->kernel->extract_cubic(&source, s->bezier);
    else {
        const double *extraction[3];
        int degree[3];
        for (int a = 0; a < 3; a++) {
            const size_t order = (size_t)rest->knots[a].degree + 1;
            degree[a] = rest->knots[a].degree;
            extraction[a] = rest->knots[a].extractions + of->index[a] * order * order;
        }
        memcpy(s->bezier, s->numbers, 3 * cell_size(rest) * sizeof *s->bezier);
        s->bezier[3 * cell_size(rest)] = 0;
        work->single->extract(degree, extraction, s->bezier, NULL);
    }
    ffd_displacement_cell_begin(rest, of->index, CELL_VALUES, s->bezier, cell);
    return may_shift;
}

/* Multiplies the displacements with their factors. */
static void apply_factors(const block_work *work, const cell_points *points, block_scratch *s)
{
    const double *const fade = work->cells->fade ? work->cells->fade + points->first : NULL;
    for (size_t i = 0; i < 3 * points->count && fade; i++)
        s->vectors[i] = fade[i / 3] * s->vectors[i];
    for (size_t i = 0; i < 3 * points->count && work->variants->of.weights; i++)
        s->vectors[i] = s->weight[i / 3] * s->vectors[i];
}

/* As array_kernel's displace, without its loops for many. Returns false if a point is too large. */
static bool move_few(const block_work *work, size_t count, block_scratch *s)
{
    bool fits = true;
    for (size_t i = 0; i < 3 * count; i++) {
        const double x = s->x[i], moved = s->vectors[i] != 0 ? x + s->vectors[i] : x;
        fits = fits && (moved == x || fabs(moved) <= work->largest);
        s->x[i] = moved;
    }
    return fits;
}

static bool deform_single(const block_work *work, const kernel_cell *cell, const cell_points *points,
                          bool may_shift, size_t variant, block_scratch *s)
{
    const kernel_points displaced = {.uvw = work->cells->uvw + 3 * points->first,
                                     .which = s->order,
                                     .count = points->count,
                                     .delta = s->vectors};
    const shift_points shifts = shift_of(work, points, s->vectors, 1);
    if (points->count <= FEW_IN_CELL)
        work->kernel->displace_few(cell, displaced.uvw, points->count, s->vectors);
    else
        work->single->displace(cell, &displaced);
    if (may_shift)
        ffd_shift_points(&shifts, s->numbers);
    read_points(work, points, s);
    apply_factors(work, points, s);
    if (points->count <= FEW_IN_CELL ? !move_few(work, points->count, s)
                                     : work->arrays->displace(s->vectors, points->count, work->largest, s->x,
                                                              s->changed) < points->count)
        return false;
    for (size_t i = 0; i < points->count; i++)
        write_point(work, variant, work->cells->which[points->first + i], s->x + 3 * i);
    return true;
}

/* -- parts */

/* Displaces the points of a cell from first to end. */
static bool deform_cell(const block_work *work, const point_cell *of, size_t first, size_t end,
                        const block_part *part, block_scratch *s)
{
    cell_points points = {.cell = of};
    variant_cell cell;
    kernel_cell single;
    ffd_displacement_spans(work->variants->rest, of->index, points.span);
    bool may_shift = false;
    if (part->is_single)
        may_shift = extract_single(work, of, part->variant, s, &single);
    else {
        cell = begin_cell(work, of, points.span, s);
        if (of->count > 1)
            work->kernel->extract(&cell, &s->planes);
    }
    for (; first < end; first += points.count) {
        points.first = first;
        points.count = end - first < VARIANT_POINTS ? end - first : VARIANT_POINTS;
        if (!(part->is_single ? deform_single(work, &single, &points, may_shift, part->variant, s)
                              : deform_lanes(work, &cell, &points, part, s)))
            return false;
    }
    return true;
}

/* Returns the index of the cell that holds a sorted point. */
static size_t cell_of(const point_cells *cells, size_t point)
{
    size_t first = 0, end = cells->cell_count;
    while (end - first > 1) {
        const size_t middle = first + (end - first) / 2;
        if (cells->cells[middle].first <= point)
            first = middle;
        else
            end = middle;
    }
    return first;
}

bool ffd_block_deform(const block_work *work, const block_part *part, block_scratch *scratch)
{
    const point_cells *const cells = work->cells;
    size_t first = part->first;
    for (size_t c = first < part->end ? cell_of(cells, first) : 0; first < part->end; c++) {
        const point_cell *const cell = &cells->cells[c];
        const size_t last = cell->first + cell->count, end = last < part->end ? last : part->end;
        if (!deform_cell(work, cell, first, end, part, scratch))
            return false;
        first = end;
    }
    return true;
}
