/* test_embedding_file.c - hashes, and the file of `ffd embed`: its content, and that no other file is
   accepted. */
#include "lattice/rest_hash.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/test_folder.h"
#include "base/little_endian.h"
#include "base/memory/memory.h"
#include "job/input/embedding_file.h"
#include "job/input/source.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

/* Constants of the format (embedding_file.h), written independently. */
#define HEADER 128
#define FOOTER 72

/* Hashes */

static void assert_hash(hash128 hash, const char *expected)
{
    char text[33];
    for (int i = 0; i < 16; i++)
        snprintf(text + 2 * i, 3, "%02x", hash.bytes[i]);
    assert_string_equal(text, expected);
}

/* XXH3, 128 bits, seed 0. The expected values are libxxhash's own. */
static void the_hash_is_xxh3(void **state)
{
    (void)state;
    assert_hash(ffd_hash(NULL, 0), "99aa06d3014798d86001c324468d497f");
    assert_hash(ffd_hash("abc", 3), "06b05ab6733a618578af5f94892f3950");
    unsigned char many[5000];
    for (size_t i = 0; i < sizeof many; i++)
        many[i] = (unsigned char)(i % 251);
    assert_hash(ffd_hash(many, sizeof many), "b92ec02c39d33ce7b418500fc42320ee");
}

static void the_hash_of_blocks_is_that_of_the_whole(void **state)
{
    (void)state;
    unsigned char bytes[3000];
    for (size_t i = 0; i < sizeof bytes; i++)
        bytes[i] = (unsigned char)(i * i >> 3);
    const hash128 whole = ffd_hash(bytes, sizeof bytes);
    for (size_t cut = 0; cut <= sizeof bytes; cut += 37) {
        const hash_block blocks[] = {{bytes, cut}, {NULL, 0}, {bytes + cut, sizeof bytes - cut}};
        const hash128 joined = ffd_hash_blocks(blocks, 3);
        assert_true(ffd_hash_equal(&joined, &whole));
    }
}

static void the_hash_of_doubles_is_that_of_their_bytes(void **state)
{
    (void)state;
    double values[1500];
    unsigned char bytes[8 * 1500];
    for (size_t i = 0; i < 1500; i++) {
        values[i] = sqrt((double)i) - 7;
        uint64_t bits;
        memcpy(&bits, &values[i], 8);
        for (size_t b = 0; b < 8; b++)
            bytes[8 * i + b] = (unsigned char)(bits >> (8 * b));
    }
    for (size_t count = 0; count <= 1500; count += 100) {
        const hash128 a = ffd_hash_doubles(values, count), b = ffd_hash(bytes, 8 * count);
        assert_true(ffd_hash_equal(&a, &b));
    }
    const double zeros[2] = {0.0, -0.0};
    const hash128 a = ffd_hash_doubles(zeros, 1), b = ffd_hash_doubles(zeros + 1, 1);
    assert_false(ffd_hash_equal(&a, &b));
}

/* Positions, in a document of the test's own */

#define PARTS 3
#define MOST 2600

typedef struct cloud {
    mesh_document head;
    mesh_part parts[PARTS];
    double xyz[PARTS][3 * MOST];
} cloud;

static void read_positions(const mesh_document *document, size_t part, mesh_stream stream, mesh_state state,
                           size_t first, size_t count, double *xyz)
{
    (void)stream;
    (void)state;
    memcpy(xyz, ((const cloud *)document)->xyz[part] + 3 * first, 3 * count * sizeof *xyz);
}

static const mesh_format cloud_format = {.name = "cloud", .read = read_positions};

/* Parts of 2600 (three tiles) and 1024 (one) vertices. */
static cloud *make_cloud(void)
{
    cloud *made = calloc(1, sizeof *made);
    assert_non_null(made);
    made->head = (mesh_document){.format = &cloud_format, .parts = made->parts, .part_count = 2};
    for (size_t p = 0; p < PARTS; p++)
        for (size_t i = 0; i < (size_t)3 * MOST; i++)
            made->xyz[p][i] = (double)(i % 97) / 8 + (double)p - 3;
    made->parts[0] = (mesh_part){.vertex_count = MOST, .identity = true};
    made->parts[1] =
        (mesh_part){.vertex_count = 1024, .linear = {2, 0, 0, 0, 1, 0, 0, 0, 1}, .offset = {0, 0, 5}};
    return made;
}

