/* test_locale.c - numbers in outputs in a locale with a decimal comma, which a program may have set: as in
   the C locale. Skipped where the system cannot make such a locale. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/job_description.h"
#include "../support/test_folder.h"
#include "base/file/output.h"
#include "base/text/number.h"
#include "view/index.h"
#include <ffd/job.h>
#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define COMMA "de_DE.UTF-8"

static bool has_comma;

/* Makes the locale in the folder. */
static int set_up(void **state)
{
    char command[300], number[10];
    if (make_folder(state))
        return -1;
    snprintf(command, sizeof command, "localedef -i de_DE -f UTF-8 '%s/" COMMA "' > /dev/null 2>&1", folder);
    const bool is_made = system(command) == 0;
    setenv("LOCPATH", folder, 1);
    if (is_made && setlocale(LC_ALL, COMMA)) {
        snprintf(number, sizeof number, "%.1f", 0.5);
        has_comma = strcmp(number, "0,5") == 0;
    }
    setlocale(LC_ALL, "C");
    put_text("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
    put_text("l.json",
             "{\"format\": \"ffd-lattice\", \"version\": 1, \"size\": [4, 4, 4], \"rest\": {\"box\": "
             "{\"min\": [-1, -1, -1], \"max\": [2, 2, 2]}}, \"moves\": [{\"at\": [1, 1, 1], \"by\": [0, 0, "
             "0.5]}]}");
    return 0;
}

static void numbers_have_points(void **state)
{
    static const double values[] = {0, -0.0, 0.5, -1234.5678, 1e-9, 12345678, 1.5e300, 1e23, HUGE_VAL};
    (void)state;
    if (!has_comma)
        skip();
    for (size_t i = 0; i < sizeof values / sizeof *values; i++)
        for (int digits = 0; digits < 7; digits++) {
            char general[40], fixed[400];
            setlocale(LC_ALL, "C");
            snprintf(general, sizeof general, "%.*g", digits, values[i]);
            snprintf(fixed, sizeof fixed, "%.*f", digits, values[i]);
            setlocale(LC_ALL, COMMA);
            assert_string_equal(ffd_number_digits(values[i], digits).text, general);
            if (strlen(fixed) <= FFD_NUMBER_CAPACITY)
                assert_string_equal(ffd_number_decimals(values[i], digits).text, fixed);
        }
    setlocale(LC_ALL, "C");
}

/* Returns the bytes of a file in the folder, until the next call. */
static const char *bytes_of(const char *name, size_t *size)
{
    static char bytes[2000000];
    FILE *const file = fopen(in_folder(name), "rb");
    assert_non_null(file);
    *size = fread(bytes, 1, sizeof bytes - 1, file);
    assert_true(*size > 0 && *size < sizeof bytes - 1);
    bytes[*size] = 0;
    fclose(file);
    return bytes;
}

/* A picture or a page. */
static void write_view(const char *name)
{
    char mesh[200], lattice[200];
    strcpy(mesh, in_folder("m.obj"));
    strcpy(lattice, in_folder("l.json"));
    const ffd_lattice_source source = {.path = lattice};
    ffd_deform_desc job = describe_job(mesh, NULL, &source);
    ffd_view_desc view;
    ffd_job_result result = {.struct_size = sizeof result};
    ffd_view_desc_init(&view, sizeof view);
    view.job = &job;
    view.output = in_folder(name);
    view.force = true;
    assert_int_equal(ffd_view_run(&view, &result, NULL), FFD_OK);
}

static void write_junit(const char *name)
{
    put_text("r.jsonl",
             "{\"input\": \"a\", \"output\": null, \"status\": \"ok\", \"exit\": 0, \"error\": null, "
             "\"seconds\": {\"read\": 61.25, \"write\": 0.000002}}\n");
    const char *const reports[] = {in_folder("r.jsonl")};
    assert_int_equal(ffd_report_junit_run(reports, 1, in_folder(name), true, NULL), FFD_OK);
}

static void write_index(const char *name)
{
    static const ffd_job_result figures[] = {
        {.displacement = {.max = 0.25},
         .folds = {.is_known = true, .cells = 8, .min_det = 0.75},
         .tear = {.is_known = true, .edges = 2, .largest = 1.5}},
        {.folds = {.is_known = true, .verdict = FFD_FOLDS_SOME, .folded_cells = 1, .min_det = -0.5}}};
    view_index index;
    file_output *output = NULL;
    assert_int_equal(ffd_output_create(&output, NULL), FFD_OK);
    assert_int_equal(ffd_output_begin(output, in_folder(name), true, NULL), FFD_OK);
    assert_int_equal(ffd_index_begin(&index, "m", output, NULL), FFD_OK);
    for (int i = 0; i < 2; i++)
        assert_int_equal(
            ffd_index_add(&index, &(index_row){.line = 1, .state = INDEX_DONE, .figures = &figures[i]}, NULL),
            FFD_OK);
    assert_int_equal(ffd_index_end(&index, NULL), FFD_OK);
    ffd_index_free(&index);
    assert_int_equal(ffd_output_commit(output, NULL), FFD_OK);
    ffd_output_destroy(&output);
}

static void outputs_have_the_same_bytes(void **state)
{
    static const struct {
        const char *name;
        void (*write)(const char *name);
        const char *part; /* that is in it */
    } outputs[] = {{"p.png", write_view, NULL},
                   {"p.html", write_view, NULL},
                   {"i.html", write_index, "step to 1.5<"},
                   {"j.xml", write_junit, "time=\"61.250002\""}};
    (void)state;
    if (!has_comma)
        skip();
    for (size_t i = 0; i < sizeof outputs / sizeof *outputs; i++) {
        size_t size, again;
        outputs[i].write(outputs[i].name);
        const char *const bytes = bytes_of(outputs[i].name, &size);
        assert_true(!outputs[i].part || strstr(bytes, outputs[i].part));
        char *const first = malloc(size);
        assert_non_null(first);
        memcpy(first, bytes, size);
        setlocale(LC_ALL, COMMA);
        outputs[i].write(outputs[i].name);
        setlocale(LC_ALL, "C");
        const char *const second = bytes_of(outputs[i].name, &again);
        if (again != size || memcmp(first, second, size) != 0)
            fail_msg("%s differs", outputs[i].name);
        free(first);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(numbers_have_points),
                                       cmocka_unit_test(outputs_have_the_same_bytes)};
    return cmocka_run_group_tests(tests, set_up, remove_folder);
}
