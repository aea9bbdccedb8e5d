/* test_materials.c - materials of glTF files and of OBJ libraries: base colours, opacity, emission, and which
   images are loaded. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/test_folder.h"
#include "base/memory/memory.h"
#include "base/text/base64.h"
#include "io/formats.h"
#include "mesh/mesh.h"
#include <math.h>
#include <meshoptimizer.h>
#include <sys/stat.h>

#define PNG "\x89PNG\r\n\x1a\n"
#define PNG_SIZE 8
#define JPEG "\xff\xd8\xff\xe0"

static mesh_materials found;
static ffd_error error;
static char logged[4000]; /* lines of the log */
static size_t line_count;

static void keep_line(void *user, ffd_log_level level, const char *line)
{
    (void)user;
    assert_int_equal(level, FFD_LOG_WARNING);
    assert_null(strpbrk(line, "\r\n"));
    assert_true(strlen(logged) + strlen(line) + 2 < sizeof logged);
    strcat(strcat(logged, line), "\n");
    line_count++;
}

/* Lists the materials of bytes as if they were the file `path`. */
static ffd_status list_bytes(ffd_format format, const char *path, const void *bytes, size_t size)
{
    const mesh_log log = {keep_line, NULL};
    const ffd_source source = {.path = path, .format = format};
    const mesh_format *const table = ffd_format_table(format);
    mesh_document *document = NULL;
    file_input input = {.data = bytes, .size = size};
    ffd_materials_free(&found);
    *logged = 0;
    line_count = 0;
    error = (ffd_error){0};
    ffd_status status = ffd_format_open(table, &input, &source, &document, &error);
    if (status)
        return status;
    status = table->list_materials(document, &log, &found, &error);
    table->close(document);
    return status;
}

static void list_gltf(const char *members)
{
    static char text[300000];
    assert_true(snprintf(text, sizeof text, "{\"asset\":{\"version\":\"2.0\"},%s}", members) <
                (int)sizeof text);
    const ffd_status status = list_bytes(FFD_FORMAT_GLTF, in_folder("m.gltf"), text, strlen(text));
    if (status)
        fail_msg("%s: %s", members, error.message);
}

static void list_obj(const char *text)
{
    const ffd_status status = list_bytes(FFD_FORMAT_OBJ, in_folder("m.obj"), text, strlen(text));
    if (status)
        fail_msg("%s: %s", text, error.message);
}

/* Lists the materials of an OBJ with this library. */
static void list_library(const char *text)
{
    put_text("m.mtl", text);
    list_obj("mtllib m.mtl\nv 0 0 0\n");
}

static void check_colour(size_t i, double red, double green, double blue, double alpha)
{
    const double expected[4] = {red, green, blue, alpha};
    assert_true(i < found.count);
    for (size_t c = 0; c < 4; c++)
        if (!(fabs(found.list[i].color[c] - expected[c]) <= 1e-7))
            fail_msg("material %zu has %g at %zu, not %g", i, found.list[i].color[c], c, expected[c]);
}

static void check_alpha(size_t i, material_alpha alpha, double cutoff)
{
    assert_int_equal(found.list[i].alpha, alpha);
    assert_true(found.list[i].alpha_cutoff <= cutoff && found.list[i].alpha_cutoff >= cutoff);
}

static void check_emission(size_t i, double red, double green, double blue)
{
    const double expected[3] = {red, green, blue};
    for (size_t c = 0; c < 3; c++)
        if (!(fabs(found.list[i].emission[c] - expected[c]) <= 1e-7))
            fail_msg("material %zu emits %g at %zu, not %g", i, found.list[i].emission[c], c, expected[c]);
}

static void check_wrap(size_t i, texture_wrap u, texture_wrap v)
{
    assert_int_equal(found.list[i].base.wrap[0], u);
    assert_int_equal(found.list[i].base.wrap[1], v);
}

/* Checks that a material's image is this text, after the signature of PNG. */
static void check_image(size_t i, const char *name, const char *text)
{
    assert_true(i < found.count);
    assert_true(found.list[i].base.image < found.image_count);
    const mesh_image *const image = &found.images[found.list[i].base.image];
    assert_string_equal(image->name, name);
    assert_int_equal(image->size, PNG_SIZE + strlen(text));
    assert_memory_equal(image->bytes, PNG, PNG_SIZE);
    assert_memory_equal(image->bytes + PNG_SIZE, text, strlen(text));
}

static void check_no_image(size_t i)
{
    assert_true(i < found.count);
    assert_int_equal(found.list[i].base.image, MATERIAL_NONE);
}

static void check_lost_image(size_t i)
{
    assert_true(i < found.count);
    assert_int_equal(found.list[i].base.image, MATERIAL_LOST);
}

static void put_png(const char *name, const char *text)
{
    char bytes[100];
    assert_true(strlen(text) < sizeof bytes - PNG_SIZE);
    memcpy(bytes, PNG, PNG_SIZE);
    memcpy(bytes + PNG_SIZE, text, strlen(text));
    put(name, bytes, PNG_SIZE + strlen(text));
}

