/* test_quality.c - flipped faces, areas, volumes, deviation of straight edges from the deformed surface. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/draw.h"
#include "../support/repetitions.h"
#include "base/memory/memory.h"
#include "base/vector/vec.h"
#include "job/chain/chain_apply.h"
#include "job/measure/edge_list.h"
#include "job/measure/extent.h"
#include "job/measure/quality.h"
#include "job/measure/quality_edges.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MOST_LINKS 2

/* A mesh, and its vertices deformed by a chain of lattices. */
typedef struct sample {
    mesh_faces faces;
    double *deformed, *gradients;
    chain_link links[MOST_LINKS];
    lattice_chain chain;
} sample;

static void *checked(void *block)
{
    assert_non_null(block);
    return block;
}

static void add_lattice(sample *s, const char *json)
{
    ffd_error error = {0};
    chain_link *link = &s->links[s->chain.count++];
    assert_true(s->chain.count <= MOST_LINKS);
    if (ffd_lattice_parse(json, strlen(json), "test.json", &link->lattice, &error) ||
        ffd_locator_create(link->lattice, &link->locator, &error))
        fail_msg("%s %s", error.pointer, error.message);
    s->chain.links = s->links;
}

static void set_mesh(sample *s, size_t vertices, const double *positions, size_t faces,
                     size_t corners_of_face, const uint32_t *corners)
{
    const size_t count = faces * corners_of_face;
    s->faces = (mesh_faces){.vertex_count = vertices, .face_count = faces};
    s->faces.positions = checked(ffd_alloc(vertices, 3 * sizeof(double)));
    s->faces.start = checked(ffd_alloc(faces + 1, sizeof(size_t)));
    s->faces.corners = checked(ffd_alloc(count, sizeof(uint32_t)));
    if (vertices)
        memcpy(s->faces.positions, positions, 3 * vertices * sizeof(double));
    for (size_t f = 0; f <= faces; f++)
        s->faces.start[f] = f * corners_of_face;
    if (count)
        memcpy(s->faces.corners, corners, count * sizeof(uint32_t));
}

static void apply(const lattice_chain *chain, double *x, size_t count, double *gradients)
{
    chain_scratch *scratch = checked(ffd_alloc_zero(1, sizeof *scratch));
    point_outcome *outcomes = checked(ffd_alloc(CHAIN_RUN, sizeof *outcomes));
    double *delta = checked(ffd_alloc(CHAIN_RUN, 3 * sizeof *delta));
    for (size_t first = 0; first < count; first += CHAIN_RUN) {
        const size_t size = count - first < CHAIN_RUN ? count - first : CHAIN_RUN;
        chain_run run = {.x = x + 3 * first,
                         .count = size,
                         .scratch = scratch,
                         .delta = delta,
                         .gradient = gradients ? gradients + 9 * first : NULL,
                         .outcomes = outcomes};
        assert_int_equal(ffd_chain_apply(chain, chain->count, &run, NULL), FFD_OK);
    }
    ffd_free(scratch);
    ffd_free(delta);
    ffd_free(outcomes);
}

static void deform(sample *s)
{
    const size_t count = s->faces.vertex_count;
    s->deformed = checked(ffd_alloc(count, 3 * sizeof(double)));
    s->gradients = checked(ffd_alloc(count, 9 * sizeof(double)));
    memcpy(s->deformed, s->faces.positions, 3 * count * sizeof(double));
    apply(&s->chain, s->deformed, count, s->gradients);
}

static uint64_t flipped(const sample *s)
{
    const face_motion motion = {s->faces.positions, s->deformed, s->gradients, NULL};
    return ffd_quality_flipped(&s->faces, &motion);
}

static edge_quality measure(const sample *s, int threads)
{
    edge_quality quality;
    memset(&quality, 0xff, sizeof quality);
    assert_int_equal(ffd_quality_edges(NULL, MESH_STORED, &s->faces, s->deformed, &s->chain, NULL, NULL,
                                       threads, &quality, NULL),
                     FFD_OK);
    return quality;
}

static void clear_mesh(sample *s)
{
    ffd_mesh_faces_free(&s->faces);
    ffd_free(s->deformed);
    ffd_free(s->gradients);
    s->deformed = s->gradients = NULL;
}

static void clear(sample *s)
{
    clear_mesh(s);
    for (size_t k = 0; k < s->chain.count; k++) {
        ffd_locator_destroy(&s->links[k].locator);
        ffd_lattice_destroy(&s->links[k].lattice);
    }
    memset(s, 0, sizeof *s);
}

static void check_near(double value, double expected, double allowed)
{
    if (!(fabs(value - expected) <= allowed))
        fail_msg("%.17g is not %.17g", value, expected);
}

/* The largest distance of 10,000 deformed points of an edge from the straight line between its deformed
   ends. */
static double brute_force(const sample *s, uint32_t from, uint32_t to)
{
    enum { COUNT = 10001 };
    const double *a = s->faces.positions + 3 * from, *b = s->faces.positions + 3 * to;
    const double *start = s->deformed + 3 * from, *end = s->deformed + 3 * to;
    double *x = checked(ffd_alloc(COUNT, 3 * sizeof(double))), result = 0, chord[3];
    for (int i = 0; i < COUNT; i++)
        for (int c = 0; c < 3; c++)
            x[3 * i + c] = a[c] + i / (COUNT - 1.0) * (b[c] - a[c]);
    apply(&s->chain, x, COUNT, NULL);
    for (int c = 0; c < 3; c++)
        chord[c] = end[c] - start[c];
    for (int i = 0; i < COUNT; i++) {
        double away[3], t;
        for (int c = 0; c < 3; c++)
            away[c] = x[3 * i + c] - start[c];
        t = fmin(fmax(vec_dot(away, chord) / vec_dot(chord, chord), 0), 1);
        for (int c = 0; c < 3; c++)
            away[c] -= t * chord[c];
        result = fmax(result, vec_length(away));
    }
    ffd_free(x);
    return result;
}

