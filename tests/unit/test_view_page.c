/* test_view_page.c - the page of ffd view: text from files, numbers, omissions, broken scenes. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/test_folder.h"
#include "../support/view_by_hand.h"
#include "base/little_endian.h"
#include "base/text/base64.h"
#include "view/page.h"
#include "view/page_assets.h"
#include "view/page_data.h"
#include "view/page_text.h"

/* Without geometry. */
#define LARGEST_PAGE 700000

static char logged[1000];

static void listen(void *user, ffd_log_level level, const char *line)
{
    (void)user;
    assert_int_equal(level, FFD_LOG_WARNING);
    strncat(logged, line, sizeof logged - strlen(logged) - 1);
}

static ffd_status write_page(const view_scene *scene, const view_page_options *options)
{
    file_output *output = NULL;
    ffd_error error;
    ffd_status status = ffd_output_create(&output, &error);
    if (!status)
        status = ffd_output_begin(output, in_folder("page.html"), true, &error);
    if (!status)
        status = ffd_view_page_write(scene, options, output, &error);
    if (!status)
        status = ffd_output_commit(output, &error);
    ffd_output_destroy(&output);
    return status;
}

static char *read_page(void)
{
    FILE *const file = fopen(in_folder("page.html"), "rb");
    assert_non_null(file);
    assert_int_equal(fseek(file, 0, SEEK_END), 0);
    const size_t size = (size_t)ftell(file);
    rewind(file);
    char *const text = hand_array(size + 1, 1);
    assert_int_equal(fread(text, 1, size, file), size);
    fclose(file);
    assert_int_equal(strlen(text), size);
    return text;
}

static char *page_of(const view_scene *scene, bool full)
{
    const mesh_log log = {listen, NULL};
    const view_page_options options = {.full = full, .log = &log};
    *logged = 0;
    assert_int_equal(write_page(scene, &options), FFD_OK);
    return read_page();
}

/* Returns the content of the script element of that id; NULL: there is none. */
static char *block_of(const char *page, const char *id)
{
    char head[80];
    snprintf(head, sizeof head, "id=\"%s\">", id);
    const char *const from = strstr(page, head);
    if (!from)
        return NULL;
    const char *const first = from + strlen(head), *const end = strstr(first, "</script>");
    char *const text = hand_array((size_t)(end - first) + 1, 1);
    memcpy(text, first, (size_t)(end - first));
    return text;
}

static unsigned char *bytes_of(const char *page, const char *id, size_t expected)
{
    char *const text = block_of(page, id);
    assert_non_null(text);
    size_t count;
    unsigned char *const bytes = hand_array(ffd_base64_capacity(strlen(text)), 1);
    assert_true(ffd_base64_decode(text, strlen(text), bytes, &count));
    assert_int_equal(count, expected);
    ffd_free(text);
    return bytes;
}

/* Returns the number, or an element of the array, of a key in the page's JSON. */
static double value_of(const char *page, const char *key, int index)
{
    char name[60];
    snprintf(name, sizeof name, "\"%s\": ", key);
    const char *at = strstr(strstr(page, "id=\"scene\""), name);
    assert_non_null(at);
    at += strlen(name) + (at[strlen(name)] == '[');
    for (; index > 0; index--)
        at = strchr(at, ',') + 1;
    return strtod(at, NULL);
}

static size_t count_of(const char *text, const char *word)
{
    size_t count = 0;
    for (const char *at = text; (at = strstr(at, word)); at += strlen(word))
        count++;
    return count;
}

static void wave(const double from[3], double to[3])
{
    to[0] = from[0] + 0.02 * sin(5 * from[1]);
    to[1] = from[1] * 1.25;
    to[2] = from[2] - 3e-4 * from[0];
}

