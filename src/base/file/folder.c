#define _XOPEN_SOURCE 700 /* realpath, readlink */
#include "base/file/folder.h"
#include "base/file/folder_entries.h"
#include "base/file/input.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "base/posix.h"
#include <errno.h>
#include <string.h>

/* As many symbolic links in a row as systems follow. */
#define MOST_LINKS 40

/* How often the making of a folder begins again. */
#define MOST_AGAIN 20

/* Returns the end of the next folder's name in a path, at or after the offset `at`; 0 if there is none. */
static size_t next_folder(const char *path, size_t at)
{
    for (size_t i = at; path[i]; i++)
        if (ffd_is_separator(path[i + 1]) || path[i + 1] == 0)
            return i + 1;
    return 0;
}

/* Makes the folder that partial names so far. *made: as of ffd_folder_make. */
static int make_one(const char *partial, size_t end, size_t *made)
{
    if (mkdir(partial, 0777) != 0) {
        const int reason = errno; /* looking for the folder sets another one */
        return reason == EEXIST || ffd_file_exists(partial) ? 0 : reason;
    }
    if (!*made || end < *made)
        *made = end;
    return 0;
}

ffd_status ffd_folder_make(const char *path, size_t *made, ffd_error *error)
{
    char *partial = ffd_text_copy(path);
    *made = 0;
    if (!partial)
        return ffd_fail_memory(error);
    ffd_status status = FFD_OK;
    int again = 0;
    for (size_t end = next_folder(path, 0); end; end = next_folder(path, end)) {
        partial[end] = 0;
        const int reason = make_one(partial, end, made);
        if (reason && !(reason == ENOENT && again < MOST_AGAIN))
            TRY_END(
                ffd_fail_file(error, FFD_E_IO, partial, "the folder cannot be made: %s", strerror(reason)));
        partial[end] = path[end];
        if (reason) { /* another run has removed a folder above, which it had made */
            again++;
            end = 0;
        }
    }
end:
    ffd_free(partial);
    return status;
}

bool ffd_folder_is_there(const char *path)
{
    struct stat info;
    return stat(path, &info) == 0 && S_ISDIR(info.st_mode);
}

/* Returns the part of a path that is there, or "." for a relative one; NULL if memory runs out. */
static char *find_existing(const char *path)
{
    struct stat info;
    char *at = ffd_text_copy(path);
    while (at && lstat(at, &info) != 0 && errno == ENOENT && strcmp(at, ".") != 0) {
        char *const above = ffd_path_folder(at);
        if (above && strcmp(above, at) == 0) { /* a drive that is not there */
            ffd_free(above);
            return at;
        }
        ffd_free(at);
        at = above;
    }
    return at;
}

ffd_status ffd_folder_check(const char *path, ffd_error *error)
{
    if (ffd_folder_is_there(path))
        return FFD_OK;
    char *const there = find_existing(path);
    TRY(there ? FFD_OK : ffd_fail_memory(error));
    ffd_status status = FFD_OK;
    if (!ffd_folder_is_there(there))
        status =
            ffd_fail_file(error, FFD_E_IO, path, "the folder cannot be made: \"%s\" is not a folder", there);
    else if (access(there, W_OK | X_OK) != 0)
        status = ffd_fail_file(error, FFD_E_IO, path, "the folder cannot be made: %s", strerror(errno));
    ffd_free(there);
    return status;
}

ffd_status ffd_check_output_folder(const char *folder, ffd_error *error)
{
    struct stat info;
    char *const there = find_existing(folder);
    TRY(there ? FFD_OK : ffd_fail_memory(error));
    const bool is_refused = stat(there, &info) == 0 ? !S_ISDIR(info.st_mode) : errno == ENOTDIR;
    ffd_free(there);
    return is_refused ? ffd_fail_file(error, FFD_E_IO, folder, "is not a folder") : FFD_OK;
}

void ffd_folder_unmake(char *path, size_t made)
{
    for (size_t end = strlen(path); made && end >= made; end--) {
        if (!ffd_is_separator(path[end]) && path[end] != 0)
            continue;
        path[end] = 0;
        rmdir(path);
    }
}

