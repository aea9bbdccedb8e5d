/* csv.h - parses rows of comma-separated values (RFC 4180), or of values separated by semicolons, tabs or
   bars. Blanks beside separators do not belong to a cell, except in quotes. */
#ifndef FFD_IO_CSV_CSV_H
#define FFD_IO_CSV_CSV_H

#include "base/text/buffer.h"
#include <stdbool.h>
#include <stddef.h>

typedef struct csv_row {
    byte_buffer text; /* the cells, each terminated by 0 */
    byte_buffer ways; /* how each was written: csv_way */
    size_t count;
} csv_row;

/* Bits of a cell. */
typedef enum csv_way { CSV_IN_QUOTES = 1, CSV_HAD_BLANKS = 2 } csv_way;

/* State of a scan; all zeros at the start. */
typedef struct csv_scan {
    size_t at, opened; /* opened: where the last quoted cell begins */
    enum { CSV_CELL_BEGINS, CSV_PLAIN, CSV_QUOTED, CSV_QUOTE_ENDS, CSV_CELL_ENDS, CSV_BROKEN } state;
} csv_scan;

/* Scans text that was appended. separators: the characters that may separate cells. Returns whether the text
   ends inside quotes, so that its row continues in the next line. */
bool ffd_csv_is_open(csv_scan *scan, const char *separators, const char *text, size_t size);
/* The characters that may separate cells. */
#define CSV_SEPARATORS ",;\t|"

/* Returns the separator of a table by its first row: a comma if it has one outside of quotes, else a
   semicolon or a tab, of which it has more, else a bar. */
char ffd_csv_separator(const char *text, size_t size);
/* Returns the separator that a line "sep=;" in front of a table names, as Excel reads it; 0: it is none. */
char ffd_csv_named_separator(const char *text, size_t size);
/* Splits a complete row. Returns false for a quote inside an unquoted cell, or text behind a closing
   quote. */
bool ffd_csv_split(char separator, const char *text, size_t size, csv_row *row);
/* Whether all cells are valid UTF-8 without NUL bytes. */
bool ffd_csv_is_text(const csv_row *row);
/* Returns the next cell; cell NULL: the first one. */
const char *ffd_csv_next(const csv_row *row, const char *cell);
/* How a number is written: with a decimal comma; or with a dot before three digits at its end, which may
   stand for thousands where others have a decimal comma. */
typedef enum csv_point { CSV_DECIMAL_COMMA = 1, CSV_DOT_OF_THREE = 2 } csv_point;

/* Returns which of these a cell that is a number has; 0: none. */
csv_point ffd_csv_point(const char *cell);
/* Converts a number as people and programs write it (".5", "5.", "+5", "05", with decimal_comma also "0,5")
   to JSON. Returns false if the text is not a number. */
bool ffd_csv_number(const char *cell, bool decimal_comma, byte_buffer *json);
/* Frees the cells; leaves an empty row. */
void ffd_csv_free(csv_row *row);

#endif
