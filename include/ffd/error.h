/* error.h - errors: a status for programs, a message of one line for people. */
#ifndef FFD_ERROR_H
#define FFD_ERROR_H

#include <ffd/export.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The result of every function that can fail. The numbers never change. Failures have different codes only if
   a caller would handle them differently; ffd_error has the details. The exit code of the program `ffd` is
   given in parentheses. */
typedef enum ffd_status {
    FFD_OK = 0,
    FFD_E_GATE = -1,         /* a quality gate (ffd_gate) is violated (exit 1) */
    FFD_E_UNMET = -2,        /* what is asked for cannot be met: rows that contradict each other (exit 1) */
    FFD_E_ARGUMENT = -10,    /* the caller passed an argument that the function does not accept (exit 2) */
    FFD_E_IO = -20,          /* a file cannot be read or written (exit 3) */
    FFD_E_EXISTS = -21,      /* the output exists and must not be overwritten (exit 3) */
    FFD_E_INVALID = -30,     /* a mesh, lattice or manifest is not valid (exit 4) */
    FFD_E_EMBEDDING = -40,   /* the embedding failed: a vertex is outside, with FFD_OUTSIDE_ERROR (exit 5) */
    FFD_E_UNSUPPORTED = -50, /* valid input that needs what this build does not have (exit 6) */
    FFD_E_MEMORY = -60,      /* out of memory (exit 7) */
    FFD_E_LIMIT = -61,       /* a documented limit is exceeded (exit 7) */
    FFD_E_CANCELLED = -70    /* the caller's progress function returned false (exit 1) */
} ffd_status;

/* Details of a failure. Functions that can fail take a pointer to the caller's record as their last argument;
   NULL if the details are not needed. They write the record only when they fail. All strings end with a 0
   byte and contain no control characters. */
typedef struct ffd_error {
    ffd_status status; /* the status that the function returned */
    char file[1024];   /* path or name of the file; "": none */
    size_t line;       /* line in the file, from 1; 0: none */
    char pointer[256]; /* JSON pointer (RFC 6901) into the file, at that line if there is one; "": none */
    char message[512]; /* what is wrong, with the value, in English */
} ffd_error;

/* Formats an error as "FILE: MESSAGE", "FILE:LINE: MESSAGE", "FILE:LINE: POINTER: MESSAGE" or
   "FILE:POINTER: MESSAGE", or "MESSAGE" if it names no file. Writes at most
   capacity bytes to text, including a final 0; text may be NULL if capacity is 0. Returns the length of the
   whole line without the 0, as snprintf does. Thread-safe. */
FFD_API size_t ffd_error_format(const ffd_error *error, char *text, size_t capacity);

/* Returns the exit code of the program `ffd` for a status, 0 to 7 (data/schema/formats.md 1); 7 for an
   unknown status. Thread-safe. */
FFD_API int ffd_status_exit_code(ffd_status status);

#ifdef __cplusplus
}
#endif

#endif
