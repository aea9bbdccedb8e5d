/* test_job_source.c - jobs from manifests and tables: what they are, and refusals. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/test_folder.h"
#include "batch/manifest/job_source.h"
#include "batch/manifest/lines.h"
#include "batch/manifest/manifest.h"

static batch_job parsed(const batch_frame *frame, const char *text)
{
    batch_job job = {.line = 7};
    assert_int_equal(ffd_job_parse(frame, text, strlen(text), &job), FFD_OK);
    return job;
}

static batch_job made(const batch_frame *frame, const char *text)
{
    batch_job job = parsed(frame, text);
    if (job.error.status)
        fail_msg("%s: %s", text, job.error.message);
    return job;
}

static void check_paths(const batch_frame *frame, const char *text, const char *const paths[4])
{
    batch_job job = made(frame, text);
    assert_string_equal(job.desc.input.path, paths[0]);
    assert_string_equal(job.target, paths[1]);
    assert_int_equal(job.desc.lattice_count, paths[3] ? 2 : 1);
    for (size_t i = 0; i < job.desc.lattice_count; i++)
        assert_string_equal(job.desc.lattices[i].path, paths[2 + i]);
    ffd_job_free(&job);
}

static void a_job_becomes_a_description(void **state)
{
    const batch_frame frame = {.name = "m", .folder = "f"}, here = {.name = "m", .folder = ""};
    check_paths(&frame, "{\"in\": \"a.obj\", \"lattice\": \"l.json\", \"out\": \"o/b.obj\"}",
                (const char *const[4]){"f/a.obj", "f/o/b.obj", "f/l.json"});
    check_paths(&here, "{\"in\": \"-a.obj\", \"lattice\": [\"/l\", \"k\"], \"out\": \"b.obj\"}",
                (const char *const[4]){"./-a.obj", "b.obj", "/l", "k"});
    check_paths(&here, "{\"in\": \"a.obj\", \"lattice\": \"l\", \"options\": {\"in-place\": true}}",
                (const char *const[4]){"a.obj", "a.obj", "l"});
    batch_job job = made(
        &frame,
        "{\"in\": \"a.obj\", \"lattice\": \"l\", \"out\": \"b.obj\", \"options\": {\"falloff\": 0.1, "
        "\"outside\": \"extend\", \"only\": [\"group:a\", \"group:b\"], \"strict\": true, \"force\": false, "
        "\"embedding\": \"e.npy\", \"threads\": 2}, \"set\": {\"A\": [1, 0.5], \"B\": \"t\"}}");
    const ffd_deform_desc *const desc = &job.desc;
    assert_true(desc->falloff > 0.09 && desc->falloff < 0.11 && desc->outside == FFD_OUTSIDE_EXTEND);
    assert_int_equal(desc->only_count, 2);
    assert_string_equal(desc->only[1], "group:b");
    assert_true(desc->input.strict && !desc->force && desc->threads == 2);
    assert_string_equal(desc->embedding.path, "f/e.npy");
    assert_int_equal(desc->set_count, 2);
    assert_string_equal(desc->set[0].value, "[1,0.5]");
    assert_string_equal(desc->set[1].value, "\"t\"");
    ffd_job_free(&job);
    (void)state;
}

static hash128 content_of(const batch_frame *frame, const char *text)
{
    batch_job job = made(frame, text);
    const hash128 content = job.content;
    ffd_job_free(&job);
    return content;
}

/* As the journal asks: is the output of this job that of another one? */
static void content_is_what_can_change_the_output(void **state)
{
    const batch_frame frame = {.name = "m", .folder = "f"}, other = {.name = "n", .folder = "g"};
#define OPTIONS(options)                                                                                     \
    "{\"in\": \"a.obj\", \"lattice\": \"l\", \"out\": \"b.obj\", \"options\": {" options "}}"
    const hash128 plain = content_of(&frame, OPTIONS(""));
    static const char *const same[] = {
        OPTIONS("\"threads\": 2, \"force\": true, \"isa\": \"scalar\", \"memory\": \"4G\""),
        OPTIONS("\"if-changed\": true, \"normals\": \"transform\""),
    };
    static const char *const others[] = {OPTIONS("\"normals\": \"keep\""),
                                         OPTIONS("\"embedding\": \"e\""),
                                         OPTIONS("\"fail-on\": \"tear\""),
                                         OPTIONS("\"fail-on\": \"tear=0.5\""),
                                         "{\"in\": \"a.obj\", \"lattice\": \"l\", \"out\": \"c.obj\"}",
                                         "{\"in\": \"c.obj\", \"lattice\": \"l\", \"out\": \"b.obj\"}"};
    for (size_t i = 0; i < sizeof same / sizeof *same; i++) {
        const hash128 content = content_of(&other, same[i]);
        assert_memory_equal(&content, &plain, sizeof plain);
    }
    hash128 last = plain;
    for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
        const hash128 content = content_of(&frame, others[i]);
        assert_memory_not_equal(&content, &plain, sizeof plain);
        assert_memory_not_equal(&content, &last, sizeof plain);
        last = content;
    }
    (void)state;
}

