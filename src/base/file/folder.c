#define _XOPEN_SOURCE 700 /* realpath, readlink */
#include "base/file/folder.h"
#include "base/file/input.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include <dirent.h>
#include <errno.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* As many symbolic links in a row as systems follow. */
#define MOST_LINKS 40

/* Returns the end of the next folder's name in a path, at or after the offset `at`; 0 if there is none. */
static size_t next_folder(const char *path, size_t at)
{
    for (size_t i = at; path[i]; i++)
        if (path[i + 1] == '/' || path[i + 1] == 0)
            return i + 1;
    return 0;
}

ffd_status ffd_folder_make(const char *path, size_t *made, ffd_error *error)
{
    char *partial = ffd_text_copy(path);
    *made = 0;
    if (!partial)
        return ffd_fail_memory(error);
    ffd_status status = FFD_OK;
    for (size_t end = next_folder(path, 0); end; end = next_folder(path, end)) {
        partial[end] = 0;
        if (mkdir(partial, 0777) == 0)
            *made = *made ? *made : end;
        else if (errno != EEXIST && !ffd_file_exists(partial))
            TRY_END(
                ffd_fail_file(error, FFD_E_IO, partial, "the folder cannot be made: %s", strerror(errno)));
        partial[end] = path[end];
    }
end:
    ffd_free(partial);
    return status;
}

void ffd_folder_unmake(char *path, size_t made)
{
    for (size_t end = strlen(path); made && end >= made; end--) {
        if (path[end] != '/' && path[end] != 0)
            continue;
        path[end] = 0;
        rmdir(path);
    }
}

static int compare(const void *a, const void *b)
{
    return strcmp(*(const char *const *)a, *(const char *const *)b);
}

ffd_status ffd_folder_list(const char *path, path_list *names, ffd_error *error)
{
    DIR *const folder = opendir(path);
    const struct dirent *entry;
    const size_t before = names->count;
    ffd_status status = FFD_OK;
    while (folder && (entry = readdir(folder)) != NULL)
        TRY_END(ffd_paths_add(names, entry->d_name, error));
end:
    if (folder)
        closedir(folder);
    if (names->count > before)
        qsort(names->paths + before, names->count - before, sizeof *names->paths, compare);
    return status;
}

bool ffd_folders_differ(const char *file, const char *other)
{
    char *const here = ffd_path_folder(file), *const there = ffd_path_folder(other);
    const bool differ = here && there && !ffd_file_same(here, there);
    ffd_free(here);
    ffd_free(there);
    return differ;
}

bool ffd_paths_meet(const char *a, const char *b)
{
    if (strcmp(a, b) == 0 || ffd_file_same(a, b))
        return true;
    if (ffd_file_exists(a) || ffd_file_exists(b) || strcmp(ffd_path_name(a), ffd_path_name(b)) != 0)
        return false;
    char *const here = ffd_path_folder(a), *const there = ffd_path_folder(b);
    const bool meet = here && there && (strcmp(here, there) == 0 || ffd_file_same(here, there));
    ffd_free(here);
    ffd_free(there);
    return meet;
}

char *ffd_path_resolve(const char *path)
{
    char *resolved = realpath(path, NULL);
    char *copy = resolved ? ffd_text_copy(resolved) : NULL;
    free(resolved);
    return copy;
}

char *ffd_path_follow(const char *path)
{
    char *at = ffd_text_copy(path);
    for (int links = 0; at && links < MOST_LINKS; links++) {
        char link[PATH_MAX];
        const ssize_t length = readlink(at, link, sizeof link - 1);
        if (length < 0)
            return at;
        link[length] = 0;
        char *const next = ffd_path_is_absolute(link) ? ffd_text_copy(link) : ffd_path_sibling(at, link);
        ffd_free(at);
        at = next;
    }
    const bool is_circle = at != NULL;
    ffd_free(at);
    return is_circle ? ffd_text_copy(path) : NULL;
}
