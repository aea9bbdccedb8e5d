#include "job/source.h"
#include <stdio.h>
#include <string.h>

ffd_status ffd_compare_run(const ffd_source *a, const ffd_source *b, double tolerance,
                           ffd_comparison *comparison, ffd_error *error)
{
    mesh_document *first = NULL, *second = NULL;
    if (!(tolerance >= 0))
        return ffd_fail(error, FFD_E_ARGUMENT, "the tolerance must not be negative");
    memset(comparison, 0, sizeof *comparison);
    ffd_status status = ffd_source_open(a, 0, &first, error);
    if (!status)
        status = ffd_source_open(b, 0, &second, error);
    if (!status && first->format != second->format)
        snprintf(comparison->difference, sizeof comparison->difference, "formats: %s and %s",
                 first->format->name, second->format->name);
    else if (!status)
        status = first->format->compare(first, second, tolerance, comparison, error);
    ffd_source_close(&second);
    ffd_source_close(&first);
    return status;
}
