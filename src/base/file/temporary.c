#define _DEFAULT_SOURCE /* flock, realpath */
#include "base/file/temporary.h"
#include "base/file/input.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

/* The longest name that file systems take, less what is added to it. */
#define LONGEST_NAME 255
#define NAME_SUFFIX ".ffd-tmp"

/* FNV-1a (Fowler, Noll, Vo): distinguishes names that start alike. */
static unsigned long long digest_of(const char *text)
{
    unsigned long long digest = 14695981039346656037ULL;
    for (; *text; text++)
        digest = (digest ^ (unsigned char)*text) * 1099511628211ULL;
    return digest;
}

char *ffd_temporary_name(const char *target)
{
    const char *name = ffd_path_name(target);
    const size_t folder = (size_t)(name - target), length = strlen(name);
    const size_t capacity = strlen(target) + sizeof "..0123456789abcdef" NAME_SUFFIX;
    char *text = ffd_alloc(capacity, 1);
    if (!text)
        return NULL;
    if (length + sizeof "." NAME_SUFFIX - 1 <= LONGEST_NAME)
        snprintf(text, capacity, "%.*s.%s" NAME_SUFFIX, (int)folder, target, name);
    else
        snprintf(text, capacity, "%.*s.%.200s.%016llx" NAME_SUFFIX, (int)folder, target, name,
                 digest_of(name));
    return text;
}

/* Locks a file against other runs. 1: done; 0: it is no longer the one of that name, as its owner has renamed
   or removed it between our open and our lock; -1: errno says why not; EBUSY: another run holds it. */
static int lock_named(int fd, const char *path)
{
    struct stat ours, there;
    if (flock(fd, LOCK_EX | LOCK_NB) != 0) {
        errno = errno == EWOULDBLOCK ? EBUSY : errno;
        return -1;
    }
    if (fstat(fd, &ours) != 0)
        return -1;
    if (!S_ISREG(ours.st_mode)) {
        errno = EEXIST;
        return -1;
    }
    return stat(path, &there) == 0 && ours.st_ino == there.st_ino && ours.st_dev == there.st_dev;
}

/* Opens what a run has left, to be locked: for writing, which some file systems want for that, if it may be.
 */
static int open_left(const char *path)
{
    const int flags = O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC;
    const int fd = open(path, O_WRONLY | flags);
    return fd < 0 && errno == EACCES ? open(path, O_RDONLY | flags) : fd;
}

int ffd_temporary_open(const char *path)
{
    int fd, locked;
    do {
        bool is_new = true;
        fd = open(path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (fd < 0 && errno == EEXIST) {
            is_new = false;
            fd = open_left(path);
        }
        locked = fd >= 0 ? lock_named(fd, path) : is_new || errno != ENOENT ? -1 : 0;
        if (locked > 0 && !is_new)
            locked = unlink(path);
        if (locked <= 0 && fd >= 0) {
            const int reason = errno;
            close(fd);
            errno = reason;
        }
    } while (locked == 0);
    return locked > 0 ? fd : -1;
}

static void discard_one(const char *target)
{
    char *const name = ffd_temporary_name(target);
    const int fd = name && ffd_file_exists(name) ? ffd_temporary_open(name) : -1;
    if (fd >= 0) {
        unlink(name);
        close(fd);
    }
    ffd_free(name);
}

void ffd_temporary_discard(const char *path)
{
    char *const target = realpath(path, NULL), *const stem = ffd_path_stem(path);
    discard_one(target ? target : path);
    free(target);
    const size_t capacity = stem ? strlen(stem) + 40 : 0;
    char *const name = stem ? ffd_alloc(capacity, 1) : NULL;
    bool more = name && ffd_path_has_ending(path, ".gltf");
    for (unsigned i = 0; more; i++) {
        snprintf(name, capacity, i ? "%s-%u.bin" : "%s.bin", stem, i);
        char *const buffer = ffd_path_beside(path, name);
        char *const begun = buffer ? ffd_temporary_name(buffer) : NULL;
        more = begun && (i == 0 || ffd_file_exists(begun));
        if (more)
            discard_one(buffer);
        ffd_free(begun);
        ffd_free(buffer);
    }
    ffd_free(name);
    ffd_free(stem);
}
