#include "job/report/report_reader.h"
#include "base/text/content.h"
#include "base/text/words.h"
#include "job/report/report.h"
#include "json/json_parse.h"
#include <stdio.h>
#include <string.h>

/* The most bytes of what was found, for messages. */
#define SHOWN_MOST 64

/* Returns the line number of a position. Counts lines, so only for messages. */
static size_t line_of(const report_reader *reader, const char *at)
{
    size_t line = 1;
    for (const char *c = reader->begin; c < at; c++)
        line += *c == '\n';
    return line;
}

/* Returns the end of the text, number, word or character at the current position. */
static const char *token_end(const report_reader *reader)
{
    const char *c = reader->at;
    if (*c == '"') {
        for (c++; c < reader->end && *c != '"' && (unsigned char)*c >= ' ';)
            c += *c == '\\' && c + 1 < reader->end ? 2 : 1;
        return c < reader->end && *c == '"' ? c + 1 : reader->at + 1;
    }
    while (c < reader->end && *c &&
           strchr("+-.0123456789abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_", *c))
        c++;
    return c > reader->at ? c : c + 1;
}

static ffd_status refuse(const report_reader *reader, const char *what, ffd_error *error)
{
    char found[SHOWN_MOST] = "the end";
    const unsigned char byte = reader->at < reader->end ? (unsigned char)*reader->at : 0;
    if (byte > 0x20 && byte < 0x7f) {
        const size_t length = (size_t)(token_end(reader) - reader->at);
        const char *const quote = length == 1 ? "'" : "";
        char shown[SHOWN_MOST - 3];
        ffd_bytes_shown(reader->at, length, shown, sizeof shown);
        snprintf(found, sizeof found, "%s%s%s", quote, shown, quote);
    } else if (reader->at < reader->end) {
        snprintf(found, sizeof found, "byte 0x%02x", (unsigned)byte);
    }
    return ffd_fail_line(error, FFD_E_INVALID, reader->name, line_of(reader, reader->at),
                         "not a report: %s, found %s", what, found);
}

static void skip_space(report_reader *reader)
{
    while (reader->at < reader->end && *reader->at && strchr(" \t\n\r", *reader->at))
        reader->at++;
}

/* Skips the character c and the white space after it. */
static bool take(report_reader *reader, char c)
{
    if (reader->at == reader->end || *reader->at != c)
        return false;
    reader->at++;
    skip_space(reader);
    return true;
}

/* Skips a fixed text and the white space after it. */
static bool take_text(report_reader *reader, const char *text)
{
    const size_t length = strlen(text);
    if ((size_t)(reader->end - reader->at) < length || memcmp(reader->at, text, length) != 0)
        return false;
    reader->at += length;
    skip_space(reader);
    return true;
}

/* Returns the end of the object that begins at c, by counting brackets outside of strings; NULL: it has no
   end. */
static const char *object_end(const char *c, const char *end)
{
    size_t depth = 0;
    bool quoted = false;
    for (; c < end; c++) {
        if (quoted && *c == '\\' && c + 1 < end)
            c++;
        else if (*c == '"')
            quoted = !quoted;
        else if (!quoted && (*c == '{' || *c == '['))
            depth++;
        else if (!quoted && (*c == '}' || *c == ']') && --depth == 0)
            return c + 1;
    }
    return NULL;
}

/* Reads the entry that begins here, and moves behind it. */
static ffd_status take_entry(report_reader *reader, report_entry_text *entry, ffd_error *error)
{
    if (reader->at == reader->end || *reader->at != '{')
        return refuse(reader, reader->lines ? "an entry is expected" : "an entry of \"jobs\" is expected",
                      error);
    const char *const end = object_end(reader->at, reader->end);
    if (!end)
        return ffd_fail_line(error, FFD_E_INVALID, reader->name, line_of(reader, reader->at),
                             "not a report: this entry has no end");
    *entry = (report_entry_text){reader->at, (size_t)(end - reader->at)};
    reader->at = end;
    reader->jobs++;
    skip_space(reader);
    return FFD_OK;
}