static void colours_of_gltf(void **state)
{
    (void)state;
    list_gltf(
        "\"materials\":[{\"name\":\"a\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.25,0.5,0,0.75]}},"
        "{\"doubleSided\":true},{\"pbrMetallicRoughness\":{\"metallicFactor\":0},\"doubleSided\":1,"
        "\"extensions\":{\"KHR_materials_pbrSpecularGlossiness\":{\"diffuseFactor\":[0,1,0.5,1]}}},"
        "{\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.5,0.5,0.5,1]},\"extensions\":"
        "{\"KHR_materials_pbrSpecularGlossiness\":{\"diffuseFactor\":[0,1,0.5,1]}}}]");
    assert_int_equal(found.count, 4);
    assert_int_equal(line_count, 0);
    assert_string_equal(found.list[0].name, "a");
    assert_string_equal(found.list[1].name, "");
    check_colour(0, 0.25, 0.5, 0, 0.75);
    check_colour(1, 1, 1, 1, 1);
    check_colour(2, 0, 1, 0.5, 1);
    check_colour(3, 0.5, 0.5, 0.5, 1);
    assert_false(found.list[0].is_double_sided || found.list[2].is_double_sided);
    assert_true(found.list[1].is_double_sided);
    for (size_t i = 0; i < 4; i++) {
        check_no_image(i);
        check_alpha(i, MATERIAL_OPAQUE, 0);
        check_wrap(i, TEXTURE_REPEAT, TEXTURE_REPEAT);
    }
}

static void alpha_of_gltf(void **state)
{
    (void)state;
    list_gltf("\"materials\":[{\"alphaMode\":\"OPAQUE\",\"alphaCutoff\":0.3},{\"alphaMode\":\"MASK\"},"
              "{\"alphaMode\":\"MASK\",\"alphaCutoff\":0.25},{\"alphaMode\":\"BLEND\",\"alphaCutoff\":0.3},"
              "{\"alphaMode\":\"mask\"},{\"alphaMode\":\"MASK\",\"alphaCutoff\":-1},{\"alphaMode\":7},"
              "{\"alphaMode\":\"MASK\",\"alphaCutoff\":1e999},{\"alphaCutoff\":0.3}]");
    static const double cutoffs[] = {0, 0.5, 0.25, 0, 0, 0.5, 0, 0.5, 0};
    for (size_t i = 0; i < sizeof cutoffs / sizeof *cutoffs; i++)
        check_alpha(i,
                    cutoffs[i] > 0 ? MATERIAL_MASK
                    : i == 3       ? MATERIAL_BLEND
                                   : MATERIAL_OPAQUE,
                    cutoffs[i]);
}

static void light_of_gltf(void **state)
{
    (void)state;
    put_png("a.png", "base");
    put_png("b.png", "glow");
    list_gltf(
        "\"materials\":[{\"emissiveFactor\":[1,0.5,0.25]},{\"emissiveFactor\":[1,0.5,0.25],\"extensions\":{"
        "\"KHR_materials_emissive_strength\":{\"emissiveStrength\":4},\"KHR_materials_unlit\":{}}},"
        "{\"emissiveFactor\":[1,1],\"extensions\":{\"KHR_materials_emissive_strength\":{"
        "\"emissiveStrength\":-4}}},{\"emissiveFactor\":[1,1,1],\"emissiveTexture\":{\"index\":1},"
        "\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0}}},{\"emissiveTexture\":{\"index\":9}}],"
        "\"textures\":[{\"source\":0},{\"source\":1,\"sampler\":0}],\"samplers\":[{\"wrapS\":33071}],"
        "\"images\":[{\"uri\":\"a.png\"},{\"uri\":\"b.png\"}]");
    check_emission(0, 1, 0.5, 0.25);
    check_emission(1, 4, 2, 1);
    check_emission(2, 1, 1, 0);
    assert_false(found.list[0].is_unlit || found.list[3].is_unlit);
    assert_true(found.list[1].is_unlit);
    check_image(3, "a.png", "base");
    assert_string_equal(found.images[found.list[3].glow.image].name, "b.png");
    assert_int_equal(found.list[3].glow.wrap[0], TEXTURE_CLAMP);
    check_wrap(3, TEXTURE_REPEAT, TEXTURE_REPEAT);
    assert_int_equal(found.list[4].glow.image, MATERIAL_LOST);
    check_no_image(4);
}

/* A material with texture n. */
#define TEXTURED(n) "{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":" #n "}}}"

