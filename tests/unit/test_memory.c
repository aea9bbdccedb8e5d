/* test_memory.c - memory that runs out at any allocation, in every job and every format: in ffd_alloc, and in
   C++'s operator new. Each failure is reported as such and leaves no file. The leak sanitizer checks for
   leaks.

       test_memory CORPUS      the folder tests/fuzz/corpus */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/failing_new.h"
#include "../support/job_description.h"
#include "../support/repetitions.h"
#include "../support/test_folder.h"
#include "base/file/input.h"
#include "base/memory/memory.h"
#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Up to this allocation every failure is tried, then ever fewer. */
#define FIRST_FAILURES 64

enum { PATH = 128 };

static const char *corpus;
static char lattice[PATH], input[PATH], output[PATH], array[PATH], comparison_file[PATH];

typedef ffd_status job(ffd_error *error);

static void path_of(const char *name, char path[PATH])
{
    assert_true(snprintf(path, PATH, "%s/%s", folder, name) < PATH);
}

static size_t count_files(void)
{
    size_t count = 0;
    DIR *open = opendir(folder);
    assert_non_null(open);
    while (readdir(open))
        count++;
    closedir(open);
    return count;
}

static ffd_deform_desc describe(void)
{
    static const ffd_lattice_source lattices[] = {{.path = lattice}};
    ffd_deform_desc desc = describe_job(input, output, lattices);
    desc.force = false; /* so that the next job notices a file left by a failure */
    return desc;
}

static ffd_status run_deform(ffd_error *error)
{
    const ffd_deform_desc desc = describe();
    ffd_job_result result = {.struct_size = sizeof result};
    return ffd_deform_run(&desc, &result, error);
}

/* Converts to another format. */
static ffd_status run_convert(ffd_error *error)
{
    ffd_deform_desc desc = describe();
    ffd_job_result result = {.struct_size = sizeof result};
    char converted[PATH];
    path_of("converted", converted);
    desc.output = converted;
    desc.output_format = strstr(input, ".glb") ? FFD_FORMAT_PLY : FFD_FORMAT_GLB;
    const ffd_status status = ffd_deform_run(&desc, &result, error);
    if (!status)
        unlink(converted);
    return status;
}

static ffd_status run_as_morph(ffd_error *error)
{
    ffd_deform_desc desc = describe();
    ffd_job_result result = {.struct_size = sizeof result};
    desc.as_morph = "bent";
    desc.output_format = FFD_FORMAT_GLB;
    return ffd_deform_run(&desc, &result, error);
}

static ffd_status run_morphs(ffd_error *error)
{
    ffd_deform_desc desc = describe();
    ffd_job_result result = {.struct_size = sizeof result};
    const ffd_lattice_source lattices[] = {{.path = lattice}, {.path = lattice}};
    const char *const names[] = {"bent", "again"};
    const char *const clips[] = {"a: 0 bent=1, 1", "b: 1 again=1"};
    desc.lattices = lattices;
    desc.lattice_count = 2;
    desc.morphs = names;
    desc.clips = clips;
    desc.clip_count = 2;
    desc.output_format = FFD_FORMAT_GLB;
    return ffd_deform_run(&desc, &result, error);
}

static ffd_status run_check(ffd_error *error)
{
    ffd_deform_desc desc = describe();
    ffd_job_result result = {.struct_size = sizeof result};
    desc.outside = FFD_OUTSIDE_EXTEND;
    return ffd_check_run(&desc, &result, error);
}

static ffd_status run_embed(ffd_error *error)
{
    ffd_embed_desc desc;
    ffd_job_result result = {.struct_size = sizeof result};
    ffd_embed_desc_init(&desc, sizeof desc);
    desc.input.path = input;
    desc.lattice.path = lattice;
    desc.output = array;
    desc.threads = 1;
    return ffd_embed_run(&desc, &result, error);
}

