/* test_gltf_mended.c - what compression made of skin weights and directions is valid again where it is
   written uncompressed. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/draco_sample.h"
#include "../support/gltf_file.h"
#include "../support/test_folder.h"
#include "base/text/base64.h"
#include "io/gltf/read/gltf_elements.h"
#include <math.h>
#include <meshoptimizer.h>

#define VERTICES 9
#define SETS 2
#define SKIN                                                                                                 \
    "\"nodes\":[{\"mesh\":0,\"skin\":0},{},{},{},{},{},{}],"                                                 \
    "\"scenes\":[{\"nodes\":[0,1,2,3,4,5,6]}],\"scene\":0,\"skins\":[{\"joints\":[1,2,3,4,5,6]}]"
#define ELEMENTS(number, offset, type)                                                                       \
    "{\"bufferView\":0,\"byteOffset\":" #offset ",\"componentType\":" #number                                \
    ",\"count\":9,\"type\":\"" type "\""

static char output[100];

typedef struct vertex {
    float position[3];
    uint8_t joints[SETS][4];
    float weights[SETS][4];
} vertex;

/* What each of the nine vertices has, and what it should have once it is mended. */
typedef struct influence_case {
    vertex of;
    uint8_t joints[SETS][4];
    float weights[SETS][4];
} influence_case;

#define NOT_A_NUMBER ((float)NAN)

static const influence_case cases[VERTICES] = {
    /* Valid ones keep their numbers. */
    {{{0, 0, 0}, {{1, 2, 0, 0}, {3, 0, 0, 0}}, {{0.5f, 0.25f, 0, 0}, {0.25f, 0, 0, 0}}},
     {{1, 2, 0, 0}, {3, 0, 0, 0}},
     {{0.5f, 0.25f, 0, 0}, {0.25f, 0, 0, 0}}},
    /* Over both sets. */
    {{{1, 0, 0}, {{1, 2, 0, 0}, {3, 4, 0, 0}}, {{1, 0.5f, 0, 0}, {0.25f, 0.25f, 0, 0}}},
     {{1, 2, 0, 0}, {3, 4, 0, 0}},
     {{0.5f, 0.25f, 0, 0}, {0.125f, 0.125f, 0, 0}}},
    /* No weight at all: the first joint has it. */
    {{{0, 1, 0}, {{5, 2, 1, 0}, {3, 0, 0, 0}}, {{0}}}, {{5, 0, 0, 0}, {0}}, {{1, 0, 0, 0}, {0}}},
    /* A joint twice, once in each set. */
    {{{2, 0, 0}, {{1, 2, 0, 0}, {0, 1, 0, 0}}, {{0.5f, 0.25f, 0, 0}, {0, 0.25f, 0, 0}}},
     {{1, 2, 0, 0}, {0, 0, 0, 0}},
     {{0.75f, 0.25f, 0, 0}, {0, 0, 0, 0}}},
    /* A joint without weight. */
    {{{3, 0, 0}, {{1, 2, 3, 4}, {5, 0, 0, 0}}, {{1, 0, 0, 0}, {0}}},
     {{1, 0, 0, 0}, {0}},
     {{1, 0, 0, 0}, {0}}},
    /* A weight below zero. */
    {{{2, 1, 0}, {{1, 2, 0, 0}, {0}}, {{1, -0.25f, 0, 0}, {0}}}, {{1, 0, 0, 0}, {0}}, {{1, 0, 0, 0}, {0}}},
    /* No number: left alone. */
    {{{4, 0, 0}, {{1, 2, 0, 0}, {0}}, {{1, NOT_A_NUMBER, 0, 0}, {0}}},
     {{1, 2, 0, 0}, {0}},
     {{1, NOT_A_NUMBER, 0, 0}, {0}}},
    /* A sum that is off by no more than rounding is left alone. */
    {{{5, 0, 0}, {{1, 2, 0, 0}, {0}}, {{0.5f, 0.50000006f, 0, 0}, {0}}},
     {{1, 2, 0, 0}, {0}},
     {{0.5f, 0.50000006f, 0, 0}, {0}}},
    {{{4, 1, 0}, {{4, 0, 0, 0}, {0}}, {{0.5f, 0, 0, 0}, {0}}}, {{4, 0, 0, 0}, {0}}, {{1, 0, 0, 0}, {0}}},
};

