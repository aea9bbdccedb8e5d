/* How many points a second are displaced, with each instruction set of this processor, beside a plain copy of
   as many positions as floats.

     displacement [RUNS] [POINTS]     default 7 runs of 1,000,000 points, one thread

   Millions a second: median (least to greatest), of the displacement alone and with its gradient, for a box,
   where d uvw / d p is one for all, and for a lattice in general. First how many points a second there could
   be if a displacement were its multiplications and nothing else: of what it takes, they keep the processor
   longest. Then the kernels alone, with points of one cell side by side, in the cache; the same with u,v,w
   from floats and displacements to floats, through all memory; then with what a tile of a mesh costs beside
   them: the cells of the points are found, and the points of each brought together. These lie on a wavy
   surface through the lattice, row by row. */
#include "deform/displacement.h"
#include "../support/draw.h"
#include "../support/lattice_by_hand.h"
#include "base/system/clock.h"
#include "base/vector/array_kernel.h"
#include <assert.h>
#include <math.h>

#define MOST_RUNS 99
#define KERNEL_BATCH ((size_t)128) /* in and out, they fit the nearest cache */

static const char *const names[] = {"auto", "scalar", "sse2", "avx2", "avx512", "neon"};

typedef struct sample {
    ffd_lattice *lattice;
    size_t count;
    double *uvw;
    float *from, *to; /* 3 a point */
    displacement_scratch scratch;
    double delta[3 * DISPLACEMENT_BATCH], gradient[9 * DISPLACEMENT_BATCH];
    uint8_t moves[DISPLACEMENT_BATCH];
    uint32_t which[DISPLACEMENT_BATCH];
    ffd_isa isa;
    bool gradients;
} sample;

static ffd_lattice *make_lattice(size_t size, bool is_box)
{
    draw d = {7};
    knot_vector knots[3];
    for (int a = 0; a < 3; a++)
        if (ffd_knots_make(KNOTS_CLAMPED, 3, size, NULL, 0, "uvw"[a], &knots[a], NULL))
            abort();
    ffd_lattice *lattice = lattice_of_knots(knots);
    for (size_t n = 0; n < lattice->count; n++) {
        const size_t index[3] = {n % size, n / size % size, n / size / size};
        for (size_t a = 0; a < 3; a++) {
            lattice->rest[3 * n + a] = ffd_knots_greville(&lattice->knots[a], index[a]);
            lattice->deformed[3 * n + a] = lattice->rest[3 * n + a] + draw_between(&d, -0.1, 0.1);
        }
    }
    if (is_box) {
        lattice->form = REST_BOX_AFFINE;
        for (int i = 0; i < 9; i += 4)
            lattice->frame[i] = 1;
    }
    if (finish_by_hand(lattice, NULL))
        abort();
    return lattice;
}

static void place_points(sample *s)
{
    const size_t side = (size_t)sqrt((double)s->count);
    for (size_t n = 0; n < s->count; n++) {
        const double x = (double)(n % side) / (double)side,
                     y = (double)(n / side) / (double)(s->count / side + 1);
        s->uvw[3 * n] = x;
        s->uvw[3 * n + 1] = y;
        s->uvw[3 * n + 2] = 0.5 + 0.4 * sin(20 * x) * cos(20 * y);
    }
}

/* In the first cell of every lattice of up to 64^3 points: its width is 1/61 at least. */
static void place_floats(sample *s)
{
    for (size_t c = 0; c < 3 * s->count; c++)
        s->from[c] = (float)(s->uvw[c] / 61);
}

static void run_batches(sample *s)
{
    for (size_t first = 0; first < s->count; first += DISPLACEMENT_BATCH) {
        const size_t rest = s->count - first;
        const displacement_batch batch = {.uvw = s->uvw + 3 * first,
                                          .stride = 3 * sizeof(double),
                                          .which = s->which,
                                          .count = rest < DISPLACEMENT_BATCH ? rest : DISPLACEMENT_BATCH,
                                          .delta = s->delta,
                                          .gradient = s->gradients ? s->gradient : NULL,
                                          .moves = s->moves};
        ffd_displacements(s->lattice, s->isa, &batch, &s->scratch);
    }
}

