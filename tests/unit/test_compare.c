/* The comparison of two files in the library: tolerances, refusals, counts, the JSON. What the formats
   compare is in their own tests and in tests/cli/test_compare.py. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "../support/json_facts.h"
#include "../support/test_folder.h"
#include "mesh/difference.h"
#include <ffd/job.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static ffd_compare_desc description(void)
{
    ffd_compare_desc desc;
    ffd_compare_desc_init(&desc, sizeof desc);
    desc.a.path = in_folder("a.obj");
    desc.b.path = in_folder("b.obj");
    put_text("a.obj", "v 0 0 0\nv 3 4 0\nvn 0 0 1\n");
    put_text("b.obj", "v 0 0 0\nv 3 4 1\nvn 0 0.25 1\n");
    return desc;
}

static ffd_comparison run(const ffd_compare_desc *desc)
{
    ffd_comparison comparison = {.struct_size = sizeof comparison};
    ffd_error error = {0};
    memset(&comparison, 0xff, sizeof comparison); /* so that every member must be filled in */
    comparison.struct_size = sizeof comparison;
    if (ffd_compare_run(desc, &comparison, &error))
        fail_msg("%s", error.message);
    return comparison;
}

static void tolerances_decide_what_counts_as_different(void **state)
{
    (void)state;
    static const struct {
        double tolerance, direction_tolerance;
        bool relative;
        uint64_t positions, normals;
        double applied;
    } cases[] = {
        {0, 0, false, 1, 1, 0},
        {1, 0, false, 0, 1, 1},
        {0, 0.25, false, 1, 0, 0},
        {1, 0.25, false, 0, 0, 1},
        {0.2, 0, true, 0, 1, 1},
        {0.19, 0.25, true, 1, 0, 0.19 * 5},
        {INFINITY, 9, false, 0, 0, 0x1.fffffffffffffp1023},
        {0, 0, true, 1, 1, 0},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        ffd_compare_desc desc = description();
        desc.tolerance = cases[i].tolerance;
        desc.direction_tolerance = cases[i].direction_tolerance;
        desc.relative = cases[i].relative;
        const ffd_comparison c = run(&desc);
        assert_int_equal(c.counts[FFD_DIFFERENCE_POSITION], cases[i].positions);
        assert_int_equal(c.counts[FFD_DIFFERENCE_NORMAL], cases[i].normals);
        assert_int_equal(c.differences, cases[i].positions + cases[i].normals);
        assert_int_equal(c.equal, c.differences == 0);
        assert_true(c.complete && c.tolerance == cases[i].applied);
        assert_true(c.diagonal == (cases[i].relative ? 5 : 0));
        assert_true(c.position_difference_max == 1 && c.direction_difference_max == 0.25);
        assert_int_equal(c.positions_compared, 2);
    }
}

/* A source that asks for positions only does not hide normals from the comparison. */
static void only_positions_does_not_hide_normals(void **state)
{
    (void)state;
    ffd_compare_desc desc = description();
    desc.a.only_positions = desc.b.only_positions = true;
    assert_int_equal(run(&desc).counts[FFD_DIFFERENCE_NORMAL], 1);
}

static void wrong_descriptions_and_missing_files_are_refused(void **state)
{
    (void)state;
    ffd_comparison comparison = {.struct_size = sizeof comparison};
    const double wrong[] = {-1, -1e-300, NAN, -INFINITY};
    for (size_t i = 0; i < 2 * sizeof wrong / sizeof *wrong; i++) {
        ffd_compare_desc desc = description();
        *(i % 2 ? &desc.tolerance : &desc.direction_tolerance) = wrong[i / 2];
        assert_int_equal(ffd_compare_run(&desc, &comparison, NULL), FFD_E_ARGUMENT);
    }
    ffd_compare_desc desc = description();
    desc.struct_size += 8;
    assert_int_equal(ffd_compare_run(&desc, &comparison, NULL), FFD_E_ARGUMENT);
    desc = description();
    desc.b.path = NULL;
    assert_int_equal(ffd_compare_run(&desc, &comparison, NULL), FFD_E_ARGUMENT);
    desc.b.path = in_folder("none.obj");
    assert_int_equal(ffd_compare_run(&desc, &comparison, NULL), FFD_E_IO);
}

