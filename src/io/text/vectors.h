/* vectors.h - copies and compares the positions and normals of documents that hold them as numbers, 3 per
   vector. */
#ifndef FFD_IO_TEXT_VECTORS_H
#define FFD_IO_TEXT_VECTORS_H

#include <stddef.h>
#include <string.h>

/* Copies count vectors (possibly 0), beginning with number first, to xyz. */
static inline void ffd_vectors_read(const double *vectors, size_t first, size_t count, double *xyz)
{
    if (count > 0) /* vectors may be NULL if count is 0 */
        memcpy(xyz, vectors + 3 * first, 3 * count * sizeof *xyz);
}

/* Returns one bit for each of count numbers (at most 32), set if the bits of the number differ. */
static inline unsigned ffd_vectors_changes(const double *before, const double *after, size_t count)
{
    unsigned changes = 0;
    for (size_t i = 0; i < count; i++)
        changes |= (unsigned)(memcmp(before + i, after + i, sizeof *after) != 0) << i;
    return changes;
}

#endif
