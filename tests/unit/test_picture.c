/* test_picture.c - whole pictures: cameras, light and creases, textures, cages, letters, threads and memory.

       test_picture FOLDER      the folder tests/golden/pictures with the expected pixels of some pictures;
                                FFD_REMEMBER=1 writes them */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/picture_shapes.h"
#include "base/file/input.h"
#include "base/memory/memory.h"
#include "base/vector/vec.h"
#include "mesh/bounds.h"
#include "mesh/twins.h"
#include "picture/letters.h"
#include "picture/surface.h"
#include <stdio.h>
#include <string.h>

static const char *golden;

static bool near(double a, double b)
{
    return fabs(a - b) < 1e-12;
}

static const double upwards[3][3] = {{0, 1, 0}, {0, 0, 1}, {1, 0, 0}}; /* by ffd_up */

static void check_axes(const camera *c, ffd_up up)
{
    double cross[3];
    vec_cross(c->right, c->up, cross);
    for (int a = 0; a < 3; a++)
        assert_true(near(cross[a], c->back[a]));
    assert_true(near(vec_dot(c->right, c->right), 1) && near(vec_dot(c->up, c->up), 1));
    /* The horizon is horizontal, and nothing is upside down. */
    assert_true(near(vec_dot(c->right, upwards[up]), 0) && vec_dot(c->up, upwards[up]) > -1e-12);
}

static void cameras_have_axes_of_a_right_hand(void **state)
{
    static const double directions[][3] = {{1, 2, 3}, {-1e300, 0, 1e-300}, {0, -1, 0}, {0, 5e-324, 0},
                                           {0, 0, 1}, {0, 0, -3},          {1, 0, 0}};
    (void)state;
    for (int up = 0; up < 3; up++) {
        const camera iso = ffd_camera_iso((ffd_up)up);
        check_axes(&iso, (ffd_up)up);
        assert_true(vec_dot(iso.back, upwards[up]) > 0.3);
        for (size_t i = 0; i < sizeof directions / sizeof *directions; i++) {
            camera c;
            assert_true(ffd_camera_from(directions[i], (ffd_up)up, &c));
            check_axes(&c, (ffd_up)up);
            assert_true(vec_dot(c.back, directions[i]) > 0);
        }
    }
}

/* Named sides follow what is upwards; numbers are in the axes of the scene. */
static void cameras_look_from_where_they_say(void **state)
{
    static const struct {
        const char *name;
        double from[3][3]; /* by ffd_up */
    } views[] = {
        {"front", {{0, 0, 1}, {0, -1, 0}, {0, 0, 1}}}, {"back", {{0, 0, -1}, {0, 1, 0}, {0, 0, -1}}},
        {"left", {{-1, 0, 0}, {-1, 0, 0}, {0, 1, 0}}}, {"right", {{1, 0, 0}, {1, 0, 0}, {0, -1, 0}}},
        {"top", {{0, 1, 0}, {0, 0, 1}, {1, 0, 0}}},    {"bottom", {{0, -1, 0}, {0, 0, -1}, {-1, 0, 0}}}};
    static const double numbers[3] = {3, 0, 4};
    static const double refused[][3] = {{0, 0, 0}, {NAN, 1, 1}, {HUGE_VAL, 0, 0}};
    double direction[3];
    camera c;
    (void)state;
    for (int up = 0; up < 3; up++) {
        for (size_t i = 0; i < sizeof views / sizeof *views; i++) {
            assert_true(ffd_camera_side(views[i].name, (ffd_up)up, direction));
            assert_true(ffd_camera_from(direction, (ffd_up)up, &c));
            for (int a = 0; a < 3; a++)
                assert_true(near(c.back[a], views[i].from[up][a]));
        }
        assert_true(ffd_camera_from(numbers, (ffd_up)up, &c));
        assert_true(near(c.back[0], 0.6) && near(c.back[2], 0.8));
        for (size_t i = 0; i < sizeof refused / sizeof *refused; i++)
            assert_false(ffd_camera_from(refused[i], (ffd_up)up, &c));
    }
    assert_false(ffd_camera_side("Front", FFD_UP_Y, direction) || ffd_camera_side("", FFD_UP_Y, direction));
}

