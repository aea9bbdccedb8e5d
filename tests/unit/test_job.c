/* test_job.c - whole jobs through the library: refused descriptions, which figures are filled, and failing
   memory. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/job_description.h"
#include "../support/test_folder.h"
#include "base/file/input.h"
#include "base/memory/memory.h"
#include "job/report/depfile.h"
#include <ffd/job.h>
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static char mesh[64], lattice[64], output[64];
static const ffd_lattice_source lattices[] = {{.path = lattice}, {.path = lattice}};

static int set_up(void **state)
{
    assert_int_equal(make_folder(state), 0);
    put_text("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 9 0 0\nvn 0 0 1\nf 1//1 2//1 3//1\nf 2//1 3//1 4//1\n");
    put_text(
        "l.json",
        "{\"format\": \"ffd-lattice\", \"version\": 1, \"size\": [4, 4, 4], \"rest\": {\"box\": "
        "{\"min\": [-1, -1, -1], \"max\": [2, 2, 2]}}, \"moves\": [{\"at\": [1, 1, 1], \"by\": [0, 0, 1]}]}");
    strcpy(mesh, in_folder("a.obj"));
    strcpy(lattice, in_folder("l.json"));
    strcpy(output, in_folder("b.obj"));
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    return remove_files((const char *const[]){output, mesh, lattice}, 3);
}

static ffd_deform_desc describe(void)
{
    return describe_job(mesh, output, lattices);
}

static void refuse(const ffd_deform_desc *desc)
{
    ffd_job_result result = {.struct_size = sizeof result};
    ffd_error error;
    assert_int_equal(ffd_deform_run(desc, &result, &error), FFD_E_ARGUMENT);
    assert_int_equal(result.status, FFD_E_ARGUMENT);
    assert_string_equal(error.message, result.error.message);
    assert_int_equal(ffd_check_run(desc, &result, NULL), FFD_E_ARGUMENT);
    assert_false(result.folds.is_known);
    assert_int_not_equal(access(output, F_OK), 0);
}

static void wrong_descriptions_are_refused(void **state)
{
    ffd_deform_desc desc = describe();
    desc.struct_size += 8;
    refuse(&desc);
    desc = describe();
    desc.input.path = NULL;
    refuse(&desc);
    desc = describe();
    desc.lattice_count = 0;
    refuse(&desc);
    const double lengths[] = {-1, HUGE_VAL, NAN};
    for (int i = 0; i < 3; i++) {
        desc = describe();
        desc.outside = FFD_OUTSIDE_EXTEND;
        desc.falloff = lengths[i];
        refuse(&desc);
    }
    desc = describe();
    desc.falloff = 1;
    refuse(&desc);
    desc = describe();
    desc.embedding.path = "e.npy";
    desc.lattice_count = 2;
    refuse(&desc);
    (void)state;
}

/* Expensive figures are computed if they are asked for. */
static void costly_figures_are_there_when_asked_for(void **state)
{
    ffd_job_result result = {.struct_size = sizeof result};
    ffd_deform_desc desc = describe();
    assert_int_equal(ffd_deform_run(&desc, &result, NULL), FFD_OK);
    assert_false(result.folds.is_known || result.edges.is_known);
    assert_true(result.has_flipped); /* of a coarse mesh */
    assert_true(result.det.min > result.det.max);

    desc.fail_on = FFD_GATE_FOLDS;
    assert_int_equal(ffd_deform_run(&desc, &result, NULL), FFD_OK);
    assert_true(result.folds.is_known && !result.edges.is_known);
    assert_int_equal(result.folds.verdict, FFD_FOLDS_NONE);

    desc.fail_on = 0;
    desc.quality = true;
    assert_int_equal(ffd_deform_run(&desc, &result, NULL), FFD_OK);
    assert_true(result.folds.is_known && result.has_flipped && !result.edges.is_known);
    assert_true(result.det.min <= result.det.max);
    assert_int_equal(result.faces, 2);

    desc.output = NULL; /* ignored */
    desc.quality = false;
    assert_int_equal(ffd_check_run(&desc, &result, NULL), FFD_OK);
    assert_true(result.folds.is_known && result.has_flipped && result.edges.is_known);
    assert_int_equal(result.edges.count, 5);

    desc.fail_on = FFD_GATE_FOLDS | FFD_GATE_OUTSIDE;
    assert_int_equal(ffd_check_run(&desc, &result, NULL), FFD_E_GATE);
    assert_string_equal(result.error.message, "1 of 4 vertices is outside the lattice (fail_on = outside)");
    assert_int_equal(result.counts[FFD_VERTEX_OUTSIDE], 1);
    assert_true(result.folds.is_known && result.has_flipped && result.edges.is_known);
    (void)state;
}

