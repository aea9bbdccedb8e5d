#define _XOPEN_SOURCE 700 /* realpath */
#include "base/file.h"
#include "base/memory.h"
#include "base/path.h"
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

ffd_status ffd_folder_make(const char *path, ffd_error *error)
{
    char *partial = ffd_text_copy(path);
    if (!partial)
        return ffd_fail_memory(error);
    ffd_status status = FFD_OK;
    for (char *c = partial; status == FFD_OK && *c; c++) {
        if (c[1] != '/' && c[1] != 0)
            continue;
        const char kept = c[1];
        c[1] = 0;
        if (mkdir(partial, 0777) != 0 && errno != EEXIST && !ffd_file_exists(partial))
            status =
                ffd_fail_file(error, FFD_E_IO, partial, "the folder cannot be made: %s", strerror(errno));
        c[1] = kept;
    }
    ffd_free(partial);
    return status;
}

char *ffd_path_resolve(const char *path)
{
    char *resolved = realpath(path, NULL);
    char *copy = resolved ? ffd_text_copy(resolved) : NULL;
    free(resolved);
    return copy;
}