/* Makes a file whose view 0 is buffer 0 with `bytes`. view: more members of the view. */
static char *make_text(const unsigned char *bytes, size_t size, const char *view, const char *rest)
{
    byte_buffer text = {0};
    char *coded = calloc(ffd_base64_length(size) + 1, 1);
    ffd_base64_encode(bytes, size, coded);
    ffd_buffer_format(&text, "{\"asset\":{\"version\":\"2.0\"},\"bufferViews\":[{%s}],\"buffers\":[", view);
    ffd_buffer_format(&text, "{\"byteLength\":%zu,\"uri\":\"data:application/octet-stream;base64,", size);
    ffd_buffer_text(&text, coded);
    ffd_buffer_format(&text, "\"},{\"byteLength\":%d}],", VERTICES * (int)sizeof(vertex));
    ffd_buffer_text(&text, rest);
    ffd_buffer_text(&text, "," SKIN "}");
    free(coded);
    return ffd_buffer_finish(&text);
}

/* Makes a file with one view that meshopt compressed. size: of a vertex in it. */
static char *make_meshopt(const void *vertices, size_t size, const char *accessors, const char *primitives)
{
    unsigned char bytes[2048];
    char view[400];
    byte_buffer rest = {0};
    const size_t length = meshopt_encodeVertexBuffer(bytes, sizeof bytes, vertices, VERTICES, size);
    assert_true(length > 0);
    snprintf(view, sizeof view,
             "\"buffer\":1,\"byteLength\":%zu,\"byteStride\":%zu,\"extensions\":{\"EXT_meshopt_compression\":"
             "{\"buffer\":0,\"byteLength\":%zu,\"byteStride\":%zu,\"mode\":\"ATTRIBUTES\",\"count\":%d}}",
             VERTICES * size, size, length, size, VERTICES);
    ffd_buffer_format(&rest,
                      "\"extensionsUsed\":[\"EXT_meshopt_compression\"],\"extensionsRequired\":["
                      "\"EXT_meshopt_compression\"],\"accessors\":[%s],\"meshes\":[{\"primitives\":[%s]}]",
                      accessors, primitives);
    char *finished = ffd_buffer_finish(&rest), *text = make_text(bytes, length, view, finished);
    ffd_free(finished);
    return text;
}

static mesh_document *open_text(const char *text)
{
    mesh_document *document = NULL;
    ffd_error error = {0};
    if (open_bytes(text, strlen(text), "t.gltf", FFD_FORMAT_GLTF, FFD_SPACE_SCENE, &document, &error))
        fail_msg("%s %s", error.pointer, error.message);
    return document;
}

static size_t told;

static void hear(void *user, ffd_log_level level, const char *line)
{
    (void)user;
    (void)level;
    size_t count = 0;
    if (strstr(line, "are written so that they sum to 1") &&
        sscanf(line, "the skin weights of %zu ", &count) == 1)
        told += count;
}

/* Moves a file's mesh into `output` and opens that. *text: its text; free it after the document. */
static mesh_document *move_into(const char *from, bool attributes, char **text)
{
    mesh_document *document = open_text(from);
    const mesh_save_options options = {.path = output, .force = true};
    const mesh_log log = {hear, NULL};
    ffd_error error = {0};
    told = 0;
    if (deform(document, add_one, attributes, &error) || save_with(document, &options, &log, &error))
        fail_msg("%s %s", error.pointer, error.message);
    gltf->close(document);
    *text = load_text(output);
    return open_text(*text);
}

static void check_four(const mesh_document *document, size_t accessor, size_t v, const double wanted[4])
{
    double values[4];
    ffd_gltf_read(ffd_gltf_of(document), accessor, v, 1, 4, values);
    for (size_t c = 0; c < 4; c++)
        if (!(fabs(values[c] - wanted[c]) <= 0) && !(isnan(values[c]) && isnan(wanted[c])))
            fail_msg("accessor %zu, vertex %zu: %.9g instead of %.9g", accessor, v, values[c], wanted[c]);
}