static ffd_status run_lattice_new(ffd_error *error)
{
    const ffd_source source = {.path = input};
    ffd_lattice_desc desc;
    ffd_lattice_desc_init(&desc, sizeof desc);
    desc.principal = true;
    ffd_lattice_new_desc made;
    ffd_lattice_new_desc_init(&made, sizeof made);
    made.meshes = &source;
    made.mesh_count = 1;
    made.lattice = &desc;
    made.output = output;
    return ffd_lattice_new_run(&made, error);
}

/* A lattice in memory whose box goes round the mesh. */
static const char box_text[] =
    "{\"format\": \"ffd-lattice\", \"version\": 1, \"size\": [2, 3, 2], \"rest\": {\"box\": "
    "\"mesh\"}, \"moves\": [{\"at\": [1, 1, 1], \"by\": [0.01, 0, 0]}]}";

static ffd_status run_lattice_refine(ffd_error *error)
{
    const ffd_source source = {.path = input};
    ffd_refine_desc finer;
    ffd_refine_desc_init(&finer, sizeof finer);
    finer.size[0] = finer.degree[1] = 3;
    ffd_lattice_refine_desc desc;
    ffd_lattice_refine_desc_init(&desc, sizeof desc);
    desc.lattice = (ffd_lattice_source){.path = "l.json", .text = {box_text, sizeof box_text - 1}};
    desc.meshes = &source;
    desc.mesh_count = 1;
    desc.refine = &finer;
    desc.measure = true;
    desc.threads = 1;
    desc.output = array; /* any name that is not a mesh's */
    return ffd_lattice_refine_run(&desc, NULL, error);
}

static ffd_status run_lattice_set(ffd_error *error)
{
    const ffd_lattice_source box = {.path = "l.json", .text = {box_text, sizeof box_text - 1}};
    const ffd_operation operations[] = {{.kind = FFD_OPERATION_STRENGTH, .number = 0.5},
                                        {.kind = FFD_OPERATION_ADD, .other = box},
                                        {.kind = FFD_OPERATION_MIRROR, .direction = 1},
                                        {.kind = FFD_OPERATION_ROTATE, .number = 30},
                                        {.kind = FFD_OPERATION_INVERT}};
    const ffd_source source = {.path = input};
    ffd_lattice_set_desc desc;
    ffd_lattice_set_desc_init(&desc, sizeof desc);
    desc.lattice = box;
    desc.meshes = &source;
    desc.mesh_count = 1;
    desc.operations = operations;
    desc.operation_count = sizeof operations / sizeof *operations;
    desc.threads = 1;
    desc.output = array;
    return ffd_lattice_set_run(&desc, error);
}

static ffd_status run_info(ffd_error *error)
{
    ffd_info_desc desc;
    char *text = NULL;
    ffd_info_desc_init(&desc, sizeof desc);
    desc.file.path = input;
    desc.parts = true;
    const ffd_status status = ffd_info_run(&desc, &text, error);
    assert_true((status == FFD_OK) == (text != NULL));
    ffd_free(text);
    return status;
}

static ffd_status run_compare(ffd_error *error)
{
    ffd_compare_desc desc;
    ffd_comparison comparison = {.struct_size = sizeof comparison};
    char *text = NULL;
    ffd_compare_desc_init(&desc, sizeof desc);
    desc.a.path = desc.b.path = input;
    desc.relative = true;
    ffd_status status = ffd_compare_run(&desc, &comparison, error);
    if (status == FFD_OK)
        status = ffd_comparison_json(&comparison, input, input, &text, error);
    assert_true((status == FFD_OK) == (text != NULL));
    ffd_free(text);
    return status;
}

static ffd_status run_report_merge(ffd_error *error)
{
    static const char *const reports[] = {input, input};
    return ffd_report_merge_run(reports, 2, true, output, false, error);
}

static ffd_status run_report_junit(ffd_error *error)
{
    static const char *const reports[] = {input, comparison_file};
    return ffd_report_junit_run(reports, 2, output, false, error);
}

static void cpp_fail_after(long successes)
{
    new_fail_after(successes);
}

