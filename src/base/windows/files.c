/* files.c - files by descriptors of the C runtime, opened and read by calls of Windows (posix.h). */
#include "base/windows/names.h"
#include "base/windows/posix.h"
#include <windows.h>

/* The most bytes of one call. */
#define MOST ((size_t)1 << 30)

/* Seconds from 1601, where Windows begins to count, to 1970. */
#define EPOCH 11644473600

const char *ffd_strerror(int number)
{
    return number == ETXTBSY ? "another program has it open" : (strerror)(number);
}

char *ffd_getenv(const char *name)
{
    enum { VALUES = 4 };
    static _Thread_local char values[VALUES][PATH_MAX];
    static _Thread_local unsigned next;
    wchar_t wide[64], value[WIDE_ROOM];
    if (!MultiByteToWideChar(CP_UTF8, 0, name, -1, wide, 64))
        return NULL;
    const DWORD length = GetEnvironmentVariableW(wide, value, WIDE_ROOM);
    if ((length == 0 && GetLastError() == ERROR_ENVVAR_NOT_FOUND) || length >= WIDE_ROOM)
        return NULL;
    value[length] = 0;
    char *const to = values[next++ % VALUES];
    return ffd_utf8_into(value, to, PATH_MAX) ? to : NULL;
}

static HANDLE handle_of(int fd)
{
    return (HANDLE)_get_osfhandle(fd);
}

static bool is_link(HANDLE file)
{
    FILE_ATTRIBUTE_TAG_INFO info;
    return GetFileInformationByHandleEx(file, FileAttributeTagInfo, &info, sizeof info) &&
           info.FileAttributes & FILE_ATTRIBUTE_REPARSE_POINT && info.ReparseTag == IO_REPARSE_TAG_SYMLINK;
}

static HANDLE open_handle(const wchar_t *path, DWORD access, DWORD disposition, bool follows)
{
    return CreateFileW(path, access, FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE, NULL,
                       disposition, FILE_FLAG_BACKUP_SEMANTICS | (follows ? 0 : FILE_FLAG_OPEN_REPARSE_POINT),
                       NULL);
}

/* Returns the handle as a descriptor; closes it if there is none. */
static int descriptor_of(HANDLE file, int flags)
{
    const int fd = _open_osfhandle((intptr_t)file, flags | O_BINARY | O_NOINHERIT);
    if (fd < 0) {
        CloseHandle(file);
        errno = EMFILE;
    }
    return fd;
}

static int open_file(const char *path, int flags)
{
    wchar_t wide[WIDE_ROOM];
    const int way = flags & (O_RDONLY | O_WRONLY | O_RDWR);
    const bool follows = !(flags & O_NOFOLLOW);
    const DWORD access = way == O_RDWR     ? GENERIC_READ | GENERIC_WRITE
                         : way == O_WRONLY ? GENERIC_WRITE
                                           : GENERIC_READ,
                disposition = !(flags & O_CREAT) ? OPEN_EXISTING
                              : flags & O_EXCL   ? CREATE_NEW
                                                 : OPEN_ALWAYS;
    if (!ffd_wide_path(path, wide))
        return -1;
    const HANDLE file = open_handle(wide, access, disposition, follows);
    if (file == INVALID_HANDLE_VALUE) {
        const DWORD reason = GetLastError(), attributes = GetFileAttributesW(wide);
        ffd_set_errno_by(reason);
        if (reason == ERROR_ACCESS_DENIED && attributes != INVALID_FILE_ATTRIBUTES &&
            attributes & FILE_ATTRIBUTE_DIRECTORY)
            errno = flags & O_EXCL ? EEXIST : EISDIR;
        return -1;
    }
    if (!follows && is_link(file)) {
        CloseHandle(file);
        errno = ELOOP;
        return -1;
    }
    return descriptor_of(file, way == O_RDONLY ? O_RDONLY : 0);
}

