/* test_batch.c - ffd_batch_run (ffd/batch.h): what does not fit is refused in the words of C, and without the
   program, or with one of another build, there is no batch. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/test_folder.h"
#include <ffd/batch.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

static ffd_status no_jobs(void *user, uint64_t index, const char **line)
{
    (void)user;
    (void)index;
    *line = NULL;
    return FFD_OK;
}

static ffd_status one_job(void *user, uint64_t index, const char **line)
{
    *line = index == 0 ? user : NULL;
    return FFD_OK;
}

static ffd_batch_desc described(void)
{
    ffd_batch_desc desc;
    ffd_batch_desc_init(&desc, sizeof desc);
    return desc;
}

static void check_refused(const ffd_batch_desc *desc, const char *message)
{
    ffd_error error;
    ffd_batch_result result = {.struct_size = sizeof result};
    assert_int_equal(ffd_batch_desc_check(desc, &error), FFD_E_ARGUMENT);
    assert_string_equal(error.message, message);
    assert_int_equal(ffd_batch_run(desc, &result, &error), FFD_E_ARGUMENT);
    assert_string_equal(error.message, message);
    assert_false(result.is_complete);
}

static void what_does_not_fit_is_refused(void **state)
{
    static const ffd_lattice_source files[] = {{.path = "l"}, {.path = "k"}}, memory = {.text = {"{}", 2}};
    static const char *const names[] = {"a", NULL};
    ffd_deform_desc jobs;
    (void)state;
    ffd_batch_desc desc = described();
    check_refused(&desc, "needs manifest, or in, or csv");
    desc.manifest = "m";
    desc.next = no_jobs;
    check_refused(&desc, "manifest cannot be used with next");
    desc.next = NULL;
    desc.out_dir = "o";
    check_refused(&desc, "manifest cannot be used with in, csv, lattices, morphs or out_dir");
    desc.out_dir = NULL;
    desc.shard = desc.shards = 2;
    check_refused(&desc, "shard is not one of shards, counted from 0");
    desc.shard = 0;
    desc.timeout = -1;
    check_refused(&desc, "timeout is not a time");
    desc = described();
    ffd_deform_desc_init(&jobs, sizeof jobs);
    desc.defaults = &jobs;
    desc.in = "*.obj";
    check_refused(&desc, "in needs a lattice (lattices)");
    jobs.lattices = &memory;
    jobs.lattice_count = 1;
    check_refused(&desc, "lattices, embedding and weight of a batch are files: its processes read them");
    jobs.lattices = files;
    check_refused(&desc, "in needs out_dir, in_place or positions");
    jobs.lattice_count = 2;
    jobs.morphs = names;
    check_refused(&desc, "lattices cannot be used with morphs: each morphs names its own lattice");
    desc.struct_size = 0;
    assert_int_equal(ffd_batch_desc_check(&desc, NULL), FFD_E_ARGUMENT);
}

/* Runs a batch with these folders in PATH. */
static ffd_status run_with(const char *path, const ffd_batch_desc *desc, ffd_batch_result *result,
                           ffd_error *error)
{
    char kept[4096];
    snprintf(kept, sizeof kept, "%s", getenv("PATH"));
    assert_int_equal(setenv("PATH", path, 1), 0);
    const ffd_status status = ffd_batch_run(desc, result, error);
    assert_int_equal(setenv("PATH", kept, 1), 0);
    return status;
}

/* With a program that is no worker of this build in PATH. */
static void check_unsupported(const char *path, const char *part)
{
    char line[] = "{\"in\": \"a.obj\", \"lattice\": \"l\", \"out\": \"b.obj\"}";
    ffd_batch_desc desc = described();
    ffd_batch_result result = {.struct_size = sizeof result};
    ffd_error error;
    desc.next = one_job;
    desc.next_user = line;
    desc.journal = in_folder("journal");
    assert_int_equal(run_with(path, &desc, &result, &error), FFD_E_UNSUPPORTED);
    if (!strstr(error.message, part))
        fail_msg("\"%s\" is not in \"%s\"", part, error.message);
    assert_int_equal(ffd_status_exit_code(error.status), 6);
}

static void without_the_program_there_is_no_batch(void **state)
{
    (void)state;
    check_unsupported("/nowhere:relative", "\"ffd\"");
    put_text("ffd", "#!/bin/sh\nexit 2\n");
    assert_int_equal(chmod(in_folder("ffd"), 0755), 0);
    check_unsupported(folder, "is of another build than the library");
}

static void no_jobs_are_a_whole_batch_unless_it_is_cancelled(void **state)
{
    ffd_batch_desc desc = described();
    ffd_batch_result result = {.struct_size = sizeof result};
    (void)state;
    put_text("ffd", "#!/bin/sh\nexit 2\n");
    assert_int_equal(chmod(in_folder("ffd"), 0755), 0);
    desc.next = no_jobs;
    desc.journal = in_folder("journal");
    assert_int_equal(run_with(folder, &desc, &result, NULL), FFD_OK);
    assert_true(result.is_complete);
    assert_int_equal(result.done + result.skipped + result.failed, 0);
    const int cancel = 1;
    desc.cancel = &cancel;
    assert_int_equal(run_with(folder, &desc, &result, NULL), FFD_E_CANCELLED);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_does_not_fit_is_refused),
        cmocka_unit_test(without_the_program_there_is_no_batch),
        cmocka_unit_test(no_jobs_are_a_whole_batch_unless_it_is_cancelled),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
