/* program.h - what programs need beside the library. First what holds for the whole process: handlers of
   signals, and how messages name settings; it is not for libraries that use this one, and the library never
   sets any of it by itself. Then words and paths, as the program `ffd` has them. */
#ifndef FFD_PROGRAM_H
#define FFD_PROGRAM_H

#include <ffd/error.h>
#include <ffd/export.h>
#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Takes the descriptors of standard streams that are closed: else the next file that is opened would get one
   of them, and messages be written into it. Writing to them remains an error. To be called first of all when
   the program starts. */
FFD_API void ffd_occupy_closed_streams(void);

/* Installs handlers for those of SIGHUP, SIGINT, SIGPIPE, SIGQUIT and SIGTERM that would end the program:
   they remove the temporary files of unfinished outputs before it ends. On Windows the same for Ctrl-C and
   for a console that is closed. Beyond a limit on the sizes of files (SIGXFSZ), writing fails from now on
   instead of ending the program. To be called once when the program starts. */
FFD_API void ffd_cleanup_on_signals(void);

/* Installs a SIGBUS handler. Large input files are mapped into memory; if another program truncates one while
   it is read, the system raises SIGBUS. With the handler the function that reads the file fails with FFD_E_IO
   instead. A SIGBUS with another cause is passed to the previous handler. To be called once when the
   program starts. */
FFD_API void ffd_guard_inputs(void);

/* Writes to text how a front end spells a member of a description (or an argument) in messages. member: as in
   these headers ("falloff", "input.space"); value: its value in a word ("extend"), or NULL. In a format for
   printf the value may be a conversion, which is to be copied. */
typedef void (*ffd_spell_function)(const char *member, const char *value, char *text, size_t capacity);

/* Makes the library's messages name members as a front end does: "--falloff needs --outside extend" by the
   program's function; "falloff needs outside = extend" by default, and again after NULL. To be called
   before all other functions. */
FFD_API void ffd_spell_members(ffd_spell_function spell);

/* Replaces what breaks a line, controls a terminal or turns the direction of a text, each byte by '?':
   control characters (ASCII and U+0080 to U+009F), U+2028 to U+202E and U+2066 to U+2069. All other bytes
   stay. Thread-safe. */
FFD_API void ffd_make_one_line(char *text, size_t size);

/* Returns the entry of known (count words) that is most similar to word by edit distance, the first one if
   there are several; NULL if count is 0. Thread-safe. */
FFD_API const char *ffd_nearest_word(const char *word, const char *const *known, size_t count);
/* Returns that entry if it is what an unknown word means; NULL if it is not similar enough, if others are as
   similar, or if the word is that entry with a minus, its opposite. Thread-safe. */
FFD_API const char *ffd_word_meant(const char *word, const char *const *known, size_t count);

/* Returns whether both paths lead to the same file, which need not exist yet; false if memory runs out.
   Thread-safe. */
FFD_API bool ffd_paths_meet(const char *a, const char *b);

/* Makes the path of an output in a folder that keeps the name of its input; ending: which it gets instead of
   its own, or NULL. The caller frees *path with ffd_free. Thread-safe. Errors: FFD_E_MEMORY. */
FFD_API ffd_status ffd_output_path(const char *folder, const char *input, const char *ending, char **path,
                                   ffd_error *error);

/* Checks that no file is where a folder for outputs is to be. A folder need not be there yet. Thread-safe.
   Errors: FFD_E_IO, FFD_E_MEMORY. */
FFD_API ffd_status ffd_check_output_folder(const char *folder, ffd_error *error);

/* How far a call has come, on standard error: a bar that is redrawn ten times a second on a terminal, else a
   line every ten seconds. For one thread. */
typedef struct ffd_bar ffd_bar;

/* Starts the clock. what: the word in front ("fit"), which must stay until the bar is destroyed. The caller
   destroys it with ffd_bar_destroy. Returns NULL if memory runs out; the other functions then do nothing. */
FFD_API ffd_bar *ffd_bar_create(const char *what);
/* A callback of progress, with the bar as its user. Returns true. */
FFD_API bool ffd_bar_show(void *bar, double done);
/* Removes what is on the terminal: before anything else is written there. bar may be NULL. */
FFD_API void ffd_bar_clear(ffd_bar *bar);
/* Clears and frees the bar; sets *bar to NULL. bar and *bar may be NULL. */
FFD_API void ffd_bar_destroy(ffd_bar **bar);

/* Does the work of this process if ffd_batch_run has started it (ffd/batch.h), and sets *exit_code. Returns
   false otherwise. The program `ffd` calls it with the arguments of main, after ffd_cleanup_on_signals. */
FFD_API bool ffd_worker_main(int argc, char **argv, int *exit_code);

#ifdef __cplusplus
}
#endif

#endif