static void a_camera_is_fitted_to_what_it_sees(void **state)
{
    shape ball = shape_ball(40, 20, 3, 0.3);
    camera c;
    (void)state;
    assert_true(ffd_camera_from((double[]){2, 1, 3}, FFD_UP_Y, &c));
    for (int wide = 0; wide < 2; wide++) {
        ffd_bounds seen = ffd_bounds_empty(), found = ffd_bounds_empty();
        const double width = wide ? 300 : 100, height = 200;
        ffd_camera_widen(&c, ball.positions, ball.mesh.vertex_count, &seen);
        const projection to = ffd_camera_fit(&c, &seen, 500, 400, width, height);
        for (size_t v = 0; v < ball.mesh.vertex_count; v++) {
            double at[3];
            projection_apply(&to, ball.positions + 3 * v, at);
            ffd_bounds_widen(&found, at);
        }
        const double across = found.max[0] - found.min[0], down = found.max[1] - found.min[1];
        assert_true(fabs(found.min[0] + found.max[0] - 1000) < 1e-9 &&
                    fabs(found.min[1] + found.max[1] - 800) < 1e-9);
        assert_true(across < width + 1e-9 && down < height + 1e-9);
        assert_true(fabs(across - width) < 1e-9 || fabs(down - height) < 1e-9);
    }
    shape_free(&ball);
}

static void nothing_and_one_point_have_a_projection_too(void **state)
{
    const ffd_bounds none = ffd_bounds_empty(),
                     huge = {.min = {-1e308, -1e308, -1e308}, .max = {1e308, 1e308, 1e308}},
                     point = {.min = {5, 5, 5}, .max = {5, 5, 5}};
    const ffd_bounds *const all[] = {&none, &huge, &point};
    const camera c = shape_camera("front");
    (void)state;
    for (int i = 0; i < 3; i++) {
        const projection to = ffd_camera_fit(&c, all[i], 50, 60, 100, 100);
        double at[3];
        assert_true(to.scale > 0 && isfinite(to.scale));
        projection_apply(&to, i == 2 ? (double[]){5, 5, 5} : (double[]){0, 0, 0}, at);
        assert_true(near(at[0], 50) && near(at[1], 60));
    }
}

static void normals_break_at_creases_only(void **state)
{
    shape cube = shape_cube(), ball = shape_ball(40, 20, 0, 0);
    surface_normals found;
    ffd_error error;
    (void)state;
    assert_int_equal(ffd_surface_normals(&cube.mesh, 100, NULL, &found, &error), FFD_OK);
    /* Three faces meet at each of eight corners. */
    assert_int_equal(found.split_count, 16);
    for (size_t t = 0; t < 12; t++)
        for (size_t c = 0; c < 3; c++) {
            const uint32_t v = found.triangles[3 * t + c];
            assert_int_equal(v < 8 ? v : found.origins[v - 8], cube.triangles[3 * t + c]);
            /* Each normal is along one axis, outwards. */
            int axes = 0;
            for (size_t a = 0; a < 3; a++) {
                const double n = found.normals[3 * v + a];
                axes += n > 0 || n < 0;
                assert_true(n * cube.positions[3 * (size_t)cube.triangles[3 * t + c] + a] >= 0);
            }
            assert_int_equal(axes, 1);
        }
    ffd_free(found.normals);
    ffd_free(found.origins);
    ffd_free(found.triangles);
    uint32_t twins[800];
    assert_int_equal(ffd_positions_twins(ball.positions, 800, 1, twins, &error), FFD_OK);
    ball.mesh.twins = twins;
    assert_int_equal(ffd_surface_normals(&ball.mesh, 100, NULL, &found, &error), FFD_OK);
    assert_null(found.triangles);
    for (size_t r = 0; r < 20; r++) {
        assert_int_equal(twins[40 * r + 39], r == 0 || r == 19 ? twins[40 * r] : 40 * r);
        assert_memory_equal(found.normals + 3 * (40 * r), found.normals + 3 * (40 * r + 39),
                            3 * sizeof(float));
    }
    /* Outwards, like the position itself. */
    for (size_t v = 0; v < 800; v++) {
        const double n[3] = {found.normals[3 * v], found.normals[3 * v + 1], found.normals[3 * v + 2]};
        assert_true(vec_dot(n, ball.positions + 3 * v) > 0.99 * vec_length(n));
    }
    ffd_free(found.normals);
    shape_free(&cube);
    shape_free(&ball);
}

