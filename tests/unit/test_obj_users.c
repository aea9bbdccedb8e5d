/* OBJ: which elements are used by faces, lines and points in a file of many blocks, some of which are read
   before the elements. Counts and pairs equal those of a plain list of all corners, with any number of
   threads and in any order of statements, and the first fault is reported. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "../support/draw.h"
#include "../support/repetitions.h"
#include "base/text/buffer.h"
#include "io/obj/obj_vectors.h"
#include <string.h>

#define MOST_CORNERS 60000

/* A file, and the elements it uses. */
typedef struct file {
    draw *d;
    byte_buffer text;
    int lines;
    int vertices, normals;             /* so far */
    int vertices_total, normals_total; /* when complete */
    int reach;                         /* the greatest vertex that a face uses */
    int back;                          /* one in this many indices is relative; 0: none */
    bool pairs;                        /* vertices have several normals */
    size_t faces, corners, named_lines;
    uint64_t *named; /* vertex and normal of each face corner with a normal */
    size_t named_count;
} file;

static void begin_file(file *f, draw *d, int vertices, int normals)
{
    *f = (file){.d = d, .vertices_total = vertices, .normals_total = normals, .reach = vertices};
    f->named = malloc(MOST_CORNERS * sizeof *f->named);
    assert_non_null(f->named);
}

static void free_file(file *f)
{
    ffd_buffer_free(&f->text);
    free(f->named);
}

static void put_line(file *f, const char *text)
{
    ffd_buffer_format(&f->text, "%s\n", text);
    f->lines++;
}

static void put_vectors(file *f, int vertices, int normals)
{
    char text[80];
    for (; vertices > 0 && f->vertices < f->vertices_total; vertices--, f->vertices++) {
        snprintf(text, sizeof text, "v %.6f %.6f %.6f", draw_unit(f->d), draw_unit(f->d), draw_unit(f->d));
        put_line(f, text);
    }
    for (; normals > 0 && f->normals < f->normals_total; normals--, f->normals++) {
        snprintf(text, sizeof text, "vn %.6f %.6f %.6f", draw_unit(f->d), draw_unit(f->d), draw_unit(f->d));
        put_line(f, text);
    }
}

static int index_of(const file *f, int number, int so_far)
{
    const bool back = f->back && number <= so_far && draw_int(f->d, 1, f->back) == 1;
    return back ? number - so_far - 1 : number;
}

static void put_face(file *f)
{
    /* Texture coordinates of any length, so that corners end anywhere in a SIMD window. */
    static const int coordinates[] = {9, 9, 9, 99, 12345, 123456789};
    char text[400] = "f";
    for (int corners = draw_int(f->d, 3, draw_int(f->d, 1, 20) > 1 ? 4 : 16); corners > 0; corners--) {
        const int v = draw_int(f->d, 1, f->reach), vt = coordinates[draw_int(f->d, 0, 5)];
        const int n = !f->normals_total ? 7
                      : f->pairs        ? draw_int(f->d, 1, f->normals_total)
                                        : 1 + v % f->normals_total;
        char *const end = text + strlen(text);
        const size_t room = (size_t)(text + sizeof text - end);
        if (draw_int(f->d, 0, 9) == 0) {
            snprintf(end, room, " %d/%d", index_of(f, v, f->vertices), vt);
        } else {
            const int normal = index_of(f, n, f->normals);
            snprintf(end, room, vt < 12345 ? " %d/%d/%d" : " %d/%d/%09d", index_of(f, v, f->vertices), vt,
                     normal);
            assert_true(f->named_count < MOST_CORNERS);
            f->named[f->named_count++] = (uint64_t)(v - 1) << 32 | (uint64_t)(n - 1);
        }
        f->corners++;
    }
    f->faces++;
    put_line(f, text);
}

static void put_faces(file *f, int faces)
{
    for (; faces > 0; faces--)
        if (draw_int(f->d, 0, 99) > 0) {
            put_face(f);
        } else {
            put_line(f, f->normals_total ? "l 1/2/1 2/3/1 1/1/1 2/2/1 1/3/1 2/1/1 1/2/1 2/3/1" : "l 1 2 1");
            f->named_lines++;
        }
}

/* Vertices among so many other lines that their number is underestimated, and faces that use the first
   ones. */
static void put_rare_vertices(file *f)
{
    while (f->vertices < f->vertices_total) {
        put_vectors(f, 1, 0);
        for (int i = 0; i < 3; i++)
            put_line(f, "usemtl a");
    }
    put_vectors(f, 0, INT32_MAX);
    f->reach = (f->vertices_total + 24) / 25;
    put_faces(f, 3000);
    f->reach = f->vertices_total;
    put_faces(f, 3000);
}