static void images_of_gltf_once_each(void **state)
{
    (void)state;
    put_png("a.png", "file");
    put("b 1.jpg", JPEG, 4);
    list_gltf("\"materials\":[" TEXTURED(0) "," TEXTURED(1) "," TEXTURED(2) "," TEXTURED(0) "," TEXTURED(
        3) "],"
           "\"textures\":[{\"source\":0},{\"source\":1,\"sampler\":0},{\"source\":2,\"sampler\":1},{"
           "\"source\":3}],"
           "\"samplers\":[{\"wrapS\":33071,\"wrapT\":33648},{\"wrapS\":1,\"wrapT\":\"x\"}],"
           "\"images\":[{\"uri\":\"a.png\"},{\"uri\":\"data:image/"
           "png;base64,iVBORw0KGgpkYXRh\",\"name\":\"inner\"},"
           "{\"uri\":\"./b%201.jpg\"},{\"uri\":\"x/../a.png\"}]");
    assert_int_equal(found.count, 5);
    assert_int_equal(found.image_count, 3);
    check_image(0, "a.png", "file");
    check_image(1, "inner", "data");
    assert_int_equal(found.list[2].base.image, 2);
    assert_string_equal(found.images[2].name, "b 1.jpg");
    assert_int_equal(found.list[3].base.image, found.list[0].base.image);
    assert_int_equal(found.list[4].base.image, found.list[0].base.image);
    check_wrap(0, TEXTURE_REPEAT, TEXTURE_REPEAT);
    check_wrap(1, TEXTURE_CLAMP, TEXTURE_MIRROR);
    check_wrap(2, TEXTURE_REPEAT, TEXTURE_REPEAT);
    assert_int_equal(line_count, 0);
}

static void an_older_texture_stands_in(void **state)
{
    (void)state;
    put_png("a.png", "base");
    put_png("b.png", "older");
#define OLDER                                                                                                \
    "\"extensions\":{\"KHR_materials_pbrSpecularGlossiness\":{\"diffuseFactor\":[0,0,1,1],"                  \
    "\"diffuseTexture\":{\"index\":1}}}"
    list_gltf("\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,0,0,1]}," OLDER "},"
              "{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0}}," OLDER "}],"
              "\"textures\":[{\"source\":0},{\"source\":1}],"
              "\"images\":[{\"uri\":\"a.png\"},{\"uri\":\"b.png\"}]");
    check_image(0, "b.png", "older");
    check_colour(0, 0, 0, 1, 1);
    check_image(1, "a.png", "base");
    check_colour(1, 1, 1, 1, 1);
}

static void put_number(char *at, size_t number)
{
    for (size_t i = 0; i < 4; i++)
        at[i] = (char)(unsigned char)(number >> 8 * i);
}

static void an_image_in_a_glb(void **state)
{
    (void)state;
    static const char text[] =
        "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":16}],\"bufferViews\":[{"
        "\"buffer\":0,\"byteOffset\":4,\"byteLength\":11}],\"materials\":[" TEXTURED(
            0) "],\"textures\":[{\"source\":0}],\"images\":[{\"bufferView\":0}]}";
    char bytes[sizeof text + 64] = "glTF\2";
    const size_t padded = (sizeof text - 1 + 3) / 4 * 4, bin = 20 + padded, size = bin + 8 + 16;
    put_number(bytes + 8, size);
    put_number(bytes + 12, padded);
    memcpy(bytes + 16, "JSON", 4);
    memset(bytes + 20, ' ', padded);
    memcpy(bytes + 20, text, sizeof text - 1);
    put_number(bytes + bin, 16);
    memcpy(bytes + bin + 4, "BIN\0....\x89PNG\r\n\x1a\nbin.", 20);
    assert_int_equal(list_bytes(FFD_FORMAT_GLB, in_folder("m.glb"), bytes, size), FFD_OK);
    check_image(0, "image 0", "bin");
    assert_int_equal(line_count, 0);
}

/* One plain image, and one that is compressed like numbers. */
static void images_in_buffers(void **state)
{
    (void)state;
    static const char png[] = PNG "compressed";
    unsigned char packed[400];
    char digits[600], text[2400];
    const size_t plain = PNG_SIZE + 4, size = sizeof png - 1 - 2; /* a multiple of 4 */
    memcpy(packed, PNG "view", plain);
    const size_t packed_size =
        meshopt_encodeVertexBuffer(packed + plain, sizeof packed - plain, png, size / 4, 4);
    ffd_base64_encode(packed, plain + packed_size, digits);
    digits[ffd_base64_length(plain + packed_size)] = 0;
    snprintf(
        text, sizeof text,
        "\"extensionsUsed\":[\"EXT_meshopt_compression\"],\"buffers\":[{\"byteLength\":%zu,\"uri\":"
        "\"data:application/octet-stream;base64,%s\"}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":%zu},"
        "{\"buffer\":0,\"byteLength\":%zu,\"extensions\":{\"EXT_meshopt_compression\":{\"buffer\":0,"
        "\"byteOffset\":%zu,\"byteLength\":%zu,\"byteStride\":4,\"count\":%zu,\"mode\":\"ATTRIBUTES\"}}}],"
        "\"materials\":[" TEXTURED(0) "," TEXTURED(1) "," TEXTURED(
            2) "],"
               "\"textures\":[{\"source\":0},{\"source\":1},{\"source\":2}],\"images\":[{\"bufferView\":0,"
               "\"mimeType\":\"image/png\"},{\"bufferView\":1},{\"bufferView\":0,\"name\":\"again\"}]",
        plain + packed_size, digits, plain, size, plain, packed_size, size / 4);
    list_gltf(text);
    assert_int_equal(found.image_count, 2);
    check_image(0, "image 0", "view");
    check_image(1, "image 1", "compress");
    assert_int_equal(found.list[2].base.image, found.list[0].base.image);
    assert_int_equal(line_count, 0);
}

