/* row_array.h - the positions of all jobs of a run in one array (--positions): a file of NumPy's, jobs x
   vertices x 3 numbers, lowest byte first. It has its final size from the beginning; a row is NaN until its
   job is done. The first vertex of a row is written last, so that a row which begins with a number is whole.
   Several runs may write rows of one array at a time, each its own. */
#ifndef FFD_BATCH_ROW_ARRAY_H
#define FFD_BATCH_ROW_ARRAY_H

#include "base/fail.h"
#include "base/file/output.h"
#include "base/memory/hash.h"
#include <stdint.h>

typedef struct row_array {
    const char *path;        /* not owned */
    uint64_t rows, vertices; /* of each row */
    bool is_double;          /* float64, else float32 */
} row_array;

/* Checks that the numbers of its bytes can be counted. Errors: FFD_E_LIMIT. */
ffd_status ffd_rows_check_size(const row_array *array, ffd_error *error);
/* Whether the file is there. Errors: FFD_E_EXISTS for one that is not this array, to the byte of its head;
   FFD_E_IO. */
ffd_status ffd_rows_find(const row_array *array, bool *is_there, ffd_error *error);
/* Refuses to replace what is no array of NumPy's. Errors: FFD_E_EXISTS, FFD_E_IO. */
ffd_status ffd_rows_check_replaced(const row_array *array, ffd_error *error);
/* Writes the file with rows of NaN under a temporary name. *made is for ffd_rows_place or ffd_output_destroy;
   NULL: another run has made the same array in this moment, or this one was interrupted. force: in the place
   of another file. Errors: FFD_E_EXISTS, FFD_E_IO, FFD_E_MEMORY. */
ffd_status ffd_rows_make(const row_array *array, bool force, file_output **made, ffd_error *error);
/* Gives it its name, unless *made is NULL, and frees it. Errors: the same. */
ffd_status ffd_rows_place(const row_array *array, bool force, file_output **made, ffd_error *error);

/* Whether a row has positions. False too where there is no such file. */
bool ffd_row_is_done(const row_array *array, uint64_t row);
/* Whether positions, x, y, z of `count` vertices, can be a row. Errors: FFD_E_INVALID where they are not as
   many as the array has, or too large for its numbers. */
ffd_status ffd_row_check(const row_array *array, const double *positions, size_t count, ffd_error *error);
/* Writes them, after the same checks. Errors: these; FFD_E_IO, FFD_E_MEMORY. */
ffd_status ffd_row_write(const row_array *array, uint64_t row, const double *positions, size_t count,
                         ffd_error *error);
/* Makes a row NaN again, as far as that is possible. */
void ffd_row_clear(const row_array *array, uint64_t row);
/* Hashes the bytes of a row. Errors: those of reading. */
ffd_status ffd_row_hash(const row_array *array, uint64_t row, hash128 *hash, ffd_error *error);

#endif
