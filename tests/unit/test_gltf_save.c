/* test_gltf_save.c - writing glTF: bytes in place, appended copies, files of buffers and images. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/gltf_file.h"
#include "../support/test_folder.h"
#include "base/little_endian.h"
#include "io/gltf/file/glb.h"
#include "mesh/difference.h"
#include <sys/stat.h>
#include <unistd.h>

#define ASSET "\"asset\":{\"version\":\"2.0\"}"
#define TRIANGLE "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"
/* The triangle (0,0,0) (1,0,0) (0,1,0) with 1 added to x. */
#define MOVED "AACAPwAAAAAAAAAAAAAAQAAAAAAAAAAAAACAPwAAgD8AAAAA"
#define DATA_URI "data:application/octet-stream;base64,"
#define BUFFER(length, text) "\"buffers\":[{\"byteLength\":" length ",\"uri\":\"" DATA_URI text "\"}]"
#define VIEWS "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36,\"target\":34962}"
#define ACCESSOR(min, max)                                                                                   \
    "{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"min\":" min ",\"max\":" max ",\"type\":"         \
    "\"VEC3\"}"
#define OLD_ACCESSOR ACCESSOR("[0, 0,0.0]", "[1,1,0]")
#define MESH(position) "{\"primitives\":[{\"attributes\":{\"POSITION\":" position "}}]}"

static void check_bytes(const char *name, const void *bytes, size_t size)
{
    file_input input;
    assert_int_equal(ffd_file_load(in_folder(name), &input, NULL), FFD_OK);
    assert_int_equal(input.size, size);
    assert_memory_equal(input.data, bytes, size);
    ffd_file_unload(&input);
}

/* Compared as strings, so that a difference is printed. */
static void check_text(const char *name, const char *text)
{
    char *read = load_text(in_folder(name));
    assert_string_equal(read, text);
    free(read);
}

static void move_by_place(const double place[3], double xyz[3])
{
    xyz[0] += place[0];
}

typedef struct log_lines {
    char text[1024];
} log_lines;

static void keep_line(void *user, ffd_log_level level, const char *line)
{
    log_lines *lines = user;
    const size_t length = strlen(lines->text);
    snprintf(lines->text + length, sizeof lines->text - length, "%d %s\n", (int)level, line);
}

/* Deforms the file `name` and saves it as `output`, both in the test's folder. */
static ffd_status convert(const char *name, const char *output, ffd_space space, mover move, bool attributes,
                          ffd_resources resources, log_lines *lines, ffd_error *error)
{
    mesh_document *document = NULL;
    const mesh_save_options options = {.path = strcmp(output, "-") == 0 ? output : in_folder(output),
                                       .resources = resources};
    const mesh_log log = {lines ? keep_line : NULL, lines};
    assert_int_equal(open_file(in_folder(name), space, &document, error), FFD_OK);
    ffd_status status = deform(document, move, attributes, error);
    if (status == FFD_OK)
        status = save_with(document, &options, &log, error);
    gltf->close(document);
    return status;
}

/* log: the expected lines; NULL: a warning about a node that is not shown. */
static void check_conversion(const char *text, ffd_space space, mover move, const char *expected,
                             const char *log)
{
    log_lines lines = {{0}};
    ffd_error error = {0};
    put_text("in.gltf", text);
    unlink(in_folder("out.gltf"));
    const ffd_status status =
        convert("in.gltf", "out.gltf", space, move, false, FFD_RESOURCES_COPY, &lines, &error);
    assert_string_equal(error.message, "");
    assert_int_equal(status, FFD_OK);
    check_text("out.gltf", expected);
    if (log)
        assert_string_equal(lines.text, log);
    else
        assert_non_null(
            strstr(lines.text, "1 node with a mesh is not in the displayed scene: left as it is"));
}

static void only_what_changes_is_replaced(void **state)
{
    (void)state;
    /* max x becomes 2; 0 becomes 1; the text of other numbers is unchanged. */
    const char *const before = "\xef\xbb\xbf{ " ASSET ", " BUFFER(
        "36", TRIANGLE) ",\n" VIEWS "],\"accessors\":[" OLD_ACCESSOR
                        "],\"meshes\":[" MESH("0") "],\"nodes\":[{\"mesh\":0}] , \"extras\":1.50}\n ";
    const char *const after =
        "\xef\xbb\xbf{ " ASSET
        ", " BUFFER("36", MOVED) ",\n" VIEWS
                                 "],\"accessors\":[" ACCESSOR("[1, 0,0.0]", "[2,1,0]") "],\"meshes\":[" MESH(
                                     "0") "],\"nodes\":[{\"mesh\":0}] , \"extras\":1.50}\n ";
    check_conversion(before, FFD_SPACE_SCENE, add_one, after, "");
    check_conversion(before, FFD_SPACE_MESH, add_one, after, "");
    check_conversion(before, FFD_SPACE_SCENE, stay, before, "");
}

