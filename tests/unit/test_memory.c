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
#include <ffd/animate.h>
#include <ffd/fit.h>
#include <ffd/jacobian.h>
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

/* With values that have defaults too, and without: keys are looked for in both. */
static ffd_status run_animate(ffd_error *error)
{
    static const char keys[] =
        "{\"format\": \"ffd-lattice\", \"version\": 1, \"size\": [4, 4, 4], \"rest\": {\"box\": \"mesh\"}, "
        "\"parameters\": {\"A\": {\"default\": 1}, \"F\": {\"default\": [1, 2, 1]}}, \"moves\": ["
        "{\"twist\": {\"axis\": \"y\", \"degrees\": {\"$\": \"A\"}}}, {\"scale\": {\"factor\": {\"$\": "
        "\"F\"}}}], "
        "\"keys\": [{\"time\": 0, \"set\": {\"A\": 0}}, {\"time\": 0.05, \"set\": {\"A\": 30}}]}";
    ffd_deform_desc animated = describe();
    ffd_animate_desc desc;
    const ffd_lattice_source source = {.path = "k.json", .text = {keys, sizeof keys - 1}};
    ffd_animate_desc_init(&desc, sizeof desc);
    char written[PATH];
    path_of("animated.glb", written);
    animated.lattices = &source;
    animated.lattice_count = 1;
    animated.output = written;
    animated.output_format = FFD_FORMAT_AUTO;
    desc.job = &animated;
    const ffd_status status = ffd_animate_run(&desc, NULL, error);
    if (!status)
        unlink(written);
    return status;
}

static ffd_status run_check(ffd_error *error)
{
    ffd_deform_desc desc = describe();
    ffd_job_result result = {.struct_size = sizeof result};
    desc.outside = FFD_OUTSIDE_EXTEND;
    return ffd_check_run(&desc, &result, error);
}

/* Two squares, one of which leaves both lattices: a box, and a curved volume whose knots have to be
   clamped. */
static const char cut_mesh[] = "v -1 0.2 0.5\nv 0.5 0.2 0.5\nv 0.5 0.8 0.5\nv -1 0.8 0.5\nv 0.7 0.2 0.5\n"
                               "v 0.7 0.8 0.5\nf 1 2 3 4\nf 2 5 6 3\n";
static const char cut_box[] =
    "{\"format\": \"ffd-lattice\", \"version\": 1, \"size\": [3, 2, 2], \"rest\": {\"box\": "
    "{\"min\": [0, 0, 0], \"max\": [1, 1, 1]}}, \"moves\": [{\"by\": [0, 0, 0.125]}]}";
static const char cut_curve[] =
    "{\"format\": \"ffd-lattice\", \"version\": 1, \"size\": [3, 2, 2], \"degree\": [2, 1, 1], "
    "\"knots\": [\"open\", \"clamped\", \"clamped\"], \"weights\": [1, 2, 1, 1, 2, 1, 1, 2, 1, 1, 2, 1], "
    "\"rest\": {\"points\": [[-1, 0, 0], [0.5, 0, 0], [2, 0.25, 0], [-1, 1, 0], [0.5, 1, 0], [2, 1, 0], "
    "[-1, 0, 1], [0.5, 0, 1], [2, 0.25, 1], [-1, 1, 1], [0.5, 1, 1], [2, 1, 1]]}, "
    "\"moves\": [{\"by\": [0, 0, 0.125]}]}";

static ffd_deform_desc describe_cut(const ffd_lattice_source *lattices, size_t count)
{
    ffd_deform_desc desc;
    ffd_deform_desc_init(&desc, sizeof desc);
    desc.input.path = "m.obj";
    desc.input.bytes = (ffd_bytes){cut_mesh, sizeof cut_mesh - 1};
    desc.lattices = lattices;
    desc.lattice_count = count;
    desc.seam = FFD_SEAM_C0;
    desc.threads = 1;
    return desc;
}

static const ffd_lattice_source cut_lattices[] = {
    {.path = "b.json", .text = {cut_box, sizeof cut_box - 1}},
    {.path = "c.json", .text = {cut_curve, sizeof cut_curve - 1}},
};

/* One after the other, and side by side. */
static ffd_status run_seam(ffd_error *error)
{
    ffd_deform_desc desc = describe_cut(cut_lattices, 2);
    ffd_job_result result = {.struct_size = sizeof result};
    ffd_status status = ffd_check_run(&desc, &result, error);
    if (!status)
        assert_true(result.seam.faces[0] == 1 && result.seam.faces[1] == 1);
    desc.blocks = true;
    return status ? status : ffd_check_run(&desc, &result, error);
}

