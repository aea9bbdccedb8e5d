/* displacement_batch.c - the displacements of many points: groups them by cell. */
#include "deform/displacement.h"
#include <string.h>

#define NO_CELL UINT16_MAX

#define ROW(ISA, set, lanes)                                                                                 \
    [FFD_ISA_##ISA] = {ffd_extraction_kernel_##set, ffd_kernel_##set, ffd_slope_kernel_##set},
static const cell_kernels kernels[] = {
    [FFD_ISA_SCALAR] = {ffd_extraction_kernel_scalar, ffd_kernel_scalar, ffd_slope_kernel_scalar},
    FOR_EACH_SIMD(ROW)};

const cell_kernels *ffd_cell_kernels(ffd_isa isa)
{
    return &kernels[ffd_isa_resolve(isa)];
}

/* Returns the cell of the batch with these spans, and adds it if it is new. */
static size_t take_cell(const size_t span[3], size_t key, displacement_scratch *scratch)
{
    size_t bucket = (key * 0x9e3779b97f4a7c15u >> 20) % scratch->bucket_count;
    while (scratch->buckets[bucket] != NO_CELL) {
        const size_t found = scratch->buckets[bucket];
        if (scratch->cells[found].key == key)
            return found;
        bucket = (bucket + 1) % scratch->bucket_count;
    }
    const size_t made = scratch->cell_count++;
    scratch->buckets[bucket] = (uint16_t)made;
    scratch->cells[made] = (batch_cell){.span = {span[0], span[1], span[2]}, .key = key};
    return made;
}

/* A non-empty span, with its two knots. */
typedef struct span_range {
    size_t index;
    double first, last;
} span_range;

static bool span_holds(const span_range *span, double u)
{
    return span->first <= u && u < span->last;
}

static bool cell_holds(const span_range cell[3], const double uvw[3])
{
    return span_holds(&cell[0], uvw[0]) && span_holds(&cell[1], uvw[1]) && span_holds(&cell[2], uvw[2]);
}

/* Finds the cell of a point, starting with that of the point before, from which it mostly differs in one
   direction at most. */
static size_t find_cell(const ffd_lattice *lattice, const double uvw[3], displacement_scratch *scratch,
                        span_range cell[3])
{
    const knot_vector *const knots = lattice->knots;
    for (int a = 0; a < 3; a++)
        if (!span_holds(&cell[a], uvw[a])) {
            const size_t index = ffd_knots_span_index(&knots[a], ffd_knots_wrap(&knots[a], uvw[a]));
            const double *const span = knots[a].t + knots[a].spans[index];
            cell[a] = (span_range){index, span[0], span[1]};
        }
    const size_t span[3] = {cell[0].index, cell[1].index, cell[2].index};
    return take_cell(span, (span[2] * knots[1].span_count + span[1]) * knots[0].span_count + span[0],
                     scratch);
}

/* Returns u,v,w of the k-th point to compute. */
static const double *uvw_of(const displacement_batch *batch, size_t k)
{
    return ffd_batch_uvw(batch, batch->which[k]);
}

/* Divides the points into stretches of which only the first point may need to be wrapped. */
static void find_cells(const ffd_lattice *lattice, const displacement_batch *batch,
                       displacement_scratch *scratch)
{
    span_range cell[3] = {{0}}; /* an empty range: no cell yet */
    size_t stretches = 0;
    scratch->cell_count = 0;
    scratch->bucket_count = 2 * batch->count;
    memset(scratch->buckets, 0xff, scratch->bucket_count * sizeof *scratch->buckets);
    for (size_t k = 0; k < batch->count; k++) {
        if (cell_holds(cell, uvw_of(batch, k)))
            continue;
        const size_t found = find_cell(lattice, uvw_of(batch, k), scratch, cell);
        scratch->stretches[stretches++] = (batch_stretch){(uint32_t)k, (uint32_t)found};
    }
    scratch->stretches[stretches].first = (uint32_t)batch->count;
    scratch->stretch_count = stretches;
}

/* Appends the points [first, end) of a stretch to those of their cell. */
static void add_stretch(const ffd_lattice *lattice, const displacement_batch *batch, size_t first, size_t end,
                        batch_cell *cell, displacement_scratch *scratch)
{
    const size_t slot = cell->first + cell->count;
    double *const uvw = scratch->uvw_room + 3 * slot;
    memcpy(scratch->sorted_room + slot, batch->which + first, (end - first) * sizeof *batch->which);
    ffd_displacement_wrap(lattice, uvw_of(batch, first), uvw);
    for (size_t k = first + 1; k < end; k++)
        memcpy(uvw + 3 * (k - first), uvw_of(batch, k), 3 * sizeof *uvw);
    cell->count += (uint32_t)(end - first);
}

/* Groups the points by cell, stably (a counting sort). */
static void sort_points(const ffd_lattice *lattice, const displacement_batch *batch,
                        displacement_scratch *scratch)
{
    const batch_stretch *const stretches = scratch->stretches;
    uint32_t first = 0;
    for (size_t s = 0; s < scratch->stretch_count; s++)
        scratch->cells[stretches[s].cell].count += stretches[s + 1].first - stretches[s].first;
    for (size_t c = 0; c < scratch->cell_count; c++) {
        scratch->cells[c].first = first;
        first += scratch->cells[c].count;
        scratch->cells[c].count = 0;
    }
    for (size_t s = 0; s < scratch->stretch_count; s++)
        add_stretch(lattice, batch, stretches[s].first, stretches[s + 1].first,
                    &scratch->cells[stretches[s].cell], scratch);
    scratch->sorted = scratch->sorted_room;
    scratch->uvw = scratch->uvw_room;
}

/* Whether a lattice has one cell, and no u,v,w of it is wrapped: that of one polynomial, as Sederberg &
   Parry's. */
static bool is_one_cell(const ffd_lattice *lattice)
{
    bool is_one = true;
    for (int a = 0; a < 3; a++) {
        const knot_vector *const knots = &lattice->knots[a];
        const double last = ffd_knots_last(knots);
        is_one = is_one && knots->span_count == 1 && ffd_knots_wrap(knots, last) == last;
    }
    return is_one;
}

/* Whether the u,v,w of a batch follow one another without a gap. */
static bool is_packed(const displacement_batch *batch)
{
    const uint32_t distance = batch->which[batch->count - 1] - batch->which[0];
    return distance == batch->count - 1 && batch->stride == 3 * sizeof *batch->uvw;
}

/* Takes the points where they are, all in the only cell. */
static void take_points(const displacement_batch *batch, displacement_scratch *scratch)
{
    scratch->cell_count = 1;
    scratch->cells[0] = (batch_cell){.count = (uint32_t)batch->count};
    scratch->sorted = batch->which;
    scratch->uvw = uvw_of(batch, 0);
}

static void stay(const displacement_batch *batch, size_t n)
{
    memset(batch->delta + 3 * n, 0, 3 * sizeof *batch->delta);
    if (batch->gradient && !batch->only_turns)
        memset(batch->gradient + 9 * n, 0, 9 * sizeof *batch->gradient);
    batch->moves[n] = 0;
}

void ffd_displacement_scratch_clear(displacement_scratch *scratch)
{
    scratch->kept.lattice = NULL;
    scratch->kept_turns.lattice = NULL;
    scratch->turns.order[0] = 0;
}

static size_t cell_count(const ffd_lattice *lattice)
{
    const knot_vector *const knots = lattice->knots;
    return knots[0].span_count * knots[1].span_count * knots[2].span_count;
}

/* More slots than cells, so that few cells share one. */
#define SLOTS_A_CELL 4

/* Prepares the cache for a lattice. */
static void begin_cells(const ffd_lattice *lattice, cell_use use, kept_cells *kept)
{
    if (kept->lattice == lattice && kept->use == use)
        return;
    const size_t width = ffd_displacement_cell_width(lattice, use) + 1;
    const size_t most = SLOTS_A_CELL * cell_count(lattice);
    kept->lattice = lattice;
    kept->use = use;
    kept->width = width;
    const size_t share = KEPT_IN_ALL / (size_t)(kept->threads > 2 ? kept->threads : 2);
    kept->count = share / width < KEPT_CELLS ? share / width : KEPT_CELLS;
    if (kept->count > most)
        kept->count = most;
    if (kept->count == 0)
        kept->count = 1;
    kept->used = 0;
    memset(kept->keys, 0, kept->count * sizeof *kept->keys);
}

/* Returns the number of blocks of cells along a direction. */
static size_t block_count(const knot_vector *knots)
{
    return (knots->span_count + BLOCK_SIDE - 1) / BLOCK_SIDE;
}

static void begin_turns(const ffd_lattice *lattice, kept_turns *kept)
{
    const knot_vector *const knots = lattice->knots;
    if (kept->lattice == lattice)
        return;
    kept->lattice = lattice;
    kept->cells = cell_count(lattice);
    const size_t all = kept->cells + block_count(&knots[0]) * block_count(&knots[1]) * block_count(&knots[2]);
    kept->count = all < TURN_SLOTS ? all : TURN_SLOTS;
    memset(kept->answers, 0, kept->count * sizeof *kept->answers);
}

static cell_turns recall_turns(const kept_turns *kept, size_t key)
{
    const uint64_t answer = kept->answers[key % kept->count];
    return answer / 4 == key ? (cell_turns)(answer % 4) : TURNS_UNKNOWN;
}

static cell_turns keep_turns(kept_turns *kept, size_t key, bool nowhere)
{
    const cell_turns turns = nowhere ? TURNS_NOWHERE : TURNS_PERHAPS;
    kept->answers[key % kept->count] = 4 * (uint64_t)key + turns;
    return turns;
}

/* Returns how a cell moves and, if its displacements differ, its numbers; computes them if they are not in
   the cache. */
static cell_motion find_numbers(const ffd_lattice *lattice, extraction_kernel *extract,
                                const batch_cell *cell, kept_cells *kept, const double **numbers)
{
    const size_t slot = (cell->key * 0x9e3779b97f4a7c15u >> 40) % kept->count;
    if (kept->keys[slot] == 0)
        kept->places[slot] = kept->used++;
    double *const kept_numbers = kept->values + kept->places[slot] * kept->width;
    *numbers = kept_numbers;
    if (kept->keys[slot] == cell->key + 1)
        return kept->motions[slot];
    kept->keys[slot] = cell->key + 1;
    kept->motions[slot] = ffd_displacement_cell_points(lattice, extract, cell->span, kept->use, kept_numbers);
    return kept->motions[slot];
}

/* With fewer points in a cell of a curved lattice, their gradients cost less than bounds. With fewer in the
   cells of a batch on average, so few cells of a block may be met that their bounds cost less than the
   block's. */
#define FEW_POINTS 5
#define FEW_ON_AVERAGE 2

/* Returns whether det F may be 0 or less in the block of a cell. */
static bool block_may_turn(const ffd_lattice *lattice, slope_kernel *find_slopes, const size_t span[3],
                           displacement_scratch *scratch)
{
    const size_t block[3] = {span[0] / BLOCK_SIDE, span[1] / BLOCK_SIDE, span[2] / BLOCK_SIDE};
    const size_t row = block[2] * block_count(&lattice->knots[1]) + block[1];
    const size_t key = scratch->kept_turns.cells + row * block_count(&lattice->knots[0]) + block[0];
    cell_turns turns = recall_turns(&scratch->kept_turns, key);
    if (turns == TURNS_UNKNOWN)
        turns = keep_turns(&scratch->kept_turns, key,
                           ffd_turns_nowhere_in_block(lattice, find_slopes, block, &scratch->turns));
    return turns == TURNS_PERHAPS;
}

/* Returns whether det F may be 0 or less at a point of a cell. */
static bool may_turn(const ffd_lattice *lattice, const cell_kernels *kernel, const batch_cell *of,
                     const double *numbers, bool is_dense, displacement_scratch *scratch)
{
    const turn_cell cell = {lattice, of->span, kernel};
    if (is_dense && !block_may_turn(lattice, kernel->find_slopes, of->span, scratch))
        return false;
    cell_turns turns = recall_turns(&scratch->kept_turns, of->key);
    if (turns != TURNS_UNKNOWN)
        return turns == TURNS_PERHAPS;
    if (!lattice->has_uvw_by_p && of->count < FEW_POINTS)
        return true;
    turns = keep_turns(&scratch->kept_turns, of->key, ffd_turns_nowhere(&cell, numbers, &scratch->turns));
    return turns == TURNS_PERHAPS;
}

/* Stores the same displacement for all points of a cell. */
static void shift_cell(const double shared[3], const displacement_batch *batch, const uint32_t *which,
                       size_t count)
{
    for (size_t k = 0; k < count; k++) {
        stay(batch, which[k]);
        memcpy(batch->delta + 3 * (size_t)which[k], shared, 3 * sizeof *shared);
        batch->moves[which[k]] = 1;
    }
}

/* A parameter value that is a knot. */
typedef struct knot_place {
    int direction;
    double u;
} knot_place;

static int list_knots(const ffd_lattice *lattice, const int span[3], uint8_t knots, knot_place places[6])
{
    int count = 0;
    for (int bit = 0; bit < 6; bit++)
        if (knots >> bit & 1)
            places[count++] = (knot_place){bit / 2, lattice->knots[bit / 2].t[span[bit / 2] + bit % 2]};
    return count;
}

/* Handles points on the knots of a cell. Fewer control points act there than between knots, and these may
   have a common displacement. */
static void shift_on_knots(const ffd_lattice *lattice, const int span[3], uint8_t knots, const double *uvw,
                           const displacement_batch *batch, const uint32_t *which, size_t count)
{
    knot_place places[6];
    const int most = list_knots(lattice, span, knots, places);
    for (size_t k = 0; k < count; k++, uvw += 3) {
        int i = 0;
        while (i < most && uvw[places[i].direction] != places[i].u)
            i++;
        const double *const shared = i < most ? ffd_displacement_shared(lattice, span, uvw) : NULL;
        if (shared)
            memcpy(batch->delta + 3 * (size_t)which[k], shared, 3 * sizeof *shared);
    }
}

/* Displaces count points of a cell, from the first of them in the sorted order. */
static void bend_points(const cell_kernels *kernel, const kernel_cell *cell, const displacement_batch *batch,
                        size_t first, size_t count, bool gradients, displacement_scratch *scratch)
{
    const uint32_t *const which = scratch->sorted + first;
    const bool has_rest = gradients && cell->rest.points;
    const kernel_points points = {.uvw = scratch->uvw + 3 * first,
                                  .which = which,
                                  .count = count,
                                  .delta = batch->delta,
                                  .gradient = gradients ? batch->gradient : NULL,
                                  .jacobian = has_rest ? scratch->jacobian : NULL};
    kernel->displace(cell, &points);
    for (size_t k = 0; k < count; k++)
        batch->moves[which[k]] = 1;
    for (size_t k = 0; k < count && has_rest; k++)
        ffd_displacement_to_space(scratch->jacobian + 9 * which[k], batch->gradient + 9 * which[k]);
}

static void add_turns(const displacement_batch *batch, const uint32_t *which, size_t count)
{
    memcpy(batch->turns->points + batch->turns->count, which, count * sizeof *which);
    batch->turns->count += count;
}

/* Displaces the points of a cell in which the displacement may turn: computes gradients only in the runs of
   points where that is not excluded, and lists these points. */
static void bend_and_watch(const ffd_lattice *lattice, const cell_kernels *kernel,
                           const displacement_batch *batch, const batch_cell *of,
                           displacement_scratch *scratch)
{
    const turn_cell turn = {lattice, of->span, kernel};
    const uint32_t *const which = scratch->sorted + of->first;
    const turn_run *const runs = scratch->runs;
    kernel_cell cell;
    ffd_displacement_cell_points(lattice, kernel->extract, of->span, CELL_GRADIENTS, scratch->fields);
    ffd_displacement_cell_begin(lattice, of->span, CELL_GRADIENTS, scratch->fields, &cell);
    const size_t count = ffd_turns_find(&turn, &cell, which, scratch->uvw + 3 * (size_t)of->first, of->count,
                                        scratch->runs, &scratch->turns);
    for (size_t i = 0, end; i < count; i = end) {
        for (end = i + 1; end < count && runs[end].may_turn == runs[i].may_turn;)
            end++;
        const size_t first = runs[i].first, points = runs[end - 1].end - first;
        bend_points(kernel, &cell, batch, of->first + first, points, runs[i].may_turn, scratch);
        if (runs[i].may_turn)
            add_turns(batch, which + first, points);
    }
}

/* Displaces the points of a cell whose control points have different displacements. */
static void bend_cell(const ffd_lattice *lattice, const cell_kernels *kernel, const displacement_batch *batch,
                      const batch_cell *of, const double *numbers, displacement_scratch *scratch)
{
    const bool is_dense = batch->count >= FEW_ON_AVERAGE * scratch->cell_count;
    const bool turns = batch->turns && may_turn(lattice, kernel, of, numbers, is_dense, scratch);
    kernel_cell cell;
    if (turns && batch->only_turns) {
        bend_and_watch(lattice, kernel, batch, of, scratch);
        return;
    }
    ffd_displacement_cell_begin(lattice, of->span, scratch->kept.use, numbers, &cell);
    bend_points(kernel, &cell, batch, of->first, of->count, batch->gradient && !batch->only_turns, scratch);
    if (turns)
        add_turns(batch, scratch->sorted + of->first, of->count);
}

static void displace_cell(const ffd_lattice *lattice, const cell_kernels *kernel,
                          const displacement_batch *batch, const batch_cell *of,
                          displacement_scratch *scratch)
{
    const uint32_t *const which = scratch->sorted + of->first;
    const double *numbers;
    int span[3];
    const cell_motion motion = find_numbers(lattice, kernel->extract, of, &scratch->kept, &numbers);
    ffd_displacement_spans(lattice, of->span, span);
    for (size_t k = 0; k < of->count && motion.kind == CELL_STILL; k++)
        stay(batch, which[k]);
    if (motion.kind == CELL_SHIFTED)
        shift_cell(ffd_displacement_shared(lattice, span, NULL), batch, which, of->count);
    if (motion.kind == CELL_BENT)
        bend_cell(lattice, kernel, batch, of, numbers, scratch);
    if (motion.knots)
        shift_on_knots(lattice, span, motion.knots, scratch->uvw + 3 * (size_t)of->first, batch, which,
                       of->count);
}

/* Displaces each point alone. */
static void displace_singly(const ffd_lattice *lattice, const displacement_batch *batch)
{
    for (size_t k = 0; k < batch->count; k++) {
        const size_t n = batch->which[k];
        batch->moves[n] = (uint8_t)ffd_displacement(lattice, uvw_of(batch, k), batch->delta + 3 * n,
                                                    batch->gradient ? batch->gradient + 9 * n : NULL);
        if (batch->turns && batch->moves[n])
            batch->turns->points[batch->turns->count++] = (uint32_t)n;
    }
}

void ffd_displacements(const ffd_lattice *lattice, ffd_isa isa, const displacement_batch *batch,
                       displacement_scratch *scratch)
{
    if (lattice->rest_weights || !scratch) {
        displace_singly(lattice, batch);
        return;
    }
    const cell_kernels *const kernel = ffd_cell_kernels(isa);
    const bool gradients = batch->gradient && !batch->only_turns;
    begin_cells(lattice, gradients ? CELL_GRADIENTS : CELL_VALUES, &scratch->kept);
    if (batch->turns)
        begin_turns(lattice, &scratch->kept_turns);
    if (batch->count > 0 && is_packed(batch) && is_one_cell(lattice))
        take_points(batch, scratch);
    else {
        find_cells(lattice, batch, scratch);
        sort_points(lattice, batch, scratch);
    }
    for (size_t c = 0; c < scratch->cell_count; c++)
        displace_cell(lattice, kernel, batch, &scratch->cells[c], scratch);
}