static void odd_data_uris_become_plain(void **state)
{
    (void)state;
#define REST                                                                                                 \
    VIEWS "],\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}],"       \
          "\"meshes\":[" MESH("0") "],\"nodes\":[{\"mesh\":0}]}"
#define URI(uri) "{" ASSET ",\"buffers\":[{\"byteLength\":36,\"uri\":\"" uri "\"}]," REST
    check_conversion(URI("DATA:;base64," TRIANGLE), FFD_SPACE_MESH, add_one, URI("DATA:;base64," MOVED), "");
    check_conversion(URI("data:application\\/gltf-buffer;base64," TRIANGLE), FFD_SPACE_MESH, add_one,
                     URI("data:application\\/gltf-buffer;base64," MOVED), "");
    check_conversion(URI("data\\u003a;base64\\u002c" TRIANGLE), FFD_SPACE_MESH, add_one, URI(DATA_URI MOVED),
                     "");
#undef URI
#undef REST
}

/* Two nodes show one mesh, one of them far away. */
#define TWO_NODES(first, second)                                                                             \
    "],\"nodes\":[{\"mesh\":" first "},{\"mesh\":" second                                                    \
    ",\"translation\":[10,0,0]}],\"scenes\":[{\"nodes\":[0,1]}]}"

/* The far node's mesh has its own accessor, after the first. */
#define FAR_HAS_ITS_OWN                                                                                      \
    "{" ASSET "," BUFFER("72", TRIANGLE MOVED) "," VIEWS                                                     \
                                               ",{\"buffer\":0,\"byteOffset\":36,\"byteLength\":36,"         \
                                               "\"target\":34962}],\"accessors\":[" OLD_ACCESSOR             \
                                               ",{\"bufferView\":1,\"componentType\":5126,\"count\":3,"      \
                                               "\"min\":[1, 0,0.0],\"max\":[2,1,0],"                         \
                                               "\"type\":\"VEC3\"}],\"meshes\":[" MESH("0") "," MESH("1")    \
                                                   TWO_NODES("0", "1")

static void a_mesh_under_two_nodes_is_copied_where_they_differ(void **state)
{
    (void)state;
    const char *const before =
        "{" ASSET "," BUFFER("36", TRIANGLE) "," VIEWS "],\"accessors\":[" OLD_ACCESSOR
                                             "],\"meshes\":[" MESH("0") TWO_NODES("0", "0");
    /* Both agree: in place. */
    check_conversion(before, FFD_SPACE_SCENE, add_one,
                     "{" ASSET "," BUFFER("36", MOVED) "," VIEWS "],\"accessors\":[" ACCESSOR(
                         "[1, 0,0.0]", "[2,1,0]") "],\"meshes\":[" MESH("0") TWO_NODES("0", "0"),
                     "");
    /* Only the far one moves: the first one keeps its mesh and bytes. */
    check_conversion(
        before, FFD_SPACE_SCENE, move_far, FAR_HAS_ITS_OWN,
        "1 node 1 gets a copy of mesh 0 (mesh 1): the mesh is deformed differently under other nodes\n"
        "0 1 node gets a copy of its mesh, which is deformed differently under other nodes\n");
}

static void nodes_that_agree_share_a_copy(void **state)
{
    (void)state;
#define THREE(second)                                                                                        \
    "],\"nodes\":[{\"mesh\":0},{\"mesh\":" second ",\"translation\":[10,0,0]},{\"mesh\":" second             \
    ",\"translation\":[20,0,0]}]}"
    check_conversion(
        "{" ASSET "," BUFFER("36", TRIANGLE) "," VIEWS "],\"accessors\":[" OLD_ACCESSOR
                                             "],\"meshes\":[" MESH("0") THREE("0"),
        FFD_SPACE_SCENE, move_far,
        "{" ASSET "," BUFFER("72", TRIANGLE MOVED) "," VIEWS
                                                   ",{\"buffer\":0,\"byteOffset\":36,\"byteLength\":36,"
                                                   "\"target\":34962}],\"accessors\":[" OLD_ACCESSOR
                                                   ",{\"bufferView\":1,\"componentType\":5126,\"count\":3,"
                                                   "\"min\":[1, 0,0.0],\"max\":[2,1,0],"
                                                   "\"type\":\"VEC3\"}],\"meshes\":[" MESH("0") "," MESH("1")
                                                       THREE("1"),
        "1 node 1 gets a copy of mesh 0 (mesh 1): the mesh is deformed differently under other nodes\n"
        "1 node 2 gets a copy of mesh 0 (mesh 1): the mesh is deformed differently under other nodes\n"
        "0 2 nodes get copies of their meshes, which are deformed differently under other nodes\n");
#undef THREE
}