/* Alternating black and white columns, each this many texels wide. */
static texture make_stripes(uint32_t width, uint32_t height, uint32_t each)
{
    image stripes = {width, height, ffd_alloc((size_t)width * height, 4)};
    texture made;
    ffd_error error;
    assert_non_null(stripes.pixels);
    for (size_t i = 0; i < (size_t)width * height; i++)
        memset(stripes.pixels + 4 * i, i % width / each % 2 ? 255 : 0, 3);
    for (size_t i = 0; i < (size_t)width * height; i++)
        stripes.pixels[4 * i + 3] = 255;
    assert_int_equal(ffd_texture_make(&stripes, &made, &error), FFD_OK);
    return made;
}

static void a_texture_far_away_is_the_mean_of_its_light(void **state)
{
    static const texture_wrap wrap[2] = {TEXTURE_REPEAT, TEXTURE_REPEAT};
    texture stripes = make_stripes(64, 37, 1);
    linear_tables tables;
    double c[4];
    (void)state;
    ffd_linear_fill(&tables);
    /* 64 x 37, 32 x 18, 16 x 9, 8 x 4, 4 x 2, 2 x 1, 1 x 1. */
    assert_int_equal(stripes.level_count, 7);
    for (double size = 2; size < 100; size *= 1.7) {
        ffd_texture_sample(&stripes, &tables, wrap, 0.3, 0.7, size, c);
        assert_true(fabs(c[0] - 0.5) < 0.003 && near(c[3], 1));
    }
    /* Enlarged: the middle of a column, and the border between two. */
    ffd_texture_sample(&stripes, &tables, wrap, 3.5 / 64, 0.5, 1, c);
    assert_true(near(c[0], 1));
    ffd_texture_sample(&stripes, &tables, wrap, 4.5 / 64 - 7, 0.5, 0, c);
    assert_true(near(c[0], 0));
    ffd_texture_sample(&stripes, &tables, wrap, 4.0 / 64, 0.5, 0.5, c);
    assert_true(near(c[0], 0.5));
    /* Halfway between two levels. */
    ffd_texture_sample(&stripes, &tables, wrap, 3.5 / 64, 0.5, 1.5, c);
    assert_true(fabs(c[0] - 0.75) < 0.003);
    ffd_texture_sample(&stripes, &tables, wrap, NAN, HUGE_VAL, 1, c);
    assert_true(c[0] >= 0 && c[0] <= 1);
    ffd_texture_free(&stripes);
    /* Two halves are visible until a pixel spans both. */
    texture halves = make_stripes(64, 64, 32);
    for (double size = 1; size < 100; size *= 2) {
        ffd_texture_sample(&halves, &tables, wrap, 0.75, 0.5, size, c);
        assert_true(fabs(c[0] - (size < 64 ? 1 : 0.5)) < 0.003);
    }
    ffd_texture_free(&halves);
}

