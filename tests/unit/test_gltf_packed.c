/* test_gltf_packed.c - glTF with geometry compressed by Draco or meshopt: read like plain data, written
   uncompressed where something changed and unchanged where nothing did. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/draco_sample.h"
#include "../support/gltf_file.h"
#include "../support/repetitions.h"
#include "../support/sheet.h"
#include "../support/test_folder.h"
#include "base/text/base64.h"
#include "io/gltf/read/gltf_elements.h"
#include "mesh/difference.h"
#include <meshoptimizer.h>

#define DRACO "KHR_draco_mesh_compression"
#define MESHOPT "EXT_meshopt_compression"
#define LISTS(names) "\"extensionsUsed\":[" names "],\"extensionsRequired\":[" names "]"

#define SIDE 5
#define POINTS (SIDE * SIDE)
#define TRIANGLES (2 * (SIDE - 1) * (SIDE - 1))

static char output[100];

/* A sheet of squares in the unit square of x and y. */
static float positions[3 * POINTS], normals[3 * POINTS];
static uint16_t joints[4 * POINTS];
static uint8_t factors[POINTS];
static uint32_t triangles[3 * TRIANGLES];

static void make_sheet(void)
{
    for (uint32_t i = 0; i < POINTS; i++) {
        const float position[3] = {(float)(i % SIDE) / 4, (float)(i / SIDE) / 4, 0.25f};
        const float normal[3] = {0, 0.6f, 0.8f};
        memcpy(positions + 3 * i, position, sizeof position);
        memcpy(normals + 3 * i, normal, sizeof normal);
        for (uint32_t c = 0; c < 4; c++)
            joints[4 * i + c] = (uint16_t)(i * 9 + c);
        factors[i] = (uint8_t)(i * 10);
    }
    sheet_triangles(SIDE, triangles);
}

/* Bytes of a buffer, with the JSON of their bufferViews. */
typedef struct blob {
    unsigned char bytes[16384];
    size_t size;
    byte_buffer views;
} blob;

/* Appends bytes at a multiple of 4. Returns their offset. */
static size_t put_aligned(blob *b, const void *bytes, size_t size)
{
    const size_t offset = (b->size + 3) / 4 * 4;
    assert_in_range(offset + size, 0, sizeof b->bytes);
    memset(b->bytes + b->size, 0, offset - b->size);
    memcpy(b->bytes + offset, bytes, size);
    b->size = offset + size;
    return offset;
}

static void add_view(blob *b, const void *bytes, size_t size)
{
    const size_t offset = put_aligned(b, bytes, size);
    ffd_buffer_format(&b->views, "%s{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu}",
                      b->views.size > 0 ? "," : "", offset, size);
}

/* Makes the JSON of a file. Buffer 0 is the blob, more_buffers follow it. Frees the blob's views. */
static char *make_text(blob *b, const char *more_buffers, const char *rest)
{
    byte_buffer text = {0};
    char *coded = calloc(ffd_base64_length(b->size) + 1, 1);
    ffd_base64_encode(b->bytes, b->size, coded);
    ffd_buffer_format(&text, "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":%zu,\"uri\":\"",
                      b->size);
    ffd_buffer_text(&text, "data:application/octet-stream;base64,");
    ffd_buffer_text(&text, coded);
    ffd_buffer_format(&text, "\"}%s],\"bufferViews\":[", more_buffers);
    ffd_buffer_append(&text, b->views.data, b->views.size);
    ffd_buffer_format(&text, "],");
    ffd_buffer_text(&text, rest);
    ffd_buffer_text(&text, "}");
    free(coded);
    ffd_buffer_free(&b->views);
    return ffd_buffer_finish(&text);
}

static void add_draco(blob *b, bool edgebreaker)
{
    const sample_mesh mesh = {POINTS, TRIANGLES, positions, normals, NULL,
                              joints, factors,   triangles, NULL,    NULL};
    const sample_options options = {.edgebreaker = edgebreaker, .bits = edgebreaker ? 14 : 0};
    size_t size;
    unsigned char *bytes = make_draco(&mesh, &options, &size);
    assert_non_null(bytes);
    add_view(b, bytes, size);
    free(bytes);
}

#define DRACO_ACCESSORS                                                                                      \
    "{\"componentType\":5123,\"count\":96,\"type\":\"SCALAR\",\"max\":[99]},"                                \
    "{\"componentType\":5126,\"count\":25,\"type\":\"VEC3\",\"min\":[0,0,0.2],\"max\":[1,1,0.3]},"           \
    "{\"componentType\":5126,\"count\":25,\"type\":\"VEC3\"},"                                               \
    "{\"componentType\":5123,\"count\":25,\"type\":\"VEC4\"},"                                               \
    "{\"componentType\":5121,\"normalized\":true,\"count\":25,\"type\":\"SCALAR\"}"