static void a_node_outside_the_scene_keeps_its_mesh(void **state)
{
    (void)state;
#define HIDDEN(shown) "],\"nodes\":[{\"mesh\":" shown "},{\"mesh\":0}],\"scenes\":[{\"nodes\":[0]}]}"
    check_conversion("{" ASSET "," BUFFER("36", TRIANGLE) "," VIEWS "],\"accessors\":[" OLD_ACCESSOR
                                                          "],\"meshes\":[" MESH("0") HIDDEN("0"),
                     FFD_SPACE_SCENE, add_one,
                     "{" ASSET "," BUFFER(
                         "72", TRIANGLE MOVED) "," VIEWS ",{\"buffer\":0,\"byteOffset\":36,\"byteLength\":36,"
                                               "\"target\":34962}],\"accessors\":[" OLD_ACCESSOR
                                               ",{\"bufferView\":1,\"componentType\":5126,\"count\":3,"
                                               "\"min\":[1, 0,0.0],\"max\":[2,1,0],"
                                               "\"type\":\"VEC3\"}],\"meshes\":[" MESH("0") "," MESH("1")
                                                   HIDDEN("1"),
                     NULL);
#undef HIDDEN
}

static void other_users_of_the_bytes_keep_them(void **state)
{
    (void)state;
    /* One more user of the data: an attribute of another name, an animation, an unused accessor, an image,
       another accessor that overlaps by one vertex. The positions then get a new accessor. */
    static const struct {
        const char *views, *accessors, *attributes, *rest;
        const char *number; /* of the new accessor */
        const char *view;   /* of the new bufferView */
    } cases[] = {
        {"", "", ",\"_OLD\":0", "", "1", "1"},
        {"", "", "", ",\"animations\":[{\"samplers\":[{\"input\":0,\"output\":0}]}]", "1", "1"},
        {"", ",{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}", "", "", "2", "1"},
        {"", "", "", ",\"images\":[{\"bufferView\":0}]", "1", "1"},
        {",{\"buffer\":0,\"byteOffset\":24,\"byteLength\":12}",
         ",{\"bufferView\":1,\"componentType\":5126,\"count\":1,\"type\":\"VEC3\"}", "", "", "2", "2"},
        {"", "", "", ",\"skins\":[{\"joints\":[0],\"inverseBindMatrices\":0}]", "1", "1"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char before[2048], after[2048];
        static const char *const form =
            "{" ASSET ",\"buffers\":[{\"byteLength\":%s,\"uri\":\"" DATA_URI TRIANGLE "%s\"}]," VIEWS
            "%s%s],\"accessors\":[" OLD_ACCESSOR
            "%s%s],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":%s%s}}]}],"
            "\"nodes\":[{\"mesh\":0}]%s}";
        char accessor[256];
        snprintf(accessor, sizeof accessor,
                 ",{\"bufferView\":%s,\"componentType\":5126,\"count\":3,\"min\":[1, 0,0.0],\"max\":[2,1,0],"
                 "\"type\":\"VEC3\"}",
                 cases[i].view);
        snprintf(before, sizeof before, form, "36", "", cases[i].views, "", cases[i].accessors, "", "0",
                 cases[i].attributes, cases[i].rest);
        snprintf(after, sizeof after, form, "72", MOVED, cases[i].views,
                 ",{\"buffer\":0,\"byteOffset\":36,\"byteLength\":36,\"target\":34962}", cases[i].accessors,
                 accessor, cases[i].number, cases[i].attributes, cases[i].rest);
        check_conversion(before, FFD_SPACE_SCENE, add_one, after, "");
    }
}

static void accessors_of_the_same_bytes_that_agree_stay(void **state)
{
    (void)state;
#define TWO(min, max)                                                                                        \
    "],\"accessors\":[" ACCESSOR(min, max) "," ACCESSOR(min, max) "],\"meshes\":[" MESH("0") "," MESH("1")
    check_conversion(
        "{" ASSET "," BUFFER("36", TRIANGLE) "," VIEWS TWO("[0,0,0]", "[1,1,0]") TWO_NODES("0", "1"),
        FFD_SPACE_SCENE, add_one,
        "{" ASSET "," BUFFER("36", MOVED) "," VIEWS TWO("[1,0,0]", "[2,1,0]") TWO_NODES("0", "1"), "");
#undef TWO
    /* Two meshes with different results share an accessor: each gets its own. */
    check_conversion("{" ASSET "," BUFFER("36", TRIANGLE) "," VIEWS "],\"accessors\":[" OLD_ACCESSOR
                                                          "],\"meshes\":[" MESH("0") "," MESH("0")
                                                              TWO_NODES("0", "1"),
                     FFD_SPACE_SCENE, move_far, FAR_HAS_ITS_OWN, "");
}

/* Positions, normals and tangents of two vertices, interleaved, with this many floats a vertex. The tangent's
   last number and the gap, if any, are unchanged. */
