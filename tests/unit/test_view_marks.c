/* test_view_marks.c - what marks show in pictures: each is told apart from all colours of the scales by eyes
   of every kind, and the legend has those that are there; and the letters of the legend where the picture is
   small. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/lab.h"
#include "base/memory/memory.h"
#include "picture/layout.h"
#include "picture/letters.h"
#include "picture/stripes.h"
#include "view/view_dots.h"
#include "view/view_palette.h"
#include <string.h>

static double positions[6] = {0, 0, 0, 1, 0, 0}, moved[6] = {0, 0, 0, 1, 0, 3}, dets[5] = {0.1, 9, 1, 1, 1};
static uint8_t statuses[2] = {0, 1}, flipped[1] = {1};
static view_tear tear = {{0, 1}, 1};

static view_scene make_scene(void)
{
    return (view_scene){.vertex_count = 2,
                        .before = positions,
                        .after = moved,
                        .statuses = statuses,
                        .dets = dets,
                        .displacement_max = 3};
}

static view_frame frame_of(const view_scene *scene)
{
    view_frame frame = ffd_view_frame_none();
    frame.displacement = scene->displacement_max;
    frame.det = ffd_view_most_det(scene);
    return frame;
}

/* Ten times what is just noticed. */
#define FAR_APART 25

/* In stripes of two colours, one of these differs much from whatever colour a scale has there. */
static void marks_differ_from_the_scales_for_every_eye(void **state)
{
    static const ffd_view_color scales[] = {FFD_VIEW_DISPLACEMENT, FFD_VIEW_DET, FFD_VIEW_STATUS};
    static const uint8_t(*const marks[])[3] = {ffd_view_flipped, ffd_view_folded, ffd_view_torn};
    double least = 1000;
    (void)state;
    for (size_t s = 0; s < 3; s++) {
        view_scene scene = make_scene();
        uint8_t all[5] = {0, 1, 2, 3, 4};
        scene.vertex_count = scales[s] == FFD_VIEW_STATUS ? 5 : 2;
        scene.statuses = all;
        static view_palette palette;
        const view_frame frame = frame_of(&scene);
        ffd_view_palette_make(&scene, &frame, scales[s], &palette);
        assert_int_equal(palette.color, scales[s]);
        assert_int_equal(palette.scale.color_count, scales[s] == FFD_VIEW_STATUS ? 5 : PALETTE_COLORS);
        for (int by = VISION_NORMAL; by < VISIONS; by++)
            for (size_t m = 0; m < 3; m++)
                for (size_t i = 0; i < palette.scale.color_count; i++) {
                    const double a = lab_distance_by(marks[m][0], palette.ramp[i], (vision)by),
                                 b = lab_distance_by(marks[m][1], palette.ramp[i], (vision)by);
                    const double distance = a > b ? a : b;
                    least = distance < least ? distance : least;
                    if (distance < FAR_APART)
                        fail_msg("mark %zu and colour %zu of scale %zu: %g to eye %d", m, i, s, distance, by);
                }
    }
    print_message("the least distance is %g\n", least);
    for (int by = VISION_NORMAL; by < VISIONS; by++)
        for (size_t m = 0; m < 3; m++)
            assert_true(lab_distance_by(marks[m][0], marks[m][1], (vision)by) > 40);
}

/* The second colour of surfaces is that of the first one in the shade of its stripe. */
static void stripes_in_the_legend_are_those_of_surfaces(void **state)
{
    static const uint8_t(*const marks[])[3] = {ffd_view_flipped, ffd_view_folded};
    (void)state;
    for (size_t m = 0; m < 2; m++)
        for (int c = 0; c < 3; c++)
            assert_true(fabs(lab_linear(marks[m][1][c]) - STRIPE_DARK * lab_linear(marks[m][0][c])) < 0.003);
}

static void stripes_go_round_every_corner(void **state)
{
    (void)state;
    for (int64_t x = -40; x < 40; x++)
        for (int64_t y = -40; y < 40; y++) {
            const bool rising = ffd_stripes_second(STRIPES_RISING, 10, x, y),
                       falling = ffd_stripes_second(STRIPES_FALLING, 10, x, y);
            assert_int_equal(rising, ffd_stripes_second(STRIPES_RISING, 10, x - 3, y + 3));
            assert_int_equal(falling, ffd_stripes_second(STRIPES_FALLING, 10, x + 3, y + 3));
            assert_true(rising != ffd_stripes_second(STRIPES_RISING, 10, x + 5, y));
            assert_false(ffd_stripes_second(STRIPES_NONE, 10, x, y));
        }
}

static void the_legend_has_the_marks_that_are_there(void **state)
{
    picture_mark marks[PALETTE_MARKS];
    static view_palette palette;
    (void)state;
    view_scene scene = make_scene();
    assert_int_equal(ffd_view_marks(&scene, FFD_VIEW_DISPLACEMENT, marks), 0);
    scene.flipped = flipped;
    scene.tears = &tear;
    scene.tear_count = 1;
    scene.witness.is_there = true;
    assert_int_equal(ffd_view_marks(&scene, FFD_VIEW_DISPLACEMENT, marks), 3);
    assert_string_equal(marks[0].label, "flipped");
    assert_string_equal(marks[1].label, "torn");
    assert_string_equal(marks[2].label, "fold");
    assert_true(marks[1].is_line && !marks[0].is_line && marks[0].stripes != marks[2].stripes);
    /* det F below 0 is drawn as a fold only where det F is. */
    scene = make_scene();
    dets[0] = -0.5;
    assert_int_equal(ffd_view_marks(&scene, FFD_VIEW_DISPLACEMENT, marks), 0);
    const view_frame frame = frame_of(&scene);
    ffd_view_palette_make(&scene, &frame, FFD_VIEW_DET, &palette);
    assert_int_equal(ffd_view_marks(&scene, FFD_VIEW_DET, marks), 1);
    assert_string_equal(marks[0].label, "fold");
    uint8_t colors[8];
    ffd_view_palette_fill(&palette, &scene, 1, colors);
    assert_true(colors[3] == 0 && colors[7] == 255);
    dets[0] = 0.1;
}

