/* test_view_reduce.c - simplifying a page's mesh: parts, marks, borders, and failing memory. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/failing_new.h"
#include "../support/repetitions.h"
#include "../support/view_by_hand.h"
#include "view/page_reduce.h"
#include "view/page_texcoords.h"

static void take(const view_scene *scene, page_mesh *mesh)
{
    ffd_error error;
    assert_int_equal(ffd_page_mesh_take(scene, mesh, &error), FFD_OK);
}

static bool holds_vertex(const page_mesh *mesh, uint32_t vertex)
{
    for (size_t i = 0; i < 3 * mesh->triangle_count; i++)
        if (mesh->triangles[i] == vertex)
            return true;
    return false;
}

static void a_reduced_mesh_keeps_parts_marks_and_tears(void **state)
{
    (void)state;
    view_scene scene = hand_halves();
    page_mesh mesh;
    ffd_error error;
    take(&scene, &mesh);
    const size_t used = ffd_page_mesh_mark(&mesh);
    assert_int_equal(used, 101 * 101);
    assert_int_equal(ffd_page_reduce(&mesh, used, &error), FFD_OK);
    assert_int_equal(mesh.triangle_count, scene.triangle_count);
    assert_int_equal(ffd_page_reduce(&mesh, 2000, &error), FFD_OK);
    assert_in_range(ffd_page_mesh_mark(&mesh), 1000, 2000);
    assert_true(holds_vertex(&mesh, 7500) && holds_vertex(&mesh, 7501));
    assert_int_equal(mesh.parts[0].first_triangle, 0);
    assert_int_equal(mesh.parts[1].first_triangle, mesh.parts[0].triangle_count);
    assert_int_equal(mesh.parts[1].first_triangle + mesh.parts[1].triangle_count, mesh.triangle_count);
    double area[2] = {0, 0};
    size_t flipped = 0;
    uint8_t seam[2][101] = {{0}};
    for (size_t t = 0; t < mesh.triangle_count; t++) {
        const bool is_upper = t >= mesh.parts[1].first_triangle;
        const double *p[3];
        for (size_t c = 0; c < 3; c++) {
            p[c] = scene.before + 3 * (size_t)mesh.triangles[3 * t + c];
            assert_true(is_upper ? p[c][1] >= 0.5 : p[c][1] <= 0.5);
            assert_true(!mesh.flipped[t] || p[c][1] <= 0.1);
            if (p[c][1] == 0.5)
                seam[is_upper][lround(100 * p[c][0])] = 1;
        }
        area[is_upper] +=
            ((p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) - (p[1][1] - p[0][1]) * (p[2][0] - p[0][0])) / 2;
        flipped += mesh.flipped[t];
    }
    assert_true(fabs(area[0] - 0.5) < 1e-9 && fabs(area[1] - 0.5) < 1e-9);
    /* All vertices between the parts are kept in both: no gap opens. */
    for (size_t i = 0; i < 101; i++)
        assert_true(seam[0][i] && seam[1][i]);
    assert_true(flipped > 20 && flipped < mesh.parts[0].triangle_count);
    ffd_page_mesh_free(&mesh);
    ffd_view_scene_free(&scene);
}

/* Gives the only part a material with one image. */
static void hand_material(view_scene *scene)
{
    static const mesh_texture none = {.image = MATERIAL_NONE};
    scene->parts[0].material = 0;
    scene->materials.list = hand_array(1, sizeof *scene->materials.list);
    scene->materials.count = 1;
    scene->materials.list[0] = (mesh_material){.name = hand_text(""), .glow = none, .opacity = none};
    scene->materials.images = hand_array(1, sizeof *scene->materials.images);
    scene->materials.image_count = 1;
}

