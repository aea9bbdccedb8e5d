/* table.h - reads the rows of a table of jobs. */
#ifndef FFD_BATCH_MANIFEST_TABLE_H
#define FFD_BATCH_MANIFEST_TABLE_H

#include "batch/manifest/lines.h"
#include "io/csv/csv.h"
#include "mesh/flaws.h"
#include <stdint.h>

typedef struct csv_table {
    line_reader *reader;
    const char *name;    /* for messages */
    const char *ignored; /* columns to ignore, "a,b"; or NULL */
    csv_row columns, row;
    uint8_t *skipped; /* of each column: whether it is left out */
    uint8_t *points;  /* of each column: the set of csv_point of its numbers so far */
    char separator;   /* of the cells; 0: not known yet */
    uint64_t line;    /* first line of the last row */
    mesh_flaws flaws;
    csv_scan scan;    /* of the current row */
    bool row_goes_on; /* the row continues in a line that has not arrived yet */
    bool is_lost;     /* a row was too long, so the start of the next one is unknown */
} csv_table;

/* Waits for the first row of a table whose reader, name and ignored columns are set; it names the columns.
   Errors: FFD_E_INVALID, FFD_E_IO, FFD_E_MEMORY. */
ffd_status ffd_table_begin(csv_table *table, ffd_error *error);
/* Reads the next row, which may extend over several lines. *valid: its cells are in table->row. Errors:
   FFD_E_IO, FFD_E_MEMORY. */
ffd_status ffd_table_next(csv_table *table, line_state *state, bool *valid, ffd_error *error);
/* Whether that row is valid and has a cell for each column; adds its flaws. error: says what is wrong, at the
   row's line. */
bool ffd_table_check(csv_table *table, bool valid, ffd_error *error);
/* Whether the table has a column of this name that is not left out. */
bool ffd_table_has(const csv_table *table, const char *column);
/* Frees the rows. */
void ffd_table_free(csv_table *table);

#endif
