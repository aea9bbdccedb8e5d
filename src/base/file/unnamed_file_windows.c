#include "base/file/unnamed_file.h"
#include "base/posix.h"
#include <windows.h>

int ffd_unnamed_file(void)
{
    wchar_t folder[MAX_PATH + 1], path[MAX_PATH + 1];
    if (!GetTempPathW(MAX_PATH + 1, folder) || !GetTempFileNameW(folder, L"ffd", 0, path))
        return -1;
    const HANDLE file =
        CreateFileW(path, GENERIC_READ | GENERIC_WRITE, FILE_SHARE_DELETE, NULL, OPEN_EXISTING,
                    FILE_ATTRIBUTE_TEMPORARY | FILE_FLAG_DELETE_ON_CLOSE, NULL);
    const int fd =
        file == INVALID_HANDLE_VALUE ? -1 : _open_osfhandle((intptr_t)file, O_BINARY | O_NOINHERIT);
    if (file == INVALID_HANDLE_VALUE)
        DeleteFileW(path);
    else if (fd < 0)
        CloseHandle(file);
    return fd;
}