static void check_interleaved(size_t floats)
{
    static const float values[2][11] = {{1, 2, 3, 4, 5, 6, 7, 8, 9, -1, 77},
                                        {11, 12, 13, 14, 15, 16, 17, 18, 19, 1, 78}};
    static const float expected[2][11] = {{2, 2, 3, 5, 6, 4, 8, 9, 7, -1, 77},
                                          {12, 12, 13, 15, 16, 14, 18, 19, 17, 1, 78}};
    const size_t stride = floats * sizeof(float);
    float before[22], after[22];
    char text[1000];
    for (size_t i = 0; i < 2; i++) {
        memcpy(before + i * floats, values[i], stride);
        memcpy(after + i * floats, expected[i], stride);
    }
    snprintf(text, sizeof text,
             "{" ASSET ",\"buffers\":[{\"byteLength\":%zu,\"uri\":\"in.bin\"}],"
             "\"bufferViews\":[{\"buffer\":0,\"byteLength\":%zu,\"byteStride\":%zu}],"
             "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":2,\"type\":\"VEC3\"},"
             "{\"bufferView\":0,\"byteOffset\":12,\"componentType\":5126,\"count\":2,\"type\":\"VEC3\"},"
             "{\"bufferView\":0,\"byteOffset\":24,\"componentType\":5126,\"count\":2,\"type\":\"VEC4\"}],"
             "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1,\"TANGENT\":2}}]}],"
             "\"nodes\":[{\"mesh\":0}]}",
             2 * stride, 2 * stride, stride);
    put_text("in.gltf", text);
    put("in.bin", before, 2 * stride);
    unlink(in_folder("out.gltf"));
    unlink(in_folder("out.bin"));
    assert_int_equal(
        convert("in.gltf", "out.gltf", FFD_SPACE_SCENE, add_one, true, FFD_RESOURCES_COPY, NULL, NULL),
        FFD_OK);
    check_bytes("out.bin", after, 2 * stride);
    check_bytes("in.bin", before, 2 * stride);
}

static void interleaved_attributes_change_in_place(void **state)
{
    (void)state;
    check_interleaved(10);
    check_interleaved(11);
}

static size_t make_glb(unsigned char *glb, const char *json, const void *bin, size_t bin_size,
                       const char *tail)
{
    const size_t length = strlen(json), tail_size = strlen(tail);
    const size_t total = 12 + 8 + length + 8 + bin_size;
    memcpy(glb, "glTF\2\0\0\0", 8);
    store_u32(glb + 8, (uint32_t)total);
    store_u32(glb + 12, (uint32_t)length);
    store_u32(glb + 16, GLB_CHUNK_JSON);
    memcpy(glb + 20, json, length);
    store_u32(glb + 20 + length, (uint32_t)bin_size);
    store_u32(glb + 24 + length, GLB_CHUNK_BIN);
    memcpy(glb + 28 + length, bin, bin_size);
    memcpy(glb + total, tail, tail_size);
    return total + tail_size;
}

/* Pads a text with spaces to a multiple of 4, plus `more`. */
static const char *pad(const char *text, size_t more)
{
    static char padded[4][1024];
    static int turn;
    char *room = padded[turn++ % 4];
    const size_t length = strlen(text), size = (length + 3) / 4 * 4 + more;
    memset(room, ' ', size);
    memcpy(room, text, length);
    room[size] = 0;
    return room;
}

static void check_glb(const char *json, const void *bin, size_t bin_size, const char *tail, mover move,
                      const char *new_json, const void *new_bin, size_t new_bin_size, const char *new_tail)
{
    unsigned char before[2048], after[2048];
    const size_t before_size = make_glb(before, json, bin, bin_size, tail);
    const size_t after_size = make_glb(after, new_json, new_bin, new_bin_size, new_tail);
    put("in.glb", before, before_size);
    unlink(in_folder("out.glb"));
    assert_int_equal(
        convert("in.glb", "out.glb", FFD_SPACE_SCENE, move, false, FFD_RESOURCES_COPY, NULL, NULL), FFD_OK);
    check_bytes("out.glb", after, after_size);
}

#define GLB_JSON(length, view, accessor, mesh, nodes)                                                        \
    "{" ASSET ",\"buffers\":[{\"byteLength\":" length                                                        \
    "}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}" view                                              \
    "],\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}" accessor      \
    "],\"meshes\":[" MESH("0") mesh "],\"nodes\":[{\"mesh\":0}" nodes "]}"

static void glb_lengths_and_padding_follow(void **state)
{
    (void)state;
    const float triangle[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0}, moved[9] = {1, 0, 0, 2, 0, 0, 1, 1, 0};
    const char *const plain = pad(GLB_JSON("36", "", "", "", ""), 0);
    check_glb(plain, triangle, 36, "tail", stay, plain, triangle, 36, "tail");
    check_glb(plain, triangle, 36, "tail", add_one, plain, moved, 36, "");
    /* Odd sizes are kept if nothing grows. */
    const float padded[10] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 9},
                padded_moved[10] = {1, 0, 0, 2, 0, 0, 1, 1, 0, 9};
    const char *const odd = pad(GLB_JSON("36", "", "", "", ""), 6);
    check_glb(odd, padded, 40, "", add_one, odd, padded_moved, 40, "");
    /* A copy for the second node makes both chunks grow. */
    float grown[18];
    memcpy(grown, triangle, sizeof triangle);
    memcpy(grown + 9, moved, sizeof moved);
