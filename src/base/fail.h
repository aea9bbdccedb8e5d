/* fail.h - fills the caller's error record (error may be NULL). Each function returns the status, so that
   callers can write `return ffd_fail(...)`. Formats name members in braces (base/spelling.h). */
#ifndef FFD_BASE_FAIL_H
#define FFD_BASE_FAIL_H

#include <ffd/error.h>

#ifdef __cplusplus
extern "C" {
#endif

#ifdef __MINGW32__ /* whose __printf__ is that of the C runtime of Windows */
#define FFD_PRINTF(text, first) __attribute__((__format__(__gnu_printf__, text, first)))
#elif defined(__GNUC__)
#define FFD_PRINTF(text, first) __attribute__((__format__(__printf__, text, first)))
#else
#define FFD_PRINTF(text, first)
#endif

/* Returns the status of a call that fails, from the function that makes it: for functions in which nothing is
   to be freed then. */
#define TRY(call)                                                                                            \
    do {                                                                                                     \
        const ffd_status try_status = (call);                                                                \
        if (try_status)                                                                                      \
            return try_status;                                                                               \
    } while (0)

/* Sets `status` to that of a call, and goes to `end` if it fails: for functions that free something there. */
#define TRY_END(call)                                                                                        \
    do {                                                                                                     \
        status = (call);                                                                                     \
        if (status)                                                                                          \
            goto end;                                                                                        \
    } while (0)

/* A failure without a file. Line breaks and control characters in the text are replaced by '?'. */
ffd_status ffd_fail(ffd_error *error, ffd_status status, const char *format, ...) FFD_PRINTF(3, 4);
/* A failure that concerns a file. */
ffd_status ffd_fail_file(ffd_error *error, ffd_status status, const char *file, const char *format, ...)
    FFD_PRINTF(4, 5);
/* The message is "WHAT: REASON", with the reason from errno. The status is FFD_E_MEMORY for ENOMEM, else
   FFD_E_IO. */
ffd_status ffd_fail_errno(ffd_error *error, const char *file, const char *what);
/* A failure at a line (from 1) of a file. */
ffd_status ffd_fail_line(ffd_error *error, ffd_status status, const char *file, size_t line,
                         const char *format, ...) FFD_PRINTF(5, 6);
/* A failure at a JSON pointer into a file. line: of the value, from 1; 0: the file has no lines. */
ffd_status ffd_fail_at(ffd_error *error, ffd_status status, const char *file, size_t line,
                       const char *pointer, const char *format, ...) FFD_PRINTF(6, 7);
/* "out of memory", FFD_E_MEMORY. */
ffd_status ffd_fail_memory(ffd_error *error);
/* Hands over a failure that is kept in a record of one's own, because it may be none. Returns status; nothing
   is written if it is FFD_OK. */
ffd_status ffd_fail_as(ffd_status status, const ffd_error *own, ffd_error *error);
/* Returns the status that a callback of the user's has returned, or FFD_E_IO if it is not an ffd_status. */
ffd_status ffd_status_known(ffd_status status);
/* Sets the file of an error that does not have one. */
void ffd_fail_name_file(ffd_error *error, const char *file);

#ifdef __cplusplus
}
#endif

#endif