/* Returns the number of failures. */
static size_t fail_everywhere(const char *name, job *run, void (*fail_after)(long))
{
    const size_t files = count_files();
    size_t failures = 0;
    for (long successes = 0;; successes += 1 + (successes > FIRST_FAILURES ? successes / 8 : 0)) {
        ffd_error error = {0};
        fail_after(successes);
        const ffd_status status = run(&error);
        fail_after(-1);
        if (status == FFD_OK)
            break;
        failures++;
        if (status != FFD_E_MEMORY || !strstr(error.message, "out of memory"))
            fail_msg("%s, failure after %ld: status %d, %s", name, successes, status, error.message);
        if (count_files() != files)
            fail_msg("%s, failure after %ld: a file is left", name, successes);
    }
    unlink(output);
    unlink(array);
    return failures;
}

/* Copies a file of the corpus to the folder. Bytes after a .gltf's text go to m.bin. */
static void take_input(const char *format, const char *name)
{
    char path[512], own[32];
    file_input file;
    ffd_error error;
    snprintf(path, sizeof path, "%s/%s/%s", corpus, format, name);
    if (ffd_file_load(path, &file, &error))
        fail_msg("%s: %s", path, error.message);
    const unsigned char *end = memchr(file.data, 0, file.size);
    const size_t size = strcmp(format, "gltf") == 0 && end ? (size_t)(end - file.data) : file.size;
    snprintf(own, sizeof own, "m.%s", format);
    path_of(own, input);
    put(own, file.data, size);
    if (size < file.size)
        put("m.bin", end + 1, file.size - size - 1);
    ffd_file_unload(&file);
    snprintf(own, sizeof own, "o.%s", format);
    path_of(own, output);
    path_of("u.npy", array);
}

static const struct {
    const char *format, *name;
} inputs[] = {{"obj", "normals"}, {"obj", "many-normals"}, {"ply", "ascii"}, {"ply", "big"},
              {"off", "normals"}, {"gltf", "data"},        {"glb", "plain"}, {"glb", "tangents"},
              {"glb", "sparse"},  {"glb", "quantized"},    {"glb", "nodes"}, {"glb", "morphs"},
              {"glb", "skin"},    {"stl", "bytes"},        {"stl", "text"}};

static void memory_of_ours(void **state)
{
    static job *const jobs[] = {run_deform,         run_convert,     run_check, run_embed,  run_lattice_new,
                                run_lattice_refine, run_lattice_set, run_info,  run_compare};
    for (size_t i = 0; i < sizeof inputs / sizeof *inputs; i++) {
        take_input(inputs[i].format, inputs[i].name);
        for (size_t j = 0; j < sizeof jobs / sizeof *jobs; j++)
            assert_true(fail_everywhere(input, jobs[j], ffd_alloc_fail_after) > 2);
        unlink(input);
    }
    (void)state;
}

static void memory_of_morph_targets(void **state)
{
    static const struct {
        const char *format, *name;
    } models[] = {{"glb", "plain"}, {"glb", "skin"},    {"glb", "morphs"}, {"glb", "nodes"},
                  {"stl", "text"},  {"obj", "normals"}, {"ply", "ascii"}};
    for (size_t i = 0; i < sizeof models / sizeof *models; i++) {
        take_input(models[i].format, models[i].name);
        assert_true(fail_everywhere(input, run_as_morph, ffd_alloc_fail_after) > 30);
        fail_everywhere(input, run_as_morph, cpp_fail_after);
        if (i < 4 || i == 5) /* other formats allocate the same */
            assert_true(fail_everywhere(input, run_morphs, ffd_alloc_fail_after) > 60);
        unlink(input);
    }
    (void)state;
}

/* Failures in all C++ code: for glTF and for topology. */
static void memory_of_cpp(void **state)
{
    /* Valgrind is loaded before the program and replaces our operator new. */
    if (is_under_valgrind())
        skip();
    size_t failures = 0;
    for (size_t i = 0; i < sizeof inputs / sizeof *inputs; i++) {
        take_input(inputs[i].format, inputs[i].name);
        failures += fail_everywhere(input, run_deform, cpp_fail_after);
        failures += fail_everywhere(input, run_check, cpp_fail_after);
        failures += fail_everywhere(input, run_info, cpp_fail_after);
        unlink(input);
    }
    assert_true(failures > 100);
    (void)state;
}

