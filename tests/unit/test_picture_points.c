/* test_picture_points.c - the points of meshes in pictures: their colours, which of them hides another one,
   and Gaussian splats. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/lab.h"
#include "../support/picture_shapes.h"
#include "base/memory/memory.h"
#include "splat/splat.h"
#include "splat/splat_color.h"

#define SIDE 100

static uint8_t *draw_points(const picture_points *points, bool sees_through, int threads)
{
    static const ffd_bounds seen = {.min = {-1, -1, -1}, .max = {1, 1, 1}};
    const picture_panel panel = {.points = points, .point_count = 1};
    const picture p = {.width = SIDE,
                       .height = SIDE,
                       .panels = &panel,
                       .panel_count = 1,
                       .camera = shape_camera("front"),
                       .seen = &seen,
                       .sees_through = sees_through,
                       .threads = threads};
    uint8_t *pixels;
    ffd_error error;
    if (ffd_picture_draw(&p, NULL, &pixels, &error))
        fail_msg("%s", error.message);
    return pixels;
}

static const uint8_t *pixel_at(const uint8_t *pixels, int x, int y)
{
    return pixels + 3 * (SIDE * y + x);
}

static void the_nearer_point_is_seen_in_its_colour(void **state)
{
    static const double at[] = {0, 0, 0, 0, 0, 0.5, 0.8, 0, 0, NAN, 0, 0, 1e300, 0, 0};
    static const uint8_t colors[] = {255, 0,   0, 255, 0, 255, 0, 255, 0, 0,
                                     255, 255, 9, 9,   9, 255, 9, 9,   9, 255};
    static const uint32_t orders[2][5] = {{0, 1, 2, 3, 4}, {4, 3, 2, 1, 0}};
    (void)state;
    for (int i = 0; i < 2; i++) {
        const picture_points points = {.positions = at,
                                       .vertex_count = 5,
                                       .points = orders[i],
                                       .count = 5,
                                       .colors = colors,
                                       .radius = 4};
        uint8_t *const pixels = draw_points(&points, false, 1);
        assert_memory_equal(pixel_at(pixels, 50, 50), colors + 4, 3);
        bool is_blue = false;
        for (int x = 60; x < SIDE; x++)
            is_blue = is_blue || memcmp(pixel_at(pixels, x, 50), colors + 8, 3) == 0;
        assert_true(is_blue);
        ffd_free(pixels);
    }
}

/* Counts the columns and rows in which the middle row and column are not those of the background. */
static void spread_of(const uint8_t *pixels, int spread[2])
{
    spread[0] = spread[1] = 0;
    for (int i = 0; i < SIDE; i++) {
        spread[0] += lab_distance(pixel_at(pixels, i, 50), pixel_at(pixels, 0, 50)) > 3;
        spread[1] += lab_distance(pixel_at(pixels, 50, i), pixel_at(pixels, 0, i)) > 3;
    }
}

static void a_splat_is_as_long_and_as_dense_as_it_says(void **state)
{
    static const double at[] = {0, 0, 0};
    static const uint32_t one[] = {0};
    uint8_t color[4] = {255, 0, 0, 255};
    /* standard deviations of 0.3 and 0.1 */
    float covariance[6] = {0.09f, 0, 0, 0.01f, 0, 0.04f};
    const picture_points points = {.positions = at,
                                   .vertex_count = 1,
                                   .points = one,
                                   .count = 1,
                                   .colors = color,
                                   .radius = 1,
                                   .covariances = covariance};
    int spread[2];
    (void)state;
    uint8_t *pixels = draw_points(&points, true, 1);
    assert_true(lab_distance(pixel_at(pixels, 50, 50), color) < 10);
    spread_of(pixels, spread);
    assert_true(spread[0] > 2.5 * spread[1] && spread[0] < 3.5 * spread[1]);
    assert_true(spread[0] > 50 && spread[0] < SIDE); /* about 3 standard deviations on each side */
    ffd_free(pixels);
    /* Half clear, it lets half of the background through. */
    color[3] = 128;
    pixels = draw_points(&points, true, 1);
    const double ground = lab_linear(pixel_at(pixels, 0, 50)[1]),
                 green = lab_linear(pixel_at(pixels, 50, 50)[1]);
    assert_true(fabs(green - ground / 2) < 0.02);
    ffd_free(pixels);
    /* Turned by 45 degrees it is as long along both axes. */
    memcpy(covariance, (float[]){0.05f, 0.04f, 0, 0.05f, 0, 0.04f}, sizeof covariance);
    pixels = draw_points(&points, true, 1);
    spread_of(pixels, spread);
    assert_true(abs(spread[0] - spread[1]) <= 2);
    /* It rises to the right. */
    assert_true(lab_distance(pixel_at(pixels, 62, 38), pixel_at(pixels, 0, 38)) >
                10 + lab_distance(pixel_at(pixels, 38, 38), pixel_at(pixels, 0, 38)));
    ffd_free(pixels);
    /* One that is no number is a disc; clear ones are not there. */
    covariance[0] = (float)NAN;
    pixels = draw_points(&points, true, 1);
    spread_of(pixels, spread);
    assert_in_range(spread[0], 1, 4);
    ffd_free(pixels);
    covariance[0] = 0.05f;
    color[3] = 0;
    pixels = draw_points(&points, true, 1);
    spread_of(pixels, spread);
    assert_int_equal(spread[0] + spread[1], 0);
    ffd_free(pixels);
}

