/* program.h - handlers of signals, which are those of the whole process: for programs, not for libraries that
   use this one. The library never installs them by itself. */
#ifndef FFD_PROGRAM_H
#define FFD_PROGRAM_H

#include <ffd/export.h>

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

#ifdef __cplusplus
}
#endif

#endif