#define DRACO_EXTENSION(more)                                                                                \
    "\"extensions\":{" more "\"" DRACO "\":{\"bufferView\":0,\"attributes\":"                                \
    "{\"_FACTOR\":8,\"JOINTS_0\":300,\"NORMAL\":7,\"POSITION\":3}}}"
#define DRACO_ATTRIBUTES                                                                                     \
    "\"attributes\":{\"POSITION\":1,\"NORMAL\":2,\"JOINTS_0\":3,\"_FACTOR\":4},\"indices\":0"
#define DRACO_PRIMITIVE "{" DRACO_ATTRIBUTES "," DRACO_EXTENSION("") "}"
#define ONE_NODE "\"nodes\":[{\"mesh\":0}],\"scenes\":[{\"nodes\":[0]}]"
#define DRACO_REST "\"meshes\":[{\"primitives\":[" DRACO_PRIMITIVE "]}]," ONE_NODE

static char *make_draco_text(bool edgebreaker, const char *accessors, const char *rest)
{
    static blob b;
    b = (blob){.size = 0};
    add_draco(&b, edgebreaker);
    byte_buffer text = {0};
    ffd_buffer_text(&text, LISTS("\"" DRACO "\"") ",\"accessors\":[");
    ffd_buffer_text(&text, accessors);
    ffd_buffer_text(&text, "],");
    ffd_buffer_text(&text, rest);
    char *finished = ffd_buffer_finish(&text), *made = make_text(&b, "", finished);
    ffd_free(finished);
    return made;
}

static mesh_document *open_text(const char *text)
{
    mesh_document *document = NULL;
    ffd_error error = {0};
    if (open_bytes(text, strlen(text), "t.gltf", FFD_FORMAT_GLTF, FFD_SPACE_SCENE, &document, &error))
        fail_msg("%s %s", error.pointer, error.message);
    return document;
}

static size_t log_count;

static void count_line(void *user, ffd_log_level level, const char *line)
{
    (void)user;
    assert_non_null(strstr(line, " written uncompressed "));
    log_count += level == FFD_LOG_INFO;
}

/* Deforms a file into `output` and returns its text. *lines: the number of log lines about decompression. */
static char *run_text(const char *text, mover move, size_t *lines)
{
    mesh_document *document = open_text(text);
    const mesh_save_options options = {.path = output, .force = true};
    const mesh_log log = {count_line, NULL};
    ffd_error error = {0};
    log_count = 0;
    if (gltf->check(document, &error) || deform(document, move, true, &error) ||
        save_with(document, &options, &log, &error))
        fail_msg("%s %s", error.pointer, error.message);
    gltf->close(document);
    *lines = log_count;
    return load_text(output);
}

/* Likewise without normals and tangents, ignoring the log. */
static char *run_positions(const char *text, mover move)
{
    mesh_document *document = open_text(text);
    assert_int_equal(deform(document, move, false, NULL), FFD_OK);
    assert_int_equal(save_to(document, output, NULL), FFD_OK);
    gltf->close(document);
    return load_text(output);
}

/* Compares the first `components` of all elements of an accessor with floats, with the quantization
   `step`. */
static void check_values(const mesh_document *document, size_t accessor, size_t components, size_t step,
                         const float *wanted, double tolerance, double added)
{
    const gltf_document *d = ffd_gltf_of(document);
    const size_t count = (size_t)d->model.accessors[accessor].count;
    for (size_t i = 0; i < count; i++) {
        double values[16];
        ffd_gltf_read(d, accessor, i, 1, components, values);
        for (size_t c = 0; c < components; c++) {
            const double difference = values[c] - (double)wanted[step * i + c] - (c == 0 ? added : 0);
            if (!(difference <= tolerance && difference >= -tolerance))
                fail_msg("accessor %zu element %zu component %zu: %g", accessor, i, c, values[c]);
        }
    }
}

/* Checks what the deformation must not change. */
static void check_unchanged(const mesh_document *document)
{
    const gltf_document *d = ffd_gltf_of(document);
    for (size_t i = 0; i < 3 * TRIANGLES; i++) {
        double index;
        ffd_gltf_read(d, 0, i, 1, 1, &index);
        assert_int_equal((uint32_t)index, triangles[i]);
    }
    for (size_t i = 0; i < POINTS; i++) {
        double joint[4], factor;
        ffd_gltf_read(d, 3, i, 1, 4, joint);
        ffd_gltf_read(d, 4, i, 1, 1, &factor);
        for (size_t c = 0; c < 4; c++)
            assert_int_equal((uint32_t)joint[c], joints[4 * i + c]);
        assert_true(factor * 255 > factors[i] - 0.1 && factor * 255 < factors[i] + 0.1);
    }
}