/* Its mark has no alpha, which would be the opacity of a splat. */
static void a_splat_in_folded_volume_is_seen(void **state)
{
    static float spread[12] = {1, 0, 0, 1, 0, 1, 1, 0, 0, 1, 0, 1};
    static view_palette palette;
    uint8_t colors[8];
    view_dots dots = {.all = NULL};
    (void)state;
    view_scene scene = make_scene();
    scene.splats[0] = scene.splats[1] = spread;
    dets[0] = -0.5;
    const view_frame frame = frame_of(&scene);
    ffd_view_palette_make(&scene, &frame, FFD_VIEW_DET, &palette);
    ffd_view_palette_fill(&palette, &scene, 1, colors);
    assert_int_equal(colors[3], 0);
    assert_int_equal(ffd_view_dots_make(&scene, 1, moved, colors, false, 900, &dots, NULL), FFD_OK);
    assert_int_equal(dots.points.count, 2);
    for (size_t i = 0; i < 2; i++) {
        assert_memory_equal(dots.points.colors + 4 * i, colors + 4 * i, 3);
        assert_int_equal(dots.points.colors[4 * i + 3], 255);
    }
    ffd_view_dots_free(&dots);
    dets[0] = 0.1;
}

/* Letters in a picture of 1600 x 900 that is shrunk to 320 pixels. */
#define SHRINK 5
#define CELL 80
#define SMALL (CELL / SHRINK)

static void draw_letter(char letter, double x, double y, double dot, double small[SMALL * SMALL])
{
    static uint64_t pixels[CELL * CELL];
    const stroke_target into = {0, 0, CELL, CELL, pixels, NULL};
    const char text[2] = {letter, 0};
    memset(pixels, 0, sizeof pixels);
    ffd_letters_draw(&into, text, x, y, dot, linear_pack(LINEAR_ONE, 0, 0));
    for (int i = 0; i < SMALL * SMALL; i++) {
        small[i] = 0;
        for (int k = 0; k < SHRINK * SHRINK; k++) {
            const int px = i % SMALL * SHRINK + k % SHRINK, py = i / SMALL * SHRINK + k / SHRINK;
            small[i] += linear_part(pixels[CELL * py + px], 0) / (double)LINEAR_ONE / (SHRINK * SHRINK);
        }
    }
}

/* Returns how much two letters differ where they lie upon each other best. */
static double difference(const double *a, const double *b)
{
    double least = 1e9;
    for (int dy = -1; dy <= 1; dy++)
        for (int dx = -1; dx <= 1; dx++) {
            double sum = 0;
            for (int y = 1; y < SMALL - 1; y++)
                for (int x = 1; x < SMALL - 1; x++) {
                    const double d = a[SMALL * y + x] - b[SMALL * (y + dy) + x + dx];
                    sum += d * d;
                }
            least = sum < least ? sum : least;
        }
    return least;
}

static void letters_can_be_read_in_a_thumbnail(void **state)
{
    static const char letters[] = "abcdefghijklmnopqrstuvwxyz0123456789.,:%-";
    enum { COUNT = sizeof letters - 1 };
    /* Each letter as it comes out at four places between the pixels, for the eye knows blurred ones too. */
    static double known[COUNT][4][SMALL * SMALL];
    const picture_panel panels[2] = {{.caption = "before"}, {.caption = "after"}};
    const picture p = {.width = 1600, .height = 900, .panels = panels, .panel_count = 2};
    const double dot = ffd_layout_make(&p).dot;
    (void)state;
    assert_true(dot * LETTER_ROWS / SHRINK > 7); /* pixels of a capital letter */
    for (int i = 0; i < COUNT; i++)
        for (int at = 0; at < 4; at++)
            draw_letter(letters[i], 20 + 2.5 * (at % 2), 15 + 2.5 * (at / 2), dot, known[i][at]);
    for (int i = 0; i < COUNT; i++)
        for (int phase = 0; phase < SHRINK * SHRINK; phase++) {
            double seen[SMALL * SMALL];
            int nearest = -1;
            double least = 1e9;
            draw_letter(letters[i], 20 + phase % SHRINK, 15 + phase / SHRINK, dot, seen);
            for (int k = 0; k < 4 * COUNT; k++) {
                const double d = difference(seen, known[k / 4][k % 4]);
                nearest = d < least ? k / 4 : nearest;
                least = d < least ? d : least;
            }
            if (nearest != i)
                fail_msg("'%c' is read as '%c' at %d", letters[i], letters[nearest], phase);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(marks_differ_from_the_scales_for_every_eye),
        cmocka_unit_test(stripes_in_the_legend_are_those_of_surfaces),
        cmocka_unit_test(stripes_go_round_every_corner),
        cmocka_unit_test(the_legend_has_the_marks_that_are_there),
        cmocka_unit_test(a_splat_in_folded_volume_is_seen),
        cmocka_unit_test(letters_can_be_read_in_a_thumbnail),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