static void names_are_shown_as_what_they_hold(void **state)
{
    (void)state;
    static const char *const names[][2] = {
        {"", ""},
        {"Head", "Head"},
        {"a\nb\tc", "a\\nb\\u{9}c"},
        {"\x01\x7f", "\\u{1}\\u{7f}"},
        {"\xc2\x85", "\\u{85}"},
        {"\xe2\x80\xaetxt.exe", "\\u{202e}txt.exe"},
        {"\xe2\x81\xa6x\xe2\x81\xa9", "\\u{2066}x\\u{2069}"},
        {"\xf3\xa0\x81\x81", "\\u{e0041}"},
        {"\xff\xc3", "\xef\xbf\xbd\xef\xbf\xbd"},
        {"\xd9\x85\xe2\x80\x8c\xd9\x87", "\xd9\x85\xe2\x80\x8c\xd9\x87"},
        {"<b>&amp;\"'", "<b>&amp;\"'"},
    };
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        char *const text = ffd_page_name(names[i][0]);
        assert_string_equal(text, names[i][1]);
        ffd_free(text);
    }
    char longest[100001], *text;
    memset(longest, 'x', sizeof longest - 1);
    longest[sizeof longest - 1] = 0;
    text = ffd_page_name(longest);
    assert_int_equal(strlen(text), 203);
    assert_string_equal(text + 199, "x\xe2\x80\xa6");
    ffd_free(text);
    longest[200] = 0;
    text = ffd_page_name(longest);
    assert_string_equal(text, longest);
    ffd_free(text);
}

static void no_text_of_a_file_is_markup(void **state)
{
    (void)state;
    static const char evil[] = "</script></title><img src=x onerror=alert(1)><!--<script>";
    view_scene scene = hand_grid(2);
    const double box[2][3] = {{0, 0, -1}, {1, 1, 1}};
    ffd_free(scene.name);
    scene.name = hand_text(evil);
    scene.output = hand_text(evil);
    scene.report = hand_text("{\"input\": \"</script><img src=x>\"}");
    hand_part(&scene, evil, 0, 8);
    hand_cage(&scene, evil, 2, 2, 2, box[0], box[1], wave);
    scene.materials.list = hand_array(1, sizeof *scene.materials.list);
    scene.materials.list[0] = (mesh_material){.name = hand_text(evil), .base = ffd_texture_none()};
    scene.materials.count = 1;
    scene.parts[0].material = 0;
    char *const page = page_of(&scene, false), *const report = block_of(page, "report"),
                *const json = block_of(page, "scene");
    assert_null(strchr(report, '<'));
    assert_null(strchr(json, '<'));
    assert_int_equal(count_of(json, "\\u003c/script>"), 5);
    assert_null(strstr(page, "<img"));
    assert_int_equal(count_of(page, "<script"), count_of(page, "</script>"));
    assert_int_equal(count_of(page, "</title>"), 1);
    assert_non_null(strstr(page, "<title>&lt;/script>&lt;/title>&lt;img src=x"));
    ffd_free(report);
    ffd_free(json);
    ffd_free(page);
    ffd_view_scene_free(&scene);
}

static void a_page_allows_no_request(void **state)
{
    (void)state;
    view_scene scene = hand_grid(1);
    char *const page = page_of(&scene, false);
    assert_non_null(strstr(page, "content=\"default-src 'none'; script-src 'sha256-"));
    assert_null(strstr(page, "unsafe"));
    for (const char *const *word =
             (const char *const[]){"http:", "https:", "url(", "fetch(", "import ", " onclick", NULL};
         *word; word++)
        assert_null(strstr(page, *word));
    assert_true(ffd_page_start_size + ffd_page_middle_size + ffd_page_end_size < LARGEST_PAGE);
    ffd_free(page);
    ffd_view_scene_free(&scene);
}

/* Errors are at most half a quantization step: of the box of both shapes, and of the largest component of a
   displacement. */
