/* test_job_cache.c - a cached mesh or lattice is not reused after its file has changed. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/test_folder.h"
#include "embed/cells/cells.h"
#include "embed/locator.h"
#include "embed/locator_border.h"
#include "job/chain/chain_load.h"
#include "job/chain/job_cache.h"
#include "job/deform_job.h"
#include "job/figures/figure_values.h"
#include "job/input/source.h"
#include "job/measure/figures.h"
#include <time.h>

static const char one[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
                  other[] = "v 0 0 0\nv 2 0 0\nv 0 1 0\nf 1 2 3\n";

static mesh_document *opened(const ffd_deform_desc *desc)
{
    mesh_document *document;
    assert_int_equal(ffd_source_open(&desc->input, 1, &document, NULL), FFD_OK);
    return document;
}

/* Waits until newly written files get a different time. */
static void let_time_pass(void)
{
    nanosleep(&(struct timespec){.tv_nsec = 20000000}, NULL);
}

/* Caches the mesh, like a job that opened it when its file had this stamp. */
static void keep(ffd_job_cache *cache, const ffd_deform_desc *desc, const file_stamp *stamp)
{
    mesh_document *const document = opened(desc);
    ffd_job_cache_describe_mesh(cache, desc, false, stamp, document);
    ffd_job_cache_put_mesh(cache, desc, document);
}

static bool takes(ffd_job_cache *cache, const ffd_deform_desc *desc, bool only_positions)
{
    mesh_document *document = ffd_job_cache_take_mesh(cache, desc, only_positions);
    const bool taken = document != NULL;
    ffd_source_close(&document);
    return taken;
}

static void a_mesh_is_lent_only_while_nothing_changed(void **state)
{
    ffd_job_cache *cache;
    ffd_deform_desc desc, differs;
    file_stamp stamp;
    assert_int_equal(ffd_job_cache_create(&cache, NULL), FFD_OK);
    ffd_deform_desc_init(&desc, sizeof desc);
    put_text("m.obj", one);
    desc.input.path = in_folder("m.obj");
    assert_true(ffd_file_stamp(desc.input.path, &stamp));

    assert_false(takes(cache, &desc, false));
    keep(cache, &desc, &stamp);
    assert_true(takes(cache, &desc, false));
    assert_false(takes(cache, &desc, false)); /* it was taken and not put back */

    keep(cache, &desc, &stamp);
    assert_false(takes(cache, &desc, true));
    keep(cache, &desc, &stamp);
    differs = desc;
    differs.input.memory = 1 << 30;
    assert_false(takes(cache, &differs, false));
    keep(cache, &desc, &stamp);
    differs = desc;
    differs.as_morph = "name"; /* modifies the document */
    assert_false(takes(cache, &differs, false));

    /* Equal size, written a moment later. */
    keep(cache, &desc, &stamp);
    let_time_pass();
    put_text("m.obj", other);
    assert_false(takes(cache, &desc, false));
    /* Changed between stamping and opening, or while the job read it. */
    keep(cache, &desc, &stamp);
    assert_false(takes(cache, &desc, false));
    ffd_job_cache_destroy(&cache);
    (void)state;
}

/* The state of the mesh that a job with this share has read. */
static bool state_of(ffd_job_cache *cache, const ffd_deform_desc *desc, hash128 *hash)
{
    file_stamp stamp;
    ffd_job_cache_begin_job(cache, false, NULL);
    mesh_document *document = ffd_job_cache_take_mesh(cache, desc, false);
    if (!document) {
        assert_true(ffd_file_stamp(desc->input.path, &stamp));
        document = opened(desc);
        ffd_job_cache_describe_mesh(cache, desc, false, &stamp, document);
    }
    ffd_job_cache_put_mesh(cache, desc, document);
    return ffd_job_cache_find_state(cache, hash);
}

static void a_mesh_that_has_changed_has_another_state(void **state)
{
    ffd_job_cache *cache;
    ffd_deform_desc desc;
    hash128 first, again, late;
    assert_int_equal(ffd_job_cache_create(&cache, NULL), FFD_OK);
    ffd_deform_desc_init(&desc, sizeof desc);
    put_text("m.obj", one);
    desc.input.path = in_folder("m.obj");
    assert_true(state_of(cache, &desc, &first));
    assert_true(state_of(cache, &desc, &again));
    assert_true(ffd_hash_equal(&again, &first));
    assert_int_equal(ffd_job_cache_counts(cache).reads, 1);

    let_time_pass();
    put_text("m.obj", other); /* while the job reads it */
    assert_true(ffd_job_cache_find_state(cache, &late));
    assert_false(ffd_hash_equal(&late, &first));
    assert_true(state_of(cache, &desc, &again)); /* before the next job */
    assert_false(ffd_hash_equal(&again, &first));
    assert_int_equal(ffd_job_cache_counts(cache).reads, 2);

    ffd_job_cache_begin_job(cache, false, NULL); /* fails before it reads */
    assert_false(ffd_job_cache_find_state(cache, &late));
    desc.in_place = true;
    assert_false(state_of(cache, &desc, &late));
    ffd_job_cache_destroy(&cache);
    (void)state;
}

