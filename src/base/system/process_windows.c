#include "base/memory/memory.h"
#include "base/posix.h"
#include "base/system/interrupt.h"
#include "base/system/process.h"
#include "base/windows/names.h"
#include <pthread.h>
#include <stdatomic.h>
#include <windows.h>

/* The exit code of a process that another one has ended, as that of the task manager. */
#define KILLED 1
/* Exit codes from here on are those of crashes. */
#define LEAST_CRASH 0xC0000000u
/* Milliseconds from one poll of an input to the next: it cannot be waited for. */
#define INPUT_INTERVAL 20
/* Milliseconds from one poll of the workers to the next: another batch of this process may have taken the
   event. */
#define WORKER_INTERVAL 100

enum { BLOCK = 4096, PIPE_BYTES = 1 << 16, COMMAND = 512 };

/* A thread for each worker reads what it sends: one wait is for 64 objects at most, and none for a pipe. */
struct worker_process {
    HANDLE process, to, from, stop;
    pthread_t reader;
    bool has_reader;
    pthread_mutex_t lock; /* protects the members below */
    byte_buffer arrived;
    bool has_ended;
};

static HANDLE job;     /* ends its processes with this one */
static HANDLE arrival; /* set when something has arrived */

static void prepare(void)
{
    JOBOBJECT_EXTENDED_LIMIT_INFORMATION limits = {0};
    arrival = CreateEventW(NULL, FALSE, FALSE, NULL);
    job = CreateJobObjectW(NULL, NULL);
    limits.BasicLimitInformation.LimitFlags = JOB_OBJECT_LIMIT_KILL_ON_JOB_CLOSE;
    if (job)
        SetInformationJobObject(job, JobObjectExtendedLimitInformation, &limits, sizeof limits);
}

/* The name of the event that asks a worker to end. */
static void name_stop(DWORD id, wchar_t name[64])
{
    swprintf(name, 64, L"Local\\ffd-stop-%lu", (unsigned long)id);
}

static void *read_all(void *argument)
{
    worker_process *const process = argument;
    char block[BLOCK];
    for (;;) {
        DWORD got = 0;
        const bool is_read = ReadFile(process->from, block, sizeof block, &got, NULL);
        pthread_mutex_lock(&process->lock);
        ffd_buffer_append(&process->arrived, block, got);
        process->has_ended = !is_read;
        pthread_mutex_unlock(&process->lock);
        SetEvent(arrival);
        if (!is_read)
            return NULL;
    }
}

static void close_handle(HANDLE *handle)
{
    if (*handle && *handle != INVALID_HANDLE_VALUE)
        CloseHandle(*handle);
    *handle = NULL;
}

/* Makes a pipe of which the worker inherits the end `theirs`. */
static bool make_pipe(HANDLE *read, HANDLE *write, HANDLE *theirs)
{
    return CreatePipe(read, write, NULL, PIPE_BYTES) &&
           SetHandleInformation(*theirs, HANDLE_FLAG_INHERIT, HANDLE_FLAG_INHERIT);
}

/* Returns standard error as a worker inherits it; NULL: there is none. */
static HANDLE inherited_error(void)
{
    HANDLE copy = NULL;
    const HANDLE error = GetStdHandle(STD_ERROR_HANDLE), self = GetCurrentProcess();
    return error && error != INVALID_HANDLE_VALUE &&
                   DuplicateHandle(self, error, self, &copy, 0, TRUE, DUPLICATE_SAME_ACCESS)
               ? copy
               : NULL;
}

/* Starts the program with these as its standard streams, and no other handle of this process; suspended. */
static bool start_suspended(const wchar_t *program, wchar_t *command, HANDLE streams[3],
                            PROCESS_INFORMATION *made)
{
    union {
        char bytes[256];
        void *alignment;
    } room;
    SIZE_T size = sizeof room;
    STARTUPINFOEXW startup = {.StartupInfo = {.cb = sizeof startup,
                                              .dwFlags = STARTF_USESTDHANDLES,
                                              .hStdInput = streams[0],
                                              .hStdOutput = streams[1],
                                              .hStdError = streams[2]},
                              .lpAttributeList = (void *)room.bytes};
    if (!InitializeProcThreadAttributeList(startup.lpAttributeList, 1, 0, &size))
        return false;
    const size_t count = streams[2] ? 3 : 2;
    const bool is_made =
        UpdateProcThreadAttribute(startup.lpAttributeList, 0, PROC_THREAD_ATTRIBUTE_HANDLE_LIST, streams,
                                  count * sizeof *streams, NULL, NULL) &&
        CreateProcessW(program, command, NULL, NULL, TRUE, CREATE_SUSPENDED | EXTENDED_STARTUPINFO_PRESENT,
                       NULL, NULL, &startup.StartupInfo, made);
    const DWORD reason = GetLastError();
    DeleteProcThreadAttributeList(startup.lpAttributeList);
    SetLastError(reason);
    return is_made;
}