static void draco_is_read_as_plain_data_is(void **state)
{
    (void)state;
    char *text = make_draco_text(false, DRACO_ACCESSORS, DRACO_REST);
    mesh_document *document = open_text(text);
    mesh_faces faces = {0};
    assert_int_equal(gltf->check(document, NULL), FFD_OK);
    assert_int_equal(document->part_count, 1);
    assert_int_equal(document->parts[0].vertex_count, POINTS);
    assert_int_equal(document->parts[0].normal_count, POINTS);
    check_values(document, 1, 3, 3, positions, 0, 0);
    check_values(document, 2, 3, 3, normals, 0, 0);
    check_unchanged(document);
    assert_int_equal(gltf->faces(document, MESH_STORED, &faces, NULL), FFD_OK);
    assert_int_equal(faces.face_count, TRIANGLES);
    assert_memory_equal(faces.corners, triangles, sizeof triangles);
    ffd_mesh_faces_free(&faces);
    gltf->close(document);
    ffd_free(text);
}

static void check_kept(const char *text)
{
    char *written = run_positions(text, stay);
    assert_string_equal(written, text);
    free(written);
}

static void nothing_moved_gives_the_same_bytes(void **state)
{
    (void)state;
    size_t lines;
    char *text = make_draco_text(true, DRACO_ACCESSORS, DRACO_REST);
    check_kept(text);
    char *written = run_text(text, move_far, &lines); /* nothing is far away, so only normals change */
    assert_int_equal(lines, 1);
    free(written);
    check_kept(text);
    ffd_free(text);
}

static void a_moved_draco_primitive_is_written_uncompressed(void **state)
{
    (void)state;
    size_t lines;
    char *text = make_draco_text(false, DRACO_ACCESSORS, DRACO_REST);
    char *written = run_text(text, add_one, &lines);
    assert_int_equal(lines, 1);
    assert_null(strstr(written, "extensions")); /* neither the lists nor the object */
    /* Bounds of decompressed accessors are those of the decoded numbers. */
    assert_non_null(strstr(
        written, "{\"bufferView\":5,\"componentType\":5123,\"count\":96,\"type\":\"SCALAR\",\"max\":[24]}"));
    assert_non_null(strstr(written, "\"min\":[1,0,0.25],\"max\":[2,1,0.25]"));
    assert_non_null(strstr(written, "\"byteStride\":4,\"target\":34962")); /* bytes, 4 apart */
    mesh_document *document = open_text(written);
    assert_int_equal(ffd_gltf_of(document)->model.accessor_count, 5);
    check_values(document, 1, 3, 3, positions, 0, 1);
    const float turned[3] = {0.6f, 0.8f, 0};
    check_values(document, 2, 3, 0, turned, 0, 0);
    check_unchanged(document);
    gltf->close(document);
    free(written);
    ffd_free(text);
}

static void other_draco_primitives_stay_compressed(void **state)
{
    (void)state;
    /* The second mesh is a copy with accessors of its own, and far away. */
    char *text = make_draco_text(false, DRACO_ACCESSORS "," DRACO_ACCESSORS,
                                 "\"meshes\":[{\"primitives\":[" DRACO_PRIMITIVE
                                 "]},{\"primitives\":[{\"attributes\":{\"POSITION\":6},"
                                 "\"indices\":5,\"extensions\":{\"" DRACO
                                 "\":{\"attributes\":{\"POSITION\":3},\"bufferView\":0},\"X_y\":1}}]}],"
                                 "\"nodes\":[{\"mesh\":0},{\"mesh\":1,\"translation\":[20,0,0]}]");
    char *written = run_positions(text, move_far);
    assert_non_null(strstr(written, LISTS("\"" DRACO "\"")));
    assert_non_null(strstr(written, "[" DRACO_PRIMITIVE "]"));
    assert_non_null(strstr(written, "\"indices\":5,\"extensions\":{\"X_y\":1}}"));
    mesh_document *document = open_text(written);
    check_values(document, 1, 3, 3, positions, 0, 0);
    check_values(document, 6, 3, 3, positions, 0, 1);
    gltf->close(document);
    free(written);
    ffd_free(text);
}

/* One compressed mesh under two nodes, one of them far away: only the copy is decompressed. */
static void a_copy_of_a_draco_mesh_is_uncompressed(void **state)
{
    (void)state;
    char *text =
        make_draco_text(false, DRACO_ACCESSORS,
                        "\"meshes\":[{\"primitives\":[" DRACO_PRIMITIVE "]}],\"nodes\":[{\"mesh\":0},"
                        "{\"mesh\":0,\"translation\":[20,0,0]}]");
    char *written = run_positions(text, move_far);
    assert_non_null(strstr(written, "[" DRACO_PRIMITIVE "]"));
    assert_non_null(strstr(written,
                           "{\"primitives\":[{\"attributes\":{\"POSITION\":5,\"NORMAL\":2,\"JOINTS_0\":3,"
                           "\"_FACTOR\":4},\"indices\":0}]}"));
    assert_non_null(strstr(written, LISTS("\"" DRACO "\"")));
    mesh_document *document = open_text(written);
    assert_int_equal(gltf->check(document, NULL), FFD_OK);
    check_values(document, 1, 3, 3, positions, 0, 0);
    check_values(document, 5, 3, 3, positions, 0, 1);
    check_unchanged(document);
    gltf->close(document);
    free(written);
    ffd_free(text);
}