static void a_mesh_is_lent_only_for_the_same_selection(void **state)
{
    static const char *const only[] = {"group:a"}, *const others[] = {"group:b"};
    ffd_job_cache *cache;
    ffd_deform_desc desc;
    file_stamp stamp;
    assert_int_equal(ffd_job_cache_create(&cache, NULL), FFD_OK);
    ffd_deform_desc_init(&desc, sizeof desc);
    put_text("g.obj", "g a\nv 0 0 0\ng b\nv 1 0 0\n");
    desc.input.path = in_folder("g.obj");
    desc.only = only;
    desc.only_count = 1;
    assert_true(ffd_file_stamp(desc.input.path, &stamp));
    keep(cache, &desc, &stamp);
    assert_true(takes(cache, &desc, false));
    keep(cache, &desc, &stamp);
    desc.only = others;
    assert_false(takes(cache, &desc, false));
    ffd_job_cache_destroy(&cache);
    (void)state;
}

#define HEAD "{\"format\": \"ffd-lattice\", \"version\": 1, \"degree\": [1, 1, 1], \"size\": [2, 2, 2], "
#define BENT(x)                                                                                              \
    HEAD "\"rest\": {\"points\": [[" x                                                                       \
         ", 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [0, 0, 1], [1, 0, 1], [0, 1, 1], [1, 1, 1]]}}"
#define CURVED                                                                                               \
    HEAD "\"rest\": {\"points\": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1.25, 1, 0.125], [0, 0, 1], [1, 0.25, "  \
         "1], "                                                                                              \
         "[0, 1, 1], [1, 1, 1]]}}"
#define MESH_BOX HEAD "\"rest\": {\"box\": \"mesh\"}}"

/* Each locator still has the lattice that it refers to. */
static void find_slot(lattice_chain *chain, size_t link)
{
    static const double box[2][3] = {{0, 0, 0}, {2, 2, 2}}, inside[3] = {0.5, 0.5, 0.5};
    ffd_location location;
    if (!chain->links[link].locator) {
        assert_int_equal(ffd_lattice_fit(chain->links[link].lattice, box[0], box[1], NULL), FFD_OK);
        assert_int_equal(ffd_chain_prepare(chain, link, NULL), FFD_OK);
    }
    assert_int_equal(ffd_locator_find(chain->links[link].locator, inside, 1, &location, NULL), FFD_OK);
    assert_int_equal(location.status, FFD_VERTEX_INSIDE);
}

static lattice_chain load(ffd_job_cache *cache, const chain_files *files, const chain_outside *outside,
                          ffd_isa isa)
{
    lattice_chain chain;
    ffd_error error;
    if (ffd_chain_load(files, outside, isa, cache, &chain, &error))
        fail_msg("%s", error.message);
    return chain;
}

/* Returns bits for what a job with these files took from the cache: its lattices, then its locators. */
static unsigned borrowed(ffd_job_cache *cache, const chain_files *files, ffd_isa isa)
{
    static const chain_outside outside;
    lattice_chain chain = load(cache, files, &outside, isa);
    unsigned found = 0;
    for (size_t i = 0; i < chain.count; i++) {
        find_slot(&chain, i);
        found |= (unsigned)chain.links[i].lattice_is_lent << i;
        found |= (unsigned)chain.links[i].locator_is_lent << (chain.count + i);
    }
    ffd_job_cache_put_chain(cache, &chain);
    ffd_chain_free(&chain);
    return found;
}

static void only_lattices_of_unchanged_files_are_lent(void **state)
{
    char a_path[4096], box_path[4096];
    snprintf(a_path, sizeof a_path, "%s", in_folder("a.json"));
    snprintf(box_path, sizeof box_path, "%s", in_folder("box.json"));
    const ffd_lattice_source lattices[] = {{.path = a_path}, {.path = box_path}};
    const chain_files a = {.lattices = lattices, .count = 1}, both = {.lattices = lattices, .count = 2};
    ffd_job_cache *cache;
    assert_int_equal(ffd_job_cache_create(&cache, NULL), FFD_OK);
    put_text("a.json", BENT("0"));
    put_text("box.json", MESH_BOX);
    assert_int_equal(borrowed(cache, &a, FFD_ISA_AUTO), 0);
    assert_int_equal(borrowed(cache, &a, FFD_ISA_AUTO), 3);
    assert_int_equal(borrowed(cache, &a, FFD_ISA_SCALAR), 1); /* another locator of the same lattice */
    assert_int_equal(borrowed(cache, &a, FFD_ISA_SCALAR), 3);
    /* A lattice whose box goes round each mesh is loaded for each mesh. */
    assert_int_equal(borrowed(cache, &both, FFD_ISA_SCALAR), 5);
    assert_int_equal(borrowed(cache, &both, FFD_ISA_SCALAR), 13);

    let_time_pass();
    put_text("a.json", BENT("0.25"));
    assert_int_equal(borrowed(cache, &a, FFD_ISA_SCALAR), 0);
    assert_int_equal(borrowed(cache, &a, FFD_ISA_SCALAR), 3);
    /* The same rest volume in another file: its locator still refers to the lattice it was made for. */
    let_time_pass();
    put_text("a.json", BENT("0.25") " ");
    assert_int_equal(borrowed(cache, &a, FFD_ISA_SCALAR), 2);
    assert_int_equal(borrowed(cache, &a, FFD_ISA_SCALAR), 3);
    ffd_job_cache_destroy(&cache);
    (void)state;
}