static void only_extensions_have_the_image(void **state)
{
    (void)state;
    put_png("a.png", "");
    put("w.webp", "RIFF\4\0\0\0WEBP", 12);
    list_gltf("\"materials\":[" TEXTURED(0) "," TEXTURED(1) "," TEXTURED(1) "," TEXTURED(
        2) "],"
           "\"textures\":[{\"source\":0,\"extensions\":{\"EXT_texture_webp\":{\"source\":0}}},"
           "{\"extensions\":{\"KHR_texture_basisu\":{\"source\":0}}},"
           "{\"source\":7,\"extensions\":{\"EXT_texture_webp\":{\"source\":1}}}],\"images\":[{\"uri\":\"a."
           "png\"},"
           "{\"uri\":\"w.webp\"}]");
    check_image(0, "a.png", "");
    for (size_t i = 1; i < 3; i++)
        check_lost_image(i);
    assert_string_equal(found.images[found.list[3].base.image].name, "w.webp");
    assert_string_equal(logged, "1 image of a material cannot be shown: \"texture 1\" has an image of "
                                "KHR_texture_basisu only\n");
}

/* Makes files that must not be read: a hidden file, a link, a FIFO, and files that are not images. */
static void put_traps(void)
{
    put_png(".hidden.png", "");
    put_png("real.png", "");
    unlink(in_folder("link.png"));
    unlink(in_folder("pipe.png"));
    assert_int_equal(symlink("real.png", in_folder("link.png")), 0);
    assert_int_equal(mkfifo(in_folder("pipe.png"), 0600), 0);
    put_text("text.png", "no image");
    put("t.tga", "\0\0\2\0\0\0\0\0\0\0\0\0\1\0\1\0\30\0\1\2\3", 21);
    put_png("secret", "");
}

static const char *const traps[][2] = {{"none.png", "is missing"},
                                       {".hidden.png", "is a hidden file or in a hidden folder"},
                                       {"link.png", "is reached through a link"},
                                       {"pipe.png", "cannot be read"},
                                       {"text.png", "does not have the content of an image"},
                                       {"t.tga", "is neither PNG, JPEG nor WebP"},
                                       {"secret", "does not have the ending of an image"},
                                       {"../real.png", "is outside the model's folder"}};
#define TRAPS (sizeof traps / sizeof *traps)

static void images_that_cannot_be_had(void **state)
{
    (void)state;
    char text[1000], expected[300];
    put_traps();
    for (size_t i = 0; i < TRAPS; i++) {
        snprintf(expected, sizeof expected, "1 image of a material cannot be shown: \"%s\" %s\n", traps[i][0],
                 traps[i][1]);
        snprintf(text, sizeof text,
                 "\"materials\":[" TEXTURED(0) "," TEXTURED(0) "],\"textures\":[{\"source\":0}],\"images\":"
                                                               "[{\"uri\":\"%s\"}]",
                 traps[i][0]);
        list_gltf(text);
        check_lost_image(1);
        assert_string_equal(logged, expected);
        snprintf(text, sizeof text, "newmtl a\nmap_Kd %s\nnewmtl b\nmap_Kd %s\n", traps[i][0], traps[i][0]);
        list_library(text);
        check_lost_image(1);
        assert_string_equal(logged, expected);
    }
}

static void one_line_says_all(void **state)
{
    (void)state;
    list_library("newmtl a\nmap_Kd 1.png\nnewmtl b\nmap_Kd /2.png\nnewmtl c\nmap_Kd \x01"
                 "3.png\nnewmtl d\nmap_Kd 4.png\nnewmtl e\nmap_Kd 5.png\nnewmtl f\nmap_Kd /2.png\n");
    assert_string_equal(logged,
                        "5 images of materials cannot be shown: \"1.png\" is missing, \"/2.png\" is outside "
                        "the model's folder, \"?3.png\" is missing and 2 more\n");
    list_gltf("\"materials\":[" TEXTURED(0) "," TEXTURED(1) "," TEXTURED(2) "," TEXTURED(
        3) "],"
           "\"textures\":[{\"source\":0},{\"source\":1},{\"source\":2},{\"source\":3}],\"images\":["
           "{\"uri\":\"https://a.b/c.png\"},{\"uri\":\"data:image/png;base64,?\",\"name\":\"odd\"},{},"
           "{\"bufferView\":3}]");
    assert_string_equal(logged,
                        "4 images of materials cannot be shown: \"image 0\" is outside the model's folder, "
                        "\"odd\" is not valid base64, \"image 2\" has no bytes and 1 more\n");
}

