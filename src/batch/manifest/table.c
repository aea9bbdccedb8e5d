#include "batch/manifest/table.h"
#include "base/memory/intern.h"
#include "base/memory/memory.h"
#include "base/system/interrupt.h"
#include "base/text/words.h"
#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static ffd_status next_row(csv_table *table, csv_row *row, line_state *state, bool *valid, ffd_error *error)
{
    line_reader *const reader = table->reader;
    *state = table->is_lost ? LINE_NONE : LINE_READ;
    if (table->is_lost)
        return FFD_OK;
    if (!table->row_goes_on) {
        TRY(ffd_lines_next_filled(reader, state, error));
        table->line = reader->count;
        table->scan = (csv_scan){0};
    }
    const char only[] = {table->separator, 0}, *const separators = table->separator ? only : CSV_SEPARATORS;
    while (*state == LINE_READ && !reader->too_long &&
           ffd_csv_is_open(&table->scan, separators, reader->line.data, reader->line.size))
        TRY(ffd_lines_next(reader, true, state, error));
    table->row_goes_on = *state == LINE_LATER && table->scan.at > 0;
    if (*state == LINE_NONE && table->scan.at > 0)
        *state = LINE_READ; /* the text ended inside quotes */
    if (*state != LINE_READ)
        return FFD_OK;
    table->is_lost = reader->too_long;
    if (!table->separator)
        table->separator = ffd_csv_separator(reader->line.data, reader->line.size);
    *valid = !reader->too_long && ffd_csv_split(table->separator, reader->line.data, reader->line.size, row);
    return row->text.failed || row->ways.failed ? ffd_fail_memory(error) : FFD_OK;
}

ffd_status ffd_table_next(csv_table *table, line_state *state, bool *valid, ffd_error *error)
{
    return next_row(table, &table->row, state, valid, error);
}

/* Says what is wrong with the row; returns false. */
static bool refuse_row(const csv_table *table, ffd_error *error, const char *format, ...) FFD_PRINTF(3, 4);

static bool refuse_row(const csv_table *table, ffd_error *error, const char *format, ...)
{
    char text[256];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    ffd_fail_line(error, FFD_E_INVALID, table->name, (size_t)table->line, "%s", text);
    return false;
}

/* The line in which the last quoted cell begins. */
static uint64_t quote_line(const csv_table *table)
{
    const byte_buffer *const line = &table->reader->line;
    uint64_t number = table->line;
    for (size_t i = 0; i < table->scan.opened && i < line->size; i++)
        number += line->data[i] == '\n';
    return number;
}

/* Says what is wrong with the quotes of a row, the only reason why it is not valid; returns false. */
static bool refuse_quotes(const csv_table *table, ffd_error *error)
{
    return table->scan.state == CSV_QUOTED
               ? refuse_row(table, error,
                            "not a valid CSV row: the quote that was opened in line %" PRIu64
                            " is not closed",
                            quote_line(table))
               : refuse_row(table, error,
                            "not a valid CSV row: a quote stands beside other characters of its cell");
}

/* Tells of the blanks that were left out round a text. Those round numbers change nothing. */
static ffd_status note_blanks(csv_table *table, const csv_row *row, ffd_error *error)
{
    const char *cell = NULL;
    for (size_t i = 0; i < row->count; i++) {
        cell = ffd_csv_next(row, cell);
        if (row->ways.data[i] & CSV_HAD_BLANKS && *cell && !strchr("+-.0123456789", *cell))
            TRY(ffd_flaw_line(&table->flaws, table->name, (size_t)table->line, error,
                              "blanks beside \"%.60s\" are left out", cell));
    }
    return FFD_OK;
}

/* Tells of a row without a value, as spreadsheet programs leave them. */
static ffd_status note_empty(csv_table *table, ffd_error *error)
{
    const csv_row *const row = &table->row;
    bool empty = row->count > 1 && row->text.size == row->count;
    for (size_t i = 0; i < row->count; i++)
        empty = empty && !(row->ways.data[i] & CSV_IN_QUOTES);
    return empty ? ffd_flaw_line(
                       &table->flaws, table->name, (size_t)table->line, error,
                       "all cells of the row are empty: its job has the values of {set} and the defaults")
                 : FFD_OK;
}