int ffd_open(const char *path, int flags, ...)
{
    if (strcmp(path, "/dev/stdin") == 0)
        return ffd_dup(STDIN_FILENO);
    if (strcmp(path, "/dev/null") != 0)
        return open_file(path, flags);
    const HANDLE null = open_handle(L"NUL", GENERIC_READ | GENERIC_WRITE, OPEN_EXISTING, true);
    return null == INVALID_HANDLE_VALUE ? ffd_set_errno() : descriptor_of(null, 0);
}

int ffd_close(int fd)
{
    return _close(fd);
}

int ffd_dup(int fd)
{
    return _dup(fd);
}

static OVERLAPPED position(int64_t at)
{
    OVERLAPPED place = {0};
    place.Offset = (DWORD)(uint64_t)at;
    place.OffsetHigh = (DWORD)((uint64_t)at >> 32);
    return place;
}

/* at: NULL, from where the file stands. The end of a file or pipe is not a failure. */
static ssize_t read_at(int fd, void *to, size_t size, OVERLAPPED *at)
{
    DWORD got = 0;
    if (ReadFile(handle_of(fd), to, (DWORD)(size < MOST ? size : MOST), &got, at))
        return (ssize_t)got;
    const DWORD reason = GetLastError();
    return reason == ERROR_HANDLE_EOF || reason == ERROR_BROKEN_PIPE ? 0 : ffd_set_errno_by(reason);
}

static ssize_t write_at(int fd, const void *from, size_t size, OVERLAPPED *at)
{
    DWORD put = 0;
    return WriteFile(handle_of(fd), from, (DWORD)(size < MOST ? size : MOST), &put, at) ? (ssize_t)put
                                                                                        : ffd_set_errno();
}

ssize_t ffd_read(int fd, void *to, size_t size)
{
    return read_at(fd, to, size, NULL);
}

ssize_t ffd_write(int fd, const void *from, size_t size)
{
    return write_at(fd, from, size, NULL);
}

ssize_t ffd_pread(int fd, void *to, size_t size, int64_t at)
{
    OVERLAPPED place = position(at);
    return read_at(fd, to, size, &place);
}

ssize_t ffd_pwrite(int fd, const void *from, size_t size, int64_t at)
{
    OVERLAPPED place = position(at);
    return write_at(fd, from, size, &place);
}

int ffd_ftruncate(int fd, int64_t size)
{
    FILE_END_OF_FILE_INFO end;
    end.EndOfFile.QuadPart = size;
    return SetFileInformationByHandle(handle_of(fd), FileEndOfFileInfo, &end, sizeof end) ? 0
                                                                                          : ffd_set_errno();
}

/* A file that is made longer has its space on the disk, unless it is sparse. */
int ffd_posix_fallocate(int fd, int64_t at, int64_t size)
{
    return ffd_ftruncate(fd, at + size) == 0 ? 0 : errno;
}

int flock(int fd, int operation)
{
    OVERLAPPED place = position(INT64_MAX);
    const DWORD flags = LOCKFILE_EXCLUSIVE_LOCK | (operation & LOCK_NB ? LOCKFILE_FAIL_IMMEDIATELY : 0);
    if (LockFileEx(handle_of(fd), flags, 0, 1, 0, &place))
        return 0;
    const DWORD reason = GetLastError();
    return ffd_set_errno_by(reason == ERROR_IO_PENDING ? ERROR_LOCK_VIOLATION : reason);
}

static struct timespec time_of(int64_t ticks)
{
    return (struct timespec){.tv_sec = ticks / 10000000 - EPOCH, .tv_nsec = (long)(ticks % 10000000) * 100};
}

static int64_t ticks_of(FILETIME time)
{
    return (int64_t)((uint64_t)time.dwHighDateTime << 32 | time.dwLowDateTime);
}

