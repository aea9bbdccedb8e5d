/* test_positions_callback.c - the callback for deformed positions: its arguments, when it is called, and the
   effect of its return value. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include <ffd/ffd.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

/* The second vertex is outside of the lattice; the third has a number that float32 would round. */
static const char mesh[] = "v 0 0 0\nv 9 9 9\nv 0.1 1 0.5\nf 1 2 3\n";
static const char lattice[] = "{\"format\":\"ffd-lattice\",\"version\":1,\"size\":[2,2,2],\"rest\":{"
                              "\"box\":{\"min\":[-1,-1,-1],\"max\":[2,2,2]}},\"moves\":[{\"by\":[0,0.5,1]}]}";
static const double expected[] = {0, 0.5, 1, 9, 9, 9, 0.1, 1.5, 1.5};

typedef struct taker {
    size_t calls, count, files; /* files: received by the sink at the last call */
    double points[9];
    ffd_status with; /* the return value */
} taker;

static ffd_status take(void *user, const double *positions, size_t count)
{
    taker *const t = user;
    t->calls++;
    t->count = count;
    if (count == 3)
        memcpy(t->points, positions, sizeof t->points);
    return t->with;
}

static ffd_status take_file(void *user, const char *name, const void *bytes, size_t size)
{
    taker *const t = user;
    assert_non_null(name);
    assert_true(bytes && size > 0);
    t->files++;
    return t->calls == 1 ? FFD_OK : FFD_E_ARGUMENT; /* positions come first */
}

typedef struct job {
    ffd_deform_desc desc;
    ffd_job_result result;
    ffd_error error;
    ffd_lattice_source lattice;
    taker taker;
} job;

static void begin(job *j)
{
    memset(j, 0, sizeof *j);
    ffd_deform_desc_init(&j->desc, sizeof j->desc);
    j->result.struct_size = sizeof j->result;
    j->lattice = (ffd_lattice_source){.path = "l.json", .text = {lattice, strlen(lattice)}};
    j->desc.input.path = "a.obj";
    j->desc.input.bytes = (ffd_bytes){mesh, strlen(mesh)};
    j->desc.lattices = &j->lattice;
    j->desc.lattice_count = 1;
    j->desc.positions = take;
    j->desc.positions_user = &j->taker;
}

static void check_taken(const taker *t)
{
    assert_int_equal(t->calls, 1);
    assert_int_equal(t->count, 3);
    for (int i = 0; i < 9; i++)
        assert_true(fabs(t->points[i] - expected[i]) < 1e-14);
}

static void no_output_is_needed(void **state)
{
    job j;
    begin(&j);
    assert_int_equal(ffd_deform_run(&j.desc, &j.result, &j.error), FFD_OK);
    check_taken(&j.taker);
    assert_int_equal(j.result.moved, 2);
    begin(&j);
    j.desc.dry_run = true;
    assert_int_equal(ffd_deform_run(&j.desc, &j.result, &j.error), FFD_OK);
    check_taken(&j.taker);
    begin(&j);
    j.desc.sink = take_file; /* receives nothing */
    j.desc.sink_user = &j.taker;
    assert_int_equal(ffd_deform_run(&j.desc, &j.result, &j.error), FFD_OK);
    check_taken(&j.taker);
    assert_int_equal(j.taker.files, 0);
    begin(&j);
    assert_int_equal(ffd_check_run(&j.desc, &j.result, &j.error), FFD_OK);
    check_taken(&j.taker);
    begin(&j);
    j.desc.quality = true;
    assert_int_equal(ffd_deform_run(&j.desc, &j.result, &j.error), FFD_OK);
    check_taken(&j.taker);
    (void)state;
}

static void they_come_before_the_output(void **state)
{
    job j;
    begin(&j);
    j.desc.output = "b.obj";
    j.desc.sink = take_file;
    j.desc.sink_user = &j.taker;
    assert_int_equal(ffd_deform_run(&j.desc, &j.result, &j.error), FFD_OK);
    check_taken(&j.taker);
    assert_int_equal(j.taker.files, 1);
    (void)state;
}

