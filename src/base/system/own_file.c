#define _GNU_SOURCE /* dladdr, lstat */
#include "base/system/own_file.h"
#include <dlfcn.h>
#include <inttypes.h>
#include <limits.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/auxv.h>
#elif defined(__APPLE__)
#include <mach-o/dyld.h>
#endif

/* What the system writes behind the path of a file that was deleted, or replaced by another. */
static const char deleted[] = " (deleted)";

static bool exists(const char *path)
{
    struct stat info;
    return stat(path, &info) == 0;
}

/* Takes the path of a mapped file. Returns false if it is too long. */
static bool take_path(const char *from, char path[LONGEST_PATH])
{
    const size_t length = strcspn(from, "\n"), ending = sizeof deleted - 1;
    if (length >= LONGEST_PATH)
        return false;
    memcpy(path, from, length);
    path[length] = 0;
    if (length > ending && strcmp(path + length - ending, deleted) == 0 && !exists(path))
        path[length - ending] = 0;
    return true;
}

/* Finds the file by what the system has mapped: a path without symbolic links, whatever name the file was
   started by. */
static bool find_mapped(const void *inside, char path[LONGEST_PATH])
{
    FILE *const maps = fopen("/proc/self/maps", "re");
    char *line = NULL;
    size_t capacity = 0;
    bool found = false;
    while (maps && !found && getline(&line, &capacity, maps) >= 0) {
        uintptr_t first, end;
        const char *const file = strchr(line, '/');
        if (file && sscanf(line, "%" SCNxPTR "-%" SCNxPTR, &first, &end) == 2)
            found = (uintptr_t)inside >= first && (uintptr_t)inside < end && take_path(file, path);
    }
    free(line);
    if (maps)
        fclose(maps);
    return found;
}

/* The name by which the system started the program that begins at `base`; NULL: unknown, or none does. */
static const char *find_program_name(const void *base, char room[LONGEST_PATH])
{
#ifdef __linux__
    /* The program is the object with the program headers that the system passed. */
    Dl_info program;
    (void)room;
    if (dladdr((const void *)getauxval(AT_PHDR), &program) && program.dli_fbase == base)
        return (const char *)getauxval(AT_EXECFN);
#elif defined(__APPLE__)
    uint32_t size = LONGEST_PATH;
    if (base == _dyld_get_image_header(0) && _NSGetExecutablePath(room, &size) == 0)
        return room;
#else
    (void)base;
    (void)room;
#endif
    return NULL;
}

/* The name by which the system started the program, or the loader found the library. A relative name of a
   library is not used: the process may have changed its folder since. NULL: unknown. */
static const char *find_name(const void *inside, char room[LONGEST_PATH])
{
    Dl_info object;
    if (!dladdr(inside, &object))
        return NULL;
    const char *const program = find_program_name(object.dli_fbase, room);
    return program ? program : object.dli_fname && object.dli_fname[0] == '/' ? object.dli_fname : NULL;
}

/* In a folder whose path is too long only a relative name would do, for which the loader of glibc 2.41 waits
   forever. */
static bool find_named(const void *inside, char path[LONGEST_PATH])
{
    _Static_assert(LONGEST_PATH >= PATH_MAX, "realpath writes that much");
    char room[LONGEST_PATH];
    const char *const name = find_name(inside, room);
    return name && realpath(name, path);
}

bool ffd_find_own_file(const void *inside, char path[LONGEST_PATH])
{
    char named[LONGEST_PATH];
    const bool is_mapped = find_mapped(inside, path);
    if ((is_mapped && exists(path)) || !find_named(inside, named))
        return is_mapped;
    memcpy(path, named, sizeof named);
    return true;
}

/* Returns whether a file belongs to somebody who may change what the program does anyway: the administrator,
   the user, or the owner of the program file. The folder of the program may be writable for others, who could
   put files there, or pipes, on which the loader would block. */
static bool is_trusted(const char *path, const struct stat *own)
{
    struct stat link, file;
    if (lstat(path, &link) != 0 || stat(path, &file) != 0 || !S_ISREG(file.st_mode) || file.st_mode & S_IWOTH)
        return false;
    const uid_t trusted[] = {0, geteuid(), own->st_uid};
    bool has_link = false, has_file = false;
    for (size_t i = 0; i < sizeof trusted / sizeof *trusted; i++) {
        has_link = has_link || link.st_uid == trusted[i];
        has_file = has_file || file.st_uid == trusted[i];
    }
    return has_link && has_file;
}

/* Finds the folder of the program or library that this is linked into, and what is known of that file. */
static bool find_own_folder(const void *inside, char folder[LONGEST_PATH], struct stat *own)
{
    if (!ffd_find_own_file(inside, folder))
        return false;
    if (stat(folder, own) != 0)
        own->st_uid = geteuid(); /* it was deleted: there is no owner to trust */
    *strrchr(folder, '/') = 0;
    return true;
}

bool ffd_find_near(const char *const *folders, size_t count, const char *file, char path[LONGEST_PATH],
                   bool *is_known)
{
    char own[LONGEST_PATH], tried[LONGEST_PATH];
    struct stat own_info = {0}, info;
    bool is_refused = false;
    *is_known = find_own_folder(folders, own, &own_info);
    for (size_t i = 0; i < count; i++) {
        const bool is_absolute = folders[i][0] == '/';
        if (!is_absolute && !*is_known)
            continue;
        const int length = snprintf(tried, LONGEST_PATH, "%s%s%s/%s", is_absolute ? "" : own,
                                    is_absolute ? "" : "/", folders[i], file);
        if (length >= LONGEST_PATH)
            continue;
        const bool is_there = lstat(tried, &info) == 0;
        const bool is_good = is_there && is_trusted(tried, &own_info);
        if (is_good || !is_refused)
            memcpy(path, tried, sizeof tried);
        if (is_good)
            return true;
        is_refused = is_refused || is_there;
    }
    return !is_refused;
}