static const double cube[24] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 0, 1, 1, 0, 1, 0, 1, 1, 1, 1, 1};
static const uint32_t cube_corners[24] = {0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4,
                                          2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5};

/* The square [lo, hi]^2 at z = 0.5 as n x n squares, each of two triangles: 2 n n faces. */
static void set_grid(sample *s, size_t n, double lo, double hi)
{
    const size_t side = n + 1;
    double *positions = checked(ffd_alloc(side * side, 3 * sizeof(double)));
    uint32_t *corners = checked(ffd_alloc(6 * n * n, sizeof(uint32_t))), *next = corners;
    for (size_t i = 0; i < side * side; i++) {
        positions[3 * i] = lo + (hi - lo) * (double)(i % side) / (double)n;
        positions[3 * i + 1] = lo + (hi - lo) * (double)(i / side) / (double)n;
        positions[3 * i + 2] = 0.5;
    }
    for (size_t i = 0; i < n * n; i++) {
        const uint32_t a = (uint32_t)(i % n + side * (i / n)), c = a + (uint32_t)side;
        const uint32_t two[6] = {a, a + 1, c + 1, a, c + 1, c};
        memcpy(next, two, sizeof two);
        next += 6;
    }
    set_mesh(s, side * side, positions, 2 * n * n, 3, corners);
    ffd_free(positions);
    ffd_free(corners);
}

#define BOX(size, degree, max, moves)                                                                        \
    "{\"format\": \"ffd-lattice\", \"version\": 1, \"size\": " size ", \"degree\": " degree                  \
    ", \"rest\": {\"box\": {\"min\": [-0.5, -0.5, -0.5], \"max\": " max "}}, \"moves\": [" moves "]}"
#define CUBE(moves) BOX("[4, 4, 4]", "[3, 3, 3]", "[1.5, 1.5, 1.5]", moves)

static void a_translation_bends_no_edge_and_flips_no_face(void **state)
{
    sample s = {0};
    add_lattice(&s, CUBE("{\"by\": [0.3, -7, 11.1]}"));
    set_mesh(&s, 8, cube, 6, 4, cube_corners);
    deform(&s);
    const edge_quality quality = measure(&s, 1);
    assert_int_equal(quality.edges, 12);
    check_near(quality.deviation_max, 0, 1e-14);
    check_near(quality.deviation_mean, 0, 1e-14);
    assert_int_equal(flipped(&s), 0);
    clear(&s);

    add_lattice(&s, CUBE("{\"by\": [0.3, -7, 11.1]}"));
    set_grid(&s, 10, 0, 1);
    deform(&s);
    check_near(measure(&s, 1).deviation_max, 0, 1e-14);
    assert_int_equal(measure(&s, 1).edges, 320);
    assert_int_equal(flipped(&s), 0);
    clear(&s);
    (void)state;
}

/* For slanted edges, whose inner points are rounded, the deviation is exactly 0 where nothing moves. */
static void edges_that_do_not_move_are_exactly_straight(void **state)
{
    sample s = {0};
    const double positions[9] = {0.1, 0.2, 0.3, 0.7, 0.9, 0.31, -0.4, 1.3, 0.77};
    const uint32_t corners[3] = {2, 1, 0};
    add_lattice(&s, CUBE(""));
    set_mesh(&s, 3, positions, 1, 3, corners);
    deform(&s);
    const edge_quality quality = measure(&s, 1);
    assert_int_equal(quality.edges, 3);
    assert_true(quality.deviation_max == 0 && quality.deviation_mean == 0);
    assert_int_equal(quality.worst[0], 0);
    assert_int_equal(quality.worst[1], 1);
    assert_int_equal(flipped(&s), 0);
    clear(&s);
    (void)state;
}

/* z rises by 2u(1-u), u = (x + 0.5)/4: a parabola of sagitta 0.5; and an edge over a quarter of it. */
static void an_edge_on_a_parabola_deviates_by_its_sagitta(void **state)
{
    sample s = {0};
    const double positions[12] = {-0.5, 0, 0, 3.5, 0, 0, 0.5, 1, 0, 1.5, 1, 0};
    const uint32_t corners[4] = {0, 1, 2, 3};
    add_lattice(&s, BOX("[3, 2, 2]", "[2, 1, 1]", "[3.5, 1.5, 1.5]",
                        "{\"at\": [1, \"all\", \"all\"], \"by\": [0, 0, 1]}"));
    set_mesh(&s, 4, positions, 2, 2, corners);
    deform(&s);
    const edge_quality quality = measure(&s, 1);
    assert_int_equal(quality.edges, 2);
    check_near(quality.deviation_max, 0.5, 1e-14);
    assert_int_equal(quality.worst[0], 0);
    assert_int_equal(quality.worst[1], 1);
    /* The other one: 2u(1-u) from 1/4 to 1/2. The point at t is 1/8 t(1-t) above a chord that rises from 3/8
       to 1/2 over a length of 1. */
    check_near(quality.deviation_mean, (0.5 + 1 / 32.0 / sqrt(1 + 1 / 64.0)) / 2, 1e-14);
    clear(&s);
    (void)state;
}

