/* fold.c - ffd_folds_find: the proof that a deformed lattice does not fold, cell by cell. */
#include "base/arithmetic.h"
#include <ffd/fold.h>

#include "base/memory/memory.h"
#include "base/struct_size.h"
#include "base/system/deadline.h"
#include "base/system/thread.h"
#include "fold/affine/affine.h"
#include "fold/cell.h"
#include "fold/place.h"
#include <string.h>

#define TILE_CELLS 64

/* Budgets in boxes: for a cell in the first round, and for all cells together; for an undecided cell in the
   second round, and for all of them together; for min_det. The last three are for cubic lattices
   (ffd_cell_boxes). */
#define FIRST_BOXES 64
#define ALL_FIRST_BOXES (1L << 26)
#define CELL_BOXES 2048
#define ALL_BOXES (1L << 22)
#define REFINE_BOXES 4096

/* How many witnesses are looked at until one is true. */
#define MOST_WITNESSES 64

typedef struct tile_verdict {
    size_t folded, unknown;
    double lower, least_seen;
    size_t first; /* the first folded cell, if possible one with a true witness; only if folded */
    cell_verdict witness;
} tile_verdict;

typedef struct fold_work {
    fold_plan plan;
    fold_scratch **scratch; /* one for each worker */
    int workers;
    double *lower;           /* one for each cell */
    unsigned char *verdicts; /* one for each cell */
    tile_verdict *tiles;
    size_t tile_count;
    long first, boxes; /* budgets of a cell: in the first round; in the second one, if it is undecided */
} fold_work;

/* Returns whether the witness of a cell is to replace that of the tile. */
static bool is_better(const tile_verdict *tile, const cell_verdict *witness, size_t cell)
{
    if (tile->folded == 0 || witness->is_positive != tile->witness.is_positive)
        return tile->folded == 0 || tile->witness.is_positive;
    return cell < tile->first;
}

static void decide(fold_work *work, size_t cell, long boxes, int worker, tile_verdict *result)
{
    cell_verdict verdict;
    if (ffd_deadline_passed()) { /* then the proof fails as a whole */
        work->lower[cell] = -DBL_MAX;
        work->verdicts[cell] = FFD_FOLDS_UNKNOWN;
        result->unknown++;
        return;
    }
    ffd_cell_decide(&work->plan, cell, boxes, work->scratch[worker], &verdict);
    work->lower[cell] = verdict.lower;
    work->verdicts[cell] = (unsigned char)verdict.verdict;
    result->least_seen = minimum_number(result->least_seen, verdict.least_seen);
    result->unknown += verdict.verdict == FFD_FOLDS_UNKNOWN;
    if (verdict.verdict != FFD_FOLDS_SOME)
        return;
    if (is_better(result, &verdict, cell)) {
        result->first = cell;
        result->witness = verdict;
    }
    result->folded++;
}

/* Finds the least lower bound of the cells of a tile. */
static void find_lower(fold_work *work, size_t tile)
{
    const size_t begin = tile * TILE_CELLS, left = work->plan.cell_count - begin,
                 end = begin + (left < TILE_CELLS ? left : TILE_CELLS);
    work->tiles[tile].lower = work->lower[begin];
    for (size_t cell = begin + 1; cell < end; cell++)
        work->tiles[tile].lower = minimum_number(work->tiles[tile].lower, work->lower[cell]);
}

static void decide_tile(void *context, size_t tile, size_t begin, size_t end, int worker)
{
    fold_work *work = context;
    work->tiles[tile] = (tile_verdict){.least_seen = DBL_MAX};
    for (size_t cell = begin; cell < end; cell++)
        decide(work, cell, work->first, worker, &work->tiles[tile]);
    find_lower(work, tile);
}

