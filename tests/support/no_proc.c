/* Preloaded into a program (LD_PRELOAD): nothing is below /proc, as in a chroot or a sandbox without it. */
#define _GNU_SOURCE
#undef _FILE_OFFSET_BITS /* fopen and fopen64 must be two functions here */
#include <dlfcn.h>
#include <errno.h>
#include <spawn.h>
#include <stdio.h>
#include <string.h>

/* Finds the library's function of this name, which the one here replaces. */
static void find(const char *name, void *function)
{
    void *const found = dlsym(RTLD_NEXT, name);
    memcpy(function, &found, sizeof found);
}

static FILE *fopen_as(const char *function, const char *path, const char *mode)
{
    FILE *(*real)(const char *, const char *);
    find(function, &real);
    if (strncmp(path, "/proc/", 6) != 0)
        return real(path, mode);
    errno = ENOENT;
    return NULL;
}

FILE *fopen(const char *path, const char *mode)
{
    return fopen_as("fopen", path, mode);
}

FILE *fopen64(const char *path, const char *mode)
{
    return fopen_as("fopen64", path, mode);
}

int posix_spawn(pid_t *id, const char *path, const posix_spawn_file_actions_t *actions,
                const posix_spawnattr_t *attributes, char *const arguments[], char *const environment[])
{
    int (*real)(pid_t *, const char *, const posix_spawn_file_actions_t *, const posix_spawnattr_t *,
                char *const[], char *const[]);
    find("posix_spawn", &real);
    return strncmp(path, "/proc/", 6) == 0 ? ENOENT
                                           : real(id, path, actions, attributes, arguments, environment);
}
