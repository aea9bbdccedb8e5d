/* row_array.h - the positions of all jobs of a run in one array (--positions): a NumPy file of shape jobs x
   vertices x 3, little-endian. It has its final size from the start; a row is NaN until its job is done. A
   row's first vertex is written last, so a row that does not begin with NaN is complete. Several runs may
   write different rows of one array at the same time. */
#ifndef FFD_BATCH_ROW_ARRAY_H
#define FFD_BATCH_ROW_ARRAY_H

#include "base/fail.h"
#include "base/file/output.h"
#include "base/memory/hash.h"
#include <stdint.h>

typedef struct row_array {
    const char *path;        /* borrowed */
    uint64_t rows, vertices; /* vertices: of each row */
    bool is_double;          /* float64, else float32 */
} row_array;

/* Checks that the size in bytes does not overflow. Errors: FFD_E_LIMIT. */
ffd_status ffd_rows_check_size(const row_array *array, ffd_error *error);
/* Finds whether the file exists. Errors: FFD_E_EXISTS for a file that is not this array (its header must
   match byte for byte); FFD_E_IO. */
ffd_status ffd_rows_find(const row_array *array, bool *is_there, ffd_error *error);
/* Refuses to replace a file that is not a NumPy array. Errors: FFD_E_EXISTS, FFD_E_IO. */
ffd_status ffd_rows_check_replaced(const row_array *array, ffd_error *error);
/* Writes an array with all rows NaN under a temporary name. *made is passed to ffd_rows_place or
   ffd_output_destroy; NULL: another run has just made the same array, or this run was interrupted. force:
   replace an existing file. Errors: FFD_E_EXISTS, FFD_E_IO, FFD_E_MEMORY. */
ffd_status ffd_rows_make(const row_array *array, bool force, file_output **made, ffd_error *error);
/* Renames the array to its final name, unless *made is NULL, and frees it. Errors: as of ffd_rows_make. */
ffd_status ffd_rows_place(const row_array *array, bool force, file_output **made, ffd_error *error);

/* Whether a row has positions. False if the file does not exist. */
bool ffd_row_is_done(const row_array *array, uint64_t row);
/* Checks that positions (x, y, z of count vertices) fit into a row. Errors: FFD_E_INVALID if the number of
   vertices differs, or a number is too large for the array's type. */
ffd_status ffd_row_check(const row_array *array, const double *positions, size_t count, ffd_error *error);
/* Checks positions likewise, and writes them to a row. Errors: those of ffd_row_check; FFD_E_IO,
   FFD_E_MEMORY. */
ffd_status ffd_row_write(const row_array *array, uint64_t row, const double *positions, size_t count,
                         ffd_error *error);
/* Resets a row to NaN, as far as possible. */
void ffd_row_clear(const row_array *array, uint64_t row);
/* Hashes the bytes of a row. Errors: those of reading. */
ffd_status ffd_row_hash(const row_array *array, uint64_t row, hash128 *hash, ffd_error *error);

#endif
