/* folders.c - what folders hold: files that are renamed and removed, other folders, links (posix.h). */
#include "base/windows/names.h"
#include "base/windows/posix.h"
#include "base/windows/views.h"
#include <windows.h>
#include <winioctl.h>

/* How often, and after how many milliseconds, a file is tried again that another program has open: a virus
   scanner or an index looks at every new file for a moment. */
enum { TRIES = 5, PAUSE = 20 };

static bool is_held(DWORD error)
{
    return error == ERROR_SHARING_VIOLATION || error == ERROR_ACCESS_DENIED ||
           error == ERROR_USER_MAPPED_FILE;
}

/* What a refusal for lack of access means for a file that may be written: another program has it open. */
static int fail_held(const wchar_t *path, DWORD error)
{
    const DWORD attributes = GetFileAttributesW(path);
    const bool is_plain = attributes != INVALID_FILE_ATTRIBUTES &&
                          !(attributes & (FILE_ATTRIBUTE_DIRECTORY | FILE_ATTRIBUTE_READONLY));
    HANDLE file = INVALID_HANDLE_VALUE;
    if (error == ERROR_ACCESS_DENIED && is_plain)
        file = CreateFileW(path, DELETE, 0, NULL, OPEN_EXISTING, 0, NULL);
    const bool is_open = error == ERROR_ACCESS_DENIED && is_plain && file == INVALID_HANDLE_VALUE &&
                         GetLastError() == ERROR_SHARING_VIOLATION;
    if (file != INVALID_HANDLE_VALUE)
        CloseHandle(file);
    return ffd_set_errno_by(is_open ? ERROR_SHARING_VIOLATION : error);
}

/* As FILE_RENAME_INFO with the members of Windows 10. */
typedef struct rename_info {
    DWORD flags;
    HANDLE root;
    DWORD size;
    wchar_t name[WIDE_ROOM];
} rename_info;

/* Replaces the target at once, also where others have it open and let it be deleted. Windows before 10, wine
   8 and some file systems cannot: returns false. */
static bool replace_open(const wchar_t *source, const wchar_t *target)
{
    enum { RENAME_INFO_EX = 22, REPLACE = 1, AS_POSIX = 2 };
    rename_info info = {.flags = REPLACE | AS_POSIX};
    const DWORD length = GetFullPathNameW(target, WIDE_ROOM, info.name, NULL);
    if (length == 0 || length >= WIDE_ROOM)
        return false;
    const HANDLE file =
        CreateFileW(source, DELETE | SYNCHRONIZE, FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE,
                    NULL, OPEN_EXISTING, FILE_FLAG_BACKUP_SEMANTICS | FILE_FLAG_OPEN_REPARSE_POINT, NULL);
    if (file == INVALID_HANDLE_VALUE)
        return false;
    info.size = length * (DWORD)sizeof *info.name;
    const bool done =
        SetFileInformationByHandle(file, (FILE_INFO_BY_HANDLE_CLASS)RENAME_INFO_EX, &info, sizeof info);
    CloseHandle(file);
    return done;
}

static int move(const char *from, const char *to, DWORD flags)
{
    wchar_t source[WIDE_ROOM], target[WIDE_ROOM];
    if (!ffd_wide_path(from, source) || !ffd_wide_path(to, target))
        return -1;
    if (flags & MOVEFILE_REPLACE_EXISTING)
        ffd_views_detach(to);
    for (int tries = 1;; tries++) {
        if (MoveFileExW(source, target, flags))
            return 0;
        const DWORD reason = GetLastError();
        if (!is_held(reason))
            return ffd_set_errno_by(reason);
        if (flags & MOVEFILE_REPLACE_EXISTING && replace_open(source, target))
            return 0;
        if (tries == TRIES)
            return fail_held(flags & MOVEFILE_REPLACE_EXISTING ? target : source, reason);
        Sleep(PAUSE);
    }
}

int ffd_rename(const char *from, const char *to)
{
    return move(from, to, MOVEFILE_REPLACE_EXISTING);
}

int renameat2(int from_folder, const char *from, int to_folder, const char *to, unsigned flags)
{
    (void)from_folder;
    (void)to_folder;
    return move(from, to, flags & RENAME_NOREPLACE ? 0 : MOVEFILE_REPLACE_EXISTING);
}

int link(const char *from, const char *to)
{
    wchar_t there[WIDE_ROOM], name[WIDE_ROOM];
    if (!ffd_wide_path(from, there) || !ffd_wide_path(to, name))
        return -1;
    return CreateHardLinkW(name, there, NULL) ? 0 : ffd_set_errno();
}

int ffd_unlink(const char *path)
{
    wchar_t wide[WIDE_ROOM];
    if (!ffd_wide_path(path, wide))
        return -1;
    ffd_views_detach(path);
    for (int tries = 1;; tries++) {
        if (DeleteFileW(wide))
            return 0;
        const DWORD reason = GetLastError();
        if (reason != ERROR_SHARING_VIOLATION || tries == TRIES)
            return fail_held(wide, reason);
        Sleep(PAUSE);
    }
}

int ffd_mkdir(const char *path)
{
    wchar_t wide[WIDE_ROOM];
    if (!ffd_wide_path(path, wide))
        return -1;
    return CreateDirectoryW(wide, NULL) ? 0 : ffd_set_errno();
}