static void standard_input_has_no_folder(void **state)
{
    (void)state;
    static const char obj[] = "mtllib m.mtl\nv 0 0 0\n";
    static const char text[] = "{\"asset\":{\"version\":\"2.0\"},\"materials\":[" TEXTURED(
        0) "],\"textures\":"
           "[{\"source\":0}],\"images\":[{\"uri\":\"a.png\"}]}";
    assert_int_equal(list_bytes(FFD_FORMAT_OBJ, "-", obj, sizeof obj - 1), FFD_OK);
    assert_int_equal(found.count, 0);
    assert_string_equal(logged,
                        "1 material library cannot be read, and its materials are unknown: \"m.mtl\" is a "
                        "file, and standard input has no folder\n");
    assert_int_equal(list_bytes(FFD_FORMAT_GLTF, "-", text, sizeof text - 1), FFD_OK);
    check_lost_image(0);
    assert_string_equal(logged,
                        "1 image of a material cannot be shown: \"a.png\" is a file, and standard input "
                        "has no folder\n");
}

/* Values that glTF does not allow are ignored. */
static void hostile_json(void **state)
{
    (void)state;
    static const char *const materials[] = {
        "7",
        "\"x\"",
        "[]",
        "{\"name\":7}",
        "{\"pbrMetallicRoughness\":[1]}",
        "{\"pbrMetallicRoughness\":{\"baseColorFactor\":\"x\"}}",
        "{\"pbrMetallicRoughness\":{\"baseColorFactor\":{\"a\":0,\"b\":0}}}",
        "{\"pbrMetallicRoughness\":{\"baseColorFactor\":[-1,1e300,\"x\",1e999,0,0]}}",
        "{\"pbrMetallicRoughness\":{\"baseColorFactor\":[]},\"extensions\":7}",
        "{\"alphaMode\":[],\"alphaCutoff\":{}}",
        "{\"doubleSided\":\"true\"}"};
    static const char *const textures[] = {"1", "-1", "1e300", "0.5", "\"0\"", "{}", "4294967296", "null"};
    static char text[3000];
    for (size_t i = 0; i < sizeof materials / sizeof *materials; i++) {
        snprintf(text, sizeof text, "\"materials\":[%s]", materials[i]);
        list_gltf(text);
        assert_int_equal(found.count, 1);
        check_colour(0, 1, 1, 1, 1);
        check_alpha(0, MATERIAL_OPAQUE, 0);
        check_emission(0, 0, 0, 0);
        assert_false(found.list[0].is_double_sided);
        assert_int_equal(line_count, 0);
    }
    for (size_t i = 0; i < sizeof textures / sizeof *textures; i++) {
        snprintf(text, sizeof text,
                 "\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":%s}}}," TEXTURED(
                     0) ",{\"pbrMetallicRoughness\":{\"baseColorTexture\":%s}}],\"textures\":[{\"source\":%s,"
                        "\"sampler\":%s}],"
                        "\"samplers\":[{\"wrapS\":%s}],\"images\":[{\"byteLength\":%s}]",
                 textures[i], textures[i], textures[i], textures[i], textures[i], textures[i]);
        list_gltf(text);
        check_lost_image(0);
        check_lost_image(1);
        check_wrap(1, TEXTURE_REPEAT, TEXTURE_REPEAT);
        assert_string_equal(
            logged, "2 images of materials cannot be shown: \"a texture\" that a material names is not "
                    "there, \"texture 0\" names an image that is not there\n");
    }
    list_gltf("\"materials\":7,\"textures\":\"x\",\"samplers\":{\"a\":1}");
    assert_int_equal(found.count, 0);
    list_gltf("\"materials\":[" TEXTURED(0) "," TEXTURED(1) "],\"textures\":[1,{}]");
    assert_string_equal(
        logged, "2 images of materials cannot be shown: \"texture 0\" has no image, \"texture 1\" has no "
                "image\n");
}

static void long_names(void **state)
{
    (void)state;
    enum { LONG = 100000 };
    static char name[LONG + 1], text[2 * LONG + 500];
    memset(name, 'n', LONG);
    snprintf(
        text, sizeof text,
        "\"materials\":[{\"name\":\"%s\",\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0}}}],"
        "\"textures\":[{\"source\":0}],\"images\":[{\"uri\":\"%s.png\"}]",
        name, name);
    list_gltf(text);
    assert_string_equal(found.list[0].name, name);
    check_lost_image(0);
    assert_true(line_count == 1 && strlen(logged) < 200);
    snprintf(text, sizeof text, "newmtl %s\nmap_Kd %s.png\n", name, name);
    list_library(text);
    assert_string_equal(found.list[0].name, name);
    assert_true(line_count == 1 && strlen(logged) < 200);
}