/* Also placeholders: for numbers, an object, and a text that is not JSON. */
static ffd_status run_lattice_load(ffd_error *error)
{
    static const ffd_setting values[] = {
        {"N", "0.5"}, {"T", "{\"axis\": \"x\", \"degrees\": 9}"}, {"A", "all"}};
    bool used[3] = {false};
    ffd_lattice *loaded;
    const ffd_status status = ffd_lattice_load_set(input, values, 3, used, &loaded, error);
    assert_true((status == FFD_OK) == (loaded != NULL));
    if (!status)
        assert_true(used[0] && used[1] && used[2]);
    ffd_lattice_destroy(&loaded);
    return status;
}

static void memory_of_lattice_files(void **state)
{
    path_of("p.json", input);
    put_text("p.json",
             "{\"format\": \"ffd-lattice\", \"version\": 1, \"size\": [2, 3, 4], \"degree\": [1, 2, 3], "
             "\"rest\": {\"box\": {\"min\": [0, 0, 0], \"max\": [1, 1, 1], \"spacing\": \"greville\"}}, "
             "\"moves\": [{\"at\": [{\"$\": \"A\"}, 0, 0], \"by\": [0, {\"$\": \"N\"}, {\"$\": \"N\"}]}, "
             "{\"twist\": {\"$\": \"T\"}}]}");
    assert_true(fail_everywhere(input, run_lattice_load, ffd_alloc_fail_after) > 20);
    unlink(input);
    (void)state;
}

static void memory_of_reports(void **state)
{
    path_of("r.json", input);
    path_of("o.json", output);
    put_text("r.json",
             "{\"format\": \"ffd-report\", \"version\": 1, \"jobs\": [{\"input\": \"a\", \"output\": null, "
             "\"status\": \"ok\", \"exit\": 0, \"error\": null}]}");
    assert_true(fail_everywhere(input, run_report_merge, ffd_alloc_fail_after) > 3);
    put_text("r.json",
             "{\"format\": \"ffd-report\", \"version\": 1, \"jobs\": [{\"input\": \"a\", \"output\": \"b\", "
             "\"status\": \"skipped\", \"exit\": 0, \"error\": \"none\"}]}");
    path_of("c.json", comparison_file);
    put_text("c.json",
             "{\"format\": \"ffd-comparison\", \"version\": 1, \"a\": \"A\", \"b\": \"B\", \"files\": ["
             "{\"name\": \"n\", \"equal\": false, \"error\": \"e\"}, "
             "{\"name\": \"n\", \"equal\": false, \"error\": null, \"first\": {\"message\": \"m\"}}], "
             "\"only_a\": [\"s\"], \"only_b\": []}");
    assert_true(fail_everywhere(input, run_report_junit, ffd_alloc_fail_after) > 12);
    unlink(comparison_file);
    unlink(input);
    (void)state;
}

static int set_up(void **state)
{
    static const char text[] =
        "{\"format\": \"ffd-lattice\", \"version\": 1, \"size\": [4, 4, 4], \"rest\": {\"box\": \"mesh\"}, "
        "\"moves\": [{\"at\": [1, 1, 1], \"by\": [0, 0, 0.25]}]}";
    if (make_folder(state))
        return -1;
    path_of("l.json", lattice);
    put_text("l.json", text);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    return remove_files((const char *const[]){in_folder("m.bin"), lattice}, 2);
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(memory_of_ours),    cmocka_unit_test(memory_of_morph_targets),
        cmocka_unit_test(memory_of_cpp),     cmocka_unit_test(memory_of_lattice_files),
        cmocka_unit_test(memory_of_reports),
    };
    if (argc != 2)
        return 2;
    corpus = argv[1];
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