static void numbers_come_back_to_half_a_step(void **state)
{
    (void)state;
    const double low[3] = {0, 0.3, -1}, high[3] = {1, 1, 1};
    view_scene scene = hand_grid(60); /* more vertices than are encoded at a time */
    hand_deform(&scene, low, high, wave);
    char *const page = page_of(&scene, false);
    const size_t count = scene.vertex_count;
    unsigned char *const before = bytes_of(page, "data-before", 6 * count),
                         *const move = bytes_of(page, "data-move", 6 * count),
                         *const status = bytes_of(page, "data-status", count),
                         *const det = bytes_of(page, "data-det", 4 * count),
                         *const triangles = bytes_of(page, "data-triangle", 12 * scene.triangle_count);
    const double move_step = value_of(page, "moveStep", 0);
    /* The box is that of both shapes: x decreases, y increases. */
    assert_true(value_of(page, "low", 0) < -0.015);
    assert_true(value_of(page, "low", 1) + 65535 * value_of(page, "step", 1) > 1.2499);
    assert_true(fabs(move_step - 0.25 / 32767) < 1e-12);
    for (size_t v = 0; v < count; v++) {
        for (size_t a = 0; a < 3; a++) {
            const unsigned char *const p = before + 6 * v + 2 * a, *const m = move + 6 * v + 2 * a;
            const double step = value_of(page, "step", (int)a),
                         x = value_of(page, "low", (int)a) + step * (p[0] + 256 * p[1]);
            const double d = move_step * (int16_t)(uint16_t)(m[0] + 256 * m[1]);
            const double moved = scene.after[3 * v + a] - scene.before[3 * v + a];
            assert_true(fabs(x - scene.before[3 * v + a]) <= 0.5000001 * step);
            assert_true(fabs(d - moved) <= 0.5000001 * move_step);
            assert_true(moved != 0 || d == 0);
        }
        assert_int_equal(status[v], scene.statuses[v]);
        assert_true(load_float(det + 4 * v) == (float)scene.dets[v]);
    }
    for (size_t i = 0; i < 3 * scene.triangle_count; i++)
        assert_int_equal(load_u32(triangles + 4 * i), scene.triangles[i]);
    assert_null(strstr(page, "id=\"data-number\""));
    void *const blocks[] = {before, move, status, det, triangles, page};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++)
        ffd_free(blocks[i]);
    ffd_view_scene_free(&scene);
}

static void colors_numbers_and_cages_are_there(void **state)
{
    (void)state;
    view_scene scene = hand_grid(1);
    const double low[3] = {0, 0, -1}, high[3] = {1, 1, 1};
    scene.colors = hand_array(4, 4 * sizeof(double));
    const double colors[4] = {1, 0.5, -3, NAN};
    memcpy(scene.colors, colors, sizeof colors);
    scene.indices = hand_array(4, sizeof *scene.indices);
    for (size_t v = 0; v < 4; v++)
        scene.indices[v] = 10 + v;
    hand_cage(&scene, "cage", 3, 2, 2, low, high, wave);
    char *page = page_of(&scene, false);
    unsigned char *bytes = bytes_of(page, "data-color", 16);
    assert_memory_equal(bytes, "\xff\x80\x00\x00", 4);
    ffd_free(bytes);
    bytes = bytes_of(page, "data-number", 16);
    assert_int_equal(load_u32(bytes + 4), 11);
    ffd_free(bytes);
    bytes = bytes_of(page, "data-cage-0", 48 * 12);
    for (size_t i = 0; i < 12 * 6; i++) {
        const double *const points = i / 3 % 2 ? scene.cages[0].deformed : scene.cages[0].rest;
        const uint64_t bits = load_u64(bytes + 8 * i);
        assert_memory_equal(&bits, points + 3 * (i / 6) + i % 3, 8);
    }
    ffd_free(bytes);
    ffd_free(page);
    scene.indices[3] = (uint64_t)1 << 40;
    page = page_of(&scene, false);
    ffd_free(bytes_of(page, "data-number", 32));
    ffd_free(page);
    ffd_view_scene_free(&scene);
}

