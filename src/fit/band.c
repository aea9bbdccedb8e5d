#include "fit/band.h"
#include "base/arithmetic.h"
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include "base/system/thread.h"
#include "fit/band_kernel.h"
#include <math.h>
#include <stdatomic.h>
#include <string.h>

/* A pivot below this part of the largest diagonal entry is 0. */
#define LEAST_PIVOT 1e-15

#define ENTRIES (BAND_TILE * BAND_TILE)

#define ROW(ISA, set, lanes) [FFD_ISA_##ISA] = &ffd_band_kernel_##set,
static const band_kernel *const kernels[] = {[FFD_ISA_SCALAR] = &ffd_band_kernel_scalar, FOR_EACH_SIMD(ROW)};

static size_t tiles_of(size_t rows)
{
    return rows / BAND_TILE + (rows % BAND_TILE != 0);
}

/* Tiles from the diagonal down to the last one with an entry: the first row of a tile may be its last. */
static size_t depth_of(size_t n, size_t reach)
{
    const size_t depth = tiles_of(reach + BAND_TILE), most = tiles_of(n);
    return depth < most ? depth : most;
}

uint64_t ffd_band_bytes(size_t n, size_t reach)
{
    const uint64_t tiles = (uint64_t)tiles_of(n) * depth_of(n, reach);
    return tiles > UINT64_MAX / (ENTRIES * sizeof(double)) ? UINT64_MAX : tiles * ENTRIES * sizeof(double);
}

/* Returns the tile in row `row` and column `column` of tiles. */
static double *tile_at(const band_matrix *band, size_t row, size_t column)
{
    return band->entries + (column * band->depth + row - column) * ENTRIES;
}

/* The rows that are not rows of the matrix make no difference. */
static void fill_up(const band_matrix *band)
{
    for (size_t i = band->n; i < band->tiles * BAND_TILE; i++)
        *ffd_band_entry(band, i, i) = 1;
}

ffd_status ffd_band_make(size_t n, size_t reach, band_matrix *band, ffd_error *error)
{
    const uint64_t bytes = ffd_band_bytes(n, reach);
    *band = (band_matrix){.n = n, .reach = reach, .tiles = tiles_of(n), .depth = depth_of(n, reach)};
    band->entries = bytes > SIZE_MAX ? NULL : ffd_alloc_whole((size_t)bytes, 1);
    return band->entries ? FFD_OK : ffd_fail_memory(error);
}

void ffd_band_free(band_matrix *band)
{
    ffd_free(band->entries);
    *band = (band_matrix){0};
}

static void clear_columns(void *context, size_t tile, size_t first, size_t last, int worker)
{
    const band_matrix *const band = context;
    (void)tile, (void)worker;
    memset(tile_at(band, first, first), 0, (last - first) * band->depth * ENTRIES * sizeof *band->entries);
}

void ffd_band_clear(band_matrix *band, int threads)
{
    ffd_parallel_tiles(band->tiles, 1, threads, clear_columns, band);
    fill_up(band);
}

void ffd_band_copy(const band_matrix *from, band_matrix *to)
{
    memcpy(to->entries, from->entries, from->tiles * from->depth * ENTRIES * sizeof *from->entries);
}

double ffd_band_trace(const band_matrix *band)
{
    double sum = 0;
    for (size_t i = 0; i < band->n; i++)
        sum += *ffd_band_entry(band, i, i);
    return sum;
}

/* Returns the pivot that counts as 0. */
static double least_pivot(const band_matrix *band)
{
    double largest = 0;
    for (size_t i = 0; i < band->n; i++)
        largest = larger_of(largest, *ffd_band_entry(band, i, i));
    return LEAST_PIVOT * largest;
}

/* A factor that is made tile by tile, column by column: each from tiles before it. */
typedef struct factor_work {
    const band_matrix *band;
    const band_kernel *kernel;
    const band_run *run;
    double least;           /* pivot that is positive */
    atomic_uchar *made;     /* of each tile, in the order of the entries: it is final */
    atomic_bool is_stopped; /* no more tiles are made */
    atomic_bool is_singular;
} factor_work;

static size_t number_of(const band_matrix *band, size_t row, size_t column)
{
    return column * band->depth + row - column;
}

/* Waits until a tile is final. Another thread makes it: tiles are taken in order, so that this ends. Returns
   NULL if the work has stopped. */
static const double *wait_for(factor_work *work, size_t row, size_t column)
{
    while (!atomic_load_explicit(&work->made[number_of(work->band, row, column)], memory_order_acquire)) {
        if (atomic_load(&work->is_stopped))
            return NULL;
        ffd_thread_yield();
    }
    return tile_at(work->band, row, column);
}

