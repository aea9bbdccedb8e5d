/* cleanup_signals_windows.c - the same for Windows. */
#include "base/file/cleanup.h"
#include "base/file/cleanup_list.h"
#include "base/system/process.h"
#include <ffd/program.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <windows.h>

/* The exit code of a worker that was stopped: that of a program ended by Ctrl-C. */
#define STOPPED ((UINT)STATUS_CONTROL_C_EXIT)

static atomic_flag held = ATOMIC_FLAG_INIT;
static atomic_bool is_over; /* a handler holds or awaits the lock: nobody else may take it */

static bool try_lock(void)
{
    return !atomic_flag_test_and_set_explicit(&held, memory_order_acquire);
}

/* Handlers run in threads of their own: nothing is to be blocked. */
void ffd_cleanup_hold(void)
{
    while (atomic_load(&is_over) || !try_lock())
        Sleep(1);
}

void ffd_cleanup_release(void)
{
    atomic_flag_clear_explicit(&held, memory_order_release);
}

/* Keeps the lock, so that nothing is created or renamed any more. */
static void clean_up(void)
{
    atomic_store(&is_over, true);
    while (!try_lock())
        Sleep(1);
    ffd_cleanup_remove_all();
}

/* The handler that Windows has itself comes next, and ends the program. */
static BOOL WINAPI on_request(DWORD kind)
{
    (void)kind;
    clean_up();
    return FALSE;
}

static void on_stop(void)
{
    clean_up();
    TerminateProcess(GetCurrentProcess(), STOPPED);
}

/* If the thread that crashed holds the lock, the list may be inconsistent, and is not used. */
static void clean_up_crash(void)
{
    int tries = 1000;
    atomic_store(&is_over, true);
    for (; tries > 0 && !try_lock(); tries--)
        Sleep(1);
    if (tries > 0)
        ffd_cleanup_remove_all();
}

static LONG WINAPI on_crash(EXCEPTION_POINTERS *what)
{
    clean_up_crash();
    TerminateProcess(GetCurrentProcess(), what->ExceptionRecord->ExceptionCode);
    return EXCEPTION_CONTINUE_SEARCH;
}

static void on_abort(int signal)
{
    (void)signal;
    clean_up_crash();
    TerminateProcess(GetCurrentProcess(), (UINT)STATUS_FATAL_APP_EXIT);
}

void ffd_cleanup_on_signals(void)
{
    SetConsoleCtrlHandler(on_request, TRUE);
}

void ffd_cleanup_on_crashes(void)
{
    ffd_process_on_stop(on_stop);
    SetUnhandledExceptionFilter(on_crash);
    signal(SIGABRT, on_abort);
}
