/* test_gltf.c - reading glTF: invalid and unsupported files, parts, faces. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/gltf_file.h"
#include "base/file/path.h"
#include "base/text/base64.h"
#include "io/gltf/file/gltf_uri.h"
#include "io/gltf/read/gltf_model.h"
#include <stdlib.h>
#include <unistd.h>

#define ASSET "\"asset\":{\"version\":\"2.0\"}"
/* 36 bytes: the triangle (0,0,0) (1,0,0) (0,1,0). */
#define TRIANGLE "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"
#define BUFFERS                                                                                              \
    "\"buffers\":[{\"byteLength\":36,\"uri\":\"data:application/octet-stream;base64," TRIANGLE "\"}]"
#define VIEWS "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}]"
#define TRIANGLE_BOUNDS "\"min\":[-9,-9,-9],\"max\":[9,9,9]"
#define ACCESSORS                                                                                            \
    "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"," TRIANGLE_BOUNDS \
    "}]"
#define MESHES "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}]"
#define SCENE "\"nodes\":[{\"mesh\":0}],\"scenes\":[{\"nodes\":[0]}]"
#define DATA ASSET "," BUFFERS "," VIEWS
#define FILE_TEXT "{" DATA "," ACCESSORS "," MESHES "," SCENE "}"

/* Message and status of a size of 2^53: a program with addresses of 32 bits refuses the member itself. */
#if SIZE_MAX > UINT32_MAX
#define OF_2_53(message, status, member) message, status
#else
#define OF_2_53(message, status, member)                                                                     \
    member "9007199254740992 is more than the 4294967295 that a program with addresses of 32 bits holds",    \
        FFD_E_LIMIT
#endif

static ffd_status open_text(const char *text, ffd_space space, mesh_document **document, ffd_error *error)
{
    return open_bytes(text, strlen(text), "t.gltf", FFD_FORMAT_GLTF, space, document, error);
}

typedef struct refusal {
    const char *text, *message;
    ffd_status status;
} refusal;

static void check_refusals(const refusal *cases, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        mesh_document *document = NULL;
        ffd_error error = {0};
        char line[1024];
        ffd_status status = open_text(cases[i].text, FFD_SPACE_SCENE, &document, &error);
        if (status == FFD_OK)
            status = gltf->check(document, &error);
        if (status == FFD_OK)
            status = gltf->begin_results(document, &(mesh_results){.directions = true}, &error);
        ffd_error_format(&error, line, sizeof line);
        assert_string_equal(line, cases[i].message);
        assert_int_equal(status, cases[i].status);
        gltf->close(document);
    }
}