static void textures_go_on_as_they_are_told(void **state)
{
    texture stripes = make_stripes(4, 1, 1); /* black, white, black, white */
    linear_tables tables;
    static const struct {
        texture_wrap wrap;
        double u, color;
    } cases[] = {{TEXTURE_CLAMP, -3, 0},      {TEXTURE_CLAMP, 9, 1},      {TEXTURE_REPEAT, 1.125, 0},
                 {TEXTURE_REPEAT, -0.125, 1}, {TEXTURE_MIRROR, 1.125, 1}, {TEXTURE_MIRROR, -0.125, 0},
                 {TEXTURE_REPEAT, 0, 0.5},    {TEXTURE_MIRROR, 0, 0},     {TEXTURE_MIRROR, 2.375, 1}};
    (void)state;
    ffd_linear_fill(&tables);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        double c[4];
        const texture_wrap wrap[2] = {cases[i].wrap, TEXTURE_CLAMP};
        ffd_texture_sample(&stripes, &tables, wrap, cases[i].u, 0.5, 0, c);
        if (!near(c[0], cases[i].color))
            fail_msg("wrap %d at %g is %g", (int)cases[i].wrap, cases[i].u, c[0]);
    }
    ffd_texture_free(&stripes);
}

static void what_is_cut_away_lends_no_colour(void **state)
{
    static const texture_wrap wrap[2] = {TEXTURE_CLAMP, TEXTURE_CLAMP};
    image two = {2, 1, ffd_alloc(2, 4)};
    texture made;
    linear_tables tables;
    ffd_error error;
    double c[4];
    (void)state;
    assert_non_null(two.pixels);
    memcpy(two.pixels, (uint8_t[]){255, 0, 0, 255, 0, 255, 0, 0}, 8);
    assert_int_equal(ffd_texture_make(&two, &made, &error), FFD_OK);
    ffd_linear_fill(&tables);
    ffd_texture_sample(&made, &tables, wrap, 0.5, 0.5, 8, c);
    assert_true(near(c[0], 1) && near(c[1], 0) && near(c[3], 128 / 255.0));
    ffd_texture_free(&made);
}

static void bytes_survive_the_way_to_light_and_back(void **state)
{
    linear_tables tables;
    (void)state;
    ffd_linear_fill(&tables);
    for (unsigned byte = 0; byte < 256; byte++)
        assert_in_range(linear_to_byte(&tables, tables.light[byte]) + 1u, byte, byte + 2);
    for (unsigned byte = 30; byte < 256; byte++)
        assert_int_equal(linear_to_byte(&tables, tables.light[byte]), byte);
}

/* Returns the red of a pixel. */
static int red_at(const picture *p, const uint8_t *pixels, uint32_t x, uint32_t y)
{
    return pixels[3 * ((size_t)y * p->width + x)];
}

static uint8_t *draw_all(const picture *p)
{
    uint8_t *pixels;
    ffd_error error;
    if (ffd_picture_draw(p, NULL, &pixels, &error))
        fail_msg("%s", error.message);
    return pixels;
}

/* A white square and a black line in front of it and behind it. */
static void what_hides_a_line_lets_a_little_through(void **state)
{
    static const double corners[] = {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0};
    static const uint32_t faces[] = {0, 1, 2, 0, 2, 3}, line[] = {0, 1}, number[] = {0, 0};
    static const picture_material white = {.color = {0.8, 0.8, 0.8, 1}};
    const picture_mesh square = {.positions = corners,
                                 .vertex_count = 4,
                                 .triangles = faces,
                                 .triangle_count = 2,
                                 .materials = number,
                                 .material_list = &white,
                                 .material_count = 1};
    int reds[3];
    (void)state;
    for (int i = 0; i < 3; i++) {
        const double z = i == 0 ? 0.5 : i == 1 ? -0.5 : 0, ends[] = {-0.9, 0, z, 0.9, 0, z};
        const picture_cage cage = {
            .points = ends, .point_count = 2, .segments = line, .segment_count = 1, .width = 3, .radius = -1};
        const picture_panel panel = {.meshes = &square, .mesh_count = 1, .cages = &cage, .cage_count = 1};
        picture p = {.width = 100, .height = 100, .panels = &panel, .panel_count = 1, .threads = 1};
        p.camera = shape_camera("front");
        uint8_t *const pixels = draw_all(&p);
        reds[i] = red_at(&p, pixels, 50, 50);
        assert_true(red_at(&p, pixels, 50, 30) > 200);
        ffd_free(pixels);
    }
    assert_in_range(reds[0], 0, 5);
    assert_in_range(reds[1], 150, 230);
    /* A line within the surface is visible. */
    assert_in_range(reds[2], 0, 5);
}