static void a_cage_of_too_many_points_is_left_out_and_said(void **state)
{
    (void)state;
    view_scene scene = hand_grid(1);
    const double low[3] = {0, 0, -1}, high[3] = {1, 1, 1};
    hand_cage(&scene, "large", 50, 50, 41, low, high, wave);
    hand_cage(&scene, "small", 2, 2, 2, low, high, wave);
    char *page = page_of(&scene, false);
    assert_null(strstr(page, "data-cage-0\""));
    assert_non_null(strstr(page, "data-cage-1\""));
    assert_non_null(strstr(logged, "1 of 2 lattices are not drawn"));
    ffd_free(page);
    page = page_of(&scene, true);
    assert_non_null(strstr(page, "data-cage-0\""));
    assert_string_equal(logged, "");
    ffd_free(page);
    ffd_view_scene_free(&scene);
}

static void what_is_not_finite_is_left_out_and_said(void **state)
{
    (void)state;
    view_scene scene = hand_grid(10);
    const size_t count = scene.vertex_count;
    scene.before[0] = NAN;
    scene.after[3 * 60] = INFINITY;
    scene.before[3 * 120 + 2] = -1e301;
    hand_part(&scene, "all", 0, scene.triangle_count);
    char *const page = page_of(&scene, false);
    /* Corners of the square belong to one or two triangles, an inner vertex to six. */
    const size_t left = scene.triangle_count - 2 - 6 - 2;
    assert_int_equal(value_of(page, "vertices", 0), count - 3);
    assert_int_equal(value_of(page, "triangles", 0), left);
    assert_int_equal(value_of(page, "notFinite", 0), 3);
    assert_non_null(strstr(logged, "3 vertices are not finite, and 10 triangles there are not drawn"));
    unsigned char *const triangles = bytes_of(page, "data-triangle", 12 * left);
    for (size_t i = 0; i < 3 * left; i++)
        assert_true(load_u32(triangles + 4 * i) < count - 3);
    ffd_free(triangles);
    ffd_free(page);
    ffd_view_scene_free(&scene);
}

#define BONES 7
#define FOLLOWED 5 /* bones of each vertex: one more than a page keeps */

static void free_nothing(mesh_skeleton *skeleton)
{
    (void)skeleton;
}

/* Vertex v follows the bones v, v + 1 .. (modulo 7) with decreasing weights; its anchor is (v, 2v, -v). */
static void give_rig(view_scene *scene, mesh_skeleton *skeleton, rig_node *nodes, rig_bone *bones,
                     rig_animation *animation)
{
    const size_t count = scene->vertex_count;
    *skeleton = (mesh_skeleton){.nodes = nodes,
                                .node_count = BONES,
                                .bones = bones,
                                .bone_count = BONES,
                                .animations = animation,
                                .animation_count = 1,
                                .vertex_count = count,
                                .starts = hand_array(count + 1, sizeof(size_t)),
                                .influences = hand_array(FOLLOWED * count, sizeof(rig_influence)),
                                .free = free_nothing};
    scene->rigs[0].skeleton = scene->rigs[1].skeleton = skeleton;
    scene->rigs[0].anchors.points = hand_array(count, 3 * sizeof(double));
    for (size_t v = 0; v < count; v++) {
        skeleton->starts[v + 1] = FOLLOWED * (v + 1);
        for (size_t k = 0; k < FOLLOWED; k++)
            /* The largest weight is not the first. */
            skeleton->influences[FOLLOWED * v + (k + 2) % FOLLOWED] =
                (rig_influence){(uint32_t)((v + k) % BONES), 0.3f - 0.05f * (float)k};
        for (size_t a = 0; a < 3; a++)
            scene->rigs[0].anchors.points[3 * v + a] = (a == 2 ? -1.0 : (double)(a + 1)) * (double)v;
    }
}

