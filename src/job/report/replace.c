#include "job/report/replace.h"
#include "base/file/output.h"

ffd_status ffd_replace_check(const char *path, bool (*is_own)(const file_input *old), const char *kind,
                             ffd_error *error)
{
    file_input old;
    if (ffd_output_is_stream(path) || ffd_output_check(path, false, NULL) != FFD_E_EXISTS)
        return FFD_OK;
    TRY(ffd_file_load(path, &old, error));
    const bool free = old.size == 0 || is_own(&old);
    ffd_file_unload(&old);
    return free
               ? FFD_OK
               : ffd_fail_file(error, FFD_E_EXISTS, path, "exists and is not a %s: it is not replaced", kind);
}