/* A bar on a circular arc of 60 degrees: sagitta R (1 - cos 30 degrees), R = L / angle. */
static void an_edge_on_an_arc_deviates_by_its_sagitta(void **state)
{
    sample s = {0};
    const double positions[6] = {0, 0, 0, 10, 0, 0}, radius = 10 / (3.14159265358979323846 / 3);
    const uint32_t corners[2] = {1, 0};
    add_lattice(
        &s, "{\"format\": \"ffd-lattice\", \"version\": 1, \"size\": [50, 4, 4],"
            "\"rest\": {\"box\": {\"min\": [0, -1, -1], \"max\": [10, 1, 1]}}, \"moves\":"
            "[{\"bend\": {\"axis\": \"x\", \"toward\": [0, 0, 1], \"degrees\": 60, \"about\": [0, 0, 0]}}]}");
    set_mesh(&s, 2, positions, 1, 2, corners);
    deform(&s);
    const double sagitta = radius * (1 - sqrt(0.75));
    check_near(measure(&s, 1).deviation_max, sagitta, 1e-3 * sagitta);
    clear(&s);
    (void)state;
}

/* Eight cubic Bezier pieces along x, each of length 1; only a point inside the fifth one moves. */
static void a_bump_inside_one_span_is_found(void **state)
{
    sample s = {0};
    const double positions[12] = {0, 0.5, 0.5, 8, 0.5, 0.5, 0.1, 0.3, 0.2, 7.7, 0.8, 0.6};
    const uint32_t corners[4] = {0, 1, 2, 3};
    for (int point = 13; point <= 14; point++) {
        char json[1024];
        snprintf(json, sizeof json,
                 "{\"format\": \"ffd-lattice\", \"version\": 1, \"size\": [25, 2, 2], \"degree\": [3, 1, 1],"
                 "\"knots\": [[0,0,0,0,1,1,1,2,2,2,3,3,3,4,4,4,5,5,5,6,6,6,7,7,7,8,8,8,8], \"clamped\", "
                 "\"clamped\"], \"rest\": {\"box\": {\"min\": [0, 0, 0], \"max\": [8, 1, 1]}},"
                 "\"moves\": [{\"at\": [%d, \"all\", \"all\"], \"by\": [0, 0.2, 1]}]}",
                 point);
        add_lattice(&s, json);
        set_mesh(&s, 4, positions, 2, 2, corners);
        deform(&s);
        const edge_quality quality = measure(&s, 1);
        /* 3 t (1-t)^2 has its maximum 4/9 at t = 1/3 */
        const double peak = 4 / 9.0 * sqrt(1.04), straight = brute_force(&s, 0, 1),
                     oblique = brute_force(&s, 2, 3);
        check_near(straight, peak, 1e-5);
        assert_true(quality.deviation_max <= fmax(straight, oblique) * (1 + 1e-12));
        assert_true(quality.deviation_max >= 0.97 * fmax(straight, oblique));
        check_near(quality.deviation_mean, (straight + oblique) / 2, 0.03 * peak);
        clear(&s);
    }
    (void)state;
}

/* Edges hundreds of times as long as the lattice are sampled where they pass it: the bump of height 0.3
   (3/4)^3 in its middle is found wherever it is along the edge. */
static void a_bump_on_a_very_long_edge_is_found(void **state)
{
    for (int shift = 0; shift < 8; shift++) {
        sample s = {0};
        const double from = -180 - 37.3 * shift;
        const double positions[9] = {from, 0.5, 0.5, 220.3 + 11 * shift, 0.5, 0.5, 0.5, -1, 0.5};
        const uint32_t corners[3] = {0, 1, 2};
        add_lattice(&s, "{\"format\": \"ffd-lattice\", \"version\": 1, \"size\": [4, 4, 4],"
                        "\"rest\": {\"box\": {\"min\": [0, 0, 0], \"max\": [1, 1, 1]}},"
                        "\"moves\": [{\"at\": [[1, 2], [1, 2], [1, 2]], \"by\": [0, 0.3, 0]}]}");
        set_mesh(&s, 3, positions, 1, 3, corners);
        deform(&s);
        check_near(measure(&s, 1).deviation_max, 0.3 * 27 / 64, 1e-3);
        clear(&s);
    }
    (void)state;
}

/* Adds a lattice over [lo, hi]^3 with random degrees (from lowest_degree on) and sizes, every point moved. */
static void add_random_lattice(sample *s, draw *d, int lowest_degree, double lo, double hi)
{
    static char json[1 << 16];
    size_t used = 0;
    int size[3], degree[3];
    for (int a = 0; a < 3; a++) {
        degree[a] = draw_int(d, lowest_degree, 4);
        size[a] = degree[a] + draw_int(d, 1, 4);
    }
    used +=
        (size_t)snprintf(json, sizeof json,
                         "{\"format\": \"ffd-lattice\", \"version\": 1, \"size\": [%d, %d, %d], "
                         "\"degree\": [%d, %d, %d], \"rest\": {\"box\": {\"min\": [%g, %g, %g], "
                         "\"max\": [%g, %g, %g]}}, \"moves\": [",
                         size[0], size[1], size[2], degree[0], degree[1], degree[2], lo, lo, lo, hi, hi, hi);
    for (int k = 0; k < size[2]; k++)
        for (int j = 0; j < size[1]; j++)
            for (int i = 0; i < size[0]; i++) {
                used += (size_t)snprintf(json + used, sizeof json - used,
                                         "%s{\"at\": [%d, %d, %d], \"by\": [%.3f, %.3f, %.3f]}",
                                         i + j + k ? "," : "", i, j, k, draw_between(d, -0.1, 0.1),
                                         draw_between(d, -0.1, 0.1), draw_between(d, -0.1, 0.1));
                assert_true(used < sizeof json - 4);
            }
    snprintf(json + used, sizeof json - used, "]}");
    add_lattice(s, json);
}