/* Starts the worker, and the thread that reads what it sends. Returns false with errno. */
static bool start(worker_process *process, const wchar_t *program, wchar_t *command)
{
    HANDLE streams[3] = {NULL, NULL, inherited_error()};
    PROCESS_INFORMATION made = {0};
    wchar_t name[64];
    const bool is_started = make_pipe(&streams[0], &process->to, &streams[0]) &&
                            make_pipe(&process->from, &streams[1], &streams[1]) &&
                            start_suspended(program, command, streams, &made);
    if (!is_started)
        ffd_set_errno();
    for (int i = 0; i < 3; i++)
        close_handle(&streams[i]);
    if (!is_started)
        return false;
    process->process = made.hProcess;
    if (job)
        AssignProcessToJobObject(job, made.hProcess);
    name_stop(made.dwProcessId, name);
    process->stop = CreateEventW(NULL, TRUE, FALSE, name);
    ResumeThread(made.hThread);
    CloseHandle(made.hThread);
    process->has_reader = pthread_create(&process->reader, NULL, read_all, process) == 0;
    errno = process->has_reader ? 0 : ENOMEM;
    return process->has_reader;
}

/* Returns false with errno. */
static bool find_program(const char *program, wchar_t wide[WIDE_ROOM])
{
    if (program)
        return ffd_wide_path(program, wide);
    const DWORD length = GetModuleFileNameW(NULL, wide, WIDE_ROOM);
    if (length > 0 && length < WIDE_ROOM)
        return true;
    if (length > 0)
        errno = ENAMETOOLONG;
    else
        ffd_set_errno();
    return false;
}

/* Makes the command line of a worker. Returns false with errno. */
static bool make_command(const char *name, const char *build, wchar_t command[COMMAND])
{
    char text[COMMAND];
    const int length = snprintf(text, sizeof text, "\"%s\" \"%s\"", name, build);
    if (length < 0 || length >= COMMAND) {
        errno = ENAMETOOLONG;
        return false;
    }
    if (MultiByteToWideChar(CP_UTF8, 0, text, -1, command, COMMAND) > 0)
        return true;
    ffd_set_errno();
    return false;
}

ffd_status ffd_process_start(const char *program, const char *name, const char *build,
                             worker_process **process, ffd_error *error)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    wchar_t wide[WIDE_ROOM], command[COMMAND];
    pthread_once(&once, prepare);
    worker_process *made = ffd_alloc_zero(1, sizeof *made);
    *process = NULL;
    if (!made)
        return ffd_fail_memory(error);
    pthread_mutex_init(&made->lock, NULL);
    if (find_program(program, wide) && make_command(name, build, command) && start(made, wide, command)) {
        *process = made;
        return FFD_OK;
    }
    const int reason = errno;
    if (made->process)
        ffd_process_kill(made);
    ffd_process_finish(&made, NULL);
    return ffd_fail(error, reason == ENOMEM ? FFD_E_MEMORY : FFD_E_IO, "a worker cannot be started: %s",
                    strerror(reason));
}

static bool write_all(HANDLE pipe, const void *bytes, size_t size)
{
    const char *at = bytes;
    while (size > 0) {
        DWORD put = 0;
        if (!WriteFile(pipe, at, size < PIPE_BYTES ? (DWORD)size : PIPE_BYTES, &put, NULL))
            return false;
        at += put;
        size -= put;
    }
    return true;
}

bool ffd_process_send(worker_process *process, const void *bytes, size_t size)
{
    return write_all(process->to, bytes, size);
}

static bool has_arrived(worker_process *const *processes, size_t count)
{
    bool found = false;
    for (size_t i = 0; i < count && !found; i++) {
        if (!processes[i])
            continue;
        pthread_mutex_lock(&processes[i]->lock);
        found = processes[i]->arrived.size > 0 || processes[i]->arrived.failed || processes[i]->has_ended;
        pthread_mutex_unlock(&processes[i]->lock);
    }
    return found;
}

static bool is_readable(int input)
{
    struct pollfd ready = {.fd = input, .events = POLLIN};
    return input >= 0 && poll(&ready, 1, 0) > 0;
}

void ffd_process_wait(worker_process *const *processes, size_t count, int input, double seconds)
{
    const double most = seconds < 0 ? 1e18 : 1e3 * seconds;
    const ULONGLONG begin = GetTickCount64();
    for (;;) {
        const double passed = (double)(GetTickCount64() - begin), left = most - passed;
        if (has_arrived(processes, count) || is_readable(input) || ffd_interrupt_requested() || left <= 0)
            return;
        const DWORD slice = input >= 0 ? INPUT_INTERVAL : WORKER_INTERVAL,
                    pause = left < slice ? (DWORD)left + 1 : slice;
        HANDLE signs[2];
        DWORD used = 0;
        if (arrival)
            signs[used++] = arrival;
        if (ffd_interrupt_event())
            signs[used++] = ffd_interrupt_event();
        if (used == 0)
            Sleep(pause);
        else
            WaitForMultipleObjects(used, signs, FALSE, pause);
    }
}