static hash128 hash_of(const cloud *mesh, int threads)
{
    hash128 hash;
    assert_int_equal(ffd_embedding_hash_positions(&mesh->head, threads, &hash, NULL), FFD_OK);
    return hash;
}

static void assert_positions(const cloud *mesh, const hash128 *expected, bool same)
{
    const hash128 hash = hash_of(mesh, 1);
    assert_int_equal(ffd_hash_equal(&hash, expected), same);
}

static void positions_are_hashed_the_same_by_any_threads(void **state)
{
    (void)state;
    cloud *mesh = make_cloud();
    const hash128 one = hash_of(mesh, 1);
    for (int threads = 2; threads < 9; threads += 3) {
        const hash128 more = hash_of(mesh, threads);
        assert_true(ffd_hash_equal(&more, &one));
    }
    free(mesh);
}

static void swap_vertices(cloud *mesh, size_t part, size_t a, size_t b)
{
    for (size_t c = 0; c < 3; c++) {
        const double kept = mesh->xyz[part][3 * a + c];
        mesh->xyz[part][3 * a + c] = mesh->xyz[part][3 * b + c];
        mesh->xyz[part][3 * b + c] = kept;
    }
}

static void other_positions_have_other_hashes(void **state)
{
    (void)state;
    cloud *mesh = make_cloud();
    const hash128 before = hash_of(mesh, 1);
    const size_t places[] = {0, 3 * 1023 + 2, 3 * 1024, 3 * 2047, 3 * MOST - 1};
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        double *x = &mesh->xyz[0][places[i]];
        const double kept = *x;
        *x = nextafter(kept, 1e9);
        assert_positions(mesh, &before, false);
        *x = kept;
    }
    assert_positions(mesh, &before, true);
    /* Another order, within a tile and across tiles. */
    swap_vertices(mesh, 0, 3, 4);
    assert_positions(mesh, &before, false);
    swap_vertices(mesh, 0, 3, 4);
    swap_vertices(mesh, 0, 3, 2000);
    assert_positions(mesh, &before, false);
    swap_vertices(mesh, 0, 3, 2000);
    mesh->parts[0].vertex_count--;
    assert_positions(mesh, &before, false);
    mesh->parts[0].vertex_count++;
    mesh->parts[1].offset[2] = 4; /* another position in the scene */
    assert_positions(mesh, &before, false);
    mesh->parts[1].offset[2] = 5;
    assert_positions(mesh, &before, true);
    free(mesh);
}

static void repeated_positions_do_not_count(void **state)
{
    (void)state;
    cloud *mesh = make_cloud();
    const hash128 before = hash_of(mesh, 1);
    mesh->parts[2] = mesh->parts[1];
    mesh->parts[1] = (mesh_part){.vertex_count = 1500, .identity = true, .repeats_positions = true};
    memcpy(mesh->xyz[2], mesh->xyz[1], sizeof mesh->xyz[2]);
    mesh->head.part_count = 3;
    assert_positions(mesh, &before, true);
    mesh->parts[1].repeats_positions = false;
    assert_positions(mesh, &before, false);
    free(mesh);
}

static void hashing_without_memory_is_reported(void **state)
{
    (void)state;
    cloud *mesh = make_cloud();
    hash128 hash;
    ffd_error error = {0};
    ffd_alloc_fail_after(0);
    const ffd_status status = ffd_embedding_hash_positions(&mesh->head, 1, &hash, &error);
    ffd_alloc_fail_after(-1);
    assert_int_equal(status, FFD_E_MEMORY);
    assert_int_equal(error.status, FFD_E_MEMORY);
    free(mesh);
}

/* Rest lattices */

#define BOX "\"rest\":{\"box\":{\"min\":[0,0,0],\"max\":[1,1,1]}}"
#define RING_KNOTS "\"knots\":[\"clamped\",\"closed\",\"clamped\"]"
#define CYLINDER                                                                                             \
    "\"rest\":{\"cylinder\":{\"center\":[0,0,0],\"axis\":[0,0,1],\"radius\":[1,2],\"height\":1,"             \
    "\"angle\":[0,360]}}"
#define EIGHT "[1,1,1,1,1,1,1,1]"

