/* Faces whose vertices have different marks: for each format, exactly the mixed ones among all faces, for all
   combinations of marks. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "../support/draw.h"
#include "../support/mesh_file.h"
#include "base/text/base64.h"
#include "mesh/mixed_faces.h"

#define MOST_VERTICES 12
#define MANY 300

static bool is_marked(const vertex_marks *marks, size_t vertex)
{
    for (size_t p = 0; p < marks->planes; p++)
        if (marks->bytes[p * marks->vertices + vertex])
            return true;
    return false;
}

/* Vertex numbers ascend, and each one is used by a face. */
static void assert_narrow(const mesh_faces *faces)
{
    bool used[MANY] = {false};
    for (size_t v = 0; faces->vertices && v + 1 < faces->vertex_count; v++)
        assert_true(faces->vertices[v] < faces->vertices[v + 1]);
    for (size_t c = 0; c < faces->start[faces->face_count]; c++)
        used[faces->corners[c]] = true;
    for (size_t v = 0; faces->vertices && v < faces->vertex_count; v++)
        assert_true(used[v]);
}

/* Two faces have the same corners; unmarked ones may be other vertices at the same position. */
static void assert_same_face(const mesh_faces *all, size_t face, const mesh_faces *mixed, size_t found,
                             const vertex_marks *marks)
{
    const uint32_t *const a = all->corners + all->start[face], *const b =
                                                                   mixed->corners + mixed->start[found];
    const size_t count = all->start[face + 1] - all->start[face];
    assert_int_equal(mixed->start[found + 1] - mixed->start[found], count);
    for (size_t c = 0; c < count; c++) {
        if (is_marked(marks, a[c]))
            assert_int_equal(ffd_faces_document_vertex(mixed, b[c]), a[c]);
        for (size_t i = 0; i < 3; i++)
            assert_true(mixed->positions[3 * b[c] + i] == all->positions[3 * a[c] + i]); /* also 0 and -0 */
    }
}

/* Each failing allocation is reported without a leak; the last try succeeds. */
static void assert_failures(const mesh_document *document, const vertex_marks *marks)
{
    ffd_status status = FFD_E_MEMORY;
    for (long successes = 0; status; successes++) {
        mesh_faces faces;
        ffd_alloc_fail_after(successes);
        status = document->format->mixed_faces(document, MESH_STORED, marks, &faces, NULL);
        ffd_alloc_fail_after(-1);
        if (status)
            assert_int_equal(status, FFD_E_MEMORY);
        else
            ffd_mesh_faces_free(&faces);
    }
}

/* Returns the number of mixed faces. */
static size_t assert_mixed(const mesh_document *document, const mesh_faces *all, const vertex_marks *marks)
{
    mesh_faces mixed;
    size_t found = 0;
    assert_int_equal(document->format->mixed_faces(document, MESH_STORED, marks, &mixed, NULL), FFD_OK);
    if (!mixed.vertices)
        assert_int_equal(mixed.vertex_count, marks->vertices);
    assert_narrow(&mixed);
    for (size_t f = 0; f < all->face_count; f++) {
        const size_t count = all->start[f + 1] - all->start[f];
        if (!ffd_marks_differ(marks, all->corners + all->start[f], count))
            continue;
        assert_in_range(found, 0, mixed.face_count - 1);
        assert_same_face(all, f, &mixed, found++, marks);
    }
    assert_int_equal(mixed.face_count, found);
    ffd_mesh_faces_free(&mixed);
    return found;
}

/* Marks every subset of the vertices in one plane, and different subsets in two planes. Vertices at one
   position have equal marks: places[v] is the first vertex at the position of v. */
static void assert_all_marks(mesh_document *document, const size_t *places)
{
    uint8_t bytes[2 * MOST_VERTICES];
    size_t found = 0;
    mesh_faces all;
    assert_int_equal(ffd_mesh_check(document, NULL), FFD_OK);
    assert_int_equal(document->format->faces(document, MESH_STORED, &all, NULL), FFD_OK);
    const size_t vertices = all.vertex_count;
    assert_in_range(vertices, 1, MOST_VERTICES);
    for (uint32_t set = 0; set < 1u << vertices; set++)
        for (size_t planes = 1; planes <= 2; planes++) {
            for (size_t v = 0; v < planes * vertices; v++) {
                const size_t place = places ? places[v % vertices] : v % vertices;
                bytes[v] = (uint8_t)(set >> (v < vertices ? place : vertices - 1 - place) & 1);
            }
            const vertex_marks marks = {bytes, planes, vertices};
            found += assert_mixed(document, &all, &marks);
            if (set % 7 == 1)
                assert_failures(document, &marks);
        }
    assert_true(found > 0);
    ffd_mesh_faces_free(&all);
    document->format->close(document);
}

