/* test_seams.c - finds the lattices of a chain with a seam that their moves open, and marks points there. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "base/memory/memory.h"
#include "job/chain/chain_load.h"
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
    static const char *const all[] = {STILL, OPENED, BOX, LIFTED, OPENED};
    lattice_chain chain = make_chain(false, 5, all);
    assert_int_equal(chain.seam_count, 2);
    assert_int_equal(ffd_chain_marked(&chain), 7);
    for (size_t l = 0; l < 5; l++)
        for (int a = 0; a < 3; a++) {
            const chain_seam *const seam = ffd_chain_seam(&chain, l, a);
            assert_int_equal(seam != NULL, a == 1 && (l == 1 || l == 4));
            if (seam)
                assert_true(seam->link == l && seam->direction == a);
        }
    ffd_chain_free(&chain);
    chain = make_chain(true, 5, all);
    assert_int_equal(ffd_chain_marked(&chain), 5); /* outside, disagrees, and one for each direction */
    ffd_chain_free(&chain);
    static const char *const none[] = {LIFTED, BOX};
    chain = make_chain(true, 2, none);
    assert_int_equal(ffd_chain_marked(&chain), 2);
    ffd_chain_free(&chain);
    (void)state;
}

/* Returns the marks of a point at v in a link, as bits by link. */
static unsigned marked(const lattice_chain *chain, size_t link, double v)
{
    static uint8_t kept[2 * CHAIN_RUN];
    chain_run run = {.count = 1, .kept = kept};
    const double uvw[3] = {0.9, v, 0.9};
    unsigned set = 0;
    memset(kept, 0, sizeof kept);
    ffd_seams_mark(chain, link, &run, 1, uvw);
    for (size_t m = 0; m < ffd_chain_marked(chain); m++)
        if (kept[ffd_kept_plane(m) * CHAIN_RUN + 1] & ffd_kept_bit(m))
            set |= 1u << m;
    assert_int_equal(run.keeps, set != 0);
    return set;
}

static void points_nearer_to_the_last_face_are_marked(void **state)
{
    static const char *const all[] = {OPENED, BOX, OPENED};
    lattice_chain chain = make_chain(false, 3, all);
    for (size_t l = 0; l < 3; l++)
        for (int i = 0; i <= 8; i++) {
            const unsigned mark = l == 0 ? 1u << 3 : l == 2 ? 1u << 4 : 0;
            assert_int_equal(marked(&chain, l, i / 8.0), i > 4 ? mark : 0);
        }
    ffd_chain_free(&chain);
    chain = make_chain(true, 3, all); /* with blocks, marks stand for directions */
    for (size_t l = 0; l < 3; l++)
        for (int i = 0; i <= 8; i++)
            assert_int_equal(marked(&chain, l, i / 8.0), i > 4 && l != 1 ? 1u << 3 : 0);
    ffd_chain_free(&chain);
    (void)state;
}

/* Each face at its own u,w; their v is ignored. */
static void the_parting_is_that_of_the_two_faces(void **state)
{
    static const char *const all[] = {OPENED, WEIGHTED};
    lattice_chain chain = make_chain(false, 2, all);
    const chain_seam *const seam = ffd_chain_seam(&chain, 0, 1), *const weighted =
                                                                     ffd_chain_seam(&chain, 1, 1);
    assert_non_null(seam);
    assert_non_null(weighted); /* this case cannot be detected earlier */
    for (int i = 0; i <= 4; i++) {
        const double low[3] = {0.75, 0.25, 0.5}, high[3] = {i / 4.0, 0.5, 0.5};
        assert_float_equal(ffd_seam_parting(&chain, seam, low, high), 3 * i / 4.0, 1e-15);
        assert_true(ffd_seam_parting(&chain, weighted, low, high) == 0);
    }
    ffd_chain_free(&chain);
    (void)state;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(only_faces_that_the_moves_part_are_a_seam),
        cmocka_unit_test(points_nearer_to_the_last_face_are_marked),
        cmocka_unit_test(the_parting_is_that_of_the_two_faces),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