static hash128 hash_of_lattice(const char *members)
{
    char text[2000];
    ffd_lattice *lattice = NULL;
    ffd_error error = {0};
    const int size = snprintf(text, sizeof text, "{\"format\":\"ffd-lattice\",\"version\":1,%s}", members);
    if (ffd_lattice_parse(text, (size_t)size, "test", &lattice, &error) != FFD_OK)
        fail_msg("%s: %s", error.pointer, error.message);
    const hash128 hash = ffd_rest_hash(lattice);
    ffd_lattice_destroy(&lattice);
    return hash;
}

static void moves_do_not_change_the_rest_lattice(void **state)
{
    (void)state;
    static const char *const same[][2] = {
        {"\"size\":[4,4,4]," BOX, "\"size\":[4,4,4]," BOX ",\"moves\":[{\"at\":[0,0,0],\"by\":[0,0,1]}]"},
        {"\"size\":[4,4,4]," BOX, "\"size\":[4,4,4],\"degree\":[3,3,3]," BOX ",\"moves\":[{\"by\":[1,0,0]}]"},
        {"\"size\":[2,2,2]," BOX, "\"size\":[2,2,2]," BOX ",\"weights\":" EIGHT},
        {"\"size\":[2,2,2]," BOX, "\"size\":[2,2,2]," BOX ",\"deformed\":{\"weights\":[1,2,1,1,1,1,1,1]}"},
        {"\"size\":[2,2,2]," BOX ",\"weights\":[1,2,1,1,1,1,1,1]",
         "\"size\":[2,2,2]," BOX ",\"weights\":[1,2,1,1,1,1,1,1],\"deformed\":{\"weights\":" EIGHT "}"},
        {"\"size\":[4,6,4]," CYLINDER, "\"size\":[4,6,4]," RING_KNOTS "," CYLINDER
                                       ",\"moves\":[{\"twist\":{\"axis\":\"z\",\"degrees\":9}}]"},
    };
    for (size_t i = 0; i < sizeof same / sizeof *same; i++) {
        const hash128 a = hash_of_lattice(same[i][0]), b = hash_of_lattice(same[i][1]);
        if (!ffd_hash_equal(&a, &b))
            fail_msg("%s is not %s", same[i][0], same[i][1]);
    }
}

static void other_rest_lattices_have_other_hashes(void **state)
{
    (void)state;
    static const char *const all[] = {
        "\"size\":[4,4,4]," BOX,
        "\"size\":[4,4,5]," BOX,
        "\"size\":[5,4,4]," BOX,
        "\"size\":[4,4,4],\"degree\":[3,3,2]," BOX,
        "\"size\":[4,4,4],\"degree\":[2,3,3]," BOX,
        "\"size\":[4,4,4],\"knots\":[\"clamped\",\"clamped\",\"open\"]," BOX,
        "\"size\":[4,4,4],\"knots\":[\"clamped\",\"clamped\",\"uniform\"]," BOX,
        "\"size\":[4,4,4],\"knots\":[\"clamped\",\"clamped\",[0,0,0,0,2,2,2,2]]," BOX,
        "\"size\":[4,4,4],\"rest\":{\"box\":{\"min\":[0,0,0],\"max\":[1,1,1.0000000000000002]}}",
        "\"size\":[4,4,4],\"rest\":{\"box\":{\"min\":[0,0,0],\"max\":[1,1,1],\"spacing\":\"uniform\"}},"
        "\"degree\":[2,2,2]",
        "\"size\":[2,2,2]," BOX,
        "\"size\":[2,2,2]," BOX ",\"weights\":[1,2,1,1,1,1,1,1]",
        "\"size\":[2,2,2]," BOX ",\"weights\":[1,1,2,1,1,1,1,1]",
        "\"size\":[4,6,4]," CYLINDER,
        "\"size\":[4,6,4],\"degree\":[3,2,3]," CYLINDER,
    };
    const size_t count = sizeof all / sizeof *all;
    for (size_t i = 0; i < count; i++)
        for (size_t j = 0; j < i; j++) {
            const hash128 a = hash_of_lattice(all[i]), b = hash_of_lattice(all[j]);
            if (ffd_hash_equal(&a, &b))
                fail_msg("%s is taken for %s", all[i], all[j]);
        }
}

