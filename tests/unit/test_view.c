/* test_view.c - the job of ffd view through the library: refused descriptions, its result, failing memory;
   and the list of torn edges. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/test_folder.h"
#include "base/memory/memory.h"
#include "job/measure/torn_edges.h"
#include <ffd/job.h>
#include <math.h>

static char mesh[64], other[64], lattice[64], page[64], drawn[64];
static const ffd_lattice_source lattices[] = {{.path = lattice}};

/* A square and a triangle beside it; vertices from x = 2.5 on are outside. */
#define MESH                                                                                                 \
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 3 0 0\nv 4 0 %d\ng a\nf 1 2 4 3\ng b\nf 2 5 4\nl 1 6\np 6\n"

static int set_up(void **state)
{
    char text[200];
    assert_int_equal(make_folder(state), 0);
    snprintf(text, sizeof text, MESH, 0);
    put_text("a.obj", text);
    snprintf(text, sizeof text, MESH, 2);
    put_text("b.obj", text);
    put_text("l.json",
             "{\"format\": \"ffd-lattice\", \"version\": 1, \"size\": [2, 2, 2], \"rest\": {\"box\": "
             "{\"min\": [-1, -1, -1], \"max\": [2.5, 2, 2]}}, \"moves\": [{\"by\": [0, 0, 0.5]}]}");
    strcpy(mesh, in_folder("a.obj"));
    strcpy(other, in_folder("b.obj"));
    strcpy(lattice, in_folder("l.json"));
    strcpy(page, in_folder("p.html"));
    strcpy(drawn, in_folder("p.png"));
    return 0;
}

static ffd_deform_desc describe_job(void)
{
    ffd_deform_desc job;
    ffd_deform_desc_init(&job, sizeof job);
    job.input.path = mesh;
    job.lattices = lattices;
    job.lattice_count = 1;
    job.threads = 1;
    return job;
}

static ffd_view_desc describe(const ffd_deform_desc *job)
{
    ffd_view_desc view;
    ffd_view_desc_init(&view, sizeof view);
    view.job = job;
    view.output = page;
    return view;
}

static void refuse(const ffd_view_desc *view)
{
    ffd_job_result result = {.struct_size = sizeof result};
    ffd_error error;
    assert_int_equal(ffd_view_run(view, &result, &error), FFD_E_ARGUMENT);
    assert_int_equal(result.status, FFD_E_ARGUMENT);
    assert_int_not_equal(access(page, F_OK), 0);
}

static void descriptions_that_are_not_complete(void **state)
{
    const ffd_source nowhere = {0};
    ffd_deform_desc job = describe_job();
    ffd_view_desc view = describe(&job);
    view.job = NULL;
    refuse(&view);
    view = describe(&job);
    view.struct_size += 8;
    refuse(&view);
    view = describe(&job);
    view.output = NULL;
    refuse(&view);
    view.output = "a.txt";
    refuse(&view);
    view = describe(&job);
    view.camera[1] = NAN;
    refuse(&view);
    view = describe(&job);
    view.frames = 1;
    refuse(&view);
    view.frames = 65;
    view.width = view.height = 16;
    refuse(&view);
    view.frames = 0;
    view.width = 40000;
    refuse(&view);
    view = describe(&job);
    view.deformed = &nowhere;
    refuse(&view);
    view = describe(&job);
    job.input.path = NULL;
    refuse(&view);
    (void)state;
}

/* The result equals that of a check. */
static void figures_are_those_of_a_check(void **state)
{
    ffd_deform_desc job = describe_job();
    const ffd_view_desc view = describe(&job);
    ffd_job_result shown = {.struct_size = sizeof shown}, checked = shown;
    assert_int_equal(ffd_view_run(&view, &shown, NULL), FFD_OK);
    assert_int_equal(ffd_check_run(&job, &checked, NULL), FFD_OK);
    assert_int_equal(shown.vertices, checked.vertices);
    assert_int_equal(shown.tear.edges, 2);
    assert_int_equal(checked.tear.edges, 2);
    assert_int_equal(shown.moved, 4);
    assert_int_equal(access(page, F_OK), 0);
    unlink(page);
    job.fail_on = FFD_GATE_TEAR;
    job.tear_most = -1;
    assert_int_equal(ffd_view_run(&view, &shown, NULL), FFD_E_GATE);
    assert_int_equal(shown.status, FFD_E_GATE);
    assert_int_equal(access(page, F_OK), 0);
    unlink(page);
    (void)state;
}

