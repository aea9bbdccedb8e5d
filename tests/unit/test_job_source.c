/* test_job_source.c - jobs from manifests and tables: their words, and refusals. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/test_folder.h"
#include "batch/manifest/job_memory.h"
#include "batch/manifest/job_source.h"
#include "batch/manifest/lines.h"
#include "batch/manifest/manifest.h"

/* Joins the words of a list with bars. */
static const char *joined(const byte_buffer *words)
{
    static char text[1000];
    assert_true(words->size < sizeof text);
    memcpy(text, words->data, words->size);
    for (size_t i = 0; i + 1 < words->size; i++)
        text[i] = text[i] ? text[i] : '|';
    text[words->size] = 0;
    return text;
}

static batch_job parsed(const batch_frame *frame, const char *text)
{
    batch_job job = {.line = 7};
    assert_int_equal(ffd_job_parse(frame, text, strlen(text), &job), FFD_OK);
    return job;
}

static void check_words(const batch_frame *frame, const char *text, const char *words, const char *content)
{
    batch_job job = parsed(frame, text);
    if (job.error.status)
        fail_msg("%s: %s", text, job.error.message);
    assert_string_equal(joined(&job.words), words);
    assert_string_equal(joined(&job.content), content);
    size_t count = 0;
    for (size_t i = 0; i < job.words.size; i++)
        count += job.words.data[i] == 0;
    assert_int_equal(job.word_count, count);
    ffd_job_free(&job);
}

static void a_job_becomes_words_and_content(void **state)
{
    const batch_frame frame = {.name = "m", .folder = "f"}, here = {.name = "m", .folder = ""};
    check_words(&frame, "{\"in\": \"a.obj\", \"lattice\": \"l.json\", \"out\": \"o/b.obj\"}",
                "f/a.obj|f/o/b.obj|--lattice=f/l.json", "a.obj|o/b.obj");
    check_words(&here, "{\"in\": \"-a.obj\", \"lattice\": [\"/l\", \"k\"], \"out\": \"b.obj\"}",
                "./-a.obj|b.obj|--lattice=/l|--lattice=k", "-a.obj|b.obj");
    check_words(
        &frame,
        "{\"in\": \"a\", \"lattice\": \"l\", \"out\": \"b\", \"options\": {\"falloff\": 0.1, \"x\": 12, "
        "\"only\": [\"node:a\", \"node:b\"], \"yes\": true, \"no\": false, \"embedding\": \"e.npy\", "
        "\"threads\": 2}, \"set\": {\"A\": [1, 0.5], \"B\": \"t\"}}",
        "f/a|f/b|--lattice=f/l|--falloff=0.1|--x=12|--only=node:a|--only=node:b|--yes|"
        "--embedding=f/e.npy|--threads=2|--set=A=[1,0.5]|--set=B=\"t\"",
        "a|b|--falloff=0.1|--x=12|--only=node:a|--only=node:b|--yes|--embedding=e.npy|"
        "--set=A=[1,0.5]|--set=B=\"t\"");
    check_words(&here, "{\"in\": \"a\", \"lattice\": \"l\", \"options\": {\"in-place\": true}}",
                "a|--lattice=l|--in-place", "a||--in-place");
    (void)state;
}

/* A job's own options replace those of the batch. */
static void a_jobs_own_options_replace_the_batchs(void **state)
{
    static const batch_default defaults[] = {
        {"normals", "keep"}, {"force", NULL}, {"set", "A=1"}, {"set", "B=2"}};
    const batch_frame frame = {.name = "m", .folder = "", .defaults = defaults, .default_count = 4};
    check_words(&frame, "{\"in\": \"a\", \"lattice\": \"l\", \"out\": \"b\"}",
                "a|b|--lattice=l|--normals=keep|--force|--set=A=1|--set=B=2",
                "a|b|--normals=keep|--set=A=1|--set=B=2");
    check_words(
        &frame,
        "{\"in\": \"a\", \"lattice\": \"l\", \"out\": \"b\", \"options\": {\"normals\": \"recompute\", "
        "\"force\": false}, \"set\": {\"B\": 3}}",
        "a|b|--lattice=l|--set=A=1|--normals=recompute|--set=B=3",
        "a|b|--set=A=1|--normals=recompute|--set=B=3");
    (void)state;
}

