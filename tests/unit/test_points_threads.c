/* test_points_threads.c - one embedding, lattice and locator shared by eight threads, for the thread
   sanitizer; results equal those of one thread. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "../support/draw.h"
#include "../support/repetitions.h"
#include <ffd/ffd.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#define THREADS 8
/* More than two tiles, so that each call starts threads of its own. */
#define POINTS ((size_t)9000)

typedef struct results {
    float moved[3 * POINTS], some[3 * POINTS];
    double variants[2 * 3 * POINTS], gradients[9 * POINTS], products[3 * POINTS], adjoint[3 * 125],
        uvw[3 * POINTS];
    uint32_t affected;
    double entries;
} results;

typedef struct shared {
    ffd_lattice *lattice;
    ffd_embedding *embedding;
    ffd_locator *locator;
    double points[3 * POINTS];
    uint32_t vertices[POINTS / 2];
    double offsets[2 * 3 * 125];
} shared;

typedef struct user {
    shared *all;
    results *own;
    int threads;
    bool failed;
} user;

static void take_part(user *u)
{
    shared *const all = u->all;
    results *const own = u->own;
    ffd_run_options run;
    ffd_run_options_init(&run, sizeof run);
    run.threads = u->threads;
    const ffd_span in = {all->points, POINTS, FFD_FLOAT64, 0, 0};
    const ffd_span out = {own->moved, POINTS, FFD_FLOAT32, 0, 0},
                   some = {own->some, POINTS, FFD_FLOAT32, 0, 0};
    u->failed |=
        ffd_embedding_deform(all->embedding, all->lattice, in, out, own->gradients, &run, NULL) != FFD_OK;
    u->failed |= ffd_embedding_deform_some(all->embedding, all->lattice, all->vertices, POINTS / 2, in, some,
                                           NULL, &run, NULL) != FFD_OK;
    u->failed |=
        ffd_embedding_basis_times(all->embedding, NULL, all->points, own->products, &run, NULL) != FFD_OK;
    u->failed |=
        ffd_embedding_basis_transposed(all->embedding, NULL, all->points, own->adjoint, &run, NULL) != FFD_OK;
    const ffd_span variants = {own->variants, 2 * POINTS, FFD_FLOAT64, 0, 0};
    u->failed |=
        ffd_embedding_deform_many(all->embedding, 2, all->offsets, in, variants, &run, NULL) != FFD_OK;
    const size_t corner = 31;
    uint32_t *listed = NULL;
    size_t count = 0;
    u->failed |= ffd_embedding_affected(all->embedding, &corner, 1, &listed, &count, NULL) != FFD_OK;
    own->affected = (uint32_t)count;
    ffd_free(listed);
    ffd_csr matrix;
    u->failed |= ffd_embedding_basis(all->embedding, NULL, &matrix, &run, NULL) != FFD_OK;
    own->entries = (double)matrix.starts[matrix.rows];
    ffd_csr_free(&matrix);
    ffd_location found[64];
    u->failed |=
        ffd_locator_locate(all->locator, all->points, 64, NULL, found, sizeof *found, NULL) != FFD_OK;
    for (size_t i = 0; i < 64; i++)
        memcpy(own->uvw + 3 * i, found[i].uvw, sizeof found[i].uvw);
}

static void *thread_main(void *given)
{
    take_part(given);
    return NULL;
}

static void prepare(shared *all)
{
    draw d = {8};
    ffd_lattice_arrays arrays;
    ffd_lattice_arrays_init(&arrays, sizeof arrays);
    double rest[3 * 125];
    for (size_t i = 0; i < 125; i++) {
        const size_t at[3] = {i % 5, i / 5 % 5, i / 25};
        for (int a = 0; a < 3; a++)
            rest[3 * i + (size_t)a] = (double)at[a] / 4 + draw_between(&d, -0.02, 0.02);
    }
    for (int a = 0; a < 3; a++)
        arrays.size[a] = 5;
    arrays.rest = rest;
    assert_int_equal(ffd_lattice_from_arrays(&arrays, &all->lattice, NULL), FFD_OK);
    for (size_t i = 0; i < 3 * POINTS; i++)
        all->points[i] = draw_between(&d, -0.05, 1.05);
    for (size_t i = 0; i < POINTS / 2; i++)
        all->vertices[i] = (uint32_t)(2 * i);
    for (size_t i = 0; i < 2 * 3 * 125; i++)
        all->offsets[i] = draw_between(&d, -0.05, 0.05);
    ffd_embedding_desc desc;
    ffd_embedding_desc_init(&desc, sizeof desc);
    desc.lattice = all->lattice;
    desc.points = (ffd_span){all->points, POINTS, FFD_FLOAT64, 0, 0};
    desc.outside = FFD_OUTSIDE_EXTEND;
    assert_int_equal(ffd_embedding_create(&desc, NULL, &all->embedding, NULL), FFD_OK);
    assert_int_equal(ffd_locator_create(all->lattice, &all->locator, NULL), FFD_OK);
    for (size_t i = 0; i < 3 * 125; i++)
        rest[i] += draw_between(&d, -0.1, 0.1);
    assert_int_equal(ffd_lattice_set_points(all->lattice, NULL, 125, rest, NULL), FFD_OK);
}

static void eight_threads_share_one_embedding(void **state)
{
    const int threads = is_under_valgrind() ? 3 : THREADS; /* which runs one at a time */
    shared *const all = calloc(1, sizeof *all);
    results *const own = calloc(THREADS + 1, sizeof *own);
    assert_true(all && own);
    prepare(all);
    pthread_t running[THREADS];
    user users[THREADS + 1];
    for (int t = 0; t <= threads; t++)
        users[t] = (user){all, &own[t], t == threads ? 1 : 1 + t % 3, false};
    for (int t = 0; t < threads; t++)
        assert_int_equal(pthread_create(&running[t], NULL, thread_main, &users[t]), 0);
    for (int t = 0; t < threads; t++)
        assert_int_equal(pthread_join(running[t], NULL), 0);
    take_part(&users[threads]);
    for (int t = 0; t <= threads; t++) {
        assert_false(users[t].failed);
        assert_memory_equal(&own[t], &own[threads], sizeof *own);
    }
    assert_true(own->affected > 0 && own->entries > 0);
    ffd_locator_destroy(&all->locator);
    ffd_embedding_destroy(&all->embedding);
    ffd_lattice_destroy(&all->lattice);
    free(all);
    free(own);
    (void)state;
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(eight_threads_share_one_embedding)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
