/* hold.c - another program that has a file open: "open" lets nobody else open it, "lock" has locked it as a
   run of ffd does that writes it. Says "ready", and ends when its standard input does. */
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <windows.h>

int main(int argc, char **argv)
{
    wchar_t path[MAX_PATH];
    const BOOL locks = argc > 1 && strcmp(argv[1], "lock") == 0;
    if (argc != 3 || !MultiByteToWideChar(CP_UTF8, 0, argv[2], -1, path, MAX_PATH))
        return 2;
    const DWORD sharing = FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE;
    const HANDLE file =
        CreateFileW(path, GENERIC_READ | GENERIC_WRITE, locks ? sharing : 0, NULL, OPEN_ALWAYS, 0, NULL);
    OVERLAPPED place = {0};
    place.Offset = 0xffffffff;
    place.OffsetHigh = 0x7fffffff;
    if (file == INVALID_HANDLE_VALUE ||
        (locks && !LockFileEx(file, LOCKFILE_EXCLUSIVE_LOCK, 0, 1, 0, &place)))
        return 1;
    puts("ready");
    fflush(stdout);
    getchar();
    return 0;
}