static void broken_jobs_are_refused(void **state)
{
    static const struct {
        const char *text, *says;
    } cases[] = {
        {"[]", "a job is an object: {\"in\": ..., \"lattice\": ..., \"out\": ...}"},
        {"{\"lattice\": \"l\", \"out\": \"b\"}", "\"in\" is missing"},
        {"{\"in\": 1, \"lattice\": \"l\", \"out\": \"b\"}", "\"in\" is not the name of a file"},
        {"{\"in\": \"\", \"lattice\": \"l\", \"out\": \"b\"}", "\"in\" is empty"},
        {"{\"in\": \"-\", \"lattice\": \"l\", \"out\": \"b\"}",
         "\"in\" is \"-\": jobs of a batch have no standard streams"},
        {"{\"in\": \"a\", \"out\": \"b\"}", "\"lattice\" is missing"},
        {"{\"in\": \"a\", \"lattice\": [], \"out\": \"b\"}", "\"lattice\" is an empty list"},
        {"{\"in\": \"a\", \"lattice\": [\"l\", 2], \"out\": \"b\"}", "\"lattice\" is not the name of a file"},
        {"{\"in\": \"a\", \"lattice\": \"l\"}", "\"out\" is missing"},
        {"{\"in\": \"a\", \"lattice\": \"l\", \"out\": \"b\", \"option\": {}}",
         "unknown key \"option\" (nearest: \"options\")"},
        {"{\"in\": \"a\", \"lattice\": \"l\", \"out\": \"b\", \"options\": []}",
         "\"options\" is not an object"},
        {"{\"in\": \"a\", \"lattice\": \"l\", \"out\": \"b\", \"options\": {\"report\": \"r\"}}",
         "\"report\" is not an option of a job"},
        {"{\"in\": \"a\", \"lattice\": \"l\", \"out\": \"b\", \"options\": {\"falloff\": null}}",
         "option \"falloff\" must be a string, a number, true, false or a list of strings and numbers"},
        {"{\"in\": \"a\", \"lattice\": \"l\", \"out\": \"b\", \"set\": 1}", "\"set\" is not an object"},
    };
    const batch_frame frame = {.name = "m", .folder = ""};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        batch_job job = parsed(&frame, cases[i].text);
        assert_int_equal(job.error.status, FFD_E_INVALID);
        assert_string_equal(job.error.message, cases[i].says);
        assert_string_equal(job.error.file, "m");
        assert_int_equal(job.error.line, 7);
        ffd_job_free(&job);
    }
    (void)state;
}

/* Line numbers and inputs of all jobs: "1 a, 3 b". Refused jobs have no input. */
static const char *listed(const job_source_desc *desc)
{
    static char text[1000];
    job_source *source;
    batch_job job;
    line_state more;
    ffd_error error;
    if (ffd_jobs_open(desc, &source, &error))
        fail_msg("%s", error.message);
    *text = 0;
    for (;;) {
        assert_int_equal(ffd_jobs_next(source, &job, &more, &error), FFD_OK);
        if (more != LINE_READ)
            break;
        const size_t length = strlen(text);
        snprintf(text + length, sizeof text - length, "%s%d %s", length ? ", " : "", (int)job.line,
                 job.error.status ? "?" : job.input);
        ffd_job_free(&job);
    }
    assert_true(ffd_jobs_fraction(source) >= 1);
    ffd_jobs_close(&source);
    return text;
}

#define JOB(in) "{\"in\": \"" in "\", \"lattice\": \"l\", \"out\": \"o\"}"

static void shards_share_out_the_lines_of_a_manifest(void **state)
{
    put_text("m.jsonl", "\xef\xbb\xbf" JOB("a") "\n\n \t\r\n" JOB("b") "\r\nnothing\n" JOB("c"));
    const char *const path = in_folder("m.jsonl");
    assert_string_equal(listed(&(job_source_desc){.manifest = path, .shards = 1}), "1 a, 4 b, 5 ?, 6 c");
    assert_string_equal(listed(&(job_source_desc){.manifest = path, .shards = 3}), "1 a, 6 c");
    assert_string_equal(listed(&(job_source_desc){.manifest = path, .shard = 1, .shards = 3}), "4 b");
    assert_string_equal(listed(&(job_source_desc){.manifest = path, .shard = 2, .shards = 3}), "5 ?");
    assert_string_equal(listed(&(job_source_desc){.manifest = path, .shard = 4, .shards = 9}), "");
    put_text("m.jsonl", "");
    job_source *source;
    assert_int_equal(
        ffd_jobs_open(&(job_source_desc){.manifest = in_folder("no"), .shards = 1}, &source, NULL), FFD_E_IO);
    (void)state;
}

/* An endless line takes no more memory than the limit. */
static void a_line_too_long_is_refused_and_skipped(void **state)
{
    const size_t size = LINE_MOST + 100;
    char *text = malloc(size);
    assert_non_null(text);
    memset(text, 'x', size);
    memcpy(text + size - 60, "\n" JOB("z"), sizeof JOB("z"));
    put("long.jsonl", text, size - 60 + sizeof JOB("z"));
    free(text);
    assert_string_equal(listed(&(job_source_desc){.manifest = in_folder("long.jsonl"), .shards = 1}),
                        "1 ?, 2 z");
    (void)state;
}

