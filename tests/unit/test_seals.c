/* test_seals.c - faces that are held, by jobs of the library: what they share with other jobs, and that they
   are what ffd_lattice_seal makes. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/draw.h"
#include "../support/test_folder.h"
#include "embed/locator.h"
#include "job/chain/job_cache.h"
#include "job/chain/seals.h"
#include "lattice/lattice.h"
#include <ffd/author.h>
#include <ffd/job.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SIDE 9

/* A square sheet of SIDE x SIDE vertices, x from -3 to 3, y from -1 to 1. */
static void write_sheet(const char *name)
{
    static char text[20000];
    size_t used = 0;
    for (int j = 0; j < SIDE; j++)
        for (int i = 0; i < SIDE; i++)
            used += (size_t)snprintf(text + used, sizeof text - used, "v %.17g %.17g 0.25\n",
                                     -3 + 6.0 * i / (SIDE - 1), -1 + 2.0 * j / (SIDE - 1));
    for (int j = 0; j + 1 < SIDE; j++)
        for (int i = 0; i + 1 < SIDE; i++) {
            const int a = j * SIDE + i + 1;
            used += (size_t)snprintf(text + used, sizeof text - used, "f %d %d %d %d\n", a, a + 1,
                                     a + SIDE + 1, a + SIDE);
        }
    put_text(name, text);
}

/* rest: of a box, or control points that are bent. */
static void write_lattice(const char *name, bool is_bent, double by)
{
    static char text[20000];
    size_t used = (size_t)snprintf(text, sizeof text,
                                   "{\"format\": \"ffd-lattice\", \"version\": 1, \"size\": [6, 4, 4], "
                                   "\"moves\": [{\"by\": [0.1, 0, %g]}], \"rest\": {",
                                   by);
    if (!is_bent)
        used += (size_t)snprintf(text + used, sizeof text - used,
                                 "\"box\": {\"min\": [-2, -2, -2], \"max\": [2, 2, 2]}}}");
    for (int i = 0; i < 96 && is_bent; i++) {
        const double x = -2 + 0.8 * (i % 6), y = -2 + 4.0 * (i / 6 % 4) / 3, z = -2 + 4.0 * (i / 24) / 3;
        used += (size_t)snprintf(text + used, sizeof text - used, "%s[%.17g, %.17g, %.17g]%s",
                                 i == 0 ? "\"points\": [" : "", x + 0.05 * y * y, y, z, i < 95 ? "," : "]}}");
    }
    put_text(name, text);
}

/* Receives the positions of SIDE * SIDE vertices. */
static ffd_status take_positions(void *user, const double *positions, size_t count)
{
    assert_int_equal(count, SIDE * SIDE);
    memcpy(user, positions, 3 * count * sizeof *positions);
    return FFD_OK;
}

typedef struct run_result {
    double positions[3 * SIDE * SIDE];
    ffd_job_result job;
} run_result;

static void run(const ffd_lattice_source *lattice, ffd_seam seam, unsigned faces, ffd_job_cache *cache,
                run_result *result)
{
    ffd_deform_desc desc;
    ffd_error error = {.message = ""};
    ffd_deform_desc_init(&desc, sizeof desc);
    desc.input.path = in_folder("a.obj");
    desc.lattices = lattice;
    desc.lattice_count = 1;
    desc.seam = seam;
    desc.seam_faces = faces;
    desc.cache = cache;
    desc.quality = true;
    desc.positions = take_positions;
    desc.positions_user = result->positions;
    result->job.struct_size = sizeof result->job;
    if (ffd_deform_run(&desc, &result->job, &error))
        fail_msg("%s", error.message);
}

/* A path in the folder, which in_folder keeps only for a while. */
static char *path_of(const char *name)
{
    return strdup(in_folder(name));
}

static void jobs_hold_what_the_lattice_call_holds(void **state)
{
    (void)state;
    write_sheet("a.obj");
    for (int is_bent = 0; is_bent < 2; is_bent++) {
        write_lattice("l.json", is_bent, 0.25);
        char *const path = path_of("l.json");
        const ffd_lattice_source source = {.path = path};
        run_result named, cut, plain, sealed;
        ffd_lattice *lattice, *held;
        assert_int_equal(ffd_lattice_load(path, &lattice, NULL), FFD_OK);
        assert_int_equal(ffd_lattice_seal(lattice, 1, 3, &held, NULL), FFD_OK);
        const ffd_lattice_source own = {.object = held};
        run(&source, FFD_SEAM_C1, 3, NULL, &named);
        run(&source, FFD_SEAM_C1, FFD_FACES_CUT, NULL, &cut);
        run(&source, FFD_SEAM_NONE, 3, NULL, &plain);
        run(&own, FFD_SEAM_NONE, 0, NULL, &sealed);
        assert_memory_equal(named.positions, sealed.positions, sizeof named.positions);
        assert_memory_equal(named.positions, cut.positions, sizeof named.positions);
        assert_memory_not_equal(named.positions, plain.positions, sizeof named.positions);
        assert_true(cut.job.seam.is_there && !plain.job.seam.is_there);
        assert_int_equal(cut.job.seam.continuity, FFD_SEAM_C1);
        assert_int_equal(cut.job.seam.count, 1);
        assert_int_equal(cut.job.seam.faces[0], 3);
        assert_int_equal(cut.job.tear.edges, 0);
        assert_true(plain.job.tear.edges > 0);
        assert_memory_equal(&cut.job.residual, &plain.job.residual, sizeof plain.job.residual); /* of u,v,w */
        ffd_lattice_destroy(&lattice);
        ffd_lattice_destroy(&held);
        free(path);
    }
}

