/* Preloaded into a program (LD_PRELOAD): opening a file for reading triggers a fault if its name contains one
   of these words. "abort", "segv", "kill": the program ends in this way. "sleep": the call never returns.
   "nomemory": all allocations fail until another file is opened. */
#define _GNU_SOURCE
#undef _FILE_OFFSET_BITS /* open and open64 must be two functions here */
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

void *__libc_malloc(size_t size);
void *__libc_calloc(size_t count, size_t size);
void *__libc_realloc(void *block, size_t size);
int __open_2(const char *path, int flags);
int __open64_2(const char *path, int flags);

static volatile bool exhausted;

static void spring(const char *path)
{
    const char *slash = strrchr(path, '/');
    const char *name = slash ? slash + 1 : path;
    exhausted = strstr(name, "nomemory") != NULL;
    if (strstr(name, "abort"))
        abort();
    if (strstr(name, "segv"))
        raise(SIGSEGV);
    if (strstr(name, "kill"))
        raise(SIGKILL);
    while (strstr(name, "sleep"))
        pause();
}

static bool reads(int flags)
{
    return (flags & O_ACCMODE) == O_RDONLY;
}

/* Finds the library's function of this name, which the one here replaces. */
static void find(const char *name, void *function)
{
    void *const found = dlsym(RTLD_NEXT, name);
    memcpy(function, &found, sizeof found);
}

static int open_as(const char *function, const char *path, int flags, int mode)
{
    int (*real)(const char *, int, ...);
    find(function, &real);
    if (reads(flags))
        spring(path);
    return real(path, flags, mode);
}

static FILE *fopen_as(const char *function, const char *path, const char *mode)
{
    FILE *(*real)(const char *, const char *);
    find(function, &real);
    if (mode[0] == 'r')
        spring(path);
    return real(path, mode);
}

static int mode_of(int flags, va_list more)
{
    return flags & O_CREAT ? va_arg(more, int) : 0;
}

int open(const char *path, int flags, ...)
{
    va_list more;
    va_start(more, flags);
    const int mode = mode_of(flags, more);
    va_end(more);
    return open_as("open", path, flags, mode);
}

int open64(const char *path, int flags, ...)
{
    va_list more;
    va_start(more, flags);
    const int mode = mode_of(flags, more);
    va_end(more);
    return open_as("open64", path, flags, mode);
}

/* Called in place of open with -D_FORTIFY_SOURCE, if the flags are not constant. */
int __open_2(const char *path, int flags)
{
    return open_as("__open_2", path, flags, 0);
}

int __open64_2(const char *path, int flags)
{
    return open_as("__open64_2", path, flags, 0);
}

FILE *fopen(const char *path, const char *mode)
{
    return fopen_as("fopen", path, mode);
}

FILE *fopen64(const char *path, const char *mode)
{
    return fopen_as("fopen64", path, mode);
}

void *malloc(size_t size)
{
    return exhausted ? (errno = ENOMEM, NULL) : __libc_malloc(size);
}

void *calloc(size_t count, size_t size)
{
    return exhausted ? (errno = ENOMEM, NULL) : __libc_calloc(count, size);
}

void *realloc(void *block, size_t size)
{
    return exhausted ? (errno = ENOMEM, NULL) : __libc_realloc(block, size);
}
