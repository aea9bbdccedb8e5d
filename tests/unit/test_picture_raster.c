/* test_picture_raster.c - rasterization: each sample is covered exactly once, the nearest triangle wins, for
   triangles of any size, also beyond the picture. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/draw.h"
#include "picture/raster.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define WIDTH 90
#define HEIGHT 70
#define PIXELS (WIDTH * HEIGHT)
#define MOST_VERTICES 4096
#define MOST_TRIANGLES 8192

static surface_vertex vertices[MOST_VERTICES];
static uint32_t triangles[3 * MOST_TRIANGLES];
static double positions[3 * MOST_VERTICES];
static float depth[SAMPLES * PIXELS];
static uint64_t color[SAMPLES * PIXELS];
static linear_tables tables;
static picture_mesh mesh;
static surface drawn;
static samples into;

static void begin(size_t vertex_count, size_t triangle_count)
{
    mesh = (picture_mesh){.positions = positions,
                          .vertex_count = vertex_count,
                          .triangles = triangles,
                          .triangle_count = triangle_count};
    drawn =
        (surface){.mesh = &mesh, .vertices = vertices, .vertex_count = vertex_count, .triangles = triangles};
    into = (samples){0, 0, WIDTH, HEIGHT, depth, color, NULL, NULL};
    ffd_linear_fill(&tables);
    for (size_t i = 0; i < SAMPLES * PIXELS; i++) {
        depth[i] = SAMPLE_EMPTY;
        color[i] = 0;
    }
}

static void set(size_t vertex, int32_t x, int32_t y, float z)
{
    vertices[vertex] = (surface_vertex){x, y, z, {LIGHT_ONE, LIGHT_ONE}};
}

/* Draws each triangle alone, and counts how often each sample is covered. Checks the range of rows. */
static void count(size_t triangle_count, unsigned char counts[SAMPLES * PIXELS])
{
    memset(counts, 0, SAMPLES * PIXELS);
    for (size_t t = 0; t < triangle_count; t++) {
        int64_t first, last;
        const bool is_there = ffd_raster_rows(&drawn, t, &first, &last);
        ffd_raster_triangle(&drawn, &tables, t, &into);
        for (size_t i = 0; i < SAMPLES * PIXELS; i++)
            if (depth[i] < SAMPLE_EMPTY) {
                const int64_t row = (int64_t)(i / SAMPLES / WIDTH);
                assert_true(is_there && row >= first && row <= last);
                counts[i]++;
                depth[i] = SAMPLE_EMPTY;
            }
    }
}

/* A grid of columns x rows cells. Inner corners are moved at random, diagonals and orientations vary. */
static size_t make_net(draw *d, int columns, int rows, const int32_t box[4])
{
    size_t next = 0;
    const int across = (box[2] - box[0]) / columns, down = (box[3] - box[1]) / rows;
    for (int r = 0; r <= rows; r++)
        for (int c = 0; c <= columns; c++) {
            const int32_t x = c == columns ? box[2] : box[0] + c * across,
                          y = r == rows ? box[3] : box[1] + r * down;
            const bool is_edge_x = c == 0 || c == columns, is_edge_y = r == 0 || r == rows;
            /* Less than half a cell, so that no cell is inverted. */
            const int32_t dx = is_edge_x ? 0 : draw_int(d, -across / 3, across / 3),
                          dy = is_edge_y ? 0 : draw_int(d, -down / 3, down / 3);
            set((size_t)(r * (columns + 1) + c), x + dx, y + dy, 0);
        }
    for (int r = 0; r < rows; r++)
        for (int c = 0; c < columns; c++) {
            const uint32_t a = (uint32_t)(r * (columns + 1) + c), b = a + 1, e = a + (uint32_t)columns + 1,
                           f = e + 1;
            /* A quad may be concave: the diagonal from its reflex corner is the right one, so choose by the
               areas of both. */
            const surface_vertex *const v = vertices;
            const int64_t side_b = (int64_t)(v[f].x - v[a].x) * (v[b].y - v[a].y) -
                                   (int64_t)(v[f].y - v[a].y) * (v[b].x - v[a].x),
                          side_e = (int64_t)(v[f].x - v[a].x) * (v[e].y - v[a].y) -
                                   (int64_t)(v[f].y - v[a].y) * (v[e].x - v[a].x);
            const bool is_falling = side_b <= 0 && side_e >= 0;
            const uint32_t falling[6] = {a, b, f, a, f, e}, rising[6] = {a, b, e, b, f, e};
            for (int k = 0; k < 6; k++)
                triangles[next + (size_t)k] = (is_falling ? falling : rising)[k];
            if (draw_int(d, 0, 1)) {
                const uint32_t other = triangles[next];
                triangles[next] = triangles[next + 1];
                triangles[next + 1] = other;
            }
            next += 6;
        }
    return next / 3;
}