/* A closed direction is stored as the equivalent open one: kind and knots tell them apart. */
static void closed_lattices_hash_unlike_open_ones(void **state)
{
    (void)state;
    static const char points[] =
        "\"rest\":{\"points\":[[1,0,0],[0,1,0],[-1,0,0],[0,-1,0],[2,0,0],[0,2,0],[-2,0,0],[0,-2,0],"
        "[1,0,1],[0,1,1],[-1,0,1],[0,-1,1],[2,0,1],[0,2,1],[-2,0,1],[0,-2,1]]}";
    static const char *const knots[] = {"\"closed\"", "\"open\"", "{\"closed\":[0,1,2,3,5]}"};
    hash128 hash[3];
    for (int i = 0; i < 3; i++) {
        char text[1000];
        snprintf(text, sizeof text,
                 "\"size\":[4,2,2],\"degree\":[2,1,1],\"knots\":[%s,\"clamped\",\"clamped\"],%s", knots[i],
                 points);
        hash[i] = hash_of_lattice(text);
        for (int j = 0; j < i; j++)
            assert_false(ffd_hash_equal(&hash[i], &hash[j]));
    }
}

/* A ring whose ends meet at rest: an embedding depends on the rest lattice alone. */
static void a_seam_that_a_move_opens_keeps_the_hash(void **state)
{
    (void)state;
    static const double corner[5][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, 0}};
    static const char *const moves[] = {"", ",\"moves\":[{\"at\":[1,0,0],\"by\":[0,0,1]}]",
                                        ",\"moves\":[{\"at\":[\"all\",1,1],\"by\":[0,0,1]}]",
                                        ",\"moves\":[{\"at\":[0,0,0],\"by\":[0,0,1]}]"};
    char text[2000], points[1000] = "";
    hash128 hash[4];
    for (int i = 0; i < 20; i++) {
        const double *at = corner[i % 5], radius = i / 5 % 2 + 1;
        const size_t length = strlen(points);
        snprintf(points + length, sizeof points - length, "%s[%g,%g,%d]", i ? "," : "", radius * at[0],
                 radius * at[1], i / 10);
    }
    for (int i = 0; i < 4; i++) {
        snprintf(text, sizeof text, "\"size\":[5,2,2],\"degree\":[1,1,1],\"rest\":{\"points\":[%s]}%s",
                 points, moves[i]);
        hash[i] = hash_of_lattice(text);
    }
    for (int i = 1; i < 4; i++)
        assert_true(ffd_hash_equal(&hash[i], &hash[0]));
}

/* Files */

static const hash128 positions = {{1, 2, 3}}, rest = {{9, 8, 7}}, other = {{5}};

static const double three[9] = {0.25, -0.5, 1e-300, NAN, NAN, NAN, 1, 2, 3};
static const uint8_t three_statuses[3] = {FFD_VERTEX_INSIDE, FFD_VERTEX_OUTSIDE, FFD_VERTEX_MULTIPLE};

static ffd_status try_write(const char *name, const double *uvw, const uint8_t *statuses, size_t count)
{
    file_output *output;
    assert_int_equal(ffd_output_create(&output, NULL), FFD_OK);
    ffd_status status = ffd_output_begin(output, in_folder(name), true, NULL);
    if (!status)
        status = ffd_embedding_write(output, uvw, statuses, count, &positions, &rest, NULL);
    if (!status)
        status = ffd_output_commit(output, NULL);
    ffd_output_destroy(&output);
    return status;
}

/* Returns the bytes of a written file, freed by the caller. */
static unsigned char *written(const double *uvw, const uint8_t *statuses, size_t count, size_t *size)
{
    file_input input;
    assert_int_equal(try_write("w.npy", uvw, statuses, count), FFD_OK);
    assert_int_equal(ffd_file_load(in_folder("w.npy"), &input, NULL), FFD_OK);
    unsigned char *bytes = malloc(input.size + 1); /* with capacity for one more byte */
    assert_non_null(bytes);
    memcpy(bytes, input.data, input.size);
    *size = input.size;
    ffd_file_unload(&input);
    return bytes;
}

static ffd_status try_open(const unsigned char *bytes, size_t size, size_t count, embedding_file *file,
                           ffd_error *error)
{
    put("r.npy", bytes, size);
    *error = (ffd_error){0};
    return ffd_embedding_open(&(ffd_embedding_source){.path = in_folder("r.npy")}, count, &positions, &rest,
                              file, error);
}

