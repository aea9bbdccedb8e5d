#include "base/file/glob.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include <errno.h>
#include <glob.h>
#include <stdlib.h>
#include <string.h>

static int compare(const void *a, const void *b)
{
    return strcmp(*(const char *const *)a, *(const char *const *)b);
}

static int refuse(const char *path, int reason)
{
    (void)path;
    errno = reason;
    return reason != ENOENT && reason != ENOTDIR; /* in a folder that is not there nothing matches */
}

static ffd_status copy(const glob_t *found, file_list *list, ffd_error *error)
{
    list->paths = ffd_alloc_zero(found->gl_pathc, sizeof *list->paths);
    if (!list->paths)
        return ffd_fail_memory(error);
    for (size_t i = 0; i < found->gl_pathc; i++, list->count++) {
        list->paths[i] = ffd_text_copy(found->gl_pathv[i]);
        if (!list->paths[i])
            return ffd_fail_memory(error);
    }
    /* Not in the order of a locale. */
    qsort(list->paths, list->count, sizeof *list->paths, compare);
    return FFD_OK;
}

ffd_status ffd_glob(const char *pattern, file_list *list, ffd_error *error)
{
    glob_t found;
    *list = (file_list){0};
    errno = 0;
    const int result = glob(pattern, GLOB_NOSORT, refuse, &found);
    const int reason = errno;
    ffd_status status = FFD_OK;
    if (result == 0)
        status = copy(&found, list, error);
    else if (result == GLOB_NOSPACE)
        status = ffd_fail_memory(error);
    else if (result != GLOB_NOMATCH)
        status = ffd_fail_file(error, FFD_E_IO, pattern, "a folder cannot be read: %s", strerror(reason));
    if (result != GLOB_NOSPACE)
        globfree(&found);
    if (status)
        ffd_glob_free(list);
    return status;
}

void ffd_glob_free(file_list *list)
{
    for (size_t i = 0; i < list->count; i++)
        ffd_free(list->paths[i]);
    ffd_free(list->paths);
    *list = (file_list){0};
}
