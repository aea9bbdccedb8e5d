/* test_report_junit.c - the times of ffd_report_junit_run in a locale with a decimal comma. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/test_folder.h"
#include <ffd/job.h>
#include <locale.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Makes a locale with a decimal comma in the folder, and sets it. Returns whether the system can. */
static bool set_comma(void)
{
    char command[300], number[10];
    snprintf(command, sizeof command, "localedef -i de_DE -f UTF-8 %s/de_DE.UTF-8 > /dev/null 2>&1", folder);
    const bool is_made = system(command) == 0;
    setenv("LOCPATH", folder, 1);
    const bool is_set = is_made && setlocale(LC_ALL, "de_DE.UTF-8");
    snprintf(number, sizeof number, "%.1f", 0.5);
    return is_set && strcmp(number, "0,5") == 0;
}

static void times_have_points_in_any_locale(void **state)
{
    static const char job[] =
        "{\"input\": \"a\", \"output\": null, \"status\": \"ok\", \"exit\": 0, \"error\": null, "
        "\"seconds\": {\"read\": 61.25, \"write\": 0.000002}}\n";
    char text[1000] = "";
    ffd_error error;
    (void)state;
    const bool has_comma = set_comma();
    put_text("r.jsonl", job);
    const char *const reports[] = {in_folder("r.jsonl")}, *const output = in_folder("o.xml");
    const ffd_status status = ffd_report_junit_run(reports, 1, output, false, &error);
    setlocale(LC_ALL, "C");
    assert_int_equal(status, FFD_OK);
    FILE *const file = fopen(output, "r");
    assert_non_null(file);
    assert_true(fread(text, 1, sizeof text - 1, file) > 0);
    fclose(file);
    size_t times = 0;
    for (const char *at = text; (at = strstr(at, "time=\"61.250002\"")) != NULL; at++)
        times++;
    assert_int_equal(times, 3);
    if (!has_comma)
        skip();
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(times_have_points_in_any_locale)};
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
