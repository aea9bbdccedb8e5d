/* Preloaded into a program (LD_PRELOAD): truncates a file whose name contains "cut" as soon as it is mapped,
   as if another program overwrote it. FFD_CUT is its new size. */
#define _GNU_SOURCE
#undef _FILE_OFFSET_BITS /* mmap and mmap64 must be two functions here */
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

static void cut(int fd)
{
    char link[64], path[4096];
    snprintf(link, sizeof link, "/proc/self/fd/%d", fd);
    const ssize_t length = fd < 0 ? -1 : readlink(link, path, sizeof path - 1);
    if (length <= 0)
        return;
    path[length] = 0;
    const char *const slash = strrchr(path, '/'), *const size = getenv("FFD_CUT");
    if (slash && strstr(slash, "cut") && truncate(path, size ? atol(size) : 0) != 0)
        abort();
}

static void *map_as(const char *function, void *address, size_t size, int protection, int flags, int fd,
                    off64_t offset)
{
    void *(*real)(void *, size_t, int, int, int, off64_t);
    void *const found = dlsym(RTLD_NEXT, function);
    memcpy(&real, &found, sizeof found);
    void *const block = real(address, size, protection, flags, fd, offset);
    if (block != MAP_FAILED)
        cut(fd);
    return block;
}

void *mmap(void *address, size_t size, int protection, int flags, int fd, off_t offset)
{
    return map_as("mmap", address, size, protection, flags, fd, offset);
}

void *mmap64(void *address, size_t size, int protection, int flags, int fd, off64_t offset)
{
    return map_as("mmap64", address, size, protection, flags, fd, offset);
}