/* A job's own options replace those of the batch. */
static void a_jobs_own_options_replace_the_batchs(void **state)
{
    static const ffd_setting set[] = {{"A", "1"}, {"B", "2"}};
    static const char *const only[] = {"group:a"};
    const ffd_deform_desc defaults = {.struct_size = sizeof defaults,
                                      .normals = FFD_NORMALS_KEEP,
                                      .force = true,
                                      .set = set,
                                      .set_count = 2,
                                      .only = only,
                                      .only_count = 1};
    const batch_frame frame = {.name = "m", .folder = "", .defaults = &defaults};
    batch_job job = made(&frame, "{\"in\": \"a.obj\", \"lattice\": \"l\", \"out\": \"b.obj\"}");
    assert_true(job.desc.normals == FFD_NORMALS_KEEP && job.desc.force);
    assert_int_equal(job.desc.set_count, 2);
    assert_string_equal(job.desc.only[0], "group:a");
    ffd_job_free(&job);
    job =
        made(&frame, "{\"in\": \"a.obj\", \"lattice\": \"l\", \"out\": \"b.obj\", \"options\": {\"normals\": "
                     "\"recompute\", \"force\": false, \"only\": \"group:b\"}, \"set\": {\"B\": 3}}");
    assert_true(job.desc.normals == FFD_NORMALS_RECOMPUTE && !job.desc.force);
    assert_int_equal(job.desc.set_count, 2);
    assert_string_equal(job.desc.set[0].value, "1");
    assert_string_equal(job.desc.set[1].value, "3");
    assert_int_equal(job.desc.only_count, 1);
    assert_string_equal(job.desc.only[0], "group:b");
    ffd_job_free(&job);
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
        {OPTIONS("\"normal\": 1"), "unknown option normal (nearest: normals)"},
        {OPTIONS("\"strict\": 1"), "input.strict takes no value: true or false is wanted"},
        {OPTIONS("\"snap\": true"), "snap needs a value"},
        {OPTIONS("\"falloff\": 1"), "falloff needs outside = extend"},
        {"{\"in\": \"a.xyz\", \"lattice\": \"l\", \"out\": \"b\"}",
         "a.xyz: the ending \".xyz\" is not that of a mesh format (obj, gltf, glb, vrm, ply, off, stl, vtk, "
         "su2, vtu, vtp, vts, msh or foam, whose file is called points)"},
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

#define JOB(in) "{\"in\": \"" in ".obj\", \"lattice\": \"l\", \"out\": \"o.obj\"}"

static void shards_share_out_the_lines_of_a_manifest(void **state)
{
    put_text("m.jsonl", "\xef\xbb\xbf" JOB("a") "\n\n \t\r\n" JOB("b") "\r\nnothing\n" JOB("c"));
    const char *const path = in_folder("m.jsonl");
    assert_string_equal(listed(&(job_source_desc){.manifest = path, .shards = 1}),
                        "1 a.obj, 4 b.obj, 5 ?, 6 c.obj");
    assert_string_equal(listed(&(job_source_desc){.manifest = path, .shards = 3}), "1 a.obj, 6 c.obj");
    assert_string_equal(listed(&(job_source_desc){.manifest = path, .shard = 1, .shards = 3}), "4 b.obj");
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
                        "1 ?, 2 z.obj");
    (void)state;
}