#define SECOND(mesh) ",{\"mesh\":" mesh ",\"translation\":[10,0,0]}"
    check_glb(pad(GLB_JSON("36", "", "", "", SECOND("0")), 0), padded, 40, "tail", move_far,
              pad(GLB_JSON("72", ",{\"buffer\":0,\"byteOffset\":36,\"byteLength\":36}",
                           ",{\"bufferView\":1,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}",
                           "," MESH("1"), SECOND("1")),
                  0),
              grown, 72, "");
#undef SECOND
}

#define WITH_FILE(uri)                                                                                       \
    "{" ASSET ",\"buffers\":[{\"byteLength\":36,\"uri\":\"" uri "\"}]," VIEWS                                \
    "],\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}],\"meshes\":"  \
    "[" MESH("0") "],\"nodes\":[{\"mesh\":0}]}"

static void buffer_files_are_named_after_the_output(void **state)
{
    (void)state;
    const float triangle[10] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 5}, moved[10] = {1, 0, 0, 2, 0, 0, 1, 1, 0, 5};
    put_text("own.gltf", WITH_FILE("some%20data.bin"));
    put("some data.bin", triangle, sizeof triangle); /* a buffer may be longer than its byteLength */
    assert_int_equal(
        convert("own.gltf", "new one.gltf", FFD_SPACE_SCENE, add_one, false, FFD_RESOURCES_COPY, NULL, NULL),
        FFD_OK);
    check_text("new one.gltf", WITH_FILE("new%20one.bin"));
    check_bytes("new one.bin", moved, sizeof moved);
    check_bytes("some data.bin", triangle, sizeof triangle);

    /* An existing file is refused without force, whichever it is. */
    ffd_error error = {0};
    unlink(in_folder("new one.gltf"));
    assert_int_equal(convert("own.gltf", "new one.gltf", FFD_SPACE_SCENE, add_one, false, FFD_RESOURCES_COPY,
                             NULL, &error),
                     FFD_E_EXISTS);
    assert_string_equal(error.file, in_folder("new one.bin"));
    assert_int_equal(access(in_folder("new one.gltf"), F_OK), -1);

    /* The input's own buffer is never overwritten, even with force. */
    mesh_document *document = NULL;
    assert_int_equal(open_file(in_folder("own.gltf"), FFD_SPACE_SCENE, &document, NULL), FFD_OK);
    assert_int_equal(save_to(document, in_folder("some data.gltf"), &error), FFD_E_EXISTS);
    gltf->close(document);
    check_bytes("some data.bin", triangle, sizeof triangle);

    assert_int_equal(
        convert("own.gltf", "-", FFD_SPACE_SCENE, add_one, false, FFD_RESOURCES_COPY, NULL, &error),
        FFD_E_ARGUMENT);
    assert_string_equal(error.message,
                        "the buffer is a file of its own, which standard output cannot hold: give a file "
                        "name as output");
}

/* Also in place, a changed buffer gets a new name: another model may use the old one. */
static void in_place_buffers_are_named_after_the_file(void **state)
{
    (void)state;
    const float triangle[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0}, moved[9] = {1, 0, 0, 2, 0, 0, 1, 1, 0};
    const char strange[] = "not of this model";
    put_text("place.gltf", WITH_FILE("other.bin"));
    put("other.bin", triangle, sizeof triangle);
    put("place.bin", strange, sizeof strange);
    assert_int_equal(
        convert("place.gltf", "place.gltf", FFD_SPACE_SCENE, add_one, false, FFD_RESOURCES_COPY, NULL, NULL),
        FFD_OK);
    check_text("place.gltf", WITH_FILE("place-1.bin"));
    check_bytes("place-1.bin", moved, sizeof moved);
    check_bytes("other.bin", triangle, sizeof triangle);
    check_bytes("place.bin", strange, sizeof strange);

    put_text("own.gltf", WITH_FILE("own.bin"));
    put("own.bin", triangle, sizeof triangle);
    assert_int_equal(
        convert("own.gltf", "own.gltf", FFD_SPACE_SCENE, add_one, false, FFD_RESOURCES_COPY, NULL, NULL),
        FFD_OK);
    check_text("own.gltf", WITH_FILE("own.bin"));
    check_bytes("own.bin", moved, sizeof moved);
}

/* Moves the file `name` and saves it in the container of the output's ending. */
static void change_container(const char *name, const char *output, ffd_format format)
{
    mesh_document *document = NULL;
    ffd_error error = {0};
    const mesh_save_options options = {.path = in_folder(output), .format = format};
    assert_int_equal(open_file(in_folder(name), FFD_SPACE_SCENE, &document, NULL), FFD_OK);
    ffd_status status = deform(document, add_one, false, &error);
    if (status == FFD_OK)
        status = save_with(document, &options, NULL, &error);
    assert_string_equal(error.message, "");
    assert_int_equal(status, FFD_OK);
    gltf->close(document);
}