/* Checks that bytes are refused as invalid, with the file's name and these words, and that nothing stays
   open. */
static void assert_refused(const unsigned char *bytes, size_t size, size_t count, const char *words)
{
    embedding_file file;
    ffd_error error;
    assert_int_equal(try_open(bytes, size, count, &file, &error), FFD_E_INVALID);
    assert_int_equal(error.status, FFD_E_INVALID);
    assert_string_equal(error.file, in_folder("r.npy"));
    if (!strstr(error.message, words))
        fail_msg("\"%s\" has no \"%s\"", error.message, words);
    assert_null(file.uvw);
    assert_null(file.turned);
    assert_int_equal(file.input.size, 0);
}

/* Updates the hash of the content after a deliberate change. */
static void seal(unsigned char *bytes, size_t size)
{
    const hash128 content = ffd_hash(bytes, size - FOOTER);
    memcpy(bytes + size - FOOTER + 32, &content, sizeof content);
}

static void a_file_is_header_arrays_and_footer(void **state)
{
    (void)state;
    size_t size;
    unsigned char *bytes = written(three, three_statuses, 3, &size);
    assert_int_equal(size, HEADER + 3 * 25 + FOOTER);
    assert_memory_equal(bytes, "\x93NUMPY\x01\x00\x76\x00{'descr': '", 21);
    assert_memory_equal(bytes + HEADER, three, sizeof three);
    assert_memory_equal(bytes + HEADER + sizeof three, three_statuses, 3);
    const unsigned char *footer = bytes + size - FOOTER;
    const hash128 content = ffd_hash(bytes, size - FOOTER);
    assert_memory_equal(footer, &positions, 16);
    assert_memory_equal(footer + 16, &rest, 16);
    assert_memory_equal(footer + 32, &content, 16);
    assert_memory_equal(footer + 48, "\3\0\0\0\0\0\0\0\1\0\0\0\0\0\0\0ffd-embd", 24);
    free(bytes);
}

static void what_is_written_is_read_back(void **state)
{
    (void)state;
    static const size_t counts[] = {0, 1, 2, 1000, 70000};
    for (size_t n = 0; n < sizeof counts / sizeof *counts; n++) {
        const size_t count = counts[n];
        double *uvw = malloc((3 * count + 1) * sizeof *uvw);
        uint8_t *statuses = malloc(count + 1);
        assert_true(uvw && statuses);
        for (size_t i = 0; i < count; i++) {
            statuses[i] = (uint8_t)(i % 5);
            for (size_t c = 0; c < 3; c++)
                uvw[3 * i + c] = statuses[i] == 1 || statuses[i] == 4 ? NAN : sqrt((double)i) + (double)c;
        }
        assert_int_equal(try_write("e.npy", uvw, statuses, count), FFD_OK);
        embedding_file file;
        assert_int_equal(ffd_embedding_open(&(ffd_embedding_source){.path = in_folder("e.npy")}, count,
                                            &positions, &rest, &file, NULL),
                         FFD_OK);
        assert_int_equal(file.count, count);
        assert_memory_equal(file.uvw, uvw, 3 * count * sizeof *uvw);
        assert_memory_equal(file.statuses, statuses, count);
        assert_int_equal((uintptr_t)file.uvw % sizeof(double), 0);
        ffd_embedding_close(&file);
        assert_null(file.uvw);
        ffd_embedding_close(&file); /* closing twice is allowed */
        free(uvw);
        free(statuses);
    }
}

static void every_changed_bit_is_refused(void **state)
{
    (void)state;
    size_t size;
    unsigned char *bytes = written(three, three_statuses, 3, &size);
    for (size_t i = 0; i < 8 * size; i++) {
        bytes[i / 8] ^= (unsigned char)(1 << i % 8);
        assert_refused(bytes, size, 3, i / 8 < size - FOOTER ? "is damaged" : "");
        bytes[i / 8] ^= (unsigned char)(1 << i % 8);
    }
    embedding_file file;
    ffd_error error;
    assert_int_equal(try_open(bytes, size, 3, &file, &error), FFD_OK);
    ffd_embedding_close(&file);
    free(bytes);
}