static const refusal broken_values[] = {
    {"[]", "t.gltf: is not glTF: the JSON is not an object", FFD_E_INVALID},
    {"{}", "t.gltf:1: \"asset\" is missing", FFD_E_INVALID},
    {"{\"asset\":{\"version\":\"1.0\"}}",
     "t.gltf:1: /asset/version: glTF version \"1.0\" is not known, only 2", FFD_E_UNSUPPORTED},
    {"{" ASSET ",\"nodes\":{}}", "t.gltf:1: /nodes: an array of objects is expected, not {}", FFD_E_INVALID},
    {"{" ASSET ",\"nodes\":[3]}", "t.gltf:1: /nodes/0: an object is expected, not 3", FFD_E_INVALID},
    {"{" ASSET ",\"nodes\":[{\"mesh\":-1}]}",
     "t.gltf:1: /nodes/0/mesh: an integer from 0 to 2147483647 is expected, not -1", FFD_E_INVALID},
    {"{" ASSET ",\"nodes\":[{\"mesh\":0.5}]}",
     "t.gltf:1: /nodes/0/mesh: an integer from 0 to 2147483647 is expected, not 0.5", FFD_E_INVALID},
    {"{" ASSET ",\"nodes\":[{\"mesh\":4294967296}]}",
     "t.gltf:1: /nodes/0/mesh: an integer from 0 to 2147483647 is expected, not 4294967296", FFD_E_INVALID},
    {"{" ASSET ",\"nodes\":[{\"mesh\":0}]}", "t.gltf:1: /nodes/0/mesh: there is no mesh 0: the file has none",
     FFD_E_INVALID},
    {"{" ASSET ",\"nodes\":[{\"scale\":[1,2]}]}", "t.gltf:1: /nodes/0/scale: 3 numbers are expected, not 2",
     FFD_E_INVALID},
    {"{" ASSET ",\"nodes\":[{\"scale\":[1,2,1e999]}]}",
     "t.gltf:1: /nodes/0/scale/2: a finite number is expected, not 1e999", FFD_E_INVALID},
    {"{" ASSET ",\"nodes\":[{\"matrix\":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,2]}]}",
     "t.gltf:1: /nodes/0/matrix: the matrix's last row is 0 0 0 2, not 0 0 0 1", FFD_E_INVALID},
    {"{" ASSET ",\"nodes\":[{\"children\":[1]},{\"children\":[0]}]}",
     "t.gltf:1: /nodes/0: the node is its own ancestor, or below one that is", FFD_E_INVALID},
    {"{" ASSET ",\"nodes\":[{\"children\":[1,2]},{\"children\":[2]},{}]}",
     "t.gltf:1: /nodes/2: the node is a child of both node 0 and node 1", FFD_E_INVALID},
    {"{" ASSET ",\"nodes\":[{\"children\":[7]}]}", "t.gltf:1: /nodes/0/children: there is no node 7, only 1",
     FFD_E_INVALID},
    {"{" ASSET ",\"nodes\":[{\"scale\":[1e300,1,1],\"children\":[1]},{\"scale\":[1e300,1,1]}]}",
     "t.gltf:1: /nodes/1: the node's matrix in the scene is not finite", FFD_E_INVALID},
    {"{" ASSET ",\"scene\":2,\"scenes\":[{}]}", "t.gltf:1: /scene: there is no scene 2, only 1",
     FFD_E_INVALID},
    {"{" ASSET ",\"buffers\":[{}]}", "t.gltf:1: /buffers/0: \"byteLength\" is missing", FFD_E_INVALID},
    {"{" ASSET ",\"buffers\":[{\"byteLength\":1,\"uri\":\"data:x;base64,A$==\"}]}",
     "t.gltf:1: /buffers/0/uri: the data URI is not valid base64", FFD_E_INVALID},
    {"{" ASSET ",\"buffers\":[{\"byteLength\":1,\"uri\":\"data:x;base64\"}]}",
     "t.gltf:1: /buffers/0/uri: the data URI has no comma", FFD_E_INVALID},
    {"{" ASSET ",\"buffers\":[{\"byteLength\":1,\"uri\":\"data:,AA==\"}]}",
     "t.gltf:1: /buffers/0/uri: the data URI of a buffer must say \";base64\" before its comma",
     FFD_E_INVALID},
    {"{" ASSET ",\"buffers\":[{\"byteLength\":1,\"uri\":\"file:///etc/passwd\"}]}",
     "t.gltf:1: /buffers/0/uri: the buffer \"file:///etc/passwd\" is outside the model's folder", FFD_E_IO},
    {"{" ASSET ",\"buffers\":[{\"byteLength\":1,\"uri\":\"/etc/passwd\"}]}",
     "t.gltf:1: /buffers/0/uri: the buffer \"/etc/passwd\" is outside the model's folder", FFD_E_IO},
    {"{" ASSET ",\"buffers\":[{\"byteLength\":1,\"uri\":\"a%00b\"}]}",
     "t.gltf:1: /buffers/0/uri: the buffer's name holds a NUL character", FFD_E_INVALID},
    {"{" ASSET "," BUFFERS ",\"bufferViews\":[{\"buffer\":1,\"byteLength\":1}]}",
     "t.gltf:1: /bufferViews/0/buffer: there is no buffer 1, only 1", FFD_E_INVALID},
    {"{" ASSET "," BUFFERS
     ",\"bufferViews\":[{\"buffer\":0,\"byteOffset\":9007199254740992,\"byteLength\":1}]}",
     OF_2_53("t.gltf:1: /bufferViews/0/byteLength: bytes 9007199254740992 to 9007199254740993 are outside "
             "buffer 0 of 36 bytes",
             FFD_E_INVALID, "t.gltf:1: /bufferViews/0/byteOffset: ")},
    {"{" ASSET "," BUFFERS ",\"bufferViews\":[{\"buffer\":0,\"byteLength\":36,\"byteStride\":8}]," ACCESSORS
     "}",
     "t.gltf:1: /accessors/0/bufferView: its elements have 12 bytes, more than the byteStride 8",
     FFD_E_INVALID},
    {"{" DATA ",\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\"}]}",
     "t.gltf:1: /accessors/0/count: 4 elements need 48 bytes of bufferView 0, which has 36", FFD_E_INVALID},
    {"{" DATA ",\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":9007199254740992,\"type\":"
     "\"VEC3\"}]}",
     OF_2_53("t.gltf:1: /accessors/0/count: 9007199254740992 elements need 108086391056891904 bytes of "
             "bufferView 0, which has 36",
             FFD_E_INVALID, "t.gltf:1: /accessors/0/count: ")},
    {"{" DATA ",\"accessors\":[{\"bufferView\":3,\"componentType\":5126,\"count\":1,\"type\":\"VEC3\"}]}",
     "t.gltf:1: /accessors/0/bufferView: there is no bufferView 3, only 1", FFD_E_INVALID},
    {"{" DATA ",\"accessors\":[{\"bufferView\":0,\"componentType\":5130,\"count\":1,\"type\":\"VEC3\"}]}",
     "t.gltf:1: /accessors/0/componentType: a component type (5120 to 5123, 5125, 5126) is expected, not "
     "5130",
     FFD_E_INVALID},
    {"{" DATA ",\"extensionsUsed\":[\"KHR_a\",\"KHR_accessor_float64\"],\"accessors\":[{\"bufferView\":0,"
     "\"componentType\":5130,\"count\":1,\"type\":\"VEC3\"}]}",
     "t.gltf:1: /accessors/0/componentType: component type 5130, double precision, of KHR_accessor_float64 "
     "is "
     "not supported",
     FFD_E_UNSUPPORTED},
    {"{" DATA ",\"accessors\":[{\"bufferView\":0,\"componentType\":5124,\"count\":1,\"type\":\"VEC3\"}]}",
     "t.gltf:1: /accessors/0/componentType: a component type (5120 to 5123, 5125, 5126) is expected, not "
     "5124",
     FFD_E_INVALID},
    {"{" DATA ",\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":1,\"type\":\"VEC5\"}]}",
     "t.gltf:1: /accessors/0/type: \"SCALAR\", \"VEC2\" to \"VEC4\" or \"MAT2\" to \"MAT4\" is expected, "
     "not \"VEC5\"",
     FFD_E_INVALID},
    {"{" DATA "," ACCESSORS ",\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":1}}]}]}",
     "t.gltf:1: /meshes/0/primitives/0/attributes/POSITION: there is no accessor 1, only 1", FFD_E_INVALID},
    {"{" DATA "," ACCESSORS ",\"meshes\":[{\"primitives\":[{}]}]}",
     "t.gltf:1: /meshes/0/primitives/0: \"attributes\" is missing", FFD_E_INVALID},
    {"{" DATA "," ACCESSORS ",\"meshes\":[{\"primitives\":[{\"attributes\":{\"TANGENT\":0}}]}]}",
     "t.gltf:1: /meshes/0/primitives/0/attributes/TANGENT: its accessor is not a VEC4", FFD_E_INVALID},
    {"{" DATA ",\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"},"
     "{\"bufferView\":0,\"componentType\":5126,\"count\":2,\"type\":\"VEC3\"}],"
     "\"meshes\":[{\"primitives\":[{\"attributes\":{\"NORMAL\":0,\"POSITION\":1}}]}]}",
     "t.gltf:1: /meshes/0/primitives/0/attributes/POSITION: accessor 1 has 2 elements, another attribute "
     "has 3",
     FFD_E_INVALID},
    {"{" DATA
     ",\"accessors\":[{\"componentType\":5126,\"count\":9007199254740992,\"type\":\"VEC3\",\"sparse\":{"
     "\"count\":1,\"indices\":{\"bufferView\":0,\"componentType\":5121},\"values\":{\"bufferView\":0}}}]"
     "}",
     OF_2_53(
         "t.gltf:1: /accessors/0: needs more than the 100 MB of memory allowed (input.memory raises this)",
         FFD_E_LIMIT, "t.gltf:1: /accessors/0/count: ")},
    {"{" DATA ",\"accessors\":[{\"componentType\":5126,\"count\":1,\"type\":\"VEC3\",\"sparse\":{\"count\":1,"
     "\"indices\":{\"bufferView\":0,\"byteOffset\":14,\"componentType\":5121},\"values\":{\"bufferView\":"
     "0}}}]}",
     "t.gltf:1: /accessors/0/sparse/indices: sparse index 128 is not below the count 1", FFD_E_INVALID},
};

