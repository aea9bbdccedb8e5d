/* input.h - reading whole files, and telling which file a path leads to. All paths are UTF-8. */
#ifndef FFD_BASE_FILE_INPUT_H
#define FFD_BASE_FILE_INPUT_H

#include "base/fail.h"
#include "base/file/mapping.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct file_input {
    const unsigned char *data; /* never NULL after success, also when size is 0 */
    size_t size;
    void *block; /* how it is held: mapped or allocated */
    bool mapped;
    file_mapping *mapping; /* where it is mapped */
    uint64_t identity[2];  /* of a regular file that is not empty: the same whatever name led to it */
} file_input;

/* Reads path ("-": standard input, also where that is a pipe). Large regular files are mapped (mmap): see
   mapping.h for what happens when one becomes shorter; a smaller one that does so fails with FFD_E_IO. A
   folder, a pipe and a device are refused (FFD_E_IO), but for /dev/stdin, /dev/fd/N and /dev/null; so is a
   stream that does not end (FFD_E_LIMIT). */
ffd_status ffd_file_load(const char *path, file_input *input, ffd_error *error);
/* Maps small files too: for callers that keep many files open and must not spend memory on them. */
ffd_status ffd_file_map(const char *path, file_input *input, ffd_error *error);
/* Loads a file that a model refers to: relative must lead to a regular file inside folder, links followed
   (canonical paths are compared). Else FFD_E_IO with `named_by` as the file of the message. Small files are
   read if they have at most *most bytes, from which they are then taken; all others are mapped. */
ffd_status ffd_file_load_within(const char *folder, const char *relative, const char *named_by, size_t *most,
                                file_input *input, ffd_error *error);
/* Frees or unmaps what was loaded; an input of zeros is allowed. */
void ffd_file_unload(file_input *input);
/* Prefaults bytes, of a memory-mapped file or any others, that are about to be read or written: all at once,
   if the system has a call for that. Without it a read waits for a few pages at a time; and a write copies
   without waiting, clears what it could not fill, and begins again, once for every page. Does nothing if
   there are too few bytes to be worth the call. Thread-safe. */
void ffd_file_prefault(const void *bytes, size_t size);
/* Releases the pages of bytes that are not needed for a while, if the system can read them from the file
   again by itself. Thread-safe. */
void ffd_file_release_pages(const file_input *input, const void *bytes, size_t size);
/* For a file that is read from start to end: releases the pages between *released and `end`, if there are
   enough of them to be worth the call, which stops the other threads for a moment. The caller releases the
   rest at the end. Pages that another thread still reads are read in again. One thread at a time. */
void ffd_file_release_until(const file_input *input, const void *end, size_t *released);

/* Whether path names a stream of this process or the null device, not a file: "-",
   /dev/stdin, /dev/fd/N, /dev/null. */
bool ffd_file_is_stream(const char *path);
/* Whether what it gives can be read once only: a stream, a pipe or another device. */
bool ffd_file_reads_once(const char *path);
/* The path as messages show it: "-" -> "standard input"; of a file in memory (memory_files.h) its name;
   others as they are. */
const char *ffd_file_display_name(const char *path);
/* Whether a file or folder of this name exists (links are followed). */
bool ffd_file_exists(const char *path);
/* Tells whether a file is the one that it was: which it is, its size and when it was written. */
typedef struct file_stamp {
    uint64_t device, number, size;
    int64_t written[2], changed[2]; /* its bytes; these, or what is known of it: seconds and nanoseconds */
} file_stamp;
/* Reads the stamp of a regular file. Returns false if there is none. */
bool ffd_file_stamp(const char *path, file_stamp *stamp);
/* Whether both stamps are of one file in one state. */
bool ffd_stamp_equal(const file_stamp *a, const file_stamp *b);
/* Whether all files are still as their stamps say. */
bool ffd_stamps_hold(char *const *paths, const file_stamp *stamps, size_t count);
/* Whether both paths lead to one existing file. */
bool ffd_file_same(const char *a, const char *b);
/* Whether path is a file of just these bytes. Errors: those of reading it. */
ffd_status ffd_file_compare(const char *path, const file_input *bytes, bool *same, ffd_error *error);

#endif