/* The cache has the mesh, its u,v,w and the lattice as it is, and its proof, whatever is held. */
static void jobs_share_what_no_face_changes(void **state)
{
    (void)state;
    static const struct {
        ffd_seam seam;
        unsigned faces;
    } turns[] = {{FFD_SEAM_C1, FFD_FACES_CUT}, {FFD_SEAM_NONE, 0},           {FFD_SEAM_C0, 2},
                 {FFD_SEAM_C1, FFD_FACES_CUT}, {FFD_SEAM_C0, FFD_FACES_ALL}, {FFD_SEAM_NONE, 0}};
    write_sheet("a.obj");
    for (int is_bent = 0; is_bent < 2; is_bent++) {
        ffd_job_cache *cache;
        char *paths[2];
        write_lattice("l.json", is_bent, 0.25);
        write_lattice("k.json", is_bent, 3);
        paths[0] = path_of("l.json");
        paths[1] = path_of("k.json");
        assert_int_equal(ffd_job_cache_create(&cache, NULL), FFD_OK);
        for (size_t t = 0; t < sizeof turns / sizeof *turns; t++)
            for (int l = 0; l < 2; l++) {
                const ffd_lattice_source source = {.path = paths[l]};
                run_result cached, alone;
                run(&source, turns[t].seam, turns[t].faces, cache, &cached);
                run(&source, turns[t].seam, turns[t].faces, NULL, &alone);
                assert_memory_equal(cached.positions, alone.positions, sizeof alone.positions);
                assert_int_equal(cached.job.folds.verdict, alone.job.folds.verdict);
                assert_memory_equal(&cached.job.folds.min_det, &alone.job.folds.min_det, sizeof(double));
                assert_int_equal(cached.job.seam.is_there, alone.job.seam.is_there);
                assert_int_equal(cached.job.seam.continuity, alone.job.seam.continuity);
                assert_int_equal(cached.job.seam.count, alone.job.seam.count);
                assert_memory_equal(cached.job.seam.faces, alone.job.seam.faces, sizeof alone.job.seam.faces);
            }
        const cache_counts counts = ffd_job_cache_counts(cache);
        assert_int_equal(counts.reads, 1);
        assert_int_equal(counts.searches, 1); /* both have the same rest */
        ffd_job_cache_destroy(&cache);
        free(paths[0]);
        free(paths[1]);
    }
}

static void a_box_that_is_called_held_has_all_its_points_inside(void **state)
{
    (void)state;
    draw d = {draw_seed()};
    size_t held = 0, missed = 0;
    for (int turn = 0; turn < 2000; turn++) {
        ffd_lattice_desc desc;
        ffd_lattice *lattice;
        ffd_locator *locator;
        double ends[6], min[3], max[3];
        ffd_lattice_desc_init(&desc, sizeof desc);
        for (int a = 0; a < 3; a++) {
            desc.margin[a] = 0;
            ends[a] = draw_between(&d, -2, 0);
            ends[3 + a] = draw_between(&d, 0.5, 2);
            min[a] = draw_between(&d, -2.2, 1);
            max[a] = min[a] + draw_between(&d, 0, 1.5);
        }
        assert_int_equal(ffd_lattice_create(&desc, ends, 2, &lattice, NULL), FFD_OK);
        assert_int_equal(ffd_locator_create(lattice, &locator, NULL), FFD_OK);
        bool all = true;
        for (int corner = 0; corner < 8; corner++) {
            ffd_location location;
            const double p[3] = {corner & 1 ? max[0] : min[0], corner & 2 ? max[1] : min[1],
                                 corner & 4 ? max[2] : min[2]};
            assert_int_equal(ffd_locator_find(locator, p, 1, &location, NULL), FFD_OK);
            all = all && ffd_location_is_placed(&location);
        }
        const bool answer = ffd_locator_holds_box(locator, min, max);
        held += answer;
        missed += all && !answer;
        if (answer && !all)
            fail_msg("turn %d: a corner is outside", turn);
        ffd_locator_destroy(&locator);
        ffd_lattice_destroy(&lattice);
    }
    assert_true(held > 100 && missed < 10);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(jobs_hold_what_the_lattice_call_holds),
        cmocka_unit_test(jobs_share_what_no_face_changes),
        cmocka_unit_test(a_box_that_is_called_held_has_all_its_points_inside),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