static void broken_values_are_refused(void **state)
{
    (void)state;
    check_refusals(broken_values, sizeof broken_values / sizeof *broken_values);
}

/* A flaw, and the end of its message. */
typedef struct flawed {
    const char *text, *pointer, *message;
} flawed;

static void flaws_are_noted_or_refused(void **state)
{
    (void)state;
    static const flawed cases[] = {
        {"{" ASSET ",\"nodes\":[{\"children\":[1]},{}],\"scenes\":[{\"nodes\":[1]}]}", "/nodes/1",
         "a scene names the node as a root, but it is a child of node 0"},
        {"{" ASSET ",\"nodes\":[{\"children\":[1],\"scale\":[2,1,1]},{}],\"scenes\":[{\"nodes\":[1]}]}",
         "/nodes/1",
         "a scene names the node as a root, but it is a child of node 0, which places it: viewers differ in "
         "this"},
        {"{" ASSET ",\"nodes\":[{}],\"scenes\":[{\"nodes\":[0,0]}]}", "/nodes/0",
         "the scene names the node twice"},
        {"{" ASSET ",\"buffers\":[{\"byteLength\":4,\"uri\":\"data:x;base64,AA==\"}]}", "/buffers/0",
         "the buffer has 1 bytes, less than its byteLength 4"},
        {"{" ASSET "," BUFFERS ",\"bufferViews\":[{\"buffer\":0,\"byteLength\":36,\"byteStride\":6}]}",
         "/bufferViews/0/byteStride", "a byteStride is a multiple of 4 from 4 to 252, not 6"},
        {"{" ASSET "," BUFFERS
         ",\"bufferViews\":[{\"buffer\":0,\"byteLength\":36,\"byteStride\":0}]," ACCESSORS "}",
         "/bufferViews/0/byteStride", "a byteStride is a multiple of 4 from 4 to 252, not 0"},
        {"{" DATA
         ",\"accessors\":[{\"bufferView\":0,\"byteOffset\":2,\"componentType\":5126,\"count\":1,\"type\":"
         "\"VEC3\"}]}",
         "/accessors/0/byteOffset",
         "byteOffset 2 (in a view at 0) is not a multiple of the component's 4 bytes"},
        {"{" DATA "," ACCESSORS
         ",\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":0}]}]}",
         "/meshes/0/primitives/0/indices",
         "accessor 0 does not hold indices (SCALAR of component type 5121, 5123 or 5125): what the primitive "
         "draws "
         "is not known"},
        {"{" DATA "," ACCESSORS
         ",\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":7}]}]}",
         "/meshes/0/primitives/0/indices",
         "there is no accessor 7, only 1: what the primitive draws is not known"},
        {"{" DATA "," ACCESSORS
         ",\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"mode\":7}]}]}",
         "/meshes/0/primitives/0/mode",
         "a mode is from 0 to 6, not 7: what the primitive draws is not known"},
        {"{" DATA ",\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":"
         "\"VEC3\"," TRIANGLE_BOUNDS "},"
         "{\"bufferView\":0,\"componentType\":5123,\"count\":12,\"type\":\"SCALAR\"}],"
         "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1}]}]," SCENE "}",
         "/meshes/0/primitives/0",
         "there is an index 16256, but the count of vertices is 3: what the primitive draws is not known"},
        {"{" ASSET ",\"nodes\":[{\"matrix\":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1.000001]}]}", "/nodes/0/matrix",
         "the matrix's last row differs from 0 0 0 1 by 1e-06"},
        {"{" ASSET ",\"buffers\":[{\"byteLength\":1,\"uri\":\"data:x;BASE64,AA==\"}]}", "/buffers/0/uri",
         "the head of the data URI does not end with \";base64\" in small letters"},
        {"{" ASSET ",\"buffers\":[{\"byteLength\":1,\"uri\":\"data:x; base64 ,AA==\"}]}", "/buffers/0/uri",
         "the head of the data URI does not end with \";base64\" in small letters"},
        {"{" ASSET ",\"buffers\":[{\"byteLength\":1,\"uri\":\"data:x;base64,A\\nA==\"}]}", "/buffers/0/uri",
         "there are blanks in the base64 of the data URI"},
        {"{" ASSET ",\"nodes\":[{\"children\":[1,1]},{}]}", "/nodes/1",
         "node 0 names the node twice as its child"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        mesh_document *document = NULL;
        ffd_error error = {0};
        ffd_source source = {.path = "t.gltf", .format = FFD_FORMAT_GLTF};
        file_input input = {.data = (const unsigned char *)cases[i].text, .size = strlen(cases[i].text)};
        assert_int_equal(ffd_format_open(gltf, &input, &source, &document, &error), FFD_OK);
        assert_int_equal(gltf->check(document, &error), FFD_OK);
        assert_int_equal(document->flaws.count, 1);
        assert_string_equal(document->flaws.list[0].pointer, cases[i].pointer);
        assert_string_equal(document->flaws.list[0].message, cases[i].message);
        gltf->close(document);

        source.strict = true;
        input = (file_input){.data = (const unsigned char *)cases[i].text, .size = strlen(cases[i].text)};
        assert_int_equal(ffd_format_open(gltf, &input, &source, &document, &error), FFD_E_INVALID);
        assert_string_equal(error.pointer, cases[i].pointer);
        assert_string_equal(error.message, cases[i].message);
    }
}