/* Returns the JSON of a GLB, freed by the caller, and the offset of its BIN chunk. Chunks are whole words. */
static char *split_glb(const file_input *file, glb_layout *layout)
{
    assert_int_equal(ffd_glb_parse(file->data, file->size, "", layout, NULL), FFD_OK);
    assert_int_equal(layout->end, file->size);
    assert_int_equal(layout->json_size % 4, 0);
    assert_int_equal(layout->bin_size % 4, 0);
    char *text = calloc(layout->json_size + 1, 1);
    memcpy(text, file->data + layout->json_begin, layout->json_size);
    return text;
}

/* Checks the JSON, except for trailing spaces, and the bytes of the BIN chunk. */
static void check_container(const char *name, const char *expected, const void *bytes, size_t size)
{
    file_input file;
    glb_layout layout;
    assert_int_equal(ffd_file_load(in_folder(name), &file, NULL), FFD_OK);
    char *text = split_glb(&file, &layout);
    assert_true(layout.json_size >= strlen(expected));
    assert_memory_equal(text, expected, strlen(expected));
    assert_int_equal(strspn(text + strlen(expected), " "), layout.json_size - strlen(expected));
    assert_int_equal(layout.bin_size, size);
    assert_memory_equal(file.data + layout.bin_begin, bytes, size);
    free(text);
    ffd_file_unload(&file);
}

/* A buffer moves from its file into the BIN chunk and back. The rest of the JSON is the same text. */
static void containers_change(void **state)
{
    (void)state;
    const float triangle[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0}, moved[9] = {1, 0, 0, 2, 0, 0, 1, 1, 0},
                twice[9] = {2, 0, 0, 3, 0, 0, 2, 1, 0};
#define CONTAINER(uri, last, least, most)                                                                    \
    "{" ASSET ",\"buffers\":[{" uri "\"byteLength\":36" last "}]," VIEWS                                     \
    "],\"accessors\":[" ACCESSOR(least, most) "],\"meshes\":[" MESH("0") "],\"nodes\":[{\"mesh\":0}]}"
    put_text("text.gltf",
             "\xef\xbb\xbf " CONTAINER("\"uri\" : \"data%20.bin\" ,", "", "[0,0,0]", "[1,1,0]") "\n");
    put("data .bin", triangle, sizeof triangle);
    change_container("text.gltf", "binary.glb", FFD_FORMAT_GLB);

    check_container("binary.glb", CONTAINER("", "", "[1,0,0]", "[2,1,0]"), moved, sizeof moved);
    change_container("binary.glb", "text again.gltf", FFD_FORMAT_GLTF);
    check_text("text again.gltf", CONTAINER("", ",\"uri\":\"text%20again.bin\"", "[2,0,0]", "[3,1,0]"));
    check_bytes("text again.bin", twice, sizeof twice);
#undef CONTAINER
}

/* A GLB has one BIN chunk, for the first buffer; the others become data URIs. */
static void a_glb_holds_all_buffers(void **state)
{
    (void)state;
    const char first[] = "first", second[] = "2nd";
    put_text("many.gltf", "{" ASSET ",\"buffers\":[{\"byteLength\":5,\"uri\":\"one.bin\"},{\"byteLength\":3,"
                          "\"uri\":\"two.bin\"},{\"byteLength\":1,\"uri\":\"data:;base64,QQ==\"}]}");
    put("one.bin", first, strlen(first));
    put("two.bin", second, sizeof second); /* one byte more than byteLength */
    change_container("many.gltf", "many.glb", FFD_FORMAT_GLB);

    const char *const expected = "{" ASSET ",\"buffers\":[{\"byteLength\":5},{\"byteLength\":3,\"uri\":"
                                 "\"data:application/octet-stream;base64,Mm5k\"},{\"byteLength\":1,"
                                 "\"uri\":\"data:;base64,QQ==\"}]}";
    check_container("many.glb", expected, "first\0\0\0", 8);
}

#define PICTURE "\x89PNG\r\n\x1a\n..."

