/* fuzz_report.c - a report that is to be merged: it is taken if and only if jansson reads it too and it says
   what a report must; its entries are those that jansson finds. */
#include "base/fail.h"
#include "fuzz_target.h"
#include "job/report/report_reader.h"
#include "mutate_text.h"
#include "promise.h"
#include <jansson.h>
#include <string.h>

/* *too_large: it is refused for a number that no double can hold, which is JSON all the same. */
static json_t *read_json(const char *text, size_t size, bool *too_large)
{
    json_error_t error;
    json_t *const root =
        json_loadb(text, size, JSON_REJECT_DUPLICATES | JSON_ALLOW_NUL | JSON_DECODE_INT_AS_REAL, &error);
    *too_large = !root && json_error_code(&error) == json_error_numeric_overflow;
    return root;
}

static bool is_text_or_null(const json_t *value)
{
    return json_is_string(value) || json_is_null(value);
}

static bool is_entry(const json_t *entry)
{
    const char *const status = json_string_value(json_object_get(entry, "status"));
    const json_t *const code = json_object_get(entry, "exit");
    const double exit = json_number_value(code);
    return is_text_or_null(json_object_get(entry, "input")) &&
           is_text_or_null(json_object_get(entry, "output")) &&
           is_text_or_null(json_object_get(entry, "error")) && json_is_number(code) && exit >= 0 &&
           exit <= 7 && exit == (int)exit && status &&
           (!strcmp(status, "ok") || !strcmp(status, "failed") || !strcmp(status, "skipped"));
}

static bool is_report(const json_t *root)
{
    const char *const format = json_string_value(json_object_get(root, "format"));
    const json_t *const jobs = json_object_get(root, "jobs");
    bool right = json_object_size(root) == 3 && format && !strcmp(format, "ffd-report") &&
                 json_number_value(json_object_get(root, "version")) == 1 && json_is_array(jobs);
    for (size_t i = 0; right && i < json_array_size(jobs); i++)
        right = is_entry(json_array_get(jobs, i));
    return right;
}

/* Where word begins in text, or NULL. */
static const char *find(const char *text, size_t size, const char *word)
{
    const size_t length = strlen(word);
    for (size_t i = 0; i + length <= size; i++)
        if (memcmp(text + i, word, length) == 0)
            return text + i;
    return NULL;
}

/* Other ways to write a key or the version are refused: letters by escapes, 1.0. */
static bool is_plain(const char *text, size_t size)
{
    const char *const end = text + size;
    const char *c = find(text, size, "\"version\"");
    for (c = c ? c + 9 : end; c < end && strchr(" \t\r\n:", *c); c++)
        ;
    return end - c >= 2 && c[0] == '1' && !strchr(".eE", c[1]) && !find(text, size, "\\u");
}

static void check_entries(report_reader *reader, const json_t *root)
{
    const json_t *const jobs = json_object_get(root, "jobs");
    report_entry_text entry;
    size_t count = 0;
    bool too_large;
    for (; ffd_report_reader_next(reader, &entry); count++) {
        PROMISE(entry.bytes >= reader->begin && entry.bytes + entry.size <= reader->end,
                "an entry of other bytes");
        json_t *const own = read_json(entry.bytes, entry.size, &too_large);
        PROMISE(!root || json_equal(own, json_array_get(jobs, count)), "entry %zu is another one", count);
        json_decref(own);
    }
    PROMISE(!root || count == json_array_size(jobs), "%zu entries of %zu", count, json_array_size(jobs));
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const char *const text = size > 0 ? (const char *)data : "";
    const size_t mark = size >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0 ? 3 : 0;
    report_reader reader;
    ffd_error error = {0};
    bool too_large;
    const ffd_status status = ffd_report_reader_open(&reader, "input", text, size, &error);
    json_t *const root = read_json(text + mark, size - mark, &too_large);
    if (status) {
        PROMISE(status == FFD_E_INVALID || status == FFD_E_LIMIT || status == FFD_E_UNSUPPORTED, "status %d",
                status);
        PROMISE(error.message[0] && !strpbrk(error.message, "\r\n"), "it says '%s'", error.message);
        PROMISE(status == FFD_E_LIMIT || !is_report(root) || !is_plain(text, size), "a report is refused: %s",
                error.message);
    } else {
        PROMISE(root ? is_report(root) : too_large, "what is no report is taken");
        check_entries(&reader, root);
    }
    json_decref(root);
    return 0;
}

size_t fuzz_mutate(uint8_t *data, size_t size, size_t capacity, uint64_t seed)
{
    mutant m = {.data = data, .size = size, .capacity = capacity, .text = size, .random = {seed}};
    if (size == 0)
        return 0;
    if (mutant_pick(&m, 4) == 0)
        mutant_change_number(&m);
    else
        mutant_change_piece(&m, "{}[]\",:\\ 01-e.nt\n\xff");
    return m.size;
}