#define WITH_NODE(node)                                                                                      \
    "{" DATA "," ACCESSORS "," MESHES ",\"skins\":[{\"joints\":[0]}],\"nodes\":[" node "]}"
#define WITH_PRIMITIVE(primitive)                                                                            \
    "{" DATA "," ACCESSORS ",\"meshes\":[{\"primitives\":[" primitive "]}]," SCENE "}"

static void unsupported_things_are_named(void **state)
{
    (void)state;
    static const refusal cases[] = {
        {"{" ASSET
         ",\"buffers\":[{\"byteLength\":36}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}]," ACCESSORS
         "," MESHES "," SCENE "}",
         "t.gltf:1: /accessors/0: an accessor without bytes is not supported", FFD_E_UNSUPPORTED},
        {"{" DATA "," ACCESSORS "," MESHES "," SCENE
         ",\"extensionsRequired\":[\"KHR_materials_x\",\"EXT_geometry\"]}",
         "t.gltf:1: /extensionsRequired/1: the required extension \"EXT_geometry\" is not known "
         "(input.allow_extensions = EXT_geometry deforms the file all the same)",
         FFD_E_UNSUPPORTED},
    };
    check_refusals(cases, sizeof cases / sizeof *cases);
}

static void what_is_not_deformed_is_not_refused(void **state)
{
    (void)state;
    static const char *const texts[] = {
        /* A skin and a morph target in a scene that is not shown. */
        "{" DATA "," ACCESSORS
        ",\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"targets\":[{}]}]}],"
        "\"skins\":[{\"joints\":[0]}],\"nodes\":[{\"mesh\":0,\"skin\":0},{}],\"scenes\":[{\"nodes\":[1]}]}",
        /* Integers that are not plain digits, which tinygltf would read as 0. */
        "{" DATA
        ",\"accessors\":[{\"bufferView\":0.0,\"byteOffset\":1.2e1,\"componentType\":5126,\"count\":2.0,"
        "\"type\":\"VEC3\"}]," MESHES "," SCENE "}",
        "{" DATA "," ACCESSORS "," MESHES "}",
        "{" ASSET "}",
    };
    static const size_t parts[] = {0, 1, 0, 0};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        mesh_document *document = NULL;
        assert_int_equal(open_text(texts[i], FFD_SPACE_SCENE, &document, NULL), FFD_OK);
        assert_int_equal(gltf->begin_results(document, &(mesh_results){.directions = true}, NULL), FFD_OK);
        assert_int_equal(document->part_count, parts[i]);
        if (parts[i]) {
            double xyz[6];
            assert_int_equal(document->parts[0].vertex_count, 2);
            gltf->read(document, 0, MESH_POSITIONS, MESH_STORED, 0, 2, xyz);
            assert_true(xyz[0] >= 1 && xyz[0] <= 1 && xyz[4] >= 1 && xyz[4] <= 1);
        }
        gltf->close(document);
    }
}