/* Draws an edge in the unit cube, of any length. */
static void draw_edge(draw *d, double positions[6])
{
    const double reach = draw_between(d, 0.02, 0.5);
    for (int a = 0; a < 3; a++) {
        const double middle = draw_between(d, reach, 1 - reach);
        positions[a] = middle + draw_between(d, -reach, reach);
        positions[3 + a] = middle + draw_between(d, -reach, reach);
    }
}

/* The smallest ratio of the deviation found to the true one, over edges in random lattices. The second
   lattice covers everything to which the first moves the unit cube. */
static double least_found(draw *d, int rounds, int lowest_degree, bool two_links)
{
    const uint32_t corners[2] = {0, 1};
    double least = 1;
    for (int round = 0; round < rounds; round++) {
        sample s = {0};
        add_random_lattice(&s, d, lowest_degree, 0, 1);
        if (two_links)
            add_random_lattice(&s, d, lowest_degree, -1, 2);
        for (int e = 0; e < repetitions(16); e++) {
            double positions[6];
            draw_edge(d, positions);
            set_mesh(&s, 2, positions, 1, 2, corners);
            deform(&s);
            const double found = measure(&s, 1).deviation_max, truth = brute_force(&s, 0, 1);
            assert_true(found <= truth * (1 + 1e-5) + 1e-14);
            least = fmin(least, found / truth);
            clear_mesh(&s);
        }
        clear(&s);
    }
    return least;
}

/* Kinks, as with degree 1, are harder to hit than waves. */
static void random_edges_come_close_to_the_true_deviation(void **state)
{
    draw d = {20};
    const double smooth = least_found(&d, 6, 2, false), two = least_found(&d, 3, 2, true),
                 kinks = least_found(&d, 6, 1, false);
    print_message("found at least: %.4f smooth, %.4f of two lattices, %.4f with kinks\n", smooth, two, kinks);
    assert_true(smooth > 0.98);
    assert_true(two > 0.98);
    assert_true(kinks > 0.93);
    (void)state;
}

/* The deformed edge jumps at the border; its end outside stays. */
static void the_jump_at_the_border_is_measured(void **state)
{
    sample s = {0};
    const double positions[6] = {0.5, 0.5, 0.5, 2.5, 0.5, 0.5};
    const uint32_t corners[2] = {0, 1};
    add_lattice(&s, CUBE("{\"by\": [0, 0, 1]}"));
    set_mesh(&s, 2, positions, 1, 2, corners);
    deform(&s);
    /* At x = 1.5 the points are 1 above their rest position, and the chord from (0.5, 1) to (2.5, 0) is 0.5
       above it. */
    check_near(measure(&s, 1).deviation_max, 0.5 * 2 / sqrt(5), 0.03);
    clear(&s);
    (void)state;
}

/* A closed direction: a ring of edges round a cylinder, also across its seam. */
static void edges_over_the_seam_are_measured(void **state)
{
    sample s = {0};
    double positions[36];
    uint32_t corners[12];
    for (uint32_t i = 0; i < 12; i++) {
        static const double x[12] = {2, 1.75, 1, 0, -1, -1.75, -2, -1.75, -1, 0, 1, 1.75};
        positions[3 * i] = x[i];
        positions[3 * i + 1] = x[(i + 9) % 12];
        positions[3 * i + 2] = 0;
        corners[i] = i;
    }
    add_lattice(
        &s, "{\"format\": \"ffd-lattice\", \"version\": 1, \"size\": [4, 8, 4], \"rest\": {\"cylinder\": "
            "{\"center\": [0, 0, 0], \"axis\": [0, 0, 1], \"radius\": [1, 3], \"height\": 2}}, \"moves\": "
            "[{\"at\": [\"all\", 0, \"all\"], \"by\": [0, 0, 1]}]}");
    set_mesh(&s, 12, positions, 1, 12, corners);
    deform(&s);
    const edge_quality quality = measure(&s, 1);
    assert_int_equal(quality.edges, 12);
    double largest = 0;
    for (uint32_t i = 0; i < 12; i++)
        largest = fmax(largest, brute_force(&s, i, (i + 1) % 12));
    assert_true(largest > 0.01);
    check_near(quality.deviation_max, largest, 0.02 * largest);
    clear(&s);
    (void)state;
}

