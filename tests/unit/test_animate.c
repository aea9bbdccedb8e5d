/* ffd_animate_run in memory: the right answers of a reference case, read back from the GLB; refusals; every
   allocation made to fail. Argument: a file of tests/cli/authoring. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "../support/message.h"
#include "base/file/input.h"
#include "base/little_endian.h"
#include "base/memory/memory.h"
#include "json/json_parse.h"
#include <ffd/animate.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *case_file;

/* A GLB, and its JSON. */
typedef struct glb {
    unsigned char *bytes;
    size_t size, bin;
    json_tree tree;
} glb;

static ffd_status keep(void *user, const char *name, const void *bytes, size_t size)
{
    glb *const to = user;
    assert_string_equal(name, "o.glb");
    to->bytes = malloc(size);
    to->size = size;
    memcpy(to->bytes, bytes, size);
    return FFD_OK;
}

static double number_of(const json_tree *tree, uint32_t value)
{
    double number = NAN;
    assert_true(ffd_json_tree_number(tree, value, &number));
    return number;
}

static uint32_t find(const json_tree *tree, uint32_t from, const char *key)
{
    const uint32_t found = ffd_json_tree_member(tree, from, key);
    assert_true(found != JSON_NONE);
    return found;
}

static void open_glb(glb *file)
{
    const size_t size = load_u32(file->bytes + 12);
    const json_input input = {.text = (const char *)file->bytes + 20, .size = size, .name = "o.glb"};
    assert_int_equal(ffd_json_parse(&input, &file->tree, NULL), FFD_OK);
    file->bin = 28 + size;
}

/* Returns a number of an accessor of floats. */
static double element(const glb *file, uint32_t accessor_index, size_t i)
{
    const json_tree *const tree = &file->tree;
    const size_t number = (size_t)number_of(tree, accessor_index);
    const uint32_t accessor = ffd_json_tree_element(tree, find(tree, 0, "accessors"), number);
    const size_t view_number = (size_t)number_of(tree, find(tree, accessor, "bufferView"));
    const uint32_t view = ffd_json_tree_element(tree, find(tree, 0, "bufferViews"), view_number);
    const uint32_t offsets[] = {ffd_json_tree_member(tree, accessor, "byteOffset"),
                                ffd_json_tree_member(tree, view, "byteOffset")};
    size_t at = file->bin + 4 * i;
    for (int k = 0; k < 2; k++)
        at += offsets[k] == JSON_NONE ? 0 : (size_t)number_of(tree, offsets[k]);
    const uint32_t bits = load_u32(file->bytes + at);
    float value;
    memcpy(&value, &bits, sizeof value);
    return (double)value;
}

static ffd_animate_desc describe(ffd_deform_desc *job, ffd_lattice_source *lattice, const char *mesh,
                                 const char *text, size_t size, glb *out)
{
    ffd_animate_desc desc;
    ffd_deform_desc_init(job, sizeof *job);
    *lattice = (ffd_lattice_source){.path = "k.json", .text = {text, size}};
    job->input.path = "m.obj";
    job->input.bytes = (ffd_bytes){mesh, strlen(mesh)};
    job->lattices = lattice;
    job->lattice_count = 1;
    job->output = "o.glb";
    job->sink = keep;
    job->sink_user = out;
    ffd_animate_desc_init(&desc, sizeof desc);
    desc.job = job;
    return desc;
}

/* Writes points as an OBJ of points. */
static void write_points(const json_tree *tree, uint32_t array, char *text, size_t capacity)
{
    size_t count = 0;
    *text = 0;
    for (uint32_t p = ffd_json_tree_first(tree, array); p != JSON_NONE;
         p = ffd_json_tree_after(tree, p), count++)
        snprintf(text + strlen(text), capacity - strlen(text), "v %.17g %.17g %.17g\n",
                 number_of(tree, ffd_json_tree_element(tree, p, 0)),
                 number_of(tree, ffd_json_tree_element(tree, p, 1)),
                 number_of(tree, ffd_json_tree_element(tree, p, 2)));
    for (size_t i = 0; i < count; i++)
        snprintf(text + strlen(text), capacity - strlen(text), "p %zu\n", i + 1);
}

