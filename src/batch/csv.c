#include "batch/csv.h"
#include "json/json_chars.h"
#include <string.h>

/* Reads a quoted cell from the quote at text[i]. Returns the index after its closing quote; 0 if there is
 * none. */
static size_t take_quoted(const char *text, size_t i, size_t size, byte_buffer *cell)
{
    for (i++; i < size; i++) {
        if (text[i] == '"' && i + 1 < size && text[i + 1] == '"')
            i++;
        else if (text[i] == '"')
            return i + 1;
        ffd_buffer_append(cell, text + i, 1);
    }
    return 0;
}

/* The end of the cell at text[i], which is not quoted. */
static size_t skip_plain(const char *text, size_t i, size_t size)
{
    while (i < size && text[i] != ',' && text[i] != '"')
        i++;
    return i;
}

bool ffd_csv_is_open(csv_scan *scan, const char *text, size_t size)
{
    for (; scan->at < size; scan->at++) {
        const char c = text[scan->at];
        if (scan->state == CSV_QUOTED)
            scan->state = c == '"' ? CSV_QUOTE_ENDS : CSV_QUOTED;
        else if (c == '"' && scan->state != CSV_PLAIN && scan->state != CSV_BROKEN)
            scan->state = CSV_QUOTED; /* begins, or was one of two */
        else if (c == ',' && scan->state != CSV_BROKEN)
            scan->state = CSV_CELL_BEGINS;
        else if (c == '"' || scan->state == CSV_QUOTE_ENDS)
            scan->state = CSV_BROKEN; /* it is not a row, whatever follows */
        else if (scan->state == CSV_CELL_BEGINS)
            scan->state = CSV_PLAIN;
    }
    return scan->state == CSV_QUOTED;
}

bool ffd_csv_split(const char *text, size_t size, csv_row *row)
{
    size_t i = 0;
    row->text.size = row->count = 0;
    for (;; i++) {
        if (i < size && text[i] == '"') {
            i = take_quoted(text, i, size, &row->text);
            if (i == 0 || (i < size && text[i] != ','))
                return false;
        } else {
            const size_t first = i;
            i = skip_plain(text, i, size);
            if (i < size && text[i] == '"')
                return false;
            ffd_buffer_append(&row->text, text + first, i - first);
        }
        ffd_buffer_append(&row->text, "", 1);
        row->count++;
        if (i >= size)
            return true;
    }
}

bool ffd_csv_is_text(const csv_row *row)
{
    const char *cell = NULL;
    for (size_t i = 0; i < row->count; i++) {
        cell = ffd_csv_next(row, cell);
        if (!ffd_utf8_is_valid(cell, strlen(cell)))
            return false;
    }
    return true;
}

const char *ffd_csv_next(const csv_row *row, const char *cell)
{
    return cell ? cell + strlen(cell) + 1 : row->text.data;
}

void ffd_csv_free(csv_row *row)
{
    ffd_buffer_free(&row->text);
    *row = (csv_row){0};
}
