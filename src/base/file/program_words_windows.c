/* program_words_windows.c - the words of a command line, which Windows leaves to programs: in UTF-8, with
   file names in place of patterns. */
#include "base/file/glob.h"
#include "base/file/program_words.h"
#include "base/memory/memory.h"
#include "base/windows/names.h"
#include "base/windows/posix.h"
#include <windows.h>

/* The arguments so far. */
typedef struct arguments {
    path_list words;
    bool failed; /* memory ran out */
} arguments;

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

char **ffd_program_words(int *count)
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
    if (given.failed)
        return NULL;
    ffd_free(given.words.paths[--given.words.count]);
    given.words.paths[given.words.count] = NULL;
    *count = (int)given.words.count;
    return given.words.paths;
}
