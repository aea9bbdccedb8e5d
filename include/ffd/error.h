/* error.h - what can go wrong, for programs (a status) and for people (one line). */
#ifndef FFD_ERROR_H
#define FFD_ERROR_H

#include <ffd/export.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Returned by every function that can fail. 0 is success; the numbers never change. A code exists
   only where a caller would act differently; the words are in ffd_error. Behind each: the exit code
   of the program `ffd`. */
typedef enum ffd_status {
    FFD_OK = 0,
    FFD_E_GATE = -1,         /* a quality gate of --fail-on is violated (exit 1) */
    FFD_E_ARGUMENT = -10,    /* the caller's arguments are not what the function takes (exit 2) */
    FFD_E_IO = -20,          /* a file cannot be read or written (exit 3) */
    FFD_E_EXISTS = -21,      /* the output exists and overwriting was not asked for (exit 3) */
    FFD_E_INVALID = -30,     /* a mesh, lattice or manifest is not valid (exit 4) */
    FFD_E_EMBEDDING = -40,   /* the embedding failed, e.g. a vertex outside under --outside error (exit 5) */
    FFD_E_UNSUPPORTED = -50, /* valid, but this build cannot do it (exit 6) */
    FFD_E_MEMORY = -60,      /* out of memory (exit 7) */
    FFD_E_LIMIT = -61,       /* a documented limit was passed (exit 7) */
    FFD_E_CANCELLED = -70    /* the caller's progress function said so (exit 1) */
} ffd_status;

/* The caller's own record of a failure; every function takes a pointer to one last, NULL where the words are
   not wanted. Written only when the function fails. All strings end in 0 and hold no line break. */
typedef struct ffd_error {
    ffd_status status;
    char file[1024];   /* the file concerned, "" where there is none */
    size_t line;       /* line in it from 1, 0 where there is none */
    char pointer[256]; /* JSON pointer (RFC 6901) into the file, "" where there is none */
    char message[512]; /* what is wrong, with the value */
} ffd_error;

/* Writes "FILE[:LINE|:POINTER]: MESSAGE" (or just MESSAGE) and a final 0 to text, cut to capacity bytes.
   Returns the length of the uncut line. error and text are not NULL unless capacity is 0. Thread-safe. */
FFD_API size_t ffd_error_format(const ffd_error *error, char *text, size_t capacity);

/* The exit code (0 to 7; data/schema/formats.md 1) that stands for a status. Thread-safe. */
FFD_API int ffd_status_exit_code(ffd_status status);

#ifdef __cplusplus
}
#endif

#endif