static void mirrored_faces_are_flipped_and_turned_ones_are_not(void **state)
{
    sample s = {0};
    add_lattice(&s, CUBE("{\"scale\": {\"factor\": -1, \"about\": [0.5, 0.5, 0.5]}}"));
    set_mesh(&s, 8, cube, 6, 4, cube_corners);
    deform(&s);
    assert_int_equal(flipped(&s), 6);
    clear(&s);

    add_lattice(&s, CUBE("{\"scale\": {\"factor\": [-1, 1, 1], \"about\": [0.5, 0.5, 0.5]}}"));
    set_mesh(&s, 8, cube, 6, 4, cube_corners);
    deform(&s);
    assert_int_equal(flipped(&s), 6);
    clear(&s);

    add_lattice(&s, CUBE("{\"rotate\": {\"axis\": [1, 2, 3], \"degrees\": 200}}"));
    set_mesh(&s, 8, cube, 6, 4, cube_corners);
    deform(&s);
    assert_int_equal(flipped(&s), 0);
    clear(&s);
    (void)state;
}

/* x + 3 times the basis functions of the moved points: dx'/dx is negative only in the middle of x. */
static void flipped_faces_are_those_where_space_folds(void **state)
{
    sample s = {0};
    add_lattice(&s, BOX("[9, 2, 2]", "[3, 1, 1]", "[1.5, 1.5, 1.5]",
                        "{\"at\": [4, \"all\", \"all\"], \"by\": [1.2, 0, 0]}"));
    set_grid(&s, 40, -0.4, 1.4);
    deform(&s);
    uint64_t expected = 0;
    for (size_t f = 0; f < s.faces.face_count; f++) {
        const uint32_t *c = s.faces.corners + 3 * f;
        double lowest = 1e9, highest = -1e9;
        for (int i = 0; i < 3; i++) {
            lowest = fmin(lowest, 1 + s.gradients[9 * c[i]]);
            highest = fmax(highest, 1 + s.gradients[9 * c[i]]);
        }
        if (highest < 0)
            expected++;
        else if (lowest < 0) /* at the limit of the fold, either answer is right */
            expected += UINT64_C(1) << 32;
    }
    const uint64_t folded = expected & UINT32_MAX, between = expected >> 32;
    assert_true(folded > 100 && folded + between < s.faces.face_count);
    assert_true(flipped(&s) >= folded && flipped(&s) <= folded + between);
    clear(&s);
    (void)state;
}

/* y rises by 2u(1-u): det F = 1 everywhere, but the middle vertex crosses the line between the others. */
static void a_coarse_face_can_flip_without_a_fold(void **state)
{
    sample s = {0};
    const double positions[9] = {-0.4, 0, 0, 1.5, 0, 0, 3.4, 0.1, 0};
    const uint32_t corners[3] = {0, 1, 2};
    add_lattice(&s, BOX("[3, 2, 2]", "[2, 1, 1]", "[3.5, 1.5, 1.5]",
                        "{\"at\": [1, \"all\", \"all\"], \"by\": [0, 1, 0]}"));
    set_mesh(&s, 3, positions, 1, 3, corners);
    deform(&s);
    for (size_t i = 0; i < 3; i++) {
        double f[9];
        for (size_t k = 0; k < 9; k++)
            f[k] = s.gradients[9 * i + k] + (k % 4 == 0);
        check_near(mat_determinant(f), 1, 1e-12);
    }
    assert_int_equal(flipped(&s), 1);
    clear(&s);
    (void)state;
}

/* Faces with more than 4 corners, without area, and with NaN. */
static void faces_without_area_or_with_nan_are_not_flipped(void **state)
{
    sample s = {0};
    const double positions[24] = {0, 0,   0.5, 1,   0,   0.5, 1.2, 0.8, 0.5, 0.5, 1.3, 0.5,
                                  0, 0.8, 0.5, 0.1, 0.1, 0.1, 0.2, 0.2, 0.2, 0.3, 0.3, 0.3};
    const uint32_t five[5] = {0, 1, 2, 3, 4}, line[3] = {5, 6, 7}, point[3] = {1, 1, 1}, pair[2] = {0, 1};
    add_lattice(&s, CUBE("{\"scale\": {\"factor\": -1, \"about\": [0.5, 0.5, 0.5]}}"));
    set_mesh(&s, 8, positions, 1, 5, five);
    deform(&s);
    assert_int_equal(flipped(&s), 1);
    assert_int_equal(measure(&s, 1).edges, 5);

    s.deformed[3 * 2 + 1] = NAN;
    assert_int_equal(flipped(&s), 0);
    assert_int_equal(measure(&s, 1).edges, 3);
    s.deformed[3 * 2 + 1] = 1;
    s.faces.positions[3 * 2] = INFINITY;
    assert_int_equal(flipped(&s), 0);
    assert_int_equal(measure(&s, 1).edges, 3);
    s.faces.positions[3 * 2] = 1;
    s.gradients[9 * 4 + 8] = NAN;
    assert_int_equal(flipped(&s), 0);

    s.faces.start[1] = 3;
    memcpy(s.faces.corners, line, sizeof line);
    assert_int_equal(flipped(&s), 0);
    memcpy(s.faces.corners, point, sizeof point);
    assert_int_equal(flipped(&s), 0);
    assert_int_equal(measure(&s, 1).edges, 0);
    s.faces.start[1] = 2;
    memcpy(s.faces.corners, pair, sizeof pair);
    assert_int_equal(flipped(&s), 0);
    assert_int_equal(measure(&s, 1).edges, 1);
    s.faces.face_count = 0;
    const edge_quality nothing = measure(&s, 2);
    assert_true(nothing.edges == 0 && nothing.deviation_max == 0 && nothing.deviation_mean == 0);
    s.faces.face_count = 1;
    clear(&s);
    (void)state;
}

