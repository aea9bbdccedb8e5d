/* Models: elements, names, descriptions of losses, and conversions with failing memory. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/memory/memory.h"
#include "io/formats.h"
#include "job/conversion.h"
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#define COUNT(array) (sizeof(array) / sizeof *(array))

static void keys_are_numbered_in_order(void **state)
{
    (void)state;
    intern_table table = {0};
    char key[16];
    uint32_t number;
    for (uint32_t round = 0; round < 2; round++)
        for (uint32_t i = 0; i < 1000; i++) {
            const int size = snprintf(key, sizeof key, "%u", i % 7 ? i : i * 1000);
            assert_true(ffd_intern(&table, key, (size_t)size, &number));
            assert_int_equal(number, i);
            assert_string_equal(ffd_intern_key(&table, number), key);
        }
    assert_true(ffd_intern_find(&table, "1", 1, &number));
    assert_string_equal(ffd_intern_key(&table, number), "1");
    assert_false(ffd_intern_find(&table, "none", 4, &number));
    assert_true(ffd_intern(&table, NULL, 0, &number));
    assert_int_equal(number, 1000);
    assert_true(ffd_intern(&table, "1\0", 2, &number)); /* not the key "1" */
    assert_int_equal(number, 1001);
    ffd_intern_free(&table);
    assert_false(ffd_intern_find(&table, "1", 1, &number));
}

static model_corner plain(uint32_t position)
{
    return (model_corner){position, MODEL_NONE, MODEL_NONE};
}

static void make_square(mesh_model *model)
{
    assert_int_equal(ffd_model_make_values(model, 4, 2, 2, NULL), FFD_OK);
    for (size_t i = 0; i < 12; i++)
        model->positions[i] = (double)i;
    for (size_t i = 0; i < 6; i++)
        model->normals[i] = i % 3 == 2;
    for (size_t i = 0; i < 4; i++)
        model->texcoords[i] = (double)i;
}

static void elements_fall_where_they_belong(void **state)
{
    (void)state;
    mesh_model model = {0};
    make_square(&model);
    const model_corner corners[4] = {plain(0), plain(1), plain(2), plain(3)};
    assert_int_equal(ffd_model_begin_run(&model, "a", NULL, "", NULL), FFD_OK);
    assert_int_equal(ffd_model_begin_run(&model, "a", NULL, NULL, NULL), FFD_OK); /* the same run */
    for (size_t count = 0; count <= 4; count++)
        assert_int_equal(ffd_model_add(&model, MODEL_FACES, corners, count, NULL), FFD_OK);
    assert_int_equal(ffd_model_begin_run(&model, "b", NULL, NULL, NULL), FFD_OK); /* stays empty */
    assert_int_equal(ffd_model_begin_run(&model, "a", "g", NULL, NULL), FFD_OK);
    assert_int_equal(ffd_model_add(&model, MODEL_LINES, corners, 3, NULL), FFD_OK);
    assert_int_equal(ffd_model_add(&model, MODEL_LINES, corners, 1, NULL), FFD_OK);
    assert_int_equal(ffd_model_add(&model, MODEL_POINTS, corners, 2, NULL), FFD_OK);
    assert_int_equal(ffd_model_finish(&model, NULL), FFD_OK);

    assert_int_equal(model.run_count, 2);
    assert_string_equal(model_name(&model, model.runs[1].object), "a");
    assert_string_equal(model_name(&model, model.runs[1].group), "g");
    assert_null(model_name(&model, model.runs[1].material));
    const size_t ends[2][MODEL_KINDS] = {{2, 1, 1}, {2, 2, 4}};
    for (size_t run = 0; run < 2; run++)
        for (int k = 0; k < MODEL_KINDS; k++)
            assert_int_equal(model_run_end(&model, run, (model_kind)k), ends[run][k]);
    size_t count;
    assert_int_equal(model_element(&model.lists[MODEL_FACES], 1, &count)[3].position, 3);
    assert_int_equal(count, 4);
    assert_int_equal(model.features, MODEL_HAS_POLYGONS | MODEL_HAS_LINES | MODEL_HAS_POINTS |
                                         MODEL_HAS_OBJECTS | MODEL_HAS_GROUPS);
    ffd_model_free(&model);
}

