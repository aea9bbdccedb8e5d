/* test_seams.c - finds the lattices of a chain with a seam or an axis that their moves open; marks of points.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "base/memory/memory.h"
#include "job/chain/chain_load.h"
#include "job/chain/marks.h"
#include "job/chain/seams.h"
#include <ffd/lattice.h>
#include <string.h>

/* A ring about z with 5 rays, of which the first and the last coincide: radius 1 to 2, height 0 to 1. */
#define RING                                                                                                 \
    "\"format\":\"ffd-lattice\",\"version\":1,\"size\":[2,5,2],\"degree\":[1,1,1],"                          \
    "\"rest\":{\"points\":[[1,0,0],[2,0,0],[0,1,0],[0,2,0],[-1,0,0],[-2,0,0],[0,-1,0],[0,-2,0],[1,0,0],"     \
    "[2,0,0],[1,0,1],[2,0,1],[0,1,1],[0,2,1],[-1,0,1],[-2,0,1],[0,-1,1],[0,-2,1],[1,0,1],[2,0,1]]}"
#define STILL "{" RING "}"
#define LIFTED "{" RING ",\"moves\":[{\"by\":[0,0,1]}]}"
/* The outer end of the last ray rises. */
#define OPENED "{" RING ",\"moves\":[{\"at\":[1,4,\"all\"],\"by\":[0,0,3]}]}"
#define BOX                                                                                                  \
    "{\"format\":\"ffd-lattice\",\"version\":1,\"size\":[2,2,2],\"rest\":{\"box\":{\"min\":[0,0,0],"         \
    "\"max\":[1,1,1]}},\"moves\":[{\"by\":[0,0,1]}]}"
/* The same ring closed to a disk: the inner ends of the rays are one point, which is moved as one, or not. */
#define DISK                                                                                                 \
    "\"format\":\"ffd-lattice\",\"version\":1,\"size\":[2,5,2],\"degree\":[1,1,1],"                          \
    "\"rest\":{\"points\":[[0,0,0],[2,0,0],[0,0,0],[0,2,0],[0,0,0],[-2,0,0],[0,0,0],[0,-2,0],[0,0,0],"       \
    "[2,0,0],[0,0,1],[2,0,1],[0,0,1],[0,2,1],[0,0,1],[-2,0,1],[0,0,1],[0,-2,1],[0,0,1],[2,0,1]]}"
#define LIFTED_AXIS "{" DISK ",\"moves\":[{\"at\":[0,\"all\",\"all\"],\"by\":[0,0,3]}]}"
#define OPENED_AXIS "{" DISK ",\"moves\":[{\"at\":[0,2,0],\"by\":[0,0,3]}]}"
/* The weights of the last ray have other ratios than those of the first. */
#define WEIGHTS ",\"weights\":[1,2,1,1,1,1,1,1,3,1,2,1,1,1,1,1,1,1,1,5]"
#define WEIGHTED "{" RING WEIGHTS ",\"moves\":[{\"by\":[0,0,1]}]}"

static lattice_chain make_chain(bool blocks, size_t count, const char *const *json)
{
    lattice_chain chain = {.blocks = blocks, .count = count};
    ffd_error error = {0};
    chain.links = ffd_alloc_zero(count, sizeof *chain.links);
    assert_non_null(chain.links);
    for (size_t l = 0; l < count; l++) {
        chain_link *const link = &chain.links[l];
        if (ffd_lattice_parse(json[l], strlen(json[l]), "test.json", &link->lattice, &error) ||
            ffd_locator_create(link->lattice, &link->locator, &error))
            fail_msg("%s %s", error.pointer, error.message);
    }
    assert_int_equal(ffd_seams_find(&chain, &error), FFD_OK);
    return chain;
}

static void only_faces_that_the_moves_part_are_a_seam(void **state)
{
    static const char *const all[] = {STILL, OPENED, BOX, LIFTED, WEIGHTED, OPENED};
    static const bool seams[] = {false, true, false,
                                 false, true, true}; /* equal weights are not looked for */
    lattice_chain chain = make_chain(false, 6, all);
    size_t found = 0;
    for (size_t l = 0; l < 6; l++) {
        assert_int_equal(chain.links[l].is_convex, l == 2);
        assert_false(chain.links[l].opens_axis);
        if (!seams[l])
            continue;
        assert_true(found < chain.seam_count);
        assert_true(chain.seams[found].link == l && chain.seams[found].direction == 1);
        found++;
    }
    assert_int_equal(chain.seam_count, found);
    ffd_chain_free(&chain);
    (void)state;
}

static void only_points_that_the_moves_part_are_an_axis(void **state)
{
    static const char *const all[] = {LIFTED_AXIS, OPENED_AXIS, OPENED};
    lattice_chain chain = make_chain(false, 3, all);
    for (size_t l = 0; l < 3; l++)
        assert_int_equal(chain.links[l].opens_axis, l == 1);
    ffd_chain_free(&chain);
    (void)state;
}

