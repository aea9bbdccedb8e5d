/* Lattices with keys: the right answers of reference cases in memory, texts and copies that are the same
   lattice, failures that change nothing. Arguments: files of tests/cli/authoring. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "../support/draw.h"
#include "../support/file_content.h"
#include "../support/message.h"
#include "../support/repetitions.h"
#include "base/memory/memory.h"
#include "lattice/lattice.h"
#include "json/json_parse.h"
#include <ffd/points.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static char **case_files;
static int case_count;

static ffd_lattice *parse(const char *text, size_t size)
{
    ffd_lattice *lattice = NULL;
    ffd_error error = {0};
    if (ffd_lattice_parse(text, size, "k.json", &lattice, &error))
        fail_msg("%s", message_of(&error));
    return lattice;
}

static double number_of(const json_tree *tree, uint32_t value)
{
    double number = NAN;
    assert_true(ffd_json_tree_number(tree, value, &number));
    return number;
}

/* Reads an array of points. Returns their number. */
static size_t read_points(const json_tree *tree, uint32_t array, double xyz[64][3])
{
    size_t count = 0;
    for (uint32_t p = ffd_json_tree_first(tree, array); p != JSON_NONE; p = ffd_json_tree_after(tree, p)) {
        assert_true(count < 64);
        for (size_t c = 0; c < 3; c++)
            xyz[count][c] = number_of(tree, ffd_json_tree_element(tree, p, c));
        count++;
    }
    return count;
}

static void check_frame(ffd_lattice *lattice, const ffd_embedding *embedding, ffd_span in,
                        const json_tree *tree, uint32_t frame, double tolerance)
{
    double right[64][3], found[64][3];
    const size_t count = read_points(tree, ffd_json_tree_member(tree, frame, "points"), right);
    const ffd_span out = {.data = found, .count = count, .type = FFD_FLOAT64};
    const double time = number_of(tree, ffd_json_tree_member(tree, frame, "time"));
    assert_int_equal(ffd_lattice_set_time(lattice, time, NULL), FFD_OK);
    assert_int_equal(ffd_embedding_deform(embedding, lattice, in, out, NULL, NULL, NULL), FFD_OK);
    for (size_t i = 0; i < count; i++)
        for (size_t c = 0; c < 3; c++)
            assert_true(fabs(found[i][c] - right[i][c]) <= tolerance);
}

static void check_case(const json_tree *tree)
{
    const uint32_t file = ffd_json_tree_member(tree, 0, "lattice");
    const uint32_t expect = ffd_json_tree_member(tree, 0, "expect");
    const uint32_t frames = ffd_json_tree_member(tree, expect, "frames");
    char *const text = ffd_json_tree_text(tree, file);
    ffd_lattice *lattice = parse(text, strlen(text));
    double before[64][3], times[8];
    ffd_embedding_desc desc;
    ffd_embedding *embedding = NULL;
    ffd_embedding_desc_init(&desc, sizeof desc);
    desc.lattice = lattice;
    desc.points.data = before;
    desc.points.count = read_points(tree, ffd_json_tree_member(tree, 0, "before"), before);
    desc.points.type = FFD_FLOAT64;
    assert_int_equal(ffd_embedding_create(&desc, NULL, &embedding, NULL), FFD_OK);
    const uint32_t keys = ffd_json_tree_member(tree, file, "keys");
    assert_int_equal(ffd_lattice_get_keys(lattice, times), ffd_json_tree_count(tree, keys));
    for (size_t k = 0; k < ffd_json_tree_count(tree, keys); k++)
        assert_true(times[k] == number_of(tree, ffd_json_tree_member(
                                                    tree, ffd_json_tree_element(tree, keys, k), "time")));
    const double tolerance = number_of(tree, ffd_json_tree_member(tree, expect, "tolerance"));
    size_t checked = 0;
    for (uint32_t f = ffd_json_tree_first(tree, frames); f != JSON_NONE; f = ffd_json_tree_after(tree, f)) {
        check_frame(lattice, embedding, desc.points, tree, f, tolerance);
        checked++;
    }
    assert_true(checked > 5);
    ffd_embedding_destroy(&embedding);
    ffd_lattice_destroy(&lattice);
    ffd_free(text);
}

