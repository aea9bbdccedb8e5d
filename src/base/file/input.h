/* input.h - reads whole files, and tells which file a path leads to. All paths are UTF-8. */
#ifndef FFD_BASE_FILE_INPUT_H
#define FFD_BASE_FILE_INPUT_H

#include "base/fail.h"
#include "base/file/mapping.h"
#include <ffd/lattice.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct file_input {
    const unsigned char *data; /* never NULL after success, also when size is 0 */
    size_t size;
    void *block; /* the mapped or allocated memory */
    bool mapped;
    file_mapping *mapping; /* of a mapped file (mapping.h) */
    uint64_t identity[2];  /* identifies a regular file that is not empty, whatever path led to it */
} file_input;

/* Opens path ("-": standard input) for reading. A folder, a pipe and a device are FFD_E_IO, except
   /dev/stdin, /dev/fd/N and /dev/null. The caller closes *fd, unless it is STDIN_FILENO. */
ffd_status ffd_file_open(const char *path, int *fd, ffd_error *error);
/* Loads path ("-": standard input, also a pipe). Large regular files are mapped (mmap); mapping.h says what
   happens if one is truncated meanwhile. Truncation of a smaller file is FFD_E_IO, an endless stream
   FFD_E_LIMIT. Other errors: those of ffd_file_open. */
ffd_status ffd_file_load(const char *path, file_input *input, ffd_error *error);
/* Lends bytes in memory, which must stay as they are until the input is unloaded. name: for messages. Errors:
   FFD_E_MEMORY. */
ffd_status ffd_file_lend(ffd_bytes bytes, const char *name, file_input *input, ffd_error *error);
/* Lends bytes, if there are any, under the name `path`; else loads the file. */
ffd_status ffd_file_take(const char *path, ffd_bytes bytes, file_input *input, ffd_error *error);
/* As ffd_file_load, but maps small files too: for callers that keep many files open and must save memory. */
ffd_status ffd_file_map(const char *path, file_input *input, ffd_error *error);
/* Loads a file that a model refers to. relative must lead to a regular file inside folder after all symbolic
   links are followed (canonical paths are compared); otherwise FFD_E_IO with `named_by` as the file of the
   message. A small file of at most *most bytes is read, and its size subtracted from *most; all others are
   mapped. */
ffd_status ffd_file_load_within(const char *folder, const char *relative, const char *named_by, size_t *most,
                                file_input *input, ffd_error *error);
/* Frees or unmaps a loaded file; an input of zeros is allowed. */
void ffd_file_unload(file_input *input);
/* Prefaults bytes of a memory-mapped file, or of any memory, that are about to be read or written, with a
   single system call if the system has one (MADV_POPULATE_READ). Without that, reading them faults in a few
   pages at a time; and a system call that writes them to a file copies page by page, and starts again at each
   page that is not resident. Does nothing for small ranges. Thread-safe. */
void ffd_file_prefault(const void *bytes, size_t size);
/* Releases the pages of bytes that are not needed for a while, if they are mapped, so that the system can
   read them again from the file. Thread-safe. */
void ffd_file_release_pages(const file_input *input, const void *bytes, size_t size);
/* For a file that is read sequentially: releases the pages from the offset *released up to `end`, if there
   are enough of them to be worth the call, which interrupts the other threads. The caller releases the rest
   at the end. Pages that another thread still needs are read again. One thread at a time. */
void ffd_file_release_until(const file_input *input, const void *end, size_t *released);

/* Returns whether path names a stream of this process or the null device instead of a file: "-", /dev/stdin,
   /dev/fd/N, /dev/null. */
bool ffd_file_is_stream(const char *path);
/* Returns whether path can be read only once: a stream, a pipe or another device. */
bool ffd_file_reads_once(const char *path);
/* Returns the path as messages show it: "standard input" for "-", any other path
   unchanged. */
const char *ffd_file_display_name(const char *path);
/* Returns whether a file or folder exists at path (symbolic links are followed). */
bool ffd_file_exists(const char *path);
/* Identifies a file and its state: identity, size and times. */
typedef struct file_stamp {
    uint64_t device, inode, size;
    int64_t written[2], changed[2]; /* mtime and ctime: seconds and nanoseconds */
} file_stamp;
/* Reads the stamp of a regular file. Returns false if there is none. */
bool ffd_file_stamp(const char *path, file_stamp *stamp);
/* Returns whether both stamps are of the same file in the same state. */
bool ffd_stamp_equal(const file_stamp *a, const file_stamp *b);
/* Returns whether all files still match their stamps. */
bool ffd_stamps_hold(char *const *paths, const file_stamp *stamps, size_t count);
/* Returns whether both paths lead to the same existing file. */
bool ffd_file_same(const char *a, const char *b);
/* Sets *same to whether the file at path has exactly these bytes. Errors: those of reading it. */
ffd_status ffd_file_compare(const char *path, const file_input *bytes, bool *same, ffd_error *error);

#endif