static void letters_stay_in_their_place_and_differ(void **state)
{
    static uint64_t pixels[95][20 * 20];
    (void)state;
    for (int c = ' '; c <= '~'; c++) {
        uint64_t *const at = pixels[c - ' '];
        const stroke_target into = {0, 0, 20, 20, at, NULL};
        const char text[2] = {(char)c, 0};
        for (int i = 0; i < 400; i++)
            at[i] = 0;
        ffd_letters_draw(&into, text, 4, 4, 2, linear_pack(LINEAR_ONE, 0, 0));
        for (int i = 0; i < 400; i++)
            if (at[i] && (i % 20 < 3 || i % 20 > 14 || i / 20 < 3 || i / 20 > 20))
                fail_msg("'%c' is at %d,%d", c, i % 20, i / 20);
        for (int other = ' '; other < c; other++)
            if (memcmp(at, pixels[other - ' '], sizeof pixels[0]) == 0 && !(other == '0' && c == 'O'))
                fail_msg("'%c' looks like '%c'", c, other);
    }
    assert_true(near(ffd_letters_width("ab\xc3\xa4"), 17) && near(ffd_letters_width(""), 0));
}

/* Scenes. */

typedef struct scene {
    shape ball, cube;
    shape_cage cage;
    texture texture;
    picture_material material;
    uint32_t numbers[12];
    picture_mesh both[2];
    picture_panel panels[2];
    uint8_t ramp[64][3];
    picture_scale scale;
    picture picture;
} scene;

static const char *const steps[] = {"0", "0.5", "1 mm"}, *const kinds[] = {"inside", "outside"};

/* 0: textured cube; 1: coloured ball with a scale; 2: before and after with cages; 3: status fields. */
static void make_scene(scene *s, int which)
{
    memset(s, 0, sizeof *s);
    s->ball = shape_ball(49, 25, which == 2 ? 0 : 4, which == 2 ? 0 : 0.2);
    s->cube = shape_cube();
    s->cage = shape_box_cage(3, 1.2);
    s->texture = make_stripes(16, 16, 1);
    s->material =
        (picture_material){.color = {1, 0.8, 0.5, 1}, .texture = &s->texture, .is_double_sided = true};
    s->cube.mesh.texcoords = s->cube.texcoords;
    s->cube.mesh.materials = s->numbers;
    s->cube.mesh.material_list = &s->material;
    s->cube.mesh.material_count = 1;
    for (int i = 0; i < 64; i++)
        for (int c = 0; c < 3; c++)
            s->ramp[i][c] = (uint8_t)((c == 0 ? 60 + 3 * i : c == 1 ? 30 + 3 * i : 150 - i) & 255);
    for (size_t v = 0; v < s->ball.mesh.vertex_count; v++) {
        memcpy(s->ball.colors + 4 * v, s->ramp[(size_t)(31.5 + 31 * s->ball.positions[3 * v + 1] / 1.5)], 3);
        s->ball.colors[4 * v + 3] = 255;
    }
    if (which == 1 || which == 3)
        s->ball.mesh.colors = s->ball.colors;
    s->both[0] = which == 0 ? s->cube.mesh : s->ball.mesh;
    s->both[1] = s->cube.mesh;
    s->panels[0] = (picture_panel){.caption = which == 2 ? "before" : NULL,
                                   .meshes = &s->both[0],
                                   .mesh_count = 1,
                                   .cages = &s->cage.cage,
                                   .cage_count = which == 2};
    s->panels[1] = (picture_panel){
        .caption = "after", .meshes = &s->both[1], .mesh_count = 1, .cages = &s->cage.cage, .cage_count = 1};
    s->scale = (picture_scale){which == 1 ? "moved" : NULL, (const uint8_t(*)[3])s->ramp, which == 3 ? 2 : 64,
                               which == 3 ? kinds : steps,  which == 3 ? 2 : 3,           which == 3};
    s->picture = (picture){.width = 160,
                           .height = 120,
                           .panels = s->panels,
                           .panel_count = which == 2 ? 2 : 1,
                           .scale = which % 2 ? &s->scale : NULL,
                           .threads = 1};
    s->picture.camera = shape_camera(which == 3 ? "front" : "iso");
}