/* Possible orders: elements first, faces first, alternating, unexpected elements. */
static void fill_file(file *f, int order)
{
    if (draw_int(f->d, 0, 1))
        put_line(f, "# a file\n\no name");
    f->lines += 2 * (f->lines > 0);
    if (order == 0)
        put_vectors(f, INT32_MAX, INT32_MAX);
    if (order < 2)
        put_faces(f, 9000);
    if (order == 2)
        for (int i = 0; i < 90; i++) {
            put_vectors(f, f->vertices_total / 80, f->normals_total / 80);
            put_faces(f, 100);
        }
    if (order == 3)
        put_rare_vertices(f);
    put_vectors(f, INT32_MAX, INT32_MAX);
}

/* Counts the blocks whose faces can only be read when all elements are known. */
static size_t count_late(const file *f)
{
    char name[] = "a.obj";
    obj_document d = {.file.input = {.data = (const unsigned char *)f->text.data, .size = f->text.size},
                      .file.name = name,
                      .threads = 2};
    obj_users found;
    size_t late = 0;
    assert_int_equal(ffd_obj_read_vectors(&d, &found, NULL), FFD_OK);
    for (size_t i = 0; i < d.blocks.count; i++)
        late += found.blocks[i].is_late;
    ffd_obj_users_free(&d, &found);
    ffd_obj_blocks_free(&d.blocks);
    ffd_spill_free(&d.position_store);
    ffd_spill_free(&d.direction_store);
    return late;
}

static ffd_status open_file(const file *f, int threads, bool only_positions, mesh_document **document,
                            ffd_error *error)
{
    file_input input = {.data = (const unsigned char *)f->text.data, .size = f->text.size};
    const ffd_source source = {.path = "a.obj", .threads = threads, .only_positions = only_positions};
    assert_false(f->text.failed);
    *error = (ffd_error){0};
    return ffd_obj_open(&input, &source, document, error);
}

static int compare(const void *a, const void *b)
{
    const uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return (x > y) - (x < y);
}

/* Sorts the corners and removes duplicates. */
static void make_pairs(file *f)
{
    size_t kept = 0;
    qsort(f->named, f->named_count, sizeof *f->named, compare);
    for (size_t i = 0; i < f->named_count; i++)
        if (i == 0 || f->named[i] != f->named[kept - 1])
            f->named[kept++] = f->named[i];
    f->named_count = kept;
}

static void check_document(const file *f, const obj_document *d)
{
    assert_true(d->blocks.count > 10);
    assert_int_equal(d->vertices, f->vertices_total);
    assert_int_equal(d->normals, f->normals_total);
    assert_int_equal(d->faces, f->faces);
    assert_int_equal(d->corners, f->corners);
    assert_int_equal(d->lines, f->named_lines);
    if (d->only_positions || f->normals_total == 0) {
        assert_null(d->pair_start);
        return;
    }
    assert_int_equal(d->file.part.normal_count, f->named_count);
    for (size_t v = 0, i = 0; v < d->vertices; v++) {
        assert_int_equal(d->pair_start[v], i);
        for (; i < f->named_count && f->named[i] >> 32 == v; i++)
            assert_int_equal(d->pair_normal[i], (uint32_t)f->named[i]);
        assert_int_equal(d->pair_start[v + 1], i);
    }
}

static void users_are_those_of_all_corners(void **state)
{
    (void)state;
    draw d = {draw_seed()};
    int early = 0; /* files with elements first and no late block */
    for (int round = 0; round < 32; round += is_under_valgrind() ? 5 : is_memory_checked() ? 3 : 1) {
        file f;
        begin_file(&f, &d, draw_int(&d, 500, 12000), round / 4 == 7 ? 0 : draw_int(&d, 1, 9000));
        f.pairs = draw_int(&d, 0, 1);
        f.back = round % 8 < 4 ? 0 : draw_int(&d, 0, 1) ? 2 : 10000;
        fill_file(&f, round % 4);
        make_pairs(&f);
        if (round % 4 == 0 && f.normals_total && !f.back)
            early += count_late(&f) == 0;
        for (int i = 0; i < 4; i++) {
            mesh_document *document;
            ffd_error error;
            if (open_file(&f, i % 2 ? 4 : 1, i > 1, &document, &error))
                fail_msg("round %d: line %zu: %s", round, error.line, error.message);
            check_document(&f, ffd_obj_of(document));
            ffd_obj_close(document);
        }
        free_file(&f);
    }
    if (!is_memory_checked()) /* which reads one or two such files, and one in fifteen has a late block */
        assert_true(early > 0);
}

