/* test_picture_materials.c - how pictures show materials: glass, its order and its limits, emission, opacity
   maps, materials without light, white surfaces before the background. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/lab.h"
#include "../support/picture_shapes.h"
#include "base/memory/memory.h"
#include "picture/layers.h"
#include <stdio.h>

#define SIDE 40
#define MOST_PANES 40

/* Squares that face the camera, the first one nearest, each with a material of its own. */
typedef struct panes {
    double corners[12 * MOST_PANES];
    uint32_t triangles[6 * MOST_PANES], numbers[2 * MOST_PANES];
    float texcoords[12 * MOST_PANES];
    picture_material materials[MOST_PANES];
    picture_mesh mesh;
    picture_panel panel;
    picture picture;
} panes;

static void make_panes(panes *p, size_t count)
{
    static const double xy[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    static const uint32_t faces[6] = {0, 1, 2, 0, 2, 3};
    memset(p, 0, sizeof *p);
    for (size_t i = 0; i < count; i++) {
        for (size_t v = 0; v < 4; v++)
            memcpy(p->corners + 12 * i + 3 * v, (double[]){xy[v][0], xy[v][1], -0.01 * (double)i}, 24);
        for (size_t k = 0; k < 6; k++) {
            p->triangles[6 * i + k] = (uint32_t)(4 * i) + faces[k];
            p->texcoords[12 * i + 2 * k] = (float)(xy[faces[k]][0] + 1) / 2;
            p->texcoords[12 * i + 2 * k + 1] = (float)(xy[faces[k]][1] + 1) / 2;
        }
        p->numbers[2 * i] = p->numbers[2 * i + 1] = (uint32_t)i;
        p->materials[i] = (picture_material){.color = {1, 1, 1, 1}};
    }
    p->mesh = (picture_mesh){.positions = p->corners,
                             .vertex_count = 4 * count,
                             .triangles = p->triangles,
                             .triangle_count = 2 * count,
                             .texcoords = p->texcoords,
                             .materials = p->numbers,
                             .material_list = p->materials,
                             .material_count = count};
    p->panel = (picture_panel){.meshes = &p->mesh, .mesh_count = 1};
    p->picture = (picture){.width = SIDE,
                           .height = SIDE,
                           .panels = &p->panel,
                           .panel_count = 1,
                           .camera = shape_camera("front"),
                           .sees_through = true,
                           .threads = 1};
}

static void set_glass(picture_material *m, double red, double green, double blue, double alpha)
{
    *m = (picture_material){.color = {red, green, blue, alpha}, .is_see_through = true, .is_unlit = true};
}

static uint8_t *draw_picture(const picture *p)
{
    uint8_t *pixels;
    ffd_error error;
    if (ffd_picture_draw(p, NULL, &pixels, &error))
        fail_msg("%s", error.message);
    return pixels;
}

/* The linear light in the middle, in a triangle and away from its edges. */
static void middle_of(const panes *p, double light[3])
{
    uint8_t *const pixels = draw_picture(&p->picture);
    for (int c = 0; c < 3; c++)
        light[c] = lab_linear(pixels[3 * (SIDE * 20 + 25) + c]);
    ffd_free(pixels);
}

static void expect_light(const panes *p, double red, double green, double blue, double tolerance)
{
    const double wanted[3] = {red, green, blue};
    double found[3];
    middle_of(p, found);
    for (int c = 0; c < 3; c++)
        if (!(fabs(found[c] - wanted[c]) <= tolerance))
            fail_msg("%d: %g, not %g", c, found[c], wanted[c]);
}

static void glass_lets_through_what_is_behind_it(void **state)
{
    panes p;
    (void)state;
    make_panes(&p, 3);
    set_glass(&p.materials[0], 0, 0, 1, 0.3);
    set_glass(&p.materials[1], 0, 1, 0, 0.5);
    p.materials[2] = (picture_material){.color = {1, 0, 0, 1}, .is_unlit = true};
    expect_light(&p, 0.7 * 0.5, 0.7 * 0.5, 0.3, 0.01);
    /* Behind something opaque it is not seen. */
    p.materials[0] = p.materials[2];
    expect_light(&p, 1, 0, 0, 0.01);
    /* Wholly clear, it is as if it were not there; without layers it is solid. */
    set_glass(&p.materials[0], 0, 0, 1, 0);
    set_glass(&p.materials[1], 0, 1, 0, 0);
    expect_light(&p, 1, 0, 0, 0.01);
    p.picture.sees_through = false;
    expect_light(&p, 0, 0, 1, 0.01);
}

static void swap_panes(panes *p, size_t a, size_t b)
{
    uint32_t kept[6], number = p->numbers[2 * a];
    memcpy(kept, p->triangles + 6 * a, sizeof kept);
    memcpy(p->triangles + 6 * a, p->triangles + 6 * b, sizeof kept);
    memcpy(p->triangles + 6 * b, kept, sizeof kept);
    p->numbers[2 * a] = p->numbers[2 * a + 1] = p->numbers[2 * b];
    p->numbers[2 * b] = p->numbers[2 * b + 1] = number;
}

/* Whatever the order in the file, up to the layers that there is room for. Of more, nearly. */
static void the_order_of_panes_does_not_matter(void **state)
{
    (void)state;
    for (size_t count = LAYERS_MOST / 2; count <= MOST_PANES; count += LAYERS_MOST / 2) {
        double first[3], exact[3] = {0, 0, 0}, through = 1;
        panes p;
        make_panes(&p, count);
        for (size_t i = 0; i < count; i++) {
            const double color[3] = {i % 3 == 0, i % 3 == 1, (double)i / (double)count};
            set_glass(&p.materials[i], color[0], color[1], color[2], 0.2);
            for (int c = 0; c < 3; c++)
                exact[c] += through * 0.2 * color[c];
            through *= 0.8;
        }
        middle_of(&p, first);
        uint8_t *const pixels = draw_picture(&p.picture);
        for (int c = 0; c < 3; c++) {
            const double ground = lab_linear(pixels[3 * SIDE * 20 + c]);
            if (!(fabs(first[c] - exact[c] - through * ground) < (count > LAYERS_MOST ? 0.03 : 0.008)))
                fail_msg("%zu panes: %g, not %g", count, first[c], exact[c] + through * ground);
        }
        for (int turn = 0; turn < 20; turn++) {
            swap_panes(&p, (size_t)(7 * turn) % count, (size_t)(5 * turn + 3) % count);
            uint8_t *const again = draw_picture(&p.picture);
            if (count <= LAYERS_MOST)
                assert_memory_equal(pixels, again, (size_t)3 * SIDE * SIDE);
            for (int i = 0; i < 3 * SIDE * SIDE; i++)
                assert_true(fabs(lab_linear(pixels[i]) - lab_linear(again[i])) < 0.03);
            ffd_free(again);
        }
        ffd_free(pixels);
    }
}

static void what_emits_glows(void **state)
{
    panes p;
    (void)state;
    make_panes(&p, 1);
    p.materials[0] = (picture_material){.color = {0, 0, 0, 1}, .emission = {1, 0.6, 0.1}};
    expect_light(&p, 1, 0.6, 0.1, 0.01);
    p.materials[0].emission[2] = 40; /* emissive strength */
    expect_light(&p, 1, 0.6, 1, 0.01);
}

/* An image of one pixel. */
static texture make_texture(uint8_t red, uint8_t green, uint8_t blue, uint8_t alpha)
{
    image one = {1, 1, ffd_alloc(1, 4)};
    texture made;
    ffd_error error;
    assert_non_null(one.pixels);
    memcpy(one.pixels, (uint8_t[]){red, green, blue, alpha}, 4);
    assert_int_equal(ffd_texture_make(&one, &made, &error), FFD_OK);
    return made;
}

/* Left half black, right half white. */
static texture make_halves(void)
{
    image two = {16, 1, ffd_alloc(16, 4)};
    texture made;
    ffd_error error;
    assert_non_null(two.pixels);
    for (int i = 0; i < 16; i++)
        memcpy(two.pixels + 4 * i, i < 8 ? (uint8_t[]){0, 0, 0, 255} : (uint8_t[]){255, 255, 255, 255}, 4);
    assert_int_equal(ffd_texture_make(&two, &made, &error), FFD_OK);
    return made;
}

static void textures_of_emission_and_opacity(void **state)
{
    texture halves = make_halves(), clear = make_texture(255, 255, 255, 64), red = make_texture(255, 0, 0, 0);
    float turned[12];
    panes p;
    (void)state;
    make_panes(&p, 2);
    p.materials[1] = (picture_material){.color = {0, 0, 1, 1}, .is_unlit = true};
    p.materials[0] = (picture_material){.color = {0, 0, 0, 1},
                                        .emission = {0.5, 0.5, 0.5},
                                        .glow = &halves,
                                        .glow_wrap = {TEXTURE_CLAMP, TEXTURE_CLAMP}};
    expect_light(&p, 0.5, 0.5, 0.5, 0.01); /* at the right */
    /* Texture coordinates of its own. */
    for (size_t i = 0; i < 12; i++)
        turned[i] = i % 2 ? p.texcoords[i] : 1 - p.texcoords[i];
    float glow[24] = {0};
    memcpy(glow, turned, sizeof turned);
    p.mesh.glow_texcoords = glow;
    expect_light(&p, 0, 0, 0, 0.01);
    /* The opacity takes the place of the texture's alpha. */
    p.materials[0] = (picture_material){
        .color = {1, 1, 1, 1}, .texture = &red, .opacity = &clear, .is_see_through = true, .is_unlit = true};
    expect_light(&p, 64 / 255.0, 0, 1 - 64 / 255.0, 0.01);
    p.materials[0].alpha_cutoff = 0.3;
    expect_light(&p, 0, 0, 1, 0.01);
    ffd_texture_free(&halves);
    ffd_texture_free(&clear);
    ffd_texture_free(&red);
}

static void what_is_unlit_has_its_colour_from_every_side(void **state)
{
    static const char *const sides[] = {"front", "iso", "left", "top"};
    shape cube = shape_cube();
    uint32_t numbers[12] = {0};
    picture_material m = {.color = {0.5, 0.25, 0.1, 1}, .is_unlit = true};
    (void)state;
    cube.mesh.materials = numbers;
    cube.mesh.material_list = &m;
    cube.mesh.material_count = 1;
    const picture_panel panel = {.meshes = &cube.mesh, .mesh_count = 1};
    for (size_t i = 0; i < sizeof sides / sizeof *sides; i++) {
        picture p = {.width = SIDE, .height = SIDE, .panels = &panel, .panel_count = 1, .threads = 1};
        p.camera = shape_camera(sides[i]);
        uint8_t *const pixels = draw_picture(&p);
        for (int c = 0; c < 3; c++)
            assert_true(fabs(lab_linear(pixels[3 * (SIDE * 22 + 18) + c]) - m.color[c]) < 0.01);
        ffd_free(pixels);
    }
    shape_free(&cube);
}

/* A white ball: with light and without it stands out from the background all round. */
static void white_stands_out_from_the_background(void **state)
{
    shape ball = shape_ball(40, 20, 0, 0);
    uint32_t *const numbers = calloc(ball.mesh.triangle_count, sizeof *numbers);
    picture_material m = {.color = {1, 1, 1, 1}, .is_double_sided = true};
    assert_non_null(numbers);
    (void)state;
    ball.mesh.materials = numbers;
    ball.mesh.material_list = &m;
    ball.mesh.material_count = 1;
    const picture_panel panel = {.meshes = &ball.mesh, .mesh_count = 1}, none = {0};
    for (int unlit = 0; unlit < 2; unlit++) {
        m.is_unlit = unlit;
        picture p = {.width = 200, .height = 200, .panels = &panel, .panel_count = 1, .threads = 1};
        p.camera = shape_camera("iso");
        uint8_t *const shown = draw_picture(&p);
        p.panels = &none;
        uint8_t *const empty = draw_picture(&p);
        double sum = 0;
        int count = 0, weak = 0;
        for (int y = 0; y < 200; y++)
            for (int x = 0; x < 200; x++) {
                const uint8_t *const a = shown + 3 * (200 * y + x), *const b = empty + 3 * (200 * y + x);
                if ((x - 100) * (x - 100) + (y - 100) * (y - 100) > 90 * 90)
                    continue;
                const double distance = lab_distance(a, b);
                sum += distance;
                weak += distance < 5;
                count++;
            }
        print_message("unlit %d: %g on average, %d of %d below 5\n", unlit, sum / count, weak, count);
        assert_true(sum / count > 9 && weak < count / 20);
        ffd_free(shown);
        ffd_free(empty);
    }
    free(numbers);
    shape_free(&ball);
}

static void any_number_of_threads_sees_through_alike(void **state)
{
    shape ball = shape_ball(49, 25, 4, 0.2);
    uint32_t *const numbers = calloc(ball.mesh.triangle_count, sizeof *numbers);
    picture_material m = {.color = {0.2, 0.5, 0.8, 0.4}, .is_double_sided = true, .is_see_through = true};
    assert_non_null(numbers);
    (void)state;
    ball.mesh.materials = numbers;
    ball.mesh.material_list = &m;
    ball.mesh.material_count = 1;
    const picture_panel panel = {.meshes = &ball.mesh, .mesh_count = 1};
    picture p = {
        .width = 160, .height = 120, .panels = &panel, .panel_count = 1, .sees_through = true, .threads = 1};
    p.camera = shape_camera("iso");
    uint8_t *const one = draw_picture(&p);
    for (p.threads = 2; p.threads <= 7; p.threads += 5) {
        uint8_t *const more = draw_picture(&p);
        assert_memory_equal(one, more, (size_t)3 * 160 * 120);
        ffd_free(more);
    }
    ffd_free(one);
    free(numbers);
    shape_free(&ball);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(glass_lets_through_what_is_behind_it),
        cmocka_unit_test(the_order_of_panes_does_not_matter),
        cmocka_unit_test(what_emits_glows),
        cmocka_unit_test(textures_of_emission_and_opacity),
        cmocka_unit_test(what_is_unlit_has_its_colour_from_every_side),
        cmocka_unit_test(white_stands_out_from_the_background),
        cmocka_unit_test(any_number_of_threads_sees_through_alike),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