static void what_is_written_is_recorded(void **state)
{
    ffd_deform_desc job = describe_job();
    ffd_view_desc view = describe(&job);
    ffd_job_result result = {.struct_size = sizeof result};
    ffd_error error;
    assert_int_equal(ffd_output_set_create(&job.output_set, &error), FFD_OK);
    view.force = true;
    assert_int_equal(ffd_view_run(&view, &result, NULL), FFD_OK);
    assert_int_equal(ffd_view_run(&view, &result, NULL), FFD_E_EXISTS);
    ffd_output_set_destroy(&job.output_set);
    unlink(page);
    (void)state;
}

/* Each allocation fails once, and nothing is left over. */
static void fail_everywhere(const ffd_view_desc *view)
{
    long failures = 0;
    for (ffd_status status = FFD_E_MEMORY; status; failures++) {
        ffd_job_result result = {.struct_size = sizeof result};
        ffd_error error = {0};
        ffd_alloc_fail_after(failures);
        status = ffd_view_run(view, &result, &error);
        ffd_alloc_fail_after(-1);
        assert_int_equal(result.status, status);
        if (status) {
            assert_int_equal(status, FFD_E_MEMORY);
            assert_non_null(strstr(error.message, "out of memory"));
            assert_int_not_equal(access(view->output, F_OK), 0);
            assert_null(result.picture);
        }
    }
    assert_true(failures > 20);
    unlink(view->output);
}

static void memory_ends_anywhere(void **state)
{
    const ffd_source deformed = {.path = other};
    ffd_deform_desc job = describe_job();
    ffd_view_desc view = describe(&job);
    fail_everywhere(&view);
    view.deformed = &deformed;
    fail_everywhere(&view);
    view.output = drawn;
    view.width = view.height = 40;
    fail_everywhere(&view);
    view.deformed = NULL;
    view.frames = 3;
    fail_everywhere(&view);
    (void)state;
}

/* Of many edges those with the largest steps are kept, without duplicates, whichever end stays. */
static void the_largest_torn_edges_are_kept(void **state)
{
    torn_edges torn = {0};
    const uint32_t count = 3 * (uint32_t)TORN_EDGES_MOST;
    for (uint32_t turn = 0; turn < 2; turn++)
        for (uint32_t i = 0; i < count; i++) {
            /* 7919 and the count are coprime: all steps occur, in a scrambled order. */
            const uint32_t step = (uint32_t)((uint64_t)i * 7919 % count);
            const uint32_t a = turn ? step + count : step, b = turn ? step : step + count;
            assert_int_equal(ffd_torn_edges_add(&torn, a, b, step + (turn ? 0.5 : 0), NULL), FFD_OK);
            assert_true(torn.count <= 2 * TORN_EDGES_MOST);
        }
    ffd_torn_edges_thin(&torn);
    assert_int_equal(torn.count, TORN_EDGES_MOST);
    for (uint32_t i = 0; i < torn.count; i++) {
        const uint32_t step = count - 1 - i;
        assert_true(fabs(torn.list[i].step - (step + 0.5)) < 1e-9);
        assert_int_equal(torn.list[i].ends[0], step + count);
        assert_int_equal(torn.list[i].ends[1], step);
    }
    ffd_free(torn.list);
    torn = (torn_edges){0};
    ffd_torn_edges_thin(&torn);
    assert_int_equal(torn.count, 0);
    (void)state;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(descriptions_that_are_not_complete), cmocka_unit_test(figures_are_those_of_a_check),
        cmocka_unit_test(what_is_written_is_recorded),        cmocka_unit_test(memory_ends_anywhere),
        cmocka_unit_test(the_largest_torn_edges_are_kept),
    };
    return cmocka_run_group_tests(tests, set_up, remove_folder);
}