/* Several values at one position count as several only if they differ. */
static void values_of_a_position_are_compared(void **state)
{
    (void)state;
    for (int different = 0; different < 2; different++) {
        mesh_model model = {0};
        uint32_t numbers[4];
        make_square(&model);
        model.normals[5] += different;
        const model_corner first[3] = {{0, 0, 0}, plain(1), plain(2)},
                           second[3] = {{0, 0, 1}, plain(1), plain(2)};
        assert_int_equal(ffd_model_begin_run(&model, NULL, NULL, NULL, NULL), FFD_OK);
        assert_int_equal(ffd_model_add(&model, MODEL_FACES, first, 3, NULL), FFD_OK);
        assert_int_equal(ffd_model_add(&model, MODEL_FACES, second, 3, NULL), FFD_OK);
        assert_int_equal(ffd_model_finish(&model, NULL), FFD_OK);
        assert_int_equal(model.features, MODEL_HAS_NORMALS | MODEL_HAS_TEXCOORDS | MODEL_HAS_LOOSE |
                                             (different ? MODEL_HAS_CORNER_NORMALS : 0));
        assert_int_equal(ffd_model_normals_by_position(&model, numbers), different);
        assert_int_equal(numbers[0], 0);
        for (int i = 1; i < 4; i++)
            assert_int_equal(numbers[i], MODEL_NONE);
        ffd_model_free(&model);
    }
}

/* A colour fits into bytes if six digits of it are those of a byte. */
static void colours_that_bytes_hold(void **state)
{
    (void)state;
    static const struct {
        double value;
        bool fits;
    } cases[] = {{0, true},          {1, true},       {0.501961, true}, {0.498039, true}, {0.2, true},
                 {0.2000025, false}, {0.2005, false}, {0.5, false},     {-0.001, false},  {1.001, false}};
    for (size_t i = 0; i < COUNT(cases); i++) {
        double colours[8] = {1, 1, 1, 1, 1, 1, cases[i].value, 1};
        const mesh_model model = {.position_count = 2, .colours = colours};
        if (ffd_model_colours_fit_bytes(&model) != cases[i].fits)
            fail_msg("%g", cases[i].value);
    }
}

/* Floats are too coarse if a mesh is far from the origin for its size. */
static void positions_that_floats_hold(void **state)
{
    (void)state;
    for (int far = 0; far < 2; far++) {
        mesh_model model = {0};
        assert_int_equal(ffd_model_make_values(&model, 3, 0, 0, NULL), FFD_OK);
        for (size_t i = 0; i < 9; i++)
            model.positions[i] = (far ? 1000.3 : 60.3) + (double)(i / 3) / 2;
        assert_int_equal(ffd_model_finish(&model, NULL), FFD_OK);
        assert_int_equal(model.features & MODEL_HAS_FINE_POSITIONS, far ? MODEL_HAS_FINE_POSITIONS : 0);
        ffd_model_free(&model);
    }
}

static void losses_are_named_once(void **state)
{
    (void)state;
    static const struct {
        uint32_t has, holds;
        const char *words;
    } cases[] = {
        {MODEL_HAS_NORMALS | MODEL_HAS_CORNER_NORMALS, 0, "vertex normals"},
        {MODEL_HAS_NORMALS | MODEL_HAS_CORNER_NORMALS, MODEL_HAS_NORMALS,
         "vertex normals (a vertex has several)"},
        {MODEL_HAS_NORMALS, MODEL_HAS_NORMALS, ""},
        {MODEL_HAS_MATERIALS | MODEL_HAS_MATERIAL_NAMES | MODEL_HAS_SKINS, 0, "materials, skins"},
        {MODEL_HAS_MATERIALS | MODEL_HAS_MATERIAL_NAMES, MODEL_HAS_MATERIAL_NAMES,
         "materials (their names are kept)"},
        {MODEL_HAS_MATERIALS, MODEL_HAS_MATERIAL_NAMES, "materials"},
        {MODEL_HAS_MATERIAL_NAMES, 0, "material names"},
    };
    for (size_t i = 0; i < COUNT(cases); i++) {
        const mesh_model model = {.features = cases[i].has};
        char text[200];
        ffd_model_describe_loss(&model, cases[i].holds, text, sizeof text);
        assert_string_equal(text, cases[i].words);
    }
    const mesh_model all = {.features = UINT32_MAX};
    char text[800], cut[12];
    ffd_model_describe_loss(&all, 0, text, sizeof text);
    assert_true(strlen(text) < sizeof text - 1); /* the text is not truncated */
    ffd_model_describe_loss(&all, 0, cut, sizeof cut);
    assert_true(strlen(cut) < sizeof cut);
}