/* Whether a sample is inside the box. Samples on its left and upper edges are. */
static bool is_in(const int32_t box[4], size_t sample)
{
    static const int32_t xs[SAMPLES] = SAMPLE_X, ys[SAMPLES] = SAMPLE_Y;
    const int32_t x = SUBPIXELS * (int32_t)(sample / SAMPLES % WIDTH) + xs[sample % SAMPLES],
                  y = SUBPIXELS * (int32_t)(sample / SAMPLES / WIDTH) + ys[sample % SAMPLES];
    return x >= box[0] && x < box[2] && y >= box[1] && y < box[3];
}

static void each_sample_is_in_one_triangle(void **state)
{
    static unsigned char counts[SAMPLES * PIXELS];
    draw d = {draw_seed()};
    (void)state;
    for (int round = 0; round < 30; round++) {
        /* Also corners at samples, and boxes far larger than the picture. */
        const int far_away = round % 3 == 0 ? 60000 * SUBPIXELS : 0, grain = round % 2 ? 1 : 32;
        const int32_t box[4] = {
            draw_int(&d, 0, 200) * grain - far_away, draw_int(&d, 0, 100) * grain - far_away,
            draw_int(&d, 300, 600) * 32 + far_away, draw_int(&d, 250, 500) * 32 + far_away};
        const int columns = draw_int(&d, 1, 12), rows = draw_int(&d, 1, 12);
        begin((size_t)((columns + 1) * (rows + 1)), (size_t)(2 * columns * rows));
        const size_t made = make_net(&d, columns, rows, box);
        count(made, counts);
        for (size_t i = 0; i < SAMPLES * PIXELS; i++)
            assert_int_equal(counts[i], is_in(box, i));
    }
}

static void triangles_without_area_take_no_sample(void **state)
{
    static unsigned char counts[SAMPLES * PIXELS];
    (void)state;
    begin(3, 1);
    set(0, 96, 32, 0);
    set(1, 96 + 2560, 32 + 2560, 0);
    set(2, 96 + 25600, 32 + 25600, 0);
    memcpy(triangles, (uint32_t[]){0, 1, 2}, 12);
    count(1, counts);
    for (size_t i = 0; i < SAMPLES * PIXELS; i++)
        assert_int_equal(counts[i], 0);
}

/* Two planes that intersect in the middle of the picture. */
static void the_nearest_triangle_is_seen_in_any_order(void **state)
{
    (void)state;
    for (uint32_t order = 0; order < 2; order++) {
        begin(6, 2);
        for (uint32_t k = 0; k < 2; k++) {
            const float left = k ? 10.f : 0.f, right = k ? 0.f : 10.f;
            set(3 * k, 0, -1000 * SUBPIXELS, left);
            set(3 * k + 1, 0, 1000 * SUBPIXELS, left);
            set(3 * k + 2, WIDTH * SUBPIXELS, 35 * SUBPIXELS, right);
        }
        for (uint32_t c = 0; c < 6; c++)
            triangles[c] = (c + 3 * order) % 6;
        for (size_t v = 0; v < 6; v++)
            vertices[v].light[0] = vertices[v].light[1] = v < 3 ? LIGHT_ONE : LIGHT_ONE / 2;
        ffd_raster_triangle(&drawn, &tables, 0, &into);
        ffd_raster_triangle(&drawn, &tables, 1, &into);
        const uint64_t left = color[SAMPLES * (35 * WIDTH + 20)], right = color[SAMPLES * (35 * WIDTH + 70)];
        assert_true(linear_part(left, 0) > linear_part(right, 0));
        assert_true(fabs((double)depth[SAMPLES * (35 * WIDTH + 20)] - 10 * (20 + 96 / 256.0) / WIDTH) < 1e-4);
    }
}