int ffd_rmdir(const char *path)
{
    wchar_t wide[WIDE_ROOM];
    if (!ffd_wide_path(path, wide))
        return -1;
    return RemoveDirectoryW(wide) ? 0 : ffd_set_errno();
}

char *realpath(const char *path, char *to)
{
    wchar_t wide[WIDE_ROOM];
    if (!ffd_wide_path(path, wide))
        return NULL;
    const HANDLE file =
        CreateFileW(wide, FILE_READ_ATTRIBUTES, FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE, NULL,
                    OPEN_EXISTING, FILE_FLAG_BACKUP_SEMANTICS, NULL);
    if (file == INVALID_HANDLE_VALUE) {
        ffd_set_errno();
        return NULL;
    }
    const DWORD length = GetFinalPathNameByHandleW(file, wide, WIDE_ROOM, VOLUME_NAME_DOS);
    if (length == 0 || length >= WIDE_ROOM)
        ffd_set_errno();
    CloseHandle(file);
    if (length == 0 || length >= WIDE_ROOM)
        return NULL;
    ffd_plain_path(wide);
    if (!to)
        return ffd_utf8(wide);
    return ffd_utf8_into(wide, to, PATH_MAX) ? to : NULL;
}

/* What FSCTL_GET_REPARSE_POINT writes for a symbolic link (Windows protocols, [MS-FSCC] 2.1.2.4). */
typedef struct link_data {
    DWORD tag;
    WORD size, reserved, target_at, target_size, shown_at, shown_size;
    DWORD flags;
    wchar_t text[WIDE_ROOM];
} link_data;

ssize_t readlink(const char *path, char *to, size_t size)
{
    wchar_t wide[WIDE_ROOM];
    link_data data;
    DWORD got = 0;
    if (!ffd_wide_path(path, wide))
        return -1;
    const HANDLE file =
        CreateFileW(wide, FILE_READ_ATTRIBUTES, FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE, NULL,
                    OPEN_EXISTING, FILE_FLAG_BACKUP_SEMANTICS | FILE_FLAG_OPEN_REPARSE_POINT, NULL);
    if (file == INVALID_HANDLE_VALUE)
        return ffd_set_errno();
    const bool is_read =
        DeviceIoControl(file, FSCTL_GET_REPARSE_POINT, NULL, 0, &data, sizeof data, &got, NULL);
    CloseHandle(file);
    if (!is_read || data.tag != IO_REPARSE_TAG_SYMLINK) {
        errno = EINVAL;
        return -1;
    }
    const size_t begin = data.target_at / sizeof *data.text, length = data.target_size / sizeof *data.text;
    wmemmove(data.text, data.text + begin, length);
    data.text[length] = 0;
    if (wcsncmp(data.text, L"\\??\\", 4) == 0) /* the native form of the prefix of long paths */
        data.text[1] = '\\';
    ffd_plain_path(data.text);
    return ffd_utf8_into(data.text, to, size) ? (ssize_t)strlen(to) : -1;
}

struct ffd_dir {
    HANDLE search;
    bool is_first; /* `found` is still to be given */
    WIN32_FIND_DATAW found;
    struct dirent entry;
};

DIR *opendir(const char *path)
{
    wchar_t wide[WIDE_ROOM];
    if (!ffd_wide_path(path, wide))
        return NULL;
    const size_t length = wcslen(wide);
    if (length + 3 > WIDE_ROOM) {
        errno = ENAMETOOLONG;
        return NULL;
    }
    const DWORD attributes = GetFileAttributesW(wide);
    if (attributes == INVALID_FILE_ATTRIBUTES || !(attributes & FILE_ATTRIBUTE_DIRECTORY)) {
        if (attributes == INVALID_FILE_ATTRIBUTES)
            ffd_set_errno();
        else
            errno = ENOTDIR;
        return NULL;
    }
    wcscpy(wide + length, wide[length - 1] == '\\' ? L"*" : L"\\*");
    DIR *const folder = malloc(sizeof *folder);
    if (!folder)
        return NULL;
    folder->search = FindFirstFileW(wide, &folder->found);
    folder->is_first = folder->search != INVALID_HANDLE_VALUE;
    if (folder->is_first || GetLastError() == ERROR_FILE_NOT_FOUND) /* the root of an empty volume */
        return folder;
    ffd_set_errno();
    free(folder);
    return NULL;
}

struct dirent *readdir(DIR *folder)
{
    while (folder->search != INVALID_HANDLE_VALUE) {
        if (!folder->is_first && !FindNextFileW(folder->search, &folder->found)) {
            if (GetLastError() != ERROR_NO_MORE_FILES)
                ffd_set_errno();
            return NULL;
        }
        folder->is_first = false;
        if (ffd_utf8_into(folder->found.cFileName, folder->entry.d_name, sizeof folder->entry.d_name))
            return &folder->entry; /* one that is no Unicode can have no name here */
    }
    return NULL;
}

int closedir(DIR *folder)
{
    if (folder->search != INVALID_HANDLE_VALUE)
        FindClose(folder->search);
    free(folder);
    return 0;
}
