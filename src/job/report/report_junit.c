/* report_junit.c - reports and comparisons of folders as JUnit XML, which build servers show. */
#include "base/arithmetic.h"
#include "base/file/input.h"
#include "base/file/mapping.h"
#include "base/file/output.h"
#include "base/memory/memory.h"
#include "base/text/number.h"
#include "job/report/report.h"
#include "job/report/report_file.h"
#include "job/report/report_reader.h"
#include "json/json_chars.h"
#include "json/json_parse.h"
#include <ffd/job.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* The character that stands for what XML cannot hold. */
#define REPLACEMENT 0xfffd

/* Whether XML 1.0 has a character. */
static bool is_in_xml(uint32_t code)
{
    return code == '\t' || code == '\n' || code == '\r' || (code >= 0x20 && code < 0xd800) ||
           (code >= 0xe000 && code != 0xfffe && code != 0xffff);
}

static void put_char(byte_buffer *xml, uint32_t code)
{
    char bytes[4];
    switch (code) {
    case '&':
        ffd_buffer_text(xml, "&amp;");
        return;
    case '<':
        ffd_buffer_text(xml, "&lt;");
        return;
    case '>':
        ffd_buffer_text(xml, "&gt;");
        return;
    case '"':
        ffd_buffer_text(xml, "&quot;");
        return;
    case '\t':
    case '\n':
    case '\r': /* in an attribute they would become blanks */
        ffd_buffer_format(xml, "&#%" PRIu32 ";", code);
        return;
    default:
        ffd_buffer_append(xml, bytes, ffd_utf8_write(is_in_xml(code) ? code : REPLACEMENT, bytes));
    }
}

/* Appends ` NAME="TEXT"`. What is not UTF-8 or not a character of XML becomes the replacement character. */
static void put_attribute(byte_buffer *xml, const char *name, const char *text)
{
    const char *const last = text + strlen(text);
    ffd_buffer_format(xml, " %s=\"", name);
    while (text < last) {
        uint32_t code = REPLACEMENT;
        const char *const next = ffd_utf8_read(text, last, &code);
        put_char(xml, next ? code : REPLACEMENT);
        text = next ? next : text + 1;
    }
    ffd_buffer_text(xml, "\"");
}

/* How a case ended. */
typedef enum case_outcome { CASE_PASSED, CASE_FAILED, CASE_BROKEN, CASE_SKIPPED } case_outcome;
#define OUTCOMES 4

/* A suite or all of them: the text of what is in it, and numbers of cases. */
typedef struct junit_suite {
    byte_buffer cases;
    uint64_t counts[OUTCOMES]; /* by case_outcome */
    double seconds;
} junit_suite;

/* No time is longer, in seconds. */
#define LONGEST 1e9

typedef struct junit_case {
    const char *name, *group, *type, *message; /* type, message: of a failure or an error */
    case_outcome outcome;
    double seconds; /* negative: not known */
} junit_case;

static void put_time(byte_buffer *xml, double seconds)
{
    ffd_buffer_format(xml, " time=\"%s\"", ffd_number_decimals(minimum_number(seconds, LONGEST), 6).text);
}

static void add_case(junit_suite *suite, const junit_case *c)
{
    static const char *const elements[OUTCOMES] = {NULL, "failure", "error", "skipped"};
    byte_buffer *const xml = &suite->cases;
    suite->counts[c->outcome]++;
    ffd_buffer_text(xml, "    <testcase");
    put_attribute(xml, "name", c->name);
    put_attribute(xml, "classname", c->group);
    if (c->seconds >= 0) {
        suite->seconds += c->seconds;
        put_time(xml, c->seconds);
    }
    if (c->outcome == CASE_PASSED) {
        ffd_buffer_text(xml, "/>\n");
        return;
    }
    ffd_buffer_format(xml, ">\n      <%s", elements[c->outcome]);
    if (c->outcome != CASE_SKIPPED)
        put_attribute(xml, "type", c->type);
    if (c->message)
        put_attribute(xml, "message", c->message);
    ffd_buffer_text(xml, "/>\n    </testcase>\n");
}

static void put_counts(byte_buffer *xml, const junit_suite *suite)
{
    uint64_t all = 0;
    for (int i = 0; i < OUTCOMES; i++)
        all += suite->counts[i];
    ffd_buffer_format(
        xml, " tests=\"%" PRIu64 "\" failures=\"%" PRIu64 "\" errors=\"%" PRIu64 "\" skipped=\"%" PRIu64 "\"",
        all, suite->counts[CASE_FAILED], suite->counts[CASE_BROKEN], suite->counts[CASE_SKIPPED]);
    put_time(xml, suite->seconds);
}

