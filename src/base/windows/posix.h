/* posix.h - the calls of POSIX that base/posix.h names, on Windows: files.c, folders.c, views.c. Paths are
   UTF-8 with '/' or '\', of any length; files are opened so that others may read, write, rename and delete
   them meanwhile; nothing is translated in them; errno is set. What Windows does not have (owners, permission
   bits) is as if all files belonged to the user. */
#ifndef FFD_BASE_WINDOWS_POSIX_H
#define FFD_BASE_WINDOWS_POSIX_H

#include "base/windows/path_flaw.h"
#include <errno.h>
#include <fcntl.h>
#include <io.h>
#include <limits.h>
#include <process.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <time.h>

/* Errors */

/* A file that another program has open for itself, or mapped. */
#define strerror(number) ffd_strerror(number)
const char *ffd_strerror(int number);

/* Returns a variable of the environment in UTF-8, valid until the fourth next call in this thread. */
#define getenv(name) ffd_getenv(name)
char *ffd_getenv(const char *name);

/* Files */

#define getpid() _getpid()

#define STDIN_FILENO 0
#define STDOUT_FILENO 1
#define STDERR_FILENO 2

#define O_CLOEXEC O_NOINHERIT
#define O_NONBLOCK 0
#define O_NOCTTY 0
#define O_NOFOLLOW 0x10000000

typedef unsigned uid_t, gid_t;

/* Device and inode are the serial number of the volume and the index of the file, which identify it. */
struct ffd_stat {
    uint64_t st_dev, st_ino;
    unsigned st_mode, st_nlink;
    uid_t st_uid;
    gid_t st_gid;
    int64_t st_size;
    struct timespec st_mtim, st_ctim;
};

#undef stat
#undef fstat
#define stat ffd_stat
#define fstat(fd, info) ffd_fstat(fd, info)
#define lstat(path, info) ffd_lstat(path, info)
#define open(...) ffd_open(__VA_ARGS__, 0)
#define close(fd) ffd_close(fd)
#define read(fd, to, size) ffd_read(fd, to, size)
#define write(fd, from, size) ffd_write(fd, from, size)
#define pread(fd, to, size, at) ffd_pread(fd, to, size, at)
#define pwrite(fd, from, size, at) ffd_pwrite(fd, from, size, at)
#define ftruncate(fd, size) ffd_ftruncate(fd, size)
#define posix_fallocate(fd, at, size) ffd_posix_fallocate(fd, at, size)
#define dup(fd) ffd_dup(fd)
#define fcntl(fd, ...) ((void)(fd), 0)
#define access(path, mode) ffd_access(path, mode)

int ffd_stat(const char *path, struct ffd_stat *info);
int ffd_lstat(const char *path, struct ffd_stat *info);
int ffd_fstat(int fd, struct ffd_stat *info);
int ffd_open(const char *path, int flags, ...);
int ffd_close(int fd);
ssize_t ffd_read(int fd, void *to, size_t size);
ssize_t ffd_write(int fd, const void *from, size_t size);
ssize_t ffd_pread(int fd, void *to, size_t size, int64_t at);
ssize_t ffd_pwrite(int fd, const void *from, size_t size, int64_t at);
int ffd_ftruncate(int fd, int64_t size);
int ffd_posix_fallocate(int fd, int64_t at, int64_t size);
int ffd_dup(int fd);
int ffd_access(const char *path, int mode);

#ifndef S_IFLNK
#define S_IFLNK 0xA000
#define S_IFSOCK 0xC000
#endif
#define S_ISLNK(mode) (((mode)&S_IFMT) == S_IFLNK)
#define S_ISSOCK(mode) (((mode)&S_IFMT) == S_IFSOCK)
#define S_ISVTX 0

#undef F_OK
#undef W_OK
#undef X_OK
#define F_OK 0
#define X_OK 1
#define W_OK 2

static inline uid_t geteuid(void)
{
    return 0;
}

static inline gid_t getegid(void)
{
    return 0;
}

static inline int fchown(int fd, uid_t user, gid_t group)
{
    (void)fd;
    (void)user;
    (void)group;
    return 0;
}

static inline int fchmod(int fd, unsigned mode)
{
    (void)fd;
    (void)mode;
    return 0;
}

/* The lock is on a byte that no file has, because locks of Windows keep others from reading. */
#define LOCK_EX 2
#define LOCK_NB 4
int flock(int fd, int operation);

struct pollfd {
    int fd;
    short events, revents;
};
typedef unsigned nfds_t;
#define POLLIN 1
/* Waits for a pipe, a console or a file; looks at a pipe every few milliseconds. */
int poll(struct pollfd *set, nfds_t count, int milliseconds);

/* Names */

#undef PATH_MAX
#define PATH_MAX 4096

#define unlink(path) ffd_unlink(path)
#define rename(from, to) ffd_rename(from, to)
#define mkdir(path, mode) ffd_mkdir(path)
#define rmdir(path) ffd_rmdir(path)

int ffd_unlink(const char *path);
/* Tries again for a tenth of a second while another program has the target open. */
int ffd_rename(const char *from, const char *to);
int ffd_mkdir(const char *path);
int ffd_rmdir(const char *path);
int link(const char *from, const char *to);

#define AT_FDCWD (-100)
#define RENAME_NOREPLACE 1
int renameat2(int from_folder, const char *from, int to_folder, const char *to, unsigned flags);

/* With '/', and each name as the file system has it; to: NULL, the path is allocated by malloc. */
char *realpath(const char *path, char *to);
ssize_t readlink(const char *path, char *to, size_t size);

typedef struct ffd_dir DIR;
struct dirent {
    char d_name[3 * 260];
};
DIR *opendir(const char *path);
struct dirent *readdir(DIR *folder);
int closedir(DIR *folder);

/* Memory. A file that is mapped cannot be replaced or deleted: unlink and rename make its mappings copies in
   memory first. */

#define PROT_READ 1
#define PROT_WRITE 2
#define MAP_SHARED 1
#define MAP_PRIVATE 2
#define MAP_FAILED ((void *)-1)
#define MADV_DONTNEED 4
#define _SC_PAGESIZE 1

/* Maps a file from its beginning, to be read, or shared to be written too. */
void *mmap(void *at, size_t size, int protection, int flags, int fd, int64_t offset);
int munmap(void *at, size_t size);
int madvise(void *at, size_t size, int advice);
long sysconf(int name);

#endif