static void parts_are_pairs_of_accessor_and_node(void **state)
{
    (void)state;
    /* Nodes 1 (turned, moved) and 2 show mesh 0, whose second primitive has other normals. Mesh 1 shares
       positions. */
    static const char text[] =
        "{" DATA ",\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"},"
        "{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":0}},"
        "{\"attributes\":{\"POSITION\":0,\"NORMAL\":1}},{\"attributes\":{\"POSITION\":0}}]},"
        "{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],"
        "\"nodes\":[{\"children\":[1,2],\"translation\":[10,0,0]},"
        "{\"mesh\":0,\"rotation\":[0,0,0.7071067811865476,0.7071067811865476],\"scale\":[2,2,2],"
        "\"translation\":[1,2,3]},"
        "{\"mesh\":0,\"matrix\":[0,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]},{\"mesh\":1}],\"scenes\":[{},{\"nodes\":["
        "0,3]}],"
        "\"scene\":1}";
    mesh_document *document = NULL;
    assert_int_equal(open_text(text, FFD_SPACE_SCENE, &document, NULL), FFD_OK);
    assert_int_equal(document->part_count, 5);
    static const bool repeats[] = {false, false, true, true, false};
    static const bool identity[] = {false, false, false, false, true};
    static const bool singular[] = {false, true, false, true, false};
    static const size_t normals[] = {3, 3, 3, 3, 0};
    for (size_t i = 0; i < 5; i++) {
        assert_int_equal(document->parts[i].repeats_positions, repeats[i]);
        assert_int_equal(document->parts[i].identity, identity[i]);
        assert_int_equal(document->parts[i].singular, singular[i]);
        assert_int_equal(document->parts[i].normal_count, normals[i]);
    }
    double xyz[9];
    gltf->read(document, 0, MESH_POSITIONS, MESH_STORED, 0, 3, xyz);
    ffd_part_transform(document, 0, 0, 3, xyz);
    static const double expected[9] = {11, 2, 3, 11, 4, 3, 9, 2, 3};
    for (int i = 0; i < 9; i++)
        assert_true(xyz[i] > expected[i] - 1e-14 && xyz[i] < expected[i] + 1e-14);
    gltf->close(document);

    assert_int_equal(open_text(text, FFD_SPACE_MESH, &document, NULL), FFD_OK);
    assert_int_equal(document->part_count, 2);
    assert_true(document->parts[0].identity && document->parts[1].identity &&
                document->parts[1].repeats_positions);
    gltf->close(document);
}

