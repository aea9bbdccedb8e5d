/* test_border_cells.c - points of a curved lattice's border, known to a box with sides of very different
   lengths: inside where the box reaches the volume, outside where it does not. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/draw.h"
#include "../support/lattice_by_hand.h"
#include "../support/repetitions.h"
#include "base/vector/vec.h"
#include "embed/locator.h"
#include "mesh/rounding.h"
#include <ffd/embedding.h>
#include <stdint.h>

enum { POINTS = 250 };

/* Lattices that are nearly a grid: `points` a direction, of this degree; weights from 1 to `weight`; y is
   `thickness` of the others. */
typedef struct kind {
    size_t points;
    int degree;
    double weight, thickness;
} kind;

static const kind kinds[] = {{2, 1, 1, 1},  {2, 1, 2, 1},  {2, 1, 10, 1},     {2, 1, 50, 1},    {3, 2, 1, 1},
                             {3, 2, 50, 1}, {3, 1, 1, 1},  {3, 1, 50, 1},     {4, 1, 1, 1},     {4, 1, 50, 1},
                             {5, 3, 1, 1},  {5, 3, 50, 1}, {5, 3, 1e4, 1e-3}, {3, 2, 1e6, 1e-3}};
enum { KINDS = sizeof kinds / sizeof *kinds };

/* What was found of the points of all lattices of a kind. */
typedef struct figures {
    uint64_t points, outside, singular;
} figures;

static ffd_lattice *lattice_like(size_t points, int degree)
{
    knot_vector knots[3];
    for (int a = 0; a < 3; a++)
        assert_int_equal(ffd_knots_make(KNOTS_CLAMPED, degree, points, NULL, 0, "uvw"[a], &knots[a], NULL),
                         FFD_OK);
    return lattice_of_knots(knots);
}

static void finish(ffd_lattice *lattice)
{
    memcpy(lattice->deformed, lattice->rest, 3 * lattice->count * sizeof(double));
    assert_int_equal(finish_by_hand(lattice, NULL), FFD_OK);
}

/* A grid bent by up to 0.15 of a spacing, with each coordinate at its own distance from 0. */
static ffd_lattice *draw_lattice_at(draw *d, const kind *k, const double far[3], double spacing)
{
    ffd_lattice *lattice = lattice_like(k->points, k->degree);
    for (size_t n = 0; n < lattice->count; n++) {
        const size_t index[3] = {n % k->points, n / k->points % k->points, n / k->points / k->points};
        for (int a = 0; a < 3; a++)
            lattice->rest[3 * n + (size_t)a] = far[a] + spacing * (a == 1 ? k->thickness : 1) *
                                                            ((double)index[a] + draw_between(d, -0.15, 0.15));
    }
    if (k->weight > 1) {
        lattice_add_weights(lattice);
        for (size_t n = 0; n < lattice->count; n++)
            lattice->rest_weights[n] = lattice->deformed_weights[n] = pow(k->weight, draw_unit(d));
    }
    finish(lattice);
    return lattice;
}

/* A size of 0.1 to 100, and distances of up to 1e6. */
static ffd_lattice *draw_lattice(draw *d, const kind *k)
{
    double far[3], spacing = pow(10, draw_between(d, -1, 2)) / (double)(k->points - 1);
    for (int a = 0; a < 3; a++)
        far[a] = draw_between(d, -1, 1) * pow(10, draw_between(d, 0, 6));
    return draw_lattice_at(d, k, far, spacing);
}

/* The same, so far away that x and y are known to a small part of the thickness only, and so that its middle
   is at a y that is a float32: points of its border are stored as points in it or next to it. */
static ffd_lattice *draw_lattice_round_a_float(draw *d, const kind *k)
{
    const double spacing = pow(10, draw_between(d, -1, 1)) / (double)(k->points - 1);
    const double middle = (double)(float)(draw_between(d, 0.3, 1) * 1e6);
    const double far[3] = {draw_between(d, -1, 1) * 1e6,
                           middle - 0.5 * spacing * k->thickness * (double)(k->points - 1),
                           draw_between(d, -1, 1) * 10};
    return draw_lattice_at(d, k, far, spacing);
}