bool ffd_table_check(csv_table *table, bool valid, ffd_error *error)
{
    if (table->is_lost && table->scan.state == CSV_QUOTED)
        return refuse_row(
            table, error,
            "a row of more than %zu bytes, perhaps because the quote that was opened in line %" PRIu64
            " is not closed: the rest is not read",
            LINE_MOST, quote_line(table));
    if (table->is_lost)
        return refuse_row(table, error, "a row of more than %zu bytes: the rest is not read", LINE_MOST);
    if (!valid)
        return refuse_quotes(table, error);
    if (table->row.count != table->columns.count)
        return refuse_row(table, error, "the row has %zu %s, but the table has %zu %s", table->row.count,
                          ffd_plural(table->row.count, "cell", "cells"), table->columns.count,
                          ffd_plural(table->columns.count, "column", "columns"));
    if (!ffd_csv_is_text(&table->row))
        return refuse_row(table, error, "a cell is not text in UTF-8");
    return !note_empty(table, error) && !note_blanks(table, &table->row, error);
}

bool ffd_table_has(const csv_table *table, const char *column)
{
    const char *name = NULL;
    for (size_t i = 0; i < table->columns.count; i++) {
        name = ffd_csv_next(&table->columns, name);
        if (strcmp(name, column) == 0)
            return !table->skipped[i];
    }
    return false;
}

/* Marks the ignored columns. names: of the columns, with their indices, but for those without a name. */
static ffd_status skip_ignored(csv_table *table, const intern_table *names, const size_t *indices,
                               ffd_error *error)
{
    const char *word = table->ignored;
    uint32_t known;
    for (size_t length; word && *word; word += length + (word[length] == ',')) {
        length = strcspn(word, ",");
        if (length == 0)
            continue;
        if (!ffd_intern_find(names, word, length, &known))
            return ffd_fail_line(error, FFD_E_INVALID, table->name, (size_t)table->line,
                                 "the table has no column \"%.*s\" ({csv_ignore})",
                                 (int)(length < 60 ? length : 60), word);
        table->skipped[indices[known]] = true;
    }
    return FFD_OK;
}

/* Whether lines end in CR alone (old Macs): then the whole table looks like one line. */
static bool has_lone_return(const char *name)
{
    const char *found = strchr(name, '\r');
    while (found && found[1] == '\n')
        found = strchr(found + 1, '\r');
    return found;
}

static char lower(char c)
{
    return c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c;
}

static const char *const files[] = {"in", "out", "lattice"};

/* Whether the name of a table's only column looks like several: words between blanks or colons, one of which
   is a column of files. */
static bool is_like_row(const char *name)
{
    static const char between[] = " \t:";
    bool found = false;
    size_t words = 0, length;
    for (const char *word = name; *word; word += length) {
        word += strspn(word, between);
        length = strcspn(word, between);
        words += length > 0;
        for (size_t i = 0; i < sizeof files / sizeof *files; i++)
            found = found || (strlen(files[i]) == length && memcmp(word, files[i], length) == 0);
    }
    return found && words > 1;
}

/* Whether a name is one of a column of files but for capitals. */
static bool is_like_file(const char *name)
{
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        size_t k = 0;
        while (name[k] && lower(name[k]) == files[i][k])
            k++;
        if (!name[k] && !files[i][k] && strcmp(name, files[i]) != 0)
            return true;
    }
    return false;
}

/* Tells what a reader of the table may have meant otherwise. */
static ffd_status note_name(csv_table *table, const char *name, size_t index, ffd_error *error)
{
    const size_t line = (size_t)table->line;
    if (!*name) {
        table->skipped[index] = true;
        return ffd_flaw_line(&table->flaws, table->name, line, error,
                             "column %zu has no name, as the index of pandas (index=False), and is left out",
                             index + 1);
    }
    if (table->columns.count == 1 && is_like_row(name))
        return ffd_flaw_line(&table->flaws, table->name, line, error,
                             "the table has one column, \"%.60s\": commas, semicolons, tabs and bars "
                             "separate columns, blanks and colons do not",
                             name);
    if (index == 0 && name[0] == '#' && name[1])
        return ffd_flaw_line(&table->flaws, table->name, line, error,
                             "the first row names the columns, although it begins with \"%.20s\"", name);
    return is_like_file(name) ? ffd_flaw_line(&table->flaws, table->name, line, error,
                                              "the column \"%.20s\" sets a placeholder: files are in columns "
                                              "\"in\", \"out\" and \"lattice\", in small letters",
                                              name)
                              : FFD_OK;
}

