#include "batch/manifest/table.h"
#include "base/system/interrupt.h"
#include "base/text/words.h"
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static ffd_status next_row(csv_table *table, csv_row *row, line_state *state, bool *valid, ffd_error *error)
{
    line_reader *const reader = table->reader;
    ffd_status status = FFD_OK;
    *state = table->is_lost ? LINE_NONE : LINE_READ;
    if (table->is_lost)
        return FFD_OK;
    if (!table->row_goes_on) {
        status = ffd_lines_next_filled(reader, state, error);
        table->line = reader->number;
        table->scan = (csv_scan){0};
    }
    const char separators[] = {table->separator ? table->separator : ',', table->separator ? 0 : ';', 0};
    while (!status && *state == LINE_READ && !reader->too_long &&
           ffd_csv_is_open(&table->scan, separators, reader->line.data, reader->line.size))
        status = ffd_lines_next(reader, true, state, error);
    table->row_goes_on = *state == LINE_LATER && table->scan.at > 0;
    if (*state == LINE_NONE && table->scan.at > 0)
        *state = LINE_READ; /* the text ended inside quotes */
    if (status || *state != LINE_READ)
        return status;
    table->is_lost = reader->too_long;
    if (!table->separator)
        table->separator = ffd_csv_separator(reader->line.data, reader->line.size);
    *valid = !reader->too_long && ffd_csv_split(table->separator, reader->line.data, reader->line.size, row);
    return row->text.failed ? ffd_fail_memory(error) : FFD_OK;
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

bool ffd_table_check(const csv_table *table, bool valid, ffd_error *error)
{
    if (table->is_lost)
        return refuse_row(
            table, error,
            "a row of more than %zu bytes, perhaps because a quote is missing: the rest is not read",
            LINE_MOST);
    if (!valid)
        return refuse_row(table, error, "not a valid CSV row");
    if (table->row.count != table->columns.count)
        return refuse_row(table, error, "the row has %zu %s, but the table has %zu %s", table->row.count,
                          ffd_plural(table->row.count, "cell", "cells"), table->columns.count,
                          ffd_plural(table->columns.count, "column", "columns"));
    return ffd_csv_is_text(&table->row) || refuse_row(table, error, "a cell is not text in UTF-8");
}

bool ffd_table_has(const csv_table *table, const char *column)
{
    const char *name = NULL;
    for (size_t i = 0; i < table->columns.count; i++) {
        name = ffd_csv_next(&table->columns, name);
        if (strcmp(name, column) == 0)
            return true;
    }
    return false;
}

/* Refuses names of ignored columns that the table does not have. */
static ffd_status check_ignored(const csv_table *table, ffd_error *error)
{
    const char *word = table->ignored;
    for (size_t length; word && *word; word += length + (word[length] == ',')) {
        char name[64];
        length = strcspn(word, ",");
        snprintf(name, sizeof name, "%.*s", (int)(length < sizeof name ? length : sizeof name - 1), word);
        if (length && !ffd_table_has(table, name))
            return ffd_fail_line(error, FFD_E_INVALID, table->name, (size_t)table->line,
                                 "the table has no column \"%s\" (--csv-ignore)", name);
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

static ffd_status check_columns(const csv_table *table, ffd_error *error)
{
    const csv_row *const columns = &table->columns;
    const char *name = NULL;
    if (!ffd_csv_is_text(columns))
        return ffd_fail_line(error, FFD_E_INVALID, table->name, (size_t)table->line,
                             "the name of a column is not text in UTF-8");
    for (size_t i = 0; i < columns->count; i++) {
        const char *other = name = ffd_csv_next(columns, name);
        if (has_lone_return(name))
            return ffd_fail_line(error, FFD_E_INVALID, table->name, (size_t)table->line,
                                 "the lines end with CR alone: a table needs LF or CR LF");
        if (!*name)
            return ffd_fail_line(error, FFD_E_INVALID, table->name, (size_t)table->line,
                                 "column %zu of the table has no name", i + 1);
        for (size_t k = i + 1; k < columns->count; k++) {
            other = ffd_csv_next(columns, other);
            if (strcmp(name, other) == 0)
                return ffd_fail_line(error, FFD_E_INVALID, table->name, (size_t)table->line,
                                     "two columns of the table are named \"%.60s\"", name);
        }
    }
    return check_ignored(table, error);
}

ffd_status ffd_table_begin(csv_table *table, ffd_error *error)
{
    line_state state;
    bool valid = false;
    ffd_status status;
    do {
        ffd_stream_wait(table->reader->stream);
        status = next_row(table, &table->columns, &state, &valid, error);
    } while (!status && state == LINE_LATER && !ffd_interrupt_requested());
    if (status || ffd_interrupt_requested())
        return status;
    if (state != LINE_READ || !valid)
        return ffd_fail_line(error, FFD_E_INVALID, table->name, 1,
                             "the first row of the table must name its columns");
    status = check_columns(table, error);
    if (!status && table->separator == ';')
        status = ffd_flaw_line(&table->flaws, table->name, (size_t)table->line, error,
                               "the columns are separated by semicolons: numbers may have a decimal comma");
    return status;
}

void ffd_table_free(csv_table *table)
{
    ffd_csv_free(&table->columns);
    ffd_csv_free(&table->row);
}
