/* test_normals.c - angles of polygons, and normals of groups of corners. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/memory/memory.h"
#include "base/vector/vec.h"
#include "io/openmesh/normals.h"
#include "mesh/polygon.h"
#include <math.h>
#include <string.h>

#define MOST 64

static void check_angles(const double *xyz, size_t count, const double *degrees)
{
    uint32_t corners[MOST];
    size_t scratch[MOST];
    double normal[3], angles[MOST];
    for (uint32_t i = 0; i < count; i++)
        corners[i] = i;
    assert_true(ffd_polygon_normal(xyz, corners, count, normal, NULL));
    ffd_polygon_angles(xyz, corners, count, normal, scratch, angles);
    for (size_t i = 0; i < count; i++)
        if (!(fabs(angles[i] - degrees[i] * acos(-1) / 180) < 1e-14))
            fail_msg("corner %zu: %.17g, expected %g degrees", i, angles[i], degrees[i]);
}

static void corner_angles_match_those_worked_out_by_hand(void **state)
{
    (void)state;
    const double triangle[] = {0, 0, 5, 1, 0, 5, 0, 1, 5};
    check_angles(triangle, 3, (const double[]){90, 45, 45});
    const double concave[] = {0, 0, 0, 2, 0, 0, 1, 1, 0, 1, 3, 0};
    const double sharp = atan2(1, 1) * 180 / acos(-1), top = atan2(1, 3) * 180 / acos(-1);
    check_angles(concave, 4, (const double[]){atan2(3, 1) * 180 / acos(-1), sharp, 225, top});
    const double straight[] = {0, 0, 0, 1, 0, 0, 2, 0, 0, 0, 2, 0};
    check_angles(straight, 4, (const double[]){90, 180, 45, 45});
    /* Corners at one place share an angle, also across the end of the list; 0 and -0 are equal. */
    const double doubled[] = {0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 1, 0, -0.0, 0, 0, 0, 0, -0.0};
    check_angles(doubled, 6, (const double[]){30, 22.5, 22.5, 45, 30, 30});
    const double huge[] = {0, 0, 0, 1e200, 0, 0, 0, 1e200, 0};
    check_angles(huge, 3, (const double[]){90, 45, 45});
}

static void a_polygon_without_area_has_no_normal(void **state)
{
    (void)state;
    const uint32_t corners[] = {0, 1, 2};
    double normal[3];
    const double line[] = {0.1, 0.1, 0.1, 0.2, 0.2, 0.2, 0.7, 0.7, 0.7};
    assert_false(ffd_polygon_normal(line, corners, 3, normal, NULL));
    const double broken[] = {0, 0, 0, 1, 0, 0, 0, NAN, 0};
    assert_false(ffd_polygon_normal(broken, corners, 3, normal, NULL));
    const double place[] = {3, 3, 3, 3, 3, 3, 3, 3, 3};
    assert_false(ffd_polygon_normal(place, corners, 3, normal, NULL));
}

/* The cube from -1 to 1; its quads face outwards. */
static double cube[24];
static uint32_t cube_corners[] = {0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5};
static size_t cube_start[] = {0, 4, 8, 12, 16, 20, 24};

static mesh_faces make_cube(void)
{
    for (int i = 0; i < 24; i++)
        cube[i] = (i / 3) >> (i % 3) & 1 ? 1 : -1;
    return (mesh_faces){
        .vertex_count = 8, .face_count = 6, .positions = cube, .start = cube_start, .corners = cube_corners};
}

static void find(const mesh_faces *faces, const uint32_t *groups, const uint8_t *mirrored, size_t count,
                 double *directions)
{
    ffd_error error = {0};
    memset(directions, 0, 3 * count * sizeof *directions);
    if (ffd_normals_of_groups(faces, faces->positions, groups, count, mirrored, directions, &error))
        fail_msg("%s", error.message);
}

static void check_direction(const double v[3], double x, double y, double z)
{
    if (!(fabs(v[0] - x) < 1e-15 && fabs(v[1] - y) < 1e-15 && fabs(v[2] - z) < 1e-15))
        fail_msg("%.17g %.17g %.17g, expected %.17g %.17g %.17g", v[0], v[1], v[2], x, y, z);
}

static void cube_normals_follow_groups_and_mirroring(void **state)
{
    (void)state;
    const mesh_faces faces = make_cube();
    static const double outward[][3] = {{0, 0, -1}, {0, 0, 1}, {0, -1, 0}, {0, 1, 0}, {-1, 0, 0}, {1, 0, 0}};
    uint32_t groups[24];
    double found[72];
    /* Hard edges: each corner is a group. */
    for (uint32_t c = 0; c < 24; c++)
        groups[c] = c;
    find(&faces, groups, NULL, 24, found);
    for (size_t c = 0; c < 24; c++)
        assert_memory_equal(found + 3 * c, outward[c / 4], sizeof outward[0]);
    /* Smooth: each vertex is a group, so the normals are diagonals. One corner is in no group. */
    for (size_t c = 0; c < 24; c++)
        groups[c] = cube_corners[c];
    find(&faces, groups, NULL, 8, found);
    for (size_t v = 0; v < 8; v++)
        check_direction(found + 3 * v, cube[3 * v] / sqrt(3), cube[3 * v + 1] / sqrt(3),
                        cube[3 * v + 2] / sqrt(3));
    groups[0] = NORMALS_NONE;
    find(&faces, groups, NULL, 8, found);
    check_direction(found, -sqrt(0.5), -sqrt(0.5), 0);
    /* Mirrored: seen from the other side. */
    const uint8_t mirrored[8] = {1};
    find(&faces, groups, mirrored, 8, found);
    check_direction(found, sqrt(0.5), sqrt(0.5), 0);
}

