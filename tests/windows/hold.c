/* hold.c - another program: "open FILE" has a file open and lets nobody else open it, "lock FILE" has locked
   it as a run of ffd does that writes it; both say "ready", and end when their standard input does. "kill
   NAME" says "ready", and when its standard input ends it ends the workers of a program of that name as the
   task manager does, and says how many. "console
   COMMAND" runs a command line in its console, with the code page 437, and says which page and mode that has
   afterwards, and whether the mode is the one before. */
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

static void wait_for_input(void)
{
    puts("ready");
    fflush(stdout);
    getchar();
}

static int kill_workers(const wchar_t *name)
{
    wait_for_input();
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

static int run_in_console(wchar_t *command)
{
    STARTUPINFOW startup = {.cb = sizeof startup};
    PROCESS_INFORMATION made;
    DWORD before = 0, after = 1, code = 1;
    const HANDLE console = GetStdHandle(STD_ERROR_HANDLE);
    if (!SetConsoleOutputCP(437) || !GetConsoleMode(console, &before) ||
        !SetConsoleMode(console, before & ~(DWORD)ENABLE_VIRTUAL_TERMINAL_PROCESSING) ||
        !GetConsoleMode(console, &before) ||
        !CreateProcessW(NULL, command, NULL, NULL, TRUE, 0, NULL, NULL, &startup, &made))
        return 1;
    WaitForSingleObject(made.hProcess, INFINITE);
    GetExitCodeProcess(made.hProcess, &code);
    GetConsoleMode(console, &after);
    char line[100];
    snprintf(line, sizeof line, "exit %lu, page %u, %s mode\n", code, GetConsoleOutputCP(),
             before == after ? "old" : "new");
    fputs(line, stdout);
    return 0;
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
    if (strcmp(argv[1], "console") == 0)
        return run_in_console(path);
    const HANDLE file =
        CreateFileW(path, GENERIC_READ | GENERIC_WRITE, locks ? sharing : 0, NULL, OPEN_ALWAYS, 0, NULL);
    OVERLAPPED place = {0};
    place.Offset = 0xffffffff;
    place.OffsetHigh = 0x7fffffff;
    if (file == INVALID_HANDLE_VALUE ||
        (locks && !LockFileEx(file, LOCKFILE_EXCLUSIVE_LOCK, 0, 1, 0, &place)))
        return 1;
    wait_for_input();
    return 0;
}