static void fail_everywhere(ffd_status (*run)(const ffd_deform_desc *, ffd_job_result *, ffd_error *),
                            const ffd_deform_desc *desc)
{
    long failures = 0;
    for (ffd_status status = FFD_E_MEMORY; status; failures++) {
        ffd_job_result result = {.struct_size = sizeof result};
        ffd_error error = {0};
        ffd_alloc_fail_after(failures);
        status = run(desc, &result, &error);
        ffd_alloc_fail_after(-1);
        if (status) {
            assert_int_equal(status, FFD_E_MEMORY);
            assert_non_null(strstr(error.message, "out of memory"));
            assert_int_not_equal(access(output, F_OK), 0);
        }
    }
    assert_true(failures > 20);
    unlink(output);
}

/* Runs a job with a depfile, and writes it. */
static ffd_status run_with_depfile(const ffd_deform_desc *desc, ffd_job_result *result, ffd_error *error)
{
    ffd_deform_desc with = *desc;
    ffd_status status = ffd_depfile_create(in_folder("d"), &with.depfile, error);
    if (!status)
        status = ffd_deform_run(&with, result, error);
    if (!status) {
        status = ffd_depfile_write(with.depfile, error);
        if (status)
            unlink(output); /* which is complete */
    }
    ffd_depfile_destroy(&with.depfile);
    assert_null(with.depfile);
    assert_int_equal(access(in_folder("d"), F_OK), status ? -1 : 0);
    assert_int_not_equal(access(in_folder(".d.ffd-tmp"), F_OK), 0);
    return status;
}

/* Splats under a node with two sockets, a level of detail and a collider, and a camera that is far away. */
static void put_scene(void)
{
    put_text(
        "a.gltf",
        "{\"asset\": {\"version\": \"2.0\"}, \"scenes\": [{\"nodes\": [0, 3, 4]}], \"nodes\": [{\"mesh\": 0, "
        "\"name\": "
        "\"rose\", \"extensions\": {\"MSFT_lod\": {\"ids\": [1]}, \"KHR_physics_rigid_bodies\": "
        "{\"collider\": "
        "{\"geometry\": {\"node\": 2}}}}}, {\"mesh\": 0, \"translation\": [9, 0, "
        "0]}, {}, "
        "{\"name\": \"hand\", \"translation\": [0.5, 0.5, 0]}, {\"children\": [5], \"translation\": [3, 0, "
        "0]}, "
        "{\"camera\": 0, \"translation\": [6, 0, 0]}], \"cameras\": [{}], \"animations\": [{\"channels\": "
        "[{\"target\": {\"node\": 0, \"path\": \"rotation\"}}]}], \"meshes\": [{\"primitives\": [{\"mode\": "
        "0, "
        "\"attributes\": {\"POSITION\": 0}, \"extensions\": {\"KHR_gaussian_splatting\": {}}}]}], "
        "\"accessors\": "
        "[{\"bufferView\": 0, \"componentType\": 5126, \"count\": 3, \"type\": \"VEC3\", \"min\": [0, 0, 0], "
        "\"max\": [1, 1, 0]}], \"bufferViews\": [{\"buffer\": 0, \"byteLength\": 36}], \"buffers\": "
        "[{\"byteLength\": 36, \"uri\": \"data:application/octet-stream;base64,"
        "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}]}");
}