#define SET_ACCESSORS                                                                                        \
    ELEMENTS(5126, 0, "VEC3")                                                                                \
    "}," ELEMENTS(5121, 12, "VEC4") "}," ELEMENTS(5126, 20, "VEC4") "}," ELEMENTS(                           \
        5121, 16, "VEC4") "}," ELEMENTS(5126, 36, "VEC4") ",\"min\":[0,0,0,0],\"max\":[2,2,2,2]}"
#define SET_PRIMITIVE                                                                                        \
    "{\"attributes\":{\"POSITION\":0,\"JOINTS_0\":1,\"WEIGHTS_0\":2,\"JOINTS_1\":3,\"WEIGHTS_1\":4}}"

static char *make_cases(const char *primitives)
{
    vertex vertices[VERTICES];
    for (size_t i = 0; i < VERTICES; i++)
        vertices[i] = cases[i].of;
    return make_meshopt(vertices, sizeof vertices[0], SET_ACCESSORS, primitives);
}

static void weights_sum_to_one(void **state)
{
    (void)state;
    char *text = make_cases(SET_PRIMITIVE), *written;
    mesh_document *document = move_into(text, false, &written);
    for (size_t v = 0; v < VERTICES; v++)
        for (size_t s = 0; s < SETS; s++) {
            double joints[4], weights[4];
            for (size_t c = 0; c < 4; c++) {
                joints[c] = cases[v].joints[s][c];
                weights[c] = (double)cases[v].weights[s][c];
            }
            check_four(document, 1 + 2 * s, v, joints);
            check_four(document, 2 + 2 * s, v, weights);
        }
    assert_int_equal(told, 6);
    gltf->close(document);
    ffd_free(text);
    free(written);
}

/* Where two primitives have other weights of the same joints, the joints must not change, and nothing does.
 */
static void joints_with_several_weights_are_left(void **state)
{
    (void)state;
    char *text = make_cases("{\"attributes\":{\"POSITION\":0,\"JOINTS_0\":1,\"WEIGHTS_0\":2}},"
                            "{\"attributes\":{\"POSITION\":0,\"JOINTS_0\":1,\"WEIGHTS_0\":4}}"),
         *written;
    mesh_document *document = move_into(text, false, &written);
    for (size_t v = 0; v < VERTICES; v++) {
        double joints[4], weights[4];
        for (size_t c = 0; c < 4; c++) {
            joints[c] = cases[v].of.joints[0][c];
            weights[c] = (double)cases[v].of.weights[0][c];
        }
        check_four(document, 1, v, joints);
        check_four(document, 2, v, weights);
    }
    assert_int_equal(told, 0);
    gltf->close(document);
    ffd_free(text);
    free(written);
}

/* Two primitives with the same joints and weights, the second one with fewer sets: mended once. */
static void shared_weights_are_mended_once(void **state)
{
    (void)state;
    char *text =
             make_cases(SET_PRIMITIVE ",{\"attributes\":{\"POSITION\":0,\"JOINTS_0\":1,\"WEIGHTS_0\":2}}"),
         *written;
    mesh_document *document = move_into(text, false, &written);
    const double halves[4] = {0.5, 0.25, 0, 0};
    check_four(document, 2, 1, halves);
    assert_int_equal(told, 6);
    gltf->close(document);
    ffd_free(text);
    free(written);
}

