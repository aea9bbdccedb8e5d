#include <ffd/fold.h>

#include "base/memory.h"
#include "base/thread.h"
#include "fold/cell.h"
#include <string.h>

#define TILE_CELLS 64
#define REFINE_BOXES 4096 /* looked at for min_det, if cubic */

typedef struct tile_verdict {
    size_t folded, unknown;
    double lower, least_seen;
    size_t first; /* the first folded cell; only with folded */
    cell_verdict witness;
} tile_verdict;

typedef struct fold_work {
    fold_plan plan;
    fold_scratch **scratch; /* one a worker */
    int workers;
    double *lower; /* one a cell */
    tile_verdict *tiles;
    size_t tile_count;
} fold_work;

static void decide_tile(void *context, size_t tile, size_t begin, size_t end, int worker)
{
    fold_work *work = context;
    tile_verdict *result = &work->tiles[tile];
    *result = (tile_verdict){.lower = DBL_MAX, .least_seen = DBL_MAX};
    for (size_t cell = begin; cell < end; cell++) {
        cell_verdict verdict;
        ffd_cell_decide(&work->plan, cell, work->scratch[worker], &verdict);
        work->lower[cell] = verdict.lower;
        result->lower = fmin(result->lower, verdict.lower);
        result->least_seen = fmin(result->least_seen, verdict.least_seen);
        result->unknown += verdict.verdict == FFD_FOLDS_UNKNOWN;
        if (verdict.verdict == FFD_FOLDS_SOME && result->folded++ == 0) {
            result->first = cell;
            result->witness = verdict;
        }
    }
}

/* u of a place in the cell; at its end the last number before the next cell, where that has another one. */
static double parameter_at(const knot_vector *knots, size_t span, double t)
{
    const double *knot = knots->t + knots->spans[span];
    if (t < 1)
        return knot[0] + t * (knot[1] - knot[0]);
    const bool is_last = span + 1 == knots->span_count && !ffd_knots_closed(knots);
    return is_last ? knot[1] : nextafter(knot[1], knot[0]);
}

static void report_witness(const fold_plan *plan, const tile_verdict *tile, ffd_folds *folds)
{
    size_t index[3];
    int span[3];
    ffd_fold_cell_at(plan, tile->first, index, span);
    for (int a = 0; a < 3; a++)
        folds->witness_uvw[a] = parameter_at(&plan->lattice->knots[a], index[a], tile->witness.place[a]);
    ffd_lattice_evaluate(plan->lattice, FFD_VOLUME_DEFORMED, folds->witness_uvw, folds->witness_xyz, NULL);
    ffd_lattice_evaluate(plan->lattice, FFD_VOLUME_REST, folds->witness_uvw, folds->witness_rest, NULL);
    folds->witness_det = tile->witness.value;
    folds->has_witness = true;
}

/* Joins the tiles in their order. Returns the least value seen. */
static double join_tiles(const fold_work *work, ffd_folds *folds)
{
    double least_seen = DBL_MAX;
    for (size_t i = 0; i < work->tile_count; i++) {
        const tile_verdict *tile = &work->tiles[i];
        folds->folded_cells += tile->folded;
        folds->unknown_cells += tile->unknown;
        least_seen = fmin(least_seen, tile->least_seen);
        if (tile->folded > 0 && !folds->has_witness)
            report_witness(&work->plan, tile, folds);
    }
    folds->cells = work->plan.cell_count;
    folds->verdict = folds->folded_cells    ? FFD_FOLDS_SOME
                     : folds->unknown_cells ? FFD_FOLDS_UNKNOWN
                                            : FFD_FOLDS_NONE;
    return least_seen;
}

/* The cell with the least lower bound. */
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

static void set_lower(fold_work *work, size_t tile, size_t cell, double lower)
{
    const size_t begin = tile * TILE_CELLS;
    const size_t left = work->plan.cell_count - begin, count = left < TILE_CELLS ? left : TILE_CELLS;
    work->lower[cell] = lower;
    work->tiles[tile].lower = work->lower[begin];
    for (size_t i = 1; i < count; i++)
        work->tiles[tile].lower = fmin(work->tiles[tile].lower, work->lower[begin + i]);
}

/* Looks into the least cells until their bound is near the least value seen. Returns the least bound. */
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
        if (!(lower > before)) /* no better is to be had */
            return before;
        set_lower(work, tile, cell, lower);
    }
}

static ffd_status allocate(fold_work *work, int threads, ffd_error *error)
{
    const size_t cells = work->plan.cell_count;
    work->tile_count = cells / TILE_CELLS + (cells % TILE_CELLS != 0);
    if (threads < 1)
        threads = ffd_processor_count();
    if ((size_t)threads > work->tile_count)
        threads = (int)work->tile_count;
    work->lower = ffd_alloc(cells, sizeof(double));
    work->tiles = ffd_alloc(work->tile_count, sizeof *work->tiles);
    work->scratch = ffd_alloc_zero((size_t)threads, sizeof(fold_scratch *));
    if (!work->lower || !work->tiles || !work->scratch)
        return ffd_fail_memory(error);
    while (work->workers < threads) {
        fold_scratch *scratch = ffd_fold_scratch_create(&work->plan);
        if (!scratch)
            return work->workers > 0 ? FFD_OK : ffd_fail_memory(error);
        work->scratch[work->workers++] = scratch;
    }
    return FFD_OK;
}

ffd_status ffd_folds_find(const ffd_lattice *lattice, int threads, ffd_folds *folds, ffd_error *error)
{
    fold_work work;
    memset(&work, 0, sizeof work);
    memset(folds, 0, sizeof *folds);
    if (!ffd_lattice_get_points(lattice, FFD_VOLUME_REST))
        return ffd_fail(error, FFD_E_ARGUMENT, "the lattice still needs the bounds of a mesh");
    ffd_status status = ffd_fold_plan_make(lattice, &work.plan, error);
    if (!status)
        status = allocate(&work, threads, error);
    if (status)
        goto out;
    ffd_parallel_tiles(work.plan.cell_count, TILE_CELLS, work.workers, decide_tile, &work);
    folds->min_det = refine(&work, join_tiles(&work, folds));
out:
    for (int i = 0; i < work.workers; i++)
        ffd_fold_scratch_destroy(work.scratch[i]);
    ffd_free(work.scratch);
    ffd_free(work.tiles);
    ffd_free(work.lower);
    ffd_fold_plan_free(&work.plan);
    return status;
}
