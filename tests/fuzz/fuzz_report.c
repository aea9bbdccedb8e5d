/* fuzz_report.c - a report that is to be merged: it is taken if and only if another reader of JSON reads it
   too and it says what a report must; its entries are those that the other one finds. */
#include "fuzz_target.h"
#include "job/report/report_reader.h"
#include "json_oracle.h"
#include "mutate_text.h"
#include "promise.h"
#include <string.h>

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

static void check_entries(report_reader *reader, const json_oracle *root)
{
    report_entry_text entry;
    size_t count = 0;
    bool too_large;
    for (; ffd_report_reader_next(reader, &entry); count++) {
        PROMISE(entry.bytes >= reader->begin && entry.bytes + entry.size <= reader->end,
                "an entry of other bytes");
        json_oracle *const own = oracle_read(entry.bytes, entry.size, &too_large);
        PROMISE(!root || (own && count < oracle_count_jobs(root) && oracle_job_is(root, count, own)),
                "entry %zu is another one", count);
        oracle_free(own);
    }
    PROMISE(!root || count == oracle_count_jobs(root), "%zu entries of %zu", count, oracle_count_jobs(root));
}

/* The same text as JSON Lines. */
static void check_lines(const char *text, size_t size)
{
    report_reader reader;
    ffd_error error = {0};
    const ffd_status status = ffd_report_reader_open(&reader, "input", true, text, size, &error);
    if (status)
        PROMISE(error.message[0] && !strpbrk(error.message, "\r\n"), "it says '%s'", error.message);
    else
        check_entries(&reader, NULL);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const char *const text = size > 0 ? (const char *)data : "";
    const size_t mark = size >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0 ? 3 : 0;
    report_reader reader;
    ffd_error error = {0};
    bool too_large;
    const ffd_status status = ffd_report_reader_open(&reader, "input", false, text, size, &error);
    json_oracle *const root = oracle_read(text + mark, size - mark, &too_large);
    if (status) {
        PROMISE(status == FFD_E_INVALID || status == FFD_E_LIMIT || status == FFD_E_UNSUPPORTED, "status %d",
                status);
        PROMISE(error.message[0] && !strpbrk(error.message, "\r\n"), "it says '%s'", error.message);
        PROMISE(status == FFD_E_LIMIT || !root || !oracle_is_report(root) || !is_plain(text, size),
                "a report is refused: %s", error.message);
    } else {
        PROMISE(root ? oracle_is_report(root) : too_large, "what is not a report is taken");
        check_entries(&reader, root);
    }
    oracle_free(root);
    check_lines(text, size);
    return 0;
}

size_t fuzz_mutate(uint8_t *data, size_t size, size_t capacity, uint64_t seed)
{
    return mutate_text(data, size, capacity, seed, "{}[]\",:\\ 01-e.nt\n\xff");
}