/* Folds and border are available to the next job once one job has asked for them. The border is the one that
   the locator uses for points that miss the volume by rounding. */
static void folds_and_border_are_lent_once_asked_for(void **state)
{
    static const chain_outside keep_them, extend = {.extend = true};
    char path[4096];
    snprintf(path, sizeof path, "%s", in_folder("f.json"));
    const ffd_lattice_source lattice = {.path = path};
    const chain_files files = {.lattices = &lattice, .count = 1};
    const boundary *first = NULL, *border;
    ffd_job_result result = {.struct_size = sizeof result}, again = result;
    ffd_job_cache *cache;
    put_text("f.json", BENT("0"));
    assert_int_equal(ffd_job_cache_create_for_lattices(&cache, NULL), FFD_OK);
    for (int job = 0; job < 6; job++) {
        lattice_chain chain = load(cache, &files, job == 1 || job >= 4 ? &extend : &keep_them, FFD_ISA_AUTO);
        const chain_link *const link = &chain.links[0];
        assert_int_equal(link->lattice_is_lent && link->locator_is_lent, job > 0);
        assert_int_equal(link->border != NULL, job == 1 || job >= 4);
        assert_int_equal(ffd_locator_border(link->locator, &border, NULL), FFD_OK);
        if (job == 0)
            first = border;
        assert_true(border == first && (!link->border || link->border == first));
        assert_int_equal(link->has_folds, job > 2);
        ffd_result_clear(&result);
        if (job >= 2)
            assert_int_equal(ffd_figures_folds(&chain, 1, &result, NULL), FFD_OK);
        if (job == 2)
            again = result;
        if (job > 2)
            assert_true(result.folds.is_known && result.folds.cells == again.folds.cells &&
                        result.folds.min_det == again.folds.min_det && result.folds.cells == 1);
        ffd_job_cache_put_chain(cache, &chain);
        ffd_chain_free(&chain);
    }
    ffd_job_cache_destroy(&cache);
    (void)state;
}

static void a_share_for_lattices_keeps_no_mesh(void **state)
{
    static const chain_outside outside;
    char path[4096];
    ffd_deform_desc desc;
    ffd_job_cache *cache;
    file_stamp stamp;
    ffd_deform_desc_init(&desc, sizeof desc);
    put_text("o.obj", one);
    desc.input.path = in_folder("o.obj");
    assert_true(ffd_file_stamp(desc.input.path, &stamp));
    assert_int_equal(ffd_job_cache_create_for_lattices(&cache, NULL), FFD_OK);
    assert_false(ffd_job_cache_holds_meshes(cache) || ffd_job_cache_holds_meshes(NULL));
    keep(cache, &desc, &stamp);
    assert_false(takes(cache, &desc, false));

    snprintf(path, sizeof path, "%s", in_folder("o.json"));
    const ffd_lattice_source lattice = {.path = path};
    const chain_files files = {.lattices = &lattice, .count = 1};
    put_text("o.json", CURVED);
    assert_int_equal(borrowed(cache, &files, FFD_ISA_AUTO), 0);
    assert_int_equal(borrowed(cache, &files, FFD_ISA_AUTO), 3);
    /* Work that counts against a limit would make the next job reach it earlier than alone. */
    lattice_chain chain = load(cache, &files, &outside, FFD_ISA_AUTO);
    assert_non_null(chain.links[0].locator->cells);
    atomic_store(&chain.links[0].locator->cells->heavy_leaves, 1);
    ffd_job_cache_put_chain(cache, &chain);
    ffd_chain_free(&chain);
    assert_int_equal(borrowed(cache, &files, FFD_ISA_AUTO), 1);
    assert_int_equal(borrowed(cache, &files, FFD_ISA_AUTO), 3);
    ffd_job_cache_destroy(&cache);
    (void)state;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_mesh_is_lent_only_while_nothing_changed),
        cmocka_unit_test(a_mesh_that_has_changed_has_another_state),
        cmocka_unit_test(a_mesh_is_lent_only_for_the_same_selection),
        cmocka_unit_test(only_lattices_of_unchanged_files_are_lent),
        cmocka_unit_test(folds_and_border_are_lent_once_asked_for),
        cmocka_unit_test(a_share_for_lattices_keeps_no_mesh),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