static void splats_are_sorted_for_any_order_and_threads(void **state)
{
    enum { COUNT = 12 };
    static double at[3 * COUNT];
    static float covariances[6 * COUNT];
    static uint8_t colors[4 * COUNT];
    uint32_t order[COUNT];
    (void)state;
    for (uint32_t i = 0; i < COUNT; i++) {
        at[3 * i] = 0.05 * i - 0.3;
        at[3 * i + 1] = 0.04 * (i % 5);
        at[3 * i + 2] = 0.01 * ((7 * i) % COUNT);
        covariances[6 * i] = covariances[6 * i + 3] = covariances[6 * i + 5] = 0.02f;
        memcpy(colors + 4 * i,
               (uint8_t[]){(uint8_t)(20 * i), (uint8_t)(255 - 20 * i), (uint8_t)(60 * (i % 4)), 150}, 4);
        order[i] = i;
    }
    const picture_points points = {.positions = at,
                                   .vertex_count = COUNT,
                                   .points = order,
                                   .count = COUNT,
                                   .colors = colors,
                                   .radius = 1,
                                   .covariances = covariances};
    uint8_t *const first = draw_points(&points, true, 1);
    for (int turn = 1; turn < 6; turn++) {
        for (uint32_t i = 0; i < COUNT; i++)
            order[i] = (uint32_t)(5 * i + (uint32_t)turn) % COUNT;
        uint8_t *const again = draw_points(&points, true, turn);
        assert_memory_equal(first, again, (size_t)3 * SIDE * SIDE);
        ffd_free(again);
    }
    ffd_free(first);
}

static void covariances_are_those_of_the_ellipsoid(void **state)
{
    const splat_form plain = {0}, logs = {.is_logarithmic = true}, flat = {.is_flat = true};
    /* a quarter turn about z: the first axis is y */
    const splat_ellipsoid turned = {{2, 0, 0, 2}, {3, 2, 1}}, small = {{1, 0, 0, 0}, {0, -1, 1}},
                          none = {{0, 0, 0, 0}, {1, 1, 1}};
    double c[6];
    (void)state;
    ffd_splat_covariance(&turned, &plain, c);
    const double wanted[6] = {4, 0, 0, 9, 0, 1};
    for (int i = 0; i < 6; i++)
        assert_true(fabs(c[i] - wanted[i]) < 1e-12);
    ffd_splat_covariance(&small, &logs, c);
    assert_true(fabs(c[0] - 1) < 1e-12 && fabs(c[3] - exp(-2)) < 1e-12 && fabs(c[5] - exp(2)) < 1e-12);
    ffd_splat_covariance(&turned, &flat, c);
    assert_true(fabs(c[5]) < 1e-12);
    ffd_splat_covariance(&none, &plain, c);
    assert_false(isfinite(c[0]));
    /* Sheared along x by z. */
    const double shear[9] = {1, 0, 2, 0, 1, 0, 0, 0, 1};
    memcpy(c, wanted, sizeof c);
    ffd_covariance_carry(shear, c);
    const double carried[6] = {8, 0, 2, 9, 0, 1};
    for (int i = 0; i < 6; i++)
        assert_true(fabs(c[i] - carried[i]) < 1e-12);
    assert_true(fabs(splat_opacity(0) - 0.5) < 1e-12 && fabs(splat_opacity(2) - 1 / (1 + exp(-2))) < 1e-12);
    assert_true(splat_opacity(-1000) <= 0 && splat_opacity(1000) >= 1 && splat_opacity(NAN) >= 1);
    assert_true(fabs(splat_color(1) - 0.78209479177387814) < 1e-12 && splat_color(9) >= 1 &&
                splat_color(-9) <= 0);
    assert_true(fabs(splat_color(NAN) - 0.5) < 1e-12);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_nearer_point_is_seen_in_its_colour),
        cmocka_unit_test(a_splat_is_as_long_and_as_dense_as_it_says),
        cmocka_unit_test(splats_are_sorted_for_any_order_and_threads),
        cmocka_unit_test(covariances_are_those_of_the_ellipsoid),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