static void free_scene(scene *s)
{
    shape_free(&s->ball);
    shape_free(&s->cube);
    shape_cage_free(&s->cage);
    ffd_texture_free(&s->texture);
}

static void any_number_of_threads_draws_the_same(void **state)
{
    (void)state;
    for (int which = 0; which < 4; which++) {
        scene s;
        make_scene(&s, which);
        uint8_t *const one = draw_all(&s.picture);
        for (int threads = 2; threads <= 7; threads += 5) {
            s.picture.threads = threads;
            uint8_t *const more = draw_all(&s.picture);
            assert_memory_equal(one, more, (size_t)3 * 160 * 120);
            ffd_free(more);
        }
        ffd_free(one);
        free_scene(&s);
    }
}

static ffd_status append(void *file, const void *bytes, size_t size, ffd_error *error)
{
    (void)error;
    return fwrite(bytes, 1, size, file) == size ? FFD_OK : FFD_E_IO;
}

static void save(const picture *p, const char *path)
{
    uint8_t *const pixels = draw_all(p);
    FILE *const file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(ffd_png_write(pixels, p->width, p->height, 3, append, file, NULL), FFD_OK);
    assert_int_equal(fclose(file), 0);
    ffd_free(pixels);
}

static void pictures_look_as_ever(void **state)
{
    static const char *const names[] = {"texture", "scale", "cages", "fields"};
    const char *const remember = getenv("FFD_REMEMBER");
    (void)state;
    for (int which = 0; which < 4; which++) {
        scene s;
        char path[4096];
        ffd_error error;
        file_input file;
        image then;
        make_scene(&s, which);
        assert_true(snprintf(path, sizeof path, "%s/%s.png", golden, names[which]) < (int)sizeof path);
        if (remember && *remember == '1')
            save(&s.picture, path);
        assert_int_equal(ffd_file_load(path, &file, &error), FFD_OK);
        assert_int_equal(ffd_image_decode(file.data, file.size, NULL, &then, &error), FFD_OK);
        uint8_t *const now = draw_all(&s.picture);
        assert_true(then.width == 160 && then.height == 120);
        for (size_t i = 0; i < 160 * 120; i++)
            if (memcmp(now + 3 * i, then.pixels + 4 * i, 3) != 0)
                fail_msg("%s: pixel %zu,%zu is %d %d %d", names[which], i % 160, i / 160, now[3 * i],
                         now[3 * i + 1], now[3 * i + 2]);
        ffd_free(now);
        ffd_free(then.pixels);
        ffd_file_unload(&file);
        free_scene(&s);
    }
}

