/* main_windows.c - where the program begins on Windows: with its arguments in UTF-8, and a console that shows
   UTF-8. */
#include "base/file/program_words.h"
#include <ffd/error.h>
#include <pthread.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <windows.h>

/* Milliseconds that a line for a console waits at most; bytes that wait. */
enum { FLUSH_INTERVAL = 50, CONSOLE_BUFFER = 1 << 16 };

int main(int argc, char **argv);
int wmain(void);

static UINT page_before;

static void put_page_back(void)
{
    SetConsoleOutputCP(page_before);
}

static bool is_console(DWORD stream)
{
    DWORD mode;
    return GetConsoleMode(GetStdHandle(stream), &mode);
}

/* Messages are UTF-8. */
static void set_console_page(void)
{
    page_before = GetConsoleOutputCP();
    if (page_before != 0 && page_before != CP_UTF8 && SetConsoleOutputCP(CP_UTF8))
        atexit(put_page_back);
}

/* A printf locks its stream: none is cut. */
static void *flush_streams(void *nothing)
{
    for (;; Sleep(FLUSH_INTERVAL)) {
        fflush(stdout);
        fflush(stderr);
    }
    return nothing;
}

/* The printf of mingw-w64 writes byte by byte, and a console would take each byte of a character for one of
   its own: what is printed is kept for a moment. */
static void buffer_console(void)
{
    static const DWORD streams[] = {STD_OUTPUT_HANDLE, STD_ERROR_HANDLE};
    pthread_t thread;
    if (pthread_create(&thread, NULL, flush_streams, NULL) != 0)
        return;
    pthread_detach(thread);
    for (int i = 0; i < 2; i++)
        if (is_console(streams[i]))
            setvbuf(i == 0 ? stdout : stderr, NULL, _IOFBF, CONSOLE_BUFFER);
}

int wmain(void)
{
    int count;
    char **const words = ffd_program_words(&count);
    if (!words) {
        fputs("ffd: out of memory\n", stderr);
        return ffd_status_exit_code(FFD_E_MEMORY);
    }
    if (is_console(STD_OUTPUT_HANDLE) || is_console(STD_ERROR_HANDLE)) {
        set_console_page();
        buffer_console();
    }
    return main(count, words);
}
