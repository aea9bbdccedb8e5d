#include "base/file/glob.h"
#include "base/file/folder_entries.h"
#include "base/file/path.h"
#include "base/file/pattern.h"
#include "base/memory/memory.h"
#include "base/posix.h"
#include "base/system/interrupt.h"
#include <errno.h>
#include <string.h>

typedef struct search {
    const char *pattern; /* the whole one, for messages */
    path_list *found;
} search;

/* The next part of a pattern: names without wildcards, and one with. Each length includes the separators
   behind. */
typedef struct pattern_part {
    size_t plain, wild;
    size_t name; /* of the one with wildcards, without separators */
} pattern_part;

static pattern_part split(const char *pattern)
{
    pattern_part part = {0};
    for (size_t end = 0; pattern[part.plain]; part.plain = end) {
        while (pattern[end] && !ffd_is_separator(pattern[end]))
            end++;
        part.name = end - part.plain;
        while (ffd_is_separator(pattern[end]))
            end++;
        part.wild = end - part.plain;
        if (ffd_pattern_has_wildcards(pattern + part.plain, part.name))
            return part;
    }
    part.wild = part.name = 0;
    return part;
}

/* Returns whether a path leads to something; one that ends in a separator, to a folder. */
static bool is_there(const char *path)
{
    struct stat info;
    const size_t length = strlen(path);
    return length > 0 && ffd_is_separator(path[length - 1]) ? stat(path, &info) == 0 && S_ISDIR(info.st_mode)
                                                            : lstat(path, &info) == 0;
}

/* Returns `path` with `length` characters of `name` and `more` of `behind`; NULL if memory runs out. */
static char *append(const char *path, const char *name, size_t length, const char *behind, size_t more)
{
    const size_t before = strlen(path);
    char *const text = ffd_alloc(before + length + more + 1, 1);
    if (!text)
        return NULL;
    memcpy(text, path, before);
    memcpy(text + before, name, length);
    memcpy(text + before + length, behind, more);
    text[before + length + more] = 0;
    return text;
}

static ffd_status find(const search *of, const char *path, const char *rest, ffd_error *error);

/* Goes on with an entry of the folder `path`; rest: of the pattern, behind the separators. */
static ffd_status take_entry(const search *of, const char *path, const char *name, const char *separators,
                             const char *rest, ffd_error *error)
{
    char *const below = append(path, name, strlen(name), separators, (size_t)(rest - separators));
    if (!below)
        return ffd_fail_memory(error);
    ffd_status status = FFD_OK;
    if (*rest)
        status = find(of, below, rest, error);
    else if (rest == separators || is_there(below))
        status = ffd_paths_add(of->found, below, error);
    ffd_free(below);
    return status;
}

/* Goes on with each entry of the folder `path` that matches the first name in `rest`. A folder may have
   millions of files on a slow disk: after a request to end the program, the listing stops. */
static ffd_status find_entries(const search *of, const char *path, const char *rest, pattern_part part,
                               ffd_error *error)
{
    const struct dirent *entry;
    if (ffd_interrupt_requested())
        return FFD_OK;
    DIR *const folder = opendir(*path ? path : ".");
    if (!folder) /* a folder that does not exist has no matches */
        return errno == ENOENT || errno == ENOTDIR
                   ? FFD_OK
                   : ffd_fail_file(error, FFD_E_IO, of->pattern, "a folder cannot be read: %s",
                                   strerror(errno));
    ffd_status status = FFD_OK;
    while (!status && !ffd_interrupt_requested()) {
        status = ffd_folder_next(folder, of->pattern, &entry, error);
        if (status || !entry)
            break;
        if (ffd_pattern_matches(rest, part.name, entry->d_name))
            status = take_entry(of, path, entry->d_name, rest + part.name, rest + part.wild, error);
    }
    closedir(folder);
    return status;
}

/* Finds what matches `rest` below the folder `path`, which ends in a separator or is empty. */
static ffd_status find(const search *of, const char *path, const char *rest, ffd_error *error)
{
    const pattern_part part = split(rest);
    char *const folder = append(path, rest, part.plain, "", 0);
    ffd_status status = FFD_OK;
    if (!folder)
        return ffd_fail_memory(error);
    ffd_pattern_unescape(folder + strlen(path));
    if (part.wild)
        status = find_entries(of, folder, rest + part.plain, part, error);
    else if (is_there(folder))
        status = ffd_paths_add(of->found, folder, error);
    ffd_free(folder);
    return status;
}

static int compare(const void *a, const void *b)
{
    return strcmp(*(const char *const *)a, *(const char *const *)b);
}

ffd_status ffd_glob(const char *pattern, path_list *found, ffd_error *error)
{
    const search of = {pattern, found};
    const ffd_status status = find(&of, "", pattern, error);
    if (status || ffd_interrupt_requested())
        ffd_paths_free(found);
    else if (found->count > 0)
        qsort(found->paths, found->count, sizeof *found->paths, compare);
    return status;
}