static void primitives_become_triangles(void **state)
{
    (void)state;
    static const struct {
        const char *mode;
        size_t faces, lines, points;
        uint32_t corners[6];
    } cases[] = {
        {"0", 0, 0, 4, {0}},
        {"1", 0, 2, 0, {0}},
        {"2", 0, 4, 0, {0}},
        {"3", 0, 3, 0, {0}},
        {"4", 1, 0, 0, {3, 2, 1}},
        {"5", 2, 0, 0, {3, 2, 1, 2, 0, 1}},
        {"6", 2, 0, 0, {3, 2, 1, 3, 1, 0}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[1024];
        /* Indices 3 2 1 0 as bytes, then 4 positions of 0. */
        snprintf(text, sizeof text,
                 "{" ASSET ",\"buffers\":[{\"byteLength\":52,\"uri\":\"data:;base64,"
                 "AwIBAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAA==\"}],"
                 "\"bufferViews\":[{\"buffer\":0,\"byteLength\":4},{\"buffer\":0,\"byteOffset\":4,"
                 "\"byteLength\":48}],"
                 "\"accessors\":[{\"bufferView\":0,\"componentType\":5121,\"count\":4,\"type\":\"SCALAR\"},"
                 "{\"bufferView\":1,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\"}],"
                 "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":1},\"indices\":0,\"mode\":%s}]}]"
                 "," SCENE "}",
                 cases[i].mode);
        mesh_document *document = NULL;
        mesh_faces faces;
        ffd_error error = {0};
        assert_int_equal(open_text(text, FFD_SPACE_SCENE, &document, &error), FFD_OK);
        assert_int_equal(gltf->faces(document, MESH_STORED, &faces, NULL), FFD_OK);
        assert_int_equal(faces.vertex_count, 4);
        assert_int_equal(faces.face_count, cases[i].faces);
        assert_int_equal(faces.lines, cases[i].lines);
        assert_int_equal(faces.points, cases[i].points);
        assert_memory_equal(faces.corners, cases[i].corners, 3 * faces.face_count * sizeof *faces.corners);
        ffd_mesh_faces_free(&faces);
        gltf->close(document);
    }
}

static void a_primitive_with_wrong_indices_has_vertices_but_no_faces(void **state)
{
    (void)state;
    static const char text[] =
        "{" DATA ",\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"},"
        "{\"bufferView\":0,\"componentType\":5123,\"count\":12,\"type\":\"SCALAR\"}],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1},"
        "{\"attributes\":{\"POSITION\":0}}]}]," SCENE "}";
    mesh_document *document = NULL;
    mesh_faces faces;
    mesh_model model = {0};
    ffd_error error = {0};
    assert_int_equal(open_text(text, FFD_SPACE_SCENE, &document, &error), FFD_OK);
    assert_int_equal(ffd_mesh_vertex_count(document), 3);
    assert_int_equal(gltf->faces(document, MESH_STORED, &faces, NULL), FFD_OK);
    assert_int_equal(faces.face_count, 1);
    assert_int_equal(faces.points + faces.lines, 0);
    ffd_mesh_faces_free(&faces);
    assert_int_equal(ffd_mesh_mark_used(document, NULL), FFD_OK);
    assert_null(document->parts[0].used);
    assert_int_equal(gltf->model(document, MESH_STORED, &model, &error), FFD_E_INVALID);
    assert_string_equal(error.pointer, "/meshes/0/primitives/0");
    ffd_model_free(&model);
    gltf->close(document);
}