static const struct {
    ffd_format format;
    const char *text;
} sources[] = {
    {FFD_FORMAT_OBJ,
     "mtllib x\no a\nv 0 0 0 1 0 0\nv 4 0 0 0 1 0\nv 1 1 0 0 0 1\nv 0 4 0 0 0 0.5\nvt 0 0\nvn 0 0 1\n"
     "usemtl m\nf 1/1/1 2/1/1 3/1/1 4/1/1\ng b\nl 1/1 2/1\np 4\nf 1 2 3\n"},
    {FFD_FORMAT_PLY,
     "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
     "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty float s\n"
     "property float t\nelement face 1\nproperty list uchar int vertex_indices\nelement edge 1\n"
     "property int vertex1\nproperty int vertex2\nend_header\n0 0 0 1 2 3 0 1\n1 0 0 4 5 6 1 0\n"
     "0 1 0 7 8 9 1 1\n3 0 1 2\n0 2\n"},
    {FFD_FORMAT_OFF,
     "STCNOFF\n3 2 0\n0 0 0 0 0 1 9 8 7 255 0 0\n1 0 0 0 0 1 6 5 4 255 1 0\n0 1 0 0 0 1 3 2 1 255 0 1\n"
     "3 0 1 2\n2 0 1\n"},
    {FFD_FORMAT_STL,
     "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
     "endfacet\nendsolid a\n"},
    {FFD_FORMAT_GLTF,
     "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":36,\"uri\":\"data:application/"
     "octet-stream;base64,"
     "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}]"
     ","
     "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"min\":[0,0,0],"
     "\"max\":[1,1,0]}],\"materials\":[{\"name\":\"m\"}],\"meshes\":[{\"primitives\":[{\"attributes\":{"
     "\"POSITION\":0,"
     "\"NORMAL\":0},\"material\":0}]}],\"nodes\":[{\"mesh\":0,\"name\":\"n\",\"scale\":[-1,2,3]}]}"},
};

static mesh_document *open_source(size_t i)
{
    file_input input;
    char path[64];
    mesh_document *document = NULL;
    const ffd_source source = {.path = "-", .format = sources[i].format};
    ffd_error error = {0};
    snprintf(path, sizeof path, "/tmp/ffd-test-model-%ld.in", (long)getpid());
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fputs(sources[i].text, file) >= 0, 1);
    assert_int_equal(fclose(file), 0);
    assert_int_equal(ffd_file_load(path, &input, NULL), FFD_OK);
    remove(path);
    if (ffd_format_open(ffd_format_table(sources[i].format), &input, &source, &document, &error))
        fail_msg("%s", error.message);
    return document;
}

static ffd_status convert(const mesh_document *document, ffd_format format, const char *path)
{
    const mesh_save_options options = {.path = path, .format = format, .force = true};
    const mesh_log log = {0};
    file_output *output = NULL;
    ffd_error error = {0};
    ffd_status status = ffd_output_create(&output, &error);
    if (status == FFD_OK)
        status = ffd_conversion_save(document, MESH_STORED, NULL, &options, output, &log, &error);
    if (status == FFD_OK)
        status = ffd_output_commit(output, &error);
    ffd_output_destroy(&output);
    return status;
}

/* Each allocation fails in turn, without leak or file; then all succeed. */
static void memory_may_run_out_anywhere(void **state)
{
    (void)state;
    static const ffd_format targets[] = {FFD_FORMAT_OBJ, FFD_FORMAT_PLY, FFD_FORMAT_OFF,
                                         FFD_FORMAT_STL, FFD_FORMAT_GLB, FFD_FORMAT_GLTF};
    char path[64], bin[64];
    snprintf(path, sizeof path, "/tmp/ffd-test-model-%ld.out", (long)getpid());
    snprintf(bin, sizeof bin, "/tmp/ffd-test-model-%ld.bin", (long)getpid());
    for (size_t s = 0; s < COUNT(sources); s++) {
        mesh_document *document = open_source(s);
        for (size_t t = 0; t < COUNT(targets); t++) {
            if (!ffd_conversion_needed(document, targets[t]))
                continue;
            assert_int_equal(ffd_conversion_check(document, targets[t], NULL), FFD_OK);
            ffd_status status = FFD_E_MEMORY;
            for (long successes = 0; status == FFD_E_MEMORY; successes++) {
                assert_true(successes < 2000);
                assert_int_equal(access(path, F_OK), -1);
                assert_int_equal(access(bin, F_OK), -1);
                ffd_alloc_fail_after(successes);
                status = convert(document, targets[t], path);
                ffd_alloc_fail_after(-1);
            }
            assert_int_equal(status, FFD_OK);
            assert_int_equal(access(path, F_OK), 0);
            assert_int_equal(access(bin, F_OK), targets[t] == FFD_FORMAT_GLTF ? 0 : -1);
            remove(path);
            remove(bin);
        }
        document->format->close(document);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(keys_are_numbered_in_order),
        cmocka_unit_test(elements_fall_where_they_belong),
        cmocka_unit_test(values_of_a_position_are_compared),
        cmocka_unit_test(colours_that_bytes_hold),
        cmocka_unit_test(positions_that_floats_hold),
        cmocka_unit_test(losses_are_named_once),
        cmocka_unit_test(memory_may_run_out_anywhere),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
