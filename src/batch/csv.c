#include "batch/csv.h"
#include <string.h>

bool ffd_csv_is_open(const char *text, size_t size)
{
    bool open = false;
    for (size_t i = 0; i < size; i++)
        open = open != (text[i] == '"');
    return open;
}

/* From the quote at text[i] to behind the one that ends the cell: where that is, 0 for none. */
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
            while (i < size && text[i] != ',' && text[i] != '"')
                i++;
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