static ffd_status run_seam_of_one(ffd_error *error)
{
    const ffd_deform_desc desc = describe_cut(cut_lattices + 1, 1);
    ffd_job_result result = {.struct_size = sizeof result};
    return ffd_check_run(&desc, &result, error);
}

static ffd_status drop_output(void *user, const char *name, const void *bytes, size_t size)
{
    (void)user;
    (void)name;
    (void)bytes;
    (void)size;
    return FFD_OK;
}

static ffd_status run_jacobian(ffd_error *error)
{
    ffd_deform_desc cut = describe_cut(cut_lattices, 2);
    ffd_jacobian_desc desc;
    ffd_jacobian_desc_init(&desc, sizeof desc);
    cut.sink = drop_output;
    desc.job = &cut;
    desc.output = "j.npz";
    desc.check = true;
    return ffd_jacobian_run(&desc, NULL, error);
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
    ffd_author_desc desc;
    ffd_refine_result result = {.struct_size = sizeof result};
    ffd_author_desc_init(&desc, sizeof desc);
    desc.lattice = (ffd_lattice_source){.path = "l.json", .text = {box_text, sizeof box_text - 1}};
    desc.meshes = &source;
    desc.mesh_count = 1;
    desc.threads = 1;
    char written[PATH];
    path_of("finer.json", written);
    desc.output = written;
    const ffd_status status = ffd_lattice_refine_run(&desc, &finer, &result, error);
    if (!status)
        unlink(written);
    return status;
}

/* Places that are dragged, one exactly. */
static const char pairs_text[] = "px,py,pz,x,y,z,weight\n0.25,0.25,0.25,0.25,0.5,0.25,exact\n"
                                 "0.5,0.75,0.5,0.5,0.75,0.625,2\n0.75,0.5,0.25,0.75,0.5,0.25,1\n";

/* Runs a fit of a new box, with a report of its figures or without. */
static ffd_status fit_box(ffd_fit_job *fit, ffd_fit_job_result *result, ffd_error *error)
{
    ffd_lattice_desc box;
    ffd_author_desc desc;
    char written[PATH];
    ffd_lattice_desc_init(&box, sizeof box);
    ffd_author_desc_init(&desc, sizeof desc);
    path_of("fitted.json", written);
    desc.threads = 1;
    desc.output = written;
    fit->job = &desc;
    fit->lattice = &box;
    const ffd_status status = ffd_fit_run(fit, result, error);
    if (!status)
        unlink(written);
    return status;
}

static ffd_status run_fit(ffd_error *error)
{
    ffd_fit_job fit;
    ffd_fit_job_result result = {.struct_size = sizeof result};
    ffd_fit_job_init(&fit, sizeof fit);
    fit.pairs_bytes = (ffd_bytes){pairs_text, sizeof pairs_text - 1};
    return fit_box(&fit, &result, error);
}

static ffd_status run_fit_of_meshes(ffd_error *error)
{
    const ffd_source source = {.path = input};
    ffd_fit_job fit;
    ffd_fit_job_init(&fit, sizeof fit);
    fit.before = fit.after = fit.cover = &source;
    fit.cover_count = 1;
    fit.symmetric = 1;
    return fit_box(&fit, NULL, error);
}

/* A table of as many control points. */
static const char table_text[] = "i,j,k,x,y,z,dx,dy,dz\n"
                                 "0,0,0,0,0,0,0,0,0\n"
                                 "1,0,0,1,0,0,0,0.01,0\n"
                                 "0,1,0,0,1,0,0,0.01,0\n"
                                 "1,1,0,1,1,0,0,0.02,0\n"
                                 "0,2,0,0,2,0,0,0.02,0\n"
                                 "1,2,0,1,2,0,0,0.03,0\n"
                                 "0,0,1,0,0,1,0,0,0\n"
                                 "1,0,1,1,0,1,0,0.01,0\n"
                                 "0,1,1,0,1,1,0,0.01,0\n"
                                 "1,1,1,1,1,1,0,0.02,0\n"
                                 "0,2,1,0,2,1,0,0.02,0\n"
                                 "1,2,1,1,2,1,0,0.03,0\n";

