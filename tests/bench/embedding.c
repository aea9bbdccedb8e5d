/* Counts and times of finding u,v,w on lattices of many kinds, beside one evaluation of C with its Jacobian
   at the same places.

     embedding [RUNS] [POINTS]     default 5 runs of 100,000 points

   build   ms that the search structure takes in all: the locator, and every brick of cells
   evals   evaluations of C with its Jacobian a point: mean and greatest
   leaves  parts of cells that were looked into a point: mean and greatest
   us      microseconds a point with the structure made, one thread: median (least to greatest)
   ratio   of that to one evaluation of C with its Jacobian at the same u,v,w
   far     evaluations a point ten lattices away */
#include "../support/draw.h"
#include "../support/lattice_by_hand.h"
#include "base/system/clock.h"
#include "embed/cells/brick.h"
#include "embed/cells/cells.h"
#include "embed/locator.h"
#include <ffd/embedding.h>

#define TURN 6.283185307179586
#define MOST_RUNS 99

/* x of a place g in [0,1]^3, the control point's Greville abscissae. */
typedef void (*shape_function)(const double g[3], draw *random, double x[3]);

static void box(const double g[3], draw *random, double x[3])
{
    (void)random;
    for (int a = 0; a < 3; a++)
        x[a] = g[a];
}

static void uneven(const double g[3], draw *random, double x[3])
{
    (void)random;
    for (int a = 0; a < 3; a++)
        x[a] = g[a] + 0.1 * sin(3 * g[a]);
}

static void warp_by(double size, const double g[3], double x[3])
{
    x[0] = g[0] + size * sin(3 * g[1] + 1) * g[2];
    x[1] = g[1] + size * cos(4 * g[0] + g[2]);
    x[2] = g[2] + size * sin(2 * g[0] * g[1]);
}

static void warp(const double g[3], draw *random, double x[3])
{
    (void)random;
    warp_by(0.1, g, x);
}

static void strong_warp(const double g[3], draw *random, double x[3])
{
    (void)random;
    warp_by(0.2, g, x);
}

/* Radius 1 to 2, a turn of v. */
static void arc(double turns, const double g[3], double x[3])
{
    const double radius = 1 + g[0], angle = turns * TURN * g[1];
    x[0] = radius * cos(angle);
    x[1] = radius * sin(angle);
    x[2] = g[2];
}

static void bent_bar(const double g[3], draw *random, double x[3])
{
    (void)random;
    arc(0.7, g, x);
}

static void overlapping_bar(const double g[3], draw *random, double x[3])
{
    (void)random;
    arc(1.2, g, x);
}

static void ring(const double g[3], draw *random, double x[3])
{
    (void)random;
    arc(1, g, x);
}

static void cylinder(const double g[3], draw *random, double x[3])
{
    (void)random;
    const double angle = TURN * g[1];
    x[0] = g[0] * cos(angle);
    x[1] = g[0] * sin(angle);
    x[2] = g[2];
}

static void folded(const double g[3], draw *random, double x[3])
{
    for (int a = 0; a < 3; a++)
        x[a] = g[a] + 0.35 * (draw_unit(random) - 0.5);
}

typedef struct subject {
    const char *name;
    shape_function shape;
    size_t size[3];
    int degree;
    bool closed; /* in v */
    bool rational;
} subject;

