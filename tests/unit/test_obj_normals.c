/* OBJ: normals that vertices share get new values, in files drawn at random in all dialects. */
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
    int vertices_total, normals_total; /* in the end */
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

/* Names element `number` (from 1) forwards, or back from the last so far where that is possible. */
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

static void draw_file(writer *w)
{
    w->vertices_total = draw_int(w->d, 1, 6);
    w->normals_total = draw_int(w->d, 1, 4);
    w->line_ends = draw_int(w->d, 0, 3);
    w->continues = draw_int(w->d, 0, 2) == 0;
    w->counts_back = draw_int(w->d, 0, 1) == 1;
    for (int count = draw_int(w->d, 0, 25); count > 0; count--)
        put_statement(w);
    while (w->vertices < w->vertices_total) {
        put_numbers(w, "v", ++w->vertices);
        put_line_end(w);
    }
    while (w->normals < w->normals_total) {
        put_numbers(w, "vn", ++w->normals);
        put_line_end(w);
    }
    for (int count = draw_int(w->d, 0, 3); count > 0; count--)
        put_statement(w);
    static const char *const ends[] = {"", "", "# c", "f 1//1", "f 1//1 \\", "# \\"};
    put(w, ends[draw_int(w->d, 0, 5)]);
}

static void test_random_files(void **state)
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

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_random_files)};
    return cmocka_run_group_tests(tests, NULL, remove_saved);
}