typedef struct refusal {
    const char *accessors, *rest, *pointer, *message;
    ffd_status status;
} refusal;

static void draco_that_cannot_be_is_refused(void **state)
{
    (void)state;
#define WITH(primitives) "\"meshes\":[{\"primitives\":[" primitives "]}]," ONE_NODE
#define POSITION_ONLY(attributes, more)                                                                      \
    "{\"attributes\":{\"POSITION\":1}," more "\"extensions\":{\"" DRACO "\":{\"bufferView\":0,"              \
    "\"attributes\":{" attributes "}}}}"
    static const refusal cases[] = {
        {DRACO_ACCESSORS, WITH("{\"attributes\":{\"POSITION\":1},\"extensions\":{\"" DRACO "\":{}}}"),
         "/meshes/0/primitives/0/extensions/" DRACO, "\"bufferView\" is missing", FFD_E_INVALID},
        {DRACO_ACCESSORS,
         WITH("{\"attributes\":{\"POSITION\":1},\"extensions\":{\"" DRACO
              "\":{\"bufferView\":7,\"attributes\":{}}}}"),
         "/meshes/0/primitives/0/extensions/" DRACO "/bufferView", "the bufferView does not exist",
         FFD_E_INVALID},
        {DRACO_ACCESSORS, WITH(POSITION_ONLY("\"NORMAL\":7", "")),
         "/meshes/0/primitives/0/extensions/" DRACO "/attributes/NORMAL",
         "the primitive has no such attribute", FFD_E_INVALID},
        {DRACO_ACCESSORS, WITH(POSITION_ONLY("\"POSITION\":4", "")),
         "/meshes/0/primitives/0/extensions/" DRACO "/attributes/POSITION",
         "the Draco data has no attribute 4", FFD_E_INVALID},
        {DRACO_ACCESSORS, WITH(POSITION_ONLY("\"POSITION\":300", "")),
         "/meshes/0/primitives/0/extensions/" DRACO "/attributes/POSITION",
         "attribute 300 of the Draco data has 4 components, its accessor has 3", FFD_E_INVALID},
        {"{\"componentType\":5123,\"count\":93,\"type\":\"SCALAR\"},"
         "{\"componentType\":5126,\"count\":25,\"type\":\"VEC3\"}",
         WITH(POSITION_ONLY("\"POSITION\":3", "\"indices\":0,")), "/meshes/0/primitives/0/extensions/" DRACO,
         "the Draco data's count of triangles is 32, that of its indices 93", FFD_E_INVALID},
        {"{\"componentType\":5123,\"count\":96,\"type\":\"SCALAR\"},"
         "{\"componentType\":5126,\"count\":4294967295,\"type\":\"VEC3\"}",
         WITH(POSITION_ONLY("\"POSITION\":3", "\"indices\":0,")), "/meshes/0/primitives/0/extensions/" DRACO,
         "the Draco data's count of points is 25, that of its accessors 4294967295", FFD_E_INVALID},
        {DRACO_ACCESSORS, WITH(POSITION_ONLY("\"POSITION\":3", "\"indices\":0,\"mode\":5,")),
         "/meshes/0/primitives/0/extensions/" DRACO,
         "indices of mode 5 compressed by Draco are not supported, only triangles", FFD_E_UNSUPPORTED},
        /* Accessor 1 comes from Draco data in one primitive, and is zeros in another. */
        {DRACO_ACCESSORS, WITH(DRACO_PRIMITIVE ",{\"attributes\":{\"POSITION\":1}}"), "/accessors/1",
         "primitives read different values for the accessor, from Draco data and from elsewhere: this is not "
         "supported",
         FFD_E_UNSUPPORTED},
        /* Used as positions in one primitive, as normals in another. */
        {DRACO_ACCESSORS, WITH(POSITION_ONLY("\"POSITION\":3", "") "," POSITION_ONLY("\"POSITION\":7", "")),
         "/accessors/1",
         "primitives read different values for the accessor, from Draco data and from elsewhere: this is not "
         "supported",
         FFD_E_UNSUPPORTED},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char *text = make_draco_text(false, cases[i].accessors, cases[i].rest);
        mesh_document *document = NULL;
        ffd_error error = {0};
        ffd_status status =
            open_bytes(text, strlen(text), "t.gltf", FFD_FORMAT_GLTF, FFD_SPACE_SCENE, &document, &error);
        if (status == FFD_OK)
            status = gltf->check(document, &error);
        assert_string_equal(error.message, cases[i].message);
        assert_string_equal(error.pointer, cases[i].pointer);
        assert_int_equal(status, cases[i].status);
        gltf->close(document);
        ffd_free(text);
    }
}