bool ffd_process_receive(worker_process *process, byte_buffer *bytes)
{
    pthread_mutex_lock(&process->lock);
    ffd_buffer_append(bytes, process->arrived.data, process->arrived.size);
    bytes->failed = bytes->failed || process->arrived.failed;
    process->arrived.size = 0;
    const bool is_open = !process->has_ended;
    pthread_mutex_unlock(&process->lock);
    return is_open;
}

void ffd_process_stop(worker_process *process)
{
    if (process->stop)
        SetEvent(process->stop);
    else
        ffd_process_kill(process);
}

void ffd_process_kill(worker_process *process)
{
    TerminateProcess(process->process, KILLED);
}

static const char *crash_in_words(DWORD code)
{
    switch (code) {
    case STATUS_ACCESS_VIOLATION:
        return "access violation";
    case STATUS_STACK_OVERFLOW:
        return "stack overflow";
    case STATUS_ILLEGAL_INSTRUCTION:
        return "illegal instruction";
    case STATUS_IN_PAGE_ERROR:
        return "a mapped file cannot be read";
    case STATUS_NO_MEMORY:
        return "out of memory";
    case STATUS_FATAL_APP_EXIT:
        return "aborted";
    default:
        return "exception";
    }
}

static void describe_end(DWORD code, process_end *end)
{
    const bool is_crash = code >= LEAST_CRASH || code == (DWORD)STATUS_FATAL_APP_EXIT;
    *end = (process_end){.killed = code == KILLED};
    if (is_crash || end->killed)
        end->signal = (int)code;
    else
        end->code = (int)code;
    if (is_crash)
        snprintf(end->text, sizeof end->text, "%s (0x%08lX)", crash_in_words(code), (unsigned long)code);
    else
        snprintf(end->text, sizeof end->text, "exit code %lu", (unsigned long)code);
}

void ffd_process_finish(worker_process **process, process_end *end)
{
    DWORD code = 0;
    if (end)
        *end = (process_end){0};
    if (!process || !*process)
        return;
    worker_process *const gone = *process;
    close_handle(&gone->to);
    if (gone->process) {
        WaitForSingleObject(gone->process, INFINITE);
        GetExitCodeProcess(gone->process, &code);
    }
    if (gone->has_reader)
        pthread_join(gone->reader, NULL);
    if (end && gone->process)
        describe_end(code, end);
    close_handle(&gone->from);
    close_handle(&gone->stop);
    close_handle(&gone->process);
    pthread_mutex_destroy(&gone->lock);
    ffd_buffer_free(&gone->arrived);
    ffd_free(gone);
    *process = NULL;
}

/* In a worker. */

static HANDLE channel_in, channel_out;
static SRWLOCK stopping = SRWLOCK_INIT;
static bool is_deferred; /* the worker's only thread has the lock */
static void (*end_worker)(void);

static HANDLE copy_of(DWORD stream)
{
    HANDLE copy = NULL;
    const HANDLE self = GetCurrentProcess();
    DuplicateHandle(self, GetStdHandle(stream), self, &copy, 0, FALSE, DUPLICATE_SAME_ACCESS);
    return copy;
}

/* The channel comes as standard input and output. In their place is the null device from now on, because a
   library might print. The end of the parent ends the job object, and with it this process. */
void ffd_process_follow_parent(void)
{
    const int null = open("/dev/null", O_RDWR);
    channel_in = copy_of(STD_INPUT_HANDLE);
    channel_out = copy_of(STD_OUTPUT_HANDLE);
    if (null < 0)
        return;
    _dup2(null, STDIN_FILENO);
    _dup2(null, STDOUT_FILENO);
    close(null);
}

static void *wait_for_stop(void *event)
{
    WaitForSingleObject(event, INFINITE);
    AcquireSRWLockExclusive(&stopping);
    end_worker();
    return NULL;
}

void ffd_process_on_stop(void (*function)(void))
{
    wchar_t name[64];
    pthread_t thread;
    name_stop(GetCurrentProcessId(), name);
    const HANDLE event = OpenEventW(SYNCHRONIZE, FALSE, name);
    end_worker = function;
    if (event && pthread_create(&thread, NULL, wait_for_stop, event) == 0)
        pthread_detach(thread);
}

void ffd_process_defer_stop(bool wait)
{
    if (wait && !is_deferred)
        AcquireSRWLockExclusive(&stopping);
    else if (!wait && is_deferred)
        ReleaseSRWLockExclusive(&stopping);
    is_deferred = wait;
}

bool ffd_process_take(void *bytes, size_t size)
{
    char *at = bytes;
    while (size > 0) {
        DWORD got = 0;
        if (!ReadFile(channel_in, at, size < PIPE_BYTES ? (DWORD)size : PIPE_BYTES, &got, NULL) || got == 0)
            return false;
        at += got;
        size -= got;
    }
    return true;
}

bool ffd_process_give(const void *bytes, size_t size)
{
    return write_all(channel_out, bytes, size);
}