/* The second round, for undecided cells. */
static void decide_rest_of_tile(void *context, size_t tile, size_t begin, size_t end, int worker)
{
    fold_work *work = context;
    if (work->tiles[tile].unknown == 0)
        return;
    work->tiles[tile].unknown = 0;
    for (size_t cell = begin; cell < end; cell++)
        if (work->verdicts[cell] == FFD_FOLDS_UNKNOWN)
            decide(work, cell, work->boxes, worker, &work->tiles[tile]);
    find_lower(work, tile);
}

/* All cells, and all undecided ones, share a fixed number of boxes, so that the time is bounded for any
   lattice. The shares depend only on the lattice. */
static void decide_all(fold_work *work)
{
    const size_t cells = work->plan.cell_count;
    size_t unknown = 0;
    const long each = (long)(ALL_FIRST_BOXES / cells);
    work->first = each < 1 ? 1 : each < FIRST_BOXES ? each : FIRST_BOXES;
    ffd_parallel_tiles(cells, TILE_CELLS, work->workers, decide_tile, work);
    for (size_t tile = 0; tile < work->tile_count; tile++)
        unknown += work->tiles[tile].unknown;
    if (unknown == 0)
        return;
    const long most = ffd_cell_boxes(&work->plan, CELL_BOXES);
    const size_t share = (size_t)ffd_cell_boxes(&work->plan, ALL_BOXES) / unknown;
    work->boxes = share < (size_t)most ? (long)share : most;
    if (work->boxes > work->first)
        ffd_parallel_tiles(cells, TILE_CELLS, work->workers, decide_rest_of_tile, work);
}

/* Reports the witness of a tile. With weights it is looked at once more: the parameters are rounded, and the
   value, of W^4 det J, is known to the bound of its rounding only. Nothing is reported if it does not fold.
 */
static void report_witness(const fold_work *work, const tile_verdict *tile, ffd_folds *folds)
{
    const fold_plan *plan = &work->plan;
    size_t index[3];
    int span[3];
    ffd_fold_cell_at(plan, tile->first, index, span);
    ffd_place_parameters(plan, index, tile->witness.local, folds->witness.uvw);
    folds->witness.det = tile->witness.value;
    if (plan->rational) {
        const place_determinant place =
            ffd_place_determinant(plan, index, folds->witness.uvw, work->scratch[0]->working);
        if (place.sign > 0)
            return;
        folds->witness.det = -place.size;
    }
    ffd_lattice_evaluate(plan->lattice, FFD_VOLUME_DEFORMED, folds->witness.uvw, folds->witness.xyz, NULL);
    ffd_lattice_evaluate(plan->lattice, FFD_VOLUME_REST, folds->witness.uvw, folds->witness.rest, NULL);
    folds->witness.is_there = true;
}

/* Combines the results of the tiles in order. Returns the least value found. */
static double join_tiles(const fold_work *work, ffd_folds *folds)
{
    double least_seen = DBL_MAX;
    int witnesses = 0;
    for (size_t i = 0; i < work->tile_count; i++) {
        const tile_verdict *tile = &work->tiles[i];
        folds->folded_cells += tile->folded;
        folds->unknown_cells += tile->unknown;
        least_seen = minimum_number(least_seen, tile->least_seen);
        if (tile->folded > 0 && !folds->witness.is_there && witnesses++ < MOST_WITNESSES)
            report_witness(work, tile, folds);
    }
    if (!folds->witness.is_there) { /* none that a double can name */
        folds->unknown_cells += folds->folded_cells;
        folds->folded_cells = 0;
    }
    folds->verdict = folds->folded_cells    ? FFD_FOLDS_SOME
                     : folds->unknown_cells ? FFD_FOLDS_UNKNOWN
                                            : FFD_FOLDS_NONE;
    return least_seen;
}

/* Returns the cell with the least lower bound. */
static size_t least_cell(const fold_work *work, size_t *least_tile)
{
    size_t tile = 0;
    for (size_t i = 1; i < work->tile_count; i++)
        if (work->tiles[i].lower < work->tiles[tile].lower)
            tile = i;
    size_t cell = tile * TILE_CELLS;
    while (work->lower[cell] > work->tiles[tile].lower)
        cell++;
    *least_tile = tile;
    return cell;
}