static void what_is_wrong_with_a_mesh_is_left_out(void **state)
{
    scene s;
    ffd_error error;
    (void)state;
    make_scene(&s, 1);
    uint8_t *const whole = draw_all(&s.picture);
    const ffd_bounds box = {.min = {-1.2, -1, -1.2}, .max = {1.2, 1, 1.2}}; /* along the camera's axes */
    s.picture.seen = &box;
    s.ball.positions[300] = NAN;
    s.ball.positions[601] = 1e300;
    s.ball.positions[900] = -HUGE_VAL;
    s.ball.triangles[30] = UINT32_MAX;
    uint8_t *const rest = draw_all(&s.picture);
    ffd_free(rest);
    ffd_free(whole);
    memory_budget budget = ffd_budget_make(0);
    budget.most = 1000;
    uint8_t *pixels;
    assert_int_equal(ffd_picture_draw(&s.picture, &budget, &pixels, &error), FFD_E_LIMIT);
    assert_null(pixels);
    s.picture.width = 0;
    assert_int_equal(ffd_picture_draw(&s.picture, NULL, &pixels, &error), FFD_E_ARGUMENT);
    s.picture.width = s.picture.height = 32767;
    assert_int_equal(ffd_picture_draw(&s.picture, NULL, &pixels, &error), FFD_E_ARGUMENT);
    free_scene(&s);
}

/* A cube has few vertices, but a crease at each one: 36 corners need their own vertex. */
static void the_budget_holds_for_creases_and_lists_too(void **state)
{
    scene s;
    ffd_error error;
    uint8_t *pixels;
    (void)state;
    make_scene(&s, 0);
    memory_budget budget = ffd_budget_make(0);
    const uint64_t least = budget.taken + 3 * 160 * 120 + 8 * 48 + 12 * 40;
    budget.most = least - 1;
    assert_int_equal(ffd_picture_draw(&s.picture, &budget, &pixels, &error), FFD_E_LIMIT);
    s.picture.width = s.picture.height = 16;
    budget.most = budget.taken + 3 * 16 * 16 + 8 * 48 + 12 * 40 + 36 * 64 - 1;
    assert_int_equal(ffd_picture_draw(&s.picture, &budget, &pixels, &error), FFD_E_LIMIT);
    budget.most++;
    assert_int_equal(ffd_picture_draw(&s.picture, &budget, &pixels, &error), FFD_OK);
    ffd_free(pixels);
    free_scene(&s);
}

static void memory_may_run_out_anywhere(void **state)
{
    scene s;
    (void)state;
    make_scene(&s, 2);
    long successes = 0;
    ffd_status status;
    do {
        ffd_error error;
        uint8_t *pixels;
        ffd_alloc_fail_after(successes++);
        status = ffd_picture_draw(&s.picture, NULL, &pixels, &error);
        ffd_alloc_fail_after(-1);
        assert_true(status == FFD_E_MEMORY || (!status && pixels));
        ffd_free(pixels);
    } while (status);
    assert_true(successes > 20);
    free_scene(&s);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cameras_have_axes_of_a_right_hand),
        cmocka_unit_test(cameras_look_from_where_they_say),
        cmocka_unit_test(a_camera_is_fitted_to_what_it_sees),
        cmocka_unit_test(nothing_and_one_point_have_a_projection_too),
        cmocka_unit_test(normals_break_at_creases_only),
        cmocka_unit_test(a_texture_far_away_is_the_mean_of_its_light),
        cmocka_unit_test(textures_go_on_as_they_are_told),
        cmocka_unit_test(what_is_cut_away_lends_no_colour),
        cmocka_unit_test(bytes_survive_the_way_to_light_and_back),
        cmocka_unit_test(what_hides_a_line_lets_a_little_through),
        cmocka_unit_test(letters_stay_in_their_place_and_differ),
        cmocka_unit_test(any_number_of_threads_draws_the_same),
        cmocka_unit_test(pictures_look_as_ever),
        cmocka_unit_test(what_is_wrong_with_a_mesh_is_left_out),
        cmocka_unit_test(the_budget_holds_for_creases_and_lists_too),
        cmocka_unit_test(memory_may_run_out_anywhere),
    };
    if (argc != 2)
        return 2;
    golden = argv[1];
    return cmocka_run_group_tests(tests, NULL, NULL);
}