static void broken_glb_is_refused(void **state)
{
    (void)state;
    static const struct {
        const char *bytes;
        size_t size;
        const char *message;
    } cases[] = {
        {"", 0, "t.glb: is not a GLB file: it does not start with \"glTF\""},
        {"{}", 2, "t.glb: is a glTF file in JSON, not a GLB file: its name must end in .gltf"},
        {"glT", 3, "t.glb: is not a GLB file: it does not start with \"glTF\""},
        {"glTF\2\0\0\0", 8, "t.glb: GLB: the file has 8 bytes, less than its header"},
        {"glTF\2\0\0\0\15\0\0\0", 12, "t.glb: GLB: the header states a size of 13, the file has 12 bytes"},
        {"glTF\2\0\0\0\14\0\0\0", 12, "t.glb: GLB: the header of the chunk at byte 12 is cut off"},
        {"glTF\2\0\0\0\24\0\0\0\4\0\0\0JSON", 20,
         "t.glb: GLB: the chunk at byte 12 states a size of 4, but only 0 bytes follow"},
        {"glTF\2\0\0\0\24\0\0\0\0\0\0\0BIN\0", 20,
         "t.glb: GLB: the first chunk has type 0x004e4942, not JSON"},
        {"glTF\2\0\0\0\30\0\0\0\4\0\0\0JSON{}  xx", 26, "t.glb: \"asset\" is missing"},
        {"glTF\2\0\0\0\32\0\0\0\4\0\0\0JSON{}  xx", 26,
         "t.glb: GLB: the header of the chunk at byte 24 is cut off"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        mesh_document *document = NULL;
        ffd_error error = {0};
        char line[512];
        assert_int_equal(open_bytes(cases[i].bytes, cases[i].size, "t.glb", FFD_FORMAT_GLB, FFD_SPACE_SCENE,
                                    &document, &error),
                         FFD_E_INVALID);
        ffd_error_format(&error, line, sizeof line);
        assert_string_equal(line, cases[i].message);
    }
    mesh_document *document = NULL;
    ffd_error error = {0};
    assert_int_equal(open_bytes("glTF", 4, "t.gltf", FFD_FORMAT_GLTF, FFD_SPACE_SCENE, &document, &error),
                     FFD_E_INVALID);
    assert_string_equal(error.message, "is a GLB file: its name must end in .glb");
}

static void standard_input_has_no_folder(void **state)
{
    (void)state;
    static const char text[] = "{" ASSET ",\"buffers\":[{\"byteLength\":1,\"uri\":\"a.bin\"}]}";
    mesh_document *document = NULL;
    ffd_error error = {0};
    assert_int_equal(
        open_bytes(text, sizeof text - 1, "-", FFD_FORMAT_GLTF, FFD_SPACE_SCENE, &document, &error),
        FFD_E_IO);
    assert_string_equal(error.file, "standard input");
    assert_string_equal(error.message, "the buffer is the file \"a.bin\", and standard input has no folder");
}

/* Callers pass no URIs. If one did, the file would be there to be read. */
static void tinygltf_opens_no_file(void **state)
{
    (void)state;
    char path[] = "/tmp/ffd-test-XXXXXX", text[200];
    gltf_model model;
    ffd_error error = {0};
    const int file = mkstemp(path);
    assert_true(file >= 0);
    assert_int_equal(write(file, "1234", 4), 4);
    close(file);
    snprintf(text, sizeof text, "{" ASSET ",\"buffers\":[{\"byteLength\":4,\"uri\":\"%s\"}]}", path);
    const ffd_status status = ffd_gltf_parse_model(text, strlen(text), "t.gltf", &model, &error);
    unlink(path);
    assert_int_equal(status, FFD_E_INVALID);
}

static void base64_is_read_and_written(void **state)
{
    (void)state;
    unsigned char bytes[8];
    char text[8];
    size_t count;
    static const char *const pairs[][2] = {{"", ""},        {"f", "Zg=="},        {"fo", "Zm8="},
                                           {"foo", "Zm9v"}, {"foob", "Zm9vYg=="}, {"\xfb\xff", "+/8="}};
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++) {
        const size_t size = strlen(pairs[i][0]), length = strlen(pairs[i][1]);
        assert_int_equal(ffd_base64_length(size), length);
        ffd_base64_encode((const unsigned char *)pairs[i][0], size, text);
        assert_memory_equal(text, pairs[i][1], length);
        assert_true(ffd_base64_decode(pairs[i][1], length, bytes, &count));
        assert_int_equal(count, size);
        assert_memory_equal(bytes, pairs[i][0], size);
    }
    assert_true(ffd_base64_decode("Zg", 2, bytes, &count));
    assert_int_equal(count, 1);
    assert_false(ffd_base64_decode("Z", 1, bytes, &count));
    assert_false(ffd_base64_decode("Z===", 4, bytes, &count));
    assert_false(ffd_base64_decode("Zm 9", 4, bytes, &count));
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (int c = 0; c < 256; c++)
        for (size_t place = 0; place < 7; place++) { /* a final '=' is padding */
            const char *const digit = c ? strchr(digits, c) : NULL;
            memcpy(text, "AAAAAAA", 7);
            text[place] = (char)c;
            const bool ends = c == '=' && place == 6;
            assert_int_equal(ffd_base64_decode(text, 7, bytes, &count), digit || ends);
            if (!digit)
                continue;
            const uint64_t bits = (uint64_t)(digit - digits) << (42 - 6 * place);
            for (size_t i = 0; i < count; i++)
                assert_int_equal(bytes[i], bits >> (40 - 8 * i) & 255);
        }
}