/* Adds a suite to all of them. */
static void add_suite(junit_suite *all, const char *name, const junit_suite *suite)
{
    byte_buffer *const xml = &all->cases;
    ffd_buffer_text(xml, "  <testsuite");
    put_attribute(xml, "name", name);
    put_counts(xml, suite);
    ffd_buffer_text(xml, ">\n");
    ffd_buffer_append(xml, suite->cases.data, suite->cases.size);
    ffd_buffer_text(xml, "  </testsuite>\n");
    xml->failed = xml->failed || suite->cases.failed;
    all->seconds += suite->seconds;
    for (int i = 0; i < OUTCOMES; i++)
        all->counts[i] += suite->counts[i];
}

/* Returns a text, freed by the caller; NULL: it is none, or memory runs out, and with it the suite fails. */
static char *text_at(junit_suite *suite, const json_tree *tree, uint32_t value)
{
    if (value == JSON_NONE || tree->values[value].kind != JSON_STRING)
        return NULL;
    char *const text = ffd_json_tree_string(tree, value, NULL);
    suite->cases.failed = suite->cases.failed || !text;
    return text;
}

/* The same for a member. */
static char *text_of(junit_suite *suite, const json_tree *tree, uint32_t object, const char *key)
{
    return text_at(suite, tree, ffd_json_tree_member(tree, object, key));
}

/* Returns a number, or -1. */
static double number_of(const json_tree *tree, uint32_t object, const char *key)
{
    double number;
    const uint32_t value = ffd_json_tree_member(tree, object, key);
    return value != JSON_NONE && ffd_json_tree_number(tree, value, &number) ? number : -1;
}

/* Sums the times of a job; -1: they are not known. */
static double seconds_of(const json_tree *tree)
{
    const uint32_t seconds = ffd_json_tree_member(tree, 0, "seconds");
    double sum = 0, number;
    if (seconds == JSON_NONE || tree->values[seconds].kind != JSON_OBJECT)
        return -1;
    for (uint32_t v = ffd_json_tree_first(tree, seconds); v != JSON_NONE; v = ffd_json_tree_after(tree, v))
        if (ffd_json_tree_number(tree, v, &number) && number > 0)
            sum += number;
    return sum;
}

/* Adds a job. Jobs of one name are told apart by their lines, or by their rows. */
static void add_job(junit_suite *suite, const json_tree *tree)
{
    char *const input = text_of(suite, tree, 0, "input"), *const output = text_of(suite, tree, 0, "output"),
                *const error = text_of(suite, tree, 0, "error"),
                *const status = text_of(suite, tree, 0, "status");
    const double code = number_of(tree, 0, "exit"), line = number_of(tree, 0, "line"),
                 row = number_of(tree, 0, "row");
    byte_buffer name = {0};
    char type[20];
    ffd_buffer_text(&name, output ? output : input ? input : "line");
    if (!output && row >= 0)
        ffd_buffer_format(&name, " row %.0f", row);
    else if (!output && line >= 0)
        ffd_buffer_format(&name, input ? " line %.0f" : " %.0f", line);
    char *const shown = ffd_buffer_finish(&name);
    snprintf(type, sizeof type, "exit %.0f", code);
    if (shown)
        add_case(suite, &(junit_case){.name = shown,
                                      .group = input ? input : "no input",
                                      .type = type,
                                      .message = error,
                                      .outcome = status && strcmp(status, "skipped") == 0 ? CASE_SKIPPED
                                                 : code == 0                              ? CASE_PASSED
                                                 : code == 1                              ? CASE_FAILED
                                                                                          : CASE_BROKEN,
                                      .seconds = seconds_of(tree)});
    suite->cases.failed = suite->cases.failed || !shown;
    ffd_free(input);
    ffd_free(output);
    ffd_free(error);
    ffd_free(status);
    ffd_free(shown);
}

static ffd_status add_report(junit_suite *suite, const char *path, const char *name, const file_input *file,
                             ffd_error *error)
{
    report_reader reader;
    report_entry_text entry;
    TRY(ffd_report_reader_open(&reader, name, ffd_report_has_lines(path), file->data, file->size, error));
    while (ffd_report_reader_next(&reader, &entry)) {
        const json_input input = {.text = entry.bytes, .size = entry.size, .name = name};
        json_tree tree;
        TRY(ffd_json_parse(&input, &tree, error));
        add_job(suite, &tree);
        ffd_json_tree_free(&tree);
    }
    return FFD_OK;
}

/* Adds a mesh of two folders that was compared. */
static void add_pair(junit_suite *suite, const json_tree *tree, uint32_t file, const char *group)
{
    const uint32_t equal = ffd_json_tree_member(tree, file, "equal"),
                   first = ffd_json_tree_member(tree, file, "first");
    char *const name = text_of(suite, tree, file, "name"), *const error = text_of(suite, tree, file, "error"),
                *const what = text_of(suite, tree, first, "message");
    const bool is_equal = equal != JSON_NONE && tree->values[equal].kind == JSON_TRUE;
    add_case(suite, &(junit_case){.name = name ? name : group,
                                  .group = group,
                                  .type = error ? "error" : "difference",
                                  .message = error ? error : what,
                                  .outcome = error      ? CASE_BROKEN
                                             : is_equal ? CASE_PASSED
                                                        : CASE_FAILED,
                                  .seconds = -1});
    ffd_free(name);
    ffd_free(error);
    ffd_free(what);
}

