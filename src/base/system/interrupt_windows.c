#include "base/system/interrupt.h"
#include <stdatomic.h>
#include <stddef.h>
#include <windows.h>

/* A program whose console is closed, or whose user logs off, is ended as soon as its handler returns. */
#define LONGEST_END 4000

static atomic_bool requested;
static HANDLE event;

static BOOL WINAPI notice(DWORD kind)
{
    atomic_store(&requested, true);
    if (event)
        SetEvent(event);
    if (kind != CTRL_C_EVENT && kind != CTRL_BREAK_EVENT)
        Sleep(LONGEST_END);
    return TRUE;
}

static BOOL WINAPI ignore(DWORD kind)
{
    if (kind != CTRL_C_EVENT && kind != CTRL_BREAK_EVENT)
        Sleep(LONGEST_END);
    return TRUE;
}

void ffd_interrupt_watch(void)
{
    if (event)
        return;
    event = CreateEventW(NULL, TRUE, FALSE, NULL);
    SetConsoleCtrlHandler(notice, TRUE);
}

bool ffd_interrupt_requested(void)
{
    return atomic_load(&requested);
}

void *ffd_interrupt_event(void)
{
    return event;
}

void ffd_interrupt_ignore(void)
{
    SetConsoleCtrlHandler(ignore, TRUE);
}
