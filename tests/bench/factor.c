/* How fast the band matrices of fits are factored, beside a loop of multiplications and additions that stays
   in registers, of the same instruction set.

     factor [RUNS] [SIDE]...     default 5 runs of lattices of 8^3, 16^3, 24^3 control points, cubic

   Thousands of millions of multiplications and additions a second: median (least to greatest). A factor of n
   rows with reach b counts n b^2, as the report of a fit does: half multiplications, half subtractions. */
#include "base/system/clock.h"
#include "fit/band.h"
#include <assert.h>
#include <stdio.h>
#include <stdlib.h>

#define MOST_RUNS 99
#define DEGREE 3

static const char *const names[] = {"auto", "scalar", "sse2", "avx2", "avx512", "neon"};

/* As many chains as hide how long a multiplication and an addition take, and fit the registers. */
#define CHAINS 12
#define TURNS 4000000

static volatile double one = 1, kept;

/* Returns the numbers of each register. */
#define DEFINE_LOOP(name, width, attribute)                                                                  \
    attribute static size_t name(void)                                                                       \
    {                                                                                                        \
        typedef double lanes __attribute__((vector_size(8 * (width))));                                      \
        const lanes factor = one - (lanes){0}, term = one - (lanes){0};                                      \
        lanes chain[CHAINS];                                                                                 \
        for (int c = 0; c < CHAINS; c++)                                                                     \
            chain[c] = factor * c;                                                                           \
        for (size_t turn = 0; turn < TURNS; turn++)                                                          \
            for (int c = 0; c < CHAINS; c++)                                                                 \
                chain[c] = chain[c] * factor + term;                                                         \
        for (int c = 0; c < CHAINS; c++)                                                                     \
            kept = chain[c][0];                                                                              \
        return width;                                                                                        \
    }

#ifdef FFD_X86
DEFINE_LOOP(loop_sse2, 2, __attribute__((target("sse2"))))
DEFINE_LOOP(loop_avx2, 4, __attribute__((target("avx2"))))
DEFINE_LOOP(loop_avx512, 8, __attribute__((target("avx512f"))))
#endif
DEFINE_LOOP(loop_neon, 2, )

static size_t (*const loops[])(void) = {
#ifdef FFD_X86
    [FFD_ISA_SSE2] = loop_sse2,
    [FFD_ISA_AVX2] = loop_avx2,
    [FFD_ISA_AVX512] = loop_avx512,
#endif
    [FFD_ISA_NEON] = loop_neon};

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void print_rate(const char *what, double operations, double *seconds, int runs)
{
    qsort(seconds, (size_t)runs, sizeof *seconds, compare);
    printf("%s: %.2f (%.2f to %.2f)\n", what, operations / 1e9 / seconds[runs / 2],
           operations / 1e9 / seconds[runs - 1], operations / 1e9 / seconds[0]);
}

static void print_loop(ffd_isa isa, int runs)
{
    double seconds[MOST_RUNS];
    size_t width = 0;
    char what[40];
    for (int r = 0; r < runs; r++) {
        const double start = ffd_clock_seconds();
        width = loops[isa]();
        seconds[r] = ffd_clock_seconds() - start;
    }
    snprintf(what, sizeof what, "registers, %s", names[isa]);
    print_rate(what, 2.0 * TURNS * CHAINS * (double)width, seconds, runs);
}

/* Entries that differ, and a diagonal that is larger than the sum of the others of its row. */
static void fill(band_matrix *band)
{
    ffd_band_clear(band, 1);
    for (size_t j = 0; j < band->n; j++) {
        const size_t end = band->n - j > band->reach ? j + band->reach + 1 : band->n;
        *ffd_band_entry(band, j, j) = (double)(2 * band->reach + 1);
        for (size_t i = j + 1; i < end; i++)
            *ffd_band_entry(band, i, j) = (double)((i * 7 + j * 13) % 17) / 17 - 0.5;
    }
}

static void print_factor(size_t side, ffd_isa isa, int threads, int runs)
{
    const size_t n = side * side * side, reach = DEGREE * (side * side + side + 1);
    const band_run run = {.isa = isa, .threads = threads};
    double seconds[MOST_RUNS];
    band_matrix band;
    char what[80];
    if (ffd_band_make(n, reach, &band, NULL))
        abort();
    for (int r = 0; r < runs; r++) {
        bool is_positive;
        fill(&band);
        const double start = ffd_clock_seconds();
        if (ffd_band_factor(&band, &run, &is_positive, NULL) || !is_positive)
            abort();
        seconds[r] = ffd_clock_seconds() - start;
    }
    ffd_band_free(&band);
    snprintf(what, sizeof what, "%zu^3, %s, %d %s", side, names[isa], threads,
             threads == 1 ? "thread" : "threads");
    print_rate(what, (double)n * (double)reach * (double)reach, seconds, runs);
}

int main(int count, char **arguments)
{
    static const size_t usual[] = {8, 16, 24};
    const int runs = count > 1 ? atoi(arguments[1]) : 5;
    const int sides = count > 2 ? count - 2 : (int)(sizeof usual / sizeof *usual);
    if (runs < 1 || runs > MOST_RUNS)
        return 2;
    for (ffd_isa isa = FFD_ISA_SSE2; isa <= FFD_ISA_NEON; isa++) {
        if (!ffd_isa_available(isa))
            continue;
        print_loop(isa, runs);
        for (int s = 0; s < sides; s++)
            for (int threads = 1; threads <= 2; threads++)
                print_factor(count > 2 ? (size_t)strtoull(arguments[2 + s], NULL, 10) : usual[s], isa,
                             threads, runs);
    }
    return 0;
}