/* Points without indices use the accessors they name. */
static void draco_points_are_read(void **state)
{
    (void)state;
    size_t lines;
    char *text =
        make_draco_text(false, DRACO_ACCESSORS, WITH(POSITION_ONLY("\"POSITION\":3", "\"mode\":0,")));
    char *written = run_text(text, add_one, &lines);
    mesh_document *document = open_text(written);
    assert_int_equal(lines, 1);
    check_values(document, 1, 3, 3, positions, 0, 1);
    gltf->close(document);
    free(written);
    ffd_free(text);
}

/* Two compressed views: interleaved positions and normals, and indices. A plain view: factors. Views 0 and 1
   are in buffer 1, which has no bytes. */
static char *make_meshopt_text(const char *extension, const char *fallback, const char *rest)
{
    static blob b;
    unsigned char vertices[24 * POINTS], bytes[4096];
    b = (blob){.size = 0};
    for (size_t i = 0; i < POINTS; i++) {
        memcpy(vertices + 24 * i, positions + 3 * i, 12);
        memcpy(vertices + 24 * i + 12, normals + 3 * i, 12);
    }
    size_t size = meshopt_encodeVertexBuffer(bytes, sizeof bytes, vertices, POINTS, 24);
    const size_t first = put_aligned(&b, bytes, size);
    ffd_buffer_format(
        &b.views,
        "{\"buffer\":1,\"byteLength\":600,\"byteStride\":24,\"target\":34962,\"extensions\":{\"%s\":"
        "{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu,\"byteStride\":24,\"mode\":"
        "\"ATTRIBUTES\",\"count\":25}}},",
        extension, first, size);
    size = meshopt_encodeIndexSequence(bytes, sizeof bytes, triangles, 3 * TRIANGLES);
    const size_t second = put_aligned(&b, bytes, size);
    ffd_buffer_format(
        &b.views,
        "{\"buffer\":1,\"byteOffset\":600,\"byteLength\":192,\"target\":34963,\"extensions\":{\"%s\":"
        "{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu,\"byteStride\":2,\"mode\":"
        "\"INDICES\",\"filter\":\"NONE\",\"count\":96}}}",
        extension, second, size);
    add_view(&b, factors, sizeof factors);
    return make_text(&b, fallback, rest);
}

#define FALLBACK ",{\"byteLength\":792,\"extensions\":{\"" MESHOPT "\":{\"fallback\":true}}}"
#define MESHOPT_ACCESSORS                                                                                    \
    "\"accessors\":[{\"bufferView\":1,\"componentType\":5123,\"count\":96,\"type\":\"SCALAR\"},"             \
    "{\"bufferView\":0,\"componentType\":5126,\"count\":25,\"type\":\"VEC3\",\"min\":[0,0,0.25],"            \
    "\"max\":[1,1,0.25]},{\"bufferView\":0,\"byteOffset\":12,\"componentType\":5126,\"count\":25,"           \
    "\"type\":\"VEC3\"},{\"bufferView\":2,\"componentType\":5121,\"count\":25,\"type\":\"SCALAR\"}]"
#define MESHOPT_MESH                                                                                         \
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":1,\"NORMAL\":2,\"_FACTOR\":3},\"indices\":"  \
    "0}]}]"
#define MESHOPT_REST LISTS("\"" MESHOPT "\"") "," MESHOPT_ACCESSORS "," MESHOPT_MESH "," ONE_NODE

static void meshopt_is_read_as_plain_data_is(void **state)
{
    (void)state;
    static const char *const names[] = {MESHOPT, "KHR_meshopt_compression"};
    for (size_t n = 0; n < 2; n++) {
        char *text = make_meshopt_text(names[n], FALLBACK, MESHOPT_REST);
        mesh_document *document = open_text(text);
        mesh_faces faces = {0};
        assert_int_equal(gltf->check(document, NULL), FFD_OK);
        check_values(document, 1, 3, 3, positions, 0, 0);
        check_values(document, 2, 3, 3, normals, 0, 0);
        assert_int_equal(gltf->faces(document, MESH_STORED, &faces, NULL), FFD_OK);
        assert_memory_equal(faces.corners, triangles, sizeof triangles);
        ffd_mesh_faces_free(&faces);
        gltf->close(document);
        ffd_free(text);
    }
}

