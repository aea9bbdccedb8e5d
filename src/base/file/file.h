/* file.h - reading whole files, and writing files that are complete or absent. All paths are UTF-8. */
#ifndef FFD_BASE_FILE_FILE_H
#define FFD_BASE_FILE_FILE_H

#include "base/fail.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct file_input {
    const unsigned char *data; /* never NULL after success, also when size is 0 */
    size_t size;
    void *block; /* how it is held: mapped or allocated */
    bool mapped;
    uint64_t identity[2]; /* of a regular file that is not empty: the same whatever name led to it */
} file_input;

/* Reads path ("-": standard input, also where that is a pipe). Large regular files are mapped. A folder, a
   pipe and a device are refused (FFD_E_IO), but for /dev/stdin, /dev/fd/N and /dev/null; so is a stream that
   does not end (FFD_E_LIMIT). */
ffd_status ffd_file_load(const char *path, file_input *input, ffd_error *error);
/* Maps small ones too: for files of which there may be many at a time, that are to take no memory then. */
ffd_status ffd_file_map(const char *path, file_input *input, ffd_error *error);
/* Maps a file that a model refers to: relative must lead to a regular file inside folder, links followed
   (canonical paths are compared). Else FFD_E_IO with `named_by` as the file of the message. */
ffd_status ffd_file_load_within(const char *folder, const char *relative, const char *named_by,
                                file_input *input, ffd_error *error);
void ffd_file_unload(file_input *input);
/* For bytes, of a mapped file or any others, that are about to be read or written: brings them into memory at
   once, where the system has a call for that. Else a read waits for a few pages at a time; and a write copies
   without waiting for any, clears what it could not fill, and begins again, once a page. Does nothing where
   there are so few that it is not worth the call. Any thread. */
void ffd_file_bring_in(const void *bytes, size_t size);
/* For bytes that are not needed for a while: gives back the memory that they take where the system can read
   them again, by itself, from the file. Any thread. */
void ffd_file_forget(const file_input *input, const void *bytes, size_t size);
/* For a file that is gone through from its beginning on: gives back what stands before a place and has not
   been given back, behind *forgotten bytes, where that is worth the call, which stops the other threads for a
   moment; what is left in the end is the caller's to give back. Pages that another thread still reads come
   again. One thread at a time. */
void ffd_file_forget_until(const file_input *input, const void *place, size_t *forgotten);

/* Whether path names a stream of this process or nothing, and no file that stands somewhere: "-",
   /dev/stdin, /dev/fd/N, /dev/null. */
bool ffd_file_is_stream(const char *path);
bool ffd_file_exists(const char *path);
/* Tells whether a file is the one that it was: which it is, its size and when it was written. */
typedef struct file_stamp {
    uint64_t device, number, size;
    int64_t written[2], changed[2]; /* its bytes; these, or what is known of it: seconds and nanoseconds */
} file_stamp;
bool ffd_file_stamp(const char *path, file_stamp *stamp);
bool ffd_stamp_equal(const file_stamp *a, const file_stamp *b);
/* Whether both paths lead to one existing file. */
bool ffd_file_same(const char *a, const char *b);
/* Whether path is a file of just these bytes. Errors: those of reading it. */
ffd_status ffd_file_compare(const char *path, const file_input *bytes, bool *same, ffd_error *error);
/* Makes a folder and those above it, where they do not exist. *made: the length of the first path that was
   made (0: none), also after a failure. */
ffd_status ffd_folder_make(const char *path, size_t *made, ffd_error *error);
/* Removes what ffd_folder_make made, where it is empty; shortens path. */
void ffd_folder_unmake(char *path, size_t made);
/* The absolute path of a file or folder, without links; NULL where there is none (or no memory). Free with
   ffd_free. */
char *ffd_path_resolve(const char *path);

/* A set of files that appear together. Each is written under a temporary name beside its target
   (".NAME.ffd-tmp"; the same for the same target, locked against other runs) and renamed by the commit in the
   order of begin. */
typedef struct file_output file_output;

/* The files that a run has written so far (written_files.h). */
typedef struct written_files written_files;
/* Whether path leads to one of them, under whatever name it was written. */
bool ffd_written_holds(const written_files *written, const char *path);

ffd_status ffd_output_create(file_output **output, ffd_error *error);
/* From now on the set refuses targets that written holds (FFD_E_EXISTS), and its commit adds what it wrote.
   written may be NULL and must outlive the set. */
void ffd_output_record(file_output *output, written_files *written);
/* Whether path names an open stream of this process: "-" (standard output), /dev/stdout, /dev/stderr,
   /dev/fd/N. */
bool ffd_output_is_stream(const char *path);
/* Starts the next file. To a stream bytes go at the commit's time or before, behind what it holds. An
   existing target is refused with FFD_E_EXISTS unless force. Permission bits of an existing target are kept.
   Targets that are neither file nor link (/dev/null) are written straight. */
ffd_status ffd_output_begin(file_output *output, const char *path, bool force, ffd_error *error);
/* Makes a folder for the next file, and those above it. They go again if the set is not committed. */
ffd_status ffd_output_folder(file_output *output, const char *path, ffd_error *error);
/* Appends to the file begun last. */
ffd_status ffd_output_write(file_output *output, const void *bytes, size_t size, ffd_error *error);
/* Removes the old target of the file begun last before the commit renames anything (a .gltf whose buffers are
   replaced). */
void ffd_output_remove_first(file_output *output);
/* From now on, where all files of the set have targets of the very same bytes, its commit leaves these as
   they are, with their times. */
void ffd_output_keep_equal(file_output *output);
/* Makes all files appear. After a failure none that was not yet renamed does. */
ffd_status ffd_output_commit(file_output *output, ffd_error *error);
/* Whether ffd_output_begin has just failed because another run is writing the target. */
bool ffd_output_was_busy(const file_output *output);
/* Frees; removes the temporary files of what was not committed. NULL and pointers to NULL are allowed. */
void ffd_output_destroy(file_output **output);
/* The refusals of ffd_output_begin, before any work is done. */
ffd_status ffd_output_check(const char *path, bool force, ffd_error *error);

#endif