static void colours_of_libraries(void **state)
{
    (void)state;
    list_library(
        "# exported\nnewmtl a b \t\r\nKd 0.5 0 1\nnewmtl none\nnewmtl d\nd 0.25\nTr 0.5\nnewmtl halo\n"
        "d -halo 0.75\nnewmtl tr\nTr 0.75\nnewmtl grey\nkd 0.5\nnewmtl xyz\nKd xyz 0 0 0\nnewmtl black\n"
        "Kd 0 0 0\nnewmtl mapped\nKd 0 0 0\nmap_Kd none.png\nnewmtl odd\nKd -1 2 nan\nd 7\nTr x\n"
        "newmtl tr\nKd 0 0 1\nTr 0\nnewmtl\nKd 0 0 0\nnewmtl leaves\nmap_d a.png\n");
    const double half = 0.21404114048223255; /* ((0.5 + 0.055) / 1.055) ^ 2.4 */
    static const char *const names[] = {"a b", "none",  "d",      "halo", "tr",    "grey",
                                        "xyz", "black", "mapped", "odd",  "leaves"};
    assert_int_equal(found.count, 11);
    for (size_t i = 0; i < found.count; i++) {
        assert_string_equal(found.list[i].name, names[i]);
        assert_true(found.list[i].is_double_sided);
        (i == 8 ? check_lost_image : check_no_image)(i);
        check_alpha(i, (i >= 2 && i <= 4) || i == 10 ? MATERIAL_BLEND : MATERIAL_OPAQUE, 0);
    }
    check_colour(0, half, 0, 1, 1);
    check_colour(1, 1, 1, 1, 1);
    check_colour(2, 1, 1, 1, 0.25);
    check_colour(3, 1, 1, 1, 0.75);
    check_colour(4, 1, 1, 1, 0.25);
    check_colour(5, half, half, half, 1);
    check_colour(6, 1, 1, 1, 1);
    check_colour(7, 0, 0, 0, 1);
    check_colour(8, 1, 1, 1, 1);
    check_colour(9, 1, 1, 1, 1);
}

/* Checks the opacity of the only material of a library, and whether it is opaque. */
static void check_opacity(const char *statements, double opacity, material_alpha alpha)
{
    char text[300];
    snprintf(text, sizeof text, "newmtl a\n%s\n", statements);
    list_library(text);
    if (!(fabs(found.list[0].color[3] - opacity) <= 1e-12) || found.list[0].alpha != alpha)
        fail_msg("%s: %g and %d", statements, found.list[0].color[3], (int)found.list[0].alpha);
}

static void clearness_that_means_opaque(void **state)
{
    (void)state;
    static const char line[] = "\"Tr 1\" of 1 material is taken for opaque: no material has another Tr\n";
    check_opacity("Tr 1.000000", 1, MATERIAL_OPAQUE);
    assert_string_equal(logged, line);
    check_opacity("Tr 1.0\nTr 1", 1, MATERIAL_OPAQUE);
    check_opacity("Tr 1\nmap_d none.png", 1, MATERIAL_BLEND);
    check_opacity("Tr 0.999", 0.001, MATERIAL_BLEND);
    check_opacity("Tr 0", 1, MATERIAL_OPAQUE);
    check_opacity("d 1\nTr 1", 1, MATERIAL_OPAQUE);
    assert_string_equal(logged, "");
    check_opacity("d 0\nTr 0", 1, MATERIAL_OPAQUE);
    check_opacity("d 0\nTr 1", 0, MATERIAL_BLEND);
    check_opacity("d 0", 0, MATERIAL_BLEND);
    check_opacity("d 0\nmap_Kd none.png", 0, MATERIAL_BLEND);
    check_opacity("d 0\nmap_d none.png", 1, MATERIAL_BLEND);
    list_library("newmtl a\nTr 1\nnewmtl b\nnewmtl c\nd 0.5\nTr 0.5\nnewmtl d\nTr 1\n");
    assert_string_equal(logged, "\"Tr 1\" of 2 materials is taken for opaque: no material has another Tr\n");
    static const double all_say_one[] = {1, 1, 0.5, 1}, one_differs[] = {0, 1, 1};
    for (size_t i = 0; i < 4; i++)
        check_colour(i, 1, 1, 1, all_say_one[i]);
    /* of all libraries together */
    put_text("n.mtl", "newmtl b\nnewmtl c\nTr 0\n");
    put_text("m.mtl", "newmtl a\nTr 1\n");
    list_obj("mtllib m.mtl n.mtl\nv 0 0 0\n");
    assert_string_equal(logged, "");
    for (size_t i = 0; i < 3; i++)
        check_colour(i, 1, 1, 1, one_differs[i]);
}