/* A grid with one texture, whose coordinates are x and y; right of the middle u is 2 larger. */
static view_scene textured_grid(void)
{
    view_scene scene = hand_grid(100);
    hand_part(&scene, "", 0, scene.triangle_count);
    hand_material(&scene);
    scene.texcoords = hand_array(scene.triangle_count, 6 * sizeof *scene.texcoords);
    for (size_t t = 0; t < scene.triangle_count; t++) {
        double middle = 0;
        for (size_t c = 3 * t; c < 3 * t + 3; c++)
            middle += scene.before[3 * (size_t)scene.triangles[c]] / 3;
        for (size_t c = 3 * t; c < 3 * t + 3; c++) {
            const double *const p = scene.before + 3 * (size_t)scene.triangles[c];
            scene.texcoords[2 * c] = (float)(p[0] + (middle > 0.5 ? 2 : 0));
            scene.texcoords[2 * c + 1] = (float)p[1];
        }
    }
    return scene;
}

/* Each corner of what is left has the coordinates that its vertex has on that side of the seam, and no
   triangle is of both sides. */
static void a_texture_is_not_torn_at_its_seam(void **state)
{
    (void)state;
    view_scene scene = textured_grid();
    page_mesh mesh;
    ffd_error error;
    take(&scene, &mesh);
    assert_int_equal(mesh.texcoord_width, 2);
    assert_int_equal(ffd_page_reduce(&mesh, 2000, &error), FFD_OK);
    assert_in_range(ffd_page_mesh_mark(&mesh), 1000, 2000);
    for (size_t t = 0; t < mesh.triangle_count; t++) {
        const float *const uv = mesh.texcoords + 6 * t;
        const bool is_right = uv[0] > 1.5;
        for (size_t c = 0; c < 3; c++) {
            const double *const p = scene.before + 3 * (size_t)mesh.triangles[3 * t + c];
            assert_true(is_right ? p[0] >= 0.5 : p[0] <= 0.5);
            assert_true(fabs(uv[2 * c] - (p[0] + (is_right ? 2 : 0))) < 1e-6 &&
                        fabs(uv[2 * c + 1] - p[1]) < 1e-6);
        }
    }
    page_texcoords texcoords;
    assert_int_equal(ffd_page_mesh_index(&mesh, &error), FFD_OK);
    assert_int_equal(ffd_page_texcoords_make(&mesh, &texcoords, &error), FFD_OK);
    /* A wedge more for each vertex of the seam. */
    size_t seam = 0;
    for (size_t v = 0; v < mesh.vertex_count; v++)
        seam += scene.before[3 * (size_t)mesh.vertices[v]] == 0.5;
    assert_true(seam > 10);
    assert_int_equal(texcoords.count, mesh.vertex_count + seam);
    for (size_t i = 0; i < texcoords.corner_count; i++) {
        assert_int_equal(texcoords.vertices[texcoords.corners[i]], mesh.triangles[i]);
        assert_memory_equal(texcoords.values + 2 * (size_t)texcoords.corners[i], mesh.texcoords + 2 * i,
                            2 * sizeof(float));
    }
    ffd_page_texcoords_free(&texcoords);
    ffd_page_mesh_free(&mesh);
    ffd_view_scene_free(&scene);
}

/* A vertex with other texture coordinates in each triangle: what is looked for one by one takes minutes. */
static void a_vertex_may_have_any_number_of_texture_coordinates(void **state)
{
    enum { RIM = 300000 };
    (void)state;
    view_scene scene = hand_scene(RIM + 1, RIM);
    hand_part(&scene, "", 0, RIM);
    hand_material(&scene);
    scene.texcoords = hand_array(RIM, 6 * sizeof *scene.texcoords);
    for (uint32_t i = 0; i < RIM; i++) {
        const uint32_t corners[3] = {RIM, i, (i + 1) % RIM};
        scene.before[3 * (size_t)i] = cos(i * (8 * atan(1) / RIM));
        scene.before[3 * (size_t)i + 1] = sin(i * (8 * atan(1) / RIM));
        memcpy(scene.triangles + 3 * (size_t)i, corners, sizeof corners);
        for (size_t c = 0; c < 3; c++)
            scene.texcoords[6 * (size_t)i + 2 * c] = (float)i;
    }
    memcpy(scene.after, scene.before, 3 * scene.vertex_count * sizeof(double));
    page_mesh mesh;
    page_texcoords texcoords;
    ffd_error error;
    take(&scene, &mesh);
    ffd_page_mesh_mark(&mesh);
    assert_int_equal(ffd_page_mesh_index(&mesh, &error), FFD_OK);
    assert_int_equal(ffd_page_texcoords_make(&mesh, &texcoords, &error), FFD_OK);
    assert_int_equal(texcoords.count, 3 * RIM);
    ffd_page_texcoords_free(&texcoords);
    ffd_page_mesh_free(&mesh);
    ffd_view_scene_free(&scene);
}

