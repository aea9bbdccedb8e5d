/* test_journal.c - a batch's journal of its outputs, also after a kill at any moment. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/test_folder.h"
#include "base/memory/memory.h"
#include "batch/journal.h"
#include <sys/stat.h>
#include <time.h>

static job_record record_of(unsigned number)
{
    job_record record;
    record.inputs = ffd_hash(&number, sizeof number);
    record.outputs = ffd_hash(&record.inputs, sizeof record.inputs);
    return record;
}

static const hash128 *target_of(unsigned number)
{
    static hash128 target;
    target = ffd_hash(&number, sizeof number);
    return &target;
}

/* Figures of different lengths, some empty. */
static size_t figures_of(unsigned value, char text[100])
{
    const size_t size = value % 97;
    memset(text, 'a' + (int)(value % 26), size);
    return size;
}

static bool put_record(job_journal *journal, unsigned number, unsigned value)
{
    char text[100];
    const job_record record = record_of(value);
    const size_t size = figures_of(value, text);
    return ffd_journal_put(journal, target_of(number), &record, text, size);
}

static bool holds(job_journal *journal, unsigned number, unsigned value)
{
    char text[100];
    job_record found;
    byte_buffer figures = {0};
    const job_record expected = record_of(value);
    const size_t size = figures_of(value, text);
    const bool is_held = ffd_journal_find(journal, target_of(number), &found, &figures) &&
                         memcmp(&found, &expected, sizeof found) == 0 && figures.size == size &&
                         memcmp(figures.data, text, size) == 0;
    ffd_buffer_free(&figures);
    return is_held;
}

static job_journal *opened(const char *path)
{
    job_journal *journal;
    ffd_error error;
    if (ffd_journal_open(path, &journal, &error))
        fail_msg("%s", error.message);
    return journal;
}

/* More records than the first table holds, some of them stored twice. */
static void records_are_found_after_reopening(void **state)
{
    const unsigned count = 5000;
    job_journal *journal = opened(in_folder("reopened"));
    job_record record;
    assert_false(ffd_journal_find(journal, target_of(0), &record, NULL));
    for (unsigned i = 0; i < count; i++)
        assert_true(put_record(journal, i, i));
    for (unsigned i = 0; i < count; i += 3)
        assert_true(put_record(journal, i, i + count));
    for (int again = 0; again < 2; again++) {
        for (unsigned i = 0; i < count; i++)
            assert_true(holds(journal, i, i % 3 ? i : i + count));
        assert_false(ffd_journal_find(journal, target_of(count), &record, NULL));
        ffd_journal_close(&journal);
        journal = opened(in_folder("reopened"));
    }
    ffd_journal_close(&journal);
    (void)state;
}

/* Truncated anywhere, or with corrupt bytes: a record that is found is correct, or none is found. */
static void a_damaged_journal_never_gives_a_wrong_record(void **state)
{
    const unsigned count = 40, seed = (unsigned)time(NULL);
    static char bytes[1 << 17];
    print_message("seed %u\n", seed);
    srand(seed);
    job_journal *journal = opened(in_folder("damaged"));
    for (unsigned i = 0; i < count; i++)
        assert_true(put_record(journal, i, i));
    ffd_journal_close(&journal);
    FILE *file = fopen(in_folder("damaged"), "rb");
    assert_non_null(file);
    const size_t size = fread(bytes, 1, sizeof bytes, file);
    fclose(file);
    assert_true(size > 0 && size < sizeof bytes);
    for (int turn = 0; turn < 200; turn++) {
        static char changed[sizeof bytes];
        memcpy(changed, bytes, size);
        const size_t cut = turn % 2 ? size : (size_t)rand() % size;
        for (int i = 0; i < 200 && turn % 2; i++)
            changed[64 + (size_t)rand() % (size - 64)] ^= (char)(1 + rand() % 255);
        put("damaged", changed, cut);
        journal = opened(in_folder("damaged"));
        for (unsigned i = 0; i < count; i++) {
            job_record found;
            byte_buffer figures = {0};
            const job_record expected = record_of(i);
            if (ffd_journal_find(journal, target_of(i), &found, NULL))
                assert_memory_equal(&found, &expected, sizeof found);
            if (ffd_journal_find(journal, target_of(i), &found, &figures))
                assert_true(holds(journal, i, i));
            ffd_buffer_free(&figures);
            assert_true(put_record(journal, i, i));
            assert_true(holds(journal, i, i));
        }
        ffd_journal_close(&journal);
    }
    (void)state;
}

/* The table grows under a temporary name of its own. Existing files beside it, and targets of links, are not
   touched. */
static void growing_touches_no_other_file(void **state)
{
    put_text("grows.new", "precious");
    put_text("victim", "precious");
    assert_int_equal(symlink("victim", in_folder("kept.new")), 0);
    for (int k = 0; k < 2; k++) {
        job_journal *journal = opened(in_folder(k ? "kept" : "grows"));
        for (unsigned i = 0; i < 1500; i++)
            assert_true(put_record(journal, i, i));
        ffd_journal_close(&journal);
        char text[16] = "";
        FILE *const file = fopen(in_folder(k ? "victim" : "grows.new"), "rb");
        assert_non_null(file);
        assert_int_equal(fread(text, 1, sizeof text, file), 8);
        assert_string_equal(text, "precious");
        fclose(file);
    }
    (void)state;
}

