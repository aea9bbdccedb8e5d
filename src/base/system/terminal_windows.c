#include "base/system/terminal.h"
#include <stdlib.h>
#include <windows.h>

static DWORD mode_before;

static void put_back(void)
{
    SetConsoleMode(GetStdHandle(STD_ERROR_HANDLE), mode_before);
}

/* A line is redrawn by escape sequences, which consoles before Windows 10 do not have. */
bool ffd_terminal_is_error(void)
{
    static bool is_changed;
    const HANDLE console = GetStdHandle(STD_ERROR_HANDLE);
    DWORD mode;
    if (!GetConsoleMode(console, &mode))
        return false;
    if (mode & ENABLE_VIRTUAL_TERMINAL_PROCESSING)
        return true;
    if (!SetConsoleMode(console, mode | ENABLE_VIRTUAL_TERMINAL_PROCESSING))
        return false;
    mode_before = mode;
    if (!is_changed)
        atexit(put_back);
    is_changed = true;
    return true;
}

int ffd_terminal_width(void)
{
    CONSOLE_SCREEN_BUFFER_INFO info;
    const bool is_known = GetConsoleScreenBufferInfo(GetStdHandle(STD_ERROR_HANDLE), &info);
    const int width = is_known ? info.srWindow.Right - info.srWindow.Left + 1 : 0;
    return width > 1 ? width : 80;
}