static void rows_of_a_table_become_jobs(void **state)
{
    put_text(
        "t.csv",
        "in,out,A,\"B \"\"2\"\"\"\na.obj,o1,1,x\n\n\"b.obj\",o2,\"[1,\n2]\",\"y,z\"\nc,o3,1\nd\"e,o,1,2\n");
    static const ffd_lattice_source lattices[] = {{.path = "l.json"}};
    const ffd_deform_desc defaults = {
        .struct_size = sizeof defaults, .lattices = lattices, .lattice_count = 1};
    job_source_desc desc = {
        .table = in_folder("t.csv"), .defaults = &defaults, .out_dir = "dir", .shards = 1};
    job_source *source;
    batch_job job;
    line_state more;
    char expected[1000];
    assert_int_equal(ffd_jobs_open(&desc, &source, NULL), FFD_OK);
    static const char *const values[][2] = {{"1", "\"x\""}, {"[1,2]", "\"y,z\""}};
    static const int lines[] = {2, 4, 6, 7};
    for (int i = 0; i < 4; i++) {
        assert_int_equal(ffd_jobs_next(source, &job, &more, NULL), FFD_OK);
        assert_int_equal(more, LINE_READ);
        assert_int_equal(job.line, lines[i]);
        if (i < 2) {
            snprintf(expected, sizeof expected, "%s/%c.obj", folder, "ab"[i]);
            assert_string_equal(job.desc.input.path, expected);
            snprintf(expected, sizeof expected, "dir/o%d", i + 1);
            assert_string_equal(job.desc.output, expected);
            assert_string_equal(job.desc.lattices[0].path, "l.json");
            assert_string_equal(job.desc.set[0].name, "A");
            assert_string_equal(job.desc.set[0].value, values[i][0]);
            assert_string_equal(job.desc.set[1].name, "B \"2\"");
            assert_string_equal(job.desc.set[1].value, values[i][1]);
        } else {
            assert_string_equal(job.error.message, i == 2 ? "the row has 3 cells, but the table has 4 columns"
                                                          : "not a valid CSV row: a quote stands beside "
                                                            "other characters of its cell");
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
    const ffd_deform_desc defaults = {
        .struct_size = sizeof defaults, .lattices = lattices, .lattice_count = 1};
    put_text("g2.obj", "");
    put_text("g1.obj", "");
    job_source_desc desc = {
        .pattern = in_folder("g*.obj"), .defaults = &defaults, .out_dir = "dir", .shards = 1};
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
    const ffd_deform_desc budget = {.struct_size = sizeof budget,
                                    .input = {.format = FFD_FORMAT_OBJ, .memory = 400000000}},
                          plain = {.struct_size = sizeof plain, .input = {.format = FFD_FORMAT_OBJ}};
    const batch_frame frame = {.name = "m", .folder = folder, .defaults = &plain},
                      given = {.name = "m", .folder = folder, .defaults = &budget};
    memset(blanks, ' ', sizeof blanks);
    put("3MB", blanks, sizeof blanks);
    put("1MB", blanks, 1000000);
    put("1MB.obj", blanks, 1000000);
    put("it's=", blanks, 2000000);
    check_memory(&frame, "{\"in\": \"none\", \"lattice\": \"none\", \"out\": \"b.obj\"}", false, 100);
    check_memory(&frame, "{\"in\": \"3MB\", \"lattice\": \"none\", \"out\": \"1MB.obj\"}", false, 160);
    check_memory(&frame, "{\"in\": \"3MB\", \"lattice\": [\"1MB\", \"1MB\", \"it's=\"], \"out\": \"b.obj\"}",
                 false, 240);
    check_memory(&frame,
                 "{\"in\": \"1MB\", \"morph\": {\"a\": \"3MB\", \"it's='\": \"it's=\", \"''\": \"1MB\"}, "
                 "\"out\": \"b.obj\"}",
                 false, 240);
    check_memory(&frame, "{\"in\": \"3MB\", \"lattice\": \"none\", \"out\": \"b.obj\"}", true, 400);
#define WITH(size)                                                                                           \
    "{\"in\": \"3MB\", \"lattice\": \"none\", \"out\": \"b.obj\", \"options\": {\"memory\": " size "}}"
    check_memory(&frame, WITH("\"2G\""), false, 2000);
    check_memory(&frame, WITH("\"2G\""), true, 2000);
    check_memory(&frame, WITH("\"20M\""), false, 160);
    check_memory(&given, WITH("500000000"), false, 500);
    check_memory(&given, "{\"in\": \"3MB\", \"lattice\": \"none\", \"out\": \"b.obj\"}", false, 400);
    (void)state;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_job_becomes_a_description),
        cmocka_unit_test(content_is_what_can_change_the_output),
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
