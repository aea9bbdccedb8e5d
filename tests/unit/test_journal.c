/* test_journal.c - what a batch remembers of its outputs, also after it was ended at any moment. */
#define _XOPEN_SOURCE 700 /* mkdtemp */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/test_folder.h"
#include "base/memory/memory.h"
#include "batch/journal.h"
#include <time.h>

static job_record record_of(unsigned number)
{
    job_record record;
    record.inputs = ffd_hash(&number, sizeof number);
    record.outputs = ffd_hash(&record.inputs, sizeof record.inputs);
    return record;
}

static const char *target_of(unsigned number)
{
    static char name[64];
    snprintf(name, sizeof name, "somewhere/o%u.obj", number);
    return name;
}

static bool holds(job_journal *journal, unsigned number, unsigned value)
{
    job_record found;
    const job_record expected = record_of(value);
    return ffd_journal_find(journal, target_of(number), &found) &&
           memcmp(&found, &expected, sizeof found) == 0;
}

static job_journal *opened(const char *path)
{
    job_journal *journal;
    ffd_error error;
    if (ffd_journal_open(path, &journal, &error))
        fail_msg("%s", error.message);
    return journal;
}

/* More than the first table has room for, some of them twice. */
static void records_are_found_after_reopening(void **state)
{
    const unsigned count = 5000;
    job_journal *journal = opened(in_folder("made/too/journal"));
    job_record record;
    assert_false(ffd_journal_find(journal, target_of(0), &record));
    for (unsigned i = 0; i < count; i++) {
        record = record_of(i);
        assert_true(ffd_journal_put(journal, target_of(i), &record));
    }
    for (unsigned i = 0; i < count; i += 3) {
        record = record_of(i + count);
        assert_true(ffd_journal_put(journal, target_of(i), &record));
    }
    for (int again = 0; again < 2; again++) {
        for (unsigned i = 0; i < count; i++)
            assert_true(holds(journal, i, i % 3 ? i : i + count));
        assert_false(ffd_journal_find(journal, target_of(count), &record));
        ffd_journal_close(&journal);
        journal = opened(in_folder("made/too/journal"));
    }
    ffd_journal_close(&journal);
    (void)state;
}

/* Cut off anywhere, or with bytes that are not what was written: what is found is right, or nothing is. */
static void a_damaged_journal_never_gives_a_wrong_record(void **state)
{
    const unsigned count = 40, seed = (unsigned)time(NULL);
    static char bytes[1 << 17];
    print_message("seed %u\n", seed);
    srand(seed);
    job_journal *journal = opened(in_folder("damaged"));
    for (unsigned i = 0; i < count; i++) {
        const job_record record = record_of(i);
        assert_true(ffd_journal_put(journal, target_of(i), &record));
    }
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
            const job_record expected = record_of(i);
            if (ffd_journal_find(journal, target_of(i), &found))
                assert_memory_equal(&found, &expected, sizeof found);
            assert_true(ffd_journal_put(journal, target_of(i), &expected));
            assert_true(holds(journal, i, i));
        }
        ffd_journal_close(&journal);
    }
    (void)state;
}

static void a_file_that_is_no_journal_is_refused(void **state)
{
    job_journal *journal;
    put_text("letter", "Dear Sir or Madam,");
    assert_int_equal(ffd_journal_open(in_folder("letter"), &journal, NULL), FFD_E_INVALID);
    assert_null(journal);
    assert_int_equal(ffd_journal_open(in_folder("letter/journal"), &journal, NULL), FFD_E_IO);
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
        cmocka_unit_test(a_file_that_is_no_journal_is_refused),
        cmocka_unit_test(each_manifest_and_share_has_one_default_path),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