static void each_kind_has_its_own_name(void **state)
{
    (void)state;
    for (int i = 0; i < FFD_DIFFERENCE_KIND_COUNT; i++)
        for (int k = 0; k < i; k++)
            assert_string_not_equal(ffd_difference_kind_name((ffd_difference_kind)i),
                                    ffd_difference_kind_name((ffd_difference_kind)k));
    assert_null(ffd_difference_kind_name(FFD_DIFFERENCE_KIND_COUNT));
}

static void no_label(const void *context, char *text, size_t capacity)
{
    snprintf(text, capacity, "%s", (const char *)context);
}

/* The worst difference is of the first kind that differs; of equal ones the first counts. */
static void the_worst_is_the_first_largest_of_the_first_kind(void **state)
{
    (void)state;
    static const struct {
        ffd_difference_kind kind;
        double amount;
        const char *place, *worst;
    } steps[] = {
        {FFD_DIFFERENCE_TANGENT, 9, "t", "t: x of the tangent differs by 9"},
        {FFD_DIFFERENCE_NORMAL, 1, "n1", "n1: x of the normal differs by 1"},
        {FFD_DIFFERENCE_NORMAL, 2, "n2", "n2: x of the normal differs by 2"},
        {FFD_DIFFERENCE_TANGENT, 99, "t2", "n2: x of the normal differs by 2"},
        {FFD_DIFFERENCE_POSITION, 0.5, "p1", "p1: x differs by 0.5"},
        {FFD_DIFFERENCE_POSITION, 0.25, "p2", "p1: x differs by 0.5"},
        {FFD_DIFFERENCE_POSITION, 0.5, "p3", "p1: x differs by 0.5"},
        {FFD_DIFFERENCE_POSITION, INFINITY, "p4\n", "p4?: x: inf and 0"},
        {FFD_DIFFERENCE_POSITION, 1e300, "p5", "p4?: x: inf and 0"},
    };
    ffd_comparison c = {.struct_size = sizeof c};
    ffd_difference_begin(&c, 0, 0);
    for (size_t i = 0; i < sizeof steps / sizeof *steps; i++) {
        const double a[3] = {steps[i].amount}, b[3] = {0};
        ffd_difference_vector(&c, steps[i].kind, 3, a, b, no_label, steps[i].place);
        assert_string_equal(c.worst.text, steps[i].worst);
        assert_string_equal(c.first.text, steps[0].worst);
        assert_int_equal(c.differences, i + 1);
    }
}

static void the_json_names_files_and_worst_difference(void **state)
{
    (void)state;
    ffd_compare_desc desc = description();
    const ffd_comparison comparison = run(&desc);
    char *text = NULL;
    assert_int_equal(ffd_comparison_json(&comparison, "a\"\xff", "-", &text, NULL), FFD_OK);
    json_facts *const json = facts_read(text, strlen(text));
    assert_string_equal(text + strlen(text) - 2, "}\n");
    assert_text(json, facts_member(json, "a"), "a\"\xef\xbf\xbd");
    assert_text(json, facts_member(json, "worst.kind"), "position");
    assert_true(facts_number(json, facts_member(json, "worst.difference")) == 1);
    facts_free(json);
    ffd_free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tolerances_decide_what_counts_as_different),
        cmocka_unit_test(only_positions_does_not_hide_normals),
        cmocka_unit_test(wrong_descriptions_and_missing_files_are_refused),
        cmocka_unit_test(each_kind_has_its_own_name),
        cmocka_unit_test(the_worst_is_the_first_largest_of_the_first_kind),
        cmocka_unit_test(the_json_names_files_and_worst_difference),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