static void assert_of_text(ffd_format format, const char *text, const size_t *places)
{
    assert_all_marks(opened_bytes(ffd_format_table(format), text, strlen(text)), places);
}

#define OFF_VERTICES "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0.5 2 0\n"

static void of_off(void **state)
{
    (void)state;
    assert_of_text(FFD_FORMAT_OFF,
                   "OFF\n5 6 0\n" OFF_VERTICES "3 0 1 2 # a\n4 0 1 3 2 255 0 0\n\n2 1 4\n1 3\n5 4 3 1 0 "
                   "2\n3 0000000000000000002 3 4\n",
                   NULL);
    assert_of_text(FFD_FORMAT_OFF, "OFF 5 2 0 0 0 0 1 0 0\n0 1 0 1 1 0 0.5 2 0\n3 0 1 2\n3 3 4\n2", NULL);
    assert_of_text(FFD_FORMAT_OFF, "COFF\r\n3 1 0\r\n0 0 0 1 1 1 1\r\n1 0 0 9\r\n0 1 0 9 9 9\r\n3 0 1 2\r\n",
                   NULL);
}

#define PLY_HEAD(encoding, vertices, faces, type)                                                            \
    "ply\nformat " encoding " 1.0\nelement edge 1\nproperty int vertex1\nproperty int vertex2\n"             \
    "element vertex " vertices "\nproperty float x\nproperty float y\nproperty float z\nelement face " faces \
    "\nproperty uchar red\nproperty list uchar " type " vertex_indices\nproperty uchar blue\nend_header\n"

static void of_ply(void **state)
{
    (void)state;
    assert_of_text(FFD_FORMAT_PLY,
                   PLY_HEAD("ascii", "5", "5", "int") "0 4\n" OFF_VERTICES
                                                      "7 3 0 1 2 7\n7 4 0 1 3 2 7\n\n7 0 7\n7 5 +4 3 1 0 2.0 "
                                                      "7\n7 2 1 4 7\n",
                   NULL);
    assert_of_text(FFD_FORMAT_PLY,
                   PLY_HEAD("ascii", "5", "1", "float") "0 4\n" OFF_VERTICES "7 3 1e0 4 2 7\n", NULL);
}

/* Stores an integer of this size, in either byte order. */
static size_t put(unsigned char *bytes, uint64_t value, size_t size, bool big)
{
    for (size_t i = 0; i < size; i++)
        bytes[big ? size - 1 - i : i] = (unsigned char)(value >> (8 * i));
    return size;
}

/* Checks that the faces are these; a vertex that they do not use is not listed. */
static void assert_known(mesh_document *document, const uint32_t *corners, size_t words)
{
    mesh_faces faces;
    bool named[MOST_VERTICES] = {false};
    size_t at = 0, face = 0;
    assert_int_equal(document->format->faces(document, MESH_STORED, &faces, NULL), FFD_OK);
    for (; at < words; face++) {
        const size_t count = corners[at++];
        assert_int_equal(faces.start[face + 1] - faces.start[face], count);
        assert_memory_equal(faces.corners + faces.start[face], corners + at, count * sizeof *corners);
        for (size_t c = 0; c < count; c++)
            named[corners[at++]] = true;
    }
    assert_int_equal(faces.face_count, face);
    ffd_mesh_faces_free(&faces);
    named[0] = named[1] = true; /* by an edge */
    assert_int_equal(ffd_mesh_mark_used(document, NULL), FFD_OK);
    for (size_t v = 0; v < document->parts[0].vertex_count; v++)
        assert_int_equal(!document->parts[0].used || document->parts[0].used[v], named[v]);
}

