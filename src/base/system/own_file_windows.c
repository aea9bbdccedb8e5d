#include "base/posix.h"
#include "base/system/own_file.h"
#include "base/windows/names.h"
#include <windows.h>

bool ffd_find_own_file(const void *inside, char path[LONGEST_PATH])
{
    wchar_t wide[WIDE_ROOM];
    HMODULE own;
    if (!GetModuleHandleExW(GET_MODULE_HANDLE_EX_FLAG_FROM_ADDRESS |
                                GET_MODULE_HANDLE_EX_FLAG_UNCHANGED_REFCOUNT,
                            inside, &own))
        return false;
    const DWORD length = GetModuleFileNameW(own, wide, WIDE_ROOM);
    if (length == 0 || length >= WIDE_ROOM)
        return false;
    ffd_plain_path(wide);
    return ffd_utf8_into(wide, path, LONGEST_PATH);
}

/* Who may write to a folder is not looked at: it is that of the program. */
bool ffd_find_near(const char *const *folders, size_t count, const char *file, char path[LONGEST_PATH],
                   bool *is_known)
{
    char own[LONGEST_PATH];
    struct stat info;
    *is_known = ffd_find_own_file(folders, own);
    if (*is_known)
        *strrchr(own, '/') = 0;
    for (size_t i = 0; i < count && *is_known; i++)
        if (folders[i][0] != '/' &&
            snprintf(path, LONGEST_PATH, "%s/%s/%s", own, folders[i], file) < LONGEST_PATH &&
            stat(path, &info) == 0 && S_ISREG(info.st_mode))
            return true;
    return false;
}
