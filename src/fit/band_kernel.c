/* band_kernel.c - compiled once for each instruction set; FFD_BAND_KERNEL is the name of its table, FFD_LANES
   the number of SIMD lanes, each with one row of a tile.

   A block of the result stays in registers while its products are subtracted: as many of them as hide how
   long one subtraction takes. */
#include "fit/band_kernel.h"
#include <math.h>
#if FFD_LANES == 1
#include "base/inline.h"
typedef double lanes;
#define LOAD(from) (*(from))
#define STORE(values, to) (*(to) = (values))
#else
#include "base/vector/lanes.h"
#define LOAD(from) lanes_load(from)
#define STORE(values, to) lanes_store(values, to)
#endif

/* Registers down a column of the block, and its columns. */
#define DOWN (FFD_LANES == 8 ? 4 : 2)
#define ACROSS 4
#define ROWS ((size_t)DOWN * FFD_LANES)

/* Subtracts from the block of c at row i and column j the products of the columns [first, last) of a and b.
 */
static ALWAYS_INLINE void subtract_block(const double *a, const double *b, size_t first, size_t last,
                                         double *c)
{
    lanes sum[ACROSS][DOWN];
#pragma GCC unroll 4
    for (size_t j = 0; j < ACROSS; j++)
#pragma GCC unroll 4
        for (size_t i = 0; i < DOWN; i++)
            sum[j][i] = LOAD(c + BAND_TILE * j + FFD_LANES * i);
    for (size_t k = first; k < last; k++) {
        lanes column[DOWN];
#pragma GCC unroll 4
        for (size_t i = 0; i < DOWN; i++)
            column[i] = LOAD(a + BAND_TILE * k + FFD_LANES * i);
#pragma GCC unroll 4
        for (size_t j = 0; j < ACROSS; j++)
#pragma GCC unroll 4
            for (size_t i = 0; i < DOWN; i++)
                sum[j][i] -= column[i] * b[BAND_TILE * k + j];
    }
#pragma GCC unroll 4
    for (size_t j = 0; j < ACROSS; j++)
#pragma GCC unroll 4
        for (size_t i = 0; i < DOWN; i++)
            STORE(sum[j][i], c + BAND_TILE * j + FFD_LANES * i);
}

static void subtract(const double *a, const double *b, size_t first, double *c)
{
    for (size_t i = 0; i < BAND_TILE; i += ROWS)
        for (size_t j = 0; j < BAND_TILE; j += ACROSS)
            subtract_block(a + i, b + j, first, BAND_TILE, c + BAND_TILE * j + i);
}

/* Subtracts from column j of x, from row `from` on, what the columns [first, j) of it make there. */
static ALWAYS_INLINE void subtract_columns(const double *l, size_t first, size_t j, size_t from, double *x)
{
    for (size_t k = first; k < j; k++)
        for (size_t i = from; i < BAND_TILE; i++)
            x[BAND_TILE * j + i] -= x[BAND_TILE * k + i] * l[BAND_TILE * k + j];
}

static void divide(const double *l, double *x)
{
    for (size_t first = 0; first < BAND_TILE; first += ACROSS) {
        for (size_t i = 0; i < BAND_TILE; i += ROWS)
            subtract_block(x + i, l + first, 0, first, x + BAND_TILE * first + i);
        for (size_t j = first; j < first + ACROSS; j++) {
            subtract_columns(l, first, j, 0, x);
            for (size_t i = 0; i < BAND_TILE; i++)
                x[BAND_TILE * j + i] /= l[BAND_TILE * j + j];
        }
    }
}

static bool factor(double *tile, double least)
{
    for (size_t first = 0; first < BAND_TILE; first += ACROSS) {
        for (size_t i = first / ROWS * ROWS; i < BAND_TILE; i += ROWS)
            subtract_block(tile + i, tile + first, 0, first, tile + BAND_TILE * first + i);
        for (size_t j = first; j < first + ACROSS; j++) {
            double *const column = tile + BAND_TILE * j;
            subtract_columns(tile, first, j, j, tile);
            if (!(column[j] > least))
                return false;
            const double root = sqrt(column[j]);
            for (size_t i = j; i < BAND_TILE; i++)
                column[i] /= root;
        }
    }
    return true;
}

const band_kernel FFD_BAND_KERNEL = {subtract, divide, factor};