/* The first cell, and points in it. */
typedef struct one_cell {
    kernel_cell cell;
    double uvw[3 * KERNEL_BATCH], numbers[2 * FIELD_NUMBERS + 1];
} one_cell;

static void begin_cell(const sample *s, one_cell *one)
{
    static const size_t number[3] = {0, 0, 0};
    const cell_use use = s->gradients ? CELL_GRADIENTS : CELL_VALUES;
    const knot_vector *const knots = s->lattice->knots;
    for (size_t c = 0; c < 3 * KERNEL_BATCH; c++)
        one->uvw[c] =
            knots[c % 3].t[3] + s->uvw[c % (3 * s->count)] * (knots[c % 3].t[4] - knots[c % 3].t[3]);
    if (ffd_displacement_cell_points(s->lattice, ffd_extraction_kernel_scalar, number, use, one->numbers)
            .kind != CELL_BENT)
        abort();
    ffd_displacement_cell_begin(s->lattice, number, use, one->numbers, &one->cell);
}

#define ROW(ISA, set, lanes) [FFD_ISA_##ISA] = ffd_kernel_##set,
static displacement_kernel *const kernels[] = {[FFD_ISA_SCALAR] = ffd_kernel_scalar, FOR_EACH_SIMD(ROW)};

/* Points [0, count) of a batch. */
static void run_kernel_once(sample *s, const one_cell *one, size_t count)
{
    const kernel_points points = {.uvw = one->uvw,
                                  .which = s->which,
                                  .count = count,
                                  .delta = s->delta,
                                  .gradient = s->gradients ? s->gradient : NULL,
                                  .jacobian = one->cell.rest.points ? s->scratch.jacobian : NULL};
    kernels[s->isa](&one->cell, &points);
}

/* As many points as there are, a batch at a time; a batch fits the cache. */
static void run_kernel(sample *s)
{
    one_cell one;
    begin_cell(s, &one);
    for (size_t first = 0, count; first < s->count; first += count) {
        count = s->count - first < KERNEL_BATCH ? s->count - first : KERNEL_BATCH;
        run_kernel_once(s, &one, count);
    }
}

/* The same from one array of floats to another. */
static void run_kernel_on_floats(sample *s)
{
    const array_kernel *const arrays = ffd_array_kernel(s->isa);
    one_cell one;
    begin_cell(s, &one);
    for (size_t first = 0, count; first < s->count; first += count) {
        count = s->count - first < KERNEL_BATCH ? s->count - first : KERNEL_BATCH;
        arrays->read_floats((const unsigned char *)(s->from + 3 * first), 3 * count, one.uvw);
        run_kernel_once(s, &one, count);
        arrays->round(s->delta, 3 * count, s->to + 3 * first);
    }
}

static void copy(sample *s)
{
    memcpy(s->to, s->from, 3 * s->count * sizeof *s->to);
}

#ifdef FFD_X86
/* What one displacement of degree 3 multiplies: 7 times for the functions of each direction, and with 64, 16
   and 4 vectors of three. As many chains as hide how long one multiplication takes, and fit the registers. */
#define PRODUCTS (3 * 7 + 3 * (64 + 16 + 4))
#define CHAINS 13
static_assert(PRODUCTS % CHAINS == 0, "every chain multiplies as often");

static volatile double multiplied_by = 1, multiplied;

#define MULTIPLY(name, width, instructions)                                                                  \
    __attribute__((target(instructions))) static void name(sample *s)                                        \
    {                                                                                                        \
        typedef double lanes __attribute__((vector_size(8 * (width))));                                      \
        const lanes factor = multiplied_by - (lanes){0};                                                     \
        lanes chain[CHAINS];                                                                                 \
        for (int c = 0; c < CHAINS; c++)                                                                     \
            chain[c] = factor;                                                                               \
        for (size_t n = 0; n < s->count; n += (width))                                                       \
            for (int turn = 0; turn < PRODUCTS / CHAINS; turn++)                                             \
                for (int c = 0; c < CHAINS; c++)                                                             \
                    chain[c] = chain[c] * factor;                                                            \
        for (int c = 0; c < CHAINS; c++)                                                                     \
            multiplied = chain[c][0];                                                                        \
    }

