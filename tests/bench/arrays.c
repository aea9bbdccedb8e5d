/* What the calls of ffd/points.h take beside the kernels that they call.

     arrays [RUNS] [POINTS]     default 7 runs of 1,000,000 points, one thread

   Millions of points a second: median (least to greatest), in turns. Each pair of lines is the work by the
   internal functions (numbers to doubles, cells found, displacements, sums, rounding) and by one call, for a
   box lattice of 8^3 control points, degree 3; then one point a call. */
#include <ffd/points.h>

#include "../support/draw.h"
#include "base/memory/memory.h"
#include "base/system/clock.h"
#include "base/vector/array_kernel.h"
#include "deform/displacement.h"
#include "embed/locator.h"
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MOST_RUNS 99
#define ONE_BY_ONE 20000

typedef struct sample {
    ffd_lattice *lattice;
    ffd_locator *locator;
    ffd_embedding *embedding;
    size_t count;
    double *wide, *wide_out, *gradients;
    float *narrow, *narrow_out;
    ffd_location *locations; /* of a batch */
    ffd_run_options options;
    displacement_scratch scratch;
    double x[3 * DISPLACEMENT_BATCH], delta[3 * DISPLACEMENT_BATCH];
    uint8_t moves[DISPLACEMENT_BATCH], changed[DISPLACEMENT_BATCH];
    uint32_t which[DISPLACEMENT_BATCH];
} sample;

static ffd_span span_of(const sample *s, void *data, ffd_number type)
{
    return (ffd_span){.data = data, .count = s->count, .type = type};
}

static void check(ffd_status status, const ffd_error *error)
{
    if (!status)
        return;
    fprintf(stderr, "%s\n", error->message);
    exit(1);
}

/* What a call does, by hand. */
static void by_kernels(sample *s, bool narrow, bool gradients)
{
    const array_kernel *const arrays = ffd_array_kernel(FFD_ISA_AUTO);
    for (size_t first = 0; first < s->count; first += DISPLACEMENT_BATCH) {
        const size_t rest = s->count - first, count = rest < DISPLACEMENT_BATCH ? rest : DISPLACEMENT_BATCH;
        const displacement_batch batch = {.uvw = ffd_embedding_get_uvw(s->embedding) + 3 * first,
                                          .stride = 3 * sizeof(double),
                                          .which = s->which,
                                          .count = count,
                                          .delta = s->delta,
                                          .gradient = gradients ? s->gradients + 9 * first : NULL,
                                          .moves = s->moves};
        if (narrow)
            arrays->read_floats((const unsigned char *)(s->narrow + 3 * first), 3 * count, s->x);
        else
            memcpy(s->x, s->wide + 3 * first, 3 * count * sizeof *s->x);
        ffd_displacements(s->lattice, FFD_ISA_AUTO, &batch, &s->scratch);
        arrays->displace(s->delta, count, narrow ? FLT_MAX : DBL_MAX, s->x, s->changed);
        if (narrow)
            arrays->round(s->x, 3 * count, s->narrow_out + 3 * first);
        else
            memcpy(s->wide_out + 3 * first, s->x, 3 * count * sizeof *s->x);
    }
}

static void by_call(sample *s, bool narrow, bool gradients)
{
    ffd_error error;
    const ffd_number type = narrow ? FFD_FLOAT32 : FFD_FLOAT64;
    check(ffd_embedding_deform(s->embedding, s->lattice,
                               span_of(s, narrow ? (void *)s->narrow : s->wide, type),
                               span_of(s, narrow ? (void *)s->narrow_out : s->wide_out, type),
                               gradients ? s->gradients : NULL, &s->options, &error),
          &error);
}

static void find_by_locator(sample *s, bool narrow, bool gradients)
{
    ffd_error error;
    (void)narrow, (void)gradients;
    for (size_t first = 0; first < s->count; first += DISPLACEMENT_BATCH) {
        const size_t rest = s->count - first, count = rest < DISPLACEMENT_BATCH ? rest : DISPLACEMENT_BATCH;
        check(ffd_locator_find(s->locator, s->wide + 3 * first, count, s->locations, &error), &error);
        for (size_t i = 0; i < count; i++)
            memcpy(s->wide_out + 3 * (first + i), s->locations[i].uvw, 3 * sizeof *s->wide_out);
    }
}

static void embed(sample *s, bool narrow, bool gradients)
{
    ffd_embedding_desc desc;
    ffd_error error;
    (void)narrow, (void)gradients;
    ffd_embedding_destroy(&s->embedding);
    ffd_embedding_desc_init(&desc, sizeof desc);
    desc.lattice = s->lattice;
    desc.points = span_of(s, s->wide, FFD_FLOAT64);
    check(ffd_embedding_create(&desc, &s->options, &s->embedding, &error), &error);
}