/* Plays the animation at a time. */
static void check_frame(const glb *file, const json_tree *tree, uint32_t frame, size_t keys, size_t targets,
                        double tolerance)
{
    const uint32_t meshes = find(&file->tree, 0, "meshes"), animations = find(&file->tree, 0, "animations");
    const uint32_t primitives =
        find(&file->tree, ffd_json_tree_element(&file->tree, meshes, 0), "primitives");
    const uint32_t primitive = ffd_json_tree_element(&file->tree, primitives, 0);
    const uint32_t samplers =
        find(&file->tree, ffd_json_tree_element(&file->tree, animations, 0), "samplers");
    const uint32_t sampler = ffd_json_tree_element(&file->tree, samplers, 0);
    const uint32_t input = find(&file->tree, sampler, "input"), output = find(&file->tree, sampler, "output");
    const uint32_t base = find(&file->tree, find(&file->tree, primitive, "attributes"), "POSITION");
    const uint32_t shapes = find(&file->tree, primitive, "targets"), points = find(tree, frame, "points");
    const double time = number_of(tree, find(tree, frame, "time"));
    size_t k = 0;
    while (k + 2 < keys && time >= element(file, input, k + 1))
        k++;
    const double from = element(file, input, k), to = element(file, input, k + 1);
    const double part = time <= from ? 0 : time >= to ? 1 : (time - from) / (to - from);
    for (size_t i = 0; i < ffd_json_tree_count(tree, points); i++)
        for (size_t c = 0; c < 3; c++) {
            double place = element(file, base, 3 * i + c);
            for (size_t t = 0; t < targets; t++) {
                const double w = (1 - part) * element(file, output, targets * k + t) +
                                 part * element(file, output, targets * (k + 1) + t);
                const uint32_t target = ffd_json_tree_element(&file->tree, shapes, t);
                if (i == 0 && c == 0)
                    assert_true(
                        fabs(w - number_of(tree, ffd_json_tree_element(tree, find(tree, frame, "weights"),
                                                                       t))) <= tolerance);
                place += w * element(file, find(&file->tree, target, "POSITION"), 3 * i + c);
            }
            const uint32_t right = ffd_json_tree_element(tree, points, i);
            assert_true(fabs(place - number_of(tree, ffd_json_tree_element(tree, right, c))) <= tolerance);
        }
}

static void the_right_answers_of_a_reference_case(void **state)
{
    (void)state;
    static char mesh[4000];
    file_input input;
    json_tree tree;
    glb out = {0};
    ffd_deform_desc job;
    ffd_lattice_source lattice;
    ffd_animate_result result = {.struct_size = sizeof result};
    ffd_error error = {0};
    assert_int_equal(ffd_file_load(case_file, &input, NULL), FFD_OK);
    const json_input text = {.text = (const char *)input.data, .size = input.size, .name = case_file};
    assert_int_equal(ffd_json_parse(&text, &tree, NULL), FFD_OK);
    char *const file = ffd_json_tree_text(&tree, find(&tree, 0, "lattice"));
    write_points(&tree, find(&tree, 0, "before"), mesh, sizeof mesh);
    ffd_animate_desc desc = describe(&job, &lattice, mesh, file, strlen(file), &out);
    desc.targets = FFD_TARGETS_KEYS;
    desc.name = "wave";
    if (ffd_animate_run(&desc, &result, &error))
        fail_msg("%s", message_of(&error));
    const uint32_t expect = find(&tree, 0, "expect");
    const size_t targets = (size_t)number_of(&tree, find(&tree, expect, "targets"));
    assert_int_equal(result.targets, targets);
    assert_int_equal(result.keys, 4);
    assert_int_equal(result.vertices, 8);
    assert_string_equal(result.name, "wave");
    assert_true(result.bound >= 0 && result.bound <= 0 && result.largest_weight > 0.9);
    open_glb(&out);
    const uint32_t frames = find(&tree, expect, "frames");
    const double tolerance = number_of(&tree, find(&tree, expect, "tolerance"));
    for (uint32_t f = ffd_json_tree_first(&tree, frames); f != JSON_NONE; f = ffd_json_tree_after(&tree, f))
        check_frame(&out, &tree, f, 4, targets, tolerance);
    ffd_json_tree_free(&out.tree);
    free(out.bytes);
    ffd_free(file);
    ffd_json_tree_free(&tree);
    ffd_file_unload(&input);
}