static void what_stays_behind_is_in_the_result(void **state)
{
    char input[64];
    ffd_job_result result = {.struct_size = sizeof result};
    ffd_deform_desc desc = describe();
    strcpy(input, in_folder("a.gltf"));
    put_scene();
    desc.input.path = input;
    assert_int_equal(ffd_check_run(&desc, &result, NULL), FFD_OK);
    const uint64_t counts[FFD_BEHIND_KIND_COUNT] = {
        [FFD_BEHIND_SOCKET] = 1, [FFD_BEHIND_PIVOT] = 1, [FFD_BEHIND_SPLAT] = 3};
    for (int k = 0; k < FFD_BEHIND_KIND_COUNT; k++)
        assert_int_equal(result.behind[k].count, counts[k]);
    assert_string_equal(result.behind[FFD_BEHIND_SOCKET].names[0], "hand");
    assert_string_equal(result.behind[FFD_BEHIND_SOCKET].names[1], "");
    assert_string_equal(result.behind[FFD_BEHIND_SPLAT].names[0], "rose");
    assert_int_equal(result.vertices, 6);
    assert_int_equal(result.counts[FFD_VERTEX_OUTSIDE], 3);

    unlink(output);
    fail_everywhere(ffd_check_run, &desc);
    static const char *const only[] = {"node:rose"};
    desc.only = only;
    desc.only_count = 1;
    fail_everywhere(ffd_check_run, &desc);
    assert_int_equal(ffd_check_run(&desc, &result, NULL), FFD_OK);
    assert_int_equal(result.behind[FFD_BEHIND_SOCKET].count, 0);
    assert_int_equal(result.behind[FFD_BEHIND_PIVOT].count, 1);
    unlink(input);
    (void)state;
}

static void a_depfile_names_output_and_inputs(void **state)
{
    ffd_deform_desc desc = describe();
    ffd_job_result result = {.struct_size = sizeof result};
    char expected[400];
    assert_int_equal(run_with_depfile(&desc, &result, NULL), FFD_OK);
    FILE *file = fopen(in_folder("d"), "r");
    char text[400] = "";
    assert_non_null(file);
    assert_non_null(fgets(text, sizeof text, file));
    fclose(file);
    snprintf(expected, sizeof expected, "%s: %s %s\n", output, mesh, lattice);
    assert_string_equal(text, expected);
    unlink(in_folder("d"));
    desc.in_place = true;
    desc.output = NULL;
    assert_int_equal(run_with_depfile(&desc, &result, NULL), FFD_E_ARGUMENT);
    (void)state;
}

