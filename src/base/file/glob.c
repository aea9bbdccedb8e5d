#define _DEFAULT_SOURCE /* GLOB_ALTDIRFUNC */
#include "base/file/glob.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "base/system/interrupt.h"
#include <dirent.h>
#include <errno.h>
#include <glob.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* A folder may have millions of files on a slow disk: after a request to end the program, the listing
   stops. */
#ifdef GLOB_ALTDIRFUNC
#define OWN_CALLS GLOB_ALTDIRFUNC

static void *open_folder(const char *path)
{
    if (!ffd_interrupt_requested())
        return opendir(path);
    errno = EINTR;
    return NULL;
}

static void close_folder(void *folder)
{
    closedir(folder);
}

static void *next_entry(void *folder)
{
    return ffd_interrupt_requested() ? NULL : readdir(folder);
}

static int stat_path(const char *path, void *info)
{
    return stat(path, info);
}

static int stat_link(const char *path, void *info)
{
    return lstat(path, info);
}

static void use_own_calls(glob_t *found)
{
    found->gl_opendir = open_folder;
    found->gl_readdir = next_entry;
    found->gl_closedir = close_folder;
    found->gl_stat = stat_path;
    found->gl_lstat = stat_link;
}
#else
#define OWN_CALLS 0

static void use_own_calls(glob_t *found)
{
    (void)found;
}
#endif

static int compare(const void *a, const void *b)
{
    return strcmp(*(const char *const *)a, *(const char *const *)b);
}

static int refuse(const char *path, int reason)
{
    (void)path;
    errno = reason;
    return reason != ENOENT && reason != ENOTDIR; /* a folder that does not exist has no matches */
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
    /* Sorted by bytes: glob would sort by the locale. */
    qsort(list->paths, list->count, sizeof *list->paths, compare);
    return FFD_OK;
}

ffd_status ffd_glob(const char *pattern, file_list *list, ffd_error *error)
{
    glob_t found = {0};
    *list = (file_list){0};
    use_own_calls(&found);
    errno = 0;
    const int result = glob(pattern, GLOB_NOSORT | OWN_CALLS, refuse, &found);
    const int reason = errno;
    ffd_status status = FFD_OK;
    if (result == GLOB_NOSPACE)
        status = ffd_fail_memory(error);
    else if (result == 0 && !ffd_interrupt_requested())
        status = copy(&found, list, error);
    else if (result == GLOB_ABORTED && !ffd_interrupt_requested())
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
