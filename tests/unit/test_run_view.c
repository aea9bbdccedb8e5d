/* test_run_view.c - pictures of a batch: their names, whether they are up to date, and rows from report
   entries. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/test_folder.h"
#include "base/memory/memory.h"
#include "batch/index_entry.h"
#include "batch/job_picture.h"
#include "batch/run_view.h"
#include <fcntl.h>
#include <sys/stat.h>

static void expect_name(const char *out_dir, const char *output, const char *name)
{
    const run_view_desc desc = {.folder = "v", .out_dir = out_dir, .name = "m", .shards = 1, .dry = true};
    run_view *view;
    ffd_error error;
    hash128 files[2];
    char out[100];
    pool_task task = {.job = {.output = out}};
    snprintf(out, sizeof out, "%s", output);
    assert_int_equal(ffd_run_view_create(&desc, &view, &error), FFD_OK);
    assert_string_equal(ffd_run_view_page(view), "v/index.html");
    assert_int_equal(ffd_run_view_name(view, &task, files, &error), FFD_OK);
    assert_string_equal(task.picture_name, name);
    assert_memory_equal(task.picture, "v/", 2);
    assert_ptr_equal(task.picture + 2, task.picture_name);
    ffd_free(task.picture);
    ffd_run_view_destroy(&view);
    assert_null(view);
}

static void pictures_stay_below_the_folder(void **state)
{
    (void)state;
    expect_name(NULL, "a.obj", "a.obj.png");
    expect_name(NULL, "o/a.obj", "o/a.obj.png");
    expect_name(NULL, "./o//x/../a.obj", "o/a.obj.png");
    expect_name(NULL, "../../o/a.obj", "o/a.obj.png");
    expect_name(NULL, "/o/../../a.obj", "a.obj.png");
    expect_name(NULL, "..a/a.obj", "..a/a.obj.png");
    expect_name("out", "out/a.obj", "a.obj.png");
    expect_name("out//", "out/b/a.obj", "b/a.obj.png");
    expect_name("out", "outer/a.obj", "outer/a.obj.png");
    expect_name("out", "/out/a.obj", "out/a.obj.png");
}

static void shards_have_pages_of_their_own(void **state)
{
    (void)state;
    const run_view_desc desc = {.folder = "v", .name = "m", .shard = 2, .shards = 11, .dry = true};
    run_view *view;
    ffd_error error;
    assert_int_equal(ffd_run_view_create(&desc, &view, &error), FFD_OK);
    assert_string_equal(ffd_run_view_page(view), "v/index-2-of-11.html");
    ffd_run_view_destroy(&view);
}

static void set_time(const char *name, time_t seconds, long nanoseconds)
{
    const struct timespec times[] = {{seconds, nanoseconds}, {seconds, nanoseconds}};
    put(name, "x", 1);
    assert_int_equal(utimensat(AT_FDCWD, in_folder(name), times, 0), 0);
}

static void older_pictures_are_not_current(void **state)
{
    (void)state;
    char picture[200], output[200];
    snprintf(picture, sizeof picture, "%s", in_folder("p.png"));
    snprintf(output, sizeof output, "%s", in_folder("a.obj"));
    set_time("a.obj", 1000, 500);
    assert_false(ffd_job_picture_is_current(picture, output));
    set_time("p.png", 1000, 500);
    assert_true(ffd_job_picture_is_current(picture, output));
    set_time("p.png", 1000, 499);
    assert_false(ffd_job_picture_is_current(picture, output));
    set_time("p.png", 999, 900);
    assert_false(ffd_job_picture_is_current(picture, output));
    set_time("p.png", 1001, 0);
    assert_true(ffd_job_picture_is_current(picture, output));
}

static ffd_status read_entry(const char *json, index_entry *entry)
{
    ffd_error error;
    byte_buffer text = {0};
    ffd_buffer_text(&text, json);
    const ffd_status status = ffd_index_entry_read(&text, entry, &error);
    ffd_buffer_free(&text);
    return status;
}

static void entries_become_rows(void **state)
{
    (void)state;
    index_entry entry;
    assert_int_equal(
        read_entry("{\"input\": \"a\", \"output\": null, \"status\": \"failed\", \"error\": \"e\\u0041\", "
                   "\"vertices\": 3, "
                   "\"folds\": {\"verdict\": \"some\", \"min_det\": -2.5, \"folded_cells\": 4}, "
                   "\"flipped_faces\": 5, "
                   "\"tear\": {\"edges\": 6, \"largest\": 0.5}, \"displacement\": {\"max\": 1e3}}",
                   &entry),
        FFD_OK);
    assert_string_equal(entry.row.input, "a");
    assert_null(entry.row.output);
    assert_int_equal(entry.row.state, INDEX_FAILED);
    assert_string_equal(entry.row.error, "eA");
    const ffd_job_result *const read = entry.row.figures;
    assert_true(read->has_flipped && read->folds.is_known && read->tear.is_known);
    assert_int_equal(read->folds.verdict, FFD_FOLDS_SOME);
    assert_true(read->folds.min_det == -2.5 && read->folds.folded_cells == 4 && read->flipped_faces == 5);
    assert_true(read->tear.edges == 6 && read->tear.largest == 0.5 && read->displacement.max == 1000);
    ffd_index_entry_free(&entry);
}

static void figures_that_are_not_there_are_not_known(void **state)
{
    (void)state;
    static const char *const texts[] = {"{\"status\": \"ok\", \"vertices\": 3, \"folds\": null, \"tear\": "
                                        "null, \"flipped_faces\": null, \"displacement\": null}",
                                        /* Failed before it had figures. */
                                        "{\"status\": \"failed\", \"vertices\": 0, \"tear\": {\"edges\": 0, "
                                        "\"largest\": 0}, \"displacement\": {\"max\": 0}}",
                                        "{\"status\": \"ok\"}"};
    index_entry entry;
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        assert_int_equal(read_entry(texts[i], &entry), FFD_OK);
        const ffd_job_result *const read = entry.row.figures;
        assert_true((read == NULL) == (i > 0));
        assert_false(read && (read->has_flipped || read->folds.is_known || read->tear.is_known ||
                              isfinite(read->displacement.max)));
        ffd_index_entry_free(&entry);
    }
    assert_int_equal(read_entry("{\"status\": ", &entry), FFD_E_INVALID);
    ffd_index_entry_free(&entry);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pictures_stay_below_the_folder), cmocka_unit_test(shards_have_pages_of_their_own),
        cmocka_unit_test(older_pictures_are_not_current), cmocka_unit_test(entries_become_rows),
        cmocka_unit_test(figures_that_are_not_there_are_not_known)};
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
