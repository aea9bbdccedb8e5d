#include "io/text/vectors.h"
#include "base/memory/memory.h"
#include <string.h>

void ffd_vectors_read(const double *vectors, size_t first, size_t count, double *xyz)
{
    if (count > 0) /* else vectors may be NULL */
        memcpy(xyz, vectors + 3 * first, 3 * count * sizeof *xyz);
}

ffd_status ffd_vectors_copy(const double *vectors, size_t count, double **results, ffd_error *error)
{
    if (!*results)
        *results = ffd_alloc(count, 3 * sizeof **results);
    if (!*results)
        return ffd_fail_memory(error);
    ffd_vectors_read(vectors, 0, count, *results);
    return FFD_OK;
}

void ffd_vectors_write(double *results, size_t first, size_t count, const double *xyz, const uint8_t *changed)
{
    for (size_t i = 0; results && i < count; i++)
        if (changed[i])
            memcpy(results + 3 * (first + i), xyz + 3 * i, 3 * sizeof *xyz);
}
