/* output.h - writes files that are complete or absent. All paths are UTF-8. */
#ifndef FFD_BASE_FILE_OUTPUT_H
#define FFD_BASE_FILE_OUTPUT_H

#include "base/fail.h"
#include "base/file/written_files.h"
#include "base/memory/hash.h"
#include <ffd/job.h>
#include <stdbool.h>
#include <stddef.h>

/* A set of files that appear together. Each file is written under a temporary name in the folder of its
   target (".NAME.ffd-tmp", always the same for a target, locked against other runs). The commit renames all
   files; the one begun last is the head (file_set.h). */
typedef struct file_output file_output;

/* Creates an empty set; the caller destroys it with ffd_output_destroy. Errors: FFD_E_MEMORY. */
ffd_status ffd_output_create(file_output **output, ffd_error *error);
/* From now on the set refuses targets that are in `written` (FFD_E_EXISTS), and its commit adds its files to
   it. written may be NULL and must outlive the set. */
void ffd_output_record(file_output *output, written_files *written);
/* From now on paths are only names: the set collects its files in memory, and its commit passes them to the
   callback in the order in which they were begun, until that fails. sink NULL: does nothing. */
void ffd_output_redirect(file_output *output, ffd_sink_function sink, void *user);
/* From now on the bytes of the first file are hashed while they are written. */
void ffd_output_hash(file_output *output);
/* Gets that hash. Returns false if the set is not a single regular file, or there is no hash. */
bool ffd_output_hash_value(const file_output *output, hash128 *hash);
/* Returns whether path names an open stream of this process: "-" (standard output), /dev/stdout, /dev/stderr,
   /dev/fd/N. */
bool ffd_output_is_stream(const char *path);
/* Begins the next file. To a stream, bytes are appended at the commit or before. Without force an existing
   target is FFD_E_EXISTS, and the commit fails likewise if a target appears meanwhile. The permission bits of
   an existing target are kept. A character device (/dev/null) is written to directly; a pipe, a socket,
   another device and a dangling symbolic link are FFD_E_IO. */
ffd_status ffd_output_begin(file_output *output, const char *path, bool force, ffd_error *error);
/* Creates a folder for the next file, and its parents. They are removed if the set is not committed, as far
   as they are empty. */
ffd_status ffd_output_folder(file_output *output, const char *path, ffd_error *error);
/* Appends bytes to the file begun last. */
ffd_status ffd_output_write(file_output *output, const void *bytes, size_t size, ffd_error *error);
/* Hands all bytes written so far to the system, so that a full disk or device is known now. */
ffd_status ffd_output_flush(file_output *output, ffd_error *error);
/* Lets the commit keep the file begun last open for reading and writing, and locked. Returns its descriptor,
   which ffd_output_destroy closes. */
int ffd_output_keep_open(file_output *output);
/* If the targets of all files already have the same bytes, the commit leaves them untouched, with their
   times. */
void ffd_output_keep_equal(file_output *output);
/* Commits the set: all files appear. After a failure the targets are as before. */
ffd_status ffd_output_commit(file_output *output, ffd_error *error);
/* Returns whether the last ffd_output_begin failed because another run is writing the target. */
bool ffd_output_was_busy(const file_output *output);
/* Destroys the set, and removes its temporary files if it is not committed. output and *output may be
   NULL. */
void ffd_output_destroy(file_output **output);
/* Refuses (FFD_E_ARGUMENT) a name for something in memory that cannot be that of a file: its last component
   is empty, "." or "..", or it means a stream. */
ffd_status ffd_file_check_name(const char *name, ffd_error *error);
/* Makes the checks of ffd_output_begin before any work is done. */
ffd_status ffd_output_check(const char *path, bool force, ffd_error *error);
/* The same for a file whose folders are made before it is begun (ffd_output_folder): only a place where they
   cannot be made is refused. */
ffd_status ffd_output_check_with_folder(const char *path, bool force, ffd_error *error);

#endif