/* A turn about a random axis (unit quaternion), row by row. */
static void draw_turn(draw *d, double m[9])
{
    double q[4], length = 0;
    for (int i = 0; i < 4; i++) {
        q[i] = draw_between(d, -1, 1);
        length += q[i] * q[i];
    }
    for (int i = 0; i < 4; i++)
        q[i] /= sqrt(length);
    const double turn[9] = {1 - 2 * (q[2] * q[2] + q[3] * q[3]), 2 * (q[1] * q[2] - q[0] * q[3]),
                            2 * (q[1] * q[3] + q[0] * q[2]),     2 * (q[1] * q[2] + q[0] * q[3]),
                            1 - 2 * (q[1] * q[1] + q[3] * q[3]), 2 * (q[2] * q[3] - q[0] * q[1]),
                            2 * (q[1] * q[3] - q[0] * q[2]),     2 * (q[2] * q[3] + q[0] * q[1]),
                            1 - 2 * (q[1] * q[1] + q[2] * q[2])};
    memcpy(m, turn, sizeof turn);
}

/* The border's image of a random u,v,w, as a file holds it under a node with this matrix: p is what the
   nearest float32 in the node's space stands for, and rounding the bounds of all that it stands for. */
static void draw_image(draw *d, const ffd_lattice *lattice, const double matrix[9], double p[3],
                       double rounding[3])
{
    static const mesh_rounding floats = {.is_float = {true, true, true}};
    double uvw[3], inverse[9], local[3];
    for (int a = 0; a < 3; a++)
        uvw[a] = draw_int(d, 0, 5) == 0 ? draw_int(d, 0, 1) : draw_unit(d);
    uvw[draw_int(d, 0, 2)] = draw_int(d, 0, 1);
    ffd_lattice_evaluate(lattice, FFD_VOLUME_REST, uvw, p, NULL);
    assert_true(mat_invert(matrix, inverse));
    mat_apply(inverse, p, local);
    for (int a = 0; a < 3; a++)
        local[a] = (double)(float)local[a];
    ffd_rounding_cell(&floats, local, rounding);
    ffd_rounding_transform(matrix, rounding);
    mat_apply(matrix, local, p);
}

/* A point whose box holds the border's image of a random u,v,w, mostly near an edge or a corner of it. */
static void draw_box(draw *d, const ffd_lattice *lattice, double p[3], double half[3])
{
    double uvw[3];
    for (int a = 0; a < 3; a++)
        uvw[a] = draw_unit(d);
    uvw[draw_int(d, 0, 2)] = draw_int(d, 0, 1);
    ffd_lattice_evaluate(lattice, FFD_VOLUME_REST, uvw, p, NULL);
    for (int a = 0; a < 3; a++) {
        half[a] = lattice->diagonal * pow(10, draw_between(d, -7, -1));
        p[a] += half[a] * (draw_int(d, 0, 3) == 0 ? draw_between(d, -1, 1)
                           : draw_int(d, 0, 1)    ? 0.9999
                                                  : -0.9999);
    }
}

/* The image of a random u,v,w of an edge or a corner of the domain, which stands for itself. */
static void draw_edge(draw *d, const ffd_lattice *lattice, double p[3], double half[3])
{
    const int along = draw_int(d, 0, 2);
    double uvw[3];
    for (int a = 0; a < 3; a++) {
        uvw[a] = draw_int(d, 0, 1);
        half[a] = 0;
    }
    if (draw_int(d, 0, 1))
        uvw[along] = draw_unit(d);
    ffd_lattice_evaluate(lattice, FFD_VOLUME_REST, uvw, p, NULL);
}

typedef enum sample { FLOATS, TURNED_FLOATS, BOXES, EDGES } sample;