static void every_other_length_is_refused(void **state)
{
    (void)state;
    size_t size;
    unsigned char *bytes = written(three, three_statuses, 3, &size);
    for (size_t length = 0; length < size; length++) {
        assert_refused(bytes, length, 3, "is not an embedding written by ffd embed");
        /* Truncated at the start, or with a gap: the footer is intact. */
        assert_refused(bytes + size - length, length, 3,
                       length < FOOTER ? "is not an embedding" : "is damaged");
    }
    bytes[size] = 0;
    assert_refused(bytes, size + 1, 3, "is not an embedding written by ffd embed");
    free(bytes);
}

static void stale_files_are_refused(void **state)
{
    (void)state;
    embedding_file file;
    ffd_error error;
    assert_int_equal(try_write("e.npy", three, three_statuses, 3), FFD_OK);
    const char *path = in_folder("e.npy");
    assert_int_equal(
        ffd_embedding_open(&(ffd_embedding_source){.path = path}, 4, &positions, &rest, &file, &error),
        FFD_E_INVALID);
    assert_string_equal(error.message, "was made for another mesh: it is of 3 vertices, not 4");
    assert_int_equal(
        ffd_embedding_open(&(ffd_embedding_source){.path = path}, 3, &other, &rest, &file, &error),
        FFD_E_INVALID);
    assert_string_equal(error.message,
                        "was made for another mesh: its positions, or their number type, differ");
    assert_int_equal(
        ffd_embedding_open(&(ffd_embedding_source){.path = path}, 3, &positions, &other, &file, &error),
        FFD_E_INVALID);
    assert_string_equal(error.message, "was made for another rest lattice, or with another snap");
    assert_string_equal(error.file, path);
}

static void other_versions_are_refused(void **state)
{
    (void)state;
    size_t size;
    unsigned char *bytes = written(three, three_statuses, 3, &size), *version = bytes + size - 16;
    *version = 2;
    assert_refused(bytes, size, 3, "is an embedding of format version 2, this program reads version 1");
    *version = 0;
    assert_refused(bytes, size, 3, "format version 0");
    *version = 1;
    version[3] = 0xff;
    assert_refused(bytes, size, 3, "format version 4278190081");
    version[3] = 0;
    version[4] = 1; /* reserved */
    assert_refused(bytes, size, 3, "is damaged");
    free(bytes);
}

/* Forged files: valid hashes, but a wrong content. */

static void headers_of_other_arrays_are_refused(void **state)
{
    (void)state;
    static const char *const texts[] = {
        "{'descr': '<f4', 'fortran_order': False, 'shape': (3, 3), }",
        "{'descr': '|f8', 'fortran_order': False, 'shape': (3, 3), }",
        "{'descr': '<f8', 'fortran_order': True, 'shape': (3, 3), } ",
        "{'descr': '<f8', 'fortran_order': False, 'shape': (9, 1), }",
        "{'descr': '<f8', 'fortran_order': False, 'shape': (3, 4), }",
        "{'descr': '<f8', 'fortran_order': False, 'shape': (4, 3), }",
        "{'descr': '<f8', 'fortran_order': False, 'shape': (3, 3)}  ",
        "{'shape': (3, 3), 'fortran_order': False, 'descr': '<f8', }",
    };
    size_t size;
    unsigned char *bytes = written(three, three_statuses, 3, &size);
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        memcpy(bytes + 10, texts[i], strlen(texts[i]));
        seal(bytes, size);
        assert_refused(bytes, size, 3, "does not hold float64 of the shape (3, 3) and as many statuses");
    }
    free(bytes);
}

/* A count that agrees with the header, but not with the file's size. */
static void counts_beyond_the_file_are_refused(void **state)
{
    (void)state;
    static const uint64_t counts[] = {2, 4, 1u << 20, (uint64_t)1 << 60, ((uint64_t)1 << 63) + 3, UINT64_MAX};
    size_t size;
    unsigned char *bytes = written(three, three_statuses, 3, &size);
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
        if (counts[i] > SIZE_MAX)
            continue;
        char text[HEADER];
        memset(text, ' ', sizeof text);
        const int length =
            snprintf(text, sizeof text, "{'descr': '<f8', 'fortran_order': False, 'shape': (%zu, 3), }",
                     (size_t)counts[i]);
        text[length] = ' ';
        memcpy(bytes + 10, text, HEADER - 11);
        store_u64(bytes + size - 24, counts[i]);
        seal(bytes, size);
        assert_refused(bytes, size, (size_t)counts[i], "does not hold float64 of the shape");
        assert_refused(bytes, size, 3, "was made for another mesh");
    }
    free(bytes);
}

