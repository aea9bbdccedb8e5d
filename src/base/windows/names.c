#include "base/windows/names.h"
#include "base/windows/path_flaw.h"
#include <errno.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <windows.h>

/* From this many characters on a path gets the prefix that lifts the limit of 260: folders have one of 248,
   and the names of files in them are to fit too. */
#define LONG_FROM 240

int ffd_set_errno_by(unsigned long error)
{
    static const struct {
        unsigned long error;
        int number;
    } known[] = {
        {ERROR_FILE_NOT_FOUND, ENOENT},
        {ERROR_PATH_NOT_FOUND, ENOENT},
        {ERROR_INVALID_DRIVE, ENOENT},
        {ERROR_BAD_NETPATH, ENOENT},
        {ERROR_BAD_NET_NAME, ENOENT},
        {ERROR_NOT_READY, ENOENT},
        {ERROR_INVALID_NAME, EINVAL},
        {ERROR_BAD_PATHNAME, EINVAL},
        {ERROR_INVALID_PARAMETER, EINVAL},
        {ERROR_NO_UNICODE_TRANSLATION, EILSEQ},
        {ERROR_ACCESS_DENIED, EACCES},
        {ERROR_DELETE_PENDING, EACCES},
        {ERROR_PRIVILEGE_NOT_HELD, EACCES},
        {ERROR_SHARING_VIOLATION, ETXTBSY},
        {ERROR_USER_MAPPED_FILE, ETXTBSY},
        {ERROR_LOCK_VIOLATION, EWOULDBLOCK},
        {ERROR_FILE_EXISTS, EEXIST},
        {ERROR_ALREADY_EXISTS, EEXIST},
        {ERROR_DIRECTORY, ENOTDIR},
        {ERROR_DIR_NOT_EMPTY, ENOTEMPTY},
        {ERROR_DISK_FULL, ENOSPC},
        {ERROR_HANDLE_DISK_FULL, ENOSPC},
        {ERROR_FILE_TOO_LARGE, EFBIG},
        {ERROR_WRITE_PROTECT, EROFS},
        {ERROR_NOT_ENOUGH_MEMORY, ENOMEM},
        {ERROR_OUTOFMEMORY, ENOMEM},
        {ERROR_COMMITMENT_LIMIT, ENOMEM},
        {ERROR_NO_SYSTEM_RESOURCES, ENOMEM},
        {ERROR_TOO_MANY_OPEN_FILES, EMFILE},
        {ERROR_FILENAME_EXCED_RANGE, ENAMETOOLONG},
        {ERROR_INSUFFICIENT_BUFFER, ENAMETOOLONG},
        {ERROR_BROKEN_PIPE, EPIPE},
        {ERROR_NO_DATA, EPIPE},
        {ERROR_INVALID_HANDLE, EBADF},
        {ERROR_NOT_SAME_DEVICE, EXDEV},
        {ERROR_CANT_RESOLVE_FILENAME, ELOOP},
        {ERROR_NOT_SUPPORTED, ENOSYS},
        {ERROR_INVALID_FUNCTION, ENOSYS},
        {ERROR_CALL_NOT_IMPLEMENTED, ENOSYS},
    };
    errno = EIO;
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (known[i].error == error)
            errno = known[i].number;
    return -1;
}

int ffd_set_errno(void)
{
    return ffd_set_errno_by(GetLastError());
}

/* Puts the prefix of long paths before the absolute form of a path. */
static bool lengthen(wchar_t wide[WIDE_ROOM])
{
    static const wchar_t prefix[] = L"\\\\?\\", network[] = L"\\\\?\\UNC\\";
    wchar_t full[WIDE_ROOM];
    const DWORD length = GetFullPathNameW(wide, WIDE_ROOM, full, NULL);
    const bool is_network = full[0] == '\\' && full[1] == '\\';
    const wchar_t *const before = is_network ? network : prefix, *const rest = is_network ? full + 2 : full;
    if (length == 0 || length >= WIDE_ROOM || wcslen(before) + wcslen(rest) >= WIDE_ROOM) {
        errno = length == 0 ? EINVAL : ENAMETOOLONG;
        return false;
    }
    wcscpy(wide, before);
    wcscat(wide, rest);
    return true;
}

bool ffd_wide_path(const char *path, wchar_t wide[WIDE_ROOM])
{
    const int size = MultiByteToWideChar(CP_UTF8, MB_ERR_INVALID_CHARS, path, -1, wide, WIDE_ROOM);
    if (size == 0 || !*path || ffd_path_flaw(path)) {
        errno = !*path ? ENOENT : EINVAL;
        if (size == 0)
            ffd_set_errno();
        return false;
    }
    for (wchar_t *c = wide; *c; c++)
        if (*c == '/')
            *c = '\\';
    return size < LONG_FROM || wcsncmp(wide, L"\\\\?\\", 4) == 0 || lengthen(wide);
}

bool ffd_utf8_into(const wchar_t *wide, char *text, size_t capacity)
{
    if (WideCharToMultiByte(CP_UTF8, 0, wide, -1, text, (int)capacity, NULL, NULL) > 0)
        return true;
    ffd_set_errno();
    return false;
}

char *ffd_utf8(const wchar_t *wide)
{
    const size_t capacity = 3 * wcslen(wide) + 1;
    char *const text = malloc(capacity);
    if (!text || ffd_utf8_into(wide, text, capacity))
        return text;
    free(text);
    return NULL;
}

void ffd_plain_path(wchar_t *wide)
{
    if (wcsncmp(wide, L"\\\\?\\UNC\\", 8) == 0)
        wmemmove(wide + 1, wide + 7, wcslen(wide + 7) + 1);
    else if (wcsncmp(wide, L"\\\\?\\", 4) == 0)
        wmemmove(wide, wide + 4, wcslen(wide + 4) + 1);
    for (wchar_t *c = wide; *c; c++)
        if (*c == '\\')
            *c = '/';
}

uint32_t ffd_small_letter(uint32_t c)
{
    wchar_t small, given = (wchar_t)c;
    if (c < 0x80)
        return c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c;
    return c < 0xd800 && LCMapStringW(LOCALE_INVARIANT, LCMAP_LOWERCASE, &given, 1, &small, 1) == 1 ? small
                                                                                                    : c;
}

char *ffd_small_letters(const char *name)
{
    wchar_t wide[WIDE_ROOM];
    if (!MultiByteToWideChar(CP_UTF8, 0, name, -1, wide, WIDE_ROOM))
        return NULL;
    for (wchar_t *c = wide; *c; c++)
        *c = (wchar_t)ffd_small_letter(*c);
    return ffd_utf8(wide);
}

bool ffd_equal_without_case(const char *a, const char *b)
{
    char *const x = ffd_small_letters(a), *const y = ffd_small_letters(b);
    const bool equal = x && y ? strcmp(x, y) == 0 : strcmp(a, b) == 0;
    free(x);
    free(y);
    return equal;
}