static int compare_keys(const void *a, const void *b)
{
    const uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return (x > y) - (x < y);
}

/* Compared with the C library's sort; vertex numbers use all 32 bits. */
static void each_edge_is_listed_once_in_order(void **state)
{
    draw d = {7};
    enum { FACES = 3000 };
    static uint32_t corners[4 * FACES];
    static size_t start[FACES + 1];
    static uint64_t expected[4 * FACES];
    const uint32_t spread[3] = {40, 70000, UINT32_MAX};
    for (int round = 0; round < 3; round++) {
        size_t used = 0, sides = 0, different = 0;
        for (size_t f = 0; f < FACES; f++) {
            const size_t count = (size_t)draw_int(&d, 1, 4);
            for (size_t i = 0; i < count; i++)
                corners[used + i] = (uint32_t)(draw_bits(&d) % spread[round]) + (spread[round] == UINT32_MAX);
            for (size_t i = 0; i < count; i++) {
                const uint64_t a = corners[used + i], b = corners[used + (i + 1) % count];
                if (a != b)
                    expected[sides++] = a < b ? a << 32 | b : b << 32 | a;
            }
            used += count;
            start[f + 1] = used;
        }
        qsort(expected, sides, sizeof *expected, compare_keys);
        for (size_t i = 0; i < sides; i++)
            if (i == 0 || expected[i] != expected[i - 1])
                expected[different++] = expected[i];
        const mesh_faces faces = {.face_count = FACES, .start = start, .corners = corners};
        edge_list edges;
        assert_int_equal(ffd_edges_collect(&faces, &edges, NULL), FFD_OK);
        assert_int_equal(edges.count, different);
        assert_memory_equal(edges.keys, expected, different * sizeof *expected);
        ffd_edges_free(&edges);
    }
    (void)state;
}

static void any_number_of_threads_gives_the_same_bits(void **state)
{
    sample s = {0};
    add_lattice(&s, BOX("[7, 6, 5]", "[3, 2, 2]", "[1.5, 1.5, 1.5]",
                        "{\"twist\": {\"axis\": [1, 1, 0], \"degrees\": 120}}, "
                        "{\"at\": [2, 3, \"all\"], \"by\": [0.1, 0.2, 0.3]}"));
    add_lattice(&s, BOX("[5, 5, 5]", "[3, 3, 3]", "[2, 2, 2]",
                        "{\"bend\": {\"axis\": \"x\", \"toward\": [0, 0, 1], \"degrees\": 60}}"));
    set_grid(&s, 30, -0.6, 1.4);
    deform(&s);
    const edge_quality one = measure(&s, 1);
    assert_int_equal(one.edges, 2 * 30 * 31 + 30 * 30);
    assert_true(one.deviation_max > one.deviation_mean && one.deviation_mean > 0);
    for (int threads = 0; threads <= 3; threads++) {
        const edge_quality many = measure(&s, threads);
        assert_int_equal(many.edges, one.edges);
        assert_memory_equal(&many.deviation_max, &one.deviation_max, sizeof one.deviation_max);
        assert_memory_equal(&many.deviation_mean, &one.deviation_mean, sizeof one.deviation_mean);
        assert_memory_equal(many.worst, one.worst, sizeof one.worst);
    }
    const double truth = brute_force(&s, one.worst[0], one.worst[1]);
    check_near(one.deviation_max, truth, 0.03 * truth);
    clear(&s);
    (void)state;
}

static void every_failed_allocation_is_reported(void **state)
{
    sample s = {0};
    long failures = 0;
    add_lattice(&s, CUBE("{\"by\": [0, 0, 1]}"));
    set_grid(&s, 20, 0, 1);
    deform(&s);
    for (ffd_status status = FFD_E_MEMORY; status; failures++) {
        edge_quality quality;
        ffd_error error = {0};
        ffd_alloc_fail_after(failures);
        status = ffd_quality_edges(NULL, MESH_STORED, &s.faces, s.deformed, &s.chain, NULL, NULL, 1, &quality,
                                   &error);
        ffd_alloc_fail_after(-1);
        if (status) {
            assert_int_equal(status, FFD_E_MEMORY);
            assert_string_equal(error.message, "out of memory");
        }
    }
    assert_true(failures > 4);
    clear(&s);
    (void)state;
}

/* Areas and volumes */

static mesh_extent extent_of(size_t vertices, const double *positions, size_t faces, size_t corners_of_face,
                             const uint32_t *corners)
{
    sample s = {0};
    mesh_extent extent;
    set_mesh(&s, vertices, positions, faces, corners_of_face, corners);
    ffd_extent_measure(NULL, &s.faces, s.faces.positions, &extent);
    clear_mesh(&s);
    return extent;
}

static void assert_near(double found, double expected)
{
    if (!(fabs(found - expected) <= 1e-14 * (1 + fabs(expected))))
        fail_msg("%.17g, not %.17g", found, expected);
}

/* A box with sides 2, 3, 4 and its low corner at `at`; faces look outwards. */
static const uint32_t box_faces[24] = {0, 4, 6, 2, 1, 3, 7, 5, 0, 1, 5, 4,
                                       2, 6, 7, 3, 0, 2, 3, 1, 4, 5, 7, 6};