static ffd_status run_lattice_set(ffd_error *error)
{
    const ffd_lattice_source box = {.path = "l.json", .text = {box_text, sizeof box_text - 1}};
    const ffd_lattice_source table = {.path = "l.csv", .text = {table_text, sizeof table_text - 1}};
    const ffd_operation operations[] = {{.kind = FFD_OPERATION_STRENGTH, .number = 0.5},
                                        {.kind = FFD_OPERATION_ADD, .other = box},
                                        {.kind = FFD_OPERATION_MIRROR, .direction = 1},
                                        {.kind = FFD_OPERATION_DEFORMED_OFFSETS, .other = table},
                                        {.kind = FFD_OPERATION_SEAL, .continuity = 0, .faces = 4},
                                        {.kind = FFD_OPERATION_ROTATE, .number = 30},
                                        {.kind = FFD_OPERATION_INVERT}};
    const ffd_source source = {.path = input};
    ffd_author_desc desc;
    ffd_author_desc_init(&desc, sizeof desc);
    desc.lattice = box;
    desc.meshes = &source;
    desc.mesh_count = 1;
    desc.threads = 1;
    char written[PATH];
    path_of("changed.json", written);
    desc.output = written;
    const ffd_status status =
        ffd_lattice_set_run(&desc, operations, sizeof operations / sizeof *operations, error);
    if (!status)
        unlink(written);
    return status;
}

/* An array of 27 points, whose order is looked for, as a table. */
static ffd_status run_lattice_convert(ffd_error *error)
{
    static const char head[] = "{'descr': '<f8', 'fortran_order': False, 'shape': (27, 3)}  \n";
    unsigned char bytes[10 + sizeof head - 1 + 27 * 3 * sizeof(double)] = "\x93NUMPY\1";
    ffd_convert_desc convert;
    ffd_author_desc desc;
    bytes[8] = sizeof head - 1;
    memcpy(bytes + 10, head, sizeof head - 1);
    for (int n = 0; n < 27; n++)
        memcpy(bytes + 10 + sizeof head - 1 + 24 * n, (double[]){n % 3, n / 3 % 3, n / 9}, 24);
    ffd_convert_desc_init(&convert, sizeof convert);
    convert.size[0] = convert.size[1] = convert.size[2] = 3;
    convert.order = FFD_ORDER_AUTO;
    ffd_author_desc_init(&desc, sizeof desc);
    desc.lattice = (ffd_lattice_source){.path = "l.npy", .text = {(const char *)bytes, sizeof bytes}};
    char written[PATH];
    path_of("written.csv", written);
    desc.output = written;
    const ffd_status status = ffd_lattice_convert_run(&desc, &convert, error);
    if (!status)
        unlink(written);
    return status;
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
    static job *const jobs[] = {run_deform,          run_convert,        run_check,
                                run_embed,           run_lattice_new,    run_fit,
                                run_fit_of_meshes,   run_lattice_refine, run_lattice_set,
                                run_lattice_convert, run_info,           run_compare};
    for (size_t i = 0; i < sizeof inputs / sizeof *inputs; i++) {
        take_input(inputs[i].format, inputs[i].name);
        for (size_t j = 0; j < sizeof jobs / sizeof *jobs; j++)
            assert_true(fail_everywhere(input, jobs[j], ffd_alloc_fail_after) > 2);
        unlink(input);
    }
    (void)state;
}

static void memory_of_volume_meshes(void **state)
{
    static const struct {
        const char *format, *name;
    } meshes[] = {
        {"vtk", "kinds"}, {"vtk", "polyhedra"}, {"vtu", "raw-zlib"}, {"su2", "plain"}, {"msh", "old-bytes"}};
    for (size_t i = 0; i < sizeof meshes / sizeof *meshes; i++) {
        take_input(meshes[i].format, meshes[i].name);
        assert_true(fail_everywhere(input, run_deform, ffd_alloc_fail_after) > 20);
        assert_true(fail_everywhere(input, run_check, ffd_alloc_fail_after) > 20);
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
        if (i < 4 || i == 5) { /* other formats allocate the same */
            assert_true(fail_everywhere(input, run_morphs, ffd_alloc_fail_after) > 60);
            assert_true(fail_everywhere(input, run_animate, ffd_alloc_fail_after) > 60);
        }
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

static void memory_of_held_faces(void **state)
{
    (void)state;
    assert_true(fail_everywhere("held faces", run_seam, ffd_alloc_fail_after) > 60);
    assert_true(fail_everywhere("held faces of one lattice", run_seam_of_one, ffd_alloc_fail_after) > 60);
    assert_true(fail_everywhere("derivatives", run_jacobian, ffd_alloc_fail_after) > 60);
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
        cmocka_unit_test(memory_of_ours),          cmocka_unit_test(memory_of_morph_targets),
        cmocka_unit_test(memory_of_cpp),           cmocka_unit_test(memory_of_lattice_files),
        cmocka_unit_test(memory_of_reports),       cmocka_unit_test(memory_of_held_faces),
        cmocka_unit_test(memory_of_volume_meshes),
    };
    if (argc != 2)
        return 2;
    corpus = argv[1];
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