static void light_of_libraries(void **state)
{
    (void)state;
    put_png("a.png", "one");
    put_png("b.png", "two");
    list_library(
        "newmtl a\nKe 0.5 0 1\nmap_Kd a.png\nmap_Ke -s 2 3 -o 0.5 -clamp on b.png\nnewmtl b\nKe 0 0 0\n"
        "map_Ke b.png\nnewmtl c\nKe 0 0 0\nnewmtl d\nmap_Kd a.png\nmap_d ./a.png\nnewmtl e\n"
        "map_Kd a.png\nmap_D b.png\n");
    check_emission(0, 0.21404114048223255, 0, 1);
    check_emission(1, 1, 1, 1);
    check_emission(2, 0, 0, 0);
    const mesh_texture *const glow = &found.list[0].glow;
    assert_string_equal(found.images[glow->image].name, "b.png");
    assert_int_equal(glow->wrap[0], TEXTURE_CLAMP);
    assert_true(glow->scale[0] + glow->scale[1] / 10 == 2.3 && glow->offset[0] == 0.5 &&
                glow->offset[1] == 0);
    assert_true(found.list[0].base.scale[0] == 1 && found.list[0].base.offset[0] == 0);
    assert_int_equal(found.list[2].glow.image, MATERIAL_NONE);
    /* An image that is its own map of opacity counts once. */
    assert_int_equal(found.list[3].alpha, MATERIAL_BLEND);
    assert_int_equal(found.list[3].opacity.image, MATERIAL_NONE);
    assert_int_equal(found.list[4].alpha, MATERIAL_BLEND);
    assert_string_equal(found.images[found.list[4].opacity.image].name, "b.png");
    assert_string_equal(logged, "");
}

static void maps_of_libraries(void **state)
{
    (void)state;
    mkdir(in_folder("lib"), 0777);
    put_png("lib/a b.png", "near");
    put_png("far.png", "far");
    put_png("a b.png", "other");
    put_text("lib/x.mtl",
             "newmtl one\nmap_Kd -clamp on -s 2 2 2 -o 0 0 0 a b.png\nnewmtl two\nmap_Kd -clamp off "
             "far.png\nnewmtl three\nMAP_KD old.png\nmap_Kd .\\far.png\nmap_Kd\nmap_Ks none.png\n");
    put_text("y.mtl", "newmtl two\nKd 1 0 0\nmap_Kd none.png\nnewmtl four\nKd 1 0 0\nmap_Kd a b.png\n");
    list_obj("mtllib lib/x.mtl\nv 0 0 0\nmtllib y.mtl lib/x.mtl\n");
    assert_int_equal(found.count, 4);
    assert_int_equal(found.image_count, 3);
    check_image(0, "lib/a b.png", "near");
    check_image(1, "far.png", "far");
    check_image(2, "far.png", "far");
    check_image(3, "a b.png", "other");
    check_colour(1, 1, 1, 1, 1);
    check_colour(3, 1, 0, 0, 1);
    check_wrap(0, TEXTURE_CLAMP, TEXTURE_CLAMP);
    check_wrap(1, TEXTURE_REPEAT, TEXTURE_REPEAT);
    assert_string_equal(logged, "");
}

/* Of -s and -o numbers may be left out: a name that begins with one is none. */
static void names_that_begin_with_a_number(void **state)
{
    (void)state;
    put_png("512.png", "a");
    put_png("2d.png", "b");
    put_png("-1.png", "c");
    list_library("newmtl a\nmap_Kd -s 3 512.png\nnewmtl b\nmap_Kd -o 0.5 2d.png\nnewmtl c\n"
                 "map_Kd -s 2 4 -o 0.25 -1.png\n");
    check_image(0, "512.png", "a");
    check_image(1, "2d.png", "b");
    check_image(2, "-1.png", "c");
    const double expected[3][4] = {{3, 1, 0, 0}, {1, 1, 0.5, 0}, {2, 4, 0.25, 0}};
    for (size_t i = 0; i < 3; i++) {
        assert_memory_equal(found.list[i].base.scale, expected[i], 2 * sizeof(double));
        assert_memory_equal(found.list[i].base.offset, expected[i] + 2, 2 * sizeof(double));
    }
    assert_string_equal(logged, "");
}

static void libraries_that_cannot_be_read(void **state)
{
    (void)state;
    unlink(in_folder("pipe.mtl"));
    assert_int_equal(mkfifo(in_folder("pipe.mtl"), 0600), 0);
    put_text("odd.mtl", "Kd 1 1 1\n");
    put_text("m.mtl", "newmtl a\n");
    list_obj("mtllib pipe.mtl\nmtllib odd.mtl\nmtllib /etc/x.mtl\nmtllib ../m.mtl\nmtllib m.mtl\nv 0 0 0\n");
    assert_int_equal(found.count, 1);
    assert_string_equal(
        logged, "4 material libraries cannot be read, and their materials are unknown: \"pipe.mtl\" cannot "
                "be read, \"odd.mtl\" does not have the content of a material library, \"/etc/x.mtl\" is "
                "outside the model's folder and 1 more\n");
}