static const subject subjects[] = {
    {"box 8x8x8, affine", box, {8, 8, 8}, 3, false, false},
    {"uneven box 8x8x8, separable", uneven, {8, 8, 8}, 3, false, false},
    {"smooth warp 8x8x8, degree 3", warp, {8, 8, 8}, 3, false, false},
    {"strong warp 8x8x8, degree 3", strong_warp, {8, 8, 8}, 3, false, false},
    {"smooth warp 8x8x8, degree 1", warp, {8, 8, 8}, 1, false, false},
    {"smooth warp 8x8x8, degree 2", warp, {8, 8, 8}, 2, false, false},
    {"smooth warp 12x12x12, degree 5", warp, {12, 12, 12}, 5, false, false},
    {"smooth warp 12x12x12, degree 9", warp, {12, 12, 12}, 9, false, false},
    {"smooth warp 8x8x8, rational", warp, {8, 8, 8}, 3, false, true},
    {"smooth warp 64x64x64, degree 3", warp, {64, 64, 64}, 3, false, false},
    {"bar bent by 252 degrees, 4x12x4", bent_bar, {4, 12, 4}, 3, false, false},
    {"bar bent by 432 degrees, 4x20x4", overlapping_bar, {4, 20, 4}, 3, false, false},
    {"ring closed in v, 4x12x4", ring, {4, 12, 4}, 3, true, false},
    {"cylinder with its axis, 4x12x4", cylinder, {4, 12, 4}, 3, true, false},
    {"random, folded 8x8x8", folded, {8, 8, 8}, 3, false, false},
};

static void stop(const ffd_error *error)
{
    fprintf(stderr, "%s\n", error->message);
    exit(1);
}

static ffd_lattice *make_lattice(const subject *of)
{
    knot_vector knots[3];
    ffd_error error;
    draw random = {1};
    for (int a = 0; a < 3; a++)
        if (ffd_knots_make(of->closed && a == 1 ? KNOTS_CLOSED : KNOTS_CLAMPED, of->degree, of->size[a], NULL,
                           0, "uvw"[a], &knots[a], &error))
            stop(&error);
    ffd_lattice *lattice = lattice_of_knots(knots);
    if (of->rational)
        lattice_add_weights(lattice);
    for (size_t n = 0; n < lattice->count; n++) {
        const size_t index[3] = {n % of->size[0], n / of->size[0] % of->size[1],
                                 n / of->size[0] / of->size[1]};
        double g[3];
        for (int a = 0; a < 3; a++)
            g[a] = ffd_knots_greville(&lattice->knots[a], index[a]);
        of->shape(g, &random, lattice->rest + 3 * n);
        if (of->rational)
            lattice->rest_weights[n] = lattice->deformed_weights[n] = 1 + 0.5 * draw_unit(&random);
    }
    memcpy(lattice->deformed, lattice->rest, lattice->count * 3 * sizeof(double));
    if (finish_by_hand(lattice, &error))
        stop(&error);
    return lattice;
}

typedef struct counts {
    double evaluations, leaves;
    unsigned most_evaluations, most_leaves;
    size_t status[FFD_VERTEX_STATUS_COUNT];
} counts;

static counts count_up(const ffd_location *found, size_t points)
{
    counts sum = {0, 0, 0, 0, {0}};
    for (size_t i = 0; i < points; i++) {
        sum.evaluations += found[i].evaluations;
        sum.leaves += found[i].leaves;
        if (found[i].evaluations > sum.most_evaluations)
            sum.most_evaluations = found[i].evaluations;
        if (found[i].leaves > sum.most_leaves)
            sum.most_leaves = found[i].leaves;
        sum.status[found[i].status]++;
    }
    sum.evaluations /= (double)points;
    sum.leaves /= (double)points;
    return sum;
}

static int compare_numbers(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y;
}

/* Seconds for a locator with all its bricks, which are otherwise made when a point first needs them. */
static double build_all(const ffd_lattice *lattice, ffd_locator **locator)
{
    ffd_error error;
    own_bricks own;
    memset(&own, 0, sizeof own);
    const double start = ffd_clock_seconds();
    if (ffd_locator_create(lattice, locator, &error))
        stop(&error);
    const cell_search *cells = (*locator)->cells;
    const size_t count = cells ? cells->bricks[0] * cells->bricks[1] * cells->bricks[2] : 0;
    for (size_t i = 0; i < count; i++) {
        const cell_brick *brick;
        if (ffd_cells_brick(*locator, (uint32_t)i, &own, &brick, &error))
            stop(&error);
    }
    const double seconds = ffd_clock_seconds() - start;
    ffd_own_bricks_free(&own);
    return seconds;
}

