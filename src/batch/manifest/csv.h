/* csv.h - one row of a table of values separated by commas (RFC 4180), or by semicolons. */
#ifndef FFD_BATCH_MANIFEST_CSV_H
#define FFD_BATCH_MANIFEST_CSV_H

#include "base/text/buffer.h"
#include <stdbool.h>
#include <stddef.h>

typedef struct csv_row {
    byte_buffer text; /* the cells, each ended by 0 */
    size_t count;
} csv_row;

/* How far a text was scanned; all zeros at its beginning. */
typedef struct csv_scan {
    size_t at;
    enum { CSV_CELL_BEGINS, CSV_PLAIN, CSV_QUOTED, CSV_QUOTE_ENDS, CSV_BROKEN } state;
} csv_scan;

/* Scans what has been added to the text, whose cells are separated by one of these characters. Returns
   whether it ends within quotes: its row goes on in the next line. */
bool ffd_csv_is_open(csv_scan *scan, const char *separators, const char *text, size_t size);
/* The separator of a first row: the semicolon, where there is one outside of quotes and no comma. */
char ffd_csv_separator(const char *text, size_t size);
/* Splits a complete row. False if a quote is in the middle of a cell, or the cell goes on
   after its closing quote. */
bool ffd_csv_split(char separator, const char *text, size_t size, csv_row *row);
/* Whether all cells are UTF-8. */
bool ffd_csv_is_text(const csv_row *row);
/* The cell after this one; the first for NULL. */
const char *ffd_csv_next(const csv_row *row, const char *cell);
/* Writes a number as JSON has it, read as people and programs write it: ".5", "5.", "+5", "05", and with a
   decimal comma "0,5". Returns false for all other texts. */
bool ffd_csv_number(const char *cell, bool decimal_comma, byte_buffer *json);
/* Leaves an empty row. */
void ffd_csv_free(csv_row *row);

#endif