/* Checks that bones and anchors of the remaining vertices match their numbers. */
static void check_rig(const char *page, size_t vertices)
{
    unsigned char *const numbers = bytes_of(page, "data-number", 4 * vertices);
    unsigned char *const follows = bytes_of(page, "data-rig-before-follow", 16 * vertices);
    unsigned char *const anchors = bytes_of(page, "data-rig-before-anchor", 12 * vertices);
    for (size_t i = 0; i < vertices; i++) {
        const uint32_t number = load_u32(numbers + 4 * i);
        uint32_t all = 0, before = 65535;
        for (size_t k = 0; k < 4; k++) {
            const unsigned char *const at = follows + 16 * i + 2 * k;
            const uint32_t bone = at[0] | (uint32_t)at[1] << 8, share = at[8] | (uint32_t)at[9] << 8;
            assert_int_equal(bone, (number + k) % BONES);
            assert_true(share > 0 && share < before);
            before = share;
            all += share;
        }
        assert_int_equal(all, 65535);
        assert_true(load_float(anchors + 12 * i) == (float)number);
        assert_true(load_float(anchors + 12 * i + 8) == -(float)number);
    }
    ffd_free(numbers);
    ffd_free(follows);
    ffd_free(anchors);
}

static void a_page_of_many_vertices_is_reduced_and_says_so(void **state)
{
    (void)state;
    view_scene scene = hand_grid(460);
    mesh_skeleton skeleton;
    rig_node nodes[BONES] = {{.parent = RIG_NONE, .is_joint = true}};
    rig_bone bones[BONES] = {{0}};
    rig_animation animation = {.name = "walk"};
    give_rig(&scene, &skeleton, nodes, bones, &animation);
    char *const page = page_of(&scene, false);
    check_rig(page, (size_t)value_of(page, "vertices", 0));
    assert_non_null(
        strstr(logged, "vertices follow more than 4 joints (up to 5): animations move them by the largest"));
    assert_in_range((size_t)value_of(page, "vertices", 0), 150000, VIEW_PAGE_VERTICES);
    assert_int_equal(value_of(page, "verticesAll", 0), 461 * 461);
    assert_non_null(strstr(logged, "of 212521 vertices are drawn: the mesh is simplified (see full)"));
    assert_non_null(strstr(page, "of 212521 vertices are drawn: the mesh is simplified (see full)\""));
    ffd_free(page);
    char *const full = page_of(&scene, true);
    assert_int_equal(value_of(full, "vertices", 0), 461 * 461);
    assert_null(strstr(logged, "simplified"));
    ffd_free(full);
    ffd_view_scene_free(&scene);
    ffd_free(skeleton.starts);
    ffd_free(skeleton.influences);
}

static void a_scene_of_nothing_is_a_page(void **state)
{
    (void)state;
    view_scene scene = {0};
    char *page = page_of(&scene, false);
    assert_non_null(strstr(logged, "the mesh has no vertices"));
    ffd_free(page);
    scene.vertex_count = 5; /* a mesh of vertices alone is shown as points */
    scene.before = hand_array(5, 3 * sizeof(double));
    page = page_of(&scene, false);
    assert_int_equal(value_of(page, "points", 0), 5);
    ffd_free(page);
    ffd_view_scene_free(&scene);
}

static void a_page_opens_as_it_is_told(void **state)
{
    (void)state;
    view_scene scene = hand_grid(1);
    const view_page_options options = {.color = FFD_VIEW_DET, .camera = {0, -2, 0.5}, .up = FFD_UP_Z};
    assert_int_equal(write_page(&scene, &options), FFD_OK);
    char *const page = read_page();
    assert_non_null(strstr(page, "\"view\": {\"color\": \"det\", \"camera\": [0, -2, 0.5], \"up\": \"z\"}"));
    ffd_free(page);
    ffd_view_scene_free(&scene);
}