static void the_right_answers_of_reference_cases(void **state)
{
    (void)state;
    assert_true(case_count > 0);
    for (int i = 0; i < case_count; i++) {
        file_input input;
        json_tree tree;
        assert_int_equal(ffd_file_load(case_files[i], &input, NULL), FFD_OK);
        const json_input text = {.text = (const char *)input.data, .size = input.size, .name = case_files[i]};
        assert_int_equal(ffd_json_parse(&text, &tree, NULL), FFD_OK);
        check_case(&tree);
        ffd_json_tree_free(&tree);
        ffd_file_unload(&input);
    }
}

/* Appends a random move. */
static void add_move(draw *d, bool named, char *text, size_t capacity)
{
    const size_t used = strlen(text);
    const int kind = draw_int(d, 0, 3);
    const double x = draw_between(d, -1, 1);
    if (named)
        snprintf(text + used, capacity - used,
                 "{\"twist\":{\"axis\":\"y\",\"degrees\":{\"$\":\"A\"}}},{\"at\":[0,\"all\",1],\"by\":{\"$\":"
                 "\"-B\",\"times\":%.17g}},{\"scale\":{\"factor\":{\"$\":\"F\"}}}",
                 x);
    else if (kind == 0)
        snprintf(text + used, capacity - used, "{\"at\":[%d,\"all\",\"all\"],\"by\":[%.17g,0,1]}",
                 draw_int(d, 0, 3), x);
    else if (kind == 1)
        snprintf(text + used, capacity - used, "{\"taper\":{\"axis\":\"z\",\"factor\":%.17g}}", 1 + x / 2);
    else if (kind == 2)
        snprintf(text + used, capacity - used, "{\"drag\":[{\"point\":[0.5,0.5,0.5],\"by\":[%.17g,0,0]}]}",
                 x);
    else
        snprintf(text + used, capacity - used,
                 "{\"at\":[\"all\",\"all\",0],\"rotate\":{\"axis\":[1,2,3],\"degrees\":%.17g}}", 90 * x);
}

static void add_offsets(draw *d, char *text, size_t capacity)
{
    for (int i = 0; i < 64; i++) {
        const size_t used = strlen(text);
        const bool moves = draw_int(d, 0, 2) > 0;
        snprintf(text + used, capacity - used, "%s[%.17g,0,%.17g]", i ? "," : "",
                 moves ? draw_between(d, -1, 1) : 0, moves ? draw_unit(d) : 0);
    }
}

#define APPEND(...) snprintf(text + strlen(text), capacity - strlen(text), __VA_ARGS__)

/* Writes a random lattice file with keys. */
static void make_file(draw *d, bool of_values, bool of_mesh, char *text, size_t capacity)
{
    const int keys = draw_int(d, 2, 5);
    double time = draw_unit(d);
    *text = 0;
    APPEND("{\"format\":\"ffd-lattice\",\"version\":1,\"size\":[4,4,4],\"rest\":%s,\"units\":\"box\",",
           of_mesh ? "{\"box\":\"mesh\"}" : "{\"box\":{\"min\":[0,0,0],\"max\":[1,2,3]}}");
    if (of_values) {
        APPEND("\"parameters\":{\"F\":{\"default\":[1,1.25,1]}},\"moves\":[");
        add_move(d, true, text, capacity);
        APPEND("],");
    }
    APPEND("\"keys\":[");
    for (int k = 0; k < keys; k++, time += 0.1 + draw_unit(d)) {
        APPEND("%s{\"time\":%.17g,", k ? "," : "", time);
        if (of_values) {
            APPEND("\"set\":{\"B\":[%.17g,0,1],\"A\":%.17g}}", draw_unit(d), draw_between(d, -90, 90));
        } else if (draw_int(d, 0, 1)) {
            APPEND("\"offsets\":[");
            add_offsets(d, text, capacity);
            APPEND("]}");
        } else {
            APPEND("\"moves\":[");
            add_move(d, false, text, capacity);
            APPEND("]}");
        }
    }
    APPEND("]}");
}

static void fit(ffd_lattice *lattice)
{
    static const double min[3] = {0, 0, 0}, max[3] = {1, 2, 3};
    assert_int_equal(ffd_lattice_fit(lattice, min, max, NULL), FFD_OK);
}

static void check_same(const ffd_lattice *a, const ffd_lattice *b)
{
    assert_memory_equal(a->rest, b->rest, 3 * a->count * sizeof *a->rest);
    assert_memory_equal(a->difference, b->difference, 3 * a->count * sizeof *a->rest);
}