/* Skips the comma between entries; stays at the closing bracket. */
static ffd_status take_comma(report_reader *reader, ffd_error *error)
{
    const bool comma = take(reader, ',');
    if (reader->at < reader->end && *reader->at == (comma ? '{' : ']'))
        return FFD_OK;
    return refuse(reader, comma ? "an entry is expected after ','" : "',' or ']' is expected after an entry",
                  error);
}

/* The most bytes of a value in a message. */
#define VALUE_SHOWN 200

/* Members that every entry has. */
static const struct {
    const char *key, *what;
    unsigned kinds; /* bit set of json_kind */
} promised[] = {
    {"input", "a text or null", 1U << JSON_STRING | 1U << JSON_NULL},
    {"output", "a text or null", 1U << JSON_STRING | 1U << JSON_NULL},
    {"status", "\"ok\", \"failed\" or \"skipped\"", 1U << JSON_STRING},
    {"exit", "a whole number from 0 to 7", 1U << JSON_NUMBER},
    {"error", "a text or null", 1U << JSON_STRING | 1U << JSON_NULL},
};

static bool is_outcome(const json_tree *tree, uint32_t value)
{
    for (int outcome = 0; outcome < REPORT_OUTCOMES; outcome++)
        if (ffd_json_tree_string_is(tree, value, ffd_report_outcome_name((report_outcome)outcome)))
            return true;
    return false;
}

static bool is_promised(const json_tree *tree, uint32_t value, size_t which)
{
    double code;
    if (!(promised[which].kinds >> tree->values[value].kind & 1))
        return false;
    if (strcmp(promised[which].key, "status") == 0)
        return is_outcome(tree, value);
    return !ffd_json_tree_number(tree, value, &code) || (code >= 0 && code <= 7 && code == (int)code);
}

static ffd_status refuse_value(const json_tree *tree, uint32_t value, const char *what, const char *name,
                               ffd_error *error)
{
    const json_value *const v = &tree->values[value];
    const uint32_t length = v->end - v->begin;
    return ffd_json_tree_fail(tree, value, name, FFD_E_INVALID, error, "must be %s, not %.*s", what,
                              (int)(length < VALUE_SHOWN ? length : VALUE_SHOWN), tree->text + v->begin);
}

static ffd_status check_members(const json_tree *tree, const char *name, ffd_error *error)
{
    for (size_t i = 0; i < sizeof promised / sizeof *promised; i++) {
        const uint32_t value = ffd_json_tree_member(tree, 0, promised[i].key);
        if (value == JSON_NONE)
            return ffd_json_tree_fail(tree, 0, name, FFD_E_INVALID, error, "\"%s\" is missing",
                                      promised[i].key);
        if (!is_promised(tree, value, i))
            return refuse_value(tree, value, promised[i].what, name, error);
    }
    return FFD_OK;
}

/* Turns a pointer into an entry into one into the report. That into a line of JSON Lines stays. */
static void extend_pointer(const report_reader *reader, const report_entry_text *entry, ffd_error *error)
{
    if (reader->lines) {
        error->line = line_of(reader, entry->bytes);
        return;
    }
    char pointer[sizeof error->pointer];
    snprintf(pointer, sizeof pointer, "/jobs/%llu%s", (unsigned long long)(reader->jobs - 1), error->pointer);
    memcpy(error->pointer, pointer, sizeof pointer);
}

static ffd_status check_entry(const report_reader *reader, const report_entry_text *entry, ffd_error *error)
{
    const json_input input = {
        .text = entry->bytes, .size = entry->size, .name = reader->name, .whole = reader->begin};
    json_tree tree;
    bool parsed = false;
    ffd_status status;
    TRY_END(ffd_json_parse(&input, &tree, error));
    parsed = true;
    TRY_END(check_members(&tree, reader->name, error));
end:
    if (status == FFD_E_INVALID && error && (parsed || error->pointer[0]))
        extend_pointer(reader, entry, error);
    ffd_json_tree_free(&tree);
    return status;
}