static void statuses_that_do_not_fit_are_refused(void **state)
{
    (void)state;
    static const uint8_t unknown[3] = {0, 1, 5}, inside[3] = {0, 0, 2}, multiple[3] = {0, 2, 0};
    static const uint8_t singular[3] = {0, FFD_VERTEX_SINGULAR, FFD_VERTEX_INVALID};
    size_t size;
    unsigned char *bytes = written(three, unknown, 3, &size);
    assert_refused(bytes, size, 3, "the status of vertex 2 is 5, not 0 to 4");
    free(bytes);
    bytes = written(three, inside, 3, &size);
    assert_refused(bytes, size, 3, "u,v,w of vertex 1 is not finite, although its status is 0");
    free(bytes);
    bytes = written(three, multiple, 3, &size);
    assert_refused(bytes, size, 3, "u,v,w of vertex 1 is not finite, although its status is 2");
    free(bytes);
    /* An unresolved set of solutions has no u,v,w. */
    bytes = written(three, singular, 3, &size);
    embedding_file file;
    ffd_error error;
    assert_int_equal(try_open(bytes, size, 3, &file, &error), FFD_OK);
    ffd_embedding_close(&file);
    free(bytes);
}

static void the_other_byte_order_is_read(void **state)
{
    (void)state;
    size_t size;
    unsigned char *bytes = written(three, three_statuses, 3, &size);
    bytes[21] = bytes[21] == '<' ? '>' : '<';
    for (size_t i = 0; i < 9; i++)
        for (size_t b = 0; b < 4; b++) {
            unsigned char *x = bytes + HEADER + 8 * i, kept = x[b];
            x[b] = x[7 - b];
            x[7 - b] = kept;
        }
    seal(bytes, size);
    embedding_file file;
    ffd_error error;
    assert_int_equal(try_open(bytes, size, 3, &file, &error), FFD_OK);
    assert_memory_equal(file.uvw, three, sizeof three);
    assert_memory_equal(file.statuses, three_statuses, 3);
    ffd_embedding_close(&file);

    ffd_alloc_fail_after(0);
    const ffd_status status = try_open(bytes, size, 3, &file, &error);
    ffd_alloc_fail_after(-1);
    assert_int_equal(status, FFD_E_MEMORY);
    assert_null(file.uvw);
    free(bytes);
}

static void files_that_are_no_embedding_are_refused(void **state)
{
    (void)state;
    embedding_file file;
    ffd_error error;
    assert_refused((const unsigned char *)"", 0, 0, "is not an embedding written by ffd embed");
    assert_refused((const unsigned char *)"ffd-embd", 8, 0, "is not an embedding written by ffd embed");
    unsigned char zeros[FOOTER] = {0};
    memcpy(zeros + FOOTER - 8, "ffd-embd", 8);
    assert_refused(zeros, sizeof zeros, 0, "format version 0");
    zeros[FOOTER - 16] = 1;
    assert_refused(zeros, sizeof zeros, 0, "is damaged");
    seal(zeros, sizeof zeros);
    assert_refused(zeros, sizeof zeros, 0,
                   "was made for another mesh: its positions, or their number type, differ");
    memcpy(zeros, &positions, 16);
    memcpy(zeros + 16, &rest, 16);
    assert_refused(zeros, sizeof zeros, 0, "does not hold float64 of the shape (0, 3)");
    assert_int_equal(ffd_embedding_open(&(ffd_embedding_source){.path = in_folder("none.npy")}, 3, &positions,
                                        &rest, &file, &error),
                     FFD_E_IO);
    assert_int_equal(
        ffd_embedding_open(&(ffd_embedding_source){.path = folder}, 3, &positions, &rest, &file, &error),
        FFD_E_IO);
    assert_null(file.uvw);
}

/* The job */