static void assert_refused_so(const file *f, int line, const char *expected)
{
    for (int i = 0; i < 4; i++) {
        mesh_document *document;
        ffd_error error;
        assert_int_equal(open_file(f, i % 2 ? 4 : 1, i > 1, &document, &error), FFD_E_INVALID);
        assert_non_null(strstr(error.message, expected));
        assert_int_equal(error.line, line);
    }
}

/* The first fault of a face is reported, whether it is detected early or late; but faults of vectors come
   first. */
static void the_first_fault_is_told(void **state)
{
    (void)state;
    static const struct {
        const char *text, *expected;
    } faults[] = {
        {"f 1 2 601", "vertex index 601 is out of range: the file has 600"},
        {"l 1 601", "vertex index 601 is out of range: the file has 600"},
        {"p 99999999999", "vertex index 99999999999 is out of range: the file has 600"},
        {"f 1//1 2//301 3//1", "normal index 301 is out of range: the file has 300"},
        {"f 1//1 2//4294967295 3//1", "normal index 4294967295 is out of range: the file has 300"},
        {"f 1 2 -601", "vertex index -601 is out of range: 600 come before it"},
        {"f 1//-301", "normal index -301 is out of range: 300 come before it"},
        {"f 1 2 0", "vertex index 0 is out of range: indices start at 1"},
        {"f 1 2 x", "not a corner"},
        {"f 1/1/1 2/2/2 0/3/3", "vertex index 0 is out of range: indices start at 1"},
        {"f 1/1/1 2/2/2 3/3/0", "normal index 0 is out of range: indices start at 1"},
        {"f 1/1/1 2/2/2 601/3/3", "vertex index 601 is out of range: the file has 600"},
        {"f 1/1/1 2/2/2 3/3/301", "normal index 301 is out of range: the file has 300"},
        {"f 1/1/1 2/2/2 99999999/3/3", "vertex index 99999999 is out of range: the file has 600"},
        {"f 1/1/1 2/2/100000000 3/3/3", "normal index 100000000 is out of range: the file has 300"},
        {"f 1/1/1 2/2-2 3/3/3", "not a corner (v, v/t, v//n or v/t/n): \"2/2-2\""},
        {"f 1/1/1 2-2/2 3/3/3", "not a corner (v, v/t, v//n or v/t/n): \"2-2/2\""},
        {"f 1/1/1 2/2/2/ 3/3/3", "not a corner (v, v/t, v//n or v/t/n): \"2/2/2/\""},
        {"f 1/1/1 2/2/2\\2 3/3/3", "not a corner (v, v/t, v//n or v/t/n): \"2/2/2\\2\""},
        {"f 1/1/1 2/2/2- 3/3/3", "not a corner (v, v/t, v//n or v/t/n): \"2/2/2-\""},
    };
    draw d = {draw_seed()};
    for (size_t i = 0; i < sizeof faults / sizeof *faults; i += (size_t)stride(5)) {
        file f;
        begin_file(&f, &d, 600, 300);
        put_vectors(&f, 600, 300);
        put_faces(&f, draw_int(&d, 0, 6000));
        put_line(&f, faults[i].text);
        const int line = f.lines;
        put_faces(&f, draw_int(&d, 0, 3000));
        put_line(&f, faults[draw_int(&d, 0, sizeof faults / sizeof *faults - 1)].text);
        put_faces(&f, 3000);
        assert_refused_so(&f, line, faults[i].expected);
        put_line(&f, "v 1 2 z");
        assert_refused_so(&f, f.lines, "coordinate z of a vertex is not a number");
        free_file(&f);
    }
}

/* A last `vn` decides about all normals used before it. */
static void a_late_normal_counts(void **state)
{
    (void)state;
    draw d = {draw_seed()};
    file f;
    begin_file(&f, &d, 600, 0);
    put_vectors(&f, 600, 0);
    put_faces(&f, 9000); /* all use normal 7 */
    for (int i = 0; i < 7; i++)
        put_line(&f, "vn 0 0 1");
    f.normals_total = 7;
    for (size_t i = 0; i < f.named_count; i++)
        f.named[i] = f.named[i] >> 32 << 32 | 6;
    make_pairs(&f);
    for (int threads = 1; threads < 4; threads++) {
        mesh_document *document;
        ffd_error error;
        assert_int_equal(open_file(&f, threads, false, &document, &error), FFD_OK);
        check_document(&f, ffd_obj_of(document));
        ffd_obj_close(document);
    }
    free_file(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(users_are_those_of_all_corners),
        cmocka_unit_test(the_first_fault_is_told),
        cmocka_unit_test(a_late_normal_counts),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
