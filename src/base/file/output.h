/* output.h - writing files that are complete or absent. All paths are UTF-8. */
#ifndef FFD_BASE_FILE_OUTPUT_H
#define FFD_BASE_FILE_OUTPUT_H

#include "base/fail.h"
#include "base/file/written_files.h"
#include "base/memory/hash.h"
#include <stdbool.h>
#include <stddef.h>

/* A set of files that appear together. Each is written under a temporary name beside its target
   (".NAME.ffd-tmp"; the same for the same target, locked against other runs) and renamed by the commit, the
   one begun last after all others (file_set.h). A set of paths in memory (memory_files.h) is collected, and
   given to its callback by the commit: file by file in the order in which they were begun, up to one that the
   callback does not take. */
typedef struct file_output file_output;

/* An empty set, for ffd_output_destroy. Errors: FFD_E_MEMORY. */
ffd_status ffd_output_create(file_output **output, ffd_error *error);
/* From now on the set refuses targets that written holds (FFD_E_EXISTS), and its commit adds what it wrote.
   written may be NULL and must outlive the set. */
void ffd_output_record(file_output *output, written_files *written);
/* From now on the bytes of the set's first file are hashed as they are written. */
void ffd_output_hash(file_output *output);
/* Gives their hash; false: the set is not one regular file, or has none. */
bool ffd_output_hash_value(const file_output *output, hash128 *hash);
/* Whether path names an open stream of this process: "-" (standard output), /dev/stdout,
   /dev/stderr, /dev/fd/N. */
bool ffd_output_is_stream(const char *path);
/* Starts the next file. To a stream bytes go at the commit's time or before, after what it holds. An
   existing target is refused with FFD_E_EXISTS unless force, by the commit too if it appeared meanwhile.
   Permission bits of an existing target are kept. A character device (/dev/null) is written straight; a pipe,
   a socket, another device and a link that leads to no file are refused with FFD_E_IO. */
ffd_status ffd_output_begin(file_output *output, const char *path, bool force, ffd_error *error);
/* Makes a folder for the next file, and those above it. They go again if the set is not committed. */
ffd_status ffd_output_folder(file_output *output, const char *path, ffd_error *error);
/* Appends to the file begun last. */
ffd_status ffd_output_write(file_output *output, const void *bytes, size_t size, ffd_error *error);
/* The commit leaves the file begun last open, for writing and reading, and locked. Returns its descriptor,
   which is closed with the set. */
int ffd_output_keep_open(file_output *output);
/* From now on, where all files of the set have targets of the very same bytes, its commit leaves these as
   they are, with their times. */
void ffd_output_keep_equal(file_output *output);
/* Makes all files appear. After a failure the old ones are there, or none. */
ffd_status ffd_output_commit(file_output *output, ffd_error *error);
/* Whether ffd_output_begin has just failed because another run is writing the target. */
bool ffd_output_was_busy(const file_output *output);
/* Frees; removes the temporary files of what was not committed. NULL and pointers to NULL are allowed. */
void ffd_output_destroy(file_output **output);
/* The refusals of ffd_output_begin, before any work is done. */
ffd_status ffd_output_check(const char *path, bool force, ffd_error *error);

#endif