/* Returns the first column of a tile in the band with an entry. */
static size_t first_entry(const band_matrix *band, size_t row, size_t column)
{
    const size_t distance = BAND_TILE * (row - column);
    return distance > band->reach ? distance - band->reach : 0;
}

/* Subtracts from a tile the products of those left of it, in ascending order. */
static bool subtract_all(factor_work *work, size_t row, size_t column)
{
    const band_matrix *const band = work->band;
    double *const tile = tile_at(band, row, column);
    for (size_t k = row + 1 > band->depth ? row + 1 - band->depth : 0; k < column; k++) {
        const double *const left = wait_for(work, row, k), *const above = wait_for(work, column, k);
        if (!left || !above)
            return false;
        work->kernel->subtract(left, above, first_entry(band, row, k), tile);
    }
    return true;
}

/* Makes the rest of a tile, by the diagonal one of its column. */
static bool divide_tile(factor_work *work, size_t row, size_t column)
{
    double *const tile = tile_at(work->band, row, column);
    if (row == column) {
        if (work->kernel->factor(tile, work->least))
            return true;
        atomic_store(&work->is_singular, true);
        atomic_store(&work->is_stopped, true);
        return false;
    }
    const double *const diagonal = wait_for(work, column, column);
    if (diagonal)
        work->kernel->divide(diagonal, tile);
    return diagonal;
}

static void make_tile(void *context, size_t number, size_t first, size_t last, int worker)
{
    factor_work *const work = context;
    const band_matrix *const band = work->band;
    const size_t column = number / band->depth, row = column + number % band->depth;
    (void)first, (void)last, (void)worker;
    if (row >= band->tiles)
        return;
    ffd_fit_step_done(work->run->steps, (double)column / (double)band->tiles);
    if (ffd_deadline_passed())
        atomic_store(&work->is_stopped, true);
    if (!atomic_load(&work->is_stopped) && subtract_all(work, row, column) && divide_tile(work, row, column))
        atomic_store_explicit(&work->made[number], 1, memory_order_release);
}

/* A thread for so many multiplications and additions: to start one takes longer than a tenth of them. */
#define WORK_OF_THREAD 3e7

static int threads_for(const band_matrix *band, int threads)
{
    const double work = (double)band->n * (double)band->reach * (double)band->reach;
    return work < threads * WORK_OF_THREAD ? 1 + (int)(work / WORK_OF_THREAD) : threads;
}

ffd_status ffd_band_factor(band_matrix *band, const band_run *run, bool *is_positive, ffd_error *error)
{
    const size_t tiles = band->tiles * band->depth;
    factor_work work = {.band = band,
                        .kernel = kernels[ffd_isa_resolve(run->isa)],
                        .run = run,
                        .least = least_pivot(band),
                        .made = ffd_alloc_zero(tiles, sizeof *work.made)};
    *is_positive = false;
    if (!work.made)
        return ffd_fail_memory(error);
    ffd_parallel_tiles(tiles, 1, threads_for(band, run->threads), make_tile, &work);
    *is_positive = !atomic_load(&work.is_singular);
    ffd_free(work.made);
    return ffd_deadline_check(error);
}

/* to -= factor * from, for rows of numbers. */
static void subtract_row(double factor, const double *from, double *to, size_t columns)
{
    for (size_t c = 0; c < columns; c++)
        to[c] -= factor * from[c];
}

static void divide_row(double by, double *row, size_t columns)
{
    for (size_t c = 0; c < columns; c++)
        row[c] /= by;
}

/* Returns the end of the rows with entries in column j. */
static size_t end_of_column(const band_matrix *factor, size_t j)
{
    return factor->n - j > factor->reach ? j + factor->reach + 1 : factor->n;
}

void ffd_band_forward(const band_matrix *factor, double *x, size_t columns)
{
    for (size_t j = 0; j < factor->n && !(j % 16 == 0 && ffd_deadline_passed()); j++) {
        divide_row(*ffd_band_entry(factor, j, j), x + j * columns, columns);
        for (size_t i = j + 1; i < end_of_column(factor, j); i++)
            subtract_row(*ffd_band_entry(factor, i, j), x + j * columns, x + i * columns, columns);
    }
}

void ffd_band_backward(const band_matrix *factor, double *x, size_t columns)
{
    for (size_t j = factor->n; j-- > 0 && !(j % 16 == 0 && ffd_deadline_passed());) {
        for (size_t i = j + 1; i < end_of_column(factor, j); i++)
            subtract_row(*ffd_band_entry(factor, i, j), x + i * columns, x + j * columns, columns);
        divide_row(*ffd_band_entry(factor, j, j), x + j * columns, columns);
    }
}