static void a_changed_meshopt_view_is_written_uncompressed(void **state)
{
    (void)state;
    size_t lines;
    char *text = make_meshopt_text(MESHOPT, FALLBACK, MESHOPT_REST);
    char *written = run_text(text, add_one, &lines);
    assert_int_equal(lines, 1);
    /* The other view, its buffer and the lists keep the extension. This view keeps its other members. */
    const char *view = strstr(
        written, "\"bufferViews\":[{\"buffer\":0,\"byteLength\":600,\"byteStride\":24,\"target\":34962}");
    assert_null(view); /* its byteOffset is no longer 0 */
    assert_non_null(
        strstr(written, ",\"buffer\":0,\"byteLength\":600,\"byteStride\":24,\"target\":34962},{\"buffer\":1,"
                        "\"byteOffset\":600,"));
    assert_non_null(strstr(written, FALLBACK));
    assert_non_null(strstr(written, LISTS("\"" MESHOPT "\"")));
    assert_non_null(strstr(written, "\"min\":[1,0,0.25],\"max\":[2,1,0.25]"));
    mesh_document *document = open_text(written);
    assert_int_equal(ffd_gltf_of(document)->model.accessor_count, 4);
    assert_int_equal(ffd_gltf_of(document)->model.view_count, 3);
    check_values(document, 1, 3, 3, positions, 0, 1);
    const float turned[3] = {0.6f, 0.8f, 0};
    check_values(document, 2, 3, 0, turned, 0, 0);
    mesh_faces faces = {0};
    assert_int_equal(gltf->faces(document, MESH_STORED, &faces, NULL), FFD_OK);
    assert_memory_equal(faces.corners, triangles, sizeof triangles);
    ffd_mesh_faces_free(&faces);
    gltf->close(document);
    free(written);
    ffd_free(text);
}

/* Once no compressed indices and no marked buffer are left, nothing needs the extension. */
static void the_last_meshopt_view_takes_the_extension_along(void **state)
{
    (void)state;
    size_t lines;
    char *text = make_meshopt_text(MESHOPT, ",{\"byteLength\":792}", MESHOPT_REST);
    char *second = strstr(text, ",{\"buffer\":1,\"byteOffset\":600"),
         *behind = strstr(text, ",{\"buffer\":0,\"byteOffset\":");
    while (behind && behind < second)
        behind = strstr(behind + 1, ",{\"buffer\":0,\"byteOffset\":");
    assert_true(second && behind);
    memset(second, ' ', (size_t)(behind - second)); /* removes the view of the indices */
    char *indices = strstr(text, "\"bufferView\":1");
    assert_non_null(indices);
    indices[strlen("\"bufferView\":")] = '2';
    char *count = strstr(indices, "5123,\"count\":96");
    assert_non_null(count);
    memcpy(count, "5121,\"count\":24", strlen("5121,\"count\":24"));
    char *factor = strstr(text, "{\"bufferView\":2,\"componentType\":5121,\"count\":25");
    assert_non_null(factor);
    factor[strlen("{\"bufferView\":")] = '1';
    indices[strlen("\"bufferView\":")] = '1';
    /* The bytes are now not indices of 25 vertices. */
    char *use = strstr(text, ",\"indices\":0");
    assert_non_null(use);
    memset(use, ' ', strlen(",\"indices\":0"));
    char *written = run_text(text, add_one, &lines);
    assert_int_equal(lines, 1);
    assert_null(strstr(written, "extensions"));
    free(written);
    ffd_free(text);
}

static void meshopt_that_cannot_be_is_refused(void **state)
{
    (void)state;
    /* the text to replace, its replacement (of equal length), the message */
    static const struct {
        const char *old, *new, *pointer, *message;
        ffd_status status;
    } cases[] = {
        {"\"mode\":\"ATTRIBUTES\"", "\"mode\":\"ATTRIBUTEZ\"", "/bufferViews/0/extensions/" MESHOPT "/mode",
         "only the modes ATTRIBUTES, TRIANGLES and INDICES are known", FFD_E_UNSUPPORTED},
        {"\"filter\":\"NONE\"", "\"filter\":\"NINE\"", "/bufferViews/1/extensions/" MESHOPT "/filter",
         "only the filters NONE, OCTAHEDRAL, QUATERNION, EXPONENTIAL and COLOR are known", FFD_E_UNSUPPORTED},
        {"\"count\":25}}}", "\"count\":24}}}", "/bufferViews/0/extensions/" MESHOPT,
         "count 24 times byteStride 24 is not the bufferView's byteLength 600", FFD_E_INVALID},
        {"\"count\":25}}}", "\"count\":-1}}}", "/bufferViews/0/extensions/" MESHOPT "/count",
         "an integer from 0 to 2^53 is expected, not -1", FFD_E_INVALID},
        {"\"byteStride\":24,\"mode\"", "\"byteStride\":21,\"mode\"", "/bufferViews/0/extensions/" MESHOPT,
         "byteStride 21 is not allowed with mode ATTRIBUTES", FFD_E_INVALID},
        {"{\"buffer\":0,\"byteOffset\":0,", "{\"buffer\":1,\"byteOffset\":0,",
         "/bufferViews/0/extensions/" MESHOPT "/buffer", "the buffer does not exist or has no bytes",
         FFD_E_INVALID},
        {"{\"buffer\":0,\"byteOffset\":0,", "{\"buffer\":0,\"byteOffset\":9,",
         "/bufferViews/0/extensions/" MESHOPT, "the compressed data is not of mode ATTRIBUTES",
         FFD_E_INVALID},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char *text = make_meshopt_text(MESHOPT, FALLBACK, MESHOPT_REST);
        char *at = strstr(text, cases[i].old);
        mesh_document *document = NULL;
        ffd_error error = {0};
        assert_non_null(at);
        memcpy(at, cases[i].new, strlen(cases[i].new));
        ffd_status status =
            open_bytes(text, strlen(text), "t.gltf", FFD_FORMAT_GLTF, FFD_SPACE_SCENE, &document, &error);
        if (status == FFD_OK)
            status = gltf->check(document, &error);
        if (status == FFD_OK) { /* indices are not read before faces are needed */
            mesh_faces faces = {0};
            status = gltf->faces(document, MESH_STORED, &faces, &error);
            ffd_mesh_faces_free(&faces);
        }
        assert_string_equal(error.message, cases[i].message);
        assert_string_equal(error.pointer, cases[i].pointer);
        assert_int_equal(status, cases[i].status);
        gltf->close(document);
        ffd_free(text);
    }
}