static void put_box(const double at[3], double *positions)
{
    static const double sides[3] = {2, 3, 4};
    for (size_t i = 0; i < 8; i++)
        for (size_t a = 0; a < 3; a++)
            positions[3 * i + a] = at[a] + (i >> a & 1 ? sides[a] : 0);
}

static void a_box_has_its_area_and_volume_wherever_it_is(void **state)
{
    (void)state;
    static const double places[][3] = {{0, 0, 0}, {-1, -1.5, -2}, {1 << 30, -(1 << 30), 1 << 29}};
    double box[24];
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        put_box(places[i], box);
        const mesh_extent extent = extent_of(8, box, 6, 4, box_faces);
        assert_near(extent.area, 52);
        assert_near(extent.volume, 24);
    }
}

static void a_box_that_shows_its_back_has_less_than_no_volume(void **state)
{
    (void)state;
    double box[24];
    uint32_t turned[24];
    put_box((const double[]){5, 6, 7}, box);
    for (size_t i = 0; i < 24; i++)
        turned[i] = box_faces[23 - i];
    const mesh_extent extent = extent_of(8, box, 6, 4, turned);
    assert_near(extent.area, 52);
    assert_near(extent.volume, -24);
}

static void an_octahedron_has_its_area_and_volume(void **state)
{
    (void)state;
    static const double points[] = {1, 0, 0, 0, 1, 0, 0, 0, 1, -1, 0, 0, 0, -1, 0, 0, 0, -1};
    static const uint32_t faces[] = {0, 1, 2, 1, 3, 2, 3, 4, 2, 4, 0, 2, 1, 0, 5, 3, 1, 5, 4, 3, 5, 0, 4, 5};
    const mesh_extent extent = extent_of(6, points, 8, 3, faces);
    assert_near(extent.area, 4 * sqrt(3));
    assert_near(extent.volume, 4.0 / 3);
}

static void what_is_not_closed_has_no_volume(void **state)
{
    (void)state;
    double box[24], moebius[30];
    uint32_t turned[24], strip[20];
    put_box((const double[]){0, 0, 0}, box);
    assert_true(isnan(extent_of(8, box, 5, 4, box_faces).volume)); /* one face is missing */
    memcpy(turned, box_faces, sizeof turned);
    turned[20] = box_faces[23], turned[21] = box_faces[22], turned[22] = box_faces[21],
    turned[23] = box_faces[20];
    assert_true(isnan(extent_of(8, box, 6, 4, turned).volume)); /* one face is reversed */
    for (uint32_t i = 0; i < 5; i++) {
        const double angle = 0.4 * 3.14159265358979 * i;
        for (uint32_t side = 0; side < 2; side++) {
            const double across = (side ? 0.2 : -0.2), radius = 1 + across * cos(angle / 2);
            double *const p = moebius + 3 * (2 * i + side);
            p[0] = radius * cos(angle), p[1] = radius * sin(angle), p[2] = across * sin(angle / 2);
        }
        const uint32_t next = i < 4 ? 2 * i + 2 : 1, beyond = i < 4 ? 2 * i + 3 : 0;
        strip[4 * i] = 2 * i, strip[4 * i + 1] = next, strip[4 * i + 2] = beyond,
                  strip[4 * i + 3] = 2 * i + 1;
    }
    const mesh_extent extent = extent_of(10, moebius, 5, 4, strip);
    assert_true(isnan(extent.volume) && extent.area > 2);
    assert_true(isnan(extent_of(0, NULL, 0, 3, NULL).volume)); /* an empty mesh encloses no volume */
}

static void vertices_at_one_position_close_a_mesh(void **state)
{
    (void)state;
    double box[24], corners[72], pair[48];
    uint32_t numbers[24], both[48];
    put_box((const double[]){0, 0, 0}, box);
    for (uint32_t i = 0; i < 24; i++) {
        memcpy(corners + 3 * i, box + 3 * box_faces[i], 3 * sizeof *box);
        corners[3 * i] = corners[3 * i] > 0 ? corners[3 * i] : i % 2 ? -0.0 : 0.0;
        numbers[i] = i;
    }
    assert_near(extent_of(24, corners, 6, 4, numbers).volume, 24);
    corners[0] += 1e-15; /* a tiny gap */
    assert_true(isnan(extent_of(24, corners, 6, 4, numbers).volume));
    /* Two boxes that share an edge, where four faces meet. */
    put_box((const double[]){0, 0, 0}, pair);
    put_box((const double[]){2, 3, 0}, pair + 24);
    for (uint32_t i = 0; i < 24; i++) {
        both[i] = box_faces[i];
        both[24 + i] = 8 + box_faces[i];
    }
    const mesh_extent extent = extent_of(16, pair, 12, 4, both);
    assert_near(extent.volume, 48);
    assert_near(extent.area, 104);
}

