/* test_figures.c - the table of figures: what is written to a report is read back, and joined as each row
 * says. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "base/memory/memory.h"
#include "job/figures/figure_values.h"
#include "job/figures/figures.h"
#include "job/report/report.h"
#include "job/report/report_figures.h"
#include "json/json_parse.h"
#include <ffd/job.h>
#include <math.h>
#include <string.h>

static void a_figure_has_the_type_of_its_total(void **state)
{
    (void)state;
    for (const figure *f = ffd_figures; f < ffd_figures + ffd_figure_count; f++)
        if (*f->name && f->total.type && f->total.type != f->result.type)
            fail_msg("%s is not of the type that the pass has", f->name);
}

/* Whether values of a type can be joined so. */
static bool can_join(figure_type type, figure_join how)
{
    switch (how) {
    case JOIN_NONE:
        return true;
    case JOIN_SUM:
        return type == FIGURE_COUNT || type == FIGURE_NUMBER || type == FIGURE_STATUSES;
    case JOIN_ANY:
    case JOIN_ALL:
        return type == FIGURE_FLAG;
    case JOIN_HIGHEST:
    case JOIN_ONLY:
        return type == FIGURE_NUMBER;
    case JOIN_LARGEST:
    case JOIN_LEAST:
    case JOIN_WITH:
        return type == FIGURE_COUNT || type == FIGURE_NUMBER;
    case JOIN_BOUNDS:
        return type == FIGURE_BOX;
    case JOIN_SAME:
        return type == FIGURE_COUNT || type == FIGURE_NUMBER || type == FIGURE_BOX;
    case JOIN_FEWEST:
        return type == FIGURE_COUNT || type == FIGURE_STATUSES;
    case JOIN_BEHIND:
        return type == FIGURE_BEHIND;
    default:
        return type == FIGURE_GROUP;
    }
}

static void a_figure_is_joined_as_its_type_can_be(void **state)
{
    (void)state;
    for (const figure *f = ffd_figures; f < ffd_figures + ffd_figure_count; f++) {
        const char *const name = *f->name ? f->name : "a figure of the pass";
        if (!can_join(f->total.type, f->tiles))
            fail_msg("%s cannot be joined so from tiles", name);
        if (!can_join(f->result.type, f->targets))
            fail_msg("%s cannot be joined so from morph targets", name);
    }
}

/* Another value in each. */
static void fill(ffd_job_result *result)
{
    uint64_t next = 1;
    ffd_result_clear(result);
    for (const figure *f = ffd_figures; f < ffd_figures + ffd_figure_count && (*f->name || !f->total.type);
         f++) {
        void *const value = (char *)result + f->result.at;
        if (f->result.type == FIGURE_FLAG)
            *(bool *)value = true;
        else if (f->result.type == FIGURE_COUNT && strcmp(f->name, "flaw_count") != 0)
            *(uint64_t *)value = next++;
        else if (f->result.type == FIGURE_NUMBER)
            *(double *)value = (double)next++ / 16;
        for (int s = 0; s < FFD_VERTEX_STATUS_COUNT && f->result.type == FIGURE_STATUSES; s++)
            ((uint64_t *)value)[s] = next++;
    }
    result->folds.is_known = result->rig.is_there = true;
    result->folds.verdict = FFD_FOLDS_UNKNOWN;
    result->folds.relative_to = FFD_FOLDS_TO_PLACE;
    result->seam = (ffd_seam_figures){true, FFD_SEAM_C2, 3, {1, 0, 63}};
}

/* Writes a result, and reads it back. */
static void copy(const ffd_job_result *result, ffd_job_result *read)
{
    ffd_error error;
    json_tree tree;
    byte_buffer text = {0};
    ffd_report_figures(result, &text);
    const json_input input = {.text = text.data, .size = text.size, .name = "the report"};
    assert_int_equal(ffd_json_parse(&input, &tree, &error), FFD_OK);
    ffd_figures_read(&tree, 0, read);
    ffd_json_tree_free(&tree);
    ffd_buffer_free(&text);
}

static void a_report_is_read_back(void **state)
{
    (void)state;
    ffd_job_result result, read;
    fill(&result);
    copy(&result, &read);
    size_t compared = 0;
    for (const figure *f = ffd_figures; f < ffd_figures + ffd_figure_count; f++) {
        const size_t size = f->result.type == FIGURE_STATUSES ? sizeof result.counts
                            : f->result.type == FIGURE_COUNT || f->result.type == FIGURE_NUMBER ? 8
                                                                                                : 0;
        if (!*f->name || f->is_held_back || strncmp(f->name, "folds.witness", 13) == 0)
            continue;
        compared += size > 0;
        if (memcmp((char *)&result + f->result.at, (char *)&read + f->result.at, size) != 0)
            fail_msg("%s is another after it was read", f->name);
    }
    assert_true(compared > 50);
    assert_true(read.folds.is_known && read.tear.is_known && read.det.is_known && read.edges.is_known);
    assert_true(read.has_flipped && read.rig.is_there && !read.folds.witness.is_there);
    assert_int_equal(read.folds.verdict, FFD_FOLDS_UNKNOWN);
    assert_int_equal(read.folds.relative_to, FFD_FOLDS_TO_PLACE);
    assert_true(read.seam.is_there);
    assert_int_equal(read.seam.continuity, FFD_SEAM_C2);
    assert_int_equal(read.seam.count, 3);
    assert_memory_equal(read.seam.faces, result.seam.faces, sizeof read.seam.faces);
}