static void check_comparison(const char *first, const char *second, double tolerance, bool equal,
                             const char *difference)
{
    mesh_document *a = open_text(first), *b = open_text(second);
    ffd_comparison comparison = {.struct_size = sizeof comparison};
    ffd_difference_begin(&comparison, tolerance, 0);
    assert_int_equal(gltf->compare(a, b, &comparison, NULL), FFD_OK);
    assert_string_equal(comparison.first.text, difference);
    assert_int_equal(comparison.equal, equal);
    gltf->close(a);
    gltf->close(b);
}

/* Sheets of equal size that differ in one number. */
static void compressed_data_is_compared_as_what_it_becomes(void **state)
{
    (void)state;
    const char *rest = WITH(DRACO_PRIMITIVE);
    char *texts[3], *views[3];
    texts[0] = make_draco_text(false, DRACO_ACCESSORS, rest);
    views[0] = make_meshopt_text(MESHOPT, FALLBACK, MESHOPT_REST);
    positions[3 * 7] += 0.125f;
    texts[1] = make_draco_text(false, DRACO_ACCESSORS, rest);
    views[1] = make_meshopt_text(MESHOPT, FALLBACK, MESHOPT_REST);
    positions[3 * 7] -= 0.125f;
    normals[3 * 7 + 2] += 0.125f;
    texts[2] = make_draco_text(false, DRACO_ACCESSORS, rest);
    views[2] = make_meshopt_text(MESHOPT, FALLBACK, MESHOPT_REST);
    normals[3 * 7 + 2] -= 0.125f;
    for (int i = 0; i < 3; i++)
        check_comparison(texts[i], texts[i], 0, true, "");
    check_comparison(texts[0], texts[1], 0, false, "/accessors/1: vertex 7: x differs by 0.125");
    check_comparison(texts[0], texts[1], 0.2, true, "");
    check_comparison(texts[0], texts[2], 0.2, false,
                     "/accessors/2: element 7: z of the normal differs by 0.125");
    for (int i = 0; i < 3; i++)
        check_comparison(views[i], views[i], 0, true, "");
    for (int i = 0; i < 3; i++) {
        ffd_free(texts[i]);
        ffd_free(views[i]);
    }
}

/* Many views of the same few bytes: their total decoded size is limited. */
static void many_views_of_the_same_bytes_are_too_much(void **state)
{
    (void)state;
    enum { VIEWS = 800, COUNT = 40000 };
    static blob b;
    b = (blob){.size = 0};
    static float zeros[COUNT];
    unsigned char bytes[4096];
    const size_t size = meshopt_encodeVertexBuffer(bytes, sizeof bytes, zeros, COUNT, 4);
    assert_in_range(size, 1, sizeof bytes);
    put_aligned(&b, bytes, size);
    for (size_t i = 0; i < VIEWS; i++)
        ffd_buffer_format(&b.views,
                          "%s{\"buffer\":1,\"byteLength\":160000,\"extensions\":{\"" MESHOPT
                          "\":{\"buffer\":0,"
                          "\"byteLength\":%zu,\"byteStride\":4,\"mode\":\"ATTRIBUTES\",\"count\":40000}}}",
                          i ? "," : "", size);
    char *text = make_text(&b, ",{\"byteLength\":160000}", "\"nodes\":[]");
    mesh_document *document = NULL;
    ffd_error error = {0};
    assert_int_equal(
        open_bytes(text, strlen(text), "t.gltf", FFD_FORMAT_GLTF, FFD_SPACE_SCENE, &document, &error),
        FFD_E_LIMIT);
    assert_non_null(strstr(error.message, "needs more than the 10"));
    gltf->close(document);
    ffd_free(text);
}