static int compare(const void *a, const void *b)
{
    return strcmp(*(const char *const *)a, *(const char *const *)b);
}

ffd_status ffd_folder_next(DIR *folder, const char *path, const struct dirent **entry, ffd_error *error)
{
    errno = 0;
    *entry = readdir(folder);
    return *entry || !errno ? FFD_OK
                            : ffd_fail_file(error, FFD_E_IO, path,
                                            "cannot be read to its end as a folder: %s", strerror(errno));
}

ffd_status ffd_folder_list(const char *path, path_list *names, ffd_error *error)
{
    DIR *const folder = opendir(path);
    const struct dirent *entry;
    const size_t before = names->count;
    ffd_status status = FFD_OK;
    while (folder) {
        TRY_END(ffd_folder_next(folder, path, &entry, error));
        if (!entry)
            break;
        TRY_END(ffd_paths_add(names, entry->d_name, error));
    }
end:
    if (folder)
        closedir(folder);
    if (names->count > before)
        qsort(names->paths + before, names->count - before, sizeof *names->paths, compare);
    return status;
}

/* Adds an entry of a folder, named relative to `top`, to the files or to the folders that are still to be
   read. */
static ffd_status add_entry(const char *top, const char *name, path_list *files, path_list *folders,
                            ffd_error *error)
{
    struct stat info;
    char *const path = ffd_path_join(top, name);
    TRY(path ? FFD_OK : ffd_fail_memory(error));
    const bool is_there = lstat(path, &info) == 0;
    const bool is_folder = is_there && S_ISDIR(info.st_mode);
    const bool is_file = is_there && !is_folder && stat(path, &info) == 0 && S_ISREG(info.st_mode);
    ffd_free(path);
    return is_folder ? ffd_paths_add(folders, name, error)
           : is_file ? ffd_paths_add(files, name, error)
                     : FFD_OK;
}

/* Reads the folder `name` below top; "": top itself. */
static ffd_status read_below(const char *top, const char *name, path_list *files, path_list *folders,
                             ffd_error *error)
{
    char *const path = *name ? ffd_path_join(top, name) : ffd_text_copy(top);
    TRY(path ? FFD_OK : ffd_fail_memory(error));
    DIR *const folder = opendir(path);
    const struct dirent *entry;
    ffd_status status =
        folder ? FFD_OK
               : ffd_fail_file(error, FFD_E_IO, path, "cannot be read as a folder: %s", strerror(errno));
    while (!status) {
        status = ffd_folder_next(folder, path, &entry, error);
        if (status || !entry)
            break;
        if (strcmp(entry->d_name, ".") == 0 || strcmp(entry->d_name, "..") == 0)
            continue;
        char *const below = *name ? ffd_path_join(name, entry->d_name) : ffd_text_copy(entry->d_name);
        status = below ? add_entry(top, below, files, folders, error) : ffd_fail_memory(error);
        ffd_free(below);
    }
    if (folder)
        closedir(folder);
    ffd_free(path);
    return status;
}

ffd_status ffd_folder_walk(const char *path, path_list *files, ffd_error *error)
{
    path_list folders = {0};
    const size_t before = files->count;
    ffd_status status = ffd_paths_add(&folders, "", error);
    for (size_t i = 0; i < folders.count && !status; i++) {
        char *const name = ffd_text_copy(folders.paths[i]); /* the list grows */
        status = name ? read_below(path, name, files, &folders, error) : ffd_fail_memory(error);
        ffd_free(name);
    }
    ffd_paths_free(&folders);
    if (files->count > before)
        qsort(files->paths + before, files->count - before, sizeof *files->paths, compare);
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
    if (ffd_file_exists(a) || ffd_file_exists(b) || !ffd_names_equal(ffd_path_name(a), ffd_path_name(b)))
        return false;
    char *const here = ffd_path_folder(a), *const there = ffd_path_folder(b);
    const bool meet = here && there && (ffd_names_equal(here, there) || ffd_file_same(here, there));
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