/* A short file may use 100 MB, and its images together need more. */
static void images_count_in_the_budget(void **state)
{
    (void)state;
    for (int i = 0; i < 2; i++) {
        const char *const path = in_folder(i == 0 ? "large1.png" : "large2.png");
        put_png(i == 0 ? "large1.png" : "large2.png", "");
        assert_int_equal(truncate(path, 60000000), 0);
    }
    put_text("m.mtl", "newmtl a\nmap_Kd large1.png\nnewmtl b\nmap_Kd large1.png\n");
    static const char obj[] = "mtllib m.mtl\nv 0 0 0\n";
    assert_int_equal(list_bytes(FFD_FORMAT_OBJ, in_folder("m.obj"), obj, sizeof obj - 1), FFD_OK);
    put_text("m.mtl", "newmtl a\nmap_Kd large1.png\nnewmtl b\nmap_Kd large2.png\n");
    assert_int_equal(list_bytes(FFD_FORMAT_OBJ, in_folder("m.obj"), obj, sizeof obj - 1), FFD_E_LIMIT);
    assert_string_equal(error.file, in_folder("m.obj"));
    assert_string_equal(error.message,
                        "the image \"large2.png\" needs more than the 100 MB of memory allowed "
                        "(input.memory raises this)");
}

static void memory_may_run_out_anywhere(void **state)
{
    (void)state;
    static const char text[] =
        "{\"asset\":{\"version\":\"2.0\"},\"materials\":[{\"name\":\"a\",\"pbrMetallicRoughness\":{"
        "\"baseColorTexture\":{\"index\":0}}}," TEXTURED(1) "," TEXTURED(2) "," TEXTURED(
            3) "],\"textures\":["
               "{\"source\":0},{\"source\":1},{\"source\":2},{}],\"images\":[{\"uri\":\"a.png\"},{\"uri\":"
               "\"data:image/png;base64,iVBORw0KGgpkYXRh\"},{\"uri\":\"none.png\"}]}";
    static const char obj[] = "mtllib m.mtl none.mtl\nmtllib /x.mtl\nv 0 0 0\n";
    put_png("a.png", "");
    put_text("m.mtl", "newmtl a\nmap_Kd a.png\nnewmtl b\nmap_Kd none.png\nnewmtl c\nmap_Kd /x.png\n");
    for (int turn = 0; turn < 2; turn++) {
        ffd_status status = FFD_E_MEMORY;
        for (long successes = 0; status != FFD_OK; successes++) {
            ffd_alloc_fail_after(successes);
            status = turn ? list_bytes(FFD_FORMAT_OBJ, in_folder("m.obj"), obj, sizeof obj - 1)
                          : list_bytes(FFD_FORMAT_GLTF, in_folder("m.gltf"), text, sizeof text - 1);
            ffd_alloc_fail_after(-1);
            assert_true(status == FFD_OK || status == FFD_E_MEMORY);
        }
        assert_int_equal(found.count, turn ? 3 : 4);
        check_image(0, "a.png", "");
        assert_int_equal(line_count, turn ? 2 : 1);
    }
}

static void formats_without_materials(void **state)
{
    (void)state;
    assert_null(ffd_format_table(FFD_FORMAT_PLY)->list_materials);
    assert_null(ffd_format_table(FFD_FORMAT_STL)->list_materials);
    assert_non_null(ffd_format_table(FFD_FORMAT_GLB)->list_materials);
}

static int end_tests(void **state)
{
    ffd_materials_free(&found);
    return remove_folder(state);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(colours_of_gltf),
        cmocka_unit_test(alpha_of_gltf),
        cmocka_unit_test(light_of_gltf),
        cmocka_unit_test(images_of_gltf_once_each),
        cmocka_unit_test(an_older_texture_stands_in),
        cmocka_unit_test(an_image_in_a_glb),
        cmocka_unit_test(images_in_buffers),
        cmocka_unit_test(only_extensions_have_the_image),
        cmocka_unit_test(images_that_cannot_be_had),
        cmocka_unit_test(one_line_says_all),
        cmocka_unit_test(standard_input_has_no_folder),
        cmocka_unit_test(hostile_json),
        cmocka_unit_test(long_names),
        cmocka_unit_test(colours_of_libraries),
        cmocka_unit_test(clearness_that_means_opaque),
        cmocka_unit_test(light_of_libraries),
        cmocka_unit_test(maps_of_libraries),
        cmocka_unit_test(names_that_begin_with_a_number),
        cmocka_unit_test(libraries_that_cannot_be_read),
        cmocka_unit_test(images_count_in_the_budget),
        cmocka_unit_test(memory_may_run_out_anywhere),
        cmocka_unit_test(formats_without_materials),
    };
    return cmocka_run_group_tests(tests, make_folder, end_tests);
}