#define BOX                                                                                                  \
    "{\"format\":\"ffd-lattice\",\"version\":1,\"size\":[4,4,4],\"rest\":{\"box\":{\"min\":[-1,-1,-1],"      \
    "\"max\":[1,1,1]}},"
static const char turning[] = BOX "\"moves\":[{\"twist\":{\"axis\":\"y\",\"degrees\":{\"$\":\"A\"}}}],"
                                  "\"keys\":[{\"time\":0,\"set\":{\"A\":0}},"
                                  "{\"time\":0.5,\"set\":{\"A\":90}}]}";
static const char stepping[] =
    BOX "\"keys\":[{\"time\":1,\"moves\":[]},{\"time\":2,\"moves\":[{\"at\":[\"all\","
        "\"all\",0],\"by\":[1,0,0]}]}]}";
static const char cube[] = "v 0 0 0\nv 0.5 0 0\nv 0 0.5 0\nv 0.25 0.25 -0.5\nf 1 2 3\nf 2 3 4\n";

static void what_cannot_be_is_refused(void **state)
{
    (void)state;
    glb out = {0};
    ffd_deform_desc job;
    ffd_lattice_source lattice;
    ffd_error error;
    const ffd_animate_desc good = describe(&job, &lattice, cube, turning, strlen(turning), &out);
    const ffd_deform_desc good_job = job;
    ffd_animate_desc desc = good;
    desc.job = NULL;
    assert_int_equal(ffd_animate_run(&desc, NULL, &error), FFD_E_ARGUMENT);
    desc = good;
    desc.tolerance = NAN;
    assert_int_equal(ffd_animate_run(&desc, NULL, &error), FFD_E_ARGUMENT);
    desc = good;
    desc.frames_per_second = 1001;
    assert_int_equal(ffd_animate_run(&desc, NULL, &error), FFD_E_ARGUMENT);
    desc = good;
    desc.targets = FFD_TARGETS_COUNT;
    assert_int_equal(ffd_animate_run(&desc, NULL, &error), FFD_E_ARGUMENT);
    job.has_time = true;
    assert_int_equal(ffd_animate_run(&good, NULL, &error), FFD_E_ARGUMENT);
    assert_string_equal(message_of(&error), "time cannot be used with an animation");
    job = good_job;
    job.normals = FFD_NORMALS_RECOMPUTE;
    assert_int_equal(ffd_animate_run(&good, NULL, &error), FFD_E_ARGUMENT);
    job = good_job;
    job.output = "o.obj";
    assert_int_equal(ffd_animate_run(&good, NULL, &error), FFD_E_ARGUMENT);
    job = good_job;
    job.lattice_count = 0;
    assert_int_equal(ffd_animate_run(&good, NULL, &error), FFD_E_ARGUMENT);
    assert_null(out.bytes);
}