static long size_of(const char *name)
{
    FILE *const file = fopen(in_folder(name), "rb");
    assert_non_null(file);
    assert_int_equal(fseek(file, 0, SEEK_END), 0);
    const long size = ftell(file);
    fclose(file);
    return size;
}

/* Figures that are stored again and again do not make the file grow for ever. */
static void a_journal_stays_in_bounds(void **state)
{
    static char text[1 << 18];
    job_journal *journal = opened(in_folder("again"));
    const job_record record = record_of(1), other = record_of(2);
    byte_buffer figures = {0};
    job_record found;
    memset(text, 'x', sizeof text);
    assert_true(ffd_journal_put(journal, target_of(2), &other, "other", 5));
    for (int i = 0; i < 200; i++) {
        text[0] = (char)i;
        assert_true(ffd_journal_put(journal, target_of(1), &record, text, sizeof text));
    }
    assert_true(size_of("again") < 20 << 20);
    for (int again = 0; again < 2; again++) {
        assert_true(ffd_journal_find(journal, target_of(1), &found, &figures));
        assert_int_equal(figures.size, sizeof text);
        assert_memory_equal(figures.data, text, sizeof text);
        assert_true(ffd_journal_find(journal, target_of(2), &found, &figures));
        assert_memory_equal(figures.data, "other", 5);
        ffd_journal_close(&journal);
        journal = opened(in_folder("again"));
    }
    ffd_buffer_free(&figures);
    ffd_journal_close(&journal);
    (void)state;
}

/* A journal of another version is useless, but is recognized as a journal. */
static void a_journal_of_another_version_is_replaced(void **state)
{
    static const char old[64] = "ffd-journal 1\n";
    put("old", old, sizeof old);
    job_journal *journal = opened(in_folder("old"));
    assert_true(put_record(journal, 3, 3));
    assert_true(holds(journal, 3, 3));
    ffd_journal_close(&journal);
    (void)state;
}

/* As a dry run and the workers of a batch read it. */
static void reading_a_journal_changes_nothing(void **state)
{
    static const char old[64] = "ffd-journal 1\n";
    job_journal *journal = opened(in_folder("read"));
    assert_true(put_record(journal, 3, 3));
    ffd_journal_close(&journal);
    assert_int_equal(ffd_journal_read(in_folder("read"), &journal, NULL), FFD_OK);
    assert_true(holds(journal, 3, 3));
    ffd_journal_close(&journal);
    put("of another version", old, sizeof old);
    put("cut short", old, 5);
    static const char *const others[] = {"of another version", "cut short"};
    for (size_t i = 0; i < 2; i++) {
        struct stat info;
        assert_int_equal(ffd_journal_read(in_folder(others[i]), &journal, NULL), FFD_OK);
        assert_null(journal);
        assert_int_equal(stat(in_folder(others[i]), &info), 0);
        assert_int_equal(info.st_size, i == 0 ? sizeof old : 5);
    }
    put_text("a letter", "Dear Sir or Madam,");
    assert_int_equal(ffd_journal_read(in_folder("a letter"), &journal, NULL), FFD_E_INVALID);
    assert_int_equal(ffd_journal_read(in_folder("missing"), &journal, NULL), FFD_E_IO);
    assert_null(journal);
    (void)state;
}

static void a_file_that_is_no_journal_is_refused(void **state)
{
    job_journal *journal;
    put_text("letter", "Dear Sir or Madam,");
    assert_int_equal(ffd_journal_open(in_folder("letter"), &journal, NULL), FFD_E_INVALID);
    assert_null(journal);
    assert_int_equal(ffd_journal_open(in_folder("letter/journal"), &journal, NULL), FFD_E_IO);
    assert_int_equal(ffd_journal_open(in_folder("no folder/journal"), &journal, NULL), FFD_E_IO);
    (void)state;
}

static void each_manifest_and_share_has_one_default_path(void **state)
{
    assert_int_equal(setenv("XDG_CACHE_HOME", folder, 1), 0);
    char *a = ffd_journal_default_path("jobs.jsonl", 0, 1), *b = ffd_journal_default_path("jobs.jsonl", 0, 2),
         *c = ffd_journal_default_path("./jobs.jsonl", 0, 1);
    assert_int_equal(strncmp(a, in_folder("ffd/batch-"), strlen(in_folder("ffd/batch-"))), 0);
    assert_string_not_equal(a, b);
    assert_string_equal(a, c);
    ffd_free(a);
    ffd_free(b);
    ffd_free(c);
    (void)state;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(records_are_found_after_reopening),
        cmocka_unit_test(a_damaged_journal_never_gives_a_wrong_record),
        cmocka_unit_test(growing_touches_no_other_file),
        cmocka_unit_test(a_journal_stays_in_bounds),
        cmocka_unit_test(a_journal_of_another_version_is_replaced),
        cmocka_unit_test(reading_a_journal_changes_nothing),
        cmocka_unit_test(a_file_that_is_no_journal_is_refused),
        cmocka_unit_test(each_manifest_and_share_has_one_default_path),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