static void morph_targets_have_figures_of_their_own(void **state)
{
    const char *const names[] = {"bent", "more"}, *const clips[] = {"hop: 0 bent=1, 1 more=1"};
    ffd_deform_desc desc = describe();
    ffd_job_result result = {.struct_size = sizeof result}, alone = result, results[2];
    (void)state;
    char glb[64];
    strcpy(glb, in_folder("m.glb"));
    desc.output = glb;
    desc.lattice_count = 2;
    desc.morphs = names;
    desc.clips = clips;
    desc.clip_count = 1;
    assert_int_equal(ffd_deform_run(&desc, &result, NULL), FFD_OK);
    assert_int_equal(result.morphs.count, 2);
    assert_null(result.morphs.results);
    assert_string_equal(result.morphs.names[1], "more");
    assert_string_equal(result.morphs.lattices[1].path, lattice);
    desc.morph_results = results;
    assert_int_equal(ffd_deform_run(&desc, &result, NULL), FFD_OK);
    assert_ptr_equal(result.morphs.results, results);
    desc = describe();
    assert_int_equal(ffd_check_run(&desc, &alone, NULL), FFD_OK);
    for (size_t k = 0; k < 2; k++) {
        assert_int_equal(results[k].counts[FFD_VERTEX_INSIDE], alone.counts[FFD_VERTEX_INSIDE]);
        assert_int_equal(results[k].moved, alone.moved);
        assert_memory_equal(&results[k].displacement.max, &alone.displacement.max, sizeof(double));
    }
    assert_int_equal(result.moved, alone.moved);
    assert_int_equal(result.vertices, alone.vertices);
    desc.output = glb;
    ffd_alloc_fail_after(0);
    desc.lattice_count = 2;
    desc.morphs = names;
    desc.morph_results = results;
    const ffd_status status = ffd_deform_run(&desc, &result, NULL);
    ffd_alloc_fail_after(-1);
    assert_int_equal(status, FFD_E_MEMORY);
    assert_non_null(strstr(result.error.message, "out of memory"));
    unlink(glb);
}

static void wrong_morph_targets_are_refused(void **state)
{
    const char *const names[] = {"bent", "more"}, *const twice[] = {"bent", "bent"},
                      *const empty[] = {"bent", ""}, *const bytes[] = {"bent", "\xff"};
    const char *const clips[] = {"hop: 0 bent"}, *const unknown[] = {"hop: 0 bend=1"};
    ffd_deform_desc desc = describe();
    ffd_job_result result = {.struct_size = sizeof result};
    (void)state;
    unlink(output); /* of an earlier test */
    desc.output_format = FFD_FORMAT_GLB;
    desc.lattice_count = 2;
    desc.morphs = twice;
    refuse(&desc);
    desc.morphs = empty;
    refuse(&desc);
    desc.morphs = bytes;
    refuse(&desc);
    desc.morphs = names;
    desc.blocks = true;
    refuse(&desc);
    desc.blocks = false;
    desc.as_morph = "x";
    refuse(&desc);
    desc.as_morph = NULL;
    desc.clips = clips;
    desc.clip_count = 1;
    refuse(&desc);
    desc.clips = unknown;
    refuse(&desc);
    desc.clips = NULL;
    refuse(&desc);
    desc.clip_count = 0;
    desc.output_format = FFD_FORMAT_AUTO; /* OBJ */
    refuse(&desc);
    desc.morphs = NULL;
    desc.clips = unknown;
    desc.clip_count = 1;
    assert_int_equal(ffd_deform_run(&desc, &result, NULL), FFD_E_ARGUMENT);
}

static void each_failed_allocation_is_reported(void **state)
{
    ffd_deform_desc desc = describe();
    unlink(output);
    fail_everywhere(run_with_depfile, &desc);
    unlink(in_folder("d"));
    fail_everywhere(ffd_check_run, &desc);
    desc.quality = true;
    fail_everywhere(ffd_deform_run, &desc);
    desc.outside = FFD_OUTSIDE_EXTEND;
    fail_everywhere(ffd_check_run, &desc);
    static const char *const only[] = {"group:default"};
    desc.only = only;
    desc.only_count = 1;
    desc.normals = FFD_NORMALS_RECOMPUTE;
    fail_everywhere(ffd_deform_run, &desc);
    (void)state;
}

