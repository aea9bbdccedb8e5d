#include "job/report/output_set.h"
#include "base/memory/memory.h"

ffd_status ffd_written_create(ffd_written **written, ffd_error *error)
{
    *written = ffd_alloc_zero(1, sizeof **written);
    return *written ? FFD_OK : ffd_fail_memory(error);
}

void ffd_written_destroy(ffd_written **written)
{
    if (!written || !*written)
        return;
    ffd_written_free(&(*written)->files);
    ffd_free(*written);
    *written = NULL;
}