/* Integers sum to one exactly. */
static void integers_sum_to_one_exactly(void **state)
{
    (void)state;
    static const uint8_t given[VERTICES][2][4] = {
        {{85, 85, 85, 0}, {85, 85, 85, 0}},   {{86, 86, 86, 0}, {84, 86, 86, 0}},
        {{0, 0, 0, 0}, {255, 0, 0, 0}},       {{254, 0, 0, 0}, {255, 0, 0, 0}},
        {{255, 255, 0, 0}, {127, 128, 0, 0}}, {{1, 1, 1, 0}, {85, 85, 85, 0}},
        {{128, 64, 63, 0}, {128, 64, 63, 0}}, {{255, 1, 0, 0}, {254, 1, 0, 0}},
        {{1, 255, 255, 0}, {1, 128, 126, 0}}};
    struct {
        float position[3];
        uint8_t joints[4], weights[4];
    } vertices[VERTICES];
    for (size_t i = 0; i < VERTICES; i++) {
        vertices[i].position[0] = (float)i;
        vertices[i].position[1] = (float)(i * i);
        vertices[i].position[2] = 0;
        const uint8_t joints[4] = {1, 2, 3, 0};
        memcpy(vertices[i].joints, joints, 4);
        memcpy(vertices[i].weights, given[i][0], 4);
    }
    char *text = make_meshopt(vertices, sizeof vertices[0],
                              ELEMENTS(5126, 0, "VEC3") "}," ELEMENTS(5121, 12, "VEC4") "}," ELEMENTS(
                                  5121, 16, "VEC4") ",\"normalized\":true}",
                              "{\"attributes\":{\"POSITION\":0,\"JOINTS_0\":1,\"WEIGHTS_0\":2}}"),
         *written;
    mesh_document *document = move_into(text, false, &written);
    for (size_t v = 0; v < VERTICES; v++) {
        double values[4], sum = 0;
        ffd_gltf_read(ffd_gltf_of(document), 2, v, 1, 4, values);
        for (size_t c = 0; c < 4; c++) {
            const long steps = lround(values[c] * 255);
            sum += (double)steps;
            if (labs(steps - given[v][1][c]) > 1)
                fail_msg("vertex %zu, weight %zu: %ld", v, c, steps);
        }
        assert_true(fabs(sum - 255) < 0.5);
    }
    assert_int_equal(told, 7);
    gltf->close(document);
    ffd_free(text);
    free(written);
}

/* Draco with few bits: weights and tangents off by some hundredths. */
static char *make_coarse(void)
{
    float positions[3 * VERTICES], normals[3 * VERTICES], tangents[4 * VERTICES], weights[4 * VERTICES];
    uint16_t joints[4 * VERTICES];
    uint32_t triangles[VERTICES];
    for (uint32_t i = 0; i < VERTICES; i++) {
        const float turn = 0.7f * (float)i, share = 0.05f + 0.09f * (float)i;
        const float position[3] = {(float)i, (float)(i * i), 0.5f * (float)(i % 2)};
        const float tangent[4] = {1.05f * cosf(turn), 1.05f * sinf(turn), 0, i % 2 ? 1.0f : -1.0f};
        const float normal[3] = {0, 0, 1}, weight[4] = {1 - share, 0.7f * share, 0.3f * share, 0};
        const uint16_t joint[4] = {1, 2, 3, 0};
        memcpy(positions + 3 * i, position, sizeof position);
        memcpy(normals + 3 * i, normal, sizeof normal);
        memcpy(tangents + 4 * i, tangent, sizeof tangent);
        memcpy(weights + 4 * i, weight, sizeof weight);
        memcpy(joints + 4 * i, joint, sizeof joint);
        triangles[i] = i;
    }
    const sample_mesh mesh = {.point_count = VERTICES,
                              .triangle_count = VERTICES / 3,
                              .positions = positions,
                              .normals = normals,
                              .joints = joints,
                              .triangles = triangles,
                              .weights = weights,
                              .tangents = tangents};
    const sample_options options = {.bits = 5};
    size_t size;
    char view[60];
    unsigned char *bytes = make_draco(&mesh, &options, &size);
    assert_non_null(bytes);
    snprintf(view, sizeof view, "\"buffer\":0,\"byteLength\":%zu", size);
    char *text = make_text(
        bytes, size, view,
        "\"extensionsUsed\":[\"KHR_draco_mesh_compression\"],\"extensionsRequired\":["
        "\"KHR_draco_mesh_compression\"],\"accessors\":["
        "{\"componentType\":5126,\"count\":9,\"type\":\"VEC3\",\"min\":[0,0,0],\"max\":[8,64,1]},"
        "{\"componentType\":5126,\"count\":9,\"type\":\"VEC3\"},{\"componentType\":5126,\"count\":9,\"type\":"
        "\"VEC4\"},{\"componentType\":5123,\"count\":9,\"type\":\"VEC4\"},{\"componentType\":5126,\"count\":"
        "9,"
        "\"type\":\"VEC4\",\"max\":[0.5,0,0,0]},{\"componentType\":5123,\"count\":9,\"type\":\"SCALAR\"}],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1,\"TANGENT\":2,\"JOINTS_"
        "0\":"
        "3,\"WEIGHTS_0\":4},\"indices\":5,\"extensions\":{\"KHR_draco_mesh_compression\":{\"bufferView\":0,"
        "\"attributes\":{\"POSITION\":3,\"NORMAL\":7,\"TANGENT\":11,\"JOINTS_0\":300,\"WEIGHTS_0\":10}}}}]}"
        "]");
    free(bytes);
    return text;
}