/* Destroys the lattice. */
static void try_points(draw *d, ffd_lattice *lattice, sample which, figures *found)
{
    static double xyz[3 * POINTS], rounding[3 * POINTS];
    static ffd_location locations[POINTS];
    ffd_locator *locator;
    double matrix[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    if (which == TURNED_FLOATS)
        draw_turn(d, matrix);
    for (int i = 0; i < POINTS; i++)
        if (which == BOXES)
            draw_box(d, lattice, xyz + 3 * i, rounding + 3 * i);
        else if (which == EDGES)
            draw_edge(d, lattice, xyz + 3 * i, rounding + 3 * i);
        else
            draw_image(d, lattice, matrix, xyz + 3 * i, rounding + 3 * i);
    const ffd_border_allowance allowance = {.rounding = rounding};
    assert_int_equal(ffd_locator_create(lattice, &locator, NULL), FFD_OK);
    assert_int_equal(ffd_locator_find_near(locator, xyz, POINTS, &allowance, locations, NULL), FFD_OK);
    for (int i = 0; i < POINTS; i++) {
        found->points++;
        found->outside += locations[i].status == FFD_VERTEX_OUTSIDE;
        found->singular += locations[i].status == FFD_VERTEX_SINGULAR;
    }
    ffd_locator_destroy(&locator);
    ffd_lattice_destroy(&lattice);
}

static double seconds_since(const struct timespec *start)
{
    struct timespec now;
    timespec_get(&now, TIME_UTC);
    return (double)(now.tv_sec - start->tv_sec) + 1e-9 * (double)(now.tv_nsec - start->tv_nsec);
}

static void boxes_that_reach_the_volume_are_inside(void **state)
{
    const char *const seconds = getenv("FFD_SECONDS");
    draw d = {draw_seed()};
    figures found[KINDS] = {{0}}, all = {0};
    struct timespec start;
    timespec_get(&start, TIME_UTC);
    const int lattices = repetitions(12);
    for (int i = 0; i < lattices || (seconds && seconds_since(&start) < atof(seconds)); i++)
        for (int k = 0; k < KINDS; k++)
            try_points(&d, draw_lattice(&d, &kinds[k]),
                       i % 4 == 3 ? TURNED_FLOATS
                       : i % 2    ? FLOATS
                                  : BOXES,
                       &found[k]);
    for (int k = 0; k < KINDS; k++) {
        printf("%zu points a direction, degree %d, weights to %g, thickness %g: of %llu, outside %llu, "
               "singular %llu\n",
               kinds[k].points, kinds[k].degree, kinds[k].weight, kinds[k].thickness,
               (unsigned long long)found[k].points, (unsigned long long)found[k].outside,
               (unsigned long long)found[k].singular);
        all.points += found[k].points;
        all.outside += found[k].outside;
        all.singular += found[k].singular;
    }
    assert_int_equal(all.outside, 0);
    assert_true(all.singular <= 3 + all.points / 10000);
    (void)state;
}

/* The tolerance of x and y, far from 0, is a sliver in u,v,w that may pass through many cells of the search.
 */
static void a_thin_lattice_round_a_number_of_the_file_decides_its_border(void **state)
{
    draw d = {draw_seed()};
    figures found = {0};
    const int lattices = repetitions(24);
    for (int i = 0; i < lattices; i++)
        try_points(&d, draw_lattice_round_a_float(&d, &kinds[KINDS - 1]), FLOATS, &found);
    printf("of %llu, outside %llu, singular %llu\n", (unsigned long long)found.points,
           (unsigned long long)found.outside, (unsigned long long)found.singular);
    assert_int_equal(found.outside, 0);
    assert_true(found.singular <= 3 + found.points / 500);
    (void)state;
}

/* The iteration may end beside the edge, a few tolerances from the point. Without the search that leaves
   regions by proofs only, seeds 1, 2 and 3 find points outside. */
static void an_edge_of_a_thin_lattice_round_a_number_of_the_file_is_not_outside(void **state)
{
    static const kind thin[] = {{3, 2, 50, 1e-3}, {3, 2, 1e6, 1e-3}, {5, 3, 1e4, 1e-3}};
    draw d = {draw_seed()};
    figures found = {0};
    const int lattices = repetitions(6);
    for (int i = 0; i < lattices; i++)
        try_points(&d, draw_lattice_round_a_float(&d, &thin[i % 3]), EDGES, &found);
    printf("of %llu, outside %llu, singular %llu\n", (unsigned long long)found.points,
           (unsigned long long)found.outside, (unsigned long long)found.singular);
    assert_int_equal(found.outside, 0);
    (void)state;
}

/* x = f(y,z) + u - 1 with f = -a y^2 - b z^2 + c y z: below each of its tangent planes where f is concave. */
static ffd_lattice *draw_dome(draw *d, double f[3])
{
    ffd_lattice *lattice = lattice_like(3, 2);
    f[0] = draw_between(d, 0.05, 0.3);
    f[1] = draw_between(d, 0.05, 0.3);
    f[2] = draw_between(d, -0.09, 0.09);
    for (size_t n = 0; n < lattice->count; n++) {
        /* The blossom of a product of two parameters at (0,0), (0,1), (1,1). */
        static const double square[3] = {0, 0, 1};
        const size_t i = n % 3, j = n / 3 % 3, k = n / 9;
        const double y = 0.5 * (double)j, z = 0.5 * (double)k;
        double *const p = lattice->rest + 3 * n;
        p[0] = -f[0] * square[j] - f[1] * square[k] + f[2] * y * z + 0.5 * (double)i - 1;
        p[1] = y;
        p[2] = z;
    }
    finish(lattice);
    return lattice;
}

/* The corner of a box that is nearest to the dome stands before a point of it or behind its tangent plane
   there. */
static void a_box_that_ends_before_the_tangent_plane_is_outside(void **state)
{
    draw d = {draw_seed()};
    const int domes = repetitions(200);
    for (int m = 0; m < domes; m++) {
        double f[3];
        ffd_lattice *lattice = draw_dome(&d, f);
        ffd_locator *locator;
        assert_int_equal(ffd_locator_create(lattice, &locator, NULL), FFD_OK);
        for (int i = 0; i < 40; i++) {
            const double y = draw_unit(&d), z = draw_unit(&d);
            const double foot[3] = {-f[0] * y * y - f[1] * z * z + f[2] * y * z, y, z};
            const double normal[3] = {1, 2 * f[0] * y - f[2] * z, 2 * f[1] * z - f[2] * y};
            double p[6], rounding[6];
            for (int a = 0; a < 3; a++) {
                const double half = pow(10, draw_between(&d, -7, -2));
                for (int more = 0; more < 2; more++) {
                    rounding[3 * more + a] = half;
                    p[3 * more + a] = foot[a] + half * (normal[a] < 0 ? -1 : 1) * (more ? 1.0001 : 0.9999);
                }
            }
            const ffd_border_allowance allowance = {.rounding = rounding};
            ffd_location found[2];
            assert_int_equal(ffd_locator_find_near(locator, p, 2, &allowance, found, NULL), FFD_OK);
            assert_int_equal(found[0].status, FFD_VERTEX_INSIDE);
            assert_int_equal(found[1].status, FFD_VERTEX_OUTSIDE);
        }
        ffd_locator_destroy(&locator);
        ffd_lattice_destroy(&lattice);
    }
    (void)state;
}

/* Boxes of which some make the search halve patches. */
static void each_failed_allocation_is_reported(void **state)
{
    draw d = {draw_seed()};
    const kind bent = {2, 1, 50, 1};
    ffd_lattice *lattice = draw_lattice(&d, &bent);
    ffd_locator *locator;
    long most = 0;
    assert_int_equal(ffd_locator_create(lattice, &locator, NULL), FFD_OK);
    for (int i = 0; i < 200; i++) {
        double p[3], half[3];
        ffd_location found, failed;
        draw_box(&d, lattice, p, half);
        const ffd_border_allowance allowance = {.rounding = half};
        assert_int_equal(ffd_locator_find_near(locator, p, 1, &allowance, &found, NULL), FFD_OK);
        ffd_status status = FFD_E_MEMORY;
        long failing = 0;
        for (; status; failing++) {
            assert_true(failing < 10000);
            ffd_alloc_fail_after(failing);
            status = ffd_locator_find_near(locator, p, 1, &allowance, &failed, NULL);
            ffd_alloc_fail_after(-1);
            assert_true(status == FFD_OK || status == FFD_E_MEMORY);
        }
        assert_memory_equal(failed.uvw, found.uvw, sizeof found.uvw);
        assert_int_equal(failed.status, found.status);
        most = failing > most ? failing : most;
    }
    assert_true(most > 10);
    ffd_locator_destroy(&locator);
    ffd_lattice_destroy(&lattice);
    (void)state;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(boxes_that_reach_the_volume_are_inside),
        cmocka_unit_test(a_thin_lattice_round_a_number_of_the_file_decides_its_border),
        cmocka_unit_test(an_edge_of_a_thin_lattice_round_a_number_of_the_file_is_not_outside),
        cmocka_unit_test(a_box_that_ends_before_the_tangent_plane_is_outside),
        cmocka_unit_test(each_failed_allocation_is_reported),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