static void images_are_copied_or_referred_to(void **state)
{
    (void)state;
    ffd_error error = {0};
    log_lines lines = {{0}};
#define IMAGES(a, b, c) "{" ASSET ",\"images\":[{\"uri\":\"" a "\"},{\"uri\":\"" b "\"},{\"uri\":\"" c "\"}]}"
    const char *const text = IMAGES("tex/a%20b.png", "./tex/a b.png", "data:,x");
    assert_int_equal(mkdir(in_folder("tex"), 0777), 0);
    assert_int_equal(mkdir(in_folder("out"), 0777), 0);
    put_text("tex/a b.png", PICTURE);
    put_text("images.gltf", text);
    assert_int_equal(convert("images.gltf", "out/i.gltf", FFD_SPACE_SCENE, stay, false, FFD_RESOURCES_COPY,
                             &lines, &error),
                     FFD_OK);
    check_text("out/i.gltf", text);
    check_text("out/tex/a b.png", PICTURE);
    assert_string_equal(lines.text, "");
    /* Again: the copy exists already. */
    assert_int_equal(
        convert("images.gltf", "out/j.gltf", FFD_SPACE_SCENE, stay, false, FFD_RESOURCES_COPY, NULL, &error),
        FFD_OK);
    put_text("out/tex/a b.png", "another");
    assert_int_equal(
        convert("images.gltf", "out/k.gltf", FFD_SPACE_SCENE, stay, false, FFD_RESOURCES_COPY, NULL, &error),
        FFD_E_IO);
    assert_string_equal(error.file, in_folder("out/tex/a b.png"));
    assert_int_equal(access(in_folder("out/k.gltf"), F_OK), -1);

    assert_int_equal(convert("images.gltf", "out/r.gltf", FFD_SPACE_SCENE, stay, false,
                             FFD_RESOURCES_REFERENCE, NULL, &error),
                     FFD_OK);
    check_text("out/r.gltf", IMAGES("../tex/a%20b.png", "../tex/a%20b.png", "data:,x"));

    put_text("images.gltf", IMAGES("../secret.png", "none.png", "http://x/y.png"));
    assert_int_equal(
        convert("images.gltf", "out/o.gltf", FFD_SPACE_SCENE, stay, false, FFD_RESOURCES_COPY, NULL, &error),
        FFD_E_IO);
    assert_string_equal(error.pointer, "/images/0");
    put_text("images.gltf", IMAGES("none.png", "http://x/y.png", "none.png"));
    assert_int_equal(convert("images.gltf", "out/m.gltf", FFD_SPACE_SCENE, stay, false, FFD_RESOURCES_COPY,
                             &lines, &error),
                     FFD_OK);
    assert_non_null(strstr(lines.text, "the image \"none.png\" is missing and was not copied"));
#undef IMAGES
}

/* No file of the model replaces an image, either the input's or a copy. */
static void an_image_is_not_overwritten(void **state)
{
    (void)state;
    const float triangle[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
#define WITH_IMAGE(uri)                                                                                      \
    "{" ASSET ",\"images\":[{\"uri\":\"" uri                                                                 \
    "\"}],\"buffers\":[{\"byteLength\":36,\"uri\":\"pic-data.bin\"}]," VIEWS                                 \
    "],\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}],"             \
    "\"meshes\":[" MESH("0") "],\"nodes\":[{\"mesh\":0}]}"
    static const struct {
        const char *image, *text, *output, *file; /* file: the refused one */
    } cases[] = {
        /* Beside the input, where it would overwrite the image itself. */
        {"skin.bin", WITH_IMAGE("./skin.bin"), "skin.gltf", "skin.bin"},
        {"skin.gltf", WITH_IMAGE("skin.gltf"), "skin.gltf", "skin.gltf"},
        /* In another folder, where it would overwrite the copy. */
        {"skin.bin", WITH_IMAGE("a/../skin.bin"), "pics/skin.gltf", "pics/skin.bin"},
        {"skin.gltf", WITH_IMAGE("skin.gltf"), "pics/skin.gltf", "pics/skin.gltf"},
    };
    assert_int_equal(mkdir(in_folder("pics"), 0777), 0);
    put("pic-data.bin", triangle, sizeof triangle);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        mesh_document *document = NULL;
        ffd_error error = {0};
        put_text("pic.gltf", cases[i].text);
        put_text(cases[i].image, "picture");
        assert_int_equal(open_file(in_folder("pic.gltf"), FFD_SPACE_SCENE, &document, NULL), FFD_OK);
        assert_int_equal(deform(document, add_one, false, NULL), FFD_OK);
        assert_int_equal(save_to(document, in_folder(cases[i].output), &error), FFD_E_EXISTS);
        assert_string_equal(error.file, in_folder(cases[i].file));
        assert_non_null(strstr(error.message, "is also the path of the image \"skin."));
        gltf->close(document);
        check_text(cases[i].image, "picture");
        unlink(in_folder(cases[i].image));
    }
    assert_int_equal(rmdir(in_folder("pics")), 0); /* nothing was written */
#undef WITH_IMAGE
}

static void check_comparison(const char *first, const char *second, double tolerance, const char *difference)
{
    mesh_document *a = NULL, *b = NULL;
    ffd_comparison comparison = {.struct_size = sizeof comparison};
    assert_int_equal(open_bytes(first, strlen(first), "a", FFD_FORMAT_GLTF, FFD_SPACE_SCENE, &a, NULL),
                     FFD_OK);
    assert_int_equal(open_bytes(second, strlen(second), "b", FFD_FORMAT_GLTF, FFD_SPACE_SCENE, &b, NULL),
                     FFD_OK);
    ffd_difference_begin(&comparison, tolerance, 0);
    assert_int_equal(gltf->compare(a, b, &comparison, NULL), FFD_OK);
    assert_string_equal(comparison.first.text, difference);
    assert_int_equal(comparison.equal, !*difference);
    gltf->close(a);
    gltf->close(b);
}