/* A lattice of an object is as it is given; its own time does not matter. */
static void objects_are_animated_as_files_are(void **state)
{
    (void)state;
    glb of_text = {0}, of_object = {0};
    ffd_deform_desc job;
    ffd_lattice_source lattice;
    ffd_lattice *object;
    ffd_animate_desc desc = describe(&job, &lattice, cube, turning, strlen(turning), &of_text);
    desc.name = "k";
    assert_int_equal(ffd_animate_run(&desc, NULL, NULL), FFD_OK);
    assert_int_equal(ffd_lattice_parse(turning, strlen(turning), "k.json", &object, NULL), FFD_OK);
    assert_int_equal(ffd_lattice_set_time(object, 0.25, NULL), FFD_OK);
    lattice = (ffd_lattice_source){.object = object};
    job.sink_user = &of_object;
    assert_int_equal(ffd_animate_run(&desc, NULL, NULL), FFD_OK);
    assert_int_equal(of_text.size, of_object.size);
    assert_memory_equal(of_text.bytes, of_object.bytes, of_text.size);
    ffd_lattice_destroy(&object);
    free(of_text.bytes);
    free(of_object.bytes);
}

static void every_allocation_may_fail(void **state)
{
    (void)state;
    const char *const texts[] = {turning, stepping};
    for (size_t i = 0; i < 4; i++) {
        long successes = 0;
        ffd_status status = FFD_E_MEMORY;
        for (; status == FFD_E_MEMORY && successes < 5000; successes++) {
            glb out = {0};
            ffd_deform_desc job;
            ffd_lattice_source lattice;
            ffd_animate_desc desc = describe(&job, &lattice, cube, texts[i % 2], strlen(texts[i % 2]), &out);
            desc.targets = i < 2 ? FFD_TARGETS_AUTO : FFD_TARGETS_KEYS;
            desc.tolerance = 0.05;
            job.threads = 1;
            ffd_alloc_fail_after(successes);
            status = ffd_animate_run(&desc, NULL, NULL);
            ffd_alloc_fail_after(-1);
            assert_true((status == FFD_OK) == (out.bytes != NULL));
            free(out.bytes);
        }
        assert_int_equal(status, FFD_OK);
        assert_true(successes > 50);
    }
}

static ffd_animate_result animate(const char *text, ffd_animate_targets targets, double frames)
{
    glb out = {0};
    ffd_deform_desc job;
    ffd_lattice_source lattice;
    ffd_animate_result result = {.struct_size = sizeof result};
    ffd_animate_desc desc = describe(&job, &lattice, cube, text, strlen(text), &out);
    desc.targets = targets;
    desc.count = 8;
    desc.frames_per_second = frames;
    assert_int_equal(ffd_animate_run(&desc, &result, NULL), FFD_OK);
    free(out.bytes);
    return result;
}

/* Of turns that are too fast for the samples the bound says that the chords between these are far from the
   path. Others are within the tolerance, but for a number of targets that is too small. */
static void bounds_are_those_of_chords_too(void **state)
{
    (void)state;
    static const char fast[] = BOX "\"moves\":[{\"twist\":{\"axis\":\"y\",\"degrees\":{\"$\":\"A\"}}}],"
                                   "\"keys\":[{\"time\":0,\"set\":{\"A\":0}},"
                                   "{\"time\":1,\"set\":{\"A\":106000}}]}";
    for (int targets = FFD_TARGETS_AUTO; targets <= FFD_TARGETS_COUNT; targets++) {
        const ffd_animate_result slow = animate(turning, (ffd_animate_targets)targets, 60);
        assert_true(animate(fast, (ffd_animate_targets)targets, 1).bound > 0.5);
        assert_true(slow.bound > 0 && slow.bound <= slow.tolerance);
    }
}

int main(int count, char **arguments)
{
    case_file = count > 1 ? arguments[1] : "";
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_right_answers_of_a_reference_case),
        cmocka_unit_test(what_cannot_be_is_refused),
        cmocka_unit_test(objects_are_animated_as_files_are),
        cmocka_unit_test(bounds_are_those_of_chords_too),
        cmocka_unit_test(every_allocation_may_fail),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