static void call_one_by_one(sample *s, bool narrow, bool gradients)
{
    ffd_error error;
    const ffd_span all = span_of(s, s->wide, FFD_FLOAT64), out = span_of(s, s->wide_out, FFD_FLOAT64);
    (void)narrow, (void)gradients;
    for (uint32_t i = 0; i < ONE_BY_ONE && i < s->count; i++)
        check(ffd_embedding_deform_some(s->embedding, s->lattice, &i, 1, all, out, NULL, &s->options, &error),
              &error);
}

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void print(const char *what, size_t count, double *seconds, int runs)
{
    const double millions = (double)count / 1e6;
    qsort(seconds, (size_t)runs, sizeof *seconds, compare);
    printf("%s: %.3f (%.3f to %.3f)\n", what, millions / seconds[runs / 2], millions / seconds[runs - 1],
           millions / seconds[0]);
}

typedef struct task {
    const char *name;
    void (*run)(sample *s, bool narrow, bool gradients);
    bool narrow, gradients;
    size_t most; /* points, at most; 0: all */
} task;

/* Two tasks in turns. */
static void measure(sample *s, const task tasks[2], int runs)
{
    double seconds[2][MOST_RUNS];
    for (int r = -1; r < runs; r++)
        for (int t = 0; t < 2; t++) {
            const double start = ffd_clock_seconds();
            tasks[t].run(s, tasks[t].narrow, tasks[t].gradients);
            if (r >= 0)
                seconds[t][r] = ffd_clock_seconds() - start;
        }
    for (int t = 0; t < 2; t++)
        print(tasks[t].name, tasks[t].most && tasks[t].most < s->count ? tasks[t].most : s->count, seconds[t],
              runs);
}

/* On a wavy surface through the lattice, row by row, as the vertices of meshes lie. */
static void place_points(sample *s)
{
    const size_t side = (size_t)sqrt((double)s->count);
    for (size_t n = 0; n < s->count; n++) {
        const double x = (double)(n % side) / (double)side,
                     y = (double)(n / side) / (double)(s->count / side + 1);
        const double p[3] = {x, y, 0.5 + 0.4 * sin(20 * x) * cos(20 * y)};
        for (size_t c = 0; c < 3; c++) {
            s->wide[3 * n + c] = p[c];
            s->narrow[3 * n + c] = (float)p[c];
        }
    }
}

static void make_lattice(sample *s)
{
    ffd_lattice_arrays arrays;
    ffd_error error;
    double offsets[3 * 8 * 8 * 8];
    draw d = {7};
    ffd_lattice_arrays_init(&arrays, sizeof arrays);
    for (int a = 0; a < 3; a++) {
        arrays.size[a] = 8;
        arrays.box_max[a] = 1;
    }
    for (size_t i = 0; i < sizeof offsets / sizeof *offsets; i++)
        offsets[i] = draw_between(&d, -0.1, 0.1);
    check(ffd_lattice_from_arrays(&arrays, &s->lattice, &error), &error);
    check(ffd_lattice_set_offsets(s->lattice, NULL, 8 * 8 * 8, offsets, &error), &error);
    check(ffd_locator_create(s->lattice, &s->locator, &error), &error);
}

int main(int count, char **arguments)
{
    static const task pairs[][2] = {
        {{"float64: kernels", by_kernels, false, false, 0}, {"float64: one call", by_call, false, false, 0}},
        {{"float32: kernels", by_kernels, true, false, 0}, {"float32: one call", by_call, true, false, 0}},
        {{"float64, gradients: kernels", by_kernels, false, true, 0},
         {"float64, gradients: one call", by_call, false, true, 0}},
        {{"u,v,w: locator", find_by_locator, false, false, 0}, {"u,v,w: one call", embed, false, false, 0}},
        {{"float64: kernels", by_kernels, false, false, 0},
         {"float64: a point a call", call_one_by_one, false, false, ONE_BY_ONE}},
    };
    const int runs = count > 1 ? atoi(arguments[1]) : 7;
    sample *s = calloc(1, sizeof *s);
    if (!s || runs < 1 || runs > MOST_RUNS)
        return 2;
    s->count = count > 2 ? (size_t)strtoull(arguments[2], NULL, 10) : 1000000;
    s->wide = calloc(s->count, 3 * sizeof *s->wide);
    s->wide_out = calloc(s->count, 3 * sizeof *s->wide_out);
    s->narrow = calloc(s->count, 3 * sizeof *s->narrow);
    s->narrow_out = calloc(s->count, 3 * sizeof *s->narrow_out);
    s->gradients = calloc(s->count, 9 * sizeof *s->gradients);
    s->locations = calloc(DISPLACEMENT_BATCH, sizeof *s->locations);
    if (!s->wide || !s->wide_out || !s->narrow || !s->narrow_out || !s->gradients || !s->locations)
        return 2;
    for (uint32_t n = 0; n < DISPLACEMENT_BATCH; n++)
        s->which[n] = n;
    place_points(s);
    make_lattice(s);
    ffd_run_options_init(&s->options, sizeof s->options);
    s->options.threads = 1;
    embed(s, false, false);
    for (size_t p = 0; p < sizeof pairs / sizeof *pairs; p++) {
        ffd_displacement_scratch_clear(&s->scratch);
        measure(s, pairs[p], runs);
    }
    ffd_embedding_destroy(&s->embedding);
    ffd_locator_destroy(&s->locator);
    ffd_lattice_destroy(&s->lattice);
    free(s->wide);
    free(s->wide_out);
    free(s->narrow);
    free(s->narrow_out);
    free(s->gradients);
    free(s->locations);
    free(s);
    return 0;
}