static void rows_of_a_table_become_jobs(void **state)
{
    put_text("t.csv",
             "in,out,A,\"B \"\"2\"\"\"\na,o1,1,x\n\n\"b\",o2,\"[1,\n2]\",\"y,z\"\nc,o3,1\nd\"e,o,1,2\n");
    static const ffd_lattice_source lattices[] = {{.path = "l.json"}};
    job_source_desc desc = {
        .table = in_folder("t.csv"), .lattices = lattices, .lattice_count = 1, .out_dir = "dir", .shards = 1};
    job_source *source;
    batch_job job;
    line_state more;
    char expected[1000];
    assert_int_equal(ffd_jobs_open(&desc, &source, NULL), FFD_OK);
    static const char *const settings[] = {"--set=A=1|--set=B \"2\"=\"x\"",
                                           "--set=A=[1,2]|--set=B \"2\"=\"y,z\""};
    static const int lines[] = {2, 4, 6, 7};
    for (int i = 0; i < 4; i++) {
        assert_int_equal(ffd_jobs_next(source, &job, &more, NULL), FFD_OK);
        assert_int_equal(more, LINE_READ);
        assert_int_equal(job.line, lines[i]);
        if (i < 2) {
            snprintf(expected, sizeof expected, "%s/%c|dir/o%d|--lattice=l.json|%s", folder, "ab"[i], i + 1,
                     settings[i]);
            assert_string_equal(joined(&job.words), expected);
        } else {
            assert_string_equal(job.error.message, i == 2 ? "the row has 3 cells, but the table has 4 columns"
                                                          : "not a valid CSV row");
        }
        ffd_job_free(&job);
    }
    assert_int_equal(ffd_jobs_next(source, &job, &more, NULL), FFD_OK);
    assert_int_equal(more, LINE_NONE);
    ffd_jobs_close(&source);
    put_text("empty.csv", "\n");
    assert_int_equal(
        ffd_jobs_open(&(job_source_desc){.table = in_folder("empty.csv"), .shards = 1}, &source, NULL),
        FFD_E_INVALID);
    (void)state;
}

static void files_of_a_pattern_come_sorted(void **state)
{
    static const ffd_lattice_source lattices[] = {{.path = "l.json"}};
    put_text("g2.obj", "");
    put_text("g1.obj", "");
    job_source_desc desc = {.pattern = in_folder("g*.obj"),
                            .lattices = lattices,
                            .lattice_count = 1,
                            .out_dir = "dir",
                            .shards = 1};
    char expected[500];
    snprintf(expected, sizeof expected, "1 %s/g1.obj, 2 %s/g2.obj", folder, folder);
    assert_string_equal(listed(&desc), expected);
    job_source *source;
    desc.pattern = in_folder("nothing*");
    assert_int_equal(ffd_jobs_open(&desc, &source, NULL), FFD_E_IO);
    (void)state;
}

static void check_memory(const batch_frame *frame, const char *text, bool draws, unsigned megabytes)
{
    batch_job job = parsed(frame, text);
    assert_int_equal(job.error.status, FFD_OK);
    assert_int_equal(ffd_job_memory(&job, draws), 1000000ull * megabytes);
    ffd_job_free(&job);
}

/* By the sizes of its mesh and of all its lattices. */
static void a_job_may_take_the_budget_of_its_files(void **state)
{
    static char blanks[3000000];
    const batch_default budget = {"memory", "400M"};
    const batch_frame frame = {.name = "m", .folder = folder},
                      given = {.name = "m", .folder = folder, .defaults = &budget, .default_count = 1};
    memset(blanks, ' ', sizeof blanks);
    put("3MB", blanks, sizeof blanks);
    put("1MB", blanks, 1000000);
    put("it's=", blanks, 2000000);
    check_memory(&frame, "{\"in\": \"none\", \"lattice\": \"none\", \"out\": \"b\"}", false, 100);
    check_memory(&frame, "{\"in\": \"3MB\", \"lattice\": \"none\", \"out\": \"1MB\"}", false, 160);
    check_memory(&frame, "{\"in\": \"3MB\", \"lattice\": [\"1MB\", \"1MB\", \"it's=\"], \"out\": \"b\"}",
                 false, 240);
    check_memory(&frame,
                 "{\"in\": \"1MB\", \"morph\": {\"a\": \"3MB\", \"it's='\": \"it's=\", \"''\": \"1MB\"}, "
                 "\"out\": \"b\"}",
                 false, 240);
    check_memory(&frame, "{\"in\": \"3MB\", \"lattice\": \"none\", \"out\": \"b\"}", true, 400);
#define WITH(size)                                                                                           \
    "{\"in\": \"3MB\", \"lattice\": \"none\", \"out\": \"b\", \"options\": {\"memory\": " size "}}"
    check_memory(&frame, WITH("\"2G\""), false, 2000);
    check_memory(&frame, WITH("\"2G\""), true, 2000);
    check_memory(&frame, WITH("\"20M\""), false, 160);
    check_memory(&frame, WITH("\"much\""), false, 160);
    check_memory(&given, WITH("500000000"), false, 500);
    check_memory(&given, "{\"in\": \"3MB\", \"lattice\": \"none\", \"out\": \"b\"}", false, 400);
    (void)state;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_job_becomes_words_and_content),
        cmocka_unit_test(a_jobs_own_options_replace_the_batchs),
        cmocka_unit_test(broken_jobs_are_refused),
        cmocka_unit_test(shards_share_out_the_lines_of_a_manifest),
        cmocka_unit_test(a_line_too_long_is_refused_and_skipped),
        cmocka_unit_test(rows_of_a_table_become_jobs),
        cmocka_unit_test(files_of_a_pattern_come_sorted),
        cmocka_unit_test(a_job_may_take_the_budget_of_its_files),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
