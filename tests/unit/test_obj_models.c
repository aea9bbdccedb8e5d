/* OBJ: each sample model in the folder FFD_MODELS is read, and written with only the changed numbers. */
#define _XOPEN_SOURCE 700 /* nftw */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "../support/obj_check.h"
#include "../support/repetitions.h"
#include "base/file/path.h"
#include <ftw.h>

/* Made to test readers with indices that refer to nothing. */
static const char invalid_model[] = "synthetic_partial_attrib_0_obj.obj";

static char **paths;
static size_t path_count;

static int add_path(const char *path, const struct stat *info, int type, struct FTW *place)
{
    (void)info;
    (void)place;
    if (type == FTW_F && ffd_path_has_ending(path, ".obj")) {
        paths = plain_grow(paths, path_count, sizeof *paths);
        paths[path_count++] = plain_join(NULL, path, "");
    }
    return 0;
}

static mesh_document *open_model(const char *path, file_input *input)
{
    mesh_document *document;
    ffd_error error;
    assert_int_equal(ffd_file_load(path, input, NULL), FFD_OK);
    const ffd_status status = open_bytes(obj, input->data, input->size, &document, &error);
    if (strcmp(ffd_path_name(path), invalid_model) == 0) {
        assert_int_equal(status, FFD_E_INVALID);
        assert_int_equal(error.line, 23);
        assert_string_equal(error.message, "vertex index 0 is out of range: indices start at 1");
        ffd_file_unload(input);
        return NULL;
    }
    if (status)
        fail_msg("%s:%zu: %s", path, error.line, error.message);
    return document;
}

typedef void (*model_check)(const char *path, mesh_document *document, const file_input *input);

static void for_each_model(model_check check)
{
    size_t checked = 0;
    for (size_t i = 0; i < path_count; i += (size_t)stride(4)) {
        file_input input;
        mesh_document *document = open_model(paths[i], &input);
        if (!document)
            continue;
        check(paths[i], document, &input);
        checked++;
        obj->close(document);
        ffd_file_unload(&input);
    }
    printf("%zu models\n", checked);
    assert_true(checked > 0);
}

static void check_unchanged(const char *path, mesh_document *document, const file_input *input)
{
    file_input saved;
    assert_int_equal(obj->begin_results(document, &(mesh_results){.directions = true}, NULL), FFD_OK);
    assert_int_equal(save_bytes(document, &saved, NULL), FFD_OK);
    if (!same_bytes(&saved, input->data, input->size))
        fail_msg("%s: saved with other bytes", path);
    ffd_file_unload(&saved);
}

static void unchanged_models_are_saved_to_the_byte(void **state)
{
    (void)state;
    for_each_model(check_unchanged);
}

/* A walk over words and gaps, which only knows where statements begin. */
typedef struct word_walk {
    const char *at, *end;
    const char *gap, *word; /* the blanks before the word, and the word */
    char keyword[4];        /* of the statement, truncated */
    int place;              /* of the word in its statement; 0: the keyword */
    bool continued;
} word_walk;

static bool is_gap(char c)
{
    return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

static bool next_word(word_walk *walk)
{
    bool new_line = !walk->word;
    walk->gap = walk->at;
    for (; walk->at < walk->end && is_gap(*walk->at); walk->at++)
        new_line = new_line || *walk->at == '\n' || *walk->at == '\r';
    walk->word = walk->at;
    while (walk->at < walk->end && !is_gap(*walk->at))
        walk->at++;
    if (new_line && !walk->continued) {
        walk->place = 0;
        snprintf(walk->keyword, sizeof walk->keyword, "%.*s", (int)(walk->at - walk->word), walk->word);
    } else if (!walk->continued || walk->at - walk->word != 1)
        walk->place++;
    walk->continued = walk->at - walk->word == 1 && *walk->word == '\\';
    if (walk->continued)
        walk->place--; /* it is not an argument */
    return walk->word < walk->at;
}

static bool same_range(const char *a, const char *a_end, const char *b, const char *b_end)
{
    return a_end - a == b_end - b && memcmp(a, b, (size_t)(a_end - a)) == 0;
}

/* Checks that only arguments 1 to 3 of `v` differ, each by exactly 1. Returns their number. */
static size_t check_words(const char *path, const file_input *input, const file_input *saved)
{
    const char *a_data = (const char *)input->data, *b_data = (const char *)saved->data;
    const size_t mark = input->size >= 3 && memcmp(a_data, "\xEF\xBB\xBF", 3) == 0 ? 3 : 0;
    word_walk a = {.at = a_data + mark, .end = a_data + input->size},
              b = {.at = b_data + mark, .end = b_data + saved->size};
    size_t differences = 0;
    assert_true(saved->size >= mark && memcmp(a_data, b_data, mark) == 0);
    for (;;) {
        const bool in_a = next_word(&a), in_b = next_word(&b);
        assert_int_equal(in_a, in_b);
        assert_true(same_range(a.gap, a.word, b.gap, b.word));
        if (!in_a)
            return differences;
        if (same_range(a.word, a.at, b.word, b.at))
            continue;
        if (strcmp(a.keyword, "v") != 0 || a.place < 1 || a.place > 3)
            fail_msg("%s: \"%.*s\" has become \"%.*s\" in a '%s'", path, (int)(a.at - a.word), a.word,
                     (int)(b.at - b.word), b.word, a.keyword);
        char *end;
        assert_true(strtod(a.word, NULL) + 1 == strtod(b.word, &end));
        assert_ptr_equal(end, b.at);
        differences++;
    }
}

static void check_moved(const char *path, mesh_document *document, const file_input *input)
{
    const size_t count = document->parts->vertex_count;
    size_t expected = 0;
    file_input saved;
    assert_int_equal(obj->begin_results(document, &(mesh_results){.directions = true}, NULL), FFD_OK);
    for (size_t i = 0; i < count; i++) {
        double old[3], new[3];
        const uint8_t changed = 1;
        obj->read(document, 0, MESH_POSITIONS, MESH_STORED, i, 1, old);
        for (int a = 0; a < 3; a++) {
            new[a] = old[a] + 1;
            expected += new[a] != old[a];
        }
        obj->write(document, 0, MESH_POSITIONS, i, 1, new, &changed);
    }
    assert_int_equal(save_bytes(document, &saved, NULL), FFD_OK);
    assert_int_equal(check_words(path, input, &saved), expected);
    ffd_file_unload(&saved);
}

static void moving_all_vertices_changes_only_coordinates(void **state)
{
    (void)state;
    for_each_model(check_moved);
}

static draw drawn;

static void check_normals(const char *path, mesh_document *document, const file_input *input)
{
    (void)path;
    (void)input;
    check_new_normals(document, &drawn, false);
}

static void saved_models_hold_their_new_normals(void **state)
{
    (void)state;
    drawn.state = draw_seed();
    for_each_model(check_normals);
}

static int find_models(void **state)
{
    (void)state;
    return nftw(getenv("FFD_MODELS"), add_path, 16, FTW_PHYS);
}

static int free_paths(void **state)
{
    for (size_t i = 0; i < path_count; i++)
        free(paths[i]);
    free(paths);
    return remove_saved(state);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(unchanged_models_are_saved_to_the_byte),
        cmocka_unit_test(moving_all_vertices_changes_only_coordinates),
        cmocka_unit_test(saved_models_hold_their_new_normals),
    };
    if (!getenv("FFD_MODELS")) {
        puts("SKIP: models: FFD_MODELS is not set");
        return 77;
    }
    return cmocka_run_group_tests(tests, find_models, free_paths);
}
