/* vectors.h - the positions and normals of documents that hold them as numbers, 3 a vector. */
#ifndef FFD_IO_TEXT_VECTORS_H
#define FFD_IO_TEXT_VECTORS_H

#include "base/fail.h"
#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* Makes *results a copy of count vectors, in its old place where it had one. Freed by ffd_free. Errors:
   FFD_E_MEMORY. */
ffd_status ffd_vectors_copy(const double *vectors, size_t count, double **results, ffd_error *error);
/* Copies count vectors from number first on, if any, to xyz. */
void ffd_vectors_read(const double *vectors, size_t first, size_t count, double *xyz);
/* Puts those of count vectors at xyz that are marked as changed into results, from number first on. results
   may be NULL: nothing is kept. Any thread, on ranges of its own. */
void ffd_vectors_write(double *results, size_t first, size_t count, const double *xyz,
                       const uint8_t *changed);

/* Which of count numbers, 32 at most, have other bits than before: a bit for each. */
static inline unsigned ffd_vectors_changes(const double *before, const double *after, size_t count)
{
    unsigned changes = 0;
    for (size_t i = 0; i < count; i++)
        changes |= (unsigned)(memcmp(before + i, after + i, sizeof *after) != 0) << i;
    return changes;
}

#endif