MULTIPLY(multiply_sse2, 2, "sse2")
MULTIPLY(multiply_avx2, 4, "avx2")
MULTIPLY(multiply_avx512, 8, "avx512f")
#endif

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void print_rate(size_t count, double *seconds, int runs)
{
    qsort(seconds, (size_t)runs, sizeof *seconds, compare);
    const double millions = (double)count / 1e6;
    printf(" %7.1f (%.1f to %.1f)", millions / seconds[runs / 2], millions / seconds[runs - 1],
           millions / seconds[0]);
}

static void measure(sample *s, void (*run)(sample *), int runs)
{
    double seconds[MOST_RUNS];
    run(s);
    for (int r = 0; r < runs; r++) {
        const double start = ffd_clock_seconds();
        run(s);
        seconds[r] = ffd_clock_seconds() - start;
    }
    print_rate(s->count, seconds, runs);
}

static void print_limits(sample *s, int runs)
{
#ifdef FFD_X86
    static void (*const multiply[])(sample *) = {
        [FFD_ISA_SSE2] = multiply_sse2, [FFD_ISA_AVX2] = multiply_avx2, [FFD_ISA_AVX512] = multiply_avx512};
    printf("multiplications alone, millions a second\n");
    for (ffd_isa isa = FFD_ISA_SSE2; isa <= FFD_ISA_AVX512; isa++)
        if (ffd_isa_available(isa)) {
            printf("  %-7s", names[isa]);
            measure(s, multiply[isa], runs);
            printf("\n");
        }
#else
    (void)s, (void)runs;
#endif
}

static void print_rates(sample *s, void (*run)(sample *), const char *what, int runs)
{
    printf("%s, millions a second\n", what);
    for (s->isa = FFD_ISA_SCALAR; s->isa <= FFD_ISA_NEON; s->isa++) {
        if (!ffd_isa_available(s->isa))
            continue;
        printf("  %-7s", names[s->isa]);
        for (int gradients = 0; gradients < 2; gradients++) {
            s->gradients = gradients;
            measure(s, run, runs);
        }
        printf("\n");
    }
}

int main(int count, char **arguments)
{
    const int runs = count > 1 ? atoi(arguments[1]) : 7;
    sample *s = calloc(1, sizeof *s);
    if (!s || runs < 1 || runs > MOST_RUNS)
        return 2;
    s->count = count > 2 ? (size_t)strtoull(arguments[2], NULL, 10) : 1000000;
    s->uvw = malloc(s->count * 3 * sizeof *s->uvw);
    s->from = calloc(s->count, 3 * sizeof *s->from);
    s->to = calloc(s->count, 3 * sizeof *s->to);
    if (!s->uvw || !s->from || !s->to)
        return 2;
    for (uint32_t n = 0; n < DISPLACEMENT_BATCH; n++)
        s->which[n] = n;
    place_points(s);
    place_floats(s);
    printf("copy     ");
    measure(s, copy, runs);
    printf("\n");
    print_limits(s, runs);
    for (size_t size = 8; size <= 64; size *= 8)
        for (int box = 1; box >= 0; box--) {
            s->lattice = make_lattice(size, box);
            ffd_displacement_scratch_clear(&s->scratch);
            if (size == 8) {
                print_rates(s, run_kernel, box ? "kernel alone, box" : "kernel alone, general", runs);
                print_rates(s, run_kernel_on_floats, box ? "kernel, floats, box" : "kernel, floats, general",
                            runs);
            }
            printf("%zu^3 ", size);
            print_rates(s, run_batches, box ? "box" : "general", runs);
            ffd_lattice_destroy(&s->lattice);
        }
    free(s->uvw);
    free(s->from);
    free(s->to);
    free(s);
    return 0;
}