/* Only selected vertices are counted. An unknown kind or name is an argument error. */
static void only_what_a_selector_names_is_counted(void **state)
{
    ffd_job_result result = {.struct_size = sizeof result};
    ffd_deform_desc desc = describe();
    static const char *const known[] = {"group:default"}, *const unknown[] = {"group:default", "material:x"},
                             *const wrong[] = {"groups:x"};
    assert_int_equal(ffd_selector_check(known[0], NULL), FFD_OK);
    assert_int_equal(ffd_selector_check(wrong[0], NULL), FFD_E_ARGUMENT);
    desc.only = known;
    desc.only_count = 1;
    assert_int_equal(ffd_check_run(&desc, &result, NULL), FFD_OK);
    assert_int_equal(result.vertices, 4);
    desc.only = unknown;
    desc.only_count = 2;
    assert_int_equal(ffd_check_run(&desc, &result, NULL), FFD_E_ARGUMENT);
    assert_string_equal(result.error.file, mesh);
    desc.only = wrong;
    desc.only_count = 1;
    assert_int_equal(ffd_check_run(&desc, &result, NULL), FFD_E_ARGUMENT);
    desc.only = NULL;
    refuse(&desc);
    (void)state;
}

/* A caller who watches a job. */
typedef struct watcher {
    pthread_t thread;
    int calls, cancels_at; /* the call that answers false; 0: none */
    double done;
    bool is_wrong; /* called by another thread, with a fraction that falls, or after it has cancelled */
} watcher;

static bool watch(void *user, double done)
{
    watcher *const w = user;
    w->is_wrong = w->is_wrong || !pthread_equal(w->thread, pthread_self()) || done < w->done || done < 0 ||
                  done > 1 || (w->cancels_at && w->calls >= w->cancels_at);
    w->done = done;
    return ++w->calls != w->cancels_at;
}

/* Shows the mesh in place of writing it. */
static ffd_status run_view(const ffd_deform_desc *desc, ffd_job_result *result, ffd_error *error)
{
    ffd_deform_desc job = *desc;
    job.output = NULL;
    ffd_view_desc view;
    ffd_view_desc_init(&view, sizeof view);
    view.job = &job;
    view.output = in_folder("a.html");
    const ffd_status status = ffd_view_run(&view, result, error);
    assert_int_equal(remove(in_folder("a.html")), 0);
    return status;
}

static void the_caller_watches_a_job(void **state)
{
    static ffd_status (*const calls[])(const ffd_deform_desc *, ffd_job_result *,
                                       ffd_error *) = {ffd_deform_run, ffd_check_run, run_view};
    (void)state;
    ffd_job_result result = {.struct_size = sizeof result};
    ffd_error error;
    for (size_t i = 0; i < sizeof calls / sizeof *calls; i++) {
        watcher w = {.thread = pthread_self()};
        ffd_deform_desc desc = describe();
        desc.threads = 3;
        desc.progress = watch;
        desc.progress_user = &w;
        assert_int_equal(calls[i](&desc, &result, &error), FFD_OK);
        assert_false(w.is_wrong);
        assert_true(w.calls >= 2 && w.done == 1);
    }
    assert_int_equal(remove(output), 0);
}

static void the_caller_cancels_a_job(void **state)
{
    (void)state;
    ffd_job_result result = {.struct_size = sizeof result};
    ffd_error error;
    ffd_output_list *outputs;
    watcher w = {.thread = pthread_self(), .cancels_at = 1};
    assert_int_equal(ffd_output_list_create(&outputs, NULL), FFD_OK);
    ffd_deform_desc desc = describe();
    desc.progress = watch;
    desc.progress_user = &w;
    desc.output_list = outputs;
    assert_int_equal(ffd_deform_run(&desc, &result, &error), FFD_E_CANCELLED);
    assert_int_equal(result.status, FFD_E_CANCELLED);
    assert_false(w.is_wrong);
    assert_int_equal(w.calls, 1);
    assert_int_equal(ffd_output_list_count(outputs), 0);
    assert_int_not_equal(access(output, F_OK), 0);
    /* With a time limit besides. */
    w = (watcher){.thread = pthread_self(), .cancels_at = 1};
    desc.timeout = 1000;
    assert_int_equal(ffd_deform_run(&desc, &result, &error), FFD_E_CANCELLED);
    w = (watcher){.thread = pthread_self()};
    desc.timeout = 1e-9;
    assert_int_equal(ffd_deform_run(&desc, &result, &error), FFD_E_LIMIT);
    ffd_output_list_destroy(&outputs);
}