/* A texture that is not there is grey; one that a mesh without coordinates cannot show is not missing. */
static void only_a_texture_that_is_not_there_is_lost(void **state)
{
    static const mesh_texture none = {.image = MATERIAL_NONE};
    static const struct {
        uint32_t image;
        const char *lost;
    } cases[] = {
        {0, "\"lost\": false"}, {MATERIAL_LOST, "\"lost\": true"}, {MATERIAL_NONE, "\"lost\": false"}};
    (void)state;
    view_scene scene = hand_grid(1);
    hand_part(&scene, "", 0, scene.triangle_count);
    scene.parts[0].material = 0;
    scene.materials.list = hand_array(1, sizeof *scene.materials.list);
    scene.materials.count = 1;
    scene.materials.images = hand_array(1, sizeof *scene.materials.images);
    scene.materials.image_count = 1;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        ffd_free(scene.materials.list[0].name);
        scene.materials.list[0] =
            (mesh_material){.name = hand_text(""), .base = none, .glow = none, .opacity = none};
        scene.materials.list[0].base.image = cases[i].image;
        char *const page = page_of(&scene, false);
        if (count_of(page, cases[i].lost) != 1)
            fail_msg("image %u: not %s", (unsigned)cases[i].image, cases[i].lost);
        ffd_free(page);
    }
    ffd_view_scene_free(&scene);
}

static void indices_beyond_the_arrays_are_refused(void **state)
{
    (void)state;
    view_scene scene = hand_halves();
    const view_page_options options = {0};
    uint32_t *const indices[] = {&scene.triangles[77], &scene.tears[0].vertices[1]};
    for (size_t i = 0; i < sizeof indices / sizeof *indices; i++) {
        const uint32_t good = *indices[i];
        *indices[i] = (uint32_t)scene.vertex_count;
        assert_int_equal(write_page(&scene, &options), FFD_E_ARGUMENT);
        *indices[i] = good;
    }
    scene.parts[1].first_triangle++;
    assert_int_equal(write_page(&scene, &options), FFD_E_ARGUMENT);
    scene.parts[1].first_triangle = SIZE_MAX;
    assert_int_equal(write_page(&scene, &options), FFD_E_ARGUMENT);
    ffd_view_scene_free(&scene);
}

static void no_allocation_may_fail_unseen(void **state)
{
    (void)state;
    view_scene scene = hand_halves();
    const double low[3] = {0, 0, -1}, high[3] = {1, 1, 1};
    const view_page_options options = {0};
    hand_cage(&scene, "cage", 3, 3, 3, low, high, wave);
    scene.report = hand_text("{}");
    ffd_status status = FFD_E_MEMORY;
    long count = 0;
    for (; status != FFD_OK && count < 500; count++) {
        ffd_alloc_fail_after(count);
        status = write_page(&scene, &options);
        ffd_alloc_fail_after(-1);
        assert_true(status == FFD_OK || status == FFD_E_MEMORY);
    }
    assert_in_range(count, 20, 499);
    ffd_view_scene_free(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(names_are_shown_as_what_they_hold),
        cmocka_unit_test(no_text_of_a_file_is_markup),
        cmocka_unit_test(a_page_allows_no_request),
        cmocka_unit_test(numbers_come_back_to_half_a_step),
        cmocka_unit_test(colors_numbers_and_cages_are_there),
        cmocka_unit_test(a_cage_of_too_many_points_is_left_out_and_said),
        cmocka_unit_test(what_is_not_finite_is_left_out_and_said),
        cmocka_unit_test(a_page_of_many_vertices_is_reduced_and_says_so),
        cmocka_unit_test(a_scene_of_nothing_is_a_page),
        cmocka_unit_test(a_page_opens_as_it_is_told),
        cmocka_unit_test(only_a_texture_that_is_not_there_is_lost),
        cmocka_unit_test(indices_beyond_the_arrays_are_refused),
        cmocka_unit_test(no_allocation_may_fail_unseen),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