static void what_is_not_known_is_null_or_absent(void **state)
{
    (void)state;
    ffd_job_result result, read;
    ffd_result_clear(&result);
    copy(&result, &read);
    assert_false(read.folds.is_known || read.tear.is_known || read.det.is_known || read.edges.is_known);
    assert_false(read.has_flipped || read.rig.is_there);
    assert_true(isnan(read.volume.before) && isnan(read.tear.largest) && isnan(read.precision.side));
    assert_true(read.displacement.max == 0); /* every entry has it */
}

static void the_text_has_a_line_for_what_is_known(void **state)
{
    (void)state;
    ffd_error error;
    char *text = NULL;
    ffd_job_result result;
    ffd_result_clear(&result);
    assert_int_equal(ffd_job_result_text(&result, NULL, &text, &error), FFD_OK);
    assert_string_equal(text,
                        "  vertices       0\n  moved          0, by 0 at most\n  area           not known\n"
                        "  volume         not known\n");
    ffd_free(text);
    result.counts[FFD_VERTEX_SINGULAR] = result.vertices = 2;
    result.tear.is_known = result.folds.is_known = result.folds.witness.is_there = true;
    result.folds.witness.lattice = 1;
    result.folds.verdict = FFD_FOLDS_SOME;
    assert_int_equal(ffd_job_result_text(&result, NULL, &text, &error), FFD_OK);
    assert_non_null(strstr(text, "  vertices       2: 2 singular\n"));
    assert_non_null(strstr(text, "  torn edges     0\n"));
    assert_non_null(strstr(text, "det J is 0 (lattice 2)\n"));
    assert_null(strstr(text, "flipped"));
    ffd_free(text);
    result.struct_size = 0;
    assert_int_equal(ffd_job_result_text(&result, NULL, &text, &error), FFD_E_ARGUMENT);
    assert_null(text);
}

static void tiles_are_joined(void **state)
{
    (void)state;
    pass_totals all, tiles[3];
    ffd_totals_clear(&all);
    assert_true(isinf(all.det_outside) && all.first_outside == UINT64_MAX && all.det_max < all.det_min);
    for (int i = 0; i < 3; i++) {
        ffd_totals_clear(&tiles[i]);
        tiles[i].moved = 10;
        tiles[i].counts[FFD_VERTEX_MULTIPLE] = (uint64_t)i;
        tiles[i].det_outside = i == 0 ? 3 : -1; /* the second and the third are equal */
        tiles[i].first_det_outside = 100 + (uint64_t)i;
        tiles[i].det_max = -5 + i;
        tiles[i].evaluations_max = i == 1 ? 7 : 2;
    }
    tiles[1].misses.is_least = true;
    tiles[2].first_missed = 5;
    tiles[2].missed_by = 0.25;
    for (int i = 0; i < 3; i++)
        ffd_totals_join(&tiles[i], &all);
    assert_int_equal(all.moved, 30);
    assert_int_equal(all.counts[FFD_VERTEX_MULTIPLE], 3);
    assert_true(all.det_outside == -1 && all.first_det_outside == 101); /* the first of equal ones */
    assert_true(all.det_max == -3 && isinf(all.det_min));
    assert_int_equal(all.evaluations_max, 7);
    assert_true(all.misses.is_least && all.first_missed == 5 && all.missed_by == 0.25);
}

static void targets_are_joined(void **state)
{
    (void)state;
    ffd_job_result all, targets[2];
    ffd_result_clear(&all);
    for (int k = 0; k < 2; k++) {
        ffd_result_clear(&targets[k]);
        targets[k].vertices = 8;
        targets[k].counts[FFD_VERTEX_INSIDE] = k == 0 ? 6 : 8;
        targets[k].hidden = k == 0 ? 1 : 0;
        targets[k].tear.is_known = true;
        targets[k].tear.edges = k == 0 ? 9 : 2;
        targets[k].tear.largest = k == 0 ? 0.5 : 2;
        strcpy(targets[k].tear.part, k == 0 ? "node:a" : "node:b");
        targets[k].edges.is_known = k == 0;
        targets[k].folds.is_known = true;
        targets[k].folds.cells = 3;
        targets[k].folds.min_det = k == 0 ? 0.5 : -1;
        targets[k].folds.witness.is_there = k == 1;
        targets[k].area = (ffd_before_after){4, 5};
    }
    targets[1].det.is_known = true;
    targets[1].det.min = targets[1].det.max = -2;
    targets[1].det.outside = 0.125;
    targets[1].det.outside_vertex = 6;
    targets[0].behind[FFD_BEHIND_LIGHT].count = 2;
    ffd_results_join(targets, 2, &all);
    assert_true(all.vertices == 8 && all.counts[FFD_VERTEX_INSIDE] == 6 && all.hidden == 1);
    assert_true(all.tear.is_known && all.tear.edges == 2);
    assert_string_equal(all.tear.part, "node:b");
    assert_false(all.edges.is_known);
    assert_true(all.folds.is_known && all.folds.cells == 6 && all.folds.min_det == -1);
    assert_true(all.folds.witness.is_there && all.folds.witness.lattice == 1);
    assert_true(all.area.before == 4 && isnan(all.area.after));
    assert_true(all.det.is_known && all.det.min == -2 && all.det.max == -2);
    assert_true(all.det.outside == 0.125 && all.det.outside_vertex == 6);
    assert_int_equal(all.behind[FFD_BEHIND_LIGHT].count, 2);
    ffd_result_clear(&all);
    ffd_results_join(targets, 1, &all);
    assert_true(all.area.after == 5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_figure_has_the_type_of_its_total),
        cmocka_unit_test(a_figure_is_joined_as_its_type_can_be),
        cmocka_unit_test(a_report_is_read_back),
        cmocka_unit_test(what_is_not_known_is_null_or_absent),
        cmocka_unit_test(the_text_has_a_line_for_what_is_known),
        cmocka_unit_test(tiles_are_joined),
        cmocka_unit_test(targets_are_joined),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
