/* test_view_index.c - the page that compares the jobs of a batch: text from files, sort keys, counts, the
   Content-Security-Policy. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/test_folder.h"
#include "base/memory/memory.h"
#include "view/index.h"
#include "view/page_text.h"
#include <math.h>

/* Makes a page with these rows, freed by the caller. */
static char *page_of(const char *name, const index_row *rows, size_t count)
{
    view_index index;
    file_output *output = NULL;
    ffd_error error;
    assert_int_equal(ffd_output_create(&output, &error), FFD_OK);
    assert_int_equal(ffd_output_begin(output, in_folder("index.html"), true, &error), FFD_OK);
    assert_int_equal(ffd_index_begin(&index, name, output, &error), FFD_OK);
    for (size_t i = 0; i < count; i++)
        assert_int_equal(ffd_index_add(&index, &rows[i], &error), FFD_OK);
    assert_int_equal(ffd_index_end(&index, &error), FFD_OK);
    ffd_index_free(&index);
    assert_int_equal(ffd_output_commit(output, &error), FFD_OK);
    ffd_output_destroy(&output);
    FILE *const file = fopen(in_folder("index.html"), "rb");
    assert_non_null(file);
    static char text[40000];
    text[fread(text, 1, sizeof text - 1, file)] = 0;
    fclose(file);
    return text;
}

static void expect(const char *page, const char *part)
{
    if (!strstr(page, part))
        fail_msg("\"%s\" is not in the page", part);
}

static const ffd_job_result figures = {.displacement = {.max = 0.1},
                                       .folds = {.is_known = true, .cells = 8, .min_det = 0.75},
                                       .tear = {.is_known = true},
                                       .has_flipped = true};

static const index_row plain = {.line = 7,
                                .input = "a.obj",
                                .output = "o/a.obj",
                                .picture = "o/a.obj.png",
                                .settings = "LIFT=0.5",
                                .state = INDEX_DONE,
                                .figures = &figures};

static void rows_have_keys(void **state)
{
    (void)state;
    index_row rows[] = {plain, plain, plain};
    ffd_job_result torn = figures, undecided = figures;
    torn.tear.edges = 3;
    torn.tear.largest = 0.25;
    torn.folds.verdict = FFD_FOLDS_SOME;
    torn.folds.folded_cells = 2;
    torn.folds.min_det = -1.5;
    torn.flipped_faces = 12;
    rows[1].figures = &torn;
    rows[1].state = INDEX_SKIPPED;
    undecided.folds.verdict = FFD_FOLDS_UNKNOWN;
    rows[2].figures = &undecided;
    rows[2].state = INDEX_FAILED;
    rows[2].error = "too <wild> & bent";
    const char *const page = page_of("m.jsonl", rows, 3);
    expect(page, "<title>m.jsonl</title>");
    expect(page, "data-key=\"7\">7</td>");
    expect(page, "data-key=\"0.1\">0.1</td>");
    expect(page, "data-key=\"0 0\">none</td>");
    expect(page, "data-key=\"1 0 -0.75\">none, det J at least 0.75</td>");
    expect(page, "data-key=\"1\">done</td>");
    expect(page, "data-key=\"3 0.25\" class=\"bad\">3, step to 0.25</td>");
    expect(page, "data-key=\"3 2 1.5\" class=\"bad\">2 cells, det J to -1.5</td>");
    expect(page, "data-key=\"12\" class=\"bad\">12</td>");
    expect(page, "data-key=\"0\">up to date</td>");
    expect(page, "data-key=\"2 0 -0.75\" class=\"warn\">undecided</td>");
    expect(page,
           "data-key=\"2\" class=\"bad\">failed: <span class=\"error\">too &lt;wild> &amp; bent</span></td>");
    expect(page, "<p id=\"counts\">3 jobs: 1 done, 1 up to date, 1 failed</p>");
    expect(page, "loading=\"lazy\" width=\"1600\" height=\"900\"");
    expect(page, "default-src 'none'; img-src 'self'; script-src 'sha256-");
}

static void what_is_not_known_has_no_key(void **state)
{
    (void)state;
    const ffd_job_result unknown = {.vertices = 3, .displacement = {.max = (double)NAN}};
    const index_row rows[] = {{.line = 1, .state = INDEX_FAILED},
                              {.line = 2, .state = INDEX_DONE, .figures = &unknown}};
    for (size_t i = 0; i < 2; i++) {
        const char *const page = page_of("", &rows[i], 1);
        expect(page, "<td class=\"picture none\">no picture</td>");
        expect(page, "Largest displacement\" data-key=\"\">not known</td>");
        expect(page, "Torn edges\" data-key=\"\">not known</td>");
        expect(page, "Folds\" data-key=\"\">not known</td>");
        expect(page, "Flipped faces\" data-key=\"\">not known</td>");
        expect(page, i == 0 ? "<p id=\"counts\">1 job: 0 done, 0 up to date, 1 failed</p>"
                            : "<p id=\"counts\">1 job: 1 done, 0 up to date, 0 failed</p>");
    }
}

static void names_are_text(void **state)
{
    (void)state;
    index_row row = plain;
    row.input = "<a>.obj\xff";
    row.output = "\"><script>\n";
    row.picture = "x:\"'<&#?% \xc3\xbc/a-b_c.d~.png";
    row.settings = "A=\"<b>&amp;\"";
    const char *const page = page_of("</title><script>", &row, 1);
    expect(page, "<title>&lt;/title>&lt;script></title>");
    expect(page, "from &lt;a>.obj\xef\xbf\xbd</span>");
    expect(page, "<span class=\"name\">\">&lt;script>\\n</span>");
    expect(page, "alt=\"before and after: &quot;>&lt;script>\\n\"");
    expect(page, "<a href=\"x%3A%22%27%3C%26%23%3F%25%20%C3%BC/a-b_c.d~.png\"><img src=\"x%3A%22%27%3C%26");
    expect(page, "class=\"settings\">A=\"&lt;b>&amp;amp;\"</td>");
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(rows_have_keys),
                                       cmocka_unit_test(what_is_not_known_has_no_key),
                                       cmocka_unit_test(names_are_text)};
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