static void paths_are_worked_in(void **state)
{
    (void)state;
    static const char *const normal[][2] = {{"a/./b//c", "a/b/c"}, {"a/../b", "b"},
                                            {"../a/../b", "../b"}, {"a/../../b", "../b"},
                                            {"/a/../../b", "/b"},  {"./", ""}};
    for (size_t i = 0; i < sizeof normal / sizeof *normal; i++) {
        char *path = ffd_path_normalize(normal[i][0]);
        assert_string_equal(path, normal[i][1]);
        ffd_free(path);
    }
    static const char *const relative[][3] = {
        {"/a/b", "/a/c/x", "../c/x"},  {"/a/b", "/a/b/x", "x"},
        {"/a/bc", "/a/b/x", "../b/x"}, {"/", "/x", "x"},
        {"/a/b", "/a/b", ""},          {"/A/b", "/a/b/x", "../../a/b/x"},
        {"/a/b", "/c", "../../c"}};
    for (size_t i = 0; i < sizeof relative / sizeof *relative; i++) {
        char *path = ffd_path_relative(relative[i][0], relative[i][1]);
        assert_string_equal(path, relative[i][2]);
        ffd_free(path);
    }
    static const struct {
        const char *folder, *path;
        bool is_inside;
    } places[] = {{"/a/b", "/a/b/x", true},    {"/", "/x", true},         {"/a/b", "/a/bc", false},
                  {"/a/b", "/a/b", false},     {"/a/b/c", "/a/b", false}, {"/A", "/a/x", false},
                  {"/A", "/\xc1\x81/x", false}};
    for (size_t i = 0; i < sizeof places / sizeof *places; i++)
        assert_int_equal(ffd_path_is_inside(places[i].folder, places[i].path), places[i].is_inside);
    char text[] = "a%20b%2Fc%zz%4";
    text[ffd_uri_decode(text, sizeof text - 1)] = 0;
    assert_string_equal(text, "a b/c%zz%4");
    char *encoded = ffd_uri_encode("a b/\xc3\xa4.bin");
    assert_string_equal(encoded, "a%20b/%C3%A4.bin");
    ffd_free(encoded);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(broken_values_are_refused),
        cmocka_unit_test(flaws_are_noted_or_refused),
        cmocka_unit_test(unsupported_things_are_named),
        cmocka_unit_test(what_is_not_deformed_is_not_refused),
        cmocka_unit_test(parts_are_pairs_of_accessor_and_node),
        cmocka_unit_test(primitives_become_triangles),
        cmocka_unit_test(a_primitive_with_wrong_indices_has_vertices_but_no_faces),
        cmocka_unit_test(broken_glb_is_refused),
        cmocka_unit_test(standard_input_has_no_folder),
        cmocka_unit_test(tinygltf_opens_no_file),
        cmocka_unit_test(base64_is_read_and_written),
        cmocka_unit_test(paths_are_worked_in),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