/* Positions are taken from the argument, not from faces. Sizes far from 1 are fine. */
static void normals_come_from_the_given_positions(void **state)
{
    (void)state;
    const mesh_faces faces = make_cube();
    uint32_t groups[24];
    for (size_t c = 0; c < 24; c++)
        groups[c] = cube_corners[c];
    static const double scales[] = {1e-200, 1e-5, 1e5, 1e250};
    for (size_t s = 0; s < 4; s++) {
        double placed[24], found[24] = {0};
        for (int i = 0; i < 24; i++)
            placed[i] = cube[i] * scales[s];
        assert_int_equal(ffd_normals_of_groups(&faces, placed, groups, 8, NULL, found, NULL), FFD_OK);
        check_direction(found, -sqrt(1.0 / 3), -sqrt(1.0 / 3), -sqrt(1.0 / 3));
    }
}

/* Faces that half-edges cannot connect count too: three faces at an edge, one face twice, one reversed. */
static void non_manifold_faces_count_like_others(void **state)
{
    (void)state;
    double xyz[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1};
    uint32_t corners[] = {0, 1, 2, 0, 1, 3, 0, 1, 4, 0, 1, 2, 1, 1, 0, 2, 2};
    size_t start[] = {0, 3, 6, 9, 12, 17};
    const mesh_faces faces = {
        .vertex_count = 5, .face_count = 5, .positions = xyz, .start = start, .corners = corners};
    uint32_t groups[17];
    double found[3];
    for (size_t c = 0; c < 17; c++)
        groups[c] = corners[c] == 0 ? 0 : NORMALS_NONE;
    find(&faces, groups, NULL, 1, found);
    /* Normals z, -z, -y, z, -z, each with area 1/2 and a right angle. */
    check_direction(found, 0, -1, 0);
}

/* In a slanted plane, all corners of a face have exactly its normal, whatever their angles. So do corners of
   several faces with the same normal: a triangle, and the same one twice as large. A face and its reverse
   cancel out. */
static void corners_of_one_plane_have_one_normal_to_the_bit(void **state)
{
    (void)state;
    double xyz[] = {0, 0, 0, 1, 0.3, 0, 0.7, 1, 0, 2, 0.6, 0, 1.4, 2, 0, 2.1, 0.9, 0, 1.3, 3, 0};
    for (size_t i = 0; i < 7; i++)
        xyz[3 * i + 2] = 0.9 * xyz[3 * i] - 0.2 * xyz[3 * i + 1];
    uint32_t corners[] = {0, 1, 2, 0, 3, 4, 0, 2, 1, 0, 1, 5, 6, 2};
    size_t start[] = {0, 3, 6, 9, 14};
    const mesh_faces faces = {
        .vertex_count = 7, .face_count = 4, .positions = xyz, .start = start, .corners = corners};
    const double length = sqrt(0.9 * 0.9 + 0.2 * 0.2 + 1);
    uint32_t groups[14];
    double found[42];
    for (uint32_t c = 0; c < 14; c++)
        groups[c] = c;
    groups[3] = 0;
    find(&faces, groups, NULL, 14, found);
    check_direction(found, -0.9 / length, 0.2 / length, 1 / length);
    check_direction(found + 27, -0.9 / length, 0.2 / length, 1 / length);
    static const size_t alike[14] = {0, 0, 0, 3, 0, 0, 6, 6, 6, 9, 9, 9, 9, 9};
    for (size_t c = 0; c < 14; c++)
        assert_memory_equal(found + 3 * c, found + 3 * alike[c], 3 * sizeof *found);
    groups[3] = 3;
    groups[6] = 0;
    find(&faces, groups, NULL, 14, found);
    assert_true(found[0] == 0 && found[1] == 0 && found[2] == 0);
}

static void bad_corners_and_failed_allocations_are_reported(void **state)
{
    (void)state;
    const mesh_faces faces = make_cube();
    uint32_t wrong[24], groups[24];
    double found[24] = {0};
    ffd_error error;
    memcpy(wrong, cube_corners, sizeof wrong);
    memcpy(groups, cube_corners, sizeof groups);
    wrong[7] = 8;
    mesh_faces broken = faces;
    broken.corners = wrong;
    assert_int_equal(ffd_normals_of_groups(&broken, cube, groups, 8, NULL, found, &error), FFD_E_ARGUMENT);
    for (long n = 0;; n++) {
        assert_true(n < 1000);
        ffd_alloc_fail_after(n);
        const ffd_status status = ffd_normals_of_groups(&faces, cube, groups, 8, NULL, found, &error);
        ffd_alloc_fail_after(-1);
        if (status == FFD_OK)
            break;
        assert_int_equal(status, FFD_E_MEMORY);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(corner_angles_match_those_worked_out_by_hand),
        cmocka_unit_test(a_polygon_without_area_has_no_normal),
        cmocka_unit_test(cube_normals_follow_groups_and_mirroring),
        cmocka_unit_test(normals_come_from_the_given_positions),
        cmocka_unit_test(non_manifold_faces_count_like_others),
        cmocka_unit_test(corners_of_one_plane_have_one_normal_to_the_bit),
        cmocka_unit_test(bad_corners_and_failed_allocations_are_reported),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