static void outputs_are_listed(void **state)
{
    (void)state;
    ffd_job_result result = {.struct_size = sizeof result};
    ffd_output_list *outputs;
    assert_int_equal(ffd_output_list_create(&outputs, NULL), FFD_OK);
    ffd_deform_desc desc = describe();
    desc.output_list = outputs;
    desc.dry_run = true;
    for (int i = 0; i < 2; i++, desc.dry_run = false) {
        assert_int_equal(ffd_deform_run(&desc, &result, NULL), FFD_OK);
        assert_ptr_equal(result.outputs, outputs);
        assert_int_equal(ffd_output_list_count(outputs), 1);
        assert_string_equal(ffd_output_list_name(outputs, 0), output);
        assert_null(ffd_output_list_name(outputs, 1));
    }
    desc.force = false;
    assert_int_equal(ffd_deform_run(&desc, &result, NULL), FFD_E_EXISTS);
    assert_int_equal(ffd_output_list_count(outputs), 0);
    assert_int_equal(ffd_check_run(&desc, &result, NULL), FFD_OK);
    assert_int_equal(ffd_output_list_count(outputs), 0);
    ffd_output_list_destroy(&outputs);
    assert_int_equal(remove(output), 0);
}

/* Appends a rule to a depfile as a job does that is about to place its output. */
static void offer(ffd_depfile *depfile, const char *text, bool is_placed)
{
    byte_buffer rule = {0};
    ffd_buffer_text(&rule, text);
    assert_int_equal(ffd_depfile_offer(depfile, &rule, NULL), FFD_OK);
    if (!is_placed)
        ffd_depfile_withdraw(depfile, &rule);
    ffd_buffer_free(&rule);
}

/* The rule of an output that could not be placed, first, between others, or last. */
static void rules_that_are_withdrawn_are_not_written(void **state)
{
    static const char *const rules[] = {"a: b\n", "c.obj: d.obj l.json\n", "e: f\n"};
    for (unsigned placed = 0; placed < 8; placed++) {
        ffd_depfile *depfile;
        file_input found;
        byte_buffer expected = {0};
        assert_int_equal(ffd_depfile_create(in_folder("d"), &depfile, NULL), FFD_OK);
        for (unsigned i = 0; i < 3; i++) {
            offer(depfile, rules[i], placed >> i & 1);
            ffd_buffer_text(&expected, placed >> i & 1 ? rules[i] : "");
        }
        assert_int_equal(ffd_depfile_write(depfile, NULL), FFD_OK);
        ffd_depfile_destroy(&depfile);
        assert_int_equal(ffd_file_load(in_folder("d"), &found, NULL), FFD_OK);
        assert_int_equal(found.size, expected.size);
        if (found.size > 0)
            assert_memory_equal(found.data, expected.data, found.size);
        ffd_file_unload(&found);
        ffd_buffer_free(&expected);
        unlink(in_folder("d"));
    }
    (void)state;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(wrong_descriptions_are_refused),
        cmocka_unit_test(costly_figures_are_there_when_asked_for),
        cmocka_unit_test(what_stays_behind_is_in_the_result),
        cmocka_unit_test(a_depfile_names_output_and_inputs),
        cmocka_unit_test(morph_targets_have_figures_of_their_own),
        cmocka_unit_test(wrong_morph_targets_are_refused),
        cmocka_unit_test(each_failed_allocation_is_reported),
        cmocka_unit_test(only_what_a_selector_names_is_counted),
        cmocka_unit_test(the_caller_watches_a_job),
        cmocka_unit_test(the_caller_cancels_a_job),
        cmocka_unit_test(outputs_are_listed),
        cmocka_unit_test(rules_that_are_withdrawn_are_not_written),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