/* Of two triangles at the same depth the first one is visible, in the order of the file. */
static void of_equally_near_ones_the_first_is_seen(void **state)
{
    (void)state;
    begin(6, 2);
    for (size_t v = 0; v < 6; v++) {
        set(v, v % 3 == 1 ? 20000 : 0, v % 3 == 2 ? 15000 : 0, 1);
        vertices[v].light[0] = vertices[v].light[1] = v < 3 ? LIGHT_ONE : LIGHT_ONE / 2;
        triangles[v] = (uint32_t)v;
    }
    ffd_raster_triangle(&drawn, &tables, 0, &into);
    const uint64_t before = color[SAMPLES * (5 * WIDTH + 5)];
    ffd_raster_triangle(&drawn, &tables, 1, &into);
    assert_true(before != 0);
    assert_true(color[SAMPLES * (5 * WIDTH + 5)] == before);
}

/* Triangles with corners of a rectangle. */
static void begin_on_a_rectangle(size_t vertex_count, size_t count, const uint32_t corners[][3])
{
    begin(vertex_count, count);
    for (size_t v = 0; v < vertex_count; v++)
        set(v, v % 2 ? 20000 : 0, v / 2 ? 15000 : 0, 1);
    memcpy(triangles, corners, count * sizeof *corners);
}

static void use_materials(uint32_t *of, const picture_material two[2])
{
    mesh.materials = of;
    mesh.material_list = two;
    mesh.material_count = 2;
}

/* If a file repeats a face, also with degenerate triangles between, only the first one is listed. The same
   corners with another material may be visible through its holes. */
static void a_repeated_triangle_is_drawn_once(void **state)
{
    static const picture_material materials[2] = {{.color = {1, 1, 1, 1}}, {.color = {1, 1, 1, 1}}};
    static const uint32_t corners[6][3] = {{0, 1, 2}, {0, 1, 2}, {0, 2, 2}, {0, 1, 2}, {0, 1, 3}, {0, 1, 3}};
    static const bool is_there[6] = {true, false, false, false, true, true};
    uint32_t of[6] = {0, 0, 0, 0, 0, 1};
    (void)state;
    begin_on_a_rectangle(4, 6, corners);
    use_materials(of, materials);
    for (size_t t = 0; t < 6; t++) {
        int64_t first, last;
        assert_int_equal(ffd_raster_rows(&drawn, t, &first, &last), is_there[t]);
    }
}

/* A polygon that goes round three corners many times is cut into triangles that begin at each corner in turn.
   Triangles of opposite orientation show the other side. */
static void a_turned_triangle_is_drawn_once(void **state)
{
    static const picture_material materials[2] = {{.color = {1, 1, 1, 1}, .alpha_cutoff = 0.5},
                                                  {.color = {1, 1, 1, 1}}};
    static const uint32_t corners[5][3] = {{0, 1, 2}, {2, 0, 1}, {1, 2, 0}, {1, 0, 2}, {0, 1, 2}};
    static const bool is_there[5] = {true, false, false, true, false};
    float texcoords[5][6] = {{0, 0, 1, 0, 0, 1}};
    uint32_t of[5] = {1, 1, 1, 1, 1};
    int64_t first, last;
    (void)state;
    begin_on_a_rectangle(3, 5, corners);
    use_materials(of, materials);
    mesh.texcoords = texcoords[0];
    for (size_t t = 0; t < 5; t++)
        assert_int_equal(ffd_raster_rows(&drawn, t, &first, &last), is_there[t]);
    of[0] = of[1] = of[2] = 0;
    assert_true(ffd_raster_rows(&drawn, 1, &first, &last)); /* its transparent parts may differ */
    memcpy(texcoords[1], (float[]){0, 1, 0, 0, 1, 0}, sizeof texcoords[1]);
    assert_false(ffd_raster_rows(&drawn, 1, &first, &last));
}

/* Skipping hidden blocks gives the same samples as not skipping them. */
static void blocks_hide_nothing_that_is_seen(void **state)
{
    enum { TRIANGLES = 60 };
    static float plain_depth[SAMPLES * PIXELS];
    static uint64_t plain_color[SAMPLES * PIXELS];
    float blocks[WIDTH / BLOCK + 1];
    draw d = {draw_seed()};
    (void)state;
    for (int kept = 0; kept < 2; kept++) {
        draw again = d;
        begin(3, 1);
        for (size_t i = 0; i <= WIDTH / BLOCK; i++)
            blocks[i] = SAMPLE_EMPTY;
        into.blocks = kept ? blocks : NULL;
        memcpy(triangles, (uint32_t[]){0, 1, 2}, 12);
        for (int t = 0; t < TRIANGLES; t++) {
            for (size_t v = 0; v < 3; v++) {
                set(v, (int32_t)draw_between(&again, -20000, 40000),
                    (int32_t)draw_between(&again, -20000, 40000),
                    (float)draw_between(&again, 0, t % 3 ? 1 : 1e-3));
                vertices[v].light[0] = vertices[v].light[1] =
                    (uint16_t)(LIGHT_ONE * (t + 1) / (TRIANGLES + 1));
            }
            ffd_raster_triangle(&drawn, &tables, 0, &into);
        }
        if (!kept) {
            memcpy(plain_depth, depth, sizeof depth);
            memcpy(plain_color, color, sizeof color);
        }
    }
    assert_memory_equal(depth, plain_depth, sizeof depth);
    assert_memory_equal(color, plain_color, sizeof color);
    for (size_t row = 0; row < HEIGHT; row++)
        for (size_t i = 0; i < SAMPLES * WIDTH; i++)
            assert_true(depth[SAMPLES * row * WIDTH + i] <= blocks[i / SAMPLES / BLOCK]);
}

