/* The calls that make lattices of lattices beside right answers of the reference cases: one of each kind.
   Arguments: refine, set, seam and jitter files of tests/cli/authoring, in this order. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/file/input.h"
#include "base/memory/memory.h"
#include "json/json_parse.h"
#include <ffd/author.h>
#include <math.h>
#include <string.h>

enum { REFINE, SET, SEAM, JITTER, KINDS };

static char **case_files;

/* A case, and the lattice that it begins with. */
typedef struct answer {
    file_input file;
    json_tree tree;
    uint32_t expect;
    double tolerance;
    ffd_lattice *lattice;
} answer;

static ffd_lattice *lattice_of(const json_tree *tree, const char *member)
{
    char *const text = ffd_json_tree_text(tree, ffd_json_tree_member(tree, 0, member));
    ffd_lattice *lattice = NULL;
    assert_non_null(text);
    assert_int_equal(ffd_lattice_parse(text, strlen(text), member, &lattice, NULL), FFD_OK);
    ffd_free(text);
    return lattice;
}

static double number_of(const answer *a, uint32_t value)
{
    double number = NAN;
    assert_true(ffd_json_tree_number(&a->tree, value, &number));
    return number;
}

static void begin(answer *a, int kind)
{
    const char *const name = case_files[kind];
    assert_int_equal(ffd_file_load(name, &a->file, NULL), FFD_OK);
    const json_input text = {.text = (const char *)a->file.data, .size = a->file.size, .name = name};
    assert_int_equal(ffd_json_parse(&text, &a->tree, NULL), FFD_OK);
    a->expect = ffd_json_tree_member(&a->tree, 0, "expect");
    a->tolerance = number_of(a, ffd_json_tree_member(&a->tree, a->expect, "tolerance"));
    a->lattice = lattice_of(&a->tree, "lattice");
}

static void end(answer *a, ffd_lattice *made)
{
    ffd_lattice_destroy(&made);
    ffd_lattice_destroy(&a->lattice);
    ffd_json_tree_free(&a->tree);
    ffd_file_unload(&a->file);
}

/* Compares numbers with an array of numbers, or of points. */
static void check_numbers(const answer *a, const char *member, const double *found, size_t count)
{
    const uint32_t array = ffd_json_tree_member(&a->tree, a->expect, member);
    size_t n = 0;
    assert_true(array != JSON_NONE);
    assert_non_null(found);
    for (uint32_t e = ffd_json_tree_first(&a->tree, array); e != JSON_NONE;
         e = ffd_json_tree_after(&a->tree, e)) {
        const bool is_point = ffd_json_tree_first(&a->tree, e) != JSON_NONE;
        for (size_t c = 0; c < (is_point ? 3 : 1); c++, n++) {
            const double right = number_of(a, is_point ? ffd_json_tree_element(&a->tree, e, c) : e);
            assert_true(n < count && fabs(found[n] - right) <= a->tolerance);
        }
    }
    assert_int_equal(n, count);
}

static size_t count_of(const ffd_lattice *lattice)
{
    size_t size[3];
    ffd_lattice_get_size(lattice, size);
    return size[0] * size[1] * size[2];
}

static void refine_raises_degrees(void **state)
{
    answer a = {.lattice = NULL};
    ffd_lattice *made = NULL;
    ffd_refine_desc desc;
    (void)state;
    begin(&a, REFINE);
    ffd_refine_desc_init(&desc, sizeof desc);
    desc.degree[0] = desc.degree[1] = 4;
    desc.degree[2] = 3;
    assert_int_equal(ffd_lattice_refine(a.lattice, &desc, &made, NULL), FFD_OK);
    check_numbers(&a, "rest_points", ffd_lattice_get_points(made, FFD_VOLUME_REST), 3 * count_of(made));
    check_numbers(&a, "deformed_points", ffd_lattice_get_points(made, FFD_VOLUME_DEFORMED),
                  3 * count_of(made));
    end(&a, made);
}

static void blend_mixes_weights_too(void **state)
{
    answer a = {.lattice = NULL};
    ffd_lattice *made = NULL;
    (void)state;
    begin(&a, SET);
    ffd_lattice *other = lattice_of(&a.tree, "other");
    assert_int_equal(ffd_lattice_blend(a.lattice, other, 0.25, &made, NULL), FFD_OK);
    check_numbers(&a, "offsets", ffd_lattice_get_offsets(made), 3 * count_of(made));
    check_numbers(&a, "weights", ffd_lattice_get_weights(made, FFD_VOLUME_REST), count_of(made));
    check_numbers(&a, "deformed_weights", ffd_lattice_get_weights(made, FFD_VOLUME_DEFORMED), count_of(made));
    ffd_lattice_destroy(&other);
    end(&a, made);
}

static void seal_holds_the_first_layers(void **state)
{
    answer a = {.lattice = NULL};
    ffd_lattice *made = NULL;
    (void)state;
    begin(&a, SEAM);
    assert_int_equal(ffd_lattice_seal(a.lattice, 1, 1, &made, NULL), FFD_OK);
    check_numbers(&a, "deformed_points_clamped", ffd_lattice_get_points(made, FFD_VOLUME_DEFORMED),
                  3 * count_of(made));
    end(&a, made);
}

static void jitter_gives_these_bits(void **state)
{
    answer a = {.lattice = NULL};
    (void)state;
    begin(&a, JITTER);
    assert_true(a.tolerance == 0);
    check_numbers(&a, "offsets", ffd_lattice_get_offsets(a.lattice), 3 * count_of(a.lattice));
    end(&a, NULL);
}

int main(int count, char **arguments)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(refine_raises_degrees),
        cmocka_unit_test(blend_mixes_weights_too),
        cmocka_unit_test(seal_holds_the_first_layers),
        cmocka_unit_test(jitter_gives_these_bits),
    };
    case_files = arguments + 1;
    return count == KINDS + 1 ? cmocka_run_group_tests(tests, NULL, NULL) : 2;
}
