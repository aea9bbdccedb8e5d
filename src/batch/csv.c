#include "batch/csv.h"
#include <string.h>

/* From the quote at text[i] to behind the one that ends the cell: where that is, 0 for none. cell gets what
   is between them, or is NULL. */
static size_t take_quoted(const char *text, size_t i, size_t size, byte_buffer *cell)
{
    for (i++; i < size; i++) {
        if (text[i] == '"' && i + 1 < size && text[i + 1] == '"')
            i++;
        else if (text[i] == '"')
            return i + 1;
        if (cell)
            ffd_buffer_append(cell, text + i, 1);
    }
    return 0;
}

/* Where the cell at text[i] that is not within quotes ends. */
static size_t skip_plain(const char *text, size_t i, size_t size)
{
    while (i < size && text[i] != ',' && text[i] != '"')
        i++;
    return i;
}

bool ffd_csv_is_open(const char *text, size_t size)
{
    for (size_t i = 0; i < size; i++) {
        if (text[i] == '"') {
            i = take_quoted(text, i, size, NULL);
            if (i == 0)
                return true;
        } else {
            i = skip_plain(text, i, size);
        }
        if (i < size && text[i] != ',')
            return false; /* it is no row, whatever comes */
    }
    return false;
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

const char *ffd_csv_next(const csv_row *row, const char *cell)
{
    return cell ? cell + strlen(cell) + 1 : row->text.data;
}

void ffd_csv_free(csv_row *row)
{
    ffd_buffer_free(&row->text);
    *row = (csv_row){0};
}