/* names: gets the names of the columns, and indices their indices. */
static ffd_status check_name(csv_table *table, const char *name, size_t index, intern_table *names,
                             size_t *indices, ffd_error *error)
{
    uint32_t known;
    const size_t before = names->count;
    if (has_lone_return(name))
        return ffd_fail_line(error, FFD_E_INVALID, table->name, (size_t)table->line,
                             "the lines end with CR alone: a table needs LF or CR LF");
    if (*name && !ffd_intern(names, name, strlen(name), &known))
        return ffd_fail_memory(error);
    if (*name && known < before)
        return ffd_fail_line(error, FFD_E_INVALID, table->name, (size_t)table->line,
                             "two columns of the table are named \"%.60s\"", name);
    if (*name)
        indices[known] = index;
    return note_name(table, name, index, error);
}

static ffd_status check_columns(csv_table *table, ffd_error *error)
{
    const csv_row *const columns = &table->columns;
    const char *name = NULL;
    intern_table names = {0};
    if (!ffd_csv_is_text(columns))
        return ffd_fail_line(error, FFD_E_INVALID, table->name, (size_t)table->line,
                             "the name of a column is not text in UTF-8");
    table->skipped = ffd_alloc_zero(columns->count, sizeof *table->skipped);
    size_t *const indices = ffd_alloc(columns->count, sizeof *indices);
    table->points = ffd_alloc_zero(columns->count, sizeof *table->points);
    ffd_status status;
    TRY_END(table->skipped && table->points && indices ? FFD_OK : ffd_fail_memory(error));
    for (size_t i = 0; i < columns->count; i++) {
        name = ffd_csv_next(columns, name);
        TRY_END(check_name(table, name, i, &names, indices, error));
    }
    TRY_END(skip_ignored(table, &names, indices, error));
end:
    ffd_intern_free(&names);
    ffd_free(indices);
    return status ? status : note_blanks(table, columns, error);
}

static ffd_status note_separator(csv_table *table, ffd_error *error)
{
    if (table->separator == ',')
        return FFD_OK;
    return ffd_flaw_line(&table->flaws, table->name, (size_t)table->line, error,
                         "the columns are separated by %s: numbers may have a decimal comma",
                         table->separator == ';'    ? "semicolons"
                         : table->separator == '\t' ? "tabs"
                                                    : "bars");
}

/* Waits for a row in front of the jobs. */
static ffd_status first_row(csv_table *table, line_state *state, bool *valid, ffd_error *error)
{
    do {
        ffd_stream_wait(table->reader->stream);
        TRY(next_row(table, &table->columns, state, valid, error));
    } while (*state == LINE_LATER && !ffd_interrupt_requested());
    return FFD_OK;
}

/* Takes the separator from a line that is there for a spreadsheet program, and reads the next row instead. */
static ffd_status pass_separator(csv_table *table, line_state *state, bool *valid, ffd_error *error)
{
    const byte_buffer *const line = &table->reader->line;
    const char named = *state == LINE_READ ? ffd_csv_named_separator(line->data, line->size) : 0;
    if (!named)
        return FFD_OK;
    table->separator = named;
    TRY(ffd_flaw_line(&table->flaws, table->name, (size_t)table->line, error,
                      "the line names the separator: the columns are named in the next one"));
    return first_row(table, state, valid, error);
}

ffd_status ffd_table_begin(csv_table *table, ffd_error *error)
{
    line_state state;
    bool valid = false;
    TRY(first_row(table, &state, &valid, error));
    if (!ffd_interrupt_requested())
        TRY(pass_separator(table, &state, &valid, error));
    if (ffd_interrupt_requested())
        return FFD_OK;
    if (state == LINE_READ && !valid && table->scan.state == CSV_QUOTED) {
        refuse_quotes(table, error);
        return FFD_E_INVALID;
    }
    if (state != LINE_READ || !valid)
        return ffd_fail_line(error, FFD_E_INVALID, table->name, 1,
                             "the first row of the table must name its columns");
    TRY(check_columns(table, error));
    return note_separator(table, error);
}

void ffd_table_free(csv_table *table)
{
    ffd_csv_free(&table->columns);
    ffd_csv_free(&table->row);
    ffd_free(table->skipped);
    ffd_free(table->points);
}