static ffd_lattice *reread(const ffd_lattice *lattice)
{
    char *text;
    size_t size;
    assert_int_equal(ffd_lattice_text(lattice, &text, &size, NULL), FFD_OK);
    ffd_lattice *const read = parse(text, size);
    ffd_free(text);
    return read;
}

/* What is written and read, or copied, is the same at each time; the text of a still too, and it has no keys.
 */
static void check_times(draw *d, ffd_lattice *lattice)
{
    ffd_lattice *read = reread(lattice), *copy;
    double times[8];
    const size_t count = ffd_lattice_get_keys(lattice, times);
    assert_int_equal(ffd_lattice_get_keys(read, NULL), count);
    assert_int_equal(ffd_lattice_copy(lattice, &copy, NULL), FFD_OK);
    fit(lattice);
    fit(read);
    check_same(lattice, read);
    for (int i = 0; i < 6; i++) {
        const double time = i < 2 ? times[(size_t)draw_int(d, 0, (int)count - 1)]
                                  : draw_between(d, times[0] - 0.5, times[count - 1] + 0.5);
        ffd_lattice *still;
        assert_int_equal(ffd_lattice_set_time(lattice, time, NULL), FFD_OK);
        assert_int_equal(ffd_lattice_set_time(read, time, NULL), FFD_OK);
        assert_int_equal(ffd_lattice_set_time(copy, time, NULL), FFD_OK); /* before it has positions */
        fit(copy);
        check_same(lattice, read);
        check_same(lattice, copy);
        still = reread(lattice);
        fit(still);
        check_same(lattice, still);
        assert_int_equal(ffd_lattice_get_keys(still, NULL), 0);
        assert_int_equal(ffd_lattice_set_time(still, time, NULL), FFD_E_ARGUMENT);
        ffd_lattice_destroy(&still);
    }
    ffd_lattice_destroy(&read);
    ffd_lattice_destroy(&copy);
}

static void texts_and_copies_are_the_same_lattice(void **state)
{
    (void)state;
    draw d = {draw_seed()};
    static char text[40000];
    for (int number = 0; number < repetitions(200); number++) {
        const bool of_values = number % 2, of_mesh = number % 4 > 1;
        make_file(&d, of_values, of_mesh, text, sizeof text);
        ffd_lattice *lattice = parse(text, strlen(text));
        check_times(&d, lattice);
        ffd_lattice_destroy(&lattice);
    }
}

/* The control points between two keys lie on the line between those of the keys, in proportion to the time;
   one that neither moves does not move, to the bit. */
static void points_go_straight(void **state)
{
    (void)state;
    draw d = {draw_seed()};
    static char text[40000];
    for (int number = 0; number < repetitions(100); number++) {
        double times[8], ends[2][192];
        make_file(&d, false, false, text, sizeof text);
        ffd_lattice *lattice = parse(text, strlen(text));
        const size_t count = ffd_lattice_get_keys(lattice, times);
        const size_t k = (size_t)draw_int(&d, 0, (int)count - 2);
        const double part = draw_unit(&d), time = times[k] + part * (times[k + 1] - times[k]);
        for (size_t e = 0; e < 2; e++) {
            assert_int_equal(ffd_lattice_set_time(lattice, times[k + e], NULL), FFD_OK);
            memcpy(ends[e], ffd_lattice_get_offsets(lattice), sizeof ends[e]);
        }
        assert_int_equal(ffd_lattice_set_time(lattice, time, NULL), FFD_OK);
        for (size_t i = 0; i < 192; i++) {
            const double found = ffd_lattice_get_offsets(lattice)[i];
            if (ends[0][i] == ends[1][i])
                assert_true(found == ends[0][i]);
            assert_true(fabs(found - ((1 - part) * ends[0][i] + part * ends[1][i])) <= 1e-14);
            assert_true(fabs(lattice->deformed[i] - lattice->rest[i] - found) <= 1e-14);
        }
        ffd_lattice_destroy(&lattice);
    }
}