static void embed_writes_what_belongs_to_mesh_and_lattice(void **state)
{
    (void)state;
    static const char lattice_text[] = "{\"format\":\"ffd-lattice\",\"version\":1,\"size\":[4,4,4],"
                                       "\"rest\":{\"box\":\"mesh\",\"margin\":0}}";
    static char mesh_text[60000];
    size_t size = 0;
    for (int i = 0; i < 1500; i++)
        size +=
            (size_t)snprintf(mesh_text + size, sizeof mesh_text - size, "v %d.5 %d %d\n", i % 13, i % 7, i);
    put("m.obj", mesh_text, size);
    put("l.json", lattice_text, sizeof lattice_text - 1);

    ffd_embed_desc desc;
    ffd_embed_desc_init(&desc, sizeof desc);
    char mesh_path[200], lattice_path[200], output_path[200];
    snprintf(mesh_path, sizeof mesh_path, "%s", in_folder("m.obj"));
    snprintf(lattice_path, sizeof lattice_path, "%s", in_folder("l.json"));
    snprintf(output_path, sizeof output_path, "%s", in_folder("m.npy"));
    desc.input.path = mesh_path;
    desc.lattice.path = lattice_path;
    desc.output = output_path;
    desc.threads = 3;
    assert_int_equal(ffd_embed_run(&desc, NULL, NULL), FFD_OK);

    const double min[3] = {0.5, 0, 0}, max[3] = {12.5, 6, 1499};
    ffd_lattice *lattice = NULL;
    mesh_document *document = NULL;
    hash128 mesh_hash;
    embedding_file file;
    assert_int_equal(ffd_lattice_load(lattice_path, &lattice, NULL), FFD_OK);
    assert_int_equal(ffd_lattice_fit(lattice, min, max, NULL), FFD_OK);
    const hash128 lattice_hash = ffd_rest_hash(lattice);
    assert_int_equal(ffd_source_open(&desc.input, 0, &document, NULL), FFD_OK);
    assert_int_equal(ffd_embedding_hash_positions(document, 1, &mesh_hash, NULL), FFD_OK);
    assert_int_equal(ffd_embedding_open(&(ffd_embedding_source){.path = output_path}, 1500, &mesh_hash,
                                        &lattice_hash, &file, NULL),
                     FFD_OK);
    for (size_t i = 0; i < 1500; i++) {
        assert_int_equal(file.statuses[i], FFD_VERTEX_INSIDE);
        assert_true(fabs(file.uvw[3 * i] - (double)(i % 13) / 12) <= 1e-14);
        assert_true(fabs(file.uvw[3 * i + 2] - (double)i / 1499) <= 1e-14);
    }
    ffd_embedding_close(&file);
    ffd_source_close(&document);
    ffd_lattice_destroy(&lattice);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_hash_is_xxh3),
        cmocka_unit_test(the_hash_of_blocks_is_that_of_the_whole),
        cmocka_unit_test(the_hash_of_doubles_is_that_of_their_bytes),
        cmocka_unit_test(positions_are_hashed_the_same_by_any_threads),
        cmocka_unit_test(other_positions_have_other_hashes),
        cmocka_unit_test(repeated_positions_do_not_count),
        cmocka_unit_test(hashing_without_memory_is_reported),
        cmocka_unit_test(moves_do_not_change_the_rest_lattice),
        cmocka_unit_test(other_rest_lattices_have_other_hashes),
        cmocka_unit_test(closed_lattices_hash_unlike_open_ones),
        cmocka_unit_test(a_seam_that_a_move_opens_keeps_the_hash),
        cmocka_unit_test(a_file_is_header_arrays_and_footer),
        cmocka_unit_test(what_is_written_is_read_back),
        cmocka_unit_test(every_changed_bit_is_refused),
        cmocka_unit_test(every_other_length_is_refused),
        cmocka_unit_test(stale_files_are_refused),
        cmocka_unit_test(other_versions_are_refused),
        cmocka_unit_test(headers_of_other_arrays_are_refused),
        cmocka_unit_test(counts_beyond_the_file_are_refused),
        cmocka_unit_test(statuses_that_do_not_fit_are_refused),
        cmocka_unit_test(the_other_byte_order_is_read),
        cmocka_unit_test(files_that_are_no_embedding_are_refused),
        cmocka_unit_test(embed_writes_what_belongs_to_mesh_and_lattice),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