/* Unconnected triangles consist of borders only: simplification cannot reduce them. */
static void a_soup_is_reduced_too(void **state)
{
    (void)state;
    view_scene scene = hand_scene(30000, 10000);
    for (uint32_t i = 0; i < 30000; i++) {
        const double p[3] = {i / 3 % 100 + (i % 3 == 1) * 0.5, (double)(i / 300) + (i % 3 == 2) * 0.5,
                             i % 7 * 0.01};
        memcpy(scene.before + 3 * (size_t)i, p, sizeof p);
        scene.triangles[i] = i;
    }
    memcpy(scene.after, scene.before, 90000 * sizeof(double));
    page_mesh mesh;
    ffd_error error;
    take(&scene, &mesh);
    assert_int_equal(ffd_page_reduce(&mesh, 900, &error), FFD_OK);
    assert_in_range(ffd_page_mesh_mark(&mesh), 1, 900);
    ffd_page_mesh_free(&mesh);
    ffd_view_scene_free(&scene);
}

static void segments_and_points_are_thinned_out(void **state)
{
    (void)state;
    view_scene scene = hand_scene(5000, 0);
    scene.segment_count = scene.point_count = 2000;
    scene.segments = hand_array(2000, 2 * sizeof(uint32_t));
    scene.points = hand_array(2000, sizeof(uint32_t));
    for (uint32_t i = 0; i < 2000; i++) {
        scene.segments[2 * i] = i;
        scene.segments[2 * i + 1] = i + 1;
        scene.points[i] = 3000 + i;
    }
    page_mesh mesh;
    ffd_error error;
    take(&scene, &mesh);
    assert_int_equal(ffd_page_reduce(&mesh, 800, &error), FFD_OK);
    assert_in_range(ffd_page_mesh_mark(&mesh), 300, 800);
    assert_in_range(mesh.point_count, 100, 500);
    assert_true(mesh.points[mesh.point_count - 1] > 4900 && mesh.points[0] < 3100);
    ffd_page_mesh_free(&mesh);
    ffd_view_scene_free(&scene);
}

static void no_allocation_may_fail_unseen(void **state)
{
    (void)state;
    view_scene scene = hand_halves();
    ffd_status status = FFD_E_MEMORY;
    long count = 0;
    for (; status != FFD_OK && count < 500; count++) {
        page_mesh mesh;
        ffd_error error;
        take(&scene, &mesh);
        ffd_alloc_fail_after(count);
        status = ffd_page_reduce(&mesh, 2000, &error);
        ffd_alloc_fail_after(-1);
        assert_true(status == FFD_OK || status == FFD_E_MEMORY);
        ffd_page_mesh_free(&mesh);
    }
    assert_in_range(count, 7, 499);
    for (status = FFD_E_MEMORY, count = 0; status != FFD_OK && count < 500; count++) {
        page_mesh mesh;
        ffd_error error;
        take(&scene, &mesh);
        new_fail_after(count);
        status = ffd_page_reduce(&mesh, 2000, &error);
        new_fail_after(-1);
        assert_true(status == FFD_OK || status == FFD_E_MEMORY);
        ffd_page_mesh_free(&mesh);
    }
    assert_in_range(count, is_under_valgrind() ? 1 : 7, 499); /* valgrind has its own operator new */
    ffd_view_scene_free(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_reduced_mesh_keeps_parts_marks_and_tears),
        cmocka_unit_test(a_texture_is_not_torn_at_its_seam),
        cmocka_unit_test(a_vertex_may_have_any_number_of_texture_coordinates),
        cmocka_unit_test(a_soup_is_reduced_too),
        cmocka_unit_test(segments_and_points_are_thinned_out),
        cmocka_unit_test(no_allocation_may_fail_unseen),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