/* Checks all entries, up to the closing bracket. */
static ffd_status read_jobs(report_reader *reader, ffd_error *error)
{
    report_entry_text entry;
    if (!take(reader, '['))
        return refuse(reader, "\"jobs\" must be an array", error);
    while (!take(reader, ']')) {
        TRY(take_entry(reader, &entry, error));
        TRY(check_entry(reader, &entry, error));
        TRY(take_comma(reader, error));
    }
    return FFD_OK;
}

/* Reads a member of the report. Each may occur once. */
static ffd_status read_member(report_reader *reader, unsigned *seen, const char **jobs, ffd_error *error)
{
    static const char *const keys[] = {"\"format\"", "\"version\"", "\"jobs\""};
    static const char *const values[] = {"\"ffd-report\"", "1", NULL};
    for (unsigned i = 0; i < 3; i++) {
        const char *const key = reader->at;
        if (!take_text(reader, keys[i]))
            continue;
        if (*seen & 1U << i) {
            reader->at = key;
            return refuse(reader, "a member is repeated", error);
        }
        *seen |= 1U << i;
        if (!take(reader, ':'))
            return refuse(reader, "':' is expected", error);
        if (!values[i]) {
            *jobs = reader->at;
            return read_jobs(reader, error);
        }
        if (i == 1 && reader->at < reader->end && *reader->at >= '2' && *reader->at <= '9')
            return ffd_fail_line(error, FFD_E_UNSUPPORTED, reader->name, line_of(reader, reader->at),
                                 "this version of a report is newer than 1, the newest known here");
        return take_text(reader, values[i])
                   ? FFD_OK
                   : refuse(reader, i == 0 ? "\"format\" must be \"ffd-report\"" : "\"version\" must be 1",
                            error);
    }
    /* Refuse unknown members: a merged report would lose them. */
    return refuse(reader, "\"format\", \"version\" or \"jobs\" is expected", error);
}

static ffd_status read_lines(report_reader *reader, ffd_error *error)
{
    report_entry_text entry;
    const char *const first = reader->at;
    while (reader->at < reader->end) {
        TRY(take_entry(reader, &entry, error));
        TRY(check_entry(reader, &entry, error));
    }
    reader->at = first;
    reader->jobs = 0;
    return FFD_OK;
}

ffd_status ffd_report_reader_open(report_reader *reader, const char *name, bool lines, const void *text,
                                  size_t size, ffd_error *error)
{
    const char *jobs = NULL;
    unsigned seen = 0;
    *reader = (report_reader){
        .name = name, .begin = text, .at = text, .end = (const char *)text + size, .lines = lines};
    if (ffd_content_is_utf16(text, size))
        return ffd_fail_line(error, FFD_E_INVALID, name, 1, "is text in UTF-16: it must be UTF-8");
    take_text(reader, "\xef\xbb\xbf"); /* RFC 8259, 8.1: a byte order mark may be ignored */
    skip_space(reader);
    if (lines)
        return read_lines(reader, error);
    if (!take(reader, '{'))
        return refuse(reader, "'{' is expected", error);
    do {
        TRY(read_member(reader, &seen, &jobs, error));
    } while (take(reader, ','));
    if (!take(reader, '}'))
        return refuse(reader, "',' or '}' is expected", error);
    if (seen != 7)
        return ffd_fail_file(error, FFD_E_INVALID, name,
                             "not a report: \"format\", \"version\" or \"jobs\" is missing");
    if (reader->at < reader->end)
        return refuse(reader, "nothing may follow", error);
    reader->at = jobs;
    reader->jobs = 0;
    take(reader, '[');
    return FFD_OK;
}

bool ffd_report_reader_next(report_reader *reader, report_entry_text *entry)
{
    if (reader->lines)
        return reader->at < reader->end && take_entry(reader, entry, NULL) == FFD_OK;
    return *reader->at != ']' && take_entry(reader, entry, NULL) == FFD_OK &&
           take_comma(reader, NULL) == FFD_OK;
}
