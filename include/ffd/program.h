/* program.h - what holds for the whole process: handlers of signals, and how messages name settings. For
   programs, not for libraries that use this one; the library never sets any of it by itself. */
#ifndef FFD_PROGRAM_H
#define FFD_PROGRAM_H

#include <ffd/export.h>
#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Installs handlers for those of SIGHUP, SIGINT, SIGPIPE, SIGQUIT and SIGTERM that would end the program:
   they remove the temporary files of unfinished outputs before it ends. To be called once when the program
   starts. */
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

/* Does the work of this process if ffd_batch_run has started it (ffd/batch.h), and sets *exit_code. Returns
   false otherwise. The program `ffd` calls it with the arguments of main, after ffd_cleanup_on_signals. */
FFD_API bool ffd_worker_main(int argc, char **argv, int *exit_code);

#ifdef __cplusplus
}
#endif

#endif