/* Draco data of a sheet with this many points a side. Free it with free(). */
static unsigned char *make_large_draco(uint32_t side, size_t *size)
{
    const size_t points = (size_t)side * side;
    float *const xyz = calloc(3 * points, sizeof *xyz);
    uint32_t *const corners = calloc(6 * points, sizeof *corners);
    for (size_t i = 0; i < points; i++) {
        xyz[3 * i] = (float)(i % side);
        xyz[3 * i + 1] = (float)(i / side);
    }
    sheet_triangles(side, corners);
    const sample_mesh mesh = {.point_count = points,
                              .triangle_count = 2 * (size_t)(side - 1) * (side - 1),
                              .positions = xyz,
                              .triangles = corners};
    unsigned char *const bytes = make_draco(&mesh, &(sample_options){.edgebreaker = true, .bits = 6}, size);
    free(xyz);
    free(corners);
    return bytes;
}

/* Many views of the same Draco data, each with a primitive that uses none of it. Each would be decoded. */
static void the_same_draco_data_is_decoded_too_often(void **state)
{
    (void)state;
    if (is_under_valgrind()) /* Draco's decoder takes nearly all of the time */
        skip();
    enum { LARGE = 120, VIEWS = 300 };
    static blob b;
    byte_buffer rest = {0};
    size_t size;
    unsigned char *const bytes = make_large_draco(LARGE, &size);
    b = (blob){.size = 0};
    put_aligned(&b, bytes, size);
    ffd_buffer_format(&rest,
                      LISTS("\"" DRACO "\"") ",\"nodes\":[{\"mesh\":0}],\"accessors\":[{"
                                             "\"componentType\":5126,\"count\":%d,\"type\":\"VEC3\",\"min\":"
                                             "[0,0,0],\"max\":[0,0,0]}],\"meshes\":[{\"primitives\":[",
                      LARGE * LARGE);
    for (size_t i = 0; i < VIEWS; i++) {
        ffd_buffer_format(&b.views, "%s{\"buffer\":0,\"byteLength\":%zu}", i ? "," : "", size);
        ffd_buffer_format(&rest,
                          "%s{\"attributes\":{\"POSITION\":0},\"extensions\":{\"" DRACO
                          "\":{\"bufferView\":%zu,\"attributes\":{}}}}",
                          i ? "," : "", i);
    }
    ffd_buffer_text(&rest, "]}]");
    char *const finished = ffd_buffer_finish(&rest), *const text = make_text(&b, "", finished);
    mesh_document *document = NULL;
    ffd_error error = {0};
    assert_int_equal(
        open_bytes(text, strlen(text), "t.gltf", FFD_FORMAT_GLTF, FFD_SPACE_SCENE, &document, &error),
        FFD_E_LIMIT);
    assert_string_equal(error.message, "the file's Draco data would be decoded too many times");
    ffd_free(finished);
    ffd_free(text);
    free(bytes);
}

static void memory_failures_are_reported(void **state)
{
    (void)state;
    char *texts[] = {make_draco_text(true, DRACO_ACCESSORS, WITH(DRACO_PRIMITIVE)),
                     make_meshopt_text(MESHOPT, FALLBACK, MESHOPT_REST)};
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
        assert_in_range(successes, 50, 5000);
        ffd_free(texts[t]);
    }
}

static int begin(void **state)
{
    if (make_folder(state))
        return -1;
    make_sheet();
    snprintf(output, sizeof output, "%s/out.gltf", folder);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(draco_is_read_as_plain_data_is),
        cmocka_unit_test(nothing_moved_gives_the_same_bytes),
        cmocka_unit_test(a_moved_draco_primitive_is_written_uncompressed),
        cmocka_unit_test(other_draco_primitives_stay_compressed),
        cmocka_unit_test(a_copy_of_a_draco_mesh_is_uncompressed),
        cmocka_unit_test(draco_that_cannot_be_is_refused),
        cmocka_unit_test(draco_points_are_read),
        cmocka_unit_test(meshopt_is_read_as_plain_data_is),
        cmocka_unit_test(a_changed_meshopt_view_is_written_uncompressed),
        cmocka_unit_test(the_last_meshopt_view_takes_the_extension_along),
        cmocka_unit_test(meshopt_that_cannot_be_is_refused),
        cmocka_unit_test(compressed_data_is_compared_as_what_it_becomes),
        cmocka_unit_test(many_views_of_the_same_bytes_are_too_much),
        cmocka_unit_test(the_same_draco_data_is_decoded_too_often),
        cmocka_unit_test(memory_failures_are_reported),
    };
    return cmocka_run_group_tests(tests, begin, remove_folder);
}