/* Refines the cells with the least bounds until the bound is near the least value found. Returns the least
   bound. */
static double refine(fold_work *work, double least_seen)
{
    long boxes = ffd_cell_boxes(&work->plan, REFINE_BOXES);
    for (;;) {
        size_t tile;
        const size_t cell = least_cell(work, &tile);
        const double before = work->lower[cell];
        if (before >= ffd_fold_target(least_seen) || boxes <= 0)
            return before;
        const double lower = ffd_cell_refine(&work->plan, cell, work->scratch[0], &least_seen, &boxes);
        if (!(lower > before)) /* the bound cannot be improved */
            return before;
        work->lower[cell] = lower;
        find_lower(work, tile);
    }
}

static ffd_status allocate(fold_work *work, int threads, ffd_error *error)
{
    const size_t cells = work->plan.cell_count;
    work->tile_count = cells / TILE_CELLS + (cells % TILE_CELLS != 0);
    threads = ffd_threads_for(threads, work->tile_count);
    work->lower = ffd_alloc(cells, sizeof(double));
    work->verdicts = ffd_alloc(cells, 1);
    work->tiles = ffd_alloc(work->tile_count, sizeof *work->tiles);
    work->scratch = ffd_alloc_zero((size_t)threads, sizeof(fold_scratch *));
    if (!work->lower || !work->verdicts || !work->tiles || !work->scratch)
        return ffd_fail_memory(error);
    while (work->workers < threads) {
        fold_scratch *scratch = ffd_fold_scratch_create(&work->plan);
        if (!scratch)
            return work->workers > 0 ? FFD_OK : ffd_fail_memory(error);
        work->scratch[work->workers++] = scratch;
    }
    return FFD_OK;
}

static ffd_status find(const ffd_lattice *lattice, int threads, ffd_folds *folds, ffd_error *error)
{
    fold_work work;
    memset(&work, 0, sizeof work);
    if (!ffd_lattice_get_points(lattice, FFD_VOLUME_REST))
        return ffd_fail(error, FFD_E_ARGUMENT,
                        "the lattice has no control points yet: its box is that of a mesh");
    TRY(ffd_threads_check(threads, error));
    folds->cells = lattice->knots[0].span_count * lattice->knots[1].span_count * lattice->knots[2].span_count;
    folds->relative_to = FFD_FOLDS_TO_PLACE;
    if (ffd_fold_is_affine(lattice, &folds->min_det))
        return FFD_OK;
    ffd_status status;
    TRY_END(ffd_fold_plan_make(lattice, &work.plan, error));
    TRY_END(allocate(&work, threads, error));
    folds->relative_to = work.plan.volume.is_mean ? FFD_FOLDS_TO_MEAN : FFD_FOLDS_TO_BOUNDS;
    decide_all(&work);
    TRY_END(ffd_deadline_check(error));
    folds->min_det = refine(&work, join_tiles(&work, folds));
    if (folds->witness.is_there) /* the witness' value can be below the bound by rounding */
        folds->min_det = minimum_number(folds->min_det, folds->witness.det);
end:
    for (int i = 0; i < work.workers; i++)
        ffd_fold_scratch_destroy(work.scratch[i]);
    ffd_free(work.scratch);
    ffd_free(work.tiles);
    ffd_free(work.verdicts);
    ffd_free(work.lower);
    ffd_fold_plan_free(&work.plan);
    return status;
}

ffd_status ffd_folds_find(const ffd_lattice *lattice, int threads, ffd_folds *callers, ffd_error *error)
{
    ffd_folds folds = {.struct_size = sizeof folds};
    TRY(ffd_struct_check(sizeof folds, callers, "ffd_folds", error));
    ffd_status status = find(lattice, threads, &folds, error);
    folds.is_known = !status;
    ffd_struct_give(&folds, sizeof folds, callers, callers->struct_size);
    return status;
}