static void of_binary_ply(void **state)
{
    (void)state;
    static const uint32_t corners[] = {3, 0, 1, 2, 0, 4, 4, 0, 1, 2};
    static const struct {
        const char *head;
        size_t size;
        bool big;
    } cases[] = {{PLY_HEAD("binary_little_endian", "5", "3", "int"), 4, false},
                 {PLY_HEAD("binary_big_endian", "5", "3", "ushort"), 2, true},
                 {PLY_HEAD("binary_big_endian", "5", "3", "uint"), 4, true},
                 {PLY_HEAD("binary_little_endian", "5", "3", "uint"), 4, false},
                 {PLY_HEAD("binary_little_endian", "5", "3", "char"), 1, false}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        unsigned char bytes[1024];
        size_t size = strlen(cases[i].head);
        memcpy(bytes, cases[i].head, size);
        for (size_t v = 0; v < 2; v++)
            size += put(bytes + size, v, 4, cases[i].big);
        for (uint32_t v = 0; v < 15; v++)
            size += put(bytes + size, v << 23, 4, cases[i].big);
        for (size_t face = 0, at = 0; face < 3; face++) {
            size += put(bytes + size, 7, 1, false);
            const size_t count = corners[at];
            size += put(bytes + size, corners[at++], 1, false);
            for (size_t c = 0; c < count; c++)
                size += put(bytes + size, corners[at++], cases[i].size, cases[i].big);
            size += put(bytes + size, 7, 1, false);
        }
        mesh_document *const document = opened_bytes(ffd_format_table(FFD_FORMAT_PLY), bytes, size);
        assert_known(document, corners, sizeof corners / sizeof *corners);
        assert_all_marks(document, NULL);
    }
}

static void of_obj(void **state)
{
    (void)state;
    assert_of_text(FFD_FORMAT_OBJ,
                   "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1\nv 1 1 0\nf 1 2 \\\n4 -2\nl 1 2\np "
                   "3\nv 5 0 0\nf 5 4 3 2 1 # a\nf 1 2 3 4 5 1 2 3 4 5\n",
                   NULL);
}

#define FACET(a, b, c)                                                                                       \
    "facet normal 0 0 1\nouter loop\nvertex " a "\nvertex " b "\nvertex " c "\nendloop\nendfacet\n"

/* The last corners share positions with the first facet, once with -0 for 0. */
static void of_stl(void **state)
{
    (void)state;
    static const size_t places[] = {0, 1, 2, 2, 1, 5, 5, 1, 8, 0, 2, 5};
    assert_of_text(FFD_FORMAT_STL,
                   "solid a\n" FACET("0 0 0", "1 0 0", "0 1 0") FACET("-0 1 0", "1 0 0", "1 1 0")
                       FACET("1 1 0", "1 0 0", "2 0 0") FACET("0 0 0", "0 1 0", "1 1 0") "endsolid a\n",
                   places);
}

/* Three squares: with 32-bit indices under two nodes, one of them moved; with 8-bit indices; and as two
   triangles without indices. */
static void of_gltf(void **state)
{
    (void)state;
    unsigned char bytes[128] = {0};
    char base64[256] = {0}, text[2048];
    for (size_t i = 0; i < 12; i++)
        put(bytes + 4 * i, i * i << 23, 4, false);
    static const uint32_t corners[] = {0, 1, 2, 2, 1, 3};
    for (size_t i = 0; i < 6; i++) {
        put(bytes + 48 + 4 * i, corners[i], 4, false);
        put(bytes + 72 + i, corners[i], 1, false);
    }
    ffd_base64_encode(bytes, 78, base64);
    snprintf(
        text, sizeof text,
        "{\"asset\":{\"version\":\"2.0\"},\"buffers\":[{\"byteLength\":78,\"uri\":"
        "\"data:application/octet-stream;base64,%s\"}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":48},"
        "{\"buffer\":0,\"byteOffset\":48,\"byteLength\":24},{\"buffer\":0,\"byteOffset\":72,"
        "\"byteLength\":6}],\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":"
        "\"VEC3\"},{\"bufferView\":1,\"componentType\":5125,\"count\":6,\"type\":\"SCALAR\"},"
        "{\"bufferView\":2,\"componentType\":5121,\"count\":6,\"type\":\"SCALAR\"},{\"bufferView\":0,"
        "\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}],\"meshes\":[{\"primitives\":[{\"indices\":1,"
        "\"attributes\":{\"POSITION\":0}}]},{\"primitives\":[{\"indices\":2,\"attributes\":"
        "{\"POSITION\":0}}]},{\"primitives\":[{\"attributes\":{\"POSITION\":3}}]}],\"nodes\":["
        "{\"mesh\":0},{\"mesh\":0,\"translation\":[1,2,3]},{\"mesh\":2}],\"scenes\":[{\"nodes\":[0,1,2]}],"
        "\"scene\":0}",
        base64);
    mesh_document *document;
    ffd_error error;
    if (open_bytes(ffd_format_table(FFD_FORMAT_GLTF), text, strlen(text), &document, &error))
        fail_msg("%s", error.message);
    assert_all_marks(document, NULL);
    snprintf(strstr(text, "\"nodes\":["), 100,
             "\"nodes\":[{\"mesh\":1,\"scale\":[2,2,2]},{\"mesh\":2}],"
             "\"scenes\":[{\"nodes\":[0,1]}],\"scene\":0}");
    if (open_bytes(ffd_format_table(FFD_FORMAT_GLTF), text, strlen(text), &document, &error))
        fail_msg("%s", error.message);
    assert_all_marks(document, NULL);
}

