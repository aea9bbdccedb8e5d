#include "job/report/output_set.h"
#include "base/memory/memory.h"

ffd_status ffd_written_create(ffd_written **written, ffd_error *error)
{
    *written = ffd_alloc_zero(1, sizeof **written);
    return *written ? FFD_OK : ffd_fail_memory(error);
}

void ffd_known_users_free(known_users *known)
{
    ffd_users_free(&known->users);
    ffd_intern_free(&known->folders);
    *known = (known_users){0};
}

void ffd_written_destroy(ffd_written **written)
{
    if (!written || !*written)
        return;
    ffd_written_free(&(*written)->files);
    ffd_known_users_free(&(*written)->users);
    ffd_free(*written);
    *written = NULL;
}
