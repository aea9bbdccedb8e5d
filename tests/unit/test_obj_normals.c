/* OBJ: normals shared by vertices get new values, in random files of all dialects. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "../support/obj_check.h"

typedef struct writer {
    draw *d;
    char text[8192];
    int vertices, normals;             /* so far */
    int vertices_total, normals_total; /* when complete */
    int line_ends;                     /* 0..2: one kind; 3: all kinds */
    bool continues, counts_back;
} writer;

static void put(writer *w, const char *text)
{
    strcat(w->text, text);
}

static void put_line_end(writer *w)
{
    static const char *const ends[] = {"\n", "\r\n", "\r"};
    put(w, ends[w->line_ends == 3 ? draw_int(w->d, 0, 2) : w->line_ends]);
}

static void put_blank(writer *w)
{
    static const char *const blanks[] = {" ", "  ", "\t", " \t "};
    put(w, blanks[draw_int(w->d, 0, 3)]);
    if (w->continues && draw_int(w->d, 0, 9) == 0) {
        put(w, "\\");
        put_line_end(w);
    }
}

static void put_number(writer *w, int number)
{
    sprintf(w->text + strlen(w->text), "%d", number);
}

/* Writes element `number` (from 1) as an absolute index or, if possible, as a relative one. */
static void put_index(writer *w, int number, int so_far)
{
    const bool back = w->counts_back && number <= so_far && draw_int(w->d, 0, 1);
    put_number(w, back ? number - so_far - 1 : number);
}

static void put_face(writer *w)
{
    put(w, "f");
    for (int corners = draw_int(w->d, 1, 5); corners > 0; corners--) {
        put_blank(w);
        put_index(w, draw_int(w->d, 1, w->vertices_total), w->vertices);
        if (draw_int(w->d, 0, 7) == 0)
            continue;
        put(w, draw_int(w->d, 0, 1) ? "//" : "/5/");
        put_index(w, draw_int(w->d, 1, w->normals_total), w->normals);
    }
}

static void put_numbers(writer *w, const char *keyword, int first)
{
    put(w, keyword);
    put_blank(w);
    put_number(w, first);
    for (int i = 0; i < 2; i++) {
        put_blank(w);
        put(w, draw_int(w->d, 0, 1) ? "0.50" : "1");
    }
}

static void put_statement(writer *w)
{
    static const char *const others[] = {"# c", "# \\", "", "usemtl a#b", "l 1 1", "s off", "end"};
    const int kind = draw_int(w->d, 0, 9);
    if (kind < 2 && w->vertices < w->vertices_total)
        put_numbers(w, "v", ++w->vertices);
    else if (kind < 4 && w->normals < w->normals_total)
        put_numbers(w, "vn", ++w->normals);
    else if (kind < 8)
        put_face(w);
    else
        put(w, others[draw_int(w->d, 0, 6)]);
    if (draw_int(w->d, 0, 9) == 0)
        put(w, " # c");
    put_line_end(w);
}

static void put_missing_vectors(writer *w)
{
    while (w->vertices < w->vertices_total) {
        put_numbers(w, "v", ++w->vertices);
        put_line_end(w);
    }
    while (w->normals < w->normals_total) {
        put_numbers(w, "vn", ++w->normals);
        put_line_end(w);
    }
}

static void draw_file(writer *w)
{
    w->vertices_total = draw_int(w->d, 1, 6);
    w->normals_total = draw_int(w->d, 1, 4);
    w->line_ends = draw_int(w->d, 0, 3);
    w->continues = draw_int(w->d, 0, 2) == 0;
    w->counts_back = draw_int(w->d, 0, 1) == 1;
    for (int count = draw_int(w->d, 0, 25); count > 0; count--)
        put_statement(w);
    put_missing_vectors(w);
    for (int count = draw_int(w->d, 0, 3); count > 0; count--)
        put_statement(w);
    static const char *const ends[] = {"", "", "# c", "f 1//1", "f 1//1 \\", "# \\"};
    put(w, ends[draw_int(w->d, 0, 5)]);
}

static void random_files_hold_their_new_normals(void **state)
{
    (void)state;
    draw d = {draw_seed()};
    size_t pairs = 0;
    for (int round = 0; round < 400; round++) {
        writer w = {.d = &d};
        draw_file(&w);
        mesh_document *document = opened_bytes(obj, w.text, strlen(w.text));
        pairs += document->parts->normal_count;
        check_new_normals(document, &d, true);
        obj->close(document);
    }
    assert_true(pairs > 400);
}

/* A file in which each vertex has the normal of its own number, the usual case. */
static void draw_plain_file(writer *w)
{
    w->vertices_total = w->normals_total = draw_int(w->d, 3, 20);
    put_missing_vectors(w);
    put(w, "f");
    for (int i = 1; i <= w->vertices; i++) {
        put(w, " ");
        put_number(w, i);
        put(w, "//");
        put_number(w, i);
    }
}

/* Moves half of the positions, each along one axis or more. */
static void move_some(mesh_document *document, draw *d)
{
    const size_t count = document->parts->vertex_count;
    double xyz[3 * 20];
    uint8_t changed[20];
    obj->read(document, 0, MESH_POSITIONS, MESH_STORED, 0, count, xyz);
    for (size_t i = 0; i < count; i++) {
        changed[i] = draw_int(d, 0, 1) == 1;
        xyz[3 * i + (size_t)draw_int(d, 0, 2)] += 0.125;
    }
    obj->write(document, 0, MESH_POSITIONS, 0, count, xyz, changed);
}

/* Applies the same changes, with or without results in place of the input. */
static void saved_text(const writer *file, uint64_t seed, bool in_place, byte_buffer *text)
{
    draw d = {seed};
    uint8_t changed[64];
    file_input saved;
    ffd_error error = {0};
    mesh_document *document = opened_bytes(obj, file->text, strlen(file->text));
    const size_t count = document->parts->normal_count;
    assert_true(count <= sizeof changed);
    double *values = draw_normals(document, &d);
    memset(changed, 1, sizeof changed);
    const mesh_results results = {.directions = true, .replace = in_place};
    assert_int_equal(obj->begin_results(document, &results, NULL), FFD_OK);
    move_some(document, &d);
    obj->write(document, 0, MESH_NORMALS, 0, count, values, changed);
    assert_int_equal(save_bytes(document, &saved, &error), FFD_OK);
    ffd_buffer_append(text, saved.data, saved.size);
    ffd_file_unload(&saved);
    free(values);
    obj->close(document);
}

static void results_in_place_give_the_same_file(void **state)
{
    (void)state;
    draw d = {draw_seed()};
    size_t different = 0;
    for (int round = 0; round < 400; round++) {
        writer w = {.d = &d};
        const uint64_t seed = draw_bits(&d);
        byte_buffer to_file = {0}, in_place = {0};
        if (round % 2)
            draw_file(&w);
        else
            draw_plain_file(&w);
        saved_text(&w, seed, false, &to_file);
        saved_text(&w, seed, true, &in_place);
        assert_int_equal(to_file.size, in_place.size);
        assert_memory_equal(to_file.data, in_place.data, to_file.size);
        different += to_file.size != strlen(w.text) || memcmp(to_file.data, w.text, to_file.size) != 0;
        ffd_buffer_free(&to_file);
        ffd_buffer_free(&in_place);
    }
    assert_true(different > 300);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(random_files_hold_their_new_normals),
        cmocka_unit_test(results_in_place_give_the_same_file),
    };
    return cmocka_run_group_tests(tests, NULL, remove_saved);
}
