#define _GNU_SOURCE /* flock, realpath, renameat2 */
#include "base/file/temporary.h"
#include "base/file/input.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "base/posix.h"
#include <errno.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>

/* The longest file name that file systems accept, in bytes. */
#define LONGEST_NAME 255

/* FNV-1a (Fowler, Noll, Vo), to distinguish long names with the same beginning. */
static unsigned long long digest_of(const char *text)
{
    unsigned long long digest = 14695981039346656037ULL;
    for (; *text; text++)
        digest = (digest ^ (unsigned char)*text) * 1099511628211ULL;
    return digest;
}

char *ffd_hidden_name(const char *target, const char *ending)
{
    const char *name = ffd_path_name(target);
    const size_t folder = (size_t)(name - target), length = strlen(name);
    const size_t capacity = strlen(target) + strlen(ending) + sizeof "..0123456789abcdef";
    char *text = ffd_alloc(capacity, 1);
    if (!text)
        return NULL;
    if (1 + length + strlen(ending) <= LONGEST_NAME)
        snprintf(text, capacity, "%.*s.%s%s", (int)folder, target, name, ending);
    else
        snprintf(text, capacity, "%.*s.%.200s.%016llx%s", (int)folder, target, name, digest_of(name), ending);
    return text;
}

char *ffd_temporary_name(const char *target)
{
    return ffd_hidden_name(target, ".ffd-tmp");
}

/* Whether a file could not be locked because its file system has no locks. */
static atomic_bool lacks_locks;

/* Whether the last call failed because the system or the file system does not have it. The last two are one
   on most systems. */
static bool is_not_there(void)
{
    return errno == ENOSYS || errno == ENOTSUP || errno == EOPNOTSUPP;
}

/* Whether the last call failed for this reason. */
static bool has_no_locks(void)
{
    if (errno != ENOLCK && !is_not_there())
        return false;
    atomic_store(&lacks_locks, true);
    return true;
}

int ffd_lock_named(int fd, const char *path)
{
    struct stat ours, there;
    if (flock(fd, LOCK_EX | LOCK_NB) != 0 && !has_no_locks()) {
        errno = errno == EWOULDBLOCK ? EBUSY : errno;
        return -1;
    }
    if (fstat(fd, &ours) != 0)
        return -1;
    if (!S_ISREG(ours.st_mode)) {
        errno = EEXIST;
        return -1;
    }
    /* Another run may have renamed or removed the file between open and lock. */
    return lstat(path, &there) == 0 && ours.st_ino == there.st_ino && ours.st_dev == there.st_dev;
}

bool ffd_names_other(int fd, const char *path)
{
    struct stat ours, there;
    return atomic_load(&lacks_locks) && lstat(path, &there) == 0 && fstat(fd, &ours) == 0 &&
           (ours.st_ino != there.st_ino || ours.st_dev != there.st_dev);
}

/* Opens the leftover of another run to lock it; for writing if possible, because some file systems require
   that for a lock. */
static int open_left(const char *path)
{
    const int flags = O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC;
    const int fd = open(path, O_WRONLY | flags);
    return fd < 0 && errno == EACCES ? open(path, O_RDONLY | flags) : fd;
}

/* Closes a file and, unless its path is NULL, removes it. Keeps errno. */
static void drop(int fd, const char *path)
{
    const int reason = errno;
    if (path)
        unlink(path);
    close(fd);
    errno = reason;
}

int ffd_temporary_open(const char *path)
{
    int fd, locked;
    do {
        bool is_new = true;
        fd = open(path, O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
        if (fd < 0 && errno == EEXIST) {
            is_new = false;
            fd = open_left(path);
        }
        locked = fd >= 0 ? ffd_lock_named(fd, path) : is_new || errno != ENOENT ? -1 : 0;
        if (locked > 0 && !is_new)
            locked = unlink(path);
        if (locked <= 0 && fd >= 0)
            drop(fd, is_new && locked < 0 && errno != EBUSY ? path : NULL);
    } while (locked == 0);
    return locked > 0 ? fd : -1;
}

/* Returns what stands at a path that is not a regular file; NULL: one does, or nothing. */
static const char *kind_in_the_way(const char *path)
{
    struct stat info;
    if (lstat(path, &info) != 0 || S_ISREG(info.st_mode))
        return NULL;
    return S_ISLNK(info.st_mode)    ? "link"
           : S_ISDIR(info.st_mode)  ? "folder"
           : S_ISFIFO(info.st_mode) ? "pipe"
           : S_ISSOCK(info.st_mode) ? "socket"
                                    : "device";
}

ffd_status ffd_temporary_fail(int reason, const char *name, const char *target, ffd_error *error)
{
    const char *const kind = kind_in_the_way(name);
    if (reason == EBUSY)
        return ffd_fail_file(error, FFD_E_IO, target, "is being written by another run");
    if (kind)
        return ffd_fail_file(error, FFD_E_IO, target,
                             "cannot be written: a %s named %s stands where it is written first: remove that",
                             kind, ffd_path_name(name));
    if (ffd_file_exists(name))
        return ffd_fail_file(error, FFD_E_IO, target, "cannot be written: %s, left by another run: %s",
                             ffd_path_name(name), strerror(reason));
    errno = reason;
    return ffd_fail_errno(error, target, "cannot be written");
}

/* For file systems without the flags of renameat2. link() never replaces a file. On file systems without hard
   links there remains a race between the check and the rename. */
static int place_by_link(const char *from, const char *to)
{
    struct stat info;
    if (link(from, to) == 0) {
        if (unlink(from) == 0)
            return 0;
        const int reason = errno;
        unlink(to);
        errno = reason;
        return -1;
    }
    if (errno != EPERM && errno != EMLINK && !is_not_there())
        return -1;
    if (lstat(to, &info) == 0) {
        errno = EEXIST;
        return -1;
    }
    return rename(from, to);
}

int ffd_place(const char *from, const char *to, bool replace)
{
    if (replace)
        return rename(from, to);
#ifdef RENAME_NOREPLACE
    if (renameat2(AT_FDCWD, from, AT_FDCWD, to, RENAME_NOREPLACE) == 0)
        return 0;
    if (errno != EINVAL && !is_not_there())
        return -1;
#endif
    return place_by_link(from, to);
}

void ffd_temporary_remove(const char *target)
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
    ffd_temporary_remove(target ? target : path);
    free(target);
    const size_t capacity = stem ? strlen(stem) + 40 : 0;
    char *const name = stem ? ffd_alloc(capacity, 1) : NULL;
    bool more = name && ffd_path_has_ending(path, ".gltf");
    for (unsigned i = 0; more; i++) {
        snprintf(name, capacity, i ? "%s-%u.bin" : "%s.bin", stem, i);
        char *const buffer = ffd_path_sibling(path, name);
        char *const begun = buffer ? ffd_temporary_name(buffer) : NULL;
        more = begun && (i == 0 || ffd_file_exists(begun));
        if (more)
            ffd_temporary_remove(buffer);
        ffd_free(begun);
        ffd_free(buffer);
    }
    ffd_free(name);
    ffd_free(stem);
}
