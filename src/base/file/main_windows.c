/* main_windows.c - where the program begins on Windows: its arguments in UTF-8, and file names in place of
   patterns, which the command line of Windows leaves to programs. */
#include "base/file/glob.h"
#include "base/memory/memory.h"
#include "base/windows/names.h"
#include "base/windows/posix.h"
#include <pthread.h>
#include <windows.h>

/* Milliseconds that a line for a console waits at most; bytes that wait. */
enum { FLUSH_INTERVAL = 50, CONSOLE_BUFFER = 1 << 16 };

int main(int argc, char **argv);
int wmain(void);

/* The arguments so far. */
typedef struct arguments {
    path_list words;
    bool failed; /* memory ran out */
} arguments;

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

/* Adds a word or, as a shell does, the files that it matches if it has * or ? outside of quotes. */
static void add_word(arguments *given, const wchar_t *wide, bool is_pattern)
{
    char *const word = ffd_utf8(wide);
    path_list found = {0};
    if (word && is_pattern && ffd_glob(word, &found, NULL))
        ffd_paths_free(&found);
    for (size_t i = 0; i < found.count; i++)
        given->failed = given->failed || ffd_paths_add(&given->words, found.paths[i], NULL);
    if (found.count == 0)
        given->failed = given->failed || !word || ffd_paths_add(&given->words, word, NULL);
    ffd_paths_free(&found);
    free(word);
}

/* Takes a word of the command line, by the rules of CommandLineToArgvW: 2n backslashes before a quotation
   mark are n of them, and 2n+1 are n and the mark itself; two marks inside of quotes are one. The first word,
   the program, has no backslashes with a meaning. */
static const wchar_t *take_word(const wchar_t *at, bool is_program, wchar_t *word, bool *is_pattern)
{
    bool quoted = false;
    for (*is_pattern = false; *at && (quoted || (*at != ' ' && *at != '\t')); at++) {
        size_t slashes = 0;
        while (!is_program && at[slashes] == '\\')
            slashes++;
        const bool marked = at[slashes] == '"';
        for (size_t i = marked ? slashes / 2 : slashes; i > 0; i--)
            *word++ = '\\';
        at += slashes;
        if (marked && slashes % 2 == 0) {
            if (quoted && !is_program && at[1] == '"')
                *word++ = *at++;
            else
                quoted = !quoted;
            continue;
        }
        if (slashes > 0 && !marked) {
            at--;
            continue;
        }
        *is_pattern = *is_pattern || (!quoted && (*at == '*' || *at == '?'));
        *word++ = *at;
    }
    *word = 0;
    return at + wcsspn(at, L" \t");
}

int wmain(void)
{
    const wchar_t *at = GetCommandLineW();
    wchar_t *const word = ffd_alloc(wcslen(at) + 1, sizeof *word);
    arguments given = {0};
    for (bool is_pattern, is_first = true; word && (*at || is_first); is_first = false) {
        at = take_word(at, is_first, word, &is_pattern);
        add_word(&given, word, is_pattern && !is_first);
    }
    ffd_free(word);
    given.failed = given.failed || !word || ffd_paths_add(&given.words, "", NULL);
    if (given.failed) {
        fputs("ffd: out of memory\n", stderr);
        return ffd_status_exit_code(FFD_E_MEMORY);
    }
    ffd_free(given.words.paths[--given.words.count]);
    given.words.paths[given.words.count] = NULL;
    if (is_console(STD_OUTPUT_HANDLE) || is_console(STD_ERROR_HANDLE)) {
        set_console_page();
        buffer_console();
    }
    return main((int)given.words.count, given.words.paths);
}