/* At each time a lattice has the values of the keys, whatever defaults their placeholders have. */
static void values_of_keys_come_before_defaults(void **state)
{
    (void)state;
    draw d = {draw_seed()};
    static char text[40000], with[40000];
    static const char list[] = "\"parameters\":{",
                      more[] = "\"A\":{\"default\":7},\"B\":{\"default\":[0,0,2]},";
    for (int number = 0; number < repetitions(50); number++) {
        make_file(&d, true, false, text, sizeof text);
        const char *const at = strstr(text, list) + strlen(list);
        snprintf(with, sizeof with, "%.*s%s%s", (int)(at - text), text, more, at);
        ffd_lattice *a = parse(text, strlen(text)), *b = parse(with, strlen(with)), *c = reread(b);
        double times[8];
        const size_t count = ffd_lattice_get_keys(a, times);
        for (size_t k = 0; k < count; k++) {
            const double time = times[k] + draw_unit(&d) / 10;
            assert_int_equal(ffd_lattice_set_time(a, time, NULL), FFD_OK);
            assert_int_equal(ffd_lattice_set_time(b, time, NULL), FFD_OK);
            assert_int_equal(ffd_lattice_set_time(c, time, NULL), FFD_OK);
            check_same(a, b);
            check_same(a, c);
        }
        ffd_lattice_destroy(&a);
        ffd_lattice_destroy(&b);
        ffd_lattice_destroy(&c);
    }
}

static void a_failure_changes_nothing(void **state)
{
    (void)state;
    static const char text[] =
        "{\"format\":\"ffd-lattice\",\"version\":1,\"size\":[2,2,2],\"rest\":{\"box\":{\"min\":[0,0,0],"
        "\"max\":[1,1,1]}},\"moves\":[{\"jitter\":{\"sigma\":1,\"seed\":{\"$\":\"N\"}}}],\"keys\":[{\"time\":"
        "0,\"set\":{\"N\":1}},{\"time\":2,\"set\":{\"N\":3}}]}";
    double before[24], time;
    ffd_error error;
    ffd_lattice *lattice = parse(text, strlen(text));
    assert_int_equal(ffd_lattice_set_time(lattice, 1, NULL), FFD_OK);
    memcpy(before, ffd_lattice_get_offsets(lattice), sizeof before);
    assert_int_equal(ffd_lattice_set_time(lattice, 0.25, &error), FFD_E_INVALID);
    assert_string_equal(message_of(&error),
                        "k.json:1: /moves/0/jitter/seed: seed 1.25 is not a whole number from 0 to "
                        "9007199254740991");
    assert_int_equal(ffd_lattice_set_time(lattice, NAN, NULL), FFD_E_ARGUMENT);
    assert_memory_equal(before, ffd_lattice_get_offsets(lattice), sizeof before);
    /* Control points that are set are no longer those of the keys. */
    assert_int_equal(ffd_lattice_set_offsets(lattice, NULL, 8, before, NULL), FFD_OK);
    assert_int_equal(ffd_lattice_get_keys(lattice, &time), 0);
    assert_int_equal(ffd_lattice_set_time(lattice, 1, NULL), FFD_E_ARGUMENT);
    ffd_lattice_destroy(&lattice);
}

static ffd_status use(const char *text)
{
    ffd_lattice *lattice = NULL, *copy = NULL;
    char *out = NULL;
    size_t size;
    ffd_status status = ffd_lattice_parse(text, strlen(text), "k.json", &lattice, NULL);
    if (!status)
        status = ffd_lattice_set_time(lattice, 1, NULL);
    if (!status)
        status = ffd_lattice_copy(lattice, &copy, NULL);
    if (!status)
        status = ffd_lattice_text(copy, &out, &size, NULL);
    ffd_free(out);
    ffd_lattice_destroy(&copy);
    ffd_lattice_destroy(&lattice);
    return status;
}

static void every_allocation_may_fail(void **state)
{
    (void)state;
    draw d = {draw_seed()};
    static char text[40000];
    for (int kind = 0; kind < 4; kind++) {
        long successes = 0;
        ffd_status status = FFD_E_MEMORY;
        make_file(&d, kind % 2, false, text, sizeof text);
        for (; status == FFD_E_MEMORY && successes < 1000; successes++) {
            ffd_alloc_fail_after(successes);
            status = use(text);
            ffd_alloc_fail_after(-1);
        }
        assert_int_equal(status, FFD_OK);
        assert_true(successes > 20);
    }
}

int main(int count, char **arguments)
{
    case_files = arguments + 1;
    case_count = count - 1;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_right_answers_of_reference_cases),
        cmocka_unit_test(texts_and_copies_are_the_same_lattice),
        cmocka_unit_test(points_go_straight),
        cmocka_unit_test(values_of_keys_come_before_defaults),
        cmocka_unit_test(a_failure_changes_nothing),
        cmocka_unit_test(every_allocation_may_fail),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