static int describe(HANDLE file, struct ffd_stat *info)
{
    BY_HANDLE_FILE_INFORMATION by_handle;
    FILE_BASIC_INFO basic;
    if (!GetFileInformationByHandle(file, &by_handle))
        return ffd_set_errno();
    const int64_t written = ticks_of(by_handle.ftLastWriteTime);
    const bool has_change = GetFileInformationByHandleEx(file, FileBasicInfo, &basic, sizeof basic);
    const bool is_folder = by_handle.dwFileAttributes & FILE_ATTRIBUTE_DIRECTORY;
    *info = (struct ffd_stat){
        .st_dev = by_handle.dwVolumeSerialNumber,
        .st_ino = (uint64_t)by_handle.nFileIndexHigh << 32 | by_handle.nFileIndexLow,
        .st_mode = is_link(file) ? S_IFLNK | 0777u
                   : is_folder   ? S_IFDIR | 0755u
                                 : S_IFREG | 0644u,
        .st_nlink = by_handle.nNumberOfLinks,
        .st_size = (int64_t)((uint64_t)by_handle.nFileSizeHigh << 32 | by_handle.nFileSizeLow),
        .st_mtim = time_of(written),
        .st_ctim = time_of(has_change ? basic.ChangeTime.QuadPart : written),
    };
    return 0;
}

static int describe_path(const char *path, struct ffd_stat *info, bool follows)
{
    wchar_t wide[WIDE_ROOM];
    if (strcmp(path, "/dev/null") == 0) {
        *info = (struct ffd_stat){.st_mode = S_IFCHR | 0666};
        return 0;
    }
    if (!ffd_wide_path(path, wide))
        return -1;
    const HANDLE file = open_handle(wide, FILE_READ_ATTRIBUTES, OPEN_EXISTING, follows);
    if (file == INVALID_HANDLE_VALUE)
        return ffd_set_errno();
    const int result = describe(file, info);
    const int reason = errno;
    CloseHandle(file);
    errno = reason;
    return result;
}

int ffd_stat(const char *path, struct ffd_stat *info)
{
    return describe_path(path, info, true);
}

int ffd_lstat(const char *path, struct ffd_stat *info)
{
    return describe_path(path, info, false);
}

int ffd_fstat(int fd, struct ffd_stat *info)
{
    const HANDLE file = handle_of(fd);
    switch (file == INVALID_HANDLE_VALUE ? FILE_TYPE_UNKNOWN : GetFileType(file)) {
    case FILE_TYPE_DISK:
        if (describe(file, info) == 0)
            return 0;
        /* Of a standard stream that is a file wine tells nothing: it is read as a pipe. */
        __attribute__((fallthrough));
    case FILE_TYPE_PIPE:
        *info = (struct ffd_stat){.st_mode = S_IFIFO | 0600};
        return 0;
    case FILE_TYPE_CHAR:
        *info = (struct ffd_stat){.st_mode = S_IFCHR | 0600};
        return 0;
    default:
        errno = EBADF;
        return -1;
    }
}

int ffd_access(const char *path, int mode)
{
    struct ffd_stat info;
    wchar_t wide[WIDE_ROOM];
    if (ffd_stat(path, &info) != 0 || !ffd_wide_path(path, wide))
        return -1;
    if (mode & W_OK && S_ISREG(info.st_mode) && GetFileAttributesW(wide) & FILE_ATTRIBUTE_READONLY) {
        errno = EACCES;
        return -1;
    }
    return 0;
}

/* Whether a read returns at once. */
static bool is_ready(int fd)
{
    DWORD bytes = 0;
    const HANDLE file = handle_of(fd);
    switch (GetFileType(file)) {
    case FILE_TYPE_PIPE:
        return !PeekNamedPipe(file, NULL, 0, NULL, &bytes, NULL) || bytes > 0;
    case FILE_TYPE_CHAR:
        return WaitForSingleObject(file, 0) != WAIT_TIMEOUT;
    default:
        return true;
    }
}

int poll(struct pollfd *set, nfds_t count, int milliseconds)
{
    enum { PAUSE = 5 };
    const ULONGLONG begin = GetTickCount64();
    for (;;) {
        int found = 0;
        for (nfds_t i = 0; i < count; i++) {
            set[i].revents = is_ready(set[i].fd) ? POLLIN : 0;
            found += set[i].revents != 0;
        }
        if (found > 0 || (milliseconds >= 0 && GetTickCount64() - begin >= (ULONGLONG)milliseconds))
            return found;
        Sleep(PAUSE);
    }
}