static void a_gate_comes_first(void **state)
{
    job j;
    begin(&j);
    j.desc.fail_on = FFD_GATE_OUTSIDE;
    assert_int_equal(ffd_deform_run(&j.desc, &j.result, &j.error), FFD_E_GATE);
    assert_int_equal(j.taker.calls, 0);
    (void)state;
}

/* The job has the callback's status; a value that is not an ffd_status becomes FFD_E_IO. Nothing is
   written. */
static void what_is_not_taken_fails(void **state)
{
    const int answers[][2] = {{FFD_E_GATE, FFD_E_GATE},
                              {FFD_E_LIMIT, FFD_E_LIMIT},
                              {FFD_E_MEMORY, FFD_E_MEMORY},
                              {FFD_E_EXISTS, FFD_E_EXISTS},
                              {1, FFD_E_IO},
                              {4711, FFD_E_IO}};
    for (size_t i = 0; i < sizeof answers / sizeof *answers; i++) {
        job j;
        begin(&j);
        j.desc.output = "b.obj";
        j.desc.sink = take_file;
        j.desc.sink_user = &j.taker;
        j.taker.with = (ffd_status)answers[i][0];
        assert_int_equal(ffd_deform_run(&j.desc, &j.result, &j.error), answers[i][1]);
        assert_int_equal(j.result.status, answers[i][1]);
        assert_int_equal(j.error.status, answers[i][1]);
        assert_non_null(strstr(j.error.message, "the callback for positions did not take them"));
        check_taken(&j.taker);
        assert_int_equal(j.taker.files, 0);
    }
    (void)state;
}

static void what_needs_an_output_is_refused(void **state)
{
    const char *const morph = "M";
    job j;
    begin(&j);
    j.desc.as_morph = morph;
    assert_int_equal(ffd_deform_run(&j.desc, &j.result, &j.error), FFD_E_ARGUMENT);
    begin(&j);
    j.desc.output_format = FFD_FORMAT_PLY;
    assert_int_equal(ffd_deform_run(&j.desc, &j.result, &j.error), FFD_E_ARGUMENT);
    begin(&j);
    j.desc.morphs = &morph;
    j.desc.output = "b.glb";
    assert_int_equal(ffd_deform_run(&j.desc, &j.result, &j.error), FFD_E_ARGUMENT);
    assert_int_equal(j.taker.calls, 0);
    begin(&j);
    j.desc.positions = NULL;
    assert_int_equal(ffd_deform_run(&j.desc, &j.result, &j.error), FFD_E_ARGUMENT);
    assert_non_null(strstr(j.error.message, "no output is given"));
    /* A caller of an older version lacks these members. */
    begin(&j);
    j.desc.struct_size = offsetof(ffd_deform_desc, positions);
    assert_int_equal(ffd_deform_run(&j.desc, &j.result, &j.error), FFD_E_ARGUMENT);
    assert_int_equal(j.taker.calls, 0);
    (void)state;
}

/* Also called for a mesh without vertices. */
static void many_jobs_in_a_row(void **state)
{
    ffd_job_cache *cache;
    assert_int_equal(ffd_job_cache_create(&cache, NULL), FFD_OK);
    for (int i = 0; i < 4; i++) {
        job j;
        begin(&j);
        j.desc.cache = cache;
        j.desc.quality = i == 2;
        assert_int_equal(ffd_deform_run(&j.desc, &j.result, &j.error), FFD_OK);
        check_taken(&j.taker);
    }
    ffd_job_cache_destroy(&cache);
    job j;
    begin(&j);
    j.desc.input.path = "a.off";
    j.desc.input.bytes = (ffd_bytes){"OFF\n0 0 0\n", 10};
    assert_int_equal(ffd_deform_run(&j.desc, &j.result, &j.error), FFD_OK);
    assert_int_equal(j.taker.calls, 1); /* also for the mesh without vertices */
    assert_int_equal(j.taker.count, 0);
    (void)state;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_output_is_needed),
        cmocka_unit_test(they_come_before_the_output),
        cmocka_unit_test(a_gate_comes_first),
        cmocka_unit_test(what_is_not_taken_fails),
        cmocka_unit_test(what_needs_an_output_is_refused),
        cmocka_unit_test(many_jobs_in_a_row),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
