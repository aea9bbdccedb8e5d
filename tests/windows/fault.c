/* fault.c - makes a call of Windows that changes a folder fail, or the program end there: linked into the
   program by --wrap. FFD_FAULT_AT is the number of the call, FFD_FAULT_KIND "error" or "kill"; FFD_FAULT_MARK
   names a file that is made when it happens. Without FFD_FAULT_AT all calls go through. */
#include <stdlib.h>
#include <string.h>
#include <windows.h>

#define DECLARE(result, name, parameters)                                                                    \
    typedef result(WINAPI *name##_call) parameters;                                                          \
    extern name##_call __real___imp_##name;                                                                  \
    static result WINAPI my_##name parameters;                                                               \
    extern name##_call __wrap___imp_##name;                                                                  \
    name##_call __wrap___imp_##name = my_##name;

DECLARE(HANDLE, CreateFileW, (const wchar_t *, DWORD, DWORD, SECURITY_ATTRIBUTES *, DWORD, DWORD, HANDLE))
DECLARE(BOOL, MoveFileExW, (const wchar_t *, const wchar_t *, DWORD))
DECLARE(BOOL, DeleteFileW, (const wchar_t *))
DECLARE(BOOL, CreateDirectoryW, (const wchar_t *, SECURITY_ATTRIBUTES *))
DECLARE(BOOL, RemoveDirectoryW, (const wchar_t *))
DECLARE(BOOL, WriteFile, (HANDLE, const void *, DWORD, DWORD *, OVERLAPPED *))

static void mark(void)
{
    const char *const path = getenv("FFD_FAULT_MARK");
    wchar_t wide[MAX_PATH];
    if (path && MultiByteToWideChar(CP_UTF8, 0, path, -1, wide, MAX_PATH))
        CloseHandle(__real___imp_CreateFileW(wide, GENERIC_WRITE, 0, NULL, CREATE_ALWAYS, 0, NULL));
}

/* Returns whether this call is to fail; ends the program if it is to end here. */
static BOOL fails(void)
{
    static LONG calls;
    const char *const at = getenv("FFD_FAULT_AT"), *const kind = getenv("FFD_FAULT_KIND");
    if (!at || InterlockedIncrement(&calls) != atol(at))
        return FALSE;
    mark();
    if (kind && strcmp(kind, "kill") == 0)
        TerminateProcess(GetCurrentProcess(), 99);
    SetLastError(ERROR_DISK_FULL);
    return TRUE;
}

static HANDLE WINAPI my_CreateFileW(const wchar_t *path, DWORD access, DWORD sharing,
                                    SECURITY_ATTRIBUTES *security, DWORD way, DWORD flags, HANDLE like)
{
    return way != OPEN_EXISTING && fails()
               ? INVALID_HANDLE_VALUE
               : __real___imp_CreateFileW(path, access, sharing, security, way, flags, like);
}

static BOOL WINAPI my_MoveFileExW(const wchar_t *from, const wchar_t *to, DWORD flags)
{
    return !fails() && __real___imp_MoveFileExW(from, to, flags);
}

static BOOL WINAPI my_DeleteFileW(const wchar_t *path)
{
    return !fails() && __real___imp_DeleteFileW(path);
}

static BOOL WINAPI my_CreateDirectoryW(const wchar_t *path, SECURITY_ATTRIBUTES *security)
{
    return !fails() && __real___imp_CreateDirectoryW(path, security);
}

static BOOL WINAPI my_RemoveDirectoryW(const wchar_t *path)
{
    return !fails() && __real___imp_RemoveDirectoryW(path);
}

/* To files only: messages are to be seen. */
static BOOL WINAPI my_WriteFile(HANDLE file, const void *bytes, DWORD size, DWORD *done, OVERLAPPED *at)
{
    return !(GetFileType(file) == FILE_TYPE_DISK && fails()) &&
           __real___imp_WriteFile(file, bytes, size, done, at);
}
