/* hold.c - another program: "open FILE" has a file open and lets nobody else open it, "lock FILE" has locked
   it as a run of ffd does that writes it; both say "ready", and end when their standard input does. "kill
   NAME" ends the workers of a program of that name as the task manager does, and says how many. */
#include <stdio.h>
#include <string.h>
#include <windows.h>

#include <tlhelp32.h>

/* Whether a process is a worker: its parent has the same name. */
static BOOL is_worker(HANDLE all, const PROCESSENTRY32W *process)
{
    PROCESSENTRY32W other = {.dwSize = sizeof other};
    for (BOOL more = Process32FirstW(all, &other); more; more = Process32NextW(all, &other))
        if (other.th32ProcessID == process->th32ParentProcessID)
            return wcscmp(other.szExeFile, process->szExeFile) == 0;
    return FALSE;
}

static int kill_workers(const wchar_t *name)
{
    PROCESSENTRY32W process = {.dwSize = sizeof process};
    const HANDLE list = CreateToolhelp32Snapshot(TH32CS_SNAPPROCESS, 0),
                 all = CreateToolhelp32Snapshot(TH32CS_SNAPPROCESS, 0);
    int count = 0;
    for (BOOL more = Process32FirstW(list, &process); more; more = Process32NextW(list, &process)) {
        if (wcscmp(process.szExeFile, name) != 0 || !is_worker(all, &process))
            continue;
        const HANDLE worker = OpenProcess(PROCESS_TERMINATE, FALSE, process.th32ProcessID);
        count += worker && TerminateProcess(worker, 1);
    }
    printf("%d\n", count);
    return count == 0;
}

int main(int argc, char **argv)
{
    wchar_t path[MAX_PATH];
    const BOOL locks = argc > 1 && strcmp(argv[1], "lock") == 0;
    if (argc != 3 || !MultiByteToWideChar(CP_UTF8, 0, argv[2], -1, path, MAX_PATH))
        return 2;
    const DWORD sharing = FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE;
    if (strcmp(argv[1], "kill") == 0)
        return kill_workers(path);
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