static void draco_is_valid_again(void **state)
{
    (void)state;
    char *text = make_coarse(), *written;
    mesh_document *document = move_into(text, false, &written);
    const gltf_document *const d = ffd_gltf_of(document);
    double largest = 0;
    for (size_t v = 0; v < VERTICES; v++) {
        double weights[4], tangent[4], sum = 0;
        ffd_gltf_read(d, 4, v, 1, 4, weights);
        ffd_gltf_read(d, 2, v, 1, 4, tangent);
        for (size_t c = 0; c < 4; c++)
            sum += weights[c];
        largest = fmax(largest, weights[0]);
        if (fabs(sum - 1) > 1e-7 || weights[2] > 0.28)
            fail_msg("vertex %zu: %g %g %g %g", v, weights[0], weights[1], weights[2], weights[3]);
        const double length =
            sqrt(tangent[0] * tangent[0] + tangent[1] * tangent[1] + tangent[2] * tangent[2]);
        if (fabs(length - 1) > 0.0051 || fabs(tangent[3] - (v % 2 ? 1 : -1)) > 0 ||
            fabs(tangent[0] - cos(0.7 * (double)v)) > 0.05)
            fail_msg("vertex %zu: length %g, %g", v, length, tangent[3]);
    }
    assert_true(told > 0);
    /* The stated bounds are those of what is written. */
    const char *bounds = strstr(written, "\"type\":\"VEC4\",\"max\":[");
    double stated;
    assert_non_null(bounds);
    assert_int_equal(sscanf(bounds, "\"type\":\"VEC4\",\"max\":[%lf", &stated), 1);
    assert_true(fabs(stated - largest) < 1e-6);
    gltf->close(document);
    ffd_free(text);
    free(written);
}

/* What stays compressed keeps its bytes. */
static void what_stays_compressed_is_left(void **state)
{
    (void)state;
    char *texts[] = {make_coarse(), make_cases(SET_PRIMITIVE)};
    for (size_t t = 0; t < 2; t++) {
        mesh_document *document = open_text(texts[t]);
        assert_int_equal(deform(document, stay, false, NULL), FFD_OK);
        assert_int_equal(save_to(document, output, NULL), FFD_OK);
        gltf->close(document);
        char *written = load_text(output);
        assert_string_equal(written, texts[t]);
        free(written);
        ffd_free(texts[t]);
    }
}

static void memory_failures_are_reported(void **state)
{
    (void)state;
    char *texts[] = {make_coarse(), make_cases(SET_PRIMITIVE)};
    for (size_t t = 0; t < 2; t++) {
        ffd_status status = FFD_E_MEMORY;
        long successes = 0;
        for (; status == FFD_E_MEMORY && successes < 5000; successes++) {
            ffd_error error = {0};
            ffd_alloc_fail_after(successes);
            status = run_all(texts[t], strlen(texts[t]), "t.gltf", FFD_FORMAT_GLTF, FFD_SPACE_SCENE, add_one,
                             output, &error);
            ffd_alloc_fail_after(-1);
            assert_true(status == FFD_OK || status == FFD_E_MEMORY);
        }
        assert_int_equal(status, FFD_OK);
        ffd_free(texts[t]);
    }
}

static int begin(void **state)
{
    if (make_folder(state))
        return -1;
    snprintf(output, sizeof output, "%s/out.gltf", folder);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(weights_sum_to_one),
        cmocka_unit_test(joints_with_several_weights_are_left),
        cmocka_unit_test(shared_weights_are_mended_once),
        cmocka_unit_test(integers_sum_to_one_exactly),
        cmocka_unit_test(draco_is_valid_again),
        cmocka_unit_test(what_stays_compressed_is_left),
        cmocka_unit_test(memory_failures_are_reported),
    };
    return cmocka_run_group_tests(tests, begin, remove_folder);
}
