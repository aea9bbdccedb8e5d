/* test_gltf_models.c - the sample models of FFD_MODELS: read, written back unchanged, and mutated at
   random. */
#define _XOPEN_SOURCE 700 /* nftw */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/draw.h"
#include "../support/gltf_file.h"
#include "../support/repetitions.h"
#include "../support/test_folder.h"
#include "io/gltf/read/gltf_document.h"
#include "mesh/difference.h"
#include <ftw.h>
#include <math.h>
#include <sys/stat.h>
#include <unistd.h>

#define MOST_MODELS 1000
#define LARGEST_TO_BREAK 20000
#define BROKEN_COPIES 20

static char *models[MOST_MODELS];
static size_t model_count;

static int add_model(const char *path, const struct stat *info, int kind, struct FTW *place)
{
    (void)info;
    (void)place;
    if (kind == FTW_F && model_count < MOST_MODELS &&
        (ffd_path_has_ending(path, ".gltf") || ffd_path_has_ending(path, ".glb")))
        models[model_count++] = ffd_text_copy(path);
    return 0;
}

static int compare_names(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

static int find_models(void **state)
{
    if (nftw(getenv("FFD_MODELS"), add_model, 16, FTW_PHYS) != 0 || model_count == 0)
        return -1;
    qsort(models, model_count, sizeof *models, compare_names);
    return make_folder(state);
}

static int forget_models(void **state)
{
    for (size_t i = 0; i < model_count; i++)
        ffd_free(models[i]);
    return remove_folder(state);
}

static bool is_binary(const char *path)
{
    return ffd_path_has_ending(path, ".glb");
}

static void twist(const double place[3], double xyz[3])
{
    xyz[0] += 0.25 * place[1];
    xyz[1] -= 0.5 * place[2] + 0.125;
}

/* A model that cannot be deformed is still described. It has faces, unless it is compressed. */
static void describe(mesh_document *document, const char *path)
{
    byte_buffer text = {0};
    json_text json;
    ffd_json_begin(&json, &text);
    ffd_json_object(&json, NULL, false);
    assert_int_equal(gltf->describe(document, &json, NULL), FFD_OK);
    ffd_json_end(&json, '}');
    assert_false(text.failed);
    ffd_buffer_free(&text);
    mesh_faces faces;
    ffd_error error = {0};
    const ffd_status status = gltf->faces(document, MESH_STORED, &faces, &error);
    if (status != FFD_OK && status != FFD_E_UNSUPPORTED)
        fail_msg("%s: faces: %s", path, error.message);
    ffd_mesh_faces_free(&faces);
}

static bool names_files(const file_input *file)
{
    for (size_t i = 0; i + 5 <= file->size; i++)
        if (memcmp(file->data + i, ".bin\"", 5) == 0)
            return true;
    return false;
}

static void check_same(const char *path, const char *output)
{
    file_input before, after;
    assert_int_equal(ffd_file_load(path, &before, NULL), FFD_OK);
    assert_int_equal(ffd_file_load(output, &after, NULL), FFD_OK);
    /* Only names of buffer files may differ. */
    if (!names_files(&before) &&
        (before.size != after.size || memcmp(before.data, after.data, before.size) != 0))
        fail_msg("%s: changed though no vertex moved", path);
    ffd_file_unload(&before);
    ffd_file_unload(&after);
    mesh_document *a = NULL, *b = NULL;
    ffd_comparison comparison = {.struct_size = sizeof comparison};
    assert_int_equal(open_file(path, FFD_SPACE_MESH, &a, NULL), FFD_OK);
    assert_int_equal(open_file(output, FFD_SPACE_MESH, &b, NULL), FFD_OK);
    ffd_difference_begin(&comparison, 0, 0);
    assert_int_equal(gltf->compare(a, b, &comparison, NULL), FFD_OK);
    if (!comparison.equal)
        fail_msg("%s: %s", path, comparison.first.text);
    gltf->close(a);
    gltf->close(b);
}

/* Each model gets a folder of its own, which also receives its images. */
static const char *output_for(size_t model)
{
    static char output[200];
    snprintf(output, sizeof output, "%s/%zu", folder, model);
    mkdir(output, 0777);
    snprintf(output, sizeof output, "%s/%zu/out.%s", folder, model,
             is_binary(models[model]) ? "glb" : "gltf");
    return output;
}

static void models_that_stay_are_written_back_as_they_are(void **state)
{
    (void)state;
    size_t deformed = 0;
    for (size_t i = 0; i < model_count; i += (size_t)stride(4)) {
        mesh_document *document = NULL;
        ffd_error error = {0};
        if (open_file(models[i], FFD_SPACE_SCENE, &document, &error))
            fail_msg("%s: %s", models[i], error.message);
        describe(document, models[i]);
        if (gltf->check(document, &error) == FFD_OK && deform(document, stay, false, &error) == FFD_OK)
            deformed++;
        else
            assert_true(error.status == FFD_E_UNSUPPORTED || error.status == FFD_E_INVALID);
        const char *const output = output_for(i);
        if (save_to(document, output, &error))
            fail_msg("%s: %s", models[i], error.message);
        gltf->close(document);
        check_same(models[i], output);
    }
    print_message("%zu models, %zu can be deformed in the scene\n", model_count, deformed);
    assert_true(deformed > 0);
}

/* Returns the largest error of a stored number: half a step for integers. If they are converted to floats, an
   unchanged number is rounded once more. */
static double allowed_error(const mesh_document *document, size_t part, double value)
{
    const gltf_document *d = ffd_gltf_of(document);
    const gltf_accessor *accessor = &d->model.accessors[d->parts[part].streams[GLTF_POSITION].accessor];
    const double scales[] = {127, 255, 32767, 65535};
    if (accessor->component == GLTF_FLOAT)
        return 0;
    return 0.5 / (accessor->normalized ? scales[accessor->component - GLTF_I8] : 1) + 1e-7 * fabs(value);
}

/* At each node the output shows what was asked for. The parts of the new file are checked one by one. */
static void moved_models_show_what_was_asked_for(void **state)
{
    (void)state;
    size_t vertices = 0;
    for (size_t m = 0; m < model_count; m += (size_t)stride(4)) {
        mesh_document *a = NULL, *b = NULL;
        ffd_error error = {0};
        assert_int_equal(open_file(models[m], FFD_SPACE_SCENE, &a, NULL), FFD_OK);
        if (gltf->check(a, &error) || deform(a, twist, true, &error)) {
            gltf->close(a);
            continue;
        }
        const char *const output = output_for(m);
        if (save_to(a, output, &error) || open_file(output, FFD_SPACE_SCENE, &b, &error))
            fail_msg("%s: %s", models[m], error.message);
        assert_int_equal(a->part_count, b->part_count);
        for (size_t part = 0; part < a->part_count; part++)
            for (size_t i = 0; i < a->parts[part].vertex_count && !a->parts[part].skipped; i++) {
                double xyz[3], place[3], moved[3];
                gltf->read(a, part, MESH_POSITIONS, MESH_STORED, i, 1, xyz);
                memcpy(place, xyz, sizeof place);
                ffd_part_transform(a, part, i, 1, place);
                twist(place, xyz);
                gltf->read(b, part, MESH_POSITIONS, MESH_STORED, i, 1, moved);
                for (int c = 0; c < 3; c++)
                    if (fabs((double)(float)xyz[c] - moved[c]) > allowed_error(a, part, xyz[c]))
                        fail_msg("%s: part %zu, vertex %zu", models[m], part, i);
                vertices++;
            }
        gltf->close(a);
        gltf->close(b);
    }
    assert_true(vertices > 0);
}

/* Changes some bytes of a copy, mostly of its JSON. */
static void break_bytes(draw *d, unsigned char *bytes, size_t size)
{
    static const char likely[] = "0123456789-.e,:[]{}\"";
    for (int n = draw_int(d, 1, 4); n > 0; n--) {
        const size_t at = (size_t)(draw_unit(d) * (double)size);
        bytes[at] = draw_unit(d) < 0.7 ? (unsigned char)likely[draw_int(d, 0, (int)sizeof likely - 2)]
                                       : (unsigned char)draw_int(d, 0, 255);
    }
}

static void broken_models_crash_nothing(void **state)
{
    (void)state;
    draw d = {draw_seed()};
    size_t accepted = 0, refused = 0;
    for (size_t m = 0; m < model_count; m++) {
        file_input input;
        assert_int_equal(ffd_file_load(models[m], &input, NULL), FFD_OK);
        unsigned char *bytes = malloc(input.size);
        for (int i = 0; i < (is_under_valgrind() ? 1 : BROKEN_COPIES) && input.size <= LARGEST_TO_BREAK;
             i++) {
            ffd_error error = {0};
            memcpy(bytes, input.data, input.size);
            break_bytes(&d, bytes, input.size);
            const ffd_space space = draw_int(&d, 0, 1) ? FFD_SPACE_SCENE : FFD_SPACE_MESH;
            const ffd_status status =
                run_all(bytes, input.size, models[m], is_binary(models[m]) ? FFD_FORMAT_GLB : FFD_FORMAT_GLTF,
                        space, twist, output_for(m), &error);
            if (status && !error.message[0])
                fail_msg("%s: status %d without a message", models[m], (int)status);
            if (status)
                refused++;
            else
                accepted++;
        }
        free(bytes);
        ffd_file_unload(&input);
    }
    print_message("%zu broken copies written, %zu refused\n", accepted, refused);
    assert_true(accepted > 0 && refused > 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(models_that_stay_are_written_back_as_they_are),
        cmocka_unit_test(moved_models_show_what_was_asked_for),
        cmocka_unit_test(broken_models_crash_nothing),
    };
    if (!getenv("FFD_MODELS")) {
        puts("SKIP: models: FFD_MODELS is not set");
        return 77;
    }
    return cmocka_run_group_tests(tests, find_models, forget_models);
}