static void compare_finds_what_differs(void **state)
{
    (void)state;
#define WITH(uri, max, extra)                                                                                \
    "{" ASSET "," extra "\"buffers\":[{\"byteLength\":36,\"uri\":\"" DATA_URI uri "\"}]," VIEWS              \
    "],\"accessors\":[" ACCESSOR("[0,0,0]", max) "],\"meshes\":[" MESH(                                      \
        "0") "],\"nodes\":[{\"mesh\":0,\"scale\":[2,1,1]}]}"
    const char *const base = WITH(TRIANGLE, "[1,1,0]", "");
    const struct {
        const char *text;
        double tolerance;
        const char *difference; /* "": equal */
    } cases[] = {
        {base, 0, ""},
        {WITH(TRIANGLE, "[1.0,1,0e1]", ""), 0, ""},
        {WITH(TRIANGLE, "[1,1,0]", "\"x\":1,"), 0, "/: only the second file has \"x\""},
        {WITH(TRIANGLE, "[2,1,0]", ""), 0, "/accessors/0/max/0: 1 and 2"},
        {WITH(TRIANGLE, "[2,1,0]", ""), 1.5, ""},
        {WITH(MOVED, "[2,1,0]", ""), 0, "/accessors/0: vertex 0: x differs by 2"},
        {WITH(MOVED, "[1,1,0]", ""), 0, "/accessors/0: vertex 0: x differs by 2"},
        {WITH(MOVED, "[2,1,0]", ""), 1.5, "/accessors/0: vertex 0: x differs by 2"},
        {WITH(MOVED, "[2,1,0]", ""), 2, ""},
    };
    const struct {
        const char *a, *b, *difference; /* "": equal */
    } numbers[] = {
        {"9007199254740993", "9007199254740993", ""},
        {"9007199254740993", "9007199254740992", "/x: 9007199254740993 and 9007199254740992"},
        {"-9007199254740993", "-9007199254740992", "/x: -9007199254740993 and -9007199254740992"},
        {"0", "-0", ""},
        {"1", "-1", "/x: 1 and -1"},
        {"100", "1e2", ""},
        {"1.50", "1.5", ""},
        {"1.5", "2", "/x: 1.5 and 2"},
    };
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        char first[64], second[64];
        snprintf(first, sizeof first, "{" ASSET ",\"x\":%s}", numbers[i].a);
        snprintf(second, sizeof second, "{" ASSET ",\"x\":%s}", numbers[i].b);
        check_comparison(first, second, 0, numbers[i].difference);
    }
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        check_comparison(base, cases[i].text, cases[i].tolerance, cases[i].difference);
    }
#undef WITH
}

/* Any allocation may fail: an error, no leak, no output. */
static void memory_may_run_out_anywhere(void **state)
{
    (void)state;
    const char *const text = "{" ASSET "," BUFFER(
        "36",
        TRIANGLE) "," VIEWS "],\"accessors\":[" OLD_ACCESSOR
                  "],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":0}}]}" TWO_NODES(
                      "0", "0");
    const char *const output = in_folder("memory.gltf");
    for (long successes = 0;; successes++) {
        ffd_error error = {0};
        ffd_alloc_fail_after(successes);
        const ffd_status status = run_all(text, strlen(text), "m.gltf", FFD_FORMAT_GLTF, FFD_SPACE_SCENE,
                                          move_by_place, output, &error);
        ffd_alloc_fail_after(-1);
        if (status == FFD_OK) {
            assert_true(successes > 50);
            break;
        }
        assert_int_equal(status, FFD_E_MEMORY);
        assert_int_equal(access(output, F_OK), -1);
    }
    assert_int_equal(access(output, F_OK), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(only_what_changes_is_replaced),
        cmocka_unit_test(odd_data_uris_become_plain),
        cmocka_unit_test(a_mesh_under_two_nodes_is_copied_where_they_differ),
        cmocka_unit_test(nodes_that_agree_share_a_copy),
        cmocka_unit_test(a_node_outside_the_scene_keeps_its_mesh),
        cmocka_unit_test(other_users_of_the_bytes_keep_them),
        cmocka_unit_test(accessors_of_the_same_bytes_that_agree_stay),
        cmocka_unit_test(interleaved_attributes_change_in_place),
        cmocka_unit_test(glb_lengths_and_padding_follow),
        cmocka_unit_test(buffer_files_are_named_after_the_output),
        cmocka_unit_test(in_place_buffers_are_named_after_the_file),
        cmocka_unit_test(containers_change),
        cmocka_unit_test(a_glb_holds_all_buffers),
        cmocka_unit_test(images_are_copied_or_referred_to),
        cmocka_unit_test(an_image_is_not_overwritten),
        cmocka_unit_test(compare_finds_what_differs),
        cmocka_unit_test(memory_may_run_out_anywhere),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