static void set_far(size_t vertex, double x, double y, double z)
{
    memcpy(positions + 3 * vertex, (double[]){x, y, z}, 3 * sizeof(double));
    vertices[vertex] = (surface_vertex){VERTEX_FAR, 0, 0, {LIGHT_ONE, LIGHT_ONE}};
}

static void what_reaches_far_beyond_is_drawn_where_it_is_in_the_picture(void **state)
{
    static unsigned char counts[SAMPLES * PIXELS];
    (void)state;
    begin(3, 1);
    /* The identity, with y upwards. */
    drawn.projection = (projection){.camera = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, .scale = 1};
    /* All to the right of x = 40. */
    set_far(0, 40, -1e7, 0);
    set_far(1, 1e9, 0, 0);
    set_far(2, 40, 1e7, 0);
    memcpy(triangles, (uint32_t[]){0, 1, 2}, 12);
    const int32_t right[4] = {40 * SUBPIXELS, INT32_MIN, INT32_MAX, INT32_MAX};
    count(1, counts);
    for (size_t i = 0; i < SAMPLES * PIXELS; i++)
        assert_int_equal(counts[i], is_in(right, i));
    /* Everywhere; nowhere; coordinates whose squares overflow. */
    set_far(0, -1e12, -1e12, 0);
    set_far(2, -1e12, 1e12, 0);
    set_far(1, 1e13, 0, 0);
    count(1, counts);
    for (size_t i = 0; i < SAMPLES * PIXELS; i++)
        assert_int_equal(counts[i], 1);
    set_far(0, 1e12, 1e12, 0);
    count(1, counts);
    assert_int_equal(counts[0], 0);
    set_far(0, 1e300, -1e300, 1e300);
    count(1, counts);
    vertices[0].x = VERTEX_NOWHERE;
    int64_t first, last;
    assert_false(ffd_raster_rows(&drawn, 0, &first, &last));
}

static void the_back_of_a_material_of_one_side_is_not_drawn(void **state)
{
    static const picture_material materials[2] = {{.color = {1, 1, 1, 1}},
                                                  {.color = {1, 1, 1, 1}, .is_double_sided = true}};
    static unsigned char counts[SAMPLES * PIXELS];
    (void)state;
    for (uint32_t material = 0; material < 2; material++)
        for (uint32_t turned = 0; turned < 2; turned++) {
            begin(3, 1);
            use_materials(&material, materials);
            set(0, 0, 0, 0);
            set(1, 0, 15000, 0);
            set(2, 15000, 0, 0);
            memcpy(triangles, turned ? (uint32_t[]){0, 2, 1} : (uint32_t[]){0, 1, 2}, 12);
            count(1, counts);
            /* Rows run downwards: down, then right, is counter-clockwise. */
            assert_int_equal(counts[SAMPLES * (5 * WIDTH + 5)], material || !turned);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_sample_is_in_one_triangle),
        cmocka_unit_test(triangles_without_area_take_no_sample),
        cmocka_unit_test(the_nearest_triangle_is_seen_in_any_order),
        cmocka_unit_test(of_equally_near_ones_the_first_is_seen),
        cmocka_unit_test(a_repeated_triangle_is_drawn_once),
        cmocka_unit_test(a_turned_triangle_is_drawn_once),
        cmocka_unit_test(blocks_hide_nothing_that_is_seen),
        cmocka_unit_test(what_reaches_far_beyond_is_drawn_where_it_is_in_the_picture),
        cmocka_unit_test(the_back_of_a_material_of_one_side_is_not_drawn),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