static void what_hides_or_has_no_number_is_not_measured(void **state)
{
    (void)state;
    sample s = {0};
    mesh_extent extent;
    double pair[48], moved[48];
    uint32_t both[48];
    mesh_part parts[3] = {{.vertex_count = 8, .hidden = true},
                          {.vertex_count = 8, .repeats_positions = true},
                          {.vertex_count = 8}};
    mesh_document document = {.parts = parts, .part_count = 3};
    put_box((const double[]){0, 0, 0}, pair);
    put_box((const double[]){9, 9, 9}, pair + 24);
    for (uint32_t i = 0; i < 24; i++) {
        both[i] = 8 + box_faces[i];
        both[24 + i] = i < 20 ? box_faces[i] : 0; /* hidden faces may be open */
    }
    memcpy(moved, pair, sizeof moved);
    for (size_t a = 0; a < 3; a++)
        moved[3 * 9 + a] = NAN; /* its transform is singular, so it stays */
    set_mesh(&s, 16, pair, 12, 4, both);
    ffd_extent_measure(&document, &s.faces, moved, &extent);
    assert_near(extent.area, 52);
    assert_near(extent.volume, 24);
    s.faces.positions[3 * 9 + 1] = NAN;
    ffd_extent_measure(&document, &s.faces, s.faces.positions, &extent);
    assert_true(isnan(extent.area) && isnan(extent.volume));
    clear_mesh(&s);
}

static void sums_that_overflow_are_what_they_are(void **state)
{
    (void)state;
    static const int exponents[] = {300, 340, 500, 1020};
    double box[24];
    put_box((const double[3]){0, 0, 0}, box);
    for (size_t i = 0; i < 24; i++)
        box[i] = ldexp(box[i], exponents[0]);
    assert_near(extent_of(8, box, 6, 4, box_faces).volume / 0x1p900, 24);
    for (size_t e = 1; e < sizeof exponents / sizeof *exponents; e++) {
        for (size_t i = 0; i < 24; i++)
            box[i] = ldexp(box[i], exponents[e] - exponents[e - 1]);
        const mesh_extent extent = extent_of(8, box, 6, 4, box_faces);
        assert_true(isinf(extent.volume) && extent.volume > 0);
        if (exponents[e] < 510)
            assert_near(ldexp(extent.area, -2 * exponents[e]), 52);
        else
            assert_true(isinf(extent.area));
        assert_true(isnan(extent_of(8, box, 5, 4, box_faces).volume)); /* a lid is open */
    }
    /* Six times the volume of a part overflows, the volume does not. */
    put_box((const double[3]){0, 0, 0}, box);
    for (size_t i = 0; i < 24; i++)
        box[i] = ldexp(box[i], i % 3 ? 339 : 341);
    assert_near(ldexp(extent_of(8, box, 6, 4, box_faces).volume, -3 * 339), 96);
    box[0] = NAN;
    const mesh_extent unknown = extent_of(8, box, 6, 4, box_faces);
    assert_true(isnan(unknown.volume) && isnan(unknown.area));
}

static void small_parts_are_not_lost_in_a_large_sum(void **state)
{
    (void)state;
    enum { SMALL = 1000 };
    double *const points = checked(ffd_alloc((SMALL + 1) * 3, 3 * sizeof(double)));
    uint32_t *const corners = checked(ffd_alloc(SMALL + 1, 3 * sizeof(uint32_t)));
    for (uint32_t i = 0; i <= SMALL; i++) { /* an area of 1e8, then 1,000 times 2^-30 */
        const double side = i ? 0x1p-14 : 0x1p14, height = i ? 0x1p-15 : 0x1p15;
        const double triangle[9] = {0, 0, i, side, 0, i, 0, height, i};
        memcpy(points + 9 * (size_t)i, triangle, sizeof triangle);
        for (uint32_t c = 0; c < 3; c++)
            corners[3 * i + c] = 3 * i + c;
    }
    const double area = extent_of(3 * (SMALL + 1), points, SMALL + 1, 3, corners).area;
    if (area < 0x1p28 + SMALL * 0x1p-30 || area > 0x1p28 + SMALL * 0x1p-30)
        fail_msg("%.17g", area);
    ffd_free(points);
    ffd_free(corners);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_translation_bends_no_edge_and_flips_no_face),
        cmocka_unit_test(edges_that_do_not_move_are_exactly_straight),
        cmocka_unit_test(an_edge_on_a_parabola_deviates_by_its_sagitta),
        cmocka_unit_test(an_edge_on_an_arc_deviates_by_its_sagitta),
        cmocka_unit_test(a_bump_inside_one_span_is_found),
        cmocka_unit_test(random_edges_come_close_to_the_true_deviation),
        cmocka_unit_test(the_jump_at_the_border_is_measured),
        cmocka_unit_test(edges_over_the_seam_are_measured),
        cmocka_unit_test(mirrored_faces_are_flipped_and_turned_ones_are_not),
        cmocka_unit_test(flipped_faces_are_those_where_space_folds),
        cmocka_unit_test(a_coarse_face_can_flip_without_a_fold),
        cmocka_unit_test(faces_without_area_or_with_nan_are_not_flipped),
        cmocka_unit_test(a_box_has_its_area_and_volume_wherever_it_is),
        cmocka_unit_test(a_box_that_shows_its_back_has_less_than_no_volume),
        cmocka_unit_test(an_octahedron_has_its_area_and_volume),
        cmocka_unit_test(what_is_not_closed_has_no_volume),
        cmocka_unit_test(vertices_at_one_position_close_a_mesh),
        cmocka_unit_test(what_hides_or_has_no_number_is_not_measured),
        cmocka_unit_test(sums_that_overflow_are_what_they_are),
        cmocka_unit_test(small_parts_are_not_lost_in_a_large_sum),
        cmocka_unit_test(each_edge_is_listed_once_in_order),
        cmocka_unit_test(any_number_of_threads_gives_the_same_bits),
        cmocka_unit_test(every_failed_allocation_is_reported),
        cmocka_unit_test(a_bump_on_a_very_long_edge_is_found),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