/* Of a seam along v, from 0 to 1. */
static void points_on_different_sides_of_a_seam(void **state)
{
    static const char *const all[] = {BOX, OPENED, LIFTED};
    lattice_chain chain = make_chain(false, 3, all);
    for (size_t l = 0; l < 3; l++)
        for (int i = 0; i <= 8; i++) {
            const double a[3] = {0.9, 0.125, 0.1}, b[3] = {0.1, i / 8.0, 0.9};
            assert_int_equal(ffd_seams_part(&chain, l, a, b), l == 1 && i > 5);
            assert_int_equal(ffd_seams_part(&chain, l, b, a), l == 1 && i > 5);
        }
    ffd_chain_free(&chain);
    (void)state;
}

/* Marks of two points of a run. */
static uint8_t bytes[16 * CHAIN_RUN];

/* Whether points at v = a and v = b of a link have marks of neighbouring parts. */
static bool are_near(lattice_chain *chain, size_t link, double a, double b)
{
    const chain_run run = {.count = 2, .kept = bytes};
    const mark_planes marks = {bytes, CHAIN_RUN};
    const double uvw[2][3] = {{0.5, a, 0.5}, {0.5, b, 0.5}};
    ffd_marks_lay_out(chain, true);
    assert_true(chain->marks.planes <= 16);
    memset(bytes, 0, sizeof bytes);
    for (size_t i = 0; i < 2; i++) {
        for (size_t l = 0; l < chain->count; l++)
            if (!chain->blocks || l == link)
                ffd_mark_part(chain, l, &run, i, l == link ? uvw[i] : uvw[0]);
        ffd_mark_owner(chain, &run, i, (unsigned)link);
    }
    return ffd_marks_are_near(chain, &marks, 0, 1);
}

static void parts_of_a_volume_are_told_apart(void **state)
{
    static const char *const all[] = {BOX, OPENED, LIFTED};
    for (int blocks = 0; blocks < 2; blocks++) {
        lattice_chain chain = make_chain(blocks, 3, all);
        assert_true(are_near(&chain, 1, 0.5, 0.51));
        assert_false(are_near(&chain, 1, 0.5, 0.6));
        assert_false(are_near(&chain, 2, 0.0, 1.0)); /* the ring is not closed */
        assert_true(are_near(&chain, 0, 0.0, 1.0));  /* a box is one part */
        ffd_chain_free(&chain);
    }
    (void)state;
}

static void parts_meet_across_a_closed_direction(void **state)
{
    static const char *const all[] = {
        "{\"format\":\"ffd-lattice\",\"version\":1,\"size\":[3,6,3],\"knots\":[\"clamped\",\"closed\","
        "\"clamped\"],"
        "\"rest\":{\"cylinder\":{\"center\":[0,0,0],\"axis\":\"z\",\"radius\":[1,2],\"height\":1}}}"};
    lattice_chain chain = make_chain(false, 1, all);
    assert_true(are_near(&chain, 0, 0.001, 0.999));
    assert_false(are_near(&chain, 0, 0.001, 0.9));
    ffd_chain_free(&chain);
    (void)state;
}

/* Bits of links, and numbers of blocks, of points that others are beside. */
static void marks_are_read_as_they_are_written(void **state)
{
    static const char *const all[] = {BOX, OPENED, LIFTED};
    lattice_chain chain = make_chain(false, 3, all);
    const mark_planes marks = {bytes, CHAIN_RUN};
    chain_run run = {.count = 3, .kept = bytes};
    memset(bytes, 0, sizeof bytes);
    ffd_marks_lay_out(&chain, true);
    for (size_t l = 0; l < 3; l++)
        ffd_mark_kept(&run, 0, l);
    ffd_mark_kept(&run, 2, 1);
    assert_true(run.keeps);
    assert_false(ffd_marks_take_any(&marks, 0, 3));
    assert_true(ffd_marks_take_any(&marks, 1, 3) && ffd_marks_take_any(&marks, 2, 3));
    assert_true(ffd_marks_take(&marks, 2, 0) && !ffd_marks_take(&marks, 2, 1) &&
                ffd_marks_keep(&marks, 2, 1));
    ffd_chain_free(&chain);

    chain = make_chain(true, 3, all);
    memset(bytes, 0, sizeof bytes);
    ffd_marks_lay_out(&chain, false);
    ffd_mark_owner(&chain, &run, 0, 2);
    ffd_mark_owner(&chain, &run, 1, 0x123 | OWNER_NEAREST);
    ffd_mark_kept(&run, 2, 0);
    assert_int_equal(ffd_marks_owner(&chain, &marks, 0), 2);
    assert_int_equal(ffd_marks_owner(&chain, &marks, 1), 0x123 | OWNER_NEAREST);
    assert_int_equal(ffd_marks_owner(&chain, &marks, 2), OWNER_NONE);
    ffd_chain_free(&chain);
    (void)state;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(only_faces_that_the_moves_part_are_a_seam),
        cmocka_unit_test(only_points_that_the_moves_part_are_an_axis),
        cmocka_unit_test(points_on_different_sides_of_a_seam),
        cmocka_unit_test(parts_of_a_volume_are_told_apart),
        cmocka_unit_test(parts_meet_across_a_closed_direction),
        cmocka_unit_test(marks_are_read_as_they_are_written),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