static double find(const ffd_locator *locator, const double *xyz, size_t points, ffd_location *found)
{
    ffd_error error;
    const double start = ffd_clock_seconds();
    if (ffd_locator_find(locator, xyz, points, found, &error))
        stop(&error);
    return ffd_clock_seconds() - start;
}

static double evaluate(const ffd_lattice *lattice, const double *uvw, size_t points, double *xyz)
{
    double jacobian[9], sum = 0;
    const double start = ffd_clock_seconds();
    for (size_t i = 0; i < points; i++) {
        ffd_lattice_evaluate(lattice, FFD_VOLUME_REST, uvw + 3 * i, xyz + 3 * i, jacobian);
        sum += jacobian[0];
    }
    const double seconds = ffd_clock_seconds() - start;
    return sum == HUGE_VAL ? 0 : seconds; /* so that the Jacobians are needed */
}

static void measure(const subject *of, int runs, size_t points)
{
    ffd_lattice *lattice = make_lattice(of);
    double *uvw = ffd_alloc(points, 3 * sizeof(double)), *xyz = ffd_alloc(points, 3 * sizeof(double)),
           *far = ffd_alloc(points, 3 * sizeof(double));
    ffd_location *found = ffd_alloc(points, sizeof *found);
    double build[MOST_RUNS], time[MOST_RUNS], ratio[MOST_RUNS];
    draw random = {2};
    if (!uvw || !xyz || !far || !found)
        exit(1);
    for (size_t i = 0; i < 3 * points; i++)
        uvw[i] = draw_unit(&random);
    evaluate(lattice, uvw, points, xyz);
    for (size_t i = 0; i < 3 * points; i++)
        far[i] = xyz[i] + 10;
    for (int run = 0; run < runs; run++) {
        ffd_locator *locator;
        build[run] = 1e3 * build_all(lattice, &locator);
        const double seconds = find(locator, xyz, points, found);
        time[run] = 1e6 * seconds / (double)points;
        ratio[run] = seconds / evaluate(lattice, uvw, points, xyz);
        if (run + 1 == runs) {
            const counts near = count_up(found, points);
            find(locator, far, points, found);
            const counts away = count_up(found, points);
            qsort(build, (size_t)runs, sizeof *build, compare_numbers);
            qsort(time, (size_t)runs, sizeof *time, compare_numbers);
            qsort(ratio, (size_t)runs, sizeof *ratio, compare_numbers);
            printf("%-32s %9.2f %7.2f %5u %7.2f %4u %8.3f (%.3f to %.3f) %6.1f %5.2f   %zu/%zu/%zu/%zu\n",
                   of->name, build[runs / 2], near.evaluations, near.most_evaluations, near.leaves,
                   near.most_leaves, time[runs / 2], time[0], time[runs - 1], ratio[runs / 2],
                   away.evaluations, near.status[FFD_VERTEX_INSIDE], near.status[FFD_VERTEX_OUTSIDE],
                   near.status[FFD_VERTEX_MULTIPLE], near.status[FFD_VERTEX_SINGULAR]);
            fflush(stdout);
        }
        ffd_locator_destroy(&locator);
    }
    ffd_free(uvw);
    ffd_free(xyz);
    ffd_free(far);
    ffd_free(found);
    ffd_lattice_destroy(&lattice);
}

int main(int argc, char **argv)
{
    const long runs = argc > 1 ? strtol(argv[1], NULL, 10) : 5,
               points = argc > 2 ? strtol(argv[2], NULL, 10) : 100000;
    if (runs < 1 || runs > MOST_RUNS || points < 1 || points > 10000000) {
        fprintf(stderr, "usage: embedding [RUNS, 1 to %d] [POINTS, 1 to 10000000]\n", MOST_RUNS);
        return 2;
    }
    printf("%-32s %9s %13s %12s %27s %6s %5s   %s\n", "lattice", "build ms", "evals mean/max", "leaves",
           "us a point", "ratio", "far", "inside/outside/multiple/singular");
    for (size_t i = 0; i < sizeof subjects / sizeof *subjects; i++)
        measure(&subjects[i], (int)runs, (size_t)points);
    return 0;
}