/* Adds the meshes that are in one folder only. */
static void add_single(junit_suite *suite, const json_tree *tree, const char *key, const char *message,
                       const char *group)
{
    const uint32_t names = ffd_json_tree_member(tree, 0, key);
    for (uint32_t v = ffd_json_tree_first(tree, names); v != JSON_NONE; v = ffd_json_tree_after(tree, v)) {
        char *const name = text_at(suite, tree, v);
        add_case(suite, &(junit_case){.name = name ? name : "?",
                                      .group = group,
                                      .type = "difference",
                                      .message = message,
                                      .outcome = CASE_FAILED,
                                      .seconds = -1});
        ffd_free(name);
    }
}

static ffd_status add_comparison(junit_suite *suite, const char *name, const file_input *file,
                                 ffd_error *error)
{
    const json_input input = {.text = (const char *)file->data, .size = file->size, .name = name};
    json_tree tree;
    TRY(ffd_json_parse(&input, &tree, error));
    const uint32_t files = ffd_json_tree_member(&tree, 0, "files");
    char *const group = text_of(suite, &tree, 0, "b");
    const char *const shown = group ? group : name;
    if (files == JSON_NONE)
        add_pair(suite, &tree, 0, shown);
    for (uint32_t v = ffd_json_tree_first(&tree, files); v != JSON_NONE; v = ffd_json_tree_after(&tree, v))
        add_pair(suite, &tree, v, shown);
    add_single(suite, &tree, "only_a", "only in a", shown);
    add_single(suite, &tree, "only_b", "only in b", shown);
    ffd_free(group);
    ffd_json_tree_free(&tree);
    return FFD_OK;
}

/* Whether the first member "format" of a text says that it is a comparison. */
static bool is_comparison(const file_input *file)
{
    static const char key[] = "\"format\"", value[] = "\"ffd-comparison\"";
    const char *at = (const char *)file->data, *const last = at + file->size;
    while (last - at >= (ptrdiff_t)sizeof key && memcmp(at, key, sizeof key - 1) != 0)
        at++;
    at += last - at >= (ptrdiff_t)sizeof key ? sizeof key - 1 : 0;
    while (at < last && strchr(" \t\r\n:", *at) && *at)
        at++;
    return last - at >= (ptrdiff_t)sizeof value - 1 && memcmp(at, value, sizeof value - 1) == 0;
}

static ffd_status add_file(junit_suite *all, const char *path, ffd_error *error)
{
    const char *const name = ffd_file_display_name(path);
    file_input file;
    junit_suite suite = {0};
    TRY(ffd_file_map(path, &file, error));
    const ffd_status status = is_comparison(&file) ? add_comparison(&suite, name, &file, error)
                                                   : add_report(&suite, path, name, &file, error);
    if (!status)
        add_suite(all, name, &suite);
    ffd_buffer_free(&suite.cases);
    ffd_file_unload(&file);
    return status;
}

static ffd_status add_files(junit_suite *all, const char *const *reports, size_t count, ffd_error *error)
{
    for (size_t i = 0; i < count; i++)
        TRY(add_file(all, reports[i], error));
    return FFD_OK;
}

static ffd_status write_all(const junit_suite *all, const char *path, bool force, ffd_error *error)
{
    byte_buffer head = {0};
    file_output *output = NULL;
    ffd_status status;
    ffd_buffer_text(&head, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"ffd\"");
    put_counts(&head, all);
    ffd_buffer_text(&head, ">\n");
    TRY_END(all->cases.failed || head.failed ? ffd_fail_memory(error) : FFD_OK);
    TRY_END(ffd_output_create(&output, error));
    TRY_END(ffd_output_begin(output, path, force, error));
    TRY_END(ffd_output_write(output, head.data, head.size, error));
    TRY_END(ffd_output_write(output, all->cases.data, all->cases.size, error));
    TRY_END(ffd_output_write(output, "</testsuites>\n", strlen("</testsuites>\n"), error));
    TRY_END(ffd_output_commit(output, error));
end:
    ffd_output_destroy(&output);
    ffd_buffer_free(&head);
    return status;
}

ffd_status ffd_report_junit_run(const char *const *reports, size_t count, const char *output, bool force,
                                ffd_error *error)
{
    junit_suite all = {0};
    if (count == 0)
        return ffd_fail(error, FFD_E_ARGUMENT, "no report is given");
    for (size_t i = 0; i < count; i++)
        if (!ffd_output_is_stream(output) && ffd_file_same(output, reports[i]))
            return ffd_fail_file(error, FFD_E_EXISTS, output, "is an input of this command");
    TRY(ffd_output_check(output, force, error));
    const unsigned losses = ffd_mapping_losses();
    ffd_status status;
    TRY_END(ffd_mapping_judge(losses, add_files(&all, reports, count, error), error));
    TRY_END(write_all(&all, output, force, error));
end:
    ffd_buffer_free(&all.cases);
    return status;
}