/* Many vertices, with long lines: the vertices of mixed faces are renumbered. */
static void of_many(void **state)
{
    (void)state;
    draw d = {draw_seed()};
    for (int round = 0; round < 20; round++) {
        char text[40 * 2 * MANY];
        uint8_t bytes[MANY];
        size_t size = 0;
        mesh_faces all;
        const uint32_t border = (uint32_t)draw_int(&d, 10, MANY - 10);
        for (size_t v = 0; v < MANY; v++) {
            size += (size_t)snprintf(text + size, sizeof text - size, "v %zu 0 %d\n", v, draw_int(&d, 0, 9));
            bytes[v] = v > border;
        }
        for (int f = 0; f < MANY; f++) {
            const int a = draw_int(&d, 1, MANY - 8), b = a + draw_int(&d, 1, 3), c = b + draw_int(&d, 1, 3);
            size += (size_t)snprintf(text + size, sizeof text - size, "f %d/%d/%d %d/%d/%d %d/%d/%d\n", a, a,
                                     a, b, b, b, c, c, c);
        }
        const vertex_marks marks = {bytes, 1, MANY};
        mesh_document *const document = opened_bytes(ffd_format_table(FFD_FORMAT_OBJ), text, size);
        assert_int_equal(document->format->faces(document, MESH_STORED, &all, NULL), FFD_OK);
        assert_mixed(document, &all, &marks);
        ffd_mesh_faces_free(&all);
        document->format->close(document);
    }
}

/* Faces of the file are overwritten by vertices after it was opened; the arrays have the old size. */
static void of_a_file_that_changes(void **state)
{
    (void)state;
    char text[40 * MANY] = "";
    mesh_faces faces;
    size_t size = 0;
    for (int v = 0; v < 3; v++)
        size += (size_t)snprintf(text + size, sizeof text - size, "v %d 0 %d\n", v, v % 2);
    for (int f = 0; f < MANY; f++)
        size += (size_t)snprintf(text + size, sizeof text - size, "f 1 2 3\n");
    mesh_document *const document = opened_bytes(ffd_format_table(FFD_FORMAT_OBJ), text, size);
    const mesh_results results = {.replace = true}; /* so that positions are read again */
    assert_int_equal(document->format->begin_results(document, &results, NULL), FFD_OK);
    for (char *c = text; *c; c++)
        *c = *c == 'f' ? 'v' : *c;
    assert_int_equal(document->format->faces(document, MESH_STORED, &faces, NULL), FFD_E_IO);
    document->format->close(document);
}

/* Finds marks among many unmarked vertices, in one plane and in two. */
static void next_marks(void **state)
{
    (void)state;
    draw d = {draw_seed()};
    for (int round = 0; round < 300; round++) {
        const size_t planes = (size_t)draw_int(&d, 1, 2), vertices = (size_t)draw_int(&d, 0, 60);
        uint8_t bytes[2 * 60] = {0};
        for (int i = draw_int(&d, 0, 5); i > 0 && vertices > 0; i--)
            bytes[draw_int(&d, 0, (int)(planes * vertices) - 1)] = (uint8_t)draw_int(&d, 1, 255);
        const vertex_marks marks = {bytes, planes, vertices};
        for (size_t v = 0, next = 0; v <= vertices; v++) {
            for (next = v; next < vertices && !is_marked(&marks, next);)
                next++;
            assert_int_equal(ffd_marks_next(&marks, v), next);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(of_off),        cmocka_unit_test(of_ply),
        cmocka_unit_test(of_binary_ply), cmocka_unit_test(of_obj),
        cmocka_unit_test(of_stl),        cmocka_unit_test(of_gltf),
        cmocka_unit_test(of_many),       cmocka_unit_test(of_a_file_that_changes),
        cmocka_unit_test(next_marks),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
